/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "render/shade.h"

#include "base/status.h"
#include "base/vector.h"

#include <math.h>
#include <pthread.h>
#include <string.h>

/* IEC 61966-2-1 in eight bits, by linear value. At black, where it is steepest, an entry is a quarter of a step. */
static int32_t srgb[SWARF_SRGB_SIZE + 1];
static pthread_once_t srgb_once = PTHREAD_ONCE_INIT;

static void fill_srgb(void)
{
    for (int i = 0; i <= SWARF_SRGB_SIZE; i++) {
        const double x = (double)i / SWARF_SRGB_SIZE;
        srgb[i] = (int32_t)((x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055) * 255 + 0.5);
    }
}

/* Towards the light in the camera's right, up and backward: from the upper left. Faces towards the viewer, upwards and
 * to the side get three different tones. */
static const double light_camera[3] = {-0.36, 0.76, 0.46};
/* Strength and sharpness of the gloss on steel. */
static const float gloss = 0.35f, gloss_power = 24;

/* Linear RGB. */
static const float flutes_colour[3] = {0.70f, 0.56f, 0.24f};
static const float shank_colour[3] = {0.42f, 0.44f, 0.47f};
static const float holder_colour[3] = {0.13f, 0.14f, 0.17f};
static const float fixture_colour[3] = {0.16f, 0.30f, 0.27f};
static const float section_colour[3] = {0.62f, 0.17f, 0.08f};
static const float selected_colour[3] = {1.0f, 0.36f, 0.02f};
/* Lines of a hatch: one in so many squares of the picture. */
static const double hatch_squares = 9;

/* Of the first numbers, sRGB: told apart by most colour-blind people when neighbours in this order (after Okabe and
 * Ito), on light and on dark. */
static const uint8_t first_colours[][3] = {{0x3d, 0x8f, 0xd1}, {0xe6, 0x9f, 0x00}, {0x2a, 0xa8, 0x76},
                                           {0xcc, 0x6f, 0xa6}, {0xd5, 0x5e, 0x00}, {0x7b, 0x7f, 0xd4},
                                           {0xa3, 0xa1, 0x29}, {0x50, 0xb7, 0xc9}};

void swarf_picture_colour(int32_t number, float out[3])
{
    if (number >= 0 && number < (int32_t)(sizeof first_colours / sizeof first_colours[0])) {
        for (int channel = 0; channel < 3; channel++) {
            const double value = first_colours[number][channel] / 255.0;
            out[channel] = (float)(value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4));
        }
        return;
    }
    /* Hues by the golden ratio: any few in a row lie far apart. */
    const double turn = 0.61803398875 * number + 0.08, hue = 6 * (turn - floor(turn));
    static const double phase[3] = {3, 5, 1};
    for (int channel = 0; channel < 3; channel++) {
        const double k = fmod(phase[channel] + 6 - hue, 6);
        const double value = 0.85 - 0.68 * fmax(0, fmin(fmin(k, 4 - k), 1));
        out[channel] = (float)pow(value, 2.2);
    }
}

swarf_status swarf_shading_make(const swarf_look *look, const swarf_picture_options *options, swarf_shading *out)
{
    swarf_shading shading = {.look = look, .options = options, .feed_lo = INFINITY, .feed_hi = 0};
    double light[3];
    pthread_once(&srgb_once, fill_srgb);
    SWARF_REQUIRE(options->colouring >= 0 && options->colouring < SWARF_COLOURING_COUNT, "picture: no colouring %d",
                  (int)options->colouring);
    if (options->colouring == SWARF_COLOURING_DEVIATION)
        SWARF_REQUIRE(options->values && options->value_range > 0, "picture: values or their range missing");
    else if (options->colouring != SWARF_COLOURING_MATERIAL)
        SWARF_REQUIRE(options->program, "picture: the colouring needs the program");
    for (int axis = 0; axis < 3; axis++)
        light[axis] = light_camera[0] * look->frame.right[axis] + light_camera[1] * look->frame.up[axis] -
                      light_camera[2] * look->frame.forward[axis];
    (void)vector_normalise(light);
    for (int axis = 0; axis < 3; axis++) shading.light[axis] = (float)light[axis];
    const int by_feed = options->colouring == SWARF_COLOURING_FEED;
    const size_t count = by_feed ? swarf_program_move_count(options->program) : 0;
    const swarf_move *moves = count ? swarf_program_moves(options->program) : NULL;
    for (size_t i = 0; i < count; i++) {
        if (swarf_move_get_kind(&moves[i]) != SWARF_MOVE_FEED || !(moves[i].feed_mm_min > 0)) continue;
        if (moves[i].feed_mm_min < shading.feed_lo) shading.feed_lo = moves[i].feed_mm_min;
        if (moves[i].feed_mm_min > shading.feed_hi) shading.feed_hi = moves[i].feed_mm_min;
    }
    *out = shading;
    return SWARF_OK;
}

static void backdrop(const swarf_picture_options *options, float height, float out[4])
{
    const float *bottom = options->background, *top = options->background_top;
    out[3] = bottom[3] + height * (top[3] - bottom[3]);
    for (int channel = 0; channel < 3; channel++)
        out[channel] = out[3] * (bottom[channel] + height * (top[channel] - bottom[channel]));
}

/** Blue over green and yellow to red for x = 0 .. 1. */
static void ramp(float x, float out[3])
{
    static const float stops[5][3] = {{0.05f, 0.12f, 0.62f},
                                      {0.02f, 0.45f, 0.60f},
                                      {0.10f, 0.55f, 0.16f},
                                      {0.80f, 0.62f, 0.06f},
                                      {0.70f, 0.08f, 0.03f}};
    const float place = fminf(fmaxf(x, 0), 1) * 4;
    const int low = place < 3 ? (int)place : 3;
    for (int channel = 0; channel < 3; channel++)
        out[channel] = stops[low][channel] + (place - (float)low) * (stops[low + 1][channel] - stops[low][channel]);
}

static void blend(float colour[3], const float other[3], float part)
{
    for (int channel = 0; channel < 3; channel++) colour[channel] += part * (other[channel] - colour[channel]);
}

/* Red where material is left, blue where it is missing, as swarf_deviation_colours() has it. */
static void deviation_colour(float value, float range, float out[3])
{
    static const float within[3] = {0.12f, 0.50f, 0.16f};
    static const float excess[3] = {0.75f, 0.05f, 0.03f}, gouge[3] = {0.05f, 0.12f, 0.75f};
    static const float most[2][3] = {{0.80f, 0.62f, 0.06f}, {0.02f, 0.45f, 0.60f}};
    const float part = fminf(fabsf(value) / range, 1);
    memcpy(out, within, sizeof within);
    if (part > 0.1f) {
        memcpy(out, most[value < 0], sizeof within);
        blend(out, value < 0 ? gouge : excess, (part - 0.1f) / 0.9f);
    }
}

/** What the colouring makes of the stock's surface. */
static void surface_colour(const swarf_shading *s, const swarf_sight *sight, float value, float out[3])
{
    const swarf_picture_options *o = s->options;
    memcpy(out, o->colour, sizeof o->colour);
    if (o->colouring == SWARF_COLOURING_DEVIATION && !isnan(value)) deviation_colour(value, (float)o->value_range, out);
    if (sight->move < 0 || !o->program || (size_t)sight->move >= swarf_program_move_count(o->program)) return;
    const swarf_move *move = &swarf_program_moves(o->program)[sight->move];
    const swarf_section *section = &swarf_program_sections(o->program)[swarf_move_get_section(move)];
    switch (o->colouring) {
    case SWARF_COLOURING_OPERATION: swarf_picture_colour(section->operation, out); break;
    case SWARF_COLOURING_TOOL: swarf_picture_colour(section->tool, out); break;
    case SWARF_COLOURING_AGE: ramp((float)(sight->move / fmax(o->moves_done, 1)), out); break;
    case SWARF_COLOURING_FEED:
        ramp(s->feed_hi > s->feed_lo ? (move->feed_mm_min - s->feed_lo) / (s->feed_hi - s->feed_lo) : 0, out);
        break;
    default: break;
    }
    if (swarf_shade_is_selected(o, sight->move)) blend(out, selected_colour, 0.8f);
}

/** Slanting lines as wide as the gaps between them look best; these are half that, on the colour of a cut. */
static void hatch(const swarf_shading *s, const swarf_sight *sight, float out[3])
{
    static const float between[3] = {0.78f, 0.42f, 0.26f};
    const swarf_camera_frame *frame = &s->look->frame;
    double across = 0;
    for (int axis = 0; axis < 3; axis++) across += sight->point[axis] * (frame->right[axis] + frame->up[axis]);
    const double lines = across / (swarf_look_footprint(s->look, sight) * hatch_squares * 1.41421356);
    const double off = fabs(lines - floor(lines) - 0.5) * hatch_squares; /* squares from the line's middle */
    memcpy(out, between, sizeof between);
    blend(out, section_colour, (float)fmin(fmax(1.6 - off, 0), 1));
}

/* Base colour and gloss of what takes light; 0: it has a colour of its own, which goes to `out`. */
static int take_base(const swarf_shading *s, const swarf_spot *spot, float base[3], float *glossy, float out[4])
{
    *glossy = 0;
    switch (spot->sight->seen) {
    case SWARF_SEEN_NOTHING: backdrop(s->options, (float)(0.5 + 0.5 * spot->y), out); return 0;
    case SWARF_SEEN_SECTION:
        hatch(s, spot->sight, out);
        out[3] = 1;
        return 0;
    case SWARF_SEEN_FLUTES: memcpy(base, flutes_colour, sizeof flutes_colour); break;
    case SWARF_SEEN_SHANK: memcpy(base, shank_colour, sizeof shank_colour); break;
    case SWARF_SEEN_HOLDER: memcpy(base, holder_colour, sizeof holder_colour); break;
    case SWARF_SEEN_FIXTURE: memcpy(base, fixture_colour, sizeof fixture_colour); return 1;
    default: surface_colour(s, spot->sight, spot->value, base); return 1;
    }
    *glossy = gloss;
    return 1;
}

/* The light's mirror image, seen along the view. */
static float shine(const swarf_shading *s, const float normal[3], float glossy)
{
    const float *l = s->light;
    const float cosine = l[0] * normal[0] + l[1] * normal[1] + l[2] * normal[2];
    float along = 0;
    for (int axis = 0; axis < 3; axis++)
        along -= (2 * cosine * normal[axis] - l[axis]) * (float)s->look->frame.forward[axis];
    return along > 0 ? glossy * powf(along, gloss_power) : 0;
}

void swarf_shade(const swarf_shading *shading, const swarf_spot spots[], int count, float (*out)[4])
{
    swarf_tones tones;
    float lit[3][SWARF_PACKET], glossy[SWARF_PACKET];
    int lit_spots[SWARF_PACKET], used = 0;
    for (int i = 0; i < count; i++) {
        float base[3];
        if (!take_base(shading, &spots[i], base, &glossy[used], out[i])) continue;
        for (int axis = 0; axis < 3; axis++) {
            tones.base[axis][used] = base[axis];
            tones.normal[axis][used] = spots[i].sight->normal[axis];
        }
        tones.sky[used] = spots[i].sky;
        tones.sun[used] = spots[i].sun;
        lit_spots[used++] = i;
    }
    if (used == 0) return;
    memcpy(tones.light, shading->light, sizeof tones.light);
    swarf_ray_kernel_current()->shade(&tones, lit);
    for (int k = 0; k < used; k++) {
        float *colour = out[lit_spots[k]];
        const float more = glossy[k] > 0 ? shine(shading, spots[lit_spots[k]].sight->normal, glossy[k]) : 0;
        for (int channel = 0; channel < 3; channel++) colour[channel] = lit[channel][k] + more;
        colour[3] = 1;
    }
}

int swarf_shade_is_uniform(const swarf_shading *shading)
{
    const swarf_look *look = shading->look;
    return shading->options->colouring == SWARF_COLOURING_MATERIAL && !shading->options->selected_count &&
           !look->cutter && look->section_count == 0 && !swarf_scene_fixtures(look->scene);
}

/** Light on what all rays of a packet met, if it is the stock. */
static void light_rays(const swarf_shading *shading, const swarf_rays *rays, float lit[3][SWARF_PACKET])
{
    swarf_tones tones;
    memcpy(tones.normal, rays->normal, sizeof tones.normal);
    memcpy(tones.light, shading->light, sizeof tones.light);
    for (int ray = 0; ray < SWARF_PACKET; ray++) {
        for (int channel = 0; channel < 3; channel++) tones.base[channel][ray] = shading->options->colour[channel];
        tones.sky[ray] = tones.sun[ray] = 1;
    }
    swarf_ray_kernel_current()->shade(&tones, lit);
}

void swarf_shade_rays(const swarf_shading *shading, const swarf_rays *rays, const swarf_places *places, float (*out)[4])
{
    float lit[3][SWARF_PACKET];
    if (rays->hit) light_rays(shading, rays, lit);
    for (unsigned ray = 0; ray < places->count; ray++) {
        if (!(rays->hit >> ray & 1)) {
            backdrop(shading->options, (float)(0.5 + 0.5 * places->y[ray]), out[ray]);
            continue;
        }
        for (int channel = 0; channel < 3; channel++) out[ray][channel] = lit[channel][ray];
        out[ray][3] = 1;
    }
}

void swarf_shade_hits(const swarf_shading *shading, const swarf_rays *rays, uint8_t out[SWARF_PACKET][4])
{
    float lit[3][SWARF_PACKET];
    if (rays->hit == 0) return;
    light_rays(shading, rays, lit);
    swarf_ray_kernel_current()->encode_opaque(lit, srgb, rays->hit, out[0]);
}

void swarf_shade_backdrop(const swarf_shading *shading, double y, uint8_t out[4])
{
    float colour[1][4];
    backdrop(shading->options, (float)(0.5 + 0.5 * y), colour[0]);
    swarf_shade_encode(colour, 1, out);
}

void swarf_shade_encode(const float (*colour)[4], size_t count, uint8_t *out)
{
    const swarf_ray_kernel *kernel = swarf_ray_kernel_current();
    size_t at = 0;
    for (; at + 4 <= count; at += 4) kernel->encode(colour[at], srgb, out + 4 * at);
    if (at == count) return;
    float last[4][4] = {{0}};
    uint8_t bytes[4][4];
    memcpy(last, colour[at], (count - at) * sizeof *colour);
    kernel->encode(last[0], srgb, bytes[0]);
    memcpy(out + 4 * at, bytes, (count - at) * sizeof *bytes);
}
