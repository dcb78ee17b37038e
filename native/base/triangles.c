/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Topology of triangles: every undirected edge with how often it is used each way, by sorting. */
#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Edge a < b packed as a << 32 | b in the high bits, used forwards (a -> b) or not. */
typedef struct edge {
    uint64_t key;
    uint32_t forward;
    uint32_t triangle;
} edge;

static int compare_edges(const void *left, const void *right)
{
    const uint64_t a = ((const edge *)left)->key, b = ((const edge *)right)->key;
    return a < b ? -1 : a > b;
}

static swarf_status count_edges(const swarf_triangles *t, swarf_topology *topology)
{
    const size_t count = t->triangle_count * 3;
    if (count == 0) return SWARF_OK;
    edge *edges = malloc(count * sizeof *edges);
    if (!edges)
        return swarf_fail(SWARF_ERROR_MEMORY, "out of memory for the edges of %zu triangles", t->triangle_count);
    size_t used = 0;
    for (size_t i = 0; i < t->triangle_count; i++) {
        const uint32_t *v = t->index + 3 * i;
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
            topology->degenerate++;
            continue;
        }
        for (int k = 0; k < 3; k++) {
            const uint32_t a = v[k], b = v[(k + 1) % 3];
            edges[used].forward = a < b;
            edges[used].key = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
            edges[used++].triangle = (uint32_t)i;
        }
    }
    qsort(edges, used, sizeof *edges, compare_edges);
    int balanced = 1;
    for (size_t i = 0; i < used;) {
        size_t j = i, forward = 0;
        for (; j < used && edges[j].key == edges[i].key; j++) forward += edges[j].forward;
        const size_t uses = j - i;
        if (uses == 1) topology->boundary_edges++;
        if (uses > 2) topology->nonmanifold_edges++;
        if (uses == 2 && forward != 1) topology->misoriented_edges++;
        if (2 * forward != uses) balanced = 0;
        i = j;
    }
    free(edges);
    topology->closed = balanced && used > 0;
    return SWARF_OK;
}

swarf_status swarf_triangles_topology(const swarf_triangles *t, swarf_topology *out)
{
    SWARF_REQUIRE(t && out, "triangles: NULL");
    SWARF_REQUIRE((t->xyz || !t->vertex_count) && (t->index || !t->triangle_count), "triangles: arrays missing");
    swarf_topology topology;
    memset(&topology, 0, sizeof topology);
    for (int k = 0; k < 3; k++) {
        topology.box.lo[k] = INFINITY;
        topology.box.hi[k] = -INFINITY;
    }
    for (size_t i = 0; i < 3 * t->vertex_count; i++)
        SWARF_REQUIRE(isfinite(t->xyz[i]), "triangles: coordinate %c of vertex %zu is not finite", "xyz"[i % 3], i / 3);
    for (size_t i = 0; i < t->triangle_count; i++) {
        double p[3][3];
        for (int k = 0; k < 3; k++) {
            const uint32_t v = t->index[3 * i + (size_t)k];
            SWARF_REQUIRE(v < t->vertex_count, "triangles: triangle %zu uses vertex %u of %zu", i, v, t->vertex_count);
            for (int c = 0; c < 3; c++) {
                p[k][c] = t->xyz[3 * (size_t)v + (size_t)c];
                if (p[k][c] < topology.box.lo[c]) topology.box.lo[c] = p[k][c];
                if (p[k][c] > topology.box.hi[c]) topology.box.hi[c] = p[k][c];
            }
        }
        double u[3], v[3];
        for (int c = 0; c < 3; c++) {
            u[c] = p[1][c] - p[0][c];
            v[c] = p[2][c] - p[0][c];
        }
        const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        topology.area_mm2 += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        /* relative to the first vertex, so that far away parts lose no digits */
        const float *o = t->xyz;
        topology.volume_mm3 += ((p[0][0] - o[0]) * n[0] + (p[0][1] - o[1]) * n[1] + (p[0][2] - o[2]) * n[2]) / 6.0;
    }
    SWARF_TRY(count_edges(t, &topology));
    *out = topology;
    return SWARF_OK;
}
