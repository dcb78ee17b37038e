/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Judging what was measured by tolerances: no point is measured again. */
#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "compare/compare.h"
#include "solid/solid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* mm; stocks reach no farther, nor does any tolerance. */
static const double farthest = 1e6;

/* Voxels by which values may be off, on smooth faces and within one voxel of edges: there the field is rounded. */
static const double smooth_error = 0.02, edge_error = 0.5;

/* Points of one piece of work; bins that percentiles are found in. */
enum { PIECE = 1 << 14, BINS = 1 << 16 };

struct swarf_deviation {
    swarf_measured *measured;
    float *value;  /* of the points on the stock */
    uint8_t *kind; /* of these */
    swarf_deviation_sums sums;
    swarf_cluster *clusters;
    size_t cluster_count;
};

/* Sums over one piece of the points; added up in the order of the pieces, whatever thread made them. */
struct piece {
    swarf_samples beyond;
    double area, counted, sum, squares, least, most; /* `counted` and what follows: where values are smooth */
    double excess, gouge, not_reached;
};

struct work {
    const swarf_measured *measured;
    const swarf_deviation *deviation;
    const swarf_deviation_options *options;
    struct piece *pieces;
};

swarf_deviation_options swarf_deviation_options_default(void)
{
    return (swarf_deviation_options){.size = sizeof(swarf_deviation_options),
                                     .excess_mm = 0.05,
                                     .gouge_mm = 0.05,
                                     .region = {{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}}};
}

static swarf_status check_options(const swarf_deviation_options *o, size_t source_count)
{
    SWARF_REQUIRE(o->size == sizeof *o, "deviation: options of another version");
    SWARF_REQUIRE(o->excess_mm > 0 && o->excess_mm <= farthest, "deviation: a tolerance of %g mm for material left",
                  o->excess_mm);
    SWARF_REQUIRE(o->gouge_mm > 0 && o->gouge_mm <= farthest, "deviation: a tolerance of %g mm for gouges",
                  o->gouge_mm);
    SWARF_REQUIRE(fabs(o->allowance_mm) <= farthest, "deviation: an allowance of %g mm; -%g to %g are possible",
                  o->allowance_mm, farthest, farthest);
    SWARF_REQUIRE(!o->ignore || o->ignore_count == source_count,
                  "deviation: %zu marks for the %zu triangles of the design", o->ignore_count, source_count);
    for (int k = 0; k < 3; k++)
        SWARF_REQUIRE(o->region.lo[k] <= o->region.hi[k], "deviation: the region is empty in %c", "xyz"[k]);
    return SWARF_OK;
}

int swarf_deviation_ignores(const swarf_deviation_options *o, uint32_t triangle, const float xyz[3])
{
    if (o->ignore && o->ignore[triangle]) return 1;
    for (int k = 0; k < 3; k++)
        if (xyz[k] < o->region.lo[k] || xyz[k] > o->region.hi[k]) return 1;
    return 0;
}

/* Kind of a point, and whether it is beyond tolerance. */
static uint8_t judge_point(const struct work *work, size_t i, int *beyond)
{
    const swarf_deviation_options *o = work->options;
    const swarf_points *points = &work->measured->on_stock;
    const double distance = points->distance[i], value = distance - o->allowance_mm;
    uint8_t kind = points->kind[i] & SWARF_POINT_EDGE;
    *beyond = 0;
    if (swarf_deviation_ignores(o, points->triangle[i], points->xyz + 3 * i)) return kind | SWARF_POINT_IGNORED;
    const double error = work->measured->layout.voxel * (kind & SWARF_POINT_EDGE ? edge_error : smooth_error);
    *beyond = value > o->excess_mm + error || value < -o->gouge_mm - error;
    if (*beyond && points->kind[i] & SWARF_POINT_UNTOUCHED) {
        kind |= SWARF_POINT_UNTOUCHED;
        /* an allowance cannot be left where the stock has none */
        if (value < 0 && distance > -o->gouge_mm) *beyond = 0;
    }
    return kind;
}

static swarf_status judge_piece(void *context, size_t index)
{
    const struct work *work = context;
    const swarf_points *points = &work->measured->on_stock;
    const size_t end = (index + 1) * PIECE < points->count ? (index + 1) * PIECE : points->count;
    struct piece piece = {.least = INFINITY, .most = -INFINITY};
    size_t room = 0;
    for (size_t i = index * PIECE; i < end; i++) {
        int beyond;
        const uint8_t kind = judge_point(work, i, &beyond);
        const float value = (float)((double)points->distance[i] - work->options->allowance_mm);
        const double own = points->area[i], square = (double)value * value;
        work->deviation->kind[i] = kind;
        work->deviation->value[i] = value;
        piece.area += own;
        if (kind == 0) {
            piece.counted += own;
            piece.sum += own * value;
            piece.squares += own * square;
            piece.least = value < piece.least ? value : piece.least;
            piece.most = value > piece.most ? value : piece.most;
        }
        if (!beyond) continue;
        *(value < 0 ? &piece.gouge : kind & SWARF_POINT_UNTOUCHED ? &piece.not_reached : &piece.excess) += own;
        const swarf_status status = swarf_array_reserve((void **)&piece.beyond.samples, &room, piece.beyond.count + 1,
                                                        sizeof *piece.beyond.samples);
        if (status != SWARF_OK) {
            free(piece.beyond.samples);
            return status;
        }
        swarf_sample *sample = &piece.beyond.samples[piece.beyond.count++];
        *sample =
            (swarf_sample){.value = value, .area = points->area[i], .triangle = points->triangle[i], .kind = kind};
        memcpy(sample->xyz, points->xyz + 3 * i, sizeof sample->xyz);
    }
    work->pieces[index] = piece;
    return SWARF_OK;
}

/* Percentiles of the area from fine bins between the least and the greatest value. */
static swarf_status find_percentiles(const swarf_deviation *d, swarf_deviation_sums *sums, double area)
{
    static const double share[7] = {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};
    const double width = (sums->most_mm - sums->least_mm) / BINS;
    double *bins = calloc(BINS, sizeof *bins), below = 0;
    if (!bins) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    for (size_t i = 0; i < d->measured->on_stock.count; i++) {
        if (d->kind[i]) continue;
        const double at = width > 0 ? (d->value[i] - sums->least_mm) / width : 0;
        bins[at < BINS - 1 ? (size_t)at : BINS - 1] += d->measured->on_stock.area[i];
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

static swarf_status sum_up(swarf_deviation *d, const struct piece *pieces, size_t count)
{
    swarf_deviation_sums *sums = &d->sums;
    double area = 0, sum = 0, squares = 0, least = INFINITY, most = -INFINITY;
    sums->points = d->measured->on_stock.count;
    sums->design_mm2 = d->measured->design_mm2;
    sums->volumes = d->measured->volumes;
    sums->error_mm = smooth_error * d->measured->layout.voxel;
    for (size_t i = 0; i < count; i++) {
        sums->area_mm2 += pieces[i].area;
        sums->gouge_mm2 += pieces[i].gouge;
        sums->excess_mm2 += pieces[i].excess;
        sums->not_reached_mm2 += pieces[i].not_reached;
        area += pieces[i].counted;
        sum += pieces[i].sum;
        squares += pieces[i].squares;
        least = fmin(least, pieces[i].least);
        most = fmax(most, pieces[i].most);
    }
    if (!(area > 0)) return SWARF_OK;
    sums->mean_mm = sum / area;
    sums->rms_mm = sqrt(squares / area);
    sums->least_mm = least;
    sums->most_mm = most;
    return find_percentiles(d, sums, area);
}

static swarf_status join_beyond(const struct piece *pieces, size_t count, swarf_samples *out)
{
    swarf_samples all = {0};
    size_t total = 0;
    for (size_t i = 0; i < count; i++) total += pieces[i].beyond.count;
    all.samples = malloc((total + 1) * sizeof *all.samples);
    if (!all.samples) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory for %zu points", total);
    for (size_t i = 0; i < count; i++) {
        const swarf_samples *own = &pieces[i].beyond;
        if (own->count) memcpy(all.samples + all.count, own->samples, own->count * sizeof *own->samples);
        all.count += own->count;
    }
    *out = all;
    return SWARF_OK;
}

static swarf_status gather(swarf_deviation *d, const struct piece *pieces, size_t count,
                           const swarf_deviation_options *options, const swarf_progress *progress, double from)
{
    swarf_samples on_stock = {0}, on_design = {0};
    swarf_status status = join_beyond(pieces, count, &on_stock);
    if (status == SWARF_OK) status = swarf_find_missing(d->measured, options, progress, from, 1, &on_design);
    if (status == SWARF_OK)
        status = swarf_cluster_samples(&d->measured->layout, &on_stock, &on_design, d->measured->slots, &d->clusters,
                                       &d->cluster_count);
    free(on_stock.samples);
    free(on_design.samples);
    d->sums.passed = 1;
    for (size_t i = 0; i < d->cluster_count; i++)
        if (!d->clusters[i].excess || d->clusters[i].reached) d->sums.passed = 0;
    return status;
}

static swarf_status judge(swarf_deviation *d, const swarf_deviation_options *options, const swarf_progress *progress,
                          double from)
{
    const size_t points = d->measured->on_stock.count, count = (points + PIECE - 1) / PIECE;
    const double middle = 0.5 * (from + 1);
    struct work work = {d->measured, d, options, calloc(count + 1, sizeof(struct piece))};
    d->value = malloc((points + 1) * sizeof *d->value);
    d->kind = malloc(points + 1);
    swarf_status status = SWARF_OK;
    if (!work.pieces || !d->value || !d->kind) status = swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    if (status == SWARF_OK) status = swarf_parallel_for(count, judge_piece, &work, progress, from, middle);
    if (status == SWARF_OK) status = sum_up(d, work.pieces, count);
    if (status == SWARF_OK) status = gather(d, work.pieces, count, options, progress, middle);
    for (size_t i = 0; work.pieces && i < count; i++) free(work.pieces[i].beyond.samples);
    free(work.pieces);
    return status;
}

/* Takes one reference of `measured`. */
static swarf_status make(swarf_measured *measured, const swarf_deviation_options *options,
                         const swarf_progress *progress, double from, swarf_deviation **out)
{
    swarf_deviation *deviation = calloc(1, sizeof *deviation);
    if (!deviation) {
        swarf_measured_release(measured);
        return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    }
    deviation->measured = measured;
    const swarf_status status = judge(deviation, options, progress, from);
    if (status != SWARF_OK) {
        swarf_deviation_destroy(deviation);
        return status;
    }
    *out = deviation;
    return SWARF_OK;
}

swarf_status swarf_deviation_create(swarf_stock *stock, const swarf_solid *design,
                                    const swarf_deviation_options *options, const swarf_progress *progress,
                                    swarf_deviation **out)
{
    SWARF_REQUIRE(stock && design && out, "deviation: stock, design or output missing");
    const swarf_deviation_options plain = swarf_deviation_options_default();
    if (!options) options = &plain;
    SWARF_TRY(check_options(options, design->source_count));
    swarf_stock *first = (swarf_stock *)options->first; /* entered, not changed */
    SWARF_TRY(swarf_stock_enter_read(stock));
    swarf_measured *measured = NULL;
    swarf_status status = first ? swarf_stock_enter_read(first) : SWARF_OK;
    if (status == SWARF_OK) {
        status = swarf_measure(stock, design, first, progress, &measured);
        if (first) swarf_stock_leave(first);
    }
    swarf_stock_leave(stock);
    return status == SWARF_OK ? make(measured, options, progress, 1, out) : status;
}

swarf_status swarf_deviation_judge(const swarf_deviation *measured, const swarf_deviation_options *options,
                                   const swarf_progress *progress, swarf_deviation **out)
{
    SWARF_REQUIRE(measured && options && out, "deviation: deviation, options or output missing");
    SWARF_TRY(check_options(options, measured->measured->source_count));
    return make(swarf_measured_retain(measured->measured), options, progress, 0, out);
}

void swarf_deviation_destroy(swarf_deviation *deviation)
{
    if (!deviation) return;
    swarf_measured_release(deviation->measured);
    free(deviation->clusters);
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
    *xyz = deviation ? deviation->measured->on_stock.xyz : NULL;
    *value = deviation ? deviation->value : NULL;
    *kind = deviation ? deviation->kind : NULL;
    return deviation ? deviation->measured->on_stock.count : 0;
}

swarf_status swarf_deviation_histogram(const swarf_deviation *deviation, double lo, double hi, size_t bins, double *out)
{
    SWARF_REQUIRE(deviation && out && bins > 0, "deviation: histogram without deviation, output or bins");
    SWARF_REQUIRE(isfinite(lo) && isfinite(hi) && lo < hi, "deviation: histogram from %g to %g mm", lo, hi);
    memset(out, 0, bins * sizeof *out);
    for (size_t i = 0; i < deviation->measured->on_stock.count; i++) {
        if (deviation->kind[i]) continue;
        const double at = ((double)deviation->value[i] - lo) / (hi - lo) * (double)bins;
        out[at < 0 ? 0 : at >= (double)bins ? bins - 1 : (size_t)at] += deviation->measured->on_stock.area[i];
    }
    return SWARF_OK;
}

swarf_status swarf_deviation_find_moves(swarf_deviation *deviation, const swarf_program *program,
                                        const swarf_tool *tools, size_t tool_count, const swarf_progress *progress)
{
    SWARF_REQUIRE(deviation && program && (tools || tool_count == 0), "deviation: deviation, program or tools missing");
    return swarf_find_moves(deviation->clusters, deviation->cluster_count, deviation->measured->layout.voxel, program,
                            tools, tool_count, progress);
}
