/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Of the edges that pass cells the vertices nearest to them, one for each edge of each cell: where facets are split a
 * cell has vertices on its faces besides. */
#ifndef SWARF_TEST_PASSED_H
#define SWARF_TEST_PASSED_H

#include <stddef.h>

/** A vertex in a cell that an edge passes. */
typedef struct passed_vertex {
    int cell, edge; /* any numbers by which cells, and the edges of one, are told apart */
    double away;    /* from the edge */
} passed_vertex;

typedef struct passed {
    passed_vertex *vertex;
    size_t count, room;
} passed;

/** Of all edges of all cells. */
typedef struct passed_figures {
    int count;
    double most; /* greatest distance from one to the vertex nearest to it */
    int far;     /* how many are farther than asked about */
} passed_figures;

/** Note a vertex in a list that began as zeros. Exits when there is no memory. */
void passed_add(passed *list, int cell, int edge, double away);

/** What was noted, which is forgotten. */
passed_figures passed_end(passed *list, double far);

#endif
