/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Facets sorted along Morton's curve, LEAF of them to a leaf of a complete binary tree of boxes:
 *
 *   level 0: leaves; node i of level l + 1 is over nodes 2 i and 2 i + 1 of level l.
 *
 * The tree is gone through against itself, a part of it by each thread: pairs of nodes whose boxes meet, the first not
 * after the second. Of two leaves each pair of facets whose boxes meet is decided in whole numbers. */
#include "mesh/intersect.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/predicate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Facets of a leaf; of the nodes that are one thread's part the level; facets that are prepared together. */
enum { LEAF = 4, LEVELS = 32, PART = 8, CHUNK = 4096 };

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
    extent box;
    int32_t p[3][3];
    uint32_t v[3], facet;
    int fresh;
} sorted;

typedef struct tree {
    const swarf_facets *facets;
    const uint8_t *fresh; /* of the facets, NULL: all are */
    double step;
    key *keys; /* the facets in order, until they are there: */
    sorted *order;
    size_t level_first[LEVELS], level_count[LEVELS];
    int levels;
    extent *boxes;
    uint8_t *any_fresh; /* of the boxes */
    found *parts;
} tree;

double swarf_facets_step(double most)
{
    int exponent;
    frexp(most > 0 ? most : 1, &exponent);
    return ldexp(1, exponent - 24);
}

static double step_of(const swarf_facets *facets)
{
    float most = 0;
    for (size_t i = 0; i < 3 * facets->vertex_count; i++) {
        const float size = fabsf(facets->xyz[i]);
        most = size > most ? size : most;
    }
    return swarf_facets_step((double)most);
}

void swarf_facets_snap(swarf_facets *facets, double least)
{
    /* adding and taking away 1.5 * 2^52 steps rounds to whole steps */
    const double step = fmax(step_of(facets), least), magic = 0x1.8p52 * step;
    for (size_t i = 0; i < 3 * facets->vertex_count; i++)
        facets->xyz[i] = (float)((double)facets->xyz[i] + magic - magic);
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

static int apart(const extent *a, const extent *b)
{
    for (int c = 0; c < 3; c++)
        if (a->hi[c] < b->lo[c] || b->hi[c] < a->lo[c]) return 1;
    return 0;
}

/* Every third bit of 21. */
static uint64_t spread(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
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
    for (int shift = 0; shift < 64; shift += 16) {
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
            t->keys[f].code |= spread((uint64_t)(((int64_t)e.lo[c] + e.hi[c]) / 2 + (1 << 24)) >> 4) << c;
    }
    return SWARF_OK;
}

static void widen(extent *to, const extent *by)
{
    for (int c = 0; c < 3; c++) {
        to->lo[c] = by->lo[c] < to->lo[c] ? by->lo[c] : to->lo[c];
        to->hi[c] = by->hi[c] > to->hi[c] ? by->hi[c] : to->hi[c];
    }
}

/* The boxes of facets and leaves. */
static swarf_status make_leaves(void *context, size_t index)
{
    const tree *t = context;
    for (size_t i = index * CHUNK; i < (index + 1) * CHUNK && i < t->facets->facet_count; i++) {
        sorted *own = &t->order[i];
        own->facet = t->keys[i].facet;
        memcpy(own->v, t->facets->facet[own->facet].v, sizeof own->v);
        corners_of(t, own->facet, own->p);
        own->box = extent_of(own->p);
        own->fresh = !t->fresh || t->fresh[own->facet];
        if (i % LEAF == 0) {
            t->boxes[i / LEAF] = own->box;
            t->any_fresh[i / LEAF] = (uint8_t)own->fresh;
        } else {
            widen(&t->boxes[i / LEAF], &own->box);
            t->any_fresh[i / LEAF] |= (uint8_t)own->fresh;
        }
    }
    return SWARF_OK;
}

static swarf_status build(tree *t)
{
    const size_t count = t->facets->facet_count, chunks = (count + CHUNK - 1) / CHUNK;
    t->keys = malloc((count + 1) * sizeof *t->keys);
    if (!t->keys) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for checking %zu triangles", count);
    SWARF_TRY(swarf_parallel_for(chunks, make_keys, t, NULL, 0, 1));
    SWARF_TRY(sort_keys(&t->keys, count));
    size_t total = 0;
    for (size_t nodes = (count + LEAF - 1) / LEAF;; nodes = (nodes + 1) / 2) {
        t->level_first[t->levels] = total;
        t->level_count[t->levels++] = nodes;
        total += nodes;
        if (nodes <= 1) break;
    }
    t->boxes = malloc((total + 1) * sizeof *t->boxes);
    t->order = malloc((count + 1) * sizeof *t->order);
    t->any_fresh = malloc(total + 1);
    if (!t->boxes || !t->order || !t->any_fresh)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for checking %zu triangles", count);
    SWARF_TRY(swarf_parallel_for(chunks, make_leaves, t, NULL, 0, 1));
    free(t->keys);
    t->keys = NULL;
    for (int level = 1; level < t->levels; level++)
        for (size_t i = 0; i < t->level_count[level]; i++) {
            const size_t child = t->level_first[level - 1] + 2 * i;
            const size_t own = t->level_first[level] + i;
            t->boxes[own] = t->boxes[child];
            t->any_fresh[own] = t->any_fresh[child];
            if (2 * i + 1 == t->level_count[level - 1]) continue;
            widen(&t->boxes[own], &t->boxes[child + 1]);
            t->any_fresh[own] |= t->any_fresh[child + 1];
        }
    return SWARF_OK;
}

static swarf_status put_pair(found *out, const sorted *a, const sorted *b)
{
    SWARF_TRY(swarf_array_reserve((void **)&out->pairs, &out->room, out->count + 1, sizeof *out->pairs));
    out->pairs[out->count++] = (swarf_facet_pair){a->facet, b->facet};
    return SWARF_OK;
}

static swarf_status look_at_leaf(const tree *t, size_t own, size_t leaf, found *out)
{
    const size_t count = t->facets->facet_count;
    const sorted *end = t->order + ((own + 1) * LEAF < count ? (own + 1) * LEAF : count);
    const sorted *other_end = t->order + ((leaf + 1) * LEAF < count ? (leaf + 1) * LEAF : count);
    for (const sorted *a = t->order + own * LEAF; a < end; a++) {
        if (own != leaf && apart(&a->box, &t->boxes[leaf])) continue;
        if (own == leaf && !swarf_triangle_has_area(a->p)) SWARF_TRY(put_pair(out, a, a));
        for (const sorted *b = own == leaf ? a + 1 : t->order + leaf * LEAF; b < other_end; b++) {
            if (apart(&a->box, &b->box) || !(a->fresh | b->fresh)) continue;
            if (swarf_triangles_meet(a->p, a->v, b->p, b->v)) SWARF_TRY(put_pair(out, a, b));
        }
    }
    return SWARF_OK;
}

typedef struct node {
    int level;
    size_t index;
} node;

static size_t place_of(const tree *t, node n)
{
    return t->level_first[n.level] + n.index;
}

/* The leaves under node `index` of level PART, against all that do not come before them. */
static swarf_status look_for(void *context, size_t index)
{
    const tree *t = context;
    found *out = &t->parts[index];
    struct {
        node a, b;
    } stack[4 * LEVELS];
    int depth = 0;
    stack[depth].a = (node){t->levels - 1 < PART ? t->levels - 1 : PART, index};
    stack[depth++].b = (node){t->levels - 1, 0};
    while (depth) {
        depth--;
        const node a = stack[depth].a, b = stack[depth].b;
        const size_t at_a = place_of(t, a), at_b = place_of(t, b);
        if ((b.index + 1) << b.level <= a.index << a.level || !(t->any_fresh[at_a] | t->any_fresh[at_b]) ||
            apart(&t->boxes[at_a], &t->boxes[at_b]))
            continue;
        if (a.level == 0 && b.level == 0) {
            SWARF_TRY(look_at_leaf(t, a.index, b.index, out));
            continue;
        }
        const int first = a.level >= b.level;
        const node parted = first ? a : b;
        for (size_t i = 2 * parted.index; i < 2 * parted.index + 2 && i < t->level_count[parted.level - 1]; i++) {
            const node child = {parted.level - 1, i};
            stack[depth].a = first ? child : a;
            stack[depth++].b = first ? b : child;
        }
    }
    return SWARF_OK;
}

static swarf_status look_everywhere(tree *t, const swarf_progress *progress, double from, double to,
                                    swarf_facet_pair **pairs, size_t *count)
{
    const size_t parts = t->level_count[t->levels - 1 < PART ? t->levels - 1 : PART];
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
    free(t.boxes);
    free(t.any_fresh);
    free(t.order);
    free(t.parts);
    return status;
}
