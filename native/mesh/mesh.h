/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Inside of a mesh, and what readers and writers of file formats share. */
#ifndef SWARF_MESH_MESH_H
#define SWARF_MESH_MESH_H

#include "base/file.h"
#include "swarf/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Triangles being gathered; grows with what is really there, never by a count that a file claims. */
typedef struct swarf_mesh_data {
    float *xyz;
    size_t vertex_count;
    size_t xyz_room;
    uint32_t *index;
    size_t triangle_count;
    size_t index_room;
} swarf_mesh_data;

swarf_status swarf_mesh_data_vertex(swarf_mesh_data *data, const float xyz[3]);
swarf_status swarf_mesh_data_triangle(swarf_mesh_data *data, uint32_t a, uint32_t b, uint32_t c);
/** Equal positions become one vertex. */
swarf_status swarf_mesh_data_weld(swarf_mesh_data *data);
void swarf_mesh_data_free(swarf_mesh_data *data);
/** A mesh of the data, which it takes over, also on failure. */
swarf_status swarf_mesh_adopt(swarf_mesh_data *data, swarf_mesh **out);

/** Unit normal of a plane, of a normal of any length. SWARF_ERROR_ARGUMENT: not finite, no length. */
swarf_status swarf_plane_take(const double point[3], const double normal[3], double unit[3]);

/** Readers of a whole file in memory (followed by a 0 byte); `name` is used in errors. On failure the caller frees
 *  what was gathered. */
swarf_status swarf_stl_read(const char *text, size_t length, const char *name, swarf_mesh_data *out);
swarf_status swarf_ply_read(const char *text, size_t length, const char *name, swarf_mesh_data *out);
swarf_status swarf_obj_read(const char *text, size_t length, const char *name, swarf_mesh_data *out);

/** 1 when the bytes are as long as the triangle count of a binary STL says. */
int swarf_stl_is_binary(const char *text, size_t length);

/** Writers to an open stream; write errors are found when the file is committed. `rgb`: 3 bytes per triangle, NULL for
 *  none; STL has no place for them. */
typedef swarf_status swarf_mesh_writer(const swarf_triangles *triangles, const uint8_t *rgb, FILE *stream,
                                       const swarf_progress *progress);
swarf_mesh_writer swarf_stl_write, swarf_ply_write, swarf_obj_write, swarf_3mf_write, swarf_gltf_write;

#ifdef __cplusplus
}
#endif
#endif
