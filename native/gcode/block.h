/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Block: one line of RS274/NGC text -> its words, sorted by letter and modal group.
 *
 * Blanks and tabs mean nothing outside comments, not even inside numbers (NIST RS274/NGC version 3, 3.3.2).
 * Numbers have a sign, digits and a point, no exponent. Letters are upper or lower case. Expressions are computed
 * while the line is read; what a line assigns holds from the end of the line on.
 */
#ifndef SWARF_GCODE_BLOCK_H
#define SWARF_GCODE_BLOCK_H

#include "gcode/codes.h"

typedef struct swarf_machine swarf_machine;

/** A word: its value and where it stands in the text. */
typedef struct swarf_word {
    double value; /**< as written; G words times 10, so that G91.1 is 911 */
    const char *at;
    uint32_t length;
    uint32_t whole; /**< a number without a decimal point */
} swarf_word;

enum { SWARF_LETTERS = 27, SWARF_SETTINGS_MAX = 50 };

/** Slot of a letter: A to Z, then '$'. */
static inline int swarf_letter_index(char letter)
{
    return letter == '$' ? 26 : letter - 'A';
}

/** Bit of a letter in the masks of a block. */
#define SWARF_LETTER(letter) (1u << ((letter) - 'A'))

/** "#5 = 3" or "#<name> = 3". */
typedef struct swarf_setting {
    double value;
    int32_t index;    /**< of a numbered parameter, 0: named */
    uint32_t length;  /**< of the name */
    const char *name; /**< in the text */
} swarf_setting;

/** One line. letters[] is valid where `given` has the letter's bit, groups[] where `grouped` has the group's. */
typedef struct swarf_block {
    const char *text;    /**< first byte of the line */
    const char *end;     /**< one past its last */
    const char *flow;    /**< the O of an O word, which is then all there is; else NULL */
    const char *comment; /**< the last comment's text, NULL if there is none */
    const char *comment_end;
    uint32_t given; /**< letters other than G, M and N */
    uint32_t used;  /**< letters that some word of the line asked for */
    uint32_t grouped;
    int percent; /**< the line is a '%' */
    int skipped; /**< the line is deleted, or a command to the control */
    int setting_count;
    swarf_word letters[SWARF_LETTERS];
    swarf_word groups[SWARF_GROUP_COUNT];
    swarf_setting settings[SWARF_SETTINGS_MAX];
} swarf_block;

/** Where errors are. */
typedef struct swarf_place {
    const char *name;
    const char *text; /**< the line */
    uint32_t line;
} swarf_place;

/** Fail with "name:line:column: error: 'word' text"; a NULL word names the line's first column only. */
swarf_status swarf_gcode_fail(const swarf_machine *machine, const swarf_word *word, const char *format, ...)
    SWARF_PRINTF(3, 4);
/** Note a warning at a word. */
swarf_status swarf_gcode_warn(const swarf_machine *machine, const swarf_word *word, const char *format, ...)
    SWARF_PRINTF(3, 4);

/** Split the line text .. end (without its line end) into words and carry out its assignments. */
swarf_status swarf_block_read(swarf_machine *machine, const char *text, const char *end, swarf_block *out);

/** Read a value at *cursor: a number, a parameter, a function or an expression in brackets. */
swarf_status swarf_value_read(const swarf_machine *machine, const char **cursor, const char *end, double *out);
/** Read a plain number; 0 if there is none. *whole: it has no decimal point. */
int swarf_plain_number_read(const char **cursor, const char *end, double *out, uint32_t *whole);

static inline const char *swarf_skip_blanks(const char *at, const char *end)
{
    while (at < end && (*at == ' ' || *at == '\t')) at++;
    return at;
}

static inline int swarf_block_has(const swarf_block *block, char letter)
{
    return (block->given >> swarf_letter_index(letter) & 1u) != 0;
}

/** The word of a letter, now counted as used. */
static inline const swarf_word *swarf_block_take(swarf_block *block, char letter)
{
    block->used |= 1u << swarf_letter_index(letter);
    return &block->letters[swarf_letter_index(letter)];
}

/** The word of a group, NULL if the line has none. */
static inline const swarf_word *swarf_block_group(const swarf_block *block, swarf_group group)
{
    return block->grouped >> group & 1u ? &block->groups[group] : NULL;
}

#endif
