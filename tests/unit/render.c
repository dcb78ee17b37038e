/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Rays over a stock: against closed forms, against marching through the samples, and packets against single rays. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"

static const double degree = 0.017453292519943295;

static swarf_stock_options voxels(double voxel_mm)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel_mm;
    return options;
}

static double angle_between(const float normal[3], double x, double y, double z)
{
    const double sine[3] = {normal[1] * z - normal[2] * y, normal[2] * x - normal[0] * z,
                            normal[0] * y - normal[1] * x};
    return atan2(sqrt(sine[0] * sine[0] + sine[1] * sine[1] + sine[2] * sine[2]),
                 normal[0] * x + normal[1] * y + normal[2] * z);
}

/** Rays onto points of the six faces of a block, at least two voxels from the edges, from up to 60 degrees aside. */
static void check_block(test_random *random)
{
    const double voxel = 0.25;
    const swarf_box box = {{-3.1, 2.03, 100.7}, {18.4, 12.2, 111.11}};
    const swarf_stock_options options = voxels(voxel);
    swarf_stock *stock = NULL;
    swarf_scene *scene = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&box, &options, &stock))) return;
    if (!CHECK_OK(swarf_scene_create(stock, &scene))) return;
    double worst_distance = 0, worst_angle = 0;
    for (int trial = 0; trial < 3000; trial++) {
        const int axis = trial % 3, side = trial / 3 % 2;
        double point[3], origin[3], direction[3], distance, normal[3] = {0, 0, 0};
        normal[axis] = side ? 1 : -1;
        for (int i = 0; i < 3; i++) point[i] = test_random_in(random, box.lo[i] + 2 * voxel, box.hi[i] - 2 * voxel);
        point[axis] = side ? box.hi[axis] : box.lo[axis];
        for (int i = 0; i < 3; i++) direction[i] = -normal[i] + (i == axis ? 0 : test_random_in(random, -1.2, 1.2));
        const double away = test_random_in(random, 0.3, 3000);
        for (int i = 0; i < 3; i++) origin[i] = point[i] - away * direction[i];
        float found[3];
        if (!CHECK_OK(swarf_scene_cast(scene, origin, direction, 1, &distance, found))) break;
        /* Along the normal, whatever the ray's slope: direction[axis] is 1. */
        worst_distance = fmax(worst_distance, isfinite(distance) ? fabs(distance - away) : INFINITY);
        worst_angle = fmax(worst_angle, angle_between(found, normal[0], normal[1], normal[2]));
    }
    CHECK_NEAR(worst_distance / voxel, 0, 0.02);
    CHECK_NEAR(worst_angle / degree, 0, 1);
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
}

/** Rays onto the mantle of a bar that lies askew. */
static void check_bar(test_random *random)
{
    const double voxel = 0.1, radius = 7, base[3] = {3, -2, 1}, axis[3] = {8, 5, -6};
    const double length = sqrt(64 + 25 + 36), along[3] = {8 / length, 5 / length, -6 / length};
    /* Two directions across the axis. */
    const double ground = sqrt(64 + 25), e[3] = {-5 / ground, 8 / ground, 0};
    const double f[3] = {along[1] * e[2] - along[2] * e[1], along[2] * e[0] - along[0] * e[2],
                         along[0] * e[1] - along[1] * e[0]};
    const swarf_stock_options options = voxels(voxel);
    swarf_stock *stock = NULL;
    swarf_scene *scene = NULL;
    if (!CHECK_OK(swarf_stock_create_cylinder(base, axis, radius, &options, &stock))) return;
    if (!CHECK_OK(swarf_scene_create(stock, &scene))) return;
    double worst_distance = 0, worst_angle = 0;
    for (int trial = 0; trial < 3000; trial++) {
        const double turn = test_random_in(random, 0, 6.283185307), height = test_random_in(random, 0.5, length - 0.5);
        double origin[3], direction[3], normal[3], distance;
        for (int i = 0; i < 3; i++) {
            normal[i] = cos(turn) * e[i] + sin(turn) * f[i];
            direction[i] = -normal[i] + test_random_in(random, -0.3, 0.3);
        }
        const double away = test_random_in(random, 0.4, 2000);
        for (int i = 0; i < 3; i++) origin[i] = base[i] + height * along[i] + radius * normal[i] - away * direction[i];
        float found[3];
        if (!CHECK_OK(swarf_scene_cast(scene, origin, direction, 1, &distance, found))) break;
        const double steepness = -(direction[0] * normal[0] + direction[1] * normal[1] + direction[2] * normal[2]);
        worst_distance = fmax(worst_distance, isfinite(distance) ? fabs(distance - away) * steepness : INFINITY);
        worst_angle = fmax(worst_angle, angle_between(found, normal[0], normal[1], normal[2]));
    }
    CHECK_NEAR(worst_distance / voxel, 0, 0.02);
    CHECK_NEAR(worst_angle / degree, 0, 1);
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
}

static double sample_at(swarf_stock *stock, const double origin[3], const double direction[3], double t)
{
    const double point[3] = {origin[0] + t * direction[0], origin[1] + t * direction[1], origin[2] + t * direction[2]};
    float value = NAN;
    CHECK_OK(swarf_stock_sample(stock, point, 1, &value));
    return value;
}

/** One hit or miss against the field's own samples, every 0.1 voxel along the ray. */
static void check_ray(swarf_stock *stock, const double origin[3], const double direction[3], double reach,
                      double distance)
{
    enum { STEPS_MAX = 4096 };
    static double points[STEPS_MAX * 3];
    static float values[STEPS_MAX];
    const double voxel = swarf_stock_voxel(stock), step = 0.1 * voxel;
    const size_t steps = (size_t)(reach / step);
    if (!CHECK(steps > 1 && steps <= STEPS_MAX)) return;
    for (size_t i = 0; i < steps; i++)
        for (int axis = 0; axis < 3; axis++) points[3 * i + axis] = origin[axis] + step * (double)i * direction[axis];
    if (!CHECK_OK(swarf_stock_sample(stock, points, steps, values))) return;
    if (values[0] < 0) { /* starts in material: no surface is met from outside */
        CHECK(isinf(distance));
        return;
    }
    size_t inside = 0;
    while (inside < steps && !(values[inside] < -1e-5 * voxel)) inside++;
    if (inside < steps) CHECK(distance <= step * (double)inside);
    if (isinf(distance)) return;
    /* The hit itself is a change of sign; marching may have stepped over a graze, never the other way round. */
    const double bit = 1e-3 * voxel;
    CHECK_NEAR(sample_at(stock, origin, direction, distance) / voxel, 0, 1e-3);
    CHECK(sample_at(stock, origin, direction, distance - bit) > -1e-5 * voxel);
    CHECK(sample_at(stock, origin, direction, distance + bit) < 1e-5 * voxel);
    if (inside < steps)
        CHECK(distance > step * ((double)inside - 1) || sample_at(stock, origin, direction, distance + bit) < 0);
}

/** 10,000 rays from all around and from within, some along the grid's own lines, against marching; the same rays one
 *  by one and on other numbers of threads give the same bits. */
static void check_field(test_random *random)
{
    enum { RAYS = 10000 };
    const double voxel = 0.5, base[3] = {-4, -5, -3}, axis[3] = {6, 7, 8};
    const swarf_stock_options options = voxels(voxel);
    swarf_stock *stock = NULL;
    swarf_scene *scene = NULL;
    if (!CHECK_OK(swarf_stock_create_cylinder(base, axis, 4.3, &options, &stock))) return;
    if (!CHECK_OK(swarf_scene_create(stock, &scene))) return;
    double *origin = malloc(RAYS * 3 * sizeof(double)), *direction = malloc(RAYS * 3 * sizeof(double));
    double *distance = malloc(RAYS * sizeof(double)), *again = malloc(RAYS * sizeof(double));
    float *normal = malloc(RAYS * 3 * sizeof(float)), *normal_again = malloc(RAYS * 3 * sizeof(float));
    if (!CHECK(origin && direction && distance && again && normal && normal_again)) return;
    swarf_box box;
    CHECK_OK(swarf_stock_box(stock, &box));
    for (size_t ray = 0; ray < RAYS; ray++) {
        double *o = origin + 3 * ray, *d = direction + 3 * ray, length = 0;
        for (int i = 0; i < 3; i++) {
            o[i] = test_random_in(random, box.lo[i] - 8, box.hi[i] + 8);
            d[i] = test_random_in(random, box.lo[i], box.hi[i]) - o[i];
        }
        if (ray % 4 == 0) { /* along an axis, at a multiple of half a voxel: on the planes between cells */
            for (int i = 0; i < 3; i++) {
                o[i] = box.lo[i] + 0.5 * voxel * floor((o[i] - box.lo[i]) / (0.5 * voxel));
                if (i != (int)(ray / 4 % 3)) d[i] = 0;
            }
        }
        for (int i = 0; i < 3; i++) length += d[i] * d[i];
        if (length == 0) d[0] = length = 1;
        for (int i = 0; i < 3; i++) d[i] /= sqrt(length);
    }
    CHECK_OK(swarf_scene_cast(scene, origin, direction, RAYS, distance, normal));
    size_t hits = 0;
    for (size_t ray = 0; ray < RAYS; ray++) {
        hits += isfinite(distance[ray]);
        check_ray(stock, origin + 3 * ray, direction + 3 * ray, 40, distance[ray]);
    }
    CHECK(hits > RAYS / 4 && hits < RAYS);
    for (size_t ray = 0; ray < RAYS; ray++)
        CHECK_OK(
            swarf_scene_cast(scene, origin + 3 * ray, direction + 3 * ray, 1, again + ray, normal_again + 3 * ray));
    CHECK(memcmp(distance, again, RAYS * sizeof(double)) == 0);
    CHECK(memcmp(normal, normal_again, RAYS * 3 * sizeof(float)) == 0);
    for (int threads = 1; threads <= 8; threads += threads == 3 ? 5 : 1) {
        CHECK_OK(swarf_threads_set(threads));
        memset(again, 0, RAYS * sizeof(double));
        CHECK_OK(swarf_scene_cast(scene, origin, direction, RAYS, again, NULL));
        CHECK(memcmp(distance, again, RAYS * sizeof(double)) == 0);
    }
    CHECK_OK(swarf_threads_set(0));
    free(origin);
    free(direction);
    free(distance);
    free(again);
    free(normal);
    free(normal_again);
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
}

/** No holes: rays down the top of a block at every voxel centre, plane and edge between cells and leaves. */
static void check_holes(void)
{
    const double voxel = 0.5;
    const swarf_box box = {{0, 0, 0}, {20, 17, 3}};
    const swarf_stock_options options = voxels(voxel);
    swarf_stock *stock = NULL;
    swarf_scene *scene = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&box, &options, &stock))) return;
    if (!CHECK_OK(swarf_scene_create(stock, &scene))) return;
    int missed = 0, wrong = 0;
    for (int x = 2; x < 78; x++) {
        for (int y = 2; y < 66; y++) {
            const double origin[3] = {0.25 * x, 0.25 * y, 50}, direction[3] = {0, 0, -2};
            double distance;
            float normal[3];
            CHECK_OK(swarf_scene_cast(scene, origin, direction, 1, &distance, normal));
            missed += isinf(distance);
            wrong += !(fabs(distance - 23.5) < 0.01 * voxel && normal[2] > 0.9999f);
        }
    }
    CHECK(missed == 0);
    CHECK(wrong == 0);
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
}

static void check_refusals(void)
{
    const swarf_box box = {{0, 0, 0}, {4, 4, 4}};
    const swarf_stock_options options = voxels(0.5);
    swarf_stock *stock = NULL;
    swarf_scene *scene = NULL;
    CHECK_FAILS(swarf_scene_create(NULL, &scene), SWARF_ERROR_ARGUMENT, "stock");
    swarf_scene_destroy(NULL);
    if (!CHECK_OK(swarf_stock_create_box(&box, &options, &stock))) return;
    CHECK_FAILS(swarf_scene_create(stock, NULL), SWARF_ERROR_ARGUMENT, NULL);
    if (!CHECK_OK(swarf_scene_create(stock, &scene))) return;
    const double origin[6] = {2, 2, 9, 2, 2, 9}, down[6] = {0, 0, -1, 0, 0, -1}, zero[6] = {0, 0, -1, 0, 0, 0};
    const double bad[6] = {2, 2, 9, 2, NAN, 9}, within[3] = {2, 2, 2}, far[3] = {1e300, 2, 2};
    double distance[2] = {7, 7};
    CHECK_FAILS(swarf_scene_cast(scene, bad, down, 2, distance, NULL), SWARF_ERROR_ARGUMENT, "ray 1");
    CHECK_FAILS(swarf_scene_cast(scene, origin, zero, 2, distance, NULL), SWARF_ERROR_ARGUMENT, "ray 1");
    CHECK_FAILS(swarf_scene_cast(scene, origin, NULL, 2, distance, NULL), SWARF_ERROR_ARGUMENT, NULL);
    CHECK(distance[0] == 7 && distance[1] == 7);
    CHECK_OK(swarf_scene_cast(scene, NULL, NULL, 0, NULL, NULL));
    CHECK_OK(swarf_scene_cast(scene, within, down, 1, distance, NULL));
    CHECK(isinf(distance[0]));
    CHECK_OK(swarf_scene_cast(scene, far, down, 1, distance, NULL));
    CHECK(isinf(distance[0]));
    CHECK_OK(swarf_scene_cast(scene, origin, down, 2, distance, NULL));
    CHECK_NEAR(distance[0], 5, 0.005);
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
}

int main(void)
{
    test_random random = test_random_begin(23);
    check_block(&random);
    check_bar(&random);
    check_field(&random);
    check_holes();
    check_refusals();
    return test_end();
}
