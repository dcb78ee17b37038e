/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Compare: the stock against the design model. */
#ifndef SWARF_COMPARE_H
#define SWARF_COMPARE_H

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

/** Compare by volume: the design (closed triangles) is sampled on the stock's own voxels and both differences are
 *  integrated. The stock is unchanged. SWARF_ERROR_GEOMETRY as for swarf_stock_create_mesh(). */
SWARF_API swarf_status swarf_compare_volume(swarf_stock *stock, const swarf_triangles *design,
                                            const swarf_progress *progress, swarf_comparison *out);

#ifdef __cplusplus
}
#endif
#endif
