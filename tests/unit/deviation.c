/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Deviations of known size, place and line; none where nothing is wrong. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "milled.h"
#include "shapes.h"

static const double pi = 3.14159265358979323846;

/* The block with that pocket: its corners round with radius 2, in `steps` facets each. */
static swarf_solid *design_of(double depth, int steps)
{
    enum { MOST = 512 };
    double ring[MOST][2];
    size_t count = 0;
    static const double corner[4][2] = {{38, 23}, {22, 23}, {22, 17}, {38, 17}};
    for (int c = 0; c < 4; c++)
        for (int i = 0; i <= steps; i++, count++) {
            const double angle = 0.5 * pi * (c + (double)i / steps);
            ring[count][0] = corner[c][0] + 2 * cos(angle);
            ring[count][1] = corner[c][1] + 2 * sin(angle);
        }
    shape s = {0};
    /* vertices 0 .. 7: the block; then the ring above and below; then the middle of the pocket's floor */
    for (int i = 0; i < 8; i++)
        shape_vertex(&s, i & 1 ? milled_block.hi[0] : milled_block.lo[0],
                     i & 2 ? milled_block.hi[1] : milled_block.lo[1], i & 4 ? milled_block.hi[2] : milled_block.lo[2]);
    for (size_t i = 0; i < count; i++) {
        shape_vertex(&s, ring[i][0], ring[i][1], 0);
        shape_vertex(&s, ring[i][0], ring[i][1], -depth);
    }
    shape_vertex(&s, 30, 20, -depth);
    static const int faces[5][4] = {{0, 2, 3, 1}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 5; i++) {
        shape_triangle(&s, (size_t)faces[i][0], (size_t)faces[i][1], (size_t)faces[i][2]);
        shape_triangle(&s, (size_t)faces[i][0], (size_t)faces[i][2], (size_t)faces[i][3]);
    }
    static const size_t top[4] = {7, 6, 4, 5}; /* by the corners of the ring, counter-clockwise */
    for (size_t i = 0; i < count; i++) {
        const size_t next = (i + 1) % count, a = 8 + 2 * i, b = 8 + 2 * next;
        const size_t quarter = i / ((size_t)steps + 1), then = next / ((size_t)steps + 1);
        shape_triangle(&s, a, b, b + 1);
        shape_triangle(&s, a, b + 1, a + 1);
        shape_triangle(&s, 8 + 2 * count, a + 1, b + 1);
        shape_triangle(&s, top[quarter], b, a);
        if (then != quarter) shape_triangle(&s, top[quarter], top[then], b);
    }
    swarf_triangles triangles = shape_view(&s);
    swarf_topology topology;
    swarf_solid *solid = NULL;
    CHECK_OK(swarf_triangles_topology(&triangles, &topology));
    CHECK(topology.closed);
    CHECK_OK(swarf_solid_create(&triangles, NULL, &solid));
    shape_free(&s);
    return solid;
}

static void print_clusters(const swarf_deviation *deviation)
{
    size_t count;
    const swarf_cluster *c = swarf_deviation_clusters(deviation, &count);
    for (size_t i = 0; i < count && i < 10; i++)
        printf("  %s %s%g mm at (%g, %g, %g), %g mm2, %g mm3, move %d\n", c[i].excess ? "excess" : "gouge",
               c[i].at_least ? "at least " : "", c[i].value_mm, c[i].place[0], c[i].place[1], c[i].place[2],
               c[i].area_mm2, c[i].volume_mm3, c[i].move_count ? (int)c[i].moves[0] : -1);
}

static void check_nothing_wrong(void)
{
    static const double voxels[5] = {0.125, 0.137, 0.2, 0.331, 0.5};
    swarf_solid *design = design_of(4, 90);
    for (int i = 0; i < 5 && design; i++) {
        milled j = milled_begin("flat:d=4,l=20", voxels[i]);
        milled_pocket(&j, 4);
        milled_cut(&j);
        swarf_deviation *deviation = milled_deviation(&j, design, 0.01);
        size_t count = 1;
        swarf_deviation_clusters(deviation, &count);
        if (!CHECK(count == 0)) {
            printf("voxel %g\n", voxels[i]);
            print_clusters(deviation);
        }
        const swarf_deviation_sums sums = swarf_deviation_get_sums(deviation);
        CHECK(sums.passed == 1);
        CHECK_NEAR(sums.area_mm2, 2 * 2400 + 2000 + 4 * (2 * (16 + 6) + 4 * pi), 0.01 * 7000);
        CHECK_NEAR(sums.most_mm, 0, 0.025 * voxels[i] + 0.001);
        CHECK_NEAR(sums.least_mm, 0, 0.025 * voxels[i] + 0.001);
        CHECK_NEAR(sums.volumes.excess_mm3, 0, voxels[i]);
        CHECK_NEAR(sums.volumes.gouge_mm3, 0, voxels[i]);
        swarf_deviation_destroy(deviation);
        milled_end(&j);
    }
    swarf_solid_release(design);
}

static void check_deep_pocket(void)
{
    static const double voxels[3] = {0.1, 0.173, 0.25};
    swarf_solid *design = design_of(4, 90);
    for (int i = 0; i < 3 && design; i++) {
        milled j = milled_begin("flat:d=4,l=20", voxels[i]);
        milled_pocket(&j, 4.03);
        milled_cut(&j);
        swarf_deviation *deviation = milled_deviation(&j, design, 0.02);
        size_t count = 0;
        const swarf_cluster *c = swarf_deviation_clusters(deviation, &count);
        if (CHECK(count == 1)) {
            CHECK(c->excess == 0);
            CHECK_NEAR(c->value_mm, -0.03, 0.02 * voxels[i] + 1e-4);
            CHECK_NEAR(c->place[2], -4.03, 0.02 * voxels[i]);
            const double floor = 200 - (4 - pi) * 4;
            CHECK_NEAR(c->area_mm2, floor, 2.5 * voxels[i] * 60);
            CHECK_NEAR(c->volume_mm3, 0.03 * floor, 0.1 * 0.03 * floor);
            CHECK(c->move_count > 0);
        }
        print_clusters(deviation);
        CHECK(swarf_deviation_get_sums(deviation).passed == 0);
        swarf_deviation_destroy(deviation);
        milled_end(&j);
    }
    swarf_solid_release(design);
}

static void check_gouge_by_a_line(void)
{
    swarf_solid *design = design_of(4, 90);
    milled j = milled_begin("flat:d=4,l=20", 0.1);
    milled_pocket(&j, 4);
    milled_line(&j, SWARF_MOVE_RAPID, 10, 8, 5, 100);
    milled_line(&j, SWARF_MOVE_FEED, 10, 8, -0.2, 101);
    milled_line(&j, SWARF_MOVE_FEED, 15, 8, -0.2, 102);
    milled_line(&j, SWARF_MOVE_RAPID, 15, 8, 5, 103);
    milled_cut(&j);
    swarf_deviation *deviation = milled_deviation(&j, design, 0.05);
    size_t count = 0;
    const swarf_cluster *c = swarf_deviation_clusters(deviation, &count);
    if (CHECK(count == 1)) {
        CHECK(c->excess == 0);
        CHECK_NEAR(c->value_mm, -0.2, 0.002 + 1e-4);
        CHECK(c->place[0] > 7.9 && c->place[0] < 17.1 && fabs(c->place[1] - 8) < 2.1);
        CHECK_NEAR(c->volume_mm3, 0.2 * (20 + 4 * pi), 0.1);
        const uint32_t by = c->move_count ? swarf_program_moves(j.program)[c->moves[0]].line : 0;
        CHECK(by == 102 || by == 101); /* not the retract, which finds nothing left */
    }
    print_clusters(deviation);
    swarf_deviation_destroy(deviation);
    milled_end(&j);
    swarf_solid_release(design);
}

/* Who did it, where others came by: the pocket is cut 0.03 less deep, then (moves 9 .. 17) as deep as given, then so
 * once more (18 .. 26), and at last rapids go through it. */
static void check_who_did_it(double depth, int first, int last)
{
    static const double voxels[3] = {0.2, 0.331, 0.5};
    swarf_solid *design = design_of(4, 90);
    for (int i = 0; i < 3; i++) {
        milled j = milled_begin("flat:d=4,l=20", voxels[i]);
        milled_pocket(&j, depth - 0.03);
        milled_pocket(&j, depth);
        milled_pocket(&j, depth);
        milled_line(&j, SWARF_MOVE_RAPID, 22, 17, 5, 300);
        milled_line(&j, SWARF_MOVE_RAPID, 22, 17, -depth, 301);
        milled_line(&j, SWARF_MOVE_RAPID, 38, 17, -depth, 302);
        milled_line(&j, SWARF_MOVE_RAPID, 38, 23, -depth, 303);
        milled_line(&j, SWARF_MOVE_RAPID, 22, 23, -depth, 304);
        milled_line(&j, SWARF_MOVE_RAPID, 22, 20, -depth, 305);
        milled_line(&j, SWARF_MOVE_RAPID, 38, 20, -depth, 306);
        milled_cut(&j);
        swarf_deviation *deviation = milled_deviation(&j, design, 0.015);
        size_t count = 0;
        const swarf_cluster *c = swarf_deviation_clusters(deviation, &count);
        if (CHECK(count == 1) && CHECK(c->move_count > 0) && CHECK(c->excess == (depth < 4))) {
            CHECK_NEAR(c->value_mm, 4 - depth, 0.02 * voxels[i] + 1e-4);
            if (!CHECK(c->moves[0] >= first && c->moves[0] <= last))
                printf("voxel %g, %g deep: move %d, not %d .. %d\n", voxels[i], depth, (int)c->moves[0], first, last);
        }
        print_clusters(deviation);
        swarf_deviation_destroy(deviation);
        milled_end(&j);
    }
    swarf_solid_release(design);
}

static void check_missing_pocket(void)
{
    swarf_solid *design = design_of(4, 90);
    milled j = milled_begin("flat:d=4,l=20", 0.2);
    milled_line(&j, SWARF_MOVE_RAPID, 30, 20, 5, 1);
    milled_cut(&j);
    swarf_deviation *deviation = milled_deviation(&j, design, 0.05);
    size_t count = 0;
    const swarf_cluster *c = swarf_deviation_clusters(deviation, &count);
    if (CHECK(count == 1)) {
        CHECK(c->excess == 1 && c->reached == 0 && c->at_least == 0);
        CHECK_NEAR(c->value_mm, 4, 0.01); /* from the floor to the top above it */
        CHECK_NEAR(c->volume_mm3, 4 * (200 - (4 - pi) * 4), 2);
    }
    const swarf_deviation_sums sums = swarf_deviation_get_sums(deviation);
    CHECK(sums.passed == 1); /* not reached is no failure */
    CHECK(sums.not_reached_mm2 > 150);
    print_clusters(deviation);
    swarf_deviation_destroy(deviation);
    milled_end(&j);
    swarf_solid_release(design);
}

/* Every point on the scallops of passes at multiples of `step` has the height that the circle has there. */
static void check_scallop_points(const swarf_deviation *deviation, double radius, double step, double voxel)
{
    const float *xyz, *value;
    const uint8_t *kind;
    double off = 0, highest = 0;
    size_t seen = 0;
    const size_t count = swarf_deviation_points(deviation, &xyz, &value, &kind);
    for (size_t i = 0; i < count; i++) {
        const double x = xyz[3 * i], y = xyz[3 * i + 1], z = xyz[3 * i + 2];
        if (z < -1.5 || x < 3 || x > 57 || y < 3 || y > 37) continue; /* not the sides nor what is beside them */
        highest = fmax(highest, (double)value[i]);
        if (kind[i]) continue;
        const double beside = y - step * round(y / step);
        off = fmax(off, fabs((double)value[i] - (radius - sqrt(radius * radius - beside * beside))));
        seen++;
    }
    CHECK(seen > 100000);
    CHECK_NEAR(off, 0, 0.02 * voxel + 1e-4);
    CHECK_NEAR(highest, radius - sqrt(radius * radius - step * step / 4), 0.1 * voxel); /* of the ridges */
    printf("scallops: %zu points off by up to %g mm, the highest at %g\n", seen, off, highest);
}

/* Ball passes side by side leave scallops of r - sqrt(r^2 - (s / 2)^2). */
static void check_scallops(void)
{
    const double radius = 3, step = 1.5, height = radius - sqrt(radius * radius - step * step / 4);
    const double lo[3] = {0, 0, -10}, hi[3] = {60, 40, -1};
    shape s = {0};
    shape_box(&s, lo, hi);
    const swarf_triangles triangles = shape_view(&s);
    swarf_solid *design = NULL;
    CHECK_OK(swarf_solid_create(&triangles, NULL, &design));
    milled j = milled_begin("ball:d=6,l=20", 0.08);
    for (int i = -1; i <= 28; i++) {
        milled_line(&j, SWARF_MOVE_RAPID, i % 2 ? -5 : 65, step * i, 5, 1);
        milled_line(&j, SWARF_MOVE_FEED, i % 2 ? -5 : 65, step * i, -1, 2);
        milled_line(&j, SWARF_MOVE_FEED, i % 2 ? 65 : -5, step * i, -1, 3);
        milled_line(&j, SWARF_MOVE_RAPID, i % 2 ? 65 : -5, step * i, 5, 4);
    }
    milled_cut(&j);
    swarf_deviation *deviation = milled_deviation(&j, design, 0.15);
    const swarf_deviation_sums sums = swarf_deviation_get_sums(deviation);
    CHECK(sums.passed == 1);
    CHECK(sums.most_mm < height && sums.most_mm > 0.6 * height); /* the ridge itself is sharp */
    check_scallop_points(deviation, radius, step, 0.08);
    swarf_deviation_destroy(deviation);
    deviation = milled_deviation(&j, design, 0.02);
    CHECK(swarf_deviation_get_sums(deviation).passed == 0);
    size_t count = 0;
    const swarf_cluster *c = swarf_deviation_clusters(deviation, &count);
    CHECK(count > 0);
    for (size_t i = 0; i < count; i++) CHECK(c[i].excess && c[i].value_mm < height + 0.01);
    swarf_deviation_destroy(deviation);
    milled_end(&j);
    swarf_solid_release(design);
    shape_free(&s);
}

static void check_place(void)
{
    const double lo[3] = {100, 0, -10}, hi[3] = {160, 40, 0}, inch[3] = {60 / 25.4, 40 / 25.4, -1};
    shape beside = {0}, small = {0};
    shape_box(&beside, lo, hi);
    shape_box(&small, (const double[3]){0, 0, -10 / 25.4}, (const double[3]){inch[0], inch[1], 0});
    const swarf_triangles triangles[2] = {shape_view(&beside), shape_view(&small)};
    milled j = milled_begin("flat:d=4,l=20", 0.5);
    swarf_place place;
    for (int i = 0; i < 2; i++) {
        swarf_solid *design = NULL;
        CHECK_OK(swarf_solid_create(&triangles[i], NULL, &design));
        CHECK_OK(swarf_compare_place(j.stock, design, &place));
        CHECK(strstr(place.text, i ? "inches" : "beside") != NULL);
        CHECK(strcmp(swarf_place_name((swarf_place_kind)place.kind), i ? "unit" : "beside") == 0);
        swarf_solid_release(design);
    }
    swarf_solid *right = design_of(4, 8);
    CHECK_OK(swarf_compare_place(j.stock, right, &place));
    CHECK(place.kind == SWARF_PLACE_WELL && place.text[0] == 0);
    swarf_deviation_options options = swarf_deviation_options_default();
    swarf_deviation *deviation = NULL;
    options.gouge_mm = 0;
    CHECK_FAILS(swarf_deviation_create(j.stock, right, &options, NULL, &deviation), SWARF_ERROR_ARGUMENT, "gouges");
    options.gouge_mm = 0.1;
    options.allowance_mm = NAN;
    CHECK_FAILS(swarf_deviation_create(j.stock, right, &options, NULL, &deviation), SWARF_ERROR_ARGUMENT, "allowance");
    CHECK_FAILS(swarf_deviation_create(j.stock, NULL, NULL, NULL, &deviation), SWARF_ERROR_ARGUMENT, "missing");
    swarf_solid_release(right);
    milled_end(&j);
    shape_free(&beside);
    shape_free(&small);
}

/* Judging again by other options gives what measuring again would; the first judgement may be gone, stock and design
 * too. */
static void check_judging(void)
{
    swarf_solid *design = design_of(4, 30);
    milled j = milled_begin("flat:d=4,l=20", 0.2);
    milled_pocket(&j, 4.03);
    milled_line(&j, SWARF_MOVE_FEED, 38, 20, -4.3, 11);
    milled_cut(&j);
    uint8_t ignore[4096] = {0};
    swarf_deviation_options options[6];
    for (int i = 0; i < 6; i++) {
        options[i] = swarf_deviation_options_default();
        options[i].first = j.first;
    }
    options[1].excess_mm = options[1].gouge_mm = 0.005;
    options[2].allowance_mm = 0.1;
    options[3].gouge_mm = 1;
    options[4].region = (swarf_box){{20, 10, -10}, {37, 30, 10}};
    options[4].gouge_mm = 0.01;
    options[5].ignore = ignore;
    options[5].gouge_mm = 0.01;
    const size_t triangles = swarf_solid_get_facts(design).triangle_count;
    for (size_t i = 0; i < triangles; i++) ignore[i] = i % 3 == 0;
    options[5].ignore_count = triangles;
    swarf_deviation *measured[6] = {NULL}, *judged[6] = {NULL};
    for (int i = 0; i < 6; i++) CHECK_OK(swarf_deviation_create(j.stock, design, &options[i], NULL, &measured[i]));
    milled_end(&j);
    swarf_solid_release(design);
    for (int i = 0; i < 6; i++) {
        options[i].first = NULL; /* is not looked at */
        CHECK_OK(swarf_deviation_judge(measured[(i + 1) % 6], &options[i], NULL, &judged[i]));
    }
    swarf_deviation *none = NULL;
    options[5].ignore_count--;
    CHECK_FAILS(swarf_deviation_judge(measured[0], &options[5], NULL, &none), SWARF_ERROR_ARGUMENT, "marks");
    options[5].excess_mm = NAN;
    CHECK_FAILS(swarf_deviation_judge(measured[0], &options[5], NULL, &none), SWARF_ERROR_ARGUMENT, "material left");
    CHECK_FAILS(swarf_deviation_judge(measured[0], NULL, NULL, &none), SWARF_ERROR_ARGUMENT, "missing");
    int passed = 0;
    for (int i = 0; i < 6; i++) {
        const swarf_deviation_sums a = swarf_deviation_get_sums(measured[i]), b = swarf_deviation_get_sums(judged[i]);
        CHECK(memcmp(&a, &b, sizeof a) == 0);
        const float *xyz[2], *value[2];
        const uint8_t *kind[2];
        size_t count[2] = {swarf_deviation_points(measured[i], &xyz[0], &value[0], &kind[0]),
                           swarf_deviation_points(judged[i], &xyz[1], &value[1], &kind[1])};
        CHECK(count[0] == count[1] && memcmp(value[0], value[1], count[0] * sizeof(float)) == 0);
        CHECK(memcmp(kind[0], kind[1], count[0]) == 0 && memcmp(xyz[0], xyz[1], 3 * count[0] * sizeof(float)) == 0);
        const swarf_cluster *first = swarf_deviation_clusters(measured[i], &count[0]);
        const swarf_cluster *second = swarf_deviation_clusters(judged[i], &count[1]);
        CHECK(count[0] == count[1] && memcmp(first, second, count[0] * sizeof *first) == 0);
        passed += a.passed;
    }
    CHECK(passed == 1); /* a tolerance of 1 mm for gouges alone */
    for (int i = 0; i < 6; i++) {
        swarf_deviation_destroy(measured[i]);
        CHECK(swarf_deviation_get_sums(judged[i]).points > 0);
        swarf_deviation_destroy(judged[i]);
    }
}

/* A rib of the design too thin to be missed by the floor below it, on a stock without it: with tolerances within the
 * band of the stock's field and far beyond it. */
static void check_missing_rib(void)
{
    static const struct {
        double voxel, gouge;
        int found;
    } cases[] = {{0.2, 0.2, 1}, {0.1, 0.2, 1}, {0.05, 0.2, 1}, {0.1, 1, 1},
                 {0.1, 3.5, 1}, {0.1, 4.5, 0}, {0.05, 4.5, 0}};
    shape s = {0};
    const double hi[3] = {60, 40, -4};
    shape_box(&s, milled_block.lo, hi);
    const double rib_lo[3] = {29.85, 10, -4.5}, rib_hi[3] = {30.15, 30, 0};
    shape_box(&s, rib_lo, rib_hi);
    const swarf_triangles triangles = shape_view(&s);
    swarf_solid *design = NULL;
    CHECK_OK(swarf_solid_create(&triangles, NULL, &design));
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        milled j = milled_begin("flat:d=30,l=20", cases[i].voxel);
        for (int y = 0; y <= 40; y += 20) {
            milled_line(&j, SWARF_MOVE_RAPID, -20, y, 5, 1);
            milled_line(&j, SWARF_MOVE_FEED, -20, y, -4, 2);
            milled_line(&j, SWARF_MOVE_FEED, 80, y, -4, 3);
            milled_line(&j, SWARF_MOVE_RAPID, 80, y, 5, 4);
        }
        milled_cut(&j);
        swarf_deviation *deviation = milled_deviation(&j, design, cases[i].gouge);
        size_t count = 0;
        const swarf_cluster *c = swarf_deviation_clusters(deviation, &count);
        if (!CHECK(count == (size_t)cases[i].found)) {
            printf("voxel %g, tolerance %g: %zu\n", cases[i].voxel, cases[i].gouge, count);
            print_clusters(deviation);
        }
        if (count == 1) {
            CHECK(!c->excess && c->at_least && c->value_mm <= -cases[i].gouge && c->value_mm >= -4);
            CHECK(c->place[2] > -4 + cases[i].gouge && fabs(c->place[0] - 30) < 0.2);
        }
        swarf_deviation_destroy(deviation);
        milled_end(&j);
    }
    swarf_solid_release(design);
    shape_free(&s);
}

static int stop_after(void *user, double fraction)
{
    return fraction > *(const double *)user;
}

/* Judging by a wide tolerance and looking for moves end soon after they are cancelled, whenever that is, and harm
 * nothing. */
static void check_cancel(void)
{
    swarf_solid *design = design_of(4, 90);
    milled j = milled_begin("flat:d=4,l=20", 0.1);
    milled_pocket(&j, 3.5);
    milled_cut(&j);
    swarf_deviation *deviation = milled_deviation(&j, design, 0.02);
    swarf_deviation_options options = swarf_deviation_options_default();
    options.excess_mm = options.gouge_mm = 3;
    test_random random = test_random_begin(3);
    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_OK(swarf_threads_set(1));
    int cancelled = 0;
    for (int i = 0; i < 6 && deviation; i++) {
        double limit = i ? test_random_in(&random, 0, 0.95) : 0;
        const swarf_progress progress = {stop_after, &limit};
        swarf_deviation *other = NULL;
        const swarf_status status = swarf_deviation_judge(deviation, &options, &progress, &other);
        cancelled += status == SWARF_ERROR_CANCELLED && other == NULL;
        swarf_deviation_destroy(other);
    }
    CHECK(cancelled >= 3);
    size_t count = 0;
    double none = -1;
    const swarf_progress at_once = {stop_after, &none};
    CHECK_FAILS(swarf_deviation_find_moves(deviation, j.program, &j.tool, 1, &at_once), SWARF_ERROR_CANCELLED, NULL);
    CHECK_OK(swarf_deviation_find_moves(deviation, j.program, &j.tool, 1, NULL));
    const swarf_cluster *c = swarf_deviation_clusters(deviation, &count);
    CHECK(count == 1 && c->move_count > 0 && fabs(c->value_mm - 0.5) < 0.01);
    CHECK_OK(swarf_progress_interval_set(25));
    CHECK_OK(swarf_threads_set(0));
    swarf_deviation_destroy(deviation);
    milled_end(&j);
    swarf_solid_release(design);
}

static int keep_last(void *user, double fraction)
{
    *(double *)user = fraction;
    return 0;
}

/* Each pixel is as far from the design as the point it shows; those that show something else have no value. */
static void check_pixels(void)
{
    swarf_solid *design = design_of(4, 8);
    const double position[] = {3, 3, 0.25, 30, 20, -4.5, 57, 37, -0.125, 1, 2, 3, NAN, NAN, NAN};
    const uint8_t seen[] = {SWARF_SEEN_STOCK, SWARF_SEEN_STOCK, SWARF_SEEN_STOCK, SWARF_SEEN_FLUTES,
                            SWARF_SEEN_NOTHING};
    const double expected[] = {0.25, -0.5, -0.125, NAN, NAN};
    enum { COUNT = sizeof seen };
    double value[COUNT];
    for (double allowance = 0; allowance < 0.5; allowance += 0.3) {
        CHECK_OK(swarf_deviation_pixels(design, position, seen, COUNT, allowance, NULL, value));
        for (size_t i = 0; i < COUNT; i++)
            CHECK(isnan(expected[i]) ? isnan(value[i]) : fabs(value[i] - expected[i] + allowance) < 1e-12);
    }
    CHECK_OK(swarf_deviation_pixels(design, position, seen + 3, 2, 0, NULL, value));
    CHECK(isnan(value[0]) && isnan(value[1]));
    CHECK_OK(swarf_deviation_pixels(design, NULL, NULL, 0, 0, NULL, NULL));
    double last = 0;
    const swarf_progress progress = {keep_last, &last};
    CHECK_OK(swarf_deviation_pixels(design, position, seen + 3, 2, 0, &progress, value));
    CHECK(last == 1);
    value[0] = 7;
    CHECK_FAILS(swarf_deviation_pixels(design, position, seen, COUNT, NAN, NULL, value), SWARF_ERROR_ARGUMENT,
                "allowance");
    CHECK_FAILS(swarf_deviation_pixels(NULL, position, seen, COUNT, 0, NULL, value), SWARF_ERROR_ARGUMENT, "missing");
    CHECK_FAILS(swarf_deviation_pixels(design, NULL, seen, COUNT, 0, NULL, value), SWARF_ERROR_ARGUMENT, "missing");
    CHECK_FAILS(swarf_deviation_pixels(design, position + 12, seen, 1, 0, NULL, value), SWARF_ERROR_ARGUMENT, "finite");
    CHECK(value[0] == 7);
    swarf_solid_release(design);
}

int main(void)
{
    check_nothing_wrong();
    check_deep_pocket();
    check_gouge_by_a_line();
    check_who_did_it(4.03, 9, 17);
    check_who_did_it(3.95, 18, 26);
    check_missing_pocket();
    check_scallops();
    check_missing_rib();
    check_judging();
    check_place();
    check_cancel();
    check_pixels();
    return test_end();
}
