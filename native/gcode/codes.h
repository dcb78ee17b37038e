/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Codes: what each G and M word is, in which modal group, and which dialect has it. Dialects are rows of data. */
#ifndef SWARF_GCODE_CODES_H
#define SWARF_GCODE_CODES_H

#include "swarf/gcode.h"

/** Modal groups: at most one word of each may stand in a line (LinuxCNC's manual, "Modal Groups"). */
typedef enum swarf_group {
    SWARF_GROUP_NONE = 0,   /**< no such code */
    SWARF_GROUP_NONMODAL,   /**< G4 G10 G28 G30 G52 G53 G92 ... */
    SWARF_GROUP_MOTION,     /**< G0 to G3, G5, G33, G38, cycles */
    SWARF_GROUP_CANCEL,     /**< G80, by itself so that a header may say "G0 ... G80" */
    SWARF_GROUP_PLANE,      /**< G17 G18 G19 */
    SWARF_GROUP_DISTANCE,   /**< G90 G91 */
    SWARF_GROUP_ARC_CENTRE, /**< G90.1 G91.1 */
    SWARF_GROUP_FEED_MODE,  /**< G93 G94 G95 */
    SWARF_GROUP_UNITS,      /**< G20 G21 */
    SWARF_GROUP_RADIUS,     /**< G40 to G42.1 */
    SWARF_GROUP_LENGTH,     /**< G43 to G49 */
    SWARF_GROUP_RETRACT,    /**< G98 G99 */
    SWARF_GROUP_OFFSET,     /**< G54 to G59.3 */
    SWARF_GROUP_PATH,       /**< G61 G61.1 G64 */
    SWARF_GROUP_SPEED_MODE, /**< G96 G97 */
    SWARF_GROUP_SCALE,      /**< G50 G51 */
    SWARF_GROUP_TURN,       /**< G68 G69 */
    SWARF_GROUP_LATHE,      /**< G7 G8 */
    SWARF_GROUP_STOP,       /**< M0 M1 M2 M30 M60 */
    SWARF_GROUP_TOOL,       /**< M6 M61 */
    SWARF_GROUP_SPINDLE,    /**< M3 M4 M5 M19 */
    SWARF_GROUP_MIST,       /**< M7; M7 and M8 may stand together */
    SWARF_GROUP_FLOOD,      /**< M8 */
    SWARF_GROUP_DRY,        /**< M9 */
    SWARF_GROUP_OVERRIDE,   /**< M48 to M53 */
    SWARF_GROUP_PINS,       /**< M62 to M68 */
    SWARF_GROUP_STATE,      /**< M70 to M73 */
    SWARF_GROUP_USER,       /**< M100 to M199 */
    SWARF_GROUP_CALL,       /**< M98 M99 */
    SWARF_GROUP_COUNT
} swarf_group;

/** How one kind of control reads G-code. */
typedef struct swarf_dialect {
    const char *name;
    uint8_t bit;            /**< in the masks of the codes */
    uint8_t expressions;    /**< parameters and expressions are read */
    uint8_t o_words;        /**< o100 sub, if, while ... */
    uint8_t k_repeats;      /**< cycles repeat by K (else by L) */
    uint8_t dollar_system;  /**< a line that begins with $ is a command to the control, not to the machine */
    uint8_t needs_end;      /**< a file ends with M2, M30 or a second % */
    uint8_t retract_to_r;   /**< G99 at the start, else G98 */
    int16_t motion;         /**< motion mode at the start, times 10 */
    int32_t call_depth;     /**< nested calls */
    double whole_unit_mm;   /**< what 1 without a decimal point means for a length; 0: the unit in force */
    double chip_retract_mm; /**< G73, and how far above the last depth G83 turns to feed */
} swarf_dialect;

/** The data of a dialect; NULL if there is none. */
const swarf_dialect *swarf_dialect_get(swarf_gcode_dialect dialect);

/** Group of the G word `code` / 10, or SWARF_GROUP_NONE with the reason why a dialect does not take it. */
swarf_group swarf_code_g(const swarf_dialect *dialect, int code, const char **reason);
/** The same for an M word. */
swarf_group swarf_code_m(const swarf_dialect *dialect, int code, const char **reason);

#endif
