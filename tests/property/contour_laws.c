/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Random stocks, mostly far too coarse for what was cut, so that cells of all kinds occur: the mesh is always a closed
 * oriented 2-manifold whose triangles do not cut each other, with and without simplifying, of about the field's
 * volume, and simplifying keeps the number of shells and holes. Where edges are split more of the exact surface is
 * there, and next to none of the triangles made cut others. */
#include <math.h>
#include <string.h>

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
    int apart;    /* the first one while parts that cut others are looked for; 0: none */
} listener;

/* Whether a report is of the last fifth of one of the six rounds in which facets are split. */
static int is_apart(double fraction)
{
    const double rounds = (fraction - 0.7) * 60, left = ceil(rounds - 1e-6) - rounds;
    return fraction > 0.7 && fraction < 0.8 && left < 0.19;
}

static int listen(void *user, double fraction)
{
    listener *l = user;
    l->back += fraction < l->done;
    l->done = fraction;
    l->among[fraction <= 0.7 ? 0 : fraction < 0.8 ? 1 : 2]++;
    l->calls++;
    if (!l->apart && is_apart(fraction)) l->apart = l->calls;
    return l->calls == l->last;
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
    CHECK(all.among[0] && all.among[1] && all.among[2] && all.apart);
    swarf_mesh_release(mesh);
    for (int i = 0; i <= TIMES; i++) {
        listener some = {.last = i ? 1 + i * (all.calls - 1) / (TIMES + 1) : all.apart};
        swarf_mesh *none = NULL;
        CHECK_FAILS(swarf_mesh_contour(stock, &options, &(swarf_progress){listen, &some}, &none, NULL),
                    SWARF_ERROR_CANCELLED, NULL);
        CHECK(none == NULL && some.calls == some.last);
    }
    CHECK_OK(swarf_threads_set(0));
    CHECK_OK(swarf_progress_interval_set(100));
}

enum { POINTS = 2000, PLAIN = 2, FINE = 4 };

/* Points of the exact surface, found along random lines; returns how many. */
static int find_points(const swarf_surface *surface, const swarf_mesh *mesh, test_random *random,
                       double points[POINTS][3])
{
    static double from[POINTS][3], along[POINTS][3];
    static int64_t moves[POINTS];
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    int count = 0;
    for (int i = 0; i < POINTS; i++) {
        const float *near = t.xyz + 3 * test_random_below(random, t.vertex_count);
        for (int k = 0; k < 3; k++) {
            from[i][k] = (double)near[k] + test_random_in(random, -0.5, 0.5);
            along[i][k] = test_random_in(random, -1, 1);
        }
    }
    const swarf_surface_lines lines = {from[0], along[0], POINTS, 1};
    CHECK_OK(swarf_surface_refine(surface, SIZE_MAX, &lines, NULL, &(swarf_surface_feet){from[0], NULL, moves}));
    for (int i = 0; i < POINTS; i++)
        if (moves[i] != -2) memcpy(points[count++], from[i], sizeof *points);
    return count;
}

/* How many of the points are farther from the mesh than a tenth of a voxel. */
static int count_beyond(const swarf_mesh *mesh, const double points[POINTS][3], int count, double voxel)
{
    static double distance[POINTS];
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    swarf_solid *solid = NULL;
    int beyond = 0;
    if (CHECK_OK(swarf_solid_create(&t, NULL, &solid)))
        CHECK_OK(swarf_solid_distance(solid, points[0], (size_t)count, NULL, distance, NULL));
    for (int i = 0; solid && i < count; i++) beyond += fabs(distance[i]) > 0.1 * voxel;
    swarf_solid_release(solid);
    return beyond;
}

int main(void)
{
    static double points[POINTS][3];
    int beyond[2] = {0};
    size_t crossed[2] = {0};
    check_count();
    test_random random = test_random_begin(20), points_random = test_random_begin(21);
    const int count = test_size() == TEST_FULL ? 250 : 25;
    for (int i = 0; i < count; i++) {
        const double voxel = test_random_in(&random, 0.1, 0.5);
        swarf_surface *surface = NULL;
        swarf_stock *stock = stock_random(&random, voxel, 6, &surface);
        double volume = 0;
        CHECK_OK(swarf_stock_volume(stock, &volume));
        long full_euler = 0;
        int point_count = 0;
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
            if (report.triangles && kind == PLAIN) point_count = find_points(surface, mesh, &points_random, points);
            if (report.triangles && (kind == PLAIN || kind == FINE)) {
                beyond[kind == FINE] += count_beyond(mesh, points, point_count, voxel);
                crossed[kind == FINE] += report.intersections_found;
            }
            swarf_mesh_release(mesh);
        }
        if (i < 3) check_cancel(stock, surface);
        swarf_surface_release(surface);
        swarf_stock_destroy(stock);
    }
    printf("%d points of the surface beyond a tenth of a voxel, fine %d; %zu pairs cut each other, fine %zu\n",
           beyond[0], beyond[1], crossed[0], crossed[1]);
    CHECK(beyond[1] < 0.65 * beyond[0]);
    CHECK(crossed[1] <= crossed[0] + crossed[0] / 4);
    return test_end();
}
