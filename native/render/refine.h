/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sights onto the exact surface: sharp edges, true normals, and which move made what is seen. */
#ifndef SWARF_RENDER_REFINE_H
#define SWARF_RENDER_REFINE_H

#include "render/look.h"

/** Place (-1 .. 1) in the picture of the ray of sight `index`, if `place` is not NULL; returns 0 when that is on the
 *  exact surface already. Many threads at once. */
typedef int (*swarf_place_fn)(const void *context, size_t index, double place[2]);

/** Sights to be moved. */
typedef struct swarf_sights {
    swarf_sight *sight;
    size_t count;
    double close_enough;  /**< a part of a grid square: what is closer to the surface stays; 0: exactly there */
    swarf_place_fn place; /**< of each */
    const void *context;  /**< for place() */
} swarf_sights;

/** Move those of the sights that see the stock along their rays onto the scene's exact surface, where it has one;
 *  nothing without. All cores; not from within a piece of parallel work. */
swarf_status swarf_look_refine(const swarf_look *look, const swarf_sights *sights, const swarf_progress *progress,
                               double from, double to);

#endif
