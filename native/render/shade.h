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

/** One place of a picture that wants a colour. */
typedef struct swarf_spot {
    const swarf_sight *sight;
    double y;       /**< -1 .. 1 in the picture */
    float sky, sun; /**< how much of the sky is open there and whether the light reaches it, 0 .. 1 */
    float value;    /**< the deviation, NAN: none */
} swarf_spot;

/** Whether a move (-1: none) is one of those that stand out. */
static inline int swarf_shade_is_selected(const swarf_picture_options *options, int64_t move)
{
    return move >= 0 && (size_t)move >= options->selected_first &&
           (size_t)move - options->selected_first < options->selected_count;
}

/** Colours of `count` <= SWARF_PACKET spots, RGBA premultiplied. */
void swarf_shade(const swarf_shading *shading, const swarf_spot spots[], int count, float (*out)[4]);

/** Whether swarf_shade_rays() can shade what this look sees: surfaces of one material and nothing else. */
int swarf_shade_is_uniform(const swarf_shading *shading);
/** Colours of the `count` first rays of a packet through places of a look for which that is so, without light to come:
 *  the same as swarf_shade() makes of their sights. */
void swarf_shade_rays(const swarf_shading *shading, const swarf_rays *rays, const swarf_places *places,
                      float (*out)[4]);
/** The same of those rays that met something, as swarf_shade_encode() has it; the others keep what they have. */
void swarf_shade_hits(const swarf_shading *shading, const swarf_rays *rays, uint8_t out[SWARF_PACKET][4]);
/** What rays at this height (-1 .. 1) of the picture see that meet nothing, as bytes. */
void swarf_shade_backdrop(const swarf_shading *shading, double y, uint8_t out[4]);

/** Colours to eight bits per channel: IEC 61966-2-1 (sRGB), not premultiplied. */
void swarf_shade_encode(const float (*colour)[4], size_t count, uint8_t *out);

#endif
