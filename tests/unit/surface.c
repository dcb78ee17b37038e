/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The exact surface: closed forms, then every cutter on every motion against the oracle and the voxels' kernels. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"

static const swarf_box block = {{-25, -25, -25}, {25, 25, 25}};

static swarf_surface *make_surface(const swarf_box *box, double voxel, const swarf_path *paths, size_t count,
                                   const swarf_cutter *cutter)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    swarf_stock *stock = NULL;
    swarf_program *program = NULL;
    swarf_surface *surface = NULL;
    const swarf_section section = {.tool = 1};
    const swarf_tool tool = {1, 0, cutter};
    CHECK_OK(swarf_stock_create_box(box, &options, &stock));
    CHECK_OK(swarf_program_create(paths[0].start, &program));
    CHECK_OK(swarf_program_add_operation(program, "cut"));
    CHECK_OK(swarf_program_set_section(program, &section));
    for (size_t i = 0; i < count; i++) {
        const swarf_path *path = &paths[i];
        if (!path->is_arc)
            CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, path->end, 100, 1));
        else
            CHECK_OK(swarf_program_add_arc(program, path->end, path->arc.centre, (swarf_plane)path->arc.plane,
                                           path->arc.angle_rad > 0,
                                           (int)ceil(fabs(path->arc.angle_rad) / 6.283185307179586 - 1e-9), 100, 1));
    }
    if (!CHECK_OK(swarf_surface_create(stock, program, &tool, 1, NULL, &surface))) exit(test_end());
    swarf_program_release(program);
    swarf_stock_destroy(stock);
    return surface;
}

static swarf_surface_near *near_point(const swarf_surface *surface, const double p[3], double half)
{
    swarf_surface_near *near = NULL;
    const swarf_box box = {{p[0] - half, p[1] - half, p[2] - half}, {p[0] + half, p[1] + half, p[2] + half}};
    CHECK_OK(swarf_surface_near_create(surface, &near));
    CHECK_OK(swarf_surface_gather(near, SIZE_MAX, &box));
    return near;
}

/* Crossing from a to b: where, the normal, the move. */
static void check_hit(const swarf_surface *surface, const double a[3], const double b[3], double t, const double n[3],
                      int64_t move)
{
    double middle[3], found = -1;
    for (int k = 0; k < 3; k++) middle[k] = 0.5 * (a[k] + b[k]);
    swarf_surface_near *near = near_point(surface, middle, 2);
    swarf_surface_point point;
    if (CHECK(swarf_surface_crossing(near, a, b, 1e-10, &found, &point))) {
        CHECK_NEAR(found, t, 1e-8);
        for (int k = 0; k < 3; k++) CHECK_NEAR(point.normal[k], n[k], 1e-7);
        CHECK(point.move == move);
    }
    swarf_surface_near_destroy(near);
}

static void check_closed_forms(void)
{
    swarf_cutter *flat = NULL, *ball = NULL, *drill = NULL;
    CHECK_OK(swarf_cutter_parse("flat:d=4,l=20", &flat));
    CHECK_OK(swarf_cutter_parse("ball:d=4,l=20", &ball));
    CHECK_OK(swarf_cutter_parse("drill:d=4,l=20,a=90", &drill));
    const swarf_box box = {{-10, -10, -10}, {10, 10, 0}};
    const swarf_path slot = oracle_line(-8, 0, -1, 8, 0, -1), ramp = oracle_line(-8, 0, 0, 8, 0, -4);
    const swarf_path hole = oracle_line(1, 2, 5, 1, 2, -6);
    swarf_surface *s = make_surface(&box, 0.25, &slot, 1, flat);
    const double up[3] = {0, 0, 1}, down_y[3] = {0, -1, 0}, left[3] = {-1, 0, 0};
    check_hit(s, (double[3]){1, 0.3, -2}, (double[3]){1, 0.3, 0}, 0.5, up, 0);
    check_hit(s, (double[3]){1, 3, -0.5}, (double[3]){1, 1, -0.5}, 0.5, down_y, 0);
    check_hit(s, (double[3]){1, 5, -1}, (double[3]){1, 5, 1}, 0.5, up, -1);
    check_hit(s, (double[3]){10.5, 5, -0.5}, (double[3]){9.5, 5, -0.5}, 0.5, (double[3]){1, 0, 0}, -1);
    check_hit(s, (double[3]){10.4, 5, -0.5}, (double[3]){8.9, 5, -0.5}, 0.4 / 1.5, (double[3]){1, 0, 0}, -1);
    swarf_surface_release(s);
    s = make_surface(&box, 0.25, &slot, 1, ball); /* groove: depth 1 with radius 2 */
    check_hit(s, (double[3]){0, 1, -2}, (double[3]){0, 1, 0}, (1 + 2 - sqrt(3.0)) / 2, (double[3]){0, -0.5, sqrt(0.75)},
              0);
    swarf_surface_release(s);
    /* on a ramp the leading edge of the disc leaves the floor: at y = 0 it lies R * slope above the tip's own line */
    s = make_surface(&box, 0.25, &ramp, 1, flat);
    const double floor = -0.25 * 9 - 0.25 * 2, length = sqrt(1 + 0.0625);
    check_hit(s, (double[3]){1, 0, floor - 0.4}, (double[3]){1, 0, floor + 0.6}, 0.4,
              (double[3]){0.25 / length, 0, 1 / length}, 0);
    swarf_surface_release(s);
    s = make_surface(&box, 0.25, &hole, 1, drill);
    check_hit(s, (double[3]){2, 2, -5.5}, (double[3]){2, 2, -4.5}, 0.5, (double[3]){-sqrt(0.5), 0, sqrt(0.5)}, 0);
    check_hit(s, (double[3]){3.5, 2, -2}, (double[3]){2.5, 2, -2}, 0.5, left, 0);
    swarf_surface_release(s);
    /* arc and helix about the origin, radius 5: walls at 3 and 7, floor where the tip is */
    const swarf_path arc = oracle_arc((double[3]){5, 0, -1}, (double[3]){0, 0, -1}, SWARF_PLANE_XY, 3, 0);
    s = make_surface(&box, 0.25, &arc, 1, flat);
    check_hit(s, (double[3]){0, 2.5, -0.5}, (double[3]){0, 3.5, -0.5}, 0.5, (double[3]){0, 1, 0}, 0);
    check_hit(s, (double[3]){0, 7.5, -0.5}, (double[3]){0, 6.5, -0.5}, 0.5, down_y, 0);
    check_hit(s, (double[3]){0.1, 5, -1.5}, (double[3]){0.1, 5, -0.5}, 0.5, up, 0);
    swarf_surface_release(s);
    const swarf_path helix =
        oracle_arc((double[3]){5, 0, 1}, (double[3]){0, 0, 1}, SWARF_PLANE_XY, 12.5663706143591729, -6);
    s = make_surface(&box, 0.25, &helix, 1, flat);
    check_hit(s, (double[3]){0, 7.5, -1}, (double[3]){0, 6.5, -1}, 0.5, down_y, 0);
    check_hit(s, (double[3]){0, 2.5, -1}, (double[3]){0, 3.5, -1}, 0.5, (double[3]){0, 1, 0}, 0);
    swarf_surface_release(s);
    swarf_cutter_release(flat);
    swarf_cutter_release(ball);
    swarf_cutter_release(drill);
}

static void check_cases(void)
{
    enum { POINTS = 40 };
    const double voxel = 0.1;
    test_random random = test_random_begin(17);
    long signs = 0, smooth = 0, normals = 0, off = 0, tilted = 0;
    long apart = 0;
    for (int number = 0; number < CASE_CUTTERS * CASE_MOTIONS; number++) {
        const char *cutter_name, *motion_name;
        int curved;
        swarf_cutter *cutter = case_cutter(number / CASE_MOTIONS, &cutter_name);
        const swarf_path path = case_motion(number % CASE_MOTIONS, &random, &motion_name, &curved);
        const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
        swarf_surface *surface = make_surface(&block, 0.5, &path, 1, cutter);
        for (int i = 0; i < POINTS; i++) {
            double p[3];
            float kernel = 0;
            swarf_surface_point seen;
            oracle_random_point(&body, &path, i < POINTS / 2 ? 0.02 : voxel, &random, p);
            swarf_surface_near *near = near_point(surface, p, 0.3);
            swarf_surface_evaluate(near, p, &seen);
            const int sign = oracle_sign(&body, &path, p, 1e-3 * voxel);
            if (sign) {
                signs++;
                if (!CHECK((seen.value < 0) == (sign > 0))) {
                    printf("%s, %s: value %g\n", cutter_name, motion_name, seen.value);
                    oracle_print(stdout, cutter_name, &path, voxel, p);
                }
            }
            const double away = oracle_distance(&body, &path, p);
            if (away > 1e-4 && away < 1.5 * voxel && oracle_is_smooth(&body, &path, p, away, voxel)) {
                double gradient[3];
                oracle_gradient(&body, &path, p, 1e-5, gradient);
                const double dot =
                    -(gradient[0] * seen.normal[0] + gradient[1] * seen.normal[1] + gradient[2] * seen.normal[2]);
                normals++;
                off += dot < cos(0.03);
                smooth++;
                tilted += fabs(-seen.value - away) > 0.05 * voxel;
                CHECK_OK(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, voxel, p, 1, &kernel));
                apart += fabs(-seen.value - (double)kernel) > 0.02 * voxel;
            }
            swarf_surface_near_destroy(near);
        }
        swarf_surface_release(surface);
        swarf_cutter_release(cutter);
    }
    printf("%ld signs; %ld smooth points: %ld values off, %ld apart from the kernels'; %ld of %ld normals off\n", signs,
           smooth, tilted, apart, off, normals);
    CHECK(signs > 4000 && smooth > 1000);
    CHECK(tilted <= smooth / 50);
    CHECK(off <= normals / 50);
    CHECK(apart <= smooth / 50);
}

/* Points beside a slot's faces and edges, and one where nothing is. */
static void check_refine(void)
{
    swarf_cutter *flat = NULL;
    CHECK_OK(swarf_cutter_parse("flat:d=4,l=20", &flat));
    const swarf_box box = {{-10, -10, -10}, {10, 10, 0}};
    const swarf_path slot = oracle_line(-8, 0, -1, 8, 0, -1);
    swarf_surface *s = make_surface(&box, 0.25, &slot, 1, flat);
    double points[4][3] = {{1, 0.3, -1.1}, {1, 2.1, -0.5}, {1, 5, 0.07}, {1, 1, -5}}, normals[4][3], out[4][3];
    double directions[4][3] = {{0, 0, -2}, {0, -1, 0.1}, {0, 0, 1}, {0, 0, 1}};
    int64_t moves[4];
    const swarf_surface_lines lines = {points[0], directions[0], 4, 0.5}, nowhere = {points[0], directions[0], 4, 0};
    const swarf_surface_feet all = {out[0], normals[0], moves}, some = {out[0], NULL, NULL};
    for (int threads = 1; threads <= 3; threads++) {
        CHECK_OK(swarf_threads_set(threads));
        CHECK_OK(swarf_surface_refine(s, 1, &lines, NULL, &all));
        CHECK_NEAR(out[0][2], -1, 1e-9);
        CHECK_NEAR(out[1][1], 2, 1e-9);
        CHECK_NEAR(out[2][2], 0, 1e-9);
        CHECK(moves[0] == 0 && moves[1] == 0 && moves[2] == -1 && moves[3] == -2);
        CHECK(memcmp(out[3], points[3], sizeof out[3]) == 0);
        CHECK_NEAR(normals[1][1], -1, 1e-9);
    }
    CHECK_OK(swarf_threads_set(0));
    CHECK_OK(swarf_surface_refine(s, 0, &lines, NULL, &all));
    CHECK(moves[0] == -2 && moves[2] == -1); /* before the first move the block is whole */
    CHECK_FAILS(swarf_surface_refine(NULL, 1, &lines, NULL, &some), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_surface_refine(s, 1, &lines, NULL, &(swarf_surface_feet){NULL, normals[0], moves}),
                SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_surface_refine(s, 1, &nowhere, NULL, &some), SWARF_ERROR_ARGUMENT, "reach");
    directions[2][2] = 0;
    CHECK_FAILS(swarf_surface_refine(s, 1, &lines, NULL, &some), SWARF_ERROR_ARGUMENT, "direction 2");
    swarf_surface_release(s);
    swarf_cutter_release(flat);
}

/* Turned axes cut nothing, as in a simulation: where such a move went, the stock's own top is met. */
static void check_turned(void)
{
    swarf_cutter *cutter = NULL;
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 1;
    swarf_stock *stock = NULL;
    swarf_program *program = NULL;
    swarf_surface *surface = NULL;
    const swarf_section section = {.tool = 1};
    const double start[3] = {-10, 0, 20}, ends[3][3] = {{10, 0, 20}, {10, 15, 20}, {-10, 15, 20}};
    const double turned[6] = {90};
    CHECK_OK(swarf_cutter_parse("flat:d=4,l=20", &cutter));
    const swarf_tool tool = {1, 0, cutter};
    CHECK_OK(swarf_stock_create_box(&block, &options, &stock));
    CHECK_OK(swarf_program_create(start, &program));
    CHECK_OK(swarf_program_add_operation(program, "cut"));
    CHECK_OK(swarf_program_set_section(program, &section));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, ends[0], 100, 1));
    CHECK_OK(swarf_program_set_axes(program, turned));
    for (int i = 1; i < 3; i++) CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, ends[i], 100, 1));
    if (CHECK_OK(swarf_surface_create(stock, program, &tool, 1, NULL, &surface))) {
        const double a[2][3] = {{0, 0, 18}, {0, 15, 18}}, b[2][3] = {{0, 0, 26}, {0, 15, 26}}, up[3] = {0, 0, 1};
        check_hit(surface, a[0], b[0], 2.0 / 8, up, 0);
        check_hit(surface, a[1], b[1], 7.0 / 8, up, -1);
    }
    swarf_surface_release(surface);
    swarf_program_release(program);
    swarf_stock_destroy(stock);
    swarf_cutter_release(cutter);
}

/* A box about a point of a move's axis, where a cutter's distance has a crease, sees what boxes about the points do: a
 * little below the top of the block, which is the nearer of the two in places. */
static void check_on_axis(void)
{
    enum { POINTS = 300 };
    static const double ends[][3] = {{9, 0, 0}, {-9, 0, 0}, {0, 9, 0}, {0, 0, 6}, {9, 0, 3}, {-9, 0, 3}, {0, 9, -3}};
    const double half = 3;
    test_random random = test_random_begin(23);
    long compared = 0;
    for (int index = 0; index < CASE_CUTTERS; index++)
        for (size_t e = 0; e < sizeof ends / sizeof *ends; e++) {
            const char *name;
            swarf_cutter *cutter = case_cutter(index, &name);
            const double rise =
                test_random_in(&random, 0, 1) < 0.5 ? 0 : oracle_body_of(cutter, SWARF_PART_FLUTES).radius;
            swarf_path path = {.has_motion = 1};
            double middle[3];
            for (int k = 0; k < 3; k++) {
                path.start[k] = -0.5 * ends[e][k];
                path.end[k] = 0.5 * ends[e][k];
                middle[k] = k == 2 ? rise : 0;
            }
            const swarf_box below = {{-25, -25, -25}, {25, 25, rise + 0.2}};
            swarf_surface *surface = make_surface(&below, 0.5, &path, 1, cutter);
            swarf_surface_near *wide = near_point(surface, middle, half);
            for (int i = 0; i < POINTS; i++) {
                swarf_surface_point a, b;
                double p[3];
                for (int k = 0; k < 3; k++) p[k] = middle[k] + test_random_in(&random, -half, half);
                swarf_surface_near *near = near_point(surface, p, half);
                swarf_surface_evaluate(near, p, &a);
                swarf_surface_evaluate(wide, p, &b);
                swarf_surface_near_destroy(near);
                if (fabs(a.value) > half) continue;
                compared++;
                if (!CHECK_NEAR(b.value, a.value, 1e-9))
                    printf("%s to %g %g %g at %g %g %g\n", name, path.end[0], path.end[1], path.end[2], p[0], p[1],
                           p[2]);
            }
            swarf_surface_near_destroy(wide);
            swarf_surface_release(surface);
            swarf_cutter_release(cutter);
        }
    CHECK(compared > 5000);
}

int main(void)
{
    check_turned();
    check_on_axis();
    check_closed_forms();
    check_refine();
    check_cases();
    return test_end();
}
