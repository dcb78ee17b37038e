/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Short G-code programs in tests: what they give, or how they are refused. They start at (0, 0, 10) with a feed of 100
 * and G98, so that moves are what they seem. */
#ifndef SWARF_TEST_GCODE_H
#define SWARF_TEST_GCODE_H

#include "test.h"

/** Read a text of so many bytes. It lies in a block of its own length: a reader that goes on past the end is seen by
 * the address sanitizer. */
swarf_status gcode_read_bytes(const char *text, size_t length, swarf_program **out);

/** The program of a text, to be released. A failure is counted, and gives an empty one. */
swarf_program *gcode_read_ok(const char *text);

/** The text fails, and the message is or contains `part`. */
void gcode_refuse(const char *text, const char *part);

/** What a program must be, one character a move: r f d t P for the kinds, a for an arc; then ends x y z of each. */
void gcode_expect(const char *text, const char *kinds, ...);

#endif
