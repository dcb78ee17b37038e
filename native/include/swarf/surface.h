/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Surface: what the surface of a stock truly is, beyond the voxels: its first shape and the exact sweeps of the moves
 * that were cut, in double precision.
 *
 * A block that was not cut before is a formula; any other first stock is its level set, trilinear between
 * the voxels. Arcs and helices are themselves, not chords. Concave arcs of a cutter's meridian, and convex ones of
 * enormous radius, are chords within 1/10000 of a voxel. Made once for a whole program; what stands after its
 * first n moves is asked for with `moves` = n.
 */
#ifndef SWARF_SURFACE_H
#define SWARF_SURFACE_H

#include "placement.h"
#include "stock.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Immutable; shared by reference count; any thread. */
typedef struct swarf_surface swarf_surface;

/** Take the first stock (read now, not kept) and a program (kept). Moves whose tool is not in `tools` or has no flutes
 *  cut nothing. SWARF_ERROR_BUSY: the stock is in use by another thread. The caller owns one reference. */
SWARF_API swarf_status swarf_surface_create(swarf_stock *first, const swarf_program *program, const swarf_tool *tools,
                                            size_t tool_count, const swarf_progress *progress, swarf_surface **out);
/** The surface of the next set-up: what `before` (kept) is after its first `moves`, turned and moved by `placement`, is
 *  the first shape of `program`. Nothing of it is lost, as nothing is sampled. The voxel is that of `before`. */
SWARF_API swarf_status swarf_surface_create_next(const swarf_surface *before, size_t moves,
                                                 const swarf_placement *placement, const swarf_program *program,
                                                 const swarf_tool *tools, size_t tool_count,
                                                 const swarf_progress *progress, swarf_surface **out);
SWARF_API swarf_surface *swarf_surface_retain(swarf_surface *surface);
/** Give one reference back; NULL is legal. */
SWARF_API void swarf_surface_release(swarf_surface *surface);

/** What a point sees of the surface, and what made that. */
typedef struct swarf_surface_point {
    double value;     /**< signed distance in mm as in the stock's field: negative in material; 0 on the surface */
    double normal[3]; /**< unit, out of the material: the gradient of `value` */
    double t;         /**< 0..1 along the move where the cutter touches; an end of a plunge, on its wall too */
    int64_t move;     /**< index into the program; -1: the first shape; below -2: swarf_surface_origin() tells */
    /** Of the first shape: block 0 -x, 1 +x, 2 -y ... 5 +z, else 0. Of a cutter: number
     *  of the line or arc among those its meridian is cut into, from the tip upwards. */
    int32_t piece;
    int32_t reserved;
} swarf_surface_point;

/** The set-up of a move as points name it, and its index in that set-up's program: 0 the surface's own, 1 the one
 *  before
 *  ...; index -1 and the number of set-ups before for the first shape of all. Other numbers come out as that. */
SWARF_API void swarf_surface_origin(const swarf_surface *surface, int64_t move, int *set_up, int64_t *index);

/** What a face is, as CAD programs know them. */
typedef enum swarf_face_kind {
    SWARF_FACE_OTHER = 0, /**< of a first shape that is no block, of edges on slopes, of helices ... */
    SWARF_FACE_PLANE = 1,
    SWARF_FACE_CYLINDER = 2,
    SWARF_FACE_CONE = 3,
    SWARF_FACE_SPHERE = 4,
    SWARF_FACE_TORUS = 5
} swarf_face_kind;
/** What face a point of the surface is on, by the piece of the cutter and the move that made it. */
SWARF_API swarf_face_kind swarf_surface_face(const swarf_surface *surface, const swarf_surface_point *point);

/** A face as CAD programs know them, endless. Without meaning: 0. */
typedef struct swarf_face_shape {
    int32_t kind; /**< swarf_face_kind */
    int32_t reserved;
    double point[3]; /**< plane, cylinder: on it, on its axis; cone: its apex; sphere, torus: the centre; mm */
    double axis[3];  /**< plane: its normal, out of the material; cylinder, cone, torus: the axis; unit */
    double radius;   /**< cylinder, sphere; torus: from the axis to the middle of its tube; mm */
    double second;   /**< cone: tangent of the angle between its axis and it; torus: radius of its tube, mm */
} swarf_face_shape;
/** The face that a point of the surface is on. */
SWARF_API swarf_face_shape swarf_surface_shape(const swarf_surface *surface, const swarf_surface_point *point);

/** What made a point and on what kind of face it lies. */
typedef struct swarf_surface_mark {
    int32_t set_up; /**< as of swarf_surface_origin() */
    int32_t move;   /**< -1: the first shape; -2: not known */
    int32_t piece;
    int32_t face; /**< swarf_face_kind */
} swarf_surface_mark;

/** The marks of `count` points; SWARF_ERROR_ARGUMENT: NULL; SWARF_ERROR_CANCELLED. Any thread. */
SWARF_API swarf_status swarf_surface_marks(const swarf_surface *surface, const swarf_surface_point *points,
                                           size_t count, const swarf_progress *progress, swarf_surface_mark *out);

/** What can matter within one small box: scratch of one thread. Keeps the surface alive. */
typedef struct swarf_surface_near swarf_surface_near;
SWARF_API swarf_status swarf_surface_near_create(const swarf_surface *surface, swarf_surface_near **out);
/** NULL is legal. */
SWARF_API void swarf_surface_near_destroy(swarf_surface_near *near);

/** Gather what the first shape and moves 0 .. moves - 1 can contribute to a zero within `where`; cost grows with the
 *  box, some voxels are best. After a failure nothing is gathered. */
SWARF_API swarf_status swarf_surface_gather(swarf_surface_near *near, size_t moves, const swarf_box *where);
/** Parts of moves gathered. */
SWARF_API size_t swarf_surface_near_count(const swarf_surface_near *near);
/** The surface as seen from a point in the gathered box. Near a zero `value` is exact to first order, as far as a box
 *  edge its sign is. */
SWARF_API void swarf_surface_evaluate(const swarf_surface_near *near, const double point[3], swarf_surface_point *out);
/** Zero on the segment a .. b (both in the gathered box) by a bracketed search: 1, its place t in 0..1 and the point
 *  seen there; 0 and outputs untouched when the values at a and b are not of opposite sign. */
SWARF_API int swarf_surface_crossing(const swarf_surface_near *near, const double a[3], const double b[3],
                                     double tolerance_mm, double *t, swarf_surface_point *out);

/** Lines along which the surface is looked for, from points forth and back. */
typedef struct swarf_surface_lines {
    const double *points;     /**< 3 each, mm */
    const double *directions; /**< 3 each, of any length but 0 */
    size_t count;             /**< any number, in any order */
    double reach_mm;          /**< no farther than this from the points, > 0 */
} swarf_surface_lines;

/** Where lines meet the surface; arrays of the caller. */
typedef struct swarf_surface_feet {
    double *points;  /**< 3 each; may be those of the lines */
    double *normals; /**< 3 each; NULL: not wanted */
    int64_t *moves;  /**< as in swarf_surface_point; NULL: not wanted */
} swarf_surface_feet;

/** What made the surface near points: the zero on their lines that swarf_surface_refine() finds, as seen from there;
 *  move -2 where there is none. `out`: one per line. */
SWARF_API swarf_status swarf_surface_find(const swarf_surface *surface, size_t moves, const swarf_surface_lines *lines,
                                          const swarf_progress *progress, swarf_surface_point *out);

/** Move points along their lines onto the nearest zero of the surface after its first `moves`; where there is none they
 *  stay, with move -2 and the line's direction as normal. All cores. */
SWARF_API swarf_status swarf_surface_refine(const swarf_surface *surface, size_t moves,
                                            const swarf_surface_lines *lines, const swarf_progress *progress,
                                            const swarf_surface_feet *out);

#ifdef __cplusplus
}
#endif
#endif
