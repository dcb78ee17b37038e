/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Making a surface, and its first shape. */
#include "surface/surface.h"

#include "base/least.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/placement.h"
#include "base/status.h"
#include "stock/stock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Concave arcs of a meridian become chords, 1/200 of this part of a voxel off: 1/10000 of the stock's voxels. */
static const double chord_voxel = 0.02;

static double field_at(const swarf_surface *surface, const double point[3], double gradient[3])
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(surface->field->tree);
    int32_t base[3];
    double f[3], v[8];
    for (int k = 0; k < 3; k++) {
        const double at = (point[k] - layout->origin[k]) / layout->voxel;
        base[k] = (int32_t)floor(fmax(-2, fmin(1e9, at)));
        f[k] = fmax(0, fmin(1, at - base[k]));
    }
    for (int i = 0; i < 8; i++)
        v[i] = (double)swarf_stock_value(surface->field,
                                         (int32_t[3]){base[0] + (i >> 2), base[1] + (i >> 1 & 1), base[2] + (i & 1)});
    double value = 0;
    memset(gradient, 0, 3 * sizeof *gradient);
    for (int i = 0; i < 8; i++) {
        const int bit[3] = {i >> 2, i >> 1 & 1, i & 1};
        double w[3];
        for (int k = 0; k < 3; k++) w[k] = bit[k] ? f[k] : 1 - f[k];
        value += v[i] * w[0] * w[1] * w[2];
        for (int k = 0; k < 3; k++) gradient[k] += (bit[k] ? v[i] : -v[i]) * w[(k + 1) % 3] * w[(k + 2) % 3];
    }
    return value;
}

void swarf_surface_first(const swarf_surface *surface, const double point[3], swarf_surface_point *out)
{
    *out = (swarf_surface_point){.move = -1};
    double *n = out->normal;
    if (!surface->block) {
        out->value = field_at(surface, point, n);
    } else {
        double most = -INFINITY, square = 0;
        for (int k = 0; k < 3; k++) {
            const double below = surface->lo[k] - point[k], above = point[k] - surface->hi[k];
            const double away = swarf_most(below, above);
            if (away > most) {
                most = away;
                out->piece = 2 * k + (above > below);
            }
            if (away > 0) {
                square += away * away;
                n[k] = above > below ? away : -away;
            }
        }
        if (most <= 0) {
            out->value = most;
            n[out->piece / 2] = out->piece & 1 ? 1 : -1;
            return;
        }
        out->value = sqrt(square);
    }
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) n[k] = length > 0 ? n[k] / length : k == 2;
}

const swarf_body *swarf_surface_body(const swarf_surface *surface, size_t move)
{
    const uint32_t section = swarf_move_get_section(&swarf_program_moves(surface->program)[move]);
    const int32_t body = surface->section_body[section];
    return body >= 0 ? surface->bodies[body] : NULL;
}

swarf_status swarf_surface_trace(const swarf_surface *surface, size_t part, swarf_trace *out)
{
    const swarf_surface_part *own = &surface->parts[part];
    swarf_path path;
    SWARF_TRY(swarf_program_path(surface->program, own->move, &path));
    swarf_trace_make(swarf_surface_body(surface, own->move), &path, own->move, own->part, swarf_trace_parts(&path),
                     out);
    return SWARF_OK;
}

static swarf_status take_first(swarf_surface *surface, swarf_stock *first)
{
    SWARF_TRY(swarf_stock_enter_write(first));
    const swarf_tree_layout *layout = swarf_tree_get_layout(first->tree);
    surface->voxel = layout->voxel;
    surface->block = first->box_half[0] > 0 && layout->generation == 1;
    for (int k = 0; k < 3; k++) {
        surface->lo[k] = layout->origin[k] + (first->box_centre[k] - first->box_half[k]) * layout->voxel;
        surface->hi[k] = layout->origin[k] + (first->box_centre[k] + first->box_half[k]) * layout->voxel;
    }
    swarf_stock_leave(first);
    if (surface->block) return SWARF_OK;
    SWARF_TRY(swarf_stock_copy(first, &surface->field));
    SWARF_TRY(swarf_stock_enter_read(surface->field)); /* makes all its leaves; it is never written again */
    swarf_stock_leave(surface->field);
    return SWARF_OK;
}

static swarf_status take_tools(swarf_surface *surface, const swarf_tool *tools, size_t count)
{
    const size_t sections = swarf_program_section_count(surface->program);
    surface->bodies = calloc(count + 1, sizeof *surface->bodies);
    surface->section_body = malloc((sections + 1) * sizeof *surface->section_body);
    if (!surface->bodies || !surface->section_body) return swarf_fail(SWARF_ERROR_MEMORY, "surface: out of memory");
    surface->body_count = count;
    for (size_t i = 0; i < count; i++)
        if (tools[i].cutter)
            SWARF_TRY(swarf_body_create(tools[i].cutter, SWARF_PART_FLUTES, chord_voxel * surface->voxel,
                                        &surface->bodies[i]));
    for (size_t s = 0; s < sections; s++) {
        size_t i = 0;
        while (i < count && (tools[i].number != swarf_program_sections(surface->program)[s].tool || !tools[i].cutter))
            i++;
        surface->section_body[s] = i < count && surface->bodies[i]->component_count ? (int32_t)i : -1;
    }
    return SWARF_OK;
}

static swarf_status take_parts(swarf_surface *surface)
{
    const size_t moves = swarf_program_move_count(surface->program);
    SWARF_REQUIRE(moves < UINT32_MAX, "surface: %zu moves are too many", moves);
    size_t room = 0;
    for (size_t i = 0; i < moves; i++) {
        swarf_path path;
        double from[6], to[6]; /* turned axes cut nothing, here as in a simulation */
        SWARF_TRY(swarf_program_path(surface->program, i, &path));
        if (!path.has_motion || !swarf_surface_body(surface, i) ||
            swarf_program_move_axes(surface->program, i, from, to))
            continue;
        const uint32_t parts = swarf_trace_parts(&path);
        SWARF_TRY(
            swarf_array_reserve((void **)&surface->parts, &room, surface->part_count + parts, sizeof *surface->parts));
        for (uint32_t k = 0; k < parts; k++)
            surface->parts[surface->part_count++] = (swarf_surface_part){(uint32_t)i, k};
    }
    return SWARF_OK;
}

enum { PARTS_AT_ONCE = 4096 };

static swarf_status bound_parts(void *context, size_t index)
{
    swarf_surface *surface = context;
    const size_t first = index * PARTS_AT_ONCE;
    for (size_t i = first; i < first + PARTS_AT_ONCE && i < surface->part_count; i++) {
        swarf_trace trace;
        swarf_box box;
        SWARF_TRY(swarf_surface_trace(surface, i, &trace));
        swarf_trace_box(&trace, &box);
        for (int k = 0; k < 3; k++) {
            surface->level[0][i].lo[k] = nextafterf((float)box.lo[k], -INFINITY);
            surface->level[0][i].hi[k] = nextafterf((float)box.hi[k], INFINITY);
        }
    }
    return SWARF_OK;
}

static swarf_status build(swarf_surface *surface, const swarf_progress *progress)
{
    size_t count = surface->part_count;
    for (int n = 0;; n++) {
        surface->level[n] = malloc((count + 1) * sizeof *surface->level[n]);
        if (!surface->level[n]) return swarf_fail(SWARF_ERROR_MEMORY, "surface: out of memory");
        surface->level_count[n] = count;
        surface->levels = n + 1;
        if (n == 0)
            SWARF_TRY(
                swarf_parallel_for((count + PARTS_AT_ONCE - 1) / PARTS_AT_ONCE, bound_parts, surface, progress, 0, 1));
        for (size_t i = 0; n > 0 && i < count; i++) {
            const size_t first = i * SURFACE_FAN, below = surface->level_count[n - 1];
            swarf_surface_box box = surface->level[n - 1][first];
            for (size_t j = first + 1; j < first + SURFACE_FAN && j < below; j++)
                for (int k = 0; k < 3; k++) {
                    box.lo[k] = fminf(box.lo[k], surface->level[n - 1][j].lo[k]);
                    box.hi[k] = fmaxf(box.hi[k], surface->level[n - 1][j].hi[k]);
                }
            surface->level[n][i] = box;
        }
        if (count <= SURFACE_FAN || n + 1 == SURFACE_LEVELS) return SWARF_OK;
        count = (count + SURFACE_FAN - 1) / SURFACE_FAN;
    }
}

/* Of the stock `first`, or of the set-up in `from`. */
static swarf_status create(swarf_stock *first, const swarf_surface *from, const swarf_program *program,
                           const swarf_tool *tools, size_t tool_count, const swarf_progress *progress,
                           swarf_surface **out)
{
    swarf_surface *surface = calloc(1, sizeof *surface);
    if (!surface) return swarf_fail(SWARF_ERROR_MEMORY, "surface: out of memory");
    surface->references = 1;
    surface->program = swarf_program_retain((swarf_program *)program); /* only its count changes */
    swarf_status status = SWARF_OK;
    if (first) {
        status = take_first(surface, first);
    } else {
        surface->voxel = from->before->voxel;
        surface->before = swarf_surface_retain(from->before);
        surface->before_moves = from->before_moves;
        surface->placement = from->placement;
        surface->back = swarf_placement_inverse(&from->placement);
    }
    if (status == SWARF_OK) status = take_tools(surface, tools, tool_count);
    if (status == SWARF_OK) status = take_parts(surface);
    if (status == SWARF_OK) status = build(surface, progress);
    if (status != SWARF_OK) {
        swarf_surface_release(surface);
        return status;
    }
    *out = surface;
    return SWARF_OK;
}

swarf_status swarf_surface_create(swarf_stock *first, const swarf_program *program, const swarf_tool *tools,
                                  size_t tool_count, const swarf_progress *progress, swarf_surface **out)
{
    SWARF_REQUIRE(first && program && out && (tools || tool_count == 0), "surface: stock, program or tools missing");
    return create(first, NULL, program, tools, tool_count, progress, out);
}

swarf_status swarf_surface_create_next(const swarf_surface *before, size_t moves, const swarf_placement *placement,
                                       const swarf_program *program, const swarf_tool *tools, size_t tool_count,
                                       const swarf_progress *progress, swarf_surface **out)
{
    SWARF_REQUIRE(before && placement && program && out && (tools || tool_count == 0),
                  "surface: the set-up before, placement, program or tools missing");
    SWARF_TRY(swarf_placement_check(placement));
    const size_t all = swarf_program_move_count(before->program);
    const swarf_surface from = {.before = (swarf_surface *)before, /* only its count changes */
                                .before_moves = moves < all ? moves : all,
                                .placement = *placement};
    return create(NULL, &from, program, tools, tool_count, progress, out);
}

void swarf_surface_origin(const swarf_surface *surface, int64_t move, int *set_up, int64_t *index)
{
    *set_up = 0;
    *index = move;
    if (move >= 0) return;
    int64_t left = -3 - move; /* among the moves of the set-ups before, the latest first */
    for (const swarf_surface *at = surface->before; at; at = at->before) {
        const int64_t moves = (int64_t)swarf_program_move_count(at->program);
        ++*set_up;
        if (left >= 0 && left < moves) {
            *index = left;
            return;
        }
        left -= moves;
    }
    *index = -1;
}

swarf_surface *swarf_surface_retain(swarf_surface *surface)
{
    if (surface) __atomic_add_fetch(&surface->references, 1, __ATOMIC_RELAXED);
    return surface;
}

void swarf_surface_release(swarf_surface *surface)
{
    if (!surface || __atomic_sub_fetch(&surface->references, 1, __ATOMIC_ACQ_REL) > 0) return;
    for (int n = 0; n < surface->levels; n++) free(surface->level[n]);
    for (size_t i = 0; surface->bodies && i < surface->body_count; i++) swarf_body_destroy(surface->bodies[i]);
    free(surface->bodies);
    free(surface->section_body);
    free(surface->parts);
    swarf_stock_destroy(surface->field);
    swarf_surface_release(surface->before);
    swarf_program_release(surface->program);
    free(surface);
}
