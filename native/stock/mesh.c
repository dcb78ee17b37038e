/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Closed triangles -> level set, from the exact distance to them. */
#include "stock/mesh.h"

#include "base/parallel.h"
#include "base/status.h"
#include "solid/field.h"
#include "solid/solid.h"
#include "stock/leaf.h"
#include "stock/stock.h"

/* Pieces of work: columns of 8 x 8 slots of a node, which share no words of masks. */
enum { COLUMN = 64, COLUMNS_PER_NODE = 4 };

struct work {
    swarf_tree *tree;
    const swarf_tree_layout *layout;
    swarf_field field;
};

struct node_work {
    const struct work *work;
    size_t node;
    int32_t origin[3];
};

static swarf_status fill_cube(void *context, const int32_t corner[3], int edge, const float *values, int inside)
{
    const struct node_work *node = context;
    const struct work *work = node->work;
    int lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        lo[k] = (corner[k] - node->origin[k]) / SWARF_LEAF_DIM;
        hi[k] = lo[k] + edge / SWARF_LEAF_DIM - 1;
    }
    if (!values) {
        if (inside) swarf_tree_fill(work->tree, node->node, lo, hi);
        return SWARF_OK;
    }
    uint64_t mask[8];
    float least;
    swarf_leaf_mask(values, work->layout->background, mask, &least);
    if (least >= SWARF_LEAF_DROP * (float)work->layout->voxel) return SWARF_OK;
    uint64_t any = 0;
    for (int i = 0; i < 8; i++) any |= mask[i];
    if (!any) { /* all of them inside */
        swarf_tree_fill(work->tree, node->node, lo, hi);
        return SWARF_OK;
    }
    const unsigned slot = (unsigned)(lo[0] << 8 | lo[1] << 4 | lo[2]);
    return swarf_tree_leaf_add(work->tree, node->node, slot, values, mask);
}

static swarf_status fill_column(void *context, size_t index)
{
    const struct work *work = context;
    struct node_work node = {.work = work, .node = index / COLUMNS_PER_NODE};
    swarf_node_corner(work->layout, node.node, node.origin);
    const int part = (int)(index % COLUMNS_PER_NODE);
    for (int z = 0; z < SWARF_NODE_DIM; z += COLUMN) {
        const int32_t corner[3] = {node.origin[0] + (part >> 1) * COLUMN, node.origin[1] + (part & 1) * COLUMN,
                                   node.origin[2] + z};
        SWARF_TRY(swarf_field_walk(&work->field, corner, COLUMN, fill_cube, &node));
    }
    return SWARF_OK;
}

/* Whether the solid is its bounding box. No triangle leaves its six faces, so all points inside have one winding
 * number, and the volume, which is positive, says that it is not zero. */
static int is_box(const swarf_solid *solid)
{
    const swarf_box *box = &solid->facts.box;
    for (size_t place = 0; place < solid->tree.count; place++) {
        const float(*p)[3] = solid->corners[place].xyz;
        int on_face = 0;
        for (int k = 0; k < 3; k++)
            on_face |= (p[0][k] == box->lo[k] || p[0][k] == box->hi[k]) && p[1][k] == p[0][k] && p[2][k] == p[0][k];
        if (!on_face) return 0;
    }
    return 1;
}

static swarf_status create_tree(const swarf_solid *solid, const swarf_stock_options *options,
                                const swarf_progress *progress, double from, double to, swarf_tree **out)
{
    struct work work = {.tree = NULL};
    int32_t count[3];
    work.field = (swarf_field){
        .solid = solid, .voxel = options->voxel_mm, .reach = (double)SWARF_HALF_WIDTH * options->voxel_mm};
    SWARF_TRY(swarf_stock_layout(&solid->facts.box, options, work.field.origin, count));
    SWARF_TRY(swarf_tree_create(options->voxel_mm, work.field.origin, count, &work.tree));
    work.layout = swarf_tree_get_layout(work.tree);
    const swarf_status status =
        swarf_parallel_for(swarf_layout_nodes(work.layout) * COLUMNS_PER_NODE, fill_column, &work, progress, from, to);
    if (status != SWARF_OK)
        swarf_tree_destroy(work.tree);
    else
        *out = work.tree;
    return status;
}

swarf_status swarf_stock_create_solid(const swarf_solid *solid, const swarf_stock_options *options,
                                      const swarf_progress *progress, double from, double to, swarf_stock **out)
{
    swarf_tree *tree = NULL;
    if (is_box(solid)) return swarf_stock_create_box(&solid->facts.box, options, out); /* exact, and at once */
    SWARF_TRY(create_tree(solid, options, progress, from, to, &tree));
    return swarf_stock_wrap(tree, out);
}

swarf_status swarf_stock_create_mesh(const swarf_triangles *triangles, const swarf_stock_options *options,
                                     const swarf_progress *progress, swarf_stock **out)
{
    SWARF_REQUIRE(triangles && options && out, "stock: triangles, options or output missing");
    swarf_solid *solid;
    SWARF_TRY(swarf_solid_make(triangles, 0, progress, 0, 0.3, &solid));
    const swarf_status status = swarf_stock_create_solid(solid, options, progress, 0.3, 1, out);
    swarf_solid_release(solid);
    return status;
}
