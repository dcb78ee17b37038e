/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A mesh that is never in memory as a whole: made band by band along x, each written as soon as it is finished.
 *
 *   band        voxels first .. end - 1; its facets are those of the edges that begin there
 *   handed on   to the next band: the last layer of blocks as it is, as both sides share the vertices of its last
 *               cells, and where care was taken in the layer above it
 *   carried     to the next band: the facets that reach into it, so that its own do not cut them
 *
 * Whether what was written is closed is told by a sum over all directed edges of a number that is its own negative for
 * the edge turned round: it is 0 when every edge is there both ways. */
#include "base/memory.h"
#include "base/mix.h"
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/contour.h"
#include "mesh/intersect.h"
#include "mesh/stl.h"
#include "stock/leaf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Voxels of a band: what is done twice is three layers of 8 at most, a tenth of a wide one.
 * Only these, so that the mesh does not change with every byte that is free. */
enum { WIDE = 256, NARROW = 64 };
/* Bytes that making a whole mesh needs beside the stock, by leaf of it: with an error, which tiles make use of, with
 * none, and what fine adds at most. Measured (bear and cameo, N = 512 and 1024; 0.1 voxel): 15 100, 30 700, 17 500.
 * With coarser voxels it is up to two and a half times as much, which is 160 MB then (cameo, N = 256). */
static const double bytes_per_leaf = 16000, bytes_per_full_leaf = 33000, bytes_per_fine_leaf = 18000;

typedef struct streaming {
    contour work;
    const swarf_contour_options *options;
    contour_band band;
    contour_block *handed;
    size_t handed_count;
    FILE *stream;
    uint64_t edges; /* the sum over directed edges */
    swarf_contour_report report;
} streaming;

/* ---- the sum over edges ------------------------------------------------------------------------------------------ */

static uint64_t hash_point(const float *p)
{
    uint64_t hash = 0;
    for (int k = 0; k < 3; k++) {
        const float value = p[k] + 0.0f; /* -0 is 0 */
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = swarf_mix(hash + bits + 1);
    }
    return hash;
}

static void add_edges(streaming *s, const swarf_facets *facets)
{
    for (size_t f = 0; f < facets->facet_count; f++) {
        uint64_t hash[3];
        for (int k = 0; k < 3; k++) hash[k] = hash_point(facets->xyz + 3 * (size_t)facets->facet[f].v[k]);
        for (int k = 0; k < 3; k++) {
            const uint64_t a = hash[k], b = hash[(k + 1) % 3];
            s->edges += a < b ? swarf_mix(a + swarf_mix(b)) : a > b ? 0 - swarf_mix(b + swarf_mix(a)) : 0;
        }
    }
}

/* ---- from band to band ------------------------------------------------------------------------------------------- */

/* Facets that reach into the next band's cells, those of bands before among them. */
static swarf_status carry(streaming *s, const swarf_facets *facets)
{
    const swarf_tree_layout *layout = s->work.layout;
    const double from = layout->origin[0] + (s->band.end - 1.5) * layout->voxel;
    const swarf_facets *sources[2] = {&s->band.below, facets};
    swarf_facets out = {0};
    size_t count = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < 2; i++)
            for (size_t f = 0; f < sources[i]->facet_count; f++) {
                const swarf_facet *facet = &sources[i]->facet[f];
                int reaches = 0;
                for (int k = 0; k < 3; k++) reaches |= (double)sources[i]->xyz[3 * (size_t)facet->v[k]] >= from;
                if (!reaches) continue;
                if (pass == 0) {
                    count++;
                    continue;
                }
                swarf_facet *to = &out.facet[out.facet_count++];
                *to = *facet;
                for (int k = 0; k < 3; k++) {
                    memcpy(out.xyz + 3 * out.vertex_count, sources[i]->xyz + 3 * (size_t)facet->v[k], 12);
                    to->v[k] = (uint32_t)out.vertex_count++;
                }
            }
        if (pass == 1) break;
        out.xyz = malloc((9 * count + 1) * sizeof *out.xyz);
        out.facet = malloc((count + 1) * sizeof *out.facet);
        if (!out.xyz || !out.facet || 3 * count >= UINT32_MAX) {
            swarf_facets_free(&out);
            return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", count);
        }
    }
    swarf_facets_free(&s->band.below);
    s->band.below = out;
    return SWARF_OK;
}

static void drop_handed(streaming *s)
{
    for (size_t i = 0; i < s->handed_count; i++) swarf_contour_block_free(&s->handed[i]);
    free(s->handed);
    s->handed = NULL;
    s->handed_count = 0;
}

/* Take the last layer out of the band, finished, and what is known of the one above it. */
static swarf_status hand_on(streaming *s)
{
    contour *work = &s->work;
    const int32_t end = s->band.end, layer = end - SWARF_LEAF_DIM;
    size_t count = 0;
    for (size_t i = 0; i < work->block_count; i++) count += work->blocks[i].ijk[0] >= layer;
    s->handed = malloc((count + 1) * sizeof *s->handed);
    if (!s->handed) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    for (size_t i = 0; i < work->block_count; i++) {
        contour_block *block = &work->blocks[i];
        if (block->ijk[0] != layer && block->ijk[0] != end) continue;
        contour_block *to = &s->handed[s->handed_count++];
        *to = (contour_block){.ijk = {block->ijk[0], block->ijk[1], block->ijk[2]}};
        if (block->ijk[0] == layer) {
            free(block->facets); /* written */
            free(block->centres);
            block->facets = NULL;
            block->centres = NULL;
            block->facet_count = block->full_count = block->centre_count = 0;
            block->finished = 1;
            const contour_block none = *to;
            *to = *block;
            *block = none;
        } else {
            memcpy(to->keep_mask, block->keep_mask, sizeof to->keep_mask);
            memcpy(to->own_mask, block->own_mask, sizeof to->own_mask);
            memcpy(to->calm_mask, block->calm_mask, sizeof to->calm_mask);
            memcpy(to->middle_mask, block->middle_mask, sizeof to->middle_mask);
        }
    }
    return SWARF_OK;
}

/* Put them into the blocks of the next one, which has the same there. */
static void take_over(streaming *s)
{
    for (size_t i = 0; i < s->handed_count; i++) {
        contour_block *block = swarf_contour_block_at(&s->work, s->handed[i].ijk);
        if (block) {
            *block = s->handed[i];
            s->handed[i] = (contour_block){0};
        }
    }
    drop_handed(s);
}

/* ---- bands ------------------------------------------------------------------------------------------------------- */

static swarf_status write_facets(streaming *s, const swarf_facets *facets)
{
    const size_t count = facets->facet_count;
    uint32_t *index = malloc((3 * count + 1) * sizeof *index);
    if (!index) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", count);
    for (size_t f = 0; f < count; f++) memcpy(index + 3 * f, facets->facet[f].v, sizeof facets->facet[f].v);
    const swarf_triangles triangles = {facets->xyz, facets->vertex_count, index, count};
    const swarf_status status = swarf_stl_write_records(&triangles, s->stream, NULL);
    free(index);
    return status;
}

static swarf_status check_closed(const streaming *s)
{
    if (s->edges == 0) return SWARF_OK;
    return swarf_fail(
        SWARF_ERROR_GEOMETRY,
        "mesh: the surface is not closed: the level set is cut off at its border or is no distance field");
}

/* One that is all of the stock is written with its count, so that nobody has to go back to where the file begins. */
static swarf_status write_band(streaming *s, const swarf_facets *facets)
{
    if (!s->work.band) {
        SWARF_TRY(check_closed(s));
        SWARF_TRY(swarf_stl_write_header(facets->facet_count, s->stream));
    }
    return write_facets(s, facets);
}

static swarf_status make_band(streaming *s, const swarf_progress *progress)
{
    contour *work = &s->work;
    swarf_facets facets = {0};
    swarf_status status = swarf_contour_blocks(work);
    if (status == SWARF_OK) {
        take_over(s);
        status = swarf_contour_settle(work, s->options, progress, &facets, &s->report);
    }
    if (status == SWARF_OK) {
        add_edges(s, &facets);
        status = write_band(s, &facets);
    }
    if (status == SWARF_OK) status = carry(s, &facets);
    if (status == SWARF_OK) status = hand_on(s);
    swarf_facets_free(&facets);
    swarf_contour_clear(work);
    return status;
}

/* What positions of all bands are rounded to: enough for the farthest corner of the voxels. */
static double step_of(const swarf_tree_layout *layout)
{
    double most = 0;
    for (int k = 0; k < 3; k++) {
        const double last = layout->origin[k] + layout->count[k] * SWARF_NODE_DIM * layout->voxel;
        most = fmax(most, fmax(fabs(layout->origin[k]), fabs(last)));
    }
    return swarf_facets_step(most);
}

static swarf_status make_bands(streaming *s, const swarf_progress *progress, int32_t width)
{
    const int32_t all = s->work.layout->count[0] * SWARF_NODE_DIM;
    const int whole = width >= all;
    s->work.band = whole ? NULL : &s->band;
    s->band.step = step_of(s->work.layout);
    if (!whole) SWARF_TRY(swarf_stl_write_header(0, s->stream));
    for (int32_t first = 0; first < all; first += width) {
        s->band.first = first;
        s->band.end = all - first < width ? all : first + width;
        swarf_progress_share share = {progress, (double)first / all, (double)s->band.end / all};
        const swarf_progress part = swarf_progress_part(&share);
        SWARF_TRY(make_band(s, progress ? &part : NULL));
        if (ferror(s->stream)) return SWARF_OK; /* told when the file is closed */
    }
    if (whole) return SWARF_OK;
    SWARF_TRY(check_closed(s));
    return swarf_stl_finish(s->stream, s->report.triangles);
}

/* All of the stock where the memory allows it, and where the count cannot be put before what is written already. */
static int32_t choose_width(const swarf_stock *stock, const swarf_contour_options *options, size_t memory_limit,
                            int can_seek)
{
    size_t leaves, bytes;
    swarf_tree_size(stock->tree, &leaves, &bytes);
    const double each = (options->error_mm > 0 ? bytes_per_leaf : bytes_per_full_leaf) +
                        (options->fine && options->surface ? bytes_per_fine_leaf : 0);
    const double limit = swarf_memory_limit(memory_limit), needed = (double)leaves * each;
    const int32_t all = swarf_tree_get_layout(stock->tree)->count[0] * SWARF_NODE_DIM;
    if (needed <= limit || !can_seek) return all;
    return needed * WIDE / all <= limit ? WIDE : NARROW;
}

swarf_status swarf_mesh_stream(swarf_stock *stock, const swarf_contour_options *options, size_t memory_limit,
                               const char *path, const swarf_progress *progress, swarf_contour_report *report)
{
    SWARF_REQUIRE(stock && path, "mesh: NULL");
    SWARF_TRY(swarf_contour_check(options));
    SWARF_REQUIRE(!options->triangle_budget,
                  "mesh: a budget of %zu triangles needs the whole mesh, which is not streamed",
                  options->triangle_budget);
    char suffix[8];
    swarf_file_suffix(path, suffix, sizeof suffix);
    SWARF_REQUIRE(strcmp(suffix, "stl") == 0, "%s: a mesh is streamed to .stl only", path);
    streaming s = {.options = options};
    swarf_file_writer writer;
    SWARF_TRY(swarf_file_begin(path, &writer));
    s.stream = writer.stream;
    const int can_seek = fseek(s.stream, 0, SEEK_SET) == 0;
    swarf_status status = swarf_contour_begin(stock, options, &s.work);
    if (status == SWARF_OK) {
        status = make_bands(&s, progress, choose_width(stock, options, memory_limit, can_seek));
        if (status == SWARF_OK) status = swarf_progress_report(progress, 1);
        drop_handed(&s);
        swarf_facets_free(&s.band.below);
        swarf_contour_free(&s.work);
        swarf_stock_leave(stock);
    }
    if (status != SWARF_OK) {
        swarf_file_abandon(&writer);
        return status;
    }
    SWARF_TRY(swarf_file_commit(&writer));
    if (report) *report = s.report;
    return SWARF_OK;
}
