/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Which material hangs together: voxels with a common face, both inside.
 *
 *   part: voxels of one leaf that hang together, a mask of 8 words as the leaf's own; or an inside tile, all of it.
 *   part_at[node * 4096 + slot]: the first part there; a leaf's parts follow each other, `part_at` of the next slot
 * that has any begins where they end.
 *
 * Parts of neighbouring slots are joined where their faces overlap, by union-find with the lower number on top: the
 * lumps are the same for any number of threads. */
#include "swarf/lumps.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/leaf.h"
#include "stock/stock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct part {
    uint64_t mask[8];
    uint32_t on_top; /* another part of the same lump, or itself */
    int32_t corner[3];
} part;

typedef struct parts {
    part *part;
    size_t count, room;
} parts;

struct swarf_lumps {
    swarf_lump *lump;
    size_t count;
};

typedef struct finding {
    const swarf_stock *stock;
    const swarf_tree_layout *layout;
    parts *of_node;
    uint32_t *part_at;  /* counted from the node's first until they are numbered through */
    uint16_t *parts_at; /* how many */
    part *all;
    uint32_t *lump_at; /* of a part on top: its lump */
    size_t count;
    const swarf_progress *progress;
} finding;

/* Shares of the progress: the leaves are parted, neighbours are joined, lumps are gathered. */
static const double parted = 0.6, joined = 0.9;
/* Parts between two reports. */
enum { REPORT = 1 << 16 };

/* Spread the bits to their neighbours within the leaf. */
static void spread(const uint64_t in[8], uint64_t out[8])
{
    const uint64_t low_z = 0x0101010101010101u, high_z = 0x8080808080808080u;
    for (int x = 0; x < 8; x++) {
        const uint64_t w = in[x];
        out[x] = w | (w & ~high_z) << 1 | (w & ~low_z) >> 1 | w << 8 | w >> 8;
        if (x > 0) out[x] |= in[x - 1];
        if (x < 7) out[x] |= in[x + 1];
    }
}

static swarf_status add_part(parts *p, const uint64_t mask[8], const int32_t corner[3])
{
    SWARF_TRY(swarf_array_reserve((void **)&p->part, &p->room, p->count + 1, sizeof *p->part));
    part *made = &p->part[p->count++];
    memcpy(made->mask, mask, sizeof made->mask);
    memcpy(made->corner, corner, sizeof made->corner);
    return SWARF_OK;
}

static swarf_status split_leaf(parts *p, const float *values, const int32_t corner[3])
{
    uint64_t left[8];
    for (int x = 0; x < 8; x++) {
        left[x] = 0;
        for (int k = 0; k < 64; k++) left[x] |= (uint64_t)(values[x * 64 + k] < 0) << k;
    }
    for (int x = 0; x < 8; x++)
        while (left[x]) {
            uint64_t grown[8] = {0}, next[8];
            grown[x] = left[x] & (~left[x] + 1);
            for (int changed = 1; changed;) {
                spread(grown, next);
                changed = 0;
                for (int i = 0; i < 8; i++) {
                    next[i] &= left[i];
                    changed |= next[i] != grown[i];
                    grown[i] = next[i];
                }
            }
            for (int i = 0; i < 8; i++) left[i] &= ~grown[i];
            SWARF_TRY(add_part(p, grown, corner));
        }
    return SWARF_OK;
}

static swarf_status find_in_node(void *context, size_t node)
{
    finding *f = context;
    parts *p = &f->of_node[node];
    static const uint64_t all[8] = {~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull};
    int32_t origin[3], corner[3];
    swarf_node_corner(f->layout, node, origin);
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        const size_t at = node * SWARF_NODE_SLOTS + slot, before = p->count;
        f->part_at[at] = (uint32_t)before;
        swarf_leaf_corner(origin, slot, corner);
        const float *values = swarf_tree_leaf(f->stock->tree, node, slot);
        if (values)
            SWARF_TRY(split_leaf(p, values, corner));
        else if (swarf_tree_tile_inside(f->stock->tree, node, slot))
            SWARF_TRY(add_part(p, all, corner));
        f->parts_at[at] = (uint16_t)(p->count - before);
    }
    return SWARF_OK;
}

static swarf_status number_parts(finding *f)
{
    const size_t nodes = swarf_layout_nodes(f->layout);
    for (size_t n = 0; n < nodes; n++) f->count += f->of_node[n].count;
    SWARF_REQUIRE(f->count < UINT32_MAX, "lumps: %zu parts are too many", f->count);
    f->all = malloc((f->count + 1) * sizeof *f->all);
    if (!f->all) return swarf_fail(SWARF_ERROR_MEMORY, "lumps: out of memory for %zu parts", f->count);
    size_t first = 0;
    for (size_t n = 0; n < nodes; n++) {
        if (f->of_node[n].count) memcpy(f->all + first, f->of_node[n].part, f->of_node[n].count * sizeof *f->all);
        free(f->of_node[n].part);
        f->of_node[n].part = NULL;
        for (size_t s = 0; s < SWARF_NODE_SLOTS; s++) f->part_at[n * SWARF_NODE_SLOTS + s] += (uint32_t)first;
        first += f->of_node[n].count;
    }
    for (size_t i = 0; i < f->count; i++) f->all[i].on_top = (uint32_t)i;
    return SWARF_OK;
}

static uint32_t top_of(part *all, uint32_t i)
{
    while (all[i].on_top != i) {
        all[i].on_top = all[all[i].on_top].on_top;
        i = all[i].on_top;
    }
    return i;
}

static void join(part *all, uint32_t a, uint32_t b)
{
    a = top_of(all, a);
    b = top_of(all, b);
    if (a < b)
        all[b].on_top = a;
    else
        all[a].on_top = b;
}

/* Whether the high side of a along an axis overlaps the low side of b. */
static int touch(const part *a, const part *b, int axis)
{
    const uint64_t low_y = 0xffu, low_z = 0x0101010101010101u;
    if (axis == 0) return (a->mask[7] & b->mask[0]) != 0;
    for (int x = 0; x < 8; x++) {
        const uint64_t high = axis == 1 ? a->mask[x] >> 56 : a->mask[x] >> 7 & low_z;
        const uint64_t low = axis == 1 ? b->mask[x] & low_y : b->mask[x] & low_z;
        if (high & low) return 1;
    }
    return 0;
}

static size_t place_of(const swarf_tree_layout *layout, const int32_t slot[3])
{
    size_t node = 0;
    unsigned within = 0;
    for (int k = 0; k < 3; k++) {
        if (slot[k] >= layout->count[k] * 16) return SIZE_MAX;
        node = node * (size_t)layout->count[k] + (size_t)(slot[k] >> 4);
        within = within << 4 | (unsigned)(slot[k] & 15);
    }
    return node * SWARF_NODE_SLOTS + within;
}

static swarf_status report(const finding *f, uint32_t done, double from, double to)
{
    if (done % REPORT) return SWARF_OK;
    return swarf_progress_report(f->progress, from + (to - from) * done / (double)f->count);
}

static swarf_status join_neighbours(finding *f)
{
    for (uint32_t i = 0; i < f->count; i++) {
        SWARF_TRY(report(f, i, parted, joined));
        for (int axis = 0; axis < 3; axis++) {
            int32_t slot[3];
            for (int k = 0; k < 3; k++) slot[k] = f->all[i].corner[k] / SWARF_LEAF_DIM + (k == axis);
            const size_t at = place_of(f->layout, slot);
            if (at == SIZE_MAX) continue;
            for (uint32_t j = f->part_at[at]; j < f->part_at[at] + f->parts_at[at]; j++)
                if (touch(&f->all[i], &f->all[j], axis)) join(f->all, i, j);
        }
    }
    return SWARF_OK;
}

static void ends_of(unsigned bits, int32_t *lo, int32_t *hi)
{
    *lo = __builtin_ctz(bits);
    *hi = 31 - __builtin_clz(bits);
}

static void widen(const finding *f, const part *p, swarf_lump *lump)
{
    const double voxel = f->layout->voxel;
    uint64_t any = 0;
    unsigned seen[3] = {0}; /* planes with voxels along x, y and z */
    for (int x = 0; x < 8; x++) {
        any |= p->mask[x];
        seen[0] |= (unsigned)(p->mask[x] != 0) << x;
    }
    for (int y = 0; y < 8; y++) {
        const unsigned row = (unsigned)(any >> 8 * y) & 0xff;
        seen[1] |= (unsigned)(row != 0) << y;
        seen[2] |= row;
    }
    const int first = __builtin_ctz(seen[0]), bit = __builtin_ctzll(p->mask[first]);
    const int inside[3] = {first, bit >> 3, bit & 7};
    for (int k = 0; k < 3; k++) {
        int32_t lo, hi;
        ends_of(seen[k], &lo, &hi);
        const double corner = f->layout->origin[k] + p->corner[k] * voxel;
        lump->box.lo[k] = fmin(lump->box.lo[k], corner + (lo - 0.5) * voxel);
        lump->box.hi[k] = fmax(lump->box.hi[k], corner + (hi + 0.5) * voxel);
        if (!lump->voxels) lump->inside[k] = corner + inside[k] * voxel;
    }
    for (int x = 0; x < 8; x++) lump->voxels += (size_t)__builtin_popcountll(p->mask[x]);
}

static int larger_first(const void *a, const void *b)
{
    const swarf_lump *p = a, *q = b;
    if (p->voxels != q->voxels) return p->voxels > q->voxels ? -1 : 1;
    for (int k = 0; k < 3; k++)
        if (p->inside[k] != q->inside[k]) return p->inside[k] < q->inside[k] ? -1 : 1;
    return 0;
}

/* The part that holds the voxel nearest to a point, UINT32_MAX where it is in the air. */
static uint32_t part_of(const finding *f, const double point[3])
{
    int32_t voxel[3], slot[3];
    for (int k = 0; k < 3; k++) {
        const double at = (point[k] - f->layout->origin[k]) / f->layout->voxel;
        if (!(at > -0.5 && at < f->layout->count[k] * SWARF_NODE_DIM - 0.5)) return UINT32_MAX;
        voxel[k] = (int32_t)floor(at + 0.5);
        slot[k] = voxel[k] / SWARF_LEAF_DIM;
    }
    const size_t at = place_of(f->layout, slot);
    const uint64_t bit = 1ull << ((voxel[1] & 7) * 8 + (voxel[2] & 7));
    for (uint32_t j = f->part_at[at]; j < f->part_at[at] + f->parts_at[at]; j++)
        if (f->all[j].mask[voxel[0] & 7] & bit) return j;
    return UINT32_MAX;
}

static swarf_status gather_lumps(finding *f, swarf_lumps *out)
{
    size_t room = 0;
    f->lump_at = malloc((f->count + 1) * sizeof *f->lump_at);
    if (!f->lump_at) return swarf_fail(SWARF_ERROR_MEMORY, "lumps: out of memory");
    for (uint32_t i = 0; i < f->count; i++) {
        SWARF_TRY(report(f, i, joined, 1));
        const uint32_t top = top_of(f->all, i);
        if (top == i) {
            SWARF_TRY(swarf_array_reserve((void **)&out->lump, &room, out->count + 1, sizeof *out->lump));
            f->lump_at[i] = (uint32_t)out->count;
            out->lump[out->count++] =
                (swarf_lump){.box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}}};
        }
        widen(f, &f->all[i], &out->lump[f->lump_at[top]]);
    }
    const double cube = f->layout->voxel * f->layout->voxel * f->layout->voxel;
    for (size_t i = 0; i < out->count; i++) out->lump[i].volume_mm3 = (double)out->lump[i].voxels * cube;
    if (out->count > 1) qsort(out->lump, out->count, sizeof *out->lump, larger_first);
    for (size_t i = 0; i < out->count; i++) f->lump_at[top_of(f->all, part_of(f, out->lump[i].inside))] = (uint32_t)i;
    return SWARF_OK;
}

static void find_points(finding *f, const double *points, size_t count, uint32_t *lump_of)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t own = part_of(f, points + 3 * i);
        lump_of[i] = own == UINT32_MAX ? UINT32_MAX : f->lump_at[top_of(f->all, own)];
    }
}

static swarf_status find(finding *f, swarf_lumps *out)
{
    const size_t nodes = swarf_layout_nodes(f->layout);
    f->of_node = calloc(nodes + 1, sizeof *f->of_node);
    f->part_at = calloc(nodes * SWARF_NODE_SLOTS + 1, sizeof *f->part_at);
    f->parts_at = calloc(nodes * SWARF_NODE_SLOTS + 1, sizeof *f->parts_at);
    if (!f->of_node || !f->part_at || !f->parts_at) return swarf_fail(SWARF_ERROR_MEMORY, "lumps: out of memory");
    SWARF_TRY(swarf_parallel_for(nodes, find_in_node, f, f->progress, 0, parted));
    SWARF_TRY(number_parts(f));
    SWARF_TRY(join_neighbours(f));
    return gather_lumps(f, out);
}

swarf_status swarf_lumps_create(swarf_stock *stock, const double *points, size_t point_count,
                                const swarf_progress *progress, uint32_t *lump_of, swarf_lumps **out)
{
    SWARF_REQUIRE(stock && out && (point_count == 0 || (points && lump_of)), "lumps: NULL");
    swarf_lumps *made = calloc(1, sizeof *made);
    if (!made) return swarf_fail(SWARF_ERROR_MEMORY, "lumps: out of memory");
    swarf_status status = swarf_stock_enter_read(stock);
    if (status == SWARF_OK) {
        finding f = {.stock = stock, .layout = swarf_tree_get_layout(stock->tree), .progress = progress};
        status = find(&f, made);
        if (status == SWARF_OK) find_points(&f, points, point_count, lump_of);
        for (size_t n = 0; f.of_node && n < swarf_layout_nodes(f.layout); n++) free(f.of_node[n].part);
        free(f.of_node);
        free(f.part_at);
        free(f.parts_at);
        free(f.all);
        free(f.lump_at);
        swarf_stock_leave(stock);
    }
    if (status != SWARF_OK) {
        swarf_lumps_destroy(made);
        return status;
    }
    *out = made;
    return SWARF_OK;
}

void swarf_lumps_destroy(swarf_lumps *lumps)
{
    if (!lumps) return;
    free(lumps->lump);
    free(lumps);
}

const swarf_lump *swarf_lumps_get(const swarf_lumps *lumps, size_t *count)
{
    *count = lumps->count;
    return lumps->lump;
}
