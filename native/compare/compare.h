/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of this room share. */
#ifndef SWARF_COMPARE_COMPARE_H
#define SWARF_COMPARE_COMPARE_H

#include "stock/stock.h"
#include "swarf/compare.h"

/** Differences by volume of a stock that has been entered. `slots` (may be NULL): per slot of the tree the excess and
 *  the gouge in it, in voxels. */
typedef struct swarf_slot_difference {
    float excess, gouge;
} swarf_slot_difference;
swarf_status swarf_compare_slots(const swarf_stock *stock, const swarf_solid *design, const swarf_progress *progress,
                                 double from, double to, swarf_slot_difference *slots, swarf_comparison *out);

/** A point where a surface is measured. */
typedef struct swarf_sample {
    float xyz[3];
    float value; /**< deviation, positive where material is left */
    float area;  /**< of the surface it stands for */
    uint32_t triangle;
    uint8_t kind;    /**< SWARF_POINT_ bits */
    uint8_t beyond;  /**< out of tolerance */
    uint8_t missing; /**< on the design, with no surface of the stock near */
} swarf_sample;

typedef struct swarf_samples {
    swarf_sample *samples;
    size_t count;
} swarf_samples;

/** Where the surface of an entered stock crosses the lines between neighbouring voxel centres; value, triangle and
 *  beyond are left 0. Freed with free(). */
swarf_status swarf_sample_stock(const swarf_stock *stock, const swarf_progress *progress, double from, double to,
                                swarf_samples *out);
/** Points of the design, no more than `spacing` apart, that lie deeper than `excess` in the stock or farther than
 *  `gouge` out of it; *area is that of all points tried. The stock has been entered. */
swarf_status swarf_sample_design(const swarf_stock *stock, const swarf_solid *design, double spacing, double excess,
                                 double gouge, const swarf_progress *progress, double from, double to,
                                 swarf_samples *out, double *area);

/** Gather the samples that are beyond tolerance into clusters and share out the volumes. */
swarf_status swarf_cluster_samples(const swarf_stock *stock, const swarf_samples *on_stock,
                                   const swarf_samples *on_design, const swarf_slot_difference *slots,
                                   swarf_cluster **out, size_t *count);

/** See swarf_deviation_find_moves(). */
swarf_status swarf_find_moves(swarf_cluster *clusters, size_t count, double voxel, const swarf_program *program,
                              const swarf_tool *tools, size_t tool_count);

#endif
