/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The sweep kernels of every instruction set give the scalar reference's bits.
 *
 * Every cutter and motion with one of eight voxel sizes and places in turn, with all of them with SWARF_TEST_FULL=1. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"

enum { RANDOM = 120, MOST = 2000, VARIANTS = 8 };

/* Random points near the sweep and far off, then the places where formulas divide by zero or switch. */
static size_t make_points(const oracle_body *body, const swarf_path *path, double voxel, test_random *random,
                          double (*points)[3])
{
    size_t count = 0;
    for (int i = 0; i < RANDOM; i++) oracle_random_point(body, path, 3 * voxel, random, points[count++]);
    for (int i = 0; i < 20; i++) oracle_random_point(body, path, 1000 * voxel, random, points[count++]);
    for (int i = 0; i < 20; i++) oracle_random_point(body, path, 0, random, points[count++]);
    for (int k = 0; k <= 4; k++) {
        double tip[3];
        oracle_tip(path, 0.25 * k, tip);
        for (int e = 0; e < body->part_begin[body->parts]; e++)
            for (int turn = 0; turn < 8; turn++) {
                const double *node = body->edge[e].to;
                if (count == MOST - 8) break;
                points[count][0] = tip[0] + node[0] * cos(turn * 0.7853981633974483);
                points[count][1] = tip[1] + node[0] * sin(turn * 0.7853981633974483);
                points[count++][2] = tip[2] + node[1];
            }
    }
    const double special[][3] = {{0, 0, 0}, {-0.0, -0.0, -0.0}, {1e-40, -1e-40, 1e-300}, {1e6, -1e6, 1e6}};
    for (size_t i = 0; i < sizeof special / sizeof special[0]; i++)
        memcpy(points[count++], special[i], sizeof special[i]);
    for (int i = 0; i < 3; i++) points[count][i] = path->arc.centre[i];
    return count + 1;
}

/* Move a whole case away from the origin. */
static void shift(swarf_path *path, const double by[3])
{
    for (int i = 0; i < 3; i++) path->start[i] += by[i], path->end[i] += by[i], path->arc.centre[i] += by[i];
}

static long compare(swarf_isa isa, test_random *random)
{
    const int full = test_size() == TEST_FULL;
    static double points[MOST][3];
    static float reference[MOST], value[MOST];
    const double voxels[] = {0.1, 0.02, 0.33, 3.7}, shifts[][3] = {{0, 0, 0}, {812.3, -1503.7, 211.1}};
    long different = 0, compared = 0;
    for (int number = 0; number < CASE_CUTTERS * CASE_MOTIONS; number++) {
        const char *cutter_name, *motion_name;
        int curved;
        swarf_cutter *cutter = case_cutter(number / CASE_MOTIONS, &cutter_name);
        const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
        const int first = full ? 0 : number % VARIANTS, last = full ? VARIANTS - 1 : first;
        for (int variant = first; variant <= last; variant++) {
            swarf_path path = case_motion(number % CASE_MOTIONS, random, &motion_name, &curved);
            shift(&path, shifts[variant / 4]);
            const double voxel = voxels[variant % 4];
            const size_t count = make_points(&body, &path, voxel, random, points);
            CHECK_OK(swarf_isa_set(SWARF_ISA_SCALAR));
            CHECK_OK(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, voxel, points[0], count, reference));
            CHECK_OK(swarf_isa_set(isa));
            CHECK_OK(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, voxel, points[0], count, value));
            for (size_t i = 0; i < count; i++) {
                compared++;
                CHECK(!isnan(reference[i]));
                if (memcmp(&reference[i], &value[i], sizeof value[i]) == 0) continue;
                if (different++ < 10) {
                    printf("%s %s, %s: scalar %.9g, here %.9g: ", swarf_isa_name(isa), cutter_name, motion_name,
                           (double)reference[i], (double)value[i]);
                    oracle_print(stdout, cutter_name, &path, voxel, points[i]);
                }
            }
        }
        swarf_cutter_release(cutter);
    }
    printf("%s: %ld values compared, %ld different\n", swarf_isa_name(isa), compared, different);
    return different;
}

int main(void)
{
    test_random random = test_random_begin(77);
    const swarf_isa at_start = swarf_isa_current();
    for (int isa = SWARF_ISA_AVX2; isa <= SWARF_ISA_AVX512; isa++) {
        if (swarf_isa_set((swarf_isa)isa) == SWARF_OK)
            CHECK(compare((swarf_isa)isa, &random) == 0);
        else
            printf("%s: not here, skipped\n", swarf_isa_name((swarf_isa)isa));
    }
    CHECK_OK(swarf_isa_set(at_start));

    const char *name;
    swarf_cutter *cutter = case_cutter(0, &name);
    swarf_path path = oracle_line(0, 0, 0, 1, 0, 0);
    const double point[3] = {0, 0, 0}, bad[3] = {0, NAN, 0};
    float value = 7;
    CHECK_FAILS(swarf_sweep_distance(NULL, SWARF_PART_FLUTES, &path, 0.1, point, 1, &value), SWARF_ERROR_ARGUMENT,
                NULL);
    CHECK_FAILS(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, NULL, 0.1, point, 1, &value), SWARF_ERROR_ARGUMENT,
                NULL);
    CHECK_FAILS(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, 0.1, NULL, 1, &value), SWARF_ERROR_ARGUMENT,
                NULL);
    CHECK_FAILS(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, 0.1, point, 1, NULL), SWARF_ERROR_ARGUMENT,
                NULL);
    CHECK_FAILS(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, 0, point, 1, &value), SWARF_ERROR_ARGUMENT,
                NULL);
    CHECK_FAILS(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, NAN, point, 1, &value), SWARF_ERROR_ARGUMENT,
                NULL);
    CHECK_FAILS(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, 0.1, bad, 1, &value), SWARF_ERROR_ARGUMENT,
                NULL);
    path.end[1] = INFINITY;
    CHECK_FAILS(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, 0.1, point, 1, &value), SWARF_ERROR_ARGUMENT,
                NULL);
    CHECK(value == 7);
    swarf_cutter_release(cutter);
    return test_end();
}
