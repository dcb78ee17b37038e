/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The block a stock was made from, as a formula: its faces need no leaves until they are read or cut. */
#ifndef SWARF_STOCK_BLOCK_H
#define SWARF_STOCK_BLOCK_H

#include "stock/stock.h"

/** 1 when the band of the block's faces reaches into the leaf whose low corner is at `corner`. */
int swarf_block_reaches(const swarf_stock *stock, const int32_t corner[3]);

/** A leaf of the block: signed distances in mm, clamped to the background; their active mask and least value. */
void swarf_block_fill(const swarf_stock *stock, const int32_t corner[3], float values[SWARF_LEAF_SIZE],
                      uint64_t mask[8], float *least);

/** Set the tiles of a fresh tree: inside where the block or its band is. */
swarf_status swarf_block_occupy(swarf_stock *stock);

/** Make the leaves of all faces that have none yet; afterwards stock->untouched is 0. */
swarf_status swarf_block_finish(swarf_stock *stock);

#endif
