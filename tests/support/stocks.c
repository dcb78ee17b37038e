/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "stocks.h"

#include <math.h>
#include <stdlib.h>

swarf_stock *stock_block(const swarf_box *box, double voxel)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(box, &options, &stock))) exit(test_end());
    return stock;
}

double stock_volume(swarf_stock *stock)
{
    double volume = NAN;
    CHECK_OK(swarf_stock_volume(stock, &volume));
    return volume;
}

uint64_t stock_hash(swarf_stock *stock)
{
    uint64_t hash = 0;
    CHECK_OK(swarf_stock_hash(stock, &hash));
    return hash;
}

enum { CUTTERS = 4, PATHS = STOCK_CUTS / CUTTERS };
static const char *const cutters[CUTTERS] = {"flat:d=0.5,l=9", "ball:d=0.8,l=9", "chamfer:d=2,l=9,a=60",
                                             "ball:d=3,l=9"};

int stock_random_cuts(test_random *random, double length, swarf_box *box, stock_cut out[STOCK_CUTS])
{
    const double offset = test_random_in(random, -50, 50);
    int count = 0;
    *box = (swarf_box){{offset, 0, -5}, {offset + length, 6, 0}};
    for (int i = 0; i < CUTTERS; i++) {
        for (int k = 0; k < PATHS; k++) {
            swarf_path *path = &out[count + k].path;
            out[count + k] = (stock_cut){.cutter = cutters[i], .path = {.has_motion = 1}};
            for (int c = 0; c < 2; c++) {
                path->start[c] = (c == 0 ? offset : 0) + test_random_in(random, -1, c == 0 ? length + 1 : 7);
                path->end[c] = (c == 0 ? offset : 0) + test_random_in(random, -1, c == 0 ? length + 1 : 7);
            }
            path->start[2] = test_random_in(random, -5.5, 0.5);
            path->end[2] = test_random_below(random, 2) ? path->start[2] : test_random_in(random, -5.5, 0.5);
        }
        count += 1 + (int)test_random_below(random, PATHS);
    }
    return count;
}

swarf_stock *stock_random(test_random *random, double voxel, double length, swarf_surface **surface)
{
    stock_cut cuts[STOCK_CUTS];
    swarf_box box;
    const int count = stock_random_cuts(random, length, &box, cuts);
    swarf_stock *stock = stock_block(&box, voxel), *first = NULL;
    swarf_program *program = NULL;
    swarf_tool tools[CUTTERS] = {{0}};
    CHECK_OK(swarf_stock_copy(stock, &first));
    CHECK_OK(swarf_program_create((double[3]){0, 0, 9}, &program));
    CHECK_OK(swarf_program_add_operation(program, "cut"));
    for (int i = 0, k = 0; i < CUTTERS; i++) {
        swarf_cutter *cutter = NULL;
        const swarf_section section = {.tool = i + 1};
        if (!CHECK_OK(swarf_cutter_parse(cutters[i], &cutter))) exit(test_end());
        CHECK_OK(swarf_program_set_section(program, &section));
        tools[i] = (swarf_tool){.number = i + 1, .cutter = cutter};
        swarf_path paths[PATHS];
        size_t own = 0;
        for (; k < count && cuts[k].cutter == cutters[i]; k++) {
            paths[own++] = cuts[k].path;
            CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_POSITION, cuts[k].path.start, 0, 1));
            CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, cuts[k].path.end, 100, 1));
        }
        CHECK_OK(swarf_stock_cut(stock, cutter, paths, own, NULL));
    }
    CHECK_OK(swarf_surface_create(first, program, tools, CUTTERS, NULL, surface));
    for (int i = 0; i < CUTTERS; i++) swarf_cutter_release((swarf_cutter *)tools[i].cutter);
    swarf_program_release(program);
    swarf_stock_destroy(first);
    return stock;
}
