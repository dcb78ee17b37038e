/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "render/look.h"

#include "base/status.h"
#include "render/vector.h"

swarf_status swarf_look_make(const swarf_scene *scene, const swarf_camera *camera, double aspect, swarf_look *out)
{
    swarf_look look = {.scene = scene};
    SWARF_TRY(swarf_camera_frame_make(camera, aspect, &look.frame));
    look.source.parallel = !look.frame.perspective;
    for (int axis = 0; axis < 3; axis++) {
        look.source.eye[axis] = look.frame.eye[axis];
        look.source.forward[axis] = look.frame.forward[axis];
        look.source.right[axis] = look.frame.half[0] * look.frame.right[axis];
        look.source.up[axis] = look.frame.half[1] * look.frame.up[axis];
    }
    if (!look.frame.perspective) {
        swarf_box box;
        swarf_scene_box(scene, &box);
        for (int corner = 0; corner < 8; corner++) {
            double behind = 0;
            for (int axis = 0; axis < 3; axis++) {
                const double at = corner >> axis & 1 ? box.hi[axis] : box.lo[axis];
                behind -= (at - look.frame.eye[axis]) * look.frame.forward[axis];
            }
            /* Parallel rays start behind all of the scene. One millimetre: clear of what lies right at the box's
             * corner. */
            if (box.lo[0] <= box.hi[0]) look.source.back = fmax(look.source.back, behind + 1);
        }
    }
    *out = look;
    return SWARF_OK;
}

void swarf_look_ray(const swarf_look *look, const double place[2], double origin[3], double direction[3])
{
    swarf_camera_frame_ray(&look->frame, place[0], place[1], origin, direction);
    (void)vector_normalise(direction);
    for (int axis = 0; axis < 3; axis++) origin[axis] -= look->source.back * direction[axis];
}

void swarf_look_through(const swarf_look *look, const double x[SWARF_PACKET], const double y[SWARF_PACKET],
                        unsigned count, swarf_sight out[])
{
    swarf_rays rays;
    swarf_ray_kernel_current()->aim(&look->source, x, y, &rays);
    rays.active = (1u << count) - 1;
    swarf_scene_trace(look->scene, &rays, NULL);
    for (unsigned ray = 0; ray < count; ray++) {
        swarf_sight *sight = &out[ray];
        const int hit = (int)(rays.hit >> ray & 1);
        sight->distance = rays.distance[ray];
        sight->move = -1;
        sight->seen = hit ? SWARF_SEEN_STOCK : SWARF_SEEN_NOTHING;
        for (int axis = 0; axis < 3; axis++) sight->normal[axis] = hit ? rays.normal[axis][ray] : 0;
    }
}
