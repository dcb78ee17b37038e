/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "solid/tree.h"

#include "base/parallel.h"
#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A triangle while they are sorted. */
typedef struct item {
    float centre[3];
    uint32_t number;
} item;

struct builder {
    const swarf_corners *corners;
    item *items;
    size_t count;
    size_t stride, part; /* places of a range being divided, and of each of its parts */
    swarf_box_tree *tree;
    unsigned level;
};

static int longest_side(const item *items, size_t count)
{
    float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            const float x = items[i].centre[k];
            lo[k] = x < lo[k] ? x : lo[k];
            hi[k] = x > hi[k] ? x : hi[k];
        }
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
    return axis;
}

static int less(const item *a, const item *b, int axis)
{
    if (a->centre[axis] != b->centre[axis]) return a->centre[axis] < b->centre[axis];
    return a->number < b->number; /* equal centres: the order must not depend on chance */
}

/* Put the `first` least items along an axis first (C. A. R. Hoare, "Algorithm 65: find", 1961). */
static void select_least(item *items, size_t count, size_t first, int axis)
{
    const ptrdiff_t wanted = (ptrdiff_t)first;
    ptrdiff_t lo = 0, hi = (ptrdiff_t)count - 1;
    while (lo < hi) {
        const item pivot = items[lo + (hi - lo) / 2];
        ptrdiff_t i = lo, j = hi;
        while (i <= j) {
            while (less(&items[i], &pivot, axis)) i++;
            while (less(&pivot, &items[j], axis)) j--;
            if (i > j) break;
            const item keep = items[i];
            items[i++] = items[j];
            items[j--] = keep;
        }
        if (wanted <= j)
            hi = j;
        else if (wanted >= i)
            lo = i;
        else
            return;
    }
}

/* Divide a range into parts of `part` places, all but the last full, by halving. */
static void divide(item *items, size_t count, size_t part)
{
    if (count <= part) return;
    const size_t parts = (count + part - 1) / part, left = parts / 2 * part;
    select_least(items, count, left, longest_side(items, count));
    divide(items, left, part);
    divide(items + left, count - left, part);
}

static swarf_status divide_range(void *context, size_t index)
{
    const struct builder *b = context;
    const size_t first = index * b->stride;
    divide(b->items + first, b->count - first < b->stride ? b->count - first : b->stride, b->part);
    return SWARF_OK;
}

static void sum_triangle(const swarf_corners *t, swarf_group_sum *sum)
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)t->xyz[1][k] - t->xyz[0][k];
        v[k] = (double)t->xyz[2][k] - t->xyz[0][k];
        sum->middle[k] = ((double)t->xyz[0][k] + t->xyz[1][k] + t->xyz[2][k]) / 3;
    }
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        sum->vector[k] = 0.5 * (u[l] * v[m] - u[m] * v[l]);
    }
    sum->area =
        sqrt(sum->vector[0] * sum->vector[0] + sum->vector[1] * sum->vector[1] + sum->vector[2] * sum->vector[2]);
    sum->radius = 0;
    for (int i = 0; i < 3; i++)
        sum->radius = fmax(sum->radius, hypot(hypot(t->xyz[i][0] - sum->middle[0], t->xyz[i][1] - sum->middle[1]),
                                              t->xyz[i][2] - sum->middle[2]));
}

static void sum_up(const swarf_group_sum *part, int count, swarf_group_sum *out)
{
    memset(out, 0, sizeof *out);
    for (int i = 0; i < count; i++) {
        out->area += part[i].area;
        for (int k = 0; k < 3; k++) {
            out->vector[k] += part[i].vector[k];
            out->middle[k] += part[i].middle[k] * part[i].area;
        }
    }
    for (int k = 0; k < 3; k++) out->middle[k] = out->area > 0 ? out->middle[k] / out->area : part[0].middle[k];
    for (int i = 0; i < count; i++)
        out->radius =
            fmax(out->radius,
                 part[i].radius + hypot(hypot(part[i].middle[0] - out->middle[0], part[i].middle[1] - out->middle[1]),
                                        part[i].middle[2] - out->middle[2]));
}

static swarf_status fill_group(void *context, size_t index)
{
    const struct builder *b = context;
    swarf_box_tree *tree = b->tree;
    swarf_group *group = &tree->groups[tree->first[b->level] + index];
    swarf_group_sum part[TREE_WIDTH];
    const size_t below = b->level ? tree->first[b->level] - tree->first[b->level - 1] : tree->count;
    int used = 0;
    for (int i = 0; i < TREE_WIDTH; i++) {
        const size_t number = index * TREE_WIDTH + (size_t)i;
        for (int k = 0; k < 3; k++) {
            group->lo[k][i] = INFINITY;
            group->hi[k][i] = -INFINITY;
        }
        if (number >= below) continue;
        if (b->level == 0) {
            const swarf_corners *t = &b->corners[number];
            for (int j = 0; j < 9; j++) {
                const float x = t->xyz[j / 3][j % 3];
                if (x < group->lo[j % 3][i]) group->lo[j % 3][i] = x;
                if (x > group->hi[j % 3][i]) group->hi[j % 3][i] = x;
            }
            sum_triangle(t, &part[used++]);
            continue;
        }
        const size_t child_number = tree->first[b->level - 1] + number;
        const swarf_group *child = &tree->groups[child_number];
        for (int j = 0; j < 3 * TREE_WIDTH; j++) {
            const int k = j / TREE_WIDTH, at = j % TREE_WIDTH;
            if (child->lo[k][at] < group->lo[k][i]) group->lo[k][i] = child->lo[k][at];
            if (child->hi[k][at] > group->hi[k][i]) group->hi[k][i] = child->hi[k][at];
        }
        part[used++] = tree->sums[child_number];
    }
    sum_up(part, used, &tree->sums[tree->first[b->level] + index]);
    return SWARF_OK;
}

static swarf_status sort_items(struct builder *b, const swarf_progress *progress, double from, double to)
{
    size_t stride = TREE_WIDTH;
    unsigned levels = 1;
    while (stride < b->count) {
        stride *= TREE_WIDTH;
        levels++;
    }
    b->tree->levels = levels;
    /* within a group of level 0 the order is of no matter */
    for (unsigned level = 0; level + 1 < levels; level++) {
        const double step = (to - from) / levels;
        b->stride = stride;
        b->part = stride /= TREE_WIDTH;
        SWARF_TRY(swarf_parallel_for((b->count + b->stride - 1) / b->stride, divide_range, b, progress,
                                     from + level * step, from + (level + 1) * step));
    }
    return SWARF_OK;
}

/* Bring corners and sources into the order of the items. */
static swarf_status reorder(const struct builder *b, swarf_corners *corners, uint32_t *source)
{
    swarf_corners *old_corners = malloc(b->count * sizeof *old_corners);
    uint32_t *old_source = malloc(b->count * sizeof *old_source);
    if (old_corners && old_source) {
        memcpy(old_corners, corners, b->count * sizeof *corners);
        memcpy(old_source, source, b->count * sizeof *source);
        for (size_t i = 0; i < b->count; i++) {
            corners[i] = old_corners[b->items[i].number];
            source[i] = old_source[b->items[i].number];
        }
    }
    const int ok = old_corners && old_source;
    free(old_corners);
    free(old_source);
    return ok ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory for %zu triangles", b->count);
}

static swarf_status build_groups(struct builder *b, const swarf_progress *progress, double from, double to)
{
    swarf_box_tree *tree = b->tree;
    size_t groups = 0, below = b->count;
    for (unsigned level = 0; level < tree->levels; level++) {
        below = (below + TREE_WIDTH - 1) / TREE_WIDTH;
        tree->first[level] = groups;
        groups += below;
    }
    for (unsigned level = tree->levels; level <= TREE_LEVELS; level++) tree->first[level] = groups;
    tree->groups = malloc(groups * sizeof *tree->groups);
    tree->sums = malloc(groups * sizeof *tree->sums);
    if (!tree->groups || !tree->sums) return swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory");
    for (b->level = 0; b->level < tree->levels; b->level++)
        SWARF_TRY(swarf_parallel_for(tree->first[b->level + 1] - tree->first[b->level], fill_group, b, progress,
                                     b->level ? to : from, to));
    float most = 0;
    const swarf_group *root = &tree->groups[groups - 1];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < TREE_WIDTH; i++)
            if (root->hi[k][i] >= root->lo[k][i])
                most = fmaxf(most, fmaxf(fabsf(root->lo[k][i]), fabsf(root->hi[k][i])));
    tree->slack = TREE_SLACK * most;
    return SWARF_OK;
}

swarf_status swarf_box_tree_build(swarf_corners *corners, uint32_t *source, size_t count,
                                  const swarf_progress *progress, double from, double to, swarf_box_tree *out)
{
    swarf_box_tree tree = {.count = count};
    struct builder b = {.corners = corners, .count = count, .tree = &tree};
    b.items = malloc(count * sizeof *b.items);
    if (!b.items) return swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory for %zu triangles", count);
    for (size_t i = 0; i < count; i++) {
        const float(*p)[3] = corners[i].xyz;
        b.items[i].number = (uint32_t)i;
        for (int k = 0; k < 3; k++) {
            const float lo = fminf(p[0][k], fminf(p[1][k], p[2][k])), hi = fmaxf(p[0][k], fmaxf(p[1][k], p[2][k]));
            b.items[i].centre[k] = 0.5f * lo + 0.5f * hi;
        }
    }
    const double middle = 0.5 * (from + to);
    swarf_status status = sort_items(&b, progress, from, middle);
    if (status == SWARF_OK) status = reorder(&b, corners, source);
    free(b.items);
    if (status == SWARF_OK) status = build_groups(&b, progress, middle, to);
    if (status != SWARF_OK) {
        swarf_box_tree_free(&tree);
        return status;
    }
    *out = tree;
    return SWARF_OK;
}

void swarf_box_tree_free(swarf_box_tree *tree)
{
    free(tree->groups);
    free(tree->sums);
    memset(tree, 0, sizeof *tree);
}
