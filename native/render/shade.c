/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "render/shade.h"

#include <math.h>
#include <pthread.h>

/* A. Gooch, B. Gooch, P. Shirley, E. Cohen: A Non-Photorealistic Lighting Model for Automatic Technical Illustration,
 * SIGGRAPH 1998, section 4.2: blue and yellow shifts, and how much of the object's colour each side shows. */
static const float gooch_blue = 0.4f, gooch_yellow = 0.4f, gooch_alpha = 0.2f, gooch_beta = 0.6f;
/* Towards the light in the camera's right, up and backward: over the left shoulder. */
static const double light_camera[3] = {-0.5, 0.7, 0.6};

/* IEC 61966-2-1 in eight bits, by linear value. At black, where it is steepest, an entry is a quarter of a step. */
enum { SRGB_SIZE = 1 << 14 };
static uint8_t srgb[SRGB_SIZE + 1];
static pthread_once_t srgb_once = PTHREAD_ONCE_INIT;

static void fill_srgb(void)
{
    for (int i = 0; i <= SRGB_SIZE; i++) {
        const double x = (double)i / SRGB_SIZE;
        srgb[i] = (uint8_t)((x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055) * 255 + 0.5);
    }
}

void swarf_shading_make(const swarf_look *look, const swarf_picture_options *options, swarf_shading *out)
{
    const swarf_camera_frame *frame = &look->frame;
    double length = 0;
    pthread_once(&srgb_once, fill_srgb);
    for (int axis = 0; axis < 3; axis++) length += light_camera[axis] * light_camera[axis];
    out->options = options;
    for (int axis = 0; axis < 3; axis++)
        out->light[axis] = (float)((light_camera[0] * frame->right[axis] + light_camera[1] * frame->up[axis] -
                                    light_camera[2] * frame->forward[axis]) /
                                   sqrt(length));
}

static void backdrop(const swarf_picture_options *options, float height, float out[4])
{
    const float *bottom = options->background, *top = options->background_top;
    out[3] = bottom[3] + height * (top[3] - bottom[3]);
    for (int channel = 0; channel < 3; channel++)
        out[channel] = out[3] * (bottom[channel] + height * (top[channel] - bottom[channel]));
}

void swarf_shade(const swarf_shading *shading, const swarf_sight *sight, double height, float out[4])
{
    if (sight->seen == SWARF_SEEN_NOTHING) {
        backdrop(shading->options, (float)height, out);
        return;
    }
    const float *base = shading->options->colour;
    float cosine = 0;
    for (int axis = 0; axis < 3; axis++) cosine += shading->light[axis] * sight->normal[axis];
    const float warmth = 0.5f + 0.5f * cosine;
    for (int channel = 0; channel < 3; channel++) {
        const float cool = gooch_alpha * base[channel] + (channel == 2 ? gooch_blue : 0);
        const float warm = gooch_beta * base[channel] + (channel == 2 ? 0 : gooch_yellow);
        out[channel] = warmth * warm + (1 - warmth) * cool;
    }
    out[3] = 1;
}

static float clamp01(float x)
{
    return x > 0 ? (x < 1 ? x : 1) : 0;
}

void swarf_shade_resolve(const float sum[4], float weight, uint8_t out[4])
{
    const float alpha = sum[3] * weight;
    const float scale = alpha > 0 ? weight / alpha : 0;
    for (int channel = 0; channel < 3; channel++)
        out[channel] = srgb[(int)(clamp01(sum[channel] * scale) * SRGB_SIZE + 0.5f)];
    out[3] = (uint8_t)(clamp01(alpha) * 255 + 0.5f);
}
