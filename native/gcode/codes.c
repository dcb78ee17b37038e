/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Codes: two tables indexed by the code (G times 10), and the dialects. A G word costs one load.
 *
 * Sources: LinuxCNC's G-code and M-code references; grbl's "G-code supported"; Mach3's G-code and M-code reference;
 * Fanuc's operator manuals, G-code system B.
 */
#include "gcode/codes.h"

enum { LCNC = 1, GRBL = 2, MACH = 4, FANUC = 8, ALL = 15, NO_GRBL = LCNC | MACH | FANUC, NGC = LCNC | MACH };

static const swarf_dialect dialects[] = {
    [SWARF_DIALECT_LINUXCNC] = {"linuxcnc", LCNC, 1, 1, 0, 0, 1, 1, 800, 10, 0.0, 0.254},
    [SWARF_DIALECT_GRBL] = {"grbl", GRBL, 0, 0, 0, 1, 0, 0, 0, 1, 0.0, 0.254},
    [SWARF_DIALECT_MACH3] = {"mach3", MACH, 1, 0, 0, 0, 0, 0, 800, 15, 0.0, 0.254},
    [SWARF_DIALECT_FANUC] = {"fanuc", FANUC, 1, 0, 1, 0, 0, 0, 0, 10, 0.001, 0.254},
};

typedef struct code_row {
    uint8_t group, dialects;
} code_row;

static const code_row g_codes[1000] = {
    [0] = {SWARF_GROUP_MOTION, ALL},
    [10] = {SWARF_GROUP_MOTION, ALL},
    [20] = {SWARF_GROUP_MOTION, ALL},
    [30] = {SWARF_GROUP_MOTION, ALL},
    [40] = {SWARF_GROUP_NONMODAL, ALL},
    [50] = {SWARF_GROUP_MOTION, LCNC},
    [51] = {SWARF_GROUP_MOTION, LCNC},
    [80] = {SWARF_GROUP_LATHE, LCNC},
    [100] = {SWARF_GROUP_NONMODAL, ALL},
    [170] = {SWARF_GROUP_PLANE, ALL},
    [180] = {SWARF_GROUP_PLANE, ALL},
    [190] = {SWARF_GROUP_PLANE, ALL},
    [200] = {SWARF_GROUP_UNITS, ALL},
    [210] = {SWARF_GROUP_UNITS, ALL},
    [280] = {SWARF_GROUP_NONMODAL, ALL},
    [281] = {SWARF_GROUP_NONMODAL, LCNC | GRBL | MACH},
    [300] = {SWARF_GROUP_NONMODAL, ALL},
    [301] = {SWARF_GROUP_NONMODAL, LCNC | GRBL},
    [330] = {SWARF_GROUP_MOTION, LCNC},
    [331] = {SWARF_GROUP_MOTION, LCNC},
    [382] = {SWARF_GROUP_MOTION, LCNC | GRBL},
    [383] = {SWARF_GROUP_MOTION, LCNC | GRBL},
    [384] = {SWARF_GROUP_MOTION, LCNC | GRBL},
    [385] = {SWARF_GROUP_MOTION, LCNC | GRBL},
    [400] = {SWARF_GROUP_RADIUS, ALL},
    [410] = {SWARF_GROUP_RADIUS, NO_GRBL},
    [411] = {SWARF_GROUP_RADIUS, LCNC},
    [420] = {SWARF_GROUP_RADIUS, NO_GRBL},
    [421] = {SWARF_GROUP_RADIUS, LCNC},
    [430] = {SWARF_GROUP_LENGTH, NO_GRBL},
    [431] = {SWARF_GROUP_LENGTH, LCNC | GRBL},
    [432] = {SWARF_GROUP_LENGTH, LCNC},
    [490] = {SWARF_GROUP_LENGTH, ALL},
    [500] = {SWARF_GROUP_SCALE, MACH | FANUC},
    [510] = {SWARF_GROUP_SCALE, MACH | FANUC},
    [520] = {SWARF_GROUP_NONMODAL, NO_GRBL},
    [530] = {SWARF_GROUP_NONMODAL, ALL},
    [540] = {SWARF_GROUP_OFFSET, ALL},
    [550] = {SWARF_GROUP_OFFSET, ALL},
    [560] = {SWARF_GROUP_OFFSET, ALL},
    [570] = {SWARF_GROUP_OFFSET, ALL},
    [580] = {SWARF_GROUP_OFFSET, ALL},
    [590] = {SWARF_GROUP_OFFSET, ALL},
    [591] = {SWARF_GROUP_OFFSET, NGC},
    [592] = {SWARF_GROUP_OFFSET, NGC},
    [593] = {SWARF_GROUP_OFFSET, NGC},
    [610] = {SWARF_GROUP_PATH, ALL},
    [611] = {SWARF_GROUP_PATH, LCNC},
    [640] = {SWARF_GROUP_PATH, NO_GRBL},
    [680] = {SWARF_GROUP_TURN, MACH | FANUC},
    [690] = {SWARF_GROUP_TURN, MACH | FANUC},
    [730] = {SWARF_GROUP_MOTION, NO_GRBL},
    [740] = {SWARF_GROUP_MOTION, LCNC | FANUC},
    [800] = {SWARF_GROUP_CANCEL, ALL},
    [810] = {SWARF_GROUP_MOTION, NO_GRBL},
    [820] = {SWARF_GROUP_MOTION, NO_GRBL},
    [830] = {SWARF_GROUP_MOTION, NO_GRBL},
    [840] = {SWARF_GROUP_MOTION, NO_GRBL},
    [850] = {SWARF_GROUP_MOTION, NO_GRBL},
    [860] = {SWARF_GROUP_MOTION, NO_GRBL},
    [890] = {SWARF_GROUP_MOTION, NO_GRBL},
    [900] = {SWARF_GROUP_DISTANCE, ALL},
    [901] = {SWARF_GROUP_ARC_CENTRE, NGC},
    [910] = {SWARF_GROUP_DISTANCE, ALL},
    [911] = {SWARF_GROUP_ARC_CENTRE, LCNC | GRBL | MACH},
    [920] = {SWARF_GROUP_NONMODAL, ALL},
    [921] = {SWARF_GROUP_NONMODAL, LCNC | GRBL | MACH},
    [922] = {SWARF_GROUP_NONMODAL, NGC},
    [923] = {SWARF_GROUP_NONMODAL, NGC},
    [930] = {SWARF_GROUP_FEED_MODE, ALL},
    [940] = {SWARF_GROUP_FEED_MODE, ALL},
    [950] = {SWARF_GROUP_FEED_MODE, NO_GRBL},
    [960] = {SWARF_GROUP_SPEED_MODE, LCNC | FANUC},
    [970] = {SWARF_GROUP_SPEED_MODE, LCNC | FANUC},
    [980] = {SWARF_GROUP_RETRACT, NO_GRBL},
    [990] = {SWARF_GROUP_RETRACT, NO_GRBL},
};

static const code_row m_codes[100] = {
    [0] = {SWARF_GROUP_STOP, ALL},
    [1] = {SWARF_GROUP_STOP, ALL},
    [2] = {SWARF_GROUP_STOP, ALL},
    [3] = {SWARF_GROUP_SPINDLE, ALL},
    [4] = {SWARF_GROUP_SPINDLE, ALL},
    [5] = {SWARF_GROUP_SPINDLE, ALL},
    [6] = {SWARF_GROUP_TOOL, ALL},
    [7] = {SWARF_GROUP_MIST, ALL},
    [8] = {SWARF_GROUP_FLOOD, ALL},
    [9] = {SWARF_GROUP_DRY, ALL},
    [19] = {SWARF_GROUP_SPINDLE, LCNC | FANUC},
    [30] = {SWARF_GROUP_STOP, ALL},
    [48] = {SWARF_GROUP_OVERRIDE, NO_GRBL},
    [49] = {SWARF_GROUP_OVERRIDE, NO_GRBL},
    [50] = {SWARF_GROUP_OVERRIDE, LCNC},
    [51] = {SWARF_GROUP_OVERRIDE, LCNC},
    [52] = {SWARF_GROUP_OVERRIDE, LCNC},
    [53] = {SWARF_GROUP_OVERRIDE, LCNC},
    [60] = {SWARF_GROUP_STOP, LCNC},
    [61] = {SWARF_GROUP_TOOL, LCNC},
    [62] = {SWARF_GROUP_PINS, LCNC},
    [63] = {SWARF_GROUP_PINS, LCNC},
    [64] = {SWARF_GROUP_PINS, LCNC},
    [65] = {SWARF_GROUP_PINS, LCNC},
    [66] = {SWARF_GROUP_PINS, LCNC},
    [67] = {SWARF_GROUP_PINS, LCNC},
    [68] = {SWARF_GROUP_PINS, LCNC},
    [70] = {SWARF_GROUP_STATE, LCNC},
    [71] = {SWARF_GROUP_STATE, LCNC},
    [72] = {SWARF_GROUP_STATE, LCNC},
    [73] = {SWARF_GROUP_STATE, LCNC},
    [98] = {SWARF_GROUP_CALL, NO_GRBL},
    [99] = {SWARF_GROUP_CALL, NO_GRBL},
};

const swarf_dialect *swarf_dialect_get(swarf_gcode_dialect dialect)
{
    if ((int)dialect < 0 || (size_t)dialect >= sizeof dialects / sizeof *dialects) return NULL;
    return &dialects[dialect];
}

const char *swarf_gcode_dialect_name(swarf_gcode_dialect dialect)
{
    const swarf_dialect *found = swarf_dialect_get(dialect);
    return found ? found->name : NULL;
}

/* Why a code of some control is not for a milling simulation; NULL where there is nothing special to say. */
static const char *reason_of_g(int code)
{
    switch (code) {
    case 52:
    case 53: return "NURBS blocks are not supported; post with arcs, or with G5 and G5.1";
    case 70: return "is the diameter mode of lathes; this is a milling simulation";
    case 171:
    case 181:
    case 191: return "planes of U, V and W are not supported; use G17, G18 or G19";
    case 700:
    case 710:
    case 711:
    case 712:
    case 720:
    case 721:
    case 722:
    case 760: return "is a cycle of lathes; this is a milling simulation";
    case 120:
    case 130: return "circular pockets are not supported; write them by G2 and G3";
    case 150:
    case 160: return "polar coordinates are not supported; write X and Y";
    case 650:
    case 660:
    case 670: return "macro calls are not supported; call by M98";
    case 541: return "further work offsets are not supported; G54 to G59 are";
    case 870: return "back boring needs a shift of the tool that is not known here; write its moves";
    case 880: return "is fed out by hand; write its moves";
    case 500:
    case 510:
    case 680:
    case 690: return "scaling and rotation are of the dialects mach3 and fanuc; choose one of them";
    default: return NULL;
    }
}

swarf_group swarf_code_g(const swarf_dialect *dialect, int code, const char **reason)
{
    if (code >= 0 && code < 1000 && (g_codes[code].dialects & dialect->bit)) return (swarf_group)g_codes[code].group;
    *reason = reason_of_g(code);
    if (!*reason)
        *reason = code >= 0 && code < 1000 && g_codes[code].dialects ? "is not a code of this dialect"
                                                                     : "is no G code that mills have";
    return SWARF_GROUP_NONE;
}

swarf_group swarf_code_m(const swarf_dialect *dialect, int code, const char **reason)
{
    if (code >= 100 && code < 200 && dialect->bit == LCNC) return SWARF_GROUP_USER;
    if (code >= 0 && code < 100 && (m_codes[code].dialects & dialect->bit)) return (swarf_group)m_codes[code].group;
    *reason = code >= 0 && code < 100 && m_codes[code].dialects ? "is not a code of this dialect"
                                                                : "is no M code that mills have";
    return SWARF_GROUP_NONE;
}
