/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cutting a meridian into convex chains, and each chain into the component it bounds. */
#include "sweep/body.h"

#include "base/memory.h"
#include "base/status.h"
#include "cutter/cutter.h"
#include "swarf/sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Working copy of a piece, in mm and double. Angles are those of the outward normal, -pi/2 (down) .. pi/2 (up). */
typedef struct face {
    double r0, z0, r1, z1;
    double centre_r, centre_z, radius; /* radius 0: a line */
    double first, last;                /* angle of the normal at its lower and upper end */
} face;

/* A chain of faces with normals that only turn upwards, between the heights its component is clipped at, and within the
 * radius at which its faces would leave the profile. */
typedef struct chain {
    size_t first, count;
    double lo, hi; /* -INFINITY / INFINITY: closed by itself */
    double wall;   /* INFINITY: none */
} chain;

typedef struct outline {
    face *faces;
    size_t face_count, face_room;
    chain *chains;
    size_t chain_count, chain_room;
    const swarf_cutter *cutter;
    swarf_part_kind kind;
    double z_lo, z_hi;
    double tolerance;   /* of the chords that stand for arcs */
    double largest_arc; /* radius up to which a convex arc stays one */
} outline;

static const double tiny = 1e-9;
/* Convex arcs of a larger radius, in voxels, become chords: a float holds their centre to 1/250 voxel, less beyond. */
static const double largest_arc_voxels = 65536;
/* Angles closer than this are one: CAD arcs meet their tangents no better. */
static const double same_angle = 1e-6;

static swarf_status add_face(outline *o, face f)
{
    if (hypot(f.r1 - f.r0, f.z1 - f.z0) < tiny) return SWARF_OK;
    SWARF_TRY(swarf_array_reserve((void **)&o->faces, &o->face_room, o->face_count + 1, sizeof *o->faces));
    o->faces[o->face_count++] = f;
    return SWARF_OK;
}

static swarf_status add_line(outline *o, double r0, double z0, double r1, double z1)
{
    const double angle = fmax(-0.5 * M_PI, fmin(0.5 * M_PI, atan2(-(r1 - r0), z1 - z0)));
    return add_face(o, (face){.r0 = r0, .z0 = z0, .r1 = r1, .z1 = z1, .first = angle, .last = angle});
}

/* Angle of a point on an arc as seen from its centre, kept in the range of a profile that only climbs. */
static double arc_angle(const swarf_profile_piece *p, double r, double z)
{
    const double angle = atan2(z - p->centre_z, r - p->centre_r);
    return fmax(-0.5 * M_PI, fmin(0.5 * M_PI, angle));
}

/* A convex arc is split where it is vertical, so that each piece belongs to the lower or the upper border. */
static swarf_status add_convex_arc(outline *o, const swarf_profile_piece *p)
{
    const double from = arc_angle(p, p->r0, p->z0), to = arc_angle(p, p->r1, p->z1);
    face f = {p->r0, p->z0, p->r1, p->z1, p->centre_r, p->centre_z, p->radius, from, to};
    if (from < -same_angle && to > same_angle) {
        face upper = f;
        f.r1 = upper.r0 = p->centre_r + p->radius;
        f.z1 = upper.z0 = p->centre_z;
        f.last = upper.first = 0;
        SWARF_TRY(add_face(o, f));
        return add_face(o, upper);
    }
    return add_face(o, f);
}

/* Chords that leave an arc by no more than the tolerance; their ends lie on it. */
static swarf_status add_chords(outline *o, const swarf_profile_piece *p)
{
    const double from = atan2(p->z0 - p->centre_z, p->r0 - p->centre_r);
    /* arcs are half a circle at most; from the chord, as the difference of two angles would be all rounding when the
     * centre is far away */
    const double chord = hypot(p->r1 - p->r0, p->z1 - p->z0);
    const double turn = (p->convex ? 2 : -2) * asin(fmin(1, 0.5 * chord / p->radius));
    const double step = 4 * asin(fmin(0.5, sqrt(0.5 * o->tolerance / p->radius))); /* height of its arc: tolerance */
    const int count = (int)fmax(1, ceil(fabs(turn) / step));
    double r = p->r0, z = p->z0;
    for (int i = 1; i <= count; i++) {
        const double angle = from + turn * i / count;
        const double next_r = i == count ? p->r1 : p->centre_r + p->radius * cos(angle);
        const double next_z = i == count ? p->z1 : p->centre_z + p->radius * sin(angle);
        SWARF_TRY(add_line(o, r, z, next_r, next_z));
        r = next_r;
        z = next_z;
    }
    return SWARF_OK;
}

/* Radius of a chain's component at a height, by its faces and wall; below 0 where there is nothing. */
static double chain_radius(const outline *o, const chain *c, double z)
{
    double least = c->wall;
    for (size_t i = c->first; i < c->first + c->count; i++) {
        const face *f = &o->faces[i];
        const double s = f->radius > 0 ? (z - f->centre_z) / f->radius : 0;
        if (f->radius > 0 && s >= sin(f->first) && s <= sin(f->last)) {
            least = fmin(least, f->centre_r + f->radius * sqrt(fmax(0, 1 - s * s)));
            continue;
        }
        /* beyond its ends an arc goes on as its tangent there; a line is its own */
        const int above = f->radius > 0 && s > sin(f->last);
        const double angle = above ? f->last : f->first, r = above ? f->r1 : f->r0, height = above ? f->z1 : f->z0;
        const double nr = cos(angle), rest = -sin(angle) * (z - height);
        if (nr >= same_angle)
            least = fmin(least, r + rest / nr);
        else if (rest < -tiny)
            return -1;
    }
    return least;
}

/* Greatest radius of the chain's own faces: at a node, as arcs are split where they are vertical. */
static double face_radius(const outline *o, const chain *c)
{
    double most = 0;
    for (size_t i = c->first; i < c->first + c->count; i++) most = fmax(most, fmax(o->faces[i].r0, o->faces[i].r1));
    return most;
}

/* Is the chain's component inside the whole profile at this height? */
static int fits(const outline *o, const chain *c, double z)
{
    const double slack = 1e-7 + 0.01 * o->tolerance;
    return chain_radius(o, c, z) <= swarf_cutter_radius_at(o->cutter, o->kind, z) + slack;
}

/* The height from `start` towards `end` up to which the chain's component stays inside the whole profile. Where its
 * faces would first leave it the component gets a wall, so that it stays as thick as the profile allows: under a hollow
 * face many components lie side by side, and the depth of one is right only while no inner border is nearer. */
static double reach(const outline *o, chain *c, double start, double end)
{
    /* fine enough for any profile with features above a five-hundredth of its length; nodes are seen besides */
    enum { STEPS = 512 };
    double inside = start;
    for (int i = 1; i <= STEPS; i++) {
        double z = start + (end - start) * i / STEPS;
        if (chain_radius(o, c, z) < 0) return end > start ? INFINITY : -INFINITY; /* closed by its own faces */
        if (fits(o, c, z)) {
            inside = z;
            continue;
        }
        const double step = z;
        for (int k = 0; k < 60; k++) {
            const double middle = 0.5 * (inside + z);
            if (fits(o, c, middle))
                inside = middle;
            else
                z = middle;
        }
        if (chain_radius(o, c, inside) < face_radius(o, c)) return inside; /* a wall there would cut its own faces */
        c->wall = fmin(chain_radius(o, c, inside), swarf_cutter_radius_at(o->cutter, o->kind, inside));
        if (!fits(o, c, step)) return inside;
        inside = step;
    }
    return end;
}

/* Where the line that continues a face would meet a radius, within lo .. hi; `lo` when it does not. */
static double height_at_radius(const face *f, int above, double radius, double lo, double hi)
{
    const double angle = above ? f->last : f->first, r = above ? f->r1 : f->r0, z = above ? f->z1 : f->z0;
    if (fabs(sin(angle)) < same_angle || !isfinite(radius)) return lo;
    return fmax(lo, fmin(hi, z - (radius - r) * cos(angle) / sin(angle)));
}

static int within_at(const outline *o, const chain *a, const chain *b, double z)
{
    const double own = chain_radius(o, a, z);
    return own <= 0 || (z >= b->lo - tiny && z <= b->hi + tiny && own <= chain_radius(o, b, z) + tiny);
}

/* Is all of chain a within chain b? Then a need not be swept. Asked at even steps, at b's nodes and where b's ends meet
 * its wall: between those the radius of b is a line or an arc. */
static int contained(const outline *o, const chain *a, const chain *b)
{
    enum { STEPS = 256 };
    const double lo = fmax(o->z_lo, a->lo), hi = fmin(o->z_hi, a->hi);
    for (int i = 0; i <= STEPS; i++)
        if (!within_at(o, a, b, lo + (hi - lo) * i / STEPS)) return 0;
    for (size_t i = b->first; i < b->first + b->count; i++) {
        const face *f = &o->faces[i];
        const double at[] = {f->z0, f->z1, height_at_radius(f, 0, b->wall, lo, hi),
                             height_at_radius(f, 1, b->wall, lo, hi)};
        for (size_t k = 0; k < sizeof at / sizeof at[0]; k++)
            if (!within_at(o, a, b, fmax(lo, fmin(hi, at[k])))) return 0;
    }
    for (size_t i = a->first; i < a->first + a->count; i++)
        if (!within_at(o, a, b, fmax(lo, fmin(hi, o->faces[i].z0))) ||
            !within_at(o, a, b, fmax(lo, fmin(hi, o->faces[i].z1))))
            return 0;
    return 1;
}

static swarf_status collect_faces(outline *o, const swarf_cutter_part *part)
{
    for (size_t i = 0; i + 1 < part->node_count; i++) {
        const swarf_profile_piece p = swarf_profile_piece_get(&part->nodes[i], &part->nodes[i + 1]);
        if (p.radius == 0)
            SWARF_TRY(add_line(o, p.r0, p.z0, p.r1, p.z1));
        else if (p.convex && p.radius <= o->largest_arc)
            SWARF_TRY(add_convex_arc(o, &p));
        else
            SWARF_TRY(add_chords(o, &p));
    }
    return SWARF_OK;
}

static swarf_status collect_chains(outline *o, size_t first_face)
{
    for (size_t i = first_face; i < o->face_count;) {
        size_t end = i + 1;
        while (end < o->face_count && o->faces[end].first >= o->faces[end - 1].last - same_angle) end++;
        SWARF_TRY(swarf_array_reserve((void **)&o->chains, &o->chain_room, o->chain_count + 1, sizeof *o->chains));
        o->chains[o->chain_count++] = (chain){i, end - i, -INFINITY, INFINITY, INFINITY};
        i = end;
    }
    return SWARF_OK;
}

static void drop_contained(outline *o)
{
    for (size_t i = 0; i < o->chain_count;) {
        size_t j = 0;
        while (j < o->chain_count && (j == i || !contained(o, &o->chains[i], &o->chains[j]))) j++;
        if (j == o->chain_count) {
            i++;
            continue;
        }
        memmove(o->chains + i, o->chains + i + 1, (o->chain_count - i - 1) * sizeof *o->chains);
        o->chain_count--;
    }
}

static swarf_exact_piece to_exact(const face *f)
{
    swarf_exact_piece p = {.is_arc = f->radius > 0, .upper = 0.5 * (f->first + f->last) > same_angle};
    p.first_r = fmax(0, cos(f->first));
    p.first_z = sin(f->first);
    p.last_r = fmax(0, cos(f->last));
    p.last_z = sin(f->last);
    if (p.is_arc) {
        p.centre_r = f->centre_r;
        p.centre_z = f->centre_z;
        p.radius = f->radius;
    } else {
        p.radius = cos(f->first) * f->r0 + sin(f->first) * f->z0;
    }
    return p;
}

static swarf_piece to_piece(const swarf_exact_piece *e, double voxel)
{
    return (swarf_piece){.centre_r = (float)(e->centre_r / voxel),
                         .centre_z = (float)(e->centre_z / voxel),
                         .radius = (float)(e->radius / voxel),
                         .first_r = (float)e->first_r,
                         .first_z = (float)e->first_z,
                         .last_r = (float)e->last_r,
                         .last_z = (float)e->last_z,
                         .is_arc = e->is_arc,
                         .upper = e->upper};
}

/* Greatest radius of a chain's component: at a node or where it is clipped, as arcs are split where they are vertical.
 */
static double widest(const outline *o, const chain *c)
{
    const double lo = fmax(o->z_lo, c->lo), hi = fmin(o->z_hi, c->hi);
    double most = fmax(chain_radius(o, c, lo), chain_radius(o, c, hi));
    for (size_t i = c->first; i < c->first + c->count; i++) {
        const face *f = &o->faces[i];
        most = fmax(most, chain_radius(o, c, fmax(lo, fmin(hi, f->z0))));
        most = fmax(most, chain_radius(o, c, fmax(lo, fmin(hi, f->z1))));
    }
    return most;
}

/* Does a face of the chain have the horizontal normal among its own? */
static int has_side(const outline *o, const chain *c)
{
    for (size_t i = c->first; i < c->first + c->count; i++)
        if (o->faces[i].first <= same_angle && o->faces[i].last >= -same_angle) return 1;
    return 0;
}

static swarf_status emit(const outline *o, double voxel, swarf_body *body)
{
    size_t pieces = 0;
    for (size_t i = 0; i < o->chain_count; i++) pieces += o->chains[i].count + 3;
    body->pieces = calloc(pieces ? pieces : 1, sizeof *body->pieces);
    body->exact = calloc(pieces ? pieces : 1, sizeof *body->exact);
    body->components = calloc(o->chain_count ? o->chain_count : 1, sizeof *body->components);
    if (!body->pieces || !body->exact || !body->components)
        return swarf_fail(SWARF_ERROR_MEMORY, "cutter: out of memory");
    for (size_t i = 0; i < o->chain_count; i++) {
        const chain *c = &o->chains[i];
        swarf_component *component = &body->components[body->component_count++];
        component->first = body->piece_count;
        for (size_t k = c->first; k < c->first + c->count; k++)
            body->exact[body->piece_count++] = to_exact(&o->faces[k]);
        if (isfinite(c->lo))
            body->exact[body->piece_count++] = (swarf_exact_piece){.radius = -c->lo, .first_z = -1, .last_z = -1};
        if (isfinite(c->hi))
            body->exact[body->piece_count++] =
                (swarf_exact_piece){.radius = c->hi, .first_z = 1, .last_z = 1, .upper = 1};
        /* A plunge draws the lower and the upper border apart: what closes it between them is the widest place or
         * the wall. */
        if (!has_side(o, c) || isfinite(c->wall))
            body->exact[body->piece_count++] = (swarf_exact_piece){.radius = widest(o, c), .first_r = 1, .last_r = 1};
        component->count = body->piece_count - component->first;
    }
    for (size_t k = 0; k < body->piece_count; k++) body->pieces[k] = to_piece(&body->exact[k], voxel);
    return SWARF_OK;
}

/* Largest cylinder inside, by volume, among those that start and end at 65 evenly spaced heights. */
static void find_core(const outline *o, double voxel, swarf_body *body)
{
    enum { LEVELS = 64 };
    double radius[LEVELS + 1], best = 0;
    for (int i = 0; i <= LEVELS; i++) {
        const double z = o->z_lo + (o->z_hi - o->z_lo) * i / LEVELS;
        radius[i] = 0;
        for (size_t k = 0; k < o->chain_count; k++)
            if (z >= o->chains[k].lo && z <= o->chains[k].hi)
                radius[i] = fmax(radius[i], chain_radius(o, &o->chains[k], z));
    }
    for (int i = 0; i < LEVELS; i++) {
        double least = radius[i];
        for (int j = i + 1; j <= LEVELS; j++) {
            least = fmin(least, radius[j]);
            if (least * least * (j - i) <= best) continue;
            best = least * least * (j - i);
            /* the slack of fits() must not make it wider than the whole: bounds would cross */
            body->core_radius = fminf((float)(least / voxel), body->radius);
            body->core_lo = (float)((o->z_lo + (o->z_hi - o->z_lo) * i / LEVELS) / voxel);
            body->core_hi = (float)((o->z_lo + (o->z_hi - o->z_lo) * j / LEVELS) / voxel);
        }
    }
}

/* Bodies with a kernel of their own are recognised by their faces. */
static void recognise(const outline *o, double voxel, swarf_body *body)
{
    body->kind = SWARF_BODY_GENERAL;
    if (o->chain_count != 1) return;
    const face *f = o->faces;
    const size_t n = o->face_count;
    const int side_and_top = n >= 2 && f[n - 2].radius == 0 && fabs(f[n - 2].first) < same_angle &&
                             f[n - 1].radius == 0 && f[n - 1].first > 0.5 * M_PI - same_angle;
    if (n == 3 && side_and_top && f[0].radius == 0 && f[0].first < -0.5 * M_PI + same_angle) {
        body->kind = SWARF_BODY_CYLINDER;
        body->core_radius = body->radius;
        body->core_lo = body->z_lo;
        body->core_hi = body->z_hi;
    } else if (n >= 2 && f[0].radius > 0 && fabs(f[0].centre_r) < tiny && f[0].first < -0.5 * M_PI + same_angle &&
               fabs(f[0].last) < same_angle && (side_and_top || n == 2) && f[n - 1].radius == 0 &&
               f[n - 1].first > 0.5 * M_PI - same_angle) {
        body->kind = SWARF_BODY_BALL;
        body->core_radius = body->radius;
        body->core_lo = (float)(f[0].centre_z / voxel);
        body->core_hi = body->z_hi;
    }
}

swarf_status swarf_body_create(const swarf_cutter *cutter, swarf_part_kind kind, double voxel, swarf_body **out)
{
    swarf_body *body = calloc(1, sizeof *body);
    if (!body) return swarf_fail(SWARF_ERROR_MEMORY, "cutter: out of memory");
    /* half of the promised bound, the rest is left to rounding */
    outline o = {.cutter = cutter,
                 .kind = kind,
                 .tolerance = 0.5 * SWARF_SWEEP_BOUND * voxel,
                 .largest_arc = largest_arc_voxels * voxel};
    swarf_cutter_extent(cutter, kind, &o.z_lo, &o.z_hi);
    swarf_status status = SWARF_OK;
    for (size_t i = 0; i < cutter->part_count && status == SWARF_OK; i++) {
        if (cutter->parts[i].kind != kind) continue;
        const size_t first = o.face_count;
        status = collect_faces(&o, &cutter->parts[i]);
        if (status == SWARF_OK) status = collect_chains(&o, first);
    }
    if (status == SWARF_OK) {
        for (size_t i = 0; i < o.chain_count && o.chain_count > 1; i++) {
            chain *c = &o.chains[i];
            const face *lowest = &o.faces[c->first], *highest = &o.faces[c->first + c->count - 1];
            /* a flat face at the end closes the component there */
            c->lo = lowest->last < -0.5 * M_PI + same_angle ? -INFINITY : reach(&o, c, lowest->z0, o.z_lo);
            c->hi = highest->first > 0.5 * M_PI - same_angle ? INFINITY : reach(&o, c, highest->z1, o.z_hi);
        }
        drop_contained(&o);
        body->exact_radius = swarf_cutter_radius(cutter, kind);
        body->exact_lo = o.z_lo;
        body->exact_hi = o.z_hi;
        body->radius = (float)(body->exact_radius / voxel);
        body->z_lo = (float)(o.z_lo / voxel);
        body->z_hi = (float)(o.z_hi / voxel);
        if (o.chain_count) {
            recognise(&o, voxel, body);
            if (body->kind == SWARF_BODY_GENERAL) find_core(&o, voxel, body);
        }
        status = emit(&o, voxel, body);
    }
    free(o.faces);
    free(o.chains);
    if (status != SWARF_OK) {
        swarf_body_destroy(body);
        return status;
    }
    *out = body;
    return SWARF_OK;
}

void swarf_body_destroy(swarf_body *body)
{
    if (!body) return;
    free(body->pieces);
    free(body->exact);
    free(body->components);
    free(body);
}
