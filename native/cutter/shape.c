/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The common shapes as meridians. */
#include "cutter/shape.h"
#include "base/status.h"
#include "cutter/cutter.h"

#include <math.h>
#include <stddef.h>

/* A meridian under construction; the thread mill is the longest: three nodes a tooth. */
enum { MOST_TEETH = 64, MOST_NODES = 3 * MOST_TEETH + 8 };
typedef struct outline {
    swarf_profile_node nodes[MOST_NODES];
    size_t count;
} outline;

static void to(outline *o, double r, double z)
{
    o->nodes[o->count++] = (swarf_profile_node){r, z, 0};
}

/* The same, and an arc of `angle` (positive: counter-clockwise) leads on to the next node. */
static void to_arc(outline *o, double r, double z, double angle)
{
    o->nodes[o->count++] = (swarf_profile_node){r, z, tan(0.25 * angle)};
}

static const double right_angle = 0.5 * M_PI;

swarf_dimensions swarf_dimensions_default(void)
{
    swarf_dimensions d = {.size = sizeof d};
    for (size_t i = 0; i < swarf_dimension_count; i++) *(double *)((char *)&d + swarf_dimension_table[i].offset) = NAN;
    return d;
}

#define LETTER(letters, member, words)                                                                                 \
    {                                                                                                                  \
        letters, offsetof(swarf_dimensions, member), words                                                             \
    }
const swarf_dimension swarf_dimension_table[] = {
    LETTER("d", diameter, "diameter"),
    LETTER("l", length, "length"),
    LETTER("r", corner_radius, "corner radius"),
    LETTER("t", tip_diameter, "tip diameter"),
    LETTER("a", angle_deg, "angle in degrees"),
    LETTER("n", neck_diameter, "neck diameter"),
    LETTER("h", edge_height, "height of the cutting edge"),
    LETTER("p", pitch, "pitch"),
    LETTER("k", teeth, "number of teeth"),
    LETTER("sd", shank_diameter, "shank diameter"),
    LETTER("sl", shank_length, "shank length"),
    LETTER("hd", holder_diameter, "holder diameter"),
    LETTER("hl", holder_length, "holder length"),
};
const size_t swarf_dimension_count = sizeof swarf_dimension_table / sizeof *swarf_dimension_table;

const swarf_shape_entry swarf_shape_table[SWARF_SHAPE_COUNT] = {
    [SWARF_SHAPE_FLAT] = {"flat", "d l", "d l"},
    [SWARF_SHAPE_BALL] = {"ball", "d l", "d l"},
    [SWARF_SHAPE_BULL] = {"bull", "d l r", "d l r"},
    [SWARF_SHAPE_CHAMFER] = {"chamfer", "d l a", "d l a t"},
    [SWARF_SHAPE_DRILL] = {"drill", "d l", "d l a"},
    [SWARF_SHAPE_TAPERED_BALL] = {"taperedball", "t a l", "t a l d"},
    [SWARF_SHAPE_LOLLIPOP] = {"lollipop", "d n l", "d n l"},
    [SWARF_SHAPE_TSLOT] = {"tslot", "d n h l", "d n h l r"},
    [SWARF_SHAPE_DOVETAIL] = {"dovetail", "d a h n l", "d a h n l"},
    [SWARF_SHAPE_THREAD_MILL] = {"threadmill", "d p n l", "d p k n l a"},
    [SWARF_SHAPE_FORM] = {"form", "", ""},
};

/* Is the letter one of those in a list separated by blanks? */
static int listed(const char *list, const char *letter)
{
    while (*list) {
        const char *l = letter;
        while (*l && *list == *l) {
            list++;
            l++;
        }
        if (!*l && (*list == ' ' || !*list)) return 1;
        while (*list && *list != ' ') list++;
        while (*list == ' ') list++;
    }
    return 0;
}

static swarf_status check_dimensions(swarf_shape shape, const swarf_dimensions *d)
{
    const swarf_shape_entry *entry = &swarf_shape_table[shape];
    for (size_t i = 0; i < swarf_dimension_count; i++) {
        const swarf_dimension *dimension = &swarf_dimension_table[i];
        const double value = *(const double *)((const char *)d + dimension->offset);
        const int above = dimension->letters[1] != 0; /* shank and holder go with every shape */
        if (isnan(value)) {
            SWARF_REQUIRE(above || !listed(entry->needed, dimension->letters), "cutter: %s needs %s (%s)", entry->name,
                          dimension->letters, dimension->words);
            continue;
        }
        SWARF_REQUIRE(above || listed(entry->known, dimension->letters), "cutter: %s has no %s (%s); it takes %s",
                      entry->name, dimension->letters, dimension->words, entry->known);
        const int may_be_zero = dimension->letters[0] == 't' || dimension->letters[0] == 'r';
        SWARF_REQUIRE(value <= SWARF_CUTTER_LIMIT_MM && (value > 0 || (value == 0 && may_be_zero)),
                      "cutter: %s (%s) of %s is %g; it must be a positive number up to %g", dimension->letters,
                      dimension->words, entry->name, value, SWARF_CUTTER_LIMIT_MM);
    }
    SWARF_REQUIRE(isnan(d->shank_diameter) == isnan(d->shank_length), "cutter: a shank needs both sd and sl");
    SWARF_REQUIRE(isnan(d->holder_diameter) == isnan(d->holder_length), "cutter: a holder needs both hd and hl");
    return SWARF_OK;
}

/* Cone below a cylinder: drills, chamfer mills, V-bits. */
static swarf_status draw_point(const char *name, double radius, double tip, double angle_deg, double length, outline *o)
{
    SWARF_REQUIRE(angle_deg < 180, "cutter: the included angle a of %s is %g; it must be below 180 degrees", name,
                  angle_deg);
    SWARF_REQUIRE(tip <= radius, "cutter: the tip of %s is wider than its diameter", name);
    const double cone = (radius - tip) / tan(0.5 * angle_deg * M_PI / 180);
    SWARF_REQUIRE(length >= cone - 1e-9, "cutter: the length l of %s is %g; its point alone is %g long", name, length,
                  cone);
    to(o, 0, 0);
    to(o, tip, 0);
    to(o, radius, cone);
    to(o, radius, fmax(cone, length));
    return SWARF_OK;
}

static swarf_status draw_tapered_ball(const swarf_dimensions *d, outline *o)
{
    const double ball = 0.5 * d->tip_diameter, angle = d->angle_deg * M_PI / 180;
    SWARF_REQUIRE(d->angle_deg < 90, "cutter: the angle a of taperedball is %g; per side it must be below 90",
                  d->angle_deg);
    const double touch_r = ball * cos(angle), touch_z = ball * (1 - sin(angle));
    SWARF_REQUIRE(d->length > touch_z, "cutter: the length l of taperedball is %g; its ball alone is %g", d->length,
                  touch_z);
    to_arc(o, 0, 0, right_angle - angle);
    to(o, touch_r, touch_z);
    double end = touch_r + (d->length - touch_z) * tan(angle);
    if (!isnan(d->diameter)) {
        SWARF_REQUIRE(0.5 * d->diameter >= touch_r, "cutter: the diameter d of taperedball is below its ball's");
        if (0.5 * d->diameter < end) {
            end = 0.5 * d->diameter;
            to(o, end, touch_z + (end - touch_r) / tan(angle));
        }
    }
    to(o, end, d->length);
    return SWARF_OK;
}

static swarf_status draw_thread_mill(const swarf_dimensions *d, outline *o)
{
    const double core = 0.5 * d->neck_diameter, depth = 0.5 * d->diameter - core;
    const double angle_deg = isnan(d->angle_deg) ? 60 : d->angle_deg, teeth = isnan(d->teeth) ? 1 : d->teeth;
    SWARF_REQUIRE(teeth == floor(teeth) && teeth <= MOST_TEETH,
                  "cutter: k of threadmill is %g; it must be a whole number up to %d", teeth, MOST_TEETH);
    SWARF_REQUIRE(angle_deg < 180, "cutter: the flank angle a of threadmill must be below 180 degrees");
    SWARF_REQUIRE(depth > 0, "cutter: the neck n of threadmill is not below its diameter d");
    const double half = depth * tan(0.5 * angle_deg * M_PI / 180);
    SWARF_REQUIRE(2 * half <= d->pitch * (1 + 1e-9),
                  "cutter: the teeth of threadmill are %g wide, more than the pitch p = %g", 2 * half, d->pitch);
    SWARF_REQUIRE(d->length >= teeth * d->pitch * (1 - 1e-9), "cutter: the length l of threadmill is below k * p = %g",
                  teeth * d->pitch);
    to(o, 0, 0);
    to(o, core, 0);
    for (int tooth = 0; tooth < (int)teeth; tooth++) {
        const double middle = (tooth + 0.5) * d->pitch;
        to(o, core, middle - half);
        to(o, core + depth, middle);
        to(o, core, middle + half);
    }
    to(o, core, fmax(d->length, teeth * d->pitch));
    return SWARF_OK;
}

static swarf_status draw(swarf_shape shape, const swarf_dimensions *d, outline *o)
{
    const char *name = swarf_shape_table[shape].name;
    const double radius = 0.5 * d->diameter, neck = 0.5 * d->neck_diameter, length = d->length;
    const double corner = isnan(d->corner_radius) ? 0 : d->corner_radius, height = d->edge_height;
    switch (shape) {
    case SWARF_SHAPE_FLAT:
        to(o, 0, 0);
        to(o, radius, 0);
        to(o, radius, length);
        return SWARF_OK;
    case SWARF_SHAPE_BALL:
        SWARF_REQUIRE(length >= radius, "cutter: the length l of ball is %g, below its radius %g", length, radius);
        to_arc(o, 0, 0, right_angle);
        to(o, radius, radius);
        to(o, radius, length);
        return SWARF_OK;
    case SWARF_SHAPE_BULL:
        SWARF_REQUIRE(corner <= radius, "cutter: the corner radius r of bull is %g, above its radius %g", corner,
                      radius);
        SWARF_REQUIRE(length >= corner, "cutter: the length l of bull is %g, below its corner radius %g", length,
                      corner);
        to(o, 0, 0);
        to_arc(o, radius - corner, 0, right_angle);
        to(o, radius, corner);
        to(o, radius, length);
        return SWARF_OK;
    case SWARF_SHAPE_CHAMFER:
        return draw_point(name, radius, isnan(d->tip_diameter) ? 0 : 0.5 * d->tip_diameter, d->angle_deg, length, o);
    case SWARF_SHAPE_DRILL: return draw_point(name, radius, 0, isnan(d->angle_deg) ? 118 : d->angle_deg, length, o);
    case SWARF_SHAPE_TAPERED_BALL: return draw_tapered_ball(d, o);
    case SWARF_SHAPE_LOLLIPOP: {
        SWARF_REQUIRE(neck < radius, "cutter: the neck n of lollipop is not below its diameter d");
        const double top = radius + sqrt(radius * radius - neck * neck);
        SWARF_REQUIRE(length > top, "cutter: the length l of lollipop is %g; its ball alone is %g", length, top);
        to_arc(o, 0, 0, right_angle + acos(neck / radius));
        to(o, neck, top);
        to(o, neck, length);
        return SWARF_OK;
    }
    case SWARF_SHAPE_TSLOT:
        SWARF_REQUIRE(neck < radius, "cutter: the neck n of tslot is not below its diameter d");
        SWARF_REQUIRE(length > height, "cutter: the length l of tslot is not above its edge h");
        SWARF_REQUIRE(2 * corner <= height && corner <= radius - neck,
                      "cutter: the corner radius r of tslot does not fit");
        to(o, 0, 0);
        to_arc(o, radius - corner, 0, right_angle);
        to_arc(o, radius, corner, 0);
        to_arc(o, radius, height - corner, right_angle);
        to(o, radius - corner, height);
        to(o, neck, height);
        to(o, neck, length);
        return SWARF_OK;
    case SWARF_SHAPE_DOVETAIL: {
        SWARF_REQUIRE(d->angle_deg < 90, "cutter: the angle a of dovetail is %g; it must be below 90 degrees",
                      d->angle_deg);
        const double top = radius - height / tan(d->angle_deg * M_PI / 180);
        SWARF_REQUIRE(top >= neck, "cutter: the dovetail narrows to a radius of %g at h, below its neck's %g", top,
                      neck);
        SWARF_REQUIRE(length > height, "cutter: the length l of dovetail is not above its edge h");
        to(o, 0, 0);
        to(o, radius, 0);
        to(o, top, height);
        to(o, neck, height);
        to(o, neck, length);
        return SWARF_OK;
    }
    case SWARF_SHAPE_THREAD_MILL: return draw_thread_mill(d, o);
    default: return swarf_fail(SWARF_ERROR_ARGUMENT, "cutter: shape %d has no dimensions", (int)shape);
    }
}

swarf_status swarf_cutter_create_shape(swarf_shape shape, const swarf_dimensions *d, swarf_cutter **out)
{
    SWARF_REQUIRE(shape >= 0 && shape < SWARF_SHAPE_FORM, "cutter: shape %d is not a common one", (int)shape);
    SWARF_REQUIRE(d && d->size == sizeof *d && out, "cutter: dimensions missing or of another version");
    SWARF_TRY(check_dimensions(shape, d));
    outline flutes = {.count = 0};
    SWARF_TRY(draw(shape, d, &flutes));
    swarf_cutter_part parts[3] = {{SWARF_PART_FLUTES, flutes.nodes, flutes.count}};
    size_t count = 1;
    double top = flutes.nodes[flutes.count - 1].z;
    swarf_profile_node above[2][2];
    const double stack[2][2] = {{d->shank_diameter, d->shank_length}, {d->holder_diameter, d->holder_length}};
    for (int i = 0; i < 2; i++) {
        if (isnan(stack[i][0])) continue;
        above[i][0] = (swarf_profile_node){0.5 * stack[i][0], top, 0};
        top += stack[i][1];
        above[i][1] = (swarf_profile_node){0.5 * stack[i][0], top, 0};
        parts[count++] = (swarf_cutter_part){i ? SWARF_PART_HOLDER : SWARF_PART_SHANK, above[i], 2};
    }
    return swarf_cutter_create(parts, count, out);
}
