/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Arc: from centre, ends and direction to centre and signed angle, and points on the result.
 *
 * Files round centres and ends to some decimals, so the two radii seldom agree. The mismatch is taken up by
 * moving the centre along the chord until both are equal: the result is a true circle through both ends, which
 * strays from what was written by no more than twice the mismatch. Where that would move the far side of the circle
 * further (more than half a turn between close ends) the centre stays and the radius changes evenly with the angle.
 */
#include "program/arc.h"

#include "base/status.h"

#include <math.h>

static const double two_pi = 6.283185307179586476925286766559;

/* Ends closer than this are one point: a full circle. Files have at most six decimals, inches included;
 * incremental programs sum up rounding errors far below it. */
static const double same_point_mm = 1e-6;

/* Radii closer than this need no correction, so that exact arcs keep their exact centre. */
static const double same_radius_mm = 1e-9;

double swarf_arc_tolerance(double radius)
{
    return fmax(0.002, 0.001 * radius);
}

/* Angle from u to v turning ccw or cw, in (0, 2 pi]. */
static double angle_between(const double u[2], const double v[2], int ccw)
{
    double angle = atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
    if (!ccw) angle = -angle;
    return angle > 0.0 ? angle : angle + two_pi;
}

swarf_status swarf_arc_make(const double start[3], const double end[3], const double centre[3], swarf_plane plane,
                            int ccw, int turns, double tolerance_mm, swarf_arc *out)
{
    SWARF_REQUIRE(start && end && centre && out, "arc: NULL");
    SWARF_REQUIRE(plane >= SWARF_PLANE_XY && plane <= SWARF_PLANE_YZ, "arc: %d is not a plane", (int)plane);
    SWARF_REQUIRE(turns >= 1 && turns <= SWARF_ARC_TURNS_MAX, "arc: %d turns; 1 to %d are possible", turns,
                  SWARF_ARC_TURNS_MAX);
    int a, b, n;
    swarf_plane_axes(plane, &a, &b, &n);
    SWARF_REQUIRE(isfinite(start[a]) && isfinite(start[b]),
                  "arc: starts at an unknown position; command %c and %c first", "XYZ"[a], "XYZ"[b]);
    SWARF_REQUIRE(isfinite(end[a]) && isfinite(end[b]), "arc: the end is not finite");
    SWARF_REQUIRE(isfinite(centre[a]) && isfinite(centre[b]), "arc: the centre is not finite");

    double u[2] = {start[a] - centre[a], start[b] - centre[b]};
    double v[2] = {end[a] - centre[a], end[b] - centre[b]};
    const double r0 = hypot(u[0], u[1]), r1 = hypot(v[0], v[1]);
    const double chord[2] = {end[a] - start[a], end[b] - start[b]};
    const double length = hypot(chord[0], chord[1]);
    SWARF_REQUIRE(r0 > same_point_mm && r1 > same_point_mm,
                  "arc: the radius is %.6g mm at the start and %.6g mm at the end; the centre must lie off both", r0,
                  r1);

    /* along the chord to the point as far from the start as from the end */
    const double shift = length > same_point_mm ? (r0 - r1) * (r0 + r1) / (2.0 * length) : 0.0;
    const double shift_a = length > same_point_mm ? -shift * chord[0] / length : 0.0;
    const double shift_b = length > same_point_mm ? -shift * chord[1] / length : 0.0;
    const double tolerance = tolerance_mm > 0.0 ? tolerance_mm : swarf_arc_tolerance(fmax(r0, r1));
    SWARF_REQUIRE(fabs(r0 - r1) <= tolerance,
                  "arc: the radius is %.6g mm at the start but %.6g mm at the end (they may differ by %.3g mm); "
                  "the centre %c%.6g %c%.6g would fit",
                  r0, r1, tolerance, "XYZ"[a], centre[a] + shift_a, "XYZ"[b], centre[b] + shift_b);

    swarf_arc arc = {{0.0, 0.0, 0.0}, 0.0, (int32_t)plane, 0};
    arc.centre[a] = centre[a];
    arc.centre[b] = centre[b];
    arc.centre[n] = start[n];
    double angle = length <= same_point_mm ? two_pi : angle_between(u, v, ccw);
    if (fabs(r0 - r1) > same_radius_mm && fabs(shift) <= 0.5 * r0 &&
        ((angle <= 0.5 * two_pi && turns == 1) || fabs(shift) <= 2.0 * fabs(r0 - r1))) {
        arc.centre[a] += shift_a;
        arc.centre[b] += shift_b;
        u[0] -= shift_a, u[1] -= shift_b;
        v[0] -= shift_a, v[1] -= shift_b;
        angle = angle_between(u, v, ccw);
    }
    angle += two_pi * (turns - 1);
    arc.angle_rad = ccw ? angle : -angle;
    *out = arc;
    return SWARF_OK;
}

void swarf_path_point(const swarf_path *path, double t, double out[3])
{
    if (t <= 0.0 || t >= 1.0) { /* exactly, whatever the rounding of the formulas below */
        for (int k = 0; k < 3; k++) out[k] = t <= 0.0 ? path->start[k] : path->end[k];
        return;
    }
    for (int k = 0; k < 3; k++) out[k] = path->start[k] + t * (path->end[k] - path->start[k]);
    if (!path->is_arc) return;
    int a, b, n;
    swarf_plane_axes((swarf_plane)path->arc.plane, &a, &b, &n);
    const double *c = path->arc.centre;
    const double u = path->start[a] - c[a], v = path->start[b] - c[b];
    const double r0 = hypot(u, v), r1 = hypot(path->end[a] - c[a], path->end[b] - c[b]);
    const double scale = r0 > 0.0 ? 1.0 + t * (r1 - r0) / r0 : 1.0;
    const double cosine = scale * cos(t * path->arc.angle_rad), sine = scale * sin(t * path->arc.angle_rad);
    out[a] = c[a] + cosine * u - sine * v;
    out[b] = c[b] + sine * u + cosine * v;
}

void swarf_path_part(const swarf_path *path, double t, swarf_path *out)
{
    swarf_path part = *path;
    swarf_path_point(path, t, part.end);
    part.arc.angle_rad *= t;
    *out = part;
}

double swarf_path_length(const swarf_path *path)
{
    const double d[3] = {path->end[0] - path->start[0], path->end[1] - path->start[1], path->end[2] - path->start[2]};
    if (!path->is_arc) return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    int a, b, n;
    swarf_plane_axes((swarf_plane)path->arc.plane, &a, &b, &n);
    const double *c = path->arc.centre;
    const double r0 = hypot(path->start[a] - c[a], path->start[b] - c[b]);
    const double r1 = hypot(path->end[a] - c[a], path->end[b] - c[b]);
    return hypot(0.5 * (r0 + r1) * path->arc.angle_rad, d[n]);
}
