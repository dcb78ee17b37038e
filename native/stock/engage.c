/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Two passes over the surface of the flutes. The first one looks at the cells of the meridian and finds, on each piece,
 * between which of its points there is material (bisected). The second one puts rings evenly between those, follows
 * each around and bisects where it enters and leaves the material; what lies between is integrated in closed form.
 *
 * A surface that the tool only rubs along is not in material, yet beside edges of the field it may look so by a part of
 * a voxel. So a run of samples counts only where it is somewhere deeper than `deep`, and then up to `edge`. */
#include "stock/engage.h"

#include "base/status.h"
#include "stock/probe.h"
#include "sweep/distance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Voxels of depth; see above. Beside concave edges samples of the field run short by up to a quarter of a voxel. */
static const double deep = 0.35, edge = 0.02;
/* Ends are bisected to this many voxels. */
static const double settled = 0.01;
/* A motion whose level part is less than this share of the whole is a plunge. */
static const double sideways = 0.02;

enum { SCAN_ANGLES = 32, RING_ANGLES = 64, MOST_RINGS = 12, PIECE_CELLS = 24 };

/* ---- the meridian ---- */

static void piece_point(const swarf_meridian_piece *piece, double u, double rz[2], double normal[2])
{
    const swarf_profile_piece *s = &piece->shape;
    if (s->radius == 0) {
        rz[0] = s->r0 + u * (s->r1 - s->r0);
        rz[1] = s->z0 + u * (s->z1 - s->z0);
        normal[0] = (s->z1 - s->z0) / piece->length;
        normal[1] = -(s->r1 - s->r0) / piece->length;
        return;
    }
    const double angle = piece->from + u * piece->turn, side = s->convex ? 1 : -1;
    rz[0] = s->centre_r + s->radius * cos(angle);
    rz[1] = s->centre_z + s->radius * sin(angle);
    normal[0] = side * cos(angle);
    normal[1] = side * sin(angle);
}

/* Lines of many voxels get cells that grow upwards; arcs even ones, of a voxel but no fewer than the eighth of a right
 * angle needs. */
static void make_cells(swarf_meridian_piece *piece, double voxel)
{
    const swarf_profile_piece *s = &piece->shape;
    double size[SWARF_MERIDIAN_CELLS], sum = 0, next = voxel;
    int count = 0;
    if (s->radius > 0) {
        count = (int)fmin(PIECE_CELLS, ceil(fmax(piece->length / voxel, fabs(piece->turn) / (M_PI / 16))));
        for (int i = 0; i < count; i++) size[i] = 1;
        sum = count;
    } else {
        const double most = fmax(voxel, piece->length / PIECE_CELLS);
        while (count < SWARF_MERIDIAN_CELLS && sum < piece->length) {
            sum += size[count++] = next;
            next = fmin(1.15 * next, most);
        }
    }
    double at = 0;
    for (int i = 0; i < count; i++) {
        piece->edge[i] = (float)(at / sum);
        at += size[i];
    }
    piece->edge[count] = 1;
    piece->cells = count;
}

swarf_status swarf_meridian_create(const swarf_cutter *cutter, double voxel, swarf_meridian *out)
{
    size_t room = 0;
    swarf_cutter_part part;
    for (size_t i = 0; i < swarf_cutter_part_count(cutter); i++) {
        SWARF_TRY(swarf_cutter_part_get(cutter, i, &part));
        if (part.kind == SWARF_PART_FLUTES) room += part.node_count;
    }
    swarf_meridian made = {.cutter = cutter, .pieces = calloc(room + 1, sizeof *made.pieces)};
    if (!made.pieces) return swarf_fail(SWARF_ERROR_MEMORY, "load: out of memory");
    for (size_t i = 0; i < swarf_cutter_part_count(cutter); i++) {
        swarf_cutter_part_get(cutter, i, &part);
        for (size_t k = 0; part.kind == SWARF_PART_FLUTES && k + 1 < part.node_count; k++) {
            swarf_meridian_piece piece = {.shape = swarf_profile_piece_get(&part.nodes[k], &part.nodes[k + 1])};
            const swarf_profile_piece *s = &piece.shape;
            piece.length = hypot(s->r1 - s->r0, s->z1 - s->z0);
            /* upper faces: where a part ends, another one begins or the shank */
            if (piece.length < 1e-9 || (s->radius == 0 && s->z1 - s->z0 < 1e-9 && s->r1 < s->r0)) continue;
            if (s->radius > 0) {
                piece.from = atan2(s->z0 - s->centre_z, s->r0 - s->centre_r);
                piece.turn = 4 * atan(part.nodes[k].bulge);
                piece.length = s->radius * fabs(piece.turn);
            }
            make_cells(&piece, voxel);
            made.pieces[made.count++] = piece;
        }
    }
    *out = made;
    return SWARF_OK;
}

void swarf_meridian_destroy(swarf_meridian *meridian)
{
    free(meridian->pieces);
    *meridian = (swarf_meridian){0};
}

/* ---- one moment ---- */

struct fan {
    double half, cosine[RING_ANGLES], sine[RING_ANGLES];
};

struct moment {
    const swarf_meridian *meridian;
    const swarf_material *material;
    swarf_probe probe;
    double tip[3]; /* voxels of the layout */
    struct fan fans[2];
    double level, up;        /* parts of the motion */
    double ahead_x, ahead_y; /* its level direction */
    double voxel;
    swarf_status status;
    swarf_engagement found;
    double reach[4]; /* least and greatest across, least and greatest ahead */
    double z_lo, z_hi;
};

/* A circle of the flutes: its place, its normal, and the half angle of what faces the motion: that is where
 * front * cos(angle) + rise > 0. */
struct ring {
    double r, z, front, rise, half;
};

static struct ring ring_at(const struct moment *m, const swarf_meridian_piece *piece, double u)
{
    double rz[2], normal[2];
    piece_point(piece, u, rz, normal);
    struct ring ring = {.r = rz[0], .z = rz[1], .front = normal[0] * m->level, .rise = normal[1] * m->up};
    const double tiny = 1e-9;
    if (ring.front <= tiny)
        ring.half = ring.rise > tiny ? M_PI : 0;
    else
        ring.half = acos(fmax(-1, fmin(1, -ring.rise / ring.front)));
    /* a lower face that another part of the flutes covers */
    if (normal[1] < -0.999 && swarf_cutter_radius_at(m->meridian->cutter, SWARF_PART_FLUTES, rz[1] - 1e-6) > rz[0])
        ring.half = 0;
    return ring;
}

/* Whether what the tracks of the material have cut is far from a point (1; farther than `deep`), covers it (-1), or is
 * near (0), as far as the enclosing cylinder of the body and a large one inside it tell. */
static int tracks_at(const swarf_material *material, const double at[3])
{
    const swarf_body *body = material->body;
    const double slack = 0.01; /* of floats */
    const double outer = (double)body->radius + deep + slack, inner = (double)body->core_radius - slack;
    int far = 1;
    for (size_t i = 0; i < material->track_count; i++) {
        const swarf_track *track = &material->tracks[i];
        const double x = at[0] - track->point[0], y = at[1] - track->point[1], z = at[2] - track->point[2];
        if (z < (double)body->z_lo - deep - slack) continue;
        if (track->is_arc) {
            const double plan = fabs(hypot(at[0] - track->centre[0], at[1] - track->centre[1]) - track->radius);
            if (plan < outer) far = 0;
            continue;
        }
        const double t = x * track->ux + y * track->uy, s = t < 0 ? 0 : t > track->run ? track->run : t;
        const double dx = x - s * track->ux, dy = y - s * track->uy;
        const double square = dx * dx + dy * dy;
        if (square >= outer * outer) continue;
        if (track->rise == 0 && inner > 0 && square < inner * inner && z > (double)body->core_lo + slack &&
            z < (double)body->core_hi - slack)
            return -1;
        far = 0;
    }
    return far;
}

/* How many voxels deep in material the ring is at the angle of a cosine and sine from the motion. */
static double depth_towards(struct moment *m, const struct ring *ring, double c, double s)
{
    const swarf_material *material = m->material;
    const double r = ring->r * m->probe.scale;
    const double at[3] = {m->tip[0] + r * (c * m->ahead_x - s * m->ahead_y),
                          m->tip[1] + r * (c * m->ahead_y + s * m->ahead_x), m->tip[2] + ring->z * m->probe.scale};
    const int32_t nearest[3] = {(int32_t)lrint(at[0]), (int32_t)lrint(at[1]), (int32_t)lrint(at[2])};
    double depth = -swarf_probe_voxel(&m->probe, nearest) * m->probe.scale;
    if (depth < -2) return depth;
    if (depth < 2) depth = -swarf_probe_point(&m->probe, at) * m->probe.scale;
    if (depth <= edge || material->track_count == 0 || m->status != SWARF_OK) return depth;
    const int known = tracks_at(material, at);
    if (known) return known > 0 ? depth : -1;
    float away = 0;
    m->status = swarf_distance_at(material->body, material->tracks, material->track_count, at, material->column, &away);
    return fmin(depth, away);
}

static double depth_at(struct moment *m, const struct ring *ring, double angle)
{
    return depth_towards(m, ring, cos(angle), sin(angle));
}

/* Cosines and sines of `count` angles evenly across the half turn of a ring. The last ones are kept: most rings face
 * the motion by a half turn. */
static const struct fan *fan_of(struct moment *m, double half, int count)
{
    struct fan *fan = &m->fans[count == RING_ANGLES];
    if (fan->half == half) return fan;
    fan->half = half;
    for (int k = 0; k < count; k++) {
        const double angle = half * (2 * (k + 0.5) / count - 1);
        fan->cosine[k] = cos(angle);
        fan->sine[k] = sin(angle);
    }
    return fan;
}

/* Where between `in`, which lies in material, and `out`, which does not, the ring leaves it. */
static double ring_end(struct moment *m, const struct ring *ring, double in, double out)
{
    while (fabs(out - in) * ring->r > settled * m->voxel) {
        const double middle = 0.5 * (in + out);
        if (depth_at(m, ring, middle) > edge)
            in = middle;
        else
            out = middle;
    }
    return in;
}

static int reaches(struct moment *m, const swarf_meridian_piece *piece, double u, double angle)
{
    const struct ring ring = ring_at(m, piece, u);
    return fabs(angle) < ring.half && depth_at(m, &ring, angle) > edge;
}

static double facing(const struct ring *ring, double angle)
{
    return ring->front * cos(angle) + ring->rise;
}

/* Material is cut at angles of greater cosines. At its sides a tool rubs along the walls it has made, and where they
 * are nearer than `deep` what shows is none. */
static double least_cosine(const struct moment *m, const struct ring *ring)
{
    return ring->rise > 0 ? -2 : fmin(0.5, sqrt(2 * deep * m->voxel / fmax(ring->r, 1e-9)));
}

static double scan_angle(const struct ring *ring, int k)
{
    return ring->half * (2 * (k + 0.5) / SCAN_ANGLES - 1);
}

static double cell_middle(const swarf_meridian_piece *piece, int cell)
{
    if (cell < 0 || cell >= piece->cells) return cell < 0 ? 0 : 1;
    return 0.5 * (piece->edge[cell] + piece->edge[cell + 1]);
}

/* The same along the meridian: the farthest, upwards or downwards (`step` 1, -1), of what a cell has in material at the
 * angles `in`. Layers too thin to be seen by themselves go with it. */
static double piece_end(struct moment *m, const swarf_meridian_piece *piece, int cell, uint32_t in, int step)
{
    const struct ring ring = ring_at(m, piece, cell_middle(piece, cell));
    double best = cell_middle(piece, cell);
    for (int k = 0; k < SCAN_ANGLES; k++) {
        const double angle = scan_angle(&ring, k);
        if (!(in >> k & 1)) continue;
        /* one that does not get farther than the best so far need not be bisected */
        if (best != cell_middle(piece, cell) && !reaches(m, piece, best, angle)) continue;
        double inner = best, outer;
        int next = cell + step;
        while ((outer = cell_middle(piece, next)) * step <= inner * step && next >= 0 && next < piece->cells)
            next += step;
        while (reaches(m, piece, outer, angle)) {
            inner = outer;
            if (next < 0 || next >= piece->cells) break;
            outer = cell_middle(piece, next += step);
        }
        while (fabs(outer - inner) * piece->length > settled * m->voxel) {
            const double middle = 0.5 * (inner + outer);
            if (reaches(m, piece, middle, angle))
                inner = middle;
            else
                outer = middle;
        }
        best = inner;
    }
    return best;
}

/* The angles at which the middle of a cell is deep in material, one bit each. */
static uint32_t scan_cell(struct moment *m, const swarf_meridian_piece *piece, int cell)
{
    const struct ring ring = ring_at(m, piece, cell_middle(piece, cell));
    uint32_t in = 0;
    if (ring.half == 0) return 0;
    const struct fan *fan = fan_of(m, ring.half, SCAN_ANGLES);
    const double least = least_cosine(m, &ring);
    for (int k = 0; k < SCAN_ANGLES; k++)
        if (fan->cosine[k] > least && depth_towards(m, &ring, fan->cosine[k], fan->sine[k]) > deep) in |= 1u << k;
    return in;
}

/* The first and last point of a piece that lie in material; 0 when none does. */
static int piece_range(struct moment *m, const swarf_meridian_piece *piece, double range[2])
{
    int lowest = 0, highest = piece->cells - 1;
    uint32_t at_lowest = 0, at_highest = 0;
    while (lowest < piece->cells && !(at_lowest = scan_cell(m, piece, lowest))) lowest++;
    if (lowest == piece->cells) return 0;
    while (!(at_highest = highest == lowest ? at_lowest : scan_cell(m, piece, highest))) highest--;
    range[0] = piece_end(m, piece, lowest, at_lowest, -1);
    range[1] = piece_end(m, piece, highest, at_highest, 1);
    return 1;
}

/* ---- what lies between two angles of a ring ---- */

static double overlap(double a, double b, double lo, double hi)
{
    return fmax(0, fmin(b, hi) - fmax(a, lo));
}

static double flow(const struct ring *ring, double a, double b)
{
    return b > a ? ring->front * (sin(b) - sin(a)) + ring->rise * (b - a) : 0;
}

static void reach_out(struct moment *m, double r, double a, double b)
{
    const double level = m->level < sideways ? M_PI : M_PI_2, lo = fmax(a, -level), hi = fmin(b, level);
    if (lo > hi) return;
    const double right = lo <= -M_PI_2 && hi >= -M_PI_2 ? -1 : fmin(sin(lo), sin(hi));
    const double left = lo <= M_PI_2 && hi >= M_PI_2 ? 1 : fmax(sin(lo), sin(hi));
    const double back = fmin(cos(lo), cos(hi)), front = lo <= 0 && hi >= 0 ? 1 : fmax(cos(lo), cos(hi));
    m->reach[0] = fmin(m->reach[0], r * right);
    m->reach[1] = fmax(m->reach[1], r * left);
    m->reach[2] = fmin(m->reach[2], r * back);
    m->reach[3] = fmax(m->reach[3], r * front);
}

/* Samples first .. last of a ring, in material. Those of neighbouring rings that overlap hang together; what hangs
 * together with anything deep counts. */
struct run {
    int ring, first, last, counts;
    double a, b;
};

enum { MOST_RUNS = MOST_RINGS * (RING_ANGLES / 2) };

static int find_runs(struct moment *m, const struct ring *rings, int ring_count, struct run *runs)
{
    int count = 0;
    for (int i = 0; i < ring_count; i++) {
        const double half = rings[i].half, step = 2 * half / RING_ANGLES;
        double depth[RING_ANGLES];
        if (half == 0) continue;
        const struct fan *fan = fan_of(m, half, RING_ANGLES);
        const double least = least_cosine(m, &rings[i]);
        for (int k = 0; k < RING_ANGLES; k++) depth[k] = depth_towards(m, &rings[i], fan->cosine[k], fan->sine[k]);
        for (int k = 0; k < RING_ANGLES; k++) {
            if (depth[k] <= edge) continue;
            struct run run = {.ring = i, .first = k};
            for (; k < RING_ANGLES && depth[k] > edge; k++) run.counts |= depth[k] > deep && fan->cosine[k] > least;
            run.last = k - 1;
            run.a = -half + (run.first + 0.5) * step;
            run.b = -half + (run.last + 0.5) * step;
            runs[count++] = run;
        }
    }
    for (int changed = 1; changed;) {
        changed = 0;
        for (int i = 0; i < count; i++)
            for (int k = 0; k < count && !runs[i].counts; k++) {
                if (!runs[k].counts || abs(runs[i].ring - runs[k].ring) != 1) continue;
                if (runs[i].a <= runs[k].b && runs[k].a <= runs[i].b) runs[i].counts = changed = 1;
            }
    }
    return count;
}

/* What a run adds; `width` is that of the strip its ring stands for, `ends` are the ends of the piece in material that
 * the strip reaches. Returns its angle. */
static double add_run(struct moment *m, const struct ring *ring, const struct run *run, double width,
                      const struct ring *ends, int end_count)
{
    const double step = 2 * ring->half / RING_ANGLES, plane = m->level < sideways ? M_PI : M_PI_2;
    const double a = ring_end(m, ring, run->a, run->first ? run->a - step : -ring->half);
    const double b = ring_end(m, ring, run->b, run->last + 1 < RING_ANGLES ? run->b + step : ring->half);
    const double scale = ring->r * width;
    m->found.area += scale * flow(ring, a, b);
    m->found.side += scale * (flow(ring, fmax(a, 0), b) - flow(ring, a, fmin(b, 0)));
    for (int i = -1; i < end_count; i++) {
        const struct ring *at = i < 0 ? ring : &ends[i];
        m->found.chip = fmax(m->found.chip, facing(at, fmax(a, fmin(b, 0))));
        reach_out(m, at->r, a, b);
    }
    return overlap(a, b, -plane, plane);
}

static void follow_piece(struct moment *m, const swarf_meridian_piece *piece)
{
    double range[2], angle[MOST_RINGS] = {0};
    struct ring rings[MOST_RINGS], ends[2];
    struct run runs[MOST_RUNS];
    if (!piece_range(m, piece, range)) return;
    const double length = (range[1] - range[0]) * piece->length;
    const int count = (int)fmax(1, fmin(MOST_RINGS, ceil(length / m->voxel)));
    for (int i = 0; i < 2; i++) {
        ends[i] = ring_at(m, piece, range[i]);
        m->z_lo = fmin(m->z_lo, ends[i].z);
        m->z_hi = fmax(m->z_hi, ends[i].z);
    }
    for (int i = 0; i < count; i++) rings[i] = ring_at(m, piece, range[0] + (range[1] - range[0]) * (i + 0.5) / count);
    const int run_count = find_runs(m, rings, count, runs);
    for (int k = 0; k < run_count; k++) {
        if (!runs[k].counts) continue;
        const int i = runs[k].ring, first = i == 0 ? 0 : 1, last = i == count - 1 ? 2 : 1;
        angle[i] += add_run(m, &rings[i], &runs[k], length / count, ends + first, last - first);
        m->found.angle = fmax(m->found.angle, angle[i]);
    }
}

swarf_status swarf_engage(const swarf_meridian *meridian, const swarf_material *material, const double tip[3],
                          const double along[3], swarf_engagement *out)
{
    struct moment m = {.meridian = meridian,
                       .material = material,
                       .probe = swarf_probe_begin(material->stock),
                       .level = hypot(along[0], along[1]),
                       .up = along[2],
                       .ahead_x = 1,
                       .reach = {INFINITY, -INFINITY, INFINITY, -INFINITY},
                       .z_lo = INFINITY,
                       .z_hi = -INFINITY};
    m.voxel = m.probe.layout->voxel;
    for (int k = 0; k < 3; k++) {
        m.tip[k] = (tip[k] - m.probe.layout->origin[k]) / m.voxel;
        if (!(fabs(m.tip[k]) < 1e8)) { /* no stock reaches there, nor do its numbers */
            *out = m.found;
            return SWARF_OK;
        }
    }
    if (m.level > 1e-9) {
        m.ahead_x = along[0] / m.level;
        m.ahead_y = along[1] / m.level;
    } else
        m.level = 0;
    for (size_t i = 0; i < meridian->count && m.status == SWARF_OK; i++) follow_piece(&m, &meridian->pieces[i]);
    if (m.status != SWARF_OK) return m.status;
    if (m.z_hi >= m.z_lo) m.found.depth = m.z_hi - m.z_lo;
    m.found.width = fmax(0, m.reach[1] - m.reach[0]);
    if (m.level < sideways) m.found.width = fmax(m.found.width, m.reach[3] - m.reach[2]);
    *out = m.found;
    return SWARF_OK;
}
