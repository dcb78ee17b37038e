/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "mesh/colours.h"

#include "base/status.h"

#include <stdlib.h>
#include <string.h>

static uint32_t pack(const uint8_t rgb[3])
{
    return (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
}

/* The copies of a vertex are a list: the vertex itself, then next[] of it; a vertex without colour yet takes the first
 * that comes. */
swarf_status swarf_painted_create(const swarf_triangles *t, const uint8_t *rgb, swarf_painted *out)
{
    memset(out, 0, sizeof *out);
    out->triangles = *t;
    if (!rgb || t->triangle_count == 0) return SWARF_OK;
    const size_t most = t->vertex_count + 3 * t->triangle_count;
    uint32_t *next = malloc(most * sizeof *next), *colour = malloc(most * sizeof *colour);
    out->xyz = malloc(3 * most * sizeof *out->xyz);
    out->vertex_rgb = calloc(most, 3);
    out->index = malloc(3 * t->triangle_count * sizeof *out->index);
    swarf_status status = SWARF_OK;
    size_t used = t->vertex_count;
    if (!next || !colour || !out->xyz || !out->vertex_rgb || !out->index || most >= UINT32_MAX) {
        status = swarf_fail(SWARF_ERROR_MEMORY, "out of memory for the colours of %zu triangles", t->triangle_count);
    } else {
        memset(next, 0xff, most * sizeof *next);
        memset(colour, 0xff, most * sizeof *colour);
        memcpy(out->xyz, t->xyz, 3 * t->vertex_count * sizeof *out->xyz);
        for (size_t i = 0; i < 3 * t->triangle_count; i++) {
            const uint8_t *own = rgb + i / 3 * 3;
            const uint32_t wanted = pack(own);
            uint32_t v = t->index[i];
            while (colour[v] != UINT32_MAX && colour[v] != wanted && next[v] != UINT32_MAX) v = next[v];
            if (colour[v] != UINT32_MAX && colour[v] != wanted) {
                memcpy(out->xyz + 3 * used, t->xyz + 3 * (size_t)t->index[i], 3 * sizeof *out->xyz);
                next[v] = (uint32_t)used;
                v = (uint32_t)used++;
            }
            colour[v] = wanted;
            memcpy(out->vertex_rgb + 3 * (size_t)v, own, 3);
            out->index[i] = v;
        }
    }
    free(next);
    free(colour);
    if (status != SWARF_OK) {
        swarf_painted_free(out);
        return status;
    }
    out->triangles = (swarf_triangles){out->xyz, used, out->index, t->triangle_count};
    return SWARF_OK;
}

void swarf_painted_free(swarf_painted *painted)
{
    free(painted->xyz);
    free(painted->index);
    free(painted->vertex_rgb);
    memset(painted, 0, sizeof *painted);
}

static int compare_colours(const void *left, const void *right)
{
    const uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    return a < b ? -1 : a > b;
}

swarf_status swarf_palette(const uint8_t *rgb, size_t count, uint32_t **out, size_t *colours)
{
    uint32_t *all = malloc((count + 1) * sizeof *all);
    if (!all) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory for %zu colours", count);
    for (size_t i = 0; i < count; i++) all[i] = pack(rgb + 3 * i);
    qsort(all, count, sizeof *all, compare_colours);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || all[kept - 1] != all[i]) all[kept++] = all[i];
    *out = all;
    *colours = kept;
    return SWARF_OK;
}

size_t swarf_palette_find(const uint32_t *palette, size_t colours, const uint8_t rgb[3])
{
    const uint32_t wanted = pack(rgb);
    const uint32_t *found = bsearch(&wanted, palette, colours, sizeof *palette, compare_colours);
    return found ? (size_t)(found - palette) : 0;
}
