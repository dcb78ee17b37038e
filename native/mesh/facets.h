/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Triangles on their way from the contour to a mesh: corners, true normal, error. */
#ifndef SWARF_MESH_FACETS_H
#define SWARF_MESH_FACETS_H

#include "mesh/mesh.h"

typedef struct swarf_facet {
    uint32_t v[3];
    float error_mm;    /* bound of the distance to the first triangles here */
    float lost_mm3;    /* volume between it and the surface that it stands for, outside of it */
    int16_t normal[3]; /* of the surface where the facet was made, * 32767 */
    int8_t beyond;     /* 1: of the next band (see contour.h) */
    int8_t before;     /* 1: of the layer that was beyond in the band before */
} swarf_facet;

/** Vertices and facets of one surface. */
typedef struct swarf_facets {
    float *xyz;
    size_t vertex_count;
    swarf_facet *facet;
    size_t facet_count;
    size_t vertex_room, facet_room; /* what there is memory for; 0: just for these */
} swarf_facets;

void swarf_facets_free(swarf_facets *facets);

/** Put more facets, and their vertices, behind these, which they share vertices with that lie at the same places. */
swarf_status swarf_facets_append(swarf_facets *facets, const swarf_facets *more);

/** Drop vertices that no facet uses; `marks` (NULL: none) go with the others. */
swarf_status swarf_facets_compact(swarf_facets *facets, uint8_t *marks);

/** Marks of vertices: stays; is as it was when the memo was made. Facets whose corners are all known were there then,
 *  in the same order; others may have been there beside them. */
enum { SWARF_VERTEX_LOCKED = 1, SWARF_VERTEX_KNOWN = 2 };

/** What simplifying came to cube by cube, so that only cubes with other facets than before are simplified again. Starts
 *  as zeros. */
typedef struct swarf_facets_memo {
    struct pass_memo *pass;
    double least[3], most[3]; /* of the vertices */
    int same;                 /* vertices marked as known are; set by the caller */
} swarf_facets_memo;

void swarf_facets_memo_free(swarf_facets_memo *memo);

/** Remove vertices while the surface stays within error_mm of what came in, keeping edges sharper than 25 degrees,
 *  corners and topology; stops at `budget` facets (0: none). `marks` of vertices may be NULL: none; they go with the
 *  vertices, known ones lose that mark where what became of them may differ. `memo` may be NULL too, and is not used
 *  with a budget. The error of what is left, and the volume lost, are in the facets. */
swarf_status swarf_facets_simplify(swarf_facets *facets, double error_mm, double voxel, size_t budget, uint8_t *marks,
                                   swarf_facets_memo *memo, const swarf_progress *progress, double from, double to);

/** Shift vertices by `most_mm` at most, along their faces' normals and so that edges stay on them, until the surface
 *  has within it what its facets had lost; what those that lost less than `flat_mm` all over cannot bring is not asked
 *  of them. Vertices with *marks SWARF_VERTEX_LOCKED (NULL: none) stay; so do those whose facets would turn. The shifts
 *  are added to the facets' errors. */
swarf_status swarf_facets_regain(swarf_facets *facets, const uint8_t *marks, double most_mm, double flat_mm);

#endif
