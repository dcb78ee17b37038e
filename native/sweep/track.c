/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "sweep/track.h"

#include "base/memory.h"
#include "base/status.h"
#include "swarf/sweep.h"
#include "sweep/body.h"

#include <math.h>
#include <stdint.h>

/* A line steeper than this (run over rise) is swept as vertical: over the tallest stock (a million voxels) it leaves
 * its track by a thousandth of a voxel. */
static const double vertical = 1e-9;
/* No stock is a thousandth of this many voxels large; squares and sums of such numbers stay finite. */
static const double farthest = 1e30;
/* Steps of less than this many voxels between the ends of an arc are level, radii that differ by less are equal. */
static const double level = 1e-4;

static swarf_status append(swarf_track_list *list, const swarf_track *track)
{
    SWARF_TRY(swarf_array_reserve((void **)&list->tracks, &list->room, list->count + 1, sizeof *track));
    list->tracks[list->count++] = *track;
    return SWARF_OK;
}

static swarf_status append_line(swarf_track_list *list, const double a[3], const double b[3])
{
    const double *low = b[2] < a[2] ? b : a, *high = b[2] < a[2] ? a : b;
    swarf_track track = {.point = {low[0], low[1], low[2]}, .ux = 1, .rise = high[2] - low[2]};
    const double dx = high[0] - low[0], dy = high[1] - low[1], run = hypot(dx, dy);
    if (run > vertical * track.rise) {
        track.run = run;
        track.ux = dx / run;
        track.uy = dy / run;
        track.slope = track.rise / run;
    }
    track.length = hypot(track.run, track.rise);
    return append(list, &track);
}

static void to_index(const double xyz[3], const double origin[3], double voxel, double ijk[3])
{
    for (int k = 0; k < 3; k++) ijk[k] = (xyz[k] - origin[k]) / voxel;
}

static swarf_status append_chords(swarf_track_list *list, const swarf_path *path, const double origin[3], double voxel,
                                  double radius, const int axis[2], const double centre[3])
{
    /* A chord of angle s lies inside its arc by at most radius * (1 - cos(s / 2)), two thirds of that on average: with
     * its ends that much outside the arc it removes as much as the arc does, and leaves it by two thirds at most. Half
     * of the bound goes to this, half to the joints. */
    const double inside = fmin(1, 0.5 * SWARF_SWEEP_BOUND / fmax(radius, 1e-9));
    const double step = fmin(0.5 * M_PI, 2 * acos(1 - inside));
    const double outwards = 1 + 2.0 / 3.0 * (1 - cos(0.5 * step));
    const double steps = ceil(fabs(path->arc.angle_rad) / step);
    if (!(steps < 4e6)) /* half a gigabyte */

        return swarf_fail(SWARF_ERROR_ARGUMENT, "arc: %g turns of radius %g voxels are too many",
                          path->arc.angle_rad / (2 * M_PI), radius);
    const size_t count = steps < 1 ? 1 : (size_t)steps;
    /* Beside the joint of two chords the nearest point would be the end of both, where edges of the cutter have no unit
     * gradient: chords go on a little, as far as the bound allows or the band needs. */
    const double turn = fabs(path->arc.angle_rad) / (double)count;
    const double overlap = fmin(0.5 * SWARF_SWEEP_BOUND / fmax(turn, 1e-9), 0.5 * SWARF_HALF_WIDTH * turn);
    double xyz[3], a[3], b[3];
    to_index(path->start, origin, voxel, a);
    for (size_t i = 1; i <= count; i++) {
        swarf_path_point(path, (double)i / (double)count, xyz);
        to_index(xyz, origin, voxel, b);
        for (int k = 0; k < 2 && i < count; k++)
            b[axis[k]] = centre[axis[k]] + outwards * (b[axis[k]] - centre[axis[k]]);
        const double length =
            sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
        const double part = length > 0 ? overlap / length : 0;
        double low[3], high[3];
        for (int k = 0; k < 3; k++) {
            low[k] = a[k] - (i > 1 ? part : 0) * (b[k] - a[k]);
            high[k] = b[k] + (i < count ? part : 0) * (b[k] - a[k]);
        }
        SWARF_TRY(append_line(list, low, high));
        for (int k = 0; k < 3; k++) a[k] = b[k];
    }
    return SWARF_OK;
}

swarf_status swarf_track_append(swarf_track_list *list, const swarf_path *path, const double origin[3], double voxel)
{
    if (!path->has_motion) return SWARF_OK;
    double a[3], b[3];
    to_index(path->start, origin, voxel, a);
    to_index(path->end, origin, voxel, b);
    for (int k = 0; k < 3; k++)
        SWARF_REQUIRE(fabs(a[k]) < farthest && fabs(b[k]) < farthest,
                      "path: coordinate %c (%g .. %g mm) is not finite or too far away", "xyz"[k], path -> start[k],
                      path -> end[k]);
    if (!path->is_arc) return append_line(list, a, b);

    SWARF_REQUIRE(isfinite(path->arc.angle_rad), "path: the angle of an arc is not finite");
    SWARF_REQUIRE(path->arc.plane >= SWARF_PLANE_XY && path->arc.plane <= SWARF_PLANE_YZ, "path: %d is not a plane",
                  (int)path->arc.plane);
    static const int axes[3][2] = {{0, 1}, {2, 0}, {1, 2}}; /* in-plane coordinates of XY, ZX, YZ */
    const int *axis = axes[path->arc.plane];
    double centre[3];
    to_index(path->arc.centre, origin, voxel, centre);
    const double radius = hypot(a[axis[0]] - centre[axis[0]], a[axis[1]] - centre[axis[1]]);
    const double end_radius = hypot(b[axis[0]] - centre[axis[0]], b[axis[1]] - centre[axis[1]]);
    if (path->arc.plane != SWARF_PLANE_XY || fabs(a[2] - b[2]) > level || fabs(radius - end_radius) > level ||
        radius < level)
        return append_chords(list, path, origin, voxel, fmax(radius, end_radius), axis, centre);

    const double turn = fabs(path->arc.angle_rad);
    const double *first = path->arc.angle_rad < 0 ? b : a;
    const swarf_track track = {.point = {a[0], a[1], a[2]},
                               .ux = 1,
                               .centre = {centre[0], centre[1]},
                               .radius = radius,
                               .from = atan2(first[1] - centre[1], first[0] - centre[0]),
                               .turn = fmin(turn, 2 * M_PI),
                               .is_arc = 1};
    return append(list, &track);
}
