/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Edges of a part of which every face is a smooth function, and how far vertices of a mesh are from them. */
#ifndef SWARF_TEST_FACES_H
#define SWARF_TEST_FACES_H

/** A part: all that is below (negative in) all of its faces, or however else its own value says. */
typedef struct faces {
    /** Of face 0 .. count - 1, in mm, a distance near the face; of the whole part where `face` is -1. */
    double (*value)(const void *of, int face, const double p[3]);
    const void *of;
    int count;
    int apart; /* edges between two of the first so many faces are left out */
    double voxel;
    double bend;      /* in voxels: edges that are farther from straight than this within half a cell are left out */
    double origin[3]; /* any corner of the cells that have a vertex each: the centre of a voxel */
} faces;

/** Gradient of a face, or (-1) of the whole part; whether it is one of a distance, as it is not where faces meet. */
int faces_gradient(const faces *s, int face, const double p[3], double out[3]);

/** An edge that passes a cell, and how far a vertex in it is from that, in voxels. */
typedef struct faces_edge {
    int face[2]; /* the first is the greater number */
    double away;
} faces_edge;
enum { FACES_MOST_EDGES = 32 };

/** The edges that pass the cell of a vertex for half a voxel at least; how many. */
int faces_edges(const faces *s, const double p[3], faces_edge out[FACES_MOST_EDGES]);

/** Of a vertex whose cell an edge passes for half a voxel at least the distance to that edge, in voxels; negative for
 *  others. corner: whether another face is within three voxels. */
double faces_edge_distance(const faces *s, const double p[3], int *corner);

#endif
