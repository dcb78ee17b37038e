/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stocks that random programs have cut. */
#ifndef SWARF_TEST_RANDOM_STOCK_H
#define SWARF_TEST_RANDOM_STOCK_H

#include "test.h"

/** A block of `length` x 6 x 5 mm after some straight moves of four small cutters, and its exact surface; both owned by
 * the caller. NULL when it could not be made. */
swarf_stock *random_stock(test_random *random, double voxel, double length, swarf_surface **surface);

#endif
