/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A stock in its next set-up: turned, moved, with other voxels. One thread per stock at a time. */
#ifndef SWARF_PLACE_H
#define SWARF_PLACE_H

#include "surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/** How a stock goes into its next set-up. */
typedef struct swarf_place_options {
    size_t size;                  /**< sizeof(swarf_place_options) */
    const swarf_surface *surface; /**< of the stock, borrowed for the call; NULL: the field alone */
    size_t moves;                 /**< the stock is the surface after its first so many moves */
    double voxel_mm;              /**< of the new stock; 0: that of `stock` */
    size_t memory_limit;          /**< as in swarf_stock_options */
} swarf_place_options;

/** No surface, the same voxel, no explicit memory limit. */
SWARF_API swarf_place_options swarf_place_options_default(void);

/** A stock turned and moved, as a new one; `options` NULL: the default. Quarter turns with any shift lose nothing where
 *  the voxel stays: *lossless (may be NULL) is 1, and the new voxels are the old ones.
 *
 *  With a surface the new field is the exact distance to the turned mesh of the stock, within two hundredths of a
 *  voxel, at edges too. Without one, and with voxels no larger than the old ones, it is looked for between the old
 *  voxels: faces and edges move by less than a tenth of a voxel (measured: 0.01; 0.07 when turned once more) where the
 *  faces beside them are three voxels wide; corners where a ridge meets a groove by up to 0.3, for voxels tell of each
 *  face only where it is the nearest, and what is as small as voxels by as much; what is thinner than two may part.
 *  Larger voxels without a surface go by the mesh of the field alone, whose edges it tells less of near corners.
 *  SWARF_ERROR_GEOMETRY: nothing is left of the stock. */
SWARF_API swarf_status swarf_stock_place(swarf_stock *stock, const swarf_placement *placement,
                                         const swarf_place_options *options, const swarf_progress *progress,
                                         swarf_stock **out, int *lossless);

#ifdef __cplusplus
}
#endif
#endif
