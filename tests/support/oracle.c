/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "oracle.h"

#include "gradient.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static void fail_setup(const char *why)
{
    fprintf(stderr, "oracle: %s\n", why);
    exit(2);
}

static void add_edge(oracle_body *body, int *count, const swarf_profile_node *a, const swarf_profile_node *b)
{
    const double dr = b->r - a->r, dz = b->z - a->z, chord = hypot(dr, dz);
    if (chord == 0) return;
    if (*count == 64) fail_setup("more than 64 edges");
    oracle_edge *edge = &body->edge[(*count)++];
    *edge = (oracle_edge){.from = {a->r, a->z}, .to = {b->r, b->z}};
    if (a->bulge == 0) return;
    edge->turn_rad = 4 * atan(a->bulge);
    edge->radius = 0.5 * chord / fabs(sin(0.5 * edge->turn_rad));
    /* The centre lies on the chord's perpendicular bisector, to the left for a short counter-clockwise arc. */
    const double to_left = 0.5 / tan(0.5 * edge->turn_rad);
    edge->centre[0] = 0.5 * (a->r + b->r) - dz * to_left;
    edge->centre[1] = 0.5 * (a->z + b->z) + dr * to_left;
    edge->start_rad = atan2(a->z - edge->centre[1], a->r - edge->centre[0]);
}

static void add_part(oracle_body *body, const swarf_profile_node *nodes, size_t count)
{
    int edges = body->part_begin[body->parts];
    if (body->parts == 8) fail_setup("more than 8 parts");
    if (count < 2) fail_setup("fewer than 2 nodes");
    const swarf_profile_node bottom = {0, nodes[0].z, 0}, top = {0, nodes[count - 1].z, 0};
    add_edge(body, &edges, &bottom, &nodes[0]);
    for (size_t i = 0; i + 1 < count; i++) add_edge(body, &edges, &nodes[i], &nodes[i + 1]);
    swarf_profile_node last = nodes[count - 1];
    last.bulge = 0;
    add_edge(body, &edges, &last, &top);
    body->part_begin[++body->parts] = edges;
}

static void grow_extent(oracle_body *body, double r, double z)
{
    body->radius = fmax(body->radius, r);
    body->z_lo = fmin(body->z_lo, z);
    body->z_hi = fmax(body->z_hi, z);
}

static void measure_extent(oracle_body *body)
{
    body->radius = 0;
    body->z_lo = INFINITY;
    body->z_hi = -INFINITY;
    for (int i = 0; i < body->part_begin[body->parts]; i++) {
        const oracle_edge *edge = &body->edge[i];
        grow_extent(body, edge->from[0], edge->from[1]);
        grow_extent(body, edge->to[0], edge->to[1]);
        for (int k = 1; edge->radius > 0 && k < 256; k++) {
            const double angle = edge->start_rad + edge->turn_rad * k / 256;
            grow_extent(body, edge->centre[0] + edge->radius * cos(angle), edge->centre[1] + edge->radius * sin(angle));
        }
    }
}

oracle_body oracle_body_from(const swarf_profile_node *nodes, size_t count)
{
    oracle_body body = {0};
    add_part(&body, nodes, count);
    measure_extent(&body);
    return body;
}

oracle_body oracle_body_of(const swarf_cutter *cutter, swarf_part_kind kind)
{
    oracle_body body = {0};
    for (size_t i = 0; i < swarf_cutter_part_count(cutter); i++) {
        swarf_cutter_part part;
        if (swarf_cutter_part_get(cutter, i, &part) != SWARF_OK) fail_setup(swarf_error_last());
        if (part.kind == kind) add_part(&body, part.nodes, part.node_count);
    }
    if (!body.parts) fail_setup("the cutter has no part of this kind");
    measure_extent(&body);
    return body;
}

static double edge_distance(const oracle_edge *edge, double r, double z)
{
    if (edge->radius > 0) {
        const double dr = r - edge->centre[0], dz = z - edge->centre[1];
        double along = (atan2(dz, dr) - edge->start_rad) * (edge->turn_rad > 0 ? 1 : -1);
        along -= 2 * pi * floor(along / (2 * pi));
        if (along <= fabs(edge->turn_rad)) return fabs(hypot(dr, dz) - edge->radius);
        return fmin(hypot(r - edge->from[0], z - edge->from[1]), hypot(r - edge->to[0], z - edge->to[1]));
    }
    const double er = edge->to[0] - edge->from[0], ez = edge->to[1] - edge->from[1];
    double t = ((r - edge->from[0]) * er + (z - edge->from[1]) * ez) / (er * er + ez * ez);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    const double dr = r - edge->from[0] - t * er, dz = z - edge->from[1] - t * ez;
    return sqrt(dr * dr + dz * dz);
}

/* Even-odd rule over the chords, corrected by the segments between chords and arcs. The axis closes the chain; as rays
 * run outwards from r >= 0 it never counts. */
static int part_contains(const oracle_body *body, int part, double r, double z)
{
    int inside = 0;
    for (int i = body->part_begin[part]; i < body->part_begin[part + 1]; i++) {
        const oracle_edge *e = &body->edge[i];
        if ((e->from[1] > z) != (e->to[1] > z) &&
            r < e->from[0] + (e->to[0] - e->from[0]) * (z - e->from[1]) / (e->to[1] - e->from[1]))
            inside ^= 1;
        if (e->radius > 0 && hypot(r - e->centre[0], z - e->centre[1]) < e->radius) {
            const double side = (e->to[0] - e->from[0]) * (z - e->from[1]) - (e->to[1] - e->from[1]) * (r - e->from[0]);
            if ((side < 0) == (e->turn_rad > 0) && side != 0) inside ^= 1;
        }
    }
    return inside;
}

double oracle_meridian(const oracle_body *body, double r, double z)
{
    double least = INFINITY;
    for (int part = 0; part < body->parts; part++) {
        double distance = INFINITY;
        for (int i = body->part_begin[part]; i < body->part_begin[part + 1]; i++)
            distance = fmin(distance, edge_distance(&body->edge[i], r, z));
        least = fmin(least, part_contains(body, part, r, z) ? -distance : distance);
    }
    return least;
}

double oracle_radius_at(const oracle_body *body, double z)
{
    double greatest = 0;
    for (int i = 0; i < body->part_begin[body->parts]; i++) {
        const oracle_edge *e = &body->edge[i];
        if (e->radius > 0) {
            const double h = z - e->centre[1];
            if (fabs(h) > e->radius) continue;
            const double half = sqrt(e->radius * e->radius - h * h);
            for (int sign = -1; sign <= 1; sign += 2) {
                const double r = e->centre[0] + sign * half;
                if (edge_distance(e, r, z) < 1e-9) greatest = fmax(greatest, r);
            }
        } else if ((e->from[1] > z) != (e->to[1] > z)) {
            greatest =
                fmax(greatest, e->from[0] + (e->to[0] - e->from[0]) * (z - e->from[1]) / (e->to[1] - e->from[1]));
        }
    }
    return greatest;
}

/* Integral over z of radius^power, piece by piece between node heights; the substitution z = m + h sin(u) keeps the
 * square roots at arc ends smooth. */
static double integrate_radius(const oracle_body *body, int power)
{
    double height[200];
    int count = 0;
    for (int i = 0; i < body->part_begin[body->parts]; i++) {
        const oracle_edge *e = &body->edge[i];
        height[count++] = e->from[1];
        height[count++] = e->to[1];
        for (int k = -1; e->radius > 0 && k <= 1; k += 2)
            if (edge_distance(e, e->centre[0], e->centre[1] + k * e->radius) < 1e-9)
                height[count++] = e->centre[1] + k * e->radius;
    }
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && height[k - 1] > height[k]; k--) {
            const double keep = height[k];
            height[k] = height[k - 1];
            height[k - 1] = keep;
        }
    double sum = 0;
    for (int i = 0; i + 1 < count; i++) {
        const double middle = 0.5 * (height[i] + height[i + 1]), half = 0.5 * (height[i + 1] - height[i]);
        if (half < 1e-12) continue;
        const int steps = 2000;
        for (int k = 0; k < steps; k++) {
            const double u = pi * ((k + 0.5) / steps - 0.5);
            sum += pow(oracle_radius_at(body, middle + half * sin(u)), power) * half * cos(u) * pi / steps;
        }
    }
    return sum;
}

double oracle_meridian_area(const oracle_body *body)
{
    return integrate_radius(body, 1);
}

double oracle_volume(const oracle_body *body)
{
    return pi * integrate_radius(body, 2);
}

void oracle_tip(const swarf_path *path, double t, double out[3])
{
    if (!path->is_arc) {
        for (int i = 0; i < 3; i++) out[i] = path->start[i] + t * (path->end[i] - path->start[i]);
        return;
    }
    const int normal = path->arc.plane == SWARF_PLANE_XY ? 2 : path->arc.plane == SWARF_PLANE_ZX ? 1 : 0;
    const int u = (normal + 1) % 3, v = (normal + 2) % 3;
    const double du = path->start[u] - path->arc.centre[u], dv = path->start[v] - path->arc.centre[v];
    const double c = cos(t * path->arc.angle_rad), s = sin(t * path->arc.angle_rad);
    out[u] = path->arc.centre[u] + c * du - s * dv;
    out[v] = path->arc.centre[v] + s * du + c * dv;
    out[normal] = path->start[normal] + t * (path->end[normal] - path->start[normal]);
}

double oracle_length(const swarf_path *path)
{
    if (!path->is_arc)
        return sqrt(pow(path->end[0] - path->start[0], 2) + pow(path->end[1] - path->start[1], 2) +
                    pow(path->end[2] - path->start[2], 2));
    const int normal = path->arc.plane == SWARF_PLANE_XY ? 2 : path->arc.plane == SWARF_PLANE_ZX ? 1 : 0;
    const int u = (normal + 1) % 3, v = (normal + 2) % 3;
    const double radius = hypot(path->start[u] - path->arc.centre[u], path->start[v] - path->arc.centre[v]);
    return hypot(radius * path->arc.angle_rad, path->end[normal] - path->start[normal]);
}

double oracle_at(const oracle_body *body, const swarf_path *path, const double point[3], double t)
{
    double tip[3];
    oracle_tip(path, t, tip);
    return oracle_meridian(body, hypot(point[0] - tip[0], point[1] - tip[1]), point[2] - tip[2]);
}

typedef struct search {
    const oracle_body *body;
    const swarf_path *path;
    const double *point;
    double tolerance;
} search;

/* Between two samples at distance `length` a 1-Lipschitz function stays above (a + b - length) / 2. */
static int sign_between(const search *s, double ta, double a, double tb, double b, double length)
{
    if (0.5 * (a + b - length) > s->tolerance) return 1;
    if (length < s->tolerance) return 0;
    const double tm = 0.5 * (ta + tb), m = oracle_at(s->body, s->path, s->point, tm);
    if (m < -s->tolerance) return -1;
    const int left_first = a < b;
    const int first =
        left_first ? sign_between(s, ta, a, tm, m, 0.5 * length) : sign_between(s, tm, m, tb, b, 0.5 * length);
    if (first < 0) return -1;
    const int second =
        left_first ? sign_between(s, tm, m, tb, b, 0.5 * length) : sign_between(s, ta, a, tm, m, 0.5 * length);
    return second < first ? second : first;
}

int oracle_sign(const oracle_body *body, const swarf_path *path, const double point[3], double tolerance)
{
    const search s = {body, path, point, tolerance};
    const double a = oracle_at(body, path, point, 0), b = oracle_at(body, path, point, 1);
    if (a < -tolerance || b < -tolerance) return -1;
    return sign_between(&s, 0, a, 1, b, oracle_length(path));
}

static double shortest_edge(const oracle_body *body)
{
    double shortest = INFINITY;
    for (int i = 0; i < body->part_begin[body->parts]; i++) {
        const oracle_edge *edge = &body->edge[i];
        shortest = fmin(shortest, hypot(edge->to[0] - edge->from[0], edge->to[1] - edge->from[1]));
    }
    return shortest;
}

double oracle_distance(const oracle_body *body, const swarf_path *path, const double point[3])
{
    enum { MOST = 4096 };
    const double length = oracle_length(path), golden = 0.6180339887498949;
    /* two teeth may be nearest in turn, a step of the meridian apart */
    const double fine = fmin(fmax(0.5 * shortest_edge(body), 0.01 * body->radius), 0.1 * body->radius);
    int steps = 16 + (int)(length / fine);
    if (steps > MOST) steps = MOST;
    double sample[MOST + 1];
    double least = INFINITY;
    for (int i = 0; i <= steps; i++) {
        sample[i] = oracle_at(body, path, point, (double)i / steps);
        least = fmin(least, sample[i]);
    }
    const double found = least, spacing = length / steps;
    for (int i = 0; i <= steps; i++) {
        if ((i > 0 && sample[i - 1] < sample[i]) || (i < steps && sample[i + 1] < sample[i])) continue;
        if (sample[i] > found + spacing) continue;
        double lo = (double)(i > 0 ? i - 1 : 0) / steps, hi = (double)(i < steps ? i + 1 : steps) / steps;
        double t1 = hi - golden * (hi - lo), t2 = lo + golden * (hi - lo);
        double f1 = oracle_at(body, path, point, t1), f2 = oracle_at(body, path, point, t2);
        for (int k = 0; k < 40 && (hi - lo) * length > 1e-8; k++) {
            if (f1 < f2) {
                hi = t2, t2 = t1, f2 = f1;
                t1 = hi - golden * (hi - lo), f1 = oracle_at(body, path, point, t1);
            } else {
                lo = t1, t1 = t2, f1 = f2;
                t2 = lo + golden * (hi - lo), f2 = oracle_at(body, path, point, t2);
            }
        }
        least = fmin(least, fmin(f1, f2));
    }
    return least;
}

typedef struct sweep {
    const oracle_body *body;
    const swarf_path *path;
} sweep;

static double sweep_distance(const void *of, const double point[3])
{
    const sweep *s = of;
    return oracle_distance(s->body, s->path, point);
}

/* Place along the path, 0 to 1, that is nearest in plan. */
static double nearest_in_plan(const swarf_path *path, const double p[3])
{
    double s;
    if (path->is_arc) {
        const double *c = path->arc.centre;
        const double from = atan2(path->start[1] - c[1], path->start[0] - c[0]);
        s = fmod(atan2(p[1] - c[1], p[0] - c[0]) - from + 4 * pi, 2 * pi) / path->arc.angle_rad;
    } else {
        const double along[2] = {path->end[0] - path->start[0], path->end[1] - path->start[1]};
        const double square = along[0] * along[0] + along[1] * along[1];
        if (square == 0) return 0;
        s = ((p[0] - path->start[0]) * along[0] + (p[1] - path->start[1]) * along[1]) / square;
    }
    return fmin(fmax(s, 0), 1);
}

double oracle_swept(const oracle_body *body, const swarf_path *path, const double point[3])
{
    double least = INFINITY;
    const double moments[3] = {0, 1, nearest_in_plan(path, point)};
    for (int k = 0; k < 3; k++) {
        double tip[3];
        oracle_tip(path, moments[k], tip);
        least = fmin(least, hypot(point[0] - tip[0], point[1] - tip[1]));
    }
    if (path->start[2] == path->end[2]) return oracle_meridian(body, least, point[2] - path->start[2]);
    const int is_plunge = path->start[0] == path->end[0] && path->start[1] == path->end[1];
    const double away = least - body->radius, below = fmin(path->start[2], path->end[2]) - point[2];
    if (fmax(away, below) > 0.7 || (is_plunge && away > 0.1)) return fmax(away, below);
    return oracle_distance(body, path, point);
}

double oracle_gradient(const oracle_body *body, const swarf_path *path, const double point[3], double step,
                       double out[3])
{
    const sweep of = {body, path};
    return test_gradient(sweep_distance, &of, point, step, out);
}

int oracle_is_smooth(const oracle_body *body, const swarf_path *path, const double point[3], double distance,
                     double voxel)
{
    const double step = 0.05 * voxel;
    double normal[3];
    if (fabs(oracle_gradient(body, path, point, step, normal) - 1) > 0.01) return 0;
    const double aside[3] = {fabs(normal[0]) < 0.7, fabs(normal[0]) >= 0.7, 0};
    double u[3], v[3], size = 0;
    for (int i = 0; i < 3; i++)
        u[i] = normal[(i + 1) % 3] * aside[(i + 2) % 3] - normal[(i + 2) % 3] * aside[(i + 1) % 3];
    for (int i = 0; i < 3; i++) size += u[i] * u[i];
    for (int i = 0; i < 3; i++) u[i] /= sqrt(size);
    for (int i = 0; i < 3; i++) v[i] = normal[(i + 1) % 3] * u[(i + 2) % 3] - normal[(i + 2) % 3] * u[(i + 1) % 3];
    for (int k = 0; k < 8; k++) {
        const double c = 1.5 * voxel * cos(k * 0.7853981633974483), s = 1.5 * voxel * sin(k * 0.7853981633974483);
        double p[3];
        for (int i = 0; i < 3; i++) p[i] = point[i] + c * u[i] + s * v[i] - distance * normal[i];
        /* From the foot of the point, 1.5 voxels along the tangent plane: how far the surface bends away. */
        if (fabs(oracle_distance(body, path, p)) > 0.15 * voxel || oracle_sign(body, path, p, 0.3 * voxel) < 0)
            return 0;
    }
    return 1;
}

static void random_meridian_point(const oracle_body *body, test_random *random, double out[2])
{
    const oracle_edge *edge = &body->edge[test_random_below(random, (uint64_t)body->part_begin[body->parts])];
    const double s = test_random_in(random, 0, 1);
    if (edge->radius > 0) {
        const double angle = edge->start_rad + s * edge->turn_rad;
        out[0] = edge->centre[0] + edge->radius * cos(angle);
        out[1] = edge->centre[1] + edge->radius * sin(angle);
    } else {
        out[0] = edge->from[0] + s * (edge->to[0] - edge->from[0]);
        out[1] = edge->from[1] + s * (edge->to[1] - edge->from[1]);
    }
    out[0] = fabs(out[0]);
}

void oracle_random_point(const oracle_body *body, const swarf_path *path, double spread, test_random *random,
                         double out[3])
{
    const double which = test_random_in(random, 0, 1), step = 1e-6;
    double meridian[2], azimuth = test_random_in(random, -pi, pi), t = test_random_in(random, 0, 1);
    random_meridian_point(body, random, meridian);
    if (which < 0.2) t = which < 0.1 ? 0 : 1;
    if (which > 0.5) { /* On the envelope the surface normal is at a right angle to the velocity. */
        double before[3], after[3];
        oracle_tip(path, t - step, before);
        oracle_tip(path, t + step, after);
        const double vx = after[0] - before[0], vy = after[1] - before[1], vz = after[2] - before[2];
        const double nr = oracle_meridian(body, meridian[0] + step, meridian[1]) -
                          oracle_meridian(body, fabs(meridian[0] - step), meridian[1]);
        const double nz = oracle_meridian(body, meridian[0], meridian[1] + step) -
                          oracle_meridian(body, meridian[0], meridian[1] - step);
        const double cosine = -nz * vz / (nr * hypot(vx, vy));
        if (fabs(cosine) <= 1) azimuth = atan2(vy, vx) + acos(cosine) * (test_random_below(random, 2) ? 1 : -1);
    }
    oracle_tip(path, t, out);
    out[0] += meridian[0] * cos(azimuth) + test_random_in(random, -spread, spread);
    out[1] += meridian[0] * sin(azimuth) + test_random_in(random, -spread, spread);
    out[2] += meridian[1] + test_random_in(random, -spread, spread);
}

swarf_path oracle_line(double x0, double y0, double z0, double x1, double y1, double z1)
{
    return (swarf_path){.start = {x0, y0, z0}, .end = {x1, y1, z1}, .has_motion = 1};
}

swarf_path oracle_arc(const double start[3], const double centre[3], swarf_plane plane, double angle_rad, double rise)
{
    swarf_path path = {.is_arc = 1, .has_motion = 1, .arc = {.angle_rad = angle_rad, .plane = plane}};
    const int normal = plane == SWARF_PLANE_XY ? 2 : plane == SWARF_PLANE_ZX ? 1 : 0;
    for (int i = 0; i < 3; i++) {
        path.start[i] = path.end[i] = start[i];
        path.arc.centre[i] = centre[i];
    }
    path.arc.centre[normal] = start[normal];
    path.end[normal] = start[normal] + rise;
    oracle_tip(&path, 1, path.end);
    return path;
}

void oracle_print(FILE *stream, const char *cutter, const swarf_path *path, double voxel_mm, const double point[3])
{
    fprintf(stream, "cutter %s voxel %.17g point %.17g %.17g %.17g path start %.17g %.17g %.17g end %.17g %.17g %.17g",
            cutter, voxel_mm, point[0], point[1], point[2], path->start[0], path->start[1], path->start[2],
            path->end[0], path->end[1], path->end[2]);
    if (path->is_arc)
        fprintf(stream, " centre %.17g %.17g %.17g angle_rad %.17g plane %d", path->arc.centre[0], path->arc.centre[1],
                path->arc.centre[2], path->arc.angle_rad, path->arc.plane);
    fprintf(stream, "\n");
}
