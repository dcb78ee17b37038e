/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Finding triangles of a surface that cut or touch each other where they share neither edge nor corner. */
#ifndef SWARF_MESH_INTERSECT_H
#define SWARF_MESH_INTERSECT_H

#include "mesh/facets.h"

/** Steps of floats as large as `most`: positions up to it that are whole numbers of steps have differences of 25 bits,
 *  so that every decision below is exact. */
double swarf_facets_step(double most);

/** The greatest coordinate of positions, whatever its sign. */
float swarf_facets_most(const float *xyz, size_t vertex_count);

/** Round positions to the steps of their greatest coordinate, or to `least` where that is more; returns the step. */
double swarf_facets_snap(swarf_facets *facets, double least);

typedef struct swarf_facet_pair {
    uint32_t a, b;
} swarf_facet_pair;

/** All pairs, and each facet without area as a pair with itself, in an order that only depends on the facets; decided
 *  exactly. The facets must be snapped. `fresh`: of each facet, pairs with none of them are left out; NULL: all are.
 *  *pairs is freed by the caller with free(). */
swarf_status swarf_facets_intersect(const swarf_facets *facets, const uint8_t *fresh, const swarf_progress *progress,
                                    double from, double to, swarf_facet_pair **pairs, size_t *count);

#endif
