/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of this room share. */
#ifndef SWARF_COMPARE_COMPARE_H
#define SWARF_COMPARE_COMPARE_H

#include "base/parallel.h"
#include "stock/stock.h"
#include "swarf/compare.h"

/** Differences by volume of a stock that has been entered. `slots` (may be NULL): per slot of the tree the excess and
 *  the gouge in it, in voxels. */
typedef struct swarf_slot_difference {
    float excess, gouge;
} swarf_slot_difference;
/** `settled` (may be NULL) has 1 for each slot whose differences are known already. */
swarf_status swarf_compare_slots(const swarf_stock *stock, const swarf_solid *design, const uint8_t *settled,
                                 const swarf_progress *progress, double from, double to, swarf_slot_difference *slots,
                                 swarf_comparison *out);

/** Whether a box lies within the voxels of a layout. */
int swarf_layout_holds(const swarf_tree_layout *layout, const swarf_box *box);

/** A point that is out of tolerance. */
typedef struct swarf_sample {
    float xyz[3];
    float value; /**< deviation, positive where material is left */
    float area;  /**< of the surface it stands for */
    uint32_t triangle;
    uint8_t kind;    /**< SWARF_POINT_ bits */
    uint8_t missing; /**< on the design, with no surface of the stock near */
} swarf_sample;

typedef struct swarf_samples {
    swarf_sample *samples;
    size_t count;
} swarf_samples;

/** Beside SWARF_POINT_ bits: the nearest triangle faces the other way. */
enum { POINT_TURNED = 8 };

/** Points on the surface of a stock, in the order of its leaves. */
typedef struct swarf_points {
    size_t count;
    float *xyz;      /**< 3 each */
    float *area;     /**< of the surface each stands for */
    float *distance; /**< from the design, positive outside */
    uint32_t *triangle;
    uint8_t *kind; /**< SWARF_POINT_EDGE; _UNTOUCHED where it lies on the first stock, whatever its distance;
                      POINT_TURNED */
    size_t leaf_count;
    size_t *slot;  /**< of each leaf, swarf_layout_slot(), ascending */
    size_t *first; /**< point of each leaf, and one more: their number */
} swarf_points;

/** What was measured once: a stock's surface against a design and the design's against the stock. It asks for no
 *  tolerance; the deviations judged from it share it. Immutable. */
typedef struct swarf_measured {
    int references;           /* only by atomic operations */
    swarf_tree_layout layout; /* of the stock; without its arrays, which may have changed since */
    size_t source_count;      /* of the triangles the design was given */
    swarf_points on_stock;
    swarf_samples on_design; /* deeper in the stock, or farther out of it, than a voxel */
    double design_mm2;
    swarf_slot_difference *slots; /* one per slot of the layout */
    swarf_comparison volumes;
} swarf_measured;

/** Measure stocks that have been entered; `first` may be NULL. The caller owns one reference. */
swarf_status swarf_measure(const swarf_stock *stock, const swarf_solid *design, const swarf_stock *first,
                           const swarf_progress *progress, swarf_measured **out);
swarf_measured *swarf_measured_retain(const swarf_measured *measured);
/** NULL is legal. */
void swarf_measured_release(swarf_measured *measured);

/** Where the surface of an entered stock crosses the lines between neighbouring voxel centres; distance and triangle
 *  have room but no values. Freed with swarf_points_free(). */
swarf_status swarf_sample_stock(const swarf_stock *stock, const swarf_progress *progress, double from, double to,
                                swarf_points *out);
void swarf_points_free(swarf_points *points);
/** How a design is sampled. */
typedef struct swarf_sampling {
    double spacing; /**< mm; points are no farther apart */
    double least;   /**< mm; those deeper in the stock, or farther out of it, are told */
    uint8_t
        *marks; /**< a byte per slot gets what the design is there; NULL: not wanted, else spacing is a voxel at most */
} swarf_sampling;

/** Points of the design that differ from the stock; *area is that of all points tried. Values are positive in the stock
 *  and end at its band. The stock has been entered. */
swarf_status swarf_sample_design(const swarf_stock *stock, const swarf_solid *design, const swarf_sampling *sampling,
                                 const swarf_progress_share *share, swarf_samples *out, double *area);

/** Marks of slots: a surface is in it; one that the other does not run beside. */
enum { SLOT_MET = 1, SLOT_OPEN = 2 };

/** Mark the slots at and just beside a point in voxels of the layout. Any thread. */
void swarf_mark_slots(const swarf_tree_layout *layout, const double at[3], uint8_t mark, uint8_t *marks);

/** The slots whose volumes follow from the points: turns marks of the design, which has no holes and lies within the
 *  layout, into 1 for these and 0, and fills their measured->slots; the others of these stay 0. on_stock has distances.
 */
swarf_status swarf_match_slots(const swarf_stock *stock, const swarf_solid *design, const swarf_measured *measured,
                               uint8_t *marks);

/** Put parts end to end, in their order; free `count` parts and the array they are in (NULL is legal). */
swarf_status swarf_samples_join(const swarf_samples *parts, size_t count, swarf_samples *out);
void swarf_samples_free(swarf_samples *parts, size_t count);

/** Whether options leave out a place that is nearest to a triangle of the design. */
int swarf_deviation_ignores(const swarf_deviation_options *o, uint32_t triangle, const float xyz[3]);
/** Of measured->on_design those that these options are beyond; where the stock's band does not tell how far, their
 *  value is what they are known to be beyond. */
swarf_status swarf_find_missing(const swarf_measured *measured, const swarf_deviation_options *o,
                                const swarf_progress *progress, double from, double to, swarf_samples *out);

/** Gather the samples, all of them beyond tolerance, into clusters and share out the volumes. */
swarf_status swarf_cluster_samples(const swarf_tree_layout *layout, const swarf_samples *on_stock,
                                   const swarf_samples *on_design, const swarf_slot_difference *slots,
                                   swarf_cluster **out, size_t *count);

/** See swarf_deviation_find_moves(). */
swarf_status swarf_find_moves(swarf_cluster *clusters, size_t count, double voxel, const swarf_program *program,
                              const swarf_tool *tools, size_t tool_count, const swarf_progress *progress);

#endif
