/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G2 and G3: the centre from I J K or from R. */
#include "gcode/machine.h"

#include "base/status.h"
#include "program/program.h"

#include <math.h>

/* The centre of an arc of radius |r| between two points: left of the way for ccw and r > 0 (the shorter arc), on the
 * other side for either alone. Fails unless the points are at most 2 |r| apart. */
static swarf_status centre_from_radius(const swarf_machine *machine, const swarf_block *block, const swarf_word *word,
                                       const double from[2], const double to[2], double r, int ccw, double out[2])
{
    const double d[2] = {to[0] - from[0], to[1] - from[1]};
    const double chord = hypot(d[0], d[1]), half = 0.5 * chord, radius = fabs(r);
    if (!(chord > 1e-6))
        return swarf_gcode_fail(&machine->place, block, word,
                                "makes no arc between equal points; a full circle needs its centre by I, J or K");
    if (radius < half - swarf_arc_tolerance(half))
        return swarf_gcode_fail(&machine->place, block, word,
                                "is too small: the ends are %.6g mm apart, so R must be at least %.6g", chord,
                                half / machine->unit_mm);
    const double height = radius > half ? sqrt((radius - half) * (radius + half)) : 0.0;
    const double side = (r > 0.0) == (ccw != 0) ? height : -height;
    out[0] = from[0] + 0.5 * d[0] - side * d[1] / chord;
    out[1] = from[1] + 0.5 * d[1] + side * d[0] / chord;
    return SWARF_OK;
}

swarf_status swarf_machine_arc(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    const swarf_place *place = &machine->place;
    int axes[3]; /* first, second, normal */
    swarf_plane_axes(machine->plane, &axes[0], &axes[1], &axes[2]);
    const double *start = machine->position;
    double end[3] = {start[0], start[1], start[2]}, centre[3] = {start[0], start[1], start[2]};
    int in_plane = 0, offsets = 0;
    for (int i = 0; i < 3; i++) {
        const int k = axes[i];
        const char letter = (char)('X' + k), offset_letter = (char)('I' + k);
        if (swarf_block_has(block, letter)) {
            const swarf_word *axis = swarf_block_take(block, letter);
            double value = 0.0;
            SWARF_TRY(swarf_machine_length(machine, block, axis, &value));
            if (machine->incremental && isnan(start[k]))
                return swarf_gcode_fail(place, block, axis,
                                        "is a step from an unknown position; command %c under G90 first", letter);
            end[k] = machine->incremental ? start[k] + value : value;
            in_plane += i < 2;
        }
        if (i < 2 && swarf_block_has(block, offset_letter)) {
            double value = 0.0;
            SWARF_TRY(swarf_machine_length(machine, block, swarf_block_take(block, offset_letter), &value));
            centre[k] = machine->arc_absolute ? value : start[k] + value;
            offsets++;
        }
    }
    const char first = "XYZ"[axes[0]], second = "XYZ"[axes[1]];
    if (isnan(start[axes[0]]) || isnan(start[axes[1]]))
        return swarf_gcode_fail(place, block, word, "arc starts at an unknown position; command %c and %c first", first,
                                second);
    const int ccw = machine->motion == 30;
    int turns = 1;
    if (swarf_block_has(block, 'P') && !(block->used & SWARF_LETTER('P')))
        SWARF_TRY(swarf_machine_whole(machine, block, swarf_block_take(block, 'P'), 1, SWARF_ARC_TURNS_MAX, &turns));
    if (swarf_block_has(block, 'R')) {
        const swarf_word *radius = swarf_block_take(block, 'R');
        if (offsets) return swarf_gcode_fail(place, block, radius, "and a centre by I, J, K; an arc takes one of them");
        if (!in_plane) return swarf_gcode_fail(place, block, radius, "needs an end: %c or %c", first, second);
        double r = 0.0, c[2] = {0.0, 0.0};
        SWARF_TRY(swarf_machine_length(machine, block, radius, &r));
        if (r == 0.0) return swarf_gcode_fail(place, block, radius, "radius must not be 0");
        const double from[2] = {start[axes[0]], start[axes[1]]}, to[2] = {end[axes[0]], end[axes[1]]};
        SWARF_TRY(centre_from_radius(machine, block, radius, from, to, r, ccw, c));
        centre[axes[0]] = c[0];
        centre[axes[1]] = c[1];
    } else if (offsets < (machine->arc_absolute ? 2 : 1)) {
        return swarf_gcode_fail(place, block, word, "arc needs a centre by %c %s %c%s, or R", 'I' + axes[0],
                                machine->arc_absolute ? "and" : "or", 'I' + axes[1],
                                machine->arc_absolute ? " (both under G90.1)" : "");
    }
    swarf_arc arc;
    if (swarf_arc_make(start, end, centre, machine->plane, ccw, turns, &arc) != SWARF_OK)
        return swarf_gcode_fail(place, block, word, "%s", swarf_error_last());
    return swarf_machine_turn(machine, block, word, end, &arc);
}
