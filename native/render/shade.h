/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Shading: from what a ray met to a colour, in linear light. */
#ifndef SWARF_RENDER_SHADE_H
#define SWARF_RENDER_SHADE_H

#include "render/look.h"

/** How one picture is shaded. */
typedef struct swarf_shading {
    const swarf_look *look;
    const swarf_picture_options *options;
    float light[3];         /**< unit, towards it */
    float feed_lo, feed_hi; /**< mm/min, of the program */
} swarf_shading;

/** SWARF_ERROR_ARGUMENT when the colouring lacks what it is about. */
swarf_status swarf_shading_make(const swarf_look *look, const swarf_picture_options *options, swarf_shading *out);

/** Colour of what was seen in a pixel at place (x, y) of the picture, RGBA premultiplied. `sky` is how much of the sky
 *  is open there and `sun` whether the light reaches it, 0 .. 1; `value` the deviation, NAN: none. */
void swarf_shade(const swarf_shading *shading, const swarf_sight *sight, double y, float sky, float sun, float value,
                 float out[4]);

/** A sum of `1 / weight` colours to eight bits per channel: IEC 61966-2-1 (sRGB), not premultiplied. */
void swarf_shade_resolve(const float sum[4], float weight, uint8_t out[4]);

#endif
