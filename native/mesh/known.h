/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Facets of the last attempt that do not cut each other, so that pairs of them need not be looked at again. */
#ifndef SWARF_MESH_KNOWN_H
#define SWARF_MESH_KNOWN_H

#include "mesh/intersect.h"

/** Starts as zeros: nothing is known. */
typedef struct swarf_facets_known {
    float (*corners)[9];
    size_t count;
    uint32_t *slots; /* a power of two of them, facet + 1 each, 0: empty */
    size_t slot_count;
} swarf_facets_known;

void swarf_facets_known_free(swarf_facets_known *known);

/** Know these facets, but for those of the pairs that were found, and no others. Nothing is known after a failure. */
swarf_status swarf_facets_known_take(swarf_facets_known *known, const swarf_facets *facets,
                                     const swarf_facet_pair *pairs, size_t pair_count);

/** 1 for each facet that is not known, else 0. */
swarf_status swarf_facets_known_tell(const swarf_facets_known *known, const swarf_facets *facets, uint8_t *fresh);

#endif
