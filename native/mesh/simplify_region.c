/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Simplifying one region by drawing vertices onto neighbours (half-edge collapses), so that every vertex that stays is
 * one of the surface's own.
 *
 * A vertex v may be drawn onto u when
 *   - the surface stays a manifold of the same topology (link condition of Dey, Edelsbrunner, Guha, Nekhayev 1999);
 *   - on an edge of the surface (facets whose normals differ by more than 25 degrees), u lies on the same edge;
 *     corners and ends of edges stay;
 *   - no facet turns over against the true normal it was made with, or becomes a needle;
 *   - the greatest error of v's facets so far, plus the distance between v's facets and the new ones, is within the
 *     limit. The sum bounds the distance to the first facets by the triangle inequality.
 * Of several choices the one with the best worst facet is taken. The limit is raised in steps, so that what costs
 * nothing goes first.
 */
#include "mesh/ring.h"
#include "mesh/simplify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rounds over the vertices at one limit; what is left after them is not worth looking for. */
enum { ROUNDS = 6 };
/* cos 25 degrees: sharper is an edge. On a ball of three voxels facets differ by up to 20. */
static const double edge_cosine = 0.906;
/* A choice that leaves facets as good as this is taken without looking at the others: they cost most of the time. */
static const double good_enough = 0.5;
/* What is good enough on flat rings, where all but the border goes in the end. */
static const double flat_enough = 0.3;

static int is_crease(const simplify_facet *a, const simplify_facet *b)
{
    int32_t sum = 0; /* of three products below 2^30, of which the squares sum up to one */
    for (int k = 0; k < 3; k++) sum += a->normal[k] * b->normal[k];
    return (double)sum < edge_cosine * 32767 * 32767;
}

/* Corners after a corner of a facet. */
static const uint8_t following[4] = {1, 2, 0, 1};

/* Marks of another ring than any before. */
static void next_stamp(simplify_region *r)
{
    if (r->stamp > UINT32_MAX - 2 * RING_MOST) {
        memset(r->mark, 0, r->vertex_count * sizeof *r->mark);
        r->stamp = 0;
    }
    r->stamp += RING_MOST;
}

static int is_on_ring(const simplify_region *r, uint32_t v)
{
    return r->mark[v] - r->stamp < RING_MOST;
}

/* The facets round a vertex in order; 0 when they are too many or no single ring. */
static int look_round(simplify_region *r, uint32_t v, ring *out)
{
    uint32_t facet[RING_MOST], from[RING_MOST], to[RING_MOST], *link = &r->head[v];
    int count = 0;
    while (*link != SWARF_NO_VERTEX) {
        const uint32_t f = *link >> 2, k = *link & 3;
        simplify_facet *here = &r->facet[f];
        if (!here->alive) {
            *link = here->next[k];
            continue;
        }
        if (count == RING_MOST) return 0;
        facet[count] = f;
        from[count] = here->v[following[k]];
        to[count++] = here->v[following[k + 1]];
        link = &here->next[k];
    }
    if (count < 3) return 0;
    next_stamp(r);
    for (int i = 0; i < count; i++) r->mark[from[i]] = r->stamp + (uint32_t)i;
    for (int i = 0; i < count; i++) to[i] = r->mark[to[i]] - r->stamp; /* from here on a place */
    out->count = count;
    for (uint32_t i = 0, at = 0; i < (uint32_t)count; i++) {
        out->facet[i] = facet[at];
        out->vertex[i] = from[at];
        at = to[at];
        if (at >= (uint32_t)count || (at == 0) != (i + 1 == (uint32_t)count)) return 0;
    }
    return 1;
}

/* Of u's neighbours only the two beside it on the ring may be on the ring too, and no facet may come twice. */
static int keeps_topology(const simplify_region *r, const ring *around, int j, uint32_t v)
{
    const int n = around->count;
    const uint32_t u = around->vertex[j], before = around->vertex[(j + n - 1) % n], after = around->vertex[(j + 1) % n];
    const simplify_facet *here;
    for (uint32_t corner = r->head[u]; corner != SWARF_NO_VERTEX; corner = here->next[corner & 3]) {
        here = &r->facet[corner >> 2];
        if (!here->alive) continue;
        const uint32_t a = here->v[following[corner & 3]], b = here->v[following[(corner & 3) + 1]];
        if (a == v || b == v) continue;
        const int a_on = a != SWARF_NO_VERTEX && is_on_ring(r, a);
        const int b_on = b != SWARF_NO_VERTEX && is_on_ring(r, b);
        if ((a_on && a != before && a != after) || (b_on && b != before && b != after)) return 0;
        if (a_on && b_on && n == 3) return 0;
    }
    return 1;
}

/* What the two facets that go when v is drawn onto ring vertex j had lost, shared out among those that stay; on an edge
 * of the surface each to its own side. */
static void share_lost(simplify_region *r, const ring *around, int j)
{
    const int n = around->count;
    float lost[2] = {r->facet[around->facet[j]].lost_mm3, r->facet[around->facet[(j + n - 1) % n]].lost_mm3};
    int on_left = n - 2;
    for (int i = 1; i < n && around->crease >> j & 1; i++)
        if (around->crease >> (j + i) % n & 1) on_left = i - 1;
    const int on_right = n - 2 - on_left;
    if (on_left == 0 || on_right == 0) lost[0] = lost[1] = lost[0] + lost[1];
    for (int i = 1; i < n - 1; i++)
        r->facet[around->facet[(j + i) % n]].lost_mm3 +=
            i <= on_left ? lost[0] / (float)on_left : lost[1] / (float)on_right;
}

/* Volume between the old place of facet i and the new when v is drawn onto ring vertex j, outside of the new, mm3. */
static float volume_lost(const ring *around, int j, int i)
{
    double lost = 0;
    for (int k = 0; k < 3; k++) lost -= around->at[k][j] * around->normal[k][i];
    return (float)(lost / 6);
}

static void draw(simplify_region *r, const ring *around, int j, uint32_t v, double error)
{
    const int n = around->count;
    const uint32_t u = around->vertex[j];
    share_lost(r, around, j);
    for (int i = 0; i < n; i++) {
        const uint32_t f = around->facet[i];
        simplify_facet *here = &r->facet[f];
        if (i == j || (i + 1) % n == j) {
            here->alive = 0;
            continue;
        }
        const uint32_t k = here->v[0] == v ? 0 : here->v[1] == v ? 1 : 2;
        here->v[k] = u;
        here->next[k] = r->head[u];
        r->head[u] = 4 * f + k;
        here->error_mm = (float)error;
        here->lost_mm3 += volume_lost(around, j, i);
    }
    r->head[v] = SWARF_NO_VERTEX;
    for (int i = 0; i < n; i++) r->state[around->vertex[i]] |= SIMPLIFY_DIRTY;
}

/* The greatest error of the facets, and which edges are edges of the surface. */
static void look_at_facets(const simplify_region *r, ring *out)
{
    const simplify_facet *before = &r->facet[out->facet[out->count - 1]];
    float error = 0;
    out->crease = 0;
    for (int i = 0; i < out->count; i++) {
        const simplify_facet *here = &r->facet[out->facet[i]];
        error = here->error_mm > error ? here->error_mm : error;
        out->crease |= (uint32_t)is_crease(before, here) << i;
        before = here;
    }
    out->error = (double)error;
}

/* The ring's places and true normals; what there is no facet for in the last eight is nought. */
static void put_places(const simplify_region *r, uint32_t v, ring *around)
{
    const int n = around->count;
    const double *middle = &r->xyz[3 * (size_t)v];
    for (int i = 0; i < n; i++) {
        const double *at = &r->xyz[3 * (size_t)around->vertex[i]];
        const int16_t *true_normal = r->facet[around->facet[i]].normal;
        for (int k = 0; k < 3; k++) {
            around->at[k][i] = at[k] - middle[k];
            around->true_normal[k][i] = true_normal[k];
        }
    }
    for (int i = n; i <= (n + 7) / 8 * 8; i++)
        for (int k = 0; k < 3; k++) {
            around->at[k][i] = i == n ? around->at[k][0] : 0;
            around->true_normal[k][i] = 0;
        }
}

/* Whether the distance to the facet that comes to lie over the middle tells that the draw cannot be; `error` is then a
 * lower bound of what it takes. */
static int is_too_far(const ring *around, int j, double limit, double least, double *error)
{
    if (around->slab >= 0 || around->crease) return 0;
    *error = around->error + around->lift[j];
    return *error > limit || ring_score(1, *error, limit) <= least;
}

/* The ring vertex that v is to be drawn onto, or -1: `need` is then the least error that was found to be too much. */
static int choose(const simplify_region *r, const ring_kernel *kernel, ring *around, uint32_t v, double limit,
                  double *error)
{
    const double enough = around->slab >= 0 ? flat_enough : good_enough;
    int best = -1;
    double best_score = -1, best_error = 0, least_error = INFINITY;
    for (int j = 0; j < around->count && best_score <= enough; j++) {
        double score;
        if (around->crease && !(around->crease >> j & 1)) continue;
        if (is_too_far(around, j, limit, best_score, error) ||
            !kernel->try_draw(around, j, limit, best_score, error, &score)) {
            least_error = *error < least_error ? *error : least_error;
            continue;
        }
        if (!keeps_topology(r, around, j, v)) continue;
        best = j;
        best_score = score;
        best_error = *error;
    }
    *error = best < 0 ? least_error : best_error;
    return best;
}

static int remove_vertex(simplify_region *r, const ring_kernel *kernel, uint32_t v, double limit, int flat_only)
{
    ring around;
    r->need[v] = INFINITY;
    if (!look_round(r, v, &around)) return 0;
    look_at_facets(r, &around);
    if (around.error > limit) {
        r->need[v] = (float)around.error;
        return 0;
    }
    const uint32_t more = around.crease & (around.crease - 1);
    if (around.crease && (!more || more & (more - 1))) return 0; /* not two */
    around.shape = -1;
    put_places(r, v, &around);
    kernel->look_flat(&around, limit);
    if (around.slab < 0 && flat_only) {
        r->state[v] = SIMPLIFY_DIRTY;
        r->need[v] = 0;
        return 0;
    }
    if (around.slab < 0) kernel->find_dots(&around);
    if (around.slab < 0 && !around.crease) kernel->find_lifts(&around);
    double error;
    const int best = choose(r, kernel, &around, v, limit, &error);
    if (best < 0) {
        r->need[v] = (float)error;
        return 0;
    }
    draw(r, &around, best, v, error);
    return 1;
}

/* On flat faces, where most vertices go first, those that follow each other should be far apart, so that rings stay
 * round: a stride near the golden section of the count, without a common divisor. */
static size_t stride_of(size_t count)
{
    size_t stride = (size_t)(0.6180339887 * (double)count) | 1;
    for (;; stride++) {
        size_t a = stride, b = count;
        while (b) {
            const size_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1) return stride;
    }
}

static void find_bent(simplify_region *r)
{
    for (size_t f = 0; f < r->facet_count; f++)
        for (int k = 0; k < 3; k++) {
            const uint32_t v = r->facet[f].v[k];
            if (v == SWARF_NO_VERTEX) continue;
            const int16_t *own = r->facet[f].normal, *other = r->facet[r->head[v] >> 2].normal;
            for (int c = 0; c < 3; c++)
                if (abs(own[c] - other[c]) > (int)ring_flat_normal) r->state[v] |= SIMPLIFY_BENT;
        }
}

/* Whether a vertex is to be looked at. What it was found to need still tells when its ring has changed: errors only
 * grow, so that to look again before the limit gets there seldom helps, and takes a fourth of the time. What no error
 * was found to allow is looked at again. */
static int is_due(const simplify_region *r, size_t v, double limit)
{
    const int dirty = r->state[v] == SIMPLIFY_DIRTY;
    if (r->state[v] && !dirty) return 0;
    return (double)r->need[v] <= limit || (dirty && isinf(r->need[v]));
}

void swarf_simplify_region(simplify_region *r, double limit, int first)
{
    const ring_kernel *kernel = swarf_ring_kernel_current();
    const size_t far_apart = stride_of(r->vertex_count);
    static const double steps[] = {0.1, 0.2, 0.45, 0.7, 1}; /* the first only where it is flat */
    if (first) find_bent(r);
    for (size_t step = first ? 0 : 4; step < sizeof steps / sizeof *steps; step++) {
        const double at = limit * steps[step];
        const size_t stride = step == 0 ? far_apart : 1, back = stride - r->vertex_count; /* modulo 2^n */
        for (int round = 0, removed = 1; round < ROUNDS && removed; round++) {
            removed = 0;
            for (size_t i = 0, v = 0; i < r->vertex_count; i++, v += v + stride < r->vertex_count ? stride : back) {
                if (!is_due(r, v, at)) continue;
                if (r->head[v] == SWARF_NO_VERTEX) continue;
                r->state[v] = 0;
                removed |= remove_vertex(r, kernel, (uint32_t)v, at, step == 0);
            }
        }
        for (size_t v = 0; step == 0 && v < r->vertex_count; v++) r->state[v] &= (uint8_t)~SIMPLIFY_BENT;
    }
}
