/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Scenes: what rays meet does not depend on threads, instruction set and grouping; many views without holes; a scene
 * that follows its stock is the scene made anew. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"

enum { RAYS = 4000 };

typedef struct part {
    swarf_stock *stock;
    swarf_box box;
    double voxel;
} part;

static swarf_path line(const double a[3], const double b[3])
{
    swarf_path path = {.has_motion = 1};
    memcpy(path.start, a, sizeof path.start);
    memcpy(path.end, b, sizeof path.end);
    return path;
}

/** Cut `count` random slots, sloping and crossing. */
static void cut_slots(part *p, int count, test_random *random)
{
    static const char *const texts[] = {"flat:d=3,l=18", "ball:d=4,l=18", "bull:d=5,r=1,l=18",
                                        "dovetail:d=6,a=60,h=2,n=2,l=18"};
    for (int i = 0; i < count; i++) {
        swarf_cutter *cutter = NULL;
        double a[3], b[3];
        for (int axis = 0; axis < 3; axis++) {
            a[axis] = test_random_in(random, p->box.lo[axis] - 2, p->box.hi[axis] + 2);
            b[axis] = test_random_in(random, p->box.lo[axis] - 2, p->box.hi[axis] + 2);
        }
        const swarf_path path = line(a, b);
        if (!CHECK_OK(swarf_cutter_parse(texts[test_random_below(random, 4)], &cutter))) return;
        CHECK_OK(swarf_stock_cut(p->stock, cutter, &path, 1, NULL));
        swarf_cutter_release(cutter);
    }
}

static part make_part(double voxel)
{
    part p = {.box = {{-3, 2, 100}, {21, 19, 109}}, .voxel = voxel};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    CHECK_OK(swarf_stock_create_box(&p.box, &options, &p.stock));
    return p;
}

/** Rays at random places of the part from all around; every third is along an axis. */
static void aim(const part *p, test_random *random, size_t count, double *origin, double *direction)
{
    for (size_t ray = 0; ray < count; ray++) {
        double way[3], length = 0;
        for (int axis = 0; axis < 3; axis++) way[axis] = test_random_in(random, -1, 1);
        if (ray % 3 == 0) {
            const int along = (int)test_random_below(random, 3);
            for (int axis = 0; axis < 3; axis++) way[axis] = axis == along ? (way[axis] < 0 ? -1 : 1) : 0;
        }
        for (int axis = 0; axis < 3; axis++) length += way[axis] * way[axis];
        for (int axis = 0; axis < 3; axis++) {
            way[axis] /= sqrt(length);
            const double at = test_random_in(random, p->box.lo[axis], p->box.hi[axis]);
            direction[3 * ray + (size_t)axis] = way[axis];
            origin[3 * ray + (size_t)axis] = at - 40 * way[axis];
        }
    }
}

static void check_same_bits(test_random *random)
{
    part p = make_part(0.23);
    cut_slots(&p, 25, random);
    swarf_scene *scene = NULL;
    double *origin = malloc(3 * RAYS * sizeof *origin), *direction = malloc(3 * RAYS * sizeof *direction);
    double *distance = malloc(RAYS * sizeof *distance), *again = malloc(RAYS * sizeof *again);
    float *normal = malloc(3 * RAYS * sizeof *normal), *normal_again = malloc(3 * RAYS * sizeof *normal_again);
    if (!CHECK(origin && direction && distance && again && normal && normal_again)) return;
    aim(&p, random, RAYS, origin, direction);
    const swarf_isa best = swarf_isa_current();
    for (int isa = SWARF_ISA_SCALAR; isa <= SWARF_ISA_AVX512; isa++) {
        if (swarf_isa_set((swarf_isa)isa) != SWARF_OK) continue;
        swarf_scene_destroy(scene);
        if (!CHECK_OK(swarf_scene_create(p.stock, &scene))) return;
        for (int threads = 1; threads <= 3; threads += 2) {
            CHECK_OK(swarf_threads_set(threads));
            const int first = isa == SWARF_ISA_SCALAR && threads == 1;
            CHECK_OK(swarf_scene_cast(scene, origin, direction, RAYS, first ? distance : again,
                                      first ? normal : normal_again));
            if (first) continue;
            CHECK(memcmp(distance, again, RAYS * sizeof *again) == 0);
            CHECK(memcmp(normal, normal_again, 3 * RAYS * sizeof *normal) == 0);
        }
        /* In packets of 1 .. 15 that begin anywhere. */
        for (size_t ray = 0; ray < RAYS;) {
            const size_t left = RAYS - ray, wanted = 1 + test_random_below(random, 15);
            const size_t count = wanted < left ? wanted : left;
            CHECK_OK(swarf_scene_cast(scene, origin + 3 * ray, direction + 3 * ray, count, again + ray,
                                      normal_again + 3 * ray));
            ray += count;
        }
        CHECK(memcmp(distance, again, RAYS * sizeof *again) == 0);
        CHECK(memcmp(normal, normal_again, 3 * RAYS * sizeof *normal) == 0);
    }
    CHECK_OK(swarf_isa_set(best));
    CHECK_OK(swarf_threads_set(0));
    size_t hits = 0;
    for (size_t ray = 0; ray < RAYS; ray++) hits += !isinf(distance[ray]);
    CHECK(hits > RAYS / 2);
    swarf_scene_destroy(scene);
    swarf_stock_destroy(p.stock);
    free(origin), free(direction), free(distance), free(again), free(normal), free(normal_again);
}

/** Cut on and on: the scene that follows meets what a new one does, to the bit. */
static void check_following(test_random *random)
{
    part p = make_part(0.31);
    swarf_scene *scene = NULL, *fresh = NULL;
    enum { FEW = 800 };
    static double origin[3 * FEW], direction[3 * FEW], distance[2][FEW];
    static float normal[2][3 * FEW];
    if (!CHECK_OK(swarf_scene_create(p.stock, &scene))) return;
    for (int round = 0; round < 12; round++) {
        cut_slots(&p, 1 + round % 3, random);
        if (round % 2) CHECK_OK(swarf_scene_update(scene)); /* the others by themselves */
        aim(&p, random, FEW, origin, direction);
        if (!CHECK_OK(swarf_scene_create(p.stock, &fresh))) return;
        CHECK_OK(swarf_scene_cast(scene, origin, direction, FEW, distance[0], normal[0]));
        CHECK_OK(swarf_scene_cast(fresh, origin, direction, FEW, distance[1], normal[1]));
        CHECK(memcmp(distance[0], distance[1], sizeof distance[0]) == 0);
        CHECK(memcmp(normal[0], normal[1], sizeof normal[0]) == 0);
        swarf_scene_destroy(fresh);
    }
    swarf_scene_destroy(scene);
    swarf_stock_destroy(p.stock);
}

/** Points on the rays of a view: the hit, or somewhere on the way to it or through the whole part. */
static void take_points(const part *p, const swarf_camera *camera, const swarf_picture_buffers *seen, int32_t width,
                        int32_t height, test_random *random, double *hits, double *before)
{
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++) {
            const size_t at = (size_t)y * (size_t)width + (size_t)x;
            double origin[3], direction[3];
            swarf_status status = swarf_camera_ray(camera, (double)width / height, 2 * (x + 0.5) / width - 1,
                                                   1 - 2 * (y + 0.5) / height, origin, direction);
            if (!CHECK_OK(status)) return;
            const int hit = seen->seen[at] != SWARF_SEEN_NOTHING;
            double most = 0;
            for (int i = 0; i < 3 && hit; i++) most += (seen->position[3 * at + (size_t)i] - origin[i]) * direction[i];
            const double t = hit ? most - fabs(test_random_in(random, 0, 20)) : test_random_in(random, 0, 120);
            for (int i = 0; i < 3; i++) {
                hits[3 * at + (size_t)i] = hit ? seen->position[3 * at + (size_t)i] : p->box.lo[i] - 50;
                before[3 * at + (size_t)i] = origin[i] + t * direction[i];
            }
        }
}

/** From 200 sides, near and far, parallel and in perspective: what is seen lies on the surface, and the way there is
 *  free, by the stock's own samples. A hole shows material on the way; a speckle is a point off the surface. */
static void check_views(test_random *random)
{
    enum { WIDTH = 96, HEIGHT = 72, PIXELS = WIDTH * HEIGHT };
    part p = make_part(0.29);
    cut_slots(&p, 30, random);
    swarf_scene *scene = NULL;
    static double position[3 * PIXELS], before[3 * PIXELS], hits[3 * PIXELS];
    static float value[PIXELS];
    static uint8_t seen[PIXELS];
    const swarf_picture_buffers out = {.size = sizeof out, .position = position, .seen = seen};
    swarf_picture_options options = swarf_picture_options_default();
    options.width = WIDTH;
    options.height = HEIGHT;
    options.samples = 1;
    options.occlusion = 0;
    if (!CHECK_OK(swarf_scene_create(p.stock, &scene))) return;
    double off = 0, in = 0;
    size_t met = 0;
    for (int trial = 0; trial < 200; trial++) {
        swarf_camera camera = {.perspective = trial & 1, .fov_deg = 40, .height_mm = test_random_in(random, 3, 40)};
        const double away = test_random_in(random, 20, 60);
        double length = 0;
        for (int i = 0; i < 3; i++) {
            camera.target[i] = 0.5 * (p.box.lo[i] + p.box.hi[i]);
            camera.eye[i] = trial % 10 == 4 ? (i == trial / 10 % 3) : test_random_in(random, -1, 1);
            length += camera.eye[i] * camera.eye[i];
            camera.up[i] = test_random_in(random, -1, 1);
        }
        for (int i = 0; i < 3; i++) camera.eye[i] = camera.target[i] + away / sqrt(length) * camera.eye[i];
        if (!CHECK_OK(swarf_scene_render(scene, &camera, &options, NULL, &out))) return;
        take_points(&p, &camera, &out, WIDTH, HEIGHT, random, hits, before);
        CHECK_OK(swarf_stock_sample(p.stock, hits, PIXELS, value));
        for (int i = 0; i < PIXELS; i++) {
            if (seen[i] == SWARF_SEEN_NOTHING) continue;
            off = fmax(off, fabs((double)value[i]) / p.voxel);
            met++;
        }
        CHECK_OK(swarf_stock_sample(p.stock, before, PIXELS, value));
        for (int i = 0; i < PIXELS; i++) in = fmax(in, -(double)value[i] / p.voxel);
    }
    CHECK(met > 200 * PIXELS / 5);
    CHECK_NEAR(off, 0, 1e-3);
    CHECK_NEAR(in, 0, 1e-3);
    swarf_scene_destroy(scene);
    swarf_stock_destroy(p.stock);
}

int main(void)
{
    test_random random = test_random_begin(31);
    check_same_bits(&random);
    check_following(&random);
    check_views(&random);
    return test_end();
}
