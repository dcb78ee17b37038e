/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Part of the kernels (kernel_body.h): distance to one line of a cylinder or of a ball with its shaft, in closed form,
 * 16 columns x 8 voxels. */
#ifndef SWARF_SWEEP_KERNEL_LINE_H
#define SWARF_SWEEP_KERNEL_LINE_H

#include "sweep/kernel_plan.h"

/* The slanted surface left by the rim of a disc on a tilted line, where it turns into the side: an elliptic cylinder
 * that meets the side without an edge. `height`: voxels beyond the disc's middle, outwards. The distance of first order
 * used elsewhere is off there by h^2 / 4 (distance to the seam), so near the seam the conic itself stands for it:
 *     (height^2 / m^2 - (R^2 - w^2)) / (R + |w|)
 * which is the side's own distance R - |w| up to the disc, and right to second order next to the seam. */
enum { SEAM = 3, STEEP = 6 };

struct slant {
    lanes square, linear, rest;
};

/* Of a line of slope m; `seam`: it turns into the side without an edge. */
INLINE struct slant slant_between(lanes w, float m, float radius, int seam)
{
    const lanes chord2 = maximum(all(0), all(radius * radius) - w * w), chord = root(chord2);
    const lanes scale = chord / root(chord2 + m * m * radius * radius);
    if (!seam) return (struct slant){all(0), scale, scale * chord * m};
    const lanes aside = maximum(w, all(0) - w);
    const mask near = less(all(radius - SEAM), aside);
    const lanes conic = all(1) / ((minimum(aside, all(radius)) + radius) * (m * m));
    return (struct slant){pick(near, conic, all(0)), pick(near, all(0), scale),
                          pick(near, all(radius) - aside, scale * chord * m)};
}

INLINE lanes slant_value(const struct slant *slant, lanes height)
{
    const lanes up = maximum(height, all(0));
    return up * up * slant->square + height * slant->linear - slant->rest;
}

static __attribute__((noinline)) void cylinder_seam(float m, float radius, lanes s, lanes w, lanes side, float bottom,
                                                    float length, float low, float high, int top_near, lanes best[8])
{
    const struct slant slant = slant_between(w, m, radius, 1);
    const lanes at = s * m + bottom;
    for (int z = 0; z < 8; z++) {
        const lanes below = maximum(all(low - (float)z), slant_value(&slant, at - (float)z));
        if (!top_near) {
            best[z] = minimum(best[z], maximum(side, below));
            continue;
        }
        const lanes above = maximum(all((float)z - high), slant_value(&slant, all((float)z - length) - at));
        best[z] = minimum(best[z], maximum(side, maximum(below, above)));
    }
}

/* Cylinders on lines. Tilted: side, lowest bottom, and the slanted surface that the trailing edge of the bottom leaves,
 * scaled to unit gradient; likewise at the top. Never switched between, so that the band has no tears. */
INLINE void cylinder_line(const swarf_body *body, const swarf_column *c, int32_t i, lanes x, lanes y, float z0,
                          lanes best[8])
{
    float *const *f = c->field;
    const float radius = body->radius, m = f[COLUMN_M][i];
    const float bottom = f[COLUMN_Z][i] + body->z_lo - z0, length = body->z_hi - body->z_lo + f[COLUMN_RISE][i];
    const lanes ex = x - f[COLUMN_X][i], ey = y - f[COLUMN_Y][i];
    const float ux = f[COLUMN_UX][i], uy = f[COLUMN_UY][i], s0 = f[COLUMN_S0][i], s1 = f[COLUMN_S1][i];
    const lanes s = ex * ux + ey * uy, w = ey * ux - ex * uy;
    const lanes beyond = s - clamped(s, all(s0), all(s1)), w2 = w * w;
    const lanes side = root(beyond * beyond + w2) - radius;
    const float low = bottom + m * s0, high = bottom + length + m * s1;
    if (m == 0) {
        for (int z = 0; z < 8; z++) {
            const float below = low - (float)z, above = (float)z - high;
            best[z] = minimum(best[z], maximum(side, all(below > above ? below : above)));
        }
        return;
    }
    const int top_near = low + length - SWARF_HALF_WIDTH < 7; /* of a long cutter it mostly is far above */
    if (m * m * radius > STEEP && bits(less(all((radius - SEAM) * (radius - SEAM)), w2))) {
        cylinder_seam(m, radius, s, w, side, bottom, length, low, high, top_near, best);
        return;
    }
    const lanes chord2 = maximum(all(0), all(radius * radius) - w2), chord = root(chord2);
    const lanes scale = chord / root(chord2 + m * m * radius * radius);
    const lanes under = (s - chord) * m + bottom;
    for (int z = 0; z < 8; z++) {
        const lanes value = maximum(maximum(side, all(low - (float)z)), (under - (float)z) * scale);
        if (!top_near)
            best[z] = minimum(best[z], value);
        else {
            const lanes over = ((s + chord) * m + (bottom + length)) * scale;
            best[z] = minimum(best[z], maximum(value, maximum(all((float)z - high), scale * (float)z - over)));
        }
    }
}

/* A ball with its shaft above, up to where the shaft ends, is what lies within the radius of a vertical ray; swept
 * along a line, what lies within the radius of a strip: the line of the ball's centre and all above it. Its distance is
 * the exact one on both sides, the seam between the ball's and the shaft's part included. */
struct strip {
    lanes beside;      /* squared distance in the plane */
    lanes line;        /* height from which on that is the distance */
    lanes along, flat; /* for what is below: the place along the line (less its height's part), squared plan distance */
    lanes t0, t1;
    float centre, dz;
};

INLINE lanes strip_square(const struct strip *strip, float z)
{
    const float ez = z - strip->centre;
    const lanes q = strip->along + ez * strip->dz;
    const lanes t = clamped(q, strip->t0, strip->t1);
    return t * (t - (q + q)) + (strip->flat + ez * ez);
}

/* Where the shaft's top is near: `top` is its height at the line's base, `high` the greatest one. `shaft`: the whole
 * group is above the strip's line. */
static __attribute__((noinline)) void ball_top(const struct strip *strip, float radius, float m, lanes s, lanes w,
                                               float top, float high, int shaft, lanes best[8])
{
    const lanes side = root(strip->beside) - radius, at = s * m + top;
    struct slant slant = {all(0), all(0), all(far_away)}; /* of level and vertical lines there is none */
    if (m > 0) slant = slant_between(w, m, radius, m * m * radius > STEEP);
    for (int z = 0; z < 8; z++) {
        lanes value = maximum(side, maximum(all((float)z - high), slant_value(&slant, all((float)z) - at)));
        if (!shaft) {
            const lanes ball = root(maximum(strip_square(strip, (float)z), all(0))) - radius;
            value = pick(less(strip->line, all((float)z)), value, maximum(value, ball));
        }
        best[z] = minimum(best[z], value);
    }
}

/* Balls on lines; `squares`: squared distances to the strips, rooted once at the end. */
INLINE void ball_line(const swarf_body *body, const swarf_column *c, int32_t i, lanes x, lanes y, float z0,
                      lanes best[8], lanes squares[8])
{
    float *const *f = c->field;
    const float centre = f[COLUMN_Z][i] + body->core_lo - z0, length = body->z_hi - body->core_lo;
    const float m = f[COLUMN_M][i], s0 = f[COLUMN_S0][i], s1 = f[COLUMN_S1][i];
    const lanes ex = x - f[COLUMN_X][i], ey = y - f[COLUMN_Y][i];
    const float ux = f[COLUMN_UX][i], uy = f[COLUMN_UY][i];
    const lanes s = ex * ux + ey * uy, w = ey * ux - ex * uy;
    const lanes on = clamped(s, all(s0), all(s1)), beyond = s - on;
    /* the line's heights near the group: its first lane is no farther from the others than its diagonal */
    const float diagonal = 4.25f;
    const float before = s[0] - diagonal, after = s[0] + diagonal;
    const float lowest = centre + m * (before < s0 ? s0 : before > s1 ? s1 : before);
    const float highest = centre + m * (after < s0 ? s0 : after > s1 ? s1 : after);
    const struct strip strip = {.beside = beyond * beyond + w * w,
                                .line = on * m + centre,
                                .along = ex * f[COLUMN_DX][i] + ey * f[COLUMN_DY][i],
                                .flat = ex * ex + ey * ey,
                                .t0 = all(f[COLUMN_T0][i]),
                                .t1 = all(f[COLUMN_T1][i]),
                                .centre = centre,
                                .dz = f[COLUMN_DZ][i]};
    if (lowest + length - SWARF_HALF_WIDTH < 7) {
        const float high = centre + length + m * s1 + f[COLUMN_RISE][i];
        ball_top(&strip, body->radius, m, s, w, centre + length, high, highest < 0, best);
    } else if (highest < 0) {
        for (int z = 0; z < 8; z++) squares[z] = minimum(squares[z], strip.beside);
    } else if (lowest > 7) {
        for (int z = 0; z < 8; z++) squares[z] = minimum(squares[z], strip_square(&strip, (float)z));
    } else {
        for (int z = 0; z < 8; z++)
            squares[z] = minimum(squares[z],
                                 pick(less(strip.line, all((float)z)), strip.beside, strip_square(&strip, (float)z)));
    }
}

#endif
