/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Second and third pass of contouring: a vertex per cycle of every active cell, then a quadrilateral per crossing. */
#include "base/status.h"
#include "mesh/contour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int config_at(const float *values, int x, int y, int z)
{
    int config = 0;
    for (int c = 0; c < 8; c++)
        config |= (values[((x + 1 + (c >> 2)) * SWARF_HALO + y + 1 + (c >> 1 & 1)) * SWARF_HALO + z + 1 + (c & 1)] < 0)
                  << c;
    return config;
}

/* Whether the cell's face that its cycle passes twice is one that the cycle of the cell behind it passes twice too. */
static int is_flipped(const contour *work, const float *values, int config, const int at[3])
{
    const int face = work->table.entry[config][0].twice_on_face;
    if (face == SWARF_NO_FACE) return 0;
    int other[3] = {at[0], at[1], at[2]};
    other[face / 2] += face % 2 ? 1 : -1;
    const int behind = config_at(values, other[0], other[1], other[2]);
    return work->table.entry[behind][0].twice_on_face == (face ^ 1);
}

/* Where an edge of a cell starts, from the cell. */
static void edge_offset(int edge, int out[3])
{
    const int axis = edge / 4;
    out[axis] = 0;
    out[(axis + 1) % 3] = edge >> 1 & 1;
    out[(axis + 2) % 3] = edge & 1;
}

/* Gather the crossings of one cycle. */
static void gather(const contour *work, const contour_block *block, const int at[3], const contour_case *joined,
                   int config, int cycle, contour_polygon *out)
{
    out->count = 0;
    for (int edge = 0; edge < 12; edge++) {
        const int axis = edge / 4;
        int offset[3];
        edge_offset(edge, offset);
        const int low = offset[0] * 4 + offset[1] * 2 + offset[2], high = low + (4 >> axis);
        if ((config >> low & 1) == (config >> high & 1) || joined->of_edge[edge] != cycle) continue;
        int32_t voxel[3];
        for (int k = 0; k < 3; k++) voxel[k] = block->ijk[k] + at[k] + offset[k];
        const contour_crossing *crossing = swarf_contour_crossing(work, voxel, axis);
        if (!crossing) continue; /* beyond the layout: the mesh will be found open */
        const int i = out->count++;
        out->edge[i] = (uint8_t)edge;
        for (int k = 0; k < 3; k++) {
            out->point[i][k] = offset[k] + (k == axis ? crossing->t : 0);
            out->normal[i][k] = crossing->normal[k];
        }
        out->move[i] = crossing->move;
        out->piece[i] = crossing->piece;
    }
}

static void place_middle(const contour_polygon *polygon, double out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = 0;
        for (int i = 0; i < polygon->count; i++) out[k] += polygon->point[i][k] / polygon->count;
    }
}

/* In voxels: planes of crossings on one flat face pass each other's crossings this close, and the exact surface the
 * vertex; and the cosine between their normals, for 0.3 degrees. */
static const double same_plane = 1e-3, same_plane_cosine = 0.999986;

/* Where the field is flat round all crossings, their middle is on the surface, unless that is hidden from the field. */
static int place_flat(const contour_polygon *polygon, const swarf_surface_near *near, double out[3])
{
    for (int i = 0; i < polygon->count; i++)
        if (polygon->move[i] != SWARF_BY_FLAT_FIELD) return 0;
    double middle[3];
    place_middle(polygon, middle);
    const double *n = polygon->normal[0];
    for (int i = 0; i < polygon->count; i++) {
        const double *m = polygon->normal[i];
        double away = 0, cosine = 0;
        for (int k = 0; k < 3; k++) {
            away += n[k] * (polygon->point[i][k] - middle[k]);
            cosine += n[k] * m[k];
        }
        if (fabs(away) > same_plane || cosine < same_plane_cosine) return 0;
    }
    if (near) {
        swarf_surface_point found;
        double world[3], cosine = 0;
        for (int k = 0; k < 3; k++) world[k] = polygon->origin[k] + middle[k] * polygon->voxel;
        swarf_surface_evaluate(near, world, &found);
        for (int k = 0; k < 3; k++) cosine += n[k] * found.normal[k];
        if (fabs(found.value) > same_plane * polygon->voxel || cosine < same_plane_cosine) return 0;
    }
    memcpy(out, middle, sizeof middle);
    swarf_contour_clamp(out);
    return 1;
}

/* Crossings of a flat field beside others: what they are on the exact surface. */
static void make_exact(contour_polygon *polygon, const swarf_surface_near *near, int config)
{
    for (int i = 0; i < polygon->count; i++) {
        if (polygon->move[i] != SWARF_BY_FLAT_FIELD) continue;
        const int axis = polygon->edge[i] / 4;
        int offset[3];
        double a[3];
        edge_offset(polygon->edge[i], offset);
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

/* Leave out the crossings that only the field knows. */
static void keep_exact(contour_polygon *polygon)
{
    int kept = 0;
    for (int i = 0; i < polygon->count; i++) {
        if (polygon->move[i] == SWARF_BY_FIELD) continue;
        memcpy(polygon->point[kept], polygon->point[i], sizeof polygon->point[i]);
        memcpy(polygon->normal[kept], polygon->normal[i], sizeof polygon->normal[i]);
        polygon->move[kept] = polygon->move[i];
        polygon->piece[kept++] = polygon->piece[i];
    }
    polygon->count = kept;
}

/* Place the vertex of a cycle on the exact surface if that made any of its crossings, else by the field. Returns
 * whether it lies on a flat face. */
static int place_vertex(contour_block *block, contour_polygon *polygon, const swarf_surface_near *near, int config,
                        int calm, int middle, double out[3])
{
    if (middle) {
        place_middle(polygon, out);
        return 0;
    }
    if (place_flat(polygon, near, out)) {
        block->exact_count += near != NULL;
        return 1;
    }
    if (!near) {
        if (calm)
            place_middle(polygon, out);
        else
            block->sharp_count += swarf_contour_vertex(polygon, out) > 1;
        return 0;
    }
    make_exact(polygon, near, config);
    contour_polygon known = *polygon;
    keep_exact(&known);
    const int exact = known.count > 0;
    int rank = 1;
    if (calm && !exact)
        place_middle(polygon, out);
    else if (calm)
        swarf_contour_vertex_smooth(&known, near, out);
    else
        rank = exact ? swarf_contour_vertex_exact(&known, near, out) : swarf_contour_vertex(polygon, out);
    block->sharp_count += rank > 1;
    block->exact_count += exact;
    return 0;
}

static swarf_status place_cell(contour *work, contour_block *block, const float *values, contour_near *near, int index,
                               contour_cell *cell, uint32_t *used)
{
    const swarf_tree_layout *layout = work->layout;
    const int at[3] = {index >> 6, index >> 3 & 7, index & 7};
    const contour_case *joined = &work->table.entry[cell->config][cell->flip];
    const int calm = (int)(block->calm_mask[at[0]] >> (index & 63) & 1);
    const int middle = (int)(block->middle_mask[at[0]] >> (index & 63) & 1);
    const swarf_surface_near *surface;
    SWARF_TRY(swarf_contour_near_get(near, at, &surface));
    contour_polygon polygon = {.voxel = layout->voxel};
    for (int k = 0; k < 3; k++) polygon.origin[k] = layout->origin[k] + (block->ijk[k] + at[k]) * layout->voxel;
    for (int c = 0; c < 8; c++)
        polygon.corner[c] =
            (double)values[((at[0] + 1 + (c >> 2)) * SWARF_HALO + at[1] + 1 + (c >> 1 & 1)) * SWARF_HALO + at[2] + 1 +
                           (c & 1)] /
            layout->voxel;
    cell->first = (uint16_t)*used;
    for (int cycle = 0; cycle < joined->count; cycle++) {
        double inside[3] = {0.5, 0.5, 0.5};
        gather(work, block, at, joined, cell->config, cycle, &polygon);
        const int flat =
            polygon.count > 0 && place_vertex(block, &polygon, surface, cell->config, calm, middle, inside);
        if (flat && joined->count == 1) block->flat_mask[at[0]] |= UINT64_C(1) << (index & 63);
        for (int k = 0; k < 3; k++)
            block->vertices[*used].xyz[k] = (float)(polygon.origin[k] + inside[k] * layout->voxel);
        (*used)++;
    }
    return SWARF_OK;
}

swarf_status swarf_contour_place(contour *work, contour_block *block)
{
    float values[SWARF_HALO * SWARF_HALO * SWARF_HALO];
    contour_cell cells[SWARF_LEAF_SIZE];
    uint32_t cell_count = 0, vertex_count = 0;
    swarf_contour_fetch(work, block->ijk, values);
    block->sharp_count = block->exact_count = 0;
    memset(block->flat_mask, 0, sizeof block->flat_mask);
    uint16_t(*inside)[9] = block->inside;
    for (int x = 0; x < 9; x++)
        for (int y = 0; y < 9; y++) {
            const float *row = values + ((x + 1) * SWARF_HALO + y + 1) * SWARF_HALO + 1;
            unsigned signs = 0;
            for (int z = 0; z < 9; z++) signs |= (unsigned)(row[z] < 0) << z;
            inside[x][y] = (uint16_t)signs;
        }
    for (int x = 0; x < 8; x++) {
        uint64_t word = 0;
        block->cell_rank[x] = (uint16_t)cell_count;
        for (int y = 0; y < 8; y++) {
            const unsigned a = inside[x][y], b = inside[x][y + 1], c = inside[x + 1][y], d = inside[x + 1][y + 1];
            const unsigned any = a | b | c | d, all = a & b & c & d;
            word |= (uint64_t)((any | any >> 1) & ~(all & all >> 1) & 0xff) << (8 * y);
        }
        for (uint64_t left = word; left; left &= left - 1) {
            const int yz = __builtin_ctzll(left), at[3] = {x, yz >> 3, yz & 7};
            const int config = config_at(values, at[0], at[1], at[2]);
            contour_cell *cell = &cells[cell_count++];
            cell->config = (uint8_t)config;
            cell->flip = (uint8_t)is_flipped(work, values, config, at);
            vertex_count += work->table.entry[config][cell->flip].count;
        }
        block->cell_mask[x] = word;
    }
    free(block->cells);
    free(block->vertices);
    block->cells = NULL;
    block->vertices = NULL;
    block->vertex_count = vertex_count;
    if (cell_count == 0) return SWARF_OK;
    block->cells = malloc(cell_count * sizeof *cells);
    block->vertices = malloc(vertex_count * sizeof *block->vertices);
    if (!block->cells || !block->vertices) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for vertices");
    contour_near near = {.work = work, .block = block};
    swarf_status status = SWARF_OK;
    uint32_t used = 0, next = 0;
    for (int x = 0; x < 8; x++)
        for (uint64_t word = block->cell_mask[x]; word && status == SWARF_OK; word &= word - 1)
            status = place_cell(work, block, values, &near, x * 64 + __builtin_ctzll(word), &cells[next++], &used);
    swarf_contour_near_free(&near);
    memcpy(block->cells, cells, cell_count * sizeof *cells);
    return status;
}

/* In voxels: triangles less high than this are avoided. */
static const double least_height = 1e-3;

/* Corner of a quadrilateral: the vertex of the cell `back` of the edge's voxel. */
typedef struct corner {
    double at[3]; /* in voxels from the edge's voxel */
    uint32_t number;
    int calm, tiled;
} corner;

static int find_corner(const contour *work, const int32_t voxel[3], int axis, const int back[2], corner *out)
{
    int32_t cell[3] = {voxel[0], voxel[1], voxel[2]};
    cell[(axis + 1) % 3] -= back[0];
    cell[(axis + 2) % 3] -= back[1];
    const contour_block *block = swarf_contour_block_at(work, cell);
    const int x = cell[0] & 7, bit = (cell[1] & 7) * 8 + (cell[2] & 7);
    if (!block || !(block->cell_mask[x] >> bit & 1)) return 0;
    const contour_cell *found =
        block->cells + block->cell_rank[x] + __builtin_popcountll(block->cell_mask[x] & ((UINT64_C(1) << bit) - 1));
    const contour_case *joined = &work->table.entry[found->config][found->flip];
    uint32_t local = found->first + joined->of_edge[axis * 4 + back[0] * 2 + back[1]];
    out->tiled = block->tile && block->tile[local] != SWARF_NO_TILE;
    if (out->tiled) local = block->tile[local];
    out->number = (uint32_t)(block->vertex_first + local);
    out->calm = (int)(block->calm_mask[x] >> bit & 1);
    for (int k = 0; k < 3; k++)
        out->at[k] = ((double)block->vertices[local].xyz[k] - work->layout->origin[k]) / work->layout->voxel - voxel[k];
    return 1;
}

/* Cosine between a triangle and the true normal; -1 for a needle that may turn over when it is rounded to floats. */
static double facing(const double *a, const double *b, const double *c, const double normal[3])
{
    double u[3], v[3], longest = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
        longest += u[k] * u[k] + v[k] * v[k];
    }
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    if (square < least_height * least_height * longest) return -1;
    return (n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2]) / sqrt(square);
}

/* Whether the two triangles on the diagonal corner[first] - corner[first + 2] meet the edge itself and not only its
 * line: else they might reach into sheets above or below. */
static int meets_edge(const corner q[4], int first, int axis)
{
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const double *p = q[first].at, *r = q[first + 2].at;
    const double side = p[b] * r[c] - p[c] * r[b];
    /* corner k lies in the k-th quadrant round the edge, so that the line is on the side of one of the two others */
    const double *third = q[(first + 1) % 4].at;
    const double third_side = (r[b] - p[b]) * (third[c] - p[c]) - (r[c] - p[c]) * (third[b] - p[b]);
    if (side * third_side < 0) third = q[(first + 3) % 4].at;
    const double area = (r[b] - p[b]) * (third[c] - p[c]) - (r[c] - p[c]) * (third[b] - p[b]);
    if (area == 0) return 0;
    const double w_third = side / area, w_p = (r[b] * third[c] - r[c] * third[b]) / area, w_r = 1 - w_third - w_p;
    const double height = w_p * p[axis] + w_r * r[axis] + w_third * third[axis];
    return height >= 0 && height <= 1;
}

static void put_facet(swarf_facet *facet, const contour_crossing *crossing, int outwards, float error, uint32_t a,
                      uint32_t b, uint32_t c)
{
    facet->v[0] = a;
    facet->v[1] = outwards ? b : c;
    facet->v[2] = outwards ? c : b;
    facet->error_mm = error;
    for (int k = 0; k < 3; k++) facet->normal[k] = (int16_t)lrintf(crossing->normal[k] * 32767);
}

/* Which diagonal cuts the quadrilateral: 0, 1, or -1 for all four triangles round its crossing. */
static int choose_diagonal(const corner q[4], int axis, int outwards, const contour_crossing *crossing)
{
    for (int k = 0; k < 4; k++)
        if (q[k].calm) return -1;
    double normal[3], least[2];
    for (int k = 0; k < 3; k++) normal[k] = outwards ? crossing->normal[k] : -(double)crossing->normal[k];
    for (int d = 0; d < 2; d++)
        least[d] = fmin(facing(q[d].at, q[d + 1].at, q[d + 2].at, normal),
                        facing(q[d].at, q[d + 2].at, q[(d + 3) % 4].at, normal));
    const int meets[2] = {meets_edge(q, 0, axis), meets_edge(q, 1, axis)};
    int best = least[1] > least[0] + 1e-3;
    if (fabs(least[1] - least[0]) <= 1e-3) {
        double length[2] = {0, 0};
        for (int d = 0; d < 2; d++)
            for (int k = 0; k < 3; k++) length[d] += (q[d].at[k] - q[d + 2].at[k]) * (q[d].at[k] - q[d + 2].at[k]);
        best = length[1] < length[0] * (1 - 1e-6);
    }
    if (meets[best]) return best;
    return meets[!best] ? !best : -1;
}

enum { NONE_SAME = -1, TWO_SAME = -2 };

/* The corner that is the same as the next one, in a tile with it. */
static int find_same(const corner q[4])
{
    int found = NONE_SAME;
    for (int k = 0; k < 4; k++)
        if (q[k].number == q[(k + 1) % 4].number) found = found == NONE_SAME ? k : TWO_SAME;
    return found;
}

swarf_status swarf_contour_join(contour *work, contour_block *block)
{
    free(block->facets);
    free(block->centres);
    block->facets = NULL;
    block->centres = NULL;
    block->facet_count = block->full_count = block->centre_count = 0;
    if (block->crossing_count == 0) return SWARF_OK;
    swarf_facet *facets = malloc(4 * (size_t)block->crossing_count * sizeof *facets);
    contour_vertex *centres = malloc(block->crossing_count * sizeof *centres);
    block->facets = facets;
    block->centres = centres;
    if (!facets || !centres) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for facets");
    static const int back[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}; /* counter-clockwise seen against the axis */
    const contour_crossing *crossing = block->crossings;
    for (int axis = 0; axis < 3; axis++)
        for (int x = 0; x < 8; x++)
            for (uint64_t word = block->edge_mask[axis][x]; word; word &= word - 1, crossing++) {
                const int bit = __builtin_ctzll(word);
                const int32_t voxel[3] = {block->ijk[0] + x, block->ijk[1] + (bit >> 3), block->ijk[2] + (bit & 7)};
                const int outwards = swarf_stock_value(work->stock, voxel) < 0;
                corner q[4];
                int found = 0;
                for (int k = 0; k < 4; k++) found += find_corner(work, voxel, axis, back[k], &q[k]);
                if (found < 4) continue; /* at the border of the layout: the mesh will be found open */
                block->full_count += 2;
                float error = 0;
                for (int k = 0; k < 4; k++)
                    if (q[k].tiled) error = (float)(SWARF_TILE_ERROR * work->error_mm);
                swarf_facet *next = facets + block->facet_count;
                const int same = find_same(q);
                if (same != NONE_SAME) {
                    if (same == TWO_SAME) continue;
                    put_facet(next, crossing, outwards, error, q[(same + 1) % 4].number, q[(same + 2) % 4].number,
                              q[(same + 3) % 4].number);
                    block->facet_count++;
                    continue;
                }
                const int d = choose_diagonal(q, axis, outwards, crossing);
                if (d >= 0) {
                    put_facet(next, crossing, outwards, error, q[d].number, q[d + 1].number, q[d + 2].number);
                    put_facet(next + 1, crossing, outwards, error, q[d].number, q[d + 2].number, q[(d + 3) % 4].number);
                    block->facet_count += 2;
                    continue;
                }
                block->full_count += 2;
                contour_vertex *centre = &centres[block->centre_count];
                for (int k = 0; k < 3; k++)
                    centre->xyz[k] = (float)(work->layout->origin[k] +
                                             (voxel[k] + (k == axis ? (double)crossing->t : 0)) * work->layout->voxel);
                for (int k = 0; k < 4; k++)
                    put_facet(next + k, crossing, outwards, error, q[k].number, q[(k + 1) % 4].number,
                              SWARF_CENTRE | block->centre_count);
                block->facet_count += 4;
                block->centre_count++;
            }
    swarf_facet *fitting = realloc(facets, (block->facet_count ? block->facet_count : 1) * sizeof *facets);
    if (fitting) block->facets = fitting;
    return SWARF_OK;
}
