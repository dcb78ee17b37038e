/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A ray goes on by its distance to the meridian, measured in its own half plane (r, z), until that is nothing: the
 * distance to the surface of revolution is the same (J. C. Hart: Sphere Tracing, The Visual Computer 12, 1996). */
#include "render/revolve.h"

#include "base/status.h"
#include "base/vector.h"
#include "cutter/cutter.h"

#include <stdlib.h>

typedef struct piece {
    swarf_profile_piece shape;
    double middle_r, middle_z; /* of an arc: unit vector from the centre to its middle */
    double half_cosine;        /* of an arc: of half its angle */
    swarf_part_kind kind;
} piece;

struct swarf_revolve {
    double tip[3];
    double radius, z_lo, z_hi;
    size_t count;
    piece piece[];
};

/* Of the cutter's size: where a ray counts as arrived. */
static const double arrived = 1e-7;
/* Rays that graze take small steps; beyond this many they have missed. */
enum { STEPS = 400 };

static piece make_piece(const swarf_profile_node *node, const swarf_profile_node *next, swarf_part_kind kind)
{
    piece p = {.shape = swarf_profile_piece_get(node, next), .kind = kind};
    const swarf_profile_piece *s = &p.shape;
    if (!(s->radius > 0)) return p;
    /* The bulge is tan(angle / 4); its middle lies at right angles to the chord, on the side the arc bulges to. */
    const double angle = 4 * atan(fabs(node->bulge)), side = node->bulge > 0 ? 1 : -1;
    const double chord_r = s->r1 - s->r0, chord_z = s->z1 - s->z0, length = hypot(chord_r, chord_z);
    p.middle_r = side * chord_z / length;
    p.middle_z = -side * chord_r / length;
    p.half_cosine = cos(0.5 * angle);
    return p;
}

swarf_status swarf_revolve_create(const swarf_cutter *cutter, const double tip[3], swarf_revolve **out)
{
    size_t count = 0;
    for (size_t part = 0; part < cutter->part_count; part++) count += cutter->parts[part].node_count;
    swarf_revolve *revolve = calloc(1, sizeof *revolve + count * sizeof(piece));
    if (!revolve) return swarf_fail(SWARF_ERROR_MEMORY, "cutter: out of memory");
    revolve->z_lo = INFINITY;
    revolve->z_hi = -INFINITY;
    for (int axis = 0; axis < 3; axis++) revolve->tip[axis] = tip[axis];
    for (size_t part = 0; part < cutter->part_count; part++) {
        const swarf_cutter_part *p = &cutter->parts[part];
        double lo, hi;
        swarf_cutter_extent(cutter, p->kind, &lo, &hi);
        revolve->z_lo = fmin(revolve->z_lo, lo);
        revolve->z_hi = fmax(revolve->z_hi, hi);
        revolve->radius = fmax(revolve->radius, swarf_cutter_radius(cutter, p->kind));
        for (size_t node = 0; node + 1 < p->node_count; node++) {
            const swarf_profile_node *a = &p->nodes[node], *b = &p->nodes[node + 1];
            if (a->r == b->r && a->z == b->z) continue;
            revolve->piece[revolve->count++] = make_piece(a, b, p->kind);
        }
    }
    *out = revolve;
    return SWARF_OK;
}

void swarf_revolve_destroy(swarf_revolve *revolve)
{
    free(revolve);
}

void swarf_revolve_box(const swarf_revolve *revolve, swarf_box *out)
{
    for (int axis = 0; axis < 2; axis++) {
        out->lo[axis] = revolve->tip[axis] - revolve->radius;
        out->hi[axis] = revolve->tip[axis] + revolve->radius;
    }
    out->lo[2] = revolve->tip[2] + revolve->z_lo;
    out->hi[2] = revolve->tip[2] + revolve->z_hi;
}

/** Distance in the half plane to a piece, and the unit normal of the piece where it is nearest. */
static double piece_distance(const piece *p, double r, double z, double normal[2])
{
    const swarf_profile_piece *s = &p->shape;
    if (s->radius > 0) {
        const double dr = r - s->centre_r, dz = z - s->centre_z, length = hypot(dr, dz);
        if (length > 0 && (dr * p->middle_r + dz * p->middle_z) >= p->half_cosine * length) {
            normal[0] = dr / length;
            normal[1] = dz / length;
            return fabs(length - s->radius);
        }
        const double to0 = hypot(r - s->r0, z - s->z0), to1 = hypot(r - s->r1, z - s->z1);
        const double er = (to0 < to1 ? s->r0 : s->r1) - s->centre_r, ez = (to0 < to1 ? s->z0 : s->z1) - s->centre_z;
        normal[0] = er / s->radius;
        normal[1] = ez / s->radius;
        return fmin(to0, to1);
    }
    const double dr = s->r1 - s->r0, dz = s->z1 - s->z0, square = dr * dr + dz * dz, length = sqrt(square);
    const double along = fmin(fmax(((r - s->r0) * dr + (z - s->z0) * dz) / square, 0), 1);
    normal[0] = dz / length;
    normal[1] = -dr / length;
    return hypot(r - (s->r0 + along * dr), z - (s->z0 + along * dz));
}

static double meridian_distance(const swarf_revolve *revolve, double r, double z, double normal[2],
                                swarf_part_kind *kind)
{
    double least = INFINITY;
    for (size_t i = 0; i < revolve->count; i++) {
        double n[2];
        const double distance = piece_distance(&revolve->piece[i], r, z, n);
        if (!(distance < least)) continue;
        least = distance;
        normal[0] = n[0];
        normal[1] = n[1];
        *kind = revolve->piece[i].kind;
    }
    return least;
}

/** Part of the ray within the cylinder around the body; 0 when it misses that. */
static int clip(const swarf_revolve *revolve, const double o[3], const double d[3], double margin, double *from,
                double *to)
{
    const double a = d[0] * d[0] + d[1] * d[1], b = o[0] * d[0] + o[1] * d[1], radius = revolve->radius + margin;
    const double c = o[0] * o[0] + o[1] * o[1] - radius * radius;
    if (a > 1e-20) {
        const double discriminant = b * b - a * c;
        if (!(discriminant > 0)) return 0;
        *from = fmax(*from, (-b - sqrt(discriminant)) / a);
        *to = fmin(*to, (-b + sqrt(discriminant)) / a);
    } else if (c > 0) {
        return 0;
    }
    if (fabs(d[2]) > 1e-10) {
        const double t0 = (revolve->z_lo - margin - o[2]) / d[2], t1 = (revolve->z_hi + margin - o[2]) / d[2];
        *from = fmax(*from, fmin(t0, t1));
        *to = fmin(*to, fmax(t0, t1));
    } else if (o[2] < revolve->z_lo - margin || o[2] > revolve->z_hi + margin) {
        return 0;
    }
    return *from < *to;
}

int swarf_revolve_trace(const swarf_revolve *revolve, const double origin[3], const double direction[3], double reach,
                        double *distance, float normal[3], swarf_part_kind *kind)
{
    const double size = revolve->radius + revolve->z_hi - revolve->z_lo, close = arrived * size;
    double o[3], t = 0, end = reach;
    for (int axis = 0; axis < 3; axis++) o[axis] = origin[axis] - revolve->tip[axis];
    if (!clip(revolve, o, direction, 10 * close, &t, &end)) return 0;
    for (int step = 0; step < STEPS && t < end; step++) {
        double p[3], n[2] = {0, 0};
        for (int axis = 0; axis < 3; axis++) p[axis] = o[axis] + t * direction[axis];
        const double r = hypot(p[0], p[1]), gap = meridian_distance(revolve, r, p[2], n, kind);
        if (gap > close) {
            t += gap;
            continue;
        }
        const double x = r > 0 ? n[0] * p[0] / r : 0, y = r > 0 ? n[0] * p[1] / r : 0;
        const double towards = x * direction[0] + y * direction[1] + n[1] * direction[2] > 0 ? -1 : 1;
        normal[0] = (float)(towards * x);
        normal[1] = (float)(towards * y);
        normal[2] = (float)(towards * n[1]);
        *distance = t;
        return 1;
    }
    return 0;
}
