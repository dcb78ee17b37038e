/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cameras: the presets show the whole box, from the right side. */
#include <math.h>
#include <string.h>

#include "test.h"

/** Place of a point in the picture, -1 .. 1 each, by definition of swarf_camera, independently of the library. */
static void project(const swarf_camera *camera, double aspect, const double point[3], double out[3])
{
    double f[3], r[3], u[3], q[3], length = 0;
    for (int i = 0; i < 3; i++) f[i] = camera->target[i] - camera->eye[i];
    for (int i = 0; i < 3; i++) length += f[i] * f[i];
    for (int i = 0; i < 3; i++) f[i] /= sqrt(length);
    for (int i = 0; i < 3; i++)
        r[i] = f[(i + 1) % 3] * camera->up[(i + 2) % 3] - f[(i + 2) % 3] * camera->up[(i + 1) % 3];
    length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    for (int i = 0; i < 3; i++) r[i] /= length;
    for (int i = 0; i < 3; i++) u[i] = r[(i + 1) % 3] * f[(i + 2) % 3] - r[(i + 2) % 3] * f[(i + 1) % 3];
    for (int i = 0; i < 3; i++) q[i] = point[i] - camera->eye[i];
    const double x = q[0] * r[0] + q[1] * r[1] + q[2] * r[2], y = q[0] * u[0] + q[1] * u[1] + q[2] * u[2];
    out[2] = q[0] * f[0] + q[1] * f[1] + q[2] * f[2];
    const double half =
        camera->perspective ? out[2] * tan(camera->fov_deg * 3.14159265358979323846 / 360) : camera->height_mm / 2;
    out[0] = x / (half * aspect);
    out[1] = y / half;
}

static void check_fit(const swarf_box *box, int view, int perspective, double aspect)
{
    swarf_camera camera;
    if (!CHECK_OK(swarf_camera_fit((swarf_view)view, perspective, box, aspect, &camera))) return;
    CHECK(camera.perspective == perspective);
    double reach = 0;
    for (int corner = 0; corner < 8; corner++) {
        const double point[3] = {corner & 1 ? box->hi[0] : box->lo[0], corner & 2 ? box->hi[1] : box->lo[1],
                                 corner & 4 ? box->hi[2] : box->lo[2]};
        double place[3];
        project(&camera, aspect, point, place);
        CHECK(place[2] > 0);
        reach = fmax(reach, fmax(fabs(place[0]), fabs(place[1])));
    }
    CHECK(reach < 0.97 && reach > 0.85); /* inside, with a small margin only */
}

static void check_sides(void)
{
    /* A point of the box and where it must appear: sign of x and y, and whether it is nearer than the centre. */
    static const struct {
        swarf_view view;
        double point[3];
        int x, y;
    } sides[] = {
        {SWARF_VIEW_TOP, {1, 1, 1}, 1, 1},       {SWARF_VIEW_BOTTOM, {1, 1, -1}, 1, -1},
        {SWARF_VIEW_FRONT, {1, -1, 1}, 1, 1},    {SWARF_VIEW_REAR, {1, 1, 1}, -1, 1},
        {SWARF_VIEW_LEFT, {-1, 1, 1}, -1, 1},    {SWARF_VIEW_RIGHT, {1, 1, 1}, 1, 1},
        {SWARF_VIEW_ISOMETRIC, {1, 0, 1}, 1, 1},
    };
    const swarf_box box = {{-1, -1, -1}, {1, 1, 1}};
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        swarf_camera camera;
        if (!CHECK_OK(swarf_camera_fit(sides[i].view, 0, &box, 1, &camera))) continue;
        const double centre[3] = {0, 0, 0};
        double at[3], middle[3];
        project(&camera, 1, sides[i].point, at);
        project(&camera, 1, centre, middle);
        CHECK_NEAR(middle[0], 0, 1e-12);
        CHECK_NEAR(middle[1], 0, 1e-12);
        CHECK(at[0] * sides[i].x > 0.1);
        CHECK(at[1] * sides[i].y > 0.1);
        CHECK(at[2] < middle[2] - 0.5);
    }
}

static void check_errors(void)
{
    const swarf_box box = {{0, 0, 0}, {1, 2, 3}}, nan_box = {{0, NAN, 0}, {1, 1, 1}};
    const swarf_box infinite = {{0, 0, 0}, {1, INFINITY, 1}}, empty = {{1, 1, 1}, {-1, -1, -1}};
    swarf_camera camera, untouched;
    memset(&camera, 0x5a, sizeof camera);
    memcpy(&untouched, &camera, sizeof camera);
    CHECK_FAILS(swarf_camera_fit(SWARF_VIEW_COUNT, 0, &box, 1, &camera), SWARF_ERROR_ARGUMENT, "view 7");
    CHECK_FAILS(swarf_camera_fit((swarf_view)-1, 0, &box, 1, &camera), SWARF_ERROR_ARGUMENT, "view");
    CHECK_FAILS(swarf_camera_fit(SWARF_VIEW_TOP, 0, &box, 0, &camera), SWARF_ERROR_ARGUMENT, "aspect");
    CHECK_FAILS(swarf_camera_fit(SWARF_VIEW_TOP, 0, &box, NAN, &camera), SWARF_ERROR_ARGUMENT, "aspect");
    CHECK_FAILS(swarf_camera_fit(SWARF_VIEW_TOP, 0, &nan_box, 1, &camera), SWARF_ERROR_ARGUMENT, "y of the box");
    CHECK_FAILS(swarf_camera_fit(SWARF_VIEW_TOP, 0, &infinite, 1, &camera), SWARF_ERROR_ARGUMENT, "y of the box");
    CHECK_FAILS(swarf_camera_fit(SWARF_VIEW_TOP, 0, NULL, 1, &camera), SWARF_ERROR_ARGUMENT, NULL);
    CHECK(memcmp(&camera, &untouched, sizeof camera) == 0);
    if (CHECK_OK(swarf_camera_fit(SWARF_VIEW_TOP, 0, &empty, 1, &camera))) CHECK(camera.height_mm > 0);
}

int main(void)
{
    test_random random = test_random_begin(11);
    for (int view = 0; view < SWARF_VIEW_COUNT; view++) {
        for (int trial = 0; trial < 60; trial++) {
            swarf_box box;
            for (int axis = 0; axis < 3; axis++) {
                box.lo[axis] = test_random_in(&random, -500, 500);
                box.hi[axis] = box.lo[axis] + pow(10, test_random_in(&random, -1, 3));
            }
            check_fit(&box, view, trial % 2, pow(2, test_random_in(&random, -2, 2)));
        }
        const swarf_box plate = {{0, 0, 5}, {100, 60, 5}}; /* flat: seen from the side it is a line */
        swarf_camera camera;
        for (int perspective = 0; perspective < 2; perspective++)
            if (CHECK_OK(swarf_camera_fit((swarf_view)view, perspective, &plate, 1.5, &camera)))
                CHECK(camera.height_mm > 0 && isfinite(camera.height_mm));
    }
    check_sides();
    check_errors();
    return test_end();
}
