/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Machine: the modal state of an RS274/NGC interpreter, which turns one block after the other into moves.
 *
 * Lengths are kept in mm whatever the units of the program; words are scaled when they are read.
 */
#ifndef SWARF_GCODE_MACHINE_H
#define SWARF_GCODE_MACHINE_H

#include "gcode/words.h"
#include "swarf/program.h"

/** Motion modes are the G codes times 10; this one is none at all (at the start and after G80). */
enum { SWARF_MOTION_NONE = 800 };

/** What drilling cycles remember from line to line, until a line leaves them. */
typedef struct swarf_cycle {
    int active;     /**< in a series of cycles */
    uint32_t known; /**< letters Z R Q P given in this series */
    double z, r, q; /**< as written, mm */
    double seconds; /**< P */
    double initial; /**< height the series began at, for G98; NAN if that was unknown */
} swarf_cycle;

typedef struct swarf_machine {
    swarf_place place;
    swarf_program *program;
    double position[3]; /**< NAN per axis: unknown */
    double unit_mm;     /**< 1 or 25.4 */
    int motion;
    swarf_plane plane;
    int incremental;  /**< G91 */
    int arc_absolute; /**< G90.1 */
    int retract_to_r; /**< G99 */
    double feed_mm_min;
    int selected; /**< by T, -1 for none */
    swarf_section section;
    int section_changed;
    swarf_cycle cycle;
    uint32_t *tool_uses; /**< by tool number: M6 so far, for the operations' names */
    size_t tool_room;
    int ended;
} swarf_machine;

/** Execute one line. The machine needs a program, a position and a place. */
swarf_status swarf_machine_run(swarf_machine *machine, swarf_block *block);

/** State at the start of a program: G0 to nowhere, G17 G21 G90 G91.1 G94 G98, no tool, spindle off. */
void swarf_machine_begin(swarf_machine *machine, swarf_program *program, const char *name, const double start[3]);
void swarf_machine_end(swarf_machine *machine);

/** A length word in mm; an error if beyond what a machine can be. */
swarf_status swarf_machine_length(const swarf_machine *machine, const swarf_block *block, const swarf_word *word,
                                  double *out);
/** A whole number from lo to hi. */
swarf_status swarf_machine_whole(const swarf_machine *machine, const swarf_block *block, const swarf_word *word, int lo,
                                 int hi, int *out);
/** Move straight to `end`, RAPID or FEED. */
swarf_status swarf_machine_go(swarf_machine *machine, const swarf_block *block, const swarf_word *word,
                              swarf_move_kind kind, const double end[3]);
/** Move along a checked arc to `end`. */
swarf_status swarf_machine_turn(swarf_machine *machine, const swarf_block *block, const swarf_word *word,
                                const double end[3], const swarf_arc *arc);
/** Record a pause. */
swarf_status swarf_machine_dwell(swarf_machine *machine, double seconds);

/** The motion of a block: G2 and G3; G73 and G81 to G89. `word` is what an error points at. */
swarf_status swarf_machine_arc(swarf_machine *machine, swarf_block *block, const swarf_word *word);
swarf_status swarf_machine_drill(swarf_machine *machine, swarf_block *block, const swarf_word *word);

#endif
