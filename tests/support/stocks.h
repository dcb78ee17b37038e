/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Blocks, as they are and cut at random. */
#ifndef SWARF_TEST_STOCKS_H
#define SWARF_TEST_STOCKS_H

#include "test.h"

/** A block; owned by the caller. Exits when it cannot be made. */
swarf_stock *stock_block(const swarf_box *box, double voxel);

/** A block of `length` x 6 x 5 mm after some straight moves of four small cutters, and its exact surface; both owned by
 * the caller. */
swarf_stock *stock_random(test_random *random, double voxel, double length, swarf_surface **surface);

#endif
