/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cutting with a prepared body, for callers that are already inside the stock. */
#ifndef SWARF_STOCK_CUT_H
#define SWARF_STOCK_CUT_H

#include "stock/stock.h"
#include "stock/undo.h"
#include "sweep/body.h"
#include "sweep/track.h"

/** Cut all paths at once with a body prepared at the stock's voxel size; the stock has been entered for writing.
 *  Progress runs from `from` to `to`. */
swarf_status swarf_cut_body(swarf_stock *stock, const swarf_body *body, const swarf_path *paths, size_t count,
                            const swarf_progress *progress, double from, double to);

/** The same, keeping in `undo` what was there before, one layer per batch that was begun, whatever comes of it. The
 *  faces of the block must have leaves. A cancel takes effect at once, in the middle of a batch: with it, as after any
 *  failure, pop the new layers for a consistent stock. */
swarf_status swarf_cut_recorded(swarf_stock *stock, const swarf_body *body, const swarf_path *paths, size_t count,
                                swarf_undo *undo, const swarf_progress *progress, double from, double to);

/** Cut tracks in the stock's voxels at once; *removed: mm3 that went, the difference of swarf_measure_volume(). */
swarf_status swarf_cut_measured(swarf_stock *stock, const swarf_body *body, const swarf_track *tracks, size_t count,
                                double *removed);

/** How deep (mm, 0: not at all) bodies along these paths go into the stock, which stays as it is, and a voxel where.
 *  Good to a hundredth of a voxel where faces meet, to a tenth elsewhere; no more than three voxels are told.
 *  Deeper places than `enough` are not looked for: what is found then is one of them, which one may depend on threads.
 */
swarf_status swarf_cut_touch(swarf_stock *stock, const swarf_body *body, const swarf_path *paths, size_t count,
                             double enough, double *depth, double point[3]);

#endif
