/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The vertex of one cycle on the exact surface.
 *
 * The crossings are sorted into faces by what cut them and by their normals. Where there is more than one, the vertex
 * is where their planes meet; the planes are then taken again on their faces close to the point found, so that curved
 * faces meet where they truly do. What comes out counts only if it lies on the surface: faces that are hidden where
 * they would meet leave the pairs of them, and these the point of the surface nearest to the middle of the crossings.
 */
#include "mesh/contour.h"

#include <math.h>
#include <string.h>

/* Faces that differ by less than 3 degrees are one; leaving the edge out moves the mesh by 0.5 tan 1.5 degrees = 0.013
 * voxels at most. */
static const double same_face_cosine = 0.99863;
/* Crossings of one piece that differ by more than 37 degrees may be on two sides of what it cut: the groove of a
 * point, whose sides are one cone. Those of a small ball do not meet as planes would, taken again close to that. */
static const double one_face_cosine = 0.8;
/* Eigenvalues below this part of the greatest: planes that differ by less than half of same_face. The first guess takes
 * planes apart from where they meet, so it is careful. */
static const double least_eigenvalue = 1.5e-4, first_eigenvalue = 1e-3;
/* How near to the vertex found its planes are taken, round by round, in parts of the way to the crossings. The error
 * of a round is the bend over that way, so each is well within the next one's reach. */
static const double approach[] = {0.5, 0.2, 0.05, 0.01};
/* A face near the vertex is the one at the crossings if it has turned by less than 25 degrees on the way. */
static const double met_again_cosine = 0.906;
/* In voxels: on the surface; where Newton's steps end. A tenth and a hundredth of what the mesh promises. */
static const double on_surface = 1e-3, close_enough = 1e-4;
/* From this far one step leads onto a face as well as many: it misses by the square of it over the face's radius. */
static const double one_step = 0.02;
/* After a round that moves the vertex by less only the last one follows: it alone tells whether the faces are there. */
static const double settled = 1e-5;
/* Vertices are moved into the cell by this much at most, so that they stay on their edge. */
static const double allowed_outside = 0.01;

/* Each crossing may be on a face of its own. */
enum { MOST_FACES = 12 };

typedef struct face {
    contour_plane plane;
    int32_t move, piece;
    int count;
} face;

typedef struct cell {
    const contour_polygon *polygon;
    const swarf_surface_near *near;
    double middle[3];
    face faces[MOST_FACES];
    int count;
} cell;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Value in voxels at a point of the cell, and what the surface is there. */
static double look(const cell *c, const double x[3], swarf_surface_point *found)
{
    double world[3];
    for (int k = 0; k < 3; k++) world[k] = c->polygon->origin[k] + x[k] * c->polygon->voxel;
    swarf_surface_evaluate(c->near, world, found);
    return found->value / c->polygon->voxel;
}

static void find_faces(cell *c)
{
    const contour_polygon *polygon = c->polygon;
    c->count = 0;
    for (int i = 0; i < polygon->count; i++) {
        face *to = c->faces;
        const face *end = c->faces + c->count;
        for (; to < end; to++) {
            const double *n = to->plane.normal;
            if (to->move == polygon->move[i] && to->piece == polygon->piece[i] &&
                dot(n, polygon->normal[i]) > one_face_cosine * sqrt(dot(n, n)))
                break;
        }
        if (to == end) {
            *to = (face){.move = polygon->move[i], .piece = polygon->piece[i]};
            c->count++;
        }
        for (int k = 0; k < 3; k++) {
            to->plane.point[k] += polygon->point[i][k];
            to->plane.normal[k] += polygon->normal[i][k];
        }
        to->count++;
    }
    for (int i = 0; i < c->count; i++) {
        contour_plane *plane = &c->faces[i].plane;
        const double length = sqrt(dot(plane->normal, plane->normal));
        for (int k = 0; k < 3; k++) {
            plane->point[k] /= c->faces[i].count;
            plane->normal[k] /= length > 0 ? length : 1;
        }
    }
}

/* Whether what was found is face number `own` of `chosen`, rather than another of them or none. */
static int is_face(const face *const chosen[MOST_FACES], int count, int own, const swarf_surface_point *found)
{
    const double likeness = dot(found->normal, chosen[own]->plane.normal);
    if (found->move == chosen[own]->move && found->piece == chosen[own]->piece) return likeness > one_face_cosine;
    for (int i = 0; i < count; i++)
        if (i != own && dot(found->normal, chosen[i]->plane.normal) > likeness) return 0;
    return likeness > met_again_cosine;
}

/* Take the plane of face number `own` of `chosen` again where it is near x; 0, and it stays as it is, where the face is
 * not seen there. */
static int take_one(const cell *c, const face *const chosen[MOST_FACES], int count, int own, const double x[3],
                    double part, contour_plane *plane)
{
    double q[3];
    swarf_surface_point found;
    for (int k = 0; k < 3; k++) q[k] = x[k] + part * (chosen[own]->plane.point[k] - x[k]);
    for (int step = 0; step < 3; step++) {
        const double value = look(c, q, &found);
        if (!is_face(chosen, count, own, &found)) return 0;
        for (int k = 0; k < 3; k++) q[k] -= value * found.normal[k];
        if (fabs(value) < one_step) break;
    }
    memcpy(plane->point, q, sizeof q);
    memcpy(plane->normal, found.normal, sizeof found.normal);
    return 1;
}

/* Take each plane that is seen again near x; returns whether all were. */
static int take_again(const cell *c, const face *const chosen[MOST_FACES], int count, const double x[3], double part,
                      contour_plane *planes)
{
    int all = 1;
    for (int i = 0; i < count; i++) all &= take_one(c, chosen, count, i, x, part, &planes[i]);
    return all;
}

static double apart(const double a[3], const double b[3])
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
}

/* Move the point where faces meet into the cell: 1 when it is one of the surface, 0 when it lies elsewhere. */
static int keep_if_there(const cell *c, double x[3])
{
    const contour_bounds *bounds = &c->polygon->bounds;
    for (int k = 0; k < 3; k++)
        if (x[k] < bounds->lo[k] - allowed_outside || x[k] > bounds->hi[k] + allowed_outside) return 0;
    swarf_surface_point found;
    swarf_contour_clamp(bounds, x);
    return fabs(look(c, x, &found)) <= on_surface;
}

/* Where the chosen faces meet in the cell: the rank, or 1 when they do not. Planes from afar may lead out of the cell
 * though their faces meet in it, so that only the last round decides. */
static int meet_faces(const cell *c, const face *const chosen[MOST_FACES], int count, double x[3])
{
    contour_plane planes[MOST_FACES];
    const contour_bounds *bounds = &c->polygon->bounds;
    for (int i = 0; i < count; i++) planes[i] = chosen[i]->plane;
    int rank = swarf_contour_meet(planes, count, c->middle, first_eigenvalue, bounds, x), seen = 0;
    const size_t rounds = sizeof approach / sizeof *approach;
    for (size_t round = 0; round < rounds && rank > 1; round++) {
        swarf_contour_clamp(bounds, x);
        const double about[3] = {x[0], x[1], x[2]};
        seen = take_again(c, chosen, count, x, approach[round], planes);
        rank = swarf_contour_meet(planes, count, about, least_eigenvalue, bounds, x);
        if (seen && apart(x, about) < settled * settled && round + 2 < rounds) round = rounds - 2;
    }
    return rank > 1 && seen && keep_if_there(c, x) ? rank : 1;
}

static void step_onto(const cell *c, double x[3], double value, const swarf_surface_point *found)
{
    for (int k = 0; k < 3; k++) x[k] -= value * found->normal[k];
    swarf_contour_clamp(&c->polygon->bounds, x);
}

/* Move x onto the surface within the cell; 0 when Newton's steps do not lead there. Where the last one leads is not
 * looked at. */
static int project(const cell *c, double x[3], swarf_surface_point *found)
{
    double value = look(c, x, found);
    for (int step = 0; step < 8 && fabs(value) > close_enough; step++) {
        step_onto(c, x, value, found);
        value = look(c, x, found);
    }
    if (fabs(value) > on_surface) return 0;
    step_onto(c, x, value, found);
    return 1;
}

/* The crossing nearest to the middle of all: it is on the surface, and all but in the cell. */
static void take_crossing(const cell *c, double x[3])
{
    const contour_polygon *polygon = c->polygon;
    int chosen = 0;
    for (int i = 1; i < polygon->count; i++)
        if (apart(polygon->point[i], c->middle) < apart(polygon->point[chosen], c->middle)) chosen = i;
    memcpy(x, polygon->point[chosen], sizeof polygon->point[chosen]);
    swarf_contour_clamp(&c->polygon->bounds, x);
}

/* Where two of the faces meet nearest to the middle of the crossings. */
static int meet_two(const cell *c, double x[3])
{
    double nearest = INFINITY;
    for (int i = 0; i < c->count; i++)
        for (int j = 0; j < i; j++) {
            const face *two[MOST_FACES] = {&c->faces[j], &c->faces[i]};
            double at[3];
            if (dot(two[0]->plane.normal, two[1]->plane.normal) > same_face_cosine || meet_faces(c, two, 2, at) < 2)
                continue;
            const double away = apart(at, c->middle);
            if (away >= nearest) continue;
            nearest = away;
            memcpy(x, at, sizeof at);
        }
    return nearest < INFINITY ? 2 : 1;
}

/* Where faces meet; one that no crossing lies on, as the crest of a thread, is seen from where the others led to. */
static int meet(cell *c, double x[3])
{
    const face *chosen[MOST_FACES];
    for (int i = 0; i < c->count; i++) chosen[i] = &c->faces[i];
    int rank = meet_faces(c, chosen, c->count, x);
    if (rank == 1 && c->count > 2) rank = meet_two(c, x);
    if (rank > 1 || c->count == MOST_FACES) return rank;
    memcpy(x, c->middle, sizeof c->middle);
    swarf_surface_point found;
    if (!project(c, x, &found)) return 1;
    for (int i = 0; i < c->count; i++)
        if (found.move == c->faces[i].move && found.piece == c->faces[i].piece) return 1;
    face *hidden = &c->faces[c->count++];
    *hidden = (face){.move = (int32_t)found.move, .piece = found.piece, .count = 1};
    memcpy(hidden->plane.point, x, sizeof hidden->plane.point);
    memcpy(hidden->plane.normal, found.normal, sizeof found.normal);
    return meet_two(c, x);
}

/* On the surface as near to `from` as Newton's steps lead. */
static void place_smooth(const cell *c, const double from[3], double out[3])
{
    swarf_surface_point found;
    memcpy(out, from, sizeof c->middle);
    if (!project(c, out, &found)) take_crossing(c, out);
}

void swarf_contour_vertex_smooth(const contour_polygon *polygon, const swarf_surface_near *near, double out[3])
{
    cell c = {.polygon = polygon, .near = near};
    swarf_contour_middle(polygon, c.middle);
    place_smooth(&c, c.middle, out);
}

int swarf_contour_vertex_exact(const contour_polygon *polygon, const swarf_surface_near *near, double out[3])
{
    cell c = {.polygon = polygon, .near = near};
    double least_dot = 1;
    int one_piece = 1;
    swarf_contour_middle(polygon, c.middle);
    for (int i = 0; i < polygon->count; i++) {
        for (int j = 0; j < i; j++) {
            const double likeness = dot(polygon->normal[i], polygon->normal[j]);
            least_dot = likeness < least_dot ? likeness : least_dot;
        }
        one_piece &= polygon->move[i] == polygon->move[0] && polygon->piece[i] == polygon->piece[0];
    }
    if (least_dot < (one_piece ? one_face_cosine : same_face_cosine)) {
        find_faces(&c);
        const int rank = meet(&c, out);
        if (rank == 1) place_smooth(&c, c.middle, out);
        return rank;
    }
    double above[3] = {c.middle[0], c.middle[1], c.middle[2]};
    swarf_contour_rise(polygon, above);
    swarf_contour_clamp(&polygon->bounds, above);
    place_smooth(&c, above, out);
    return 1;
}
