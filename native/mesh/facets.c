/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Two surfaces as one. */
#include "mesh/facets.h"

#include "base/status.h"
#include "base/weld.h"

#include <stdlib.h>
#include <string.h>

swarf_status swarf_facets_append(swarf_facets *facets, const swarf_facets *more)
{
    const size_t own = facets->vertex_count, all = own + more->vertex_count, count = facets->facet_count;
    float *xyz = malloc((3 * all + 1) * sizeof *xyz), *welded = malloc((3 * all + 1) * sizeof *welded);
    swarf_facet *facet = malloc((count + more->facet_count + 1) * sizeof *facet);
    uint32_t *map = malloc((all + 1) * sizeof *map), *first = malloc((all + 1) * sizeof *first);
    swarf_status status = SWARF_OK;
    if (!xyz || !welded || !facet || !map || !first) {
        status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for %zu triangles", count);
    } else {
        memcpy(xyz, facets->xyz, 3 * own * sizeof *xyz);
        memcpy(xyz + 3 * own, more->xyz, 3 * more->vertex_count * sizeof *xyz);
        memcpy(welded, xyz, 3 * all * sizeof *xyz);
        memcpy(facet, facets->facet, count * sizeof *facet);
        memcpy(facet + count, more->facet, more->facet_count * sizeof *facet);
        size_t unique = 0;
        status = swarf_weld(welded, all, map, &unique);
        for (size_t i = all; status == SWARF_OK && i-- > 0;) first[map[i]] = (uint32_t)i;
        for (size_t f = count; status == SWARF_OK && f < count + more->facet_count; f++)
            for (int k = 0; k < 3; k++) facet[f].v[k] = first[map[own + facet[f].v[k]]];
    }
    free(welded);
    free(map);
    free(first);
    if (status != SWARF_OK) {
        free(xyz);
        free(facet);
        return status;
    }
    swarf_facets_free(facets);
    *facets = (swarf_facets){.xyz = xyz, .vertex_count = all, .facet = facet, .facet_count = count + more->facet_count};
    return SWARF_OK;
}
