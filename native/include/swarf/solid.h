/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Solid: what closed triangles enclose, with exact signed distances to it.
 *
 * The distance is to the closest point of the triangles, in double. Its sign is that of the angle-weighted normal at
 * that point (J. A. Baerentzen and H. Aanaes, "Signed distance computation using the angle weighted pseudonormal",
 * 2005); where this is not clear - edges of more than two triangles, folded or degenerate ones, holes, edges and
 * corners where shells cross or touch - the winding number decides: inside is where it is 1 or more.
 *
 * Shells may overlap, touch, lie flush or inside each other: the solid is their union. Triangles inside it bound
 * nothing and are not measured; those that cross or touch others are cut along them, and only the pieces that bound the
 * union remain. Gaps narrower than 5e-7 of the coordinates count as closed.
 *
 * Immutable, shared by reference count; any thread.
 */
#ifndef SWARF_SOLID_H
#define SWARF_SOLID_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_solid swarf_solid;

/** What a solid was made of. */
typedef struct swarf_solid_facts {
    double volume_mm3; /**< of the union; of triangles with holes their signed sum */
    double area_mm2;   /**< of what bounds it */
    swarf_box box;
    size_t triangle_count;     /**< that bound it, all over or in part */
    size_t dropped_triangles;  /**< degenerate, duplicates, opposite pairs, or inside the solid */
    size_t open_edges;         /**< used by an odd number of triangles */
    size_t turned_edges;       /**< between triangles turned different ways */
    double hole_mm2;           /**< the holes at these edges have no greater area */
    size_t crossing_triangles; /**< that cross or touch others without a common edge */
} swarf_solid_facts;

/** A solid from triangles (copied, welded by equal positions). Holes pass as long as their edges cannot bound more than
 *  a hundredth of the area; swarf_solid_get_facts() tells of them. SWARF_ERROR_GEOMETRY: no triangles, open beyond
 *  that, inside out, no volume, a cavity in no solid, a triangle that others cut into more than a million pieces.
 *  SWARF_ERROR_ARGUMENT: NULL, an index out of range, a coordinate that is not finite. The caller owns one reference.
 */
SWARF_API swarf_status swarf_solid_create(const swarf_triangles *triangles, const swarf_progress *progress,
                                          swarf_solid **out);
SWARF_API swarf_solid *swarf_solid_retain(swarf_solid *solid);
/** Give one reference back; NULL is legal. */
SWARF_API void swarf_solid_release(swarf_solid *solid);
SWARF_API swarf_solid_facts swarf_solid_get_facts(const swarf_solid *solid);

/** Signed distances (mm, negative inside) of `count` points (3 doubles each), and the number of the triangle each is
 *  closest to, as in the triangles given (may be NULL). SWARF_ERROR_ARGUMENT: NULL, not finite. */
SWARF_API swarf_status swarf_solid_distance(const swarf_solid *solid, const double *points, size_t count,
                                            const swarf_progress *progress, double *distance, uint32_t *triangle);

#ifdef __cplusplus
}
#endif
#endif
