/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Small arithmetic on leaves and nodes, shared by the files of this room. */
#ifndef SWARF_STOCK_LEAF_H
#define SWARF_STOCK_LEAF_H

#include "stock/vdb_tree.h"

#include <math.h>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

/** A leaf with no value below this many voxels holds no part of a cell that the surface crosses: sqrt(3) is the
 *  diagonal of a voxel, and a margin for rounding. Smaller would tear holes into the surface. */
#define SWARF_LEAF_DROP 1.75f

static inline size_t swarf_layout_nodes(const swarf_tree_layout *layout)
{
    return (size_t)layout->count[0] * (size_t)layout->count[1] * (size_t)layout->count[2];
}

/** Number of a slot, SWARF_NODE_SLOTS to a node, from its place among all of the layout. */
static inline size_t swarf_layout_slot(const swarf_tree_layout *layout, const int32_t at[3])
{
    const size_t node =
        ((size_t)(at[0] >> 4) * (size_t)layout->count[1] + (size_t)(at[1] >> 4)) * (size_t)layout->count[2] +
        (size_t)(at[2] >> 4);
    return node * SWARF_NODE_SLOTS + (size_t)((at[0] & 15) << 8 | (at[1] & 15) << 4 | (at[2] & 15));
}

/** Low corner of a slot in a node whose low corner is `origin`. */
static inline void swarf_leaf_corner(const int32_t origin[3], unsigned slot, int32_t corner[3])
{
    corner[0] = origin[0] + (int32_t)(slot >> 8) * SWARF_LEAF_DIM;
    corner[1] = origin[1] + (int32_t)(slot >> 4 & 15) * SWARF_LEAF_DIM;
    corner[2] = origin[2] + (int32_t)(slot & 15) * SWARF_LEAF_DIM;
}

/** Low corner of a node, in voxels of the layout. */
static inline void swarf_node_corner(const swarf_tree_layout *layout, size_t node, int32_t corner[3])
{
    const size_t rows = (size_t)layout->count[1] * (size_t)layout->count[2];
    corner[0] = (int32_t)(node / rows) * SWARF_NODE_DIM;
    corner[1] = (int32_t)(node % rows / (size_t)layout->count[2]) * SWARF_NODE_DIM;
    corner[2] = (int32_t)(node % (size_t)layout->count[2]) * SWARF_NODE_DIM;
}

/** Bits of the eight values of a row (along z) that are less than a limit. */
static inline unsigned swarf_row_below(const float row[8], float limit)
{
#if defined(__SSE2__) /* the compiler makes a bit at a time of the loop */
    const __m128 most = _mm_set1_ps(limit);
    return (unsigned)_mm_movemask_ps(_mm_cmplt_ps(_mm_loadu_ps(row), most)) |
           (unsigned)_mm_movemask_ps(_mm_cmplt_ps(_mm_loadu_ps(row + 4), most)) << 4;
#else
    unsigned bits = 0;
    for (int z = 0; z < 8; z++) bits |= (unsigned)(row[z] < limit) << z;
    return bits;
#endif
}

/** Bits of the eight values of a row (along z) that are inside the band. */
static inline unsigned swarf_row_mask(const float row[8], float background)
{
#if defined(__SSE2__) /* the compiler makes a bit at a time of the loop, eight times as slow */
    const __m128 sign = _mm_set1_ps(-0.0f), limit = _mm_set1_ps(background);
    const __m128 low = _mm_andnot_ps(sign, _mm_loadu_ps(row)), high = _mm_andnot_ps(sign, _mm_loadu_ps(row + 4));
    return (unsigned)_mm_movemask_ps(_mm_cmplt_ps(low, limit)) | (unsigned)_mm_movemask_ps(_mm_cmplt_ps(high, limit))
                                                                     << 4;
#else
    unsigned bits = 0;
    for (int z = 0; z < 8; z++) bits |= (unsigned)(fabsf(row[z]) < background) << z;
    return bits;
#endif
}

/** Active mask (values inside the band) and least value of a leaf. */
static inline void swarf_leaf_mask(const float values[SWARF_LEAF_SIZE], float background, uint64_t mask[8],
                                   float *least)
{
    float low = values[0];
    for (int x = 0; x < 8; x++) {
        uint64_t word = 0;
        for (int y = 0; y < 8; y++) word |= (uint64_t)swarf_row_mask(values + x * 64 + y * 8, background) << (8 * y);
        mask[x] = word;
    }
    for (int k = 1; k < SWARF_LEAF_SIZE; k++) low = values[k] < low ? values[k] : low;
    *least = low;
}

#endif
