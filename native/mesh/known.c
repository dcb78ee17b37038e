/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A hash table with open addressing over the places of facets' corners. Facets are known by these places alone, not by
 * the numbers of their vertices: two that shared a vertex, and have now two vertices at that place, are still taken for
 * facets that do not cut each other. One that comes back with its corners in another order is another one, which only
 * costs time. */
#include "mesh/known.h"

#include "base/mix.h"
#include "base/parallel.h"
#include "base/status.h"

#include <stdlib.h>
#include <string.h>

/* Facets one thread takes at a time; how far ahead slots are fetched, which lie all over memory. */
enum { CHUNK = 16384, AHEAD = 16 };

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

/* The first slot to look at for corners. */
static size_t first_slot(const swarf_facets_known *known, const float corners[9])
{
    uint32_t bits[9];
    uint64_t hash = 0;
    memcpy(bits, corners, sizeof bits);
    for (int k = 0; k < 9; k++) hash = swarf_mix_in(hash, bits[k]);
    return (size_t)(hash >> 20) & (known->slot_count - 1);
}

/* Where corners are, or the empty slot where they would be. */
static size_t find(const swarf_facets_known *known, const float corners[9], size_t at)
{
    while (known->slots[at] && memcmp(known->corners[known->slots[at] - 1], corners, 9 * sizeof *corners) != 0)
        at = (at + 1) & (known->slot_count - 1);
    return at;
}

typedef struct taking {
    const swarf_facets_known *known;
    const swarf_facets *facets;
    size_t *first; /* slot of each facet */
} taking;

static swarf_status take_chunk(void *context, size_t index)
{
    const taking *t = context;
    for (size_t f = index * CHUNK; f < (index + 1) * CHUNK && f < t->facets->facet_count; f++) {
        corners_of(t->facets, f, t->known->corners[f]);
        t->first[f] = first_slot(t->known, t->known->corners[f]);
    }
    return SWARF_OK;
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
    size_t *first = malloc((count + AHEAD) * sizeof *first);
    if (!known->corners || !known->slots || !cut || !first) {
        free(cut);
        free(first);
        swarf_facets_known_free(known);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for checking %zu triangles", count);
    }
    known->slot_count = slots;
    for (size_t i = 0; i < pair_count; i++) cut[pairs[i].a] = cut[pairs[i].b] = 1;
    taking t = {known, facets, first};
    const swarf_status status = swarf_parallel_for((count + CHUNK - 1) / CHUNK, take_chunk, &t, NULL, 0, 1);
    memset(first + count, 0, AHEAD * sizeof *first);
    for (size_t f = 0; f < count && status == SWARF_OK; f++) {
        __builtin_prefetch(&known->slots[first[f + AHEAD]], 1);
        if (cut[f]) continue;
        known->slots[find(known, known->corners[f], first[f])] = (uint32_t)(f + 1);
        known->count++;
    }
    free(cut);
    free(first);
    if (status != SWARF_OK) swarf_facets_known_free(known);
    return status;
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
        t->fresh[f] = !t->known->slots[find(t->known, corners, first_slot(t->known, corners))];
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
