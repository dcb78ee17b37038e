/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Embree over cubes: user geometry with one primitive per cube; builds against Embree 3.13 and Embree 4.
 *
 * Embree walks its tree in float and only proposes cubes; the rays proper, in double, travel beside the packet in the
 * query context and are found by their id, so that hits are as exact for a packet of 16 as for a single ray, whatever
 * width Embree splits the packet into and whatever order it visits cubes in. A cube is 64 leaves: the tree over a fine
 * stock has some thousand primitives, and building it anew after a cut takes a millisecond or two.
 */
#include "render/embree_scene.h"

#include "render/embree_device.hpp"

#include <cmath>
#include <limits>

struct swarf_accel {
    RTCScene scene;
    RTCGeometry geometry;
    const swarf_cube *const *cubes;
};

namespace {

/* Voxels by which bounds grow: more than the rounding of a float coordinate in a layout of 2^16 voxels (4e-3). */
constexpr float bounds_padding = 1.0f / 64;

struct packet {
    swarf_embree_context context; /* first: Embree hands back a pointer to it */
    swarf_packet *rays;
    const swarf_ray_kernel *kernel;
};

const swarf_cube *cube_of(const void *user, unsigned number)
{
    return static_cast<const swarf_accel *>(user)->cubes[number];
}

void cube_bounds(const RTCBoundsFunctionArguments *args)
{
    const swarf_cube &cube = *cube_of(args->geometryUserPtr, args->primID);
    RTCBounds &out = *args->bounds_o;
    const float padding = bounds_padding;
    out.lower_x = static_cast<float>(cube.corner[0] + cube.lo[0]) - padding;
    out.lower_y = static_cast<float>(cube.corner[1] + cube.lo[1]) - padding;
    out.lower_z = static_cast<float>(cube.corner[2] + cube.lo[2]) - padding;
    out.upper_x = static_cast<float>(cube.corner[0] + cube.hi[0]) + padding;
    out.upper_y = static_cast<float>(cube.corner[1] + cube.hi[1]) + padding;
    out.upper_z = static_cast<float>(cube.corner[2] + cube.hi[2]) + padding;
}

void cube_intersect(const RTCIntersectFunctionNArguments *args)
{
    packet *const p = reinterpret_cast<packet *>(args->context);
    RTCRayN *const ray = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCHitN *const hit = RTCRayHitN_HitN(args->rayhit, args->N);
    unsigned active = 0;
    for (unsigned lane = 0; lane < args->N; lane++)
        if (args->valid[lane]) active |= 1u << RTCRayN_id(ray, args->N, lane);
    const unsigned hits = p->kernel->trace(cube_of(args->geometryUserPtr, args->primID), args->primID, p->rays, active);
    if (!hits) return;
    for (unsigned lane = 0; lane < args->N; lane++) {
        const unsigned id = RTCRayN_id(ray, args->N, lane);
        if (!args->valid[lane] || !(hits >> id & 1)) continue;
        /* Rounded up, or a cube with a hit at the very same place might not be proposed any more. */
        RTCRayN_tfar(ray, args->N, lane) =
            static_cast<float>(p->rays->t[id]) * (1 + 2 * std::numeric_limits<float>::epsilon());
        RTCHitN_geomID(hit, args->N, lane) = args->geomID;
        RTCHitN_primID(hit, args->N, lane) = args->primID;
    }
}

/** Fill lane `lane` of Embree's ray arrays (N lanes) from ray `id`. */
void load_lane(RTCRayHitN *rayhit, unsigned n, unsigned lane, const swarf_packet &rays, unsigned id)
{
    RTCRayN *const out = RTCRayHitN_RayN(rayhit, n);
    RTCRayN_org_x(out, n, lane) = static_cast<float>(rays.origin[0][id]);
    RTCRayN_org_y(out, n, lane) = static_cast<float>(rays.origin[1][id]);
    RTCRayN_org_z(out, n, lane) = static_cast<float>(rays.origin[2][id]);
    RTCRayN_dir_x(out, n, lane) = static_cast<float>(rays.direction[0][id]);
    RTCRayN_dir_y(out, n, lane) = static_cast<float>(rays.direction[1][id]);
    RTCRayN_dir_z(out, n, lane) = static_cast<float>(rays.direction[2][id]);
    RTCRayN_tnear(out, n, lane) = 0;
    RTCRayN_tfar(out, n, lane) = static_cast<float>(rays.t[id]);
    RTCRayN_time(out, n, lane) = 0;
    RTCRayN_mask(out, n, lane) = ~0u;
    RTCRayN_id(out, n, lane) = id;
    RTCRayN_flags(out, n, lane) = 0;
    RTCHitN_geomID(RTCRayHitN_HitN(rayhit, n), n, lane) = RTC_INVALID_GEOMETRY_ID;
    RTCHitN_instID(RTCRayHitN_HitN(rayhit, n), n, lane, 0) = RTC_INVALID_GEOMETRY_ID;
}

} // namespace

extern "C" swarf_status swarf_accel_create(swarf_accel **out)
{
    return swarf_guard("scene", [&]() -> swarf_status {
        SWARF_TRY(swarf_embree_check("device"));
        swarf_accel *accel = new swarf_accel{rtcNewScene(swarf_embree_device()), nullptr, nullptr};
        if (accel->scene) accel->geometry = rtcNewGeometry(swarf_embree_device(), RTC_GEOMETRY_TYPE_USER);
        if (!accel->geometry) {
            swarf_accel_destroy(accel);
            return swarf_embree_check("new scene");
        }
        rtcSetSceneFlags(accel->scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
        rtcSetGeometryUserData(accel->geometry, accel);
        rtcSetGeometryBoundsFunction(accel->geometry, cube_bounds, nullptr);
        rtcSetGeometryIntersectFunction(accel->geometry, cube_intersect);
        rtcAttachGeometry(accel->scene, accel->geometry);
        *out = accel;
        return SWARF_OK;
    });
}

extern "C" void swarf_accel_destroy(swarf_accel *accel)
{
    if (!accel) return;
    if (accel->geometry) rtcReleaseGeometry(accel->geometry);
    if (accel->scene) rtcReleaseScene(accel->scene);
    delete accel;
}

static void commit(swarf_accel *accel, const swarf_cube *const *cubes, size_t count)
{
    accel->cubes = cubes;
    rtcSetGeometryUserPrimitiveCount(accel->geometry, static_cast<unsigned>(count));
    rtcCommitGeometry(accel->geometry);
    rtcCommitScene(accel->scene);
}

extern "C" swarf_status swarf_accel_set(swarf_accel *accel, const swarf_cube *const *cubes, size_t count)
{
    return swarf_guard("scene", [&]() -> swarf_status {
        if (count > 0xfffffffeu) return swarf_fail(SWARF_ERROR_MEMORY, "scene: %zu cubes are too many", count);
        commit(accel, cubes, count);
        const swarf_status status = swarf_embree_check("cubes");
        if (status != SWARF_OK) commit(accel, nullptr, 0);
        return status;
    });
}

extern "C" void swarf_accel_trace(const swarf_accel *accel, swarf_packet *rays, unsigned active)
{
    packet p;
    p.rays = rays;
    p.kernel = swarf_ray_kernel_current();
    if (active == 0) return;
    const unsigned first = static_cast<unsigned>(__builtin_ctz(active));
    if ((active & (active - 1)) == 0) {
        RTCRayHit single;
        load_lane(reinterpret_cast<RTCRayHitN *>(&single), 1, 0, *rays, first);
        swarf_embree_intersect1(accel->scene, &single, &p.context);
        return;
    }
    alignas(64) int valid[SWARF_PACKET];
    RTCRayHit16 packet16;
    for (unsigned lane = 0; lane < SWARF_PACKET; lane++) {
        const bool is_active = active >> lane & 1;
        valid[lane] = is_active ? -1 : 0;
        /* Idle lanes repeat a ray: Embree may look at their numbers before the mask. */
        load_lane(reinterpret_cast<RTCRayHitN *>(&packet16), SWARF_PACKET, lane, *rays, is_active ? lane : first);
    }
    swarf_embree_intersect16(valid, accel->scene, &packet16, &p.context);
}
