/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* test_property_closed [FILE...]: what CGAL says of our meshes: closed oriented 2-manifolds that do not cut themselves
 * and enclose the volume that we say. Of the two programs of the shared data and of random ones, by the field and on
 * the exact surface, with every vertex and after simplifying; or of the files named. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "jobs.h"
#include "shapes.h"
#include "stocks.h"
#include "verdict.h"

static int is_good(const verdict *v)
{
    return v->manifold && v->closed && v->outward && v->cuts == 0 && v->flat_triangles == 0 && v->bounds_a_volume;
}

static void print(const char *what, size_t triangles, const verdict *v)
{
    printf("%s: %zu triangles, manifold %d, closed %d, outward %d, %zu cut each other, %zu without area, bounds a "
           "volume %d of %.6f mm3",
           what, triangles, v->manifold, v->closed, v->outward, v->cuts, v->flat_triangles, v->bounds_a_volume,
           v->volume_mm3);
}

/* Voxels of material that may be left where there is no mesh. */
enum { MOST_UNSEEN = 8 };

/* `field_mm3`: that of the stock, 0: not known. It counts what is thinner than a voxel, of which the mesh shows only
 * what voxel centres see: the two differ by up to a quarter of a voxel all over. `surface_mm3`: what the mesh stands
 * for, within `apart` voxels all over. */
static void check_mesh(const char *what, const swarf_mesh *mesh, double field_mm3, double surface_mm3, double voxel,
                       double apart)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    const double ours = swarf_mesh_topology(mesh).volume_mm3;
    verdict v;
    if (t.triangle_count == 0) { /* no voxel centre of it is inside: a few voxels may be left at most */
        CHECK(field_mm3 <= MOST_UNSEEN * voxel * voxel * voxel);
        return;
    }
    if (!CHECK(verdict_of(&t, &v))) return;
    CHECK(is_good(&v));
    CHECK_NEAR(v.volume_mm3, ours, 1e-9 * fabs(ours));
    print(what, t.triangle_count, &v);
    if (field_mm3 > 0) {
        CHECK_NEAR(v.volume_mm3, field_mm3, 0.25 * voxel * swarf_mesh_topology(mesh).area_mm2);
        CHECK_NEAR(v.volume_mm3, surface_mm3, apart * voxel * swarf_mesh_topology(mesh).area_mm2);
        printf(", %+.2e of the field's, %+.2e of the surface's", v.volume_mm3 / field_mm3 - 1,
               v.volume_mm3 / surface_mm3 - 1);
    }
    printf("\n");
    fflush(stdout);
}

enum { KINDS = 8 };

/* Error (in voxels) of each kind, whether the surface is given, edges are split and the volume is kept; how far flat
 * triangles may be from curved faces all over, in voxels, and those that the field alone tells from its edges. */
static const struct kind {
    double error;
    int exact, fine, keep_volume;
    double apart;
    const char *name;
} kinds[KINDS] = {{0, 0, 0, 0, 0.03, "field, whole"},
                  {0.1, 0, 0, 0, 0.03, "field, error 0.1 voxel"},
                  {0, 1, 0, 0, 0.01, "exact, whole"},
                  {0.1, 1, 0, 0, 0.015, "exact, error 0.1 voxel"},
                  {0, 1, 1, 0, 0.01, "exact and fine, whole"},
                  {0.1, 1, 1, 0, 0.015, "exact and fine, error 0.1 voxel"},
                  {0.1, 0, 0, 1, 0.03, "field, error 0.1 voxel, volume kept"},
                  {0.1, 1, 0, 1, 0.015, "exact, error 0.1 voxel, volume kept"}};

/* Kept is a volume to a part in 100 000 of the surface's, where there is room to shift vertices: on cameo, whose
 * valleys are narrower than a voxel at N = 128, and on some random programs there is too little. Seen were 1.9e-5 and
 * 1.8e-4 of cameo, 2.4e-4 of the first hundred random programs but the one with 3.6e-3; not kept, 2e-4 to 7e-3. Of
 * that one little is left, 1.8 voxels thick on average: what the field alone makes of it is 0.018 voxels off all over,
 * nearly as much as vertices may be shifted by. */
typedef struct keeping {
    double field, exact; /* greatest part that a kept volume may be off, without and with the surface */
} keeping;

static const keeping well = {1e-5, 1e-5}, on_cameo = {2.9e-5, 2.7e-4}, at_random = {1.6e-4, 3.6e-4},
                     at_worst = {5.5e-3, 3.6e-4};

static void check_stock(const char *name, swarf_stock *stock, const swarf_surface *surface, double voxel, keeping most)
{
    double volume = 0;
    CHECK_OK(swarf_stock_volume(stock, &volume));
    for (int k = 0; k < KINDS; k++) {
        swarf_contour_options options = swarf_contour_options_default();
        options.error_mm = kinds[k].error * voxel;
        options.surface = kinds[k].exact ? surface : NULL;
        options.fine = kinds[k].fine;
        options.keep_volume = kinds[k].keep_volume;
        swarf_mesh *mesh = NULL;
        char what[128];
        snprintf(what, sizeof what, "%s, %s", name, kinds[k].name);
        swarf_contour_report report;
        if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) continue;
        CHECK(report.intersections_left == 0);
        check_mesh(what, mesh, volume, report.surface_mm3, voxel, kinds[k].apart);
        if (kinds[k].keep_volume && report.triangles)
            CHECK_NEAR(swarf_mesh_topology(mesh).volume_mm3 / report.surface_mm3, 1,
                       kinds[k].exact ? most.exact : most.field);
        swarf_mesh_release(mesh);
    }
}

static void check_job(const bench_job *job, int resolution, keeping most)
{
    const double voxel = bench_job_voxel(job, resolution);
    char name[64];
    swarf_surface *surface = NULL;
    swarf_stock *stock = bench_job_cut(job, voxel, &surface);
    snprintf(name, sizeof name, "%s at N = %d", job->name, resolution);
    check_stock(name, stock, surface, voxel, most);
    swarf_surface_release(surface);
    swarf_stock_destroy(stock);
}

/* The first ones; and the one whose surface passes through a voxel centre, so that
 * vertices about it were rounded onto one line. */
enum { ON_ONE_LINE = 13, WORST_KEPT = 49 };

static void check_random(int count)
{
    test_random random = test_random_begin(100);
    for (int i = 0; i < count || i <= ON_ONE_LINE; i++) {
        const double voxel = test_random_in(&random, 0.05, 0.2);
        swarf_surface *surface = NULL;
        swarf_stock *stock = stock_random(&random, voxel, 6, &surface);
        char name[64];
        snprintf(name, sizeof name, "random program %d, voxel %.3f", i, voxel);
        if (i < count || i == ON_ONE_LINE)
            check_stock(name, stock, surface, voxel,
                        i < 2 || i == ON_ONE_LINE ? well
                        : i == WORST_KEPT         ? at_worst
                                                  : at_random);
        swarf_surface_release(surface);
        swarf_stock_destroy(stock);
    }
}

/* What is wrong is found: open, turned over, cutting itself. */
static void check_verdict(void)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {2, 2, 2}, lo_other[3] = {1, 1, 1}, hi_other[3] = {3, 3, 3};
    verdict v;
    shape s = {0};
    shape_box(&s, lo, hi);
    swarf_triangles view = shape_view(&s);
    CHECK(verdict_of(&view, &v) && is_good(&v) && fabs(v.volume_mm3 - 8) < 1e-9);
    view.triangle_count--;
    CHECK(verdict_of(&view, &v) && v.manifold && !v.closed && !is_good(&v));
    const uint32_t kept = s.index[0];
    s.index[0] = s.index[1];
    s.index[1] = kept;
    view = shape_view(&s);
    CHECK(verdict_of(&view, &v) && !v.manifold && !is_good(&v));
    s.index[1] = s.index[0];
    s.index[0] = kept;
    shape_box(&s, lo_other, hi_other);
    view = shape_view(&s);
    CHECK(verdict_of(&view, &v) && v.closed && v.cuts > 0 && !is_good(&v));
    shape_free(&s);
    shape_box(&s, lo, hi);
    shape_flip(&s, 0);
    view = shape_view(&s);
    CHECK(verdict_of(&view, &v) && v.closed && !v.outward && !is_good(&v));
    shape_free(&s);
}

int main(int count, char **argument)
{
    check_verdict();
    for (int i = 1; i < count; i++) {
        swarf_mesh *mesh = NULL;
        if (!CHECK_OK(swarf_mesh_read(argument[i], &mesh))) continue;
        check_mesh(argument[i], mesh, 0, 0, 0, 0);
        swarf_mesh_release(mesh);
    }
    if (count > 1) return test_end();
    const int full = test_size() == TEST_FULL;
    check_random(full ? 100 : 2);
    if (!test_shared()[0]) {
        printf("bear and cameo left out: no folder of shared data (SWARF_SHARED)\n");
        return test_end();
    }
    for (int resolution = full ? 256 : 128; resolution <= (full ? 2048 : 128); resolution *= 2) {
        check_job(bench_job_find("bear"), resolution, well);
        check_job(bench_job_find("cameo"), resolution, on_cameo);
    }
    return test_end();
}
