/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* surface_bench PROGRAM N THREADS [POINTS]: cut a fixed job, then move the vertices of its mesh onto the exact surface.
 * PROGRAM is bear or cameo (see shared data); prints one line of JSON. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "test.h"

typedef struct job {
    const char *name;
    const char *cutter;
    swarf_box box;
} job;

/* As in cut_bench. */
static const job jobs[] = {
    {"bear", "flat:d=3,l=18", {{0, 0, -20}, {80, 80, 0}}},
    {"cameo", "ball:d=2,l=4", {{-83.6, -104.153, -6}, {83.6, 103.747, 0}}},
};

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void must(swarf_status status)
{
    if (status == SWARF_OK) return;
    fprintf(stderr, "surface_bench: %s\n", swarf_error_last());
    exit(2);
}

int main(int count, char **argument)
{
    const job *j = NULL;
    for (size_t i = 0; count > 1 && i < sizeof jobs / sizeof jobs[0]; i++)
        if (strcmp(argument[1], jobs[i].name) == 0) j = &jobs[i];
    if (!j || count < 4 || count > 5 || atoi(argument[2]) < 1) {
        fprintf(stderr, "usage: surface_bench bear|cameo RESOLUTION THREADS [POINTS]\n");
        return 2;
    }
    if (!test_shared()[0]) {
        fprintf(stderr, "surface_bench: skipped, no folder of shared data: set SWARF_SHARED\n");
        return 77;
    }
    must(swarf_threads_set(atoi(argument[3])));
    char path[2048];
    snprintf(path, sizeof path, "%s/data/%s.nc", test_shared(), j->name);
    swarf_gcode_options reading = swarf_gcode_options_default();
    reading.start[0] = reading.start[1] = 0;
    reading.start[2] = 50;
    swarf_program *program = NULL;
    must(swarf_gcode_read_file(path, &reading, NULL, &program));
    const size_t moves = swarf_program_move_count(program), sections = swarf_program_section_count(program);
    swarf_tool *tools = calloc(sections + 1, sizeof *tools);
    swarf_cutter *cutter = NULL;
    must(swarf_cutter_parse(j->cutter, &cutter));
    for (size_t i = 0; i < sections; i++) tools[i] = (swarf_tool){swarf_program_sections(program)[i].tool, 0, cutter};
    double longest = 0;
    for (int k = 0; k < 3; k++) longest = fmax(longest, j->box.hi[k] - j->box.lo[k]);
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = longest / atoi(argument[2]);
    swarf_stock *stock = NULL;
    swarf_surface *surface = NULL;
    must(swarf_stock_create_box(&j->box, &options, &stock));
    const double t_build = now();
    must(swarf_surface_create(stock, program, tools, sections, NULL, &surface));
    const double build_s = now() - t_build;
    swarf_simulation *simulation = NULL;
    must(swarf_stock_simulate(stock, program, 0, moves, tools, sections, NULL, NULL, &simulation));
    swarf_mesh *mesh = NULL;
    must(swarf_mesh_create_stock(stock, 0, NULL, &mesh));
    const swarf_triangles view = swarf_mesh_triangles(mesh);
    size_t points = view.vertex_count;
    if (count > 4 && (size_t)atol(argument[4]) < points) points = (size_t)atol(argument[4]);
    double *xyz = malloc((points + 1) * 24), *normal = malloc((points + 1) * 24), *out = malloc((points + 1) * 24);
    int64_t *move = malloc((points + 1) * 8);
    if (!tools || !xyz || !normal || !out || !move) return 2;
    memset(normal, 0, points * 24);
    for (size_t i = 0; i < 3 * points; i++) xyz[i] = (double)view.xyz[i];
    for (size_t i = 0; i < view.triangle_count; i++) { /* directions: summed normals of the triangles */
        const uint32_t *at = view.index + 3 * i;
        double e[2][3];
        for (int s = 0; s < 2; s++)
            for (int k = 0; k < 3; k++) e[s][k] = (double)view.xyz[3 * at[s + 1] + k] - (double)view.xyz[3 * at[0] + k];
        for (int s = 0; s < 3; s++)
            for (int k = 0; k < 3 && at[s] < points; k++)
                normal[3 * at[s] + k] += e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
    }
    for (size_t i = 0; i < points; i++)
        if (normal[3 * i] == 0 && normal[3 * i + 1] == 0 && normal[3 * i + 2] == 0) normal[3 * i + 2] = 1;
    const double t_refine = now();
    must(swarf_surface_refine(surface, moves, xyz, normal, points, options.voxel_mm, NULL, out, normal, move));
    const double refine_s = now() - t_refine;
    size_t none = 0;
    double sum = 0, most = 0;
    for (size_t i = 0; i < points; i++) {
        none += move[i] == -2;
        double square = 0;
        for (int k = 0; k < 3; k++) square += (out[3 * i + k] - xyz[3 * i + k]) * (out[3 * i + k] - xyz[3 * i + k]);
        sum += square;
        most = fmax(most, square);
    }
    printf("{\"program\": \"%s\", \"resolution\": %s, \"threads\": %d, \"moves\": %zu, \"points\": %zu, "
           "\"build_s\": %.4f, \"refine_s\": %.4f, \"without\": %zu, \"moved_rms_voxel\": %.4f, "
           "\"moved_most_voxel\": %.4f}\n",
           j->name, argument[2], swarf_threads(), moves, points, build_s, refine_s, none,
           sqrt(sum / (double)(points + !points)) / options.voxel_mm, sqrt(most) / options.voxel_mm);
    free(xyz);
    free(normal);
    free(out);
    free(move);
    free(tools);
    swarf_mesh_release(mesh);
    swarf_simulation_destroy(simulation);
    swarf_stock_destroy(stock);
    swarf_surface_release(surface);
    swarf_cutter_release(cutter);
    swarf_program_release(program);
    return 0;
}
