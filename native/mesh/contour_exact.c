/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The vertex of one cycle on the exact surface.
 *
 * The crossings are sorted into faces by what cut them and by their normals. Where there is more than one, the vertex
 * is where their planes meet; the planes are then taken again on their faces close to the point found, so that curved
 * faces meet where they truly do. What comes out counts only if it lies on the surface: faces that are hidden where
 * they would meet leave the pairs of them, and these the point of the surface nearest to the middle of the crossings.
 */
#include "mesh/contour.h"

#include "base/vector.h"

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
/* A round of looking for where faces meet. */
struct round {
    double part;    /* how near to the vertex found its planes are taken, of the way to the crossings */
    double settled; /* where it moves the vertex by less, and all faces are seen, ... */
    int left_out;   /* ... so many of the next rounds are left out */
    int bent;       /* planes are led on from there to the vertex, as their faces bend up to there */
};
/* Planes that are led on bring the vertex within the next round's reach, which tells whether the faces are there: what
 * bends by 0.01 over half of the way bends by 2e-5 over a fiftieth. */
static const struct round quick_rounds[] = {
    {0.5, 0, 0, 1}, {0.02, 0.01, 3, 0}, {0.2, 0, 0, 1}, {0.05, 0, 0, 0}, {0.01, 0, 0, 0}};
/* The error of a round is the bend over its way, so each is well within the next one's reach. */
static const struct round sure_rounds[] = {{0.5, 1e-5, 2, 0}, {0.2, 1e-5, 1, 0}, {0.05, 0, 0, 0}, {0.01, 0, 0, 0}};
typedef struct rounds {
    const struct round *rounds;
    int count;
} rounds;
static const rounds quick = {quick_rounds, sizeof quick_rounds / sizeof *quick_rounds};
static const rounds sure = {sure_rounds, sizeof sure_rounds / sizeof *sure_rounds};
/* A face near the vertex is the one at the crossings if it has turned by less than 25 degrees on the way. */
static const double met_again_cosine = 0.906;
/* In voxels: on the surface; where Newton's steps end. A tenth and a hundredth of what the mesh promises. */
static const double on_surface = 1e-3, close_enough = 1e-4;
/* From this far one step leads onto a face as well as many: it misses by the square of it over the face's radius. From
 * further than this no face seen at the vertex is one that meets there. */
static const double one_step = 0.02, farthest = 0.1;
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
                vector_dot(n, polygon->normal[i]) > one_face_cosine * sqrt(vector_dot(n, n)))
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
        const double length = sqrt(vector_dot(plane->normal, plane->normal));
        for (int k = 0; k < 3; k++) {
            plane->point[k] /= c->faces[i].count;
            plane->normal[k] /= length > 0 ? length : 1;
        }
    }
}

/* Whether what was found is face number `own` of `chosen`, rather than another of them or none. */
static int is_face(const face *const chosen[MOST_FACES], int count, int own, const swarf_surface_point *found)
{
    const double likeness = vector_dot(found->normal, chosen[own]->plane.normal);
    if (found->move == chosen[own]->move && found->piece == chosen[own]->piece) return likeness > one_face_cosine;
    for (int i = 0; i < count; i++)
        if (i != own && vector_dot(found->normal, chosen[i]->plane.normal) > likeness) return 0;
    return likeness > met_again_cosine;
}

static double apart(const double a[3], const double b[3])
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
}

/* Lead the plane at q, a part of the way from x to where the normal was `before`, on to x, as it bends up to q. */
static void lead_on(const double q[3], const double normal[3], const double before[3], double part, const double x[3],
                    contour_plane *plane)
{
    const double on = part / (1 - part);
    double chord[3]; /* its normal, half way between that at q and that at x */
    for (int k = 0; k < 3; k++) {
        plane->normal[k] = normal[k] + on * (normal[k] - before[k]);
        chord[k] = normal[k] + plane->normal[k];
    }
    const double length = sqrt(vector_dot(plane->normal, plane->normal));
    const double above = (vector_dot(chord, x) - vector_dot(chord, q)) / vector_dot(chord, chord);
    for (int k = 0; k < 3; k++) {
        plane->point[k] = x[k] - above * chord[k];
        plane->normal[k] /= length;
    }
}

/* Take the plane of face number `own` of `chosen` again where it is near x; 0, and it stays as it is, where the face is
 * not seen there. */
static int take_one(const cell *c, const face *const chosen[MOST_FACES], int count, int own, const double x[3],
                    const struct round *round, contour_plane *plane)
{
    double q[3];
    swarf_surface_point found;
    for (int k = 0; k < 3; k++) q[k] = x[k] + round->part * (chosen[own]->plane.point[k] - x[k]);
    for (int step = 0; step < 3; step++) {
        const double value = look(c, q, &found);
        if (!is_face(chosen, count, own, &found)) return 0;
        for (int k = 0; k < 3; k++) q[k] -= value * found.normal[k];
        if (fabs(value) < one_step) break;
    }
    if (round->bent) {
        lead_on(q, found.normal, chosen[own]->plane.normal, round->part, x, plane);
        return 1;
    }
    memcpy(plane->point, q, sizeof q);
    memcpy(plane->normal, found.normal, sizeof found.normal);
    return 1;
}

/* Take each plane that is seen again, one of them at x, the others near it; returns whether all were. Sets the value
 * at x. */
static int take_again(const cell *c, const face *const chosen[MOST_FACES], int count, const double x[3],
                      const struct round *round, contour_plane *planes, double *value)
{
    swarf_surface_point found;
    *value = look(c, x, &found);
    int all = 1, here = 0;
    while (here < count && !(fabs(*value) < farthest && is_face(chosen, count, here, &found))) here++;
    for (int i = 0; i < count; i++)
        if (i != here) all &= take_one(c, chosen, count, i, x, round, &planes[i]);
    for (int k = 0; here < count && k < 3; k++) {
        planes[here].point[k] = x[k] - *value * found.normal[k];
        planes[here].normal[k] = found.normal[k];
    }
    return all;
}

/* Move the point where faces meet into the cell: 1 when it is one of the surface, 0 when it lies elsewhere. `value` is
 * that at `seen`; along the way from there it changes by no more than the way, by sqrt 3 of it where a field is what
 * was there first. */
static int keep_if_there(const cell *c, const double seen[3], double value, double x[3])
{
    const contour_bounds *bounds = &c->polygon->bounds;
    for (int k = 0; k < 3; k++)
        if (x[k] < bounds->lo[k] - allowed_outside || x[k] > bounds->hi[k] + allowed_outside) return 0;
    swarf_surface_point found;
    swarf_contour_clamp(bounds, x);
    return fabs(value) + sqrt(apart(x, seen)) <= on_surface || fabs(look(c, x, &found)) <= on_surface;
}

/* Where the chosen faces meet in the cell: the rank, or 1 when they do not. Planes from afar may lead out of the cell
 * though their faces meet in it, so that only the last round decides. */
static int meet_in(const cell *c, const face *const chosen[MOST_FACES], int count, const rounds *how, double x[3])
{
    contour_plane planes[MOST_FACES];
    double about[3], value = 0;
    const contour_bounds *bounds = &c->polygon->bounds;
    for (int i = 0; i < count; i++) planes[i] = chosen[i]->plane;
    int rank = swarf_contour_meet(planes, count, c->middle, first_eigenvalue, bounds, x), seen = 0;
    for (int i = 0; i < how->count && rank > 1; i++) {
        const struct round *round = &how->rounds[i];
        swarf_contour_clamp(bounds, x);
        memcpy(about, x, sizeof about);
        seen = take_again(c, chosen, count, x, round, planes, &value);
        rank = swarf_contour_meet(planes, count, about, least_eigenvalue, bounds, x);
        if (seen && apart(x, about) < round->settled * round->settled) i += round->left_out;
    }
    return rank > 1 && seen && keep_if_there(c, about, value, x) ? rank : 1;
}

/* Where the chosen faces meet. Two that are all the cell has are looked for with more care, where planes that are led
 * on lead astray. */
static int meet_faces(const cell *c, const face *const chosen[MOST_FACES], int count, double x[3])
{
    const int rank = meet_in(c, chosen, count, &quick, x);
    return rank == 1 && c->count == 2 ? meet_in(c, chosen, count, &sure, x) : rank;
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

/* On the surface as near to `from` as Newton's steps lead; 0 when they do not, then on a crossing. */
static int place_smooth(const cell *c, const double from[3], double x[3], swarf_surface_point *found)
{
    memcpy(x, from, sizeof c->middle);
    if (project(c, x, found)) return 1;
    take_crossing(c, x);
    return 0;
}

/* How far from the middle of the crossings the planes of two faces meet; INFINITY where they are all but one. */
static double pair_away(const cell *c, const face *a, const face *b)
{
    const contour_plane planes[] = {a->plane, b->plane};
    double at[3];
    if (vector_dot(a->plane.normal, b->plane.normal) > same_face_cosine ||
        swarf_contour_meet(planes, 2, c->middle, first_eigenvalue, &c->polygon->bounds, at) < 2)
        return INFINITY;
    return apart(at, c->middle);
}

/* The pair of faces whose planes meet nearest, of those left, and how far. */
static double next_pair(double away[MOST_FACES][MOST_FACES], int count, int pair[2])
{
    double least = INFINITY;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < i; j++) {
            if (away[i][j] >= least) continue;
            least = away[i][j];
            pair[0] = i;
            pair[1] = j;
        }
    return least;
}

/* Where two of the faces meet, the first of those whose planes meet nearest to the middle of the crossings; x stays as
 * it is where none do. */
static int meet_two(const cell *c, double x[3])
{
    double away[MOST_FACES][MOST_FACES], at[3];
    for (int i = 0; i < c->count; i++)
        for (int j = 0; j < i; j++) away[i][j] = pair_away(c, &c->faces[j], &c->faces[i]);
    int pair[2] = {0, 0};
    while (next_pair(away, c->count, pair) < INFINITY) {
        const face *two[MOST_FACES] = {&c->faces[pair[1]], &c->faces[pair[0]]};
        if (meet_faces(c, two, 2, at) > 1) {
            memcpy(x, at, sizeof at);
            return 2;
        }
        away[pair[0]][pair[1]] = INFINITY;
    }
    return 1;
}

/* Where faces meet, or on one of them; one that no crossing lies on, as the crest of a thread, is seen from where the
 * others led to. */
static int meet(cell *c, double x[3])
{
    const face *chosen[MOST_FACES];
    for (int i = 0; i < c->count; i++) chosen[i] = &c->faces[i];
    int rank = meet_faces(c, chosen, c->count, x);
    if (rank == 1 && c->count > 2) rank = meet_two(c, x);
    swarf_surface_point found;
    if (rank > 1 || !place_smooth(c, c->middle, x, &found) || c->count == MOST_FACES) return rank;
    for (int i = 0; i < c->count; i++)
        if (found.move == c->faces[i].move && found.piece == c->faces[i].piece) return 1;
    face *hidden = &c->faces[c->count++];
    *hidden = (face){.move = (int32_t)found.move, .piece = found.piece, .count = 1};
    memcpy(hidden->plane.point, x, sizeof hidden->plane.point);
    memcpy(hidden->plane.normal, found.normal, sizeof found.normal);
    return meet_two(c, x);
}

void swarf_contour_vertex_smooth(const contour_polygon *polygon, const swarf_surface_near *near, double out[3])
{
    cell c = {.polygon = polygon, .near = near};
    swarf_surface_point found;
    swarf_contour_middle(polygon, c.middle);
    place_smooth(&c, c.middle, out, &found);
}

int swarf_contour_vertex_exact(const contour_polygon *polygon, const swarf_surface_near *near, double out[3])
{
    cell c = {.polygon = polygon, .near = near};
    double least_dot = 1;
    int one_piece = 1;
    swarf_contour_middle(polygon, c.middle);
    for (int i = 0; i < polygon->count; i++) {
        for (int j = 0; j < i; j++) {
            const double likeness = vector_dot(polygon->normal[i], polygon->normal[j]);
            least_dot = likeness < least_dot ? likeness : least_dot;
        }
        one_piece &= polygon->move[i] == polygon->move[0] && polygon->piece[i] == polygon->piece[0];
    }
    if (least_dot < (one_piece ? one_face_cosine : same_face_cosine)) {
        find_faces(&c);
        return meet(&c, out);
    }
    swarf_surface_point found;
    double above[3] = {c.middle[0], c.middle[1], c.middle[2]};
    swarf_contour_rise(polygon, above);
    swarf_contour_clamp(&polygon->bounds, above);
    place_smooth(&c, above, out, &found);
    return 1;
}
