/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code: what each word does, as LinuxCNC's manual says it; a program on the left, its moves as text on the right.
 *
 *     r X,Y,Z   rapid      f X,Y,Z@F   feed      p   probe      P X,Y,Z   position      d S   dwell      t N   tool
 *     a ANGLE(CX,CY,CZ)X,Y,Z           an arc by its angle in degrees
 */
#include "test.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double start[3] = {0, 0, 10};

static const swarf_gcode_tool tools[] = {{1, 0, {0, 0, 10}, 6}, {2, 0, {0, 0, 20}, 4}, {3, 0, {1, 2, 30}, 10}};

static void append(char *text, size_t size, const char *format, ...) SWARF_PRINTF(3, 4);
static void append(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

/* Rounded to 1e-5, which also makes -0 a 0. */
static double tidy(double value)
{
    return round(value * 1e5) / 1e5 + 0.0;
}

static void show(const swarf_program *program, char *text, size_t size)
{
    text[0] = 0;
    for (size_t i = 0; i < swarf_program_move_count(program); i++) {
        const swarf_move *move = &swarf_program_moves(program)[i];
        const swarf_section *section = &swarf_program_sections(program)[swarf_move_get_section(move)];
        const swarf_move_kind kind = swarf_move_get_kind(move);
        const double *e = move->end, feed = (double)move->feed_mm_min;
        if (i) append(text, size, " ");
        if (kind == SWARF_MOVE_DWELL) {
            append(text, size, "d%g", feed);
        } else if (kind == SWARF_MOVE_TOOL_CHANGE) {
            append(text, size, "t%d", (int)section->tool);
        } else if (move->arc >= 0) {
            const swarf_arc *arc = &swarf_program_arcs(program)[move->arc];
            append(text, size, "a%g(%g,%g,%g)%g,%g,%g", tidy(arc->angle_rad * 57.29577951308232), tidy(arc->centre[0]),
                   tidy(arc->centre[1]), tidy(arc->centre[2]), tidy(e[0]), tidy(e[1]), tidy(e[2]));
        } else {
            append(text, size, "%c%g,%g,%g", "rf??pP"[kind], tidy(e[0]), tidy(e[1]), tidy(e[2]));
        }
        if (kind == SWARF_MOVE_FEED && move->arc < 0) append(text, size, "@%g", feed);
    }
}

static swarf_gcode_options options_for(swarf_gcode_dialect dialect, int with_table)
{
    swarf_gcode_options options = swarf_gcode_options_default();
    memcpy(options.start, start, sizeof options.start);
    options.dialect = dialect;
    if (with_table) {
        options.tools = tools;
        options.tool_count = sizeof tools / sizeof *tools;
    }
    return options;
}

static void check_with(const swarf_gcode_options *options, const char *text, const char *wanted, const char *file,
                       int line)
{
    swarf_program *program = NULL;
    char got[4000];
    const swarf_status status = swarf_gcode_read(text, strlen(text), "t", options, NULL, &program);
    if (status == SWARF_OK)
        show(program, got, sizeof got);
    else
        snprintf(got, sizeof got, "%s", swarf_error_last());
    /* an error is wanted by a part of its text, moves by all of it */
    const int ok = status == SWARF_OK ? strcmp(got, wanted) == 0 : strstr(got, wanted) != NULL && *wanted != 0;
    if (!test_check(ok && (status == SWARF_OK || status == SWARF_ERROR_FORMAT), file, line, text))
        fprintf(stderr, "  wanted: %s\n  got:    %s\n", wanted, got);
    swarf_program_release(program);
}

#define IS(text, wanted)                                                                                               \
    do {                                                                                                               \
        const swarf_gcode_options options_ = options_for(SWARF_DIALECT_LINUXCNC, 0);                                   \
        check_with(&options_, text, wanted, __FILE__, __LINE__);                                                       \
    } while (0)
#define IS_WITH_TABLE(text, wanted)                                                                                    \
    do {                                                                                                               \
        const swarf_gcode_options options_ = options_for(SWARF_DIALECT_LINUXCNC, 1);                                   \
        check_with(&options_, text, wanted, __FILE__, __LINE__);                                                       \
    } while (0)
#define IS_IN(dialect, text, wanted)                                                                                   \
    do {                                                                                                               \
        const swarf_gcode_options options_ = options_for(dialect, 0);                                                  \
        check_with(&options_, text, wanted, __FILE__, __LINE__);                                                       \
    } while (0)

static void test_feeds(void)
{
    IS("G1 X1", "'G1' has no feed");
    IS("F100 G1 X1\nG20\nX2", "f1,0,10@100 f50.8,0,10@100");
    IS("G20 F10 G1 X1", "f25.4,0,10@10"); /* F comes before units in the order of execution */
    IS("G93 G1 X3 F2\nY4 F.5\nG94 F7 X0", "f3,0,10@6 f3,4,10@2 f0,4,10@7");
    IS("G93 G1 X3 F2\nY4", "t:2:1: error: 'Y4' needs F in its own line under G93");
    IS("F5 G1 X1\nG95 X2", "has no feed");
    IS("G95 F.5 S100 G1 X1", "f1,0,10@50");
    IS("G95 F.5 G1 X1", "no speed");
    IS("G93 G3 X-10 Y10 I-10 F1", "a90(-10,0,10)-10,10,10");
    IS("G96 S100 M3\nG97 S50\nG0 X1", "r1,0,10");
    IS("G96 M3", "needs S");
}

static void test_offsets(void)
{
    /* the frame is the work offset of the first motion; the machine stands still when offsets change */
    IS("G10 L2 P1 X5 Y5\nG0 X1 Y1 Z1\nG10 L2 P2 X15 Y5\nG55 G0 X1", "P-5,-5,10 r1,1,1 r11,1,1");
    IS("G0 X1 Y1 Z1\nG10 L20 P1 X0 Y0\nX1", "r1,1,1 r2,1,1");
    IS("G0 X1 Y1 Z1\nG10 L2 P1 X0 Y0 R90\nX5 Y0\nX0 Y5", "r1,1,1 r0,5,1 r-5,0,1");
    IS("G0 X10 Y0 Z0\nG10 L2 P1 R90\nF9 G2 X0 Y0 I5 J-5", "arc: the radius");
    IS("G0 X10 Y0 Z0\nG10 L2 P1 R90\nF9 G3 X10 Y0 I5 J5", "r10,0,0 a180(5,5,0)0,10,0");
    IS("G10 L2 P1 R90\nG0 X0 Y0\nG10 L2 P1 R45\nF1 G18 G2 X1 Z10 I.5", "a rotation of X and Y turns");
    IS("G0 X1 Y2 Z3\nG92 X0 Y0\nG0 X1\nG92.1\nX1", "r1,2,3 r2,2,3 r1,2,3");
    IS("G0 X1\nG92 X0\nG92.2\nG0 X5\nG92.3\nG0 X5", "r1,0,10 r5,0,10 r6,0,10");
    IS("G52 X10\nG0 X1\nG52 X0\nG0 X1", "r11,0,10 r1,0,10");
    IS("G92", "needs the coordinates");
    IS("G92 X1 G1 X2", "second X");
    IS("G92 X1 G0", "'G0' shares the line with another code that takes axis words");
    IS("G10 L3 P1", "'L3' is nothing that G10 sets");
    IS("G10 L2 X1", "needs P");
    IS("G10 L2 P10", "'P10' must be a whole number from 0 to 9");
    IS("G59.3 G0 X1\nG53 G0 X2", "r1,0,10 Pnan,0,10");
    /* home: unknown unless told */
    IS("G28.1\nG0 X5 Y5\nG28 X6", "r5,5,10 r6,5,10 r0,5,10");
    IS("G30.1 G0 X5\nG30", "r5,0,10 r0,0,10");
    IS("G1 F1 X1 G53 G2 I1", "of one modal group");
    IS("G2 F1 I1\nG53 X3", "moves in machine coordinates by G0 or G1 only");
}

static void test_lengths(void)
{
    IS("T1 M6\nG43\nG0 Z5\nG49 Z6", "t1 r0,0,5 r0,0,6"); /* no table: the tip is what is programmed */
    IS("T1 M6 G43.1 Z20\nG0 Z5", "t1 P0,0,-10 r0,0,5");
    IS_WITH_TABLE("T1 M6 G43\nG0 Z5", "t1 P0,0,0 r0,0,5"); /* the tip is 10 below the spindle */
    IS_WITH_TABLE("T1 M6 G43 H2\nG0 Z5", "t1 P0,0,0 r0,0,15");
    IS_WITH_TABLE("T1 M6 G43\nG43.2 H2\nG0 Z5", "t1 P0,0,0 r0,0,25");
    IS_WITH_TABLE("T1 M6 G43\nG43.2 Z1\nG0 Z5", "t1 P0,0,0 r0,0,6");
    IS_WITH_TABLE("T3 M6 G43\nG0 X0 Y0 Z5", "t3 P-1,-2,-20 r0,0,5");
    IS_WITH_TABLE("T1 M6\nG0 Z5", "t1 P0,0,0 r0,0,-5"); /* as the machine would: nobody asked for the length */
    IS_WITH_TABLE("G43 H9", "'H9' names tool T9, which is not in the tool table");
    IS_WITH_TABLE("T9 M6", "not in the tool table");
    IS_WITH_TABLE("T1 M6\nG10 L1 P1 Z15\nG43 G0 Z5", "t1 P0,0,-5 r0,0,5");
    IS_WITH_TABLE("T1 M6\nG0 Z0\nG10 L10 P1 Z-3\nG43 G0 Z5\n(3 long)", "t1 P0,0,0 r0,0,-10 P0,0,-3 r0,0,5");
    IS_WITH_TABLE("M61 Q2\nG43 G0 Z5", "P0,0,-10 r0,0,5");
    IS("G43.2 Z1 H1", "needs H, a tool's number, or axis words, not both");
}

static void test_cycles(void)
{
    IS("F9 G81 X1 Z-1 R1", "r1,0,10 r1,0,1 f1,0,-1@9 r1,0,1"); /* G99 is LinuxCNC's start */
    IS("F9 G81 X1 Z-1 R1\nG73 X2 Z-1 Q1", "'G73' starts a cycle that needs R");
    IS("F9 S5 M3 G84 X1 Z-1 R1 P2", "r1,0,10 r1,0,1 f1,0,-1@9 d2 f1,0,1@9");
    IS("F9 S5 M4 G74 X1 Z-1 R1", "r1,0,10 r1,0,1 f1,0,-1@9 f1,0,1@9");
    IS("F9 S5 M3 G98 G86 X1 Z-1 R1 P.5", "r1,0,10 r1,0,1 f1,0,-1@9 d0.5 r1,0,10");
    IS("F9 G86 X1 Z-1 R1 P.5", "bores with a turning spindle");
    IS("F9 G98 G85 X1 Z-1 R1\nG89 X2 Z-1 R1 P1",
       "r1,0,10 r1,0,1 f1,0,-1@9 f1,0,1@9 r1,0,10 r2,0,10 r2,0,1 f2,0,-1@9 d1 f2,0,10@9");
    IS("F9 G83 Z-1 R1 Q1 D.1", "r0,0,1 f0,0,0@9 r0,0,1 r0,0,0.1 f0,0,-1@9 r0,0,1");
    IS("F9 G19 G82 X-5 R0 P1", "f-5,0,10@9 d1 r0,0,10");
    IS("F9 G81 X1 Z-1 R1 A5", "'A5' does not belong to a cycle");
    IS("G93 F9 G81 X1 Z-1 R1", "cannot be under G93");
}

static void test_splines(void)
{
    swarf_program *program = NULL;
    const swarf_gcode_options options = options_for(SWARF_DIALECT_LINUXCNC, 0);
    /* LinuxCNC's example, a parabola y = x^2 from -2 to 2: each chord's middle strays by (dx / 2)^2 at most 0.001 */
    const char text[] = "G0 X-2 Y4\nF9 G5.1 X2 I2 J-8";
    CHECK_OK(swarf_gcode_read(text, strlen(text), "t", &options, NULL, &program));
    const size_t count = swarf_program_move_count(program);
    CHECK(count > 30 && count < 100);
    double last = -2;
    for (size_t i = 1; i < count; i++) {
        const double *e = swarf_program_moves(program)[i].end;
        CHECK_NEAR(e[1], e[0] * e[0], 1e-12);
        CHECK(e[0] > last && 0.25 * (e[0] - last) * (e[0] - last) <= 0.001);
        last = e[0];
    }
    CHECK(last == 2);
    swarf_program_release(program);
    program = NULL;
    /* a cubic with even control points is a straight line */
    const char straight[] = "F9 G5 X3 Y3 I1 J1 P-1 Q-1\nG5 X6 Y6 P-1 Q-1";
    CHECK_OK(swarf_gcode_read(straight, strlen(straight), "t", &options, NULL, &program));
    CHECK(swarf_program_move_count(program) == 2);
    swarf_program_release(program);
    IS("F9 G5 X3 P1 Q1", "needs I and J");
    IS("F9 G5 X3 I1 J1 P1", "needs P and Q");
    IS("F9 G5 X3 Z1 I1 J1 P1 Q1", "'Z1' does not belong to a spline");
    IS("F9 G18 G5.1 X1 I1", "G17");
    IS("F9 G5.1 X1", "needs I or J");
}

static void test_synchronized_and_probe(void)
{
    IS("S100 M3 G33 Z0 K1.5", "f0,0,0@150");
    IS("S100 M3 G33.1 Z0 K1 I2", "f0,0,0@100 f0,0,10@200");
    IS("S100 M3 F5 G33 Z0 K1", "'F5' has no meaning here");
    IS("S100 G33 Z0 K1", "needs a turning spindle");
    IS("S100 M3 G33 Z0", "needs K");
    IS("F9 G38.2 Z0\n#1=#5063 G0 X#1 Y#5070", "p0,0,0 r0,1,0");
    IS("F9 G38.2 Z0\nG0 X[#5063+7] Y#5070", "p0,0,0 r7,1,0");
    IS("F9 G38.3 Z10", "probes to where the tool stands");
    IS("G38.3 Z1", "has no feed");
}

static void test_compensation(void)
{
    /* the same programs by LinuxCNC 2.9's rs274 give these moves */
    IS("F9 G0 Z0\nG42.1 D2\nG1 X10\nX20\nY10\nX10\nG40\nG0 X0 Y0",
       "r0,0,0 f10,-1,0@9 f20,-1,0@9 a90(20,0,0)21,0,0 f21,10,0@9 a90(20,10,0)20,11,0 f10,11,0@9 r0,0,0");
    IS("F9 G0 Z0\nG41.1 D2\nG1 X10\nX20\nY10\nX10\nG40\nG0 X0 Y0",
       "r0,0,0 f10,1,0@9 f19,1,0@9 f19,9,0@9 f10,9,0@9 r0,0,0");
    IS("F9 G0 Z0\nG41.1 D2\nG1 X10\nG3 X20 Y10 J10\nG1 Y20\nG40 G0 X0 Y0",
       "r0,0,0 f10,1,0@9 a90(10,10,0)19,10,0 f19,20,0@9 r0,0,0");
    IS("F9 G0 Z0\nG42.1 D2\nG2 X10 R8\nX20 I5\nG40 G0 X0 Y0",
       "r0,0,0 a-67.8447(4.10714,-7.36018,0)9.375,-0.78062,0 a128.682(10,0,0)11,0,0 a-180(15,0,0)19,0,0 r0,0,0");
    IS("F9 G0 Z0\nG41.1 D2\nG1 X10\nX20\nG4 P1\nZ-1\nY20\nG40 G0 X0 Y0 Z9",
       "r0,0,0 f10,1,0@9 f19,1,0@9 d1 f19,1,-1@9 f19,20,-1@9 r0,0,9");
    IS("F9 G0 Z0\nG41.1 D2\nG1 X10\nX20\nG2 X30 Y10 I10\nG3 X40 Y0 J-10\nG1 X50\nM2",
       "r0,0,0 f10,1,0@9 f19.0455,1,0@9 a-84.7841(30,0,0)30,11,0 a-180(30,10,0)30,9,0 a270(30,0,0)39,0,0 "
       "a-90(40,0,0)40,1,0 f50,1,0@9");
    IS_WITH_TABLE("T1 M6 F9\nG41\nG1 X10\nX20\nY20\nG40 G0 X0 Y0", "t1 P0,0,0 f10,3,0@9 f17,3,0@9 f17,20,0@9 r0,0,0");
    IS_WITH_TABLE("G41 D2 F9\nG1 X10\nX20\nM2", "f10,2,10@9 f20,2,10@9");
    IS("F9 G18 G41.1 D2\nG1 X10 \nX20\nZ-20\nM2", "f10,0,9@9 f19,0,9@9 f19,0,-20@9");
    /* a way back that bends by less than 0.05 rad from straight goes around the corner, to whichever side */
    IS("F9 G0 Z0\nG42.1 D2\nG1 X10\nX20\nX10 Y.3\nM2",
       "r0,0,0 f10,-1,0@9 f20,-1,0@9 a178.282(20,0,0)20.03,0.99955,0 f10.03,1.29955,0@9");
    IS("F9 G41.1 D2\nG1 X1", "leads in over 1 mm; it must be longer than the radius");
    IS("F9 G41.1 D8\nG1 X10\nX12 Y.5\nX5 Y10", "cannot reach without gouging");
    IS("F9 G42.1 D30\nG1 X20\nG2 X30 Y10 I10", "does not fit");
    IS("F9 G41.1 D2\nG1 X10\nG40 G2 X0 R50", "must be straight");
    IS("G41.1 D2\nG42.1 D2", "while it is on");
    IS("G41.1 D2\nG55", "cannot be under cutter compensation");
    IS("G41.1 D2\nG28", "cannot be under cutter compensation");
    IS("G41.1", "needs D");
    IS("G19 G41.1 D1", "does not work in the plane YZ");
}

static void test_states(void)
{
    IS("F9 G91\nM70\nG90 G0 X5\nM72\nG0 X1", "r5,0,10 r6,0,10");
    IS("M72", "was not saved");
    IS("M66 P0 L0\nG0 X#5399", "r0,0,10");
    IS("M62 P1 M67", "of one modal group");
    IS("M19 R90\nM48\nM50 P0\nM60\nG0 X1", "r1,0,10");
    IS("M101 P1\nG0 X1", "r1,0,10");
    IS("G61\nG64 P.1 Q.2\nG61.1 G0 X1", "r1,0,10");
    IS("G0 A90 X1", "r1,0,10");
}

static void test_axes(void)
{
    swarf_program *program = NULL;
    const swarf_gcode_options options = options_for(SWARF_DIALECT_LINUXCNC, 0);
    const char text[] = "G0 X1\nA90 W2\nX2\nF9 G1 A0 W0\nX3";
    CHECK_OK(swarf_gcode_read(text, strlen(text), "t", &options, NULL, &program));
    CHECK(swarf_program_move_count(program) == 5 && swarf_program_axes_count(program) == 2);
    static const double at_start[5] = {0, 0, 90, 90, 0}, at_end[5] = {0, 90, 90, 0, 0};
    for (size_t i = 0; i < 5; i++) {
        double from[6], to[6];
        CHECK(swarf_program_move_axes(program, i, from, to) == (at_start[i] != 0 || at_end[i] != 0));
        CHECK(from[0] == at_start[i] && to[0] == at_end[i] && to[5] == at_end[i] / 45);
    }
    swarf_program_release(program);
}

static void test_dialects(void)
{
    IS_IN(SWARF_DIALECT_GRBL, "X1 Y2\n$H\nG1 F5 Z0", "r1,2,10 f1,2,0@5"); /* G0 at the start */
    IS_IN(SWARF_DIALECT_GRBL, "G81 X1 Z0 R1", "(dialect grbl)");
    IS_IN(SWARF_DIALECT_GRBL, "G0 X#1", "parameters are not read in this dialect");
    IS_IN(SWARF_DIALECT_FANUC, "G0 X1000 Y1. Z5.", "r1,1,5"); /* thousandths without a point */
    IS_IN(SWARF_DIALECT_FANUC, "G20 G0 X10000 Y1. Z0", "r25.4,25.4,0");
    IS_IN(SWARF_DIALECT_FANUC, "G4 P500\nG4 X1.5", "d0.5 d1.5");
    IS_IN(SWARF_DIALECT_FANUC, "F9. G91 G99 G81 X1. Z-2. R-9. K2",
          "r1,0,10 r1,0,1 f1,0,-1@9 r1,0,1 r2,0,1 f2,0,-1@9 r2,0,1");
    IS_IN(SWARF_DIALECT_FANUC, "G68 X0 Y0 R90.\nG0 X5. Y0\nG69\nX5.", "r0,5,10 r5,5,10");
    IS_IN(SWARF_DIALECT_MACH3, "G0 X10 Y0\nG68 A0 B0 R90\nG0 X5 Y0\nG69\nX5", "r10,0,10 r0,5,10 r5,5,10");
    IS_IN(SWARF_DIALECT_MACH3, "G51 X2 Y2\nG0 X5 Y1\nF9 G3 X5 Y3 J1\nG50 G1 X5",
          "r10,2,10 a180(10,4,10)10,6,10 f5,6,10@9");
    IS_IN(SWARF_DIALECT_MACH3, "G51 X-1\nG0 X5 Y1\nF9 G3 X5 Y3 J1", "r-5,1,10 a-180(-5,2,10)-5,3,10");
    IS_IN(SWARF_DIALECT_MACH3, "G51 X2\nG0 X5 Y1\nF9 G3 X5 Y3 J1", "unequal scales");
    IS_IN(SWARF_DIALECT_FANUC, "O7\nM98 P8 L2\nM30\nO8\nG91 G0 X1.\nM99", "r1,0,10 r2,0,10");
}

int main(void)
{
    test_feeds();
    test_offsets();
    test_lengths();
    test_cycles();
    test_splines();
    test_synchronized_and_probe();
    test_compensation();
    test_states();
    test_axes();
    test_dialects();
    return test_end();
}
