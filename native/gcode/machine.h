/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Machine: the modal state of an RS274/NGC interpreter, which turns one block after the other into moves.
 *
 * Lengths are kept in mm whatever the units of the program; words are scaled when they are read. A position is nine
 * numbers X Y Z A B C U V W in the work coordinates of the program, NAN per axis where it is not known. On its way
 * into the program a point passes
 *
 *     work -> scaled and turned (G51, G68) -> + G92 -> turned by the work offset -> + work offset + tool offset
 *          -> machine -> - length of the tool in the spindle -> - frame -> the tip in the coordinates of the stock
 *
 * where the frame is the work offset in force at the first motion. When an offset changes, the machine stands still
 * and the position in work coordinates changes.
 */
#ifndef SWARF_GCODE_MACHINE_H
#define SWARF_GCODE_MACHINE_H

#include "gcode/block.h"
#include "gcode/parameters.h"
#include "program/arc.h"

/** Motion modes are the G codes times 10; this one is none at all (at the start and after G80). */
enum { SWARF_MOTION_NONE = 800 };

enum { SWARF_AXES = 9, SWARF_SYSTEMS = 9, SWARF_CALLS_MAX = 16 };

/** What M70 saves and M72 brings back. */
typedef struct swarf_modes {
    int motion;
    swarf_plane plane;
    int incremental;  /**< G91 */
    int arc_absolute; /**< G90.1 */
    int retract_to_r; /**< G99 */
    int feed_mode;    /**< 930, 940, 950 */
    int surface;      /**< G96 */
    int path;         /**< 610, 611, 640 */
    double unit_mm;   /**< 1 or 25.4 */
    double feed;      /**< mm/min, mm per turn under G95; 0: none given */
    double speed;     /**< S: rpm, or m/min under G96 */
    int spindle, coolant;
} swarf_modes;

/** What drilling cycles remember from line to line, until a line leaves them. */
typedef struct swarf_cycle {
    int active;     /**< in a series of cycles */
    int last;       /**< the cycle that `known` belongs to */
    uint32_t known; /**< letters Z R Q P given in this series */
    double z, r, q; /**< as written, mm */
    double seconds; /**< P */
    double initial; /**< height the series began at, for G98; NAN if that was unknown */
} swarf_cycle;

/** One move on its way to the program. */
typedef struct swarf_step {
    int kind; /**< swarf_move_kind */
    int is_arc, ccw, turns;
    double end[SWARF_AXES]; /**< work coordinates */
    double centre[3];
    double value; /**< feed in mm/min, seconds of a dwell */
    swarf_section section;
    uint32_t line;
} swarf_step;

/** A step of a compensated path in the plane: programmed, and the tool's side of it. */
typedef struct swarf_course {
    int is_arc, ccw;
    double end[2], centre[2];
    double tangent_in[2], tangent_out[2]; /**< unit, at the programmed start and end */
    double normal_in[2], normal_out[2];   /**< unit, from the path towards the tool */
    double from[2];                       /**< where the tool's path begins */
} swarf_course;

/** Cutter compensation: the step whose end depends on the next one, and what came after it. */
typedef struct swarf_compensation {
    int side;    /**< 0 off, 1 left, -1 right */
    int code;    /**< 410, 411, 420, 421 for #<_ccomp> */
    int entered; /**< the lead-in was read */
    int leaving; /**< G40 was read, but no motion since */
    int has_pending;
    double radius;
    double at[2]; /**< where the tool is */
    swarf_course course;
    swarf_step pending;
    swarf_step *held; /**< moves along the normal of the plane, dwells */
    size_t held_count, held_room;
} swarf_compensation;

/** G51 and G68: about a centre, per axis and in the plane XY. */
typedef struct swarf_bend {
    int on;
    double scale_centre[3], factor[3];
    double turn_centre[2], angle;
    double cosine, sine;
} swarf_bend;

/** M98 and M99: what the runner is asked to do after this block. */
typedef enum swarf_request { SWARF_REQUEST_NONE, SWARF_REQUEST_CALL, SWARF_REQUEST_RETURN } swarf_request;

struct swarf_machine {
    const swarf_dialect *dialect;
    int block_delete;
    int has_table; /**< a tool table was given */
    swarf_place place;
    swarf_program *program;
    swarf_notes *notes;
    swarf_parameters parameters;
    swarf_modes modes;
    double position[SWARF_AXES];

    int system;                /**< 1 G54 ... 9 G59.3 */
    int plain;                 /**< the tip is position + constant */
    double work[SWARF_AXES];   /**< its origin */
    double turn_deg;           /**< its rotation */
    double shift[SWARF_AXES];  /**< G92 and G52 in force */
    double offset[SWARF_AXES]; /**< tool offset in force */
    double length[3];          /**< offset of the tool in the spindle */
    swarf_bend bend;
    int machine_known; /**< machine coordinates mean something: offsets were given */
    int home_known[2]; /**< G28.1, G30.1 were told in this program */
    int frame_fixed;
    double frame[3], frame_deg;
    int selected;    /**< tool by T, -1 for none */
    int frame_stale; /**< offsets changed since the last move: the tip may be elsewhere than the program left it */
    double last_tip[3];
    double cosine, sine, constant[3];

    swarf_gcode_tool *tools;
    size_t tool_count, tool_room;
    const swarf_gcode_diameter *diameters; /**< the caller's */
    size_t diameter_count;
    swarf_section section, settled;
    uint32_t *tool_uses; /**< by tool number: M6 so far, for the operations' names */
    size_t tool_room_used;

    swarf_cycle cycle;
    swarf_compensation comp;
    int had_spline, has_returned;
    double spline[2]; /**< direction that the next G5 goes on with */
    double axes_now[6];

    swarf_modes saved[SWARF_CALLS_MAX + 2]; /**< by call level */
    int is_saved[SWARF_CALLS_MAX + 2];      /**< 1 by M70, 2 by M73: brought back on return */
    int level, is_settled;                  /**< is_settled: the program's section is `settled` */
    double returned;

    swarf_request request;
    int call_number, call_repeats, ended;
    swarf_word call_word;
    uint32_t warned;        /**< SWARF_WARNED_... */
    uint32_t systems_moved; /**< bit per work offset that motion used */
};

enum {
    SWARF_WARNED_MACHINE = 1,
    SWARF_WARNED_PROBE = 2,
    SWARF_WARNED_INPUT = 4,
    SWARF_WARNED_SURFACE = 8,
    SWARF_WARNED_LENGTH = 16,
    SWARF_WARNED_SYSTEM = 32,
    SWARF_WARNED_UNKNOWN = 64
};

/** State at the start of a program. The machine keeps `program` and `notes`, copies the tool table. */
swarf_status swarf_machine_begin(swarf_machine *machine, const swarf_gcode_options *options, swarf_program *program);
void swarf_machine_end(swarf_machine *machine);
/** Execute one line. */
swarf_status swarf_machine_run(swarf_machine *machine, swarf_block *block);
/** What is still on its way to the program; at the end of the text. */
swarf_status swarf_machine_finish(swarf_machine *machine);

/* ---- words ---- */
/** A length word in mm; an error if beyond what a machine can be. */
swarf_status swarf_machine_length(const swarf_machine *machine, const swarf_word *word, double *out);
/** A whole number from lo to hi. */
swarf_status swarf_machine_whole(const swarf_machine *machine, const swarf_word *word, int lo, int hi, int *out);
/** Value of an axis word, mm or degrees. */
swarf_status swarf_machine_axis_word(const swarf_machine *machine, swarf_block *block, int axis, double *out);
/** Letter of an axis 0 .. 8. */
static inline char swarf_axis_letter(int axis)
{
    return "XYZABCUVW"[axis];
}
/** Letters of all axes. */
#define SWARF_AXIS_LETTERS                                                                                             \
    (SWARF_LETTER('X') | SWARF_LETTER('Y') | SWARF_LETTER('Z') | SWARF_LETTER('A') | SWARF_LETTER('B') |               \
     SWARF_LETTER('C') | SWARF_LETTER('U') | SWARF_LETTER('V') | SWARF_LETTER('W'))

/* ---- parameters ---- */
/** Value of a numbered parameter; NAN: not known. */
double swarf_machine_parameter(const swarf_machine *machine, int index);
/** Value of a predefined named parameter (NAN: not known); 0 if there is none of this name. */
int swarf_machine_predefined(const swarf_machine *machine, const char *name, double *out);
swarf_status swarf_machine_check_setting(const swarf_machine *machine, const swarf_setting *setting,
                                         const swarf_word *word);
swarf_status swarf_machine_set(swarf_machine *machine, const swarf_setting *setting);

/* ---- frames ---- */
/** Bring what depends on offsets up to date. */
void swarf_machine_reframe(swarf_machine *machine);
/** Machine coordinates of a point in work coordinates, and back. */
void swarf_machine_absolute(const swarf_machine *machine, const double work[SWARF_AXES], double out[SWARF_AXES]);
void swarf_machine_relative(const swarf_machine *machine, const double absolute[SWARF_AXES], double out[SWARF_AXES]);
/** Place of the tip in the coordinates of the stock. */
void swarf_machine_tip(const swarf_machine *machine, const double work[3], double out[3]);

/* ---- moves ---- */
/** Feed in mm/min of a feed move of `length` mm. */
swarf_status swarf_machine_feed(swarf_machine *machine, swarf_block *block, const swarf_word *word, double length,
                                double *out);
/** Move straight to `end`. */
swarf_status swarf_machine_go(swarf_machine *machine, const swarf_word *word, swarf_move_kind kind,
                              const double end[SWARF_AXES], double feed);
/** Move along an arc. */
swarf_status swarf_machine_turn(swarf_machine *machine, const swarf_word *word, const double end[SWARF_AXES],
                                const double centre[3], int ccw, int turns, double feed);
/** Record a pause. */
swarf_status swarf_machine_dwell(swarf_machine *machine, const swarf_word *word, double seconds);
/** Put a step into the program. `word` is what an error points at. */
swarf_status swarf_machine_emit(swarf_machine *machine, const swarf_word *word, const swarf_step *step);
/** What has to be so before a first move, or after offsets changed: the tip may be elsewhere without a motion. */
swarf_status swarf_machine_prepare(swarf_machine *machine, const swarf_word *word, uint32_t line);
/** A step with what the machine's state says of it. */
swarf_step swarf_machine_step(const swarf_machine *machine, swarf_move_kind kind, double value);
/** Read the axis words of a straight move into `end`. `any`: some axis was given. */
swarf_status swarf_machine_target(swarf_machine *machine, swarf_block *block, double end[SWARF_AXES], int *any);
/** The length along which a feed goes: XYZ, else UVW, else ABC in degrees. */
double swarf_machine_distance(const double from[SWARF_AXES], const double to[SWARF_AXES]);

/* ---- what blocks do; `word` is what an error points at ---- */
swarf_status swarf_machine_straight(swarf_machine *machine, swarf_block *block, const swarf_word *word);
swarf_status swarf_machine_arc(swarf_machine *machine, swarf_block *block, const swarf_word *word);
swarf_status swarf_machine_spline(swarf_machine *machine, swarf_block *block, const swarf_word *word);
swarf_status swarf_machine_probe(swarf_machine *machine, swarf_block *block, const swarf_word *word);
swarf_status swarf_machine_synchronized(swarf_machine *machine, swarf_block *block, const swarf_word *word);
swarf_status swarf_machine_drill(swarf_machine *machine, swarf_block *block, const swarf_word *word);
/** T, M6, M61. */
swarf_status swarf_machine_tool(swarf_machine *machine, swarf_block *block);
const swarf_gcode_tool *swarf_machine_find_tool(const swarf_machine *machine, int number);
/** G43 to G49, G54 to G59.3, G50 G51 G68 G69. */
swarf_status swarf_machine_offsets(swarf_machine *machine, swarf_block *block);
/** G10, G28, G30, G52, G92 and what belongs to them. */
swarf_status swarf_machine_nonmodal(swarf_machine *machine, swarf_block *block, const swarf_word *word);
/** Make a work offset the one in force. */
void swarf_machine_select_system(swarf_machine *machine, int system);
/** M62 to M73, M100 to M199, M48 to M53. */
swarf_status swarf_machine_misc(swarf_machine *machine, swarf_block *block);
/** Bring back what M73 saved at this call level. */
swarf_status swarf_machine_restore(swarf_machine *machine);
/** (MSG, ...), (DEBUG, ...) and their kin. */
swarf_status swarf_machine_comment(swarf_machine *machine, const swarf_block *block);

/* ---- cutter compensation ---- */
/** G40 to G42.1. */
swarf_status swarf_machine_radius(swarf_machine *machine, swarf_block *block);
/** A step of a compensated path. */
swarf_status swarf_compensation_add(swarf_machine *machine, const swarf_word *word, const swarf_step *step);
/** Let out what waits. */
swarf_status swarf_compensation_flush(swarf_machine *machine, const swarf_word *word);

#endif
