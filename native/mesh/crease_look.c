/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the exact surface can be near edges and facets that lie close to each other: gathered once for a cube. */
#include "mesh/crease.h"

#include <math.h>

/* In voxels: edge of a cube, and how far boxes of edges and facets in it reach out of it, mostly: larger ones share
 * more, and have more moves to look at. */
static const double cube_edge = 2, around = 1.5;

swarf_status swarf_crease_look_begin(const contour *work, crease_look *out)
{
    *out = (crease_look){.work = work};
    return swarf_surface_near_create(work->surface, &out->near);
}

void swarf_crease_look_end(crease_look *look)
{
    swarf_surface_near_destroy(look->near);
}

static void find_cube(const contour *work, const double x[3], int64_t cube[3])
{
    const swarf_tree_layout *layout = work->layout;
    for (int k = 0; k < 3; k++) cube[k] = (int64_t)floor((x[k] - layout->origin[k]) / (cube_edge * layout->voxel));
}

uint64_t swarf_crease_cube(const contour *work, const double x[3], int beside_x, int beside_y, int beside_z)
{
    const int beside[3] = {beside_x, beside_y, beside_z};
    int64_t cube[3];
    uint64_t number = 1;
    find_cube(work, x, cube);
    for (int k = 0; k < 3; k++) number = number << 21 | ((uint64_t)(cube[k] + beside[k] + (1 << 20)) & 0x1fffff);
    return number;
}

swarf_status swarf_crease_look_into(crease_look *look, const swarf_box *box)
{
    const swarf_tree_layout *layout = look->work->layout;
    int64_t cube[3];
    double middle[3];
    swarf_box wide;
    int fits = 1, same = look->held;
    for (int k = 0; k < 3; k++) middle[k] = 0.5 * (box->lo[k] + box->hi[k]);
    find_cube(look->work, middle, cube);
    for (int k = 0; k < 3; k++) {
        wide.lo[k] = layout->origin[k] + ((double)cube[k] * cube_edge - around) * layout->voxel;
        wide.hi[k] = layout->origin[k] + ((double)(cube[k] + 1) * cube_edge + around) * layout->voxel;
        fits &= box->lo[k] >= wide.lo[k] && box->hi[k] <= wide.hi[k];
        same &= cube[k] == look->cube[k];
    }
    if (fits && same) return SWARF_OK;
    look->held = fits;
    for (int k = 0; k < 3; k++) look->cube[k] = cube[k];
    return swarf_surface_gather(look->near, look->work->moves, fits ? &wide : box);
}

double swarf_crease_look_at(const crease_look *look, const double x[3], swarf_surface_point *found)
{
    swarf_surface_evaluate(look->near, x, found);
    return found->value / look->work->layout->voxel;
}
