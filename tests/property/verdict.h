/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What CGAL (Polygon Mesh Processing, exact predicates) says of a mesh: nothing of ours decides. */
#ifndef SWARF_TEST_VERDICT_H
#define SWARF_TEST_VERDICT_H

#include "swarf/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct verdict {
    int manifold;          /* every edge has two triangles that run along it in opposite ways, every vertex one fan */
    int closed;            /* no border */
    int outward;           /* normals point out of the material */
    int bounds_a_volume;   /* shells lie in each other with turns of orientation; only where nothing cuts itself */
    size_t cuts;           /* pairs of triangles that meet elsewhere than where they are neighbours */
    size_t flat_triangles; /* without area */
    double volume_mm3;
} verdict;

/** 0 when there was no memory for it. */
int verdict_of(const swarf_triangles *mesh, verdict *out);

#ifdef __cplusplus
}
#endif
#endif
