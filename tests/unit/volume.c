/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Removed volumes against closed forms, and surface points against the oracle, at 200 voxels per tool diameter.
 *
 * Level and flat-arc moves: at each height the swept area is 2 r L + pi r^2, whatever the profile, so
 * V = 2 L A + V_tool with A the area of the half meridian (Pappus for the circle). Slanted lines of convex tools:
 * V = V_tool + L times the area of the tool's shadow along the path (Cauchy). Tools are cut deep inside the block, so
 * undercuts and the top count too. Moves that enter from above have forms of their own below.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases.h"

static const double pi = 3.14159265358979323846;
static const double voxel = 0.02; /* 200 to the 4 mm of the tools */

/* The promises: volume, relative, and surface points on smooth parts, in voxels. */
static const double volume_bound = 1e-4, surface_bound = 0.05;

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Shadow of a convex body of revolution along a unit direction with vertical part s: half the integral of |n . v|. */
static double shadow(const oracle_body *body, double s)
{
    const double c = sqrt(fmax(0, 1 - s * s));
    double sum = 0;
    for (int i = 0; i < body->part_begin[body->parts]; i++) {
        const oracle_edge *e = &body->edge[i];
        const int steps = e->radius > 0 ? 400 : 1, azimuths = 2000;
        for (int k = 0; k < steps; k++) {
            double nr, nz, ring; /* normal, and radius times length, of a piece */
            if (e->radius > 0) {
                const double angle = e->start_rad + e->turn_rad * (k + 0.5) / steps;
                nr = cos(angle), nz = sin(angle);
                ring = (e->centre[0] + e->radius * nr) * e->radius * fabs(e->turn_rad) / steps;
            } else {
                const double dr = e->to[0] - e->from[0], dz = e->to[1] - e->from[1], l = hypot(dr, dz);
                nr = dz / l, nz = -dr / l;
                ring = 0.5 * (e->from[0] + e->to[0]) * l;
            }
            for (int a = 0; a < azimuths; a++)
                sum += 0.5 * ring * fabs(nr * c * cos(2 * pi * (a + 0.5) / azimuths) + nz * s) * 2 * pi / azimuths;
        }
    }
    return sum;
}

/* A plunge by `depth`: at each height the widest part that passes it, by a sliding maximum over the radii. */
static double plunged(const oracle_body *body, double depth)
{
    enum { CELLS = 400000 };
    static double radius[CELLS];
    static int queue[CELLS]; /* cells of falling radius, the widest first */
    const double height = body->z_hi - body->z_lo, step = (height + depth) / CELLS;
    const int tall = (int)(height / step), window = (int)(depth / step);
    int first = 0, last = 0;
    double sum = 0;
    for (int i = 0; i < tall; i++) radius[i] = oracle_radius_at(body, body->z_lo + (i + 0.5) * step);
    for (int i = 0; i < CELLS; i++) { /* heights above the low end of the tool at the bottom */
        if (i < tall) {
            while (last > first && radius[queue[last - 1]] <= radius[i]) last--;
            queue[last++] = i;
        }
        while (first < last && queue[first] < i - window) first++;
        if (first < last) sum += pi * radius[queue[first]] * radius[queue[first]] * step;
    }
    return sum;
}

static swarf_stock *make_stock(const swarf_box *box)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(box, &options, &stock))) exit(test_end());
    return stock;
}

/* Zero crossings along grid edges near the sweep, against the oracle; the block's faces are left out. */
static void check_surface(const char *what, swarf_stock *stock, const swarf_box *box, const oracle_body *body,
                          const swarf_path *path, test_random *random)
{
    enum { TRIES = 4000 };
    const int wanted = test_size() == TEST_LIGHT ? 60 : test_size() == TEST_FULL ? 300 : 120;
    int found = 0;
    double worst = 0, worst_at[3] = {0};
    for (int i = 0; i < TRIES && found < wanted; i++) {
        double near[3], ends[2][3], at[3];
        oracle_random_point(body, path, 0.5 * voxel, random, near);
        const int axis = (int)test_random_below(random, 3);
        int inside = 1;
        for (int k = 0; k < 3; k++) {
            const double cell = floor((near[k] - box->lo[k]) / voxel) + 0.5;
            ends[0][k] = box->lo[k] + cell * voxel;
            ends[1][k] = ends[0][k] + (k == axis ? voxel : 0);
            inside &= near[k] > box->lo[k] + 4 * voxel && near[k] < box->hi[k] - 4 * voxel;
        }
        float value[2];
        if (!inside || !CHECK_OK(swarf_stock_sample(stock, ends[0], 2, value)) || (value[0] < 0) == (value[1] < 0))
            continue;
        const double t = (double)value[0] / ((double)value[0] - (double)value[1]);
        for (int k = 0; k < 3; k++) at[k] = ends[0][k] + t * (ends[1][k] - ends[0][k]);
        const double off = oracle_distance(body, path, at);
        if (!oracle_is_smooth(body, path, at, off, voxel)) continue;
        found++;
        if (fabs(off) > worst) {
            worst = fabs(off);
            memcpy(worst_at, at, sizeof at);
        }
    }
    const int good = CHECK(found >= 20) & CHECK(worst <= surface_bound * voxel);
    if (!good) {
        printf("    of %s: %d crossings, worst off by %.4g voxels: ", what, found, worst / voxel);
        oracle_print(stdout, what, path, voxel, worst_at);
    }
}

static void check_removed(const char *what, const swarf_cutter *cutter, const swarf_box *box, const swarf_path *path,
                          double exact, test_random *random)
{
    const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
    swarf_stock *stock = make_stock(box);
    double before = 0, after = 0;
    const double block = (box->hi[0] - box->lo[0]) * (box->hi[1] - box->lo[1]) * (box->hi[2] - box->lo[2]);
    CHECK_OK(swarf_stock_volume(stock, &before));
    CHECK_NEAR(before, block, volume_bound * block);
    CHECK_OK(swarf_stock_cut(stock, cutter, path, 1, NULL));
    CHECK_OK(swarf_stock_volume(stock, &after));
    if (!CHECK_NEAR(before - after, exact, volume_bound * exact))
        printf("    of %s: relative %.3g\n", what, (before - after) / exact - 1);
    check_surface(what, stock, box, &body, path, random);
    swarf_stock_destroy(stock);
}

/* The block that holds a whole sweep with a margin that is no whole number of voxels. */
static swarf_box around(const oracle_body *body, const swarf_path *path)
{
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i <= 1000; i++) {
        double tip[3];
        oracle_tip(path, i / 1000.0, tip);
        for (int k = 0; k < 3; k++) {
            box.lo[k] = fmin(box.lo[k], tip[k] + (k < 2 ? -body->radius : body->z_lo) - 0.1137);
            box.hi[k] = fmax(box.hi[k], tip[k] + (k < 2 ? body->radius : body->z_hi) + 0.1251);
        }
    }
    return box;
}

static void check_inside(int index, test_random *random)
{
    const char *name;
    char what[160];
    swarf_cutter *cutter = case_cutter(index, &name);
    const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
    const double tool = swarf_cutter_volume(cutter, SWARF_PART_FLUTES), area = oracle_meridian_area(&body);
    const double start[3] = {0.313, -0.207, 0.119}, centre[3] = {0.313, 2.293, 0}; /* radius 2.5 */
    struct {
        const char *name;
        swarf_path path;
        double exact;
    } cases[] = {
        {"standing", oracle_line(0.31, 0.2, 0.1, 0.31, 0.2, 0.1), tool},
        {"level line", oracle_line(0.31, 0.2, 0.1, 1.31, 1.4, 0.1), tool + 2 * hypot(1, 1.2) * area},
        {"arc", oracle_arc(start, centre, SWARF_PLANE_XY, -1.1, 0), tool + 2 * 2.5 * 1.1 * area},
        {"full circle", oracle_arc(start, centre, SWARF_PLANE_XY, 2 * pi, 0), 2 * 2.5 * 2 * pi * area},
        {"plunge", oracle_line(0.31, 0.2, 1.1, 0.31, 0.2, 0.03), plunged(&body, 1.07)},
        {"ramp", oracle_line(0.31, 0.2, 0.1, 1.31, 1.4, 0.4), 0},
        {"steep ramp", oracle_line(0.31, 0.2, 1.6, 0.91, 0.4, 0.1), 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        if (cases[i].exact == 0) {
            if (index > 6) continue; /* not convex: no closed form */
            double v[3];
            for (int k = 0; k < 3; k++) v[k] = cases[i].path.end[k] - cases[i].path.start[k];
            const double length = length_of(v);
            cases[i].exact = tool + length * shadow(&body, v[2] / length);
        }
        const swarf_box box = around(&body, &cases[i].path);
        snprintf(what, sizeof what, "%s, %s", name, cases[i].name);
        check_removed(what, cutter, &box, &cases[i].path, cases[i].exact, random);
    }
    swarf_cutter_release(cutter);
}

/* Area below the height `low + cut` of a circle of radius r whose lowest point is at `low`. */
static double segment(double r, double cut)
{
    return r * r * acos((r - cut) / r) - (r - cut) * sqrt(fmax(0, 2 * r * cut - cut * cut));
}

/* Dipping into the block along half a circle in a vertical plane. Slices across the tool: the flat end of half width w
 * sweeps the dip and 2 w more of its greatest depth; the ball's slice is a half disc, whose sweep is a larger circle.
 */
static void check_dips(test_random *random)
{
    const double tool = 2, dip = 1.6, depth = 1.2, steps = 20000;
    const double top = 0.171, centre_z = top - depth + dip; /* of the tip's circle */
    double exact_flat = pi * tool * tool * depth + 2 * tool * segment(dip, depth), exact_ball = 0;
    for (int i = 0; i < steps; i++) {
        const double u = pi * ((i + 0.5) / steps - 0.5), half = tool * cos(u);
        /* the ball's centre runs `tool` above the tip; its slice reaches up to half - tool below the tip's circle */
        exact_ball +=
            segment(dip + half, depth - tool + half > 0 ? depth - tool + half : 0) * tool * cos(u) * pi / steps;
    }
    const swarf_plane planes[] = {SWARF_PLANE_ZX, SWARF_PLANE_YZ};
    for (int p = 0; p < 2; p++) {
        const double start[3] = {p ? 0.043 : -dip + 0.043, p ? -dip + 0.043 : 0.043, centre_z};
        const double centre[3] = {0.043, 0.043, centre_z};
        /* About +y the lower half runs from -x through -z with a falling angle; about +x from -y with a rising one. */
        const swarf_path path = oracle_arc(start, centre, planes[p], p ? pi : -pi, 0);
        double lowest[3];
        oracle_tip(&path, 0.5, lowest);
        CHECK_NEAR(lowest[2], top - depth, 1e-9);
        const swarf_box box = {{-4.1, -4.1, -1.6}, {4.1, 4.1, top}};
        const char *name;
        swarf_cutter *flat = case_cutter(0, &name), *ball = case_cutter(1, &name);
        check_removed(p ? "flat, dip in YZ" : "flat, dip in ZX", flat, &box, &path, exact_flat, random);
        check_removed(p ? "ball, dip in YZ" : "ball, dip in ZX", ball, &box, &path, exact_ball, random);
        swarf_cutter_release(flat);
        swarf_cutter_release(ball);
    }
}

/* A flat end mill boring down a helix from above the block: a column is cut to the last height at which the disc passed
 * over it. Where the disc covers the column for half an angle h(s), the average height above the end is that of a lag
 * spread evenly over the 2 pi - 2 h of the turn in which it is away. */
static void check_helix(test_random *random)
{
    const double tool = 2, turns = 3, pitch = 0.5, top = 0.9;
    for (int wide = 0; wide < 2; wide++) {
        const double ring = wide ? 2.7 : 1.1;
        const double start[3] = {ring, 0, top + pitch + 0.01};
        const swarf_path path =
            oracle_arc(start, (double[3]){0, 0, 0}, SWARF_PLANE_XY, (wide ? -2 : 2) * pi * turns, -pitch * turns);
        const double depth = top - path.end[2], slope = pitch / (2 * pi);
        const double inner = fabs(ring - tool), outer = ring + tool;
        double exact = ring < tool ? pi * inner * inner * depth : 0;
        const int steps = 20000;
        for (int i = 0; i < steps; i++) {
            const double u = pi * ((i + 0.5) / steps - 0.5);
            const double s = 0.5 * (inner + outer) + 0.5 * (outer - inner) * sin(u);
            const double half = acos((s * s + ring * ring - tool * tool) / (2 * s * ring)), away = 2 * pi - 2 * half;
            exact += s * (2 * pi * depth - slope * away * away / 2) * 0.5 * (outer - inner) * cos(u) * pi / steps;
        }
        const double reach = outer + 0.1137;
        const swarf_box box = {{-reach, -reach, path.end[2] - 0.3}, {reach, reach, top}};
        const char *name;
        swarf_cutter *flat = case_cutter(0, &name);
        check_removed(wide ? "flat, wide helix" : "flat, helix", flat, &box, &path, exact, random);
        swarf_cutter_release(flat);
    }
}

/* A flat end that ramps right through a block leaves half an elliptic cylinder with tall walls, to which it is tangent:
 * with few voxels too the material below that edge is none of the cut. Removed, per length: the rectangle above the
 * disc's middle line, and m times half the disc below it. */
static void check_ramp_through(double slope)
{
    const double radius = 2, length = 30, end = -4, middle = end - slope * length / 2;
    const swarf_box box = {{0, 0, -40}, {length, 15, 0}};
    const double removed = length * (2 * radius * -middle + slope * pi * radius * radius / 2);
    const swarf_path path = oracle_line(-8, 7.03, end - slope * (length + 8), length + 8, 7.03, end + slope * 8);
    swarf_cutter *cutter = NULL;
    swarf_stock *stock = NULL;
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = radius / 12;
    double volume = NAN;
    CHECK_OK(swarf_cutter_parse("flat:d=4,l=60", &cutter));
    CHECK_OK(swarf_stock_create_box(&box, &options, &stock));
    CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
    CHECK_OK(swarf_stock_volume(stock, &volume));
    const double found = length * 15 * 40 - volume;
    printf("ramp of slope %g, 24 voxels wide: %.2e of %.4g mm3\n", slope, found / removed - 1, removed);
    CHECK_NEAR(found, removed, 6e-4 * removed);
    swarf_stock_destroy(stock);
    swarf_cutter_release(cutter);
}

/* A ramp over the very centres of voxels leaves what one a thousandth of a voxel beside it does. */
static void check_ramp_on_centres(const char *tool, double slope)
{
    const swarf_box box = {{0, 0, -60}, {60, 40, 0}};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 1;
    double volume[2] = {NAN, NAN};
    swarf_cutter *cutter = NULL;
    CHECK_OK(swarf_cutter_parse(tool, &cutter));
    for (int k = 0; k < 2; k++) {
        const double y = 20.5 + 0.001 * k;
        const swarf_path path = oracle_line(10, y, -5 - 40 * slope, 50, y, -5);
        swarf_stock *stock = NULL;
        CHECK_OK(swarf_stock_create_box(&box, &options, &stock));
        CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
        CHECK_OK(swarf_stock_volume(stock, &volume[k]));
        swarf_stock_destroy(stock);
    }
    CHECK_NEAR(volume[0], volume[1], 0.5);
    swarf_cutter_release(cutter);
}

int main(int count, char **argument)
{
    test_random random = test_random_begin(99);
    for (int i = 0; i < CASE_CUTTERS; i++)
        if (count < 2 || atoi(argument[1]) == i) check_inside(i, &random);
    if (count < 2 || atoi(argument[1]) < 0) {
        check_dips(&random);
        check_helix(&random);
        for (int i = 0; i < 3; i++) check_ramp_through((const double[]){0.1, 0.3, 1}[i]);
        check_ramp_on_centres("flat:d=10,l=80", 0.3);
        check_ramp_on_centres("flat:d=6,l=80", 1);
        check_ramp_on_centres("ball:d=10,l=12", 0.5); /* whose shaft ends in the block */
    }
    return test_end();
}
