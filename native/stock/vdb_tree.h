/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The OpenVDB tree behind a C face, laid out for cutting.
 *
 *   grid of nodes: 128^3 voxels each = 16^3 slots of 8^3 voxels; a slot is a leaf (512 floats), or a tile that
 *   is outside (+background) or inside (-background).
 *   node (nx, ny, nz) has the number (nx * count[1] + ny) * count[2] + nz; slot (sx, sy, sz) of it the number
 *   sx * 256 + sy * 16 + sz; value (x, y, z) of a leaf the place x * 64 + y * 8 + z.
 *   `occupied` has 64 words per node, one bit per slot: 0 where the slot is an outside tile.
 *   `stamps` has 64 numbers per node, one per cube of 4x4x4 slots, (x * 4 + y) * 4 + z: the generation in which a slot
 *   of it last changed. Whoever shows the stock remembers the generation it saw and looks only at later stamps.
 *
 * Index space starts at the low corner of the first node. Different slots of one node may be changed by different
 * threads only when they lie in different columns of 4x4 slots (a mask word holds 4 rows of y at one x).
 */
#ifndef SWARF_STOCK_VDB_TREE_H
#define SWARF_STOCK_VDB_TREE_H

#include "sweep/body.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    SWARF_LEAF_DIM = 8,
    SWARF_LEAF_SIZE = 512,
    SWARF_NODE_DIM = 128,
    SWARF_NODE_SLOTS = 4096,
    SWARF_NODE_WORDS = 64,
    SWARF_CUBE_SLOTS = 4, /* along each edge of a cube that has one stamp */
    SWARF_NODE_CUBES = 64
};

typedef struct swarf_tree swarf_tree;

/** What the cutting loop works on; owned by the tree. */
typedef struct swarf_tree_layout {
    double voxel;
    double origin[3]; /**< world position (mm) of the centre of voxel (0, 0, 0) of this layout */
    int32_t count[3]; /**< nodes along x, y, z */
    float background; /**< SWARF_HALF_WIDTH * voxel */
    uint64_t *occupied;
    uint32_t *stamps;
    uint32_t generation; /**< what changes now are stamped with; at least 1 */
} swarf_tree_layout;

/** A tree of outside tiles only, all nodes made. */
swarf_status swarf_tree_create(double voxel, const double origin[3], const int32_t count[3], swarf_tree **out);
swarf_status swarf_tree_copy(const swarf_tree *tree, swarf_tree **out);
void swarf_tree_destroy(swarf_tree *tree);
const swarf_tree_layout *swarf_tree_get_layout(const swarf_tree *tree);

/** Stamp what changes from here on with the next generation. */
void swarf_tree_next_generation(swarf_tree *tree);
/** Stamp all cubes with `generation` and make it the tree's own: of a tree that takes another one's place. */
void swarf_tree_stamp_all(swarf_tree *tree, uint32_t generation);

/** Values of the leaf in a slot, NULL where it is a tile; who changes them calls swarf_tree_leaf_mask() then. */
float *swarf_tree_leaf(const swarf_tree *tree, size_t node, unsigned slot);
/** Have the processor fetch what swarf_tree_leaf() will read. */
void swarf_tree_leaf_fetch(const swarf_tree *tree, size_t node, unsigned slot);
/** Of a slot that is a tile: 1 inside, 0 outside. */
int swarf_tree_tile_inside(const swarf_tree *tree, size_t node, unsigned slot);
/** Make a slot a leaf with these 512 values and active mask (8 words), and occupied. May fail on memory. */
swarf_status swarf_tree_leaf_add(swarf_tree *tree, size_t node, unsigned slot, const float *values,
                                 const uint64_t mask[8]);
/** Replace the active mask of an existing leaf, after its values. */
void swarf_tree_leaf_mask(swarf_tree *tree, size_t node, unsigned slot, const uint64_t mask[8]);
/** Make a slot an outside (+background, not occupied) or inside tile (occupied), dropping its leaf. */
void swarf_tree_tile(swarf_tree *tree, size_t node, unsigned slot, int inside);

/** Make the slots lo .. hi (0 .. 15 along each axis) of a node without leaves inside tiles. */
void swarf_tree_fill(swarf_tree *tree, size_t node, const int lo[3], const int hi[3]);

/** Leaves in the tree, and bytes it holds. */
void swarf_tree_size(const swarf_tree *tree, size_t *leaves, size_t *bytes);

#ifdef __cplusplus
}
#endif
#endif
