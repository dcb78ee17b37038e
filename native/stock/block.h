/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The block a stock was made from, as a formula: its faces need no leaves until they are read or cut. */
#ifndef SWARF_STOCK_BLOCK_H
#define SWARF_STOCK_BLOCK_H

#include "stock/stock.h"

/** 1 when the band of the block's faces reaches into the leaf whose low corner is at `corner`. */
int swarf_block_reaches(const swarf_stock *stock, const int32_t corner[3]);

/** Signed distances to the block in mm, clamped to the background, at the 512 voxels of a leaf. */
void swarf_block_fill(const swarf_stock *stock, const int32_t corner[3], float values[SWARF_LEAF_SIZE]);

/** Set the tiles of a fresh tree: inside where the block or its band is. */
swarf_status swarf_block_occupy(swarf_stock *stock);

/** Make the leaves of all faces that have none yet; afterwards stock->untouched is 0. */
swarf_status swarf_block_finish(swarf_stock *stock);

#endif
