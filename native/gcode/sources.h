/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sources: the program's text and the files of subroutines it called, and where a subroutine is among them. */
#ifndef SWARF_GCODE_SOURCES_H
#define SWARF_GCODE_SOURCES_H

#include "gcode/flow.h"

typedef struct swarf_sources {
    swarf_source **list;
    size_t count, room;
    const char *search; /**< folders, ':' between them; NULL: none */
    const char *folder; /**< of the program's file; NULL: none */
} swarf_sources;

void swarf_sources_destroy(swarf_sources *sources);
/** Add a text; it is freed with the sources when `owned`, also on failure. */
swarf_status swarf_sources_add(swarf_sources *sources, swarf_program *program, const char *name, char *text,
                               size_t length, int owned, swarf_source **out);
/** Where `label` is: in the text `here`, in another one that is there, else in a file of its name. *out is NULL if it
 *  is nowhere. */
swarf_status swarf_sources_find(swarf_sources *sources, swarf_machine *machine, swarf_source *here,
                                swarf_flow_kind kind, const char *label, swarf_source **source,
                                const swarf_flow_word **out);

#endif
