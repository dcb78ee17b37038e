/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Slots where the surfaces of stock and design run side by side, so that the volume between them is the sum of
 * deviation times area and no field of the design is needed.
 *
 * A slot is open where a point on either surface is more than a voxel from the other surface. Without an open slot on
 * the way both surfaces are crossed together: who starts outside of both is inside both or outside both wherever such a
 * way leads. What is reached so from the border of the layout, where nothing is, is settled. */
#include "base/parallel.h"
#include "base/status.h"
#include "compare/compare.h"
#include "solid/solid.h"
#include "stock/leaf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Surfaces farther apart than this many voxels do not run side by side: for curved ones the sum would be wrong. No more
 * than swarf_measured.on_design holds. */
static const double most_apart = 1;

/* Beside edges the stock's field is rounded by this many voxels; what is more is there. */
static const double most_rounded = 0.5;

/* Deviations beside edges are not summed; those of the faces stand for them as long as the faces have this share of the
 * area. */
static const double least_smooth = 0.25;

/* Leaves of one piece of work. */
enum { LEAVES = 256 };

enum { FREE = 0, OPEN = 2 }; /* and 1: settled */

struct matching {
    const swarf_tree_layout *layout;
    const swarf_points *points;
    swarf_slot_difference *slots;
    uint8_t *state;
};

static void sum_leaf(const struct matching *m, size_t leaf)
{
    const swarf_points *p = m->points;
    const double voxel = m->layout->voxel;
    const size_t slot = p->slot[leaf];
    double area = 0, smooth = 0, excess = 0, gouge = 0;
    for (size_t i = p->first[leaf]; i < p->first[leaf + 1]; i++) {
        const double distance = p->distance[i], own = p->area[i];
        const int edge = p->kind[i] & SWARF_POINT_EDGE;
        if (fabs(distance) > voxel * (edge ? most_rounded : most_apart)) {
            m->state[slot] = OPEN;
            return;
        }
        area += own;
        if (p->kind[i] & SWARF_POINT_EDGE) continue;
        smooth += own;
        *(distance > 0 ? &excess : &gouge) += own * fabs(distance);
    }
    if (smooth < least_smooth * area) {
        m->state[slot] = OPEN;
        return;
    }
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

static void open_design(const struct matching *m, const swarf_samples *on_design)
{
    for (size_t i = 0; i < on_design->count; i++) {
        int32_t at[3];
        for (int k = 0; k < 3; k++) {
            const double voxels = (on_design->samples[i].xyz[k] - m->layout->origin[k]) / m->layout->voxel;
            const int32_t last = m->layout->count[k] * SWARF_NODE_DIM / SWARF_LEAF_DIM - 1;
            at[k] = (int32_t)fmin(fmax(voxels / SWARF_LEAF_DIM, 0), last);
        }
        m->state[swarf_layout_slot(m->layout, at)] = OPEN;
    }
}

/* Settle a slot and put it on the stack, if it is neither open nor settled. */
static void settle(const struct matching *m, const int32_t at[3], int32_t (*stack)[3], size_t *depth)
{
    uint8_t *state = &m->state[swarf_layout_slot(m->layout, at)];
    if (*state != FREE) return;
    *state = 1;
    memcpy(stack[(*depth)++], at, 3 * sizeof at[0]);
}

/* From the outermost slots, which hold no material and no design, inwards. */
static swarf_status spread(const struct matching *m)
{
    const swarf_tree_layout *layout = m->layout;
    int32_t size[3];
    for (int k = 0; k < 3; k++) size[k] = layout->count[k] * SWARF_NODE_DIM / SWARF_LEAF_DIM;
    int32_t(*stack)[3] = malloc(swarf_layout_nodes(layout) * SWARF_NODE_SLOTS * sizeof *stack);
    if (!stack) return swarf_fail(SWARF_ERROR_MEMORY, "deviation: out of memory");
    size_t depth = 0;
    const int32_t corner[3] = {0, 0, 0};
    settle(m, corner, stack, &depth);
    while (depth > 0) {
        int32_t at[3];
        memcpy(at, stack[--depth], sizeof at);
        for (int side = 0; side < 6; side++) {
            int32_t next[3] = {at[0], at[1], at[2]};
            next[side / 2] += side % 2 ? 1 : -1;
            if (next[side / 2] >= 0 && next[side / 2] < size[side / 2]) settle(m, next, stack, &depth);
        }
    }
    free(stack);
    return SWARF_OK;
}

swarf_status swarf_match_slots(const swarf_stock *stock, const swarf_solid *design, const swarf_measured *measured,
                               uint8_t *settled)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    const size_t count = swarf_layout_nodes(layout) * SWARF_NODE_SLOTS;
    const int at_border = (int)(layout->occupied[0] & 1); /* a grid from a file may start anywhere */
    if (at_border || !swarf_layout_holds(layout, &design->facts.box)) return SWARF_OK;
    const struct matching m = {layout, &measured->on_stock, measured->slots, settled};
    SWARF_TRY(swarf_parallel_for((m.points->leaf_count + LEAVES - 1) / LEAVES, sum_leaves, (void *)&m, NULL, 0, 1));
    open_design(&m, &measured->on_design);
    SWARF_TRY(spread(&m));
    for (size_t i = 0; i < count; i++) {
        settled[i] = settled[i] == 1;
        if (!settled[i]) measured->slots[i] = (swarf_slot_difference){0, 0};
    }
    return SWARF_OK;
}
