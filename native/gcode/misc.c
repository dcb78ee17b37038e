/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What M words do beside tools, spindle and stops, and comments that speak. */
#include "gcode/machine.h"

#include "base/status.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void take(swarf_block *block, const char *letters)
{
    for (; *letters; letters++)
        if (swarf_block_has(block, *letters)) (void)swarf_block_take(block, *letters);
}

/* M66 waits for an input, which nobody knows here; the others set outputs. */
static swarf_status run_pins(swarf_machine *machine, swarf_block *block, const swarf_word *word)
{
    take(block, word->value == 66.0 ? "PELQ" : word->value >= 67.0 ? "EQ" : "P");
    if (word->value != 66.0) return SWARF_OK;
    machine->parameters.numbered[5399] = 0.0;
    if (machine->warned & SWARF_WARNED_INPUT) return SWARF_OK;
    machine->warned |= SWARF_WARNED_INPUT;
    return swarf_gcode_warn(machine, word, "reads an input, which is not known here: #5399 is taken to be 0");
}

swarf_status swarf_machine_restore(swarf_machine *machine)
{
    const swarf_modes *saved = &machine->saved[machine->level];
    const int motion = machine->modes.motion; /* motion is not part of the state that is saved */
    if (saved->plane != machine->modes.plane) machine->cycle.active = 0;
    machine->modes = *saved;
    machine->modes.motion = motion;
    machine->section.spindle = saved->spindle;
    machine->section.coolant = saved->coolant;
    machine->section.spindle_rpm = saved->surface ? 0.0 : saved->speed;
    return SWARF_OK;
}

static swarf_status run_state(swarf_machine *machine, const swarf_word *word)
{
    switch ((int)word->value) {
    case 70:
    case 73:
        machine->saved[machine->level] = machine->modes;
        machine->is_saved[machine->level] = word->value == 73.0 ? 2 : 1;
        return SWARF_OK;
    case 71: machine->is_saved[machine->level] = 0; return SWARF_OK;
    default:
        if (!machine->is_saved[machine->level])
            return swarf_gcode_fail(machine, word, "brings back a state that was not saved; write M70 before");
        return swarf_machine_restore(machine);
    }
}

swarf_status swarf_machine_misc(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_PINS);
    if (word) SWARF_TRY(run_pins(machine, block, word));
    word = swarf_block_group(block, SWARF_GROUP_STATE);
    if (word) SWARF_TRY(run_state(machine, word));
    word = swarf_block_group(block, SWARF_GROUP_OVERRIDE);
    if (word && word->value >= 50.0) take(block, "P");
    word = swarf_block_group(block, SWARF_GROUP_USER);
    if (!word) return SWARF_OK;
    take(block, "PQ");
    return swarf_gcode_warn(machine, word, "runs a program of the machine's owner; it is not simulated");
}

/* ---- comments ---- */

/* `at` behind `word` (lower case) and a comma, blanks anywhere between; NULL if the comment begins otherwise. */
static const char *after_word(const char *at, const char *end, const char *word, int comma)
{
    at = swarf_skip_blanks(at, end);
    for (; *word; word++) {
        if (at == end || (*at >= 'A' && *at <= 'Z' ? *at - 'A' + 'a' : *at) != *word) return NULL;
        at = swarf_skip_blanks(at + 1, end);
    }
    if (!comma) return at;
    return at < end && *at == ',' ? at + 1 : NULL;
}

/* Append to a text of `size` bytes; what does not fit is cut. */
static void append(char *text, size_t size, const char *more, size_t length)
{
    const size_t used = strlen(text), room = size - 1 - used;
    const size_t count = length < room ? length : room;
    memcpy(text + used, more, count);
    text[used + count] = 0;
}

/* The value of the parameter at *at ("#5", "#<name>") as text; "######" where there is none. */
static void append_parameter(const swarf_machine *machine, const char **at, const char *end, int decimals, char *text,
                             size_t size)
{
    char number[64] = "######", name[SWARF_PARAMETER_NAME_MAX + 1];
    const char *p = *at + 1;
    double value = NAN;
    if (p < end && *p == '<') {
        const char *open = ++p;
        while (p < end && *p != '>') p++;
        if (swarf_parameter_name(open, p, name)) {
            const double *found = swarf_parameters_find(&machine->parameters, name);
            if (found)
                value = *found;
            else if (!swarf_machine_predefined(machine, name, &value))
                value = NAN;
        }
        if (p < end) p++;
    } else {
        int index = 0;
        while (p < end && *p >= '0' && *p <= '9' && index < SWARF_PARAMETERS) index = 10 * index + (*p++ - '0');
        if (index > 0 && index < SWARF_PARAMETERS) value = swarf_machine_parameter(machine, index);
    }
    if (!isnan(value)) snprintf(number, sizeof number, "%.*f", decimals, value);
    append(text, size, number, strlen(number));
    *at = p;
}

/* "%d", "%f", "%.3f" and "%lf" set the decimals of the parameters that follow. */
static int read_format(const char **at, const char *end, int *decimals)
{
    const char *p = *at + 1;
    int wanted = 4;
    if (p < end && *p == 'd') {
        wanted = 0;
    } else if (end - p >= 3 && p[0] == '.' && p[1] >= '0' && p[1] <= '9' && p[2] == 'f') {
        wanted = p[1] - '0';
        p += 2;
    } else if (end - p >= 2 && p[0] == 'l' && p[1] == 'f') {
        wanted = 6;
        p++;
    } else if (p == end || *p != 'f') {
        return 0;
    }
    *decimals = wanted;
    *at = p + 1;
    return 1;
}

static void expand(const swarf_machine *machine, const char *at, const char *end, char *text, size_t size)
{
    int decimals = 6;
    text[0] = 0;
    while (at < end) {
        if (*at == '#')
            append_parameter(machine, &at, end, decimals, text, size);
        else if (*at != '%' || !read_format(&at, end, &decimals))
            append(text, size, at++, 1);
    }
}

swarf_status swarf_machine_comment(swarf_machine *machine, const swarf_block *block)
{
    const char *at = swarf_skip_blanks(block->comment, block->comment_end), *end = block->comment_end;
    if (at == end || !strchr("mMdDpPaA", *at)) return SWARF_OK; /* most comments say nothing to the machine */
    const swarf_word word = {0.0, block->comment, (uint32_t)(end - block->comment), 0};
    char text[400];
    const char *rest = after_word(at, end, "msg", 1);
    if (rest) {
        text[0] = 0;
        append(text, sizeof text, rest, (size_t)(end - rest));
    } else if ((rest = after_word(at, end, "debug", 1)) != NULL) {
        if (machine->parameters.numbered[5599] == 0.0) return SWARF_OK;
        expand(machine, rest, end, text, sizeof text);
    } else if ((rest = after_word(at, end, "print", 1)) != NULL) {
        expand(machine, rest, end, text, sizeof text);
    } else if ((rest = after_word(at, end, "abort", 1)) != NULL) {
        expand(machine, rest, end, text, sizeof text);
        return swarf_gcode_fail(machine, &word, "ends the program");
    } else {
        return SWARF_OK;
    }
    return swarf_notes_add(machine->notes, SWARF_NOTE_MESSAGE, machine->place.name, machine->place.line,
                           (uint32_t)(block->comment - block->text) + 1, text);
}
