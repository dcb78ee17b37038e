/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Words and numbers of the text formats, whatever the process's locale says of decimal points. */
#ifndef SWARF_MESH_TEXT_H
#define SWARF_MESH_TEXT_H

#include "swarf/base.h"

#include <locale.h>

/** Where a reader stands. The text ends with a 0 byte at `end`. */
typedef struct swarf_text {
    const char *at;
    const char *end;
    const char *name;
    size_t line; /* of `at`, from 1 */
} swarf_text;

/** A run of bytes that are no blanks; length 0: none left (on the line, or at all). */
typedef struct swarf_word {
    const char *at;
    size_t length;
} swarf_word;

/** Next word on this line. */
swarf_word swarf_text_word(swarf_text *text);
/** Next word on this line or a later one. */
swarf_word swarf_text_word_anywhere(swarf_text *text);
/** To the start of the next line; 0 at the end of the text. */
int swarf_text_next_line(swarf_text *text);
int swarf_word_is(swarf_word word, const char *wanted);
/** The whole word as a finite number that a float can hold; 0 when it is none. */
int swarf_word_number(swarf_word word, double *out);
/** The whole word as a whole number within +-2^53. */
int swarf_word_integer(swarf_word word, int64_t *out);
/** Decimal points are points until swarf_text_locale_end(), for this thread alone. */
swarf_status swarf_text_locale_begin(locale_t *kept);
void swarf_text_locale_end(locale_t kept);
/** Three numbers on this line. SWARF_ERROR_FORMAT */
swarf_status swarf_text_point(swarf_text *text, float out[3]);
/** SWARF_ERROR_FORMAT: "name:line: 'word': wanted". */
swarf_status swarf_text_fail(const swarf_text *text, swarf_word word, const char *wanted);

#endif
