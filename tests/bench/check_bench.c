/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* check_bench bear|cameo N THREADS [REPEAT [LOADS]]: what the checks cost beside cutting.
 *
 * Alternately the fixed job is simulated, and simulated with the checks (flutes, a shank and a holder against the stock
 * and a stop), with LOADS 1 besides with the loads of all moves; one line of JSON with the least seconds of each,
 * of all threads together, and their ratios. Making the stock and reading the program are left out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "jobs.h"
#include "shapes.h"

static swarf_stock *make_stock(const bench_job *j, int resolution)
{
    swarf_stock_options options = swarf_stock_options_default();
    swarf_stock *stock = NULL;
    options.voxel_mm = bench_job_voxel(j, resolution);
    bench_must(swarf_stock_create_box(&j->box, &options, &stock));
    return stock;
}

static double simulate(const bench_job *j, int resolution, const swarf_program *program, const swarf_tool *tool)
{
    swarf_stock *stock = make_stock(j, resolution);
    swarf_simulation *simulation = NULL;
    const double begin = bench_cpu();
    bench_must(
        swarf_stock_simulate(stock, program, 0, swarf_program_move_count(program), tool, 1, NULL, NULL, &simulation));
    const double seconds = bench_cpu() - begin;
    swarf_simulation_destroy(simulation);
    swarf_stock_destroy(stock);
    return seconds;
}

static double check(const bench_job *j, int resolution, const swarf_program *program, const swarf_tool *tool,
                    const swarf_solid *vice, int loads, size_t *findings)
{
    swarf_stock *stock = make_stock(j, resolution);
    swarf_check *made = NULL;
    swarf_check_options options = swarf_check_options_default();
    options.loads = loads;
    options.fixtures = &vice;
    options.fixture_count = 1;
    const double begin = bench_cpu();
    bench_must(swarf_stock_check(stock, program, 0, swarf_program_move_count(program), tool, 1, &options, NULL, &made));
    const double seconds = bench_cpu() - begin;
    swarf_check_findings(made, findings);
    swarf_check_destroy(made);
    swarf_stock_destroy(stock);
    return seconds;
}

int main(int count, char **argument)
{
    const bench_job *j = count > 1 ? bench_job_find(argument[1]) : NULL;
    if (!j || count < 4 || atoi(argument[2]) < 1) {
        fprintf(stderr, "usage: check_bench bear|cameo RESOLUTION THREADS [REPEAT [LOADS]]\n");
        return 2;
    }
    const int resolution = atoi(argument[2]), loads = count > 5 && atoi(argument[5]);
    bench_must(swarf_threads_set(atoi(argument[3])));
    swarf_program *program = bench_job_program(j);
    char text[256];
    snprintf(text, sizeof text, "%s,sd=%s,sl=20,hd=30,hl=40", j->cutter, strstr(j->cutter, "d=3") ? "3" : "2");
    swarf_cutter *cutter = NULL;
    bench_must(swarf_cutter_parse(text, &cutter));
    const swarf_tool tool = {.number = swarf_program_sections(program)[0].tool, .cutter = cutter};
    /* a stop beside the block, which nothing touches, up to a millimetre below its top */
    shape s = {0};
    const double lo[3] = {j->box.lo[0], j->box.hi[1] + 5, j->box.lo[2] - 20};
    const double hi[3] = {j->box.hi[0], j->box.hi[1] + 20, j->box.hi[2] - 1};
    shape_box(&s, lo, hi);
    const swarf_triangles view = shape_view(&s);
    swarf_solid *vice = NULL;
    bench_must(swarf_solid_create(&view, NULL, &vice));
    double best[3] = {INFINITY, INFINITY, INFINITY};
    size_t findings = 0;
    for (int repeat = count > 4 ? atoi(argument[4]) : 3; repeat > 0; repeat--) {
        best[0] = fmin(best[0], simulate(j, resolution, program, &tool));
        best[1] = fmin(best[1], check(j, resolution, program, &tool, vice, 0, &findings));
        if (loads) best[2] = fmin(best[2], check(j, resolution, program, &tool, vice, 1, &findings));
    }
    printf(
        "{\"program\": \"%s\", \"resolution\": %d, \"threads\": %d, \"moves\": %zu, \"isa\": \"%s\", \"simulate_s\": "
        "%.4f, \"check_s\": %.4f, \"ratio\": %.3f, \"findings\": %zu",
        j->name, resolution, swarf_threads(), swarf_program_move_count(program), swarf_isa_name(swarf_isa_current()),
        best[0], best[1], best[1] / best[0], findings);
    if (loads) printf(", \"loads_s\": %.4f, \"loads_ratio\": %.2f", best[2], best[2] / best[0]);
    printf("}\n");
    shape_free(&s);
    swarf_solid_release(vice);
    swarf_cutter_release(cutter);
    swarf_program_release(program);
    return 0;
}
