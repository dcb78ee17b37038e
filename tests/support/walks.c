/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "walks.h"

#include <math.h>
#include <stdlib.h>

static const swarf_box block = {{-10, -8, -5}, {10, 8, 0}};

static void load(swarf_program *program, int32_t tool, int32_t operation)
{
    CHECK_OK(swarf_program_add_operation(program, "walk"));
    const swarf_section section = {.tool = tool, .operation = operation, .spindle = SWARF_SPINDLE_CW};
    CHECK_OK(swarf_program_set_section(program, &section));
}

/* A short way on from where the program stands, so that many moves do not clear the whole block. */
static void add_random(swarf_program *program, test_random *random, double at[3], uint32_t line)
{
    const uint64_t kind = test_random_below(random, 12);
    double end[3];
    for (int k = 0; k < 3; k++) {
        const double low = k < 2 ? block.lo[k] : -4.5, high = k < 2 ? block.hi[k] : 1.5;
        end[k] = fmin(high, fmax(low, at[k] + test_random_in(random, -2.5, 2.5) * (k < 2 ? 1 : 0.4)));
    }
    if (kind == 0) {
        CHECK_OK(swarf_program_add_event(program, SWARF_MOVE_DWELL, 0.5, line));
        return;
    }
    if (kind < 3) { /* an arc, a helix or a spiral of more than a turn */
        const double radius = test_random_in(random, 0.3, 2), turn = test_random_in(random, 0, 2 * M_PI);
        const double centre[3] = {at[0] + radius * cos(turn), at[1] + radius * sin(turn), at[2]};
        const double sweep = test_random_in(random, 0.2, 6);
        end[0] = centre[0] - radius * cos(turn + sweep);
        end[1] = centre[1] - radius * sin(turn + sweep);
        if (test_random_below(random, 2)) end[2] = at[2];
        CHECK_OK(swarf_program_add_arc(program, end, centre, SWARF_PLANE_XY, (int)test_random_below(random, 2),
                                       1 + (int)test_random_below(random, 2), 300, line));
    } else {
        if (kind == 3) end[2] = at[2];
        if (kind == 4) end[0] = at[0], end[1] = at[1];
        CHECK_OK(swarf_program_add_line(program, kind == 5 ? SWARF_MOVE_RAPID : SWARF_MOVE_FEED, end,
                                        kind == 5 ? 0 : 300, line));
    }
    for (int k = 0; k < 3; k++) at[k] = end[k];
}

walk_job walk_job_make(test_random *random, size_t moves)
{
    walk_job job = {.moves = moves, .voxel = test_random_in(random, 0.4, 0.6)};
    double at[3] = {0, 0, 1};
    CHECK_OK(swarf_program_create(at, &job.program));
    int32_t operation = 0;
    for (size_t i = 0; i < moves; i++) {
        if (i == 0 || test_random_below(random, moves / 6 + 2) == 0) {
            const int32_t number = (int32_t)test_random_below(random, WALK_TOOLS + 1);
            load(job.program, number < WALK_TOOLS ? number : 9, operation++);
        }
        add_random(job.program, random, at, (uint32_t)i + 1);
    }
    CHECK(swarf_program_move_count(job.program) == moves);
    for (int i = 0; i < WALK_TOOLS; i++) {
        const char *name;
        job.tools[i] =
            (swarf_tool){.number = i, .cutter = case_cutter((int)test_random_below(random, CASE_CUTTERS), &name)};
    }
    return job;
}

void walk_job_free(walk_job *job)
{
    for (int i = 0; i < WALK_TOOLS; i++) swarf_cutter_release((swarf_cutter *)job->tools[i].cutter);
    swarf_program_release(job->program);
}

swarf_stock *walk_job_stock(const walk_job *job)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = job->voxel;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&block, &options, &stock))) exit(test_end());
    return stock;
}

uint64_t walk_job_fresh(const walk_job *job, size_t move, double fraction)
{
    swarf_stock *stock = walk_job_stock(job);
    swarf_history *history = NULL;
    uint64_t hash = 0;
    CHECK_OK(swarf_history_create(stock, job->program, job->tools, WALK_TOOLS, NULL, &history));
    CHECK_OK(swarf_history_seek(history, move, fraction, NULL));
    CHECK_OK(swarf_stock_hash(stock, &hash));
    swarf_history_destroy(history);
    swarf_stock_destroy(stock);
    return hash;
}
