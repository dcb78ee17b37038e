/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files that use Embree share: its header, of Embree 3.13 or Embree 4, and the device. */
#ifndef SWARF_RENDER_EMBREE_DEVICE_HPP
#define SWARF_RENDER_EMBREE_DEVICE_HPP

#include "base/guard.hpp"

#if SWARF_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
using swarf_embree_context = RTCRayQueryContext;
#else
#include <embree3/rtcore.h>
using swarf_embree_context = RTCIntersectContext;
#endif

/* One for the process, on first use, never released: releasing many crashed Embree 3. */
inline RTCDevice swarf_embree_device()
{
    static const RTCDevice device = rtcNewDevice(nullptr);
    return device;
}

/* What Embree's last error on this thread comes to; SWARF_OK when there is none. */
inline swarf_status swarf_embree_check(const char *what)
{
    RTCDevice device = swarf_embree_device();
    const RTCError error = rtcGetDeviceError(device);
    if (device && error == RTC_ERROR_NONE) return SWARF_OK;
    if (!device)
        return swarf_fail(SWARF_ERROR_INTERNAL, "scene: Embree does not start (error %d)", static_cast<int>(error));
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        return swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory in Embree (%s)", what);
    return swarf_fail(SWARF_ERROR_INTERNAL, "scene: Embree error %d (%s)", static_cast<int>(error), what);
}

/* Intersect sixteen coherent rays of a packet; `context` reaches the callbacks. */
inline void swarf_embree_intersect16(const int *valid, RTCScene scene, RTCRayHit16 *rays, swarf_embree_context *context)
{
#if SWARF_EMBREE_MAJOR >= 4
    rtcInitRayQueryContext(context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = context;
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect16(valid, scene, rays, &arguments);
#else
    rtcInitIntersectContext(context);
    context->flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, scene, context, rays);
#endif
}

#endif
