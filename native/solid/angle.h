/* SPDX-License-Identifier: LGPL-2.1-or-later */
#ifndef SWARF_SOLID_ANGLE_H
#define SWARF_SOLID_ANGLE_H

#include <math.h>

/** Signed solid angle of a triangle seen from the origin, positive from behind (A. van Oosterom and J. Strackee, 1983).
 *  Summed over a closed surface: 4 pi inside, 0 outside. */
static inline double swarf_solid_angle(const double p[3][3])
{
    double length[3];
    for (int k = 0; k < 3; k++) length[k] = sqrt(p[k][0] * p[k][0] + p[k][1] * p[k][1] + p[k][2] * p[k][2]);
    const double volume = p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
                          p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
                          p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    double below = length[0] * length[1] * length[2];
    for (int k = 0; k < 3; k++) {
        const double *u = p[k], *v = p[(k + 1) % 3];
        below += (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) * length[(k + 2) % 3];
    }
    return 2 * atan2(volume, below);
}

#endif
