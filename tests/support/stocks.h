/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Blocks, as they are and cut at random. */
#ifndef SWARF_TEST_STOCKS_H
#define SWARF_TEST_STOCKS_H

#include "test.h"

/** A block; owned by the caller. Exits when it cannot be made. */
swarf_stock *stock_block(const swarf_box *box, double voxel);

/** Its volume, mm3; NAN where that fails. */
double stock_volume(swarf_stock *stock);
/** Its hash. */
uint64_t stock_hash(swarf_stock *stock);

/** A straight move of one cutter through a block. */
typedef struct stock_cut {
    const char *cutter; /* as swarf_cutter_parse() reads it */
    swarf_path path;
} stock_cut;
enum { STOCK_CUTS = 48 };

/** The block and the cuts of stock_random() in the same state; how many. */
int stock_random_cuts(test_random *random, double length, swarf_box *box, stock_cut out[STOCK_CUTS]);

/** A block of `length` x 6 x 5 mm after some straight moves of four small cutters, and its exact surface; both owned by
 * the caller. */
swarf_stock *stock_random(test_random *random, double voxel, double length, swarf_surface **surface);

#endif
