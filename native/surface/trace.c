/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Distance to one trace, with its gradient: by the envelope theorem that of the cutter where it comes nearest.
 *
 * The same distances as the kernels take (sweep/kernel_line.h and kernel_general.h tell them), so that both agree
 * within the band; but in double and mm, helices and upright arcs as themselves. Level lines, plunges and level arcs
 * have the least plan distance as their nearest moment; on a tilted line phi is convex in time; on a curve it is
 * convex but for the bend.
 */
#include "surface/trace.h"

#include "base/least.h"
#include "program/arc.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* mm: what differs by less is level, or one radius. */
static const double level = 1e-7;
/* Lines steeper than this (run over rise) are vertical. */
static const double vertical = 1e-9;
/* Least moments are known to this many mm, those of curves among several are told apart to `apart`. */
static const double settled = 1e-10, apart = 1e-6;

/* mm: nearer to a line than this the direction from it is noise, or there is none: a tangent of the distance there is
 * level. */
static const double no_direction = 1e-6;
/* mm: far above what rounding makes of a distance. */
static const double rounded = 1e-9;

static double clamp(double value, double lo, double hi)
{
    return value < lo ? lo : value > hi ? hi : value;
}

/* ---- making ------------------------------------------------------------------------------------------------------ */

static double plan_radius(const swarf_path *path, const double point[3])
{
    int a, b, n;
    swarf_plane_axes((swarf_plane)path->arc.plane, &a, &b, &n);
    return hypot(point[a] - path->arc.centre[a], point[b] - path->arc.centre[b]);
}

static int is_level_arc(const swarf_path *path)
{
    return path->arc.plane == SWARF_PLANE_XY && fabs(path->start[2] - path->end[2]) <= level &&
           fabs(plan_radius(path, path->start) - plan_radius(path, path->end)) <= level;
}

uint32_t swarf_trace_parts(const swarf_path *path)
{
    if (!path->is_arc) return 1;
    const double turn = is_level_arc(path) ? fmin(fabs(path->arc.angle_rad), 2 * M_PI) : 2 * path->arc.angle_rad;
    return (uint32_t)fmax(1, ceil(fabs(turn) / (0.5 * M_PI) - 1e-9));
}

static void make_line(swarf_trace *trace, const double a[3], const double b[3])
{
    const int falls = b[2] < a[2];
    const double *low = falls ? b : a, *high = falls ? a : b;
    memcpy(trace->point, low, sizeof trace->point);
    trace->rise = high[2] - low[2];
    trace->ux = 1;
    trace->t0 = falls ? 1 : 0;
    trace->t1 = falls ? 0 : 1;
    const double dx = high[0] - low[0], dy = high[1] - low[1], run = hypot(dx, dy);
    if (run > vertical * trace->rise) {
        trace->run = run;
        trace->ux = dx / run;
        trace->uy = dy / run;
        trace->slope = trace->rise / run;
    }
    trace->kind = trace->slope > 0 ? TRACE_TILTED : TRACE_LEVEL;
    trace->cosine = 1 / sqrt(1 + trace->slope * trace->slope);
    trace->length = sqrt(trace->run * trace->run + trace->rise * trace->rise);
    if (!(trace->length > 0)) return;
    trace->along[0] = trace->ux * trace->run / trace->length;
    trace->along[1] = trace->uy * trace->run / trace->length;
    trace->along[2] = trace->rise / trace->length;
}

static void make_arc(swarf_trace *trace, const swarf_path *path, double share, double parts)
{
    const swarf_arc *arc = &path->arc;
    const int back = arc->angle_rad < 0;
    const double *first = back ? path->end : path->start;
    const double turn = fmin(fabs(arc->angle_rad), 2 * M_PI);
    memcpy(trace->point, path->start, sizeof trace->point);
    memcpy(trace->centre, arc->centre, sizeof trace->centre);
    trace->kind = TRACE_ARC;
    trace->radius = plan_radius(path, path->start);
    trace->turn = turn / parts;
    trace->from = atan2(first[1] - arc->centre[1], first[0] - arc->centre[0]) + turn * share;
    trace->t0 = back ? 1 - share : share;
    trace->t1 = trace->t0 + (back ? -1 : 1) / parts;
}

void swarf_trace_make(const swarf_body *body, const swarf_path *path, int64_t move, uint32_t part, uint32_t parts,
                      swarf_trace *out)
{
    const double share = (double)part / parts;
    *out = (swarf_trace){.body = body, .move = move};
    if (!path->is_arc) {
        make_line(out, path->start, path->end);
    } else if (is_level_arc(path)) {
        make_arc(out, path, share, parts);
    } else {
        const double step = path->arc.angle_rad / parts;
        out->kind = TRACE_CURVE;
        out->path = *path;
        out->t0 = share;
        out->t1 = (double)(part + 1) / parts;
        const double r0 = plan_radius(path, path->start), r1 = plan_radius(path, path->end);
        /* where the radius changes with the angle, twice its rate times the angle's besides */
        out->bend = fmax(r0, r1) * step * step + 2 * fabs(r1 - r0) / parts * fabs(step);
    }
}

/* The tool's tip at t of the part, 0..1, and its change with t. */
static void curve_at(const swarf_trace *trace, double t, double at[3], double rate[3])
{
    const swarf_path *path = &trace->path;
    const double part = trace->t1 - trace->t0, whole = trace->t0 + part * t;
    for (int k = 0; k < 3; k++) {
        rate[k] = path->end[k] - path->start[k];
        at[k] = path->start[k] + whole * rate[k];
    }
    int a, b, n;
    swarf_plane_axes((swarf_plane)path->arc.plane, &a, &b, &n);
    const double *c = path->arc.centre;
    const double u = path->start[a] - c[a], v = path->start[b] - c[b];
    const double r0 = hypot(u, v), r1 = hypot(path->end[a] - c[a], path->end[b] - c[b]);
    const double grow = r0 > 0 ? (r1 - r0) / r0 : 0, scale = 1 + whole * grow;
    const double angle = path->arc.angle_rad, cosine = cos(whole * angle), sine = sin(whole * angle);
    const double x = cosine * u - sine * v, y = sine * u + cosine * v;
    at[a] = c[a] + scale * x;
    at[b] = c[b] + scale * y;
    rate[a] = grow * x - scale * angle * y;
    rate[b] = grow * y + scale * angle * x;
    for (int k = 0; k < 3; k++) rate[k] *= part;
}

static double top_of(const swarf_body *body)
{
    return body->exact_hi;
}

void swarf_trace_box(const swarf_trace *trace, swarf_box *out)
{
    const double R = trace->body->exact_radius;
    double a[3] = {0}, b[3] = {0}, rate[3], sag = 0;
    if (trace->kind == TRACE_ARC) {
        for (int i = 0; i < 2; i++) {
            double *p = i ? b : a;
            p[0] = trace->centre[0] + trace->radius * cos(trace->from + i * trace->turn);
            p[1] = trace->centre[1] + trace->radius * sin(trace->from + i * trace->turn);
            p[2] = trace->point[2];
        }
        sag = trace->radius * (1 - cos(0.5 * trace->turn));
    } else if (trace->kind == TRACE_CURVE) {
        curve_at(trace, 0, a, rate);
        curve_at(trace, 1, b, rate);
        sag = 0.125 * trace->bend;
    } else {
        memcpy(a, trace->point, sizeof a);
        b[0] = a[0] + trace->ux * trace->run;
        b[1] = a[1] + trace->uy * trace->run;
        b[2] = a[2] + trace->rise;
    }
    for (int k = 0; k < 3; k++) {
        out->lo[k] = fmin(a[k], b[k]) - sag + (k < 2 ? -R : trace->body->exact_lo);
        out->hi[k] = fmax(a[k], b[k]) + sag + (k < 2 ? R : top_of(trace->body));
    }
}

/* ---- the cutter standing ----------------------------------------------------------------------------------------- */

static double piece_value(const swarf_exact_piece *p, double rho, double height, double *nr, double *nz)
{
    *nr = p->first_r;
    *nz = p->first_z;
    if (!p->is_arc) return rho * p->first_r + height * p->first_z - p->radius;
    const double v = rho - p->centre_r, h = height - p->centre_z;
    if (v * p->first_z < h * p->first_r && h * p->last_r < v * p->last_z) {
        const double length = sqrt(v * v + h * h);
        *nr = v / length;
        *nz = h / length;
        return length - p->radius;
    }
    const double first = v * p->first_r + h * p->first_z, last = v * p->last_r + h * p->last_z;
    if (last > first) {
        *nr = p->last_r;
        *nz = p->last_z;
        return last - p->radius;
    }
    return first - p->radius;
}

/* Offer a touch; the nearest stays. */
static void offer(swarf_touch *best, double value, const double gradient[3], double t, int32_t piece)
{
    if (value >= best->value) return;
    best->value = value;
    memcpy(best->gradient, gradient, sizeof best->gradient);
    best->t = t;
    best->piece = piece;
}

static void put_bound(swarf_touch *best, double value, const double slope[3])
{
    swarf_touch_bound *bound = &best->bound[best->bounds++];
    bound->value = value;
    memcpy(bound->slope, slope, sizeof bound->slope);
}

/* A cutter whose height does not depend on the place: at plan distance rho, along (gx, gy) from it, over heights from
 * `low` (beyond the tip at its low end) down to `high` (at its high end). */
static void touch_level(const swarf_trace *trace, double rho, double gx, double gy, double low, double high, double t,
                        swarf_touch *best)
{
    const swarf_body *body = trace->body;
    for (size_t c = 0; c < body->component_count; c++) {
        const swarf_component *component = &body->components[c];
        double value = -INFINITY, nr = 0, nz = 0, pr, pz;
        size_t piece = component->first;
        for (size_t k = component->first; k < component->first + component->count; k++) {
            const swarf_exact_piece *p = &body->exact[k];
            const double own = piece_value(p, rho, p->upper ? high : low, &pr, &pz);
            if (own <= value) continue;
            value = own;
            nr = pr;
            nz = pz;
            piece = k;
        }
        const double gradient[3] = {nr * gx, nr * gy, nz}, over[3] = {0, 0, nz};
        /* a convex function of the plan distance, with which it never falls, to a segment */
        if (trace->kind == TRACE_LEVEL && body->component_count <= 2)
            put_bound(best, rho > no_direction ? value : value - rho, rho > no_direction ? gradient : over);
        const double at = trace->kind == TRACE_LEVEL && trace->run == 0 && body->exact[piece].upper ? trace->t1 : t;
        best->raw = swarf_least(best->raw, value);
        offer(best, value, gradient, at, (int32_t)piece);
    }
}

static void touch_level_line(const swarf_trace *trace, const double p[3], swarf_touch *best)
{
    const double ex = p[0] - trace->point[0], ey = p[1] - trace->point[1];
    const double s = clamp(ex * trace->ux + ey * trace->uy, 0, trace->run);
    const double dx = ex - s * trace->ux, dy = ey - s * trace->uy, rho = sqrt(dx * dx + dy * dy);
    const double low = p[2] - trace->point[2];
    const double t = trace->run > 0 ? trace->t0 + (trace->t1 - trace->t0) * s / trace->run : trace->t0;
    touch_level(trace, rho, rho > 0 ? dx / rho : 1, rho > 0 ? dy / rho : 0, low, low - trace->rise, t, best);
}

static void touch_arc(const swarf_trace *trace, const double p[3], swarf_touch *best)
{
    const double dx = p[0] - trace->centre[0], dy = p[1] - trace->centre[1];
    double angle = remainder(atan2(dy, dx) - trace->from - 0.5 * trace->turn, 2 * M_PI);
    angle = trace->from + 0.5 * trace->turn + clamp(angle, -0.5 * trace->turn, 0.5 * trace->turn);
    const double cx = trace->centre[0] + trace->radius * cos(angle);
    const double cy = trace->centre[1] + trace->radius * sin(angle);
    const double ex = p[0] - cx, ey = p[1] - cy, rho = sqrt(ex * ex + ey * ey), height = p[2] - trace->point[2];
    const double t = trace->t0 + (trace->t1 - trace->t0) * (angle - trace->from) / trace->turn;
    touch_level(trace, rho, rho > 0 ? ex / rho : 1, rho > 0 ? ey / rho : 0, height, height, t, best);
}

/* ---- tilted lines of cylinders and balls ------------------------------------------------------------------------- */

/* A cylinder from `bottom` to `top` above the tip, as a point sees it: along the line, across it, above its start. */
struct tilted {
    double R, bottom, top;
    double s, w, z;
    double along, beyond; /* along the line to the nearest moment in plan, and from there on */
    double low, high;     /* beyond the flat ends */
};

static struct tilted see_tilted(const swarf_trace *trace, const double p[3], double R, double bottom, double top)
{
    const double ex = p[0] - trace->point[0], ey = p[1] - trace->point[1], z = p[2] - trace->point[2];
    struct tilted see = {.R = R, .bottom = bottom, .top = top, .z = z};
    see.s = ex * trace->ux + ey * trace->uy;
    see.w = ey * trace->ux - ex * trace->uy;
    see.along = clamp(see.s, 0, trace->run);
    see.beyond = see.s - see.along;
    see.low = bottom - z;
    see.high = z - (top + trace->rise);
    return see;
}

/* A plane that touches the slanted surface of a disc on a tilted line: that whose normal is the similar ellipse's
 * through a point at `w` across the line, `away` from the plane of the disc's middles. Its normal, of this length, is
 * `across` the line and v away from it. Beside the wall, where the plane above a point is steep, it is the nearer to
 * the truth (see sweep/kernel_line.h). */
struct rim {
    double value; /* -INFINITY: the point is not beyond the disc */
    double across, v, length;
};

static struct rim rim_plane(double w, double away, double R, double tilt)
{
    struct rim rim = {.value = -INFINITY};
    const double half_axis = R * tilt;
    if (away <= 0 || half_axis < 1e-9 * R) return rim;
    const double u = w / R, v = away / half_axis, size = sqrt(u * u + v * v);
    rim.across = u * tilt;
    rim.v = v;
    rim.length = sqrt(u * u * tilt * tilt + v * v);
    rim.value = size * (size - 1) * half_axis / rim.length;
    return rim;
}

/* What comes nearest of a cylinder: its wall, a flat end, the slanted surface below or above, or its rim there. */
enum face { WALL, LOW, HIGH, UNDER, OVER, RIM_UNDER, RIM_OVER };

struct nearest_face {
    enum face face;
    double value, rho, chord, norm;
    struct rim rim;
};

/* The rest of what there is to tell of it: divisions, which only the face that is nearest is worth. */
static void offer_face(const swarf_trace *trace, const struct tilted *see, const struct nearest_face *found,
                       swarf_touch *best)
{
    const double m = trace->slope, im = trace->cosine, R = see->R, s = see->s, w = see->w;
    const double sense = found->face == OVER || found->face == RIM_OVER ? -1 : 1;
    double gs = 0, gw = 0, gz = 0, at = see->along;
    int32_t piece = 1;
    switch (found->face) {
    case WALL:
        gs = found->rho > 0 ? see->beyond / found->rho : 1;
        gw = found->rho > 0 ? w / found->rho : 0;
        break;
    case LOW:
        gz = -1;
        at = 0;
        piece = 0;
        break;
    case HIGH:
        gz = 1;
        at = trace->run;
        piece = 2;
        break;
    case UNDER:
    case OVER:
        gs = sense * m * found->chord / found->norm;
        gw = m * clamp(w, -R, R) / found->norm;
        gz = -sense * found->chord / found->norm;
        at = clamp(s - sense * found->chord, 0, trace->run);
        piece = found->face == UNDER ? 0 : 2;
        break;
    case RIM_UNDER:
    case RIM_OVER: {
        const double away = found->rim.v / found->rim.length;
        gs = sense * m * im * away;
        gw = found->rim.across / found->rim.length;
        gz = -sense * im * away;
        const double foot = w - found->value * gw;
        at = clamp(s - found->value * gs - sense * sqrt(swarf_most(0, R * R - foot * foot)), 0, trace->run);
        piece = found->face == RIM_UNDER ? 0 : 2;
        break;
    }
    }
    const double gradient[3] = {gs * trace->ux - gw * trace->uy, gs * trace->uy + gw * trace->ux, gz};
    offer(best, found->value, gradient, trace->t0 + (trace->t1 - trace->t0) * at / trace->run, piece);
}

static void take_face(struct nearest_face *found, enum face face, double value)
{
    if (value <= found->value) return;
    found->value = value;
    found->face = face;
}

/* Its lower face has the piece number 0. Nothing is offered that is not below `most`. */
static void look_cylinder(const swarf_trace *trace, const struct tilted *see, double most, swarf_touch *best)
{
    const double m = trace->slope, im = trace->cosine, R = see->R, s = see->s, w = see->w, z = see->z;
    struct nearest_face found = {.rho = sqrt(see->beyond * see->beyond + w * w)};
    found.face = WALL;
    found.value = found.rho - R;
    take_face(&found, LOW, see->low);
    take_face(&found, HIGH, see->high);
    if (found.value >= most) return;
    const double chord2 = swarf_most(0, R * R - w * w), chord = sqrt(chord2);
    const double norm = sqrt(chord2 + m * m * R * R), scale = chord / norm;
    found.chord = chord;
    found.norm = norm;
    take_face(&found, UNDER, scale * ((s - chord) * m + see->bottom - z));
    take_face(&found, OVER, scale * (z - see->top - (s + chord) * m));
    if (found.value >= most) return;
    const double under = (s * m + see->bottom - z) * im, over = (z - see->top - s * m) * im;
    const double away = swarf_most(under, over); /* no point is beyond both */
    /* above the disc no plane that touches it is farther off than the disc itself is straight below */
    if (w * w >= R * R || found.value <= swarf_most(away - m * im * chord, 0) + rounded) {
        found.rim = rim_plane(w, away, R, m * im);
        take_face(&found, under > over ? RIM_UNDER : RIM_OVER, found.rim.value);
    }
    if (found.value < most) offer_face(trace, see, &found, best);
}

static void bound_cylinder(const swarf_trace *trace, const struct tilted *see, swarf_touch *best)
{
    const double m = trace->slope, im = trace->cosine, R = see->R, s = see->s, w = see->w, z = see->z;
    const double rho = sqrt(see->beyond * see->beyond + w * w);
    const double plane_under = ((s - R) * m + see->bottom - z) * im, plane_over = (z - see->top - (s + R) * m) * im;
    const int beside = rho > no_direction;
    double raw = rho - R, bound = beside ? raw : -R;
    double ts = beside ? see->beyond / rho : 0, tw = beside ? w / rho : 0, tz = 0;
    const double flat = swarf_most(see->low, see->high), plane = swarf_most(plane_under, plane_over);
    if (flat > raw || plane > raw) {
        raw = bound = swarf_most(flat, plane);
        const int up = flat >= plane ? see->high > see->low : plane_over > plane_under;
        ts = flat >= plane ? 0 : up ? -m * im : m * im;
        tw = 0;
        tz = (up ? 1 : -1) * (flat >= plane ? 1 : im);
    }
    const double tangent[3] = {ts * trace->ux - tw * trace->uy, ts * trace->uy + tw * trace->ux, tz};
    best->raw = swarf_least(best->raw, raw);
    best->exact = 0;
    put_bound(best, bound, tangent);
}

/* The same cylinder up from the middle of a ball. */
static struct tilted see_above_ball(const swarf_trace *trace, const double p[3])
{
    const swarf_exact_piece *ball = trace->body->exact;
    return see_tilted(trace, p, ball->radius, ball->centre_z, top_of(trace->body));
}

/* The way to a point from where the middle of a ball comes nearest, that far along the line, and its length. */
static double see_ball(const swarf_trace *trace, const double p[3], double way[3], double *along)
{
    const double *d = trace->along;
    for (int k = 0; k < 3; k++) way[k] = p[k] - trace->point[k];
    way[2] -= trace->body->exact->centre_z;
    *along = clamp(way[0] * d[0] + way[1] * d[1] + way[2] * d[2], 0, trace->length);
    for (int k = 0; k < 3; k++) way[k] -= *along * d[k];
    return sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
}

static void look_ball(const swarf_trace *trace, const double p[3], double most, swarf_touch *best)
{
    const swarf_exact_piece *ball = trace->body->exact;
    double way[3], along;
    const double away = see_ball(trace, p, way, &along), value = away - ball->radius;
    /* what is above the ball is farther than it from a point so far below */
    if (!(ball->centre_z - (p[2] - trace->point[2]) > value)) {
        const struct tilted see = see_above_ball(trace, p);
        look_cylinder(trace, &see, most, best);
        /* its lower end lies in the ball, at whose equator both are as near but for rounding */
        if (best->value < most && best->piece == 0) best->value = INFINITY;
    }
    if (value >= most) return;
    const double gradient[3] = {away > 0 ? way[0] / away : 0, away > 0 ? way[1] / away : 0,
                                away > 0 ? way[2] / away : -1};
    offer(best, value, gradient, trace->t0 + (trace->t1 - trace->t0) * along / trace->length, 0);
}

static void bound_ball(const swarf_trace *trace, const double p[3], swarf_touch *best)
{
    const double R = trace->body->exact->radius;
    const struct tilted see = see_above_ball(trace, p);
    double way[3], along, tangent[3] = {0};
    bound_cylinder(trace, &see, best);
    const double away = see_ball(trace, p, way, &along);
    best->raw = swarf_least(best->raw, away - R);
    for (int k = 0; k < 3 && away > no_direction; k++) tangent[k] = way[k] / away;
    put_bound(best, away > no_direction ? away - R : -R, tangent);
}

/* ---- any cutter on tilted lines and curves ------------------------------------------------------------------------
 */

/* phi of a component at a moment t of the part, 0..1, its slope in t, and its gradient. */
struct moment {
    double t, value, slope, gradient[3];
    int32_t piece;
};

struct search {
    const swarf_trace *trace;
    const swarf_component *component;
    const double *point;
    swarf_touch *best;
};

static struct moment at_moment(const struct search *search, double t)
{
    const swarf_trace *trace = search->trace;
    const swarf_component *component = search->component;
    double at[3], rate[3] = {trace->ux * trace->run, trace->uy * trace->run, trace->rise};
    if (trace->kind == TRACE_CURVE)
        curve_at(trace, t, at, rate);
    else
        for (int k = 0; k < 3; k++) at[k] = trace->point[k] + t * rate[k];
    const double x = search->point[0] - at[0], y = search->point[1] - at[1], height = search->point[2] - at[2];
    const double rho = sqrt(x * x + y * y);
    struct moment m = {.t = t, .value = -INFINITY};
    double nr = 0, nz = 0, pr, pz;
    for (size_t k = component->first; k < component->first + component->count; k++) {
        const double own = piece_value(&trace->body->exact[k], rho, height, &pr, &pz);
        if (own <= m.value) continue;
        m.value = own;
        nr = pr;
        nz = pz;
        m.piece = (int32_t)k;
    }
    m.gradient[0] = rho > 0 ? nr * x / rho : 0;
    m.gradient[1] = rho > 0 ? nr * y / rho : 0;
    m.gradient[2] = nz;
    for (int k = 0; k < 3; k++) m.slope -= m.gradient[k] * rate[k];
    return m;
}

/* Where the tangents at both ends meet, and the height there: the least value there can be if nothing bends. */
static double tangents_meet(const struct moment *a, const struct moment *b, double *bound)
{
    if (a->slope >= 0 || b->slope <= 0) {
        const struct moment *end = a->slope >= 0 ? a : b;
        *bound = end->value;
        return end->t;
    }
    const double step = (a->value - b->value + b->slope * (b->t - a->t)) / (b->slope - a->slope);
    *bound = a->value + a->slope * clamp(step, 0, b->t - a->t);
    return clamp(a->t + step, a->t, b->t);
}

static void offer_moment(const struct search *search, const struct moment *m, double value, const double gradient[3],
                         double t)
{
    const swarf_trace *trace = search->trace;
    search->best->raw = swarf_least(search->best->raw, swarf_least(m->value, value));
    offer(search->best, value, gradient, trace->t0 + (trace->t1 - trace->t0) * t, m->piece);
}

/* Least value between two moments, phi being convex between them. Its gradient is the mix of both ends' that stands
 * across the motion; dividing by its length makes what edges sweep have a unit gradient. */
static void search_convex(const struct search *search, struct moment a, struct moment b)
{
    if (a.slope >= 0 || b.slope <= 0) {
        const struct moment *end = a.slope >= 0 ? &a : &b;
        offer_moment(search, end, end->value, end->gradient, end->t);
        return;
    }
    double bound, t = tangents_meet(&a, &b, &bound);
    /* bisection every other step halves the bracket at least that often: 2^-40 of a move is less than settled */
    for (int step = 0; step < 80 && swarf_least(a.value, b.value) - bound > settled; step++) {
        const struct moment m = at_moment(search, step & 1 ? 0.5 * (a.t + b.t) : t);
        if (m.slope < 0)
            a = m;
        else
            b = m;
        t = tangents_meet(&a, &b, &bound);
    }
    const double part = b.slope > a.slope ? clamp(-a.slope / (b.slope - a.slope), 0, 1) : 0;
    double gradient[3], square = 0;
    for (int k = 0; k < 3; k++) {
        gradient[k] = a.gradient[k] + (b.gradient[k] - a.gradient[k]) * part;
        square += gradient[k] * gradient[k];
    }
    /* deep inside, opposite sides of the cutter cancel: no more than tenfold */
    const double length = swarf_most(sqrt(square), 0.1);
    for (int k = 0; k < 3; k++) gradient[k] /= length;
    struct moment found = part < 0.5 ? a : b;
    found.value = bound;
    offer_moment(search, &found, bound / swarf_least(length, 1), gradient, t);
}

/* Least value on a stretch of a curve, unless it is above what is known; the bend says by how much phi may fall short
 * of a convex function. Halves of the stretch follow each other until that does not matter. */
static void search_curve(const struct search *search, const struct moment *a, const struct moment *b)
{
    const double width = b->t - a->t, slack = 0.5 * search->trace->bend * width * width;
    double bound;
    tangents_meet(a, b, &bound);
    if (bound - slack >= search->best->value || bound - slack >= search->best->raw) return;
    if (slack < apart) {
        search_convex(search, *a, *b);
        return;
    }
    const struct moment m = at_moment(search, 0.5 * (a->t + b->t));
    const int left_first = m.slope >= 0;
    search_curve(search, left_first ? a : &m, left_first ? &m : b);
    search_curve(search, left_first ? &m : a, left_first ? b : &m);
}

static void touch_any(const swarf_trace *trace, const double p[3], swarf_touch *best)
{
    for (size_t c = 0; c < trace->body->component_count; c++) {
        swarf_touch own = *best;
        own.value = own.raw = INFINITY;
        const struct search search = {trace, &trace->body->components[c], p, &own};
        const struct moment a = at_moment(&search, 0), b = at_moment(&search, 1);
        if (trace->kind == TRACE_CURVE)
            search_curve(&search, &a, &b);
        else
            search_convex(&search, a, b);
        best->raw = swarf_least(best->raw, own.raw);
        offer(best, own.value, own.gradient, own.t, own.piece);
    }
}

/* Both at once: what is near, and how near anything may be. */
static void touch_trace(const swarf_trace *trace, const double point[3], swarf_touch *best)
{
    switch (trace->kind) {
    case TRACE_LEVEL: touch_level_line(trace, point, best); break;
    case TRACE_ARC: touch_arc(trace, point, best); break;
    case TRACE_TILTED:
    case TRACE_CURVE: touch_any(trace, point, best); break;
    }
}

void swarf_trace_bound(const swarf_trace *trace, const double point[3], swarf_touch *out)
{
    const swarf_body *body = trace->body;
    *out = (swarf_touch){.value = INFINITY, .raw = INFINITY, .exact = 1};
    if (trace->kind == TRACE_TILTED && body->kind == SWARF_BODY_CYLINDER) {
        const struct tilted see = see_tilted(trace, point, body->exact_radius, body->exact_lo, top_of(body));
        bound_cylinder(trace, &see, out);
    } else if (trace->kind == TRACE_TILTED && body->kind == SWARF_BODY_BALL) {
        bound_ball(trace, point, out);
    } else {
        touch_trace(trace, point, out);
    }
}

void swarf_trace_look(const swarf_trace *trace, const double point[3], double most, swarf_touch *out)
{
    const swarf_body *body = trace->body;
    out->value = out->raw = INFINITY;
    out->exact = 1;
    out->bounds = 0;
    if (trace->kind == TRACE_TILTED && body->kind == SWARF_BODY_CYLINDER) {
        const struct tilted see = see_tilted(trace, point, body->exact_radius, body->exact_lo, top_of(body));
        look_cylinder(trace, &see, most, out);
    } else if (trace->kind == TRACE_TILTED && body->kind == SWARF_BODY_BALL) {
        look_ball(trace, point, most, out);
    } else {
        touch_trace(trace, point, out);
    }
}
