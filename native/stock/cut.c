/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cutting: stock = max(stock, -sweep) over all paths of a batch at once.
 *
 * The tracks of the batch are binned by columns of 32 x 32 voxels. A column is one piece of work: its leaves share no
 * words of any mask with another column's, so that there are no locks and the order of columns does not matter. Within
 * it blocks of 32^3, 16^3 and 8^3 voxels are visited with ever shorter lists of tracks; air is skipped by occupancy, a
 * block that one track covers is removed whole, and a leaf is read and written once however many tracks meet it. */
#include "stock/cut.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "stock/block.h"
#include "stock/leaf.h"
#include "stock/undo.h"
#include "sweep/kernel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_FLOATS = 64 / sizeof(float) };
enum { COLUMN = 32, COLUMN_LEAVES = COLUMN / SWARF_LEAF_DIM, NODE_COLUMNS = SWARF_NODE_DIM / COLUMN };

/* What is seen of one column while it is worked on: how deep tracks go into the stock at most, and where in voxels of
 * the layout; or how much they remove. */
struct touch {
    float depth; /* mm */
    int32_t ijk[3];
    double removed; /* voxels */
};

struct cut_work {
    swarf_stock *stock;
    const swarf_tree_layout *layout;
    const swarf_kernel *kernel;
    const swarf_body *body;
    const swarf_track *tracks;
    const int32_t *columns; /* numbers (x * columns_y + y) of the columns that have tracks */
    const int32_t *starts;  /* per column of the layout: where its tracks start in `numbers` */
    const int32_t *numbers;
    int32_t columns_y;
    swarf_column *scratch; /* one per thread */
    int scratch_count;
    struct touch *touches; /* one per column with tracks: nothing is cut, only looked for; else NULL */
    int measured;          /* 1: it is cut all the same, and the touches tell how much was removed */
    float enough;          /* depth from which on it need not be looked for any more */
    int *found;            /* 1 once that deep a place is known; only by atomic operations */
    swarf_undo *undo;      /* keeps what slots held before; NULL: nothing does */
};

/* Place of a leaf, by its coordinates in leaves. */
struct place {
    size_t node;
    unsigned slot;
};

static struct place place_of(const swarf_tree_layout *layout, int32_t x, int32_t y, int32_t z)
{
    const size_t node =
        ((size_t)(x >> 4) * (size_t)layout->count[1] + (size_t)(y >> 4)) * (size_t)layout->count[2] + (size_t)(z >> 4);
    return (struct place){node, (unsigned)(x & 15) << 8 | (unsigned)(y & 15) << 4 | (unsigned)(z & 15)};
}

/* Is any slot of an aligned cube of `edge` (1, 2 or 4) leaves occupied? A word holds four rows of y at one x. */
static int occupied(const swarf_tree_layout *layout, int32_t x, int32_t y, int32_t z, int edge)
{
    const struct place place = place_of(layout, x, y, z);
    const uint64_t *words = layout->occupied + place.node * SWARF_NODE_WORDS;
    const uint64_t row = ((1u << edge) - 1ull) << (z & 15);
    uint64_t rows = 0;
    for (int i = 0; i < edge; i++) rows |= row << (((y + i) & 3) * 16);
    for (int i = 0; i < edge; i++)
        if (words[((x & 15) + i) * 4 + ((y & 15) >> 2)] & rows) return 1;
    return 0;
}

/* Of equally deep places the first in the order of voxels: the order of threads must not show. */
static void see_touch(struct touch *touch, float depth, int32_t x, int32_t y, int32_t z)
{
    if (depth <= touch->depth) return;
    *touch = (struct touch){.depth = depth, .ijk = {x, y, z}};
}

/* Material in a slot, in voxels. */
static double slot_material(const struct cut_work *work, const struct place *place, int32_t x, int32_t y, int32_t z)
{
    const int32_t corner[3] = {x * SWARF_LEAF_DIM, y * SWARF_LEAF_DIM, z * SWARF_LEAF_DIM};
    const float scale = (float)(1 / work->layout->voxel),
                *values = swarf_tree_leaf(work->stock->tree, place->node, place->slot);
    _Alignas(64) float face[SWARF_LEAF_SIZE];
    uint64_t mask[8];
    float least;
    if (!values && !(work->stock->untouched && swarf_block_reaches(work->stock, corner))) return SWARF_LEAF_SIZE;
    if (!values) swarf_block_fill(work->stock, corner, face, mask, &least);
    return work->kernel->occupancy(values ? values : face, scale);
}

/* Keep what a slot held, by its coordinates in leaves: `before` is NULL where it was a tile, `after` where it becomes
 * one. */
static swarf_status keep_slot(const struct cut_work *work, int32_t x, int32_t y, struct place place,
                              const float *before, const float *after)
{
    if (!work->undo) return SWARF_OK;
    const int32_t column = x / COLUMN_LEAVES * work->columns_y + y / COLUMN_LEAVES;
    return swarf_undo_keep(work->undo, column, place.node, place.slot, before, after);
}

static swarf_status remove_cube(const struct cut_work *work, struct touch *touch, int32_t x, int32_t y, int32_t z,
                                int edge)
{
    const int32_t middle = edge * SWARF_LEAF_DIM / 2;
    if (touch && !work->measured) {
        see_touch(touch, work->layout->background, x * SWARF_LEAF_DIM + middle, y * SWARF_LEAF_DIM + middle,
                  z * SWARF_LEAF_DIM + middle);
        return SWARF_OK;
    }
    for (int i = 0; i < edge * edge * edge; i++) {
        const int32_t at[3] = {x + i / (edge * edge), y + i / edge % edge, z + i % edge};
        const struct place place = place_of(work->layout, at[0], at[1], at[2]);
        const uint64_t word = work->layout->occupied[place.node * SWARF_NODE_WORDS + (place.slot >> 6)];
        if (!(word >> (place.slot & 63) & 1)) continue;
        if (touch) touch->removed += slot_material(work, &place, at[0], at[1], at[2]);
        SWARF_TRY(keep_slot(work, x, y, place, swarf_tree_leaf(work->stock->tree, place.node, place.slot), NULL));
        swarf_tree_tile(work->stock->tree, place.node, place.slot, 0);
    }
    return SWARF_OK;
}

/* Beside edges distances run short, and the more so the farther away: voxels farther from the surface than the first
 * number tell of nothing shallower than the second (both in voxels). Below every face there are some within one voxel.
 */
static const float touch_near = 1, touch_deep = 1.3f;

/* What a cut of the leaf would raise its values by: where -sweep exceeds the stock the two overlap, for the distances
 * to two bodies that are apart add up to at least the gap between them. Only voxels in the material tell: those in air
 * may have kept their distance from a face that was cut away since. */
static void touch_leaf(const struct cut_work *work, struct touch *touch, const float *before, const float *after,
                       const int32_t corner[3])
{
    for (int i = 0; i < SWARF_LEAF_SIZE; i++) {
        /* the kernel wrote all of it: NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign) */
        const float own = before ? before[i] : -work->layout->background, depth = after[i] - own;
        const float voxel = (float)work->layout->voxel;
        if (own > 0 || (own < -touch_near * voxel && depth < touch_deep * voxel)) continue;
        see_touch(touch, depth, corner[0] + (i >> 6), corner[1] + (i >> 3 & 7), corner[2] + (i & 7));
    }
}

static swarf_status cut_leaf(const struct cut_work *work, struct touch *touch, const swarf_column *column,
                             const int32_t *list, size_t count, int32_t x, int32_t y, int32_t z)
{
    const swarf_tree_layout *layout = work->layout;
    const struct place place = place_of(layout, x, y, z);
    const int32_t corner[3] = {x * SWARF_LEAF_DIM, y * SWARF_LEAF_DIM, z * SWARF_LEAF_DIM};
    _Alignas(64) float fresh[SWARF_LEAF_SIZE];
    float *stored = swarf_tree_leaf(work->stock->tree, place.node, place.slot);
    swarf_leaf_cut cut; /* an initializer would clear it all, which takes as long as a tenth of the cut */
    cut.voxel = (float)layout->voxel;
    cut.background = layout->background;
    cut.solid = 0;
    cut.x = (float)(corner[0] - column->middle[0]);
    cut.y = (float)(corner[1] - column->middle[1]);
    cut.z = (float)(corner[2] - column->middle[2]);
    cut.values = stored ? stored : fresh;
    if (!stored) {
        cut.solid = !(work->stock->untouched && swarf_block_reaches(work->stock, corner));
        if (!cut.solid) swarf_block_fill(work->stock, corner, fresh, cut.mask, &cut.least);
    }
    _Alignas(64) float before[SWARF_LEAF_SIZE];
    const float scale = 1 / cut.voxel;
    if (touch && work->measured)
        touch->removed += cut.solid ? SWARF_LEAF_SIZE : work->kernel->occupancy(cut.values, scale);
    else if (touch) { /* on a copy */
        if (touch->depth > work->enough) {
            __atomic_store_n(work->found, 1, __ATOMIC_RELAXED);
            return SWARF_OK;
        }
        if (!cut.solid) memcpy(before, cut.values, sizeof before);
        if (stored) memcpy(fresh, stored, sizeof fresh);
        cut.values = fresh;
    }
    if (work->undo && stored) memcpy(before, stored, sizeof before);
    const int changed = work->kernel->cut(work->body, column, list, count, &cut);
    if (touch && work->measured)
        touch->removed -= cut.solid && !changed ? SWARF_LEAF_SIZE : work->kernel->occupancy(cut.values, scale);
    if (!changed) return SWARF_OK;
    if (touch && !work->measured) {
        touch_leaf(work, touch, cut.solid ? NULL : before, fresh, corner);
        return SWARF_OK;
    }
    const int gone = cut.least >= SWARF_LEAF_DROP * cut.voxel;
    if (stored || gone || cut.most > -cut.background) {
        const swarf_status status = keep_slot(work, x, y, place, stored ? before : NULL, gone ? NULL : cut.values);
        if (status != SWARF_OK) {
            if (stored) memcpy(stored, before, sizeof before);
            return status;
        }
    }
    if (gone) {
        swarf_tree_tile(work->stock->tree, place.node, place.slot, 0);
    } else if (stored) {
        swarf_tree_leaf_mask(work->stock->tree, place.node, place.slot, cut.mask);
    } else if (cut.most > -cut.background) {
        return swarf_tree_leaf_add(work->stock->tree, place.node, place.slot, fresh, cut.mask);
    }
    return SWARF_OK;
}

static swarf_block block_of(const swarf_column *column, const int32_t at[3], int edge)
{
    const float half = 0.5f * (float)(edge * SWARF_LEAF_DIM - 1);
    return (swarf_block){(float)(at[0] * SWARF_LEAF_DIM - column->middle[0]) + half,
                         (float)(at[1] * SWARF_LEAF_DIM - column->middle[1]) + half,
                         (float)(at[2] * SWARF_LEAF_DIM - column->middle[2]) + half, half, half};
}

/* Leaves lie anywhere in memory: what will be read soon is asked for ahead, its place while tracks are culled,
 * its values while the leaf before it is cut. */
static void fetch_leaf(const struct cut_work *work, const int32_t at[3])
{
    const struct place place = place_of(work->layout, at[0], at[1], at[2]);
    swarf_tree_leaf_fetch(work->stock->tree, place.node, place.slot);
}

static void fetch_values(const struct cut_work *work, const int32_t at[3])
{
    const struct place place = place_of(work->layout, at[0], at[1], at[2]);
    const float *values = swarf_tree_leaf(work->stock->tree, place.node, place.slot);
    for (int i = 0; values && i < SWARF_LEAF_SIZE; i += LINE_FLOATS) __builtin_prefetch(values + i, 1);
}

/* A cube of `edge` leaves at a place in leaves, with the tracks that concern it. */
static swarf_status cut_cube(const struct cut_work *work, struct touch *touch, const swarf_column *column,
                             const int32_t *list, size_t count, const int32_t at[3], int edge)
{
    if (edge == 1) return cut_leaf(work, touch, column, list, count, at[0], at[1], at[2]);
    const int next = edge / 2;
    int32_t *const *kept = &column->list[edge == COLUMN_LEAVES ? LIST_PARTS : LIST_LEAVES];
    int32_t places[BLOCKS_AT_ONCE][3];
    swarf_block blocks[BLOCKS_AT_ONCE];
    size_t used = 0, left[BLOCKS_AT_ONCE];
    for (int i = 0; i < BLOCKS_AT_ONCE; i++) {
        const int32_t place[3] = {at[0] + (i >> 2) * next, at[1] + (i >> 1 & 1) * next, at[2] + (i & 1) * next};
        if (!occupied(work->layout, place[0], place[1], place[2], next)) continue;
        memcpy(places[used], place, sizeof place);
        blocks[used++] = block_of(column, place, next);
        if (next == 1) fetch_leaf(work, place);
    }
    const unsigned covered = work->kernel->cull(work->body, column, list, count, blocks, used, kept, left);
    if (next == 1 && used && left[0]) fetch_values(work, places[0]);
    for (size_t i = 0; i < used; i++) {
        if (next == 1 && i + 1 < used && left[i + 1]) fetch_values(work, places[i + 1]);
        if (covered >> i & 1)
            SWARF_TRY(remove_cube(work, touch, places[i][0], places[i][1], places[i][2], next));
        else if (left[i])
            SWARF_TRY(cut_cube(work, touch, column, kept[i], left[i], places[i], next));
    }
    return SWARF_OK;
}

static swarf_status cut_column_with(const struct cut_work *work, swarf_column *column, int32_t number,
                                    struct touch *touch)
{
    const int32_t x = number / work->columns_y, y = number % work->columns_y;
    const int32_t *numbers = work->numbers + work->starts[number];
    const size_t count = (size_t)(work->starts[number + 1] - work->starts[number]);
    const double middle[3] = {x * COLUMN + 15.5, y * COLUMN + 15.5, 0.5 * SWARF_NODE_DIM * work->layout->count[2]};
    SWARF_TRY(swarf_column_fill(column, middle, work->tracks, numbers, count));
    double lo = INFINITY, hi = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        const swarf_track *track = &work->tracks[numbers[i]];
        lo = fmin(lo, track->point[2]);
        hi = fmax(hi, track->point[2] + track->rise);
    }
    lo = fmax(lo + work->body->z_lo - SWARF_HALF_WIDTH, 0);
    hi = fmin(hi + work->body->z_hi + SWARF_HALF_WIDTH, (double)work->layout->count[2] * SWARF_NODE_DIM - 1);
    for (int32_t z = (int32_t)floor(lo / COLUMN); lo <= hi && z <= (int32_t)floor(hi / COLUMN); z++) {
        const int32_t at[3] = {x * COLUMN_LEAVES, y * COLUMN_LEAVES, z * COLUMN_LEAVES};
        if (!occupied(work->layout, at[0], at[1], at[2], COLUMN_LEAVES)) continue;
        const swarf_block block = block_of(column, at, COLUMN_LEAVES);
        int32_t *kept = column->list[LIST_CUBE];
        size_t left = 0;
        if (work->kernel->cull(work->body, column, column->list[LIST_ALL], count, &block, 1, &kept, &left))
            SWARF_TRY(remove_cube(work, touch, at[0], at[1], at[2], COLUMN_LEAVES));
        else if (left)
            SWARF_TRY(cut_cube(work, touch, column, kept, left, at, COLUMN_LEAVES));
    }
    if (work->undo) swarf_undo_finish(work->undo, number);
    return SWARF_OK;
}

static swarf_status cut_column(void *context, size_t index)
{
    const struct cut_work *work = context;
    const int32_t number = work->columns[index];
    /* the number of threads may have been raised since the scratch was made */
    const int slot = swarf_parallel_slot();
    if (work->found && __atomic_load_n(work->found, __ATOMIC_RELAXED)) return SWARF_OK;
    struct touch *touch = work->touches ? &work->touches[index] : NULL;
    if (slot < work->scratch_count) return cut_column_with(work, &work->scratch[slot], number, touch);
    swarf_column own = {.room = 0};
    const swarf_status status = cut_column_with(work, &own, number, touch);
    swarf_column_free(&own);
    return status;
}

/* Call `see` for every column that the track may reach: those in its box, and of a long slanting line those near it. */
typedef void (*column_fn)(void *context, int32_t column);
static void for_columns(const swarf_tree_layout *layout, const swarf_body *body, const swarf_track *track,
                        column_fn see, void *context)
{
    const double reach = (double)body->radius + SWARF_HALF_WIDTH;
    if (track->point[2] + body->z_lo - SWARF_HALF_WIDTH > (double)layout->count[2] * SWARF_NODE_DIM ||
        track->point[2] + track->rise + body->z_hi + SWARF_HALF_WIDTH < 0)
        return;
    int32_t lo[2], hi[2];
    for (int k = 0; k < 2; k++) {
        const double along = (k ? track->uy : track->ux) * track->run;
        double a = fmin(track->point[k], track->point[k] + along), b = fmax(track->point[k], track->point[k] + along);
        if (track->is_arc) {
            a = track->centre[k] - track->radius;
            b = track->centre[k] + track->radius;
        }
        const int32_t last = layout->count[k] * NODE_COLUMNS - 1;
        lo[k] = (int32_t)fmin(last + 1, floor(fmax(0, (a - reach) / COLUMN)));
        hi[k] = (int32_t)fmin(last, floor(fmax(-1, fmin(last, (b + reach) / COLUMN))));
    }
    const int slanting = !track->is_arc && hi[0] - lo[0] > 1 && hi[1] - lo[1] > 1;
    const double near = reach + 0.5 * COLUMN * M_SQRT2;
    for (int32_t x = lo[0]; x <= hi[0]; x++)
        for (int32_t y = lo[1]; y <= hi[1]; y++) {
            const double dx = x * COLUMN + 15.5 - track->point[0], dy = y * COLUMN + 15.5 - track->point[1];
            if (slanting) {
                const double s = fmin(fmax(dx * track->ux + dy * track->uy, 0), track->run);
                if (hypot(dx - s * track->ux, dy - s * track->uy) > near) continue;
            }
            if (track->is_arc) {
                const double away = hypot(x * COLUMN + 15.5 - track->centre[0], y * COLUMN + 15.5 - track->centre[1]);
                if (fabs(away - track->radius) > near) continue;
            }
            see(context, x * (layout->count[1] * NODE_COLUMNS) + y);
        }
}

/* Which tracks each column has: counted, then filled in the order of the tracks. */
struct bins {
    int32_t *starts, *numbers, *columns;
    size_t column_count; /* that have tracks */
    size_t tracks;       /* binned */
    int32_t track;
    size_t total;
};

static void count_one(void *context, int32_t column)
{
    struct bins *bins = context;
    bins->starts[column + 1]++;
    bins->total++;
}

static void add_one(void *context, int32_t column)
{
    struct bins *bins = context;
    bins->numbers[bins->starts[column]++] = bins->track;
}

/* A batch ends at this many tracks times columns: about a second of work on one thread, which is how long a cancel may
 * wait. It does not depend on time, so that the same moves always make the same batches. */
enum { MOST_BINNED = 400000 };

/* Bin the first tracks of a list, as many as one batch takes. */
static swarf_status fill_bins(const swarf_tree_layout *layout, const swarf_body *body, const swarf_track *tracks,
                              size_t count, struct bins *bins)
{
    const size_t columns = (size_t)layout->count[0] * (size_t)layout->count[1] * NODE_COLUMNS * NODE_COLUMNS;
    bins->starts = calloc(columns + 1, sizeof *bins->starts);
    if (!bins->starts) return swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory");
    for (; bins->tracks < count && bins->total < MOST_BINNED; bins->tracks++)
        for_columns(layout, body, &tracks[bins->tracks], count_one, bins);
    for (size_t i = 0; i < columns; i++) bins->column_count += bins->starts[i + 1] > 0;
    for (size_t i = 0; i < columns; i++) bins->starts[i + 1] += bins->starts[i];
    bins->numbers = malloc((bins->total + 1) * sizeof *bins->numbers);
    bins->columns = malloc((bins->column_count + 1) * sizeof *bins->columns);
    if (!bins->numbers || !bins->columns) return swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory");
    size_t used = 0;
    for (size_t i = 0; i < columns; i++)
        if (bins->starts[i + 1] > bins->starts[i]) bins->columns[used++] = (int32_t)i;
    for (size_t i = 0; i < bins->tracks; i++) {
        bins->track = (int32_t)i;
        for_columns(layout, body, &tracks[i], add_one, bins);
    }
    /* filling moved every start to the next one's place */
    memmove(bins->starts + 1, bins->starts, columns * sizeof *bins->starts);
    bins->starts[0] = 0;
    return SWARF_OK;
}

/* Within a batch some columns are cut and others not, with walls between them that have no band. So a wish to cancel is
 * kept until the batch is done. */
struct deferred {
    const swarf_progress *progress;
    int cancelled;
};

static int report_deferred(void *user, double fraction)
{
    struct deferred *deferred = user;
    if (!deferred->cancelled) deferred->cancelled = deferred->progress->fn(deferred->progress->user, fraction) != 0;
    return 0;
}

/* Scratch memory of all threads. The last one is kept for the next batch: making it costs more than cutting one move.
 */
struct scratch {
    int count;
    swarf_column columns[];
};

static struct scratch *kept_scratch; /* only by atomic exchange */

static void free_scratch(struct scratch *scratch)
{
    for (int i = 0; scratch && i < scratch->count; i++) swarf_column_free(&scratch->columns[i]);
    free(scratch);
}

static struct scratch *take_scratch(int threads)
{
    struct scratch *scratch = __atomic_exchange_n(&kept_scratch, NULL, __ATOMIC_ACQ_REL);
    if (scratch && scratch->count >= threads) return scratch;
    free_scratch(scratch);
    scratch = calloc(1, sizeof *scratch + (size_t)threads * sizeof scratch->columns[0]);
    if (scratch) scratch->count = threads;
    return scratch;
}

/* Keep it, unless it has grown large: a batch of millions of moves in one place comes rarely. */
static void keep_scratch(struct scratch *scratch)
{
    const size_t most = 1 << 14; /* tracks a column: 4 MB a thread */
    for (int i = 0; scratch && i < scratch->count; i++)
        if (scratch->columns[i].room > most) swarf_column_free(&scratch->columns[i]);
    free_scratch(__atomic_exchange_n(&kept_scratch, scratch, __ATOMIC_ACQ_REL));
}

/* What is wanted of batches beside the cut itself. */
struct wish {
    swarf_undo *undo;      /* what is changed is kept there, each batch in a layer of its own; or NULL */
    struct touch *deepest; /* nothing is cut, only seen how deep it would go, `measured`: cut, and how much goes */
    int measured;
    float enough; /* see cut_work */
};

/* Cut the first tracks of a list as one batch; *done: how many. */
static swarf_status cut_batch(swarf_stock *stock, const swarf_body *body, const swarf_track *tracks, size_t count,
                              const struct wish *wish, const swarf_progress *progress, double from, double to,
                              size_t *done)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    struct touch *deepest = wish->deepest;
    struct bins bins = {0};
    int found = 0;
    struct scratch *scratch = take_scratch(swarf_threads());
    swarf_status status = scratch ? fill_bins(layout, body, tracks, count, &bins)
                                  : swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory");
    if (status == SWARF_OK && wish->undo) status = swarf_undo_open(wish->undo, layout, bins.columns, bins.column_count);
    if (status == SWARF_OK) {
        const double until = bins.tracks == count ? to : from + (to - from) * (double)bins.tracks / (double)count;
        struct cut_work work = {.stock = stock,
                                .layout = layout,
                                .kernel = swarf_kernel_current(),
                                .body = body,
                                .tracks = tracks,
                                .columns = bins.columns,
                                .starts = bins.starts,
                                .numbers = bins.numbers,
                                .columns_y = layout->count[1] * NODE_COLUMNS,
                                .scratch = scratch->columns,
                                .scratch_count = scratch->count,
                                .measured = wish->measured,
                                .enough = wish->enough,
                                .found = deepest && !wish->measured ? &found : NULL,
                                .undo = wish->undo};
        if (deepest && !(work.touches = calloc(bins.column_count + 1, sizeof *work.touches)))
            status = swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory");
        if (status == SWARF_OK)
            status = swarf_parallel_for(bins.column_count, cut_column, &work, progress, from, until);
        for (size_t i = 0; deepest && status == SWARF_OK && i < bins.column_count; i++)
            if (wish->measured)
                deepest->removed += work.touches[i].removed;
            else if (work.touches[i].depth > deepest->depth)
                *deepest = work.touches[i];
        free(work.touches);
        if (wish->undo) swarf_undo_close(wish->undo);
    }
    keep_scratch(scratch);
    free(bins.starts);
    free(bins.numbers);
    free(bins.columns);
    *done = bins.tracks;
    return status;
}

/* What is kept can be put back: then a cancel need not wait for the end of a batch. */
static swarf_status cut_tracks(swarf_stock *stock, const swarf_body *body, const swarf_track_list *list,
                               swarf_undo *undo, const swarf_progress *progress, double from, double to)
{
    struct deferred deferred = {progress, 0};
    const swarf_progress patient = {report_deferred, &deferred};
    const struct wish wish = {.undo = undo};
    for (size_t first = 0, done = 0; first < list->count; first += done) {
        const double at = from + (to - from) * (double)first / (double)list->count;
        SWARF_TRY(cut_batch(stock, body, list->tracks + first, list->count - first, &wish,
                            progress && progress->fn && !undo ? &patient : progress, at, to, &done));
        if (deferred.cancelled) return swarf_fail(SWARF_ERROR_CANCELLED, "cancelled");
    }
    return swarf_progress_report(progress, to);
}

swarf_status swarf_cut_recorded(swarf_stock *stock, const swarf_body *body, const swarf_path *paths, size_t count,
                                swarf_undo *undo, const swarf_progress *progress, double from, double to)
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    if (body->component_count == 0) return swarf_progress_report(progress, to);
    swarf_track_list list = {0};
    swarf_status status = SWARF_OK;
    for (size_t i = 0; i < count && status == SWARF_OK; i++)
        status = swarf_track_append(&list, &paths[i], layout->origin, layout->voxel);
    swarf_tree_next_generation(stock->tree);
    if (status == SWARF_OK) status = cut_tracks(stock, body, &list, undo, progress, from, to);
    free(list.tracks);
    return status;
}

swarf_status swarf_cut_body(swarf_stock *stock, const swarf_body *body, const swarf_path *paths, size_t count,
                            const swarf_progress *progress, double from, double to)
{
    return swarf_cut_recorded(stock, body, paths, count, NULL, progress, from, to);
}

swarf_status swarf_cut_measured(swarf_stock *stock, const swarf_body *body, const swarf_track *tracks, size_t count,
                                double *removed)
{
    const double voxel = swarf_stock_voxel(stock);
    struct touch sum = {0};
    const struct wish wish = {.deepest = &sum, .measured = 1};
    swarf_tree_next_generation(stock->tree);
    for (size_t first = 0, done = 0; first < count && body->component_count; first += done)
        SWARF_TRY(cut_batch(stock, body, tracks + first, count - first, &wish, NULL, 0, 1, &done));
    *removed = sum.removed * voxel * voxel * voxel;
    return SWARF_OK;
}

swarf_status swarf_cut_touch(swarf_stock *stock, const swarf_body *body, const swarf_path *paths, size_t count,
                             double enough, double *depth, double point[3])
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(stock->tree);
    struct touch deepest = {0};
    const struct wish wish = {.deepest = &deepest, .enough = (float)enough};
    swarf_track_list list = {0};
    swarf_status status = SWARF_OK;
    for (size_t i = 0; i < count && status == SWARF_OK; i++)
        status = swarf_track_append(&list, &paths[i], layout->origin, layout->voxel);
    for (size_t first = 0, done = 0;
         first < list.count && status == SWARF_OK && body->component_count && !(deepest.depth > enough); first += done)
        status = cut_batch(stock, body, list.tracks + first, list.count - first, &wish, NULL, 0, 1, &done);
    free(list.tracks);
    if (status != SWARF_OK) return status;
    *depth = deepest.depth;
    for (int k = 0; k < 3; k++) point[k] = layout->origin[k] + layout->voxel * deepest.ijk[k];
    return SWARF_OK;
}

swarf_status swarf_stock_cut(swarf_stock *stock, const swarf_cutter *cutter, const swarf_path *paths, size_t count,
                             const swarf_progress *progress)
{
    SWARF_REQUIRE(cutter && (paths || count == 0), "stock: cutter or paths missing");
    SWARF_TRY(swarf_stock_enter_write(stock));
    swarf_body *body = NULL;
    swarf_status status = swarf_body_create(cutter, SWARF_PART_FLUTES, swarf_stock_voxel(stock), &body);
    if (status == SWARF_OK) status = swarf_cut_body(stock, body, paths, count, progress, 0, 1);
    swarf_body_destroy(body);
    swarf_stock_leave(stock);
    return status;
}
