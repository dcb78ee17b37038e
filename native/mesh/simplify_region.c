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
#include "mesh/simplify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Facets round a vertex that is looked at; hubs with more stay. */
enum { MOST = 32 };
/* Rounds over the vertices at one limit; what is left after them is not worth looking for. */
enum { ROUNDS = 6 };
/* cos 25 degrees: sharper is an edge. On a ball of three voxels facets differ by up to 20. */
static const double edge_cosine = 0.906;
/* A facet may lean by 41 degrees from the true normal of where it was made: far more than the error allows to a facet
 * of usual size, far less than turning over. */
static const double least_cosine = 0.75;
/* Facets of 4 sqrt(3) area / (a^2 + b^2 + c^2) below this are needles (1: equilateral). */
static const double least_shape = 0.02;

/* A choice that leaves facets as good as this is taken without looking at the others: they cost most of the time. */
static const double good_enough = 0.5;
/* Flat rings, of which there are most: true normals (of length 32767) differ by this, vertices by this part of the
 * limit; and what is good enough there, where all but the border goes in the end. */
static const double flat_normal = 8, flat_part = 0.05, flat_enough = 0.3;

/* The facets round a vertex, in coordinates from it: those are small, so that doubles lose nothing. */
typedef struct ring {
    int count;
    uint32_t vertex[MOST]; /* facet i: the middle, vertex i, vertex i + 1 */
    uint32_t facet[MOST];
    uint8_t crease[MOST]; /* whether the edge to vertex i is one of the surface */
    double error;         /* greatest of the facets */
    double shape;         /* least; negative: not measured yet */
    double slab;          /* of a flat ring: half of its thickness, across the true normal; else negative */
    double at[MOST][3];
    double normal[MOST][3]; /* of facet i with its old place, not unit */
    double true_normal[MOST][3];
    /* of rings that are not flat: */
    double dots[MOST][MOST]; /* of at[i] and at[k] */
    double side[MOST][MOST]; /* of at[i] x at[k] and the sum of the true normals: above 0 where k is to the left of i */
} ring;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* fmin() and fmax() are calls, for the sake of NaNs that cannot come here. */
static double least_of(double a, double b)
{
    return a < b ? a : b;
}

static double most_of(double a, double b)
{
    return a > b ? a : b;
}

/* Squared distance of the middle to the segment between ring vertices i and j. */
static double to_segment(const ring *around, int i, int j)
{
    const double start = around->dots[i][i], along = start - around->dots[i][j];
    const double square = start + around->dots[j][j] - 2 * around->dots[i][j];
    const double t = along <= 0 || square <= 0 ? 0 : along >= square ? 1 : along / square;
    return most_of(0, start - 2 * t * along + t * t * square);
}

/* Squared distance between the edge from the middle to ring vertex i and that from ring vertex j to k where they pass
 * each other between their ends, else 0. */
static double where_they_pass(const ring *around, int i, int j, int k)
{
    const double ij = around->dots[i][j], jj = around->dots[j][j];
    const double a = around->dots[i][i], b = around->dots[i][k] - ij;
    const double c = around->dots[k][k] + jj - 2 * around->dots[j][k];
    const double d = -ij, e = jj - around->dots[j][k], size = a * c - b * b;
    if (size <= 1e-9 * a * c) return 0;
    const double s = b * e - c * d, t = a * e - b * d;
    if (s <= 0 || s >= size || t <= 0 || t >= size) return 0;
    const double u = s / size, v = t / size;
    double away = 0;
    for (int n = 0; n < 3; n++) {
        const double part = u * around->at[i][n] - (1 - v) * around->at[j][n] - v * around->at[k][n];
        away += part * part;
    }
    return away;
}

static int is_crease(const simplify_facet *a, const simplify_facet *b)
{
    int32_t sum = 0; /* of three products below 2^30, of which the squares sum up to one */
    for (int k = 0; k < 3; k++) sum += a->normal[k] * b->normal[k];
    return (double)sum < edge_cosine * 32767 * 32767;
}

/* Squared shape of a triangle (4 sqrt(3) area / sum of squared sides) from the square of its normal and that sum. */
static double shape_of(double square, double sum)
{
    return sum > 0 ? 12 * square / (sum * sum) : 0;
}

static double apart(const double a[3], const double b[3])
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
}

static double worst_shape(const ring *around)
{
    double worst = 1;
    for (int i = 0; i < around->count; i++) {
        const double *a = around->at[i], *b = around->at[i + 1 < around->count ? i + 1 : 0];
        worst =
            least_of(worst, shape_of(dot(around->normal[i], around->normal[i]), dot(a, a) + dot(b, b) + apart(a, b)));
    }
    return worst;
}

/* Corners after a corner of a facet. */
static const uint8_t following[4] = {1, 2, 0, 1};

/* The facets round a vertex in order; 0 when they are too many or no single ring. */
static int look_round(simplify_region *r, uint32_t v, ring *out)
{
    uint32_t facet[MOST], from[MOST], to[MOST], *link = &r->head[v];
    int count = 0;
    while (*link != SWARF_NO_VERTEX) {
        const uint32_t f = *link >> 2, k = *link & 3;
        simplify_facet *here = &r->facet[f];
        if (!here->alive) {
            *link = here->next[k];
            continue;
        }
        if (count == MOST) return 0;
        facet[count] = f;
        from[count] = here->v[following[k]];
        to[count++] = here->v[following[k + 1]];
        link = &here->next[k];
    }
    if (count < 3) return 0;
    out->count = count;
    out->error = 0;
    out->shape = -1;
    for (int i = 0, at = 0; i < count; i++) {
        out->facet[i] = facet[at];
        out->vertex[i] = from[at];
        out->error = most_of(out->error, (double)r->facet[facet[at]].error_mm);
        int follow = count;
        for (int k = 0; k < count; k++) follow = from[k] == to[at] ? k : follow; /* without jumps */
        if (follow == count || (i < count - 1 && follow == 0)) return 0;
        at = follow;
        if (i == count - 1 && at != 0) return 0;
    }
    for (int i = 0; i < count; i++) {
        const int before = i ? i - 1 : count - 1;
        out->crease[i] = (uint8_t)is_crease(&r->facet[out->facet[before]], &r->facet[out->facet[i]]);
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
        const int a_on = a != SWARF_NO_VERTEX && r->mark[a] == r->stamp;
        const int b_on = b != SWARF_NO_VERTEX && r->mark[b] == r->stamp;
        if ((a_on && a != before && a != after) || (b_on && b != before && b != after)) return 0;
        if (a_on && b_on && n == 3) return 0;
    }
    return 1;
}

/* Squared greatest distance between the edges to v that go and the edges to u = ring vertex j that come, where they
 * pass each other: with v's own distance it is that between the old facets and the new. On an edge of the surface its
 * two sides do not mix. Not looked for further where it is more than `enough`. */
static double between_edges(const ring *around, int j, double enough)
{
    const int n = around->count;
    double most = 0;
    int side = 0, side_of[MOST];
    for (int step = 1, i = j; step < n; step++) {
        i = i + 1 < n ? i + 1 : 0;
        if (around->crease[j] && around->crease[i]) side++;
        side_of[i] = around->crease[i] && around->crease[j] ? -1 : side;
    }
    for (int k = 0; k < n && most <= enough; k++) {
        /* cppcheck-suppress uninitvar ; all but that of j are set */
        if (k == j || k == (j + 1) % n || k == (j + n - 1) % n || side_of[k] < 0) continue;
        for (int i = 0; i < n; i++)
            if (i != j && i != k && side_of[i] == side_of[k]) most = most_of(most, where_they_pass(around, i, j, k));
    }
    return most;
}

/* Of several choices the best has the best worst facet, and little error. */
static const double score_error = 0.95;

static double score_of(double shape, double error, double limit)
{
    return sqrt(shape) * (1 - score_error * error / limit);
}

/* How far the middle lies from the new facet that comes to lie over it when it is drawn onto ring vertex j; 0 when it
 * lies over none. This alone rules out most of what is looked at on curved faces. */
static double lift(const ring *around, int j)
{
    const int n = around->count;
    const double *side = around->side[j], *u = around->at[j];
    int i = j + 1 < n ? j + 1 : 0;
    for (int left = n - 2; left > 0; left--) {
        const int next = i + 1 < n ? i + 1 : 0;
        if (side[i] >= 0 && side[next] <= 0 && around->side[i][next] >= 0) {
            double a[3], b[3], normal[3];
            cross(u, around->at[i], a);
            cross(u, around->at[next], b);
            for (int k = 0; k < 3; k++) normal[k] = around->normal[i][k] + a[k] - b[k];
            const double square = dot(normal, normal);
            return square > 0 ? fabs(dot(u, normal)) / sqrt(square) : 0;
        }
        i = next;
    }
    return 0;
}

/* Error and score of drawing v onto ring vertex j; 0 when the error is too much, a facet turns or becomes a needle, or
 * the score is not above `least`: the error is then a lower bound of what it takes. Where v lies over none of the new
 * facets its distance is that from the edges between them, which is not less. */
static int try_draw(ring *around, int j, double limit, double least, double *error, double *score)
{
    const int n = around->count;
    const double *u = around->at[j];
    const double spare = (limit - around->error) * (limit - around->error);
    double nearest = INFINITY, before[3], after[3], normal[3];
    double shape = 1;
    if (around->slab < 0 && !around->crease[j]) {
        *error = around->error + lift(around, j);
        if (*error > limit || score_of(1, *error, limit) <= least) return 0;
    }
    *error = INFINITY;
    int i = j + 1 < n ? j + 1 : 0;
    cross(u, around->at[i], before);
    for (int left = n - 2; left > 0; left--) {
        const int next = i + 1 < n ? i + 1 : 0;
        cross(u, around->at[next], after);
        for (int k = 0; k < 3; k++) normal[k] = around->normal[i][k] + before[k] - after[k];
        const double square = dot(normal, normal), facing = dot(normal, around->true_normal[i]);
        if (facing <= 0 || facing * facing < least_cosine * least_cosine * 32767 * 32767 * square) return 0;
        const double *a = around->at[i], *b = around->at[next];
        const double own = shape_of(square, apart(a, b) + apart(a, u) + apart(b, u));
        if (own < least_shape * least_shape) {
            if (around->shape < 0) around->shape = worst_shape(around);
            if (own <= around->shape) return 0;
        }
        shape = least_of(shape, own);
        if (least > 0 && shape <= least * least) return 0;
        if (around->slab < 0 && dot(around->normal[i], normal) >= 0 && dot(before, normal) >= 0 &&
            dot(after, normal) <= 0) { /* v lies over the facet */
            const double away = dot(u, normal);
            nearest = least_of(nearest, away * away / square);
        }
        memcpy(before, after, sizeof before);
        i = next;
    }
    if (around->slab >= 0) { /* old facets and new cover the same ground within it */
        *error = around->error + 2 * around->slab;
        *score = sqrt(shape);
        return *error <= limit;
    }
    if (nearest > spare)
        for (i = 0; i < n; i++)
            if (i != j) nearest = least_of(nearest, to_segment(around, i, j));
    if (around->crease[j])
        for (i = 0; i < n; i++)
            if (around->crease[i] && i != j) nearest = most_of(nearest, to_segment(around, i, j));
    *error = around->error + sqrt(nearest);
    if (*error > limit || score_of(shape, *error, limit) <= least) return 0;
    /* beyond this error the score is not above `least` either */
    const double last = least > 0 ? least_of(limit, limit * (1 - least / sqrt(shape)) / score_error) : limit;
    const double enough = (last - around->error) * (last - around->error);
    *error = around->error + sqrt(most_of(nearest, between_edges(around, j, enough)));
    *score = score_of(shape, *error, limit);
    return *error <= limit && *score > least;
}

static void draw(simplify_region *r, const ring *around, int j, uint32_t v, double error)
{
    const int n = around->count;
    const uint32_t u = around->vertex[j];
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
    }
    r->head[v] = SWARF_NO_VERTEX;
    for (int i = 0; i < n; i++) r->state[around->vertex[i]] |= SIMPLIFY_DIRTY;
}

/* The ring's places, normals and products. */
static void measure_round(const simplify_region *r, uint32_t v, ring *around)
{
    const int n = around->count;
    for (int i = 0; i < n; i++) {
        const int16_t *true_normal = r->facet[around->facet[i]].normal;
        for (int k = 0; k < 3; k++) {
            around->at[i][k] = r->xyz[3 * (size_t)around->vertex[i] + (size_t)k] - r->xyz[3 * (size_t)v + (size_t)k];
            around->true_normal[i][k] = true_normal[k];
        }
    }
    for (int i = 0; i < n; i++) cross(around->at[i], around->at[i + 1 < n ? i + 1 : 0], around->normal[i]);
}

/* The products of the ring's vertices. */
static void measure_pairs(ring *around)
{
    const int n = around->count;
    double up[3] = {0};
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) up[k] += around->true_normal[i][k];
    for (int i = 0; i < n; i++) {
        double turned[3]; /* at[k] . turned = side[i][k] */
        cross(up, around->at[i], turned);
        for (int k = 0; k < i; k++) {
            around->dots[i][k] = around->dots[k][i] = dot(around->at[i], around->at[k]);
            around->side[i][k] = dot(around->at[k], turned);
            around->side[k][i] = -around->side[i][k];
        }
        around->dots[i][i] = dot(around->at[i], around->at[i]);
        around->side[i][i] = 0;
    }
}

/* Find out whether all facets have one true normal and the ring's vertices lie in one plane across it. */
static void look_flat(ring *around, double limit)
{
    const double *n = around->true_normal[0];
    double most = 0;
    around->slab = -1;
    for (int i = 0; i < around->count; i++) {
        for (int k = 0; k < 3; k++)
            if (fabs(around->true_normal[i][k] - n[k]) > flat_normal) return;
        most = most_of(most, fabs(dot(around->at[i], n)));
    }
    most /= 32767;
    if (most <= flat_part * limit) around->slab = most;
}

static int remove_vertex(simplify_region *r, uint32_t v, double limit, int flat_only)
{
    ring around;
    r->need[v] = INFINITY;
    if (!look_round(r, v, &around)) return 0;
    if (around.error > limit) {
        r->need[v] = (float)around.error;
        return 0;
    }
    int creases = 0;
    for (int i = 0; i < around.count; i++) creases += around.crease[i];
    if (creases != 0 && creases != 2) return 0;
    measure_round(r, v, &around);
    look_flat(&around, limit);
    if (around.slab < 0) {
        if (flat_only) {
            r->state[v] = SIMPLIFY_DIRTY;
            r->need[v] = 0;
            return 0;
        }
        measure_pairs(&around);
    }
    r->stamp++;
    for (int i = 0; i < around.count; i++) r->mark[around.vertex[i]] = r->stamp;
    int best = -1;
    double best_score = -1, best_error = 0, least_error = INFINITY;
    for (int j = 0; j < around.count; j++) {
        double error, score;
        if (creases && !around.crease[j]) continue;
        if (!try_draw(&around, j, limit, best_score, &error, &score)) {
            least_error = least_of(least_error, error);
            continue;
        }
        if (!keeps_topology(r, &around, j, v)) continue;
        best = j;
        best_score = score;
        best_error = error;
        if (score > (around.slab >= 0 ? flat_enough : good_enough)) break;
    }
    if (best < 0) {
        r->need[v] = (float)least_error;
        return 0;
    }
    draw(r, &around, best, v, best_error);
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
                if (abs(own[c] - other[c]) > (int)flat_normal) r->state[v] |= SIMPLIFY_BENT;
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
                removed |= remove_vertex(r, (uint32_t)v, at, step == 0);
            }
        }
        for (size_t v = 0; step == 0 && v < r->vertex_count; v++) r->state[v] &= (uint8_t)~SIMPLIFY_BENT;
    }
}
