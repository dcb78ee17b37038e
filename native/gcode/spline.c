/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G5 and G5.1: cubic and quadratic Bezier curves in the plane XY, as chords.
 *
 * A chord over a step h of the parameter strays from a curve by at most h^2 / 8 times the largest second derivative;
 * that of a Bezier curve is largest at a corner of its control polygon's second differences. So the number of chords
 * for a given bound is known beforehand.
 */
#include "gcode/machine.h"

#include "base/status.h"

#include <math.h>
#include <string.h>

/* A tenth of what mills can hold; halving it makes 1.4 times as many chords. */
static const double chord_error_mm = 0.001;

/* A curve as long as machines are large needs fewer. */
static const double chords_max = 100000.0;

static swarf_status plane_word(swarf_machine *machine, swarf_block *block, char letter, double *out)
{
    return swarf_machine_length(machine, swarf_block_take(block, letter), out);
}

/* The curve through its control points p[0] .. p[degree]. */
static swarf_status go_along(swarf_machine *machine, swarf_block *block, const swarf_word *word, int degree,
                             double p[4][2])
{
    double bend = 0.0, length = 0.0, feed = 0.0;
    for (int i = 0; i + 2 <= degree; i++)
        bend = fmax(bend, hypot(p[i][0] - 2.0 * p[i + 1][0] + p[i + 2][0], p[i][1] - 2.0 * p[i + 1][1] + p[i + 2][1]));
    bend *= degree * (degree - 1);
    const double wanted = ceil(sqrt(bend / (8.0 * chord_error_mm)));
    if (!(wanted <= chords_max)) return swarf_gcode_fail(machine, word, "is a curve larger than machines are");
    const int chords = wanted < 1.0 ? 1 : (int)wanted;
    for (int i = 0; i < degree; i++) length += hypot(p[i + 1][0] - p[i][0], p[i + 1][1] - p[i][1]);
    SWARF_TRY(swarf_machine_feed(machine, block, word, length, &feed));
    for (int i = 1; i <= chords; i++) {
        const double t = (double)i / chords, u = 1.0 - t;
        double end[SWARF_AXES];
        memcpy(end, machine->position, sizeof end);
        for (int k = 0; k < 2; k++)
            end[k] = i == chords   ? p[degree][k]
                     : degree == 2 ? u * u * p[0][k] + 2.0 * u * t * p[1][k] + t * t * p[2][k]
                                   : u * u * u * p[0][k] + 3.0 * u * u * t * p[1][k] + 3.0 * u * t * t * p[2][k] +
                                         t * t * t * p[3][k];
        SWARF_TRY(swarf_machine_go(machine, word, SWARF_MOVE_FEED, end, feed));
    }
    return SWARF_OK;
}

swarf_status swarf_machine_spline(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    const int cubic = machine->modes.motion == 50;
    if (machine->modes.plane != SWARF_PLANE_XY)
        return swarf_gcode_fail(machine, word, "lies in the plane XY only: G17");
    if (machine->comp.side) return swarf_gcode_fail(machine, word, "cannot be under cutter compensation");
    for (int k = 2; k < SWARF_AXES; k++)
        if (swarf_block_has(block, swarf_axis_letter(k)))
            return swarf_gcode_fail(machine, &block->letters[swarf_axis_letter(k) - 'A'],
                                    "does not belong to a spline; X and Y do");
    double end[SWARF_AXES], p[4][2], i = 0.0, j = 0.0, at_end[2] = {0.0, 0.0};
    int any;
    SWARF_TRY(swarf_machine_target(machine, block, end, &any));
    for (int k = 0; k < 2; k++)
        if (isnan(machine->position[k]))
            return swarf_gcode_fail(machine, word, "starts at an unknown position; command X and Y first");
    const int has_i = swarf_block_has(block, 'I'), has_j = swarf_block_has(block, 'J');
    if (has_i) SWARF_TRY(plane_word(machine, block, 'I', &i));
    if (has_j) SWARF_TRY(plane_word(machine, block, 'J', &j));
    if (cubic) {
        if (!swarf_block_has(block, 'P') || !swarf_block_has(block, 'Q'))
            return swarf_gcode_fail(machine, word, "needs P and Q, from the end to the second control point");
        if (has_i != has_j || (!has_i && !machine->had_spline))
            return swarf_gcode_fail(machine, word, "needs I and J; only after another G5 both may be left out");
        if (!has_i) i = machine->spline[0], j = machine->spline[1];
        SWARF_TRY(plane_word(machine, block, 'P', &at_end[0]));
        SWARF_TRY(plane_word(machine, block, 'Q', &at_end[1]));
    } else if (i == 0.0 && j == 0.0) {
        return swarf_gcode_fail(machine, word, "needs I or J, from the start to the control point");
    }
    const double *start = machine->position;
    const double first[2] = {i, j};
    for (int k = 0; k < 2; k++) {
        p[0][k] = start[k];
        p[1][k] = start[k] + first[k];
        p[2][k] = cubic ? end[k] + at_end[k] : end[k];
        p[3][k] = end[k];
        machine->spline[k] = -at_end[k];
    }
    machine->had_spline = cubic;
    return go_along(machine, block, word, cubic ? 3 : 2, p);
}
