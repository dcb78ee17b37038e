/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The deviation of what a picture shows: a value per pixel, for colours and for what is under a cursor. */
#include "base/memory.h"
#include "base/status.h"
#include "swarf/compare.h"
#include "swarf/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

swarf_status swarf_deviation_pixels(const swarf_solid *design, const double *position, const uint8_t *seen,
                                    size_t count, double allowance, const swarf_progress *progress, double *value)
{
    SWARF_REQUIRE(design && ((position && seen && value) || count == 0), "pixels: design or buffers missing");
    SWARF_REQUIRE(isfinite(allowance), "pixels: an allowance of %g mm", allowance);
    /* The points of the pixels that count lie together, so that all cores get an equal share. */
    void *array = NULL;
    size_t room = 0, used = 0, at = 0;
    for (size_t i = 0; i < count; i++) used += seen[i] == SWARF_SEEN_STOCK;
    if (used == 0) {
        for (size_t i = 0; i < count; i++) value[i] = NAN;
        return SWARF_OK;
    }
    SWARF_TRY(swarf_array_reserve(&array, &room, used, 4 * sizeof(double)));
    double *points = array, *distance = points + 3 * used;
    for (size_t i = 0; i < count; i++)
        if (seen[i] == SWARF_SEEN_STOCK) memcpy(points + 3 * at++, position + 3 * i, 3 * sizeof *points);
    const swarf_status status = swarf_solid_distance(design, points, used, progress, distance, NULL);
    for (size_t i = at = 0; i < count && !status; i++)
        value[i] = seen[i] == SWARF_SEEN_STOCK ? distance[at++] - allowance : NAN;
    free(array);
    return status;
}

swarf_status swarf_deviation_design_pixels(swarf_stock *stock, const double *position, const uint8_t *seen,
                                           size_t count, double allowance, double *value)
{
    SWARF_REQUIRE(stock && ((position && seen && value) || count == 0), "pixels: stock or buffers missing");
    SWARF_REQUIRE(isfinite(allowance), "pixels: an allowance of %g mm", allowance);
    enum { SOME = 1024 };
    /* just below three voxels: rounded, the band ends somewhere there */
    const double band = 2.999 * swarf_stock_voxel(stock);
    double points[3 * SOME];
    float distance[SOME];
    size_t pixels[SOME];
    for (size_t i = 0; i < count;) {
        size_t used = 0;
        for (; i < count && used < SOME; i++) {
            value[i] = NAN;
            if (seen[i] != SWARF_SEEN_STOCK) continue;
            memcpy(points + 3 * used, position + 3 * i, 3 * sizeof *points);
            pixels[used++] = i;
        }
        SWARF_TRY(swarf_stock_sample(stock, points, used, distance));
        for (size_t k = 0; k < used; k++) {
            const double left = -(double)distance[k];
            value[pixels[k]] = (fabs(left) < band ? left : copysign(INFINITY, left)) - allowance;
        }
    }
    return SWARF_OK;
}
