/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Rays stop at floors wherever these lie between the voxels, through voxel centres above all: there the value is 0 but
 * for rounding, and a ray may seem outside of the cell above and inside of the one below. */
#include <math.h>

#include "test.h"

/* The floor of the bracket's pocket lies on voxel centres with values of about -1e-17 there. */
static void check_bracket(void)
{
    const swarf_box box = {{0, 0, -12}, {60, 40, 0}};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.2;
    char path[1100];
    snprintf(path, sizeof path, "%s/examples/bracket.nc", test_source());
    swarf_program *program = NULL;
    swarf_cutter *cutters[2] = {NULL, NULL};
    swarf_stock *stock = NULL;
    swarf_simulation *simulation = NULL;
    swarf_scene *scene = NULL;
    CHECK_OK(swarf_gcode_read_file(path, NULL, NULL, &program));
    CHECK_OK(swarf_cutter_parse("flat:d=6,l=20", &cutters[0]));
    CHECK_OK(swarf_cutter_parse("drill:d=4,l=40", &cutters[1]));
    const swarf_tool tools[] = {{1, 0, cutters[0]}, {2, 0, cutters[1]}};
    CHECK_OK(swarf_stock_create_box(&box, &options, &stock));
    CHECK_OK(
        swarf_stock_simulate(stock, program, 0, swarf_program_move_count(program), tools, 2, NULL, NULL, &simulation));
    CHECK_OK(swarf_scene_create(stock, &scene));
    for (int k = 0; k < 41 * 41; k++) {
        const double origin[3] = {16 + 0.1 * (k % 41), 21 + 0.1 * (k / 41), 10}, down[3] = {0, 0, -1};
        double distance = 0;
        CHECK_OK(swarf_scene_cast(scene, origin, down, 1, &distance, NULL));
        CHECK_NEAR(distance, 16.5, 0.02 * options.voxel_mm);
    }
    swarf_scene_destroy(scene);
    swarf_simulation_destroy(simulation);
    swarf_stock_destroy(stock);
    for (int i = 0; i < 2; i++) swarf_cutter_release(cutters[i]);
    swarf_program_release(program);
}

int main(void)
{
    check_bracket();
    const swarf_box box = {{0, 0, -12}, {20, 20, 0}};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.2;
    swarf_cutter *cutter = NULL;
    CHECK_OK(swarf_cutter_parse("flat:d=8,l=30", &cutter));
    test_random random = test_random_begin(11);
    for (int i = 0; i < 12; i++) {
        const double floor_z = i < 6 ? -10.1 + 0.2 * (i * 9) : test_random_in(&random, -11, -1);
        swarf_stock *stock = NULL;
        swarf_scene *scene = NULL;
        if (!CHECK_OK(swarf_stock_create_box(&box, &options, &stock))) continue;
        const swarf_path path = {.start = {6, 10, floor_z}, .end = {14, 10, floor_z}, .has_motion = 1};
        CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
        CHECK_OK(swarf_scene_create(stock, &scene));
        long wrong = 0;
        for (int k = 0; k < 2000; k++) {
            /* upright and slanting rays that end in the pocket; every other one through voxel centres or on cell planes
             */
            const double at[3] = {k & 1 ? 6.1 + 0.2 * (k % 39) : test_random_in(&random, 6, 14),
                                  k & 1 ? 8.0 + 0.1 * (k % 41) : test_random_in(&random, 8, 12), floor_z};
            const double tilt = k & 2 ? 0 : test_random_in(&random, -0.05, 0.05);
            const double direction[3] = {tilt, 0, -1}, height = 30;
            const double origin[3] = {at[0] - tilt * height, at[1], at[2] + height};
            double distance = 0;
            float normal[3];
            CHECK_OK(swarf_scene_cast(scene, origin, direction, 1, &distance, normal));
            wrong += !(fabs(distance - height) < 0.02 * options.voxel_mm) || !(normal[2] > 0.99f);
        }
        if (!CHECK(wrong == 0)) fprintf(stderr, "    floor at %.17g: %ld of 2000 rays wrong\n", floor_z, wrong);
        swarf_scene_destroy(scene);
        swarf_stock_destroy(stock);
    }
    swarf_cutter_release(cutter);
    return test_end();
}
