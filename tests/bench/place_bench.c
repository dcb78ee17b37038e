/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* place_bench PROGRAM N THREADS [REPEAT]: turn the stock of a fixed job by odd angles, with its exact surface and from
 * its voxels alone, in turn, and print one line of JSON for each round: seconds, and what is left of the volume.
 *
 * PROGRAM is bear or cameo (see shared data); N the voxels along the longest edge of the stock.
 */
#include <stdio.h>
#include <stdlib.h>

#include "jobs.h"

/* About x by 0.6, then about z by 0.8 as a cosine. */
static const double rows[12] = {0.8, -0.48, 0.36, 5, 0.6, 0.64, -0.48, -7, 0, 0.6, 0.8, 2};

int main(int count, char **argument)
{
    const bench_job *j = count > 1 ? bench_job_find(argument[1]) : NULL;
    if (!j || count < 4 || count > 5 || atoi(argument[2]) < 1) {
        fprintf(stderr, "usage: place_bench bear|cameo RESOLUTION THREADS [REPEAT]\n");
        return 2;
    }
    bench_must(swarf_threads_set(atoi(argument[3])));
    swarf_surface *surface = NULL;
    swarf_stock *stock = bench_job_cut(j, bench_job_voxel(j, atoi(argument[2])), &surface);
    swarf_placement placement;
    double before = 0;
    bench_must(swarf_placement_create(rows, &placement));
    bench_must(swarf_stock_volume(stock, &before));
    for (int repeat = count > 4 ? atoi(argument[4]) : 3; repeat > 0; repeat--)
        for (int known = 1; known >= 0; known--) {
            swarf_place_options options = swarf_place_options_default();
            options.surface = known ? surface : NULL;
            options.moves = SIZE_MAX;
            swarf_stock *placed = NULL;
            double after = 0;
            const double begin = bench_now(), cpu = bench_cpu();
            bench_must(swarf_stock_place(stock, &placement, &options, NULL, &placed, NULL));
            const double end = bench_now(), cpu_end = bench_cpu();
            bench_must(swarf_stock_volume(placed, &after));
            printf("{\"program\": \"%s\", \"resolution\": %s, \"threads\": %d, \"known\": %s, \"place_s\": %.4f, "
                   "\"cpu_s\": %.4f, \"before_mm3\": %.3f, \"after_mm3\": %.3f}\n",
                   j->name, argument[2], swarf_threads(), known ? "true" : "false", end - begin, cpu_end - cpu, before,
                   after);
            fflush(stdout);
            swarf_stock_destroy(placed);
        }
    swarf_surface_release(surface);
    swarf_stock_destroy(stock);
    return 0;
}
