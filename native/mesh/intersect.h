/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Finding triangles of a surface that cut or touch each other where they share neither edge nor corner. */
#ifndef SWARF_MESH_INTERSECT_H
#define SWARF_MESH_INTERSECT_H

#include "mesh/facets.h"

/** Round positions to the grid of floats of the greatest coordinate, so that differences are whole numbers of 25 bits
 *  and every decision below is exact. */
void swarf_facets_snap(swarf_facets *facets);

typedef struct swarf_facet_pair {
    uint32_t a, b;
} swarf_facet_pair;

/** All pairs, in an order that only depends on the facets; decided exactly. The facets must be
 *  snapped. *pairs is freed by the caller with free(). */
swarf_status swarf_facets_intersect(const swarf_facets *facets, const swarf_progress *progress, double from, double to,
                                    swarf_facet_pair **pairs, size_t *count);

#endif
