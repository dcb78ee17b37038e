/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Between the second and the third pass of contouring: tiles, the largest first.
 *
 * The cells of a tile may become one where that leaves the surface as it hangs together: the sign in the middle of each
 * of the tile's edges, faces and of itself is that of one of their corners, for the tile and for all smaller cubes in
 * it (Ju, Losasso, Schaefer, Warren 2002), and its corners have one cycle. */
#include "mesh/contour.h"

#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct tiling {
    const contour *work;
    contour_block *block;
    double flat; /* mm */
} tiling;

/* Cells of a block with all coordinates in lo .. hi - 1, one of the eight words. */
static uint64_t cells_within(int y_lo, int y_hi, int z_lo, int z_hi)
{
    const uint64_t row = ((UINT64_C(1) << z_hi) - 1) & ~((UINT64_C(1) << z_lo) - 1);
    uint64_t word = 0;
    for (int y = y_lo; y < y_hi; y++) word |= row << (8 * y);
    return word;
}

static int is_empty(const contour_block *block, const int at[3], int edge)
{
    const uint64_t within = cells_within(at[1], at[1] + edge, at[2], at[2] + edge);
    for (int x = at[0]; x < at[0] + edge; x++)
        if (block->cell_mask[x] & within) return 0;
    return 1;
}

/* Nine places of a cube along each pair of axes, 27 bits in all: bit x * 9 + y * 3 + z, each coordinate low, middle or
 * high. */
enum { ALL_PLACES = 0x7ffffff, CORNER_PLACES = 0x5140145, LOW_X = 0x1ff, LOW_Y = 0x1c0e07, LOW_Z = 0x1249249 };

/* Places in whose edge, face or cube one of these corners is. */
static uint32_t reach_of(uint32_t corners)
{
    uint32_t places = corners;
    places |= ((places | places >> 18) & LOW_X) << 9;
    places |= ((places | places >> 6) & LOW_Y) << 3;
    return places | ((places | places >> 2) & LOW_Z) << 1;
}

/* Whether the cubes within a tile may become one, level by level. */
static int is_simple(const contour *work, const contour_block *block, const int at[3], int edge)
{
    if (edge == 1) return 1;
    const int half = edge / 2;
    uint32_t inside = 0;
    for (int i = 0; i < 9; i++) {
        const unsigned row = (unsigned)block->inside[at[0] + i / 3 * half][at[1] + i % 3 * half] >> at[2];
        inside |= ((row & 1) | (row >> half & 1) << 1 | (row >> edge & 1) << 2) << (3 * i);
    }
    const uint32_t outside = ~inside & ALL_PLACES;
    if ((inside & ~reach_of(inside & CORNER_PLACES)) | (outside & ~reach_of(outside & CORNER_PLACES))) return 0;
    unsigned config = 0;
    for (int c = 0; c < 8; c++) config |= (inside >> ((c >> 2) * 18 + (c >> 1 & 1) * 6 + (c & 1) * 2) & 1) << c;
    const contour_case *joined = &work->table.entry[config][0];
    if (joined->count != 1 || joined->twice_on_face != SWARF_NO_FACE) return 0;
    for (int c = 0; c < 8; c++) {
        const int corner[3] = {at[0] + (c >> 2) * half, at[1] + (c >> 1 & 1) * half, at[2] + (c & 1) * half};
        if (!is_empty(block, corner, half) && !is_simple(work, block, corner, half)) return 0;
    }
    return 1;
}

/* The plane of the surface in a cell with one vertex. */
static void plane_of(const tiling *t, int x, int bit, uint32_t vertex, contour_plane *out)
{
    for (int k = 0; k < 3; k++) out->point[k] = (double)t->block->vertices[vertex].xyz[k];
    for (int edge = 0; edge < 12; edge++) {
        const int axis = edge / 4;
        const int *offset = swarf_contour_edge_offset[edge];
        const int at[3] = {x + offset[0], (bit >> 3) + offset[1], (bit & 7) + offset[2]};
        const contour_crossing *crossing = swarf_contour_crossing(t->work, t->block, at, axis);
        if (!crossing) continue;
        for (int k = 0; k < 3; k++) out->normal[k] = (double)crossing->normal[k];
        return;
    }
}

/* Whether the cells of a block from lo to hi - 1 are flat, free to go, and on the plane. */
static int lie_on(const tiling *t, const contour_block *block, const int lo[3], const int hi[3],
                  const contour_plane *plane)
{
    const uint64_t within = cells_within(lo[1], hi[1], lo[2], hi[2]);
    for (int x = lo[0]; x < hi[0]; x++) {
        const uint64_t all = block->cell_mask[x], word = all & within;
        if (word & (~block->flat_mask[x] | block->keep_mask[x])) return 0;
        for (uint64_t left = word; left; left &= left - 1) {
            const unsigned cell = block->cell_rank[x] + swarf_contour_below(all, __builtin_ctzll(left));
            const float *p = block->vertices[block->cells[cell].first].xyz;
            double away = 0;
            for (int k = 0; k < 3; k++) away += plane->normal[k] * ((double)p[k] - plane->point[k]);
            if (!(fabs(away) <= t->flat)) return 0;
        }
    }
    return 1;
}

/* Whether a tile and what is about it lie on one plane: one cell about it, two about the largest. */
static int is_plane(const tiling *t, const int at[3], int edge, const contour_plane *plane)
{
    const int ring = edge == 8 ? 2 : 1;
    for (int c = 0; c < 27; c++) {
        const int part[3] = {(c / 9 + 1) % 3 - 1, (c / 3 + 1) % 3 - 1, (c + 1) % 3 - 1}; /* its own block first */
        int32_t corner[3];
        int lo[3], hi[3], empty = 0;
        for (int k = 0; k < 3; k++) {
            corner[k] = t->block->ijk[k] + part[k] * SWARF_LEAF_DIM;
            lo[k] = at[k] - ring - part[k] * SWARF_LEAF_DIM;
            hi[k] = at[k] + edge + ring - part[k] * SWARF_LEAF_DIM;
            lo[k] = lo[k] < 0 ? 0 : lo[k];
            hi[k] = hi[k] > SWARF_LEAF_DIM ? SWARF_LEAF_DIM : hi[k];
            empty |= lo[k] >= hi[k];
        }
        if (empty) continue;
        const contour_block *block = swarf_contour_block_at(t->work, corner);
        if (block && !lie_on(t, block, lo, hi, plane)) return 0;
    }
    return 1;
}

typedef struct cell_list {
    int count;
    uint16_t vertex[SWARF_LEAF_SIZE];
    int x, bit; /* of the first */
} cell_list;

/* The vertices of a tile whose cells are all flat; 0 when they are not, or less than two. */
static int list_cells(const contour_block *block, const int at[3], int edge, cell_list *out)
{
    const uint64_t within = cells_within(at[1], at[1] + edge, at[2], at[2] + edge);
    out->count = 0;
    for (int x = at[0]; x < at[0] + edge; x++)
        if (block->cell_mask[x] & within & ~block->flat_mask[x]) return 0;
    for (int x = at[0]; x < at[0] + edge; x++) {
        const uint64_t all = block->cell_mask[x];
        for (uint64_t left = all & within; left; left &= left - 1) {
            if (out->count == 0) {
                out->x = x;
                out->bit = __builtin_ctzll(left);
            }
            out->vertex[out->count++] =
                block->cells[block->cell_rank[x] + swarf_contour_below(all, __builtin_ctzll(left))].first;
        }
    }
    return out->count > 1;
}

/* The vertex nearest to the middle of a tile. */
static uint16_t find_middle(const tiling *t, const int at[3], int edge, const cell_list *cells)
{
    const swarf_tree_layout *layout = t->work->layout;
    double middle[3], least = INFINITY;
    uint16_t chosen = 0;
    for (int k = 0; k < 3; k++) middle[k] = layout->origin[k] + (t->block->ijk[k] + at[k] + 0.5 * edge) * layout->voxel;
    for (int i = 0; i < cells->count; i++) {
        const float *p = t->block->vertices[cells->vertex[i]].xyz;
        double square = 0;
        for (int k = 0; k < 3; k++) square += ((double)p[k] - middle[k]) * ((double)p[k] - middle[k]);
        if (square >= least) continue;
        least = square;
        chosen = cells->vertex[i];
    }
    return chosen;
}

/* To be told from every number of a vertex. */
enum { NO_TILE = 0xffff };

static void make_tiles(const tiling *t, const int at[3], int edge)
{
    cell_list cells;
    if (edge == 1 || is_empty(t->block, at, edge)) return;
    if (list_cells(t->block, at, edge, &cells)) {
        contour_plane plane;
        plane_of(t, cells.x, cells.bit, cells.vertex[0], &plane);
        if (is_plane(t, at, edge, &plane) && is_simple(t->work, t->block, at, edge)) {
            const uint16_t chosen = find_middle(t, at, edge, &cells);
            for (int i = 0; i < cells.count; i++) t->block->tile[cells.vertex[i]] = chosen;
            return;
        }
    }
    const int half = edge / 2;
    for (int c = 0; c < 8; c++) {
        const int corner[3] = {at[0] + (c >> 2) * half, at[1] + (c >> 1 & 1) * half, at[2] + (c & 1) * half};
        make_tiles(t, corner, half);
    }
}

/* Number the vertices that are left. */
static swarf_status count_left(contour_block *block)
{
    block->left_count = 0;
    block->left = malloc(block->vertex_count * sizeof *block->left);
    uint16_t *number = malloc(block->vertex_count * sizeof *number);
    if (!block->left || !number) {
        free(number);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for tiles");
    }
    for (uint32_t v = 0; v < block->vertex_count; v++) {
        if (block->tile[v] != NO_TILE && block->tile[v] != v) continue;
        block->left[block->left_count] = (uint16_t)v;
        number[v] = (uint16_t)block->left_count++;
    }
    for (uint32_t v = 0; v < block->vertex_count; v++)
        block->tile[v] = (uint16_t)(block->tile[v] == NO_TILE ? number[v] : number[block->tile[v]] | SWARF_TILED);
    free(number);
    return SWARF_OK;
}

void swarf_contour_untile(contour_block *block)
{
    free(block->tile);
    free(block->left);
    block->tile = block->left = NULL;
    block->left_count = block->vertex_count;
}

swarf_status swarf_contour_tile(contour *work, contour_block *block)
{
    static const int corner[3] = {0, 0, 0};
    uint64_t flat = 0;
    swarf_contour_untile(block);
    for (int x = 0; x < 8; x++) flat |= block->flat_mask[x];
    if (!(work->error_mm > 0) || !flat) return SWARF_OK;
    block->tile = malloc(block->vertex_count * sizeof *block->tile);
    if (!block->tile) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for tiles");
    memset(block->tile, 0xff, block->vertex_count * sizeof *block->tile);
    const double limit = work->error_mm < 0.1 * work->layout->voxel ? work->error_mm : 0.1 * work->layout->voxel;
    const tiling t = {work, block, SWARF_TILE_FLAT * limit};
    make_tiles(&t, corner, SWARF_LEAF_DIM);
    return count_left(block);
}
