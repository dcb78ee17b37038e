/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stocks from one set-up to the next, against closed forms: a slotted block, turned over and slotted again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "placements.h"
#include "stocks.h"

static const double pi = 3.14159265358979323846, voxel = 0.2;
static const swarf_box block = {{0.03, 0.01, -6.02}, {20.04, 12.05, 0.01}};

enum { SLOT_Y = 6, SLOT_R = 2, SLOT_Z = -2 };

/* A cut along a line that goes through the part, by a flat cutter of radius 2. */
typedef struct job {
    swarf_cutter *cutter;
    swarf_program *program;
    swarf_tool tool;
} job;

static job make_job(const double from[3], const double to[3])
{
    job j = {0};
    const swarf_section section = {.tool = 1};
    CHECK_OK(swarf_cutter_parse("flat:d=4,l=30", &j.cutter));
    CHECK_OK(swarf_program_create(from, &j.program));
    CHECK_OK(swarf_program_add_operation(j.program, "slot"));
    CHECK_OK(swarf_program_set_section(j.program, &section));
    CHECK_OK(swarf_program_add_line(j.program, SWARF_MOVE_FEED, to, 100, 7));
    j.tool = (swarf_tool){1, 0, j.cutter};
    return j;
}

static void end_job(job *j)
{
    swarf_program_release(j->program);
    swarf_cutter_release(j->cutter);
}

static job first_job(void)
{
    return make_job((double[]){-5, SLOT_Y, SLOT_Z}, (double[]){25, SLOT_Y, SLOT_Z});
}

static void play(swarf_stock *stock, const job *j)
{
    swarf_simulation *played = NULL;
    CHECK_OK(swarf_stock_simulate(stock, j->program, 0, swarf_program_move_count(j->program), &j->tool, 1, NULL, NULL,
                                  &played));
    swarf_simulation_destroy(played);
}

static swarf_stock *make_block(const double edge)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = edge;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&block, &options, &stock))) exit(test_end());
    return stock;
}

/* Signed distance to the slotted block: an outline in y and z, extruded along x. */
static double first_distance(const double p[3])
{
    const double corner[8][2] = {{block.lo[1], block.lo[2]},     {block.hi[1], block.lo[2]}, {block.hi[1], block.hi[2]},
                                 {SLOT_Y + SLOT_R, block.hi[2]}, {SLOT_Y + SLOT_R, SLOT_Z},  {SLOT_Y - SLOT_R, SLOT_Z},
                                 {SLOT_Y - SLOT_R, block.hi[2]}, {block.lo[1], block.hi[2]}};
    double least = INFINITY;
    for (int i = 0; i < 8; i++) {
        const double *a = corner[i], *b = corner[(i + 1) % 8];
        const double u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {p[1] - a[0], p[2] - a[1]};
        const double t = fmin(1, fmax(0, (u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1])));
        least = fmin(least, hypot(v[0] - t * u[0], v[1] - t * u[1]));
    }
    const int in_block = p[1] > block.lo[1] && p[1] < block.hi[1] && p[2] > block.lo[2] && p[2] < block.hi[2];
    const int in_slot = fabs(p[1] - SLOT_Y) < SLOT_R && p[2] > SLOT_Z;
    const double outline = in_block && !in_slot ? -least : least;
    const double ends = fmax(block.lo[0] - p[0], p[0] - block.hi[0]);
    return outline <= 0 && ends <= 0 ? fmax(outline, ends) : hypot(fmax(outline, 0), fmax(ends, 0));
}

static swarf_stock *place(swarf_stock *stock, const swarf_placement *placement, const swarf_surface *surface,
                          double edge, int expected)
{
    swarf_place_options options = swarf_place_options_default();
    options.surface = surface;
    options.moves = SIZE_MAX;
    options.voxel_mm = edge;
    swarf_stock *placed = NULL;
    int lossless = -1;
    if (!CHECK_OK(swarf_stock_place(stock, placement, &options, NULL, &placed, &lossless))) exit(test_end());
    CHECK(lossless == expected);
    return placed;
}

/* All 24 ways to lie on an axis, by any shift: there, the old values; and back, the old bits. */
static void check_quarters(void)
{
    test_random random = test_random_begin(20261122);
    for (int cut = 0; cut < 2; cut++) {
        swarf_stock *stock = make_block(2 * voxel);
        job j = first_job();
        if (cut) play(stock, &j);
        const uint64_t hash = stock_hash(stock);
        const double volume = stock_volume(stock);
        int ways = 0;
        for (int turn = 0; turn < 64; turn++) {
            const double angle[3] = {(turn & 3) * pi / 2, (turn >> 2 & 3) * pi / 2, (turn >> 4) * pi / 2};
            if (turn >> 2 & 2) continue; /* about y by 0 or a quarter: 32, of them 24 differ */
            double shift[3];
            for (int k = 0; k < 3; k++) shift[k] = test_random_in(&random, -50, 50);
            const swarf_placement there = placement_make(angle, shift), back = swarf_placement_inverse(&there);
            swarf_stock *placed = place(stock, &there, NULL, 0, 1), *again = place(placed, &back, NULL, 0, 1);
            CHECK(stock_hash(again) == hash);
            CHECK_NEAR(stock_volume(placed), volume, 1e-7 * volume); /* integrated in another order */
            for (int i = 0; i < 50; i++) {
                double p[3], q[3];
                float was, is;
                for (int k = 0; k < 3; k++) p[k] = test_random_in(&random, block.lo[k] - 1, block.hi[k] + 1);
                swarf_placement_point(&there, p, q);
                CHECK_OK(swarf_stock_sample(stock, p, 1, &was));
                CHECK_OK(swarf_stock_sample(placed, q, 1, &is));
                CHECK_NEAR(is, was, 1e-5);
            }
            swarf_stock_destroy(placed);
            swarf_stock_destroy(again);
            ways++;
        }
        CHECK(ways == 32);
        swarf_stock_destroy(stock);
        end_job(&j);
    }
}

/* The faces of a block that was never read are still made when it was turned and cut. */
static void check_untouched(void)
{
    swarf_stock *turned = make_block(voxel), *plain = make_block(voxel);
    job j = first_job();
    const swarf_placement over = placement_make((double[]){pi, 0, 0}, (double[]){0, 0, 0});
    swarf_stock *there = place(turned, &over, NULL, 0, 1);
    job k = make_job((double[]){-5, -SLOT_Y, -SLOT_Z - 4}, (double[]){25, -SLOT_Y, -SLOT_Z - 4});
    play(there, &k); /* from above: y -8 .. -4, z above -2, all of it */
    CHECK_NEAR(stock_volume(there), stock_volume(plain) - 20.01 * 4 * 6.03, 0.5);
    play(turned, &j);
    swarf_stock *cut = place(turned, &over, NULL, 0, 1);
    CHECK_NEAR(stock_volume(cut), stock_volume(turned), 1e-7 * stock_volume(turned));
    swarf_surface *surface = NULL;
    CHECK_OK(swarf_surface_create(cut, k.program, &k.tool, 1, NULL, &surface)); /* a block that was cut is none */
    swarf_surface_near *near = NULL;
    CHECK_OK(swarf_surface_near_create(surface, &near));
    const double floor[3] = {10, -SLOT_Y, -SLOT_Z};
    const swarf_box around = {{9.5, -SLOT_Y - 0.5, -SLOT_Z - 0.5}, {10.5, -SLOT_Y + 0.5, -SLOT_Z + 0.5}};
    CHECK_OK(swarf_surface_gather(near, 0, &around));
    swarf_surface_point seen = {.value = NAN};
    swarf_surface_evaluate(near, floor, &seen); /* of its slot, which the block does not have */
    CHECK_NEAR(seen.value, 0, 0.01 * voxel);
    CHECK(seen.move == -1 && fabs(seen.normal[2] + 1) < 0.01);
    swarf_surface_near_destroy(near);
    swarf_surface_release(surface);
    swarf_stock_destroy(turned);
    swarf_stock_destroy(plain);
    swarf_stock_destroy(there);
    swarf_stock_destroy(cut);
    end_job(&j);
    end_job(&k);
}

typedef double (*distance_fn)(const double p[3]);

/* Whether three faces of the slotted block meet within three voxels. */
static int is_corner(const double p[3])
{
    const double y[4] = {block.lo[1], SLOT_Y - SLOT_R, SLOT_Y + SLOT_R, block.hi[1]};
    const double z[3] = {block.lo[2], SLOT_Z, block.hi[2]};
    const double x = fmin(fabs(p[0] - block.lo[0]), fabs(p[0] - block.hi[0]));
    double least = INFINITY;
    for (int i = 0; i < 12; i++) least = fmin(least, hypot(hypot(p[1] - y[i / 3], p[2] - z[i % 3]), x));
    return least < 3 * voxel;
}

static double cylinder_distance(const double p[3])
{
    const double side = hypot(p[0] - 1, p[1] - 2) - 4.01, ends = fabs(p[2] - 3) - 5.02;
    return side > 0 && ends > 0 ? hypot(side, ends) : fmax(side, ends);
}

/* Greatest differences from the true distance, in voxels. */
typedef struct off {
    double band;    /* of voxels within one of the surface */
    double surface; /* of those within a tenth of it */
    double corner;  /* of those of them beside a corner; the others are not */
    double mean;    /* of those within one */
    size_t count;
} off;

static void note(off *found, const double p[3], double value, double truth, double edge)
{
    const double away = fabs(value - truth) / edge;
    if (fabs(truth) > edge) return;
    found->band = fmax(found->band, away);
    found->mean += away;
    found->count++;
    if (fabs(truth) > 0.1 * edge) return;
    double *most = is_corner(p) ? &found->corner : &found->surface;
    *most = fmax(*most, away);
}

/* Voxels of a cube, at their places before it was turned, that a distance is known for. */
typedef struct near_voxels {
    const swarf_box *cube;
    double edge;
    const swarf_placement *back;
    distance_fn distance;
    double *points, *truth; /* where they are now, and what their values should be */
    size_t count;
} near_voxels;

enum { CUBE = 32 };

/* All within a voxel of the surface, and others about them: part by part, as no distance changes faster than places. */
static void find_near(near_voxels *v, const int at[3], int size)
{
    double middle[3], before[3];
    for (int k = 0; k < 3; k++) middle[k] = v->cube->lo[k] + (at[k] + 0.5 * size) * v->edge;
    swarf_placement_point(v->back, middle, before);
    const double truth = v->distance(before);
    if (fabs(truth) > (1 + 0.5 * sqrt(3) * (size - 1)) * v->edge) return;
    if (size == 1) {
        memcpy(v->points + 3 * v->count, middle, sizeof middle);
        v->truth[v->count++] = truth;
        return;
    }
    for (int i = 0; i < 8; i++) {
        const int half = size / 2,
                  part[3] = {at[0] + (i >> 2) * half, at[1] + (i >> 1 & 1) * half, at[2] + (i & 1) * half};
        find_near(v, part, half);
    }
}

/* Every voxel near the surface against the closed form. */
static off compare_field(swarf_stock *placed, const swarf_placement *back, distance_fn distance)
{
    off found = {0};
    const double edge = swarf_stock_voxel(placed);
    size_t cubes = 0;
    CHECK_OK(swarf_stock_changed(placed, 0, NULL, 0, &cubes));
    swarf_box *boxes = malloc((cubes + 1) * sizeof *boxes);
    double *points = malloc(3 * sizeof(double) * CUBE * CUBE * CUBE),
           *truth = malloc(sizeof(double) * CUBE * CUBE * CUBE);
    float *values = malloc(sizeof(float) * CUBE * CUBE * CUBE);
    CHECK_OK(swarf_stock_changed(placed, 0, boxes, cubes, &cubes));
    for (size_t c = 0; c < cubes; c++) {
        near_voxels near = {&boxes[c], edge, back, distance, points, truth, 0};
        find_near(&near, (int[3]){0}, CUBE);
        if (near.count == 0) continue;
        CHECK_OK(swarf_stock_sample(placed, points, near.count, values));
        for (size_t i = 0; i < near.count; i++) {
            double before[3];
            swarf_placement_point(back, points + 3 * i, before);
            note(&found, before, (double)values[i], truth[i], edge);
        }
    }
    free(boxes);
    free(points);
    free(truth);
    free(values);
    CHECK(found.count > 1000);
    found.mean /= (double)found.count;
    return found;
}

static void print_off(const char *what, const off *found)
{
    printf("%s: on the surface off by %.4f voxels, %.3f at corners; within a voxel by %.3f, %.5f in the mean\n", what,
           found->surface, found->corner, found->band, found->mean);
}

/* Voxels alone tell faces and edges well (`most`: in voxels), but not the corners where a ridge meets a groove. Beside
 * edges, outside of the material or behind grooves, the distance is that of the old voxels, from the faces or from the
 * edges. */
static void check_plain(swarf_stock *placed, const swarf_placement *back, distance_fn distance, double most)
{
    const off found = compare_field(placed, back, distance);
    print_off("from voxels", &found);
    CHECK(found.surface < most);
    CHECK(found.corner < 0.3);
    CHECK(found.band < 0.35);
    CHECK(found.mean < 0.003);
}

/* What any other turn costs: with the exact surface, from the voxels alone, and there and back. */
static void check_cost(void)
{
    swarf_stock *stock = make_block(voxel);
    job j = first_job();
    swarf_surface *surface = NULL;
    CHECK_OK(swarf_surface_create(stock, j.program, &j.tool, 1, NULL, &surface));
    play(stock, &j);
    const double angle[4][3] = {{pi, 0, 0}, {0, 0, 0.3}, {0.5, -0.4, 0.7}, {0.5, -0.4, 0.7}};
    for (int i = 0; i < 4; i++) {
        const double near[3] = {3.3, -70.7, 12.1}, far[3] = {9e5, -8e5, 7e5}; /* where floats are 0.06 mm apart */
        const swarf_placement there = placement_make(angle[i], i < 3 ? near : far),
                              back = swarf_placement_inverse(&there), none = swarf_placement_identity();
        swarf_stock *exact = place(stock, &there, surface, i ? 0 : 0.13, 0),
                    *plain = place(stock, &there, NULL, i ? 0 : 0.13, 0), *again = place(plain, &back, NULL, 0, i == 0);
        const off with = compare_field(exact, &back, first_distance);
        print_off("with the surface", &with);
        CHECK(with.band < 0.02);
        check_plain(plain, &back, first_distance, 0.03);
        check_plain(again, &none, first_distance, 0.1);
        const double truth = 20.01 * (12.04 * 6.03 - 4 * 2.01);
        CHECK_NEAR(stock_volume(exact), truth, 1e-3 * truth);
        CHECK_NEAR(stock_volume(plain), truth, 1e-3 * truth);
        swarf_stock_destroy(exact);
        swarf_stock_destroy(plain);
        swarf_stock_destroy(again);
    }
    swarf_surface_release(surface);
    swarf_stock_destroy(stock);
    end_job(&j);
}

/* A round stock: 20 voxels from its axis to its side, which meets its ends in edges. Larger voxels go by the mesh. */
static void check_round(void)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    swarf_stock *stock = NULL;
    CHECK_OK(swarf_stock_create_cylinder((double[]){1, 2, -2.02}, (double[]){0, 0, 10.04}, 4.01, &options, &stock));
    const swarf_placement there = placement_make((double[]){0.5, -0.4, 0.7}, (double[]){1, 2, 3}),
                          back = swarf_placement_inverse(&there);
    swarf_stock *plain = place(stock, &there, NULL, 0, 0), *coarse = place(stock, &there, NULL, 1.5 * voxel, 0);
    check_plain(plain, &back, cylinder_distance, 0.03);
    const off mesh = compare_field(coarse, &back, cylinder_distance);
    print_off("by the mesh", &mesh);
    CHECK(mesh.band < 0.5);
    CHECK_OK(swarf_threads_set(1));
    swarf_stock *again = place(stock, &there, NULL, 0, 0);
    CHECK_OK(swarf_threads_set(3));
    CHECK(stock_hash(again) == stock_hash(plain));
    CHECK_OK(swarf_threads_set(0));
    swarf_stock_destroy(again);
    swarf_stock_destroy(stock);
    swarf_stock_destroy(plain);
    swarf_stock_destroy(coarse);
}

/* A block with a channel in it, all of it as large as the voxel tells and nowhere at a limit of what is told apart:
 * turned without a program. */
static swarf_stock *make_turned(double edge)
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = edge;
    const swarf_box outer = {{0.2317 * edge, 0.1173 * edge, 0.0391 * edge},
                             {60.3519 * edge, 40.4253 * edge, 30.2187 * edge}},
                    inner = {{-9.7683 * edge, 12.1173 * edge, 19.0391 * edge}, {80 * edge, 25.1439 * edge, 50 * edge}};
    const swarf_placement there =
        placement_make((double[]){0.5, -0.4, 0.7}, (double[]){2 * edge, -3.3 * edge, 5.1 * edge});
    swarf_stock *stock = NULL, *cut = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&outer, &options, &stock)) ||
        !CHECK_OK(swarf_stock_create_box(&inner, &options, &cut)))
        exit(test_end());
    CHECK_OK(swarf_stock_boolean(stock, cut, SWARF_DIFFERENCE));
    swarf_stock *turned = place(stock, &there, NULL, 0, 0);
    swarf_stock_destroy(stock);
    swarf_stock_destroy(cut);
    return turned;
}

/* Nothing hangs on how large a voxel is: to float, three of them are not always three times one. */
static void check_scale(void)
{
    enum { POINTS = 40000 };
    static double at[POINTS][3], scaled[POINTS][3];
    static float unit[POINTS], value[POINTS];
    test_random random = test_random_begin(20261123);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++) at[i][k] = test_random_in(&random, -40, 70);
    swarf_stock *stock = make_turned(1);
    CHECK_OK(swarf_stock_sample(stock, at[0], POINTS, unit));
    swarf_stock_destroy(stock);
    const double edges[] = {0.5, 0.07, 0.15, 0.3, 0.6, 0.9};
    for (int e = 0; e < 6; e++) {
        int near = 0, wrong = 0;
        for (int i = 0; i < POINTS; i++)
            for (int k = 0; k < 3; k++) scaled[i][k] = at[i][k] * edges[e];
        stock = make_turned(edges[e]);
        CHECK_OK(swarf_stock_sample(stock, scaled[0], POINTS, value));
        swarf_stock_destroy(stock);
        for (int i = 0; i < POINTS; i++) {
            near += fabsf(unit[i]) < 2.5f;
            wrong += fabs(value[i] / edges[e] - (double)unit[i]) > 1e-4;
        }
        CHECK(near > 1000);
        CHECK(wrong == 0);
    }
}

/* Random cuts leave fields that are no distances everywhere: of finer voxels that are made of those none says the other
 * side where both are sure. */
static void check_sides(void)
{
    enum { POINTS = 100000 };
    static double at[POINTS][3], turned[POINTS][3];
    static float before[POINTS], after[POINTS];
    const uint64_t states[] = {3000016, 15000052, 0, 0};
    test_random seeds = test_random_begin(20261124);
    for (int i = 0; i < 4; i++) {
        test_random random = {.state = states[i] ? states[i] : test_random_below(&seeds, UINT64_MAX)};
        swarf_surface *surface = NULL;
        swarf_stock *stock = stock_random(&random, test_random_in(&random, 0.1, 0.25), 12, &surface), *finer = NULL;
        const double own = swarf_stock_voxel(stock);
        swarf_box box;
        double angle[3], shift[3];
        for (int k = 0; k < 3; k++) {
            angle[k] = test_random_in(&random, -3, 3);
            shift[k] = test_random_in(&random, -50, 50);
        }
        const swarf_placement there = placement_make(angle, shift);
        CHECK_OK(swarf_stock_box(stock, &box));
        finer = place(stock, &there, NULL, 0.35 * own, 0);
        for (int p = 0; p < POINTS; p++) {
            for (int k = 0; k < 3; k++) at[p][k] = test_random_in(&random, box.lo[k] - own, box.hi[k] + own);
            swarf_placement_point(&there, at[p], turned[p]);
        }
        CHECK_OK(swarf_stock_sample(stock, at[0], POINTS, before));
        CHECK_OK(swarf_stock_sample(finer, turned[0], POINTS, after));
        int inside = 0, wrong = 0;
        for (int p = 0; p < POINTS; p++) {
            inside += before[p] < 0;
            wrong += (before[p] < 0) != (after[p] < 0) && fminf(fabsf(before[p]), fabsf(after[p])) > 0.5 * own;
        }
        CHECK(inside > POINTS / 10 && wrong == 0);
        swarf_surface_release(surface);
        swarf_stock_destroy(finer);
        swarf_stock_destroy(stock);
    }
}

/* What an earlier set-up cut is, in a picture of this one, the stock as it was. */
static void check_pick(swarf_stock *turned, swarf_surface *surface, const swarf_placement *over)
{
    double floor[3] = {3, SLOT_Y, SLOT_Z};
    swarf_placement_point(over, floor, floor);
    const swarf_box around = {{floor[0] - 1, floor[1] - 1, floor[2] - 1}, {floor[0] + 1, floor[1] + 1, floor[2] + 1}};
    const swarf_picture_options options = swarf_picture_options_default();
    swarf_scene *scene = NULL;
    swarf_camera camera;
    swarf_pick pick = {0};
    CHECK_OK(swarf_scene_create(turned, &scene));
    CHECK_OK(swarf_scene_set_surface(scene, surface, SIZE_MAX, 0));
    CHECK_OK(swarf_camera_fit(SWARF_VIEW_BOTTOM, 0, &around, 1, &camera));
    CHECK_OK(swarf_scene_pick(scene, &camera, &options, 0, 0, &pick));
    CHECK(pick.seen == SWARF_SEEN_STOCK && pick.move == -1);
    CHECK_NEAR(pick.point[2], floor[2], 1e-3);
    swarf_scene_destroy(scene);
}

static int cancel_at_once(void *user, double fraction)
{
    (void)user;
    (void)fraction;
    return 1;
}

/* Turned over and cut again: every vertex of the mesh on the true surface of both set-ups, and it tells of which. */
static void check_chain(const double angle[3], int lossless)
{
    const swarf_placement over = placement_make(angle, (double[]){1, 2, -3}), back = swarf_placement_inverse(&over);
    swarf_stock *stock = make_block(voxel);
    job top = first_job();
    swarf_surface *first = NULL, *second = NULL;
    CHECK_OK(swarf_surface_create(stock, top.program, &top.tool, 1, NULL, &first));
    play(stock, &top);
    CHECK_OK(swarf_threads_set(1));
    swarf_stock *turned = place(stock, &over, first, 0, lossless);
    CHECK_OK(swarf_threads_set(3));
    swarf_stock *again = place(stock, &over, first, 0, lossless);
    CHECK(stock_hash(again) == stock_hash(turned));
    swarf_stock_destroy(again);
    CHECK_OK(swarf_threads_set(0));
    double middle[3] = {10, 6, -6};
    swarf_placement_point(&over, middle, middle);
    const double way[2] = {cos(1.1), sin(1.1)}, depth = middle[2] - 1.5; /* into what was the underside */
    job bottom = make_job((double[]){middle[0] - 30 * way[0], middle[1] - 30 * way[1], depth},
                          (double[]){middle[0] + 30 * way[0], middle[1] + 30 * way[1], depth});
    CHECK_OK(swarf_surface_create_next(first, SIZE_MAX, &over, bottom.program, &bottom.tool, 1, NULL, &second));
    play(turned, &bottom);
    swarf_contour_options options = swarf_contour_options_default();
    options.surface = second;
    options.moves = SIZE_MAX;
    options.error_mm = 0.001;
    swarf_mesh *mesh = NULL;
    if (!CHECK_OK(swarf_mesh_contour(turned, &options, NULL, &mesh, NULL))) return;
    CHECK(swarf_mesh_topology(mesh).closed && swarf_mesh_topology(mesh).nonmanifold_edges == 0);
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    double worst = 0;
    for (size_t i = 0; i < t.vertex_count; i++) {
        double p[3];
        for (size_t k = 0; k < 3; k++) p[k] = (double)t.xyz[3 * i + k];
        const double across = fabs((p[0] - middle[0]) * -way[1] + (p[1] - middle[1]) * way[0]) - SLOT_R;
        const double slot = fmax(across, depth - p[2]);
        swarf_placement_point(&back, p, p);
        worst = fmax(worst, fabs(fmax(first_distance(p), -slot)) / voxel);
    }
    CHECK(worst < 0.01);
    printf("chain: vertices off by %.5f voxels, %zu triangles\n", worst, t.triangle_count);
    size_t seen[2] = {0}, shape = 0;
    swarf_surface_point *points = malloc((t.triangle_count + 1) * sizeof *points);
    CHECK_OK(swarf_mesh_origins(mesh, second, SIZE_MAX, 0, NULL, points));
    swarf_surface_mark *marks = malloc((t.triangle_count + 1) * sizeof *marks);
    const swarf_progress stop = {cancel_at_once, NULL};
    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_FAILS(swarf_surface_marks(second, points, t.triangle_count, &stop, marks), SWARF_ERROR_CANCELLED, NULL);
    CHECK_OK(swarf_surface_marks(second, points, t.triangle_count, NULL, marks));
    for (size_t i = 0; i < t.triangle_count; i++) {
        int set_up;
        int64_t move;
        swarf_surface_origin(second, points[i].move, &set_up, &move);
        CHECK(move >= -1 && (move == -1 ? set_up == 1 : set_up < 2 && move == 0));
        const int known = points[i].move != -2;
        CHECK(marks[i].set_up == (known ? set_up : 0) && marks[i].move == (known ? move : -2) &&
              marks[i].piece == points[i].piece && marks[i].face == (int)swarf_surface_face(second, &points[i]));
        if (move == -1)
            shape++;
        else
            seen[set_up & 1]++;
    }
    CHECK(seen[0] > 3 && seen[1] > 3 && shape > 5);
    free(points);
    free(marks);
    if (lossless) check_pick(turned, second, &over);
    swarf_mesh_release(mesh);
    swarf_surface_release(first);
    swarf_surface_release(second);
    swarf_stock_destroy(turned);
    swarf_stock_destroy(stock);
    end_job(&top);
    end_job(&bottom);
}

static void check_errors(void)
{
    swarf_placement placement = swarf_placement_identity();
    double rows[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0};
    CHECK_FAILS(swarf_placement_create(rows, &placement), SWARF_ERROR_ARGUMENT, "mirrors");
    rows[10] = 1.1;
    CHECK_FAILS(swarf_placement_create(rows, &placement), SWARF_ERROR_ARGUMENT, "skews or scales");
    rows[10] = 1;
    rows[3] = NAN;
    CHECK_FAILS(swarf_placement_create(rows, &placement), SWARF_ERROR_ARGUMENT, "row 0, column 3 is not finite");
    rows[3] = 2e6;
    CHECK_FAILS(swarf_placement_create(rows, &placement), SWARF_ERROR_ARGUMENT, "shifted by 2e+06 mm in x");

    swarf_stock *stock = make_block(1), *placed = NULL;
    const swarf_placement turn = placement_make((double[]){0, 0, 0.3}, (double[]){0, 0, 0});
    swarf_place_options options = swarf_place_options_default();
    const swarf_placement over = placement_make((double[]){pi, 0, 0}, (double[]){0, 0, 0});
    options = swarf_place_options_default();
    options.memory_limit = 10000;
    CHECK_FAILS(swarf_stock_place(stock, &over, &options, NULL, &placed, NULL), SWARF_ERROR_MEMORY, "turned it needs");
    options.memory_limit = 0;
    /* filled by hand: refused wherever one goes in, and no quarter turn */
    const swarf_placement bad[4] = {{.rotation = {{1, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                                    {.rotation = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}},
                                    {.rotation = {{1, 0, 0.5}, {0, 1, 0}, {0, 0, 1}}},
                                    {.rotation = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .shift = {0, NAN, 0}}};
    const char *const why[4] = {"rows 0 and 1", "mirrors", "rows 0 and 0", "row 1, column 3 is not finite"};
    job cut = first_job();
    swarf_surface *surface = NULL, *next = NULL;
    CHECK_OK(swarf_surface_create(stock, cut.program, &cut.tool, 1, NULL, &surface));
    swarf_mesh *mesh = NULL, *moved = NULL;
    const float corner[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t index[3] = {0, 1, 2};
    CHECK_OK(swarf_mesh_create(&(swarf_triangles){corner, 3, index, 1}, &mesh));
    for (int i = 0; i < 4; i++) {
        int axis[3] = {7, 7, 7}, sign[3] = {7, 7, 7};
        if (i < 3) CHECK(!swarf_placement_quarters(&bad[i], axis, sign) && axis[0] == 7 && sign[0] == 7);
        CHECK_FAILS(swarf_stock_place(stock, &bad[i], NULL, NULL, &placed, NULL), SWARF_ERROR_ARGUMENT, why[i]);
        CHECK_FAILS(swarf_surface_create_next(surface, 0, &bad[i], cut.program, &cut.tool, 1, NULL, &next),
                    SWARF_ERROR_ARGUMENT, why[i]);
        CHECK_FAILS(swarf_mesh_create_placed(mesh, &bad[i], &moved), SWARF_ERROR_ARGUMENT, why[i]);
    }
    CHECK(!placed && !next && !moved);
    swarf_mesh_release(mesh);
    swarf_surface_release(surface);
    end_job(&cut);
    options.voxel_mm = -1;
    CHECK_FAILS(swarf_stock_place(stock, &turn, &options, NULL, &placed, NULL), SWARF_ERROR_ARGUMENT, "voxel size -1");
    options.voxel_mm = 0.001;
    options.memory_limit = 1000000;
    CHECK_FAILS(swarf_stock_place(stock, &turn, &options, NULL, &placed, NULL), SWARF_ERROR_MEMORY, "fits");
    job j = make_job((double[]){-30, 6, -10}, (double[]){40, 6, -10});
    swarf_cutter *wide = NULL;
    CHECK_OK(swarf_cutter_parse("flat:d=40,l=30", &wide));
    j.tool.cutter = wide;
    play(stock, &j);
    CHECK_FAILS(swarf_stock_place(stock, &turn, NULL, NULL, &placed, NULL), SWARF_ERROR_GEOMETRY, "nothing is left");
    CHECK(placed == NULL);
    swarf_cutter_release(wide);
    swarf_stock_destroy(stock);
    end_job(&j);
}

int main(void)
{
    check_quarters();
    check_untouched();
    check_cost();
    check_round();
    check_scale();
    check_sides();
    check_chain((double[]){pi, 0, 0}, 1);
    check_chain((double[]){pi + 0.05, 0.03, 0.4}, 0);
    check_errors();
    return test_end();
}
