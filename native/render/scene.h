/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Tracing inside the render room. */
#ifndef SWARF_RENDER_SCENE_H
#define SWARF_RENDER_SCENE_H

#include "swarf/render.h"

/** Most rays of one packet. */
enum { SWARF_PACKET = 16 };

/** First hits of up to SWARF_PACKET rays, as swarf_scene_cast() without its checks: all numbers are finite, no
 *  direction is zero, the stock has been entered. Many threads at once. */
swarf_status swarf_scene_trace(const swarf_scene *scene, const double *origin, const double *direction, unsigned count,
                               double *distance, float *normal);

/** Keep others from changing the stock while rays run over it: SWARF_ERROR_BUSY when it is in use. */
swarf_status swarf_scene_enter(const swarf_scene *scene);
void swarf_scene_leave(const swarf_scene *scene);

/** Box of the surface in mm, empty when there is none. */
void swarf_scene_box(const swarf_scene *scene, swarf_box *out);

/** Milliseconds that a ray of a picture takes, from what the pictures before took. */
double swarf_scene_ray_ms(const swarf_scene *scene);
void swarf_scene_note_ray_ms(swarf_scene *scene, double ray_ms);

#endif
