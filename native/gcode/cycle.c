/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Drilling cycles, expanded into the moves the machine makes (LinuxCNC's G-code reference, "Canned Cycles"):
 * over to the hole, rapid down to R, the hole itself, out to R (G99) or to where the series began (G98).
 *
 *     G81  feed to Z, rapid out              G85  feed to Z, feed out
 *     G82  the same with a dwell at Z        G89  the same with a dwell at Z
 *     G83  pecks of Q, each out to R and back to 0.254 mm above the last depth
 *     G73  pecks of Q, each 0.254 mm back up to break the chip
 *
 * They drill along the normal of the current plane. Under G91 X and Y are steps that L repeats, R counts from the
 * height at which the series began and Z from R. Z, R, Q and P hold until a line leaves the cycles.
 */
#include "gcode/machine.h"

#include "base/status.h"
#include "program/arc.h"

#include <math.h>

/* LinuxCNC's 0.010 inch. */
static const double chip_retract_mm = 0.254;

/* A last peck thinner than this is rounding of R - n Q, not a peck. */
static const double least_peck_mm = 1e-6;

/* One line can ask for no more: a slip like Q.0001 must not fill the memory. */
enum { REPEATS_MAX = 10000, PECKS_MAX = 100000 };

/* A word of the cycle: from this line, else from the series. */
static swarf_status remember(swarf_machine *machine, swarf_block *block, const swarf_word *word, char letter,
                             double *value)
{
    swarf_cycle *cycle = &machine->cycle;
    const int taken = letter == 'P' && (block->used & SWARF_LETTER('P')); /* by G4 or G64 */
    if (swarf_block_has(block, letter) && !taken) {
        const swarf_word *given = swarf_block_take(block, letter);
        if (letter == 'P')
            *value = given->value;
        else
            SWARF_TRY(swarf_machine_length(machine, block, given, value));
        if (letter == 'Q' && !(*value > 0.0))
            return swarf_gcode_fail(&machine->place, block, given, "must be positive: the depth of a peck");
        if (letter == 'P' && !(*value >= 0.0))
            return swarf_gcode_fail(&machine->place, block, given, "must not be negative");
        cycle->known |= SWARF_LETTER(letter);
    } else if (!(cycle->known & SWARF_LETTER(letter))) {
        const char *what = letter == 'R'   ? "the height to which it goes in rapid"
                           : letter == 'Q' ? "the depth of a peck"
                           : letter == 'P' ? "the seconds to wait"
                                           : "the bottom of the hole";
        return swarf_gcode_fail(&machine->place, block, word, "starts a cycle that needs %c, %s", letter, what);
    }
    return SWARF_OK;
}

/* One hole's worth of moves: where it is and what an error points at. */
typedef struct hole {
    swarf_machine *machine;
    const swarf_block *block;
    const swarf_word *word;
    int normal;
    double r, z, clear;
} hole;

static swarf_status along(const hole *h, swarf_move_kind kind, double level)
{
    const double *p = h->machine->position;
    double end[3] = {p[0], p[1], p[2]};
    end[h->normal] = level;
    if (kind == SWARF_MOVE_RAPID && p[h->normal] == level) return SWARF_OK;
    return swarf_machine_go(h->machine, h->block, h->word, kind, end);
}

static swarf_status drill(const hole *h)
{
    const int motion = h->machine->motion, deep = motion == 830;
    const double q = h->machine->cycle.q;
    if (deep || motion == 730) {
        for (int peck = 1;; peck++) {
            const double depth = h->r - peck * q;
            if (!(depth > h->z + least_peck_mm)) break;
            SWARF_TRY(along(h, SWARF_MOVE_FEED, depth));
            if (deep) SWARF_TRY(along(h, SWARF_MOVE_RAPID, h->r));
            SWARF_TRY(along(h, SWARF_MOVE_RAPID, fmin(h->r, depth + chip_retract_mm)));
        }
    }
    SWARF_TRY(along(h, SWARF_MOVE_FEED, h->z));
    if (motion == 820 || motion == 890) SWARF_TRY(swarf_machine_dwell(h->machine, h->machine->cycle.seconds));
    return along(h, motion == 850 || motion == 890 ? SWARF_MOVE_FEED : SWARF_MOVE_RAPID, h->clear);
}

/* Places in the plane: where the first hole is and the step to the next one. */
static swarf_status read_place(swarf_machine *machine, swarf_block *block, const swarf_word *word, const int axes[2],
                               double place[2], double step[2])
{
    for (int i = 0; i < 2; i++) {
        const char letter = (char)('X' + axes[i]);
        const double here = machine->position[axes[i]];
        place[i] = here;
        step[i] = 0.0;
        if (swarf_block_has(block, letter)) {
            double value = 0.0;
            SWARF_TRY(swarf_machine_length(machine, block, swarf_block_take(block, letter), &value));
            if (machine->incremental) step[i] = value;
            place[i] = machine->incremental ? here + value : value;
        }
        if (isnan(place[i]))
            return swarf_gcode_fail(&machine->place, block, word, "starts a cycle at an unknown place; give %c%s",
                                    letter, machine->incremental ? " under G90 first" : "");
    }
    return SWARF_OK;
}

swarf_status swarf_machine_drill(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    const swarf_place *place = &machine->place;
    swarf_cycle *cycle = &machine->cycle;
    int axes[3];
    swarf_plane_axes(machine->plane, &axes[0], &axes[1], &axes[2]);
    const int n = axes[2];
    if (!(swarf_block_has(block, 'X') || swarf_block_has(block, 'Y') || swarf_block_has(block, 'Z')))
        return swarf_gcode_fail(place, block, word, "starts a cycle without a place; give X, Y or Z");
    if (!cycle->active) {
        cycle->active = 1;
        cycle->known = 0;
        cycle->initial = machine->position[n];
    }
    const char depth_letter = (char)('X' + n);
    SWARF_TRY(remember(machine, block, word, depth_letter, &cycle->z));
    SWARF_TRY(remember(machine, block, word, 'R', &cycle->r));
    const int pecks = machine->motion == 730 || machine->motion == 830;
    if (pecks) SWARF_TRY(remember(machine, block, word, 'Q', &cycle->q));
    if (machine->motion == 820 || machine->motion == 890)
        SWARF_TRY(remember(machine, block, word, 'P', &cycle->seconds));
    int repeats = 1;
    if (swarf_block_has(block, 'L'))
        SWARF_TRY(swarf_machine_whole(machine, block, swarf_block_take(block, 'L'), 1, REPEATS_MAX, &repeats));
    double centre[2], step[2];
    SWARF_TRY(read_place(machine, block, word, axes, centre, step));

    hole h = {machine, block, word, n, cycle->r, cycle->z, 0.0};
    if (machine->incremental) {
        if (isnan(cycle->initial))
            return swarf_gcode_fail(place, block, word, "starts a cycle under G91 at an unknown height; move %c first",
                                    depth_letter);
        h.r += cycle->initial;
        h.z += h.r;
    }
    h.clear = !machine->retract_to_r && cycle->initial > h.r ? cycle->initial : h.r;
    if (h.z > h.r)
        return swarf_gcode_fail(place, block, word, "cycle ends at %.6g mm, above R at %.6g mm; R must be above %c",
                                h.z, h.r, depth_letter);
    if (pecks && (h.r - h.z) / cycle->q * repeats > PECKS_MAX)
        return swarf_gcode_fail(place, block, word, "makes more than %d pecks of Q %.6g mm", PECKS_MAX, cycle->q);

    if (!(machine->position[n] >= h.r)) SWARF_TRY(along(&h, SWARF_MOVE_RAPID, h.r));
    for (int i = 0; i < repeats; i++) {
        double over[3] = {machine->position[0], machine->position[1], machine->position[2]};
        for (int k = 0; k < 2; k++) over[axes[k]] = centre[k] + i * step[k];
        if (over[axes[0]] != machine->position[axes[0]] || over[axes[1]] != machine->position[axes[1]])
            SWARF_TRY(swarf_machine_go(machine, block, word, SWARF_MOVE_RAPID, over));
        SWARF_TRY(along(&h, SWARF_MOVE_RAPID, h.r));
        SWARF_TRY(drill(&h));
    }
    return SWARF_OK;
}
