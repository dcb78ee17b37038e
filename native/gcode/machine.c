/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Machine: one block in the order of RS274/NGC table 8, except that units count for the whole line, feed included. */
#include "gcode/machine.h"

#include "base/memory.h"
#include "base/status.h"
#include "program/program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* As large as any control's table; also bounds tool_uses. */
enum { TOOL_MAX = 99999 };

static const uint32_t axis_letters = SWARF_LETTER('X') | SWARF_LETTER('Y') | SWARF_LETTER('Z');
static const uint32_t arc_letters = SWARF_LETTER('I') | SWARF_LETTER('J') | SWARF_LETTER('K') | SWARF_LETTER('R');

void swarf_machine_begin(swarf_machine *machine, swarf_program *program, const char *name, const double start[3])
{
    memset(machine, 0, sizeof *machine);
    machine->place.name = name;
    machine->program = program;
    for (int k = 0; k < 3; k++) machine->position[k] = start[k];
    machine->unit_mm = 1.0;
    machine->motion = SWARF_MOTION_NONE;
    machine->selected = -1;
    machine->section.tool = -1;
    machine->section.work_offset = 1;
}

void swarf_machine_end(swarf_machine *machine)
{
    free(machine->tool_uses);
}

swarf_status swarf_machine_length(const swarf_machine *machine, const swarf_block *block, const swarf_word *word,
                                  double *out)
{
    const double value = word->value * machine->unit_mm;
    if (!(fabs(value) <= SWARF_COORDINATE_LIMIT_MM))
        return swarf_gcode_fail(&machine->place, block, word, "is %g mm; at most %g is possible", value,
                                SWARF_COORDINATE_LIMIT_MM);
    *out = value;
    return SWARF_OK;
}

swarf_status swarf_machine_whole(const swarf_machine *machine, const swarf_block *block, const swarf_word *word, int lo,
                                 int hi, int *out)
{
    const double value = word->value;
    if (!(value >= lo && value <= hi && value == floor(value)))
        return swarf_gcode_fail(&machine->place, block, word, "must be a whole number from %d to %d", lo, hi);
    *out = (int)value;
    return SWARF_OK;
}

/* Sections reach the program with the first move that needs them. */
static swarf_status settle(swarf_machine *machine)
{
    if (!machine->section_changed) return SWARF_OK;
    if (swarf_program_operation_count(machine->program) == 0)
        SWARF_TRY(swarf_program_add_operation(machine->program, "program"));
    machine->section_changed = 0;
    return swarf_program_set_section(machine->program, &machine->section);
}

/* Incremental words add up, so ends are checked beside words. */
static swarf_status check_end(const swarf_machine *machine, const swarf_block *block, const swarf_word *word,
                              const double end[3])
{
    for (int k = 0; k < 3; k++)
        if (fabs(end[k]) > SWARF_COORDINATE_LIMIT_MM)
            return swarf_gcode_fail(&machine->place, block, word, "leads to %c %g mm; at most %g is possible", "XYZ"[k],
                                    end[k], SWARF_COORDINATE_LIMIT_MM);
    return SWARF_OK;
}

swarf_status swarf_machine_go(swarf_machine *machine, const swarf_block *block, const swarf_word *word,
                              swarf_move_kind kind, const double end[3])
{
    SWARF_TRY(check_end(machine, block, word, end));
    SWARF_TRY(settle(machine));
    SWARF_TRY(swarf_program_add_line(machine->program, kind, end, machine->feed_mm_min, machine->place.line));
    for (int k = 0; k < 3; k++) machine->position[k] = end[k];
    return SWARF_OK;
}

swarf_status swarf_machine_turn(swarf_machine *machine, const swarf_block *block, const swarf_word *word,
                                const double end[3], const swarf_arc *arc)
{
    int first, second, normal;
    swarf_plane_axes(machine->plane, &first, &second, &normal);
    if (isnan(machine->position[normal])) /* nothing to sweep at an unknown height */
        return swarf_machine_go(machine, block, word, SWARF_MOVE_POSITION, end);
    SWARF_TRY(check_end(machine, block, word, end));
    SWARF_TRY(settle(machine));
    SWARF_TRY(
        swarf_program_push(machine->program, SWARF_MOVE_FEED, end, arc, machine->feed_mm_min, machine->place.line));
    for (int k = 0; k < 3; k++) machine->position[k] = end[k];
    return SWARF_OK;
}

swarf_status swarf_machine_dwell(swarf_machine *machine, double seconds)
{
    SWARF_TRY(settle(machine));
    return swarf_program_add_event(machine->program, SWARF_MOVE_DWELL, seconds, machine->place.line);
}

static swarf_status run_units_and_feed(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *units = swarf_block_group(block, SWARF_GROUP_UNITS);
    if (units) machine->unit_mm = units->value == 200.0 ? 25.4 : 1.0;
    if (swarf_block_has(block, 'F')) {
        const swarf_word *feed = swarf_block_take(block, 'F');
        if (feed->value < 0.0) return swarf_gcode_fail(&machine->place, block, feed, "feed must not be negative");
        SWARF_TRY(swarf_machine_length(machine, block, feed, &machine->feed_mm_min));
    }
    return SWARF_OK;
}

static swarf_status change_tool(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    if (machine->selected < 0)
        return swarf_gcode_fail(&machine->place, block, word, "has no tool to load; write T and its number first");
    const size_t tool = (size_t)machine->selected, room = machine->tool_room;
    SWARF_TRY(
        swarf_array_reserve((void **)&machine->tool_uses, &machine->tool_room, tool + 1, sizeof *machine->tool_uses));
    if (machine->tool_room > room)
        memset(machine->tool_uses + room, 0, (machine->tool_room - room) * sizeof *machine->tool_uses);
    const uint32_t use = ++machine->tool_uses[tool];
    char name[40];
    if (use == 1)
        snprintf(name, sizeof name, "T%d", machine->selected);
    else
        snprintf(name, sizeof name, "T%d (%u)", machine->selected, use);
    SWARF_TRY(swarf_program_add_operation(machine->program, name));
    machine->section.operation = (int32_t)swarf_program_operation_count(machine->program) - 1;
    machine->section.tool = machine->selected;
    machine->section.spindle = SWARF_SPINDLE_OFF; /* RS274/NGC 3.6.3: stopped when the change is complete */
    machine->section_changed = 1;
    SWARF_TRY(settle(machine));
    return swarf_program_add_event(machine->program, SWARF_MOVE_TOOL_CHANGE, 0.0, machine->place.line);
}

static swarf_status run_tool_and_spindle(swarf_machine *machine, swarf_block *block)
{
    const swarf_place *place = &machine->place;
    if (swarf_block_has(block, 'S')) {
        const swarf_word *speed = swarf_block_take(block, 'S');
        if (speed->value < 0.0)
            return swarf_gcode_fail(place, block, speed, "speed must not be negative; M4 turns the other way");
        machine->section.spindle_rpm = speed->value;
        machine->section_changed = 1;
    }
    if (swarf_block_has(block, 'T'))
        SWARF_TRY(swarf_machine_whole(machine, block, swarf_block_take(block, 'T'), 0, TOOL_MAX, &machine->selected));
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_TOOL);
    if (word) SWARF_TRY(change_tool(machine, block, word));
    word = swarf_block_group(block, SWARF_GROUP_SPINDLE);
    if (word) {
        machine->section.spindle = word->value == 3.0   ? SWARF_SPINDLE_CW
                                   : word->value == 4.0 ? SWARF_SPINDLE_CCW
                                                        : SWARF_SPINDLE_OFF;
        machine->section_changed = 1;
    }
    const swarf_word *mist = swarf_block_group(block, SWARF_GROUP_MIST);
    const swarf_word *flood = swarf_block_group(block, SWARF_GROUP_FLOOD);
    const swarf_word *dry = swarf_block_group(block, SWARF_GROUP_DRY);
    if (dry && (mist || flood))
        return swarf_gcode_fail(place, block, dry, "stops the coolant that this line starts; keep one");
    if (mist || flood || dry) {
        machine->section.coolant = dry ? 0 : machine->section.coolant | (mist ? 1 : 0) | (flood ? 2 : 0);
        machine->section_changed = 1;
    }
    return SWARF_OK;
}

static swarf_status run_dwell(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_DWELL);
    if (!word) return SWARF_OK;
    if (!swarf_block_has(block, 'P'))
        return swarf_gcode_fail(&machine->place, block, word, "needs P, the seconds to wait");
    const swarf_word *seconds = swarf_block_take(block, 'P');
    if (seconds->value < 0.0) return swarf_gcode_fail(&machine->place, block, seconds, "must not be negative");
    return swarf_machine_dwell(machine, seconds->value);
}

static swarf_status run_modes(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_PLANE);
    if (word) {
        machine->plane = word->value == 170.0 ? SWARF_PLANE_XY : word->value == 180.0 ? SWARF_PLANE_ZX : SWARF_PLANE_YZ;
        machine->cycle.active = 0; /* its R and Z lay along another axis */
    }
    word = swarf_block_group(block, SWARF_GROUP_LENGTH);
    if (word && word->value == 430.0) {
        /* The tip is what is programmed and simulated, so the right offset changes nothing; another one would. */
        const int tool = machine->section.tool;
        if (swarf_block_has(block, 'H')) {
            const swarf_word *offset = swarf_block_take(block, 'H');
            int number = 0;
            SWARF_TRY(swarf_machine_whole(machine, block, offset, 0, TOOL_MAX, &number));
            if (tool < 0)
                return swarf_gcode_fail(&machine->place, block, offset,
                                        "is a tool's offset but no tool is loaded; load it by T%d M6 first", number);
            if (number != tool)
                return swarf_gcode_fail(&machine->place, block, offset,
                                        "is not the offset of the loaded tool; H%d is, others are not supported", tool);
        }
    }
    word = swarf_block_group(block, SWARF_GROUP_PATH);
    if (word && word->value == 640.0) { /* tolerances of blending; the programmed path is what is simulated */
        if (swarf_block_has(block, 'P')) (void)swarf_block_take(block, 'P');
        if (swarf_block_has(block, 'Q')) (void)swarf_block_take(block, 'Q');
    }
    word = swarf_block_group(block, SWARF_GROUP_DISTANCE);
    if (word) machine->incremental = word->value == 910.0;
    word = swarf_block_group(block, SWARF_GROUP_ARC_CENTRE);
    if (word) machine->arc_absolute = word->value == 901.0;
    word = swarf_block_group(block, SWARF_GROUP_RETRACT);
    if (word) machine->retract_to_r = word->value == 990.0;
    return SWARF_OK;
}

static swarf_status run_straight(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    double end[3];
    for (int k = 0; k < 3; k++) {
        end[k] = machine->position[k];
        if (!swarf_block_has(block, (char)('X' + k))) continue;
        const swarf_word *axis = swarf_block_take(block, (char)('X' + k));
        double value = 0.0;
        SWARF_TRY(swarf_machine_length(machine, block, axis, &value));
        if (machine->incremental && isnan(end[k]))
            return swarf_gcode_fail(&machine->place, block, axis,
                                    "is a step from an unknown position; command %c under G90 first", 'X' + k);
        end[k] = machine->incremental ? end[k] + value : value;
    }
    return swarf_machine_go(machine, block, word, machine->motion == 0 ? SWARF_MOVE_RAPID : SWARF_MOVE_FEED, end);
}

static swarf_status run_motion(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_MOTION);
    const swarf_word *cancel = swarf_block_group(block, SWARF_GROUP_CANCEL);
    if (cancel) {
        machine->motion = SWARF_MOTION_NONE;
        machine->cycle.active = 0;
        if (word && word->value >= 730.0)
            return swarf_gcode_fail(&machine->place, block, cancel, "and a cycle cannot share a line; keep one");
    }
    if (word) machine->motion = (int)word->value;
    const int arc = machine->motion == 20 || machine->motion == 30;
    const int cycle = machine->motion >= 730 && machine->motion != SWARF_MOTION_NONE;
    if (!cycle) machine->cycle.active = 0;
    const uint32_t movers = axis_letters | (arc ? arc_letters : 0);
    if (!(block->given & movers) && !(word && cycle)) return SWARF_OK;
    if (!word) { /* modal: point at the first word that asks for motion */
        for (int letter = 0; letter < 26; letter++)
            if ((block->given & movers) >> letter & 1u && (!word || block->letters[letter].at < word->at))
                word = &block->letters[letter];
    }
    if (machine->motion == SWARF_MOTION_NONE)
        return swarf_gcode_fail(&machine->place, block, word, "has no motion mode; write G0 to G3 or a cycle first");
    if (arc) return swarf_machine_arc(machine, block, word);
    if (cycle) return swarf_machine_drill(machine, block, word);
    return run_straight(machine, block, word);
}

/* A word that nothing asked for was meant for something: never ignore it. */
static swarf_status check_unused(const swarf_machine *machine, const swarf_block *block)
{
    const uint32_t unused = block->given & ~block->used;
    if (!unused) return SWARF_OK;
    const swarf_word *word = NULL;
    char letter = 'A';
    for (int i = 0; i < 26; i++)
        if (unused >> i & 1u && (!word || block->letters[i].at < word->at)) {
            word = &block->letters[i];
            letter = (char)('A' + i);
        }
    const char *home = "G0 to G3 and cycles";
    switch (letter) {
    case 'H': home = "G43"; break;
    case 'I':
    case 'J':
    case 'K': home = "G2 and G3, by the plane's two letters"; break;
    case 'L': home = "cycles"; break;
    case 'P': home = "G4, G82 and G89, turns of G2 and G3, and G64"; break;
    case 'Q': home = "G73, G83 and G64"; break;
    case 'R': home = "G2, G3 and cycles"; break;
    default: break;
    }
    return swarf_gcode_fail(&machine->place, block, word, "is not used by this line; %c belongs to %s", letter, home);
}

swarf_status swarf_machine_run(swarf_machine *machine, swarf_block *block)
{
    SWARF_TRY(run_units_and_feed(machine, block));
    SWARF_TRY(run_tool_and_spindle(machine, block));
    SWARF_TRY(run_dwell(machine, block));
    SWARF_TRY(run_modes(machine, block));
    SWARF_TRY(run_motion(machine, block));
    const swarf_word *stop = swarf_block_group(block, SWARF_GROUP_STOP);
    if (stop && stop->value >= 2.0) machine->ended = 1;
    return check_unused(machine, block);
}
