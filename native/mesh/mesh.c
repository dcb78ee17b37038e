/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Mesh: two flat arrays (positions, vertex numbers) and what was measured on them when it was made. */
#include "mesh/mesh.h"

#include "base/memory.h"
#include "base/status.h"
#include "base/weld.h"

#include <ctype.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

struct swarf_mesh {
    atomic_uint references;
    swarf_mesh_data data;
    swarf_topology topology;
};

swarf_status swarf_mesh_data_vertex(swarf_mesh_data *data, const float xyz[3])
{
    const size_t used = 3 * data->vertex_count;
    SWARF_TRY(swarf_array_reserve((void **)&data->xyz, &data->xyz_room, used + 3, sizeof *data->xyz));
    memcpy(data->xyz + used, xyz, 3 * sizeof *xyz);
    data->vertex_count++;
    return SWARF_OK;
}

swarf_status swarf_mesh_data_triangle(swarf_mesh_data *data, uint32_t a, uint32_t b, uint32_t c)
{
    const size_t used = 3 * data->triangle_count;
    SWARF_TRY(swarf_array_reserve((void **)&data->index, &data->index_room, used + 3, sizeof *data->index));
    data->index[used] = a;
    data->index[used + 1] = b;
    data->index[used + 2] = c;
    data->triangle_count++;
    return SWARF_OK;
}

swarf_status swarf_mesh_data_weld(swarf_mesh_data *data)
{
    uint32_t *map = malloc((data->vertex_count + 1) * sizeof *map);
    if (!map) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory for welding %zu vertices", data->vertex_count);
    const swarf_status status = swarf_weld(data->xyz, data->vertex_count, map, &data->vertex_count);
    if (status == SWARF_OK)
        for (size_t i = 0; i < 3 * data->triangle_count; i++) data->index[i] = map[data->index[i]];
    free(map);
    return status;
}

void swarf_mesh_data_free(swarf_mesh_data *data)
{
    free(data->xyz);
    free(data->index);
    memset(data, 0, sizeof *data);
}

static swarf_triangles view_of(const swarf_mesh_data *data)
{
    return (swarf_triangles){data->xyz, data->vertex_count, data->index, data->triangle_count};
}

swarf_status swarf_mesh_adopt(swarf_mesh_data *data, swarf_mesh **out)
{
    swarf_mesh *mesh = calloc(1, sizeof *mesh);
    const swarf_triangles triangles = view_of(data);
    const swarf_status status =
        mesh ? swarf_triangles_topology(&triangles, &mesh->topology) : swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    if (status != SWARF_OK) {
        free(mesh);
        swarf_mesh_data_free(data);
        return status;
    }
    atomic_init(&mesh->references, 1);
    mesh->data = *data;
    memset(data, 0, sizeof *data);
    *out = mesh;
    return SWARF_OK;
}

swarf_status swarf_mesh_create(const swarf_triangles *triangles, swarf_mesh **out)
{
    SWARF_REQUIRE(triangles && out, "mesh: NULL");
    SWARF_REQUIRE((triangles->xyz || !triangles->vertex_count) && (triangles->index || !triangles->triangle_count),
                  "mesh: arrays missing");
    const size_t coordinates = 3 * triangles->vertex_count, corners = 3 * triangles->triangle_count;
    swarf_mesh_data data = {0};
    swarf_status status = swarf_array_reserve((void **)&data.xyz, &data.xyz_room, coordinates, sizeof *data.xyz);
    if (status == SWARF_OK)
        status = swarf_array_reserve((void **)&data.index, &data.index_room, corners, sizeof *data.index);
    if (status != SWARF_OK) {
        swarf_mesh_data_free(&data);
        return status;
    }
    if (coordinates) memcpy(data.xyz, triangles->xyz, coordinates * sizeof *data.xyz);
    if (corners) memcpy(data.index, triangles->index, corners * sizeof *data.index);
    data.vertex_count = triangles->vertex_count;
    data.triangle_count = triangles->triangle_count;
    return swarf_mesh_adopt(&data, out);
}

swarf_mesh *swarf_mesh_retain(swarf_mesh *mesh)
{
    if (mesh) atomic_fetch_add_explicit(&mesh->references, 1, memory_order_relaxed);
    return mesh;
}

void swarf_mesh_release(swarf_mesh *mesh)
{
    if (!mesh || atomic_fetch_sub_explicit(&mesh->references, 1, memory_order_acq_rel) != 1) return;
    swarf_mesh_data_free(&mesh->data);
    free(mesh);
}

swarf_triangles swarf_mesh_triangles(const swarf_mesh *mesh)
{
    return mesh ? view_of(&mesh->data) : (swarf_triangles){0};
}

swarf_topology swarf_mesh_topology(const swarf_mesh *mesh)
{
    return mesh ? mesh->topology : (swarf_topology){0};
}

/* The readers by content: a PLY says so; a binary STL has exactly the length that its count asks for; a text STL
 * starts with "solid"; an OBJ has no mark, so the rest is one unless its name or its bytes say otherwise. */
static swarf_status read_any(const char *text, size_t length, const char *path, swarf_mesh_data *data)
{
    char suffix[8];
    swarf_file_suffix(path, suffix, sizeof suffix);
    if (length == 0) return swarf_fail(SWARF_ERROR_FORMAT, "%s: the file is empty", path);
    if (length >= 4 && memcmp(text, "ply", 3) == 0 && isspace((unsigned char)text[3]))
        return swarf_ply_read(text, length, path, data);
    size_t skip = 0;
    while (skip < length && isspace((unsigned char)text[skip])) skip++;
    if (swarf_stl_is_binary(text, length) || strncmp(text + skip, "solid", 5) == 0 || strcmp(suffix, "stl") == 0)
        return swarf_stl_read(text, length, path, data);
    if (strcmp(suffix, "ply") == 0)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s:1: a PLY file starts with the word \"ply\"", path);
    if (memchr(text, 0, length))
        return swarf_fail(SWARF_ERROR_FORMAT,
                          "%s: neither STL, PLY nor OBJ, of which meshes are read; 3MF and glTF are only written",
                          path);
    return swarf_obj_read(text, length, path, data);
}

swarf_status swarf_mesh_read(const char *path, swarf_mesh **out)
{
    SWARF_REQUIRE(path && out, "mesh: path or output missing");
    char *text;
    size_t length;
    SWARF_TRY(swarf_file_read(path, &text, &length));
    swarf_mesh_data data = {0};
    const swarf_status status = read_any(text, length, path, &data);
    free(text);
    if (status != SWARF_OK) {
        swarf_mesh_data_free(&data);
        return status;
    }
    return swarf_mesh_adopt(&data, out);
}

static const struct format {
    const char *suffix;
    swarf_mesh_writer *write;
} formats[] = {{"stl", swarf_stl_write},
               {"ply", swarf_ply_write},
               {"obj", swarf_obj_write},
               {"3mf", swarf_3mf_write},
               {"glb", swarf_gltf_write}};

swarf_status swarf_mesh_write(const swarf_mesh *mesh, const char *path, const swarf_progress *progress)
{
    return swarf_mesh_write_coloured(mesh, NULL, 0, path, progress);
}

swarf_status swarf_mesh_write_coloured(const swarf_mesh *mesh, const uint8_t *rgb, size_t triangle_count,
                                       const char *path, const swarf_progress *progress)
{
    SWARF_REQUIRE(mesh && path, "mesh: NULL");
    SWARF_REQUIRE(!rgb || triangle_count == mesh->data.triangle_count, "mesh: %zu colours for %zu triangles",
                  triangle_count, mesh->data.triangle_count);
    char suffix[8];
    swarf_file_suffix(path, suffix, sizeof suffix);
    swarf_mesh_writer *write = NULL;
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (strcmp(suffix, formats[i].suffix) == 0) write = formats[i].write;
    SWARF_REQUIRE(write, "%s: a mesh is written as .stl, .ply, .obj, .3mf or .glb", path);
    const swarf_triangles triangles = view_of(&mesh->data);
    swarf_file_writer writer;
    SWARF_TRY(swarf_file_begin(path, &writer));
    const swarf_status status = write(&triangles, rgb, writer.stream, progress);
    const int full = status == SWARF_ERROR_IO && ferror(writer.stream); /* which closing the file tells best */
    if (status != SWARF_OK && !full) {
        swarf_file_abandon(&writer);
        return status;
    }
    return swarf_file_commit(&writer);
}
