/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Picture: camera rays in packets, antialiasing, and what the caller wants to know of each pixel.
 *
 *   middle    one sight per grid square (a pixel, or coarse * coarse of them), rows from the top; packets of 4 x 4
 *   rough     numbers of the squares where a square and its eight neighbours do not see one smooth face
 *
 * Each pass goes over rows or squares on all cores and writes only what is its own; samples are summed in a fixed
 * order: the picture is the same for any number of threads. Colours are summed premultiplied in linear light.
 */
#include "base/parallel.h"
#include "base/status.h"
#include "render/look.h"
#include "render/shade.h"
#include "render/vector.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* A tile of rays finds in the nearer caches what the rays beside it brought there. */
enum { TILE = 32, PACKET_EDGE = 4, PIXELS_MAX = 16384, SAMPLES_MAX = 4, COARSE_MAX = 16 };

_Static_assert(SAMPLES_MAX *SAMPLES_MAX <= SWARF_PACKET, "the samples of a square are one packet");

/* One face: neighbours' normals differ by at most 2.5 degrees, and each lies in the plane of the other to 1 in 20 of
 * their distance, so that steps of more than 1/20 pixel show. Larger values save rays and leave jagged edges. */
static const float same_face_cosine = 0.999f;
static const double same_face_slope = 0.05;

/* Squares that one piece of work takes: some 0.1 ms. */
enum { PIECE = 256 };

typedef struct picture {
    const swarf_picture_options *options;
    swarf_look look;
    swarf_shading shading;
    int32_t coarse;
    int32_t width, height; /* of the grid */
    swarf_sight *middle;
    size_t *rough_before; /* rough squares in the rows before this one; height + 1 entries */
    size_t *rough;
    size_t rough_count;
    float (*colour)[4]; /* of the squares */
} picture;

/** Place -1 .. 1 of the part 0 .. 1 of a grid square; squares at the right and lower rim may lie partly beyond the
 *  picture. */
static double place_x(const picture *p, int32_t x, double part)
{
    return 2 * (x + part) * p->coarse / p->options->width - 1;
}

static double place_y(const picture *p, int32_t y, double part)
{
    return 1 - 2 * (y + part) * p->coarse / p->options->height;
}

/** The square of PACKET_EDGE^2 grid squares from (x0, y0). */
static void look_packet(const picture *p, int32_t x0, int32_t y0)
{
    double place[2][SWARF_PACKET];
    size_t at[SWARF_PACKET];
    swarf_sight seen[SWARF_PACKET];
    unsigned count = 0;
    for (int32_t y = y0; y < y0 + PACKET_EDGE && y < p->height; y++)
        for (int32_t x = x0; x < x0 + PACKET_EDGE && x < p->width; x++, count++) {
            place[0][count] = place_x(p, x, 0.5);
            place[1][count] = place_y(p, y, 0.5);
            at[count] = (size_t)y * (size_t)p->width + (size_t)x;
        }
    for (unsigned idle = count; idle < SWARF_PACKET; idle++) place[0][idle] = place[1][idle] = 0;
    swarf_look_through(&p->look, place[0], place[1], count, seen);
    for (unsigned ray = 0; ray < count; ray++) p->middle[at[ray]] = seen[ray];
}

static int32_t tiles_across(const picture *p)
{
    return (p->width + TILE - 1) / TILE;
}

static swarf_status look_tile(void *context, size_t index)
{
    const picture *p = context;
    const int32_t x0 = (int32_t)index % tiles_across(p) * TILE, y0 = (int32_t)index / tiles_across(p) * TILE;
    for (int32_t y = y0; y < y0 + TILE && y < p->height; y += PACKET_EDGE)
        for (int32_t x = x0; x < x0 + TILE && x < p->width; x += PACKET_EDGE) look_packet(p, x, y);
    return SWARF_OK;
}

static void point_of(const picture *p, int32_t x, int32_t y, double out[3])
{
    const double place[2] = {place_x(p, x, 0.5), place_y(p, y, 0.5)};
    double direction[3];
    swarf_look_ray(&p->look, place, out, direction);
    const double distance = p->middle[(size_t)y * (size_t)p->width + (size_t)x].distance;
    for (int axis = 0; axis < 3; axis++) out[axis] += distance * direction[axis];
}

static int is_same_face(const picture *p, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    const swarf_sight *a = &p->middle[(size_t)y0 * (size_t)p->width + (size_t)x0];
    const swarf_sight *b = &p->middle[(size_t)y1 * (size_t)p->width + (size_t)x1];
    if (a->seen != b->seen) return 0;
    if (a->seen == SWARF_SEEN_NOTHING) return 1;
    float cosine = 0;
    for (int axis = 0; axis < 3; axis++) cosine += a->normal[axis] * b->normal[axis];
    if (!(cosine > same_face_cosine)) return 0;
    double from[3], to[3], off_a = 0, off_b = 0, square = 0;
    point_of(p, x0, y0, from);
    point_of(p, x1, y1, to);
    for (int axis = 0; axis < 3; axis++) {
        const double step = to[axis] - from[axis];
        off_a += step * a->normal[axis];
        off_b += step * b->normal[axis];
        square += step * step;
    }
    const double most = same_face_slope * same_face_slope * square;
    return off_a * off_a <= most && off_b * off_b <= most;
}

static int is_rough(const picture *p, int32_t x0, int32_t y0)
{
    for (int32_t y = y0 - 1; y <= y0 + 1; y++)
        for (int32_t x = x0 - 1; x <= x0 + 1; x++)
            if (x >= 0 && y >= 0 && x < p->width && y < p->height && !is_same_face(p, x0, y0, x, y)) return 1;
    return 0;
}

/** Shade the middles of a row, and count the rough squares in it. */
static swarf_status shade_row(void *context, size_t row)
{
    const picture *p = context;
    const double height = 0.5 + 0.5 * place_y(p, (int32_t)row, 0.5);
    size_t rough = 0;
    for (int32_t x = 0; x < p->width; x++) {
        const size_t at = row * (size_t)p->width + (size_t)x;
        swarf_shade(&p->shading, &p->middle[at], height, p->colour[at]);
        if (p->options->samples == 1 || !is_rough(p, x, (int32_t)row)) continue;
        p->colour[at][3] = -1; /* until its samples are there */
        rough++;
    }
    p->rough_before[row + 1] = rough;
    return SWARF_OK;
}

static swarf_status list_row(void *context, size_t row)
{
    const picture *p = context;
    size_t number = p->rough_before[row];
    for (size_t at = row * (size_t)p->width; at < (row + 1) * (size_t)p->width; at++)
        if (p->colour[at][3] < 0) p->rough[number++] = at;
    return SWARF_OK;
}

static swarf_status sample_some(void *context, size_t index)
{
    const picture *p = context;
    const int32_t n = p->options->samples;
    for (size_t number = index * PIECE; number < (index + 1) * PIECE && number < p->rough_count; number++) {
        const size_t at = p->rough[number];
        const int32_t x = (int32_t)(at % (size_t)p->width), y = (int32_t)(at / (size_t)p->width);
        double place[2][SWARF_PACKET] = {{0}};
        swarf_sight seen[SWARF_PACKET];
        float *sum = p->colour[at];
        for (int32_t sub = 0; sub < n * n; sub++) {
            place[0][sub] = place_x(p, x, (sub % n + 0.5) / n);
            place[1][sub] = place_y(p, y, (sub / n + 0.5) / n);
        }
        swarf_look_through(&p->look, place[0], place[1], (unsigned)(n * n), seen);
        memset(sum, 0, sizeof *p->colour);
        for (int32_t sub = 0; sub < n * n; sub++) {
            float one[4];
            swarf_shade(&p->shading, &seen[sub], 0.5 + 0.5 * place[1][sub], one);
            for (int channel = 0; channel < 4; channel++) sum[channel] += one[channel] / (float)(n * n);
        }
    }
    return SWARF_OK;
}

/** The parts of `progress` by what they cost. */
static const double looked = 0.5, shaded = 0.6;

static swarf_status draw(picture *p, const swarf_progress *progress)
{
    const size_t rows = (size_t)p->height;
    SWARF_TRY(
        swarf_parallel_for((size_t)tiles_across(p) * ((rows + TILE - 1) / TILE), look_tile, p, progress, 0, looked));
    SWARF_TRY(swarf_parallel_for(rows, shade_row, p, progress, looked, shaded));
    for (size_t row = 0; row < rows; row++) p->rough_before[row + 1] += p->rough_before[row];
    p->rough_count = p->rough_before[rows];
    if (p->rough_count) {
        p->rough = malloc(p->rough_count * sizeof *p->rough);
        if (!p->rough) return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
        SWARF_TRY(swarf_parallel_for(rows, list_row, p, NULL, 0, 1));
        SWARF_TRY(swarf_parallel_for((p->rough_count + PIECE - 1) / PIECE, sample_some, p, progress, shaded, 1));
    }
    return SWARF_OK;
}

typedef struct output {
    const picture *picture;
    const swarf_picture_buffers *to;
} output;

/** Colour of a pixel between the middles of coarse squares. */
static void blend(const picture *p, int32_t x, int32_t y, float out[4])
{
    const double u = fmax((x + 0.5) / p->coarse - 0.5, 0), v = fmax((y + 0.5) / p->coarse - 0.5, 0);
    const int32_t x0 = (int32_t)u, y0 = (int32_t)v;
    const int32_t x1 = x0 + 1 < p->width ? x0 + 1 : x0, y1 = y0 + 1 < p->height ? y0 + 1 : y0;
    const float fx = (float)(u - x0), fy = (float)(v - y0);
    const float *c00 = p->colour[(size_t)y0 * (size_t)p->width + (size_t)x0];
    const float *c10 = p->colour[(size_t)y0 * (size_t)p->width + (size_t)x1];
    const float *c01 = p->colour[(size_t)y1 * (size_t)p->width + (size_t)x0];
    const float *c11 = p->colour[(size_t)y1 * (size_t)p->width + (size_t)x1];
    for (int channel = 0; channel < 4; channel++)
        out[channel] = (1 - fy) * ((1 - fx) * c00[channel] + fx * c10[channel]) +
                       fy * ((1 - fx) * c01[channel] + fx * c11[channel]);
}

static swarf_status put_row(void *context, size_t row)
{
    const output *o = context;
    const picture *p = o->picture;
    const int32_t width = p->options->width, grid_y = (int32_t)row / p->coarse;
    for (int32_t x = 0; x < width; x++) {
        const size_t at = row * (size_t)width + (size_t)x;
        const int32_t grid_x = x / p->coarse;
        const size_t square = (size_t)grid_y * (size_t)p->width + (size_t)grid_x;
        const swarf_sight *sight = &p->middle[square];
        if (o->to->rgba) {
            float colour[4];
            memcpy(colour, p->colour[square], sizeof colour);
            if (p->coarse > 1) blend(p, x, (int32_t)row, colour);
            swarf_shade_resolve(colour, 1, o->to->rgba + 4 * at);
        }
        if (o->to->seen) o->to->seen[at] = (uint8_t)sight->seen;
        if (o->to->move) o->to->move[at] = sight->move;
        if (o->to->normal) memcpy(o->to->normal + 3 * at, sight->normal, sizeof sight->normal);
        if (!o->to->depth && !o->to->position) continue;
        double point[3] = {NAN, NAN, NAN}, arm[3];
        if (sight->seen != SWARF_SEEN_NOTHING) point_of(p, grid_x, grid_y, point);
        for (int axis = 0; axis < 3; axis++) arm[axis] = point[axis] - p->look.frame.eye[axis];
        if (o->to->position) memcpy(o->to->position + 3 * at, point, sizeof point);
        if (o->to->depth)
            o->to->depth[at] =
                sight->seen == SWARF_SEEN_NOTHING ? INFINITY : (float)vector_dot(arm, p->look.frame.forward);
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
        .coarse = 1,
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
    SWARF_REQUIRE(o->coarse >= 1 && o->coarse <= COARSE_MAX, "picture: %d pixels per ray is not in 1 .. %d",
                  (int)o->coarse, (int)COARSE_MAX);
    SWARF_REQUIRE(isfinite(o->budget_ms) && o->budget_ms >= 0, "picture: a budget of %g ms", o->budget_ms);
    for (int channel = 0; channel < 4; channel++) {
        const float colour = channel < 3 ? o->colour[channel] : 0;
        const float low = o->background[channel], high = o->background_top[channel];
        SWARF_REQUIRE(colour >= 0 && colour <= 1 && low >= 0 && low <= 1 && high >= 0 && high <= 1,
                      "picture: a colour is not in 0 .. 1");
    }
    return SWARF_OK;
}

static double now_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

/** Pixels per ray, along each axis, with which the picture should take the time it may. */
static int32_t choose_coarse(const swarf_scene *scene, const swarf_picture_options *options)
{
    int32_t coarse = options->coarse;
    if (options->budget_ms > 0) {
        const double rays = options->budget_ms / swarf_scene_ray_ms(scene);
        while (coarse < COARSE_MAX && (double)options->width * options->height > rays * coarse * coarse) coarse++;
    }
    return coarse;
}

/** With the scene entered. */
static swarf_status render(swarf_scene *scene, const swarf_camera *camera, picture *p, const swarf_progress *progress,
                           const swarf_picture_buffers *out)
{
    const swarf_picture_options *options = p->options;
    const double started = now_ms();
    SWARF_TRY(swarf_look_make(scene, camera, (double)options->width / options->height, &p->look));
    swarf_shading_make(&p->look, options, &p->shading);
    p->coarse = choose_coarse(scene, options);
    p->width = (options->width + p->coarse - 1) / p->coarse;
    p->height = (options->height + p->coarse - 1) / p->coarse;
    const size_t squares = (size_t)p->width * (size_t)p->height;
    p->middle = malloc(squares * sizeof *p->middle);
    p->colour = malloc(squares * sizeof *p->colour);
    p->rough_before = calloc((size_t)p->height + 1, sizeof *p->rough_before);
    if (!p->middle || !p->colour || !p->rough_before)
        return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory for %d x %d pixels", (int)options->width,
                          (int)options->height);
    SWARF_TRY(draw(p, progress));
    output o = {p, out};
    SWARF_TRY(swarf_parallel_for((size_t)options->height, put_row, &o, NULL, 0, 1));
    swarf_scene_note_ray_ms(scene, (now_ms() - started) / (double)squares);
    return SWARF_OK;
}

swarf_status swarf_scene_render(swarf_scene *scene, const swarf_camera *camera, const swarf_picture_options *options,
                                const swarf_progress *progress, const swarf_picture_buffers *out)
{
    SWARF_REQUIRE(scene && camera && options && out, "picture: scene, camera, options or output missing");
    SWARF_REQUIRE(out->size == sizeof *out, "picture: buffers of another version");
    SWARF_TRY(check_options(options));
    picture p = {.options = options};
    SWARF_TRY(swarf_scene_enter(scene));
    const swarf_status status = render(scene, camera, &p, progress, out);
    swarf_scene_leave(scene);
    free(p.middle);
    free(p.colour);
    free(p.rough_before);
    free(p.rough);
    return status;
}

swarf_status swarf_scene_picture(swarf_scene *scene, const swarf_camera *camera, const swarf_picture_options *options,
                                 const swarf_progress *progress, uint8_t *rgba)
{
    SWARF_REQUIRE(rgba, "picture: pixels missing");
    const swarf_picture_buffers out = {.size = sizeof out, .rgba = rgba};
    return swarf_scene_render(scene, camera, options, progress, &out);
}

swarf_status swarf_scene_pick(swarf_scene *scene, const swarf_camera *camera, double aspect, double x, double y,
                              swarf_pick *out)
{
    SWARF_REQUIRE(scene && camera && out, "pick: scene, camera or output missing");
    SWARF_REQUIRE(isfinite(x) && isfinite(y), "pick: the place in the picture is not finite");
    SWARF_TRY(swarf_scene_enter(scene));
    swarf_look look;
    swarf_sight sight;
    const double place[2] = {x, y}, xs[SWARF_PACKET] = {x}, ys[SWARF_PACKET] = {y};
    swarf_status status = swarf_look_make(scene, camera, aspect, &look);
    if (status == SWARF_OK) swarf_look_through(&look, xs, ys, 1, &sight);
    swarf_scene_leave(scene);
    SWARF_TRY(status);
    swarf_pick pick = {.seen = sight.seen, .move = -1, .depth = NAN};
    for (int axis = 0; axis < 3; axis++) pick.point[axis] = pick.normal[axis] = NAN;
    if (sight.seen != SWARF_SEEN_NOTHING) {
        double direction[3], arm[3];
        swarf_look_ray(&look, place, pick.point, direction);
        for (int axis = 0; axis < 3; axis++) {
            pick.point[axis] += sight.distance * direction[axis];
            pick.normal[axis] = sight.normal[axis];
            arm[axis] = pick.point[axis] - look.frame.eye[axis];
        }
        pick.move = sight.move;
        pick.depth = vector_dot(arm, look.frame.forward);
    }
    *out = pick;
    return SWARF_OK;
}
