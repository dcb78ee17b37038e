/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "render/look.h"

#include "base/status.h"
#include "render/vector.h"

#include <string.h>

swarf_status swarf_look_make(const swarf_scene *scene, const swarf_camera *camera, double aspect, swarf_look *out)
{
    swarf_look look = {.scene = scene};
    SWARF_TRY(swarf_camera_frame_make(camera, aspect, &look.frame));
    if (!look.frame.perspective) {
        swarf_box box;
        swarf_scene_box(scene, &box);
        for (int corner = 0; corner < 8; corner++) {
            double behind = 0;
            for (int axis = 0; axis < 3; axis++) {
                const double at = corner >> axis & 1 ? box.hi[axis] : box.lo[axis];
                behind -= (at - look.frame.eye[axis]) * look.frame.forward[axis];
            }
            /* One millimetre: clear of what lies right at the box's corner. */
            if (box.lo[0] <= box.hi[0]) look.back = fmax(look.back, behind + 1);
        }
    }
    *out = look;
    return SWARF_OK;
}

void swarf_look_ray(const swarf_look *look, const double place[2], double origin[3], double direction[3])
{
    swarf_camera_frame_ray(&look->frame, place[0], place[1], origin, direction);
    (void)vector_normalise(direction);
    for (int axis = 0; axis < 3; axis++) origin[axis] -= look->back * direction[axis];
}

swarf_status swarf_look_through(const swarf_look *look, const double place[][2], unsigned count, swarf_sight out[])
{
    double origin[3 * SWARF_PACKET] = {0}, direction[3 * SWARF_PACKET] = {0}, distance[SWARF_PACKET];
    float normal[3 * SWARF_PACKET];
    for (unsigned ray = 0; ray < count; ray++) swarf_look_ray(look, place[ray], origin + 3 * ray, direction + 3 * ray);
    SWARF_TRY(swarf_scene_trace(look->scene, origin, direction, count, distance, normal));
    for (unsigned ray = 0; ray < count; ray++) {
        out[ray] = (swarf_sight){.distance = distance[ray], .move = -1};
        out[ray].seen = isinf(distance[ray]) ? SWARF_SEEN_NOTHING : SWARF_SEEN_STOCK;
        memcpy(out[ray].normal, normal + 3 * ray, sizeof out[ray].normal);
    }
    return SWARF_OK;
}
