/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Checks, in time order: what a program does that it must not, seen against the stock as it is at that instant. */
#ifndef SWARF_CHECK_H
#define SWARF_CHECK_H

#include "load.h"
#include "solid.h"
#include "stock.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum swarf_check_kind {
    SWARF_CHECK_RAPID = 0, /**< a rapid goes through material */
    SWARF_CHECK_START,     /**< the first move of a tool starts inside the stock */
    SWARF_CHECK_SHANK,     /**< the shank goes into the stock */
    SWARF_CHECK_HOLDER,    /**< the holder goes into the stock */
    SWARF_CHECK_DEPTH,     /**< deeper than the flutes of a tool without shank and holder are long */
    SWARF_CHECK_NEAR,      /**< the holder comes nearer to the stock than the clearance */
    SWARF_CHECK_FIXTURE,   /**< any part goes into a fixture */
    SWARF_CHECK_DESIGN,    /**< any part goes into the design */
    SWARF_CHECK_SPINDLE,   /**< a feed move cuts with the spindle stopped, or turning backwards */
    SWARF_CHECK_FEED,      /**< a feed move without feed */
    SWARF_CHECK_PLUNGE,    /**< a tool that cannot plunges */
    SWARF_CHECK_TRAVEL,    /**< beyond the travel of the machine */
    SWARF_CHECK_TOOL,      /**< no tool, one that is not in the table, or has no flutes */
    SWARF_CHECK_COUNT
} swarf_check_kind;

typedef struct swarf_check_options {
    size_t size;
    const swarf_solid *const *fixtures; /**< clamps, vices, tables */
    size_t fixture_count;
    const swarf_solid *design; /**< NULL: not checked against */
    double design_mm;          /**< how deep flutes may go into the design */
    double clearance_mm;       /**< between holder and stock, at most 1000; 0: not looked at */
    swarf_box travel;          /**< of the tool's tip; as it comes: without end */
    const int32_t *no_plunge;  /**< numbers of tools that cannot plunge */
    size_t no_plunge_count;
    int32_t stop_on_first; /**< end with the first error */
    int32_t loads;         /**< measure the load of each move; costs several times the cutting */
} swarf_check_options;

/** Nothing but the stock, 0.05 mm for the design, no clearance, travel without end. */
SWARF_API swarf_check_options swarf_check_options_default(void);

typedef struct swarf_check_finding {
    int32_t severity; /**< swarf_severity */
    int32_t kind;     /**< swarf_check_kind */
    int32_t part;     /**< swarf_part_kind that touches */
    int32_t operation;
    size_t move;
    uint32_t line;
    int32_t tool;
    double t;        /**< 0..1 along the move: the first contact */
    double tip[3];   /**< of the tool then */
    double point[3]; /**< a voxel of the deepest contact of the whole move */
    double depth_mm; /**< how deep that is; no more than three voxels are told */
    char text[160];
} swarf_check_finding;

typedef struct swarf_check swarf_check;

/** Play moves first .. first + count - 1 as swarf_stock_simulate() does, and look at each before it is cut: what a
 *  move's own flutes remove is still there for its shank and holder. A contact counts from 0.06 voxel of depth
 *  (fixtures, design: 0.35), and its first instant is found by bisection. A batch of moves that touches nothing is cut
 *  whole, others are halved until the move is found. After twenty findings of one kind in one operation the others of
 *  it are left out. SWARF_ERROR_CANCELLED leaves the moves played so far cut. */
SWARF_API swarf_status swarf_stock_check(swarf_stock *stock, const swarf_program *program, size_t first, size_t count,
                                         const swarf_tool *tools, size_t tool_count, const swarf_check_options *options,
                                         const swarf_progress *progress, swarf_check **out);
SWARF_API void swarf_check_destroy(swarf_check *check);
/** What swarf_stock_simulate() tells of the same moves: removed volumes, moves that could not be simulated. Owned by
 *  the check. */
SWARF_API const swarf_simulation *swarf_check_simulation(const swarf_check *check);
/** Loads of the moves played; NULL unless asked for. Owned by the check. */
SWARF_API const swarf_loads *swarf_check_loads(const swarf_check *check);
/** In the order of the moves. */
SWARF_API const swarf_check_finding *swarf_check_findings(const swarf_check *check, size_t *count);
/** "rapid", "holder" ... */
SWARF_API const char *swarf_check_name(swarf_check_kind kind);

#ifdef __cplusplus
}
#endif
#endif
