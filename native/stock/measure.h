/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Measures over the leaves of a stock, for callers that are already inside it. */
#ifndef SWARF_STOCK_MEASURE_H
#define SWARF_STOCK_MEASURE_H

#include "stock/stock.h"

/** Volume in mm3 of a stock that has been entered (untouched faces count by their formula): every voxel counts by
 *  clamp(1/2 - d / h, 0, 1), which is exact for planes along the axes and of second order in the voxel h for curved
 *  faces (a cylinder of radius R counts as pi (R^2 + h^2 / 12)) and for edges: at a right-angled convex edge material
 *  is overcounted by up to h^2 / 4 per mm of it, h^2 / 13 on average; concave edges are undercounted as much. */
swarf_status swarf_measure_volume(const swarf_stock *stock, double *out);

/** Box in mm that no material is outside of: exact for a block whose faces have no leaves yet (before it was cut), else
 *  up to a voxel too large; empty (lo > hi) where there is none. The stock has been entered. */
swarf_status swarf_measure_reach(const swarf_stock *stock, swarf_box *out);

/** swarf_stock_sample() of a stock that has been entered, with progress; `out` is written in part when it fails. */
swarf_status swarf_measure_samples(const swarf_stock *stock, const double *points, size_t count,
                                   const swarf_progress *progress, float *out);

#endif
