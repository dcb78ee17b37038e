/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* From a stock to a mesh with sharp edges: what is asked is checked, the passes run on the whole of the stock, what
 * they made becomes a mesh. */
#include "mesh/contour.h"

#include "base/parallel.h"
#include "base/status.h"

#include <stdlib.h>
#include <string.h>

static const double farthest = 1e6; /* mm, as lengths everywhere: an error must be a float in voxels */

swarf_contour_options swarf_contour_options_default(void)
{
    return (swarf_contour_options){.size = sizeof(swarf_contour_options), .moves = SIZE_MAX};
}

static swarf_status to_mesh(swarf_facets *facets, swarf_mesh **out)
{
    const size_t count = facets->facet_count;
    swarf_mesh_data data = {.xyz = facets->xyz, .vertex_count = facets->vertex_count, .triangle_count = count};
    facets->xyz = NULL;
    data.index = malloc((3 * count + 1) * sizeof *data.index);
    if (!data.index) {
        swarf_mesh_data_free(&data);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", count);
    }
    for (size_t f = 0; f < count; f++) memcpy(data.index + 3 * f, facets->facet[f].v, sizeof facets->facet[f].v);
    return swarf_mesh_adopt(&data, out);
}

static swarf_status check_closed(const swarf_mesh *mesh)
{
    const swarf_topology topology = swarf_mesh_topology(mesh);
    if (swarf_mesh_triangles(mesh).triangle_count == 0 || (topology.closed && !topology.nonmanifold_edges))
        return SWARF_OK;
    return swarf_fail(SWARF_ERROR_GEOMETRY,
                      "mesh: the surface is not closed (%zu open edges): the level set is cut off at its border or is "
                      "no distance field",
                      topology.boundary_edges);
}

typedef struct finishing {
    contour *work;
    swarf_facets *facets;
    swarf_mesh *mesh;
} finishing;

/* The mesh from its facets; the blocks, which take as long to free, meanwhile. */
static swarf_status finish_one(void *context, size_t index)
{
    finishing *f = context;
    if (index == 0) return to_mesh(f->facets, &f->mesh);
    swarf_contour_clear(f->work);
    return SWARF_OK;
}

static swarf_status make(contour *work, const swarf_contour_options *options, const swarf_progress *progress,
                         swarf_mesh **out, swarf_contour_report *report)
{
    swarf_facets facets = {0};
    finishing f = {work, &facets, NULL};
    swarf_status status = swarf_contour_blocks(work);
    if (status == SWARF_OK) status = swarf_contour_settle(work, options, progress, &facets, report);
    if (status == SWARF_OK) status = swarf_parallel_for(2, finish_one, &f, NULL, 0, 1);
    swarf_facets_free(&facets);
    if (status == SWARF_OK) status = check_closed(f.mesh);
    if (status == SWARF_OK) status = swarf_progress_report(progress, 1);
    if (status != SWARF_OK) {
        swarf_mesh_release(f.mesh);
        return status;
    }
    *out = f.mesh;
    return SWARF_OK;
}

swarf_status swarf_contour_check(const swarf_contour_options *options)
{
    SWARF_REQUIRE(options && options->size == sizeof *options, "mesh: options missing or of another version");
    SWARF_REQUIRE(options->error_mm >= 0 && options->error_mm <= farthest, "mesh: error %g mm; 0 to %g are possible",
                  options->error_mm, farthest);
    SWARF_REQUIRE(options->error_mm > 0 || !options->triangle_budget,
                  "mesh: a budget of %zu triangles needs an error (mm) that may be spent on it",
                  options->triangle_budget);
    SWARF_REQUIRE(options->keep_volume == 0 || options->keep_volume == 1,
                  "mesh: keep_volume is %d, which is neither 0 nor 1", options->keep_volume);
    SWARF_REQUIRE(options->fine == 0 || options->fine == 1, "mesh: fine is %d, which is neither 0 nor 1",
                  options->fine);
    return SWARF_OK;
}

swarf_status swarf_contour_begin(swarf_stock *stock, const swarf_contour_options *options, contour *out)
{
    SWARF_TRY(swarf_contour_check(options));
    SWARF_TRY(swarf_stock_enter_read(stock));
    *out = (contour){.stock = stock,
                     .layout = swarf_tree_get_layout(stock->tree),
                     .surface = options->surface,
                     .moves = options->moves,
                     .error_mm = options->error_mm * (options->keep_volume ? 1 - SWARF_REGAIN_PART : 1)};
    return SWARF_OK;
}

swarf_status swarf_mesh_contour(swarf_stock *stock, const swarf_contour_options *options,
                                const swarf_progress *progress, swarf_mesh **out, swarf_contour_report *report)
{
    SWARF_REQUIRE(out, "mesh: output missing");
    contour work;
    SWARF_TRY(swarf_contour_begin(stock, options, &work));
    swarf_contour_report made = {0};
    const swarf_status status = make(&work, options, progress, out, &made);
    if (status == SWARF_OK && report) *report = made;
    swarf_contour_free(&work);
    swarf_stock_leave(stock);
    return status;
}
