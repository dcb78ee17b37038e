/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Change stamps: a cube of 32^3 voxels is named exactly when one of its voxels may have changed. Every voxel of the
 * stock is compared before and after each change; what is named without a change must lie within reach of the cut. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle.h"

enum { EDGE = 32, MOST = 4096 };

static const double voxel = 0.25;
static const swarf_box block = {{0, 0, 0}, {30, 22, 14}};

static swarf_stock *make_stock(void)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&block, &options, &stock))) exit(test_end());
    return stock;
}

/* All voxels of a box of one cube. */
static void read_cube(swarf_stock *stock, const swarf_box *box, float values[EDGE * EDGE * EDGE])
{
    static double points[EDGE * EDGE * EDGE][3];
    for (int i = 0; i < EDGE * EDGE * EDGE; i++) {
        const int at[3] = {i / (EDGE * EDGE), i / EDGE % EDGE, i % EDGE};
        for (int k = 0; k < 3; k++) points[i][k] = box->lo[k] + (at[k] + 0.5) * voxel;
    }
    CHECK_OK(swarf_stock_sample(stock, points[0], EDGE * EDGE * EDGE, values));
}

static int differs(const float *a, const float *b)
{
    for (int i = 0; i < EDGE * EDGE * EDGE; i++)
        if (fabsf(a[i] - b[i]) > 1e-4f) return 1; /* samples at voxels are rounded in the last digits */
    return 0;
}

static int named(const swarf_box *boxes, size_t count, const swarf_box *box)
{
    for (size_t i = 0; i < count; i++)
        if (memcmp(&boxes[i], box, sizeof *box) == 0) return 1;
    return 0;
}

/* Can the tool on this path come near a leaf that touches the box? By the box of all its places. */
static int within_reach(const swarf_path *path, double radius, double length, const swarf_box *box)
{
    const double margin = 3 * voxel + 8 * voxel;
    for (int k = 0; k < 3; k++) {
        const double lo = fmin(path->start[k], path->end[k]) - (k < 2 ? radius : 0) - margin;
        const double hi = fmax(path->start[k], path->end[k]) + (k < 2 ? radius : length) + margin;
        if (box->hi[k] < lo || box->lo[k] > hi) return 0;
    }
    return 1;
}

static void check_cuts(void)
{
    static swarf_box all[MOST], changed[MOST], again[MOST];
    static float before[EDGE * EDGE * EDGE], after[EDGE * EDGE * EDGE];
    test_random random = test_random_begin(91);
    swarf_cutter *cutter = NULL;
    CHECK_OK(swarf_cutter_parse("ball:d=3,l=5", &cutter));
    swarf_stock *stock = make_stock();
    size_t total = 0, count = 0, same = 0, quiet = 0;
    CHECK_OK(swarf_stock_changed(stock, 0, all, MOST, &total));
    CHECK(total > 8 && total % 64 == 0 && total <= MOST);
    const int cuts = test_size() == TEST_FULL ? 12 : test_size() == TEST_USUAL ? 6 : 4;
    for (int cut = 0; cut < cuts; cut++) {
        double c[6];
        for (int i = 0; i < 6; i++) c[i] = test_random_in(&random, block.lo[i % 3] - 3, block.hi[i % 3] + 3);
        const swarf_path path = oracle_line(c[0], c[1], c[2], c[3], c[4], c[5]);
        swarf_stock *old = NULL, *twin = NULL;
        CHECK_OK(swarf_stock_copy(stock, &old));
        CHECK_OK(swarf_stock_copy(stock, &twin));
        const uint32_t generation = swarf_stock_generation(stock);
        CHECK(generation > 0 && swarf_stock_generation(old) == generation);
        CHECK_OK(swarf_threads_set(1 + cut % 3));
        CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
        CHECK(swarf_stock_generation(stock) > generation);
        CHECK_OK(swarf_stock_changed(stock, generation, changed, MOST, &count));
        CHECK_OK(swarf_threads_set(3 - cut % 3));
        CHECK_OK(swarf_stock_cut(twin, cutter, &path, 1, NULL));
        CHECK_OK(swarf_stock_changed(twin, generation, again, MOST, &same));
        CHECK(same == count && memcmp(changed, again, count * sizeof *changed) == 0);
        for (size_t i = 0; i < total; i++) {
            read_cube(old, &all[i], before);
            read_cube(stock, &all[i], after);
            const int is_named = named(changed, count, &all[i]);
            if (differs(before, after)) CHECK(is_named);
            if (is_named) CHECK(within_reach(&path, 1.5, 5, &all[i]));
            quiet += !is_named;
        }
        CHECK_OK(swarf_stock_changed(stock, swarf_stock_generation(stock), changed, MOST, &count));
        CHECK(count == 0);
        swarf_stock_destroy(old);
        swarf_stock_destroy(twin);
    }
    CHECK(quiet > (size_t)cuts * total / 4); /* the test would see stamps everywhere */
    CHECK_OK(swarf_threads_set(0));
    swarf_stock_destroy(stock);
    swarf_cutter_release(cutter);
}

static void check_whole(void)
{
    swarf_stock *stock = make_stock(), *other = make_stock();
    size_t total = 0, count = 0;
    const uint32_t generation = swarf_stock_generation(stock);
    CHECK_OK(swarf_stock_changed(stock, 0, NULL, 0, &total));
    CHECK_OK(swarf_stock_changed(stock, generation, NULL, 0, &count));
    CHECK(total > 0 && count == 0);
    CHECK_OK(swarf_stock_boolean(stock, other, SWARF_DIFFERENCE));
    CHECK(swarf_stock_generation(stock) > generation);
    CHECK_OK(swarf_stock_changed(stock, generation, NULL, 0, &count));
    CHECK_OK(swarf_stock_changed(stock, 0, NULL, 0, &total));
    CHECK(count == total && count > 0);
    count = 7;
    CHECK_FAILS(swarf_stock_changed(NULL, 0, NULL, 0, &count), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_changed(stock, 0, NULL, 1, &count), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_changed(stock, 0, NULL, 0, NULL), SWARF_ERROR_ARGUMENT, NULL);
    CHECK(count == 7);
    CHECK(swarf_stock_generation(NULL) == 0);
    swarf_stock_destroy(stock);
    swarf_stock_destroy(other);
}

int main(void)
{
    check_cuts();
    check_whole();
    return test_end();
}
