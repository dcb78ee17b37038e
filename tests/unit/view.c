/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What else a picture shows: sections, the cutter, fixtures, lines, light; against closed forms. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"

static const swarf_box block_box = {{0, 0, 0}, {40, 30, 20}};

static swarf_scene *make_scene(swarf_stock **stock)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.5;
    swarf_scene *scene = NULL;
    CHECK_OK(swarf_stock_create_box(&block_box, &options, stock));
    CHECK_OK(swarf_scene_create(*stock, &scene));
    return scene;
}

static swarf_picture_options small_options(void)
{
    swarf_picture_options options = swarf_picture_options_default();
    options.width = 80;
    options.height = 60;
    return options;
}

/** A slanting plane: its cut face lies in it and is seen wherever the plane runs through the block. */
static void check_sections(swarf_scene *scene, test_random *random)
{
    swarf_picture_options options = small_options();
    const swarf_cut_plane planes[2] = {{{20, 15, 10}, {0.6, -0.7, 0.4}}, {{30, 15, 10}, {1, 0, 0}}};
    const double unit = sqrt(0.36 + 0.49 + 0.16);
    options.section = planes;
    options.section_count = 2;
    int faces = 0, walls = 0;
    for (int trial = 0; trial < 600; trial++) {
        swarf_camera camera = {.perspective = trial & 1, .fov_deg = 30, .height_mm = 60, .up = {0, 0, 1}};
        for (int i = 0; i < 3; i++) {
            camera.target[i] = test_random_in(random, block_box.lo[i] + 1, block_box.hi[i] - 1);
            camera.eye[i] = camera.target[i] + 70 * planes[0].normal[i] + test_random_in(random, -20, 20);
        }
        swarf_pick pick;
        double height[2] = {0, 0}, origin[3], d[3], slope = 0, above = 0;
        if (!CHECK_OK(swarf_scene_pick(scene, &camera, &options, 0, 0, &pick))) return;
        if (pick.seen == SWARF_SEEN_NOTHING) continue;
        for (int i = 0; i < 3; i++)
            for (int plane = 0; plane < 2; plane++)
                height[plane] += (pick.point[i] - planes[plane].point[i]) * planes[plane].normal[i];
        CHECK(height[0] < 1e-6 && height[1] < 1e-6); /* nothing is left beyond the planes */
        walls += pick.seen == SWARF_SEEN_STOCK;
        CHECK_OK(swarf_camera_ray(&camera, 1, 0, 0, origin, d));
        for (int i = 0; i < 3; i++) {
            slope += d[i] * planes[0].normal[i];
            above += (origin[i] - planes[0].point[i]) * planes[0].normal[i];
        }
        /* Where the ray comes through the first plane within the block and before the second, that is what is seen. */
        int within = 1;
        double at[3];
        for (int i = 0; i < 3; i++) {
            at[i] = origin[i] - above / slope * d[i];
            within &= at[i] > block_box.lo[i] + 0.1 && at[i] < block_box.hi[i] - 0.1;
        }
        if (!within || at[0] > 30) continue;
        faces++;
        CHECK(pick.seen == SWARF_SEEN_SECTION);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(pick.point[i], at[i], 1e-9);
            CHECK_NEAR(pick.normal[i], planes[0].normal[i] / unit, 1e-6);
        }
    }
    CHECK(faces > 100 && walls > 20);
    options.section_count = 7;
    swarf_pick pick;
    swarf_camera camera;
    CHECK_OK(swarf_camera_fit(SWARF_VIEW_TOP, 0, &block_box, 1, &camera));
    CHECK_FAILS(swarf_scene_pick(scene, &camera, &options, 0, 0, &pick), SWARF_ERROR_ARGUMENT, "7 sections");
    const swarf_cut_plane none = {{0, 0, 0}, {0, 0, 0}};
    options.section = &none;
    options.section_count = 1;
    CHECK_FAILS(swarf_scene_pick(scene, &camera, &options, 0, 0, &pick), SWARF_ERROR_ARGUMENT, "section 0");
}

/** A bull-nose with shank and holder: every point seen lies on its torus, cylinders or planes. */
static void check_cutter(swarf_scene *scene, test_random *random)
{
    swarf_picture_options options = small_options();
    swarf_cutter *cutter = NULL;
    if (!CHECK_OK(swarf_cutter_parse("bull:d=8,r=1.5,l=12,sd=6,sl=10,hd=20,hl=15", &cutter))) return;
    options.cutter = cutter;
    options.cutter_tip[0] = 20;
    options.cutter_tip[1] = 15;
    options.cutter_tip[2] = 30;
    int kinds[SWARF_SEEN_COUNT] = {0};
    double worst = 0;
    for (int trial = 0; trial < 3000; trial++) {
        swarf_camera camera = {.perspective = trial & 1, .fov_deg = 10, .height_mm = 10, .up = {0.1, 0.2, 1}};
        for (int i = 0; i < 3; i++) {
            camera.target[i] =
                options.cutter_tip[i] + (i < 2 ? test_random_in(random, -9, 9) : test_random_in(random, 0, 37));
            camera.eye[i] =
                camera.target[i] + (i < 2 ? test_random_in(random, -100, 100) : test_random_in(random, -99, 60));
        }
        swarf_pick pick;
        if (!CHECK_OK(swarf_scene_pick(scene, &camera, &options, 0, 0, &pick))) return;
        kinds[pick.seen]++;
        if (pick.seen < SWARF_SEEN_FLUTES || pick.seen > SWARF_SEEN_HOLDER) continue;
        const double r = hypot(pick.point[0] - 20, pick.point[1] - 15), z = pick.point[2] - 30;
        double off;
        if (pick.seen == SWARF_SEEN_FLUTES)
            off = z > 1.5 ? fmin(fabs(r - 4), fabs(z - 12)) : r < 2.5 ? fabs(z) : fabs(hypot(r - 2.5, z - 1.5) - 1.5);
        else if (pick.seen == SWARF_SEEN_SHANK)
            off = fmin(fabs(r - 3), fabs(z - 12));
        else
            off = fmin(fabs(r - 10), fmin(fabs(z - 22), fabs(z - 37)));
        worst = fmax(worst, off);
        double length = 0, facing = 0;
        for (int i = 0; i < 3; i++) {
            length += pick.normal[i] * pick.normal[i];
            facing += pick.normal[i] * (camera.eye[i] - camera.target[i]);
        }
        CHECK_NEAR(length, 1, 1e-5);
        CHECK(facing >= -1e-6);
        if (pick.seen == SWARF_SEEN_FLUTES && z < 1.4 && z > 0.1 && r > 2.6)
            CHECK_NEAR(pick.normal[2], (z - 1.5) / 1.5, 1e-3);
    }
    CHECK(kinds[SWARF_SEEN_FLUTES] > 100 && kinds[SWARF_SEEN_SHANK] > 50 && kinds[SWARF_SEEN_HOLDER] > 100);
    CHECK_NEAR(worst, 0, 2e-5);
    swarf_cutter_release(cutter);
}

static void check_fixtures(swarf_scene *scene)
{
    static const float xyz[] = {-10, -10, 25, 60, -10, 25, 60, 60, 25, -10, 60, 25};
    static const uint32_t index[] = {0, 1, 2, 0, 2, 3}, wrong[] = {0, 1, 4};
    static const float away[] = {0, 0, 0, 1, 0, 0, 0, -2e20f, 0};
    const swarf_triangles plate = {xyz, 4, index, 2}, broken = {xyz, 4, wrong, 1}, far = {away, 3, index, 1};
    const swarf_picture_options options = small_options();
    swarf_camera camera;
    swarf_pick pick;
    CHECK_OK(swarf_camera_fit(SWARF_VIEW_TOP, 0, &block_box, 1, &camera));
    CHECK_FAILS(swarf_scene_set_fixtures(scene, &broken, 1), SWARF_ERROR_ARGUMENT, "vertex 4 of 4");
    CHECK_FAILS(swarf_scene_set_fixtures(scene, &far, 1), SWARF_ERROR_ARGUMENT, "vertex 2 is at -2e+20 mm in y");
    CHECK_OK(swarf_scene_set_fixtures(scene, &plate, 1));
    CHECK_OK(swarf_scene_pick(scene, &camera, &options, 0.1, 0.2, &pick));
    CHECK(pick.seen == SWARF_SEEN_FIXTURE);
    CHECK_NEAR(pick.point[2], 25, 1e-4);
    CHECK_NEAR(pick.normal[2], 1, 1e-6);
    swarf_camera wide = camera;
    wide.height_mm = 1e30; /* rays that start there would end the process */
    CHECK_OK(swarf_scene_pick(scene, &wide, &options, 0.1, 0.2, &pick));
    CHECK(pick.seen == SWARF_SEEN_NOTHING);
    CHECK_OK(swarf_scene_set_fixtures(scene, NULL, 0));
    CHECK_OK(swarf_scene_pick(scene, &camera, &options, 0.1, 0.2, &pick));
    CHECK(pick.seen == SWARF_SEEN_STOCK);
    CHECK_NEAR(pick.point[2], 20, 1e-5);
}

static int darkness(const uint8_t *rgba, const swarf_picture_options *options, int x, int y)
{
    const uint8_t *pixel = rgba + 4 * (y * options->width + x);
    return 765 - pixel[0] - pixel[1] - pixel[2];
}

/** Edges, a pocket's corner and what lies in shadow are darker with their option than without; a path shows. */
static void check_light(swarf_stock *stock, swarf_scene *scene)
{
    swarf_picture_options options = small_options();
    swarf_cutter *cutter = NULL;
    const swarf_path slot = {.start = {10, 15, 8}, .end = {30, 15, 8}, .has_motion = 1};
    swarf_camera camera;
    static uint8_t plain[4 * 80 * 60], other[4 * 80 * 60];
    if (!CHECK_OK(swarf_cutter_parse("flat:d=10,l=30", &cutter))) return;
    CHECK_OK(swarf_stock_cut(stock, cutter, &slot, 1, NULL));
    swarf_cutter_release(cutter);
    CHECK_OK(swarf_camera_fit(SWARF_VIEW_TOP, 0, &block_box, 80.0 / 60, &camera));
    options.edges = options.occlusion = 0;
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, plain));
    options.occlusion = 1;
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, other));
    CHECK(darkness(other, &options, 40, 30) > darkness(plain, &options, 40, 30) + 20);      /* the slot's floor */
    CHECK(abs(darkness(other, &options, 40, 10) - darkness(plain, &options, 40, 10)) < 12); /* the open top */
    options.occlusion = 0;
    options.shadow = 1;
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, other));
    CHECK(darkness(other, &options, 40, 24) > darkness(plain, &options, 40, 24) + 20); /* below the upper wall */
    CHECK(darkness(other, &options, 40, 10) == darkness(plain, &options, 40, 10));
    options.shadow = 0;
    options.edges = 1;
    for (options.samples = 1; options.samples <= 3; options.samples += 2) {
        CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, other));
        int most = 0;
        for (int y = 15; y < 30; y++) {
            const int more = darkness(other, &options, 40, y) - darkness(plain, &options, 40, y);
            most = more > most ? more : most;
        }
        CHECK(most > 150);
        CHECK(darkness(other, &options, 40, 10) == darkness(plain, &options, 40, 10));
    }
    swarf_program *program = NULL;
    const double start[3] = {5, 5, 30}, end[3] = {35, 5, 20.1};
    CHECK_OK(swarf_program_create(start, &program));
    CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, end, 100, 7));
    options.edges = 0;
    options.samples = 1;
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, plain));
    options.program = program;
    options.path = 1;
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, other));
    int changed = 0;
    for (int i = 0; i < 80 * 60; i++) changed += memcmp(plain + 4 * i, other + 4 * i, 4) != 0;
    const int expected = (int)(30 * 60 / camera.height_mm);
    CHECK(changed > expected && changed < 4 * expected); /* about two pixels wide */
    options.path = 0;
    options.program = NULL;
    options.colouring = SWARF_COLOURING_TOOL;
    CHECK_FAILS(swarf_scene_picture(scene, &camera, &options, NULL, other), SWARF_ERROR_ARGUMENT, "program");
    options.colouring = SWARF_COLOURING_DEVIATION;
    CHECK_FAILS(swarf_scene_picture(scene, &camera, &options, NULL, other), SWARF_ERROR_ARGUMENT, "values");
    static float values[80 * 60];
    for (int i = 0; i < 80 * 60; i++) values[i] = i % 80 < 40 ? -0.2f : 0.2f;
    options.values = values;
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, other));
    const uint8_t *left = other + 4 * (10 * 80 + 25), *right = other + 4 * (10 * 80 + 55);
    CHECK(left[2] > left[0] + 40 && right[0] > right[2] + 40); /* gouge blue, excess red */
    swarf_program_release(program);
}

int main(void)
{
    test_random random = test_random_begin(41);
    swarf_stock *stock = NULL;
    swarf_scene *scene = make_scene(&stock);
    if (scene) {
        check_sections(scene, &random);
        check_cutter(scene, &random);
        check_fixtures(scene);
        check_light(stock, scene);
    }
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
    return test_end();
}
