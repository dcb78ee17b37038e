/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What matters within a small box: gathered once, then looked at from many points in it.
 *
 * Each trace is looked at from the middle of the box; `raw` there, less the way to a point, bounds what that point
 * sees. What cannot have a zero in the box, or lies behind another trace everywhere, is left out. The
 * rest is ordered by raw, so that a point stops looking as soon as nothing nearer can come; where raw is the least of a
 * few convex functions, their tangents in the middle tell of most traces that they are not the nearest. A block that is
 * the first shape comes nearer by no more than the way either: most points need not look at it.
 *
 * Where traces leave the very same surface the first of the program has made it, whatever box was gathered.
 *
 *   traces: of the box that was gathered or collected; boxes within it that are narrowed from it look at the same ones
 *   seen: what a point goes through, a cache line and a half each */
#include "surface/surface.h"

#include "base/least.h"
#include "base/memory.h"
#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What is nearer by less than this (mm) is as near: values and bounds are rounded. */
static const double as_near = 1e-9;

struct seen {
    double raw; /* from the middle of the box */
    int32_t bounds;
    uint32_t trace;
    swarf_touch_bound bound[2]; /* of raw, by its tangents there */
};

struct swarf_surface_near {
    swarf_surface *surface;
    swarf_trace *traces;
    size_t trace_count, trace_room;
    uint32_t *numbers; /* of collected traces, among the surface's parts */
    size_t number_room;
    int collected;                /* nothing is seen yet */
    const swarf_trace *looked_at; /* own traces, or those of the larger box */
    struct seen *seen;
    size_t count, room;
    double middle[3];
    double block_value;         /* there, of the block that is the first shape; INFINITY where it is none */
    swarf_surface_near *before; /* of the set-up before, NULL where there is none */
};

swarf_status swarf_surface_near_create(const swarf_surface *surface, swarf_surface_near **out)
{
    SWARF_REQUIRE(surface && out, "surface: NULL");
    swarf_surface_near *near = calloc(1, sizeof *near);
    if (!near) return swarf_fail(SWARF_ERROR_MEMORY, "surface: out of memory");
    near->surface = swarf_surface_retain((swarf_surface *)surface); /* only its count changes */
    const swarf_status status = surface->before ? swarf_surface_near_create(surface->before, &near->before) : SWARF_OK;
    if (status != SWARF_OK) {
        swarf_surface_near_destroy(near);
        return status;
    }
    *out = near;
    return SWARF_OK;
}

void swarf_surface_near_destroy(swarf_surface_near *near)
{
    if (!near) return;
    swarf_surface_near_destroy(near->before);
    swarf_surface_release(near->surface);
    free(near->traces);
    free(near->numbers);
    free(near->seen);
    free(near);
}

size_t swarf_surface_near_count(const swarf_surface_near *near)
{
    return near ? near->count + swarf_surface_near_count(near->before) : 0;
}

struct gathering {
    swarf_surface_near *near;
    const swarf_box *where;
    size_t limit;   /* parts of the moves that count */
    double reach;   /* from the middle to a corner */
    double ceiling; /* least upper bound of a trace's raw at the middle */
};

static int overlaps(const swarf_surface_box *box, const swarf_box *where)
{
    for (int k = 0; k < 3; k++)
        if ((double)box->lo[k] > where->hi[k] || (double)box->hi[k] < where->lo[k]) return 0;
    return 1;
}

/* Let what is seen have a trace unless it cannot matter. */
static swarf_status look_at(struct gathering *g, uint32_t trace)
{
    swarf_surface_near *near = g->near;
    swarf_touch touch;
    swarf_trace_bound(&near->looked_at[trace], near->middle, &touch);
    if (touch.raw > 2 * g->reach || touch.raw > g->ceiling + 2 * g->reach) return SWARF_OK;
    if (touch.exact) g->ceiling = fmin(g->ceiling, touch.raw);
    SWARF_TRY(swarf_array_reserve((void **)&near->seen, &near->room, near->count + 1, sizeof *near->seen));
    struct seen *seen = &near->seen[near->count++];
    *seen = (struct seen){.raw = touch.raw, .bounds = touch.bounds, .trace = trace};
    memcpy(seen->bound, touch.bound, sizeof seen->bound);
    return SWARF_OK;
}

static swarf_status make_room(swarf_surface_near *near)
{
    return swarf_array_reserve((void **)&near->traces, &near->trace_room, near->trace_count + 1, sizeof *near->traces);
}

/* The trace behind the last one is kept when it is seen. */
static swarf_status keep_trace(struct gathering *g)
{
    swarf_surface_near *near = g->near;
    near->looked_at = near->traces;
    const size_t before = near->count;
    SWARF_TRY(look_at(g, (uint32_t)near->trace_count));
    near->trace_count += near->count - before;
    return SWARF_OK;
}

/* The trace of a part of the surface, kept when it is seen or only collected. */
static swarf_status take_part(struct gathering *g, size_t part)
{
    swarf_surface_near *near = g->near;
    SWARF_TRY(make_room(near));
    SWARF_TRY(swarf_surface_trace(near->surface, part, &near->traces[near->trace_count]));
    if (!near->collected) return keep_trace(g);
    SWARF_TRY(
        swarf_array_reserve((void **)&near->numbers, &near->number_room, near->trace_count + 1, sizeof *near->numbers));
    near->numbers[near->trace_count++] = (uint32_t)part;
    return SWARF_OK;
}

static swarf_status gather_level(struct gathering *g, int level, size_t first, size_t end)
{
    const swarf_surface *surface = g->near->surface;
    size_t span = 1;
    for (int n = 0; n < level; n++) span *= SURFACE_FAN;
    if (end > surface->level_count[level]) end = surface->level_count[level];
    for (size_t i = first; i < end && i * span < g->limit; i++) {
        if (!overlaps(&surface->level[level][i], g->where)) continue;
        SWARF_TRY(level > 0 ? gather_level(g, level - 1, i * SURFACE_FAN, (i + 1) * SURFACE_FAN) : take_part(g, i));
    }
    return SWARF_OK;
}

/* All that the first `moves` moves have in the box. */
static swarf_status gather_moves(struct gathering *g, size_t moves)
{
    const swarf_surface *surface = g->near->surface;
    size_t lo = 0, hi = surface->part_count; /* first part of a move that does not count */
    while (lo < hi) {
        const size_t middle = (lo + hi) / 2;
        if (surface->parts[middle].move < moves)
            lo = middle + 1;
        else
            hi = middle;
    }
    g->limit = lo;
    const int top = surface->levels - 1;
    return gather_level(g, top, 0, surface->level_count[top]);
}

/* The same for a part of a move. */
static swarf_status gather_part(struct gathering *g, size_t move, double part)
{
    swarf_surface_near *near = g->near;
    swarf_path path;
    SWARF_TRY(swarf_program_path(near->surface->program, move, &path));
    swarf_path_part(&path, part, &path);
    const uint32_t parts = swarf_trace_parts(&path);
    for (uint32_t i = 0; i < parts; i++) {
        SWARF_TRY(make_room(near));
        swarf_trace_make(swarf_surface_body(near->surface, move), &path, (int64_t)move, i, parts,
                         &near->traces[near->trace_count]);
        SWARF_TRY(keep_trace(g));
    }
    return SWARF_OK;
}

/* Ties keep the order of the program, which is that of the traces. */
static int nearer(const void *a, const void *b)
{
    const struct seen *x = a, *y = b;
    if (x->raw != y->raw) return x->raw < y->raw ? -1 : 1;
    return x->trace < y->trace ? -1 : x->trace > y->trace;
}

/* Up to so many are sorted here: qsort() sets up more than there is to sort. */
enum { MANY = 32 };

static void sort_seen(const struct gathering *g)
{
    swarf_surface_near *near = g->near;
    size_t kept = 0;
    for (size_t i = 0; i < near->count; i++)
        if (near->seen[i].raw <= g->ceiling + 2 * g->reach) near->seen[kept++] = near->seen[i];
    near->count = kept;
    if (kept > MANY) {
        qsort(near->seen, kept, sizeof *near->seen, nearer);
        return;
    }
    for (size_t i = 1; i < kept; i++) {
        const struct seen own = near->seen[i];
        size_t to = i;
        for (; to > 0 && nearer(&own, &near->seen[to - 1]) < 0; to--) near->seen[to] = near->seen[to - 1];
        near->seen[to] = own;
    }
}

/* The middle of the box, from there to its corners, and the block as seen from there. */
static swarf_status begin_box(struct gathering *g)
{
    const swarf_box *where = g->where;
    double square = 0;
    for (int k = 0; k < 3; k++) {
        SWARF_REQUIRE(isfinite(where->lo[k]) && isfinite(where->hi[k]) && where->hi[k] >= where->lo[k],
                      "surface: the box is empty or not finite in %c", "xyz"[k]);
        g->near->middle[k] = 0.5 * (where->lo[k] + where->hi[k]);
        square += 0.25 * (where->hi[k] - where->lo[k]) * (where->hi[k] - where->lo[k]);
    }
    g->reach = sqrt(square);
    g->near->block_value = INFINITY;
    if (g->near->surface->block) {
        swarf_surface_point first;
        swarf_surface_first(g->near->surface, g->near->middle, &first);
        g->near->block_value = first.value;
    }
    return SWARF_OK;
}

/* The box turned back to the set-up before, and the box round that. */
static swarf_box turn_back(const swarf_surface *surface, const swarf_box *where)
{
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int corner = 0; corner < 8; corner++) {
        double p[3];
        for (int k = 0; k < 3; k++) p[k] = corner >> k & 1 ? where->hi[k] : where->lo[k];
        swarf_placement_point(&surface->back, p, p);
        for (int k = 0; k < 3; k++) {
            box.lo[k] = fmin(box.lo[k], p[k]);
            box.hi[k] = fmax(box.hi[k], p[k]);
        }
    }
    return box;
}

static void first_shape(const swarf_surface_near *near, const double point[3], swarf_surface_point *out)
{
    const swarf_surface *surface = near->surface;
    if (!near->before) {
        swarf_surface_first(surface, point, out);
        return;
    }
    double back[3];
    swarf_placement_point(&surface->back, point, back);
    swarf_surface_evaluate(near->before, back, out);
    swarf_placement_direction(&surface->placement, out->normal, out->normal);
    if (out->move >= 0)
        out->move = -3 - out->move;
    else if (out->move != -1)
        out->move -= (int64_t)swarf_program_move_count(surface->before->program);
}

swarf_status swarf_surface_gather(swarf_surface_near *near, size_t moves, const swarf_box *where)
{
    return swarf_surface_gather_part(near, moves, 0, where);
}

swarf_status swarf_surface_gather_part(swarf_surface_near *near, size_t moves, double part, const swarf_box *where)
{
    SWARF_REQUIRE(near && where, "surface: NULL");
    near->count = near->trace_count = 0;
    near->collected = 0;
    const swarf_surface *surface = near->surface;
    struct gathering g = {.near = near, .where = where, .ceiling = INFINITY};
    SWARF_TRY(begin_box(&g));
    swarf_status status = SWARF_OK;
    if (near->before) {
        const swarf_box back = turn_back(surface, where);
        status = swarf_surface_gather(near->before, surface->before_moves, &back);
    }
    if (status == SWARF_OK) status = gather_moves(&g, moves);
    if (status == SWARF_OK && part > 0 && g.limit < surface->part_count && surface->parts[g.limit].move == moves)
        status = gather_part(&g, moves, part);
    if (status == SWARF_OK)
        sort_seen(&g);
    else
        near->count = 0;
    return status;
}

swarf_status swarf_surface_collect(swarf_surface_near *near, size_t moves, const swarf_box *where)
{
    near->count = near->trace_count = 0;
    near->collected = 1;
    if (near->before) {
        const swarf_box back = turn_back(near->surface, where);
        SWARF_TRY(swarf_surface_collect(near->before, near->surface->before_moves, &back));
    }
    struct gathering g = {.near = near, .where = where};
    const swarf_status status = gather_moves(&g, moves);
    near->looked_at = near->traces;
    return status;
}

/* What of another box there may be in this one. */
static swarf_status look_again(struct gathering *g, const swarf_surface_near *wider)
{
    if (!wider->collected) {
        for (size_t i = 0; i < wider->count; i++) SWARF_TRY(look_at(g, wider->seen[i].trace));
        return SWARF_OK;
    }
    const swarf_surface_box *boxes = wider->surface->level[0];
    for (size_t i = 0; i < wider->trace_count; i++)
        if (overlaps(&boxes[wider->numbers[i]], g->where)) SWARF_TRY(look_at(g, (uint32_t)i));
    return SWARF_OK;
}

swarf_status swarf_surface_narrow(swarf_surface_near *near, const swarf_surface_near *wider, const swarf_box *where)
{
    near->count = 0;
    near->collected = 0;
    near->looked_at = wider->looked_at;
    struct gathering g = {.near = near, .where = where, .ceiling = INFINITY};
    SWARF_TRY(begin_box(&g));
    swarf_status status = SWARF_OK;
    if (near->before) {
        const swarf_box back = turn_back(near->surface, where);
        status = swarf_surface_narrow(near->before, wider->before, &back);
    }
    if (status == SWARF_OK) status = look_again(&g, wider);
    if (status == SWARF_OK)
        sort_seen(&g);
    else
        near->count = 0;
    return status;
}

/* A tangent at a point that lies so from the middle. */
static inline double bound_at(const swarf_touch_bound *bound, const double way[3])
{
    return bound->value + bound->slope[0] * way[0] + bound->slope[1] * way[1] + bound->slope[2] * way[2];
}

/* Whether the trace is further than `beaten` for what is known of it. */
static inline int is_beyond(const struct seen *seen, const double way[3], double beaten)
{
    if (seen->bounds == 0 || bound_at(&seen->bound[0], way) <= beaten) return 0;
    return seen->bounds == 1 || bound_at(&seen->bound[1], way) > beaten;
}

/* The nearest of what a point sees. */
struct nearest {
    double least;         /* INFINITY: nothing */
    uint32_t maker;       /* trace that it is of, for which nothing may be as near that comes later */
    int kept;             /* touch that it is */
    swarf_touch touch[2]; /* and room for the next */
};

/* What is nearer to a point, `away` from the middle, than `limit`. */
static void find_nearest(const swarf_surface_near *near, const double point[3], const double way[3], double away,
                         double limit, struct nearest *found)
{
    found->least = INFINITY;
    found->maker = 0;
    found->kept = 0;
    double beaten = limit, bound = beaten + as_near;
    const struct seen *end = near->seen + near->count;
    for (const struct seen *seen = near->seen; seen < end && seen->raw <= bound + away; seen++) {
        if (is_beyond(seen, way, bound)) continue;
        const int comes_first = seen->trace < found->maker;
        const double most = comes_first ? swarf_least(bound, limit) : beaten;
        swarf_touch *touch = &found->touch[!found->kept];
        swarf_trace_look(&near->looked_at[seen->trace], point, most, touch);
        if (touch->value >= most) continue;
        const int is_nearer = touch->value < found->least - as_near;
        beaten = found->least = swarf_least(touch->value, found->least);
        bound = beaten + as_near;
        if (!is_nearer && !comes_first) continue;
        found->maker = seen->trace;
        found->kept = !found->kept;
    }
}

static void tell(const swarf_surface_near *near, const struct nearest *found, swarf_surface_point *out)
{
    const swarf_touch *touch = &found->touch[found->kept];
    *out = (swarf_surface_point){.value = -found->least,
                                 .normal = {-touch->gradient[0], -touch->gradient[1], -touch->gradient[2]},
                                 .t = touch->t,
                                 .move = near->looked_at[found->maker].move,
                                 .piece = touch->piece};
}

void swarf_surface_evaluate(const swarf_surface_near *near, const double point[3], swarf_surface_point *out)
{
    double way[3], square = 0;
    for (int k = 0; k < 3; k++) {
        way[k] = point[k] - near->middle[k];
        square += way[k] * way[k];
    }
    const double away = sqrt(square), to_block = -near->block_value - away; /* the first shape comes no nearer */
    struct nearest found;
    /* most points are decided by moves; the others look at them again, with the first shape as the limit */
    if (near->count > 0 && near->seen[0].raw + away < to_block) {
        find_nearest(near, point, way, away, INFINITY, &found);
        if (found.least + 2 * as_near < to_block) { /* nor as near, rounded as both are */
            tell(near, &found, out);
            return;
        }
    }
    swarf_surface_point first;
    first_shape(near, point, &first);
    find_nearest(near, point, way, away, -first.value, &found);
    if (found.least < INFINITY)
        tell(near, &found, out);
    else
        *out = first;
}

int swarf_surface_crossing(const swarf_surface_near *near, const double a[3], const double b[3], double tolerance_mm,
                           double *t, swarf_surface_point *out)
{
    swarf_surface_point at_lo, at_hi, at;
    swarf_surface_evaluate(near, a, &at_lo);
    swarf_surface_evaluate(near, b, &at_hi);
    if (!((at_lo.value < 0) != (at_hi.value < 0))) return 0;
    double lo = 0, hi = 1, f_lo = at_lo.value, f_hi = at_hi.value, length = 0;
    for (int k = 0; k < 3; k++) length += (b[k] - a[k]) * (b[k] - a[k]);
    length = sqrt(length);
    double best = fabs(f_lo) < fabs(f_hi) ? lo : hi;
    at = fabs(f_lo) < fabs(f_hi) ? at_lo : at_hi;
    /* false position; every third step halves, so that the bracket closes however the value bends */
    for (int step = 0; step < 200 && (hi - lo) * length > tolerance_mm && fabs(at.value) > 1e-12; step++) {
        best = step % 3 == 2 ? 0.5 * (lo + hi) : lo + (hi - lo) * f_lo / (f_lo - f_hi);
        const double point[3] = {a[0] + best * (b[0] - a[0]), a[1] + best * (b[1] - a[1]), a[2] + best * (b[2] - a[2])};
        swarf_surface_evaluate(near, point, &at);
        if ((at.value < 0) == (f_lo < 0)) {
            lo = best;
            f_lo = at.value;
        } else {
            hi = best;
            f_hi = at.value;
        }
    }
    *t = best;
    *out = at;
    return 1;
}
