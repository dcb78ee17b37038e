/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Random stocks, mostly far too coarse for what was cut, so that cells of all kinds occur: the mesh is always a closed
 * oriented 2-manifold whose triangles do not cut each other, with and without simplifying, of about the field's
 * volume, and simplifying keeps the number of shells and holes. */
#include <math.h>
#include <stdlib.h>

#include "cuts.h"
#include "stocks.h"

/* V - E + F: twice the number of shells less twice the number of holes through them. */
static long euler_number(const swarf_mesh *mesh)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    return (long)t.vertex_count - (long)t.triangle_count / 2; /* 3 F = 2 E */
}

/* The count can tell. */
static void check_count(void)
{
    static const float xyz[] = {0, 0, 0, 2, 0, 0, 0, 2, 0, 0.5f, 0.5f, -1, 0.5f, 0.5f, 1, 5, 5, 0};
    static const uint32_t index[] = {0, 1, 2, 3, 4, 5};
    const swarf_triangles two = {xyz, 6, index, 2};
    swarf_mesh *mesh = NULL;
    if (!CHECK_OK(swarf_mesh_create(&two, &mesh))) return;
    CHECK(mesh_cuts(mesh) == 1);
    swarf_mesh_release(mesh);
}

typedef struct listener {
    int calls, last; /* the call that says stop; 0: none */
    int back;        /* reports of less than there was before */
    double done;
    int among[3]; /* reports before the facets are split, meanwhile, later */
} listener;

static int listen(void *user, double fraction)
{
    listener *l = user;
    l->back += fraction < l->done;
    l->done = fraction;
    l->among[fraction <= 0.7 ? 0 : fraction < 0.8 ? 1 : 2]++;
    return ++l->calls == l->last;
}

/* A fine mesh tells its progress, and can be broken off at every stage. */
static void check_cancel(swarf_stock *stock, const swarf_surface *surface)
{
    enum { TIMES = 12 };
    swarf_contour_options options = swarf_contour_options_default();
    options.surface = surface;
    options.fine = 1;
    listener all = {0};
    swarf_mesh *mesh = NULL;
    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_OK(swarf_threads_set(1));
    CHECK_OK(swarf_mesh_contour(stock, &options, &(swarf_progress){listen, &all}, &mesh, NULL));
    CHECK(all.back == 0 && all.done == 1);
    CHECK(all.among[0] && all.among[1] && all.among[2]);
    swarf_mesh_release(mesh);
    for (int i = 1; i <= TIMES; i++) {
        listener some = {.last = 1 + i * (all.calls - 1) / (TIMES + 1)};
        swarf_mesh *none = NULL;
        CHECK_FAILS(swarf_mesh_contour(stock, &options, &(swarf_progress){listen, &some}, &none, NULL),
                    SWARF_ERROR_CANCELLED, NULL);
        CHECK(none == NULL && some.calls == some.last);
    }
    CHECK_OK(swarf_threads_set(0));
    CHECK_OK(swarf_progress_interval_set(100));
}

int main(void)
{
    check_count();
    test_random random = test_random_begin(20);
    const char *count_text = getenv("SWARF_COUNT");
    const int count = count_text ? atoi(count_text) : 25;
    for (int i = 0; i < count; i++) {
        const double voxel = test_random_in(&random, 0.1, 0.5);
        swarf_surface *surface = NULL;
        swarf_stock *stock = stock_random(&random, voxel, 6, &surface);
        double volume = 0;
        CHECK_OK(swarf_stock_volume(stock, &volume));
        long full_euler = 0;
        for (int kind = 0; kind < 6; kind++) {
            const int simple = kind & 1, exact = kind > 1;
            swarf_contour_options options = swarf_contour_options_default();
            options.error_mm = simple ? 0.1 * voxel : 0;
            options.surface = exact ? surface : NULL;
            options.fine = kind > 3;
            swarf_contour_report report;
            swarf_mesh *mesh = NULL;
            if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) continue;
            const swarf_topology topology = swarf_mesh_topology(mesh);
            const int good = (topology.closed || report.triangles == 0) && !topology.nonmanifold_edges &&
                             !topology.boundary_edges && !topology.misoriented_edges && !topology.degenerate;
            CHECK(good);
            CHECK(report.intersections_left == 0);
            if (report.triangles < 10000) CHECK(mesh_cuts(mesh) == 0);
            if (!good || report.intersections_left || report.intersections_found)
                printf("stock %d, voxel %g: %zu triangles, %zu of %zu vertices exact, cut each other: %zu found, %zu "
                       "left\n",
                       i, voxel, report.triangles, report.exact_vertices, report.full_triangles / 2,
                       report.intersections_found, report.intersections_left);
            CHECK_NEAR(topology.volume_mm3, volume, 0.25 * voxel * topology.area_mm2);
            CHECK(!exact || 10 * report.exact_vertices > 9 * (report.full_triangles / 2));
            if (kind)
                CHECK(euler_number(mesh) == full_euler);
            else
                full_euler = euler_number(mesh);
            swarf_mesh_release(mesh);
        }
        if (i < 3) check_cancel(stock, surface);
        swarf_surface_release(surface);
        swarf_stock_destroy(stock);
    }
    return test_end();
}
