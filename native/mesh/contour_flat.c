/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Vertices of cells about which the field is flat: the middle of their crossings, if the exact surface, where there is
 * one, has the same plane there. */
#include "base/status.h"
#include "base/vector.h"
#include "mesh/contour.h"
#include "surface/surface.h"

#include <math.h>
#include <string.h>

/* In voxels: planes of crossings on one flat face pass each other's crossings this close, and the exact surface the
 * vertex; and the cosine between their normals, for 0.3 degrees. */
static const double same_plane = 1e-3, same_plane_cosine = 0.999986;

/* Whether the field is flat round all crossings, and these on one plane. */
static int is_flat(const contour_polygon *polygon, const double middle[3])
{
    const double *n = polygon->normal[0];
    for (int i = 0; i < polygon->count; i++)
        if (polygon->move[i] != SWARF_BY_FLAT_FIELD ||
            fabs(vector_dot(n, polygon->point[i]) - vector_dot(n, middle)) > same_plane ||
            vector_dot(n, polygon->normal[i]) < same_plane_cosine)
            return 0;
    return 1;
}

/* Whether the exact surface has the plane there: grooves between voxels may be too narrow for the field to show. */
static int is_on(const swarf_surface_near *surface, const contour_polygon *polygon, const double middle[3])
{
    swarf_surface_point seen;
    double world[3];
    for (int k = 0; k < 3; k++) world[k] = polygon->origin[k] + middle[k] * polygon->voxel;
    swarf_surface_evaluate(surface, world, &seen);
    return fabs(seen.value) <= same_plane * polygon->voxel &&
           vector_dot(seen.normal, polygon->normal[0]) >= same_plane_cosine;
}

swarf_status swarf_contour_vertex_flat(contour_near *near, const int at[3], const contour_polygon *polygon,
                                       double out[3], int *flat)
{
    double middle[3];
    swarf_contour_middle(polygon, middle);
    *flat = is_flat(polygon, middle);
    if (!*flat) return SWARF_OK;
    const swarf_surface_near *surface;
    SWARF_TRY(swarf_contour_near_get(near, at, &surface));
    *flat = !surface || is_on(surface, polygon, middle);
    if (!*flat) return SWARF_OK;
    memcpy(out, middle, sizeof middle);
    swarf_contour_clamp(&polygon->bounds, out);
    return SWARF_OK;
}
