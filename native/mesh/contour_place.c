/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Second pass of contouring: a vertex per cycle of every active cell. */
#include "base/status.h"
#include "mesh/contour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A block at work. */
typedef struct placing {
    contour *work;
    contour_block *block;
    contour_near near;
    int fetched; /* whether values are there: few cells need them */
    float values[SWARF_HALO * SWARF_HALO * SWARF_HALO];
} placing;

static const float *values_at(placing *p, const int at[3])
{
    if (!p->fetched) swarf_contour_fetch(p->work, p->block->ijk, p->values);
    p->fetched = 1;
    return p->values + ((at[0] + 1) * SWARF_HALO + at[1] + 1) * SWARF_HALO + at[2] + 1;
}

static int config_at(const contour_block *block, const int at[3])
{
    int config = 0;
    for (int row = 0; row < 4; row++)
        config |= (block->inside[at[0] + (row >> 1)][at[1] + (row & 1)] >> at[2] & 3) << (2 * row);
    return config;
}

/* Whether the cell's face that its cycle passes twice is one that the cycle of the cell behind it passes twice too. */
static int is_flipped(placing *p, int config, const int at[3])
{
    const int face = p->work->table.entry[config][0].twice_on_face;
    if (face == SWARF_NO_FACE) return 0;
    int other[3] = {at[0], at[1], at[2]}, behind = 0;
    other[face / 2] += face % 2 ? 1 : -1;
    const float *value = values_at(p, other);
    for (int c = 0; c < 8; c++)
        behind |= (value[(c >> 2) * SWARF_HALO * SWARF_HALO + (c >> 1 & 1) * SWARF_HALO + (c & 1)] < 0) << c;
    return p->work->table.entry[behind][0].twice_on_face == (face ^ 1);
}

/* Gather the crossings of one cycle. */
static void gather(const placing *p, const int at[3], const contour_case *joined, int cycle, contour_polygon *out)
{
    out->count = 0;
    for (unsigned left = joined->edges[cycle]; left; left &= left - 1) {
        const int edge = __builtin_ctz(left), axis = edge / 4;
        const int *offset = swarf_contour_edge_offset[edge];
        const int voxel[3] = {at[0] + offset[0], at[1] + offset[1], at[2] + offset[2]};
        const contour_crossing *crossing = swarf_contour_crossing(p->work, p->block, voxel, axis);
        if (!crossing) continue; /* beyond the layout: the mesh will be found open */
        const int i = out->count++;
        out->edge[i] = (uint8_t)edge;
        for (int k = 0; k < 3; k++) {
            out->point[i][k] = offset[k];
            out->normal[i][k] = (double)crossing->normal[k];
        }
        out->point[i][axis] = (double)crossing->t;
        out->move[i] = crossing->move;
        out->piece[i] = crossing->piece;
    }
}

/* Faces beside a wedge differ by more than 15 degrees. */
static const double wedge_cosine = 0.966;
/* In voxels: how far along the edge of a wedge a vertex may be moved. */
static const double farthest_along = 0.5;

/* Crossings of a flat field beside others: what they are on the exact surface. */
static void make_exact(contour_polygon *polygon, const swarf_surface_near *near, int config)
{
    for (int i = 0; i < polygon->count; i++) {
        if (polygon->move[i] != SWARF_BY_FLAT_FIELD) continue;
        const int axis = polygon->edge[i] / 4;
        const int *offset = swarf_contour_edge_offset[polygon->edge[i]];
        double a[3];
        for (int k = 0; k < 3; k++) a[k] = polygon->origin[k] + offset[k] * polygon->voxel;
        const int outwards = config >> (offset[0] * 4 + offset[1] * 2 + offset[2]) & 1;
        contour_crossing crossing = {.t = (float)polygon->point[i][axis], .move = SWARF_BY_FIELD};
        swarf_contour_cross_exact(near, a, polygon->voxel, axis, outwards, &crossing);
        polygon->move[i] = crossing.move;
        polygon->piece[i] = crossing.piece;
        if (crossing.move == SWARF_BY_FIELD) continue;
        polygon->point[i][axis] = (double)crossing.t;
        for (int k = 0; k < 3; k++) polygon->normal[i][k] = (double)crossing.normal[k];
    }
}

/* Leave out the crossings that only the field knows; 0, and all stay, where there are no others. */
static int keep_exact(contour_polygon *polygon)
{
    int kept = 0;
    for (int i = 0; i < polygon->count; i++) {
        if (polygon->move[i] == SWARF_BY_FIELD) continue;
        if (kept < i) {
            memcpy(polygon->point[kept], polygon->point[i], sizeof polygon->point[i]);
            memcpy(polygon->normal[kept], polygon->normal[i], sizeof polygon->normal[i]);
            polygon->move[kept] = polygon->move[i];
            polygon->piece[kept] = polygon->piece[i];
        }
        kept++;
    }
    if (kept) polygon->count = kept;
    return kept > 0;
}

/* Place the vertex of a cycle by the field. */
static int place_by_field(placing *p, const int at[3], contour_polygon *polygon, double out[3])
{
    const float *value = values_at(p, at);
    for (int c = 0; c < 8; c++)
        polygon->corner[c] =
            (double)value[(c >> 2) * SWARF_HALO * SWARF_HALO + (c >> 1 & 1) * SWARF_HALO + (c & 1)] / polygon->voxel;
    return swarf_contour_vertex(polygon, out);
}

/* Where faces meet in a cell beside this one: there a wedge ends that is narrower than a voxel. Without this cell's
 * vertex on it the edge would have a notch, be it that no other vertex is there or that only other cells' are; where it
 * folds what lies between them swarf_contour_unfold() takes it back. Sets *rank where they do, no farther than half a
 * voxel from where they come nearest to the crossings: beyond, the edge is another cell's. */
static swarf_status place_beside(placing *p, const int at[3], contour_polygon *polygon, double out[3], int *rank)
{
    enum { OWN = 13 }; /* of the 27 cells */
    const swarf_surface_near *near;
    const contour_bounds own = polygon->bounds;
    double free[3], least = farthest_along * farthest_along;
    SWARF_TRY(swarf_contour_near_wide(&p->near, at, &near));
    for (int k = 0; k < 3; k++) {
        polygon->bounds.lo[k] -= 1;
        polygon->bounds.hi[k] += 1;
    }
    const int meeting = swarf_contour_vertex_exact(polygon, near, free) > 1;
    for (int n = 0; meeting && n < 27; n++) {
        const int way[3] = {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
        double x[3], away = 0, nearest = 0;
        for (int k = 0; k < 3; k++) {
            polygon->bounds.lo[k] = own.lo[k] + way[k];
            polygon->bounds.hi[k] = own.hi[k] + way[k];
            const double to = fmin(fmax(free[k], way[k]), way[k] + 1) - free[k];
            nearest += to * to;
        }
        if (n == OWN || nearest >= least) continue;
        const int found = swarf_contour_vertex_exact(polygon, near, x);
        for (int k = 0; k < 3; k++) away += (x[k] - free[k]) * (x[k] - free[k]);
        if (found < 2 || away >= least) continue;
        least = away;
        *rank = found;
        memcpy(out, x, sizeof x);
    }
    polygon->bounds = own;
    return SWARF_OK;
}

/* Whether the crossings of a cycle differ by more than what one face does. */
static int has_faces(const contour_polygon *polygon)
{
    double least = 1;
    for (int i = 0; i < polygon->count; i++)
        for (int j = 0; j < i; j++)
            least = fmin(least, polygon->normal[i][0] * polygon->normal[j][0] +
                                    polygon->normal[i][1] * polygon->normal[j][1] +
                                    polygon->normal[i][2] * polygon->normal[j][2]);
    return least < wedge_cosine;
}

/* Place the vertex of a cycle on the exact surface if that made any of its crossings, else by the field. Sets
 * *flat where it lies on a flat face. */
static swarf_status place_vertex(placing *p, const int at[3], int config, contour_polygon *polygon, double out[3],
                                 int *flat)
{
    contour_block *block = p->block;
    const int bit = at[1] * 8 + at[2];
    const int calm = (int)(block->calm_mask[at[0]] >> bit & 1), middle = (int)(block->middle_mask[at[0]] >> bit & 1);
    if (middle) {
        for (int i = 0; i < polygon->count; i++) {
            double *t = &polygon->point[i][polygon->edge[i] / 4];
            *t = fmin(fmax(*t, SWARF_CONTOUR_LAST_MARGIN), 1 - SWARF_CONTOUR_LAST_MARGIN);
        }
        swarf_contour_middle(polygon, out);
        return SWARF_OK;
    }
    const swarf_surface_near *near;
    SWARF_TRY(swarf_contour_vertex_flat(&p->near, at, polygon, out, flat));
    if (*flat) {
        block->exact_count += p->work->surface != NULL;
        return SWARF_OK;
    }
    int rank = 1, exact = 0;
    SWARF_TRY(swarf_contour_near_get(&p->near, at, &near));
    if (near) {
        SWARF_TRY(swarf_contour_near_narrow(&p->near, at, &near));
        make_exact(polygon, near, config);
        exact = keep_exact(polygon);
        if (exact && calm)
            swarf_contour_vertex_smooth(polygon, near, out);
        else if (exact)
            rank = swarf_contour_vertex_exact(polygon, near, out);
        if (exact && !calm && !(block->own_mask[at[0]] >> bit & 1) && rank == 1 && has_faces(polygon)) {
            SWARF_TRY(place_beside(p, at, polygon, out, &rank));
            if (rank > 1) block->beside_mask[at[0]] |= UINT64_C(1) << bit;
        }
    }
    if (!exact && calm)
        swarf_contour_middle(polygon, out);
    else if (!exact)
        rank = place_by_field(p, at, polygon, out);
    block->sharp_count += rank > 1;
    block->exact_count += (uint32_t)exact;
    return SWARF_OK;
}

static swarf_status place_cell(placing *p, const int at[3], contour_cell *cell, uint32_t *used)
{
    const swarf_tree_layout *layout = p->work->layout;
    contour_block *block = p->block;
    const contour_case *joined = &p->work->table.entry[cell->config][cell->flip];
    contour_polygon polygon;
    polygon.voxel = layout->voxel;
    for (int k = 0; k < 3; k++) {
        polygon.origin[k] = layout->origin[k] + (block->ijk[k] + at[k]) * layout->voxel;
        polygon.bounds.lo[k] = SWARF_CONTOUR_MARGIN;
        polygon.bounds.hi[k] = 1 - SWARF_CONTOUR_MARGIN;
    }
    cell->first = (uint16_t)*used;
    for (int cycle = 0; cycle < joined->count; cycle++) {
        double inside[3] = {0.5, 0.5, 0.5};
        gather(p, at, joined, cycle, &polygon);
        int flat = 0;
        if (polygon.count > 0) SWARF_TRY(place_vertex(p, at, cell->config, &polygon, inside, &flat));
        if (flat && joined->count == 1) block->flat_mask[at[0]] |= UINT64_C(1) << (at[1] * 8 + at[2]);
        for (int k = 0; k < 3; k++)
            block->vertices[*used].xyz[k] = (float)(polygon.origin[k] + inside[k] * layout->voxel);
        (*used)++;
    }
    return SWARF_OK;
}

/* Find the active cells. */
static uint32_t list_cells(placing *p, contour_cell cells[SWARF_LEAF_SIZE])
{
    contour_block *block = p->block;
    const uint16_t(*inside)[9] = (const uint16_t(*)[9])block->inside;
    uint32_t count = 0;
    block->vertex_count = 0;
    for (int x = 0; x < 8; x++) {
        uint64_t word = 0;
        block->cell_rank[x] = (uint16_t)count;
        for (int y = 0; y < 8; y++) {
            const unsigned a = inside[x][y], b = inside[x][y + 1], c = inside[x + 1][y], d = inside[x + 1][y + 1];
            const unsigned any = a | b | c | d, all = a & b & c & d;
            word |= (uint64_t)((any | any >> 1) & ~(all & all >> 1) & 0xff) << (8 * y);
        }
        block->cell_mask[x] = word;
        for (; word; word &= word - 1) {
            const int yz = __builtin_ctzll(word), at[3] = {x, yz >> 3, yz & 7};
            const int config = config_at(block, at);
            contour_cell *cell = &cells[count++];
            cell->config = (uint8_t)config;
            cell->flip = (uint8_t)is_flipped(p, config, at);
            block->vertex_count += p->work->table.entry[config][cell->flip].count;
        }
    }
    return count;
}

swarf_status swarf_contour_place(contour *work, contour_block *block)
{
    placing p; /* its values are set when they are needed */
    contour_cell cells[SWARF_LEAF_SIZE];
    p.work = work;
    p.block = block;
    p.near = (contour_near){.work = work, .block = block};
    p.fetched = 0;
    block->sharp_count = block->exact_count = 0;
    memset(block->flat_mask, 0, sizeof block->flat_mask);
    memset(block->beside_mask, 0, sizeof block->beside_mask);
    free(block->cells);
    free(block->vertices);
    block->cells = NULL;
    block->vertices = NULL;
    const uint32_t cell_count = list_cells(&p, cells);
    block->parted_count = block->vertex_count - cell_count;
    if (cell_count == 0) return SWARF_OK;
    block->cells = malloc(cell_count * sizeof *cells);
    block->vertices = malloc(block->vertex_count * sizeof *block->vertices);
    if (!block->cells || !block->vertices) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for vertices");
    swarf_status status = SWARF_OK;
    uint32_t used = 0, next = 0;
    for (int x = 0; x < 8; x++)
        for (uint64_t word = block->cell_mask[x]; word && status == SWARF_OK; word &= word - 1) {
            const int yz = __builtin_ctzll(word), at[3] = {x, yz >> 3, yz & 7};
            status = place_cell(&p, at, &cells[next++], &used);
        }
    swarf_contour_near_free(&p.near);
    memcpy(block->cells, cells, cell_count * sizeof *cells);
    return status;
}
