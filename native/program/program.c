/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Program: the flat array of moves, the arcs and sections they point to, the names of operations and sources, and
 * beside them the rare rows that say where A B C U V W stand.
 *
 *     moves    [40 B each]  end | feed | line | arc ----> arcs     [48 B each]
 *                                   section_kind >> 3 --> sections [32 B each] -- operation --> names
 *     slots    open addressing hash of the sections, half empty at least, holding index + 1
 *
 * Appending is the hot path (ten million moves): a move touches the section table only after
 * swarf_program_set_section() or swarf_program_add_operation() changed something, and a section enters the
 * table with the first move that uses it.
 */
#include "program/program.h"

#include "base/memory.h"
#include "base/mix.h"
#include "base/status.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

struct swarf_program {
    atomic_int references;
    double start[3];
    double position[3];
    swarf_move *moves;
    size_t move_count, move_room;
    swarf_arc *arcs;
    size_t arc_count, arc_room;
    swarf_section *sections;
    size_t section_count, section_room;
    uint32_t *slots;
    size_t slot_count; /* a power of two, or 0 */
    char **operations;
    size_t operation_count, operation_room;
    char **sources;
    size_t source_count, source_room;
    swarf_axes *axes;
    size_t axes_count, axes_room;
    double axes_now[6];
    int axes_stale; /* `axes_now` is not what the last row says */
    swarf_section current;
    uint32_t current_index;
    int current_stale; /* `current` has no index yet */
};

_Static_assert(sizeof(swarf_move) == 40, "a move is 40 bytes");

/* section_kind keeps 29 bits for the section, arc 31 for the arc. */
static const size_t section_limit = (size_t)1 << 29;
static const size_t arc_limit = INT32_MAX;

/* Feeds and seconds are kept as floats; beyond this they are mistakes. */
static const double value_limit = 1e9;

/* From this size on growing asks first what the system has left: a file must not swap the host to death. */
static const size_t ask_from_bytes = (size_t)256 << 20;

swarf_status swarf_program_create(const double *start, swarf_program **out)
{
    SWARF_REQUIRE(out, "program: output missing");
    for (int k = 0; start && k < 3; k++)
        SWARF_REQUIRE(isnan(start[k]) || fabs(start[k]) <= SWARF_COORDINATE_LIMIT_MM,
                      "program: start %c is %g; at most %g mm, or NAN for unknown", "XYZ"[k], start[k],
                      SWARF_COORDINATE_LIMIT_MM);
    swarf_program *program = calloc(1, sizeof *program);
    if (!program) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    atomic_init(&program->references, 1);
    for (int k = 0; k < 3; k++) program->position[k] = program->start[k] = start ? start[k] : NAN;
    program->current.tool = -1;
    program->current.work_offset = 1;
    program->current_stale = 1;
    *out = program;
    return SWARF_OK;
}

swarf_program *swarf_program_retain(swarf_program *program)
{
    if (program) atomic_fetch_add_explicit(&program->references, 1, memory_order_relaxed);
    return program;
}

void swarf_program_release(swarf_program *program)
{
    if (!program || atomic_fetch_sub_explicit(&program->references, 1, memory_order_acq_rel) != 1) return;
    for (size_t i = 0; i < program->operation_count; i++) free(program->operations[i]);
    free(program->operations);
    for (size_t i = 0; i < program->source_count; i++) free(program->sources[i]);
    free(program->sources);
    free(program->axes);
    free(program->slots);
    free(program->sections);
    free(program->arcs);
    free(program->moves);
    free(program);
}

/* Append a copy of `name` to a list of names. */
static swarf_status add_name(char ***names, size_t *count, size_t *room, const char *name)
{
    if (*count >= INT32_MAX) return swarf_fail(SWARF_ERROR_MEMORY, "program: too many names");
    SWARF_TRY(swarf_array_reserve((void **)names, room, *count + 1, sizeof **names));
    const size_t size = strlen(name) + 1;
    char *copy = malloc(size);
    if (!copy) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    memcpy(copy, name, size);
    (*names)[(*count)++] = copy;
    return SWARF_OK;
}

swarf_status swarf_program_add_operation(swarf_program *program, const char *name)
{
    SWARF_REQUIRE(program && name, "program: operation without a name");
    SWARF_TRY(add_name(&program->operations, &program->operation_count, &program->operation_room, name));
    program->current.operation = (int32_t)program->operation_count - 1;
    program->current_stale = 1;
    return SWARF_OK;
}

swarf_status swarf_program_add_source(swarf_program *program, const char *name, int32_t *index)
{
    SWARF_REQUIRE(program && name && index, "program: source without a name");
    SWARF_TRY(add_name(&program->sources, &program->source_count, &program->source_room, name));
    *index = (int32_t)program->source_count - 1;
    return SWARF_OK;
}

swarf_status swarf_program_set_axes(swarf_program *program, const double value[6])
{
    SWARF_REQUIRE(program && value, "program: NULL");
    for (int k = 0; k < 6; k++)
        SWARF_REQUIRE(fabs(value[k]) <= SWARF_COORDINATE_LIMIT_MM, "program: %c is %g; at most %g is possible",
                      "ABCUVW"[k], value[k], SWARF_COORDINATE_LIMIT_MM);
    for (int k = 0; k < 6; k++) {
        program->axes_stale |= program->axes_now[k] != value[k];
        program->axes_now[k] = value[k];
    }
    return SWARF_OK;
}

swarf_status swarf_program_set_section(swarf_program *program, const swarf_section *section)
{
    SWARF_REQUIRE(program && section, "program: NULL");
    SWARF_REQUIRE(section->operation >= 0 && (size_t)section->operation < program->operation_count,
                  "program: section of operation %d, but %zu were added", (int)section->operation,
                  program->operation_count);
    SWARF_REQUIRE(isfinite(section->spindle_rpm) && section->spindle_rpm >= 0.0,
                  "program: spindle speed %g rpm; it must be finite and not negative", section->spindle_rpm);
    SWARF_REQUIRE(section->spindle >= SWARF_SPINDLE_OFF && section->spindle <= SWARF_SPINDLE_CCW,
                  "program: %d is not a spindle state", (int)section->spindle);
    SWARF_REQUIRE(section->tool >= -1, "program: tool number %d; -1 means none", (int)section->tool);
    SWARF_REQUIRE(section->source >= 0 && (section->source == 0 || (size_t)section->source < program->source_count),
                  "program: section of source %d, but %zu were added", (int)section->source, program->source_count);
    program->current = *section;
    program->current.spindle_rpm += 0.0; /* -0 becomes 0: sections are compared by their bytes */
    program->current_stale = 1;
    return SWARF_OK;
}

static uint64_t section_hash(const swarf_section *section)
{
    uint64_t words[sizeof *section / 8], hash = 0;
    memcpy(words, section, sizeof words);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) hash = swarf_mix_in(hash, words[i]);
    return hash;
}
_Static_assert(sizeof(swarf_section) == 32, "sections have no padding to hash");

/* The slot that holds `section`, or the empty one where it belongs. */
static size_t section_slot(const swarf_program *program, const swarf_section *section)
{
    const size_t mask = program->slot_count - 1;
    size_t slot = (size_t)section_hash(section) & mask;
    while (program->slots[slot] && memcmp(&program->sections[program->slots[slot] - 1], section, sizeof *section) != 0)
        slot = (slot + 1) & mask;
    return slot;
}

static swarf_status slots_grow(swarf_program *program)
{
    const size_t count = program->slot_count ? program->slot_count * 2 : 16;
    uint32_t *slots = calloc(count, sizeof *slots);
    if (!slots) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    free(program->slots);
    program->slots = slots;
    program->slot_count = count;
    for (size_t i = 0; i < program->section_count; i++)
        slots[section_slot(program, &program->sections[i])] = (uint32_t)i + 1;
    return SWARF_OK;
}

/* Give the current section its index. */
static swarf_status settle_section(swarf_program *program)
{
    if (program->operation_count == 0) SWARF_TRY(swarf_program_add_operation(program, "program"));
    if (2 * (program->section_count + 1) > program->slot_count) SWARF_TRY(slots_grow(program));
    const size_t slot = section_slot(program, &program->current);
    if (!program->slots[slot]) {
        if (program->section_count >= section_limit)
            return swarf_fail(SWARF_ERROR_MEMORY, "program: too many sections");
        SWARF_TRY(swarf_array_reserve((void **)&program->sections, &program->section_room, program->section_count + 1,
                                      sizeof *program->sections));
        program->sections[program->section_count++] = program->current;
        program->slots[slot] = (uint32_t)program->section_count;
    }
    program->current_index = program->slots[slot] - 1;
    program->current_stale = 0;
    return SWARF_OK;
}

static swarf_status reserve_moves(swarf_program *program)
{
    if (program->move_count < program->move_room) return SWARF_OK;
    const size_t bytes = 2 * program->move_room * sizeof *program->moves;
    if (bytes >= ask_from_bytes && bytes / 2 > swarf_memory_free())
        return swarf_fail(SWARF_ERROR_MEMORY, "program: no memory for more than %zu moves", program->move_count);
    return swarf_array_reserve((void **)&program->moves, &program->move_room, program->move_count + 1,
                               sizeof *program->moves);
}

swarf_status swarf_program_push(swarf_program *program, swarf_move_kind kind, const double end[3], const swarf_arc *arc,
                                double value, uint32_t line)
{
    if (program->current_stale) SWARF_TRY(settle_section(program));
    SWARF_TRY(reserve_moves(program));
    if (program->axes_stale) {
        SWARF_TRY(swarf_array_reserve((void **)&program->axes, &program->axes_room, program->axes_count + 1,
                                      sizeof *program->axes));
        swarf_axes *row = &program->axes[program->axes_count++];
        row->first = program->move_count;
        memcpy(row->value, program->axes_now, sizeof row->value);
        program->axes_stale = 0;
    }
    int32_t arc_index = -1;
    if (arc) {
        if (program->arc_count >= arc_limit) return swarf_fail(SWARF_ERROR_MEMORY, "program: too many arcs");
        SWARF_TRY(swarf_array_reserve((void **)&program->arcs, &program->arc_room, program->arc_count + 1,
                                      sizeof *program->arcs));
        arc_index = (int32_t)program->arc_count;
        program->arcs[program->arc_count++] = *arc;
    }
    swarf_move *move = &program->moves[program->move_count++];
    for (int k = 0; k < 3; k++) program->position[k] = move->end[k] = end[k];
    move->feed_mm_min = (float)value;
    move->line = line;
    move->arc = arc_index;
    move->section_kind = program->current_index << 3 | (uint32_t)kind;
    return SWARF_OK;
}

static int position_known(const swarf_program *program)
{
    return !(isnan(program->position[0]) || isnan(program->position[1]) || isnan(program->position[2]));
}

/* An end may be NAN only where the position is: an axis that nobody has commanded yet. */
static swarf_status check_move(const swarf_program *program, const double end[3], double feed_mm_min, uint32_t line)
{
    for (int k = 0; k < 3; k++) {
        if (isnan(end[k]) && isnan(program->position[k])) continue;
        SWARF_REQUIRE(isfinite(end[k]), "line %u: %c is not finite", line, "XYZ"[k]);
        SWARF_REQUIRE(fabs(end[k]) <= SWARF_COORDINATE_LIMIT_MM, "line %u: %c is %g mm; at most %g is possible", line,
                      "XYZ"[k], end[k], SWARF_COORDINATE_LIMIT_MM);
    }
    SWARF_REQUIRE(feed_mm_min >= 0.0 && feed_mm_min <= value_limit, "line %u: feed %g; 0 to %g mm/min are possible",
                  line, feed_mm_min, value_limit);
    return SWARF_OK;
}

swarf_status swarf_program_add_line(swarf_program *program, swarf_move_kind kind, const double end[3],
                                    double feed_mm_min, uint32_t line)
{
    SWARF_REQUIRE(program && end, "line %u: NULL", line);
    SWARF_REQUIRE(kind == SWARF_MOVE_RAPID || kind == SWARF_MOVE_FEED || kind == SWARF_MOVE_PROBE ||
                      kind == SWARF_MOVE_POSITION,
                  "line %u: kind %d is no straight move", line, (int)kind);
    SWARF_TRY(check_move(program, end, feed_mm_min, line));
    if (!position_known(program)) kind = SWARF_MOVE_POSITION;
    const int fed = kind == SWARF_MOVE_FEED || kind == SWARF_MOVE_PROBE;
    return swarf_program_push(program, kind, end, NULL, fed ? feed_mm_min : 0.0, line);
}

swarf_status swarf_program_add_arc(swarf_program *program, const double end[3], const double centre[3],
                                   swarf_plane plane, int ccw, int turns, double feed_mm_min, uint32_t line)
{
    SWARF_REQUIRE(program && end && centre, "line %u: NULL", line);
    SWARF_TRY(check_move(program, end, feed_mm_min, line));
    swarf_arc arc;
    const swarf_status status = swarf_arc_make(program->position, end, centre, plane, ccw, turns, 0.0, &arc);
    if (status != SWARF_OK) return swarf_fail_within(status, "line %u", line);
    /* height unknown: there is nothing to sweep, only a place to arrive at */
    if (!position_known(program)) return swarf_program_push(program, SWARF_MOVE_POSITION, end, NULL, 0.0, line);
    return swarf_program_push(program, SWARF_MOVE_FEED, end, &arc, feed_mm_min, line);
}

swarf_status swarf_program_add_event(swarf_program *program, swarf_move_kind kind, double value, uint32_t line)
{
    SWARF_REQUIRE(program, "line %u: NULL", line);
    SWARF_REQUIRE(kind == SWARF_MOVE_DWELL || kind == SWARF_MOVE_TOOL_CHANGE, "line %u: kind %d is no event", line,
                  (int)kind);
    SWARF_REQUIRE(value >= 0.0 && value <= value_limit, "line %u: %g; 0 to %g are possible", line, value, value_limit);
    const double here[3] = {program->position[0], program->position[1], program->position[2]};
    return swarf_program_push(program, kind, here, NULL, kind == SWARF_MOVE_DWELL ? value : 0.0, line);
}

size_t swarf_program_move_count(const swarf_program *program)
{
    return program ? program->move_count : 0;
}

const swarf_move *swarf_program_moves(const swarf_program *program)
{
    return program ? program->moves : NULL;
}

size_t swarf_program_arc_count(const swarf_program *program)
{
    return program ? program->arc_count : 0;
}

const swarf_arc *swarf_program_arcs(const swarf_program *program)
{
    return program ? program->arcs : NULL;
}

size_t swarf_program_section_count(const swarf_program *program)
{
    return program ? program->section_count : 0;
}

const swarf_section *swarf_program_sections(const swarf_program *program)
{
    return program ? program->sections : NULL;
}

size_t swarf_program_operation_count(const swarf_program *program)
{
    return program ? program->operation_count : 0;
}

const char *swarf_program_operation_name(const swarf_program *program, size_t index)
{
    return program && index < program->operation_count ? program->operations[index] : NULL;
}

size_t swarf_program_source_count(const swarf_program *program)
{
    return program ? program->source_count : 0;
}

const char *swarf_program_source_name(const swarf_program *program, size_t index)
{
    return program && index < program->source_count ? program->sources[index] : index == 0 ? "" : NULL;
}

size_t swarf_program_axes_count(const swarf_program *program)
{
    return program ? program->axes_count : 0;
}

const swarf_axes *swarf_program_axes(const swarf_program *program)
{
    return program ? program->axes : NULL;
}

int swarf_program_move_axes(const swarf_program *program, size_t index, double start[6], double end[6])
{
    for (int k = 0; k < 6; k++) start[k] = end[k] = 0.0;
    if (!program || program->axes_count == 0) return 0;
    size_t lo = 0, hi = program->axes_count; /* rows before `lo` have begun at `index`, rows from `hi` on have not */
    while (lo < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (program->axes[middle].first <= index)
            lo = middle + 1;
        else
            hi = middle;
    }
    if (lo == 0) return 0;
    memcpy(end, program->axes[lo - 1].value, sizeof program->axes->value);
    if (program->axes[lo - 1].first < index)
        memcpy(start, end, sizeof program->axes->value);
    else if (lo > 1)
        memcpy(start, program->axes[lo - 2].value, sizeof program->axes->value);
    int off_zero = 0;
    for (int k = 0; k < 6; k++) off_zero |= start[k] != 0.0 || end[k] != 0.0;
    return off_zero;
}

void swarf_program_move_start(const swarf_program *program, size_t index, double out[3])
{
    const int known = program && index < program->move_count;
    for (int k = 0; k < 3; k++) out[k] = !known ? NAN : index ? program->moves[index - 1].end[k] : program->start[k];
}

swarf_status swarf_program_path(const swarf_program *program, size_t index, swarf_path *out)
{
    SWARF_REQUIRE(program && out, "program: NULL");
    SWARF_REQUIRE(index < program->move_count, "program: move %zu of %zu", index, program->move_count);
    const swarf_move *move = &program->moves[index];
    const swarf_move_kind kind = swarf_move_get_kind(move);
    swarf_path path;
    memset(&path, 0, sizeof path);
    swarf_program_move_start(program, index, path.start);
    memcpy(path.end, move->end, sizeof path.end);
    path.is_arc = move->arc >= 0;
    if (path.is_arc) path.arc = program->arcs[move->arc];
    const int still = path.start[0] == path.end[0] && path.start[1] == path.end[1] && path.start[2] == path.end[2];
    path.has_motion = kind == SWARF_MOVE_FEED || ((kind == SWARF_MOVE_RAPID || kind == SWARF_MOVE_PROBE) && !still);
    *out = path;
    return SWARF_OK;
}

double swarf_program_seconds(const swarf_program *program, double rapid_mm_min)
{
    double seconds = 0.0;
    for (size_t i = 0; i < swarf_program_move_count(program); i++) {
        const swarf_move *move = &program->moves[i];
        const swarf_move_kind kind = swarf_move_get_kind(move);
        if (kind == SWARF_MOVE_DWELL) seconds += (double)move->feed_mm_min;
        const double speed = kind == SWARF_MOVE_RAPID ? rapid_mm_min : (double)move->feed_mm_min;
        swarf_path path;
        if (speed > 0.0 && swarf_program_path(program, i, &path) == SWARF_OK && path.has_motion)
            seconds += 60.0 * swarf_path_length(&path) / speed;
    }
    return seconds;
}
