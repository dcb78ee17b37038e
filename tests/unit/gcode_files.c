/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code as a whole: laws of random programs, a million lines, files, arguments. */
#include "gcode.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Random programs whose outcome is known from how they were made. */
static void test_random_programs(void)
{
    test_random random = test_random_begin(11);
    enum { LINES = 40 };
    for (int n = 0; n < 500; n++) {
        char text[8192];
        size_t used = 0;
        double x = 0, y = 0, z = 10, length = 0, bottom = 10;
        size_t arcs = 0, feeds_down = 0;
        const double unit = n % 2 ? 25.4 : 1;
        used += (size_t)snprintf(text + used, sizeof text - used, n % 2 ? "G20\n" : "G21\n");
        for (int i = 0; i < LINES; i++) {
            const double a = round(test_random_in(&random, -1e5, 1e5)) / 1e4;
            const double b = round(test_random_in(&random, -1e5, 1e5)) / 1e4;
            switch (test_random_below(&random, 3)) {
            case 0: /* straight */
                used += (size_t)snprintf(text + used, sizeof text - used, "N%d G%d X%.4f Y%.4f\n", i, 1, a, b);
                length += hypot(a * unit - x, b * unit - y);
                x = a * unit, y = b * unit;
                break;
            case 1: { /* helix of P turns back to where it began */
                const int turns = 1 + (int)test_random_below(&random, 4);
                if (hypot(a, b) < 0.01) break;
                used += (size_t)snprintf(text + used, sizeof text - used, "G%d Z%.4f I%.4f J%.4f P%d\n", 2 + i % 2, a,
                                         b, a, turns);
                length += hypot(2 * pi * turns * hypot(a, b) * unit, a * unit - z);
                z = a * unit;
                if (z < bottom) bottom = z;
                arcs++;
                break;
            }
            default: { /* pecks: each feeds 2 q at most, all reach the bottom */
                const double r = fabs(a) + 0.5, depth = -fabs(b), q = 0.7;
                used += (size_t)snprintf(text + used, sizeof text - used,
                                         "G99 G83 X%.4f Y%.4f Z%.4f R%.4f Q%.4f\nG80\n", b, a, depth, r, q);
                feeds_down += (size_t)ceil((r - depth) / q - 1e-6 / unit / q);
                x = b * unit, y = a * unit, z = r * unit;
                if (depth * unit < bottom) bottom = depth * unit;
                break;
            }
            }
        }
        swarf_program *program = gcode_read_ok(text);
        const size_t count = swarf_program_move_count(program);
        double total = 0, lowest = 10;
        size_t pecks = 0;
        for (size_t i = 0; i < count; i++) {
            swarf_path path;
            if (swarf_program_path(program, i, &path) != SWARF_OK) continue;
            const int fed = swarf_move_get_kind(&swarf_program_moves(program)[i]) == SWARF_MOVE_FEED;
            const int plunge = !path.is_arc && path.start[2] != path.end[2];
            if (fed && plunge) pecks++;
            if (fed && !plunge) total += swarf_path_length(&path);
            if (path.end[2] < lowest) lowest = path.end[2];
            if (fed && plunge) CHECK(path.start[2] - path.end[2] < (0.7 + 0.2541) * unit);
            double p[3];
            swarf_path_point(&path, 1, p);
            CHECK(memcmp(p, swarf_program_moves(program)[i].end, sizeof p) == 0);
        }
        CHECK(swarf_program_arc_count(program) == arcs);
        CHECK(pecks == feeds_down);
        CHECK_NEAR(total, length, 1e-9 * (1 + length));
        CHECK_NEAR(lowest, bottom, 1e-9);
        if (count) {
            const double *end = swarf_program_moves(program)[count - 1].end;
            CHECK_NEAR(end[0], x, 1e-9);
            CHECK_NEAR(end[1], y, 1e-9);
            CHECK_NEAR(end[2], z, 1e-9);
        }
        swarf_program_release(program);
    }
}

static int stop_at_once(void *user, double fraction)
{
    (void)fraction;
    return ++*(int *)user > 0;
}

static int rising(void *user, double fraction)
{
    double *last = user;
    CHECK(fraction >= *last && fraction <= 1.0);
    *last = fraction;
    return 0;
}

/* A million lines, and cancelled at the first report. (Time and memory: gcode_bench.) */
static void test_large(void)
{
    enum { LINES = 1000000 };
    char *text = malloc((size_t)LINES * 40);
    if (!CHECK(text != NULL)) return;
    size_t used = 0;
    for (int i = 0; i < LINES; i++)
        used +=
            (size_t)sprintf(text + used, "N%d G1 X%d.%03d Y%d.5 Z-%d.25 F1000\n", i, i % 200, i % 1000, i % 77, i % 9);
    swarf_program *program = NULL;
    double last = -1;
    const swarf_progress progress = {rising, &last};
    CHECK_OK(swarf_gcode_read(text, used, "large.nc", NULL, &progress, &program));
    CHECK(last == 1.0);
    CHECK(swarf_program_move_count(program) == LINES);
    swarf_program_release(program);
    program = NULL;
    int calls = 0;
    const swarf_progress cancel = {stop_at_once, &calls};
    CHECK_FAILS(swarf_gcode_read(text, used, "large.nc", NULL, &cancel, &program), SWARF_ERROR_CANCELLED, "cancelled");
    CHECK(program == NULL && calls == 1);
    free(text);
}

static void test_arguments_and_files(void)
{
    swarf_program *program = NULL;
    CHECK_FAILS(swarf_gcode_read(NULL, 5, "a", NULL, NULL, &program), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_gcode_read("", 0, NULL, NULL, NULL, &program), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_gcode_read("", 0, "a", NULL, NULL, NULL), SWARF_ERROR_ARGUMENT, NULL);
    swarf_gcode_options options = swarf_gcode_options_default();
    options.size = 3;
    CHECK_FAILS(swarf_gcode_read("", 0, "a", &options, NULL, &program), SWARF_ERROR_ARGUMENT, "options");
    options = swarf_gcode_options_default();
    options.start[1] = INFINITY;
    CHECK_FAILS(swarf_gcode_read("", 0, "a", &options, NULL, &program), SWARF_ERROR_ARGUMENT, "start Y");
    CHECK_FAILS(swarf_gcode_read_file("/nowhere/at all.nc", NULL, NULL, &program), SWARF_ERROR_IO,
                "/nowhere/at all.nc");
    CHECK_OK(swarf_gcode_read(NULL, 0, "a", NULL, NULL, &program));
    swarf_program_release(program);

    /* the examples: every move known, cuts within their stock's reach, lowest point */
    static const struct {
        const char *name;
        size_t arcs, operations;
        double lowest;
    } examples[] = {{"slot.nc", 4, 1, -4}, {"bracket.nc", 30, 2, -13.2}};
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        char path[1200];
        snprintf(path, sizeof path, "%s/examples/%s", SWARF_SOURCE_DIR, examples[i].name);
        program = NULL;
        CHECK_OK(swarf_gcode_read_file(path, NULL, NULL, &program));
        CHECK(swarf_program_arc_count(program) == examples[i].arcs);
        CHECK(swarf_program_operation_count(program) == examples[i].operations);
        double lowest = 0;
        for (size_t k = 0; k < swarf_program_move_count(program); k++) {
            const swarf_move *move = &swarf_program_moves(program)[k];
            if (swarf_move_get_kind(move) != SWARF_MOVE_FEED) continue;
            CHECK(move->feed_mm_min > 0 && move->end[0] >= -5 && move->end[0] <= 65);
            CHECK(move->end[1] >= -6 && move->end[1] <= 40 && move->end[2] <= 1);
            if (move->end[2] < lowest) lowest = move->end[2];
        }
        CHECK_NEAR(lowest, examples[i].lowest, 0);
        swarf_program_release(program);
    }

    static const struct {
        const char *name;
        size_t moves;
        size_t operations;
    } shared[] = {{"bear.nc", 15160, 1}, {"cameo.nc", 35283, 1}};
    if (!*test_shared()) {
        printf("skipped: the benchmark programs are not here (set SWARF_SHARED)\n");
        return;
    }
    for (size_t i = 0; i < sizeof shared / sizeof *shared; i++) {
        char path[1200];
        snprintf(path, sizeof path, "%s/data/%s", test_shared(), shared[i].name);
        program = NULL;
        CHECK_OK(swarf_gcode_read_file(path, NULL, NULL, &program));
        CHECK(swarf_program_move_count(program) == shared[i].moves);
        CHECK(swarf_program_operation_count(program) == shared[i].operations);
        swarf_program_release(program);
    }
}

int main(void)
{
    test_random_programs();
    test_large();
    test_arguments_and_files();
    return test_end();
}
