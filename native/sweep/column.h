/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Column: the tracks that concern one vertical column of voxels, one array per quantity, in floats relative to the
 * column's middle. Every track is re-based in double to its point nearest to the middle, so that floats are good to
 * a thousandth of a voxel however long the move. Kernels read the arrays by lists of numbers. */
#ifndef SWARF_SWEEP_COLUMN_H
#define SWARF_SWEEP_COLUMN_H

#include "sweep/body.h"
#include "sweep/track.h"

/** Arrays of a column. A line is base + t * u (t from S0 to S1, horizontal length), rising by M per unit; D, T0 and T1
 *  the same by length in space. Level arcs use the names in brackets. */
enum swarf_column_field {
    COLUMN_X,
    COLUMN_Y, /* base [nearest point on the circle] */
    COLUMN_Z, /* height of the cutter's tip there; of a vertical line its low end */
    COLUMN_UX,
    COLUMN_UY, /* horizontal direction [outward normal of the circle at the base] */
    COLUMN_S0,
    COLUMN_S1, /* [S0: 1 / radius] */
    COLUMN_M,
    COLUMN_IM,   /* slope, 1 / sqrt(1 + slope^2) [0, 1] */
    COLUMN_RISE, /* vertical line: its length; others 0 */
    COLUMN_DX,
    COLUMN_DY,
    COLUMN_DZ,
    COLUMN_T0,
    COLUMN_T1,
    COLUMN_AX,
    COLUMN_AY,
    COLUMN_BX,
    COLUMN_BY, /* [ends of the arc] */
    COLUMN_FIELDS,
    /* arcs: a point is within the arc's angle where A + NA x (p - base) >= 0 and / or B - NB x (p - base) >= 0 */
    COLUMN_A = COLUMN_T0,
    COLUMN_B = COLUMN_T1,
    COLUMN_NAX = COLUMN_DX,
    COLUMN_NAY = COLUMN_DY,
    COLUMN_NBX = COLUMN_DZ,
    COLUMN_NBY = COLUMN_S1
};

/** What a track is, for the kernels. */
enum { TRACK_LEVEL = 0, TRACK_TILTED = 1, TRACK_ARC = 2, TRACK_ARC_MAJOR = 4, TRACK_ARC_FULL = 8 };

/** Blocks that share a list of tracks are culled together: the eight parts of a cube, the four groups of a leaf. */
enum { BLOCKS_AT_ONCE = 8 };

/** Lists of a column: all tracks, a cube of 32^3 voxels, its eight parts, their eight parts, a leaf's four groups. */
enum {
    LIST_ALL = 0,
    LIST_CUBE = 1,
    LIST_PARTS = 2,
    LIST_LEAVES = LIST_PARTS + BLOCKS_AT_ONCE,
    LIST_GROUPS = LIST_LEAVES + BLOCKS_AT_ONCE,
    COLUMN_LISTS = LIST_GROUPS + 4
};

/** Kernels read and write lists in whole lanes: arrays have room for this many more. */
enum { COLUMN_SLACK = 16 };

typedef struct swarf_column {
    float *field[COLUMN_FIELDS];
    uint8_t *kind;
    int32_t *list[COLUMN_LISTS];  /* numbers of tracks: all, and what is left of them at each level of refinement */
    float *bound[BLOCKS_AT_ONCE]; /* lower bounds beside the lists being made */
    float *floor[BLOCKS_AT_ONCE]; /* least heights of the bottom, likewise */
    size_t room, count;
    double middle[3]; /* what the floats are relative to */
    int arcs;         /* 1 when any track is an arc */
} swarf_column;

/** Fill from tracks `numbers` (NULL: 0 .. count - 1). On SWARF_ERROR_MEMORY the column is empty. */
swarf_status swarf_column_fill(swarf_column *column, const double middle[3], const swarf_track *tracks,
                               const int32_t *numbers, size_t count);
void swarf_column_free(swarf_column *column);

#endif
