/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Program: what a machine does, as one flat array of moves.
 *
 * A move is 40 bytes and starts where the one before it ended (the first: at the program's start).
 * What many moves share - tool, operation, spindle, coolant, work offset - is a section they point to;
 * arcs and helices keep their exact geometry in a table of their own. Built front to back by one
 * thread, then read by many. Lengths in mm, in the coordinates of the stock.
 */
#ifndef SWARF_PROGRAM_H
#define SWARF_PROGRAM_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_program swarf_program;

typedef enum swarf_move_kind {
    SWARF_MOVE_RAPID = 0,
    SWARF_MOVE_FEED = 1,
    SWARF_MOVE_DWELL = 2,       /**< no motion; feed_mm_min holds the seconds */
    SWARF_MOVE_TOOL_CHANGE = 3, /**< no motion; the section holds the new tool */
    SWARF_MOVE_PROBE = 4,
    SWARF_MOVE_POSITION = 5 /**< to a place from an unknown one: moves the tool, cuts nothing */
} swarf_move_kind;

/** Plane of an arc: the axis it turns about is the plane's normal (+z, +y, +x). */
typedef enum swarf_plane { SWARF_PLANE_XY = 0, SWARF_PLANE_ZX = 1, SWARF_PLANE_YZ = 2 } swarf_plane;

/** An arc or helix: turns about the line through `centre` along the plane's normal by `angle_rad`
 *  (positive: counter-clockwise seen against the normal; |angle| may exceed a turn), while advancing
 *  evenly along the normal from the start's to the end's coordinate. */
typedef struct swarf_arc {
    double centre[3]; /**< the coordinate along the normal is that of the start */
    double angle_rad;
    int32_t plane; /**< swarf_plane */
    int32_t reserved;
} swarf_arc;

typedef enum swarf_spindle { SWARF_SPINDLE_OFF = 0, SWARF_SPINDLE_CW = 1, SWARF_SPINDLE_CCW = 2 } swarf_spindle;

/** What the moves of a stretch share. */
typedef struct swarf_section {
    int32_t tool;      /**< tool number, -1 when none is loaded yet */
    int32_t operation; /**< index into the program's operation names */
    int32_t spindle;   /**< swarf_spindle */
    int32_t coolant;   /**< bit 0: mist, bit 1: flood */
    double spindle_rpm;
    int32_t work_offset; /**< 0: machine, 1: G54 ... 9: G59.3 */
    int32_t source;      /**< index of the file that the lines are of: swarf_program_source_name() */
} swarf_section;

/** Where the axes beside X, Y and Z stand from move `first` on: A, B, C in degrees, U, V, W in mm. */
typedef struct swarf_axes {
    size_t first;
    double value[6];
} swarf_axes;

typedef enum swarf_note_kind { SWARF_NOTE_ERROR = 0, SWARF_NOTE_WARNING = 1, SWARF_NOTE_MESSAGE = 2 } swarf_note_kind;

/** What a reader or the program itself has to say of a place in a source. */
typedef struct swarf_note {
    int32_t kind; /**< swarf_note_kind */
    uint32_t line, column;
    const char *source; /**< name of the file; owned by the notes, like the text */
    const char *text;
} swarf_note;

/** A growing list of notes. One thread at a time. */
typedef struct swarf_notes swarf_notes;
SWARF_API swarf_status swarf_notes_create(swarf_notes **out);
SWARF_API void swarf_notes_destroy(swarf_notes *notes);
/** Add a copy; `notes` may be NULL. Beyond 10000 of one kind notes are left out, an error never. */
SWARF_API swarf_status swarf_notes_add(swarf_notes *notes, swarf_note_kind kind, const char *source, uint32_t line,
                                       uint32_t column, const char *text);
SWARF_API size_t swarf_notes_count(const swarf_notes *notes);
SWARF_API swarf_note swarf_notes_get(const swarf_notes *notes, size_t index);

typedef struct swarf_move {
    double end[3];
    float feed_mm_min;     /**< 0 for rapids */
    uint32_t line;         /**< 1-based line of the source (G-code) or command number (FreeCAD operation) */
    int32_t arc;           /**< index into the arcs, -1 for a straight move */
    uint32_t section_kind; /**< section * 8 + swarf_move_kind: use swarf_move_get_kind() */
} swarf_move;

static inline swarf_move_kind swarf_move_get_kind(const swarf_move *move)
{
    return (swarf_move_kind)(move->section_kind & 7u);
}
static inline uint32_t swarf_move_get_section(const swarf_move *move)
{
    return move->section_kind >> 3;
}

/** An empty program whose first move starts at `start` (3 doubles; NULL: unknown, NAN in each). */
SWARF_API swarf_status swarf_program_create(const double *start, swarf_program **out);
SWARF_API swarf_program *swarf_program_retain(swarf_program *program);
SWARF_API void swarf_program_release(swarf_program *program);

/** Add an operation name (copied) and make it current; its index is the count before. */
SWARF_API swarf_status swarf_program_add_operation(swarf_program *program, const char *name);
/** Make what follows belong to a section equal to `section` (found or added). SWARF_ERROR_ARGUMENT for
 *  an operation that was not added, a speed that is not finite. */
SWARF_API swarf_status swarf_program_set_section(swarf_program *program, const swarf_section *section);
/** Add a straight move (RAPID, FEED, PROBE, POSITION); the feed of a rapid is kept as 0. Coordinates that are NAN in
 *  the current position make it a POSITION move; such an axis may stay NAN in `end`. Without any operation the first
 *  move adds one called "program". SWARF_ERROR_ARGUMENT names the line when a number is not finite or a coordinate
 *  beyond 1e6 mm. */
SWARF_API swarf_status swarf_program_add_line(swarf_program *program, swarf_move_kind kind, const double end[3],
                                              double feed_mm_min, uint32_t line);
/** Add an arc or helix about `centre`; ccw turns counter-clockwise about the plane's normal; `turns` >= 1 counts
 *  the passes (1: up to a full circle; end == start gives a full one). The end's and start's radii may
 *  differ by at most max(0.002 mm, 0.1 %) and the arc ends exactly at `end`; else SWARF_ERROR_ARGUMENT.
 *  A mismatch is taken up by moving the centre along the chord until the radii agree; only in more than half a turn
 *  between close ends, where that would move it too far, the centre stays and the radius changes with the angle. */
SWARF_API swarf_status swarf_program_add_arc(swarf_program *program, const double end[3], const double centre[3],
                                             swarf_plane plane, int ccw, int turns, double feed_mm_min, uint32_t line);
/** Where A, B, C (degrees) and U, V, W (mm) stand at the end of what is added next. They are 0 until told.
 *  SWARF_ERROR_ARGUMENT for a number that is not finite or beyond 1e6. */
SWARF_API swarf_status swarf_program_set_axes(swarf_program *program, const double value[6]);
/** Add the name of a further file (copied); sections point to it by *index. The first is "" until named. */
SWARF_API swarf_status swarf_program_add_source(swarf_program *program, const char *name, int32_t *index);
/** Add a dwell or a tool change at the current position. */
SWARF_API swarf_status swarf_program_add_event(swarf_program *program, swarf_move_kind kind, double value,
                                               uint32_t line);

SWARF_API size_t swarf_program_move_count(const swarf_program *program);
SWARF_API const swarf_move *swarf_program_moves(const swarf_program *program);
SWARF_API size_t swarf_program_arc_count(const swarf_program *program);
SWARF_API const swarf_arc *swarf_program_arcs(const swarf_program *program);
SWARF_API size_t swarf_program_section_count(const swarf_program *program);
SWARF_API const swarf_section *swarf_program_sections(const swarf_program *program);
SWARF_API size_t swarf_program_operation_count(const swarf_program *program);
SWARF_API const char *swarf_program_operation_name(const swarf_program *program, size_t index);
SWARF_API const char *swarf_program_source_name(const swarf_program *program, size_t index);
SWARF_API size_t swarf_program_source_count(const swarf_program *program);
/** Changes of the axes beside X, Y and Z, by move; none: they stand at 0 all the time. */
SWARF_API size_t swarf_program_axes_count(const swarf_program *program);
SWARF_API const swarf_axes *swarf_program_axes(const swarf_program *program);
/** Those axes at the start and at the end of move `index`; returns whether one of them is or becomes other than 0. */
SWARF_API int swarf_program_move_axes(const swarf_program *program, size_t index, double start[6], double end[6]);
/** Where move `index` starts. */
SWARF_API void swarf_program_move_start(const swarf_program *program, size_t index, double out[3]);
/** Seconds that the feed and dwell moves take at their feeds (no acceleration), rapids at rapid_mm_min. Moves of
 *  feed 0 (none given) and rapids at rapid_mm_min <= 0 count nothing. */
SWARF_API double swarf_program_seconds(const swarf_program *program, double rapid_mm_min);

/** What a machine can do, for estimates of time. */
typedef struct swarf_machine_limits {
    size_t size;                  /**< sizeof(swarf_machine_limits) */
    double rapid_mm_min[3];       /**< of X, Y, Z in rapids */
    double feed_mm_min[3];        /**< at most, in feed moves */
    double acceleration_mm_s2[3]; /**< 0: at once */
    double junction_mm;           /**< how far corners may be cut: sets the speed through them; 0: full stop */
    double rotary_deg_min;        /**< of A, B, C, where nothing else moves */
    double tool_change_s;
} swarf_machine_limits;
/** A small mill: 5000 mm/min, 500 mm/s2, corners to 0.01 mm, 3600 deg/min, tools changed in no time. */
SWARF_API swarf_machine_limits swarf_machine_limits_default(void);
/** Seconds of each move into `seconds` (move_count of them): speeds rise and fall by the acceleration of each axis,
 *  with look-ahead through corners that do not stop. Moves of feed 0 (none given), to or from unknown places count
 *  nothing. SWARF_ERROR_ARGUMENT for limits that are not positive. Any thread. */
SWARF_API swarf_status swarf_program_times(const swarf_program *program, const swarf_machine_limits *limits,
                                           double *seconds);

/** The geometry of one move as the sweeps see it; has_motion 0: nothing moves (event, zero length, unknown
 *  start). A zero-length feed move is reported with has_motion 1 and start == end: the tool stands there. */
typedef struct swarf_path {
    double start[3];
    double end[3];
    int32_t is_arc;
    int32_t has_motion;
    swarf_arc arc;
} swarf_path;
SWARF_API swarf_status swarf_program_path(const swarf_program *program, size_t index, swarf_path *out);

/** Point of a path at parameter t in 0..1. */
SWARF_API void swarf_path_point(const swarf_path *path, double t, double out[3]);
/** The part of a path from its start to t (0 .. 1). Any thread. */
SWARF_API void swarf_path_part(const swarf_path *path, double t, swarf_path *out);
/** Length of a path in mm (arc length of a helix). */
SWARF_API double swarf_path_length(const swarf_path *path);

#ifdef __cplusplus
}
#endif
#endif
