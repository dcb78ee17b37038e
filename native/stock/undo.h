/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Undo: what the slots of a tree held before cuts changed them, a stack of layers.
 *
 *   layer     one batch of a cut: its columns of 4x4 slots that changed anything, by ascending number
 *   column    entries, one after the other: a head, then 8 floats for each row that it stores
 *   entry     a slot that was an inside tile (nothing stored); rows of a leaf that is still there; or a whole leaf that
 *             is gone. Rows are 8 voxels along z. One that repeats the row before it is told by a bit only.
 *
 * While a batch is cut every column belongs to one thread, and so does its list of entries: no locks. Restoring works
 * column by column too. The faces of the block must have leaves (swarf_block_finish()) before anything is kept: what is
 * no leaf then is a tile, inside if a cut can change it. */
#ifndef SWARF_STOCK_UNDO_H
#define SWARF_STOCK_UNDO_H

#include "stock/stock.h"

typedef struct swarf_undo_column {
    int32_t number; /* (x * columns along y + y) in columns of the layout */
    unsigned char *bytes;
    size_t size, room;
    size_t slots; /* entries, once it is finished */
} swarf_undo_column;

typedef struct swarf_undo_layer {
    size_t first; /* the position that the stock returns to: the caller's own numbers */
    swarf_undo_column *columns;
    size_t count;
    size_t slots; /* entries in all columns */
    size_t bytes; /* of memory */
} swarf_undo_layer;

typedef struct swarf_undo {
    swarf_undo_layer *layers;
    size_t count, room;
    size_t first;   /* given to layers that are pushed */
    size_t bytes;   /* of memory in all layers that are closed */
    int32_t *index; /* while a layer is open, per column of the layout: its place in the layer */
} swarf_undo;

void swarf_undo_free(swarf_undo *undo);

/** Open a layer on top for a batch that may change these columns (ascending). */
swarf_status swarf_undo_open(swarf_undo *undo, const swarf_tree_layout *layout, const int32_t *numbers, size_t count);
/** Keep what a slot of the open layer holds before it changes: `before` its leaf (NULL: an inside tile), `after` the
 *  values it is going to have or already has (NULL: the leaf goes). One thread per column. */
swarf_status swarf_undo_keep(swarf_undo *undo, int32_t column, size_t node, unsigned slot, const float *before,
                             const float *after);
/** Nothing more is to be kept in a column of the open layer: its list need not grow any more. One thread per column. */
void swarf_undo_finish(swarf_undo *undo, int32_t column);
/** Close the layer, however much of it was cut. */
void swarf_undo_close(swarf_undo *undo);

/** Put back what the topmost layer kept and drop it. The stock has been entered. When memory runs out the layer stays
 *  and the stock stands between two positions. */
swarf_status swarf_undo_pop(swarf_undo *undo, swarf_stock *stock);

/** Make one layer of the layers `at` and `at` + 1, as if one batch had cut both. On failure they stay two. */
swarf_status swarf_undo_merge(swarf_undo *undo, const swarf_tree_layout *layout, size_t at);
/** Forget the lowest `count` layers. */
void swarf_undo_forget(swarf_undo *undo, size_t count);

/** Give a stock the content of another one of the same layout, changing and stamping only what differs. With `undo`
 *  what was there is kept in a layer on top, for which the stock must be one that cutting leads from to `other`. When
 *  it fails the stock stands in between. */
swarf_status swarf_undo_match(swarf_undo *undo, swarf_stock *stock, const swarf_stock *other);

#endif
