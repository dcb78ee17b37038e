/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A block of 60 x 40 x 10 mm, milled by one cutter, and compared with what it ought to be. */
#ifndef SWARF_TEST_MILLED_H
#define SWARF_TEST_MILLED_H

#include "test.h"

/** From (0, 0, -10) to (60, 40, 0). */
extern const swarf_box milled_block;

typedef struct milled {
    swarf_program *program; /* starts at (30, 20, 10) */
    swarf_cutter *cutter;
    swarf_stock *first, *stock; /* before and after milled_cut() */
    swarf_tool tool;
} milled;

/** A block that is not cut yet; to be ended by milled_end(). cutter: as swarf_cutter_parse() reads it. */
milled milled_begin(const char *cutter, double voxel);

/** Add a straight move. number: of the line it comes from. */
void milled_line(milled *j, swarf_move_kind kind, double x, double y, double z, uint32_t number);

/** Add a pocket of 20 x 10 about the middle, by passes of a cutter of 4 mm; its corners are left round. Lines 1 to 9.
 */
void milled_pocket(milled *j, double depth);

/** Cut the program. */
void milled_cut(milled *j);

/** The deviation from a design; to be destroyed by the caller. */
swarf_deviation *milled_deviation(milled *j, const swarf_solid *design, double tolerance);

/** Release it all. */
void milled_end(milled *j);

#endif
