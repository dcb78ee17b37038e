/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Points on surfaces. A stock is sampled where its surface crosses the lines between voxel centres: each such crossing
 * along axis k stands for h^2 |n_k| of the surface, which adds up to its area because n is a unit vector. */
#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "base/vector.h"
#include "compare/compare.h"
#include "solid/solid.h"
#include "stock/leaf.h"
#include "stock/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A leaf with a border of one voxel. */
enum { EDGE = SWARF_LEAF_DIM + 2 };
static const int stride[3] = {EDGE * EDGE, EDGE, 1};

/* Where the surface is smooth the gradients on both sides of it agree to this cosine and have the length of a voxel to
 * this share of it; closer than a voxel to an edge one of them does not. */
static const double smooth_cosine = 0.98, smooth_length = 0.06;

/* Where a stock's surface runs beside the design's its field grows along the design's normal by at least this much:
 * by 1 on faces, less at edges, by -1 at the other side of a thin wall. */
static const double least_slope = 0.2;

/* Pieces of work of this many leaves or triangles. */
enum { LEAVES = 64, TRIANGLES = 1024 };

struct work {
    const swarf_stock *stock;
    const swarf_tree_layout *layout;
    const swarf_leaf *leaves;
    size_t leaf_count;
    swarf_samples *parts; /* one per piece of work */
    const swarf_solid *design;
    swarf_sampling sampling;
    swarf_points *points; /* where the parts go; first counts within a part until they are there */
    size_t *starts;       /* of each part in them */
    double *area;         /* per piece */
};

static void load_border(const struct work *work, const swarf_leaf *leaf, float out[EDGE * EDGE * EDGE])
{
    for (int part = 0; part < 27; part++) {
        const int side[3] = {part / 9 - 1, part / 3 % 3 - 1, part % 3 - 1};
        int32_t at[3];
        int lo[3], hi[3];
        for (int k = 0; k < 3; k++) {
            at[k] = leaf->ijk[k] + side[k] * SWARF_LEAF_DIM;
            lo[k] = side[k] < 0 ? -1 : side[k] > 0 ? SWARF_LEAF_DIM : 0;
            hi[k] = side[k] == 0 ? SWARF_LEAF_DIM : lo[k] + 1;
        }
        const swarf_tree_layout *layout = work->layout;
        float tile = layout->background;
        const float *values = NULL;
        int within = 1;
        for (int k = 0; k < 3; k++) within &= at[k] >= 0 && at[k] < layout->count[k] * SWARF_NODE_DIM;
        if (within) {
            const size_t node =
                ((size_t)(at[0] >> 7) * (size_t)layout->count[1] + (size_t)(at[1] >> 7)) * (size_t)layout->count[2] +
                (size_t)(at[2] >> 7);
            const unsigned slot = (unsigned)((at[0] >> 3 & 15) << 8 | (at[1] >> 3 & 15) << 4 | (at[2] >> 3 & 15));
            values = swarf_tree_leaf(work->stock->tree, node, slot);
            if (layout->occupied[node * SWARF_NODE_WORDS + (slot >> 6)] >> (slot & 63) & 1) tile = -tile;
        }
        for (int x = lo[0]; x < hi[0]; x++)
            for (int y = lo[1]; y < hi[1]; y++) {
                float *row = out + (x + 1) * stride[0] + (y + 1) * stride[1] + 1;
                const float *from = values ? values + (x & 7) * 64 + (y & 7) * 8 : NULL;
                if (from && side[2] == 0)
                    memcpy(row, from, SWARF_LEAF_DIM * sizeof *row);
                else
                    for (int z = lo[2]; z < hi[2]; z++) row[z] = from ? from[z & 7] : tile;
            }
    }
}

/* Bit k of row (x, y) of the border: whether its value k along z is in the material. */
static void find_signs(const float border[EDGE * EDGE * EDGE], uint32_t sign[EDGE][EDGE])
{
    for (int x = 0; x < EDGE; x++)
        for (int y = 0; y < EDGE; y++) {
            const float *row = border + x * stride[0] + y * stride[1];
            uint32_t bits = 0;
            for (int z = 0; z < EDGE; z++) bits |= (uint32_t)(row[z] < 0) << z;
            sign[x][y] = bits;
        }
}

static void gradient_at(const float *value, double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = 0.5 * ((double)value[stride[k]] - value[-stride[k]]);
}

/* Gradient of the field at a place of the border is made from one side: the border has no neighbours. */
static void gradient_near(const float *value, const int at[3], double out[3])
{
    for (int k = 0; k < 3; k++) {
        const int below = at[k] > 0, above = at[k] < EDGE - 1;
        out[k] = ((double)value[above * stride[k]] - value[-below * stride[k]]) / (below + above);
    }
}

static swarf_status add_sample(swarf_samples *samples, size_t *room, const swarf_sample *sample)
{
    SWARF_TRY(swarf_array_reserve((void **)&samples->samples, room, samples->count + 1, sizeof *sample));
    samples->samples[samples->count++] = *sample;
    return SWARF_OK;
}

/* The crossing between a voxel at `at` (in the border's places) and the next along `axis`. */
static swarf_sample make_crossing(const struct work *work, const swarf_leaf *leaf, const float *border, const int at[3],
                                  int axis)
{
    const double voxel = work->layout->voxel;
    const float *a = border + at[0] * stride[0] + at[1] * stride[1] + at[2], *b = a + stride[axis];
    const double t = (double)*a / ((double)*a - *b);
    const int next[3] = {at[0] + (axis == 0), at[1] + (axis == 1), at[2] + (axis == 2)};
    double u[3], v[3], normal[3];
    gradient_at(a, u);
    gradient_near(b, next, v);
    u[axis] = v[axis] = (double)*b - *a; /* beyond them the band may end */
    const double uu = sqrt(vector_dot(u, u)), vv = sqrt(vector_dot(v, v));
    swarf_sample sample = {.kind = SWARF_POINT_EDGE};
    if (vector_dot(u, v) >= smooth_cosine * uu * vv && fabs(uu - voxel) <= smooth_length * voxel &&
        fabs(vv - voxel) <= smooth_length * voxel)
        sample.kind = 0;
    for (int k = 0; k < 3; k++) {
        normal[k] = (1 - t) * u[k] + t * v[k];
        sample.xyz[k] = (float)(work->layout->origin[k] + voxel * (leaf->ijk[k] + at[k] - 1 + (k == axis ? t : 0)));
    }
    const double length = sqrt(vector_dot(normal, normal));
    sample.area = (float)(length > 0 ? voxel * voxel * fabs(normal[axis]) / length : 0);
    return sample;
}

static swarf_status sample_leaves(void *context, size_t index)
{
    const struct work *work = context;
    const size_t end = (index + 1) * LEAVES < work->leaf_count ? (index + 1) * LEAVES : work->leaf_count;
    float border[EDGE * EDGE * EDGE];
    uint32_t sign[EDGE][EDGE];
    size_t room = 0;
    for (size_t i = index * LEAVES; i < end; i++) {
        work->points->slot[i] = work->leaves[i].node * SWARF_NODE_SLOTS + work->leaves[i].slot;
        work->points->first[i] = work->parts[index].count;
        load_border(work, &work->leaves[i], border);
        find_signs(border, sign);
        for (int row = 0; row < SWARF_LEAF_DIM * SWARF_LEAF_DIM; row++) {
            int at[3] = {(row >> 3) + 1, (row & 7) + 1, 0};
            const uint32_t own = sign[at[0]][at[1]];
            const uint32_t crossed[3] = {own ^ sign[at[0] + 1][at[1]], own ^ sign[at[0]][at[1] + 1], own ^ own >> 1};
            const uint32_t in_leaf = ((1u << SWARF_LEAF_DIM) - 1) << 1;
            for (uint32_t left = (crossed[0] | crossed[1] | crossed[2]) & in_leaf; left; left &= left - 1) {
                at[2] = __builtin_ctz(left);
                for (int axis = 0; axis < 3; axis++) {
                    if (!(crossed[axis] >> at[2] & 1)) continue;
                    const swarf_sample sample = make_crossing(work, &work->leaves[i], border, at, axis);
                    SWARF_TRY(add_sample(&work->parts[index], &room, &sample));
                }
            }
        }
    }
    return SWARF_OK;
}

void swarf_samples_free(swarf_samples *parts, size_t count)
{
    for (size_t i = 0; parts && i < count; i++) free(parts[i].samples);
    free(parts);
}

swarf_status swarf_samples_join(const swarf_samples *parts, size_t count, swarf_samples *out)
{
    swarf_samples all = {0};
    size_t total = 0;
    for (size_t i = 0; i < count; i++) total += parts[i].count;
    all.samples = malloc((total + 1) * sizeof *all.samples);
    if (!all.samples) return swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory for %zu points", total);
    for (size_t i = 0; i < count; i++) {
        if (parts[i].count) memcpy(all.samples + all.count, parts[i].samples, parts[i].count * sizeof *all.samples);
        all.count += parts[i].count;
    }
    *out = all;
    return SWARF_OK;
}

static swarf_status reserve_points(swarf_points *points, size_t count)
{
    points->count = count;
    points->xyz = malloc((3 * count + 1) * sizeof *points->xyz);
    points->area = malloc((count + 1) * sizeof *points->area);
    points->distance = malloc((count + 1) * sizeof *points->distance);
    points->triangle = malloc((count + 1) * sizeof *points->triangle);
    points->kind = malloc(count + 1);
    if (!points->xyz || !points->area || !points->distance || !points->triangle || !points->kind)
        return swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory for %zu points", count);
    return SWARF_OK;
}

void swarf_points_free(swarf_points *points)
{
    free(points->xyz);
    free(points->area);
    free(points->distance);
    free(points->triangle);
    free(points->kind);
    free(points->slot);
    free(points->first);
}

static swarf_status spread_part(void *context, size_t index)
{
    const struct work *work = context;
    const swarf_samples *part = &work->parts[index];
    const swarf_points *points = work->points;
    const size_t end = (index + 1) * LEAVES < work->leaf_count ? (index + 1) * LEAVES : work->leaf_count;
    for (size_t i = index * LEAVES; i < end; i++) points->first[i] += work->starts[index];
    for (size_t i = 0, at = work->starts[index]; i < part->count; i++, at++) {
        memcpy(points->xyz + 3 * at, part->samples[i].xyz, 3 * sizeof *points->xyz);
        points->area[at] = part->samples[i].area;
        points->kind[at] = part->samples[i].kind;
    }
    return SWARF_OK;
}

static swarf_status sample(struct work *work, size_t pieces, const swarf_progress *progress, double from, double to)
{
    swarf_points *points = work->points;
    points->leaf_count = work->leaf_count;
    points->slot = malloc((work->leaf_count + 1) * sizeof *points->slot);
    points->first = malloc((work->leaf_count + 1) * sizeof *points->first);
    if (!work->parts || !work->starts || !points->slot || !points->first)
        return swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory");
    SWARF_TRY(swarf_parallel_for(pieces, sample_leaves, work, progress, from, to));
    size_t total = 0;
    for (size_t i = 0; i < pieces; i++) {
        work->starts[i] = total;
        total += work->parts[i].count;
    }
    points->first[work->leaf_count] = total;
    SWARF_TRY(reserve_points(points, total));
    return swarf_parallel_for(pieces, spread_part, work, NULL, 0, 1);
}

swarf_status swarf_sample_stock(const swarf_stock *stock, const swarf_progress *progress, double from, double to,
                                swarf_points *out)
{
    swarf_points points = {0};
    struct work work = {.stock = stock, .layout = swarf_tree_get_layout(stock->tree), .points = &points};
    swarf_leaf *leaves = NULL;
    SWARF_TRY(swarf_stock_leaves(stock, &leaves, &work.leaf_count));
    work.leaves = leaves;
    const size_t pieces = (work.leaf_count + LEAVES - 1) / LEAVES;
    work.parts = calloc(pieces + 1, sizeof *work.parts);
    work.starts = malloc((pieces + 1) * sizeof *work.starts);
    const swarf_status status = sample(&work, pieces, progress, from, to);
    swarf_samples_free(work.parts, pieces);
    free(work.starts);
    free(leaves);
    if (status == SWARF_OK)
        *out = points;
    else
        swarf_points_free(&points);
    return status;
}

/* What one piece of the design's triangles finds. */
struct finder {
    const struct work *work;
    swarf_probe probe;
    swarf_samples *found;
    size_t room;
};

/* `normal` is a unit vector. A point of no area only leaves a mark. */
static swarf_status try_point(struct finder *f, size_t place, const double point[3], const double normal[3],
                              double area)
{
    const struct work *work = f->work;
    double at[3], slope[3] = {0, 0, 0}, value = work->layout->background; /* beyond the layout */
    int within = 1;
    for (int k = 0; k < 3; k++) {
        at[k] = (point[k] - work->layout->origin[k]) * f->probe.scale;
        within &= at[k] >= -1 && at[k] < (double)work->layout->count[k] * SWARF_NODE_DIM;
    }
    if (within) value = (double)swarf_probe_slope(&f->probe, at, slope);
    if (work->sampling.marks) {
        const int is_beside = fabs(value) <= work->sampling.least && vector_dot(slope, normal) >= least_slope;
        const int has_side = work->design->state[place] != SOLID_SLIVER;
        swarf_mark_slots(work->layout, at, is_beside && has_side ? SLOT_MET : SLOT_OPEN, work->sampling.marks);
    }
    if (fabs(value) <= work->sampling.least || area == 0) return SWARF_OK;
    swarf_sample sample = {
        .value = (float)-value, .area = (float)area, .triangle = work->design->source[place], .missing = 1};
    for (int k = 0; k < 3; k++) sample.xyz[k] = (float)point[k];
    return add_sample(f->found, &f->room, &sample);
}

/* Marks along an edge. */
static swarf_status mark_edge(struct finder *f, size_t place, const float from[3], const float to[3],
                              const double normal[3])
{
    double square = 0, point[3];
    for (int k = 0; k < 3; k++) square += ((double)to[k] - from[k]) * ((double)to[k] - from[k]);
    const size_t steps = (size_t)ceil(sqrt(square) / f->work->sampling.spacing);
    for (size_t i = 0; i <= steps; i++) {
        const double along = steps ? (double)i / (double)steps : 0;
        for (int k = 0; k < 3; k++) point[k] = (1 - along) * from[k] + along * to[k];
        SWARF_TRY(try_point(f, place, point, normal, 0));
    }
    return SWARF_OK;
}

/* Points in rows along the longest edge, in the middle of pieces of equal area. Beyond the ends of a row lie what slant
 * edges cut off it; where this is far, as in slivers, these edges are marked too, so that all of the triangle is within
 * 1.2 times the spacing of a mark. */
static swarf_status sample_triangle(struct finder *f, size_t place, double *area)
{
    const struct work *work = f->work;
    const swarf_corners *t = &work->design->corners[place];
    double edge[3], normal[3];
    int base = 0;
    for (int i = 0; i < 3; i++) {
        double square = 0;
        for (int k = 0; k < 3; k++) {
            const double along = (double)t->xyz[(i + 1) % 3][k] - t->xyz[i][k];
            square += along * along;
        }
        edge[i] = sqrt(square);
        if (edge[i] > edge[base]) base = i;
    }
    swarf_corners_normal(t, normal);
    const double own = 0.5 * sqrt(vector_dot(normal, normal));
    if (!(own > 0)) return SWARF_OK;
    *area += own;
    for (int k = 0; k < 3; k++) normal[k] /= 2 * own;
    const size_t rows = (size_t)ceil(2 * own / edge[base] / work->sampling.spacing);
    const float *a = t->xyz[base], *b = t->xyz[(base + 1) % 3], *top = t->xyz[(base + 2) % 3];
    double foot = 0; /* of the top on the longest edge, from its start */
    for (int k = 0; k < 3; k++) foot += ((double)top[k] - a[k]) * ((double)b[k] - a[k]) / edge[base];
    if (work->sampling.marks && fmax(foot, edge[base] - foot) > (double)rows * work->sampling.spacing) {
        SWARF_TRY(mark_edge(f, place, a, top, normal));
        SWARF_TRY(mark_edge(f, place, b, top, normal));
    }
    for (size_t row = 0; row < rows; row++) {
        const double up = ((double)row + 0.5) / (double)rows;
        const size_t columns = (size_t)ceil(edge[base] * (1 - up) / work->sampling.spacing);
        for (size_t column = 0; column < columns; column++) {
            const double along = ((double)column + 0.5) / (double)columns;
            double point[3];
            for (int k = 0; k < 3; k++) point[k] = up * top[k] + (1 - up) * (a[k] + along * ((double)b[k] - a[k]));
            SWARF_TRY(try_point(f, place, point, normal, own * 2 * (1 - up) / (double)rows / (double)columns));
        }
    }
    return SWARF_OK;
}

static swarf_status sample_triangles(void *context, size_t index)
{
    const struct work *work = context;
    const size_t count = work->design->tree.count;
    const size_t end = (index + 1) * TRIANGLES < count ? (index + 1) * TRIANGLES : count;
    struct finder finder = {.work = work, .probe = swarf_probe_begin(work->stock), .found = &work->parts[index]};
    for (size_t place = index * TRIANGLES; place < end; place++)
        SWARF_TRY(sample_triangle(&finder, place, &work->area[index]));
    return SWARF_OK;
}

swarf_status swarf_sample_design(const swarf_stock *stock, const swarf_solid *design, const swarf_sampling *sampling,
                                 const swarf_progress_share *share, swarf_samples *out, double *area)
{
    const size_t pieces = (design->tree.count + TRIANGLES - 1) / TRIANGLES;
    struct work work = {
        .stock = stock, .layout = swarf_tree_get_layout(stock->tree), .design = design, .sampling = *sampling};
    work.parts = calloc(pieces + 1, sizeof *work.parts);
    work.area = calloc(pieces + 1, sizeof *work.area);
    swarf_status status = SWARF_OK;
    if (!work.parts || !work.area) status = swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory");
    if (status == SWARF_OK)
        status = swarf_parallel_for(pieces, sample_triangles, &work, share->whole, share->from, share->to);
    double total = 0;
    for (size_t i = 0; i < pieces && status == SWARF_OK; i++) total += work.area[i];
    if (status == SWARF_OK) status = swarf_samples_join(work.parts, pieces, out);
    if (status == SWARF_OK) *area = total;
    swarf_samples_free(work.parts, pieces);
    free(work.area);
    return status;
}
