/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Exact decisions about triangles whose corners are whole numbers below 2^25 in magnitude. */
#ifndef SWARF_MESH_PREDICATE_H
#define SWARF_MESH_PREDICATE_H

#include <stdint.h>

/** Whether two triangles (three corners each, `a` and `b` their vertex numbers) have a point in common besides the
 *  vertices and the edge they share. Triangles without area have none. */
int swarf_triangles_meet(const int32_t pa[3][3], const uint32_t a[3], const int32_t pb[3][3], const uint32_t b[3]);

/** Whether the corners do not lie on one line. */
int swarf_triangle_has_area(const int32_t p[3][3]);

#endif
