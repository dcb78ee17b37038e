/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Meshes of two random programs on the exact surface, most edges of which are within a voxel or two of others: how many
 * of their vertices are on the surface, and how far from the edges where two sweeps, or one and the block, meet. */
#include <math.h>
#include <stdlib.h>

#include "faces.h"
#include "oracle.h"
#include "stocks.h"

typedef struct part {
    swarf_box box;
    stock_cut cut[STOCK_CUTS];
    const oracle_body *body[STOCK_CUTS];
    int count;
} part;

/* Face 0 .. 5 of the block, then one per move, or (-1) the whole. */
static double value_of(const void *of, int face, const double p[3])
{
    const part *t = of;
    if (face >= 6) return -oracle_swept(t->body[face - 6], &t->cut[face - 6].path, p);
    if (face >= 0) return face % 2 ? p[face / 2] - t->box.hi[face / 2] : t->box.lo[face / 2] - p[face / 2];
    double value = -INFINITY;
    for (int i = 0; i < 6 + t->count; i++) value = fmax(value, value_of(of, i, p));
    return value;
}

static part make_part(test_random random)
{
    enum { MOST = 8 };
    static oracle_body bodies[MOST];
    part out;
    out.count = stock_random_cuts(&random, 6, &out.box, out.cut);
    for (int i = 0, body = -1; i < out.count; i++) {
        if (i == 0 || out.cut[i].cutter != out.cut[i - 1].cutter) {
            swarf_cutter *cutter = NULL;
            if (!CHECK_OK(swarf_cutter_parse(out.cut[i].cutter, &cutter))) exit(test_end());
            bodies[++body] = oracle_body_of(cutter, SWARF_PART_FLUTES);
            swarf_cutter_release(cutter);
        }
        out.body[i] = &bodies[body];
    }
    return out;
}

typedef struct share {
    int count, beyond; /* vertices whose cell an edge passes; farther than 0.02 voxel from it */
    double worst;      /* in voxels */
} share;

static share measure_edges(const part *truth, swarf_stock *stock, double voxel, const swarf_triangles *t)
{
    faces all = {.value = value_of, .of = truth, .count = 6 + truth->count, .apart = 6, .voxel = voxel, .bend = 0.2};
    share out = {0};
    swarf_box cube;
    size_t cubes = 0;
    CHECK_OK(swarf_stock_changed(stock, 0, &cube, 1, &cubes));
    for (int k = 0; k < 3; k++) all.origin[k] = cube.lo[k] + 0.5 * voxel;
    for (size_t i = 0; i < t->vertex_count; i++) {
        const double p[3] = {t->xyz[3 * i], t->xyz[3 * i + 1], t->xyz[3 * i + 2]};
        int corner;
        const double away = faces_edge_distance(&all, p, &corner);
        out.count += away >= 0;
        out.beyond += away > 0.02;
        out.worst = fmax(out.worst, away);
    }
    return out;
}

/* A random program as it was seen: `met` of its vertices at least lie on edges, all but a few on the surface, and a
 * share of `far` at most of those of an edge's cell farther than 0.02 voxel from it. */
static void check_known(uint64_t state, size_t met, double far)
{
    test_random random = {state};
    const double size = test_random_in(&random, 0.05, 0.2);
    swarf_surface *surface = NULL;
    swarf_surface_near *near = NULL;
    swarf_mesh *mesh = NULL;
    swarf_contour_report report = {0};
    static part truth;
    truth = make_part(random);
    swarf_stock *stock = stock_random(&random, size, 6, &surface);
    swarf_contour_options options = swarf_contour_options_default();
    options.error_mm = 0;
    options.surface = surface;
    if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) exit(test_end());
    if (!CHECK_OK(swarf_surface_near_create(surface, &near))) exit(test_end());
    CHECK(report.sharp_vertices >= met);
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    size_t off = 0;
    for (size_t i = 0; i < t.vertex_count; i++) {
        double p[3];
        swarf_box about;
        swarf_surface_point found;
        for (int k = 0; k < 3; k++) {
            p[k] = t.xyz[3 * i + k];
            about.lo[k] = p[k] - size;
            about.hi[k] = p[k] + size;
        }
        CHECK_OK(swarf_surface_gather(near, SIZE_MAX, &about));
        swarf_surface_evaluate(near, p, &found);
        off += fabs(found.value) > 1.2e-3 * size;
    }
    CHECK(off <= 4);
    const share at = measure_edges(&truth, stock, size, &t);
    printf(
        "known program: %zu vertices on edges, %zu of %zu off the surface; %d of %d above 0.02 voxel off their edge, "
        "the worst by %.3f\n",
        report.sharp_vertices, off, t.vertex_count, at.beyond, at.count, at.worst);
    CHECK(at.count > 300 && at.beyond <= far * at.count);
    swarf_surface_near_destroy(near);
    swarf_mesh_release(mesh);
    swarf_surface_release(surface);
    swarf_stock_destroy(stock);
}

int main(void)
{
    /* 952 are met and 1 is off, 934 with quick rounds alone and 20 off where points out of sight are kept; 1116 and 2,
     * 1113 with quick rounds alone, 1099 with sure ones alone */
    check_known(0x256bed0295c89b26, 945, 0.01);
    check_known(0x5ad0cd5c394558a9, 1115, 0.23);
    return test_end();
}
