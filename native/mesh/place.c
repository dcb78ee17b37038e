/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A stock in its next set-up. Quarter turns move voxels and lose nothing. Any other turn, and another voxel size, goes
 * by the mesh where the exact surface is known: its vertices are turned, and the new voxels get their exact distance to
 * it, so that edges stay edges. Else new voxels are made from the old ones, but for larger ones, whose band is wider
 * than what the old ones know. */
#include "swarf/place.h"
#include "base/parallel.h"
#include "base/placement.h"
#include "base/status.h"
#include "mesh/mesh.h"
#include "stock/resample.h"
#include "stock/turn.h"

#include <math.h>
#include <stdlib.h>

/* Vertices are left out up to this part of a voxel: as much as the mesh itself is off, and far fewer triangles. The
 * mesh of the field alone does not know all edges as well, so that it may cost faces a little more. */
static const double mesh_error = 0.01, field_error = 0.04;

swarf_place_options swarf_place_options_default(void)
{
    return (swarf_place_options){.size = sizeof(swarf_place_options)};
}

swarf_status swarf_mesh_create_placed(const swarf_mesh *mesh, const swarf_placement *placement, swarf_mesh **out)
{
    SWARF_REQUIRE(mesh && placement && out, "mesh: NULL");
    SWARF_TRY(swarf_placement_check(placement));
    swarf_triangles t = swarf_mesh_triangles(mesh);
    float *xyz = malloc((3 * t.vertex_count + 1) * sizeof *xyz);
    if (!xyz) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu vertices", t.vertex_count);
    for (size_t i = 0; i < t.vertex_count; i++) {
        double p[3] = {(double)t.xyz[3 * i], (double)t.xyz[3 * i + 1], (double)t.xyz[3 * i + 2]};
        swarf_placement_point(placement, p, p);
        for (size_t k = 0; k < 3; k++) xyz[3 * i + k] = (float)p[k];
    }
    t.xyz = xyz;
    const swarf_status status = swarf_mesh_create(&t, out);
    free(xyz);
    return status;
}

/* Vertices are floats: they are turned about their own middle, and the shift goes into the place of the new stock's
 * voxels, which is a double. */
static swarf_status turn_mesh(const swarf_mesh *mesh, const swarf_placement *placement, double voxel,
                              const swarf_place_options *options, const swarf_progress *filling,
                              const swarf_progress *moving, swarf_stock **out)
{
    const swarf_box box = swarf_mesh_topology(mesh).box;
    swarf_placement about = *placement, rest = swarf_placement_identity();
    double middle[3];
    for (int k = 0; k < 3; k++) middle[k] = 0.5 * (box.lo[k] + box.hi[k]);
    swarf_placement_direction(placement, middle, about.shift);
    for (int k = 0; k < 3; k++) about.shift[k] = -about.shift[k];
    swarf_placement_point(placement, middle, rest.shift);
    swarf_mesh *turned;
    SWARF_TRY(swarf_mesh_create_placed(mesh, &about, &turned));
    const swarf_triangles t = swarf_mesh_triangles(turned);
    swarf_stock_options made = swarf_stock_options_default();
    made.voxel_mm = voxel;
    made.memory_limit = options->memory_limit;
    swarf_stock *here = NULL;
    swarf_status status = swarf_stock_create_mesh(&t, &made, filling, &here);
    swarf_mesh_release(turned);
    if (status == SWARF_OK) status = swarf_stock_turn(here, &rest, options->memory_limit, moving, out);
    swarf_stock_destroy(here);
    return status;
}

static swarf_status place_by_mesh(swarf_stock *stock, const swarf_placement *placement, double voxel,
                                  const swarf_place_options *options, const swarf_progress *progress, swarf_stock **out)
{
    swarf_progress_share shares[3] = {{progress, 0, 0.5}, {progress, 0.5, 0.95}, {progress, 0.95, 1}};
    const swarf_progress contouring = swarf_progress_part(&shares[0]), filling = swarf_progress_part(&shares[1]),
                         moving = swarf_progress_part(&shares[2]);
    swarf_contour_options wanted = swarf_contour_options_default();
    wanted.error_mm = (options->surface ? mesh_error : field_error) * fmin(voxel, swarf_stock_voxel(stock));
    wanted.surface = options->surface;
    wanted.moves = options->moves;
    swarf_mesh *mesh;
    SWARF_TRY(swarf_mesh_contour(stock, &wanted, progress ? &contouring : NULL, &mesh, NULL));
    const swarf_status status =
        swarf_mesh_triangles(mesh).triangle_count
            ? turn_mesh(mesh, placement, voxel, options, progress ? &filling : NULL, progress ? &moving : NULL, out)
            : swarf_fail(SWARF_ERROR_GEOMETRY, "stock: nothing is left of it that could be set up again");
    swarf_mesh_release(mesh);
    return status;
}

swarf_status swarf_stock_place(swarf_stock *stock, const swarf_placement *placement, const swarf_place_options *options,
                               const swarf_progress *progress, swarf_stock **out, int *lossless)
{
    SWARF_REQUIRE(stock && placement && out, "stock: NULL");
    SWARF_TRY(swarf_placement_check(placement));
    const swarf_place_options none = swarf_place_options_default();
    if (!options) options = &none;
    SWARF_REQUIRE(options->size == sizeof *options, "stock: options of another version");
    const double own = swarf_stock_voxel(stock), voxel = options->voxel_mm == 0 ? own : options->voxel_mm;
    SWARF_REQUIRE(isfinite(voxel) && voxel > 0, "stock: voxel size %g mm is not a positive number", voxel);
    int axis[3], sign[3];
    const int kept = swarf_placement_quarters(placement, axis, sign) && fabs(voxel - own) <= 1e-9 * own;
    const int by_mesh = options->surface || voxel > own * (1 + 1e-9);
    swarf_stock_options made = swarf_stock_options_default();
    made.voxel_mm = voxel;
    made.memory_limit = options->memory_limit;
    SWARF_TRY(kept      ? swarf_stock_turn(stock, placement, options->memory_limit, progress, out)
              : by_mesh ? place_by_mesh(stock, placement, voxel, options, progress, out)
                        : swarf_stock_resample(stock, placement, &made, progress, out));
    if (lossless) *lossless = kept;
    return SWARF_OK;
}
