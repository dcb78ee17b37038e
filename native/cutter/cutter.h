/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Inside of a cutter: its parts, and the arcs of a meridian in centre form. */
#ifndef SWARF_CUTTER_CUTTER_H
#define SWARF_CUTTER_CUTTER_H

#include "swarf/cutter.h"

/** Nothing that turns in a spindle is larger (mm); beyond it floats of voxels would lose the band without a word. */
#define SWARF_CUTTER_LIMIT_MM 1e4

struct swarf_cutter {
    int references; /* only by atomic operations */
    size_t part_count;
    swarf_cutter_part *parts; /* the nodes of each part in one block of their own, axis to axis */
};

/** Piece of a meridian between two nodes. For an arc `radius` > 0, `convex` tells on which side the material lies,
 *  and the outward normals at its ends are (point - centre) / radius, reversed when it is not convex. */
typedef struct swarf_profile_piece {
    double r0, z0, r1, z1;
    double centre_r, centre_z, radius; /* radius 0: a line */
    int convex;
} swarf_profile_piece;

/** Piece from `node` to `next`; degenerate ones (both nodes equal) have r0 == r1 and z0 == z1. */
swarf_profile_piece swarf_profile_piece_get(const swarf_profile_node *node, const swarf_profile_node *next);

#endif
