/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cubes: what rays are traced through.
 *
 * A cell is the cube between 2x2x2 neighbouring voxel centres; cell (i, j, k) has its low corner in voxel (i, j, k) and
 * belongs to that voxel's slot, so that the 512 cells of a slot need values of its own and of its seven upper
 * neighbours. A cube holds the cells of 4x4x4 slots. It copies no values, it points to them, and keeps a bit for each
 * cell that stops a ray: one with a corner in material. Of those the cells with other corners outside have the surface
 * in them; the solid ones behind are the net that holds a ray which rounding led past the surface at a seam.
 *
 *   block    a bit for each of the 8^3 blocks of 4^3 cells with such a cell
 *   place    where the slots that have such blocks are in `slots`
 *   slots    128 bytes for each of those
 *
 * Coordinates are voxels of the stock's layout, or, where it says so, of the cube.
 */
#ifndef SWARF_RENDER_CUBE_H
#define SWARF_RENDER_CUBE_H

#include "render/ray_kernel.h"
#include "stock/vdb_tree.h"

#ifdef __cplusplus
extern "C" {
#endif

_Static_assert((int)SWARF_CUBE_CELLS == (int)SWARF_CUBE_SLOTS * (int)SWARF_LEAF_DIM, "the kernels know cubes by cells");

/** What cubes see of tiles: 512 equal values each. */
typedef struct swarf_cube_tiles {
    float outside[SWARF_LEAF_SIZE], inside[SWARF_LEAF_SIZE];
} swarf_cube_tiles;

/** Bring the cube with low corner `cube->corner` up to date with a tree; what it held of slots is reused or freed.
 *  SWARF_ERROR_MEMORY leaves it without slots. */
swarf_status swarf_cube_make(swarf_cube *cube, const swarf_tree *tree, const swarf_cube_tiles *tiles);

/** Free the slots; the cube stops no ray. */
void swarf_cube_free(swarf_cube *cube);

#ifdef __cplusplus
}
#endif
#endif
