/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Features of the design that the stock does not show: points of the design farther from the stock's surface than the
 * tolerance. The stock's field tells within its band; beyond it the nearest of the measured points does, which are
 * looked up by the blocks and slots they are in: such a box that lies all within reach, or all beyond it, needs no look
 * at its points. */
#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "compare/compare.h"
#include "stock/leaf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Voxels that a feature of the design must be off by, beyond tolerance, to be found from the design's side: trilinear
 * values next to edges are rounded, and what is thinner than this the stock's own surface shows. */
static const double feature_error = 1;

/* Share of the band from which on a value says no more than that the surface is beyond it. */
static const double band_end = 0.98;

/* Design points of one piece of work, few, for with a wide tolerance each may look at thousands of slots and a caller
 * that cancels waits for a piece; slots along the edge of a block. */
enum { PIECE = 1 << 8, BLOCK = 4 };

/* Voxels along the edges of slots and blocks. Their points may lie a voxel before the upper end: in the gap to the
 * next.
 */
enum { SLOT_EDGE = SWARF_LEAF_DIM, BLOCK_EDGE = BLOCK * SLOT_EDGE };

struct work {
    const swarf_measured *measured;
    const swarf_deviation_options *options;
    double excess, gouge; /* mm from which on a point counts */
    int32_t count[3];     /* of blocks */
    uint8_t *has_points;  /* per block */
    swarf_samples *parts;
};

/* Place of a slot among the leaves that have points, SIZE_MAX: it has none. They are in ascending order. */
static size_t find_leaf(const swarf_points *points, size_t slot)
{
    size_t lo = 0, hi = points->leaf_count;
    while (lo < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (points->slot[middle] < slot)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo < points->leaf_count && points->slot[lo] == slot ? lo : SIZE_MAX;
}

/* A ball, in voxels of the layout, and the last point that was found in such a one. */
struct search {
    double at[3], reach;
    size_t found; /* SIZE_MAX: none */
};

/* Where a cube of voxels lies: beyond the ball, partly in it, all in it. */
enum { BEYOND, PARTLY, WITHIN };

static int place_cube(const struct search *search, const int32_t corner[3], int edge)
{
    double near = 0, far = 0;
    for (int k = 0; k < 3; k++) {
        const double below = corner[k] - search->at[k], above = search->at[k] - (corner[k] + edge);
        const double gap = fmax(fmax(below, above), 0), most = fmax(-below, -above);
        near += gap * gap;
        far += most * most;
    }
    const double square = search->reach * search->reach;
    return near > square ? BEYOND : far <= square ? WITHIN : PARTLY;
}

static int is_in_reach(const struct work *work, const struct search *search, size_t point)
{
    const swarf_tree_layout *layout = &work->measured->layout;
    double square = 0;
    for (size_t k = 0; k < 3; k++) {
        const double at = (work->measured->on_stock.xyz[3 * point + k] - layout->origin[k]) / layout->voxel;
        square += (at - search->at[k]) * (at - search->at[k]);
    }
    return square <= search->reach * search->reach;
}

static int slot_has_surface(const struct work *work, struct search *search, const int32_t slot[3])
{
    const swarf_points *points = &work->measured->on_stock;
    const int32_t corner[3] = {slot[0] * SLOT_EDGE, slot[1] * SLOT_EDGE, slot[2] * SLOT_EDGE};
    if (place_cube(search, corner, SLOT_EDGE) == BEYOND) return 0;
    const size_t leaf = find_leaf(points, swarf_layout_slot(&work->measured->layout, slot));
    if (leaf == SIZE_MAX) return 0;
    for (size_t i = points->first[leaf]; i < points->first[leaf + 1]; i++)
        if (is_in_reach(work, search, i)) {
            search->found = i;
            return 1;
        }
    return 0;
}

static int block_has_surface(const struct work *work, struct search *search, const int32_t block[3])
{
    const int32_t *count = work->count;
    if (!work->has_points[((size_t)block[0] * (size_t)count[1] + (size_t)block[1]) * (size_t)count[2] +
                          (size_t)block[2]])
        return 0;
    const int32_t corner[3] = {block[0] * BLOCK_EDGE, block[1] * BLOCK_EDGE, block[2] * BLOCK_EDGE};
    const int place = place_cube(search, corner, BLOCK_EDGE);
    if (place != PARTLY) return place == WITHIN;
    for (int i = 0; i < BLOCK * BLOCK * BLOCK; i++) {
        const int32_t slot[3] = {block[0] * BLOCK + i / (BLOCK * BLOCK), block[1] * BLOCK + i / BLOCK % BLOCK,
                                 block[2] * BLOCK + i % BLOCK};
        if (slot_has_surface(work, search, slot)) return 1;
    }
    return 0;
}

/* Whether a measured point lies within `reach` of a place. Neighbours are mostly in reach of the same point. */
static int has_surface(const struct work *work, const float xyz[3], double reach, struct search *search)
{
    const swarf_tree_layout *layout = &work->measured->layout;
    int32_t lo[3], hi[3];
    search->reach = reach / layout->voxel;
    for (int k = 0; k < 3; k++) {
        search->at[k] = (xyz[k] - layout->origin[k]) / layout->voxel;
        lo[k] = (int32_t)fmin(fmax(floor((search->at[k] - search->reach) / BLOCK_EDGE) - 1, 0), work->count[k] - 1);
        hi[k] = (int32_t)fmin(fmax(floor((search->at[k] + search->reach) / BLOCK_EDGE), 0), work->count[k] - 1);
    }
    if (search->found != SIZE_MAX && is_in_reach(work, search, search->found)) return 1;
    for (int32_t x = lo[0]; x <= hi[0]; x++)
        for (int32_t y = lo[1]; y <= hi[1]; y++)
            for (int32_t z = lo[2]; z <= hi[2]; z++)
                if (block_has_surface(work, search, (const int32_t[3]){x, y, z})) return 1;
    return 0;
}

static swarf_status find_blocks(struct work *work)
{
    const swarf_points *points = &work->measured->on_stock;
    const swarf_tree_layout *layout = &work->measured->layout;
    for (int k = 0; k < 3; k++) work->count[k] = layout->count[k] * (SWARF_NODE_DIM / BLOCK_EDGE);
    work->has_points =
        calloc((size_t)work->count[0] * (size_t)work->count[1] * (size_t)work->count[2], sizeof *work->has_points);
    if (!work->has_points) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    for (size_t leaf = 0; leaf < points->leaf_count; leaf++) {
        if (points->first[leaf] == points->first[leaf + 1]) continue;
        int32_t node[3], corner[3];
        swarf_node_corner(layout, points->slot[leaf] / SWARF_NODE_SLOTS, node);
        swarf_leaf_corner(node, (unsigned)(points->slot[leaf] % SWARF_NODE_SLOTS), corner);
        work->has_points[((size_t)(corner[0] / BLOCK_EDGE) * (size_t)work->count[1] +
                          (size_t)(corner[1] / BLOCK_EDGE)) *
                             (size_t)work->count[2] +
                         (size_t)(corner[2] / BLOCK_EDGE)] = 1;
    }
    return SWARF_OK;
}

static swarf_status find_piece(void *context, size_t index)
{
    const struct work *work = context;
    const swarf_samples *all = &work->measured->on_design;
    const size_t end = (index + 1) * PIECE < all->count ? (index + 1) * PIECE : all->count;
    const double band = band_end * (double)work->measured->layout.background;
    swarf_samples *found = &work->parts[index];
    struct search search = {.found = SIZE_MAX};
    size_t room = 0;
    for (size_t i = index * PIECE; i < end; i++) {
        swarf_sample sample = all->samples[i];
        const double away = fabs((double)sample.value), limit = sample.value > 0 ? work->excess : work->gouge;
        if (away <= limit && away < band) continue;
        if (swarf_deviation_ignores(work->options, sample.triangle, sample.xyz)) continue;
        if (away <= limit) {
            if (has_surface(work, sample.xyz, limit, &search)) continue;
            sample.value = (float)copysign(limit, (double)sample.value);
        }
        SWARF_TRY(swarf_array_reserve((void **)&found->samples, &room, found->count + 1, sizeof *found->samples));
        found->samples[found->count++] = sample;
    }
    return SWARF_OK;
}

swarf_status swarf_find_missing(const swarf_measured *measured, const swarf_deviation_options *o,
                                const swarf_progress *progress, double from, double to, swarf_samples *out)
{
    /* an allowance is material that ought to be there: the design lies that deep in it */
    const double error = feature_error * measured->layout.voxel;
    struct work work = {.measured = measured,
                        .options = o,
                        .excess = fmax(o->excess_mm + o->allowance_mm, 0) + error,
                        .gouge = fmax(o->gouge_mm - o->allowance_mm, 0) + error};
    const size_t pieces = (measured->on_design.count + PIECE - 1) / PIECE;
    work.parts = calloc(pieces + 1, sizeof *work.parts);
    if (!work.parts) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    swarf_status status = find_blocks(&work);
    if (status == SWARF_OK) status = swarf_parallel_for(pieces, find_piece, &work, progress, from, to);
    if (status == SWARF_OK) status = swarf_samples_join(work.parts, pieces, out);
    swarf_samples_free(work.parts, pieces);
    free(work.has_points);
    return status;
}
