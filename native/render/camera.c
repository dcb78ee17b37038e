/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Camera: presets that show a whole box, and the rays of a picture.
 *
 * The frame is right-handed seen from behind: right x up = -forward. Presets turn the way FreeCAD's views do.
 */
#include "render/camera.h"

#include "base/status.h"
#include "base/vector.h"

/* Opening angle of the presets: close to a 50 mm photographic lens, edges hardly converge. */
static const double preset_fov_deg = 30.0;
/* Picture height over box height: leaves 4 % of air on each side. */
static const double margin = 1.08;

static const double radians = 0.017453292519943295;

swarf_status swarf_camera_frame_make(const swarf_camera *camera, double aspect, swarf_camera_frame *out)
{
    SWARF_REQUIRE(camera && out, "camera: missing");
    SWARF_REQUIRE(isfinite(aspect) && aspect > 0, "camera: aspect %g is not a positive number", aspect);
    swarf_camera_frame frame;
    double up[3];
    for (int axis = 0; axis < 3; axis++) {
        SWARF_REQUIRE(isfinite(camera->eye[axis]) && isfinite(camera->target[axis]) && isfinite(camera->up[axis]),
                      "camera: %c of eye, target or up is not finite", "xyz"[axis]);
        frame.eye[axis] = camera->eye[axis];
        frame.forward[axis] = camera->target[axis] - camera->eye[axis];
        up[axis] = camera->up[axis];
    }
    SWARF_REQUIRE(vector_normalise(frame.forward) > 0, "camera: eye and target are the same point");
    SWARF_REQUIRE(vector_normalise(up) > 0, "camera: up has no length");
    vector_cross(frame.forward, up, frame.right);
    /* Below this the frame would turn with the rounding of its inputs. */
    SWARF_REQUIRE(vector_normalise(frame.right) > 1e-9, "camera: up is along the view");
    vector_cross(frame.right, frame.forward, frame.up);
    frame.perspective = camera->perspective != 0;
    if (frame.perspective) {
        SWARF_REQUIRE(camera->fov_deg > 0 && camera->fov_deg < 180,
                      "camera: opening angle %g is not in 0 .. 180 degrees", camera->fov_deg);
        frame.half[1] = tan(0.5 * camera->fov_deg * radians);
    } else {
        SWARF_REQUIRE(isfinite(camera->height_mm) && camera->height_mm > 0, "camera: height %g mm is not positive",
                      camera->height_mm);
        frame.half[1] = 0.5 * camera->height_mm;
    }
    frame.half[0] = frame.half[1] * aspect;
    *out = frame;
    return SWARF_OK;
}

void swarf_camera_frame_ray(const swarf_camera_frame *frame, double x, double y, double origin[3], double direction[3])
{
    for (int axis = 0; axis < 3; axis++) {
        const double offset = frame->right[axis] * (x * frame->half[0]) + frame->up[axis] * (y * frame->half[1]);
        origin[axis] = frame->perspective ? frame->eye[axis] : frame->eye[axis] + offset;
        direction[axis] = frame->perspective ? frame->forward[axis] + offset : frame->forward[axis];
    }
}

void swarf_camera_frame_project(const swarf_camera_frame *frame, const double point[3], double out[3])
{
    double arm[3];
    for (int axis = 0; axis < 3; axis++) arm[axis] = point[axis] - frame->eye[axis];
    const double depth = vector_dot(arm, frame->forward), scale = frame->perspective ? depth : 1;
    out[0] = scale > 0 ? vector_dot(arm, frame->right) / (frame->half[0] * scale) : NAN;
    out[1] = scale > 0 ? vector_dot(arm, frame->up) / (frame->half[1] * scale) : NAN;
    out[2] = depth;
}

/** Centre and half extents of a box; an empty one is 1 mm wide at the origin. */
static swarf_status measure_box(const swarf_box *box, double centre[3], double half[3])
{
    int empty = 0;
    for (int axis = 0; axis < 3; axis++) {
        SWARF_REQUIRE(!isnan(box->lo[axis]) && !isnan(box->hi[axis]), "camera: %c of the box is not a number",
                      "xyz"[axis]);
        if (box->lo[axis] > box->hi[axis]) empty = 1;
    }
    for (int axis = 0; axis < 3; axis++) {
        centre[axis] = empty ? 0 : 0.5 * (box->lo[axis] + box->hi[axis]);
        half[axis] = empty ? 0.5 : 0.5 * (box->hi[axis] - box->lo[axis]);
        SWARF_REQUIRE(isfinite(centre[axis]) && isfinite(half[axis]), "camera: %c of the box is infinite", "xyz"[axis]);
    }
    return SWARF_OK;
}

swarf_status swarf_camera_fit_box(swarf_camera *camera, const swarf_box *box, double aspect)
{
    SWARF_REQUIRE(camera && box, "camera: camera or box missing");
    double centre[3], half[3], extent[3] = {0, 0, 0}, distance = 0;
    swarf_camera_frame frame;
    SWARF_TRY(swarf_camera_frame_make(camera, aspect, &frame));
    SWARF_TRY(measure_box(box, centre, half));
    const double slope = frame.perspective ? frame.half[1] : tan(0.5 * preset_fov_deg * radians);
    for (int corner = 0; corner < 8; corner++) {
        double q[3];
        for (int axis = 0; axis < 3; axis++) q[axis] = corner >> axis & 1 ? half[axis] : -half[axis];
        const double x = fabs(vector_dot(q, frame.right)), y = fabs(vector_dot(q, frame.up));
        const double z = vector_dot(q, frame.forward);
        extent[0] = fmax(extent[0], x);
        extent[1] = fmax(extent[1], y);
        extent[2] = fmax(extent[2], z);
        distance = fmax(distance, fmax(y, x / aspect) * margin / slope - z);
    }
    const double size = fmax(fmax(extent[0], extent[1]), extent[2]);
    const double height = 2 * margin * fmax(extent[1], extent[0] / aspect);
    if (!frame.perspective) distance = extent[2] + size;
    if (size == 0) distance = 1; /* a single point */
    camera->height_mm = height > 0 ? height : 1;
    for (int axis = 0; axis < 3; axis++) {
        camera->target[axis] = centre[axis];
        camera->eye[axis] = centre[axis] - distance * frame.forward[axis];
    }
    return SWARF_OK;
}

swarf_status swarf_camera_fit(swarf_view view, int perspective, const swarf_box *box, double aspect, swarf_camera *out)
{
    static const struct {
        double forward[3], up[3];
    } presets[SWARF_VIEW_COUNT] = {
        [SWARF_VIEW_ISOMETRIC] = {{-1, 1, -1}, {0, 0, 1}}, [SWARF_VIEW_TOP] = {{0, 0, -1}, {0, 1, 0}},
        [SWARF_VIEW_BOTTOM] = {{0, 0, 1}, {0, -1, 0}},     [SWARF_VIEW_FRONT] = {{0, 1, 0}, {0, 0, 1}},
        [SWARF_VIEW_REAR] = {{0, -1, 0}, {0, 0, 1}},       [SWARF_VIEW_LEFT] = {{1, 0, 0}, {0, 0, 1}},
        [SWARF_VIEW_RIGHT] = {{-1, 0, 0}, {0, 0, 1}},
    };
    SWARF_REQUIRE(box && out, "camera: box or output missing");
    SWARF_REQUIRE((int)view >= 0 && (int)view < SWARF_VIEW_COUNT, "camera: no view %d", (int)view);
    swarf_camera camera = {.perspective = perspective != 0, .fov_deg = preset_fov_deg, .height_mm = 1};
    for (int axis = 0; axis < 3; axis++) {
        camera.eye[axis] = -presets[view].forward[axis];
        camera.up[axis] = presets[view].up[axis];
    }
    SWARF_TRY(swarf_camera_fit_box(&camera, box, aspect));
    *out = camera;
    return SWARF_OK;
}
