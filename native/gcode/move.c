/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Moves: steps on their way into the program, and the motions that are straight: G0, G1, G33, G38. */
#include "gcode/machine.h"

#include "base/status.h"
#include "program/program.h"

#include <math.h>
#include <string.h>

/* The tip is elsewhere only beyond what rounding of offsets makes. */
static const double same_place_mm = 1e-9;

/* ---- into the program ---- */

static swarf_status settle_section(swarf_machine *machine, const swarf_section *section)
{
    if (machine->is_settled && memcmp(&machine->settled, section, sizeof *section) == 0) return SWARF_OK;
    if (swarf_program_operation_count(machine->program) == 0)
        SWARF_TRY(swarf_program_add_operation(machine->program, "program"));
    SWARF_TRY(swarf_program_set_section(machine->program, section));
    machine->settled = *section;
    machine->is_settled = 1;
    return SWARF_OK;
}

static int all_known(const double p[3])
{
    return !(isnan(p[0]) || isnan(p[1]) || isnan(p[2]));
}

static swarf_status push(swarf_machine *machine, swarf_move_kind kind, const double end[3], const swarf_arc *arc,
                         double value, uint32_t line)
{
    if (!all_known(machine->last_tip) || !all_known(end)) {
        kind = SWARF_MOVE_POSITION;
        arc = NULL;
    }
    const int fed = kind == SWARF_MOVE_FEED || kind == SWARF_MOVE_PROBE;
    SWARF_TRY(swarf_program_push(machine->program, kind, end, arc, fed ? value : 0.0, line));
    memcpy(machine->last_tip, end, sizeof machine->last_tip);
    return SWARF_OK;
}

swarf_status swarf_machine_prepare(swarf_machine *machine, const swarf_word *word, uint32_t line)
{
    if (!machine->frame_stale) return SWARF_OK;
    machine->frame_fixed = 1;
    machine->frame_stale = 0;
    const uint32_t bit = 1u << machine->system;
    const int zero = machine->work[0] == 0.0 && machine->work[1] == 0.0 && machine->work[2] == 0.0;
    if (machine->systems_moved && !(machine->systems_moved & bit) && zero && !machine->machine_known &&
        !(machine->warned & SWARF_WARNED_SYSTEM)) {
        machine->warned |= SWARF_WARNED_SYSTEM;
        SWARF_TRY(swarf_gcode_warn(machine, word,
                                   "moves in work offset %d, whose place is not known: taken to be that of the first; "
                                   "give a parameter file or set it by G10 L2",
                                   machine->system));
    }
    machine->systems_moved |= bit;
    if (machine->has_table && machine->offset[2] != machine->length[2] && !(machine->warned & SWARF_WARNED_LENGTH)) {
        machine->warned |= SWARF_WARNED_LENGTH;
        SWARF_TRY(swarf_gcode_warn(machine, word,
                                   "moves with a tool offset of %.6g mm, but tool T%d is %.6g mm long; the tip is "
                                   "simulated where that puts it",
                                   machine->offset[2], (int)machine->section.tool, machine->length[2]));
    }
    double here[3];
    swarf_machine_tip(machine, machine->position, here);
    int moved = 0;
    for (int k = 0; k < 3; k++) moved |= fabs(here[k] - machine->last_tip[k]) > same_place_mm;
    if (!moved) return SWARF_OK;
    return push(machine, SWARF_MOVE_POSITION, here, NULL, 0.0, line);
}

/* Incremental words add up and offsets as well, so ends are checked beside words. */
static swarf_status check_end(const swarf_machine *machine, const swarf_word *word, const double end[3])
{
    for (int k = 0; k < 3; k++)
        if (fabs(end[k]) > SWARF_COORDINATE_LIMIT_MM)
            return swarf_gcode_fail(machine, word, "leads to %c %g mm; at most %g is possible", "XYZ"[k], end[k],
                                    SWARF_COORDINATE_LIMIT_MM);
    return SWARF_OK;
}

static swarf_status make_arc(const swarf_machine *machine, const swarf_word *word, const swarf_step *step,
                             const double end[3], swarf_arc *out)
{
    double centre[3];
    swarf_machine_tip(machine, step->centre, centre);
    int a, b, n, ccw = step->ccw;
    swarf_plane_axes(machine->modes.plane, &a, &b, &n);
    const swarf_bend *bend = &machine->bend;
    if (!machine->plain && n != 2)
        return swarf_gcode_fail(machine, word, "is an arc in a plane that a rotation of X and Y turns; use G17");
    if (bend->on) {
        if (fabs(bend->factor[a]) != fabs(bend->factor[b]))
            return swarf_gcode_fail(machine, word, "is an arc that unequal scales make an ellipse; give equal scales");
        if ((bend->factor[a] < 0.0) != (bend->factor[b] < 0.0)) ccw = !ccw;
    }
    /* how far the radii may differ was checked in the program's own units when the line was read */
    if (swarf_arc_make(machine->last_tip, end, centre, machine->modes.plane, ccw, step->turns, INFINITY, out) !=
        SWARF_OK)
        return swarf_gcode_fail(machine, word, "%s", swarf_error_last());
    return SWARF_OK;
}

/** A feed that is not simulated, since nothing tells where it begins or ends; said of the first. */
static swarf_status warn_unknown(swarf_machine *machine, const swarf_word *word, const double end[3])
{
    if (machine->warned & SWARF_WARNED_UNKNOWN || (all_known(machine->last_tip) && all_known(end))) return SWARF_OK;
    machine->warned |= SWARF_WARNED_UNKNOWN;
    const double *const unknown = all_known(end) ? machine->last_tip : end;
    char axes[4] = "";
    for (int k = 0, n = 0; k < 3; k++)
        if (isnan(unknown[k])) axes[n++] = "XYZ"[k];
    return swarf_gcode_warn(machine, word,
                            "feeds %s a place whose %s is not known: what it cuts is not simulated; command it before, "
                            "or tell where the tool starts",
                            all_known(end) ? "from" : "to", axes);
}

swarf_status swarf_machine_emit(swarf_machine *machine, const swarf_word *word, const swarf_step *step)
{
    SWARF_TRY(settle_section(machine, &step->section));
    if (step->kind == SWARF_MOVE_DWELL)
        return swarf_program_add_event(machine->program, SWARF_MOVE_DWELL, step->value, step->line);
    SWARF_TRY(swarf_machine_prepare(machine, word, step->line));
    double end[3];
    swarf_machine_tip(machine, step->end, end);
    SWARF_TRY(check_end(machine, word, end));
    swarf_arc arc;
    const int turning = step->is_arc && all_known(machine->last_tip) && all_known(end);
    if (turning) SWARF_TRY(make_arc(machine, word, step, end, &arc));
    if (memcmp(machine->axes_now, step->end + 3, sizeof machine->axes_now) != 0) {
        for (int k = 3; k < SWARF_AXES; k++)
            if (!(fabs(step->end[k]) <= SWARF_COORDINATE_LIMIT_MM))
                return swarf_gcode_fail(machine, word, "leads to %c %g; at most %g is possible", swarf_axis_letter(k),
                                        step->end[k], SWARF_COORDINATE_LIMIT_MM);
        SWARF_TRY(swarf_program_set_axes(machine->program, step->end + 3));
        memcpy(machine->axes_now, step->end + 3, sizeof machine->axes_now);
    }
    if (step->kind == SWARF_MOVE_FEED) SWARF_TRY(warn_unknown(machine, word, end));
    return push(machine, (swarf_move_kind)step->kind, end, turning ? &arc : NULL, step->value, step->line);
}

swarf_step swarf_machine_step(const swarf_machine *machine, swarf_move_kind kind, double value)
{
    swarf_step step;
    memset(&step, 0, sizeof step);
    step.kind = (int)kind;
    step.turns = 1;
    step.value = value;
    step.line = machine->place.line;
    step.section = machine->section;
    memcpy(step.end, machine->position, sizeof step.end);
    return step;
}

static swarf_status send(swarf_machine *machine, const swarf_word *word, const swarf_step *step)
{
    if (machine->comp.side)
        SWARF_TRY(swarf_compensation_add(machine, word, step));
    else
        SWARF_TRY(swarf_machine_emit(machine, word, step));
    machine->comp.leaving = 0;
    memcpy(machine->position, step->end, sizeof machine->position);
    return SWARF_OK;
}

swarf_status swarf_machine_go(swarf_machine *machine, const swarf_word *word, swarf_move_kind kind,
                              const double end[SWARF_AXES], double feed)
{
    swarf_step step = swarf_machine_step(machine, kind, feed);
    memcpy(step.end, end, sizeof step.end);
    return send(machine, word, &step);
}

swarf_status swarf_machine_turn(swarf_machine *machine, const swarf_word *word, const double end[SWARF_AXES],
                                const double centre[3], int ccw, int turns, double feed)
{
    swarf_step step = swarf_machine_step(machine, SWARF_MOVE_FEED, feed);
    memcpy(step.end, end, sizeof step.end);
    memcpy(step.centre, centre, sizeof step.centre);
    step.is_arc = 1;
    step.ccw = ccw;
    step.turns = turns;
    return send(machine, word, &step);
}

swarf_status swarf_machine_dwell(swarf_machine *machine, const swarf_word *word, double seconds)
{
    const swarf_step step = swarf_machine_step(machine, SWARF_MOVE_DWELL, seconds);
    return machine->comp.side ? swarf_compensation_add(machine, word, &step) : swarf_machine_emit(machine, word, &step);
}

/* ---- what straight motions share ---- */

double swarf_machine_distance(const double from[SWARF_AXES], const double to[SWARF_AXES])
{
    static const int order[3] = {0, 6, 3};
    for (int i = 0; i < 3; i++) {
        double sum = 0.0;
        for (int k = order[i]; k < order[i] + 3; k++) sum += (to[k] - from[k]) * (to[k] - from[k]);
        if (sum > 0.0) return sqrt(sum);
    }
    return 0.0;
}

swarf_status swarf_machine_feed(swarf_machine *machine, swarf_block *block, const swarf_word *word, double length,
                                double *out)
{
    const swarf_modes *modes = &machine->modes;
    if (modes->feed_mode == 930 && !swarf_block_has(block, 'F'))
        return swarf_gcode_fail(machine, word, "needs F in its own line under G93");
    if (!(modes->feed > 0.0)) return swarf_gcode_fail(machine, word, "has no feed; write F and the feed first");
    double feed = modes->feed;
    if (modes->feed_mode == 930 && isfinite(length)) feed *= length;
    if (modes->feed_mode == 950) {
        if (modes->surface || !(modes->speed > 0.0))
            return swarf_gcode_fail(machine, word, "has a feed per turn under G95, but no speed; write S first");
        feed *= modes->speed;
    }
    *out = fmin(feed, 1e9);
    return SWARF_OK;
}

/* G53: the axes given are machine coordinates. */
static swarf_status machine_target(swarf_machine *machine, swarf_block *block, const swarf_word *word,
                                   double end[SWARF_AXES])
{
    double absolute[SWARF_AXES], values[SWARF_AXES];
    uint32_t given = 0;
    swarf_machine_absolute(machine, machine->position, absolute);
    for (int k = 0; k < SWARF_AXES; k++) {
        if (!swarf_block_has(block, swarf_axis_letter(k))) continue;
        SWARF_TRY(swarf_machine_axis_word(machine, block, k, &values[k]));
        absolute[k] = values[k];
        given |= 1u << k;
    }
    swarf_machine_relative(machine, absolute, end);
    if (machine->machine_known) return SWARF_OK;
    for (int k = 0; k < 3; k++)
        if (given >> k & 1u) end[k] = NAN;
    if (machine->warned & SWARF_WARNED_MACHINE || !(given & 7u)) return SWARF_OK;
    machine->warned |= SWARF_WARNED_MACHINE;
    return swarf_gcode_warn(machine, word,
                            "moves in machine coordinates, which are not known here: what it passes is not simulated; "
                            "give a parameter file");
}

swarf_status swarf_machine_target(swarf_machine *machine, swarf_block *block, double end[SWARF_AXES], int *any)
{
    *any = 0;
    memcpy(end, machine->position, SWARF_AXES * sizeof *end);
    const uint32_t given = block->given & ~block->used & SWARF_AXIS_LETTERS;
    if (!given) return SWARF_OK;
    *any = 1;
    const swarf_word *absolute = swarf_block_group(block, SWARF_GROUP_NONMODAL);
    if (absolute && absolute->value == 530.0) return machine_target(machine, block, absolute, end);
    const uint32_t linear = SWARF_LETTER('X') | SWARF_LETTER('Y') | SWARF_LETTER('Z');
    for (int k = 0; k < ((given & ~linear) ? SWARF_AXES : 3); k++) {
        const char letter = swarf_axis_letter(k);
        if (!(given & SWARF_LETTER(letter))) continue;
        double value = 0.0;
        SWARF_TRY(swarf_machine_axis_word(machine, block, k, &value));
        if (machine->modes.incremental && isnan(end[k]))
            return swarf_gcode_fail(machine, &block->letters[letter - 'A'],
                                    "is a step from an unknown position; command %c under G90 first", letter);
        end[k] = machine->modes.incremental ? end[k] + value : value;
    }
    return SWARF_OK;
}

swarf_status swarf_machine_straight(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    double end[SWARF_AXES], feed = 0.0;
    int any;
    SWARF_TRY(swarf_machine_target(machine, block, end, &any));
    const swarf_move_kind kind = machine->modes.motion == 0 ? SWARF_MOVE_RAPID : SWARF_MOVE_FEED;
    if (kind == SWARF_MOVE_FEED) {
        const double length = machine->modes.feed_mode == 930 ? swarf_machine_distance(machine->position, end) : 0.0;
        SWARF_TRY(swarf_machine_feed(machine, block, word, length, &feed));
    }
    return swarf_machine_go(machine, word, kind, end, feed);
}

/* ---- G38 ---- */

swarf_status swarf_machine_probe(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    double end[SWARF_AXES], feed = 0.0;
    int any;
    if (machine->comp.side) return swarf_gcode_fail(machine, word, "cannot probe under cutter compensation");
    SWARF_TRY(swarf_machine_target(machine, block, end, &any));
    if (!any) return swarf_gcode_fail(machine, word, "needs a place to probe to");
    int same = 1;
    for (int k = 0; k < SWARF_AXES; k++) same = same && end[k] == machine->position[k];
    if (same) return swarf_gcode_fail(machine, word, "probes to where the tool stands");
    SWARF_TRY(swarf_machine_feed(machine, block, word, swarf_machine_distance(machine->position, end), &feed));
    if (!(machine->warned & SWARF_WARNED_PROBE)) {
        machine->warned |= SWARF_WARNED_PROBE;
        SWARF_TRY(swarf_gcode_warn(machine, word, "what a probe finds is not known here: taken to be its end"));
    }
    SWARF_TRY(swarf_machine_go(machine, word, SWARF_MOVE_PROBE, end, feed));
    for (int k = 0; k < SWARF_AXES; k++) machine->parameters.numbered[5061 + k] = end[k];
    machine->parameters.numbered[5070] = 1.0;
    return SWARF_OK;
}

/* ---- G33, G33.1 ---- */

swarf_status swarf_machine_synchronized(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    double end[SWARF_AXES], pitch = 0.0, back = 1.0;
    double start[SWARF_AXES];
    int any;
    memcpy(start, machine->position, sizeof start);
    SWARF_TRY(swarf_machine_target(machine, block, end, &any));
    if (!any) return swarf_gcode_fail(machine, word, "needs a place to go to");
    if (!swarf_block_has(block, 'K')) return swarf_gcode_fail(machine, word, "needs K, the way per turn");
    const swarf_word *k = swarf_block_take(block, 'K');
    SWARF_TRY(swarf_machine_length(machine, k, &pitch));
    if (!(pitch > 0.0)) return swarf_gcode_fail(machine, k, "must be positive: the way per turn");
    if (swarf_block_has(block, 'F'))
        return swarf_gcode_fail(machine, &block->letters['F' - 'A'], "has no meaning here: K and S make the feed");
    const double speed = machine->modes.surface ? 0.0 : machine->modes.speed;
    if (machine->modes.spindle == SWARF_SPINDLE_OFF || !(speed > 0.0))
        return swarf_gcode_fail(machine, word, "needs a turning spindle; write M3 and S first");
    if (machine->modes.motion == 331 && swarf_block_has(block, 'I')) {
        back = fmax(1.0, swarf_block_take(block, 'I')->value);
    }
    SWARF_TRY(swarf_machine_go(machine, word, SWARF_MOVE_FEED, end, fmin(pitch * speed, 1e9)));
    if (machine->modes.motion == 330) return SWARF_OK;
    machine->section.spindle = machine->modes.spindle == SWARF_SPINDLE_CW ? SWARF_SPINDLE_CCW : SWARF_SPINDLE_CW;
    machine->section.spindle_rpm = speed * back;
    SWARF_TRY(swarf_machine_go(machine, word, SWARF_MOVE_FEED, start, fmin(pitch * speed * back, 1e9)));
    machine->section.spindle = machine->modes.spindle;
    machine->section.spindle_rpm = speed;
    return SWARF_OK;
}
