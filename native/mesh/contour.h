/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Dual contouring: what its files share.
 *
 *   cell (i, j, k): the cube between the centres of voxels (i, j, k) and (i+1, j+1, k+1) of the stock's layout.
 *   crossing: where the surface crosses the grid edge from a voxel along +x, +y or +z; owned by that voxel's block.
 *   block: 8^3 voxels, the cells whose low corner they are, and the edges that start at them.
 *   cycle: one closed polygon of crossings on the faces of a cell; each gets one vertex, so that sheets that pass
 *   through one cell stay apart.
 *
 * Every crossing becomes a quadrilateral of the vertices of the four cells round its edge. Four passes over the blocks
 * (crossings, vertices, tiles, faces), each in parallel, each block written by one thread, numbered by prefix sums: the
 * result is the same for any number of threads.
 *
 *   tile: a cube of 2, 4 or 8 cells along an edge, of one block, in and about which the surface is one plane; its cells
 *   share the vertex of one of them, and their quadrilaterals become triangles or nothing.
 */
#ifndef SWARF_MESH_CONTOUR_H
#define SWARF_MESH_CONTOUR_H

#include "base/parallel.h"
#include "mesh/facets.h"
#include "mesh/known.h"
#include "stock/stock.h"
#include "swarf/mesh.h"

/** Voxels along an edge of what a block reads: itself, one below, two above. */
enum { SWARF_HALO = 11 };

/** A face of a cell, axis * 2 + side; none. */
enum { SWARF_NO_FACE = 255 };

/** How the crossings on the edges of one cell are joined. Edge number: axis * 4 + offset along the next axis * 2 +
 *  offset along the one after. */
typedef struct contour_case {
    uint8_t count;       /* cycles, 0 .. 4 */
    uint8_t of_edge[12]; /* cycle of a crossed edge */
    uint16_t edges[4];   /* of a cycle, a bit each */
    uint8_t
        twice_on_face; /* the face with four crossings that one cycle passes twice, SWARF_NO_FACE if there is none */
} contour_case;

/** By the signs of the corners (bit x * 4 + y * 2 + z set: material); [1]: the face twice_on_face joined the other
 *  way. */
typedef struct contour_table {
    contour_case entry[256][2];
} contour_table;

void swarf_contour_table_fill(contour_table *table);
/** Where the edges of a cell start, from the cell. */
extern const int swarf_contour_edge_offset[12][3];

/** A crossing, `t` from its voxel to the next, the normal out of the material. */
typedef struct contour_crossing {
    float t;
    float normal[3];
    int32_t move;  /* that made the surface there, -1: the first shape; or one of those below */
    int32_t piece; /* of the first shape or the cutter */
} contour_crossing;

/** Crossings known from the field alone: of a surface that lies elsewhere; from the face there, or those that meet
 *  beside it; or where it is flat, so that nothing else could tell more. */
enum { SWARF_BY_FIELD = -2, SWARF_BY_FACES = -3, SWARF_BY_FLAT_FIELD = INT32_MIN };

/** An active cell of a block. */
typedef struct contour_cell {
    uint16_t first; /* vertex, from the block's first one */
    uint8_t config; /* signs of its corners */
    uint8_t flip;   /* which entry of the table */
} contour_cell;

typedef struct contour_vertex {
    float xyz[3]; /* mm */
} contour_vertex;

typedef struct contour_block {
    int32_t ijk[3];
    uint32_t crossing_count;
    uint64_t edge_mask[3][8]; /* [axis][x], bit y * 8 + z */
    uint16_t edge_rank[3][8]; /* crossings before that word */
    uint64_t cell_mask[8];
    uint16_t cell_rank[8];
    uint64_t flat_mask[8];   /* cells with one vertex, whose crossings are all known from a flat field */
    uint64_t beside_mask[8]; /* cells with a vertex in a cell beside them */
    uint16_t inside[9][9];   /* signs of the corners of its cells, [x][y], bit z set: material */
    /* cells near facets that cut each other, each mask a part of the one before: */
    uint64_t keep_mask[8];   /* their vertices stay when others are left out */
    uint64_t own_mask[8];    /* and lie in them, not beside; also those that swarf_contour_unfold() took back */
    uint64_t calm_mask[8];   /* and are where the surface is smooth, their quadrilaterals cut into four */
    uint64_t middle_mask[8]; /* and are in the middle of their crossings, which never cut each other */
    uint64_t noted_mask[8];  /* to go one further */
    int noted;               /* any of them are */
    int changed;             /* vertices are to be placed again */
    int touched;             /* its facets may be others than at the last attempt */
    int amiss;               /* were touched at any attempt */
    int finished;            /* of the band before: only looked at */
    uint32_t vertex_count;
    uint32_t parted_count; /* more vertices than cells */
    uint32_t left_count;   /* vertices without those that others stand for */
    uint32_t facet_count;
    uint32_t full_count;   /* facets, had there been no tiles */
    uint32_t centre_count; /* vertices on crossings, of quadrilaterals cut into four */
    uint32_t sharp_count;  /* vertices on edges and corners of the surface */
    uint32_t exact_count;  /* vertices on the exact surface */
    double within;         /* its share of the volume within the surface, in voxels */
    float unseen;          /* material in voxels that no crossing is near, in voxels */
    float most;            /* greatest coordinate of its vertices, when they were last gathered */
    size_t vertex_first;   /* of those left, where they were last gathered */
    size_t centre_first;
    size_t facet_first;
    contour_crossing *crossings;
    contour_cell *cells;
    contour_vertex *vertices;
    uint16_t *tile; /* of a vertex: which of those left stands for it, and SWARF_TILED; NULL: all are left */
    uint16_t *left; /* of those left: their vertices; NULL: all are */
    contour_vertex *centres;
    swarf_facet *facets; /* corners as below */
} contour_block;

/** How a block's facets name their corners, so that they stay as they are when other blocks get more vertices: a centre
 *  by SWARF_CENTRE and its number in the block; else by which of its block's vertices left it is, and which block that
 *  is: in the upper half a bit for each axis along which it is the one below (4: x, 2: y, 1: z). */
#define SWARF_CENTRE 0x80000000u
#define SWARF_LEFT_MASK 0xffffu
enum { SWARF_BELOW_SHIFT = 16 };
/** Marks the vertices of a tile. */
#define SWARF_TILED 0x8000u

/** How far (as a part of the error asked for) vertices in and about a tile lie from its plane, and from each other the
 *  surface with tiles and without. Planes of neighbouring tiles have two rows of vertices in common for every four
 *  along their edge, so that they part by 4 times the first per row; what bends where they meet is a chord's middle, 2
 *  rows from there, and both surfaces have the first for themselves. */
#define SWARF_TILE_FLAT 0.005
#define SWARF_TILE_ERROR (10 * SWARF_TILE_FLAT)

/** A part of the stock that is made on its own: the edges of the voxels first .. end - 1 along x, in layers of blocks.
 *
 *   below first     one layer, finished by the band before
 *   first .. end    joined, simplified, written
 *   from end on     a layer that is joined and simplified too, so that facets of both sides are kept from cutting each
 *                   other, and made again by the next band; one placed and one crossed, as those below look there
 *
 *  What two bands share are the vertices of the cells beside the plane between them, which stay. */
typedef struct contour_band {
    int32_t first, end; /* multiples of SWARF_LEAF_DIM */
    double step;        /* mm; positions of all bands are rounded to multiples of it */
    swarf_facets below; /* finished facets that reach into it */
} contour_band;

typedef struct contour {
    const swarf_stock *stock;
    const swarf_tree_layout *layout;
    const swarf_surface *surface; /* NULL: the field alone */
    size_t moves;                 /* of the surface that the stock has seen */
    double error_mm;              /* that may be spent */
    const contour_band *band;     /* NULL: all of the stock */
    contour_table table;
    contour_block *blocks;
    size_t block_count;
    uint32_t *block_at; /* by node * 4096 + slot; UINT32_MAX: none */
} contour;

/** SWARF_ERROR_ARGUMENT: of another version, or they ask for what cannot be. */
swarf_status swarf_contour_check(const swarf_contour_options *options);
/** Check the options and enter the stock for reading; its caller leaves it. */
swarf_status swarf_contour_begin(swarf_stock *stock, const swarf_contour_options *options, contour *out);
/** Blocks that cells of the surface may lie in, those of the band and about it. */
swarf_status swarf_contour_blocks(contour *work);
/** The part of the error that shifting vertices may take to keep the volume. A face that bends evenly takes two thirds
 * of what leaving vertices out took. */
#define SWARF_REGAIN_PART 0.2
/** All passes, until no facets cut each other: the facets of the band, and what they came to (added to *report). The
 *  blocks are there; those that are finished stay as they are. */
swarf_status swarf_contour_settle(contour *work, const swarf_contour_options *options, const swarf_progress *progress,
                                  swarf_facets *facets, swarf_contour_report *report);
/** Facets that cut each other, those of two other bands aside. */
typedef struct contour_pairs {
    swarf_facet_pair *pair; /**< the caller's to free() */
    size_t count;
    size_t fresh; /**< that the band before has not seen, those of the layer above among them */
    size_t last;  /**< that the next band will not see again */
} contour_pairs;

/** Pairs of facets that are not both known; where there are any, `known` are then these facets. The facets stay, with
 * all vertices, behind which come those of the band below. */
swarf_status swarf_contour_pairs_find(const contour *work, swarf_facets *facets, swarf_facets_known *known,
                                      const swarf_progress_share *share, contour_pairs *out);
/** Note the cells of the surface where the boxes of two facets that cut each other overlap, and two voxels round it. */
void swarf_contour_note(contour *work, const swarf_facets *facets, const swarf_facet_pair *pair);
/** The next remedy for the cells noted: the blocks to be placed again are then `changed`, those about them touched.
 *  `all_kept`: no vertices are left out as it is. */
void swarf_contour_take_care(contour *work, int all_kept);
/** Whether a block is of the band or within so many layers above it. */
static inline int swarf_contour_is_within(const contour *work, const contour_block *block, int above)
{
    const contour_band *band = work->band;
    return !band || (block->ijk[0] >= band->first && block->ijk[0] < band->end + above * SWARF_LEAF_DIM);
}
/** The passes, one block each. */
swarf_status swarf_contour_cross(contour *work, contour_block *block);
swarf_status swarf_contour_place(contour *work, contour_block *block);
/** Vertices beside their cells that fold a quadrilateral are to be placed again, in their cells: the block is then
 *  `changed`. Reads those of the blocks about it. */
swarf_status swarf_contour_unfold(contour *work, contour_block *block);
swarf_status swarf_contour_tile(contour *work, contour_block *block);
/** No tiles, all vertices. */
void swarf_contour_untile(contour_block *block);
swarf_status swarf_contour_join(contour *work, contour_block *block);

/** Some of the blocks, by their numbers; the first so many with their facets, and with all blocks that these name. */
typedef struct contour_choice {
    uint32_t *block;
    size_t count, joined;
} contour_choice;

/** The vertices and facets of the chosen blocks (NULL: of all) as one surface, in the memory of *out where that is
 *  enough. *marks (NULL: none are wanted) are the caller's to free: locked are the vertices of cells that care was
 *  taken of, and those that bands share, known those of blocks that were not touched. */
swarf_status swarf_contour_gather(contour *work, const contour_choice *choice, swarf_facets *out, uint8_t **marks);
/** Look at the touched blocks alone, with all vertices there, and note the cells that care was taken of and whose
 *  facets still cut each other; *count: pairs of them. The blocks are left to be tiled and joined again. */
swarf_status swarf_contour_look(contour *work, size_t *count);
/** Which edges were split, and where, so that later attempts need not look again. Starts as zeros. */
typedef struct swarf_crease_memo {
    struct crease_split *splits;
    size_t count, room;
    uint32_t *slots; /* their numbers + 1, 0: empty */
    size_t slot_count;
} swarf_crease_memo;

void swarf_crease_memo_free(swarf_crease_memo *memo);

/** Split edges of facets that leave the exact surface where its faces meet; those of vertices whose *marks are
 *  SWARF_VERTEX_LOCKED stay. *marks (NULL: none) grow with the vertices; *made: those of this band. */
swarf_status swarf_contour_crease(const contour *work, swarf_facets *facets, uint8_t **marks, swarf_crease_memo *memo,
                                  const swarf_progress *progress, double from, double to, size_t *made);
void swarf_contour_free(contour *work);
/** Free the blocks only. */
void swarf_contour_clear(contour *work);
void swarf_contour_block_free(contour_block *block);

/** A crossing on the exact surface, from what the field makes of it; `a`: the edge's voxel in mm, `outwards`: that is
 *  material. Where there is no such surface the crossing stays as it is. */
void swarf_contour_cross_exact(const swarf_surface_near *near, const double a[3], double voxel, int axis, int outwards,
                               contour_crossing *crossing);

/** Values of a block's voxels with their halo: index ((x + 1) * 11 + y + 1) * 11 + z + 1. */
void swarf_contour_fetch(const contour *work, const int32_t ijk[3], float values[SWARF_HALO * SWARF_HALO * SWARF_HALO]);
/** The block that holds a voxel, NULL where there is none. */
contour_block *swarf_contour_block_at(const contour *work, const int32_t ijk[3]);
/** The block below along the axes of a mask (4: x, 2: y, 1: z). */
static inline contour_block *swarf_contour_block_below(const contour *work, const contour_block *block, int below)
{
    int32_t corner[3];
    for (int k = 0; k < 3; k++) corner[k] = block->ijk[k] - (below >> (2 - k) & 1) * SWARF_LEAF_DIM;
    return swarf_contour_block_at(work, corner);
}
/** The block that holds a voxel, at[] from the corner of `near`, which most often it is. */
static inline const contour_block *swarf_contour_block_near(const contour *work, const contour_block *near,
                                                            const int at[3])
{
    if (!((at[0] | at[1] | at[2]) & ~7)) return near;
    const int32_t voxel[3] = {near->ijk[0] + at[0], near->ijk[1] + at[1], near->ijk[2] + at[2]};
    return swarf_contour_block_at(work, voxel);
}
/** How many bits of a mask are set below one: what __builtin_popcountll() is a call for where the processor need not
 *  have it. */
static inline unsigned swarf_contour_below(uint64_t mask, int bit)
{
    uint64_t x = mask & ((UINT64_C(1) << bit) - 1);
    x -= x >> 1 & UINT64_C(0x5555555555555555);
    x = (x & UINT64_C(0x3333333333333333)) + (x >> 2 & UINT64_C(0x3333333333333333));
    x = (x + (x >> 4)) & UINT64_C(0x0f0f0f0f0f0f0f0f);
    return (unsigned)(x * UINT64_C(0x0101010101010101) >> 56);
}
/** The crossing of the edge from a voxel, at[] from the corner of `near`; NULL where there is none. */
static inline const contour_crossing *swarf_contour_crossing(const contour *work, const contour_block *near,
                                                             const int at[3], int axis)
{
    const contour_block *block = swarf_contour_block_near(work, near, at);
    const int x = at[0] & 7, bit = (at[1] & 7) * 8 + (at[2] & 7);
    if (!block) return NULL;
    const uint64_t word = block->edge_mask[axis][x];
    if (!(word >> bit & 1)) return NULL;
    return block->crossings + block->edge_rank[axis][x] + swarf_contour_below(word, bit);
}
/** What the exact surface can be in the eight parts of a block, and in their own eight parts, collected for all and
 *  narrowed when first asked for: the smaller the box, the fewer moves a point has to look at. */
typedef struct contour_near {
    const contour *work;
    const contour_block *block;
    swarf_surface_near *all, *part[8], *small[64];
    swarf_surface_near *wide;
} contour_near;

/** Of the part that holds a cell of the block, at[] in 0 .. 7; NULL without a surface. Owned by `near`. */
swarf_status swarf_contour_near_get(contour_near *near, const int at[3], const swarf_surface_near **out);
/** For a cell that is looked at from many points: of the part's part that holds it, where that pays. */
swarf_status swarf_contour_near_narrow(contour_near *near, const int at[3], const swarf_surface_near **io);
/** Of a cell and those about it; owned by `near` until the next call. */
swarf_status swarf_contour_near_wide(contour_near *near, const int at[3], const swarf_surface_near **out);
void swarf_contour_near_free(contour_near *near);

/** Where a vertex may lie, in voxels from the low corner of its cell. */
typedef struct contour_bounds {
    double lo[3], hi[3];
} contour_bounds;

/** What is known of one cycle, in voxels from the low corner of its cell. */
typedef struct contour_polygon {
    int count;
    double point[12][3];
    double normal[12][3];
    int32_t move[12];
    int32_t piece[12];
    uint8_t edge[12]; /* number of its edge in the cell */
    double corner[8]; /* the field, in voxels */
    contour_bounds bounds;
    double origin[3]; /* of the cell, in mm */
    double voxel;     /* in mm */
} contour_polygon;

/** Vertices keep this far (in voxels) from the sides of their cell, so that those of two cells never fall together; it
 *  is a hundredth of the error that the mesh promises. */
#define SWARF_CONTOUR_MARGIN 1e-4

/** Where nothing else keeps facets from cutting each other, crossings stay this far from voxels, so that positions
 *  rounded to floats keep apart; it is what the mesh promises. */
#define SWARF_CONTOUR_LAST_MARGIN 1e-2

/** Place the vertex of a cycle inside its cell; returns how many independent faces meet there (1 smooth, 2 on an edge,
 *  3 on a corner). */
int swarf_contour_vertex(const contour_polygon *polygon, double out[3]);
/** The same on the exact surface; the polygon has only crossings that this made, one at least. */
int swarf_contour_vertex_exact(const contour_polygon *polygon, const swarf_surface_near *near, double out[3]);

/** The same where the surface is taken as smooth. */
void swarf_contour_vertex_smooth(const contour_polygon *polygon, const swarf_surface_near *near, double out[3]);

/** A face that a vertex lies on. */
typedef struct contour_plane {
    double point[3];
    double normal[3]; /* unit */
} contour_plane;

/** The vertex of a cycle in the cell `at` of the block where the field is flat and the exact surface, if there is one,
 *  has the same plane: sets *flat, 0 where it is another vertex. */
swarf_status swarf_contour_vertex_flat(contour_near *near, const int at[3], const contour_polygon *polygon,
                                       double out[3], int *flat);

/** Middle of the crossings. */
void swarf_contour_middle(const contour_polygon *polygon, double out[3]);
/** Point that the planes have in common, the nearest to `about` where they leave a choice; moved along an edge into the
 *  bounds where that is possible. What eigenvalues below `least` of the greatest carry is left out. Returns the rank.
 */
int swarf_contour_meet(const contour_plane *planes, int count, const double about[3], double least,
                       const contour_bounds *bounds, double out[3]);
/** Onto one smooth face from the middle of its crossings, all but: as the planes at these are as far above it as the
 *  middle is below where it bends, to half of the way between. */
void swarf_contour_rise(const contour_polygon *polygon, double x[3]);
/** Move into the bounds; 1 when it was not. */
int swarf_contour_clamp(const contour_bounds *bounds, double x[3]);

#endif
