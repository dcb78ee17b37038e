/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Rays of a caller over a scene. */
#include "base/parallel.h"
#include "base/status.h"
#include "render/scene.h"

#include <math.h>
#include <string.h>

typedef struct cast {
    const swarf_scene *scene;
    const double *origin, *direction;
    size_t count;
    double *distance;
    float *normal;
} cast;

/* Packets that one piece of work traces: some 0.1 ms. */
enum { PACKETS = 32 };

static void take(const cast *c, size_t first, swarf_rays *rays, double length[SWARF_PACKET])
{
    rays->active = 0;
    for (int lane = 0; lane < SWARF_PACKET && first + (size_t)lane < c->count; lane++) {
        const double *o = c->origin + 3 * (first + (size_t)lane), *d = c->direction + 3 * (first + (size_t)lane);
        length[lane] = hypot(hypot(d[0], d[1]), d[2]);
        rays->reach[lane] = INFINITY;
        rays->active |= 1u << lane;
        for (int axis = 0; axis < 3; axis++) {
            rays->origin[axis][lane] = o[axis];
            rays->direction[axis][lane] = d[axis] / length[lane];
        }
    }
}

static void give(const cast *c, size_t first, const swarf_rays *rays, const double length[SWARF_PACKET])
{
    for (int lane = 0; rays->active >> lane & 1 && lane < SWARF_PACKET; lane++) {
        const size_t ray = first + (size_t)lane;
        const int hit = (int)(rays->hit >> lane & 1);
        c->distance[ray] = hit ? rays->distance[lane] / length[lane] : INFINITY;
        for (int axis = 0; c->normal && axis < 3; axis++)
            c->normal[3 * ray + (size_t)axis] = hit ? rays->normal[axis][lane] : 0;
    }
}

static swarf_status cast_some(void *context, size_t index)
{
    const cast *c = context;
    const size_t begin = index * PACKETS * SWARF_PACKET, end = begin + PACKETS * SWARF_PACKET;
    for (size_t first = begin; first < end && first < c->count; first += SWARF_GROUP * SWARF_PACKET) {
        swarf_rays rays[SWARF_GROUP];
        double length[SWARF_GROUP][SWARF_PACKET];
        unsigned inside[SWARF_GROUP];
        int count = 0;
        for (; count < SWARF_GROUP && first + (size_t)count * SWARF_PACKET < c->count; count++)
            take(c, first + (size_t)count * SWARF_PACKET, &rays[count], length[count]);
        swarf_scene_trace(c->scene, rays, inside, count);
        for (int i = 0; i < count; i++) give(c, first + (size_t)i * SWARF_PACKET, &rays[i], length[i]);
    }
    return SWARF_OK;
}

swarf_status swarf_scene_cast(swarf_scene *scene, const double *origin, const double *direction, size_t count,
                              double *distance, float *normal)
{
    SWARF_REQUIRE(scene && (count == 0 || (origin && direction && distance)), "rays: scene, rays or output missing");
    for (size_t ray = 0; ray < count; ray++) {
        double longest = 0;
        for (size_t place = 3 * ray; place < 3 * ray + 3; place++) {
            SWARF_REQUIRE(isfinite(origin[place]) && isfinite(direction[place]),
                          "rays: a number of ray %zu is not finite", ray);
            longest = fmax(longest, fabs(direction[place]));
        }
        SWARF_REQUIRE(longest > 0, "rays: the direction of ray %zu is zero", ray);
    }
    cast c = {scene, origin, direction, count, distance, normal};
    SWARF_TRY(swarf_scene_enter(scene));
    const swarf_status status =
        swarf_parallel_for((count + PACKETS * SWARF_PACKET - 1) / (PACKETS * SWARF_PACKET), cast_some, &c, NULL, 0, 1);
    swarf_scene_leave(scene);
    return status;
}
