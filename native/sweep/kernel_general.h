/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Part of the kernels (kernel_body.h): distance to one track of any body, 16 columns x 8 voxels. */
#ifndef SWARF_SWEEP_KERNEL_GENERAL_H
#define SWARF_SWEEP_KERNEL_GENERAL_H

#include "sweep/kernel_plan.h"

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

#endif
