/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code (RS274/NGC) text -> program. */
#ifndef SWARF_GCODE_H
#define SWARF_GCODE_H

#include "program.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_gcode_options {
    size_t size;     /**< sizeof(swarf_gcode_options) */
    double start[3]; /**< where the tool stands first, mm; NAN per axis: unknown until commanded */
} swarf_gcode_options;

SWARF_API swarf_gcode_options swarf_gcode_options_default(void);

/** Read `length` bytes of G-code. `name` is used in errors. Each M6 starts an operation named after the tool.
 *  SWARF_ERROR_FORMAT: "name:line:column: error: 'word' ...". The program has one reference. Any thread. */
SWARF_API swarf_status swarf_gcode_read(const char *text, size_t length, const char *name,
                                        const swarf_gcode_options *options, const swarf_progress *progress,
                                        swarf_program **out);
/** The same for a file; SWARF_ERROR_IO if it cannot be read. */
SWARF_API swarf_status swarf_gcode_read_file(const char *path, const swarf_gcode_options *options,
                                             const swarf_progress *progress, swarf_program **out);

#ifdef __cplusplus
}
#endif
#endif
