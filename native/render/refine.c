/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The field knows a face to a hundredth of a voxel and cuts edges by a third of one; the sweeps know both. A ray's hit
 * goes along the ray to the zero of the sweeps nearby. Where the ray misses that - it went through what the field made
 * of an edge - the hit stays, and takes normal and move from the nearest place along its normal.
 */
#include "render/refine.h"

#include "base/parallel.h"
#include "base/status.h"
#include "swarf/surface.h"

#include <stdlib.h>

/* Voxels along the ray: what the field cuts off an edge, seen at 80 degrees. */
static const double reach_voxels = 2;
/* Sights refined at once: 12 MiB of scratch. */
enum { BATCH = 1 << 17 };

typedef struct batch {
    double *point, *direction, *normal; /* 3 each */
    double *found;                      /* 3 each */
    int64_t *move;
    size_t *sight;
    size_t count;
} batch;

static void take(const swarf_look *look, const swarf_sight *sight, const double place[2], size_t index, batch *b)
{
    double origin[3], direction[3];
    swarf_look_ray(look, place, origin, direction);
    for (int axis = 0; axis < 3; axis++) {
        b->direction[3 * b->count + (size_t)axis] = direction[axis];
        b->point[3 * b->count + (size_t)axis] = origin[axis] + sight->distance * direction[axis];
    }
    b->sight[b->count++] = index;
}

static void give(const swarf_look *look, const batch *b, size_t i, int moved, swarf_sight *sight)
{
    double way = 0;
    for (size_t axis = 0; axis < 3; axis++) {
        if (moved) {
            way += (b->found[3 * i + axis] - b->point[3 * i + axis]) * b->direction[3 * i + axis];
            sight->point[axis] = (float)(b->found[3 * i + axis] - look->middle[axis]);
        }
        sight->normal[axis] = (float)b->normal[3 * i + axis];
    }
    sight->distance += way;
    sight->move = b->move[i] < 0 ? -1 : (int32_t)b->move[i]; /* what set-ups before cut is the stock as it was */
}

static swarf_status refine(const swarf_look *look, batch *b, swarf_sight *sights)
{
    size_t moves, left = 0;
    const swarf_surface *surface = swarf_scene_surface(look->scene, &moves);
    const double reach = reach_voxels * swarf_scene_voxel(look->scene);
    SWARF_TRY(swarf_surface_refine(surface, moves, b->point, b->direction, b->count, reach, NULL, b->found, b->normal,
                                   b->move));
    for (size_t i = 0; i < b->count; i++) {
        if (b->move[i] != -2) {
            give(look, b, i, 1, &sights[b->sight[i]]);
            continue;
        }
        for (size_t axis = 0; axis < 3; axis++) {
            b->point[3 * left + axis] = b->point[3 * i + axis];
            b->direction[3 * left + axis] = sights[b->sight[i]].normal[axis];
        }
        b->sight[left++] = b->sight[i];
    }
    if (left == 0) return SWARF_OK;
    SWARF_TRY(
        swarf_surface_refine(surface, moves, b->point, b->direction, left, reach, NULL, b->found, b->normal, b->move));
    for (size_t i = 0; i < left; i++)
        if (b->move[i] != -2) give(look, b, i, 0, &sights[b->sight[i]]);
    return SWARF_OK;
}

swarf_status swarf_look_refine(const swarf_look *look, swarf_sight *sights, size_t count, swarf_place_fn place,
                               const void *context, const swarf_progress *progress, double from, double to)
{
    size_t moves;
    if (!swarf_scene_surface(look->scene, &moves) || count == 0) return SWARF_OK;
    const size_t room = count < BATCH ? count : BATCH;
    double *const numbers = malloc(room * 12 * sizeof *numbers);
    batch b = {.move = malloc(room * sizeof *b.move), .sight = malloc(room * sizeof *b.sight)};
    swarf_status status =
        numbers && b.move && b.sight ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
    b.point = numbers;
    b.direction = numbers + 3 * room;
    b.normal = numbers + 6 * room;
    b.found = numbers + 9 * room;
    for (size_t index = 0; status == SWARF_OK && index < count;) {
        for (b.count = 0; index < count && b.count < room; index++) {
            if (sights[index].seen != SWARF_SEEN_STOCK) continue;
            double at[2];
            if (place(context, index, at)) take(look, &sights[index], at, index, &b);
        }
        if (b.count) status = refine(look, &b, sights);
        if (status == SWARF_OK)
            status = swarf_progress_report(progress, from + (to - from) * (double)index / (double)count);
    }
    free(numbers);
    free(b.move);
    free(b.sight);
    return status;
}
