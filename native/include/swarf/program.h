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
    int32_t work_offset; /**< 0: machine, 1: G54 ... */
    int32_t reserved;
} swarf_section;

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
/** Where move `index` starts. */
SWARF_API void swarf_program_move_start(const swarf_program *program, size_t index, double out[3]);
/** Seconds that the feed and dwell moves take at their feeds (no acceleration), rapids at rapid_mm_min. Moves of
 *  feed 0 (none given) and rapids at rapid_mm_min <= 0 count nothing. */
SWARF_API double swarf_program_seconds(const swarf_program *program, double rapid_mm_min);

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
/** Length of a path in mm (arc length of a helix). */
SWARF_API double swarf_path_length(const swarf_path *path);

#ifdef __cplusplus
}
#endif
#endif
