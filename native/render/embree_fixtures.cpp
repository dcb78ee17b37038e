/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "render/embree_fixtures.h"

#include "render/embree_device.hpp"

#include <cmath>
#include <cstring>
#include <limits>

struct swarf_fixtures {
    RTCScene scene;
    swarf_box box;
};

namespace {

constexpr double farthest = 1e6; /* as stocks and moves */
/* Rays that start farther out cannot meet a box within `farthest`; beyond 1.8e18 Embree ends the process. */
constexpr float farthest_ray = 1e9F;

bool is_near(float x, float y, float z)
{
    return std::fabs(x) < farthest_ray && std::fabs(y) < farthest_ray && std::fabs(z) < farthest_ray;
}

swarf_status add_mesh(swarf_fixtures &fixtures, const swarf_triangles &mesh)
{
    for (size_t i = 0; i < 3 * mesh.triangle_count; i++)
        if (mesh.index[i] >= mesh.vertex_count)
            return swarf_fail(SWARF_ERROR_ARGUMENT, "fixture: triangle %zu has vertex %u of %zu", i / 3, mesh.index[i],
                              mesh.vertex_count);
    for (size_t i = 0; i < mesh.vertex_count; i++)
        for (size_t axis = 0; axis < 3; axis++) {
            const double at = static_cast<double>(mesh.xyz[3 * i + axis]);
            if (!(std::fabs(at) <= farthest))
                return swarf_fail(SWARF_ERROR_ARGUMENT, "fixture: vertex %zu is at %g mm in %c; up to %g is possible",
                                  i, at, "xyz"[axis], farthest);
            fixtures.box.lo[axis] = std::fmin(fixtures.box.lo[axis], at);
            fixtures.box.hi[axis] = std::fmax(fixtures.box.hi[axis], at);
        }
    RTCGeometry geometry = rtcNewGeometry(swarf_embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!geometry) return swarf_embree_check("fixture");
    void *xyz = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                        mesh.vertex_count);
    void *index = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                                          mesh.triangle_count);
    if (xyz && index) {
        std::memcpy(xyz, mesh.xyz, 3 * sizeof(float) * mesh.vertex_count);
        std::memcpy(index, mesh.index, 3 * sizeof(uint32_t) * mesh.triangle_count);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(fixtures.scene, geometry);
    }
    rtcReleaseGeometry(geometry);
    return swarf_embree_check("fixture");
}

} // namespace

extern "C" swarf_status swarf_fixtures_create(const swarf_triangles *triangles, size_t count, swarf_fixtures **out)
{
    return swarf_guard("fixtures", [&]() -> swarf_status {
        SWARF_TRY(swarf_embree_check("device"));
        const double far = std::numeric_limits<double>::infinity();
        swarf_fixtures *fixtures =
            new swarf_fixtures{rtcNewScene(swarf_embree_device()), {{far, far, far}, {-far, -far, -far}}};
        swarf_status status = fixtures->scene ? SWARF_OK : swarf_embree_check("new scene");
        if (status == SWARF_OK) rtcSetSceneFlags(fixtures->scene, RTC_SCENE_FLAG_ROBUST);
        for (size_t i = 0; status == SWARF_OK && i < count; i++)
            if (triangles[i].triangle_count) status = add_mesh(*fixtures, triangles[i]);
        if (status == SWARF_OK) {
            rtcCommitScene(fixtures->scene);
            status = swarf_embree_check("fixtures");
        }
        if (status != SWARF_OK) {
            swarf_fixtures_destroy(fixtures);
            return status;
        }
        *out = fixtures;
        return SWARF_OK;
    });
}

extern "C" void swarf_fixtures_destroy(swarf_fixtures *fixtures)
{
    if (!fixtures) return;
    if (fixtures->scene) rtcReleaseScene(fixtures->scene);
    delete fixtures;
}

extern "C" void swarf_fixtures_box(const swarf_fixtures *fixtures, swarf_box *out)
{
    *out = fixtures->box;
}

extern "C" unsigned swarf_fixtures_trace(const swarf_fixtures *fixtures, swarf_rays *rays, unsigned active)
{
    alignas(64) int valid[SWARF_PACKET];
    RTCRayHit16 packet;
    double moved[SWARF_PACKET];
    for (unsigned lane = 0; lane < SWARF_PACKET; lane++) {
        const unsigned ray = active >> lane & 1 ? lane : static_cast<unsigned>(__builtin_ctz(active));
        valid[lane] = active >> lane & 1 ? -1 : 0;
        /* A far origin would cost a float's precision: start near the box. */
        double middle = 0, size = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double lo = fixtures->box.lo[axis], hi = fixtures->box.hi[axis];
            middle += (0.5 * (lo + hi) - rays->origin[axis][ray]) * rays->direction[axis][ray];
            size += hi - lo;
        }
        moved[lane] = std::fmax(middle - size, 0);
        packet.ray.org_x[lane] = static_cast<float>(rays->origin[0][ray] + moved[lane] * rays->direction[0][ray]);
        packet.ray.org_y[lane] = static_cast<float>(rays->origin[1][ray] + moved[lane] * rays->direction[1][ray]);
        packet.ray.org_z[lane] = static_cast<float>(rays->origin[2][ray] + moved[lane] * rays->direction[2][ray]);
        packet.ray.dir_x[lane] = static_cast<float>(rays->direction[0][ray]);
        packet.ray.dir_y[lane] = static_cast<float>(rays->direction[1][ray]);
        packet.ray.dir_z[lane] = static_cast<float>(rays->direction[2][ray]);
        packet.ray.tnear[lane] = 0;
        packet.ray.tfar[lane] = static_cast<float>(std::fmin(rays->reach[ray], rays->distance[ray]) - moved[lane]);
        if (packet.ray.tfar[lane] < 0 ||
            !is_near(packet.ray.org_x[lane], packet.ray.org_y[lane], packet.ray.org_z[lane]))
            valid[lane] = 0;
        packet.ray.time[lane] = 0;
        packet.ray.mask[lane] = ~0u;
        packet.ray.id[lane] = lane;
        packet.ray.flags[lane] = 0;
        packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    swarf_embree_context context;
    swarf_embree_intersect16(valid, fixtures->scene, &packet, &context);
    unsigned hits = 0;
    for (unsigned lane = 0; lane < SWARF_PACKET; lane++) {
        if (!valid[lane] || packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
        const float n[3] = {packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane]};
        const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (!(length > 0)) continue;
        const float along =
            n[0] * packet.ray.dir_x[lane] + n[1] * packet.ray.dir_y[lane] + n[2] * packet.ray.dir_z[lane];
        for (int axis = 0; axis < 3; axis++) rays->normal[axis][lane] = (along > 0 ? -n[axis] : n[axis]) / length;
        rays->distance[lane] = moved[lane] + static_cast<double>(packet.ray.tfar[lane]);
        hits |= 1u << lane;
    }
    return hits;
}
