/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "stocks.h"

#include <stdlib.h>

swarf_stock *stock_block(const swarf_box *box, double voxel)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(box, &options, &stock))) exit(test_end());
    return stock;
}

enum { CUTTERS = 4 };

swarf_stock *stock_random(test_random *random, double voxel, double length, swarf_surface **surface)
{
    const double offset = test_random_in(random, -50, 50);
    const swarf_box box = {{offset, 0, -5}, {offset + length, 6, 0}};
    swarf_stock *stock = stock_block(&box, voxel), *first = NULL;
    swarf_program *program = NULL;
    swarf_tool tools[CUTTERS] = {{0}};
    CHECK_OK(swarf_stock_copy(stock, &first));
    CHECK_OK(swarf_program_create((double[3]){0, 0, 9}, &program));
    CHECK_OK(swarf_program_add_operation(program, "cut"));
    static const char *const cutters[CUTTERS] = {"flat:d=0.5,l=9", "ball:d=0.8,l=9", "chamfer:d=2,l=9,a=60",
                                                 "ball:d=3,l=9"};
    for (int i = 0; i < CUTTERS; i++) {
        swarf_cutter *cutter = NULL;
        const swarf_section section = {.tool = i + 1};
        if (!CHECK_OK(swarf_cutter_parse(cutters[i], &cutter))) exit(test_end());
        CHECK_OK(swarf_program_set_section(program, &section));
        tools[i] = (swarf_tool){.number = i + 1, .cutter = cutter};
        enum { PATHS = 12 };
        swarf_path paths[PATHS] = {0};
        for (int k = 0; k < PATHS; k++) {
            paths[k].has_motion = 1;
            for (int c = 0; c < 2; c++) {
                paths[k].start[c] = (c == 0 ? offset : 0) + test_random_in(random, -1, c == 0 ? length + 1 : 7);
                paths[k].end[c] = (c == 0 ? offset : 0) + test_random_in(random, -1, c == 0 ? length + 1 : 7);
            }
            paths[k].start[2] = test_random_in(random, -5.5, 0.5);
            paths[k].end[2] = test_random_below(random, 2) ? paths[k].start[2] : test_random_in(random, -5.5, 0.5);
        }
        const size_t count = 1 + test_random_below(random, PATHS);
        CHECK_OK(swarf_stock_cut(stock, cutter, paths, count, NULL));
        for (size_t k = 0; k < count; k++) {
            CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_POSITION, paths[k].start, 0, 1));
            CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, paths[k].end, 100, 1));
        }
    }
    CHECK_OK(swarf_surface_create(first, program, tools, CUTTERS, NULL, surface));
    for (int i = 0; i < CUTTERS; i++) swarf_cutter_release((swarf_cutter *)tools[i].cutter);
    swarf_program_release(program);
    swarf_stock_destroy(first);
    return stock;
}
