/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Whether triangles of a mesh cut each other. */
#ifndef SWARF_TEST_CUTS_H
#define SWARF_TEST_CUTS_H

#include "test.h"

/** Pairs of triangles that cut through each other, counted independently of the library: every pair whose boxes meet,
 *  in doubles, where it is beyond doubt. */
size_t mesh_cuts(const swarf_mesh *mesh);

#endif
