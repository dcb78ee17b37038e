/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Facets of a band that cut each other, or those that the bands before left there. */
#include "base/status.h"
#include "mesh/contour.h"

#include <stdlib.h>

/* Of pairs that involve facets of this band, counted by who else sees them; those of two other bands are dropped. */
static void count_pairs(const swarf_facets *facets, size_t found, contour_pairs *out)
{
    const size_t own = facets->facet_count;
    for (size_t i = 0; i < found; i++) {
        const swarf_facet_pair pair = out->pair[i];
        const int a = pair.a < own && !facets->facet[pair.a].beyond;
        const int b = pair.b < own && !facets->facet[pair.b].beyond;
        out->fresh +=
            (pair.a < own && !facets->facet[pair.a].before) || (pair.b < own && !facets->facet[pair.b].before);
        if (!a && !b) continue;
        out->pair[out->count++] = pair;
        out->last += (a || pair.a >= own) && (b || pair.b >= own);
    }
}

swarf_status swarf_contour_pairs_find(const contour *work, swarf_facets *facets, swarf_facets_known *known,
                                      const swarf_progress_share *share, contour_pairs *out)
{
    const contour_band *band = work->band;
    const size_t own = facets->facet_count;
    *out = (contour_pairs){0};
    if (band && band->below.facet_count) SWARF_TRY(swarf_facets_append(facets, &band->below));
    size_t found = 0;
    uint8_t *fresh = malloc(facets->facet_count + 1);
    swarf_status status =
        fresh ? swarf_facets_known_tell(known, facets, fresh) : swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    if (status == SWARF_OK)
        status = swarf_facets_intersect(facets, fresh, share->whole, share->from, share->to, &out->pair, &found);
    free(fresh);
    if (status == SWARF_OK && found > 0) status = swarf_facets_known_take(known, facets, out->pair, found);
    facets->facet_count = own;
    if (status == SWARF_OK) {
        count_pairs(facets, found, out);
        return SWARF_OK;
    }
    free(out->pair);
    out->pair = NULL;
    return status;
}
