/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Volume, box, hash, size, changes and samples. Sums are made per node and then in the order of the nodes, so that they
 * do not depend on the threads. */
#include "stock/measure.h"

#include "base/mix.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/block.h"
#include "stock/leaf.h"
#include "sweep/kernel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct walk {
    const swarf_stock *stock;
    const swarf_tree_layout *layout;
    double *volume;   /* in voxels, per node */
    uint64_t *hash;   /* per node */
    swarf_box *boxes; /* in voxels of the layout, per node */
};

static swarf_status node_volume(void *context, size_t node)
{
    const struct walk *walk = context;
    const swarf_stock *stock = walk->stock;
    const swarf_kernel *kernel = swarf_kernel_current();
    const float scale = (float)(1 / walk->layout->voxel);
    const uint64_t *words = walk->layout->occupied + node * SWARF_NODE_WORDS;
    double total = 0;
    int32_t origin[3], corner[3];
    swarf_node_corner(walk->layout, node, origin);
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        if (!(words[slot >> 6] >> (slot & 63) & 1)) continue;
        const float *values = swarf_tree_leaf(stock->tree, node, slot);
        _Alignas(64) float face[SWARF_LEAF_SIZE];
        swarf_leaf_corner(origin, slot, corner);
        if (!values && stock->untouched && swarf_block_reaches(stock, corner)) {
            uint64_t mask[8];
            float least;
            swarf_block_fill(stock, corner, face, mask, &least);
            values = face;
        }
        total += values ? kernel->occupancy(values, scale) : SWARF_LEAF_SIZE;
    }
    walk->volume[node] = total;
    return SWARF_OK;
}

swarf_status swarf_measure_volume(const swarf_stock *stock, double *out)
{
    struct walk walk = {.stock = stock, .layout = swarf_tree_get_layout(stock->tree)};
    const size_t nodes = swarf_layout_nodes(walk.layout);
    walk.volume = malloc(nodes * sizeof *walk.volume);
    if (!walk.volume) return swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory");
    const swarf_status status = swarf_parallel_for(nodes, node_volume, &walk, NULL, 0, 1);
    double total = 0;
    for (size_t node = 0; node < nodes && status == SWARF_OK; node++) total += walk.volume[node];
    free(walk.volume);
    if (status == SWARF_OK) *out = total * walk.layout->voxel * walk.layout->voxel * walk.layout->voxel;
    return status;
}

swarf_status swarf_stock_volume(swarf_stock *stock, double *out)
{
    SWARF_REQUIRE(out, "stock: output missing");
    SWARF_TRY(swarf_stock_enter_write(stock)); /* nothing is written, but faces need no leaves to be measured */
    const swarf_status status = swarf_measure_volume(stock, out);
    swarf_stock_leave(stock);
    return status;
}

/* Least value of each of the eight planes across each axis. */
static void find_least(const float values[SWARF_LEAF_SIZE], float least[3][SWARF_LEAF_DIM])
{
    for (int i = 0; i < 3 * SWARF_LEAF_DIM; i++) least[i / SWARF_LEAF_DIM][i % SWARF_LEAF_DIM] = INFINITY;
    for (int row = 0; row < SWARF_LEAF_DIM * SWARF_LEAF_DIM; row++) {
        const float *from = values + row * SWARF_LEAF_DIM;
        float low = from[0];
        for (int z = 0; z < SWARF_LEAF_DIM; z++) {
            least[2][z] = from[z] < least[2][z] ? from[z] : least[2][z];
            low = from[z] < low ? from[z] : low;
        }
        least[0][row >> 3] = low < least[0][row >> 3] ? low : least[0][row >> 3];
        least[1][row & 7] = low < least[1][row & 7] ? low : least[1][row & 7];
    }
}

/* A ball of radius -v around a voxel of value v < 0 is all material, so the material reaches at least that far; for
 * faces along the axes that is exact. */
static swarf_status node_box(void *context, size_t node)
{
    const struct walk *walk = context;
    const float scale = (float)(1 / walk->layout->voxel);
    const uint64_t *words = walk->layout->occupied + node * SWARF_NODE_WORDS;
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    int32_t origin[3];
    swarf_node_corner(walk->layout, node, origin);
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        if (!(words[slot >> 6] >> (slot & 63) & 1)) continue;
        int32_t corner[3];
        swarf_leaf_corner(origin, slot, corner);
        const float *values = swarf_tree_leaf(walk->stock->tree, node, slot);
        if (!values) {
            for (int k = 0; k < 3; k++) {
                box.lo[k] = fmin(box.lo[k], corner[k]);
                box.hi[k] = fmax(box.hi[k], corner[k] + SWARF_LEAF_DIM - 1);
            }
            continue;
        }
        float least[3][SWARF_LEAF_DIM];
        find_least(values, least);
        for (int i = 0; i < 3 * SWARF_LEAF_DIM; i++) {
            const int k = i / SWARF_LEAF_DIM, at = i % SWARF_LEAF_DIM;
            const double depth = -(double)(least[k][at] * scale);
            if (!(depth > 0)) continue;
            box.lo[k] = fmin(box.lo[k], corner[k] + at - depth);
            box.hi[k] = fmax(box.hi[k], corner[k] + at + depth);
        }
    }
    walk->boxes[node] = box;
    return SWARF_OK;
}

swarf_status swarf_stock_box(swarf_stock *stock, swarf_box *out)
{
    SWARF_REQUIRE(out, "stock: output missing");
    SWARF_TRY(swarf_stock_enter_read(stock));
    struct walk walk = {.stock = stock, .layout = swarf_tree_get_layout(stock->tree)};
    const size_t nodes = swarf_layout_nodes(walk.layout);
    walk.boxes = malloc(nodes * sizeof *walk.boxes);
    swarf_status status = walk.boxes ? swarf_parallel_for(nodes, node_box, &walk, NULL, 0, 1)
                                     : swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory");
    if (status == SWARF_OK) {
        swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        for (size_t node = 0; node < nodes; node++)
            for (int k = 0; k < 3; k++) {
                box.lo[k] = fmin(box.lo[k], walk.layout->origin[k] + walk.boxes[node].lo[k] * walk.layout->voxel);
                box.hi[k] = fmax(box.hi[k], walk.layout->origin[k] + walk.boxes[node].hi[k] * walk.layout->voxel);
            }
        *out = box;
    }
    free(walk.boxes);
    swarf_stock_leave(stock);
    return status;
}

/* The lowest and highest places of a leaf that are in the material along each axis; 0 where there are none. */
static int find_extent(const float values[SWARF_LEAF_SIZE], int lo[3], int hi[3])
{
    for (int k = 0; k < 3; k++) {
        lo[k] = SWARF_LEAF_DIM;
        hi[k] = -1;
    }
    for (int i = 0; i < SWARF_LEAF_SIZE; i++) {
        if (!(values[i] < 0)) continue;
        const int at[3] = {i >> 6, i >> 3 & 7, i & 7};
        for (int k = 0; k < 3; k++) {
            lo[k] = at[k] < lo[k] ? at[k] : lo[k];
            hi[k] = at[k] > hi[k] ? at[k] : hi[k];
        }
    }
    return hi[0] >= 0;
}

/* Material ends before the next voxel that is none. */
static swarf_status node_reach(void *context, size_t node)
{
    const struct walk *walk = context;
    const uint64_t *words = walk->layout->occupied + node * SWARF_NODE_WORDS;
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    int32_t origin[3], corner[3];
    swarf_node_corner(walk->layout, node, origin);
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        if (!(words[slot >> 6] >> (slot & 63) & 1)) continue;
        const float *values = swarf_tree_leaf(walk->stock->tree, node, slot);
        int lo[3] = {0, 0, 0}, hi[3] = {SWARF_LEAF_DIM - 1, SWARF_LEAF_DIM - 1, SWARF_LEAF_DIM - 1};
        swarf_leaf_corner(origin, slot, corner);
        if (values && !find_extent(values, lo, hi)) continue;
        for (int k = 0; k < 3; k++) {
            box.lo[k] = fmin(box.lo[k], corner[k] + lo[k] - 1);
            box.hi[k] = fmax(box.hi[k], corner[k] + hi[k] + 1);
        }
    }
    walk->boxes[node] = box;
    return SWARF_OK;
}

swarf_status swarf_measure_reach(const swarf_stock *stock, swarf_box *out)
{
    struct walk walk = {.stock = stock, .layout = swarf_tree_get_layout(stock->tree)};
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    if (stock->untouched) { /* what was cut away is not looked for */
        for (int k = 0; k < 3; k++) {
            box.lo[k] = stock->box_centre[k] - stock->box_half[k];
            box.hi[k] = stock->box_centre[k] + stock->box_half[k];
        }
    } else {
        const size_t nodes = swarf_layout_nodes(walk.layout);
        walk.boxes = malloc(nodes * sizeof *walk.boxes);
        if (!walk.boxes) return swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory");
        const swarf_status status = swarf_parallel_for(nodes, node_reach, &walk, NULL, 0, 1);
        for (size_t node = 0; node < nodes && status == SWARF_OK; node++)
            for (int k = 0; k < 3; k++) {
                box.lo[k] = fmin(box.lo[k], walk.boxes[node].lo[k]);
                box.hi[k] = fmax(box.hi[k], walk.boxes[node].hi[k]);
            }
        free(walk.boxes);
        SWARF_TRY(status);
    }
    for (int k = 0; k < 3; k++) {
        out->lo[k] = walk.layout->origin[k] + box.lo[k] * walk.layout->voxel;
        out->hi[k] = walk.layout->origin[k] + box.hi[k] * walk.layout->voxel;
    }
    return SWARF_OK;
}

static swarf_status node_hash(void *context, size_t node)
{
    const struct walk *walk = context;
    const uint64_t *words = walk->layout->occupied + node * SWARF_NODE_WORDS;
    uint64_t state = 1;
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        if (!(words[slot >> 6] >> (slot & 63) & 1)) continue;
        const float *values = swarf_tree_leaf(walk->stock->tree, node, slot);
        state = swarf_mix_fold(state, slot * 2 + (values != NULL));
        for (int i = 0; values && i < SWARF_LEAF_SIZE; i += 2) {
            uint64_t pair;
            memcpy(&pair, values + i, sizeof pair);
            state = swarf_mix_fold(state, pair);
        }
    }
    walk->hash[node] = state;
    return SWARF_OK;
}

swarf_status swarf_stock_hash(swarf_stock *stock, uint64_t *out)
{
    SWARF_REQUIRE(out, "stock: output missing");
    SWARF_TRY(swarf_stock_enter_read(stock));
    struct walk walk = {.stock = stock, .layout = swarf_tree_get_layout(stock->tree)};
    const size_t nodes = swarf_layout_nodes(walk.layout);
    walk.hash = malloc(nodes * sizeof *walk.hash);
    swarf_status status = walk.hash ? swarf_parallel_for(nodes, node_hash, &walk, NULL, 0, 1)
                                    : swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory");
    if (status == SWARF_OK) {
        uint64_t state = nodes;
        for (size_t node = 0; node < nodes; node++) state = swarf_mix_fold(state, walk.hash[node]);
        *out = state;
    }
    free(walk.hash);
    swarf_stock_leave(stock);
    return status;
}

swarf_status swarf_stock_size(swarf_stock *stock, size_t *leaves, size_t *bytes)
{
    SWARF_REQUIRE(leaves && bytes, "stock: output missing");
    SWARF_TRY(swarf_stock_enter_read(stock));
    swarf_tree_size(stock->tree, leaves, bytes);
    swarf_stock_leave(stock);
    return SWARF_OK;
}

static swarf_box cube_box(const swarf_tree_layout *layout, size_t node, int cube)
{
    const int edge = SWARF_CUBE_SLOTS * SWARF_LEAF_DIM, at[3] = {cube >> 4, cube >> 2 & 3, cube & 3};
    int32_t corner[3];
    swarf_node_corner(layout, node, corner);
    swarf_box box;
    for (int k = 0; k < 3; k++) {
        box.lo[k] = layout->origin[k] + (corner[k] + edge * at[k] - 0.5) * layout->voxel;
        box.hi[k] = box.lo[k] + edge * layout->voxel;
    }
    return box;
}

swarf_status swarf_stock_changed(swarf_stock *stock, uint32_t since, swarf_box *boxes, size_t room, size_t *count)
{
    SWARF_REQUIRE(count && (boxes || room == 0), "stock: output missing");
    SWARF_TRY(swarf_stock_enter_read(stock));
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    const size_t nodes = swarf_layout_nodes(layout);
    size_t found = 0;
    for (size_t node = 0; node < nodes; node++)
        for (int cube = 0; cube < SWARF_NODE_CUBES; cube++) {
            if (swarf_stock_stamp(stock, node, (unsigned)cube) <= since) continue;
            if (found < room) boxes[found] = cube_box(layout, node, cube);
            found++;
        }
    swarf_stock_leave(stock);
    *count = found;
    return SWARF_OK;
}

float swarf_stock_value(const swarf_stock *stock, const int32_t ijk[3])
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    for (int k = 0; k < 3; k++)
        if (ijk[k] < 0 || ijk[k] >= layout->count[k] * SWARF_NODE_DIM) return layout->background;
    const size_t node =
        ((size_t)(ijk[0] >> 7) * (size_t)layout->count[1] + (size_t)(ijk[1] >> 7)) * (size_t)layout->count[2] +
        (size_t)(ijk[2] >> 7);
    const unsigned slot =
        (unsigned)(ijk[0] >> 3 & 15) << 8 | (unsigned)(ijk[1] >> 3 & 15) << 4 | (unsigned)(ijk[2] >> 3 & 15);
    const float *values = swarf_tree_leaf(stock->tree, node, slot);
    if (values) return values[(ijk[0] & 7) * 64 + (ijk[1] & 7) * 8 + (ijk[2] & 7)];
    const int inside = (int)(layout->occupied[node * SWARF_NODE_WORDS + (slot >> 6)] >> (slot & 63) & 1);
    return inside ? -layout->background : layout->background;
}

static float sample(const swarf_stock *stock, const swarf_tree_layout *layout, const double point[3])
{
    int32_t corner[3];
    float part[3];
    for (int k = 0; k < 3; k++) {
        const double at = (point[k] - layout->origin[k]) / layout->voxel;
        if (!(at >= -1 && at < (double)layout->count[k] * SWARF_NODE_DIM)) return layout->background;
        corner[k] = (int32_t)floor(at);
        part[k] = (float)(at - corner[k]);
    }
    float value[8];
    for (int i = 0; i < 8; i++) {
        const int32_t ijk[3] = {corner[0] + (i >> 2), corner[1] + (i >> 1 & 1), corner[2] + (i & 1)};
        value[i] = swarf_stock_value(stock, ijk);
    }
    for (int i = 0; i < 4; i++) value[i] += part[0] * (value[i + 4] - value[i]);
    for (int i = 0; i < 2; i++) value[i] += part[1] * (value[i + 2] - value[i]);
    return value[0] + part[2] * (value[1] - value[0]);
}

enum { SAMPLES_AT_ONCE = 4096 };

struct sampling {
    const swarf_stock *stock;
    const double *points;
    float *out;
    size_t count;
};

static swarf_status sample_chunk(void *context, size_t index)
{
    const struct sampling *work = context;
    const swarf_tree_layout *layout = swarf_tree_get_layout(work->stock->tree);
    const size_t first = index * SAMPLES_AT_ONCE;
    const size_t last = first + SAMPLES_AT_ONCE < work->count ? first + SAMPLES_AT_ONCE : work->count;
    for (size_t i = first; i < last; i++) work->out[i] = sample(work->stock, layout, work->points + 3 * i);
    return SWARF_OK;
}

swarf_status swarf_measure_samples(const swarf_stock *stock, const double *points, size_t count,
                                   const swarf_progress *progress, float *out)
{
    for (size_t i = 0; i < 3 * count; i++)
        SWARF_REQUIRE(isfinite(points[i]), "stock: coordinate %c of point %zu is not finite", "xyz"[i % 3], i / 3);
    struct sampling work = {stock, points, out, count};
    return swarf_parallel_for((count + SAMPLES_AT_ONCE - 1) / SAMPLES_AT_ONCE, sample_chunk, &work, progress, 0, 1);
}

swarf_status swarf_stock_sample(swarf_stock *stock, const double *points, size_t count, float *out)
{
    SWARF_REQUIRE((points && out) || count == 0, "stock: points or output missing");
    SWARF_TRY(swarf_stock_enter_read(stock));
    const swarf_status status = swarf_measure_samples(stock, points, count, NULL, out);
    swarf_stock_leave(stock);
    return status;
}

swarf_status swarf_stock_leaves(const swarf_stock *stock, swarf_leaf **out, size_t *count)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    size_t total, bytes, used = 0;
    swarf_tree_size(stock->tree, &total, &bytes);
    swarf_leaf *leaves = malloc((total ? total : 1) * sizeof *leaves);
    if (!leaves) return swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory for %zu leaves", total);
    const size_t nodes = swarf_layout_nodes(layout);
    for (size_t node = 0; node < nodes; node++) {
        int32_t origin[3];
        swarf_node_corner(layout, node, origin);
        for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
            const float *values = swarf_tree_leaf(stock->tree, node, slot);
            if (!values) continue;
            swarf_leaf *leaf = &leaves[used++];
            swarf_leaf_corner(origin, slot, leaf->ijk);
            leaf->slot = slot;
            leaf->node = node;
            leaf->values = values;
        }
    }
    *out = leaves;
    *count = used;
    return SWARF_OK;
}
