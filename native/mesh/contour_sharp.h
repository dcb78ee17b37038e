/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Crossings of the field beside edges of the surface. */
#ifndef SWARF_MESH_CONTOUR_SHARP_H
#define SWARF_MESH_CONTOUR_SHARP_H

#include "mesh/contour.h"
#include "stock/gradient.h"

/** Voxels along an edge of what is looked at about a block, the ends of its edges and those beside them; of what is
 *  read, and what of that is below the block. */
enum {
    SWARF_SHARP_SPAN = SWARF_LEAF_DIM + 2,
    SWARF_WIDE_HALO = SWARF_SHARP_SPAN + 2 * SWARF_GRADIENT_HALO,
    SWARF_WIDE_BELOW = 1 + SWARF_GRADIENT_HALO
};

/** What a voxel tells of the face that it sees. */
typedef struct contour_sight {
    float gradient[3];
    float bend; /* of the face, in voxels; INFINITY: it sees none, or more than one */
} contour_sight;

/** What was looked at about a block. */
typedef struct contour_sharp {
    float limit, voxel;                                                /* mm */
    float values[SWARF_WIDE_HALO * SWARF_WIDE_HALO * SWARF_WIDE_HALO]; /* mm */
    uint8_t looked[SWARF_SHARP_SPAN * SWARF_SHARP_SPAN * SWARF_SHARP_SPAN];
    contour_sight sight[SWARF_SHARP_SPAN * SWARF_SHARP_SPAN * SWARF_SHARP_SPAN];
} contour_sharp;

/** Values of a block's voxels with those about it. */
void swarf_contour_fetch_wide(const contour *work, const int32_t ijk[3], float *values);

void swarf_contour_sharp_begin(contour_sharp *sharp, const contour *work, const contour_block *block);
/** A crossing by the faces that the voxels on either side of it see, where these are the distances from faces; else it
 *  stays as it is. at[]: the edge's voxel in the block. */
void swarf_contour_cross_sharp(contour_sharp *sharp, const int at[3], int axis, contour_crossing *crossing);

#endif
