/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Meshes that keep the volume: of bores, dimples and posts in closed form, within the error, their flat faces flat. */
#include <math.h>

#include "cuts.h"
#include "milled.h"
#include "stocks.h"

static const double pi = 3.14159265358979323846;

typedef struct made {
    swarf_mesh *mesh;
    swarf_contour_report report;
    double volume;
} made;

static made make(swarf_stock *stock, const swarf_surface *surface, double error, int keep_volume)
{
    swarf_contour_options options = swarf_contour_options_default();
    options.error_mm = error;
    options.surface = surface;
    options.keep_volume = keep_volume;
    made m = {0};
    if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &m.mesh, &m.report))) return m;
    const swarf_topology topology = swarf_mesh_topology(m.mesh);
    CHECK(topology.closed && !topology.nonmanifold_edges && !topology.misoriented_edges && !topology.degenerate);
    CHECK(m.report.intersections_left == 0);
    if (m.report.triangles < 6000) CHECK(mesh_cuts(m.mesh) == 0);
    CHECK(m.report.error_mm <= fmax(error, 0.01 * swarf_stock_voxel(stock)) * (1 + 1e-4));
    m.volume = topology.volume_mm3;
    return m;
}

/* Whether all but a fiftieth of what the mesh without shifts is off by came back. */
static int keeps(const made *shifted, const made *plain)
{
    const double off = fabs(shifted->volume - shifted->report.surface_mm3);
    return off < 0.02 * fabs(plain->volume - plain->report.surface_mm3) + 5e-6 * plain->volume;
}

/* Greatest distance of vertices near the top z = 0 from it. */
static double off_top(const swarf_mesh *mesh)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    double worst = 0;
    for (size_t i = 0; i < t.vertex_count; i++) {
        const double z = (double)t.xyz[3 * i + 2];
        if (z > -0.1) worst = fmax(worst, fabs(z));
    }
    return worst;
}

static void check_bore(const char *cutter, double depth, double removed, double voxel)
{
    milled job = milled_begin(cutter, voxel);
    swarf_surface *surface = NULL;
    milled_line(&job, SWARF_MOVE_POSITION, 30, 20, 1, 1);
    milled_line(&job, SWARF_MOVE_FEED, 30, 20, -depth, 2);
    CHECK_OK(swarf_surface_create(job.first, job.program, &job.tool, 1, NULL, &surface));
    milled_cut(&job);
    const double volume = 60 * 40 * 10 - removed;
    for (int exact = 0; exact < 2; exact++) {
        const swarf_surface *from = exact ? surface : NULL;
        const made full = make(job.stock, from, 0, 0), shifted = make(job.stock, from, 0, 1);
        const made plain = make(job.stock, from, 0.1 * voxel, 0), kept = make(job.stock, from, 0.1 * voxel, 1);
        if (exact) CHECK_NEAR(kept.volume, volume, 1e-5 * volume);
        CHECK(keeps(&kept, &plain));
        CHECK(kept.report.triangles < 2 * plain.report.triangles);
        if (exact) CHECK(off_top(kept.mesh) < 1e-3 * voxel);
        CHECK(full.report.triangles == shifted.report.triangles);
        CHECK(keeps(&shifted, &full));
        swarf_mesh_release(plain.mesh);
        swarf_mesh_release(kept.mesh);
        swarf_mesh_release(full.mesh);
        swarf_mesh_release(shifted.mesh);
    }
    swarf_surface_release(surface);
    milled_end(&job);
}

/* A cylinder, which bulges; the same bits for any number of threads. */
static void check_post(void)
{
    const double base[3] = {0.03, 0.02, 0.01}, axis[3] = {0, 0, 12};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.2;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_cylinder(base, axis, 5, &options, &stock))) return;
    made first = {0};
    for (int threads = 1; threads <= 3; threads++) {
        CHECK_OK(swarf_threads_set(threads));
        const made m = make(stock, NULL, 0.02, 1);
        if (threads == 1) {
            const made plain = make(stock, NULL, 0.02, 0);
            CHECK(keeps(&m, &plain));
            swarf_mesh_release(plain.mesh);
            first = m;
            continue;
        }
        CHECK(test_same_mesh(first.mesh, m.mesh));
        swarf_mesh_release(m.mesh);
    }
    swarf_mesh_release(first.mesh);
    CHECK_OK(swarf_threads_set(0));
    swarf_stock_destroy(stock);
}

/* Whatever was cut; with a budget by a fifth of the error that was needed. */
static void check_random(void)
{
    test_random random = test_random_begin(11);
    for (int i = 0; i < 6; i++) {
        swarf_surface *surface = NULL;
        swarf_stock *stock = stock_random(&random, 0.12, 6, &surface);
        for (int exact = 0; exact < 2; exact++) {
            const swarf_surface *from = exact ? surface : NULL;
            const made plain = make(stock, from, 0.012, 0), kept = make(stock, from, 0.012, 1);
            CHECK(keeps(&kept, &plain));
            swarf_contour_options options = swarf_contour_options_default();
            swarf_contour_report report;
            swarf_mesh *mesh = NULL;
            options.error_mm = 0.12;
            options.surface = from;
            options.keep_volume = 1;
            options.triangle_budget = kept.report.triangles;
            if (CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report)))
                CHECK(report.budget_met && report.error_mm < 0.5 * options.error_mm);
            swarf_mesh_release(mesh);
            swarf_mesh_release(plain.mesh);
            swarf_mesh_release(kept.mesh);
        }
        swarf_surface_release(surface);
        swarf_stock_destroy(stock);
    }
}

/* The slot of a ball of two voxels, which takes more than vertices may be shifted; far from the origin, where positions
 * are rounded, the ends of the block stay where they are. */
static void check_flat(void)
{
    const double voxel = 0.1, start[3] = {491, 2.4, -1.2}, end[3] = {509, 2.3, -1.2};
    const swarf_box box = {{496.97, -3.07, -3.02}, {503.05, 3.01, 0.01}};
    swarf_stock *first = stock_block(&box, voxel), *stock = NULL;
    swarf_program *program = NULL;
    swarf_surface *surface = NULL;
    swarf_cutter *cutter = NULL;
    CHECK_OK(swarf_stock_copy(first, &stock));
    CHECK_OK(swarf_cutter_parse("ball:d=0.4,l=9", &cutter));
    const swarf_tool tool = {.number = 1, .cutter = cutter};
    CHECK_OK(swarf_program_create(start, &program));
    CHECK_OK(swarf_program_add_operation(program, "slot"));
    CHECK_OK(swarf_program_set_section(program, &(swarf_section){.tool = 1}));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, end, 100, 1));
    CHECK_OK(swarf_surface_create(first, program, &tool, 1, NULL, &surface));
    swarf_path path;
    CHECK_OK(swarf_program_path(program, 0, &path));
    CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
    const made kept = make(stock, surface, 0, 1);
    const swarf_triangles t = swarf_mesh_triangles(kept.mesh);
    double off = 0;
    int count = 0;
    for (size_t i = 0; i < 3 * t.vertex_count; i += 3) {
        const double away = fabs((double)t.xyz[i] - box.lo[0]);
        if (away > 0.2 * voxel) continue;
        off = fmax(off, away);
        count++;
    }
    CHECK(count > 1000 && off < 1e-3 * voxel);
    swarf_mesh_release(kept.mesh);
    swarf_surface_release(surface);
    swarf_program_release(program);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(first);
    swarf_stock_destroy(stock);
}

static void check_refusals(void)
{
    const swarf_box box = {{0, 0, 0}, {2, 2, 2}};
    swarf_stock *stock = stock_block(&box, 0.2);
    swarf_contour_options options = swarf_contour_options_default();
    swarf_mesh *mesh = NULL;
    options.keep_volume = 2;
    CHECK_FAILS(swarf_mesh_contour(stock, &options, NULL, &mesh, NULL), SWARF_ERROR_ARGUMENT, "keep_volume is 2");
    CHECK_OK(swarf_stock_boolean(stock, stock, SWARF_DIFFERENCE));
    options.keep_volume = 1;
    swarf_contour_report report;
    if (CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) {
        CHECK(report.triangles == 0 && report.error_mm == 0);
        swarf_mesh_release(mesh);
    }
    swarf_stock_destroy(stock);
}

int main(void)
{
    const double voxel = 0.3;
    check_bore("flat:d=16,l=20", 6, pi * 64 * 6, voxel);
    check_bore("ball:d=16,l=20", 4, pi * 16 * (24 - 4) / 3, voxel);
    check_post();
    check_random();
    check_flat();
    check_refusals();
    return test_end();
}
