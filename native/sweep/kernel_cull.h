/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Part of the kernels (kernel_body.h): which tracks matter to a block, by bounds of their distance over all of it. */
#ifndef SWARF_SWEEP_KERNEL_CULL_H
#define SWARF_SWEEP_KERNEL_CULL_H

#include "sweep/kernel_plan.h"

/* Blocks: one and the same for sixteen tracks, or sixteen for one and the same track. */
struct block_lanes {
    lanes x, y, z;
    float half, half_z;
};

/* Bounds over a block of the distance to a swept cylinder, for sixteen pairs of track and block, and of the height of
 * its bottom. `covers` is greater than -SWARF_HALF_WIDTH unless side and top leave the whole block to the bottom. */
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
INLINE void shaft_least(const struct sixteen *t, const struct block_lanes *b, float reach, float radius, float lo,
                        float hi, struct shaft_bounds *bounds)
{
    const lanes bottom = t->z + lo, top = t->z + hi + t->rise;
    const lanes lateral = shaft_lateral(t, radius) - reach;
    const lanes lowest = t->m * t->s0 + bottom;
    const lanes below = lowest - (b->z + b->half_z), above = (b->z - b->half_z) - (t->m * t->s1 + top);
    const lanes support = t->m * t->im * reach + t->im * b->half_z;
    const lanes plane = t->m * (t->line_s - radius) + bottom;
    const lanes under = (plane - b->z) * t->im - support;
    const lanes over = (b->z - (t->m * (t->line_s + radius) + top)) * t->im - support;
    bounds->least = maximum(maximum(lateral, maximum(below, above)), maximum(under, over));
    bounds->floor_least = maximum(lowest, plane - t->m * reach);
}

/* Upper bound, for a cylinder inside: the deepest point of the block's side, bottom and top. */
INLINE void shaft_most(const struct sixteen *t, const struct block_lanes *b, float reach, float radius, float lo,
                       float hi, struct shaft_bounds *bounds)
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

/* Both bounds for balls: all points within the radius of a strip (see ball_line()), below the top. `reach` to vertical
 * edges of the block, `corner` to its corners. */
INLINE void ball_bounds(const swarf_body *body, const struct sixteen *t, const struct block_lanes *b, float reach,
                        struct shaft_bounds *bounds)
{
    const float corner = sqrtf(reach * reach + b->half_z * b->half_z);
    const lanes ez = b->z - t->z - body->core_lo;
    const lanes on = clamped(t->line_s, t->s0, t->s1), beyond = t->line_s - on;
    const lanes beside = pick(t->is_arc, t->arc * t->arc, beyond * beyond + t->w * t->w);
    const lanes q = clamped(t->x * t->dx + t->y * t->dy + ez * t->dz, t->t0, t->t1);
    const lanes fx = t->x - q * t->dx, fy = t->y - q * t->dy, fz = ez - q * t->dz;
    const lanes under = pick(t->is_arc, beside + ez * ez, fx * fx + fy * fy + fz * fz);
    const lanes strip = root(pick(less(t->m * on, ez), beside, under)) - body->radius;
    const lanes lateral = root(beside) - body->radius;
    const lanes top = t->z + body->z_hi + t->rise;
    const lanes above = (b->z - b->half_z) - (t->m * t->s1 + top);
    const lanes over =
        (b->z - (t->m * (t->line_s + body->radius) + top)) * t->im - (t->m * t->im * reach + t->im * b->half_z);
    bounds->least = maximum(maximum(strip - corner, lateral - reach), maximum(above, over));
    /* wholly above the centre's line only the place in the plane counts */
    const lanes below = t->m * clamped(t->line_s + reach, t->s0, t->s1) - (ez - b->half_z);
    const lanes near = pick(less(below, all(0)), lateral + reach, strip + corner);
    lanes close = (b->z + b->half_z) - (t->m * clamped(t->line_s - reach, t->s0, t->s1) + top);
    close = pick(less(close, all(0)), close * t->im, close);
    bounds->most = maximum(minimum(near, strip + corner), close);
    bounds->floor_least = all(0);
    bounds->floor_most = bounds->covers = all(far_away);
}

/* Which tracks are in the lanes: any sixteen, or two, one in the lanes before HALF and one in those after. */
enum { HALF = LANES / 2 };
struct chosen {
    const int32_t *at;
    int two;
};

INLINE lanes halves(lanes first, lanes second)
{
    const lanes number = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return pick(less(number, all(HALF)), first, second);
}

INLINE lanes chosen_field(const float *field, struct chosen chosen)
{
    return chosen.two ? halves(all(field[chosen.at[0]]), all(field[chosen.at[1]])) : gather(field, chosen.at);
}

INLINE int is_arc(const swarf_column *c, int32_t track)
{
    return (c->kind[track] & TRACK_ARC) != 0;
}

INLINE struct sixteen load_tracks(const swarf_column *c, struct chosen chosen, int ball)
{
    float *const *f = c->field;
    struct sixteen t;
    t.base_x = chosen_field(f[COLUMN_X], chosen);
    t.base_y = chosen_field(f[COLUMN_Y], chosen);
    t.ux = chosen_field(f[COLUMN_UX], chosen);
    t.uy = chosen_field(f[COLUMN_UY], chosen);
    t.m = chosen_field(f[COLUMN_M], chosen);
    t.im = chosen_field(f[COLUMN_IM], chosen);
    t.z = chosen_field(f[COLUMN_Z], chosen);
    t.rise = chosen_field(f[COLUMN_RISE], chosen);
    t.s0 = chosen_field(f[COLUMN_S0], chosen);
    t.s1 = chosen_field(f[COLUMN_S1], chosen);
    t.is_arc = less(all(0), all(0));
    if (c->arcs) { /* their fields hold other things; what is left of a line's formulas must come to nothing */
        float arc[LANES];
        for (int k = 0; k < LANES; k++) arc[k] = is_arc(c, chosen.at[chosen.two ? k / HALF : k]) ? 1 : 0;
        t.is_arc = less(all(0.5f), load(arc));
        t.s0 = pick(t.is_arc, all(0), t.s0);
        t.s1 = pick(t.is_arc, all(0), t.s1);
    }
    if (ball) {
        t.dx = chosen_field(f[COLUMN_DX], chosen);
        t.dy = chosen_field(f[COLUMN_DY], chosen);
        t.dz = chosen_field(f[COLUMN_DZ], chosen);
        t.t0 = chosen_field(f[COLUMN_T0], chosen);
        t.t1 = chosen_field(f[COLUMN_T1], chosen);
    }
    return t;
}

INLINE lanes chosen_arcs(const swarf_column *c, struct chosen chosen, const struct block_lanes *b)
{
    if (chosen.two) {
        lanes side[2] = {all(0), all(0)};
        for (int k = 0; k < 2; k++)
            if (is_arc(c, chosen.at[k])) side[k] = arc_distance(c, chosen.at[k], b->x, b->y);
        return halves(side[0], side[1]);
    }
    float plan[LANES];
    for (int k = 0; k < LANES; k++)
        plan[k] = is_arc(c, chosen.at[k]) ? arc_distance(c, chosen.at[k], b->x, b->y)[0] : 0;
    return load(plan);
}

/* Place the tracks relative to the blocks. */
INLINE void face_blocks(const swarf_column *c, struct chosen chosen, const struct block_lanes *b, struct sixteen *t)
{
    t->x = b->x - t->base_x;
    t->y = b->y - t->base_y;
    t->s = t->x * t->ux + t->y * t->uy;
    t->w = t->y * t->ux - t->x * t->uy;
    t->line_s = t->s;
    t->arc = all(0);
    if (!c->arcs) return;
    t->arc = chosen_arcs(c, chosen, b);
    t->line_s = pick(t->is_arc, all(0), t->s);
}

INLINE void find_bounds(const swarf_body *body, const struct sixteen *t, const struct block_lanes *b,
                        struct shaft_bounds *bounds)
{
    const float reach = b->half * 1.41421357f; /* from the middle of a block to its vertical edges */
    if (body->kind == SWARF_BODY_BALL) {
        ball_bounds(body, t, b, reach, bounds);
    } else {
        shaft_least(t, b, reach, body->radius, body->z_lo, body->z_hi, bounds);
        shaft_most(t, b, reach, body->core_radius, body->core_lo, body->core_hi, bounds);
    }
}

/* What is known of one block while its list is made. */
struct culling {
    int32_t *out;
    float *bound, *floor;
    size_t kept, champion;
    float best, champion_floor;
};

/* The bounds of sixteen pairs of track and block, one by one. */
struct spread {
    float low[LANES], high[LANES], floor[LANES], ceiling[LANES];
};

INLINE void spread_bounds(const struct shaft_bounds *bounds, struct spread *spread)
{
    store(spread->low, bounds->least);
    store(spread->high, bounds->most);
    store(spread->floor, bounds->floor_least);
    store(spread->ceiling, pick(less(bounds->covers, all(-SWARF_HALF_WIDTH)), bounds->floor_most, all(far_away)));
}

INLINE void keep_track(struct culling *state, int32_t track, const struct spread *spread, int lane)
{
    state->out[state->kept] = track;
    state->bound[state->kept] = spread->low[lane];
    state->floor[state->kept] = spread->floor[lane];
    if (spread->ceiling[lane] < state->champion_floor) {
        state->champion_floor = spread->ceiling[lane];
        state->champion = state->kept;
    }
    state->kept++;
    state->best = spread->high[lane] < state->best ? spread->high[lane] : state->best;
}

/* Look at up to sixteen tracks; 1 when one of them covers the block. */
INLINE int cull_sixteen(const swarf_body *body, const swarf_column *c, struct chosen chosen, unsigned valid,
                        const swarf_block *b, struct sixteen *t, struct culling *state)
{
    const struct block_lanes here = {all(b->x), all(b->y), all(b->z), b->half, b->half_z};
    struct shaft_bounds bounds;
    struct spread spread;
    face_blocks(c, chosen, &here, t);
    find_bounds(body, t, &here, &bounds);
    if (bits(less(bounds.most, all(-SWARF_HALF_WIDTH))) & valid) return 1;
    unsigned keep = bits(less(bounds.least, all(SWARF_HALF_WIDTH))) & valid;
    if (!keep) return 0;
    spread_bounds(&bounds, &spread);
    for (; keep; keep &= keep - 1) {
        const int lane = __builtin_ctz(keep);
        keep_track(state, chosen.at[lane], &spread, lane);
    }
    return 0;
}

/* All tracks, sixteen at a time, block by block; returns which blocks are covered. */
INLINE unsigned cull_many(const swarf_body *body, const swarf_column *c, const int32_t *in, size_t count,
                          const swarf_block *blocks, size_t block_count, struct culling *state)
{
    unsigned covered = 0;
    for (size_t i = 0; i < count; i += LANES) {
        const unsigned valid = count - i >= LANES ? 0xffffu : (1u << (count - i)) - 1;
        const struct chosen chosen = {in + i, 0};
        struct sixteen t = load_tracks(c, chosen, body->kind == SWARF_BODY_BALL);
        for (size_t b = 0; b < block_count; b++)
            if (!(covered >> b & 1) && cull_sixteen(body, c, chosen, valid, &blocks[b], &t, &state[b]))
                covered |= 1u << b;
    }
    return covered;
}

/* The same for few tracks: all blocks at a time, two tracks in one go. */
INLINE unsigned cull_few(const swarf_body *body, const swarf_column *c, const int32_t *in, size_t count,
                         const swarf_block *blocks, size_t block_count, struct culling *state)
{
    const unsigned present = (1u << block_count) - 1;
    struct block_lanes here = {all(0), all(0), all(0), blocks[0].half, blocks[0].half_z};
    unsigned covered = 0;
    for (size_t i = 0; i < block_count; i++) {
        here.x[i] = here.x[i + HALF] = blocks[i].x;
        here.y[i] = here.y[i + HALF] = blocks[i].y;
        here.z[i] = here.z[i + HALF] = blocks[i].z;
    }
    for (size_t i = 0; i < count; i += 2) {
        const struct chosen chosen = {in + i, 1}; /* lists may be read beyond their end */
        const unsigned valid = i + 1 < count ? present | present << HALF : present;
        struct sixteen t = load_tracks(c, chosen, body->kind == SWARF_BODY_BALL);
        struct shaft_bounds bounds;
        struct spread spread;
        face_blocks(c, chosen, &here, &t);
        find_bounds(body, &t, &here, &bounds);
        const unsigned full = bits(less(bounds.most, all(-SWARF_HALF_WIDTH))) & valid;
        covered |= (full | full >> HALF) & present;
        if (covered == present) break;
        unsigned keep = bits(less(bounds.least, all(SWARF_HALF_WIDTH))) & valid & ~(covered | covered << HALF);
        if (count == 1) { /* nothing to compare it with */
            for (size_t b = 0; b < block_count; b++) {
                state[b].kept = keep >> b & 1;
                state[b].out[0] = in[0];
            }
            break;
        }
        if (keep) spread_bounds(&bounds, &spread);
        for (; keep; keep &= keep - 1) {
            const int lane = __builtin_ctz(keep);
            keep_track(&state[lane % HALF], in[i + (size_t)lane / HALF], &spread, lane);
        }
    }
    return covered;
}

/* A track that is everywhere farther than another one is anywhere does not matter; nor does, of cylinders, one whose
 * bottom is nowhere below that of another which covers the block from side to side. */
static size_t drop_dominated(const swarf_body *body, const struct culling *state)
{
    int32_t *out = state->out;
    size_t left = state->kept;
    if (left > 1) {
        const int flat = body->kind == SWARF_BODY_CYLINDER;
        left = 0;
        for (size_t i = 0; i < state->kept; i++) {
            const int matters = state->bound[i] <= state->best && !(flat && state->floor[i] >= state->champion_floor);
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
        state[b] = (struct culling){out[b], c->bound[b], c->floor[b], 0, SIZE_MAX, far_away, far_away};
    const unsigned covered = count <= block_count ? cull_few(body, c, in, count, blocks, block_count, state)
                                                  : cull_many(body, c, in, count, blocks, block_count, state);
    for (size_t b = 0; b < block_count; b++)
        if (!(covered >> b & 1)) out_count[b] = drop_dominated(body, &state[b]);
    return covered;
}

#endif
