/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A surface that is simplified again after a part of it has changed, with what is known of the rest, becomes to the bit
 * what it becomes without a memo. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "mesh/facets.h"
#include "test.h"

/* The library's are not of its face. */
swarf_status swarf_parallel_for(size_t count, swarf_work_fn work, void *context, const swarf_progress *progress,
                                double from, double to)
{
    (void)progress, (void)from, (void)to;
    swarf_status status = SWARF_OK;
    for (size_t i = 0; i < count && status == SWARF_OK; i++) status = work(context, i);
    return status;
}

int swarf_parallel_slot(void)
{
    return 0;
}

/** Squares along an edge of the sheet; those of a block, which has the numbers of its vertices together. */
enum { SPAN = 192, BLOCK = 8, BLOCKS = SPAN / BLOCK };

static const double error_mm = 0.05;

/** Facets that have a corner this near to a dent may be others with it. */
static const double margin = 2;

/** A sheet of waves in squares of 1 mm. Near `dent` the waves are others, quarters of squares meet in a vertex of their
 * own, or vertices are to stay. */
typedef struct sheet {
    double dent[2], radius, depth;
    double out;    /* how far its first corner is drawn out, and with it the cubes that it is cut into */
    unsigned gone; /* a bit for each of the four quarters that is a hole instead */
    double error;  /* mm */
} sheet;

enum { ALL_GONE = 15, HALF_GONE = 3 };

typedef struct made {
    swarf_facets facets;
    uint8_t *marks;
} made;

static int is_within(const sheet *s, double x, double y, double about)
{
    return hypot(x - s->dent[0], y - s->dent[1]) < s->radius + about;
}

static double height_at(const sheet *s, double x, double y)
{
    const double wave = 3 * sin(x / 11) * cos(y / 17) + 0.3 * sin(x * y / 2000);
    const double in = hypot(x - s->dent[0], y - s->dent[1]) / s->radius;
    return in < 1 ? wave + s->depth * (1 - in * in) : wave;
}

static uint32_t put_vertex(made *m, const sheet *s, double x, double y)
{
    const size_t v = m->facets.vertex_count++;
    const double out = x + y > 0 ? 0 : s->out;
    const float at[3] = {(float)(x - out), (float)(y - out), (float)height_at(s, x, y)};
    memcpy(m->facets.xyz + 3 * v, at, sizeof at);
    m->marks[v] = is_within(s, x, y, margin) || hypot(x, y) < margin ? 0 : SWARF_VERTEX_KNOWN;
    if (is_within(s, x, y, -s->radius / 2)) m->marks[v] |= SWARF_VERTEX_LOCKED;
    return (uint32_t)v;
}

static void put_facet(made *m, uint32_t a, uint32_t b, uint32_t c)
{
    swarf_facet *facet = &m->facets.facet[m->facets.facet_count++];
    const float *p = m->facets.xyz + 3 * a, *q = m->facets.xyz + 3 * b, *r = m->facets.xyz + 3 * c;
    double n[3], u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)q[k] - (double)p[k];
        v[k] = (double)r[k] - (double)p[k];
    }
    for (int k = 0; k < 3; k++) n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    *facet = (swarf_facet){.v = {a, b, c}};
    for (int k = 0; k < 3; k++) facet->normal[k] = (int16_t)lrint(n[k] / length * 32767);
}

/** Block by block, the vertices of one after another, so that numbers change behind a block with others. */
static made make_sheet(const sheet *s)
{
    const size_t corners = (SPAN + 1) * (SPAN + 1), squares = SPAN * SPAN;
    made m = {.facets = {.xyz = malloc(3 * (corners + squares) * sizeof(float)),
                         .facet = malloc(4 * squares * sizeof(swarf_facet))},
              .marks = malloc(corners + squares)};
    uint32_t *number = malloc(corners * sizeof *number), *centre = malloc(squares * sizeof *centre);
    for (int b = 0; b < (BLOCKS + 1) * (BLOCKS + 1); b++)
        for (int i = 0; i < BLOCK * BLOCK; i++) {
            const int x = b / (BLOCKS + 1) * BLOCK + i / BLOCK, y = b % (BLOCKS + 1) * BLOCK + i % BLOCK;
            if (x > SPAN || y > SPAN) continue;
            number[x * (SPAN + 1) + y] = put_vertex(&m, s, x, y);
            if (x < SPAN && y < SPAN && is_within(s, x, y, 0))
                centre[x * SPAN + y] = put_vertex(&m, s, x + 0.5, y + 0.5);
        }
    for (int x = 0; x < SPAN; x++)
        for (int y = 0; y < SPAN; y++) {
            const uint32_t *low = &number[x * (SPAN + 1) + y], *high = low + SPAN + 1;
            const uint32_t ring[4] = {low[0], high[0], high[1], low[1]};
            if (is_within(s, x, y, 0)) {
                for (int k = 0; k < 4; k++)
                    if (!(s->gone >> k & 1)) put_facet(&m, ring[k], ring[(k + 1) % 4], centre[x * SPAN + y]);
            } else {
                put_facet(&m, ring[0], ring[1], ring[2]);
                put_facet(&m, ring[0], ring[2], ring[3]);
            }
        }
    free(number);
    free(centre);
    return m;
}

static void free_made(made *m)
{
    swarf_facets_free(&m->facets);
    free(m->marks);
}

static int is_same(const swarf_facets *a, const swarf_facets *b)
{
    return a->vertex_count == b->vertex_count && a->facet_count == b->facet_count &&
           memcmp(a->xyz, b->xyz, 3 * a->vertex_count * sizeof *a->xyz) == 0 &&
           memcmp(a->facet, b->facet, a->facet_count * sizeof *a->facet) == 0;
}

static swarf_status simplify(made *m, const sheet *s, swarf_facets_memo *memo)
{
    return swarf_facets_simplify(&m->facets, s->error, 1, 0, m->marks, memo, NULL, 0, 1);
}

/** Whether a sheet is the last one but for a hole, so that all that it has was there. */
static int is_less(const sheet *s, const sheet *last)
{
    return s->dent[0] == last->dent[0] && s->dent[1] == last->dent[1] && s->radius == last->radius &&
           s->depth == last->depth && s->out == last->out && s->error == last->error &&
           (s->gone & last->gone) == last->gone;
}

/** Known is what lies away from the dent that is there and from the one that was; beside a new hole all. */
static void mark_known(made *m, const sheet *s, const sheet *last)
{
    const int less = is_less(s, last);
    for (size_t v = 0; v < m->facets.vertex_count; v++) {
        const int beside = is_within(last, (double)m->facets.xyz[3 * v], (double)m->facets.xyz[3 * v + 1], margin);
        if (less)
            m->marks[v] |= SWARF_VERTEX_KNOWN;
        else if (beside)
            m->marks[v] &= (uint8_t)~SWARF_VERTEX_KNOWN;
    }
}

static void check_again(swarf_facets_memo *memo, const sheet *s, const sheet *last)
{
    made one = make_sheet(s), other = make_sheet(s);
    const size_t full = one.facets.facet_count;
    if (last) mark_known(&one, s, last);
    memo->same = last != NULL;
    CHECK_OK(simplify(&one, s, memo));
    CHECK_OK(simplify(&other, s, NULL));
    CHECK(other.facets.facet_count < full / 4 * (s->error < error_mm ? 3 : 2));
    CHECK(is_same(&one.facets, &other.facets));
    free_made(&one);
    free_made(&other);
}

/** Where a dent was there is a hole: facets have gone, and all that are left are known. */
static void check_hole(void)
{
    swarf_facets_memo memo = {0};
    const sheet dent = {.dent = {80, 80}, .radius = 5, .depth = 0.3, .error = error_mm};
    sheet hole = dent;
    hole.gone = ALL_GONE;
    check_again(&memo, &dent, NULL);
    check_again(&memo, &hole, &dent);
    check_again(&memo, &dent, &hole);
    swarf_facets_memo_free(&memo);
}

/** In the last cube there are the four quarters of one square, of which two are left, known and too few for any to go:
 * as many facets as became of the four. */
static void check_few(void)
{
    swarf_facets_memo memo = {0};
    const sheet four = {.dent = {SPAN - 1, SPAN - 1}, .radius = 0.5, .out = 1.5, .error = error_mm};
    sheet two = four;
    two.gone = HALF_GONE;
    check_again(&memo, &four, NULL);
    check_again(&memo, &two, &four);
    swarf_facets_memo_free(&memo);
}

/** With little error many vertices stay until the border beside them goes: what was settled there tells when they are
 * looked at. */
static void check_settled(test_random *random)
{
    swarf_facets_memo memo = {0};
    sheet last = {.dent = {100, 100}, .radius = 5, .depth = 0.1, .error = error_mm / 5};
    check_again(&memo, &last, NULL);
    for (int i = 0; i < 6; i++) {
        sheet next = last;
        for (int k = 0; k < 2; k++) next.dent[k] = test_random_in(random, 0, SPAN);
        check_again(&memo, &next, &last);
        last = next;
    }
    swarf_facets_memo_free(&memo);
}

int main(void)
{
    test_random random = test_random_begin(13);
    check_hole();
    check_few();
    check_settled(&random);
    swarf_facets_memo memo = {0};
    sheet last = {.dent = {50, 60}, .radius = 9, .depth = 1, .error = error_mm};
    check_again(&memo, &last, NULL);
    check_again(&memo, &last, &last);
    for (int i = 0; i < (test_size() == TEST_LIGHT ? 4 : 24); i++) {
        sheet next = {.out = last.out,
                      .error = error_mm,
                      .radius = test_random_in(&random, 1, 12),
                      .depth = test_random_in(&random, -0.5, 0.5)};
        for (int k = 0; k < 2; k++) next.dent[k] = test_random_in(&random, 0, SPAN);
        if (test_random_below(&random, 2)) { /* the same facets, elsewhere */
            next = last;
            next.depth = test_random_in(&random, -0.5, 0.5);
        }
        if (test_random_below(&random, 3) == 0) next.out = test_random_in(&random, 0, 8);
        check_again(&memo, &next, &last);
        last = next;
    }
    swarf_facets_memo_free(&memo);
    return test_end();
}
