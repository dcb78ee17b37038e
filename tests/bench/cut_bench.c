/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* cut_bench PROGRAM N THREADS BATCH [REPEAT]: cut a fixed job and print one line of JSON for each run.
 *
 * PROGRAM is bear or cameo (see shared data); N the voxels along the longest edge of the stock; BATCH the moves per
 * call, 0 for all at once. Reading the program, the volume and the hash are outside "total".
 */
#include <inttypes.h>
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

/* The jobs of the prototype this is measured against, to the digit. */
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
    fprintf(stderr, "cut_bench: %s\n", swarf_error_last());
    exit(2);
}

static swarf_path *read_paths(const job *j, size_t *count)
{
    char path[2048];
    if (!test_shared()[0]) {
        fprintf(stderr, "cut_bench: skipped, no folder of shared data: set SWARF_SHARED\n");
        exit(77);
    }
    snprintf(path, sizeof path, "%s/data/%s.nc", test_shared(), j->name);
    swarf_gcode_options options = swarf_gcode_options_default();
    options.start[0] = options.start[1] = 0;
    options.start[2] = 50;
    swarf_program *program = NULL;
    must(swarf_gcode_read_file(path, &options, NULL, &program));
    const size_t moves = swarf_program_move_count(program);
    swarf_path *paths = malloc((moves + 1) * sizeof *paths);
    if (!paths) exit(2);
    *count = 0;
    for (size_t i = 0; i < moves; i++) {
        must(swarf_program_path(program, i, &paths[*count]));
        *count += paths[*count].has_motion != 0;
    }
    swarf_program_release(program);
    return paths;
}

static void run(const job *j, int resolution, size_t batch)
{
    double longest = 0;
    for (int i = 0; i < 3; i++)
        if (j->box.hi[i] - j->box.lo[i] > longest) longest = j->box.hi[i] - j->box.lo[i];
    swarf_cutter *cutter = NULL;
    must(swarf_cutter_parse(j->cutter, &cutter));
    size_t count = 0, leaves = 0, bytes = 0;
    const double t_read = now();
    swarf_path *paths = read_paths(j, &count);
    const double t_create = now();
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = longest / resolution;
    swarf_stock *stock = NULL;
    must(swarf_stock_create_box(&j->box, &options, &stock));
    const double t_cut = now();
    const size_t step = batch ? batch : count;
    for (size_t i = 0; i < count; i += step)
        must(swarf_stock_cut(stock, cutter, paths + i, count - i < step ? count - i : step, NULL));
    const double t_finish = now();
    must(swarf_stock_size(stock, &leaves, &bytes)); /* makes the leaves of the untouched faces */
    const double t_end = now();
    const size_t peak = swarf_memory_peak();
    double volume = 0;
    uint64_t hash = 0;
    must(swarf_stock_volume(stock, &volume));
    must(swarf_stock_hash(stock, &hash));
    printf(
        "{\"program\": \"%s\", \"resolution\": %d, \"threads\": %d, \"batch\": %zu, \"moves\": %zu, \"isa\": \"%s\", "
        "\"version\": \"%s\", \"read_s\": %.6f, \"create_s\": %.6f, \"cut_s\": %.6f, \"finish_s\": %.6f, "
        "\"total_s\": %.6f, \"leaves\": %zu, \"tree_mb\": %.1f, \"peak_mb\": %.1f, \"volume_mm3\": %.4f, "
        "\"hash\": \"%016" PRIx64 "\"}\n",
        j->name, resolution, swarf_threads(), batch, count, swarf_isa_name(swarf_isa_current()), swarf_version(),
        t_create - t_read, t_cut - t_create, t_finish - t_cut, t_end - t_finish, t_end - t_create, leaves,
        (double)bytes / 1048576, (double)peak / 1048576, volume, hash);
    fflush(stdout);
    swarf_stock_destroy(stock);
    swarf_cutter_release(cutter);
    free(paths);
}

int main(int count, char **argument)
{
    const job *j = NULL;
    for (size_t i = 0; count > 1 && i < sizeof jobs / sizeof jobs[0]; i++)
        if (strcmp(argument[1], jobs[i].name) == 0) j = &jobs[i];
    if (!j || count < 5 || count > 6 || atoi(argument[2]) < 1 || atol(argument[4]) < 0) {
        fprintf(stderr, "usage: cut_bench bear|cameo RESOLUTION THREADS BATCH [REPEAT]\n");
        return 2;
    }
    must(swarf_threads_set(atoi(argument[3])));
    for (int repeat = count > 5 ? atoi(argument[5]) : 1; repeat > 0; repeat--)
        run(j, atoi(argument[2]), (size_t)atol(argument[4]));
    return 0;
}
