/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Measuring loads while cutting, for callers that play a program. */
#ifndef SWARF_STOCK_LOAD_H
#define SWARF_STOCK_LOAD_H

#include "stock/stock.h"
#include "swarf/load.h"
#include "sweep/body.h"

/** Nothing known yet of `count` moves. */
swarf_status swarf_loads_create(size_t count, swarf_loads **out);
void swarf_loads_destroy(swarf_loads *loads);

/** What the moves of a batch have in common. */
typedef struct swarf_load_batch {
    const swarf_program *program;
    const swarf_cutter *cutter;
    const swarf_body *flutes; /**< of it */
    int32_t teeth;            /**< 0: not known */
    size_t origin;            /**< number of the move whose loads are the first */
} swarf_load_batch;

/** Cut the moves `numbers` (ascending, all with motion), and measure them. The stock has been entered for writing.
 *  SWARF_ERROR_CANCELLED: whole moves are cut. */
swarf_status swarf_loads_cut(swarf_loads *loads, swarf_stock *stock, const swarf_load_batch *batch,
                             const size_t *numbers, size_t count, const swarf_progress *progress, double from,
                             double to);

#endif
