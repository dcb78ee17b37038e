/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Placements of other origin than swarf_placement_create(), which are plain data anyone may have filled. */
#ifndef SWARF_BASE_PLACEMENT_H
#define SWARF_BASE_PLACEMENT_H

#include "swarf/placement.h"

/** SWARF_ERROR_ARGUMENT: not finite, skewed, scaled or mirrored by more than swarf_placement_create() mends. */
swarf_status swarf_placement_check(const swarf_placement *placement);

#endif
