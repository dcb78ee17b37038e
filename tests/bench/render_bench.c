/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* render_bench PROGRAM N THREADS [WIDTH ...]: cut a fixed job, then time pictures of it, one line of JSON for each.
 *
 * PROGRAM is bear or cameo (see shared data); N the voxels along the longest edge of the stock. Pictures of WIDTH x
 * 9/16 WIDTH pixels (default 1280 and 1920), one ray each, shaded, from the two cameras of the prototype this is
 * measured against; the minimum and median of nine.
 *
 * The first line tells of the scene: "scene" making it, "update" taking over 20 more moves, "moves" from that batch of
 * moves to the new picture, cutting included. The last one is about 1280 x 720 pixels and the way a viewer draws:
 * "orbit", frames per second and the slowest of them once the eye goes round within a budget of time; then from
 * stopping to "exact", a still with exact points and edges, one ray each; "sharp", antialiased; "still", with open sky:
 * one after the other, as the viewer shows them.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "jobs.h"
#include "test.h"

enum { RUNS = 9 };

/* An orbit: frames of a turn, after those from which the pictures learn what a ray costs; 20 of them a second leave
 * some time to the viewer. */
enum { ORBIT_FRAMES = 60, ORBIT_FIRST = 5, ORBIT_WIDTH = 1280, ORBIT_HEIGHT = 720 };
static const double orbit_budget_ms = 40;

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/** The prototype's cameras, to the digit: perspective of 30 degrees, onto the middle of the top. */
static swarf_camera camera_of(const bench_job *job, int oblique)
{
    swarf_camera camera = {.perspective = 1, .fov_deg = 30, .height_mm = 1};
    const double wide = (job->box.hi[0] - job->box.lo[0]) / 1.777, deep = job->box.hi[1] - job->box.lo[1];
    const double slope = tan(15 * 3.14159265358979323846 / 180);
    const double distance =
        0.5 * (oblique ? fmax(wide, deep) : fmin(wide, deep)) / slope * (oblique ? 1.03 * 0.95 : 0.97);
    const double way[2][3] = {{0.001, -0.001, 1}, {0.35, -0.75, 0.6}}, *v = way[oblique];
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) {
        camera.target[i] = i == 2 ? job->box.hi[2] : 0.5 * (job->box.lo[i] + job->box.hi[i]);
        camera.eye[i] = camera.target[i] + distance * v[i] / length;
    }
    camera.up[oblique ? 2 : 1] = 1;
    return camera;
}

static void time_pictures(swarf_scene *scene, const bench_job *job, int resolution, int width)
{
    swarf_picture_options options = swarf_picture_options_default();
    options.width = width;
    options.height = width * 9 / 16;
    options.samples = 1;
    options.edges = options.occlusion = 0; /* the prototype has neither */
    const double pixels = (double)options.width * options.height;
    uint8_t *rgba = malloc(4 * (size_t)pixels);
    if (!rgba) exit(2);
    for (int oblique = 0; oblique < 2; oblique++) {
        const swarf_camera camera = camera_of(job, oblique);
        double seconds[RUNS], cpu[RUNS];
        for (int run = 0; run < RUNS; run++) {
            const double started = bench_now(), cpu_started = bench_cpu();
            bench_must(swarf_scene_picture(scene, &camera, &options, NULL, rgba));
            seconds[run] = bench_now() - started;
            cpu[run] = bench_cpu() - cpu_started;
        }
        qsort(seconds, RUNS, sizeof *seconds, ascending);
        qsort(cpu, RUNS, sizeof *cpu, ascending);
        printf("{\"program\": \"%s\", \"resolution\": %d, \"threads\": %d, \"isa\": \"%s\", \"camera\": \"%s\", "
               "\"width\": %d, \"height\": %d, \"best_ms\": %.3f, \"median_ms\": %.3f, \"mrays_s\": %.3f, "
               "\"mrays_cpu_s\": %.3f}\n",
               job->name, resolution, swarf_threads(), swarf_isa_name(swarf_isa_current()),
               oblique ? "oblique" : "above", options.width, options.height, 1e3 * seconds[0], 1e3 * seconds[RUNS / 2],
               1e-6 * pixels / seconds[0], 1e-6 * pixels / cpu[0]);
        fflush(stdout);
        const char *keep = getenv("SWARF_BENCH_PICTURES");
        if (!keep) continue;
        char path[2048];
        snprintf(path, sizeof path, "%s/%s-%d-%s.png", keep, job->name, resolution, oblique ? "oblique" : "above");
        bench_must(swarf_picture_write(path, rgba, options.width, options.height));
    }
    free(rgba);
}

static swarf_picture_options viewer_options(void)
{
    swarf_picture_options options = swarf_picture_options_default();
    options.width = ORBIT_WIDTH;
    options.height = ORBIT_HEIGHT;
    return options;
}

static double time_picture(swarf_scene *scene, const swarf_camera *camera, const swarf_picture_options *options,
                           uint8_t *rgba)
{
    const double started = bench_now();
    bench_must(swarf_scene_picture(scene, camera, options, NULL, rgba));
    return bench_now() - started;
}

static void time_viewer(swarf_scene *scene, const bench_job *job, int resolution)
{
    swarf_picture_options options = viewer_options();
    uint8_t *rgba = malloc((size_t)4 * ORBIT_WIDTH * ORBIT_HEIGHT);
    if (!rgba) exit(2);
    options.samples = 1;
    options.exact = options.edges = options.occlusion = 0;
    options.budget_ms = orbit_budget_ms;
    swarf_camera camera = camera_of(job, 1);
    const double arm[2] = {camera.eye[0] - camera.target[0], camera.eye[1] - camera.target[1]};
    double sum = 0, slowest = 0;
    for (int frame = -ORBIT_FIRST; frame < ORBIT_FRAMES; frame++) {
        const double angle = 2 * 3.14159265358979323846 * frame / ORBIT_FRAMES;
        camera.eye[0] = camera.target[0] + cos(angle) * arm[0] - sin(angle) * arm[1];
        camera.eye[1] = camera.target[1] + sin(angle) * arm[0] + cos(angle) * arm[1];
        const double took = time_picture(scene, &camera, &options, rgba);
        if (frame < 0) continue;
        sum += took;
        slowest = fmax(slowest, took);
    }
    options = viewer_options();
    options.samples = 1;
    options.occlusion = 0;
    const double exact = time_picture(scene, &camera, &options, rgba);
    options.samples = viewer_options().samples;
    const double sharp = exact + time_picture(scene, &camera, &options, rgba);
    options.occlusion = 1;
    const double still = sharp + time_picture(scene, &camera, &options, rgba);
    printf("{\"program\": \"%s\", \"resolution\": %d, \"threads\": %d, \"orbit_fps\": %.1f, \"slowest_ms\": %.1f, "
           "\"exact_ms\": %.1f, \"sharp_ms\": %.1f, \"still_ms\": %.1f}\n",
           job->name, resolution, swarf_threads(), ORBIT_FRAMES / sum, 1e3 * slowest, 1e3 * exact, 1e3 * sharp,
           1e3 * still);
    const char *keep = getenv("SWARF_BENCH_PICTURES");
    if (keep) {
        char path[2048];
        snprintf(path, sizeof path, "%s/%s-%d-still.png", keep, job->name, resolution);
        bench_must(swarf_picture_write(path, rgba, ORBIT_WIDTH, ORBIT_HEIGHT));
    }
    free(rgba);
}

/* The exact surface of all moves of the job, whose stock is not cut yet. */
static swarf_surface *make_surface(const bench_job *job, swarf_stock *stock, swarf_cutter *cutter, size_t *moves)
{
    swarf_program *program = bench_job_program(job);
    const size_t sections = swarf_program_section_count(program);
    swarf_tool *tools = calloc(sections + 1, sizeof *tools);
    swarf_surface *surface = NULL;
    if (!tools) exit(2);
    for (size_t i = 0; i < sections; i++)
        tools[i] = (swarf_tool){.number = swarf_program_sections(program)[i].tool, .cutter = cutter};
    bench_must(swarf_surface_create(stock, program, tools, sections, NULL, &surface));
    *moves = swarf_program_move_count(program);
    free(tools);
    swarf_program_release(program);
    return surface;
}

int main(int count, char **argument)
{
    const bench_job *job = count > 3 ? bench_job_find(argument[1]) : NULL;
    if (!job || atoi(argument[2]) < 1) {
        fprintf(stderr, "usage: render_bench bear|cameo RESOLUTION THREADS [WIDTH ...]\n");
        return 2;
    }
    const int resolution = atoi(argument[2]);
    enum { LAST = 20 };
    swarf_cutter *cutter = NULL;
    swarf_stock *stock = NULL;
    swarf_scene *scene = NULL;
    swarf_surface *surface = NULL;
    size_t paths_count, moves;
    bench_must(swarf_cutter_parse(job->cutter, &cutter));
    swarf_path *paths = bench_job_paths(job, &paths_count);
    const size_t held = paths_count > LAST ? LAST : 0;
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = bench_job_voxel(job, resolution);
    bench_must(swarf_stock_create_box(&job->box, &options, &stock));
    surface = make_surface(job, stock, cutter, &moves);
    bench_must(swarf_stock_cut(stock, cutter, paths, paths_count - held, NULL));
    bench_must(swarf_threads_set(atoi(argument[3])));
    const double t0 = bench_now();
    bench_must(swarf_scene_create(stock, &scene));
    const double t1 = bench_now();
    bench_must(swarf_stock_cut(stock, cutter, paths + paths_count - held, held, NULL));
    const double t2 = bench_now();
    bench_must(swarf_scene_update(scene));
    const double t3 = bench_now();
    swarf_picture_options picture = viewer_options();
    picture.samples = 1;
    picture.edges = picture.occlusion = 0;
    const swarf_camera camera = camera_of(job, 1);
    uint8_t *rgba = malloc((size_t)4 * ORBIT_WIDTH * ORBIT_HEIGHT);
    if (!rgba) exit(2);
    const double picture_s = time_picture(scene, &camera, &picture, rgba);
    free(rgba);
    printf("{\"program\": \"%s\", \"resolution\": %d, \"threads\": %d, \"scene_ms\": %.3f, \"cut_ms\": %.3f, "
           "\"update_ms\": %.3f, \"moves_ms\": %.3f}\n",
           job->name, resolution, swarf_threads(), 1e3 * (t1 - t0), 1e3 * (t2 - t1), 1e3 * (t3 - t2),
           1e3 * (t3 - t1 + picture_s));
    for (int i = 4; i < count; i++) time_pictures(scene, job, resolution, atoi(argument[i]));
    if (count == 4) {
        time_pictures(scene, job, resolution, 1280);
        time_pictures(scene, job, resolution, 1920);
    }
    bench_must(swarf_scene_set_surface(scene, surface, moves, 0));
    time_viewer(scene, job, resolution);
    swarf_surface_release(surface);
    swarf_scene_destroy(scene);
    swarf_stock_destroy(stock);
    swarf_cutter_release(cutter);
    free(paths);
    return 0;
}
