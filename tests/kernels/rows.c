/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernels that look at a leaf's values as they are: what is in the band, which rows changed, which repeat the one
 * before. Every instruction set gives what plain loops over single values give: floats that are equal but have other
 * bits (0 and -0) differ, NANs with the same bits do not, and what is at the band's edge is out of it. */
#include <math.h>
#include <string.h>

#include "sweep/kernel.h"
#include "test.h"

enum { LEAF = 512, ROW = 8, ROWS = LEAF / ROW };

static const float background = 0.3f;

/** A value such as leaves have, or one of those that are easily taken for another. */
static float any_value(test_random *random)
{
    const float special[] = {0,
                             -0.0f,
                             background,
                             -background,
                             nextafterf(background, 0),
                             NAN,
                             -background * 2,
                             INFINITY,
                             -INFINITY,
                             1e-40f,
                             -nextafterf(background, 1)};
    if (test_random_below(random, 3) == 0) return special[test_random_below(random, sizeof special / sizeof *special)];
    return (float)test_random_in(random, -1.2 * background, 1.2 * background);
}

/** Few different values, and many rows that are as one before. */
static void fill(test_random *random, float values[LEAF])
{
    for (int row = 0; row < ROWS; row++) {
        const int from = row ? (int)test_random_below(random, (uint64_t)row) : 0;
        float *const own = values + row * ROW;
        if (row && test_random_below(random, 2))
            memcpy(own, values + (test_random_below(random, 2) ? row - 1 : from) * ROW, ROW * sizeof *own);
        else
            for (int i = 0; i < ROW; i++) own[i] = any_value(random);
    }
}

static int is_same_row(const float *a, const float *b)
{
    for (int i = 0; i < ROW; i++)
        if (memcmp(&a[i], &b[i], sizeof a[i]) != 0) return 0;
    return 1;
}

static void check(const swarf_kernel *kernel, const float before[LEAF], const float after[LEAF])
{
    uint64_t mask[8], band[8] = {0}, changed = 0, repeated = 0;
    for (int i = 0; i < LEAF; i++) band[i / 64] |= (uint64_t)(fabsf(before[i]) < background) << (i % 64);
    for (int row = 0; row < ROWS; row++) {
        changed |= (uint64_t)!is_same_row(before + row * ROW, after + row * ROW) << row;
        if (row) repeated |= (uint64_t)is_same_row(before + row * ROW, before + (row - 1) * ROW) << row;
    }
    memset(mask, 0xa5, sizeof mask);
    kernel->band(before, background, mask);
    CHECK(memcmp(mask, band, sizeof mask) == 0);
    CHECK(kernel->rows_changed(before, after) == changed);
    CHECK(kernel->rows_changed(before, before) == 0);
    CHECK(kernel->rows_repeated(before) == repeated);
}

int main(void)
{
    test_random random = test_random_begin(91);
    const swarf_isa at_start = swarf_isa_current();
    for (int isa = SWARF_ISA_SCALAR; isa <= SWARF_ISA_AVX512; isa++) {
        if (swarf_isa_set((swarf_isa)isa) != SWARF_OK) {
            printf("%s: not here, skipped\n", swarf_isa_name((swarf_isa)isa));
            continue;
        }
        const swarf_kernel *const kernel = swarf_kernel_current();
        for (int trial = 0; trial < 300; trial++) {
            float before[LEAF], after[LEAF];
            fill(&random, before);
            memcpy(after, before, sizeof after);
            /* one value, then some rows, then all of them */
            after[test_random_below(&random, LEAF)] = any_value(&random);
            check(kernel, before, after);
            for (int row = 0; row < ROWS; row++)
                if (test_random_below(&random, 2)) after[row * ROW + (int)test_random_below(&random, ROW)] += 1;
            check(kernel, before, after);
            fill(&random, after);
            check(kernel, before, after);
        }
        /* each value alone is seen, and each row that is as the one before */
        float zero[LEAF] = {0}, one[LEAF] = {0};
        for (int i = 0; i < LEAF; i++) {
            one[i] = -0.0f;
            check(kernel, zero, one);
            check(kernel, one, zero);
            one[i] = 0;
        }
    }
    CHECK_OK(swarf_isa_set(at_start));
    return test_end();
}
