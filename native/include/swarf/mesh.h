/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Mesh: triangles of a stock or a design, their measures and file formats. Immutable, shared, any thread. */
#ifndef SWARF_MESH_H
#define SWARF_MESH_H

#include "stock.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct swarf_mesh swarf_mesh;

/** Copies the triangles. SWARF_ERROR_ARGUMENT for an index out of range or numbers not finite. */
SWARF_API swarf_status swarf_mesh_create(const swarf_triangles *triangles, swarf_mesh **out);
/** From a stock by OpenVDB's mesher; adaptivity 0 (uniform) .. 1. Closed and oriented outwards, or
 *  SWARF_ERROR_INTERNAL; an empty stock gives an empty mesh. */
SWARF_API swarf_status swarf_mesh_create_stock(swarf_stock *stock, double adaptivity, const swarf_progress *progress,
                                               swarf_mesh **out);
/** Read .stl (binary or text, welded), .ply or .obj by its content. SWARF_ERROR_IO / SWARF_ERROR_FORMAT. */
SWARF_API swarf_status swarf_mesh_read(const char *path, swarf_mesh **out);
/** Write .stl (binary), .ply (binary) or .obj by the suffix; written beside and renamed. */
SWARF_API swarf_status swarf_mesh_write(const swarf_mesh *mesh, const char *path, const swarf_progress *progress);
SWARF_API swarf_mesh *swarf_mesh_retain(swarf_mesh *mesh);
SWARF_API void swarf_mesh_release(swarf_mesh *mesh);

/** View of the mesh's triangles, owned by it. */
SWARF_API swarf_triangles swarf_mesh_triangles(const swarf_mesh *mesh);
/** Edges, volume, area, box; measured once when the mesh is made. */
SWARF_API swarf_topology swarf_mesh_topology(const swarf_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
