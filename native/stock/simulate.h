/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Simulating with someone who looks on and cuts himself: the checks. */
#ifndef SWARF_STOCK_SIMULATE_H
#define SWARF_STOCK_SIMULATE_H

#include "stock/stock.h"

/** Called for each batch instead of cutting it. */
typedef struct swarf_watch {
    /** Moves first .. end - 1 share a tool and an operation; those with turned axes cut nothing. They are this part of
     *  the progress. *stop: play no further. */
    swarf_status (*play)(void *context, size_t first, size_t end, double from, double to, int *stop);
    void *context;
} swarf_watch;

/** swarf_stock_simulate() of a stock that has been entered for writing; `watch` may be NULL. The arguments have been
 *  looked at. */
swarf_status swarf_simulate_watched(swarf_stock *stock, const swarf_program *program, size_t first, size_t count,
                                    const swarf_tool *tools, size_t tool_count, const swarf_simulation_options *options,
                                    const swarf_progress *progress, const swarf_watch *watch, swarf_simulation **out);

#endif
