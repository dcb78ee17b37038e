/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Parts of facets that cut others: looked for among the facets in and about the cubes that the facets cut are in.
 * Larger ones, those of tiles, and what long parts meet farther out are left to the check of the whole mesh. */
#include "mesh/crease.h"

#include "base/mix.h"
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/intersect.h"

#include <stdlib.h>
#include <string.h>

enum { PIECE = 16384 };

/* Numbers of cubes, by open addressing; 0: empty. */
typedef struct cube_set {
    uint64_t *slots;
    size_t slot_count;
} cube_set;

static size_t find(const cube_set *set, uint64_t cube)
{
    size_t at = (size_t)swarf_mix(cube) & (set->slot_count - 1);
    while (set->slots[at] && set->slots[at] != cube) at = (at + 1) & (set->slot_count - 1);
    return at;
}

static void middle_of(const swarf_facets *facets, const swarf_facet *facet, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    for (int k = 0; k < 3; k++) {
        double p[3];
        swarf_crease_place(facets, facet->v[k], p);
        for (int c = 0; c < 3; c++) out[c] += p[c] / 3;
    }
}

/* The cubes of the facets that are cut, and those about them. */
static swarf_status find_cubes(const contour *work, const swarf_facets *facets, const crease_cuts *cuts, cube_set *out)
{
    enum { AROUND = 27 };
    out->slot_count = 64;
    while (out->slot_count < 2 * AROUND * cuts->count) out->slot_count *= 2;
    out->slots = calloc(out->slot_count, sizeof *out->slots);
    if (!out->slots) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    uint64_t last = 0;
    for (size_t i = 0; i < cuts->count; i++) {
        double middle[3];
        middle_of(facets, &facets->facet[cuts->cut[i].facet], middle);
        const uint64_t own = swarf_crease_cube(work, middle, 0, 0, 0);
        if (own == last) continue;
        last = own;
        for (int n = 0; n < AROUND; n++) {
            const uint64_t cube = swarf_crease_cube(work, middle, n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
            out->slots[find(out, cube)] = cube;
        }
    }
    return SWARF_OK;
}

typedef struct nearness {
    const contour *work;
    const swarf_facets *facets;
    const cube_set *cubes;
    uint8_t *near;
} nearness;

static swarf_status look_some(void *context, size_t index)
{
    const nearness *l = context;
    for (size_t f = index * PIECE; f < (index + 1) * PIECE && f < l->facets->facet_count; f++) {
        double middle[3];
        middle_of(l->facets, &l->facets->facet[f], middle);
        l->near[f] = l->cubes->slots[find(l->cubes, swarf_crease_cube(l->work, middle, 0, 0, 0))] != 0;
    }
    return SWARF_OK;
}

/* The facets near those that are cut, those themselves left out. */
swarf_status swarf_crease_near(const contour *work, const swarf_facets *facets, const crease_cuts *cuts, uint32_t **out,
                               size_t *count)
{
    cube_set cubes = {0};
    nearness l = {work, facets, &cubes, malloc(facets->facet_count + 1)};
    swarf_status status =
        l.near ? find_cubes(work, facets, cuts, &cubes) : swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    if (status == SWARF_OK)
        status = swarf_parallel_for((facets->facet_count + PIECE - 1) / PIECE, look_some, &l, NULL, 0, 1);
    size_t all = 0;
    for (size_t i = 0; status == SWARF_OK && i < cuts->count; i++) l.near[cuts->cut[i].facet] = 0;
    for (size_t f = 0; status == SWARF_OK && f < facets->facet_count; f++) all += l.near[f];
    uint32_t *list = status == SWARF_OK ? malloc((all + 1) * sizeof *list) : NULL;
    if (status == SWARF_OK && !list) status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    all = 0;
    for (size_t f = 0; status == SWARF_OK && f < facets->facet_count; f++)
        if (l.near[f]) list[all++] = (uint32_t)f;
    free(l.near);
    free(cubes.slots);
    SWARF_TRY(status);
    *out = list;
    *count = all;
    return SWARF_OK;
}

/* Facets near parts, then the parts, or the facets themselves where there are none: the cut that each is of. */
typedef struct gathered {
    swarf_facets facets;
    uint8_t *fresh;
    uint32_t *cut_of;
} gathered;

static swarf_status gather(const swarf_facets *facets, const crease_cuts *cuts, const uint32_t *near, size_t near_count,
                           gathered *out)
{
    const size_t room = near_count + 4 * cuts->count + 1;
    swarf_facet *list = malloc(room * sizeof *list);
    out->fresh = calloc(room, 1);
    out->cut_of = malloc(room * sizeof *out->cut_of);
    out->facets =
        (swarf_facets){.xyz = facets->xyz, .vertex_count = facets->vertex_count + cuts->pair_count, .facet = list};
    if (!list || !out->fresh || !out->cut_of) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    size_t count = 0;
    for (size_t i = 0; i < near_count; i++) {
        list[count] = facets->facet[near[i]];
        out->cut_of[count++] = UINT32_MAX;
    }
    for (size_t i = 0; i < cuts->count; i++) {
        const crease_cut *cut = &cuts->cut[i];
        for (int n = 0; n < cut->parts || n == 0; n++) {
            list[count] = cut->parts ? cut->part[n] : facets->facet[cut->facet];
            out->fresh[count] = (uint8_t)cut->fresh;
            out->cut_of[count++] = (uint32_t)i;
        }
    }
    out->facets.facet_count = count;
    return SWARF_OK;
}

swarf_status swarf_crease_find_crossed(const swarf_facets *facets, const crease_cuts *cuts, const uint32_t *near,
                                       size_t near_count, const swarf_progress *progress, double from, uint8_t *crossed)
{
    gathered g = {0};
    swarf_facet_pair *pairs = NULL;
    size_t count = 0;
    swarf_status status = gather(facets, cuts, near, near_count, &g);
    if (status == SWARF_OK) status = swarf_facets_intersect(&g.facets, g.fresh, progress, from, 1, &pairs, &count);
    for (size_t i = 0; status == SWARF_OK && i < count; i++) {
        const uint32_t both[2] = {g.cut_of[pairs[i].a], g.cut_of[pairs[i].b]};
        for (int k = 0; k < 2; k++)
            if (both[k] != UINT32_MAX) crossed[both[k]] = 1;
    }
    free(pairs);
    free(g.facets.facet);
    free(g.fresh);
    free(g.cut_of);
    return status;
}
