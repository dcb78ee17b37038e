/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* History: positions of a stock along a program.
 *
 *   runs        stretches of moves with one body; positions within are counted from the run's first move
 *   batches     what a position p of a run is cut in: 4096, 512, 64, 8 or 1 moves, largest first, as they fit; that
 *               is, the digits of p in base 8. The runs that are already behind are cut in the same way
 *   way points  of a position: where those batches end. At a way point the stock is the same, to the bit, as when
 *               that was where to go; so a way starts from any of them
 *   records     what each batch changed, a stack: to go back is to undo down to a way point and cut the rest
 *   keyframes   copies of the stock at multiples of 4096 moves and at ends of runs: way points of all later positions
 */
#include "swarf/history.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/cut.h"
#include "stock/undo.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Steps of batch sizes and the largest one. A step back undoes one batch and cuts what is shorter by a move, on the
 * average one batch again: with base 8 that is a single move 7 times of 8, and the positions up to the next 8th share
 * what comes before. Smaller steps cut more moves again (1000 steps back on bear at N=1024 take 1.5 times as long with
 * base 2), larger ones more batches on the way to any one place (19 on bear with base 8, 9 with base 2). Larger batches
 * cut hardly faster, while this many moves are what may have to be cut again to step back by one. */
enum { BASE = 8, LARGEST = 4096 };

/* A jump to a keyframe compares the stocks as a whole, which takes as long as cutting some thousand moves. */
enum { JUMP = LARGEST };

/* Slots recorded between two keyframes, per slot that a copy takes, at first: a copy then costs a few per cent of the
 * cutting between. Doubled whenever keyframes fill their half of the memory limit. */
enum { FIRST_SPACING = 16 };

struct keyframe {
    size_t move;
    swarf_stock *stock;
    size_t bytes;
};

struct swarf_history {
    swarf_stock *stock; /* the caller's */
    swarf_program *program;
    swarf_body **bodies; /* per tool */
    size_t body_count;
    const swarf_body **section_bodies; /* NULL: cuts nothing */
    size_t *runs;                      /* first moves of them */
    size_t run_count, run_room;
    swarf_stock *first; /* as it was */
    size_t first_bytes, limit;
    size_t at;
    double fraction;
    uint32_t generation; /* of the stock, as it was left */
    int has_part;        /* the topmost record is that of a part of a move */
    int is_torn;         /* putting back failed half way: what the stock holds is nothing */
    swarf_undo undo;
    struct keyframe *keyframes; /* by ascending move */
    size_t keyframe_count, keyframe_room, keyframe_bytes;
    size_t cut_slots; /* since the last keyframe */
    size_t spacing;
    swarf_path *paths;
    size_t path_room;
};

swarf_history_options swarf_history_options_default(void)
{
    return (swarf_history_options){.size = sizeof(swarf_history_options)};
}

/* ---- positions --------------------------------------------------------------------------------------------------- */

static size_t find_run(const swarf_history *history, size_t move)
{
    size_t lo = 0, hi = history->run_count;
    while (hi - lo > 1) {
        const size_t middle = lo + (hi - lo) / 2;
        if (history->runs[middle] <= move)
            lo = middle;
        else
            hi = middle;
    }
    return lo;
}

static size_t run_end(const swarf_history *history, size_t run)
{
    return run + 1 < history->run_count ? history->runs[run + 1] : swarf_program_move_count(history->program);
}

/* Is `move` a way point of `target`? */
static int is_on_way(const swarf_history *history, size_t move, size_t target)
{
    if (move >= target) return move == target;
    const size_t run = find_run(history, move), begin = history->runs[run], end = run_end(history, run);
    const size_t done = move - begin, wanted = (target < end ? target : end) - begin;
    size_t size = 1;
    while (size < LARGEST && done % (size * BASE) == 0) size *= BASE;
    return size == LARGEST || done / (size * BASE) == wanted / (size * BASE);
}

/* Where the next batch ends, from a way point of `target`. */
static size_t next_stop(const swarf_history *history, size_t move, size_t target)
{
    const size_t run = find_run(history, move), begin = history->runs[run], end = run_end(history, run);
    const size_t done = move - begin, wanted = (target < end ? target : end) - begin;
    size_t size = 1;
    while (size < LARGEST && done % (size * BASE) == 0 && done + size * BASE <= wanted) size *= BASE;
    return move + size;
}

/* May a keyframe be here: is it a way point of every later position? */
static int is_stop(const swarf_history *history, size_t move)
{
    return (move - history->runs[find_run(history, move)]) % LARGEST == 0;
}

/* ---- making ------------------------------------------------------------------------------------------------------ */

static swarf_status take_tools(swarf_history *history, const swarf_tool *tools, size_t count)
{
    const size_t sections = swarf_program_section_count(history->program);
    history->bodies = calloc(count + 1, sizeof *history->bodies);
    history->section_bodies = calloc(sections + 1, sizeof *history->section_bodies);
    if (!history->bodies || !history->section_bodies) return swarf_fail(SWARF_ERROR_MEMORY, "history: out of memory");
    history->body_count = count;
    for (size_t i = 0; i < count; i++)
        if (tools[i].cutter)
            SWARF_TRY(swarf_body_create(tools[i].cutter, SWARF_PART_FLUTES, swarf_stock_voxel(history->stock),
                                        &history->bodies[i]));
    for (size_t s = 0; s < sections; s++) {
        size_t i = 0;
        while (i < count && (tools[i].number != swarf_program_sections(history->program)[s].tool || !tools[i].cutter))
            i++;
        if (i < count && history->bodies[i]->component_count) history->section_bodies[s] = history->bodies[i];
    }
    return SWARF_OK;
}

static const swarf_body *body_of(const swarf_history *history, size_t move)
{
    return history->section_bodies[swarf_move_get_section(&swarf_program_moves(history->program)[move])];
}

static swarf_status find_runs(swarf_history *history)
{
    const size_t count = swarf_program_move_count(history->program);
    for (size_t i = 0; i < count || i == 0; i++) {
        if (i > 0 && body_of(history, i) == body_of(history, i - 1)) continue;
        SWARF_TRY(swarf_array_reserve((void **)&history->runs, &history->run_room, history->run_count + 1,
                                      sizeof *history->runs));
        history->runs[history->run_count++] = i;
    }
    return SWARF_OK;
}

static size_t bytes_of(const swarf_stock *stock)
{
    size_t leaves, bytes;
    swarf_tree_size(stock->tree, &leaves, &bytes);
    return bytes;
}

static swarf_status take_stock(swarf_history *history)
{
    /* before its faces have leaves, which take most of the memory of a block */
    SWARF_TRY(swarf_stock_copy(history->stock, &history->first));
    history->first_bytes = bytes_of(history->first);
    SWARF_TRY(swarf_stock_enter_read(history->stock));
    history->generation = swarf_stock_generation(history->stock);
    swarf_stock_leave(history->stock);
    return SWARF_OK;
}

swarf_status swarf_history_create(swarf_stock *stock, const swarf_program *program, const swarf_tool *tools,
                                  size_t tool_count, const swarf_history_options *options, swarf_history **out)
{
    SWARF_REQUIRE(stock && program && out && (tools || tool_count == 0),
                  "history: stock, program, tools or output missing");
    SWARF_REQUIRE(!options || options->size == sizeof *options, "history: options of another version");
    swarf_history *history = calloc(1, sizeof *history);
    if (!history) return swarf_fail(SWARF_ERROR_MEMORY, "history: out of memory");
    history->stock = stock;
    history->program = swarf_program_retain((swarf_program *)program);
    history->spacing = FIRST_SPACING;
    history->limit = options ? options->memory_limit : 0;
    if (history->limit == 0) {
        const size_t left = swarf_memory_free();
        history->limit = left == SIZE_MAX ? SIZE_MAX : left / 4;
    }
    swarf_status status = take_tools(history, tools, tool_count);
    if (status == SWARF_OK) status = find_runs(history);
    if (status == SWARF_OK) status = take_stock(history);
    if (status != SWARF_OK) {
        swarf_history_destroy(history);
        return status;
    }
    *out = history;
    return SWARF_OK;
}

void swarf_history_destroy(swarf_history *history)
{
    if (!history) return;
    for (size_t i = 0; i < history->keyframe_count; i++) swarf_stock_destroy(history->keyframes[i].stock);
    for (size_t i = 0; i < history->body_count; i++) swarf_body_destroy(history->bodies[i]);
    swarf_undo_free(&history->undo);
    swarf_stock_destroy(history->first);
    swarf_program_release(history->program);
    free(history->keyframes);
    free(history->bodies);
    free(history->section_bodies);
    free(history->runs);
    free(history->paths);
    free(history);
}

/* ---- staying within the limit ------------------------------------------------------------------------------------ */

/* Position that the topmost of the lowest `count` records was cut up to. */
static size_t end_of_record(const swarf_history *history, size_t count)
{
    return count < history->undo.count ? history->undo.layers[count].first : history->at;
}

/* The record that is best made one with the next: where both together span least for how far back they lie, so that
 * what is kept grows coarser with the distance. */
static size_t choose_merge(const swarf_history *history)
{
    size_t best = 0;
    double least = INFINITY;
    for (size_t i = 0; i + 1 < history->undo.count; i++) {
        const size_t end = end_of_record(history, i + 2);
        const double ratio = (double)(end - history->undo.layers[i].first) / (double)(history->at - end + 1);
        if (ratio >= least) continue;
        least = ratio;
        best = i;
    }
    return best;
}

static void thin_records(swarf_history *history)
{
    swarf_undo *undo = &history->undo;
    const swarf_tree_layout *layout = swarf_tree_get_layout(history->stock->tree);
    while (undo->count && undo->bytes + history->keyframe_bytes > history->limit) {
        /* one that takes half of all would be copied again and again by what comes after it */
        if (undo->count == 1 || undo->layers[0].bytes > history->limit / 2 ||
            swarf_undo_merge(undo, layout, choose_merge(history)) != SWARF_OK)
            swarf_undo_forget(undo, 1);
    }
}

static void drop_keyframe(swarf_history *history, size_t index)
{
    history->keyframe_bytes -= history->keyframes[index].bytes;
    swarf_stock_destroy(history->keyframes[index].stock);
    history->keyframe_count--;
    for (size_t i = index; i < history->keyframe_count; i++) history->keyframes[i] = history->keyframes[i + 1];
}

/* Keep a keyframe here if it is time to. That there is no memory for one is no failure. */
static void keep_keyframe(swarf_history *history)
{
    size_t place = history->keyframe_count;
    while (place && history->keyframes[place - 1].move > history->at) place--;
    if (place && history->keyframes[place - 1].move == history->at) {
        history->cut_slots = 0;
        return;
    }
    if (!is_stop(history, history->at)) return;
    size_t leaves, bytes;
    swarf_tree_size(history->stock->tree, &leaves, &bytes);
    if (history->cut_slots < history->spacing * leaves) return;
    if (history->keyframe_bytes + bytes > history->limit / 2) {
        for (size_t i = 0; i < history->keyframe_count; i++) drop_keyframe(history, i); /* every other one */
        history->spacing *= 2;
        return;
    }
    struct keyframe keyframe = {.move = history->at, .bytes = bytes};
    swarf_tree *copy;
    if (swarf_array_reserve((void **)&history->keyframes, &history->keyframe_room, history->keyframe_count + 1,
                            sizeof keyframe) != SWARF_OK ||
        swarf_tree_copy(history->stock->tree, &copy) != SWARF_OK || swarf_stock_wrap(copy, &keyframe.stock) != SWARF_OK)
        return;
    for (size_t i = history->keyframe_count; i > place; i--) history->keyframes[i] = history->keyframes[i - 1];
    history->keyframes[place] = keyframe;
    history->keyframe_count++;
    history->keyframe_bytes += bytes;
    history->cut_slots = 0;
}

/* ---- going back -------------------------------------------------------------------------------------------------- */

/* Undo the topmost record. */
static swarf_status undo_one(swarf_history *history)
{
    const size_t first = history->undo.layers[history->undo.count - 1].first;
    const swarf_status status = swarf_undo_pop(&history->undo, history->stock);
    if (status != SWARF_OK) {
        history->is_torn = 1;
        return status;
    }
    history->at = first;
    history->cut_slots = 0;
    return SWARF_OK;
}

static swarf_status lift_part(swarf_history *history)
{
    if (history->has_part) SWARF_TRY(undo_one(history));
    history->has_part = 0;
    history->fraction = 0;
    return SWARF_OK;
}

/* Put back what was recorded above the lowest `count` records: a change that failed with `status`. */
static swarf_status take_back(swarf_history *history, size_t count, swarf_status status)
{
    while (history->undo.count > count && !history->is_torn)
        if (swarf_undo_pop(&history->undo, history->stock) != SWARF_OK) history->is_torn = 1;
    return status;
}

/* How many records stay when undoing down to a way point of `target`: SIZE_MAX when none of them leads there. */
static size_t find_records(const swarf_history *history, size_t target, size_t *move)
{
    size_t count = history->undo.count;
    *move = history->at;
    while (!is_on_way(history, *move, target)) {
        if (count == 0) return SIZE_MAX;
        *move = history->undo.layers[--count].first;
    }
    return count;
}

/* The last keyframe on the way to `target`; else the first stock. */
static const swarf_stock *find_keyframe(const swarf_history *history, size_t target, size_t *move)
{
    for (size_t i = history->keyframe_count; i-- > 0;) {
        *move = history->keyframes[i].move;
        if (is_on_way(history, *move, target)) return history->keyframes[i].stock;
    }
    *move = 0;
    return history->first;
}

/* Make the stock that of another position, whatever it holds now. */
static swarf_status jump_back(swarf_history *history, size_t target)
{
    size_t move;
    const swarf_stock *keyframe = find_keyframe(history, target, &move);
    swarf_undo_forget(&history->undo, history->undo.count);
    history->is_torn = 1;
    SWARF_TRY(swarf_undo_match(NULL, history->stock, keyframe));
    history->is_torn = 0;
    history->has_part = 0;
    history->fraction = 0;
    history->cut_slots = 0;
    history->at = move;
    return SWARF_OK;
}

static swarf_status jump_forward(swarf_history *history, const swarf_stock *keyframe, size_t move)
{
    const size_t count = history->undo.count;
    history->undo.first = history->at;
    const swarf_status status = swarf_undo_match(&history->undo, history->stock, keyframe);
    if (status != SWARF_OK) return take_back(history, count, status);
    history->at = move;
    history->cut_slots = 0;
    thin_records(history);
    return SWARF_OK;
}

/* Stand at a way point of `target`, one from which it is not far. */
static swarf_status find_way(swarf_history *history, size_t target, const swarf_progress *progress, double done)
{
    size_t kept, move;
    const size_t count = find_records(history, target, &kept);
    const swarf_stock *keyframe = find_keyframe(history, target, &move);
    if (count == SIZE_MAX) {
        SWARF_TRY(swarf_progress_report(progress, done));
        return jump_back(history, target);
    }
    while (history->undo.count > count) {
        SWARF_TRY(swarf_progress_report(progress, done));
        SWARF_TRY(undo_one(history));
    }
    return move > kept && move - kept >= JUMP ? jump_forward(history, keyframe, move) : SWARF_OK;
}

/* ---- going on ---------------------------------------------------------------------------------------------------- */

/* The path of a move that cuts; 0 if it does not. */
static swarf_status find_path(const swarf_history *history, size_t move, swarf_path *path, int *cuts)
{
    double from[6], to[6];
    SWARF_TRY(swarf_program_path(history->program, move, path));
    *cuts = path->has_motion && !swarf_program_move_axes(history->program, move, from, to);
    return SWARF_OK;
}

/* Cut with a record of its own, or not at all. */
static swarf_status cut_paths(swarf_history *history, const swarf_body *body, const swarf_path *paths, size_t count,
                              const swarf_progress *progress, double from, double to)
{
    swarf_undo *undo = &history->undo;
    const swarf_tree_layout *layout = swarf_tree_get_layout(history->stock->tree);
    const size_t before = undo->count;
    swarf_status status = SWARF_OK;
    undo->first = history->at;
    if (body && count) status = swarf_cut_recorded(history->stock, body, paths, count, undo, progress, from, to);
    if (status == SWARF_OK && undo->count == before) {
        status = swarf_undo_open(undo, layout, NULL, 0);
        if (status == SWARF_OK) swarf_undo_close(undo);
    }
    while (status == SWARF_OK && undo->count > before + 1) status = swarf_undo_merge(undo, layout, before);
    return status == SWARF_OK ? SWARF_OK : take_back(history, before, status);
}

static swarf_status cut_moves(swarf_history *history, size_t end, const swarf_progress *progress, double from,
                              double to)
{
    SWARF_TRY(
        swarf_array_reserve((void **)&history->paths, &history->path_room, end - history->at, sizeof *history->paths));
    size_t used = 0;
    for (size_t i = history->at; i < end; i++) {
        int cuts;
        SWARF_TRY(find_path(history, i, &history->paths[used], &cuts));
        used += cuts != 0;
    }
    SWARF_TRY(cut_paths(history, body_of(history, history->at), history->paths, used, progress, from, to));
    history->cut_slots += history->undo.layers[history->undo.count - 1].slots;
    history->at = end;
    keep_keyframe(history);
    thin_records(history);
    return SWARF_OK;
}

/* Cut the next move from its start to a part of its way. */
static swarf_status cut_part(swarf_history *history, double fraction, const swarf_progress *progress, double from,
                             double to)
{
    swarf_path path;
    int cuts;
    SWARF_TRY(find_path(history, history->at, &path, &cuts));
    swarf_path_part(&path, fraction, &path);
    SWARF_TRY(cut_paths(history, body_of(history, history->at), &path, cuts != 0, progress, from, to));
    history->has_part = 1;
    history->fraction = fraction;
    return SWARF_OK;
}

/* ---- seeking ----------------------------------------------------------------------------------------------------- */

static swarf_status enter(swarf_history *history, size_t *move, double *fraction)
{
    SWARF_REQUIRE(history, "history: NULL");
    const size_t count = swarf_program_move_count(history->program);
    SWARF_REQUIRE(*fraction >= 0 && *fraction <= 1, "history: part %g of a move; 0 to 1 are possible", *fraction);
    SWARF_REQUIRE(*move < count || (*move == count && *fraction == 0),
                  "history: no position %zu and %g of a move in a program of %zu moves", *move, *fraction, count);
    SWARF_TRY(swarf_stock_enter_read(history->stock));
    if (swarf_stock_generation(history->stock) != history->generation) {
        swarf_stock_leave(history->stock);
        return swarf_fail(SWARF_ERROR_ARGUMENT,
                          "history: its stock was changed by someone else; make a new history of it");
    }
    if (*fraction == 1) {
        ++*move;
        *fraction = 0;
    }
    return SWARF_OK;
}

static void leave(swarf_history *history)
{
    history->generation = swarf_stock_generation(history->stock);
    swarf_stock_leave(history->stock);
}

static int has_arrived(const swarf_history *history, size_t move, double fraction)
{
    return !history->is_torn && history->at == move && history->fraction == fraction;
}

/* Share of a way that is done, to report: `start` is where its cutting begins, SIZE_MAX before that. */
struct way {
    size_t start, move;
};

static double share(const struct way *way, size_t at)
{
    return way->start < way->move ? (double)(at - way->start) / (double)(way->move - way->start + 1) : 0;
}

static swarf_status approach(swarf_history *history, struct way *way, double fraction, const swarf_progress *progress)
{
    if (has_arrived(history, way->move, fraction)) return SWARF_OK;
    if (history->is_torn) SWARF_TRY(jump_back(history, way->move));
    SWARF_TRY(lift_part(history));
    SWARF_TRY(find_way(history, way->move, progress, way->start == SIZE_MAX ? 0 : share(way, history->at)));
    if (way->start == SIZE_MAX) way->start = history->at;
    if (history->at < way->move) {
        const size_t end = next_stop(history, history->at, way->move);
        SWARF_TRY(cut_moves(history, end, progress, share(way, history->at), share(way, end)));
    }
    if (history->at == way->move && fraction > 0)
        return cut_part(history, fraction, progress, share(way, history->at), 1);
    return SWARF_OK;
}

swarf_status swarf_history_approach(swarf_history *history, size_t move, double fraction,
                                    const swarf_progress *progress, int *arrived)
{
    SWARF_REQUIRE(arrived, "history: output missing");
    SWARF_TRY(enter(history, &move, &fraction));
    struct way way = {SIZE_MAX, move};
    const swarf_status status = approach(history, &way, fraction, progress);
    if (status == SWARF_OK) *arrived = has_arrived(history, move, fraction);
    leave(history);
    return status;
}

swarf_status swarf_history_seek(swarf_history *history, size_t move, double fraction, const swarf_progress *progress)
{
    SWARF_TRY(enter(history, &move, &fraction));
    struct way way = {SIZE_MAX, move};
    swarf_status status = SWARF_OK;
    while (status == SWARF_OK && !has_arrived(history, move, fraction))
        status = approach(history, &way, fraction, progress);
    leave(history);
    return status;
}

size_t swarf_history_move(const swarf_history *history)
{
    return history ? history->at : 0;
}

double swarf_history_fraction(const swarf_history *history)
{
    return history ? history->fraction : 0;
}

swarf_history_held swarf_history_get_held(const swarf_history *history)
{
    swarf_history_held held = {.bytes = 0};
    if (!history) return held;
    held.first_bytes = history->first_bytes;
    held.record_bytes = history->undo.bytes;
    held.keyframe_bytes = history->keyframe_bytes;
    held.bytes = held.first_bytes + held.record_bytes + held.keyframe_bytes;
    held.record_count = history->undo.count;
    held.keyframe_count = history->keyframe_count;
    held.oldest = history->undo.count ? history->undo.layers[0].first : history->at;
    return held;
}
