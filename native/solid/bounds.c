/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What bounds a solid. Triangles that meet no others make patches, joined along their edges, which bound the solid all
 * over or nowhere; those that meet others are cut into pieces that do. Where all of them bound it nothing changes; else
 * the tree is built anew from what does, and the old one stays for the winding number. */
#include "base/status.h"
#include "solid/crossing.h"
#include "solid/pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double square(const double v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

static uint32_t find_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

static int meets_others(const swarf_crossings *crossings, size_t place)
{
    return crossings->first && crossings->first[place] < crossings->first[place + 1];
}

/* Whether a triangle that meets no other bounds the solid. */
static int bounds_at_middle(const swarf_solid *solid, size_t place)
{
    const swarf_corners *t = &solid->corners[place];
    double middle[3], normal[3];
    swarf_corners_normal(t, normal);
    const double length = sqrt(square(normal));
    if (!(length > 0)) return 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = ((double)t->xyz[0][k] + t->xyz[1][k] + t->xyz[2][k]) / 3;
        normal[k] /= length;
    }
    return swarf_solid_bounds(solid, middle, normal) != 0;
}

/* Fill keep[place]: 1 for triangles that meet no others and bound the solid. The largest of each patch is asked. */
static swarf_status find_patches(const swarf_solid *solid, const swarf_crossings *crossings, uint8_t *keep)
{
    const size_t count = solid->tree.count;
    uint32_t *parent = malloc(count * sizeof *parent), *largest = malloc(count * sizeof *largest);
    size_t patches = 0;
    if (!parent || !largest) {
        free(parent);
        free(largest);
        return swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory");
    }
    for (size_t i = 0; i < count; i++) largest[i] = parent[i] = (uint32_t)i;
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3 && !meets_others(crossings, i); k++) {
            const uint32_t other = solid->across[i][k];
            if (other >= i || meets_others(crossings, other)) continue;
            const uint32_t a = find_root(parent, (uint32_t)i), b = find_root(parent, other);
            parent[a > b ? a : b] = a > b ? b : a;
        }
    }
    for (size_t i = 0; i < count; i++) {
        const uint32_t root = find_root(parent, (uint32_t)i);
        keep[i] = !meets_others(crossings, i);
        patches += keep[i] && root == i;
        double own[3], most[3];
        swarf_corners_normal(&solid->corners[i], own);
        swarf_corners_normal(&solid->corners[largest[root]], most);
        if (square(own) > square(most)) largest[root] = (uint32_t)i;
    }
    if (patches > 1 || crossings->first) { /* a single patch bounds whatever there is */
        for (size_t i = 0; i < count; i++) /* no root is above its members */
            keep[i] = keep[i] && (parent[i] == i ? bounds_at_middle(solid, largest[i]) : keep[parent[i]]);
    }
    free(parent);
    free(largest);
    return SWARF_OK;
}

/* Arrays by place of a tree that is built anew. */
struct bounds {
    size_t count;
    swarf_box_tree tree;
    swarf_corners *corners;
    uint32_t *number; /* before the tree was built */
    uint32_t *place;  /* by number: in the tree of all */
    uint8_t *state;   /* by number */
    uint32_t *source, (*vertex)[3], (*across)[3];
    uint8_t *sorted_state;
    uint32_t *map; /* by place in the tree of all: where it, or a piece that has its normal, is now */
};

static void free_bounds(struct bounds *b)
{
    swarf_box_tree_free(&b->tree);
    free(b->corners);
    free(b->number);
    free(b->place);
    free(b->state);
    free(b->source);
    free(b->vertex);
    free(b->across);
    free(b->sorted_state);
    free(b->map);
}

static swarf_status allocate(struct bounds *b, size_t all)
{
    const size_t count = b->count;
    b->corners = malloc(count * sizeof *b->corners);
    b->number = malloc(count * sizeof *b->number);
    b->place = malloc(count * sizeof *b->place);
    b->state = malloc(count * sizeof *b->state);
    b->source = malloc(count * sizeof *b->source);
    b->vertex = malloc(count * sizeof *b->vertex);
    b->across = malloc(count * sizeof *b->across);
    b->sorted_state = malloc(count * sizeof *b->sorted_state);
    b->map = malloc(all * sizeof *b->map);
    if (!b->corners || !b->number || !b->place || !b->state || !b->source || !b->vertex || !b->across ||
        !b->sorted_state || !b->map)
        return swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory for %zu triangles", count);
    memset(b->map, 0xff, all * sizeof *b->map);
    return SWARF_OK;
}

static void add(struct bounds *b, size_t *used, const swarf_corners *corners, size_t place, int state)
{
    b->corners[*used] = *corners;
    b->number[*used] = (uint32_t)*used;
    b->place[*used] = (uint32_t)place;
    b->state[(*used)++] = (uint8_t)state;
}

/* What was known of the triangles, in the order of the new tree. */
static void sort_bounds(const swarf_solid *solid, struct bounds *b)
{
    for (size_t i = 0; i < b->count; i++) {
        const uint32_t number = b->number[i], place = b->place[number];
        b->sorted_state[i] = b->state[number];
        b->source[i] = solid->source[place];
        memcpy(b->vertex[i], solid->vertex[place], sizeof b->vertex[i]);
        memcpy(b->across[i], solid->across[place], sizeof b->across[i]);
        if (b->state[number] != SOLID_SLIVER) b->map[place] = (uint32_t)i;
    }
    for (size_t i = 0; i < b->count; i++)
        for (int k = 0; k < 3; k++)
            if (b->across[i][k] != UINT32_MAX) b->across[i][k] = b->map[b->across[i][k]];
}

static void take(swarf_solid *solid, struct bounds *b)
{
    free(solid->source);
    free(solid->vertex);
    free(solid->across);
    free(solid->state);
    solid->tree = b->tree;
    solid->corners = b->corners;
    solid->source = b->source;
    solid->vertex = b->vertex;
    solid->across = b->across;
    solid->state = b->sorted_state;
    free(b->number);
    free(b->place);
    free(b->state);
    free(b->map);
}

static swarf_status build_bounds(swarf_solid *solid, const uint8_t *keep, const swarf_pieces *pieces, size_t count,
                                 const swarf_progress *progress, double from, double to)
{
    struct bounds b = {.count = count};
    size_t used = 0;
    swarf_status status = allocate(&b, solid->tree.count);
    for (size_t i = 0; i < solid->tree.count && status == SWARF_OK; i++)
        if (keep[i]) add(&b, &used, &solid->corners[i], i, SOLID_PLAIN);
    for (size_t i = 0; i < pieces->count && status == SWARF_OK; i++)
        add(&b, &used, &pieces->list[i].corners, pieces->list[i].place, pieces->list[i].state);
    if (status == SWARF_OK) status = swarf_box_tree_build(b.corners, b.number, b.count, progress, from, to, &b.tree);
    if (status != SWARF_OK) {
        free_bounds(&b);
        return status;
    }
    sort_bounds(solid, &b);
    take(solid, &b);
    return SWARF_OK;
}

/* Volume and area by what bounds the solid: inner triangles count twice in the others' sum. The volume of an open one
 * stays as it is: without what is inside, its holes would weigh more. */
static void measure(swarf_solid *solid)
{
    double volume = 0, area = 0;
    for (size_t i = 0; i < solid->tree.count; i++) {
        const swarf_corners *t = &solid->corners[i];
        double normal[3], height = 0;
        swarf_corners_normal(t, normal);
        for (int k = 0; k < 3; k++) height += normal[k] * (t->xyz[0][k] - solid->facts.box.lo[k]);
        volume += height / 6;
        area += 0.5 * sqrt(square(normal));
    }
    if (!solid->open) solid->facts.volume_mm3 = volume;
    solid->facts.area_mm2 = area;
}

static swarf_status find_bounds(swarf_solid *solid, const swarf_crossings *crossings, uint8_t *keep,
                                const swarf_progress *progress, double from, double to)
{
    swarf_pieces pieces = {.list = NULL};
    size_t kept = 0;
    SWARF_TRY(find_patches(solid, crossings, keep));
    for (size_t i = 0; i < solid->tree.count; i++) kept += keep[i];
    solid->facts.triangle_count = kept;
    if (kept == solid->tree.count) return SWARF_OK;
    swarf_status status = swarf_pieces_cut(solid, crossings, progress, from, 0.7 * from + 0.3 * to, &pieces);
    for (size_t i = 0; i < pieces.count; i++)
        solid->facts.triangle_count += i == 0 || pieces.list[i].place != pieces.list[i - 1].place;
    const size_t count = kept + pieces.count;
    size_t whole = kept;
    for (size_t i = 0; i < pieces.count; i++) whole += (size_t)pieces.list[i].whole;
    if (status == SWARF_OK && whole == solid->tree.count) { /* some touch others, yet all bound it as they are */
        for (size_t i = 0; i < pieces.count; i++) solid->state[pieces.list[i].place] = SOLID_PIECE;
        swarf_pieces_free(&pieces);
        return SWARF_OK;
    }
    if (status == SWARF_OK && count == 0)
        status = swarf_fail(SWARF_ERROR_GEOMETRY, "mesh: its triangles enclose nothing");
    if (status == SWARF_OK && count > UINT32_MAX / 3)
        status = swarf_fail(SWARF_ERROR_GEOMETRY, "mesh: its triangles cross so often that they fall into %zu pieces",
                            count);
    if (status == SWARF_OK) status = build_bounds(solid, keep, &pieces, count, progress, 0.7 * from + 0.3 * to, to);
    swarf_pieces_free(&pieces);
    if (status == SWARF_OK) measure(solid);
    return status;
}

swarf_status swarf_solid_find_bounds(swarf_solid *solid, const swarf_progress *progress, double from, double to)
{
    swarf_crossings crossings = {.first = NULL};
    const double middle = 0.5 * (from + to);
    uint8_t *keep = calloc(solid->tree.count, 1);
    if (!keep) return swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory");
    swarf_status status = swarf_crossings_find(solid, progress, from, middle, &crossings);
    solid->facts.crossing_triangles = crossings.count;
    if (status == SWARF_OK) status = find_bounds(solid, &crossings, keep, progress, middle, to);
    swarf_crossings_free(&crossings);
    free(keep);
    return status;
}
