/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Looking: what the rays of a picture meet. */
#ifndef SWARF_RENDER_LOOK_H
#define SWARF_RENDER_LOOK_H

#include "render/camera.h"
#include "render/scene.h"

/** What one ray met. */
typedef struct swarf_sight {
    double distance; /**< mm along the ray's unit direction, INFINITY: nothing */
    float normal[3]; /**< unit, towards the side the ray came from */
    int32_t move;    /**< as in swarf_picture_buffers */
    int32_t seen;    /**< swarf_seen */
    int32_t reserved;
} swarf_sight;

/** One view of a scene. */
typedef struct swarf_look {
    const swarf_scene *scene;
    swarf_camera_frame frame;
    swarf_ray_source source;
} swarf_look;

/** A view by this camera; the scene has been entered. */
swarf_status swarf_look_make(const swarf_scene *scene, const swarf_camera *camera, double aspect, swarf_look *out);

/** The ray through a place (-1 .. 1) of the picture, its direction of unit length. */
void swarf_look_ray(const swarf_look *look, const double place[2], double origin[3], double direction[3]);

/** What the rays through `count` <= SWARF_PACKET places (x[i], y[i]) meet. Many threads at once. */
void swarf_look_through(const swarf_look *look, const double x[SWARF_PACKET], const double y[SWARF_PACKET],
                        unsigned count, swarf_sight out[]);

#endif
