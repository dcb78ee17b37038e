/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Lines where faces meet or one hides the other. */
#ifndef SWARF_RENDER_EDGES_H
#define SWARF_RENDER_EDGES_H

#include "render/picture.h"

/** How much of a crease, 0 .. 1, there is between two sights. */
float swarf_edge_crease(const swarf_sight *a, const swarf_sight *b);
/** What is left of a crease between sights one step farther on either side (NULL: there is none): faces that meet on a
 *  ridge less wide than that make none. */
float swarf_edge_beyond(float crease, const swarf_sight *before, const swarf_sight *beyond);

/** How far `a` stands before `b`, in squares of the grid; 0 when `a` is the farther one, INFINITY before something
 *  else. */
float swarf_edge_height(const swarf_look *look, const swarf_sight *a, const swarf_sight *b);
/** How much of a line there is, 0 .. 1, at a step this high; and of an outline, which is drawn in full wherever it is.
 */
float swarf_edge_step(float height);
float swarf_edge_outline(float height);

/** Darken a colour by an edge of a strength 0 .. 1. */
void swarf_edge_draw(float colour[4], float strength);

/** Allocate `edge`, `outline` and `room` of the canvas, which must be NULL, and fill them from its middles. Who made
 * the canvas frees them, also after a failure. */
swarf_status swarf_canvas_edges(swarf_canvas *canvas, const swarf_progress *progress, double from, double to);

#endif
