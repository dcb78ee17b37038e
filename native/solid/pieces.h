/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Triangles cut where they meet others, so that each piece bounds the solid all over or nowhere. */
#ifndef SWARF_SOLID_PIECES_H
#define SWARF_SOLID_PIECES_H

#include "solid/crossing.h"

/** A part of a triangle that bounds the solid. */
typedef struct swarf_piece {
    swarf_corners corners;
    uint32_t place; /* of the triangle in the tree of all */
    uint8_t state;  /* SOLID_PIECE or SOLID_SLIVER */
    uint8_t whole;  /* 1: all of the triangle */
} swarf_piece;

typedef struct swarf_pieces {
    swarf_piece *list; /* in order of places */
    size_t count, room;
} swarf_pieces;

/** The bounding pieces of all triangles that meet others. SWARF_ERROR_GEOMETRY: one falls into too many. */
swarf_status swarf_pieces_cut(const swarf_solid *solid, const swarf_crossings *crossings,
                              const swarf_progress *progress, double from, double to, swarf_pieces *out);
void swarf_pieces_free(swarf_pieces *pieces);

/** +1 where the solid lies behind a point of a triangle only, -1 where it lies only before it, 0 where it bounds
 *  nothing; `normal` is the triangle's unit normal. */
int swarf_solid_bounds(const swarf_solid *solid, const double point[3], const double normal[3]);

#endif
