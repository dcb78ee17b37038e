/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What a simulation says of its operations: volumes, and findings where nothing is cut. */
#include <string.h>

#include "test.h"

static const swarf_box block = {{0, 0, 0}, {20, 10, 5}};

static swarf_cutter *flat(void)
{
    swarf_dimensions dimensions = swarf_dimensions_default();
    dimensions.diameter = 4;
    dimensions.length = 10;
    swarf_cutter *cutter = NULL;
    CHECK_OK(swarf_cutter_create_shape(SWARF_SHAPE_FLAT, &dimensions, &cutter));
    return cutter;
}

/* One operation with a straight move at a height. */
static void add_operation(swarf_program *program, const char *name, int operation, int tool, double z)
{
    CHECK_OK(swarf_program_add_operation(program, name));
    const swarf_section section = {.tool = tool, .operation = operation, .spindle = SWARF_SPINDLE_CW};
    CHECK_OK(swarf_program_set_section(program, &section));
    const double from[3] = {-5, 5, z}, to[3] = {25, 5, z};
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, from, 0, 10u * (uint32_t)operation + 1));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, to, 300, 10u * (uint32_t)operation + 2));
}

static void check_findings(void)
{
    swarf_cutter *cutter = flat();
    const swarf_tool tools[] = {{.number = 1, .cutter = cutter}};
    const double start[3] = {-5, 5, 9};
    swarf_program *program = NULL;
    swarf_stock *stock = NULL;
    swarf_simulation *simulation = NULL;
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.25;
    CHECK_OK(swarf_program_create(start, &program));
    add_operation(program, "slot", 0, 1, 3);
    add_operation(program, "again", 1, 1, 3);
    add_operation(program, "above", 2, 1, 6);
    add_operation(program, "unknown", 3, 7, 3);
    CHECK_OK(swarf_stock_create_box(&block, &options, &stock));
    const size_t moves = swarf_program_move_count(program);
    CHECK_OK(swarf_stock_simulate(stock, program, 0, moves, tools, 1, NULL, NULL, &simulation));

    size_t count = 0;
    const double *removed = swarf_simulation_removed(simulation, &count);
    if (CHECK(count == 4)) {
        CHECK_NEAR(removed[0], 20.0 * 4 * 2, 0.02);
        CHECK(removed[1] == 0 && removed[2] == 0 && removed[3] == 0);
    }
    const swarf_finding *findings = swarf_simulation_findings(simulation, &count);
    if (CHECK(count == 3)) {
        CHECK(findings[0].severity == SWARF_ERROR && findings[0].operation == 3 && findings[0].tool == 7);
        CHECK(strstr(findings[0].text, "'unknown': tool T7 is not in the tool table") != NULL);
        for (int i = 1; i < 3; i++) {
            CHECK(findings[i].severity == SWARF_NOTE && findings[i].operation == i && findings[i].tool == 1);
            CHECK(findings[i].line > 10u * (unsigned)i && findings[i].line < 10u * (unsigned)i + 3);
            CHECK(strstr(findings[i].text, i == 1 ? "'again' removes nothing" : "'above' removes nothing") != NULL);
        }
    }
    swarf_simulation_destroy(simulation);

    /* of a part of the program there is nothing to say */
    CHECK_OK(swarf_stock_simulate(stock, program, 0, 3, tools, 1, NULL, NULL, &simulation));
    swarf_simulation_findings(simulation, &count);
    CHECK(count == 0);
    swarf_simulation_destroy(simulation);
    swarf_stock_destroy(stock);
    swarf_program_release(program);
    swarf_cutter_release(cutter);
}

int main(void)
{
    check_findings();
    return test_end();
}
