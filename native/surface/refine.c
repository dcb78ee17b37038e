/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Many points onto the surface: sorted into cells, so that what a cell needs is gathered once for all of its points.
 * A place is the number of its cell, 21 bits per axis; they are sorted digit by digit of those bits up to which they
 * differ on each axis. */
#include "base/parallel.h"
#include "base/status.h"
#include "surface/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Edge of a cell in voxels: larger ones gather less often, but more. */
static const double cell_voxels = 6;
/* Points this close, as a part of the reach, are on the surface. */
static const double on_surface = 1e-9;

struct place {
    uint64_t cell;
    uint32_t point;
};

enum { AXIS_BITS = 21, DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS };
/* Points that one piece of work finds the cells of: some 0.1 ms. */
enum { PIECE = 1 << 12 };

struct refining {
    const swarf_surface *surface;
    size_t moves;
    double part; /* of the next move */
    swarf_surface_lines lines;
    double tolerance;
    swarf_surface_feet feet;
    swarf_surface_point *found_out; /* instead of feet */
    double edge;
    struct place *places;
    const size_t *runs; /* where the places of each cell start */
    swarf_surface_near **near;
    int near_count;
};

static void along(const double p[3], const double d[3], double s, double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = p[k] + s * d[k];
}

/* Newton steps first; where they do not end, the nearest change of sign on a row of samples. The step from within the
 * tolerance is the last one: nobody looks from where it leads. */
static int find_zero(const struct refining *work, const swarf_surface_near *near, const double p[3], const double d[3],
                     double *s, swarf_surface_point *found)
{
    const double reach = work->lines.reach_mm;
    double q[3];
    *s = 0;
    for (int step = 0; step < 8; step++) {
        along(p, d, *s, q);
        swarf_surface_evaluate(near, q, found);
        if (fabs(found->value) <= on_surface * reach) return 1;
        const double slope = found->normal[0] * d[0] + found->normal[1] * d[1] + found->normal[2] * d[2];
        if (fabs(slope) < 0.2) break;
        *s -= found->value / slope;
        if (fabs(*s) > reach) break;
        if (fabs(found->value) <= work->tolerance) return 1;
    }
    enum { SAMPLES = 8 };
    swarf_surface_evaluate(near, p, found);
    int is_in[2] = {found->value < 0, found->value < 0}; /* the last sample back, and forth */
    for (int i = 1; i <= SAMPLES; i++)
        for (int side = -1; side <= 1; side += 2) {
            double a[3], b[3], t;
            along(p, d, side * reach * i / SAMPLES, b);
            swarf_surface_evaluate(near, b, found);
            const int was_in = is_in[side > 0];
            is_in[side > 0] = found->value < 0;
            if (is_in[side > 0] == was_in) continue;
            along(p, d, side * reach * (i - 1) / SAMPLES, a);
            if (!swarf_surface_crossing(near, a, b, on_surface * reach, &t, found)) continue;
            *s = side * reach * (i - 1 + t) / SAMPLES;
            return 1;
        }
    return 0;
}

static void refine_point(const struct refining *work, const swarf_surface_near *near, size_t i)
{
    double p[3], d[3], s;
    memcpy(p, work->lines.points + 3 * i, sizeof p);
    const double *given = work->lines.directions + 3 * i;
    const double length = sqrt(given[0] * given[0] + given[1] * given[1] + given[2] * given[2]);
    for (int k = 0; k < 3; k++) d[k] = given[k] / length;
    swarf_surface_point found;
    const int ok = find_zero(work, near, p, d, &s, &found);
    if (work->found_out) {
        if (!ok) found = (swarf_surface_point){.move = -2};
        work->found_out[i] = found;
        return;
    }
    along(p, d, ok ? s : 0, work->feet.points + 3 * i);
    for (int k = 0; k < 3 && work->feet.normals; k++)
        work->feet.normals[3 * i + (size_t)k] = ok ? found.normal[k] : d[k];
    if (work->feet.moves) work->feet.moves[i] = ok ? found.move : -2;
}

static swarf_status refine_cell_with(const struct refining *work, swarf_surface_near *near, size_t run)
{
    const struct place *first = &work->places[work->runs[run]];
    swarf_box box;
    for (int k = 0; k < 3; k++) {
        box.lo[k] = INFINITY;
        box.hi[k] = -INFINITY;
        for (size_t i = 0; i < work->runs[run + 1] - work->runs[run]; i++) {
            const double at = work->lines.points[3 * (size_t)first[i].point + (size_t)k];
            box.lo[k] = fmin(box.lo[k], at - work->lines.reach_mm);
            box.hi[k] = fmax(box.hi[k], at + work->lines.reach_mm);
        }
    }
    SWARF_TRY(swarf_surface_gather_part(near, work->moves, work->part, &box));
    for (size_t i = 0; i < work->runs[run + 1] - work->runs[run]; i++) refine_point(work, near, first[i].point);
    return SWARF_OK;
}

static swarf_status refine_cell(void *context, size_t run)
{
    const struct refining *work = context;
    /* the number of threads may have been raised since the scratch was made */
    const int slot = swarf_parallel_slot();
    if (slot < work->near_count) return refine_cell_with(work, work->near[slot], run);
    swarf_surface_near *own = NULL;
    SWARF_TRY(swarf_surface_near_create(work->surface, &own));
    const swarf_status status = refine_cell_with(work, own, run);
    swarf_surface_near_destroy(own);
    return status;
}

/* Cells beyond what 21 bits can tell are taken as one: it is only that more is gathered there. */
static uint64_t cell_of(const double point[3], double edge)
{
    const double most = 1 << (AXIS_BITS - 1);
    uint64_t cell = 0;
    for (int k = 0; k < 3; k++) {
        const double along = fmax(-most, fmin(most - 1, floor(point[k] / edge))) + most;
        cell = cell << AXIS_BITS | (uint64_t)along;
    }
    return cell;
}

/* Leave out the bits of the cells in which none differs from another, above those of each axis; how many are left. */
static int shorten(struct place *places, size_t count)
{
    uint64_t some = 0, all = UINT64_MAX;
    int bits[3], sum = 0;
    for (size_t i = 0; i < count; i++) {
        some |= places[i].cell;
        all &= places[i].cell;
    }
    const uint64_t axis_mask = (1u << AXIS_BITS) - 1;
    for (int k = 0; k < 3; k++) {
        const uint64_t differ = (some ^ all) >> (k * AXIS_BITS) & axis_mask;
        bits[k] = differ ? 64 - __builtin_clzll(differ) : 0;
        sum += bits[k];
    }
    for (size_t i = 0; i < count; i++) {
        uint64_t cell = 0;
        for (int k = 2; k >= 0; k--) {
            const uint64_t own = places[i].cell >> (k * AXIS_BITS);
            cell = cell << bits[k] | (own & ((1u << bits[k]) - 1));
        }
        places[i].cell = cell;
    }
    return sum;
}

/* Sort by cells, stable; `spare` has room for as many. Where they are then: one of both. */
static struct place *sort_places(struct place *places, struct place *spare, size_t count)
{
    const int bits = shorten(places, count);
    for (int shift = 0; shift < bits; shift += DIGIT_BITS) {
        size_t start[DIGITS + 1] = {0};
        for (size_t i = 0; i < count; i++) start[(places[i].cell >> shift & (DIGITS - 1)) + 1]++;
        for (int digit = 0; digit < DIGITS; digit++) start[digit + 1] += start[digit];
        for (size_t i = 0; i < count; i++) spare[start[places[i].cell >> shift & (DIGITS - 1)]++] = places[i];
        struct place *const sorted = spare;
        spare = places;
        places = sorted;
    }
    return places;
}

static swarf_status check_point(const struct refining *work, size_t i)
{
    const double *p = work->lines.points + 3 * i, *d = work->lines.directions + 3 * i;
    for (int k = 0; k < 3; k++)
        SWARF_REQUIRE(isfinite(p[k]) && isfinite(d[k]),
                      "surface: coordinate %c of point or direction %zu is not finite", "xyz"[k], i);
    SWARF_REQUIRE(d[0] != 0 || d[1] != 0 || d[2] != 0, "surface: direction %zu has no length", i);
    return SWARF_OK;
}

static swarf_status place_some(void *context, size_t piece)
{
    const struct refining *work = context;
    for (size_t i = piece * PIECE; i < (piece + 1) * PIECE && i < work->lines.count; i++) {
        SWARF_TRY(check_point(work, i));
        work->places[i] = (struct place){.cell = cell_of(work->lines.points + 3 * i, work->edge), .point = (uint32_t)i};
    }
    return SWARF_OK;
}

static swarf_status refine_sorted(struct refining *work, struct place *places, struct place *spare, size_t *runs,
                                  const swarf_progress *progress)
{
    const size_t count = work->lines.count;
    work->places = places;
    SWARF_TRY(swarf_parallel_for((count + PIECE - 1) / PIECE, place_some, work, NULL, 0, 1));
    places = sort_places(places, spare, count);
    size_t cells = 0;
    for (size_t i = 0; i < count; i++)
        if (i == 0 || places[i].cell != places[i - 1].cell) runs[cells++] = i;
    runs[cells] = count;
    work->places = places;
    work->runs = runs;
    work->near_count = swarf_threads();
    work->near = calloc((size_t)work->near_count, sizeof *work->near);
    swarf_status status = work->near ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "surface: out of memory");
    for (int i = 0; i < work->near_count && status == SWARF_OK; i++)
        status = swarf_surface_near_create(work->surface, &work->near[i]);
    if (status == SWARF_OK) status = swarf_parallel_for(cells, refine_cell, work, progress, 0, 1);
    for (int i = 0; work->near && i < work->near_count; i++) swarf_surface_near_destroy(work->near[i]);
    free(work->near);
    return status;
}

static swarf_status refine(struct refining *work, const swarf_progress *progress)
{
    const size_t count = work->lines.count;
    SWARF_REQUIRE(isfinite(work->lines.reach_mm) && work->lines.reach_mm > 0,
                  "surface: reach %g mm is not a positive number", work->lines.reach_mm);
    SWARF_REQUIRE(count < UINT32_MAX, "surface: %zu points at once are too many", count);
    work->edge = cell_voxels * work->surface->voxel;
    struct place *places = malloc(2 * (count + 1) * sizeof *places);
    size_t *runs = malloc((count + 1) * sizeof *runs);
    const swarf_status status = places && runs ? refine_sorted(work, places, places + count, runs, progress)
                                               : swarf_fail(SWARF_ERROR_MEMORY, "surface: out of memory");
    free(places);
    free(runs);
    return status;
}

static int are_there(const swarf_surface *surface, const swarf_surface_lines *lines, const void *out)
{
    return surface && lines && (lines->count == 0 || (lines->points && lines->directions && out));
}

swarf_status swarf_surface_refine_to(const swarf_surface *surface, size_t moves, double part,
                                     const swarf_surface_lines *lines, double tolerance_mm,
                                     const swarf_progress *progress, const swarf_surface_feet *out)
{
    SWARF_REQUIRE(out && are_there(surface, lines, out->points), "surface: NULL");
    struct refining work = {
        .surface = surface, .moves = moves, .part = part, .lines = *lines, .tolerance = tolerance_mm, .feet = *out};
    return refine(&work, progress);
}

swarf_status swarf_surface_refine(const swarf_surface *surface, size_t moves, const swarf_surface_lines *lines,
                                  const swarf_progress *progress, const swarf_surface_feet *out)
{
    return swarf_surface_refine_to(surface, moves, 0, lines, 0, progress, out);
}

swarf_status swarf_surface_find(const swarf_surface *surface, size_t moves, const swarf_surface_lines *lines,
                                const swarf_progress *progress, swarf_surface_point *out)
{
    SWARF_REQUIRE(are_there(surface, lines, out), "surface: NULL");
    struct refining work = {.surface = surface, .moves = moves, .lines = *lines, .found_out = out};
    return refine(&work, progress);
}
