/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "stock/check_tool.h"

#include "base/status.h"

#include <stdlib.h>

/* The tool of a cutter without shank ends this far up, mm. */
static const double endless = 500;

/* A cutter of one holder: this cutter's, wider and lower by the clearance. */
static swarf_status make_wide(const swarf_cutter *cutter, double clearance, swarf_cutter **out)
{
    swarf_cutter_part part = {.nodes = NULL};
    double low, high;
    swarf_cutter_extent(cutter, SWARF_PART_HOLDER, &low, &high);
    for (size_t i = 0; i < swarf_cutter_part_count(cutter) && !part.nodes; i++) {
        SWARF_TRY(swarf_cutter_part_get(cutter, i, &part));
        if (part.kind != SWARF_PART_HOLDER) part.nodes = NULL;
    }
    if (!part.nodes) return SWARF_OK;
    swarf_profile_node *nodes = malloc(part.node_count * sizeof *nodes);
    if (!nodes) return swarf_fail(SWARF_ERROR_MEMORY, "check: out of memory");
    for (size_t i = 0; i < part.node_count; i++) {
        nodes[i] = part.nodes[i];
        if (nodes[i].r > 0) nodes[i].r += clearance;
        if (nodes[i].z <= low) nodes[i].z -= clearance;
    }
    part.nodes = nodes;
    const swarf_status status = swarf_cutter_create(&part, 1, out);
    free(nodes);
    return status;
}

/* A cylinder as wide as the flutes from their upper end on. */
static swarf_status make_above(const swarf_cutter *cutter, swarf_cutter **out)
{
    double low, high;
    swarf_cutter_extent(cutter, SWARF_PART_FLUTES, &low, &high);
    const double radius = swarf_cutter_radius(cutter, SWARF_PART_FLUTES);
    const swarf_profile_node nodes[4] = {
        {0, high, 0}, {radius, high, 0}, {radius, high + endless, 0}, {0, high + endless, 0}};
    const swarf_cutter_part part = {SWARF_PART_SHANK, nodes, 4};
    return swarf_cutter_create(&part, 1, out);
}

swarf_status swarf_check_tool_prepare(const swarf_tool *entry, double voxel, double clearance, swarf_check_tool *tool)
{
    const swarf_cutter *cutter = entry->cutter;
    tool->cutter = cutter;
    tool->teeth = entry->teeth;
    tool->ready = 1;
    SWARF_TRY(swarf_body_create(cutter, SWARF_PART_FLUTES, voxel, &tool->flutes));
    SWARF_TRY(swarf_body_create(cutter, SWARF_PART_SHANK, voxel, &tool->shank));
    SWARF_TRY(swarf_body_create(cutter, SWARF_PART_HOLDER, voxel, &tool->holder));
    swarf_cutter *made = NULL;
    swarf_status status = SWARF_OK;
    if (tool->holder->component_count && clearance > 0) {
        SWARF_TRY(make_wide(cutter, clearance, &made));
        if (made) status = swarf_body_create(made, SWARF_PART_HOLDER, voxel, &tool->wide_holder);
    } else if (tool->flutes->component_count && !tool->shank->component_count && !tool->holder->component_count) {
        SWARF_TRY(make_above(cutter, &made));
        status = swarf_body_create(made, SWARF_PART_SHANK, voxel, &tool->above);
    }
    swarf_cutter_release(made);
    return status;
}

void swarf_check_tool_free(swarf_check_tool *tool)
{
    swarf_body_destroy(tool->flutes);
    swarf_body_destroy(tool->shank);
    swarf_body_destroy(tool->holder);
    swarf_body_destroy(tool->wide_holder);
    swarf_body_destroy(tool->above);
}
