/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Offsets: tool length, work offsets, G92 and G52, scale and rotation, reference positions. The machine stands still
 * while they change.
 */
#include "gcode/machine.h"

#include "base/memory.h"
#include "base/status.h"

#include <math.h>
#include <string.h>

/* Run `change` with the machine standing still. */
#define KEEPING_STILL(machine, change)                                                                                 \
    do {                                                                                                               \
        double absolute_[SWARF_AXES];                                                                                  \
        swarf_machine_absolute(machine, (machine)->position, absolute_);                                               \
        change;                                                                                                        \
        swarf_machine_relative(machine, absolute_, (machine)->position);                                               \
        swarf_machine_reframe(machine);                                                                                \
    } while (0)

static swarf_status need_no_compensation(const swarf_machine *machine, const swarf_word *word)
{
    if (!machine->comp.side) return SWARF_OK;
    return swarf_gcode_fail(machine, word, "cannot be under cutter compensation; write G40 first");
}

/* ---- G43 G43.1 G43.2 G49 ---- */

/* The offset of tool `number`, which the word `given` names (NULL: the loaded one is meant). */
static swarf_status offset_of(const swarf_machine *machine, const swarf_word *word, const swarf_word *given, int number,
                              double out[SWARF_AXES])
{
    memset(out, 0, SWARF_AXES * sizeof *out);
    const swarf_gcode_tool *row = swarf_machine_find_tool(machine, number);
    if (row) {
        memcpy(out, row->offset, sizeof row->offset);
        return SWARF_OK;
    }
    if (number <= 0) return SWARF_OK; /* no tool: no offset */
    if (machine->has_table)
        return swarf_gcode_fail(machine, given ? given : word, "names tool T%d, which is not in the tool table",
                                number);
    if (number == machine->section.tool) return SWARF_OK; /* the tip is what is programmed */
    if (machine->section.tool < 0)
        return swarf_gcode_fail(machine, given, "is a tool's offset but no tool is loaded; load it by T%d M6 first",
                                number);
    return swarf_gcode_fail(machine, given,
                            "is not the offset of the loaded tool, H%d is; give a tool table for others",
                            (int)machine->section.tool);
}

static swarf_status run_length(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_LENGTH);
    if (!word) return SWARF_OK;
    double offset[SWARF_AXES];
    memset(offset, 0, sizeof offset);
    const int code = (int)word->value;
    const swarf_word *h = NULL;
    int number = machine->section.tool < 0 ? 0 : machine->section.tool, axes = 0;
    if ((code == 430 || code == 432) && swarf_block_has(block, 'H')) {
        h = swarf_block_take(block, 'H');
        SWARF_TRY(swarf_machine_whole(machine, h, 0, 99999, &number));
        if (number == 0) number = machine->section.tool < 0 ? 0 : machine->section.tool;
    }
    if (code == 431 || code == 432) {
        if (code == 431) memcpy(offset, machine->offset, sizeof offset);
        if (swarf_block_group(block, SWARF_GROUP_MOTION))
            return swarf_gcode_fail(machine, word, "takes the axis words; a motion cannot share its line");
        for (int k = 0; k < SWARF_AXES; k++) {
            if (!swarf_block_has(block, swarf_axis_letter(k))) continue;
            SWARF_TRY(swarf_machine_axis_word(machine, block, k, &offset[k]));
            axes = 1;
        }
        if (code == 431 ? !axes : (axes != 0) == (h != NULL))
            return swarf_gcode_fail(machine, word,
                                    code == 431 ? "needs the offset, by axis words"
                                                : "needs H, a tool's number, or axis words, not both");
    }
    if (code == 430 || h) SWARF_TRY(offset_of(machine, word, h, number, offset));
    if (code == 432)
        for (int k = 0; k < SWARF_AXES; k++) offset[k] += machine->offset[k];
    if (memcmp(offset, machine->offset, sizeof offset) == 0) return SWARF_OK;
    SWARF_TRY(need_no_compensation(machine, word));
    KEEPING_STILL(machine, memcpy(machine->offset, offset, sizeof offset));
    return SWARF_OK;
}

/* ---- G50 G51 G68 G69 ---- */

static swarf_status run_scale(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_SCALE);
    if (!word) return SWARF_OK;
    SWARF_TRY(need_no_compensation(machine, word));
    swarf_bend bend = machine->bend;
    const int by_p = swarf_block_has(block, 'P'),
              by_ijk = block->given & (SWARF_LETTER('I') | SWARF_LETTER('J') | SWARF_LETTER('K'));
    for (int k = 0; k < 3; k++) bend.factor[k] = 1.0, bend.scale_centre[k] = 0.0;
    if (word->value == 510.0) {
        for (int k = 0; k < 3; k++) {
            if (swarf_block_has(block, swarf_axis_letter(k))) {
                if (by_p || by_ijk) /* Fanuc: the centre; Mach3: the factor */
                    SWARF_TRY(swarf_machine_axis_word(machine, block, k, &bend.scale_centre[k]));
                else
                    bend.factor[k] = swarf_block_take(block, swarf_axis_letter(k))->value;
            }
            if (by_p) bend.factor[k] = swarf_block_take(block, 'P')->value;
            if (by_ijk && swarf_block_has(block, "IJK"[k])) bend.factor[k] = swarf_block_take(block, "IJK"[k])->value;
            if (!(fabs(bend.factor[k]) >= 1e-3 && fabs(bend.factor[k]) <= 1e3))
                return swarf_gcode_fail(machine, word, "scales %c by %g; 0.001 to 1000 are possible",
                                        swarf_axis_letter(k), bend.factor[k]);
        }
    }
    int on = bend.angle != 0.0;
    for (int k = 0; k < 3; k++) on |= bend.factor[k] != 1.0;
    bend.on = on;
    KEEPING_STILL(machine, (machine->bend = bend, swarf_machine_reframe(machine)));
    return SWARF_OK;
}

static swarf_status run_turn(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_TURN);
    if (!word) return SWARF_OK;
    SWARF_TRY(need_no_compensation(machine, word));
    swarf_bend bend = machine->bend;
    bend.angle = 0.0;
    if (word->value == 680.0) {
        if (machine->modes.plane != SWARF_PLANE_XY)
            return swarf_gcode_fail(machine, word, "turns the plane XY only; write G17 first");
        if (!swarf_block_has(block, 'R')) return swarf_gcode_fail(machine, word, "needs R, the angle in degrees");
        bend.angle = swarf_block_take(block, 'R')->value;
        for (int k = 0; k < 2; k++) {
            const char letter = swarf_block_has(block, "AB"[k]) && machine->dialect->k_repeats == 0 ? "AB"[k] : "XY"[k];
            bend.turn_centre[k] = machine->position[k];
            if (swarf_block_has(block, letter))
                SWARF_TRY(swarf_machine_length(machine, swarf_block_take(block, letter), &bend.turn_centre[k]));
            if (isnan(bend.turn_centre[k]))
                return swarf_gcode_fail(machine, word, "turns about an unknown place; give X and Y");
        }
    }
    int on = bend.angle != 0.0;
    for (int k = 0; k < 3; k++) on |= bend.factor[k] != 1.0;
    bend.on = on;
    KEEPING_STILL(machine, (machine->bend = bend, swarf_machine_reframe(machine)));
    return SWARF_OK;
}

swarf_status swarf_machine_offsets(swarf_machine *machine, swarf_block *block)
{
    SWARF_TRY(run_length(machine, block));
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_OFFSET);
    if (word) {
        SWARF_TRY(need_no_compensation(machine, word));
        const int code = (int)word->value;
        swarf_machine_select_system(machine, code <= 590 ? code / 10 - 53 : code - 584);
    }
    if (machine->dialect->bit & 12u) { /* the dialects that have them */
        SWARF_TRY(run_scale(machine, block));
        SWARF_TRY(run_turn(machine, block));
    }
    return SWARF_OK;
}

/* ---- G10 ---- */

/* G10 L2 and L20: a work offset, to values or so that the current point becomes them. */
static swarf_status set_system(swarf_machine *machine, swarf_block *block, const swarf_word *word, int to_current)
{
    int system = 0;
    if (!swarf_block_has(block, 'P')) return swarf_gcode_fail(machine, word, "needs P, the work offset (1: G54)");
    SWARF_TRY(swarf_machine_whole(machine, swarf_block_take(block, 'P'), 0, SWARF_SYSTEMS, &system));
    if (system == 0) system = machine->system;
    double *row = machine->parameters.numbered + 5221 + 20 * (system - 1), absolute[SWARF_AXES];
    double as_there[SWARF_AXES];
    swarf_machine_absolute(machine, machine->position, absolute);
    if (swarf_block_has(block, 'R')) {
        if (to_current) return swarf_gcode_fail(machine, &block->letters['R' - 'A'], "belongs to G10 L2 only");
        row[9] = swarf_block_take(block, 'R')->value;
    }
    /* where the machine stands, less everything but the offset that is wanted */
    const int current = machine->system;
    if (to_current) {
        swarf_machine_select_system(machine, system);
        swarf_machine_relative(machine, absolute, as_there);
        swarf_machine_select_system(machine, current);
    }
    double step[SWARF_AXES];
    memset(step, 0, sizeof step);
    for (int k = 0; k < SWARF_AXES; k++) {
        if (!swarf_block_has(block, swarf_axis_letter(k))) continue;
        const swarf_word *axis = &block->letters[swarf_axis_letter(k) - 'A'];
        double value = 0.0;
        SWARF_TRY(swarf_machine_axis_word(machine, block, k, &value));
        if (!to_current) {
            row[k] = value;
        } else if (isnan(as_there[k])) {
            return swarf_gcode_fail(machine, axis, "sets an offset from an unknown position; command %c first",
                                    swarf_axis_letter(k));
        } else {
            step[k] = as_there[k] - value;
        }
    }
    if (to_current) {
        const double angle = row[9] * 0.017453292519943295769, c = cos(angle), s = sin(angle);
        row[0] += row[9] != 0.0 ? c * step[0] - s * step[1] : step[0];
        row[1] += row[9] != 0.0 ? s * step[0] + c * step[1] : step[1];
        for (int k = 2; k < SWARF_AXES; k++) row[k] += step[k];
    }
    if (system == current) swarf_machine_select_system(machine, system);
    return SWARF_OK;
}

/* G10 L1, L10 and L11: a row of the tool table. */
static swarf_status set_tool(swarf_machine *machine, swarf_block *block, const swarf_word *word, int what)
{
    int number = 0;
    if (!swarf_block_has(block, 'P')) return swarf_gcode_fail(machine, word, "needs P, the tool's number");
    const swarf_word *p = swarf_block_take(block, 'P');
    SWARF_TRY(swarf_machine_whole(machine, p, 1, 99999, &number));
    swarf_gcode_tool *row = (swarf_gcode_tool *)swarf_machine_find_tool(machine, number);
    if (!row && machine->has_table)
        return swarf_gcode_fail(machine, p, "names tool T%d, which is not in the tool table", number);
    if (!row) {
        SWARF_TRY(swarf_array_reserve((void **)&machine->tools, &machine->tool_room, machine->tool_count + 1,
                                      sizeof *machine->tools));
        row = &machine->tools[machine->tool_count++];
        memset(row, 0, sizeof *row);
        row->number = number;
    }
    double here[SWARF_AXES]; /* machine coordinates, less what the work offset asked for makes of them */
    swarf_machine_absolute(machine, machine->position, here);
    for (int k = 0; k < SWARF_AXES; k++)
        here[k] -= what == 10 ? machine->work[k] + machine->shift[k] : machine->parameters.numbered[5381 + k];
    for (int k = 0; k < SWARF_AXES; k++) {
        if (!swarf_block_has(block, swarf_axis_letter(k))) continue;
        double value = 0.0;
        SWARF_TRY(swarf_machine_axis_word(machine, block, k, &value));
        row->offset[k] = what == 1 ? value : here[k] - value;
        if (isnan(row->offset[k]))
            return swarf_gcode_fail(machine, word, "sets an offset from an unknown position; command %c first",
                                    swarf_axis_letter(k));
    }
    if (swarf_block_has(block, 'R')) {
        double radius = 0.0;
        SWARF_TRY(swarf_machine_length(machine, swarf_block_take(block, 'R'), &radius));
        row->diameter_mm = 2.0 * radius;
    }
    if (swarf_block_has(block, 'I')) (void)swarf_block_take(block, 'I');
    if (swarf_block_has(block, 'J')) (void)swarf_block_take(block, 'J');
    if (swarf_block_has(block, 'Q'))
        SWARF_TRY(swarf_machine_whole(machine, swarf_block_take(block, 'Q'), 0, 9, &row->orientation));
    if (number == machine->section.tool && machine->has_table) {
        memcpy(machine->length, row->offset, sizeof machine->length);
        swarf_machine_reframe(machine);
    }
    return SWARF_OK;
}

static swarf_status run_g10(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    int what = 0;
    if (!swarf_block_has(block, 'L')) return swarf_gcode_fail(machine, word, "needs L: 1, 2, 10, 11 or 20");
    const swarf_word *l = swarf_block_take(block, 'L');
    SWARF_TRY(swarf_machine_whole(machine, l, 0, 99, &what));
    const int tool = what == 1 || what == 10 || what == 11;
    if ((machine->dialect->bit == 2 && what != 2 && what != 20) || (!tool && what != 0 && what != 2 && what != 20))
        return swarf_gcode_fail(machine, l, "is nothing that G10 sets; L1, L2, L10, L11 and L20 are");
    SWARF_TRY(need_no_compensation(machine, word));
    if (what == 0) return SWARF_OK; /* the table is read again: nobody changed it meanwhile */
    return tool ? set_tool(machine, block, word, what) : set_system(machine, block, word, what == 20);
}

/* ---- G28 G30 ---- */

static swarf_status go_home(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    const int second = word->value == 300.0;
    const double *home = machine->parameters.numbered + (second ? 5181 : 5161);
    double end[SWARF_AXES], absolute[SWARF_AXES];
    int any;
    const uint32_t given = block->given & ~block->used;
    SWARF_TRY(swarf_machine_target(machine, block, end, &any));
    int moves = 0;
    for (int k = 0; k < SWARF_AXES; k++)
        moves |= !(end[k] == machine->position[k] || (isnan(end[k]) && isnan(machine->position[k])));
    if (any && moves) SWARF_TRY(swarf_machine_go(machine, word, SWARF_MOVE_RAPID, end, 0.0));
    swarf_machine_absolute(machine, machine->position, absolute);
    const int known = machine->machine_known || machine->home_known[second];
    for (int k = 0; k < SWARF_AXES; k++)
        if (!any || given & SWARF_LETTER(swarf_axis_letter(k))) absolute[k] = home[k];
    swarf_machine_relative(machine, absolute, end);
    for (int k = 0; k < 3 && !known; k++)
        if (!any || given & SWARF_LETTER(swarf_axis_letter(k))) end[k] = NAN;
    if (!known && !(machine->warned & SWARF_WARNED_MACHINE)) {
        machine->warned |= SWARF_WARNED_MACHINE;
        SWARF_TRY(swarf_gcode_warn(machine, word,
                                   "goes to a place of the machine that is not known here: what it passes is not "
                                   "simulated; give a parameter file"));
    }
    return swarf_machine_go(machine, word, SWARF_MOVE_RAPID, end, 0.0);
}

static void store_home(swarf_machine *machine, int second)
{
    double absolute[SWARF_AXES];
    swarf_machine_absolute(machine, machine->position, absolute);
    for (int k = 0; k < SWARF_AXES; k++)
        machine->parameters.numbered[(second ? 5181 : 5161) + k] = absolute[k] - machine->offset[k];
    machine->home_known[second] = 1;
}

/* ---- G92 G52 ---- */

static void save_shift(swarf_machine *machine)
{
    int on = 0;
    for (int k = 0; k < SWARF_AXES; k++) on |= machine->shift[k] != 0.0;
    machine->parameters.numbered[5210] = on;
    memcpy(machine->parameters.numbered + 5211, machine->shift, sizeof machine->shift);
}

static swarf_status set_shift(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    double shift[SWARF_AXES];
    int any = 0;
    memcpy(shift, machine->shift, sizeof shift);
    for (int k = 0; k < SWARF_AXES; k++) {
        if (!swarf_block_has(block, swarf_axis_letter(k))) continue;
        double value = 0.0;
        SWARF_TRY(swarf_machine_axis_word(machine, block, k, &value));
        any = 1;
        if (word->value == 520.0)
            shift[k] = value;
        else if (isnan(machine->position[k]))
            machine->position[k] = value; /* nobody knew where it stood: now it is known */
        else
            shift[k] += machine->position[k] - value;
        if (!(fabs(shift[k]) <= SWARF_COORDINATE_LIMIT_MM))
            return swarf_gcode_fail(machine, word, "shifts %c by %g mm; at most %g is possible", swarf_axis_letter(k),
                                    shift[k], SWARF_COORDINATE_LIMIT_MM);
    }
    if (!any) return swarf_gcode_fail(machine, word, "needs the coordinates, by axis words");
    KEEPING_STILL(machine, memcpy(machine->shift, shift, sizeof shift));
    save_shift(machine);
    return SWARF_OK;
}

static void clear_shift(swarf_machine *machine, int restore)
{
    const double *saved = machine->parameters.numbered + 5211;
    KEEPING_STILL(machine, for (int k = 0; k < SWARF_AXES; k++) machine->shift[k] = restore ? saved[k] : 0.0);
}

swarf_status swarf_machine_nonmodal(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    const int code = (int)word->value;
    if (code == 100) return run_g10(machine, block, word);
    SWARF_TRY(need_no_compensation(machine, word));
    switch (code) {
    case 280:
    case 300: return go_home(machine, block, word);
    case 281:
    case 301: store_home(machine, code == 301); return SWARF_OK;
    case 520:
    case 920: return set_shift(machine, block, word);
    case 921:
        clear_shift(machine, 0);
        save_shift(machine);
        return SWARF_OK;
    case 922:
        clear_shift(machine, 0);
        machine->parameters.numbered[5210] = 0.0;
        return SWARF_OK;
    default:
        clear_shift(machine, 1);
        machine->parameters.numbered[5210] = 1.0;
        return SWARF_OK;
    }
}
