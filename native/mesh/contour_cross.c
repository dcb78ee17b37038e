/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* First pass of contouring: the blocks, their values, and where the surface crosses their edges. */
#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/contour.h"
#include "mesh/contour_sharp.h"
#include "stock/gradient.h"
#include "stock/leaf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Parts of a voxel. A crossing is searched for to a thousandth of what the mesh promises; a voxel this near to the
 * exact surface may have either sign in the field. */
static const double crossing_tolerance = 1e-5, noise = 1e-3;
/* Where second differences of the field (in voxels) are less than this at both ends of an edge, the surface is flat:
 * linear crossings are right to an eighth of it, central differences to half of it (as an angle). */
static const float plane_bend = 1e-3f;
/* An edge that meets the surface at a flatter angle than this (as a sine) is left to the bracketed search. */
static const double least_slope = 0.1;

/* Block coordinates -> place in block_at; -1 outside the layout. */
static ptrdiff_t place_of(const swarf_tree_layout *layout, const int32_t ijk[3])
{
    for (int k = 0; k < 3; k++)
        if (ijk[k] < 0 || ijk[k] >= layout->count[k] * SWARF_NODE_DIM) return -1;
    const size_t node =
        ((size_t)(ijk[0] >> 7) * (size_t)layout->count[1] + (size_t)(ijk[1] >> 7)) * (size_t)layout->count[2] +
        (size_t)(ijk[2] >> 7);
    const int slot = (ijk[0] >> 3 & 15) << 8 | (ijk[1] >> 3 & 15) << 4 | (ijk[2] >> 3 & 15);
    return (ptrdiff_t)(node * SWARF_NODE_SLOTS + (size_t)slot);
}

contour_block *swarf_contour_block_at(const contour *work, const int32_t ijk[3])
{
    const ptrdiff_t place = place_of(work->layout, ijk);
    return place < 0 || work->block_at[place] == UINT32_MAX ? NULL : &work->blocks[work->block_at[place]];
}

static int is_wanted(const contour_band *band, int32_t x)
{
    return !band || (x >= band->first - SWARF_LEAF_DIM && x < band->end + 3 * SWARF_LEAF_DIM);
}

/* The blocks of a node: their memory is touched here for the first time, which takes longest. */
static swarf_status begin_blocks(void *context, size_t node)
{
    contour *work = context;
    int32_t origin[3];
    swarf_node_corner(work->layout, node, origin);
    for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++) {
        const uint32_t block = work->block_at[node * SWARF_NODE_SLOTS + slot];
        if (block != UINT32_MAX) swarf_leaf_corner(origin, slot, work->blocks[block].ijk);
    }
    return SWARF_OK;
}

/* A cell of the surface has a corner in a leaf, so its low corner lies in that leaf or in one of the seven below. */
swarf_status swarf_contour_blocks(contour *work)
{
    const swarf_tree_layout *layout = work->layout;
    const size_t nodes = swarf_layout_nodes(layout), places = nodes * SWARF_NODE_SLOTS;
    swarf_leaf *leaves;
    size_t leaf_count;
    SWARF_TRY(swarf_stock_leaves(work->stock, &leaves, &leaf_count));
    work->block_at = malloc((places ? places : 1) * sizeof *work->block_at);
    if (!work->block_at) {
        free(leaves);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu nodes", nodes);
    }
    memset(work->block_at, 0xff, places * sizeof *work->block_at);
    for (size_t i = 0; i < leaf_count; i++)
        for (int c = 0; c < 8; c++) {
            const int32_t ijk[3] = {leaves[i].ijk[0] - (c >> 2 & 1) * SWARF_LEAF_DIM,
                                    leaves[i].ijk[1] - (c >> 1 & 1) * SWARF_LEAF_DIM,
                                    leaves[i].ijk[2] - (c & 1) * SWARF_LEAF_DIM};
            const ptrdiff_t place = place_of(layout, ijk);
            if (place >= 0 && is_wanted(work->band, ijk[0])) work->block_at[place] = 0;
        }
    free(leaves);
    for (size_t place = 0; place < places; place++)
        if (work->block_at[place] == 0) work->block_at[place] = (uint32_t)work->block_count++;
    work->blocks = calloc(work->block_count ? work->block_count : 1, sizeof *work->blocks);
    if (!work->blocks) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu blocks", work->block_count);
    return swarf_parallel_for(nodes, begin_blocks, work, NULL, 0, 1);
}

/* The values of the leaf at a corner; NULL where there is none, all of it is then *tile. */
static const float *find_leaf(const contour *work, const int32_t corner[3], float *tile)
{
    const ptrdiff_t place = place_of(work->layout, corner);
    *tile = work->layout->background;
    if (place < 0) return NULL;
    const size_t node = (size_t)place / SWARF_NODE_SLOTS;
    const unsigned slot = (unsigned)((size_t)place % SWARF_NODE_SLOTS);
    const float *leaf = swarf_tree_leaf(work->stock->tree, node, slot);
    if (!leaf && swarf_tree_tile_inside(work->stock->tree, node, slot)) *tile = -*tile;
    return leaf;
}

/* With so many voxels below the block along each axis and above it. */
static inline void fetch(const contour *work, const int32_t ijk[3], int below, int above, float *values)
{
    const int first[3] = {SWARF_LEAF_DIM - below, 0, 0}, count[3] = {below, SWARF_LEAF_DIM, above},
              start[3] = {0, below, below + SWARF_LEAF_DIM}, edge = below + SWARF_LEAF_DIM + above;
    for (int c = 0; c < 9; c++) {
        const int part[2] = {c / 3, c % 3};
        const float *leaf[3];
        float tile[3];
        for (int k = 0; k < 3; k++) {
            const int32_t corner[3] = {ijk[0] + (part[0] - 1) * SWARF_LEAF_DIM, ijk[1] + (part[1] - 1) * SWARF_LEAF_DIM,
                                       ijk[2] + (k - 1) * SWARF_LEAF_DIM};
            leaf[k] = find_leaf(work, corner, &tile[k]);
        }
        for (int x = 0; x < count[part[0]]; x++)
            for (int y = 0; y < count[part[1]]; y++) {
                float *to = values + ((start[part[0]] + x) * edge + start[part[1]] + y) * edge;
                const int from = (first[part[0]] + x) * 64 + (first[part[1]] + y) * 8;
                for (int z = 0; z < below; z++) to[z] = leaf[0] ? leaf[0][from + first[0] + z] : tile[0];
                if (leaf[1])
                    memcpy(to + below, leaf[1] + from, SWARF_LEAF_DIM * sizeof *to);
                else
                    for (int z = 0; z < SWARF_LEAF_DIM; z++) to[below + z] = tile[1];
                for (int z = 0; z < above; z++) to[start[2] + z] = leaf[2] ? leaf[2][from + z] : tile[2];
            }
    }
}

void swarf_contour_fetch(const contour *work, const int32_t ijk[3], float values[SWARF_HALO * SWARF_HALO * SWARF_HALO])
{
    fetch(work, ijk, 1, 2, values);
}

void swarf_contour_fetch_wide(const contour *work, const int32_t ijk[3], float *values)
{
    fetch(work, ijk, SWARF_WIDE_BELOW, SWARF_WIDE_HALO - SWARF_WIDE_BELOW - SWARF_LEAF_DIM, values);
}

static const int stride[3] = {SWARF_HALO * SWARF_HALO, SWARF_HALO, 1};

/* From the field: linear along the edge; the gradient by differences along it and central ones across. */
static void cross_field(const float *at, int axis, contour_crossing *out)
{
    const double low = at[0], high = at[stride[axis]], t = low / (low - high);
    double normal[3], square = 0;
    for (int k = 0; k < 3; k++) {
        const float *next = at + stride[axis];
        normal[k] = k == axis ? 2 * (high - low)
                              : (1 - t) * ((double)at[stride[k]] - at[-stride[k]]) +
                                    t * ((double)next[stride[k]] - next[-stride[k]]);
        square += normal[k] * normal[k];
    }
    const double length = sqrt(square); /* the part along the edge is not 0: the signs differ */
    for (int k = 0; k < 3; k++) out->normal[k] = (float)(normal[k] / length);
    out->t = (float)t;
    out->move = SWARF_BY_FIELD;
    out->piece = 0;
}

/* Whether all second differences at both ends of an edge are less. */
static int bends_less(const float *at, int axis, float most)
{
    const float *next = at + stride[axis];
    for (int k = 0; k < 3; k++)
        if (!(fabsf(at[stride[k]] - 2 * at[0] + at[-stride[k]]) < most &&
              fabsf(next[stride[k]] - 2 * next[0] + next[-stride[k]]) < most))
            return 0;
    return 1;
}

/* The same where the field bends: the parabola through both ends that bends as the less bent of them does, which an
 * edge nearby changes the less. */
static void cross_bent(const float *at, int axis, contour_crossing *crossing)
{
    const int step = stride[axis];
    const double low = at[0], slope = at[step] - low;
    const double first = at[step] - 2 * low + at[-step], last = at[2 * step] - 2.0 * at[step] + low;
    if (first * last <= 0) return;
    const double half = 0.5 * (fabs(first) < fabs(last) ? first : last);
    const double middle = slope - half; /* low + middle t + half t^2 */
    const double root = copysign(sqrt(fmax(middle * middle - 4 * half * low, 0)), slope); /* the slope where it is 0 */
    const double t = middle * root > 0 ? -2 * low / (middle + root) : 0.5 * (root - middle) / half;
    if (t >= 0 && t <= 1) crossing->t = (float)t;
}

/* What makes the surface at a voxel, as seen from a little further along the edge. Where faces that go through the
 * middle of voxels, as round numbers make them do, meet in a line of voxels, these alone see no face but the line. */
static void look_beside(const swarf_surface_near *near, const double a[3], double voxel, int axis, double t,
                        swarf_surface_point *found)
{
    double point[3] = {a[0], a[1], a[2]};
    swarf_surface_point beside;
    point[axis] += (t < 0.5 ? noise : 1 - noise) * voxel;
    swarf_surface_evaluate(near, point, &beside);
    if (fabs(beside.value) <= 2 * noise * voxel) *found = beside;
}

/* From the exact surface: Newton's steps from where the field has it, which on flat faces is at once; the bracketed
 * search where these do not end. A voxel as good as on the surface may have the other sign in the field's floats: then
 * the surface is at that voxel. Where there is no such surface the field's crossing stays. */
void swarf_contour_cross_exact(const swarf_surface_near *near, const double a[3], double voxel, int axis, int outwards,
                               contour_crossing *crossing)
{
    swarf_surface_point found;
    double t = (double)crossing->t, point[3] = {a[0], a[1], a[2]};
    int good = 0;
    for (int step = 0; step < 4 && !good; step++) {
        point[axis] = a[axis] + t * voxel;
        swarf_surface_evaluate(near, point, &found);
        const double slope = outwards ? found.normal[axis] : -found.normal[axis];
        good = slope > 0 && fabs(found.value) <= crossing_tolerance * voxel;
        if (slope < least_slope) break;
        t = fmin(fmax(t - found.value / (voxel * found.normal[axis]), 0), 1); /* no look at where it leads */
    }
    if (!good) {
        const double b[3] = {a[0] + (axis == 0) * voxel, a[1] + (axis == 1) * voxel, a[2] + (axis == 2) * voxel};
        good = swarf_surface_crossing(near, a, b, crossing_tolerance * voxel, &t, &found);
    }
    if (!good) {
        t = crossing->t < 0.5f ? 0 : 1;
        point[axis] = a[axis] + t * voxel;
        swarf_surface_evaluate(near, point, &found);
        if (fabs(found.value) > noise * voxel) return;
    }
    if (t < noise || t > 1 - noise) look_beside(near, a, voxel, axis, t, &found);
    t = fmin(fmax(t, SWARF_CONTOUR_MARGIN), 1 - SWARF_CONTOUR_MARGIN);
    *crossing = (contour_crossing){.t = (float)t, .move = (int32_t)found.move, .piece = found.piece};
    for (int k = 0; k < 3; k++) crossing->normal[k] = (float)found.normal[k];
}

/* All crossings of a block, in the order of its masks. */
static swarf_status cross_edges(const contour *work, contour_block *block, const float *values, contour_near *near)
{
    const swarf_tree_layout *layout = work->layout;
    const float voxel = (float)layout->voxel;
    contour_sharp sharp; /* set when it is needed */
    int begun = 0;
    contour_crossing *next = block->crossings;
    for (int axis = 0; axis < 3; axis++)
        for (int x = 0; x < 8; x++)
            for (uint64_t word = block->edge_mask[axis][x]; word; word &= word - 1, next++) {
                const int bit = __builtin_ctzll(word), at[3] = {x, bit >> 3, bit & 7};
                const float *value = values + ((x + 1) * SWARF_HALO + at[1] + 1) * SWARF_HALO + at[2] + 1;
                cross_field(value, axis, next);
                if (bends_less(value, axis, plane_bend * voxel)) {
                    next->t = fminf(fmaxf(next->t, (float)SWARF_CONTOUR_MARGIN), 1 - (float)SWARF_CONTOUR_MARGIN);
                    next->move = SWARF_BY_FLAT_FIELD;
                    continue;
                }
                if (bends_less(value, axis, swarf_face_bend * voxel)) cross_bent(value, axis, next);
                if (!work->surface) {
                    if (bends_less(value, axis, swarf_edge_bend * voxel)) {
                        next->move = SWARF_BY_FACES;
                        continue;
                    }
                    if (!begun) swarf_contour_sharp_begin(&sharp, work, block);
                    begun = 1;
                    swarf_contour_cross_sharp(&sharp, at, axis, next);
                    continue;
                }
                const swarf_surface_near *surface;
                SWARF_TRY(swarf_contour_near_get(near, at, &surface));
                double a[3];
                for (int k = 0; k < 3; k++) a[k] = layout->origin[k] + (block->ijk[k] + at[k]) * layout->voxel;
                swarf_contour_cross_exact(surface, a, layout->voxel, axis, *value < 0, next);
            }
    return SWARF_OK;
}

/* Rows of a block and those about it. */
enum { ROWS = 10 };

/* Signs of the voxels of a block and those about them, [x][y], bit z set: material. */
static void find_signs(const float values[SWARF_HALO * SWARF_HALO * SWARF_HALO], unsigned inside[ROWS][ROWS])
{
    for (int x = 0; x < ROWS; x++)
        for (int y = 0; y < ROWS; y++) {
            const float *row = values + (x * SWARF_HALO + y) * SWARF_HALO;
            inside[x][y] = swarf_row_below(row, 0) | (unsigned)(row[8] < 0) << 8 | (unsigned)(row[9] < 0) << 9;
        }
}

/* Material in voxels of the block whose centres are outside, as all about them are: as much of each as in a voxel
 * beside a face at that distance. In voxels. */
static float find_unseen(const float values[SWARF_HALO * SWARF_HALO * SWARF_HALO], unsigned inside[ROWS][ROWS],
                         double voxel)
{
    unsigned about[ROWS][8]; /* with those beside them along y and z */
    for (int x = 0; x < ROWS; x++)
        for (int y = 0; y < 8; y++) {
            const unsigned rows = inside[x][y] | inside[x][y + 1] | inside[x][y + 2];
            about[x][y] = rows | rows << 1 | rows >> 1;
        }
    const float reach = (float)(0.5 * voxel), scale = (float)(1 / voxel);
    float sum = 0;
    for (int x = 0; x < 8; x++)
        for (int y = 0; y < 8; y++) {
            const float *row = values + ((x + 1) * SWARF_HALO + y + 1) * SWARF_HALO + 1;
            const unsigned seen = (about[x][y] | about[x + 1][y] | about[x + 2][y]) >> 1 & 0xff;
            for (int z = 0; z < 8 && seen != 0xff; z++)
                if (row[z] < reach && !(seen >> z & 1)) sum += 0.5f - row[z] * scale;
        }
    return sum;
}

swarf_status swarf_contour_cross(contour *work, contour_block *block)
{
    float values[SWARF_HALO * SWARF_HALO * SWARF_HALO];
    swarf_contour_fetch(work, block->ijk, values);
    unsigned signs[ROWS][ROWS];
    find_signs(values, signs);
    block->unseen = find_unseen(values, signs, work->layout->voxel);
    uint16_t(*inside)[9] = block->inside;
    for (int x = 0; x < 9; x++)
        for (int y = 0; y < 9; y++) inside[x][y] = (uint16_t)(signs[x + 1][y + 1] >> 1);
    uint32_t count = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int x = 0; x < 8; x++) {
            uint64_t word = 0;
            for (int y = 0; y < 8; y++) {
                const unsigned own = inside[x][y];
                const unsigned next = axis == 0 ? inside[x + 1][y] : axis == 1 ? inside[x][y + 1] : own >> 1;
                word |= (uint64_t)((own ^ next) & 0xff) << (y * 8);
            }
            block->edge_mask[axis][x] = word;
            block->edge_rank[axis][x] = (uint16_t)count;
            count += (uint32_t)__builtin_popcountll(word);
        }
    block->crossing_count = count;
    if (count == 0) return SWARF_OK;
    block->crossings = malloc(count * sizeof *block->crossings);
    if (!block->crossings) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for crossings");
    contour_near near = {.work = work, .block = block};
    const swarf_status status = cross_edges(work, block, values, &near);
    swarf_contour_near_free(&near);
    return status;
}

void swarf_contour_block_free(contour_block *block)
{
    free(block->crossings);
    free(block->cells);
    free(block->vertices);
    free(block->tile);
    free(block->left);
    free(block->centres);
    free(block->facets);
}

void swarf_contour_clear(contour *work)
{
    for (size_t i = 0; work->blocks && i < work->block_count; i++) swarf_contour_block_free(&work->blocks[i]);
    free(work->blocks);
    free(work->block_at);
    work->blocks = NULL;
    work->block_at = NULL;
    work->block_count = 0;
}

void swarf_contour_free(contour *work)
{
    swarf_contour_clear(work);
    memset(work, 0, sizeof *work);
}
