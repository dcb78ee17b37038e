/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "stock/undo.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/block.h"
#include "stock/leaf.h"
#include "sweep/kernel.h"

#include <stdlib.h>
#include <string.h>

enum {
    ROW = 8,
    ROW_BYTES = ROW * sizeof(float),
    COLUMN_SLOTS = 4, /* along x and y */
    NODE_COLUMNS = 16 / COLUMN_SLOTS,
    SLOTS_AT_ONCE = COLUMN_SLOTS * COLUMN_SLOTS * 16 /* of a column, in one node */
};

enum kind { KIND_TILE, KIND_ROWS, KIND_LEAF };

struct entry {
    uint64_t rows; /* stored after this head */
    uint64_t same; /* the same as the one before among all rows of the entry */
    uint32_t node;
    uint16_t slot;
    uint16_t kind;
};

static size_t entry_bytes(const struct entry *entry)
{
    return sizeof *entry + (size_t)__builtin_popcountll(entry->rows) * ROW_BYTES;
}

static void free_layer(swarf_undo_layer *layer)
{
    for (size_t i = 0; i < layer->count; i++) free(layer->columns[i].bytes);
    free(layer->columns);
}

void swarf_undo_free(swarf_undo *undo)
{
    for (size_t i = 0; i < undo->count; i++) free_layer(&undo->layers[i]);
    free(undo->layers);
    free(undo->index);
    *undo = (swarf_undo){.first = 0};
}

static int32_t columns_along_y(const swarf_tree_layout *layout)
{
    return layout->count[1] * NODE_COLUMNS;
}

swarf_status swarf_undo_open(swarf_undo *undo, const swarf_tree_layout *layout, const int32_t *numbers, size_t count)
{
    const size_t total = (size_t)layout->count[0] * NODE_COLUMNS * (size_t)columns_along_y(layout);
    SWARF_TRY(swarf_array_reserve((void **)&undo->layers, &undo->room, undo->count + 1, sizeof *undo->layers));
    swarf_undo_column *columns = calloc(count + 1, sizeof *columns);
    undo->index = malloc(total * sizeof *undo->index);
    if (!columns || !undo->index) {
        free(columns);
        free(undo->index);
        undo->index = NULL;
        return swarf_fail(SWARF_ERROR_MEMORY, "history: out of memory");
    }
    for (size_t i = 0; i < count; i++) {
        columns[i].number = numbers[i];
        undo->index[numbers[i]] = (int32_t)i;
    }
    undo->layers[undo->count++] = (swarf_undo_layer){.first = undo->first, .columns = columns, .count = count};
    return SWARF_OK;
}

/* Room for `bytes` more; they are the caller's to write. */
static unsigned char *extend(swarf_undo_column *column, size_t bytes)
{
    if (swarf_array_reserve((void **)&column->bytes, &column->room, column->size + bytes, 1) != SWARF_OK) return NULL;
    unsigned char *const place = column->bytes + column->size;
    column->size += bytes;
    return place;
}

static int is_same_row(const float *a, const float *b)
{
    uint64_t own[4], other[4];
    memcpy(own, a, sizeof own);
    memcpy(other, b, sizeof other);
    return ((own[0] ^ other[0]) | (own[1] ^ other[1]) | (own[2] ^ other[2]) | (own[3] ^ other[3])) == 0;
}

/* Of these rows those that repeat the one before: along level and upright faces most do. */
static uint64_t find_same(const float *values, uint64_t rows)
{
    if (!rows) return 0;
    uint64_t same = swarf_kernel_current()->rows_repeated(values) & rows & rows << 1;
    for (uint64_t left = rows & ~(rows << 1) & (rows - 1); left; left &= left - 1) { /* first ones after a gap */
        const int row = __builtin_ctzll(left);
        const int last = 63 - __builtin_clzll(rows & (((uint64_t)1 << row) - 1));
        if (is_same_row(values + (ptrdiff_t)row * ROW, values + (ptrdiff_t)last * ROW)) same |= (uint64_t)1 << row;
    }
    return same;
}

/* Append the rows of a leaf. */
static swarf_status append_entry(swarf_undo_column *column, struct entry entry, uint64_t rows, const float *values)
{
    entry.same = find_same(values, rows);
    entry.rows = rows & ~entry.same;
    unsigned char *place = extend(column, entry_bytes(&entry));
    if (!place) return SWARF_ERROR_MEMORY;
    memcpy(place, &entry, sizeof entry);
    place += sizeof entry;
    for (rows = entry.rows; rows; rows &= rows - 1, place += ROW_BYTES)
        memcpy(place, values + (ptrdiff_t)__builtin_ctzll(rows) * ROW, ROW_BYTES);
    return SWARF_OK;
}

swarf_status swarf_undo_keep(swarf_undo *undo, int32_t column, size_t node, unsigned slot, const float *before,
                             const float *after)
{
    const swarf_undo_layer *layer = &undo->layers[undo->count - 1];
    struct entry entry = {.node = (uint32_t)node, .slot = (uint16_t)slot, .kind = KIND_TILE};
    const uint64_t rows = !before ? 0 : after ? swarf_kernel_current()->rows_changed(before, after) : UINT64_MAX;
    if (before && !rows) return SWARF_OK;
    if (before) entry.kind = after ? KIND_ROWS : KIND_LEAF;
    return append_entry(&layer->columns[undo->index[column]], entry, rows, before);
}

/* What is in the columns of a layer. */
static void count_layer(swarf_undo_layer *layer)
{
    layer->bytes = sizeof *layer + layer->count * sizeof *layer->columns;
    layer->slots = 0;
    for (size_t i = 0; i < layer->count; i++) {
        layer->slots += layer->columns[i].slots;
        layer->bytes += layer->columns[i].room;
    }
}

/* Count what is in a column's list, and let it fit. */
static void finish_column(swarf_undo_column *column)
{
    if (!column->size) return;
    struct entry entry;
    column->slots = 0;
    for (size_t at = 0; at < column->size; at += entry_bytes(&entry)) {
        memcpy(&entry, column->bytes + at, sizeof entry);
        column->slots++;
    }
    unsigned char *fitting = realloc(column->bytes, column->size);
    if (!fitting) return;
    column->bytes = fitting;
    column->room = column->size;
}

void swarf_undo_finish(swarf_undo *undo, int32_t column)
{
    finish_column(&undo->layers[undo->count - 1].columns[undo->index[column]]);
}

void swarf_undo_close(swarf_undo *undo)
{
    swarf_undo_layer *layer = &undo->layers[undo->count - 1];
    size_t used = 0;
    for (size_t i = 0; i < layer->count; i++) {
        if (layer->columns[i].size) layer->columns[used++] = layer->columns[i];
    }
    layer->count = used;
    swarf_undo_column *fitting = realloc(layer->columns, (used + 1) * sizeof *fitting);
    if (fitting) layer->columns = fitting;
    count_layer(layer);
    undo->bytes += layer->bytes;
    free(undo->index);
    undo->index = NULL;
}

/* ---- putting back ------------------------------------------------------------------------------------------------ */

static void put_rows(const struct entry *entry, const unsigned char *stored, float *values)
{
    const unsigned char *row = stored;
    for (uint64_t rows = entry->rows | entry->same; rows; rows &= rows - 1) {
        if (entry->rows & rows & (~rows + 1)) {
            row = stored;
            stored += ROW_BYTES;
        }
        memcpy(values + (ptrdiff_t)__builtin_ctzll(rows) * ROW, row, ROW_BYTES);
    }
}

static swarf_status put_entry(swarf_tree *tree, const struct entry *entry, const unsigned char *stored)
{
    const float background = swarf_tree_get_layout(tree)->background;
    _Alignas(64) float whole[SWARF_LEAF_SIZE];
    uint64_t mask[8];
    if (entry->kind == KIND_TILE) {
        swarf_tree_tile(tree, entry->node, entry->slot, 1);
        return SWARF_OK;
    }
    float *values = entry->kind == KIND_LEAF ? whole : swarf_tree_leaf(tree, entry->node, entry->slot);
    put_rows(entry, stored, values);
    swarf_kernel_current()->band(values, background, mask);
    if (entry->kind == KIND_LEAF) return swarf_tree_leaf_add(tree, entry->node, entry->slot, values, mask);
    swarf_tree_leaf_mask(tree, entry->node, entry->slot, mask);
    return SWARF_OK;
}

struct pop {
    swarf_tree *tree;
    const swarf_undo_layer *layer;
};

static swarf_status pop_column(void *context, size_t index)
{
    const struct pop *pop = context;
    const swarf_undo_column *column = &pop->layer->columns[index];
    struct entry entry;
    for (size_t at = 0; at < column->size; at += entry_bytes(&entry)) {
        memcpy(&entry, column->bytes + at, sizeof entry);
        SWARF_TRY(put_entry(pop->tree, &entry, column->bytes + at + sizeof entry));
    }
    return SWARF_OK;
}

swarf_status swarf_undo_pop(swarf_undo *undo, swarf_stock *stock)
{
    swarf_undo_layer *layer = &undo->layers[undo->count - 1];
    struct pop pop = {stock->tree, layer};
    swarf_tree_next_generation(stock->tree);
    SWARF_TRY(swarf_parallel_for(layer->count, pop_column, &pop, NULL, 0, 1));
    undo->bytes -= layer->bytes;
    free_layer(layer);
    undo->count--;
    return SWARF_OK;
}

void swarf_undo_forget(swarf_undo *undo, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        undo->bytes -= undo->layers[i].bytes;
        free_layer(&undo->layers[i]);
    }
    undo->count -= count;
    if (count) memmove(undo->layers, undo->layers + count, undo->count * sizeof *undo->layers);
}

/* ---- two layers as one ------------------------------------------------------------------------------------------- */

struct merge {
    const swarf_tree_layout *layout;
    swarf_undo_column *older, *newer; /* sorted by number */
    size_t older_count, newer_count;
    swarf_undo_column *out;      /* one per number */
    swarf_undo_column **sources; /* two per number: the older and the newer list's, NULL where it lacks it */
};

static struct entry entry_at(const swarf_undo_column *column, size_t at)
{
    struct entry entry;
    memcpy(&entry, column->bytes + at, sizeof entry);
    return entry;
}

/* Where a slot lies among those of its column. */
static size_t place_in_column(const swarf_tree_layout *layout, const struct entry *entry)
{
    const unsigned slot = entry->slot;
    const unsigned place = (slot >> 8 & 3) << 6 | (slot >> 4 & 3) << 4 | (slot & 15);
    return entry->node % (size_t)layout->count[2] * SLOTS_AT_ONCE + place;
}

static swarf_status append_bytes(swarf_undo_column *out, const void *bytes, size_t count)
{
    unsigned char *place = extend(out, count);
    if (!place) return SWARF_ERROR_MEMORY;
    memcpy(place, bytes, count);
    return SWARF_OK;
}

/* A slot of which both lists know: the older one's rows, and those of the newer that it lacks. */
static swarf_status append_both(swarf_undo_column *out, const swarf_undo_column *older, size_t older_at,
                                const swarf_undo_column *newer, size_t newer_at)
{
    const struct entry a = entry_at(older, older_at), b = entry_at(newer, newer_at);
    if (a.kind != KIND_ROWS) return append_bytes(out, older->bytes + older_at, entry_bytes(&a));
    _Alignas(64) float values[SWARF_LEAF_SIZE] = {0};
    put_rows(&b, newer->bytes + newer_at + sizeof b, values);
    put_rows(&a, older->bytes + older_at + sizeof a, values);
    return append_entry(out, b, a.rows | a.same | b.rows | b.same, values);
}

static swarf_status merge_lists(const struct merge *merge, const swarf_undo_column *older,
                                const swarf_undo_column *newer, swarf_undo_column *out)
{
    /* per slot: 1 + where the newer list has it */
    size_t *found = calloc((size_t)merge->layout->count[2] * SLOTS_AT_ONCE, sizeof *found);
    if (!found) return swarf_fail(SWARF_ERROR_MEMORY, "history: out of memory");
    struct entry entry;
    swarf_status status = SWARF_OK;
    for (size_t at = 0; at < newer->size; at += entry_bytes(&entry)) {
        entry = entry_at(newer, at);
        found[place_in_column(merge->layout, &entry)] = at + 1;
    }
    for (size_t at = 0; at < older->size && status == SWARF_OK; at += entry_bytes(&entry)) {
        entry = entry_at(older, at);
        size_t *other = &found[place_in_column(merge->layout, &entry)];
        status = *other ? append_both(out, older, at, newer, *other - 1)
                        : append_bytes(out, older->bytes + at, entry_bytes(&entry));
        *other = 0;
    }
    for (size_t at = 0; at < newer->size && status == SWARF_OK; at += entry_bytes(&entry)) {
        entry = entry_at(newer, at);
        if (found[place_in_column(merge->layout, &entry)])
            status = append_bytes(out, newer->bytes + at, entry_bytes(&entry));
    }
    free(found);
    if (status == SWARF_OK) finish_column(out);
    return status;
}

static swarf_status merge_column(void *context, size_t index)
{
    const struct merge *merge = context;
    const swarf_undo_column *older = merge->sources[2 * index], *newer = merge->sources[2 * index + 1];
    return older && newer ? merge_lists(merge, older, newer, &merge->out[index]) : SWARF_OK;
}

/* Pair the columns of both lists by their numbers; how many there are. */
static size_t pair_columns(const struct merge *merge)
{
    size_t a = 0, b = 0, count = 0;
    while (a < merge->older_count || b < merge->newer_count) {
        const int32_t own = a < merge->older_count ? merge->older[a].number : INT32_MAX;
        const int32_t other = b < merge->newer_count ? merge->newer[b].number : INT32_MAX;
        merge->out[count].number = own < other ? own : other;
        merge->sources[2 * count] = own <= other ? &merge->older[a++] : NULL;
        merge->sources[2 * count + 1] = other <= own ? &merge->newer[b++] : NULL;
        count++;
    }
    return count;
}

swarf_status swarf_undo_merge(swarf_undo *undo, const swarf_tree_layout *layout, size_t at)
{
    swarf_undo_layer *older = &undo->layers[at], *newer = older + 1;
    const size_t most = older->count + newer->count;
    struct merge merge = {layout, older->columns, newer->columns, older->count, newer->count, NULL, NULL};
    merge.out = calloc(most + 1, sizeof *merge.out);
    merge.sources = calloc(most + 1, 2 * sizeof *merge.sources);
    size_t count = 0;
    swarf_status status = SWARF_OK;
    if (!merge.out || !merge.sources) {
        status = swarf_fail(SWARF_ERROR_MEMORY, "history: out of memory");
    } else {
        count = pair_columns(&merge);
        status = swarf_parallel_for(count, merge_column, &merge, NULL, 0, 1);
    }
    if (status == SWARF_OK) {
        for (size_t i = 0; i < count; i++) {
            swarf_undo_column *own = merge.sources[2 * i], *other = merge.sources[2 * i + 1];
            if (own && other) continue;
            swarf_undo_column *only = own ? own : other;
            merge.out[i] = *only; /* its list goes over */
            only->bytes = NULL;
        }
        undo->bytes -= older->bytes + newer->bytes;
        free_layer(older);
        free_layer(newer);
        older->columns = merge.out;
        older->count = count;
        count_layer(older);
        undo->bytes += older->bytes;
        undo->count--;
        memmove(newer, newer + 1, (undo->count - at - 1) * sizeof *newer);
    } else {
        for (size_t i = 0; merge.out && i < count; i++) free(merge.out[i].bytes);
        free(merge.out);
    }
    free(merge.sources);
    return status;
}

/* ---- another stock's content ------------------------------------------------------------------------------------- */

struct match {
    swarf_undo *undo;
    swarf_stock *stock;
    const swarf_stock *other;
    const swarf_tree_layout *layout;
};

/* What a slot shall be: a leaf (its values), or a tile. */
struct wanted {
    const float *values;
    int inside;
    _Alignas(64) float face[SWARF_LEAF_SIZE];
};

static void find_wanted(const struct match *match, size_t node, unsigned slot, struct wanted *wanted)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(match->other->tree);
    wanted->values = swarf_tree_leaf(match->other->tree, node, slot);
    wanted->inside = (int)(layout->occupied[node * SWARF_NODE_WORDS + (slot >> 6)] >> (slot & 63) & 1);
    if (wanted->values || !wanted->inside || !match->other->untouched) return;
    int32_t origin[3], corner[3];
    swarf_node_corner(layout, node, origin);
    swarf_leaf_corner(origin, slot, corner);
    if (!swarf_block_reaches(match->other, corner)) return;
    uint64_t mask[8];
    float least;
    swarf_block_fill(match->other, corner, wanted->face, mask, &least);
    wanted->inside = 0;
    if (least < SWARF_LEAF_DROP * (float)layout->voxel) wanted->values = wanted->face;
}

static swarf_status match_slot(const struct match *match, int32_t column, size_t node, unsigned slot)
{
    swarf_tree *tree = match->stock->tree;
    const float background = match->layout->background;
    struct wanted wanted;
    find_wanted(match, node, slot, &wanted);
    float *values = swarf_tree_leaf(tree, node, slot);
    const int inside = (int)(match->layout->occupied[node * SWARF_NODE_WORDS + (slot >> 6)] >> (slot & 63) & 1);
    if (values && wanted.values ? memcmp(values, wanted.values, SWARF_LEAF_SIZE * sizeof *values) == 0
                                : !values && !wanted.values && inside == wanted.inside)
        return SWARF_OK;
    if (match->undo) SWARF_TRY(swarf_undo_keep(match->undo, column, node, slot, values, wanted.values));
    if (!wanted.values) {
        swarf_tree_tile(tree, node, slot, wanted.inside);
        return SWARF_OK;
    }
    uint64_t mask[8];
    swarf_kernel_current()->band(wanted.values, background, mask);
    if (!values) return swarf_tree_leaf_add(tree, node, slot, wanted.values, mask);
    memcpy(values, wanted.values, SWARF_LEAF_SIZE * sizeof *values);
    swarf_tree_leaf_mask(tree, node, slot, mask);
    return SWARF_OK;
}

static swarf_status match_column(void *context, size_t index)
{
    const struct match *match = context;
    const int32_t along = columns_along_y(match->layout), z_count = match->layout->count[2];
    const int32_t x = (int32_t)index / along, y = (int32_t)index % along;
    const size_t node =
        ((size_t)(x / NODE_COLUMNS) * (size_t)match->layout->count[1] + (size_t)(y / NODE_COLUMNS)) * (size_t)z_count;
    const unsigned low = (unsigned)(x % NODE_COLUMNS) << 10 | (unsigned)(y % NODE_COLUMNS) << 6;
    for (int32_t z = 0; z < z_count; z++)
        for (unsigned i = 0; i < SLOTS_AT_ONCE; i++)
            SWARF_TRY(match_slot(match, (int32_t)index, node + (size_t)z,
                                 low + ((i >> 6) << 8 | (i >> 4 & 3) << 4 | (i & 15))));
    if (match->undo) swarf_undo_finish(match->undo, (int32_t)index);
    return SWARF_OK;
}

swarf_status swarf_undo_match(swarf_undo *undo, swarf_stock *stock, const swarf_stock *other)
{
    struct match match = {undo, stock, other, swarf_tree_get_layout(stock->tree)};
    const size_t count = (size_t)match.layout->count[0] * NODE_COLUMNS * (size_t)columns_along_y(match.layout);
    if (undo) {
        int32_t *numbers = malloc(count * sizeof *numbers);
        if (!numbers) return swarf_fail(SWARF_ERROR_MEMORY, "history: out of memory");
        for (size_t i = 0; i < count; i++) numbers[i] = (int32_t)i;
        const swarf_status status = swarf_undo_open(undo, match.layout, numbers, count);
        free(numbers);
        if (status != SWARF_OK) return status;
    }
    swarf_tree_next_generation(stock->tree);
    const swarf_status status = swarf_parallel_for(count, match_column, &match, NULL, 0, 1);
    if (undo) swarf_undo_close(undo);
    return status;
}
