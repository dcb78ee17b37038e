/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Random stocks, mostly far too coarse for what was cut, so that cells of all kinds occur: the mesh is always a closed
 * oriented 2-manifold whose triangles do not cut each other, with and without simplifying, of about the field's
 * volume, and simplifying keeps the number of shells and holes. */
#include <math.h>
#include <stdlib.h>

#include "random_stock.h"

/* V - E + F: twice the number of shells less twice the number of holes through them. */
static long euler_number(const swarf_mesh *mesh)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    return (long)t.vertex_count - (long)t.triangle_count / 2; /* 3 F = 2 E */
}

static double volume_of(const float *a, const float *b, const float *c, const float *d)
{
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)b[k] - a[k];
        v[k] = (double)c[k] - a[k];
        w[k] = (double)d[k] - a[k];
    }
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/* Whether the segment p q goes through the triangle's inside. */
static int pierces(const float *p, const float *q, const float *const t[3], double least)
{
    const double above = volume_of(t[0], t[1], t[2], p), below = volume_of(t[0], t[1], t[2], q);
    if (!((above > least && below < -least) || (above < -least && below > least))) return 0;
    const double e0 = volume_of(p, q, t[0], t[1]), e1 = volume_of(p, q, t[1], t[2]), e2 = volume_of(p, q, t[2], t[0]);
    return (e0 > least && e1 > least && e2 > least) || (e0 < -least && e1 < -least && e2 < -least);
}

/* Pairs of triangles that cut through each other, counted independently of the library: every pair whose boxes meet, in
 * doubles, where it is beyond doubt. */
static size_t count_cuts(const swarf_mesh *mesh)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    float(*box)[6] = malloc((t.triangle_count + 1) * sizeof *box);
    size_t cuts = 0;
    for (size_t i = 0; box && i < t.triangle_count; i++)
        for (int c = 0; c < 3; c++) {
            const float x[3] = {t.xyz[3 * (size_t)t.index[3 * i] + (size_t)c],
                                t.xyz[3 * (size_t)t.index[3 * i + 1] + (size_t)c],
                                t.xyz[3 * (size_t)t.index[3 * i + 2] + (size_t)c]};
            box[i][c] = fminf(x[0], fminf(x[1], x[2]));
            box[i][3 + c] = fmaxf(x[0], fmaxf(x[1], x[2]));
        }
    for (size_t i = 0; box && i < t.triangle_count; i++)
        for (size_t j = 0; j < i; j++) {
            if (box[i][0] > box[j][3] || box[j][0] > box[i][3] || box[i][1] > box[j][4] || box[j][1] > box[i][4] ||
                box[i][2] > box[j][5] || box[j][2] > box[i][5])
                continue;
            const float *a[3], *b[3];
            for (size_t k = 0; k < 3; k++) {
                a[k] = t.xyz + 3 * (size_t)t.index[3 * i + k];
                b[k] = t.xyz + 3 * (size_t)t.index[3 * j + k];
            }
            int cut = 0;
            for (int k = 0; k < 3; k++)
                cut |= pierces(a[k], a[(k + 1) % 3], b, 1e-9) || pierces(b[k], b[(k + 1) % 3], a, 1e-9);
            cuts += (size_t)cut;
        }
    free(box);
    return cuts;
}

/* The count can tell. */
static void check_count(void)
{
    static const float xyz[] = {0, 0, 0, 2, 0, 0, 0, 2, 0, 0.5f, 0.5f, -1, 0.5f, 0.5f, 1, 5, 5, 0};
    static const uint32_t index[] = {0, 1, 2, 3, 4, 5};
    const swarf_triangles two = {xyz, 6, index, 2};
    swarf_mesh *mesh = NULL;
    if (!CHECK_OK(swarf_mesh_create(&two, &mesh))) return;
    CHECK(count_cuts(mesh) == 1);
    swarf_mesh_release(mesh);
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
        swarf_stock *stock = random_stock(&random, voxel, &surface);
        if (!stock) continue;
        double volume = 0;
        CHECK_OK(swarf_stock_volume(stock, &volume));
        long full_euler = 0;
        for (int kind = 0; kind < 4; kind++) {
            const int simple = kind & 1, exact = kind >> 1;
            swarf_contour_options options = swarf_contour_options_default();
            options.error_mm = simple ? 0.1 * voxel : 0;
            options.surface = exact ? surface : NULL;
            swarf_contour_report report;
            swarf_mesh *mesh = NULL;
            if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) continue;
            const swarf_topology topology = swarf_mesh_topology(mesh);
            const int good = (topology.closed || report.triangles == 0) && !topology.nonmanifold_edges &&
                             !topology.boundary_edges && !topology.misoriented_edges && !topology.degenerate;
            CHECK(good);
            CHECK(report.intersections_left == 0);
            if (report.triangles < 10000) CHECK(count_cuts(mesh) == 0);
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
        swarf_surface_release(surface);
        swarf_stock_destroy(stock);
    }
    return test_end();
}
