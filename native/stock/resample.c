/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Each new leaf fetches the old voxels about it once, into a block on the stack, and looks for its own between them.
 * Work is a column of 4x4 slots, the least that may be changed by one thread; slots that no old leaf is near become
 * tiles at once. */
#include "stock/resample.h"

#include "base/parallel.h"
#include "base/status.h"
#include "stock/interpolate.h"
#include "stock/leaf.h"
#include "stock/stock.h"

#include <math.h>
#include <stdlib.h>

/* Voxels along an edge of what a leaf can need: the diagonal of 7 voxels, the far corners of the last cell and the
 * halo about it. */
enum { BLOCK = 20 };

enum { COLUMNS = 16 }; /* of a node */

struct resampling {
    const swarf_stock *from;
    const swarf_tree_layout *old;
    swarf_tree *to;
    const swarf_tree_layout *layout;
    double step[3][3]; /* old voxels for one of the new along each axis: [new axis][old axis] */
    double first[3];   /* old place of the first of the new voxels */
    double reach[3];   /* of a leaf from its middle */
};

/* Old voxels as a block, in voxels; `corner`: the first of them. */
typedef struct block {
    int32_t corner[3], size[3];
    float value[BLOCK * BLOCK * BLOCK];
} block;

static const float *old_leaf(const struct resampling *r, const int32_t slot[3], int *inside)
{
    *inside = 0;
    for (int k = 0; k < 3; k++)
        if (slot[k] < 0 || slot[k] >= r->old->count[k] * (SWARF_NODE_DIM / SWARF_LEAF_DIM)) return NULL;
    const size_t number = swarf_layout_slot(r->old, slot), node = number / SWARF_NODE_SLOTS;
    const float *leaf = swarf_tree_leaf(r->from->tree, node, (unsigned)(number % SWARF_NODE_SLOTS));
    if (!leaf) *inside = swarf_tree_tile_inside(r->from->tree, node, (unsigned)(number % SWARF_NODE_SLOTS));
    return leaf;
}

/* What of an old slot lies in a block. */
static void copy_slot(const struct resampling *r, const int32_t slot[3], const float *leaf, float tile, block *b)
{
    const float scale = (float)(1 / r->old->voxel), background = r->old->background;
    int lo[3], hi[3], at[3];
    for (int k = 0; k < 3; k++) {
        at[k] = slot[k] * SWARF_LEAF_DIM - b->corner[k]; /* of its first voxel, may be negative */
        lo[k] = at[k] < 0 ? -at[k] : 0;
        hi[k] = b->size[k] - at[k] < SWARF_LEAF_DIM ? b->size[k] - at[k] : SWARF_LEAF_DIM;
    }
    for (int x = lo[0]; x < hi[0]; x++)
        for (int y = lo[1]; y < hi[1]; y++) {
            float *to = b->value + ((at[0] + x) * BLOCK + at[1] + y) * BLOCK + at[2];
            for (int z = lo[2]; z < hi[2]; z++) {
                const float value = leaf ? leaf[x * 64 + y * 8 + z] : 0;
                if (!leaf)
                    to[z] = tile;
                else /* rounding makes no distance of what is only known to be beyond */
                    to[z] = fabsf(value) < background ? value * scale : copysignf(SWARF_HALF_WIDTH, value);
            }
        }
}

/* Fill a block about the middle of a new leaf; whether there is any old leaf in it, else *inside tells what it is. */
static int fetch(const struct resampling *r, const double middle[3], block *b, int *inside)
{
    int32_t lo[3], hi[3], slot[3];
    int any = 0;
    for (int k = 0; k < 3; k++) {
        b->corner[k] = (int32_t)floor(middle[k] - r->reach[k]) - SWARF_CELL_HALO;
        b->size[k] = (int32_t)floor(middle[k] + r->reach[k]) + 2 + SWARF_CELL_HALO - b->corner[k];
        lo[k] = b->corner[k] >> 3;
        hi[k] = (b->corner[k] + b->size[k] - 1) >> 3;
    }
    for (slot[0] = lo[0]; slot[0] <= hi[0] && !any; slot[0]++)
        for (slot[1] = lo[1]; slot[1] <= hi[1] && !any; slot[1]++)
            for (slot[2] = lo[2]; slot[2] <= hi[2] && !any; slot[2]++) any = old_leaf(r, slot, inside) != NULL;
    if (!any) return 0;
    for (slot[0] = lo[0]; slot[0] <= hi[0]; slot[0]++)
        for (slot[1] = lo[1]; slot[1] <= hi[1]; slot[1]++)
            for (slot[2] = lo[2]; slot[2] <= hi[2]; slot[2]++) {
                int is_inside;
                const float *leaf = old_leaf(r, slot, &is_inside);
                copy_slot(r, slot, leaf, is_inside ? -SWARF_HALF_WIDTH : SWARF_HALF_WIDTH, b);
            }
    return 1;
}

static void fill_values(const struct resampling *r, const double first[3], const block *b,
                        float values[SWARF_LEAF_SIZE])
{
    static const int stride[2] = {BLOCK * BLOCK, BLOCK};
    const float background = r->layout->background, voxel = (float)r->old->voxel;
    for (int i = 0; i < SWARF_LEAF_SIZE; i++) {
        const int at[3] = {i >> 6, i >> 3 & 7, i & 7};
        double t[3];
        const float *low = b->value;
        for (int k = 0; k < 3; k++) {
            const double x = first[k] + at[0] * r->step[0][k] + at[1] * r->step[1][k] + at[2] * r->step[2][k];
            const double cell = floor(x);
            t[k] = x - cell;
            low += ((int32_t)cell - b->corner[k]) * (k < 2 ? stride[k] : 1);
        }
        const float value = swarf_field_interpolate(low, stride, t, SWARF_HALF_WIDTH) * voxel;
        values[i] = fminf(fmaxf(value, -background), background);
    }
}

static swarf_status fill_slot(const struct resampling *r, size_t node, unsigned slot, const int32_t corner[3])
{
    double first[3], middle[3];
    for (int k = 0; k < 3; k++) {
        first[k] = r->first[k];
        for (int j = 0; j < 3; j++) first[k] += corner[j] * r->step[j][k];
        middle[k] = first[k] + 3.5 * (r->step[0][k] + r->step[1][k] + r->step[2][k]);
    }
    block b;
    int inside;
    if (!fetch(r, middle, &b, &inside)) {
        if (inside) swarf_tree_tile(r->to, node, slot, 1);
        return SWARF_OK;
    }
    float values[SWARF_LEAF_SIZE], least;
    uint64_t mask[8], any = 0;
    fill_values(r, first, &b, values);
    swarf_leaf_mask(values, r->layout->background, mask, &least);
    if (least >= SWARF_LEAF_DROP * (float)r->layout->voxel) return SWARF_OK;
    for (int i = 0; i < 8; i++) any |= mask[i];
    if (any) return swarf_tree_leaf_add(r->to, node, slot, values, mask);
    swarf_tree_tile(r->to, node, slot, 1); /* all of them inside */
    return SWARF_OK;
}

static swarf_status fill_column(void *context, size_t index)
{
    const struct resampling *r = context;
    const size_t node = index / COLUMNS;
    const unsigned x = (unsigned)(index % COLUMNS / 4) * 4, y = (unsigned)(index % 4) * 4;
    int32_t origin[3], corner[3];
    swarf_node_corner(r->layout, node, origin);
    for (unsigned i = 0; i < 256; i++) {
        const unsigned slot = (x + (i >> 6)) << 8 | (y + (i >> 4 & 3)) << 4 | (i & 15);
        swarf_leaf_corner(origin, slot, corner);
        SWARF_TRY(fill_slot(r, node, slot, corner));
    }
    return SWARF_OK;
}

/* Box of the turned material in mm, to a leaf. */
static swarf_status find_box(const struct resampling *r, const swarf_placement *placement, swarf_box *out)
{
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    swarf_leaf *leaves;
    size_t count;
    SWARF_TRY(swarf_stock_leaves(r->from, &leaves, &count));
    for (size_t i = 0; i < count; i++) {
        int material = 0;
        for (int v = 0; v < SWARF_LEAF_SIZE && !material; v++) material = leaves[i].values[v] < 0;
        if (!material) continue;
        double middle[3];
        for (int k = 0; k < 3; k++) middle[k] = r->old->origin[k] + r->old->voxel * (leaves[i].ijk[k] + 3.5);
        swarf_placement_point(placement, middle, middle);
        for (int k = 0; k < 3; k++) {
            const double *row = placement->rotation[k];
            const double reach = 4.5 * r->old->voxel * (fabs(row[0]) + fabs(row[1]) + fabs(row[2]));
            box.lo[k] = fmin(box.lo[k], middle[k] - reach);
            box.hi[k] = fmax(box.hi[k], middle[k] + reach);
        }
    }
    free(leaves);
    if (!(box.lo[0] < box.hi[0]))
        return swarf_fail(SWARF_ERROR_GEOMETRY, "stock: nothing is left of it that could be set up again");
    *out = box;
    return SWARF_OK;
}

static swarf_status resample(struct resampling *r, const swarf_placement *placement, const swarf_stock_options *options,
                             const swarf_progress *progress)
{
    swarf_box box;
    double origin[3];
    int32_t count[3];
    SWARF_TRY(find_box(r, placement, &box));
    SWARF_TRY(swarf_stock_layout(&box, options, origin, count));
    SWARF_TRY(swarf_tree_create(options->voxel_mm, origin, count, &r->to));
    r->layout = swarf_tree_get_layout(r->to);
    const swarf_placement back = swarf_placement_inverse(placement);
    const double ratio = options->voxel_mm / r->old->voxel;
    swarf_placement_point(&back, origin, r->first);
    for (int k = 0; k < 3; k++) {
        r->first[k] = (r->first[k] - r->old->origin[k]) / r->old->voxel;
        r->reach[k] = 0;
        for (int j = 0; j < 3; j++) {
            r->step[j][k] = ratio * back.rotation[k][j];
            r->reach[k] += 3.5 * fabs(r->step[j][k]);
        }
        r->reach[k] += 1e-6; /* rounding */
    }
    const swarf_status status =
        swarf_parallel_for(swarf_layout_nodes(r->layout) * COLUMNS, fill_column, r, progress, 0, 1);
    if (status != SWARF_OK) swarf_tree_destroy(r->to);
    return status;
}

swarf_status swarf_stock_resample(swarf_stock *stock, const swarf_placement *placement,
                                  const swarf_stock_options *options, const swarf_progress *progress, swarf_stock **out)
{
    SWARF_REQUIRE(stock && placement && options && out, "stock: NULL");
    SWARF_TRY(swarf_stock_enter_read(stock));
    struct resampling r = {.from = stock, .old = swarf_tree_get_layout(stock->tree)};
    swarf_status status = resample(&r, placement, options, progress);
    if (status == SWARF_OK) status = swarf_stock_wrap(r.to, out);
    swarf_stock_leave(stock);
    return status;
}
