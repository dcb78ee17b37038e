/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "test.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static long checks, failures;

int test_check(int ok, const char *file, int line, const char *text)
{
    checks++;
    if (!ok) {
        failures++;
        fprintf(stderr, "%s:%d: failed: %s\n", file, line, text);
    }
    return ok;
}

int test_near(double value, double expected, double tolerance, const char *file, int line, const char *text)
{
    const int ok = fabs(value - expected) <= tolerance;
    checks++;
    if (!ok) {
        failures++;
        fprintf(stderr, "%s:%d: failed: %s is %.9g, expected %.9g within %.3g (off by %.3g)\n", file, line, text, value,
                expected, tolerance, value - expected);
    }
    return ok;
}

int test_status(swarf_status got, swarf_status wanted, const char *part, const char *file, int line, const char *text)
{
    const int named =
        wanted == SWARF_OK || (part ? strstr(swarf_error_last(), part) != NULL : swarf_error_last()[0] != 0);
    const int ok = got == wanted && named;
    checks++;
    if (!ok) {
        failures++;
        fprintf(stderr, "%s:%d: failed: %s gave %s (\"%s\"), expected %s%s%s\n", file, line, text,
                swarf_status_name(got), got == SWARF_OK ? "" : swarf_error_last(), swarf_status_name(wanted),
                part ? " naming " : "", part ? part : "");
    }
    return ok;
}

int test_end(void)
{
    printf("%ld checks, %ld failed\n", checks, failures);
    return failures || !checks ? 1 : 0;
}

test_random test_random_begin(uint64_t fallback)
{
    const char *wanted = getenv("SWARF_SEED");
    test_random random = {wanted ? strtoull(wanted, NULL, 0) : fallback};
    printf("seed %" PRIu64 " (set SWARF_SEED to repeat)\n", random.state);
    return random;
}

static uint64_t next(test_random *random)
{
    uint64_t x = random->state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

double test_random_in(test_random *random, double lo, double hi)
{
    return lo + (hi - lo) * ((double)(next(random) >> 11) * 0x1p-53);
}

uint64_t test_random_below(test_random *random, uint64_t count)
{
    return next(random) % count;
}

static int is_wished(const char *name)
{
    const char *wish = getenv(name);
    return wish && *wish && strcmp(wish, "0") != 0;
}

int test_size(void)
{
    return is_wished("SWARF_TEST_FULL") ? TEST_FULL : is_wished("SWARF_TEST_LIGHT") ? TEST_LIGHT : TEST_USUAL;
}

int test_stop(void *stopper, double fraction)
{
    test_stopper *s = stopper;
    s->fell |= fraction < s->last || fraction < 0 || fraction > 1;
    s->last = fraction;
    return s->calls++ == s->after;
}

int test_same_mesh(const swarf_mesh *a, const swarf_mesh *b)
{
    const swarf_triangles s = swarf_mesh_triangles(a), t = swarf_mesh_triangles(b);
    if (s.vertex_count != t.vertex_count || s.triangle_count != t.triangle_count) return 0;
    if (s.vertex_count == 0) return 1; /* there are no arrays either */
    return memcmp(s.xyz, t.xyz, s.vertex_count * 3 * sizeof *s.xyz) == 0 &&
           memcmp(s.index, t.index, s.triangle_count * 3 * sizeof *s.index) == 0;
}

const char *test_source(void)
{
    return SWARF_SOURCE_DIR;
}

const char *test_shared(void)
{
    static char path[1024];
    const char *wanted = getenv("SWARF_SHARED");
    snprintf(path, sizeof path, "%s", wanted ? wanted : SWARF_SOURCE_DIR "/../shared");
    if (access(path, R_OK) != 0) path[0] = 0;
    return path;
}
