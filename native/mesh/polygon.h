/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Triangles of plane regions between closed rings. */
#ifndef SWARF_MESH_POLYGON_H
#define SWARF_MESH_POLYGON_H

#include "swarf/base.h"

/** Cut a region into triangles whose corners are its own: rings of points (2 doubles each), one after the other, ring r
 *  ending before ends[r]; the region on the left of each, so that outlines go counter-clockwise and holes clockwise.
 *  Rings may touch themselves and each other. *index (3 per triangle, counter-clockwise, freed by the caller with
 *  free()) uses each edge of the rings once and each other edge twice, whatever the rings are like. */
swarf_status swarf_polygon_triangulate(const double *points, const size_t *ends, size_t rings, uint32_t **index,
                                       size_t *triangles);

#endif
