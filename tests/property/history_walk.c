/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Laws of the history, on random programs: wherever a walk leads, the stock is that of a new history that goes there at
 * once, to the bit; with any memory limit and number of threads, after cancelled ways, and what is held stays within
 * the limit. And the surface is that of a plain simulation. */
#include <stdlib.h>

#include "stocks.h"
#include "walks.h"

enum { STEPS = 16 };

/* Where to go next: near by, one back, far away, or to the ends. */
static size_t choose(test_random *random, size_t at, size_t moves)
{
    const size_t near = (size_t)test_random_below(random, 12);
    switch (test_random_below(random, 6)) {
    case 0: return at ? at - 1 : 0;
    case 1: return at > near ? at - near : 0;
    case 2: return at + near < moves ? at + near : moves;
    case 3: return test_random_below(random, 4) ? at : moves;
    default: return (size_t)test_random_below(random, moves + 1);
    }
}

static void check_held(swarf_history *history, size_t limit)
{
    const swarf_history_held held = swarf_history_get_held(history);
    CHECK(held.bytes == held.first_bytes + held.record_bytes + held.keyframe_bytes);
    CHECK(held.oldest <= swarf_history_move(history));
    if (swarf_history_fraction(history) == 0) CHECK(held.record_bytes + held.keyframe_bytes <= limit);
}

/* The text of a failed law must lead back to the walk. */
static int same(uint64_t hash, const walk_job *job, swarf_history *history, size_t limit, int step)
{
    const size_t move = swarf_history_move(history);
    const double fraction = swarf_history_fraction(history);
    if (CHECK(hash == walk_job_fresh(job, move, fraction))) return 1;
    printf("    step %d, at %zu and %.17g of %zu moves, limit %zu\n", step, move, fraction, job->moves, limit);
    return 0;
}

static void check_walk(const walk_job *job, test_random *random, size_t limit, int *cancelled)
{
    const int threads[] = {0, 1, 2, 3, 8};
    swarf_history_options options = swarf_history_options_default();
    options.memory_limit = limit;
    swarf_stock *stock = walk_job_stock(job);
    swarf_history *history = NULL;
    uint64_t first = 0, hash = 1;
    CHECK_OK(swarf_history_create(stock, job->program, job->tools, WALK_TOOLS, &options, &history));
    CHECK_OK(swarf_stock_hash(stock, &first));
    int good = 1;
    for (int step = 0; step < STEPS && good; step++) {
        const size_t move = choose(random, swarf_history_move(history), job->moves);
        const double fraction =
            move < job->moves && test_random_below(random, 3) == 0 ? test_random_in(random, 0, 1) : 0;
        test_stopper stopping = {.after = test_random_below(random, 3) ? -1 : (long)test_random_below(random, 20)};
        const swarf_progress progress = {test_stop, &stopping};
        CHECK_OK(swarf_threads_set(threads[test_random_below(random, 5)]));
        const swarf_status status = swarf_history_seek(history, move, fraction, &progress);
        CHECK(!stopping.fell);
        CHECK(status == SWARF_OK || status == SWARF_ERROR_CANCELLED);
        *cancelled += status == SWARF_ERROR_CANCELLED;
        if (status == SWARF_OK)
            CHECK(swarf_history_move(history) == move && swarf_history_fraction(history) == fraction);
        else
            CHECK(swarf_history_fraction(history) == 0);
        check_held(history, limit);
        CHECK_OK(swarf_stock_hash(stock, &hash));
        good = same(hash, job, history, limit, step);
    }
    CHECK_OK(swarf_history_seek(history, 0, 0, NULL));
    CHECK_OK(swarf_stock_hash(stock, &hash));
    CHECK(hash == first);
    swarf_history_destroy(history);
    swarf_stock_destroy(stock);
    CHECK_OK(swarf_threads_set(0));
}

/* The same moves played as one and as a history; and parts of moves lie between the moves. */
static void check_simulation(const walk_job *job, test_random *random)
{
    swarf_stock *plain = walk_job_stock(job), *stock = walk_job_stock(job);
    swarf_history *history = NULL;
    swarf_simulation *simulation = NULL;
    CHECK_OK(swarf_history_create(stock, job->program, job->tools, WALK_TOOLS, NULL, &history));
    size_t done = 0;
    for (int i = 0; i < 3; i++) {
        const size_t move = i < 2 ? done + (size_t)test_random_below(random, job->moves - done) : job->moves;
        CHECK_OK(swarf_stock_simulate(plain, job->program, done, move - done, job->tools, WALK_TOOLS, NULL, NULL,
                                      &simulation));
        swarf_simulation_destroy(simulation);
        CHECK_OK(swarf_history_seek(history, move, 0, NULL));
        const double volume = stock_volume(stock);
        CHECK_NEAR(volume, stock_volume(plain), 2e-5 * stock_volume(plain));
        done = move;
    }
    for (int i = 0; i < 5; i++) {
        const size_t move = (size_t)test_random_below(random, job->moves);
        double last = 0;
        for (int part = 0; part <= 4; part++) {
            CHECK_OK(swarf_history_seek(history, move, part / 4.0, NULL));
            const double volume = stock_volume(stock);
            if (part) CHECK(volume <= last * (1 + 1e-5));
            last = volume;
        }
        CHECK(swarf_history_move(history) == move + 1);
    }
    swarf_history_destroy(history);
    swarf_stock_destroy(stock);
    swarf_stock_destroy(plain);
}

int main(int count, char **argument)
{
    test_random random = test_random_begin(815);
    CHECK_OK(swarf_progress_interval_set(0));
    const swarf_isa best = swarf_isa_current();
    int cancelled = 0;
    const int jobs = count > 1 ? atoi(argument[1]) : 2;
    for (int i = 0; i < jobs; i++) {
        walk_job job = walk_job_make(&random, i ? 150 + (size_t)test_random_below(&random, 400) : 4200);
        printf("job %d: %zu moves, voxel %g\n", i, job.moves, job.voxel);
        const size_t limits[] = {1, 30000, 500000, SIZE_MAX};
        for (int k = i % 2; k < 4; k += 2) {
            if (k == 1) (void)swarf_isa_set(SWARF_ISA_AVX2); /* where the processor has it */
            check_walk(&job, &random, limits[k], &cancelled);
            CHECK_OK(swarf_isa_set(best));
        }
        check_simulation(&job, &random);
        walk_job_free(&job);
    }
    CHECK(cancelled > 0); /* else that part shows nothing */
    return test_end();
}
