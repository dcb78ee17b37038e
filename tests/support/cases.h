/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cutters and motions that the sweep, cut and kernel tests go through. */
#ifndef SWARF_TEST_CASES_H
#define SWARF_TEST_CASES_H

#include "oracle.h"

enum { CASE_CUTTERS = 14, CASE_MOTIONS = 17 };

/** Cutter number `index`, about 4 mm in diameter; `name` gets a static text. Exits when it cannot be made. */
swarf_cutter *case_cutter(int index, const char **name);

/** Motion number `index`; the last three are random. `curved` is 1 for helices and arcs out of the XY plane, which the
 *  sweep may follow by chords within SWARF_SWEEP_BOUND. */
swarf_path case_motion(int index, test_random *random, const char **name, int *curved);

#endif
