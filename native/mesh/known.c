/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A hash table with open addressing over the places of facets' corners. Facets are known by these places alone, not by
 * the numbers of their vertices: two that shared a vertex, and have now two vertices at that place, are still taken for
 * facets that do not cut each other. One that comes back with its corners in another order is another one, which only
 * costs time. */
#include "mesh/known.h"

#include "base/parallel.h"
#include "base/status.h"

#include <stdlib.h>
#include <string.h>

enum { CHUNK = 16384 };

void swarf_facets_known_free(swarf_facets_known *known)
{
    free(known->corners);
    free(known->slots);
    memset(known, 0, sizeof *known);
}

static void corners_of(const swarf_facets *facets, size_t f, float out[9])
{
    for (int k = 0; k < 3; k++)
        memcpy(out + 3 * (size_t)k, facets->xyz + 3 * (size_t)facets->facet[f].v[k], 3 * sizeof *out);
}

/* Where corners are, or the empty slot where they would be. */
static size_t find(const swarf_facets_known *known, const float corners[9])
{
    uint32_t bits[9];
    uint64_t hash = 0;
    memcpy(bits, corners, sizeof bits);
    for (int k = 0; k < 9; k++) hash = (hash ^ bits[k]) * UINT64_C(0x9e3779b97f4a7c15) ^ hash >> 29;
    size_t at = (size_t)(hash >> 20) & (known->slot_count - 1);
    while (known->slots[at] && memcmp(known->corners[known->slots[at] - 1], corners, sizeof bits) != 0)
        at = (at + 1) & (known->slot_count - 1);
    return at;
}

swarf_status swarf_facets_known_take(swarf_facets_known *known, const swarf_facets *facets,
                                     const swarf_facet_pair *pairs, size_t pair_count)
{
    const size_t count = facets->facet_count;
    swarf_facets_known_free(known);
    size_t slots = 16;
    while (slots < 2 * count) slots *= 2;
    known->corners = malloc((count + 1) * sizeof *known->corners);
    known->slots = calloc(slots, sizeof *known->slots);
    uint8_t *cut = calloc(count + 1, 1);
    if (!known->corners || !known->slots || !cut) {
        free(cut);
        swarf_facets_known_free(known);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for checking %zu triangles", count);
    }
    known->slot_count = slots;
    for (size_t i = 0; i < pair_count; i++) cut[pairs[i].a] = cut[pairs[i].b] = 1;
    for (size_t f = 0; f < count; f++) {
        if (cut[f]) continue;
        corners_of(facets, f, known->corners[known->count]);
        known->slots[find(known, known->corners[known->count])] = (uint32_t)(known->count + 1);
        known->count++;
    }
    free(cut);
    return SWARF_OK;
}

typedef struct telling {
    const swarf_facets_known *known;
    const swarf_facets *facets;
    uint8_t *fresh;
} telling;

static swarf_status tell_chunk(void *context, size_t index)
{
    const telling *t = context;
    for (size_t f = index * CHUNK; f < (index + 1) * CHUNK && f < t->facets->facet_count; f++) {
        float corners[9];
        corners_of(t->facets, f, corners);
        t->fresh[f] = !t->known->slots[find(t->known, corners)];
    }
    return SWARF_OK;
}

swarf_status swarf_facets_known_tell(const swarf_facets_known *known, const swarf_facets *facets, uint8_t *fresh)
{
    telling t = {known, facets, fresh};
    if (!known->count) {
        memset(fresh, 1, facets->facet_count);
        return SWARF_OK;
    }
    return swarf_parallel_for((facets->facet_count + CHUNK - 1) / CHUNK, tell_chunk, &t, NULL, 0, 1);
}
