/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cuts one slot with a flat end mill and prints what is left, beside the exact value. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <swarf/swarf.h>

static void must(swarf_status status, const char *what)
{
    if (status == SWARF_OK) return;
    fprintf(stderr, "slot: %s: %s: %s\n", what, swarf_status_name(status), swarf_error_last());
    exit(1);
}

int main(void)
{
    const swarf_box block = {{0, 0, -10}, {60, 40, 0}};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.1;
    swarf_stock *stock = NULL;
    must(swarf_stock_create_box(&block, &options, &stock), "stock");

    swarf_cutter *cutter = NULL;
    must(swarf_cutter_parse("flat:d=8,l=20", &cutter), "cutter");

    /* down into the block, then along x; the tool's tip is 4 mm below the top face */
    const swarf_path paths[] = {
        {.start = {15, 20, 5}, .end = {15, 20, -4}, .has_motion = 1},
        {.start = {15, 20, -4}, .end = {45, 20, -4}, .has_motion = 1},
    };
    must(swarf_stock_cut(stock, cutter, paths, sizeof paths / sizeof paths[0], NULL), "cut");

    double volume = 0;
    must(swarf_stock_volume(stock, &volume), "volume");
    const double pi = acos(-1.0);
    const double exact = 60 * 40 * 10 - 4 * (30 * 8 + pi * 4 * 4);
    printf("volume %.2f mm3, exact %.2f mm3\n", volume, exact);

    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
    return fabs(volume - exact) > 1e-4 * exact;
}
