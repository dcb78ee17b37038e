/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Last pass of contouring: a quadrilateral per crossing, or what tiles leave of it, as triangles. Before it, a look at
 * those about vertices that lie beside their cells. */
#include "base/status.h"
#include "mesh/contour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In voxels: triangles less high than this are avoided. */
static const double least_height = 1e-3;

/* Corner of a quadrilateral: the vertex of one of the four cells round its edge. */
typedef struct corner {
    double at[3]; /* in voxels from the edge's voxel, set by measure_corners() */
    const float *xyz;
    uint32_t number; /* as facets of the block that is joined name it */
    int calm, tiled;
} corner;

/* Of the cell whose edge of that number starts at a voxel, at[] from the corner of `near`. */
static int find_corner(const contour *work, const contour_block *near, const int at[3], int edge, corner *out)
{
    const int *offset = swarf_contour_edge_offset[edge];
    const int cell[3] = {at[0] - offset[0], at[1] - offset[1], at[2] - offset[2]};
    const contour_block *block = swarf_contour_block_near(work, near, cell);
    const int x = cell[0] & 7, bit = (cell[1] & 7) * 8 + (cell[2] & 7);
    if (!block || !(block->cell_mask[x] >> bit & 1)) return 0;
    const contour_cell *found = block->cells + block->cell_rank[x] + swarf_contour_below(block->cell_mask[x], bit);
    const contour_case *joined = &work->table.entry[found->config][found->flip];
    uint32_t local = found->first + joined->of_edge[edge], left = local;
    out->tiled = block->tile && block->tile[local] & SWARF_TILED;
    if (block->tile) {
        left = block->tile[local] & ~SWARF_TILED;
        local = block->left[left];
    }
    const uint32_t below = (uint32_t)(cell[0] < 0) << 2 | (uint32_t)(cell[1] < 0) << 1 | (uint32_t)(cell[2] < 0);
    out->number = below << SWARF_BELOW_SHIFT | left;
    out->calm = (int)(block->calm_mask[x] >> bit & 1);
    out->xyz = block->vertices[local].xyz;
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

/* Where on the edge, 0 .. 1 from its voxel, the two triangles on the diagonal corner[first] - corner[first + 2] meet
 * it; NAN where they only meet its line: they might reach into sheets above or below. */
static double meet_edge(const corner q[4], int first, int axis)
{
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const double *p = q[first].at, *r = q[first + 2].at;
    const double side = p[b] * r[c] - p[c] * r[b];
    /* corner k lies in the k-th quadrant round the edge, so that the line is on the side of one of the two others */
    const double *third = q[(first + 1) % 4].at;
    const double third_side = (r[b] - p[b]) * (third[c] - p[c]) - (r[c] - p[c]) * (third[b] - p[b]);
    if (side * third_side < 0) third = q[(first + 3) % 4].at;
    const double area = (r[b] - p[b]) * (third[c] - p[c]) - (r[c] - p[c]) * (third[b] - p[b]);
    if (area == 0) return NAN;
    const double w_third = side / area, w_p = (r[b] * third[c] - r[c] * third[b]) / area, w_r = 1 - w_third - w_p;
    const double height = w_p * p[axis] + w_r * r[axis] + w_third * third[axis];
    return height >= 0 && height <= 1 ? height : NAN;
}

static void put_facet(swarf_facet *facet, const contour_crossing *crossing, int outwards, float error, uint32_t a,
                      uint32_t b, uint32_t c)
{
    facet->v[0] = a;
    facet->v[1] = outwards ? b : c;
    facet->v[2] = outwards ? c : b;
    facet->error_mm = error;
    facet->lost_mm3 = 0;
    for (int k = 0; k < 3; k++) facet->normal[k] = (int16_t)lrintf(crossing->normal[k] * 32767);
    facet->beyond = facet->before = 0;
}

/* Vertices of the four cells round the edge from a voxel, at[] from the corner of `near`, counter-clockwise seen
 * against the axis; 0 when there are fewer. */
static int find_corners(const contour *work, const contour_block *near, const int at[3], int axis, corner q[4])
{
    static const int round[4] = {0, 2, 3, 1};
    int found = 0;
    for (int k = 0; k < 4; k++) found += find_corner(work, near, at, axis * 4 + round[k], &q[k]);
    return found == 4;
}

static void measure_corners(const contour *work, const int32_t voxel[3], corner q[4])
{
    const swarf_tree_layout *layout = work->layout;
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < 3; k++) q[c].at[k] = ((double)q[c].xyz[k] - layout->origin[k]) / layout->voxel - voxel[k];
}

/* The lesser cosine of the two triangles on a diagonal to the normal, which points along the axis. */
static double least_facing(const corner q[4], int first, const double normal[3])
{
    return fmin(facing(q[first].at, q[first + 1].at, q[first + 2].at, normal),
                facing(q[first].at, q[first + 2].at, q[(first + 3) % 4].at, normal));
}

/* Which diagonal cuts the quadrilateral, and where on the edge: 0, 1, or -1 for all four triangles round its crossing.
 */
static int choose_diagonal(const corner q[4], int axis, int outwards, const contour_crossing *crossing, double *at)
{
    for (int k = 0; k < 4; k++)
        if (q[k].calm) return -1;
    double normal[3], least[2];
    for (int k = 0; k < 3; k++) normal[k] = outwards ? crossing->normal[k] : -(double)crossing->normal[k];
    for (int d = 0; d < 2; d++) least[d] = least_facing(q, d, normal);
    const double meets[2] = {meet_edge(q, 0, axis), meet_edge(q, 1, axis)};
    int best = least[1] > least[0] + 1e-3;
    if (fabs(least[1] - least[0]) <= 1e-3) {
        double length[2] = {0, 0};
        for (int d = 0; d < 2; d++)
            for (int k = 0; k < 3; k++) length[d] += (q[d].at[k] - q[d + 2].at[k]) * (q[d].at[k] - q[d + 2].at[k]);
        best = length[1] < length[0] * (1 - 1e-6);
    }
    if (isnan(meets[best])) best = !best;
    if (isnan(meets[best])) return -1;
    *at = meets[best];
    return best;
}

/* Volume between a triangle and the plane z = 0 of the layout, in voxels: the sum over a closed surface is what is
 * within. */
static double beneath(const int32_t voxel[3], const double *a, const double *b, const double *c)
{
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    return area / 2 * (voxel[2] + (a[2] + b[2] + c[2]) / 3);
}

/* Volume between the triangles of a crossing, which meet its edge at `at`, and the surface, in voxels. The edges of an
 * axis measure all of it, those of the three axes in the shares of the squares of the normal. */
static double between(const contour_crossing *crossing, int axis, int outwards, double at)
{
    const double n = (double)crossing->normal[axis], far = (double)crossing->t - at;
    return n * n * (outwards ? far : -far);
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

/* Whether the quadrilateral of an edge is turned over, whichever diagonal cuts it. */
static int is_folded(const contour *work, const contour_block *near, const int at[3], int axis)
{
    corner q[4];
    double normal[3];
    const contour_crossing *crossing = swarf_contour_crossing(work, near, at, axis);
    if (!crossing || !find_corners(work, near, at, axis, q)) return 0;
    const int32_t voxel[3] = {near->ijk[0] + at[0], near->ijk[1] + at[1], near->ijk[2] + at[2]};
    measure_corners(work, voxel, q);
    const double along = crossing->normal[axis] < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) normal[k] = along * (double)crossing->normal[k];
    return least_facing(q, 0, normal) <= 0 && least_facing(q, 1, normal) <= 0;
}

swarf_status swarf_contour_unfold(contour *work, contour_block *block)
{
    for (int x = 0; x < 8; x++)
        for (uint64_t word = block->beside_mask[x]; word; word &= word - 1) {
            const int bit = __builtin_ctzll(word);
            int folded = 0;
            for (int edge = 0; edge < 12 && !folded; edge++) {
                const int *offset = swarf_contour_edge_offset[edge];
                const int at[3] = {x + offset[0], (bit >> 3) + offset[1], (bit & 7) + offset[2]};
                folded = is_folded(work, block, at, edge / 4);
            }
            if (folded) block->own_mask[x] |= word & -word;
            block->changed |= folded;
        }
    return SWARF_OK;
}

/* A crossing on its way to facets. */
typedef struct joint {
    const contour_crossing *crossing;
    int32_t voxel[3];
    int at[3]; /* the same from the corner of the block */
    int axis, outwards;
    float error;
    corner q[4];
} joint;

/* A facet of a block, the numbers of its corners and their places; its share of the volume. */
static void add_facet(contour_block *block, const joint *j, const uint32_t v[3], const double *const at[3])
{
    put_facet(&block->facets[block->facet_count++], j->crossing, j->outwards, j->error, v[0], v[1], v[2]);
    block->within += (j->outwards ? 1 : -1) * beneath(j->voxel, at[0], at[1], at[2]);
}

/* The facet of three corners of the quadrilateral. */
static void add_three(contour_block *block, const joint *j, int a, int b, int c)
{
    const corner *q = j->q;
    add_facet(block, j, (uint32_t[3]){q[a].number, q[b].number, q[c].number},
              (const double *[3]){q[a].at, q[b].at, q[c].at});
}

/* Four facets round the crossing. */
static void add_four(const contour *work, contour_block *block, const joint *j)
{
    const double t = fmin(fmax((double)j->crossing->t, SWARF_CONTOUR_LAST_MARGIN), 1 - SWARF_CONTOUR_LAST_MARGIN);
    const uint32_t number = SWARF_CENTRE | block->centre_count;
    contour_vertex *centre = &block->centres[block->centre_count++];
    double middle[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = k == j->axis ? t : 0;
        centre->xyz[k] = (float)(work->layout->origin[k] + (j->voxel[k] + middle[k]) * work->layout->voxel);
    }
    for (int k = 0; k < 4; k++) {
        const corner *a = &j->q[k], *b = &j->q[(k + 1) % 4];
        add_facet(block, j, (uint32_t[3]){a->number, b->number, number}, (const double *[3]){a->at, b->at, middle});
    }
}

/* The facets of a crossing whose corners are there. */
static void join_crossing(const contour *work, contour_block *block, joint *j)
{
    block->full_count += 2;
    for (int k = 0; k < 4; k++)
        if (j->q[k].tiled) j->error = (float)(SWARF_TILE_ERROR * work->error_mm);
    const int same = find_same(j->q);
    if (same == TWO_SAME) return;
    measure_corners(work, j->voxel, j->q);
    if (same != NONE_SAME) {
        add_three(block, j, (same + 1) % 4, (same + 2) % 4, (same + 3) % 4);
        return;
    }
    double at;
    const int d = choose_diagonal(j->q, j->axis, j->outwards, j->crossing, &at);
    if (d < 0) {
        block->full_count += 2;
        add_four(work, block, j);
        return;
    }
    add_three(block, j, d, d + 1, d + 2);
    add_three(block, j, d, d + 2, (d + 3) % 4);
    const double lost = between(j->crossing, j->axis, j->outwards, at), voxel = work->layout->voxel;
    for (uint32_t f = block->facet_count - 2; f < block->facet_count; f++)
        block->facets[f].lost_mm3 = (float)(lost / 2 * voxel * voxel * voxel);
    block->within += lost;
}

/* At the border of the level set there are no cells that corners could lie in. */
static swarf_status cut_off(void)
{
    return swarf_fail(SWARF_ERROR_GEOMETRY, "mesh: the surface is not closed: the level set is cut off at its border "
                                            "or is no distance field");
}

swarf_status swarf_contour_join(contour *work, contour_block *block)
{
    free(block->facets);
    free(block->centres);
    block->facets = NULL;
    block->centres = NULL;
    block->facet_count = block->full_count = block->centre_count = 0;
    block->within = 0;
    if (block->crossing_count == 0) return SWARF_OK;
    block->facets = malloc(4 * (size_t)block->crossing_count * sizeof *block->facets);
    block->centres = malloc(block->crossing_count * sizeof *block->centres);
    if (!block->facets || !block->centres) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for facets");
    joint j = {.crossing = block->crossings};
    for (j.axis = 0; j.axis < 3; j.axis++)
        for (int x = 0; x < 8; x++)
            for (uint64_t word = block->edge_mask[j.axis][x]; word; word &= word - 1, j.crossing++) {
                const int bit = __builtin_ctzll(word), at[3] = {x, bit >> 3, bit & 7};
                memcpy(j.at, at, sizeof at);
                for (int k = 0; k < 3; k++) j.voxel[k] = block->ijk[k] + at[k];
                j.outwards = block->inside[x][at[1]] >> at[2] & 1;
                j.error = 0;
                if (!find_corners(work, block, j.at, j.axis, j.q)) return cut_off();
                join_crossing(work, block, &j);
            }
    swarf_facet *fitting = realloc(block->facets, (block->facet_count ? block->facet_count : 1) * sizeof *fitting);
    if (fitting) block->facets = fitting;
    return SWARF_OK;
}
