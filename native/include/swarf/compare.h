/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Compare: the stock against the design model. */
#ifndef SWARF_COMPARE_H
#define SWARF_COMPARE_H

#include "solid.h"
#include "stock.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Stock and design by volume, mm3. */
typedef struct swarf_comparison {
    double design_mm3; /**< volume of the design's triangles */
    double stock_mm3;
    double excess_mm3; /**< stock outside the design: material left */
    double gouge_mm3;  /**< design outside the stock: material missing */
} swarf_comparison;

/** Compare by volume: the design's exact distance is taken at the stock's own voxels and both differences are
 *  integrated. A voxel of both counts by how much of it each fills and by the angle between their surfaces, so that
 *  surfaces that coincide leave nothing over. The stock is unchanged. SWARF_ERROR_BUSY as all calls on a stock. */
SWARF_API swarf_status swarf_compare_volume(swarf_stock *stock, const swarf_solid *design,
                                            const swarf_progress *progress, swarf_comparison *out);

/** How the surface of a stock is to be held against a design. */
typedef struct swarf_deviation_options {
    size_t size;
    double excess_mm;      /**< material may stand out by this much; above 0, at most 1e6 */
    double gouge_mm;       /**< material may be missing by this much; above 0, at most 1e6 */
    double allowance_mm;   /**< material that is meant to be left on the design; -1e6 to 1e6 */
    swarf_box region;      /**< only in here; as it comes: everywhere */
    const uint8_t *ignore; /**< one for each triangle the design was given: 1 where it is not to be measured; or NULL */
    size_t ignore_count;
    const swarf_stock *first; /**< the stock as it was before the first cut, to tell where no move went; or NULL */
} swarf_deviation_options;

/** 0.05 mm both ways, no allowance, everywhere, the whole design, no first stock. */
SWARF_API swarf_deviation_options swarf_deviation_options_default(void);

/** Places where the deviation is beyond tolerance, within some three voxels of each other. */
typedef struct swarf_cluster {
    int32_t excess;  /**< 1: material left; 0: a gouge, material missing */
    int32_t reached; /**< 0: all of it lies on the first stock, where no move went (needs options.first) */
    double value_mm; /**< the greatest deviation, positive outwards */
    int32_t
        at_least; /**< 1: it is a feature that no surface of the stock shows; value_mm is only known to be as much */
    int32_t reserved;
    double place[3];     /**< where that is, on the surface of the stock (or, see at_least, of the design) */
    double area_mm2;     /**< of the stock's surface beyond tolerance (see at_least: of the design's) */
    double volume_mm3;   /**< between stock and design in and around these places */
    swarf_box box;       /**< of the places */
    uint32_t triangle;   /**< of the design, nearest to the place */
    uint32_t move_count; /**< of `moves` */
    int64_t moves[4];    /**< see swarf_deviation_find_moves() */
    double away_mm;      /**< how far the nearest cut stays from the place (excess) */
} swarf_cluster;

typedef struct swarf_deviation_sums {
    swarf_comparison volumes;
    size_t points;     /**< measured on the stock's surface: where it crosses the grid of voxel centres */
    double area_mm2;   /**< of the surface they stand for */
    double design_mm2; /**< of the design's surface held against the stock */
    double mean_mm, rms_mm, least_mm, most_mm; /**< where the surface is smooth and some move went */
    double percentile_mm[7];                   /**< of these: 1, 5, 25, 50, 75, 95, 99 % of the area lie below */
    double excess_mm2, gouge_mm2;              /**< beyond tolerance */
    double not_reached_mm2;                    /**< excess on the first stock, where no move went */
    double error_mm; /**< how far a value may be off: 0.02 voxel on smooth faces (half a voxel within one of an edge,
                        where only more than that beyond tolerance counts) */
    int32_t passed;  /**< no cluster is a gouge or an excess that a move reached */
    int32_t reserved;
} swarf_deviation_sums;

/** What the points of a deviation can be. */
enum { SWARF_POINT_EDGE = 1, SWARF_POINT_UNTOUCHED = 2, SWARF_POINT_IGNORED = 4 };

/** The deviation of a stock from its design. Immutable but for swarf_deviation_find_moves(). Any thread. */
typedef struct swarf_deviation swarf_deviation;

/** Measure the stock's surface against the design, and the design's against the stock for features that are missing
 *  altogether. The stocks are unchanged. SWARF_ERROR_ARGUMENT: a tolerance that is not positive, an allowance that is
 *  not finite, an ignore_count that is not the number of triangles the design was given. */
SWARF_API swarf_status swarf_deviation_create(swarf_stock *stock, const swarf_solid *design,
                                              const swarf_deviation_options *options, const swarf_progress *progress,
                                              swarf_deviation **out);
/** Judge what a deviation was measured from by other options - tolerances, allowance, region, what to ignore - without
 *  measuring again: some 30 ms for a million points, then the clusters. What lies on the first stock was found when it
 *  was measured, options.first is not looked at; moves have to be found again. Stock and design may be gone. Owns a
 *  share of the measurement: either may be destroyed first. Statuses as above. */
SWARF_API swarf_status swarf_deviation_judge(const swarf_deviation *measured, const swarf_deviation_options *options,
                                             const swarf_progress *progress, swarf_deviation **out);
SWARF_API void swarf_deviation_destroy(swarf_deviation *deviation);
SWARF_API swarf_deviation_sums swarf_deviation_get_sums(const swarf_deviation *deviation);
/** The clusters, those that fail first, the largest volume first. */
SWARF_API const swarf_cluster *swarf_deviation_clusters(const swarf_deviation *deviation, size_t *count);
/** The points on the stock's surface: 3 floats each (mm), deviations (mm, positive: material left), SWARF_POINT_ bits.
 */
SWARF_API size_t swarf_deviation_points(const swarf_deviation *deviation, const float **xyz, const float **value,
                                        const uint8_t **kind);
/** mm2 of the surface in `bins` equal steps of the deviation from lo to hi; what is beyond counts in the outer ones. */
SWARF_API swarf_status swarf_deviation_histogram(const swarf_deviation *deviation, double lo, double hi, size_t bins,
                                                 double *out);
/** Find the moves behind each cluster's worst place: of a gouge those whose flutes pass through it, the first cut
 *  first; of an excess the feeds (where there is none, the rapids) that come nearest, within half a cutter and three
 *  voxels, the last cut first. Up to four that come about as near. After SWARF_ERROR_CANCELLED clusters have any moves.
 */
SWARF_API swarf_status swarf_deviation_find_moves(swarf_deviation *deviation, const swarf_program *program,
                                                  const swarf_tool *tools, size_t tool_count,
                                                  const swarf_progress *progress);

typedef enum swarf_place_kind {
    SWARF_PLACE_WELL = 0, /**< all looks well */
    SWARF_PLACE_UNIT,     /**< `value` times as large as the stock, as in the wrong one of two units `factor` apart */
    SWARF_PLACE_EMPTY,    /**< nothing is left of the stock */
    SWARF_PLACE_BESIDE,   /**< their boxes do not touch */
    SWARF_PLACE_OUT,      /**< reaches `value` mm out of the stock */
    SWARF_PLACE_COUNT
} swarf_place_kind;

typedef struct swarf_place {
    int32_t kind; /**< swarf_place_kind */
    double value, factor;
    char text[320]; /**< for people; "" when all looks well */
} swarf_place;

/** Whether a design can hardly belong to a stock: beside it, larger than it, or in another unit. */
SWARF_API swarf_status swarf_compare_place(swarf_stock *stock, const swarf_solid *design, swarf_place *out);
/** "", "unit", "empty", "beside", "out". */
SWARF_API const char *swarf_place_name(swarf_place_kind kind);

/** How deep (mm) a solid - a fixture - reaches into a stock, and a voxel's centre where; no more than six voxels are
 *  told. Where faces meet it is good to a hundredth of a voxel; beside edges distances run short, so that up to 0.35
 *  voxel of depth may be told where nothing overlaps: the caller takes no more than that for none. */
SWARF_API swarf_status swarf_compare_overlap(swarf_stock *stock, const swarf_solid *solid,
                                             const swarf_progress *progress, double *depth, double point[3]);

/** Deviations (mm, positive: material left, less an allowance) of the `count` pixels of a picture that see the stock,
 *  NAN for the others. `position` has 3 doubles and `seen` a swarf_seen per pixel, as swarf_picture_buffers has them.
 *  Any thread, all cores. SWARF_ERROR_ARGUMENT: NULL, an allowance that is not finite. */
SWARF_API swarf_status swarf_deviation_pixels(const swarf_solid *design, const double *position, const uint8_t *seen,
                                              size_t count, double allowance, const swarf_progress *progress,
                                              double *value);
/** The same of a picture of the design: what the stock lacks or has too much where the design's surface is seen. Told
 *  by the level set, on faces to a hundredth of a voxel up to two voxels and to a fifth beyond; INFINITY or -INFINITY
 *  beyond its band of three. All cores; one call at a time in the stock. SWARF_ERROR_ARGUMENT, SWARF_ERROR_BUSY,
 *  SWARF_ERROR_CANCELLED. */
SWARF_API swarf_status swarf_deviation_design_pixels(swarf_stock *stock, const double *position, const uint8_t *seen,
                                                     size_t count, double allowance, const swarf_progress *progress,
                                                     double *value);

/** Tint `count` shaded pixels (RGBA, 8 bits, sRGB) by their deviations: green within +-tolerance, by yellow to red for
 *  material left and by cyan to blue for material missing at +-4 tolerances and beyond; NAN leaves a pixel as it is.
 *  SWARF_ERROR_ARGUMENT: NULL, a tolerance that is not positive. */
SWARF_API swarf_status swarf_deviation_colours(const double *value, size_t count, double tolerance, uint8_t *rgba);

#ifdef __cplusplus
}
#endif
#endif
