/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Inside of a solid, for the rooms that measure against it. */
#ifndef SWARF_SOLID_SOLID_H
#define SWARF_SOLID_SOLID_H

#include "solid/nearby.h"
#include "swarf/solid.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What is known of a triangle that bounds the solid. */
enum {
    SOLID_PLAIN = 0, /* as it was given */
    SOLID_PIECE =
        1, /* cut from one that crosses or touches others: its normal tells a side, its edges and corners none */
    SOLID_SLIVER = 2 /* a piece too thin for its normal to tell anything */
};

struct swarf_solid {
    int references; /* only by atomic operations */
    swarf_solid_facts facts;
    size_t source_count; /* of the triangles given */
    /* the triangles that bound it, by place in their tree */
    swarf_box_tree tree;
    swarf_corners *corners;
    uint32_t *source;      /* number in the triangles given */
    uint32_t (*vertex)[3]; /* numbers of the corners; of pieces those of the triangle they are cut from */
    uint32_t (*across)[3]; /* place beyond edge k, UINT32_MAX where there is not just one */
    uint8_t *state;
    int open; /* there are holes: normals tell no sign */
    /* by vertex */
    size_t vertex_count;
    float (*normal)[3]; /* weighted by the angles of the triangles there; zero where it tells no sign */
    /* all triangles, for the winding number: the same memory as above where all of them bound the solid */
    swarf_box_tree all;
    swarf_corners *all_corners;
};

/** swarf_solid_create() with holes of at most this share of the area (0: none), as a part of a longer work. */
swarf_status swarf_solid_make(const swarf_triangles *triangles, double hole_share, const swarf_progress *progress,
                              double from, double to, swarf_solid **out);

/** Points that are best measured at a time. */
enum { SOLID_BATCH = 1024 };

/** Signed distances of points and the places of their closest triangles: quicker where a point is near the last. Any
 *  thread. */
void swarf_solid_measure(const swarf_solid *solid, const double (*point)[3], size_t count, double *distance,
                         size_t *place);
/** By the winding number: slower than by the closest triangle, and needs nothing to be near. Any thread. */
int swarf_solid_inside(const swarf_solid *solid, const double point[3]);

/** The closest point that bounds the solid; place SIZE_MAX when it is farther than `reach`, never with INFINITY. */
void swarf_solid_nearest(const swarf_solid *solid, const double point[3], double reach, swarf_nearest *out);
/** Sign (+1 outside, -1 inside) of a point whose closest feature this is; asks the winding number where need be. */
double swarf_solid_sign(const swarf_solid *solid, const double point[3], const swarf_nearest *nearest);
/** Twice the area times the unit normal of a triangle. */
static inline void swarf_corners_normal(const swarf_corners *t, double out[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)t->xyz[1][k] - t->xyz[0][k];
        v[k] = (double)t->xyz[2][k] - t->xyz[0][k];
    }
    for (int k = 0; k < 3; k++) out[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
}

/** Leave only what bounds the solid in its tree: cut what crosses or touches, drop what lies inside (bounds.c). */
swarf_status swarf_solid_find_bounds(swarf_solid *solid, const swarf_progress *progress, double from, double to);

#ifdef __cplusplus
}
#endif
#endif
