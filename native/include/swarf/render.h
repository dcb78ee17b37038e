/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Render: a picture of a stock by packet ray casting over the leaves of its level set. */
#ifndef SWARF_RENDER_H
#define SWARF_RENDER_H

#include "surface.h"

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

/** A camera: looks from `eye` to `target`, `up` upwards. Perspective has the vertical opening angle `fov_deg` and shows
 *  what is before the eye. Parallel rays show `height_mm` of the world from the bottom to the top of the picture,
 *  before and behind the eye. Places in a picture are x to the right and y upwards, both -1 .. 1 at its borders; its
 *  aspect is width / height. What the functions change is the camera they are given; all: any thread,
 *  SWARF_ERROR_ARGUMENT for NULL, a number that is not finite, eye at target, `up` along the view, height or angle out
 *  of range. */
typedef struct swarf_camera {
    double eye[3];
    double target[3];
    double up[3];
    int32_t perspective;
    int32_t reserved;
    double height_mm;
    double fov_deg;
} swarf_camera;

/** The camera of a preset that shows the whole box; an empty box gives some camera, so that a stock with nothing left
 *  can be pictured too. */
SWARF_API swarf_status swarf_camera_fit(swarf_view view, int perspective, const swarf_box *box, double aspect,
                                        swarf_camera *out);
/** Show the whole box from the direction the camera looks in; the box's middle becomes the target. */
SWARF_API swarf_status swarf_camera_fit_box(swarf_camera *camera, const swarf_box *box, double aspect);
/** Parallel rays instead of perspective or back, so that what lies at the target keeps its size. */
SWARF_API swarf_status swarf_camera_set_perspective(swarf_camera *camera, int perspective);
/** Turn by angle_deg, counter-clockwise, about the line through `pivot` along `axis`. */
SWARF_API swarf_status swarf_camera_turn(swarf_camera *camera, const double pivot[3], const double axis[3],
                                         double angle_deg);
/** Turn about `pivot` as if the part were dragged to the right and upwards by these angles: about the camera's own axes
 *  (a trackball), or, with `turntable`, about the vertical and only up to the poles, so that +z never tilts. */
SWARF_API swarf_status swarf_camera_orbit(swarf_camera *camera, const double pivot[3], double right_deg, double up_deg,
                                          int turntable);
/** Move so that what lies as deep as `depth_of` (NULL: the target) goes x to the right and y upwards in the picture,
 *  in heights of the picture. */
SWARF_API swarf_status swarf_camera_pan(swarf_camera *camera, double x, double y, const double *depth_of);
/** Show things `factor` times as large (> 0); the point `toward` stays at its place in the picture. */
SWARF_API swarf_status swarf_camera_zoom(swarf_camera *camera, double factor, const double toward[3]);
/** The ray through a place in the picture: unit direction. Parallel rays start in the eye's plane. */
SWARF_API swarf_status swarf_camera_ray(const swarf_camera *camera, double aspect, double x, double y, double origin[3],
                                        double direction[3]);
/** Where a point appears: x, y and its depth (mm along the view from the eye). With perspective, points that are not
 *  before the eye give x and y NAN. */
SWARF_API swarf_status swarf_camera_project(const swarf_camera *camera, double aspect, const double point[3],
                                            double out[3]);

/** What is shown of a stock, and rays over it. Holds nothing of the stock's samples: the stock must outlive it. After
 *  the stock has changed the next call brings the scene up to date by itself; swarf_scene_update() does it at a time of
 *  the caller's choice. One thread per object: SWARF_ERROR_BUSY when scene or stock are in use by another. */
typedef struct swarf_scene swarf_scene;
SWARF_API swarf_status swarf_scene_create(swarf_stock *stock, swarf_scene **out);
SWARF_API void swarf_scene_destroy(swarf_scene *scene);
SWARF_API swarf_status swarf_scene_update(swarf_scene *scene);

/** Show the stock as the exact surface (kept) that stands after its first `moves` moves and a part, 0 .. 1, of the next
 *  one's path, which must be those that the stock has seen: pictures then have sharp edges and true normals, and know
 *  their moves. NULL: the field alone. SWARF_ERROR_ARGUMENT: no such part. */
SWARF_API swarf_status swarf_scene_set_surface(swarf_scene *scene, swarf_surface *surface, size_t moves, double part);

/** Show these bodies beside the stock, in place of those before; count 0: none. The triangles are copied.
 *  SWARF_ERROR_ARGUMENT for a vertex number out of range or a coordinate beyond 1e6 mm. */
SWARF_API swarf_status swarf_scene_set_fixtures(swarf_scene *scene, const swarf_triangles *triangles, size_t count);

/** First hits of `count` rays (origin and direction 3 doubles each, mm) with the stock's surface: distance along the
 *  direction in its units (INFINITY: none) and unit normal (3 floats each; zero without a hit). `normal` may be NULL. A
 *  ray that starts in material meets nothing. SWARF_ERROR_ARGUMENT names the ray with a zero direction or a number that
 *  is not finite. All cores; the same bits for any threads, instruction set and grouping of rays. */
SWARF_API swarf_status swarf_scene_cast(swarf_scene *scene, const double *origin, const double *direction, size_t count,
                                        double *distance, float *normal);

/** What a pixel shows. */
typedef enum swarf_seen {
    SWARF_SEEN_NOTHING = 0,
    SWARF_SEEN_STOCK,
    SWARF_SEEN_SECTION, /**< the inside of the stock where a section cuts it */
    SWARF_SEEN_FLUTES,
    SWARF_SEEN_SHANK,
    SWARF_SEEN_HOLDER,
    SWARF_SEEN_FIXTURE,
    SWARF_SEEN_COUNT
} swarf_seen;

/** What the colour of the stock's surface says. All but the material and the deviation need `program`, and moves that
 *  are known. */
typedef enum swarf_colouring {
    SWARF_COLOURING_MATERIAL = 0,
    SWARF_COLOURING_OPERATION, /**< a colour per operation: swarf_picture_colour() */
    SWARF_COLOURING_TOOL,      /**< a colour per tool number */
    SWARF_COLOURING_AGE,       /**< from old to just cut, among the moves before `moves_done` */
    SWARF_COLOURING_FEED,      /**< from the slowest to the fastest feed */
    SWARF_COLOURING_DEVIATION, /**< `values`: excess red, gouge blue, within +- value_range / 10 green */
    SWARF_COLOURING_COUNT
} swarf_colouring;

/** A plane that takes away what lies on the side its normal points to. */
typedef struct swarf_cut_plane {
    double point[3];
    double normal[3];
} swarf_cut_plane;

typedef struct swarf_picture_options {
    size_t size;
    int32_t width; /**< pixels, 1 .. 16384 */
    int32_t height;
    int32_t samples;     /**< 1, 2, 3 or 4: n * n rays for pixels where more than one face shows, else one */
    int32_t coarse;      /**< 1 .. 16: one ray for coarse * coarse pixels, while things move */
    double budget_ms;    /**< > 0: as coarse as needed to be done in about this time, judged by the pictures before; the
                              picture then depends on the clock. `coarse` is the least. */
    int32_t exact;       /**< 1: the exact surface, where the scene has one; 0: the field alone, for speed */
    int32_t edges;       /**< 1: dark lines where faces meet or one hides the other */
    int32_t occlusion;   /**< 1: corners and pockets are darker, as under an overcast sky */
    int32_t shadow;      /**< 1: the light casts shadows */
    int32_t colouring;   /**< swarf_colouring */
    float colour[3];     /**< linear 0..1 base colour of the material */
    float background[4]; /**< RGBA at the bottom of the picture */
    float background_top[4];
    const float *values;            /**< width * height deviations (mm, excess > 0) for the colouring; NAN: none */
    double value_range;             /**< of the colours: -range .. range, mm */
    const swarf_cut_plane *section; /**< planes that cut stock and fixtures open; cut faces are hatched */
    size_t section_count;           /**< up to 6 */
    const swarf_cutter *cutter;     /**< shown at cutter_tip, axis +z; NULL: none */
    double cutter_tip[3];
    const swarf_program *program; /**< what colourings and the path are of; NULL: none */
    double moves_done;            /**< moves and part of a move that have been played */
    int32_t path;                 /**< 1: the tool's path: rapids and feeds, done and to come */
    size_t selected_first;        /**< surfaces and path of moves from this one on stand out, */
    size_t selected_count;        /**< as many as this; 0: none */
    const swarf_box *outline;     /**< its edges as lines; NULL: none */
    double axes_mm;               /**< length of x, y and z at the origin; 0: none */
} swarf_picture_options;
/** Linear RGB for a number (operation, tool): neighbours differ well, the first eight for the colour-blind too. Any
 *  thread. */
SWARF_API void swarf_picture_colour(int32_t number, float out[3]);
SWARF_API swarf_picture_options swarf_picture_options_default(void);

/** Where a picture goes: arrays of the caller with width * height entries, rows from the top; NULL where not wanted. */
typedef struct swarf_picture_buffers {
    size_t size;      /**< sizeof(swarf_picture_buffers) */
    uint8_t *rgba;    /**< 4 each; sRGB, opaque unless the background is not */
    float *depth;     /**< mm along the view from the eye (its plane), INFINITY where nothing is seen */
    float *normal;    /**< 3 each, unit, out of the surface; zero where nothing is seen */
    double *position; /**< 3 each, mm; NAN where nothing is seen */
    int32_t *move;    /**< index of the move that made the surface; -1: the stock as it was, or not known */
    uint8_t *seen;    /**< swarf_seen */
} swarf_picture_buffers;

/** A picture. The arrays other than `rgba` are of the ray through the middle of each pixel (of each square of coarse
 *  pixels). A cancelled picture leaves the arrays alone. All cores. */
SWARF_API swarf_status swarf_scene_render(swarf_scene *scene, const swarf_camera *camera,
                                          const swarf_picture_options *options, const swarf_progress *progress,
                                          const swarf_picture_buffers *out);
/** The same, `rgba` alone. */
SWARF_API swarf_status swarf_scene_picture(swarf_scene *scene, const swarf_camera *camera,
                                           const swarf_picture_options *options, const swarf_progress *progress,
                                           uint8_t *rgba);

/** What is seen at one place of a picture. */
typedef struct swarf_pick {
    int32_t seen; /**< swarf_seen; with NOTHING the rest is NAN and -1 */
    int32_t move;
    double point[3];
    double normal[3];
    double depth;
} swarf_pick;
/** The thing at place (x, y) of the picture that swarf_scene_render() would draw; lines are seen through. */
SWARF_API swarf_status swarf_scene_pick(swarf_scene *scene, const swarf_camera *camera,
                                        const swarf_picture_options *options, double x, double y, swarf_pick *out);
/** Write RGBA pixels as PNG (libpng); written beside and renamed. */
SWARF_API swarf_status swarf_picture_write(const char *path, const uint8_t *rgba, int32_t width, int32_t height);

#ifdef __cplusplus
}
#endif
#endif
