/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A tool as the checks need it: its parts ready to be swept, a holder wider by the clearance, what is above the flutes.
 */
#ifndef SWARF_STOCK_CHECK_TOOL_H
#define SWARF_STOCK_CHECK_TOOL_H

#include "stock/stock.h"
#include "sweep/body.h"

/** Bodies have no components where the tool has no such part, or are NULL. */
typedef struct swarf_check_tool {
    const swarf_cutter *cutter;
    int32_t teeth;
    swarf_body *flutes, *shank, *holder;
    swarf_body *wide_holder; /**< wider and lower by the clearance */
    swarf_body *above;       /**< of a tool with flutes only: the space beyond them */
    int ready;
} swarf_check_tool;

/** Make the bodies of an entry of the tool table at a voxel size; what was made is freed also after a failure. */
swarf_status swarf_check_tool_prepare(const swarf_tool *entry, double voxel, double clearance, swarf_check_tool *tool);
void swarf_check_tool_free(swarf_check_tool *tool);

#endif
