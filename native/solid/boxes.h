/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* How far the boxes of a group are from a point: eight at a time in float, with room for rounding, or one in double. */
#ifndef SWARF_SOLID_BOXES_H
#define SWARF_SOLID_BOXES_H

#include "solid/tree.h"

#include <math.h>
#include <string.h>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

/** Four numbers in one register of any processor; wider ones would need variants of their own and win little here. */
typedef float swarf_four __attribute__((vector_size(16)));
typedef int32_t swarf_four_bits __attribute__((vector_size(16)));

/** Bit i is set where number i of the comparison holds. */
static inline unsigned swarf_four_mask(swarf_four_bits holds)
{
#if defined(__SSE2__) /* the compiler takes the numbers out one by one */
    return (unsigned)_mm_movemask_ps((__m128)holds);
#else
    unsigned bits = 0;
    for (int i = 0; i < 4; i++) bits |= ((unsigned)holds[i] & 1) << i;
    return bits;
#endif
}

/** The larger of each two. */
static inline swarf_four swarf_four_larger(swarf_four a, swarf_four b)
{
#if defined(__SSE2__)
    return (swarf_four)_mm_max_ps((__m128)a, (__m128)b);
#else
    const swarf_four_bits first = a > b;
    return (swarf_four)((first & (swarf_four_bits)a) | (~first & (swarf_four_bits)b));
#endif
}

/** A point, and from how far away a box may hold something closer to it than what is known. */
typedef struct swarf_aim {
    const double *point;
    float at[3];
    double slack;   /**< by which float arithmetic may be wrong about a box */
    float limit;    /**< no box that shows more than this square holds anything closer */
    float doubtful; /**< one that shows this or more may be no closer after all */
} swarf_aim;

/** What is known is now `square` away. */
static inline void swarf_aim_narrow(swarf_aim *aim, double square)
{
    const double away = sqrt(square), most = away + aim->slack, least = away - aim->slack;
    aim->limit = (float)(most * most * (1 + 1e-6));
    aim->doubtful = least > 0 ? (float)(least * least * (1 - 1e-6)) : 0;
}

static inline swarf_aim swarf_aim_at(const swarf_box_tree *tree, const double point[3], double square)
{
    swarf_aim aim = {.point = point, .slack = tree->slack};
    for (int k = 0; k < 3; k++) {
        aim.at[k] = (float)point[k];
        const double own = fabs(point[k]) * TREE_SLACK;
        aim.slack = own > aim.slack ? own : aim.slack;
    }
    swarf_aim_narrow(&aim, square);
    return aim;
}

/** Squares of the distances to eight boxes; bit i of the result is set where that of box i is within the limit: missing
 *  boxes are so too while nothing is known. */
static inline unsigned swarf_group_squares(const swarf_group *group, const swarf_aim *aim, float square[TREE_WIDTH])
{
    unsigned near = 0;
    for (int first = 0; first < TREE_WIDTH; first += 4) {
        swarf_four sum = {0, 0, 0, 0};
        for (int k = 0; k < 3; k++) {
            swarf_four lo, hi;
            memcpy(&lo, group->lo[k] + first, sizeof lo);
            memcpy(&hi, group->hi[k] + first, sizeof hi);
            const swarf_four outside = swarf_four_larger(lo - aim->at[k], aim->at[k] - hi);
            const swarf_four away = swarf_four_larger(outside, (swarf_four){0, 0, 0, 0});
            sum += away * away;
        }
        memcpy(square + first, &sum, sizeof sum);
        near |= swarf_four_mask(sum <= aim->limit) << first;
    }
    return near;
}

/** Whether box i is no closer than what is nearest so far; corners are floats, so that boxes are exact. Of triangles in
 *  one plane along the axes, whose boxes overlap as those of slivers do, only the first is measured for it. */
static inline int swarf_group_is_no_closer(const swarf_group *group, int i, const swarf_aim *aim,
                                           const swarf_nearest *nearest)
{
    const double rounding = 1e-12; /* squares that differ by less than this share are the same but for rounding */
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double below = group->lo[k][i] - aim->point[k], above = aim->point[k] - group->hi[k][i];
        const double away = below > above ? below : above;
        sum += away > 0 ? away * away : 0;
    }
    return sum >= nearest->square * (1 - rounding);
}

/** Look at the triangles of group `number` of level 0 that may be closer than *nearest. */
static inline void swarf_group_look(const swarf_box_tree *tree, const swarf_corners *corners, size_t number,
                                    swarf_aim *aim, swarf_nearest *nearest)
{
    float square[TREE_WIDTH];
    const swarf_group *group = &tree->groups[number];
    unsigned near = swarf_group_squares(group, aim, square);
    const size_t boxes = tree->count - number * TREE_WIDTH;
    if (boxes < TREE_WIDTH) near &= (1u << boxes) - 1;
    for (; near; near &= near - 1) {
        const int i = __builtin_ctz(near);
        if (square[i] > aim->limit) continue;
        if (square[i] >= aim->doubtful && swarf_group_is_no_closer(group, i, aim, nearest)) continue;
        swarf_nearest here = {.place = number * TREE_WIDTH + (size_t)i};
        if (here.place == nearest->place) continue; /* where the search began */
        here.square = swarf_corners_closest(&corners[here.place], aim->point, here.point, &here.feature);
        if (!(here.square < nearest->square)) continue;
        *nearest = here;
        swarf_aim_narrow(aim, here.square);
    }
}

#endif
