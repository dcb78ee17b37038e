/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Closed triangles -> a tree, for this room and the ones that compare with a design. */
#ifndef SWARF_STOCK_VOXELIZE_H
#define SWARF_STOCK_VOXELIZE_H

#include "stock/shells.h"
#include "stock/vdb_tree.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A tree whose voxel centres lie at whole numbers of `voxel` from `origin` (mm), with values up to `half_width` voxels
 *  from the surface, at least 2; beyond 2 each more voxel costs as much again. `from`..`to` is this call's part of the
 *  progress. */
swarf_status swarf_tree_create_shells(const swarf_shells *shells, double voxel, const double origin[3],
                                      double half_width, const swarf_progress *progress, double from, double to,
                                      swarf_tree **out);

#ifdef __cplusplus
}
#endif
#endif
