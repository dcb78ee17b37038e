/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A few words to write tests with: a test program is main() made of CHECKs, ending in `return test_end();`. */
#ifndef SWARF_TEST_H
#define SWARF_TEST_H

#include <stdint.h>
#include <stdio.h>

#include "swarf/swarf.h"

/** Count a check; print place and values when it fails; the test goes on. */
#define CHECK(condition) test_check((condition) ? 1 : 0, __FILE__, __LINE__, #condition)
/** Both sides within `tolerance` of each other (NAN fails). */
#define CHECK_NEAR(value, expected, tolerance) test_near((value), (expected), (tolerance), __FILE__, __LINE__, #value)
/** The call succeeds; prints the error text when not. */
#define CHECK_OK(call) test_status((call), SWARF_OK, NULL, __FILE__, __LINE__, #call)
/** The call fails with this status and its text contains `part` (NULL: any non-empty text). */
#define CHECK_FAILS(call, status, part) test_status((call), (status), (part), __FILE__, __LINE__, #call)

int test_check(int ok, const char *file, int line, const char *text);
int test_near(double value, double expected, double tolerance, const char *file, int line, const char *text);
int test_status(swarf_status got, swarf_status wanted, const char *part, const char *file, int line, const char *text);

/** Print the number of checks and failures; the exit status of main(). No check at all is a failure. */
int test_end(void);

/** Seeded generator (splitmix64). The seed is SWARF_SEED or `fallback`, printed once. */
typedef struct test_random {
    uint64_t state;
} test_random;
test_random test_random_begin(uint64_t fallback);
/** Uniform in lo .. hi. */
double test_random_in(test_random *random, double lo, double hi);
/** Uniform whole number below `count`. */
uint64_t test_random_below(test_random *random, uint64_t count);

/** How much is tried: with SWARF_TEST_FULL=1 all that a promise names, with SWARF_TEST_LIGHT=1 (the sanitizers) enough
 *  to walk every way of the code, else something between. All may take longer than the 25 minutes that a test has:
 *  tests/run --timeout 100000. */
enum { TEST_LIGHT, TEST_USUAL, TEST_FULL };
int test_size(void);

/** A progress callback's `user`: stops after some reports, and looks whether fractions ever fall or leave 0 .. 1. */
typedef struct test_stopper {
    long calls; /* reports so far */
    long after; /* stops at the report that comes after so many; negative: never */
    double last;
    int fell;
} test_stopper;
int test_stop(void *stopper, double fraction);

/** Whether two meshes are the same to the bit. */
int test_same_mesh(const swarf_mesh *a, const swarf_mesh *b);

/** Folder of the source tree. */
const char *test_source(void);

/** Folder of the shared benchmark data ("" when absent): $SWARF_SHARED or ../shared beside the checkout. */
const char *test_shared(void);

#endif
