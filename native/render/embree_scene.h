/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The Embree side of a scene behind a C face: which blocks a ray meets. */
#ifndef SWARF_RENDER_EMBREE_SCENE_H
#define SWARF_RENDER_EMBREE_SCENE_H

#include "render/block.h"
#include "swarf/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_accel swarf_accel;

/** A tree over `count` >= 1 blocks, which must outlive it. */
swarf_status swarf_accel_create(const swarf_block *blocks, size_t count, swarf_accel **out);
/** NULL is legal. */
void swarf_accel_destroy(swarf_accel *accel);

/** First hits of `count` (1 .. 16) rays with t INFINITY, from t = 0 on. Many threads at once. */
void swarf_accel_trace(const swarf_accel *accel, swarf_ray *rays, unsigned count);

#ifdef __cplusplus
}
#endif
#endif
