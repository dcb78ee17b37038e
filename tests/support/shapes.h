/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Closed triangle meshes with known volumes, oriented outwards; call several times to gather shells in one mesh. */
#ifndef SWARF_TEST_SHAPES_H
#define SWARF_TEST_SHAPES_H

#include "swarf/mesh.h"

typedef struct shape {
    float *xyz;
    uint32_t *index;
    size_t vertices;
    size_t triangles;
} shape;

void shape_vertex(shape *s, double x, double y, double z);
void shape_triangle(shape *s, size_t a, size_t b, size_t c);
/** Twelve triangles. */
void shape_box(shape *s, const double lo[3], const double hi[3]);
/** Inside out: as a cavity. */
void shape_flip(shape *s, size_t first_triangle);
/** Prism over a regular polygon of `sides` corners on the circle; volume sides/2 sin(2 pi/sides) r^2 h. */
void shape_cylinder(shape *s, const double base[3], double radius, double height, int sides);
/** Latitude-longitude ball; its volume is that of its triangles. */
void shape_ball(shape *s, const double centre[3], double radius, int rings);
/** Give every triangle its own three vertices. */
void shape_unshare(shape *s);
swarf_triangles shape_view(const shape *s);
void shape_free(shape *s);
/** As a mesh, owned by the caller; frees the shape. */
swarf_mesh *shape_mesh(shape *s);

#endif
