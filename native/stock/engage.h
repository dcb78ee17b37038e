/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Engagement: what of a cutter's flutes lies in material at one moment of a move. */
#ifndef SWARF_STOCK_ENGAGE_H
#define SWARF_STOCK_ENGAGE_H

#include "cutter/cutter.h"
#include "stock/stock.h"
#include "sweep/column.h"

/** Samples along one piece of a meridian, at most. */
enum { SWARF_MERIDIAN_CELLS = 64 };

/** A line or arc of the flutes' meridian, cut into cells: finer where tools cut. */
typedef struct swarf_meridian_piece {
    swarf_profile_piece shape;
    double length, from, turn; /* mm; arcs: angle of the first point and signed angle */
    int cells;
    float edge[SWARF_MERIDIAN_CELLS + 1]; /* 0..1 along the piece */
} swarf_meridian_piece;

/** The outline of the flutes that can meet material. */
typedef struct swarf_meridian {
    const swarf_cutter *cutter;
    swarf_meridian_piece *pieces;
    size_t count;
} swarf_meridian;

swarf_status swarf_meridian_create(const swarf_cutter *cutter, double voxel, swarf_meridian *out);
void swarf_meridian_destroy(swarf_meridian *meridian);

/** Material at a moment: a stock, less what tracks (in its voxels) have cut since. One thread per column. */
typedef struct swarf_material {
    const swarf_stock *stock; /**< entered; all faces have leaves */
    const swarf_body *body;
    const swarf_track *tracks;
    size_t track_count;
    swarf_column *column;
} swarf_material;

/** Lengths in mm, angles in radians; all 0 where nothing is cut. */
typedef struct swarf_engagement {
    double depth, width, angle;
    double chip; /**< greatest n . v, 0..1 */
    double area; /**< integral of n . v, mm2 */
    double side; /**< that of the left half less that of the right one, mm2 */
} swarf_engagement;

/** The flutes with their tip at `tip`, moving along the unit vector `along`. */
swarf_status swarf_engage(const swarf_meridian *meridian, const swarf_material *material, const double tip[3],
                          const double along[3], swarf_engagement *out);

#endif
