/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Making, laying out, entering and leaving a stock. */
#include "stock/stock.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/block.h"
#include "stock/leaf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Air kept around the material, in voxels. Half a leaf more than a whole one puts the faces of a block into the middle
 * of leaves, so that one layer of them holds the band, not two: half the leaves and time for faces. */
enum { PADDING = SWARF_LEAF_DIM + SWARF_LEAF_DIM / 2 };

/* Bytes of a 128^3 node with its table, and of a leaf with buffer and allocator overhead (measured on OpenVDB 10). */
static const double node_bytes = 33500, leaf_bytes = 2048 + 160;

/* Usual parts end with 1.4 times the leaves that the faces of their block have; three times leaves room for deep
 * pockets and the walls that stand between two passes. */
static const double surface_factor = 3;

/* Voxels that OpenVDB's transforms and the floats in leaves can hold (mm), and how far from the origin positions stay
 * good to a fraction of such a voxel: as far as a program's coordinates may lie. */
static const double least_voxel = 1e-4, greatest_voxel = 1e4, farthest = 1e6;

swarf_stock_options swarf_stock_options_default(void)
{
    return (swarf_stock_options){.size = sizeof(swarf_stock_options)};
}

static double estimate(const swarf_box *box, double voxel)
{
    double nodes = 1, leaves[3];
    for (int k = 0; k < 3; k++) {
        const double voxels = (box->hi[k] - box->lo[k]) / voxel + 2 * PADDING;
        nodes *= ceil(voxels / SWARF_NODE_DIM);
        leaves[k] = voxels / SWARF_LEAF_DIM;
    }
    const double surface = 2 * (leaves[0] * leaves[1] + leaves[1] * leaves[2] + leaves[2] * leaves[0]);
    return nodes * node_bytes + surface_factor * surface * leaf_bytes;
}

static swarf_status check_box(const swarf_box *box, double voxel)
{
    SWARF_REQUIRE(box, "stock: box missing");
    SWARF_REQUIRE(isfinite(voxel) && voxel > 0, "stock: voxel size %g mm is not a positive number", voxel);
    for (int k = 0; k < 3; k++) {
        SWARF_REQUIRE(isfinite(box->lo[k]) && isfinite(box->hi[k]), "stock: the box is not finite in %c", "xyz"[k]);
        SWARF_REQUIRE(box->hi[k] > box->lo[k], "stock: the box is empty in %c (%g .. %g mm)", "xyz"[k], box -> lo[k],
                      box -> hi[k]);
        SWARF_REQUIRE(box->lo[k] >= -farthest && box->hi[k] <= farthest,
                      "stock: it reaches from %g to %g mm in %c; -%g to %g mm are possible", box->lo[k], box->hi[k],
                      "xyz"[k], farthest, farthest);
    }
    return SWARF_OK;
}

swarf_status swarf_stock_estimate(const swarf_box *box, double voxel_mm, size_t *bytes)
{
    SWARF_TRY(check_box(box, voxel_mm));
    SWARF_REQUIRE(bytes, "stock: output missing");
    const double wanted = estimate(box, voxel_mm);
    *bytes = wanted < (double)(SIZE_MAX / 2) ? (size_t)wanted : SIZE_MAX;
    return SWARF_OK;
}

swarf_status swarf_stock_layout(const swarf_box *box, const swarf_stock_options *options, double origin[3],
                                int32_t count[3])
{
    SWARF_REQUIRE(options && options->size == sizeof *options, "stock: options missing or of another version");
    const double voxel = options->voxel_mm;
    SWARF_TRY(check_box(box, voxel));
    const double limit = swarf_memory_limit(options->memory_limit), wanted = estimate(box, voxel);
    if (wanted > limit) {
        /* from where it cannot fit, whatever was asked for: 5e-324 * 1.05 is 5e-324 */
        const double edge = fmax(box->hi[0] - box->lo[0], fmax(box->hi[1] - box->lo[1], box->hi[2] - box->lo[2]));
        double fitting = fmax(voxel, 1e-7 * edge);
        while (estimate(box, fitting) > limit && fitting < edge) fitting *= 1.05;
        return swarf_fail(
            SWARF_ERROR_MEMORY,
            "stock: a voxel of %g mm may need %.5g GiB, %.3g GiB may be used; a voxel of %.2g mm or more fits", voxel,
            wanted / 0x1p30, limit / 0x1p30, fitting * 1.05);
    }
    SWARF_REQUIRE(voxel >= least_voxel && voxel <= greatest_voxel, "stock: a voxel of %g mm; %g to %g mm are possible",
                  voxel, least_voxel, greatest_voxel);
    for (int k = 0; k < 3; k++) {
        /* a face within a billionth of a voxel of a whole number is that number */
        const double voxels = ceil((box->hi[k] - box->lo[k]) / voxel - 1e-9);
        const double nodes = ceil((voxels + 2 * PADDING) / SWARF_NODE_DIM);
        SWARF_REQUIRE(nodes <= 8192, "stock: %g voxels along %c are more than a million; use a larger voxel", voxels,
                      "xyz"[k]);
        count[k] = (int32_t)nodes;
        origin[k] = box->lo[k] + (0.5 - PADDING) * voxel;
    }
    return SWARF_OK;
}

swarf_status swarf_stock_wrap(swarf_tree *tree, swarf_stock **out)
{
    swarf_stock *stock = calloc(1, sizeof *stock);
    if (!stock) {
        swarf_tree_destroy(tree);
        return swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory");
    }
    stock->tree = tree;
    *out = stock;
    return SWARF_OK;
}

static swarf_status create_empty(const swarf_box *box, const swarf_stock_options *options, swarf_stock **out)
{
    double origin[3];
    int32_t count[3];
    SWARF_TRY(swarf_stock_layout(box, options, origin, count));
    swarf_tree *tree;
    SWARF_TRY(swarf_tree_create(options->voxel_mm, origin, count, &tree));
    return swarf_stock_wrap(tree, out);
}

swarf_status swarf_stock_create_box(const swarf_box *box, const swarf_stock_options *options, swarf_stock **out)
{
    SWARF_REQUIRE(box && options && out, "stock: box, options or output missing");
    swarf_stock *stock = NULL;
    SWARF_TRY(create_empty(box, options, &stock));
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    stock->untouched = 1;
    for (int k = 0; k < 3; k++) {
        stock->box_half[k] = 0.5 * (box->hi[k] - box->lo[k]) / layout->voxel;
        stock->box_centre[k] = (0.5 * (box->hi[k] + box->lo[k]) - layout->origin[k]) / layout->voxel;
    }
    const swarf_status status = swarf_block_occupy(stock);
    if (status != SWARF_OK) {
        swarf_stock_destroy(stock);
        return status;
    }
    *out = stock;
    return SWARF_OK;
}

swarf_status swarf_stock_copy(swarf_stock *stock, swarf_stock **out)
{
    SWARF_REQUIRE(out, "stock: output missing");
    SWARF_TRY(swarf_stock_enter_write(stock));
    swarf_tree *tree;
    swarf_status status = swarf_tree_copy(stock->tree, &tree);
    swarf_stock *copy = NULL;
    if (status == SWARF_OK) status = swarf_stock_wrap(tree, &copy);
    if (status == SWARF_OK) {
        copy->untouched = stock->untouched;
        memcpy(copy->box_centre, stock->box_centre, sizeof copy->box_centre);
        memcpy(copy->box_half, stock->box_half, sizeof copy->box_half);
        *out = copy;
    }
    swarf_stock_leave(stock);
    return status;
}

void swarf_stock_destroy(swarf_stock *stock)
{
    if (!stock) return;
    swarf_tree_destroy(stock->tree);
    free(stock);
}

swarf_status swarf_stock_enter_write(swarf_stock *stock)
{
    SWARF_REQUIRE(stock, "stock: NULL");
    if (__atomic_exchange_n(&stock->busy, 1, __ATOMIC_ACQUIRE))
        return swarf_fail(SWARF_ERROR_BUSY, "stock: in use by another thread");
    return SWARF_OK;
}

swarf_status swarf_stock_enter_read(swarf_stock *stock)
{
    SWARF_TRY(swarf_stock_enter_write(stock));
    const swarf_status status = swarf_block_finish(stock);
    if (status != SWARF_OK) swarf_stock_leave(stock);
    return status;
}

void swarf_stock_leave(swarf_stock *stock)
{
    __atomic_store_n(&stock->busy, 0, __ATOMIC_RELEASE);
}

uint32_t swarf_stock_generation(const swarf_stock *stock)
{
    return stock ? swarf_tree_get_layout(stock->tree)->generation : 0;
}

uint32_t swarf_stock_stamp(const swarf_stock *stock, size_t node, unsigned cube)
{
    return swarf_tree_get_layout(stock->tree)->stamps[node * SWARF_NODE_CUBES + cube];
}

double swarf_stock_voxel(const swarf_stock *stock)
{
    return stock ? swarf_tree_get_layout(stock->tree)->voxel : 0;
}

/* A round bar, for filling its tree. */
struct bar {
    swarf_tree *tree;
    const swarf_tree_layout *layout;
    double base[3], axis[3], radius, length;
};

static double bar_distance(const struct bar *bar, const double point[3])
{
    double along = 0, square = 0;
    for (int k = 0; k < 3; k++) along += (point[k] - bar->base[k]) * bar->axis[k];
    for (int k = 0; k < 3; k++) {
        const double across = point[k] - bar->base[k] - along * bar->axis[k];
        square += across * across;
    }
    const double side = sqrt(square) - bar->radius, end = fabs(along - 0.5 * bar->length) - 0.5 * bar->length;
    const double most = side > end ? side : end;
    return most <= 0 ? most : hypot(side > 0 ? side : 0, end > 0 ? end : 0);
}

static swarf_status fill_bar_node(void *context, size_t node)
{
    const struct bar *bar = context;
    const swarf_tree_layout *layout = bar->layout;
    const double voxel = layout->voxel, band = layout->background;
    const double reach = band + 3.5 * sqrt(3.0) * voxel; /* from the centre of a leaf to its farthest voxel */
    int32_t origin[3];
    swarf_node_corner(layout, node, origin);
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        int32_t corner[3];
        swarf_leaf_corner(origin, slot, corner);
        double point[3];
        for (int k = 0; k < 3; k++) point[k] = layout->origin[k] + (corner[k] + 3.5) * voxel;
        const double centre = bar_distance(bar, point);
        if (centre > reach) continue;
        if (centre < -reach) {
            swarf_tree_tile(bar->tree, node, slot, 1);
            continue;
        }
        float values[SWARF_LEAF_SIZE];
        for (int i = 0; i < SWARF_LEAF_SIZE; i++) {
            const int at[3] = {i >> 6, i >> 3 & 7, i & 7};
            for (int k = 0; k < 3; k++) point[k] = layout->origin[k] + (corner[k] + at[k]) * voxel;
            const double value = bar_distance(bar, point);
            values[i] = (float)(value > band ? band : value < -band ? -band : value);
        }
        uint64_t mask[8];
        float least;
        swarf_leaf_mask(values, layout->background, mask, &least);
        if (least < SWARF_LEAF_DROP * (float)voxel) SWARF_TRY(swarf_tree_leaf_add(bar->tree, node, slot, values, mask));
    }
    return SWARF_OK;
}

swarf_status swarf_stock_create_cylinder(const double base[3], const double axis[3], double radius,
                                         const swarf_stock_options *options, swarf_stock **out)
{
    SWARF_REQUIRE(base && axis && options && out, "stock: base, axis, options or output missing");
    struct bar bar = {.radius = radius};
    bar.length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    SWARF_REQUIRE(isfinite(radius) && radius > 0, "stock: radius %g mm is not a positive number", radius);
    SWARF_REQUIRE(isfinite(bar.length) && bar.length > 0, "stock: the axis of the cylinder has no length");
    swarf_box box;
    for (int k = 0; k < 3; k++) {
        SWARF_REQUIRE(isfinite(base[k]), "stock: the base of the cylinder is not finite");
        bar.base[k] = base[k];
        bar.axis[k] = axis[k] / bar.length;
        const double across = radius * sqrt(fmax(0, 1 - bar.axis[k] * bar.axis[k]));
        box.lo[k] = fmin(base[k], base[k] + axis[k]) - across;
        box.hi[k] = fmax(base[k], base[k] + axis[k]) + across;
    }
    swarf_stock *stock = NULL;
    SWARF_TRY(create_empty(&box, options, &stock));
    bar.tree = stock->tree;
    bar.layout = swarf_tree_get_layout(stock->tree);
    const swarf_status status = swarf_parallel_for(swarf_layout_nodes(bar.layout), fill_bar_node, &bar, NULL, 0, 1);
    if (status != SWARF_OK) {
        swarf_stock_destroy(stock);
        return status;
    }
    *out = stock;
    return SWARF_OK;
}
