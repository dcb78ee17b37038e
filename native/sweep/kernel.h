/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The inner loops of cutting, one table per instruction set. All variants do the same operations on the same sixteen
 * lanes in the same order, without contraction, so that their results are the same bits. */
#ifndef SWARF_SWEEP_KERNEL_H
#define SWARF_SWEEP_KERNEL_H

#include "sweep/body.h"
#include "sweep/column.h"

/** A block of voxel centres: middle (relative to the column's) and half extents. */
typedef struct swarf_block {
    float x, y, z;
    float half, half_z;
} swarf_block;

/** A leaf of a block: per axis the signed distance to the slab between the two faces, in voxels. */
typedef struct swarf_slabs {
    float distance[3][8];
} swarf_slabs;

/** A leaf being cut. */
typedef struct swarf_leaf_cut {
    float x, y, z;     /* low corner, relative to the column's middle */
    float voxel;       /* mm */
    float background;  /* mm */
    int solid;         /* 1: all values are -background and `values` is not read */
    float *values;     /* 512 values in mm, x * 64 + y * 8 + z; changed in place */
    uint64_t mask[8];  /* out: values within the band */
    float least, most; /* out: least and greatest value */
} swarf_leaf_cut;

typedef struct swarf_kernel {
    /** For each of up to BLOCKS_AT_ONCE blocks of one size, keep of the tracks `in` those that can change a value in
     *  it: out[b] and out_count[b]. Returns the bits of the blocks that are all cut away (their lists mean nothing). */
    unsigned (*cull)(const swarf_body *body, const swarf_column *column, const int32_t *in, size_t count,
                     const swarf_block *blocks, size_t block_count, int32_t *const *out, size_t *out_count);
    /** values = max(values, -sweep) over all tracks of the list; 0: nothing was within reach, outputs are not set. */
    int (*cut)(const swarf_body *body, const swarf_column *column, const int32_t *list, size_t count,
               swarf_leaf_cut *leaf);
    /** Signed distance in voxels from the column's middle to the tracks of a list, as in a leaf. */
    float (*distance)(const swarf_body *body, const swarf_column *column, const int32_t *list, size_t count);
    /** Signed distances (mm, clamped to the background) to a block at the 512 voxels of a leaf, the mask of those in
     *  the band, and the least. */
    void (*block)(const swarf_slabs *slabs, float voxel, float background, float values[512], uint64_t mask[8],
                  float *least);
    /** Material in a leaf, in voxels: the sum of clamp(1/2 - value * scale, 0, 1), scale being 1 / voxel. */
    double (*occupancy)(const float values[512], float scale);
    /** The mask of those values of a leaf that are in the band. */
    void (*band)(const float values[512], float background, uint64_t mask[8]);
    /** Rows (x * 8 + y, of eight values along z) that are not the same bits in both leaves. */
    uint64_t (*rows_changed)(const float before[512], const float after[512]);
    /** Rows, but for the first, that are the same bits as the one before. */
    uint64_t (*rows_repeated)(const float values[512]);
} swarf_kernel;

/** The kernels of swarf_isa_current(). */
const swarf_kernel *swarf_kernel_current(void);

extern const swarf_kernel swarf_kernel_scalar;
#if defined(SWARF_HAVE_X86)
extern const swarf_kernel swarf_kernel_avx2;
extern const swarf_kernel swarf_kernel_avx512;
#endif

#endif
