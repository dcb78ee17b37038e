/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The inner loops of pictures, one table per instruction set. All variants do the same operations on the same sixteen
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

/** Most packets that are traced together: while one waits for the memory the others go on. */
enum { SWARF_GROUP = 4 };

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
 *  the eye, or, with parallel rays, along forward from eye + x * right + y * up. */
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
    double t[SWARF_PACKET];            /**< how far to look; then: of the hit */
    float normal[3][SWARF_PACKET];     /**< unit, of the hit */
} swarf_packet;

/** Smaller components of directions are made this: it leads no ray astray by more than rounding does, and its inverse
 *  times the layout's size is still a float. */
#define SWARF_RAY_LEAST 1e-12

/** Voxels that rays go on beyond the box of all that can be met: what lies in its faces is met whatever rounding
 *  does. */
#define SWARF_RAY_SLACK 1e-3

/** A slot of a cube (see cube.h). */
typedef struct swarf_cube_slot {
    uint64_t stop[8];       /**< word (x * 2 + y) * 2 + z for each block, in it bit (x * 4 + y) * 4 + z for each cell */
    const float *values[8]; /**< of this slot and its upper neighbours; number bits 4, 2, 1: one up in x, y, z */
} swarf_cube_slot;

/** Cells and blocks of 4^3 cells along the edge of a cube. */
enum { SWARF_CUBE_SHIFT = 5, SWARF_CUBE_CELLS = 1 << SWARF_CUBE_SHIFT, SWARF_CUBE_BLOCKS = SWARF_CUBE_CELLS / 4 };

typedef struct swarf_cube {
    uint64_t block[8]; /**< word x, bit y * 8 + z: the block has cells that stop rays */
    uint8_t place[64]; /**< of slot (x * 4 + y) * 4 + z in `slots`, if it has such blocks */
    swarf_cube_slot *slots;
    int32_t corner[3];
    uint32_t slot_count, slot_room;
    uint8_t lo[4], hi[4]; /**< the cells that stop rays lie in lo .. hi - 1 of the cube; lo == hi: there are none */
} swarf_cube;

/** Cube (x, y, z), 0 .. count - 1 each, has the number (x * count[1] + y) * count[2] + z; its low corner is voxel
 *  32 * (x - 2, y - 2, z - 2) of the layout. Cells below the layout's first voxels belong to slots outside it; and the
 *  outermost cubes are never there, so that a ray may step into them unchecked. */
typedef struct swarf_cube_grid {
    int32_t count[3];
    swarf_cube **cube; /**< NULL where nothing stops a ray */
} swarf_cube_grid;

/** Cubes before the layout's first voxel. */
enum { SWARF_CUBES_BELOW = 2 };

/** What the light falls on, and where it comes from (unit). */
typedef struct swarf_tones {
    float base[3][SWARF_PACKET]; /**< linear RGB */
    float normal[3][SWARF_PACKET];
    float sky[SWARF_PACKET],
        sun[SWARF_PACKET]; /**< how much of the sky is open, and whether light gets there: 0 .. 1 */
    float light[3];
} swarf_tones;

/** Steps of linear light that have a byte each. */
enum { SWARF_SRGB_SIZE = 1 << 14 };

typedef struct swarf_ray_kernel {
    /** Rays through places x[i], y[i], with endless reach, all sixteen. */
    void (*aim)(const swarf_ray_source *source, const double x[SWARF_PACKET], const double y[SWARF_PACKET],
                swarf_rays *out);
    /** Put rays on their way from where they enter the box, moved[i] voxels from their origin (0: that lies in it).
     *  Returns the bits of the active ones that meet the box within their reach. */
    unsigned (*enter)(const swarf_ray_space *space, const swarf_rays *rays, swarf_packet *out,
                      double moved[SWARF_PACKET]);
    /** Where the rays active[i] (a bit per lane) of `count` <= SWARF_GROUP packets first enter the material within
     *  their reach t; active[i] becomes the bits of those that do. The rays start outside of it. */
    void (*trace)(const swarf_cube_grid *grid, swarf_packet rays[], unsigned active[], int count);
    /** Bit y * 8 + z of word x: whether value x * 64 + y * 8 + z is below 0. */
    void (*signs)(const float values[512], uint64_t words[8]);
    /** Linear RGB of sixteen pixels. */
    void (*shade)(const swarf_tones *in, float out[3][SWARF_PACKET]);
    /** Four colours, RGBA linear and premultiplied, to bytes that are not, by a table of sRGB. */
    void (*encode)(const float colour[16], const int32_t srgb[SWARF_SRGB_SIZE + 1], uint8_t out[16]);
    /** The same of sixteen opaque colours by channel, for the places whose bit is set; the others stay. */
    void (*encode_opaque)(const float rgb[3][SWARF_PACKET], const int32_t srgb[SWARF_SRGB_SIZE + 1], unsigned which,
                          uint8_t out[4 * SWARF_PACKET]);
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
