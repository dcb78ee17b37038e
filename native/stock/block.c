/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "stock/block.h"

#include "base/parallel.h"
#include "base/status.h"
#include "stock/leaf.h"
#include "sweep/kernel.h"

#include <math.h>

int swarf_block_reaches(const swarf_stock *stock, const int32_t corner[3])
{
    const double width = SWARF_HALF_WIDTH;
    for (int k = 0; k < 3; k++)
        if (corner[k] < stock->box_centre[k] - stock->box_half[k] + width ||
            corner[k] + SWARF_LEAF_DIM - 1 > stock->box_centre[k] + stock->box_half[k] - width)
            return 1;
    return 0;
}

void swarf_block_fill(const swarf_stock *stock, const int32_t corner[3], float values[SWARF_LEAF_SIZE],
                      uint64_t mask[8], float *least)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    swarf_slabs slabs;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < SWARF_LEAF_DIM; i++)
            slabs.distance[k][i] = (float)(fabs(corner[k] + i - stock->box_centre[k]) - stock->box_half[k]);
    swarf_kernel_current()->block(&slabs, (float)layout->voxel, layout->background, values, mask, least);
}

struct block_work {
    swarf_stock *stock;
    const swarf_tree_layout *layout;
};

static swarf_status occupy_node(void *context, size_t node)
{
    const struct block_work *work = context;
    const swarf_stock *stock = work->stock;
    int32_t origin[3];
    swarf_node_corner(work->layout, node, origin);
    int lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        const double reach = stock->box_half[k] + (double)SWARF_HALF_WIDTH;
        /* slots with a voxel within reach of the block's middle */
        lo[k] = (int)fmax(0, ceil((stock->box_centre[k] - reach - (SWARF_LEAF_DIM - 1) - origin[k]) / SWARF_LEAF_DIM));
        hi[k] = (int)fmin(15, floor((stock->box_centre[k] + reach - origin[k]) / SWARF_LEAF_DIM));
    }
    swarf_tree_fill(stock->tree, node, lo, hi);
    return SWARF_OK;
}

swarf_status swarf_block_occupy(swarf_stock *stock)
{
    struct block_work work = {stock, swarf_tree_get_layout(stock->tree)};
    return swarf_parallel_for(swarf_layout_nodes(work.layout), occupy_node, &work, NULL, 0, 1);
}

static swarf_status finish_node(void *context, size_t node)
{
    const struct block_work *work = context;
    swarf_stock *stock = work->stock;
    int32_t origin[3], highest[3];
    swarf_node_corner(work->layout, node, origin);
    /* a node whose first and last leaf lie deep inside has no faces */
    swarf_leaf_corner(origin, SWARF_NODE_SLOTS - 1, highest);
    if (!swarf_block_reaches(stock, origin) && !swarf_block_reaches(stock, highest)) return SWARF_OK;
    const float drop = SWARF_LEAF_DROP * (float)work->layout->voxel;
    const uint64_t *words = work->layout->occupied + node * SWARF_NODE_WORDS;
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        if (!(words[slot >> 6] >> (slot & 63) & 1) || swarf_tree_leaf(stock->tree, node, slot)) continue;
        int32_t corner[3];
        swarf_leaf_corner(origin, slot, corner);
        if (!swarf_block_reaches(stock, corner)) continue;
        _Alignas(64) float values[SWARF_LEAF_SIZE];
        uint64_t mask[8];
        float least;
        swarf_block_fill(stock, corner, values, mask, &least);
        if (least >= drop)
            swarf_tree_tile(stock->tree, node, slot, 0);
        else
            SWARF_TRY(swarf_tree_leaf_add(stock->tree, node, slot, values, mask));
    }
    return SWARF_OK;
}

swarf_status swarf_block_finish(swarf_stock *stock)
{
    if (!stock->untouched) return SWARF_OK;
    struct block_work work = {stock, swarf_tree_get_layout(stock->tree)};
    SWARF_TRY(swarf_parallel_for(swarf_layout_nodes(work.layout), finish_node, &work, NULL, 0, 1));
    stock->untouched = 0;
    return SWARF_OK;
}
