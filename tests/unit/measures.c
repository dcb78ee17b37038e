/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Measures of meshes against closed forms, shells apart, and sections. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shapes.h"
#include "stocks.h"
#include "test.h"

static const double pi = 3.14159265358979323846;

static void check_box(void)
{
    const double lo[3] = {101, 202, -303}, hi[3] = {103, 205, -299};
    shape box = {0};
    shape_box(&box, lo, hi);
    swarf_mesh *mesh = shape_mesh(&box);
    swarf_measures *measures = NULL;
    if (CHECK_OK(swarf_measures_create(mesh, &measures))) {
        size_t count;
        const swarf_shell *shell = swarf_measures_shells(measures, &count);
        CHECK(count == 1);
        CHECK(shell->vertices == 8 && shell->edges == 18 && shell->triangles == 12 && shell->open_edges == 0);
        CHECK(shell->euler == 2 && shell->genus == 0);
        CHECK_NEAR(shell->volume_mm3, 24, 1e-9);
        CHECK_NEAR(shell->area_mm2, 52, 1e-9);
        const double size[3] = {2, 3, 4};
        for (int k = 0; k < 3; k++) {
            const double a = size[(k + 1) % 3], b = size[(k + 2) % 3];
            CHECK_NEAR(shell->centre[k], 0.5 * (lo[k] + hi[k]), 1e-9);
            CHECK_NEAR(shell->inertia[k][k], 24 * (a * a + b * b) / 12, 1e-9);
            CHECK_NEAR(shell->inertia[k][(k + 1) % 3], 0, 1e-9);
            CHECK_NEAR(shell->box.lo[k], lo[k], 1e-9);
            CHECK_NEAR(shell->box.hi[k], hi[k], 1e-9);
        }
        /* the least moment is about the longest side, z */
        CHECK_NEAR(shell->moment[0], 26, 1e-9);
        CHECK_NEAR(shell->moment[2], 50, 1e-9);
        CHECK_NEAR(shell->axis[0][2], 1, 1e-9);
        CHECK_NEAR(fabs(shell->axis[2][0]), 1, 1e-9);
        const swarf_shell whole = swarf_measures_whole(measures);
        CHECK_NEAR(whole.volume_mm3, 24, 1e-9);
        CHECK(whole.genus == 0);
    }
    swarf_measures_destroy(measures);
    swarf_mesh_release(mesh);
}

/* Groups are what their shells are by themselves; of three shells the second is in none, and the middle group is
 * empty. Cancelled, nothing comes out. */
static void check_groups(const swarf_mesh *mesh, const swarf_measures *measures)
{
    static const uint32_t group_of[] = {2, UINT32_MAX, 0}, own[] = {2, 0};
    swarf_mesh *group[3] = {NULL}, *part = NULL;
    test_stopper stopper = {.after = 1};
    const swarf_progress stopping = {test_stop, &stopper};
    CHECK_FAILS(swarf_mesh_create_groups(mesh, measures, group_of, 3, &stopping, group), SWARF_ERROR_CANCELLED, "");
    CHECK(!group[0] && !group[1] && !group[2]);
    CHECK_OK(swarf_mesh_create_groups(mesh, measures, group_of, 0, NULL, NULL));
    if (!CHECK_OK(swarf_mesh_create_groups(mesh, measures, group_of, 3, NULL, group))) return;
    for (size_t g = 0; g < 3; g++) {
        if (CHECK_OK(swarf_mesh_create_shells(mesh, measures, own + g / 2, g != 1, &part))) {
            CHECK(test_same_mesh(group[g], part));
            swarf_mesh_release(part);
        }
        swarf_mesh_release(group[g]);
    }
}

/* A hollow ball beside a bar: three shells, one a cavity. */
static void check_hollow(void)
{
    const double centre[3] = {5, -7, 3}, base[3] = {20, 0, 0};
    shape s = {0};
    shape_ball(&s, centre, 3, 60);
    const size_t outside = s.triangles;
    shape_ball(&s, centre, 2, 60);
    shape_flip(&s, outside);
    const size_t hollow = s.triangles;
    shape_cylinder(&s, base, 1, 5, 200);
    swarf_mesh *mesh = shape_mesh(&s);
    swarf_measures *measures = NULL;
    if (!CHECK_OK(swarf_measures_create(mesh, &measures))) return;
    size_t count;
    const swarf_shell *shell = swarf_measures_shells(measures, &count);
    if (CHECK(count == 3)) {
        CHECK(swarf_measures_shell_of(measures)[0] == 0 && swarf_measures_shell_of(measures)[hollow] == 2);
        const double outer = 4 * pi / 3 * 27, inner = 4 * pi / 3 * 8, bar = 100 * sin(pi / 100) * 5;
        CHECK_NEAR(shell[0].volume_mm3, outer, 3e-3 * outer); /* latitude and longitude: a polyhedron */
        CHECK_NEAR(shell[1].volume_mm3, -inner, 3e-3 * inner);
        CHECK_NEAR(shell[2].volume_mm3, bar, 1e-6 * bar);
        CHECK_NEAR(shell[0].moment[1], 0.4 * shell[0].volume_mm3 * 9, 6e-3 * 0.4 * outer * 9);
        const double m = shell[2].volume_mm3; /* a regular prism of 200 sides is as good as round */
        CHECK_NEAR(shell[2].moment[0], m / 2, 1e-3 * m);
        CHECK_NEAR(shell[2].moment[2], m * (0.25 + 25.0 / 12), 1e-3 * m);
        CHECK_NEAR(fabs(shell[2].axis[0][2]), 1, 1e-9);
        const swarf_shell whole = swarf_measures_whole(measures);
        CHECK_NEAR(whole.volume_mm3, shell[0].volume_mm3 + shell[1].volume_mm3 + m, 1e-9 * outer);
        CHECK(whole.genus == 0 && whole.euler == 6);
        static const uint32_t ball[] = {0, 1}, wrong[] = {3};
        swarf_mesh *part = NULL;
        if (CHECK_OK(swarf_mesh_create_shells(mesh, measures, ball, 2, &part))) {
            CHECK(swarf_mesh_triangles(part).triangle_count == hollow);
            CHECK(swarf_mesh_topology(part).closed);
            CHECK_NEAR(swarf_mesh_topology(part).volume_mm3, shell[0].volume_mm3 + shell[1].volume_mm3, 1e-6 * outer);
            swarf_mesh_release(part);
        }
        CHECK_FAILS(swarf_mesh_create_shells(mesh, measures, wrong, 1, &part), SWARF_ERROR_ARGUMENT, "shell 3 of 3");
        check_groups(mesh, measures);
    }
    swarf_measures_destroy(measures);
    swarf_mesh_release(mesh);
}

/* Plates with holes, cut and contoured: as many holes as were drilled; cut in two they are two pieces. */
static void check_drilled(void)
{
    const swarf_box box = {{0, 0, -2}, {40, 10, 0}};
    swarf_stock *stock = stock_block(&box, 0.2);
    swarf_cutter *drill = NULL;
    CHECK_OK(swarf_cutter_parse("flat:d=4,l=9", &drill));
    for (int holes = 0; holes <= 4; holes++) {
        const double x = 4 + 8.0 * holes + (holes > 1 ? 4 : 0);
        swarf_path path = {.start = {x, 5, 1}, .end = {x, 5, -3}, .has_motion = 1};
        if (holes == 4) { /* a cut between the holes, all through */
            path.start[0] = path.end[0] = 18;
            path.start[1] = -3;
            path.end[1] = 13;
            path.start[2] = path.end[2] = -3;
        }
        CHECK_OK(swarf_stock_cut(stock, drill, &path, 1, NULL));
        swarf_contour_options contour = swarf_contour_options_default();
        contour.error_mm = 0.02;
        swarf_mesh *mesh = NULL;
        swarf_measures *measures = NULL;
        if (CHECK_OK(swarf_mesh_contour(stock, &contour, NULL, &mesh, NULL)) &&
            CHECK_OK(swarf_measures_create(mesh, &measures))) {
            size_t count;
            const swarf_shell *shell = swarf_measures_shells(measures, &count);
            CHECK(count == (holes == 4 ? 2 : 1));
            CHECK(swarf_measures_whole(measures).genus == (holes == 4 ? 4 : holes + 1));
            CHECK(shell->genus == (holes == 4 ? 2 : holes + 1));
            const double cut = holes == 4 ? 4 * 4 * pi * 2 + 4 * 10 * 2 : (holes + 1) * 4 * pi * 2;
            CHECK_NEAR(swarf_measures_whole(measures).volume_mm3, 800 - cut, 6e-3 * 800);
        }
        swarf_measures_destroy(measures);
        swarf_mesh_release(mesh);
    }
    swarf_cutter_release(drill);
    swarf_stock_destroy(stock);
}

static double area_of(const double *p, size_t count)
{
    double area = 0;
    for (size_t i = 0; i < count; i++) {
        const double *a = p + 3 * i, *b = p + 3 * ((i + 1) % count);
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    return area;
}

static void check_sections(void)
{
    const double centre[3] = {0, 0, 0}, low[3] = {0, 0, -9}, high[3] = {0, 0, 9}, up[3] = {0, 0, 2};
    shape s = {0};
    shape_ball(&s, centre, 3, 60);
    const size_t outside = s.triangles;
    shape_ball(&s, centre, 2, 60);
    shape_flip(&s, outside);
    swarf_mesh *mesh = shape_mesh(&s);
    swarf_outline *section = NULL;
    for (double z = -2.51; z < 3; z += 1.003) {
        const double point[3] = {7, 7, z};
        if (!CHECK_OK(swarf_outline_create(mesh, point, up, &section))) continue;
        const size_t loops = swarf_outline_count(section);
        CHECK(loops == (fabs(z) < 2 ? 2 : 1));
        double area = 0;
        for (size_t i = 0; i < loops; i++) {
            size_t count;
            const double *p = swarf_outline_polyline(section, i, &count);
            for (size_t k = 0; k < count; k++) CHECK_NEAR(p[3 * k + 2], z, 1e-6);
            area += area_of(p, count);
        }
        const double exact = pi * (9 - z * z - (fabs(z) < 2 ? 4 - z * z : 0));
        CHECK_NEAR(area, exact, 2e-3 * 9 * pi);
        swarf_outline_destroy(section);
    }
    if (CHECK_OK(swarf_outline_create(mesh, high, up, &section))) {
        CHECK(swarf_outline_count(section) == 0);
        swarf_outline_destroy(section);
    }
    CHECK_FAILS(swarf_outline_create(mesh, low, centre, &section), SWARF_ERROR_ARGUMENT, "no length");
    swarf_mesh_release(mesh);

    /* through the middle of a box, along its faces, beside one by less than points are apart */
    const double lo[3] = {0, 0, 0}, hi[3] = {2, 3, 4};
    static const double heights[] = {2, 0, 4, 4 - 1e-7};
    shape box = {0};
    shape_box(&box, lo, hi);
    box.triangles = 12;
    mesh = shape_mesh(&box);
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        const double point[3] = {0, 0, heights[i]};
        if (!CHECK_OK(swarf_outline_create(mesh, point, up, &section))) continue;
        size_t count = 0;
        if (CHECK(swarf_outline_count(section) == 1)) {
            const double *p = swarf_outline_polyline(section, 0, &count);
            CHECK_NEAR(area_of(p, count), 6, 1e-6);
            CHECK(count == (heights[i] == 2 ? 8 : 4)); /* where it passes edges, corners */
        }
        swarf_outline_destroy(section);
    }
    swarf_mesh_release(mesh);

    /* through the ridge of a roof and the tip of a pyramid, of which nothing is above; both below them */
    static const float roof[2][18] = {{0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 0, 2, 3, 4, 2, 3},
                                      {0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0, 2, 2, 3, 2, 2, 3}};
    static const uint32_t sides[] = {0, 2, 1, 0, 3, 2, 0, 1, 5, 0, 5, 4, 2, 3, 4, 2, 4, 5, 1, 2, 5, 3, 0, 4};
    for (int i = 0; i < 4; i++) {
        const swarf_triangles of = {roof[i & 1], 6, sides, 8};
        const double point[3] = {0, 0, i < 2 ? 3 : 1.5};
        if (!CHECK_OK(swarf_mesh_create(&of, &mesh))) continue;
        if (CHECK_OK(swarf_outline_create(mesh, point, up, &section))) {
            CHECK(swarf_outline_count(section) == (i < 2 ? 0 : 1));
            swarf_outline_destroy(section);
        }
        swarf_mesh_release(mesh);
    }

    /* an open mesh, whose outline has ends */
    static const float xyz[] = {0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const uint32_t index[] = {0, 1, 2};
    const swarf_triangles one = {xyz, 3, index, 1};
    if (CHECK_OK(swarf_mesh_create(&one, &mesh))) {
        const double half[3] = {0, 0, 0.5};
        if (CHECK_OK(swarf_outline_create(mesh, half, up, &section))) {
            size_t count = 0;
            CHECK(swarf_outline_count(section) == 1);
            swarf_outline_polyline(section, 0, &count);
            CHECK(count == 2);
            swarf_outline_destroy(section);
        }
        swarf_measures *measures = NULL;
        if (CHECK_OK(swarf_measures_create(mesh, &measures))) {
            CHECK(swarf_measures_whole(measures).open_edges == 3 && swarf_measures_whole(measures).genus == -1);
            swarf_measures_destroy(measures);
        }
        swarf_mesh_release(mesh);
    }
}

int main(void)
{
    check_box();
    check_hollow();
    check_drilled();
    check_sections();
    return test_end();
}
