/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* cut_bench PROGRAM N THREADS BATCH [REPEAT]: cut a fixed job and print one line of JSON for each run.
 *
 * PROGRAM is bear or cameo (see shared data); N the voxels along the longest edge of the stock; BATCH the moves per
 * call, 0 for all at once. Reading the program, the volume and the hash are outside "total".
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "jobs.h"

static void run(const bench_job *j, int resolution, size_t batch)
{
    swarf_cutter *cutter = NULL;
    bench_must(swarf_cutter_parse(j->cutter, &cutter));
    size_t count = 0, leaves = 0, bytes = 0;
    const double t_read = bench_now();
    swarf_path *paths = bench_job_paths(j, &count);
    const double t_create = bench_now();
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = bench_job_voxel(j, resolution);
    swarf_stock *stock = NULL;
    bench_must(swarf_stock_create_box(&j->box, &options, &stock));
    const double t_cut = bench_now();
    const size_t step = batch ? batch : count;
    for (size_t i = 0; i < count; i += step)
        bench_must(swarf_stock_cut(stock, cutter, paths + i, count - i < step ? count - i : step, NULL));
    const double t_finish = bench_now();
    bench_must(swarf_stock_size(stock, &leaves, &bytes)); /* makes the leaves of the untouched faces */
    const double t_end = bench_now();
    const size_t peak = swarf_memory_peak();
    double volume = 0;
    uint64_t hash = 0;
    bench_must(swarf_stock_volume(stock, &volume));
    bench_must(swarf_stock_hash(stock, &hash));
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
    const bench_job *j = count > 1 ? bench_job_find(argument[1]) : NULL;
    if (!j || count < 5 || count > 6 || atoi(argument[2]) < 1 || atol(argument[4]) < 0) {
        fprintf(stderr, "usage: cut_bench bear|cameo RESOLUTION THREADS BATCH [REPEAT]\n");
        return 2;
    }
    bench_must(swarf_threads_set(atoi(argument[3])));
    for (int repeat = count > 5 ? atoi(argument[5]) : 1; repeat > 0; repeat--)
        run(j, atoi(argument[2]), (size_t)atol(argument[4]));
    return 0;
}
