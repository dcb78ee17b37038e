/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* From a stock to a mesh with sharp edges: the passes of dual contouring, simplifying, and the check for facets that
 * cut each other, whose surroundings are then made again more carefully. */
#include "mesh/contour.h"

#include "base/parallel.h"
#include "base/status.h"
#include "base/weld.h"
#include "mesh/intersect.h"
#include "mesh/known.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How often the whole is attempted; and how often, between two attempts, the surroundings of facets that cut each other
 * are made again: unsimplified, as if the surface were smooth, with vertices in the middle of their crossings; what
 * then still touches itself does so on the stock's surface. */
enum { ATTEMPTS = 7, CLOSE_LOOKS = 7 };

static const double farthest = 1e6; /* mm, as lengths everywhere: an error must be a float in voxels */
/* Of the error, what shifting vertices may take to keep the volume; in voxels, that where there is none. A face that
 * bends evenly takes two thirds of what leaving vertices out took. */
static const double regain_part = 0.2, regain_least = 0.01;
/* In voxels: faces from which crossings are no farther are flat, and stay where they are. */
static const double regain_flat = 2e-4;

swarf_contour_options swarf_contour_options_default(void)
{
    return (swarf_contour_options){.size = sizeof(swarf_contour_options), .moves = SIZE_MAX};
}

static swarf_status cross_one(void *context, size_t index)
{
    contour *work = context;
    contour_block *block = &work->blocks[index];
    return block->finished ? SWARF_OK : swarf_contour_cross(work, block);
}

static swarf_status place_one(void *context, size_t index)
{
    contour *work = context;
    contour_block *block = &work->blocks[index];
    return swarf_contour_is_within(work, block, 2) ? swarf_contour_place(work, block) : SWARF_OK;
}

static swarf_status unfold_one(void *context, size_t index)
{
    contour *work = context;
    contour_block *block = &work->blocks[index];
    block->changed = 0;
    return swarf_contour_is_within(work, block, 1) ? swarf_contour_unfold(work, block) : SWARF_OK;
}

static swarf_status place_again(void *context, size_t index)
{
    contour *work = context;
    return work->blocks[index].changed ? swarf_contour_place(work, &work->blocks[index]) : SWARF_OK;
}

static swarf_status tile_one(void *context, size_t index)
{
    contour *work = context;
    contour_block *block = &work->blocks[index];
    return swarf_contour_is_within(work, block, 1) ? swarf_contour_tile(work, block) : SWARF_OK;
}

static swarf_status tile_again(void *context, size_t index)
{
    const contour *work = context;
    return work->blocks[index].touched ? tile_one(context, index) : SWARF_OK;
}

static swarf_status join_one(void *context, size_t index)
{
    contour *work = context;
    contour_block *block = &work->blocks[index];
    return swarf_contour_is_within(work, block, 1) ? swarf_contour_join(work, block) : SWARF_OK;
}

static swarf_status join_again(void *context, size_t index)
{
    const contour *work = context;
    return work->blocks[index].touched ? join_one(context, index) : SWARF_OK;
}

/* Put the finished facets of other bands behind those of this one, where they share vertices by their places. */
static swarf_status append_below(const swarf_facets *below, swarf_facets *facets)
{
    const size_t own = facets->vertex_count, all = own + below->vertex_count, count = facets->facet_count;
    float *xyz = malloc((3 * all + 1) * sizeof *xyz), *welded = malloc((3 * all + 1) * sizeof *welded);
    swarf_facet *facet = malloc((count + below->facet_count + 1) * sizeof *facet);
    uint32_t *map = malloc((all + 1) * sizeof *map), *first = malloc((all + 1) * sizeof *first);
    swarf_status status = SWARF_OK;
    if (!xyz || !welded || !facet || !map || !first) {
        status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", count);
    } else {
        memcpy(xyz, facets->xyz, 3 * own * sizeof *xyz);
        memcpy(xyz + 3 * own, below->xyz, 3 * below->vertex_count * sizeof *xyz);
        memcpy(welded, xyz, 3 * all * sizeof *xyz);
        memcpy(facet, facets->facet, count * sizeof *facet);
        memcpy(facet + count, below->facet, below->facet_count * sizeof *facet);
        size_t unique = 0;
        status = swarf_weld(welded, all, map, &unique);
        for (size_t i = all; status == SWARF_OK && i-- > 0;) first[map[i]] = (uint32_t)i;
        for (size_t f = count; status == SWARF_OK && f < count + below->facet_count; f++)
            for (int k = 0; k < 3; k++) facet[f].v[k] = first[map[own + facet[f].v[k]]];
    }
    free(welded);
    free(map);
    free(first);
    if (status != SWARF_OK) {
        free(xyz);
        free(facet);
        return status;
    }
    swarf_facets_free(facets);
    *facets =
        (swarf_facets){.xyz = xyz, .vertex_count = all, .facet = facet, .facet_count = count + below->facet_count};
    return SWARF_OK;
}

typedef struct stage {
    contour *work;
    const swarf_contour_options *options;
    const swarf_progress *progress;
    swarf_facets *facets;
    swarf_facets_memo *memo;
    double *step; /* that positions were rounded to at the last attempt, 0: there was none */
    swarf_facets_known *known;
    swarf_crease_memo *creases;
    swarf_contour_report *report;
} stage;

/* What an attempt came to: pairs of facets that cut each other, and how many of them are counted here. */
typedef struct found {
    swarf_facet_pair *pairs;
    size_t count;
    size_t fresh; /* that the band before has not seen, those of the layer above among them */
    size_t last;  /* that the next band will not see again */
    size_t split; /* edges */
} found;

/* Pairs of facets that cut each other, those of two other bands aside. The facets stay, with all vertices. */
static swarf_status find_pairs(const stage *s, int first, found *out)
{
    const contour_band *band = s->work->band;
    const size_t own = s->facets->facet_count;
    if (band && band->below.facet_count) SWARF_TRY(append_below(&band->below, s->facets));
    size_t all = 0;
    uint8_t *fresh = malloc(s->facets->facet_count + 1);
    swarf_status status = fresh ? swarf_facets_known_tell(s->known, s->facets, fresh)
                                : swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    if (status == SWARF_OK)
        status = swarf_facets_intersect(s->facets, fresh, first ? s->progress : NULL, 0.9, 0.98, &out->pairs, &all);
    free(fresh);
    if (status == SWARF_OK && all > 0) status = swarf_facets_known_take(s->known, s->facets, out->pairs, all);
    s->facets->facet_count = own;
    if (status != SWARF_OK) {
        free(out->pairs);
        return status;
    }
    for (size_t i = 0; i < all; i++) {
        const swarf_facet_pair pair = out->pairs[i];
        const int a = pair.a < own && !s->facets->facet[pair.a].beyond;
        const int b = pair.b < own && !s->facets->facet[pair.b].beyond;
        out->fresh +=
            (pair.a < own && !s->facets->facet[pair.a].before) || (pair.b < own && !s->facets->facet[pair.b].before);
        if (!a && !b) continue;
        out->pairs[out->count++] = pair;
        out->last += (a || pair.a >= own) && (b || pair.b >= own);
    }
    return SWARF_OK;
}

/* How far vertices may be shifted to keep the volume: where simplifying stopped early, as at a budget, by the same part
 * of the error that it came to. */
static double regained_by(const stage *s)
{
    const double error = s->work->error_mm, spare = s->options->error_mm - error;
    const double least = regain_least * s->work->layout->voxel;
    float most = 0;
    if (!(error > 0)) return least;
    for (size_t f = 0; f < s->facets->facet_count; f++) most = fmaxf(most, s->facets->facet[f].error_mm);
    return fmin(spare, fmax(least, spare / error * (double)most));
}

/* Join, simplify, look for facets that cut each other. */
static swarf_status attempt(const stage *s, int first, found *out)
{
    contour *work = s->work;
    const double voxel = work->layout->voxel;
    SWARF_TRY(swarf_parallel_for(work->block_count, first ? tile_one : tile_again, work, NULL, 0, 1));
    SWARF_TRY(swarf_parallel_for(work->block_count, first ? join_one : join_again, work, first ? s->progress : NULL,
                                 0.6, 0.7));
    uint8_t *marks = NULL;
    SWARF_TRY(swarf_contour_gather(work, NULL, s->facets, first && !work->band ? NULL : &marks));
    for (size_t i = 0; first && i < work->block_count; i++)
        if (swarf_contour_is_within(work, &work->blocks[i], 0)) s->report->full_triangles += work->blocks[i].full_count;
    const int fine = s->options->fine && work->surface;
    swarf_status status = SWARF_OK;
    if (fine) /* later attempts can be broken off, but get no further */
        status = swarf_contour_crease(work, s->facets, &marks, s->creases, s->progress, first ? 0.7 : 0.99,
                                      first ? 0.8 : 0.99, &out->split);
    const double step = swarf_facets_snap(s->facets, work->band ? work->band->step : 0);
    s->memo->same = step == *s->step && !fine; /* splitting edges leaves facets of known vertices alone, or not */
    *s->step = step;
    if (status == SWARF_OK)
        status = swarf_facets_simplify(s->facets, work->error_mm, voxel, s->options->triangle_budget, marks, s->memo,
                                       first ? s->progress : NULL, fine ? 0.8 : 0.7, 0.9);
    if (status == SWARF_OK && s->options->keep_volume) {
        status = swarf_facets_regain(s->facets, marks, regained_by(s), regain_flat * voxel);
        swarf_facets_snap(s->facets, work->band ? work->band->step : 0);
    }
    free(marks);
    SWARF_TRY(status);
    return find_pairs(s, first, out);
}

/* Take care of the cells noted, and of those that then still have facets that cut each other: a look at them alone
 * costs little beside an attempt of the whole. */
static swarf_status take_care(const stage *s)
{
    contour *work = s->work;
    for (size_t b = 0; b < work->block_count; b++) work->blocks[b].touched = 0;
    swarf_contour_take_care(work, !(s->options->error_mm > 0));
    for (int look = 0;; look++) {
        size_t count;
        SWARF_TRY(swarf_progress_report(s->progress, 0.99));
        SWARF_TRY(swarf_parallel_for(work->block_count, place_again, work, NULL, 0, 1));
        if (look == CLOSE_LOOKS) return SWARF_OK;
        SWARF_TRY(swarf_contour_look(work, &count));
        if (count == 0) return SWARF_OK;
        swarf_contour_take_care(work, 1);
    }
}

/* Attempt until no facets cut each other. */
static swarf_status settle(const stage *s)
{
    contour *work = s->work;
    for (int round = 0;; round++) {
        found now = {0};
        SWARF_TRY(swarf_progress_report(s->progress, 0.6 + (round ? 0.39 : 0)));
        SWARF_TRY(attempt(s, round == 0, &now));
        if (round == 0) s->report->intersections_found += now.fresh;
        for (size_t i = 0; i < now.count; i++) swarf_contour_note(work, s->facets, &now.pairs[i]);
        free(now.pairs);
        if (now.count == 0 || round == ATTEMPTS) {
            s->report->intersections_left += now.last;
            s->report->split_edges += now.split;
            return SWARF_OK;
        }
        SWARF_TRY(take_care(s));
    }
}

swarf_status swarf_contour_settle(contour *work, const swarf_contour_options *options, const swarf_progress *progress,
                                  swarf_facets *facets, swarf_contour_report *report)
{
    swarf_facets_memo memo = {0};
    swarf_facets_known known = {0};
    swarf_crease_memo creases = {0};
    double step = 0;
    const stage s = {work, options, progress, facets, &memo, &step, &known, &creases, report};
    swarf_contour_table_fill(&work->table);
    SWARF_TRY(swarf_parallel_for(work->block_count, cross_one, work, progress, 0, 0.3));
    SWARF_TRY(swarf_parallel_for(work->block_count, place_one, work, progress, 0.3, 0.56));
    if (work->surface) { /* by the field vertices stay in their cells */
        SWARF_TRY(swarf_parallel_for(work->block_count, unfold_one, work, progress, 0.56, 0.58));
        SWARF_TRY(swarf_parallel_for(work->block_count, place_again, work, progress, 0.58, 0.6));
    }
    const double voxel_mm3 = pow(work->layout->voxel, 3);
    for (size_t i = 0; i < work->block_count; i++) {
        const contour_block *block = &work->blocks[i];
        if (!swarf_contour_is_within(work, block, 0)) continue;
        report->sharp_vertices += block->sharp_count;
        report->exact_vertices += block->exact_count;
        report->unseen_mm3 += (double)block->unseen * voxel_mm3;
        report->parted_cells += block->parted_count;
    }
    const swarf_status status = settle(&s);
    for (size_t i = 0; i < work->block_count; i++)
        if (swarf_contour_is_within(work, &work->blocks[i], 0))
            report->surface_mm3 += work->blocks[i].within * voxel_mm3;
    swarf_facets_memo_free(&memo);
    swarf_facets_known_free(&known);
    swarf_crease_memo_free(&creases);
    SWARF_TRY(status);
    size_t own = 0;
    for (size_t f = 0; f < facets->facet_count; f++) {
        if (facets->facet[f].beyond) continue;
        facets->facet[own++] = facets->facet[f];
        report->error_mm = fmax(report->error_mm, (double)facets->facet[f].error_mm);
    }
    facets->facet_count = own;
    report->triangles += own;
    report->budget_met = !options->triangle_budget || report->triangles <= options->triangle_budget;
    return SWARF_OK;
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
                     .error_mm = options->error_mm * (options->keep_volume ? 1 - regain_part : 1)};
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
