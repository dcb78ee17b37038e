/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Union, intersection and difference of stocks: volumes in closed form, frames apart by whole voxels. */
#include <math.h>

#include "test.h"

static swarf_stock *block(double x, double y, double z, double edge, double voxel)
{
    const swarf_box box = {{x, y, z}, {x + edge, y + edge, z + edge}};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    swarf_stock *stock = NULL;
    CHECK_OK(swarf_stock_create_box(&box, &options, &stock));
    return stock;
}

/* Boxes of 10 mm, the second moved by `at` along the diagonal; the result of `operation`. */
static double combined(double at, swarf_boolean operation)
{
    swarf_stock *one = block(0, 0, 0, 10, 0.2), *two = block(at, at, at, 10, 0.2);
    double volume = NAN, before = NAN, after = NAN;
    if (one && two) {
        CHECK_OK(swarf_stock_volume(two, &before));
        CHECK_OK(swarf_stock_boolean(one, two, operation));
        CHECK_OK(swarf_stock_volume(one, &volume));
        CHECK_OK(swarf_stock_volume(two, &after));
        CHECK_NEAR(after, before, 0);
    }
    swarf_stock_destroy(one);
    swarf_stock_destroy(two);
    return volume;
}

static void check_volumes(void)
{
    /* 0, a few voxels, more than the block, a whole node away, and back */
    static const double places[] = {0, 1, 4.6, 9.8, 11, 25.6, 60, -3, -30};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const double overlap = fmax(0, 10 - fabs(places[i])), common = overlap * overlap * overlap;
        CHECK_NEAR(combined(places[i], SWARF_UNION), 2000 - common, 0.5);
        CHECK_NEAR(combined(places[i], SWARF_INTERSECTION), common, 0.5);
        CHECK_NEAR(combined(places[i], SWARF_DIFFERENCE), 1000 - common, 0.5);
    }
}

static void check_further_cuts(void)
{
    /* the result is a stock like any other */
    swarf_stock *one = block(0, 0, 0, 10, 0.2), *two = block(7, 7, 7, 10, 0.2), *copy = NULL;
    if (one && two && CHECK_OK(swarf_stock_boolean(one, two, SWARF_UNION)) && CHECK_OK(swarf_stock_copy(one, &copy))) {
        uint64_t a, b;
        CHECK_OK(swarf_stock_hash(one, &a));
        CHECK_OK(swarf_stock_hash(copy, &b));
        CHECK(a == b);
        CHECK_OK(swarf_stock_boolean(one, one, SWARF_UNION));
        CHECK_OK(swarf_stock_boolean(one, one, SWARF_INTERSECTION));
        CHECK_OK(swarf_stock_hash(one, &b));
        CHECK(a == b);
        CHECK_OK(swarf_stock_boolean(one, two, SWARF_DIFFERENCE));
        double volume;
        if (CHECK_OK(swarf_stock_volume(one, &volume))) CHECK_NEAR(volume, 1000 - 27, 0.5);
        swarf_box box;
        if (CHECK_OK(swarf_stock_box(copy, &box))) {
            CHECK_NEAR(box.lo[0], 0, 0.1);
            CHECK_NEAR(box.hi[2], 17, 0.1);
        }
    }
    swarf_stock_destroy(one);
    swarf_stock_destroy(two);
    swarf_stock_destroy(copy);
}

static void check_refusals(void)
{
    swarf_stock *one = block(0, 0, 0, 10, 0.2), *half = block(0.1, 0, 0, 10, 0.2), *coarse = block(0, 0, 0, 10, 0.25);
    CHECK_FAILS(swarf_stock_boolean(one, half, SWARF_UNION), SWARF_ERROR_ARGUMENT, "along x");
    CHECK_FAILS(swarf_stock_boolean(one, coarse, SWARF_UNION), SWARF_ERROR_ARGUMENT, "0.25");
    swarf_stock *far = block(9e5, 9e5, 9e5, 10, 0.2); /* the nodes between would take eighty thousand GiB */
    CHECK_FAILS(swarf_stock_boolean(one, far, SWARF_UNION), SWARF_ERROR_MEMORY, "far apart");
    swarf_stock_destroy(far);
    CHECK_FAILS(swarf_stock_boolean(one, NULL, SWARF_UNION), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_boolean(one, one, (swarf_boolean)3), SWARF_ERROR_ARGUMENT, "3");
    double volume;
    if (CHECK_OK(swarf_stock_volume(one, &volume))) CHECK_NEAR(volume, 1000, 0.01);
    swarf_stock_destroy(one);
    swarf_stock_destroy(half);
    swarf_stock_destroy(coarse);
}

int main(void)
{
    check_volumes();
    check_further_cuts();
    check_refusals();
    return test_end();
}
