/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A ray through one block: from cell to cell, and exactly through the trilinear field of the crossed ones.
 *
 * Planes between cells are hit at (plane - origin) / direction, the same expression whichever side asks: the pieces
 * of a ray in neighbouring cells and blocks join without a gap. What rounding loses at the seam is caught by "already
 * inside at the cell's entry is a hit". That rule needs rays that start outside the material (scene.c sees to it).
 */
#include "render/block.h"

#include <math.h>
#include <string.h>

/* Roots are closed to this many voxels: far below what the samples know, far above the rounding of t. */
static const double root_tolerance = 1e-7;

/** Bit z: sign of value (x, y, z) of the apron, x, y, z = 0 .. 8. */
static unsigned sign_row(const swarf_block *block, int x, int y)
{
    const int slot = (x >> 3) << 2 | (y >> 3) << 1, place = (x & 7) << 6 | (y & 7) << 3;
    const float *row = block->values[slot] + place;
    unsigned bits = (unsigned)(block->values[slot | 1][place] < 0) << 8;
    for (int z = 0; z < 8; z++) bits |= (unsigned)(row[z] < 0) << z;
    return bits;
}

int swarf_block_make(swarf_block *block)
{
    unsigned any[9][8], all[9][8]; /* of two neighbouring rows in y, then of two neighbours in z */
    for (int x = 0; x < 9; x++) {
        unsigned low = sign_row(block, x, 0);
        for (int y = 0; y < 8; y++) {
            const unsigned high = sign_row(block, x, y + 1);
            any[x][y] = (low | high) | (low | high) >> 1;
            all[x][y] = (low & high) & (low & high) >> 1;
            low = high;
        }
    }
    unsigned in_x = 0, in_y = 0, in_z = 0;
    for (int x = 0; x < 8; x++) {
        uint64_t word = 0;
        for (int y = 0; y < 8; y++) {
            const unsigned row = (any[x][y] | any[x + 1][y]) & ~(all[x][y] & all[x + 1][y]) & 255u;
            word |= (uint64_t)row << (8 * y);
            in_z |= row;
            in_y |= (unsigned)(row != 0) << y;
        }
        block->crossing[x] = word;
        in_x |= (unsigned)(word != 0) << x;
    }
    if (!in_x) return 0;
    const unsigned in[3] = {in_x, in_y, in_z};
    for (int axis = 0; axis < 3; axis++) {
        uint8_t lo = 0, hi = 8;
        while (!(in[axis] >> lo & 1)) lo++;
        while (!(in[axis] >> (hi - 1) & 1)) hi--;
        block->lo[axis] = lo;
        block->hi[axis] = hi;
    }
    return 1;
}

static void gather(const swarf_block *block, const int cell[3], float corner[8])
{
    for (int number = 0; number < 8; number++) {
        const int x = cell[0] + (number >> 2), y = cell[1] + (number >> 1 & 1), z = cell[2] + (number & 1);
        const int slot = (x >> 3) << 2 | (y >> 3) << 1 | z >> 3;
        corner[number] = block->values[slot][(x & 7) << 6 | (y & 7) << 3 | (z & 7)];
    }
}

/* A cell's field as v0 + vx x + vy y + vz z + vxy x y + vyz y z + vxz x z + vxyz x y z. */
typedef struct cell_field {
    double v0, vx, vy, vz, vxy, vyz, vxz, vxyz;
} cell_field;

static cell_field expand(const float v[8])
{
    cell_field f;
    f.v0 = v[0];
    f.vx = (double)v[4] - v[0];
    f.vy = (double)v[2] - v[0];
    f.vz = (double)v[1] - v[0];
    f.vxy = (double)v[6] - v[4] - f.vy;
    f.vyz = (double)v[3] - v[2] - f.vz;
    f.vxz = (double)v[5] - v[4] - f.vz;
    f.vxyz = ((double)v[7] - v[6]) - ((double)v[5] - v[4]) - f.vyz;
    return f;
}

static double evaluate(const cell_field *f, const double p[3])
{
    return f->v0 + f->vx * p[0] + p[1] * (f->vy + f->vxy * p[0]) +
           p[2] * (f->vz + f->vxz * p[0] + p[1] * (f->vyz + f->vxyz * p[0]));
}

double swarf_cell_value(const float corner[8], const double p[3])
{
    const cell_field f = expand(corner);
    return evaluate(&f, p);
}

static double cubic(const double c[4], double s)
{
    return ((c[3] * s + c[2]) * s + c[1]) * s + c[0];
}

/** First s in 0 .. length where the cubic falls below 0; it is not below 0 at s = 0. Splits at the extrema into
 *  monotone intervals (G. Marmitt et al.: Fast and Accurate Ray-Voxel Intersection Techniques for Iso-Surface Ray
 *  Tracing, VMV 2004), then Newton's method held inside the bracket. Negative when there is none. */
static double first_root(const double c[4], double length)
{
    double end[3];
    int ends = 0;
    const double a = 3 * c[3], discriminant = c[2] * c[2] - a * c[1];
    if (discriminant > 0) {
        const double q = -(c[2] + copysign(sqrt(discriminant), c[2]));
        const double r0 = q / a, r1 = c[1] / q; /* infinite where the cubic is a parabola: fails the test below */
        const double low = fmin(r0, r1), high = fmax(r0, r1);
        if (low > 0 && low < length) end[ends++] = low;
        if (high > 0 && high < length) end[ends++] = high;
    }
    end[ends++] = length;

    /* A surface through voxel centres ends many cells in a value of about 0. Rounding must not let the ray slip between
     * the cell above, where it seems just outside, and the one below, which nothing crosses. */
    const double slack = 1e-9 * (fabs(c[0]) + (fabs(c[1]) + (fabs(c[2]) + fabs(c[3]) * length) * length) * length);
    double lo = 0, f_lo = c[0];
    for (int interval = 0; interval < ends; interval++) {
        double hi = end[interval];
        const double f_hi = cubic(c, hi);
        if (!(f_hi < 0)) {
            if (hi == length && f_hi <= slack && f_hi < f_lo) return hi;
            lo = hi;
            f_lo = f_hi;
            continue;
        }
        double s = lo + (hi - lo) * (f_lo / (f_lo - f_hi));
        while (hi - lo > root_tolerance) {
            const double f = cubic(c, s), slope = (3 * c[3] * s + 2 * c[2]) * s + c[1];
            if (f < 0)
                hi = s;
            else
                lo = s;
            double next = s - f / slope;
            if (!(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
            const double step = fabs(next - s);
            s = next;
            if (step < root_tolerance) break;
        }
        return s;
    }
    return -1;
}

/** Into `ray` if the surface is crossed at t_in .. t_out of this cell; p: the entry, in the cell's own coordinates. */
static int intersect_cell(const cell_field *f, const double p[3], double t_in, double t_out, uint32_t number,
                          swarf_ray *ray)
{
    const double *d = ray->direction;
    double c[4];
    c[0] = evaluate(f, p);
    double s = 0;
    if (c[0] >= 0) {
        c[1] = d[0] * (f->vx + f->vxy * p[1] + f->vxz * p[2] + f->vxyz * p[1] * p[2]) +
               d[1] * (f->vy + f->vxy * p[0] + f->vyz * p[2] + f->vxyz * p[0] * p[2]) +
               d[2] * (f->vz + f->vxz * p[0] + f->vyz * p[1] + f->vxyz * p[0] * p[1]);
        c[2] = d[0] * d[1] * (f->vxy + f->vxyz * p[2]) + d[1] * d[2] * (f->vyz + f->vxyz * p[0]) +
               d[0] * d[2] * (f->vxz + f->vxyz * p[1]);
        c[3] = d[0] * d[1] * d[2] * f->vxyz;
        s = first_root(c, t_out - t_in);
        if (s < 0) return 0;
    }
    const double t = t_in + s;
    if (t > ray->t || (t == ray->t && number > ray->block)) return 0;
    const double q[3] = {p[0] + s * d[0], p[1] + s * d[1], p[2] + s * d[2]};
    const double gradient[3] = {
        f->vx + f->vxy * q[1] + f->vxz * q[2] + f->vxyz * q[1] * q[2],
        f->vy + f->vxy * q[0] + f->vyz * q[2] + f->vxyz * q[0] * q[2],
        f->vz + f->vxz * q[0] + f->vyz * q[1] + f->vxyz * q[0] * q[1],
    };
    const double length = sqrt(gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2]);
    for (int axis = 0; axis < 3; axis++) ray->normal[axis] = (float)(length > 0 ? gradient[axis] / length : -d[axis]);
    ray->t = t;
    ray->block = number;
    return 1;
}

int swarf_block_intersect(const swarf_block *block, uint32_t number, swarf_ray *ray)
{
    /* Clip to the crossed cells. */
    double t = 0, t_end = ray->t;
    int entry = -1; /* axis of the plane that the ray comes in by */
    for (int axis = 0; axis < 3; axis++) {
        const double lo = block->ijk[axis] + block->lo[axis], hi = block->ijk[axis] + block->hi[axis];
        if (ray->direction[axis] == 0) {
            if (ray->origin[axis] < lo || ray->origin[axis] > hi) return 0;
            continue;
        }
        const double t_lo = (lo - ray->origin[axis]) * ray->inverse[axis];
        const double t_hi = (hi - ray->origin[axis]) * ray->inverse[axis];
        const double near = fmin(t_lo, t_hi), far = fmax(t_lo, t_hi);
        if (near > t) {
            t = near;
            entry = axis;
        }
        if (far < t_end) t_end = far;
    }
    if (t > t_end) return 0;

    int cell[3], step[3];
    double t_next[3]; /* where the ray leaves the cell along each axis */
    for (int axis = 0; axis < 3; axis++) {
        const double d = ray->direction[axis];
        const int lo = block->lo[axis], last = block->hi[axis] - 1;
        step[axis] = d < 0 ? -1 : 1;
        if (axis == entry) {
            cell[axis] = d > 0 ? lo : last;
        } else {
            const double place = ray->origin[axis] + t * d - block->ijk[axis];
            cell[axis] = place < lo ? lo : place > last ? last : (int)place;
        }
        const int plane = block->ijk[axis] + cell[axis] + (d > 0);
        t_next[axis] = d == 0 ? INFINITY : (plane - ray->origin[axis]) * ray->inverse[axis];
    }
    for (;;) {
        const int axis = t_next[0] < t_next[1] ? (t_next[0] < t_next[2] ? 0 : 2) : (t_next[1] < t_next[2] ? 1 : 2);
        if (block->crossing[cell[0]] >> (cell[1] * 8 + cell[2]) & 1) {
            float corner[8];
            gather(block, cell, corner);
            double p[3];
            for (int i = 0; i < 3; i++) p[i] = (ray->origin[i] - (block->ijk[i] + cell[i])) + t * ray->direction[i];
            const cell_field field = expand(corner);
            if (intersect_cell(&field, p, t, fmax(t, t_next[axis]), number, ray)) return 1;
        }
        cell[axis] += step[axis];
        if (cell[axis] < block->lo[axis] || cell[axis] >= block->hi[axis]) return 0;
        t = fmax(t, t_next[axis]);
        if (t > t_end) return 0;
        const int plane = block->ijk[axis] + cell[axis] + (step[axis] > 0);
        t_next[axis] = (plane - ray->origin[axis]) * ray->inverse[axis];
    }
}
