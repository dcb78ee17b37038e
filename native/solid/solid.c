/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "solid/solid.h"

#include "base/parallel.h"
#include "base/status.h"
#include "base/vector.h"
#include "solid/shells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A hole may bound this share of the area: a winding number off by a hundredth of a turn leaves no doubt. */
static const double most_hole_share = 0.01;

/* Below this cosine between a pseudonormal and the way to the point rounding could turn the sign. */
static const double least_cosine = 0.02;

/* Two triangles fold back onto each other when the sum of their unit normals is shorter than this. */
static const double least_fold = 0.1;

/* Vertices that one piece of work looks at. */
enum { CHUNK = 4096 };

/* Unit normal of a triangle; 0 where it has none. */
static int unit_normal(const swarf_corners *t, double out[3])
{
    swarf_corners_normal(t, out);
    const double length = sqrt(vector_dot(out, out));
    if (!(length > 0)) return 0;
    for (int k = 0; k < 3; k++) out[k] /= length;
    return 1;
}

static double corner_angle(const swarf_corners *t, int corner)
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)t->xyz[(corner + 1) % 3][k] - t->xyz[corner][k];
        v[k] = (double)t->xyz[(corner + 2) % 3][k] - t->xyz[corner][k];
    }
    double n[3];
    for (int k = 0; k < 3; k++) n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    return atan2(sqrt(vector_dot(n, n)), vector_dot(u, v));
}

struct vertex_work {
    swarf_solid *solid;
    const uint32_t *first; /* a place at each vertex */
    const uint32_t *used;  /* number of places at each vertex */
};

/* Sum the normals round a vertex, walking from triangle to triangle; 0 when the walk does not meet all of them once, or
 * passes a fold. */
static int sum_normals(const struct vertex_work *work, size_t vertex, double sum[3])
{
    const swarf_solid *solid = work->solid;
    double last[3], angle = 0;
    uint32_t place = work->first[vertex];
    for (uint32_t count = 0; count < work->used[vertex]; count++) {
        if (place == UINT32_MAX || (count > 0 && place == work->first[vertex])) return 0;
        const uint32_t *v = solid->vertex[place];
        const int corner = v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
        double normal[3];
        if (!unit_normal(&solid->corners[place], normal)) return 0;
        if (count > 0 && vector_dot(last, normal) < 0.5 * least_fold * least_fold - 1) return 0;
        const double own = corner_angle(&solid->corners[place], corner);
        angle += own;
        for (int k = 0; k < 3; k++) sum[k] += own * normal[k];
        memcpy(last, normal, sizeof last);
        place = solid->across[place][(corner + 2) % 3];
    }
    return place == work->first[vertex] && sqrt(vector_dot(sum, sum)) > least_fold * angle;
}

static swarf_status make_normals(void *context, size_t index)
{
    const struct vertex_work *work = context;
    const size_t end =
        (index + 1) * CHUNK < work->solid->vertex_count ? (index + 1) * CHUNK : work->solid->vertex_count;
    for (size_t vertex = index * CHUNK; vertex < end; vertex++) {
        double sum[3] = {0, 0, 0};
        const int told = sum_normals(work, vertex, sum);
        const double length = sqrt(vector_dot(sum, sum));
        for (int k = 0; k < 3; k++) work->solid->normal[vertex][k] = told ? (float)(sum[k] / length) : 0;
    }
    return SWARF_OK;
}

static swarf_status find_normals(swarf_solid *solid, const swarf_progress *progress, double from, double to)
{
    uint32_t *first = malloc(solid->vertex_count * sizeof *first), *used = calloc(solid->vertex_count, sizeof *used);
    swarf_status status = SWARF_OK;
    if (!first || !used) status = swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory");
    for (size_t place = 0; place < solid->tree.count && status == SWARF_OK; place++)
        for (int k = 0; k < 3; k++) {
            first[solid->vertex[place][k]] = (uint32_t)place;
            used[solid->vertex[place][k]]++;
        }
    struct vertex_work work = {solid, first, used};
    if (status == SWARF_OK)
        status = swarf_parallel_for((solid->vertex_count + CHUNK - 1) / CHUNK, make_normals, &work, progress, from, to);
    free(first);
    free(used);
    return status;
}

/* Everything by place in the tree. */
static swarf_status take_shells(swarf_solid *solid, const swarf_shells *shells, const swarf_progress *progress,
                                double from, double to)
{
    const size_t count = shells->triangle_count;
    uint32_t *places = malloc(count * sizeof *places);
    solid->corners = malloc(count * sizeof *solid->corners);
    solid->source = malloc(count * sizeof *solid->source);
    solid->vertex = malloc(count * sizeof *solid->vertex);
    solid->across = malloc(count * sizeof *solid->across);
    solid->state = calloc(count, sizeof *solid->state);
    solid->vertex_count = shells->vertex_count;
    solid->normal = malloc(shells->vertex_count * sizeof *solid->normal);
    swarf_status status = SWARF_OK;
    if (!places || !solid->corners || !solid->source || !solid->vertex || !solid->across || !solid->state ||
        !solid->normal)
        status = swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory for %zu triangles", count);
    for (size_t i = 0; i < count && status == SWARF_OK; i++) {
        solid->source[i] = (uint32_t)i;
        for (size_t k = 0; k < 3; k++)
            memcpy(solid->corners[i].xyz[k], shells->xyz + 3 * (size_t)shells->index[3 * i + k],
                   sizeof solid->corners[i].xyz[k]);
    }
    if (status == SWARF_OK)
        status = swarf_box_tree_build(solid->corners, solid->source, count, progress, from, to, &solid->tree);
    if (status == SWARF_OK) {
        for (size_t place = 0; place < count; place++) places[solid->source[place]] = (uint32_t)place;
        for (size_t place = 0; place < count; place++) {
            const size_t i = solid->source[place];
            memcpy(solid->vertex[place], shells->index + 3 * i, sizeof solid->vertex[place]);
            for (size_t k = 0; k < 3; k++) {
                const uint32_t other = shells->across[3 * i + k];
                solid->across[place][k] = other == UINT32_MAX ? UINT32_MAX : places[other];
            }
            solid->source[place] = shells->source[i];
        }
        solid->all = solid->tree;
        solid->all_corners = solid->corners;
    }
    free(places);
    return status;
}

static swarf_status create(swarf_solid *solid, const swarf_triangles *triangles, double hole_share,
                           const swarf_progress *progress, double from, double to)
{
    swarf_shells shells;
    SWARF_TRY(swarf_shells_create(triangles, hole_share, &shells));
    solid->facts = (swarf_solid_facts){.volume_mm3 = shells.volume_mm3,
                                       .area_mm2 = shells.area_mm2,
                                       .box = shells.box,
                                       .open_edges = shells.open_edges,
                                       .turned_edges = shells.turned_edges,
                                       .hole_mm2 = shells.hole_mm2};
    solid->source_count = triangles->triangle_count;
    solid->open = shells.open_edges || shells.turned_edges;
    const double part = (to - from) / 4;
    swarf_status status = take_shells(solid, &shells, progress, from + part, from + 2 * part);
    swarf_shells_free(&shells);
    if (status == SWARF_OK) status = find_normals(solid, progress, from + 2 * part, from + 3 * part);
    if (status == SWARF_OK) status = swarf_solid_find_bounds(solid, progress, from + 3 * part, to);
    solid->facts.dropped_triangles = triangles->triangle_count - solid->facts.triangle_count;
    return status;
}

swarf_status swarf_solid_make(const swarf_triangles *triangles, double hole_share, const swarf_progress *progress,
                              double from, double to, swarf_solid **out)
{
    swarf_solid *solid = calloc(1, sizeof *solid);
    if (!solid) return swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory");
    solid->references = 1;
    const swarf_status status = create(solid, triangles, hole_share, progress, from, to);
    if (status != SWARF_OK) {
        swarf_solid_release(solid);
        return status;
    }
    *out = solid;
    return SWARF_OK;
}

swarf_status swarf_solid_create(const swarf_triangles *triangles, const swarf_progress *progress, swarf_solid **out)
{
    SWARF_REQUIRE(triangles && out, "solid: triangles or output missing");
    return swarf_solid_make(triangles, most_hole_share, progress, 0, 1, out);
}

swarf_solid *swarf_solid_retain(swarf_solid *solid)
{
    if (solid) __atomic_add_fetch(&solid->references, 1, __ATOMIC_RELAXED);
    return solid;
}

void swarf_solid_release(swarf_solid *solid)
{
    if (!solid || __atomic_sub_fetch(&solid->references, 1, __ATOMIC_ACQ_REL) > 0) return;
    if (solid->all_corners != solid->corners) {
        swarf_box_tree_free(&solid->all);
        free(solid->all_corners);
    }
    swarf_box_tree_free(&solid->tree);
    free(solid->corners);
    free(solid->source);
    free(solid->vertex);
    free(solid->across);
    free(solid->state);
    free(solid->normal);
    free(solid);
}

swarf_solid_facts swarf_solid_get_facts(const swarf_solid *solid)
{
    return solid ? solid->facts : (swarf_solid_facts){0};
}

int swarf_solid_inside(const swarf_solid *solid, const double point[3])
{
    return swarf_box_tree_winding(&solid->all, solid->all_corners, point) > 0.5;
}

/* Cosine between the pseudonormal of a feature and the way from it to the point; 0 where nothing can be told. */
static double feature_cosine(const swarf_solid *solid, const double point[3], const swarf_nearest *nearest)
{
    const size_t place = nearest->place;
    const double way[3] = {point[0] - nearest->point[0], point[1] - nearest->point[1], point[2] - nearest->point[2]};
    const double away = sqrt(vector_dot(way, way));
    double normal[3];
    if (solid->open || solid->state[place] == SOLID_SLIVER) return 0;
    if (solid->state[place] == SOLID_PIECE && nearest->feature != 0) return 0;
    if (nearest->feature >= 1 && nearest->feature <= 3) {
        const float *own = solid->normal[solid->vertex[place][nearest->feature - 1]];
        for (int k = 0; k < 3; k++) normal[k] = own[k];
        return vector_dot(normal, way) / away;
    }
    if (!unit_normal(&solid->corners[place], normal)) return 0;
    if (nearest->feature == 0) { /* the way stands on the plane: only its side is in question */
        double side = 0;
        for (int k = 0; k < 3; k++) side += normal[k] * (point[k] - solid->corners[place].xyz[0][k]);
        return side < 0 ? -1 : 1;
    }
    const uint32_t other = solid->across[place][nearest->feature - 4];
    double beyond[3];
    if (other == UINT32_MAX || !unit_normal(&solid->corners[other], beyond)) return 0;
    for (int k = 0; k < 3; k++) normal[k] += beyond[k];
    const double length = sqrt(vector_dot(normal, normal));
    return length > least_fold ? vector_dot(normal, way) / (length * away) : 0;
}

double swarf_solid_sign(const swarf_solid *solid, const double point[3], const swarf_nearest *nearest)
{
    if (nearest->square == 0) return 1; /* on it */
    const double cosine = feature_cosine(solid, point, nearest);
    if (fabs(cosine) >= least_cosine) return cosine > 0 ? 1 : -1;
    return swarf_solid_inside(solid, point) ? -1 : 1;
}

void swarf_solid_nearest(const swarf_solid *solid, const double point[3], double reach, swarf_nearest *out)
{
    *out = (swarf_nearest){.square = reach * reach, .place = SIZE_MAX};
    swarf_box_tree_nearest(&solid->tree, solid->corners, point, out);
}

void swarf_solid_measure(const swarf_solid *solid, const double (*point)[3], size_t count, double *distance,
                         size_t *place)
{
    swarf_nearby nearby;
    swarf_nearby_begin(&solid->tree, solid->corners, &nearby);
    for (size_t i = 0, end = 0; i < count; i++) {
        if (i == end) end += swarf_nearby_enter_points(&nearby, point + i, count - i);
        swarf_nearest nearest;
        swarf_nearby_find(&nearby, point[i], &nearest);
        place[i] = nearest.place;
        distance[i] = sqrt(nearest.square) * swarf_solid_sign(solid, point[i], &nearest);
    }
}

struct distance_work {
    const swarf_solid *solid;
    const double *points;
    size_t count;
    double *distance;
    uint32_t *triangle;
};

static swarf_status measure_points(void *context, size_t index)
{
    const struct distance_work *work = context;
    const size_t first = index * SOLID_BATCH;
    const size_t count = work->count - first < SOLID_BATCH ? work->count - first : SOLID_BATCH;
    size_t place[SOLID_BATCH];
    swarf_solid_measure(work->solid, (const double(*)[3])work->points + first, count, work->distance + first, place);
    for (size_t i = 0; work->triangle && i < count; i++) work->triangle[first + i] = work->solid->source[place[i]];
    return SWARF_OK;
}

swarf_status swarf_solid_distance(const swarf_solid *solid, const double *points, size_t count,
                                  const swarf_progress *progress, double *distance, uint32_t *triangle)
{
    SWARF_REQUIRE(solid && ((points && distance) || count == 0), "solid: solid, points or output missing");
    for (size_t i = 0; i < 3 * count; i++)
        SWARF_REQUIRE(isfinite(points[i]), "solid: coordinate %c of point %zu is not finite", "xyz"[i % 3], i / 3);
    struct distance_work work = {solid, points, count, distance, triangle};
    return swarf_parallel_for((count + SOLID_BATCH - 1) / SOLID_BATCH, measure_points, &work, progress, 0, 1);
}
