/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Simplifying a whole surface: cut into cubes, each simplified by one thread with the vertices at its border fixed,
 * then once more with cubes that are shifted or larger, so that no border stays. Which cube is done when does not
 * matter, so the result is the same for any number of threads. */
#include "mesh/simplify.h"

#include "base/mix.h"
#include "base/parallel.h"
#include "base/status.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Edge of the cubes in voxels, pass by pass. The first are small, to stay in cache while there are many facets; the
 * last is one for all, for vertices whose facets have grown over every border before. Few are left to look at by then.
 */
static const struct pass {
    double edge, shift;
} passes[] = {{32, 0}, {32, 0.5}, {96, 0.25}, {256, 0.4}, {1e9, 0}};
enum { PASSES = sizeof passes / sizeof *passes };
/* The first take most of the time, and of their cubes most come again as they were. */
enum { MEMO_PASSES = 3 };
/* Cubes that a table is made for; more are made larger. */
static const double most_cubes = 1 << 22;
/* Parts of the facets that are sorted at once, each with counts of its own in every cube: more take memory, fewer leave
 * threads idle. */
enum { PARTS = 16 };
/* With a budget the error grows by this factor until the budget is met: the mesh ends within it of the least error. */
static const double error_step = 2;
enum { ERROR_STEPS = 8 };

typedef struct job {
    swarf_facets *facets;
    uint8_t *marks;
    struct pass_memo *memo;   /* of this pass, NULL: none */
    double least[3], most[3]; /* of the vertices */
    double lo[3], edge, limit;
    size_t count[3];
    int first;           /* pass at this limit */
    uint32_t *cube;      /* of every vertex */
    uint32_t *local;     /* of every vertex, the number in its cube */
    uint8_t *settled;    /* vertices that cannot go at this limit unless something near them does */
    uint8_t *zone;       /* of every vertex, in the last pass at a limit; else NULL */
    size_t parts;        /* of the facets, in their order */
    int put;             /* facets are put, not counted */
    int trusted;         /* known vertices are, see swarf_facets_memo */
    uint8_t *fresh;      /* by cube, then by part: it has facets with vertices that are not known; NULL: any may */
    size_t *owned_begin; /* by cube, then by part */
    size_t *shared_begin;
    uint32_t *owned;          /* facets by cube */
    uint32_t *shared;         /* facets that reach out of a cube */
    size_t *gone;             /* by cube */
    simplify_region *scratch; /* of each thread */
    int scratch_count;
} job;

static uint32_t find_cube(const job *j, size_t vertex)
{
    const float *p = j->facets->xyz + 3 * vertex;
    size_t at[3];
    for (int k = 0; k < 3; k++) {
        const double cell = ((double)p[k] - j->lo[k]) / j->edge;
        at[k] = cell < 0 ? 0 : (size_t)cell;
        if (at[k] >= j->count[k]) at[k] = j->count[k] - 1;
    }
    return (uint32_t)((at[0] * j->count[1] + at[1]) * j->count[2] + at[2]);
}

enum { CHUNK = 65536 };

static swarf_status find_cubes(void *context, size_t index)
{
    job *j = context;
    for (size_t i = index * CHUNK; i < (index + 1) * CHUNK && i < j->facets->vertex_count; i++)
        j->cube[i] = find_cube(j, i);
    return SWARF_OK;
}

/* In the last pass few vertices are not settled, and only they and those beside them may go; what is asked about that
 * reaches two vertices further, and no other facets are looked at: one thread has all that are. */
enum { ZONE_FAR, ZONE_RIM, ZONE_BESIDE, ZONE_UNSETTLED };

static swarf_status find_zones(job *j)
{
    const swarf_facets *facets = j->facets;
    j->zone = malloc(facets->vertex_count);
    if (!j->zone) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for simplifying");
    for (size_t i = 0; i < facets->vertex_count; i++) j->zone[i] = j->settled[i] ? ZONE_FAR : ZONE_UNSETTLED;
    for (uint8_t zone = ZONE_UNSETTLED; zone > ZONE_RIM; zone--)
        for (size_t f = 0; f < facets->facet_count; f++) {
            const uint32_t *v = facets->facet[f].v;
            if (j->zone[v[0]] < zone && j->zone[v[1]] < zone && j->zone[v[2]] < zone) continue;
            for (int k = 0; k < 3; k++)
                if (j->zone[v[k]] < zone - 1) j->zone[v[k]] = (uint8_t)(zone - 1);
        }
    return SWARF_OK;
}

/* A part of the facets by cube, counted and then put; a facet over several cubes is shared by each of them. */
static swarf_status sort_part(void *context, size_t part)
{
    job *j = context;
    const size_t count = j->facets->facet_count;
    for (size_t f = part * count / j->parts; f < (part + 1) * count / j->parts; f++) {
        const uint32_t *v = j->facets->facet[f].v;
        if (j->zone && !(j->zone[v[0]] | j->zone[v[1]] | j->zone[v[2]])) continue;
        const size_t c[3] = {j->cube[v[0]], j->cube[v[1]], j->cube[v[2]]};
        const int whole = c[0] == c[1] && c[1] == c[2];
        size_t *begin = whole ? j->owned_begin : j->shared_begin;
        uint32_t *list = whole ? j->owned : j->shared;
        const int fresh = j->fresh && !(j->marks[v[0]] & j->marks[v[1]] & j->marks[v[2]] & SWARF_VERTEX_KNOWN);
        for (int k = 0; k < 3; k++) {
            if ((k > 0 && c[k] == c[0]) || (k > 1 && c[k] == c[1])) continue;
            size_t *at = &begin[c[k] * j->parts + part];
            if (j->put) list[*at] = (uint32_t)f;
            if (fresh) j->fresh[c[k] * j->parts + part] = 1;
            ++*at;
        }
    }
    return SWARF_OK;
}

static size_t sum_up(size_t *begin, size_t count)
{
    size_t sum = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t own = begin[i];
        begin[i] = sum;
        sum += own;
    }
    return sum;
}

static void free_region(simplify_region *r)
{
    free(r->xyz);
    free(r->global);
    free(r->head);
    free(r->state);
    free(r->mark);
    free(r->need);
    free(r->facet);
    *r = (simplify_region){0};
}

/* A facet that was left in a cube, in the numbers of the region. */
typedef struct memo_facet {
    uint32_t owned, v[3];
    float error_mm, lost_mm3;
} memo_facet;

/* What a region became; told apart from others by what went in. */
typedef struct cube_memo {
    memo_facet *facet;
    size_t facet_count;
    uint8_t *state; /* of its vertices */
    size_t vertices, facets, owned;
    uint64_t print;
} cube_memo;

typedef struct pass_memo {
    cube_memo *cube;
    size_t count;
} pass_memo;

static void forget_cube(cube_memo *memo)
{
    free(memo->facet);
    free(memo->state);
    *memo = (cube_memo){0};
}

static void forget(pass_memo *memo)
{
    for (size_t i = 0; memo->cube && i < memo->count; i++) forget_cube(&memo->cube[i]);
    free(memo->cube);
    *memo = (pass_memo){0};
}

void swarf_facets_memo_free(swarf_facets_memo *memo)
{
    for (int pass = 0; memo->pass && pass < PASSES; pass++) forget(&memo->pass[pass]);
    free(memo->pass);
    memo->pass = NULL;
}

/* A hash in four strands, as each step waits for the one before in its own. */
typedef struct strands {
    uint64_t at[4];
} strands;

static void mix_four(strands *p, const uint64_t words[4])
{
    for (int k = 0; k < 4; k++) p->at[k] = swarf_mix_in(p->at[k], words[k]);
}

static void mix_all(strands *p, const void *bytes, size_t size)
{
    uint64_t words[4] = {0};
    size_t at = 0;
    for (; at + sizeof words <= size; at += sizeof words) {
        memcpy(words, (const char *)bytes + at, sizeof words);
        mix_four(p, words);
    }
    memset(words, 0, sizeof words);
    memcpy(words, (const char *)bytes + at, size - at);
    mix_four(p, words);
}

/* The hash of all that a region is simplified by. */
static uint64_t print_of(const simplify_region *r)
{
    strands p = {{1, 2, 3, 4}};
    mix_all(&p, r->xyz, 3 * r->vertex_count * sizeof *r->xyz);
    mix_all(&p, r->state, r->vertex_count);
    mix_all(&p, r->need, r->vertex_count * sizeof *r->need);
    for (size_t f = 0; f < r->facet_count; f++) {
        const simplify_facet *here = &r->facet[f];
        uint64_t words[4] = {here->v[0] | (uint64_t)here->v[1] << 32, here->v[2]};
        uint32_t error, lost;
        memcpy(&error, &here->error_mm, sizeof error);
        memcpy(&lost, &here->lost_mm3, sizeof lost);
        words[1] |= (uint64_t)error << 32;
        words[2] = lost;
        memcpy(&words[3], here->normal, sizeof here->normal);
        mix_four(&p, words);
    }
    return swarf_mix_in(swarf_mix_in(swarf_mix_in(p.at[0], p.at[1]), p.at[2]), p.at[3]);
}

/* Without memory for it there is nothing to recall. */
static void remember(const simplify_region *r, uint64_t print, cube_memo *memo)
{
    size_t left = 0;
    for (size_t f = 0; f < r->owned_count; f++) left += r->facet[f].alive;
    forget_cube(memo);
    *memo = (cube_memo){.vertices = r->vertex_count, .facets = r->facet_count, .owned = r->owned_count, .print = print};
    memo->facet = malloc((left + 1) * sizeof *memo->facet);
    memo->state = malloc(r->vertex_count + 1);
    if (!memo->facet || !memo->state) return;
    memcpy(memo->state, r->state, r->vertex_count);
    for (size_t f = 0; f < r->owned_count; f++) {
        const simplify_facet *here = &r->facet[f];
        if (!here->alive) continue;
        memo->facet[memo->facet_count++] =
            (memo_facet){(uint32_t)f, {here->v[0], here->v[1], here->v[2]}, here->error_mm, here->lost_mm3};
    }
}

static int recall(simplify_region *r, uint64_t print, const cube_memo *memo)
{
    if (!memo->facet || !memo->state || memo->vertices != r->vertex_count || memo->facets != r->facet_count ||
        memo->owned != r->owned_count || memo->print != print)
        return 0;
    memcpy(r->state, memo->state, r->vertex_count);
    for (size_t f = 0; f < r->owned_count; f++) r->facet[f].alive = 0;
    for (size_t i = 0; i < memo->facet_count; i++) {
        const memo_facet *left = &memo->facet[i];
        simplify_facet *here = &r->facet[left->owned];
        here->alive = 1;
        here->error_mm = left->error_mm;
        here->lost_mm3 = left->lost_mm3;
        memcpy(here->v, left->v, sizeof here->v);
    }
    return 1;
}

/* The facets that lie in a region wholly, back to the mesh; others are read by other threads. Returns how many went. */
static size_t put_back(const simplify_region *r, swarf_facet *mesh)
{
    size_t gone = 0;
    for (size_t f = 0; f < r->owned_count; f++) {
        const simplify_facet *here = &r->facet[f];
        swarf_facet *facet = &mesh[here->global];
        if (!here->alive) {
            facet->v[0] = SWARF_NO_VERTEX;
            gone++;
            continue;
        }
        facet->error_mm = here->error_mm;
        facet->lost_mm3 = here->lost_mm3;
        for (size_t k = 0; k < 3; k++) facet->v[k] = r->global[here->v[k]];
    }
    return gone;
}

/* What became of facets that are as they were, straight to the mesh. Returns how many went. */
static size_t put_known(const job *j, const simplify_region *r, const cube_memo *memo, const uint32_t *owned)
{
    swarf_facet *mesh = j->facets->facet;
    for (size_t f = 0; f < memo->owned; f++) mesh[owned[f]].v[0] = SWARF_NO_VERTEX;
    for (size_t i = 0; i < memo->facet_count; i++) {
        const memo_facet *left = &memo->facet[i];
        swarf_facet *facet = &mesh[owned[left->owned]];
        facet->error_mm = left->error_mm;
        facet->lost_mm3 = left->lost_mm3;
        for (size_t k = 0; k < 3; k++) facet->v[k] = r->global[left->v[k]];
    }
    return memo->owned - memo->facet_count;
}

/* The region's number of a vertex; *is_first: it had none. */
static uint32_t number_of(const job *j, simplify_region *r, uint32_t vertex, int *is_first)
{
    const uint32_t own = j->local[vertex];
    *is_first = own >= r->vertex_count || r->global[own] != vertex;
    if (!*is_first) return own;
    r->global[r->vertex_count] = vertex;
    return j->local[vertex] = (uint32_t)r->vertex_count++;
}

static void add_facet(job *j, simplify_region *r, size_t cube, uint32_t number, int shared)
{
    const size_t f = r->facet_count++;
    const swarf_facet *facet = &j->facets->facet[number];
    simplify_facet *here = &r->facet[f];
    *here = (simplify_facet){.global = number, .error_mm = facet->error_mm, .lost_mm3 = facet->lost_mm3, .alive = 1};
    memcpy(here->normal, facet->normal, sizeof here->normal);
    for (size_t k = 0; k < 3; k++) {
        const uint32_t vertex = facet->v[k];
        here->v[k] = SWARF_NO_VERTEX;
        if (shared && j->cube[vertex] != cube) continue;
        int is_first;
        const uint32_t own = number_of(j, r, vertex, &is_first);
        if (is_first) {
            r->head[own] = SWARF_NO_VERTEX;
            r->mark[own] = 0;
            r->need[own] = j->settled[vertex] ? INFINITY : 0;
            const int locked = j->marks && j->marks[vertex] & SWARF_VERTEX_LOCKED;
            const int fixed = locked || (j->zone && j->zone[vertex] < ZONE_BESIDE);
            r->state[own] = fixed ? SIMPLIFY_FIXED : j->settled[vertex] ? 0 : SIMPLIFY_DIRTY;
            for (int c = 0; c < 3; c++)
                r->xyz[3 * (size_t)own + (size_t)c] = j->facets->xyz[3 * (size_t)vertex + (size_t)c];
        }
        if (shared) r->state[own] |= SIMPLIFY_FIXED;
        here->v[k] = own;
        here->next[k] = r->head[own];
        r->head[own] = (uint32_t)(4 * f + k);
    }
}

/* The facets of a cube. */
typedef struct cube_list {
    const uint32_t *owned, *shared;
    size_t owned_count, shared_count;
} cube_list;

/* Those that lie in it wholly first. */
static uint32_t facet_of(const cube_list *list, size_t i)
{
    return i < list->owned_count ? list->owned[i] : list->shared[i - list->owned_count];
}

static cube_list list_of(const job *j, size_t cube)
{
    const size_t first = cube * j->parts, last = first + j->parts - 1; /* the begins have become the ends */
    const size_t owned = cube ? j->owned_begin[first - 1] : 0, shared = cube ? j->shared_begin[first - 1] : 0;
    return (cube_list){.owned = j->owned + owned,
                       .shared = j->shared + shared,
                       .owned_count = j->owned_begin[last] - owned,
                       .shared_count = j->shared_begin[last] - shared};
}

/* Whether all facets of a cube are those of the attempt before: all vertices are known, and none have gone. */
static int is_known(const job *j, size_t cube, const cube_list *list, const cube_memo *memo)
{
    if (!j->fresh || !memo->facet || !memo->state || memo->owned != list->owned_count ||
        memo->facets != list->owned_count + list->shared_count)
        return 0;
    uint8_t fresh = 0;
    for (size_t part = 0; part < j->parts; part++) fresh |= j->fresh[cube * j->parts + part];
    return !fresh;
}

/* Number the vertices as add_facet() does, and settle them as they were. */
static void settle_known(const job *j, simplify_region *r, size_t cube, const cube_list *list, const cube_memo *memo)
{
    for (size_t i = 0; i < list->owned_count + list->shared_count; i++) {
        const swarf_facet *facet = &j->facets->facet[facet_of(list, i)];
        for (size_t k = 0; k < 3; k++) {
            int is_first;
            if (j->cube[facet->v[k]] != cube) continue;
            const uint32_t own = number_of(j, r, facet->v[k], &is_first);
            if (is_first) j->settled[facet->v[k]] = memo->state[own] == 0;
        }
    }
    assert(r->vertex_count == memo->vertices);
}

/* What becomes of a cube may be something else than at the attempt before. */
static void make_fresh(const job *j, size_t cube, const cube_list *list)
{
    for (size_t i = 0; i < list->owned_count + list->shared_count; i++) {
        const swarf_facet *facet = &j->facets->facet[facet_of(list, i)];
        for (size_t k = 0; k < 3; k++)
            if (j->cube[facet->v[k]] == cube) j->marks[facet->v[k]] &= (uint8_t)~SWARF_VERTEX_KNOWN;
    }
}

static void simplify_or_recall(const job *j, simplify_region *r, size_t cube, const cube_list *list, cube_memo *memo)
{
    const uint64_t print = memo ? print_of(r) : 0;
    if (memo && recall(r, print, memo)) return;
    swarf_simplify_region(r, j->limit, j->first);
    if (j->trusted) make_fresh(j, cube, list);
    if (memo) remember(r, print, memo);
}

/* Empty the region; room for so many facets, each with corners of its own. */
static swarf_status make_room(simplify_region *r, size_t facets)
{
    r->vertex_count = r->facet_count = r->owned_count = 0;
    r->stamp = 0;
    if (r->facet && facets <= r->room) return SWARF_OK;
    free_region(r);
    const size_t room = facets + facets / 4, vertices = 3 * room;
    r->xyz = malloc(3 * vertices * sizeof *r->xyz);
    r->global = malloc(vertices * sizeof *r->global);
    r->head = malloc(vertices * sizeof *r->head);
    r->state = malloc(vertices);
    r->mark = malloc(vertices * sizeof *r->mark);
    r->need = malloc(vertices * sizeof *r->need);
    r->facet = malloc(room * sizeof *r->facet);
    if (!r->xyz || !r->global || !r->head || !r->state || !r->mark || !r->need || !r->facet) {
        free_region(r);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for simplifying");
    }
    r->room = room;
    return SWARF_OK;
}

static swarf_status simplify_facets(job *j, size_t cube, simplify_region *r)
{
    enum { LEAST = 4 }; /* of fewer none can go */
    const cube_list list = list_of(j, cube);
    cube_memo *memo = j->memo ? &j->memo->cube[cube] : NULL;
    if (list.owned_count < LEAST) {
        if (!memo || !memo->owned) return SWARF_OK; /* nor was anything done before */
        if (j->trusted) make_fresh(j, cube, &list);
        forget_cube(memo);
        return SWARF_OK;
    }
    SWARF_TRY(make_room(r, list.owned_count + list.shared_count));
    if (memo && is_known(j, cube, &list, memo)) {
        settle_known(j, r, cube, &list, memo);
        j->gone[cube] = put_known(j, r, memo, list.owned);
        return SWARF_OK;
    }
    for (; r->owned_count < list.owned_count; r->owned_count++) add_facet(j, r, cube, list.owned[r->owned_count], 0);
    for (size_t i = 0; i < list.shared_count; i++) add_facet(j, r, cube, list.shared[i], 1);
    simplify_or_recall(j, r, cube, &list, memo);
    j->gone[cube] = put_back(r, j->facets->facet);
    for (size_t i = 0; i < r->vertex_count; i++) j->settled[r->global[i]] = r->state[i] == 0;
    return SWARF_OK;
}

static swarf_status simplify_cube(void *context, size_t cube)
{
    job *j = context;
    simplify_region own = {0};
    /* the number of threads may have been raised since the scratch was made */
    const int slot = swarf_parallel_slot();
    const swarf_status status = simplify_facets(j, cube, slot < j->scratch_count ? &j->scratch[slot] : &own);
    free_region(&own);
    return status;
}

static void drop_gone(swarf_facets *facets)
{
    size_t kept = 0;
    for (size_t f = 0; f < facets->facet_count; f++)
        if (facets->facet[f].v[0] != SWARF_NO_VERTEX) facets->facet[kept++] = facets->facet[f];
    facets->facet_count = kept;
}

static void find_bounds(job *j)
{
    float least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < j->facets->vertex_count; i++)
        for (size_t k = 0; k < 3; k++) {
            const float at = j->facets->xyz[3 * i + k];
            least[k] = at < least[k] ? at : least[k];
            most[k] = at > most[k] ? at : most[k];
        }
    for (int k = 0; k < 3; k++) {
        j->least[k] = (double)least[k];
        j->most[k] = (double)most[k];
    }
}

/* Note where the vertices lie, so that the next call can trust those it knows; returns whether this one can. */
static int note_bounds(const job *j, swarf_facets_memo *memo)
{
    const int same = memcmp(memo->least, j->least, sizeof j->least) == 0 && /* the same cubes */
                     memcmp(memo->most, j->most, sizeof j->most) == 0;
    memcpy(memo->least, j->least, sizeof j->least);
    memcpy(memo->most, j->most, sizeof j->most);
    return memo->same && same && j->marks;
}

static void lay_out(job *j, const struct pass *pass, double voxel)
{
    j->edge = pass->edge * voxel;
    for (;;) {
        double cubes = 1;
        for (int k = 0; k < 3; k++) {
            j->count[k] = (size_t)fmin((j->most[k] - j->least[k]) / j->edge + pass->shift + 1, 1e6);
            cubes *= (double)j->count[k];
        }
        if (cubes <= most_cubes) break;
        j->edge *= 1.5;
    }
    for (int k = 0; k < 3; k++) j->lo[k] = j->least[k] - pass->shift * j->edge;
}

/* A memo of other cubes is none. */
static swarf_status lay_out_memo(const job *j, size_t cubes)
{
    pass_memo *memo = j->memo;
    if (!memo || (memo->cube && memo->count == cubes)) return SWARF_OK;
    forget(memo);
    memo->cube = calloc(cubes, sizeof *memo->cube);
    if (!memo->cube) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for simplifying");
    memo->count = cubes;
    return SWARF_OK;
}

static swarf_status sort_facets(job *j, size_t cubes)
{
    j->parts = PARTS * cubes < j->facets->facet_count ? PARTS : 1;
    const size_t begins = cubes * j->parts;
    if (j->memo && j->trusted) {
        j->fresh = calloc(begins, 1);
        if (!j->fresh) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for simplifying");
    }
    j->owned_begin = calloc(begins, sizeof *j->owned_begin);
    j->shared_begin = calloc(begins, sizeof *j->shared_begin);
    if (!j->owned_begin || !j->shared_begin)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for simplifying");
    j->put = 0;
    SWARF_TRY(swarf_parallel_for(j->parts, sort_part, j, NULL, 0, 1));
    const size_t owned = sum_up(j->owned_begin, begins), shared = sum_up(j->shared_begin, begins);
    j->owned = malloc((owned + 1) * sizeof *j->owned);
    j->shared = malloc((shared + 1) * sizeof *j->shared);
    if (!j->owned || !j->shared) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for simplifying");
    j->put = 1;
    return swarf_parallel_for(j->parts, sort_part, j, NULL, 0, 1);
}

static swarf_status run_pass(job *j, const struct pass *pass, double voxel, const swarf_progress *progress, double from,
                             double to, size_t *gone)
{
    lay_out(j, pass, voxel);
    const size_t cubes = j->count[0] * j->count[1] * j->count[2];
    SWARF_TRY(lay_out_memo(j, cubes));
    if (pass == &passes[PASSES - 1]) SWARF_TRY(find_zones(j));
    SWARF_TRY(swarf_parallel_for((j->facets->vertex_count + CHUNK - 1) / CHUNK, find_cubes, j, NULL, 0, 1));
    SWARF_TRY(sort_facets(j, cubes));
    j->gone = calloc(cubes, sizeof *j->gone);
    if (!j->gone) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for simplifying");
    SWARF_TRY(swarf_parallel_for(cubes, simplify_cube, j, progress, from, to));
    *gone = 0;
    for (size_t i = 0; i < cubes; i++) *gone += j->gone[i];
    drop_gone(j->facets);
    return SWARF_OK;
}

static void free_pass(job *j)
{
    free(j->owned_begin);
    free(j->shared_begin);
    free(j->owned);
    free(j->shared);
    free(j->gone);
    free(j->zone);
    free(j->fresh);
    j->zone = j->fresh = NULL;
    j->owned_begin = j->shared_begin = j->gone = NULL;
    j->owned = j->shared = NULL;
}

swarf_status swarf_facets_simplify(swarf_facets *facets, double error_mm, double voxel, size_t budget, uint8_t *marks,
                                   swarf_facets_memo *memo, const swarf_progress *progress, double from, double to)
{
    if (!(error_mm > 0) || facets->facet_count == 0 || (budget && facets->facet_count <= budget)) return SWARF_OK;
    job j = {.facets = facets, .marks = marks};
    j.cube = malloc(facets->vertex_count * sizeof *j.cube);
    j.local = calloc(facets->vertex_count, sizeof *j.local);
    j.settled = malloc(facets->vertex_count);
    j.scratch_count = swarf_threads();
    j.scratch = calloc((size_t)j.scratch_count, sizeof *j.scratch);
    swarf_status status = SWARF_OK;
    if (!j.cube || !j.local || !j.settled || !j.scratch)
        status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for simplifying");
    if (memo && !memo->pass) memo->pass = calloc(PASSES, sizeof *memo->pass);
    if (memo && !memo->pass) status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for simplifying");
    find_bounds(&j);
    j.trusted = memo && !budget && note_bounds(&j, memo);
    const int steps = budget ? ERROR_STEPS : 1;
    double at = from;
    const double part = (to - from) / (steps * PASSES);
    for (int step = 0; step < steps && status == SWARF_OK; step++) {
        j.limit = error_mm * pow(error_step, step - (steps - 1));
        for (int pass = 0; pass < PASSES && status == SWARF_OK; pass++) {
            size_t gone = 0;
            j.first = pass == 0;
            j.memo = memo && !budget && pass < MEMO_PASSES ? &memo->pass[pass] : NULL;
            if (j.first) memset(j.settled, 0, facets->vertex_count);
            status = run_pass(&j, &passes[pass], voxel, progress, at, at + part, &gone);
            free_pass(&j);
            at += part;
            if (budget && facets->facet_count <= budget) break;
        }
        if (budget && facets->facet_count <= budget) break;
    }
    for (int i = 0; j.scratch && i < j.scratch_count; i++) free_region(&j.scratch[i]);
    free(j.scratch);
    free(j.cube);
    free(j.local);
    free(j.settled);
    return status == SWARF_OK ? swarf_facets_compact(facets, marks) : status;
}

void swarf_facets_free(swarf_facets *facets)
{
    free(facets->xyz);
    free(facets->facet);
    memset(facets, 0, sizeof *facets);
}

swarf_status swarf_facets_compact(swarf_facets *facets, uint8_t *marks)
{
    uint32_t *number = malloc((facets->vertex_count + 1) * sizeof *number);
    if (!number) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    memset(number, 0xff, facets->vertex_count * sizeof *number);
    for (size_t f = 0; f < facets->facet_count; f++)
        for (int k = 0; k < 3; k++) number[facets->facet[f].v[k]] = 0;
    size_t kept = 0;
    for (size_t i = 0; i < facets->vertex_count; i++) {
        if (number[i] == SWARF_NO_VERTEX) continue;
        memmove(facets->xyz + 3 * kept, facets->xyz + 3 * i, 3 * sizeof *facets->xyz);
        if (marks) marks[kept] = marks[i];
        number[i] = (uint32_t)kept++;
    }
    facets->vertex_count = kept;
    for (size_t f = 0; f < facets->facet_count; f++)
        for (int k = 0; k < 3; k++) facets->facet[f].v[k] = number[facets->facet[f].v[k]];
    free(number);
    return SWARF_OK;
}
