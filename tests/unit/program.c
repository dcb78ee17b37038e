/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Programs: what is kept of moves, arcs in closed form and by their laws, every refusal. */
#include "test.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static void axes_of(swarf_plane plane, int axes[3])
{
    static const int table[3][3] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}};
    for (int i = 0; i < 3; i++) axes[i] = table[plane][i];
}

static swarf_program *begin(double x, double y, double z)
{
    const double start[3] = {x, y, z};
    swarf_program *program = NULL;
    CHECK_OK(swarf_program_create(start, &program));
    return program;
}

static swarf_path path_of(const swarf_program *program, size_t index)
{
    swarf_path path = {.has_motion = -1};
    CHECK_OK(swarf_program_path(program, index, &path));
    return path;
}

static void check_point(const swarf_path *path, double t, double x, double y, double z, double tolerance)
{
    double p[3];
    swarf_path_point(path, t, p);
    CHECK_NEAR(p[0], x, tolerance);
    CHECK_NEAR(p[1], y, tolerance);
    CHECK_NEAR(p[2], z, tolerance);
}

static void test_lines(void)
{
    CHECK(sizeof(swarf_move) == 40);
    swarf_program *program = begin(0, 0, 10);
    CHECK(swarf_program_move_count(program) == 0 && swarf_program_section_count(program) == 0);
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, (double[3]){3, 4, 10}, 777, 1));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, (double[3]){3, 4, -2}, 120, 2));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, (double[3]){3, 4, -2}, 120, 3));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, (double[3]){3, 4, -2}, 0, 4));
    CHECK_OK(swarf_program_add_event(program, SWARF_MOVE_DWELL, 1.5, 5));
    CHECK_OK(swarf_program_add_event(program, SWARF_MOVE_TOOL_CHANGE, 0, 6));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_PROBE, (double[3]){3, 4, -3}, 60, 7));
    CHECK(swarf_program_move_count(program) == 7);
    static const swarf_move_kind kinds[] = {SWARF_MOVE_RAPID, SWARF_MOVE_FEED,        SWARF_MOVE_FEED, SWARF_MOVE_RAPID,
                                            SWARF_MOVE_DWELL, SWARF_MOVE_TOOL_CHANGE, SWARF_MOVE_PROBE};
    static const int motion[] = {1, 1, 1, 0, 0, 0, 1};
    const swarf_move *moves = swarf_program_moves(program);
    for (size_t i = 0; i < 7; i++) {
        CHECK(swarf_move_get_kind(&moves[i]) == kinds[i]);
        CHECK(moves[i].line == i + 1 && moves[i].arc == -1);
        CHECK(path_of(program, i).has_motion == motion[i]);
        double start[3];
        swarf_program_move_start(program, i, start);
        CHECK(i ? memcmp(start, moves[i - 1].end, sizeof start) == 0 : start[2] == 10.0);
    }
    CHECK(moves[0].feed_mm_min == 0.0f && moves[1].feed_mm_min == 120.0f && moves[4].feed_mm_min == 1.5f);
    CHECK_NEAR(swarf_program_seconds(program, 300), 60 * (5 / 300.0 + 12 / 120.0 + 1 / 60.0) + 1.5, 1e-12);
    CHECK_NEAR(swarf_program_seconds(program, 0), 60 * (12 / 120.0 + 1 / 60.0) + 1.5, 1e-12);
    const swarf_path path = path_of(program, 0);
    CHECK_NEAR(swarf_path_length(&path), 5, 1e-15);
    check_point(&path, 0.5, 1.5, 2, 10, 1e-15);
    CHECK(swarf_program_operation_count(program) == 1);
    CHECK(strcmp(swarf_program_operation_name(program, 0), "program") == 0);
    CHECK(swarf_program_retain(program) == program);
    swarf_program_release(program);
    CHECK(swarf_program_move_count(program) == 7);
    swarf_program_release(program);
}

static void test_unknown(void)
{
    swarf_program *program = NULL;
    CHECK_OK(swarf_program_create(NULL, &program));
    CHECK_FAILS(swarf_program_add_arc(program, (double[3]){1, 0, 0}, (double[3]){0, 0, 0}, SWARF_PLANE_XY, 1, 1, 1, 9),
                SWARF_ERROR_ARGUMENT, "line 9: arc: starts at an unknown position");
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, (double[3]){NAN, NAN, 5}, 100, 1));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, (double[3]){1, 2, 5}, 100, 2));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, (double[3]){1, 2, 0}, 100, 3));
    CHECK_FAILS(swarf_program_add_line(program, SWARF_MOVE_FEED, (double[3]){NAN, 2, 0}, 100, 4), SWARF_ERROR_ARGUMENT,
                "line 4: X is not finite");
    const swarf_move *moves = swarf_program_moves(program);
    CHECK(swarf_program_move_count(program) == 3);
    CHECK(isnan(moves[0].end[0]) && isnan(moves[0].end[1]) && moves[0].end[2] == 5.0);
    static const swarf_move_kind kinds[] = {SWARF_MOVE_POSITION, SWARF_MOVE_POSITION, SWARF_MOVE_FEED};
    for (size_t i = 0; i < 3; i++) {
        CHECK(swarf_move_get_kind(&moves[i]) == kinds[i]);
        CHECK(path_of(program, i).has_motion == (i == 2));
    }
    CHECK_NEAR(swarf_program_seconds(program, 1000), 60 * 5 / 100.0, 1e-12);
    swarf_program_release(program);

    /* an arc at an unknown height is a way to its end */
    CHECK_OK(swarf_program_create((double[3]){1, 0, NAN}, &program));
    CHECK_OK(swarf_program_add_arc(program, (double[3]){-1, 0, NAN}, (double[3]){0, 0, 0}, SWARF_PLANE_XY, 1, 1, 1, 1));
    CHECK(swarf_program_arc_count(program) == 0);
    CHECK(swarf_move_get_kind(swarf_program_moves(program)) == SWARF_MOVE_POSITION);
    swarf_program_release(program);
}

static void test_sections(void)
{
    swarf_program *program = begin(0, 0, 0);
    swarf_section section = {.tool = 1, .operation = 0, .spindle = SWARF_SPINDLE_CW, .spindle_rpm = 1000};
    CHECK_FAILS(swarf_program_set_section(program, &section), SWARF_ERROR_ARGUMENT, "operation 0");
    CHECK_OK(swarf_program_add_operation(program, "Pocket"));
    CHECK_OK(swarf_program_add_operation(program, "Drill"));
    section.operation = 1;
    CHECK_OK(swarf_program_set_section(program, &section));
    section.operation = 2;
    CHECK_FAILS(swarf_program_set_section(program, &section), SWARF_ERROR_ARGUMENT, "operation 2");
    section.operation = -1;
    CHECK_FAILS(swarf_program_set_section(program, &section), SWARF_ERROR_ARGUMENT, "operation -1");
    section.operation = 0;
    const double bad[] = {NAN, INFINITY, -1};
    for (int i = 0; i < 3; i++) {
        section.spindle_rpm = bad[i];
        CHECK_FAILS(swarf_program_set_section(program, &section), SWARF_ERROR_ARGUMENT, "spindle speed");
    }
    /* a thousand sections used again and again stay a thousand, each with its own values */
    for (int round = 0; round < 3; round++)
        for (int i = 0; i < 1000; i++) {
            section = (swarf_section){.tool = i % 10, .operation = i % 2, .spindle_rpm = i};
            CHECK_OK(swarf_program_set_section(program, &section));
            CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, (double[3]){i, 0, 0}, 1, (uint32_t)i));
        }
    CHECK(swarf_program_section_count(program) == 1000);
    for (size_t i = 0; i < 3000; i++) {
        const swarf_move *move = &swarf_program_moves(program)[i];
        const swarf_section *got = &swarf_program_sections(program)[swarf_move_get_section(move)];
        CHECK(got->spindle_rpm == move->end[0] && got->tool == (int)move->end[0] % 10);
    }
    CHECK(strcmp(swarf_program_operation_name(program, 1), "Drill") == 0);
    CHECK(swarf_program_operation_name(program, 2) == NULL);
    swarf_program_release(program);
}

/* Quarter, three-quarter and full turns in each plane: seen against the normal, ccw leads from first to second axis. */
static void test_arcs_closed_form(void)
{
    for (int plane = 0; plane < 3; plane++) {
        int axes[3];
        axes_of((swarf_plane)plane, axes);
        double start[3] = {0}, end[3] = {0}, p[3];
        const double centre[3] = {0};
        start[axes[0]] = 2;
        end[axes[1]] = 2;
        end[axes[2]] = 3;
        swarf_program *program = begin(start[0], start[1], start[2]);
        CHECK_OK(swarf_program_add_arc(program, end, centre, (swarf_plane)plane, 1, 1, 60, 1)); /* 90 degrees */
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, start, 0, 2));
        CHECK_OK(swarf_program_add_arc(program, end, centre, (swarf_plane)plane, 0, 1, 60, 3)); /* 270 back */
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, start, 0, 4));
        CHECK_OK(swarf_program_add_arc(program, end, centre, (swarf_plane)plane, 1, 3, 60, 5)); /* 2.25 turns */
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, start, 0, 6));
        CHECK_OK(swarf_program_add_arc(program, start, centre, (swarf_plane)plane, 0, 1, 60, 7)); /* full circle */
        const double angles[] = {0.5 * pi, -1.5 * pi, 4.5 * pi, -2 * pi}, rises[] = {3, 3, 3, 0};
        double seconds = 0;
        for (size_t i = 0; i < 4; i++) {
            const swarf_path path = path_of(program, 2 * i);
            CHECK(path.is_arc && path.has_motion && path.arc.plane == plane);
            CHECK_NEAR(path.arc.angle_rad, angles[i], 1e-14);
            CHECK_NEAR(path.arc.centre[axes[2]], 0, 0);
            CHECK_NEAR(swarf_path_length(&path), hypot(2 * angles[i], rises[i]), 1e-12);
            seconds += hypot(2 * angles[i], rises[i]);
            for (int k = 1; k < 8; k++) {
                swarf_path_point(&path, k / 8.0, p);
                CHECK_NEAR(p[axes[0]], 2 * cos(angles[i] * k / 8), 1e-12);
                CHECK_NEAR(p[axes[1]], 2 * sin(angles[i] * k / 8), 1e-12);
                CHECK_NEAR(p[axes[2]], rises[i] * k / 8, 1e-12);
            }
        }
        CHECK_NEAR(swarf_program_seconds(program, 0), seconds, 1e-4);
        CHECK(swarf_program_arc_count(program) == 4);
        swarf_program_release(program);
    }
}

/* Laws on random arcs whose centre and end are rounded as in files. */
static void test_arcs_random(void)
{
    test_random random = test_random_begin(7);
    for (int n = 0; n < 20000; n++) {
        const swarf_plane plane = (swarf_plane)test_random_below(&random, 3);
        int axes[3];
        axes_of(plane, axes);
        const double radius = exp(test_random_in(&random, log(0.05), log(500)));
        const double from = test_random_in(&random, -pi, pi), turn = test_random_in(&random, 0.001, 2 * pi);
        const double step = n % 2 ? 1e-3 : 1e-4;
        const int ccw = (int)test_random_below(&random, 2);
        double start[3], end[3], centre[3], p[3];
        for (int k = 0; k < 3; k++) centre[k] = test_random_in(&random, -100, 100);
        const double to = ccw ? from + turn : from - turn;
        start[axes[0]] = centre[axes[0]] + radius * cos(from), start[axes[1]] = centre[axes[1]] + radius * sin(from);
        end[axes[0]] = centre[axes[0]] + radius * cos(to), end[axes[1]] = centre[axes[1]] + radius * sin(to);
        start[axes[2]] = test_random_in(&random, -9, 9), end[axes[2]] = test_random_in(&random, -9, 9);
        double chord = 0;
        for (int k = 0; k < 3; k++) {
            start[k] = step * round(start[k] / step);
            end[k] = step * round(end[k] / step);
            if (k != axes[2]) chord = hypot(chord, end[k] - start[k]);
        }
        if (chord < 4 * step) continue; /* rounding decides between no turn and a whole one */
        swarf_program *program = begin(start[0], start[1], start[2]);
        CHECK_OK(swarf_program_add_arc(program, end, centre, plane, ccw, 1, 100, 1));
        const swarf_path path = path_of(program, 0);
        swarf_path_point(&path, 0, p);
        CHECK(memcmp(p, start, sizeof p) == 0);
        swarf_path_point(&path, 1, p);
        CHECK(memcmp(p, end, sizeof p) == 0);
        CHECK((path.arc.angle_rad > 0) == ccw && fabs(path.arc.angle_rad) <= 2 * pi + 1e-12);
        /* the formula runs into the ends without a step, and every point is on the circle that was meant */
        swarf_path_point(&path, 1 - 1e-12, p);
        for (int k = 0; k < 3; k++) CHECK_NEAR(p[k], end[k], 1e-7);
        for (int i = 1; i < 6; i++) {
            swarf_path_point(&path, i / 6.0, p);
            const double meant = from + (to - from) * i / 6;
            const double off = hypot(p[axes[0]] - centre[axes[0]], p[axes[1]] - centre[axes[1]]) - radius;
            CHECK_NEAR(off, 0, 4 * step);
            CHECK_NEAR(hypot(p[axes[0]] - centre[axes[0]] - radius * cos(meant),
                             p[axes[1]] - centre[axes[1]] - radius * sin(meant)),
                       0, 8 * step + 0.02 * radius);
        }
        /* up to half a turn, a true circle through both ends */
        const double r0 = hypot(start[axes[0]] - path.arc.centre[axes[0]], start[axes[1]] - path.arc.centre[axes[1]]);
        const double r1 = hypot(end[axes[0]] - path.arc.centre[axes[0]], end[axes[1]] - path.arc.centre[axes[1]]);
        if (turn < 3.1 && chord > 0.02) CHECK_NEAR(r0, r1, 2e-9 + 1e-12 * radius);
        swarf_program_release(program);
    }
}

static void test_refusals(void)
{
    swarf_program *program = begin(10, 0, 0);
    const double o[3] = {0, 0, 0}, quarter[3] = {0, 10, 0}, off[3] = {0, 10.011, 0}, just[3] = {0, 10.0099, 0};
    CHECK_FAILS(swarf_program_add_arc(program, off, o, SWARF_PLANE_XY, 1, 1, 1, 12), SWARF_ERROR_ARGUMENT,
                "line 12: arc: the radius is 10 mm at the start but 10.011 mm at the end");
    CHECK(strstr(swarf_error_last(), "the centre X") != NULL);
    CHECK_FAILS(swarf_program_add_arc(program, quarter, (double[3]){10, 0, 0}, SWARF_PLANE_XY, 1, 1, 1, 1),
                SWARF_ERROR_ARGUMENT, "radius is 0 mm");
    CHECK_FAILS(swarf_program_add_arc(program, quarter, o, SWARF_PLANE_XY, 1, 0, 1, 1), SWARF_ERROR_ARGUMENT,
                "0 turns");
    CHECK_FAILS(swarf_program_add_arc(program, quarter, o, SWARF_PLANE_XY, 1, 10001, 1, 1), SWARF_ERROR_ARGUMENT,
                "10001 turns");
    CHECK_FAILS(swarf_program_add_arc(program, quarter, o, (swarf_plane)3, 1, 1, 1, 1), SWARF_ERROR_ARGUMENT, "plane");
    CHECK_FAILS(swarf_program_add_arc(program, quarter, (double[3]){NAN, 0, 0}, SWARF_PLANE_XY, 1, 1, 1, 1),
                SWARF_ERROR_ARGUMENT, "centre is not finite");
    CHECK_FAILS(swarf_program_add_arc(program, quarter, o, SWARF_PLANE_XY, 1, 1, NAN, 1), SWARF_ERROR_ARGUMENT, "feed");
    CHECK_FAILS(swarf_program_add_line(program, SWARF_MOVE_FEED, o, -1, 1), SWARF_ERROR_ARGUMENT, "feed -1");
    CHECK_FAILS(swarf_program_add_line(program, SWARF_MOVE_FEED, o, INFINITY, 1), SWARF_ERROR_ARGUMENT, "feed");
    CHECK_FAILS(swarf_program_add_line(program, SWARF_MOVE_FEED, (double[3]){0, INFINITY, 0}, 1, 3),
                SWARF_ERROR_ARGUMENT, "line 3: Y is not finite");
    CHECK_FAILS(swarf_program_add_line(program, SWARF_MOVE_RAPID, (double[3]){0, 0, 1.1e6}, 1, 3), SWARF_ERROR_ARGUMENT,
                "line 3: Z is 1.1e+06 mm");
    CHECK_FAILS(swarf_program_add_line(program, SWARF_MOVE_DWELL, o, 1, 3), SWARF_ERROR_ARGUMENT, "no straight move");
    CHECK_FAILS(swarf_program_add_event(program, SWARF_MOVE_FEED, 1, 3), SWARF_ERROR_ARGUMENT, "no event");
    CHECK_FAILS(swarf_program_add_event(program, SWARF_MOVE_DWELL, -1, 3), SWARF_ERROR_ARGUMENT, "line 3");
    CHECK_FAILS(swarf_program_add_operation(program, NULL), SWARF_ERROR_ARGUMENT, "name");
    swarf_path path;
    CHECK_FAILS(swarf_program_path(program, 0, &path), SWARF_ERROR_ARGUMENT, "move 0 of 0");
    CHECK_FAILS(swarf_program_create((double[3]){0, INFINITY, 0}, &program), SWARF_ERROR_ARGUMENT, "start Y");
    CHECK(swarf_program_move_count(program) == 0 && swarf_program_arc_count(program) == 0); /* refusals leave nothing */
    /* ends on one ray from the centre, a little apart: a whole turn, not none */
    CHECK_OK(swarf_program_add_arc(program, (double[3]){10.005, 0, 0}, o, SWARF_PLANE_XY, 1, 1, 1, 1));
    CHECK_NEAR(swarf_program_arcs(program)[0].angle_rad, 2 * pi, 1e-12);
    CHECK_OK(swarf_program_add_arc(program, just, o, SWARF_PLANE_XY, 1, 1, 1, 1));
    double nowhere[3];
    swarf_program_move_start(program, 2, nowhere);
    CHECK(isnan(nowhere[0]));
    swarf_program_release(program);
    swarf_program_release(NULL);
    CHECK(swarf_program_move_count(NULL) == 0 && swarf_program_moves(NULL) == NULL);
}

/* Many moves with ever changing sections: linear time, no loss. */
static void test_many(void)
{
    enum { COUNT = 2000000 };
    swarf_program *program = begin(0, 0, 0);
    CHECK_OK(swarf_program_add_operation(program, "all"));
    swarf_section section = {.tool = 1};
    int failed = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        section.spindle_rpm = i % 4096;
        failed |= swarf_program_set_section(program, &section);
        failed |= swarf_program_add_line(program, SWARF_MOVE_FEED, (double[3]){i % 1000, 1, 2}, 1, i);
    }
    CHECK(!failed && swarf_program_move_count(program) == COUNT && swarf_program_section_count(program) == 4096);
    CHECK(swarf_program_moves(program)[COUNT - 1].line == COUNT - 1);
    swarf_program_release(program);
}

int main(void)
{
    test_lines();
    test_unknown();
    test_sections();
    test_arcs_closed_form();
    test_arcs_random();
    test_refusals();
    test_many();
    return test_end();
}
