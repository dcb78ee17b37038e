/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Lumps: what of a stock hangs together, by voxels with a common face. */
#ifndef SWARF_LUMPS_H
#define SWARF_LUMPS_H

#include "stock.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_lump {
    size_t voxels;
    double volume_mm3; /**< of its voxels */
    double inside[3];  /**< centre of one of its voxels, mm */
    swarf_box box;     /**< of its voxels */
} swarf_lump;

/** The lumps of a stock. Owned by the caller; immutable. */
typedef struct swarf_lumps swarf_lumps;

/** Find them; `lump_of` gets the lump that holds the voxel nearest to each of `point_count` points (3 doubles each),
 *  UINT32_MAX in the air. */
SWARF_API swarf_status swarf_lumps_create(swarf_stock *stock, const double *points, size_t point_count,
                                          const swarf_progress *progress, uint32_t *lump_of, swarf_lumps **out);
/** NULL is legal. */
SWARF_API void swarf_lumps_destroy(swarf_lumps *lumps);
/** The largest first. */
SWARF_API const swarf_lump *swarf_lumps_get(const swarf_lumps *lumps, size_t *count);

#ifdef __cplusplus
}
#endif
#endif
