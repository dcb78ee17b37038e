/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Loads against closed forms: slots, side milling, facing, plunges, ramps, balls, arcs, entering and leaving. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"

static const swarf_box block = {{0, 0, -20}, {60, 40, 0}};
enum { TEETH = 2 };
static const double feed = 600, rpm = 6000; /* 0.05 mm a tooth */

typedef struct job {
    swarf_program *program;
    swarf_stock *stock;
    swarf_cutter *cutter;
    swarf_check *check;
    double voxel;
    double initial, final;
    const float *of[SWARF_LOAD_COUNT];
    const double *volume;
    size_t moves;
} job;

static job begin(const char *cutter, double voxel, double x, double y, double z)
{
    job j = {.voxel = voxel};
    const double start[3] = {x, y, z};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    CHECK_OK(swarf_program_create(start, &j.program));
    CHECK_OK(swarf_program_add_operation(j.program, "work"));
    const swarf_section section = {.tool = 1, .spindle = SWARF_SPINDLE_CW, .spindle_rpm = rpm};
    CHECK_OK(swarf_program_set_section(j.program, &section));
    CHECK_OK(swarf_cutter_parse(cutter, &j.cutter));
    CHECK_OK(swarf_stock_create_box(&block, &options, &j.stock));
    return j;
}

static void go(job *j, double x, double y, double z)
{
    const double end[3] = {x, y, z};
    CHECK_OK(swarf_program_add_line(j->program, SWARF_MOVE_FEED, end, feed, 1));
}

static void turn(job *j, double x, double y, double z, double cx, double cy, int ccw, int turns)
{
    const double end[3] = {x, y, z}, centre[3] = {cx, cy, z};
    CHECK_OK(swarf_program_add_arc(j->program, end, centre, SWARF_PLANE_XY, ccw, turns, feed, 1));
}

static void run(job *j)
{
    const swarf_tool tool = {.number = 1, .teeth = TEETH, .cutter = j->cutter};
    swarf_check_options options = swarf_check_options_default();
    options.loads = 1;
    CHECK_OK(swarf_stock_volume(j->stock, &j->initial));
    CHECK_OK(swarf_stock_check(j->stock, j->program, 0, swarf_program_move_count(j->program), &tool, 1, &options, NULL,
                               &j->check));
    CHECK_OK(swarf_stock_volume(j->stock, &j->final));
    const swarf_loads *loads = swarf_check_loads(j->check);
    for (int k = 0; k < SWARF_LOAD_COUNT; k++) j->of[k] = swarf_loads_get(loads, (swarf_load_kind)k, &j->moves);
    j->volume = swarf_loads_volume(loads, &j->moves);
    CHECK(j->moves == swarf_program_move_count(j->program));
}

/* Returns the sum of the volumes of all moves. */
static double end(job *j)
{
    double sum = 0;
    for (size_t i = 0; i < j->moves; i++) sum += j->volume[i];
    CHECK_NEAR(sum, j->initial - j->final, 1e-6 * j->initial);
    swarf_check_destroy(j->check);
    swarf_program_release(j->program);
    swarf_cutter_release(j->cutter);
    swarf_stock_destroy(j->stock);
    return sum;
}

static double get(const job *j, swarf_load_kind kind, size_t move)
{
    return j->of[kind][move];
}

/* Angle, width, depth, chip over feed per tooth, climb of a move. */
static void expect(const job *j, size_t move, double angle, double width, double depth, double chip, double climb)
{
    const double h = j->voxel, radius = swarf_cutter_radius(j->cutter, SWARF_PART_FLUTES);
    /* an end that is off by a tenth of a voxel where the flutes cross the material's face at a slant */
    const double slant = sin(fmin(angle, 180 - angle) * M_PI / 180);
    CHECK_NEAR(get(j, SWARF_LOAD_ANGLE, move), angle,
               180 / M_PI * (slant > 0.1 ? 0.12 * h / radius / slant : sqrt(0.3 * h / radius)));
    CHECK_NEAR(get(j, SWARF_LOAD_WIDTH, move), width, 0.12 * h);
    CHECK_NEAR(get(j, SWARF_LOAD_DEPTH, move), depth, 0.1 * h);
    CHECK_NEAR(get(j, SWARF_LOAD_CHIP, move) * TEETH * rpm / feed, chip, 0.01);
    CHECK_NEAR(get(j, SWARF_LOAD_CLIMB, move), climb, 0.03);
}

static void check_rate(const job *j, size_t move, double area)
{
    CHECK_NEAR(get(j, SWARF_LOAD_PEAK_RATE, move), area * feed / 60, 0.02 * area * feed / 60);
}

static void check_slot(double voxel)
{
    job j = begin("flat:d=6,l=20", voxel, -10, 20, 5);
    go(&j, -10, 20, -4);
    go(&j, 70, 20, -4);
    go(&j, -10, 20, -4); /* nothing is left */
    go(&j, -10, 20, -6);
    go(&j, 70, 20, -6);
    run(&j);
    expect(&j, 1, 180, 6, 4, 1, 0);
    check_rate(&j, 1, 24);
    CHECK_NEAR(j.volume[1], 60 * 24, 60 * 24 * 2e-3);
    CHECK_NEAR(get(&j, SWARF_LOAD_RATE, 1), j.volume[1] / 8, 1e-3 * j.volume[1]);
    for (int k = 0; k < SWARF_LOAD_COUNT; k++) CHECK_NEAR(get(&j, (swarf_load_kind)k, 2), 0, 1e-9);
    CHECK_NEAR(j.volume[2], 0, 0.01);
    expect(&j, 4, 180, 6, 2, 1, 0); /* the walls above are rubbed along, not cut */
    check_rate(&j, 4, 12);
    CHECK_NEAR(end(&j), 60 * 36, 60 * 36 * 2e-3);
}

/* Along the face y = 0 with the block on the left, then back on the other face; at several widths. */
static void check_side(double voxel, double width)
{
    const double d = 10, angle = 180 / M_PI * acos(1 - 2 * width / d), depth = 3;
    const double chip = width < d / 2 ? sin(angle * M_PI / 180) : 1;
    job j = begin("flat:d=10,l=20", voxel, -20, width - d / 2, -depth);
    go(&j, 80, width - d / 2, -depth);      /* material on the left: conventional */
    go(&j, 80, 40 - width + d / 2, -depth); /* beside the block */
    go(&j, -20, 40 - width + d / 2, -depth);
    run(&j);
    const double climb = width <= d / 2 ? -1 : -(d / 2 - (width - d / 2)) / width;
    expect(&j, 0, angle, width, depth, chip, climb);
    expect(&j, 2, angle, width, depth, chip, climb);
    check_rate(&j, 0, width * depth);
    CHECK_NEAR(end(&j), 2 * 60 * width * depth, 2 * 60 * width * depth * 5e-3);

    job back = begin("flat:d=10,l=20", voxel, 80, width - d / 2, -depth);
    go(&back, -20, width - d / 2, -depth); /* on the right: climb */
    run(&back);
    expect(&back, 0, angle, width, depth, chip, -climb);
    end(&back);
}

static void check_plunge(double voxel)
{
    job j = begin("flat:d=6,l=20", voxel, 30, 20, 5);
    go(&j, 30, 20, -8);
    run(&j);
    expect(&j, 0, 360, 6, 0, 1, 0);
    check_rate(&j, 0, 9 * M_PI);
    CHECK_NEAR(end(&j), 72 * M_PI, 3e-3 * 72 * M_PI);

    job drill = begin("drill:d=6,l=20,a=118", voxel, 30, 20, 5);
    go(&drill, 30, 20, -8);
    run(&drill);
    const double cone = 3 / tan(59 * M_PI / 180);
    expect(&drill, 0, 360, 6, cone, sin(59 * M_PI / 180), 0);
    check_rate(&drill, 0, 9 * M_PI);
    end(&drill);
}

/* Down along x: the side sees the depth grow, the bottom cuts what it sinks. */
static void check_ramp(double voxel)
{
    job j = begin("flat:d=6,l=20", voxel, 10, 20, 0);
    go(&j, 50, 20, -5);
    run(&j);
    const double length = hypot(40, 5), chip = 40 / length;
    CHECK_NEAR(get(&j, SWARF_LOAD_ANGLE, 0), 180, 6);
    CHECK_NEAR(get(&j, SWARF_LOAD_WIDTH, 0), 6, 0.1 * voxel);
    /* the last moment stands half their distance, 0.75 mm or two voxels at most, before the end */
    CHECK_NEAR(get(&j, SWARF_LOAD_DEPTH, 0), 5, 0.06 * voxel + (fmax(0.75, 2 * voxel) / 2 + 0.1) * 5 / length);
    CHECK_NEAR(get(&j, SWARF_LOAD_CHIP, 0) * TEETH * rpm / feed, chip, 0.01);
    /* front 6 z cos and the whole bottom, sinking */
    const double most = 6 * 5 * 40 / length + 9 * M_PI * 5 / length;
    CHECK_NEAR(get(&j, SWARF_LOAD_PEAK_RATE, 0), most * feed / 60, 0.05 * most * feed / 60);
    end(&j);
}

/* A ball's slot of small depth is as wide as the ball is there. */
static void check_ball(double voxel, double depth)
{
    job j = begin("ball:d=10,l=20", voxel, -20, 20, -depth);
    go(&j, 80, 20, -depth);
    run(&j);
    const double half = sqrt(depth * (10 - depth));
    const double area = 25 * acos(1 - depth / 5) - half * (5 - depth);
    expect(&j, 0, 180, 2 * half, depth, half / 5, 0);
    check_rate(&j, 0, area);
    CHECK_NEAR(end(&j), 60 * area, 0.02 * 60 * area);
}

/* Facing with a step over of a third, the tool beyond the edge at first, climb milling all the time. */
static void check_facing(double voxel)
{
    job j = begin("flat:d=12,l=20", voxel, 80, -2, -1);
    size_t passes = 0;
    for (double y = -2; y < 44; y += 4, passes++) {
        go(&j, -20, y, -1);
        if (y < 40) {
            go(&j, -20, y, 5);
            go(&j, 80, y + 4, 5);
            go(&j, 80, y + 4, -1);
        }
    }
    run(&j);
    for (size_t i = 0; i < passes; i++) {
        const double left = fmin(4, 40 - 4 * (double)i);
        if (left <= 0) continue;
        if (i == 9) { /* the block's face is a tangent of the tool: where it leaves it is known to a root only */
            CHECK_NEAR(get(&j, SWARF_LOAD_ANGLE, 4 * i), 180 / M_PI * acos(1 - left / 6), 6 * sqrt(voxel));
            continue;
        }
        expect(&j, 4 * i, 180 / M_PI * acos(1 - left / 6), left, 1, sin(acos(1 - left / 6)), 1);
    }
    CHECK_NEAR(end(&j), 60 * 40, 60 * 40 * 2e-3);
}

/* A circle of radius 5 with a tool of radius 3 in the full: first lap a slot, second nothing; then 1 mm wider, seen
 * from inside: the angle of two circles that cross. */
static void check_arcs(double voxel)
{
    job j = begin("flat:d=6,l=20", voxel, 35, 20, -2);
    turn(&j, 35, 20, -2, 30, 20, 1, 1);
    turn(&j, 35, 20, -2, 30, 20, 1, 1);
    go(&j, 36, 20, -2);
    turn(&j, 36, 20, -2, 30, 20, 1, 1);
    run(&j);
    /* it starts and ends in the hole of its plunge, where it lacks more on one side */
    CHECK_NEAR(get(&j, SWARF_LOAD_CLIMB, 0), 0, 0.06);
    CHECK_NEAR(get(&j, SWARF_LOAD_ANGLE, 0), 180, 8 * sqrt(voxel));
    CHECK_NEAR(get(&j, SWARF_LOAD_DEPTH, 0), 2, 0.06 * voxel);
    CHECK_NEAR(get(&j, SWARF_LOAD_ANGLE, 1), 0, 1e-9);
    /* the tool's centre is 6 from the middle, the wall 8: of the circle of radius 3 what lies beyond 8 */
    const double cosine = (6 * 6 + 3 * 3 - 8 * 8) / (2 * 6 * 3.0), inner = acos(-cosine);
    CHECK_NEAR(get(&j, SWARF_LOAD_ANGLE, 3), inner * 180 / M_PI, 2.5);
    CHECK_NEAR(get(&j, SWARF_LOAD_CLIMB, 3), 1, 0.02); /* counter-clockwise inside a hole: material on the right */
    CHECK_NEAR(get(&j, SWARF_LOAD_PEAK_RATE, 3), M_PI * (81 - 64) * 2 / (12 * M_PI) * feed / 60, 0.4);
    CHECK_NEAR(end(&j), (M_PI * 81 - M_PI * 4) * 2, 4);
}

/* A bore by a helix of less than the tool's radius: each turn meets only what the one before left. */
static void check_helix(double voxel)
{
    job j = begin("flat:d=6,l=20", voxel, 32, 20, 0);
    turn(&j, 32, 20, -6, 30, 20, 1, 6);
    run(&j);
    const double pitch = 1, way = hypot(4 * M_PI, pitch);
    CHECK_NEAR(get(&j, SWARF_LOAD_DEPTH, 0), pitch, 0.06 + 0.5 * voxel); /* a wall's edge is near */
    const double mean = 25 * M_PI * pitch / way * feed / 60;             /* of a turn in the full */
    CHECK_NEAR(get(&j, SWARF_LOAD_PEAK_RATE, 0), mean, 0.12 * mean);
    end(&j);
}

/* A step of half a block: the tool enters, cuts, leaves; short moves see the same as one long. */
static void check_short_moves(double voxel, double step)
{
    job j = begin("flat:d=6,l=20", voxel, -10, 1, -3);
    for (double x = -10 + step; x <= 70; x += step) go(&j, x, 1, -3);
    run(&j);
    const double angle = 180 / M_PI * acos(1 - 2 * 4 / 6.0);
    double peak = 0, first = 0;
    for (size_t i = 0; i < j.moves; i++) {
        const double x = -10 + step * (double)(i + 1);
        if (x < -3 - 1 || x - step > 60 + 3 + 1) {
            CHECK_NEAR(get(&j, SWARF_LOAD_ANGLE, i), 0, 1e-9);
            CHECK_NEAR(j.volume[i], 0, 1e-6);
        } else if (x > 4 && x < 56) {
            CHECK_NEAR(get(&j, SWARF_LOAD_ANGLE, i), angle, 1.5 + 4 * voxel);
            CHECK_NEAR(get(&j, SWARF_LOAD_DEPTH, i), 3, 0.06 * voxel);
            CHECK_NEAR(get(&j, SWARF_LOAD_RATE, i), 12 * feed / 60, 0.12 * 12 * feed / 60);
        } else if (x > 0 && x < 1.5)
            first = fmax(first, get(&j, SWARF_LOAD_RATE, i));
        peak = fmax(peak, get(&j, SWARF_LOAD_PEAK_RATE, i));
    }
    CHECK(first > 12 * feed / 60 * 0.3);
    /* no more than 4 wide; single moves get what is left over by their samples */
    CHECK_NEAR(peak, 12 * feed / 60, 0.15 * 12 * feed / 60);
    CHECK_NEAR(end(&j), 60 * 12, 60 * 12 * 5e-3);
}

/* Any program: the sum of the volumes, limits of angles and shares, the same numbers for any threads. */
static void check_laws(uint64_t seed)
{
    static const char *const cutters[] = {"flat:d=6,l=12",        "ball:d=5,l=12",           "bull:d=8,r=2,l=12",
                                          "drill:d=4,l=12",       "tslot:d=10,n=4,h=3,l=12", "lollipop:d=6,n=3,l=12",
                                          "chamfer:d=8,a=90,l=12"};
    test_random random = test_random_begin(seed);
    const char *cutter = cutters[test_random_below(&random, 7)];
    const double voxel = test_random_in(&random, 0.3, 0.7);
    float *kept[SWARF_LOAD_COUNT] = {0};
    uint64_t hash[2];
    const uint64_t state = random.state;
    for (int pass = 0; pass < 2; pass++) {
        CHECK_OK(swarf_threads_set(pass ? 3 : 1));
        random.state = state;
        job j = begin(cutter, voxel, 30, 20, 2);
        for (int i = 0; i < 60; i++) {
            const double x = test_random_in(&random, 0, 60), y = test_random_in(&random, 0, 40);
            const double z = test_random_in(&random, -8, 1);
            const uint64_t kind = test_random_below(&random, 4);
            const size_t done = swarf_program_move_count(j.program);
            double at[3] = {30, 20, 2};
            if (done) memcpy(at, swarf_program_moves(j.program)[done - 1].end, sizeof at);
            if (kind == 0 && hypot(x - at[0], y - at[1]) > 1)
                turn(&j, at[0], at[1], z, 0.5 * (x + at[0]), 0.5 * (y + at[1]), (int)test_random_below(&random, 2), 1);
            else if (kind == 1)
                go(&j, at[0] + 0.05 * (x - 30), at[1] + 0.05 * (y - 20), at[2]);
            else
                go(&j, x, y, z);
        }
        run(&j);
        for (size_t i = 0; i < j.moves; i++) {
            CHECK(j.volume[i] > -1e-6 * j.initial);
            CHECK(get(&j, SWARF_LOAD_ANGLE, i) >= 0 && get(&j, SWARF_LOAD_ANGLE, i) <= 360);
            CHECK(fabs(get(&j, SWARF_LOAD_CLIMB, i)) <= 1.0001);
            CHECK(get(&j, SWARF_LOAD_WIDTH, i) <= 2 * swarf_cutter_radius(j.cutter, SWARF_PART_FLUTES) + 1e-6);
            CHECK(get(&j, SWARF_LOAD_CHIP, i) <= feed / rpm / TEETH + 1e-6);
            CHECK(get(&j, SWARF_LOAD_PEAK_RATE, i) >= get(&j, SWARF_LOAD_RATE, i));
        }
        for (int k = 0; k < SWARF_LOAD_COUNT; k++) {
            const size_t bytes = j.moves * sizeof(float);
            if (pass == 0 && (kept[k] = malloc(bytes))) memcpy(kept[k], j.of[k], bytes);
            if (pass == 1) CHECK(kept[k] && memcmp(kept[k], j.of[k], bytes) == 0);
            if (pass == 1) free(kept[k]);
        }
        CHECK_OK(swarf_stock_hash(j.stock, &hash[pass]));
        end(&j);
    }
    CHECK(hash[0] == hash[1]);
    CHECK_OK(swarf_threads_set(0));
}

static int stop_late(void *user, double fraction)
{
    *(double *)user = fraction;
    return fraction > 0.3;
}

/* A cancel comes through, and leaves whole moves cut: what is played again cuts nothing more. */
static void check_cancel(void)
{
    job j = begin("flat:d=6,l=20", 0.5, -10, 5, -3);
    for (int i = 0; i < 20; i++) {
        go(&j, i % 2 ? -10 : 70, 5 + i, -3);
        go(&j, i % 2 ? -10 : 70, 6 + i, -3);
    }
    const swarf_tool tool = {.number = 1, .cutter = j.cutter};
    swarf_check_options options = swarf_check_options_default();
    double reached = 0, whole = 0, part = 0, again = 0;
    const swarf_progress progress = {stop_late, &reached};
    swarf_simulation *simulation = NULL;
    options.loads = 1;
    CHECK_OK(swarf_stock_volume(j.stock, &whole));
    CHECK_FAILS(swarf_stock_check(j.stock, j.program, 0, 40, &tool, 1, &options, &progress, &j.check),
                SWARF_ERROR_CANCELLED, NULL);
    CHECK(reached > 0.3 && reached < 0.6 && j.check == NULL);
    CHECK_OK(swarf_stock_volume(j.stock, &part));
    CHECK(part < whole - 100);
    CHECK_OK(swarf_stock_simulate(j.stock, j.program, 0, 10, &tool, 1, NULL, NULL, &simulation));
    swarf_simulation_destroy(simulation);
    CHECK_OK(swarf_stock_volume(j.stock, &again));
    CHECK_NEAR(again, part, 1e-6 * whole);
    j.moves = 0;
    end(&j);
}

/* Cutting while measuring leaves the same stock as simulating. */
static void check_same_stock(void)
{
    uint64_t hash[2];
    for (int plain = 0; plain < 2; plain++) {
        job j = begin("ball:d=6,l=20", 0.4, 10, 20, 2);
        turn(&j, 10, 20, -6, 20, 20, 1, 3);
        go(&j, 50, 20, -3);
        turn(&j, 50, 20, -3, 45, 20, 0, 1);
        if (plain) {
            const swarf_tool tool = {.number = 1, .cutter = j.cutter};
            swarf_simulation *simulation = NULL;
            CHECK_OK(swarf_stock_simulate(j.stock, j.program, 0, swarf_program_move_count(j.program), &tool, 1, NULL,
                                          NULL, &simulation));
            swarf_simulation_destroy(simulation);
        } else
            run(&j);
        CHECK_OK(swarf_stock_hash(j.stock, &hash[plain]));
        if (plain) j.moves = 0, j.initial = j.final = 0;
        end(&j);
    }
    CHECK(hash[0] == hash[1]);
}

int main(void)
{
    static const double voxels[] = {0.5, 0.25, 0.17};
    for (int i = 0; i < 3; i++) {
        const double voxel = voxels[i];
        check_slot(voxel);
        for (double width = 1; width < 10; width += 2) check_side(voxel, width);
        check_plunge(voxel);
        check_ramp(voxel);
        check_ball(voxel, 2);
        check_facing(voxel);
        check_arcs(voxel);
        check_helix(voxel);
        check_short_moves(voxel, 0.8);
        check_short_moves(voxel, 0.1);
    }
    check_ball(0.1, 0.3);
    check_same_stock();
    check_cancel();
    for (uint64_t seed = 1; seed <= 4; seed++) check_laws(seed);
    return test_end();
}
