/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Programs and stocks that the tests of the history walk through. */
#ifndef SWARF_TEST_WALKS_H
#define SWARF_TEST_WALKS_H

#include "cases.h"

enum { WALK_TOOLS = 4 };

/** A job of random moves in a small block: lines, rapids, arcs, helices, dwells, with tools that change, one of which
 *  (number 9) is not in the table. */
typedef struct walk_job {
    swarf_program *program;
    swarf_tool tools[WALK_TOOLS];
    size_t moves;
    double voxel;
} walk_job;

walk_job walk_job_make(test_random *random, size_t moves);
void walk_job_free(walk_job *job);
swarf_stock *walk_job_stock(const walk_job *job);

/** Hash of a new history that goes to this position at once. */
uint64_t walk_job_fresh(const walk_job *job, size_t move, double fraction);

#endif
