/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Pictures: what is shown, in which colours, and PNG files read back by libpng. */
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "test.h"

static swarf_stock *block(double voxel_mm)
{
    const swarf_box box = {{0, 0, 0}, {40, 30, 20}};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel_mm;
    swarf_stock *stock = NULL;
    CHECK_OK(swarf_stock_create_box(&box, &options, &stock));
    return stock;
}

/** Seen from the top on nothing: the opaque area is that of the face, its colour Gooch's formula, corners are clear. */
static void check_face(swarf_scene *scene, const swarf_box *box)
{
    swarf_picture_options options = swarf_picture_options_default();
    options.width = 203;
    options.height = 151;
    options.samples = 4;
    memset(options.background, 0, sizeof options.background);
    memset(options.background_top, 0, sizeof options.background_top);
    const double aspect = 203.0 / 151;
    const size_t bytes = 4 * 203 * 151;
    uint8_t *rgba = malloc(bytes), *again = malloc(bytes);
    swarf_camera camera;
    if (!CHECK(rgba && again) || !CHECK_OK(swarf_camera_fit(SWARF_VIEW_TOP, 0, box, aspect, &camera))) return;
    if (!CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, rgba))) return;
    double covered = 0;
    for (size_t i = 3; i < bytes; i += 4) covered += rgba[i] / 255.0;
    const double pixel = camera.height_mm / 151;
    CHECK_NEAR(covered * pixel * pixel / (40 * 30), 1, 2e-3);
    CHECK(rgba[3] == 0 && rgba[bytes - 1] == 0);

    /* The face looks at the camera: its light is the backward part of the unit vector to (-0.36, 0.76, 0.46), and
     * nothing hides the sky from it. */
    const double warmth = 0.5 + 0.5 * 0.46 / sqrt(0.36 * 0.36 + 0.76 * 0.76 + 0.46 * 0.46);
    const uint8_t *middle = rgba + 4 * (75 * 203 + 101);
    for (int channel = 0; channel < 3; channel++) {
        const double base = options.colour[channel];
        const double warm = 0.86 * base + (channel < 2 ? 0.10 : 0), cool = (0.22 + (channel < 2 ? 0 : 0.14)) * base;
        const double linear = warmth * warm + (1 - warmth) * cool;
        CHECK_NEAR(middle[channel], 255 * (1.055 * pow(linear, 1 / 2.4) - 0.055), 1.0);
    }
    CHECK(middle[3] == 255);

    for (int threads = 1; threads <= 8; threads += threads == 3 ? 5 : 1) {
        CHECK_OK(swarf_threads_set(threads));
        memset(again, 1, bytes);
        CHECK_OK(swarf_scene_set_fixtures(scene, NULL, 0)); /* forgets what it has seen */
        CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, again));
        CHECK(memcmp(rgba, again, bytes) == 0);
    }
    CHECK_OK(swarf_threads_set(0));
    free(rgba);
    free(again);
}

/** Pictures of one ray a square and nothing else are made in a way of their own: the same bytes, by any kernels, as by
 *  the way of all others, which whoever wants to know what is seen gets. */
static void check_plain(swarf_scene *scene, test_random *random)
{
    enum { WIDTH = 71, HEIGHT = 45, PIXELS = WIDTH * HEIGHT };
    static uint8_t plain[4 * PIXELS], other[4 * PIXELS], seen[PIXELS];
    const swarf_isa best = swarf_isa_current();
    const swarf_picture_buffers out = {.size = sizeof out, .rgba = other, .seen = seen};
    swarf_picture_options options = swarf_picture_options_default();
    options.width = WIDTH;
    options.height = HEIGHT;
    options.samples = 1;
    options.edges = options.occlusion = 0;
    for (int round = 0; round < 24; round++) {
        swarf_camera camera = {.target = {20, 15, 5}, .up = {0, 0, 1}, .height_mm = 60, .fov_deg = 35};
        for (int axis = 0; axis < 3; axis++) camera.eye[axis] = camera.target[axis] + test_random_in(random, -90, 90);
        camera.perspective = round & 1;
        options.coarse = 1 + round % 3;
        options.background[3] = round % 4 ? 1 : 0.3f;
        if (!CHECK_OK(swarf_scene_render(scene, &camera, &options, NULL, &out))) break;
        CHECK(memchr(seen, SWARF_SEEN_STOCK, sizeof seen) != NULL);
        for (int isa = SWARF_ISA_SCALAR; isa <= (int)best; isa++) {
            if (swarf_isa_set((swarf_isa)isa) != SWARF_OK) continue;
            CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, plain));
            CHECK(memcmp(plain, other, sizeof plain) == 0);
        }
    }
    CHECK_OK(swarf_isa_set(best));
}

/** Perspective and a gradient: opaque everywhere, darker from bottom to top along the rim, which shows no stock. */
static void check_background(swarf_scene *scene, const swarf_box *box)
{
    swarf_picture_options options = swarf_picture_options_default();
    options.width = 64;
    options.height = 48;
    options.samples = 1;
    uint8_t rgba[4 * 64 * 48];
    swarf_camera camera;
    CHECK_OK(swarf_camera_fit(SWARF_VIEW_ISOMETRIC, 1, box, 64.0 / 48, &camera));
    if (!CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, rgba))) return;
    for (int i = 0; i < 64 * 48; i++) CHECK(rgba[4 * i + 3] == 255);
    for (int row = 1; row < 48; row++) CHECK(rgba[4 * 64 * row] >= rgba[4 * 64 * (row - 1)]);
    CHECK(rgba[4 * 64 * 47] > rgba[0] + 30);
    /* A camera within the material sees no surface: background only, equal along each row. */
    camera.eye[0] = 20, camera.eye[1] = 15, camera.eye[2] = 10;
    camera.target[0] = 0, camera.target[1] = 0, camera.target[2] = 10;
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, rgba));
    for (int row = 0; row < 48; row++)
        for (int column = 1; column < 64; column++)
            CHECK(memcmp(rgba + 4 * (64 * row + column), rgba + 4 * 64 * row, 4) == 0);
}

static void check_refusals(swarf_scene *scene, const swarf_box *box)
{
    const swarf_picture_options good = swarf_picture_options_default();
    swarf_camera camera;
    CHECK_OK(swarf_camera_fit(SWARF_VIEW_FRONT, 0, box, 1, &camera));
    uint8_t rgba[4] = {1, 2, 3, 4};
    swarf_picture_options options = good;
    options.width = options.height = 0;
    CHECK_FAILS(swarf_scene_picture(scene, &camera, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "0 x 0");
    options = good;
    options.width = 16385;
    CHECK_FAILS(swarf_scene_picture(scene, &camera, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "16385");
    options = good;
    options.samples = 5;
    CHECK_FAILS(swarf_scene_picture(scene, &camera, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "5 samples");
    options = good;
    options.colour[1] = NAN;
    CHECK_FAILS(swarf_scene_picture(scene, &camera, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "colour");
    options = good;
    options.size = 3;
    CHECK_FAILS(swarf_scene_picture(scene, &camera, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "options");
    options = good;
    options.width = options.height = 1;
    swarf_camera bad = camera;
    bad.eye[2] = NAN;
    CHECK_FAILS(swarf_scene_picture(scene, &bad, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "z of eye");
    bad = camera;
    memcpy(bad.target, bad.eye, sizeof bad.eye);
    CHECK_FAILS(swarf_scene_picture(scene, &bad, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "same point");
    bad = camera;
    for (int i = 0; i < 3; i++) bad.up[i] = bad.target[i] - bad.eye[i];
    CHECK_FAILS(swarf_scene_picture(scene, &bad, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "up is along");
    bad = camera;
    bad.height_mm = 0;
    CHECK_FAILS(swarf_scene_picture(scene, &bad, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "height");
    bad.perspective = 1;
    bad.fov_deg = 180;
    CHECK_FAILS(swarf_scene_picture(scene, &bad, &options, NULL, rgba), SWARF_ERROR_ARGUMENT, "angle");
    CHECK(rgba[0] == 1 && rgba[3] == 4);
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, rgba));
}

static int stop_after(void *user, double fraction)
{
    int *left = user;
    CHECK(fraction >= 0 && fraction <= 1);
    return (*left)-- <= 0;
}

/** Cancelled at the k-th report: the pixels stay as they were, and the scene goes on working. plain: nothing but one
 *  ray per pixel. */
static void check_cancel(swarf_scene *scene, const swarf_box *box, int plain, test_random *random)
{
    enum { WIDTH = 160, HEIGHT = 120 };
    static uint8_t whole[4 * WIDTH * HEIGHT], rgba[4 * WIDTH * HEIGHT], untouched[4 * WIDTH * HEIGHT];
    swarf_picture_options options = swarf_picture_options_default();
    if (plain) options.samples = 1, options.edges = options.occlusion = 0;
    options.width = WIDTH;
    options.height = HEIGHT;
    swarf_camera camera, other;
    if (!CHECK_OK(swarf_camera_fit(SWARF_VIEW_ISOMETRIC, 1, box, (double)WIDTH / HEIGHT, &camera))) return;
    CHECK_OK(swarf_camera_fit(SWARF_VIEW_TOP, 1, box, (double)WIDTH / HEIGHT, &other));
    memset(untouched, 0xab, sizeof untouched);
    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_OK(swarf_threads_set(1)); /* every piece of the work is reported */
    int plenty = 1 << 30;
    const swarf_progress counting = {stop_after, &plenty};
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, &counting, whole));
    const uint32_t reports = (uint32_t)((1 << 30) - plenty);
    CHECK(reports > (plain ? 10 : 200));
    for (int trial = 0; trial < 16; trial++) {
        int left = trial ? (int)test_random_below(random, reports - 1) : 0;
        const swarf_progress progress = {stop_after, &left};
        CHECK_OK(swarf_scene_picture(scene, &other, &options, NULL, rgba)); /* nothing is known of the view any more */
        memset(rgba, 0xab, sizeof rgba);
        CHECK(swarf_scene_picture(scene, &camera, &options, &progress, rgba) == SWARF_ERROR_CANCELLED);
        CHECK(memcmp(rgba, untouched, sizeof rgba) == 0);
        CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, rgba));
        CHECK(memcmp(rgba, whole, sizeof rgba) == 0);
    }
    CHECK_OK(swarf_progress_interval_set(25));
    CHECK_OK(swarf_threads_set(0));
}

struct reports {
    double last, gap;
};

static int note_report(void *user, double fraction)
{
    struct reports *reports = user;
    CHECK(fraction >= reports->last);
    if (fraction - reports->last > reports->gap) reports->gap = fraction - reports->last;
    reports->last = fraction;
    return 0;
}

/** No pass over the picture is long without a report, with one sample per pixel or nine. */
static void check_progress(swarf_scene *scene, const swarf_box *box)
{
    static uint8_t rgba[4 * 320 * 256];
    swarf_picture_options options = swarf_picture_options_default();
    swarf_camera camera;
    options.width = 320;
    options.height = 256;
    options.shadow = 1;
    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_OK(swarf_threads_set(1));
    CHECK_OK(swarf_camera_fit(SWARF_VIEW_ISOMETRIC, 1, box, 1.25, &camera));
    for (options.samples = 1; options.samples <= 3; options.samples += 2) { /* the second: half is known */
        struct reports reports = {0};
        const swarf_progress progress = {note_report, &reports};
        CHECK_OK(swarf_scene_picture(scene, &camera, &options, &progress, rgba));
        CHECK(reports.last == 1);
        CHECK(reports.gap < 0.2);
    }
    CHECK_OK(swarf_progress_interval_set(25));
    CHECK_OK(swarf_threads_set(0));
}

/** What the middles meet is kept from picture to picture while only the shading changes: as if it were not. Whatever
 *  changes what is met changes the picture, and to the same as that of a scene that knows of nothing. */
static void check_recall(swarf_stock *stock, swarf_scene *scene, const swarf_box *box)
{
    enum { WIDTH = 160, HEIGHT = 120, BYTES = 4 * WIDTH * HEIGHT };
    static uint8_t last[BYTES], rgba[BYTES], fresh[BYTES];
    static const float corners[9] = {45, 0, 0, 45, 30, 0, 45, 30, 30};
    const uint32_t three[3] = {0, 1, 2};
    const swarf_triangles fixture = {corners, 3, three, 1};
    const swarf_cut_plane planes[2] = {{{20, 15, 10}, {1, 0, 0}}, {{20, 15, 10}, {0, -1, 0}}};
    swarf_cutter *cutter = NULL, *other = NULL;
    swarf_picture_options options = swarf_picture_options_default();
    swarf_camera camera;
    CHECK_OK(swarf_cutter_parse("flat:d=6,l=18", &cutter));
    CHECK_OK(swarf_cutter_parse("ball:d=8,l=18", &other));
    options.width = WIDTH;
    options.height = HEIGHT;
    options.samples = 1;
    options.occlusion = 0;
    CHECK_OK(swarf_camera_fit(SWARF_VIEW_ISOMETRIC, 1, box, 4.0 / 3, &camera));
    for (int step = 0; step < 17; step++) {
        const swarf_box hole = {{10, 10, 10}, {25, 20, 25}};
        swarf_stock *tool = NULL;
        switch (step) {
        case 1: options.samples = 3; break;
        case 2: options.occlusion = 1; break;
        case 3: options.shadow = 1; break;
        case 4: options.samples = 2; break; /* all of its light is known */
        case 5: options.colour[0] = 0.9f; break;
        case 6: camera.eye[0] += 3; break;
        case 7:
            options.section = planes;
            options.section_count = 1;
            break;
        case 8: options.section_count = 2; break;
        case 9:
            options.section = planes + 1;
            options.section_count = 1;
            break;
        case 10:
            options.cutter = cutter;
            options.cutter_tip[2] = 21;
            break;
        case 11: options.cutter_tip[0] = 5; break;
        case 12: options.cutter = other; break;
        case 13: options.coarse = 2; break;
        case 14: options.width -= 8; break;
        case 15: CHECK_OK(swarf_scene_set_fixtures(scene, &fixture, 1)); break;
        case 16: {
            swarf_stock_options voxels = swarf_stock_options_default();
            voxels.voxel_mm = swarf_stock_voxel(stock);
            CHECK_OK(swarf_stock_create_box(&hole, &voxels, &tool));
            CHECK_OK(swarf_stock_boolean(stock, tool, SWARF_DIFFERENCE));
            swarf_stock_destroy(tool);
            break;
        }
        default: break;
        }
        swarf_scene *once = NULL;
        CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, rgba));
        CHECK_OK(swarf_scene_create(stock, &once));
        if (step >= 15) CHECK_OK(swarf_scene_set_fixtures(once, &fixture, 1));
        CHECK_OK(swarf_scene_picture(once, &camera, &options, NULL, fresh));
        swarf_scene_destroy(once);
        const size_t bytes = 4 * (size_t)options.width * HEIGHT;
        if (!CHECK(memcmp(rgba, fresh, bytes) == 0)) printf("    step %d\n", step);
        if (step && !CHECK(memcmp(rgba, last, bytes) != 0)) printf("    step %d shows nothing\n", step);
        memcpy(last, rgba, bytes);
    }
    CHECK_OK(swarf_scene_set_fixtures(scene, NULL, 0));
    swarf_cutter_release(cutter);
    swarf_cutter_release(other);
}

/** Nothing left: a picture of the background alone. */
static void check_empty(swarf_stock *stock)
{
    swarf_stock *same = NULL;
    swarf_scene *scene = NULL;
    swarf_box box;
    swarf_camera camera;
    swarf_picture_options options = swarf_picture_options_default();
    options.width = options.height = 8;
    memset(options.background, 0, sizeof options.background);
    memset(options.background_top, 0, sizeof options.background_top);
    uint8_t rgba[4 * 8 * 8];
    memset(rgba, 1, sizeof rgba);
    if (CHECK_OK(swarf_stock_copy(stock, &same)) && CHECK_OK(swarf_stock_boolean(stock, same, SWARF_DIFFERENCE)) &&
        CHECK_OK(swarf_scene_create(stock, &scene)) && CHECK_OK(swarf_stock_box(stock, &box)) &&
        CHECK_OK(swarf_camera_fit(SWARF_VIEW_ISOMETRIC, 0, &box, 1, &camera)) &&
        CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, rgba))) {
        CHECK(box.lo[0] > box.hi[0]);
        for (size_t i = 0; i < sizeof rgba; i++) CHECK(rgba[i] == 0);
    }
    swarf_scene_destroy(scene);
    swarf_stock_destroy(same);
}

static void check_png(test_random *random)
{
    enum { WIDTH = 37, HEIGHT = 23 };
    uint8_t rgba[4 * WIDTH * HEIGHT], back[4 * WIDTH * HEIGHT];
    for (size_t i = 0; i < sizeof rgba; i++) rgba[i] = (uint8_t)test_random_below(random, 256);
    char path[64];
    snprintf(path, sizeof path, "/tmp/swarf-picture-%ld.png", (long)getpid());
    if (CHECK_OK(swarf_picture_write(path, rgba, WIDTH, HEIGHT))) {
        png_image image = {.version = PNG_IMAGE_VERSION};
        if (CHECK(png_image_begin_read_from_file(&image, path))) {
            CHECK(image.width == WIDTH && image.height == HEIGHT);
            CHECK(image.format == PNG_FORMAT_RGBA);
            image.format = PNG_FORMAT_RGBA;
            CHECK(png_image_finish_read(&image, NULL, back, 0, NULL));
            CHECK(memcmp(rgba, back, sizeof rgba) == 0);
        }
    }
    remove(path);
    CHECK_FAILS(swarf_picture_write("/nowhere/at/all.png", rgba, WIDTH, HEIGHT), SWARF_ERROR_IO, "/nowhere/at/all.png");
    CHECK_FAILS(swarf_picture_write("", rgba, WIDTH, HEIGHT), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_picture_write(path, rgba, 0, 0), SWARF_ERROR_ARGUMENT, "0 x 0");
    CHECK_FAILS(swarf_picture_write(path, NULL, WIDTH, HEIGHT), SWARF_ERROR_ARGUMENT, NULL);
    CHECK(access(path, F_OK) != 0);
}

int main(void)
{
    test_random random = test_random_begin(5);
    check_png(&random);
    swarf_stock *stock = block(0.25);
    swarf_scene *scene = NULL;
    swarf_box box;
    if (stock && CHECK_OK(swarf_scene_create(stock, &scene)) && CHECK_OK(swarf_stock_box(stock, &box))) {
        check_face(scene, &box);
        check_plain(scene, &random);
        check_background(scene, &box);
        check_refusals(scene, &box);
        check_cancel(scene, &box, 0, &random);
        check_cancel(scene, &box, 1, &random);
        check_progress(scene, &box);
        check_recall(stock, scene, &box);
    }
    swarf_scene_destroy(scene);
    if (stock) check_empty(stock);
    swarf_stock_destroy(stock);
    return test_end();
}
