/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Program: what the readers of this library use beside the public header. */
#ifndef SWARF_PROGRAM_PRIVATE_H
#define SWARF_PROGRAM_PRIVATE_H

#include "program/arc.h"

/** Append a move that the caller has checked; `arc` (may be NULL) is copied; `value` is the feed or the seconds. */
swarf_status swarf_program_push(swarf_program *program, swarf_move_kind kind, const double end[3], const swarf_arc *arc,
                                double value, uint32_t line);

#endif
