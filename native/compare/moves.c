/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Which moves are behind a place, and whether a design can belong to a stock at all. */
#include "base/parallel.h"
#include "base/status.h"
#include "compare/compare.h"
#include "swarf/sweep.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Clusters beyond these many are not worth a search of their own. */
enum { MOST_CLUSTERS = 256, MOST_MOVES = sizeof((swarf_cluster *)0)->moves / sizeof(int64_t) };

/* Behind a gouge is the deepest cut, as well as places on the stock's faces are known: voxels by which others may
 * differ. Of material left, mostly found on edges, cuts are as near that differ by less than some voxels, or a share of
 * what is left, up to a voxel. */
static const double as_deep = 0.02, least_near = 0.1, share_near = 0.25;

struct moves_work {
    swarf_cluster *clusters;
    double voxel;
    const swarf_program *program;
    const swarf_tool *tools;
    size_t tool_count;
};

static const swarf_cutter *find_cutter(const swarf_tool *tools, size_t count, int32_t number)
{
    for (size_t i = 0; i < count; i++)
        if (tools[i].number == number) return tools[i].cutter;
    return NULL;
}

/* Whether a path with a cutter of this size can come near a point. */
static int may_reach(const swarf_path *path, const double point[3], double radius, double height, double reach)
{
    for (int k = 0; k < 3; k++) {
        double lo = fmin(path->start[k], path->end[k]), hi = fmax(path->start[k], path->end[k]);
        if (path->is_arc) {
            const double *c = path->arc.centre;
            const double round = fmax(hypot(hypot(path->start[0] - c[0], path->start[1] - c[1]), path->start[2] - c[2]),
                                      hypot(hypot(path->end[0] - c[0], path->end[1] - c[1]), path->end[2] - c[2]));
            lo = fmin(lo, c[k] - round);
            hi = fmax(hi, c[k] + round);
        }
        if (point[k] < lo - reach - (k == 2 ? 0 : radius) || point[k] > hi + reach + (k == 2 ? height : radius))
            return 0;
    }
    return 1;
}

/* Put a move among the nearest, the first given first among equals; *best is the least distance so far. */
static void take_move(swarf_cluster *cluster, int64_t move, double distance, double near, double *best)
{
    if (distance > *best + near) return;
    if (distance < *best - near) cluster->move_count = 0;
    if (distance < *best) *best = distance;
    if (cluster->move_count < MOST_MOVES) cluster->moves[cluster->move_count++] = move;
}

/* Distance of a point to what a move sweeps, 0 in it; INFINITY where it sweeps nothing near. */
static swarf_status distance_to(const struct moves_work *work, size_t move, const double point[3], double *distance)
{
    const int32_t tool =
        swarf_program_sections(work->program)[swarf_move_get_section(&swarf_program_moves(work->program)[move])].tool;
    const swarf_cutter *cutter = find_cutter(work->tools, work->tool_count, tool);
    swarf_path path;
    *distance = INFINITY;
    if (!cutter) return SWARF_OK;
    SWARF_TRY(swarf_program_path(work->program, move, &path));
    const double radius = swarf_cutter_radius(cutter, SWARF_PART_FLUTES);
    if (!path.has_motion || !(radius > 0)) return SWARF_OK;
    double low, high;
    swarf_cutter_extent(cutter, SWARF_PART_FLUTES, &low, &high);
    const double wide = work->voxel + radius / 6; /* distances are right to three of these */
    if (!may_reach(&path, point, radius, high, 3 * wide)) return SWARF_OK;
    float value;
    SWARF_TRY(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, wide, point, 1, &value));
    if (value < 2.99 * wide) *distance = fmax(value, 0);
    return SWARF_OK;
}

/* mm by which moves may differ at a place and have both come as far. */
static double as_near(const struct moves_work *work, const swarf_cluster *cluster)
{
    if (!cluster->excess) return as_deep * work->voxel;
    return fmax(least_near * work->voxel, fmin(share_near * cluster->value_mm, work->voxel));
}

/* Who cut first is behind a gouge: whoever came there later found nothing left. Of material left, who came last had the
 * last chance to take it; a rapid is not meant to, and counts only where no feed came near. */
static swarf_status find_for_cluster(void *context, size_t index)
{
    const struct moves_work *work = context;
    swarf_cluster *cluster = &work->clusters[index];
    const swarf_move *moves = swarf_program_moves(work->program);
    const size_t count = swarf_program_move_count(work->program);
    const double near = as_near(work, cluster);
    double best = INFINITY, distance;
    cluster->move_count = 0;
    for (int rapids = 0; rapids < 2 && cluster->move_count == 0; rapids++)
        for (size_t i = 0; i < count; i++) {
            const size_t move = cluster->excess ? count - 1 - i : i;
            if (cluster->excess && (swarf_move_get_kind(&moves[move]) == SWARF_MOVE_RAPID) != rapids) continue;
            SWARF_TRY(distance_to(work, move, cluster->place, &distance));
            if (distance < INFINITY) take_move(cluster, (int64_t)move, distance, near, &best);
        }
    cluster->away_mm = cluster->move_count ? best : 0;
    return SWARF_OK;
}

swarf_status swarf_find_moves(swarf_cluster *clusters, size_t count, double voxel, const swarf_program *program,
                              const swarf_tool *tools, size_t tool_count, const swarf_progress *progress)
{
    struct moves_work work = {clusters, voxel, program, tools, tool_count};
    return swarf_parallel_for(count < MOST_CLUSTERS ? count : MOST_CLUSTERS, find_for_cluster, &work, progress, 0, 1);
}

/* A design this many times larger or smaller than its stock is in another unit. */
static const struct {
    double factor;
    const char *text;
} units[] = {{25.4, "mm instead of inches"}, {1 / 25.4, "inches instead of mm"}, {10, "mm instead of cm"},
             {0.1, "cm instead of mm"},      {1000, "mm instead of m"},          {0.001, "m instead of mm"}};

const char *swarf_place_name(swarf_place_kind kind)
{
    static const char *const names[SWARF_PLACE_COUNT] = {"", "unit", "empty", "beside", "out"};
    return (unsigned)kind < SWARF_PLACE_COUNT ? names[kind] : "";
}

swarf_status swarf_compare_place(swarf_stock *stock, const swarf_solid *design, swarf_place *out)
{
    SWARF_REQUIRE(stock && design && out, "compare: stock, design or output missing");
    swarf_box own;
    SWARF_TRY(swarf_stock_box(stock, &own));
    const swarf_box other = swarf_solid_get_facts(design).box;
    double edge = 0, design_edge = 0, beyond = 0;
    int overlap = 1;
    for (int k = 0; k < 3; k++) {
        edge = fmax(edge, own.hi[k] - own.lo[k]);
        design_edge = fmax(design_edge, other.hi[k] - other.lo[k]);
        beyond = fmax(beyond, fmax(own.lo[k] - other.lo[k], other.hi[k] - own.hi[k]));
        overlap &= own.lo[k] < other.hi[k] && other.lo[k] < own.hi[k];
    }
    swarf_place place = {.kind = SWARF_PLACE_WELL};
    const double ratio = edge > 0 ? design_edge / edge : 1;
    const size_t size = sizeof place.text, unit_count = sizeof units / sizeof units[0];
    size_t unit = 0;
    while (unit < unit_count && !(ratio > 0.55 * units[unit].factor && ratio < 1.2 * units[unit].factor &&
                                  fabs(log(units[unit].factor)) > 2))
        unit++;
    if (unit < unit_count) {
        place.kind = SWARF_PLACE_UNIT;
        place.value = ratio;
        place.factor = units[unit].factor;
        snprintf(place.text, size, "the design is %.4g times as large as the stock: is it in %s?", ratio,
                 units[unit].text);
    } else if (!(edge > 0)) {
        place.kind = SWARF_PLACE_EMPTY;
        snprintf(place.text, size, "nothing is left of the stock");
    } else if (!overlap) {
        place.kind = SWARF_PLACE_BESIDE;
        snprintf(place.text, size,
                 "the design (%.6g, %.6g, %.6g .. %.6g, %.6g, %.6g mm) lies beside the stock (%.6g, %.6g, "
                 "%.6g .. %.6g, %.6g, %.6g mm): is it in another place?",
                 other.lo[0], other.lo[1], other.lo[2], other.hi[0], other.hi[1], other.hi[2], own.lo[0], own.lo[1],
                 own.lo[2], own.hi[0], own.hi[1], own.hi[2]);
    } else if (beyond > 0.1 * edge) {
        place.kind = SWARF_PLACE_OUT;
        place.value = beyond;
        snprintf(place.text, size,
                 "the design reaches %.4g mm out of what is left of the stock: is it in the same place and unit?",
                 beyond);
    }
    *out = place;
    return SWARF_OK;
}
