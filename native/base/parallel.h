/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* One thread pool for everything, with progress and cancelling. */
#ifndef SWARF_BASE_PARALLEL_H
#define SWARF_BASE_PARALLEL_H

#include "swarf/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** One piece of work, number `index`; may run on any thread, in any order. */
typedef swarf_status (*swarf_work_fn)(void *context, size_t index);

/** Run `work` for 0 .. count - 1 on swarf_threads() threads. Stops early at the first failure (returned, with its
 *  text) or when `progress` (may be NULL) cancels (SWARF_ERROR_CANCELLED). `from`..`to` is the part of the
 *  progress this call covers. The callback runs on the calling thread only. */
swarf_status swarf_parallel_for(size_t count, swarf_work_fn work, void *context, const swarf_progress *progress,
                                double from, double to);

/** Number of the thread a piece of work runs on, 0 .. swarf_threads() - 1: for scratch memory of its own. */
int swarf_parallel_slot(void);

/** Report progress from the calling thread; SWARF_ERROR_CANCELLED when the caller wants to stop. */
swarf_status swarf_progress_report(const swarf_progress *progress, double fraction);

/** A part of a longer work: its 0 .. 1 is from .. to of the whole. */
typedef struct swarf_progress_share {
    const swarf_progress *whole; /**< not NULL when it is reported to */
    double from, to;
} swarf_progress_share;

/** Progress of the part, for as long as *share lives. */
swarf_progress swarf_progress_part(swarf_progress_share *share);

#ifdef __cplusplus
}
#endif
#endif
