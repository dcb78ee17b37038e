/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Part of the kernels (kernel_body.h): distance in the plane from voxels to the projection of a track. */
#ifndef SWARF_SWEEP_KERNEL_PLAN_H
#define SWARF_SWEEP_KERNEL_PLAN_H

#include "base/lanes.h"
#include "sweep/kernel.h"

/* Farther than any voxel that counts, and safe to square. */
static const float far_away = 1e18f;

/* Distance from the lanes to an arc in the plane. Relative to its point nearest to the column's middle, so that large
 * radii cost no digits: |p - c| - R = a / (1 + sqrt(1 + k a)) with a = 2 e.n + k e.e, k = 1 / R, e = p - base. */
INLINE lanes arc_distance(const swarf_column *c, int32_t i, lanes x, lanes y)
{
    float *const *f = c->field;
    const lanes ex = x - f[COLUMN_X][i], ey = y - f[COLUMN_Y][i];
    const float k = f[COLUMN_S0][i], nx = f[COLUMN_UX][i], ny = f[COLUMN_UY][i];
    const lanes a = (ex * nx + ey * ny) * 2.0f + (ex * ex + ey * ey) * k;
    const lanes circle = a / (root(maximum(a * k + 1.0f, all(0))) + 1.0f);
    const lanes across = maximum(circle, all(0) - circle);
    if (c->kind[i] & TRACK_ARC_FULL) return across;
    const lanes from = ey * f[COLUMN_NAX][i] - ex * f[COLUMN_NAY][i] + f[COLUMN_A][i];
    const lanes until = ex * f[COLUMN_NBY][i] - ey * f[COLUMN_NBX][i] + f[COLUMN_B][i];
    const mask after = less(all(0), from), before = less(all(0), until);
    const mask within = c->kind[i] & TRACK_ARC_MAJOR ? either(after, before) : both(after, before);
    const lanes ax = x - f[COLUMN_AX][i], ay = y - f[COLUMN_AY][i], bx = x - f[COLUMN_BX][i], by = y - f[COLUMN_BY][i];
    const lanes ends = root(minimum(ax * ax + ay * ay, bx * bx + by * by));
    return pick(within, across, ends);
}

/* Distance from the lanes to the track's projection. */
INLINE lanes plan_distance(const swarf_column *c, int32_t i, lanes x, lanes y)
{
    if (c->kind[i] & TRACK_ARC) return arc_distance(c, i, x, y);
    float *const *f = c->field;
    const lanes ex = x - f[COLUMN_X][i], ey = y - f[COLUMN_Y][i];
    const float ux = f[COLUMN_UX][i], uy = f[COLUMN_UY][i];
    const lanes s = ex * ux + ey * uy, w = ey * ux - ex * uy;
    const lanes beyond = s - clamped(s, all(f[COLUMN_S0][i]), all(f[COLUMN_S1][i]));
    return root(beyond * beyond + w * w);
}

#endif
