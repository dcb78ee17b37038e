/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What a deviation is judged from: the distances of the stock's surface from the design, the points of the design that
 * are off the stock's surface, the volumes between both. */
#include "base/parallel.h"
#include "base/status.h"
#include "compare/compare.h"
#include "solid/solid.h"
#include "stock/leaf.h"
#include "stock/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A point within this many voxels of the first stock's surface lies on it. */
static const double untouched_error = 0.05;

/* The surfaces at a point and nearest to it face away from each other from this cosine of their normals on: less than a
 * right angle's, for the normals at edges lie between those of the faces. */
static const double turned_cosine = -0.2;

/* More points on the design than this are not tried; fewer where it is far larger than the stock, which is said
 * elsewhere: each that lies beyond the stock would be told of. */
static const double most_points = 2e7, most_points_beyond = 1e5;

struct work {
    const swarf_stock *stock;
    const swarf_solid *design;
    const swarf_stock *first;
    const swarf_points *points;
    double voxel;
};

static int is_turned(swarf_probe *probe, const double point[3], const swarf_corners *triangle)
{
    double at[3], slope[3], normal[3], product = 0, squares[2] = {0, 0};
    for (int k = 0; k < 3; k++) at[k] = (point[k] - probe->layout->origin[k]) * probe->scale;
    swarf_probe_slope(probe, at, slope);
    swarf_corners_normal(triangle, normal);
    for (int k = 0; k < 3; k++) {
        product += slope[k] * normal[k];
        squares[0] += slope[k] * slope[k];
        squares[1] += normal[k] * normal[k];
    }
    return product < turned_cosine * sqrt(squares[0] * squares[1]);
}

static swarf_status measure_piece(void *context, size_t index)
{
    const struct work *work = context;
    const swarf_points *points = work->points;
    const size_t first = index * SOLID_BATCH;
    const size_t count = points->count - first < SOLID_BATCH ? points->count - first : SOLID_BATCH;
    double point[SOLID_BATCH][3], distance[SOLID_BATCH], at[3];
    size_t place[SOLID_BATCH];
    swarf_probe probe = {0}, own = swarf_probe_begin(work->stock);
    if (work->first) probe = swarf_probe_begin(work->first);
    for (size_t i = 0; i < 3 * count; i++) point[i / 3][i % 3] = points->xyz[3 * first + i];
    swarf_solid_measure(work->design, (const double(*)[3])point, count, distance, place);
    for (size_t i = 0; i < count; i++) {
        points->distance[first + i] = (float)distance[i];
        points->triangle[first + i] = work->design->source[place[i]];
        if (is_turned(&own, point[i], &work->design->corners[place[i]])) points->kind[first + i] |= POINT_TURNED;
        if (!work->first) continue;
        for (int k = 0; k < 3; k++) at[k] = (point[i][k] - probe.layout->origin[k]) * probe.scale;
        if (fabs((double)swarf_probe_point(&probe, at)) < untouched_error * work->voxel)
            points->kind[first + i] |= SWARF_POINT_UNTOUCHED;
    }
    return SWARF_OK;
}

static double most_design_points(const swarf_tree_layout *layout, const swarf_solid *design)
{
    for (int k = 0; k < 3; k++) {
        const double size = layout->count[k] * SWARF_NODE_DIM * layout->voxel;
        if (design->facts.box.hi[k] - design->facts.box.lo[k] > 2 * size) return most_points_beyond;
    }
    return most_points;
}

static swarf_status measure(swarf_measured *m, const swarf_stock *stock, const swarf_solid *design,
                            const swarf_stock *first, const swarf_progress *progress)
{
    const double voxel = m->layout.voxel;
    SWARF_TRY(swarf_sample_stock(stock, progress, 0, 0.1, &m->on_stock));
    struct work work = {stock, design, first, &m->on_stock, voxel};
    SWARF_TRY(swarf_parallel_for((m->on_stock.count + SOLID_BATCH - 1) / SOLID_BATCH, measure_piece, &work, progress,
                                 0.1, 0.5));
    const double spacing = fmax(voxel, sqrt(design->facts.area_mm2 / most_design_points(&m->layout, design)));
    /* 9 bytes for 512 voxels */
    m->slots = calloc(swarf_layout_nodes(&m->layout) * SWARF_NODE_SLOTS, sizeof *m->slots);
    uint8_t *marks = calloc(swarf_layout_nodes(&m->layout) * SWARF_NODE_SLOTS, sizeof *marks);
    const int matches = !design->open && !(spacing > voxel) && swarf_layout_holds(&m->layout, &design->facts.box);
    swarf_status status = SWARF_OK;
    if (!m->slots || !marks) status = swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    const swarf_sampling sampling = {spacing, voxel, matches ? marks : NULL};
    const swarf_progress_share share = {progress, 0.5, 0.6};
    if (status == SWARF_OK)
        status = swarf_sample_design(stock, design, &sampling, &share, &m->on_design, &m->design_mm2);
    if (status == SWARF_OK && matches) status = swarf_match_slots(stock, design, m, marks);
    if (status == SWARF_OK)
        status = swarf_compare_slots(stock, design, matches ? marks : NULL, progress, 0.6, 1, m->slots, &m->volumes);
    free(marks);
    return status;
}

swarf_status swarf_measure(const swarf_stock *stock, const swarf_solid *design, const swarf_stock *first,
                           const swarf_progress *progress, swarf_measured **out)
{
    swarf_measured *measured = calloc(1, sizeof *measured);
    if (!measured) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    measured->references = 1;
    measured->layout = *swarf_tree_get_layout(stock->tree);
    measured->layout.occupied = NULL;
    measured->layout.stamps = NULL;
    measured->source_count = design->source_count;
    const swarf_status status = measure(measured, stock, design, first, progress);
    if (status != SWARF_OK) {
        swarf_measured_release(measured);
        return status;
    }
    *out = measured;
    return SWARF_OK;
}

swarf_measured *swarf_measured_retain(const swarf_measured *measured)
{
    swarf_measured *counted = (swarf_measured *)measured; /* only its count changes */
    __atomic_add_fetch(&counted->references, 1, __ATOMIC_RELAXED);
    return counted;
}

void swarf_measured_release(swarf_measured *measured)
{
    if (!measured || __atomic_sub_fetch(&measured->references, 1, __ATOMIC_ACQ_REL) > 0) return;
    swarf_points_free(&measured->on_stock);
    free(measured->on_design.samples);
    free(measured->slots);
    free(measured);
}
