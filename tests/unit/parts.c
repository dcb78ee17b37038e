/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Meshes split by planes, thickness of walls, and lumps of stocks, against closed forms. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shapes.h"
#include "stocks.h"
#include "test.h"

static const double pi = 3.14159265358979323846;

static void check_closed(const swarf_mesh *mesh)
{
    const swarf_topology t = swarf_mesh_topology(mesh);
    CHECK(t.boundary_edges == 0 && t.nonmanifold_edges == 0 && t.misoriented_edges == 0 && t.degenerate == 0);
}

/* Both parts closed, on their sides, their volumes and boxes as expected; `below` NAN: only that they add up. */
static void check_split(const swarf_mesh *mesh, const double point[3], const double normal[3], double below)
{
    const double volume = swarf_mesh_topology(mesh).volume_mm3;
    swarf_mesh *part[2] = {NULL, NULL};
    if (!CHECK_OK(swarf_mesh_split(mesh, point, normal, &part[0], &part[1]))) return;
    double sum = 0;
    const double length = hypot(hypot(normal[0], normal[1]), normal[2]);
    for (int i = 0; i < 2; i++) {
        check_closed(part[i]);
        sum += swarf_mesh_topology(part[i]).volume_mm3;
        const swarf_triangles t = swarf_mesh_triangles(part[i]);
        double beyond = 0;
        for (size_t v = 0; v < t.vertex_count; v++) {
            double height = 0;
            for (size_t k = 0; k < 3; k++) height += ((double)t.xyz[3 * v + k] - point[k]) * normal[k] / length;
            beyond = fmax(beyond, i ? -height : height);
        }
        CHECK(beyond < 1e-4);
    }
    CHECK_NEAR(sum, volume, 1e-5 * fabs(volume));
    if (!isnan(below)) CHECK_NEAR(swarf_mesh_topology(part[0]).volume_mm3, below, 1e-5 * fabs(volume));
    swarf_mesh_release(part[0]);
    swarf_mesh_release(part[1]);
}

static void check_splits(void)
{
    const double lo[3] = {1, 2, 3}, hi[3] = {11, 8, 7};
    shape s = {0};
    shape_box(&s, lo, hi);
    swarf_mesh *box = shape_mesh(&s);
    check_split(box, (double[]){0, 0, 4.5}, (double[]){0, 0, 2}, 10 * 6 * 1.5);
    check_split(box, (double[]){0, 0, 4.5}, (double[]){0, 0, -1}, 10 * 6 * 2.5);
    check_split(box, (double[]){6, 5, 5}, (double[]){1, 0.3, -0.2}, 120);
    const double length[2] = {1e200, 1e-200}; /* their squares are no numbers */
    for (int i = 0; i < 2; i++) check_split(box, (double[]){3, 0, 0}, (double[]){length[i], 0, 0}, 2 * 6 * 4);
    check_split(box, lo, (double[]){0.6, 1, 0}, 0.5 * 0 + 0);       /* through an edge, nothing below */
    check_split(box, lo, (double[]){0.6, -1, 0}, 4 * 0.5 * 10 * 6); /* through two edges: a diagonal */
    check_split(box, (double[]){0, 0, 3}, (double[]){0, 0, 1}, 0);  /* a face in the plane */
    check_split(box, (double[]){0, 0, 7}, (double[]){0, 0, 1}, 240);
    check_split(box, (double[]){0, 0, 99}, (double[]){0, 0, 1}, 240);
    swarf_mesh_release(box);

    /* a hollow ball: the cap is a ring; beside it a bar and, in the ball's cavity, another ball */
    const double centre[3] = {5, -7, 3}, base[3] = {20, 0, 0};
    shape_ball(&s, centre, 3, 60);
    const size_t outside = s.triangles;
    shape_ball(&s, centre, 2, 60);
    shape_flip(&s, outside);
    shape_ball(&s, centre, 1, 60);
    shape_cylinder(&s, base, 1, 5, 200);
    swarf_mesh *mesh = shape_mesh(&s);
    const double balls = 4 * pi / 3 * (27 - 8 + 1);
    swarf_mesh *below = NULL, *above = NULL;
    if (CHECK_OK(swarf_mesh_split(mesh, centre, (double[]){1, 0, 0}, &below, &above))) {
        CHECK_NEAR(swarf_mesh_topology(below).volume_mm3, 0.5 * balls, 5e-3 * balls);
        swarf_mesh_release(below);
        swarf_mesh_release(above);
    }
    test_random random = test_random_begin(77);
    for (int i = 0; i < 60; i++) {
        double point[3], normal[3];
        for (int k = 0; k < 3; k++) {
            point[k] = test_random_in(&random, centre[k] - 2, centre[k] + 2);
            normal[k] = test_random_in(&random, -1, 1);
        }
        check_split(mesh, point, normal, NAN);
    }
    swarf_mesh_release(mesh);
}

/* The mesh of a plate with a grid of drilled holes and a pocket, cut at its faces and between. */
static void check_plate(void)
{
    const swarf_box block = {{0, 0, -6}, {40, 30, 0}};
    swarf_stock *stock = stock_block(&block, 0.25);
    swarf_program *program = NULL;
    swarf_cutter *cutter = NULL;
    swarf_mesh *mesh = NULL;
    swarf_surface *surface = NULL;
    CHECK_OK(swarf_cutter_parse("flat:d=3,l=20", &cutter));
    CHECK_OK(swarf_program_create((double[]){0, 0, 9}, &program));
    CHECK_OK(swarf_program_add_operation(program, "holes"));
    CHECK_OK(swarf_program_set_section(program, &(swarf_section){.tool = 1}));
    for (int i = 0; i < 20; i++) {
        const double x = 4 + 8 * (i % 5), y = 4 + 7 * (i / 5), depth = i < 15 ? -7 : -3;
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, (double[]){x, y, 9}, 0, 1));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, (double[]){x, y, depth}, 100, 2));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, (double[]){x, y, 9}, 0, 3));
    }
    const swarf_tool tool = {1, 0, cutter};
    swarf_simulation *played = NULL;
    CHECK_OK(swarf_surface_create(stock, program, &tool, 1, NULL, &surface));
    CHECK_OK(swarf_stock_simulate(stock, program, 0, swarf_program_move_count(program), &tool, 1, NULL, NULL, &played));
    swarf_simulation_destroy(played);
    swarf_contour_options wanted = swarf_contour_options_default();
    wanted.error_mm = 0.002;
    wanted.surface = surface;
    wanted.moves = SIZE_MAX;
    if (CHECK_OK(swarf_mesh_contour(stock, &wanted, NULL, &mesh, NULL))) {
        const double hole = pi * 1.5 * 1.5, lower = 3 * (40 * 30 - 15 * hole);
        swarf_mesh *below = NULL, *above = NULL;
        /* at the floors of the blind holes, which lie in the plane, and a little higher and lower */
        for (int i = -1; i <= 1; i++) {
            const double point[3] = {0, 0, -3 + 0.01 * i};
            CHECK_OK(swarf_mesh_split(mesh, point, (double[]){0, 0, 1}, &below, &above));
            check_closed(below);
            check_closed(above);
            const double under = swarf_mesh_topology(below).volume_mm3, over = swarf_mesh_topology(above).volume_mm3;
            CHECK_NEAR(under + over, swarf_mesh_topology(mesh).volume_mm3, 1e-5 * lower);
            CHECK_NEAR(under, lower + 0.01 * i * (40 * 30 - (i > 0 ? 20 : 15) * hole), 1e-3 * lower);
            swarf_mesh_release(below);
            swarf_mesh_release(above);
        }
        test_random random = test_random_begin(78);
        for (int i = 0; i < 20; i++) {
            const double point[3] = {test_random_in(&random, 5, 35), test_random_in(&random, 5, 25), -3};
            const double normal[3] = {test_random_in(&random, -1, 1), test_random_in(&random, -1, 1),
                                      test_random_in(&random, -0.4, 0.4)};
            check_split(mesh, point, normal, NAN);
        }
        swarf_mesh_release(mesh);
    }
    swarf_surface_release(surface);
    swarf_program_release(program);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
}

static void check_errors(void)
{
    shape s = {0};
    shape_box(&s, (double[]){0, 0, 0}, (double[]){1, 1, 1});
    s.triangles--;
    swarf_mesh *open = shape_mesh(&s), *below = NULL, *above = NULL;
    CHECK_FAILS(swarf_mesh_split(open, (double[]){0, 0, 0.5}, (double[]){0, 0, 1}, &below, &above),
                SWARF_ERROR_GEOMETRY, "only closed meshes");
    CHECK_FAILS(swarf_mesh_split(open, (double[]){0, 0, NAN}, (double[]){0, 0, 1}, &below, &above),
                SWARF_ERROR_ARGUMENT, "not finite");
    CHECK_FAILS(swarf_mesh_split(open, (double[]){0, 0, 0}, (double[]){0, 0, 0}, &below, &above), SWARF_ERROR_ARGUMENT,
                "no length");
    CHECK(!below && !above);
    swarf_mesh_release(open);
    float thick[12];
    shape_box(&s, (double[]){0, 0, -2e20}, (double[]){1, 1, 1}); /* rays that start there would end the process */
    swarf_mesh *far = shape_mesh(&s);
    CHECK_FAILS(swarf_mesh_thickness(far, NULL, thick), SWARF_ERROR_GEOMETRY, "up to 2e+20 mm");
    swarf_mesh_release(far);
}

/* ---- thickness ---- */

static float *thickness_of(const swarf_mesh *mesh)
{
    float *out = malloc((swarf_mesh_triangles(mesh).triangle_count + 1) * sizeof *out);
    CHECK_OK(swarf_mesh_thickness(mesh, NULL, out));
    return out;
}

static void check_thickness(void)
{
    /* a plate, far from the origin: its three thicknesses */
    shape s = {0};
    shape_box(&s, (double[]){500, 500, 500}, (double[]){530, 520, 501.5});
    swarf_mesh *mesh = shape_mesh(&s);
    float *found = thickness_of(mesh);
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    for (size_t i = 0; i < t.triangle_count; i++) {
        double lo[3] = {1e9, 1e9, 1e9}, hi[3] = {0};
        for (size_t c = 0; c < 9; c++) {
            const double at = (double)t.xyz[3 * (size_t)t.index[3 * i + c / 3] + c % 3];
            lo[c % 3] = fmin(lo[c % 3], at);
            hi[c % 3] = fmax(hi[c % 3], at);
        }
        const double size[3] = {30, 20, 1.5};
        for (int k = 0; k < 3; k++)
            if (lo[k] == hi[k]) CHECK_NEAR((double)found[i], size[k], 2e-3);
    }
    free(found);
    swarf_mesh_release(mesh);

    /* a tube: its wall, less what the facets' sagitta leaves out */
    const int sides = 240;
    shape_cylinder(&s, (double[]){0, 0, 0}, 10, 30, sides);
    const size_t outside = s.triangles;
    shape_cylinder(&s, (double[]){0, 0, 5}, 8, 20, sides);
    shape_flip(&s, outside);
    mesh = shape_mesh(&s);
    found = thickness_of(mesh);
    float least = INFINITY;
    for (size_t i = 0; i < swarf_mesh_triangles(mesh).triangle_count; i++) least = fminf(least, found[i]);
    CHECK_NEAR((double)least, 2, 10 * (1 - cos(pi / sides)) + 1e-3);
    free(found);
    swarf_mesh_release(mesh);

    /* a wedge of 20 degrees: rays from its lower face meet the slope at x tan 20 */
    const double slope = tan(20 * pi / 180);
    for (int side = 0; side < 2; side++) {
        const double y = side ? 10 : 0;
        shape_vertex(&s, 0, y, 0);
        shape_vertex(&s, 10, y, 0);
        shape_vertex(&s, 10, y, 10 * slope);
    }
    const size_t wedge[8][3] = {{0, 1, 2}, {3, 5, 4}, {0, 4, 1}, {0, 3, 4}, {1, 4, 5}, {1, 5, 2}, {0, 2, 5}, {0, 5, 3}};
    for (int i = 0; i < 8; i++) shape_triangle(&s, wedge[i][0], wedge[i][1], wedge[i][2]);
    mesh = shape_mesh(&s);
    CHECK(swarf_mesh_topology(mesh).closed && swarf_mesh_topology(mesh).volume_mm3 > 0);
    found = thickness_of(mesh);
    /* from near the corner at x = 0: the corners at x = 10 weigh a hundredth each */
    CHECK_NEAR((double)found[2], slope * 0.02 * 10, 1e-4);
    CHECK_NEAR((double)found[3], slope * 0.01 * 10, 1e-4);
    free(found);
    swarf_mesh_release(mesh);
}

/* A block 50 mm wide, its sides drafted by 2 degrees and parted into strips: under its upper rim, where a side and the
 * top meet at 88 degrees, rays from the strips soon leave by the top. No wall is thinner than the block is high. */
static void check_draft(void)
{
    enum { STRIPS = 40 };
    const double high = 8, lean = tan(2 * pi / 180);
    shape s = {0};
    for (int ring = 0; ring <= STRIPS; ring++) {
        const double z = high * ring / STRIPS, half = 25 + lean * z;
        for (int i = 0; i < 4; i++) shape_vertex(&s, i == 1 || i == 2 ? half : -half, i > 1 ? half : -half, z);
    }
    for (size_t ring = 0; ring < STRIPS; ring++)
        for (size_t i = 0; i < 4; i++) {
            const size_t a = 4 * ring + i, b = 4 * ring + (i + 1) % 4;
            shape_triangle(&s, a, b, b + 4);
            shape_triangle(&s, a, b + 4, a + 4);
        }
    const size_t top = 4 * STRIPS;
    shape_triangle(&s, 0, 2, 1);
    shape_triangle(&s, 0, 3, 2);
    shape_triangle(&s, top, top + 1, top + 2);
    shape_triangle(&s, top, top + 2, top + 3);
    swarf_mesh *mesh = shape_mesh(&s);
    CHECK(swarf_mesh_topology(mesh).closed && swarf_mesh_topology(mesh).volume_mm3 > 0);
    float *found = thickness_of(mesh), least = INFINITY;
    for (size_t i = 0; i < swarf_mesh_triangles(mesh).triangle_count; i++) least = fminf(least, found[i]);
    CHECK_NEAR((double)least, high, 1e-3);
    free(found);
    swarf_mesh_release(mesh);
}

/* ---- lumps ---- */

static void check_lumps(void)
{
    const swarf_box block = {{0, 0, -3}, {30, 20, 0}};
    swarf_stock *stock = stock_block(&block, 0.1);
    swarf_cutter *cutter = NULL;
    CHECK_OK(swarf_cutter_parse("flat:d=2,l=20", &cutter));
    swarf_lumps *lumps = NULL;
    size_t count = 0;
    const double points[3][3] = {{5, 10, -1}, {25, 10, -1}, {15, 10, 3}};
    uint32_t lump_of[3];
    CHECK_OK(swarf_lumps_create(stock, points[0], 3, NULL, lump_of, &lumps));
    const swarf_lump *lump = swarf_lumps_get(lumps, &count);
    CHECK(count == 1 && lump->voxels == 300 * 200 * 30);
    CHECK_NEAR(lump->volume_mm3, 1800, 1e-6);
    CHECK(lump_of[0] == 0 && lump_of[1] == 0 && lump_of[2] == UINT32_MAX);
    swarf_lumps_destroy(lumps);

    /* cut through but for a bridge a tenth thick, then through the bridge */
    swarf_path path = {.start = {15, -5, -2.9}, .end = {15, 25, -2.9}, .has_motion = 1};
    CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
    CHECK_OK(swarf_lumps_create(stock, points[0], 3, NULL, lump_of, &lumps));
    (void)swarf_lumps_get(lumps, &count);
    CHECK(count == 1 && lump_of[0] == lump_of[1]);
    swarf_lumps_destroy(lumps);
    path.start[2] = path.end[2] = -3.2;
    CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
    CHECK_OK(swarf_lumps_create(stock, points[0], 3, NULL, lump_of, &lumps));
    lump = swarf_lumps_get(lumps, &count);
    CHECK(count == 2 && lump_of[0] != lump_of[1] && lump_of[2] == UINT32_MAX);
    for (size_t i = 0; i < count; i++) {
        CHECK_NEAR(lump[i].volume_mm3, 14 * 20 * 3, 0.1 * 20 * 3);
        CHECK_NEAR(lump[i].box.hi[0] - lump[i].box.lo[0], 14, 0.11);
        float value = 0;
        CHECK_OK(swarf_stock_sample(stock, lump[i].inside, 1, &value));
        CHECK(value < 0);
    }
    swarf_lumps_destroy(lumps);
    CHECK_FAILS(swarf_lumps_create(NULL, NULL, 0, NULL, NULL, &lumps), SWARF_ERROR_ARGUMENT, "NULL");
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
}

static int stop_late(void *user, double fraction)
{
    double *last = user;
    *last = fraction;
    return fraction > 0.65;
}

/* A plate sawn into tiles of different sizes: every tile's own voxel is in it, the air between is in none; and it can
 * be stopped after the leaves have been looked at. */
static void check_tiles(void)
{
    enum { WAYS = 9 };
    const swarf_box block = {{0, 0, -1}, {40, 40, 0}};
    swarf_stock *stock = stock_block(&block, 0.2);
    swarf_cutter *cutter = NULL;
    CHECK_OK(swarf_cutter_parse("flat:d=1,l=20", &cutter));
    for (int i = 1; i <= WAYS; i++) { /* further and further apart */
        const double at = 2 * i + 0.2 * i * i;
        const swarf_path along[2] = {{.start = {at, -5, -2}, .end = {at, 45, -2}, .has_motion = 1},
                                     {.start = {-5, at, -2}, .end = {45, at, -2}, .has_motion = 1}};
        CHECK_OK(swarf_stock_cut(stock, cutter, along, 2, NULL));
    }
    swarf_lumps *lumps = NULL;
    size_t count = 0;
    CHECK_OK(swarf_lumps_create(stock, NULL, 0, NULL, NULL, &lumps));
    const swarf_lump *lump = swarf_lumps_get(lumps, &count);
    CHECK(count == (WAYS + 1) * (WAYS + 1));
    double *points = malloc(3 * (count + 1) * sizeof *points);
    uint32_t *lump_of = malloc((count + 1) * sizeof *lump_of);
    for (size_t i = 0; i < count; i++) memcpy(points + 3 * i, lump[i].inside, sizeof lump[i].inside);
    memcpy(points + 3 * count, (double[]){2.2, 20, -0.5}, 3 * sizeof *points);
    swarf_lumps_destroy(lumps);
    lumps = NULL;
    CHECK_OK(swarf_lumps_create(stock, points, count + 1, NULL, lump_of, &lumps));
    for (size_t i = 0; i < count; i++) CHECK(lump_of[i] == i);
    CHECK(lump_of[count] == UINT32_MAX);
    swarf_lumps_destroy(lumps);
    lumps = NULL;
    double last = 0;
    const swarf_progress progress = {stop_late, &last};
    CHECK_FAILS(swarf_lumps_create(stock, NULL, 0, &progress, NULL, &lumps), SWARF_ERROR_CANCELLED, "");
    CHECK(last > 0.65 && last < 1 && !lumps);
    free(points);
    free(lump_of);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
}

int main(void)
{
    check_splits();
    check_plate();
    check_errors();
    check_thickness();
    check_draft();
    check_lumps();
    check_tiles();
    return test_end();
}
