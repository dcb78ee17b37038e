/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* History: a stock that can stand at any move of a program, forward by cutting, back by undoing.
 *
 * A position is the number of moves that are done, and the part of the next one that is. Moves are cut in batches whose
 * limits depend on the program and the position only: powers of 8 counted from where the tool was last changed, as
 * large as fit, at most 4096. So a position has one content, to the bit, whichever way it is reached and whatever the
 * number of threads: swarf_stock_hash() is that of a new history that goes there at once. A stock that is cut in other
 * batches (swarf_stock_simulate()) has the same surface, but values beside it may differ.
 *
 * What each batch changes is kept to be put back. When the memory limit is reached, batches that lie far back are kept
 * as one, then forgotten; keyframes, copies of the stock at some positions, then stand in, and at last the copy of the
 * first stock, from which everything is cut again.
 *
 * One thread per object; inside, all cores work.
 */
#ifndef SWARF_HISTORY_H
#define SWARF_HISTORY_H

#include "stock.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_history swarf_history;

typedef struct swarf_history_options {
    size_t size; /**< sizeof(swarf_history_options) */
    /** Bytes for what is kept, besides the first stock's copy; 0: a quarter of what is free now. */
    size_t memory_limit;
} swarf_history_options;

/** No limit given. */
SWARF_API swarf_history_options swarf_history_options_default(void);

/** What a history holds. */
typedef struct swarf_history_held {
    size_t bytes;       /**< all together; records and keyframes of it are within the limit between moves */
    size_t first_bytes; /**< the first stock's copy */
    size_t record_bytes, keyframe_bytes;
    size_t record_count, keyframe_count;
    size_t oldest; /**< back to this position nothing needs to be cut again but what one record spans */
} swarf_history_held;

/** A history that stands before the first move of a program (kept) with the tools for it (bodies of their flutes are
 *  made). The stock stays the caller's: it must live as long as the history, may be read between calls, and whatever
 *  else changes it ends the history (see swarf_history_seek()). Moves whose tool is not in `tools` or has no flutes,
 *  and moves of turned axes, cut nothing. `options` may be NULL. SWARF_ERROR_ARGUMENT, SWARF_ERROR_MEMORY,
 *  SWARF_ERROR_BUSY: the stock is in use by another thread. */
SWARF_API swarf_status swarf_history_create(swarf_stock *stock, const swarf_program *program, const swarf_tool *tools,
                                            size_t tool_count, const swarf_history_options *options,
                                            swarf_history **out);
/** The stock stays as it stands. NULL is legal. */
SWARF_API void swarf_history_destroy(swarf_history *history);

/** Make the stock what it is after the first `move` moves (0 .. all of them) and the part `fraction` (0 .. 1) of the
 *  next one's path. 1 is the position after that move. Stamps (swarf_stock_changed()) tell what changed either way.
 *  SWARF_ERROR_ARGUMENT: there is no such position; or the stock was changed by someone else, which a history cannot go
 *  on from. SWARF_ERROR_CANCELLED: at once; the stock stands between moves where swarf_history_move() says.
 *  SWARF_ERROR_MEMORY: the same, except when it ran out while putting back: then the stock holds nothing to be read
 *  until a later call succeeds. */
SWARF_API swarf_status swarf_history_seek(swarf_history *history, size_t move, double fraction,
                                          const swarf_progress *progress);
/** Go on towards that position by one batch of at most 4096 moves, or by putting back all that has to be; *arrived is
 *  set to whether the stock is there. For who shows the way there, or has other things to do in between. */
SWARF_API swarf_status swarf_history_approach(swarf_history *history, size_t move, double fraction,
                                              const swarf_progress *progress, int *arrived);

/** Moves that are done; the number of all moves at the end. */
SWARF_API size_t swarf_history_move(const swarf_history *history);
/** Part of the next move that is done, 0 <= fraction < 1. */
SWARF_API double swarf_history_fraction(const swarf_history *history);
SWARF_API swarf_history_held swarf_history_get_held(const swarf_history *history);

#ifdef __cplusplus
}
#endif
#endif
