/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Shading: from what a ray met to a colour, in linear light. */
#ifndef SWARF_RENDER_SHADE_H
#define SWARF_RENDER_SHADE_H

#include "render/look.h"

/** How one picture is shaded. */
typedef struct swarf_shading {
    const swarf_picture_options *options;
    float light[3]; /**< unit, towards it */
} swarf_shading;

void swarf_shading_make(const swarf_look *look, const swarf_picture_options *options, swarf_shading *out);

/** Colour of what was seen at a height 0 (bottom) .. 1 of the picture, RGBA premultiplied. */
void swarf_shade(const swarf_shading *shading, const swarf_sight *sight, double height, float out[4]);

/** A sum of `1 / weight` colours to eight bits per channel: IEC 61966-2-1 (sRGB), not premultiplied. */
void swarf_shade_resolve(const float sum[4], float weight, uint8_t out[4]);

#endif
