/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Meshes of the field alone, as of a stock that was read from a .vdb file: milled blocks, as they lie and turned,
 * against their faces and edges in closed form; what OpenVDB's mesher makes of the same stock is printed beside. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "faces.h"
#include "placements.h"
#include "shapes.h"
#include "stocks.h"

static const double voxel = 0.2, pi = 3.14159265358979323846;
static const swarf_box block = {{-6.03, -5.07, -4.02}, {6.05, 5.01, 0.01}};

/* Faces as smooth functions, in mm: a plane through `a` with the normal `b`; and what cutters sweep along a - b: walls
 * and, below, the tip: a ball, or a cone of half the angle in radians. */
typedef struct face {
    enum { PLANE, WALL, BALL, CONE } kind;
    double a[3], b[3], radius, half_angle;
} face;

typedef struct body {
    face face[6];
    int count;
} body; /* all that is below all of its faces */

enum { MOST_CUTS = 5 };

typedef struct part {
    body first, cut[MOST_CUTS];
    int cuts;
    swarf_placement back; /* from where the stock lies to where it was cut */
} part;

static double plan_distance(const face *f, const double p[3])
{
    const double u[2] = {f->b[0] - f->a[0], f->b[1] - f->a[1]}, v[2] = {p[0] - f->a[0], p[1] - f->a[1]};
    const double square = u[0] * u[0] + u[1] * u[1];
    const double t = square > 0 ? fmin(fmax((u[0] * v[0] + u[1] * v[1]) / square, 0), 1) : 0;
    return hypot(v[0] - t * u[0], v[1] - t * u[1]);
}

static double face_value(const face *f, const double p[3])
{
    double sum = 0;
    switch (f->kind) {
    case PLANE:
        for (int k = 0; k < 3; k++) sum += f->b[k] * (p[k] - f->a[k]);
        return sum;
    case WALL: return plan_distance(f, p) - f->radius;
    case BALL: return hypot(plan_distance(f, p), fmin(p[2] - f->a[2] - f->radius, 0)) - f->radius;
    default: return plan_distance(f, p) * cos(f->half_angle) - (p[2] - f->a[2]) * sin(f->half_angle);
    }
}

/* Face `number` of a part, counted through its bodies; the material is below. NULL: there are no more. */
static const face *face_of(const part *t, int number, double *sign)
{
    *sign = 1;
    if (number < t->first.count) return &t->first.face[number];
    number -= t->first.count;
    *sign = -1;
    for (int i = 0; i < t->cuts; number -= t->cut[i++].count)
        if (number < t->cut[i].count) return &t->cut[i].face[number];
    return NULL;
}

static double body_value(const body *b, const double p[3])
{
    double most = -INFINITY;
    for (int i = 0; i < b->count; i++) most = fmax(most, face_value(&b->face[i], p));
    return most;
}

/* On the surface 0, beside faces the distance from them. */
static double true_value(const part *t, const double at[3])
{
    double p[3];
    swarf_placement_point(&t->back, at, p);
    double value = body_value(&t->first, p);
    for (int i = 0; i < t->cuts; i++) value = fmax(value, -body_value(&t->cut[i], p));
    return value;
}

/* Of one face, or (-1) of the whole part. */
static double part_value(const part *t, int number, const double at[3])
{
    if (number < 0) return true_value(t, at);
    double p[3], sign;
    const face *f = face_of(t, number, &sign);
    swarf_placement_point(&t->back, at, p);
    return sign * face_value(f, p);
}

static double faces_value(const void *of, int number, const double p[3])
{
    return part_value(of, number, p);
}

static faces faces_of(const part *t)
{
    faces out = {.value = faces_value, .of = t, .count = t->first.count, .voxel = voxel, .bend = 5e-4};
    for (int i = 0; i < t->cuts; i++) out.count += t->cut[i].count;
    return out;
}

/* What half of them, 99 of 100 and all are within. */
typedef struct spread {
    double median, most, worst;
    size_t count;
} spread;

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static spread spread_of(double *values, size_t count)
{
    if (!count) return (spread){0};
    qsort(values, count, sizeof *values, by_value);
    return (spread){values[count / 2], values[count - 1 - count / 100], values[count - 1], count};
}

typedef struct figures {
    spread off;          /* of vertices to the surface, in voxels */
    spread edge, corner; /* of those of an edge's cell to that, in voxels; where a third face is near */
    spread normal;       /* of triangles on flat faces, in degrees */
    double volume;
} figures;

/* Angle between a triangle and the flat face that it is on; negative where there is none. */
static double angle_of(const faces *t, const float *xyz, const uint32_t v[3])
{
    double corner[3][3], middle[3], n[3], true_n[3], other[3], size = 0, cosine = 0;
    for (int k = 0; k < 3; k++)
        for (size_t c = 0; c < 3; c++) corner[k][c] = (double)xyz[3 * (size_t)v[k] + c];
    for (int c = 0; c < 3; c++) middle[c] = (corner[0][c] + corner[1][c] + corner[2][c]) / 3;
    if (!faces_gradient(t, -1, middle, true_n)) return -1;
    for (int k = 0; k < 3; k++) {
        double towards[3], same = 0;
        for (int c = 0; c < 3; c++) towards[c] = corner[k][c] + 0.1 * (middle[c] - corner[k][c]);
        if (!faces_gradient(t, -1, towards, other)) return -1;
        for (int c = 0; c < 3; c++) same += other[c] * true_n[c];
        if (same < cos(0.5 * pi / 180)) return -1;
    }
    for (int c = 0; c < 3; c++) {
        const int a = (c + 1) % 3, b = (c + 2) % 3;
        n[c] = (corner[1][a] - corner[0][a]) * (corner[2][b] - corner[0][b]) -
               (corner[1][b] - corner[0][b]) * (corner[2][a] - corner[0][a]);
        size += n[c] * n[c];
    }
    if (size < 1e-3 * pow(voxel, 4)) return -1;
    for (int c = 0; c < 3; c++) cosine += n[c] * true_n[c] / sqrt(size);
    return acos(fmin(fmax(cosine, -1), 1)) * 180 / pi;
}

static figures measure(const part *truth, const double origin[3], const swarf_mesh *mesh)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    const size_t room = t.vertex_count + t.triangle_count;
    double *off = malloc(room * sizeof *off), *edge = malloc(room * sizeof *edge),
           *corner = malloc(room * sizeof *corner);
    size_t edges = 0, corners = 0, angles = 0;
    faces all = faces_of(truth);
    memcpy(all.origin, origin, sizeof all.origin);
    figures out = {.volume = swarf_mesh_topology(mesh).volume_mm3};
    if (!CHECK(off && edge && corner)) exit(test_end());
    for (size_t i = 0; i < t.vertex_count; i++) {
        const double p[3] = {(double)t.xyz[3 * i], (double)t.xyz[3 * i + 1], (double)t.xyz[3 * i + 2]};
        off[i] = fabs(true_value(truth, p)) / voxel;
        int is_near;
        const double away = faces_edge_distance(&all, p, &is_near);
        if (away < 0) continue;
        if (is_near)
            corner[corners++] = away;
        else
            edge[edges++] = away;
    }
    out.off = spread_of(off, t.vertex_count);
    out.edge = spread_of(edge, edges);
    out.corner = spread_of(corner, corners);
    for (size_t i = 0; i < t.triangle_count; i += 3) {
        off[angles] = angle_of(&all, t.xyz, t.index + 3 * i);
        angles += off[angles] >= 0;
    }
    out.normal = spread_of(off, angles);
    free(off);
    free(edge);
    free(corner);
    return out;
}

static void print(const char *name, const char *what, const figures *f)
{
    printf(
        "%-14s %-8s vertices off %.4f, 99 %% %.3f, worst %.3f voxels; %5zu at edges %.4f, %.3f, %.3f; %4zu at corners "
        "%.3f, %.3f, %.3f; normals %.3f, %.2f, %.1f degrees; %.5f mm3\n",
        name, what, f->off.median, f->off.most, f->off.worst, f->edge.count, f->edge.median, f->edge.most,
        f->edge.worst, f->corner.count, f->corner.median, f->corner.most, f->corner.worst, f->normal.median,
        f->normal.most, f->normal.worst, f->volume);
}

static body plane_body(const swarf_box *box)
{
    body out = {.count = 6};
    for (int i = 0; i < 6; i++) {
        out.face[i].b[i / 2] = i % 2 ? 1 : -1;
        memcpy(out.face[i].a, i % 2 ? box->hi : box->lo, sizeof box->lo);
    }
    return out;
}

/* What a cutter leaves along a level or upright line: its tip's face, or the floor, and the wall. */
static void add_cut(part *t, swarf_stock *stock, const char *text, int tip, const double a[3], const double b[3],
                    double radius, double half_angle)
{
    body *cut = &t->cut[t->cuts++];
    face wall = {.kind = WALL, .radius = radius}, floor = {.kind = PLANE, .b = {0, 0, -1}},
         point = {.half_angle = half_angle, .radius = radius};
    memcpy(wall.a, a, sizeof wall.a);
    memcpy(wall.b, b, sizeof wall.b);
    memcpy(floor.a, b, sizeof floor.a);
    memcpy(point.a, a, sizeof point.a);
    memcpy(point.b, b, sizeof point.b);
    point.kind = tip == BALL ? BALL : CONE;
    point.a[2] = point.b[2] = b[2];
    *cut = (body){.face = {tip == PLANE ? floor : point}, .count = 1};
    if (tip != BALL) cut->face[cut->count++] = wall;
    swarf_cutter *cutter = NULL;
    const swarf_path path = {.start = {a[0], a[1], a[2]}, .end = {b[0], b[1], b[2]}, .has_motion = 1};
    if (!CHECK_OK(swarf_cutter_parse(text, &cutter))) exit(test_end());
    CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
    swarf_cutter_release(cutter);
}

static void cut_all(part *t, swarf_stock *stock)
{
    add_cut(t, stock, "flat:d=3,l=19", PLANE, (double[]){-9, -2.7, -1.37}, (double[]){9, 0.9, -1.37}, 1.5, 0);
    add_cut(t, stock, "ball:d=4,l=19", BALL, (double[]){2.1, 9, -1.9}, (double[]){3.9, -9, -1.9}, 2, 0);
    add_cut(t, stock, "drill:d=2.4,l=19", CONE, (double[]){-3.9, 2.6, 5}, (double[]){-3.9, 2.6, -3.1}, 1.2,
            59 * pi / 180);
    add_cut(t, stock, "chamfer:d=8,l=19,a=90", CONE, (double[]){-9, 5.5, -1.3}, (double[]){9, 5.5, -1.3}, 4,
            45 * pi / 180);
    add_cut(t, stock, "flat:d=2,l=19", PLANE, (double[]){-4.5, -9, -2.2}, (double[]){-3.2, 0.3, -2.2}, 1, 0);
}

static const double no_shift[3] = {0};

/* A block that lies askew, as triangles. */
static swarf_stock *make_askew(part *t, const swarf_placement *there)
{
    shape s = {0};
    swarf_stock *stock = NULL;
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    shape_box(&s, block.lo, block.hi);
    for (size_t i = 0; i < s.vertices; i++) {
        double p[3] = {(double)s.xyz[3 * i], (double)s.xyz[3 * i + 1], (double)s.xyz[3 * i + 2]};
        swarf_placement_point(there, p, p);
        for (size_t k = 0; k < 3; k++) s.xyz[3 * i + k] = (float)p[k];
    }
    const swarf_triangles view = shape_view(&s);
    if (!CHECK_OK(swarf_stock_create_mesh(&view, &options, NULL, &stock))) exit(test_end());
    shape_free(&s);
    t->first = plane_body(&block);
    for (int i = 0; i < 6; i++) {
        swarf_placement_point(there, t->first.face[i].a, t->first.face[i].a);
        swarf_placement_direction(there, t->first.face[i].b, t->first.face[i].b);
    }
    return stock;
}

/* Greatest that may be, in voxels: of 99 of 100 vertices off the surface, off edges, off edges where a third face is
 * near, of which voxels see little. What was seen is a little less. */
typedef struct limits {
    double off, edge, corner;
} limits;

static swarf_mesh *make_mesh(swarf_stock *stock)
{
    const swarf_contour_options options = swarf_contour_options_default();
    swarf_contour_report report;
    swarf_mesh *mesh = NULL;
    if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &report))) exit(test_end());
    const swarf_topology topology = swarf_mesh_topology(mesh);
    CHECK(topology.closed && !topology.nonmanifold_edges && !topology.misoriented_edges && !topology.degenerate);
    CHECK(report.intersections_left == 0);
    return mesh;
}

static figures check_stock(const char *name, const part *truth, swarf_stock *stock, limits most)
{
    swarf_mesh *mesh = make_mesh(stock), *theirs = NULL;
    swarf_box cube;
    size_t cubes = 0;
    double origin[3];
    CHECK_OK(swarf_stock_changed(stock, 0, &cube, 1, &cubes));
    for (int k = 0; k < 3; k++) origin[k] = cube.lo[k] + 0.5 * voxel;
    if (!CHECK_OK(swarf_mesh_create_stock(stock, 0, NULL, &theirs))) exit(test_end());
    const figures f = measure(truth, origin, mesh), v = measure(truth, origin, theirs);
    print(name, "", &f);
    print(name, "OpenVDB", &v);
    CHECK(f.off.median < 1e-3 && f.off.most < most.off);
    CHECK(f.edge.count > 150 && f.edge.median < 5e-3 && f.edge.most < most.edge);
    CHECK(f.corner.median < 0.01 && f.corner.most < most.corner);
    CHECK(f.normal.median < 0.01);
    CHECK(v.edge.median > 0.3 && v.off.most > 2 * f.off.most);
    swarf_mesh_release(mesh);
    swarf_mesh_release(theirs);
    return f;
}

/* Through a file the mesh stays the same, to the bit, and for any number of threads. */
static void check_file(swarf_stock *stock)
{
    char path[] = "/tmp/swarf-field-XXXXXX.vdb";
    const int file = mkstemps(path, 4);
    if (!CHECK(file >= 0)) return;
    close(file);
    swarf_stock *read = NULL;
    CHECK_OK(swarf_stock_write(stock, path, NULL));
    CHECK_OK(swarf_stock_read(path, NULL, &read));
    unlink(path);
    CHECK_OK(swarf_threads_set(1));
    swarf_mesh *before = make_mesh(stock);
    CHECK_OK(swarf_threads_set(3));
    swarf_mesh *after = make_mesh(read);
    CHECK_OK(swarf_threads_set(0));
    CHECK(test_same_mesh(before, after));
    swarf_mesh_release(before);
    swarf_mesh_release(after);
    swarf_stock_destroy(read);
}

static const double block_mm3 = 12.08 * 10.08 * 4.03;

/* A block along the axes, milled, and set up again by its voxels alone. */
static void check_straight(void)
{
    const swarf_placement turn = placement_make((double[]){0.5, -0.4, 0.7}, no_shift);
    part t = {.first = plane_body(&block), .back = swarf_placement_identity()};
    swarf_stock *stock = stock_block(&block, voxel), *turned = NULL;
    CHECK_NEAR(check_stock("block", &t, stock, (limits){1e-4, 1e-3, 1e-3}).volume, block_mm3, 1e-6 * block_mm3);
    cut_all(&t, stock);
    check_stock("milled", &t, stock, (limits){0.02, 0.1, 0.35});
    check_file(stock);
    CHECK_OK(swarf_stock_place(stock, &turn, NULL, NULL, &turned, NULL));
    t.back = swarf_placement_inverse(&turn);
    check_stock("milled, turned", &t, turned, (limits){0.1, 0.16, 0.55});
    swarf_stock_destroy(turned);
    swarf_stock_destroy(stock);
}

/* A block that lies askew, milled from above. */
static void check_askew(const swarf_placement *there, limits whole, limits milled)
{
    part t = {.back = swarf_placement_identity()};
    swarf_stock *stock = make_askew(&t, there);
    CHECK_NEAR(check_stock("askew", &t, stock, whole).volume, block_mm3, 3e-4 * block_mm3);
    cut_all(&t, stock);
    check_stock("askew, milled", &t, stock, milled);
    swarf_stock_destroy(stock);
}

int main(void)
{
    const swarf_placement little = placement_make((double[]){0.05, 0.03, 0.3}, no_shift),
                          much = placement_make((double[]){0.5, -0.4, 0.7}, no_shift);
    check_straight();
    check_askew(&little, (limits){0.002, 0.02, 0.05}, (limits){0.03, 0.1, 0.5});
    check_askew(&much, (limits){0.01, 0.05, 0.1}, (limits){0.06, 0.12, 0.7});
    return test_end();
}
