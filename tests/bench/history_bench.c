/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* history_bench PROGRAM N THREADS [REPEAT [LIMIT_MB]]: stand at the end of a fixed job, go back, and print one line of
 * JSON with minimum and median of each time over the repeats.
 *
 * "forward" goes from the first move to the last; "plain" cuts the same batches without keeping anything, so that the
 * difference is what recording costs; "whole" cuts all moves at once. Then from the end: "back_1000" in one call,
 * "again_1000" forward to the end, "back_singles" one move back a thousand times, "forward_singles" as many forward
 * again, "start" back to before the first move.
 */
#include <stdio.h>
#include <stdlib.h>

#include "jobs.h"

enum { MOST_REPEATS = 99, STEPS = 1000, MOST_TOOLS = 64 };

enum { WHOLE, PLAIN, FORWARD, BACK, AGAIN, BACK_SINGLES, FORWARD_SINGLES, START, TIMES };
static const char *const names[TIMES] = {"whole",      "plain",        "forward",         "back_1000",
                                         "again_1000", "back_singles", "forward_singles", "start"};

struct bench {
    swarf_program *program;
    swarf_cutter *cutter;
    swarf_tool tools[MOST_TOOLS];
    size_t tool_count, moves, limit;
    swarf_path *paths;
    swarf_stock_options options;
    const bench_job *job;
    swarf_history_held held;
};

static int tool_of(const struct bench *bench, size_t move)
{
    const uint32_t section = swarf_move_get_section(&swarf_program_moves(bench->program)[move]);
    return swarf_program_sections(bench->program)[section].tool;
}

/* Every tool number of the program is the job's one cutter. */
static void make_tools(struct bench *bench)
{
    for (size_t i = 0; i < bench->moves; i++) {
        size_t k = 0;
        while (k < bench->tool_count && bench->tools[k].number != tool_of(bench, i)) k++;
        if (k < bench->tool_count) continue;
        if (k == MOST_TOOLS) exit(2);
        bench->tools[bench->tool_count++] = (swarf_tool){.number = tool_of(bench, i), .cutter = bench->cutter};
    }
}

static swarf_stock *make_stock(const struct bench *bench)
{
    swarf_stock *stock = NULL;
    size_t leaves, bytes;
    bench_must(swarf_stock_create_box(&bench->job->box, &bench->options, &stock));
    bench_must(swarf_stock_size(stock, &leaves, &bytes)); /* makes the leaves of its faces */
    return stock;
}

static void cut(const struct bench *bench, swarf_stock *stock, size_t first, size_t end)
{
    size_t used = 0;
    for (size_t i = first; i < end; i++) {
        bench_must(swarf_program_path(bench->program, i, &bench->paths[used]));
        used += bench->paths[used].has_motion != 0;
    }
    bench_must(swarf_stock_cut(stock, bench->cutter, bench->paths, used, NULL));
}

/* The batches that history.h tells of. */
static void cut_plainly(const struct bench *bench, swarf_stock *stock)
{
    for (size_t begin = 0; begin < bench->moves;) {
        size_t end = begin + 1;
        while (end < bench->moves && tool_of(bench, end) == tool_of(bench, begin)) end++;
        for (size_t size = 4096; size; size /= 8)
            for (; end - begin >= size; begin += size) cut(bench, stock, begin, begin + size);
    }
}

static void run(struct bench *bench, double times[TIMES])
{
    swarf_stock *stock = make_stock(bench);
    double began = bench_now();
    cut(bench, stock, 0, bench->moves);
    times[WHOLE] = bench_now() - began;
    swarf_stock_destroy(stock);
    stock = make_stock(bench);
    began = bench_now();
    cut_plainly(bench, stock);
    times[PLAIN] = bench_now() - began;
    swarf_stock_destroy(stock);

    stock = make_stock(bench);
    swarf_history *history = NULL;
    swarf_history_options options = swarf_history_options_default();
    options.memory_limit = bench->limit;
    bench_must(swarf_history_create(stock, bench->program, bench->tools, bench->tool_count, &options, &history));
    const size_t moves = bench->moves, targets[] = {moves, moves - STEPS, moves, moves - STEPS, moves, 0};
    for (int i = FORWARD; i < TIMES; i++) {
        began = bench_now();
        const size_t target = targets[i - FORWARD];
        const int singles = i == BACK_SINGLES ? -1 : i == FORWARD_SINGLES;
        for (size_t left = singles ? STEPS - 1 : 0; left; left--)
            bench_must(swarf_history_seek(history, singles < 0 ? target + left : target - left, 0, NULL));
        bench_must(swarf_history_seek(history, target, 0, NULL));
        times[i] = bench_now() - began;
        if (i == FORWARD) bench->held = swarf_history_get_held(history);
    }
    swarf_history_destroy(history);
    swarf_stock_destroy(stock);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(int count, char **argument)
{
    struct bench bench = {.job = count > 1 ? bench_job_find(argument[1]) : NULL};
    const int repeats = count > 4 ? atoi(argument[4]) : 5;
    if (!bench.job || count < 4 || count > 6 || atoi(argument[2]) < 1 || repeats < 1 || repeats > MOST_REPEATS) {
        fprintf(stderr, "usage: history_bench bear|cameo RESOLUTION THREADS [REPEAT [LIMIT_MB]]\n");
        return 2;
    }
    static double times[TIMES][MOST_REPEATS];
    bench_must(swarf_threads_set(atoi(argument[3])));
    bench_must(swarf_cutter_parse(bench.job->cutter, &bench.cutter));
    bench.limit = count > 5 ? (size_t)atol(argument[5]) << 20 : 0;
    bench.program = bench_job_program(bench.job);
    bench.moves = swarf_program_move_count(bench.program);
    bench.paths = malloc((bench.moves + 1) * sizeof *bench.paths);
    if (!bench.paths) return 2;
    bench.options = swarf_stock_options_default();
    bench.options.voxel_mm = bench_job_voxel(bench.job, atoi(argument[2]));
    make_tools(&bench);
    for (int i = 0; i < repeats; i++) {
        double once[TIMES];
        run(&bench, once);
        for (int k = 0; k < TIMES; k++) times[k][i] = once[k];
    }
    printf("{\"program\": \"%s\", \"resolution\": %d, \"threads\": %d, \"isa\": \"%s\", \"version\": \"%s\", "
           "\"moves\": %zu, \"repeats\": %d, \"limit_mb\": %zu, \"records\": %zu, \"record_mb\": %.1f, "
           "\"keyframes\": %zu, \"keyframe_mb\": %.1f, \"first_mb\": %.1f, \"peak_mb\": %.1f",
           bench.job->name, atoi(argument[2]), swarf_threads(), swarf_isa_name(swarf_isa_current()), swarf_version(),
           bench.moves, repeats, bench.limit >> 20, bench.held.record_count, (double)bench.held.record_bytes / 1048576,
           bench.held.keyframe_count, (double)bench.held.keyframe_bytes / 1048576,
           (double)bench.held.first_bytes / 1048576, (double)swarf_memory_peak() / 1048576);
    for (int k = 0; k < TIMES; k++) {
        qsort(times[k], (size_t)repeats, sizeof times[k][0], compare);
        printf(", \"%s_s\": [%.6f, %.6f]", names[k], times[k][0], times[k][repeats / 2]);
    }
    printf("}\n");
    free(bench.paths);
    swarf_cutter_release(bench.cutter);
    swarf_program_release(bench.program);
    return 0;
}
