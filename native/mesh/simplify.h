/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Simplifying one region of a surface, and the geometry it needs. */
#ifndef SWARF_MESH_SIMPLIFY_H
#define SWARF_MESH_SIMPLIFY_H

#include "mesh/facets.h"

/** Stands for a vertex of another region, and for the end of a list. */
#define SWARF_NO_VERTEX UINT32_MAX

/** A facet of a region, together in memory with all that is asked of it. */
typedef struct simplify_facet {
    uint32_t v[3];    /* the region's numbers */
    uint32_t next[3]; /* the next corner of the same vertex */
    uint32_t global;  /* its number in the whole mesh */
    float error_mm;
    float lost_mm3;
    int16_t normal[3];
    uint8_t alive;
} simplify_facet;

/** A corner is named by facet * 4 + k. A region: its own vertices, the facets that lie in it wholly (which it may
 *  change) and those that reach out of it. Only vertices whose facets all lie in the region may go. */
typedef struct simplify_region {
    double *xyz;      /* of the region's vertices */
    uint32_t *global; /* their numbers in the whole mesh */
    uint32_t *head;   /* first corner of each vertex's list */
    uint8_t *state;   /* SIMPLIFY_FIXED, SIMPLIFY_DIRTY, SIMPLIFY_BENT */
    uint32_t *mark;   /* of vertices on the ring being looked at: its stamp + the place in it */
    float *need; /* error below which a vertex cannot go, as far as is known, 0 at first; INFINITY: whatever it is */
    size_t vertex_count;
    simplify_facet *facet;
    size_t facet_count;
    size_t owned_count; /* the first ones lie in the region wholly */
    size_t room;        /* facets that there is memory for */
    uint32_t stamp;
} simplify_region;

/** May not go; may go at a later attempt, not settled; the true normals of its facets differ, so that it need not be
 *  looked at with the flat ones. */
enum { SIMPLIFY_FIXED = 1, SIMPLIFY_DIRTY = 2, SIMPLIFY_BENT = 4 };

/** Remove vertices while the error stays below `limit` (mm).
 *  `first`: the limit is new, so that all vertices are looked at; else only those that `need` no more. */
void swarf_simplify_region(simplify_region *region, double limit, int first);

#endif
