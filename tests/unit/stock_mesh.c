/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stocks from triangles: volumes in closed form, hollows, shells that cut or touch each other, and what is refused. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shapes.h"
#include "test.h"

static const double pi = 3.14159265358979323846;

static swarf_stock *make(const shape *s, double voxel)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    const swarf_triangles triangles = shape_view(s);
    swarf_stock *stock = NULL;
    CHECK_OK(swarf_stock_create_mesh(&triangles, &options, NULL, &stock));
    return stock;
}

static double volume_of(const shape *s, double voxel)
{
    swarf_stock *stock = make(s, voxel);
    double volume = NAN;
    if (stock) CHECK_OK(swarf_stock_volume(stock, &volume));
    swarf_stock_destroy(stock);
    return volume;
}

static double mesh_volume(const shape *s)
{
    const swarf_triangles triangles = shape_view(s);
    swarf_topology topology;
    return CHECK_OK(swarf_triangles_topology(&triangles, &topology)) ? topology.volume_mm3 : NAN;
}

static void check_box(void)
{
    const double lo[3] = {-3, 2, 1}, hi[3] = {17, 14, 9}, exact = 20 * 12 * 8;
    shape box = {0};
    shape_box(&box, lo, hi);
    CHECK_NEAR(volume_of(&box, 0.1), exact, 1e-4 * exact);
    CHECK_NEAR(volume_of(&box, 0.0973), exact, 1e-4 * exact); /* faces between the voxels */
    shape_unshare(&box);

    /* known for the block that it is, to the last bit */
    swarf_stock *mesh = make(&box, 0.25), *block = NULL;
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.25;
    const swarf_box bounds = {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
    if (CHECK_OK(swarf_stock_create_box(&bounds, &options, &block)) && mesh) {
        uint64_t ours = 0, theirs = 1;
        CHECK_OK(swarf_stock_hash(mesh, &ours));
        CHECK_OK(swarf_stock_hash(block, &theirs));
        CHECK(ours == theirs);
    }
    swarf_stock_destroy(mesh);

    /* with a hollow it is none, and takes the general way: same frame, same faces */
    const double hollow_lo[3] = {-1, 4, 3}, hollow_hi[3] = {15, 12, 7};
    shape_box(&box, hollow_lo, hollow_hi);
    shape_flip(&box, 12);
    mesh = make(&box, 0.25);
    if (mesh && block) {
        test_random random = test_random_begin(1);
        for (int i = 0; i < 2000; i++) {
            double point[3];
            float ours, theirs;
            for (int k = 0; k < 3; k++) point[k] = test_random_in(&random, lo[k] - 1, hi[k] + 1);
            CHECK_OK(swarf_stock_sample(mesh, point, 1, &ours));
            CHECK_OK(swarf_stock_sample(block, point, 1, &theirs));
            if (fabsf(theirs) < 0.5f) CHECK_NEAR(ours, theirs, 0.02);
        }
        double volume;
        if (CHECK_OK(swarf_stock_volume(mesh, &volume))) CHECK_NEAR(volume, exact - 16 * 8 * 4, 1e-4 * exact);
    }
    swarf_stock_destroy(mesh);
    swarf_stock_destroy(block);
    shape_free(&box);
}

static void check_round(void)
{
    const double base[3] = {1, 2, 3};
    shape cylinder = {0}, ball = {0};
    shape_cylinder(&cylinder, base, 8, 10, 512);
    CHECK_NEAR(mesh_volume(&cylinder), 256 * sin(2 * pi / 512) * 64 * 10, 1e-3);
    CHECK_NEAR(volume_of(&cylinder, 0.12), mesh_volume(&cylinder), 1e-4 * mesh_volume(&cylinder));
    shape_ball(&ball, base, 8, 100);
    CHECK_NEAR(volume_of(&ball, 0.12), mesh_volume(&ball), 1e-4 * mesh_volume(&ball));
    shape_free(&cylinder);
    shape_free(&ball);
}

static void check_tetrahedra(void)
{
    test_random random = test_random_begin(2);
    for (int i = 0; i < 8; i++) {
        shape s = {0};
        for (int k = 0; k < 4; k++)
            shape_vertex(&s, test_random_in(&random, -10, 10), test_random_in(&random, -10, 10),
                         test_random_in(&random, -10, 10));
        static const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        for (int k = 0; k < 4; k++) shape_triangle(&s, (size_t)faces[k][0], (size_t)faces[k][1], (size_t)faces[k][2]);
        if (mesh_volume(&s) < 0) shape_flip(&s, 0);
        const double exact = mesh_volume(&s);
        /* edges and thin corners are of second order in the voxel */
        if (exact > 100) CHECK_NEAR(volume_of(&s, 0.05), exact, 3e-4 * exact + 0.02);
        shape_free(&s);
    }
}

static void check_hollows(void)
{
    const double lo[4][3] = {{0, 0, 0}, {4, 4, 4}, {7, 7, 7}, {30, 0, 0}};
    const double hi[4][3] = {{20, 20, 20}, {16, 16, 16}, {13, 13, 13}, {40, 10, 10}};
    shape s = {0};
    shape_box(&s, lo[2], hi[2]); /* in any order */
    shape_box(&s, lo[0], hi[0]);
    shape_box(&s, lo[1], hi[1]);
    shape_flip(&s, 24);
    CHECK_NEAR(volume_of(&s, 0.2), 8000 - 1728 + 216, 0.7);
    shape_box(&s, lo[3], hi[3]);
    CHECK_NEAR(volume_of(&s, 0.2), 8000 - 1728 + 216 + 1000, 0.8);
    swarf_stock *stock = make(&s, 0.2);
    const double points[] = {10, 10, 10, 5, 10, 10, 2, 10, 10, 35, 5, 5, 25, 5, 5};
    float values[5];
    if (stock && CHECK_OK(swarf_stock_sample(stock, points, 5, values))) {
        CHECK(values[0] < 0);
        CHECK(values[1] > 0);
        CHECK(values[2] < 0);
        CHECK(values[3] < 0);
        CHECK(values[4] > 0);
    }
    swarf_stock_destroy(stock);
    shape_free(&s);
}

static void check_unions(void)
{
    const double lo[3][3] = {{0, 0, 0}, {5, 5, 5}, {10, 0, 0}}, hi[3][3] = {{10, 10, 10}, {15, 15, 15}, {20, 10, 10}};
    shape cut = {0}, touching = {0}, twice = {0};
    shape_box(&cut, lo[0], hi[0]);
    shape_box(&cut, lo[1], hi[1]);
    CHECK_NEAR(volume_of(&cut, 0.1), 2000 - 125, 0.4);
    shape_box(&touching, lo[0], hi[0]);
    shape_box(&touching, lo[2], hi[2]); /* the common faces cancel */
    CHECK_NEAR(volume_of(&touching, 0.1), 2000, 0.2);
    shape_box(&twice, lo[0], hi[0]);
    shape_box(&twice, lo[0], hi[0]);
    shape_triangle(&twice, twice.index[0], twice.index[1], twice.index[2]);
    shape_triangle(&twice, 3, 3, 5);
    CHECK_NEAR(volume_of(&twice, 0.1), 1000, 0.1);
    shape_free(&cut);
    shape_free(&touching);
    shape_free(&twice);
}

static void check_edge_contact(void)
{
    /* two boxes with a common edge: four triangles on it, two shells */
    const double lo[2][3] = {{0, 0, 0}, {10, 10, 0}}, hi[2][3] = {{10, 10, 10}, {20, 20, 10}};
    shape s = {0};
    for (int i = 0; i < 2; i++) shape_box(&s, lo[i], hi[i]);
    CHECK_NEAR(volume_of(&s, 0.1), 2000, 0.2);
    /* a hollow that touches the outside along an edge stays hollow */
    const double inner[3] = {5, 5, 2}, end[3] = {10, 10, 8};
    shape hollow = {0};
    shape_box(&hollow, lo[0], hi[0]);
    shape_box(&hollow, inner, end);
    shape_flip(&hollow, 12);
    CHECK_NEAR(volume_of(&hollow, 0.1), 1000 - 150, 0.5);
    shape_free(&s);
    shape_free(&hollow);
}

static void check_threads(void)
{
    const double centre[3] = {0, 0, 0};
    shape ball = {0};
    shape_ball(&ball, centre, 5, 40);
    uint64_t first = 0;
    for (int threads = 1; threads <= 8; threads++) {
        CHECK_OK(swarf_threads_set(threads));
        swarf_stock *stock = make(&ball, 0.1);
        uint64_t hash = 0;
        if (stock) CHECK_OK(swarf_stock_hash(stock, &hash));
        if (threads == 1) first = hash;
        CHECK(hash == first);
        swarf_stock_destroy(stock);
    }
    CHECK_OK(swarf_threads_set(0));
    shape_free(&ball);
}

static int stop(void *user, double fraction)
{
    double *last = user;
    CHECK(fraction >= *last);
    *last = fraction;
    return fraction > 0.1;
}

static void check_refusals(void)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {10, 10, 10}, away[3] = {20, 0, 0}, end[3] = {25, 5, 5};
    swarf_stock_options options = swarf_stock_options_default();
    swarf_stock *stock = NULL;
    shape s = {0};
    shape_box(&s, lo, hi);
    swarf_triangles triangles = shape_view(&s);
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_ARGUMENT, "voxel");
    options.voxel_mm = 1e-9;
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_MEMORY, "voxel");
    options.voxel_mm = 0.1;
    CHECK_FAILS(swarf_stock_create_mesh(NULL, &options, NULL, &stock), SWARF_ERROR_ARGUMENT, NULL);
    triangles.triangle_count = 11;
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_GEOMETRY, "3 open edges");
    triangles.triangle_count = 0;
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_GEOMETRY, "no triangles");
    uint32_t kept[3];
    triangles = shape_view(&s); /* one twice in place of another */
    memcpy(kept, s.index + 33, sizeof kept);
    memcpy(s.index + 33, s.index, sizeof kept);
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_GEOMETRY, "3 open edges");
    memcpy(s.index + 33, kept, sizeof kept);
    shape_flip(&s, 11);
    triangles = shape_view(&s);
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_GEOMETRY, "3 between");
    shape_flip(&s, 11);
    shape_flip(&s, 0);
    triangles = shape_view(&s);
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_GEOMETRY, "inside out");
    shape_flip(&s, 0);
    shape_box(&s, away, end);
    shape_flip(&s, 12);
    triangles = shape_view(&s);
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_GEOMETRY, "in no solid");
    shape_flip(&s, 12);
    triangles = shape_view(&s);
    double last = 0;
    const swarf_progress progress = {stop, &last};
    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_OK(swarf_threads_set(1));
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, &progress, &stock), SWARF_ERROR_CANCELLED, NULL);
    CHECK_OK(swarf_threads_set(0));
    s.xyz[5] = NAN;
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_ARGUMENT, "not finite");
    s.xyz[5] = 0;
    s.index[4] = 99;
    CHECK_FAILS(swarf_stock_create_mesh(&triangles, &options, NULL, &stock), SWARF_ERROR_ARGUMENT, "vertex 99");
    CHECK(stock == NULL);
    shape_free(&s);
}

int main(void)
{
    check_box();
    check_round();
    check_tetrahedra();
    check_hollows();
    check_unions();
    check_edge_contact();
    check_threads();
    check_refusals();
    return test_end();
}
