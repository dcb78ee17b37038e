/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Walks over a tree: what is closest, what is near, how often it goes round. Boxes are tested eight at a time in float,
 * triangles in double. */
#include "base/vector.h"
#include "solid/angle.h"
#include "solid/boxes.h"

#include <math.h>

/* A group to be looked at, and from how far away it may hold something. */
struct visit {
    float square;
    unsigned level;
    size_t group;
};

/* Of every level but the lowest seven groups can be waiting while the eighth is looked into. */
enum { MOST_VISITS = TREE_LEVELS * TREE_WIDTH + 1 };

/* Closest point of a segment from `a` along `ab`; *t is where, 0 .. 1. */
static double closest_on_edge(const double a[3], const double ab[3], const double point[3], double closest[3],
                              double *t)
{
    const double ap[3] = {point[0] - a[0], point[1] - a[1], point[2] - a[2]}, length = vector_dot(ab, ab);
    const double along = length > 0 ? vector_dot(ap, ab) / length : 0;
    *t = along < 0 ? 0 : along > 1 ? 1 : along;
    double square = 0;
    for (int k = 0; k < 3; k++) {
        closest[k] = a[k] + *t * ab[k];
        square += (point[k] - closest[k]) * (point[k] - closest[k]);
    }
    return square;
}

/* The regions of C. Ericson, "Real-time collision detection" (2005), 5.1.5: one of corner, edge or face. */
double swarf_corners_closest(const swarf_corners *triangle, const double point[3], double closest[3], int *feature)
{
    double corner[3][3], ab[3], ac[3], ap[3], normal[3];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) corner[i][k] = triangle->xyz[i][k];
        ab[k] = corner[1][k] - corner[0][k];
        ac[k] = corner[2][k] - corner[0][k];
        ap[k] = point[k] - corner[0][k];
    }
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        normal[k] = ab[l] * ac[m] - ab[m] * ac[l];
    }
    const double area = vector_dot(normal, normal);
    /* barycentric: the share of corner 1 and 2 of the foot on the plane, times the square of twice the area */
    const double one = vector_dot(normal, (double[3]){ap[1] * ac[2] - ap[2] * ac[1], ap[2] * ac[0] - ap[0] * ac[2],
                                                      ap[0] * ac[1] - ap[1] * ac[0]});
    const double two = vector_dot(normal, (double[3]){ab[1] * ap[2] - ab[2] * ap[1], ab[2] * ap[0] - ab[0] * ap[2],
                                                      ab[0] * ap[1] - ab[1] * ap[0]});
    if (area > 0 && one >= 0 && two >= 0 && one + two <= area) {
        const double away = vector_dot(ap, normal);
        for (int k = 0; k < 3; k++) closest[k] = point[k] - normal[k] * (away / area);
        *feature = 0;
        return away * away / area;
    }
    /* then it is closest to an edge that has the foot on its far side */
    const int beyond[3] = {!(two >= 0), !(one + two <= area), !(one >= 0)};
    double best = INFINITY;
    for (int edge = 0; edge < 3; edge++) {
        if (area > 0 && !beyond[edge]) continue;
        const double *a = corner[edge], *b = corner[(edge + 1) % 3];
        const double along[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        double here[3], t;
        const double square = closest_on_edge(a, along, point, here, &t);
        if (!(square < best)) continue;
        best = square;
        for (int k = 0; k < 3; k++) closest[k] = here[k];
        *feature = t <= 0 ? 1 + edge : t >= 1 ? 1 + (edge + 1) % 3 : 4 + edge;
    }
    return best;
}

void swarf_box_tree_nearest(const swarf_box_tree *tree, const swarf_corners *corners, const double point[3],
                            swarf_nearest *nearest)
{
    swarf_aim aim = swarf_aim_at(tree, point, nearest->square);
    struct visit stack[MOST_VISITS];
    int depth = 1;
    stack[0] = (struct visit){0, tree->levels - 1, 0};
    while (depth > 0) {
        const struct visit now = stack[--depth];
        if (now.square > aim.limit) continue;
        if (now.square >= aim.doubtful && now.level + 1 < tree->levels) {
            const swarf_group *above = &tree->groups[tree->first[now.level + 1] + now.group / TREE_WIDTH];
            if (swarf_group_is_no_closer(above, (int)(now.group % TREE_WIDTH), &aim, nearest)) continue;
        }
        if (now.level == 0) {
            swarf_group_look(tree, corners, now.group, &aim, nearest);
            continue;
        }
        float square[TREE_WIDTH];
        unsigned near = swarf_group_squares(&tree->groups[tree->first[now.level] + now.group], &aim, square);
        const size_t boxes = tree->first[now.level] - tree->first[now.level - 1] - now.group * TREE_WIDTH;
        if (boxes < TREE_WIDTH) near &= (1u << boxes) - 1;
        /* the nearest last, to be looked into first */
        const int base = depth;
        for (; near; near &= near - 1) {
            const int i = __builtin_ctz(near);
            int k = depth++;
            for (; k > base && stack[k - 1].square < square[i]; k--) stack[k] = stack[k - 1];
            stack[k] = (struct visit){square[i], now.level - 1, now.group * TREE_WIDTH + (size_t)i};
        }
    }
}

void swarf_box_tree_near(const swarf_box_tree *tree, const double lo[3], const double hi[3], double reach,
                         unsigned level, swarf_box_fn see, void *context)
{
    float low[3], high[3];
    for (int k = 0; k < 3; k++) {
        const double slack = tree->slack + TREE_SLACK * fmax(fabs(lo[k]), fabs(hi[k]));
        low[k] = (float)(lo[k] - reach - slack);
        high[k] = (float)(hi[k] + reach + slack);
    }
    struct visit stack[MOST_VISITS];
    int depth = 1;
    stack[0] = (struct visit){0, tree->levels - 1, 0};
    while (depth > 0) {
        const struct visit now = stack[--depth];
        const swarf_group *group = &tree->groups[tree->first[now.level] + now.group];
        int meets[TREE_WIDTH];
        for (int i = 0; i < TREE_WIDTH; i++)
            meets[i] = (group->lo[0][i] <= high[0]) & (group->hi[0][i] >= low[0]) & (group->lo[1][i] <= high[1]) &
                       (group->hi[1][i] >= low[1]) & (group->lo[2][i] <= high[2]) & (group->hi[2][i] >= low[2]);
        for (size_t i = 0; i < TREE_WIDTH; i++) {
            const size_t number = now.group * TREE_WIDTH + i;
            if (!meets[i]) continue; /* nor does a box that is missing */
            if (now.level > level)
                stack[depth++] = (struct visit){0, now.level - 1, number};
            else if (!see(context, number))
                return;
        }
    }
}

/* From this many radii away a group counts by its sum: off by a few hundredths of the little it sees from there, where
 * what is asked is on which side of one half a whole number lies. */
static const double far_away = 3;

double swarf_box_tree_winding(const swarf_box_tree *tree, const swarf_corners *corners, const double point[3])
{
    struct visit stack[MOST_VISITS];
    int depth = 1;
    double angle = 0;
    stack[0] = (struct visit){0, tree->levels - 1, 0};
    while (depth > 0) {
        const struct visit now = stack[--depth];
        const swarf_group_sum *sum = &tree->sums[tree->first[now.level] + now.group];
        const double to[3] = {sum->middle[0] - point[0], sum->middle[1] - point[1], sum->middle[2] - point[2]};
        const double square = vector_dot(to, to);
        if (square > far_away * far_away * sum->radius * sum->radius) {
            angle += vector_dot(sum->vector, to) / (square * sqrt(square));
            continue;
        }
        const size_t below = now.level ? tree->first[now.level] - tree->first[now.level - 1] : tree->count;
        for (size_t i = 0; i < TREE_WIDTH && now.group * TREE_WIDTH + i < below; i++) {
            const size_t number = now.group * TREE_WIDTH + i;
            if (now.level > 0) {
                stack[depth++] = (struct visit){0, now.level - 1, number};
                continue;
            }
            double p[3][3];
            for (int j = 0; j < 9; j++) p[j / 3][j % 3] = corners[number].xyz[j / 3][j % 3] - point[j % 3];
            angle += swarf_solid_angle(p);
        }
    }
    return angle / (4 * 3.14159265358979323846);
}
