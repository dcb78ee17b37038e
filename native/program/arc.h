/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Arc: checking and fitting one arc, without a program around it. */
#ifndef SWARF_PROGRAM_ARC_H
#define SWARF_PROGRAM_ARC_H

#include "swarf/program.h"

/** Coordinates beyond this are taken for mistakes: a kilometre is no machine, and doubles keep 1e-10 mm up to here. */
#define SWARF_COORDINATE_LIMIT_MM 1e6

/** Most passes of one helix; each costs the sweeps some hundred chords. */
#define SWARF_ARC_TURNS_MAX 10000

/** Indices (0 x, 1 y, 2 z) of a plane's first and second axis and of its normal, right-handed in this order. */
static inline void swarf_plane_axes(swarf_plane plane, int *first, int *second, int *normal)
{
    *normal = plane == SWARF_PLANE_XY ? 2 : plane == SWARF_PLANE_ZX ? 1 : 0;
    *first = (*normal + 1) % 3;
    *second = (*normal + 2) % 3;
}

/** How far the radii at both ends of an arc may differ, mm. */
double swarf_arc_tolerance(double radius);

/** Check an arc and make its table entry; swarf_program_add_arc() tells the rules. The radii may differ by
 *  `tolerance_mm`, 0: by swarf_arc_tolerance(). The text of a failure (SWARF_ERROR_ARGUMENT) names no line. */
swarf_status swarf_arc_make(const double start[3], const double end[3], const double centre[3], swarf_plane plane,
                            int ccw, int turns, double tolerance_mm, swarf_arc *out);

#endif
