/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Memory the system has left, and arrays that grow. */
#ifndef SWARF_BASE_MEMORY_H
#define SWARF_BASE_MEMORY_H

#include "swarf/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Bytes that can be had without swapping (or under the control group's limit), SIZE_MAX where unknown. */
size_t swarf_memory_free(void);

/** Bytes that may be used when `asked` are allowed, 0: 80 % of what is free now (INFINITY where unknown). */
double swarf_memory_limit(size_t asked);

/** Make *array (elements of `element` bytes, room for *room) hold `needed` elements, at least doubling.
 *  On failure the array is unchanged. */
swarf_status swarf_array_reserve(void **array, size_t *room, size_t needed, size_t element);

#ifdef __cplusplus
}
#endif
#endif
