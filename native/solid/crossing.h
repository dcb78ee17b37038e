/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Which triangles of a solid cross or touch others with which they have no edge in common. */
#ifndef SWARF_SOLID_CROSSING_H
#define SWARF_SOLID_CROSSING_H

#include "solid/solid.h"

/** Triangles closer than this many times the tree's slack touch: corners in one plane, rounded to float, are off it by
 *  up to a quarter of that. */
#define SOLID_GAP 1.0

/** The triangle at place i meets other[first[i]] .. other[first[i + 1] - 1]. */
typedef struct swarf_crossings {
    size_t *first; /* NULL: none meets another */
    uint32_t *other;
    size_t count; /* of triangles that meet others */
} swarf_crossings;

/** By the solid's tree of all triangles, in an order that does not depend on threads. */
swarf_status swarf_crossings_find(const swarf_solid *solid, const swarf_progress *progress, double from, double to,
                                  swarf_crossings *out);
void swarf_crossings_free(swarf_crossings *crossings);

#endif
