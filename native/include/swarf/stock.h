/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock: a narrow-band level set (OpenVDB FloatGrid, mm, negative inside, half width 3 voxels).
 *
 * One thread per object: a call on a stock that is in use by another thread returns SWARF_ERROR_BUSY.
 * Inside, all cores work; results do not depend on their number. Long calls can be cancelled and leave a consistent
 * stock: a cut is done in batches of about a second's work on one thread, and a cancel takes effect after the one under
 * way, so that whole moves are cut or not. When a cut runs out of memory half way, read or copy nothing of the stock:
 * destroy it.
 */
#ifndef SWARF_STOCK_H
#define SWARF_STOCK_H

#include "cutter.h"
#include "program.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_stock swarf_stock;

typedef struct swarf_stock_options {
    size_t size;         /**< sizeof(swarf_stock_options) */
    double voxel_mm;     /**< edge of a voxel, > 0 */
    size_t memory_limit; /**< bytes the stock may need; 0: 80 % of what is free now */
} swarf_stock_options;

/** voxel 0 (must be set), no explicit memory limit. */
SWARF_API swarf_stock_options swarf_stock_options_default(void);

/** Bytes that a stock filling `box` may need at this voxel size while it is cut (an upper estimate for
 *  usual parts). SWARF_ERROR_ARGUMENT: empty or infinite box, voxel not finite or not positive. */
SWARF_API swarf_status swarf_stock_estimate(const swarf_box *box, double voxel_mm, size_t *bytes);

/** A block. SWARF_ERROR_MEMORY tells the estimate and a voxel size that would fit. */
SWARF_API swarf_status swarf_stock_create_box(const swarf_box *box, const swarf_stock_options *options,
                                              swarf_stock **out);
/** A round bar: from the centre of one end along the vector `axis` (its length is the bar's length). */
SWARF_API swarf_status swarf_stock_create_cylinder(const double base[3], const double axis[3], double radius,
                                                   const swarf_stock_options *options, swarf_stock **out);
/** From closed triangles. SWARF_ERROR_GEOMETRY when they are open or not oriented outwards (it says how many
 *  edges are open and where the first is); shells that cut each other are united, which the volume shows. */
SWARF_API swarf_status swarf_stock_create_mesh(const swarf_triangles *triangles, const swarf_stock_options *options,
                                               const swarf_progress *progress, swarf_stock **out);
/** From the first level set in a .vdb file. SWARF_ERROR_FORMAT / SWARF_ERROR_IO. voxel_mm is taken from it. */
SWARF_API swarf_status swarf_stock_read(const char *path, const swarf_progress *progress, swarf_stock **out);
/** To a .vdb file that other OpenVDB programs read; written beside and renamed, so that a failure loses nothing. */
SWARF_API swarf_status swarf_stock_write(swarf_stock *stock, const char *path, const swarf_progress *progress);
SWARF_API swarf_status swarf_stock_copy(swarf_stock *stock, swarf_stock **out);
/** NULL is legal. */
SWARF_API void swarf_stock_destroy(swarf_stock *stock);

SWARF_API double swarf_stock_voxel(const swarf_stock *stock);
/** Bounding box of the material in mm (to half a voxel); empty (lo > hi) when nothing is left. */
SWARF_API swarf_status swarf_stock_box(swarf_stock *stock, swarf_box *out);
/** Raised by every call that changes the stock; never 0. */
SWARF_API uint32_t swarf_stock_generation(const swarf_stock *stock);
/** Cubes of 32^3 voxels in which anything may have changed after generation `since` (0: all of them). The first `room`
 *  of their boxes (mm, halfway to the next voxels) go to `boxes`, their number to `count`. */
SWARF_API swarf_status swarf_stock_changed(swarf_stock *stock, uint32_t since, swarf_box *boxes, size_t room,
                                           size_t *count);
/** Volume in mm3, to the second order of the voxel h: besides 1e-4 of it, right-angled convex edges add up to h^2 / 4
 *  per mm of their length, and concave ones take as much away; a wall thinner than a voxel, t, adds (h - t)^2 / (4 h)
 *  per mm2 where it lies anyhow, nothing where one side is a plane halfway between voxel centres, and a gap takes as
 *  much away. */
SWARF_API swarf_status swarf_stock_volume(swarf_stock *stock, double *out);
/** 64-bit hash of all values, the same for the same content whatever the threads or kernels. */
SWARF_API swarf_status swarf_stock_hash(swarf_stock *stock, uint64_t *out);
/** Number of 8x8x8 leaves and bytes the tree holds. */
SWARF_API swarf_status swarf_stock_size(swarf_stock *stock, size_t *leaves, size_t *bytes);
/** Trilinear samples (mm) at `count` points (3 doubles each, mm); beyond the band +-3 voxels. */
SWARF_API swarf_status swarf_stock_sample(swarf_stock *stock, const double *points, size_t count, float *out);

/** Cut with the flutes of one cutter along `count` paths, all at once (their order does not matter). */
SWARF_API swarf_status swarf_stock_cut(swarf_stock *stock, const swarf_cutter *cutter, const swarf_path *paths,
                                       size_t count, const swarf_progress *progress);

typedef enum swarf_boolean { SWARF_UNION = 0, SWARF_INTERSECTION = 1, SWARF_DIFFERENCE = 2 } swarf_boolean;
/** stock = stock OP other; other is unchanged. SWARF_ERROR_ARGUMENT unless both have the same voxel size
 *  and their voxels coincide. */
SWARF_API swarf_status swarf_stock_boolean(swarf_stock *stock, swarf_stock *other, swarf_boolean operation);

/** How bad a finding is. */
typedef enum swarf_severity { SWARF_NOTE = 0, SWARF_WARNING = 1, SWARF_ERROR = 2 } swarf_severity;

typedef enum swarf_finding_kind {
    SWARF_FINDING_NO_TOOL = 0,  /**< moves before any tool is loaded */
    SWARF_FINDING_UNKNOWN_TOOL, /**< the tool is not in the table */
    SWARF_FINDING_NO_FLUTES,    /**< the tool cannot cut */
    SWARF_FINDING_AXIS,         /**< a turned or shifted pose */
    SWARF_FINDING_IDLE,         /**< an operation that removes nothing */
    SWARF_FINDING_COUNT
} swarf_finding_kind;

/** Something the simulation noticed. */
typedef struct swarf_finding {
    int32_t severity;
    int32_t kind; /**< swarf_finding_kind */
    int32_t axis; /**< of SWARF_FINDING_AXIS: 0..5, A, B, C, U, V, W */
    double value; /**< where that axis goes, degrees or mm */
    int32_t operation;
    size_t move;
    uint32_t line;
    int32_t tool;
    char text[196];
} swarf_finding;

/** A tool table entry. */
typedef struct swarf_tool {
    int32_t number;
    int32_t teeth; /**< cutting edges around the tool, for loads; 0: not known */
    const swarf_cutter *cutter;
} swarf_tool;

typedef struct swarf_simulation_options {
    size_t size;
    size_t batch;         /**< moves cut at once; 0: as many as share a tool and an operation; 1: move by move */
    int removed_per_move; /**< measure each move (implies batch 1) */
} swarf_simulation_options;
SWARF_API swarf_simulation_options swarf_simulation_options_default(void);

/** What a simulation came to. Owned by the caller; immutable. */
typedef struct swarf_simulation swarf_simulation;

/** Play moves first .. first + count - 1 of a program on a stock in order.
 *  A move whose tool is not in `tools` or has no flutes cuts nothing and gives a finding of class error (one per
 *  tool and operation); when the whole program is played, an operation with moves and a tool that removes nothing
 *  gives a note. SWARF_ERROR_CANCELLED leaves the moves played so far cut. */
SWARF_API swarf_status swarf_stock_simulate(swarf_stock *stock, const swarf_program *program, size_t first,
                                            size_t count, const swarf_tool *tools, size_t tool_count,
                                            const swarf_simulation_options *options, const swarf_progress *progress,
                                            swarf_simulation **out);
SWARF_API void swarf_simulation_destroy(swarf_simulation *simulation);
/** mm3 removed per operation of the program; the count is the program's operation count. */
SWARF_API const double *swarf_simulation_removed(const swarf_simulation *simulation, size_t *count);
/** mm3 removed per move played (NULL and 0 unless asked for). */
SWARF_API const double *swarf_simulation_removed_per_move(const swarf_simulation *simulation, size_t *count);
SWARF_API double swarf_simulation_volume_initial(const swarf_simulation *simulation);
SWARF_API double swarf_simulation_volume_final(const swarf_simulation *simulation);
/** "no tool", "unknown tool" ... */
SWARF_API const char *swarf_finding_name(swarf_finding_kind kind);
SWARF_API const swarf_finding *swarf_simulation_findings(const swarf_simulation *simulation, size_t *count);

#ifdef __cplusplus
}
#endif
#endif
