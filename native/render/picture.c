/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Picture: camera rays in packets, Gooch shading, antialiasing.
 *
 * Tiles of 32 x 32 pixels go to all cores. A tile and the pixels around it are traced with one ray per pixel, in
 * packets of 4 x 4 neighbours. Where a pixel and its eight neighbours see one smooth face, or all nothing, this is the
 * colour; the others (edges, steps, silhouettes) get n x n rays, a packet per pixel. Each pixel belongs to one tile and
 * sums its samples in a fixed order, so the picture is the same for any number of threads. Colours are summed
 * premultiplied in linear light and end as sRGB.
 */
#include "base/parallel.h"
#include "base/status.h"
#include "render/camera.h"
#include "render/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TILE = 32, MARGIN_TILE = TILE + 2, PACKET_EDGE = 4, PIXELS_MAX = 16384, SAMPLES_MAX = 4 };

_Static_assert(SAMPLES_MAX *SAMPLES_MAX <= SWARF_PACKET, "the samples of a pixel are one packet");

/* One face: neighbours' normals differ by at most 2.5 degrees, and each lies in the plane of the other to 1 in 20 of
 * their distance, so that steps of more than 1/20 pixel show. Larger values save rays and leave jagged edges. */
static const float same_face_cosine = 0.999f;
static const double same_face_slope = 0.05;

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

/* What one ray saw. */
typedef struct sight {
    float colour[4];
    int hit;
    float normal[3];
    double point[3];
} sight;

/* Rays through samples `at` (x, y) of a picture with n samples per pixel edge. */
static swarf_status look(const picture *p, int32_t n, const int32_t at[][2], unsigned count, sight out[])
{
    double origin[3 * SWARF_PACKET] = {0}, direction[3 * SWARF_PACKET] = {0}, distance[SWARF_PACKET];
    float normal[3 * SWARF_PACKET], rise[SWARF_PACKET];
    for (unsigned ray = 0; ray < count; ray++) {
        const double u = (at[ray][0] + 0.5) / (p->options->width * n);
        const double v = 1 - (at[ray][1] + 0.5) / (p->options->height * n);
        swarf_camera_ray(&p->frame, 2 * u - 1, 2 * v - 1, origin + 3 * ray, direction + 3 * ray);
        rise[ray] = (float)v;
    }
    SWARF_TRY(swarf_scene_trace(p->scene, origin, direction, count, distance, normal));
    for (unsigned ray = 0; ray < count; ray++) {
        sight *seen = &out[ray];
        seen->hit = !isinf(distance[ray]);
        if (!seen->hit) {
            backdrop(p, rise[ray], seen->colour);
            continue;
        }
        shade(p, normal + 3 * ray, seen->colour);
        for (int axis = 0; axis < 3; axis++) {
            seen->normal[axis] = normal[3 * ray + (unsigned)axis];
            seen->point[axis] = origin[3 * ray + (unsigned)axis] + distance[ray] * direction[3 * ray + (unsigned)axis];
        }
    }
    return SWARF_OK;
}

static int is_same_face(const sight *a, const sight *b)
{
    if (a->hit != b->hit) return 0;
    if (!a->hit) return 1;
    double cosine = 0, off_a = 0, off_b = 0, square = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double step = b->point[axis] - a->point[axis];
        cosine += (double)a->normal[axis] * b->normal[axis];
        off_a += step * a->normal[axis];
        off_b += step * b->normal[axis];
        square += step * step;
    }
    const double most = same_face_slope * same_face_slope * square;
    return cosine > same_face_cosine && off_a * off_a <= most && off_b * off_b <= most;
}

static int is_smooth(const sight *middle)
{
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            if (!is_same_face(middle, middle + y * MARGIN_TILE + x)) return 0;
    return 1;
}

/* One ray per pixel of a tile and of the ring around it, which may lie outside the picture. */
static swarf_status look_once(const picture *p, int32_t x0, int32_t y0, sight seen[MARGIN_TILE * MARGIN_TILE])
{
    for (int32_t by = 0; by < MARGIN_TILE; by += PACKET_EDGE) {
        for (int32_t bx = 0; bx < MARGIN_TILE; bx += PACKET_EDGE) {
            int32_t at[SWARF_PACKET][2], place[SWARF_PACKET];
            sight packet[SWARF_PACKET];
            unsigned count = 0;
            for (int32_t y = by; y < by + PACKET_EDGE && y < MARGIN_TILE; y++)
                for (int32_t x = bx; x < bx + PACKET_EDGE && x < MARGIN_TILE; x++, count++) {
                    at[count][0] = x0 + x - 1;
                    at[count][1] = y0 + y - 1;
                    place[count] = y * MARGIN_TILE + x;
                }
            SWARF_TRY(look(p, 1, (const int32_t(*)[2])at, count, packet));
            for (unsigned ray = 0; ray < count; ray++) seen[place[ray]] = packet[ray];
        }
    }
    return SWARF_OK;
}

static swarf_status sum_samples(const picture *p, int32_t x, int32_t y, float sum[4])
{
    const int32_t n = p->options->samples;
    int32_t at[SWARF_PACKET][2];
    sight packet[SWARF_PACKET];
    unsigned count = 0;
    for (int32_t sub = 0; sub < n * n; sub++, count++) {
        at[count][0] = x * n + sub % n;
        at[count][1] = y * n + sub / n;
    }
    SWARF_TRY(look(p, n, (const int32_t(*)[2])at, count, packet));
    for (int channel = 0; channel < 4; channel++) sum[channel] = 0;
    for (unsigned ray = 0; ray < count; ray++)
        for (int channel = 0; channel < 4; channel++) sum[channel] += packet[ray].colour[channel];
    return SWARF_OK;
}

static swarf_status draw_tile(void *context, size_t index)
{
    const picture *p = context;
    const int32_t n = p->options->samples, width = p->options->width, height = p->options->height;
    const int32_t x0 = (int32_t)(index % (size_t)p->tiles_across) * TILE;
    const int32_t y0 = (int32_t)(index / (size_t)p->tiles_across) * TILE;
    sight seen[MARGIN_TILE * MARGIN_TILE];
    SWARF_TRY(look_once(p, x0, y0, seen));
    for (int32_t y = y0; y < y0 + TILE && y < height; y++) {
        for (int32_t x = x0; x < x0 + TILE && x < width; x++) {
            const sight *middle = &seen[(y - y0 + 1) * MARGIN_TILE + (x - x0 + 1)];
            uint8_t *pixel = p->rgba + 4 * ((size_t)y * (size_t)width + (size_t)x);
            float sum[4];
            if (n == 1 || is_smooth(middle)) {
                resolve(middle->colour, 1, pixel);
                continue;
            }
            SWARF_TRY(sum_samples(p, x, y, sum));
            resolve(sum, 1 / (float)(n * n), pixel);
        }
    }
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
