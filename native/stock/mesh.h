/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stocks from solids, for callers that have one. */
#ifndef SWARF_STOCK_MESH_H
#define SWARF_STOCK_MESH_H

#include "swarf/solid.h"
#include "swarf/stock.h"

/** The inside of a solid. `from`..`to` is this call's part of the progress. */
swarf_status swarf_stock_create_solid(const swarf_solid *solid, const swarf_stock_options *options,
                                      const swarf_progress *progress, double from, double to, swarf_stock **out);

#endif
