/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Deviations of the pixels of a picture of the design, told by a stock: they are right, or all stay as they were. */
#include <math.h>
#include <stdlib.h>

#include "test.h"

enum { COUNT = 20000, LAST = COUNT - 1 };

static double position[3 * COUNT], value[COUNT];
static uint8_t seen[COUNT];

/* A caller that stops at a share of the work, or comes back into the stock between there and the end. */
typedef struct caller {
    double limit;
    swarf_stock *stock; /* NULL: stops */
    int calls;
} caller;

static int answer(void *user, double fraction)
{
    caller *c = user;
    if (fraction <= c->limit) return 0;
    if (!c->stock) return 1;
    if (fraction >= 1) return 0;
    c->calls++;
    double other[COUNT];
    other[0] = other[LAST] = 7;
    CHECK_FAILS(swarf_deviation_design_pixels(c->stock, position, seen, COUNT, 0, NULL, other), SWARF_ERROR_BUSY, NULL);
    CHECK(other[0] == 7 && other[LAST] == 7);
    return 0;
}

static void check_untouched(void)
{
    for (int i = 0; i < COUNT; i++)
        if (value[i] != 7) {
            CHECK(value[i] == 7);
            return;
        }
}

int main(void)
{
    const swarf_box box = {{0, 0, -5}, {20, 20, 0}};
    swarf_stock_options options = swarf_stock_options_default();
    swarf_stock *stock = NULL;
    options.voxel_mm = 0.25;
    if (!CHECK_OK(swarf_stock_create_box(&box, &options, &stock))) return test_end();
    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_OK(swarf_threads_set(1)); /* of several, others than the reporting one may do all that is left */

    /* Above and below the top face, up to 1.2 mm: the field is exact to 0.5 and ends at 0.75, between two voxels. */
    test_random random = test_random_begin(5);
    for (int i = 0; i < COUNT; i++) {
        position[3 * i] = test_random_in(&random, 2, 18);
        position[3 * i + 1] = test_random_in(&random, 2, 18);
        position[3 * i + 2] = test_random_in(&random, -1.2, 1.2);
        seen[i] = i % 3 ? SWARF_SEEN_STOCK : SWARF_SEEN_FLUTES;
        value[i] = 7;
    }

    for (int part = 0; part < 2; part++) {
        caller stops = {.limit = 0.6 * part};
        const swarf_progress progress = {answer, &stops};
        CHECK_FAILS(swarf_deviation_design_pixels(stock, position, seen, COUNT, 0.1, &progress, value),
                    SWARF_ERROR_CANCELLED, NULL);
        check_untouched();
    }
    const double height = position[3 * LAST + 2];
    position[3 * LAST + 2] = NAN;
    CHECK_FAILS(swarf_deviation_design_pixels(stock, position, seen, COUNT, 0.1, NULL, value), SWARF_ERROR_ARGUMENT,
                "finite");
    check_untouched();
    position[3 * LAST + 2] = height;

    caller comes_back = {.limit = 0.5, .stock = stock};
    const swarf_progress progress = {answer, &comes_back};
    CHECK_OK(swarf_deviation_design_pixels(stock, position, seen, COUNT, 0.1, &progress, value));
    CHECK(comes_back.calls > 0);
    for (int i = 0; i < COUNT; i++) {
        const double left = -position[3 * i + 2];
        if (seen[i] != SWARF_SEEN_STOCK)
            CHECK(isnan(value[i]));
        else if (fabs(left) < 0.5)
            CHECK_NEAR(value[i], left - 0.1, 0.0025);
        else if (fabs(left) > 1)
            CHECK(isinf(value[i]) && signbit(value[i]) == signbit(left));
    }
    swarf_stock_destroy(stock);
    return test_end();
}
