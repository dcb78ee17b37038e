/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "solid/nearby.h"

#include "solid/boxes.h"

#include <math.h>
#include <string.h>

/* Share of its longest edge that points in a box may be farther away than the first. */
static const double more_reach = 0.25;

/* A box of points is no longer than this many times the group of triangles they are near: then few groups are near it.
 * For fewer points than these it is not worth it. */
static const double box_edges = 3;
enum { FEW_POINTS = 4 };

void swarf_nearby_begin(const swarf_box_tree *tree, const swarf_corners *corners, swarf_nearby *out)
{
    out->tree = tree;
    out->corners = corners;
    out->place = SIZE_MAX;
    out->reach = 0;
    out->count = 0;
}

void swarf_nearby_enter(swarf_nearby *nearby, const double lo[3], const double hi[3])
{
    memcpy(nearby->lo, lo, sizeof nearby->lo);
    memcpy(nearby->hi, hi, sizeof nearby->hi);
    nearby->reach = nearby->tree->levels > 1 ? -1 : 0; /* of a single group there is nothing to keep */
}

/* Longest edge of the box of a group of triangles. */
static double group_edge(const swarf_group *group)
{
    double most = 0;
    for (int k = 0; k < 3; k++) {
        float lo = group->lo[k][0], hi = group->hi[k][0];
        for (int i = 1; i < TREE_WIDTH; i++) {
            lo = group->lo[k][i] < lo ? group->lo[k][i] : lo;
            hi = group->hi[k][i] > hi ? group->hi[k][i] : hi;
        }
        most = (double)hi - lo > most ? (double)hi - lo : most;
    }
    return most;
}

size_t swarf_nearby_enter_points(swarf_nearby *nearby, const double (*point)[3], size_t count)
{
    double lo[3], hi[3];
    nearby->reach = 0;
    if (nearby->place == SIZE_MAX) return 1;
    const double most = box_edges * group_edge(&nearby->tree->groups[nearby->place / TREE_WIDTH]);
    for (int k = 0; k < 3; k++) lo[k] = hi[k] = point[0][k];
    size_t used = 1;
    for (; used < count; used++) {
        const double *next = point[used];
        int near = 1;
        for (int k = 0; k < 3; k++) near &= fabs(next[k] - lo[k]) <= most && fabs(next[k] - hi[k]) <= most;
        if (!near) break;
        for (int k = 0; k < 3; k++) {
            lo[k] = next[k] < lo[k] ? next[k] : lo[k];
            hi[k] = next[k] > hi[k] ? next[k] : hi[k];
        }
    }
    if (used >= FEW_POINTS) swarf_nearby_enter(nearby, lo, hi);
    return used;
}

static int add_group(void *context, size_t number)
{
    swarf_nearby *n = context;
    const swarf_group *above = &n->tree->groups[n->tree->first[1] + number / TREE_WIDTH];
    if (n->count == NEARBY_GROUPS) {
        n->reach = 0; /* too many */
        return 0;
    }
    swarf_group *boxes = &n->boxes[n->count / TREE_WIDTH];
    for (int k = 0; k < 3; k++) {
        boxes->lo[k][n->count % TREE_WIDTH] = above->lo[k][number % TREE_WIDTH];
        boxes->hi[k][n->count % TREE_WIDTH] = above->hi[k][number % TREE_WIDTH];
    }
    n->group[n->count++] = (uint32_t)number;
    return 1;
}

/* Keep what is near the box; its first point is so far away. */
static void gather(swarf_nearby *n, double away)
{
    double edge = 0;
    for (int k = 0; k < 3; k++) edge = n->hi[k] - n->lo[k] > edge ? n->hi[k] - n->lo[k] : edge;
    n->reach = away + more_reach * edge;
    n->count = 0;
    swarf_box_tree_near(n->tree, n->lo, n->hi, n->reach, 1, add_group, n);
    for (size_t i = n->count; i % TREE_WIDTH != 0; i++)
        for (int k = 0; k < 3; k++) { /* missing boxes are infinitely far away */
            n->boxes[i / TREE_WIDTH].lo[k][i % TREE_WIDTH] = INFINITY;
            n->boxes[i / TREE_WIDTH].hi[k][i % TREE_WIDTH] = -INFINITY;
        }
}

static void look_through(const swarf_nearby *n, const double point[3], swarf_nearest *nearest)
{
    swarf_aim aim = swarf_aim_at(n->tree, point, nearest->square);
    for (size_t first = 0; first < n->count; first += TREE_WIDTH) {
        float square[TREE_WIDTH];
        unsigned near = swarf_group_squares(&n->boxes[first / TREE_WIDTH], &aim, square);
        for (; near; near &= near - 1) {
            const int i = __builtin_ctz(near);
            if (square[i] > aim.limit) continue;
            swarf_group_look(n->tree, n->corners, n->group[first + (size_t)i], &aim, nearest);
        }
    }
}

void swarf_nearby_find(swarf_nearby *n, const double point[3], swarf_nearest *out)
{
    swarf_nearest nearest = {.square = INFINITY, .place = n->place};
    if (n->place != SIZE_MAX) /* nothing farther away than the last one is worth a look */
        nearest.square = swarf_corners_closest(&n->corners[n->place], point, nearest.point, &nearest.feature);
    if (n->reach > 0 && nearest.square < n->reach * n->reach)
        look_through(n, point, &nearest);
    else
        swarf_box_tree_nearest(n->tree, n->corners, point, &nearest);
    n->place = nearest.place;
    if (n->reach < 0) gather(n, sqrt(nearest.square));
    *out = nearest;
}
