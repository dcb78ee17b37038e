/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Trace: the flutes of a cutter along one move or a part of it, exactly: in mm and double. */
#ifndef SWARF_SURFACE_TRACE_H
#define SWARF_SURFACE_TRACE_H

#include "swarf/program.h"
#include "sweep/body.h"

/** Level: straight without height, or straight up. Tilted: any other line. Arc: level, of constant radius. */
typedef enum swarf_trace_kind { TRACE_LEVEL, TRACE_TILTED, TRACE_ARC, TRACE_CURVE } swarf_trace_kind;

typedef struct swarf_trace {
    const swarf_body *body;
    int64_t move;
    swarf_trace_kind kind;
    double point[3];          /* lower end of a line; of an arc its height in z */
    double ux, uy, run, rise; /* line: horizontal direction (unit), horizontal and vertical length, both >= 0 */
    double slope;             /* rise / run, 0 where it is vertical */
    double cosine;            /* run by length; 1 where it is vertical */
    double length, along[3];  /* of a line: its length and direction, of no length none */
    double centre[2], radius; /* arc */
    double from, turn;        /* arc: angle of its start, turn > 0 counter-clockwise */
    double t0, t1;            /* of the whole move, at the start and the end of this part */
    double bend;              /* curve: greatest acceleration over this part, in mm per part squared */
    swarf_path path;          /* curve: the whole move */
} swarf_trace;

/** Tangent of a convex function at the point looked at. */
typedef struct swarf_touch_bound {
    double value, slope[3];
} swarf_touch_bound;

/** What a point sees of a trace. Within s of it no value is below raw - s, where that is above 0; raw is not above 0
 *  where `value` is below. */
typedef struct swarf_touch {
    double value, raw;
    double gradient[3]; /* of value, unit */
    double t;           /* of the whole move */
    int32_t piece;
    int32_t exact; /* 1: raw is also an upper bound of the sweep's sign function */
    int32_t bounds;
    swarf_touch_bound bound[2]; /* raw is nowhere below the least of these tangents; none: nothing is known */
} swarf_touch;

/** Parts a move is best looked at in: each turns by a right angle at most. */
uint32_t swarf_trace_parts(const swarf_path *path);

/** Part `part` of `parts` of a move. */
void swarf_trace_make(const swarf_body *body, const swarf_path *path, int64_t move, uint32_t part, uint32_t parts,
                      swarf_trace *out);

/** Box of all that the flutes reach on it. */
void swarf_trace_box(const swarf_trace *trace, swarf_box *out);

/** Sets only raw, exact and the tangents: how near anything may be. The rest of *out means nothing. */
void swarf_trace_bound(const swarf_trace *trace, const double point[3], swarf_touch *out);
/** Sets only value, gradient, t and piece: what is near, where that value is below `most`, else any value that is not.
 *  The rest of *out means nothing. */
void swarf_trace_look(const swarf_trace *trace, const double point[3], double most, swarf_touch *out);

#endif
