/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The inner loops of tracing, one table per instruction set. All variants do the same operations on the same sixteen
 * lanes in the same order, without contraction, and what one lane computes never depends on the others: hits are the
 * same bits for any instruction set and any grouping of rays. */
#ifndef SWARF_RENDER_RAY_KERNEL_H
#define SWARF_RENDER_RAY_KERNEL_H

#include "swarf/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Most rays of one packet. */
enum { SWARF_PACKET = 16 };

/** Rays in mm, and what they met. */
typedef struct swarf_rays {
    double origin[3][SWARF_PACKET];
    double direction[3][SWARF_PACKET]; /**< unit */
    double reach[SWARF_PACKET];        /**< how far to look */
    double distance[SWARF_PACKET];     /**< out: to the hit, INFINITY without one */
    float normal[3][SWARF_PACKET];     /**< out: of the hit, unit */
    unsigned active;                   /**< a bit per ray */
    unsigned hit;                      /**< out: a bit per ray that met the surface within its reach */
} swarf_rays;

/** Where the rays of a picture come from: place (x, y), -1 .. 1 each, is seen along forward + x * right + y * up from
 * the eye, or, with parallel rays, along forward from eye + x * right + y * up. */
typedef struct swarf_ray_source {
    double eye[3], forward[3], right[3], up[3];
    double back; /**< rays start this far (mm) behind that */
    int parallel;
} swarf_ray_source;

/** From mm to voxels of the layout, and the box (in voxels) of all that can be met. */
typedef struct swarf_ray_space {
    double origin[3], voxel;
    double lo[3], hi[3];
} swarf_ray_space;

/** Rays on their way, in voxels of the layout. */
typedef struct swarf_packet {
    double origin[3][SWARF_PACKET];
    double direction[3][SWARF_PACKET]; /**< unit, no component nearer to 0 than SWARF_RAY_LEAST */
    double inverse[3][SWARF_PACKET];   /**< 1 / direction */
    double t[SWARF_PACKET];            /**< of the first hit so far; before: how far to look */
    uint32_t cube[SWARF_PACKET];       /**< number of the cube hit, UINT32_MAX before */
    float normal[3][SWARF_PACKET];     /**< unit, set on a hit */
} swarf_packet;

/** Smaller components of directions are made this: it leads no ray astray by more than rounding does, and its inverse
 *  times the layout's size is still a float. */
#define SWARF_RAY_LEAST 1e-12

/** A slot of a cube (see cube.h). */
typedef struct swarf_cube_slot {
    uint64_t stop[8];       /**< word x, bit y * 8 + z */
    const float *values[8]; /**< of this slot and its upper neighbours; number bits 4, 2, 1: one up in x, y, z */
} swarf_cube_slot;

typedef struct swarf_cube {
    swarf_cube_slot *slots;
    int32_t entry[64];
    const float *own[64]; /**< of each slot in `slots`: its values[0], at hand without a look into memory far away */
    int32_t corner[3];
    uint32_t slot_count, slot_room;
    uint8_t lo[3], hi[3]; /**< the cells that stop rays lie in lo .. hi - 1 of the cube; lo == hi: there are none */
} swarf_cube;

typedef struct swarf_ray_kernel {
    /** Rays through places x[i], y[i], with endless reach, all sixteen. */
    void (*aim)(const swarf_ray_source *source, const double x[SWARF_PACKET], const double y[SWARF_PACKET],
                swarf_rays *out);
    /** Put rays on their way from where they enter the box, moved[i] voxels from their origin (0: that lies in it).
     *  Returns the bits of the active ones that meet the box within their reach. */
    unsigned (*enter)(const swarf_ray_space *space, const swarf_rays *rays, swarf_packet *out,
                      double moved[SWARF_PACKET]);
    /** Where rays `active` (a bit per lane) first enter the material in this cube. Updates what is hit before t (at
     *  the same t: in the cube of lower number, so that the order of visits does not matter) and returns those bits.
     *  The rays start outside the material. */
    unsigned (*trace)(const swarf_cube *cube, uint32_t number, swarf_packet *rays, unsigned active);
    /** Bit y * 8 + z of word x: whether value x * 64 + y * 8 + z is below 0. */
    void (*signs)(const float values[512], uint64_t words[8]);
} swarf_ray_kernel;

/** The kernels of swarf_isa_current(). */
const swarf_ray_kernel *swarf_ray_kernel_current(void);

extern const swarf_ray_kernel swarf_ray_kernel_scalar;
#if defined(SWARF_HAVE_X86)
extern const swarf_ray_kernel swarf_ray_kernel_avx2;
extern const swarf_ray_kernel swarf_ray_kernel_avx512;
#endif

#ifdef __cplusplus
}
#endif
#endif
