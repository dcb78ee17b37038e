/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Picture: camera rays in packets, Gooch shading, antialiasing.
 *
 * Tiles of 32 x 32 pixels go to all cores. A tile is traced on its grid of samples (n per pixel edge) in packets of
 * 4 x 4 neighbours; each pixel belongs to one tile and sums its samples in a fixed order, so the picture is the same
 * for any number of threads. Colours are summed premultiplied in linear light and end as sRGB.
 */
#include "base/parallel.h"
#include "base/status.h"
#include "render/camera.h"
#include "render/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TILE = 32, PACKET_EDGE = 4, PIXELS_MAX = 16384, SAMPLES_MAX = 4 };

/* A. Gooch, B. Gooch, P. Shirley, E. Cohen: A Non-Photorealistic Lighting Model for Automatic Technical Illustration,
 * SIGGRAPH 1998, section 4.2: blue and yellow shifts, and how much of the object's colour each side shows. */
static const float gooch_blue = 0.4f, gooch_yellow = 0.4f, gooch_alpha = 0.2f, gooch_beta = 0.6f;
/* Towards the light in the camera's right, up and backward: over the left shoulder. */
static const double light_camera[3] = {-0.5, 0.7, 0.6};

typedef struct picture {
    const swarf_scene *scene;
    const swarf_picture_options *options;
    swarf_camera_frame frame;
    float light[3];
    float cool[3], warm[3];
    int32_t tiles_across;
    uint8_t *rgba;
} picture;

static void shade(const picture *p, const float normal[3], float out[4])
{
    const float cosine = p->light[0] * normal[0] + p->light[1] * normal[1] + p->light[2] * normal[2];
    const float warmth = 0.5f + 0.5f * cosine;
    for (int channel = 0; channel < 3; channel++)
        out[channel] = warmth * p->warm[channel] + (1 - warmth) * p->cool[channel];
    out[3] = 1;
}

/** Background at height 0 (bottom) .. 1, premultiplied. */
static void backdrop(const picture *p, float height, float out[4])
{
    const float *bottom = p->options->background, *top = p->options->background_top;
    out[3] = bottom[3] + height * (top[3] - bottom[3]);
    for (int channel = 0; channel < 3; channel++)
        out[channel] = out[3] * (bottom[channel] + height * (top[channel] - bottom[channel]));
}

/** IEC 61966-2-1 transfer function to 8 bits. */
static uint8_t to_srgb(float linear)
{
    const float x = fminf(fmaxf(linear, 0), 1);
    const float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f;
    return (uint8_t)(encoded * 255 + 0.5f);
}

static void resolve(const float sum[4], float weight, uint8_t out[4])
{
    const float alpha = sum[3] * weight;
    for (int channel = 0; channel < 3; channel++) out[channel] = alpha > 0 ? to_srgb(sum[channel] * weight / alpha) : 0;
    out[3] = (uint8_t)(fminf(fmaxf(alpha, 0), 1) * 255 + 0.5f);
}

static swarf_status draw_tile(void *context, size_t index)
{
    const picture *p = context;
    const int32_t n = p->options->samples, width = p->options->width, height = p->options->height;
    const int32_t x0 = (int32_t)(index % (size_t)p->tiles_across) * TILE;
    const int32_t y0 = (int32_t)(index / (size_t)p->tiles_across) * TILE;
    const int32_t x1 = x0 + TILE < width ? x0 + TILE : width, y1 = y0 + TILE < height ? y0 + TILE : height;
    float sum[TILE * TILE][4];
    memset(sum, 0, sizeof sum);
    for (int32_t by = y0 * n; by < y1 * n; by += PACKET_EDGE) {
        for (int32_t bx = x0 * n; bx < x1 * n; bx += PACKET_EDGE) {
            double origin[3 * SWARF_PACKET], direction[3 * SWARF_PACKET], distance[SWARF_PACKET];
            float normal[3 * SWARF_PACKET], rise[SWARF_PACKET];
            float *pixel[SWARF_PACKET];
            unsigned count = 0;
            for (int32_t y = by; y < by + PACKET_EDGE && y < y1 * n; y++) {
                for (int32_t x = bx; x < bx + PACKET_EDGE && x < x1 * n; x++, count++) {
                    const double u = (x + 0.5) / (width * n), v = 1 - (y + 0.5) / (height * n);
                    swarf_camera_ray(&p->frame, 2 * u - 1, 2 * v - 1, origin + 3 * count, direction + 3 * count);
                    rise[count] = (float)v;
                    pixel[count] = sum[(y / n - y0) * TILE + (x / n - x0)];
                }
            }
            SWARF_TRY(swarf_scene_trace(p->scene, origin, direction, count, distance, normal));
            for (unsigned ray = 0; ray < count; ray++) {
                float colour[4];
                if (isinf(distance[ray]))
                    backdrop(p, rise[ray], colour);
                else
                    shade(p, normal + 3 * ray, colour);
                for (int channel = 0; channel < 4; channel++) pixel[ray][channel] += colour[channel];
            }
        }
    }
    for (int32_t y = y0; y < y1; y++)
        for (int32_t x = x0; x < x1; x++)
            resolve(sum[(y - y0) * TILE + (x - x0)], 1 / (float)(n * n),
                    p->rgba + 4 * ((size_t)y * (size_t)width + (size_t)x));
    return SWARF_OK;
}

swarf_picture_options swarf_picture_options_default(void)
{
    return (swarf_picture_options){
        .size = sizeof(swarf_picture_options),
        .width = 1280,
        .height = 960,
        .samples = 3,
        .colour = {0.62f, 0.62f, 0.64f},
        .background = {0.80f, 0.82f, 0.85f, 1},
        .background_top = {0.30f, 0.36f, 0.44f, 1},
    };
}

static swarf_status check_options(const swarf_picture_options *o)
{
    SWARF_REQUIRE(o->size == sizeof *o, "picture: options of another version; use swarf_picture_options_default()");
    SWARF_REQUIRE(o->width >= 1 && o->width <= PIXELS_MAX && o->height >= 1 && o->height <= PIXELS_MAX,
                  "picture: %d x %d pixels is not in 1 .. %d", (int)o->width, (int)o->height, (int)PIXELS_MAX);
    SWARF_REQUIRE(o->samples >= 1 && o->samples <= SAMPLES_MAX, "picture: %d samples per edge is not in 1 .. %d",
                  (int)o->samples, (int)SAMPLES_MAX);
    for (int channel = 0; channel < 4; channel++) {
        const float colour = channel < 3 ? o->colour[channel] : 0;
        const float low = o->background[channel], high = o->background_top[channel];
        SWARF_REQUIRE(colour >= 0 && colour <= 1 && low >= 0 && low <= 1 && high >= 0 && high <= 1,
                      "picture: a colour is not in 0 .. 1");
    }
    return SWARF_OK;
}

swarf_status swarf_scene_picture(swarf_scene *scene, const swarf_camera *camera, const swarf_picture_options *options,
                                 const swarf_progress *progress, uint8_t *rgba)
{
    SWARF_REQUIRE(scene && camera && options && rgba, "picture: scene, camera, options or pixels missing");
    SWARF_TRY(check_options(options));
    picture p = {.scene = scene, .options = options};
    SWARF_TRY(swarf_camera_frame_make(camera, (double)options->width / options->height, &p.frame));
    double length = 0;
    for (int axis = 0; axis < 3; axis++) length += light_camera[axis] * light_camera[axis];
    for (int axis = 0; axis < 3; axis++) {
        p.light[axis] = (float)((light_camera[0] * p.frame.right[axis] + light_camera[1] * p.frame.up[axis] -
                                 light_camera[2] * p.frame.forward[axis]) /
                                sqrt(length));
        p.cool[axis] = gooch_alpha * options->colour[axis] + (axis == 2 ? gooch_blue : 0);
        p.warm[axis] = gooch_beta * options->colour[axis] + (axis == 2 ? 0 : gooch_yellow);
    }
    p.tiles_across = (options->width + TILE - 1) / TILE;
    const size_t tiles = (size_t)p.tiles_across * (size_t)((options->height + TILE - 1) / TILE);
    const size_t bytes = 4 * (size_t)options->width * (size_t)options->height;
    p.rgba = malloc(bytes); /* apart, so that a cancelled picture leaves the caller's pixels alone */
    if (!p.rgba) return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory for %zu bytes of pixels", bytes);
    swarf_status status = swarf_scene_enter(scene);
    if (status == SWARF_OK) {
        status = swarf_parallel_for(tiles, draw_tile, &p, progress, 0, 1);
        swarf_scene_leave(scene);
    }
    if (status == SWARF_OK) memcpy(rgba, p.rgba, bytes);
    free(p.rgba);
    return status;
}
