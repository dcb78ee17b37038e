/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cutting with a prepared body, for callers that are already inside the stock. */
#ifndef SWARF_STOCK_CUT_H
#define SWARF_STOCK_CUT_H

#include "stock/stock.h"
#include "sweep/body.h"

/** Cut all paths at once with a body prepared at the stock's voxel size; the stock has been entered for writing.
 *  Progress runs from `from` to `to`. */
swarf_status swarf_cut_body(swarf_stock *stock, const swarf_body *body, const swarf_path *paths, size_t count,
                            const swarf_progress *progress, double from, double to);

#endif
