/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sixteen rays through one cube; included once per instruction set.
 *
 * The rays' way to the cube is computed in double; inside, coordinates relative to its corner are floats below 32, good
 * to 2e-6 voxels. Each lane stands in a cell and goes on by the largest empty block around it: a slot (8 cells), a
 * sub-block (4) or the cell itself. Planes are met at (plane - origin) / direction, the same expression whichever side
 * asks, so that the pieces of a ray in neighbouring cells join without a gap. When all lanes stand in cells that stop
 * them or have left, the trilinear fields of those cells are intersected side by side.
 */
#include "render/ray_kernel.h"
#include "sweep/counts.h"
#include "sweep/doubles.h"

#include <math.h>

/* A surface through voxel centres ends many cells in a value of about 0. What rounding leaves of it, relative to the
 * cubic's coefficients, counts as met; larger would make rays stop that graze at as many voxels. */
static const float slack = 1e-6f;
/* Roots are closed to this part of the way through a cell. */
static const float root_tolerance = 1e-6f;
/* Halvings that close any bracket to that; Newton's method needs two or three steps. */
enum { ROOT_STEPS = 20 };

typedef struct sight {
    lanes p[3], d[3], inverse[3];
    counts up[3]; /* 1 where the direction is positive, else 0 */
} sight;

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

/* First s in 0 .. 1 where each cubic falls below 0, for the lanes `wanted`; returns those that have one. Splits at the
 * extrema into monotone intervals (G. Marmitt et al.: Fast and Accurate Ray-Voxel Intersection Techniques for
 * Iso-Surface Ray Tracing, VMV 2004), then Newton's method held inside the bracket. A lane that has arrived stays. */
INLINE mask first_root(const lanes c[4], mask wanted, lanes *root_out)
{
    const lanes zero = all(0), one = all(1);
    const mask inside = less(c[0], zero);
    const lanes a = all(3) * c[3], discriminant = c[2] * c[2] - a * c[1];
    const lanes spread = root(maximum(discriminant, zero));
    const lanes q = -(c[2] + pick(less(c[2], zero), -spread, spread));
    /* 0 / 0 and out of range give ends of the interval: minimum(NAN, x) is x. */
    const lanes r0 = clamped(q / a, zero, one), r1 = clamped(c[1] / q, zero, one);
    const mask real = less(zero, discriminant);
    const lanes e0 = pick(real, minimum(r0, r1), zero), e1 = pick(real, maximum(r0, r1), zero);
    const lanes f0 = cubic(c, e0), f1 = cubic(c, e1), f2 = ((c[3] + c[2]) + c[1]) + c[0];
    const lanes magnitude = size(c[0]) + size(c[1]) + size(c[2]) + size(c[3]);
    const mask in0 = less(f0, zero), in1 = less(f1, zero), in2 = less(f2, zero);
    const mask touch = both(less(f2, all(slack) * magnitude), less(f2, f1));
    const mask found = both(wanted, either(either(inside, in0), either(in1, either(in2, touch))));
    lanes lo = pick(in0, zero, pick(in1, e0, e1)), hi = pick(in0, e0, pick(in1, e1, one));
    const lanes f_lo = pick(in0, c[0], pick(in1, f0, f1)), f_hi = pick(in0, f0, pick(in1, f1, f2));
    lanes s = lo + (hi - lo) * (f_lo / (f_lo - f_hi));
    /* A cubic that only touches ends its interval. */
    const mask search = except(both(found, either(in0, either(in1, in2))), inside);
    mask going = search;
    for (int step = 0; step < ROOT_STEPS && bits(going); step++) {
        const lanes f = cubic(c, s), slope = (a * s + all(2) * c[2]) * s + c[1];
        const mask below = less(f, zero);
        hi = pick(both(going, below), s, hi);
        lo = pick(except(going, below), s, lo);
        const lanes newton = s - f / slope, middle = all(0.5f) * (lo + hi);
        const mask held = both(less(lo - all(root_tolerance), newton), less(newton, hi + all(root_tolerance)));
        const lanes next = pick(held, clamped(newton, lo, hi), middle);
        const lanes moved = size(next - s);
        s = pick(going, next, s);
        going = both(going, less(all(root_tolerance), moved));
    }
    *root_out = pick(inside, zero, pick(search, s, one));
    return found;
}

/* Corner values of the cells where lanes `wanted` stand; the others keep what is there. */
INLINE void load_corners(const swarf_cube *cube, unsigned wanted, const int32_t slot[LANES], const int32_t at[3][LANES],
                         float v[8][LANES])
{
    /* The values lie all over the memory: ask for all of them before waiting for the first. */
    for (unsigned left = wanted; left; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        const int place = (at[0][lane] & 7) << 6 | (at[1][lane] & 7) << 3 | (at[2][lane] & 7);
        __builtin_prefetch(cube->own[slot[lane]] + place);
        __builtin_prefetch(cube->own[slot[lane]] + place + 64);
    }
    for (unsigned left = wanted; left; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        const int x = at[0][lane] & 7, y = at[1][lane] & 7, z = at[2][lane] & 7;
        if (x < 7 && y < 7 && z < 7) {
            const float *low = cube->own[slot[lane]] + (x << 6 | y << 3 | z);
            v[0][lane] = low[0];
            v[1][lane] = low[1];
            v[2][lane] = low[8];
            v[3][lane] = low[9];
            v[4][lane] = low[64];
            v[5][lane] = low[65];
            v[6][lane] = low[72];
            v[7][lane] = low[73];
            continue;
        }
        const swarf_cube_slot *own = &cube->slots[slot[lane]];
        for (int pair = 0; pair < 4; pair++) {
            const int px = x + (pair >> 1), py = y + (pair & 1), which = (px >> 3) << 2 | (py >> 3) << 1;
            const int place = (px & 7) << 6 | (py & 7) << 3;
            v[2 * pair][lane] = own->values[which][place | z];
            v[2 * pair + 1][lane] = z < 7 ? own->values[which][place | (z + 1)] : own->values[which | 1][place];
        }
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

/* Clip the rays to the cells of the cube: where they come in and how much further they go, both in voxels along them,
 * and where that is in the cube. */
INLINE unsigned clip(const swarf_cube *cube, const swarf_packet *rays, unsigned active, double enter_of[LANES],
                     lanes local[3], lanes *reach)
{
    doubles enter = all_doubles(0), leave = load_doubles(rays->t);
    for (int axis = 0; axis < 3; axis++) {
        const doubles o = load_doubles(rays->origin[axis]), inverse = load_doubles(rays->inverse[axis]);
        const doubles a = (all_doubles(cube->corner[axis] + cube->lo[axis]) - o) * inverse;
        const doubles b = (all_doubles(cube->corner[axis] + cube->hi[axis]) - o) * inverse;
        enter = larger(enter, lesser(a, b));
        leave = lesser(leave, larger(a, b));
    }
    const unsigned met = up_to(enter, leave) & active;
    if (!met) return 0;
    for (int axis = 0; axis < 3; axis++) {
        const doubles o = load_doubles(rays->origin[axis]), d = load_doubles(rays->direction[axis]);
        const doubles at = (o - all_doubles(cube->corner[axis])) + enter * d;
        /* Rounding must not push it out. */
        local[axis] = clamped(narrow(at), all(cube->lo[axis]), all(cube->hi[axis]));
    }
    *reach = narrow(leave - enter);
    store_doubles(enter_of, enter);
    return met;
}

/* Cells (0 .. 31) in which the lanes stand at t: not outside lo .. hi. */
INLINE counts cell_at(const sight *ray, int axis, lanes t, counts lo, counts hi)
{
    return least(greatest(to_counts(ray->p[axis] + t * ray->d[axis]), lo), hi);
}

/* Take lanes `going` out of blocks of 1 << shift cells, to the next cell; t becomes where that begins. */
INLINE void advance(const sight *ray, mask going, counts shift, counts cell[3], lanes *t)
{
    counts base[3];
    lanes at[3];
    const counts one = all_counts(1);
    for (int axis = 0; axis < 3; axis++) {
        base[axis] = cell[axis] >> shift;
        at[axis] = (to_lanes((base[axis] + ray->up[axis]) << shift) - ray->p[axis]) * ray->inverse[axis];
        base[axis] = base[axis] << shift;
    }
    const lanes next = minimum(at[0], minimum(at[1], at[2]));
    const lanes here = maximum(*t, next);
    const counts last = (one << shift) - one;
    mask free = going;
    for (int axis = 0; axis < 3; axis++) {
        /* The first axis to reach its plane steps over it, whatever rounding says of the place there. */
        const mask later = less(next, at[axis]);
        const mask crosses = except(free, later);
        free = both(free, later);
        const counts over = base[axis] + pick_counts(meets(ray->up[axis], one), one << shift, all_counts(-1));
        const counts within = cell_at(ray, axis, here, base[axis], base[axis] + last);
        cell[axis] = pick_counts(crosses, over, pick_counts(going, within, cell[axis]));
    }
    *t = pick(going, here, *t);
}

static unsigned trace(const swarf_cube *cube, uint32_t number, swarf_packet *rays, unsigned active)
{
    double enter[LANES] __attribute__((aligned(64)));
    float v[8][LANES] __attribute__((aligned(64)));
    sight ray;
    lanes reach;
    active = clip(cube, rays, active, enter, ray.p, &reach);
    if (!active) return 0;

    counts cell[3], low[3], high[3];
    const counts one = all_counts(1);
    for (int axis = 0; axis < 3; axis++) {
        ray.d[axis] = narrow(load_doubles(rays->direction[axis]));
        ray.inverse[axis] = narrow(load_doubles(rays->inverse[axis]));
        ray.up[axis] = pick_counts(less(all(0), ray.d[axis]), one, all_counts(0));
        low[axis] = all_counts(cube->lo[axis]);
        high[axis] = all_counts(cube->hi[axis] - 1);
        cell[axis] = cell_at(&ray, axis, all(0), low[axis], high[axis]);
    }
    const int32_t *const words = (const int32_t *)(const void *)cube->slots;
    enum { SLOT_WORDS = sizeof(swarf_cube_slot) / sizeof(int32_t) };
    lanes t = all(0), hit_t = all(INFINITY), slope[3] = {all(0), all(0), all(0)};
    mask hits = mask_of(0), left = mask_of(active);
    for (int lane_value = 0; lane_value < 8; lane_value++) store(v[lane_value], all(1)); /* of idle lanes */

    while (bits(left)) {
        /* Walk on until every lane that is left stands in a cell that stops it. */
        mask going = left;
        counts slot = all_counts(0);
        for (;;) {
            const counts index = ((cell[0] >> 3) << 4) + ((cell[1] >> 3) << 2) + (cell[2] >> 3);
            const counts entry = gather_counts(going, cube->entry, index);
            const counts sub = ((cell[0] >> 2 & one) << 2) + ((cell[1] >> 2 & one) << 1) + (cell[2] >> 2 & one);
            const mask some = both(going, meets(entry, one << sub));
            counts shift = pick_counts(meets(entry, all_counts(255)), all_counts(2), all_counts(3));
            if (bits(some)) {
                const counts place = entry >> 8;
                const counts word = place * SLOT_WORDS + ((cell[0] & 7) << 1) + (cell[1] >> 2 & one);
                const counts bit = one << (((cell[1] & 3) << 3) + (cell[2] & 7));
                const mask stopped = both(some, meets(gather_counts(some, words, word), bit));
                slot = pick_counts(stopped, place, slot);
                shift = pick_counts(some, all_counts(0), shift);
                going = except(going, stopped);
            }
            if (!bits(going)) break;
            advance(&ray, going, shift, cell, &t);
            /* A lane that leaves the cube's cells or its reach is done. */
            mask out = less(reach, t);
            for (int axis = 0; axis < 3; axis++)
                out = either(out, meets((cell[axis] - low[axis]) | (high[axis] - cell[axis]), all_counts(INT32_MIN)));
            out = both(out, going);
            going = except(going, out);
            left = except(left, out);
            if (!bits(going)) break;
        }
        if (!bits(left)) break;

        int32_t slot_of[LANES], at[3][LANES];
        store_counts(slot_of, slot);
        for (int axis = 0; axis < 3; axis++) store_counts(at[axis], cell[axis]);
        load_corners(cube, bits(left), slot_of, (const int32_t(*)[LANES])at, v);
        cells here;
        lanes exit = all(INFINITY);
        for (int corner = 0; corner < 8; corner++) here.v[corner] = load(v[corner]);
        for (int axis = 0; axis < 3; axis++)
            exit = minimum(exit, (to_lanes(cell[axis] + ray.up[axis]) - ray.p[axis]) * ray.inverse[axis]);
        here.t = t;
        here.span = maximum(exit - t, all(0));
        for (int axis = 0; axis < 3; axis++) {
            here.at[axis] = (ray.p[axis] - to_lanes(cell[axis])) + t * ray.d[axis];
            here.way[axis] = ray.d[axis] * here.span;
        }
        lanes at_t, at_slope[3];
        const mask found = intersect_cells(&here, left, &at_t, at_slope);
        hit_t = pick(found, at_t, hit_t);
        for (int axis = 0; axis < 3; axis++) slope[axis] = pick(found, at_slope[axis], slope[axis]);
        hits = either(hits, found);
        left = except(left, found);
        advance(&ray, left, all_counts(0), cell, &t);
        mask out = less(reach, t);
        for (int axis = 0; axis < 3; axis++)
            out = either(out, meets((cell[axis] - low[axis]) | (high[axis] - cell[axis]), all_counts(INT32_MIN)));
        left = except(left, out);
    }

    const lanes square = slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2];
    const mask flat = less(square, all(1e-30f)); /* no gradient: face the ray */
    const lanes scale = all(1) / root(square);
    float normal[3][LANES], hit_at[LANES];
    for (int axis = 0; axis < 3; axis++) store(normal[axis], pick(flat, -ray.d[axis], slope[axis] * scale));
    store(hit_at, hit_t);
    unsigned updated = 0;
    for (unsigned rest = bits(hits); rest; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        const double at = enter[lane] + (double)hit_at[lane];
        if (at > rays->t[lane] || (at == rays->t[lane] && number > rays->cube[lane])) continue;
        rays->t[lane] = at;
        rays->cube[lane] = number;
        for (int axis = 0; axis < 3; axis++) rays->normal[axis][lane] = normal[axis][lane];
        updated |= 1u << lane;
    }
    return updated;
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
        leave = lesser(leave, larger(a, b));
        store_doubles(out->direction[axis], d);
        store_doubles(out->inverse[axis], inverse);
    }
    for (int axis = 0; axis < 3; axis++) {
        /* Rounding must not push the origin out of the box by which cubes at its rim are found. */
        const doubles at = from[axis] + moved * way[axis];
        store_doubles(out->origin[axis],
                      lesser(larger(at, all_doubles(space->lo[axis])), all_doubles(space->hi[axis])));
    }
    store_doubles(out->t, reach - moved);
    for (int i = 0; i < LANES; i++) out->cube[i] = UINT32_MAX;
    store_doubles(moved_of, moved);
    return up_to(moved, leave) & rays->active;
}

const swarf_ray_kernel KERNEL_NAME = {aim, enter, trace, signs};
