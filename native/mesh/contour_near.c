/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The exact surface within a block, part by part. */
#include "base/status.h"
#include "mesh/contour.h"

/* Cells along an edge of a part: half a block. */
enum { PART = 4 };
/* Steps onto the surface lead this far (in voxels) out of a cell. */
static const double around = 0.25;

swarf_status swarf_contour_near_get(contour_near *near, const int at[3], const swarf_surface_near **out)
{
    *out = NULL;
    const contour *work = near->work;
    if (!work->surface) return SWARF_OK;
    swarf_surface_near **part = &near->part[at[0] / PART * 4 + at[1] / PART * 2 + at[2] / PART];
    if (!*part) {
        swarf_box box;
        for (int k = 0; k < 3; k++) {
            const int32_t first = near->block->ijk[k] + at[k] / PART * PART, end = first + PART;
            box.lo[k] = work->layout->origin[k] + (first - around) * work->layout->voxel;
            box.hi[k] = work->layout->origin[k] + (end + around) * work->layout->voxel;
        }
        SWARF_TRY(swarf_surface_near_create(work->surface, part));
        SWARF_TRY(swarf_surface_gather(*part, work->moves, &box));
    }
    *out = *part;
    return SWARF_OK;
}

void swarf_contour_near_free(contour_near *near)
{
    for (int i = 0; i < 8; i++) swarf_surface_near_destroy(near->part[i]);
}
