/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A picture in the making, for the files that each add something to it.
 *
 *   middle   one sight per grid square (a pixel, or coarse * coarse of them), rows from the top; NULL in a plain
 *            picture, which has no use for them once they are shaded
 *   colour   of the squares, linear, premultiplied
 *   bytes    RGBA of the pixels of a plain picture with one ray for each, in place of colours; else NULL
 *   sky      how much of the sky is open, per square; NULL: all of it; the recall's, as are the next three
 *   sun      255 where the light reaches, per square; NULL: everywhere
 *   detail   more sights of squares where one does not tell enough
 *   mark     the lines of edges, per square; NULL: they are not drawn
 */
#ifndef SWARF_RENDER_PICTURE_H
#define SWARF_RENDER_PICTURE_H

#include "render/look.h"
#include "render/shade.h"

/* A tile of rays finds in the nearer caches what the rays beside it brought there. */
enum { SWARF_TILE = 32 };

typedef struct swarf_canvas {
    const swarf_picture_options *options;
    swarf_look look;
    swarf_shading shading;
    int32_t coarse;
    int32_t width, height; /* of the grid */
    swarf_sight *middle;
    float (*colour)[4];
    uint8_t *bytes;
    float *sky;
    uint8_t *sun;
    swarf_detail *detail;
    swarf_line_mark *mark;
} swarf_canvas;

/** Place -1 .. 1 of the part 0 .. 1 of a grid square; squares at the right and lower rim may lie partly beyond the
 *  picture. */
static inline double swarf_canvas_x(const swarf_canvas *c, int32_t x, double part)
{
    return 2 * (x + part) * c->coarse / c->options->width - 1;
}

static inline double swarf_canvas_y(const swarf_canvas *c, int32_t y, double part)
{
    return 1 - 2 * (y + part) * c->coarse / c->options->height;
}

static inline size_t swarf_canvas_at(const swarf_canvas *c, int32_t x, int32_t y)
{
    return (size_t)y * (size_t)c->width + (size_t)x;
}

/** Make `sky` and `sun` where the options ask for them and they are not there. */
swarf_status swarf_canvas_light(swarf_canvas *canvas, const swarf_progress *progress, double from, double to);

/** Shade the middles into `colour`, and sample what is rough: edges, lines along them, silhouettes. */
swarf_status swarf_canvas_shade(swarf_canvas *canvas, const swarf_progress *progress, double from, double to);

/** Draw the path, the outline and the axes over `colour`. */
swarf_status swarf_canvas_lines(swarf_canvas *canvas);

#endif
