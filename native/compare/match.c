/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Slots where the surfaces of stock and design run side by side, so that the volume between them is the sum of
 * deviation times area and no field of the design is needed.
 *
 * A slot is open where a point on either surface is more than a voxel from the other surface, or the two face different
 * ways there, as the sides of a thin wall do. Else what lies on one side of both surfaces is in both solids, what lies
 * on the other side in neither. Slots without a surface are gathered into regions that no surface divides: each is in
 * stock and design, or not, as any place of it is. */
#include "base/parallel.h"
#include "base/status.h"
#include "compare/compare.h"
#include "solid/solid.h"
#include "stock/leaf.h"
#include "stock/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Surfaces farther apart than this many voxels do not run side by side: for curved ones the sum would be wrong. */
static const double most_apart = 1;

/* Beside edges the stock's field is rounded by this many voxels; what is more is there. */
static const double most_rounded = 0.5;

/* Deviations beside edges are not summed; those of the faces stand for them as long as the faces have this share of the
 * area. */
static const double least_smooth = 0.25;

/* Leaves of one piece of work. */
enum { LEAVES = 256 };

/* Voxels around a point on a surface that are marked: points on the design may be this far apart, and values up to half
 * a voxel from a surface are partly filled. */
static const double mark_reach = 1.3;

struct matching {
    const swarf_stock *stock;
    const swarf_solid *design;
    const swarf_tree_layout *layout;
    const swarf_points *points;
    swarf_slot_difference *slots;
    uint8_t *marks;
};

static void add_mark(uint8_t *marks, size_t slot, uint8_t mark)
{
    if ((__atomic_load_n(&marks[slot], __ATOMIC_RELAXED) & mark) != mark)
        __atomic_fetch_or(&marks[slot], mark, __ATOMIC_RELAXED);
}

static double clamp(double x, double last)
{
    return x > last ? last : x > 0 ? x : 0;
}

void swarf_mark_slots(const swarf_tree_layout *layout, const double at[3], uint8_t mark, uint8_t *marks)
{
    int32_t lo[3], hi[3];
    for (int k = 0; k < 3; k++) {
        const double last = (double)layout->count[k] * SWARF_NODE_DIM / SWARF_LEAF_DIM - 1;
        lo[k] = (int32_t)clamp((at[k] - mark_reach) / SWARF_LEAF_DIM, last);
        hi[k] = (int32_t)clamp((at[k] + mark_reach) / SWARF_LEAF_DIM, last);
    }
    for (int32_t x = lo[0]; x <= hi[0]; x++)
        for (int32_t y = lo[1]; y <= hi[1]; y++)
            for (int32_t z = lo[2]; z <= hi[2]; z++)
                add_mark(marks, swarf_layout_slot(layout, (const int32_t[3]){x, y, z}), mark);
}

static void open_point(const struct matching *m, size_t i)
{
    double at[3];
    for (size_t k = 0; k < 3; k++)
        at[k] = ((double)m->points->xyz[3 * i + k] - m->layout->origin[k]) / m->layout->voxel;
    swarf_mark_slots(m->layout, at, SLOT_OPEN, m->marks);
}

static void sum_leaf(const struct matching *m, size_t leaf)
{
    const swarf_points *p = m->points;
    const double voxel = m->layout->voxel;
    const size_t slot = p->slot[leaf];
    double area = 0, smooth = 0, excess = 0, gouge = 0;
    if (p->first[leaf] < p->first[leaf + 1]) add_mark(m->marks, slot, SLOT_MET);
    for (size_t i = p->first[leaf]; i < p->first[leaf + 1]; i++) {
        const double distance = p->distance[i], own = p->area[i];
        const int edge = p->kind[i] & SWARF_POINT_EDGE;
        if (p->kind[i] & POINT_TURNED || fabs(distance) > voxel * (edge ? most_rounded : most_apart)) open_point(m, i);
        area += own;
        if (edge) continue;
        smooth += own;
        *(distance > 0 ? &excess : &gouge) += own * fabs(distance);
    }
    if (smooth < least_smooth * area) add_mark(m->marks, slot, SLOT_OPEN);
    const double scale = smooth > 0 ? area / smooth / (voxel * voxel * voxel) : 0;
    m->slots[slot] = (swarf_slot_difference){(float)(scale * excess), (float)(scale * gouge)};
}

static swarf_status sum_leaves(void *context, size_t index)
{
    const struct matching *m = context;
    const size_t end = (index + 1) * LEAVES < m->points->leaf_count ? (index + 1) * LEAVES : m->points->leaf_count;
    for (size_t leaf = index * LEAVES; leaf < end; leaf++) sum_leaf(m, leaf);
    return SWARF_OK;
}

/* Whether the middle of a slot that no surface is in is in both solids or in neither. */
static int is_alike(const struct matching *m, const int32_t at[3])
{
    const swarf_tree_layout *layout = m->layout;
    double middle[3];
    int32_t voxel[3];
    for (int k = 0; k < 3; k++) {
        voxel[k] = at[k] * SWARF_LEAF_DIM + SWARF_LEAF_DIM / 2;
        middle[k] = layout->origin[k] + layout->voxel * voxel[k];
    }
    swarf_probe probe = swarf_probe_begin(m->stock);
    return (swarf_probe_voxel(&probe, voxel) < 0) == swarf_solid_inside(m->design, middle);
}

/* Add a slot without a surface to a region, once. */
static void reach_slot(const struct matching *m, const int32_t at[3], int32_t (*region)[3], size_t *count)
{
    uint8_t *mark = &m->marks[swarf_layout_slot(m->layout, at)];
    if (*mark) return;
    *mark = SLOT_MET;
    memcpy(region[(*count)++], at, 3 * sizeof at[0]);
}

/* Find the region that a slot without a surface is in; open it where stock and design differ. */
static void find_region(const struct matching *m, const int32_t size[3], const int32_t from[3], int32_t (*region)[3])
{
    size_t count = 0;
    reach_slot(m, from, region, &count);
    for (size_t i = 0; i < count; i++)
        for (int side = 0; side < 6; side++) {
            int32_t next[3] = {region[i][0], region[i][1], region[i][2]};
            next[side / 2] += side % 2 ? 1 : -1;
            if (next[side / 2] >= 0 && next[side / 2] < size[side / 2]) reach_slot(m, next, region, &count);
        }
    if (count == 0 || is_alike(m, from)) return;
    for (size_t i = 0; i < count; i++) m->marks[swarf_layout_slot(m->layout, region[i])] = SLOT_OPEN;
}

static swarf_status find_regions(const struct matching *m)
{
    int32_t size[3], at[3];
    for (int k = 0; k < 3; k++) size[k] = m->layout->count[k] * SWARF_NODE_DIM / SWARF_LEAF_DIM;
    int32_t(*region)[3] = malloc(swarf_layout_nodes(m->layout) * SWARF_NODE_SLOTS * sizeof *region);
    if (!region) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    for (at[0] = 0; at[0] < size[0]; at[0]++)
        for (at[1] = 0; at[1] < size[1]; at[1]++)
            for (at[2] = 0; at[2] < size[2]; at[2]++) find_region(m, size, at, region);
    free(region);
    return SWARF_OK;
}

swarf_status swarf_match_slots(const swarf_stock *stock, const swarf_solid *design, const swarf_measured *measured,
                               uint8_t *marks)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    const size_t count = swarf_layout_nodes(layout) * SWARF_NODE_SLOTS;
    const struct matching m = {stock, design, layout, &measured->on_stock, measured->slots, marks};
    SWARF_TRY(swarf_parallel_for((m.points->leaf_count + LEAVES - 1) / LEAVES, sum_leaves, (void *)&m, NULL, 0, 1));
    SWARF_TRY(find_regions(&m));
    for (size_t i = 0; i < count; i++) {
        marks[i] = marks[i] == SLOT_MET;
        if (!marks[i]) measured->slots[i] = (swarf_slot_difference){0, 0};
    }
    return SWARF_OK;
}
