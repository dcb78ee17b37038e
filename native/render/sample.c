/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Shading the squares of a picture, with n x n samples for those that are rough: where a square and its eight
 * neighbours do not see one smooth face.
 *
 * Strips of 64 rows one after the other, on all cores each. A strip keeps the samples of its rough squares and of the
 * row on either side, for a sample is on an edge when half a square away something else is seen:
 *
 *   number   per square of the strip: of its samples, -1: smooth, its middle stands for all of it
 *   sample   n * n sights per rough square, a packet each
 */
#include "base/parallel.h"
#include "base/status.h"
#include "render/picture.h"
#include "render/refine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STRIP = 64 };

/* One face: neighbours' normals differ by at most 2.5 degrees, and each lies in the plane of the other to 1 in 20 of
 * their distance, so that steps of more than 1/20 pixel show. Larger values save rays and leave jagged edges. */
static const float same_face_cosine = 0.999f, same_face_slope = 0.05f;

/* An edge is drawn from 18 degrees on, in full from 40: the facets that a tool leaves on curved surfaces are not. */
static const float edge_cosine_least = 0.951f, edge_cosine_full = 0.766f;
/* One thing hides another when it stands this many squares before it: from, and in full. */
static const float step_least = 0.9f, step_full = 2.0f;
static const float edge_colour[3] = {0.012f, 0.015f, 0.022f};
static const float edge_strength = 0.8f;

typedef struct strip {
    swarf_canvas *canvas;
    int32_t top, rows; /* with a row more on either side where there is one */
    int32_t own, end;  /* rows of the canvas whose colours are this strip's */
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

static int is_rough(const swarf_canvas *c, int32_t x0, int32_t y0)
{
    const swarf_sight *own = &c->middle[swarf_canvas_at(c, x0, y0)];
    for (int32_t y = y0 - 1; y <= y0 + 1; y++)
        for (int32_t x = x0 - 1; x <= x0 + 1; x++)
            if (x >= 0 && y >= 0 && x < c->width && y < c->height &&
                !is_same_face(own, &c->middle[swarf_canvas_at(c, x, y)]))
                return 1;
    return 0;
}

static float smooth_step(float from, float to, float x)
{
    const float part = (x - from) / (to - from), t = part > 0 ? (part < 1 ? part : 1) : 0;
    return t * t * (3 - 2 * t);
}

/** How much of an edge there is at `a` towards `b`. Where one hides the other it belongs to the nearer. */
static float edge_between(const swarf_look *look, const swarf_sight *a, const swarf_sight *b, int creases)
{
    if (a->seen == SWARF_SEEN_NOTHING) return 0;
    if (a->seen != b->seen) return a->distance <= b->distance;
    float cosine = 0, off_a = 0, off_b = 0;
    for (int axis = 0; axis < 3; axis++) {
        const float step = b->point[axis] - a->point[axis];
        cosine += a->normal[axis] * b->normal[axis];
        off_a += step * a->normal[axis];
        off_b += step * b->normal[axis];
    }
    const float crease = creases ? smooth_step(edge_cosine_least, edge_cosine_full, cosine) : 0;
    if (a->distance > b->distance) return crease;
    const float off = fabsf(off_a) < fabsf(off_b) ? fabsf(off_a) : fabsf(off_b);
    const float step = smooth_step(step_least, step_full, off / (float)swarf_look_footprint(look, a));
    return crease > step ? crease : step;
}

static void draw_edge(float colour[4], float strength)
{
    const float part = edge_strength * strength;
    for (int channel = 0; channel < 3; channel++)
        colour[channel] = (1 - part) * colour[channel] + part * edge_colour[channel];
    colour[3] = (1 - part) * colour[3] + part;
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

/** Shade the middles of the squares of row y that are smooth. */
static void shade_smooth(const strip *s, size_t row, int32_t y)
{
    const swarf_canvas *c = s->canvas;
    const int32_t *number = s->number + row * (size_t)c->width;
    swarf_spot spots[SWARF_PACKET];
    int32_t place[SWARF_PACKET];
    float colour[SWARF_PACKET][4];
    int count = 0;
    for (int32_t x = 0; x < c->width; x++) {
        if (number[x] < 0) {
            spots[count] = spot_of(c, x, y, 0.5, &c->middle[swarf_canvas_at(c, x, y)]);
            place[count++] = x;
        }
        if (count < SWARF_PACKET && x + 1 < c->width) continue;
        swarf_shade(&c->shading, spots, count, colour);
        for (int i = 0; i < count; i++) memcpy(c->colour[swarf_canvas_at(c, place[i], y)], colour[i], sizeof colour[i]);
        count = 0;
    }
}

/** Edges of a row of squares that have one ray each. Creases on one side only: a line is one square wide. */
static void draw_row_edges(const swarf_canvas *c, int32_t y)
{
    for (int32_t x = 0; x < c->width; x++) {
        const swarf_sight *own = &c->middle[swarf_canvas_at(c, x, y)];
        float edge = x + 1 < c->width ? edge_between(&c->look, own, own + 1, 1) : 0;
        if (y + 1 < c->height) edge = fmaxf(edge, edge_between(&c->look, own, own + c->width, 1));
        if (x > 0) edge = fmaxf(edge, edge_between(&c->look, own, own - 1, 0));
        if (y > 0) edge = fmaxf(edge, edge_between(&c->look, own, own - c->width, 0));
        if (edge > 0) draw_edge(c->colour[swarf_canvas_at(c, x, y)], edge);
    }
}

/** Shade the middles of a row, and count the rough squares in it. */
static swarf_status shade_row(void *context, size_t row)
{
    const strip *s = context;
    const swarf_canvas *c = s->canvas;
    const int32_t y = s->top + (int32_t)row, one_ray = c->options->samples == 1;
    size_t rough = 0;
    for (int32_t x = 0; x < c->width; x++)
        s->number[row * (size_t)c->width + (size_t)x] = !one_ray && is_rough(c, x, y) ? (int32_t)rough++ : -1;
    if (y >= s->own && y < s->end) {
        shade_smooth(s, row, y);
        if (one_ray && c->options->edges) draw_row_edges(c, y);
    }
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

static swarf_status sample_some(void *context, size_t index)
{
    const strip *s = context;
    const swarf_canvas *c = s->canvas;
    const int32_t n = c->options->samples;
    const size_t end = (index + 1) * PIECE < s->rough_count ? (index + 1) * PIECE : s->rough_count;
    for (size_t number = index * PIECE; number < end;) {
        swarf_places places[SWARF_GROUP] = {{.count = 0}};
        swarf_sight *out[SWARF_GROUP];
        int count = 0;
        for (; count < SWARF_GROUP && number < end; count++, number++) {
            const int32_t x = (int32_t)(s->rough[number] % (size_t)c->width);
            const int32_t y = (int32_t)(s->rough[number] / (size_t)c->width);
            for (int32_t sub = 0; sub < n * n; sub++) {
                const int32_t row = sub / n;
                places[count].x[sub] = swarf_canvas_x(c, x, (sub % n + 0.5) / n);
                places[count].y[sub] = swarf_canvas_y(c, y, (row + 0.5) / n);
            }
            places[count].count = (unsigned)(n * n);
            out[count] = s->sample + number * (size_t)(n * n);
        }
        swarf_look_through(&c->look, places, count, out);
    }
    return SWARF_OK;
}

/** Where sample `index` of the strip lies. */
static void place_of_sample(const void *context, size_t index, double place[2])
{
    const strip *s = context;
    const swarf_canvas *c = s->canvas;
    const int32_t n = c->options->samples, sub = (int32_t)(index % (size_t)(n * n));
    const size_t square = s->rough[index / (size_t)(n * n)];
    place[0] = swarf_canvas_x(c, (int32_t)(square % (size_t)c->width), (sub % n + 0.5) / n);
    const int32_t row = sub / n;
    place[1] = swarf_canvas_y(c, (int32_t)(square / (size_t)c->width), (row + 0.5) / n);
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

static float edge_at(const strip *s, const swarf_sight *own, int32_t i, int32_t j)
{
    static const int8_t steps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    const int32_t reach = (s->canvas->options->samples + 1) / 2; /* half a square, rounded up */
    float edge = 0;
    for (int step = 0; step < (reach > 1 ? 8 : 4) && edge < 1; step++) {
        const swarf_sight *other = sight_at(s, i + reach * steps[step][0], j + reach * steps[step][1]);
        if (other) edge = fmaxf(edge, edge_between(&s->canvas->look, own, other, 1));
    }
    return edge;
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
            const float edge = c->options->edges ? edge_at(s, &sample[sub], i, j) : 0;
            if (edge > 0) draw_edge(one[sub], edge);
            for (int channel = 0; channel < 4; channel++) sum[channel] += one[sub][channel] / (float)(n * n);
        }
    }
    return SWARF_OK;
}

static swarf_status shade_strip(strip *s)
{
    const size_t rows = (size_t)s->rows, side = (size_t)s->canvas->options->samples, samples = side * side;
    s->count[0] = 0;
    SWARF_TRY(swarf_parallel_for(rows, shade_row, s, NULL, 0, 1));
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

swarf_status swarf_canvas_shade(swarf_canvas *c, const swarf_progress *progress, double from, double to)
{
    strip s = {.canvas = c};
    s.number = malloc((size_t)(STRIP + 2) * (size_t)c->width * sizeof *s.number);
    s.count = malloc((STRIP + 3) * sizeof *s.count);
    swarf_status status = s.number && s.count ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
    for (int32_t y = 0; status == SWARF_OK && y < c->height; y += STRIP) {
        s.own = y;
        s.end = y + STRIP < c->height ? y + STRIP : c->height;
        s.top = y > 0 ? y - 1 : 0;
        s.rows = (s.end < c->height ? s.end + 1 : s.end) - s.top;
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
