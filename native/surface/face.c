/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What face a piece of a cutter leaves on a move.
 *
 * A standing cutter leaves its own faces. Along a straight line a straight piece of the meridian leaves planes, an arc
 * leaves a cylinder where the line is level or the arc is a ball's. On level arcs all pieces turn about the arc's axis,
 * on helices upright ones do. What edges leave has a normal that is not the piece's own: it is told by that, and is no
 * face of these kinds. */
#include "surface/surface.h"

#include "base/parallel.h"
#include "base/status.h"

#include <math.h>
#include <string.h>

/* How near numbers of one thing are: parts of a move, coordinates of unit vectors; mm for centres of arcs. */
static const double same = 1e-6;

/* The shape of a straight piece or an arc that turns about the upright axis through `foot`, `out` mm away from it: 0
 * for a cutter that stands there. Outside (1) it is the cutter's outer side that is seen from there, else (-1) its
 * inner. */
static void turn_about(const swarf_exact_piece *piece, const double foot[3], double out, double side,
                       swarf_face_shape *shape)
{
    memcpy(shape->point, foot, sizeof shape->point);
    shape->axis[2] = 1;
    if (piece->is_arc) {
        shape->point[2] += piece->centre_z;
        shape->radius = fabs(out + side * piece->centre_r);
        shape->second = piece->radius;
        shape->kind = shape->radius < same ? SWARF_FACE_SPHERE : SWARF_FACE_TORUS;
        if (shape->kind == SWARF_FACE_SPHERE) {
            shape->radius = piece->radius;
            shape->second = 0;
        }
    } else if (fabs(piece->first_r) < same) {
        shape->kind = SWARF_FACE_PLANE;
        shape->point[2] += piece->first_z * piece->radius;
        shape->axis[2] = -piece->first_z;
    } else if (fabs(piece->first_z) < same) {
        shape->kind = SWARF_FACE_CYLINDER;
        shape->radius = fabs(out + side * piece->radius);
    } else {
        shape->kind = SWARF_FACE_CONE;
        shape->point[2] += (piece->radius + side * out * piece->first_r) / piece->first_z;
        shape->second = fabs(piece->first_z / piece->first_r);
    }
}

/* Along a straight line in the direction `along` (unit): a plane, or a cylinder about it. */
static void push_along(const swarf_exact_piece *piece, const double start[3], const double along[3],
                       const double normal[3], swarf_face_shape *shape)
{
    const double run = hypot(along[0], along[1]), ux = along[0] / run, uy = along[1] / run;
    const double side = normal[1] * ux - normal[0] * uy > 0 ? -1 : 1; /* the cutter's normal is turned round */
    if (piece->is_arc) {
        if (along[2] != 0 && fabs(piece->centre_r) >= same) return;
        shape->kind = SWARF_FACE_CYLINDER;
        memcpy(shape->axis, along, sizeof shape->axis);
        shape->point[0] = start[0] - side * piece->centre_r * uy;
        shape->point[1] = start[1] + side * piece->centre_r * ux;
        shape->point[2] = start[2] + piece->centre_z;
        shape->radius = piece->radius;
        return;
    }
    double n[3] = {0, 0, piece->first_z};
    if (fabs(piece->first_r) >= same) { /* the one of its normals that stands across the line */
        const double ahead = -piece->first_z * along[2] / (piece->first_r * run);
        if (fabs(ahead) > 1) return;
        const double across = side * sqrt(1 - ahead * ahead);
        n[0] = piece->first_r * (ahead * ux - across * uy);
        n[1] = piece->first_r * (ahead * uy + across * ux);
    }
    shape->kind = SWARF_FACE_PLANE;
    for (int k = 0; k < 3; k++) {
        shape->point[k] = start[k] + piece->radius * n[k];
        shape->axis[k] = -n[k];
    }
}

/* Along an arc about an upright axis. */
static void turn_along(const swarf_exact_piece *piece, const swarf_path *path, double t, const double normal[3],
                       swarf_face_shape *shape)
{
    const double *c = path->arc.centre, foot[3] = {c[0], c[1], path->start[2]};
    const double angle = atan2(path->start[1] - c[1], path->start[0] - c[0]) + t * path->arc.angle_rad;
    const double side = normal[0] * cos(angle) + normal[1] * sin(angle) < 0 ? 1 : -1;
    turn_about(piece, foot, hypot(path->start[0] - c[0], path->start[1] - c[1]), side, shape);
}

static void left_by(const swarf_trace *trace, const swarf_path *path, const swarf_exact_piece *piece, double t,
                    const double normal[3], swarf_face_shape *shape)
{
    if (t < same || t > 1 - same || (trace->kind == TRACE_LEVEL && trace->run == 0)) {
        turn_about(piece, t < 0.5 ? path->start : path->end, 0, 1, shape);
    } else if (trace->kind == TRACE_LEVEL || trace->kind == TRACE_TILTED) {
        push_along(piece, trace->point, trace->along, normal, shape);
    } else if (trace->kind == TRACE_ARC) {
        turn_along(piece, path, t, normal, shape);
    } else if (path->arc.plane == SWARF_PLANE_XY && !piece->is_arc && fabs(piece->first_z) < same) {
        const double *c = path->arc.centre; /* the wall of a helix */
        const double first = hypot(path->start[0] - c[0], path->start[1] - c[1]);
        if (fabs(first - hypot(path->end[0] - c[0], path->end[1] - c[1])) < same)
            turn_along(piece, path, t, normal, shape);
    }
}

/* Of a move of the surface itself; `normal` in its coordinates. */
static void of_move(const swarf_surface *surface, size_t move, const swarf_surface_point *point, const double normal[3],
                    swarf_face_shape *shape)
{
    size_t lo = 0, hi = surface->part_count;
    while (lo < hi) {
        const size_t middle = (lo + hi) / 2;
        if (surface->parts[middle].move < move)
            lo = middle + 1;
        else
            hi = middle;
    }
    swarf_trace trace;
    swarf_path path;
    if (lo == surface->part_count || surface->parts[lo].move != move ||
        swarf_surface_trace(surface, lo, &trace) != SWARF_OK ||
        swarf_program_path(surface->program, move, &path) != SWARF_OK)
        return;
    if (point->piece < 0 || (size_t)point->piece >= trace.body->piece_count) return;
    swarf_exact_piece piece = trace.body->exact[point->piece];
    const int first = fabs(normal[2] + piece.first_z) < same, last = fabs(normal[2] + piece.last_z) < same;
    if (piece.is_arc && (first || last)) { /* the straight piece that goes on from an end of it */
        piece.is_arc = 0;
        if (!first) piece.first_r = piece.last_r;
        if (!first) piece.first_z = piece.last_z;
        piece.last_z = piece.first_z;
        piece.radius += piece.first_r * piece.centre_r + piece.first_z * piece.centre_z;
    }
    const double low = fmin(piece.first_z, piece.last_z), high = fmax(piece.first_z, piece.last_z);
    if (-normal[2] < low - same || -normal[2] > high + same) return; /* an edge left it */
    left_by(&trace, &path, &piece, point->t, normal, shape);
}

/* Of the block that a surface begins with. */
static void of_block(const swarf_surface *surface, int32_t piece, swarf_face_shape *shape)
{
    if (!surface->block || piece < 0 || piece > 5) return;
    const int axis = piece / 2, high = piece % 2;
    shape->kind = SWARF_FACE_PLANE;
    memcpy(shape->point, high ? surface->hi : surface->lo, sizeof shape->point);
    shape->axis[axis] = high ? 1 : -1;
}

/* In the coordinates of the surface, from those of the set-up before in which the shape was made. */
static void find_shape(const swarf_surface *surface, int set_up, int64_t move, const swarf_surface_point *point,
                       const double normal[3], swarf_face_shape *shape)
{
    if (set_up > 0 && surface->before) {
        double back[3];
        swarf_placement_direction(&surface->back, normal, back);
        find_shape(surface->before, set_up - 1, move, point, back, shape);
        swarf_placement_point(&surface->placement, shape->point, shape->point);
        swarf_placement_direction(&surface->placement, shape->axis, shape->axis);
    } else if (move < 0) {
        of_block(surface, point->piece, shape);
    } else {
        of_move(surface, (size_t)move, point, normal, shape);
    }
}

swarf_face_shape swarf_surface_shape(const swarf_surface *surface, const swarf_surface_point *point)
{
    swarf_face_shape shape = {.kind = SWARF_FACE_OTHER};
    if (!surface || !point || point->move == -2) return shape;
    int set_up;
    int64_t move;
    swarf_surface_origin(surface, point->move, &set_up, &move);
    find_shape(surface, set_up, move, point, point->normal, &shape);
    if (shape.kind == SWARF_FACE_OTHER) return (swarf_face_shape){.kind = SWARF_FACE_OTHER};
    return shape;
}

swarf_face_kind swarf_surface_face(const swarf_surface *surface, const swarf_surface_point *point)
{
    return (swarf_face_kind)swarf_surface_shape(surface, point).kind;
}

/* Points that one piece of work looks at. */
enum { POINTS = 4096 };

struct mark_work {
    const swarf_surface *surface;
    const swarf_surface_point *points;
    size_t count;
    swarf_surface_mark *out;
};

static swarf_status mark_points(void *context, size_t index)
{
    const struct mark_work *work = context;
    const size_t end = (index + 1) * POINTS < work->count ? (index + 1) * POINTS : work->count;
    for (size_t i = index * POINTS; i < end; i++) {
        const swarf_surface_point *point = &work->points[i];
        int set_up = 0;
        int64_t move = -2;
        if (point->move != -2) swarf_surface_origin(work->surface, point->move, &set_up, &move);
        work->out[i] = (swarf_surface_mark){set_up, (int32_t)move, point->piece,
                                            (int32_t)swarf_surface_face(work->surface, point)};
    }
    return SWARF_OK;
}

swarf_status swarf_surface_marks(const swarf_surface *surface, const swarf_surface_point *points, size_t count,
                                 const swarf_progress *progress, swarf_surface_mark *out)
{
    SWARF_REQUIRE(surface && ((points && out) || count == 0), "surface: NULL");
    struct mark_work work = {surface, points, count, out};
    return swarf_parallel_for((count + POINTS - 1) / POINTS, mark_points, &work, progress, 0, 1);
}
