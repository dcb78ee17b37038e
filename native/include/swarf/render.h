/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Render: a picture of a stock by packet ray casting (Embree) over the leaves of its level set. */
#ifndef SWARF_RENDER_H
#define SWARF_RENDER_H

#include "stock.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum swarf_view {
    SWARF_VIEW_ISOMETRIC = 0,
    SWARF_VIEW_TOP,
    SWARF_VIEW_BOTTOM,
    SWARF_VIEW_FRONT,
    SWARF_VIEW_REAR,
    SWARF_VIEW_LEFT,
    SWARF_VIEW_RIGHT,
    SWARF_VIEW_COUNT
} swarf_view;

/** A camera: looks from `eye` to `target`, `up` upwards. Orthographic shows `height_mm` of the world from the
 *  bottom to the top of the picture; perspective has the vertical opening angle `fov_deg`. */
typedef struct swarf_camera {
    double eye[3];
    double target[3];
    double up[3];
    int32_t perspective;
    int32_t reserved;
    double height_mm;
    double fov_deg;
} swarf_camera;

/** The camera of a preset that shows the whole box in a picture of this aspect (width / height); an empty box gives
 *  some camera, so that a stock with nothing left can be pictured too. SWARF_ERROR_ARGUMENT: NULL, no such view,
 *  numbers not finite. Any thread. */
SWARF_API swarf_status swarf_camera_fit(swarf_view view, int perspective, const swarf_box *box, double aspect,
                                        swarf_camera *out);

/** Rays over one state of a stock. Holds nothing of the stock's samples: the stock must outlive it and must not
 *  change while it is used; make a new scene after cutting. One thread per object. */
typedef struct swarf_scene swarf_scene;
SWARF_API swarf_status swarf_scene_create(swarf_stock *stock, swarf_scene **out);
SWARF_API void swarf_scene_destroy(swarf_scene *scene);

/** First hits of `count` rays (origin and direction 3 doubles each, mm): distance along the direction in its units
 *  (INFINITY: none) and unit normal (3 floats each; zero without a hit). `normal` may be NULL. A ray that starts in
 *  material meets nothing. SWARF_ERROR_ARGUMENT names the ray with a zero direction or a number that is not finite;
 *  SWARF_ERROR_BUSY: the stock is in use. All cores; the same bits for any threads and any grouping of rays. */
SWARF_API swarf_status swarf_scene_cast(swarf_scene *scene, const double *origin, const double *direction, size_t count,
                                        double *distance, float *normal);

typedef struct swarf_picture_options {
    size_t size;
    int32_t width; /**< pixels, 1 .. 16384 */
    int32_t height;
    int32_t samples;     /**< 1, 2, 3 or 4: n * n rays for pixels where more than one face shows, else one */
    float colour[3];     /**< linear 0..1 base colour of the material */
    float background[4]; /**< RGBA at the bottom of the picture */
    float background_top[4];
} swarf_picture_options;
SWARF_API swarf_picture_options swarf_picture_options_default(void);

/** Gooch-shaded picture into `rgba` (4 * width * height bytes, rows from the top), sRGB, opaque unless the background
 * is not. */
SWARF_API swarf_status swarf_scene_picture(swarf_scene *scene, const swarf_camera *camera,
                                           const swarf_picture_options *options, const swarf_progress *progress,
                                           uint8_t *rgba);
/** Write RGBA pixels as PNG (libpng); written beside and renamed. */
SWARF_API swarf_status swarf_picture_write(const char *path, const uint8_t *rgba, int32_t width, int32_t height);

#ifdef __cplusplus
}
#endif
#endif
