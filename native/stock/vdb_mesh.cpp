/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Closed triangles -> level set by openvdb::tools::meshToVolume.
 *
 * It finds the outside by flooding from infinity and so takes hollows for solid. The shells are therefore sorted into
 * solids and cavities first (shells.h), each run is voxelized on its own and united or taken away. What one run's
 * shells enclose is solid however they cut each other. */
#include "base/arena.hpp"
#include "base/guard.hpp"
#include "stock/stock.h"
#include "stock/vdb_tree.hpp"
#include "stock/voxelize.h"

#include <openvdb/tools/Composite.h>
#include <openvdb/tools/MeshToVolume.h>

namespace {

/* The triangles of one run as meshToVolume wants them, in voxels. */
struct run_adapter {
    const swarf_shells &shells;
    const swarf_shell_run &run;
    openvdb::Vec3d origin;
    double voxel;

    size_t polygonCount() const
    {
        return run.count;
    }
    size_t pointCount() const
    {
        return shells.vertex_count;
    }
    size_t vertexCount(size_t) const
    {
        return 3;
    }
    void getIndexSpacePoint(size_t polygon, size_t corner, openvdb::Vec3d &out) const
    {
        const float *xyz = shells.xyz + 3 * static_cast<size_t>(shells.index[3 * (run.first + polygon) + corner]);
        out = (openvdb::Vec3d(xyz[0], xyz[1], xyz[2]) - origin) / voxel;
    }
};

openvdb::FloatGrid::Ptr voxelize(const swarf_shells &shells, double voxel, const openvdb::Vec3d &origin,
                                 float half_width, swarf_interrupter &interrupter, double from, double to)
{
    auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    transform->postTranslate(origin);
    openvdb::FloatGrid::Ptr result;
    for (size_t i = 0; i < shells.run_count && !interrupter.wasInterrupted(); i++) {
        const swarf_shell_run &run = shells.runs[i];
        const run_adapter mesh{shells, run, origin, voxel};
        interrupter.part(from +
                             (to - from) * static_cast<double>(run.first) / static_cast<double>(shells.triangle_count),
                         from + (to - from) * static_cast<double>(run.first + run.count) /
                                    static_cast<double>(shells.triangle_count));
        const auto part =
            openvdb::tools::meshToVolume<openvdb::FloatGrid>(interrupter, mesh, *transform, half_width, half_width);
        if (interrupter.wasInterrupted()) break; /* then `part` is unfinished */
        if (!result)
            result = part;
        else if (run.cavity)
            openvdb::tools::csgDifference(*result, *part);
        else
            openvdb::tools::csgUnion(*result, *part);
    }
    return result;
}

} // namespace

extern "C" swarf_status swarf_tree_create_shells(const swarf_shells *shells, double voxel, const double origin[3],
                                                 double half_width, const swarf_progress *progress, double from,
                                                 double to, swarf_tree **out)
{
    return swarf_guard("mesh to stock", [&]() -> swarf_status {
        swarf_vdb_initialize();
        swarf_interrupter interrupter(progress);
        const openvdb::Vec3d corner(origin[0], origin[1], origin[2]);
        const auto width = static_cast<float>(half_width);
        const auto grid =
            swarf_arena_run([&] { return voxelize(*shells, voxel, corner, width, interrupter, from, to); });
        SWARF_TRY(interrupter.status());
        *out = swarf_tree_adopt(grid);
        return SWARF_OK;
    });
}

/* Whether the shells are their bounding box. No triangle leaves its six faces, so all points inside have one winding
 * number, and the volume, which is positive, says that it is not zero. */
static bool is_box(const swarf_shells &shells)
{
    for (size_t i = 0; i < shells.triangle_count; i++) {
        const uint32_t *v = shells.index + 3 * i;
        bool on_face = false;
        for (size_t c = 0; c < 3 && !on_face; c++) {
            const float x = shells.xyz[3 * static_cast<size_t>(v[0]) + c];
            on_face = (x == shells.box.lo[c] || x == shells.box.hi[c]) &&
                      x == shells.xyz[3 * static_cast<size_t>(v[1]) + c] &&
                      x == shells.xyz[3 * static_cast<size_t>(v[2]) + c];
        }
        if (!on_face) return false;
    }
    return true;
}

static swarf_status create_from_shells(const swarf_shells &shells, const swarf_stock_options *options,
                                       const swarf_progress *progress, swarf_stock **out)
{
    if (is_box(shells)) return swarf_stock_create_box(&shells.box, options, out); /* exact, and at once */
    double origin[3];
    int32_t count[3];
    swarf_tree *tree = nullptr;
    SWARF_TRY(swarf_stock_layout(&shells.box, options, origin, count));
    SWARF_TRY(swarf_tree_create_shells(&shells, options->voxel_mm, origin, SWARF_HALF_WIDTH, progress, 0, 1, &tree));
    return swarf_stock_wrap(tree, out);
}

extern "C" swarf_status swarf_stock_create_mesh(const swarf_triangles *triangles, const swarf_stock_options *options,
                                                const swarf_progress *progress, swarf_stock **out)
{
    SWARF_REQUIRE(triangles && options && out, "stock: triangles, options or output missing");
    swarf_shells shells;
    SWARF_TRY(swarf_shells_create(triangles, &shells));
    const swarf_status status = create_from_shells(shells, options, progress, out);
    swarf_shells_free(&shells);
    return status;
}
