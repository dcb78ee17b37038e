/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Volumes of stock and design and of what each has beyond the other, on the voxels of the stock. */
#include "swarf/compare.h"

#include "base/parallel.h"
#include "base/status.h"
#include "stock/leaf.h"
#include "stock/measure.h"
#include "stock/stock.h"
#include "stock/voxelize.h"

#include <math.h>
#include <stdlib.h>

/* Of the design only the half voxel about its surface counts; this is the narrowest band that can be had. */
static const double half_width = 2;

/* a less b, node by node of a. Both trees lie on the same voxels; b's nodes start `shift` nodes after a's. */
struct difference {
    const swarf_tree *a, *b;
    const swarf_tree_layout *a_layout, *b_layout;
    int32_t shift[3];
    double *volume; /* in voxels, per node of a */
};

/* Node of b at the place of node `index` of a; 0 where b has none: it is outside there. */
static int matching_node(const struct difference *d, size_t index, size_t *out)
{
    int32_t corner[3];
    swarf_node_corner(d->a_layout, index, corner);
    size_t node = 0;
    for (int k = 0; k < 3; k++) {
        const int32_t at = corner[k] / SWARF_NODE_DIM - d->shift[k];
        if (at < 0 || at >= d->b_layout->count[k]) return 0;
        node = node * (size_t)d->b_layout->count[k] + (size_t)at;
    }
    *out = node;
    return 1;
}

static int is_occupied(const swarf_tree_layout *layout, size_t node, unsigned slot)
{
    return (int)(layout->occupied[node * SWARF_NODE_WORDS + (slot >> 6)] >> (slot & 63) & 1);
}

/* Occupancy of max(a, -b); a NULL side is a tile: a inside, b outside or inside. */
static double slot_difference(const float *a, const float *b, int b_occupied, float scale)
{
    if (!b && b_occupied) return 0;
    if (!a && !b) return SWARF_LEAF_SIZE;
    double total = 0;
    for (int i = 0; i < SWARF_LEAF_SIZE; i++) {
        const float own = a ? a[i] : -INFINITY, other = b ? -b[i] : -INFINITY;
        const float part = 0.5f - (own > other ? own : other) * scale;
        total += (double)(part < 0 ? 0 : part > 1 ? 1 : part);
    }
    return total;
}

static swarf_status node_difference(void *context, size_t node)
{
    const struct difference *d = context;
    const float scale = (float)(1 / d->a_layout->voxel);
    size_t other = 0;
    const int matched = matching_node(d, node, &other);
    double total = 0;
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        if (!is_occupied(d->a_layout, node, slot)) continue;
        const int b_occupied = matched && is_occupied(d->b_layout, other, slot);
        total += slot_difference(swarf_tree_leaf(d->a, node, slot),
                                 b_occupied ? swarf_tree_leaf(d->b, other, slot) : NULL, b_occupied, scale);
    }
    d->volume[node] = total;
    return SWARF_OK;
}

static swarf_status measure_difference(const swarf_tree *a, const swarf_tree *b, const swarf_progress *progress,
                                       double from, double to, double *out)
{
    struct difference d = {.a = a, .b = b, .a_layout = swarf_tree_get_layout(a), .b_layout = swarf_tree_get_layout(b)};
    const double voxel = d.a_layout->voxel;
    for (int k = 0; k < 3; k++)
        d.shift[k] = (int32_t)lround((d.b_layout->origin[k] - d.a_layout->origin[k]) / (SWARF_NODE_DIM * voxel));
    const size_t nodes = swarf_layout_nodes(d.a_layout);
    d.volume = malloc((nodes + 1) * sizeof *d.volume);
    if (!d.volume) return swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory");
    const swarf_status status = swarf_parallel_for(nodes, node_difference, &d, progress, from, to);
    double total = 0;
    for (size_t node = 0; node < nodes && status == SWARF_OK; node++) total += d.volume[node];
    free(d.volume);
    if (status == SWARF_OK) *out = total * voxel * voxel * voxel;
    return status;
}

static swarf_status compare(const swarf_stock *stock, const swarf_shells *design, const swarf_progress *progress,
                            swarf_comparison *out)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = layout->voxel;
    double origin[3];
    int32_t count[3];
    SWARF_TRY(swarf_stock_layout(&design->box, &options, origin, count)); /* for its check of the memory only */
    swarf_tree *tree = NULL;
    SWARF_TRY(swarf_tree_create_shells(design, layout->voxel, layout->origin, half_width, progress, 0, 0.8, &tree));
    swarf_comparison result = {.design_mm3 = design->volume_mm3};
    swarf_status status = swarf_measure_volume(stock, &result.stock_mm3);
    if (status == SWARF_OK) status = measure_difference(stock->tree, tree, progress, 0.8, 0.9, &result.excess_mm3);
    if (status == SWARF_OK) status = measure_difference(tree, stock->tree, progress, 0.9, 1, &result.gouge_mm3);
    swarf_tree_destroy(tree);
    if (status == SWARF_OK) *out = result;
    return status;
}

swarf_status swarf_compare_volume(swarf_stock *stock, const swarf_triangles *design, const swarf_progress *progress,
                                  swarf_comparison *out)
{
    SWARF_REQUIRE(stock && design && out, "compare: stock, design or output missing");
    swarf_shells shells;
    SWARF_TRY(swarf_shells_create(design, &shells));
    swarf_status status = swarf_stock_enter_read(stock);
    if (status == SWARF_OK) {
        status = compare(stock, &shells, progress, out);
        swarf_stock_leave(stock);
    }
    swarf_shells_free(&shells);
    return status;
}
