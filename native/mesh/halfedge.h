/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Half-edges of triangles: half-edge 3 * t + k goes from corner k of triangle t to corner k + 1. */
#ifndef SWARF_MESH_HALFEDGE_H
#define SWARF_MESH_HALFEDGE_H

#include "swarf/base.h"

/** No half-edge on the other side: the surface is open there. */
#define SWARF_NO_HALFEDGE UINT32_MAX

/** The half-edge on the other side of each, 3 per triangle; at edges of more than two triangles they are paired in the
 *  order of the triangles, each with one of the other direction. Triangles with a repeated vertex have none.
 *  SWARF_ERROR_ARGUMENT above 2^32 / 3 triangles. Freed by the caller with free(). */
swarf_status swarf_halfedges_create(const swarf_triangles *triangles, uint32_t **opposite);

/** Number the pieces that hang together by edges, in the order of their first triangles; piece_of has a number per
 *  triangle. */
swarf_status swarf_halfedges_pieces(const uint32_t *opposite, size_t triangle_count, uint32_t *piece_of, size_t *count);

#endif
