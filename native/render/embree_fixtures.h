/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Fixtures: bodies of triangles beside the stock, behind a C face over Embree. */
#ifndef SWARF_RENDER_EMBREE_FIXTURES_H
#define SWARF_RENDER_EMBREE_FIXTURES_H

#include "render/ray_kernel.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_fixtures swarf_fixtures;

/** Copies the triangles. SWARF_ERROR_ARGUMENT for a vertex number out of range or a vertex beyond 1e6 mm. */
swarf_status swarf_fixtures_create(const swarf_triangles *triangles, size_t count, swarf_fixtures **out);
/** NULL is legal. */
void swarf_fixtures_destroy(swarf_fixtures *fixtures);
/** Their box in mm. */
void swarf_fixtures_box(const swarf_fixtures *fixtures, swarf_box *out);

/** First hits before rays->distance of rays `active`; updates distance and normal (towards the ray's origin) of those
 *  and returns their bits. Many threads at once. */
unsigned swarf_fixtures_trace(const swarf_fixtures *fixtures, swarf_rays *rays, unsigned active);

#ifdef __cplusplus
}
#endif
#endif
