/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G2 and G3: the centre from I J K or from R. */
#include "gcode/machine.h"

#include "base/status.h"

#include <math.h>
#include <stdio.h>

/* The centre of an arc of radius |r| between two points: left of the way for ccw and r > 0 (the shorter arc), on the
 * other side for either alone. Fails unless the points are at most 2 |r| apart. */
static swarf_status centre_from_radius(const swarf_machine *machine, const swarf_word *word, const double from[2],
                                       const double to[2], double r, int ccw, double out[2])
{
    const double d[2] = {to[0] - from[0], to[1] - from[1]};
    const double chord = hypot(d[0], d[1]), half = 0.5 * chord, radius = fabs(r);
    if (!(chord > 1e-6))
        return swarf_gcode_fail(machine, word,
                                "makes no arc between equal points; a full circle needs its centre by I, J or K");
    if (radius < half - swarf_arc_tolerance(half))
        return swarf_gcode_fail(machine, word, "is too small: the ends are %.6g mm apart, so R must be at least %.6g",
                                chord, half / machine->modes.unit_mm);
    const double height = radius > half ? sqrt((radius - half) * (radius + half)) : 0.0;
    const double side = (r > 0.0) == (ccw != 0) ? height : -height;
    out[0] = from[0] + 0.5 * d[0] - side * d[1] / chord;
    out[1] = from[1] + 0.5 * d[1] + side * d[0] / chord;
    return SWARF_OK;
}

/* LinuxCNC's: radii differ by at most 0.1 % of the larger one, but always by 2 sqrt(2) hundredths of a millimetre
 * (thousandths of an inch), never by a hundred times that. */
static double tolerance_of(const swarf_machine *machine, double radius)
{
    const double least = 2.0 * sqrt(2.0) * (machine->modes.unit_mm == 1.0 ? 0.01 : 0.0254);
    return fmin(100.0 * least, fmax(least, 0.001 * radius));
}

/* The centre by I J K; at least one of the plane's two, under G90.1 both. */
static swarf_status read_centre(swarf_machine *machine, swarf_block *block, const swarf_word *word, const int axes[3],
                                double centre[3], int *offsets)
{
    *offsets = 0;
    for (int i = 0; i < 2; i++) {
        const char letter = (char)('I' + axes[i]);
        if (!swarf_block_has(block, letter)) continue;
        double value = 0.0;
        SWARF_TRY(swarf_machine_length(machine, swarf_block_take(block, letter), &value));
        centre[axes[i]] = machine->modes.arc_absolute ? value : machine->position[axes[i]] + value;
        ++*offsets;
    }
    if (swarf_block_has(block, 'R') || *offsets >= (machine->modes.arc_absolute ? 2 : 1)) return SWARF_OK;
    return swarf_gcode_fail(machine, word, "arc needs a centre by %c %s %c%s, or R", 'I' + axes[0],
                            machine->modes.arc_absolute ? "and" : "or", 'I' + axes[1],
                            machine->modes.arc_absolute ? " (both under G90.1)" : "");
}

static swarf_status check_radii(const swarf_machine *machine, const swarf_word *word, const int axes[3],
                                const double *start, const double *end, const double *centre)
{
    const double r0 = hypot(start[axes[0]] - centre[axes[0]], start[axes[1]] - centre[axes[1]]);
    const double r1 = hypot(end[axes[0]] - centre[axes[0]], end[axes[1]] - centre[axes[1]]);
    const double tolerance = tolerance_of(machine, fmax(r0, r1)), unit = machine->modes.unit_mm;
    if (fabs(r0 - r1) <= tolerance) return SWARF_OK;
    swarf_arc fit;
    const double from[3] = {start[0], start[1], start[2]}, to[3] = {end[0], end[1], end[2]};
    char better[120] = "";
    if (swarf_arc_make(from, to, centre, machine->modes.plane, 1, 1, INFINITY, &fit) == SWARF_OK && r1 > 0.0) {
        /* where a centre on the same side would fit */
        const double chord = hypot(to[axes[0]] - from[axes[0]], to[axes[1]] - from[axes[1]]);
        const double shift = chord > 0.0 ? (r1 * r1 - r0 * r0) / (2.0 * chord * chord) : 0.0;
        const double base[2] = {machine->modes.arc_absolute ? 0.0 : start[axes[0]],
                                machine->modes.arc_absolute ? 0.0 : start[axes[1]]};
        snprintf(better, sizeof better, "; %c%.6g %c%.6g would fit", 'I' + axes[0],
                 (centre[axes[0]] + shift * (to[axes[0]] - from[axes[0]]) - base[0]) / unit, 'I' + axes[1],
                 (centre[axes[1]] + shift * (to[axes[1]] - from[axes[1]]) - base[1]) / unit);
    }
    return swarf_gcode_fail(machine, word,
                            "arc: the radius is %.6g mm at the start but %.6g mm at the end (they may differ by "
                            "%.3g mm)%s",
                            r0, r1, tolerance, better);
}

swarf_status swarf_machine_arc(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    int axes[3], any, offsets, turns = 1; /* first, second, normal */
    swarf_plane_axes(machine->modes.plane, &axes[0], &axes[1], &axes[2]);
    const double *start = machine->position;
    double end[SWARF_AXES], centre[3] = {start[0], start[1], start[2]}, feed = 0.0;
    const int in_plane = swarf_block_has(block, "XYZ"[axes[0]]) || swarf_block_has(block, "XYZ"[axes[1]]);
    if (swarf_block_group(block, SWARF_GROUP_NONMODAL) &&
        swarf_block_group(block, SWARF_GROUP_NONMODAL)->value == 530.0)
        return swarf_gcode_fail(machine, swarf_block_group(block, SWARF_GROUP_NONMODAL),
                                "moves in machine coordinates by G0 or G1 only");
    if (machine->comp.leaving) return swarf_gcode_fail(machine, word, "is an arc: the move after G40 must be straight");
    SWARF_TRY(swarf_machine_target(machine, block, end, &any));
    SWARF_TRY(read_centre(machine, block, word, axes, centre, &offsets));
    if (isnan(start[axes[0]]) || isnan(start[axes[1]]))
        return swarf_gcode_fail(machine, word, "arc starts at an unknown position; command %c and %c first",
                                "XYZ"[axes[0]], "XYZ"[axes[1]]);
    const int ccw = machine->modes.motion == 30;
    if (swarf_block_has(block, 'P') && !(block->used & SWARF_LETTER('P')))
        SWARF_TRY(swarf_machine_whole(machine, swarf_block_take(block, 'P'), 1, SWARF_ARC_TURNS_MAX, &turns));
    if (swarf_block_has(block, 'R')) {
        const swarf_word *radius = swarf_block_take(block, 'R');
        if (offsets) return swarf_gcode_fail(machine, radius, "and a centre by I, J, K; an arc takes one of them");
        if (!in_plane)
            return swarf_gcode_fail(machine, radius, "needs an end: %c or %c", "XYZ"[axes[0]], "XYZ"[axes[1]]);
        double r = 0.0, c[2] = {0.0, 0.0};
        SWARF_TRY(swarf_machine_length(machine, radius, &r));
        if (r == 0.0) return swarf_gcode_fail(machine, radius, "radius must not be 0");
        const double from[2] = {start[axes[0]], start[axes[1]]}, to[2] = {end[axes[0]], end[axes[1]]};
        SWARF_TRY(centre_from_radius(machine, radius, from, to, r, ccw, c));
        centre[axes[0]] = c[0];
        centre[axes[1]] = c[1];
    }
    SWARF_TRY(check_radii(machine, word, axes, start, end, centre));
    double length = 0.0;
    if (machine->modes.feed_mode == 930) {
        swarf_path path = {{start[0], start[1], start[2]}, {end[0], end[1], end[2]}, 1, 1, {{0}, 0, 0, 0}};
        if (swarf_arc_make(path.start, path.end, centre, machine->modes.plane, ccw, turns, INFINITY, &path.arc) ==
            SWARF_OK)
            length = swarf_path_length(&path);
    }
    SWARF_TRY(swarf_machine_feed(machine, block, word, length, &feed));
    return swarf_machine_turn(machine, word, end, centre, ccw, turns, feed);
}
