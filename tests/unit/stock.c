/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock room: what must be refused, and the odd things that must work. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cases.h"
#include "stocks.h"

static const swarf_box cube = {{0, 0, 0}, {10, 10, 10}};

static swarf_stock *make_stock(double voxel)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&cube, &options, &stock))) exit(test_end());
    return stock;
}

static swarf_cutter *parse(const char *text)
{
    swarf_cutter *cutter = NULL;
    if (!CHECK_OK(swarf_cutter_parse(text, &cutter))) exit(test_end());
    return cutter;
}

static void check_refused(void)
{
    swarf_stock *const untouched = (swarf_stock *)&cube;
    swarf_stock *stock = untouched;
    swarf_stock_options options = swarf_stock_options_default();
    CHECK_FAILS(swarf_stock_create_box(&cube, &options, &stock), SWARF_ERROR_ARGUMENT, "voxel size 0");
    options.voxel_mm = -0.1;
    CHECK_FAILS(swarf_stock_create_box(&cube, &options, &stock), SWARF_ERROR_ARGUMENT, "-0.1");
    options.voxel_mm = NAN;
    CHECK_FAILS(swarf_stock_create_box(&cube, &options, &stock), SWARF_ERROR_ARGUMENT, "nan");
    options.voxel_mm = INFINITY;
    CHECK_FAILS(swarf_stock_create_box(&cube, &options, &stock), SWARF_ERROR_ARGUMENT, "inf");
    options.voxel_mm = 0.1;
    swarf_box box = cube;
    box.hi[1] = 0;
    CHECK_FAILS(swarf_stock_create_box(&box, &options, &stock), SWARF_ERROR_ARGUMENT, "y");
    box.hi[1] = -1;
    CHECK_FAILS(swarf_stock_create_box(&box, &options, &stock), SWARF_ERROR_ARGUMENT, "empty");
    box.hi[1] = NAN;
    CHECK_FAILS(swarf_stock_create_box(&box, &options, &stock), SWARF_ERROR_ARGUMENT, "y");
    box.hi[1] = INFINITY;
    CHECK_FAILS(swarf_stock_create_box(&box, &options, &stock), SWARF_ERROR_ARGUMENT, "finite");
    box.hi[1] = 1e30; /* no voxel that is large enough is possible */
    CHECK_FAILS(swarf_stock_create_box(&box, &options, &stock), SWARF_ERROR_ARGUMENT, "1e+30 mm in y; -1e+06 to 1e+06");
    CHECK_FAILS(swarf_stock_create_box(NULL, &options, &stock), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_create_box(&cube, NULL, &stock), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_create_box(&cube, &options, NULL), SWARF_ERROR_ARGUMENT, NULL);
    options.size = 1;
    CHECK_FAILS(swarf_stock_create_box(&cube, &options, &stock), SWARF_ERROR_ARGUMENT, NULL);
    const double base[3] = {0, 0, 0}, axis[3] = {0, 0, 5}, none[3] = {0, 0, 0};
    options = swarf_stock_options_default();
    options.voxel_mm = 0.1;
    CHECK_FAILS(swarf_stock_create_cylinder(base, none, 1, &options, &stock), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_create_cylinder(base, axis, 0, &options, &stock), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_create_cylinder(base, axis, NAN, &options, &stock), SWARF_ERROR_ARGUMENT, NULL);
    /* what OpenVDB's transforms and the floats in leaves cannot hold */
    const swarf_box tiny = {{0, 0, 0}, {1e-6, 1e-6, 1e-6}}, vast = {{0, 0, 0}, {1e300, 1e300, 1e300}};
    options.voxel_mm = 1e-7;
    CHECK_FAILS(swarf_stock_create_box(&tiny, &options, &stock), SWARF_ERROR_ARGUMENT, "voxel of 1e-07 mm");
    options.voxel_mm = 1e300;
    CHECK_FAILS(swarf_stock_create_box(&cube, &options, &stock), SWARF_ERROR_ARGUMENT, "voxel of 1e+300 mm");
    CHECK_FAILS(swarf_stock_create_box(&vast, &options, &stock), SWARF_ERROR_ARGUMENT, "1e+300 mm in x");
    const swarf_box away = {{1e15, 0, 0}, {1.0001e15, 1, 1}};
    options.voxel_mm = 1e4;
    CHECK_FAILS(swarf_stock_create_box(&away, &options, &stock), SWARF_ERROR_ARGUMENT, "in x");
    const swarf_box beyond = {{1e7, 0, 0}, {1e7 + 1, 1, 1}};
    options.voxel_mm = 0.1;
    CHECK_FAILS(swarf_stock_create_box(&beyond, &options, &stock), SWARF_ERROR_ARGUMENT, "in x");
    CHECK(stock == untouched);
}

/* Nothing was simulated: nothing is known, nothing crashes. */
static void check_no_simulation(void)
{
    size_t count = 7;
    CHECK(!swarf_simulation_removed(NULL, &count) && count == 0);
    CHECK(!swarf_simulation_removed_per_move(NULL, &count) && count == 0);
    CHECK(!swarf_simulation_findings(NULL, &count) && count == 0);
    CHECK(swarf_simulation_volume_initial(NULL) == 0 && swarf_simulation_volume_final(NULL) == 0);
}

/* The refusal names a voxel size, and a stock of that size is made under the same limit. */
static void check_memory(void)
{
    const double sizes[] = {1e-9, 1e-300, 0.001};
    for (int i = 0; i < 3; i++) {
        swarf_stock *stock = NULL;
        swarf_stock_options options = swarf_stock_options_default();
        options.voxel_mm = sizes[i];
        options.memory_limit = 200u << 20;
        if (!CHECK_FAILS(swarf_stock_create_box(&cube, &options, &stock), SWARF_ERROR_MEMORY, "a voxel of")) continue;
        CHECK(stock == NULL);
        const char *last = NULL, *text = swarf_error_last();
        for (const char *at = text; (at = strstr(at, "a voxel of ")); at++) last = at;
        options.voxel_mm = last ? strtod(last + strlen("a voxel of "), NULL) : 0;
        CHECK(options.voxel_mm > sizes[i]);
        size_t bytes = 0;
        CHECK_OK(swarf_stock_estimate(&cube, options.voxel_mm, &bytes));
        CHECK(bytes <= options.memory_limit);
        CHECK(bytes > options.memory_limit / 4); /* a coarser suggestion than needed would be no help */
        if (CHECK_OK(swarf_stock_create_box(&cube, &options, &stock))) {
            size_t leaves, held;
            CHECK_OK(swarf_stock_size(stock, &leaves, &held));
            CHECK(held <= bytes);
            swarf_stock_destroy(stock);
        }
    }
    swarf_stock *stock = NULL;
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 1e-9;
    CHECK_FAILS(swarf_stock_create_box(&cube, &options, &stock), SWARF_ERROR_MEMORY, "fits");
    size_t bytes = 7;
    CHECK_FAILS(swarf_stock_estimate(&cube, 0, &bytes), SWARF_ERROR_ARGUMENT, NULL);
    CHECK(bytes == 7);
}

static void check_cut_refused(void)
{
    swarf_stock *stock = make_stock(0.2);
    swarf_cutter *cutter = parse("flat:d=4,l=20");
    swarf_path path = oracle_line(2, 2, 5, 8, 2, 5);
    const uint64_t before = stock_hash(stock);
    CHECK_FAILS(swarf_stock_cut(NULL, cutter, &path, 1, NULL), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_cut(stock, NULL, &path, 1, NULL), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_cut(stock, cutter, NULL, 1, NULL), SWARF_ERROR_ARGUMENT, NULL);
    path.end[2] = NAN;
    CHECK_FAILS(swarf_stock_cut(stock, cutter, &path, 1, NULL), SWARF_ERROR_ARGUMENT, NULL);
    path.end[2] = INFINITY;
    CHECK_FAILS(swarf_stock_cut(stock, cutter, &path, 1, NULL), SWARF_ERROR_ARGUMENT, NULL);
    path = oracle_arc((double[3]){2, 2, 5}, (double[3]){5, 2, 5}, SWARF_PLANE_XY, 1, 0);
    path.arc.angle_rad = NAN;
    CHECK_FAILS(swarf_stock_cut(stock, cutter, &path, 1, NULL), SWARF_ERROR_ARGUMENT, NULL);
    path.arc.angle_rad = 1;
    path.arc.plane = 3;
    CHECK_FAILS(swarf_stock_cut(stock, cutter, &path, 1, NULL), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_OK(swarf_stock_cut(stock, cutter, NULL, 0, NULL));
    CHECK(stock_hash(stock) == before);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
    swarf_stock_destroy(NULL);
}

/* Moves that touch nothing, whatever their size, leave every bit. */
static void check_missed(void)
{
    swarf_stock *stock = make_stock(0.2);
    swarf_cutter *cutter = parse("ball:d=4,l=20");
    const swarf_path paths[] = {
        oracle_line(-100, 0, 0, -100, 50, 0),
        oracle_line(-2.7, -50, 5, -2.7, 50, 5),
        oracle_line(5, 5, 10.61, 5, 5, 900),
        oracle_line(5, 5, -1e7, 5, 5, -1e6),
        oracle_line(-1e9, -1e9, 20, 1e9, 1e9, 20),
        oracle_line(1e12, 5, 5, 1.1e12, 5, 5),
        oracle_arc((double[3]){20, 5, 5}, (double[3]){5, 5, 5}, SWARF_PLANE_XY, 6.283185307179586, 0),
        oracle_arc((double[3]){20, 5, 50}, (double[3]){5, 5, 50}, SWARF_PLANE_XY, -200, -90),
    };
    const uint64_t before = stock_hash(stock);
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++) {
        CHECK_OK(swarf_stock_cut(stock, cutter, &paths[i], 1, NULL));
        if (!CHECK(stock_hash(stock) == before)) printf("    path %zu\n", i);
    }
    CHECK_OK(swarf_stock_cut(stock, cutter, paths, sizeof paths / sizeof paths[0], NULL));
    CHECK(stock_hash(stock) == before);
    swarf_cutter_release(cutter);

    cutter = parse("flat:d=4,l=20"); /* moves without motion are skipped, whatever else they hold */
    swarf_path event = oracle_line(5, 5, 5, 5, 5, 5);
    event.has_motion = 0;
    CHECK_OK(swarf_stock_cut(stock, cutter, &event, 1, NULL));
    CHECK(stock_hash(stock) == before);
    swarf_cutter_release(cutter);

    const swarf_profile_node nodes[] = {{3, 0, 0}, {3, 20, 0}}; /* no flutes: nothing to cut with */
    const swarf_cutter_part shank = {SWARF_PART_SHANK, nodes, 2};
    const swarf_path through = oracle_line(2, 2, 5, 8, 2, 5);
    CHECK_OK(swarf_cutter_create(&shank, 1, &cutter));
    CHECK_OK(swarf_stock_cut(stock, cutter, &through, 1, NULL));
    CHECK(stock_hash(stock) == before);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
}

static void check_standing(void)
{
    const double pi = 3.14159265358979323846;
    swarf_stock *stock = make_stock(0.05);
    swarf_cutter *cutter = parse("flat:d=4,l=20,sd=8,sl=30"); /* the shank must not cut */
    const swarf_path hole = oracle_line(5.01, 4.98, 3.33, 5.01, 4.98, 3.33);
    CHECK_OK(swarf_stock_cut(stock, cutter, &hole, 1, NULL));
    CHECK_NEAR(1000 - stock_volume(stock), pi * 4 * 6.67, 1e-4 * pi * 4 * 6.67);
    swarf_box box;
    CHECK_OK(swarf_stock_box(stock, &box));
    for (int k = 0; k < 3; k++) {
        CHECK_NEAR(box.lo[k], 0, 0.03);
        CHECK_NEAR(box.hi[k], 10, 0.03);
    }
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
}

/* A tool larger than the stock takes all of it, or all above a height. */
static void check_large_tool(void)
{
    swarf_stock *stock = make_stock(0.2);
    swarf_cutter *cutter = parse("flat:d=400,l=200");
    const swarf_path above = oracle_line(-3, 5, 4.03, 8, 5, 4.03), all = oracle_line(0, 0, -5, 1, 0, -5);
    CHECK_OK(swarf_stock_cut(stock, cutter, &above, 1, NULL));
    CHECK_NEAR(stock_volume(stock), 403, 1e-4 * 403);
    CHECK_OK(swarf_stock_cut(stock, cutter, &all, 1, NULL));
    CHECK_NEAR(stock_volume(stock), 0, 0);
    swarf_box box;
    CHECK_OK(swarf_stock_box(stock, &box));
    CHECK(box.lo[0] > box.hi[0]);
    CHECK_OK(swarf_stock_cut(stock, cutter, &all, 1, NULL));
    CHECK_NEAR(stock_volume(stock), 0, 0);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
}

/* 100,000 moves, each far below a voxel, along a circle: the same groove as one arc. */
static void check_tiny_moves(void)
{
    enum { COUNT = 100000 };
    const double two_pi = 6.283185307179586476925;
    swarf_path *paths = malloc(COUNT * sizeof *paths);
    if (!paths) exit(2);
    for (int i = 0; i < COUNT; i++) {
        const double a = two_pi * i / COUNT, b = two_pi * (i + 1) / COUNT;
        paths[i] = oracle_line(5 + 2.5 * cos(a), 5 + 2.5 * sin(a), 7.77, 5 + 2.5 * cos(b), 5 + 2.5 * sin(b), 7.77);
    }
    swarf_cutter *cutter = parse("ball:d=3,l=20");
    swarf_stock *tiny = make_stock(0.1), *whole = make_stock(0.1);
    const swarf_path arc = oracle_arc((double[3]){7.5, 5, 7.77}, (double[3]){5, 5, 0}, SWARF_PLANE_XY, two_pi, 0);
    CHECK_OK(swarf_stock_cut(tiny, cutter, paths, COUNT, NULL));
    CHECK_OK(swarf_stock_cut(whole, cutter, &arc, 1, NULL));
    const double removed = 1000 - stock_volume(whole);
    CHECK(removed > 50);
    CHECK_NEAR(1000 - stock_volume(tiny), removed, 1e-5 * removed);
    swarf_stock_destroy(tiny);
    swarf_stock_destroy(whole);
    swarf_cutter_release(cutter);
    free(paths);
}

/* Blocks whose faces lie anywhere between voxels keep their volume while being cut, to 1e-4 and the second order of
 * edges and curves (h: voxel). Where faces of coverage p and q meet at a right angle, the one voxel they share counts
 * as min(p, q) instead of p q: too much by 1/4 h^2 at most, per mm of edge; a hole's rims at its top and bottom are off
 * in opposite directions. A circle of radius R counts as pi (R^2 + h^2 / 12), give or
 * take half a square voxel for its place in the grid. */
static void check_faces(void)
{
    test_random random = test_random_begin(3);
    swarf_cutter *cutter = parse("flat:d=1,l=9");
    for (int i = 0; i < 20; i++) {
        swarf_box box;
        double volume = 1, edges = 0;
        for (int k = 0; k < 3; k++) {
            box.lo[k] = test_random_in(&random, -500, 500);
            box.hi[k] = box.lo[k] + test_random_in(&random, 2, 9);
            volume *= box.hi[k] - box.lo[k];
            edges += 4 * (box.hi[k] - box.lo[k]);
        }
        swarf_stock_options options = swarf_stock_options_default();
        options.voxel_mm = test_random_in(&random, 0.04, 0.12);
        swarf_stock *stock = NULL;
        if (!CHECK_OK(swarf_stock_create_box(&box, &options, &stock))) continue;
        const double h2 = options.voxel_mm * options.voxel_mm, before = stock_volume(stock);
        CHECK_NEAR(before, volume, 1e-4 * volume + 0.25 * h2 * edges);
        const double x = box.lo[0] + 1, y = box.lo[1] + 1, bottom = box.lo[2] + 1;
        const swarf_path hole = oracle_line(x, y, box.hi[2] + 1, x, y, bottom);
        const double depth = box.hi[2] - bottom, removed = 0.7853981633974483 * depth;
        CHECK_OK(swarf_stock_cut(stock, cutter, &hole, 1, NULL));
        CHECK_NEAR(before - stock_volume(stock), removed,
                   1e-4 * removed + h2 * (0.25 * 3.1415926535897932 + 0.8 * depth));
        swarf_stock_destroy(stock);
    }
    swarf_cutter_release(cutter);
}

/* Arcs of a radius far beyond the stock keep their digits: a full circle of 1e5 mm takes all that lies on one side of
 * its tool's edge, here 5 mm from the wall but for a sagitta of 25 / 2e5 mm. */
static void check_wide_arcs(void)
{
    const double two_pi = 6.283185307179586476925, wide = 1e5;
    swarf_cutter *cutter = parse("flat:d=4,l=30");
    const swarf_path circles[] = {
        oracle_arc((double[3]){5, 5 + 2 * wide, 3.03}, (double[3]){5, 5 + wide, 0}, SWARF_PLANE_XY, two_pi, 0),
        oracle_arc((double[3]){5 - 2 * wide, 5, 3.03}, (double[3]){5 - wide, 5, 0}, SWARF_PLANE_XY, -two_pi, 0),
    };
    const double removed = 10 * 4 * 6.97;
    for (int i = 0; i < 2; i++) {
        swarf_stock *stock = make_stock(0.05);
        CHECK_OK(swarf_stock_cut(stock, cutter, &circles[i], 1, NULL));
        CHECK_NEAR(1000 - stock_volume(stock), removed, 1e-4 * removed);
        /* the walls of the groove, at its ends and in the middle, to a hundredth of a voxel */
        for (int k = 0; k < 5; k++) {
            const double along = 1 + 2 * k, sag = (along - 5) * (along - 5) / (2 * wide);
            const double in = 3.0 + (i ? -sag : sag), out = 7.0 + (i ? -sag : sag);
            const double points[2][3] = {{i ? in : along, i ? along : in, 6}, {i ? out : along, i ? along : out, 6}};
            float value[2];
            CHECK_OK(swarf_stock_sample(stock, points[0], 2, value));
            CHECK_NEAR((double)value[0], 0, 0.01 * 0.05);
            CHECK_NEAR((double)value[1], 0, 0.01 * 0.05);
        }
        swarf_stock_destroy(stock);
    }
    swarf_cutter_release(cutter);
}

/* Around half a turn an arc's ends change from one test of sides to the other: the groove does not notice. */
static void check_half_turns(void)
{
    const double pi = 3.14159265358979323846, steps[] = {-1e-3, -1e-7, -1e-13, 0, 1e-13, 1e-7, 1e-3};
    swarf_cutter *cutter = parse("flat:d=2,l=30");
    for (int i = 0; i < 7; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double turn = pi + steps[i];
            const swarf_path arc =
                oracle_arc((double[3]){7.5, 5, 6.01}, (double[3]){5, 5, 0}, SWARF_PLANE_XY, sign * turn, 0);
            swarf_stock *stock = make_stock(0.02);
            CHECK_OK(swarf_stock_cut(stock, cutter, &arc, 1, NULL));
            const double removed = 3.99 * (2 * 2.5 * turn + pi);
            CHECK_NEAR(1000 - stock_volume(stock), removed, 1e-4 * removed);
            swarf_stock_destroy(stock);
        }
    swarf_cutter_release(cutter);
}

/* Moves that reach as far as 1e12 mm, through the stock or beside it. */
static void check_far_moves(void)
{
    swarf_stock *stock = make_stock(0.1);
    swarf_cutter *cutter = parse("flat:d=4,l=30");
    const swarf_path beside[] = {
        oracle_line(-1e12, -1e12, 20, 1e12, 1e12, 20),
        oracle_line(1e12, -1e12, 5, 1e12, 1e12, 5),
        oracle_line(5, 5, 1e12, 5, 5, 11),
        oracle_line(-1e12, 7e11, -1e12, -9e11, 1e12, 1e12),
        oracle_line(-1e12, -30, 5, 1e12, -30, 5),
    };
    const uint64_t before = stock_hash(stock);
    for (size_t i = 0; i < sizeof beside / sizeof beside[0]; i++)
        CHECK_OK(swarf_stock_cut(stock, cutter, &beside[i], 1, NULL));
    CHECK(stock_hash(stock) == before);
    const swarf_path down = oracle_line(5, 5, 1e12, 5, 5, 4.01);
    CHECK_OK(swarf_stock_cut(stock, cutter, &down, 1, NULL));
    CHECK_NEAR(1000 - stock_volume(stock), 12.566370614359172 * 5.99, 1e-3 * 75);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
}

/* A million moves (ten with SWARF_TEST_FULL) in a small stock, as one batch; time and memory are printed. */
static void check_many_moves(void)
{
    const size_t count = test_size() == TEST_FULL ? 10000000 : 1000000;
    const clock_t start = clock();
    swarf_path *paths = malloc(count * sizeof *paths);
    if (!paths) exit(2);
    test_random random = test_random_begin(12);
    double x = 5, y = 5;
    for (size_t i = 0; i < count; i++) {
        const double next_x = test_random_in(&random, -1, 11), next_y = test_random_in(&random, -1, 11);
        paths[i] = oracle_line(x, y, 7.03, next_x, next_y, 7.03);
        x = next_x, y = next_y;
    }
    swarf_stock *stock = make_stock(0.5);
    swarf_cutter *cutter = parse("flat:d=1,l=30");
    CHECK_OK(swarf_stock_cut(stock, cutter, paths, count, NULL));
    CHECK_NEAR(stock_volume(stock), 703, 1e-3 * 703); /* nothing above the lines is left */
    printf("%zu moves: %.1f s of processor time, %zu MB at most\n", count, (double)(clock() - start) / CLOCKS_PER_SEC,
           swarf_memory_peak() >> 20);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
    free(paths);
}

int main(void)
{
    check_refused();
    check_no_simulation();
    check_memory();
    check_cut_refused();
    check_missed();
    check_standing();
    check_large_tool();
    check_tiny_moves();
    check_faces();
    check_wide_arcs();
    check_half_turns();
    check_far_moves();
    check_many_moves();
    return test_end();
}
