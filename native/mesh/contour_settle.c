/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The passes of dual contouring, simplifying, and the check for facets that cut each other, whose surroundings are then
 * made again more carefully: attempts until there are none. */
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/contour.h"

#include <math.h>
#include <stdlib.h>

/* How often the whole is attempted; and how often, between two attempts, the surroundings of facets that cut each other
 * are made again: unsimplified, as if the surface were smooth, with vertices in the middle of their crossings; what
 * then still touches itself does so on the stock's surface. */
enum { ATTEMPTS = 7, CLOSE_LOOKS = 7 };

/* Where in the progress each pass of the first attempt ends, about by the time that they take. Of later attempts, which
 * are short, nothing is told but that they go on. */
static const double crossed_at = 0.3, placed_at = 0.56, unfolded_at = 0.58, all_placed_at = 0.6, joined_at = 0.7,
                    creased_at = 0.8, simplified_at = 0.9, searched_at = 0.98, later_at = 0.99;

/* In voxels: how far vertices may be shifted to keep the volume where no error may be spent. */
static const double regain_least = 0.01;
/* In voxels: faces from which crossings are no farther are flat, and stay where they are. */
static const double regain_flat = 2e-4;

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

typedef struct settling {
    contour *work;
    const swarf_contour_options *options;
    const swarf_progress *progress;
    swarf_facets *facets;
    swarf_contour_report *report;
    swarf_facets_memo memo;
    swarf_facets_known known;
    swarf_crease_memo creases;
    double step;   /* that positions were rounded to at the last attempt, 0: there was none */
    size_t splits; /* edges split in the last attempt */
} settling;

/* How far vertices may be shifted to keep the volume: where simplifying stopped early, as at a budget, by the same part
 * of the error that it came to. */
static double regained_by(const settling *s)
{
    const double error = s->work->error_mm, spare = s->options->error_mm - error;
    const double least = regain_least * s->work->layout->voxel;
    float most = 0;
    if (!(error > 0)) return least;
    for (size_t f = 0; f < s->facets->facet_count; f++) most = fmaxf(most, s->facets->facet[f].error_mm);
    return fmin(spare, fmax(least, spare / error * (double)most));
}

/* Edges are split where asked, vertices left out, the volume kept where asked. `marks` may change with the vertices. */
static swarf_status refine_facets(settling *s, int first, uint8_t **marks)
{
    contour *work = s->work;
    const swarf_progress *progress = first ? s->progress : NULL;
    const double voxel = work->layout->voxel, least = work->band ? work->band->step : 0;
    const int fine = s->options->fine && work->surface;
    s->splits = 0;
    if (fine) /* later attempts can be broken off, but get no further */
        SWARF_TRY(swarf_contour_crease(work, s->facets, marks, &s->creases, s->progress, first ? joined_at : later_at,
                                       first ? creased_at : later_at, &s->splits));
    const double step = swarf_facets_snap(s->facets, least);
    s->memo.same = step == s->step && !fine; /* splitting edges leaves facets of known vertices alone, or not */
    s->step = step;
    SWARF_TRY(swarf_facets_simplify(s->facets, work->error_mm, voxel, s->options->triangle_budget, *marks, &s->memo,
                                    progress, fine ? creased_at : joined_at, simplified_at));
    if (!s->options->keep_volume) return SWARF_OK;
    SWARF_TRY(swarf_facets_regain(s->facets, *marks, regained_by(s), regain_flat * voxel));
    swarf_facets_snap(s->facets, least);
    return SWARF_OK;
}

/* Join, simplify, look for facets that cut each other. */
static swarf_status attempt(settling *s, int first, contour_pairs *out)
{
    contour *work = s->work;
    const swarf_progress *progress = first ? s->progress : NULL;
    SWARF_TRY(swarf_parallel_for(work->block_count, first ? tile_one : tile_again, work, NULL, 0, 1));
    SWARF_TRY(
        swarf_parallel_for(work->block_count, first ? join_one : join_again, work, progress, all_placed_at, joined_at));
    uint8_t *marks = NULL;
    SWARF_TRY(swarf_contour_gather(work, NULL, s->facets, first && !work->band ? NULL : &marks));
    for (size_t i = 0; first && i < work->block_count; i++)
        if (swarf_contour_is_within(work, &work->blocks[i], 0)) s->report->full_triangles += work->blocks[i].full_count;
    const swarf_status status = refine_facets(s, first, &marks);
    free(marks);
    SWARF_TRY(status);
    const swarf_progress_share share = {progress, simplified_at, searched_at};
    return swarf_contour_pairs_find(work, s->facets, &s->known, &share, out);
}

/* Take care of the cells noted, and of those that then still have facets that cut each other: a look at them alone
 * costs little beside an attempt of the whole. */
static swarf_status take_care(const settling *s)
{
    contour *work = s->work;
    for (size_t b = 0; b < work->block_count; b++) work->blocks[b].touched = 0;
    swarf_contour_take_care(work, !(s->options->error_mm > 0));
    for (int look = 0;; look++) {
        size_t count;
        SWARF_TRY(swarf_progress_report(s->progress, later_at));
        SWARF_TRY(swarf_parallel_for(work->block_count, place_again, work, NULL, 0, 1));
        if (look == CLOSE_LOOKS) return SWARF_OK;
        SWARF_TRY(swarf_contour_look(work, &count));
        if (count == 0) return SWARF_OK;
        swarf_contour_take_care(work, 1);
    }
}

/* Attempt until no facets cut each other. */
static swarf_status attempt_all(settling *s)
{
    contour *work = s->work;
    for (int round = 0;; round++) {
        contour_pairs now;
        SWARF_TRY(swarf_progress_report(s->progress, round ? later_at : all_placed_at));
        SWARF_TRY(attempt(s, round == 0, &now));
        if (round == 0) s->report->intersections_found += now.fresh;
        for (size_t i = 0; i < now.count; i++) swarf_contour_note(work, s->facets, &now.pair[i]);
        free(now.pair);
        if (now.count == 0 || round == ATTEMPTS) {
            s->report->intersections_left += now.last;
            s->report->split_edges += s->splits;
            return SWARF_OK;
        }
        SWARF_TRY(take_care(s));
    }
}

/* The vertices of all blocks. */
static swarf_status place_all(contour *work, const swarf_progress *progress)
{
    swarf_contour_table_fill(&work->table);
    SWARF_TRY(swarf_parallel_for(work->block_count, cross_one, work, progress, 0, crossed_at));
    SWARF_TRY(swarf_parallel_for(work->block_count, place_one, work, progress, crossed_at, placed_at));
    if (!work->surface) return SWARF_OK; /* by the field vertices stay in their cells */
    SWARF_TRY(swarf_parallel_for(work->block_count, unfold_one, work, progress, placed_at, unfolded_at));
    return swarf_parallel_for(work->block_count, place_again, work, progress, unfolded_at, all_placed_at);
}

static void report_vertices(const contour *work, swarf_contour_report *report)
{
    const double voxel_mm3 = pow(work->layout->voxel, 3);
    for (size_t i = 0; i < work->block_count; i++) {
        const contour_block *block = &work->blocks[i];
        if (!swarf_contour_is_within(work, block, 0)) continue;
        report->sharp_vertices += block->sharp_count;
        report->exact_vertices += block->exact_count;
        report->unseen_mm3 += (double)block->unseen * voxel_mm3;
        report->parted_cells += block->parted_count;
    }
}

static void report_volume(const contour *work, swarf_contour_report *report)
{
    const double voxel_mm3 = pow(work->layout->voxel, 3);
    for (size_t i = 0; i < work->block_count; i++)
        if (swarf_contour_is_within(work, &work->blocks[i], 0))
            report->surface_mm3 += work->blocks[i].within * voxel_mm3;
}

/* Of the facets, those of this band. */
static void keep_own(swarf_facets *facets)
{
    size_t own = 0;
    for (size_t f = 0; f < facets->facet_count; f++)
        if (!facets->facet[f].beyond) facets->facet[own++] = facets->facet[f];
    facets->facet_count = own;
}

swarf_status swarf_contour_settle(contour *work, const swarf_contour_options *options, const swarf_progress *progress,
                                  swarf_facets *facets, swarf_contour_report *report)
{
    settling s = {.work = work, .options = options, .progress = progress, .facets = facets, .report = report};
    SWARF_TRY(place_all(work, progress));
    report_vertices(work, report);
    const swarf_status status = attempt_all(&s);
    swarf_facets_memo_free(&s.memo);
    swarf_facets_known_free(&s.known);
    swarf_crease_memo_free(&s.creases);
    SWARF_TRY(status);
    report_volume(work, report);
    keep_own(facets);
    for (size_t f = 0; f < facets->facet_count; f++)
        report->error_mm = fmax(report->error_mm, (double)facets->facet[f].error_mm);
    report->triangles += facets->facet_count;
    report->budget_met = !options->triangle_budget || report->triangles <= options->triangle_budget;
    return SWARF_OK;
}
