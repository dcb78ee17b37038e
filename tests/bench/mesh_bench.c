/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* mesh_bench PROGRAM N THREADS ERROR [REPEAT [FILE.stl]]: make meshes of a fixed job, with OpenVDB's mesher, by dual
 * contouring of the field, on the exact surface, and on that with narrow edges followed, in turn, and print one line of
 * JSON for each round and, at last, their least times side by side.
 *
 * PROGRAM is bear or cameo (see shared data); N the voxels along the longest edge of the stock; ERROR in voxels. With a
 * FILE the time from reading the program to having written the mesh is printed too.
 */
#include <stdio.h>
#include <stdlib.h>

#include "jobs.h"

int main(int count, char **argument)
{
    const bench_job *j = count > 1 ? bench_job_find(argument[1]) : NULL;
    if (!j || count < 5 || count > 7 || atoi(argument[2]) < 1 || atof(argument[4]) < 0) {
        fprintf(stderr, "usage: mesh_bench bear|cameo RESOLUTION THREADS ERROR [REPEAT [FILE.stl]]\n");
        return 2;
    }
    bench_must(swarf_threads_set(atoi(argument[3])));
    const double voxel = bench_job_voxel(j, atoi(argument[2])), t_begin = bench_now();
    swarf_surface *surface = NULL;
    swarf_stock *stock = bench_job_cut(j, voxel, &surface);
    const double cut_s = bench_now() - t_begin;
    double field = 0, best[4] = {1e30, 1e30, 1e30, 1e30};
    bench_must(swarf_stock_volume(stock, &field));
    swarf_contour_options options = swarf_contour_options_default();
    options.error_mm = atof(argument[4]) * voxel;
    for (int repeat = count > 5 ? atoi(argument[5]) : 3; repeat > 0; repeat--) {
        swarf_mesh *uniform = NULL, *mesh = NULL, *exact = NULL, *fine = NULL;
        swarf_contour_report report, exact_report, fine_report;
        const double t_uniform = bench_now();
        bench_must(swarf_mesh_create_stock(stock, 0, NULL, &uniform));
        const double t_contour = bench_now();
        options.surface = NULL;
        options.fine = 0;
        bench_must(swarf_mesh_contour(stock, &options, NULL, &mesh, &report));
        const double t_exact = bench_now();
        options.surface = surface;
        bench_must(swarf_mesh_contour(stock, &options, NULL, &exact, &exact_report));
        const double t_fine = bench_now();
        options.fine = 1;
        bench_must(swarf_mesh_contour(stock, &options, NULL, &fine, &fine_report));
        const double t_end = bench_now();
        best[0] = t_contour - t_uniform < best[0] ? t_contour - t_uniform : best[0];
        best[1] = t_exact - t_contour < best[1] ? t_exact - t_contour : best[1];
        best[2] = t_fine - t_exact < best[2] ? t_fine - t_exact : best[2];
        best[3] = t_end - t_fine < best[3] ? t_end - t_fine : best[3];
        printf("{\"program\": \"%s\", \"resolution\": %s, \"threads\": %d, \"error_voxels\": %s, \"openvdb_s\": %.4f, "
               "\"contour_s\": %.4f, \"exact_s\": %.4f, \"fine_s\": %.4f, \"openvdb_triangles\": %zu, "
               "\"triangles\": %zu, \"exact_triangles\": %zu, \"fine_triangles\": %zu, \"split_edges\": %zu, "
               "\"field_mm3\": %.4f, \"openvdb_mm3\": %.4f, \"mesh_mm3\": %.4f, \"exact_mm3\": %.4f, "
               "\"surface_mm3\": [%.4f, %.4f], \"unseen_mm3\": %.4f, \"error_mm\": %.6f, "
               "\"cut_each_other\": [%zu, %zu, %zu], \"left\": [%zu, %zu, %zu]}\n",
               j->name, argument[2], swarf_threads(), argument[4], t_contour - t_uniform, t_exact - t_contour,
               t_fine - t_exact, t_end - t_fine, swarf_mesh_triangles(uniform).triangle_count, report.triangles,
               exact_report.triangles, fine_report.triangles, fine_report.split_edges, field,
               swarf_mesh_topology(uniform).volume_mm3, swarf_mesh_topology(mesh).volume_mm3,
               swarf_mesh_topology(exact).volume_mm3, report.surface_mm3, exact_report.surface_mm3,
               exact_report.unseen_mm3, exact_report.error_mm, report.intersections_found,
               exact_report.intersections_found, fine_report.intersections_found, report.intersections_left,
               exact_report.intersections_left, fine_report.intersections_left);
        fflush(stdout);
        if (repeat == 1 && count > 6) {
            const double t_write = bench_now();
            bench_must(swarf_mesh_write(exact, argument[6], NULL));
            printf("from the program to %s: %.3f s\n", argument[6], cut_s + best[2] + bench_now() - t_write);
        }
        swarf_mesh_release(uniform);
        swarf_mesh_release(mesh);
        swarf_mesh_release(exact);
        swarf_mesh_release(fine);
    }
    printf("least: OpenVDB %.3f s, contour %.3f s, %.2f times as long; exact %.3f s, %.2f times; fine %.3f s, "
           "%.2f times exact; peak %.0f MiB\n",
           best[0], best[1], best[1] / best[0], best[2], best[2] / best[0], best[3], best[3] / best[2],
           (double)swarf_memory_peak() / 1048576);
    swarf_surface_release(surface);
    swarf_stock_destroy(stock);
    return 0;
}
