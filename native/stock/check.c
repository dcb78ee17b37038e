/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Playing a program with an eye on it. The stock only shrinks: what a batch of moves does not touch as the stock is
 * before the batch, none of its moves touches later. So each test asks once for a whole batch, and only where it
 * answers yes the batch is halved, down to the move; then what comes before this move is cut, and it is asked again.
 * What is cut together is as large as that allows: small batches make walls that the next one cuts away. Fixtures and
 * design are stocks of their own that are never cut. */
#include "swarf/check.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/check_tool.h"
#include "stock/cut.h"
#include "stock/load.h"
#include "stock/measure.h"
#include "stock/mesh.h"
#include "stock/simulate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Voxels of depth from which on a contact counts: against the stock, which is made of the same distances, and against
 * triangles, beside whose concave edges the distance to a tool runs short by up to 0.3. */
static const double stock_depth = 0.06, solid_depth = 0.35;

/* mm; holders with more around them would be none that the cutter room makes. */
static const double most_clearance = 1000;

/* The first instant is bisected to this share of a voxel. */
static const double instant = 0.02;

/* Findings of one kind in one operation, and fixtures. */
enum { MOST_FINDINGS = 20, MOST_TARGETS = 64 };

struct swarf_check {
    swarf_check_finding *findings;
    size_t count, room;
    swarf_simulation *simulation;
    swarf_loads *loads; /* NULL: not asked for */
};

/* What the moves of a batch are tested for. */
struct test {
    swarf_check_kind kind;
    swarf_part_kind part;
    const swarf_body *body;
    swarf_stock *target;
    const swarf_box *reach; /* of the target */
    double depth;           /* mm from which on it counts */
    double first;           /* mm from which on its first instant counts, once it does */
    int feeds;              /* 0: only rapids are tested */
};

enum { MOST_TESTS = 6 + 4 * MOST_TARGETS };

struct player {
    swarf_stock *stock;
    swarf_stock *targets[MOST_TARGETS];     /* the fixtures, then the design if there is one */
    swarf_box reach, reaches[MOST_TARGETS]; /* no material of stock and targets beyond; the stock only shrinks */
    size_t target_count;
    const swarf_program *program;
    const swarf_tool *tools;
    size_t tool_count;
    swarf_check_tool *prepared; /* per tool */
    const swarf_check_options *options;
    const swarf_progress *progress;
    swarf_check *result;
    size_t first, count;
    swarf_path *paths;
    size_t path_room;
    swarf_path *near; /* those of them that may touch */
    size_t near_room;
    size_t *numbers; /* of the moves whose paths these are */
    size_t number_room;
    int32_t operation, tool; /* of the batch */
    size_t batch_first, batch_count;
    size_t uncut;                 /* its first move that is not cut */
    double from, to;              /* its part of the progress */
    int found[SWARF_CHECK_COUNT]; /* in this operation */
    int stopped;
    int known; /* 1 once a move of this tool has been seen */
};

static const char *const names[SWARF_CHECK_COUNT] = {"rapid",  "start",   "shank",  "holder",  "depth",
                                                     "near",   "fixture", "design", "spindle", "feed",
                                                     "plunge", "travel",  "tool"};

const char *swarf_check_name(swarf_check_kind kind)
{
    return (unsigned)kind < SWARF_CHECK_COUNT ? names[kind] : "";
}

swarf_check_options swarf_check_options_default(void)
{
    return (swarf_check_options){.size = sizeof(swarf_check_options),
                                 .design_mm = 0.05,
                                 .travel = {{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}}};
}

void swarf_check_destroy(swarf_check *check)
{
    if (!check) return;
    swarf_simulation_destroy(check->simulation);
    swarf_loads_destroy(check->loads);
    free(check->findings);
    free(check);
}

const swarf_simulation *swarf_check_simulation(const swarf_check *check)
{
    return check ? check->simulation : NULL;
}

const swarf_loads *swarf_check_loads(const swarf_check *check)
{
    return check ? check->loads : NULL;
}

const swarf_check_finding *swarf_check_findings(const swarf_check *check, size_t *count)
{
    *count = check ? check->count : 0;
    return check ? check->findings : NULL;
}

/* ---- tools ---- */

static swarf_status find_tool(struct player *p, int32_t number, swarf_check_tool **out)
{
    *out = NULL;
    for (size_t i = 0; i < p->tool_count; i++) {
        if (p->tools[i].number != number || !p->tools[i].cutter) continue;
        if (!p->prepared[i].ready)
            SWARF_TRY(swarf_check_tool_prepare(&p->tools[i], swarf_stock_voxel(p->stock), p->options->clearance_mm,
                                               &p->prepared[i]));
        *out = &p->prepared[i];
        return SWARF_OK;
    }
    return SWARF_OK;
}

/* ---- findings ---- */

static swarf_status report(struct player *p, size_t move, swarf_check_finding finding)
{
    if (p->stopped || p->found[finding.kind]++ >= MOST_FINDINGS) return SWARF_OK;
    const swarf_move *m = &swarf_program_moves(p->program)[move];
    const swarf_section *section = &swarf_program_sections(p->program)[swarf_move_get_section(m)];
    swarf_check *result = p->result;
    SWARF_TRY(
        swarf_array_reserve((void **)&result->findings, &result->room, result->count + 1, sizeof *result->findings));
    finding.move = move;
    finding.line = m->line;
    finding.tool = section->tool;
    finding.operation = section->operation;
    result->findings[result->count++] = finding;
    if (p->options->stop_on_first && finding.severity == SWARF_ERROR) p->stopped = 1;
    return SWARF_OK;
}

/* Earliest t at which a move touches as its test says. The part of the path up to t touches from there on. */
static swarf_status first_contact(const struct test *test, const swarf_path *path, double voxel, double *t)
{
    double lo = 0, hi = 1, depth, point[3];
    const double length = swarf_path_length(path), step = length > 0 ? instant * voxel / length : 1;
    swarf_path part;
    swarf_path_part(path, 0, &part);
    SWARF_TRY(swarf_cut_touch(test->target, test->body, &part, 1, test->first, &depth, point));
    if (depth > test->first) hi = 0;
    while (hi - lo > step) {
        const double middle = 0.5 * (lo + hi);
        swarf_path_part(path, middle, &part);
        SWARF_TRY(swarf_cut_touch(test->target, test->body, &part, 1, test->first, &depth, point));
        if (depth > test->first)
            hi = middle;
        else
            lo = middle;
    }
    *t = hi;
    return SWARF_OK;
}

static const char *part_name(swarf_part_kind part)
{
    return part == SWARF_PART_FLUTES ? "flutes" : part == SWARF_PART_SHANK ? "shank" : "holder";
}

static void describe(const struct player *p, const struct test *test, swarf_check_finding *f)
{
    const char *what = part_name(test->part);
    const size_t size = sizeof f->text;
    switch (f->kind) {
    case SWARF_CHECK_RAPID: snprintf(f->text, size, "rapid through material, %.3g mm deep", f->depth_mm); break;
    case SWARF_CHECK_START: snprintf(f->text, size, "the tool starts inside the stock"); break;
    case SWARF_CHECK_DEPTH: snprintf(f->text, size, "cuts deeper than the flutes are long"); break;
    case SWARF_CHECK_NEAR:
        snprintf(f->text, size, "holder closer to the stock than %g mm", p->options->clearance_mm);
        break;
    case SWARF_CHECK_FIXTURE:
        snprintf(f->text, size, "%s %s a fixture, %.3g mm deep", what, test->part == SWARF_PART_FLUTES ? "hit" : "hits",
                 f->depth_mm);
        break;
    case SWARF_CHECK_DESIGN:
        snprintf(f->text, size,
                 test->part == SWARF_PART_FLUTES ? "%s cut into the design, %.3g mm deep"
                                                 : "%s hits the design, %.3g mm deep",
                 what, f->depth_mm);
        break;
    default: snprintf(f->text, size, "%s hits the stock, %.3g mm deep", what, f->depth_mm);
    }
}

static swarf_status report_contact(struct player *p, const struct test *test, size_t move, const swarf_path *path)
{
    swarf_check_finding f = {.severity = SWARF_ERROR, .kind = (int32_t)test->kind, .part = (int32_t)test->part};
    SWARF_TRY(swarf_cut_touch(test->target, test->body, path, 1, INFINITY, &f.depth_mm, f.point));
    if (!(f.depth_mm > test->depth)) return SWARF_OK;
    SWARF_TRY(first_contact(test, path, swarf_stock_voxel(p->stock), &f.t));
    swarf_path_point(path, f.t, f.tip);
    if (f.kind == SWARF_CHECK_NEAR) {
        if (p->result->count && p->result->findings[p->result->count - 1].move == move &&
            p->result->findings[p->result->count - 1].kind == SWARF_CHECK_HOLDER)
            return SWARF_OK; /* it does more than that */
        f.severity = SWARF_WARNING;
    }
    if (f.kind == SWARF_CHECK_RAPID && f.t == 0 && !p->known) f.kind = SWARF_CHECK_START;
    describe(p, test, &f);
    return report(p, move, f);
}

/* ---- what the words of a move tell by themselves ---- */

static swarf_status check_words(struct player *p, size_t move, const swarf_path *path, const swarf_check_tool *tool)
{
    const swarf_move *m = &swarf_program_moves(p->program)[move];
    const swarf_section *section = &swarf_program_sections(p->program)[swarf_move_get_section(m)];
    swarf_check_finding f = {.severity = SWARF_ERROR};
    memcpy(f.tip, path->end, sizeof f.tip);
    for (int k = 0; k < 3; k++) {
        const swarf_box *travel = &p->options->travel;
        if (!(path->end[k] < travel->lo[k] || path->end[k] > travel->hi[k])) continue;
        f.kind = SWARF_CHECK_TRAVEL;
        f.t = 1;
        snprintf(f.text, sizeof f.text, "%c%.6g is beyond the travel of %.6g .. %.6g mm", "XYZ"[k], path -> end[k],
                 travel -> lo[k], travel -> hi[k]);
        SWARF_TRY(report(p, move, f));
    }
    f.t = 0;
    if (swarf_move_get_kind(m) != SWARF_MOVE_FEED) return SWARF_OK;
    if (!(m->feed_mm_min > 0)) {
        f.kind = SWARF_CHECK_FEED;
        snprintf(f.text, sizeof f.text, "a feed move without feed");
        SWARF_TRY(report(p, move, f));
    }
    if (section->spindle == SWARF_SPINDLE_CCW || section->spindle == SWARF_SPINDLE_OFF || !(section->spindle_rpm > 0)) {
        f.kind = SWARF_CHECK_SPINDLE;
        f.severity = section->spindle == SWARF_SPINDLE_CCW ? SWARF_WARNING : SWARF_ERROR;
        snprintf(f.text, sizeof f.text,
                 section->spindle == SWARF_SPINDLE_CCW ? "cuts with the spindle turning backwards (M4)"
                                                       : "cuts with the spindle stopped");
        SWARF_TRY(report(p, move, f));
    }
    const double down = path->start[2] - path->end[2];
    const double along = hypot(path->end[0] - path->start[0], path->end[1] - path->start[1]);
    for (size_t i = 0; tool && i < p->options->no_plunge_count && !path->is_arc; i++) {
        if (p->options->no_plunge[i] != section->tool || !(down > 0) || along > 0.02 * down) continue;
        double depth, point[3]; /* through air is no plunge */
        SWARF_TRY(
            swarf_cut_touch(p->stock, tool->flutes, path, 1, stock_depth * swarf_stock_voxel(p->stock), &depth, point));
        if (!(depth > stock_depth * swarf_stock_voxel(p->stock))) continue;
        f.kind = SWARF_CHECK_PLUNGE;
        f.severity = SWARF_ERROR;
        snprintf(f.text, sizeof f.text, "plunges %.3g mm with a tool that cannot", down);
        SWARF_TRY(report(p, move, f));
    }
    return SWARF_OK;
}

/* ---- playing ---- */

static size_t make_tests(const struct player *p, const swarf_check_tool *tool, struct test *tests)
{
    const double voxel = swarf_stock_voxel(p->stock), own = stock_depth * voxel, other = solid_depth * voxel;
    size_t count = 0;
    tests[count++] = (struct test){SWARF_CHECK_RAPID, SWARF_PART_FLUTES, tool->flutes, p->stock, &p->reach, .feeds = 0};
    tests[count++] = (struct test){SWARF_CHECK_SHANK, SWARF_PART_SHANK, tool->shank, p->stock, &p->reach, .feeds = 1};
    tests[count++] =
        (struct test){SWARF_CHECK_HOLDER, SWARF_PART_HOLDER, tool->holder, p->stock, &p->reach, .feeds = 1};
    tests[count++] =
        (struct test){SWARF_CHECK_NEAR, SWARF_PART_HOLDER, tool->wide_holder, p->stock, &p->reach, .feeds = 1};
    tests[count++] = (struct test){SWARF_CHECK_DEPTH, SWARF_PART_SHANK, tool->above, p->stock, &p->reach, .feeds = 1};
    for (size_t i = 0; i < count; i++) tests[i].depth = tests[i].first = own;
    for (size_t i = 0; i < p->target_count; i++) {
        const int is_design = i >= p->options->fixture_count;
        const swarf_body *const bodies[3] = {tool->flutes, tool->shank, tool->holder};
        static const swarf_part_kind parts[3] = {SWARF_PART_FLUTES, SWARF_PART_SHANK, SWARF_PART_HOLDER};
        for (int k = 0; k < 3; k++) {
            const double allowed = is_design && k == 0 ? p->options->design_mm : 0;
            tests[count++] = (struct test){is_design ? SWARF_CHECK_DESIGN : SWARF_CHECK_FIXTURE,
                                           parts[k],
                                           bodies[k],
                                           p->targets[i],
                                           &p->reaches[i],
                                           other + allowed,
                                           own + allowed,
                                           1};
        }
    }
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (tests[i].body && tests[i].body->component_count) tests[kept++] = tests[i];
    return kept;
}

/* Paths of the moves first .. end - 1 that move and can be simulated; without `feeds` those of rapids. */
static swarf_status take_paths(struct player *p, size_t first, size_t end, int feeds, size_t *count)
{
    const swarf_move *moves = swarf_program_moves(p->program);
    double from[6], to[6];
    SWARF_TRY(swarf_array_reserve((void **)&p->paths, &p->path_room, end - first, sizeof *p->paths));
    SWARF_TRY(swarf_array_reserve((void **)&p->numbers, &p->number_room, end - first, sizeof *p->numbers));
    *count = 0;
    for (size_t i = first; i < end; i++) {
        if (!feeds && swarf_move_get_kind(&moves[i]) != SWARF_MOVE_RAPID) continue;
        SWARF_TRY(swarf_program_path(p->program, i, &p->paths[*count]));
        if (!p->paths[*count].has_motion || swarf_program_move_axes(p->program, i, from, to)) continue;
        p->numbers[(*count)++] = i;
    }
    return SWARF_OK;
}

static void include_point(swarf_box *box, const double point[3], double radius)
{
    for (int k = 0; k < 3; k++) {
        box->lo[k] = fmin(box->lo[k], point[k] - radius);
        box->hi[k] = fmax(box->hi[k], point[k] + radius);
    }
}

/* A box around paths: of the tool's tip. */
static swarf_box paths_box(const swarf_path *paths, size_t count)
{
    swarf_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = 0; i < count; i++) {
        const swarf_path *path = &paths[i];
        double square = 0;
        include_point(&box, path->start, 0);
        include_point(&box, path->end, 0);
        for (int k = 0; k < 3 && path->is_arc; k++) {
            const double a = path->start[k] - path->arc.centre[k], b = path->end[k] - path->arc.centre[k];
            square += fmax(a * a, b * b);
        }
        if (path->is_arc) include_point(&box, path->arc.centre, sqrt(square));
    }
    return box;
}

/* Whether a body along paths in a box is clear of a target. */
static int is_clear(const struct test *test, const swarf_box *tips)
{
    const swarf_body *body = test->body;
    for (int k = 0; k < 3; k++) {
        const double below = k == 2 ? body->exact_lo : -body->exact_radius;
        const double above = k == 2 ? body->exact_hi : body->exact_radius;
        if (tips->lo[k] + below > test->reach->hi[k] || tips->hi[k] + above < test->reach->lo[k]) return 1;
    }
    return 0;
}

static double progress_at(const struct player *p, size_t move)
{
    return p->from + (p->to - p->from) * (double)(move - p->batch_first) / (double)p->batch_count;
}

/* Cut what was looked at but not cut yet, up to a move. */
static swarf_status cut_up_to(struct player *p, const swarf_check_tool *tool, size_t end)
{
    size_t count;
    const size_t first = p->uncut;
    if (p->stopped || first == end) return SWARF_OK;
    p->uncut = end;
    SWARF_TRY(take_paths(p, first, end, 1, &count));
    if (count == 0) return SWARF_OK;
    p->known = 1;
    const double from = progress_at(p, first), to = progress_at(p, end);
    if (!p->result->loads || !tool->flutes->component_count)
        return swarf_cut_body(p->stock, tool->flutes, p->paths, count, p->progress, from, to);
    const swarf_load_batch batch = {p->program, tool->cutter, tool->flutes, tool->teeth, p->first};
    return swarf_loads_cut(p->result->loads, p->stock, &batch, p->numbers, count, p->progress, from, to);
}

/* How deep the first `count` paths go, as swarf_cut_touch() tells; those that are clear by their boxes are left out. */
static swarf_status touch_near(struct player *p, const struct test *test, size_t count, double *depth, double point[3])
{
    size_t used = 0;
    SWARF_TRY(swarf_array_reserve((void **)&p->near, &p->near_room, count, sizeof *p->near));
    for (size_t i = 0; i < count; i++) {
        const swarf_box tips = paths_box(&p->paths[i], 1);
        if (!is_clear(test, &tips)) p->near[used++] = p->paths[i];
    }
    return swarf_cut_touch(test->target, test->body, p->near, used, test->depth, depth, point);
}

/* Those of the tests that moves first .. end - 1 answer with yes, on the stock as it is now. */
static swarf_status find_open(struct player *p, size_t first, size_t end, const struct test *tests, size_t test_count,
                              struct test *open, size_t *open_count)
{
    size_t count = 0;
    swarf_box tips = paths_box(NULL, 0);
    int taken = -1; /* whether the paths are those of feeds, too */
    *open_count = 0;
    for (size_t i = 0; i < test_count; i++) {
        double depth = 0, point[3];
        SWARF_TRY(swarf_progress_report(p->progress, progress_at(p, p->uncut)));
        if (p->found[tests[i].kind] >= MOST_FINDINGS) continue;
        if (tests[i].feeds != taken) {
            SWARF_TRY(take_paths(p, first, end, tests[i].feeds, &count));
            taken = tests[i].feeds;
            tips = paths_box(p->paths, count);
        }
        if (count && !is_clear(&tests[i], &tips)) SWARF_TRY(touch_near(p, &tests[i], count, &depth, point));
        if (depth > tests[i].depth) open[(*open_count)++] = tests[i];
    }
    return SWARF_OK;
}

/* Look at moves first .. end - 1, of which only these tests may answer yes. What is not cut yet is still in the way
 * then, which makes more moves doubtful but never fewer: only for one that remains in doubt it is cut. */
static swarf_status play_range(struct player *p, const swarf_check_tool *tool, size_t first, size_t end,
                               const struct test *tests, size_t test_count)
{
    size_t open_count = 0;
    struct test *open = malloc((test_count + 1) * sizeof *open);
    if (!open) return swarf_fail(SWARF_ERROR_MEMORY, "check: out of memory");
    swarf_status status = find_open(p, first, end, tests, test_count, open, &open_count);
    if (status == SWARF_OK && open_count && end - first > 1) {
        const size_t middle = first + (end - first) / 2;
        status = play_range(p, tool, first, middle, open, open_count);
        if (status == SWARF_OK && !p->stopped) status = play_range(p, tool, middle, end, open, open_count);
    } else if (status == SWARF_OK && open_count) {
        swarf_path path;
        status = cut_up_to(p, tool, first);
        if (status == SWARF_OK) status = swarf_program_path(p->program, first, &path);
        for (size_t i = 0; i < open_count && status == SWARF_OK; i++)
            status = report_contact(p, &open[i], first, &path);
    }
    free(open);
    return status;
}

static swarf_status play_batch(void *context, size_t first, size_t end, double from, double to, int *stop)
{
    struct player *p = context;
    const swarf_section *section =
        &swarf_program_sections(p->program)[swarf_move_get_section(&swarf_program_moves(p->program)[first])];
    swarf_check_tool *tool;
    p->from = from;
    p->to = to;
    p->batch_first = first;
    p->batch_count = end - first;
    p->uncut = first;
    if (first == p->first || section->operation != p->operation) memset(p->found, 0, sizeof p->found);
    if (section->tool != p->tool) p->known = 0;
    p->operation = section->operation;
    p->tool = section->tool;
    SWARF_TRY(find_tool(p, section->tool, &tool));
    int moving = 0;
    for (size_t i = first; i < end && !p->stopped; i++) {
        swarf_path path;
        SWARF_TRY(swarf_program_path(p->program, i, &path));
        if (!path.has_motion) continue;
        if (!moving++ && (!tool || !tool->flutes->component_count)) {
            swarf_check_finding f = {.severity = SWARF_ERROR, .kind = SWARF_CHECK_TOOL};
            if (!tool && section->tool < 0)
                snprintf(f.text, sizeof f.text, "moves before any tool is loaded");
            else
                snprintf(f.text, sizeof f.text, tool ? "tool T%d has no flutes" : "tool T%d is not in the tool table",
                         (int)section->tool);
            SWARF_TRY(report(p, i, f));
        }
        SWARF_TRY(check_words(p, i, &path, tool));
    }
    struct test tests[MOST_TESTS];
    swarf_status status = SWARF_OK;
    if (tool && moving && !p->stopped) status = play_range(p, tool, first, end, tests, make_tests(p, tool, tests));
    if (tool && moving && status == SWARF_OK) status = cut_up_to(p, tool, end);
    *stop = p->stopped;
    return status;
}

static int compare_findings(const void *left, const void *right)
{
    const swarf_check_finding *l = left, *r = right;
    if (l->move != r->move) return l->move < r->move ? -1 : 1;
    if (l->t != r->t) return l->t < r->t ? -1 : 1;
    return l->kind < r->kind ? -1 : l->kind > r->kind;
}

/* Fixtures and design on voxels of their own. */
static swarf_status make_targets(struct player *p)
{
    const swarf_check_options *o = p->options;
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = swarf_stock_voxel(p->stock);
    for (size_t i = 0; i < o->fixture_count + (o->design != NULL); i++) {
        const swarf_solid *solid = i < o->fixture_count ? o->fixtures[i] : o->design;
        SWARF_REQUIRE(solid, "check: fixture %zu is missing", i);
        SWARF_TRY(swarf_stock_create_solid(solid, &options, p->progress, 0, 0, &p->targets[i]));
        p->target_count++;
        SWARF_TRY(swarf_stock_enter_write(p->targets[i]));
        SWARF_TRY(swarf_measure_reach(p->targets[i], &p->reaches[i]));
    }
    return SWARF_OK;
}

static swarf_status run(struct player *p)
{
    p->prepared = calloc(p->tool_count + 1, sizeof *p->prepared);
    p->result = calloc(1, sizeof *p->result);
    if (!p->prepared || !p->result) return swarf_fail(SWARF_ERROR_MEMORY, "check: out of memory");
    SWARF_TRY(swarf_measure_reach(p->stock, &p->reach));
    SWARF_TRY(make_targets(p));
    if (p->options->loads) SWARF_TRY(swarf_loads_create(p->count, &p->result->loads));
    const swarf_watch watch = {play_batch, p};
    SWARF_TRY(swarf_simulate_watched(p->stock, p->program, p->first, p->count, p->tools, p->tool_count, NULL,
                                     p->progress, &watch, &p->result->simulation));
    if (p->result->count) qsort(p->result->findings, p->result->count, sizeof *p->result->findings, compare_findings);
    return SWARF_OK;
}

swarf_status swarf_stock_check(swarf_stock *stock, const swarf_program *program, size_t first, size_t count,
                               const swarf_tool *tools, size_t tool_count, const swarf_check_options *options,
                               const swarf_progress *progress, swarf_check **out)
{
    const swarf_check_options plain = swarf_check_options_default();
    if (!options) options = &plain;
    SWARF_REQUIRE(stock && program && out && (tools || tool_count == 0),
                  "check: stock, program, tools or output missing");
    SWARF_REQUIRE(options->size == sizeof *options, "check: options of another version");
    SWARF_REQUIRE(options->fixture_count < MOST_TARGETS, "check: %zu fixtures; %d are possible", options->fixture_count,
                  MOST_TARGETS - 1);
    SWARF_REQUIRE(options->fixtures || !options->fixture_count, "check: fixtures missing");
    SWARF_REQUIRE(options->no_plunge || !options->no_plunge_count, "check: tools that cannot plunge missing");
    SWARF_REQUIRE(options->clearance_mm >= 0 && options->clearance_mm <= most_clearance,
                  "check: a clearance of %g mm; 0 to %g are possible", options->clearance_mm, most_clearance);
    SWARF_REQUIRE(isfinite(options->design_mm) && options->design_mm >= 0, "check: %g mm into the design",
                  options->design_mm);
    const size_t total = swarf_program_move_count(program);
    SWARF_REQUIRE(first <= total && count <= total - first, "check: moves %zu .. %zu of %zu", first, first + count,
                  total);
    struct player p = {.stock = stock,
                       .program = program,
                       .tools = tools,
                       .tool_count = tool_count,
                       .options = options,
                       .progress = progress,
                       .first = first,
                       .count = count};
    SWARF_TRY(swarf_stock_enter_write(stock));
    const swarf_status status = run(&p);
    for (size_t i = 0; p.prepared && i < tool_count; i++) swarf_check_tool_free(&p.prepared[i]);
    for (size_t i = 0; i < MOST_TARGETS; i++) swarf_stock_destroy(p.targets[i]);
    free(p.prepared);
    free(p.paths);
    free(p.near);
    free(p.numbers);
    swarf_stock_leave(stock);
    if (status != SWARF_OK) {
        swarf_check_destroy(p.result);
        return status;
    }
    *out = p.result;
    return SWARF_OK;
}
