/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Placement: a turn and a shift, as of a part from one set-up to the next. Plain data, any thread. */
#ifndef SWARF_PLACEMENT_H
#define SWARF_PLACEMENT_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Maps a point p (mm) to rotation * p + shift. */
typedef struct swarf_placement {
    double rotation[3][3]; /**< rows; orthonormal, no mirror */
    double shift[3];       /**< mm */
} swarf_placement;

/** Leaves everything where it is. */
SWARF_API swarf_placement swarf_placement_identity(void);

/** The placement of 12 numbers, three rows of rotation and shift, with what they lack of orthonormal (up to 1e-6, as of
 *  printed digits) mended. SWARF_ERROR_ARGUMENT: not finite, shifted by more than 1e6 mm, skewed, scaled, mirrored. */
SWARF_API swarf_status swarf_placement_create(const double rows[12], swarf_placement *out);

/** The placement that takes back what `placement` does. */
SWARF_API swarf_placement swarf_placement_inverse(const swarf_placement *placement);

/** Map a point; `in` may be `out`. */
SWARF_API void swarf_placement_point(const swarf_placement *placement, const double in[3], double out[3]);
/** Turn a direction; `in` may be `out`. */
SWARF_API void swarf_placement_direction(const swarf_placement *placement, const double in[3], double out[3]);

/** 1 when each axis is turned onto an axis: coordinate k of the result is sign[k] (1 or -1) times coordinate axis[k],
 *  shifted. Else 0, outputs untouched. */
SWARF_API int swarf_placement_quarters(const swarf_placement *placement, int axis[3], int sign[3]);

#ifdef __cplusplus
}
#endif
#endif
