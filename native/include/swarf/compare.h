/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Compare: the stock against the design model. */
#ifndef SWARF_COMPARE_H
#define SWARF_COMPARE_H

#include "solid.h"
#include "stock.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Stock and design by volume, mm3. */
typedef struct swarf_comparison {
    double design_mm3; /**< volume of the design's triangles */
    double stock_mm3;
    double excess_mm3; /**< stock outside the design: material left */
    double gouge_mm3;  /**< design outside the stock: material missing */
} swarf_comparison;

/** Compare by volume: the design's exact distance is taken at the stock's own voxels and both differences are
 *  integrated. A voxel of both counts by how much of it each fills and by the angle between their surfaces, so that
 *  surfaces that coincide leave nothing over. The stock is unchanged. SWARF_ERROR_BUSY as all calls on a stock. */
SWARF_API swarf_status swarf_compare_volume(swarf_stock *stock, const swarf_solid *design,
                                            const swarf_progress *progress, swarf_comparison *out);

#ifdef __cplusplus
}
#endif
#endif
