/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What is done about facets that cut each other: the cells about them are noted, and made again with more care, in
 * steps: all their vertices stay, lie in their own cells, are where the surface is smooth, are in the middle of their
 * crossings. */
#include "mesh/contour.h"
#include "mesh/intersect.h"

#include <math.h>

void swarf_contour_note(contour *work, const swarf_facets *facets, const swarf_facet_pair *pair)
{
    int32_t lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        double least[2], most[2];
        const uint32_t facet[2] = {pair->a, pair->b};
        for (int i = 0; i < 2; i++) {
            const uint32_t *v = facets->facet[facet[i]].v;
            const double p[3] = {facets->xyz[3 * (size_t)v[0] + (size_t)k], facets->xyz[3 * (size_t)v[1] + (size_t)k],
                                 facets->xyz[3 * (size_t)v[2] + (size_t)k]};
            least[i] = fmin(p[0], fmin(p[1], p[2]));
            most[i] = fmax(p[0], fmax(p[1], p[2]));
        }
        const double voxel = work->layout->voxel, origin = work->layout->origin[k];
        lo[k] = (int32_t)floor((fmax(least[0], least[1]) - origin) / voxel) - 2;
        hi[k] = (int32_t)floor((fmin(most[0], most[1]) - origin) / voxel) + 2;
    }
    for (int32_t x = lo[0] & ~7; x <= hi[0]; x += 8)
        for (int32_t y = lo[1] & ~7; y <= hi[1]; y += 8)
            for (int32_t z = lo[2] & ~7; z <= hi[2]; z += 8) {
                const int32_t corner[3] = {x, y, z};
                contour_block *block = swarf_contour_block_at(work, corner);
                if (!block) continue;
                for (int i = 0; i < 8; i++) {
                    if (x + i < lo[0] || x + i > hi[0]) continue;
                    uint64_t word = block->cell_mask[i];
                    for (int bit = 0; bit < 64; bit++)
                        if (y + bit / 8 < lo[1] || y + bit / 8 > hi[1] || z + bit % 8 < lo[2] || z + bit % 8 > hi[2])
                            word &= ~(UINT64_C(1) << bit);
                    block->noted_mask[i] |= word;
                    block->noted |= word != 0;
                }
            }
}

/* Facets of blocks beside those whose vertices or tiles are others may be others too. Tiles look two cells about them,
 * so that those of the next block may be others, and with them the facets of the one after. */
static void touch_about(contour *work, const contour_block *block)
{
    for (int c = 0; c < 125; c++) {
        const int part[3] = {c / 25 - 2, c / 5 % 5 - 2, c % 5 - 2};
        int32_t corner[3];
        for (int k = 0; k < 3; k++) corner[k] = block->ijk[k] + part[k] * SWARF_LEAF_DIM;
        contour_block *near = swarf_contour_block_at(work, corner);
        if (near) near->touched = near->amiss = 1;
    }
}

/* Whether a vertex of a cell noted, whose vertices are kept already, lies beside it. */
static int any_beside(const contour *work, int all_kept)
{
    uint64_t beside = 0;
    for (size_t b = 0; b < work->block_count; b++) {
        const contour_block *block = &work->blocks[b];
        for (int x = 0; x < 8 && block->noted && !block->finished; x++)
            beside |= block->noted_mask[x] & block->beside_mask[x] & (all_kept ? UINT64_MAX : block->keep_mask[x]);
    }
    return beside != 0;
}

void swarf_contour_take_care(contour *work, int all_kept)
{
    const int beside = any_beside(work, all_kept);
    for (size_t b = 0; b < work->block_count; b++) {
        contour_block *block = &work->blocks[b];
        block->changed = 0;
        if (!block->noted || block->finished) continue;
        for (int x = 0; x < 8; x++) {
            const uint64_t noted = block->noted_mask[x], kept = all_kept ? noted : block->keep_mask[x];
            block->changed |= (noted & kept) != 0;
            block->own_mask[x] |= noted & kept;
            if (!beside) {
                block->middle_mask[x] |= noted & block->calm_mask[x];
                block->calm_mask[x] |= noted & kept;
            }
            block->keep_mask[x] |= noted;
            block->noted_mask[x] = 0;
        }
        block->noted = 0;
        touch_about(work, block);
    }
}
