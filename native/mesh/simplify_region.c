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

typedef struct ring {
    int count;
    uint32_t vertex[MOST]; /* facet i: the middle, vertex i, vertex i + 1 */
    uint32_t facet[MOST];
    uint8_t crease[MOST]; /* whether the edge to vertex i is one of the surface */
    double error;         /* greatest of the facets */
    double shape;         /* least; negative: not measured yet */
} ring;

static void sub(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

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

/* Squared distance to a segment. */
static double to_segment(const double p[3], const double a[3], const double b[3])
{
    double ab[3], ap[3];
    sub(b, a, ab);
    sub(p, a, ap);
    const double square = dot(ab, ab), along = dot(ap, ab);
    const double t = along <= 0 || square <= 0 ? 0 : along >= square ? 1 : along / square;
    double away = 0;
    for (int k = 0; k < 3; k++) away += (ap[k] - t * ab[k]) * (ap[k] - t * ab[k]);
    return away;
}

/* Squared distance to the plane of a triangle where the point lies over it, else INFINITY. */
static double over_triangle(const double ap[3], const double ab[3], const double ac[3], const double n[3])
{
    const double square = dot(n, n);
    double t[3];
    cross(ap, ac, t);
    const double u = dot(t, n);
    if (!(u >= 0)) return INFINITY;
    cross(ab, ap, t);
    const double v = dot(t, n);
    if (!(v >= 0 && u + v <= square && square > 0)) return INFINITY;
    const double away = dot(ap, n);
    return away * away / square;
}

/* Squared distance between two segments (from a point along a vector) where they pass each other between their ends,
 * else 0. */
static double where_they_pass(const double p[3], const double along[3], const double q[3], const double across[3])
{
    double w[3];
    sub(p, q, w);
    const double a = dot(along, along), b = dot(along, across), c = dot(across, across);
    const double d = dot(along, w), e = dot(across, w), size = a * c - b * b;
    if (size <= 1e-9 * a * c) return 0;
    const double s = (b * e - c * d) / size, t = (a * e - b * d) / size;
    if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return 0;
    double away = 0;
    for (int k = 0; k < 3; k++) away += (w[k] + s * along[k] - t * across[k]) * (w[k] + s * along[k] - t * across[k]);
    return away;
}

static double normals_dot(const swarf_facet *a, const swarf_facet *b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += (double)a->normal[k] * b->normal[k];
    return sum / (32767.0 * 32767.0);
}

/* Squared shape of the triangle 0, a, b (4 sqrt(3) area / sum of squared sides); its normal and the square of that. */
static inline double shape_of(const double a[3], const double b[3], double normal[3], double *square)
{
    double ab[3];
    sub(b, a, ab);
    cross(a, b, normal);
    *square = dot(normal, normal);
    const double sum = dot(a, a) + dot(b, b) + dot(ab, ab);
    return sum > 0 ? 12 * *square / (sum * sum) : 0;
}

static double worst_shape(const simplify_region *r, const ring *around, const double *at)
{
    double worst = 1, square, normal[3], a[3], b[3];
    for (int i = 0; i < around->count; i++) {
        sub(r->xyz + 3 * (size_t)around->vertex[i], at, a);
        sub(r->xyz + 3 * (size_t)around->vertex[i + 1 < around->count ? i + 1 : 0], at, b);
        worst = least_of(worst, shape_of(a, b, normal, &square));
    }
    return worst;
}

/* The facets round a vertex in order; 0 when they are too many or no single ring. */
static int look_round(simplify_region *r, uint32_t v, ring *out)
{
    uint32_t facet[MOST], from[MOST], to[MOST], *link = &r->head[v];
    int count = 0;
    while (*link != SWARF_NO_VERTEX) {
        const uint32_t corner = *link, f = corner / 3;
        if (!r->alive[f]) {
            *link = r->next[corner];
            continue;
        }
        if (count == MOST) return 0;
        facet[count] = f;
        from[count] = r->v[3 * f + (corner + 1 - 3 * f) % 3];
        to[count++] = r->v[3 * f + (corner + 2 - 3 * f) % 3];
        link = &r->next[corner];
    }
    if (count < 3) return 0;
    out->count = count;
    out->error = 0;
    out->shape = -1;
    for (int i = 0, at = 0; i < count; i++) {
        out->facet[i] = facet[at];
        out->vertex[i] = from[at];
        out->error = most_of(out->error, (double)r->of[facet[at]]->error_mm);
        int follow = 0;
        while (follow < count && from[follow] != to[at]) follow++;
        if (follow == count || (i < count - 1 && follow == 0)) return 0;
        at = follow;
        if (i == count - 1 && at != 0) return 0;
    }
    for (int i = 0; i < count; i++) {
        const int before = i ? i - 1 : count - 1;
        out->crease[i] = normals_dot(r->of[out->facet[before]], r->of[out->facet[i]]) < edge_cosine;
    }
    return 1;
}

/* Of u's neighbours only the two beside it on the ring may be on the ring too, and no facet may come twice. */
static int keeps_topology(const simplify_region *r, const ring *around, int j, uint32_t v)
{
    const int n = around->count;
    const uint32_t u = around->vertex[j], before = around->vertex[(j + n - 1) % n], after = around->vertex[(j + 1) % n];
    for (uint32_t corner = r->head[u]; corner != SWARF_NO_VERTEX; corner = r->next[corner]) {
        const uint32_t f = corner / 3;
        if (!r->alive[f]) continue;
        const uint32_t a = r->v[3 * f + (corner + 1 - 3 * f) % 3], b = r->v[3 * f + (corner + 2 - 3 * f) % 3];
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
 * two sides do not mix. */
static double between_edges(const simplify_region *r, const ring *around, int j, const double *at)
{
    const int n = around->count;
    const double *u = r->xyz + 3 * (size_t)around->vertex[j];
    double most = 0, come[3], go[3];
    int side = 0, side_of[MOST];
    for (int step = 1; step < n; step++) {
        const int i = (j + step) % n;
        if (around->crease[j] && around->crease[i]) side++;
        side_of[i] = around->crease[i] && around->crease[j] ? -1 : side;
    }
    for (int step = 2; step < n - 1; step++) {
        const int k = (j + step) % n;
        if (side_of[k] < 0) continue;
        sub(r->xyz + 3 * (size_t)around->vertex[k], u, come);
        for (int other = 1; other < n; other++) {
            const int i = (j + other) % n;
            if (i == k || side_of[i] != side_of[k]) continue;
            sub(r->xyz + 3 * (size_t)around->vertex[i], at, go);
            most = most_of(most, where_they_pass(at, go, u, come));
        }
    }
    return most;
}

/* Error and worst shape after drawing v onto ring vertex j; 0 when it is too much, a facet turns or becomes a needle.
 * Where v lies over none of the new facets its distance is that from the edges between them, which is not less. */
static int try_draw(const simplify_region *r, ring *around, int j, const double *at, double limit, double *error,
                    double *shape)
{
    const int n = around->count;
    const double *u = r->xyz + 3 * (size_t)around->vertex[j];
    const double spare = (limit - around->error) * (limit - around->error);
    double nearest = INFINITY, to_v[3], a[3], b[3], normal[3], square;
    sub(at, u, to_v);
    *shape = 1;
    int i = j + 1 < n ? j + 1 : 0;
    sub(r->xyz + 3 * (size_t)around->vertex[i], u, a);
    for (int left = n - 2; left > 0; left--) {
        const int after = i + 1 < n ? i + 1 : 0;
        sub(r->xyz + 3 * (size_t)around->vertex[after], u, b);
        *shape = least_of(*shape, shape_of(a, b, normal, &square));
        if (*shape < least_shape * least_shape) {
            if (around->shape < 0) around->shape = worst_shape(r, around, at);
            if (*shape <= around->shape) return 0;
        }
        const int16_t *true_normal = r->of[around->facet[i]]->normal;
        const double facing = normal[0] * true_normal[0] + normal[1] * true_normal[1] + normal[2] * true_normal[2];
        if (facing <= 0 || facing * facing < least_cosine * least_cosine * 32767 * 32767 * square) return 0;
        nearest = least_of(nearest, over_triangle(to_v, a, b, normal));
        memcpy(a, b, sizeof a);
        i = after;
    }
    if (nearest > spare)
        for (i = 0; i < n; i++)
            if (i != j) nearest = least_of(nearest, to_segment(at, u, r->xyz + 3 * (size_t)around->vertex[i]));
    if (around->crease[j])
        for (i = 0; i < n; i++)
            if (around->crease[i] && i != j)
                nearest = most_of(nearest, to_segment(at, u, r->xyz + 3 * (size_t)around->vertex[i]));
    if (nearest > spare) return 0;
    *error = around->error + sqrt(most_of(nearest, between_edges(r, around, j, at)));
    return *error <= limit;
}

static void draw(simplify_region *r, const ring *around, int j, uint32_t v, double error)
{
    const int n = around->count;
    const uint32_t u = around->vertex[j];
    for (int i = 0; i < n; i++) {
        const uint32_t f = around->facet[i];
        if (i == j || (i + 1) % n == j) {
            r->alive[f] = 0;
            continue;
        }
        const uint32_t corner = 3 * f + (r->v[3 * f] == v ? 0u : r->v[3 * f + 1] == v ? 1u : 2u);
        r->v[corner] = u;
        r->next[corner] = r->head[u];
        r->head[u] = corner;
        r->of[f]->error_mm = (float)error;
    }
    r->head[v] = SWARF_NO_VERTEX;
    for (int i = 0; i < n; i++) r->state[around->vertex[i]] |= SIMPLIFY_DIRTY;
}

static int remove_vertex(simplify_region *r, uint32_t v, double limit)
{
    ring around;
    if (!look_round(r, v, &around) || around.error > limit) return 0;
    int creases = 0;
    for (int i = 0; i < around.count; i++) creases += around.crease[i];
    if (creases != 0 && creases != 2) return 0;
    r->stamp++;
    for (int i = 0; i < around.count; i++) r->mark[around.vertex[i]] = r->stamp;
    const double *at = r->xyz + 3 * (size_t)v;
    int best = -1;
    double best_score = -1, best_error = 0;
    for (int j = 0; j < around.count; j++) {
        double error, shape;
        if (creases && !around.crease[j]) continue;
        if (!try_draw(r, &around, j, at, limit, &error, &shape)) continue;
        const double score = sqrt(shape) * (1 - 0.95 * error / limit);
        if (score <= best_score || !keeps_topology(r, &around, j, v)) continue;
        best = j;
        best_score = score;
        best_error = error;
        if (score > good_enough) break;
    }
    if (best < 0) return 0;
    draw(r, &around, best, v, best_error);
    return 1;
}

size_t swarf_simplify_region(simplify_region *r, double limit, int first)
{
    static const double steps[] = {0.01, 0.05, 0.15, 0.4, 1};
    for (size_t step = first ? 0 : 4; step < sizeof steps / sizeof *steps; step++) {
        for (size_t v = 0; first && v < r->vertex_count; v++) r->state[v] |= SIMPLIFY_DIRTY;
        for (int round = 0, removed = 1; round < ROUNDS && removed; round++) {
            removed = 0;
            for (uint32_t v = 0; v < r->vertex_count; v++) {
                if (r->state[v] != SIMPLIFY_DIRTY || r->head[v] == SWARF_NO_VERTEX) continue;
                r->state[v] = 0;
                removed |= remove_vertex(r, v, limit * steps[step]);
            }
        }
    }
    size_t gone = 0;
    for (size_t f = 0; f < r->owned_count; f++) { /* the others are read by other threads */
        swarf_facet *facet = r->of[f];
        if (!r->alive[f]) {
            facet->v[0] = SWARF_NO_VERTEX;
            gone++;
            continue;
        }
        for (size_t k = 0; k < 3; k++) facet->v[k] = r->global[r->v[3 * f + k]];
    }
    return gone;
}
