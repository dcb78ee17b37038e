/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Half-edges are put into one bucket per lower vertex, which holds six of them on a usual surface; in it each looks for
 * a free one with the same ends the other way: linear in time for millions of triangles. */
#include "mesh/halfedge.h"

#include "base/status.h"

#include <stdlib.h>
#include <string.h>

static uint32_t from_of(const swarf_triangles *t, uint32_t h)
{
    return t->index[h];
}

static uint32_t to_of(const swarf_triangles *t, uint32_t h)
{
    return t->index[h % 3 == 2 ? h - 2 : h + 1];
}

static int is_degenerate(const uint32_t v[3])
{
    return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
}

static uint32_t lower_of(const swarf_triangles *t, uint32_t h)
{
    const uint32_t a = from_of(t, h), b = to_of(t, h);
    return a < b ? a : b;
}

swarf_status swarf_halfedges_create(const swarf_triangles *t, uint32_t **opposite)
{
    SWARF_REQUIRE(t->triangle_count < SWARF_NO_HALFEDGE / 3, "mesh: %zu triangles are more than half-edges can number",
                  t->triangle_count);
    const uint32_t count = (uint32_t)(3 * t->triangle_count);
    size_t *end = calloc(t->vertex_count + 1, sizeof *end);
    uint32_t *sorted = calloc((size_t)count + 1, sizeof *sorted), *out = malloc(((size_t)count + 1) * sizeof *out);
    if (!end || !sorted || !out) {
        free(end);
        free(sorted);
        free(out);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for the edges of %zu triangles", t->triangle_count);
    }
    memset(out, 0xff, count * sizeof *out);
    for (uint32_t h = 0; h < count; h++)
        if (!is_degenerate(t->index + h / 3 * 3)) end[(size_t)lower_of(t, h) + 1]++;
    for (size_t v = 0; v < t->vertex_count; v++) end[v + 1] += end[v];
    for (uint32_t h = 0; h < count; h++)
        if (!is_degenerate(t->index + h / 3 * 3)) sorted[end[lower_of(t, h)]++] = h;
    size_t first = 0;
    for (size_t v = 0; v < t->vertex_count; v++) {
        for (size_t i = first; i < end[v]; i++)
            for (size_t j = first; j < i && out[sorted[i]] == SWARF_NO_HALFEDGE; j++) {
                const uint32_t h = sorted[i], g = sorted[j];
                if (out[g] != SWARF_NO_HALFEDGE || from_of(t, h) != to_of(t, g) || to_of(t, h) != from_of(t, g))
                    continue;
                out[h] = g;
                out[g] = h;
            }
        first = end[v];
    }
    free(end);
    free(sorted);
    *opposite = out;
    return SWARF_OK;
}

swarf_status swarf_halfedges_pieces(const uint32_t *opposite, size_t triangle_count, uint32_t *piece_of, size_t *count)
{
    uint32_t *stack = malloc((triangle_count + 1) * sizeof *stack);
    if (!stack) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", triangle_count);
    memset(piece_of, 0xff, triangle_count * sizeof *piece_of);
    size_t pieces = 0;
    for (size_t first = 0; first < triangle_count; first++) {
        if (piece_of[first] != UINT32_MAX) continue;
        size_t depth = 0;
        piece_of[first] = (uint32_t)pieces;
        stack[depth++] = (uint32_t)first;
        while (depth) {
            const uint32_t t = stack[--depth];
            for (uint32_t k = 0; k < 3; k++) {
                const uint32_t other = opposite[3 * t + k];
                if (other == SWARF_NO_HALFEDGE || piece_of[other / 3] != UINT32_MAX) continue;
                piece_of[other / 3] = (uint32_t)pieces;
                stack[depth++] = other / 3;
            }
        }
        pieces++;
    }
    free(stack);
    *count = pieces;
    return SWARF_OK;
}
