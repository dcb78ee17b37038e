/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Navigating: cameras turned, moved and zoomed the way a hand at a mouse means it, and places in their pictures.
 *
 * Every change is made on a copy that is checked before it is handed back: a camera that works stays one that works.
 */
#include "base/status.h"
#include "base/vector.h"
#include "render/camera.h"

static const double radians = 0.017453292519943295;
/* A turntable stops this far from the poles: there `up` would be along the view. */
static const double pole_deg = 0.01;
/* Beyond these neither the numbers nor the picture mean anything. */
static const double least_scale = 1e-6, greatest_scale = 1e9;

static swarf_status check_point(const char *what, const double point[3])
{
    SWARF_REQUIRE(point, "camera: %s missing", what);
    for (int axis = 0; axis < 3; axis++)
        SWARF_REQUIRE(isfinite(point[axis]), "camera: %c of the %s is not finite", "xyz"[axis], what);
    return SWARF_OK;
}

/** Hand a changed camera back if it can be used. */
static swarf_status accept(const swarf_camera *changed, swarf_camera *camera)
{
    swarf_camera_frame frame;
    SWARF_TRY(swarf_camera_frame_make(changed, 1, &frame));
    *camera = *changed;
    return SWARF_OK;
}

static double target_distance(const swarf_camera *camera)
{
    double view[3];
    for (int axis = 0; axis < 3; axis++) view[axis] = camera->target[axis] - camera->eye[axis];
    return sqrt(vector_dot(view, view));
}

swarf_status swarf_camera_set_perspective(swarf_camera *camera, int perspective)
{
    SWARF_REQUIRE(camera, "camera: missing");
    swarf_camera changed = *camera;
    swarf_camera_frame frame;
    SWARF_TRY(swarf_camera_frame_make(camera, 1, &frame));
    if (frame.perspective == (perspective != 0)) return SWARF_OK;
    changed.perspective = perspective != 0;
    if (!(changed.fov_deg > 0 && changed.fov_deg < 180)) changed.fov_deg = 30;
    const double slope = tan(0.5 * changed.fov_deg * radians);
    if (perspective) {
        const double distance = frame.half[1] / slope;
        for (int axis = 0; axis < 3; axis++) changed.eye[axis] = changed.target[axis] - distance * frame.forward[axis];
    } else {
        changed.height_mm = 2 * slope * target_distance(camera);
    }
    return accept(&changed, camera);
}

static void turn(swarf_camera *camera, const double pivot[3], const double axis[3], double angle_rad)
{
    double *const points[2] = {camera->eye, camera->target};
    for (int point = 0; point < 2; point++) {
        double arm[3];
        for (int i = 0; i < 3; i++) arm[i] = points[point][i] - pivot[i];
        vector_turn(arm, axis, angle_rad);
        for (int i = 0; i < 3; i++) points[point][i] = pivot[i] + arm[i];
    }
    vector_turn(camera->up, axis, angle_rad);
}

swarf_status swarf_camera_turn(swarf_camera *camera, const double pivot[3], const double axis[3], double angle_deg)
{
    SWARF_REQUIRE(camera, "camera: missing");
    SWARF_TRY(check_point("pivot", pivot));
    SWARF_TRY(check_point("axis", axis));
    SWARF_REQUIRE(isfinite(angle_deg), "camera: the angle is not finite");
    double unit[3] = {axis[0], axis[1], axis[2]};
    SWARF_REQUIRE(vector_normalise(unit) > 0, "camera: the axis has no length");
    swarf_camera changed = *camera;
    turn(&changed, pivot, unit, angle_deg * radians);
    return accept(&changed, camera);
}

swarf_status swarf_camera_orbit(swarf_camera *camera, const double pivot[3], double right_deg, double up_deg,
                                int turntable)
{
    SWARF_REQUIRE(camera, "camera: missing");
    SWARF_TRY(check_point("pivot", pivot));
    SWARF_REQUIRE(isfinite(right_deg) && isfinite(up_deg), "camera: an angle is not finite");
    swarf_camera_frame frame;
    SWARF_TRY(swarf_camera_frame_make(camera, 1, &frame));
    swarf_camera changed = *camera;
    if (turntable) {
        /* Upright first: of a camera that looks along the vertical `up` tells where its back is. */
        static const double vertical[3] = {0, 0, 1};
        const double steepness = asin(fmax(-1, fmin(1, frame.forward[2]))) / radians;
        double level[3] = {frame.up[0], frame.up[1], 0};
        if (fabs(frame.forward[2]) < sin((90 - pole_deg) * radians)) {
            vector_cross(vertical, frame.forward, level); /* to the left */
            vector_cross(level, vertical, level);
        } else if (frame.forward[2] > 0) {
            level[0] = -level[0], level[1] = -level[1];
        }
        (void)vector_normalise(level);
        /* Dragged upwards the part tips its top away: the eye sinks. */
        const double wanted = fmax(-90 + pole_deg, fmin(90 - pole_deg, steepness + up_deg));
        double right[3];
        vector_cross(level, vertical, right);
        turn(&changed, pivot, right, (wanted - steepness) * radians);
        turn(&changed, pivot, vertical, -right_deg * radians);
        changed.up[0] = changed.up[1] = 0;
        changed.up[2] = 1;
    } else {
        for (int axis = 0; axis < 3; axis++) changed.up[axis] = frame.up[axis];
        turn(&changed, pivot, frame.up, -right_deg * radians);
        turn(&changed, pivot, frame.right, up_deg * radians);
    }
    return accept(&changed, camera);
}

swarf_status swarf_camera_pan(swarf_camera *camera, double x, double y, const double *depth_of)
{
    SWARF_REQUIRE(camera, "camera: missing");
    SWARF_REQUIRE(isfinite(x) && isfinite(y), "camera: the way is not finite");
    if (!depth_of) depth_of = camera->target;
    SWARF_TRY(check_point("point", depth_of));
    swarf_camera_frame frame;
    SWARF_TRY(swarf_camera_frame_make(camera, 1, &frame));
    double height = 2 * frame.half[1];
    if (frame.perspective) {
        double depth = 0;
        for (int axis = 0; axis < 3; axis++) depth += (depth_of[axis] - camera->eye[axis]) * frame.forward[axis];
        height *= depth > 0 ? depth : target_distance(camera);
    }
    swarf_camera changed = *camera;
    for (int axis = 0; axis < 3; axis++) {
        const double way = -height * (x * frame.right[axis] + y * frame.up[axis]);
        changed.eye[axis] += way;
        changed.target[axis] += way;
    }
    return accept(&changed, camera);
}

swarf_status swarf_camera_zoom(swarf_camera *camera, double factor, const double toward[3])
{
    SWARF_REQUIRE(camera, "camera: missing");
    SWARF_REQUIRE(isfinite(factor) && factor > 0, "camera: zoom by %g is not positive", factor);
    SWARF_TRY(check_point("point to zoom to", toward));
    swarf_camera_frame frame;
    SWARF_TRY(swarf_camera_frame_make(camera, 1, &frame));
    const double scale = frame.perspective ? target_distance(camera) : camera->height_mm;
    factor = fmin(fmax(factor, scale / greatest_scale), scale / least_scale);
    swarf_camera changed = *camera;
    changed.height_mm = camera->height_mm / factor;
    for (int axis = 0; axis < 3; axis++) {
        changed.eye[axis] = toward[axis] + (camera->eye[axis] - toward[axis]) / factor;
        changed.target[axis] = toward[axis] + (camera->target[axis] - toward[axis]) / factor;
    }
    return accept(&changed, camera);
}

swarf_status swarf_camera_ray(const swarf_camera *camera, double aspect, double x, double y, double origin[3],
                              double direction[3])
{
    SWARF_REQUIRE(camera && origin && direction, "camera: camera or output missing");
    SWARF_REQUIRE(isfinite(x) && isfinite(y), "camera: the place in the picture is not finite");
    swarf_camera_frame frame;
    SWARF_TRY(swarf_camera_frame_make(camera, aspect, &frame));
    swarf_camera_frame_ray(&frame, x, y, origin, direction);
    (void)vector_normalise(direction);
    return SWARF_OK;
}

swarf_status swarf_camera_project(const swarf_camera *camera, double aspect, const double point[3], double out[3])
{
    SWARF_REQUIRE(camera && out, "camera: camera or output missing");
    SWARF_TRY(check_point("point", point));
    swarf_camera_frame frame;
    SWARF_TRY(swarf_camera_frame_make(camera, aspect, &frame));
    swarf_camera_frame_project(&frame, point, out);
    return SWARF_OK;
}
