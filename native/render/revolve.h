/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Rays onto a cutter: the exact body of revolution of its meridian. */
#ifndef SWARF_RENDER_REVOLVE_H
#define SWARF_RENDER_REVOLVE_H

#include "swarf/cutter.h"

typedef struct swarf_revolve swarf_revolve;

/** A cutter with its tip at `tip`, its axis along +z. */
swarf_status swarf_revolve_create(const swarf_cutter *cutter, const double tip[3], swarf_revolve **out);
/** NULL is legal. */
void swarf_revolve_destroy(swarf_revolve *revolve);
void swarf_revolve_box(const swarf_revolve *revolve, swarf_box *out);

/** Distance along a ray (unit direction) from outside to the body if that is below `reach`: 1, its outward normal and
 *  the kind of the part there; else 0. Good to 1e-6 of the cutter's size. Many threads at once. */
int swarf_revolve_trace(const swarf_revolve *revolve, const double origin[3], const double direction[3], double reach,
                        double *distance, float normal[3], swarf_part_kind *kind);

#endif
