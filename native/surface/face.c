/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What kind of face a piece of a cutter leaves on a move.
 *
 * A standing cutter leaves its own faces. Along a straight line a straight piece of the meridian leaves planes, an arc
 * leaves a cylinder where the line is level or the arc is a ball's. On level arcs all pieces turn about the arc's axis.
 * What edges leave has a normal that is not the piece's own: it is told by that, and is no face of these kinds. */
#include "surface/surface.h"

#include "base/parallel.h"
#include "base/status.h"

#include <math.h>
#include <string.h>

/* How near numbers of one thing are: parts of a move, coordinates of unit vectors; mm for centres of arcs. */
static const double same = 1e-6;

static swarf_face_kind standing(const swarf_exact_piece *piece)
{
    if (piece->is_arc) return fabs(piece->centre_r) < same ? SWARF_FACE_SPHERE : SWARF_FACE_TORUS;
    if (fabs(piece->first_z) < same) return SWARF_FACE_CYLINDER;
    return fabs(piece->first_r) < same ? SWARF_FACE_PLANE : SWARF_FACE_CONE;
}

static swarf_face_kind left_by(const swarf_trace *trace, const swarf_exact_piece *piece, double t)
{
    if (t < same || t > 1 - same) return standing(piece);
    switch (trace->kind) {
    case TRACE_LEVEL:
        if (trace->run == 0) return standing(piece);
        return piece->is_arc ? SWARF_FACE_CYLINDER : SWARF_FACE_PLANE;
    case TRACE_TILTED:
        if (!piece->is_arc) return SWARF_FACE_PLANE;
        return fabs(piece->centre_r) < same ? SWARF_FACE_CYLINDER : SWARF_FACE_OTHER;
    case TRACE_ARC: {
        const swarf_face_kind kind = standing(piece);
        return kind == SWARF_FACE_SPHERE ? SWARF_FACE_TORUS : kind;
    }
    default: return SWARF_FACE_OTHER;
    }
}

/* Of a move of the surface itself; `normal` in its coordinates. */
static swarf_face_kind of_move(const swarf_surface *surface, size_t move, const swarf_surface_point *point,
                               const double normal[3])
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
    if (lo == surface->part_count || surface->parts[lo].move != move ||
        swarf_surface_trace(surface, lo, &trace) != SWARF_OK)
        return SWARF_FACE_OTHER;
    if (point->piece < 0 || (size_t)point->piece >= trace.body->piece_count) return SWARF_FACE_OTHER;
    swarf_exact_piece piece = trace.body->exact[point->piece];
    if (piece.is_arc &&
        fabs(normal[2] + piece.first_z) < same) { /* the straight piece that goes on from an end of it */
        piece.is_arc = 0;
    } else if (piece.is_arc && fabs(normal[2] + piece.last_z) < same) {
        piece.is_arc = 0;
        piece.first_r = piece.last_r;
        piece.first_z = piece.last_z;
    }
    if (!piece.is_arc && fabs(normal[2] + piece.first_z) > same) return SWARF_FACE_OTHER; /* an edge left it */
    return left_by(&trace, &piece, point->t);
}

swarf_face_kind swarf_surface_face(const swarf_surface *surface, const swarf_surface_point *point)
{
    int set_up;
    int64_t move;
    if (!surface || !point || point->move == -2) return SWARF_FACE_OTHER;
    swarf_surface_origin(surface, point->move, &set_up, &move);
    double normal[3];
    memcpy(normal, point->normal, sizeof normal);
    for (; set_up > 0 && surface->before; set_up--) {
        swarf_placement_direction(&surface->back, normal, normal);
        surface = surface->before;
    }
    if (move < 0) return surface->block ? SWARF_FACE_PLANE : SWARF_FACE_OTHER;
    return of_move(surface, (size_t)move, point, normal);
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
