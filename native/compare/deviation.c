/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "base/parallel.h"
#include "base/status.h"
#include "compare/compare.h"
#include "solid/solid.h"
#include "stock/leaf.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Voxels by which values may be off, on smooth faces and within one voxel of edges: there the field is rounded. */
static const double smooth_error = 0.02, edge_error = 0.5;

/* Voxels that a feature of the design must be off by, beyond tolerance, to be found from the design's side: trilinear
 * values next to edges are rounded, and what is thinner than this the stock's own surface shows. */
static const double feature_error = 1;

/* A point within this many voxels of the first stock's surface lies on it. */
static const double untouched_error = 0.05;

/* More points on the design than this are not tried: it is far larger than the stock, which is said elsewhere. */
static const double most_design_points = 2e7;

enum { PIECE = 1024, BINS = 1 << 16 };

struct swarf_deviation {
    swarf_deviation_sums sums;
    swarf_samples on_stock;
    swarf_cluster *clusters;
    size_t cluster_count;
    /* the points as the caller sees them */
    float *xyz, *value;
    uint8_t *kind;
    double voxel;
};

struct work {
    const swarf_solid *design;
    const swarf_deviation_options *options;
    swarf_samples *samples;
    double voxel;
};

swarf_deviation_options swarf_deviation_options_default(void)
{
    return (swarf_deviation_options){.size = sizeof(swarf_deviation_options),
                                     .excess_mm = 0.05,
                                     .gouge_mm = 0.05,
                                     .region = {{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}}};
}

static swarf_status check_options(const swarf_deviation_options *o, const swarf_solid *design)
{
    SWARF_REQUIRE(o->size == sizeof *o, "deviation: options of another version");
    SWARF_REQUIRE(isfinite(o->excess_mm) && o->excess_mm > 0, "deviation: a tolerance of %g mm for material left",
                  o->excess_mm);
    SWARF_REQUIRE(isfinite(o->gouge_mm) && o->gouge_mm > 0, "deviation: a tolerance of %g mm for gouges", o->gouge_mm);
    SWARF_REQUIRE(isfinite(o->allowance_mm), "deviation: the allowance is not finite");
    SWARF_REQUIRE(!o->ignore || o->ignore_count == design->source_count,
                  "deviation: %zu marks for the %zu triangles of the design", o->ignore_count, design->source_count);
    for (int k = 0; k < 3; k++)
        SWARF_REQUIRE(o->region.lo[k] <= o->region.hi[k], "deviation: the region is empty in %c", "xyz"[k]);
    return SWARF_OK;
}

static int is_ignored(const swarf_deviation_options *o, const swarf_sample *sample)
{
    if (o->ignore && o->ignore[sample->triangle]) return 1;
    for (int k = 0; k < 3; k++)
        if (sample->xyz[k] < o->region.lo[k] || sample->xyz[k] > o->region.hi[k]) return 1;
    return 0;
}

/* Distances from the design; points are in the order of leaves, so that one's find tells how far to look for the next.
 */
static swarf_status measure_piece(void *context, size_t index)
{
    const struct work *work = context;
    const swarf_deviation_options *o = work->options;
    const size_t end = (index + 1) * PIECE < work->samples->count ? (index + 1) * PIECE : work->samples->count;
    swarf_solid_hit hit = {.place = SIZE_MAX};
    for (size_t i = index * PIECE; i < end; i++) {
        swarf_sample *sample = &work->samples->samples[i];
        double point[3], square = 0;
        for (int k = 0; k < 3; k++) {
            point[k] = sample->xyz[k];
            if (hit.place != SIZE_MAX) square += (point[k] - hit.point[k]) * (point[k] - hit.point[k]);
        }
        const double reach = hit.place == SIZE_MAX ? INFINITY : sqrt(square) * (1 + 1e-12) + 1e-300;
        swarf_solid_find(work->design, point, reach, &hit);
        if (hit.place == SIZE_MAX) swarf_solid_find(work->design, point, INFINITY, &hit);
        const double value = hit.distance - o->allowance_mm;
        const double error = work->voxel * (sample->kind & SWARF_POINT_EDGE ? edge_error : smooth_error);
        sample->value = (float)value;
        sample->triangle = work->design->source[hit.place];
        if (is_ignored(o, sample)) sample->kind |= SWARF_POINT_IGNORED;
        sample->beyond =
            !(sample->kind & SWARF_POINT_IGNORED) && (value > o->excess_mm + error || value < -o->gouge_mm - error);
    }
    return SWARF_OK;
}

/* Mark the points beyond tolerance that lie on the first stock. An allowance cannot be left where the stock has none.
 */
static swarf_status mark_untouched(swarf_samples *samples, const swarf_deviation_options *o, double voxel)
{
    size_t count = 0;
    for (size_t i = 0; i < samples->count; i++) count += samples->samples[i].beyond;
    double *points = malloc((3 * count + 1) * sizeof *points);
    float *values = malloc((count + 1) * sizeof *values);
    swarf_status status = SWARF_OK;
    if (!points || !values) status = swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    size_t used = 0;
    for (size_t i = 0; i < samples->count && status == SWARF_OK; i++)
        for (size_t k = 0; k < 3 && samples->samples[i].beyond; k++) points[used++] = samples->samples[i].xyz[k];
    if (status == SWARF_OK) status = swarf_stock_sample((swarf_stock *)o->first, points, count, values);
    used = 0;
    for (size_t i = 0; i < samples->count && status == SWARF_OK; i++) {
        swarf_sample *sample = &samples->samples[i];
        if (!sample->beyond || !(fabs((double)values[used++]) < untouched_error * voxel)) continue;
        sample->kind |= SWARF_POINT_UNTOUCHED;
        if (sample->value < 0 && sample->value + o->allowance_mm > -o->gouge_mm) sample->beyond = 0;
    }
    free(points);
    free(values);
    return status;
}

/* Percentiles of the area from fine bins between the least and the greatest value. */
static swarf_status find_percentiles(const swarf_deviation *d, swarf_deviation_sums *sums, double area)
{
    static const double share[7] = {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};
    const double width = (sums->most_mm - sums->least_mm) / BINS;
    double *bins = calloc(BINS, sizeof *bins), below = 0;
    if (!bins) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    for (size_t i = 0; i < d->on_stock.count; i++) {
        const swarf_sample *sample = &d->on_stock.samples[i];
        if (sample->kind) continue;
        const double at = width > 0 ? (sample->value - sums->least_mm) / width : 0;
        bins[at < BINS - 1 ? (size_t)at : BINS - 1] += sample->area;
    }
    int next = 0;
    for (int i = 0; i < BINS && next < 7; i++) {
        below += bins[i];
        while (next < 7 && below >= share[next] * area * (1 - 1e-9))
            sums->percentile_mm[next++] = sums->least_mm + (i + 0.5) * width;
    }
    free(bins);
    return SWARF_OK;
}

static swarf_status sum_up(swarf_deviation *d, double *counted)
{
    swarf_deviation_sums *sums = &d->sums;
    double area = 0, sum = 0, squares = 0, least = INFINITY, most = -INFINITY;
    sums->points = d->on_stock.count;
    for (size_t i = 0; i < d->on_stock.count; i++) {
        const swarf_sample *sample = &d->on_stock.samples[i];
        const double value = sample->value, own = sample->area;
        sums->area_mm2 += own;
        if (sample->beyond) {
            if (value < 0)
                sums->gouge_mm2 += own;
            else if (sample->kind & SWARF_POINT_UNTOUCHED)
                sums->not_reached_mm2 += own;
            else
                sums->excess_mm2 += own;
        }
        if (sample->kind) continue;
        area += own;
        sum += own * value;
        squares += own * value * value;
        least = value < least ? value : least;
        most = value > most ? value : most;
    }
    *counted = area;
    if (!(area > 0)) return SWARF_OK;
    sums->mean_mm = sum / area;
    sums->rms_mm = sqrt(squares / area);
    sums->least_mm = least;
    sums->most_mm = most;
    return find_percentiles(d, sums, area);
}

/* Points on the design for the caller's options: deviation instead of depth, and none that is ignored. */
static void take_design_samples(const swarf_deviation_options *o, swarf_samples *samples)
{
    size_t kept = 0;
    for (size_t i = 0; i < samples->count; i++)
        if (!is_ignored(o, &samples->samples[i])) samples->samples[kept++] = samples->samples[i];
    samples->count = kept;
}

static swarf_status show_points(swarf_deviation *d)
{
    const size_t count = d->on_stock.count;
    d->xyz = malloc((3 * count + 1) * sizeof *d->xyz);
    d->value = malloc((count + 1) * sizeof *d->value);
    d->kind = malloc(count + 1);
    if (!d->xyz || !d->value || !d->kind) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    for (size_t i = 0; i < count; i++) {
        memcpy(d->xyz + 3 * i, d->on_stock.samples[i].xyz, 3 * sizeof *d->xyz);
        d->value[i] = d->on_stock.samples[i].value;
        d->kind[i] = d->on_stock.samples[i].kind;
    }
    return SWARF_OK;
}

static swarf_status measure(swarf_deviation *d, const swarf_stock *stock, const swarf_solid *design,
                            const swarf_deviation_options *o, const swarf_progress *progress)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    const double voxel = d->voxel = layout->voxel;
    d->sums.error_mm = smooth_error * voxel;
    SWARF_TRY(swarf_sample_stock(stock, progress, 0, 0.1, &d->on_stock));
    struct work work = {design, o, &d->on_stock, voxel};
    SWARF_TRY(swarf_parallel_for((d->on_stock.count + PIECE - 1) / PIECE, measure_piece, &work, progress, 0.1, 0.5));
    if (o->first) SWARF_TRY(mark_untouched(&d->on_stock, o, voxel));
    double counted;
    SWARF_TRY(sum_up(d, &counted));
    const double spacing = fmax(voxel, sqrt(design->facts.area_mm2 / most_design_points));
    swarf_samples on_design = {0};
    /* an allowance is material that ought to be there: the design lies that deep in it */
    const double excess = o->excess_mm + o->allowance_mm, gouge = o->gouge_mm - o->allowance_mm;
    SWARF_TRY(swarf_sample_design(stock, design, spacing, excess + feature_error * voxel,
                                  fmax(gouge, 0) + feature_error * voxel, progress, 0.5, 0.6, &on_design,
                                  &d->sums.design_mm2));
    take_design_samples(o, &on_design);
    swarf_slot_difference *slots =
        calloc(swarf_layout_nodes(layout) * SWARF_NODE_SLOTS, sizeof *slots); /* 8 bytes for 512 voxels */
    swarf_status status = slots ? swarf_compare_slots(stock, design, progress, 0.6, 1, slots, &d->sums.volumes)
                                : swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    if (status == SWARF_OK)
        status = swarf_cluster_samples(stock, &d->on_stock, &on_design, slots, &d->clusters, &d->cluster_count);
    free(slots);
    free(on_design.samples);
    d->sums.passed = 1;
    for (size_t i = 0; i < d->cluster_count; i++)
        if (!d->clusters[i].excess || d->clusters[i].reached) d->sums.passed = 0;
    return status == SWARF_OK ? show_points(d) : status;
}

swarf_status swarf_deviation_create(swarf_stock *stock, const swarf_solid *design,
                                    const swarf_deviation_options *options, const swarf_progress *progress,
                                    swarf_deviation **out)
{
    SWARF_REQUIRE(stock && design && out, "deviation: stock, design or output missing");
    const swarf_deviation_options plain = swarf_deviation_options_default();
    if (!options) options = &plain;
    SWARF_TRY(check_options(options, design));
    swarf_deviation *deviation = calloc(1, sizeof *deviation);
    if (!deviation) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    swarf_status status = swarf_stock_enter_read(stock);
    if (status == SWARF_OK) {
        status = measure(deviation, stock, design, options, progress);
        swarf_stock_leave(stock);
    }
    if (status != SWARF_OK) {
        swarf_deviation_destroy(deviation);
        return status;
    }
    *out = deviation;
    return SWARF_OK;
}

void swarf_deviation_destroy(swarf_deviation *deviation)
{
    if (!deviation) return;
    free(deviation->on_stock.samples);
    free(deviation->clusters);
    free(deviation->xyz);
    free(deviation->value);
    free(deviation->kind);
    free(deviation);
}

swarf_deviation_sums swarf_deviation_get_sums(const swarf_deviation *deviation)
{
    return deviation ? deviation->sums : (swarf_deviation_sums){0};
}

const swarf_cluster *swarf_deviation_clusters(const swarf_deviation *deviation, size_t *count)
{
    *count = deviation ? deviation->cluster_count : 0;
    return deviation ? deviation->clusters : NULL;
}

size_t swarf_deviation_points(const swarf_deviation *deviation, const float **xyz, const float **value,
                              const uint8_t **kind)
{
    *xyz = deviation ? deviation->xyz : NULL;
    *value = deviation ? deviation->value : NULL;
    *kind = deviation ? deviation->kind : NULL;
    return deviation ? deviation->on_stock.count : 0;
}

swarf_status swarf_deviation_histogram(const swarf_deviation *deviation, double lo, double hi, size_t bins, double *out)
{
    SWARF_REQUIRE(deviation && out && bins > 0, "deviation: histogram without deviation, output or bins");
    SWARF_REQUIRE(isfinite(lo) && isfinite(hi) && lo < hi, "deviation: histogram from %g to %g mm", lo, hi);
    memset(out, 0, bins * sizeof *out);
    for (size_t i = 0; i < deviation->on_stock.count; i++) {
        const swarf_sample *sample = &deviation->on_stock.samples[i];
        if (sample->kind) continue;
        const double at = ((double)sample->value - lo) / (hi - lo) * (double)bins;
        out[at < 0 ? 0 : at >= (double)bins ? bins - 1 : (size_t)at] += sample->area;
    }
    return SWARF_OK;
}

swarf_status swarf_deviation_find_moves(swarf_deviation *deviation, const swarf_program *program,
                                        const swarf_tool *tools, size_t tool_count)
{
    SWARF_REQUIRE(deviation && program && (tools || tool_count == 0), "deviation: deviation, program or tools missing");
    return swarf_find_moves(deviation->clusters, deviation->cluster_count, deviation->voxel, program, tools,
                            tool_count);
}
