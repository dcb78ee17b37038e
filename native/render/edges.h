/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Lines where faces meet or one hides the other: what is asked of each pair of sights, and so is inline. */
#ifndef SWARF_RENDER_EDGES_H
#define SWARF_RENDER_EDGES_H

#include "render/picture.h"

#include <math.h>

static inline float swarf_edge_between(float from, float to, float x)
{
    const float part = (x - from) / (to - from), t = part > 0 ? (part < 1 ? part : 1) : 0;
    return t * t * (3 - 2 * t);
}

/** How much of a crease, 0 .. 1, there is between two sights. It is drawn from 18 degrees on, in full from 40: the
 *  facets that a tool leaves on curved surfaces are not. */
static inline float swarf_edge_crease(const swarf_sight *a, const swarf_sight *b)
{
    static const float cosine_least = 0.951f, cosine_full = 0.766f;
    const float *m = a->normal, *n = b->normal, cosine = m[0] * n[0] + m[1] * n[1] + m[2] * n[2];
    if (!(cosine < cosine_least) || a->seen == SWARF_SEEN_NOTHING || a->seen != b->seen) return 0;
    return swarf_edge_between(cosine_least, cosine_full, cosine);
}

/** What is left of a crease between sights one step farther on either side (NULL: there is none): faces that meet on a
 *  ridge less wide than that make none. */
static inline float swarf_edge_beyond(float crease, const swarf_sight *before, const swarf_sight *beyond)
{
    if (!before || !beyond || before->seen != beyond->seen) return crease;
    const float other = swarf_edge_crease(before, beyond);
    return other < crease ? other : crease;
}

/** How far `a` stands before `b`, in squares of the grid, one of which is `footprint` mm there; 0 when `a` is the
 *  farther one, INFINITY before something else. The face of `b` tells. That of `a` does not: where a rounding turns
 *  away from the eye, all that it hides lies close to the plane of its last sights. */
static inline float swarf_edge_height(float footprint, const swarf_sight *a, const swarf_sight *b)
{
    if (a->seen == SWARF_SEEN_NOTHING || a->distance > b->distance) return 0;
    if (a->seen != b->seen) return INFINITY;
    const float *p = a->point, *q = b->point, *n = b->normal;
    return fabsf((p[0] - q[0]) * n[0] + (p[1] - q[1]) * n[1] + (p[2] - q[2]) * n[2]) / footprint;
}

/** How much of a line there is, 0 .. 1, at a step this high: one thing hides another when it stands this many squares
 *  before it, from, and in full. */
static inline float swarf_edge_step(float height)
{
    return swarf_edge_between(0.9f, 2.0f, height);
}

/** The same of an outline, which is drawn in full wherever it is: from these heights on, in squares, the line is that
 *  of a part and not of one of many steps. */
static inline float swarf_edge_outline(float height)
{
    return swarf_edge_between(5, 15, height);
}

/** Darken a colour by an edge of a strength 0 .. 1. */
void swarf_edge_draw(float colour[4], float strength);

/** Make the `mark` of the canvas, which must be NULL, from its middles. All cores. */
swarf_status swarf_canvas_edges(swarf_canvas *canvas, const swarf_progress *progress, double from, double to);

#endif
