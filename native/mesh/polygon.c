/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Ear clipping (G. H. Meisters, 1975) of rings joined by bridges (D. Eberly, "Triangulation by Ear Clipping", 2002).
 *
 * A region is a ring of nodes that know their neighbours. Holes are joined to what lies left of them first, from left
 * to right, by two edges there and back. Points are put on a grid of 2^25 steps, where the side of a line that a point
 * is on is exact in 64 bits. Which nodes might lie in an ear is asked of a coarse grid of cells. Where no ear is left
 * (rings that cross themselves), the next corner is cut off all the same: the triangles fit together whatever happens.
 */
#include "mesh/polygon.h"

#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 1 << 25, CELLS = 256 };

typedef struct node {
    int64_t x, y;
    uint32_t point; /* of the caller's */
    uint32_t prev, next;
    uint32_t beside; /* the next node of the same cell */
    uint8_t gone;
} node;

typedef struct region {
    node *node;
    uint32_t count;
    uint32_t *ring; /* first node of each */
    size_t rings;
    uint32_t cell[CELLS * CELLS];
    uint32_t *index;
    size_t triangles;
} region;

#define NONE UINT32_MAX

/* Twice the area of a triangle: > 0 counter-clockwise. Below 2^53. */
static int64_t side(const node *a, const node *b, const node *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

static int same_place(const node *a, const node *b)
{
    return a->x == b->x && a->y == b->y;
}

static uint32_t cell_of(int64_t at)
{
    return (uint32_t)(at / (STEPS / CELLS + 1));
}

static void enter_cell(region *r, uint32_t i)
{
    uint32_t *cell = &r->cell[cell_of(r->node[i].x) * CELLS + cell_of(r->node[i].y)];
    r->node[i].beside = *cell;
    *cell = i;
}

static void link_ring(region *r, const double *points, size_t first, size_t end, const double lo[2], double scale)
{
    for (size_t i = first; i < end; i++)
        r->node[i] = (node){.x = (int64_t)llround((points[2 * i] - lo[0]) * scale),
                            .y = (int64_t)llround((points[2 * i + 1] - lo[1]) * scale),
                            .point = (uint32_t)i,
                            .prev = (uint32_t)(i == first ? end - 1 : i - 1),
                            .next = (uint32_t)(i + 1 == end ? first : i + 1)};
}

static double ring_area(const region *r, uint32_t first)
{
    double area = 0;
    uint32_t i = first;
    do {
        const node *a = &r->node[i], *b = &r->node[a->next];
        area += (double)a->x * (double)b->y - (double)b->x * (double)a->y;
        i = a->next;
    } while (i != first);
    return area;
}

static uint32_t leftmost(const region *r, uint32_t first)
{
    uint32_t best = first;
    for (uint32_t i = r->node[first].next; i != first; i = r->node[i].next) {
        const node *a = &r->node[i], *b = &r->node[best];
        if (a->x < b->x || (a->x == b->x && a->y < b->y)) best = i;
    }
    return best;
}

/* Whether the way from a to a point starts inside the region. */
static int starts_inside(const region *r, uint32_t a, const node *to)
{
    const node *n = &r->node[a], *prev = &r->node[n->prev], *next = &r->node[n->next];
    if (side(prev, n, next) > 0) return side(n, to, next) <= 0 && side(n, prev, to) <= 0;
    return side(n, to, prev) > 0 || side(n, next, to) > 0;
}

static int in_triangle(const node *a, const node *b, const node *c, const node *p)
{
    return side(a, b, p) >= 0 && side(b, c, p) >= 0 && side(c, a, p) >= 0;
}

/* The node that a hole's leftmost node can be joined to: on the first edge to its left, or what hides that edge's end.
 * `joined` marks nodes of outlines and of holes that are joined already. */
static uint32_t find_bridge(const region *r, uint32_t hole, const uint8_t *joined)
{
    const node *h = &r->node[hole];
    double best_x = -INFINITY;
    uint32_t end = NONE;
    for (uint32_t i = 0; i < r->count; i++) {
        const node *a = &r->node[i];
        if (!joined[i]) continue;
        const node *b = &r->node[a->next];
        if (same_place(a, h) && starts_inside(r, i, &r->node[h->next])) return i;
        /* of a region on the left only edges that go down have it to their right */
        if (!(a->y >= h->y && b->y <= h->y && a->y != b->y)) continue;
        const double x = (double)a->x + (double)(h->y - a->y) * (double)(b->x - a->x) / (double)(b->y - a->y);
        if (x > (double)h->x || x <= best_x) continue;
        best_x = x;
        end = a->x < b->x ? i : a->next;
        if (x == (double)h->x) end = a->y == h->y ? i : b->y == h->y ? a->next : end;
    }
    if (end == NONE) return NONE;
    /* nodes within the triangle of hole, crossing and end hide the end; the one at the least angle does not */
    node crossing = {.x = (int64_t)llround(best_x), .y = h->y};
    const node *m = &r->node[end];
    const node *low = m->y < h->y ? m : &crossing, *high = m->y < h->y ? &crossing : m;
    double least = INFINITY;
    uint32_t found = end;
    for (uint32_t i = 0; i < r->count; i++) {
        const node *p = &r->node[i];
        if (!joined[i] || p->x > h->x || same_place(p, h) || p->x < (m->x < crossing.x ? m->x : crossing.x)) continue;
        if (!(in_triangle(h, high, low, p) && starts_inside(r, i, h))) continue;
        const double slope = fabs((double)(p->y - h->y)) / fmax((double)(h->x - p->x), 0.5);
        if (slope < least || (slope == least && p->x > r->node[found].x)) {
            least = slope;
            found = i;
        }
    }
    return found;
}

/* Join a hole at `h` to the node `b` there and back: two more nodes. */
static void bridge(region *r, uint32_t h, uint32_t b)
{
    const uint32_t h2 = r->count++, b2 = r->count++;
    r->node[h2] = r->node[h];
    r->node[b2] = r->node[b];
    /* ... b -> h ... (round the hole) ... h2 -> b2 -> what followed b */
    r->node[r->node[h].prev].next = h2;
    r->node[h2].next = b2;
    r->node[b2].prev = h2;
    r->node[r->node[b].next].prev = b2;
    r->node[b].next = h;
    r->node[h].prev = b;
}

typedef struct hole {
    int64_t x, y;
    uint32_t node;
} hole;

static int from_left(const void *a, const void *b)
{
    const hole *p = a, *q = b;
    if (p->x != q->x) return p->x < q->x ? -1 : 1;
    if (p->y != q->y) return p->y < q->y ? -1 : 1;
    return p->node < q->node ? -1 : p->node > q->node;
}

static void mark(const region *r, uint32_t first, uint8_t *joined)
{
    uint32_t i = first;
    do {
        joined[i] = 1;
        i = r->node[i].next;
    } while (i != first);
}

/* Outlines stay in r->ring, holes become parts of them. */
static swarf_status join_holes(region *r)
{
    hole *holes = malloc((r->rings + 1) * sizeof *holes);
    uint8_t *joined = calloc(r->count + 2 * r->rings + 1, 1);
    if (!holes || !joined) {
        free(holes);
        free(joined);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for a cap");
    }
    size_t count = 0, outlines = 0;
    for (size_t i = 0; i < r->rings; i++) {
        if (ring_area(r, r->ring[i]) < 0) {
            const uint32_t at = leftmost(r, r->ring[i]);
            holes[count++] = (hole){r->node[at].x, r->node[at].y, at};
        } else {
            mark(r, r->ring[i], joined);
            r->ring[outlines++] = r->ring[i];
        }
    }
    if (count > 1) qsort(holes, count, sizeof *holes, from_left);
    for (size_t i = 0; i < count; i++) {
        const uint32_t to = find_bridge(r, holes[i].node, joined);
        mark(r, holes[i].node, joined);
        if (to == NONE) { /* in no outline: closed by itself */
            r->ring[outlines++] = holes[i].node;
            continue;
        }
        bridge(r, holes[i].node, to);
        joined[r->count - 1] = joined[r->count - 2] = 1;
    }
    r->rings = outlines;
    free(holes);
    free(joined);
    return SWARF_OK;
}

static int is_ear(const region *r, uint32_t i)
{
    const node *b = &r->node[i], *a = &r->node[b->prev], *c = &r->node[b->next];
    if (side(a, b, c) <= 0) return 0;
    int64_t lo[2] = {a->x, a->y}, hi[2] = {a->x, a->y};
    const node *corner[2] = {b, c};
    for (int k = 0; k < 2; k++) {
        lo[0] = corner[k]->x < lo[0] ? corner[k]->x : lo[0];
        lo[1] = corner[k]->y < lo[1] ? corner[k]->y : lo[1];
        hi[0] = corner[k]->x > hi[0] ? corner[k]->x : hi[0];
        hi[1] = corner[k]->y > hi[1] ? corner[k]->y : hi[1];
    }
    for (uint32_t x = cell_of(lo[0]); x <= cell_of(hi[0]); x++)
        for (uint32_t y = cell_of(lo[1]); y <= cell_of(hi[1]); y++)
            for (uint32_t n = r->cell[x * CELLS + y]; n != NONE; n = r->node[n].beside) {
                const node *p = &r->node[n];
                if (p->gone || p == a || p == b || p == c) continue;
                if (!in_triangle(a, b, c, p)) continue;
                if (same_place(p, a) || same_place(p, b) || same_place(p, c)) {
                    /* a corner of a ring that touches here: in the way only where it leads into the triangle */
                    const node *ends[2] = {&r->node[p->prev], &r->node[p->next]};
                    int leads_in = 0;
                    for (int k = 0; k < 2; k++)
                        leads_in |= side(a, b, ends[k]) > 0 && side(b, c, ends[k]) > 0 && side(c, a, ends[k]) > 0;
                    if (!leads_in) continue;
                }
                return 0;
            }
    return 1;
}

static void clip(region *r, uint32_t i)
{
    node *b = &r->node[i];
    r->index[3 * r->triangles] = r->node[b->prev].point;
    r->index[3 * r->triangles + 1] = b->point;
    r->index[3 * r->triangles + 2] = r->node[b->next].point;
    r->triangles++;
    r->node[b->prev].next = b->next;
    r->node[b->next].prev = b->prev;
    b->gone = 1;
}

static void clip_ring(region *r, uint32_t first)
{
    uint32_t left = 0, i = first;
    do {
        left++;
        i = r->node[i].next;
    } while (i != first);
    uint32_t missed = 0;
    while (left > 3) {
        const uint32_t next = r->node[i].next;
        /* rounds without an ear: first corners without area go, then any */
        const int flat = missed > left && side(&r->node[r->node[i].prev], &r->node[i], &r->node[next]) == 0;
        if (flat || missed > 2 * left || is_ear(r, i)) {
            clip(r, i);
            left--;
            missed = 0;
            i = r->node[next].next; /* every other corner: no fans of slivers */
        } else {
            missed++;
            i = next;
        }
    }
    if (left == 3) clip(r, i);
}

static swarf_status triangulate(region *r, const double *points, const size_t *ends, size_t rings)
{
    const size_t count = ends[rings - 1];
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 2; k++) {
            lo[k] = fmin(lo[k], points[2 * i + k]);
            hi[k] = fmax(hi[k], points[2 * i + k]);
        }
    const double extent = fmax(hi[0] - lo[0], hi[1] - lo[1]), scale = extent > 0 ? (STEPS - 1) / extent : 1;
    r->count = (uint32_t)count;
    for (size_t i = 0, first = 0; i < rings; first = ends[i++]) {
        if (ends[i] - first < 3) continue;
        link_ring(r, points, first, ends[i], lo, scale);
        r->ring[r->rings++] = (uint32_t)first;
    }
    SWARF_TRY(join_holes(r));
    memset(r->cell, 0xff, sizeof r->cell);
    for (size_t i = 0; i < r->rings; i++) {
        uint32_t n = r->ring[i];
        do {
            enter_cell(r, n);
            n = r->node[n].next;
        } while (n != r->ring[i]);
    }
    for (size_t i = 0; i < r->rings; i++) clip_ring(r, r->ring[i]);
    return SWARF_OK;
}

swarf_status swarf_polygon_triangulate(const double *points, const size_t *ends, size_t rings, uint32_t **index,
                                       size_t *triangles)
{
    *triangles = 0;
    const size_t count = rings ? ends[rings - 1] : 0;
    SWARF_REQUIRE(count < UINT32_MAX / 4, "mesh: %zu points of a cap are too many", count);
    region *r = calloc(1, sizeof *r);
    uint32_t *out = malloc(3 * (count + 2 * rings + 1) * sizeof *out);
    swarf_status status = SWARF_OK;
    if (r) {
        r->node = calloc(count + 2 * rings + 1, sizeof *r->node);
        r->ring = malloc((rings + 1) * sizeof *r->ring);
        r->index = out;
    }
    if (!r || !out || !r->node || !r->ring)
        status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for a cap of %zu points", count);
    else if (count)
        status = triangulate(r, points, ends, rings);
    if (r) {
        *triangles = r->triangles;
        free(r->node);
        free(r->ring);
    }
    free(r);
    if (status == SWARF_OK)
        *index = out;
    else
        free(out);
    return status;
}
