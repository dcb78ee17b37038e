/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* After the facets: edges of them that leave the exact surface are split where its faces meet.
 *
 * A cell has one vertex for each cycle, so that of two edges of the surface that pass it, as the two of a narrow land
 * do, one is missed, and an edge where no crossing tells of both its faces is missed too. There a facet's edge leaves
 * the planes of the facets on both its sides. It is split where the faces meet that are seen along it, and if none do
 * at its middle, drawn onto the surface; edges that came to be by that are looked at again. Splitting an edge in both
 * its facets alike leaves the surface closed.
 */
#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/contour.h"
#include "surface/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In voxels: an edge farther out of the planes of its facets is looked at, and split where the surface is farther away
 * than half of that, which is what may be missed then; ends are on the surface; a split is this far from the ends. */
static const double out_of_plane = 0.1, off_surface = 0.05, on_surface = 0.01, from_ends = 0.05;
/* In voxels: how far beside an edge it may be split. */
static const double beside = 1;
/* A part of a facet is at least this high (in voxels) and faces as the surface does within 80 degrees. */
static const double least_height = 1e-3, least_cosine = 0.17;
/* Splits are drawn this part of the way to the middle of the facets' other vertices, so that those of two edges that
 * lie above each other part. */
static const double spread = 0.5;
/* An edge over a narrow land is split at one side of it, then at the other. */
enum { ROUNDS = 3, CHUNK = 64 };
/* Where along an edge faces are looked for: a narrow one is seen from near its end only. */
static const double samples[] = {0.05, 0.25, 0.5, 0.75, 0.95};

/* An edge from its lesser to its greater vertex, and the facet it is of. */
typedef struct steep_edge {
    uint32_t v[2];
    uint32_t facet;
    uint32_t corner; /* where it starts in the facet */
} steep_edge;

typedef struct splitting {
    const contour *work;
    const swarf_facets *facets;
    steep_edge *edges; /* of two facets each, one after the other */
    size_t count;      /* of pairs */
    double (*points)[3];
    uint8_t *made;
} splitting;

static void place(const swarf_facets *facets, uint32_t v, double out[3])
{
    for (size_t k = 0; k < 3; k++) out[k] = (double)facets->xyz[3 * (size_t)v + k];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The edges of a facet that leave its plane, a bit each. */
static unsigned find_steep(const swarf_facets *facets, const swarf_facet *facet, double voxel)
{
    double height[3];
    unsigned steep = 0;
    const float scale = 1.0f / 32767;
    for (size_t k = 0; k < 3; k++) {
        const float *p = facets->xyz + 3 * (size_t)facet->v[k];
        height[k] = 0;
        for (int c = 0; c < 3; c++) height[k] += (double)((float)facet->normal[c] * scale) * (double)p[c];
    }
    for (unsigned k = 0; k < 3; k++)
        steep |= (unsigned)(fabs(height[(k + 1) % 3] - height[k]) > out_of_plane * voxel) << k;
    return steep;
}

static int by_vertices(const void *a, const void *b)
{
    const steep_edge *x = a, *y = b;
    for (int k = 0; k < 2; k++)
        if (x->v[k] != y->v[k]) return x->v[k] < y->v[k] ? -1 : 1;
    return x->facet < y->facet ? -1 : x->facet > y->facet;
}

/* ---- one edge ---------------------------------------------------------------------------------------------------- */

typedef struct looking {
    swarf_surface_near *near;
    double voxel;
    double p[3], q[3], aside[3];
    swarf_box box;
} looking;

static void along(const looking *l, double s, double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = l->p[k] + s * (l->q[k] - l->p[k]);
}

/* Value at a point, in voxels. */
static double look(const looking *l, const double x[3], swarf_surface_point *found)
{
    swarf_surface_evaluate(l->near, x, found);
    return found->value / l->voxel;
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

/* Whether both ends are on the surface and it is away from what is between them. */
static int is_off(const looking *l)
{
    swarf_surface_point found;
    double most = 0;
    if (fabs(look(l, l->p, &found)) > on_surface || fabs(look(l, l->q, &found)) > on_surface) return 0;
    for (int i = 1; i < 4; i++) {
        double x[3];
        along(l, 0.25 * i, x);
        most = fmax(most, fabs(look(l, x, &found)));
    }
    return most > off_surface;
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

/* Where faces meet that are seen along the edge. */
static int meet_along(const looking *l, double out[3])
{
    contour_polygon polygon = {.voxel = l->voxel};
    for (int k = 0; k < 3; k++) {
        polygon.origin[k] = l->box.lo[k];
        polygon.bounds.hi[k] = (l->box.hi[k] - l->box.lo[k]) / l->voxel;
    }
    for (int i = 0; i < (int)(sizeof samples / sizeof *samples); i++) {
        double x[3];
        swarf_surface_point found;
        along(l, samples[i], x);
        if (!draw_onto(l, x, &found)) continue;
        const int n = polygon.count++;
        for (int k = 0; k < 3; k++) {
            const double aside = l->aside[k] - dot(l->aside, found.normal) * found.normal[k];
            polygon.point[n][k] = (x[k] + aside - l->box.lo[k]) / l->voxel;
            polygon.normal[n][k] = found.normal[k];
        }
        polygon.move[n] = (int32_t)found.move;
        polygon.piece[n] = found.piece;
    }
    double x[3];
    if (polygon.count < 2 || swarf_contour_vertex_exact(&polygon, l->near, x) < 2) return 0;
    for (int k = 0; k < 3; k++) out[k] = polygon.origin[k] + x[k] * l->voxel;
    return is_between(l, out);
}

static swarf_status split_edge(const splitting *s, swarf_surface_near *near, size_t pair)
{
    const steep_edge *edge = &s->edges[2 * pair];
    const double voxel = s->work->layout->voxel;
    looking l = {.near = near, .voxel = voxel};
    place(s->facets, edge->v[0], l.p);
    place(s->facets, edge->v[1], l.q);
    for (int k = 0; k < 3; k++) {
        l.box.lo[k] = fmin(l.p[k], l.q[k]) - beside * voxel;
        l.box.hi[k] = fmax(l.p[k], l.q[k]) + beside * voxel;
    }
    for (int i = 0; i < 2; i++) {
        double third[3];
        place(s->facets, s->facets->facet[edge[i].facet].v[(edge[i].corner + 2) % 3], third);
        for (int k = 0; k < 3; k++) l.aside[k] += 0.5 * spread * (third[k] - 0.5 * (l.p[k] + l.q[k]));
    }
    SWARF_TRY(swarf_surface_gather(near, s->work->moves, &l.box));
    if (!is_off(&l)) return SWARF_OK;
    double x[3];
    swarf_surface_point found;
    int made = meet_along(&l, x);
    if (!made) {
        along(&l, 0.5, x);
        made = draw_onto(&l, x, &found) && is_between(&l, x);
    }
    s->made[pair] = (uint8_t)made;
    memcpy(s->points[pair], x, sizeof x);
    return SWARF_OK;
}

static swarf_status split_some(void *context, size_t index)
{
    const splitting *s = context;
    swarf_surface_near *near;
    SWARF_TRY(swarf_surface_near_create(s->work->surface, &near));
    swarf_status status = SWARF_OK;
    for (size_t i = index * CHUNK; i < (index + 1) * CHUNK && i < s->count && status == SWARF_OK; i++)
        status = split_edge(s, near, i);
    swarf_surface_near_destroy(near);
    return status;
}

/* ---- steep edges ------------------------------------------------------------------------------------------------- */

typedef struct finding {
    const swarf_facets *facets;
    const uint8_t *marks; /* of vertices, NULL: none */
    double voxel;
    size_t *first;         /* of the edges of each piece; at first how many */
    steep_edge *edges;     /* that are put, NULL: they are counted */
    const uint8_t *chosen; /* vertices of steep edges; NULL: edges are steep in their own facet */
} finding;

enum { PIECE = 16384 };

/* The edges of a facet that are looked for, a bit each. */
static unsigned find_edges(const finding *s, const swarf_facet *facet)
{
    const uint32_t *v = facet->v;
    unsigned found = 0;
    if (!s->chosen && facet->error_mm > 0) return 0; /* in a tile */
    if (!s->chosen)
        found = find_steep(s->facets, facet, s->voxel);
    else
        for (unsigned k = 0; k < 3; k++) found |= (unsigned)(s->chosen[v[k]] & s->chosen[v[(k + 1) % 3]]) << k;
    for (unsigned k = 0; k < 3 && found && s->marks; k++)
        if ((s->marks[v[k]] | s->marks[v[(k + 1) % 3]]) & SWARF_VERTEX_LOCKED) found &= ~(1u << k);
    return found;
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
            const uint32_t k = (uint32_t)__builtin_ctz(left);
            const uint32_t a = facets->facet[f].v[k], b = facets->facet[f].v[(k + 1) % 3];
            s->edges[s->first[index] + count] = (steep_edge){{a < b ? a : b, a < b ? b : a}, (uint32_t)f, k};
        }
    if (!s->edges) s->first[index] = count;
    return SWARF_OK;
}

/* The edges of all facets that are looked for. */
static swarf_status list_edges(finding *s, steep_edge **edges, size_t *count)
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

static int is_same(const steep_edge *a, const steep_edge *b)
{
    return memcmp(a->v, b->v, sizeof a->v) == 0;
}

/* Edges that are steep on one of their sides at least, in both facets. */
static swarf_status find_pairs(const contour *work, const swarf_facets *facets, const uint8_t *marks,
                               steep_edge **edges, size_t *count)
{
    finding s = {.facets = facets, .marks = marks, .voxel = work->layout->voxel};
    steep_edge *steep, *both = NULL;
    size_t steep_count, all = 0, next = 0, paired = 0;
    SWARF_TRY(list_edges(&s, &steep, &steep_count));
    uint8_t *chosen = calloc(facets->vertex_count + 1, 1);
    swarf_status status = chosen ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    for (size_t i = 0; i < steep_count && chosen; i++) chosen[steep[i].v[0]] = chosen[steep[i].v[1]] = 1;
    s.chosen = chosen;
    if (status == SWARF_OK && steep_count) status = list_edges(&s, &both, &all);
    for (size_t i = 0; i + 1 < all; i++) {
        if (!is_same(&both[i], &both[i + 1])) continue;
        while (next < steep_count && by_vertices(&steep[next], &both[i]) < 0 && !is_same(&steep[next], &both[i]))
            next++;
        if (next < steep_count && is_same(&steep[next], &both[i])) {
            both[2 * paired] = both[i];
            both[2 * paired++ + 1] = both[i + 1];
        }
        i++;
    }
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

/* ---- facets ------------------------------------------------------------------------------------------------------ */

enum { NONE = UINT32_MAX };

/* A facet one to three edges of which are split. */
typedef struct cut_facet {
    uint32_t facet;
    uint32_t at[3]; /* pairs that split its edges, NONE */
    int parts;      /* it becomes; 0: they turn over */
    swarf_facet part[4];
} cut_facet;

/* Points on split edges are there as vertices after the others, by the number of the pair. */
typedef struct cutting {
    const splitting *splits;
    cut_facet *cuts;
    size_t count;
} cutting;

/* How far the surface is from the middle between two vertices. */
static double off_middle(const looking *l, const swarf_facets *facets, uint32_t a, uint32_t b)
{
    double p[3], q[3], x[3];
    swarf_surface_point found;
    place(facets, a, p);
    place(facets, b, q);
    for (int k = 0; k < 3; k++) x[k] = 0.5 * (p[k] + q[k]);
    return fabs(look(l, x, &found));
}

/* How well a part faces the way that the surface does there: the best cosine at its middle and towards its corners,
 * as it may lie near several faces. */
static double facing(const looking *l, double p[3][3], const double n[3], double best[3])
{
    double most = -1;
    for (int at = 0; at < 4; at++) {
        double x[3];
        swarf_surface_point found;
        for (int k = 0; k < 3; k++)
            x[k] = at == 3 ? (p[0][k] + p[1][k] + p[2][k]) / 3
                           : 0.8 * p[at][k] + 0.1 * (p[(at + 1) % 3][k] + p[(at + 2) % 3][k]);
        look(l, x, &found);
        const double cosine = dot(n, found.normal);
        if (cosine <= most) continue;
        most = cosine;
        memcpy(best, found.normal, sizeof found.normal);
    }
    return most;
}

/* Add a part with the normal of the surface there; 0 when that is another way than its own. */
static int add_part(const looking *l, const swarf_facets *facets, cut_facet *cut, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t v[3] = {a, b, c};
    double p[3][3], u[3], w[3], normal[3], longest = 0;
    for (int k = 0; k < 3; k++) place(facets, v[k], p[k]);
    for (int k = 0; k < 3; k++) {
        u[k] = p[1][k] - p[0][k];
        w[k] = p[2][k] - p[0][k];
        longest += u[k] * u[k] + w[k] * w[k];
    }
    double n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
    const double size = sqrt(dot(n, n));
    if (!(size > least_height * l->voxel * sqrt(longest))) return 0;
    for (int k = 0; k < 3; k++) n[k] /= size;
    if (facing(l, p, n, normal) < least_cosine) return 0;
    swarf_facet *part = &cut->part[cut->parts++];
    *part = facets->facet[cut->facet];
    memcpy(part->v, v, sizeof part->v);
    for (int k = 0; k < 3; k++) part->normal[k] = (int16_t)lrint(normal[k] * 32767);
    return 1;
}

static int add_quad(const looking *l, const swarf_facets *facets, cut_facet *cut, const uint32_t q[4])
{
    const int d = off_middle(l, facets, q[1], q[3]) < off_middle(l, facets, q[0], q[2]);
    return add_part(l, facets, cut, q[d], q[d + 1], q[d + 2]) &&
           add_part(l, facets, cut, q[d], q[d + 2], q[(d + 3) % 4]);
}

/* The parts of a facet; 0 when one would turn over. */
static int cut_up(const looking *l, const swarf_facets *facets, cut_facet *cut)
{
    int splits = 0;
    uint32_t turn = 0; /* so that the first edge is split, and the last one is not, if any */
    for (uint32_t k = 0; k < 3; k++) {
        splits += cut->at[k] != NONE;
        if (cut->at[k] != NONE && cut->at[(k + 2) % 3] == NONE) turn = k;
    }
    uint32_t v[3], x[3];
    for (uint32_t k = 0; k < 3; k++) {
        v[k] = facets->facet[cut->facet].v[(turn + k) % 3];
        x[k] = (uint32_t)facets->vertex_count + cut->at[(turn + k) % 3];
    }
    if (splits == 1) return add_part(l, facets, cut, v[0], x[0], v[2]) && add_part(l, facets, cut, x[0], v[1], v[2]);
    if (!add_part(l, facets, cut, x[0], v[1], x[1])) return 0;
    if (splits == 2) return add_quad(l, facets, cut, (uint32_t[4]){v[0], x[0], x[1], v[2]});
    return add_part(l, facets, cut, v[0], x[0], x[2]) && add_part(l, facets, cut, x[1], v[2], x[2]) &&
           add_part(l, facets, cut, x[0], x[1], x[2]);
}

static swarf_status cut_one(const splitting *s, looking *l, cut_facet *cut)
{
    const swarf_facets *facets = s->facets;
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t k = 0; k < 6; k++) {
        if (k >= 3 && cut->at[k - 3] == NONE) continue;
        double p[3];
        place(facets, k < 3 ? facets->facet[cut->facet].v[k] : (uint32_t)facets->vertex_count + cut->at[k - 3], p);
        for (int c = 0; c < 3; c++) {
            box.lo[c] = fmin(box.lo[c], p[c]);
            box.hi[c] = fmax(box.hi[c], p[c]);
        }
    }
    SWARF_TRY(swarf_surface_gather(l->near, s->work->moves, &box));
    cut->parts = 0;
    if (!cut_up(l, facets, cut)) cut->parts = 0;
    return SWARF_OK;
}

static swarf_status cut_some(void *context, size_t index)
{
    const cutting *c = context;
    looking l = {.voxel = c->splits->work->layout->voxel};
    SWARF_TRY(swarf_surface_near_create(c->splits->work->surface, &l.near));
    swarf_status status = SWARF_OK;
    for (size_t i = index * CHUNK; i < (index + 1) * CHUNK && i < c->count && status == SWARF_OK; i++)
        status = cut_one(c->splits, &l, &c->cuts[i]);
    swarf_surface_near_destroy(l.near);
    return status;
}

static int by_facet(const void *a, const void *b)
{
    const cut_facet *x = a, *y = b;
    return (x->facet > y->facet) - (x->facet < y->facet);
}

/* The facets of edges that are split, each once. */
static size_t list_cuts(const splitting *s, cut_facet *cuts)
{
    size_t count = 0, kept = 0;
    for (size_t i = 0; i < 2 * s->count; i++) {
        if (!s->made[i / 2]) continue;
        cuts[count] = (cut_facet){.facet = s->edges[i].facet, .at = {NONE, NONE, NONE}};
        cuts[count++].at[s->edges[i].corner] = (uint32_t)(i / 2);
    }
    if (count) qsort(cuts, count, sizeof *cuts, by_facet);
    for (size_t i = 0; i < count; i++) {
        if (kept == 0 || cuts[kept - 1].facet != cuts[i].facet) {
            cuts[kept++] = cuts[i];
            continue;
        }
        for (int k = 0; k < 3; k++)
            if (cuts[i].at[k] != NONE) cuts[kept - 1].at[k] = cuts[i].at[k];
    }
    return kept;
}

/* Cut up the facets, less the splits of those that would turn over. */
static swarf_status cut_facets(const splitting *s, cutting *c, const swarf_progress *progress)
{
    for (int again = 1, first = 1; again; first = 0) {
        again = 0;
        c->count = list_cuts(s, c->cuts);
        SWARF_TRY(swarf_parallel_for((c->count + CHUNK - 1) / CHUNK, cut_some, c, progress, first ? 0.5 : 1, 1));
        for (size_t i = 0; i < c->count; i++) {
            if (c->cuts[i].parts) continue;
            again = 1;
            for (int k = 0; k < 3; k++)
                if (c->cuts[i].at[k] != NONE) s->made[c->cuts[i].at[k]] = 0;
        }
    }
    return SWARF_OK;
}

/* Room for all vertices and facets that there may be. */
static swarf_status grow(swarf_facets *facets, size_t pairs, uint8_t **marks)
{
    const size_t all = facets->vertex_count + pairs;
    float *xyz = realloc(facets->xyz, (3 * all + 1) * sizeof *xyz);
    if (xyz) facets->xyz = xyz;
    swarf_facet *facet = realloc(facets->facet, (facets->facet_count + 2 * pairs + 1) * sizeof *facet);
    if (facet) facets->facet = facet;
    uint8_t *grown = *marks ? realloc(*marks, all + 1) : NULL;
    if (grown) *marks = grown;
    if (!xyz || !facet || (*marks && !grown) || all >= UINT32_MAX || facets->facet_count + 2 * pairs >= UINT32_MAX)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for vertices");
    return SWARF_OK;
}

/* The vertices on edges that are split, and the parts of their facets, into the mesh; returns how many are not of the
 * next band. */
static size_t put_in(const splitting *s, const cutting *c, swarf_facets *facets, uint8_t *marks, uint32_t *number)
{
    const size_t before = facets->vertex_count;
    size_t made = 0, own = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (!s->made[i]) continue;
        memmove(facets->xyz + 3 * (before + made), facets->xyz + 3 * (before + i), 3 * sizeof *facets->xyz);
        if (marks) marks[before + made] = 0;
        number[i] = (uint32_t)(before + made++);
        own += !facets->facet[s->edges[2 * i].facet].beyond;
    }
    for (size_t i = 0; i < c->count; i++) {
        cut_facet *cut = &c->cuts[i];
        for (int n = 0; n < cut->parts; n++) {
            for (int k = 0; k < 3; k++)
                if (cut->part[n].v[k] >= before) cut->part[n].v[k] = number[cut->part[n].v[k] - before];
            facets->facet[n == 0 ? cut->facet : facets->facet_count++] = cut->part[n];
        }
    }
    facets->vertex_count += made;
    return own;
}

/* Split what edges there are to be split. */
static swarf_status split_facets(splitting *s, swarf_facets *facets, uint8_t **marks, const swarf_progress *progress,
                                 size_t *made)
{
    s->points = calloc(s->count + 1, sizeof *s->points);
    s->made = calloc(s->count + 1, 1);
    cutting c = {.splits = s, .cuts = malloc((2 * s->count + 1) * sizeof *c.cuts)};
    uint32_t *number = malloc((s->count + 1) * sizeof *number);
    swarf_status status = SWARF_OK;
    if (!s->points || !s->made || !c.cuts || !number) status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    if (status == SWARF_OK)
        status = swarf_parallel_for((s->count + CHUNK - 1) / CHUNK, split_some, s, progress, 0, 0.5);
    if (status == SWARF_OK) status = grow(facets, s->count, marks);
    for (size_t i = 0; i < s->count && status == SWARF_OK; i++)
        for (size_t k = 0; k < 3; k++) facets->xyz[3 * (facets->vertex_count + i) + k] = (float)s->points[i][k];
    if (status == SWARF_OK) status = cut_facets(s, &c, progress);
    if (status == SWARF_OK) *made = put_in(s, &c, facets, *marks, number);
    free(s->points);
    free(s->made);
    free(c.cuts);
    free(number);
    return status;
}

swarf_status swarf_contour_crease(const contour *work, swarf_facets *facets, uint8_t **marks,
                                  const swarf_progress *progress, double from, double to, size_t *made)
{
    *made = 0;
    size_t before = 0;
    for (int round = 0; round < ROUNDS && before != facets->vertex_count; round++) {
        splitting s = {.work = work, .facets = facets};
        swarf_progress_share share = {progress, from + round * (to - from) / ROUNDS,
                                      from + (round + 1) * (to - from) / ROUNDS};
        const swarf_progress part = swarf_progress_part(&share);
        size_t own = 0;
        before = facets->vertex_count;
        SWARF_TRY(find_pairs(work, facets, *marks, &s.edges, &s.count));
        const swarf_status status = s.count ? split_facets(&s, facets, marks, progress ? &part : NULL, &own) : SWARF_OK;
        free(s.edges);
        SWARF_TRY(status);
        *made += own;
    }
    return SWARF_OK;
}
