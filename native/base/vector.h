/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Three doubles as a vector. */
#ifndef SWARF_BASE_VECTOR_H
#define SWARF_BASE_VECTOR_H

#include <math.h>

static inline double vector_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vector_cross(const double a[3], const double b[3], double out[3])
{
    const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

/** Length before; 0 when it cannot be normalised. */
static inline double vector_normalise(double v[3])
{
    const double length = sqrt(vector_dot(v, v));
    if (!(length > 0) || !isfinite(length)) return 0;
    for (int axis = 0; axis < 3; axis++) v[axis] /= length;
    return length;
}

/** Turn `v` about the unit vector `axis` (Rodrigues' formula). */
static inline void vector_turn(double v[3], const double axis[3], double angle_rad)
{
    double side[3];
    vector_cross(axis, v, side);
    const double c = cos(angle_rad), s = sin(angle_rad), along = (1 - c) * vector_dot(axis, v);
    for (int i = 0; i < 3; i++) v[i] = c * v[i] + s * side[i] + along * axis[i];
}

#endif
