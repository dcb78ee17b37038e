/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Load: what each move asks of its tool, seen against the stock as it is just before the move takes its share.
 *
 * At moments along a move the part of the flutes' surface that faces the motion is held against the material there.
 * What of it lies in material gives, with n the outward normal and v the direction of the motion:
 *
 *   - depth: its extent along the tool's axis (of a plunge with a flat end: 0)
 *   - width: its extent across the motion, level; of a plunge the greater extent of both level axes
 *   - angle: the turn of the tool spent in material, at the height where that is most: of the half turn that faces the
 *     motion, of plunges of the whole turn
 *   - chip: feed per tooth times the greatest n . v
 *   - rate: the integral of n . v over it, times the feed
 *
 * Rapids have no loads, only the volume that they remove. Between samples the ends of what lies in material are found
 * by bisection, to a hundredth of a voxel and as well as the stock is known there (faces: a hundredth of a voxel,
 * beside edges up to half of one). Seen is what is deeper than 0.35 voxel at a sample; these are a sixty-fourth of the
 * turn apart (of plunges a thirty-second), along the axis a voxel at the tip, a twenty-fourth of the flutes' length
 * farther up. So layers under flat ends need 0.85 voxel, those on walls up to 1.2 or 9 degrees. Moments are two voxels
 * or a quarter of the tool's radius apart; moves shorter than that share them.
 */
#ifndef SWARF_LOAD_H
#define SWARF_LOAD_H

#include "stock.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum swarf_load_kind {
    SWARF_LOAD_RATE = 0,  /**< mean over the move, mm3/s at its feed; 0 where there is no feed */
    SWARF_LOAD_PEAK_RATE, /**< greatest, mm3/s */
    SWARF_LOAD_DEPTH,     /**< greatest, mm */
    SWARF_LOAD_WIDTH,     /**< greatest, mm */
    SWARF_LOAD_ANGLE,     /**< greatest, degrees */
    SWARF_LOAD_CHIP,      /**< greatest, mm; 0 where feed, speed or number of teeth are not known */
    SWARF_LOAD_CLIMB,     /**< 1: climb milling, -1: conventional, 0: as much of both, or nothing is cut */
    SWARF_LOAD_AT,        /**< 0..1 along the move: where the angle is greatest */
    SWARF_LOAD_COUNT
} swarf_load_kind;

/** Loads of the moves that were played. Owned by what made them; immutable. */
typedef struct swarf_loads swarf_loads;

/** One number for each move played; NULL and 0 for NULL. */
SWARF_API const float *swarf_loads_get(const swarf_loads *loads, swarf_load_kind kind, size_t *count);
/** mm3 that each move removed: their sum is that of the stock's volume. Moves that share a moment share what they
 *  removed together by what their samples tell. */
SWARF_API const double *swarf_loads_volume(const swarf_loads *loads, size_t *count);
/** "rate", "depth" ... */
SWARF_API const char *swarf_load_name(swarf_load_kind kind);

#ifdef __cplusplus
}
#endif
#endif
