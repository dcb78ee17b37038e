/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code: arcs in the three planes and canned cycles, every form and every refusal. */
#include "gcode.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* The only arc of a program that first goes to (10, 0, 10). */
static swarf_path arc_of(const char *line)
{
    char text[200];
    snprintf(text, sizeof text, "G0 X10 Y0\n%s", line);
    swarf_program *program = gcode_read_ok(text);
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
    gcode_expect("G2 X2 I1\nX4 I1\nX5 Y1 R1", "aaa", 2.0, 0.0, 10.0, 4.0, 0.0, 10.0, 5.0, 1.0, 10.0);
    gcode_expect("G2\nI1", "a", 0.0, 0.0, 10.0);

    gcode_refuse("G2 X10", "part.nc:1:1: error: 'G2' arc needs a centre by I or J, or R");
    gcode_refuse("G90.1 G2 X10 I5", "arc needs a centre by I and J (both under G90.1), or R");
    gcode_refuse("G2 X10 I4", "'G2' arc: the radius is 4 mm at the start but 6 mm at the end");
    CHECK(strstr(swarf_error_last(), "I5 J0 would fit") != NULL);
    gcode_refuse("G2 X10 R4",
                 "part.nc:1:8: error: 'R4' is too small: the ends are 10 mm apart, so R must be at least 5");
    gcode_refuse("G20 G2 X10 R4", "so R must be at least 5");
    gcode_refuse("G2 X0 Y0 R5", "makes no arc between equal points");
    gcode_refuse("G2 R5", "'R5' needs an end: X or Y");
    gcode_refuse("G2 X5 R0", "must not be 0");
    gcode_refuse("G2 X5 R5 I2", "an arc takes one of them");
    gcode_refuse("G2 X5 I2.5 K1", "'K1' is not used");
    gcode_refuse("G18 G2 X5 J2.5", "arc needs a centre by K or I");
    gcode_refuse("G2 I0", "the radius is 0 mm");
    gcode_refuse("G2 I1 P0", "'P0' must be a whole number from 1 to 10000");
    gcode_refuse("G2 I1 P1.5", "must be a whole number");
}

static void test_cycles(void)
{
    const double n = 10; /* initial height */
    gcode_expect("G81 X1 Y2 Z-3 R1", "rrfr", 1.0, 2.0, n, 1.0, 2.0, 1.0, 1.0, 2.0, -3.0, 1.0, 2.0, n);
    gcode_expect("G99 G81 X1 Y2 Z-3 R1", "rrfr", 1.0, 2.0, n, 1.0, 2.0, 1.0, 1.0, 2.0, -3.0, 1.0, 2.0, 1.0);
    gcode_expect("G82 X1 Z-3 R1 P.5", "rrfdr", 1.0, 0.0, n, 1.0, 0.0, 1.0, 1.0, 0.0, -3.0, 1.0, 0.0, -3.0, 1.0, 0.0, n);
    gcode_expect("G85 X1 Z-3 R1", "rrffr", 1.0, 0.0, n, 1.0, 0.0, 1.0, 1.0, 0.0, -3.0, 1.0, 0.0, 1.0, 1.0, 0.0, n);
    gcode_expect("G89 X1 Z-3 R1 P.5", "rrfdf", 1.0, 0.0, n, 1.0, 0.0, 1.0, 1.0, 0.0, -3.0, 1.0, 0.0, -3.0, 1.0, 0.0, n);
    gcode_expect("G83 Z-3 R1 Q2", "rfrrfr", 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, -0.746, 0.0, 0.0,
                 -3.0, 0.0, 0.0, n);
    gcode_expect("G73 Z-3 R1 Q2", "rfrfr", 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, -0.746, 0.0, 0.0, -3.0, 0.0, 0.0,
                 n);
    /* modal: place, depth, R and Q stay; G98 returns to where the series began, whatever G99 did between */
    gcode_expect("G99 G81 X1 Z-3 R1\nX2\nG98 X3\nG80\nG0 X4",
                 "rrfr"
                 "rfr"
                 "rfr"
                 "r",
                 1.0, 0.0, n, 1.0, 0.0, 1.0, 1.0, 0.0, -3.0, 1.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 0.0, -3.0, 2.0, 0.0,
                 1.0, 3.0, 0.0, 1.0, 3.0, 0.0, -3.0, 3.0, 0.0, n, 4.0, 0.0, n);
    /* R above the tool: up first; G98 then returns to R */
    gcode_expect("G81 X1 Z-3 R12", "rrfr", 0.0, 0.0, 12.0, 1.0, 0.0, 12.0, 1.0, 0.0, -3.0, 1.0, 0.0, 12.0);
    /* G91: steps repeat, R from the initial height, Z from R */
    gcode_expect("G91 G99 G81 X1 Y2 Z-5 R-9 L2",
                 "rrfr"
                 "rfr",
                 1.0, 2.0, n, 1.0, 2.0, 1.0, 1.0, 2.0, -4.0, 1.0, 2.0, 1.0, 2.0, 4.0, 1.0, 2.0, 4.0, -4.0, 2.0, 4.0,
                 1.0);
    gcode_expect("G81 Z-3 R1 L2",
                 "rfr"
                 "rfr",
                 0.0, 0.0, 1.0, 0.0, 0.0, -3.0, 0.0, 0.0, n, 0.0, 0.0, 1.0, 0.0, 0.0, -3.0, 0.0, 0.0, n);
    /* along the plane's normal; in inches */
    gcode_expect("G18 G81 X1 Y-3 R-1", "rrfr", 1.0, 0.0, n, 1.0, -1.0, n, 1.0, -3.0, n, 1.0, 0.0, n);
    gcode_expect("G20 G81 Z-.1 R.1", "rfr", 0.0, 0.0, 2.54, 0.0, 0.0, -2.54, 0.0, 0.0, n);

    gcode_refuse("G81 X1 R1", "'G81' starts a cycle that needs Z, the bottom of the hole");
    gcode_refuse("G81 X1 Z-1", "needs R");
    gcode_refuse("G83 X1 Z-1 R1", "needs Q");
    gcode_refuse("G82 X1 Z-1 R1", "needs P");
    gcode_refuse("G81 Z-1 R1 Q1", "'Q1' is not used");
    gcode_refuse("G83 X1 Z-1 R1 Q0", "'Q0' must be positive");
    gcode_refuse("G81 X1 Z2 R1", "R must be above Z");
    gcode_refuse("G81 X1 Z-1 R1 L0", "'L0' must be a whole number from 1");
    gcode_refuse("G83 X1 Z-100 R1 Q0.0001", "more than 100000 pecks");
    gcode_refuse("G81 R1", "without a place");
    gcode_refuse("G81 X1 Z-1 R1\nG0 X2\nG81 X3", "part.nc:3:1: error: 'G81' starts a cycle that needs Z");
    gcode_refuse("G81 X1 Z-1 R1\nG18 X2", "needs Y");
}

int main(void)
{
    test_arcs();
    test_cycles();
    return test_end();
}
