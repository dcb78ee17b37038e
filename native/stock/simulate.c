/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Playing a program on a stock: moves in order, in batches that share a tool and an operation. */
#include "stock/simulate.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/cut.h"
#include "stock/measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct swarf_simulation {
    double *removed; /* per operation */
    size_t operation_count;
    double *per_move;
    size_t per_move_count;
    double initial, final;
    swarf_finding *findings;
    size_t finding_count, finding_room;
};

/* No more moves than this at once: 100 MB of tracks and bins, while a batch is already as good as the whole. */
enum { MOST_AT_ONCE = 1 << 18, WATCHED_AT_ONCE = 1 << 14 };

/* Bytes of an operation's name that a finding has room for. */
enum { MOST_NAME = 80 };

struct player {
    swarf_stock *stock;
    const swarf_program *program;
    const swarf_tool *tools;
    size_t tool_count;
    swarf_body **bodies; /* per tool, made when first used */
    swarf_simulation *result;
    const swarf_progress *progress;
    const swarf_watch *watch; /* or NULL */
    int stopped;
    size_t first, count, batch;
    swarf_path *paths;
    size_t path_room;
    size_t *cuts; /* per operation: 1 + the first move that had a tool to cut with, 0: none */
};

swarf_simulation_options swarf_simulation_options_default(void)
{
    return (swarf_simulation_options){.size = sizeof(swarf_simulation_options)};
}

void swarf_simulation_destroy(swarf_simulation *simulation)
{
    if (!simulation) return;
    free(simulation->removed);
    free(simulation->per_move);
    free(simulation->findings);
    free(simulation);
}

const double *swarf_simulation_removed(const swarf_simulation *simulation, size_t *count)
{
    *count = simulation ? simulation->operation_count : 0;
    return simulation ? simulation->removed : NULL;
}

const double *swarf_simulation_removed_per_move(const swarf_simulation *simulation, size_t *count)
{
    *count = simulation ? simulation->per_move_count : 0;
    return simulation ? simulation->per_move : NULL;
}

double swarf_simulation_volume_initial(const swarf_simulation *simulation)
{
    return simulation ? simulation->initial : 0;
}

double swarf_simulation_volume_final(const swarf_simulation *simulation)
{
    return simulation ? simulation->final : 0;
}

const swarf_finding *swarf_simulation_findings(const swarf_simulation *simulation, size_t *count)
{
    *count = simulation ? simulation->finding_count : 0;
    return simulation ? simulation->findings : NULL;
}

const char *swarf_finding_name(swarf_finding_kind kind)
{
    static const char *const names[SWARF_FINDING_COUNT] = {"no tool", "unknown tool", "no flutes", "axis", "idle"};
    return (unsigned)kind < SWARF_FINDING_COUNT ? names[kind] : "";
}

/* A finding at a move, its text still to be written. */
static swarf_status add_finding(struct player *player, swarf_finding_kind kind, size_t move, swarf_finding **out)
{
    swarf_simulation *result = player->result;
    const swarf_move *at = &swarf_program_moves(player->program)[move];
    const swarf_section *section = &swarf_program_sections(player->program)[swarf_move_get_section(at)];
    SWARF_TRY(swarf_array_reserve((void **)&result->findings, &result->finding_room, result->finding_count + 1,
                                  sizeof *result->findings));
    *out = &result->findings[result->finding_count++];
    **out = (swarf_finding){.severity = kind == SWARF_FINDING_IDLE ? SWARF_NOTE : SWARF_ERROR,
                            .kind = (int32_t)kind,
                            .operation = section->operation,
                            .move = move,
                            .line = at->line,
                            .tool = section->tool};
    return SWARF_OK;
}

/* An error at a move; NULL in *out when the operation has one for this tool already. */
static swarf_status add_error(struct player *player, swarf_finding_kind kind, size_t move, const swarf_section *section,
                              swarf_finding **out)
{
    const swarf_simulation *result = player->result;
    *out = NULL;
    for (size_t i = 0; i < result->finding_count; i++)
        if (result->findings[i].tool == section->tool && result->findings[i].operation == section->operation)
            return SWARF_OK;
    return add_finding(player, kind, move, out);
}

static const char *operation_of(const struct player *player, const swarf_section *section)
{
    return section->operation >= 0 && (size_t)section->operation < player->result->operation_count
               ? swarf_program_operation_name(player->program, (size_t)section->operation)
               : "";
}

/* Bytes of an operation's name that a text has: whole characters of UTF-8. */
static int name_bytes(const char *name)
{
    size_t count = strlen(name);
    if (count <= MOST_NAME) return (int)count;
    for (count = MOST_NAME; count && ((unsigned char)name[count] & 0xC0) == 0x80;) count--;
    return (int)count;
}

static swarf_status report_tool(struct player *player, size_t move, const swarf_section *section,
                                swarf_finding_kind kind)
{
    swarf_finding *finding;
    SWARF_TRY(add_error(player, section->tool < 0 ? SWARF_FINDING_NO_TOOL : kind, move, section, &finding));
    if (!finding) return SWARF_OK;
    const char *operation = operation_of(player, section);
    if (section->tool < 0)
        snprintf(finding->text, sizeof finding->text,
                 "operation '%.*s' moves before any tool is loaded; nothing was cut", name_bytes(operation), operation);
    else
        snprintf(finding->text, sizeof finding->text, "operation '%.*s': tool T%d %s; nothing was cut",
                 name_bytes(operation), operation, (int)section->tool,
                 kind == SWARF_FINDING_NO_FLUTES ? "has no flutes" : "is not in the tool table");
    return SWARF_OK;
}

/* Whether the move is one that cannot be simulated: with A, B, C, U, V or W elsewhere than at 0. */
static swarf_status check_axes(struct player *player, size_t move, const swarf_section *section, int *turned)
{
    double from[6], to[6];
    *turned = swarf_program_move_axes(player->program, move, from, to);
    if (!*turned) return SWARF_OK;
    swarf_finding *finding;
    SWARF_TRY(add_error(player, SWARF_FINDING_AXIS, move, section, &finding));
    if (!finding) return SWARF_OK;
    int axis = 0;
    while (axis < 5 && from[axis] == 0.0 && to[axis] == 0.0) axis++;
    finding->axis = axis;
    finding->value = to[axis];
    const char *operation = operation_of(player, section);
    snprintf(finding->text, sizeof finding->text,
             "operation '%.*s': axis %c moves to %.6g; turned and shifted poses are not simulated, they cut nothing",
             name_bytes(operation), operation, "ABCUVW"[axis], to[axis]);
    return SWARF_OK;
}

/* The body of the section's tool; NULL with a finding when there is none that cuts. */
static swarf_status find_body(struct player *player, size_t move, const swarf_section *section, const swarf_body **out)
{
    *out = NULL;
    for (size_t i = 0; i < player->tool_count; i++) {
        if (player->tools[i].number != section->tool || !player->tools[i].cutter) continue;
        if (!player->bodies[i])
            SWARF_TRY(swarf_body_create(player->tools[i].cutter, SWARF_PART_FLUTES, swarf_stock_voxel(player->stock),
                                        &player->bodies[i]));
        if (player->bodies[i]->component_count == 0) return report_tool(player, move, section, SWARF_FINDING_NO_FLUTES);
        *out = player->bodies[i];
        return SWARF_OK;
    }
    return report_tool(player, move, section, SWARF_FINDING_UNKNOWN_TOOL);
}

/* Cut moves first .. end - 1, which share a tool. */
static swarf_status play_batch(struct player *player, size_t first, size_t end, const swarf_section *section)
{
    SWARF_TRY(swarf_array_reserve((void **)&player->paths, &player->path_room, end - first, sizeof *player->paths));
    size_t used = 0, first_moving = first;
    for (size_t i = first; i < end; i++) {
        SWARF_TRY(swarf_program_path(player->program, i, &player->paths[used]));
        if (!player->paths[used].has_motion) continue;
        int turned;
        SWARF_TRY(check_axes(player, i, section, &turned));
        if (turned) continue;
        if (used++ == 0) first_moving = i;
    }
    const double from = (double)(first - player->first) / (double)player->count;
    const double to = (double)(end - player->first) / (double)player->count;
    const swarf_body *body = NULL;
    if (used) SWARF_TRY(find_body(player, first_moving, section, &body));
    if (player->watch) SWARF_TRY(player->watch->play(player->watch->context, first, end, from, to, &player->stopped));
    if (!body) return swarf_progress_report(player->progress, to);
    size_t *cuts = section->operation >= 0 ? &player->cuts[section->operation] : NULL;
    if (cuts && *cuts == 0) *cuts = first_moving + 1;
    if (player->watch) return swarf_progress_report(player->progress, to);
    return swarf_cut_body(player->stock, body, player->paths, used, player->progress, from, to);
}

static swarf_status account(struct player *player, double *volume, double *removed)
{
    double now;
    SWARF_TRY(swarf_measure_volume(player->stock, &now));
    *removed += *volume - now;
    *volume = now;
    return SWARF_OK;
}

/* Say which operations had a tool and moves but removed nothing: the origin or the order may be wrong. */
static swarf_status report_idle(struct player *player)
{
    const swarf_simulation *result = player->result;
    const double voxel = swarf_stock_voxel(player->stock), least = 1e-3 * voxel * voxel * voxel;
    for (size_t i = 0; i < result->operation_count; i++) {
        if (player->cuts[i] == 0 || result->removed[i] > least) continue;
        swarf_finding *finding;
        SWARF_TRY(add_finding(player, SWARF_FINDING_IDLE, player->cuts[i] - 1, &finding));
        const char *operation = swarf_program_operation_name(player->program, i);
        snprintf(finding->text, sizeof finding->text,
                 "operation '%.*s' removes nothing: its moves do not meet what is left of the stock",
                 name_bytes(operation), operation);
    }
    return SWARF_OK;
}

static swarf_status play(struct player *player)
{
    const swarf_move *moves = swarf_program_moves(player->program);
    const swarf_section *sections = swarf_program_sections(player->program);
    swarf_simulation *result = player->result;
    SWARF_TRY(swarf_measure_volume(player->stock, &result->initial));
    double volume = result->initial;
    const size_t last = player->first + player->count;
    for (size_t i = player->first; i < last && !player->stopped;) {
        const swarf_section *section = &sections[swarf_move_get_section(&moves[i])];
        size_t end = i + 1;
        while (end < last && end - i < player->batch) {
            const swarf_section *next = &sections[swarf_move_get_section(&moves[end])];
            if (next->tool != section->tool || next->operation != section->operation) break;
            end++;
        }
        SWARF_TRY(play_batch(player, i, end, section));
        const int new_operation = end == last || player->stopped ||
                                  sections[swarf_move_get_section(&moves[end])].operation != section->operation;
        double removed = 0;
        if (new_operation || result->per_move) SWARF_TRY(account(player, &volume, &removed));
        if (section->operation >= 0 && (size_t)section->operation < result->operation_count)
            result->removed[section->operation] += removed;
        if (result->per_move) result->per_move[i - player->first] = removed;
        i = end;
    }
    result->final = volume;
    /* of a part of a program nobody can say what the rest does */
    const int whole = player->count == swarf_program_move_count(player->program) && !player->stopped;
    return whole ? report_idle(player) : SWARF_OK;
}

swarf_status swarf_simulate_watched(swarf_stock *stock, const swarf_program *program, size_t first, size_t count,
                                    const swarf_tool *tools, size_t tool_count, const swarf_simulation_options *options,
                                    const swarf_progress *progress, const swarf_watch *watch, swarf_simulation **out)
{
    const int per_move = options && options->removed_per_move;
    struct player player = {.stock = stock,
                            .program = program,
                            .tools = tools,
                            .tool_count = tool_count,
                            .progress = progress,
                            .watch = watch,
                            .first = first,
                            .count = count,
                            .batch = watch ? WATCHED_AT_ONCE : MOST_AT_ONCE};
    if (options && options->batch && options->batch < player.batch) player.batch = options->batch;
    if (per_move) player.batch = 1;
    swarf_simulation *result = calloc(1, sizeof *result);
    player.result = result;
    player.bodies = calloc(tool_count ? tool_count : 1, sizeof *player.bodies);
    player.cuts = calloc(swarf_program_operation_count(program) + 1, sizeof *player.cuts);
    swarf_status status = SWARF_OK;
    if (result) {
        result->operation_count = swarf_program_operation_count(program);
        result->removed = calloc(result->operation_count + 1, sizeof *result->removed);
        result->per_move_count = per_move ? count : 0;
        if (per_move) result->per_move = calloc(count + 1, sizeof *result->per_move);
    }
    if (!result || !player.bodies || !player.cuts || !result->removed || (per_move && !result->per_move))
        status = swarf_fail(SWARF_ERROR_MEMORY, "simulation: out of memory");
    if (status == SWARF_OK) status = play(&player);
    for (size_t i = 0; player.bodies && i < tool_count; i++) swarf_body_destroy(player.bodies[i]);
    free(player.bodies);
    free(player.cuts);
    free(player.paths);
    if (status != SWARF_OK) {
        swarf_simulation_destroy(result);
        return status;
    }
    *out = result;
    return SWARF_OK;
}

swarf_status swarf_stock_simulate(swarf_stock *stock, const swarf_program *program, size_t first, size_t count,
                                  const swarf_tool *tools, size_t tool_count, const swarf_simulation_options *options,
                                  const swarf_progress *progress, swarf_simulation **out)
{
    SWARF_REQUIRE(program && out && (tools || tool_count == 0), "simulation: program, tools or output missing");
    SWARF_REQUIRE(!options || options->size == sizeof *options, "simulation: options of another version");
    const size_t total = swarf_program_move_count(program);
    SWARF_REQUIRE(first <= total && count <= total - first, "simulation: moves %zu .. %zu of %zu", first, first + count,
                  total);
    SWARF_TRY(swarf_stock_enter_write(stock));
    const swarf_status status =
        swarf_simulate_watched(stock, program, first, count, tools, tool_count, options, progress, NULL, out);
    swarf_stock_leave(stock);
    return status;
}
