/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "cases.h"

#include <math.h>
#include <stdlib.h>

typedef struct cutter_case {
    const char *name;
    swarf_shape shape;
    double d, l, r, t, a, n, h, p, k;
} cutter_case;

/* 0 stands for "not given". */
static const cutter_case cutters[CASE_CUTTERS] = {
    {.name = "flat", .shape = SWARF_SHAPE_FLAT, .d = 4, .l = 6},
    {.name = "ball", .shape = SWARF_SHAPE_BALL, .d = 4, .l = 6},
    {.name = "bull", .shape = SWARF_SHAPE_BULL, .d = 4, .l = 6, .r = 0.7},
    {.name = "chamfer pointed", .shape = SWARF_SHAPE_CHAMFER, .d = 4, .l = 5, .a = 90},
    {.name = "chamfer with tip flat", .shape = SWARF_SHAPE_CHAMFER, .d = 4, .l = 5, .a = 60, .t = 1},
    {.name = "drill", .shape = SWARF_SHAPE_DRILL, .d = 4, .l = 6},
    {.name = "tapered ball", .shape = SWARF_SHAPE_TAPERED_BALL, .t = 2, .a = 10, .l = 6},
    {.name = "lollipop", .shape = SWARF_SHAPE_LOLLIPOP, .d = 4, .n = 2, .l = 6},
    {.name = "tslot", .shape = SWARF_SHAPE_TSLOT, .d = 4, .n = 2, .h = 1, .l = 5},
    {.name = "tslot rounded", .shape = SWARF_SHAPE_TSLOT, .d = 4, .n = 2, .h = 1.2, .l = 5, .r = 0.3},
    {.name = "dovetail", .shape = SWARF_SHAPE_DOVETAIL, .d = 4, .a = 60, .h = 1.5, .n = 2, .l = 5},
    {.name = "thread mill, 3 teeth", .shape = SWARF_SHAPE_THREAD_MILL, .d = 4, .p = 1, .k = 3, .n = 2.4, .l = 5},
    {.name = "form with a concave arc", .shape = SWARF_SHAPE_FORM},
    {.name = "form with a bulging arc and an undercut", .shape = SWARF_SHAPE_FORM},
};

static double given(double value)
{
    return value > 0 ? value : NAN;
}

static swarf_status make_form(int index, swarf_cutter **out)
{
    static const swarf_profile_node concave[] = {
        {0, 0, 0}, {1, 0, -0.41421356237309503}, {2, 1, 0}, {2, 5, 0}, {0, 5, 0}};
    static const swarf_profile_node bulging[] = {{0, 0, 0.2},   {1.2, 0.5, 0.6}, {1.2, 2.5, 0}, {0.8, 3, 0},
                                                 {1.6, 3.8, 0}, {1.6, 5, 0},     {0, 5, 0}};
    const int second = index == CASE_CUTTERS - 1;
    const swarf_cutter_part part = {SWARF_PART_FLUTES, second ? bulging : concave, second ? 7 : 5};
    return swarf_cutter_create(&part, 1, out);
}

swarf_cutter *case_cutter(int index, const char **name)
{
    const cutter_case *c = &cutters[index];
    swarf_dimensions dimensions = swarf_dimensions_default();
    dimensions.diameter = given(c->d);
    dimensions.length = given(c->l);
    dimensions.corner_radius = given(c->r);
    dimensions.tip_diameter = given(c->t);
    dimensions.angle_deg = given(c->a);
    dimensions.neck_diameter = given(c->n);
    dimensions.edge_height = given(c->h);
    dimensions.pitch = given(c->p);
    dimensions.teeth = given(c->k);
    swarf_cutter *cutter = NULL;
    const swarf_status status = c->shape == SWARF_SHAPE_FORM
                                    ? make_form(index, &cutter)
                                    : swarf_cutter_create_shape(c->shape, &dimensions, &cutter);
    if (status != SWARF_OK) {
        fprintf(stderr, "cutter %s: %s\n", c->name, swarf_error_last());
        exit(2);
    }
    *name = c->name;
    return cutter;
}

static swarf_path random_arc(test_random *random, int plane, double rise)
{
    const double start[3] = {test_random_in(random, -5, 5), test_random_in(random, -5, 5),
                             test_random_in(random, -5, 5)};
    const double radius = test_random_in(random, 0.2, 6), angle = test_random_in(random, -3.14, 3.14);
    const int u = plane == SWARF_PLANE_XY ? 0 : plane == SWARF_PLANE_ZX ? 2 : 1;
    double centre[3] = {start[0], start[1], start[2]};
    centre[u] += radius * cos(angle);
    centre[(u + 1) % 3] += radius * sin(angle);
    return oracle_arc(start, centre, (swarf_plane)plane, test_random_in(random, -6.28, 6.28), rise);
}

swarf_path case_motion(int index, test_random *random, const char **name, int *curved)
{
    const double pi = 3.14159265358979323846;
    const double origin[3] = {1.03, -0.71, 0.37};
    *curved = 0;
    switch (index) {
    case 0: *name = "horizontal line"; return oracle_line(1.1, 2.3, -0.7, 6.2, 2.3, -0.7);
    case 1: *name = "diagonal line"; return oracle_line(1.1, 2.3, -0.7, -2.2, 5.9, -0.7);
    case 2: *name = "ramp"; return oracle_line(0.3, -0.2, 1.1, 5.1, 1.4, -0.4);
    case 3: *name = "steep ramp"; return oracle_line(0.3, -0.2, 5.1, 1.1, 0.4, -0.4);
    case 4: *name = "plunge"; return oracle_line(0.31, -0.22, 3.7, 0.31, -0.22, -0.4);
    case 5: *name = "zero length"; return oracle_line(0.31, -0.22, 3.7, 0.31, -0.22, 3.7);
    case 6: *name = "arc"; return oracle_arc(origin, (double[3]){-3.1, 0.6, 0}, SWARF_PLANE_XY, 1.9, 0);
    case 7:
        *name = "tight arc, clockwise";
        return oracle_arc(origin, (double[3]){1.6, 0.1, 0}, SWARF_PLANE_XY, -3.7, 0);
    case 8: *name = "full circle"; return oracle_arc(origin, (double[3]){-2.1, 0.6, 0}, SWARF_PLANE_XY, 2 * pi, 0);
    case 9:
        *name = "helix", *curved = 1;
        return oracle_arc(origin, (double[3]){-1.6, 0.6, 0}, SWARF_PLANE_XY, -5.1, -1.3);
    case 10:
        *name = "helix of several turns", *curved = 1;
        return oracle_arc(origin, (double[3]){-0.2, 0.4, 0}, SWARF_PLANE_XY, 7 * pi, -3.9);
    case 11:
        *name = "arc in ZX", *curved = 1;
        return oracle_arc(origin, (double[3]){3.3, 0, 2.1}, SWARF_PLANE_ZX, -2.2, 0);
    case 12:
        *name = "arc in YZ", *curved = 1;
        return oracle_arc(origin, (double[3]){0, -3.6, 0.9}, SWARF_PLANE_YZ, 2.9, 0);
    case 13:
        *name = "helix in ZX", *curved = 1;
        return oracle_arc(origin, (double[3]){3.3, 0, 2.1}, SWARF_PLANE_ZX, 3.2, 2.2);
    case 14: {
        double c[6];
        for (int i = 0; i < 6; i++) c[i] = test_random_in(random, -5, 5);
        *name = "random line";
        return oracle_line(c[0], c[1], c[2], c[3], c[4], c[5]);
    }
    case 15: *name = "random arc"; return random_arc(random, SWARF_PLANE_XY, 0);
    default: {
        const int plane = (int)test_random_below(random, 3);
        *name = "random helix", *curved = 1;
        return random_arc(random, plane, test_random_in(random, -3, 3));
    }
    }
}
