/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "stock/block.h"

#include "base/parallel.h"
#include "base/status.h"
#include "stock/leaf.h"

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

void swarf_block_fill(const swarf_stock *stock, const int32_t corner[3], float values[SWARF_LEAF_SIZE])
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    const float voxel = (float)layout->voxel, background = layout->background;
    /* per axis: signed distance to the slab between the two faces, and its positive part squared */
    float slab[3][SWARF_LEAF_DIM], square[3][SWARF_LEAF_DIM];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < SWARF_LEAF_DIM; i++) {
            slab[k][i] = (float)(fabs(corner[k] + i - stock->box_centre[k]) - stock->box_half[k]);
            square[k][i] = slab[k][i] > 0 ? slab[k][i] * slab[k][i] : 0;
        }
    for (int x = 0; x < SWARF_LEAF_DIM; x++)
        for (int y = 0; y < SWARF_LEAF_DIM; y++) {
            const float side = slab[0][x] > slab[1][y] ? slab[0][x] : slab[1][y];
            const float side_square = square[0][x] + square[1][y];
            float *row = values + x * 64 + y * 8;
            for (int z = 0; z < SWARF_LEAF_DIM; z++) {
                const float most = slab[2][z] > side ? slab[2][z] : side;
                const float inner = most < 0 ? most : 0;
                const float value = (inner + sqrtf(side_square + square[2][z])) * voxel;
                row[z] = value > background ? background : value < -background ? -background : value;
            }
        }
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
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        int32_t corner[3];
        swarf_leaf_corner(origin, slot, corner);
        int inside = 1;
        for (int k = 0; k < 3; k++)
            if (fabs(corner[k] + 3.5 - stock->box_centre[k]) - 3.5 > stock->box_half[k] + (double)SWARF_HALF_WIDTH)
                inside = 0;
        if (inside) swarf_tree_tile(stock->tree, node, slot, 1);
    }
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
    int32_t origin[3];
    swarf_node_corner(work->layout, node, origin);
    const float drop = SWARF_LEAF_DROP * (float)work->layout->voxel;
    const uint64_t *words = work->layout->occupied + node * SWARF_NODE_WORDS;
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        if (!(words[slot >> 6] >> (slot & 63) & 1) || swarf_tree_leaf(stock->tree, node, slot)) continue;
        int32_t corner[3];
        swarf_leaf_corner(origin, slot, corner);
        if (!swarf_block_reaches(stock, corner)) continue;
        float values[SWARF_LEAF_SIZE];
        uint64_t mask[8];
        swarf_block_fill(stock, corner, values);
        float least;
        swarf_leaf_mask(values, work->layout->background, mask, &least);
        if (least >= drop) swarf_tree_tile(stock->tree, node, slot, 0);
        else SWARF_TRY(swarf_tree_leaf_add(stock->tree, node, slot, values, mask));
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
