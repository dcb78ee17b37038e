/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "milled.h"

const swarf_box milled_block = {{0, 0, -10}, {60, 40, 0}};

void milled_line(milled *j, swarf_move_kind kind, double x, double y, double z, uint32_t number)
{
    const double end[3] = {x, y, z};
    CHECK_OK(swarf_program_add_line(j->program, kind, end, 300, number));
}

milled milled_begin(const char *cutter, double voxel)
{
    milled j = {0};
    const double start[3] = {30, 20, 10};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    CHECK_OK(swarf_program_create(start, &j.program));
    CHECK_OK(swarf_program_add_operation(j.program, "pocket"));
    const swarf_section section = {.tool = 1, .spindle = SWARF_SPINDLE_CW, .spindle_rpm = 8000};
    CHECK_OK(swarf_program_set_section(j.program, &section));
    CHECK_OK(swarf_cutter_parse(cutter, &j.cutter));
    CHECK_OK(swarf_stock_create_box(&milled_block, &options, &j.first));
    CHECK_OK(swarf_stock_copy(j.first, &j.stock));
    j.tool = (swarf_tool){.number = 1, .cutter = j.cutter};
    return j;
}

void milled_cut(milled *j)
{
    swarf_simulation *simulation = NULL;
    CHECK_OK(swarf_stock_simulate(j->stock, j->program, 0, swarf_program_move_count(j->program), &j->tool, 1, NULL,
                                  NULL, &simulation));
    swarf_simulation_destroy(simulation);
}

void milled_end(milled *j)
{
    swarf_program_release(j->program);
    swarf_cutter_release(j->cutter);
    swarf_stock_destroy(j->first);
    swarf_stock_destroy(j->stock);
}

void milled_pocket(milled *j, double depth)
{
    uint32_t number = 1;
    milled_line(j, SWARF_MOVE_RAPID, 22, 17, 5, number++);
    milled_line(j, SWARF_MOVE_FEED, 22, 17, -depth, number++);
    milled_line(j, SWARF_MOVE_FEED, 38, 17, -depth, number++);
    milled_line(j, SWARF_MOVE_FEED, 38, 23, -depth, number++);
    milled_line(j, SWARF_MOVE_FEED, 22, 23, -depth, number++);
    milled_line(j, SWARF_MOVE_FEED, 22, 17, -depth, number++);
    milled_line(j, SWARF_MOVE_FEED, 22, 20, -depth, number++);
    milled_line(j, SWARF_MOVE_FEED, 38, 20, -depth, number++);
    milled_line(j, SWARF_MOVE_FEED, 38, 20, 5, number++);
}

swarf_deviation *milled_deviation(milled *j, const swarf_solid *design, double tolerance)
{
    swarf_deviation_options options = swarf_deviation_options_default();
    options.excess_mm = options.gouge_mm = tolerance;
    options.first = j->first;
    swarf_deviation *deviation = NULL;
    CHECK_OK(swarf_deviation_create(j->stock, design, &options, NULL, &deviation));
    if (deviation) CHECK_OK(swarf_deviation_find_moves(deviation, j->program, &j->tool, 1, NULL));
    return deviation;
}
