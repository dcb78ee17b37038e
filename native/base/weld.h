/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Welding: equal positions become one vertex. */
#ifndef SWARF_BASE_WELD_H
#define SWARF_BASE_WELD_H

#include "swarf/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Keep the first of every set of bit-equal positions (-0 counts as 0), in order, moved to the front of `xyz`
 *  (3 * count floats); map[i] is the new number of vertex i. SWARF_ERROR_ARGUMENT above 2^32 - 2 vertices. */
swarf_status swarf_weld(float *xyz, size_t count, uint32_t *map, size_t *unique);

#ifdef __cplusplus
}
#endif
#endif
