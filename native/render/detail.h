/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Detail: n x n sights in those squares of a picture where one does not tell enough. */
#ifndef SWARF_RENDER_DETAIL_H
#define SWARF_RENDER_DETAIL_H

#include "swarf/base.h"

#include <stddef.h>
#include <stdint.h>

struct swarf_canvas;
struct swarf_sight;

/** What is known of the squares in some rows of one canvas; all 0: nothing. */
typedef struct swarf_detail {
    int32_t side;              /**< sights along an edge of a square */
    size_t first, squares;     /**< of the canvas, that have a slot */
    int32_t *slot;             /**< per square: where its sights are, -1: nowhere */
    struct swarf_sight *sight; /**< side * side per slot, rows from the top */
    size_t count, room;        /**< slots */
} swarf_detail;

/** Look at those marked squares in rows top .. end - 1 of which nothing is known yet, options->samples squared times
 *  each. What was known of other rows, or with other sides, is forgotten. After a failure no more is known than before.
 *  All cores. */
swarf_status swarf_detail_add(swarf_detail *detail, const struct swarf_canvas *canvas, const uint8_t *is_marked,
                              int32_t top, int32_t end, const swarf_progress *progress, double from, double to);

/** The sights of a square that was looked at. */
const struct swarf_sight *swarf_detail_of(const swarf_detail *detail, size_t square);

void swarf_detail_forget(swarf_detail *detail);

#endif
