/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Vertices of cells about which the field is flat: the middle of their crossings, if the exact surface, where there is
 * one, has the same plane there. */
#include "base/status.h"
#include "mesh/contour.h"
#include "surface/surface.h"

#include <math.h>
#include <string.h>

/* In voxels: planes of crossings on one flat face pass each other's crossings this close, and the exact surface the
 * vertex; and the cosine between their normals, for 0.3 degrees. */
static const double same_plane = 1e-3, same_plane_cosine = 0.999986;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Whether a plane passes a point (in voxels) and is turned as the normal there. */
static int is_plane(const contour_plane *plane, const double point[3], const double normal[3])
{
    const double *n = plane->normal, *o = plane->point;
    return fabs(dot(n, point) - dot(n, o)) <= same_plane && dot(n, normal) >= same_plane_cosine;
}

/* Whether the field is flat round all crossings, and these on one plane. */
static int is_flat(const contour_polygon *polygon, const double middle[3])
{
    contour_plane plane;
    memcpy(plane.point, middle, sizeof plane.point);
    memcpy(plane.normal, polygon->normal[0], sizeof plane.normal);
    for (int i = 0; i < polygon->count; i++)
        if (polygon->move[i] != SWARF_BY_FLAT_FIELD || !is_plane(&plane, polygon->point[i], polygon->normal[i]))
            return 0;
    return 1;
}

/* Look for the plane on the exact surface: a groove between voxels that is narrow enough the field does not show. */
static swarf_status look_for(contour_near *near, const int at[3], const contour_polygon *polygon,
                             const double middle[3], int *found)
{
    const swarf_surface_near *surface;
    swarf_surface_point seen;
    contour_plane plane;
    double world[3];
    SWARF_TRY(swarf_contour_near_get(near, at, &surface));
    for (int k = 0; k < 3; k++) world[k] = polygon->origin[k] + middle[k] * polygon->voxel;
    swarf_surface_evaluate(surface, world, &seen);
    for (int k = 0; k < 3; k++) {
        plane.normal[k] = seen.normal[k];
        plane.point[k] = middle[k] - seen.value / polygon->voxel * seen.normal[k];
    }
    *found = is_plane(&plane, middle, polygon->normal[0]);
    return SWARF_OK;
}

swarf_status swarf_contour_vertex_flat(contour_near *near, const int at[3], const contour_polygon *polygon,
                                       double out[3], int *flat)
{
    double middle[3];
    swarf_contour_middle(polygon, middle);
    *flat = is_flat(polygon, middle);
    if (*flat && near->work->surface) SWARF_TRY(look_for(near, at, polygon, middle, flat));
    if (!*flat) return SWARF_OK;
    memcpy(out, middle, sizeof middle);
    swarf_contour_clamp(&polygon->bounds, out);
    return SWARF_OK;
}
