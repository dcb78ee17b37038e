/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Traces: a look at one with a limit tells what one without does, bit for bit, of all that is nearer than the limit,
 * and of nothing else that it is nearer; and tangents never promise more than there is. All cutters and motions. Beside
 * ramps of flat ends the value is never far below the distance. On the surface of ramps of
 * flat and ball ends normals and moments are right. */
#include "surface/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"
#include "gradient.h"

static const double voxel = 0.1;

/** Near the path, where cutters touch, and farther off. */
static void some_point(const oracle_body *body, const swarf_path *path, test_random *random, double out[3])
{
    oracle_random_point(body, path, (test_random_below(random, 4) ? 3 : 60) * voxel, random, out);
}

/* What is near without a limit, and how near anything may be. */
static swarf_touch touch_at(const swarf_trace *trace, const double point[3])
{
    swarf_touch touch, bound;
    swarf_trace_look(trace, point, INFINITY, &touch);
    swarf_trace_bound(trace, point, &bound);
    touch.raw = bound.raw;
    touch.exact = bound.exact;
    touch.bounds = bound.bounds;
    memcpy(touch.bound, bound.bound, sizeof touch.bound);
    return touch;
}

/* What looks with limits about the value, and far from it, tell. */
static void check_look(const swarf_trace *trace, const double point[3], const swarf_touch *touch, test_random *random,
                       long counts[2])
{
    const double value = touch->value;
    const double limits[] = {value,
                             nextafter(value, INFINITY),
                             value + test_random_in(random, 0, 1),
                             value - test_random_in(random, 0, 1),
                             1e3,
                             INFINITY,
                             -1e3};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        swarf_touch look;
        memset(&look, 0xa5, sizeof look);
        swarf_trace_look(trace, point, limits[i], &look);
        counts[value < limits[i]]++;
        if (value < limits[i])
            CHECK(look.value == value && look.t == touch->t && look.piece == touch->piece &&
                  memcmp(look.gradient, touch->gradient, sizeof look.gradient) == 0);
        else
            CHECK(look.value >= limits[i]);
    }
}

/* `raw` of another point is not below the least tangent; and what is known of that point from here, which is how far
 * they lie apart, tells of no sweep too much: neither where it has no material nor how near it comes. */
static void check_bounds(const swarf_trace *trace, const double point[3], const swarf_touch *touch,
                         const double other[3])
{
    const swarf_touch there = touch_at(trace, other);
    double least = INFINITY, square = 0;
    for (int i = 0; i < touch->bounds; i++) {
        double bound = touch->bound[i].value;
        for (int k = 0; k < 3; k++) bound += touch->bound[i].slope[k] * (other[k] - point[k]);
        least = fmin(least, bound);
    }
    for (int k = 0; k < 3; k++) square += (other[k] - point[k]) * (other[k] - point[k]);
    CHECK(touch->bounds == 0 || there.raw >= least - 1e-9);
    CHECK(touch->raw - sqrt(square) <= fmax(there.value, 0) + 1e-6);
    CHECK(there.value >= 0 || there.raw <= 0);
}

static double value_at(const void *trace, const double point[3])
{
    swarf_touch touch;
    swarf_trace_look(trace, point, INFINITY, &touch);
    return touch.value;
}

/* Where the surface of the sweep is smooth its normal is what values change by, and the cutter that stands at t touches
 * it. Returns whether the point led there. */
static int check_surface(const oracle_body *shape, const swarf_path *path, const swarf_trace *trace,
                         const double point[3])
{
    const double step = 1e-6;
    double at[3] = {point[0], point[1], point[2]}, slope[3];
    swarf_touch touch;
    swarf_trace_look(trace, at, INFINITY, &touch);
    for (int i = 0; i < 20 && fabs(touch.value) > 1e-10; i++) {
        for (int k = 0; k < 3; k++) at[k] -= touch.value * touch.gradient[k];
        swarf_trace_look(trace, at, INFINITY, &touch);
    }
    if (!(fabs(touch.value) <= 1e-10) || fabs(test_gradient(value_at, trace, at, step, slope) - 1) > 1e-6) return 0;
    double apart = 0;
    for (int k = 0; k < 3; k++) apart = fmax(apart, fabs(slope[k] - touch.gradient[k]));
    const double there = oracle_at(shape, path, at, touch.t);
    if (!CHECK(apart < 1e-4) || !CHECK(fabs(there) < 1e-6))
        printf("    piece %d at %.9g, %.9g, %.9g: normal %.2e off, the cutter %.2e away at t = %.9g\n", touch.piece,
               at[0], at[1], at[2], apart, there, touch.t);
    return 1;
}

/* Ramps of flat and ball ends in any direction, all round. */
static void check_surfaces(test_random *random)
{
    const int ramps = test_size() == TEST_LIGHT ? 3 : 30;
    for (int number = 0; number < 2 * ramps; number++) {
        const char *name;
        swarf_cutter *cutter = case_cutter(number & 1, &name);
        const oracle_body shape = oracle_body_of(cutter, SWARF_PART_FLUTES);
        const double way = test_random_in(random, 0, 2 * M_PI), run = test_random_in(random, 0.5, 6);
        const double rise = run * exp(test_random_in(random, log(0.02), log(5)));
        const double end = test_random_below(random, 2) ? rise : -rise;
        const swarf_path path = oracle_line(1, 2, 3, 1 + run * cos(way), 2 + run * sin(way), 3 + end);
        swarf_body *body = NULL;
        if (!CHECK_OK(swarf_body_create(cutter, SWARF_PART_FLUTES, voxel, &body))) exit(test_end());
        swarf_trace trace;
        int on_surface = 0;
        swarf_trace_make(body, &path, 7, 0, 1, &trace);
        for (int i = 0; i < 200; i++) {
            double point[3];
            oracle_random_point(&shape, &path, 3 * voxel, random, point);
            on_surface += check_surface(&shape, &path, &trace, point);
        }
        CHECK(on_surface > 50);
        swarf_body_destroy(body);
        swarf_cutter_release(cutter);
    }
}

/* The plane that touches what a disc of radius R sweeps up a slope where the similar ellipse through a point has its
 * normal: at `w` across, `depth` straight below the disc's middle. */
static double rim_plane(double R, double slope, double w, double depth)
{
    const double tilt = slope / hypot(1, slope), away = depth / hypot(1, slope);
    const double u = w / R, v = away / (R * tilt), length = hypot(u * tilt, v);
    return (u * tilt * w + v * away) / length - R * tilt * hypot(u, v) / length;
}

/* Outside of what a flat end ramps through, which is convex, values are bounds by planes that touch it: none above the
 * distance, and as the best are nearly square to the way there, none below 0.45 of it, beside the rim's wall either, or
 * below the rim's plane. */
static void check_ramps(test_random *random)
{
    const char *name;
    swarf_cutter *flat = case_cutter(0, &name);
    const oracle_body shape = oracle_body_of(flat, SWARF_PART_FLUTES);
    const int ramps = test_size() == TEST_LIGHT ? 3 : 12;
    int outside = 0;
    double least = INFINITY;
    swarf_body *body = NULL;
    if (!CHECK_OK(swarf_body_create(flat, SWARF_PART_FLUTES, voxel, &body))) exit(test_end());
    for (int ramp = 0; ramp < ramps; ramp++) {
        const double slope = exp(test_random_in(random, log(0.02), log(3)));
        const swarf_path path = oracle_line(0, 0, 0, 10, 0, 10 * slope);
        swarf_trace trace;
        swarf_trace_make(body, &path, 7, 0, 1, &trace);
        for (int i = 0; i < 500; i++) {
            const double s = test_random_in(random, 3, 7), depth = test_random_in(random, -0.1, 2.1 * slope + 0.4);
            const double w = shape.radius + 0.1 - pow(test_random_in(random, 0, 1), 3);
            const double point[3] = {s, i & 1 ? w : -w, s * slope - depth};
            const double distance = oracle_distance(&shape, &path, point);
            if (distance < 1e-3 * voxel) continue;
            const swarf_touch touch = touch_at(&trace, point);
            CHECK(touch.value < distance + 1e-6);
            CHECK(depth <= 0 || touch.value >= rim_plane(shape.radius, slope, w, depth) - 1e-9);
            least = fmin(least, touch.value / distance);
            outside++;
        }
    }
    printf("ramps of flat ends: values from %.2f of the distance, at %d points\n", least, outside);
    CHECK(least > 0.45 && outside > 100);
    swarf_body_destroy(body);
    swarf_cutter_release(flat);
}

int main(void)
{
    test_random random = test_random_begin(61);
    const int points = test_size() == TEST_LIGHT ? 6 : 60;
    long counts[2] = {0}, bounded = 0;
    for (int number = 0; number < CASE_CUTTERS * CASE_MOTIONS; number++) {
        const char *cutter_name, *motion_name;
        int curved;
        swarf_cutter *cutter = case_cutter(number / CASE_MOTIONS, &cutter_name);
        const oracle_body shape = oracle_body_of(cutter, SWARF_PART_FLUTES);
        const swarf_path path = case_motion(number % CASE_MOTIONS, &random, &motion_name, &curved);
        swarf_body *body = NULL;
        if (!CHECK_OK(swarf_body_create(cutter, SWARF_PART_FLUTES, voxel, &body))) return test_end();
        const uint32_t parts = swarf_trace_parts(&path);
        for (uint32_t part = 0; part < parts; part++) {
            swarf_trace trace;
            swarf_trace_make(body, &path, 7, part, parts, &trace);
            for (int i = 0; i < points; i++) {
                double point[3], other[3];
                some_point(&shape, &path, &random, point);
                some_point(&shape, &path, &random, other);
                const swarf_touch touch = touch_at(&trace, point);
                if (!CHECK(isfinite(touch.value))) printf("    %s, %s\n", cutter_name, motion_name);
                bounded += touch.bounds > 0;
                check_look(&trace, point, &touch, &random, counts);
                check_bounds(&trace, point, &touch, other);
            }
        }
        swarf_body_destroy(body);
        swarf_cutter_release(cutter);
    }
    check_surfaces(&random);
    check_ramps(&random);
    CHECK(counts[0] > 1000 && counts[1] > 1000 && bounded > 100);
    return test_end();
}
