/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Topology of triangles: every undirected edge with how often it is used each way. The uses are put into one bucket per
 * lower vertex, which holds six of them on a usual surface, and sorted there: linear in time for millions of triangles.
 */
#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Uses in a bucket beyond which insertion is slower than qsort: the hub of a fan has thousands. */
enum { FEW = 24 };

static int is_degenerate(const uint32_t v[3])
{
    return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
}

static int compare_uses(const void *left, const void *right)
{
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return a < b ? -1 : a > b;
}

static void sort_uses(uint64_t *use, size_t count)
{
    if (count > FEW) {
        qsort(use, count, sizeof *use, compare_uses);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const uint64_t own = use[i];
        size_t j = i;
        for (; j > 0 && use[j - 1] > own; j--) use[j] = use[j - 1];
        use[j] = own;
    }
}

/* The edges of one bucket; a use is the higher vertex << 1 | whether it goes from the lower to the higher. Returns
 * whether every edge is used as often one way as the other. */
static int count_bucket(uint64_t *use, size_t count, swarf_topology *topology)
{
    int balanced = 1;
    sort_uses(use, count);
    for (size_t i = 0, j; i < count; i = j) {
        size_t forward = 0;
        for (j = i; j < count && use[j] >> 1 == use[i] >> 1; j++) forward += use[j] & 1;
        const size_t uses = j - i;
        if (uses == 1) topology->boundary_edges++;
        if (uses > 2) topology->nonmanifold_edges++;
        if (uses == 2 && forward != 1) topology->misoriented_edges++;
        if (2 * forward != uses) balanced = 0;
    }
    return balanced;
}

/* `end[v + 1]`: how many uses vertex v has as the lower one; then where its bucket starts; at last where it ends. */
static void fill_buckets(const swarf_triangles *t, size_t *end, uint64_t *uses)
{
    for (size_t v = 0; v < t->vertex_count; v++) end[v + 1] += end[v];
    for (size_t i = 0; i < t->triangle_count; i++) {
        const uint32_t *v = t->index + 3 * i;
        if (is_degenerate(v)) continue;
        for (int k = 0; k < 3; k++) {
            const uint32_t a = v[k], b = v[(k + 1) % 3];
            uses[end[a < b ? a : b]++] = a < b ? (uint64_t)b << 1 | 1 : (uint64_t)a << 1;
        }
    }
}

static swarf_status count_edges(const swarf_triangles *t, swarf_topology *topology)
{
    if (t->triangle_count == 0) return SWARF_OK;
    size_t *end = calloc(t->vertex_count + 1, sizeof *end);
    uint64_t *uses = malloc(3 * t->triangle_count * sizeof *uses);
    if (!end || !uses) {
        free(end);
        free(uses);
        return swarf_fail(SWARF_ERROR_MEMORY, "out of memory for the edges of %zu triangles", t->triangle_count);
    }
    for (size_t i = 0; i < t->triangle_count; i++) {
        const uint32_t *v = t->index + 3 * i;
        if (is_degenerate(v)) {
            topology->degenerate++;
            continue;
        }
        for (int k = 0; k < 3; k++) {
            const uint32_t a = v[k], b = v[(k + 1) % 3];
            end[(size_t)(a < b ? a : b) + 1]++;
        }
    }
    fill_buckets(t, end, uses);
    int balanced = 1;
    size_t first = 0;
    for (size_t v = 0; v < t->vertex_count; v++) {
        balanced &= count_bucket(uses + first, end[v] - first, topology);
        first = end[v];
    }
    free(end);
    free(uses);
    topology->closed = balanced && first > 0;
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
