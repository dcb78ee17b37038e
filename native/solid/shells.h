/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Triangles checked and taken apart into the closed shells they are made of. */
#ifndef SWARF_SOLID_SHELLS_H
#define SWARF_SOLID_SHELLS_H

#include "swarf/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Shells in the order in which they are to be united (solids) or taken away (cavities): the larger first, so that a
 *  solid inside a cavity inside a solid comes out right. Neighbours of one kind are one run. */
typedef struct swarf_shell_run {
    size_t first; /* triangle */
    size_t count;
    int cavity;
} swarf_shell_run;

typedef struct swarf_shells {
    float *xyz; /* welded */
    size_t vertex_count;
    uint32_t *index;  /* by run; without repeated vertices, duplicates or pairs of opposite faces */
    uint32_t *source; /* number each triangle had */
    uint32_t
        *across; /* per edge, from corner k to the next: the triangle beyond it, UINT32_MAX unless there is just one */
    size_t triangle_count;
    swarf_shell_run *runs;
    size_t run_count;
    double volume_mm3; /* signed, of all triangles */
    double area_mm2;
    swarf_box box;
    size_t open_edges, turned_edges; /* 0 unless holes were allowed */
    double hole_mm2;                 /* greatest area that the open and turned edges can enclose */
} swarf_shells;

/** Weld, clean, check and split. SWARF_ERROR_GEOMETRY: open or turned edges (how many, where the first lies), inside
 *  out, no volume, a cavity in no solid. With a hole_share above 0 open and turned edges pass as long as the holes they
 *  can bound have at most this share of the area; then everything is one run.
 *  SWARF_ERROR_ARGUMENT as swarf_triangles_topology(). Any thread. */
swarf_status swarf_shells_create(const swarf_triangles *triangles, double hole_share, swarf_shells *out);
void swarf_shells_free(swarf_shells *shells);

#ifdef __cplusplus
}
#endif
#endif
