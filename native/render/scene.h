/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Tracing inside the render room. */
#ifndef SWARF_RENDER_SCENE_H
#define SWARF_RENDER_SCENE_H

#include "render/ray_kernel.h"
#include "render/recall.h"
#include "swarf/render.h"

/** First hits of `count` <= SWARF_GROUP packets. Rays that start in material meet nothing and have their bits in
 *  inside[i]. The scene has been entered. Many threads at once. */
void swarf_scene_trace(const swarf_scene *scene, swarf_rays rays[], unsigned inside[], int count);

/** Keep others from changing the stock while rays run over it, and bring the scene up to date with it:
 *  SWARF_ERROR_BUSY when it is in use. */
swarf_status swarf_scene_enter(swarf_scene *scene);
void swarf_scene_leave(swarf_scene *scene);

/** Memory for the picture in the making: kept from picture to picture, for fresh pages cost as much as rays. NULL when
 *  it is not there. */
void *swarf_scene_scratch(swarf_scene *scene, size_t bytes);

/** What the middles in that memory are of; forgotten when the memory, the stock or what stands on it changes. */
swarf_recall *swarf_scene_recall(swarf_scene *scene);

/** Box of the surface in mm, empty when there is none. */
void swarf_scene_box(const swarf_scene *scene, swarf_box *out);

/** NULL: none. */
const struct swarf_fixtures *swarf_scene_fixtures(const swarf_scene *scene);

/** The exact surface; NULL: none. */
const struct swarf_surface *swarf_scene_surface(const swarf_scene *scene);
/** Its moves, and the part of the next one, that stand. */
size_t swarf_scene_moves(const swarf_scene *scene, double *part);

/** Edge of a voxel, mm. */
double swarf_scene_voxel(const swarf_scene *scene);

/** Milliseconds that a ray of a picture takes, from what the pictures before took. */
double swarf_scene_ray_ms(const swarf_scene *scene);
void swarf_scene_note_ray_ms(swarf_scene *scene, double ray_ms);

#endif
