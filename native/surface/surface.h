/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Inside of a surface.
 *
 * Parts of moves in the order of the program, 8 bytes each, and a tree of boxes over them: level 0 has one box per
 * part, each further level one per FAN boxes of the one below. Moves that follow each other lie beside each other, so
 * that their order needs no sorting, and "the first n moves" is a prefix of every level. */
#ifndef SWARF_SURFACE_SURFACE_H
#define SWARF_SURFACE_SURFACE_H

#include "surface/trace.h"
#include "swarf/surface.h"

enum { SURFACE_FAN = 8, SURFACE_LEVELS = 12 };

typedef struct swarf_surface_part {
    uint32_t move, part;
} swarf_surface_part;

/** Rounded outwards. */
typedef struct swarf_surface_box {
    float lo[3], hi[3];
} swarf_surface_box;

struct swarf_surface {
    int references; /* only by atomic operations */
    double voxel;
    int block; /* 1: the first shape is a block from lo to hi; 0: `field`, or what is `before` */
    double lo[3], hi[3];
    swarf_stock *field;
    swarf_surface *before; /* NULL: none; of the set-up before, after its first before_moves */
    size_t before_moves;
    swarf_placement placement, back; /* from its coordinates to ours, and back */
    swarf_program *program;
    swarf_body **bodies; /* per tool */
    size_t body_count;
    int32_t *section_body; /* per section of the program: its body, or -1 */
    swarf_surface_part *parts;
    size_t part_count;
    swarf_surface_box *level[SURFACE_LEVELS];
    size_t level_count[SURFACE_LEVELS];
    int levels;
};

/** The same as swarf_surface_refine(), but of a `part` (0 .. 1) of the next move as well, and what comes closer to a
 *  zero than `tolerance_mm` takes its normal and its move from there and goes straight on to where that face would be:
 *  what it costs to look once more is saved. */
swarf_status swarf_surface_refine_to(const swarf_surface *surface, size_t moves, double part,
                                     const swarf_surface_lines *lines, double tolerance_mm,
                                     const swarf_progress *progress, const swarf_surface_feet *out);

/** The same as swarf_surface_gather(), and a `part` (0 .. 1) of the next move's path as well; `t` of points is along
 *  that part. */
swarf_status swarf_surface_gather_part(swarf_surface_near *near, size_t moves, double part, const swarf_box *where);

/** The trace of a part. */
swarf_status swarf_surface_trace(const swarf_surface *surface, size_t part, swarf_trace *out);
/** The body that cuts on a move; NULL: none. */
const swarf_body *swarf_surface_body(const swarf_surface *surface, size_t move);

/** The first shape as a point sees it: value, normal, piece; not where there is a set-up before. */
void swarf_surface_first(const swarf_surface *surface, const double point[3], swarf_surface_point *out);

/** Only collect what may be gathered of boxes within `where`: nothing is seen from there before it is narrowed. */
swarf_status swarf_surface_collect(swarf_surface_near *near, size_t moves, const swarf_box *where);

/** The same as swarf_surface_gather() of a box within the one that `wider` was collected, gathered or narrowed for,
 *  from what that holds; `wider` must stay as it is. */
swarf_status swarf_surface_narrow(swarf_surface_near *near, const swarf_surface_near *wider, const swarf_box *where);

#endif
