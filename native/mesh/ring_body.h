/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernels of ring.h, compiled once per instruction set; KERNEL_NAME is the table's name.
 *
 * A lane of a pack is a facet, or the neighbour with its number. Sets of them are bits: 32 for the whole ring, as many
 * as there are lanes for the pack from `base` on. Places and true normals of a ring come with the first again after the
 * last, and with room for a whole pack from there.
 */
#include "base/least.h"
#include "base/pack.h"
#include "mesh/ring.h"

/* The vertices of flat rings are apart by this part of the limit. */
static const double flat_part = 0.05;
/* cos 25 degrees: sharper is an edge. On a ball of three voxels facets differ by up to 20. */
static const double edge_cosine = 0.906;
/* A facet may lean by 41 degrees from the true normal of where it was made: far more than the error allows to a facet
 * of usual size, far less than turning over. */
static const double least_cosine = 0.75;
/* Facets of 4 sqrt(3) area / (a^2 + b^2 + c^2) below this are needles (1: equilateral). */
static const double least_shape = 0.02;

typedef struct packs {
    pack x, y, z;
} packs;

INLINE packs load3(const double from[3][RING_ROOM], int at)
{
    return (packs){pack_load(&from[0][at]), pack_load(&from[1][at]), pack_load(&from[2][at])};
}

INLINE void store3(double to[3][RING_ROOM], int at, packs a)
{
    pack_store(&to[0][at], a.x);
    pack_store(&to[1][at], a.y);
    pack_store(&to[2][at], a.z);
}

/* Of one to all. */
INLINE packs all3(const double from[3][RING_ROOM], int at)
{
    return (packs){pack_of(from[0][at]), pack_of(from[1][at]), pack_of(from[2][at])};
}

INLINE packs pick3(unsigned bits, packs a, packs b)
{
    return (packs){pack_pick(bits, a.x, b.x), pack_pick(bits, a.y, b.y), pack_pick(bits, a.z, b.z)};
}

INLINE pack dot(packs a, packs b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

INLINE packs cross(packs a, packs b)
{
    return (packs){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

INLINE pack apart(packs a, packs b)
{
    const packs c = {a.x - b.x, a.y - b.y, a.z - b.z};
    return dot(c, c);
}

/* Of the facet u, a, b: from a x b, u x a and u x b. */
INLINE packs new_normal(packs old, packs before, packs after)
{
    return (packs){old.x + before.x - after.x, old.y + before.y - after.y, old.z + before.z - after.z};
}

INLINE uint32_t whole_ring(const ring *around)
{
    return UINT32_MAX >> (RING_MOST - around->count);
}

/* Those of the pack from `base` on. */
INLINE unsigned lanes_of(uint32_t bits, int base)
{
    return bits >> base & ((1U << PACK) - 1);
}

/* Put the first after the last, too. */
INLINE void close_ring(double of[3][RING_ROOM], int count)
{
    for (int k = 0; k < 3; k++) of[k][count] = of[k][0];
}

/* Squared shape of triangles (4 sqrt(3) area / sum of squared sides) from the square of their normal and that sum. */
INLINE pack shape_of(pack square, pack sum)
{
    return pack_pick(pack_below(pack_of(0), sum), 12 * square / (sum * sum), pack_of(0));
}

static double worst_shape(const ring *around)
{
    const uint32_t all = whole_ring(around);
    double worst = 1;
    for (int base = 0; base < around->count; base += PACK) {
        const packs a = load3(around->at, base), b = load3(around->at, base + 1), n = load3(around->normal, base);
        worst = swarf_least(worst,
                            pack_least(lanes_of(all, base), shape_of(dot(n, n), dot(a, a) + dot(b, b) + apart(a, b))));
    }
    return worst;
}

static void look_flat(ring *around, double limit)
{
    const uint32_t all = whole_ring(around);
    const packs true_normal = all3(around->true_normal, 0);
    const pack differ = pack_of(ring_flat_normal);
    unsigned bent = 0;
    double most = 0;
    for (int base = 0; base < around->count; base += PACK) {
        const unsigned own = lanes_of(all, base);
        const packs at = load3(around->at, base), n = load3(around->true_normal, base);
        store3(around->normal, base, cross(at, load3(around->at, base + 1)));
        bent |= own & (pack_below(differ, pack_size(n.x - true_normal.x)) |
                       pack_below(differ, pack_size(n.y - true_normal.y)) |
                       pack_below(differ, pack_size(n.z - true_normal.z)));
        most = swarf_most(most, pack_most(own, pack_size(dot(at, true_normal))));
    }
    most /= 32767;
    around->slab = !bent && most <= flat_part * limit ? most : -1;
}

static uint32_t find_creases(const ring *around)
{
    const int n = around->count;
    uint32_t sharp = 0; /* bit i: whether the edge to vertex i + 1 is */
    for (int base = 0; base < n; base += PACK) {
        const pack cosine = dot(load3(around->true_normal, base), load3(around->true_normal, base + 1));
        sharp |= pack_below(cosine, pack_of(edge_cosine * 32767 * 32767)) << base;
    }
    sharp &= whole_ring(around);
    return (sharp << 1 | sharp >> (n - 1)) & whole_ring(around);
}

static void find_dots(ring *around)
{
    for (int i = 0; i < around->count; i++)
        for (int base = 0; base < around->count; base += PACK)
            pack_store(&around->dots[i][base], dot(load3(around->at, base), all3(around->at, i)));
}

/* at[i] x at[k] and the sum of the true normals, for the k of a pack: above 0 where k is to the left of i. As at[k] and
 * that turned by i, or for those after i the other way round, so that what is asked of i and k is minus that of k and
 * i. */
INLINE pack side_of(const ring *around, const double turned[3][RING_ROOM], int i, int base)
{
    const pack own = dot(load3(around->at, base), all3(turned, i));
    const pack other = dot(all3(around->at, i), load3(turned, base));
    return pack_pick(lanes_of((1U << i) - 1, base), own, -other);
}

/* The facets whose end is not to the right of their start. */
static uint32_t find_open(const ring *around, const double turned[3][RING_ROOM])
{
    const int n = around->count;
    uint32_t open = 0;
    for (int base = 0; base < n; base += PACK) {
        const pack side = dot(load3(around->at, base), load3(turned, base + 1));
        open |= pack_up_to(side, pack_of(0)) << base;
    }
    const double last =
        around->at[0][0] * turned[0][n - 1] + around->at[1][0] * turned[1][n - 1] + around->at[2][0] * turned[2][n - 1];
    open &= whole_ring(around) >> 1;
    return open | (uint32_t)(last >= 0) << (n - 1);
}

/* For each neighbour of the pack from `base` on the first facet after it that has the middle between its sides, seen
 * from the neighbour. */
static void find_lifts_of(ring *around, const double turned[3][RING_ROOM], uint32_t open, int base)
{
    const int n = around->count;
    const pack nought = pack_of(0);
    packs a = {nought, nought, nought}, b = a;
    pack next = side_of(around, turned, 0, base);
    unsigned found = 0, after = 0; /* after: those for which it is after them without coming round */
    for (int i = n - 1; i >= 0; i--) {
        const pack side = side_of(around, turned, i, base);
        if (open >> i & 1) {
            const int end = ring_after(around, i);
            const uint32_t before = (1U << i) - 1, others = ~(1U << i | 1U << end);
            const unsigned here = lanes_of(before, base);
            unsigned hit = pack_up_to(side, nought) & pack_up_to(nought, next) & lanes_of(others, base);
            hit &= here | ~after;
            after |= hit & here;
            found |= hit;
            a = pick3(hit, all3(around->at, i), a);
            b = pick3(hit, all3(around->at, end), b);
        }
        next = side;
    }
    const packs u = load3(around->at, base), normal = new_normal(cross(a, b), cross(u, a), cross(u, b));
    const pack square = dot(normal, normal);
    found &= pack_below(nought, square);
    pack_store(&around->lift[base], pack_pick(found, pack_size(dot(u, normal)) / pack_root(square), nought));
}

/* The sum of the true normals, to all: whole numbers, of which the order does not matter. */
INLINE packs find_upward(const ring *around)
{
    const pack nought = pack_of(0);
    packs sum = {nought, nought, nought};
    for (int base = 0; base < around->count; base += PACK) {
        const packs own = pick3(lanes_of(whole_ring(around), base), load3(around->true_normal, base),
                                (packs){nought, nought, nought});
        sum = (packs){sum.x + own.x, sum.y + own.y, sum.z + own.z};
    }
    return (packs){pack_of(pack_sum(sum.x)), pack_of(pack_sum(sum.y)), pack_of(pack_sum(sum.z))};
}

static uint32_t find_lifts(ring *around, double limit, double *least)
{
    const int n = around->count;
    const uint32_t all = whole_ring(around);
    const packs upward = find_upward(around);
    _Alignas(64) double turned[3][RING_ROOM];
    int end = 0;
    do {
        store3(turned, end, cross(upward, load3(around->at, end)));
        end += PACK;
    } while (end <= n);
    close_ring(turned, n);
    const uint32_t open = find_open(around, turned);
    uint32_t near = 0;
    *least = INFINITY;
    for (int base = 0; base < n; base += PACK) {
        find_lifts_of(around, turned, open, base);
        const pack error = pack_of(around->error) + pack_load(&around->lift[base]);
        const unsigned within = pack_up_to(error, pack_of(limit)) & lanes_of(all, base);
        near |= within << base;
        *least = swarf_least(*least, pack_least(lanes_of(all, base) & ~within, error));
    }
    return near;
}

/* Squared distances of the middle to the segments between ring vertices i and j. */
INLINE pack to_segments(const ring *around, int j, int base)
{
    const packs at = load3(around->at, base);
    const pack start = dot(at, at), both = pack_load(&around->dots[j][base]), along = start - both;
    const pack square = start + around->dots[j][j] - 2 * both, nought = pack_of(0);
    const unsigned behind = pack_up_to(along, nought) | pack_up_to(square, nought);
    pack t = pack_pick(pack_up_to(square, along), pack_of(1), along / square);
    t = pack_pick(behind, nought, t);
    const pack away = start - 2 * t * along + t * t * square;
    return pack_pick(pack_below(nought, away), away, nought);
}

/* The most of the squared distances between the edges from the middle to some ring vertices i and that from ring vertex
 * j to k, where they pass each other between their ends; 0 where none does. */
INLINE double where_they_pass(const ring *around, unsigned some, int j, int k, int base)
{
    const packs at = load3(around->at, base);
    const pack nought = pack_of(0), ij = pack_load(&around->dots[j][base]);
    const double jj = around->dots[j][j], c = around->dots[k][k] + jj - 2 * around->dots[j][k];
    const double e = jj - around->dots[j][k];
    const pack a = dot(at, at), b = pack_load(&around->dots[k][base]) - ij, d = -ij;
    const pack size = a * c - b * b, s = b * e - c * d, t = a * e - b * d;
    some &= pack_below(1e-9 * a * c, size) & pack_below(nought, s) & pack_below(s, size) & pack_below(nought, t) &
            pack_below(t, size);
    if (!some) return 0;
    const pack u = s / size, v = t / size, w = 1 - v;
    const packs part = {u * at.x - w * around->at[0][j] - v * around->at[0][k],
                        u * at.y - w * around->at[1][j] - v * around->at[1][k],
                        u * at.z - w * around->at[2][j] - v * around->at[2][k]};
    return swarf_most(0, pack_most(some, dot(part, part)));
}

/* Squared greatest distance between the edges to the middle that go and the edges to u = ring vertex j that come, where
 * they pass each other: with the middle's own distance it is that between the old facets and the new. On an edge of the
 * surface its two sides do not mix. Not looked for further where it is more than `enough`. */
static double between_edges(const ring *around, int j, double enough)
{
    const int n = around->count;
    const uint32_t own = 1U << j;
    uint32_t sides[2] = {whole_ring(around) & ~own, 0};
    if (around->crease & own) {
        const uint32_t other = around->crease & ~own, low = (own < other ? own : other), high = own ^ other ^ low;
        sides[1] = (high - 1) & ~(2 * low - 1);
        sides[0] &= ~(other | sides[1]);
    }
    const uint32_t beside = own | 1U << ring_after(around, j) | 1U << ring_before(around, j);
    double most = 0;
    for (uint32_t ends = whole_ring(around) & ~beside; ends && most <= enough; ends &= ends - 1) {
        const int k = __builtin_ctz(ends);
        const uint32_t some = (sides[0] >> k & 1 ? sides[0] : sides[1] >> k & 1 ? sides[1] : 0) & ~(1U << k);
        for (int base = 0; base < n; base += PACK)
            if (lanes_of(some, base))
                most = swarf_most(most, where_they_pass(around, lanes_of(some, base), j, k, base));
    }
    return most;
}

/* The facets that come when the middle is drawn onto ring vertex j: their worst squared shape, and the least squared
 * distance of the middle to those it lies over. 0 when one turns or becomes a needle. */
static int look_at_facets(ring *around, int j, double *shape, double *nearest)
{
    const uint32_t some = whole_ring(around) & ~(1U << j | 1U << ring_before(around, j));
    const packs u = all3(around->at, j);
    const pack nought = pack_of(0), needle = pack_of(least_shape * least_shape);
    *shape = 1;
    *nearest = INFINITY;
    for (int base = 0; base < around->count; base += PACK) {
        const unsigned own = lanes_of(some, base);
        const packs a = load3(around->at, base), b = load3(around->at, base + 1);
        const packs before = cross(u, a), after = cross(u, b), old = load3(around->normal, base);
        const packs normal = new_normal(old, before, after);
        const pack square = dot(normal, normal), facing = dot(normal, load3(around->true_normal, base));
        const unsigned turns = pack_up_to(facing, nought) |
                               pack_below(facing * facing, least_cosine * least_cosine * 32767 * 32767 * square);
        if (turns & own) return 0;
        const pack shapes = shape_of(square, apart(a, b) + apart(a, u) + apart(b, u));
        const unsigned needles = own & pack_below(shapes, needle);
        if (needles) {
            if (around->shape < 0) around->shape = worst_shape(around);
            if (needles & pack_up_to(shapes, pack_of(around->shape))) return 0;
        }
        *shape = swarf_least(*shape, pack_least(own, shapes));
        if (around->slab >= 0) continue;
        const unsigned over = own & pack_up_to(nought, dot(old, normal)) & pack_up_to(nought, dot(before, normal)) &
                              pack_up_to(dot(after, normal), nought);
        const pack away = dot(u, normal);
        if (over) *nearest = swarf_least(*nearest, pack_least(over, away * away / square));
    }
    return 1;
}

/* The squared distance of the middle to the edges that come, too; where it lies over none of the facets it is not less
 * than that. On an edge of the surface it counts how far the middle lies from the new one. */
static double look_at_edges(const ring *around, int j, double nearest, double spare)
{
    const uint32_t others = whole_ring(around) & ~(1U << j);
    const uint32_t crease = around->crease >> j & 1 ? around->crease & others : 0;
    double most = 0;
    if (nearest <= spare && !crease) return nearest;
    const int look = nearest > spare;
    for (int base = 0; base < around->count; base += PACK) {
        const pack away = to_segments(around, j, base);
        if (look) nearest = swarf_least(nearest, pack_least(lanes_of(others, base), away));
        most = swarf_most(most, pack_most(lanes_of(crease, base), away));
    }
    return swarf_most(nearest, most);
}

static int try_draw(ring *around, int j, double limit, double least, double *error, double *score)
{
    const double spare = (limit - around->error) * (limit - around->error);
    double shape, nearest;
    *error = INFINITY;
    if (!look_at_facets(around, j, &shape, &nearest)) return 0;
    if (least > 0 && shape <= least * least) return 0;
    if (around->slab >= 0) { /* old facets and new cover the same ground within it */
        *error = around->error + 2 * around->slab;
        *score = sqrt(shape);
        return *error <= limit;
    }
    nearest = look_at_edges(around, j, nearest, spare);
    *error = around->error + sqrt(nearest);
    if (*error > limit || ring_score(shape, *error, limit) <= least) return 0;
    /* beyond this error the score is not above `least` either */
    const double last = least > 0 ? swarf_least(limit, limit * (1 - least / sqrt(shape)) / ring_score_error) : limit;
    const double enough = (last - around->error) * (last - around->error);
    *error = around->error + sqrt(swarf_most(nearest, between_edges(around, j, enough)));
    *score = ring_score(shape, *error, limit);
    return *error <= limit && *score > least;
}

const ring_kernel KERNEL_NAME = {find_creases, look_flat, find_dots, find_lifts, try_draw};
