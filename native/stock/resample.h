/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A stock turned and moved in any way, voxels anew from the old ones. */
#ifndef SWARF_STOCK_RESAMPLE_H
#define SWARF_STOCK_RESAMPLE_H

#include "swarf/placement.h"
#include "swarf/stock.h"

/** A turned and moved copy of `stock` with voxels no larger than its own (`options`: their size, the memory limit).
 *  SWARF_ERROR_GEOMETRY: nothing is left of the stock; SWARF_ERROR_MEMORY. */
swarf_status swarf_stock_resample(swarf_stock *stock, const swarf_placement *placement,
                                  const swarf_stock_options *options, const swarf_progress *progress,
                                  swarf_stock **out);

#endif
