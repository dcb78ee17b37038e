/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* From places in a picture to rays. */
#ifndef SWARF_RENDER_CAMERA_H
#define SWARF_RENDER_CAMERA_H

#include "swarf/render.h"

/** A camera made ready: its orthonormal frame and half the picture's height and width, in mm for parallel rays and
 *  per unit of depth for perspective ones. */
typedef struct swarf_camera_frame {
    double eye[3];
    double right[3];
    double up[3];
    double forward[3];
    double half[2];
    int perspective;
} swarf_camera_frame;

/** SWARF_ERROR_ARGUMENT: a number that is not finite, eye at target, `up` along the view, height or angle out of range.
 */
swarf_status swarf_camera_frame_make(const swarf_camera *camera, double aspect, swarf_camera_frame *out);

/** Ray through (x, y) of the picture, each -1 .. 1, x to the right and y upwards. */
void swarf_camera_frame_ray(const swarf_camera_frame *frame, double x, double y, double origin[3], double direction[3]);

/** Place (x, y) and depth along the view at which a point appears; x and y NAN when it is not before the eye. */
void swarf_camera_frame_project(const swarf_camera_frame *frame, const double point[3], double out[3]);

#endif
