/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Drilling cycles, expanded into the moves the machine makes (LinuxCNC's G-code reference, "Canned Cycles"):
 * over to the hole, rapid down to R, the hole itself, out to R (G99) or to where the series began (G98).
 *
 *     G81  feed to Z, rapid out              G85  feed to Z, feed out to R, rapid on
 *     G82  the same with a dwell at Z        G89  feed to Z, dwell, feed out
 *     G83  pecks of Q, each out to R and back to 0.254 mm above the last depth
 *     G73  pecks of Q, each 0.254 mm back up to break the chip
 *     G84  feed to Z, reverse, dwell, feed out, reverse again; G74 the same for left-handed threads
 *     G86  feed to Z, dwell, stop, rapid out, start again
 *
 * They drill along the normal of the current plane. Under G91 X and Y are steps that L repeats, R counts from the
 * height at which the series began and Z from R. Z, R, Q and P hold while the same cycle is used.
 */
#include "gcode/machine.h"

#include "base/status.h"
#include "program/arc.h"

#include <math.h>
#include <string.h>

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
        if (letter == 'P') /* Fanuc counts milliseconds */
            *value = machine->dialect->k_repeats && given->whole ? given->value * 1e-3 : given->value;
        else
            SWARF_TRY(swarf_machine_length(machine, given, value));
        if (letter == 'Q' && !(*value > 0.0))
            return swarf_gcode_fail(machine, given, "must be positive: the depth of a peck");
        if (letter == 'P' && !(*value >= 0.0)) return swarf_gcode_fail(machine, given, "must not be negative");
        cycle->known |= SWARF_LETTER(letter);
    } else if (!(cycle->known & SWARF_LETTER(letter))) {
        const char *what = letter == 'R'   ? "the height to which it goes in rapid"
                           : letter == 'Q' ? "the depth of a peck"
                           : letter == 'P' ? "the seconds to wait"
                                           : "the bottom of the hole";
        return swarf_gcode_fail(machine, word, "starts a cycle that needs %c, %s", letter, what);
    }
    return SWARF_OK;
}

/* One hole's worth of moves: where it is and what an error points at. */
typedef struct hole {
    swarf_machine *machine;
    const swarf_word *word;
    int normal;
    double r, z, clear, chip, feed;
} hole;

static swarf_status along(const hole *h, swarf_move_kind kind, double level)
{
    const double *p = h->machine->position;
    double end[SWARF_AXES];
    memcpy(end, p, sizeof end);
    end[h->normal] = level;
    if (kind == SWARF_MOVE_RAPID && p[h->normal] == level) return SWARF_OK;
    return swarf_machine_go(h->machine, h->word, kind, end, h->feed);
}

static void turn_spindle(const hole *h, int spindle)
{
    h->machine->section.spindle = spindle;
}

static swarf_status tap(const hole *h)
{
    const int before = h->machine->section.spindle;
    SWARF_TRY(along(h, SWARF_MOVE_FEED, h->z));
    turn_spindle(h, before == SWARF_SPINDLE_CW ? SWARF_SPINDLE_CCW : SWARF_SPINDLE_CW);
    if (h->machine->cycle.seconds > 0.0) SWARF_TRY(swarf_machine_dwell(h->machine, h->word, h->machine->cycle.seconds));
    SWARF_TRY(along(h, SWARF_MOVE_FEED, h->clear));
    turn_spindle(h, before);
    return SWARF_OK;
}

static swarf_status drill(const hole *h)
{
    const int motion = h->machine->modes.motion, deep = motion == 830;
    const double q = h->machine->cycle.q, seconds = h->machine->cycle.seconds;
    if (motion == 740 || motion == 840) return tap(h);
    if (deep || motion == 730) {
        for (int peck = 1;; peck++) {
            const double depth = h->r - peck * q;
            if (!(depth > h->z + least_peck_mm)) break;
            SWARF_TRY(along(h, SWARF_MOVE_FEED, depth));
            if (deep) SWARF_TRY(along(h, SWARF_MOVE_RAPID, h->r));
            SWARF_TRY(along(h, SWARF_MOVE_RAPID, fmin(h->r, depth + h->chip)));
        }
    }
    SWARF_TRY(along(h, SWARF_MOVE_FEED, h->z));
    if (motion == 820 || motion == 860 || motion == 890) SWARF_TRY(swarf_machine_dwell(h->machine, h->word, seconds));
    const int before = h->machine->section.spindle;
    if (motion == 860) turn_spindle(h, SWARF_SPINDLE_OFF);
    if (motion == 850) SWARF_TRY(along(h, SWARF_MOVE_FEED, h->r));
    SWARF_TRY(along(h, motion == 890 ? SWARF_MOVE_FEED : SWARF_MOVE_RAPID, h->clear));
    turn_spindle(h, before);
    return SWARF_OK;
}

/* Places in the plane: where the first hole is and the step to the next one. */
static swarf_status read_place(swarf_machine *machine, swarf_block *block, const swarf_word *word, const int axes[2],
                               double place[2], double step[2])
{
    for (int i = 0; i < 2; i++) {
        const char letter = "XYZ"[axes[i]];
        const double here = machine->position[axes[i]];
        place[i] = here;
        step[i] = 0.0;
        if (swarf_block_has(block, letter)) {
            double value = 0.0;
            SWARF_TRY(swarf_machine_axis_word(machine, block, axes[i], &value));
            if (machine->modes.incremental) step[i] = value;
            place[i] = machine->modes.incremental ? here + value : value;
        }
        if (isnan(place[i]))
            return swarf_gcode_fail(machine, word, "starts a cycle at an unknown place; give %c%s", letter,
                                    machine->modes.incremental ? " under G90 first" : "");
    }
    return SWARF_OK;
}

/* What the cycle of this line needs and remembers. */
static swarf_status read_words(swarf_machine *machine, swarf_block *block, const swarf_word *word, char depth_letter)
{
    swarf_cycle *cycle = &machine->cycle;
    const int motion = machine->modes.motion;
    if (!cycle->active || cycle->last != motion) cycle->known = 0;
    if (!cycle->active) cycle->initial = machine->position[depth_letter - 'X'];
    cycle->active = 1;
    cycle->last = motion;
    SWARF_TRY(remember(machine, block, word, depth_letter, &cycle->z));
    SWARF_TRY(remember(machine, block, word, 'R', &cycle->r));
    if (motion == 730 || motion == 830) SWARF_TRY(remember(machine, block, word, 'Q', &cycle->q));
    if (motion == 740 || motion == 840) {
        if (!(cycle->known & SWARF_LETTER('P'))) cycle->seconds = 0.0;
        if (swarf_block_has(block, 'P')) SWARF_TRY(remember(machine, block, word, 'P', &cycle->seconds));
    }
    if (motion == 820 || motion == 860 || motion == 890)
        SWARF_TRY(remember(machine, block, word, 'P', &cycle->seconds));
    return SWARF_OK;
}

static swarf_status check_state(const swarf_machine *machine, const swarf_block *block, const swarf_word *word)
{
    const int motion = machine->modes.motion, spindle = machine->modes.spindle;
    if (machine->comp.side) return swarf_gcode_fail(machine, word, "cycle cannot be under cutter compensation");
    if (machine->modes.feed_mode == 930) return swarf_gcode_fail(machine, word, "cycle cannot be under G93");
    for (int k = 3; k < SWARF_AXES; k++)
        if (swarf_block_has(block, swarf_axis_letter(k)))
            return swarf_gcode_fail(machine, &block->letters[swarf_axis_letter(k) - 'A'],
                                    "does not belong to a cycle; X, Y and Z do");
    if (!(swarf_block_has(block, 'X') || swarf_block_has(block, 'Y') || swarf_block_has(block, 'Z')))
        return swarf_gcode_fail(machine, word, "starts a cycle without a place; give X, Y or Z");
    if (motion == 840 && spindle != SWARF_SPINDLE_CW)
        return swarf_gcode_fail(machine, word, "taps a right-handed thread: the spindle must turn by M3");
    if (motion == 740 && spindle != SWARF_SPINDLE_CCW)
        return swarf_gcode_fail(machine, word, "taps a left-handed thread: the spindle must turn by M4");
    if (motion == 860 && spindle == SWARF_SPINDLE_OFF)
        return swarf_gcode_fail(machine, word, "bores with a turning spindle; write M3 or M4 first");
    return SWARF_OK;
}

swarf_status swarf_machine_drill(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    swarf_cycle *cycle = &machine->cycle;
    int axes[3], repeats = 1;
    swarf_plane_axes(machine->modes.plane, &axes[0], &axes[1], &axes[2]);
    const int n = axes[2];
    const char depth_letter = (char)('X' + n), repeat_letter = machine->dialect->k_repeats ? 'K' : 'L';
    SWARF_TRY(check_state(machine, block, word));
    SWARF_TRY(read_words(machine, block, word, depth_letter));
    if (swarf_block_has(block, repeat_letter))
        SWARF_TRY(swarf_machine_whole(machine, swarf_block_take(block, repeat_letter), 1, REPEATS_MAX, &repeats));
    double centre[2], step[2];
    SWARF_TRY(read_place(machine, block, word, axes, centre, step));

    hole h = {machine, word, n, cycle->r, cycle->z, 0.0, machine->dialect->chip_retract_mm, 0.0};
    SWARF_TRY(swarf_machine_feed(machine, block, word, 0.0, &h.feed));
    const int pecks = machine->modes.motion == 730 || machine->modes.motion == 830;
    if (pecks && swarf_block_has(block, 'D')) {
        SWARF_TRY(swarf_machine_length(machine, swarf_block_take(block, 'D'), &h.chip));
        h.chip = fmax(0.0, h.chip);
    }
    if (machine->modes.incremental) {
        if (isnan(cycle->initial))
            return swarf_gcode_fail(machine, word, "starts a cycle under G91 at an unknown height; move %c first",
                                    depth_letter);
        h.r += cycle->initial;
        h.z += h.r;
    }
    h.clear = !machine->modes.retract_to_r && cycle->initial > h.r ? cycle->initial : h.r;
    if (h.z > h.r)
        return swarf_gcode_fail(machine, word, "cycle ends at %.6g mm, above R at %.6g mm; R must be above %c", h.z,
                                h.r, depth_letter);
    if (pecks && (h.r - h.z) / cycle->q * repeats > PECKS_MAX)
        return swarf_gcode_fail(machine, word, "makes more than %d pecks of Q %.6g mm", PECKS_MAX, cycle->q);

    if (!(machine->position[n] >= h.r)) SWARF_TRY(along(&h, SWARF_MOVE_RAPID, h.r));
    for (int i = 0; i < repeats; i++) {
        double over[SWARF_AXES];
        memcpy(over, machine->position, sizeof over);
        for (int k = 0; k < 2; k++) over[axes[k]] = centre[k] + i * step[k];
        if (over[axes[0]] != machine->position[axes[0]] || over[axes[1]] != machine->position[axes[1]])
            SWARF_TRY(swarf_machine_go(machine, word, SWARF_MOVE_RAPID, over, 0.0));
        SWARF_TRY(along(&h, SWARF_MOVE_RAPID, h.r));
        SWARF_TRY(drill(&h));
    }
    return SWARF_OK;
}
