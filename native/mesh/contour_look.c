/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A close look at where care was taken: only the blocks that were touched, with all vertices there. It costs little
 * beside an attempt of the whole. */
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/contour.h"
#include "mesh/intersect.h"

#include <math.h>
#include <stdlib.h>

/* Whether facets of a block are in or above cells that care was taken of. */
static int is_about_care(const contour *work, const contour_block *block)
{
    uint64_t kept = 0;
    for (int below = 0; below < 8; below++) {
        const contour_block *near = swarf_contour_block_below(work, block, below);
        for (int x = 0; near && x < 8; x++) kept |= near->keep_mask[x];
    }
    return kept != 0;
}

enum { CHOSEN = 1, JOINED = 2 };

/* The touched blocks, of which facets are looked at where care was taken, and those that these facets name. */
static swarf_status choose(const contour *work, contour_choice *out)
{
    uint8_t *how = calloc(work->block_count + 1, 1);
    out->block = malloc((work->block_count + 1) * sizeof *out->block);
    if (!how || !out->block) {
        free(how);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    }
    for (size_t b = 0; b < work->block_count; b++) {
        const contour_block *block = &work->blocks[b];
        if (!block->touched) continue;
        how[b] |= CHOSEN;
        if (!swarf_contour_is_within(work, block, 1) || !is_about_care(work, block)) continue;
        how[b] |= JOINED;
        out->block[out->joined++] = (uint32_t)b;
        for (int below = 1; below < 8; below++) {
            const contour_block *near = swarf_contour_block_below(work, block, below);
            if (near) how[near - work->blocks] |= CHOSEN;
        }
    }
    out->count = out->joined;
    for (size_t b = 0; b < work->block_count; b++)
        if (how[b] == CHOSEN) out->block[out->count++] = (uint32_t)b;
    free(how);
    return SWARF_OK;
}

typedef struct looking {
    contour *work;
    contour_choice choice;
    swarf_facets facets;
    uint8_t *marks;
} looking;

static swarf_status untile_one(void *context, size_t index)
{
    const looking *l = context;
    contour_block *block = &l->work->blocks[l->choice.block[index]];
    if (block->touched && swarf_contour_is_within(l->work, block, 1)) swarf_contour_untile(block);
    return SWARF_OK;
}

static swarf_status join_one(void *context, size_t index)
{
    const looking *l = context;
    return swarf_contour_join(l->work, &l->work->blocks[l->choice.block[index]]);
}

/* Round as the whole would be. */
static void snap(looking *l)
{
    const contour *work = l->work;
    float most = swarf_facets_most(l->facets.xyz, l->facets.vertex_count);
    for (size_t b = 0; b < work->block_count; b++) most = fmaxf(most, work->blocks[b].most);
    swarf_facets_snap(&l->facets, fmax(swarf_facets_step((double)most), work->band ? work->band->step : 0));
}

/* Leave out the facets of which no vertex is kept. */
static void drop_others(looking *l)
{
    swarf_facets *facets = &l->facets;
    size_t kept = 0;
    for (size_t f = 0; f < facets->facet_count; f++) {
        const uint32_t *v = facets->facet[f].v;
        if ((l->marks[v[0]] | l->marks[v[1]] | l->marks[v[2]]) & SWARF_VERTEX_LOCKED)
            facets->facet[kept++] = facets->facet[f];
    }
    facets->facet_count = kept;
}

static swarf_status find_pairs(looking *l, size_t *count)
{
    swarf_facet_pair *pairs;
    size_t all;
    SWARF_TRY(swarf_facets_intersect(&l->facets, NULL, NULL, 0, 1, &pairs, &all));
    *count = 0;
    for (size_t i = 0; i < all; i++) {
        if (l->facets.facet[pairs[i].a].beyond && l->facets.facet[pairs[i].b].beyond) continue;
        swarf_contour_note(l->work, &l->facets, &pairs[i]);
        ++*count;
    }
    free(pairs);
    return SWARF_OK;
}

static swarf_status look(looking *l, size_t *count)
{
    SWARF_TRY(choose(l->work, &l->choice));
    SWARF_TRY(swarf_parallel_for(l->choice.count, untile_one, l, NULL, 0, 1));
    SWARF_TRY(swarf_parallel_for(l->choice.joined, join_one, l, NULL, 0, 1));
    SWARF_TRY(swarf_contour_gather(l->work, &l->choice, &l->facets, &l->marks));
    snap(l);
    drop_others(l);
    return find_pairs(l, count);
}

swarf_status swarf_contour_look(contour *work, size_t *count)
{
    looking l = {.work = work};
    const swarf_status status = look(&l, count);
    swarf_facets_free(&l.facets);
    free(l.choice.block);
    free(l.marks);
    return status;
}
