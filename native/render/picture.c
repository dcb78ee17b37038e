/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Picture: camera rays in packets, then light, shading, lines, and what the caller wants to know of each pixel.
 *
 * Each pass goes over rows or tiles on all cores and writes only what is its own; samples are summed in a fixed order:
 * the picture is the same for any number of threads.
 */
#include "render/picture.h"

#include "base/parallel.h"
#include "base/status.h"
#include "base/vector.h"
#include "render/refine.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { PACKET_EDGE = 4, GROUP_EDGE = 2, PIXELS_MAX = 16384, SAMPLES_MAX = 4, COARSE_MAX = 16 };

/** A square of packets, each of whole rows of squares: its left upper square and how many a row has. */
typedef struct group {
    swarf_places places[SWARF_GROUP];
    int32_t left[SWARF_GROUP], top[SWARF_GROUP];
    unsigned across[SWARF_GROUP];
} group;

_Static_assert(GROUP_EDGE *GROUP_EDGE == SWARF_GROUP, "a group is a square of packets");
_Static_assert(PACKET_EDGE *PACKET_EDGE == SWARF_PACKET, "a packet is a square of rays");
_Static_assert(SAMPLES_MAX *SAMPLES_MAX <= SWARF_PACKET, "the samples of a square fit in one packet");

/** Grid squares of one piece of work, the places of their middles, and what is behind all in each row. */
typedef struct tile {
    int32_t left, top, right, bottom;
    double x[SWARF_TILE], y[SWARF_TILE];
    uint8_t behind[SWARF_TILE][4];
} tile;

/** The packets of the square from (x0, y0) on. */
static void place_group(const tile *t, int32_t x0, int32_t y0, group *g)
{
    for (int i = 0; i < SWARF_GROUP; i++) {
        swarf_places *p = &g->places[i];
        const int32_t left = x0 + i % GROUP_EDGE * PACKET_EDGE, top = y0 + i / GROUP_EDGE * PACKET_EDGE;
        const int32_t right = left + PACKET_EDGE < t->right ? left + PACKET_EDGE : t->right;
        const int32_t bottom = top + PACKET_EDGE < t->bottom ? top + PACKET_EDGE : t->bottom;
        g->left[i] = left;
        g->top[i] = top;
        g->across[i] = right > left ? (unsigned)(right - left) : 0;
        p->count = 0;
        for (int32_t y = top; y < bottom; y++)
            for (int32_t x = left; x < right; x++, p->count++) {
                p->x[p->count] = t->x[x - t->left];
                p->y[p->count] = t->y[y - t->top];
            }
        for (unsigned idle = p->count; idle < SWARF_PACKET; idle++) p->x[idle] = p->y[idle] = 0;
    }
}

/** Copy what each ray of packet `i` has, `size` bytes, to its square of the grid. */
static void put_group(const swarf_canvas *c, const group *g, int i, const void *from, void *grid, size_t size)
{
    const size_t row = g->across[i] * size;
    const char *own = from;
    char *to = (char *)grid + swarf_canvas_at(c, g->left[i], g->top[i]) * size;
    for (unsigned done = 0; done < g->places[i].count; done += g->across[i]) {
        memcpy(to, own, row);
        own += row;
        to += (size_t)c->width * size;
    }
}

/** Keep what is seen for the passes to come. */
static void keep_group(const swarf_canvas *c, const group *g)
{
    swarf_sight seen[SWARF_GROUP][SWARF_PACKET], *out[SWARF_GROUP];
    for (int i = 0; i < SWARF_GROUP; i++) out[i] = seen[i];
    swarf_look_through(&c->look, g->places, SWARF_GROUP, out);
    for (int i = 0; i < SWARF_GROUP; i++) put_group(c, g, i, seen[i], c->middle, sizeof seen[i][0]);
}

/** Shade what is seen at once. */
static void paint_group(const swarf_canvas *c, const group *g)
{
    swarf_rays rays[SWARF_GROUP];
    swarf_look_trace(&c->look, g->places, SWARF_GROUP, rays);
    for (int i = 0; i < SWARF_GROUP; i++) {
        float colour[SWARF_PACKET][4];
        swarf_shade_rays(&c->shading, &rays[i], &g->places[i], colour);
        put_group(c, g, i, colour, c->colour, sizeof colour[0]);
    }
}

/** The same where nothing else is to come. */
static void print_group(const swarf_canvas *c, const tile *t, const group *g)
{
    swarf_rays rays[SWARF_GROUP];
    swarf_look_trace(&c->look, g->places, SWARF_GROUP, rays);
    for (int i = 0; i < SWARF_GROUP; i++) {
        uint8_t bytes[SWARF_PACKET][4];
        for (unsigned ray = 0; ray < g->places[i].count; ray++)
            memcpy(bytes[ray], t->behind[(unsigned)(g->top[i] - t->top) + ray / g->across[i]], sizeof bytes[0]);
        swarf_shade_hits(&c->shading, &rays[i], bytes);
        put_group(c, g, i, bytes, c->bytes, sizeof bytes[0]);
    }
}

static int32_t tiles(int32_t length)
{
    return (length + SWARF_TILE - 1) / SWARF_TILE;
}

static swarf_status look_tile(void *context, size_t index)
{
    const swarf_canvas *c = context;
    const int32_t across = tiles(c->width);
    enum { STEP = GROUP_EDGE * PACKET_EDGE };
    tile t = {.left = (int32_t)index % across * SWARF_TILE, .top = (int32_t)index / across * SWARF_TILE};
    t.right = t.left + SWARF_TILE < c->width ? t.left + SWARF_TILE : c->width;
    t.bottom = t.top + SWARF_TILE < c->height ? t.top + SWARF_TILE : c->height;
    for (int32_t x = t.left; x < t.right; x++) t.x[x - t.left] = swarf_canvas_x(c, x, 0.5);
    for (int32_t y = t.top; y < t.bottom; y++) {
        const double place = t.y[y - t.top] = swarf_canvas_y(c, y, 0.5);
        if (c->bytes) swarf_shade_backdrop(&c->shading, place, t.behind[y - t.top]);
    }
    group g;
    for (int32_t y = t.top; y < t.bottom; y += STEP)
        for (int32_t x = t.left; x < t.right; x += STEP) {
            place_group(&t, x, y, &g);
            if (c->bytes)
                print_group(c, &t, &g);
            else
                (c->middle ? keep_group : paint_group)(c, &g);
        }
    return SWARF_OK;
}

/** Where the middle of square `index` lies. */
static int place_of_middle(const void *context, size_t index, double place[2])
{
    const swarf_canvas *c = context;
    if (!place) return 1;
    place[0] = swarf_canvas_x(c, (int32_t)(index % (size_t)c->width), 0.5);
    place[1] = swarf_canvas_y(c, (int32_t)(index / (size_t)c->width), 0.5);
    return 1;
}

/** Where the only ray of a pick goes. */
static int place_of_pick(const void *context, size_t index, double place[2])
{
    (void)index;
    if (place) memcpy(place, context, 2 * sizeof *place);
    return 1;
}

/** The parts of the progress by what they cost. */
static const double looked = 0.2, refined = 0.35, lighting = 0.4;

/** Find what there is to see of each square. */
static swarf_status find_middles(swarf_canvas *c, const swarf_progress *progress)
{
    const size_t count = (size_t)tiles(c->width) * (size_t)tiles(c->height);
    SWARF_TRY(swarf_parallel_for(count, look_tile, c, progress, 0, c->middle ? looked : 1));
    if (!c->middle || !c->options->exact) return SWARF_OK;
    const swarf_sights sights = {c->middle, (size_t)c->width * (size_t)c->height, 0, place_of_middle, c};
    return swarf_look_refine(&c->look, &sights, progress, looked, refined);
}

/** Light, shades and lines, of which a part `lit` is light. */
static swarf_status finish(swarf_canvas *c, const swarf_progress *progress, double from, double lit)
{
    SWARF_TRY(swarf_canvas_light(c, progress, from, lit));
    SWARF_TRY(swarf_canvas_shade(c, progress, lit, 1));
    return swarf_canvas_lines(c);
}

/** All that follows once the middles are known, which took the part `from` of the work: with what the recall knows of
 *  what the options ask for, and the recall knows it all afterwards. */
static swarf_status draw(swarf_canvas *c, swarf_recall *recall, const swarf_progress *progress, double from)
{
    if (!c->middle) return SWARF_OK;
    const int is_lit = (!c->options->occlusion || recall->sky) && (!c->options->shadow || recall->sun);
    if (c->options->occlusion) c->sky = recall->sky;
    if (c->options->shadow) c->sun = recall->sun;
    if (c->options->edges) c->mark = recall->mark;
    c->detail = &recall->detail;
    const swarf_status status = finish(c, progress, from, is_lit ? from : from + lighting * (1 - from));
    if (c->sky) recall->sky = c->sky;
    if (c->sun) recall->sun = c->sun;
    if (c->mark) recall->mark = c->mark;
    return status;
}

typedef struct output {
    const swarf_canvas *canvas;
    const swarf_picture_buffers *to;
} output;

/** Colour of a pixel between the middles of coarse squares. */
static void blend(const swarf_canvas *c, int32_t x, int32_t y, float out[4])
{
    const double u = fmax((x + 0.5) / c->coarse - 0.5, 0), v = fmax((y + 0.5) / c->coarse - 0.5, 0);
    const int32_t x0 = (int32_t)u, y0 = (int32_t)v;
    const int32_t x1 = x0 + 1 < c->width ? x0 + 1 : x0, y1 = y0 + 1 < c->height ? y0 + 1 : y0;
    const float fx = (float)(u - x0), fy = (float)(v - y0);
    const float *c00 = c->colour[swarf_canvas_at(c, x0, y0)];
    const float *c10 = c->colour[swarf_canvas_at(c, x1, y0)];
    const float *c01 = c->colour[swarf_canvas_at(c, x0, y1)];
    const float *c11 = c->colour[swarf_canvas_at(c, x1, y1)];
    for (int channel = 0; channel < 4; channel++)
        out[channel] = (1 - fy) * ((1 - fx) * c00[channel] + fx * c10[channel]) +
                       fy * ((1 - fx) * c01[channel] + fx * c11[channel]);
}

/** Point of a square in full precision. */
static void point_of(const swarf_canvas *c, int32_t x, int32_t y, double out[3])
{
    const swarf_sight *sight = &c->middle[swarf_canvas_at(c, x, y)];
    const double place[2] = {swarf_canvas_x(c, x, 0.5), swarf_canvas_y(c, y, 0.5)};
    double direction[3];
    swarf_look_ray(&c->look, place, out, direction);
    for (int axis = 0; axis < 3; axis++)
        out[axis] = sight->seen == SWARF_SEEN_NOTHING ? NAN : out[axis] + sight->distance * direction[axis];
}

static double depth_of(const swarf_look *look, const double point[3])
{
    double arm[3];
    for (int axis = 0; axis < 3; axis++) arm[axis] = point[axis] - look->frame.eye[axis];
    return vector_dot(arm, look->frame.forward);
}

static void put_colours(const swarf_canvas *c, size_t row, uint8_t *rgba)
{
    enum { PART = 64 };
    const size_t width = (size_t)c->options->width;
    float colour[PART][4];
    if (c->bytes) {
        memcpy(rgba + 4 * row * width, c->bytes + 4 * row * width, 4 * width);
        return;
    }
    if (c->coarse == 1) {
        swarf_shade_encode(c->colour + row * width, width, rgba + 4 * row * width);
        return;
    }
    for (size_t first = 0; first < width; first += PART) {
        const size_t count = width - first < PART ? width - first : PART;
        for (size_t i = 0; i < count; i++) blend(c, (int32_t)(first + i), (int32_t)row, colour[i]);
        swarf_shade_encode(colour, count, rgba + 4 * (row * width + first));
    }
}

static swarf_status put_row(void *context, size_t row)
{
    const output *o = context;
    const swarf_canvas *c = o->canvas;
    const int32_t width = c->options->width, y = (int32_t)row / c->coarse;
    const int is_more = o->to->seen || o->to->move || o->to->normal || o->to->depth || o->to->position;
    if (o->to->rgba) put_colours(c, row, o->to->rgba);
    for (int32_t i = 0; is_more && i < width; i++) {
        const int32_t x = i / c->coarse;
        const size_t at = row * (size_t)width + (size_t)i, square = swarf_canvas_at(c, x, y);
        const swarf_sight *sight = &c->middle[square];
        if (o->to->seen) o->to->seen[at] = (uint8_t)sight->seen;
        if (o->to->move) o->to->move[at] = sight->move;
        if (o->to->normal) memcpy(o->to->normal + 3 * at, sight->normal, sizeof sight->normal);
        if (!o->to->depth && !o->to->position) continue;
        double point[3];
        point_of(c, x, y, point);
        if (o->to->position) memcpy(o->to->position + 3 * at, point, sizeof point);
        if (o->to->depth)
            o->to->depth[at] = sight->seen == SWARF_SEEN_NOTHING ? INFINITY : (float)depth_of(&c->look, point);
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
        .exact = 1,
        .edges = 1,
        .occlusion = 1,
        .colour = {0.63f, 0.62f, 0.62f},
        .background = {0.86f, 0.88f, 0.90f, 1},
        .background_top = {0.42f, 0.49f, 0.58f, 1},
        .value_range = 0.1,
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
    SWARF_REQUIRE(isfinite(o->moves_done) && isfinite(o->value_range) && isfinite(o->axes_mm),
                  "picture: moves done, range of values or length of axes is not finite");
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

/** Whether a picture is nothing but the colours of one ray each. */
static int is_plain(const swarf_scene *scene, const swarf_shading *shading, const swarf_picture_buffers *out)
{
    const swarf_picture_options *o = shading->options;
    const int passes = o->samples > 1 || o->edges || o->occlusion || o->shadow || o->path || o->outline ||
                       o->axes_mm > 0 || (o->exact && swarf_scene_surface(scene));
    return !passes && swarf_shade_is_uniform(shading) && !out->depth && !out->normal && !out->position && !out->move &&
           !out->seen;
}

/** With the scene entered. */
static swarf_status render(swarf_scene *scene, const swarf_camera *camera, swarf_canvas *c,
                           const swarf_progress *progress, const swarf_picture_buffers *out)
{
    const swarf_picture_options *options = c->options;
    const double started = now_ms();
    c->coarse = choose_coarse(scene, options);
    c->width = (options->width + c->coarse - 1) / c->coarse;
    c->height = (options->height + c->coarse - 1) / c->coarse;
    SWARF_TRY(swarf_look_begin(scene, camera, options, c->height, &c->look));
    SWARF_TRY(swarf_shading_make(&c->look, options, &c->shading));
    const size_t squares = (size_t)c->width * (size_t)c->height;
    const size_t middles = is_plain(scene, &c->shading, out) ? 0 : squares;
    void *scratch = swarf_scene_scratch(scene, squares * sizeof *c->colour + middles * sizeof *c->middle);
    swarf_recall *const recall = swarf_scene_recall(scene);
    swarf_outlook outlook;
    swarf_outlook_make(camera, options, c->coarse, &outlook);
    const int is_new = !middles || !swarf_recall_has(recall, &outlook);
    c->colour = scratch;
    c->bytes = !middles && c->coarse == 1 ? scratch : NULL; /* then there are no colours */
    c->middle = middles ? (swarf_sight *)(void *)(c->colour + squares) : NULL;
    if (!scratch)
        return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory for %d x %d pixels", (int)options->width,
                          (int)options->height);
    if (is_new) {
        swarf_recall_forget(recall);
        SWARF_TRY(find_middles(c, progress));
        if (middles) swarf_recall_keep(recall, &outlook);
    }
    SWARF_TRY(draw(c, recall, progress, is_new ? refined : 0));
    output o = {c, out};
    SWARF_TRY(swarf_parallel_for((size_t)options->height, put_row, &o, NULL, 0, 1));
    if (is_new) swarf_scene_note_ray_ms(scene, (now_ms() - started) / (double)squares);
    return SWARF_OK;
}

swarf_status swarf_scene_render(swarf_scene *scene, const swarf_camera *camera, const swarf_picture_options *options,
                                const swarf_progress *progress, const swarf_picture_buffers *out)
{
    SWARF_REQUIRE(scene && camera && options && out, "picture: scene, camera, options or output missing");
    SWARF_REQUIRE(out->size == sizeof *out, "picture: buffers of another version");
    SWARF_TRY(check_options(options));
    swarf_canvas c = {.options = options};
    SWARF_TRY(swarf_scene_enter(scene));
    const swarf_status status = render(scene, camera, &c, progress, out);
    swarf_scene_leave(scene);
    swarf_look_end(&c.look);
    return status;
}

swarf_status swarf_scene_picture(swarf_scene *scene, const swarf_camera *camera, const swarf_picture_options *options,
                                 const swarf_progress *progress, uint8_t *rgba)
{
    SWARF_REQUIRE(rgba, "picture: pixels missing");
    const swarf_picture_buffers out = {.size = sizeof out, .rgba = rgba};
    return swarf_scene_render(scene, camera, options, progress, &out);
}

swarf_status swarf_scene_pick(swarf_scene *scene, const swarf_camera *camera, const swarf_picture_options *options,
                              double x, double y, swarf_pick *out)
{
    SWARF_REQUIRE(scene && camera && options && out, "pick: scene, camera, options or output missing");
    SWARF_REQUIRE(isfinite(x) && isfinite(y), "pick: the place in the picture is not finite");
    SWARF_TRY(check_options(options));
    SWARF_TRY(swarf_scene_enter(scene));
    swarf_look look = {0};
    swarf_sight sight = {0};
    swarf_sight *const seen = &sight;
    const double place[2] = {x, y};
    const swarf_places places = {{x}, {y}, 1};
    swarf_status status = swarf_look_begin(scene, camera, options, options->height, &look);
    if (status == SWARF_OK) {
        swarf_look_through(&look, &places, 1, &seen);
        if (options->exact)
            status = swarf_look_refine(&look, &(swarf_sights){&sight, 1, 0, place_of_pick, place}, NULL, 0, 1);
    }
    swarf_look_end(&look);
    swarf_scene_leave(scene);
    SWARF_TRY(status);
    swarf_pick pick = {.seen = sight.seen, .move = -1, .depth = NAN};
    for (int axis = 0; axis < 3; axis++) pick.point[axis] = pick.normal[axis] = NAN;
    if (sight.seen != SWARF_SEEN_NOTHING) {
        double direction[3];
        swarf_look_ray(&look, place, pick.point, direction);
        for (int axis = 0; axis < 3; axis++) {
            pick.point[axis] += sight.distance * direction[axis];
            pick.normal[axis] = sight.normal[axis];
        }
        pick.move = sight.move;
        pick.depth = depth_of(&look, pick.point);
    }
    *out = pick;
    return SWARF_OK;
}
