/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Vertices of cells about which the field is flat: the middle of their crossings, once a look at the exact surface, if
 * there is one, has found the plane of the face there. Each plane is looked for once in a block. */
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
    const double away = n[0] * (point[0] - o[0]) + n[1] * (point[1] - o[1]) + n[2] * (point[2] - o[2]);
    return fabs(away) <= same_plane && dot(n, normal) >= same_plane_cosine;
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

/* Whether a plane of the block that is known passes there. */
static int is_known(const contour_flats *flats, const double point[3], const double normal[3])
{
    for (int i = 0; i < flats->count; i++)
        if (is_plane(&flats->plane[i], point, normal)) return 1;
    return 0;
}

/* Look for the plane on the exact surface. */
static swarf_status look_for(contour_flats *flats, contour_near *near, const int at[3], const contour_polygon *polygon,
                             const double middle[3], int *found)
{
    const swarf_surface_near *surface;
    swarf_surface_point seen;
    contour_plane plane;
    double world[3], point[3];
    SWARF_TRY(swarf_contour_near_get(near, at, &surface));
    for (int k = 0; k < 3; k++) world[k] = polygon->origin[k] + middle[k] * polygon->voxel;
    swarf_surface_evaluate(surface, world, &seen);
    for (int k = 0; k < 3; k++) {
        point[k] = at[k] + middle[k];
        plane.normal[k] = seen.normal[k];
        plane.point[k] = point[k] - seen.value / polygon->voxel * seen.normal[k];
    }
    *found = is_plane(&plane, point, polygon->normal[0]);
    if (*found && flats->count < SWARF_CONTOUR_FLATS) flats->plane[flats->count++] = plane;
    return SWARF_OK;
}

swarf_status swarf_contour_vertex_flat(contour_flats *flats, contour_near *near, const int at[3],
                                       const contour_polygon *polygon, double out[3], int *flat)
{
    double middle[3];
    swarf_contour_middle(polygon, middle);
    *flat = is_flat(polygon, middle);
    if (*flat && near->work->surface) {
        const double point[3] = {at[0] + middle[0], at[1] + middle[1], at[2] + middle[2]};
        if (!is_known(flats, point, polygon->normal[0])) SWARF_TRY(look_for(flats, near, at, polygon, middle, flat));
    }
    if (!*flat) return SWARF_OK;
    memcpy(out, middle, sizeof middle);
    swarf_contour_clamp(&polygon->bounds, out);
    return SWARF_OK;
}
