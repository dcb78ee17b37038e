/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Two Fibonacci numbers in a row: points (i / COLUMNS, frac(i * TURN / COLUMNS)) are even along both axes and across.
 * Cells that moves are sorted into, along each axis. */
enum { COLUMNS = 832040, TURN = 514229, CELLS = 256 };

typedef struct span {
    double lo, hi;
} span;

typedef struct field {
    const swarf_box *block;
    const columns_cutter *cutter;
    const swarf_path *paths;
    size_t count;
    size_t *first; /* of each cell's moves, CELLS * CELLS + 1 */
    uint32_t *moves;
    span *spans; /* scratch, for all moves */
} field;

static int cell_of(const field *f, int axis, double x)
{
    const double at = (x - f->block->lo[axis]) / (f->block->hi[axis] - f->block->lo[axis]) * CELLS;
    return at < 0 ? 0 : at >= CELLS ? CELLS - 1 : (int)at;
}

/* Count the moves of each cell, or put them. */
static void sort_moves(field *f, int put)
{
    for (size_t i = 0; i < f->count; i++) {
        const swarf_path *p = &f->paths[i];
        int lo[2], hi[2];
        if (fmin(p->start[2], p->end[2]) >= f->block->hi[2]) continue;
        for (int k = 0; k < 2; k++) {
            lo[k] = cell_of(f, k, fmin(p->start[k], p->end[k]) - f->cutter->radius);
            hi[k] = cell_of(f, k, fmax(p->start[k], p->end[k]) + f->cutter->radius);
        }
        for (int x = lo[0]; x <= hi[0]; x++)
            for (int y = lo[1]; y <= hi[1]; y++) {
                size_t *end = &f->first[x * CELLS + y];
                if (put)
                    f->moves[--*end] = (uint32_t)i;
                else
                    ++*end;
            }
    }
}

/* The lowest that a ball gets over (x, y) while it is within reach: its middle is `along` from the start then, where it
 * passes, `beside` away, at best. The height of its lower side is convex in where it is, with one place that is level.
 */
static double lowest_of_ball(const field *f, const swarf_path *p, double length, double along, double square,
                             const double t[2])
{
    const double r = f->cutter->radius, rise = p->end[2] - p->start[2];
    const double slope = length > 0 ? rise / length : 0;
    const double level = along - slope * sqrt(fmax(0, square) / (1 + slope * slope));
    const double at = length > 0 ? fmin(fmax(level / length, t[0]), t[1]) : 0, off = at * length - along;
    return p->start[2] + at * rise + r - sqrt(fmax(0, square - off * off));
}

/* What a move takes out of the column at (x, y); 0: nothing. */
static int find_span(const field *f, const swarf_path *p, double x, double y, span *out)
{
    const double r = f->cutter->radius, rise = p->end[2] - p->start[2];
    const double d[2] = {p->end[0] - p->start[0], p->end[1] - p->start[1]};
    const double q[2] = {x - p->start[0], y - p->start[1]}, length = hypot(d[0], d[1]);
    const double along = length > 0 ? (q[0] * d[0] + q[1] * d[1]) / length : 0;
    const double square = r * r - (q[0] * q[0] + q[1] * q[1] - along * along);
    double t[2] = {0, 1};
    if (square <= 0) return 0;
    if (length > 0) {
        t[0] = fmax(0, (along - sqrt(square)) / length);
        t[1] = fmin(1, (along + sqrt(square)) / length);
        if (t[0] >= t[1]) return 0;
    }
    const double z[2] = {p->start[2] + t[0] * rise, p->start[2] + t[1] * rise};
    out->lo = f->cutter->ball ? lowest_of_ball(f, p, length, along, square, t) : fmin(z[0], z[1]);
    out->hi = fmin(fmax(z[0], z[1]) + f->cutter->length, f->block->hi[2]);
    out->lo = fmax(out->lo, f->block->lo[2]);
    return out->lo < out->hi;
}

static int by_low(const void *a, const void *b)
{
    const span *x = a, *y = b;
    return (x->lo > y->lo) - (x->lo < y->lo);
}

static double column_left(field *f, double x, double y)
{
    const size_t cell = (size_t)cell_of(f, 0, x) * CELLS + (size_t)cell_of(f, 1, y);
    size_t count = 0;
    double left = f->block->hi[2] - f->block->lo[2], end = f->block->lo[2];
    for (size_t i = f->first[cell]; i < f->first[cell + 1]; i++)
        count += (size_t)find_span(f, &f->paths[f->moves[i]], x, y, &f->spans[count]);
    qsort(f->spans, count, sizeof *f->spans, by_low);
    for (size_t i = 0; i < count; i++) {
        const double from = fmax(f->spans[i].lo, end);
        if (f->spans[i].hi <= from) continue;
        left -= f->spans[i].hi - from;
        end = f->spans[i].hi;
    }
    return left;
}

double columns_left(const swarf_box *block, const columns_cutter *cutter, const swarf_path *paths, size_t count)
{
    field f = {.block = block, .cutter = cutter, .paths = paths, .count = count};
    const double size[2] = {block->hi[0] - block->lo[0], block->hi[1] - block->lo[1]};
    double sum = 0;
    f.first = calloc(CELLS * CELLS + 1, sizeof *f.first);
    f.spans = malloc((count + 1) * sizeof *f.spans);
    if (!f.first || !f.spans) exit(2);
    sort_moves(&f, 0);
    for (int i = 0; i < CELLS * CELLS; i++) f.first[i + 1] += f.first[i];
    f.moves = malloc((f.first[CELLS * CELLS] + 1) * sizeof *f.moves);
    if (!f.moves) exit(2);
    sort_moves(&f, 1); /* the ends become the begins */
    for (uint64_t i = 0; i < COLUMNS; i++) {
        const double x = ((double)i + 0.5) / COLUMNS, y = ((double)(i * TURN % COLUMNS) + 0.5) / COLUMNS;
        sum += column_left(&f, block->lo[0] + x * size[0], block->lo[1] + y * size[1]);
    }
    free(f.first);
    free(f.moves);
    free(f.spans);
    return sum / COLUMNS * size[0] * size[1];
}
