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
#include "base/least.h"
#include "mesh/ring.h"
#include "mesh/simplify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rounds over the vertices at one limit; what is left after them is not worth looking for. */
enum { ROUNDS = 6 };
/* A choice that leaves facets as good as this is taken without looking at the others: they cost most of the time. */
static const double good_enough = 0.5;
/* What is good enough on flat rings, where all but the border goes in the end. */
static const double flat_enough = 0.3;

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

/* What lies round a vertex, unordered: facets, and of each the corners after the vertex. */
typedef struct spokes {
    int count;
    uint32_t facet[RING_MOST], from[RING_MOST], to[RING_MOST];
} spokes;

/* 0 when they are too many or too few. */
static int find_spokes(simplify_region *r, uint32_t v, spokes *out)
{
    uint32_t *link = &r->head[v];
    int count = 0;
    while (*link != SWARF_NO_VERTEX) {
        const uint32_t f = *link >> 2, k = *link & 3;
        simplify_facet *here = &r->facet[f];
        if (!here->alive) {
            *link = here->next[k];
            continue;
        }
        if (count == RING_MOST) return 0;
        out->facet[count] = f;
        out->from[count] = here->v[following[k]];
        out->to[count++] = here->v[following[k + 1]];
        link = &here->next[k];
    }
    out->count = count;
    return count >= 3;
}

/* Nought from the last eight facets on, as kernels read them. */
static void put_noughts(ring *around)
{
    const int n = around->count;
    for (int k = 0; k < 3; k++) {
        double *at = around->at[k], *true_normal = around->true_normal[k];
        for (int i = 0; i < 8; i++) at[(n & ~7) + i] = true_normal[(n & ~7) + i] = 0;
        at[(n + 7) & ~7] = true_normal[(n + 7) & ~7] = 0;
    }
}

/* The facets round a vertex in order, all but what kernels find; 0 when they are too many or no single ring. */
static int look_round(simplify_region *r, uint32_t v, ring *out)
{
    spokes found;
    if (!find_spokes(r, v, &found)) return 0;
    const uint32_t count = (uint32_t)found.count;
    const double *middle = &r->xyz[3 * (size_t)v];
    float error = 0;
    next_stamp(r);
    for (uint32_t i = 0; i < count; i++) r->mark[found.from[i]] = r->stamp + i;
    out->count = found.count;
    put_noughts(out);
    for (uint32_t i = 0, spoke = 0; i < count; i++) {
        const simplify_facet *here = &r->facet[found.facet[spoke]];
        const double *at = &r->xyz[3 * (size_t)found.from[spoke]];
        out->facet[i] = found.facet[spoke];
        out->vertex[i] = found.from[spoke];
        error = here->error_mm > error ? here->error_mm : error;
        for (int k = 0; k < 3; k++) {
            out->at[k][i] = at[k] - middle[k];
            out->true_normal[k][i] = here->normal[k];
        }
        spoke = r->mark[found.to[spoke]] - r->stamp;
        if (spoke >= count || (spoke == 0) != (i + 1 == count)) return 0;
    }
    for (int k = 0; k < 3; k++) {
        out->at[k][count] = out->at[k][0];
        out->true_normal[k][count] = out->true_normal[k][0];
    }
    out->error = (double)error;
    return 1;
}

/* Of u's neighbours only the two beside it on the ring may be on the ring too, and no facet may come twice. */
static int keeps_topology(const simplify_region *r, const ring *around, int j, uint32_t v)
{
    const uint32_t u = around->vertex[j], before = around->vertex[ring_before(around, j)],
                   after = around->vertex[ring_after(around, j)];
    const int is_three = around->count == 3;
    const simplify_facet *here;
    int breaks = 0;
    for (uint32_t corner = r->head[u]; corner != SWARF_NO_VERTEX; corner = here->next[corner & 3]) {
        here = &r->facet[corner >> 2];
        /* v stands for those of other regions: neither is on the ring */
        const uint32_t first = here->v[following[corner & 3]], second = here->v[following[(corner & 3) + 1]];
        const uint32_t a = first == SWARF_NO_VERTEX ? v : first, b = second == SWARF_NO_VERTEX ? v : second;
        const int a_on = is_on_ring(r, a), b_on = is_on_ring(r, b);
        const int a_far = (a != before) & (a != after), b_far = (b != before) & (b != after);
        breaks |= here->alive & ((a_on & a_far) | (b_on & b_far) | (a_on & b_on & is_three));
    }
    return !breaks;
}

/* What the two facets that go when v is drawn onto ring vertex j had lost, shared out among those that stay; on an edge
 * of the surface each to its own side. */
static void share_lost(simplify_region *r, const ring *around, int j)
{
    const int n = around->count;
    float lost[2] = {r->facet[around->facet[j]].lost_mm3, r->facet[around->facet[ring_before(around, j)]].lost_mm3};
    int on_left = n - 2;
    for (int i = 1; i < n && around->crease >> j & 1; i++)
        if (around->crease >> (j + i) % n & 1) on_left = i - 1;
    const int on_right = n - 2 - on_left;
    if (on_left == 0 || on_right == 0) lost[0] = lost[1] = lost[0] + lost[1];
    const float left = lost[0] / (float)on_left, right = lost[1] / (float)on_right;
    for (int i = 1, at = ring_after(around, j); i < n - 1; i++, at = ring_after(around, at))
        r->facet[around->facet[at]].lost_mm3 += i <= on_left ? left : right;
}

/* Volume between the old place of facet i and the new when v is drawn onto ring vertex j, outside of the new, mm3. */
static float volume_lost(const ring *around, int j, int i)
{
    double lost = 0;
    for (int k = 0; k < 3; k++) lost -= around->at[k][j] * around->normal[k][i];
    return (float)(lost / 6);
}

/* To be looked at again. What a vertex was found to need still tells when its ring has changed: errors only grow, so
 * that to look again before the limit gets there seldom helps, and takes a fourth of the time. What no error was found
 * to allow is looked at again. */
static void make_dirty(simplify_region *r, uint32_t v)
{
    const int stays = r->state[v] & (SIMPLIFY_FIXED | SIMPLIFY_BENT);
    r->state[v] |= SIMPLIFY_DIRTY;
    if (!stays && isinf(r->need[v])) r->need[v] = 0;
}

static void draw(simplify_region *r, const ring *around, int j, uint32_t v, double error)
{
    const int n = around->count;
    const uint32_t u = around->vertex[j];
    const int before = ring_before(around, j);
    share_lost(r, around, j);
    for (int i = 0; i < n; i++) {
        const uint32_t f = around->facet[i];
        simplify_facet *here = &r->facet[f];
        if (i == j || i == before) {
            here->alive = 0;
            continue;
        }
        const uint32_t k = (uint32_t)(here->v[1] == v) + 2 * (uint32_t)(here->v[2] == v);
        here->v[k] = u;
        here->next[k] = r->head[u];
        r->head[u] = 4 * f + k;
        here->error_mm = (float)error;
        here->lost_mm3 += volume_lost(around, j, i);
    }
    r->head[v] = SWARF_NO_VERTEX;
    for (int i = 0; i < n; i++) make_dirty(r, around->vertex[i]);
}

/* The vertices of the ring that the middle might be drawn onto, and the least error of those found to be too far. */
static uint32_t find_candidates(const ring_kernel *kernel, ring *around, double limit, double *least)
{
    *least = INFINITY;
    if (around->slab < 0) kernel->find_dots(around);
    if (around->crease) return around->crease;
    return around->slab < 0 ? kernel->find_lifts(around, limit, least) : UINT32_MAX >> (RING_MOST - around->count);
}

/* Whether the distance to the facet that comes to lie over the middle tells that another draw is better. */
static int is_worse(const ring *around, int j, double limit, double best_score)
{
    return around->slab < 0 && !around->crease && ring_score(1, around->error + around->lift[j], limit) <= best_score;
}

/* Of the candidates the vertex with the best score, or -1; its error, or the least that was found to be too much. */
static int find_best(const ring_kernel *kernel, ring *around, uint32_t candidates, double limit, double *error)
{
    const double enough = around->slab >= 0 ? flat_enough : good_enough;
    int best = -1;
    double best_score = -1, best_error = 0, least_error = INFINITY;
    for (; candidates && best_score <= enough; candidates &= candidates - 1) {
        const int j = __builtin_ctz(candidates);
        double own_error, score;
        if (best >= 0 && is_worse(around, j, limit, best_score)) continue;
        if (kernel->try_draw(around, j, limit, best_score, &own_error, &score)) {
            best = j;
            best_score = score;
            best_error = own_error;
        } else {
            least_error = swarf_least(least_error, own_error);
        }
    }
    *error = best < 0 ? least_error : best_error;
    return best;
}

/* The ring vertex that v is to be drawn onto, or -1: `error` is then the least that was found to be too much. */
static int choose(const simplify_region *r, const ring_kernel *kernel, ring *around, uint32_t v, double limit,
                  double *error)
{
    double too_far;
    uint32_t left = find_candidates(kernel, around, limit, &too_far);
    for (;;) {
        const int best = find_best(kernel, around, left, limit, error);
        if (best < 0) *error = swarf_least(*error, too_far);
        if (best < 0 || keeps_topology(r, around, best, v)) return best;
        left &= ~(1U << best); /* which is rare */
    }
}

static int remove_vertex(simplify_region *r, const ring_kernel *kernel, uint32_t v, double limit, int flat_only)
{
    ring around;
    r->state[v] = 0;
    r->need[v] = INFINITY;
    if (!look_round(r, v, &around)) return 0;
    if (around.error > limit) {
        r->need[v] = (float)around.error;
        return 0;
    }
    around.crease = kernel->find_creases(&around);
    const uint32_t more = around.crease & (around.crease - 1);
    if (around.crease && (!more || more & (more - 1))) return 0; /* not two */
    around.shape = -1;
    kernel->look_flat(&around, limit);
    if (around.slab < 0 && flat_only) {
        r->state[v] = SIMPLIFY_DIRTY;
        r->need[v] = 0;
        return 0;
    }
    double error;
    const int best = choose(r, kernel, &around, v, limit, &error);
    if (best < 0) {
        r->need[v] = (float)error;
        return 0;
    }
    draw(r, &around, best, v, error);
    return 1;
}

/* A stride near the golden section of the count, without a common divisor. */
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
            int bent = 0;
            for (int c = 0; c < 3; c++) bent |= abs(own[c] - other[c]) > (int)ring_flat_normal;
            r->state[v] |= (uint8_t)(bent * SIMPLIFY_BENT);
        }
}

/* Fixed vertices need more than there is; so do those that are bent, while only flat ones are looked at. */
static void set_needs(simplify_region *r, int flat_only)
{
    for (size_t v = 0; v < r->vertex_count; v++) {
        if (!flat_only && r->state[v] & SIMPLIFY_BENT) {
            r->need[v] = 0;
            r->state[v] &= (uint8_t)~SIMPLIFY_BENT;
        }
        if (r->state[v] & (SIMPLIFY_FIXED | SIMPLIFY_BENT)) r->need[v] = INFINITY;
    }
}

/* Vertices whose needs are looked at together. */
enum { CHUNK = 16 };

/* From `v` on, past chunks of which none is to be looked at. */
static size_t skip_chunks(const simplify_region *r, size_t v, float limit)
{
    for (; v + CHUNK <= r->vertex_count; v += CHUNK) {
        int due = 0;
        for (size_t k = 0; k < CHUNK; k++) due |= r->need[v + k] <= limit;
        if (due) break;
    }
    return v;
}

/* The greatest float up to a limit. */
static float float_below(double limit)
{
    const float near = (float)limit;
    return (double)near <= limit ? near : nextafterf(near, 0);
}

/* One round over the vertices. Returns whether some went. */
static int go_round(simplify_region *r, const ring_kernel *kernel, double limit)
{
    const float most = float_below(limit);
    int removed = 0;
    for (size_t v = 0; v < r->vertex_count;) {
        if (v % CHUNK == 0) v = skip_chunks(r, v, most);
        for (const size_t end = v + CHUNK < r->vertex_count ? v + CHUNK : r->vertex_count; v < end; v++)
            if (r->need[v] <= most) removed |= remove_vertex(r, kernel, (uint32_t)v, limit, 0);
    }
    return removed;
}

/* The same on flat faces. */
static int go_round_flat(simplify_region *r, const ring_kernel *kernel, double limit)
{
    /* those that follow each other should be far apart, so that rings stay round */
    const size_t stride = stride_of(r->vertex_count), back = stride - r->vertex_count; /* modulo 2^n */
    const float most = float_below(limit);
    int removed = 0;
    for (size_t i = 0, v = 0; i < r->vertex_count; i++, v += v + stride < r->vertex_count ? stride : back)
        if (r->need[v] <= most) removed |= remove_vertex(r, kernel, (uint32_t)v, limit, 1);
    return removed;
}

void swarf_simplify_region(simplify_region *r, double limit, int first)
{
    static const double steps[] = {0.2, 0.45, 0.7, 1}, flat_step = 0.1;
    const ring_kernel *kernel = swarf_ring_kernel_current();
    if (first) {
        find_bent(r);
        set_needs(r, 1);
        for (int round = 0; round < ROUNDS && go_round_flat(r, kernel, limit * flat_step);) round++;
    }
    set_needs(r, 0);
    for (size_t step = first ? 0 : 3; step < sizeof steps / sizeof *steps; step++)
        for (int round = 0; round < ROUNDS && go_round(r, kernel, limit * steps[step]);) round++;
}
