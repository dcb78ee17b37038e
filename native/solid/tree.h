/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Tree: a packed tree of boxes over triangles, eight to a group.
 *
 *   place   a triangle's number in the order of the tree; group g of level 0 has the boxes of places 8 g .. 8 g + 7,
 *           group g of level l + 1 those of groups 8 g .. 8 g + 7 of level l. All groups but the last of a level are
 *           full, so that there are no pointers; missing boxes are empty and infinitely far away.
 *   sums    per group, for the winding number: area vector, middle and radius of its triangles.
 *
 * Triangles are sorted into groups by halving along the longest side of their centres' box, so that triangles near each
 * other are near in memory too. Read by many threads.
 */
#ifndef SWARF_SOLID_TREE_H
#define SWARF_SOLID_TREE_H

#include "swarf/base.h"

enum { TREE_WIDTH = 8, TREE_LEVELS = 11 }; /* 8^11 places: more than 32-bit numbers name */

/** What float arithmetic on coordinates may be off by, as a share of them: eight units in the last place. */
#define TREE_SLACK 0x1p-21

typedef struct swarf_group {
    float lo[3][TREE_WIDTH], hi[3][TREE_WIDTH];
} swarf_group;

/** Sum over the triangles of a group. */
typedef struct swarf_group_sum {
    double vector[3]; /**< sum of their areas times their normals, mm2 */
    double middle[3]; /**< their centres weighted by area */
    double area;
    double radius; /**< from the middle to their farthest vertex */
} swarf_group_sum;

/** A triangle as the tree keeps it. */
typedef struct swarf_corners {
    float xyz[3][3];
} swarf_corners;

typedef struct swarf_box_tree {
    size_t count; /**< of triangles */
    unsigned levels;
    size_t first[TREE_LEVELS + 1]; /**< number of the first group of each level */
    swarf_group *groups;
    swarf_group_sum *sums;
    double slack; /**< mm by which float arithmetic may be wrong about a box, for points as far out as the boxes */
} swarf_box_tree;

/** Sort `corners` (and `source` beside it) into the tree's order and build over them. */
swarf_status swarf_box_tree_build(swarf_corners *corners, uint32_t *source, size_t count,
                                  const swarf_progress *progress, double from, double to, swarf_box_tree *out);
void swarf_box_tree_free(swarf_box_tree *tree);

/** Where the triangles come closest to a point. */
typedef struct swarf_nearest {
    double square; /**< of the distance */
    double point[3];
    size_t place; /**< SIZE_MAX: none as near as that */
    int feature;  /**< 0 face, 1 .. 3 corner 0 .. 2, 4 .. 6 edge from corner 0 .. 2 to the next */
} swarf_nearest;

/** The closest triangle (the first found of equally close ones), if it is closer than *nearest is before: a triangle
 *  already known, or place SIZE_MAX and the square of how far to look. */
void swarf_box_tree_nearest(const swarf_box_tree *tree, const swarf_corners *corners, const double point[3],
                            swarf_nearest *nearest);

/** Closest point of one triangle, its feature, and the square of its distance. */
double swarf_corners_closest(const swarf_corners *triangle, const double point[3], double closest[3], int *feature);

/** Call `see` with the number of every box of a level of the tree (0: the place of a triangle, 1: a group of level 0,
 *  ...) that comes within `reach` of the box lo .. hi, until it returns 0. */
typedef int (*swarf_box_fn)(void *context, size_t number);
void swarf_box_tree_near(const swarf_box_tree *tree, const double lo[3], const double hi[3], double reach,
                         unsigned level, swarf_box_fn see, void *context);

/** Winding number of the triangles about a point: far groups count by their sums (the first term of G. Barill et al.,
 *  "Fast winding numbers for soups and clouds", 2018), near ones exactly. */
double swarf_box_tree_winding(const swarf_box_tree *tree, const swarf_corners *corners, const double point[3]);

#endif
