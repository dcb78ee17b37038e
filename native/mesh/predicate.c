/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Orientation tests in whole numbers: differences have 26 bits, the determinant of three of them less than 2^81, which
 * 128 bits hold; doubles decide where their rounding cannot matter. */
#include "mesh/predicate.h"

#include <math.h>
#include <string.h>

__extension__ typedef __int128 wide;

/* The products of two differences are exact in doubles (52 bits); what is rounded are three products of 79 bits and
 * their sums, each to 2^-53 of itself. */
static const double safe = 0x1p30;

static void difference(const int32_t a[3], const int32_t b[3], int64_t out[3])
{
    for (int k = 0; k < 3; k++) out[k] = (int64_t)a[k] - b[k];
}

/* (b - a) x (c - a). */
static void normal_of(const int32_t a[3], const int32_t b[3], const int32_t c[3], int64_t n[3])
{
    int64_t u[3], v[3];
    difference(b, a, u);
    difference(c, a, v);
    for (int k = 0; k < 3; k++) n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
}

/* Sign of n . (d - a), n being a normal_of() three corners. */
static int above(const int64_t n[3], const int32_t a[3], const int32_t d[3])
{
    int64_t w[3];
    difference(d, a, w);
    const double near = (double)n[0] * (double)w[0] + (double)n[1] * (double)w[1] + (double)n[2] * (double)w[2];
    if (fabs(near) > safe) return near > 0 ? 1 : -1;
    const wide exact = (wide)n[0] * w[0] + (wide)n[1] * w[1] + (wide)n[2] * w[2];
    return exact > 0 ? 1 : exact < 0 ? -1 : 0;
}

/* Sign of the volume of (b - a, c - a, d - a). */
static int orient(const int32_t a[3], const int32_t b[3], const int32_t c[3], const int32_t d[3])
{
    int64_t n[3];
    normal_of(a, b, c, n);
    return above(n, a, d);
}

/* The coordinate to leave out so that the triangle keeps its area; -1 when it has none. */
static int flat_axis(const int32_t p[3][3])
{
    int64_t n[3];
    normal_of(p[0], p[1], p[2], n);
    int best = -1;
    int64_t most = 0;
    for (int k = 0; k < 3; k++)
        if ((n[k] < 0 ? -n[k] : n[k]) > most) {
            most = n[k] < 0 ? -n[k] : n[k];
            best = k;
        }
    return best;
}

static int side(const int32_t a[3], const int32_t b[3], const int32_t c[3], int axis)
{
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    const int64_t area =
        ((int64_t)b[i] - a[i]) * ((int64_t)c[j] - a[j]) - ((int64_t)b[j] - a[j]) * ((int64_t)c[i] - a[i]);
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

/* In a plane: both segments closed. */
static int segments_meet(const int32_t p[3], const int32_t q[3], const int32_t a[3], const int32_t b[3], int axis)
{
    const int s1 = side(p, q, a, axis), s2 = side(p, q, b, axis), s3 = side(a, b, p, axis), s4 = side(a, b, q, axis);
    if (s1 || s2 || s3 || s4) return s1 * s2 <= 0 && s3 * s4 <= 0;
    for (int k = 0; k < 3; k++) { /* on one line: their extents overlap */
        const int32_t lo = p[k] < q[k] ? p[k] : q[k], hi = p[k] < q[k] ? q[k] : p[k];
        if ((a[k] < lo && b[k] < lo) || (a[k] > hi && b[k] > hi)) return 0;
    }
    return 1;
}

static int inside_flat(const int32_t p[3], const int32_t t[3][3], int axis)
{
    const int s0 = side(t[0], t[1], p, axis), s1 = side(t[1], t[2], p, axis), s2 = side(t[2], t[0], p, axis);
    return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

static int segment_meets(const int32_t p[3], const int32_t q[3], const int32_t t[3][3], int axis)
{
    int64_t n[3];
    normal_of(t[0], t[1], t[2], n);
    const int s1 = above(n, t[0], p), s2 = above(n, t[0], q);
    if (s1 * s2 > 0) return 0;
    if (s1 == 0 && s2 == 0)
        return inside_flat(p, t, axis) || segments_meet(p, q, t[0], t[1], axis) ||
               segments_meet(p, q, t[1], t[2], axis) || segments_meet(p, q, t[2], t[0], axis);
    const int e0 = orient(p, q, t[0], t[1]), e1 = orient(p, q, t[1], t[2]), e2 = orient(p, q, t[2], t[0]);
    return (e0 >= 0 && e1 >= 0 && e2 >= 0) || (e0 <= 0 && e1 <= 0 && e2 <= 0);
}

/* Whether corners of triangle b, but for one that both have in common (-1: none), lie all on one side of the plane of
 * triangle a. */
static int on_one_side(const int32_t a[3][3], const int32_t b[3][3], int common)
{
    int64_t n[3];
    int side_of_b = 0;
    normal_of(a[0], a[1], a[2], n);
    for (int k = 0; k < 3; k++) {
        if (k == common) continue;
        const int own = above(n, a[0], b[k]);
        if (own == 0 || own == -side_of_b) return 0;
        side_of_b = own;
    }
    return 1;
}

int swarf_triangles_meet(const int32_t pa[3][3], const uint32_t a[3], const int32_t pb[3][3], const uint32_t b[3])
{
    int in_a[3], in_b[3], shared = 0; /* corners they have in common */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (a[i] == b[j] && shared < 3) {
                in_a[shared] = i;
                in_b[shared++] = j;
            }
    /* most of what is asked for: neighbours, and others that lie near each other */
    if (shared < 2 && (on_one_side(pa, pb, shared ? in_b[0] : -1) || on_one_side(pb, pa, shared ? in_a[0] : -1)))
        return 0;
    if (shared == 2 && orient(pa[0], pa[1], pa[2], pb[3 - in_b[0] - in_b[1]]) != 0) return 0;
    const int axis_a = flat_axis(pa), axis_b = flat_axis(pb);
    if (axis_a < 0 || axis_b < 0) return 0;
    if (shared == 3) return 1;
    if (shared == 2) { /* folded flat upon each other */
        const int32_t *p = pa[in_a[0]], *q = pa[in_a[1]];
        const int32_t *other_a = pa[3 - in_a[0] - in_a[1]], *other_b = pb[3 - in_b[0] - in_b[1]];
        return side(p, q, other_a, axis_a) * side(p, q, other_b, axis_a) > 0;
    }
    if (shared == 1) {
        const int i = in_a[0], j = in_b[0];
        return segment_meets(pa[(i + 1) % 3], pa[(i + 2) % 3], pb, axis_b) ||
               segment_meets(pb[(j + 1) % 3], pb[(j + 2) % 3], pa, axis_a);
    }
    for (int k = 0; k < 3; k++)
        if (segment_meets(pa[k], pa[(k + 1) % 3], pb, axis_b) || segment_meets(pb[k], pb[(k + 1) % 3], pa, axis_a))
            return 1;
    return 0;
}

int swarf_triangle_has_area(const int32_t p[3][3])
{
    return flat_axis(p) >= 0;
}
