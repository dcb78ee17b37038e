/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Signed distances to solids at random points against an exact reference: each shape is made of convex bodies, so that
 * being inside one is being behind all its triangles, and inside the solid is to be in more bodies than hollows.
 *
 * 20,000 points for each shape, 1,000,000 with SWARF_TEST_FULL=1. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shapes.h"
#include "test.h"

enum { MOST_BODIES = 8 };

typedef struct compound {
    const char *name;
    shape shape;
    size_t end[MOST_BODIES]; /* of each body's triangles */
    int hollow[MOST_BODIES];
    int bodies;
    int apart;    /* bodies that neither cross nor touch: distances are known inside too */
    double error; /* mm: corners of what is cut are rounded to float */
} compound;

static void end_body(compound *c, int hollow)
{
    const size_t first = c->bodies ? c->end[c->bodies - 1] : 0;
    if (hollow) shape_flip(&c->shape, first);
    c->hollow[c->bodies] = hollow;
    c->end[c->bodies++] = c->shape.triangles;
}

static void add_box(compound *c, double x0, double y0, double z0, double x1, double y1, double z1, int hollow)
{
    const double lo[3] = {x0, y0, z0}, hi[3] = {x1, y1, z1};
    shape_box(&c->shape, lo, hi);
    end_body(c, hollow);
}

static void add_tetrahedron(compound *c, const double p[4][3])
{
    static const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const size_t first = c->shape.vertices, triangle = c->shape.triangles;
    double u[3][3];
    for (int i = 0; i < 4; i++) shape_vertex(&c->shape, p[i][0], p[i][1], p[i][2]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) u[i][k] = p[i + 1][k] - p[0][k];
    const double volume = u[0][0] * (u[1][1] * u[2][2] - u[1][2] * u[2][1]) +
                          u[0][1] * (u[1][2] * u[2][0] - u[1][0] * u[2][2]) +
                          u[0][2] * (u[1][0] * u[2][1] - u[1][1] * u[2][0]);
    for (int i = 0; i < 4; i++)
        shape_triangle(&c->shape, first + (size_t)faces[i][0], first + (size_t)faces[i][1],
                       first + (size_t)faces[i][2]);
    if (volume < 0) shape_flip(&c->shape, triangle);
    end_body(c, 0);
}

static void corners_of(const compound *c, size_t triangle, double p[3][3])
{
    for (size_t i = 0; i < 3; i++)
        for (size_t k = 0; k < 3; k++) p[i][k] = c->shape.xyz[3 * (size_t)c->shape.index[3 * triangle + i] + k];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normal_of(const double p[3][3], double out[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = p[1][k] - p[0][k];
        v[k] = p[2][k] - p[0][k];
    }
    for (int k = 0; k < 3; k++) out[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    const double length = sqrt(dot(out, out));
    for (int k = 0; k < 3; k++) out[k] /= length;
}

/* -1 inside, 1 outside, 0 too near a plane of a triangle to tell by. */
static int exact_sign(const compound *c, const double point[3])
{
    int number = 0;
    size_t triangle = 0;
    for (int body = 0; body < c->bodies; body++) {
        double most = -INFINITY;
        for (; triangle < c->end[body]; triangle++) {
            double p[3][3], n[3], to[3];
            corners_of(c, triangle, p);
            normal_of((const double(*)[3])p, n);
            for (int k = 0; k < 3; k++) to[k] = point[k] - p[0][k];
            const double side = dot(n, to) * (c->hollow[body] ? -1 : 1);
            most = fmax(most, side);
        }
        if (fabs(most) < 1e-5) return 0;
        if (most < 0) number += c->hollow[body] ? -1 : 1;
    }
    return number > 0 ? -1 : 1;
}

static double segment_distance(const double a[3], const double b[3], const double point[3])
{
    double ab[3], ap[3], rest[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = b[k] - a[k];
        ap[k] = point[k] - a[k];
    }
    const double t = fmin(1, fmax(0, dot(ap, ab) / dot(ab, ab)));
    for (int k = 0; k < 3; k++) rest[k] = ap[k] - t * ab[k];
    return sqrt(dot(rest, rest));
}

/* By the plane where the foot is on the inner side of all edges, else by the edges. */
static double exact_distance(const compound *c, const double point[3])
{
    double best = INFINITY;
    for (size_t triangle = 0; triangle < c->shape.triangles; triangle++) {
        double p[3][3], n[3], to[3];
        corners_of(c, triangle, p);
        normal_of((const double(*)[3])p, n);
        int within = 1;
        for (int i = 0; i < 3; i++) {
            double edge[3], across[3];
            for (int k = 0; k < 3; k++) {
                edge[k] = p[(i + 1) % 3][k] - p[i][k];
                to[k] = point[k] - p[i][k];
            }
            for (int k = 0; k < 3; k++)
                across[k] = n[(k + 1) % 3] * edge[(k + 2) % 3] - n[(k + 2) % 3] * edge[(k + 1) % 3];
            within &= dot(across, to) >= 0;
            best = fmin(best, segment_distance(p[i], p[(i + 1) % 3], point));
        }
        if (within) best = fmin(best, fabs(dot(n, to)));
    }
    return best;
}

/* Half of the points anywhere about the shape, the others near its surface. */
static void random_point(const compound *c, const swarf_box *box, test_random *random, double out[3])
{
    if (test_random_below(random, 2)) {
        for (int k = 0; k < 3; k++) {
            const double margin = 0.3 * (box->hi[k] - box->lo[k]) + 1;
            out[k] = test_random_in(random, box->lo[k] - margin, box->hi[k] + margin);
        }
        return;
    }
    double p[3][3];
    corners_of(c, test_random_below(random, c->shape.triangles), p);
    double a = test_random_in(random, 0, 1), b = test_random_in(random, 0, 1);
    if (test_random_below(random, 4) == 0) a = 0; /* on an edge */
    if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
    }
    const double spread = pow(10, test_random_in(random, -4, 0.5));
    for (int k = 0; k < 3; k++)
        out[k] = p[0][k] + a * (p[1][k] - p[0][k]) + b * (p[2][k] - p[0][k]) + test_random_in(random, -spread, spread);
}

/* Half of the points come in walks of small steps: looks near each other keep what they saw. */
static void random_points(const compound *c, const swarf_box *box, test_random *random, size_t count, double *out)
{
    enum { WALK = 32 };
    for (size_t i = 0; i < count; i++) {
        if (i % (2 * WALK) == 0 || i % (2 * WALK) >= WALK) {
            random_point(c, box, random, out + 3 * i);
            continue;
        }
        for (size_t k = 0; k < 3; k++) out[3 * i + k] = out[3 * (i - 1) + k] + test_random_in(random, -0.2, 0.2);
    }
}

static void check(compound *c, test_random *random)
{
    const size_t count = test_size() == TEST_FULL ? 1000000 : 20000;
    const swarf_triangles triangles = shape_view(&c->shape);
    swarf_solid *solid = NULL;
    if (!CHECK_OK(swarf_solid_create(&triangles, NULL, &solid))) return;
    const swarf_solid_facts facts = swarf_solid_get_facts(solid);
    double *points = malloc(3 * count * sizeof *points), *distance = malloc(count * sizeof *distance);
    uint32_t *nearest = malloc(count * sizeof *nearest);
    if (!points || !distance || !nearest) exit(2);
    random_points(c, &facts.box, random, count, points);
    size_t wrong_signs = 0, wrong_distances = 0, told = 0;
    if (CHECK_OK(swarf_solid_distance(solid, points, count, NULL, distance, nearest)))
        for (size_t i = 0; i < count; i++) {
            const int sign = exact_sign(c, points + 3 * i);
            if (sign == 0) continue;
            told++;
            if (sign != (distance[i] < 0 ? -1 : 1) && wrong_signs++ < 3)
                printf("%s: (%.9g, %.9g, %.9g) is %s but has %.9g\n", c->name, points[3 * i], points[3 * i + 1],
                       points[3 * i + 2], sign < 0 ? "inside" : "outside", distance[i]);
            CHECK(nearest[i] < c->shape.triangles);
            if (i % 16 || (sign < 0 && !c->apart)) continue;
            const double exact = exact_distance(c, points + 3 * i);
            if (!(fabs(fabs(distance[i]) - exact) < c->error + 1e-9 * (1 + exact)) && wrong_distances++ < 3)
                printf("%s: (%.9g, %.9g, %.9g) is %.9g away but has %.9g\n", c->name, points[3 * i], points[3 * i + 1],
                       points[3 * i + 2], exact, distance[i]);
        }
    CHECK(wrong_signs == 0);
    CHECK(wrong_distances == 0);
    CHECK(told > count / 2);
    printf("%s: %zu of %zu points, %zu triangles, %zu of them crossing\n", c->name, told, count, facts.triangle_count,
           facts.crossing_triangles);
    free(points);
    free(distance);
    free(nearest);
    swarf_solid_release(solid);
    shape_free(&c->shape);
}

int main(void)
{
    test_random random = test_random_begin(7);
    compound box = {.name = "box", .apart = 1};
    add_box(&box, -3, 2, 1, 17, 14, 9, 0);
    check(&box, &random);

    compound plate = {.name = "thin plate", .apart = 1};
    add_box(&plate, 0, 0, 0, 20, 20, 0.015625, 0);
    check(&plate, &random);

    /* an edge of a tenth of a degree, and needles for corners */
    compound wedge = {.name = "wedge", .apart = 1};
    const double knife[4][3] = {{0, 0, 0}, {20, 0, 0}, {10, 15, 0.0234375}, {10, 15, -0.0078125}};
    add_tetrahedron(&wedge, knife);
    check(&wedge, &random);

    /* five boxes with faces in common, none of the same size: a pocket with a floor of a hundredth */
    compound pocket = {.name = "touching faces"};
    add_box(&pocket, 0, 0, 0, 20, 20, 0.01171875, 0);
    add_box(&pocket, 0, 0, 0.01171875, 4, 20, 5, 0);
    add_box(&pocket, 16, 0, 0.01171875, 20, 20, 5, 0);
    add_box(&pocket, 4, 0, 0.01171875, 16, 3, 5, 0);
    add_box(&pocket, 4, 17, 0.01171875, 16, 20, 5, 0);
    check(&pocket, &random);

    compound edge = {.name = "common edge", .apart = 1};
    add_box(&edge, 0, 0, 0, 10, 10, 10, 0);
    add_box(&edge, 10, 10, 0, 20, 20, 10, 0);
    check(&edge, &random);

    compound corner = {.name = "common corner", .apart = 1};
    add_box(&corner, 0, 0, 0, 10, 10, 10, 0);
    add_box(&corner, 10, 10, 10, 15, 15, 15, 0);
    check(&corner, &random);

    compound hollow = {.name = "hollows", .apart = 1};
    add_box(&hollow, 0, 0, 0, 20, 20, 20, 0);
    add_box(&hollow, 4, 4, 4, 16, 16, 19.984375, 1);
    add_box(&hollow, 7, 7, 7, 13, 13, 13, 0);
    check(&hollow, &random);

    compound crossing = {.name = "crossing boxes"};
    add_box(&crossing, 0, 0, 0, 10, 10, 10, 0);
    add_box(&crossing, 5, 5, 5, 15, 15, 15, 0);
    add_box(&crossing, 2, 2, 2, 3, 3, 3, 0); /* and one inside */
    check(&crossing, &random);

    /* the edge from a common corner lies in the top of the box, inside the tetrahedron on one side of it, and ends
     * beyond the box, in it, or in a side of it */
    static const double ends[3][3] = {{20, 10, 0}, {6, 3, 0}, {10, 5, 0}};
    for (int i = 0; i < 3; i++) {
        compound flat = {.name = "edge in a face", .error = 1e-6};
        add_box(&flat, 0, 0, -10, 10, 10, 0, 0);
        const double over[4][3] = {{0, 0, 0}, {ends[i][0], ends[i][1], ends[i][2]}, {4, 8, 4}, {4, 8, -4}};
        add_tetrahedron(&flat, over);
        check(&flat, &random);
    }

    compound star = {.name = "star"};
    const double one[4][3] = {{10, 10, 10}, {10, -10, -10}, {-10, 10, -10}, {-10, -10, 10}};
    const double two[4][3] = {{-10, -10, -10}, {-10, 10, 10}, {10, -10, 10}, {10, 10, -10}};
    add_tetrahedron(&star, one);
    add_tetrahedron(&star, two);
    check(&star, &random);

    compound prism = {.name = "prism", .apart = 1};
    const double base[3] = {1, 2, 3};
    shape_cylinder(&prism.shape, base, 8, 10, 48);
    end_body(&prism, 0);
    check(&prism, &random);

    compound ball = {.name = "ball", .apart = 1};
    shape_ball(&ball.shape, base, 8, 24);
    end_body(&ball, 0);
    check(&ball, &random);
    return test_end();
}
