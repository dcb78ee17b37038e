/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Turns and shifts. */
#ifndef SWARF_TEST_PLACEMENTS_H
#define SWARF_TEST_PLACEMENTS_H

#include "test.h"

/** Turned about x, then y, then z by angles (radians), then shifted. */
swarf_placement placement_make(const double angle[3], const double shift[3]);

#endif
