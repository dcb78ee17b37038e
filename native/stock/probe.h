/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Many looks at a stock near each other, by one thread: the leaf of the last look is kept. The stock has been entered
 * and does not change meanwhile, and all its faces have leaves. */
#ifndef SWARF_STOCK_PROBE_H
#define SWARF_STOCK_PROBE_H

#include "stock/stock.h"

#include <math.h>

typedef struct swarf_probe {
    const swarf_stock *stock;
    const swarf_tree_layout *layout;
    double scale;        /**< voxels per mm */
    int32_t leaf[3];     /**< whose values these are, in leaves */
    const float *values; /**< mm; NULL: a tile, or outside the layout */
    float everywhere;    /**< then this */
} swarf_probe;

static inline swarf_probe swarf_probe_begin(const swarf_stock *stock)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    return (swarf_probe){.stock = stock,
                         .layout = layout,
                         .scale = 1 / layout->voxel,
                         .leaf = {-1, -1, -1},
                         .everywhere = layout->background};
}

static inline void swarf_probe_enter(swarf_probe *probe, const int32_t leaf[3])
{
    const swarf_tree_layout *layout = probe->layout;
    int outside = 0;
    for (int k = 0; k < 3; k++) {
        probe->leaf[k] = leaf[k];
        outside |= leaf[k] < 0 || leaf[k] >= layout->count[k] * (SWARF_NODE_DIM / SWARF_LEAF_DIM);
    }
    probe->values = NULL;
    probe->everywhere = layout->background;
    if (outside) return;
    const size_t node =
        ((size_t)(leaf[0] >> 4) * (size_t)layout->count[1] + (size_t)(leaf[1] >> 4)) * (size_t)layout->count[2] +
        (size_t)(leaf[2] >> 4);
    const unsigned slot = (unsigned)(leaf[0] & 15) << 8 | (unsigned)(leaf[1] & 15) << 4 | (unsigned)(leaf[2] & 15);
    if (!(layout->occupied[node * SWARF_NODE_WORDS + (slot >> 6)] >> (slot & 63) & 1)) return;
    probe->values = swarf_tree_leaf(probe->stock->tree, node, slot);
    probe->everywhere = -layout->background;
}

/** Enter the leaf that a voxel of the layout is in. */
static inline void swarf_probe_come(swarf_probe *probe, const int32_t ijk[3])
{
    const int32_t leaf[3] = {ijk[0] >> 3, ijk[1] >> 3, ijk[2] >> 3};
    if (leaf[0] != probe->leaf[0] || leaf[1] != probe->leaf[1] || leaf[2] != probe->leaf[2])
        swarf_probe_enter(probe, leaf);
}

/** Value of a voxel of the layout, mm. */
static inline float swarf_probe_voxel(swarf_probe *probe, const int32_t ijk[3])
{
    swarf_probe_come(probe, ijk);
    return probe->values ? probe->values[(ijk[0] & 7) * 64 + (ijk[1] & 7) * 8 + (ijk[2] & 7)] : probe->everywhere;
}

/** The eight voxels around a point in voxels of the layout, and how far it is on the way from the first to the last. */
static inline void swarf_probe_corners(swarf_probe *probe, const double at[3], float part[3], float value[8])
{
    int32_t corner[3];
    for (int k = 0; k < 3; k++) {
        corner[k] = (int32_t)floor(at[k]);
        part[k] = (float)(at[k] - corner[k]);
    }
    if ((corner[0] & 7) < 7 && (corner[1] & 7) < 7 && (corner[2] & 7) < 7) { /* mostly: all in one leaf */
        swarf_probe_come(probe, corner);
        const float *first =
            probe->values ? probe->values + (corner[0] & 7) * 64 + (corner[1] & 7) * 8 + (corner[2] & 7) : NULL;
        for (int i = 0; i < 8; i++)
            value[i] = first ? first[(i >> 2) * 64 + (i >> 1 & 1) * 8 + (i & 1)] : probe->everywhere;
        return;
    }
    for (int i = 0; i < 8; i++) {
        const int32_t ijk[3] = {corner[0] + (i >> 2), corner[1] + (i >> 1 & 1), corner[2] + (i & 1)};
        value[i] = swarf_probe_voxel(probe, ijk);
    }
}

/** Trilinear value (mm) at a point in voxels of the layout. */
static inline float swarf_probe_point(swarf_probe *probe, const double at[3])
{
    float part[3], value[8];
    swarf_probe_corners(probe, at, part, value);
    for (int i = 0; i < 4; i++) value[i] += part[0] * (value[i + 4] - value[i]);
    for (int i = 0; i < 2; i++) value[i] += part[1] * (value[i + 2] - value[i]);
    return value[0] + part[2] * (value[1] - value[0]);
}

/** The same, and how it grows there along x, y and z, per mm. */
static inline float swarf_probe_slope(swarf_probe *probe, const double at[3], double slope[3])
{
    float part[3], value[8];
    swarf_probe_corners(probe, at, part, value);
    const double x = (double)part[0], y = (double)part[1], z = (double)part[2];
    double face[4], rise[4], line[2], bend[2], grow[2]; /* in the plane of x, along it in y and z */
    for (int i = 0; i < 4; i++) {
        rise[i] = (double)value[i + 4] - (double)value[i];
        face[i] = (double)value[i] + x * rise[i];
    }
    for (int i = 0; i < 2; i++) {
        bend[i] = face[i + 2] - face[i];
        line[i] = face[i] + y * bend[i];
        grow[i] = rise[i] + y * (rise[i + 2] - rise[i]);
    }
    slope[0] = probe->scale * (grow[0] + z * (grow[1] - grow[0]));
    slope[1] = probe->scale * (bend[0] + z * (bend[1] - bend[0]));
    slope[2] = probe->scale * (line[1] - line[0]);
    return (float)(line[0] + z * (line[1] - line[0]));
}

#endif
