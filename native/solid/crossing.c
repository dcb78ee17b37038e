/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Which triangles cross or touch which others. Each group of the tree looks for what comes near its eight triangles;
 * the pairs found become one list per triangle. */
#include "solid/crossing.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "base/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Share of the gap by which the projections of triangles with a common corner may overlap. */
static const double touching = 1e-3;

/* Triangles with a common corner lie on top of each other or beside each other below this sine. */
static const double least_sine = 0.01;

/* Whether the projections of two triangles on an axis lie more than `gap` apart. */
static int are_apart(double a[3][3], double b[3][3], const double axis[3], double gap)
{
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    const double length = sqrt(vector_dot(axis, axis));
    for (int i = 0; i < 3; i++) {
        const double at[2] = {vector_dot(a[i], axis), vector_dot(b[i], axis)};
        for (int k = 0; k < 2; k++) {
            lo[k] = at[k] < lo[k] ? at[k] : lo[k];
            hi[k] = at[k] > hi[k] ? at[k] : hi[k];
        }
    }
    return lo[0] - hi[1] > gap * length || lo[1] - hi[0] > gap * length;
}

/* Whether two planes are one but for rounding, by their normals: it turns that of a small or thin triangle farthest. */
static int are_parallel(const double normal_a[3], const double normal_b[3])
{
    const double squares = vector_dot(normal_a, normal_a) * vector_dot(normal_b, normal_b);
    double sine[3];
    vector_cross(normal_a, normal_b, sine);
    return squares > 0 && vector_dot(sine, sine) <= least_sine * least_sine * squares;
}

/* Whether more corners of a triangle lie in the plane of another than the two have in common: then an edge of it may
 * lie in the other's face. */
static int has_edge_in(double triangle[3][3], const double plane[3], const double normal[3], double gap, int share)
{
    const double limit = gap * sqrt(vector_dot(normal, normal)), offset = vector_dot(plane, normal);
    int in = 0;
    for (int i = 0; i < 3; i++) in += fabs(vector_dot(triangle[i], normal) - offset) <= limit;
    return in > share;
}

/* Separating axes: the two normals, across the edges in each plane, and the edges of both crossed. Triangles are apart
 * when their projections on one of them are, by more than `gap`. Those with `share` common corners cannot be; they may
 * touch there, unless they lie on top of each other or one has an edge in the other's plane, whose normal then tells
 * nothing. */
static int meet(const swarf_corners *first, const swarf_corners *second, double gap, int share)
{
    double a[3][3], b[3][3], edge_a[3][3], edge_b[3][3], normal_a[3], normal_b[3], axis[3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) { /* relative to a corner, or coordinates' digits would drown the gap */
            a[i][k] = (double)first->xyz[i][k] - first->xyz[0][k];
            b[i][k] = (double)second->xyz[i][k] - first->xyz[0][k];
        }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            edge_a[i][k] = a[(i + 1) % 3][k] - a[i][k];
            edge_b[i][k] = b[(i + 1) % 3][k] - b[i][k];
        }
    vector_cross(edge_a[0], edge_a[1], normal_a);
    vector_cross(edge_b[0], edge_b[1], normal_b);
    const int flat = share && are_parallel(normal_a, normal_b);
    const double least = share ? -touching * gap : gap;
    const int beside_a = !flat && are_apart(a, b, normal_a, least);
    if (beside_a && !(share && has_edge_in(b, a[0], normal_a, gap, share))) return 0;
    const int beside_b = !flat && are_apart(a, b, normal_b, least);
    if (beside_b && !(share && has_edge_in(a, b[0], normal_b, gap, share))) return 0;
    for (int i = 0; i < 3; i++) {
        vector_cross(normal_a, edge_a[i], axis);
        if (are_apart(a, b, axis, least)) return 0;
        vector_cross(normal_b, edge_b[i], axis);
        if (are_apart(a, b, axis, least)) return 0;
    }
    for (int i = 0; i < 9 && !flat; i++) {
        vector_cross(edge_a[i / 3], edge_b[i % 3], axis);
        if ((beside_a && are_parallel(axis, normal_a)) || (beside_b && are_parallel(axis, normal_b))) continue;
        if (are_apart(a, b, axis, least)) return 0;
    }
    return 1;
}

/* Two triangles that meet. */
struct pair {
    uint32_t place[2];
};

struct pair_list {
    struct pair *pairs;
    size_t count, room;
};

struct crossing_work {
    const swarf_solid *solid;
    double gap;
    struct pair_list *found; /* per piece of work */
};

/* The places of one group, and what comes near them. */
struct group_work {
    const struct crossing_work *work;
    struct pair_list *found;
    size_t first, end;
    float lo[TREE_WIDTH][3], hi[TREE_WIDTH][3];
    swarf_status status;
};

/* Number of corners that two triangles have in common. */
static int common_corners(const uint32_t a[3], const uint32_t b[3])
{
    int count = 0;
    for (int i = 0; i < 9; i++) count += a[i / 3] == b[i % 3];
    return count;
}

static int are_neighbours(const swarf_solid *solid, size_t place, size_t other)
{
    const uint32_t *across = solid->across[place];
    return across[0] == other || across[1] == other || across[2] == other;
}

static int test_place(void *context, size_t place)
{
    struct group_work *group = context;
    const swarf_solid *solid = group->work->solid;
    if (place < group->first) return 1; /* that one's group sees to it */
    float lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        const float(*p)[3] = solid->corners[place].xyz;
        lo[k] = fminf(p[0][k], fminf(p[1][k], p[2][k]));
        hi[k] = fmaxf(p[0][k], fmaxf(p[1][k], p[2][k]));
    }
    const float gap = (float)group->work->gap;
    for (size_t other = group->first; other < group->end && other < place; other++) {
        int near = 1;
        for (int k = 0; k < 3; k++)
            near &=
                group->lo[other - group->first][k] <= hi[k] + gap && group->hi[other - group->first][k] >= lo[k] - gap;
        if (!near) continue;
        const int share = common_corners(solid->vertex[place], solid->vertex[other]);
        if (share && are_neighbours(solid, place, other)) continue;
        if (!meet(&solid->corners[other], &solid->corners[place], group->work->gap, share)) continue;
        struct pair_list *list = group->found;
        if (group->status == SWARF_OK)
            group->status =
                swarf_array_reserve((void **)&list->pairs, &list->room, list->count + 1, sizeof *list->pairs);
        if (group->status == SWARF_OK) list->pairs[list->count++] = (struct pair){{(uint32_t)other, (uint32_t)place}};
    }
    return group->status == SWARF_OK;
}

/* Groups that one piece of work looks at. */
enum { GROUPS = 64 };

static swarf_status test_groups(void *context, size_t index)
{
    const struct crossing_work *work = context;
    const swarf_box_tree *tree = &work->solid->tree;
    for (size_t number = index * GROUPS; number < (index + 1) * GROUPS && number < tree->first[1]; number++) {
        struct group_work group = {.work = work, .found = &work->found[index], .first = number * TREE_WIDTH};
        group.end = group.first + TREE_WIDTH < tree->count ? group.first + TREE_WIDTH : tree->count;
        double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
        for (size_t i = 0; i < group.end - group.first; i++)
            for (int k = 0; k < 3; k++) {
                group.lo[i][k] = tree->groups[number].lo[k][i];
                group.hi[i][k] = tree->groups[number].hi[k][i];
                lo[k] = fmin(lo[k], group.lo[i][k]);
                hi[k] = fmax(hi[k], group.hi[i][k]);
            }
        swarf_box_tree_near(tree, lo, hi, work->gap, 0, test_place, &group);
        SWARF_TRY(group.status);
    }
    return SWARF_OK;
}

static swarf_status list_pairs(const struct crossing_work *work, size_t pieces, size_t count, swarf_crossings *out)
{
    size_t total = 0;
    for (size_t i = 0; i < pieces; i++) total += 2 * work->found[i].count;
    if (total == 0) return SWARF_OK;
    out->first = calloc(count + 2, sizeof *out->first);
    out->other = malloc(total * sizeof *out->other);
    if (!out->first || !out->other) return swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory");
    size_t *next = out->first + 1; /* first numbers of pairs one place on, then where the next goes, then its end */
    for (size_t i = 0; i < pieces; i++)
        for (size_t k = 0; k < 2 * work->found[i].count; k++) next[work->found[i].pairs[k / 2].place[k % 2] + 1]++;
    for (size_t i = 0; i < count; i++) {
        out->count += next[i + 1] > 0;
        next[i + 1] += next[i];
    }
    for (size_t i = 0; i < pieces; i++)
        for (size_t k = 0; k < 2 * work->found[i].count; k++) {
            const uint32_t *place = work->found[i].pairs[k / 2].place;
            out->other[next[place[k % 2]]++] = place[1 - k % 2];
        }
    return SWARF_OK;
}

swarf_status swarf_crossings_find(const swarf_solid *solid, const swarf_progress *progress, double from, double to,
                                  swarf_crossings *out)
{
    const size_t pieces = (solid->tree.first[1] + GROUPS - 1) / GROUPS;
    swarf_crossings crossings = {.count = 0};
    struct crossing_work work = {solid, SOLID_GAP * solid->tree.slack, calloc(pieces, sizeof *work.found)};
    if (!work.found) return swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory");
    swarf_status status = swarf_parallel_for(pieces, test_groups, &work, progress, from, to);
    if (status == SWARF_OK) status = list_pairs(&work, pieces, solid->tree.count, &crossings);
    for (size_t i = 0; i < pieces; i++) free(work.found[i].pairs);
    free(work.found);
    if (status != SWARF_OK) {
        swarf_crossings_free(&crossings);
        return status;
    }
    *out = crossings;
    return SWARF_OK;
}

void swarf_crossings_free(swarf_crossings *crossings)
{
    free(crossings->first);
    free(crossings->other);
    memset(crossings, 0, sizeof *crossings);
}
