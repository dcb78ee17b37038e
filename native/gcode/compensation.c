/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cutter compensation: G41 and G42 keep the tool beside the programmed path by its radius.
 *
 * Each step's path is shifted towards the tool. Where the next step turns away from the tool (outer corner) an arc
 * about the corner joins the two, where it turns towards it (inner corner) both end where they meet. So a step can
 * be let out only when the next one is known: it waits as `pending`, and what has no motion in the plane meanwhile
 * (plunges, dwells) waits in `held`.
 *
 *     lead-in    a step longer than the radius, from where the tool stands to beside its programmed end
 *     G40        the last step ends beside its programmed end; the next move is straight and programmed as it is
 *
 * A corner of less than 0.05 rad is no corner (LinuxCNC's limit): the tool goes straight from one to the other.
 */
#include "gcode/machine.h"

#include "base/memory.h"
#include "base/status.h"

#include <math.h>
#include <string.h>

static const double straight_rad = 0.05;

/* The way back, to the same limit, whichever side it bends to: around the corner. */
static const double reverse_rad = 3.0915926;

/* Paths shorter than this are rounding of what is none. */
static const double nothing_mm = 1e-7;

static double dot(const double u[2], const double v[2])
{
    return u[0] * v[0] + u[1] * v[1];
}

static double cross(const double u[2], const double v[2])
{
    return u[0] * v[1] - u[1] * v[0];
}

static void plane_of(const swarf_machine *machine, int *a, int *b)
{
    int n;
    swarf_plane_axes(machine->modes.plane, a, b, &n);
}

/* ---- G40 to G42.1 ---- */

static swarf_status radius_of(swarf_machine *machine, swarf_block *block, const swarf_word *word, double *out)
{
    const int code = (int)word->value, dynamic = code == 411 || code == 421;
    const swarf_word *d = swarf_block_has(block, 'D') ? swarf_block_take(block, 'D') : NULL;
    if (dynamic) {
        if (!d) return swarf_gcode_fail(machine, word, "needs D, the diameter of the tool");
        if (swarf_block_has(block, 'L')) (void)swarf_block_take(block, 'L');
        SWARF_TRY(swarf_machine_length(machine, d, out));
        *out *= 0.5;
        return SWARF_OK;
    }
    int number = machine->section.tool < 0 ? 0 : machine->section.tool;
    if (d) SWARF_TRY(swarf_machine_whole(machine, d, 0, 99999, &number));
    if (number == 0) number = machine->section.tool < 0 ? 0 : machine->section.tool;
    const swarf_gcode_tool *tool = swarf_machine_find_tool(machine, number);
    *out = 0.0;
    if (tool && tool->diameter_mm != 0.0) {
        *out = 0.5 * tool->diameter_mm;
        return SWARF_OK;
    }
    for (size_t i = 0; i < machine->diameter_count; i++)
        if (machine->diameters[i].number == number) {
            *out = 0.5 * machine->diameters[i].mm;
            return SWARF_OK;
        }
    if (tool || number == 0) return SWARF_OK;
    return swarf_gcode_fail(machine, d ? d : word, "needs the diameter of tool T%d; give the tool or a tool table",
                            number);
}

swarf_status swarf_machine_radius(swarf_machine *machine, swarf_block *block)
{
    const swarf_word *word = swarf_block_group(block, SWARF_GROUP_RADIUS);
    if (!word) return SWARF_OK;
    swarf_compensation *comp = &machine->comp;
    if (word->value == 400.0) {
        if (!comp->side) return SWARF_OK;
        SWARF_TRY(swarf_compensation_flush(machine, word));
        if (comp->entered) { /* from here on the place counts where the tool is */
            int a, b;
            plane_of(machine, &a, &b);
            machine->position[a] = comp->at[0];
            machine->position[b] = comp->at[1];
        }
        comp->leaving = comp->entered;
        comp->side = 0;
        return SWARF_OK;
    }
    if (comp->side) return swarf_gcode_fail(machine, word, "turns compensation on while it is on; write G40 first");
    if (machine->modes.plane == SWARF_PLANE_YZ)
        return swarf_gcode_fail(machine, word, "does not work in the plane YZ; G17 or G18");
    double radius = 0.0;
    SWARF_TRY(radius_of(machine, block, word, &radius));
    SWARF_TRY(swarf_machine_prepare(machine, word, machine->place.line));
    const int side = word->value < 415.0 ? 1 : -1;
    comp->side = radius < 0.0 ? -side : side;
    comp->radius = fabs(radius);
    comp->code = (int)word->value;
    comp->entered = comp->has_pending = comp->leaving = 0;
    comp->held_count = 0;
    return SWARF_OK;
}

/* ---- letting out ---- */

/* The pending step ends at `end`; then what was held. */
static swarf_status let_out(swarf_machine *machine, const swarf_word *word, const double end[2])
{
    swarf_compensation *comp = &machine->comp;
    int a, b;
    plane_of(machine, &a, &b);
    if (comp->has_pending) {
        comp->pending.end[a] = end[0];
        comp->pending.end[b] = end[1];
        comp->at[0] = end[0];
        comp->at[1] = end[1];
        comp->has_pending = 0;
        SWARF_TRY(swarf_machine_emit(machine, word, &comp->pending));
    }
    for (size_t i = 0; i < comp->held_count; i++) {
        comp->held[i].end[a] = comp->at[0];
        comp->held[i].end[b] = comp->at[1];
        SWARF_TRY(swarf_machine_emit(machine, word, &comp->held[i]));
    }
    comp->held_count = 0;
    return SWARF_OK;
}

static void beside(const swarf_compensation *comp, const double place[2], const double normal[2], double out[2])
{
    for (int k = 0; k < 2; k++) out[k] = place[k] + comp->radius * normal[k];
}

/* Whether a pending path still has its direction when it ends at `end`. */
static int goes_forward(const swarf_compensation *comp, const double end[2])
{
    const swarf_course *c = &comp->course;
    if (!c->is_arc) {
        const double way[2] = {end[0] - c->from[0], end[1] - c->from[1]};
        return dot(way, c->tangent_out) > -nothing_mm;
    }
    double untrimmed[2];
    beside(comp, c->end, c->normal_out, untrimmed);
    const double u[2] = {c->from[0] - c->centre[0], c->from[1] - c->centre[1]};
    const double v[2] = {end[0] - c->centre[0], end[1] - c->centre[1]};
    const double w[2] = {untrimmed[0] - c->centre[0], untrimmed[1] - c->centre[1]};
    const double turn = c->ccw ? 1.0 : -1.0, full = 6.283185307179586;
    double to_end = turn * atan2(cross(u, v), dot(u, v)), to_untrimmed = turn * atan2(cross(u, w), dot(u, w));
    if (to_untrimmed < 1e-9) to_untrimmed += full;
    if (to_end < -1e-9) to_end += full;
    return to_end <= to_untrimmed + 1e-9;
}

static swarf_status fail_gouge(const swarf_machine *machine, const swarf_word *word)
{
    return swarf_gcode_fail(machine, word,
                            "makes an inner corner that the tool, %.6g mm in radius, cannot reach without gouging",
                            machine->comp.radius);
}

swarf_status swarf_compensation_flush(swarf_machine *machine, const swarf_word *word)
{
    swarf_compensation *comp = &machine->comp;
    if (!comp->has_pending) return let_out(machine, word, comp->at);
    double end[2];
    beside(comp, comp->course.end, comp->course.normal_out, end);
    if (!goes_forward(comp, end)) return fail_gouge(machine, word);
    return let_out(machine, word, end);
}

/* ---- corners ---- */

/* The tool's path of a course as a line (point, direction) or a circle (centre, radius). */
static double circle_radius(const swarf_compensation *comp, const swarf_course *c)
{
    double on[2];
    beside(comp, c->end, c->normal_out, on);
    return hypot(on[0] - c->centre[0], on[1] - c->centre[1]);
}

static int meet_lines(const double p[2], const double d[2], const double q[2], const double e[2], double out[2])
{
    const double w[2] = {q[0] - p[0], q[1] - p[1]}, denominator = cross(d, e);
    if (fabs(denominator) < 1e-12) return 0;
    const double t = cross(w, e) / denominator;
    for (int k = 0; k < 2; k++) out[k] = p[k] + t * d[k];
    return 1;
}

/* Of the two points of a line on a circle the one nearer to `near`. */
static int meet_line_circle(const double p[2], const double d[2], const double centre[2], double radius,
                            const double near[2], double out[2])
{
    const double w[2] = {p[0] - centre[0], p[1] - centre[1]}, along = dot(w, d), off = cross(d, w);
    const double square = radius * radius - off * off;
    if (square < 0.0) return 0;
    double best = INFINITY;
    for (int sign = -1; sign <= 1; sign += 2) {
        const double t = -along + sign * sqrt(square);
        const double at[2] = {p[0] + t * d[0], p[1] + t * d[1]};
        const double distance = hypot(at[0] - near[0], at[1] - near[1]);
        if (distance < best) best = distance, out[0] = at[0], out[1] = at[1];
    }
    return 1;
}

static int meet_circles(const double a[2], double ra, const double b[2], double rb, const double near[2], double out[2])
{
    const double w[2] = {b[0] - a[0], b[1] - a[1]}, distance = hypot(w[0], w[1]);
    if (distance < 1e-12) return 0;
    const double d[2] = {w[0] / distance, w[1] / distance};
    const double along = (distance * distance + ra * ra - rb * rb) / (2.0 * distance);
    /* the line through both points, seen from the first circle */
    const double p[2] = {a[0] + along * d[0], a[1] + along * d[1]}, across[2] = {-d[1], d[0]};
    return meet_line_circle(p, across, a, ra, near, out);
}

/* Where the tool's paths before and after a corner meet, nearest to the corner. */
static int meet(const swarf_compensation *comp, const swarf_course *next, double out[2])
{
    const swarf_course *last = &comp->course;
    double p[2], q[2];
    beside(comp, last->end, last->normal_out, p);
    beside(comp, last->end, next->normal_in, q);
    if (!last->is_arc && !next->is_arc) return meet_lines(p, last->tangent_out, q, next->tangent_in, out);
    const double radius = hypot(q[0] - next->centre[0], q[1] - next->centre[1]);
    if (!last->is_arc) return meet_line_circle(p, last->tangent_out, next->centre, radius, last->end, out);
    if (!next->is_arc)
        return meet_line_circle(q, next->tangent_in, last->centre, circle_radius(comp, last), last->end, out);
    return meet_circles(last->centre, circle_radius(comp, last), next->centre, radius, last->end, out);
}

/* Let the pending step out as the next course wants it; next->from is then where that one begins. */
static swarf_status join(swarf_machine *machine, const swarf_word *word, swarf_course *next, const swarf_step *step)
{
    swarf_compensation *comp = &machine->comp;
    const swarf_course *last = &comp->course;
    const double corner[2] = {last->end[0], last->end[1]};
    double end[2];
    const double turn = atan2(cross(last->tangent_out, next->tangent_in), dot(last->tangent_out, next->tangent_in));
    const int towards = comp->side * turn > 0.0;
    if (fabs(turn) < straight_rad || !towards || fabs(turn) > reverse_rad) {
        beside(comp, corner, last->normal_out, end);
        if (!goes_forward(comp, end)) return fail_gouge(machine, word);
        SWARF_TRY(let_out(machine, word, end));
        memcpy(next->from, end, sizeof end);
        if (fabs(turn) < straight_rad && !next->is_arc) return SWARF_OK;
        beside(comp, corner, next->normal_in, next->from);
        if (hypot(next->from[0] - end[0], next->from[1] - end[1]) <= nothing_mm) {
            memcpy(next->from, end, sizeof end);
            return SWARF_OK;
        }
        swarf_step arc = *step;
        int a, b;
        plane_of(machine, &a, &b);
        memcpy(arc.end, machine->position, sizeof arc.end);
        memcpy(arc.centre, machine->position, sizeof arc.centre);
        arc.end[a] = next->from[0];
        arc.end[b] = next->from[1];
        arc.centre[a] = corner[0];
        arc.centre[b] = corner[1];
        arc.kind = SWARF_MOVE_FEED;
        if (!(arc.value > 0.0)) arc.value = machine->modes.feed;
        arc.is_arc = 1;
        arc.turns = 1;
        arc.ccw = fabs(turn) < straight_rad ? turn > 0.0 : comp->side < 0;
        comp->at[0] = next->from[0];
        comp->at[1] = next->from[1];
        return swarf_machine_emit(machine, word, &arc);
    }
    if (!meet(comp, next, end) || !goes_forward(comp, end)) return fail_gouge(machine, word);
    memcpy(next->from, end, sizeof end);
    return let_out(machine, word, end);
}

/* ---- steps ---- */

static void normals_of(swarf_course *c, int side)
{
    c->normal_in[0] = -side * c->tangent_in[1];
    c->normal_in[1] = side * c->tangent_in[0];
    c->normal_out[0] = -side * c->tangent_out[1];
    c->normal_out[1] = side * c->tangent_out[0];
}

static swarf_status make_course(const swarf_machine *machine, const swarf_word *word, const swarf_step *step,
                                const double start[2], swarf_course *out)
{
    const swarf_compensation *comp = &machine->comp;
    int a, b;
    plane_of(machine, &a, &b);
    memset(out, 0, sizeof *out);
    out->is_arc = step->is_arc;
    out->ccw = step->ccw;
    out->end[0] = step->end[a];
    out->end[1] = step->end[b];
    if (!step->is_arc) {
        const double d[2] = {out->end[0] - start[0], out->end[1] - start[1]}, length = hypot(d[0], d[1]);
        for (int k = 0; k < 2; k++) out->tangent_in[k] = out->tangent_out[k] = d[k] / length;
        normals_of(out, comp->side);
        return SWARF_OK;
    }
    out->centre[0] = step->centre[a];
    out->centre[1] = step->centre[b];
    const double u[2] = {start[0] - out->centre[0], start[1] - out->centre[1]};
    const double v[2] = {out->end[0] - out->centre[0], out->end[1] - out->centre[1]};
    const double ru = hypot(u[0], u[1]), rv = hypot(v[0], v[1]), turn = step->ccw ? 1.0 : -1.0;
    if (comp->side == (step->ccw ? 1 : -1) && fmin(ru, rv) <= comp->radius + nothing_mm)
        return swarf_gcode_fail(machine, word, "is an arc of radius %.6g mm; the tool, %.6g mm in radius, does not fit",
                                fmin(ru, rv), comp->radius);
    out->tangent_in[0] = -turn * u[1] / ru;
    out->tangent_in[1] = turn * u[0] / ru;
    out->tangent_out[0] = -turn * v[1] / rv;
    out->tangent_out[1] = turn * v[0] / rv;
    normals_of(out, comp->side);
    return SWARF_OK;
}

/* The lead-in: from where the tool stands to beside the end. An arc keeps its direction there: its centre moves. */
static swarf_status lead_in(swarf_machine *machine, const swarf_word *word, swarf_step *step, swarf_course *course,
                            const double start[2])
{
    swarf_compensation *comp = &machine->comp;
    const double length = hypot(course->end[0] - start[0], course->end[1] - start[1]);
    if (!(length > comp->radius))
        return swarf_gcode_fail(machine, word,
                                "leads in over %.6g mm; it must be longer than the radius of the tool, %.6g mm", length,
                                comp->radius);
    memcpy(course->from, start, sizeof course->from);
    comp->at[0] = start[0];
    comp->at[1] = start[1];
    if (!step->is_arc) return SWARF_OK;
    double end[2];
    beside(comp, course->end, course->normal_out, end);
    const double inward = course->ccw ? 1.0 : -1.0;
    const double n[2] = {-inward * course->tangent_out[1], inward * course->tangent_out[0]};
    const double q[2] = {end[0] - start[0], end[1] - start[1]}, side = dot(q, n);
    if (!(side < -nothing_mm)) return fail_gouge(machine, word);
    const double radius = -dot(q, q) / (2.0 * side);
    int a, b;
    plane_of(machine, &a, &b);
    for (int k = 0; k < 2; k++) course->centre[k] = end[k] + radius * n[k];
    step->centre[a] = course->centre[0];
    step->centre[b] = course->centre[1];
    return SWARF_OK;
}

static swarf_status hold(swarf_compensation *comp, const swarf_step *step)
{
    if (comp->held_count >= 100000) return swarf_fail(SWARF_ERROR_MEMORY, "too many moves beside a compensated path");
    SWARF_TRY(swarf_array_reserve((void **)&comp->held, &comp->held_room, comp->held_count + 1, sizeof *comp->held));
    comp->held[comp->held_count++] = *step;
    return SWARF_OK;
}

swarf_status swarf_compensation_add(swarf_machine *machine, const swarf_word *word, const swarf_step *step)
{
    swarf_compensation *comp = &machine->comp;
    int a, b;
    plane_of(machine, &a, &b);
    const double start[2] = {machine->position[a], machine->position[b]};
    const int still = step->kind == SWARF_MOVE_DWELL ||
                      (!step->is_arc && !(hypot(step->end[a] - start[0], step->end[b] - start[1]) > nothing_mm));
    if (isnan(step->end[a]) || isnan(step->end[b]) || isnan(start[0]) || isnan(start[1]))
        return swarf_gcode_fail(machine, word, "is compensated from or to an unknown place; command %c and %c first",
                                "XYZ"[a], "XYZ"[b]);
    if (still && !comp->entered) return swarf_machine_emit(machine, word, step);
    if (still) return hold(comp, step);
    swarf_step next = *step;
    swarf_course course;
    SWARF_TRY(make_course(machine, word, step, start, &course));
    if (!comp->entered) {
        SWARF_TRY(lead_in(machine, word, &next, &course, start));
        comp->entered = 1;
    } else {
        SWARF_TRY(join(machine, word, &course, step));
    }
    comp->course = course;
    comp->pending = next;
    comp->has_pending = 1;
    return SWARF_OK;
}
