/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Words: one line of RS274/NGC text -> its words, sorted by letter and modal group.
 *
 * Blanks and tabs mean nothing outside comments, not even inside numbers (NIST RS274/NGC version 3, 3.3.2).
 * Numbers have a sign, digits and a point, no exponent. Letters are upper or lower case.
 */
#ifndef SWARF_GCODE_WORDS_H
#define SWARF_GCODE_WORDS_H

#include "swarf/base.h"

/** Modal groups: at most one word of each may stand in a line (RS274/NGC table 4). */
typedef enum swarf_group {
    SWARF_GROUP_DWELL = 0,  /**< G4 */
    SWARF_GROUP_MOTION,     /**< G0 to G3, G73, G81 to G85, G89 */
    SWARF_GROUP_CANCEL,     /**< G80, by itself so that a header may say "G0 ... G80" */
    SWARF_GROUP_PLANE,      /**< G17 G18 G19 */
    SWARF_GROUP_DISTANCE,   /**< G90 G91 */
    SWARF_GROUP_ARC_CENTRE, /**< G90.1 G91.1 */
    SWARF_GROUP_FEED_MODE,  /**< G94 */
    SWARF_GROUP_UNITS,      /**< G20 G21 */
    SWARF_GROUP_RADIUS,     /**< G40 */
    SWARF_GROUP_LENGTH,     /**< G43 G49 */
    SWARF_GROUP_RETRACT,    /**< G98 G99 */
    SWARF_GROUP_OFFSET,     /**< G54 */
    SWARF_GROUP_PATH,       /**< G61 G61.1 G64 */
    SWARF_GROUP_STOP,       /**< M0 M1 M2 M30 */
    SWARF_GROUP_TOOL,       /**< M6 */
    SWARF_GROUP_SPINDLE,    /**< M3 M4 M5 */
    SWARF_GROUP_MIST,       /**< M7; M7 and M8 may stand together */
    SWARF_GROUP_FLOOD,      /**< M8 */
    SWARF_GROUP_DRY,        /**< M9 */
    SWARF_GROUP_COUNT
} swarf_group;

/** A word: its value and where it stands in the text. */
typedef struct swarf_word {
    double value; /**< as written; G words times 10, so that G91.1 is 911 */
    const char *at;
    size_t length;
} swarf_word;

/** Bit of a letter in the masks of a block. */
#define SWARF_LETTER(letter) (1u << ((letter) - 'A'))

/** One line. letters[] is valid where `given` has the letter's bit, groups[] where `grouped` has the group's. */
typedef struct swarf_block {
    const char *text; /**< first byte of the line */
    const char *end;  /**< one past its last */
    uint32_t given;   /**< letters other than G, M and N */
    uint32_t used;    /**< letters that some word of the line asked for */
    uint32_t grouped;
    int percent; /**< the line is a '%' */
    swarf_word letters[26];
    swarf_word groups[SWARF_GROUP_COUNT];
} swarf_block;

/** Where errors are: set for the whole text, `line` per line. */
typedef struct swarf_place {
    const char *name;
    uint32_t line;
} swarf_place;

/** Fail with "name:line:column: error: 'word' text"; a NULL word names the line's first column only. */
swarf_status swarf_gcode_fail(const swarf_place *place, const swarf_block *block, const swarf_word *word,
                              const char *format, ...) SWARF_PRINTF(4, 5);

/** Split the line text .. end (without its line end) into words. */
swarf_status swarf_block_read(const swarf_place *place, const char *text, const char *end, swarf_block *out);

static inline int swarf_block_has(const swarf_block *block, char letter)
{
    return (block->given & SWARF_LETTER(letter)) != 0;
}

/** The word of a letter, now counted as used. */
static inline const swarf_word *swarf_block_take(swarf_block *block, char letter)
{
    block->used |= SWARF_LETTER(letter);
    return &block->letters[letter - 'A'];
}

/** The word of a group, NULL if the line has none. */
static inline const swarf_word *swarf_block_group(const swarf_block *block, swarf_group group)
{
    return block->grouped >> group & 1u ? &block->groups[group] : NULL;
}

#endif
