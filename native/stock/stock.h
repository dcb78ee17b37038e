/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Inside of a stock, for this room and the ones that read it (render, compare, mesh).
 *
 * The faces of a block that no move has touched have no leaves until someone reads them ("untouched"): the cutting
 * loop evaluates the box formula instead. swarf_stock_enter_read() makes them.
 */
#ifndef SWARF_STOCK_STOCK_H
#define SWARF_STOCK_STOCK_H

#include "stock/vdb_tree.h"
#include "swarf/stock.h"

#ifdef __cplusplus
extern "C" {
#endif

struct swarf_stock {
    swarf_tree *tree;
    int busy;             /* 1 while a call is in; only by atomic exchange */
    int untouched;        /* 1 while the block's faces may lack leaves */
    double box_centre[3]; /* of the block, in the layout's voxels */
    double box_half[3];
};

/** Enter a call that only reads: SWARF_ERROR_BUSY when another thread is in; makes the leaves of untouched faces.
 *  On success end with swarf_stock_leave(). */
swarf_status swarf_stock_enter_read(swarf_stock *stock);
/** Enter a call that cuts: as above, but untouched faces stay without leaves. */
swarf_status swarf_stock_enter_write(swarf_stock *stock);
void swarf_stock_leave(swarf_stock *stock);

/** A stock around a tree it takes over (destroyed on failure). */
swarf_status swarf_stock_wrap(swarf_tree *tree, swarf_stock **out);

/** Lay out nodes for material in `box`: the index origin 12 voxels outside its low corner, voxel centres half a voxel
 *  inside its faces. Refuses when the estimate exceeds the options' limit. */
swarf_status swarf_stock_layout(const swarf_box *box, const swarf_stock_options *options, double origin[3],
                                int32_t count[3]);

/** A leaf as the readers see it: layout index of its low corner, its node and slot, its 512 values. */
typedef struct swarf_leaf {
    int32_t ijk[3];
    uint32_t slot;
    size_t node;
    const float *values;
} swarf_leaf;

/** All leaves in ascending order of node and slot; freed by the caller with free(). Call between enter and leave. */
swarf_status swarf_stock_leaves(const swarf_stock *stock, swarf_leaf **out, size_t *count);

/** Generation in which anything in a cube of 32^3 voxels, (x * 4 + y) * 4 + z of a node, last changed. A boolean may
 *  put another layout in place and stamps all of it. */
uint32_t swarf_stock_stamp(const swarf_stock *stock, size_t node, unsigned cube);

/** Value at a voxel of the layout, in mm; outside the layout +background. */
float swarf_stock_value(const swarf_stock *stock, const int32_t ijk[3]);

#ifdef __cplusplus
}
#endif
#endif
