/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Clusters: samples beyond tolerance are put into cells of two voxels, apart for excess and gouge; cells that are
 * neighbours (27 around each) belong together. Volumes are shared out by slots: from those that hold samples of a
 * cluster through their neighbours that have an excess (or gouge) of their own. */
#include "base/mix.h"
#include "base/status.h"
#include "compare/compare.h"
#include "stock/leaf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELL = 2 };

/* Cells and slots by a number made of their coordinates; open addressing. */
struct entry {
    uint64_t key;
    uint32_t parent;  /* cells: of the union; slots: the cluster they belong to */
    uint32_t cluster; /* cells: number once all are joined */
};

struct table {
    struct entry *entries;
    uint32_t *places; /* of entries, UINT32_MAX: free */
    size_t count, size;
};

struct clusters {
    const swarf_tree_layout *layout;
    struct table cells, slots;
    swarf_cluster *clusters;
    size_t count;
};

/* Place of the entry with a key, or of where it would go. */
static uint32_t *find_place(const struct table *table, uint64_t key)
{
    for (size_t at = swarf_mix(key) & (table->size - 1);; at = (at + 1) & (table->size - 1))
        if (table->places[at] == UINT32_MAX || table->entries[table->places[at]].key == key) return &table->places[at];
}

static int table_grow(struct table *table)
{
    const size_t size = table->size ? 4 * table->size : 1024;
    uint32_t *places = malloc(size * sizeof *places);
    struct entry *entries = realloc(table->entries, size / 2 * sizeof *entries);
    if (entries) table->entries = entries;
    if (!places || !entries) {
        free(places);
        return 0;
    }
    memset(places, 0xff, size * sizeof *places);
    free(table->places);
    table->places = places;
    table->size = size;
    for (size_t i = 0; i < table->count; i++) *find_place(table, entries[i].key) = (uint32_t)i;
    return 1;
}

/* Number of the entry with a key, made where there is none; UINT32_MAX without memory. */
static uint32_t table_add(struct table *table, uint64_t key)
{
    if (2 * (table->count + 1) > table->size && !table_grow(table)) return UINT32_MAX;
    uint32_t *place = find_place(table, key);
    if (*place == UINT32_MAX) {
        *place = (uint32_t)table->count;
        table->entries[table->count++] = (struct entry){key, *place, UINT32_MAX};
    }
    return *place;
}

static uint32_t table_find(const struct table *table, uint64_t key)
{
    return table->size ? *find_place(table, key) : UINT32_MAX;
}

static void table_free(struct table *table)
{
    free(table->entries);
    free(table->places);
}

/* Twenty bits for each coordinate, from half way up, and which kind it is. */
static uint64_t make_key(const int64_t at[3], int excess)
{
    uint64_t key = (uint64_t)excess;
    for (int k = 0; k < 3; k++) key = key << 20 | ((uint64_t)(at[k] + (1 << 19)) & 0xfffff);
    return key;
}

static void split_key(uint64_t key, int64_t at[3])
{
    for (int k = 2; k >= 0; k--, key >>= 20) at[k] = (int64_t)(key & 0xfffff) - (1 << 19);
}

static uint32_t find_root(struct table *table, uint32_t i)
{
    while (table->entries[i].parent != i)
        i = table->entries[i].parent = table->entries[table->entries[i].parent].parent;
    return i;
}

static uint64_t sample_key(const struct clusters *c, const swarf_sample *sample, int edge)
{
    int64_t at[3];
    for (int k = 0; k < 3; k++)
        at[k] = (int64_t)floor((sample->xyz[k] - c->layout->origin[k]) / c->layout->voxel / edge);
    return make_key(at, sample->value > 0);
}

static int add_cells(struct clusters *c, const swarf_samples *samples)
{
    for (size_t i = 0; i < samples->count; i++)
        if (table_add(&c->cells, sample_key(c, &samples->samples[i], CELL)) == UINT32_MAX) return 0;
    return 1;
}

/* Join neighbours; each looks at the 13 that come after it. */
static void join_cells(struct clusters *c)
{
    for (uint32_t i = 0; i < c->cells.count; i++) {
        int64_t at[3];
        split_key(c->cells.entries[i].key, at);
        for (int side = 14; side < 27; side++) {
            const int64_t next[3] = {at[0] + side / 9 - 1, at[1] + side / 3 % 3 - 1, at[2] + side % 3 - 1};
            const uint32_t other = table_find(&c->cells, make_key(next, (int)(c->cells.entries[i].key >> 60)));
            if (other == UINT32_MAX) continue;
            const uint32_t a = find_root(&c->cells, i), b = find_root(&c->cells, other);
            c->cells.entries[a > b ? a : b].parent = a > b ? b : a;
        }
    }
    for (uint32_t i = 0; i < c->cells.count; i++)
        if (find_root(&c->cells, i) == i) c->cells.entries[i].cluster = (uint32_t)c->count++;
}

static uint32_t cluster_of(struct clusters *c, const swarf_sample *sample)
{
    const uint32_t cell = table_find(&c->cells, sample_key(c, sample, CELL));
    return c->cells.entries[find_root(&c->cells, cell)].cluster;
}

/* Count samples into their clusters. Those on the design only tell of clusters that have none on the stock. */
static void add_samples(struct clusters *c, const swarf_samples *samples)
{
    for (size_t i = 0; i < samples->count; i++) {
        const swarf_sample *sample = &samples->samples[i];
        swarf_cluster *cluster = &c->clusters[cluster_of(c, sample)];
        for (int k = 0; k < 3; k++) {
            cluster->box.lo[k] = fmin(cluster->box.lo[k], sample->xyz[k]);
            cluster->box.hi[k] = fmax(cluster->box.hi[k], sample->xyz[k]);
        }
        if (sample->missing && cluster->area_mm2 > 0 && !cluster->at_least) continue;
        cluster->at_least = sample->missing;
        cluster->excess = sample->value > 0;
        cluster->area_mm2 += sample->area;
        if (!(sample->kind & SWARF_POINT_UNTOUCHED)) cluster->reached = 1;
        if (!(fabs((double)sample->value) > fabs(cluster->value_mm))) continue;
        cluster->value_mm = sample->value;
        cluster->triangle = sample->triangle;
        for (int k = 0; k < 3; k++) cluster->place[k] = sample->xyz[k];
    }
}

static const swarf_slot_difference *slot_at(const struct clusters *c, const swarf_slot_difference *slots,
                                            const int64_t at[3])
{
    size_t node = 0;
    unsigned slot = 0;
    for (int k = 0; k < 3; k++) {
        if (at[k] < 0 || at[k] >> 4 >= c->layout->count[k]) return NULL;
        node = node * (size_t)c->layout->count[k] + (size_t)(at[k] >> 4);
        slot = slot << 4 | (unsigned)(at[k] & 15);
    }
    return &slots[node * SWARF_NODE_SLOTS + slot];
}

/* A slot with less than this many voxels of a difference passes no cluster on to its neighbours. */
static const float least_fill = 0.5f;

/* Give the slots that hold samples to their clusters; the first comes first. */
static int seed_slots(struct clusters *c, const swarf_samples *samples)
{
    for (size_t i = 0; i < samples->count; i++) {
        const swarf_sample *sample = &samples->samples[i];
        const size_t before = c->slots.count;
        const uint32_t slot = table_add(&c->slots, sample_key(c, sample, SWARF_LEAF_DIM));
        if (slot == UINT32_MAX) return 0;
        if (c->slots.count > before) c->slots.entries[slot].cluster = cluster_of(c, sample);
    }
    return 1;
}

static int share_volumes(struct clusters *c, const swarf_slot_difference *slots)
{
    const double cubic = c->layout->voxel * c->layout->voxel * c->layout->voxel;
    for (size_t i = 0; i < c->slots.count; i++) { /* grows as it goes */
        const struct entry own = c->slots.entries[i];
        const int excess = (int)(own.key >> 60);
        int64_t at[3];
        split_key(own.key, at);
        const swarf_slot_difference *here = slot_at(c, slots, at);
        if (!here) continue;
        c->clusters[own.cluster].volume_mm3 += cubic * (double)(excess ? here->excess : here->gouge);
        for (int side = 0; side < 6; side++) {
            int64_t next[3] = {at[0], at[1], at[2]};
            next[side / 2] += side % 2 ? 1 : -1;
            const swarf_slot_difference *there = slot_at(c, slots, next);
            if (!there || (excess ? there->excess : there->gouge) < least_fill) continue;
            const size_t before = c->slots.count;
            const uint32_t slot = table_add(&c->slots, make_key(next, excess));
            if (slot == UINT32_MAX) return 0;
            if (c->slots.count > before) c->slots.entries[slot].cluster = own.cluster;
        }
    }
    return 1;
}

static int fails(const swarf_cluster *c)
{
    return !c->excess || c->reached;
}

static int compare_clusters(const void *left, const void *right)
{
    const swarf_cluster *l = left, *r = right;
    if (fails(l) != fails(r)) return fails(l) ? -1 : 1;
    if (l->volume_mm3 != r->volume_mm3) return l->volume_mm3 > r->volume_mm3 ? -1 : 1;
    for (int k = 0; k < 3; k++)
        if (l->place[k] != r->place[k]) return l->place[k] < r->place[k] ? -1 : 1;
    return 0;
}

static swarf_status gather(struct clusters *c, const swarf_samples *on_stock, const swarf_samples *on_design,
                           const swarf_slot_difference *slots)
{
    if (!add_cells(c, on_stock) || !add_cells(c, on_design))
        return swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory for the places beyond tolerance");
    join_cells(c);
    c->clusters = calloc(c->count + 1, sizeof *c->clusters);
    if (!c->clusters) return swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory");
    for (size_t i = 0; i < c->count; i++)
        c->clusters[i].box = (swarf_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    add_samples(c, on_stock);
    add_samples(c, on_design);
    if (!seed_slots(c, on_stock) || !seed_slots(c, on_design) || !share_volumes(c, slots))
        return swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory");
    qsort(c->clusters, c->count, sizeof *c->clusters, compare_clusters);
    return SWARF_OK;
}

swarf_status swarf_cluster_samples(const swarf_tree_layout *layout, const swarf_samples *on_stock,
                                   const swarf_samples *on_design, const swarf_slot_difference *slots,
                                   swarf_cluster **out, size_t *count)
{
    struct clusters c = {.layout = layout};
    const swarf_status status = gather(&c, on_stock, on_design, slots);
    table_free(&c.cells);
    table_free(&c.slots);
    if (status != SWARF_OK) {
        free(c.clusters);
        return status;
    }
    *out = c.clusters;
    *count = c.count;
    return SWARF_OK;
}
