/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Tools: T, M6, M61, and LinuxCNC's tool table file (its manual, "Tool Table Format"). */
#include "gcode/machine.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/status.h"
#include "program/program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* As large as any control's table; also bounds tool_uses. */
enum { TOOL_MAX = 99999 };

const swarf_gcode_tool *swarf_machine_find_tool(const swarf_machine *machine, int number)
{
    for (size_t i = 0; i < machine->tool_count; i++)
        if (machine->tools[i].number == number) return &machine->tools[i];
    return NULL;
}

/* The tool in the spindle is another one: its length, and an operation of its own. */
static swarf_status load(swarf_machine *machine, const swarf_word *word, int tool)
{
    if (machine->comp.side)
        return swarf_gcode_fail(machine, word, "changes the tool under cutter compensation; write G40 first");
    const swarf_gcode_tool *row = swarf_machine_find_tool(machine, tool);
    if (tool > 0 && machine->has_table && !row)
        return swarf_gcode_fail(machine, word, "loads tool T%d, which is not in the tool table", tool);
    const size_t index = (size_t)tool, room = machine->tool_room_used;
    SWARF_TRY(swarf_array_reserve((void **)&machine->tool_uses, &machine->tool_room_used, index + 1,
                                  sizeof *machine->tool_uses));
    if (machine->tool_room_used > room)
        memset(machine->tool_uses + room, 0, (machine->tool_room_used - room) * sizeof *machine->tool_uses);
    const uint32_t use = ++machine->tool_uses[index];
    char name[40];
    if (use == 1)
        snprintf(name, sizeof name, "T%d", tool);
    else
        snprintf(name, sizeof name, "T%d (%u)", tool, use);
    SWARF_TRY(swarf_program_add_operation(machine->program, name));
    machine->section.operation = (int32_t)swarf_program_operation_count(machine->program) - 1;
    machine->section.tool = tool;
    for (int k = 0; k < 3; k++) machine->length[k] = row ? row->offset[k] : 0.0;
    swarf_machine_reframe(machine);
    return SWARF_OK;
}

static swarf_status change(swarf_machine *machine, const swarf_word *word)
{
    if (machine->selected < 0)
        return swarf_gcode_fail(machine, word, "has no tool to load; write T and its number first");
    SWARF_TRY(load(machine, word, machine->selected));
    machine->modes.spindle = SWARF_SPINDLE_OFF; /* LinuxCNC's manual, M6: stopped when the change is complete */
    machine->section.spindle = SWARF_SPINDLE_OFF;
    SWARF_TRY(swarf_program_set_section(machine->program, &machine->section));
    machine->settled = machine->section;
    machine->is_settled = 1;
    return swarf_program_add_event(machine->program, SWARF_MOVE_TOOL_CHANGE, 0.0, machine->place.line);
}

swarf_status swarf_machine_tool(swarf_machine *machine, swarf_block *block)
{
    if (swarf_block_has(block, 'T'))
        SWARF_TRY(swarf_machine_whole(machine, swarf_block_take(block, 'T'), 0, TOOL_MAX, &machine->selected));
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_TOOL);
    if (!word) return SWARF_OK;
    if (word->value == 6.0) return change(machine, word);
    if (!swarf_block_has(block, 'Q')) return swarf_gcode_fail(machine, word, "needs Q, the number of the tool");
    int tool = 0;
    SWARF_TRY(swarf_machine_whole(machine, swarf_block_take(block, 'Q'), 0, TOOL_MAX, &tool));
    return load(machine, word, tool);
}

/* ---- the file ---- */

typedef struct table {
    const char *path;
    double unit_mm;
    swarf_gcode_tool *rows;
    size_t count, room;
} table;

static swarf_status read_row(table *t, const char *at, const char *end, int line)
{
    const char *begin = at;
    swarf_gcode_tool row;
    memset(&row, 0, sizeof row);
    row.number = -1;
    while (at < end) {
        while (at < end && (*at == ' ' || *at == '\t' || *at == '\r')) at++;
        if (at == end || *at == ';') break;
        const char *word = at;
        const char letter = (char)(*at >= 'a' && *at <= 'z' ? *at - 'a' + 'A' : *at);
        double value = 0.0;
        const char *next = letter >= 'A' && letter <= 'Z' ? swarf_number_read(at + 1, end, &value) : NULL;
        if (!next || !(fabs(value) <= SWARF_COORDINATE_LIMIT_MM))
            return swarf_fail(SWARF_ERROR_FORMAT,
                              "%s:%d:%zu: error: '%c' begins no entry; expected a letter and a number, then ';'",
                              t->path, line, (size_t)(word - begin) + 1, *word >= ' ' && *word <= '~' ? *word : '?');
        at = next;
        const char *axis = strchr("XYZABCUVW", letter);
        const int whole = value == floor(value) && value >= 0.0;
        if (axis)
            row.offset[axis - "XYZABCUVW"] = value * (letter >= 'A' && letter <= 'C' ? 1.0 : t->unit_mm);
        else if (letter == 'D')
            row.diameter_mm = value * t->unit_mm;
        else if ((letter == 'T' || letter == 'P' || letter == 'Q') && !(whole && value <= TOOL_MAX))
            return swarf_fail(SWARF_ERROR_FORMAT, "%s:%d:%zu: error: %c%g must be a whole number from 0 to %d", t->path,
                              line, (size_t)(word - begin) + 1, letter, value, TOOL_MAX);
        else if (letter == 'T')
            row.number = (int32_t)value;
        else if (letter == 'Q')
            row.orientation = (int32_t)value;
        else if (letter != 'P' && letter != 'I' && letter != 'J')
            return swarf_fail(SWARF_ERROR_FORMAT, "%s:%d:%zu: error: '%c' is no entry; T P X to W D I J Q are", t->path,
                              line, (size_t)(word - begin) + 1, letter);
    }
    if (row.number < 0) {
        for (at = begin; at < end && (*at == ' ' || *at == '\t' || *at == '\r'); at++) {
        }
        if (at == end || *at == ';') return SWARF_OK;
        return swarf_fail(SWARF_ERROR_FORMAT, "%s:%d:1: error: the row has no T, the tool's number", t->path, line);
    }
    for (size_t i = 0; i < t->count; i++)
        if (t->rows[i].number == row.number)
            return swarf_fail(SWARF_ERROR_FORMAT, "%s:%d:1: error: T%d has a row already", t->path, line, row.number);
    SWARF_TRY(swarf_array_reserve((void **)&t->rows, &t->room, t->count + 1, sizeof *t->rows));
    t->rows[t->count++] = row;
    return SWARF_OK;
}

swarf_status swarf_gcode_tools_read(const char *path, double unit_mm, swarf_gcode_tool **tools, size_t *count)
{
    SWARF_REQUIRE(path && tools && count && unit_mm > 0.0 && unit_mm <= 1000.0, "tool table: path, unit or output");
    char *data;
    size_t length;
    SWARF_TRY(swarf_file_read(path, &data, &length));
    table t = {path, unit_mm, NULL, 0, 0};
    swarf_status status = SWARF_OK;
    int line = 0;
    for (const char *at = data, *end = data + length; at < end && status == SWARF_OK;) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        if (!stop) stop = end;
        status = read_row(&t, at, stop, ++line);
        at = stop < end ? stop + 1 : end;
    }
    free(data);
    if (status == SWARF_OK && t.count == 0) status = swarf_array_reserve((void **)&t.rows, &t.room, 1, sizeof *t.rows);
    if (status != SWARF_OK) {
        free(t.rows);
        return status;
    }
    *tools = t.rows;
    *count = t.count;
    return SWARF_OK;
}

void swarf_gcode_tools_free(swarf_gcode_tool *tools)
{
    free(tools);
}
