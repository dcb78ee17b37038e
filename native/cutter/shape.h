/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Names and letters of the common shapes and their dimensions: the one table that text and errors use. */
#ifndef SWARF_CUTTER_SHAPE_H
#define SWARF_CUTTER_SHAPE_H

#include "swarf/cutter.h"

typedef struct swarf_dimension {
    const char *letters; /* "d", "sl" ... as in "flat:d=3" */
    size_t offset;       /* of the double in swarf_dimensions */
    const char *words;
} swarf_dimension;
extern const swarf_dimension swarf_dimension_table[];
extern const size_t swarf_dimension_count;

typedef struct swarf_shape_entry {
    const char *name;
    const char *needed; /* letters separated by blanks */
    const char *known;
} swarf_shape_entry;
extern const swarf_shape_entry swarf_shape_table[SWARF_SHAPE_COUNT];

#endif
