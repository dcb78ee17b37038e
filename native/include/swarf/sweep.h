/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sweep: the signed distance from a point to all the space a cutter part passes through on one path.
 *
 * The value is negative inside. Its zero set is exact (lines and planar arcs in closed form or by a
 * convex bracketed search closed to float precision; helices and arcs in the other planes within
 * SWARF_SWEEP_BOUND voxels) and on smooth parts of the surface its gradient has length 1, so that it
 * is the Euclidean distance to first order.
 */
#ifndef SWARF_SWEEP_H
#define SWARF_SWEEP_H

#include "cutter.h"
#include "program.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Largest error, in voxels, of a path that the kernels replace by chords (helices, ZX and YZ arcs). */
#define SWARF_SWEEP_BOUND 0.01

/** Signed distances in mm, by the current kernel, from `count` points (3 doubles each) to the sweep of the
 *  parts of `kind` along `path`, evaluated as in a stock of voxel size `voxel_mm`. Values beyond three
 *  voxels are only guaranteed to have the right sign and a magnitude of at least three voxels.
 *  SWARF_ERROR_ARGUMENT: NULL, not finite, voxel not positive. Any thread. */
SWARF_API swarf_status swarf_sweep_distance(const swarf_cutter *cutter, swarf_part_kind kind, const swarf_path *path,
                                            double voxel_mm, const double *points, size_t count, float *out);

#ifdef __cplusplus
}
#endif
#endif
