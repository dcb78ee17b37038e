/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Walls and floors from a tenth of a voxel to three voxels thick: the volume of the field and that of the mesh against
 * the exact one, and what both promise to be off by.
 *
 * A wall of thickness t < h that lies anyhow has in the field, averaged over where voxel centres lie,
 * the integral of 1/2 + t/2h - |u| over |u| < (h + t) / 2 = (h + t)^2 / 4h, which is (h - t)^2 / 4h too much. */
#include <math.h>
#include <string.h>

#include "stocks.h"

static const double voxel = 0.1;
static const swarf_box block = {{-3, -2.5, -2}, {3, 2.5, 0}};

enum { MOST_CORNERS = 12 };

/* Area of the part of the block, seen from above, where n . p lies between lo and hi. */
static double strip_area(const double n[2], double lo, double hi)
{
    double at[MOST_CORNERS][2] = {
        {block.lo[0], block.lo[1]}, {block.hi[0], block.lo[1]}, {block.hi[0], block.hi[1]}, {block.lo[0], block.hi[1]}};
    int count = 4;
    for (int side = 0; side < 2; side++) {
        double kept[MOST_CORNERS][2];
        int left = 0;
        for (int i = 0; i < count; i++) {
            const double *a = at[i], *b = at[(i + 1) % count];
            const double u = side ? hi - (n[0] * a[0] + n[1] * a[1]) : n[0] * a[0] + n[1] * a[1] - lo;
            const double v = side ? hi - (n[0] * b[0] + n[1] * b[1]) : n[0] * b[0] + n[1] * b[1] - lo;
            if (u >= 0) memcpy(kept[left++], a, sizeof *kept);
            if ((u < 0) == (v < 0)) continue;
            for (int k = 0; k < 2; k++) kept[left][k] = a[k] + u / (u - v) * (b[k] - a[k]);
            left++;
        }
        memcpy(at, kept, sizeof at);
        count = left;
    }
    double twice = 0;
    for (int i = 0; i < count; i++) {
        const double *a = at[i], *b = at[(i + 1) % count];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return 0.5 * twice;
}

/* Volumes of what is left of the block, in mm3. */
typedef struct volumes {
    double exact, field, mesh, unseen;
} volumes;

/* Slots along lines n . p = middle[i], across the whole block. */
static volumes cut(const double n[2], const double middle[], int count, double radius, double depth)
{
    volumes out = {.exact = 0};
    char text[64];
    snprintf(text, sizeof text, "flat:d=%.17g,l=10", 2 * radius);
    swarf_cutter *cutter = NULL;
    swarf_program *program = NULL;
    swarf_surface *surface = NULL;
    swarf_mesh *mesh = NULL;
    swarf_simulation *simulation = NULL;
    swarf_stock *stock = stock_block(&block, voxel);
    const swarf_section section = {.tool = 1};
    const double first[3] = {0, 0, 20}, far = 12;
    CHECK_OK(swarf_cutter_parse(text, &cutter));
    CHECK_OK(swarf_program_create(first, &program));
    CHECK_OK(swarf_program_add_operation(program, "slots"));
    CHECK_OK(swarf_program_set_section(program, &section));
    for (int i = 0; i < count; i++) {
        double ends[2][3];
        for (int side = 0; side < 2; side++) {
            const double along = side ? far : -far;
            ends[side][0] = n[0] * middle[i] - n[1] * along;
            ends[side][1] = n[1] * middle[i] + n[0] * along;
            ends[side][2] = -depth;
        }
        const double above[3] = {ends[0][0], ends[0][1], 20}, back[3] = {ends[1][0], ends[1][1], 20};
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, above, 0, 1));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, ends[0], 100, 1));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, ends[1], 100, 1));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_RAPID, back, 0, 1));
    }
    const swarf_tool tool = {1, 0, cutter};
    CHECK_OK(swarf_surface_create(stock, program, &tool, 1, NULL, &surface));
    CHECK_OK(
        swarf_stock_simulate(stock, program, 0, swarf_program_move_count(program), &tool, 1, NULL, NULL, &simulation));
    CHECK_OK(swarf_stock_volume(stock, &out.field));
    swarf_contour_options options = swarf_contour_options_default();
    swarf_contour_report report;
    options.surface = surface;
    if (CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) {
        out.mesh = swarf_mesh_topology(mesh).volume_mm3;
        out.unseen = report.unseen_mm3;
        CHECK(swarf_mesh_topology(mesh).closed && report.intersections_left == 0);
    }
    swarf_simulation_destroy(simulation);
    swarf_mesh_release(mesh);
    swarf_surface_release(surface);
    swarf_stock_destroy(stock);
    swarf_program_release(program);
    swarf_cutter_release(cutter);
    return out;
}

static double whole(void)
{
    return (block.hi[0] - block.lo[0]) * (block.hi[1] - block.lo[1]) * (block.hi[2] - block.lo[2]);
}

static const double thick[] = {0.1, 0.3, 0.6, 0.9, 1.1, 1.5, 3};
enum { THICKNESSES = sizeof thick / sizeof *thick };

/* Some 35 mm of edges in the field, which allow h^2 / 4 per mm, and 1e-4 of the rest. */
static const double edges_allowed = 35 * 0.1 * 0.1 / 4;

static void print(const char *what, double voxels, const volumes *v)
{
    printf("    %s of %.1f voxels: exact %.4f mm3, field %+.4f, mesh %+.4f, unseen %.4f\n", what, voxels, v->exact,
           v->field - v->exact, v->mesh - v->exact, v->unseen);
}

/* The mesh has no material too much; too little only in a wall that is thinner than a voxel, and there no more than
 * that and the chords beside it. */
static int check_mesh(const volumes *v, double voxels, double in_wall)
{
    const double lost = v->exact - v->mesh, noise = 1e-3 * v->exact; /* of corners that are cut thin */
    return CHECK(lost >= -noise) & CHECK(lost <= (voxels < 1 ? 1.1 * in_wall : 0) + noise);
}

/* A wall between two slots, anyhow. */
static void check_walls(test_random *random)
{
    const double radius = 0.7, depth = 1.53;
    for (int i = 0; i < THICKNESSES; i++) {
        const double angle = test_random_in(random, 0.1, 1.4), n[2] = {cos(angle), sin(angle)};
        const double t = thick[i] * voxel, at = test_random_in(random, -0.5, 0.5);
        const double middle[2] = {at - radius, at + t + radius};
        volumes v = cut(n, middle, 2, radius, depth);
        v.exact = whole() - depth * (strip_area(n, at - 2 * radius, at) + strip_area(n, at + t, at + t + 2 * radius));
        const double area = strip_area(n, at, at + t) / t * depth;
        const double excess = thick[i] < 1 ? area * voxel * (1 - thick[i]) * (1 - thick[i]) / 4 : 0;
        const int good = CHECK_NEAR(v.field, v.exact + excess, edges_allowed) & check_mesh(&v, thick[i], area * t);
        if (!good | !CHECK(thick[i] < 1 || v.unseen <= 0.02) | !CHECK(thick[i] > 0.2 || v.unseen > excess / 3))
            print("wall", thick[i], &v);
    }
}

/* A floor above the block's lower face, which lies halfway between voxel centres. */
static void check_floors(test_random *random)
{
    for (int i = 0; i < THICKNESSES; i++) {
        const double angle = test_random_in(random, 0.1, 1.4), n[2] = {cos(angle), sin(angle)};
        const double t = thick[i] * voxel, radius = 1.1, middle = test_random_in(random, -0.5, 0.5);
        const double depth = block.hi[2] - block.lo[2] - t;
        volumes v = cut(n, &middle, 1, radius, depth);
        const double area = strip_area(n, middle - radius, middle + radius);
        v.exact = whole() - depth * area;
        int good = CHECK_NEAR(v.field, v.exact, edges_allowed) & check_mesh(&v, thick[i], area * t);
        if (thick[i] < 0.5) /* seen nowhere: all but the row along its sides */
            good &= CHECK_NEAR(v.unseen, v.exact - v.mesh, 0.3 * (v.exact - v.mesh));
        else
            good &= CHECK(v.unseen <= 0.02);
        if (!good) print("floor", thick[i], &v);
    }
}

int main(void)
{
    test_random random = test_random_begin(55);
    check_walls(&random);
    check_floors(&random);
    return test_end();
}
