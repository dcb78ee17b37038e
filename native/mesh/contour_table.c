/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* How the crossings of a cell are joined into cycles, for all 256 signs of its corners.
 *
 * On a face with two crossings there is one way. On a face with four, two pairs of opposite corners, the material is
 * joined across the face (each outside corner is cut off on its own), from both sides of the face alike. The dual of
 * the polygons is then a closed surface, save for one flaw: where one cycle passes a face twice in both cells beside
 * it, the two edges of the dual that cross the face are one, used by four facets. With this rule a cycle can pass a
 * face twice only when the cell has two opposite corners of that face in the material and at most one corner more, so
 * at most once per cell; the flaw is seen from the two cells alone and goes away by joining that face the other way in
 * both, which splits each cycle. (The same two cases are known from Nielson's dual marching cubes.)
 */
#include "mesh/contour.h"

#include <string.h>

const int swarf_contour_edge_offset[12][3] = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1}, {0, 0, 0}, {1, 0, 0},
                                              {0, 0, 1}, {1, 0, 1}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};

/* Corner number of offsets along three axes, the first being `axis`. */
static int corner_of(int axis, int along, int next, int after)
{
    static const int weight[3] = {4, 2, 1};
    return along * weight[axis] + next * weight[(axis + 1) % 3] + after * weight[(axis + 2) % 3];
}

/* Edges and corners of a face, going round; edge k joins corners k and k + 1. */
static void go_round(int face, int edge[4], int corner[4])
{
    const int axis = face / 2, side = face % 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
    corner[0] = corner_of(axis, side, 0, 0);
    corner[1] = corner_of(axis, side, 1, 0);
    corner[2] = corner_of(axis, side, 1, 1);
    corner[3] = corner_of(axis, side, 0, 1);
    /* along b at c = 0, along c at b = 1, along b at c = 1, along c at b = 0; of an edge along b the next axis is c */
    edge[0] = b * 4 + 0 * 2 + side;
    edge[1] = c * 4 + side * 2 + 1;
    edge[2] = b * 4 + 1 * 2 + side;
    edge[3] = c * 4 + side * 2 + 0;
}

static int root_of(const uint8_t parent[12], int edge)
{
    while (parent[edge] != edge) edge = parent[edge];
    return edge;
}

static void join(uint8_t parent[12], int a, int b)
{
    a = root_of(parent, a);
    b = root_of(parent, b);
    if (a < b)
        parent[b] = (uint8_t)a;
    else
        parent[a] = (uint8_t)b;
}

static void fill_case(int config, int flipped_face, contour_case *out)
{
    uint8_t parent[12];
    for (int e = 0; e < 12; e++) parent[e] = (uint8_t)e;
    unsigned crossed = 0;
    int double_face[6], double_faces = 0;
    for (int face = 0; face < 6; face++) {
        int edge[4], corner[4], on[4], count = 0;
        go_round(face, edge, corner);
        for (int k = 0; k < 4; k++)
            if ((config >> corner[k] & 1) != (config >> corner[(k + 1) % 4] & 1)) {
                on[count++] = edge[k];
                crossed |= 1u << edge[k];
            }
        if (count == 2) join(parent, on[0], on[1]);
        if (count != 4) continue;
        double_face[double_faces++] = face;
        const int cut_off = face == flipped_face; /* the sign of the corners that are cut off */
        for (int k = 0; k < 4; k++)
            if ((config >> corner[k] & 1) == cut_off) join(parent, edge[(k + 3) % 4], edge[k]);
    }
    memset(out, 0, sizeof *out);
    for (int e = 0; e < 12; e++) {
        if (!(crossed >> e & 1)) continue;
        const int root = root_of(parent, e); /* the least edge of its cycle: seen first */
        out->of_edge[e] = root == e ? out->count++ : out->of_edge[root];
        out->edges[out->of_edge[e]] |= (uint16_t)(1u << e);
    }
    out->twice_on_face = SWARF_NO_FACE;
    for (int i = 0; i < double_faces; i++) {
        int edge[4], corner[4];
        go_round(double_face[i], edge, corner);
        if (out->of_edge[edge[0]] == out->of_edge[edge[1]] && out->of_edge[edge[1]] == out->of_edge[edge[2]] &&
            out->of_edge[edge[2]] == out->of_edge[edge[3]])
            out->twice_on_face = (uint8_t)double_face[i];
    }
}

void swarf_contour_table_fill(contour_table *table)
{
    for (int config = 0; config < 256; config++) {
        fill_case(config, SWARF_NO_FACE, &table->entry[config][0]);
        fill_case(config, table->entry[config][0].twice_on_face, &table->entry[config][1]);
    }
}
