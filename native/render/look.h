/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Looking: what the rays of a picture meet. */
#ifndef SWARF_RENDER_LOOK_H
#define SWARF_RENDER_LOOK_H

#include "render/camera.h"
#include "render/revolve.h"
#include "render/scene.h"

/** What one ray met. */
typedef struct swarf_sight {
    double distance; /**< mm along the ray's unit direction, INFINITY: nothing */
    float point[3];  /**< mm from the look's `middle` */
    float normal[3]; /**< unit */
    int32_t move;    /**< as in swarf_picture_buffers */
    int32_t seen;    /**< swarf_seen */
} swarf_sight;

/** One view of a scene. */
typedef struct swarf_look {
    const swarf_scene *scene;
    swarf_camera_frame frame;
    swarf_ray_source source;
    double middle[3]; /**< of what is seen: floats are measured from here */
    double size;      /**< mm, diagonal of the box of what is seen */
    double pixel;     /**< mm per grid square, of parallel rays, or at depth 1 */
    swarf_revolve *cutter;
    swarf_cut_plane section[SWARF_SECTIONS_MAX]; /**< normals of length 1 */
    size_t section_count;
} swarf_look;

/** A view by this camera of what the options name; the scene has been entered. `rows` are the grid squares from the
 *  bottom to the top of the picture. End with swarf_look_end(). */
swarf_status swarf_look_begin(const swarf_scene *scene, const swarf_camera *camera,
                              const swarf_picture_options *options, int32_t rows, swarf_look *out);
void swarf_look_end(swarf_look *look);

/** The ray through a place (-1 .. 1) of the picture, its direction of unit length. */
void swarf_look_ray(const swarf_look *look, const double place[2], double origin[3], double direction[3]);

/** Places (x[i], y[i]), -1 .. 1 each, of a picture; the first `count` <= SWARF_PACKET count. */
typedef struct swarf_places {
    double x[SWARF_PACKET], y[SWARF_PACKET];
    unsigned count;
} swarf_places;

/** What the rays through `count` <= SWARF_GROUP packets of places meet: out[i] has room for those of places[i]. Many
 *  threads at once. */
void swarf_look_through(const swarf_look *look, const swarf_places places[], int count, swarf_sight *const out[]);

/** Send the rays through `count` <= SWARF_GROUP packets of places to the stock alone. */
void swarf_look_trace(const swarf_look *look, const swarf_places places[], int count, swarf_rays rays[]);

/** Whether the active rays of `count` <= SWARF_GROUP packets, which start at surfaces, meet something within their
 *  reach: bits of them in blocked[i]; of those that start in material, and see nothing of the stock, in inside[i]. */
void swarf_look_blocked(const swarf_look *look, swarf_rays rays[], unsigned blocked[], unsigned inside[], int count);

/** Edge (mm) of a grid square at the depth of a sight. */
double swarf_look_footprint(const swarf_look *look, const swarf_sight *sight);

#endif
