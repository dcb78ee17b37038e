/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The volume within the surface, as contouring tells it, against columns in closed form: of blocks after random moves,
 * and of the two programs of the shared data; the same with every vertex and after simplifying. */
#include "columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "jobs.h"
#include "stocks.h"

static swarf_contour_report contour(swarf_stock *stock, const swarf_surface *surface, double error_mm)
{
    swarf_contour_options options = swarf_contour_options_default();
    swarf_contour_report report = {0};
    swarf_mesh *mesh = NULL;
    options.surface = surface;
    options.error_mm = error_mm;
    CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report));
    swarf_mesh_release(mesh);
    return report;
}

/* `bound`: relative, of what is seen and unseen together. */
static void check_volume(const char *what, swarf_stock *stock, const swarf_surface *surface, double left, double bound)
{
    const double voxel = swarf_stock_voxel(stock);
    for (int simple = 0; simple < 2; simple++) {
        const swarf_contour_report report = contour(stock, surface, simple * 0.1 * voxel);
        const int good = CHECK_NEAR(report.surface_mm3 + report.unseen_mm3, left, bound * left);
        if (!good || test_size() == TEST_FULL)
            printf("%s, error %.1f voxel: columns %.4f mm3, surface %+.2e, with unseen %+.2e\n", what, simple * 0.1,
                   left, report.surface_mm3 / left - 1, (report.surface_mm3 + report.unseen_mm3) / left - 1);
    }
}

static void check_job(const char *name, int resolution, double bound)
{
    const bench_job *job = bench_job_find(name);
    const columns_cutter cutter = strcmp(name, "bear") == 0 ? (columns_cutter){1.5, 18, 0} : (columns_cutter){1, 4, 1};
    size_t count;
    swarf_path *paths = bench_job_paths(job, &count);
    swarf_surface *surface = NULL;
    swarf_stock *stock = bench_job_cut(job, bench_job_voxel(job, resolution), &surface);
    char what[64];
    snprintf(what, sizeof what, "%s at N = %d", name, resolution);
    check_volume(what, stock, surface, columns_left(&job->box, &cutter, paths, count), bound);
    swarf_surface_release(surface);
    swarf_stock_destroy(stock);
    free(paths);
}

/* Of wedges between moves the last voxel is in neither: that much at voxels of a hundredth of the block. */
static const double wedges = 2.5e-4;

enum { MOVES = 8 };

static void check_random(test_random *random, int number)
{
    static const swarf_box block = {{-3, -2.5, -2}, {3, 2.5, 0}};
    const columns_cutter cutter = {test_random_in(random, 0.5, 1.5), 5, (int)test_random_below(random, 2)};
    const swarf_section section = {.tool = 1};
    swarf_path paths[MOVES] = {0};
    swarf_cutter *tool = NULL;
    swarf_program *program = NULL;
    swarf_surface *surface = NULL;
    swarf_stock *stock = stock_block(&block, test_random_in(random, 0.03, 0.06)), *first = NULL;
    char text[64], what[128];
    snprintf(text, sizeof text, "%s:d=%.17g,l=%g", cutter.ball ? "ball" : "flat", 2 * cutter.radius, cutter.length);
    snprintf(what, sizeof what, "random program %d, %s", number, text);
    CHECK_OK(swarf_cutter_parse(text, &tool));
    CHECK_OK(swarf_stock_copy(stock, &first));
    CHECK_OK(swarf_program_create((double[3]){0, 0, 9}, &program));
    CHECK_OK(swarf_program_add_operation(program, "cut"));
    CHECK_OK(swarf_program_set_section(program, &section));
    for (int i = 0; i < MOVES; i++) {
        paths[i].has_motion = 1;
        for (int k = 0; k < 3; k++) {
            paths[i].start[k] = test_random_in(random, k < 2 ? -4 : -1.7, k < 2 ? 4 : -0.2);
            paths[i].end[k] = test_random_in(random, k < 2 ? -4 : -1.7, k < 2 ? 4 : -0.2);
        }
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_POSITION, paths[i].start, 0, 1));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, paths[i].end, 100, 1));
    }
    CHECK_OK(swarf_stock_cut(stock, tool, paths, MOVES, NULL));
    const swarf_tool tools = {.number = 1, .cutter = tool};
    CHECK_OK(swarf_surface_create(first, program, &tools, 1, NULL, &surface));
    check_volume(what, stock, surface, columns_left(&block, &cutter, paths, MOVES), wedges);
    swarf_surface_release(surface);
    swarf_program_release(program);
    swarf_cutter_release(tool);
    swarf_stock_destroy(first);
    swarf_stock_destroy(stock);
}

int main(void)
{
    test_random random = test_random_begin(77);
    const int full = test_size() == TEST_FULL;
    for (int i = 0; i < (full ? 40 : 6); i++) check_random(&random, i);
    if (!test_shared()[0]) {
        printf("bear and cameo left out: no folder of shared data (SWARF_SHARED)\n");
        return test_end();
    }
    check_job("bear", 256, 4e-5); /* what is between surface and triangles is sampled: the coarser, the fewer */
    if (!full) return test_end();
    check_job("bear", 512, 1e-5);
    check_job("bear", 1024, 1e-5);
    /* Of its relief columns know no more than 1e-4; and of crests thinner than a voxel that are in the mesh, coarse
     * voxels tell some as unseen. */
    check_job("cameo", 512, 2e-4);
    check_job("cameo", 1024, 1e-4);
    return test_end();
}
