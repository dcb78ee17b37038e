/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Field: the signed distance to a solid at the voxels of a grid, in blocks, only as far as it is asked for. */
#ifndef SWARF_SOLID_FIELD_H
#define SWARF_SOLID_FIELD_H

#include "swarf/solid.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { FIELD_LEAF = 8, FIELD_LEAF_SIZE = FIELD_LEAF * FIELD_LEAF * FIELD_LEAF };

/** Whether a cube of voxels, its low corner at `corner`, is to be seen at all. */
typedef int (*swarf_wanted_fn)(void *context, const int32_t corner[3], int edge);

typedef struct swarf_field {
    const swarf_solid *solid;
    double origin[3];       /**< centre of voxel (0, 0, 0), mm */
    double voxel;           /**< mm */
    double reach;           /**< mm: values farther from the surface are +-reach; at least one voxel */
    swarf_wanted_fn wanted; /**< asked before a cube is looked at, with the context of the walk; NULL: all are */
} swarf_field;

/** A cube of voxels with its low corner at `corner`. `values` (NULL where the surface is nowhere within reach) are
 *  those of a leaf, edge 8, in mm, x * 64 + y * 8 + z; else the whole cube is `inside` or not. */
typedef swarf_status (*swarf_field_fn)(void *context, const int32_t corner[3], int edge, const float *values,
                                       int inside);

/** Call `see` for cubes that fill one of `edge` voxels (8 times a power of 2), in a fixed order. Any thread. */
swarf_status swarf_field_walk(const swarf_field *field, const int32_t corner[3], int edge, swarf_field_fn see,
                              void *context);

#ifdef __cplusplus
}
#endif
#endif
