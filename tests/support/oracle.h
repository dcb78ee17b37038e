/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Oracle: an independent reference for sweeps, in double, slow and simple.
 *
 * It shares no formula with native/sweep: the signed distance of a point to a body of revolution is 1-Lipschitz, so its
 * least value over time along any path can be bracketed from samples alone. Everything here follows from that, from
 * the distance to line and arc edges, and from the position of the tool at a time.
 */
#ifndef SWARF_TEST_ORACLE_H
#define SWARF_TEST_ORACLE_H

#include "swarf/swarf.h"
#include "test.h"

/** An edge of a meridian: a line, or (radius > 0) an arc from `from` to `to`. */
typedef struct oracle_edge {
    double from[2];
    double to[2];
    double centre[2];
    double radius;
    double start_rad; /* of the arc, about its centre */
    double turn_rad;  /* signed */
} oracle_edge;

/** The meridians of all parts of one kind; at most 64 edges and 8 parts. */
typedef struct oracle_body {
    oracle_edge edge[64];
    int part_begin[9];
    int parts;
    double radius; /* greatest */
    double z_lo;
    double z_hi;
} oracle_body;

/** Take the parts of a kind; exits when there are none or too many (a broken test). */
oracle_body oracle_body_of(const swarf_cutter *cutter, swarf_part_kind kind);
/** One part from its nodes. */
oracle_body oracle_body_from(const swarf_profile_node *nodes, size_t count);

/** Signed distance in the half plane, r >= 0, exact; negative inside. */
double oracle_meridian(const oracle_body *body, double r, double z);
/** Greatest radius inside the body at a height (by its edges), 0 outside. */
double oracle_radius_at(const oracle_body *body, double z);
/** Area of the meridian in the half plane, and volume of its revolution, both integrated numerically. */
double oracle_meridian_area(const oracle_body *body);
double oracle_volume(const oracle_body *body);

/** Tool tip at t in 0..1, from the definition of swarf_path and swarf_arc. */
void oracle_tip(const swarf_path *path, double t, double out[3]);
double oracle_length(const swarf_path *path);
/** Signed distance to the tool standing at t. */
double oracle_at(const oracle_body *body, const swarf_path *path, const double point[3], double t);

/** Proven sign of the sweep at a point: -1 when the least distance over time is below -tolerance, +1 when it is above
 *  +tolerance, 0 when it lies between. The tolerance is in mm and positive. */
int oracle_sign(const oracle_body *body, const swarf_path *path, const double point[3], double tolerance);
/** Least distance over time, refined from samples finer than the body's features (not proven, good to 1e-9 mm). Outside
 *  the sweep it is the Euclidean distance to it. */
double oracle_distance(const oracle_body *body, const swarf_path *path, const double point[3]);

/** The same for a flute that stands on the tip, quickly: level motions in closed form, as a cutter's distance never
 *  falls with the plan distance from its axis, and farther than 0.7 mm (0.1 mm from a plunge) no more than a bound. */
double oracle_swept(const oracle_body *body, const swarf_path *path, const double point[3]);

/** Gradient of the distance, by test_gradient(); its length. */
double oracle_gradient(const oracle_body *body, const swarf_path *path, const double point[3], double step,
                       double out[3]);

/** Is the sweep's surface smooth for 1.5 voxels around the foot of a point at this distance? (It bends away from its
 *  tangent plane by at most 0.15 voxels there, and no second surface comes near.) */
int oracle_is_smooth(const oracle_body *body, const swarf_path *path, const double point[3], double distance,
                     double voxel);

/** A point near the surface of the sweep: half of them on the envelope, the rest on the tool at any time and at the
 *  path's ends; moved by up to `spread` mm along each axis. */
void oracle_random_point(const oracle_body *body, const swarf_path *path, double spread, test_random *random,
                         double out[3]);

/** Paths. The arc turns by angle_rad about the plane's normal and advances by `rise` along it. */
swarf_path oracle_line(double x0, double y0, double z0, double x1, double y1, double z1);
swarf_path oracle_arc(const double start[3], const double centre[3], swarf_plane plane, double angle_rad, double rise);

/** Print what it takes to repeat one evaluation. */
void oracle_print(FILE *stream, const char *cutter, const swarf_path *path, double voxel_mm, const double point[3]);

#endif
