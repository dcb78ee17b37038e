/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The history where what it must give is known: volumes of parts of a move, what changes are told when stepping back,
 * where a cancelled way ends, what is refused. tests/property/history_walk.c walks through random programs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stocks.h"
#include "walks.h"

static const swarf_box block = {{0, 0, 0}, {40, 20, 10}};
static const double diameter = 4, depth = 2;

enum { SLOTS = 4, MOST = 4096 };

static swarf_stock *make_stock(void)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.25;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&block, &options, &stock))) exit(test_end());
    return stock;
}

/* Slots along x, 5 mm apart, from outside to outside: a move to each one's start, and one through it. */
static swarf_program *make_slots(void)
{
    const double start[3] = {-10, 2.5, 20};
    const swarf_section section = {.tool = 1, .spindle = SWARF_SPINDLE_CW};
    swarf_program *program = NULL;
    CHECK_OK(swarf_program_create(start, &program));
    CHECK_OK(swarf_program_add_operation(program, "slots"));
    CHECK_OK(swarf_program_set_section(program, &section));
    for (int i = 0; i < SLOTS; i++) {
        const double from[3] = {-10, 2.5 + 5 * i, block.hi[2] - depth}, to[3] = {50, from[1], from[2]};
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, from, 0, 0));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, to, 300, 0));
        const double up[3] = {to[0], to[1], 20}, back[3] = {-10, to[1], 20};
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, up, 0, 0));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, back, 0, 0));
    }
    return program;
}

static void check_slots(const swarf_tool *tool)
{
    swarf_program *program = make_slots();
    swarf_stock *stock = make_stock();
    swarf_history *history = NULL;
    uint64_t first = 0, hash = 0;
    CHECK_OK(swarf_history_create(stock, program, tool, 1, NULL, &history));
    CHECK_OK(swarf_stock_hash(stock, &first));
    const double whole = stock_volume(stock), slot = 40 * diameter * depth;
    const size_t moves = swarf_program_move_count(program);
    CHECK(moves == 4 * SLOTS && swarf_history_move(history) == 0 && swarf_history_fraction(history) == 0);
    for (int i = SLOTS; i >= 0; i--) {
        CHECK_OK(swarf_history_seek(history, 4 * (size_t)i, 0, NULL));
        CHECK_NEAR(whole - stock_volume(stock), i * slot, 0.5);
    }
    CHECK_OK(swarf_stock_hash(stock, &hash));
    CHECK(hash == first);

    /* Part of a slot: a rectangle and half a disc. The part ends at x = -10 + 60 * fraction. */
    for (int i = 1; i < 20; i++) {
        const double end = -10 + 60 * i / 20.0, half = 0.5 * diameter;
        CHECK_OK(swarf_history_seek(history, 5, i / 20.0, NULL));
        CHECK(swarf_history_move(history) == 5 && swarf_history_fraction(history) == i / 20.0);
        const double removed = whole - stock_volume(stock) - slot;
        if (end >= 0 && end + half <= 40) CHECK_NEAR(removed, depth * (diameter * end + 0.5 * M_PI * half * half), 1.5);
        if (end + half <= 0) CHECK_NEAR(removed, 0, 0.5);
        if (end >= 40) CHECK_NEAR(removed, slot, 0.5);
    }
    CHECK_OK(swarf_history_seek(history, 5, 1, NULL)); /* all of it is the next position */
    CHECK(swarf_history_move(history) == 6 && swarf_history_fraction(history) == 0);
    CHECK_NEAR(whole - stock_volume(stock), 2 * slot, 0.5);
    swarf_history_destroy(history);
    CHECK_NEAR(whole - stock_volume(stock), 2 * slot, 0.5); /* it stays the caller's */
    swarf_stock_destroy(stock);
    swarf_program_release(program);
}

/* A slot is told of where it is, and nothing far from it: forward, back, and its parts. */
static void check_stamps(const swarf_tool *tool)
{
    static swarf_box boxes[MOST];
    swarf_program *program = make_slots();
    swarf_stock *stock = make_stock();
    swarf_history *history = NULL;
    CHECK_OK(swarf_history_create(stock, program, tool, 1, NULL, &history));
    const struct {
        size_t move;
        double fraction, lo, hi; /* what may change, in y */
        int some;
    } steps[] = {{4, 0, 0, 5, 1}, {9, 0.5, 5, 15, 1}, {9, 0, 10, 15, 1},
                 {9, 0, 0, 0, 0}, {4, 0, 5, 10, 1},   {0, 0, 0, 5, 1}};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        const uint32_t before = swarf_stock_generation(stock);
        size_t count = 0;
        CHECK_OK(swarf_history_seek(history, steps[i].move, steps[i].fraction, NULL));
        if (steps[i].some)
            CHECK_OK(swarf_stock_changed(stock, before, boxes, MOST, &count));
        else
            CHECK(swarf_stock_generation(stock) == before);
        CHECK((count > 0) == steps[i].some);
        double lo = INFINITY, hi = -INFINITY;
        for (size_t k = 0; k < count; k++) {
            lo = fmin(lo, boxes[k].lo[1]);
            hi = fmax(hi, boxes[k].hi[1]);
        }
        const double cube = 32 * 0.25;
        if (count) CHECK(lo > steps[i].lo - cube - 1 && hi < steps[i].hi + cube + 1 && hi - lo < 3.5 * cube);
    }
    swarf_history_destroy(history);
    swarf_stock_destroy(stock);
    swarf_program_release(program);
}

static void check_refusals(const swarf_tool *tool)
{
    swarf_program *program = make_slots(), *empty = NULL;
    swarf_stock *stock = make_stock();
    swarf_history *history = NULL;
    swarf_history_options options = swarf_history_options_default();
    int arrived = 7;
    CHECK_FAILS(swarf_history_create(NULL, program, tool, 1, NULL, &history), SWARF_ERROR_ARGUMENT, "missing");
    CHECK_FAILS(swarf_history_create(stock, NULL, tool, 1, NULL, &history), SWARF_ERROR_ARGUMENT, "missing");
    CHECK_FAILS(swarf_history_create(stock, program, NULL, 1, NULL, &history), SWARF_ERROR_ARGUMENT, "missing");
    CHECK_FAILS(swarf_history_create(stock, program, tool, 1, NULL, NULL), SWARF_ERROR_ARGUMENT, "missing");
    options.size = 1;
    CHECK_FAILS(swarf_history_create(stock, program, tool, 1, &options, &history), SWARF_ERROR_ARGUMENT, "version");
    CHECK(history == NULL);
    CHECK_FAILS(swarf_history_seek(NULL, 0, 0, NULL), SWARF_ERROR_ARGUMENT, "NULL");
    CHECK_OK(swarf_history_create(stock, program, tool, 1, NULL, &history));
    const size_t moves = swarf_program_move_count(program);
    CHECK_FAILS(swarf_history_seek(history, moves + 1, 0, NULL), SWARF_ERROR_ARGUMENT, "no position 17");
    CHECK_FAILS(swarf_history_seek(history, moves, 0.5, NULL), SWARF_ERROR_ARGUMENT, "in a program of 16");
    CHECK_FAILS(swarf_history_seek(history, 1, -0.1, NULL), SWARF_ERROR_ARGUMENT, "part -0.1");
    CHECK_FAILS(swarf_history_seek(history, 1, 1.1, NULL), SWARF_ERROR_ARGUMENT, "0 to 1");
    CHECK_FAILS(swarf_history_seek(history, 1, NAN, NULL), SWARF_ERROR_ARGUMENT, "part");
    CHECK_FAILS(swarf_history_approach(history, 1, 0, NULL, NULL), SWARF_ERROR_ARGUMENT, "output");
    CHECK_FAILS(swarf_history_approach(history, moves + 1, 0, NULL, &arrived), SWARF_ERROR_ARGUMENT, "no position");
    CHECK(arrived == 7 && swarf_history_move(history) == 0);

    /* cut by someone else: told, not mended */
    const swarf_path path = oracle_line(5, 5, 5, 30, 5, 5);
    CHECK_OK(swarf_history_seek(history, 6, 0, NULL));
    CHECK_OK(swarf_stock_cut(stock, tool->cutter, &path, 1, NULL));
    CHECK_FAILS(swarf_history_seek(history, 0, 0, NULL), SWARF_ERROR_ARGUMENT, "changed by someone else");
    swarf_history_destroy(history);
    swarf_history_destroy(NULL);

    const double start[3] = {0, 0, 0};
    CHECK_OK(swarf_program_create(start, &empty));
    CHECK_OK(swarf_history_create(stock, empty, NULL, 0, NULL, &history));
    CHECK_OK(swarf_history_seek(history, 0, 0, NULL));
    CHECK_OK(swarf_history_approach(history, 0, 0, NULL, &arrived));
    CHECK(arrived == 1);
    CHECK_FAILS(swarf_history_seek(history, 0, 0.5, NULL), SWARF_ERROR_ARGUMENT, "program of 0 moves");
    swarf_history_destroy(history);
    CHECK(swarf_history_move(NULL) == 0 && swarf_history_fraction(NULL) == 0 &&
          swarf_history_get_held(NULL).bytes == 0);
    swarf_stock_destroy(stock);
    swarf_program_release(program);
    swarf_program_release(empty);
}

static int stop_at_once(void *user, double fraction)
{
    (void)user;
    (void)fraction;
    return 1;
}

/* A cancelled way ends between moves, and no record of it is left. */
static void check_cancel(const swarf_tool *tool)
{
    swarf_program *program = make_slots();
    swarf_stock *stock = make_stock();
    swarf_history *history = NULL;
    uint64_t first = 0, hash = 0;
    const swarf_progress progress = {stop_at_once, NULL};
    CHECK_OK(swarf_history_create(stock, program, tool, 1, NULL, &history));
    CHECK_OK(swarf_stock_hash(stock, &first));
    CHECK_FAILS(swarf_history_seek(history, 9, 0.5, &progress), SWARF_ERROR_CANCELLED, "cancelled");
    CHECK(swarf_history_move(history) == 0 && swarf_history_get_held(history).record_count == 0);
    CHECK_OK(swarf_stock_hash(stock, &hash));
    CHECK(hash == first);
    CHECK_OK(swarf_history_seek(history, 9, 0.5, NULL));
    CHECK_FAILS(swarf_history_seek(history, 2, 0, &progress), SWARF_ERROR_CANCELLED, "cancelled");
    CHECK(swarf_history_move(history) == 9 && swarf_history_fraction(history) == 0); /* the part is lifted first */
    swarf_history_destroy(history);
    swarf_stock_destroy(stock);
    swarf_program_release(program);
}

/* Step by step there and back: every position is met, and nothing is skipped. */
static void check_approach(void)
{
    test_random random = test_random_begin(31);
    walk_job job = walk_job_make(&random, 5200);
    swarf_stock *stock = walk_job_stock(&job);
    swarf_history *history = NULL;
    CHECK_OK(swarf_history_create(stock, job.program, job.tools, WALK_TOOLS, NULL, &history));
    const size_t targets[] = {5200, 17, 5000};
    for (int i = 0; i < 3; i++) {
        int arrived = 0, calls = 0;
        size_t last = swarf_history_move(history);
        while (!arrived && calls++ < 200) {
            if (!CHECK_OK(swarf_history_approach(history, targets[i], 0, NULL, &arrived))) break;
            const size_t now = swarf_history_move(history);
            CHECK(now <= targets[i] && now <= last + 4096);
            last = now;
        }
        CHECK(arrived && last == targets[i] && calls > 1);
        uint64_t hash = 0;
        CHECK_OK(swarf_stock_hash(stock, &hash));
        CHECK(hash == walk_job_fresh(&job, targets[i], 0));
    }
    const swarf_history_held held = swarf_history_get_held(history);
    CHECK(held.oldest == 0 && held.record_count > 1 && held.first_bytes > 0);
    swarf_history_destroy(history);
    swarf_stock_destroy(stock);
    walk_job_free(&job);
}

int main(void)
{
    swarf_dimensions dimensions = swarf_dimensions_default();
    dimensions.diameter = diameter;
    dimensions.length = 15;
    swarf_cutter *cutter = NULL;
    CHECK_OK(swarf_cutter_create_shape(SWARF_SHAPE_FLAT, &dimensions, &cutter));
    const swarf_tool tool = {.number = 1, .cutter = cutter};
    CHECK_OK(swarf_progress_interval_set(0));
    const swarf_isa best = swarf_isa_current();
    check_slots(&tool);
    CHECK_OK(swarf_isa_set(SWARF_ISA_SCALAR)); /* records are made and put back by kernels too */
    check_slots(&tool);
    CHECK_OK(swarf_isa_set(best));
    check_stamps(&tool);
    check_refusals(&tool);
    check_cancel(&tool);
    check_approach();
    swarf_cutter_release(cutter);
    return test_end();
}
