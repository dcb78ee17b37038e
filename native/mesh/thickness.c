/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Wall thickness along rays: from a triangle straight into the material, to where it ends at a face that lies opposite.
 * Of the two usual definitions, ray and largest inscribed ball, the ray's is taken: near an edge the ball's goes to
 * nothing however thick the part is. A ray that leaves by a face across it has only met the other side of an edge, as
 * beside the rim of a draft: that is no wall. */
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/mesh.h"
#include "render/embree_fixtures.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Rays per triangle: from its middle, and from near its corners, where walls that are not of one thickness are thinnest
 * and thickest; and how near. */
enum { RAYS = 4, TRIANGLES = SWARF_PACKET / RAYS, PACKETS_AT_ONCE = 256 };
static const double farthest = 1e6; /* mm, as swarf_fixtures_create() takes them */
static const double corner_weight = 0.98;
/* Cosine of the ray and the face it leaves by: edges of 60 degrees and more are none of a wall. */
static const double opposite = 0.5;

typedef struct measuring {
    swarf_triangles t;
    swarf_fixtures *scene;
    double inset; /* rays start so far inside: a triangle must not meet itself */
    float *out;
} measuring;

static int aim(const measuring *m, size_t triangle, swarf_rays *rays, unsigned first)
{
    double p[3][3], u[3], v[3], n[3];
    for (size_t i = 0; i < 3; i++)
        for (size_t k = 0; k < 3; k++) p[i][k] = (double)m->t.xyz[3 * (size_t)m->t.index[3 * triangle + i] + k];
    for (int k = 0; k < 3; k++) {
        u[k] = p[1][k] - p[0][k];
        v[k] = p[2][k] - p[0][k];
    }
    for (int k = 0; k < 3; k++) n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0)) return 0;
    for (unsigned r = 0; r < RAYS; r++) {
        double weight[3];
        for (unsigned i = 0; i < 3; i++)
            weight[i] = r == 0 ? 1.0 / 3 : r == i + 1 ? corner_weight : 0.5 * (1 - corner_weight);
        for (int k = 0; k < 3; k++) {
            rays->direction[k][first + r] = -n[k] / length;
            rays->origin[k][first + r] =
                weight[0] * p[0][k] + weight[1] * p[1][k] + weight[2] * p[2][k] - m->inset * n[k] / length;
        }
        rays->reach[first + r] = INFINITY;
        rays->distance[first + r] = INFINITY;
    }
    return 1;
}

/* The hit's normal is turned towards the ray. */
static int lies_opposite(const swarf_rays *rays, unsigned r)
{
    double along = 0;
    for (int k = 0; k < 3; k++) along -= (double)rays->normal[k][r] * rays->direction[k][r];
    return along > opposite;
}

static void measure_packet(const measuring *m, size_t first)
{
    swarf_rays rays = {0};
    unsigned active = 0;
    for (unsigned i = 0; i < TRIANGLES; i++) {
        if (first + i >= m->t.triangle_count) break;
        if (aim(m, first + i, &rays, RAYS * i)) active |= ((1u << RAYS) - 1) << (RAYS * i);
    }
    const unsigned hits = active ? swarf_fixtures_trace(m->scene, &rays, active) : 0;
    for (unsigned i = 0; i < TRIANGLES && first + i < m->t.triangle_count; i++) {
        double least = INFINITY;
        for (unsigned r = RAYS * i; r < RAYS * (i + 1); r++)
            if (hits >> r & 1 && lies_opposite(&rays, r)) least = fmin(least, rays.distance[r] + m->inset);
        m->out[first + i] = (float)least;
    }
}

static swarf_status measure_some(void *context, size_t index)
{
    const measuring *m = context;
    for (size_t i = 0; i < PACKETS_AT_ONCE; i++) {
        const size_t first = (index * PACKETS_AT_ONCE + i) * TRIANGLES;
        if (first < m->t.triangle_count) measure_packet(m, first);
    }
    return SWARF_OK;
}

swarf_status swarf_mesh_thickness(const swarf_mesh *mesh, const swarf_progress *progress, float *out)
{
    SWARF_REQUIRE(mesh && out, "mesh: NULL");
    measuring m = {.t = swarf_mesh_triangles(mesh), .out = out};
    if (!m.t.triangle_count) return SWARF_OK;
    const swarf_box box = swarf_mesh_topology(mesh).box;
    double most = 0;
    for (int k = 0; k < 3; k++) most = fmax(most, fmax(box.hi[k] - box.lo[k], fmax(fabs(box.lo[k]), fabs(box.hi[k]))));
    if (!(most <= farthest))
        return swarf_fail(SWARF_ERROR_GEOMETRY, "mesh: coordinates up to %g mm; thickness is measured up to %g", most,
                          farthest);
    m.inset = 8 * FLT_EPSILON * most; /* some steps of the coordinates that the rays are traced in */
    SWARF_TRY(swarf_fixtures_create(&m.t, 1, &m.scene));
    const size_t packets = (m.t.triangle_count + TRIANGLES - 1) / TRIANGLES;
    const swarf_status status =
        swarf_parallel_for((packets + PACKETS_AT_ONCE - 1) / PACKETS_AT_ONCE, measure_some, &m, progress, 0, 1);
    swarf_fixtures_destroy(m.scene);
    return status;
}
