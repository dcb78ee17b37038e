/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The field knows a face to a hundredth of a voxel and cuts edges by a third of one; the sweeps know both. A ray's hit
 * goes along the ray to the zero of the sweeps nearby. Where the ray misses that - it went through what the field made
 * of an edge - the hit stays, and takes normal and move from the nearest place along its normal.
 */
#include "render/refine.h"

#include "base/parallel.h"
#include "base/status.h"
#include "surface/surface.h"

#include <math.h>
#include <stdlib.h>

/* Voxels along the ray: what the field cuts off an edge, seen at 80 degrees. */
static const double reach_voxels = 2;
/* Sights refined at once: 12 MiB of scratch. */
enum { BATCH = 1 << 17 };

/* Of a batch, what one piece of work takes or gives: some 0.1 ms. */
enum { PIECE = 1 << 10 };

typedef struct batch {
    const swarf_look *look;
    const swarf_sights *sights;
    double *point, *direction, *normal; /* 3 each */
    double *found;                      /* 3 each */
    int64_t *move;
    size_t *sight;
    size_t count;
    double tolerance; /* mm */
    int moved;        /* what is found lies on the sights' rays */
} batch;

/** Points of the sights of a piece, and the ways of their rays. */
static swarf_status take_some(void *context, size_t piece)
{
    const batch *b = context;
    for (size_t i = piece * PIECE; i < (piece + 1) * PIECE && i < b->count; i++) {
        const swarf_sight *sight = &b->sights->sight[b->sight[i]];
        double at[2], origin[3], direction[3];
        (void)b->sights->place(b->sights->context, b->sight[i], at);
        swarf_look_ray(b->look, at, origin, direction);
        for (size_t axis = 0; axis < 3; axis++) {
            b->direction[3 * i + axis] = direction[axis];
            b->point[3 * i + axis] = origin[axis] + sight->distance * direction[axis];
        }
    }
    return SWARF_OK;
}

/** What was found goes to the sights of a piece. */
static swarf_status give_some(void *context, size_t piece)
{
    const batch *b = context;
    for (size_t i = piece * PIECE; i < (piece + 1) * PIECE && i < b->count; i++) {
        swarf_sight *sight = &b->sights->sight[b->sight[i]];
        double way = 0;
        if (b->move[i] == -2) continue;
        for (size_t axis = 0; axis < 3; axis++) {
            if (b->moved) {
                way += (b->found[3 * i + axis] - b->point[3 * i + axis]) * b->direction[3 * i + axis];
                sight->point[axis] = (float)(b->found[3 * i + axis] - b->look->middle[axis]);
            }
            sight->normal[axis] = (float)b->normal[3 * i + axis];
        }
        sight->distance += way;
        sight->move = b->move[i] < 0 ? -1 : (int32_t)b->move[i]; /* what set-ups before cut is the stock as it was */
    }
    return SWARF_OK;
}

static swarf_status find(batch *b, int moved, const swarf_progress *progress)
{
    double part;
    const size_t moves = swarf_scene_moves(b->look->scene, &part);
    const swarf_surface *surface = swarf_scene_surface(b->look->scene);
    const swarf_surface_lines lines = {b->point, b->direction, b->count,
                                       reach_voxels * swarf_scene_voxel(b->look->scene)};
    const swarf_surface_feet feet = {b->found, b->normal, b->move};
    b->moved = moved;
    SWARF_TRY(swarf_surface_refine_to(surface, moves, part, &lines, b->tolerance, progress, &feet));
    return swarf_parallel_for((b->count + PIECE - 1) / PIECE, give_some, b, NULL, 0, 1);
}

static swarf_status refine(batch *b, const swarf_progress *progress)
{
    size_t left = 0;
    SWARF_TRY(swarf_parallel_for((b->count + PIECE - 1) / PIECE, take_some, b, NULL, 0, 1));
    SWARF_TRY(find(b, 1, progress));
    for (size_t i = 0; i < b->count; i++) {
        if (b->move[i] != -2) continue;
        for (size_t axis = 0; axis < 3; axis++) {
            b->point[3 * left + axis] = b->point[3 * i + axis];
            b->direction[3 * left + axis] = b->sights->sight[b->sight[i]].normal[axis];
        }
        b->sight[left++] = b->sight[i];
    }
    b->count = left;
    return left ? find(b, 0, NULL) : SWARF_OK;
}

/** Edge (mm) of a grid square where it is least: as near to the eye as anything can be seen. */
static double least_footprint(const swarf_look *look)
{
    double square = 0;
    if (!look->frame.perspective) return look->pixel;
    for (int axis = 0; axis < 3; axis++)
        square += (look->middle[axis] - look->frame.eye[axis]) * (look->middle[axis] - look->frame.eye[axis]);
    return look->pixel * fmax(sqrt(square) - 0.5 * look->size, 0);
}

swarf_status swarf_look_refine(const swarf_look *look, const swarf_sights *sights, const swarf_progress *progress,
                               double from, double to)
{
    const size_t count = sights->count;
    if (!swarf_scene_surface(look->scene) || count == 0) return SWARF_OK;
    const size_t room = count < BATCH ? count : BATCH;
    double *const numbers = malloc(room * 12 * sizeof *numbers);
    batch b = {.look = look,
               .tolerance = sights->close_enough * least_footprint(look),
               .sights = sights,
               .move = malloc(room * sizeof *b.move),
               .sight = malloc(room * sizeof *b.sight)};
    swarf_status status =
        numbers && b.move && b.sight ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
    b.point = numbers;
    b.direction = numbers + 3 * room;
    b.normal = numbers + 6 * room;
    b.found = numbers + 9 * room;
    for (size_t index = 0; status == SWARF_OK && index < count;) {
        swarf_progress_share share = {progress, from + (to - from) * (double)index / (double)count, to};
        for (b.count = 0; index < count && b.count < room; index++)
            if (sights->sight[index].seen == SWARF_SEEN_STOCK && sights->place(sights->context, index, NULL))
                b.sight[b.count++] = index;
        share.to = from + (to - from) * (double)index / (double)count;
        const swarf_progress part = swarf_progress_part(&share);
        if (b.count) status = refine(&b, progress ? &part : NULL);
        if (status == SWARF_OK) status = swarf_progress_report(progress, share.to);
    }
    free(numbers);
    free(b.move);
    free(b.sight);
    return status;
}
