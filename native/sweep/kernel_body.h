/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernels themselves; each kernel_<isa>.c defines KERNEL_NAME, sets its instruction set and includes this.
 *
 * Lanes are 4 x 4 columns of voxels (lane = 4 * x + y); what needs a square root depends on (x, y) only and is done
 * once for the eight voxels above each other, except where a track is tilted and the body general. */
#include "sweep/kernel.h"
#include "sweep/lanes.h"

/* Farther than any voxel that counts, and safe to square. */
static const float far_away = 1e18f;

/* ---- distance in the plane ------------------------------------------------------------------------------------ */

/* Distance from the lanes to an arc in the plane. Relative to its point nearest to the column's middle, so that large
 * radii cost no digits: |p - c| - R = a / (1 + sqrt(1 + k a)) with a = 2 e.n + k e.e, k = 1 / R, e = p - base. */
INLINE lanes arc_distance(const swarf_column *c, int32_t i, lanes x, lanes y)
{
    float *const *f = c->field;
    const lanes ex = x - f[COLUMN_X][i], ey = y - f[COLUMN_Y][i];
    const float k = f[COLUMN_S0][i], nx = f[COLUMN_UX][i], ny = f[COLUMN_UY][i];
    const lanes a = (ex * nx + ey * ny) * 2.0f + (ex * ex + ey * ey) * k;
    const lanes circle = a / (root(maximum(a * k + 1.0f, all(0))) + 1.0f);
    const lanes across = maximum(circle, all(0) - circle);
    if (c->kind[i] & TRACK_ARC_FULL) return across;
    const lanes from = ey * f[COLUMN_NAX][i] - ex * f[COLUMN_NAY][i] + f[COLUMN_A][i];
    const lanes until = ex * f[COLUMN_NBY][i] - ey * f[COLUMN_NBX][i] + f[COLUMN_B][i];
    const mask after = less(all(0), from), before = less(all(0), until);
    const mask within = c->kind[i] & TRACK_ARC_MAJOR ? either(after, before) : both(after, before);
    const lanes ax = x - f[COLUMN_AX][i], ay = y - f[COLUMN_AY][i], bx = x - f[COLUMN_BX][i], by = y - f[COLUMN_BY][i];
    const lanes ends = root(minimum(ax * ax + ay * ay, bx * bx + by * by));
    return pick(within, across, ends);
}

/* Distance from the lanes to the track's projection. */
INLINE lanes plan_distance(const swarf_column *c, int32_t i, lanes x, lanes y)
{
    if (c->kind[i] & TRACK_ARC) return arc_distance(c, i, x, y);
    float *const *f = c->field;
    const lanes ex = x - f[COLUMN_X][i], ey = y - f[COLUMN_Y][i];
    const float ux = f[COLUMN_UX][i], uy = f[COLUMN_UY][i];
    const lanes s = ex * ux + ey * uy, w = ey * ux - ex * uy;
    const lanes beyond = s - clamped(s, all(f[COLUMN_S0][i]), all(f[COLUMN_S1][i]));
    return root(beyond * beyond + w * w);
}

/* ---- culling ---------------------------------------------------------------------------------------------------- */

/* Bounds over a block of the distance to a swept cylinder, for sixteen tracks, and of the height of its bottom.
 * `covers` is greater than -SWARF_HALF_WIDTH unless side and top leave the whole block to the bottom. */
struct shaft_bounds {
    lanes least, most;
    lanes floor_least, floor_most, covers;
};

struct sixteen {
    lanes base_x, base_y, ux, uy, s0, s1, m, im, z, rise; /* s0, s1, line_s: 0 for arcs */
    lanes dx, dy, dz, t0, t1;                             /* balls only */
    lanes x, y, s, w, line_s;                             /* middle of the block relative to the base */
    lanes arc;                                            /* plan distance of arcs */
    mask is_arc;
};

INLINE lanes shaft_lateral(const struct sixteen *t, float radius)
{
    const lanes beyond = t->s - clamped(t->s, t->s0, t->s1);
    const lanes line = root(beyond * beyond + t->w * t->w);
    return pick(t->is_arc, t->arc, line) - radius;
}

/* Lower bound, for the enclosing cylinder (radius, lo .. hi above the tip): beside it, below its lowest or above its
 * highest point, or beyond one of the two slanted planes that hold its bottom and top. */
INLINE void shaft_least(const struct sixteen *t, const swarf_block *b, float reach, float radius, float lo, float hi,
                        struct shaft_bounds *bounds)
{
    const lanes bottom = t->z + lo, top = t->z + hi + t->rise;
    const lanes lateral = shaft_lateral(t, radius) - reach;
    const lanes lowest = t->m * t->s0 + bottom;
    const lanes below = lowest - (b->z + b->half_z), above = (b->z - b->half_z) - (t->m * t->s1 + top);
    const lanes support = t->m * t->im * reach + t->im * b->half_z;
    const lanes plane = t->m * (t->line_s - radius) + bottom;
    const lanes under = (plane - b->z) * t->im - support;
    const lanes over = (all(b->z) - (t->m * (t->line_s + radius) + top)) * t->im - support;
    bounds->least = maximum(maximum(lateral, maximum(below, above)), maximum(under, over));
    bounds->floor_least = maximum(lowest, plane - t->m * reach);
}

/* Upper bound, for a cylinder inside: the deepest point of the block's side, bottom and top. */
INLINE void shaft_most(const struct sixteen *t, const swarf_block *b, float reach, float radius, float lo, float hi,
                       struct shaft_bounds *bounds)
{
    const lanes bottom = t->z + lo, top = t->z + hi + t->rise;
    const lanes lateral = shaft_lateral(t, radius) + reach;
    const lanes aside = maximum(t->w, all(0) - t->w) + reach;
    const lanes half = root(maximum(all(0), all(radius * radius) - aside * aside)); /* half chord at the far side */
    const lanes highest_bottom = t->m * clamped(t->line_s + reach - half, t->s0, t->s1) + bottom;
    const lanes lowest_top = t->m * clamped(t->line_s - reach + half, t->s0, t->s1) + top;
    lanes below = highest_bottom - (b->z - b->half_z), above = (b->z + b->half_z) - lowest_top;
    below = pick(less(below, all(0)), below * t->im, below);
    above = pick(less(above, all(0)), above * t->im, above);
    bounds->most = maximum(lateral, maximum(below, above));
    bounds->floor_most = highest_bottom;
    bounds->covers = maximum(lateral, above);
}

/* Distance from the middle of the block to sixteen tracks of the ball's centre, less the radius. */
INLINE lanes capsule_distance(const struct sixteen *t, const swarf_block *b, float radius, float centre)
{
    const lanes ez = all(b->z) - t->z - centre;
    const lanes q = clamped(t->x * t->dx + t->y * t->dy + ez * t->dz, t->t0, t->t1);
    const lanes fx = t->x - q * t->dx, fy = t->y - q * t->dy, fz = ez - q * t->dz;
    const lanes line = root(fx * fx + fy * fy + fz * fz);
    const lanes arc = root(t->arc * t->arc + ez * ez);
    return pick(t->is_arc, arc, line) - radius;
}

INLINE struct sixteen gather_tracks(const swarf_column *c, const int32_t *at, int ball)
{
    float *const *f = c->field;
    struct sixteen t;
    t.base_x = gather(f[COLUMN_X], at);
    t.base_y = gather(f[COLUMN_Y], at);
    t.ux = gather(f[COLUMN_UX], at);
    t.uy = gather(f[COLUMN_UY], at);
    t.m = gather(f[COLUMN_M], at);
    t.im = gather(f[COLUMN_IM], at);
    t.z = gather(f[COLUMN_Z], at);
    t.rise = gather(f[COLUMN_RISE], at);
    t.s0 = gather(f[COLUMN_S0], at);
    t.s1 = gather(f[COLUMN_S1], at);
    t.is_arc = less(all(0), all(0));
    if (c->arcs) { /* their fields hold other things; what is left of a line's formulas must come to nothing */
        float arc[LANES];
        for (int k = 0; k < LANES; k++) arc[k] = c->kind[at[k]] & TRACK_ARC ? 1 : 0;
        t.is_arc = less(all(0.5f), load(arc));
        t.s0 = pick(t.is_arc, all(0), t.s0);
        t.s1 = pick(t.is_arc, all(0), t.s1);
    }
    if (ball) {
        t.dx = gather(f[COLUMN_DX], at);
        t.dy = gather(f[COLUMN_DY], at);
        t.dz = gather(f[COLUMN_DZ], at);
        t.t0 = gather(f[COLUMN_T0], at);
        t.t1 = gather(f[COLUMN_T1], at);
    }
    return t;
}

/* Place the tracks relative to a block. */
INLINE void face_block(const swarf_column *c, const int32_t *at, const swarf_block *b, struct sixteen *t)
{
    t->x = all(b->x) - t->base_x;
    t->y = all(b->y) - t->base_y;
    t->s = t->x * t->ux + t->y * t->uy;
    t->w = t->y * t->ux - t->x * t->uy;
    t->line_s = t->s;
    t->arc = all(0);
    if (!c->arcs) return;
    float plan[LANES];
    for (int k = 0; k < LANES; k++)
        plan[k] = c->kind[at[k]] & TRACK_ARC ? arc_distance(c, at[k], all(b->x), all(b->y))[0] : 0;
    t->arc = load(plan);
    t->line_s = pick(t->is_arc, all(0), t->s);
}

/* What is known of one block while its list is made. */
struct culling {
    lanes best;
    size_t kept, champion;
    float champion_floor;
};

/* Look at up to sixteen tracks; 1 when one of them covers the block. */
INLINE int cull_sixteen(const swarf_body *body, const swarf_column *c, const int32_t *at, unsigned valid,
                        const swarf_block *b, struct sixteen *t, struct culling *state, int32_t *out, float *bound,
                        float *floor)
{
    const float reach = b->half * 1.41421357f; /* from the middle of the block to its vertical edges */
    const int ball = body->kind == SWARF_BODY_BALL;
    struct shaft_bounds bounds;
    face_block(c, at, b, t);
    shaft_least(t, b, reach, body->radius, ball ? body->core_lo : body->z_lo, body->z_hi, &bounds);
    shaft_most(t, b, reach, body->core_radius, body->core_lo, body->core_hi, &bounds);
    if (ball) {
        const float corner = sqrtf(reach * reach + b->half_z * b->half_z);
        const lanes capsule = capsule_distance(t, b, body->radius, body->core_lo);
        bounds.least = minimum(bounds.least, capsule - corner);
        bounds.most = minimum(bounds.most, capsule + corner);
    }
    if (bits(less(bounds.most, all(-SWARF_HALF_WIDTH))) & valid) return 1;
    unsigned keep = bits(less(bounds.least, all(SWARF_HALF_WIDTH))) & valid;
    if (!keep) return 0;
    float lows[LANES], highs[LANES], floors[LANES], ceilings[LANES];
    store(lows, bounds.least);
    store(highs, bounds.most);
    store(floors, bounds.floor_least);
    store(ceilings, pick(less(bounds.covers, all(-SWARF_HALF_WIDTH)), bounds.floor_most, all(far_away)));
    for (; keep; keep &= keep - 1) {
        const int lane = __builtin_ctz(keep);
        out[state->kept] = at[lane];
        bound[state->kept] = lows[lane];
        floor[state->kept] = floors[lane];
        if (ceilings[lane] < state->champion_floor) {
            state->champion_floor = ceilings[lane];
            state->champion = state->kept;
        }
        state->kept++;
        state->best = minimum(state->best, all(highs[lane]));
    }
    return 0;
}

/* A track that is everywhere farther than another one is anywhere does not matter; nor does, of cylinders, one whose
 * bottom is nowhere below that of another which covers the block from side to side. */
static size_t drop_dominated(const swarf_body *body, const struct culling *state, int32_t *out, const float *bound,
                             const float *floor)
{
    size_t left = state->kept;
    if (left > 1) {
        const float limit = least_lane(state->best);
        const int flat = body->kind == SWARF_BODY_CYLINDER;
        left = 0;
        for (size_t i = 0; i < state->kept; i++) {
            const int matters = bound[i] <= limit && !(flat && floor[i] >= state->champion_floor);
            if (matters || i == state->champion) out[left++] = out[i];
        }
    }
    for (int i = 0; i < COLUMN_SLACK; i++) out[left + (size_t)i] = left ? out[0] : 0;
    return left;
}

static unsigned cull(const swarf_body *body, const swarf_column *c, const int32_t *in, size_t count,
                     const swarf_block *blocks, size_t block_count, int32_t *const *out, size_t *out_count)
{
    struct culling state[BLOCKS_AT_ONCE];
    for (size_t b = 0; b < block_count; b++)
        state[b] = (struct culling){.best = all(far_away), .champion = SIZE_MAX, .champion_floor = far_away};
    unsigned covered = 0;
    for (size_t i = 0; i < count; i += LANES) {
        const unsigned valid = count - i >= LANES ? 0xffffu : (1u << (count - i)) - 1;
        struct sixteen t = gather_tracks(c, in + i, body->kind == SWARF_BODY_BALL);
        for (size_t b = 0; b < block_count; b++)
            if (!(covered >> b & 1) &&
                cull_sixteen(body, c, in + i, valid, &blocks[b], &t, &state[b], out[b], c->bound[b], c->floor[b]))
                covered |= 1u << b;
    }
    for (size_t b = 0; b < block_count; b++)
        if (!(covered >> b & 1)) out_count[b] = drop_dominated(body, &state[b], out[b], c->bound[b], c->floor[b]);
    return covered;
}

/* ---- distance to one track, 16 columns x 8 voxels ---------------------------------------------------------------- */

/* One piece over a whole column of eight voxels at plan distance rho; heights relative to the tip start at `base`. */
INLINE void level_piece(const swarf_piece *p, lanes rho, float base, lanes value[8])
{
    if (!p->is_arc) {
        const lanes across = rho * p->first_r - p->radius;
        for (int z = 0; z < 8; z++) value[z] = maximum(value[z], across + p->first_z * (base + (float)z));
        return;
    }
    const lanes v = rho - p->centre_r, v2 = v * v;
    for (int z = 0; z < 8; z++) {
        const float h = base + (float)z - p->centre_z;
        const mask after = less(v * p->first_z, all(h * p->first_r)), before = less(all(h * p->last_r), v * p->last_z);
        const lanes ends = maximum(v * p->first_r + h * p->first_z, v * p->last_r + h * p->last_z);
        value[z] = maximum(value[z], pick(both(after, before), root(v2 + h * h), ends) - p->radius);
    }
}

/* Any body where the height of the tip does not depend on the place: level lines, level arcs, plunges. The least plan
 * distance is the nearest moment; of a plunge the lower border counts at its low end, the upper at its high end. */
static __attribute__((noinline)) void general_level(const swarf_body *body, const swarf_column *c, int32_t i, lanes x,
                                                    lanes y, float z0, lanes best[8])
{
    float *const *f = c->field;
    const lanes rho = plan_distance(c, i, x, y);
    const float low = z0 - f[COLUMN_Z][i], high = low - f[COLUMN_RISE][i];
    for (size_t k = 0; k < body->component_count; k++) {
        const swarf_component *component = &body->components[k];
        lanes value[8];
        for (int z = 0; z < 8; z++) value[z] = all(-far_away);
        for (size_t p = component->first; p < component->first + component->count; p++)
            level_piece(&body->pieces[p], rho, body->pieces[p].upper ? high : low, value);
        for (int z = 0; z < 8; z++) best[z] = minimum(best[z], value[z]);
    }
}

/* phi of a component at moment t of a tilted line, its slope in t and its gradient across the line's frame. */
struct moment {
    lanes value, slope, along, across, up;
};

struct tilt {
    lanes s, w2, w;  /* of the columns, relative to the base */
    lanes height;    /* of the voxel above the tip at t = 0 */
    float run, rise; /* per unit of t */
};

INLINE struct moment at_moment(const swarf_body *body, const swarf_component *component, const struct tilt *tilt,
                               lanes t)
{
    const lanes u = tilt->s - t * tilt->run, height = tilt->height - t * tilt->rise;
    const lanes rho = root(u * u + tilt->w2);
    const lanes inverse = all(1) / maximum(rho, all(1e-9f));
    lanes value = all(-far_away), nr = all(0), nz = all(0);
    for (size_t k = component->first; k < component->first + component->count; k++) {
        const swarf_piece *p = &body->pieces[k];
        if (!p->is_arc) {
            const lanes own = rho * p->first_r + height * p->first_z - p->radius;
            const mask more = less(value, own);
            value = pick(more, own, value);
            nr = pick(more, all(p->first_r), nr);
            nz = pick(more, all(p->first_z), nz);
            continue;
        }
        const lanes v = rho - p->centre_r, h = height - p->centre_z;
        const lanes first = v * p->first_r + h * p->first_z, last = v * p->last_r + h * p->last_z;
        const mask within = both(less(v * p->first_z, h * p->first_r), less(h * p->last_r, v * p->last_z));
        const lanes length = root(v * v + h * h), unit = all(1) / maximum(length, all(1e-9f));
        const mask upper = less(first, last);
        const lanes own = pick(within, length, pick(upper, last, first)) - p->radius;
        const mask more = less(value, own);
        value = pick(more, own, value);
        nr = pick(more, pick(within, v * unit, pick(upper, all(p->last_r), all(p->first_r))), nr);
        nz = pick(more, pick(within, h * unit, pick(upper, all(p->last_z), all(p->first_z))), nz);
    }
    struct moment m = {.value = value, .along = nr * u * inverse, .across = nr * tilt->w * inverse, .up = nz};
    m.slope = all(0) - (m.along * tilt->run + m.up * tilt->rise);
    return m;
}

/* Greatest value at moment t among the pieces that only recede from the points from there on (sense 1: as t grows, at
 * the start of the line; -1: as it falls, at its end): the faces that close what the component sweeps. */
INLINE lanes face_at_end(const swarf_body *body, const swarf_component *component, const struct tilt *tilt, lanes t,
                         float sense)
{
    const lanes u = tilt->s - t * tilt->run, height = tilt->height - t * tilt->rise;
    const lanes rho = root(u * u + tilt->w2);
    const lanes along = u / maximum(rho, all(1e-9f)) * (sense * tilt->run);
    const float rise = sense * tilt->rise;
    lanes value = all(-far_away);
    for (size_t k = component->first; k < component->first + component->count; k++) {
        const swarf_piece *p = &body->pieces[k];
        lanes own = rho * p->first_r + height * p->first_z - p->radius, nr = all(p->first_r), nz = all(p->first_z);
        if (p->is_arc) {
            const lanes v = rho - p->centre_r, h = height - p->centre_z;
            const lanes first = v * p->first_r + h * p->first_z, last = v * p->last_r + h * p->last_z;
            const mask within = both(less(v * p->first_z, h * p->first_r), less(h * p->last_r, v * p->last_z));
            const lanes length = root(v * v + h * h), unit = all(1) / maximum(length, all(1e-9f));
            const mask upper = less(first, last);
            own = pick(within, length, pick(upper, last, first)) - p->radius;
            nr = pick(within, v * unit, pick(upper, all(p->last_r), all(p->first_r)));
            nz = pick(within, h * unit, pick(upper, all(p->last_z), all(p->first_z)));
        }
        value = pick(less(all(0), nr * along + nz * rise), value, maximum(value, own));
    }
    return value;
}

INLINE struct moment pick_moment(mask m, struct moment a, struct moment b)
{
    return (struct moment){pick(m, a.value, b.value), pick(m, a.slope, b.slope), pick(m, a.along, b.along),
                           pick(m, a.across, b.across), pick(m, a.up, b.up)};
}

/* Where the tangents at both ends of the bracket meet; a lower bound of the minimum lies there. */
INLINE lanes tangents_meet(lanes a, lanes b, const struct moment *at_a, const struct moment *at_b, lanes *bound)
{
    const lanes turn = maximum(at_b->slope - at_a->slope, all(1e-12f));
    const lanes step = (at_a->value - at_b->value + at_b->slope * (b - a)) / turn;
    const lanes t = clamped(a + step, a, b);
    *bound = at_a->value + at_a->slope * (t - a);
    return t;
}

/* Stop when the minimum is known to this many voxels. */
static const float settled = 2e-5f;
/* Alternating bisection and tangents halves the bracket at least every other step. */
enum { SEARCH_STEPS = 28 };

/* Any body on a tilted line: phi is convex in t, its minimum is bracketed by the sign of its slope and closed in on by
 * bisection and by the crossing of the tangents (exact at once where two pieces meet). The gradient of the minimum is
 * the mix of both ends' that stands across the track; dividing by its length makes edges sweep with unit gradient. */
static __attribute__((noinline)) void general_tilted(const swarf_body *body, const swarf_column *c, int32_t i, lanes x,
                                                     lanes y, float z0, int voxels, lanes best[8])
{
    float *const *f = c->field;
    const lanes ex = x - f[COLUMN_X][i], ey = y - f[COLUMN_Y][i];
    const float ux = f[COLUMN_UX][i], uy = f[COLUMN_UY][i];
    struct tilt tilt = {
        .s = ex * ux + ey * uy, .w = ey * ux - ex * uy, .run = f[COLUMN_IM][i], .rise = f[COLUMN_DZ][i]};
    tilt.w2 = tilt.w * tilt.w;
    /* only while the cutter is near: beside it and between its lowest and highest point, with the band and a margin */
    const float margin = SWARF_HALF_WIDTH + 1, reach = body->radius + margin;
    const lanes from = maximum(all(f[COLUMN_T0][i]), (tilt.s - reach) / tilt.run);
    const lanes until = minimum(all(f[COLUMN_T1][i]), (tilt.s + reach) / tilt.run);
    for (int z = 0; z < voxels; z++) {
        tilt.height = all(z0 + (float)z - f[COLUMN_Z][i]);
        const lanes first = maximum(from, (tilt.height - (body->z_hi + margin)) / tilt.rise);
        const lanes last = minimum(until, (tilt.height - (body->z_lo - margin)) / tilt.rise);
        const mask never = less(last, first);
        if (bits(never) == 0xffffu) continue;
        for (size_t k = 0; k < body->component_count; k++) {
            const swarf_component *component = &body->components[k];
            lanes a = first, b = maximum(first, last);
            struct moment at_a = at_moment(body, component, &tilt, a), at_b = at_moment(body, component, &tilt, b);
            const mask falls = less(at_a.slope, all(0)), climbs = less(all(0), at_b.slope), inner = both(falls, climbs);
            lanes bound;
            for (int step = 0; step < SEARCH_STEPS; step++) {
                lanes t = tangents_meet(a, b, &at_a, &at_b, &bound);
                const lanes gap = pick(both(inner, less(last, first)), all(0), minimum(at_a.value, at_b.value) - bound);
                if (!(bits(both(inner, less(all(settled), gap))))) break;
                if (step & 1) t = (a + b) * 0.5f;
                const struct moment at_t = at_moment(body, component, &tilt, t);
                const mask left = less(at_t.slope, all(0));
                a = pick(left, t, a);
                b = pick(left, b, t);
                at_a = pick_moment(left, at_t, at_a);
                at_b = pick_moment(left, at_b, at_t);
            }
            const lanes turn = maximum(at_b.slope - at_a.slope, all(1e-12f));
            const lanes part = clamped((all(0) - at_a.slope) / turn, all(0), all(1));
            const lanes along = at_a.along + (at_b.along - at_a.along) * part;
            const lanes across = at_a.across + (at_b.across - at_a.across) * part;
            const lanes up = at_a.up + (at_b.up - at_a.up) * part;
            /* deep inside, opposite sides of the cutter cancel: no more than tenfold */
            const lanes length = maximum(root(along * along + across * across + up * up), all(0.1f));
            tangents_meet(a, b, &at_a, &at_b, &bound);
            lanes value = pick(inner, bound / minimum(length, all(1)), pick(falls, at_b.value, at_a.value));
            /* inside, a face at the line's ends may be nearer than the one along it, whose distance was scaled */
            if (bits(both(inner, less(value, all(0))))) {
                const lanes ends = maximum(face_at_end(body, component, &tilt, first, 1),
                                           face_at_end(body, component, &tilt, maximum(first, last), -1));
                value = pick(inner, pick(less(value, all(0)), maximum(value, minimum(ends, all(0))), value), value);
            }
            value = pick(never, all(far_away), value);
            best[z] = minimum(best[z], value);
        }
    }
}

/* The slanted surface left by the rim of a disc on a tilted line, where it turns into the side: an elliptic cylinder
 * that meets the side without an edge. `height`: voxels beyond the disc's middle, outwards. The distance of first order
 * used elsewhere is off there by h^2 / 4 (distance to the seam), so near the seam the conic itself stands for it:
 *     (height^2 / m^2 - (R^2 - w^2)) / (R + |w|)
 * which is the side's own distance R - |w| up to the disc, and right to second order next to the seam. */
enum { SEAM = 3 };

struct slant {
    lanes square, linear, rest;
};

INLINE struct slant slant_at(lanes aside, lanes chord, lanes scale, float m, float radius)
{
    const mask near = less(all(radius - SEAM), aside);
    const lanes conic = all(1) / ((minimum(aside, all(radius)) + radius) * (m * m));
    return (struct slant){pick(near, conic, all(0)), pick(near, all(0), scale),
                          pick(near, all(radius) - aside, scale * chord * m)};
}

INLINE lanes slant_value(const struct slant *slant, lanes height)
{
    const lanes up = maximum(height, all(0));
    return up * up * slant->square + height * slant->linear - slant->rest;
}

static __attribute__((noinline)) void cylinder_seam(float m, float radius, lanes s, lanes w, lanes side, float bottom,
                                                    float length, float low, float high, int seam, lanes best[8])
{
    const lanes aside = maximum(w, all(0) - w);
    const lanes chord2 = maximum(all(0), all(radius * radius) - w * w), chord = root(chord2);
    const lanes scale = chord / root(chord2 + m * m * radius * radius);
    const struct slant top = slant_at(aside, chord, scale, m, radius);
    const struct slant beyond = seam ? slant_at(aside, chord, all(1), m, radius) : top;
    const lanes at = s * m + bottom;
    for (int z = 0; z < 8; z++) {
        lanes under = slant_value(&top, at - (float)z);
        if (seam) under = maximum(under, slant_value(&beyond, at - (float)z));
        const lanes below = maximum(all(low - (float)z), under);
        const lanes above = maximum(all((float)z - high), slant_value(&top, all((float)z - length) - at));
        best[z] = minimum(best[z], maximum(side, maximum(below, above)));
    }
}

/* Cylinders on lines. Tilted: side, lowest bottom, and the slanted surface that the trailing edge of the bottom leaves,
 * scaled to unit gradient; likewise at the top. Never switched between, so that the band has no tears. `seam`: the
 * bottom lies inside of something else, which gives the distance beyond it: there it only must not be too near, so that
 * it is not scaled. */
INLINE void cylinder_line(const swarf_body *body, const swarf_column *c, int32_t i, lanes x, lanes y, float z0,
                          int seam, lanes best[8])
{
    float *const *f = c->field;
    const float radius = body->radius, m = f[COLUMN_M][i];
    const float bottom = f[COLUMN_Z][i] + body->z_lo - z0, length = body->z_hi - body->z_lo + f[COLUMN_RISE][i];
    const lanes ex = x - f[COLUMN_X][i], ey = y - f[COLUMN_Y][i];
    const float ux = f[COLUMN_UX][i], uy = f[COLUMN_UY][i], s0 = f[COLUMN_S0][i], s1 = f[COLUMN_S1][i];
    const lanes s = ex * ux + ey * uy, w = ey * ux - ex * uy;
    const lanes beyond = s - clamped(s, all(s0), all(s1)), w2 = w * w;
    const lanes side = root(beyond * beyond + w2) - radius;
    const float low = bottom + m * s0, high = bottom + length + m * s1;
    if (m == 0) {
        for (int z = 0; z < 8; z++) {
            const float below = low - (float)z, above = (float)z - high;
            best[z] = minimum(best[z], maximum(side, all(below > above ? below : above)));
        }
        return;
    }
    /* the seam between slanted surface and side: of a ball always within the surface, of others where it is no edge */
    if (m * m * radius > (seam ? 1.0f : 6.0f) && bits(less(all((radius - SEAM) * (radius - SEAM)), w2))) {
        cylinder_seam(m, radius, s, w, side, bottom, length, low, high, seam, best);
        return;
    }
    const int top_near = low + length - SWARF_HALF_WIDTH < 7; /* of a long cutter it mostly is far above */
    const lanes chord2 = maximum(all(0), all(radius * radius) - w2), chord = root(chord2);
    const lanes scale = chord / root(chord2 + m * m * radius * radius);
    const lanes under = (s - chord) * m + bottom;
    for (int z = 0; z < 8; z++) {
        const lanes slanted = under - (float)z;
        lanes value = maximum(maximum(side, all(low - (float)z)), slanted * scale);
        if (seam) value = maximum(value, slanted);
        if (!top_near)
            best[z] = minimum(best[z], value);
        else {
            const lanes over = ((s + chord) * m + (bottom + length)) * scale;
            best[z] = minimum(best[z], maximum(value, maximum(all((float)z - high), scale * (float)z - over)));
        }
    }
}

/* Balls on lines: the shaft from the centre up, and the capsule's squared distance, rooted once at the end. */
INLINE void ball_line(const swarf_body *body, const swarf_column *c, int32_t i, lanes x, lanes y, float z0,
                      lanes best[8], lanes capsule[8])
{
    float *const *f = c->field;
    const float centre = f[COLUMN_Z][i] + body->core_lo - z0, m = f[COLUMN_M][i];
    const float lowest = centre + m * f[COLUMN_S0][i], highest = centre + m * f[COLUMN_S1][i] + f[COLUMN_RISE][i];
    if (highest + SWARF_HALF_WIDTH > 0) {
        const lanes ex = x - f[COLUMN_X][i], ey = y - f[COLUMN_Y][i];
        const lanes along = ex * f[COLUMN_DX][i] + ey * f[COLUMN_DY][i], flat = ex * ex + ey * ey;
        const lanes t0 = all(f[COLUMN_T0][i]), t1 = all(f[COLUMN_T1][i]);
        const float dz = f[COLUMN_DZ][i];
        for (int z = 0; z < 8; z++) {
            const float ez = (float)z - centre;
            const lanes q = along + ez * dz;
            const lanes t = clamped(q, t0, t1);
            capsule[z] = minimum(capsule[z], t * (t - (q + q)) + (flat + ez * ez));
        }
    }
    if (lowest - SWARF_HALF_WIDTH < 7) {
        const swarf_body shaft = {.radius = body->radius, .z_lo = body->core_lo, .z_hi = body->z_hi};
        cylinder_line(&shaft, c, i, x, y, z0, 1, best);
    }
}

/* ---- all tracks of a list ---------------------------------------------------------------------------------------- */

/* `voxels`: how many above each other are wanted, 8 or fewer; the others get any value. */
INLINE void distance_group(const swarf_body *body, const swarf_column *c, const int32_t *list, size_t count, lanes x,
                           lanes y, float z0, int voxels, float out[128])
{
    lanes best[8], capsule[8];
    for (int z = 0; z < 8; z++) {
        best[z] = all(far_away);
        capsule[z] = all(far_away);
    }
    const int ball = body->kind == SWARF_BODY_BALL;
    for (size_t k = 0; k < count; k++) {
        const int32_t i = list[k];
        const int kind = c->kind[i];
        if (body->kind == SWARF_BODY_GENERAL || kind & TRACK_ARC) {
            if (kind & TRACK_TILTED)
                general_tilted(body, c, i, x, y, z0, voxels, best);
            else
                general_level(body, c, i, x, y, z0, best);
        } else if (ball) {
            ball_line(body, c, i, x, y, z0, best, capsule);
        } else {
            cylinder_line(body, c, i, x, y, z0, 0, best);
        }
    }
    /* where no ball is within the band its root is not worth taking */
    const float reach = body->radius + SWARF_HALF_WIDTH;
    for (int z = 0; z < 8; z++) {
        lanes value = best[z];
        if (ball && bits(less(capsule[z], all(reach * reach))))
            value = minimum(value, root(maximum(capsule[z], all(0))) - body->radius);
        store(out + z * LANES, value);
    }
}

static const float lane_x[LANES] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
static const float lane_y[LANES] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};

static float distance(const swarf_body *body, const swarf_column *column, const int32_t *list, size_t count)
{
    _Alignas(64) float found[128];
    distance_group(body, column, list, count, all(0), all(0), 0, 1, found);
    return found[0];
}

/* What becomes of the sixteen columns of a group. */
struct leaf_state {
    octet least, most;
    unsigned char mask[64];
};

INLINE void put(swarf_leaf_cut *leaf, struct leaf_state *state, int place, octet value)
{
    store8(leaf->values + place * 8, value);
    state->least = minimum8(state->least, value);
    state->most = maximum8(state->most, value);
    state->mask[place] = (unsigned char)within8(value, all8(leaf->background));
}

/* Place of lane `lane` of the group whose low corner is (gx, gy): its column's number in the leaf. */
INLINE int column_of(int gx, int gy, int lane)
{
    return (gx + lane / 4) * 8 + gy + lane % 4;
}

INLINE void keep_group(swarf_leaf_cut *leaf, struct leaf_state *state, int gx, int gy)
{
    for (int lane = 0; lane < LANES; lane++) {
        const int place = column_of(gx, gy, lane);
        put(leaf, state, place, leaf->solid ? all8(-leaf->background) : load8(leaf->values + place * 8));
    }
}

INLINE void remove_group(swarf_leaf_cut *leaf, struct leaf_state *state, int gx, int gy)
{
    for (int lane = 0; lane < LANES; lane++) put(leaf, state, column_of(gx, gy, lane), all8(leaf->background));
}

/* values = max(values, -found), turned from sixteen columns side by side to columns of eight voxels. */
INLINE void merge_group(swarf_leaf_cut *leaf, struct leaf_state *state, int gx, int gy, const float found[128])
{
    const octet outside = all8(leaf->background), inside = all8(-leaf->background), scale = all8(-leaf->voxel);
    for (int half = 0; half < LANES; half += 8) {
        octet row[8];
        for (int z = 0; z < 8; z++) row[z] = load8(found + z * LANES + half);
        transpose8(row);
        for (int k = 0; k < 8; k++) {
            const int place = column_of(gx, gy, half + k);
            const octet old = leaf->solid ? inside : load8(leaf->values + place * 8);
            put(leaf, state, place, maximum8(old, minimum8(row[k] * scale, outside)));
        }
    }
}

/* Enough tracks that looking at each quarter of the leaf on its own pays. */
enum { FEW = 3 };

static int cut(const swarf_body *body, const swarf_column *c, const int32_t *list, size_t count, swarf_leaf_cut *leaf)
{
    struct leaf_state state = {.least = all8(leaf->background), .most = all8(-leaf->background)};
    _Alignas(64) float found[128];
    int touched = 0;
    swarf_block blocks[4];
    for (int g = 0; g < 4; g++)
        blocks[g] = (swarf_block){leaf->x + (float)(g >> 1) * 4 + 1.5f, leaf->y + (float)(g & 1) * 4 + 1.5f,
                                  leaf->z + 3.5f, 1.5f, 3.5f};
    size_t counts[4] = {count, count, count, count};
    const int each = count > FEW;
    const unsigned removed = each ? cull(body, c, list, count, blocks, 4, &c->list[LIST_GROUPS], counts) : 0;
    for (int g = 0; g < 4; g++) {
        const int gx = (g >> 1) * 4, gy = (g & 1) * 4;
        if (removed >> g & 1) {
            remove_group(leaf, &state, gx, gy);
        } else if (counts[g] == 0) {
            keep_group(leaf, &state, gx, gy);
            continue;
        } else {
            distance_group(body, c, each ? c->list[LIST_GROUPS + g] : list, counts[g],
                           load(lane_x) + (leaf->x + (float)gx), load(lane_y) + (leaf->y + (float)gy), leaf->z, 8,
                           found);
            merge_group(leaf, &state, gx, gy, found);
        }
        touched = 1;
    }
    if (!touched) return 0;
    memcpy(leaf->mask, state.mask, sizeof state.mask);
    float lows[8], highs[8];
    store8(lows, state.least);
    store8(highs, state.most);
    leaf->least = lows[0];
    leaf->most = highs[0];
    for (int k = 1; k < 8; k++) {
        leaf->least = lows[k] < leaf->least ? lows[k] : leaf->least;
        leaf->most = highs[k] > leaf->most ? highs[k] : leaf->most;
    }
    return 1;
}

/* ---- whole leaves ------------------------------------------------------------------------------------------------ */

static void block(const swarf_slabs *slabs, float voxel, float background, float values[512], uint64_t active[8],
                  float *least)
{
    const octet zero = all8(0), outside = all8(background), inside = all8(-background);
    const octet up = load8(slabs->distance[2]), up_out = maximum8(up, zero);
    octet low = outside;
    unsigned char rows[64];
    for (int x = 0; x < 8; x++) {
        const float dx = slabs->distance[0][x], dx_out = dx > 0 ? dx : 0;
        for (int y = 0; y < 8; y++) {
            const float dy = slabs->distance[1][y], dy_out = dy > 0 ? dy : 0;
            const octet square = up_out * up_out + (dx_out * dx_out + dy_out * dy_out);
            const octet depth = minimum8(maximum8(up, all8(dx > dy ? dx : dy)), zero);
            const octet value = maximum8(minimum8((depth + root8(square)) * voxel, outside), inside);
            store8(values + x * 64 + y * 8, value);
            low = minimum8(low, value);
            rows[x * 8 + y] = (unsigned char)within8(value, outside);
        }
    }
    memcpy(active, rows, sizeof rows);
    float lows[8];
    store8(lows, low);
    *least = lows[0];
    for (int k = 1; k < 8; k++) *least = lows[k] < *least ? lows[k] : *least;
}

static double occupancy(const float values[512], float scale)
{
    /* sixteen sums of 32 terms each: exact enough in float, in a fixed order */
    octet sums[2] = {all8(0), all8(0)};
    for (int i = 0; i < 512; i += 16)
        for (int k = 0; k < 2; k++) {
            const octet part = all8(0.5f) - load8(values + i + 8 * k) * scale;
            sums[k] += maximum8(minimum8(part, all8(1)), all8(0));
        }
    double total = 0;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 8; i++) total += (double)sums[k][i];
    return total;
}

const swarf_kernel KERNEL_NAME = {cull, cut, distance, block, occupancy};
