/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code (RS274/NGC) text -> program.
 *
 * Read as LinuxCNC reads it (its G-code manual is the measure), other controls by their dialect. The program holds
 * the path of the tool's tip in the coordinates of the work offset that is in force at the first motion, which are
 * those of the stock.
 */
#ifndef SWARF_GCODE_H
#define SWARF_GCODE_H

#include "program.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum swarf_gcode_dialect {
    SWARF_DIALECT_LINUXCNC = 0,
    SWARF_DIALECT_GRBL = 1,
    SWARF_DIALECT_MACH3 = 2,
    SWARF_DIALECT_FANUC = 3 /**< whole numbers are thousandths of a millimetre (ten-thousandths of an inch) */
} swarf_gcode_dialect;

/** "linuxcnc", "grbl", "mach3", "fanuc"; NULL beyond them. */
SWARF_API const char *swarf_gcode_dialect_name(swarf_gcode_dialect dialect);

/** A row of the tool table. */
typedef struct swarf_gcode_tool {
    int32_t number;
    int32_t orientation; /**< of lathe tools; kept, not used */
    double offset[9];    /**< X Y Z A B C U V W, mm and degrees; Z is the length */
    double diameter_mm;  /**< 0: not known */
} swarf_gcode_tool;

/** Read a LinuxCNC tool table (T P X Y Z A B C U V W D I J Q ;) whose lengths are in units of `unit_mm`; *tools is
 *  freed with swarf_gcode_tools_free(). SWARF_ERROR_IO, SWARF_ERROR_FORMAT. */
SWARF_API swarf_status swarf_gcode_tools_read(const char *path, double unit_mm, swarf_gcode_tool **tools,
                                              size_t *count);
SWARF_API void swarf_gcode_tools_free(swarf_gcode_tool *tools);

/** A tool's diameter where its shape is known: for cutter compensation when no tool table tells it. */
typedef struct swarf_gcode_diameter {
    int32_t number;
    double mm;
} swarf_gcode_diameter;

typedef struct swarf_gcode_options {
    size_t size;     /**< sizeof(swarf_gcode_options) */
    double start[3]; /**< where the tool stands first, mm; NAN per axis: unknown until commanded */
    swarf_gcode_dialect dialect;
    int32_t block_delete;          /**< 1: lines that begin with '/' are left out */
    const swarf_gcode_tool *tools; /**< tool table; NULL: none is known, G43 of the loaded tool leads its tip */
    size_t tool_count;
    const swarf_gcode_diameter *diameters; /**< the tool table comes first; may be NULL */
    size_t diameter_count;
    const char *parameters;   /**< LinuxCNC's parameter file (.var); NULL: none, machine coordinates are unknown */
    double parameter_unit_mm; /**< what its lengths are in: the machine's unit, 1 or 25.4 */
    const char *path;         /**< folders for subroutines in files of their own, separated by ':'; NULL: none */
    size_t line_limit;        /**< lines that loops and calls may execute beside the text itself; 0: 20 million */
    swarf_notes *notes;       /**< what the reader has to say, the error included, is added here; may be NULL */
} swarf_gcode_options;

SWARF_API swarf_gcode_options swarf_gcode_options_default(void);

/** Read `length` bytes of G-code. `name` is used in errors. Each M6 starts an operation named after the tool.
 *  SWARF_ERROR_FORMAT: "name:line:column: error: 'word' ...". The program has one reference. Any thread. */
SWARF_API swarf_status swarf_gcode_read(const char *text, size_t length, const char *name,
                                        const swarf_gcode_options *options, const swarf_progress *progress,
                                        swarf_program **out);
/** The same for a file; SWARF_ERROR_IO if it cannot be read. Its own folder is searched for subroutines too. */
SWARF_API swarf_status swarf_gcode_read_file(const char *path, const swarf_gcode_options *options,
                                             const swarf_progress *progress, swarf_program **out);

#ifdef __cplusplus
}
#endif
#endif
