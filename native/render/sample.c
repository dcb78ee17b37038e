/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Shading the squares of a picture, with n x n samples for those that are rough: where a square and its eight
 * neighbours do not see one smooth face, and it shows: by a line, or by colours that differ.
 *
 * A sample is on an edge when half a square away something else is seen that goes on beyond: that is looked for among
 * the samples of the squares about it, or their middles where those stand for them.
 */
#include "base/parallel.h"
#include "base/status.h"
#include "render/detail.h"
#include "render/edges.h"
#include "render/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of three samples, the last of a row looks four further, into the second square; of two or four into the next one.
 * The window is of the samples about those of one square, as many of either side. */
enum { MARGIN = 2, SIDE_MAX = 4, REACH_MAX = 2, WINDOW_MAX = SIDE_MAX + 4 * REACH_MAX };

/* The samples of a whole picture are kept for the next one when they need no more than this (their list may have room
 * for twice as many). Those of larger ones are made and left again in strips of so many rows. */
enum { KEPT_BYTES_MAX = 128 << 20, STRIP = 64 };

/* One face: neighbours' normals differ by at most 2.5 degrees, and each lies in the plane of the other to 1 in 20 of
 * their distance, so that steps of more than 1/20 pixel show. Larger values save rays and leave jagged edges. */
static const float same_face_cosine = 0.999f, same_face_slope = 0.05f;

/* Colours that differ by less than this part of white, as they are shown, make no jagged edge that one could see. */
static const float same_colour = 4.0f / 255;

static int is_same_face(const swarf_sight *a, const swarf_sight *b)
{
    if (a->seen != b->seen) return 0;
    if (a->seen == SWARF_SEEN_NOTHING) return 1;
    float cosine = 0, off_a = 0, off_b = 0, square = 0;
    for (int axis = 0; axis < 3; axis++) {
        const float step = b->point[axis] - a->point[axis];
        cosine += a->normal[axis] * b->normal[axis];
        off_a += step * a->normal[axis];
        off_b += step * b->normal[axis];
        square += step * step;
    }
    const float most = same_face_slope * same_face_slope * square;
    return cosine > same_face_cosine && off_a * off_a <= most && off_b * off_b <= most;
}

/** Whether colours (linear, premultiplied) look different. What is shown is about the root of it: a - b over the sum of
 *  the roots, whose square is about twice a + b. */
static int is_same_colour(const float a[4], const float b[4])
{
    for (int channel = 0; channel < 4; channel++) {
        const float off = a[channel] - b[channel];
        if (off * off > 2 * same_colour * same_colour * (a[channel] + b[channel])) return 0;
    }
    return 1;
}

/** Whether there is a line about two squares, or they look different. */
static int shows(const swarf_canvas *c, size_t own, size_t other)
{
    return (c->mark && (c->mark[own].edge || c->mark[other].edge)) || c->middle[own].seen != c->middle[other].seen ||
           !is_same_colour(c->colour[own], c->colour[other]);
}

static int is_rough(const swarf_canvas *c, int32_t x0, int32_t y0)
{
    const size_t own = swarf_canvas_at(c, x0, y0);
    for (int32_t y = y0 - 1; y <= y0 + 1; y++)
        for (int32_t x = x0 - 1; x <= x0 + 1; x++) {
            if (x < 0 || y < 0 || x >= c->width || y >= c->height) continue;
            const size_t other = swarf_canvas_at(c, x, y);
            if (!shows(c, own, other)) continue;
            if (c->middle[own].move != c->middle[other].move || !is_same_face(&c->middle[own], &c->middle[other]))
                return 1;
        }
    return 0;
}

/** What there is to shade of a sight in square (x, y), at the part of its height. */
static swarf_spot spot_of(const swarf_canvas *c, int32_t x, int32_t y, double part_y, const swarf_sight *sight)
{
    const size_t at = swarf_canvas_at(c, x, y);
    float value = NAN;
    if (c->options->values) {
        const int32_t px = x * c->coarse + c->coarse / 2, py = y * c->coarse + c->coarse / 2;
        const int32_t width = c->options->width, height = c->options->height;
        value = c->options->values[(size_t)(py < height ? py : height - 1) * (size_t)width +
                                   (size_t)(px < width ? px : width - 1)];
    }
    /* Light is known of the middles; a sample of something else takes it from no one. */
    const int same = sight->seen == c->middle[at].seen;
    return (swarf_spot){sight, swarf_canvas_y(c, y, part_y), c->sky && same ? c->sky[at] : 1,
                        c->sun && same ? (float)c->sun[at] / 255 : 1, value};
}

/** Shade the middles of a row. */
static swarf_status shade_row(void *context, size_t row)
{
    const swarf_canvas *c = context;
    const int32_t y = (int32_t)row;
    float(*colour)[4] = c->colour + swarf_canvas_at(c, 0, y);
    for (int32_t x = 0; x < c->width; x += SWARF_PACKET) {
        swarf_spot spots[SWARF_PACKET];
        int count = 0;
        for (; count < SWARF_PACKET && x + count < c->width; count++)
            spots[count] = spot_of(c, x + count, y, 0.5, &c->middle[swarf_canvas_at(c, x + count, y)]);
        swarf_shade(&c->shading, spots, count, colour + x);
    }
    return SWARF_OK;
}

/** How dark the line in a square is, of an edge and an outline there. */
static float line_of(const swarf_canvas *c, size_t square, float edge, float outline)
{
    return fmaxf(edge * (float)c->mark[square].room / 255, outline);
}

/** Edges of a row of squares that have one ray each. */
static swarf_status draw_row_edges(void *context, size_t row)
{
    const swarf_canvas *c = context;
    for (size_t at = row * (size_t)c->width; at < (row + 1) * (size_t)c->width; at++)
        if (c->mark[at].edge)
            swarf_edge_draw(c->colour[at],
                            line_of(c, at, (float)c->mark[at].edge / 255, (float)c->mark[at].outline / 255));
    return SWARF_OK;
}

struct judging {
    const swarf_canvas *canvas;
    uint8_t *is_rough;
};

static swarf_status judge_row(void *context, size_t row)
{
    const struct judging *judging = context;
    const int32_t y = (int32_t)row;
    for (int32_t x = 0; x < judging->canvas->width; x++)
        judging->is_rough[swarf_canvas_at(judging->canvas, x, y)] = (uint8_t)is_rough(judging->canvas, x, y);
    return SWARF_OK;
}

typedef struct resolving {
    swarf_canvas *canvas;
    const uint8_t *is_rough; /* per square of the canvas */
    int32_t top;             /* row of the first piece of work */
} resolving;

/** The sights about square (x, y), at `window` with a row for each of theirs; NULL beyond the picture. */
static void open_window(const resolving *r, int32_t x, int32_t y, int32_t reach,
                        const swarf_sight *window[WINDOW_MAX][WINDOW_MAX])
{
    const swarf_canvas *c = r->canvas;
    const int32_t n = c->options->samples;
    for (int32_t dy = -MARGIN; dy <= MARGIN; dy++)
        for (int32_t dx = -MARGIN; dx <= MARGIN; dx++) {
            const int is_out = x + dx < 0 || y + dy < 0 || x + dx >= c->width || y + dy >= c->height;
            const size_t at = is_out ? 0 : swarf_canvas_at(c, x + dx, y + dy);
            const int is_fine = !is_out && r->is_rough[at];
            const swarf_sight *first = is_out ? NULL : is_fine ? swarf_detail_of(c->detail, at) : &c->middle[at];
            const int32_t left = n * dx + 2 * reach, up = n * dy + 2 * reach, end = n + 4 * reach;
            for (int32_t j = up < 0 ? -up : 0; j < n && up + j < end; j++)
                for (int32_t i = left < 0 ? -left : 0; i < n && left + i < end; i++)
                    window[up + j][left + i] = is_fine ? first + j * n + i : first;
        }
}

/** How dark the line is at the sample (i, j) of the window, which is one of square `at`. */
static float line_at(const swarf_canvas *c, size_t at, const swarf_sight *const window[WINDOW_MAX][WINDOW_MAX],
                     int32_t i, int32_t j, int32_t reach)
{
    static const int32_t steps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    const swarf_sight *const own = window[j][i];
    const float footprint = (float)swarf_look_footprint(&c->look, own);
    float edge = 0, height = 0;
    for (int step = 0; step < (reach > 1 ? 8 : 4) && height < INFINITY; step++) {
        const int32_t di = reach * steps[step][0], dj = reach * steps[step][1];
        const swarf_sight *const other = window[j + dj][i + di];
        if (!other) continue;
        const float own_height = swarf_edge_height(footprint, own, other), crease = swarf_edge_crease(own, other);
        if (own_height > height) height = own_height;
        if (crease > edge)
            edge = fmaxf(edge, swarf_edge_beyond(crease, window[j - dj][i - di], window[j + 2 * dj][i + 2 * di]));
    }
    return line_of(c, at, fmaxf(edge, swarf_edge_step(height)), swarf_edge_outline(height));
}

/** The mean of a square's samples. */
static void resolve_square(const resolving *r, int32_t x, int32_t y)
{
    const swarf_canvas *c = r->canvas;
    const size_t at = swarf_canvas_at(c, x, y);
    const int32_t n = c->options->samples, reach = (n + 1) / 2; /* half a square, rounded up */
    const swarf_sight *const sample = swarf_detail_of(c->detail, at);
    const swarf_sight *window[WINDOW_MAX][WINDOW_MAX];
    swarf_spot spots[SWARF_PACKET] = {{.sky = 1}};
    float one[SWARF_PACKET][4], *const sum = c->colour[at];
    for (int32_t sub = 0; sub < n * n; sub++) {
        const int32_t sub_row = sub / n;
        spots[sub] = spot_of(c, x, y, (sub_row + 0.5) / n, &sample[sub]);
    }
    swarf_shade(&c->shading, spots, n * n, one);
    memset(sum, 0, sizeof *c->colour);
    if (c->mark) open_window(r, x, y, reach, window);
    for (int32_t sub = 0; sub < n * n; sub++) {
        const float line = c->mark ? line_at(c, at, window, 2 * reach + sub % n, 2 * reach + sub / n, reach) : 0;
        if (line > 0) swarf_edge_draw(one[sub], line);
        for (int channel = 0; channel < 4; channel++) sum[channel] += one[sub][channel] / (float)(n * n);
    }
}

static swarf_status resolve_row(void *context, size_t row)
{
    const resolving *r = context;
    const int32_t y = r->top + (int32_t)row;
    for (int32_t x = 0; x < r->canvas->width; x++)
        if (r->is_rough[swarf_canvas_at(r->canvas, x, y)]) resolve_square(r, x, y);
    return SWARF_OK;
}

/** Samples of the rough squares in rows top .. end - 1 and about them, and what these rows become by them. */
static swarf_status sample_rows(resolving *r, int32_t end, const swarf_progress *progress, double from, double to)
{
    const swarf_canvas *c = r->canvas;
    const int32_t above = r->top > MARGIN ? r->top - MARGIN : 0;
    const int32_t below = end + MARGIN < c->height ? end + MARGIN : c->height;
    const double seen = from + 0.8 * (to - from); /* the parts of the progress by what they cost */
    SWARF_TRY(swarf_detail_add(c->detail, c, r->is_rough, above, below, progress, from, seen));
    return swarf_parallel_for((size_t)(end - r->top), resolve_row, r, progress, seen, to);
}

static swarf_status sample(swarf_canvas *c, const uint8_t *is_rough, const swarf_progress *progress, double from,
                           double to)
{
    const size_t squares = (size_t)c->width * (size_t)c->height;
    const size_t each = (size_t)c->options->samples * (size_t)c->options->samples * sizeof(swarf_sight);
    size_t rough = 0;
    for (size_t i = 0; i < squares; i++) rough += is_rough[i];
    resolving r = {.canvas = c, .is_rough = is_rough};
    if (rough * each <= KEPT_BYTES_MAX) {
        if ((rough + c->detail->count) * each > KEPT_BYTES_MAX) swarf_detail_forget(c->detail);
        return sample_rows(&r, c->height, progress, from, to);
    }
    const double part = (to - from) / c->height;
    swarf_status status = SWARF_OK;
    for (; status == SWARF_OK && r.top < c->height; r.top += STRIP) {
        const int32_t end = r.top + STRIP < c->height ? r.top + STRIP : c->height;
        swarf_detail_forget(c->detail);
        status = sample_rows(&r, end, progress, from + part * r.top, from + part * end);
    }
    swarf_detail_forget(c->detail);
    return status;
}

swarf_status swarf_canvas_shade(swarf_canvas *c, const swarf_progress *progress, double from, double to)
{
    /* The parts of the progress by what they cost. */
    const int is_single = c->options->samples == 1;
    const double shaded = from + (to - from) * (is_single ? 0.5 : 0.1);
    const double marked = from + (to - from) * (is_single ? 0.9 : 0.2), judged = from + (to - from) * 0.25;
    const size_t rows = (size_t)c->height;
    SWARF_TRY(swarf_parallel_for(rows, shade_row, c, progress, from, shaded));
    if (c->options->edges && !c->mark) SWARF_TRY(swarf_canvas_edges(c, progress, shaded, marked));
    if (is_single) {
        if (c->mark) SWARF_TRY(swarf_parallel_for(rows, draw_row_edges, c, progress, marked, to));
        return swarf_progress_report(progress, to);
    }
    struct judging judging = {c, malloc(rows * (size_t)c->width)};
    if (!judging.is_rough) return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
    swarf_status status = swarf_parallel_for(rows, judge_row, &judging, progress, marked, judged);
    if (status == SWARF_OK) status = sample(c, judging.is_rough, progress, judged, to);
    free(judging.is_rough);
    return status;
}
