/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sign and first-order value of swarf_sweep_distance() against the oracle, for every cutter and motion.
 *
 * 2,000 points for each pair, 100,000 with SWARF_TEST_FULL=1, any number of thousands with SWARF_TEST_POINTS=1000.
 * Arguments: number of a cutter, number of a motion (all without). Cases are independent and shared out to threads.
 */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"

enum { CHUNK = 1000, PRINTED = 3, VALUES = 20 };

/* No sign may differ farther from the surface than this, in voxels. */
static const double exact_bound = 1e-4;
/* The field's promise for surface points on smooth parts, in voxels. Values are right to first order, so it is asked of
 * points this near; the error of second order is up to 0.11 at 0.43 voxels (beside a rim on an arc). The crossings of
 * the stock's own grid are tested in unit/volume.c. */
static const double value_bound = 0.05, value_reach = 0.25;

typedef struct result {
    long points, undecided, wrong, values, off;
    double worst_value;
    double worst_sign;
    char text[2 * PRINTED][900];
    int texts;
    const char *error;
} result;

static size_t points_per_case;
static uint64_t seed;
static int only_cutter = -1, only_motion = -1;
static atomic_int next_case;
static result results[CASE_CUTTERS * CASE_MOTIONS];

static void note(result *r, int most, const char *what, double value, double wanted, const char *cutter,
                 const swarf_path *path, double voxel, const double point[3])
{
    if (r->texts >= most) return;
    char *text = r->text[r->texts++];
    FILE *stream = fmemopen(text, sizeof r->text[0], "w");
    fprintf(stream, "%s: got %.9g, oracle %.9g mm: ", what, value, wanted);
    oracle_print(stream, cutter, path, voxel, point);
    fclose(stream);
}

/* Hollow arcs of a profile are followed by chords, so that no motion of theirs is exact. */
static int is_hollow(const swarf_cutter *cutter)
{
    swarf_cutter_part part;
    for (size_t i = 0; i < swarf_cutter_part_count(cutter) && swarf_cutter_part_get(cutter, i, &part) == SWARF_OK; i++)
        for (size_t k = 0; k < part.node_count; k++)
            if (part.nodes[k].bulge < 0) return 1;
    return 0;
}

static void run_case(int number, result *r)
{
    const char *cutter_name, *motion_name;
    int curved;
    test_random random = {seed + 1000003u * (uint64_t)number};
    swarf_cutter *cutter = case_cutter(number / CASE_MOTIONS, &cutter_name);
    const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
    const int hollow = is_hollow(cutter);
    const double voxels[] = {0.1, 0.05, 0.2};
    double point[CHUNK][3];
    float value[CHUNK];
    for (size_t chunk = 0; chunk * CHUNK < points_per_case; chunk++) {
        const swarf_path path = case_motion(number % CASE_MOTIONS, &random, &motion_name, &curved);
        const double voxel = voxels[chunk % 3];
        const double bound = (curved || hollow ? SWARF_SWEEP_BOUND : exact_bound) * voxel;
        for (int i = 0; i < CHUNK; i++) oracle_random_point(&body, &path, 3 * voxel, &random, point[i]);
        if (swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, voxel, point[0], CHUNK, value) != SWARF_OK) {
            r->error = "swarf_sweep_distance failed";
            break;
        }
        for (int i = 0; i < CHUNK; i++) {
            const int sign = oracle_sign(&body, &path, point[i], bound);
            r->points++;
            r->undecided += sign == 0;
            if (sign == 0 || (sign < 0 ? value[i] < 0 : value[i] > 0)) continue;
            const double wanted = oracle_distance(&body, &path, point[i]);
            if (fabs(wanted) / voxel > r->worst_sign || isnan(value[i])) r->worst_sign = fabs(wanted) / voxel;
            r->wrong++;
            note(r, PRINTED, "wrong sign", (double)value[i], wanted, cutter_name, &path, voxel, point[i]);
        }
        for (int i = 0; i < CHUNK && r->values < VALUES * (long)(chunk + 1); i++) {
            if (fabs((double)value[i]) > value_reach * voxel) continue;
            const double wanted = oracle_distance(&body, &path, point[i]);
            if (wanted < 0 || wanted > value_reach * voxel || !oracle_is_smooth(&body, &path, point[i], wanted, voxel))
                continue;
            const double error = fabs((double)value[i] - wanted) / voxel;
            r->values++;
            r->worst_value = fmax(r->worst_value, error);
            if (error <= value_bound + (curved || hollow ? SWARF_SWEEP_BOUND : 0))
                continue; /* chords have that bound */
            r->off++;
            note(r, 2 * PRINTED, "value off", (double)value[i], wanted, cutter_name, &path, voxel, point[i]);
        }
    }
    swarf_cutter_release(cutter);
}

static void *work(void *unused)
{
    (void)unused;
    for (;;) {
        const int number = atomic_fetch_add(&next_case, 1);
        if (number >= CASE_CUTTERS * CASE_MOTIONS) return NULL;
        if (only_cutter >= 0 && number / CASE_MOTIONS != only_cutter) continue;
        if (only_motion >= 0 && number % CASE_MOTIONS != only_motion) continue;
        run_case(number, &results[number]);
    }
}

int main(int count, char **argument)
{
    const char *full = getenv("SWARF_TEST_FULL");
    points_per_case = full && strcmp(full, "0") != 0 ? 100000 : 2000;
    if (getenv("SWARF_TEST_POINTS")) points_per_case = (strtoul(getenv("SWARF_TEST_POINTS"), NULL, 10) / 1000) * 1000;
    seed = test_random_begin(20240611).state;
    if (count > 1) only_cutter = atoi(argument[1]);
    if (count > 2) only_motion = atoi(argument[2]);
    pthread_t thread[2];
    for (int i = 0; i < 2; i++)
        if (pthread_create(&thread[i], NULL, work, NULL) != 0) return 2;
    for (int i = 0; i < 2; i++) pthread_join(thread[i], NULL);

    long points = 0, undecided = 0;
    for (int number = 0; number < CASE_CUTTERS * CASE_MOTIONS; number++) {
        const result *r = &results[number];
        if (!r->points && !r->error) continue;
        const char *cutter_name, *motion_name;
        int curved;
        test_random random = {1};
        swarf_cutter_release(case_cutter(number / CASE_MOTIONS, &cutter_name));
        case_motion(number % CASE_MOTIONS, &random, &motion_name, &curved);
        points += r->points;
        undecided += r->undecided;
        const int good = CHECK(!r->error) & CHECK(r->points == (long)points_per_case) & CHECK(r->wrong == 0) &
                         CHECK(r->off == 0) & CHECK(r->undecided <= r->points / (curved ? 20 : 200));
        if (!good)
            printf(
                "[%d %d] %s, %s: %ld of %ld signs wrong (worst at %.3g voxels), %ld undecided, %ld of %ld values off "
                "(worst %.3g voxels)\n",
                number / CASE_MOTIONS, number % CASE_MOTIONS, cutter_name, motion_name, r->wrong, r->points,
                r->worst_sign, r->undecided, r->off, r->values, r->worst_value);
        for (int i = 0; i < r->texts; i++) printf("    %s", r->text[i]);
    }
    printf("%ld points, %ld too near the surface to decide\n", points, undecided);
    return test_end();
}
