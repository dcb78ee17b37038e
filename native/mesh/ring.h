/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The facets round a vertex, and what it takes to draw it onto one of its neighbours: one table of functions per
 * instruction set. All variants do the same operations in the same order, without contraction: what they find is the
 * same bits.
 *
 * Coordinates are relative to the vertex: those are small, so that doubles lose nothing. Of each there is an array per
 * axis, so that several facets or neighbours are looked at in one go. */
#ifndef SWARF_MESH_RING_H
#define SWARF_MESH_RING_H

#include <math.h>
#include <stdint.h>

/** Facets round a vertex that is looked at; hubs with more stay. And room for the first again after the last, and for
 *  whole registers read from any of them. */
enum { RING_MOST = 32, RING_ROOM = RING_MOST + 8 };

/** Flat rings, of which there are most: their true normals (of length 32767) differ by this. */
static const double ring_flat_normal = 8;

typedef struct ring {
    int count;
    uint32_t vertex[RING_MOST]; /* facet i: the middle, vertex i, vertex i + 1 */
    uint32_t facet[RING_MOST];
    uint32_t crease; /* bit i: whether the edge to vertex i is one of the surface */
    double error;    /* greatest of the facets */
    double shape;    /* least squared shape of the facets; negative: not measured yet */
    double slab;     /* of a flat ring: half of its thickness, across the true normal; else negative */
    _Alignas(64) double at[3][RING_ROOM];
    _Alignas(64) double true_normal[3][RING_ROOM];
    _Alignas(64) double normal[3][RING_ROOM]; /* of facet i with its old place, not unit */
    /* of rings that are not flat: */
    _Alignas(64) double dots[RING_MOST][RING_MOST]; /* of at[i] and at[k] */
    /* how far the middle lies from the new facet that comes to lie over it when it is drawn onto vertex i; 0 when it
     * lies over none. This alone rules out most of what is looked at on curved faces. */
    _Alignas(64) double lift[RING_ROOM];
} ring;

/** Of several choices the best has the best worst facet, and little error. `shape` is squared. */
static const double ring_score_error = 0.95;

static inline double ring_score(double shape, double error, double limit)
{
    return sqrt(shape) * (1 - ring_score_error * error / limit);
}

static inline int ring_before(const ring *around, int j)
{
    return (j ? j : around->count) - 1;
}

static inline int ring_after(const ring *around, int j)
{
    return j + 1 < around->count ? j + 1 : 0;
}

typedef struct ring_kernel {
    /** The edges of the surface, for `crease`. */
    uint32_t (*find_creases)(const ring *around);

    /** Find `normal` from `at`, and whether the ring is flat: whether all facets have one true normal and the vertices
     *  lie in one plane across it, as near as the limit (mm) of the error allows. */
    void (*look_flat)(ring *around, double limit);

    /** Find `dots`. */
    void (*find_dots)(ring *around);

    /** Find `lift`. Returns a bit for each vertex that it leaves within the limit (mm), and the least error of the
     *  others, infinite without one. */
    uint32_t (*find_lifts)(ring *around, double limit, double *least);

    /** Error and score of drawing the middle onto vertex j; 0 when the error is too much, a facet turns or becomes a
     *  needle, or the score is not above `least`: the error is then a lower bound of what it takes. */
    int (*try_draw)(ring *around, int j, double limit, double least, double *error, double *score);
} ring_kernel;

extern const ring_kernel swarf_ring_kernel_scalar, swarf_ring_kernel_avx2, swarf_ring_kernel_avx512;

/** The one of the instruction set in use. Any thread. */
const ring_kernel *swarf_ring_kernel_current(void);

#endif
