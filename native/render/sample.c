/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Shading the squares of a picture, with n x n samples for those that are rough: where a square and its eight
 * neighbours do not see one smooth face, and it shows: by a line, or by colours that differ.
 *
 * Strips of 64 rows one after the other, on all cores each. A strip keeps the samples of its rough squares and of two
 * rows on either side, for a sample is on an edge when half a square away something else is seen that goes on beyond:
 *
 *   number   per square of the strip: of its samples, -1: smooth, its middle stands for all of it
 *   sample   n * n sights per rough square
 */
#include "base/parallel.h"
#include "base/status.h"
#include "render/edges.h"
#include "render/picture.h"
#include "render/refine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of three samples, the last of a row looks four further, into the second row; of two or four into the next one. */
enum { STRIP = 64, MARGIN = 2 };

/* One face: neighbours' normals differ by at most 2.5 degrees, and each lies in the plane of the other to 1 in 20 of
 * their distance, so that steps of more than 1/20 pixel show. Larger values save rays and leave jagged edges. */
static const float same_face_cosine = 0.999f, same_face_slope = 0.05f;

/* Colours that differ by less than this part of white, as they are shown, make no jagged edge that one could see. */
static const float same_colour = 4.0f / 255;

typedef struct strip {
    swarf_canvas *canvas;
    const uint8_t *is_rough; /* per square of the canvas */
    int32_t top, rows;       /* with those of the margin on either side where there are any */
    int32_t own, end;        /* rows of the canvas whose colours are this strip's */
    int32_t *number;
    size_t *count; /* rough squares of a row, then those of the rows before it */
    size_t *rough; /* squares of the canvas */
    swarf_sight *sample;
    size_t rough_count;
} strip;

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

static int is_rough(const swarf_canvas *c, int32_t x0, int32_t y0)
{
    const size_t own = swarf_canvas_at(c, x0, y0);
    for (int32_t y = y0 - 1; y <= y0 + 1; y++)
        for (int32_t x = x0 - 1; x <= x0 + 1; x++) {
            if (x < 0 || y < 0 || x >= c->width || y >= c->height) continue;
            const size_t other = swarf_canvas_at(c, x, y);
            if (c->middle[own].move == c->middle[other].move && is_same_face(&c->middle[own], &c->middle[other]))
                continue;
            if (c->middle[own].seen != c->middle[other].seen || (c->edge && (c->edge[own] || c->edge[other])) ||
                !is_same_colour(c->colour[own], c->colour[other]))
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
    return fmaxf(edge * (float)c->room[square] / 255, outline);
}

/** Edges of a row of squares that have one ray each. */
static swarf_status draw_row_edges(void *context, size_t row)
{
    const swarf_canvas *c = context;
    for (size_t at = row * (size_t)c->width; at < (row + 1) * (size_t)c->width; at++)
        if (c->edge[at])
            swarf_edge_draw(c->colour[at], line_of(c, at, (float)c->edge[at] / 255, (float)c->outline[at] / 255));
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

/** Count the rough squares of a row. */
static swarf_status count_row(void *context, size_t row)
{
    const strip *s = context;
    const size_t width = (size_t)s->canvas->width;
    const uint8_t *own = s->is_rough + ((size_t)s->top + row) * width;
    size_t rough = 0;
    for (size_t x = 0; x < width; x++) s->number[row * width + x] = own[x] ? (int32_t)rough++ : -1;
    s->count[row + 1] = rough;
    return SWARF_OK;
}

static swarf_status list_row(void *context, size_t row)
{
    const strip *s = context;
    const size_t width = (size_t)s->canvas->width;
    for (size_t x = 0; x < width; x++) {
        int32_t *number = &s->number[row * width + x];
        if (*number < 0) continue;
        *number += (int32_t)s->count[row];
        s->rough[*number] = ((size_t)s->top + row) * width + x;
    }
    return SWARF_OK;
}

/* Rough squares that one piece of work samples: some 0.1 ms. */
enum { PIECE = 64 };

/** Where sample `index` of the strip lies. That in the middle of its square has been seen before. */
static int place_of_sample(const void *context, size_t index, double place[2])
{
    const strip *s = context;
    const swarf_canvas *c = s->canvas;
    const int32_t n = c->options->samples, sub = (int32_t)(index % (size_t)(n * n)), row = sub / n;
    const int is_new = 2 * sub + 1 != n * n;
    if (!place) return is_new;
    const size_t square = s->rough[index / (size_t)(n * n)];
    place[0] = swarf_canvas_x(c, (int32_t)(square % (size_t)c->width), (sub % n + 0.5) / n);
    place[1] = swarf_canvas_y(c, (int32_t)(square / (size_t)c->width), (row + 0.5) / n);
    return is_new;
}

/** Send the rays of some squares, one after the other in full packets. */
static swarf_status sample_some(void *context, size_t index)
{
    const strip *s = context;
    const size_t each = (size_t)s->canvas->options->samples * (size_t)s->canvas->options->samples;
    const size_t last = (index + 1) * PIECE < s->rough_count ? (index + 1) * PIECE : s->rough_count;
    for (size_t sample = index * PIECE * each; sample < last * each;) {
        swarf_places places[SWARF_GROUP] = {{.count = 0}};
        swarf_sight *out[SWARF_GROUP];
        int count = 0;
        for (; count < SWARF_GROUP && sample < last * each; count++) {
            swarf_places *const own = &places[count];
            out[count] = s->sample + sample;
            for (; own->count < SWARF_PACKET && sample < last * each; own->count++, sample++) {
                double place[2];
                (void)place_of_sample(s, sample, place);
                own->x[own->count] = place[0];
                own->y[own->count] = place[1];
            }
        }
        swarf_look_through(&s->canvas->look, places, count, out);
    }
    for (size_t number = index * PIECE; each % 2 && number < last; number++)
        s->sample[number * each + each / 2] = s->canvas->middle[s->rough[number]];
    return SWARF_OK;
}

/** The sight of sample (i, j), counted over the whole strip; NULL beyond it. */
static const swarf_sight *sight_at(const strip *s, int32_t i, int32_t j)
{
    const swarf_canvas *c = s->canvas;
    const int32_t n = c->options->samples;
    if (i < 0 || j < 0 || i >= n * c->width || j >= n * s->rows) return NULL;
    const int32_t x = i / n, y = j / n, number = s->number[(size_t)y * (size_t)c->width + (size_t)x];
    if (number < 0) return &c->middle[swarf_canvas_at(c, x, s->top + y)];
    return &s->sample[(size_t)number * (size_t)(n * n) + (size_t)(j % n * n + i % n)];
}

/** How dark the line is at a sample of square `square`. */
static float line_at(const strip *s, size_t square, const swarf_sight *own, int32_t i, int32_t j)
{
    static const int32_t steps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    const int32_t reach = (s->canvas->options->samples + 1) / 2; /* half a square, rounded up */
    float edge = 0, height = 0;
    for (int step = 0; step < (reach > 1 ? 8 : 4) && height < INFINITY; step++) {
        const int32_t di = reach * steps[step][0], dj = reach * steps[step][1];
        const swarf_sight *other = sight_at(s, i + di, j + dj);
        if (!other) continue;
        height = fmaxf(height, swarf_edge_height(&s->canvas->look, own, other));
        const float crease = swarf_edge_crease(own, other);
        if (crease > edge)
            edge = fmaxf(edge,
                         swarf_edge_beyond(crease, sight_at(s, i - di, j - dj), sight_at(s, i + 2 * di, j + 2 * dj)));
    }
    return line_of(s->canvas, square, fmaxf(edge, swarf_edge_step(height)), swarf_edge_outline(height));
}

static swarf_status resolve_some(void *context, size_t index)
{
    const strip *s = context;
    const swarf_canvas *c = s->canvas;
    const int32_t n = c->options->samples;
    for (size_t number = index * PIECE; number < (index + 1) * PIECE && number < s->rough_count; number++) {
        const int32_t x = (int32_t)(s->rough[number] % (size_t)c->width);
        const int32_t y = (int32_t)(s->rough[number] / (size_t)c->width);
        float *sum = c->colour[s->rough[number]];
        if (y < s->own || y >= s->end) continue;
        const swarf_sight *sample = &s->sample[number * (size_t)(n * n)];
        swarf_spot spots[SWARF_PACKET];
        float one[SWARF_PACKET][4];
        for (int32_t sub = 0; sub < n * n; sub++) {
            const int32_t sub_row = sub / n;
            spots[sub] = spot_of(c, x, y, (sub_row + 0.5) / n, &sample[sub]);
        }
        swarf_shade(&c->shading, spots, n * n, one);
        memset(sum, 0, sizeof *c->colour);
        for (int32_t sub = 0; sub < n * n; sub++) {
            const int32_t i = n * x + sub % n, j = n * (y - s->top) + sub / n;
            const float line = c->edge ? line_at(s, s->rough[number], &sample[sub], i, j) : 0;
            if (line > 0) swarf_edge_draw(one[sub], line);
            for (int channel = 0; channel < 4; channel++) sum[channel] += one[sub][channel] / (float)(n * n);
        }
    }
    return SWARF_OK;
}

static swarf_status shade_strip(strip *s)
{
    const size_t rows = (size_t)s->rows, side = (size_t)s->canvas->options->samples, samples = side * side;
    s->count[0] = 0;
    SWARF_TRY(swarf_parallel_for(rows, count_row, s, NULL, 0, 1));
    for (size_t row = 0; row < rows; row++) s->count[row + 1] += s->count[row];
    s->rough_count = s->count[rows];
    if (s->rough_count == 0) return SWARF_OK;
    s->rough = malloc(s->rough_count * sizeof *s->rough);
    s->sample = malloc(s->rough_count * samples * sizeof *s->sample);
    if (!s->rough || !s->sample) return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory for samples");
    const size_t pieces = (s->rough_count + PIECE - 1) / PIECE;
    SWARF_TRY(swarf_parallel_for(rows, list_row, s, NULL, 0, 1));
    SWARF_TRY(swarf_parallel_for(pieces, sample_some, s, NULL, 0, 1));
    if (s->canvas->options->exact)
        SWARF_TRY(
            swarf_look_refine(&s->canvas->look, s->sample, s->rough_count * samples, place_of_sample, s, NULL, 0, 1));
    return swarf_parallel_for(pieces, resolve_some, s, NULL, 0, 1);
}

static swarf_status sample_strips(swarf_canvas *c, const uint8_t *is_rough, const swarf_progress *progress, double from,
                                  double to)
{
    strip s = {.canvas = c, .is_rough = is_rough};
    s.number = malloc((size_t)(STRIP + 2 * MARGIN) * (size_t)c->width * sizeof *s.number);
    s.count = malloc((STRIP + 2 * MARGIN + 1) * sizeof *s.count);
    swarf_status status = s.number && s.count ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
    for (int32_t y = 0; status == SWARF_OK && y < c->height; y += STRIP) {
        s.own = y;
        s.end = y + STRIP < c->height ? y + STRIP : c->height;
        s.top = y > MARGIN ? y - MARGIN : 0;
        s.rows = (s.end + MARGIN < c->height ? s.end + MARGIN : c->height) - s.top;
        status = shade_strip(&s);
        free(s.rough);
        free(s.sample);
        s.rough = NULL;
        s.sample = NULL;
        if (status == SWARF_OK) status = swarf_progress_report(progress, from + (to - from) * s.end / c->height);
    }
    free(s.number);
    free(s.count);
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
    if (c->options->edges) SWARF_TRY(swarf_canvas_edges(c, progress, shaded, marked));
    if (is_single) {
        if (c->edge) SWARF_TRY(swarf_parallel_for(rows, draw_row_edges, c, progress, marked, to));
        return swarf_progress_report(progress, to);
    }
    struct judging judging = {c, malloc(rows * (size_t)c->width)};
    if (!judging.is_rough) return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
    swarf_status status = swarf_parallel_for(rows, judge_row, &judging, progress, marked, judged);
    if (status == SWARF_OK) status = sample_strips(c, judging.is_rough, progress, judged, to);
    free(judging.is_rough);
    return status;
}
