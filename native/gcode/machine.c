/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Machine: one block in LinuxCNC's order of execution ("G-code Order of Execution" in its manual). */
#include "gcode/machine.h"

#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint32_t arc_letters = SWARF_LETTER('I') | SWARF_LETTER('J') | SWARF_LETTER('K') | SWARF_LETTER('R');

/* A whole number may be off by this (LinuxCNC's manual, "Numbers"). */
static const double whole_within = 1e-4;

static swarf_status copy_tools(swarf_machine *machine, const swarf_gcode_options *options)
{
    machine->has_table = options->tools != NULL;
    if (!options->tools || options->tool_count == 0) return SWARF_OK;
    machine->tools = malloc(options->tool_count * sizeof *machine->tools);
    if (!machine->tools) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    memcpy(machine->tools, options->tools, options->tool_count * sizeof *machine->tools);
    machine->tool_count = machine->tool_room = options->tool_count;
    for (size_t i = 0; i < machine->tool_count; i++) {
        const swarf_gcode_tool *tool = &machine->tools[i];
        int sound = tool->number >= 0 && tool->diameter_mm >= -SWARF_COORDINATE_LIMIT_MM &&
                    tool->diameter_mm <= SWARF_COORDINATE_LIMIT_MM;
        for (int k = 0; k < SWARF_AXES; k++) sound = sound && fabs(tool->offset[k]) <= SWARF_COORDINATE_LIMIT_MM;
        SWARF_REQUIRE(sound, "gcode: tool %d has an offset or a diameter that cannot be", (int)tool->number);
    }
    return SWARF_OK;
}

swarf_status swarf_machine_begin(swarf_machine *machine, const swarf_gcode_options *options, swarf_program *program)
{
    memset(machine, 0, sizeof *machine);
    machine->dialect = swarf_dialect_get(options->dialect);
    SWARF_REQUIRE(machine->dialect, "gcode: %d is no dialect", (int)options->dialect);
    machine->block_delete = options->block_delete;
    machine->program = program;
    machine->notes = options->notes;
    SWARF_TRY(swarf_parameters_create(&machine->parameters));
    machine->parameters.numbered[5599] = 1.0;
    if (options->parameters) {
        SWARF_TRY(swarf_parameters_read(&machine->parameters, options->parameters, options->parameter_unit_mm));
        machine->machine_known = 1;
    }
    SWARF_TRY(copy_tools(machine, options));
    for (size_t i = 0; i < options->diameter_count; i++)
        SWARF_REQUIRE(options->diameters && options->diameters[i].number >= 0 && options->diameters[i].mm >= 0 &&
                          options->diameters[i].mm <= SWARF_COORDINATE_LIMIT_MM,
                      "gcode: diameter %zu: tool T%d of %g mm", i + 1,
                      options->diameters ? (int)options->diameters[i].number : 0,
                      options->diameters ? options->diameters[i].mm : 0);
    machine->diameters = options->diameters;
    machine->diameter_count = options->diameter_count;
    for (int k = 0; k < 3; k++) machine->position[k] = options->start[k];
    swarf_modes *modes = &machine->modes;
    modes->motion = machine->dialect->motion;
    modes->retract_to_r = machine->dialect->retract_to_r;
    modes->unit_mm = 1.0;
    modes->feed_mode = 940;
    modes->path = 640;
    machine->selected = -1;
    machine->section.tool = -1;
    const double system = machine->parameters.numbered[5220];
    for (int k = 0; k < 3; k++) machine->bend.factor[k] = 1.0;
    memcpy(machine->last_tip, options->start, sizeof machine->last_tip);
    if (machine->parameters.numbered[5210] != 0.0)
        for (int k = 0; k < SWARF_AXES; k++) machine->shift[k] = machine->parameters.numbered[5211 + k];
    swarf_machine_select_system(machine, system >= 1.0 && system <= SWARF_SYSTEMS ? (int)system : 1);
    return SWARF_OK;
}

void swarf_machine_end(swarf_machine *machine)
{
    swarf_parameters_destroy(&machine->parameters);
    free(machine->tools);
    free(machine->tool_uses);
    free(machine->comp.held);
}

/* ---- words ---- */

swarf_status swarf_machine_length(const swarf_machine *machine, const swarf_word *word, double *out)
{
    double unit = machine->modes.unit_mm;
    /* of inches a whole number means ten-thousandths, a tenth of what thousandths would be */
    if (word->whole && machine->dialect->whole_unit_mm > 0.0)
        unit *= machine->dialect->whole_unit_mm * (unit > 1.0 ? 0.1 : 1.0);
    const double value = word->value * unit;
    if (!(fabs(value) <= SWARF_COORDINATE_LIMIT_MM))
        return swarf_gcode_fail(machine, word, "is %g mm; at most %g is possible", value, SWARF_COORDINATE_LIMIT_MM);
    *out = value;
    return SWARF_OK;
}

swarf_status swarf_machine_whole(const swarf_machine *machine, const swarf_word *word, int lo, int hi, int *out)
{
    const double nearest = nearbyint(word->value);
    if (!(nearest >= lo && nearest <= hi && fabs(word->value - nearest) <= whole_within))
        return swarf_gcode_fail(machine, word, "must be a whole number from %d to %d", lo, hi);
    *out = (int)nearest;
    return SWARF_OK;
}

swarf_status swarf_machine_axis_word(const swarf_machine *machine, swarf_block *block, int axis, double *out)
{
    const swarf_word *word = swarf_block_take(block, swarf_axis_letter(axis));
    if (axis < 3 || axis > 5) return swarf_machine_length(machine, word, out);
    *out = word->value;
    return SWARF_OK;
}

/* ---- the first half of a block: what moves nothing ---- */

static swarf_status run_feed(swarf_machine *machine, swarf_block *block)
{
    swarf_modes *modes = &machine->modes;
    const swarf_word *mode = swarf_block_group(block, SWARF_GROUP_FEED_MODE);
    if (mode && (int)mode->value != modes->feed_mode) {
        modes->feed_mode = (int)mode->value;
        modes->feed = 0.0; /* a number of another kind */
    }
    if (!swarf_block_has(block, 'F')) return SWARF_OK;
    const swarf_word *feed = swarf_block_take(block, 'F');
    if (feed->value < 0.0) return swarf_gcode_fail(machine, feed, "feed must not be negative");
    const double value = modes->feed_mode == 930 ? feed->value : feed->value * modes->unit_mm;
    if (!(value <= SWARF_COORDINATE_LIMIT_MM))
        return swarf_gcode_fail(machine, feed, "is %g mm/min; at most %g is possible", value,
                                SWARF_COORDINATE_LIMIT_MM);
    modes->feed = value;
    return SWARF_OK;
}

/* G96 gives m/min (ft/min); the turns it makes depend on X, which a mill does not turn about. */
static swarf_status run_speed(swarf_machine *machine, swarf_block *block)
{
    swarf_modes *modes = &machine->modes;
    const swarf_word *mode = swarf_block_group(block, SWARF_GROUP_SPEED_MODE);
    if (swarf_block_has(block, '$')) {
        int number = 0;
        SWARF_TRY(swarf_machine_whole(machine, swarf_block_take(block, '$'), -1, 7, &number));
        if (number > 0) return swarf_gcode_fail(machine, &block->letters[26], "names a spindle other than the first");
    }
    if (swarf_block_has(block, 'S')) {
        const swarf_word *speed = swarf_block_take(block, 'S');
        if (speed->value < 0.0)
            return swarf_gcode_fail(machine, speed, "speed must not be negative; M4 turns the other way");
        modes->speed = speed->value;
    }
    if (mode && mode->value == 960.0) {
        if (!swarf_block_has(block, 'S')) return swarf_gcode_fail(machine, mode, "needs S, the speed of the surface");
        if (swarf_block_has(block, 'D')) (void)swarf_block_take(block, 'D');
        modes->surface = 1;
        if (!(machine->warned & SWARF_WARNED_SURFACE)) {
            machine->warned |= SWARF_WARNED_SURFACE;
            SWARF_TRY(swarf_gcode_warn(machine, mode, "constant surface speed: the spindle's rpm are not known"));
        }
    } else if (mode) {
        modes->surface = 0;
    }
    machine->section.spindle_rpm = modes->surface ? 0.0 : modes->speed;
    return SWARF_OK;
}

static swarf_status run_spindle(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_SPINDLE);
    if (!word) return SWARF_OK;
    if (word->value == 19.0) { /* turned to an angle and held there */
        for (const char *letter = "RPQ"; *letter; letter++)
            if (swarf_block_has(block, *letter)) (void)swarf_block_take(block, *letter);
        machine->modes.spindle = SWARF_SPINDLE_OFF;
    } else {
        machine->modes.spindle = word->value == 3.0   ? SWARF_SPINDLE_CW
                                 : word->value == 4.0 ? SWARF_SPINDLE_CCW
                                                      : SWARF_SPINDLE_OFF;
    }
    machine->section.spindle = machine->modes.spindle;
    return SWARF_OK;
}

static swarf_status run_coolant(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *mist = swarf_block_group(block, SWARF_GROUP_MIST);
    const swarf_word *flood = swarf_block_group(block, SWARF_GROUP_FLOOD);
    const swarf_word *dry = swarf_block_group(block, SWARF_GROUP_DRY);
    if (dry && (mist || flood))
        return swarf_gcode_fail(machine, dry, "stops the coolant that this line starts; keep one");
    if (mist || flood || dry) {
        machine->modes.coolant = dry ? 0 : machine->modes.coolant | (mist ? 1 : 0) | (flood ? 2 : 0);
        machine->section.coolant = machine->modes.coolant;
    }
    return SWARF_OK;
}

static swarf_status run_dwell(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_NONMODAL);
    if (!word || word->value != 40.0) return SWARF_OK;
    const int fanuc = machine->dialect->k_repeats;
    const char letter = swarf_block_has(block, 'P') || !fanuc ? 'P' : 'X'; /* Fanuc: P milliseconds, X seconds */
    if (!swarf_block_has(block, letter)) return swarf_gcode_fail(machine, word, "needs P, the seconds to wait");
    const swarf_word *seconds = swarf_block_take(block, letter);
    if (seconds->value < 0.0) return swarf_gcode_fail(machine, seconds, "must not be negative");
    return swarf_machine_dwell(machine, seconds, fanuc && seconds->whole ? seconds->value * 1e-3 : seconds->value);
}

static swarf_status run_modes(swarf_machine *machine, swarf_block *block)
{
    swarf_modes *modes = &machine->modes;
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_PLANE);
    if (word) {
        const swarf_plane plane = word->value == 170.0   ? SWARF_PLANE_XY
                                  : word->value == 180.0 ? SWARF_PLANE_ZX
                                                         : SWARF_PLANE_YZ;
        if (machine->comp.side && plane != modes->plane)
            return swarf_gcode_fail(machine, word, "changes the plane under cutter compensation; write G40 first");
        if (plane != modes->plane) machine->cycle.active = 0; /* its R and Z lay along another axis */
        modes->plane = plane;
    }
    word = swarf_block_group(block, SWARF_GROUP_UNITS);
    if (word) modes->unit_mm = word->value == 200.0 ? 25.4 : 1.0;
    SWARF_TRY(swarf_machine_radius(machine, block));
    SWARF_TRY(swarf_machine_offsets(machine, block));
    word = swarf_block_group(block, SWARF_GROUP_PATH);
    if (word) {
        modes->path = (int)word->value;
        if (word->value == 640.0) /* tolerances of blending; the programmed path is what is simulated */
            for (const char *letter = "PQR"; *letter; letter++)
                if (swarf_block_has(block, *letter)) (void)swarf_block_take(block, *letter);
    }
    word = swarf_block_group(block, SWARF_GROUP_DISTANCE);
    if (word) modes->incremental = word->value == 910.0;
    word = swarf_block_group(block, SWARF_GROUP_ARC_CENTRE);
    if (word) modes->arc_absolute = word->value == 901.0;
    word = swarf_block_group(block, SWARF_GROUP_RETRACT);
    if (word) modes->retract_to_r = word->value == 990.0;
    return SWARF_OK;
}

/* ---- motion ---- */

static int is_cycle(int motion)
{
    return motion >= 730 && motion != SWARF_MOTION_NONE;
}

/* The first word of the line that asks for a motion. */
static const swarf_word *first_mover(const swarf_block *block, uint32_t movers)
{
    const swarf_word *word = NULL;
    for (int i = 0; i < 26; i++)
        if (movers >> i & 1u && (!word || block->letters[i].at < word->at)) word = &block->letters[i];
    return word;
}

static swarf_status run_motion(swarf_machine *machine, swarf_block *block)
{
    swarf_modes *modes = &machine->modes;
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_MOTION);
    const swarf_word *cancel = swarf_block_group(block, SWARF_GROUP_CANCEL);
    if (cancel) {
        modes->motion = SWARF_MOTION_NONE;
        machine->cycle.active = 0;
        if (word && word->value >= 730.0)
            return swarf_gcode_fail(machine, cancel, "and a cycle cannot share a line; keep one");
    }
    if (word) modes->motion = (int)word->value;
    const int motion = modes->motion, arc = motion == 20 || motion == 30, cycle = is_cycle(motion);
    if (!cycle) machine->cycle.active = 0;
    if (word && motion != 50) machine->had_spline = 0;
    const int spline = motion == 50 || motion == 51;
    const uint32_t movers =
        block->given & ~block->used & (SWARF_AXIS_LETTERS | (arc || (spline && !word) ? arc_letters : 0));
    if (!movers && !(word && (cycle || motion >= 330 || spline))) return SWARF_OK;
    if (!word) word = first_mover(block, movers);
    if (motion == SWARF_MOTION_NONE)
        return swarf_gcode_fail(machine, word, "has no motion mode; write G0 to G3 or a cycle first");
    if (arc) return swarf_machine_arc(machine, block, word);
    if (cycle) return swarf_machine_drill(machine, block, word);
    if (spline) return swarf_machine_spline(machine, block, word);
    if (motion == 330 || motion == 331) return swarf_machine_synchronized(machine, block, word);
    if (motion >= 382 && motion <= 385) return swarf_machine_probe(machine, block, word);
    return swarf_machine_straight(machine, block, word);
}

/* A word that nothing asked for was meant for something: never ignore it. */
static swarf_status check_unused(const swarf_machine *machine, const swarf_block *block)
{
    const uint32_t unused = block->given & ~block->used;
    if (!unused) return SWARF_OK;
    const swarf_word *word = NULL;
    char letter = 'A';
    for (int i = 0; i < SWARF_LETTERS; i++)
        if (unused >> i & 1u && (!word || block->letters[i].at < word->at)) {
            word = &block->letters[i];
            letter = i == 26 ? '$' : (char)('A' + i);
        }
    const char *home = "a motion";
    switch (letter) {
    case 'D': home = "G41, G42 and G96"; break;
    case 'E': home = "M66 to M68 (numbers take no exponent)"; break;
    case 'H': home = "G43"; break;
    case 'I':
    case 'J':
    case 'K': home = "G2 and G3, by the plane's two letters"; break;
    case 'L': home = "cycles, G10 and M98"; break;
    case 'P': home = "G4, G10, G82 and G89, turns of G2 and G3, and G64"; break;
    case 'Q': home = "G73, G83 and G64"; break;
    case 'R': home = "G2, G3, G10 and cycles"; break;
    default: break;
    }
    return swarf_gcode_fail(machine, word, "is not used by this line; %c belongs to %s", letter, home);
}

/* M98 and M99 leave a request; the stops end the program. */
static swarf_status run_stop(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *call = swarf_block_group(block, SWARF_GROUP_CALL);
    if (call && call->value == 98.0) {
        if (!swarf_block_has(block, 'P'))
            return swarf_gcode_fail(machine, call, "needs P, the number of the program to call");
        machine->call_word = *swarf_block_take(block, 'P');
        SWARF_TRY(swarf_machine_whole(machine, &machine->call_word, 0, 99999999, &machine->call_number));
        machine->call_repeats = 1;
        if (swarf_block_has(block, 'L'))
            SWARF_TRY(swarf_machine_whole(machine, swarf_block_take(block, 'L'), 0, 9999999, &machine->call_repeats));
        machine->request = SWARF_REQUEST_CALL;
    } else if (call) {
        machine->call_word = *call;
        machine->request = SWARF_REQUEST_RETURN;
    }
    const swarf_word *stop = swarf_block_group(block, SWARF_GROUP_STOP);
    if (stop && (stop->value == 2.0 || stop->value == 30.0)) {
        if (machine->comp.side) SWARF_TRY(swarf_compensation_flush(machine, stop));
        machine->ended = 1;
    }
    return SWARF_OK;
}

swarf_status swarf_machine_run(swarf_machine *machine, swarf_block *block)
{
    machine->request = SWARF_REQUEST_NONE;
    if (block->comment) SWARF_TRY(swarf_machine_comment(machine, block));
    const swarf_word *lathe = swarf_block_group(block, SWARF_GROUP_LATHE);
    (void)lathe; /* G8, radius mode, is how mills count anyway */
    SWARF_TRY(run_feed(machine, block));
    SWARF_TRY(run_speed(machine, block));
    SWARF_TRY(swarf_machine_tool(machine, block));
    SWARF_TRY(run_spindle(machine, block));
    SWARF_TRY(swarf_machine_misc(machine, block));
    SWARF_TRY(run_coolant(machine, block));
    SWARF_TRY(run_dwell(machine, block));
    SWARF_TRY(run_modes(machine, block));
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_NONMODAL);
    if (word && word->value != 530.0 && word->value != 40.0) {
        const swarf_word *motion = swarf_block_group(block, SWARF_GROUP_MOTION);
        const int takes_axes = word->value != 281.0 && word->value != 301.0 && !(word->value > 920.0);
        if (motion && takes_axes && (block->given & SWARF_AXIS_LETTERS))
            return swarf_gcode_fail(machine, motion, "shares the line with another code that takes axis words");
        SWARF_TRY(swarf_machine_nonmodal(machine, block, word));
    }
    if (word && word->value == 530.0 && machine->comp.side)
        return swarf_gcode_fail(machine, word, "cannot be under cutter compensation; write G40 first");
    SWARF_TRY(run_motion(machine, block));
    if (word && word->value == 530.0 && machine->modes.motion != 0 && machine->modes.motion != 10)
        return swarf_gcode_fail(machine, word, "moves in machine coordinates by G0 or G1 only");
    SWARF_TRY(run_stop(machine, block));
    return check_unused(machine, block);
}

swarf_status swarf_machine_finish(swarf_machine *machine)
{
    return machine->comp.side ? swarf_compensation_flush(machine, NULL) : SWARF_OK;
}
