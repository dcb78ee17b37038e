/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Facets some of whose edges are split, cut into parts. Where a part would turn over the facet gives up its splits, one
 * by one; then the facets beside it are cut again, and no others, so that all splits together are given up once at
 * most. */
#include "mesh/crease.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/intersect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A part of a facet is at least this high (in voxels) and faces as the surface does within 80 degrees. */
static const double least_height = 1e-3, least_cosine = 0.17;
/* A part that faces so nearly as the surface does at its middle is on that face. */
static const double same_face_cosine = 0.95;
/* Progress from which on parts that cut others are looked for. */
static const double apart_from = 0.8;

enum { NONE = UINT32_MAX };

typedef struct cutting {
    crease_splits *splits;
    crease_cuts cuts;
    uint32_t *cut_of;  /* of each edge: its facet's */
    uint32_t *waiting; /* cuts to be made */
    size_t waiting_count;
    uint32_t *next; /* after those */
    size_t next_count;
    uint8_t *crossed; /* cuts whose parts cut others */
} cutting;

/* How far the surface is from the middle between two vertices. */
static double off_middle(const crease_look *l, const swarf_facets *facets, uint32_t a, uint32_t b)
{
    double p[3], q[3], x[3];
    swarf_surface_point found;
    swarf_crease_place(facets, a, p);
    swarf_crease_place(facets, b, q);
    for (int k = 0; k < 3; k++) x[k] = 0.5 * (p[k] + q[k]);
    return fabs(swarf_crease_look_at(l, x, &found));
}

/* How well a part faces the way that the surface does there: the best cosine at its middle and towards its corners,
 * as it may lie near several faces. */
static double facing(const crease_look *l, double p[3][3], const double n[3], double best[3])
{
    double most = -1;
    for (int at = 3; at >= 0 && most < same_face_cosine; at--) {
        double x[3];
        swarf_surface_point found;
        for (int k = 0; k < 3; k++)
            x[k] = at == 3 ? (p[0][k] + p[1][k] + p[2][k]) / 3
                           : 0.8 * p[at][k] + 0.1 * (p[(at + 1) % 3][k] + p[(at + 2) % 3][k]);
        swarf_crease_look_at(l, x, &found);
        const double cosine = swarf_crease_dot(n, found.normal);
        if (cosine <= most) continue;
        most = cosine;
        memcpy(best, found.normal, sizeof found.normal);
    }
    return most;
}

/* Add a part with the normal of the surface there; 0 when that is another way than its own. */
static int add_part(const crease_look *l, const swarf_facets *facets, crease_cut *cut, uint32_t a, uint32_t b,
                    uint32_t c)
{
    const uint32_t v[3] = {a, b, c};
    double p[3][3], u[3], w[3], normal[3], longest = 0;
    for (int k = 0; k < 3; k++) swarf_crease_place(facets, v[k], p[k]);
    for (int k = 0; k < 3; k++) {
        u[k] = p[1][k] - p[0][k];
        w[k] = p[2][k] - p[0][k];
        longest += u[k] * u[k] + w[k] * w[k];
    }
    double n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
    const double size = sqrt(swarf_crease_dot(n, n));
    if (!(size > least_height * l->work->layout->voxel * sqrt(longest))) return 0;
    for (int k = 0; k < 3; k++) n[k] /= size;
    if (facing(l, p, n, normal) < least_cosine) return 0;
    swarf_facet *part = &cut->part[cut->parts++];
    *part = facets->facet[cut->facet];
    part->lost_mm3 = 0;
    memcpy(part->v, v, sizeof part->v);
    for (int k = 0; k < 3; k++) part->normal[k] = (int16_t)lrint(normal[k] * 32767);
    return 1;
}

/* The two parts of a quad, along the diagonal nearer to the surface unless one turns over by that. */
static int add_quad(const crease_look *l, const swarf_facets *facets, crease_cut *cut, const uint32_t q[4])
{
    const int first = off_middle(l, facets, q[1], q[3]) < off_middle(l, facets, q[0], q[2]);
    const uint8_t before = cut->parts;
    for (int i = 0; i < 2; i++) {
        const int d = first ^ i;
        cut->parts = before;
        if (add_part(l, facets, cut, q[d], q[d + 1], q[d + 2]) &&
            add_part(l, facets, cut, q[d], q[d + 2], q[(d + 3) % 4]))
            return 1;
    }
    return 0;
}

static int count_splits(const crease_cut *cut)
{
    return (cut->at[0] != NONE) + (cut->at[1] != NONE) + (cut->at[2] != NONE);
}

/* The parts of a facet; 0 when one would turn over. */
static int cut_up(const crease_look *l, const swarf_facets *facets, crease_cut *cut)
{
    const int splits = count_splits(cut);
    uint32_t turn = 0; /* so that the first edge is split, and the last one is not, if any */
    for (uint32_t k = 0; k < 3; k++)
        if (cut->at[k] != NONE && cut->at[(k + 2) % 3] == NONE) turn = k;
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

static swarf_status cut_one(const crease_splits *s, crease_look *l, crease_cut *cut)
{
    const swarf_facets *facets = s->facets;
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t k = 0; k < 6; k++) {
        if (k >= 3 && cut->at[k - 3] == NONE) continue;
        double p[3];
        swarf_crease_place(facets,
                           k < 3 ? facets->facet[cut->facet].v[k] : (uint32_t)facets->vertex_count + cut->at[k - 3], p);
        for (int c = 0; c < 3; c++) {
            box.lo[c] = fmin(box.lo[c], p[c]);
            box.hi[c] = fmax(box.hi[c], p[c]);
        }
    }
    cut->parts = 0;
    cut->waiting = 0;
    cut->fresh = 1;
    if (count_splits(cut) == 0) return SWARF_OK;
    SWARF_TRY(swarf_crease_look_into(l, &box));
    if (!cut_up(l, facets, cut)) cut->parts = 0;
    return SWARF_OK;
}

static swarf_status cut_some(void *context, size_t index)
{
    const cutting *c = context;
    crease_look l;
    SWARF_TRY(swarf_crease_look_begin(c->splits->work, &l));
    swarf_status status = SWARF_OK;
    for (size_t i = index * SWARF_CREASE_CHUNK;
         i < (index + 1) * SWARF_CREASE_CHUNK && i < c->waiting_count && status == SWARF_OK; i++)
        status = cut_one(c->splits, &l, &c->cuts.cut[c->waiting[i]]);
    swarf_crease_look_end(&l);
    return status;
}

static int by_facet(const void *a, const void *b)
{
    const crease_cut *x = a, *y = b;
    return (x->facet > y->facet) - (x->facet < y->facet);
}

static int cuts_by_cube(const void *a, const void *b)
{
    const crease_cut *x = a, *y = b;
    if (x->cube != y->cube) return x->cube < y->cube ? -1 : 1;
    return by_facet(a, b);
}

/* The facets of edges that are split, each once, those of a cube together; all are waiting. */
static void list_cuts(cutting *c)
{
    const crease_splits *s = c->splits;
    size_t count = 0, kept = 0;
    for (size_t i = 0; i < 2 * s->count; i++) {
        if (!s->split[i / 2].made) continue;
        c->cuts.cut[count] = (crease_cut){.facet = s->edges[i].facet, .at = {NONE, NONE, NONE}, .waiting = 1};
        c->cuts.cut[count++].at[s->edges[i].corner] = (uint32_t)(i / 2);
    }
    if (count) qsort(c->cuts.cut, count, sizeof *c->cuts.cut, by_facet);
    for (size_t i = 0; i < count; i++) {
        if (kept == 0 || c->cuts.cut[kept - 1].facet != c->cuts.cut[i].facet) {
            double p[3];
            c->cuts.cut[kept] = c->cuts.cut[i];
            swarf_crease_place(s->facets, s->facets->facet[c->cuts.cut[i].facet].v[0], p);
            c->cuts.cut[kept++].cube = swarf_crease_cube(s->work, p, 0, 0, 0);
            continue;
        }
        for (int k = 0; k < 3; k++)
            if (c->cuts.cut[i].at[k] != NONE) c->cuts.cut[kept - 1].at[k] = c->cuts.cut[i].at[k];
    }
    if (kept) qsort(c->cuts.cut, kept, sizeof *c->cuts.cut, cuts_by_cube);
    c->cuts.count = c->waiting_count = kept;
    for (size_t i = 0; i < kept; i++) {
        c->waiting[i] = (uint32_t)i;
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t pair = c->cuts.cut[i].at[k];
            if (pair != NONE) c->cut_of[2 * pair + (s->edges[2 * pair].facet != c->cuts.cut[i].facet)] = (uint32_t)i;
        }
    }
}

/* The edge of a pair is not split; its facets are to be cut again. */
static void unmake(cutting *c, uint32_t pair)
{
    c->splits->split[pair].made = 0;
    for (size_t side = 0; side < 2; side++) {
        const uint32_t number = c->cut_of[2 * (size_t)pair + side];
        crease_cut *cut = &c->cuts.cut[number];
        for (int k = 0; k < 3; k++)
            if (cut->at[k] == pair) cut->at[k] = NONE;
        if (!cut->waiting) c->next[c->next_count++] = number;
        cut->waiting = 1;
    }
}

static void begin_next(cutting *c)
{
    uint32_t *done = c->waiting;
    c->waiting = c->next;
    c->waiting_count = c->next_count;
    c->next = done;
    c->next_count = 0;
}

/* Of several splits only the one that matters least: without it the others may do. */
static void give_up_one(cutting *c, uint32_t number)
{
    const uint32_t *at = c->cuts.cut[number].at;
    uint32_t least = NONE;
    for (int k = 0; k < 3; k++)
        if (at[k] != NONE && (least == NONE || c->splits->split[at[k]].off < c->splits->split[least].off))
            least = at[k];
    if (least != NONE) unmake(c, least);
}

static void give_up(cutting *c, uint32_t number)
{
    for (int k = 0; k < 3; k++)
        if (c->cuts.cut[number].at[k] != NONE) unmake(c, c->cuts.cut[number].at[k]);
}

/* Cut up what is waiting; facets that turn over give up their splits. */
static swarf_status cut_waiting(cutting *c, const swarf_progress *progress, double from, double to)
{
    for (int first = 1; c->waiting_count; first = 0) {
        SWARF_TRY(swarf_parallel_for((c->waiting_count + SWARF_CREASE_CHUNK - 1) / SWARF_CREASE_CHUNK, cut_some, c,
                                     progress, first ? from : to, to));
        for (size_t i = 0; i < c->waiting_count; i++)
            if (!c->cuts.cut[c->waiting[i]].parts) give_up_one(c, c->waiting[i]);
        begin_next(c);
    }
    return SWARF_OK;
}

/* Facets with parts that cut others give up their splits, until none do. */
static swarf_status cut_apart(cutting *c, const uint32_t *near, size_t near_count, const swarf_progress *progress)
{
    for (int first = 1;; first = 0) {
        memset(c->crossed, 0, c->cuts.count);
        SWARF_TRY(swarf_crease_find_crossed(c->splits->facets, &c->cuts, near, near_count, progress,
                                            first ? apart_from : 1, c->crossed));
        for (size_t i = 0; i < c->cuts.count; i++) c->cuts.cut[i].fresh = 0;
        for (size_t i = 0; i < c->cuts.count; i++)
            if (c->crossed[i]) give_up(c, (uint32_t)i);
        begin_next(c);
        if (!c->waiting_count) return SWARF_OK;
        SWARF_TRY(cut_waiting(c, progress, 1, 1));
    }
}

static swarf_status cut_facets(cutting *c, const swarf_progress *progress, double from)
{
    uint32_t *near;
    size_t near_count;
    list_cuts(c);
    if (!c->cuts.count) return SWARF_OK;
    SWARF_TRY(cut_waiting(c, progress, from, apart_from));
    SWARF_TRY(swarf_crease_near(c->splits->work, c->splits->facets, &c->cuts, &near, &near_count));
    const swarf_status status = cut_apart(c, near, near_count, progress);
    free(near);
    return status;
}

/* Room for all vertices and facets that there may be. */
static swarf_status grow(swarf_facets *facets, size_t pairs, uint8_t **marks)
{
    const size_t all = facets->vertex_count + pairs;
    float *xyz = realloc(facets->xyz, (3 * all + 1) * sizeof *xyz);
    if (xyz) facets->xyz = xyz;
    swarf_facet *facet = realloc(facets->facet, (facets->facet_count + 2 * pairs + 1) * sizeof *facet);
    if (facet) facets->facet = facet;
    facets->vertex_room = facets->facet_room = 0;
    uint8_t *grown = *marks ? realloc(*marks, all + 1) : NULL;
    if (grown) *marks = grown;
    if (!xyz || !facet || (*marks && !grown) || all >= UINT32_MAX || facets->facet_count + 2 * pairs >= UINT32_MAX)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for vertices");
    return SWARF_OK;
}

/* The vertices on edges that are split into the mesh; returns how many are not of the next band. */
static size_t put_vertices(const crease_splits *s, swarf_facets *facets, uint8_t *marks, uint32_t *number)
{
    const size_t before = facets->vertex_count;
    size_t made = 0, own = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (!s->split[i].made) continue;
        memmove(facets->xyz + 3 * (before + made), facets->xyz + 3 * (before + i), 3 * sizeof *facets->xyz);
        if (marks) marks[before + made] = 0;
        number[i] = (uint32_t)(before + made++);
        own += !facets->facet[s->edges[2 * i].facet].beyond;
    }
    facets->vertex_count += made;
    return own;
}

/* The parts of facets into the mesh, whose split edges have vertices from number `before` on; lists them. */
static size_t put_facets(const cutting *c, swarf_facets *facets, size_t before, const uint32_t *number,
                         uint32_t *changed)
{
    size_t count = 0;
    for (size_t i = 0; i < c->cuts.count; i++) {
        crease_cut *cut = &c->cuts.cut[i];
        for (int n = 0; n < cut->parts; n++) {
            for (int k = 0; k < 3; k++)
                if (cut->part[n].v[k] >= before) cut->part[n].v[k] = number[cut->part[n].v[k] - before];
            const size_t f = n == 0 ? cut->facet : facets->facet_count++;
            facets->facet[f] = cut->part[n];
            changed[count++] = (uint32_t)f;
        }
    }
    return count;
}

swarf_status swarf_crease_cut(crease_splits *splits, swarf_facets *facets, uint8_t **marks,
                              const swarf_progress *progress, double from, uint32_t **changed, size_t *changed_count,
                              size_t *made)
{
    const size_t edges = 2 * splits->count, before = facets->vertex_count;
    cutting c = {.splits = splits,
                 .cuts = {.cut = malloc((edges + 1) * sizeof *c.cuts.cut), .pair_count = splits->count},
                 .cut_of = malloc((edges + 1) * sizeof *c.cut_of),
                 .waiting = malloc((edges + 1) * sizeof *c.waiting),
                 .next = malloc((edges + 1) * sizeof *c.next),
                 .crossed = malloc(edges + 1)};
    uint32_t *number = malloc((edges + 1) * sizeof *number), *list = malloc((2 * edges + 1) * sizeof *list);
    swarf_status status = SWARF_OK;
    if (!c.cuts.cut || !c.cut_of || !c.waiting || !c.next || !c.crossed || !number || !list)
        status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    if (status == SWARF_OK) status = grow(facets, splits->count, marks);
    for (size_t i = 0; i < splits->count && status == SWARF_OK; i++)
        memcpy(facets->xyz + 3 * (before + i), splits->split[i].point, sizeof splits->split[i].point);
    if (status == SWARF_OK) {
        swarf_facets all = {.xyz = facets->xyz, .vertex_count = before + splits->count};
        swarf_facets_snap(&all, splits->work->band ? splits->work->band->step : 0);
    }
    if (status == SWARF_OK) status = cut_facets(&c, progress, from);
    if (status == SWARF_OK) {
        *made = put_vertices(splits, facets, *marks, number);
        *changed_count = put_facets(&c, facets, before, number, list);
        *changed = list;
        list = NULL;
    }
    free(c.cuts.cut);
    free(c.cut_of);
    free(c.waiting);
    free(c.next);
    free(c.crossed);
    free(number);
    free(list);
    return status;
}
