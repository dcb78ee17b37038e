/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Mesh: triangles of a stock or a design, their measures and file formats. Immutable, shared, any thread; calls that
 * take a stock are, as all of these, for one thread at a time. */
#ifndef SWARF_MESH_H
#define SWARF_MESH_H

#include "surface.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_mesh swarf_mesh;

/** Copies the triangles. SWARF_ERROR_ARGUMENT for an index out of range or numbers not finite. */
SWARF_API swarf_status swarf_mesh_create(const swarf_triangles *triangles, swarf_mesh **out);
/** From a stock by OpenVDB's mesher; adaptivity 0 (uniform) .. 1. Closed and oriented outwards, or
 *  SWARF_ERROR_INTERNAL; an empty stock gives an empty mesh. Edges come out rounded, and an adaptivity above 0 loses
 *  volume: swarf_mesh_contour() does neither. */
SWARF_API swarf_status swarf_mesh_create_stock(swarf_stock *stock, double adaptivity, const swarf_progress *progress,
                                               swarf_mesh **out);

/** How a stock becomes a mesh with sharp edges. */
typedef struct swarf_contour_options {
    size_t size;                  /**< sizeof(swarf_contour_options) */
    double error_mm;              /**< 0 to 1e6; vertices are left out while the mesh stays this near to the full one */
    size_t triangle_budget;       /**< no more triangles than this within error_mm, not 0 then; 0: no limit */
    const swarf_surface *surface; /**< of the stock, borrowed for the call; NULL: the field alone */
    size_t moves;                 /**< the stock is the surface after its first so many moves */
    /** 0 or 1. 1: triangles that leave the surface, as beside edges closer to each other than a voxel and at wedges
     *  narrower than one, are split where its faces meet; no effect without a surface. It takes half as long again on
     *  a large part, several times as long where most of the surface is such edges. In bands the row of cells beside
     *  each plane between two stays as it is. */
    int fine;
    /** 0 or 1. 1: vertices are shifted, by a fifth of the error at most (where that is 0 by a hundredth of a voxel), so
     *  that the volume of the mesh becomes surface_mm3 of its report, or comes as near to it as that allows: flat
     *  triangles with their corners on a curved surface have another. That fifth is kept for it, so there are more
     *  triangles. Corners of triangles that would turn or cut others stay, and those along the planes between bands;
     *  what `fine` adds by splitting is not taken elsewhere. With a budget it is a fifth of the error that met it. */
    int keep_volume;
} swarf_contour_options;

/** Error 0 (every vertex), no budget, no surface; all of its moves; not fine. */
SWARF_API swarf_contour_options swarf_contour_options_default(void);

/** What making a mesh came to. */
typedef struct swarf_contour_report {
    size_t full_triangles;      /**< before vertices were left out */
    size_t triangles;           /**< in the mesh */
    size_t sharp_vertices;      /**< on edges and corners, before vertices were left out */
    size_t exact_vertices;      /**< on the exact surface, before vertices were left out */
    size_t parted_cells;        /**< cells that the surface passes more than once */
    size_t intersections_found; /**< pairs of triangles that cut each other and were put right */
    size_t intersections_left;  /**< pairs that still do: 0 unless the surface itself touches itself */
    double error_mm;            /**< bound of the distance between the mesh and the full one */
    int budget_met;             /**< 0 when error_mm stopped it above triangle_budget */
    /** Material thinner than a voxel that the mesh has not, about, as swarf_stock_volume() counts it: in voxels whose
     *  centre lies outside and about which no other's lies inside. */
    double unseen_mm3;
    /** Volume within the surface that the mesh stands for. The mesh's own differs by what its flat triangles leave out
     *  of bulges and put into hollows; here that is added up where edges of the voxels meet both. Of what is thicker
     *  than a voxel: unseen_mm3 is not in it, nor is what splitting edges adds with options.fine; and vertices put
     *  elsewhere where triangles cut each other shift it, by about a part in 100 000. */
    double surface_mm3;
    size_t split_edges; /**< of triangles that left the surface, with options.fine */
} swarf_contour_report;

/** From a stock by dual contouring: a closed, oriented 2-manifold with edges. Which voxels are material decides how it
 *  hangs together; the surface, where it is given, decides where its vertices lie: on the true faces and edges within a
 *  hundredth of a voxel.
 *
 *  The field alone tells faces to about as much. Of round ones 99 vertices of 100 are within 0.01 voxel where their
 *  radius is six voxels and more, single ones off by 0.03; of four to six within 0.02, single ones off by a tenth; of
 *  three to four by 0.13 and 0.30; of two to three by 0.22 and 0.44; in the mean by 0.002, 0.003, 0.01 and 0.04. Edges
 *  are where the faces beside them meet, half of them within a hundredth and nearly all within a tenth of a voxel, but
 *  within half of one where a third face is nearer than three voxels, and where the field is no distance. It is used
 *  where the surface does not have the stock's signs. In a field with noise of a tenth of a voxel and more vertices
 *  are off by as much as that.
 *
 *  Walls and gaps thinner than a voxel have no voxel centre in places, and are not there then; how much material that
 *  is the report tells, about. Wedges, roots of threads and tips of points narrower than a voxel end up to a voxel
 *  early, and of crests closer to each other than a voxel the valleys may be lost; with `fine` most of that is there
 *  where a voxel's centre is near.
 *
 *  `report` may be NULL. An empty stock gives an empty mesh. The result does not depend on the number of threads.
 *  SWARF_ERROR_GEOMETRY: material reaches the border of the level set, which a file of another program may do. */
SWARF_API swarf_status swarf_mesh_contour(swarf_stock *stock, const swarf_contour_options *options,
                                          const swarf_progress *progress, swarf_mesh **out,
                                          swarf_contour_report *report);

/** The mesh of swarf_mesh_contour() straight to a binary .stl file. Where the whole mesh would not fit into
 *  memory_limit (bytes; 0: 80 % of what is free now) it is made and written band by band along x, of 256 or 64 voxels:
 *  then it needs the memory of a band beside the stock's, triangles stay small along the planes between bands, and all
 *  else that swarf_mesh_contour() promises holds. A pipe, where the count cannot be put in afterwards, gets the whole
 *  mesh whatever the limit. Without a budget. SWARF_ERROR_ARGUMENT: another suffix, a budget, more triangles than the
 *  format can count; SWARF_ERROR_IO; those of swarf_mesh_contour(). `report` may be NULL. */
SWARF_API swarf_status swarf_mesh_stream(swarf_stock *stock, const swarf_contour_options *options, size_t memory_limit,
                                         const char *path, const swarf_progress *progress,
                                         swarf_contour_report *report);

/** What made each triangle: the point of the surface, after its first `moves`, that is nearest along the normal to a
 *  place beside the triangle's middle, no farther than reach_mm (0: a voxel); `move` -2 where there is none. `out`: one
 *  per triangle. */
SWARF_API swarf_status swarf_mesh_origins(const swarf_mesh *mesh, const swarf_surface *surface, size_t moves,
                                          double reach_mm, const swarf_progress *progress, swarf_surface_point *out);

/** The mesh turned and moved. */
SWARF_API swarf_status swarf_mesh_create_placed(const swarf_mesh *mesh, const swarf_placement *placement,
                                                swarf_mesh **out);

/** Read .stl (binary or text, welded), .ply or .obj by its content. SWARF_ERROR_IO / SWARF_ERROR_FORMAT. */
SWARF_API swarf_status swarf_mesh_read(const char *path, swarf_mesh **out);
/** Write .stl (binary), .ply (binary), .obj, .3mf or .glb (glTF, in metres, y up) by the suffix; written beside and
 *  renamed. SWARF_ERROR_ARGUMENT: another suffix, or more than the format can count; SWARF_ERROR_IO. */
SWARF_API swarf_status swarf_mesh_write(const swarf_mesh *mesh, const char *path, const swarf_progress *progress);
/** The same with a colour per triangle (3 bytes each; NULL: none): of faces in .ply and .3mf, of vertices (split where
 *  colours meet) in .obj and .glb; .stl leaves them out. */
SWARF_API swarf_status swarf_mesh_write_coloured(const swarf_mesh *mesh, const uint8_t *rgb, size_t triangle_count,
                                                 const char *path, const swarf_progress *progress);
SWARF_API swarf_mesh *swarf_mesh_retain(swarf_mesh *mesh);
SWARF_API void swarf_mesh_release(swarf_mesh *mesh);

/** View of the mesh's triangles, owned by it. */
SWARF_API swarf_triangles swarf_mesh_triangles(const swarf_mesh *mesh);
/** Edges, volume, area, box; measured once when the mesh is made. */
SWARF_API swarf_topology swarf_mesh_topology(const swarf_mesh *mesh);

/** A piece of surface that hangs together by its edges, or a whole mesh. Moments are of the volume it encloses, at
 *  density 1 per mm3. */
typedef struct swarf_shell {
    size_t triangles;
    size_t vertices;
    size_t edges;
    size_t open_edges; /**< of one triangle only */
    int64_t euler;     /**< vertices - edges + triangles: 2 for a ball, 0 for a torus */
    int64_t genus;     /**< holes through it; -1 when it is open */
    double volume_mm3; /**< negative: a cavity */
    double area_mm2;
    double centre[3];     /**< of mass, mm */
    double inertia[3][3]; /**< about the centre, mm5 */
    double moment[3];     /**< principal moments, the least first */
    double axis[3][3];    /**< their axes: unit, right-handed */
    swarf_box box;
} swarf_shell;

/** The shells of a mesh, measured. Owned by the caller; immutable. */
typedef struct swarf_measures swarf_measures;
SWARF_API swarf_status swarf_measures_create(const swarf_mesh *mesh, swarf_measures **out);
/** NULL is legal. */
SWARF_API void swarf_measures_destroy(swarf_measures *measures);
/** All shells as one; cavities count against the solids. */
SWARF_API swarf_shell swarf_measures_whole(const swarf_measures *measures);
/** In the order of their first triangles. */
SWARF_API const swarf_shell *swarf_measures_shells(const swarf_measures *measures, size_t *count);
/** The number of its shell for every triangle. */
SWARF_API const uint32_t *swarf_measures_shell_of(const swarf_measures *measures);
/** A mesh of some of the shells of `mesh`, of which `measures` was made. SWARF_ERROR_ARGUMENT: no such shell. */
SWARF_API swarf_status swarf_mesh_create_shells(const swarf_mesh *mesh, const swarf_measures *measures,
                                                const uint32_t *shells, size_t count, swarf_mesh **out);
/** Meshes of `count` groups of its shells, in one pass over it. `group_of`: the number of its group for every shell,
 *  `count` or more: in none. `out`: `count` meshes, the caller's; empty where a group has no shells. */
SWARF_API swarf_status swarf_mesh_create_groups(const swarf_mesh *mesh, const swarf_measures *measures,
                                                const uint32_t *group_of, size_t count, const swarf_progress *progress,
                                                swarf_mesh **out);

/** Cut a closed mesh by a plane into what lies against `normal` (below) and along it (above), each closed by caps; a
 *  side without material becomes an empty mesh. Volumes add up, but for the rounding of new vertices to floats.
 *  SWARF_ERROR_GEOMETRY: not closed; SWARF_ERROR_ARGUMENT: not finite, no normal. */
SWARF_API swarf_status swarf_mesh_split(const swarf_mesh *mesh, const double point[3], const double normal[3],
                                        swarf_mesh **below, swarf_mesh **above);

/** Thickness of the wall behind each triangle, in mm: the least of four rays straight into the material, from its
 *  middle and near its corners, to where it ends at a face within 60 degrees of opposite; a ray that ends elsewhere,
 *  beside an edge, tells of no wall. INFINITY: none of them does, or a triangle without area. `out`: one per triangle.
 *  SWARF_ERROR_GEOMETRY: it is more than 1e6 mm long or away. */
SWARF_API swarf_status swarf_mesh_thickness(const swarf_mesh *mesh, const swarf_progress *progress, float *out);

/** The curves along which a plane cuts a mesh, as polylines. Owned by the caller; immutable. */
typedef struct swarf_outline swarf_outline;
/** Material on the left seen against `normal`. Of a face that lies in the plane what is just below counts, or just
 * above where nothing is below; no two points in a row are closer than 1e-6 mm, and no closed curve is without area.
 *  SWARF_ERROR_ARGUMENT: NULL, not finite, no normal. */
SWARF_API swarf_status swarf_outline_create(const swarf_mesh *mesh, const double point[3], const double normal[3],
                                            swarf_outline **out);
/** NULL is legal. */
SWARF_API void swarf_outline_destroy(swarf_outline *section);
/** Number of polylines; in a closed mesh each goes on from its last point to its first. */
SWARF_API size_t swarf_outline_count(const swarf_outline *section);
/** Points of polyline `index` (below the count), 3 doubles each, in mm. */
SWARF_API const double *swarf_outline_polyline(const swarf_outline *section, size_t index, size_t *count);

#ifdef __cplusplus
}
#endif
#endif
