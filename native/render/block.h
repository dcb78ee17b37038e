/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Blocks: what rays are traced through.
 *
 * A cell is the cube between 2x2x2 neighbouring voxel centres; cell (i, j, k) has its low corner in voxel (i, j, k)
 * and belongs to that voxel's slot, so that the 512 cells of a slot need a 9x9x9 apron of values: its own and those
 * of its seven upper neighbours. A block is a slot with at least one cell whose corners differ in sign. It copies no
 * values: it points to the eight slots' (a tile's: 512 equal ones) and keeps a bit per cell that the surface crosses.
 * Coordinates are voxels of the stock's layout.
 */
#ifndef SWARF_RENDER_BLOCK_H
#define SWARF_RENDER_BLOCK_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** 152 bytes. */
typedef struct swarf_block {
    const float *values[8]; /**< of this slot and its upper neighbours; number bits 4, 2, 1: one up in x, y, z */
    uint64_t crossing[8];   /**< word x, bit y * 8 + z */
    int32_t ijk[3];         /**< of the slot's low corner */
    uint8_t lo[3], hi[3];   /**< the crossed cells lie in lo .. hi - 1 */
} swarf_block;

/** A ray on its way; `direction` has length 1. */
typedef struct swarf_ray {
    double origin[3];
    double direction[3];
    double inverse[3]; /**< 1 / direction */
    double t;          /**< of the first hit so far, INFINITY before */
    uint32_t block;    /**< number of the block hit */
    float normal[3];
} swarf_ray;

/** Find the cells of a block that the surface crosses; `values` and `ijk` are set. 0 when there are none. */
int swarf_block_make(swarf_block *block);

/** Where the ray first enters the material in this block. On a hit before ray->t (at the same t: in the block of
 *  lower number, so that the order of visits does not matter) updates the ray and returns 1. */
int swarf_block_intersect(const swarf_block *block, uint32_t number, swarf_ray *ray);

/** Trilinear value in a cell with corner values `corner` (number bits 4, 2, 1: x, y, z) at `p`, 0 .. 1 each. */
double swarf_cell_value(const float corner[8], const double p[3]);

#ifdef __cplusplus
}
#endif
#endif
