/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Lines of a picture: the outline of a rounding, whose face turns away from the eye without an edge; steps that crowd,
 * whose lines are lighter than that of one alone; and one ray per pixel against nine. A fine groove has none on any
 * row. What is drawn in strips looks as what is drawn at once. */
#include <stdlib.h>
#include <string.h>

#include "test.h"

enum { WIDTH = 640, HEIGHT = 480 };

static uint8_t plain[4 * WIDTH * HEIGHT], lines[4 * WIDTH * HEIGHT];

static void draw(swarf_scene *scene, const swarf_camera *camera, int samples)
{
    swarf_picture_options options = swarf_picture_options_default();
    options.width = WIDTH;
    options.height = HEIGHT;
    options.occlusion = 0;
    options.samples = samples;
    CHECK_OK(swarf_scene_picture(scene, camera, &options, NULL, lines));
    options.edges = 0;
    CHECK_OK(swarf_scene_picture(scene, camera, &options, NULL, plain));
}

/** How much darker lines make the darkest pixel from (x0, y) to (x1, y), out of 765. */
static int line_in(int x0, int x1, int y)
{
    int most = 0;
    for (int x = x0; x <= x1; x++) {
        const uint8_t *with = lines + 4 * (y * WIDTH + x), *without = plain + 4 * (y * WIDTH + x);
        const int more = without[0] + without[1] + without[2] - with[0] - with[1] - with[2];
        most = more > most ? more : most;
    }
    return most;
}

/** A pin of 12 mm stands on a plate; from 30 degrees above the plate is what its flanks hide. */
static void check_outline(void)
{
    const swarf_box plate = {{0, 0, 0}, {40, 40, 10}};
    const double base[3] = {20, 20, 0}, axis[3] = {0, 0, 30}, pixel = 60.0 / HEIGHT;
    const swarf_camera camera = {
        .eye = {20, 20 - 173.205, 115}, .target = {20, 20, 15}, .up = {0, 0, 1}, .height_mm = 60};
    swarf_stock_options options = swarf_stock_options_default();
    swarf_stock *stock = NULL, *pin = NULL;
    swarf_scene *scene = NULL;
    options.voxel_mm = 0.25;
    CHECK_OK(swarf_stock_create_box(&plate, &options, &stock));
    CHECK_OK(swarf_stock_create_cylinder(base, axis, 6, &options, &pin));
    CHECK_OK(swarf_stock_boolean(stock, pin, SWARF_UNION));
    CHECK_OK(swarf_scene_create(stock, &scene));
    const int middle = WIDTH / 2, flank = (int)(6 / pixel), row = (int)(HEIGHT / 2 - 5 * 0.866 / pixel);
    for (int samples = 1; samples <= 3; samples += 2) {
        draw(scene, &camera, samples);
        for (int y = row - 6; y <= row + 6; y++) {
            CHECK(line_in(middle - flank - 3, middle - flank + 3, y) > 150);
            CHECK(line_in(middle + flank - 3, middle + flank + 3, y) > 150);
            CHECK(line_in(middle - flank + 5, middle + flank - 5, y) == 0);
            CHECK(line_in(middle + flank + 5, middle + flank + 20, y) == 0);
        }
    }
    swarf_scene_destroy(scene);
    swarf_stock_destroy(pin);
    swarf_stock_destroy(stock);
}

static void cut(swarf_stock *stock, const char *text, double x, double y0, double y1, double z)
{
    const swarf_path path = {.start = {x, y0, z}, .end = {x, y1, z}, .has_motion = 1};
    swarf_cutter *cutter = NULL;
    CHECK_OK(swarf_cutter_parse(text, &cutter));
    CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
    swarf_cutter_release(cutter);
}

/** Grooves of four pixels, four apart, and far from them one ledge as high; from above. */
static void check_crowd(void)
{
    const swarf_box block = {{0, 0, 0}, {10, 8, 1}};
    const double pixel = 24.0 / HEIGHT;
    const swarf_camera camera = {.eye = {5, 4, 100}, .target = {5, 4, 0}, .up = {0, 1, 0}, .height_mm = 24};
    swarf_stock_options options = swarf_stock_options_default();
    swarf_stock *stock = NULL;
    swarf_scene *scene = NULL;
    options.voxel_mm = 0.05;
    CHECK_OK(swarf_stock_create_box(&block, &options, &stock));
    for (int i = 0; i < 8; i++) cut(stock, "flat:d=0.2,l=2", 1 + 0.4 * i, -1, 9, 0.8);
    cut(stock, "flat:d=4,l=2", 9, -3, 11, 0.8); /* its left flank is at 7 */
    CHECK_OK(swarf_scene_create(stock, &scene));
    for (int samples = 1; samples <= 3; samples += 2) {
        draw(scene, &camera, samples);
        const int ledge = (int)(WIDTH / 2 + 2 / pixel), comb = (int)(WIDTH / 2 - 2.6 / pixel);
        for (int y = HEIGHT / 2 - 20; y <= HEIGHT / 2 + 20; y++) {
            const int alone = line_in(ledge - 3, ledge + 3, y), among = line_in(comb - 10, comb + 10, y);
            CHECK(alone > 120);
            CHECK(among > 15 && 3 * among < 2 * alone);
        }
    }
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
}

/** A groove less than half a pixel wide has no line wherever it lies, also where one strip of work ends. */
static void check_rows(void)
{
    enum { W = 24, H = 160, RIM = 3, STEPS = 6 };
    const swarf_box block = {{0, -4, 0}, {12, 4, 1}};
    const double pixel = 0.5;
    const swarf_path path = {.start = {-1, 0, 0.9}, .end = {13, 0, 0.9}, .has_motion = 1};
    swarf_stock_options stock_options = swarf_stock_options_default();
    swarf_picture_options options = swarf_picture_options_default();
    swarf_stock *stock = NULL;
    swarf_scene *scene = NULL;
    swarf_cutter *cutter = NULL;
    stock_options.voxel_mm = 0.02;
    CHECK_OK(swarf_stock_create_box(&block, &stock_options, &stock));
    CHECK_OK(swarf_cutter_parse("chamfer:d=2,l=2,a=90", &cutter));
    CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
    swarf_cutter_release(cutter);
    CHECK_OK(swarf_scene_create(stock, &scene));
    options.width = W;
    options.height = H;
    options.occlusion = 0;
    for (options.samples = 2; options.samples <= 4; options.samples++)
        for (int place = 61 * STEPS; place < 67 * STEPS; place++) {
            const int row = place / STEPS;
            const double y = ((double)place / STEPS - 0.5 * H) * pixel;
            const swarf_camera camera = {
                .eye = {6, y, 100}, .target = {6, y, 0}, .up = {0, 1, 0}, .height_mm = H * pixel};
            options.edges = 1;
            CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, lines));
            options.edges = 0;
            CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, plain));
            int most = 0;
            for (int at = 0; at < 4 * W * H; at++) {
                const int x = at / 4 % W;
                if (x < RIM || x >= W - RIM || abs(at / 4 / W - row) > RIM) continue;
                most = abs(plain[at] - lines[at]) > most ? abs(plain[at] - lines[at]) : most;
            }
            CHECK_NEAR(most, 0, 1);
        }
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
}

/** Scallops finer than their pixels, over all of a block or so much of it, from its upper side, that their samples fit
 *  into memory; the upper half of its picture from above. */
static void draw_scallops(double lowest, uint8_t *rgba)
{
    enum { SIDE = 512 };
    const swarf_box block = {{0, 0, 0}, {16, 16, 1}};
    const swarf_camera camera = {.eye = {8, 8, 100}, .target = {8, 8, 0}, .up = {0, 1, 0}, .height_mm = 16};
    swarf_stock_options stock_options = swarf_stock_options_default();
    swarf_picture_options options = swarf_picture_options_default();
    swarf_stock *stock = NULL;
    swarf_scene *scene = NULL;
    swarf_cutter *cutter = NULL;
    static uint8_t whole[4 * SIDE * SIDE];
    stock_options.voxel_mm = 0.05;
    CHECK_OK(swarf_stock_create_box(&block, &stock_options, &stock));
    CHECK_OK(swarf_cutter_parse("ball:d=0.5,l=2", &cutter));
    for (int i = 0; i < 40; i++) {
        const double y = 15.8 - 0.4 * i;
        const swarf_path path = {.start = {1, y, 0.8}, .end = {15, y, 0.8}, .has_motion = 1};
        if (y > lowest) CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
    }
    swarf_cutter_release(cutter);
    CHECK_OK(swarf_scene_create(stock, &scene));
    options.width = options.height = SIDE;
    options.occlusion = 0;
    options.samples = 4;
    CHECK_OK(swarf_scene_picture(scene, &camera, &options, NULL, whole));
    memcpy(rgba, whole, sizeof whole / 2);
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
}

/** The samples of a picture that need more memory than is spent on them are made strip by strip: its pixels are those
 * of one whose samples fit, where both show the same. */
static void check_strips(void)
{
    static uint8_t strips[2 * 512 * 512], once[2 * 512 * 512];
    draw_scallops(0, strips);
    draw_scallops(4, once);
    CHECK(memcmp(strips, once, sizeof once) == 0);
}

int main(void)
{
    check_outline();
    check_crowd();
    check_rows();
    check_strips();
    return test_end();
}
