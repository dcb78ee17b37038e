/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* How deep a solid reaches into a stock: its exact field is walked over the stock's voxels. */
#include "base/parallel.h"
#include "base/status.h"
#include "compare/compare.h"
#include "solid/field.h"
#include "stock/leaf.h"

#include <math.h>
#include <stdlib.h>

/* Pieces of work: eighths of a node. */
enum { CUBE = 64, CUBES_PER_NODE = 8 };

/* Voxels in the material up to this many from its surface tell of thin overlaps by the sum of both distances; deeper
 * ones only of what both are deep, for beside edges distances run short. */
static const double near_surface = 1;

struct deepest {
    double depth; /* mm */
    int32_t ijk[3];
};

struct work {
    const swarf_tree *tree;
    const swarf_tree_layout *layout;
    swarf_field field;
    struct deepest *cubes;
};

struct cube_work {
    const struct work *work;
    size_t node;
    struct deepest deepest;
};

static void see_voxel(struct cube_work *cube, double own, double other, const int32_t ijk[3])
{
    if (own > 0) return;
    const double both = fmin(-own, -other);
    const double depth = own > -near_surface * cube->work->layout->voxel ? fmax(both, -own - other) : both;
    if (depth > cube->deepest.depth) cube->deepest = (struct deepest){depth, {ijk[0], ijk[1], ijk[2]}};
}

static swarf_status see_cube(void *context, const int32_t corner[3], int edge, const float *values, int inside)
{
    struct cube_work *cube = context;
    const struct work *work = cube->work;
    const int slots = edge / SWARF_LEAF_DIM;
    if (!values && !inside) return SWARF_OK;
    for (int i = 0; i < slots * slots * slots; i++) {
        const int32_t low[3] = {corner[0] + SWARF_LEAF_DIM * (i / (slots * slots)),
                                corner[1] + SWARF_LEAF_DIM * (i / slots % slots),
                                corner[2] + SWARF_LEAF_DIM * (i % slots)};
        const unsigned slot = (unsigned)((low[0] >> 3 & 15) << 8 | (low[1] >> 3 & 15) << 4 | (low[2] >> 3 & 15));
        if (!(work->layout->occupied[cube->node * SWARF_NODE_WORDS + (slot >> 6)] >> (slot & 63) & 1)) continue;
        const float *stock = swarf_tree_leaf(work->tree, cube->node, slot);
        for (int k = 0; k < SWARF_LEAF_SIZE; k++) {
            const int32_t ijk[3] = {low[0] + (k >> 6), low[1] + (k >> 3 & 7), low[2] + (k & 7)};
            see_voxel(cube, stock ? (double)stock[k] : -(double)work->layout->background,
                      values ? (double)values[k] : -work->field.reach, ijk);
        }
    }
    return SWARF_OK;
}

static swarf_status walk_cube(void *context, size_t index)
{
    const struct work *work = context;
    struct cube_work cube = {.work = work, .node = index / CUBES_PER_NODE};
    int32_t corner[3];
    swarf_node_corner(work->layout, cube.node, corner);
    const int part = (int)(index % CUBES_PER_NODE);
    corner[0] += (part >> 2) * CUBE;
    corner[1] += (part >> 1 & 1) * CUBE;
    corner[2] += (part & 1) * CUBE;
    SWARF_TRY(swarf_field_walk(&work->field, corner, CUBE, see_cube, &cube));
    work->cubes[index] = cube.deepest;
    return SWARF_OK;
}

static swarf_status find_deepest(const swarf_stock *stock, const swarf_solid *solid, const swarf_progress *progress,
                                 struct deepest *out)
{
    struct work work = {.tree = stock->tree, .layout = swarf_tree_get_layout(stock->tree)};
    work.field = (swarf_field){
        .solid = solid, .voxel = work.layout->voxel, .reach = (double)SWARF_HALF_WIDTH * work.layout->voxel};
    for (int k = 0; k < 3; k++) work.field.origin[k] = work.layout->origin[k];
    const size_t count = swarf_layout_nodes(work.layout) * CUBES_PER_NODE;
    work.cubes = malloc(count * sizeof *work.cubes);
    if (!work.cubes) return swarf_fail(SWARF_ERROR_MEMORY, "compare: out of memory");
    const swarf_status status = swarf_parallel_for(count, walk_cube, &work, progress, 0, 1);
    struct deepest deepest = {0};
    for (size_t i = 0; i < count && status == SWARF_OK; i++)
        if (work.cubes[i].depth > deepest.depth) deepest = work.cubes[i];
    free(work.cubes);
    if (status == SWARF_OK) *out = deepest;
    return status;
}

swarf_status swarf_compare_overlap(swarf_stock *stock, const swarf_solid *solid, const swarf_progress *progress,
                                   double *depth, double point[3])
{
    SWARF_REQUIRE(stock && solid && depth && point, "overlap: stock, solid or output missing");
    struct deepest deepest;
    SWARF_TRY(swarf_stock_enter_read(stock));
    const swarf_status status = find_deepest(stock, solid, progress, &deepest);
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    for (int k = 0; k < 3 && status == SWARF_OK; k++) point[k] = layout->origin[k] + layout->voxel * deepest.ijk[k];
    if (status == SWARF_OK) *depth = deepest.depth;
    swarf_stock_leave(stock);
    return status;
}
