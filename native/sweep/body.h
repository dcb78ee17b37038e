/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Body: the parts of one kind of a cutter, prepared for sweeping, in voxels.
 *
 * A body is a union of convex components; each is the intersection of all half planes that touch its meridian:
 *     phi(rho, z) = max over pieces of ( n . ((rho, z) - c) - r )
 * where a line has one normal n, and an arc the normal of its cone that is nearest to the direction from its centre.
 * phi is convex, below 0 inside, and the Euclidean distance next to smooth boundary; beyond edges it goes on straight.
 * Components overlap, so that no inner border between two of them comes near the outside.
 */
#ifndef SWARF_SWEEP_BODY_H
#define SWARF_SWEEP_BODY_H

#include "swarf/cutter.h"

/** Half width of the narrow band in voxels: within it distances must be right, beyond it only large. */
#define SWARF_HALF_WIDTH 3.0f

/** Half planes of one line or arc. Lines: centre (0, 0), radius = offset, first == last normal. Pieces whose normals
 *  point downwards (or sideways) come from the lower border of the body, the others from the upper one. */
typedef struct swarf_piece {
    float centre_r, centre_z, radius;
    float first_r, first_z; /* normal of the lowest point */
    float last_r, last_z;   /* normal of the highest point */
    int is_arc;
    int upper;
} swarf_piece;

/** The same in mm and double, for the exact surface. */
typedef struct swarf_exact_piece {
    double centre_r, centre_z, radius;
    double first_r, first_z, last_r, last_z;
    int is_arc;
    int upper;
} swarf_exact_piece;

typedef struct swarf_component {
    size_t first, count; /* into the body's pieces */
} swarf_component;

/** Bodies with kernels of their own, and all others. */
typedef enum swarf_body_kind { SWARF_BODY_CYLINDER, SWARF_BODY_BALL, SWARF_BODY_GENERAL } swarf_body_kind;

typedef struct swarf_body {
    swarf_body_kind kind;
    float radius, z_lo, z_hi;            /* enclosing cylinder */
    float core_radius, core_lo, core_hi; /* a large cylinder inside */
    size_t piece_count, component_count;
    swarf_piece *pieces;
    swarf_exact_piece *exact;                /* as many */
    double exact_radius, exact_lo, exact_hi; /* enclosing cylinder, mm */
    swarf_component *components;
} swarf_body;

/** Prepare the parts of `kind` at a voxel size. A cutter without such parts gives radius 0 and no components. */
swarf_status swarf_body_create(const swarf_cutter *cutter, swarf_part_kind kind, double voxel, swarf_body **out);
void swarf_body_destroy(swarf_body *body);

#endif
