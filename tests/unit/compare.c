/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock against design by volume, in closed form. */
#include <math.h>

#include "shapes.h"
#include "test.h"

static void check_box(double lo, double hi, double excess, double gouge)
{
    const swarf_box bounds = {{0, 0, 0}, {10, 10, 10}};
    const double low[3] = {lo, 0, 0}, high[3] = {hi, 10, 10};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.1;
    swarf_stock *stock = NULL;
    shape design = {0};
    shape_box(&design, low, high);
    const swarf_triangles triangles = shape_view(&design);
    swarf_solid *solid = NULL;
    CHECK_OK(swarf_solid_create(&triangles, NULL, &solid));
    CHECK(swarf_solid_retain(solid) == solid && !swarf_solid_retain(NULL));
    swarf_solid_release(solid);
    swarf_comparison result;
    uint64_t before, after;
    if (CHECK_OK(swarf_stock_create_box(&bounds, &options, &stock))) {
        CHECK_OK(swarf_stock_hash(stock, &before));
        if (CHECK_OK(swarf_compare_volume(stock, solid, NULL, &result))) {
            CHECK_NEAR(result.design_mm3, 100 * (hi - lo), 1e-3);
            CHECK_NEAR(result.stock_mm3, 1000, 0.1);
            CHECK_NEAR(result.excess_mm3, excess, 0.5);
            CHECK_NEAR(result.gouge_mm3, gouge, 0.5);
        }
        CHECK_OK(swarf_stock_hash(stock, &after));
        CHECK(before == after);
    }
    swarf_solid_release(solid);
    swarf_stock_destroy(stock);
    shape_free(&design);
}

static void check_refusals(void)
{
    const swarf_box bounds = {{0, 0, 0}, {10, 10, 10}};
    const double low[3] = {0, 0, 0}, high[3] = {10, 10, 10};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.5;
    swarf_stock *stock = NULL;
    shape design = {0};
    shape_box(&design, low, high);
    swarf_triangles triangles = shape_view(&design);
    swarf_solid *solid = NULL;
    triangles.triangle_count--;
    CHECK_FAILS(swarf_solid_create(&triangles, NULL, &solid), SWARF_ERROR_GEOMETRY, "open");
    triangles.triangle_count++;
    CHECK_OK(swarf_solid_create(&triangles, NULL, &solid));
    swarf_comparison result;
    if (CHECK_OK(swarf_stock_create_box(&bounds, &options, &stock))) {
        CHECK_FAILS(swarf_compare_volume(stock, NULL, NULL, &result), SWARF_ERROR_ARGUMENT, NULL);
        CHECK_FAILS(swarf_compare_volume(NULL, solid, NULL, &result), SWARF_ERROR_ARGUMENT, NULL);
    }
    swarf_solid_release(solid);
    swarf_stock_destroy(stock);
    shape_free(&design);
}

int main(void)
{
    check_box(0.5, 10, 50, 0);
    check_box(0, 10.5, 0, 50);
    check_box(2, 13, 200, 300);   /* both */
    check_box(-30, 5, 500, 3000); /* nodes before the stock's first */
    check_box(40, 45, 1000, 500); /* nothing in common */
    check_refusals();
    return test_end();
}
