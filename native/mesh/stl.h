/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Binary STL piece by piece, for meshes that are not in memory as a whole: the header, records, the count at last. */
#ifndef SWARF_MESH_STL_H
#define SWARF_MESH_STL_H

#include "mesh/mesh.h"

/** SWARF_ERROR_ARGUMENT: more triangles than the format can count. */
swarf_status swarf_stl_write_header(size_t triangles, FILE *stream);
/** Records of triangles; write errors are found when the file is committed. */
swarf_status swarf_stl_write_records(const swarf_triangles *triangles, FILE *stream, const swarf_progress *progress);
/** Back to the header of a stream that can go back, for the count that was not known before. */
swarf_status swarf_stl_finish(FILE *stream, size_t triangles);

#endif
