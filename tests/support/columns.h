/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Volumes of milled blocks by columns along z, in closed form each, independently of voxels and distances. */
#ifndef SWARF_TEST_COLUMNS_H
#define SWARF_TEST_COLUMNS_H

#include "test.h"

typedef struct columns_cutter {
    double radius, length; /* mm; what is above the length cuts nothing */
    int ball;              /* 1: of the same radius; 0: a flat end */
} columns_cutter;

/** What straight moves leave of a block, mm3: the mean over some 830 000 columns on a Fibonacci lattice. Exits without
 *  memory. */
double columns_left(const swarf_box *block, const columns_cutter *cutter, const swarf_path *paths, size_t count);

#endif
