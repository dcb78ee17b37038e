/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Splitting edges of facets where they leave the exact surface: what its files share. */
#ifndef SWARF_MESH_CREASE_H
#define SWARF_MESH_CREASE_H

#include "mesh/contour.h"
#include "surface/surface.h"

/** An edge from its lesser to its greater vertex, and the facet it is of. */
typedef struct crease_edge {
    uint32_t v[2];
    uint32_t facet;
    uint32_t corner; /* where it starts in the facet */
} crease_edge;

/** What comes of an edge: its ends, the facets' other corners. */
typedef struct crease_split {
    float corners[12];
    float point[3]; /* where it is split, if it is made */
    float off;      /* how far the surface is from it, in voxels */
    uint8_t made;
} crease_split;

/** Edges to be split. */
typedef struct crease_splits {
    const contour *work;
    const swarf_facets *facets;
    const swarf_crease_memo *memo;
    crease_edge *edges; /* of two facets each, one after the other */
    crease_split *split;
    size_t count; /* of pairs */
} crease_splits;

/** That of an edge with these corners; NULL: it is not known. */
const crease_split *swarf_crease_recall(const swarf_crease_memo *memo, const float corners[12]);
swarf_status swarf_crease_remember(swarf_crease_memo *memo, const crease_split *splits, size_t count);

/** The surface near one place after the other, by one thread. */
typedef struct crease_look {
    const contour *work;
    swarf_surface_near *near;
    int64_t cube[3]; /* what was gathered is about it */
    int held;        /* 1: there is such a cube */
} crease_look;

/** Pairs, or facets, that one thread goes through with what it gathered. */
enum { SWARF_CREASE_CHUNK = 256 };

swarf_status swarf_crease_look_begin(const contour *work, crease_look *out);
void swarf_crease_look_end(crease_look *look);
/** Gather what matters in a box: what is gathered depends on the box alone, and is gathered once for those that follow
 *  each other and lie in one cube. */
swarf_status swarf_crease_look_into(crease_look *look, const swarf_box *box);
/** Value at a point of the box, in voxels. */
double swarf_crease_look_at(const crease_look *look, const double x[3], swarf_surface_point *found);
/** The cube about a point, or the one so many beside it, as a number, not 0, by which those of one cube follow each
 *  other. */
uint64_t swarf_crease_cube(const contour *work, const double x[3], int beside_x, int beside_y, int beside_z);

static inline void swarf_crease_place(const swarf_facets *facets, uint32_t v, double out[3])
{
    for (size_t k = 0; k < 3; k++) out[k] = (double)facets->xyz[3 * (size_t)v + k];
}

static inline double swarf_crease_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** A facet one to three edges of which are split. */
typedef struct crease_cut {
    uint64_t cube;
    uint32_t facet;
    uint32_t at[3];  /* pairs that split its edges, UINT32_MAX: none */
    uint8_t waiting; /* it is to be cut, again */
    uint8_t fresh;   /* it is not known that its parts, or itself without any, cut no others */
    uint8_t parts;   /* it becomes; 0: they turn over, or it is not split */
    swarf_facet part[4];
} crease_cut;

/** Points on split edges are there as vertices after the others, by the number of the pair. */
typedef struct crease_cuts {
    crease_cut *cut;
    size_t count;
    size_t pair_count;
} crease_cuts;

/** The facets near those that are cut, without these; *out is freed by the caller. */
swarf_status swarf_crease_near(const contour *work, const swarf_facets *facets, const crease_cuts *cuts, uint32_t **out,
                               size_t *count);
/** Sets crossed[] of the cuts with a part that cuts another or one of the facets near, as far as they are fresh.
 *  Progress is reported from `from` to 1. */
swarf_status swarf_crease_find_crossed(const swarf_facets *facets, const crease_cuts *cuts, const uint32_t *near,
                                       size_t near_count, const swarf_progress *progress, double from,
                                       uint8_t *crossed);

/** Put the splits into the facets, less those by which a part of a facet would turn over or cut another. Progress is
 *  reported from `from` to 1. `*marks` (NULL: none) grow with the vertices; *changed: the facets that were cut and
 *  their parts, freed by the caller; *made: splits of this band. */
swarf_status swarf_crease_cut(crease_splits *splits, swarf_facets *facets, uint8_t **marks,
                              const swarf_progress *progress, double from, uint32_t **changed, size_t *changed_count,
                              size_t *made);

#endif
