/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* From a stock to a mesh with sharp edges: the passes of dual contouring, simplifying, and the check for facets that
 * cut each other, whose surroundings are then made again more carefully. */
#include "mesh/contour.h"

#include "base/parallel.h"
#include "base/status.h"
#include "mesh/intersect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How often the surroundings of facets that cut each other are made again: first unsimplified, then as if the surface
 * were smooth, then with vertices in the middle of their crossings; what then still touches itself does so on the
 * stock's surface. */
enum { ATTEMPTS = 7 };

swarf_contour_options swarf_contour_options_default(void)
{
    return (swarf_contour_options){.size = sizeof(swarf_contour_options), .moves = SIZE_MAX};
}

static swarf_status cross_one(void *context, size_t index)
{
    contour *work = context;
    return swarf_contour_cross(work, &work->blocks[index]);
}

static swarf_status place_one(void *context, size_t index)
{
    contour *work = context;
    return swarf_contour_place(work, &work->blocks[index]);
}

static swarf_status place_again(void *context, size_t index)
{
    contour *work = context;
    return work->blocks[index].changed ? swarf_contour_place(work, &work->blocks[index]) : SWARF_OK;
}

static swarf_status tile_one(void *context, size_t index)
{
    contour *work = context;
    return swarf_contour_tile(work, &work->blocks[index]);
}

static swarf_status join_one(void *context, size_t index)
{
    contour *work = context;
    return swarf_contour_join(work, &work->blocks[index]);
}

static swarf_status number_vertices(contour *work)
{
    size_t vertices = 0;
    for (size_t i = 0; i < work->block_count; i++) {
        work->blocks[i].vertex_first = vertices;
        vertices += work->blocks[i].left_count;
    }
    if (vertices >= SWARF_CENTRE)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: %zu vertices are more than a mesh can number; use larger voxels",
                          vertices);
    return SWARF_OK;
}

typedef struct gathering {
    contour *work;
    swarf_facets *out;
    size_t vertices; /* of cells; centres come after them */
} gathering;

static swarf_status gather_one(void *context, size_t index)
{
    const gathering *g = context;
    const contour_block *block = &g->work->blocks[index];
    float *xyz = g->out->xyz + 3 * block->vertex_first;
    if (block->left)
        for (uint32_t i = 0; i < block->left_count; i++)
            memcpy(xyz + 3 * (size_t)i, block->vertices[block->left[i]].xyz, 12);
    else if (block->vertex_count)
        memcpy(xyz, block->vertices, block->vertex_count * 12);
    if (block->centre_count)
        memcpy(g->out->xyz + 3 * (g->vertices + block->centre_first), block->centres, block->centre_count * 12);
    for (size_t f = 0; f < block->facet_count; f++) {
        swarf_facet facet = block->facets[f];
        for (int k = 0; k < 3; k++)
            if (facet.v[k] & SWARF_CENTRE)
                facet.v[k] = (uint32_t)(g->vertices + block->centre_first + (facet.v[k] & ~SWARF_CENTRE));
        g->out->facet[block->facet_first + f] = facet;
    }
    return SWARF_OK;
}

/* The blocks' vertices and facets as one surface. */
static swarf_status gather(contour *work, swarf_facets *out)
{
    gathering g = {work, out, 0};
    size_t centres = 0, facets = 0;
    for (size_t i = 0; i < work->block_count; i++) {
        contour_block *block = &work->blocks[i];
        block->centre_first = centres;
        block->facet_first = facets;
        centres += block->centre_count;
        facets += block->facet_count;
        g.vertices += block->left_count;
    }
    swarf_facets_free(out);
    out->vertex_count = g.vertices + centres;
    out->facet_count = facets;
    if (out->vertex_count >= UINT32_MAX)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: %zu vertices are more than a mesh can number; use larger voxels",
                          out->vertex_count);
    out->xyz = malloc((3 * out->vertex_count + 1) * sizeof *out->xyz);
    out->facet = malloc((facets + 1) * sizeof *out->facet);
    if (!out->xyz || !out->facet)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", facets);
    return swarf_parallel_for(work->block_count, gather_one, &g, NULL, 0, 1);
}

/* Note the cells of the surface where the boxes of two facets that cut each other overlap, and two voxels round it.
 */
static void note_cells(contour *work, const swarf_facets *facets, const swarf_facet_pair *pair)
{
    int32_t lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        double least[2], most[2];
        const uint32_t facet[2] = {pair->a, pair->b};
        for (int i = 0; i < 2; i++) {
            const uint32_t *v = facets->facet[facet[i]].v;
            const double p[3] = {facets->xyz[3 * (size_t)v[0] + (size_t)k], facets->xyz[3 * (size_t)v[1] + (size_t)k],
                                 facets->xyz[3 * (size_t)v[2] + (size_t)k]};
            least[i] = fmin(p[0], fmin(p[1], p[2]));
            most[i] = fmax(p[0], fmax(p[1], p[2]));
        }
        const double voxel = work->layout->voxel, origin = work->layout->origin[k];
        lo[k] = (int32_t)floor((fmax(least[0], least[1]) - origin) / voxel) - 2;
        hi[k] = (int32_t)floor((fmin(most[0], most[1]) - origin) / voxel) + 2;
    }
    for (int32_t x = lo[0] & ~7; x <= hi[0]; x += 8)
        for (int32_t y = lo[1] & ~7; y <= hi[1]; y += 8)
            for (int32_t z = lo[2] & ~7; z <= hi[2]; z += 8) {
                const int32_t corner[3] = {x, y, z};
                contour_block *block = swarf_contour_block_at(work, corner);
                if (!block) continue;
                for (int i = 0; i < 8; i++) {
                    if (x + i < lo[0] || x + i > hi[0]) continue;
                    uint64_t word = block->cell_mask[i];
                    for (int bit = 0; bit < 64; bit++)
                        if (y + bit / 8 < lo[1] || y + bit / 8 > hi[1] || z + bit % 8 < lo[2] || z + bit % 8 > hi[2])
                            word &= ~(UINT64_C(1) << bit);
                    block->noted_mask[i] |= word;
                }
            }
}

/* Vertices of noted cells, which are not to be left out; centres are where something was amiss already. */
static uint8_t *kept_vertices(const contour *work, const swarf_facets *facets)
{
    uint8_t *kept = calloc(facets->vertex_count + 1, 1);
    if (!kept) return NULL;
    size_t cells = 0;
    for (size_t i = 0; i < work->block_count; i++) {
        const contour_block *block = &work->blocks[i];
        cells += block->left_count;
        uint32_t next = 0;
        for (int x = 0; x < 8; x++)
            for (uint64_t word = block->cell_mask[x]; word; word &= word - 1, next++) {
                if (!(block->keep_mask[x] >> __builtin_ctzll(word) & 1)) continue;
                const contour_cell *cell = &block->cells[next];
                for (uint32_t v = cell->first; v < cell->first + work->table.entry[cell->config][cell->flip].count; v++)
                    kept[block->vertex_first + (block->tile ? block->tile[v] & ~SWARF_TILED : v)] = 1;
            }
    }
    memset(kept + cells, 1, facets->vertex_count - cells);
    return kept;
}

typedef struct stage {
    contour *work;
    const swarf_contour_options *options;
    const swarf_progress *progress;
    swarf_facets facets;
    swarf_contour_report report;
} stage;

/* Join, simplify, look for facets that cut each other. */
static swarf_status attempt(stage *s, int first, swarf_facet_pair **pairs, size_t *count)
{
    contour *work = s->work;
    const double voxel = work->layout->voxel;
    SWARF_TRY(swarf_parallel_for(work->block_count, tile_one, work, NULL, 0, 1));
    SWARF_TRY(number_vertices(work));
    SWARF_TRY(swarf_parallel_for(work->block_count, join_one, work, first ? s->progress : NULL, 0.6, 0.7));
    SWARF_TRY(gather(work, &s->facets));
    swarf_facets_snap(&s->facets);
    for (size_t i = 0; first && i < work->block_count; i++) s->report.full_triangles += work->blocks[i].full_count;
    uint8_t *kept = first ? NULL : kept_vertices(work, &s->facets);
    if (!first && !kept) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    const swarf_status status =
        swarf_facets_simplify(&s->facets, s->options->error_mm, voxel, s->options->triangle_budget, kept,
                              first ? s->progress : NULL, 0.7, 0.9);
    free(kept);
    SWARF_TRY(status);
    return swarf_facets_intersect(&s->facets, first ? s->progress : NULL, 0.9, 0.98, pairs, count);
}

/* The next remedy for the cells noted; without an error to spend all vertices are kept already. */
static void take_more_care(stage *s)
{
    for (size_t b = 0; b < s->work->block_count; b++) {
        contour_block *block = &s->work->blocks[b];
        block->changed = 0;
        for (int x = 0; x < 8; x++) {
            const uint64_t noted = block->noted_mask[x], kept = s->options->error_mm > 0 ? block->keep_mask[x] : noted;
            block->changed |= (noted & kept) != 0;
            block->middle_mask[x] |= noted & block->calm_mask[x];
            block->calm_mask[x] |= noted & kept;
            block->keep_mask[x] |= noted;
            block->noted_mask[x] = 0;
        }
    }
}

/* Attempt until no facets cut each other. */
static swarf_status settle(stage *s)
{
    contour *work = s->work;
    for (int round = 0;; round++) {
        swarf_facet_pair *pairs = NULL;
        size_t count = 0;
        SWARF_TRY(swarf_progress_report(s->progress, 0.6 + (round ? 0.39 : 0)));
        SWARF_TRY(attempt(s, round == 0, &pairs, &count));
        if (round == 0) s->report.intersections_found = count;
        s->report.intersections_left = count;
        for (size_t i = 0; i < count; i++) note_cells(work, &s->facets, &pairs[i]);
        free(pairs);
        if (count == 0 || round == ATTEMPTS) return SWARF_OK;
        take_more_care(s);
        SWARF_TRY(swarf_parallel_for(work->block_count, place_again, work, NULL, 0, 1));
    }
}

static swarf_status to_mesh(stage *s, swarf_mesh **out)
{
    const size_t count = s->facets.facet_count;
    swarf_mesh_data data = {.xyz = s->facets.xyz, .vertex_count = s->facets.vertex_count, .triangle_count = count};
    s->facets.xyz = NULL;
    data.index = malloc((3 * count + 1) * sizeof *data.index);
    if (!data.index) {
        swarf_mesh_data_free(&data);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", count);
    }
    for (size_t f = 0; f < count; f++) {
        const swarf_facet *facet = &s->facets.facet[f];
        memcpy(data.index + 3 * f, facet->v, sizeof facet->v);
        s->report.error_mm = fmax(s->report.error_mm, (double)facet->error_mm);
    }
    s->report.triangles = count;
    s->report.budget_met = !s->options->triangle_budget || count <= s->options->triangle_budget;
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

static swarf_status make(stage *s, swarf_mesh **out)
{
    contour *work = s->work;
    swarf_contour_table_fill(&work->table);
    SWARF_TRY(swarf_contour_blocks(work));
    SWARF_TRY(swarf_parallel_for(work->block_count, cross_one, work, s->progress, 0, 0.3));
    SWARF_TRY(swarf_parallel_for(work->block_count, place_one, work, s->progress, 0.3, 0.6));
    for (size_t i = 0; i < work->block_count; i++) {
        const contour_block *block = &work->blocks[i];
        s->report.sharp_vertices += block->sharp_count;
        s->report.exact_vertices += block->exact_count;
        for (int x = 0; x < 8; x++) s->report.parted_cells -= (size_t)__builtin_popcountll(block->cell_mask[x]);
        s->report.parted_cells += block->vertex_count;
    }
    SWARF_TRY(settle(s));
    swarf_mesh *mesh;
    SWARF_TRY(to_mesh(s, &mesh));
    swarf_status status = check_closed(mesh);
    if (status == SWARF_OK) status = swarf_progress_report(s->progress, 1);
    if (status != SWARF_OK) {
        swarf_mesh_release(mesh);
        return status;
    }
    *out = mesh;
    return SWARF_OK;
}

swarf_status swarf_mesh_contour(swarf_stock *stock, const swarf_contour_options *options,
                                const swarf_progress *progress, swarf_mesh **out, swarf_contour_report *report)
{
    SWARF_REQUIRE(out, "mesh: output missing");
    SWARF_REQUIRE(options && options->size == sizeof *options, "mesh: options missing or of another version");
    SWARF_REQUIRE(isfinite(options->error_mm) && options->error_mm >= 0, "mesh: error %g mm is not 0 or positive",
                  options->error_mm);
    SWARF_REQUIRE(options->error_mm > 0 || !options->triangle_budget,
                  "mesh: a budget of %zu triangles needs an error (mm) that may be spent on it",
                  options->triangle_budget);
    SWARF_TRY(swarf_stock_enter_read(stock));
    contour work = {.stock = stock,
                    .layout = swarf_tree_get_layout(stock->tree),
                    .surface = options->surface,
                    .moves = options->moves,
                    .error_mm = options->error_mm};
    stage s = {.work = &work, .options = options, .progress = progress};
    const swarf_status status = make(&s, out);
    if (status == SWARF_OK && report) *report = s.report;
    swarf_facets_free(&s.facets);
    swarf_contour_free(&work);
    swarf_stock_leave(stock);
    return status;
}
