/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A cancelled cut leaves a stock that other work can go on with: its surface is closed, and going on gives what an
 * uncancelled cut gives. */
#include <math.h>
#include <stdlib.h>

#include "test.h"

enum { MOVES = 16000 };

static int stop_after(void *user, double fraction)
{
    return fraction > *(const double *)user;
}

/* A spiral of short moves, wide enough for more than one batch. */
static void draw(swarf_path *paths)
{
    for (int i = 0; i < MOVES; i++) {
        swarf_path *path = &paths[i];
        *path = (swarf_path){.has_motion = 1};
        for (int end = 0; end < 2; end++) {
            const double turn = (i + end) * 0.02, radius = 2 + 7.0 * (i + end) / MOVES;
            double *p = end ? path->end : path->start;
            p[0] = 10 + radius * cos(turn);
            p[1] = 10 + radius * sin(turn);
            p[2] = -1 - 2.0 * (i + end) / MOVES;
        }
    }
}

int main(void)
{
    static swarf_path paths[MOVES];
    draw(paths);
    const swarf_box box = {{0, 0, -6}, {20, 20, 0}};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.03;
    swarf_cutter *cutter = NULL;
    swarf_stock *whole = NULL;
    uint64_t whole_hash = 0, hash = 1;
    double initial = 0, final = 0, volume = 0;
    CHECK_OK(swarf_cutter_parse("flat:d=5,l=20", &cutter));
    CHECK_OK(swarf_stock_create_box(&box, &options, &whole));
    CHECK_OK(swarf_stock_volume(whole, &initial));
    CHECK_OK(swarf_stock_cut(whole, cutter, paths, MOVES, NULL));
    CHECK_OK(swarf_stock_volume(whole, &final));
    CHECK_OK(swarf_stock_hash(whole, &whole_hash));
    swarf_stock_destroy(whole);

    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_OK(swarf_threads_set(1)); /* of several threads others than the reporting one may do all that is left */
    test_random random = test_random_begin(5);
    int partial = 0;
    for (int i = 0; i < 2; i++) {
        double limit = i ? test_random_in(&random, 0, 0.7) : 0;
        const swarf_progress progress = {stop_after, &limit};
        swarf_stock *stock = NULL;
        swarf_mesh *mesh = NULL;
        CHECK_OK(swarf_stock_create_box(&box, &options, &stock));
        CHECK_FAILS(swarf_stock_cut(stock, cutter, paths, MOVES, &progress), SWARF_ERROR_CANCELLED, "cancelled");
        CHECK_OK(swarf_stock_volume(stock, &volume));
        CHECK(volume <= initial && volume >= final * (1 - 1e-9));
        partial += volume > final * (1 + 1e-6);
        if (CHECK_OK(swarf_mesh_create_stock(stock, 0, NULL, &mesh))) CHECK(swarf_mesh_topology(mesh).closed);
        swarf_mesh_release(mesh);
        CHECK_OK(swarf_stock_cut(stock, cutter, paths, MOVES, NULL));
        CHECK_OK(swarf_stock_hash(stock, &hash));
        CHECK(hash == whole_hash);
        swarf_stock_destroy(stock);
    }
    CHECK(partial > 0); /* else nothing was cancelled half way and the test shows nothing */
    swarf_cutter_release(cutter);
    return test_end();
}
