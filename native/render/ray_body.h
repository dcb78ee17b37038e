/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sixteen rays through the cubes of a grid; included once per instruction set.
 *
 * Each lane goes its own way: from cube to cube, in a cube from block to block of 4^3 cells, and from cell to cell in
 * the blocks that have some which stop it; over one plane at a time, so that nothing on its way is left out. Between
 * cubes that is done in double. Inside a cube coordinates relative to its corner are floats up to 32, good to 2e-6
 * voxels. When all lanes stand in cells that stop them or have left, the trilinear fields of those cells are
 * intersected side by side. What comes in between waits for memory: packets of a group take turns.
 */
#include "base/longs.h"
#include "render/ray_kernel.h"

#include <math.h>
#include <stddef.h>

/* A surface through voxel centres ends many cells in a value of about 0. What rounding leaves of it, relative to the
 * cubic's coefficients, counts as met; larger would make rays stop that graze at as many voxels. */
static const float slack = 1e-6f;
/* Roots are closed to this part of the way through a cell. */
static const float root_tolerance = 1e-6f;
/* Halvings that close any bracket to that; Newton's method needs two or three steps. */
enum { ROOT_STEPS = 20 };
/* Voxels: more than the rounding of a float coordinate in a layout of 2^16 voxels (4e-3). */
#define SWARF_CUBE_SLACK (1.0f / 64)

/* The rays of a packet on their way. Lanes that are left and in none of the other masks have been stopped. */
typedef struct flight {
    longs cube, slots, slot;      /* addresses: of the cube, its slots, and the one where the block is */
    doubles entered, hit_from;    /* where the ray came into the cube, along it; of the hits */
    lanes p[3], d[3], inverse[3]; /* p: where the ray came into the cube, from its corner */
    lanes t, reach;               /* from there */
    lanes apart[3];               /* t from one plane between cells to the next */
    counts up[3], way[3];         /* 1 and 1 where the direction is positive, else 0 and -1 */
    counts at[3], number;         /* the cube in the grid */
    counts block[3], cell[3];
    lanes next_block[3], next_cell[3]; /* t of the planes where they end */
    lanes next_cube[3], end;           /* along the ray: where that ends in the grid, about; how far to look */
    counts stops[2];                   /* of the block, in halves */
    lanes hit_t, slope[3];             /* of the hits: from hit_from, and the field's gradient */
    mask left, cells, blocks;          /* lanes on their way; in cells, in blocks */
    mask done, gone;                   /* out of their block, of their cube */
    mask hits;
    int in_cells; /* cells have their turn */
} flight;

typedef struct cells {
    lanes v[8];    /* corner values, number bits 4, 2, 1: x, y, z */
    lanes at[3];   /* entry in the cell, 0 .. 1 */
    lanes way[3];  /* from there to the exit */
    lanes t, span; /* of the entry, and to the exit */
} cells;

/* A cell's field as v0 + vx x + vy y + vz z + vxy x y + vyz y z + vxz x z + vxyz x y z. */
typedef struct field {
    lanes v0, vx, vy, vz, vxy, vyz, vxz, vxyz;
} field;

INLINE field expand(const lanes v[8])
{
    field f;
    f.v0 = v[0];
    f.vx = v[4] - v[0];
    f.vy = v[2] - v[0];
    f.vz = v[1] - v[0];
    f.vxy = v[6] - v[4] - f.vy;
    f.vyz = v[3] - v[2] - f.vz;
    f.vxz = v[5] - v[4] - f.vz;
    f.vxyz = (v[7] - v[6]) - (v[5] - v[4]) - f.vyz;
    return f;
}

INLINE void gradient(const field *f, const lanes q[3], lanes out[3])
{
    out[0] = f->vx + f->vxy * q[1] + f->vxz * q[2] + f->vxyz * q[1] * q[2];
    out[1] = f->vy + f->vxy * q[0] + f->vyz * q[2] + f->vxyz * q[0] * q[2];
    out[2] = f->vz + f->vxz * q[0] + f->vyz * q[1] + f->vxyz * q[0] * q[1];
}

INLINE lanes size(lanes a)
{
    return maximum(a, -a);
}

INLINE lanes cubic(const lanes c[4], lanes s)
{
    return ((c[3] * s + c[2]) * s + c[1]) * s + c[0];
}

/* Where in 0 .. 1 each cubic turns, in order, and its values there; of one that does not, 0 and 0. Few do: a face met
 * by a ray is steeper than it is bent. */
INLINE void find_turns(const lanes c[4], mask wanted, lanes at[2], lanes value[2])
{
    const lanes zero = all(0), one = all(1);
    /* The slope's Bernstein coefficients: between them the slope stays. */
    const lanes first = c[1], middle = c[1] + c[2], last = middle + c[2] + all(3) * c[3];
    const mask falls = less(maximum(first, maximum(middle, last)), zero);
    const mask rises = less(zero, minimum(first, minimum(middle, last)));
    const lanes a = all(3) * c[3], discriminant = c[2] * c[2] - a * c[1];
    const mask turns = both(except(wanted, either(falls, rises)), less(zero, discriminant));
    at[0] = at[1] = zero;
    value[0] = value[1] = c[0];
    if (!bits(turns)) return;
    const lanes spread = root(maximum(discriminant, zero));
    const lanes q = -(c[2] + pick(less(c[2], zero), -spread, spread));
    /* 0 / 0 and out of range give ends of the interval: minimum(NAN, x) is x. */
    const lanes r0 = clamped(q / a, zero, one), r1 = clamped(c[1] / q, zero, one);
    at[0] = pick(turns, minimum(r0, r1), zero);
    at[1] = pick(turns, maximum(r0, r1), zero);
    for (int i = 0; i < 2; i++) value[i] = pick(turns, cubic(c, at[i]), c[0]);
}

/* First s in 0 .. 1 where each cubic falls below 0, for the lanes `wanted`; returns those that have one. Splits at the
 * extrema into monotone intervals (G. Marmitt et al.: Fast and Accurate Ray-Voxel Intersection Techniques for
 * Iso-Surface Ray Tracing, VMV 2004), then Newton's method held inside the bracket. A lane that has arrived stays. */
INLINE mask first_root(const lanes c[4], mask wanted, lanes *root_out)
{
    const lanes zero = all(0), one = all(1);
    const mask inside = less(c[0], zero);
    lanes e[2], f[2];
    find_turns(c, wanted, e, f);
    const lanes end = ((c[3] + c[2]) + c[1]) + c[0];
    const lanes magnitude = size(c[0]) + size(c[1]) + size(c[2]) + size(c[3]);
    const mask in0 = less(f[0], zero), in1 = less(f[1], zero), in2 = less(end, zero);
    const mask touch = both(less(end, all(slack) * magnitude), less(end, f[1]));
    const mask found = both(wanted, either(either(inside, in0), either(in1, either(in2, touch))));
    lanes lo = pick(in0, zero, pick(in1, e[0], e[1])), hi = pick(in0, e[0], pick(in1, e[1], one));
    const lanes f_lo = pick(in0, c[0], pick(in1, f[0], f[1])), f_hi = pick(in0, f[0], pick(in1, f[1], end));
    lanes s = lo + (hi - lo) * (f_lo / (f_lo - f_hi));
    /* A cubic that only touches ends its interval. */
    const mask search = except(both(found, either(in0, either(in1, in2))), inside);
    mask going = search;
    for (int step = 0; step < ROOT_STEPS && bits(going); step++) {
        const lanes value = cubic(c, s), bend = all(3) * c[3] * s + c[2], slope = (bend + c[2]) * s + c[1];
        const mask below = less(value, zero);
        hi = pick(both(going, below), s, hi);
        lo = pick(except(going, below), s, lo);
        const lanes newton = s - value / slope, middle = all(0.5f) * (lo + hi);
        const mask held = both(less(lo - all(root_tolerance), newton), less(newton, hi + all(root_tolerance)));
        const lanes next = pick(held, clamped(newton, lo, hi), middle);
        const lanes moved = size(next - s);
        s = pick(going, next, s);
        /* What Newton's method leaves is the square of its step times bend / slope, about; the bend changes on the way.
         */
        const lanes bent = size(bend) + size(c[3]) * moved;
        const mask near = both(held, less(moved * moved * bent, all(root_tolerance) * size(slope)));
        going = both(except(going, near), less(all(root_tolerance), moved));
    }
    *root_out = pick(inside, zero, pick(search, s, one));
    return found;
}

/* Corner values of the cells where lanes `wanted` stand, in slots at these addresses; those of the others are 1. A pair
 * of values side by side along z goes as one. */
INLINE void load_corners(unsigned wanted, const int64_t slot[LANES], const counts cell[3], lanes v[8])
{
    float pairs[4][2 * LANES] __attribute__((aligned(64)));
    int32_t which[4][LANES] __attribute__((aligned(64))), place[4][LANES] __attribute__((aligned(64)));
    const counts seven = all_counts(7), z = cell[2] & seven, low = least(z, all_counts(6));
    for (int pair = 0; pair < 4; pair++) {
        const counts x = (cell[0] & seven) + (pair >> 1), y = (cell[1] & seven) + (pair & 1);
        store_counts(which[pair], (x >> 3 << 2) + (y >> 3 << 1));
        store_counts(place[pair], ((x & seven) << 6) + ((y & seven) << 3) + low);
        store(pairs[pair], all(1));
        store(pairs[pair] + LANES, all(1));
    }
    for (unsigned left = wanted; left; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        const swarf_cube_slot *own = (const swarf_cube_slot *)(uintptr_t)slot[lane];
        for (int pair = 0; pair < 4; pair++)
            memcpy(&pairs[pair][2 * lane], own->values[which[pair][lane]] + place[pair][lane], 2 * sizeof(float));
    }
    /* Pairs of which one value lies in the next slot. */
    for (unsigned left = wanted & ~bits(less(to_lanes(z), all(7))); left; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        const swarf_cube_slot *own = (const swarf_cube_slot *)(uintptr_t)slot[lane];
        for (int pair = 0; pair < 4; pair++) {
            pairs[pair][2 * lane] = pairs[pair][2 * lane + 1];
            pairs[pair][2 * lane + 1] = own->values[which[pair][lane] | 1][place[pair][lane] - 6];
        }
    }
    for (int pair = 0; pair < 4; pair++) {
        const lanes a = load(pairs[pair]), b = load(pairs[pair] + LANES);
        v[2 * pair] = __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
        v[2 * pair + 1] = __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
    }
}

/* Intersect the cells; returns the lanes hit, with t and gradient there. */
INLINE mask intersect_cells(const cells *cell, mask wanted, lanes *t, lanes slope[3])
{
    const field f = expand(cell->v);
    const lanes *p = cell->at, *d = cell->way;
    lanes at_entry[3], c[4], s, q[3];
    gradient(&f, p, at_entry);
    c[0] = f.v0 + f.vx * p[0] + p[1] * (f.vy + f.vxy * p[0]) +
           p[2] * (f.vz + f.vxz * p[0] + p[1] * (f.vyz + f.vxyz * p[0]));
    c[1] = d[0] * at_entry[0] + d[1] * at_entry[1] + d[2] * at_entry[2];
    c[2] = d[0] * d[1] * (f.vxy + f.vxyz * p[2]) + d[1] * d[2] * (f.vyz + f.vxyz * p[0]) +
           d[0] * d[2] * (f.vxz + f.vxyz * p[1]);
    c[3] = d[0] * d[1] * d[2] * f.vxyz;
    const mask found = first_root(c, wanted, &s);
    for (int axis = 0; axis < 3; axis++) q[axis] = p[axis] + s * d[axis];
    gradient(&f, q, slope);
    *t = cell->t + s * cell->span;
    return found;
}

/* The lanes of `going` that cross a plane of each axis first; of several at once the first axis is it, whatever
 * rounding says of the place there. Returns where. */
INLINE lanes find_first(const lanes next[3], mask going, mask crosses[3])
{
    const lanes here = minimum(next[0], minimum(next[1], next[2]));
    for (int axis = 0; axis < 3; axis++) {
        const mask later = less(here, next[axis]);
        crosses[axis] = except(going, later);
        going = both(going, later);
    }
    return here;
}

/* Take lanes `going` over the next plane between cells; those that leave their block are done with it. */
INLINE void step_cells(flight *f, mask going)
{
    mask crosses[3];
    const lanes here = find_first(f->next_cell, going, crosses);
    counts away = all_counts(0);
    for (int axis = 0; axis < 3; axis++) {
        f->cell[axis] = pick_counts(crosses[axis], f->cell[axis] + f->way[axis], f->cell[axis]);
        f->next_cell[axis] = pick(crosses[axis], f->next_cell[axis] + f->apart[axis], f->next_cell[axis]);
        away |= (f->cell[axis] >> 2) ^ f->block[axis];
    }
    f->t = pick(going, maximum(f->t, here), f->t);
    const mask out = both(going, meets(away, all_counts(-1)));
    f->done = either(f->done, out);
    f->cells = except(going, out);
}

/* Walk until every lane in cells has been stopped or is done with its block. */
INLINE void walk_cells(flight *f)
{
    const counts three = all_counts(3), one = all_counts(1);
    while (bits(f->cells)) {
        const counts place = ((f->cell[0] & 1) << 4) | ((f->cell[1] & three) << 2) | (f->cell[2] & three);
        const counts word = pick_counts(meets(f->cell[0], one + one), f->stops[1], f->stops[0]);
        step_cells(f, except(f->cells, meets(word >> place, one)));
    }
}

/* Begin with the cells of the blocks where lanes `full` are. */
INLINE void enter_cells(flight *f, mask full)
{
    const counts one = all_counts(1), *b = f->block;
    const counts number = ((b[0] >> 1) << 4) + ((b[1] >> 1) << 2) + (b[2] >> 1);
    const counts sub = ((b[0] & one) << 2) + ((b[1] & one) << 1) + (b[2] & one);
    const counts place = gather_far(full, f->cube + (widen(number) + (int64_t)offsetof(swarf_cube, place))) & 255;
    const longs slot = f->slots + widen(place * (int32_t)sizeof(swarf_cube_slot));
    const longs stops = gather_longs(full, slot + widen(sub << 3));
    f->slot = pick_longs(full, slot, f->slot);
    f->stops[0] = pick_counts(full, shorten(stops), f->stops[0]);
    f->stops[1] = pick_counts(full, shorten(stops >> 32), f->stops[1]);
    for (int axis = 0; axis < 3; axis++) {
        const counts low = b[axis] << 2, cell = to_counts(f->p[axis] + f->t * f->d[axis]);
        const counts here = least(greatest(cell, low), low + all_counts(3));
        const lanes next = (to_lanes(here + f->up[axis]) - f->p[axis]) * f->inverse[axis];
        f->cell[axis] = pick_counts(full, here, f->cell[axis]);
        f->next_cell[axis] = pick(full, next, f->next_cell[axis]);
    }
    f->cells = either(f->cells, full);
}

/* One step of the lanes in blocks: into the cells of those that have some to stop them, else to the next block. */
INLINE void walk_blocks(flight *f)
{
    const counts word = (f->block[0] << 3) + (f->block[1] & 4);
    const counts bit = all_counts(1) << (((f->block[1] & 3) << 3) + f->block[2]);
    const mask full = both(f->blocks, meets(gather_far(f->blocks, f->cube + widen(word)), bit));
    if (bits(full)) enter_cells(f, full);
    const mask going = either(except(f->blocks, full), f->done);
    mask crosses[3];
    const lanes here = find_first(f->next_block, going, crosses);
    for (int axis = 0; axis < 3; axis++) {
        const lanes next = f->next_block[axis] + all(4) * f->apart[axis];
        f->block[axis] = pick_counts(crosses[axis], f->block[axis] + f->way[axis], f->block[axis]);
        f->next_block[axis] = pick(crosses[axis], next, f->next_block[axis]);
    }
    f->t = pick(going, maximum(f->t, here), f->t);
    const counts all_of = f->block[0] | f->block[1] | f->block[2];
    const mask out = both(going, either(less(f->reach, f->t), meets(all_of, all_counts(~(SWARF_CUBE_BLOCKS - 1)))));
    f->gone = either(f->gone, out);
    f->blocks = except(going, out);
    f->done = mask_of(0);
}

INLINE counts corner_of(counts at)
{
    return (at - all_counts(SWARF_CUBES_BELOW)) << SWARF_CUBE_SHIFT;
}

/* Take lanes `going` over the next plane between cubes; returns those that may stay within their reach. */
INLINE mask step_cubes(const swarf_cube_grid *grid, flight *f, mask going)
{
    const int32_t stride[3] = {grid->count[1] * grid->count[2], grid->count[2], 1};
    mask crosses[3];
    const lanes here = find_first(f->next_cube, going, crosses);
    for (int axis = 0; axis < 3; axis++) {
        const lanes next = f->next_cube[axis] + all(SWARF_CUBE_CELLS) * f->apart[axis];
        f->at[axis] = pick_counts(crosses[axis], f->at[axis] + f->way[axis], f->at[axis]);
        f->number = pick_counts(crosses[axis], f->number + f->way[axis] * stride[axis], f->number);
        f->next_cube[axis] = pick(crosses[axis], next, f->next_cube[axis]);
    }
    return both(going, less(here, f->end));
}

/* Clip lanes `there` to the cells of their cubes that stop rays: where they come in and how much further they go, both
 * in voxels along them, and where that is in the cube. Returns those that come in. */
INLINE mask clip(const swarf_packet *rays, flight *f, mask there, longs cube)
{
    const longs bounds = gather_longs(there, cube + (int64_t)offsetof(swarf_cube, lo));
    const counts corner = shorten(bounds), above = shorten(bounds >> 32), byte = all_counts(255);
    const counts lo[3] = {corner & byte, corner >> 8 & byte, corner >> 16 & byte};
    const counts hi[3] = {above & byte, above >> 8 & byte, above >> 16 & byte};
    doubles enter = all_doubles(0), leave = load_doubles(rays->t);
    for (int axis = 0; axis < 3; axis++) {
        const doubles o = load_doubles(rays->origin[axis]), inverse = load_doubles(rays->inverse[axis]);
        const counts from = corner_of(f->at[axis]);
        const doubles a = (widen_counts(from + lo[axis]) - o) * inverse;
        const doubles b = (widen_counts(from + hi[axis]) - o) * inverse;
        enter = larger(enter, lesser(a, b));
        leave = lesser(leave, larger(a, b));
    }
    const mask in = both(there, mask_of(up_to(enter, leave)));
    if (!bits(in)) return in;
    f->entered = pick_doubles(in, enter, f->entered);
    f->reach = pick(in, narrow(leave - enter), f->reach);
    f->t = pick(in, all(0), f->t);
    for (int axis = 0; axis < 3; axis++) {
        const doubles from = load_doubles(rays->origin[axis]) - widen_counts(corner_of(f->at[axis]));
        /* Rounding must not push it out. */
        const lanes p =
            clamped(narrow(from + enter * load_doubles(rays->direction[axis])), to_lanes(lo[axis]), to_lanes(hi[axis]));
        const counts block = least(to_counts(p), hi[axis] - all_counts(1)) >> 2;
        const lanes next = (to_lanes((block + f->up[axis]) << 2) - p) * f->inverse[axis];
        f->p[axis] = pick(in, p, f->p[axis]);
        f->block[axis] = pick_counts(in, block, f->block[axis]);
        f->next_block[axis] = pick(in, next, f->next_block[axis]);
    }
    return in;
}

/* Go on from cube to cube (`stand`: from the one where they stand) until each lane is in one that may stop it, or has
 * no further to go. */
static __attribute__((noinline)) void find_cubes(const swarf_cube_grid *grid, const swarf_packet *rays, flight *f,
                                                 mask going, int stand)
{
    mask found = mask_of(0);
    f->left = except(f->left, going);
    f->gone = mask_of(0);
    if (!stand) going = step_cubes(grid, f, going);
    while (bits(going)) {
        mask some = mask_of(0);
        longs there = f->cube;
        /* Until all are in cubes: they are clipped to them together. */
        for (mask rest = going; bits(rest); rest = step_cubes(grid, f, rest)) {
            const longs place = address_of(grid->cube) + widen(f->number) * (int64_t)sizeof *grid->cube;
            const longs cube = gather_longs(rest, place);
            const mask is_cube = both(rest, is_set(cube));
            there = pick_longs(is_cube, cube, there);
            some = either(some, is_cube);
            rest = except(rest, is_cube);
            if (!bits(rest)) break;
        }
        if (!bits(some)) break;
        const mask in = clip(rays, f, some, there);
        f->cube = pick_longs(in, there, f->cube);
        found = either(found, in);
        going = except(some, in);
        if (bits(going)) going = step_cubes(grid, f, going);
    }
    f->slots = pick_longs(found, gather_longs(found, f->cube + (int64_t)offsetof(swarf_cube, slots)), f->slots);
    f->left = either(f->left, found);
    f->blocks = found;
}

/* Start in the cubes where the rays' origins lie, or beside them: the lanes then go on at once. */
INLINE void start(const swarf_cube_grid *grid, const swarf_packet *rays, flight *f, unsigned active)
{
    const counts one = all_counts(1), zero = all_counts(0);
    f->number = zero;
    for (int axis = 0; axis < 3; axis++) {
        const doubles o = load_doubles(rays->origin[axis]), inverse = load_doubles(rays->inverse[axis]);
        f->d[axis] = narrow(load_doubles(rays->direction[axis]));
        f->inverse[axis] = narrow(inverse);
        f->apart[axis] = size(f->inverse[axis]);
        f->up[axis] = pick_counts(less(all(0), f->d[axis]), one, zero);
        f->way[axis] = f->up[axis] + f->up[axis] - one;
        const counts at = to_counts(narrow(o) + all(SWARF_CUBES_BELOW * SWARF_CUBE_CELLS)) >> SWARF_CUBE_SHIFT;
        f->at[axis] = least(greatest(at, one), all_counts(grid->count[axis] - 2));
        f->number = f->number * grid->count[axis] + f->at[axis];
        f->next_cube[axis] = narrow((widen_counts(corner_of(f->at[axis] + f->up[axis])) - o) * inverse);
        f->p[axis] = f->slope[axis] = f->next_block[axis] = f->next_cell[axis] = all(0);
        f->cell[axis] = f->block[axis] = zero;
    }
    /* Rounding of the float to which planes between cubes are known must not end a ray. */
    f->end = narrow(load_doubles(rays->t)) + all(SWARF_CUBE_SLACK);
    f->t = f->reach = all(0);
    f->stops[0] = f->stops[1] = zero;
    f->entered = f->hit_from = all_doubles(0);
    f->hit_t = all(INFINITY);
    f->cube = f->slots = f->slot = address_of(NULL);
    f->left = f->cells = f->blocks = f->done = f->hits = mask_of(0);
    f->in_cells = 0;
    find_cubes(grid, rays, f, mask_of(active), 1);
}

/* The lanes' next step; 0 when none walks any more. They change together between cells, blocks and cubes, so that few
 * wait for the others. */
INLINE int walk(const swarf_cube_grid *grid, const swarf_packet *rays, flight *f)
{
    if (f->in_cells) walk_cells(f);
    f->in_cells = 0;
    if (bits(either(f->blocks, f->done)))
        walk_blocks(f);
    else if (bits(f->gone))
        find_cubes(grid, rays, f, f->gone, 0);
    else
        f->in_cells = bits(f->cells) != 0;
    return f->in_cells || bits(either(either(f->blocks, f->done), f->gone));
}

/* Intersect the cells where lanes have been stopped, and take those that miss on. */
INLINE void solve(flight *f)
{
    int64_t slot[LANES] __attribute__((aligned(64)));
    cells here;
    lanes at_t, at_slope[3];
    memcpy(slot, &f->slot, sizeof slot);
    load_corners(bits(f->left), slot, f->cell, here.v);
    const lanes exit = minimum(f->next_cell[0], minimum(f->next_cell[1], f->next_cell[2]));
    here.t = f->t;
    here.span = maximum(exit - f->t, all(0));
    for (int axis = 0; axis < 3; axis++) {
        here.at[axis] = (f->p[axis] - to_lanes(f->cell[axis])) + f->t * f->d[axis];
        here.way[axis] = f->d[axis] * here.span;
    }
    const mask found = intersect_cells(&here, f->left, &at_t, at_slope);
    f->hit_t = pick(found, at_t, f->hit_t);
    f->hit_from = pick_doubles(found, f->entered, f->hit_from);
    for (int axis = 0; axis < 3; axis++) f->slope[axis] = pick(found, at_slope[axis], f->slope[axis]);
    f->hits = either(f->hits, found);
    f->left = except(f->left, found);
    if (!bits(f->left)) return;
    step_cells(f, f->left);
    f->in_cells = 1;
}

/* Hits and normals of one packet. */
INLINE unsigned finish(const flight *f, swarf_packet *rays)
{
    const lanes *slope = f->slope;
    const lanes square = slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2];
    const mask flat = less(square, all(1e-30f)); /* no gradient: face the ray */
    const lanes scale = all(1) / root(square);
    const doubles t = f->hit_from + widen_lanes(f->hit_t), limit = load_doubles(rays->t);
    for (int axis = 0; axis < 3; axis++) store(rays->normal[axis], pick(flat, -f->d[axis], slope[axis] * scale));
    store_doubles(rays->t, t);
    return bits(f->hits) & up_to(t, limit);
}

static void trace(const swarf_cube_grid *grid, swarf_packet rays[], unsigned active[], int count)
{
    flight flights[SWARF_GROUP];
    for (int k = 0; k < count; k++) {
        flights[k].left = mask_of(0);
        if (active[k]) start(grid, &rays[k], &flights[k], active[k]);
    }
    for (;;) {
        unsigned busy, left = 0;
        do {
            busy = 0;
            for (int k = 0; k < count; k++)
                if (bits(flights[k].left)) busy |= (unsigned)walk(grid, &rays[k], &flights[k]);
        } while (busy);
        for (int k = 0; k < count; k++) left |= bits(flights[k].left);
        if (!left) break;
        for (int k = 0; k < count; k++)
            if (bits(flights[k].left)) solve(&flights[k]);
    }
    for (int k = 0; k < count; k++)
        if (active[k]) active[k] = finish(&flights[k], &rays[k]);
}

static void signs(const float values[512], uint64_t words[8])
{
    for (int x = 0; x < 8; x++) {
        words[x] = 0;
        for (int part = 0; part < 4; part++)
            words[x] |= (uint64_t)bits(less(load(values + x * 64 + part * LANES), all(0))) << (part * LANES);
    }
}

static void aim(const swarf_ray_source *source, const double x_of[LANES], const double y_of[LANES], swarf_rays *out)
{
    const doubles x = load_doubles(x_of), y = load_doubles(y_of);
    doubles square = all_doubles(0), from[3], way[3];
    for (int axis = 0; axis < 3; axis++) {
        const doubles eye = all_doubles(source->eye[axis]), forward = all_doubles(source->forward[axis]);
        const doubles aside = x * all_doubles(source->right[axis]) + y * all_doubles(source->up[axis]);
        from[axis] = source->parallel ? eye + aside : eye;
        way[axis] = source->parallel ? forward : forward + aside;
        square += way[axis] * way[axis];
    }
    const doubles scale = all_doubles(1) / root_doubles(square);
    for (int axis = 0; axis < 3; axis++) {
        const doubles d = way[axis] * scale;
        store_doubles(out->direction[axis], d);
        store_doubles(out->origin[axis], from[axis] - all_doubles(source->back) * d);
    }
    store_doubles(out->reach, all_doubles(INFINITY));
    out->active = (1u << LANES) - 1;
}

static unsigned enter(const swarf_ray_space *space, const swarf_rays *rays, swarf_packet *out, double moved_of[LANES])
{
    const doubles tiny = all_doubles(SWARF_RAY_LEAST), scale = all_doubles(1 / space->voxel);
    const doubles reach = load_doubles(rays->reach) * scale;
    doubles moved = all_doubles(0), leave = reach, from[3], way[3];
    for (int axis = 0; axis < 3; axis++) {
        const doubles given = load_doubles(rays->direction[axis]);
        const doubles d = with_sign(larger(larger(given, -given), tiny), given), inverse = all_doubles(1) / d;
        const doubles o = (load_doubles(rays->origin[axis]) - all_doubles(space->origin[axis])) * scale;
        const doubles a = (all_doubles(space->lo[axis]) - o) * inverse,
                      b = (all_doubles(space->hi[axis]) - o) * inverse;
        from[axis] = o;
        way[axis] = d;
        moved = larger(moved, lesser(a, b));
        leave = lesser(leave, larger(a, b) + all_doubles(SWARF_RAY_SLACK));
        store_doubles(out->direction[axis], d);
        store_doubles(out->inverse[axis], inverse);
    }
    for (int axis = 0; axis < 3; axis++) {
        /* Rounding must not push the origin out of the box by which cubes at its rim are found. */
        const doubles at = from[axis] + moved * way[axis];
        store_doubles(out->origin[axis],
                      lesser(larger(at, all_doubles(space->lo[axis])), all_doubles(space->hi[axis])));
    }
    store_doubles(out->t, leave - moved);
    store_doubles(moved_of, moved);
    return up_to(moved, leave) & rays->active;
}

const swarf_ray_kernel KERNEL_NAME = {aim, enter, trace, signs, shade, encode, encode_opaque};
