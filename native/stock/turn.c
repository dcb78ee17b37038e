/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Quarter turns. The new layout is the old one turned, so that nodes become nodes, leaves leaves and voxels voxels:
 *
 *   new index along k = old index along axis[k], or (nodes * 128 - 1 - that) where sign[k] is negative
 *
 * and the shift goes into the place of the layout's first voxel, which may be anywhere. */
#include "stock/turn.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/leaf.h"
#include "stock/stock.h"

#include <string.h>

struct turning {
    const swarf_stock *from;
    const swarf_tree_layout *old;
    swarf_tree *to;
    const swarf_tree_layout *layout;
    int axis[3], sign[3];
};

/* Old coordinates of something at `at` in a cube of `dim` along each axis. */
static void turn_back(const struct turning *t, const int32_t at[3], const int32_t dim[3], int32_t old[3])
{
    for (int k = 0; k < 3; k++) old[t->axis[k]] = t->sign[k] > 0 ? at[k] : dim[k] - 1 - at[k];
}

static void turn_values(const struct turning *t, const float *old, float values[SWARF_LEAF_SIZE])
{
    static const int32_t dim[3] = {SWARF_LEAF_DIM, SWARF_LEAF_DIM, SWARF_LEAF_DIM};
    for (int32_t i = 0; i < SWARF_LEAF_SIZE; i++) {
        int32_t at[3];
        turn_back(t, (int32_t[3]){i >> 6, i >> 3 & 7, i & 7}, dim, at);
        values[i] = old[at[0] * 64 + at[1] * 8 + at[2]];
    }
}

static swarf_status turn_node(void *context, size_t node)
{
    const struct turning *t = context;
    static const int32_t slots[3] = {16, 16, 16};
    const size_t rows = (size_t)t->layout->count[1] * (size_t)t->layout->count[2];
    const int32_t at[3] = {(int32_t)(node / rows), (int32_t)(node % rows / (size_t)t->layout->count[2]),
                           (int32_t)(node % (size_t)t->layout->count[2])};
    int32_t old[3];
    turn_back(t, at, t->layout->count, old);
    const size_t from =
        ((size_t)old[0] * (size_t)t->old->count[1] + (size_t)old[1]) * (size_t)t->old->count[2] + (size_t)old[2];
    for (int32_t slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        turn_back(t, (int32_t[3]){slot >> 8, slot >> 4 & 15, slot & 15}, slots, old);
        const unsigned was = (unsigned)(old[0] << 8 | old[1] << 4 | old[2]);
        const float *leaf = swarf_tree_leaf(t->from->tree, from, was);
        if (leaf) {
            float values[SWARF_LEAF_SIZE], least;
            uint64_t mask[8];
            turn_values(t, leaf, values);
            swarf_leaf_mask(values, t->layout->background, mask, &least);
            SWARF_TRY(swarf_tree_leaf_add(t->to, node, (unsigned)slot, values, mask));
        } else if (swarf_tree_tile_inside(t->from->tree, from, was)) {
            swarf_tree_tile(t->to, node, (unsigned)slot, 1);
        }
    }
    return SWARF_OK;
}

static swarf_status turn_tree(struct turning *t, const swarf_placement *placement, const swarf_progress *progress)
{
    double first[3], origin[3];
    int32_t count[3];
    for (int k = 0; k < 3; k++) {
        count[k] = t->old->count[t->axis[k]];
        const int32_t last = count[k] * SWARF_NODE_DIM - 1;
        first[t->axis[k]] = t->old->origin[t->axis[k]] + (t->sign[k] > 0 ? 0 : last * t->old->voxel);
    }
    swarf_placement_point(placement, first, origin);
    SWARF_TRY(swarf_tree_create(t->old->voxel, origin, count, &t->to));
    t->layout = swarf_tree_get_layout(t->to);
    const swarf_status status = swarf_parallel_for(swarf_layout_nodes(t->layout), turn_node, t, progress, 0, 1);
    if (status != SWARF_OK) {
        swarf_tree_destroy(t->to);
        return status;
    }
    /* a block that was cut is no block any more, however it is turned */
    swarf_tree_stamp_all(t->to, t->old->generation);
    return SWARF_OK;
}

/* The copy is as large as what is copied. */
static swarf_status check_size(const swarf_tree *tree, size_t memory_limit)
{
    size_t leaves, bytes;
    swarf_tree_size(tree, &leaves, &bytes);
    const double limit = swarf_memory_limit(memory_limit);
    if ((double)bytes <= limit) return SWARF_OK;
    return swarf_fail(SWARF_ERROR_MEMORY, "stock: turned it needs %.3g GiB, %.3g GiB may be used",
                      (double)bytes / 0x1p30, limit / 0x1p30);
}

swarf_status swarf_stock_turn(swarf_stock *stock, const swarf_placement *placement, size_t memory_limit,
                              const swarf_progress *progress, swarf_stock **out)
{
    SWARF_REQUIRE(stock && placement && out, "stock: NULL");
    struct turning t = {.from = stock};
    SWARF_REQUIRE(swarf_placement_quarters(placement, t.axis, t.sign), "stock: it is not turned by quarters");
    SWARF_TRY(swarf_stock_enter_write(stock)); /* untouched faces stay without leaves */
    t.old = swarf_tree_get_layout(stock->tree);
    swarf_stock *turned = NULL;
    swarf_status status = check_size(stock->tree, memory_limit);
    if (status == SWARF_OK) status = turn_tree(&t, placement, progress);
    if (status == SWARF_OK) status = swarf_stock_wrap(t.to, &turned);
    if (status == SWARF_OK) {
        turned->untouched = stock->untouched;
        for (int k = 0; k < 3; k++) {
            const double centre = stock->box_centre[t.axis[k]];
            turned->box_centre[k] = t.sign[k] > 0 ? centre : t.layout->count[k] * SWARF_NODE_DIM - 1 - centre;
            turned->box_half[k] = stock->box_half[t.axis[k]];
        }
        *out = turned;
    }
    swarf_stock_leave(stock);
    return status;
}
