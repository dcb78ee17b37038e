/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The Embree side of a scene behind a C face: which cubes a ray meets. */
#ifndef SWARF_RENDER_EMBREE_SCENE_H
#define SWARF_RENDER_EMBREE_SCENE_H

#include "render/ray_kernel.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_accel swarf_accel;

/** A tree over no cubes. */
swarf_status swarf_accel_create(swarf_accel **out);
/** NULL is legal. */
void swarf_accel_destroy(swarf_accel *accel);

/** Make the tree one over these cubes, which it borrows; they have cells that stop rays. On failure it has none. */
swarf_status swarf_accel_set(swarf_accel *accel, const swarf_cube *const *cubes, size_t count);

/** First hits of the rays `active` before their t. Many threads at once. */
void swarf_accel_trace(const swarf_accel *accel, swarf_packet *rays, unsigned active);

#ifdef __cplusplus
}
#endif
#endif
