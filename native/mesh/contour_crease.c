/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* After the facets: edges of them that leave the exact surface are split where its faces meet.
 *
 * A cell has one vertex for each cycle, so that of two edges of the surface that pass it, as the two of a narrow land
 * do, one is missed, and an edge where no crossing tells of both its faces is missed too. There a facet's edge leaves
 * the planes of the facets on both its sides. It is split where the faces meet that are seen along it, and if none do
 * at its middle, drawn onto the surface; edges of facets that came to be by that are looked at again, round by round.
 * A facet that cuts off a corner of the surface has all of its edges on it, on another face each: its longest edge is
 * split at that corner. Splitting an edge in both its facets alike leaves the surface closed.
 */
#include "mesh/crease.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In voxels: an edge farther out of the planes of its facets is looked at, and split where the surface is farther away
 * than half of that, which is what may be missed then; ends are on the surface; a split is this far from the ends. */
static const double out_of_plane = 0.1, off_surface = 0.05, on_surface = 0.01, from_ends = 0.05;
/* In voxels: how far beside an edge it may be split; and where no faces meet so near, as before the tip of a lip that
 * gets thinner than a voxel. Farther out parts of facets reach beyond those that are held against them. */
static const double beside = 1, far_beside = 3;
/* Planes that differ by less than 3.6 degrees do not tell where they meet: an eigenvalue is below this part of the
 * greatest. */
static const double least_eigenvalue = 1e-3;
/* Splits are drawn this part of the way to the middle of the facets' other vertices, so that those of two edges that
 * lie above each other part. */
static const double spread = 0.5;
/* An edge over a narrow land is split at one side of it, then at the other, and so are those that come of that. */
enum { ROUNDS = 6 };
/* Where along an edge faces are looked for: a narrow one is seen from near its end only. */
static const double samples[] = {0.05, 0.25, 0.5, 0.75, 0.95};

/* Whether an edge of a facet leaves its plane. Then all of them are looked at: the one between two vertices below a
 * narrow land, on either side of it, passes under it and is as level as the land. */
static int is_steep(const swarf_facets *facets, const swarf_facet *facet, double voxel)
{
    double height[3];
    int steep = 0;
    const float scale = 1.0f / 32767;
    for (size_t k = 0; k < 3; k++) {
        const float *p = facets->xyz + 3 * (size_t)facet->v[k];
        height[k] = 0;
        for (int c = 0; c < 3; c++) height[k] += (double)((float)facet->normal[c] * scale) * (double)p[c];
    }
    for (int k = 0; k < 3; k++) steep |= fabs(height[(k + 1) % 3] - height[k]) > out_of_plane * voxel;
    return steep;
}

static int by_vertices(const void *a, const void *b)
{
    const crease_edge *x = a, *y = b;
    for (int k = 0; k < 2; k++)
        if (x->v[k] != y->v[k]) return x->v[k] < y->v[k] ? -1 : 1;
    return x->facet < y->facet ? -1 : x->facet > y->facet;
}

/* ---- one edge ---------------------------------------------------------------------------------------------------- */

typedef struct looking {
    const crease_look *look;
    double voxel;
    double p[3], q[3], aside[3];
    swarf_box box;
} looking;

static void along(const looking *l, double s, double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = l->p[k] + s * (l->q[k] - l->p[k]);
}

static double look(const looking *l, const double x[3], swarf_surface_point *found)
{
    return swarf_crease_look_at(l->look, x, found);
}

/* Draw a point onto the surface, within the box. */
static int draw_onto(const looking *l, double x[3], swarf_surface_point *found)
{
    double value = look(l, x, found);
    for (int step = 0; step < 8 && fabs(value) > 1e-4; step++) {
        for (int k = 0; k < 3; k++) {
            x[k] -= value * l->voxel * found->normal[k];
            if (x[k] < l->box.lo[k] || x[k] > l->box.hi[k]) return 0;
        }
        value = look(l, x, found);
    }
    return fabs(value) <= 1e-3;
}

/* How far (in voxels) the surface is from what is between the ends; 0 when they are not on it. */
static double find_off(const looking *l)
{
    swarf_surface_point found;
    double most = 0;
    if (fabs(look(l, l->p, &found)) > on_surface || fabs(look(l, l->q, &found)) > on_surface) return 0;
    for (int i = 1; i < 4; i++) {
        double x[3];
        along(l, 0.25 * i, x);
        most = fmax(most, fabs(look(l, x, &found)));
    }
    return most;
}

static int is_between(const looking *l, const double x[3])
{
    double to_p = 0, to_q = 0;
    for (int k = 0; k < 3; k++) {
        to_p += (x[k] - l->p[k]) * (x[k] - l->p[k]);
        to_q += (x[k] - l->q[k]) * (x[k] - l->q[k]);
    }
    return fmin(to_p, to_q) > from_ends * from_ends * l->voxel * l->voxel;
}

/* Add the face that a place is drawn onto, with a point of it that lies `aside` along it; 0 when none is reached. */
static int add_face(const looking *l, double x[3], const double aside[3], contour_polygon *polygon)
{
    swarf_surface_point found;
    if (!draw_onto(l, x, &found)) return 0;
    const int n = polygon->count++;
    for (int k = 0; k < 3; k++) {
        const double moved = aside[k] - swarf_crease_dot(aside, found.normal) * found.normal[k];
        polygon->point[n][k] = (x[k] + moved - l->box.lo[k]) / l->voxel;
        polygon->normal[n][k] = found.normal[k];
    }
    polygon->move[n] = (int32_t)found.move;
    polygon->piece[n] = found.piece;
    return 1;
}

/* Add the face that is in front of where the planes of the others would meet, as the wall at the end of a lip. */
static int add_hidden(const looking *l, contour_polygon *polygon)
{
    contour_plane planes[12];
    double middle[3] = {0}, x[3];
    for (int i = 0; i < polygon->count; i++) {
        memcpy(planes[i].point, polygon->point[i], sizeof planes[i].point);
        memcpy(planes[i].normal, polygon->normal[i], sizeof planes[i].normal);
        for (int k = 0; k < 3; k++) middle[k] += polygon->point[i][k] / polygon->count;
    }
    if (swarf_contour_meet(planes, polygon->count, middle, least_eigenvalue, &polygon->bounds, x) < 2) return 0;
    for (int k = 0; k < 3; k++) {
        x[k] = polygon->origin[k] + x[k] * l->voxel;
        if (x[k] < l->box.lo[k] || x[k] > l->box.hi[k]) return 0;
    }
    return add_face(l, x, (const double[3]){0}, polygon);
}

/* Without any faces as yet. */
static contour_polygon begin_polygon(const looking *l)
{
    contour_polygon polygon = {.voxel = l->voxel};
    for (int k = 0; k < 3; k++) {
        polygon.origin[k] = l->box.lo[k];
        polygon.bounds.hi[k] = (l->box.hi[k] - l->box.lo[k]) / l->voxel;
    }
    return polygon;
}

/* Where faces meet that are seen along the edge. */
static int meet_along(const looking *l, double out[3])
{
    contour_polygon polygon = begin_polygon(l);
    for (int i = 0; i < (int)(sizeof samples / sizeof *samples); i++) {
        double x[3];
        along(l, samples[i], x);
        add_face(l, x, l->aside, &polygon);
    }
    double x[3];
    if (polygon.count < 2) return 0;
    if (swarf_contour_vertex_exact(&polygon, l->look->near, x) < 2 &&
        (!add_hidden(l, &polygon) || swarf_contour_vertex_exact(&polygon, l->look->near, x) < 2))
        return 0;
    for (int k = 0; k < 3; k++) out[k] = polygon.origin[k] + x[k] * l->voxel;
    return is_between(l, out);
}

static double square_apart(const float a[3], const float b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += ((double)a[k] - (double)b[k]) * ((double)a[k] - (double)b[k]);
    return sum;
}

/* How far (in voxels) the surface is from the middle of a facet of the edge with this third corner; 0 when the edge is
 * not its longest, at which alone it is split. */
static double find_off_facet(const looking *l, const float corners[12], const float third[3])
{
    const double longest = square_apart(corners, corners + 3);
    swarf_surface_point found;
    double x[3];
    if (!(longest > square_apart(corners + 3, third) && longest > square_apart(third, corners))) return 0;
    for (int k = 0; k < 3; k++) x[k] = (l->p[k] + l->q[k] + (double)third[k]) / 3;
    return fabs(look(l, x, &found));
}

/* Where the faces meet that the edges of such a facet are on. */
static int meet_above(const looking *l, const float third[3], double out[3])
{
    static const double none[3] = {0};
    contour_polygon polygon = begin_polygon(l);
    double x[3][3];
    for (int k = 0; k < 3; k++) {
        x[0][k] = 0.5 * (l->p[k] + l->q[k]);
        x[1][k] = 0.5 * (l->q[k] + (double)third[k]);
        x[2][k] = 0.5 * ((double)third[k] + l->p[k]);
    }
    for (int i = 0; i < 3; i++)
        if (!add_face(l, x[i], none, &polygon)) return 0;
    if (swarf_contour_vertex_exact(&polygon, l->look->near, x[0]) < 2) return 0;
    for (int k = 0; k < 3; k++) out[k] = polygon.origin[k] + x[0][k] * l->voxel;
    return is_between(l, out);
}

/* Split an edge that is on the surface where one of its facets is not. */
static void split_below(const looking *l, crease_split *split)
{
    double x[3];
    for (const float *third = split->corners + 6; third < split->corners + 12 && !split->made; third += 3) {
        const double off = find_off_facet(l, split->corners, third);
        if (off <= off_surface) continue;
        split->off = (float)fmax((double)split->off, off);
        split->made = (uint8_t)meet_above(l, third, x);
        for (int k = 0; k < 3 && split->made; k++) split->point[k] = (float)x[k];
    }
}

/* The corners of an edge and of its facets. */
static void find_corners(const crease_splits *s, const crease_edge edge[2], float out[12])
{
    const uint32_t v[4] = {edge->v[0], edge->v[1], s->facets->facet[edge[0].facet].v[(edge[0].corner + 2) % 3],
                           s->facets->facet[edge[1].facet].v[(edge[1].corner + 2) % 3]};
    for (int k = 0; k < 4; k++) memcpy(out + 3 * (size_t)k, s->facets->xyz + 3 * (size_t)v[k], 3 * sizeof *out);
}

static void begin_edge(const float corners[12], double voxel, double around, looking *l)
{
    for (int k = 0; k < 3; k++) {
        l->p[k] = (double)corners[k];
        l->q[k] = (double)corners[3 + k];
        l->aside[k] = 0.5 * spread * ((double)corners[6 + k] + (double)corners[9 + k] - (l->p[k] + l->q[k]));
        l->box.lo[k] = fmin(l->p[k], l->q[k]) - around * voxel;
        l->box.hi[k] = fmax(l->p[k], l->q[k]) + around * voxel;
    }
}

static swarf_status split_edge(const crease_splits *s, crease_look *near, size_t pair)
{
    crease_split *split = &s->split[pair];
    looking l = {.look = near, .voxel = s->work->layout->voxel};
    find_corners(s, &s->edges[2 * pair], split->corners);
    const crease_split *known = swarf_crease_recall(s->memo, split->corners);
    if (known) {
        *split = *known;
        return SWARF_OK;
    }
    begin_edge(split->corners, l.voxel, beside, &l);
    SWARF_TRY(swarf_crease_look_into(near, &l.box));
    split->off = (float)find_off(&l);
    if ((double)split->off <= off_surface) {
        split_below(&l, split);
        return SWARF_OK;
    }
    double x[3];
    swarf_surface_point found;
    split->made = (uint8_t)meet_along(&l, x);
    if (!split->made) {
        begin_edge(split->corners, l.voxel, far_beside, &l);
        SWARF_TRY(swarf_crease_look_into(near, &l.box));
        split->made = (uint8_t)meet_along(&l, x);
    }
    if (!split->made) {
        along(&l, 0.5, x);
        split->made = draw_onto(&l, x, &found) && is_between(&l, x);
    }
    for (int k = 0; k < 3; k++) split->point[k] = (float)x[k];
    return SWARF_OK;
}

static swarf_status split_some(void *context, size_t index)
{
    const crease_splits *s = context;
    crease_look near;
    SWARF_TRY(swarf_crease_look_begin(s->work, &near));
    swarf_status status = SWARF_OK;
    for (size_t i = index * SWARF_CREASE_CHUNK;
         i < (index + 1) * SWARF_CREASE_CHUNK && i < s->count && status == SWARF_OK; i++)
        status = split_edge(s, &near, i);
    swarf_crease_look_end(&near);
    return status;
}

/* ---- edges of steep facets --------------------------------------------------------------------------------------- */

typedef struct finding {
    const swarf_facets *facets;
    const uint8_t *marks; /* of vertices, NULL: none */
    double voxel;
    size_t *first;         /* of the edges of each piece; at first how many */
    crease_edge *edges;    /* that are put, NULL: they are counted */
    const uint8_t *chosen; /* vertices of steep facets; NULL: those are looked for */
} finding;

enum { PIECE = 16384 };

/* The edges of a facet that are looked for, a bit each. */
static unsigned find_edges(const finding *s, const swarf_facet *facet)
{
    const uint32_t *v = facet->v;
    unsigned found = 0;
    if (!s->chosen && facet->error_mm > 0) return 0; /* in a tile */
    if (!s->chosen)
        found = is_steep(s->facets, facet, s->voxel) ? 7 : 0;
    else
        for (unsigned k = 0; k < 3; k++) found |= (unsigned)(s->chosen[v[k]] & s->chosen[v[(k + 1) % 3]]) << k;
    for (unsigned k = 0; k < 3 && found && s->marks; k++)
        if ((s->marks[v[k]] | s->marks[v[(k + 1) % 3]]) & SWARF_VERTEX_LOCKED) found &= ~(1u << k);
    return found;
}

/* The edge of the lowest bit. */
static crease_edge edge_of(const swarf_facets *facets, uint32_t f, unsigned bits)
{
    const uint32_t k = (uint32_t)__builtin_ctz(bits);
    const uint32_t a = facets->facet[f].v[k], b = facets->facet[f].v[(k + 1) % 3];
    return (crease_edge){{a < b ? a : b, a < b ? b : a}, f, k};
}

static swarf_status find_some(void *context, size_t index)
{
    const finding *s = context;
    const swarf_facets *facets = s->facets;
    if (s->edges && s->first[index] == s->first[index + 1]) return SWARF_OK;
    size_t count = 0;
    for (size_t f = index * PIECE; f < (index + 1) * PIECE && f < facets->facet_count; f++)
        for (unsigned left = find_edges(s, &facets->facet[f]); left; left &= left - 1, count++) {
            if (!s->edges) continue;
            s->edges[s->first[index] + count] = edge_of(facets, (uint32_t)f, left);
        }
    if (!s->edges) s->first[index] = count;
    return SWARF_OK;
}

/* The edges of all facets that are looked for. */
static swarf_status list_edges(finding *s, crease_edge **edges, size_t *count)
{
    const size_t pieces = (s->facets->facet_count + PIECE - 1) / PIECE;
    s->edges = NULL;
    s->first = calloc(pieces + 1, sizeof *s->first);
    if (!s->first) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    swarf_status status = swarf_parallel_for(pieces, find_some, s, NULL, 0, 1);
    size_t all = 0;
    for (size_t i = 0; i <= pieces; i++) {
        const size_t own = s->first[i];
        s->first[i] = all;
        all += own;
    }
    if (status == SWARF_OK) s->edges = malloc((all + 1) * sizeof *s->edges);
    if (status == SWARF_OK && !s->edges) status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    if (status == SWARF_OK && all) status = swarf_parallel_for(pieces, find_some, s, NULL, 0, 1);
    free(s->first);
    if (status != SWARF_OK) {
        free(s->edges);
        return status;
    }
    if (all) qsort(s->edges, all, sizeof *s->edges, by_vertices);
    *edges = s->edges;
    *count = all;
    return SWARF_OK;
}

static int is_same(const crease_edge *a, const crease_edge *b)
{
    return memcmp(a->v, b->v, sizeof a->v) == 0;
}

/* The edges of the steep ones of the facets listed. */
static swarf_status list_changed(const finding *s, const uint32_t *changed, size_t changed_count, crease_edge **edges,
                                 size_t *count)
{
    crease_edge *list = malloc((3 * changed_count + 1) * sizeof *list);
    if (!list) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    size_t all = 0;
    for (size_t i = 0; i < changed_count; i++)
        for (unsigned left = find_edges(s, &s->facets->facet[changed[i]]); left; left &= left - 1)
            list[all++] = edge_of(s->facets, changed[i], left);
    if (all) qsort(list, all, sizeof *list, by_vertices);
    *edges = list;
    *count = all;
    return SWARF_OK;
}

typedef struct keyed {
    uint64_t cube;
    crease_edge pair[2];
} keyed;

static int pairs_by_cube(const void *a, const void *b)
{
    const keyed *x = a, *y = b;
    if (x->cube != y->cube) return x->cube < y->cube ? -1 : 1;
    return by_vertices(x->pair, y->pair);
}

/* Those of a cube together. */
static swarf_status sort_pairs(const contour *work, const swarf_facets *facets, crease_edge *edges, size_t count)
{
    keyed *pairs = malloc((count + 1) * sizeof *pairs);
    if (!pairs) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    for (size_t i = 0; i < count; i++) {
        double p[3], q[3];
        swarf_crease_place(facets, edges[2 * i].v[0], p);
        swarf_crease_place(facets, edges[2 * i].v[1], q);
        for (int k = 0; k < 3; k++) p[k] = 0.5 * (p[k] + q[k]);
        pairs[i].cube = swarf_crease_cube(work, p, 0, 0, 0);
        memcpy(pairs[i].pair, &edges[2 * i], sizeof pairs[i].pair);
    }
    if (count) qsort(pairs, count, sizeof *pairs, pairs_by_cube);
    for (size_t i = 0; i < count; i++) memcpy(&edges[2 * i], pairs[i].pair, sizeof pairs[i].pair);
    free(pairs);
    return SWARF_OK;
}

/* Edges, of `both` of their facets each, that are among those of steep facets; returns how many. */
static size_t keep_steep(const crease_edge *steep, size_t steep_count, crease_edge *both, size_t count)
{
    size_t next = 0, kept = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        if (!is_same(&both[i], &both[i + 1])) continue;
        while (next < steep_count && by_vertices(&steep[next], &both[i]) < 0 && !is_same(&steep[next], &both[i]))
            next++;
        if (next < steep_count && is_same(&steep[next], &both[i])) {
            both[2 * kept] = both[i];
            both[2 * kept++ + 1] = both[i + 1];
        }
        i++;
    }
    return kept;
}

/* Edges that have a steep facet on one of their sides at least, in both facets: of the facets listed, or (NULL) of
 * all. */
static swarf_status find_steep_pairs(const contour *work, const swarf_facets *facets, const uint8_t *marks,
                                     const uint32_t *changed, size_t changed_count, crease_edge **edges, size_t *count)
{
    finding s = {.facets = facets, .marks = marks, .voxel = work->layout->voxel};
    crease_edge *steep, *both = NULL;
    size_t steep_count, all = 0;
    if (changed)
        SWARF_TRY(list_changed(&s, changed, changed_count, &steep, &steep_count));
    else
        SWARF_TRY(list_edges(&s, &steep, &steep_count));
    uint8_t *chosen = calloc(facets->vertex_count + 1, 1);
    swarf_status status = chosen ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    for (size_t i = 0; i < steep_count && chosen; i++) chosen[steep[i].v[0]] = chosen[steep[i].v[1]] = 1;
    s.chosen = chosen;
    if (status == SWARF_OK && steep_count) status = list_edges(&s, &both, &all);
    const size_t paired = keep_steep(steep, steep_count, both, all);
    if (status == SWARF_OK) status = sort_pairs(work, facets, both, paired);
    free(chosen);
    free(steep);
    if (status != SWARF_OK) {
        free(both);
        return status;
    }
    *edges = both;
    *count = paired;
    return SWARF_OK;
}

/* ---- rounds ------------------------------------------------------------------------------------------------------ */

/* How far an edge of a facet was from the surface that was not split. */
typedef struct rest {
    uint32_t facet;
    float off;
} rest;

/* Facets that the last round changed, NULL: all are to be looked at; and what is left of all rounds. */
typedef struct rounds {
    uint32_t *changed;
    size_t changed_count;
    rest *rests;
    size_t rest_count, rest_room;
} rounds;

static swarf_status keep_rests(const crease_splits *s, rounds *r)
{
    SWARF_TRY(swarf_array_reserve((void **)&r->rests, &r->rest_room, r->rest_count + 2 * s->count, sizeof *r->rests));
    for (size_t i = 0; i < 2 * s->count; i++)
        if (!s->split[i / 2].made && s->split[i / 2].off > 0)
            r->rests[r->rest_count++] = (rest){s->edges[i].facet, s->split[i / 2].off};
    return SWARF_OK;
}

/* What is left counts as spent. */
static void spend_rests(const contour *work, const rounds *r, swarf_facets *facets)
{
    float most = (float)work->error_mm;
    if ((double)most > work->error_mm) most = nextafterf(most, 0);
    for (size_t i = 0; i < r->rest_count; i++) {
        swarf_facet *facet = &facets->facet[r->rests[i].facet];
        facet->error_mm = fmaxf(facet->error_mm, fminf(r->rests[i].off * (float)work->layout->voxel, most));
    }
}

/* Split what edges there are to be split. */
static swarf_status split_edges(crease_splits *s, swarf_facets *facets, uint8_t **marks, swarf_crease_memo *memo,
                                const swarf_progress *progress, rounds *r, size_t *made)
{
    uint32_t *changed = NULL;
    size_t count = 0;
    s->split = calloc(s->count + 1, sizeof *s->split);
    if (!s->split) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    s->memo = memo;
    swarf_status status =
        swarf_parallel_for((s->count + SWARF_CREASE_CHUNK - 1) / SWARF_CREASE_CHUNK, split_some, s, progress, 0, 0.5);
    if (status == SWARF_OK) status = swarf_crease_remember(memo, s->split, s->count);
    if (status == SWARF_OK) status = swarf_crease_cut(s, facets, marks, progress, 0.5, &changed, &count, made);
    if (status == SWARF_OK) status = keep_rests(s, r);
    free(s->split);
    if (status != SWARF_OK) {
        free(changed);
        return status;
    }
    free(r->changed);
    r->changed = changed;
    r->changed_count = count;
    return SWARF_OK;
}

swarf_status swarf_contour_crease(const contour *work, swarf_facets *facets, uint8_t **marks, swarf_crease_memo *memo,
                                  const swarf_progress *progress, double from, double to, size_t *made)
{
    *made = 0;
    rounds r = {0};
    swarf_status status = SWARF_OK;
    for (int round = 0; status == SWARF_OK && round < ROUNDS && (round == 0 || r.changed_count); round++) {
        crease_splits s = {.work = work, .facets = facets};
        swarf_progress_share share = {progress, from + round * (to - from) / ROUNDS,
                                      from + (round + 1) * (to - from) / ROUNDS};
        const swarf_progress part = swarf_progress_part(&share);
        size_t own = 0;
        status = find_steep_pairs(work, facets, *marks, r.changed, r.changed_count, &s.edges, &s.count);
        if (status == SWARF_OK) status = split_edges(&s, facets, marks, memo, progress ? &part : NULL, &r, &own);
        free(s.edges);
        *made += own;
    }
    if (status == SWARF_OK) spend_rests(work, &r, facets);
    free(r.changed);
    free(r.rests);
    return status;
}
