/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The exact surface within a block, part by part. */
#include "base/status.h"
#include "mesh/contour.h"
#include "surface/surface.h"

/* Cells along an edge of a part, and of its own parts. */
enum { PART = 4, SMALL = 2 };
/* The points of a cell soon have looked at fewer traces. */
enum { MANY = 10 };
/* Steps onto the surface lead this far (in voxels) out of a cell. */
static const double around = 0.25;

static swarf_box box_of(const contour_near *near, const int at[3], int edge)
{
    const swarf_tree_layout *layout = near->work->layout;
    swarf_box box;
    for (int k = 0; k < 3; k++) {
        const int32_t first = near->block->ijk[k] + at[k] / edge * edge;
        box.lo[k] = layout->origin[k] + (first - around) * layout->voxel;
        box.hi[k] = layout->origin[k] + (first + edge + around) * layout->voxel;
    }
    return box;
}

static int part_of(const int at[3], int edge)
{
    const int along = SWARF_LEAF_DIM / edge;
    return (at[0] / edge * along + at[1] / edge) * along + at[2] / edge;
}

/* What may be in the block, once. */
static swarf_status collect(contour_near *near)
{
    static const int corner[3] = {0, 0, 0};
    if (near->all) return SWARF_OK;
    const swarf_box box = box_of(near, corner, SWARF_LEAF_DIM);
    swarf_surface_near *all;
    SWARF_TRY(swarf_surface_near_create(near->work->surface, &all));
    const swarf_status status = swarf_surface_collect(all, near->work->moves, &box);
    if (status == SWARF_OK)
        near->all = all;
    else
        swarf_surface_near_destroy(all);
    return status;
}

swarf_status swarf_contour_near_get(contour_near *near, const int at[3], const swarf_surface_near **out)
{
    *out = NULL;
    const contour *work = near->work;
    if (!work->surface) return SWARF_OK;
    swarf_surface_near **part = &near->part[part_of(at, PART)];
    if (!*part) {
        SWARF_TRY(collect(near));
        const swarf_box box = box_of(near, at, PART);
        SWARF_TRY(swarf_surface_near_create(work->surface, part));
        SWARF_TRY(swarf_surface_narrow(*part, near->all, &box));
    }
    *out = *part;
    return SWARF_OK;
}

swarf_status swarf_contour_near_narrow(contour_near *near, const int at[3], const swarf_surface_near **io)
{
    if (!*io || *io == near->small[part_of(at, SMALL)] || swarf_surface_near_count(*io) < MANY) return SWARF_OK;
    swarf_surface_near **small = &near->small[part_of(at, SMALL)];
    if (!*small) {
        const swarf_box box = box_of(near, at, SMALL);
        SWARF_TRY(swarf_surface_near_create(near->work->surface, small));
        SWARF_TRY(swarf_surface_narrow(*small, *io, &box));
    }
    *io = *small;
    return SWARF_OK;
}

swarf_status swarf_contour_near_wide(contour_near *near, const int at[3], const swarf_surface_near **out)
{
    const swarf_tree_layout *layout = near->work->layout;
    swarf_box box;
    for (int k = 0; k < 3; k++) {
        box.lo[k] = layout->origin[k] + (near->block->ijk[k] + at[k] - 1 - around) * layout->voxel;
        box.hi[k] = layout->origin[k] + (near->block->ijk[k] + at[k] + 2 + around) * layout->voxel;
    }
    if (!near->wide) SWARF_TRY(swarf_surface_near_create(near->work->surface, &near->wide));
    SWARF_TRY(swarf_surface_gather(near->wide, near->work->moves, &box));
    *out = near->wide;
    return SWARF_OK;
}

void swarf_contour_near_free(contour_near *near)
{
    swarf_surface_near_destroy(near->all);
    swarf_surface_near_destroy(near->wide);
    for (int i = 0; i < 8; i++) swarf_surface_near_destroy(near->part[i]);
    for (int i = 0; i < 64; i++) swarf_surface_near_destroy(near->small[i]);
}
