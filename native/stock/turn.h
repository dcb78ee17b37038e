/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A stock turned by quarters and moved by any shift: the same voxels in other places, bit for bit. */
#ifndef SWARF_STOCK_TURN_H
#define SWARF_STOCK_TURN_H

#include "swarf/placement.h"
#include "swarf/stock.h"

/** A copy of `stock` whose lattice of voxels moves with it. The placement must turn by quarters only. `memory_limit`:
 *  as in swarf_stock_options, of the copy. */
swarf_status swarf_stock_turn(swarf_stock *stock, const swarf_placement *placement, size_t memory_limit,
                              const swarf_progress *progress, swarf_stock **out);

#endif
