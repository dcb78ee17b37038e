/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The deviation of what a picture shows: a value per pixel, for colours and for what is under a cursor. */
#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/measure.h"
#include "swarf/compare.h"
#include "swarf/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/** The points of the pixels that see the stock, side by side, so that all cores get an equal share, and after them room
 *  for a distance of `size` bytes for each. Freed with free(). */
static swarf_status gather_points(const double *position, const uint8_t *seen, size_t count, size_t size,
                                  double **points, size_t *used)
{
    void *array = NULL;
    size_t room = 0;
    *used = 0;
    for (size_t i = 0; i < count; i++) *used += seen[i] == SWARF_SEEN_STOCK;
    SWARF_TRY(swarf_array_reserve(&array, &room, *used + 1, 3 * sizeof **points + size));
    double *next = *points = array;
    for (size_t i = 0; i < count; i++)
        if (seen[i] == SWARF_SEEN_STOCK) {
            memcpy(next, position + 3 * i, 3 * sizeof *next);
            next += 3;
        }
    return SWARF_OK;
}

swarf_status swarf_deviation_pixels(const swarf_solid *design, const double *position, const uint8_t *seen,
                                    size_t count, double allowance, const swarf_progress *progress, double *value)
{
    SWARF_REQUIRE(design && ((position && seen && value) || count == 0), "pixels: design or buffers missing");
    SWARF_REQUIRE(isfinite(allowance), "pixels: an allowance of %g mm", allowance);
    double *points;
    size_t used;
    SWARF_TRY(gather_points(position, seen, count, sizeof(double), &points, &used));
    double *distance = points + 3 * used;
    swarf_status status = swarf_solid_distance(design, points, used, progress, distance, NULL);
    if (!status) status = swarf_progress_report(progress, 1); /* however short the work was */
    for (size_t i = 0, at = 0; i < count && !status; i++)
        value[i] = seen[i] == SWARF_SEEN_STOCK ? distance[at++] - allowance : NAN;
    free(points);
    return status;
}

swarf_status swarf_deviation_design_pixels(swarf_stock *stock, const double *position, const uint8_t *seen,
                                           size_t count, double allowance, const swarf_progress *progress,
                                           double *value)
{
    SWARF_REQUIRE(stock && ((position && seen && value) || count == 0), "pixels: stock or buffers missing");
    SWARF_REQUIRE(isfinite(allowance), "pixels: an allowance of %g mm", allowance);
    /* just below three voxels: rounded, the band ends somewhere there */
    const double band = 2.999 * swarf_stock_voxel(stock);
    double *points;
    size_t used;
    SWARF_TRY(gather_points(position, seen, count, sizeof(float), &points, &used));
    float *distance = (float *)(void *)(points + 3 * used);
    swarf_status status = swarf_stock_enter_read(stock);
    if (!status) {
        status = swarf_measure_samples(stock, points, used, progress, distance);
        swarf_stock_leave(stock);
    }
    if (!status) status = swarf_progress_report(progress, 1); /* however short the work was */
    for (size_t i = 0, at = 0; i < count && !status; i++) {
        const double left = seen[i] == SWARF_SEEN_STOCK ? -(double)distance[at++] : NAN;
        value[i] = (fabs(left) >= band ? copysign(INFINITY, left) : left) - allowance;
    }
    free(points);
    return status;
}
