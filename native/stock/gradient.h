/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The gradient of a distance field at a voxel by the differences that bend least (Harten, Engquist, Osher,
 * Chakravarthy 1987), so that they do not reach over an edge of the surface. */
#ifndef SWARF_STOCK_GRADIENT_H
#define SWARF_STOCK_GRADIENT_H

#include <math.h>

/** Voxels that are read on either side. */
enum { SWARF_GRADIENT_HALO = 2 };

/** In voxels: second differences of less are those of a plane. */
static const float swarf_flat_bend = 0.005f;
/** In voxels: second differences from which on the field is taken to have an edge; less than that of a ball of ten
 *  voxels, where the planes beside each corner are off by a fortieth. */
static const float swarf_edge_bend = 0.1f;
/** In voxels: faces bend less, those of a ball of four voxels. */
static const float swarf_face_bend = 0.26f;
/** A distance has a gradient of length 1; where its square is farther from that its differences reach over an edge. */
static const float swarf_gradient_slack = 0.1f;

/** A second difference one voxel on, whose last value may not be known: then it is not held against the others. */
static inline float swarf_bend_beyond(float near, float middle, float far, float limit, float unit)
{
    return fabsf(far) < limit || !(fabsf(middle) < limit) ? near - 2 * middle + far : 0.5f * swarf_flat_bend * unit;
}

/** The slope at a voxel along one axis, in what its values are in per voxel; what its differences bend, when that is
 *  more, to *bend. `limit`: values from which on nothing is known but the sign; `unit`: a voxel. Any thread. */
static inline float swarf_field_slope(const float *at, int step, float limit, float unit, float *bend)
{
    const float ahead = at[step] - at[0], back = at[0] - at[-step], middle = ahead - back,
                flat = swarf_flat_bend * unit;
    if (fabsf(middle) > flat) {
        const float first = swarf_bend_beyond(at[0], at[step], at[2 * step], limit, unit),
                    last = swarf_bend_beyond(at[0], at[-step], at[-2 * step], limit, unit);
        if (fabsf(middle) > 2 * fminf(fabsf(first), fabsf(last)) + flat) {
            const int forward = fabsf(first) < fabsf(last);
            *bend = fmaxf(*bend, fabsf(forward ? first : last));
            return forward ? ahead - 0.5f * first : back + 0.5f * last;
        }
    }
    *bend = fmaxf(*bend, fabsf(middle));
    return 0.5f * (ahead + back);
}

#endif
