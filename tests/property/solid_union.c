/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Solids of several boxes that overlap, touch, lie flush or inside each other, against the closed form: on the grid of
 * all their coordinates a cell is in the union or not, the sides between the two kinds are its surface, and the closest
 * of these rectangles gives the distance, outside and inside. Also turned in space, where flush faces are off each
 * other by rounding. Distances, signs, volume, area, and the level set made of them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shapes.h"
#include "test.h"

enum { MOST_BOXES = 6, MOST_PLANES = 2 * MOST_BOXES + 2 };

typedef struct box_union {
    swarf_box box[MOST_BOXES];
    int count;
    double plane[3][MOST_PLANES]; /* coordinates, with one beyond at either end */
    int planes[3];
    char in[MOST_PLANES][MOST_PLANES][MOST_PLANES]; /* cell i is between planes i and i + 1 */
} box_union;

static int compare_numbers(const void *left, const void *right)
{
    const double l = *(const double *)left, r = *(const double *)right;
    return (l > r) - (l < r);
}

static void make_cells(box_union *u)
{
    for (int k = 0; k < 3; k++) {
        double *p = u->plane[k];
        int count = 0, used = 0;
        p[count++] = -1e3;
        p[count++] = 1e3;
        for (int i = 0; i < u->count; i++) {
            p[count++] = u->box[i].lo[k];
            p[count++] = u->box[i].hi[k];
        }
        qsort(p, (size_t)count, sizeof *p, compare_numbers);
        for (int i = 0; i < count; i++)
            if (i == 0 || p[i] > p[used - 1]) p[used++] = p[i];
        u->planes[k] = used;
    }
    memset(u->in, 0, sizeof u->in);
    for (int x = 0; x + 1 < u->planes[0]; x++)
        for (int y = 0; y + 1 < u->planes[1]; y++)
            for (int z = 0; z + 1 < u->planes[2]; z++)
                for (int i = 0; i < u->count; i++) {
                    const int at[3] = {x, y, z};
                    int inside = 1;
                    for (int k = 0; k < 3; k++)
                        inside &= u->plane[k][at[k]] >= u->box[i].lo[k] && u->plane[k][at[k] + 1] <= u->box[i].hi[k];
                    u->in[x][y][z] |= (char)inside;
                }
}

static int cell_in(const box_union *u, const int at[3])
{
    return u->in[at[0]][at[1]][at[2]];
}

/* Volume, area, and signed distance of a point (0 where it is NULL). */
static double measure(const box_union *u, const double *point, double *volume, double *area)
{
    double best = INFINITY, sign = 1;
    *volume = *area = 0;
    int at[3];
    for (at[0] = 0; at[0] + 1 < u->planes[0]; at[0]++)
        for (at[1] = 0; at[1] + 1 < u->planes[1]; at[1]++)
            for (at[2] = 0; at[2] + 1 < u->planes[2]; at[2]++) {
                double size[3], beyond[3];
                int here = 1;
                for (int k = 0; k < 3; k++) {
                    const double lo = u->plane[k][at[k]], hi = u->plane[k][at[k] + 1];
                    size[k] = hi - lo;
                    beyond[k] = point ? fmax(0, fmax(lo - point[k], point[k] - hi)) : 0;
                    here &= beyond[k] == 0;
                }
                if (cell_in(u, at)) {
                    *volume += size[0] * size[1] * size[2];
                    if (here) sign = -1;
                }
                for (int k = 0; k < 3; k++) { /* the side towards the cell before */
                    if (at[k] == 0) continue;
                    int before[3] = {at[0], at[1], at[2]};
                    before[k]--;
                    if (cell_in(u, at) == cell_in(u, before)) continue;
                    *area += size[(k + 1) % 3] * size[(k + 2) % 3];
                    const double away = point ? point[k] - u->plane[k][at[k]] : 0;
                    best = fmin(best, hypot(away, hypot(beyond[(k + 1) % 3], beyond[(k + 2) % 3])));
                }
            }
    return point ? sign * best : 0;
}

static void turn(const double by[3][3], const double in[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = by[k][0] * in[0] + by[k][1] * in[1] + by[k][2] * in[2];
}

/* A random turn by a quaternion, or none. */
static void random_turn(test_random *random, int turned, double out[3][3])
{
    double q[4] = {1, 0, 0, 0}, square = 0;
    for (int k = 0; k < 4 && turned; k++) q[k] = test_random_in(random, -1, 1);
    for (int k = 0; k < 4; k++) square += q[k] * q[k];
    const double s = 2 / square, w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[3][3] = {{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                            {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                            {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}};
    memcpy(out, m, sizeof m);
}

static void make_shape(const box_union *u, const double by[3][3], shape *s)
{
    for (int i = 0; i < u->count; i++) {
        const size_t first = s->vertices;
        shape_box(s, u->box[i].lo, u->box[i].hi);
        for (size_t v = first; v < s->vertices; v++) {
            double p[3], q[3];
            for (size_t k = 0; k < 3; k++) p[k] = s->xyz[3 * v + k];
            turn(by, p, q);
            for (size_t k = 0; k < 3; k++) s->xyz[3 * v + k] = (float)q[k];
        }
    }
}

/* Coordinates are sixteenths, so that floats hold them. On a coarse grid many faces are flush, and on an uneven one
 * small faces share corners with faces that are sixty times as long. */
static void random_boxes(test_random *random, box_union *u)
{
    static const double uneven_grid[] = {0, 1, 1.5, 30, 60, 61};
    const int coarse = test_random_below(random, 2) != 0, uneven = test_random_below(random, 3) == 0;
    u->count = 1 + (int)test_random_below(random, MOST_BOXES);
    for (int i = 0; i < u->count; i++)
        for (int k = 0; k < 3; k++) {
            if (uneven) {
                const size_t low = (size_t)test_random_below(random, 5);
                u->box[i].lo[k] = uneven_grid[low];
                u->box[i].hi[k] = uneven_grid[low + 1 + (size_t)test_random_below(random, 5 - low)];
                continue;
            }
            const double step = coarse ? 4 : 0.0625;
            const uint64_t steps = coarse ? 8 : 512;
            const double a = step * (double)test_random_below(random, steps);
            const double b = step * (double)test_random_below(random, steps);
            u->box[i].lo[k] = fmin(a, b);
            u->box[i].hi[k] = fmax(a, b) + step;
        }
    make_cells(u);
}

/* A point about the union, half of them near the side of one of its boxes. */
static void random_point(const box_union *u, test_random *random, double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = test_random_in(random, -8, 40);
    if (test_random_below(random, 2)) return;
    const swarf_box *box = &u->box[test_random_below(random, (uint64_t)u->count)];
    for (int k = 0; k < 3; k++) out[k] = test_random_in(random, box->lo[k], box->hi[k]);
    const int k = (int)test_random_below(random, 3);
    const double spread = pow(10, test_random_in(random, -2, 0.5));
    out[k] = (test_random_below(random, 2) ? box->lo[k] : box->hi[k]) + test_random_in(random, -spread, spread);
}

static void check_distances(const box_union *u, const double by[3][3], const swarf_solid *solid, double tolerance,
                            test_random *random, int number)
{
    enum { POINTS = 400 };
    double points[3 * POINTS], exact[POINTS], distance[POINTS], volume, area;
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_point(u, random, p);
        turn(by, p, points + (size_t)3 * (size_t)i);
        exact[i] = measure(u, p, &volume, &area);
    }
    size_t wrong = 0;
    CHECK_OK(swarf_solid_distance(solid, points, POINTS, NULL, distance, NULL));
    for (int i = 0; i < POINTS; i++)
        if (!(fabs(distance[i] - exact[i]) <= tolerance) && wrong++ < 2)
            printf("union %d of %d boxes: (%.9g, %.9g, %.9g) has %.9g, not %.9g\n", number, u->count, points[3 * i],
                   points[3 * i + 1], points[3 * i + 2], distance[i], exact[i]);
    CHECK(wrong == 0);
}

/* `tolerance`: of lengths. */
static void check_facts(const box_union *u, const swarf_solid *solid, double tolerance)
{
    double volume, area;
    const swarf_solid_facts facts = swarf_solid_get_facts(solid);
    measure(u, NULL, &volume, &area);
    CHECK_NEAR(facts.volume_mm3, volume, tolerance * area);
    CHECK_NEAR(facts.area_mm2, area, 400 * tolerance * u->count);
}

/* A ball with a hole inside a box: it bounds nothing, and the area is the box's. */
static void check_open(void)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {100, 100, 100}, centre[3] = {50, 50, 50};
    shape s = {0};
    swarf_solid *solid = NULL;
    shape_box(&s, lo, hi);
    shape_ball(&s, centre, 10, 20);
    swarf_triangles triangles = shape_view(&s);
    triangles.triangle_count--;
    if (CHECK_OK(swarf_solid_create(&triangles, NULL, &solid))) {
        const swarf_solid_facts facts = swarf_solid_get_facts(solid);
        CHECK(facts.open_edges == 3 && facts.triangle_count == 12);
        CHECK_NEAR(facts.area_mm2, 60000, 1e-6);
    }
    swarf_solid_release(solid);
    shape_free(&s);
}

int main(void)
{
    check_open();
    const int rounds = test_size() == TEST_FULL ? 3000 : test_size() == TEST_LIGHT ? 20 : 300;
    test_random random = test_random_begin(11);
    for (int i = 0; i < rounds; i++) {
        box_union u;
        shape s = {0};
        double by[3][3];
        const int turned = i % 2;
        const double tolerance = turned ? 5e-5 : 1e-9; /* floats of up to 106 are off by 4e-6 */
        random_boxes(&random, &u);
        random_turn(&random, turned, by);
        make_shape(&u, (const double(*)[3])by, &s);
        const swarf_triangles triangles = shape_view(&s);
        swarf_solid *solid = NULL;
        if (CHECK_OK(swarf_solid_create(&triangles, NULL, &solid))) {
            check_facts(&u, solid, turned ? 1e-5 : 1e-6);
            check_distances(&u, (const double(*)[3])by, solid, tolerance, &random, i);
        }
        swarf_solid_release(solid);
        shape_free(&s);
    }
    return test_end();
}
