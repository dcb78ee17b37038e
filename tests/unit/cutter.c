/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cutter room: volumes against closed forms and against numeric integration, extents, text, errors. */
#include <math.h>
#include <string.h>

#include "cases.h"

static const double pi = 3.14159265358979323846;

static double cylinder(double r, double h)
{
    return pi * r * r * h;
}

static double frustum(double r0, double r1, double h)
{
    return pi * h * (r0 * r0 + r0 * r1 + r1 * r1) / 3;
}

/* Of a ball of radius r, from its pole up. */
static double cap(double r, double h)
{
    return pi * h * h * (3 * r - h) / 3;
}

/* Quarter round of radius c at the rim of a disc of radius r, c high. */
static double rounded_disc(double r, double c)
{
    const double flat = r - c;
    return pi * (flat * flat * c + 2 * flat * pi * c * c / 4 + 2 * c * c * c / 3);
}

static void check_shape(const char *text, double volume, double radius, double z_hi)
{
    swarf_cutter *cutter = NULL;
    if (!CHECK_OK(swarf_cutter_parse(text, &cutter))) return;
    double lo, hi;
    const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
    swarf_cutter_extent(cutter, SWARF_PART_FLUTES, &lo, &hi);
    const int good = CHECK_NEAR(swarf_cutter_volume(cutter, SWARF_PART_FLUTES), volume, 1e-12 * volume) &
                     CHECK_NEAR(oracle_volume(&body), volume, 1e-5 * volume) &
                     CHECK_NEAR(swarf_cutter_radius(cutter, SWARF_PART_FLUTES), radius, 1e-12) & CHECK_NEAR(lo, 0, 0) &
                     CHECK_NEAR(hi, z_hi, 1e-12);
    for (int i = 1; i < 100; i++) {
        const double z = z_hi * (i + 0.123) / 100;
        const double at = swarf_cutter_radius_at(cutter, SWARF_PART_FLUTES, z);
        CHECK_NEAR(at, oracle_radius_at(&body, z), 1e-9);
        CHECK_NEAR(oracle_meridian(&body, at, z), 0, 1e-9);
        CHECK(oracle_meridian(&body, at + 1e-6, z) > 0 && oracle_meridian(&body, at - 1e-6, z) < 0);
    }
    CHECK_NEAR(swarf_cutter_radius_at(cutter, SWARF_PART_FLUTES, z_hi + 0.01), -1, 0);
    CHECK_NEAR(swarf_cutter_radius_at(cutter, SWARF_PART_FLUTES, -0.01), -1, 0);
    if (!good) printf("    of %s\n", text);
    swarf_cutter_release(cutter);
}

static void check_shapes(void)
{
    const double rad = pi / 180;
    check_shape("flat:d=4,l=6", cylinder(2, 6), 2, 6);
    check_shape("ball:d=4,l=6", cap(2, 2) + cylinder(2, 4), 2, 6);
    check_shape("ball:d=4,l=2", cap(2, 2), 2, 2);
    check_shape("bull:d=4,r=0.7,l=6", rounded_disc(2, 0.7) + cylinder(2, 5.3), 2, 6);
    check_shape("bull:d=4,r=2,l=6", cap(2, 2) + cylinder(2, 4), 2, 6);
    check_shape("bull:d=4,r=0,l=6", cylinder(2, 6), 2, 6);
    check_shape("chamfer:d=4,a=90,l=5", frustum(0, 2, 2) + cylinder(2, 3), 2, 5);
    const double cone = 1.5 / tan(30 * rad);
    check_shape("chamfer:d=4,a=60,t=1,l=5", frustum(0.5, 2, cone) + cylinder(2, 5 - cone), 2, 5);
    const double point = 2 / tan(59 * rad);
    check_shape("drill:d=4,l=6", frustum(0, 2, point) + cylinder(2, 6 - point), 2, 6);
    check_shape("drill:d=4,l=6,a=90", frustum(0, 2, 2) + cylinder(2, 4), 2, 6);
    const double touch_r = cos(10 * rad), touch_z = 1 - sin(10 * rad), end = touch_r + (6 - touch_z) * tan(10 * rad);
    check_shape("taperedball:t=2,a=10,l=6", cap(1, touch_z) + frustum(touch_r, end, 6 - touch_z), end, 6);
    const double reach = (1.5 - touch_r) / tan(10 * rad);
    check_shape("taperedball:t=2,a=10,l=6,d=3",
                cap(1, touch_z) + frustum(touch_r, 1.5, reach) + cylinder(1.5, 6 - touch_z - reach), 1.5, 6);
    const double top = 2 + sqrt(3);
    check_shape("lollipop:d=4,n=2,l=6", cap(2, top) + cylinder(1, 6 - top), 2, 6);
    check_shape("tslot:d=4,n=2,h=1,l=5", cylinder(2, 1) + cylinder(1, 4), 2, 5);
    check_shape("tslot:d=4,n=2,h=1.2,l=5,r=0.3", 2 * rounded_disc(2, 0.3) + cylinder(2, 0.6) + cylinder(1, 3.8), 2, 5);
    check_shape("dovetail:d=4,a=60,h=1.5,n=2,l=5", frustum(2, 2 - 1.5 / tan(60 * rad), 1.5) + cylinder(1, 3.5), 2, 5);
    const double half = 0.8 * tan(30 * rad);
    check_shape("threadmill:d=4,p=1,k=3,n=2.4,l=5", 6 * frustum(1.2, 2, half) + cylinder(1.2, 5 - 6 * half), 2, 5);
    check_shape("threadmill:d=4,p=1,n=2.4,l=5", 2 * frustum(1.2, 2, half) + cylinder(1.2, 5 - 2 * half), 2, 5);
    check_shape("form:0/0:1/0/-0.41421356237309503:2/1:2/5:0/5", pi * (4 - pi + 2.0 / 3) + cylinder(2, 4), 2, 5);
    check_shape("form:0/0:3/0:3/4", cylinder(3, 4), 3, 4);
}

/* The cutters of the other tests, through the other constructors. */
static void check_cases(void)
{
    for (int i = 0; i < CASE_CUTTERS; i++) {
        const char *name;
        swarf_cutter *cutter = case_cutter(i, &name);
        const oracle_body body = oracle_body_of(cutter, SWARF_PART_FLUTES);
        const double volume = swarf_cutter_volume(cutter, SWARF_PART_FLUTES);
        if (!CHECK_NEAR(oracle_volume(&body), volume, 1e-5 * volume)) printf("    of %s\n", name);
        CHECK_NEAR(swarf_cutter_radius(cutter, SWARF_PART_FLUTES), body.radius, 1e-4);
        swarf_cutter_release(cutter);
    }
}

static void check_parts(void)
{
    swarf_cutter *cutter = NULL;
    if (!CHECK_OK(swarf_cutter_parse("bull:d=6,r=1,l=20,sd=8,sl=30,hd=40,hl=50", &cutter))) return;
    CHECK(swarf_cutter_part_count(cutter) == 3);
    double lo, hi;
    swarf_cutter_extent(cutter, SWARF_PART_SHANK, &lo, &hi);
    CHECK_NEAR(lo, 20, 0);
    CHECK_NEAR(hi, 50, 0);
    CHECK_NEAR(swarf_cutter_volume(cutter, SWARF_PART_SHANK), cylinder(4, 30), 1e-9);
    CHECK_NEAR(swarf_cutter_radius(cutter, SWARF_PART_HOLDER), 20, 0);
    CHECK_NEAR(swarf_cutter_volume(cutter, SWARF_PART_HOLDER), cylinder(20, 50), 1e-9);
    swarf_cutter_part part = {SWARF_PART_FLUTES, NULL, 7};
    CHECK_FAILS(swarf_cutter_part_get(cutter, 3, &part), SWARF_ERROR_ARGUMENT, "3");
    CHECK(part.node_count == 7);
    CHECK(swarf_cutter_retain(cutter) == cutter);
    swarf_cutter_release(cutter);
    CHECK(swarf_cutter_part_count(cutter) == 3);
    swarf_cutter_release(cutter);
    swarf_cutter_release(NULL);

    const swarf_profile_node nodes[] = {{3, 10, 0}, {3, 20, 0}};
    const swarf_cutter_part shank = {SWARF_PART_SHANK, nodes, 2};
    if (CHECK_OK(swarf_cutter_create(&shank, 1, &cutter))) {
        CHECK_NEAR(swarf_cutter_volume(cutter, SWARF_PART_FLUTES), 0, 0);
        CHECK_NEAR(swarf_cutter_radius(cutter, SWARF_PART_FLUTES), 0, 0);
        CHECK_NEAR(swarf_cutter_radius_at(cutter, SWARF_PART_FLUTES, 15), -1, 0);
        swarf_cutter_extent(cutter, SWARF_PART_FLUTES, &lo, &hi);
        CHECK(lo == 0 && hi == 0);
        swarf_cutter_release(cutter);
    }
}

/* Every text that must be refused, and a word its error must name. */
static void check_refused_text(void)
{
    static const struct {
        const char *text, *names;
    } refused[] = {
        {"", "flat"},
        {"flat", "flat:d="},
        {"Flat:d=3,l=18", "Flat"},
        {"flatt:d=3,l=18", "flatt"},
        {"flat:", "letter=number"},
        {"flat:d=3", "l"},
        {"flat:l=3", "d"},
        {"flat:d,l=3", "'d'"},
        {"flat:=3,l=3", "=3"},
        {"flat:d=,l=3", "d="},
        {"flat:d=3x,l=3", "3x"},
        {"flat:d=3,,l=3", NULL},
        {"flat:d=3,l=3,", NULL},
        {"flat:d=3,d=4,l=18", "twice"},
        {"flat:d=0,l=18", "d"},
        {"flat:d=-3,l=18", "-3"},
        {"flat:d=nan,l=18", "nan"},
        {"flat:d=inf,l=18", "inf"},
        {"flat:d=1e999,l=18", "1e999"},
        {"flat:d=6,l=1e9", "up to 10000"},
        {"flat:d=3,l=18,q=1", "q"},
        {"flat:d=3,l=18,r=1", "r"},
        {"flat:d=3,l=18,sd=6", "sl"},
        {"flat:d=3,l=18,hl=6", "hd"},
        {"ball:d=4,l=1", "l"},
        {"bull:d=4,l=8", "r"},
        {"bull:d=4,l=8,r=2.1", "r"},
        {"bull:d=4,l=8,r=-1", "-1"},
        {"bull:d=4,l=0.5,r=1", "l"},
        {"chamfer:d=4,l=8", "a"},
        {"chamfer:d=4,l=8,a=180", "180"},
        {"chamfer:d=4,l=8,a=90,t=5", "tip"},
        {"chamfer:d=4,l=1,a=90", "l"},
        {"drill:d=4,l=1", "l"},
        {"drill:d=4,l=8,a=0", "0"},
        {"taperedball:t=2,a=90,l=8", "90"},
        {"taperedball:t=2,a=5,l=0.1", "l"},
        {"taperedball:t=2,a=5,l=8,d=1", "d"},
        {"lollipop:d=4,n=4,l=8", "n"},
        {"lollipop:d=4,n=1,l=3", "l"},
        {"tslot:d=4,n=4,h=1,l=5", "n"},
        {"tslot:d=4,n=2,h=5,l=5", "h"},
        {"tslot:d=4,n=2,h=1,l=5,r=0.6", "r"},
        {"dovetail:d=4,a=90,h=1,n=1,l=5", "90"},
        {"dovetail:d=4,a=30,h=3,n=1,l=5", "dovetail"},
        {"threadmill:d=4,p=1,n=4,l=5", "n"},
        {"threadmill:d=4,p=1,n=2,l=5,k=1.5", "k"},
        {"threadmill:d=4,p=1,n=2,l=5,k=1000000", "k"},
        {"threadmill:d=4,p=0.5,n=2,l=5", "p"},
        {"threadmill:d=4,p=1,k=6,n=2.4,l=5", "l"},
        {"form:", "0"},
        {"form:0/0", NULL},
        {"form:0/0:3", "1"},
        {"form:0/0:3/0:3/4x", "2"},
        {"form:0/0:3/0/0/0:3/4", "1"},
        {"form:0/0:nan/0:3/4", NULL},
    };
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        swarf_cutter *cutter = NULL;
        const swarf_status status = swarf_cutter_parse(refused[i].text, &cutter);
        const int form = strncmp(refused[i].text, "form:", 5) == 0;
        const int good = CHECK(status == SWARF_ERROR_FORMAT || (form && status == SWARF_ERROR_GEOMETRY)) &
                         CHECK(cutter == NULL) &
                         CHECK(!refused[i].names || strstr(swarf_error_last(), refused[i].names) != NULL);
        if (!good) printf("    of \"%s\": %s \"%s\"\n", refused[i].text, swarf_status_name(status), swarf_error_last());
        if (status == SWARF_OK) swarf_cutter_release(cutter);
    }
    swarf_cutter *cutter = NULL;
    CHECK_FAILS(swarf_cutter_parse(NULL, &cutter), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_cutter_parse("flat:d=3,l=18", NULL), SWARF_ERROR_ARGUMENT, NULL);
}

static void check_refused_parts(void)
{
    static const swarf_profile_node down[] = {{0, 0, 0}, {3, 2, 0}, {3, 1, 0}, {0, 4, 0}};
    static const swarf_profile_node negative[] = {{0, 0, 0}, {-3, 0, 0}, {3, 4, 0}};
    static const swarf_profile_node flat[] = {{0, 1, 0}, {3, 1, 0}};
    static const swarf_profile_node thin[] = {{0, 0, 0}, {0, 4, 0}};
    static const swarf_profile_node infinite[] = {{0, 0, 0}, {3, 0, 0}, {3, INFINITY, 0}};
    static const swarf_profile_node bulge[] = {{0, 0, 0}, {3, 0, NAN}, {3, 4, 0}};
    /* The arc leaves downwards, or dips behind the axis. */
    static const swarf_profile_node dips[] = {{0, 0, 0}, {1, 0, 0.9}, {3, 0.5, 0}, {3, 4, 0}};
    static const swarf_profile_node behind[] = {{0, 0, 0}, {0.5, 0, -0.9}, {0.5, 4, 0}};
    /* Larger than anything that turns in a spindle. */
    static const swarf_profile_node wide[] = {{0, 0, 0}, {2e4, 0, 0}, {2e4, 4, 0}};
    static const swarf_profile_node high[] = {{0, 0, 0}, {2, 0, 0}, {2, 1e300, 0}};
    static const struct {
        const swarf_profile_node *nodes;
        size_t count;
        swarf_status status;
    } refused[] = {
        {down, 4, SWARF_ERROR_GEOMETRY}, {negative, 3, SWARF_ERROR_GEOMETRY}, {flat, 2, SWARF_ERROR_GEOMETRY},
        {thin, 2, SWARF_ERROR_GEOMETRY}, {infinite, 3, SWARF_ERROR_ARGUMENT}, {bulge, 3, SWARF_ERROR_ARGUMENT},
        {dips, 4, SWARF_ERROR_GEOMETRY}, {behind, 3, SWARF_ERROR_GEOMETRY},   {down, 1, SWARF_ERROR_GEOMETRY},
        {down, 0, SWARF_ERROR_GEOMETRY}, {NULL, 3, SWARF_ERROR_ARGUMENT},     {wide, 3, SWARF_ERROR_GEOMETRY},
        {high, 3, SWARF_ERROR_GEOMETRY},
    };
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        const swarf_cutter_part part = {SWARF_PART_FLUTES, refused[i].nodes, refused[i].count};
        swarf_cutter *cutter = NULL;
        if (!CHECK_FAILS(swarf_cutter_create(&part, 1, &cutter), refused[i].status, NULL))
            printf("    of profile %zu\n", i);
        CHECK(cutter == NULL);
    }
    swarf_cutter *cutter = NULL;
    CHECK_FAILS(swarf_cutter_create(NULL, 0, &cutter), SWARF_ERROR_ARGUMENT, NULL);
    swarf_dimensions dimensions = swarf_dimensions_default();
    CHECK_FAILS(swarf_cutter_create_shape(SWARF_SHAPE_FLAT, &dimensions, &cutter), SWARF_ERROR_ARGUMENT, "d");
    CHECK_FAILS(swarf_cutter_create_shape(SWARF_SHAPE_FORM, &dimensions, &cutter), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_cutter_create_shape((swarf_shape)99, &dimensions, &cutter), SWARF_ERROR_ARGUMENT, "99");
    dimensions.size = 3;
    CHECK_FAILS(swarf_cutter_create_shape(SWARF_SHAPE_FLAT, &dimensions, &cutter), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_cutter_create_shape(SWARF_SHAPE_FLAT, NULL, &cutter), SWARF_ERROR_ARGUMENT, NULL);
}

/* A side bulging ever less comes ever closer to the straight one, however far away the centres of its arcs are. */
static void check_slight_arcs(void)
{
    const double voxel = 0.5, chord = hypot(0.1, 15);
    const swarf_path path = {.start = {0, 0, 5}, .end = {0, 0, 0}, .has_motion = 1};
    for (int exponent = 3; exponent <= 16; exponent++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double bulge = sign * pow(10, -exponent);
            const swarf_profile_node nodes[] = {{0, 0, 0}, {5, 0, bulge}, {5.1, 15, 0}};
            const swarf_cutter_part part = {SWARF_PART_FLUTES, nodes, 3};
            swarf_cutter *cutter = NULL;
            if (!CHECK_OK(swarf_cutter_create(&part, 1, &cutter))) continue;
            const double lowest = 7, r = 5 + 0.1 * lowest / 15;
            const double points[] = {r + 0.05, 0, lowest, r, 0, lowest, 0, r - 0.05, lowest};
            float found[3];
            const double allowed = 0.5 * chord * fabs(bulge) + 2 * SWARF_SWEEP_BOUND * voxel;
            int good = CHECK_OK(swarf_sweep_distance(cutter, SWARF_PART_FLUTES, &path, voxel, points, 3, found));
            for (int i = 0; i < 3 && good; i++) good = CHECK_NEAR(found[i], 0.05 * (1 - i), allowed);
            if (!good) printf("    of bulge %g\n", bulge);
            swarf_cutter_release(cutter);
        }
}

int main(void)
{
    check_shapes();
    check_cases();
    check_parts();
    check_refused_text();
    check_refused_parts();
    check_slight_arcs();
    return test_end();
}
