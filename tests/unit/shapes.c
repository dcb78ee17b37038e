/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Shapes of faces: points of the exact surface lie on the face that they name, with its normal, for every cutter on
 * every motion; after a turn into the next set-up as well. */
#include <math.h>
#include <string.h>

#include "cases.h"

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Signed distance to an endless face (up to its sign) and its gradient, straight from what the header says. */
static double shape_distance(const swarf_face_shape *shape, const double p[3], double gradient[3])
{
    double e[3], across[3], v[2];
    for (int k = 0; k < 3; k++) e[k] = p[k] - shape->point[k];
    const double h = dot(e, shape->axis);
    for (int k = 0; k < 3; k++) across[k] = e[k] - h * shape->axis[k];
    const double rho = sqrt(dot(across, across));
    for (int k = 0; k < 3; k++) across[k] /= rho > 0 ? rho : 1;
    double value;
    switch (shape->kind) {
    case SWARF_FACE_PLANE: memcpy(gradient, shape->axis, 3 * sizeof *gradient); return h;
    case SWARF_FACE_CYLINDER: memcpy(gradient, across, sizeof across); return rho - shape->radius;
    case SWARF_FACE_SPHERE:
        value = sqrt(dot(e, e));
        for (int k = 0; k < 3; k++) gradient[k] = e[k] / value;
        return value - shape->radius;
    case SWARF_FACE_CONE:
        value = hypot(1, shape->second);
        v[0] = 1 / value;
        v[1] = -shape->second / value * (h < 0 ? -1 : 1);
        value = v[0] * rho + v[1] * h;
        break;
    default:
        value = hypot(rho - shape->radius, h);
        v[0] = (rho - shape->radius) / value;
        v[1] = h / value;
        value -= shape->second;
    }
    for (int k = 0; k < 3; k++) gradient[k] = v[0] * across[k] + v[1] * shape->axis[k];
    return value;
}

typedef struct tally {
    long seen, of_kind[SWARF_FACE_TORUS + 1];
    double off, turned; /* greatest distance, mm, and least cosine of normals */
} tally;

static void check_point(const swarf_surface *surface, const swarf_surface_near *near, const double p[3], tally *out)
{
    swarf_surface_point seen, hit;
    double ends[2][3], t, gradient[3], at[3];
    swarf_surface_evaluate(near, p, &seen);
    for (int k = 0; k < 3; k++) {
        ends[0][k] = p[k] - 0.25 * seen.normal[k];
        ends[1][k] = p[k] + 0.25 * seen.normal[k];
    }
    if (!swarf_surface_crossing(near, ends[0], ends[1], 1e-12, &t, &hit)) return;
    for (int k = 0; k < 3; k++) at[k] = ends[0][k] + t * (ends[1][k] - ends[0][k]);
    const swarf_face_shape shape = swarf_surface_shape(surface, &hit);
    CHECK(shape.kind == (int)swarf_surface_face(surface, &hit));
    out->seen++;
    out->of_kind[shape.kind]++;
    if (shape.kind == SWARF_FACE_OTHER) return;
    const double away = fabs(shape_distance(&shape, at, gradient));
    const double cosine = dot(gradient, hit.normal);
    out->off = fmax(out->off, away);
    out->turned = fmin(out->turned, shape.kind == SWARF_FACE_PLANE ? cosine : fabs(cosine));
    if (shape.kind != SWARF_FACE_SPHERE) CHECK_NEAR(dot(shape.axis, shape.axis), 1, 1e-12);
}

static void check_case(int number, test_random *random, tally *all)
{
    enum { POINTS = 60 };
    const swarf_box block = {{-25, -25, -25}, {25, 25, 25}};
    const char *cutter_name, *motion_name;
    int curved;
    tally own = {.turned = 1};
    swarf_cutter *cutter = case_cutter(number / CASE_MOTIONS, &cutter_name);
    const swarf_path path = case_motion(number % CASE_MOTIONS, random, &motion_name, &curved);
    const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
    swarf_stock *stock = NULL;
    swarf_program *program = NULL, *nothing = NULL;
    swarf_surface *surface = NULL, *next = NULL;
    const swarf_section section = {.tool = 1};
    const swarf_tool tool = {1, 0, cutter};
    const double turn[12] = {0.6, -0.8, 0, 3, 0, 0, -1, -2, 0.8, 0.6, 0, 1};
    swarf_placement placement;
    CHECK_OK(swarf_placement_create(turn, &placement));
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 1;
    CHECK_OK(swarf_stock_create_box(&block, &options, &stock));
    CHECK_OK(swarf_program_create(path.start, &program));
    CHECK_OK(swarf_program_create(path.start, &nothing));
    CHECK_OK(swarf_program_add_operation(program, "cut"));
    CHECK_OK(swarf_program_set_section(program, &section));
    if (path.is_arc)
        CHECK_OK(swarf_program_add_arc(program, path.end, path.arc.centre, (swarf_plane)path.arc.plane,
                                       path.arc.angle_rad > 0,
                                       (int)ceil(fabs(path.arc.angle_rad) / 6.283185307179586 - 1e-9), 600, 1));
    else
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, path.end, 600, 1));
    CHECK_OK(swarf_surface_create(stock, program, &tool, 1, NULL, &surface));
    CHECK_OK(swarf_surface_create_next(surface, SIZE_MAX, &placement, nothing, NULL, 0, NULL, &next));
    for (int i = 0; surface && next && i < POINTS; i++) {
        double p[3];
        oracle_random_point(&body, &path, 0.1, random, p);
        for (int turned = 0; turned < 2; turned++) {
            const swarf_surface *of = turned ? next : surface;
            swarf_surface_near *near = NULL;
            if (turned) swarf_placement_point(&placement, p, p);
            const swarf_box box = {{p[0] - 0.5, p[1] - 0.5, p[2] - 0.5}, {p[0] + 0.5, p[1] + 0.5, p[2] + 0.5}};
            CHECK_OK(swarf_surface_near_create(of, &near));
            CHECK_OK(swarf_surface_gather(near, SIZE_MAX, &box));
            check_point(of, near, p, &own);
            swarf_surface_near_destroy(near);
        }
    }
    if (!CHECK(own.off < 1e-5 && own.turned > 1 - 1e-5))
        printf("%s, %s: off by %g mm, cosine %g\n", cutter_name, motion_name, own.off, own.turned);
    all->seen += own.seen;
    for (int k = 0; k <= SWARF_FACE_TORUS; k++) all->of_kind[k] += own.of_kind[k];
    swarf_surface_release(next);
    swarf_surface_release(surface);
    swarf_program_release(nothing);
    swarf_program_release(program);
    swarf_stock_destroy(stock);
    swarf_cutter_release(cutter);
}

int main(void)
{
    test_random random = test_random_begin(23);
    tally all = {0};
    for (int number = 0; number < CASE_CUTTERS * CASE_MOTIONS; number++) check_case(number, &random, &all);
    printf("%ld points: other %ld, planes %ld, cylinders %ld, cones %ld, spheres %ld, tori %ld\n", all.seen,
           all.of_kind[0], all.of_kind[1], all.of_kind[2], all.of_kind[3], all.of_kind[4], all.of_kind[5]);
    for (int k = 1; k <= SWARF_FACE_TORUS; k++) CHECK(all.of_kind[k] > 50);
    CHECK(2 * all.of_kind[0] < all.seen);
    const swarf_surface_point none = {.move = -2};
    CHECK(swarf_surface_shape(NULL, &none).kind == SWARF_FACE_OTHER);
    return test_end();
}
