/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock -> triangles by OpenVDB's dual mesher. */
#include "base/arena.hpp"
#include "base/guard.hpp"
#include "mesh/mesh.h"
#include "stock/stock.h"
#include "stock/vdb_tree.hpp"

#include <openvdb/tools/VolumeToMesh.h>

#include <vector>

namespace {

struct polygons {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
};

/* Turned round: OpenVDB's polygons are clockwise seen from outside. */
swarf_status copy(const polygons &from, swarf_mesh_data &to)
{
    for (const openvdb::Vec3s &point : from.points) SWARF_TRY(swarf_mesh_data_vertex(&to, point.asPointer()));
    for (const openvdb::Vec3I &t : from.triangles) SWARF_TRY(swarf_mesh_data_triangle(&to, t[0], t[2], t[1]));
    for (const openvdb::Vec4I &q : from.quads) {
        SWARF_TRY(swarf_mesh_data_triangle(&to, q[0], q[2], q[1]));
        SWARF_TRY(swarf_mesh_data_triangle(&to, q[0], q[3], q[2]));
    }
    return SWARF_OK;
}

swarf_status make_mesh(const swarf_stock *stock, double adaptivity, const swarf_progress *progress, swarf_mesh **out)
{
    polygons found;
    SWARF_TRY(swarf_progress_report(progress, 0));
    swarf_arena_run([&] {
        openvdb::tools::volumeToMesh(*stock->tree->grid, found.points, found.triangles, found.quads, 0.0, adaptivity);
    });
    SWARF_TRY(swarf_progress_report(progress, 0.6));
    swarf_mesh_data data = {};
    const swarf_status status = copy(found, data);
    if (status != SWARF_OK) {
        swarf_mesh_data_free(&data);
        return status;
    }
    swarf_mesh *mesh;
    SWARF_TRY(swarf_mesh_adopt(&data, &mesh));
    const swarf_topology topology = swarf_mesh_topology(mesh);
    if (!topology.closed && !found.points.empty()) {
        swarf_mesh_release(mesh);
        return swarf_fail(SWARF_ERROR_INTERNAL, "mesh: the surface is not closed: %zu open and %zu turned edges",
                          topology.boundary_edges, topology.misoriented_edges);
    }
    const swarf_status last = swarf_progress_report(progress, 1);
    if (last != SWARF_OK) {
        swarf_mesh_release(mesh);
        return last;
    }
    *out = mesh;
    return SWARF_OK;
}

} // namespace

extern "C" swarf_status swarf_mesh_create_stock(swarf_stock *stock, double adaptivity, const swarf_progress *progress,
                                                swarf_mesh **out)
{
    SWARF_REQUIRE(out, "mesh: output missing");
    SWARF_REQUIRE(adaptivity >= 0 && adaptivity <= 1, "mesh: adaptivity %g is not in 0 .. 1", adaptivity);
    SWARF_TRY(swarf_stock_enter_read(stock));
    const swarf_status status =
        swarf_guard("stock to mesh", [&]() -> swarf_status { return make_mesh(stock, adaptivity, progress, out); });
    swarf_stock_leave(stock);
    return status;
}
