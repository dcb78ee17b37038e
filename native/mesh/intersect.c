/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Facets sorted along Morton's curve, and a tree of boxes over them, four to a node:
 *
 *   level 0: node i has the boxes of facets 4 i .. 4 i + 3 of that order;
 *   level l + 1: node i has the boxes of nodes 4 i .. 4 i + 3 of level l.
 *
 * The tree is gone through against itself, a part of it by each thread: pairs of nodes whose boxes meet, the first not
 * after the second, a box of the one against the four of the other at once. Each pair of facets whose boxes meet is
 * decided in whole numbers. */
#include "mesh/intersect.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/predicate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Boxes of a node; of nodes that are one thread's part the level; nodes, and facets, that are prepared together. */
enum { WIDE = 4, LEVELS = 16, PART = 4, CHUNK = 4096 };

typedef struct extent {
    int32_t lo[3], hi[3];
} extent;

typedef struct found {
    swarf_facet_pair *pairs;
    size_t count, room;
} found;

typedef struct key {
    uint64_t code;
    uint32_t facet;
} key;

/* A facet, all that pairs are decided by. */
typedef struct sorted {
    int32_t p[3][3];
    uint32_t v[3], facet;
} sorted;

/* One number of each box of a node. */
typedef int32_t row __attribute__((vector_size(4 * WIDE)));

/* Boxes that are missing meet none. */
typedef struct node {
    row lo[3], hi[3];
    uint32_t fresh; /* a bit each: the box has facets that are */
} node;

typedef struct level {
    node *nodes;
    size_t count;
} level;

typedef struct tree {
    const swarf_facets *facets;
    const uint8_t *fresh; /* of the facets, NULL: all are */
    double step;
    key *keys; /* the facets in order, until they are there: */
    sorted *order;
    node *nodes; /* of all levels */
    level level[LEVELS];
    int levels;
    int filled; /* levels that have their boxes */
    found *parts;
} tree;

double swarf_facets_step(double most)
{
    int exponent;
    frexp(most > 0 ? most : 1, &exponent);
    return ldexp(1, exponent - 24);
}

float swarf_facets_most(const float *xyz, size_t vertex_count)
{
    float most = 0;
    for (size_t i = 0; i < 3 * vertex_count; i++) {
        const float size = fabsf(xyz[i]);
        most = size > most ? size : most;
    }
    return most;
}

static double step_of(const swarf_facets *facets)
{
    return swarf_facets_step((double)swarf_facets_most(facets->xyz, facets->vertex_count));
}

double swarf_facets_snap(swarf_facets *facets, double least)
{
    /* adding and taking away 1.5 * 2^52 steps rounds to whole steps */
    const double step = fmax(step_of(facets), least), magic = 0x1.8p52 * step;
    for (size_t i = 0; i < 3 * facets->vertex_count; i++)
        facets->xyz[i] = (float)((double)facets->xyz[i] + magic - magic);
    return step;
}

static void corners_of(const tree *t, uint32_t f, int32_t out[3][3])
{
    const double scale = 1 / t->step; /* a power of two */
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            out[k][c] = (int32_t)((double)t->facets->xyz[3 * (size_t)t->facets->facet[f].v[k] + (size_t)c] * scale);
}

static extent extent_of(int32_t p[3][3])
{
    extent e;
    for (int c = 0; c < 3; c++) {
        e.lo[c] = e.hi[c] = p[0][c];
        for (int k = 1; k < 3; k++) {
            e.lo[c] = p[k][c] < e.lo[c] ? p[k][c] : e.lo[c];
            e.hi[c] = p[k][c] > e.hi[c] ? p[k][c] : e.hi[c];
        }
    }
    return e;
}

/* Every third bit of 16. */
static uint64_t spread(uint64_t x)
{
    x = (x | x << 16) & 0xff0000ff;
    x = (x | x << 8) & 0xf00f00f00f;
    x = (x | x << 4) & 0xc30c30c30c3;
    return (x | x << 2) & 0x249249249249;
}

/* By 16 bits at a time, stable. */
static swarf_status sort_keys(key **keys, size_t count)
{
    key *from = *keys, *to = malloc((count + 1) * sizeof *to);
    size_t *begin = malloc(65537 * sizeof *begin);
    if (!to || !begin) {
        free(to);
        free(begin);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for checking %zu triangles", count);
    }
    for (int shift = 0; shift < 48; shift += 16) {
        memset(begin, 0, 65537 * sizeof *begin);
        for (size_t i = 0; i < count; i++) begin[(from[i].code >> shift & 0xffff) + 1]++;
        for (size_t i = 0; i < 65536; i++) begin[i + 1] += begin[i];
        for (size_t i = 0; i < count; i++) to[begin[from[i].code >> shift & 0xffff]++] = from[i];
        key *kept = from;
        from = to;
        to = kept;
    }
    free(begin);
    free(to);
    *keys = from;
    return SWARF_OK;
}

static swarf_status make_keys(void *context, size_t index)
{
    const tree *t = context;
    for (size_t f = index * CHUNK; f < (index + 1) * CHUNK && f < t->facets->facet_count; f++) {
        int32_t p[3][3];
        corners_of(t, (uint32_t)f, p);
        const extent e = extent_of(p);
        t->keys[f] = (key){.facet = (uint32_t)f};
        for (int c = 0; c < 3; c++) /* coordinates lie in -2^24 .. 2^24 */
            t->keys[f].code |= spread((uint64_t)(((int64_t)e.lo[c] + e.hi[c]) / 2 + (1 << 24)) >> 9 & 0xffff) << c;
    }
    return SWARF_OK;
}

/* The box of all boxes of a node. */
static extent cover(const node *n)
{
    extent e;
    for (int c = 0; c < 3; c++) {
        e.lo[c] = n->lo[c][0];
        e.hi[c] = n->hi[c][0];
        for (int i = 1; i < WIDE; i++) {
            e.lo[c] = n->lo[c][i] < e.lo[c] ? n->lo[c][i] : e.lo[c];
            e.hi[c] = n->hi[c][i] > e.hi[c] ? n->hi[c][i] : e.hi[c];
        }
    }
    return e;
}

static extent box_of(const node *n, int i)
{
    return (extent){{n->lo[0][i], n->lo[1][i], n->lo[2][i]}, {n->hi[0][i], n->hi[1][i], n->hi[2][i]}};
}

static void set_box(node *n, int i, const extent *box, int fresh)
{
    for (int c = 0; c < 3; c++) {
        n->lo[c][i] = box->lo[c];
        n->hi[c][i] = box->hi[c];
    }
    n->fresh |= (uint32_t)fresh << i;
}

/* A bit per box of a node that meets a box. */
static uint32_t meeting(const node *n, const extent *box)
{
    row apart = {0};
    for (int c = 0; c < 3; c++) apart |= (n->hi[c] < box->lo[c]) | (box->hi[c] < n->lo[c]);
    const row met = ~apart & (row){1, 2, 4, 8};
    return (uint32_t)(met[0] | met[1] | met[2] | met[3]);
}

/* A facet put in its place; its box. */
static extent put_facet(const tree *t, size_t at)
{
    sorted *own = &t->order[at];
    own->facet = t->keys[at].facet;
    memcpy(own->v, t->facets->facet[own->facet].v, sizeof own->v);
    corners_of(t, own->facet, own->p);
    return extent_of(own->p);
}

/* Nodes of the level to be filled, from the facets or from the level below. */
static swarf_status fill_nodes(void *context, size_t index)
{
    const tree *t = context;
    const level *own = &t->level[t->filled], *below = own - 1;
    const size_t boxes = t->filled ? below->count : t->facets->facet_count;
    for (size_t i = index * CHUNK; i < (index + 1) * CHUNK && i < own->count; i++) {
        node *n = &own->nodes[i];
        const extent none = {{INT32_MAX, INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN, INT32_MIN}};
        n->fresh = 0;
        for (int k = 0; k < WIDE; k++) {
            const size_t at = WIDE * i + (size_t)k;
            if (at >= boxes) {
                set_box(n, k, &none, 0);
            } else if (t->filled) {
                const extent box = cover(&below->nodes[at]);
                set_box(n, k, &box, below->nodes[at].fresh != 0);
            } else {
                const extent box = put_facet(t, at);
                set_box(n, k, &box, !t->fresh || t->fresh[t->order[at].facet]);
            }
        }
    }
    return SWARF_OK;
}

static swarf_status build(tree *t)
{
    const size_t count = t->facets->facet_count;
    t->keys = malloc((count + 1) * sizeof *t->keys);
    if (!t->keys) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for checking %zu triangles", count);
    SWARF_TRY(swarf_parallel_for((count + CHUNK - 1) / CHUNK, make_keys, t, NULL, 0, 1));
    SWARF_TRY(sort_keys(&t->keys, count));
    size_t total = 0;
    for (size_t nodes = count; nodes > 1 || t->levels == 0;) {
        nodes = (nodes + WIDE - 1) / WIDE;
        t->level[t->levels++].count = nodes;
        total += nodes;
    }
    t->nodes = malloc(total * sizeof *t->nodes);
    t->order = malloc((count + 1) * sizeof *t->order);
    if (!t->nodes || !t->order)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for checking %zu triangles", count);
    for (node *next = t->nodes; t->filled < t->levels; t->filled++) {
        level *own = &t->level[t->filled];
        own->nodes = next;
        next += own->count;
        SWARF_TRY(swarf_parallel_for((own->count + CHUNK - 1) / CHUNK, fill_nodes, t, NULL, 0, 1));
    }
    free(t->keys);
    t->keys = NULL;
    return SWARF_OK;
}

static swarf_status put_pair(found *out, const sorted *a, const sorted *b)
{
    SWARF_TRY(swarf_array_reserve((void **)&out->pairs, &out->room, out->count + 1, sizeof *out->pairs));
    out->pairs[out->count++] = (swarf_facet_pair){a->facet, b->facet};
    return SWARF_OK;
}

/* Facets whose boxes meet; each without area as a pair with itself. */
static swarf_status look_at_facets(const tree *t, size_t first, size_t second, found *out)
{
    const sorted *a = &t->order[first], *b = &t->order[second];
    if (first == second) return swarf_triangle_has_area(a->p) ? SWARF_OK : put_pair(out, a, a);
    return swarf_triangles_meet(a->p, a->v, b->p, b->v) ? put_pair(out, a, b) : SWARF_OK;
}

/* What is below two nodes of a level, the first not after the second. */
static swarf_status look_at_nodes(const tree *t, int at, size_t first, size_t second, found *out)
{
    const node *own = &t->level[at].nodes[first], *other = &t->level[at].nodes[second];
    for (int i = 0; i < WIDE; i++) {
        const extent box = box_of(own, i);
        uint32_t met = meeting(other, &box);
        if (!(own->fresh >> i & 1)) met &= other->fresh;
        if (first == second) met &= ~0U << i;
        for (; met; met &= met - 1) {
            const size_t a = WIDE * first + (size_t)i, b = WIDE * second + (size_t)__builtin_ctz(met);
            SWARF_TRY(at ? look_at_nodes(t, at - 1, a, b, out) : look_at_facets(t, a, b, out));
        }
    }
    return SWARF_OK;
}

static int part_level(const tree *t)
{
    return t->levels - 1 < PART ? t->levels - 1 : PART;
}

/* A part, of which all is in a box, against what is below a node and not before it. */
static swarf_status look_below(const tree *t, size_t part, const extent *box, int at, size_t index, found *out)
{
    if (at == part_level(t)) return index < part ? SWARF_OK : look_at_nodes(t, at, part, index, out);
    for (uint32_t met = meeting(&t->level[at].nodes[index], box); met; met &= met - 1)
        SWARF_TRY(look_below(t, part, box, at - 1, WIDE * index + (size_t)__builtin_ctz(met), out));
    return SWARF_OK;
}

static swarf_status look_for(void *context, size_t part)
{
    const tree *t = context;
    const extent box = cover(&t->level[part_level(t)].nodes[part]);
    return look_below(t, part, &box, t->levels - 1, 0, &t->parts[part]);
}

static swarf_status look_everywhere(tree *t, const swarf_progress *progress, double from, double to,
                                    swarf_facet_pair **pairs, size_t *count)
{
    const size_t parts = t->level[part_level(t)].count;
    t->parts = calloc(parts, sizeof *t->parts);
    if (!t->parts) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    swarf_status status = swarf_parallel_for(parts, look_for, t, progress, from, to);
    size_t total = 0, used = 0;
    for (size_t i = 0; i < parts; i++) total += t->parts[i].count;
    swarf_facet_pair *all = malloc((total + 1) * sizeof *all);
    if (status == SWARF_OK && !all) status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    for (size_t i = 0; i < parts; i++) {
        if (status == SWARF_OK && t->parts[i].count)
            memcpy(all + used, t->parts[i].pairs, t->parts[i].count * sizeof *all);
        used += t->parts[i].count;
        free(t->parts[i].pairs);
    }
    if (status != SWARF_OK) {
        free(all);
        return status;
    }
    *pairs = all;
    *count = total;
    return SWARF_OK;
}

swarf_status swarf_facets_intersect(const swarf_facets *facets, const uint8_t *fresh, const swarf_progress *progress,
                                    double from, double to, swarf_facet_pair **pairs, size_t *count)
{
    if (facets->facet_count == 0) {
        *pairs = NULL;
        *count = 0;
        return SWARF_OK;
    }
    tree t = {.facets = facets, .fresh = fresh, .step = step_of(facets)};
    swarf_status status = build(&t);
    if (status == SWARF_OK) status = look_everywhere(&t, progress, from, to, pairs, count);
    free(t.keys);
    free(t.nodes);
    free(t.order);
    free(t.parts);
    return status;
}
