/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Laws of cutting, on random programs in a block, for every cutter:
 * again (idempotent), shuffled, in batches, with other threads and kernels, cancelled, against the oracle.
 *
 * What "the same field" means depends on the law. Within one batch nothing may change a bit. Between different batches
 * a voxel whose value is beyond sqrt(3) voxels on the outside holds no information (its leaf may have been dropped at
 * different times), so such values may differ; all others may not. (With thousands of moves they can, too, beside
 * edges outside of the material, where a track that another one dominates may tell a shorter distance; never a sign.)
 * Deep inside, within the error bound of the rim of the band, a searched distance may count as beyond the band or not.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"
#include "stocks.h"

enum { MOVES = 14, SAMPLES = 100000, BAND = 3 /* voxels of it on either side of the surface */ };

static const swarf_box block = {{-8.01, -6.02, -5}, {8.03, 6.04, 2.5}};

static double (*grid_points)[3]; /* SAMPLES voxel centres */
static double voxel;

static swarf_stock *make_stock(double voxel_mm)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel_mm;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&block, &options, &stock))) exit(test_end());
    return stock;
}

static void draw_moves(test_random *random, swarf_path *paths, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const char *name;
        int curved;
        paths[i] = case_motion((int)test_random_below(random, CASE_MOTIONS), random, &name, &curved);
    }
}

/* Voxel centres: the samples there are the stored values. */
static void draw_points(test_random *random)
{
    for (int i = 0; i < SAMPLES; i++)
        for (int k = 0; k < 3; k++) {
            const int voxels = (int)ceil((block.hi[k] - block.lo[k]) / voxel);
            const int at = (int)test_random_below(random, (uint64_t)voxels + 4) - 2;
            grid_points[i][k] = block.lo[k] + (at + 0.5) * voxel;
        }
}

static float *values_of(swarf_stock *stock)
{
    float *values = malloc(SAMPLES * sizeof *values);
    if (!values) exit(2);
    CHECK_OK(swarf_stock_sample(stock, grid_points[0], SAMPLES, values));
    return values;
}

/* Same field as far as different batches must agree: see the head of this file. */
static int same_field(const float *a, const float *b)
{
    const double roof = sqrt(3) * voxel, rim = -(BAND - SWARF_SWEEP_BOUND) * voxel;
    int different = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const double low = fmin((double)a[i], (double)b[i]), high = fmax((double)a[i], (double)b[i]);
        different += low < roof && high > rim && high - low > 1e-5 * voxel;
    }
    if (different) printf("    %d of %d values differ\n", different, SAMPLES);
    return different == 0;
}

static uint64_t hash_of_cut(const swarf_cutter *cutter, const swarf_path *paths, size_t count)
{
    swarf_stock *stock = make_stock(voxel);
    CHECK_OK(swarf_stock_cut(stock, cutter, paths, count, NULL));
    const uint64_t hash = stock_hash(stock);
    swarf_stock_destroy(stock);
    return hash;
}

static void check_batches(const swarf_cutter *cutter, const swarf_path *paths, const float *whole, double whole_volume)
{
    const size_t steps[] = {1, 5};
    for (int s = 0; s < 2; s++) {
        swarf_stock *stock = make_stock(voxel);
        double before = stock_volume(stock);
        float *earlier = values_of(stock);
        for (size_t i = 0; i < MOVES; i += steps[s]) {
            CHECK_OK(swarf_stock_cut(stock, cutter, paths + i, MOVES - i < steps[s] ? MOVES - i : steps[s], NULL));
            const double after = stock_volume(stock);
            float *later = values_of(stock);
            int risen = 1;
            for (int k = 0; k < SAMPLES; k++) risen &= later[k] >= earlier[k] - 1e-5f * (float)voxel;
            CHECK(after <= before);
            CHECK(risen); /* monotone: no value falls, so no material comes back */
            before = after;
            free(earlier);
            earlier = later;
        }
        CHECK(same_field(whole, earlier));
        CHECK_NEAR(before, whole_volume, 1e-6 * whole_volume);
        free(earlier);
        swarf_stock_destroy(stock);
    }
}

static void check_oracle(const char *name, const swarf_cutter *cutter, const swarf_path *paths, const float *values)
{
    const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
    const double bound = SWARF_SWEEP_BOUND * voxel;
    double lo[MOVES][3], hi[MOVES][3];
    for (int m = 0; m < MOVES; m++) {
        const int steps = 200;
        for (int k = 0; k < 3; k++) lo[m][k] = INFINITY, hi[m][k] = -INFINITY;
        for (int i = 0; i <= steps; i++) {
            double tip[3];
            oracle_tip(&paths[m], (double)i / steps, tip);
            const double step = oracle_length(&paths[m]) / steps;
            for (int k = 0; k < 3; k++) {
                lo[m][k] = fmin(lo[m][k], tip[k] + (k < 2 ? -body.radius : body.z_lo) - step);
                hi[m][k] = fmax(hi[m][k], tip[k] + (k < 2 ? body.radius : body.z_hi) + step);
            }
        }
    }
    int wrong = 0, removed = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const double *p = grid_points[i];
        double outside = -INFINITY;
        for (int k = 0; k < 3; k++) outside = fmax(outside, fmax(block.lo[k] - p[k], p[k] - block.hi[k]));
        int sign = outside < -bound ? 1 : outside > bound ? -1 : 0; /* 1: material */
        for (int m = 0; m < MOVES && sign >= 0; m++) {
            if (p[0] < lo[m][0] || p[1] < lo[m][1] || p[2] < lo[m][2] || p[0] > hi[m][0] || p[1] > hi[m][1] ||
                p[2] > hi[m][2])
                continue;
            const int swept = oracle_sign(&body, &paths[m], p, bound);
            sign = swept < sign ? swept : sign;
        }
        removed += sign < 0 && outside < 0;
        if (sign == 0 || (sign > 0 ? values[i] < 0 : values[i] > 0)) continue;
        if (wrong++ < 3)
            printf("    %s, voxel %.17g at %.17g %.17g %.17g holds %.9g, material by the oracle: %d\n", name, voxel,
                   p[0], p[1], p[2], (double)values[i], sign > 0);
    }
    CHECK(wrong == 0);
    CHECK(removed > SAMPLES / 1000);
}

static void check_cancel(const swarf_cutter *cutter, const swarf_path *paths, uint64_t whole_hash, const float *whole,
                         double whole_volume, test_random *random)
{
    test_stopper count = {.after = -1};
    const swarf_progress counting = {test_stop, &count};
    swarf_stock *stock = make_stock(voxel);
    const double full = stock_volume(stock);
    CHECK_OK(swarf_stock_cut(stock, cutter, paths, MOVES, &counting));
    CHECK(stock_hash(stock) == whole_hash);
    CHECK(count.calls > 0);
    CHECK(!count.fell);
    swarf_stock_destroy(stock);
    for (int i = 0; i < 4; i++) {
        test_stopper stopping = {.after = i ? (long)test_random_below(random, (uint64_t)count.calls) : 0};
        const swarf_progress progress = {test_stop, &stopping};
        stock = make_stock(voxel);
        const swarf_status status = swarf_stock_cut(stock, cutter, paths, MOVES, &progress);
        /* How often progress is reported depends on time, so a late stop may never come. */
        CHECK(status == SWARF_ERROR_CANCELLED || (i && status == SWARF_OK && stopping.calls <= stopping.after));
        const double volume = stock_volume(stock);
        CHECK(volume <= full * (1 + 1e-9) && volume >= whole_volume * (1 - 1e-9));
        CHECK_OK(swarf_stock_cut(stock, cutter, paths, MOVES, NULL));
        CHECK_NEAR(stock_volume(stock), whole_volume, 1e-6 * whole_volume);
        float *values = values_of(stock);
        CHECK(same_field(whole, values));
        free(values);
        swarf_stock_destroy(stock);
    }
}

/* In the material no voxel is nearer to the surface than its neighbour by more than the way between the two: closed
 * forms are bounds of the true distance that change no faster, searched distances are scaled to it beside edges.
 * (Outside, beyond edges, leaves drop moves whose cuts others tell.) */
static void check_neighbours(swarf_stock *stock, const float *values, int closed_form)
{
    float *beside = malloc(SAMPLES * sizeof *beside);
    double(*points)[3] = malloc(SAMPLES * sizeof *points);
    if (!beside || !points) exit(2);
    memcpy(points, grid_points, SAMPLES * sizeof *points);
    for (int i = 0; i < SAMPLES; i++) points[i][i % 3] += voxel;
    CHECK_OK(swarf_stock_sample(stock, points[0], SAMPLES, beside));
    double most = 0;
    for (int i = 0; i < SAMPLES; i++)
        if (values[i] <= 0 && beside[i] <= 0) most = fmax(most, fabs((double)values[i] - (double)beside[i]));
    CHECK_NEAR(most / voxel, 1, closed_form ? 1e-3 : 0.5);
    free(points);
    free(beside);
}

static void check_cutter(int index, test_random *random)
{
    const char *name;
    swarf_path paths[MOVES], shuffled[MOVES];
    swarf_cutter *cutter = case_cutter(index, &name);
    voxel = index % 3 == 0 ? 0.1 : test_random_in(random, 0.11, 0.3);
    if (test_size() != TEST_FULL) voxel *= 3;
    draw_moves(random, paths, MOVES);
    draw_points(random);

    swarf_stock *stock = make_stock(voxel);
    CHECK_OK(swarf_stock_cut(stock, cutter, paths, MOVES, NULL));
    const uint64_t hash = stock_hash(stock);
    const double volume = stock_volume(stock);
    float *values = values_of(stock);
    check_neighbours(stock, values, index < 2);
    CHECK_OK(swarf_stock_cut(stock, cutter, paths, MOVES, NULL));
    CHECK(stock_hash(stock) == hash); /* cutting again changes nothing */
    CHECK(stock_volume(stock) == volume);
    swarf_stock_destroy(stock);

    memcpy(shuffled, paths, sizeof paths);
    for (size_t i = MOVES - 1; i > 0; i--) {
        const size_t k = (size_t)test_random_below(random, i + 1);
        const swarf_path keep = shuffled[i];
        shuffled[i] = shuffled[k];
        shuffled[k] = keep;
    }
    CHECK(hash_of_cut(cutter, shuffled, MOVES) == hash);

    const int threads[] = {1, 2, 3, 8};
    for (int i = 0; i < 4; i++) {
        CHECK_OK(swarf_threads_set(threads[i]));
        CHECK(hash_of_cut(cutter, paths, MOVES) == hash);
    }
    CHECK_OK(swarf_threads_set(0));

    const swarf_isa at_start = swarf_isa_current();
    for (int isa = SWARF_ISA_SCALAR; isa <= SWARF_ISA_AVX512; isa++) {
        if (swarf_isa_set((swarf_isa)isa) != SWARF_OK) continue;
        if (!CHECK(hash_of_cut(cutter, paths, MOVES) == hash)) printf("    with %s\n", swarf_isa_name((swarf_isa)isa));
    }
    CHECK_OK(swarf_isa_set(at_start));

    check_batches(cutter, paths, values, volume);
    check_cancel(cutter, paths, hash, values, volume, random);
    check_oracle(name, cutter, paths, values);
    free(values);
    swarf_cutter_release(cutter);
}

int main(int count, char **argument)
{
    test_random random = test_random_begin(4711);
    grid_points = malloc(SAMPLES * sizeof *grid_points);
    if (!grid_points) return 2;
    for (int i = 0; i < CASE_CUTTERS; i++) {
        test_random own = {random.state + (uint64_t)i};
        if (count > 1 && atoi(argument[1]) != i) continue;
        const char *name;
        swarf_cutter_release(case_cutter(i, &name));
        printf("%d %s\n", i, name);
        check_cutter(i, &own);
    }
    free(grid_points);
    return test_end();
}
