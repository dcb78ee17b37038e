/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Squares that are new are listed, their rays sent in full packets one after the other, and moved onto the exact
 * surface; only then they are known. The sight in the middle of a square, which an odd number of them has, is that of
 * the canvas. */
#include "render/detail.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "render/picture.h"
#include "render/refine.h"

#include <stdlib.h>
#include <string.h>

/* Squares that one piece of work samples: some 0.1 ms. */
enum { PIECE = 64 };

/* A sample that is closer to the exact surface than this part of a square knows what it is on. Next to an edge it may
 * be wrong; an edge that is off by so little changes colours by a few parts of 256 where black meets white. */
static const double close_enough = 1.0 / 32;

/* What tracing costs, and the rest what moving onto the exact surface costs. */
static const double traced = 0.35;

typedef struct adding {
    const swarf_canvas *canvas;
    int32_t side;
    const size_t *square; /* the new ones */
    size_t count;
    swarf_sight *sight; /* theirs */
} adding;

/** Whether sample `sub` is the middle of its square. */
static int is_middle(int32_t side, int32_t sub)
{
    return 2 * sub + 1 == side * side;
}

/** Where sample `index` lies. */
static int place_of_sample(const void *context, size_t index, double place[2])
{
    const adding *a = context;
    const swarf_canvas *c = a->canvas;
    const uint32_t side = (uint32_t)a->side, each = side * side;
    const uint32_t sub = (uint32_t)(index % each), row = sub / side;
    const int is_new = !is_middle(a->side, (int32_t)sub);
    if (!place) return is_new;
    const size_t square = a->square[index / each], width = (size_t)c->width;
    place[0] = swarf_canvas_x(c, (int32_t)(square % width), (sub % side + 0.5) / side);
    place[1] = swarf_canvas_y(c, (int32_t)(square / width), (row + 0.5) / side);
    return is_new;
}

static swarf_status sample_some(void *context, size_t piece)
{
    const adding *a = context;
    const size_t each = (size_t)a->side * (size_t)a->side, end = (piece + 1) * PIECE;
    const size_t last = (end < a->count ? end : a->count) * each;
    for (size_t sample = piece * PIECE * each; sample < last;) {
        swarf_places places[SWARF_GROUP] = {{.count = 0}};
        swarf_sight seen[SWARF_GROUP][SWARF_PACKET], *out[SWARF_GROUP];
        size_t own[SWARF_GROUP][SWARF_PACKET];
        int count = 0;
        for (; count < SWARF_GROUP && sample < last; count++) {
            swarf_places *const p = &places[count];
            out[count] = seen[count];
            for (; p->count < SWARF_PACKET && sample < last; sample++) {
                double place[2];
                if (!place_of_sample(a, sample, place)) {
                    a->sight[sample] = a->canvas->middle[a->square[sample / each]];
                    continue;
                }
                p->x[p->count] = place[0];
                p->y[p->count] = place[1];
                own[count][p->count++] = sample;
            }
        }
        swarf_look_through(&a->canvas->look, places, count, out);
        for (int i = 0; i < count; i++)
            for (unsigned ray = 0; ray < places[i].count; ray++) a->sight[own[i][ray]] = seen[i][ray];
    }
    return SWARF_OK;
}

/** With the new squares listed and room for their sights. */
static swarf_status look(adding *a, const swarf_progress *progress, double from, double to)
{
    const swarf_canvas *c = a->canvas;
    const size_t each = (size_t)a->side * (size_t)a->side;
    const int is_exact = c->options->exact && swarf_scene_surface(c->look.scene);
    const double middle = is_exact ? from + traced * (to - from) : to;
    SWARF_TRY(swarf_parallel_for((a->count + PIECE - 1) / PIECE, sample_some, a, progress, from, middle));
    if (!is_exact) return SWARF_OK;
    const swarf_sights sights = {a->sight, a->count * each, close_enough, place_of_sample, a};
    return swarf_look_refine(&c->look, &sights, progress, middle, to);
}

/** Begin with these squares and `side` sights along an edge of each. */
static swarf_status begin(swarf_detail *detail, size_t first, size_t squares, int32_t side)
{
    if (detail->side == side && detail->first == first && detail->squares == squares) return SWARF_OK;
    swarf_detail_forget(detail);
    detail->slot = malloc(squares * sizeof *detail->slot);
    if (!detail->slot) return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory");
    for (size_t i = 0; i < squares; i++) detail->slot[i] = -1;
    detail->first = first;
    detail->squares = squares;
    detail->side = side;
    return SWARF_OK;
}

swarf_status swarf_detail_add(swarf_detail *detail, const swarf_canvas *canvas, const uint8_t *is_marked, int32_t top,
                              int32_t end, const swarf_progress *progress, double from, double to)
{
    const size_t first = swarf_canvas_at(canvas, 0, top), last = swarf_canvas_at(canvas, 0, end);
    const int32_t side = canvas->options->samples;
    const size_t each = (size_t)side * (size_t)side;
    SWARF_TRY(begin(detail, first, last - first, side));
    adding a = {.canvas = canvas, .side = side};
    int32_t *const slot = detail->slot;
    for (size_t i = first; i < last; i++) a.count += is_marked[i] && slot[i - first] < 0;
    if (a.count == 0) return SWARF_OK;
    SWARF_TRY(swarf_array_reserve((void **)&detail->sight, &detail->room, detail->count + a.count,
                                  each * sizeof *detail->sight));
    size_t *const squares = malloc(a.count * sizeof *squares);
    if (!squares) return swarf_fail(SWARF_ERROR_MEMORY, "picture: out of memory for samples");
    size_t listed = 0;
    for (size_t i = first; i < last; i++)
        if (is_marked[i] && slot[i - first] < 0) squares[listed++] = i;
    a.square = squares;
    a.sight = detail->sight + detail->count * each;
    const swarf_status status = look(&a, progress, from, to);
    for (size_t i = 0; status == SWARF_OK && i < a.count; i++) slot[squares[i] - first] = (int32_t)(detail->count + i);
    if (status == SWARF_OK) detail->count += a.count;
    free(squares);
    return status;
}

const swarf_sight *swarf_detail_of(const swarf_detail *detail, size_t square)
{
    return detail->sight + (size_t)detail->slot[square - detail->first] * (size_t)detail->side * (size_t)detail->side;
}

void swarf_detail_forget(swarf_detail *detail)
{
    free(detail->slot);
    free(detail->sight);
    *detail = (swarf_detail){.side = 0};
}
