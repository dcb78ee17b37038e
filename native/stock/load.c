/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Moves become steps, one for each of their tracks. Steps are taken in groups: moments are laid along the group, each
 * is seen against the stock as it is before the group, less what the group's steps have cut until shortly before that
 * moment; then the group is cut at once and the volume it removes is shared out by what the moments saw. Groups and
 * moments depend on nothing but the moves, moments are worked on in parallel and gathered in order. */
#include "stock/load.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/block.h"
#include "stock/cut.h"
#include "stock/engage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Moments are this many voxels, or this share of the tool's radius, apart; the longer of both. */
static const double moment_voxels = 2, moment_share = 0.25;
/* What was cut less than this many voxels of way before a moment is not held against it: the walls it left lie so close
 * before the flutes that no depth of material is seen between. */
static const double behind_voxels = 1;
/* A group has no more steps than the second number, and ends at the first when it is long enough, or at so many
 * moments. More would make the looks at its own steps dear, fewer the cuts. */
enum { GROUP_STEPS = 32, MOST_STEPS = 512, GROUP_MOMENTS = 256, MOMENTS_AT_ONCE = 4 };
/* A step of so many moments is a group of its own: its volume needs not be shared out. */
enum { ALONE_MOMENTS = 8 };
static const double group_voxels = 8;

struct swarf_loads {
    float *values[SWARF_LOAD_COUNT];
    double *volume;
    double *side, *area; /* what moments saw, times the way they stand for; mm3 */
    size_t count;
};

static const char *const names[SWARF_LOAD_COUNT] = {"rate",  "peak_rate", "depth", "width",
                                                    "angle", "chip",      "climb", "at"};

const char *swarf_load_name(swarf_load_kind kind)
{
    return (unsigned)kind < SWARF_LOAD_COUNT ? names[kind] : "";
}

swarf_status swarf_loads_create(size_t count, swarf_loads **out)
{
    swarf_loads *loads = calloc(1, sizeof *loads);
    int ok = loads != NULL;
    if (ok) {
        loads->count = count;
        ok = (loads->volume = calloc(count + 1, sizeof *loads->volume)) != NULL &&
             (loads->side = calloc(count + 1, sizeof *loads->side)) != NULL &&
             (loads->area = calloc(count + 1, sizeof *loads->area)) != NULL;
        for (int k = 0; k < SWARF_LOAD_COUNT; k++)
            ok &= (loads->values[k] = calloc(count + 1, sizeof *loads->values[k])) != NULL;
    }
    if (!ok) {
        swarf_loads_destroy(loads);
        return swarf_fail(SWARF_ERROR_MEMORY, "load: out of memory for %zu moves", count);
    }
    *out = loads;
    return SWARF_OK;
}

void swarf_loads_destroy(swarf_loads *loads)
{
    if (!loads) return;
    for (int k = 0; k < SWARF_LOAD_COUNT; k++) free(loads->values[k]);
    free(loads->volume);
    free(loads->side);
    free(loads->area);
    free(loads);
}

const float *swarf_loads_get(const swarf_loads *loads, swarf_load_kind kind, size_t *count)
{
    const int known = loads && (unsigned)kind < SWARF_LOAD_COUNT;
    *count = known ? loads->count : 0;
    return known ? loads->values[kind] : NULL;
}

const double *swarf_loads_volume(const swarf_loads *loads, size_t *count)
{
    *count = loads ? loads->count : 0;
    return loads ? loads->volume : NULL;
}

/* Part of a move that is one track. */
struct step {
    size_t number, track;
    double t0, t1, length; /* mm */
    double begin;          /* mm of way since the group began */
};

struct moment {
    size_t first, last; /* steps of the group that it stands for */
    size_t at;          /* the one on which it is */
    double length;      /* mm of way that it stands for */
    double t, way;      /* on the move of that step; mm since the group began */
    double tip[3], along[3];
    swarf_engagement seen;
};

struct work {
    swarf_loads *loads;
    swarf_stock *stock;
    const swarf_load_batch *batch;
    swarf_meridian meridian;
    swarf_track_list list;
    struct step *steps;
    size_t step_count, step_room, first, end; /* of the group */
    struct moment *moments;
    size_t moment_count, moment_room;
    swarf_column *columns; /* per thread */
    int column_count;
    double voxel;
};

static swarf_status add_steps(struct work *w, size_t number)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(w->stock->tree);
    const size_t before = w->list.count;
    swarf_path path;
    SWARF_TRY(swarf_program_path(w->batch->program, number, &path));
    SWARF_TRY(swarf_track_append(&w->list, &path, layout->origin, layout->voxel));
    const size_t tracks = w->list.count - before;
    SWARF_TRY(swarf_array_reserve((void **)&w->steps, &w->step_room, w->step_count + tracks, sizeof *w->steps));
    for (size_t i = 0; i < tracks; i++)
        w->steps[w->step_count++] = (struct step){.number = number,
                                                  .track = before + i,
                                                  .t0 = (double)i / (double)tracks,
                                                  .t1 = (double)(i + 1) / (double)tracks,
                                                  .length = swarf_path_length(&path) / (double)tracks};
    return SWARF_OK;
}

/* ---- moments ---- */

/* The tool at t of a move; `ahead` mm farther along its direction. */
static swarf_status place_moment(const struct work *w, size_t number, double t, double ahead, struct moment *moment)
{
    swarf_path path;
    double a[3], b[3], length = 0;
    SWARF_TRY(swarf_program_path(w->batch->program, number, &path));
    const double h = path.is_arc ? fmin(1e-3, 0.01 / fmax(1, fabs(path.arc.angle_rad))) : 0.5;
    swarf_path_point(&path, path.is_arc ? t - h : 0, a);
    swarf_path_point(&path, path.is_arc ? t + h : 1, b);
    for (int k = 0; k < 3; k++) length += (b[k] - a[k]) * (b[k] - a[k]);
    length = sqrt(length);
    swarf_path_point(&path, t, moment->tip);
    for (int k = 0; k < 3; k++) {
        moment->along[k] = length > 0 ? (b[k] - a[k]) / length : 0;
        moment->tip[k] += ahead * moment->along[k];
    }
    moment->t = t;
    return SWARF_OK;
}

/* Whether the tool, standing there, is clear of all that the stock can be: nothing would be seen. */
static int is_away(const struct work *w, const double tip[3])
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(w->stock->tree);
    const swarf_body *body = w->batch->flutes;
    for (int k = 0; k < 3; k++) {
        const double low = k == 2 ? body->exact_lo : -body->exact_radius;
        const double high = k == 2 ? body->exact_hi : body->exact_radius;
        const double end = layout->origin[k] + layout->voxel * SWARF_NODE_DIM * layout->count[k];
        if (tip[k] + high < layout->origin[k] - layout->voxel || tip[k] + low > end + layout->voxel) return 1;
    }
    return 0;
}

/* A moment that stands for the steps first .. last, `way` mm after the group began, `ahead` mm farther along. */
static swarf_status add_moment(struct work *w, size_t first, size_t last, double length, double way, double ahead)
{
    struct moment moment = {.first = first, .last = last, .at = first, .length = length, .way = way};
    while (moment.at < last && w->steps[moment.at].begin + w->steps[moment.at].length < way) moment.at++;
    const struct step *step = &w->steps[moment.at];
    const double share = step->length > 0 ? fmin(1, (way - step->begin) / step->length) : 0;
    SWARF_TRY(swarf_array_reserve((void **)&w->moments, &w->moment_room, w->moment_count + 1, sizeof *w->moments));
    SWARF_TRY(place_moment(w, step->number, step->t0 + share * (step->t1 - step->t0), ahead, &moment));
    if (!is_away(w, moment.tip)) w->moments[w->moment_count++] = moment; /* moves may go on for a kilometre */
    return SWARF_OK;
}

/* The next group: its steps and moments, each in the middle of what it stands for. */
static swarf_status make_group(struct work *w)
{
    const double spacing =
        fmax(moment_voxels * w->voxel, moment_share * swarf_cutter_radius(w->batch->cutter, SWARF_PART_FLUTES));
    double way = 0, waiting = 0; /* mm of short steps that have no moment yet */
    size_t open = w->first;      /* the first of them */
    w->moment_count = 0;
    for (w->end = w->first; w->end < w->step_count; w->end++) {
        struct step *step = &w->steps[w->end];
        const size_t used = w->end - w->first;
        if (used >= MOST_STEPS || (used >= GROUP_STEPS && way >= group_voxels * w->voxel) ||
            w->moment_count >= GROUP_MOMENTS)
            break;
        const int alone = step->length >= ALONE_MOMENTS * spacing;
        if (alone && used) break;
        step->begin = way;
        way += step->length;
        waiting += step->length;
        if (waiting < spacing) continue;
        /* short steps go with the first moment of what follows them */
        const size_t count = step->length < spacing ? 1 : (size_t)floor(waiting / spacing);
        const double each = waiting / (double)count;
        for (size_t i = 0; i < count; i++) {
            const double middle = way - waiting + ((double)i + 0.5) * each;
            SWARF_TRY(add_moment(w, i == 0 ? open : w->end, w->end, each, middle, 0));
        }
        open = w->end + 1;
        waiting = 0;
        if (!alone) continue;
        w->end++;
        break;
    }
    if (waiting > 0) /* where that is too short to be seen against walls just cut, it is looked at a voxel ahead */
        SWARF_TRY(add_moment(w, open, w->end - 1, waiting, way - 0.5 * waiting,
                             fmax(0, behind_voxels * w->voxel - 0.5 * waiting)));
    return SWARF_OK;
}

/* Whether what a track has cut can be where the tool is. */
static int may_meet(const swarf_track *track, const swarf_body *body, const double tip[3])
{
    const double reach = 2 * (double)body->radius + SWARF_HALF_WIDTH;
    if (track->is_arc) {
        const double away = hypot(tip[0] - track->centre[0], tip[1] - track->centre[1]);
        return fabs(away - track->radius) < reach;
    }
    const double x = tip[0] - track->point[0], y = tip[1] - track->point[1];
    const double s = fmax(0, fmin(track->run, x * track->ux + y * track->uy));
    return hypot(x - s * track->ux, y - s * track->uy) < reach;
}

/* The tracks of the group up to a moment, less the last bit of the way. */
static swarf_status tracks_before(const struct work *w, const struct moment *moment, swarf_track_list *out)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(w->stock->tree);
    const double until = moment->way - behind_voxels * w->voxel;
    size_t whole = w->first;
    while (whole < moment->at && w->steps[whole].begin + w->steps[whole].length <= until) whole++;
    double tip[3];
    for (int k = 0; k < 3; k++) tip[k] = (moment->tip[k] - layout->origin[k]) / layout->voxel;
    out->count = 0;
    SWARF_TRY(swarf_array_reserve((void **)&out->tracks, &out->room, whole - w->first + 1, sizeof *out->tracks));
    for (size_t i = w->first; i < whole; i++) {
        const swarf_track *track = &w->list.tracks[w->steps[i].track];
        if (may_meet(track, w->batch->flutes, tip)) out->tracks[out->count++] = *track;
    }
    const struct step *step = &w->steps[whole];
    const int curved = w->list.tracks[step->track].is_arc;
    if (until <= step->begin || (whole == moment->at && !curved))
        return SWARF_OK; /* a straight step leaves its front */
    swarf_path path, part;
    SWARF_TRY(swarf_program_path(w->batch->program, step->number, &path));
    const double t = step->t0 + (step->t1 - step->t0) * fmin(1, (until - step->begin) / fmax(step->length, 1e-12));
    swarf_path_part(&path, t, &part);
    if (!curved) {
        part.is_arc = 0;
        swarf_path_point(&path, step->t0, part.start);
    }
    return swarf_track_append(out, &part, layout->origin, layout->voxel);
}

static swarf_status see_moments(void *context, size_t index)
{
    struct work *w = context;
    const int slot = swarf_parallel_slot();
    swarf_column own = {.room = 0};
    swarf_track_list before = {0};
    swarf_status status = SWARF_OK;
    for (size_t i = index * MOMENTS_AT_ONCE;
         i < (index + 1) * MOMENTS_AT_ONCE && i < w->moment_count && status == SWARF_OK; i++) {
        struct moment *moment = &w->moments[i];
        status = tracks_before(w, moment, &before);
        const swarf_material material = {w->stock, w->batch->flutes, before.tracks, before.count,
                                         /* the number of threads may have been raised since */
                                         slot < w->column_count ? &w->columns[slot] : &own};
        if (status == SWARF_OK)
            status = swarf_engage(&w->meridian, &material, moment->tip, moment->along, &moment->seen);
    }
    swarf_column_free(&own);
    free(before.tracks);
    return status;
}

/* ---- what becomes of the moves ---- */

static void raise(float *value, double to)
{
    if (to > *value) *value = (float)to;
}

static void note_moment(struct work *w, const struct moment *moment)
{
    const swarf_move *moves = swarf_program_moves(w->batch->program);
    const swarf_section *sections = swarf_program_sections(w->batch->program);
    const swarf_engagement *seen = &moment->seen;
    if (!(seen->area > 0)) return;
    for (size_t i = moment->first; i <= moment->last; i++) {
        const size_t number = w->steps[i].number, at = number - w->batch->origin;
        if (i > moment->first && w->steps[i - 1].number == number) continue;
        if (swarf_move_get_kind(&moves[number]) == SWARF_MOVE_RAPID) continue;
        const swarf_section *section = &sections[swarf_move_get_section(&moves[number])];
        const double feed = moves[number].feed_mm_min, turns = section->spindle_rpm * w->batch->teeth;
        float **values = w->loads->values;
        const double angle = seen->angle * 180 / M_PI;
        if (angle > values[SWARF_LOAD_ANGLE][at])
            values[SWARF_LOAD_AT][at] = number == w->steps[moment->at].number ? (float)moment->t : 0.5f;
        raise(&values[SWARF_LOAD_ANGLE][at], angle);
        raise(&values[SWARF_LOAD_DEPTH][at], seen->depth);
        raise(&values[SWARF_LOAD_WIDTH][at], seen->width);
        raise(&values[SWARF_LOAD_PEAK_RATE][at], seen->area * feed / 60);
        if (turns > 0) raise(&values[SWARF_LOAD_CHIP][at], seen->chip * feed / turns);
    }
}

/* Way of a step that a moment stands for. */
static double share_of(const struct work *w, const struct moment *moment, size_t step)
{
    double others = 0;
    if (step < moment->last) return w->steps[step].length;
    for (size_t i = moment->first; i < moment->last; i++) others += w->steps[i].length;
    return moment->length - others;
}

/* The volume of the group to its moves, by what their moments saw, or by their lengths. */
static void share_volume(struct work *w, double volume)
{
    double *shares = w->loads->volume, seen = 0, length = 0;
    for (size_t i = 0; i < w->moment_count; i++) seen += w->moments[i].seen.area * w->moments[i].length;
    for (size_t i = w->first; i < w->end; i++) length += w->steps[i].length;
    for (size_t i = 0; i < w->moment_count && seen > 0; i++) {
        const struct moment *moment = &w->moments[i];
        for (size_t k = moment->first; k <= moment->last; k++)
            shares[w->steps[k].number - w->batch->origin] += volume * moment->seen.area * share_of(w, moment, k) / seen;
    }
    for (size_t i = w->first; i < w->end && !(seen > 0); i++)
        shares[w->steps[i].number - w->batch->origin] +=
            length > 0 ? volume * w->steps[i].length / length : volume / (double)(w->end - w->first);
}

static void note_sides(struct work *w)
{
    const swarf_move *moves = swarf_program_moves(w->batch->program);
    for (size_t i = 0; i < w->moment_count; i++) {
        const struct moment *moment = &w->moments[i];
        for (size_t k = moment->first; k <= moment->last; k++) {
            const size_t at = w->steps[k].number - w->batch->origin;
            const double share = share_of(w, moment, k);
            if (swarf_move_get_kind(&moves[w->steps[k].number]) == SWARF_MOVE_RAPID) continue;
            w->loads->side[at] += moment->seen.side * share;
            w->loads->area[at] += moment->seen.area * share;
        }
    }
}

static swarf_status cut_group(struct work *w)
{
    const size_t pieces = (w->moment_count + MOMENTS_AT_ONCE - 1) / MOMENTS_AT_ONCE;
    double volume = 0;
    SWARF_TRY(swarf_parallel_for(pieces, see_moments, w, NULL, 0, 1));
    SWARF_TRY(swarf_cut_measured(w->stock, w->batch->flutes, &w->list.tracks[w->steps[w->first].track],
                                 w->end - w->first, &volume));
    for (size_t i = 0; i < w->moment_count; i++) note_moment(w, &w->moments[i]);
    share_volume(w, volume);
    note_sides(w);
    return SWARF_OK;
}

/* Rates and sides of whole moves. With the spindle clockwise (seen from above) the right side is climb milling. */
static void finish_moves(struct work *w, const size_t *numbers, size_t count)
{
    const swarf_move *moves = swarf_program_moves(w->batch->program);
    const swarf_section *sections = swarf_program_sections(w->batch->program);
    float **values = w->loads->values;
    size_t step = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t at = numbers[i] - w->batch->origin;
        double length = 0;
        for (; step < w->step_count && w->steps[step].number == numbers[i]; step++) length += w->steps[step].length;
        if (length > 0)
            values[SWARF_LOAD_RATE][at] = (float)(w->loads->volume[at] * moves[numbers[i]].feed_mm_min / 60 / length);
        raise(&values[SWARF_LOAD_PEAK_RATE][at], values[SWARF_LOAD_RATE][at]);
        const int left = sections[swarf_move_get_section(&moves[numbers[i]])].spindle == SWARF_SPINDLE_CCW;
        if (w->loads->area[at] > 0)
            values[SWARF_LOAD_CLIMB][at] = (float)((left ? 1 : -1) * w->loads->side[at] / w->loads->area[at]);
    }
}

static swarf_status play(struct work *w, const size_t *numbers, size_t count, const swarf_progress *progress,
                         double from, double to)
{
    SWARF_TRY(swarf_meridian_create(w->batch->cutter, w->voxel, &w->meridian));
    SWARF_TRY(swarf_block_finish(w->stock));
    for (size_t i = 0; i < count; i++) SWARF_TRY(add_steps(w, numbers[i]));
    for (w->first = 0; w->first < w->step_count; w->first = w->end) {
        if (w->steps[w->first].t0 == 0) /* between whole moves */
            SWARF_TRY(swarf_progress_report(progress, from + (to - from) * (double)w->first / (double)w->step_count));
        SWARF_TRY(make_group(w));
        SWARF_TRY(cut_group(w));
    }
    finish_moves(w, numbers, count);
    return SWARF_OK;
}

swarf_status swarf_loads_cut(swarf_loads *loads, swarf_stock *stock, const swarf_load_batch *batch,
                             const size_t *numbers, size_t count, const swarf_progress *progress, double from,
                             double to)
{
    struct work w = {.loads = loads, .stock = stock, .batch = batch, .voxel = swarf_stock_voxel(stock)};
    w.column_count = swarf_threads();
    w.columns = calloc((size_t)w.column_count, sizeof *w.columns);
    swarf_status status = w.columns ? play(&w, numbers, count, progress, from, to)
                                    : swarf_fail(SWARF_ERROR_MEMORY, "load: out of memory");
    for (int i = 0; w.columns && i < w.column_count; i++) swarf_column_free(&w.columns[i]);
    free(w.columns);
    free(w.list.tracks);
    free(w.steps);
    free(w.moments);
    swarf_meridian_destroy(&w.meridian);
    return status;
}
