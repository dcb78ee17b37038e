/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Light: how much of the sky each square's surface sees, and whether the light reaches it.
 *
 * The sky is looked for from one square of each block of 2x2, with 8 rays over the half space above the surface, more
 * of them where they count more (cosine weighting). Blocks turn the pattern by one of 4x4 angles, and each goes to
 * other heights; a square then takes the mean of the 4x4 blocks around it that lie on its own face, which has each
 * pattern once: 128 different rays. Right beside a wall a ray may start in the rounding of the voxels, which would look
 * like open sky: such blocks have no say.
 */
#include "base/parallel.h"
#include "base/status.h"
#include "base/vector.h"
#include "render/picture.h"

#include <stdlib.h>
#include <string.h>

/* Blocks that share a packet: so many rays has each. */
enum { BLOCK = 2, PATTERN = 4, SHARE = 2, RAYS = SWARF_PACKET / SHARE };

/* Of the size of what is seen: what lies farther darkens nothing. */
static const double sky_reach = 0.18;
/* Voxels by which rays start above the surface: the field's noise is a hundredth of that. */
static const double lift = 0.3;
static const double golden_angle = 2.39996322972865332;

typedef struct sky_work {
    swarf_canvas *canvas;
    int32_t across, down; /* blocks */
    float *open;          /* per block, negative: not known */
    double pattern[PATTERN * PATTERN][RAYS][3];
} sky_work;

static int is_solid(const swarf_sight *sight)
{
    return sight->seen == SWARF_SEEN_STOCK || sight->seen == SWARF_SEEN_FIXTURE;
}

static void start_above(const swarf_canvas *c, const swarf_sight *sight, swarf_rays *rays, int ray)
{
    const double gap = lift * swarf_scene_voxel(c->look.scene);
    for (int axis = 0; axis < 3; axis++)
        rays->origin[axis][ray] = c->look.middle[axis] + sight->point[axis] + gap * sight->normal[axis];
}

/** The patterns: directions over a surface with the normal (0, 0, 1). */
static void make_patterns(double pattern[PATTERN * PATTERN][RAYS][3])
{
    for (int turn = 0; turn < PATTERN * PATTERN; turn++)
        for (int ray = 0; ray < RAYS; ray++) {
            /* Seven has no part in sixteen: each turn has a height of its own, far from those of the next ones. */
            const double height = (7 * turn % (PATTERN * PATTERN) + 0.5) / (PATTERN * PATTERN);
            const double square = (ray + height) / RAYS, radius = sqrt(square);
            const double angle = ray * golden_angle + turn * (6.28318530717958648 / (PATTERN * PATTERN));
            pattern[turn][ray][0] = radius * cos(angle);
            pattern[turn][ray][1] = radius * sin(angle);
            pattern[turn][ray][2] = sqrt(1 - square);
        }
}

/** Rays over the half space above what was seen, from number `first` of the packet on. */
static void look_up(const sky_work *w, const swarf_sight *sight, int turn, int first, swarf_rays *rays)
{
    const double n[3] = {sight->normal[0], sight->normal[1], sight->normal[2]};
    const double reach = sky_reach * w->canvas->look.size;
    double u[3] = {fabs(n[0]) < 0.6 ? 1 : 0, fabs(n[0]) < 0.6 ? 0 : 1, 0}, v[3];
    vector_cross(n, u, v);
    (void)vector_normalise(v);
    vector_cross(v, n, u);
    for (int i = 0; i < RAYS; i++) {
        const double *p = w->pattern[turn][i];
        const int ray = first + i;
        for (int axis = 0; axis < 3; axis++)
            rays->direction[axis][ray] = p[0] * u[axis] + p[1] * v[axis] + p[2] * n[axis];
        start_above(w->canvas, sight, rays, ray);
        rays->reach[ray] = reach;
        rays->active |= 1u << ray;
    }
}

/** Rays that are not there: what they hold does not matter, but it is something. */
static void leave_idle(swarf_rays *rays, int first)
{
    for (int ray = first; ray < SWARF_PACKET; ray++) {
        rays->reach[ray] = 1;
        for (int axis = 0; axis < 3; axis++) {
            rays->origin[axis][ray] = 0;
            rays->direction[axis][ray] = 1;
        }
    }
}

static float openness(const sky_work *w, const swarf_rays *rays, unsigned blocked)
{
    double open = RAYS;
    for (unsigned left = blocked; left; left &= left - 1) {
        const double part = rays->distance[__builtin_ctz(left)] / (sky_reach * w->canvas->look.size);
        open -= part < 1 ? 1 - part * part : 0;
    }
    return (float)(open / RAYS);
}

static swarf_status look_up_row(void *context, size_t row)
{
    const sky_work *w = context;
    const swarf_canvas *c = w->canvas;
    const unsigned all = (1u << RAYS) - 1;
    float *open = w->open + row * (size_t)w->across;
    for (int32_t bx = 0; bx < w->across;) {
        swarf_rays rays[SWARF_GROUP];
        int32_t block[SWARF_GROUP * SHARE];
        unsigned blocked[SWARF_GROUP], inside[SWARF_GROUP];
        int count = 0;
        for (; bx < w->across && count < SWARF_GROUP * SHARE; bx++) {
            const swarf_sight *sight = &c->middle[swarf_canvas_at(c, bx * BLOCK, (int32_t)row * BLOCK)];
            open[bx] = -1;
            if (!is_solid(sight)) continue;
            swarf_rays *const own = &rays[count / SHARE];
            if (count % SHARE == 0) own->active = 0;
            look_up(w, sight, (int)(row % PATTERN) * PATTERN + bx % PATTERN, count % SHARE * RAYS, own);
            block[count++] = bx;
        }
        if (count % SHARE) leave_idle(&rays[count / SHARE], count % SHARE * RAYS);
        swarf_look_blocked(&c->look, rays, blocked, inside, (count + SHARE - 1) / SHARE);
        for (int i = 0; i < count; i++) {
            const unsigned own = all << (i % SHARE * RAYS);
            if (!(inside[i / SHARE] & own)) open[block[i]] = openness(w, &rays[i / SHARE], blocked[i / SHARE] & own);
        }
    }
    return SWARF_OK;
}

/** How much a block on the way from a square says of it: 0 beyond an edge. */
static float alike(const swarf_canvas *c, const swarf_sight *own, const swarf_sight *other)
{
    float cosine = 0, off = 0;
    for (int axis = 0; axis < 3; axis++) {
        cosine += own->normal[axis] * other->normal[axis];
        off += (other->point[axis] - own->point[axis]) * own->normal[axis];
    }
    return cosine > 0.8f && fabsf(off) < 4 * (float)swarf_look_footprint(&c->look, own) ? cosine * cosine : 0;
}

static swarf_status spread_row(void *context, size_t row)
{
    const sky_work *w = context;
    const swarf_canvas *c = w->canvas;
    const int32_t y = (int32_t)row;
    for (int32_t x = 0; x < c->width; x++) {
        const swarf_sight *own = &c->middle[swarf_canvas_at(c, x, y)];
        float sum = 0, weight = 0;
        const int32_t bx0 = (x - 3) / BLOCK, by0 = (y - 3) / BLOCK;
        for (int32_t by = by0 < 0 ? 0 : by0; is_solid(own) && by < by0 + PATTERN && by < w->down; by++)
            for (int32_t bx = bx0 < 0 ? 0 : bx0; bx < bx0 + PATTERN && bx < w->across; bx++) {
                const float open = w->open[(size_t)by * (size_t)w->across + (size_t)bx];
                if (open < 0) continue;
                const float part = alike(c, own, &c->middle[swarf_canvas_at(c, bx * BLOCK, by * BLOCK)]);
                sum += part * open;
                weight += part;
            }
        c->sky[swarf_canvas_at(c, x, y)] = weight > 0 ? sum / weight : is_solid(own) ? 0.8f : 1;
    }
    return SWARF_OK;
}

/** Rays from up to SWARF_PACKET squares of a row towards the light. */
static void look_at_light(const swarf_canvas *c, const swarf_sight *sight, int32_t count, swarf_rays *rays)
{
    rays->active = 0;
    for (int ray = 0; ray < SWARF_PACKET; ray++) {
        rays->reach[ray] = c->look.size;
        for (int axis = 0; axis < 3; axis++) {
            rays->direction[axis][ray] = c->shading.light[axis];
            rays->origin[axis][ray] = 0;
        }
        if (ray >= count || !is_solid(&sight[ray])) continue;
        start_above(c, &sight[ray], rays, ray);
        rays->active |= 1u << ray;
    }
}

static swarf_status shadow_row(void *context, size_t row)
{
    const swarf_canvas *c = context;
    const swarf_sight *sight = &c->middle[swarf_canvas_at(c, 0, (int32_t)row)];
    uint8_t *sun = &c->sun[swarf_canvas_at(c, 0, (int32_t)row)];
    memset(sun, 255, (size_t)c->width);
    for (int32_t x = 0; x < c->width; x += SWARF_GROUP * SWARF_PACKET) {
        swarf_rays rays[SWARF_GROUP];
        unsigned blocked[SWARF_GROUP], inside[SWARF_GROUP];
        for (int32_t i = 0; i < SWARF_GROUP; i++)
            look_at_light(c, &sight[x] + i * SWARF_PACKET, c->width - x - i * SWARF_PACKET, &rays[i]);
        swarf_look_blocked(&c->look, rays, blocked, inside, SWARF_GROUP);
        for (int32_t i = 0; i < SWARF_GROUP; i++)
            for (unsigned left = blocked[i]; left; left &= left - 1)
                sun[x + i * SWARF_PACKET + __builtin_ctz(left)] = 0;
    }
    return SWARF_OK;
}

static swarf_status find_sky(swarf_canvas *c, const swarf_progress *progress, double from, double to)
{
    sky_work work = {c, (c->width + BLOCK - 1) / BLOCK, (c->height + BLOCK - 1) / BLOCK, NULL, {{{0}}}};
    make_patterns(work.pattern);
    c->sky = malloc((size_t)c->width * (size_t)c->height * sizeof *c->sky);
    work.open = malloc((size_t)work.across * (size_t)work.down * sizeof *work.open);
    swarf_status status = c->sky && work.open ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
    if (status == SWARF_OK) status = swarf_parallel_for((size_t)work.down, look_up_row, &work, progress, from, to);
    if (status == SWARF_OK) status = swarf_parallel_for((size_t)c->height, spread_row, &work, NULL, 0, 1);
    free(work.open);
    if (status == SWARF_OK) return SWARF_OK;
    free(c->sky);
    c->sky = NULL;
    return status;
}

static swarf_status find_sun(swarf_canvas *c, const swarf_progress *progress, double from, double to)
{
    c->sun = malloc((size_t)c->width * (size_t)c->height);
    if (!c->sun) return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
    const swarf_status status = swarf_parallel_for((size_t)c->height, shadow_row, c, progress, from, to);
    if (status == SWARF_OK) return SWARF_OK;
    free(c->sun);
    c->sun = NULL;
    return status;
}

swarf_status swarf_canvas_light(swarf_canvas *c, const swarf_progress *progress, double from, double to)
{
    const double middle = c->options->occlusion ? from + 0.7 * (to - from) : from;
    if (c->options->occlusion && !c->sky) SWARF_TRY(find_sky(c, progress, from, middle));
    if (c->options->shadow && !c->sun) SWARF_TRY(find_sun(c, progress, middle, to));
    return SWARF_OK;
}
