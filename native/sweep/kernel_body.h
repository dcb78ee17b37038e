/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernels themselves; each kernel_<isa>.c defines KERNEL_NAME, sets its instruction set and includes this.
 *
 * Lanes are 4 x 4 columns of voxels (lane = 4 * x + y); what needs a square root depends on (x, y) only and is done
 * once for the eight voxels above each other, except where a track is tilted and the body general. */
#include "base/counts.h"
#include "sweep/kernel_cull.h"
#include "sweep/kernel_general.h"
#include "sweep/kernel_line.h"

/* ---- all tracks of a list ---------------------------------------------------------------------------------------- */

/* `voxels`: how many above each other are wanted, 8 or fewer; the others get any value. */
INLINE void distance_group(const swarf_body *body, const swarf_column *c, const int32_t *list, size_t count, lanes x,
                           lanes y, float z0, int voxels, lanes best[8])
{
    lanes squares[8];
    for (int z = 0; z < 8; z++) {
        best[z] = all(far_away);
        squares[z] = all(far_away);
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
            ball_line(body, c, i, x, y, z0, best, squares);
        } else {
            cylinder_line(body, c, i, x, y, z0, best);
        }
    }
    /* where no ball is within the band its root is not worth taking */
    const float reach = body->radius + SWARF_HALF_WIDTH;
    for (int z = 0; ball && z < 8; z++)
        if (bits(less(squares[z], all(reach * reach))))
            best[z] = minimum(best[z], root(maximum(squares[z], all(0))) - body->radius);
}

static const float lane_x[LANES] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
static const float lane_y[LANES] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};

static float distance(const swarf_body *body, const swarf_column *column, const int32_t *list, size_t count)
{
    lanes found[8];
    distance_group(body, column, list, count, all(0), all(0), 0, 1, found);
    return found[0][0];
}

/* What becomes of the leaf. Columns come in pairs: the eight voxels of one and those of the next in y. */
struct leaf_state {
    lanes least, most;
    lanes outside; /* the background */
    float *values;
    unsigned char *active; /* bits: within the background */
    int solid;             /* values were not set yet: all inside */
};

INLINE void put(struct leaf_state *state, int place, lanes value)
{
    const uint16_t within = (uint16_t)bits(less(magnitude(value), state->outside));
    store(state->values + place * 8, value);
    state->least = minimum(state->least, value);
    state->most = maximum(state->most, value);
    memcpy(state->active + place, &within, sizeof within);
}

/* Number in the leaf of the first column of pair 0 .. 7 of the group whose low corner is (gx, gy). */
INLINE int place_of_pair(int gx, int gy, int pair)
{
    return (gx + pair / 2) * 8 + gy + pair % 2 * 2;
}

INLINE lanes held(const struct leaf_state *state, int place, int solid)
{
    return solid ? all(0) - state->outside : load(state->values + place * 8);
}

INLINE void keep_group(struct leaf_state *state, int gx, int gy)
{
    for (int pair = 0; pair < 8; pair++) {
        const int place = place_of_pair(gx, gy, pair);
        put(state, place, held(state, place, state->solid));
    }
}

INLINE void remove_group(struct leaf_state *state, int gx, int gy)
{
    for (int pair = 0; pair < 8; pair++) put(state, place_of_pair(gx, gy, pair), state->outside);
}

/* values = max(values, -found). */
INLINE void merge_pairs(struct leaf_state *state, int gx, int gy, const lanes found[8], float voxel, int solid)
{
    for (int pair = 0; pair < 8; pair++) {
        const int place = place_of_pair(gx, gy, pair);
        put(state, place, maximum(held(state, place, solid), minimum(found[pair] * all(-voxel), state->outside)));
    }
}

/* `found`: eight layers of sixteen columns. */
INLINE void merge_group(struct leaf_state *state, int gx, int gy, lanes found[8], float voxel)
{
    stand_up(found);
    if (state->solid)
        merge_pairs(state, gx, gy, found, voxel, 1);
    else
        merge_pairs(state, gx, gy, found, voxel, 0);
}

/* Enough tracks that looking at each quarter of the leaf on its own pays. */
enum { FEW = 3 };

static int cut(const swarf_body *body, const swarf_column *c, const int32_t *list, size_t count, swarf_leaf_cut *leaf)
{
    unsigned char active[64];
    struct leaf_state state = {.least = all(leaf->background),
                               .most = all(-leaf->background),
                               .outside = all(leaf->background),
                               .values = leaf->values,
                               .active = active,
                               .solid = leaf->solid};
    int touched = 0;
    swarf_block blocks[4];
    for (int g = 0; g < 4; g++)
        blocks[g] = (swarf_block){leaf->x + (float)(g >> 1) * 4 + 1.5f, leaf->y + (float)(g & 1) * 4 + 1.5f,
                                  leaf->z + 3.5f, 1.5f, 3.5f};
    size_t left[4] = {count, count, count, count};
    const int each = count > FEW;
    const unsigned removed = each ? cull(body, c, list, count, blocks, 4, &c->list[LIST_GROUPS], left) : 0;
    for (int g = 0; g < 4; g++) {
        const int gx = (g >> 1) * 4, gy = (g & 1) * 4;
        if (removed >> g & 1) {
            remove_group(&state, gx, gy);
        } else if (left[g] == 0) {
            keep_group(&state, gx, gy);
            continue;
        } else {
            lanes found[8];
            distance_group(body, c, each ? c->list[LIST_GROUPS + g] : list, left[g],
                           load(lane_x) + (leaf->x + (float)gx), load(lane_y) + (leaf->y + (float)gy), leaf->z, 8,
                           found);
            merge_group(&state, gx, gy, found, leaf->voxel);
        }
        touched = 1;
    }
    if (!touched) return 0;
    memcpy(leaf->mask, active, sizeof active);
    leaf->least = least_lane(state.least);
    leaf->most = -least_lane(all(0) - state.most);
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

static void band(const float values[512], float background, uint64_t active[8])
{
    unsigned char rows[64];
    for (int place = 0; place < 64; place += 2) {
        const uint16_t within = (uint16_t)bits(less(magnitude(load(values + place * 8)), all(background)));
        memcpy(rows + place, &within, sizeof within);
    }
    memcpy(active, rows, sizeof rows);
}

/* Bits 0 and 1: whether a pair of rows differs from another. */
INLINE uint64_t pair_differs(lanes a, lanes b)
{
    const unsigned off = bits(meets((counts)a ^ (counts)b, all_counts(-1)));
    return (uint64_t)((off & 0xff) != 0) | (uint64_t)(off > 0xff) << 1;
}

static uint64_t rows_changed(const float before[512], const float after[512])
{
    uint64_t changed = 0;
    for (int place = 0; place < 64; place += 2)
        changed |= pair_differs(load(before + place * 8), load(after + place * 8)) << place;
    return changed;
}

static uint64_t rows_repeated(const float values[512])
{
    uint64_t other = 1;
    lanes last = load(values);
    for (int place = 0; place < 64; place += 2) {
        const lanes pair = load(values + place * 8);
        const lanes before =
            __builtin_shufflevector(last, pair, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23);
        other |= pair_differs(pair, before) << place;
        last = pair;
    }
    return ~other;
}

const swarf_kernel KERNEL_NAME = {cull, cut, distance, block, occupancy, band, rows_changed, rows_repeated};
