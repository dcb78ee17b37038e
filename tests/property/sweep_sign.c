/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Signs of swarf_sweep_distance(), and where it puts the surface, against the oracle, for every cutter and motion.
 *
 * 1,000 points for each pair, 100,000 with SWARF_TEST_FULL=1.
 * Arguments: number of a cutter, number of a motion (all without). Cases are independent and shared out to threads.
 */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"

/* CROSSINGS of each chunk at most, FEW of a single chunk (for the sanitizers), MOST of a case: the oracle takes
 * milliseconds for each. */
enum { CHUNK = 1000, PRINTED = 3, CROSSINGS = 20, FEW_CROSSINGS = 3, MOST_CROSSINGS = 120 };

/* No sign may differ farther from the surface than this, in voxels. */
static const double exact_bound = 1e-4;
/* The field's promise for surface points on smooth parts, in voxels: where the values at two neighbours of a grid have
 * opposite signs, their linear crossing lies this near to the sweep. */
static const double crossing_bound = 0.05, ridge_bound = 0.025;

typedef struct result {
    long points, undecided, wrong, crossings, ridges, off;
    double worst_crossing;
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

/* What is swept. */
typedef struct sweeping {
    const swarf_cutter *cutter;
    const char *name;
    const oracle_body *body;
    const swarf_path *path;
    double voxel;
} sweeping;

static void note(result *r, int most, const char *what, double value, double wanted, const sweeping *s,
                 const double point[3])
{
    if (r->texts >= most) return;
    char *text = r->text[r->texts++];
    FILE *stream = fmemopen(text, sizeof r->text[0], "w");
    fprintf(stream, "%s: got %.9g, oracle %.9g mm: ", what, value, wanted);
    oracle_print(stream, s->name, s->path, s->voxel, point);
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

/* A grid edge of random direction and phase at the point: where its ends straddle the surface, at a smooth place, their
 * crossing is checked. `bound` is in voxels. Where two positions of the tool that are both nearest lie far apart within
 * the edge (a ridge close under the surface), a field of samples has a bend that no crossing can see: a place counts
 * when the exact distances themselves cross near the surface. */
static void check_crossing(const sweeping *s, double bound, test_random *random, const double point[3], result *r)
{
    const oracle_body *body = s->body;
    const swarf_path *path = s->path;
    const double voxel = s->voxel;
    const int axis = (int)test_random_below(random, 3);
    const double phase = test_random_in(random, 0, 1);
    double ends[2][3], at[3];
    float value[2];
    memcpy(ends[0], point, sizeof ends[0]);
    memcpy(ends[1], point, sizeof ends[1]);
    memcpy(at, point, sizeof at);
    ends[0][axis] -= phase * voxel;
    ends[1][axis] += (1 - phase) * voxel;
    if (swarf_sweep_distance(s->cutter, SWARF_PART_FLUTES, path, voxel, ends[0], 2, value) != SWARF_OK) {
        r->error = "swarf_sweep_distance failed";
        return;
    }
    if ((value[0] < 0) == (value[1] < 0)) return;
    at[axis] = ends[0][axis] + voxel * (double)(value[0] / (value[0] - value[1]));
    const double off = oracle_distance(body, path, at);
    if (!oracle_is_smooth(body, path, at, off, voxel)) return;
    if (fabs(off) > bound * voxel) {
        const double exact[2] = {oracle_distance(body, path, ends[0]), oracle_distance(body, path, ends[1])};
        double there[3] = {at[0], at[1], at[2]};
        there[axis] = ends[0][axis] + voxel * exact[0] / (exact[0] - exact[1]);
        if ((exact[0] < 0) == (exact[1] < 0) || fabs(oracle_distance(body, path, there)) > ridge_bound * voxel) {
            r->ridges++;
            return;
        }
    }
    r->crossings++;
    r->worst_crossing = fmax(r->worst_crossing, fabs(off) / voxel);
    if (fabs(off) <= bound * voxel) return;
    r->off++;
    note(r, 2 * PRINTED, "crossing off", 0, off, s, at);
}

static void run_case(int number, result *r)
{
    const char *cutter_name, *motion_name;
    int curved;
    test_random random = {seed + 1000003u * (uint64_t)number};
    swarf_cutter *cutter = case_cutter(number / CASE_MOTIONS, &cutter_name);
    const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
    const int hollow = is_hollow(cutter);
    const long each = points_per_case > CHUNK ? CROSSINGS : FEW_CROSSINGS;
    const double voxels[] = {0.1, 0.05, 0.2};
    double point[CHUNK][3];
    float value[CHUNK];
    for (size_t chunk = 0; chunk * CHUNK < points_per_case; chunk++) {
        const swarf_path path = case_motion(number % CASE_MOTIONS, &random, &motion_name, &curved);
        const double voxel = voxels[chunk % 3];
        const sweeping swept = {cutter, cutter_name, &body, &path, voxel};
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
            note(r, PRINTED, "wrong sign", (double)value[i], wanted, &swept, point[i]);
        }
        for (int i = 0; i < CHUNK && r->crossings < each * (long)(chunk + 1) && r->crossings < MOST_CROSSINGS; i++)
            check_crossing(&swept, curved || hollow ? crossing_bound + SWARF_SWEEP_BOUND : crossing_bound, &random,
                           point[i], r);
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
    points_per_case = test_size() == TEST_FULL ? 100000 : 1000;
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
                         CHECK(r->off == 0) & CHECK(r->crossings > 0) & CHECK(r->ridges <= 1 + r->crossings / 100) &
                         CHECK(r->undecided <= 5 + r->points / (curved ? 20 : 200));
        if (!good)
            printf("[%d %d] %s, %s: %ld of %ld signs wrong (worst at %.3g voxels), %ld undecided, %ld of %ld crossings "
                   "off (worst %.3g voxels)\n",
                   number / CASE_MOTIONS, number % CASE_MOTIONS, cutter_name, motion_name, r->wrong, r->points,
                   r->worst_sign, r->undecided, r->off, r->crossings, r->worst_crossing);
        for (int i = 0; i < r->texts; i++) printf("    %s", r->text[i]);
    }
    printf("%ld points, %ld too near the surface to decide\n", points, undecided);
    return test_end();
}
