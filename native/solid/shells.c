/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* One array of edges, sorted, answers everything: an edge used once each way joins two triangles; an edge used more
 * often is where shells touch, and joins only those that would be open there without each other. Sorting is by buckets,
 * one per lowest vertex: they hold half a dozen on usual meshes, so that it takes linear time. */
#include "solid/shells.h"

#include "base/status.h"
#include "base/weld.h"
#include "solid/angle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Use of the edge a < b by a triangle, from a to b (forward) or back. */
typedef struct edge_use {
    uint32_t a, b;
    uint32_t triangle;
    int32_t forward; /* +1 or -1 */
} edge_use;

/* A triangle by its sorted vertices, and which way round it is. */
typedef struct face_key {
    uint32_t v[3];
    uint32_t triangle;
    int32_t even;
} face_key;

typedef struct shell {
    size_t count;
    size_t next; /* where its next triangle goes */
    double volume;
    uint32_t sample; /* one of its triangles */
    double lo[3], hi[3];
} shell;

static int compare_uses(const void *left, const void *right)
{
    const edge_use *l = left, *r = right;
    if (l->b != r->b) return l->b < r->b ? -1 : 1;
    return l->triangle < r->triangle ? -1 : l->triangle > r->triangle;
}

static int compare_faces(const void *left, const void *right)
{
    const face_key *l = left, *r = right;
    for (int k = 1; k < 3; k++)
        if (l->v[k] != r->v[k]) return l->v[k] < r->v[k] ? -1 : 1;
    return l->triangle < r->triangle ? -1 : l->triangle > r->triangle;
}

/* Uses or faces in a bucket beyond which insertion is slower than qsort: the hub of a fan has thousands. */
enum { FEW = 24 };

/* Sort what lies between starts[i] and starts[i + 1] for every i. */
static void sort_buckets(void *items, size_t size, const size_t *starts, size_t buckets,
                         int (*compare)(const void *, const void *))
{
    char keep[sizeof(face_key) > sizeof(edge_use) ? sizeof(face_key) : sizeof(edge_use)];
    for (size_t bucket = 0; bucket < buckets; bucket++) {
        char *const first = (char *)items + starts[bucket] * size;
        const size_t count = starts[bucket + 1] - starts[bucket];
        if (count > FEW) {
            qsort(first, count, size, compare);
            continue;
        }
        for (size_t i = 1; i < count; i++) {
            size_t j = i;
            while (j > 0 && compare(first + (j - 1) * size, first + i * size) > 0) j--;
            if (j == i) continue;
            memcpy(keep, first + i * size, size);
            memmove(first + (j + 1) * size, first + j * size, (i - j) * size);
            memcpy(first + j * size, keep, size);
        }
    }
}

/* From numbers per bucket (one place up) to where each starts. */
static void add_up(size_t *starts, size_t buckets)
{
    for (size_t i = 0; i < buckets; i++) starts[i + 1] += starts[i];
}

static swarf_status check_input(const swarf_triangles *t)
{
    SWARF_REQUIRE(t && (t->xyz || !t->vertex_count) && (t->index || !t->triangle_count), "mesh: arrays missing");
    for (size_t i = 0; i < 3 * t->vertex_count; i++)
        SWARF_REQUIRE(isfinite(t->xyz[i]), "mesh: coordinate %c of vertex %zu is not finite", "xyz"[i % 3], i / 3);
    for (size_t i = 0; i < 3 * t->triangle_count; i++)
        SWARF_REQUIRE(t->index[i] < t->vertex_count, "mesh: triangle %zu uses vertex %u of %zu", i / 3, t->index[i],
                      t->vertex_count);
    SWARF_REQUIRE(t->triangle_count < UINT32_MAX / 3, "mesh: %zu triangles are too many", t->triangle_count);
    if (t->triangle_count == 0) return swarf_fail(SWARF_ERROR_GEOMETRY, "mesh: no triangles");
    return SWARF_OK;
}

static swarf_status copy_welded(const swarf_triangles *t, swarf_shells *s)
{
    s->xyz = malloc(3 * t->vertex_count * sizeof *s->xyz);
    s->index = malloc(3 * t->triangle_count * sizeof *s->index);
    s->source = malloc(t->triangle_count * sizeof *s->source);
    uint32_t *map = malloc(t->vertex_count * sizeof *map);
    swarf_status status = SWARF_OK;
    if (!s->xyz || !s->index || !s->source || !map) status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    if (status == SWARF_OK) {
        memcpy(s->xyz, t->xyz, 3 * t->vertex_count * sizeof *s->xyz);
        status = swarf_weld(s->xyz, t->vertex_count, map, &s->vertex_count);
    }
    for (size_t i = 0; i < t->triangle_count && status == SWARF_OK; i++) {
        uint32_t *v = s->index + 3 * s->triangle_count;
        for (int k = 0; k < 3; k++) v[k] = map[t->index[3 * i + (size_t)k]];
        s->source[s->triangle_count] = (uint32_t)i;
        if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) s->triangle_count++;
    }
    free(map);
    return status;
}

static void swap(uint32_t *a, uint32_t *b, int32_t *even)
{
    if (*a <= *b) return;
    const uint32_t keep = *a;
    *a = *b;
    *b = keep;
    *even = !*even;
}

static face_key key_of(const swarf_shells *s, size_t triangle)
{
    face_key key = {.triangle = (uint32_t)triangle, .even = 1};
    memcpy(key.v, s->index + 3 * triangle, sizeof key.v);
    swap(&key.v[0], &key.v[1], &key.even);
    swap(&key.v[1], &key.v[2], &key.even);
    swap(&key.v[0], &key.v[1], &key.even);
    return key;
}

/* Faces by their vertices, so that those on the same three are neighbours. */
static face_key *sorted_faces(const swarf_shells *s, size_t *starts)
{
    face_key *keys = calloc(s->triangle_count + 1, sizeof *keys);
    if (!keys) return NULL;
    memset(starts, 0, (s->vertex_count + 2) * sizeof *starts);
    for (size_t i = 0; i < s->triangle_count; i++) starts[(size_t)key_of(s, i).v[0] + 2]++;
    add_up(starts + 1, s->vertex_count);
    for (size_t i = 0; i < s->triangle_count; i++) {
        const face_key key = key_of(s, i);
        keys[starts[(size_t)key.v[0] + 1]++] = key;
    }
    sort_buckets(keys, sizeof *keys, starts, s->vertex_count, compare_faces);
    return keys;
}

/* Of triangles on the same three vertices keep those of the side that is in the majority, as many as it is ahead: one
 * of them, or with `copies` all. *doubled is how many were one too many. */
static swarf_status drop_duplicates(swarf_shells *s, int copies, size_t *starts, size_t *doubled)
{
    const size_t count = s->triangle_count;
    unsigned char *keep = calloc(count + 1, 1);
    face_key *keys = keep ? sorted_faces(s, starts) : NULL;
    if (!keys) {
        free(keep);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    }
    for (size_t i = 0, j; i < count; i = j) {
        ptrdiff_t balance = 0;
        for (j = i; j < count && memcmp(keys[j].v, keys[i].v, sizeof keys[i].v) == 0; j++)
            balance += keys[j].even ? 1 : -1;
        const ptrdiff_t ahead = balance < 0 ? -balance : balance;
        ptrdiff_t wanted = copies || ahead == 0 ? ahead : 1;
        *doubled += (size_t)(ahead - wanted);
        for (size_t k = i; k < j && wanted > 0; k++)
            if (keys[k].even == (balance > 0)) {
                keep[keys[k].triangle] = 1;
                wanted--;
            }
    }
    s->triangle_count = 0;
    for (size_t i = 0; i < count; i++) {
        if (!keep[i]) continue;
        s->source[s->triangle_count] = s->source[i];
        memmove(s->index + 3 * s->triangle_count++, s->index + 3 * i, 3 * sizeof *s->index);
    }
    free(keys);
    free(keep);
    return SWARF_OK;
}

static edge_use *sorted_uses(const swarf_shells *s, size_t *starts)
{
    const size_t count = 3 * s->triangle_count;
    edge_use *uses = malloc((count + 1) * sizeof *uses);
    if (!uses) return NULL;
    memset(starts, 0, (s->vertex_count + 2) * sizeof *starts);
    for (size_t i = 0; i < count; i++) {
        const uint32_t a = s->index[i], b = s->index[i - i % 3 + (i + 1) % 3];
        starts[(size_t)(a < b ? a : b) + 2]++;
    }
    add_up(starts + 1, s->vertex_count);
    for (size_t i = 0; i < count; i++) {
        const uint32_t a = s->index[i], b = s->index[i - i % 3 + (i + 1) % 3], t = (uint32_t)(i / 3);
        uses[starts[(size_t)(a < b ? a : b) + 1]++] = a < b ? (edge_use){a, b, t, 1} : (edge_use){b, a, t, -1};
    }
    sort_buckets(uses, sizeof *uses, starts, s->vertex_count, compare_uses);
    return uses;
}

static size_t end_of_edge(const edge_use *uses, size_t first, size_t count)
{
    size_t end = first + 1;
    while (end < count && uses[end].a == uses[first].a && uses[end].b == uses[first].b) end++;
    return end;
}

static double edge_length(const swarf_shells *s, const edge_use *use)
{
    double square = 0;
    for (size_t c = 0; c < 3; c++) {
        const double along = (double)s->xyz[3 * (size_t)use->b + c] - s->xyz[3 * (size_t)use->a + c];
        square += along * along;
    }
    return sqrt(square);
}

static swarf_status check_edges(swarf_shells *s, const edge_use *uses, double hole_share)
{
    size_t first = SIZE_MAX;
    double length = 0;
    const size_t count = 3 * s->triangle_count;
    for (size_t i = 0, j; i < count; i = j) {
        int balance = 0;
        j = end_of_edge(uses, i, count);
        for (size_t k = i; k < j; k++) balance += uses[k].forward;
        if (balance == 0) continue;
        if ((j - i) % 2)
            s->open_edges++;
        else
            s->turned_edges++;
        length += edge_length(s, &uses[i]);
        if (first == SIZE_MAX) first = i;
    }
    if (first == SIZE_MAX) return SWARF_OK;
    s->hole_mm2 = length * length / (4 * 3.14159265358979323846); /* no loop of this length bounds more */
    if (s->hole_mm2 <= hole_share * s->area_mm2) return SWARF_OK;
    double middle[3];
    for (int c = 0; c < 3; c++)
        middle[c] = 0.5 * ((double)s->xyz[3 * (size_t)uses[first].a + (size_t)c] +
                           s->xyz[3 * (size_t)uses[first].b + (size_t)c]);
    return swarf_fail(SWARF_ERROR_GEOMETRY,
                      "mesh: not closed: %zu open edges and %zu between triangles turned different ways, the first at "
                      "(%.6g, %.6g, %.6g) mm; %s needs a closed surface",
                      s->open_edges, s->turned_edges, middle[0], middle[1], middle[2],
                      hole_share > 0 ? "telling in from out" : "a stock");
}

static size_t edge_number(const swarf_shells *s, const edge_use *use)
{
    const uint32_t *v = s->index + 3 * (size_t)use->triangle, from = use->forward > 0 ? use->a : use->b;
    return 3 * (size_t)use->triangle + (v[0] == from ? 0 : v[1] == from ? 1 : 2);
}

static swarf_status find_across(swarf_shells *s, const edge_use *uses)
{
    const size_t count = 3 * s->triangle_count;
    s->across = malloc((count + 1) * sizeof *s->across);
    if (!s->across) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    memset(s->across, 0xff, count * sizeof *s->across);
    for (size_t i = 0, j; i < count; i = j) {
        j = end_of_edge(uses, i, count);
        if (j - i != 2 || uses[i].forward == uses[i + 1].forward) continue;
        s->across[edge_number(s, &uses[i])] = uses[i + 1].triangle;
        s->across[edge_number(s, &uses[i + 1])] = uses[i].triangle;
    }
    return SWARF_OK;
}

static uint32_t find_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/* The smaller number becomes the root, so that the result does not depend on the order of joins. */
static void join(uint32_t *parent, uint32_t i, uint32_t j)
{
    i = find_root(parent, i);
    j = find_root(parent, j);
    if (i < j)
        parent[j] = i;
    else
        parent[i] = j;
}

static void join_shells(const edge_use *uses, size_t count, uint32_t *parent)
{
    for (size_t i = 0, j; i < count; i = j) {
        j = end_of_edge(uses, i, count);
        if (j - i == 2) join(parent, uses[i].triangle, uses[i + 1].triangle);
    }
    /* now edges where shells touch: those that are not balanced there on their own belong together */
    for (size_t i = 0, j; i < count; i = j) {
        j = end_of_edge(uses, i, count);
        if (j - i == 2) continue;
        uint32_t unbalanced = UINT32_MAX;
        for (size_t k = i; k < j; k++) {
            int balance = 0;
            for (size_t m = i; m < j; m++)
                if (find_root(parent, uses[m].triangle) == find_root(parent, uses[k].triangle))
                    balance += uses[m].forward;
            if (balance == 0) continue;
            if (unbalanced == UINT32_MAX)
                unbalanced = uses[k].triangle;
            else
                join(parent, unbalanced, uses[k].triangle);
        }
    }
}

static double six_volume(const swarf_shells *s, size_t triangle)
{
    double p[3][3];
    for (size_t k = 0; k < 3; k++)
        for (size_t c = 0; c < 3; c++) /* relative to a vertex, so that far away parts lose no digits */
            p[k][c] = (double)s->xyz[3 * (size_t)s->index[3 * triangle + k] + c] - s->xyz[c];
    return p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
           p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
}

/* A cavity counts only inside a solid: the winding number of all other shells there must be one or more. */
static swarf_status check_cavity(const swarf_shells *s, const uint32_t *shell_of, const shell *shells, uint32_t number)
{
    double point[3] = {0, 0, 0}, angle = 0;
    for (size_t k = 0; k < 3; k++)
        for (size_t c = 0; c < 3; c++)
            point[c] += s->xyz[3 * (size_t)s->index[3 * (size_t)shells[number].sample + k] + c] / 3.0;
    for (size_t i = 0; i < s->triangle_count; i++) {
        const shell *other = &shells[shell_of[i]];
        int around = shell_of[i] != number;
        for (int c = 0; c < 3; c++) around &= point[c] >= other->lo[c] && point[c] <= other->hi[c];
        if (!around) continue;
        double p[3][3];
        for (size_t k = 0; k < 3; k++)
            for (size_t c = 0; c < 3; c++) p[k][c] = s->xyz[3 * (size_t)s->index[3 * i + k] + c] - point[c];
        angle += swarf_solid_angle(p);
    }
    if (angle > 2 * 3.14159265358979323846) return SWARF_OK; /* halfway to the full turn of 4 pi */
    return swarf_fail(SWARF_ERROR_GEOMETRY,
                      "mesh: the shell at (%.6g, %.6g, %.6g) mm is inside out and in no solid; turn its triangles",
                      point[0], point[1], point[2]);
}

static int compare_shells(const void *left, const void *right)
{
    const shell *l = left, *r = right;
    const double a = fabs(l->volume), b = fabs(r->volume);
    if (a != b) return a > b ? -1 : 1;
    return l->sample < r->sample ? -1 : l->sample > r->sample;
}

/* Shells in order of size; afterwards shell_of names places in that order. */
static swarf_status gather_shells(const swarf_shells *s, uint32_t *parent, shell **out, size_t *out_count)
{
    size_t used = 0;
    for (size_t i = 0; i < s->triangle_count; i++) used += find_root(parent, (uint32_t)i) == i;
    shell *shells = calloc(used + 1, sizeof *shells);
    uint32_t *place = malloc((s->triangle_count + 1) * sizeof *place);
    if (!shells || !place) {
        free(shells);
        free(place);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    }
    used = 0;
    for (size_t i = 0; i < s->triangle_count; i++) {
        const uint32_t root = find_root(parent, (uint32_t)i); /* never above i */
        if (root == i) {
            place[i] = (uint32_t)used;
            shells[used++] =
                (shell){.sample = root, .lo = {INFINITY, INFINITY, INFINITY}, .hi = {-INFINITY, -INFINITY, -INFINITY}};
        }
        shell *own = &shells[place[root]];
        own->count++;
        own->volume += six_volume(s, i) / 6;
        for (size_t k = 0; k < 3; k++)
            for (size_t c = 0; c < 3; c++) {
                const double x = s->xyz[3 * (size_t)s->index[3 * i + k] + c];
                own->lo[c] = fmin(own->lo[c], x);
                own->hi[c] = fmax(own->hi[c], x);
            }
    }
    qsort(shells, used, sizeof *shells, compare_shells);
    for (size_t i = 0; i < used; i++) place[shells[i].sample] = (uint32_t)i;
    for (size_t i = s->triangle_count; i-- > 0;) parent[i] = place[find_root(parent, (uint32_t)i)];
    free(place);
    *out = shells;
    *out_count = used;
    return SWARF_OK;
}

/* Put the triangles in the order of their shells and join neighbours of one kind. */
static swarf_status make_runs(swarf_shells *s, const uint32_t *shell_of, shell *shells, size_t count)
{
    uint32_t *index = malloc((3 * s->triangle_count + 1) * sizeof *index);
    uint32_t *source = malloc((s->triangle_count + 1) * sizeof *source);
    uint32_t *across = malloc((3 * s->triangle_count + 1) * sizeof *across);
    uint32_t *places = malloc((s->triangle_count + 1) * sizeof *places);
    s->runs = malloc(count * sizeof *s->runs);
    if (!index || !source || !across || !places || !s->runs) {
        free(index);
        free(source);
        free(across);
        free(places);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    }
    size_t first = 0;
    for (size_t i = 0; i < count; i++) {
        const int cavity = shells[i].volume < 0;
        if (s->run_count == 0 || s->runs[s->run_count - 1].cavity != cavity)
            s->runs[s->run_count++] = (swarf_shell_run){first, 0, cavity};
        s->runs[s->run_count - 1].count += shells[i].count;
        shells[i].next = first;
        first += shells[i].count;
    }
    for (size_t i = 0; i < s->triangle_count; i++) places[i] = (uint32_t)shells[shell_of[i]].next++;
    for (size_t i = 0; i < s->triangle_count; i++) {
        memcpy(index + 3 * (size_t)places[i], s->index + 3 * i, 3 * sizeof *index);
        source[places[i]] = s->source[i];
        for (size_t k = 0; k < 3; k++) {
            const uint32_t other = s->across[3 * i + k];
            across[3 * (size_t)places[i] + k] = other == UINT32_MAX ? UINT32_MAX : places[other];
        }
    }
    free(s->index);
    free(s->source);
    free(s->across);
    free(places);
    s->index = index;
    s->source = source;
    s->across = across;
    return SWARF_OK;
}

static swarf_status split(swarf_shells *s, uint32_t *parent)
{
    shell *shells = NULL;
    size_t count = 0;
    SWARF_TRY(gather_shells(s, parent, &shells, &count));
    swarf_status status = SWARF_OK;
    for (size_t i = 0; i < count && status == SWARF_OK; i++)
        if (shells[i].volume < 0) status = check_cavity(s, parent, shells, (uint32_t)i);
    if (status == SWARF_OK) status = make_runs(s, parent, shells, count);
    free(shells);
    return status;
}

/* Volume, area and box. */
static void measure(swarf_shells *s)
{
    s->box = (swarf_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = 0; i < s->triangle_count; i++) {
        double p[3][3], u[3], v[3];
        for (size_t k = 0; k < 3; k++)
            for (size_t c = 0; c < 3; c++) {
                p[k][c] = s->xyz[3 * (size_t)s->index[3 * i + k] + c];
                s->box.lo[c] = fmin(s->box.lo[c], p[k][c]);
                s->box.hi[c] = fmax(s->box.hi[c], p[k][c]);
            }
        for (size_t c = 0; c < 3; c++) {
            u[c] = p[1][c] - p[0][c];
            v[c] = p[2][c] - p[0][c];
        }
        s->area_mm2 +=
            0.5 * hypot(hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2]), u[0] * v[1] - u[1] * v[0]);
        s->volume_mm3 += six_volume(s, i) / 6;
    }
}

static swarf_status check_volume(const swarf_shells *s)
{
    if (s->volume_mm3 > 0) return SWARF_OK;
    return swarf_fail(SWARF_ERROR_GEOMETRY,
                      s->volume_mm3 < 0 ? "mesh: inside out (volume %g mm3): turn its triangles round"
                                        : "mesh: encloses no volume (%g mm3)",
                      s->volume_mm3);
}

static swarf_status make_one_run(swarf_shells *s)
{
    s->runs = malloc(sizeof *s->runs);
    if (!s->runs) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    s->runs[0] = (swarf_shell_run){0, s->triangle_count, 0};
    s->run_count = 1;
    return SWARF_OK;
}

static swarf_status check_and_split(swarf_shells *s, double hole_share, size_t *starts)
{
    edge_use *uses = sorted_uses(s, starts);
    uint32_t *parent = malloc((s->triangle_count + 1) * sizeof *parent);
    swarf_status status = SWARF_OK;
    if (!uses || !parent) status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    if (status == SWARF_OK) status = check_edges(s, uses, hole_share);
    if (status == SWARF_OK) status = check_volume(s);
    if (status == SWARF_OK) status = find_across(s, uses);
    const int holes = s->open_edges || s->turned_edges;
    if (status == SWARF_OK && !holes) {
        for (size_t i = 0; i < s->triangle_count; i++) parent[i] = (uint32_t)i;
        join_shells(uses, 3 * s->triangle_count, parent);
    }
    free(uses);
    if (status == SWARF_OK) status = holes ? make_one_run(s) : split(s, parent);
    free(parent);
    return status;
}

static swarf_status make(const swarf_triangles *triangles, double hole_share, int copies, size_t *doubled,
                         swarf_shells *out)
{
    swarf_shells shells;
    memset(&shells, 0, sizeof shells);
    size_t *starts = NULL; /* of buckets */
    swarf_status status = copy_welded(triangles, &shells);
    if (status == SWARF_OK && !(starts = malloc((shells.vertex_count + 2) * sizeof *starts)))
        status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    if (status == SWARF_OK) status = drop_duplicates(&shells, copies, starts, doubled);
    if (status == SWARF_OK) measure(&shells);
    if (status == SWARF_OK) status = check_and_split(&shells, hole_share, starts);
    free(starts);
    if (status != SWARF_OK)
        swarf_shells_free(&shells);
    else
        *out = shells;
    return status;
}

swarf_status swarf_shells_create(const swarf_triangles *triangles, double hole_share, swarf_shells *out)
{
    SWARF_TRY(check_input(triangles));
    swarf_shells shells, other;
    size_t doubled = 0, none = 0;
    const swarf_status status = make(triangles, hole_share, 0, &doubled, &shells);
    /* A triangle given twice by mistake is one too many; where two shells have it in common both need it. */
    const int open =
        status == SWARF_ERROR_GEOMETRY || (status == SWARF_OK && (shells.open_edges || shells.turned_edges));
    if (doubled && open) {
        char text[SWARF_ERROR_SIZE];
        snprintf(text, sizeof text, "%s", swarf_error_last());
        if (make(triangles, 0, 1, &none, &other) == SWARF_OK) {
            if (status == SWARF_OK) swarf_shells_free(&shells);
            *out = other;
            return SWARF_OK;
        }
        if (status != SWARF_OK) return swarf_fail(status, "%s", text); /* what is wrong with the mesh as it is */
    }
    if (status == SWARF_OK) *out = shells;
    return status;
}

void swarf_shells_free(swarf_shells *shells)
{
    free(shells->xyz);
    free(shells->index);
    free(shells->source);
    free(shells->across);
    free(shells->runs);
    memset(shells, 0, sizeof *shells);
}
