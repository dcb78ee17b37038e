/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Embree over blocks: user geometry with one primitive per block; builds against Embree 3.13 and Embree 4.
 *
 * Embree walks its tree in float and only proposes blocks; the rays proper, in double, travel beside the packet in
 * the query context and are found by their id, so that hits are as exact for a packet of 16 as for a single ray,
 * whatever width Embree splits the packet into and whatever order it visits blocks in.
 */
#include "render/embree_scene.h"

#include "base/guard.hpp"

#if SWARF_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <limits>

struct swarf_accel {
    RTCScene scene;
};

namespace {

/* Voxels by which bounds grow: more than the rounding of a float coordinate in a layout of 2^16 voxels (4e-3). */
constexpr float bounds_padding = 1.0f / 64;

#if RTC_VERSION_MAJOR >= 4
using embree_context = RTCRayQueryContext;
#else
using embree_context = RTCIntersectContext;
#endif

struct packet {
    embree_context context; /* first: Embree hands back a pointer to it */
    swarf_ray *rays;
};

/* One for the process, on first use, never released: releasing many crashed Embree 3. */
RTCDevice shared_device()
{
    static const RTCDevice device = rtcNewDevice(nullptr);
    return device;
}

swarf_status fail_embree(const char *what)
{
    const RTCError error = rtcGetDeviceError(shared_device());
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        return swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory in Embree (%s)", what);
    return swarf_fail(SWARF_ERROR_INTERNAL, "scene: Embree error %d (%s)", static_cast<int>(error), what);
}

void block_bounds(const RTCBoundsFunctionArguments *args)
{
    const swarf_block &block = static_cast<const swarf_block *>(args->geometryUserPtr)[args->primID];
    RTCBounds &out = *args->bounds_o;
    const float padding = bounds_padding;
    out.lower_x = static_cast<float>(block.ijk[0] + block.lo[0]) - padding;
    out.lower_y = static_cast<float>(block.ijk[1] + block.lo[1]) - padding;
    out.lower_z = static_cast<float>(block.ijk[2] + block.lo[2]) - padding;
    out.upper_x = static_cast<float>(block.ijk[0] + block.hi[0]) + padding;
    out.upper_y = static_cast<float>(block.ijk[1] + block.hi[1]) + padding;
    out.upper_z = static_cast<float>(block.ijk[2] + block.hi[2]) + padding;
}

void block_intersect(const RTCIntersectFunctionNArguments *args)
{
    const swarf_block &block = static_cast<const swarf_block *>(args->geometryUserPtr)[args->primID];
    packet *const p = reinterpret_cast<packet *>(args->context);
    RTCRayN *const ray = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCHitN *const hit = RTCRayHitN_HitN(args->rayhit, args->N);
    for (unsigned lane = 0; lane < args->N; lane++) {
        if (!args->valid[lane]) continue;
        swarf_ray &exact = p->rays[RTCRayN_id(ray, args->N, lane)];
        if (!swarf_block_intersect(&block, args->primID, &exact)) continue;
        /* Rounded up, or a block with a hit at the very same place might not be proposed any more. */
        RTCRayN_tfar(ray, args->N, lane) =
            std::nextafter(static_cast<float>(exact.t), std::numeric_limits<float>::infinity());
        RTCHitN_geomID(hit, args->N, lane) = args->geomID;
        RTCHitN_primID(hit, args->N, lane) = args->primID;
    }
}

/** Fill lane `lane` of Embree's ray arrays (N lanes) from `ray`. */
void load_lane(RTCRayHitN *rayhit, unsigned n, unsigned lane, const swarf_ray &ray)
{
    RTCRayN *const out = RTCRayHitN_RayN(rayhit, n);
    RTCRayN_org_x(out, n, lane) = static_cast<float>(ray.origin[0]);
    RTCRayN_org_y(out, n, lane) = static_cast<float>(ray.origin[1]);
    RTCRayN_org_z(out, n, lane) = static_cast<float>(ray.origin[2]);
    RTCRayN_dir_x(out, n, lane) = static_cast<float>(ray.direction[0]);
    RTCRayN_dir_y(out, n, lane) = static_cast<float>(ray.direction[1]);
    RTCRayN_dir_z(out, n, lane) = static_cast<float>(ray.direction[2]);
    RTCRayN_tnear(out, n, lane) = 0;
    RTCRayN_tfar(out, n, lane) = std::numeric_limits<float>::infinity();
    RTCRayN_time(out, n, lane) = 0;
    RTCRayN_mask(out, n, lane) = ~0u;
    RTCRayN_id(out, n, lane) = lane;
    RTCRayN_flags(out, n, lane) = 0;
    RTCHitN_geomID(RTCRayHitN_HitN(rayhit, n), n, lane) = RTC_INVALID_GEOMETRY_ID;
    RTCHitN_instID(RTCRayHitN_HitN(rayhit, n), n, lane, 0) = RTC_INVALID_GEOMETRY_ID;
}

} // namespace

extern "C" swarf_status swarf_accel_create(const swarf_block *blocks, size_t count, swarf_accel **out)
{
    return swarf_guard("scene", [&]() -> swarf_status {
        RTCDevice device = shared_device();
        if (!device)
            return swarf_fail(SWARF_ERROR_INTERNAL, "scene: Embree does not start (error %d)",
                              static_cast<int>(rtcGetDeviceError(nullptr)));
        if (count > 0xfffffffeu) return swarf_fail(SWARF_ERROR_MEMORY, "scene: %zu blocks are too many", count);
        RTCScene scene = rtcNewScene(device);
        if (!scene) return fail_embree("new scene");
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        if (!geometry) {
            rtcReleaseScene(scene);
            return fail_embree("new geometry");
        }
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
        rtcSetGeometryUserData(geometry, const_cast<swarf_block *>(blocks));
        rtcSetGeometryBoundsFunction(geometry, block_bounds, nullptr);
        rtcSetGeometryIntersectFunction(geometry, block_intersect);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        const RTCError error = rtcGetDeviceError(device);
        swarf_accel *accel = error == RTC_ERROR_NONE ? new (std::nothrow) swarf_accel{scene} : nullptr;
        if (!accel) {
            rtcReleaseScene(scene);
            return error == RTC_ERROR_NONE || error == RTC_ERROR_OUT_OF_MEMORY
                       ? swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory for %zu blocks", count)
                       : swarf_fail(SWARF_ERROR_INTERNAL, "scene: Embree error %d", static_cast<int>(error));
        }
        *out = accel;
        return SWARF_OK;
    });
}

extern "C" void swarf_accel_destroy(swarf_accel *accel)
{
    if (!accel) return;
    rtcReleaseScene(accel->scene);
    delete accel;
}

extern "C" void swarf_accel_trace(const swarf_accel *accel, swarf_ray *rays, unsigned count)
{
    packet p;
    p.rays = rays;
#if RTC_VERSION_MAJOR >= 4
    rtcInitRayQueryContext(&p.context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &p.context;
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    RTCIntersectArguments *const query = &arguments;
#else
    rtcInitIntersectContext(&p.context);
    p.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCIntersectContext *const query = &p.context;
#endif
    if (count == 1) {
        RTCRayHit single;
        load_lane(reinterpret_cast<RTCRayHitN *>(&single), 1, 0, rays[0]);
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect1(accel->scene, &single, query);
#else
        rtcIntersect1(accel->scene, query, &single);
#endif
        return;
    }
    alignas(64) int valid[16];
    RTCRayHit16 packet16;
    for (unsigned lane = 0; lane < 16; lane++) {
        valid[lane] = lane < count ? -1 : 0;
        /* Idle lanes repeat a ray: Embree may look at their numbers before the mask. */
        load_lane(reinterpret_cast<RTCRayHitN *>(&packet16), 16, lane, rays[lane < count ? lane : 0]);
    }
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect16(valid, accel->scene, &packet16, query);
#else
    rtcIntersect16(valid, accel->scene, query, &packet16);
#endif
}
