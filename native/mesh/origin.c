/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What made the triangles of a mesh. */
#include "base/status.h"
#include "surface/surface.h"
#include "swarf/mesh.h"

#include <math.h>
#include <stdlib.h>

/* Shares of a triangle's corners in the place where it is looked at. Near the middle, and irrational: the middle itself
 * of corners with round coordinates often lies just on an edge of a cutter in one of its passes (of heights 0, 0 and 15
 * on that of a pass at 5), where faces tie that are not the triangle's. */
static const double shares[3] = {0.36787944117144233, 0.31830988618379067, 0.313810672644767}; /* 1/e, 1/pi, the rest */

/* About the middle and direction of the normal of a triangle; up for one without area. */
static void describe(const swarf_triangles *t, size_t triangle, double point[3], double direction[3])
{
    double u[3], v[3];
    for (size_t k = 0; k < 3; k++) {
        double p[3];
        for (size_t i = 0; i < 3; i++) p[i] = (double)t->xyz[3 * (size_t)t->index[3 * triangle + i] + k];
        point[k] = shares[0] * p[0] + shares[1] * p[1] + shares[2] * p[2];
        u[k] = p[1] - p[0];
        v[k] = p[2] - p[0];
    }
    for (int k = 0; k < 3; k++) direction[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0) direction[2] = 1;
}

swarf_status swarf_mesh_origins(const swarf_mesh *mesh, const swarf_surface *surface, size_t moves, double reach_mm,
                                const swarf_progress *progress, swarf_surface_point *out)
{
    SWARF_REQUIRE(mesh && surface && out, "mesh: NULL");
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    double *points = malloc((6 * t.triangle_count + 1) * sizeof *points),
           *directions = points ? points + 3 * t.triangle_count : NULL;
    if (!points) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", t.triangle_count);
    for (size_t i = 0; i < t.triangle_count; i++) describe(&t, i, points + 3 * i, directions + 3 * i);
    const swarf_surface_lines lines = {points, directions, t.triangle_count, reach_mm == 0 ? surface->voxel : reach_mm};
    const swarf_status status = swarf_surface_find(surface, moves, &lines, progress, out);
    free(points);
    return status;
}
