/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Time: how long a machine with limited speeds and accelerations takes for each move.
 *
 * A move is a way of some length with a speed it may reach and an acceleration, both limited by each axis alone. At a
 * junction the speed is what an arc that strays from the corner by `junction_mm` allows by its centripetal
 * acceleration. Speeds at the starts of moves are limited backwards (what can still be braked in time), then forwards
 * (what can be reached): two passes over the moves, no memory but the result's. The array of seconds holds the
 * entry speeds between them.
 */
#include "base/least.h"
#include "base/status.h"
#include "program/program.h"

#include <math.h>
#include <string.h>

typedef struct way {
    int moves;            /* else nothing moves, and everything stands still */
    double length;        /* mm, or degrees */
    double speed;         /* per second */
    double acceleration;  /* per second squared; INFINITY: at once */
    double in[3], out[3]; /* directions, unit; zero where none can be passed on */
    double pause;         /* seconds without motion */
} way;

swarf_machine_limits swarf_machine_limits_default(void)
{
    return (swarf_machine_limits){sizeof(swarf_machine_limits),
                                  {5000.0, 5000.0, 5000.0},
                                  {5000.0, 5000.0, 5000.0},
                                  {500.0, 500.0, 500.0},
                                  0.01,
                                  3600.0,
                                  0.0};
}

/* The most of a quantity along `direction` that keeps each axis within its own limit; 0 in a limit: without one. */
static double along(const double direction[3], const double limits[3])
{
    double most = INFINITY;
    for (int k = 0; k < 3; k++)
        if (fabs(direction[k]) > 1e-9 && limits[k] > 0.0) most = swarf_least(most, limits[k] / fabs(direction[k]));
    return most;
}

static void line_way(const swarf_path *path, const double speeds[3], const swarf_machine_limits *limits, way *out)
{
    for (int k = 0; k < 3; k++) out->in[k] = out->out[k] = (path->end[k] - path->start[k]) / out->length;
    out->speed = swarf_least(out->speed, along(out->in, speeds) / 60.0);
    out->acceleration = along(out->in, limits->acceleration_mm_s2);
}

/* In its plane an arc goes every way: the weaker axis limits it. */
static void arc_way(const swarf_path *path, const double speeds[3], const swarf_machine_limits *limits, way *out)
{
    int a, b, n;
    swarf_plane_axes((swarf_plane)path->arc.plane, &a, &b, &n);
    const double *c = path->arc.centre, turn = path->arc.angle_rad < 0.0 ? -1.0 : 1.0;
    const double rise = (path->end[n] - path->start[n]) / out->length, flat = sqrt(fmax(0.0, 1.0 - rise * rise));
    double radius = 0.0;
    for (int i = 0; i < 2; i++) {
        const double *p = i ? path->end : path->start;
        double *direction = i ? out->out : out->in;
        const double u = p[a] - c[a], v = p[b] - c[b], r = hypot(u, v);
        radius = i ? swarf_least(radius, r) : r;
        direction[a] = r > 0.0 ? -turn * flat * v / r : 0.0;
        direction[b] = r > 0.0 ? turn * flat * u / r : 0.0;
        direction[n] = rise;
    }
    double all[3];
    all[a] = all[b] = flat;
    all[n] = rise;
    out->speed = swarf_least(out->speed, along(all, speeds) / 60.0);
    out->acceleration = along(all, limits->acceleration_mm_s2);
    if (flat > 0.0) out->speed = swarf_least(out->speed, sqrt(out->acceleration * radius) / flat);
}

static void make_way(const swarf_program *program, size_t index, const swarf_machine_limits *limits, way *out)
{
    memset(out, 0, sizeof *out);
    const swarf_move *move = &swarf_program_moves(program)[index];
    const swarf_move_kind kind = swarf_move_get_kind(move);
    if (kind == SWARF_MOVE_DWELL) out->pause = (double)move->feed_mm_min;
    if (kind == SWARF_MOVE_TOOL_CHANGE) out->pause = limits->tool_change_s;
    const int rapid = kind == SWARF_MOVE_RAPID;
    out->speed = rapid ? INFINITY : (double)move->feed_mm_min / 60.0;
    swarf_path path;
    if (!(rapid || kind == SWARF_MOVE_FEED || kind == SWARF_MOVE_PROBE) || !(out->speed > 0.0) ||
        swarf_program_path(program, index, &path) != SWARF_OK)
        return;
    out->length = swarf_path_length(&path);
    const double *speeds = rapid ? limits->rapid_mm_min : limits->feed_mm_min;
    if (out->length > 0.0) { /* an unknown start has a length that is not a number */
        if (path.is_arc)
            arc_way(&path, speeds, limits, out);
        else
            line_way(&path, speeds, limits, out);
        out->moves = 1;
        return;
    }
    double from[6], to[6], turn = 0.0;
    if (!swarf_program_move_axes(program, index, from, to)) return;
    for (int k = 0; k < 3; k++) turn += (to[k] - from[k]) * (to[k] - from[k]);
    out->length = sqrt(turn);
    out->speed = swarf_least(out->speed, limits->rotary_deg_min / 60.0);
    out->acceleration = INFINITY;
    out->moves = out->length > 0.0;
}

/* Speed through the corner between two ways: on an arc that strays from it by `junction`. */
static double corner_speed(const way *before, const way *after, double junction)
{
    if (!before->moves || !after->moves) return 0.0;
    double cosine = 0.0, sum = 0.0;
    for (int k = 0; k < 3; k++) {
        cosine -= before->out[k] * after->in[k];
        sum += fabs(before->out[k]) + fabs(after->in[k]);
    }
    if (!(sum > 0.0)) return 0.0;
    const double most = swarf_least(before->speed, after->speed);
    if (cosine < -0.999999) return most;                       /* straight on */
    const double half = sqrt(fmax(0.0, 0.5 * (1.0 - cosine))); /* sine of half the angle between them */
    const double acceleration = swarf_least(before->acceleration, after->acceleration);
    if (half >= 1.0) return most;
    return swarf_least(most, sqrt(acceleration * junction * half / (1.0 - half)));
}

/* The most that can be reached over a length from a speed. */
static double reach(double speed, double acceleration, double length)
{
    return sqrt(speed * speed + 2.0 * acceleration * length);
}

static double seconds_of(const way *w, double in, double out)
{
    if (!w->moves) return w->pause;
    if (!isfinite(w->acceleration)) return isfinite(w->speed) ? w->length / w->speed : 0.0;
    double peak = sqrt(w->acceleration * w->length + 0.5 * (in * in + out * out));
    peak = swarf_least(peak, w->speed);
    if (!(peak > 0.0)) return 0.0;
    const double ramps = (2.0 * peak * peak - in * in - out * out) / (2.0 * w->acceleration);
    return (2.0 * peak - in - out) / w->acceleration + fmax(0.0, w->length - ramps) / peak;
}

static int is_speed(double value)
{
    return value > 0.0 && value <= 1e9;
}

static swarf_status check_limits(const swarf_machine_limits *limits)
{
    SWARF_REQUIRE(limits->size == sizeof *limits, "time: limits of %zu bytes; take swarf_machine_limits_default()",
                  limits->size);
    for (int k = 0; k < 3; k++) {
        const char axis = "XYZ"[k];
        const double rapid = limits->rapid_mm_min[k], feed = limits->feed_mm_min[k];
        const double acceleration = limits->acceleration_mm_s2[k];
        SWARF_REQUIRE(is_speed(rapid), "time: rapid_mm_min of %c is %g; above 0 and up to 1e9 is possible", axis,
                      rapid);
        SWARF_REQUIRE(is_speed(feed), "time: feed_mm_min of %c is %g; above 0 and up to 1e9 is possible", axis, feed);
        SWARF_REQUIRE(acceleration >= 0.0 && acceleration <= 1e9,
                      "time: acceleration_mm_s2 of %c is %g; 0 (at once) to 1e9 is possible", axis, acceleration);
    }
    SWARF_REQUIRE(limits->junction_mm >= 0.0 && limits->junction_mm <= 1e3,
                  "time: junction_mm is %g; 0 to 1000 is possible", limits->junction_mm);
    SWARF_REQUIRE(is_speed(limits->rotary_deg_min), "time: rotary_deg_min is %g; above 0 and up to 1e9 is possible",
                  limits->rotary_deg_min);
    SWARF_REQUIRE(limits->tool_change_s >= 0.0 && limits->tool_change_s <= 1e6,
                  "time: tool_change_s is %g; 0 to 1e6 is possible", limits->tool_change_s);
    return SWARF_OK;
}

swarf_status swarf_program_times(const swarf_program *program, const swarf_machine_limits *limits, double *seconds)
{
    const size_t count = swarf_program_move_count(program);
    SWARF_REQUIRE(program && (seconds || count == 0), "time: program or output missing");
    const swarf_machine_limits defaults = swarf_machine_limits_default();
    if (!limits) limits = &defaults;
    SWARF_TRY(check_limits(limits));
    way next, here, before;
    memset(&next, 0, sizeof next);
    double out = 0.0; /* the most with which the move may end */
    if (count) make_way(program, count - 1, limits, &here);
    for (size_t i = count; i-- > 0; next = here, here = before) {
        memset(&before, 0, sizeof before);
        if (i) make_way(program, i - 1, limits, &before);
        const double braked = here.moves ? reach(out, here.acceleration, here.length) : 0.0;
        seconds[i] = out =
            swarf_least(swarf_least(braked, here.speed), corner_speed(&before, &here, limits->junction_mm));
    }
    double in = 0.0;
    if (count) make_way(program, 0, limits, &here);
    for (size_t i = 0; i < count; i++, here = next) {
        memset(&next, 0, sizeof next);
        if (i + 1 < count) make_way(program, i + 1, limits, &next);
        const double wanted = i + 1 < count ? seconds[i + 1] : 0.0;
        const double end = here.moves ? swarf_least(wanted, reach(in, here.acceleration, here.length)) : 0.0;
        seconds[i] = seconds_of(&here, in, end);
        in = end;
    }
    return SWARF_OK;
}
