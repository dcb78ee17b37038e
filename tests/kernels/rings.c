/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernels that simplifying asks about the facets round a vertex. A tip over a regular polygon lies as far from
 * what it becomes as it is high, and the triangles that come are known; on other rings all instruction sets find the
 * same bits. */
#include <math.h>
#include <string.h>

#include "mesh/ring.h"
#include "test.h"

/** Put what follows from the places and true normals. */
static void finish(ring *around)
{
    const int n = around->count;
    for (int i = n; i <= (n + 7) / 8 * 8; i++)
        for (int k = 0; k < 3; k++) {
            around->at[k][i] = i == n ? around->at[k][0] : 0;
            around->true_normal[k][i] = i == n ? around->true_normal[k][0] : 0;
        }
    around->shape = -1;
}

/** Returns the vertices that are near enough; the error of the nearest of the others is what it is. */
static uint32_t measure(const ring_kernel *kernel, ring *around, double limit)
{
    double least, expected = INFINITY;
    uint32_t expected_near = 0;
    kernel->look_flat(around, limit);
    kernel->find_dots(around);
    const uint32_t near = kernel->find_lifts(around, limit, &least);
    for (int j = 0; j < around->count; j++) {
        const double error = around->error + around->lift[j];
        if (error <= limit)
            expected_near |= 1U << j;
        else
            expected = fmin(expected, error);
    }
    CHECK(near == expected_near);
    CHECK(memcmp(&least, &expected, sizeof least) == 0);
    return near;
}

/** A tip over a regular polygon of radius 1. */
static ring make_tip(int n, double height)
{
    ring tip = {.count = n};
    for (int i = 0; i < n; i++) {
        const double angle = 2 * M_PI * i / n;
        const double at[3] = {cos(angle), sin(angle), -height};
        for (int k = 0; k < 3; k++) {
            tip.at[k][i] = at[k];
            tip.true_normal[k][i] = k == 2 ? 32767 : 0;
        }
    }
    finish(&tip);
    return tip;
}

/** Shape (4 sqrt(3) area / sum of squared sides) of the worst triangle when a regular polygon is a fan: of two sides
 * and what they span, or the one with two longest diagonals. */
static double fan_shape(int n)
{
    double worst = 1;
    for (int i = 1; i < n - 1; i++) {
        const double a = 2 * sin(M_PI * i / n), b = 2 * sin(M_PI * (i + 1) / n), c = 2 * sin(M_PI / n);
        const double area = a * b * c / 4; /* in a circle of radius 1 */
        worst = fmin(worst, 4 * sqrt(3) * area / (a * a + b * b + c * c));
    }
    return worst;
}

static void check_tips(const ring_kernel *kernel)
{
    static const double height = 0.1, limit = 0.5;
    for (int n = 3; n <= RING_MOST; n++) {
        ring tip = make_tip(n, height), flat = make_tip(n, 0.02 * limit);
        const double shape = fan_shape(n);
        double error, score;
        measure(kernel, &tip, limit);
        CHECK(tip.slab < 0);
        kernel->look_flat(&flat, limit);
        CHECK_NEAR(flat.slab, 0.02 * limit, 1e-12);
        tip.error = 0.05;
        for (int j = 0; j < n; j++) CHECK_NEAR(tip.lift[j], height, 1e-12);
        /* with more the bound is wider: edges that run side by side count as passing each other */
        for (int j = 0; j < n && n <= 28; j++) {
            CHECK(kernel->try_draw(&tip, j, limit, -1, &error, &score));
            CHECK_NEAR(error, tip.error + height, 1e-12);
            CHECK_NEAR(score, shape * (1 - 0.95 * error / limit), 1e-9);
            CHECK(!kernel->try_draw(&tip, j, limit, score + 1e-9, &error, &score));
            CHECK(!kernel->try_draw(&tip, j, tip.error + 0.99 * height, -1, &error, &score));
            CHECK_NEAR(error, tip.error + height, 1e-12);
            CHECK(kernel->try_draw(&flat, j, limit, -1, &error, &score));
            CHECK_NEAR(error, 2 * 0.02 * limit, 1e-12);
            CHECK_NEAR(score, shape, 1e-9);
        }
    }
    /* a facet that turns over */
    ring dart = make_tip(4, 0.1);
    dart.at[0][2] = 0.3;
    finish(&dart);
    measure(kernel, &dart, limit);
    double error, score;
    CHECK(!kernel->try_draw(&dart, 1, limit, -1, &error, &score));
    CHECK(isinf(error));
}

/** On the straight edge of a blade, with two flat sides close to each other: along the edge nothing changes. */
static void check_blade(const ring_kernel *kernel)
{
    static const double at[6][3] = {{1, 0, 0},  {0.5, 0.3, -1},   {-0.5, 0.3, -1},
                                    {-1, 0, 0}, {-0.5, -0.3, -1}, {0.5, -0.3, -1}};
    static const double limit = 0.5;
    ring blade = {.count = 6, .error = 0.05};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 3; k++) {
            blade.at[k][i] = at[i][k];
            blade.true_normal[k][i] = k == 1 ? (i < 3 ? 32767 : -32767) : 0;
        }
    finish(&blade);
    blade.crease = kernel->find_creases(&blade);
    CHECK(blade.crease == (1U << 0 | 1U << 3));
    measure(kernel, &blade, limit);
    for (int j = 0; j < 6; j += 3) {
        double error, score;
        CHECK(kernel->try_draw(&blade, j, limit, -1, &error, &score));
        CHECK_NEAR(error, blade.error, 1e-7);
    }
    /* a bend of the edge to the side: one of the sides is nearer than the edge */
    for (int i = 0; i < 6; i++) blade.at[1][i] -= 0.1;
    finish(&blade);
    measure(kernel, &blade, limit);
    double error, score;
    CHECK(kernel->try_draw(&blade, 0, limit, -1, &error, &score));
    CHECK_NEAR(error, blade.error + 0.1, 1e-7);
}

/** Edges between facets whose normals are more than 25 degrees apart, on rings that turn by so much all the time. */
static void check_creases(const ring_kernel *kernel)
{
    for (int n = 3; n <= RING_MOST; n++)
        for (int sharp = 0; sharp < 2; sharp++) {
            const double turn = (sharp ? 25.2 : 24.8) * M_PI / 180;
            ring around = {.count = n};
            uint32_t expected = 0;
            for (int i = 0; i < n; i++) {
                around.true_normal[0][i] = round(32767 * cos(i * turn));
                around.true_normal[1][i] = round(32767 * sin(i * turn));
                const double last = (i ? 1 : n - 1) * turn;
                expected |= (uint32_t)(cos(last) < cos(25 * M_PI / 180)) << i;
            }
            finish(&around);
            CHECK(kernel->find_creases(&around) == expected);
        }
}

/** Some are flat, some rough, some have places side by side; some lie on an edge of the surface. */
static ring make_any(test_random *random)
{
    ring any = {.count = 3 + (int)test_random_below(random, RING_MOST - 2)};
    if (test_random_below(random, 3)) any.count = 3 + (int)test_random_below(random, 6);
    const int n = any.count;
    const double rough = test_random_below(random, 4) ? test_random_in(random, 0, 0.4) : 0;
    for (int i = 0; i < n; i++) {
        const double angle = 2 * M_PI * (i + test_random_in(random, 0, 0.9)) / n,
                     far = test_random_in(random, 0.5, 1.5);
        const double at[3] = {far * cos(angle), far * sin(angle), test_random_in(random, -rough, rough)};
        for (int k = 0; k < 3; k++) {
            any.at[k][i] = test_random_below(random, 8) ? at[k] : round(2 * at[k]) / 2;
            any.true_normal[k][i] = k == 2 ? 32000 : round(test_random_in(random, -9000, 9000) * rough);
        }
    }
    if (test_random_below(random, 3) == 0)
        any.crease = 1U << test_random_below(random, (uint64_t)n) | 1U << test_random_below(random, (uint64_t)n);
    if (!(any.crease & (any.crease - 1))) any.crease = 0;
    any.error = test_random_in(random, 0, 0.1);
    finish(&any);
    return any;
}

/** Returns how many of the draws may be. */
static int compare(const ring_kernel *kernel, const ring *any, double limit, double least)
{
    ring own = *any, reference = *any;
    int may = 0;
    CHECK(kernel->find_creases(any) == swarf_ring_kernel_scalar.find_creases(any));
    CHECK(measure(kernel, &own, limit) == measure(&swarf_ring_kernel_scalar, &reference, limit));
    const size_t size = (size_t)any->count * sizeof(double);
    CHECK(memcmp(&own.slab, &reference.slab, sizeof own.slab) == 0);
    CHECK(memcmp(own.lift, reference.lift, size) == 0);
    for (int k = 0; k < 3; k++) CHECK(memcmp(own.normal[k], reference.normal[k], size) == 0);
    for (int i = 0; i < any->count; i++) CHECK(memcmp(own.dots[i], reference.dots[i], size) == 0);
    for (int j = 0; j < any->count; j++) {
        double error[2], score[2] = {0};
        const int found = kernel->try_draw(&own, j, limit, least, &error[0], &score[0]);
        CHECK(swarf_ring_kernel_scalar.try_draw(&reference, j, limit, least, &error[1], &score[1]) == found);
        CHECK(memcmp(&error[0], &error[1], sizeof error[0]) == 0);
        CHECK(!found || memcmp(&score[0], &score[1], sizeof score[0]) == 0);
        may += found;
    }
    return may;
}

int main(void)
{
    test_random random = test_random_begin(71);
    const swarf_isa at_start = swarf_isa_current();
    for (int isa = SWARF_ISA_SCALAR; isa <= SWARF_ISA_AVX512; isa++) {
        if (swarf_isa_set((swarf_isa)isa) != SWARF_OK) {
            printf("%s: not here, skipped\n", swarf_isa_name((swarf_isa)isa));
            continue;
        }
        const ring_kernel *const kernel = swarf_ring_kernel_current();
        check_tips(kernel);
        check_blade(kernel);
        check_creases(kernel);
        int may = 0;
        for (int trial = 0; trial < 3000; trial++) {
            const ring any = make_any(&random);
            may += compare(kernel, &any, test_random_in(&random, 0.1, 1),
                           test_random_below(&random, 2) ? test_random_in(&random, 0, 0.5) : -1);
        }
        CHECK(may > 1000);
    }
    CHECK_OK(swarf_isa_set(at_start));
    return test_end();
}
