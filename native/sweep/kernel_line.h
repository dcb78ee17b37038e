/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Part of the kernels (kernel_body.h): distance to one line of a cylinder or of a ball with its shaft, in closed form,
 * 16 columns x 8 voxels. */
#ifndef SWARF_SWEEP_KERNEL_LINE_H
#define SWARF_SWEEP_KERNEL_LINE_H

#include "sweep/kernel_plan.h"

/* What a disc of radius R sweeps on a tilted line is bounded below by a slanted surface, half an elliptic cylinder with
 * half axes R and R m / sqrt(1 + m^2). It is convex, so that each of its tangent planes is no farther than the surface
 * itself, and no nearer inside. Of the planes two are taken: the one above the voxel, which is linear in z (`scale` and
 * `rest`); and, as that one is steep and far from the nearest point next to the side, within RIM voxels of the side the
 * one whose normal is that of the similar ellipse through the voxel. */
enum { RIM = 3 };
/* Half axes of less than this many voxels are no more than an edge. */
static const float least_rim = 0.01f;

struct slant {
    lanes scale, rest;
    lanes across;                   /* (w / R)^2 */
    float upwards, tilt, half_axis; /* 1 / (R m), the smaller half axis over the greater, the smaller */
};

INLINE struct slant slant_between(lanes w2, float m, float im, float radius)
{
    const lanes chord2 = maximum(all(0), all(radius * radius) - w2), chord = root(chord2);
    const lanes scale = chord / root(chord2 + m * m * radius * radius);
    const float tilt = m * im;
    return (struct slant){scale, scale * chord * m, w2 * (1 / (radius * radius)), 1 / (radius * m),
                          tilt,  radius * tilt};
}

/* `height`: voxels beyond the disc's middle, outwards. */
INLINE lanes slant_value(const struct slant *slant, lanes height)
{
    return height * slant->scale - slant->rest;
}

INLINE lanes rim_value(const struct slant *slant, lanes height)
{
    const lanes up = maximum(height, all(0)) * slant->upwards, up2 = up * up;
    const lanes size = root(slant->across + up2);
    const lanes length = root(slant->across * (slant->tilt * slant->tilt) + up2);
    return (size - 1.0f) * size * slant->half_axis / maximum(length, all(1e-6f));
}

/* Is one of the columns near enough to the side? */
INLINE int has_rim(lanes w2, float m, float im, float radius)
{
    const float inner = radius > RIM ? radius - RIM : 0;
    return radius * m * im > least_rim && bits(less(all(inner * inner), w2));
}

/* The greater of a value and that plane's, beyond the disc and within the band. */
INLINE lanes with_rim(const struct slant *slant, lanes height, lanes value)
{
    const mask beyond = both(less(all(0), height), less(value, all(SWARF_HALF_WIDTH)));
    if (!bits(beyond)) return value;
    return pick(beyond, maximum(value, rim_value(slant, height)), value);
}

static __attribute__((noinline)) void cylinder_rim(const struct slant *slant, lanes at, lanes side, float length,
                                                   float low, float high, int top_near, lanes best[8])
{
    for (int z = 0; z < 8; z++) {
        const lanes under = at - (float)z;
        lanes value = maximum(maximum(side, all(low - (float)z)), slant_value(slant, under));
        value = with_rim(slant, under, value);
        if (top_near) {
            const lanes over = all((float)z - length) - at;
            value = maximum(value, maximum(all((float)z - high), slant_value(slant, over)));
            value = with_rim(slant, over, value);
        }
        best[z] = minimum(best[z], value);
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
    const struct slant slant = slant_between(w2, m, f[COLUMN_IM][i], radius);
    const lanes at = s * m + bottom;
    if (has_rim(w2, m, f[COLUMN_IM][i], radius)) {
        cylinder_rim(&slant, at, side, length, low, high, top_near, best);
        return;
    }
    const lanes under = at * slant.scale - slant.rest, over = (at + length) * slant.scale + slant.rest;
    for (int z = 0; z < 8; z++) {
        const lanes up = slant.scale * (float)z;
        const lanes value = maximum(maximum(side, all(low - (float)z)), under - up);
        best[z] = minimum(best[z], top_near ? maximum(value, maximum(all((float)z - high), up - over)) : value);
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
static __attribute__((noinline)) void ball_top(const struct strip *strip, float radius, float m, float im, lanes s,
                                               lanes w, float top, float high, int shaft, lanes best[8])
{
    const lanes side = root(strip->beside) - radius, at = s * m + top;
    const lanes w2 = w * w;
    const int slanted = m > 0, rim = slanted && has_rim(w2, m, im, radius); /* level and vertical lines have none */
    const struct slant slant = slant_between(w2, slanted ? m : 1, im, radius);
    for (int z = 0; z < 8; z++) {
        const lanes over = all((float)z) - at;
        lanes value = maximum(side, all((float)z - high));
        if (slanted) value = maximum(value, slant_value(&slant, over));
        if (rim) value = with_rim(&slant, over, value);
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
        ball_top(&strip, body->radius, m, f[COLUMN_IM][i], s, w, centre + length, high, highest < 0, best);
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
