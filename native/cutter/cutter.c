/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "cutter/cutter.h"

#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nodes closer than this (mm) are one: far below any voxel, far above rounding in CAD files. */
static const double same = 1e-7;

/* Profiles come from CAD outlines and hands; preparing one takes time by the square of its nodes. */
enum { MOST_NODES = 4096 };

static const char *part_name(swarf_part_kind kind)
{
    return kind == SWARF_PART_FLUTES ? "flutes" : kind == SWARF_PART_SHANK ? "shank" : "holder";
}

swarf_profile_piece swarf_profile_piece_get(const swarf_profile_node *node, const swarf_profile_node *next)
{
    swarf_profile_piece piece = {.r0 = node->r, .z0 = node->z, .r1 = next->r, .z1 = next->z, .convex = 1};
    const double dr = next->r - node->r, dz = next->z - node->z, b = node->bulge;
    const double chord = hypot(dr, dz);
    /* an arc this close to its chord is the chord: its centre would lie too far away to compute with */
    if (chord < same || 0.5 * chord * fabs(b) < same) return piece;
    /* the centre lies on the chord's bisector; left of the chord for a counter-clockwise minor arc */
    const double offset = (1 - b * b) / (4 * b);
    piece.centre_r = 0.5 * (node->r + next->r) - dz * offset;
    piece.centre_z = 0.5 * (node->z + next->z) + dr * offset;
    piece.radius = chord * (1 + b * b) / (4 * fabs(b));
    piece.convex = b > 0;
    return piece;
}

/* Sine of the angle by which the piece climbs at its start and end: below 0 it walks down. */
static double climb(const swarf_profile_piece *piece, int at_end)
{
    const double r = at_end ? piece->r1 : piece->r0;
    if (piece->radius == 0) return (piece->z1 - piece->z0) / hypot(piece->r1 - piece->r0, piece->z1 - piece->z0);
    return (piece->convex ? 1 : -1) * (r - piece->centre_r) / piece->radius;
}

static swarf_status check_piece(swarf_part_kind kind, size_t index, const swarf_profile_piece *piece)
{
    const char *name = part_name(kind);
    const double slope = 1e-6; /* of an angle: lines meant to be horizontal may be off by this much */
    if (climb(piece, 0) < -slope || climb(piece, 1) < -slope)
        return swarf_fail(SWARF_ERROR_GEOMETRY,
                          "cutter: the profile of the %s walks down at node %zu (r %g, z %g); it must have one radius "
                          "at each height, from the lowest to the highest",
                          name, index, piece->r0, piece->z0);
    if (piece->radius > 0 && !piece->convex && piece->centre_r - piece->radius < -same &&
        fmin(piece->z0, piece->z1) < piece->centre_z && fmax(piece->z0, piece->z1) > piece->centre_z)
        return swarf_fail(SWARF_ERROR_GEOMETRY, "cutter: the arc after node %zu of the %s crosses the axis", index,
                          name);
    return SWARF_OK;
}

/* Copy a part's nodes, adding the ends on the axis, leaving out repeated ones. */
static swarf_status copy_part(const swarf_cutter_part *part, swarf_cutter_part *out)
{
    const char *name = part_name(part->kind);
    SWARF_REQUIRE(part->kind <= SWARF_PART_HOLDER, "cutter: part kind %d does not exist", (int)part->kind);
    SWARF_REQUIRE(part->nodes || part->node_count == 0, "cutter: the nodes of the %s are missing", name);
    if (part->node_count > MOST_NODES)
        return swarf_fail(SWARF_ERROR_GEOMETRY, "cutter: the profile of the %s has %zu nodes; at most %d are taken",
                          name, part->node_count, MOST_NODES);
    if (part->node_count < 2) return swarf_fail(SWARF_ERROR_GEOMETRY, "cutter: the profile of the %s is empty", name);
    swarf_profile_node *nodes = malloc((part->node_count + 2) * sizeof *nodes);
    if (!nodes) return swarf_fail(SWARF_ERROR_MEMORY, "cutter: out of memory");
    size_t used = 0;
    swarf_status status = SWARF_OK;
    for (size_t i = 0; i < part->node_count && status == SWARF_OK; i++) {
        swarf_profile_node node = part->nodes[i];
        if (!isfinite(node.r) || !isfinite(node.z) || !isfinite(node.bulge))
            status = swarf_fail(SWARF_ERROR_ARGUMENT, "cutter: node %zu of the %s is not finite", i, name);
        else if (fabs(node.r) > SWARF_CUTTER_LIMIT_MM || fabs(node.z) > SWARF_CUTTER_LIMIT_MM)
            status = swarf_fail(SWARF_ERROR_GEOMETRY,
                                "cutter: node %zu of the %s lies at r %g, z %g mm; at most %g mm is possible", i, name,
                                node.r, node.z, SWARF_CUTTER_LIMIT_MM);
        else if (node.r < -same)
            status =
                swarf_fail(SWARF_ERROR_GEOMETRY,
                           "cutter: node %zu of the %s has the radius %g; it must not be negative", i, name, node.r);
        else if (fabs(node.bulge) > 1 + 1e-9)
            status = swarf_fail(SWARF_ERROR_GEOMETRY,
                                "cutter: the arc after node %zu of the %s is more than half a circle", i, name);
        if (node.r < same) node.r = 0;
        if (i == 0 && node.r > 0) nodes[used++] = (swarf_profile_node){0, node.z, 0};
        if (used && hypot(node.r - nodes[used - 1].r, node.z - nodes[used - 1].z) < same) {
            nodes[used - 1].bulge = node.bulge; /* the next piece starts here */
            continue;
        }
        nodes[used++] = node;
    }
    if (status == SWARF_OK && nodes[used - 1].r > 0) {
        nodes[used - 1].bulge = 0;
        nodes[used] = (swarf_profile_node){0, nodes[used - 1].z, 0};
        used++;
    }
    if (status == SWARF_OK) nodes[used - 1].bulge = 0;
    double most = 0;
    for (size_t i = 0; i + 1 < used && status == SWARF_OK; i++) {
        const swarf_profile_piece piece = swarf_profile_piece_get(&nodes[i], &nodes[i + 1]);
        status = check_piece(part->kind, i, &piece);
        most = fmax(most, fmax(piece.r0, piece.radius > 0 && piece.convex ? piece.centre_r + piece.radius : piece.r1));
    }
    if (status == SWARF_OK && (most < same || nodes[used - 1].z - nodes[0].z < same))
        status = swarf_fail(SWARF_ERROR_GEOMETRY, "cutter: the profile of the %s encloses nothing", name);
    if (status != SWARF_OK) {
        free(nodes);
        return status;
    }
    *out = (swarf_cutter_part){part->kind, nodes, used};
    return SWARF_OK;
}

swarf_status swarf_cutter_create(const swarf_cutter_part *parts, size_t part_count, swarf_cutter **out)
{
    SWARF_REQUIRE(parts && part_count && out, "cutter: no parts");
    swarf_cutter *cutter = calloc(1, sizeof *cutter);
    if (!cutter) return swarf_fail(SWARF_ERROR_MEMORY, "cutter: out of memory");
    cutter->references = 1;
    cutter->parts = calloc(part_count, sizeof *cutter->parts);
    swarf_status status = cutter->parts ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "cutter: out of memory");
    for (size_t i = 0; i < part_count && status == SWARF_OK; i++) {
        status = copy_part(&parts[i], &cutter->parts[i]);
        if (status == SWARF_OK) cutter->part_count++;
    }
    if (status != SWARF_OK) {
        swarf_cutter_release(cutter);
        return status;
    }
    *out = cutter;
    return SWARF_OK;
}

swarf_cutter *swarf_cutter_retain(swarf_cutter *cutter)
{
    if (cutter) __atomic_add_fetch(&cutter->references, 1, __ATOMIC_RELAXED);
    return cutter;
}

void swarf_cutter_release(swarf_cutter *cutter)
{
    if (!cutter || __atomic_sub_fetch(&cutter->references, 1, __ATOMIC_ACQ_REL) > 0) return;
    for (size_t i = 0; i < cutter->part_count; i++) free((void *)cutter->parts[i].nodes);
    free(cutter->parts);
    free(cutter);
}

size_t swarf_cutter_part_count(const swarf_cutter *cutter)
{
    return cutter ? cutter->part_count : 0;
}

swarf_status swarf_cutter_part_get(const swarf_cutter *cutter, size_t index, swarf_cutter_part *out)
{
    SWARF_REQUIRE(cutter && out, "cutter: NULL");
    SWARF_REQUIRE(index < cutter->part_count, "cutter: part %zu of %zu", index, cutter->part_count);
    *out = cutter->parts[index];
    return SWARF_OK;
}

/* Greatest radius of a piece between two heights that it spans. */
static double widest(const swarf_profile_piece *piece)
{
    double most = fmax(piece->r0, piece->r1);
    if (piece->radius > 0 && piece->convex && piece->centre_z > piece->z0 && piece->centre_z < piece->z1)
        most = piece->centre_r + piece->radius;
    return most;
}

/* Radius of a piece at a height within it. */
static double radius_at(const swarf_profile_piece *piece, double z)
{
    if (piece->z1 - piece->z0 < same) return fmax(piece->r0, piece->r1);
    if (piece->radius == 0) return piece->r0 + (piece->r1 - piece->r0) * (z - piece->z0) / (piece->z1 - piece->z0);
    const double dz = z - piece->centre_z;
    const double dr = sqrt(fmax(0, piece->radius * piece->radius - dz * dz));
    return piece->centre_r + (piece->convex ? dr : -dr);
}

/* Integral of r^2 dz over a piece; times pi the volume between it and the axis. */
static double square_integral(const swarf_profile_piece *piece)
{
    const double h = piece->z1 - piece->z0;
    if (piece->radius == 0) return h * (piece->r0 * piece->r0 + piece->r0 * piece->r1 + piece->r1 * piece->r1) / 3;
    /* r = c +- sqrt(R^2 - u^2), u = z - centre: r^2 = c^2 +- 2 c sqrt(R^2 - u^2) + R^2 - u^2 */
    const double R = piece->radius, c = piece->centre_r;
    const double u0 = fmax(-R, fmin(R, piece->z0 - piece->centre_z)),
                 u1 = fmax(-R, fmin(R, piece->z1 - piece->centre_z));
    const double root =
        0.5 * (u1 * sqrt(R * R - u1 * u1) - u0 * sqrt(R * R - u0 * u0) + R * R * (asin(u1 / R) - asin(u0 / R)));
    return (c * c + R * R) * (u1 - u0) - (u1 * u1 * u1 - u0 * u0 * u0) / 3 + (piece->convex ? 2 : -2) * c * root;
}

/* Call `see` for every piece of the parts of one kind. */
typedef void (*piece_fn)(void *context, const swarf_profile_piece *piece);
static void for_pieces(const swarf_cutter *cutter, swarf_part_kind kind, piece_fn see, void *context)
{
    for (size_t p = 0; cutter && p < cutter->part_count; p++) {
        const swarf_cutter_part *part = &cutter->parts[p];
        if (part->kind != kind) continue;
        for (size_t i = 0; i + 1 < part->node_count; i++) {
            const swarf_profile_piece piece = swarf_profile_piece_get(&part->nodes[i], &part->nodes[i + 1]);
            see(context, &piece);
        }
    }
}

static void see_widest(void *context, const swarf_profile_piece *piece)
{
    double *most = context;
    *most = fmax(*most, widest(piece));
}

double swarf_cutter_radius(const swarf_cutter *cutter, swarf_part_kind kind)
{
    double most = 0;
    for_pieces(cutter, kind, see_widest, &most);
    return most;
}

static void see_extent(void *context, const swarf_profile_piece *piece)
{
    double *extent = context;
    extent[0] = fmin(extent[0], piece->z0);
    extent[1] = fmax(extent[1], piece->z1);
}

void swarf_cutter_extent(const swarf_cutter *cutter, swarf_part_kind kind, double *z_lo, double *z_hi)
{
    double extent[2] = {INFINITY, -INFINITY};
    for_pieces(cutter, kind, see_extent, extent);
    const int none = extent[0] > extent[1];
    *z_lo = none ? 0 : extent[0];
    *z_hi = none ? 0 : extent[1];
}

/* Nodes only climb, so that the pieces at a height lie together and are found by bisection. */
double swarf_cutter_radius_at(const swarf_cutter *cutter, swarf_part_kind kind, double z)
{
    double most = -1;
    for (size_t p = 0; cutter && p < cutter->part_count; p++) {
        const swarf_cutter_part *part = &cutter->parts[p];
        if (part->kind != kind) continue;
        size_t lo = 0, hi = part->node_count - 1; /* first node at or above z, or the last one */
        while (lo < hi) {
            const size_t middle = (lo + hi) / 2;
            if (part->nodes[middle].z < z - same)
                lo = middle + 1;
            else
                hi = middle;
        }
        for (size_t i = lo ? lo - 1 : 0; i + 1 < part->node_count && part->nodes[i].z <= z + same; i++) {
            const swarf_profile_piece piece = swarf_profile_piece_get(&part->nodes[i], &part->nodes[i + 1]);
            if (z <= piece.z1 + same) most = fmax(most, radius_at(&piece, z));
        }
    }
    return most;
}

static void see_volume(void *context, const swarf_profile_piece *piece)
{
    *(double *)context += M_PI * square_integral(piece);
}

double swarf_cutter_volume(const swarf_cutter *cutter, swarf_part_kind kind)
{
    double volume = 0;
    for_pieces(cutter, kind, see_volume, &volume);
    return volume;
}
