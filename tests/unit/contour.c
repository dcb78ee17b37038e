/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Dual contouring: boxes with sharp edges, the same bits for any number of threads, errors that are kept, budgets, and
 * stocks of which little or nothing is left. */
#include <math.h>
#include <stdlib.h>

#include "stocks.h"

static swarf_stock *make_box(const double lo[3], const double hi[3], double voxel)
{
    const swarf_box box = {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
    return stock_block(&box, voxel);
}

static int is_manifold(const swarf_mesh *mesh)
{
    const swarf_topology topology = swarf_mesh_topology(mesh);
    return topology.closed && !topology.boundary_edges && !topology.nonmanifold_edges && !topology.misoriented_edges &&
           !topology.degenerate;
}

/* Distance to the surface of the box 0 0 0 .. 6 5 4. */
static double off_box(const float *p)
{
    const double size[3] = {6, 5, 4};
    double inside = INFINITY, outside = 0;
    for (int k = 0; k < 3; k++) {
        const double away = fmax(-(double)p[k], (double)p[k] - size[k]);
        inside = fmin(inside, fabs(away));
        outside = fmax(outside, away);
    }
    return fmax(inside, outside);
}

static void check_box(void)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {6, 5, 4};
    swarf_stock *stock = make_box(lo, hi, 0.1);
    swarf_contour_options options = swarf_contour_options_default();
    swarf_contour_report report;
    swarf_mesh *mesh = NULL;
    if (CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) {
        CHECK(is_manifold(mesh));
        CHECK(report.triangles == report.full_triangles && report.error_mm == 0 && report.intersections_left == 0);
        const swarf_triangles t = swarf_mesh_triangles(mesh);
        double worst = 0;
        for (size_t i = 0; i < t.vertex_count; i++) worst = fmax(worst, off_box(t.xyz + 3 * i));
        CHECK(worst < 1e-4);
        CHECK(report.sharp_vertices > 500);
        swarf_mesh_release(mesh);
    }
    options.error_mm = 0.01;
    if (CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) {
        CHECK(is_manifold(mesh));
        CHECK(report.triangles == swarf_mesh_triangles(mesh).triangle_count);
        CHECK(report.triangles * 50 < report.full_triangles);
        CHECK(report.error_mm <= 0.01 * (1 + 1e-6));
        CHECK_NEAR(swarf_mesh_topology(mesh).volume_mm3, 120, 0.1);
        swarf_mesh_release(mesh);
    }
    swarf_stock_destroy(stock);
}

/* Greatest distance of the vertices, edges' middles and centres of `from` to `to`. */
static double reach(const swarf_mesh *from, const swarf_mesh *to)
{
    const swarf_triangles t = swarf_mesh_triangles(from), design = swarf_mesh_triangles(to);
    static const double weights[7][3] = {
        {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {1. / 3, 1. / 3, 1. / 3}};
    const size_t count = 7 * t.triangle_count;
    double *points = malloc(3 * count * sizeof *points), *distance = malloc(count * sizeof *distance), worst = 0;
    swarf_solid *solid = NULL;
    if (CHECK(points && distance) && CHECK_OK(swarf_solid_create(&design, NULL, &solid))) {
        for (size_t i = 0; i < count; i++)
            for (size_t c = 0; c < 3; c++) {
                points[3 * i + c] = 0;
                for (size_t k = 0; k < 3; k++)
                    points[3 * i + c] += weights[i % 7][k] * t.xyz[3 * (size_t)t.index[i / 7 * 3 + k] + c];
            }
        CHECK_OK(swarf_solid_distance(solid, points, count, NULL, distance, NULL));
        for (size_t i = 0; i < count; i++) worst = fmax(worst, fabs(distance[i]));
    }
    swarf_solid_release(solid);
    free(points);
    free(distance);
    return worst;
}

/* A part with slots on slopes, drilled and with a ball's trace: simplified it stays within the error, both ways. */
static void check_error(void)
{
    const double lo[3] = {0, 0, -3}, hi[3] = {8, 6, 0};
    swarf_stock *stock = make_box(lo, hi, 0.1);
    static const struct {
        const char *cutter;
        swarf_path path;
    } cuts[] = {{"flat:d=1.5,l=9", {.start = {-1, 1, -0.5}, .end = {9, 5, -2}, .has_motion = 1}},
                {"ball:d=2,l=9", {.start = {2, 7, -1}, .end = {6, -1, -1.3}, .has_motion = 1}},
                {"drill:d=1.2,l=9", {.start = {6.5, 4.5, 1}, .end = {6.5, 4.5, -4}, .has_motion = 1}},
                {"bull:d=2,l=9,r=0.5", {.start = {1, 4, -0.77}, .end = {1.5, 5, -0.77}, .has_motion = 1}}};
    for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
        swarf_cutter *cutter = NULL;
        if (!CHECK_OK(swarf_cutter_parse(cuts[i].cutter, &cutter))) continue;
        CHECK_OK(swarf_stock_cut(stock, cutter, &cuts[i].path, 1, NULL));
        swarf_cutter_release(cutter);
    }
    swarf_contour_options options = swarf_contour_options_default();
    swarf_mesh *full = NULL;
    if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &full, NULL))) return;
    size_t before = swarf_mesh_triangles(full).triangle_count;
    static const double errors[] = {0.001, 0.004, 0.016, 0.064};
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++) {
        const double error = errors[i];
        swarf_mesh *mesh = NULL;
        options.error_mm = error;
        if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, NULL))) continue;
        CHECK(is_manifold(mesh));
        CHECK(swarf_mesh_triangles(mesh).triangle_count < before);
        before = swarf_mesh_triangles(mesh).triangle_count;
        const double there = reach(full, mesh), back = reach(mesh, full);
        if (!CHECK(there <= error * (1 + 1e-4) && back <= error * (1 + 1e-4)))
            printf("error %g: full to simplified %g, simplified to full %g\n", error, there, back);
        swarf_mesh_release(mesh);
    }
    CHECK(before * 10 < swarf_mesh_triangles(full).triangle_count);
    swarf_mesh_release(full);
    swarf_stock_destroy(stock);
}

static void check_cylinder(void)
{
    const double base[3] = {0.03, 0.02, 0.01}, axis[3] = {6, 5, 4};
    swarf_stock_options stock_options = swarf_stock_options_default();
    stock_options.voxel_mm = 0.1;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_cylinder(base, axis, 3, &stock_options, &stock))) return;
    swarf_contour_options options = swarf_contour_options_default();
    swarf_contour_report report;
    const double exact = 3.14159265358979323846 * 9 * sqrt(77);
    swarf_mesh *first = NULL;
    for (int threads = 1; threads <= 8; threads += threads < 3 ? 1 : 5) {
        CHECK_OK(swarf_threads_set(threads));
        options.error_mm = 0.005;
        swarf_mesh *mesh = NULL;
        if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) continue;
        CHECK(is_manifold(mesh));
        CHECK_NEAR(swarf_mesh_topology(mesh).volume_mm3, exact, 2e-3 * exact);
        CHECK(report.triangles * 3 < report.full_triangles);
        if (!first) {
            first = mesh;
            continue;
        }
        CHECK(test_same_mesh(first, mesh));
        swarf_mesh_release(mesh);
    }
    CHECK_OK(swarf_threads_set(0));

    /* the budget is met by as little error as it takes, or said not to be */
    const size_t at_limit = swarf_mesh_triangles(first).triangle_count;
    swarf_mesh_release(first);
    swarf_mesh *mesh = NULL;
    options.error_mm = 0.02;
    options.triangle_budget = at_limit;
    if (CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) {
        CHECK(report.budget_met && report.triangles <= at_limit && is_manifold(mesh));
        CHECK(report.error_mm < 0.02);
        swarf_mesh_release(mesh);
    }
    options.triangle_budget = 10;
    if (CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) {
        CHECK(!report.budget_met && report.triangles > 10 && is_manifold(mesh));
        swarf_mesh_release(mesh);
    }
    swarf_stock_destroy(stock);
}

static int stop(void *user, double fraction)
{
    (void)fraction;
    return ++*(int *)user >= 3;
}

static int raise_threads(void *user, double fraction)
{
    (void)fraction;
    return swarf_threads_set(++*(int *)user % 8 + 1) != SWARF_OK;
}

/* Threads may be set at any time, from a callback too: the mesh is the same. */
static void check_threads(void)
{
    swarf_stock *stock = make_box((double[]){0, 0, 0}, (double[]){10.03, 9.07, 8.11}, 0.1);
    swarf_contour_options options = swarf_contour_options_default();
    options.error_mm = 0.01;
    uint32_t triangles[2] = {0, 1};
    int calls = 0;
    const swarf_progress progress = {raise_threads, &calls};
    CHECK_OK(swarf_progress_interval_set(0));
    for (int k = 0; k < 2; k++) {
        swarf_mesh *mesh = NULL;
        CHECK_OK(swarf_threads_set(1));
        if (!CHECK_OK(swarf_mesh_contour(stock, &options, k ? &progress : NULL, &mesh, NULL))) continue;
        triangles[k] = (uint32_t)swarf_mesh_triangles(mesh).triangle_count;
        swarf_mesh_release(mesh);
    }
    CHECK(triangles[0] == triangles[1] && calls > 20);
    CHECK_OK(swarf_threads_set(0));
    CHECK_OK(swarf_progress_interval_set(100));
    swarf_stock_destroy(stock);
}

static void check_refusals(void)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {2, 2, 2};
    swarf_stock *stock = make_box(lo, hi, 0.1);
    swarf_contour_options options = swarf_contour_options_default();
    swarf_mesh *mesh = NULL;
    options.error_mm = -1;
    CHECK_FAILS(swarf_mesh_contour(stock, &options, NULL, &mesh, NULL), SWARF_ERROR_ARGUMENT, "error -1 mm");
    options.error_mm = NAN;
    CHECK_FAILS(swarf_mesh_contour(stock, &options, NULL, &mesh, NULL), SWARF_ERROR_ARGUMENT, "error");
    options.error_mm = 1e300; /* no float */
    CHECK_FAILS(swarf_mesh_contour(stock, &options, NULL, &mesh, NULL), SWARF_ERROR_ARGUMENT, "error 1e+300 mm");
    options.error_mm = 0;
    options.triangle_budget = 5;
    CHECK_FAILS(swarf_mesh_contour(stock, &options, NULL, &mesh, NULL), SWARF_ERROR_ARGUMENT, "budget of 5");
    options.triangle_budget = 0;
    options.size = 3;
    CHECK_FAILS(swarf_mesh_contour(stock, &options, NULL, &mesh, NULL), SWARF_ERROR_ARGUMENT, "another version");
    options = swarf_contour_options_default();
    CHECK_FAILS(swarf_mesh_contour(NULL, &options, NULL, &mesh, NULL), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_mesh_contour(stock, &options, NULL, NULL, NULL), SWARF_ERROR_ARGUMENT, NULL);
    int calls = 0;
    const swarf_progress progress = {stop, &calls};
    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_OK(swarf_threads_set(1));
    CHECK_FAILS(swarf_mesh_contour(stock, &options, &progress, &mesh, NULL), SWARF_ERROR_CANCELLED, NULL);
    CHECK_OK(swarf_threads_set(0));
    CHECK(mesh == NULL);

    CHECK_OK(swarf_stock_boolean(stock, stock, SWARF_DIFFERENCE)); /* everything cut away */
    options.error_mm = 0.1;
    swarf_contour_report report;
    if (CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) {
        CHECK(swarf_mesh_triangles(mesh).triangle_count == 0 && report.triangles == 0);
        swarf_mesh_release(mesh);
    }
    swarf_stock_destroy(stock);
}

/* One voxel, and shells thinner than one. */
static void check_small(void)
{
    static const double sizes[][3] = {{0.1, 0.1, 0.1}, {0.06, 0.06, 0.06}, {3, 3, 0.04}, {3, 0.12, 0.12}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const double lo[3] = {0.05, 0.05, 0.05},
                     hi[3] = {lo[0] + sizes[i][0], lo[1] + sizes[i][1], lo[2] + sizes[i][2]};
        swarf_stock *stock = make_box(lo, hi, 0.1);
        swarf_contour_options options = swarf_contour_options_default();
        for (int simple = 0; simple < 2; simple++) {
            swarf_contour_report report;
            swarf_mesh *mesh = NULL;
            options.error_mm = simple ? 0.01 : 0;
            if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) continue;
            CHECK(swarf_mesh_triangles(mesh).triangle_count == 0 || is_manifold(mesh));
            CHECK(report.intersections_left == 0);
            swarf_mesh_release(mesh);
        }
        swarf_stock_destroy(stock);
    }
}

int main(void)
{
    check_box();
    check_error();
    check_cylinder();
    check_refusals();
    check_small();
    check_threads();
    return test_end();
}
