/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Random stocks, mostly far too coarse for what was cut, so that cells of all kinds occur: the mesh is always a closed
 * oriented 2-manifold whose triangles do not cut each other, with and without simplifying, of about the field's
 * volume, and simplifying keeps the number of shells and holes. */
#include <math.h>
#include <stdlib.h>

#include "test.h"

/* V - E + F: twice the number of shells less twice the number of holes through them. */
static long euler_number(const swarf_mesh *mesh)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    return (long)t.vertex_count - (long)t.triangle_count / 2; /* 3 F = 2 E */
}

static swarf_stock *make_random(test_random *random, double voxel)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    const double offset = test_random_in(random, -50, 50);
    const swarf_box box = {{offset, 0, -5}, {offset + 6, 6, 0}};
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&box, &options, &stock))) return NULL;
    static const char *const cutters[] = {"flat:d=0.5,l=9", "ball:d=0.8,l=9", "chamfer:d=2,l=9,a=60", "ball:d=3,l=9"};
    for (int i = 0; i < 4; i++) {
        swarf_cutter *cutter = NULL;
        if (!CHECK_OK(swarf_cutter_parse(cutters[i], &cutter))) continue;
        enum { PATHS = 12 };
        swarf_path paths[PATHS] = {0};
        for (int k = 0; k < PATHS; k++) {
            paths[k].has_motion = 1;
            for (int c = 0; c < 2; c++) {
                paths[k].start[c] = (c == 0 ? offset : 0) + test_random_in(random, -1, 7);
                paths[k].end[c] = (c == 0 ? offset : 0) + test_random_in(random, -1, 7);
            }
            paths[k].start[2] = test_random_in(random, -5.5, 0.5);
            paths[k].end[2] = test_random_below(random, 2) ? paths[k].start[2] : test_random_in(random, -5.5, 0.5);
        }
        CHECK_OK(swarf_stock_cut(stock, cutter, paths, 1 + test_random_below(random, PATHS), NULL));
        swarf_cutter_release(cutter);
    }
    return stock;
}

int main(void)
{
    test_random random = test_random_begin(20);
    const char *count_text = getenv("SWARF_COUNT");
    const int count = count_text ? atoi(count_text) : 25;
    for (int i = 0; i < count; i++) {
        const double voxel = test_random_in(&random, 0.1, 0.5);
        swarf_stock *stock = make_random(&random, voxel);
        if (!stock) continue;
        double volume = 0;
        CHECK_OK(swarf_stock_volume(stock, &volume));
        long full_euler = 0;
        for (int simple = 0; simple < 2; simple++) {
            swarf_contour_options options = swarf_contour_options_default();
            options.error_mm = simple ? 0.1 * voxel : 0;
            swarf_contour_report report;
            swarf_mesh *mesh = NULL;
            if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) continue;
            const swarf_topology topology = swarf_mesh_topology(mesh);
            const int good = (topology.closed || report.triangles == 0) && !topology.nonmanifold_edges &&
                             !topology.boundary_edges && !topology.misoriented_edges && !topology.degenerate;
            CHECK(good);
            CHECK(report.intersections_left == 0);
            if (!good || report.intersections_left || report.intersections_found)
                printf("stock %d, voxel %g: %zu triangles, cut each other: %zu found, %zu left\n", i, voxel,
                       report.triangles, report.intersections_found, report.intersections_left);
            CHECK_NEAR(topology.volume_mm3, volume, 0.25 * voxel * topology.area_mm2);
            if (simple)
                CHECK(euler_number(mesh) == full_euler);
            else
                full_euler = euler_number(mesh);
            swarf_mesh_release(mesh);
        }
        swarf_stock_destroy(stock);
    }
    return test_end();
}
