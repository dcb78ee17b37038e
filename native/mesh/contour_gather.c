/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The vertices and facets of blocks as one surface: those of a block together, centres after the vertices of all cells.
 */
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/contour.h"
#include "mesh/intersect.h"

#include <stdlib.h>
#include <string.h>

typedef struct gathering {
    contour *work;
    const contour_choice *choice;
    swarf_facets *out;
    uint8_t *marks;
    size_t vertices; /* of cells */
} gathering;

static contour_block *block_of(const gathering *g, size_t index)
{
    return &g->work->blocks[g->choice ? g->choice->block[index] : index];
}

static size_t facet_count_of(const gathering *g, size_t index, const contour_block *block)
{
    return g->choice && index >= g->choice->joined ? 0 : block->facet_count;
}

/* First vertices of the blocks that facets of this one name. */
static void find_firsts(const contour *work, const contour_block *block, size_t first[8])
{
    first[0] = block->vertex_first;
    for (int below = 1; below < 8; below++) {
        const contour_block *near = swarf_contour_block_below(work, block, below);
        first[below] = near ? near->vertex_first : 0;
    }
}

static void put_facets(const gathering *g, const contour_block *block)
{
    const contour *work = g->work;
    const int8_t beyond = !swarf_contour_is_within(work, block, 0);
    const int8_t before = work->band && block->ijk[0] > 0 && block->ijk[0] == work->band->first;
    const size_t centres = g->vertices + block->centre_first;
    size_t first[8];
    find_firsts(work, block, first);
    for (size_t f = 0; f < block->facet_count; f++) {
        swarf_facet facet = block->facets[f];
        facet.beyond = beyond;
        facet.before = before;
        for (int k = 0; k < 3; k++) {
            const uint32_t v = facet.v[k];
            facet.v[k] = (uint32_t)(v & SWARF_CENTRE ? centres + (v & ~SWARF_CENTRE)
                                                     : first[v >> SWARF_BELOW_SHIFT] + (v & SWARF_LEFT_MASK));
        }
        g->out->facet[block->facet_first + f] = facet;
    }
}

/* Whether facets end at the vertices of these cells: those beside the planes between bands, and the last ones joined.
 */
static int is_border(const contour *work, const contour_block *block, int x)
{
    const int32_t end = block->ijk[0] + SWARF_LEAF_DIM;
    return work->band && x == SWARF_LEAF_DIM - 1 &&
           (block->finished || end == work->band->end || end == work->band->end + SWARF_LEAF_DIM);
}

/* Vertices of noted cells are not to be left out. */
static void mark_vertices(const gathering *g, const contour_block *block)
{
    const contour *work = g->work;
    for (int x = 0; x < 8 && block->left_count; x++) { /* none beyond the band */
        const uint64_t all = block->cell_mask[x];
        for (uint64_t word = is_border(work, block, x) ? all : all & block->keep_mask[x]; word; word &= word - 1) {
            const contour_cell *cell =
                &block->cells[block->cell_rank[x] + swarf_contour_below(all, __builtin_ctzll(word))];
            for (uint32_t v = cell->first; v < cell->first + work->table.entry[cell->config][cell->flip].count; v++)
                g->marks[block->vertex_first + (block->tile ? block->tile[v] & ~SWARF_TILED : v)] |=
                    SWARF_VERTEX_LOCKED;
        }
    }
}

static swarf_status gather_one(void *context, size_t index)
{
    const gathering *g = context;
    contour_block *block = block_of(g, index);
    float *xyz = g->out->xyz + 3 * block->vertex_first;
    if (block->left)
        for (uint32_t i = 0; i < block->left_count; i++)
            memcpy(xyz + 3 * (size_t)i, block->vertices[block->left[i]].xyz, 12);
    else if (block->left_count) /* none beyond the band */
        memcpy(xyz, block->vertices, block->left_count * 12);
    block->most = swarf_facets_most(xyz, block->left_count);
    const uint8_t known = block->touched ? 0 : SWARF_VERTEX_KNOWN;
    if (g->marks) {
        memset(g->marks + block->vertex_first, known, block->left_count);
        mark_vertices(g, block);
    }
    if (!facet_count_of(g, index, block)) return SWARF_OK;
    const size_t centre = g->vertices + block->centre_first;
    memcpy(g->out->xyz + 3 * centre, block->centres, block->centre_count * 12);
    /* nor are centres left out where something was amiss already */
    const uint8_t locked = g->work->band || block->amiss ? SWARF_VERTEX_LOCKED : 0;
    if (g->marks) memset(g->marks + centre, known | locked, block->centre_count);
    put_facets(g, block);
    return SWARF_OK;
}

/* What was there for an attempt before is used again: touching new memory takes longest. */
static swarf_status make_room(swarf_facets *out)
{
    if (out->vertex_count < out->vertex_room && out->facet_count < out->facet_room) return SWARF_OK;
    const size_t vertices = out->vertex_count, facets = out->facet_count;
    swarf_facets_free(out);
    out->vertex_count = vertices;
    out->facet_count = facets;
    out->vertex_room = vertices + vertices / 16 + 1;
    out->facet_room = facets + facets / 16 + 1;
    out->xyz = malloc(3 * out->vertex_room * sizeof *out->xyz);
    out->facet = malloc(out->facet_room * sizeof *out->facet);
    return out->xyz && out->facet ? SWARF_OK
                                  : swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", facets);
}

swarf_status swarf_contour_gather(contour *work, const contour_choice *choice, swarf_facets *out, uint8_t **marks)
{
    gathering g = {.work = work, .choice = choice, .out = out};
    const size_t count = choice ? choice->count : work->block_count;
    size_t centres = 0, facets = 0;
    for (size_t i = 0; i < count; i++) {
        contour_block *block = block_of(&g, i);
        const size_t own = facet_count_of(&g, i, block);
        block->vertex_first = g.vertices;
        block->centre_first = centres;
        block->facet_first = facets;
        g.vertices += block->left_count;
        centres += own ? block->centre_count : 0;
        facets += own;
    }
    out->vertex_count = g.vertices + centres;
    out->facet_count = facets;
    if (out->vertex_count >= UINT32_MAX || facets >= UINT32_MAX)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: %zu vertices are more than a mesh can number; use larger voxels",
                          out->vertex_count);
    SWARF_TRY(make_room(out));
    if (marks) {
        g.marks = calloc(out->vertex_count + 1, 1);
        if (!g.marks) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    }
    const swarf_status status = swarf_parallel_for(count, gather_one, &g, NULL, 0, 1);
    if (status != SWARF_OK)
        free(g.marks);
    else if (marks)
        *marks = g.marks;
    return status;
}
