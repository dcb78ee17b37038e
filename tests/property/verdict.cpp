/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "verdict.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <new>
#include <vector>

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using surface = CGAL::Surface_mesh<kernel::Point_3>;

surface to_surface(const swarf_triangles &mesh, bool &manifold)
{
    std::vector<kernel::Point_3> points;
    std::vector<std::array<std::size_t, 3>> polygons;
    points.reserve(mesh.vertex_count);
    polygons.reserve(mesh.triangle_count);
    for (std::size_t i = 0; i < mesh.vertex_count; i++)
        points.emplace_back(mesh.xyz[3 * i], mesh.xyz[3 * i + 1], mesh.xyz[3 * i + 2]);
    for (std::size_t i = 0; i < mesh.triangle_count; i++)
        polygons.push_back({mesh.index[3 * i], mesh.index[3 * i + 1], mesh.index[3 * i + 2]});
    manifold = pmp::is_polygon_soup_a_polygon_mesh(polygons);
    surface out;
    if (manifold) pmp::polygon_soup_to_polygon_mesh(points, polygons, out);
    return out;
}

} // namespace

int verdict_of(const swarf_triangles *mesh, verdict *out)
try {
    bool manifold = false;
    const surface s = to_surface(*mesh, manifold);
    *out = verdict{};
    out->manifold = manifold;
    if (!manifold) return 1;
    out->closed = CGAL::is_closed(s);
    std::vector<std::pair<surface::Face_index, surface::Face_index>> cuts;
    pmp::self_intersections(s, std::back_inserter(cuts));
    out->cuts = cuts.size();
    for (const auto f : s.faces()) out->flat_triangles += pmp::is_degenerate_triangle_face(f, s);
    if (!out->closed) return 1;
    out->volume_mm3 = CGAL::to_double(pmp::volume(s));
    out->outward = pmp::is_outward_oriented(s);
    out->bounds_a_volume = cuts.empty() && pmp::does_bound_a_volume(s);
    return 1;
} catch (const std::bad_alloc &) {
    return 0;
}
