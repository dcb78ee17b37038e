/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Lines over a picture: the tool's path, an outline, axes; what is behind a surface shows faintly.
 *
 * They are made into strokes in grid squares first; bands of rows then draw them all in their order, so that the
 * picture is the same for any number of threads.
 */
#include "base/parallel.h"
#include "base/status.h"
#include "base/vector.h"
#include "render/picture.h"

#include <stdlib.h>
#include <string.h>

/* How a line looks. */
typedef struct style {
    float colour[3];
    float strength, hidden; /* opacity in front of surfaces and behind them */
    float width;            /* pixels */
    float dash;             /* pixels on and off; 0: none */
} style;

enum { RAPID_DONE, RAPID_COMING, FEED_DONE, FEED_COMING, SELECTED, OUTLINE, AXIS_X, AXIS_Y, AXIS_Z };
static const style styles[] = {
    [RAPID_DONE] = {{0.75f, 0.16f, 0.01f}, 0.75f, 0.05f, 1.2f, 5},
    [RAPID_COMING] = {{0.85f, 0.36f, 0.03f}, 0.70f, 0.05f, 1.2f, 5},
    [FEED_DONE] = {{0.01f, 0.07f, 0.50f}, 0.75f, 0.07f, 1.5f, 0},
    [FEED_COMING] = {{0.01f, 0.30f, 0.05f}, 0.80f, 0.12f, 1.5f, 0},
    [SELECTED] = {{1.0f, 0.30f, 0.0f}, 1.0f, 0.5f, 2.6f, 0},
    [OUTLINE] = {{0.05f, 0.06f, 0.08f}, 0.7f, 0.15f, 1.2f, 0},
    [AXIS_X] = {{0.72f, 0.03f, 0.03f}, 1.0f, 0.45f, 2.4f, 0},
    [AXIS_Y] = {{0.03f, 0.45f, 0.03f}, 1.0f, 0.45f, 2.4f, 0},
    [AXIS_Z] = {{0.03f, 0.10f, 0.75f}, 1.0f, 0.45f, 2.4f, 0},
};
/* Chords of arcs, per turn. */
enum { ARC_CHORDS = 96 };

/* Between two places of the grid; depth goes along them as 1 / depth when the picture is in perspective. */
typedef struct stroke {
    float x[2], y[2];
    double depth[2];
    int32_t style;
} stroke;

typedef struct work {
    swarf_canvas *canvas;
    stroke *stroke;
    size_t count, room;
    float scale; /* squares per pixel */
} work;

static swarf_status add_line(work *w, const double a[3], const double b[3], int kind)
{
    const swarf_canvas *c = w->canvas;
    const swarf_camera_frame *frame = &c->look.frame;
    double end[2][3], depth[2];
    for (int i = 0; i < 2; i++) {
        depth[i] = 0;
        for (int axis = 0; axis < 3; axis++) {
            end[i][axis] = i ? b[axis] : a[axis];
            depth[i] += (end[i][axis] - frame->eye[axis]) * frame->forward[axis];
        }
    }
    if (frame->perspective) { /* only what is before the eye, by a thousandth of all that is seen */
        const double near = 1e-3 * (c->look.size + 1);
        if (depth[0] < near && depth[1] < near) return SWARF_OK;
        for (int i = 0; i < 2; i++) {
            if (depth[i] >= near) continue;
            const double part = (near - depth[i]) / (depth[1 - i] - depth[i]);
            for (int axis = 0; axis < 3; axis++) end[i][axis] += part * (end[1 - i][axis] - end[i][axis]);
            depth[i] = near;
        }
    }
    stroke s = {.style = kind};
    for (int i = 0; i < 2; i++) {
        double place[3];
        swarf_camera_frame_project(frame, end[i], place);
        s.x[i] = (float)((0.5 + 0.5 * place[0]) * c->options->width / c->coarse);
        s.y[i] = (float)((0.5 - 0.5 * place[1]) * c->options->height / c->coarse);
        s.depth[i] = depth[i];
        if (!(fabsf(s.x[i]) < 1e6f && fabsf(s.y[i]) < 1e6f)) return SWARF_OK; /* too near the eye to be drawn well */
    }
    if (w->count == w->room) {
        const size_t room = w->room ? 2 * w->room : 1024;
        stroke *grown = realloc(w->stroke, room * sizeof *grown);
        if (!grown) return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory for %zu lines", room);
        w->stroke = grown;
        w->room = room;
    }
    w->stroke[w->count++] = s;
    return SWARF_OK;
}

static swarf_status add_outline(work *w, const swarf_box *box)
{
    for (int axis = 0; axis < 3; axis++)
        for (int edge = 0; edge < 4; edge++) {
            double a[3], b[3];
            for (int i = 0; i < 3; i++)
                a[i] = b[i] = (i == (axis + 1) % 3 ? edge & 1 : edge >> 1) ? box->hi[i] : box->lo[i];
            a[axis] = box->lo[axis];
            b[axis] = box->hi[axis];
            SWARF_TRY(add_line(w, a, b, OUTLINE));
        }
    return SWARF_OK;
}

static swarf_status add_axes(work *w, double length)
{
    static const double origin[3] = {0, 0, 0};
    for (int axis = 0; axis < 3; axis++) {
        double tip[3] = {0, 0, 0};
        tip[axis] = length;
        SWARF_TRY(add_line(w, origin, tip, AXIS_X + axis));
        for (int barb = 0; barb < 4; barb++) {
            double back[3] = {0, 0, 0};
            back[axis] = 0.88 * length;
            back[(axis + 1 + (barb >> 1)) % 3] = (barb & 1 ? 0.04 : -0.04) * length;
            SWARF_TRY(add_line(w, tip, back, AXIS_X + axis));
        }
    }
    return SWARF_OK;
}

/** Part from .. to (0 .. 1) of a move. */
static swarf_status add_path(work *w, const swarf_path *path, double from, double to, int kind)
{
    const int chords = path->is_arc ? (int)(fabs(path->arc.angle_rad) * (to - from) * ARC_CHORDS / 6.2831853) + 1 : 1;
    double a[3], b[3];
    swarf_path_point(path, from, a);
    for (int chord = 1; chord <= chords; chord++) {
        swarf_path_point(path, from + (to - from) * chord / chords, b);
        SWARF_TRY(add_line(w, a, b, kind));
        memcpy(a, b, sizeof a);
    }
    return SWARF_OK;
}

static swarf_status add_moves(work *w)
{
    const swarf_picture_options *o = w->canvas->options;
    const swarf_move *moves = swarf_program_moves(o->program);
    for (size_t i = 0; i < swarf_program_move_count(o->program); i++) {
        swarf_path path;
        SWARF_TRY(swarf_program_path(o->program, i, &path));
        if (!path.has_motion) continue;
        const int rapid = swarf_move_get_kind(&moves[i]) != SWARF_MOVE_FEED;
        const double done = fmin(fmax(o->moves_done - (double)i, 0), 1);
        if (swarf_shade_is_selected(o, (int64_t)i)) {
            SWARF_TRY(add_path(w, &path, 0, 1, SELECTED));
            continue;
        }
        if (done > 0) SWARF_TRY(add_path(w, &path, 0, done, rapid ? RAPID_DONE : FEED_DONE));
        if (done < 1) SWARF_TRY(add_path(w, &path, done, 1, rapid ? RAPID_COMING : FEED_COMING));
    }
    return SWARF_OK;
}

/** Depth of what a square shows, along the view. */
static double depth_of(const swarf_canvas *c, const swarf_sight *sight)
{
    if (sight->seen == SWARF_SEEN_NOTHING) return INFINITY;
    double depth = 0;
    for (int axis = 0; axis < 3; axis++)
        depth += (c->look.middle[axis] + sight->point[axis] - c->look.frame.eye[axis]) * c->look.frame.forward[axis];
    return depth;
}

static void draw_square(const work *w, const style *s, int32_t x, int32_t y, float cover, double depth)
{
    const swarf_canvas *c = w->canvas;
    const size_t at = swarf_canvas_at(c, x, y);
    const swarf_sight *sight = &c->middle[at];
    /* The path runs on the surfaces it made: what lies this close before it does not hide it. */
    const double leeway = swarf_scene_voxel(c->look.scene) + 2 * swarf_look_footprint(&c->look, sight);
    const float part = cover * (depth < depth_of(c, sight) + leeway ? s->strength : s->hidden);
    float *colour = c->colour[at];
    for (int channel = 0; channel < 3; channel++)
        colour[channel] = (1 - part) * colour[channel] + part * s->colour[channel];
    colour[3] = (1 - part) * colour[3] + part;
}

static void draw_stroke(const work *w, const stroke *s, int32_t top, int32_t end)
{
    const swarf_canvas *c = w->canvas;
    const style *look = &styles[s->style];
    const float half = 0.5f * look->width * w->scale > 0.5f ? 0.5f * look->width * w->scale : 0.5f;
    const float dx = s->x[1] - s->x[0], dy = s->y[1] - s->y[0], square = dx * dx + dy * dy, length = sqrtf(square);
    const int steep = fabsf(dy) > fabsf(dx);
    if (length < 1e-3f) return;
    /* Along the axis that it goes farther on, square by square; across, those within its width. */
    const float *along = steep ? s->y : s->x, *across = steep ? s->x : s->y;
    const float slope = steep ? dx / dy : dy / dx, reach = (half + 1) * length / (steep ? fabsf(dy) : fabsf(dx));
    const int32_t lo = steep ? top : 0, hi = steep ? end : c->width;
    const float least = fminf(along[0], along[1]) - half, most = fmaxf(along[0], along[1]) + half;
    for (int32_t i = least < (float)lo ? lo : (int32_t)least; i < hi && (float)i <= most; i++) {
        const float middle = across[0] + slope * ((float)i + 0.5f - along[0]);
        const int32_t first = steep ? 0 : top, last = steep ? c->width : end;
        int32_t j = middle - reach < (float)first ? first : (int32_t)(middle - reach);
        for (; j < last && (float)j <= middle + reach; j++) {
            const int32_t x = steep ? j : i, y = steep ? i : j;
            const float px = (float)x + 0.5f - s->x[0], py = (float)y + 0.5f - s->y[0];
            const float place = (px * dx + py * dy) / square;
            const float beyond = place < 0 ? -place : place > 1 ? place - 1 : 0;
            const float off = hypotf((px * dy - py * dx) / length, beyond * length);
            float cover = half + 0.5f - off;
            cover = cover > 0 ? (cover < 1 ? cover : 1) : 0;
            if (look->dash > 0 && ((int)(place * length / (look->dash * w->scale)) & 1)) cover = 0;
            if (cover == 0) continue;
            const double t = place < 0 ? 0 : place > 1 ? 1 : (double)place;
            const double depth = c->look.frame.perspective ? 1 / ((1 - t) / s->depth[0] + t / s->depth[1])
                                                           : (1 - t) * s->depth[0] + t * s->depth[1];
            draw_square(w, look, x, y, cover, depth);
        }
    }
}

static swarf_status draw_band(void *context, size_t band)
{
    const work *w = context;
    const int32_t top = (int32_t)band * SWARF_TILE;
    const int32_t end = top + SWARF_TILE < w->canvas->height ? top + SWARF_TILE : w->canvas->height;
    for (size_t i = 0; i < w->count; i++) {
        const stroke *s = &w->stroke[i];
        const float low = fminf(s->y[0], s->y[1]), high = fmaxf(s->y[0], s->y[1]), margin = 4 * w->scale + 2;
        if (high + margin >= (float)top && low - margin <= (float)end) draw_stroke(w, s, top, end);
    }
    return SWARF_OK;
}

swarf_status swarf_canvas_lines(swarf_canvas *c)
{
    work w = {.canvas = c, .scale = 1 / (float)c->coarse};
    swarf_status status = SWARF_OK;
    if (c->options->outline) status = add_outline(&w, c->options->outline);
    if (status == SWARF_OK && c->options->path && c->options->program) status = add_moves(&w);
    if (status == SWARF_OK && c->options->axes_mm > 0) status = add_axes(&w, c->options->axes_mm);
    if (status == SWARF_OK && w.count)
        status = swarf_parallel_for((size_t)(c->height + SWARF_TILE - 1) / SWARF_TILE, draw_band, &w, NULL, 0, 1);
    free(w.stroke);
    return status;
}
