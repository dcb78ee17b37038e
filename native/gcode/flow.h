/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Flow: the O words of one text, found and matched before the first of them is executed.
 *
 * A text is scanned once, line by line, looking only at what a line begins with. Blocks nest; each word of a block
 * knows where the block begins and ends, so that executing one is a jump. Labels of if, while, do and repeat belong
 * to the subroutine they stand in, those of subroutines to the whole program (LinuxCNC's manual, "O Codes").
 */
#ifndef SWARF_GCODE_FLOW_H
#define SWARF_GCODE_FLOW_H

#include "gcode/machine.h"

typedef enum swarf_flow_kind {
    SWARF_FLOW_PROGRAM, /**< a bare number: a program, or a subprogram for M98 */
    SWARF_FLOW_SUB,
    SWARF_FLOW_ENDSUB,
    SWARF_FLOW_RETURN,
    SWARF_FLOW_CALL,
    SWARF_FLOW_IF,
    SWARF_FLOW_ELSEIF,
    SWARF_FLOW_ELSE,
    SWARF_FLOW_ENDIF,
    SWARF_FLOW_WHILE,
    SWARF_FLOW_ENDWHILE,
    SWARF_FLOW_DO,
    SWARF_FLOW_DO_WHILE, /**< the while that ends a do */
    SWARF_FLOW_REPEAT,
    SWARF_FLOW_ENDREPEAT,
    SWARF_FLOW_BREAK,
    SWARF_FLOW_CONTINUE
} swarf_flow_kind;

typedef struct swarf_flow_word {
    const char *line_text; /**< the line */
    const char *word;      /**< the O */
    const char *rest;      /**< behind the keyword */
    const char *line_end;
    char *label; /**< "100" or the name in lower case; NULL: computed when it is called */
    uint32_t line;
    int32_t kind;   /**< swarf_flow_kind */
    int32_t begin;  /**< first word of the block this one belongs to or leaves; its own index where it begins one */
    int32_t end;    /**< last word of that block */
    int32_t branch; /**< of an if or elseif: the next branch or the endif */
} swarf_flow_word;

typedef struct swarf_source {
    char *name;
    char *text;
    size_t length;
    int owned;     /**< the text is freed with the source */
    int32_t index; /**< in the program's list of sources */
    int scanned;
    swarf_flow_word *words;
    size_t count, room;
} swarf_source;

/** Find and match the O words of a text. Errors name their place in it. */
swarf_status swarf_flow_scan(swarf_machine *machine, swarf_source *source);
/** The word that stands at `word` in the text; NULL if the scan found none. */
const swarf_flow_word *swarf_flow_at(const swarf_source *source, const char *word);
/** The subroutine or program of this label, NULL if there is none. */
const swarf_flow_word *swarf_flow_find(const swarf_source *source, swarf_flow_kind kind, const char *label);
void swarf_source_destroy(swarf_source *source);

/** One past the last byte of the line at `at`; CR, LF and CR LF end a line. */
const char *swarf_line_end(const char *at, const char *end);
/** The start of the line after the one that ends at `stop`. */
const char *swarf_line_next(const char *stop, const char *end);

#endif
