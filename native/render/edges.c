/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Lines where faces meet or one hides the other.
 *
 * A line is as dark as there is room for it: where lines crowd, as on the steps of a relief, each is lighter, and the
 * faces between them are what is seen. So every square knows how many lines there are about it.
 */
#include "render/edges.h"

#include "base/parallel.h"
#include "base/status.h"

#include <math.h>
#include <stdlib.h>

static const float edge_colour[3] = {0.012f, 0.015f, 0.022f};
static const float edge_strength = 0.8f;

/* Lines are counted within the square of which this many make the height of the picture: 1 / 45 is 16 pixels of 720,
 * about which lines begin to make a tone of their own. */
enum { WINDOWS = 45 };
/* Lines across a window that keep their strength; and what a line keeps at least, so that an engraving still shows. */
static const float lines_calm = 1.8f, room_least = 0.2f;

void swarf_edge_draw(float colour[4], float strength)
{
    const float part = edge_strength * strength;
    for (int channel = 0; channel < 3; channel++)
        colour[channel] = (1 - part) * colour[channel] + part * edge_colour[channel];
    colour[3] = (1 - part) * colour[3] + part;
}

/** The sight of a square; NULL beyond the picture. */
static const swarf_sight *middle_at(const swarf_canvas *c, int32_t x, int32_t y)
{
    return x >= 0 && y >= 0 && x < c->width && y < c->height ? &c->middle[swarf_canvas_at(c, x, y)] : NULL;
}

/** Edges of the middles of a row. A crease belongs to the square before it: a line is one square wide. */
static swarf_status mark_row(void *context, size_t row)
{
    static const int32_t steps[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    swarf_canvas *c = context;
    const int32_t y = (int32_t)row;
    for (int32_t x = 0; x < c->width; x++) {
        const swarf_sight *own = middle_at(c, x, y);
        const float footprint = (float)swarf_look_footprint(&c->look, own);
        float edge = 0, height = 0;
        for (int step = 0; step < 4; step++) {
            const int32_t dx = steps[step][0], dy = steps[step][1];
            const swarf_sight *other = middle_at(c, x + dx, y + dy);
            if (!other) continue;
            height = fmaxf(height, swarf_edge_height(footprint, own, other));
            const float crease = step < 2 ? swarf_edge_crease(own, other) : 0;
            if (crease > edge)
                edge = fmaxf(edge, swarf_edge_beyond(crease, middle_at(c, x - dx, y - dy),
                                                     middle_at(c, x + 2 * dx, y + 2 * dy)));
        }
        swarf_line_mark *const mark = &c->mark[swarf_canvas_at(c, x, y)];
        mark->edge = (uint8_t)(255 * fmaxf(edge, swarf_edge_step(height)) + 0.5f);
        mark->outline = (uint8_t)(255 * swarf_edge_outline(height) + 0.5f);
    }
    return SWARF_OK;
}

struct counting {
    swarf_canvas *canvas;
    int32_t reach;
    uint32_t *across; /* per square: sum of the edges in its row, within the reach */
};

static swarf_status count_across(void *context, size_t row)
{
    const struct counting *counting = context;
    const int32_t width = counting->canvas->width, reach = counting->reach;
    const swarf_line_mark *mark = counting->canvas->mark + row * (size_t)width;
    uint32_t *out = counting->across + row * (size_t)width, sum = 0;
    for (int32_t x = 0; x < reach && x < width; x++) sum += mark[x].edge;
    for (int32_t x = 0; x < width; x++) {
        if (x + reach < width) sum += mark[x + reach].edge;
        out[x] = sum;
        if (x >= reach) sum -= mark[x - reach].edge;
    }
    return SWARF_OK;
}

/** Room there is in a row. One line across the window is as many squares as its edge is long. */
static swarf_status find_room(void *context, size_t row)
{
    const struct counting *counting = context;
    const swarf_canvas *c = counting->canvas;
    const size_t width = (size_t)c->width;
    const int32_t y = (int32_t)row, reach = counting->reach;
    const int32_t top = y > reach ? y - reach : 0, end = y + reach < c->height ? y + reach + 1 : c->height;
    const float calm = lines_calm * 255 * (float)(2 * reach + 1);
    swarf_line_mark *mark = c->mark + row * width;
    for (size_t x = 0; x < width; x++) {
        uint32_t sum = 0;
        for (int32_t j = top; j < end; j++) sum += counting->across[(size_t)j * width + x];
        const float part = (float)sum > calm ? calm / (float)sum : 1;
        mark[x].room = (uint8_t)(255 * fmaxf(part * part, room_least) + 0.5f);
    }
    return SWARF_OK;
}

swarf_status swarf_canvas_edges(swarf_canvas *c, const swarf_progress *progress, double from, double to)
{
    const double third = (to - from) / 3;
    const size_t rows = (size_t)c->height, squares = rows * (size_t)c->width;
    struct counting counting = {c, c->height / (2 * WINDOWS) + 1, malloc(squares * sizeof *counting.across)};
    c->mark = malloc(squares * sizeof *c->mark);
    swarf_status status =
        counting.across && c->mark ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory for edges");
    if (status == SWARF_OK) status = swarf_parallel_for(rows, mark_row, c, progress, from, from + third);
    if (status == SWARF_OK)
        status = swarf_parallel_for(rows, count_across, &counting, progress, from + third, to - third);
    if (status == SWARF_OK) status = swarf_parallel_for(rows, find_room, &counting, progress, to - third, to);
    free(counting.across);
    if (status == SWARF_OK) return SWARF_OK;
    free(c->mark);
    c->mark = NULL;
    return status;
}
