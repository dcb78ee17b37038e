/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code: numbers, text, every word and every refusal with its place. Arcs and cycles: gcode_motion.c; what words do:
 * gcode_words.c. */
#include "gcode.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
        swarf_program *program = gcode_read_ok(line);
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
        swarf_program *program = gcode_read_ok(line);
        const double got = swarf_program_moves(program)[0].end[0], wanted = strtod(number, NULL);
        if (strlen(number) < 16)
            CHECK(got == wanted);
        else
            CHECK_NEAR(got, wanted, DBL_EPSILON * fabs(wanted));
        swarf_program_release(program);
    }
    gcode_refuse("G0 X", "part.nc:1:4: error: 'X' has no number");
    gcode_refuse("G0 X-", "expected a value at the end of the line");
    gcode_refuse("G0 X.", "'X' has no number");
    gcode_refuse("G0 X-+", "expected a value");
    gcode_refuse("G0 X1.2.3", "part.nc:1:8: error: '.' begins no word");
    gcode_refuse("G0 X1e400",
                 "part.nc:1:6: error: 'e400' is not used by this line; E belongs to M66 to M68 (numbers take no");
    gcode_refuse("G0 X9999999999999", "part.nc:1:4: error: 'X9999999999999' is out of range");
    gcode_refuse("G0 X1000000000000000000000000000000000000000", "is out of range");
    gcode_refuse("G0 Xnan", "'n' is no value");
    gcode_refuse("G20 G0 X40000", "'X40000' is 1.016e+06 mm; at most 1e+06 is possible");
    gcode_refuse("G91 G0 X900000\nX900000", "part.nc:2:1: error: 'X900000' leads to X 1.8e+06 mm");
}

static void test_text(void)
{
    gcode_expect("", "");
    gcode_expect("\n\n \t\n", "");
    gcode_expect("%\nG41 is never read", "");
    gcode_expect("%\nnonsense", "");
    gcode_expect("G0 X1\n%\nnonsense", "r", 1.0, 0.0, 10.0);
    gcode_expect("G0 X1\nM30\nnonsense", "r", 1.0, 0.0, 10.0);
    gcode_expect("G0 X1 M2\nnonsense", "r", 1.0, 0.0, 10.0);
    gcode_expect("g0x1y2", "r", 1.0, 2.0, 10.0);
    gcode_expect("G0X1\r\nY2\rZ3\n\rX4", "rrrr", 1.0, 0.0, 10.0, 1.0, 2.0, 10.0, 1.0, 2.0, 3.0, 4.0, 2.0, 3.0);
    gcode_expect("N10 G0 (go) X1 (Y5) ; Y6\n(a)(b)\n;G41\nN20 (c) Y2", "rr", 1.0, 0.0, 10.0, 1.0, 2.0, 10.0);
    gcode_expect("/G0 X1\n / N5 Y2", "rr", 1.0, 0.0, 10.0, 1.0, 2.0, 10.0);
    gcode_expect("G 0 X 1 . 5 Y - 2", "r", 1.5, -2.0, 10.0);
    gcode_refuse("G0 X1\nG0 (open", "part.nc:2:4: error: '(' comment is not closed");
    gcode_refuse("G0 (a (b))", "comment holds another '('");
    gcode_refuse("G0 )", "')' closes no comment");
    gcode_refuse("G0 X1 %", "'%' must stand alone");
    gcode_refuse("% G0", "part.nc:1:1: error: '%' must stand alone");
    gcode_refuse("\r\n\r\nG0 Q", "part.nc:3:4:");
    gcode_refuse("G0 X#<a>", "'#<a>' is a parameter that has no value yet");
    gcode_refuse("#1", "'#1' does nothing here; expected '='");
    gcode_refuse("G0 [1]", "'[' stands alone");
    gcode_refuse("\x7f"
                 "ELF\x01\x02",
                 "part.nc:1:1: error: '?' is byte 0x7f; this is not G-code text");
    gcode_refuse("G0 \xff", "is byte 0xff");
    swarf_program *program = NULL;
    CHECK_FAILS(gcode_read_bytes("G0 X1\0Y1", 8, &program), SWARF_ERROR_FORMAT, "byte 0x00");
    CHECK_OK(gcode_read_bytes("G0X123456", 4, &program)); /* the text ends where it is said to */
    if (program) CHECK(swarf_program_moves(program)[0].end[0] == 1.0);
    swarf_program_release(program);
}

static void test_modes(void)
{
    gcode_expect("G1 X1 F5\nY2\nG0 Z3\nX4", "ffrr", 1.0, 0.0, 10.0, 1.0, 2.0, 10.0, 1.0, 2.0, 3.0, 4.0, 2.0, 3.0);
    gcode_expect("G0 X1 Y1\nG91 X1 Y-1\nZ-1\nG90 X5", "rrrr", 1.0, 1.0, 10.0, 2.0, 0.0, 10.0, 2.0, 0.0, 9.0, 5.0, 0.0,
                 9.0);
    gcode_expect("G20 G0 X1\nG21 Y1", "rr", 25.4, 0.0, 10.0, 25.4, 1.0, 10.0);
    gcode_expect("G00 G17 G21 G40 G49 G80 G90\nX1", "r", 1.0, 0.0, 10.0);
    gcode_expect("G0 X1 G17 G40 G49 G54 G61 G80 G94 G98 G90.1", "r", 1.0, 0.0, 10.0);
    gcode_expect("G64 P0.01 Q0.02\nG61.1\nG99 G91.1", "");
    gcode_expect("G0\nX1\nG1\nX2", "rf", 1.0, 0.0, 10.0, 2.0, 0.0, 10.0);
    gcode_expect("G4 P1.5\nG4 P0", "dd", 0.0, 0.0, 10.0, 0.0, 0.0, 10.0);
    gcode_expect("G1 G4 P1 X1", "df", 0.0, 0.0, 10.0, 1.0, 0.0, 10.0);
    gcode_expect("G1 X0 Y0 Z10 F100", "f", 0.0, 0.0, 10.0);
    gcode_expect("M0\nM1\nM3 S1000 M8 M7\nM9\nM5", "");

    swarf_program *program = gcode_read_ok("G20\nF10 G1 X1\nG21\nF100 X2\nG0 X3\nG1 G4 P2.5 X4");
    const swarf_move *moves = swarf_program_moves(program);
    if (CHECK(swarf_program_move_count(program) == 5)) {
        CHECK_NEAR((double)moves[0].feed_mm_min, 254, 1e-6);
        CHECK(moves[1].feed_mm_min == 100.0f && moves[2].feed_mm_min == 0.0f && moves[3].feed_mm_min == 2.5f);
        CHECK(moves[4].feed_mm_min == 100.0f && moves[0].line == 3 && moves[4].line == 7);
    }
    swarf_program_release(program);

    gcode_refuse("X1", "part.nc:1:1: error: 'X1' has no motion mode");
    gcode_refuse("G0 X1\nG80\nY1", "part.nc:3:1: error: 'Y1' has no motion mode");
    gcode_refuse("G0 G1 X1", "part.nc:1:4: error: 'G1' and 'G0' are of one modal group");
    gcode_refuse("G17 G18", "one modal group");
    gcode_refuse("G90 G91", "one modal group");
    gcode_refuse("M3 M4", "part.nc:1:4: error: 'M4' and 'M3' are of one modal group");
    gcode_refuse("M8 M9", "'M9' stops the coolant");
    gcode_refuse("G80 G81 X1 Z1 R2", "'G80' and a cycle cannot share a line");
    gcode_refuse("G0 X1 X2", "part.nc:1:7: error: 'X2' is the second X");
    gcode_refuse("G4", "'G4' needs P");
    gcode_refuse("G4 P-1", "must not be negative");
    gcode_refuse("G1 F-1", "'F-1' feed must not be negative");
    gcode_refuse("S-5", "'S-5' speed must not be negative");
    gcode_refuse("G90.15", "'G90.15' is no code");
    gcode_refuse("G-1", "'G-1' is no code");
    gcode_refuse("M3.5", "'M3.5' is no code");
    gcode_refuse("G0 X1 I5", "part.nc:1:7: error: 'I5' is not used by this line; I belongs to G2 and G3");
    gcode_refuse("G1 X1 R5", "'R5' is not used");
    gcode_refuse("G1 X1 L5", "L belongs to cycles, G10 and M98");
    gcode_refuse("G1 X1 P5", "'P5' is not used");
    gcode_refuse("G1 X1 Q5", "'Q5' is not used");
    gcode_refuse("G0 H1", "H belongs to G43");
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
            CHECK_OK(gcode_read_bytes(line, strlen(line), &program));
        else
            CHECK_FAILS(gcode_read_bytes(line, strlen(line), &program), SWARF_ERROR_FORMAT, quoted);
        swarf_program_release(program);
        if (code >= 300) continue;
        words = code > 99 && code < 200 ? "" : NULL;
        for (size_t i = 0; i < sizeof m / sizeof *m; i++)
            if (m[i].code == code) words = m[i].words;
        snprintf(line, sizeof line, "T1 M%d %s", code, words ? words : "");
        snprintf(quoted, sizeof quoted, "'M%d'", code);
        program = NULL;
        if (words)
            CHECK_OK(gcode_read_bytes(line, strlen(line), &program));
        else
            CHECK_FAILS(gcode_read_bytes(line, strlen(line), &program), SWARF_ERROR_FORMAT, quoted);
        swarf_program_release(program);
    }
    /* every letter by itself */
    for (char letter = 'A'; letter <= 'Z'; letter++) {
        const char line[] = {letter, '1', 0};
        if (strchr("FMNST", letter) || letter == 'G' || letter == 'O')
            gcode_expect(line, "");
        else
            gcode_refuse(line, line);
    }
    gcode_refuse("WHILE [#1 LT 3] DO1", "part.nc:1:1: error: 'WHILE' is a statement of macros");
    gcode_refuse("N5 if[#1 EQ 1] GOTO 10", "part.nc:1:4: error: 'if' is a statement of macros");
    gcode_refuse("X1 GOTO10", "'GOTO' is a statement of macros");
    gcode_refuse("END1", "'END' is a statement of macros");
    gcode_refuse("G41 D1", "part.nc:1:5: error: 'D1' needs the diameter of tool T1; give the tool or a tool table");
    gcode_refuse("G76", "'G76' is a cycle of lathes; this is a milling simulation");
    gcode_refuse("G7", "diameter mode of lathes");
    gcode_refuse("G5.2", "NURBS");
    gcode_refuse("G87", "back boring");
    gcode_refuse("G84 X1 Z1 R2", "'G84' taps a right-handed thread: the spindle must turn by M3");
}

static void test_tools(void)
{
    swarf_program *program = gcode_read_ok(
        "G0 X1\nT2 M6 S900 M3\nG0 X2\nM5\nT3\nG1 X3\nM6\nM4 M7 S50\nG43 H3 Z5\nG43 Z6\nT2 M6\nG0 X4\nT0 M6");
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
    program = gcode_read_ok("T1 M6\nG0 X1"); /* nothing before the tool: no operation of its own */
    CHECK(swarf_program_operation_count(program) == 1);
    swarf_program_release(program);
    gcode_refuse("M6", "'M6' has no tool to load");
    gcode_refuse("T1.5", "'T1.5' must be a whole number");
    gcode_refuse("T-1", "'T-1' must be a whole number from 0 to 99999");
    gcode_refuse("T100000", "must be a whole number");
    gcode_refuse("T1 M6\nG43 H2", "part.nc:2:5: error: 'H2' is not the offset of the loaded tool, H1 is");
    gcode_refuse("G43 H2", "no tool is loaded");
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

int main(void)
{
    test_numbers();
    test_text();
    test_modes();
    test_all_codes();
    test_tools();
    test_unknown();
    return test_end();
}
