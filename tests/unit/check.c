/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Each check with its first contact in closed form, and no alarm where there is no cause. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shapes.h"
#include "test.h"

static const swarf_box block = {{0, 0, -20}, {80, 60, 0}};

/* Flutes 10 long, a shank of the same width to 30, a holder of 20 wide from there. */
static const char cutter_text[] = "flat:d=6,l=10,sd=6,sl=20,hd=20,hl=30";

typedef struct job {
    swarf_program *program;
    swarf_stock *stock;
    swarf_cutter *cutter;
    swarf_check_options options;
    swarf_check *check;
    const swarf_check_finding *findings;
    size_t count;
} job;

static void set_spindle(job *j, int32_t spindle)
{
    const swarf_section section = {.tool = 1, .spindle = spindle, .spindle_rpm = 8000};
    CHECK_OK(swarf_program_set_section(j->program, &section));
}

static job begin(const char *cutter, double voxel)
{
    job j = {.options = swarf_check_options_default()};
    const double start[3] = {40, 30, 50};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    CHECK_OK(swarf_program_create(start, &j.program));
    CHECK_OK(swarf_program_add_operation(j.program, "work"));
    set_spindle(&j, SWARF_SPINDLE_CW);
    CHECK_OK(swarf_cutter_parse(cutter, &j.cutter));
    CHECK_OK(swarf_stock_create_box(&block, &options, &j.stock));
    return j;
}

static void line(job *j, swarf_move_kind kind, double x, double y, double z, uint32_t number)
{
    const double end[3] = {x, y, z};
    CHECK_OK(swarf_program_add_line(j->program, kind, end, 300, number));
}

static void run(job *j)
{
    const swarf_tool tool = {.number = 1, .cutter = j->cutter};
    CHECK_OK(swarf_stock_check(j->stock, j->program, 0, swarf_program_move_count(j->program), &tool, 1, &j->options,
                               NULL, &j->check));
    j->findings = swarf_check_findings(j->check, &j->count);
}

static void end(job *j)
{
    swarf_check_destroy(j->check);
    swarf_program_release(j->program);
    swarf_cutter_release(j->cutter);
    swarf_stock_destroy(j->stock);
}

static void print(const job *j)
{
    for (size_t i = 0; i < j->count; i++)
        printf("  line %u t %.4f (%g, %g, %g): %s %s\n", j->findings[i].line, j->findings[i].t, j->findings[i].tip[0],
               j->findings[i].tip[1], j->findings[i].tip[2], swarf_check_name((swarf_check_kind)j->findings[i].kind),
               j->findings[i].text);
}

/* One finding of this kind on this line, first touching with the tip at (x, y, z). */
static void expect(const job *j, swarf_check_kind kind, uint32_t number, double x, double y, double z)
{
    if (!CHECK(j->count == 1)) print(j);
    if (j->count == 0) return;
    const swarf_check_finding *f = j->findings;
    const double tolerance = fmax(0.05, 0.1 * swarf_stock_voxel(j->stock)) + 0.02 * swarf_stock_voxel(j->stock);
    CHECK(f->kind == (int)kind);
    CHECK(f->line == number);
    CHECK_NEAR(f->tip[0], x, tolerance);
    CHECK_NEAR(f->tip[1], y, tolerance);
    CHECK_NEAR(f->tip[2], z, tolerance);
    CHECK(f->text[0] != 0);
}

static void check_all_well(double voxel)
{
    job j = begin(cutter_text, voxel);
    j.options.clearance_mm = 2;
    line(&j, SWARF_MOVE_RAPID, 20, 20, 5, 1);
    for (int layer = 1; layer <= 2; layer++) { /* 20 deep in all would bring the holder down to 10 above */
        line(&j, SWARF_MOVE_FEED, 20, 20, -5 * layer, 2);
        line(&j, SWARF_MOVE_FEED, 60, 20, -5 * layer, 3);
        line(&j, SWARF_MOVE_FEED, 60, 40, -5 * layer, 4);
        line(&j, SWARF_MOVE_FEED, 20, 40, -5 * layer, 5);
        line(&j, SWARF_MOVE_FEED, 20, 20, -5 * layer, 6);
        line(&j, SWARF_MOVE_RAPID, 20, 20, 5, 7);
        line(&j, SWARF_MOVE_RAPID, 40, 30, 5, 8);
        line(&j, SWARF_MOVE_RAPID, 20, 20, 5, 9);
        line(&j, SWARF_MOVE_RAPID, 20, 20, -5 * layer, 10); /* back to the floor just cut, along its walls */
    }
    line(&j, SWARF_MOVE_RAPID, 20, 20, 50, 11);
    run(&j);
    if (!CHECK(j.count == 0)) print(&j);
    end(&j);
}

static void check_rapids(double voxel)
{
    job j = begin(cutter_text, voxel);
    line(&j, SWARF_MOVE_RAPID, -20, 30, 20, 1);
    line(&j, SWARF_MOVE_RAPID, -20, 30, -4, 2);
    line(&j, SWARF_MOVE_RAPID, 30, 30, -4, 3); /* its side meets the block at x = 0 */
    run(&j);
    expect(&j, SWARF_CHECK_RAPID, 3, -3, 30, -4);
    end(&j);

    j = begin(cutter_text, voxel);
    line(&j, SWARF_MOVE_RAPID, 30, 30, 10, 1);
    line(&j, SWARF_MOVE_RAPID, 30, 30, -6, 2);
    run(&j);
    expect(&j, SWARF_CHECK_RAPID, 2, 30, 30, 0);
    end(&j);

    /* from inside */
    job inside = {.options = swarf_check_options_default()};
    inside = begin(cutter_text, voxel);
    swarf_program_release(inside.program);
    const double start[3] = {40, 30, -5};
    CHECK_OK(swarf_program_create(start, &inside.program));
    CHECK_OK(swarf_program_add_operation(inside.program, "work"));
    set_spindle(&inside, SWARF_SPINDLE_CW);
    line(&inside, SWARF_MOVE_RAPID, 40, 30, 20, 1);
    run(&inside);
    expect(&inside, SWARF_CHECK_START, 1, 40, 30, -5);
    end(&inside);
}

static void check_holder(double voxel)
{
    /* the holder's lower face is at 30: the tip at -30 would bring it to the top, were the block that thick */
    job j = begin("flat:d=6,l=10,sd=6,sl=4,hd=20,hl=30", voxel); /* holder from 14 on */
    line(&j, SWARF_MOVE_RAPID, 40, 30, 5, 1);
    line(&j, SWARF_MOVE_FEED, 40, 30, -9, 2);
    line(&j, SWARF_MOVE_FEED, 40, 30, -17, 3);
    line(&j, SWARF_MOVE_FEED, 50, 30, -17, 4);
    run(&j);
    CHECK(j.count >= 2);
    if (j.count) {
        const swarf_check_finding *f = NULL;
        for (size_t i = 0; i < j.count && !f; i++)
            if (j.findings[i].kind == SWARF_CHECK_HOLDER) f = &j.findings[i];
        if (CHECK(f != NULL)) {
            CHECK(f->line == 3);
            CHECK_NEAR(f->tip[2], -14, 0.1 * voxel + 0.05);
        }
    }
    end(&j);

    /* sideways into a wall: the block is cut down to -15 left of x = 30, the holder then runs against it */
    j = begin("flat:d=6,l=20,sd=6,sl=4,hd=30,hl=30", voxel);
    j.options.clearance_mm = 1;
    for (int y = -3; y <= 63; y += 3) {
        line(&j, SWARF_MOVE_RAPID, -10, y, 5, 1);
        line(&j, SWARF_MOVE_RAPID, -10, y, -15, 1);
        line(&j, SWARF_MOVE_FEED, 27, y, -15, 2);
        line(&j, SWARF_MOVE_RAPID, -10, y, -15, 3);
    }
    run(&j);
    if (!CHECK(j.count == 0)) print(&j); /* the holder is at 9 above the tip's -15 + 24 */
    end(&j);
}

/* Shank and holder run sideways against the block's face at x = 0, above where the flutes cut. */
static void check_sideways(double voxel)
{
    job j = begin("flat:d=6,l=10,sd=10,sl=20", voxel);
    line(&j, SWARF_MOVE_RAPID, -20, 30, 20, 1);
    line(&j, SWARF_MOVE_RAPID, -20, 30, -15, 2);
    line(&j, SWARF_MOVE_FEED, -4, 30, -15, 3);
    run(&j);
    expect(&j, SWARF_CHECK_SHANK, 3, -5, 30, -15);
    CHECK(j.count && j.findings[0].part == SWARF_PART_SHANK);
    end(&j);
    j = begin("flat:d=6,l=10,sd=6,sl=4,hd=20,hl=30", voxel);
    line(&j, SWARF_MOVE_RAPID, -20, 30, 20, 1);
    line(&j, SWARF_MOVE_RAPID, -20, 30, -16, 2);
    line(&j, SWARF_MOVE_FEED, -5, 30, -16, 3);
    run(&j);
    expect(&j, SWARF_CHECK_HOLDER, 3, -10, 30, -16);
    CHECK(j.count && j.findings[0].part == SWARF_PART_HOLDER);
    end(&j);
}

/* On an arc of radius 25 about (-20, 30) the shank meets the face x = 0 with the tip at x = -5. */
static void check_arc(double voxel)
{
    job j = begin("flat:d=6,l=10,sd=10,sl=20", voxel);
    const double to[3] = {-20, 5, -15}, centre[3] = {-20, 30, -15};
    line(&j, SWARF_MOVE_RAPID, -20, 55, 20, 1);
    line(&j, SWARF_MOVE_RAPID, -20, 55, -15, 2);
    CHECK_OK(swarf_program_add_arc(j.program, to, centre, SWARF_PLANE_XY, 0, 1, 300, 3));
    run(&j);
    expect(&j, SWARF_CHECK_SHANK, 3, -5, 50, -15);
    end(&j);
}

/* Straight up out of a pocket beside the block's corner, where the flutes end above the block's top: what is left of
 * the distances from that top is no material. */
static void check_retract(double voxel)
{
    job j = begin("flat:d=3,l=18,sd=3,sl=20,hd=30,hl=40", voxel);
    line(&j, SWARF_MOVE_RAPID, 70, 50, 5, 1);
    line(&j, SWARF_MOVE_FEED, 70, 50, -17.4, 2);
    for (double y = 50; y < 60; y += 2) {
        line(&j, SWARF_MOVE_FEED, 70, y, -17.4, 3);
        line(&j, SWARF_MOVE_FEED, 80, y, -17.4, 4);
        line(&j, SWARF_MOVE_FEED, 80, y + 2, -17.4, 5);
        line(&j, SWARF_MOVE_FEED, 70, y + 2, -17.4, 6);
    }
    line(&j, SWARF_MOVE_FEED, 79.999, 59.998, -17.4, 7);
    line(&j, SWARF_MOVE_RAPID, 79.999, 59.998, 10, 8);
    run(&j);
    if (!CHECK(j.count == 0)) print(&j);
    end(&j);
}

static void check_near(double voxel)
{
    job j = begin("flat:d=6,l=16,hd=20,hl=30", voxel);
    j.options.clearance_mm = 1.5;
    line(&j, SWARF_MOVE_RAPID, 40, 30, 5, 1);
    line(&j, SWARF_MOVE_FEED, 40, 30, -15, 2); /* the holder ends 1 above the top; nearer than 1.5 from -14.5 on */
    line(&j, SWARF_MOVE_RAPID, 40, 30, 20, 3);
    run(&j);
    CHECK(j.count >= 1);
    if (j.count) {
        CHECK(j.findings[0].kind == SWARF_CHECK_NEAR && j.findings[0].severity == SWARF_WARNING);
        CHECK_NEAR(j.findings[0].tip[2], -14.5, 0.1 * voxel + 0.05);
    }
    end(&j);
}

static void check_depth(double voxel)
{
    job j = begin("flat:d=6,l=10", voxel); /* no shank: what lies above the flutes must not go in */
    line(&j, SWARF_MOVE_RAPID, 40, 30, 5, 1);
    line(&j, SWARF_MOVE_FEED, 40, 30, -8, 2);
    line(&j, SWARF_MOVE_FEED, 50, 30, -8, 3);
    run(&j);
    CHECK(j.count == 0);
    end(&j);
    j = begin("flat:d=6,l=10", voxel);
    line(&j, SWARF_MOVE_RAPID, 40, 30, 5, 1);
    line(&j, SWARF_MOVE_FEED, 40, 30, -13, 2);
    run(&j);
    expect(&j, SWARF_CHECK_DEPTH, 2, 40, 30, -10);
    end(&j);
}

static void check_fixtures_and_design(double voxel)
{
    const double lo[3] = {70, 20, 0}, hi[3] = {80, 40, 30}, design_hi[3] = {80, 60, -2};
    shape clamp = {0}, part = {0};
    shape_box(&clamp, lo, hi);
    shape_box(&part, block.lo, design_hi);
    const swarf_triangles triangles[2] = {shape_view(&clamp), shape_view(&part)};
    swarf_solid *solid[2] = {NULL, NULL};
    for (int i = 0; i < 2; i++) CHECK_OK(swarf_solid_create(&triangles[i], NULL, &solid[i]));
    const swarf_solid *const fixtures[1] = {solid[0]};
    /* the side of each part meets the clamp at x = 70, on a rapid and on a feed; what is above it has not met it before
     */
    static const struct {
        const char *cutter;
        swarf_part_kind part;
        double radius, z;
    } sides[3] = {{"flat:d=6,l=30", SWARF_PART_FLUTES, 3, 5},
                  {"flat:d=6,l=10,sd=8,sl=30", SWARF_PART_SHANK, 4, 1},
                  {"flat:d=6,l=10,sd=6,sl=4,hd=20,hl=30", SWARF_PART_HOLDER, 10, 0.5}};
    for (int i = 0; i < 6; i++) {
        const double radius = sides[i / 2].radius, z = sides[i / 2].z;
        job j = begin(sides[i / 2].cutter, voxel);
        j.options.fixtures = fixtures;
        j.options.fixture_count = 1;
        line(&j, SWARF_MOVE_RAPID, 40, 30, z, 1);
        line(&j, i % 2 ? SWARF_MOVE_FEED : SWARF_MOVE_RAPID, 70.6 - radius, 30, z, 2);
        run(&j);
        expect(&j, SWARF_CHECK_FIXTURE, 2, 70 - radius, 30, z);
        CHECK(j.count && j.findings[0].part == (int)sides[i / 2].part);
        end(&j);
    }
    job j = begin("flat:d=6,l=30", voxel);
    j.options.design = solid[1];
    line(&j, SWARF_MOVE_RAPID, 40, 30, 5, 1);
    line(&j, SWARF_MOVE_FEED, 40, 30, -2, 2);
    line(&j, SWARF_MOVE_FEED, 50, 30, -2, 3);
    line(&j, SWARF_MOVE_FEED, 50, 30, -3, 4); /* 1 mm too deep, of which 0.05 are allowed */
    run(&j);
    expect(&j, SWARF_CHECK_DESIGN, 4, 50, 30, -2.05);
    end(&j);
    /* a shank wider than the flutes, in a slot that these cut beside the design: no allowance for it */
    j = begin("flat:d=6,l=10,sd=10,sl=30", voxel);
    j.options.design = solid[1];
    line(&j, SWARF_MOVE_RAPID, -20, 30, 5, 1);
    line(&j, SWARF_MOVE_RAPID, -20, 30, -15, 2);
    line(&j, SWARF_MOVE_FEED, -4, 30, -15, 3);
    run(&j);
    if (CHECK(j.count == 2)) { /* the block is there as well */
        const swarf_check_finding *f = &j.findings[j.findings[0].kind != SWARF_CHECK_DESIGN];
        CHECK(f->kind == SWARF_CHECK_DESIGN && f->part == SWARF_PART_SHANK && f->line == 3);
        CHECK_NEAR(f->tip[0], -5, 0.1 * voxel + 0.05);
    }
    end(&j);
    for (int i = 0; i < 2; i++) swarf_solid_release(solid[i]);
    shape_free(&clamp);
    shape_free(&part);
}

/* A step clamp of three boxes that overlap and lie flush: round its foot, over its steps and along its flanks the tool
 * clears it by a fifth of a voxel; then it goes 0.6 mm into the second step. */
static void check_step_clamp(double voxel)
{
    static const double boxes[3][2][3] = {{{20.3, 20.1, 1}, {60.3, 40.1, 11.2}},
                                          {{20.3, 20.1, 3}, {45.3, 40.1, 21.2}},
                                          {{20.3, 20.1, 1}, {30.3, 40.1, 31.2}}};
    static const double side = 3, clear = 0.2;
    shape clamp = {0};
    for (int i = 0; i < 3; i++) shape_box(&clamp, boxes[i][0], boxes[i][1]);
    const swarf_triangles triangles = shape_view(&clamp);
    swarf_solid *solid = NULL;
    CHECK_OK(swarf_solid_create(&triangles, NULL, &solid));
    const swarf_solid *const fixtures[1] = {solid};
    for (int deep = 0; deep < 2; deep++) {
        const double away = clear * voxel, z = deep ? 20.6 : 21.2 + away;
        job j = begin("flat:d=6,l=40", voxel);
        j.options.fixtures = fixtures;
        j.options.fixture_count = 1;
        line(&j, SWARF_MOVE_RAPID, 20.3 - side - away, 20.1 - side - away, 50, 1);
        line(&j, SWARF_MOVE_RAPID, 20.3 - side - away, 20.1 - side - away, 1, 2);
        line(&j, SWARF_MOVE_RAPID, 60.3 + side + away, 20.1 - side - away, 1, 3);
        line(&j, SWARF_MOVE_RAPID, 60.3 + side + away, 40.1 + side + away, 1, 4);
        line(&j, SWARF_MOVE_RAPID, 20.3 - side - away, 40.1 + side + away, 1, 5);
        line(&j, SWARF_MOVE_RAPID, 20.3 - side - away, 30, 1, 6);
        line(&j, SWARF_MOVE_RAPID, 20.3 - side - away, 30, 31.2 + away, 7);
        line(&j, SWARF_MOVE_RAPID, 30.3 + side + away, 30, 31.2 + away, 8);
        line(&j, SWARF_MOVE_RAPID, 30.3 + side + away, 30, z, 9);
        line(&j, SWARF_MOVE_RAPID, 45.3 + side + away, 30, 21.2 + away, 10);
        line(&j, SWARF_MOVE_RAPID, 45.3 + side + away, 30, 11.2 + away, 11);
        line(&j, SWARF_MOVE_RAPID, 70, 30, 11.2 + away, 12);
        run(&j);
        if (!deep && !CHECK(j.count == 0)) print(&j);
        if (deep && CHECK(j.count > 0)) {
            CHECK(j.findings[0].line == 9 && j.findings[0].kind == SWARF_CHECK_FIXTURE);
            CHECK_NEAR(j.findings[0].tip[2], 21.2, 0.1 * voxel + 0.05);
            CHECK_NEAR(j.findings[0].depth_mm, 0.6, 0.1 * voxel + 0.05);
        }
        end(&j);
    }
    swarf_solid_release(solid);
    shape_free(&clamp);
}

static void check_words(void)
{
    job j = begin("flat:d=6,l=10", 0.5);
    const int32_t blunt[1] = {1};
    j.options.no_plunge = blunt;
    j.options.no_plunge_count = 1;
    j.options.travel = (swarf_box){{-10, -10, -100}, {90, 70, 60}};
    line(&j, SWARF_MOVE_RAPID, 40, 30, 5, 1);
    line(&j, SWARF_MOVE_FEED, 40, 30, 1, 2);  /* through air */
    line(&j, SWARF_MOVE_FEED, 40, 30, -2, 3); /* plunges */
    line(&j, SWARF_MOVE_FEED, 60, 30, -4, 4); /* a ramp does not */
    line(&j, SWARF_MOVE_FEED, 95, 30, -4, 5); /* beyond the travel */
    const double here[3] = {95, 30, 10};
    CHECK_OK(swarf_program_add_line(j.program, SWARF_MOVE_FEED, here, 0, 6));
    set_spindle(&j, SWARF_SPINDLE_OFF);
    line(&j, SWARF_MOVE_FEED, 20, 30, 10, 7);
    set_spindle(&j, SWARF_SPINDLE_CCW);
    line(&j, SWARF_MOVE_FEED, 30, 30, 10, 8);
    line(&j, SWARF_MOVE_RAPID, 30, 30, 20, 9);
    run(&j);
    static const struct {
        swarf_check_kind kind;
        uint32_t line;
    } wanted[] = {{SWARF_CHECK_PLUNGE, 3}, {SWARF_CHECK_TRAVEL, 5},  {SWARF_CHECK_FEED, 6},
                  {SWARF_CHECK_TRAVEL, 6}, {SWARF_CHECK_SPINDLE, 7}, {SWARF_CHECK_SPINDLE, 8}};
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        int found = 0;
        for (size_t k = 0; k < j.count; k++)
            found += j.findings[k].kind == (int)wanted[i].kind && j.findings[k].line == wanted[i].line;
        CHECK(found == 1);
    }
    if (!CHECK(j.count == sizeof wanted / sizeof wanted[0])) print(&j);
    end(&j);

    j = begin("flat:d=6,l=10", 0.5);
    line(&j, SWARF_MOVE_RAPID, 40, 30, 5, 1);
    CHECK_OK(swarf_stock_check(j.stock, j.program, 0, 1, NULL, 0, NULL, NULL, &j.check));
    j.findings = swarf_check_findings(j.check, &j.count);
    CHECK(j.count == 1 && j.findings[0].kind == SWARF_CHECK_TOOL);
    CHECK(strstr(j.findings[0].text, "T1 is not in the tool table") != NULL);
    swarf_check_destroy(j.check);
    j.check = NULL;
    swarf_check_options options = swarf_check_options_default();
    options.clearance_mm = -1;
    CHECK_FAILS(swarf_stock_check(j.stock, j.program, 0, 1, NULL, 0, &options, NULL, &j.check), SWARF_ERROR_ARGUMENT,
                "clearance");
    end(&j);
}

/* The stock after checking is that after simulating. */
static void check_stock(void)
{
    job j = begin(cutter_text, 0.25);
    line(&j, SWARF_MOVE_RAPID, 20, 20, 5, 1);
    line(&j, SWARF_MOVE_FEED, 20, 20, -5, 2);
    line(&j, SWARF_MOVE_FEED, 60, 45, -7, 3);
    line(&j, SWARF_MOVE_RAPID, 20, 40, -7, 4);
    line(&j, SWARF_MOVE_RAPID, 20, 40, 7, 5);
    swarf_stock *copy = NULL;
    swarf_simulation *simulation = NULL;
    const swarf_tool tool = {.number = 1, .cutter = j.cutter};
    CHECK_OK(swarf_stock_copy(j.stock, &copy));
    CHECK_OK(swarf_stock_simulate(copy, j.program, 0, swarf_program_move_count(j.program), &tool, 1, NULL, NULL,
                                  &simulation));
    run(&j);
    CHECK(j.count == 1 && j.findings[0].kind == SWARF_CHECK_RAPID && j.findings[0].line == 4);
    double ours = 0, theirs = 1;
    CHECK_OK(swarf_stock_volume(j.stock, &ours));
    CHECK_OK(swarf_stock_volume(copy, &theirs));
    CHECK_NEAR(ours, theirs, 1e-6 * theirs);
    swarf_simulation_destroy(simulation);
    swarf_stock_destroy(copy);
    end(&j);
}

int main(void)
{
    static const double voxels[5] = {0.2, 0.37, 0.5, 0.625, 0.8};
    for (int i = 0; i < 5; i++) {
        check_all_well(voxels[i]);
        check_retract(voxels[i]);
        check_rapids(voxels[i]);
        check_arc(voxels[i]);
        check_holder(voxels[i]);
        check_sideways(voxels[i]);
        check_near(voxels[i]);
        check_depth(voxels[i]);
        check_fixtures_and_design(voxels[i]);
        check_step_clamp(voxels[i]);
    }
    check_words();
    check_stock();
    return test_end();
}
