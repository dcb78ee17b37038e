/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Distances at single points, through the kernels that cut. */
#include "sweep/distance.h"
#include "base/status.h"
#include "cutter/cutter.h"
#include "swarf/sweep.h"
#include "sweep/kernel.h"

#include <math.h>
#include <stdlib.h>

swarf_status swarf_distance_at(const swarf_body *body, const swarf_track *tracks, size_t count, const double point[3],
                               swarf_column *column, float *out)
{
    const swarf_kernel *kernel = swarf_kernel_current();
    SWARF_TRY(swarf_column_fill(column, point, tracks, NULL, count));
    /* as in a leaf, tracks beyond the band are left out and one that covers the point settles it */
    const swarf_block here = {0, 0, 0, 0, 0};
    size_t near = 0;
    *out = SWARF_HALF_WIDTH;
    if (kernel->cull(body, column, column->list[LIST_ALL], column->count, &here, 1, &column->list[LIST_CUBE], &near))
        *out = -SWARF_HALF_WIDTH;
    else if (near)
        *out = kernel->distance(body, column, column->list[LIST_CUBE], near);
    return SWARF_OK;
}

static swarf_status measure(const swarf_body *body, const swarf_track_list *list, swarf_column *column, double voxel,
                            const double *points, size_t count, float *out)
{
    for (size_t i = 0; i < count; i++) {
        double point[3];
        float found;
        for (int k = 0; k < 3; k++) {
            SWARF_REQUIRE(isfinite(points[3 * i + (size_t)k]), "sweep: coordinate %c of point %zu is not finite",
                          "xyz"[k], i);
            point[k] = points[3 * i + (size_t)k] / voxel;
        }
        SWARF_TRY(swarf_distance_at(body, list->tracks, list->count, point, column, &found));
        out[i] = found * (float)voxel;
    }
    return SWARF_OK;
}

swarf_status swarf_sweep_distance(const swarf_cutter *cutter, swarf_part_kind kind, const swarf_path *path,
                                  double voxel_mm, const double *points, size_t count, float *out)
{
    SWARF_REQUIRE(cutter && path && (count == 0 || (points && out)), "sweep: NULL");
    SWARF_REQUIRE(isfinite(voxel_mm) && voxel_mm > 0, "sweep: voxel size %g mm is not a positive number", voxel_mm);
    static const double origin[3] = {0, 0, 0};
    swarf_body *body = NULL;
    swarf_track_list list = {0};
    swarf_column column = {.room = 0};
    swarf_status status = swarf_body_create(cutter, kind, voxel_mm, &body);
    if (status == SWARF_OK) status = swarf_track_append(&list, path, origin, voxel_mm);
    if (status == SWARF_OK) status = measure(body, &list, &column, voxel_mm, points, count, out);
    swarf_column_free(&column);
    free(list.tracks);
    swarf_body_destroy(body);
    return status;
}
