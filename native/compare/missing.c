/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Features of the design that the stock does not show: points of the design farther from the stock's surface than the
 * tolerance. The stock's field tells within its band; beyond it the nearest of the measured points does, which are
 * looked up by the slots they are in. */
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

enum { PIECE = 1 << 12 };

struct work {
    const swarf_measured *measured;
    const swarf_deviation_options *options;
    double excess, gouge; /* mm from which on a point counts */
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

/* Whether a measured point lies within `reach` of a place. */
static int has_surface(const swarf_measured *m, const float xyz[3], double reach)
{
    const swarf_tree_layout *layout = &m->layout;
    int32_t lo[3], hi[3];
    for (int k = 0; k < 3; k++) { /* points may lie a voxel before their slot's upper end: in the gap to the next */
        const double at = (xyz[k] - layout->origin[k]) / layout->voxel, far = reach / layout->voxel + 1;
        const double last = (double)layout->count[k] * SWARF_NODE_DIM / SWARF_LEAF_DIM - 1;
        lo[k] = (int32_t)fmin(fmax(floor((at - far) / SWARF_LEAF_DIM), 0), last);
        hi[k] = (int32_t)fmin(fmax(floor((at + far) / SWARF_LEAF_DIM), 0), last);
    }
    for (int32_t x = lo[0]; x <= hi[0]; x++)
        for (int32_t y = lo[1]; y <= hi[1]; y++)
            for (int32_t z = lo[2]; z <= hi[2]; z++) {
                const int32_t slot[3] = {x, y, z};
                const size_t leaf = find_leaf(&m->on_stock, swarf_layout_slot(layout, slot));
                if (leaf == SIZE_MAX) continue;
                for (size_t i = m->on_stock.first[leaf]; i < m->on_stock.first[leaf + 1]; i++) {
                    double square = 0;
                    for (size_t k = 0; k < 3; k++) {
                        const double away = (double)m->on_stock.xyz[3 * i + k] - xyz[k];
                        square += away * away;
                    }
                    if (square <= reach * reach) return 1;
                }
            }
    return 0;
}

static swarf_status find_piece(void *context, size_t index)
{
    const struct work *work = context;
    const swarf_samples *all = &work->measured->on_design;
    const size_t end = (index + 1) * PIECE < all->count ? (index + 1) * PIECE : all->count;
    const double band = band_end * (double)work->measured->layout.background;
    swarf_samples *found = &work->parts[index];
    size_t room = 0;
    for (size_t i = index * PIECE; i < end; i++) {
        swarf_sample sample = all->samples[i];
        const double away = fabs((double)sample.value), limit = sample.value > 0 ? work->excess : work->gouge;
        if (away <= limit && away < band) continue;
        if (swarf_deviation_ignores(work->options, sample.triangle, sample.xyz)) continue;
        if (away <= limit) {
            if (has_surface(work->measured, sample.xyz, limit)) continue;
            sample.value = (float)copysign(limit, (double)sample.value);
        }
        SWARF_TRY(swarf_array_reserve((void **)&found->samples, &room, found->count + 1, sizeof *found->samples));
        found->samples[found->count++] = sample;
    }
    return SWARF_OK;
}

swarf_status swarf_find_missing(const swarf_measured *measured, const swarf_deviation_options *o, swarf_samples *out)
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
    swarf_status status = swarf_parallel_for(pieces, find_piece, &work, NULL, 0, 1);
    if (status == SWARF_OK) status = swarf_samples_join(work.parts, pieces, out);
    swarf_samples_free(work.parts, pieces);
    return status;
}
