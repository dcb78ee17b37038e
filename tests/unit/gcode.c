/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code: every word, every refusal with its place, laws of random programs, the benchmark programs. */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Known start, a feed and G98, so that moves are what they seem; the line that says so is numbered 0 below. The text
 * lies in a block of its own length: a reader that goes on past the end is seen by the address sanitizer. */
static const char head[] = "F100 G98\n";

static swarf_status read_bytes(const char *text, size_t length, swarf_program **out)
{
    char *copy = malloc(sizeof head - 1 + length);
    if (!copy) return SWARF_ERROR_MEMORY;
    memcpy(copy, head, sizeof head - 1);
    memcpy(copy + sizeof head - 1, text, length);
    swarf_gcode_options options = swarf_gcode_options_default();
    options.start[0] = options.start[1] = 0;
    options.start[2] = 10;
    const swarf_status status = swarf_gcode_read(copy, sizeof head - 1 + length, "part.nc", &options, NULL, out);
    free(copy);
    return status;
}

static swarf_program *read_ok(const char *text)
{
    swarf_program *program = NULL;
    CHECK_OK(read_bytes(text, strlen(text), &program));
    if (!program) CHECK_OK(swarf_program_create(NULL, &program)); /* the failure is counted; go on with nothing */
    return program;
}

/* The text fails and the message is or contains `part`; lines are counted without the head. */
static void refuse(const char *text, const char *part)
{
    swarf_program *program = NULL;
    int ok = CHECK(read_bytes(text, strlen(text), &program) == SWARF_ERROR_FORMAT);
    char message[800] = "";
    const char *last = swarf_error_last(), *place = strchr(last, ':');
    if (ok && place) {
        char *rest;
        const unsigned long line = strtoul(place + 1, &rest, 10);
        snprintf(message, sizeof message, "part.nc:%lu%s", line - 1, rest);
    }
    ok = CHECK(strstr(message, part) != NULL) && ok;
    if (!ok) fprintf(stderr, "  in: %s\n  wanted: %s\n  got: %s\n", text, part, message);
    CHECK(program == NULL);
    swarf_program_release(program);
}

/* What a program must be, one character a move: r f d t P for the kinds, a for an arc; then ends x y z of each. */
static void expect(const char *text, const char *kinds, ...)
{
    swarf_program *program = read_ok(text);
    const size_t count = swarf_program_move_count(program);
    const swarf_move *moves = swarf_program_moves(program);
    int same = count == strlen(kinds);
    va_list ends;
    va_start(ends, kinds);
    for (size_t i = 0; i < strlen(kinds); i++) {
        double wanted[3];
        for (int k = 0; k < 3; k++) wanted[k] = va_arg(ends, double);
        if (i >= count) continue;
        const char *letters = "rfdtpP";
        const char kind = moves[i].arc >= 0 ? 'a' : letters[swarf_move_get_kind(&moves[i])];
        same = same && kind == kinds[i];
        for (int k = 0; k < 3; k++)
            same = same && (isnan(wanted[k]) ? isnan(moves[i].end[k]) : fabs(moves[i].end[k] - wanted[k]) < 1e-9);
    }
    va_end(ends);
    if (!CHECK(same)) {
        fprintf(stderr, "  in: %s\n  %zu moves:\n", text, count);
        for (size_t i = 0; i < count; i++)
            fprintf(stderr, "  kind %d arc %d: %.9g %.9g %.9g\n", (int)swarf_move_get_kind(&moves[i]),
                    (int)moves[i].arc, moves[i].end[0], moves[i].end[1], moves[i].end[2]);
    }
    swarf_program_release(program);
}

static void test_numbers(void)
{
    static const struct {
        const char *text;
        double value;
    } good[] = {{"1", 1},
                {"+1.", 1},
                {".5", 0.5},
                {"-0.5", -0.5},
                {"-.5", -0.5},
                {"007", 7},
                {"- 1 2 . 5", -12.5},
                {"\t3", 3},
                {"0", 0},
                {"-0", 0},
                {"123456.789012", 123456.789012},
                {"0.000001", 1e-6},
                {"1.00000000000000000000000000000001", 1},
                {"0.1234567890123456789012345", 0.1234567890123456789},
                {".000000000000000000000000000000000000000000001", 1e-45},
                {"000000000000000000000000000012.5", 12.5},
                {"999999.99999999999999", 1e6}};
    char line[200];
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        snprintf(line, sizeof line, "G0X%s", good[i].text);
        swarf_program *program = read_ok(line);
        if (CHECK(swarf_program_move_count(program) == 1))
            CHECK_NEAR(swarf_program_moves(program)[0].end[0], good[i].value, 2e-16 * fabs(good[i].value));
        swarf_program_release(program);
    }
    /* written as a double's own digits, they come back as the same double (the C library is the judge) */
    test_random random = test_random_begin(3);
    for (int i = 0; i < 20000; i++) {
        const double value = test_random_in(&random, -1e6, 1e6) * pow(10, -(double)test_random_below(&random, 9));
        char number[64];
        snprintf(number, sizeof number, "%.*f", (int)test_random_below(&random, 16), value);
        snprintf(line, sizeof line, "G0X%s", number);
        swarf_program *program = read_ok(line);
        const double got = swarf_program_moves(program)[0].end[0], wanted = strtod(number, NULL);
        if (strlen(number) < 16)
            CHECK(got == wanted);
        else
            CHECK_NEAR(got, wanted, DBL_EPSILON * fabs(wanted));
        swarf_program_release(program);
    }
    refuse("G0 X", "part.nc:1:4: error: 'X' has no number");
    refuse("G0 X-", "expected a value at the end of the line");
    refuse("G0 X.", "'X' has no number");
    refuse("G0 X-+", "expected a value");
    refuse("G0 X1.2.3", "part.nc:1:8: error: '.' begins no word");
    refuse("G0 X1e400",
           "part.nc:1:6: error: 'e400' is not used by this line; E belongs to M66 to M68 (numbers take no");
    refuse("G0 X9999999999999", "part.nc:1:4: error: 'X9999999999999' is out of range");
    refuse("G0 X1000000000000000000000000000000000000000", "is out of range");
    refuse("G0 Xnan", "'n' is no value");
    refuse("G20 G0 X40000", "'X40000' is 1.016e+06 mm; at most 1e+06 is possible");
    refuse("G91 G0 X900000\nX900000", "part.nc:2:1: error: 'X900000' leads to X 1.8e+06 mm");
}

static void test_text(void)
{
    expect("", "");
    expect("\n\n \t\n", "");
    expect("%\nG41 is never read", "");
    expect("%\nnonsense", "");
    expect("G0 X1\n%\nnonsense", "r", 1.0, 0.0, 10.0);
    expect("G0 X1\nM30\nnonsense", "r", 1.0, 0.0, 10.0);
    expect("G0 X1 M2\nnonsense", "r", 1.0, 0.0, 10.0);
    expect("g0x1y2", "r", 1.0, 2.0, 10.0);
    expect("G0X1\r\nY2\rZ3\n\rX4", "rrrr", 1.0, 0.0, 10.0, 1.0, 2.0, 10.0, 1.0, 2.0, 3.0, 4.0, 2.0, 3.0);
    expect("N10 G0 (go) X1 (Y5) ; Y6\n(a)(b)\n;G41\nN20 (c) Y2", "rr", 1.0, 0.0, 10.0, 1.0, 2.0, 10.0);
    expect("/G0 X1\n / N5 Y2", "rr", 1.0, 0.0, 10.0, 1.0, 2.0, 10.0);
    expect("G 0 X 1 . 5 Y - 2", "r", 1.5, -2.0, 10.0);
    refuse("G0 X1\nG0 (open", "part.nc:2:4: error: '(' comment is not closed");
    refuse("G0 (a (b))", "comment holds another '('");
    refuse("G0 )", "')' closes no comment");
    refuse("G0 X1 %", "'%' must stand alone");
    refuse("% G0", "part.nc:1:1: error: '%' must stand alone");
    refuse("\r\n\r\nG0 Q", "part.nc:3:4:");
    refuse("G0 X#<a>", "'#<a>' is a parameter that has no value yet");
    refuse("#1", "'#1' does nothing here; expected '='");
    refuse("G0 [1]", "'[' stands alone");
    refuse("\x7f"
           "ELF\x01\x02",
           "part.nc:1:1: error: '?' is byte 0x7f; this is not G-code text");
    refuse("G0 \xff", "is byte 0xff");
    swarf_program *program = NULL;
    CHECK_FAILS(read_bytes("G0 X1\0Y1", 8, &program), SWARF_ERROR_FORMAT, "byte 0x00");
    CHECK_OK(read_bytes("G0X123456", 4, &program)); /* the text ends where it is said to */
    if (program) CHECK(swarf_program_moves(program)[0].end[0] == 1.0);
    swarf_program_release(program);
}

static void test_modes(void)
{
    expect("G1 X1 F5\nY2\nG0 Z3\nX4", "ffrr", 1.0, 0.0, 10.0, 1.0, 2.0, 10.0, 1.0, 2.0, 3.0, 4.0, 2.0, 3.0);
    expect("G0 X1 Y1\nG91 X1 Y-1\nZ-1\nG90 X5", "rrrr", 1.0, 1.0, 10.0, 2.0, 0.0, 10.0, 2.0, 0.0, 9.0, 5.0, 0.0, 9.0);
    expect("G20 G0 X1\nG21 Y1", "rr", 25.4, 0.0, 10.0, 25.4, 1.0, 10.0);
    expect("G00 G17 G21 G40 G49 G80 G90\nX1", "r", 1.0, 0.0, 10.0);
    expect("G0 X1 G17 G40 G49 G54 G61 G80 G94 G98 G90.1", "r", 1.0, 0.0, 10.0);
    expect("G64 P0.01 Q0.02\nG61.1\nG99 G91.1", "");
    expect("G0\nX1\nG1\nX2", "rf", 1.0, 0.0, 10.0, 2.0, 0.0, 10.0);
    expect("G4 P1.5\nG4 P0", "dd", 0.0, 0.0, 10.0, 0.0, 0.0, 10.0);
    expect("G1 G4 P1 X1", "df", 0.0, 0.0, 10.0, 1.0, 0.0, 10.0);
    expect("G1 X0 Y0 Z10 F100", "f", 0.0, 0.0, 10.0);
    expect("M0\nM1\nM3 S1000 M8 M7\nM9\nM5", "");

    swarf_program *program = read_ok("G20\nF10 G1 X1\nG21\nF100 X2\nG0 X3\nG1 G4 P2.5 X4");
    const swarf_move *moves = swarf_program_moves(program);
    if (CHECK(swarf_program_move_count(program) == 5)) {
        CHECK_NEAR((double)moves[0].feed_mm_min, 254, 1e-6);
        CHECK(moves[1].feed_mm_min == 100.0f && moves[2].feed_mm_min == 0.0f && moves[3].feed_mm_min == 2.5f);
        CHECK(moves[4].feed_mm_min == 100.0f && moves[0].line == 3 && moves[4].line == 7);
    }
    swarf_program_release(program);

    refuse("X1", "part.nc:1:1: error: 'X1' has no motion mode");
    refuse("G0 X1\nG80\nY1", "part.nc:3:1: error: 'Y1' has no motion mode");
    refuse("G0 G1 X1", "part.nc:1:4: error: 'G1' and 'G0' are of one modal group");
    refuse("G17 G18", "one modal group");
    refuse("G90 G91", "one modal group");
    refuse("M3 M4", "part.nc:1:4: error: 'M4' and 'M3' are of one modal group");
    refuse("M8 M9", "'M9' stops the coolant");
    refuse("G80 G81 X1 Z1 R2", "'G80' and a cycle cannot share a line");
    refuse("G0 X1 X2", "part.nc:1:7: error: 'X2' is the second X");
    refuse("G4", "'G4' needs P");
    refuse("G4 P-1", "must not be negative");
    refuse("G1 F-1", "'F-1' feed must not be negative");
    refuse("S-5", "'S-5' speed must not be negative");
    refuse("G90.15", "'G90.15' is no code");
    refuse("G-1", "'G-1' is no code");
    refuse("M3.5", "'M3.5' is no code");
    refuse("G0 X1 I5", "part.nc:1:7: error: 'I5' is not used by this line; I belongs to G2 and G3");
    refuse("G1 X1 R5", "'R5' is not used");
    refuse("G1 X1 L5", "L belongs to cycles, G10 and M98");
    refuse("G1 X1 P5", "'P5' is not used");
    refuse("G1 X1 Q5", "'Q5' is not used");
    refuse("G0 H1", "H belongs to G43");
}

/* Every G and M code there is: accepted or refused by name, never ignored. */
static void test_all_codes(void)
{
    static const struct {
        int code; /* times 10 */
        const char *words;
    } g[] = {{0, ""},
             {10, ""},
             {20, ""},
             {30, ""},
             {40, "P1"},
             {50, "X1 I1 J0 P1 Q0"},
             {51, "X1 I1"},
             {80, ""},
             {100, "L2 P1"},
             {170, ""},
             {180, ""},
             {190, ""},
             {200, ""},
             {210, ""},
             {280, ""},
             {281, ""},
             {300, ""},
             {301, ""},
             {400, ""},
             {410, ""},
             {411, "D1"},
             {420, ""},
             {421, "D1"},
             {430, ""},
             {431, "Z1"},
             {432, "Z1"},
             {490, ""},
             {520, "X1"},
             {530, "G0 X1"},
             {540, ""},
             {550, ""},
             {560, ""},
             {570, ""},
             {580, ""},
             {590, ""},
             {591, ""},
             {592, ""},
             {593, ""},
             {610, ""},
             {611, ""},
             {640, ""},
             {730, "X1 Z1 R2 Q1"},
             {800, ""},
             {810, "X1 Z1 R2"},
             {820, "X1 Z1 R2 P1"},
             {830, "X1 Z1 R2 Q1"},
             {850, "X1 Z1 R2"},
             {890, "X1 Z1 R2 P1"},
             {900, ""},
             {901, ""},
             {910, ""},
             {911, ""},
             {920, "X1"},
             {921, ""},
             {922, ""},
             {923, ""},
             {930, ""},
             {940, ""},
             {950, ""},
             {960, "S1"},
             {970, ""},
             {980, ""},
             {990, ""},
             {840, "M3 X1 Z1 R2"},
             {740, "M4 X1 Z1 R2"},
             {860, "M3 X1 Z1 R2 P1"},
             {382, "X1"},
             {383, "X1"},
             {384, "X1"},
             {385, "X1"}};
    static const struct {
        int code;
        const char *words;
    } m[] = {{0, ""},    {1, ""},    {2, ""},    {3, ""},       {4, ""},       {5, ""},       {6, ""},
             {7, ""},    {8, ""},    {9, ""},    {19, ""},      {30, ""},      {48, ""},      {49, ""},
             {50, ""},   {51, ""},   {52, ""},   {53, ""},      {60, ""},      {61, "Q1"},    {62, "P1"},
             {63, "P1"}, {64, "P1"}, {65, "P1"}, {66, "P1 L0"}, {67, "E0 Q1"}, {68, "E0 Q1"}, {70, ""},
             {71, ""},   {73, ""},   {99, ""},   {100, ""},     {199, "P1 Q2"}};
    for (int code = 0; code < 1100; code++) {
        char line[64], quoted[32];
        const char *words = NULL;
        for (size_t i = 0; i < sizeof g / sizeof *g; i++)
            if (g[i].code == code) words = g[i].words;
        if (code == 330 || code == 331) continue; /* no feed word may stand before them: tested elsewhere */
        snprintf(line, sizeof line, "G%d.%d %s", code / 10, code % 10, words ? words : "");
        snprintf(quoted, sizeof quoted, "'G%d.%d'", code / 10, code % 10);
        swarf_program *program = NULL;
        if (words)
            CHECK_OK(read_bytes(line, strlen(line), &program));
        else
            CHECK_FAILS(read_bytes(line, strlen(line), &program), SWARF_ERROR_FORMAT, quoted);
        swarf_program_release(program);
        if (code >= 300) continue;
        words = code > 99 && code < 200 ? "" : NULL;
        for (size_t i = 0; i < sizeof m / sizeof *m; i++)
            if (m[i].code == code) words = m[i].words;
        snprintf(line, sizeof line, "T1 M%d %s", code, words ? words : "");
        snprintf(quoted, sizeof quoted, "'M%d'", code);
        program = NULL;
        if (words)
            CHECK_OK(read_bytes(line, strlen(line), &program));
        else
            CHECK_FAILS(read_bytes(line, strlen(line), &program), SWARF_ERROR_FORMAT, quoted);
        swarf_program_release(program);
    }
    /* every letter by itself */
    for (char letter = 'A'; letter <= 'Z'; letter++) {
        const char line[] = {letter, '1', 0};
        if (strchr("FMNST", letter) || letter == 'G' || letter == 'O')
            expect(line, "");
        else
            refuse(line, line);
    }
    refuse("WHILE [#1 LT 3] DO1", "part.nc:1:1: error: 'WHILE' is a statement of macros");
    refuse("N5 if[#1 EQ 1] GOTO 10", "part.nc:1:4: error: 'if' is a statement of macros");
    refuse("X1 GOTO10", "'GOTO' is a statement of macros");
    refuse("END1", "'END' is a statement of macros");
    refuse("G41 D1", "part.nc:1:5: error: 'D1' needs the diameter of tool T1; give the tool or a tool table");
    refuse("G76", "'G76' is a cycle of lathes; this is a milling simulation");
    refuse("G7", "diameter mode of lathes");
    refuse("G5.2", "NURBS");
    refuse("G87", "back boring");
    refuse("G84 X1 Z1 R2", "'G84' taps a right-handed thread: the spindle must turn by M3");
}

static void test_tools(void)
{
    swarf_program *program =
        read_ok("G0 X1\nT2 M6 S900 M3\nG0 X2\nM5\nT3\nG1 X3\nM6\nM4 M7 S50\nG43 H3 Z5\nG43 Z6\nT2 M6\nG0 X4\nT0 M6");
    static const char *const names[] = {"program", "T2", "T3", "T2 (2)", "T0"};
    CHECK(swarf_program_operation_count(program) == 5);
    for (size_t i = 0; i < 5; i++) {
        const char *name = swarf_program_operation_name(program, i);
        CHECK(name && strcmp(name, names[i]) == 0);
    }
    static const struct {
        int kind, tool, operation, spindle, coolant;
        double rpm;
    } wanted[] = {{0, -1, 0, 0, 0, 0},  {3, 2, 1, 0, 0, 900}, {0, 2, 1, 1, 0, 900}, {1, 2, 1, 0, 0, 900},
                  {3, 3, 2, 0, 0, 900}, {1, 3, 2, 2, 1, 50},  {1, 3, 2, 2, 1, 50},  {3, 2, 3, 0, 1, 50},
                  {0, 2, 3, 0, 1, 50},  {3, 0, 4, 0, 1, 50}};
    CHECK(swarf_program_move_count(program) == 10);
    for (size_t i = 0; i < swarf_program_move_count(program) && i < 10; i++) {
        const swarf_move *move = &swarf_program_moves(program)[i];
        const swarf_section *section = &swarf_program_sections(program)[swarf_move_get_section(move)];
        CHECK((int)swarf_move_get_kind(move) == wanted[i].kind && section->tool == wanted[i].tool);
        CHECK(section->operation == wanted[i].operation && section->spindle == wanted[i].spindle);
        CHECK(section->coolant == wanted[i].coolant && section->spindle_rpm == wanted[i].rpm);
        CHECK(section->work_offset == 1);
    }
    swarf_program_release(program);
    program = read_ok("T1 M6\nG0 X1"); /* nothing before the tool: no operation of its own */
    CHECK(swarf_program_operation_count(program) == 1);
    swarf_program_release(program);
    refuse("M6", "'M6' has no tool to load");
    refuse("T1.5", "'T1.5' must be a whole number");
    refuse("T-1", "'T-1' must be a whole number from 0 to 99999");
    refuse("T100000", "must be a whole number");
    refuse("T1 M6\nG43 H2", "part.nc:2:5: error: 'H2' is not the offset of the loaded tool, H1 is");
    refuse("G43 H2", "no tool is loaded");
}

static void test_unknown(void)
{
    swarf_program *program = NULL;
    const char text[] = "G0 X1\nZ5\nG1 F9 Y2\nX2";
    CHECK_OK(swarf_gcode_read(text, strlen(text), "p", NULL, NULL, &program));
    CHECK(swarf_program_move_count(program) == 4);
    for (size_t i = 0; i < swarf_program_move_count(program); i++) {
        swarf_path path;
        CHECK_OK(swarf_program_path(program, i, &path));
        CHECK(path.has_motion == (i == 3));
    }
    CHECK(isnan(swarf_program_moves(program)[1].end[1]));
    swarf_program_release(program);
    static const char *const bad[] = {"G91 G0 X1",          "F1 G2 X1 I1",
                                      "F1 G81 Z1 R2",       "G0 X0 Y0\nF1 G91 G81 Z-1 R2",
                                      "G0 Y1\nF1 G3 X1 R1", "F1 G91 G2 X1 I1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        program = NULL;
        CHECK_FAILS(swarf_gcode_read(bad[i], strlen(bad[i]), "p", NULL, NULL, &program), SWARF_ERROR_FORMAT, "unknown");
        swarf_program_release(program);
    }
    program = NULL; /* a cycle finds its height by R */
    CHECK_OK(swarf_gcode_read("F9G81 X1Y2Z-3 R1", 16, "p", NULL, NULL, &program));
    CHECK(swarf_program_move_count(program) == 4);
    swarf_program_release(program);
}

/* The only arc of a program that first goes to (10, 0, 10). */
static swarf_path arc_of(const char *line)
{
    char text[200];
    snprintf(text, sizeof text, "G0 X10 Y0\n%s", line);
    swarf_program *program = read_ok(text);
    swarf_path path;
    memset(&path, 0, sizeof path);
    if (CHECK(swarf_program_arc_count(program) == 1 && swarf_program_move_count(program) == 2))
        CHECK_OK(swarf_program_path(program, 1, &path));
    else
        fprintf(stderr, "  in: %s\n", line);
    swarf_program_release(program);
    return path;
}

static void check_arc(const char *line, double cx, double cy, double cz, double angle)
{
    const swarf_path path = arc_of(line);
    const int ok = test_near(path.arc.centre[0], cx, 1e-9, __FILE__, __LINE__, "centre x") &
                   test_near(path.arc.centre[1], cy, 1e-9, __FILE__, __LINE__, "centre y") &
                   test_near(path.arc.centre[2], cz, 1e-9, __FILE__, __LINE__, "centre z") &
                   test_near(path.arc.angle_rad, angle, 1e-9, __FILE__, __LINE__, "angle");
    if (!ok) fprintf(stderr, "  in: %s\n", line);
}

static void test_arcs(void)
{
    check_arc("G3 X0 Y10 I-10", 0, 0, 10, 0.5 * pi);
    check_arc("G2 X0 Y10 I-10 J0", 0, 0, 10, -1.5 * pi);
    check_arc("G2 I-5", 5, 0, 10, -2 * pi);
    check_arc("G3 X10 Y0 I-5", 5, 0, 10, 2 * pi);
    check_arc("G3 X10 Y0 Z5 I-5 P3", 5, 0, 10, 6 * pi);
    check_arc("G90.1 G3 X0 Y10 I0 J0", 0, 0, 10, 0.5 * pi);
    check_arc("G91 G3 X-10 Y10 I-10", 0, 0, 10, 0.5 * pi);
    check_arc("G20 G3 X0 Y0.39370078740157483 I-0.39370078740157483", 0, 0, 10, 0.5 * pi);
    check_arc("G3 X0 Y10 R10", 0, 0, 10, 0.5 * pi);
    check_arc("G3 X0 Y10 R-10", 10, 10, 10, 1.5 * pi);
    check_arc("G2 X0 Y10 R10", 10, 10, 10, -0.5 * pi);
    check_arc("G2 X0 Y10 R-10", 0, 0, 10, -1.5 * pi);
    check_arc("G2 X0 Y0 R5", 5, 0, 10, -pi);
    check_arc("G3 X0 Y0 R4.9999", 5, 0, 10, pi);
    check_arc("G91.1 G2 X0 Y10 Z4 R10", 10, 10, 10, -0.5 * pi);
    /* the other planes: about +y from z towards x, about +x from y towards z */
    check_arc("G18 G3 X15 Z5 K-5", 10, 0, 5, 0.5 * pi);
    check_arc("G18 G2 X5 Z5 K-5", 10, 0, 5, -0.5 * pi);
    check_arc("G19 G3 Y-5 Z5 K-5", 10, 0, 5, 0.5 * pi);
    check_arc("G19 G2 Y5 Z5 K-5", 10, 0, 5, -0.5 * pi);
    check_arc("G18 G3 X15 Z5 R5", 10, 0, 5, 0.5 * pi);
    check_arc("G18 G3 X15 Y7 Z5 K-5", 10, 0, 5, 0.5 * pi);
    const swarf_path helix = arc_of("G2 I-10 Z4 P2");
    CHECK_NEAR(swarf_path_length(&helix), hypot(40 * pi, 6), 1e-9);
    expect("G2 X2 I1\nX4 I1\nX5 Y1 R1", "aaa", 2.0, 0.0, 10.0, 4.0, 0.0, 10.0, 5.0, 1.0, 10.0);
    expect("G2\nI1", "a", 0.0, 0.0, 10.0);

    refuse("G2 X10", "part.nc:1:1: error: 'G2' arc needs a centre by I or J, or R");
    refuse("G90.1 G2 X10 I5", "arc needs a centre by I and J (both under G90.1), or R");
    refuse("G2 X10 I4", "'G2' arc: the radius is 4 mm at the start but 6 mm at the end");
    CHECK(strstr(swarf_error_last(), "I5 J0 would fit") != NULL);
    refuse("G2 X10 R4", "part.nc:1:8: error: 'R4' is too small: the ends are 10 mm apart, so R must be at least 5");
    refuse("G20 G2 X10 R4", "so R must be at least 5");
    refuse("G2 X0 Y0 R5", "makes no arc between equal points");
    refuse("G2 R5", "'R5' needs an end: X or Y");
    refuse("G2 X5 R0", "must not be 0");
    refuse("G2 X5 R5 I2", "an arc takes one of them");
    refuse("G2 X5 I2.5 K1", "'K1' is not used");
    refuse("G18 G2 X5 J2.5", "arc needs a centre by K or I");
    refuse("G2 I0", "the radius is 0 mm");
    refuse("G2 I1 P0", "'P0' must be a whole number from 1 to 10000");
    refuse("G2 I1 P1.5", "must be a whole number");
}

static void test_cycles(void)
{
    const double n = 10; /* initial height */
    expect("G81 X1 Y2 Z-3 R1", "rrfr", 1.0, 2.0, n, 1.0, 2.0, 1.0, 1.0, 2.0, -3.0, 1.0, 2.0, n);
    expect("G99 G81 X1 Y2 Z-3 R1", "rrfr", 1.0, 2.0, n, 1.0, 2.0, 1.0, 1.0, 2.0, -3.0, 1.0, 2.0, 1.0);
    expect("G82 X1 Z-3 R1 P.5", "rrfdr", 1.0, 0.0, n, 1.0, 0.0, 1.0, 1.0, 0.0, -3.0, 1.0, 0.0, -3.0, 1.0, 0.0, n);
    expect("G85 X1 Z-3 R1", "rrffr", 1.0, 0.0, n, 1.0, 0.0, 1.0, 1.0, 0.0, -3.0, 1.0, 0.0, 1.0, 1.0, 0.0, n);
    expect("G89 X1 Z-3 R1 P.5", "rrfdf", 1.0, 0.0, n, 1.0, 0.0, 1.0, 1.0, 0.0, -3.0, 1.0, 0.0, -3.0, 1.0, 0.0, n);
    expect("G83 Z-3 R1 Q2", "rfrrfr", 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, -0.746, 0.0, 0.0, -3.0,
           0.0, 0.0, n);
    expect("G73 Z-3 R1 Q2", "rfrfr", 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, -0.746, 0.0, 0.0, -3.0, 0.0, 0.0, n);
    /* modal: place, depth, R and Q stay; G98 returns to where the series began, whatever G99 did between */
    expect("G99 G81 X1 Z-3 R1\nX2\nG98 X3\nG80\nG0 X4",
           "rrfr"
           "rfr"
           "rfr"
           "r",
           1.0, 0.0, n, 1.0, 0.0, 1.0, 1.0, 0.0, -3.0, 1.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 0.0, -3.0, 2.0, 0.0, 1.0, 3.0,
           0.0, 1.0, 3.0, 0.0, -3.0, 3.0, 0.0, n, 4.0, 0.0, n);
    /* R above the tool: up first; G98 then returns to R */
    expect("G81 X1 Z-3 R12", "rrfr", 0.0, 0.0, 12.0, 1.0, 0.0, 12.0, 1.0, 0.0, -3.0, 1.0, 0.0, 12.0);
    /* G91: steps repeat, R from the initial height, Z from R */
    expect("G91 G99 G81 X1 Y2 Z-5 R-9 L2",
           "rrfr"
           "rfr",
           1.0, 2.0, n, 1.0, 2.0, 1.0, 1.0, 2.0, -4.0, 1.0, 2.0, 1.0, 2.0, 4.0, 1.0, 2.0, 4.0, -4.0, 2.0, 4.0, 1.0);
    expect("G81 Z-3 R1 L2",
           "rfr"
           "rfr",
           0.0, 0.0, 1.0, 0.0, 0.0, -3.0, 0.0, 0.0, n, 0.0, 0.0, 1.0, 0.0, 0.0, -3.0, 0.0, 0.0, n);
    /* along the plane's normal; in inches */
    expect("G18 G81 X1 Y-3 R-1", "rrfr", 1.0, 0.0, n, 1.0, -1.0, n, 1.0, -3.0, n, 1.0, 0.0, n);
    expect("G20 G81 Z-.1 R.1", "rfr", 0.0, 0.0, 2.54, 0.0, 0.0, -2.54, 0.0, 0.0, n);

    refuse("G81 X1 R1", "'G81' starts a cycle that needs Z, the bottom of the hole");
    refuse("G81 X1 Z-1", "needs R");
    refuse("G83 X1 Z-1 R1", "needs Q");
    refuse("G82 X1 Z-1 R1", "needs P");
    refuse("G81 Z-1 R1 Q1", "'Q1' is not used");
    refuse("G83 X1 Z-1 R1 Q0", "'Q0' must be positive");
    refuse("G81 X1 Z2 R1", "R must be above Z");
    refuse("G81 X1 Z-1 R1 L0", "'L0' must be a whole number from 1");
    refuse("G83 X1 Z-100 R1 Q0.0001", "more than 100000 pecks");
    refuse("G81 R1", "without a place");
    refuse("G81 X1 Z-1 R1\nG0 X2\nG81 X3", "part.nc:3:1: error: 'G81' starts a cycle that needs Z");
    refuse("G81 X1 Z-1 R1\nG18 X2", "needs Y");
}

/* Random programs whose outcome is known from how they were made. */
static void test_random_programs(void)
{
    test_random random = test_random_begin(11);
    enum { LINES = 40 };
    for (int n = 0; n < 500; n++) {
        char text[8192];
        size_t used = 0;
        double x = 0, y = 0, z = 10, length = 0, bottom = 10;
        size_t arcs = 0, feeds_down = 0;
        const double unit = n % 2 ? 25.4 : 1;
        used += (size_t)snprintf(text + used, sizeof text - used, n % 2 ? "G20\n" : "G21\n");
        for (int i = 0; i < LINES; i++) {
            const double a = round(test_random_in(&random, -1e5, 1e5)) / 1e4;
            const double b = round(test_random_in(&random, -1e5, 1e5)) / 1e4;
            switch (test_random_below(&random, 3)) {
            case 0: /* straight */
                used += (size_t)snprintf(text + used, sizeof text - used, "N%d G%d X%.4f Y%.4f\n", i, 1, a, b);
                length += hypot(a * unit - x, b * unit - y);
                x = a * unit, y = b * unit;
                break;
            case 1: { /* helix of P turns back to where it began */
                const int turns = 1 + (int)test_random_below(&random, 4);
                if (hypot(a, b) < 0.01) break;
                used += (size_t)snprintf(text + used, sizeof text - used, "G%d Z%.4f I%.4f J%.4f P%d\n", 2 + i % 2, a,
                                         b, a, turns);
                length += hypot(2 * pi * turns * hypot(a, b) * unit, a * unit - z);
                z = a * unit;
                if (z < bottom) bottom = z;
                arcs++;
                break;
            }
            default: { /* pecks: each feeds 2 q at most, all reach the bottom */
                const double r = fabs(a) + 0.5, depth = -fabs(b), q = 0.7;
                used += (size_t)snprintf(text + used, sizeof text - used,
                                         "G99 G83 X%.4f Y%.4f Z%.4f R%.4f Q%.4f\nG80\n", b, a, depth, r, q);
                feeds_down += (size_t)ceil((r - depth) / q - 1e-6 / unit / q);
                x = b * unit, y = a * unit, z = r * unit;
                if (depth * unit < bottom) bottom = depth * unit;
                break;
            }
            }
        }
        swarf_program *program = read_ok(text);
        const size_t count = swarf_program_move_count(program);
        double total = 0, lowest = 10;
        size_t pecks = 0;
        for (size_t i = 0; i < count; i++) {
            swarf_path path;
            if (swarf_program_path(program, i, &path) != SWARF_OK) continue;
            const int fed = swarf_move_get_kind(&swarf_program_moves(program)[i]) == SWARF_MOVE_FEED;
            const int plunge = !path.is_arc && path.start[2] != path.end[2];
            if (fed && plunge) pecks++;
            if (fed && !plunge) total += swarf_path_length(&path);
            if (path.end[2] < lowest) lowest = path.end[2];
            if (fed && plunge) CHECK(path.start[2] - path.end[2] < (0.7 + 0.2541) * unit);
            double p[3];
            swarf_path_point(&path, 1, p);
            CHECK(memcmp(p, swarf_program_moves(program)[i].end, sizeof p) == 0);
        }
        CHECK(swarf_program_arc_count(program) == arcs);
        CHECK(pecks == feeds_down);
        CHECK_NEAR(total, length, 1e-9 * (1 + length));
        CHECK_NEAR(lowest, bottom, 1e-9);
        if (count) {
            const double *end = swarf_program_moves(program)[count - 1].end;
            CHECK_NEAR(end[0], x, 1e-9);
            CHECK_NEAR(end[1], y, 1e-9);
            CHECK_NEAR(end[2], z, 1e-9);
        }
        swarf_program_release(program);
    }
}

static int stop_at_once(void *user, double fraction)
{
    (void)fraction;
    return ++*(int *)user > 0;
}

static int rising(void *user, double fraction)
{
    double *last = user;
    CHECK(fraction >= *last && fraction <= 1.0);
    *last = fraction;
    return 0;
}

/* A million lines, and cancelled at the first report. (Time and memory: gcode_bench.) */
static void test_large(void)
{
    enum { LINES = 1000000 };
    char *text = malloc((size_t)LINES * 40);
    if (!CHECK(text != NULL)) return;
    size_t used = 0;
    for (int i = 0; i < LINES; i++)
        used +=
            (size_t)sprintf(text + used, "N%d G1 X%d.%03d Y%d.5 Z-%d.25 F1000\n", i, i % 200, i % 1000, i % 77, i % 9);
    swarf_program *program = NULL;
    double last = -1;
    const swarf_progress progress = {rising, &last};
    CHECK_OK(swarf_gcode_read(text, used, "large.nc", NULL, &progress, &program));
    CHECK(last == 1.0);
    CHECK(swarf_program_move_count(program) == LINES);
    swarf_program_release(program);
    program = NULL;
    int calls = 0;
    const swarf_progress cancel = {stop_at_once, &calls};
    CHECK_FAILS(swarf_gcode_read(text, used, "large.nc", NULL, &cancel, &program), SWARF_ERROR_CANCELLED, "cancelled");
    CHECK(program == NULL && calls == 1);
    free(text);
}

static void test_arguments_and_files(void)
{
    swarf_program *program = NULL;
    CHECK_FAILS(swarf_gcode_read(NULL, 5, "a", NULL, NULL, &program), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_gcode_read("", 0, NULL, NULL, NULL, &program), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_gcode_read("", 0, "a", NULL, NULL, NULL), SWARF_ERROR_ARGUMENT, NULL);
    swarf_gcode_options options = swarf_gcode_options_default();
    options.size = 3;
    CHECK_FAILS(swarf_gcode_read("", 0, "a", &options, NULL, &program), SWARF_ERROR_ARGUMENT, "options");
    options = swarf_gcode_options_default();
    options.start[1] = INFINITY;
    CHECK_FAILS(swarf_gcode_read("", 0, "a", &options, NULL, &program), SWARF_ERROR_ARGUMENT, "start Y");
    CHECK_FAILS(swarf_gcode_read_file("/nowhere/at all.nc", NULL, NULL, &program), SWARF_ERROR_IO,
                "/nowhere/at all.nc");
    CHECK_OK(swarf_gcode_read(NULL, 0, "a", NULL, NULL, &program));
    swarf_program_release(program);

    /* the examples: every move known, cuts within their stock's reach, lowest point */
    static const struct {
        const char *name;
        size_t arcs, operations;
        double lowest;
    } examples[] = {{"slot.nc", 4, 1, -4}, {"bracket.nc", 30, 2, -13.2}};
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        char path[1200];
        snprintf(path, sizeof path, "%s/examples/%s", SWARF_SOURCE_DIR, examples[i].name);
        program = NULL;
        CHECK_OK(swarf_gcode_read_file(path, NULL, NULL, &program));
        CHECK(swarf_program_arc_count(program) == examples[i].arcs);
        CHECK(swarf_program_operation_count(program) == examples[i].operations);
        double lowest = 0;
        for (size_t k = 0; k < swarf_program_move_count(program); k++) {
            const swarf_move *move = &swarf_program_moves(program)[k];
            if (swarf_move_get_kind(move) != SWARF_MOVE_FEED) continue;
            CHECK(move->feed_mm_min > 0 && move->end[0] >= -5 && move->end[0] <= 65);
            CHECK(move->end[1] >= -6 && move->end[1] <= 40 && move->end[2] <= 1);
            if (move->end[2] < lowest) lowest = move->end[2];
        }
        CHECK_NEAR(lowest, examples[i].lowest, 0);
        swarf_program_release(program);
    }

    static const struct {
        const char *name;
        size_t moves;
        size_t operations;
    } shared[] = {{"bear.nc", 15160, 1}, {"cameo.nc", 35283, 1}};
    if (!*test_shared()) {
        printf("skipped: the benchmark programs are not here (set SWARF_SHARED)\n");
        return;
    }
    for (size_t i = 0; i < sizeof shared / sizeof *shared; i++) {
        char path[1200];
        snprintf(path, sizeof path, "%s/data/%s", test_shared(), shared[i].name);
        program = NULL;
        CHECK_OK(swarf_gcode_read_file(path, NULL, NULL, &program));
        CHECK(swarf_program_move_count(program) == shared[i].moves);
        CHECK(swarf_program_operation_count(program) == shared[i].operations);
        swarf_program_release(program);
    }
}

int main(void)
{
    test_numbers();
    test_text();
    test_modes();
    test_all_codes();
    test_tools();
    test_unknown();
    test_arcs();
    test_cycles();
    test_random_programs();
    test_large();
    test_arguments_and_files();
    return test_end();
}
