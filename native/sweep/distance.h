/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The signed distance at one point, for callers that have tracks and a column to work in. */
#ifndef SWARF_SWEEP_DISTANCE_H
#define SWARF_SWEEP_DISTANCE_H

#include "sweep/column.h"

/** Distance from `point` (voxels) to what a body sweeps along `count` tracks, as in a leaf: voxels, beyond the band
 *  three. One thread per column. */
swarf_status swarf_distance_at(const swarf_body *body, const swarf_track *tracks, size_t count, const double point[3],
                               swarf_column *column, float *out);

#endif
