/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Times of moves against closed forms of motion with limited acceleration. */
#include "test.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static swarf_machine_limits limits_of(double acceleration, double junction)
{
    swarf_machine_limits limits = swarf_machine_limits_default();
    for (int k = 0; k < 3; k++) {
        limits.rapid_mm_min[k] = 6000;
        limits.feed_mm_min[k] = 6000;
        limits.acceleration_mm_s2[k] = acceleration;
    }
    limits.junction_mm = junction;
    return limits;
}

static swarf_program *program_at_zero(void)
{
    const double zero[3] = {0, 0, 0};
    swarf_program *program = NULL;
    CHECK_OK(swarf_program_create(zero, &program));
    return program;
}

static void go(swarf_program *program, double x, double y, double feed)
{
    const double end[3] = {x, y, 0};
    CHECK_OK(swarf_program_add_line(program, feed > 0 ? SWARF_MOVE_FEED : SWARF_MOVE_RAPID, end, feed, 1));
}

int main(void)
{
    double t[64];
    /* from rest to rest: at 100 mm/s with 500 mm/s2, ramps of 10 mm and 0.2 s, the rest at full speed */
    swarf_program *program = program_at_zero();
    go(program, 120, 0, 6000);
    swarf_machine_limits limits = limits_of(500, 0);
    CHECK_OK(swarf_program_times(program, &limits, t));
    CHECK_NEAR(t[0], 1.4, 1e-12);
    /* too short for full speed: a triangle */
    go(program, 125, 0, 6000);
    CHECK_OK(swarf_program_times(program, &limits, t));
    CHECK_NEAR(t[0] + t[1], 1.4 + 0.05, 1e-9); /* straight on: no stop between them */
    /* acceleration at once: length over speed */
    limits = limits_of(0, 0);
    CHECK_OK(swarf_program_times(program, &limits, t));
    CHECK_NEAR(t[0], 1.2, 1e-12);
    CHECK_NEAR(t[1], 0.05, 1e-12);
    swarf_program_release(program);

    /* a right angle stops without a junction, and passes at sqrt(a d s / (1 - s)), s = sin 45, with one */
    program = program_at_zero();
    go(program, 120, 0, 6000);
    go(program, 120, 120, 6000);
    limits = limits_of(500, 0);
    CHECK_OK(swarf_program_times(program, &limits, t));
    CHECK_NEAR(t[0] + t[1], 2.8, 1e-9);
    limits = limits_of(500, 0.01);
    CHECK_OK(swarf_program_times(program, &limits, t));
    const double s = sqrt(0.5), v = sqrt(500 * 0.01 * s / (1 - s));
    const double brake = (100 - v) / 500, way = (100 * 100 - v * v) / 1000;
    CHECK_NEAR(t[0], 0.2 + (120 - 10 - way) / 100 + brake, 1e-9);
    CHECK_NEAR(t[1], t[0], 1e-9);
    swarf_program_release(program);

    /* axes have limits of their own: a diagonal may be faster than one axis, by sqrt 2 */
    program = program_at_zero();
    go(program, 1000, 1000, 0);
    limits = limits_of(0, 0);
    CHECK_OK(swarf_program_times(program, &limits, t));
    CHECK_NEAR(t[0], 10, 1e-9);
    limits.rapid_mm_min[1] = 600;
    CHECK_OK(swarf_program_times(program, &limits, t));
    CHECK_NEAR(t[0], 100, 1e-9);
    swarf_program_release(program);

    /* an arc's speed is bounded by its centripetal acceleration */
    program = program_at_zero();
    const double end[3] = {0, 0, 0}, centre[3] = {2, 0, 0};
    CHECK_OK(swarf_program_add_arc(program, end, centre, SWARF_PLANE_XY, 1, 10, 6000, 1));
    limits = limits_of(500, 0);
    CHECK_OK(swarf_program_times(program, &limits, t));
    const double speed = sqrt(500 * 2.0), length = 10 * 2 * pi * 2;
    CHECK_NEAR(t[0], length / speed + speed / 500, 1e-9);
    /* dwells and tool changes */
    CHECK_OK(swarf_program_add_event(program, SWARF_MOVE_DWELL, 2.5, 1));
    CHECK_OK(swarf_program_add_event(program, SWARF_MOVE_TOOL_CHANGE, 0, 1));
    limits.tool_change_s = 7;
    CHECK_OK(swarf_program_times(program, &limits, t));
    CHECK(t[1] == 2.5 && t[2] == 7);
    swarf_program_release(program);

    /* laws: never faster than without acceleration, never slower than with a stop after each move */
    test_random random = test_random_begin(21);
    for (int n = 0; n < 200; n++) {
        program = program_at_zero();
        for (int i = 0; i < 50; i++)
            go(program, test_random_in(&random, -20, 20), test_random_in(&random, -20, 20),
               i % 7 ? test_random_in(&random, 100, 8000) : 0);
        double at_once[64], stopping[64], sum[3] = {0, 0, 0};
        limits = limits_of(400, 0.02);
        CHECK_OK(swarf_program_times(program, &limits, t));
        limits = limits_of(0, 0);
        CHECK_OK(swarf_program_times(program, &limits, at_once));
        limits = limits_of(400, 0);
        CHECK_OK(swarf_program_times(program, &limits, stopping));
        for (int i = 0; i < 50; i++) {
            CHECK(t[i] >= at_once[i] - 1e-9);
            sum[0] += at_once[i], sum[1] += t[i], sum[2] += stopping[i];
        }
        CHECK(sum[0] <= sum[1] && sum[1] <= sum[2] + 1e-9);
        swarf_program_release(program);
    }
    limits = limits_of(400, 0);
    limits.rapid_mm_min[2] = 0;
    program = program_at_zero();
    CHECK_FAILS(swarf_program_times(program, &limits, t), SWARF_ERROR_ARGUMENT, "rapid_mm_min of Z is 0; above 0");
    swarf_program_release(program);
    return test_end();
}
