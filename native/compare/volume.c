/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Volumes of stock and design and of what each has beyond the other, on the voxels of the stock. The design is not
 * sampled into a tree of its own: a walk over its field meets the leaves of the stock one by one. */
#include "base/parallel.h"
#include "base/status.h"
#include "compare/compare.h"
#include "solid/field.h"
#include "stock/leaf.h"
#include "stock/measure.h"

#include <math.h>
#include <stdlib.h>

/* Voxels from its surface where the design's values are needed: those whose neighbours a gradient takes in. */
static const double reach_voxels = 1.5;

/* Pieces of work: eighths of a node. */
enum { CUBE = 64, CUBES_PER_NODE = 8, CUBE_SLOTS = CUBE / SWARF_LEAF_DIM };

struct sums {
    double excess, gouge, design; /* in voxels */
};

struct work {
    const swarf_tree *tree;
    const swarf_tree_layout *layout;
    swarf_field field;
    struct sums *sums;            /* per cube */
    const uint8_t *settled;       /* per slot; may be NULL */
    swarf_slot_difference *slots; /* may be NULL */
};

struct cube_work {
    const struct work *work;
    size_t node;
    int32_t origin[3]; /* of the node */
    struct sums sums;
};

static double fill_of(float value, float scale)
{
    const double fill = 0.5 - (double)(value * scale);
    return fill < 0 ? 0 : fill > 1 ? 1 : fill;
}

/* Differences to the neighbours in a leaf. */
static void gradient_at(const float *values, int at, double out[3])
{
    static const int stride[3] = {64, 8, 1};
    const int place[3] = {at >> 6, at >> 3 & 7, at & 7};
    for (int k = 0; k < 3; k++) {
        const int below = place[k] > 0, above = place[k] < 7;
        out[k] = (double)(values[at + above * stride[k]] - values[at - below * stride[k]]) / (below + above);
    }
}

/* Share of a voxel that is in both, from how much of it each fills: faces that look the same way overlap, faces that
 * look at each other exclude one another, faces at right angles are independent. */
static double common_fill(const float *a, const float *b, int at, double fill_a, double fill_b)
{
    const double apart = fill_a * fill_b;
    if (fill_a == 0 || fill_a == 1 || fill_b == 0 || fill_b == 1) return apart;
    double u[3], v[3], uv = 0, uu = 0, vv = 0;
    gradient_at(a, at, u);
    gradient_at(b, at, v);
    for (int k = 0; k < 3; k++) {
        uv += u[k] * v[k];
        uu += u[k] * u[k];
        vv += v[k] * v[k];
    }
    const double cosine = uu > 0 && vv > 0 ? uv / sqrt(uu * vv) : 0;
    const double most = fmin(fill_a, fill_b), least = fmax(0, fill_a + fill_b - 1);
    return cosine >= 0 ? apart + cosine * (most - apart) : apart - cosine * (least - apart);
}

static void add_slot(struct cube_work *cube, unsigned slot, double excess, double gouge, double design)
{
    cube->sums.excess += excess;
    cube->sums.gouge += gouge;
    cube->sums.design += design;
    if (cube->work->slots)
        cube->work->slots[cube->node * SWARF_NODE_SLOTS + slot] = (swarf_slot_difference){(float)excess, (float)gouge};
}

static void add_leaf(struct cube_work *cube, unsigned slot, const float *stock, int occupied, const float *design)
{
    const float scale = (float)(1 / cube->work->layout->voxel);
    double excess = 0, gouge = 0, total = 0;
    for (int i = 0; i < SWARF_LEAF_SIZE; i++) {
        const double own = stock ? fill_of(stock[i], scale) : occupied, other = fill_of(design[i], scale);
        const double both = stock ? common_fill(stock, design, i, own, other) : own * other;
        excess += own - both;
        gouge += other - both;
        total += other;
    }
    add_slot(cube, slot, excess, gouge, total);
}

static double leaf_fill(const float *values, float scale)
{
    double total = 0;
    for (int i = 0; i < SWARF_LEAF_SIZE; i++) total += fill_of(values[i], scale);
    return total;
}

/* Number in its node of slot i of those in a cube. */
static unsigned slot_in(const struct cube_work *cube, const int32_t corner[3], int slots, int i)
{
    int low[3];
    for (int k = 0; k < 3; k++) low[k] = (corner[k] - cube->origin[k]) / SWARF_LEAF_DIM;
    return (unsigned)((low[0] + i / (slots * slots)) << 8 | (low[1] + i / slots % slots) << 4 | (low[2] + i % slots));
}

/* Whether a cube has a slot that is not settled. */
static int is_wanted(void *context, const int32_t corner[3], int edge)
{
    const struct cube_work *cube = context;
    const uint8_t *settled = cube->work->settled + cube->node * SWARF_NODE_SLOTS;
    const int slots = edge / SWARF_LEAF_DIM;
    for (int i = 0; i < slots * slots * slots; i++)
        if (!settled[slot_in(cube, corner, slots, i)]) return 1;
    return 0;
}

static swarf_status add_cube(void *context, const int32_t corner[3], int edge, const float *values, int inside)
{
    struct cube_work *cube = context;
    const struct work *work = cube->work;
    const float scale = (float)(1 / work->layout->voxel);
    const int slots = edge / SWARF_LEAF_DIM;
    for (int i = 0; i < slots * slots * slots; i++) {
        const unsigned slot = slot_in(cube, corner, slots, i);
        if (work->settled && work->settled[cube->node * SWARF_NODE_SLOTS + slot]) continue;
        const int occupied =
            (int)(work->layout->occupied[cube->node * SWARF_NODE_WORDS + (slot >> 6)] >> (slot & 63) & 1);
        const float *stock = occupied ? swarf_tree_leaf(work->tree, cube->node, slot) : NULL;
        if (values) {
            add_leaf(cube, slot, stock, occupied, values);
            continue;
        }
        const double own = stock ? leaf_fill(stock, scale) : occupied * SWARF_LEAF_SIZE;
        if (inside)
            add_slot(cube, slot, 0, SWARF_LEAF_SIZE - own, SWARF_LEAF_SIZE);
        else
            add_slot(cube, slot, own, 0, 0);
    }
    return SWARF_OK;
}

static swarf_status compare_cube(void *context, size_t index)
{
    const struct work *work = context;
    struct cube_work cube = {.work = work, .node = index / CUBES_PER_NODE};
    swarf_node_corner(work->layout, cube.node, cube.origin);
    const int part = (int)(index % CUBES_PER_NODE);
    const int32_t corner[3] = {cube.origin[0] + (part >> 2) * CUBE, cube.origin[1] + (part >> 1 & 1) * CUBE,
                               cube.origin[2] + (part & 1) * CUBE};
    SWARF_TRY(swarf_field_walk(&work->field, corner, CUBE, add_cube, &cube));
    for (int i = 0; work->settled && i < CUBE_SLOTS * CUBE_SLOTS * CUBE_SLOTS; i++) {
        const size_t slot = cube.node * SWARF_NODE_SLOTS + slot_in(&cube, corner, CUBE_SLOTS, i);
        if (!work->settled[slot]) continue;
        cube.sums.excess += (double)work->slots[slot].excess;
        cube.sums.gouge += (double)work->slots[slot].gouge;
    }
    work->sums[index] = cube.sums;
    return SWARF_OK;
}

int swarf_layout_holds(const swarf_tree_layout *layout, const swarf_box *box)
{
    for (int k = 0; k < 3; k++)
        if (box->lo[k] < layout->origin[k] ||
            box->hi[k] > layout->origin[k] + (layout->count[k] * SWARF_NODE_DIM - 1) * layout->voxel)
            return 0;
    return 1;
}

swarf_status swarf_compare_slots(const swarf_stock *stock, const swarf_solid *design, const uint8_t *settled,
                                 const swarf_progress *progress, double from, double to, swarf_slot_difference *slots,
                                 swarf_comparison *out)
{
    struct work work = {
        .settled = settled, .slots = slots, .tree = stock->tree, .layout = swarf_tree_get_layout(stock->tree)};
    const double voxel = work.layout->voxel, cubic = voxel * voxel * voxel;
    work.field = (swarf_field){
        .solid = design, .voxel = voxel, .reach = reach_voxels * voxel, .wanted = settled ? is_wanted : NULL};
    for (int k = 0; k < 3; k++) work.field.origin[k] = work.layout->origin[k];
    const swarf_solid_facts facts = swarf_solid_get_facts(design);
    swarf_comparison result = {.design_mm3 = facts.volume_mm3};
    SWARF_TRY(swarf_measure_volume(stock, &result.stock_mm3));
    const size_t cubes = swarf_layout_nodes(work.layout) * CUBES_PER_NODE;
    work.sums = malloc(cubes * sizeof *work.sums);
    if (!work.sums) return swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory");
    const swarf_status status = swarf_parallel_for(cubes, compare_cube, &work, progress, from, to);
    double seen = 0;
    for (size_t i = 0; i < cubes && status == SWARF_OK; i++) {
        result.excess_mm3 += work.sums[i].excess * cubic;
        result.gouge_mm3 += work.sums[i].gouge * cubic;
        seen += work.sums[i].design * cubic;
    }
    free(work.sums);
    /* what reaches beyond the voxels of the stock is in none of the cubes */
    if (!swarf_layout_holds(work.layout, &facts.box)) result.gouge_mm3 += fmax(0, facts.volume_mm3 - seen);
    if (status == SWARF_OK) *out = result;
    return status;
}

swarf_status swarf_compare_volume(swarf_stock *stock, const swarf_solid *design, const swarf_progress *progress,
                                  swarf_comparison *out)
{
    SWARF_REQUIRE(stock && design && out, "compare: stock, design or output missing");
    SWARF_TRY(swarf_stock_enter_read(stock));
    const swarf_status status = swarf_compare_slots(stock, design, NULL, progress, 0, 1, NULL, out);
    swarf_stock_leave(stock);
    return status;
}
