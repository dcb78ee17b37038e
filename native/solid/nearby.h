/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Many looks for what is closest, near each other, by one thread: the groups of triangles near a box are kept, which
 * spares the points in it most of the way down the tree. */
#ifndef SWARF_SOLID_NEARBY_H
#define SWARF_SOLID_NEARBY_H

#include "solid/tree.h"

/** Groups that are kept, at most: to go through more of them takes as long as the tree does. */
enum { NEARBY_GROUPS = 64 };

typedef struct swarf_nearby {
    const swarf_box_tree *tree;
    const swarf_corners *corners;
    size_t place;        /**< of the triangle closest to the last point, SIZE_MAX: there was none */
    double lo[3], hi[3]; /**< of the box */
    double reach; /**< mm: what is closer than this to a point in the box is in one of the groups; below 0: not yet */
    size_t count;
    swarf_group boxes[NEARBY_GROUPS / TREE_WIDTH]; /**< of the groups */
    uint32_t group[NEARBY_GROUPS];                 /**< of level 0 */
} swarf_nearby;

/** The tree has triangles. */
void swarf_nearby_begin(const swarf_box_tree *tree, const swarf_corners *corners, swarf_nearby *out);

/** The points that follow lie in a box, up to the next one. */
void swarf_nearby_enter(swarf_nearby *nearby, const double lo[3], const double hi[3]);
/** Enter a box of points, as many of those that follow as are near the first; returns how many, at least one. */
size_t swarf_nearby_enter_points(swarf_nearby *nearby, const double (*point)[3], size_t count);

/** The closest triangle, wherever it is. Where several are as close it depends on the points before which it tells of.
 */
void swarf_nearby_find(swarf_nearby *nearby, const double point[3], swarf_nearest *out);

#endif
