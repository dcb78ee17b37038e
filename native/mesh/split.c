/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A closed mesh cut by a plane into two closed ones.
 *
 * Vertices are below the plane, above it, or on it (within what floats can tell). Edges from below to above get one new
 * vertex, which both sides share; triangles are cut along them, those in the plane go to the side whose material they
 * bound. What has no neighbour then lies in the plane, goes round, and is closed by a cap. */
#include "base/memory.h"
#include "base/status.h"
#include "base/vector.h"
#include "mesh/halfedge.h"
#include "mesh/mesh.h"
#include "mesh/polygon.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct splitting {
    swarf_triangles t;
    const uint32_t *opposite;
    double point[3], u[3], v[3], n[3]; /* of the plane: u, v, n right-handed, unit */
    double *height;                    /* per vertex, 0: on the plane */
    uint32_t *crossing;                /* per half-edge: its new vertex, the same for both of an edge */
    swarf_mesh_data vertices;          /* old and new */
} splitting;

static swarf_status take_plane(splitting *s, const double point[3], const double normal[3])
{
    SWARF_TRY(swarf_plane_take(point, normal, s->n));
    memcpy(s->point, point, sizeof s->point);
    int least = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(s->n[k]) < fabs(s->n[least])) least = k;
    double axis[3] = {0};
    axis[least] = 1;
    vector_cross(axis, s->n, s->u);
    const double length = sqrt(vector_dot(s->u, s->u));
    for (int k = 0; k < 3; k++) s->u[k] /= length;
    vector_cross(s->n, s->u, s->v);
    return SWARF_OK;
}

static swarf_status find_heights(splitting *s)
{
    double most = 0;
    for (size_t i = 0; i < 3 * s->t.vertex_count; i++) most = fmax(most, fabs((double)s->t.xyz[i]));
    const double on = 2 * FLT_EPSILON * most; /* two steps of the greatest coordinate */
    for (size_t i = 0; i < s->t.vertex_count; i++) {
        const float *p = s->t.xyz + 3 * i;
        const double away[3] = {(double)p[0] - s->point[0], (double)p[1] - s->point[1], (double)p[2] - s->point[2]};
        const double height = vector_dot(away, s->n);
        s->height[i] = fabs(height) <= on ? 0 : height;
        SWARF_TRY(swarf_mesh_data_vertex(&s->vertices, p));
    }
    return SWARF_OK;
}

static uint32_t next_of(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

static swarf_status cut_edges(splitting *s)
{
    const size_t count = 3 * s->t.triangle_count;
    memset(s->crossing, 0xff, count * sizeof *s->crossing);
    for (uint32_t h = 0; h < count; h++) {
        if (s->crossing[h] != UINT32_MAX) continue;
        const uint32_t a = s->t.index[h], b = s->t.index[next_of(h)];
        if (!(s->height[a] * s->height[b] < 0)) continue;
        const double t = s->height[a] / (s->height[a] - s->height[b]);
        float p[3];
        for (size_t k = 0; k < 3; k++) {
            const double from = (double)s->t.xyz[3 * (size_t)a + k], to = (double)s->t.xyz[3 * (size_t)b + k];
            p[k] = (float)(from + t * (to - from));
        }
        s->crossing[h] = (uint32_t)s->vertices.vertex_count;
        if (s->opposite[h] != SWARF_NO_HALFEDGE) s->crossing[s->opposite[h]] = s->crossing[h];
        SWARF_TRY(swarf_mesh_data_vertex(&s->vertices, p));
    }
    return SWARF_OK;
}

/* What of a triangle is on one side (-1 below, 1 above), as a fan. */
static swarf_status keep_triangle(const splitting *s, uint32_t triangle, int way, swarf_mesh_data *out)
{
    uint32_t corner[4];
    int count = 0, beyond = 0, on = 0;
    const uint32_t *own = s->t.index + 3 * (size_t)triangle;
    if (own[0] == own[1] || own[1] == own[2] || own[2] == own[0]) return SWARF_OK;
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        const uint32_t v = s->t.index[h];
        const double height = way * s->height[v];
        if (height >= 0) corner[count++] = v;
        on += height == 0;
        beyond += height > 0;
        if (s->crossing[h] != UINT32_MAX) corner[count++] = s->crossing[h];
    }
    if (on == 3) { /* material lies against the normal */
        double p[3][3], u[3], v[3], normal[3];
        for (size_t i = 0; i < 3; i++)
            for (size_t k = 0; k < 3; k++) p[i][k] = (double)s->t.xyz[3 * (size_t)s->t.index[3 * triangle + i] + k];
        for (int k = 0; k < 3; k++) {
            u[k] = p[1][k] - p[0][k];
            v[k] = p[2][k] - p[0][k];
        }
        vector_cross(u, v, normal);
        if ((vector_dot(normal, s->n) > 0 ? -1 : 1) != way) return SWARF_OK;
    } else if (!beyond) {
        return SWARF_OK;
    }
    for (int i = 2; i < count; i++) SWARF_TRY(swarf_mesh_data_triangle(out, corner[0], corner[i - 1], corner[i]));
    return SWARF_OK;
}

/* ---- the cap ---- */

typedef struct rim {
    uint32_t from, to; /* of an edge of the cap: material's boundary, on its left seen against the side's way out */
    double angle;      /* of its direction in the plane */
    int used;
} rim;

typedef struct rims {
    rim *edge;
    size_t count, room;
    double *points; /* of rings */
    size_t point_room;
    uint32_t *vertex;
    size_t vertex_room, point_count;
    size_t *ends;
    size_t rings, end_room;
} rims;

static void flatten(const splitting *s, uint32_t vertex, int way, double out[2])
{
    const float *p = s->vertices.xyz + 3 * (size_t)vertex;
    const double away[3] = {(double)p[0] - s->point[0], (double)p[1] - s->point[1], (double)p[2] - s->point[2]};
    /* the cap of what is above faces down: seen from there, u and v change places */
    out[0] = vector_dot(away, way < 0 ? s->u : s->v);
    out[1] = vector_dot(away, way < 0 ? s->v : s->u);
}

static int by_from(const void *a, const void *b)
{
    const rim *p = a, *q = b;
    if (p->from != q->from) return p->from < q->from ? -1 : 1;
    if (p->angle != q->angle) return p->angle < q->angle ? -1 : 1;
    return p->to < q->to ? -1 : p->to > q->to;
}

static swarf_status collect_rim(const splitting *s, const swarf_mesh_data *part, int way, rims *r)
{
    const swarf_triangles t = {part->xyz, part->vertex_count, part->index, part->triangle_count};
    uint32_t *opposite;
    SWARF_TRY(swarf_halfedges_create(&t, &opposite));
    swarf_status status = SWARF_OK;
    for (uint32_t h = 0; h < 3 * t.triangle_count && status == SWARF_OK; h++) {
        if (opposite[h] != SWARF_NO_HALFEDGE) continue;
        status = swarf_array_reserve((void **)&r->edge, &r->room, r->count + 1, sizeof *r->edge);
        if (status != SWARF_OK) break;
        rim *edge = &r->edge[r->count++];
        *edge = (rim){.from = t.index[next_of(h)], .to = t.index[h]};
        double a[2], b[2];
        flatten(s, edge->from, way, a);
        flatten(s, edge->to, way, b);
        edge->angle = atan2(b[1] - a[1], b[0] - a[0]);
    }
    free(opposite);
    if (status == SWARF_OK && r->count > 1) qsort(r->edge, r->count, sizeof *r->edge, by_from);
    return status;
}

/* The edge that goes on from where `edge` ends, the one farthest to the left where several do: rings that touch stay
 * apart. NULL where there is none. */
static rim *go_on(rims *r, const rim *edge)
{
    size_t lo = 0, hi = r->count;
    while (lo < hi) {
        const size_t middle = (lo + hi) / 2;
        if (r->edge[middle].from < edge->to)
            lo = middle + 1;
        else
            hi = middle;
    }
    rim *best = NULL;
    double most = -INFINITY;
    for (size_t i = lo; i < r->count && r->edge[i].from == edge->to; i++) {
        if (r->edge[i].used) continue;
        double turn = remainder(r->edge[i].angle - edge->angle, 2 * M_PI); /* to the left, up to straight back */
        if (turn > M_PI - 1e-12) turn = -M_PI;
        if (turn > most) {
            most = turn;
            best = &r->edge[i];
        }
    }
    return best;
}

static swarf_status follow_rim(const splitting *s, int way, rims *r)
{
    for (size_t i = 0; i < r->count; i++) {
        if (r->edge[i].used) continue;
        const uint32_t start = r->edge[i].from;
        for (rim *edge = &r->edge[i]; edge; edge = edge->to == start ? NULL : go_on(r, edge)) {
            edge->used = 1;
            SWARF_TRY(
                swarf_array_reserve((void **)&r->points, &r->point_room, 2 * r->point_count + 2, sizeof *r->points));
            SWARF_TRY(swarf_array_reserve((void **)&r->vertex, &r->vertex_room, r->point_count + 1, sizeof *r->vertex));
            flatten(s, edge->from, way, r->points + 2 * r->point_count);
            r->vertex[r->point_count++] = edge->from;
        }
        SWARF_TRY(swarf_array_reserve((void **)&r->ends, &r->end_room, r->rings + 1, sizeof *r->ends));
        r->ends[r->rings++] = r->point_count;
    }
    return SWARF_OK;
}

static swarf_status put_cap(const splitting *s, int way, rims *r, swarf_mesh_data *part)
{
    SWARF_TRY(collect_rim(s, part, way, r));
    SWARF_TRY(follow_rim(s, way, r));
    if (!r->rings) return SWARF_OK;
    uint32_t *index = NULL;
    size_t triangles;
    SWARF_TRY(swarf_polygon_triangulate(r->points, r->ends, r->rings, &index, &triangles));
    swarf_status status = SWARF_OK;
    for (size_t i = 0; i < triangles && status == SWARF_OK; i++)
        status = swarf_mesh_data_triangle(part, r->vertex[index[3 * i]], r->vertex[index[3 * i + 1]],
                                          r->vertex[index[3 * i + 2]]);
    free(index);
    return status;
}

/* Drop the vertices of the other side. */
static swarf_status drop_unused(swarf_mesh_data *part)
{
    uint32_t *number = malloc((part->vertex_count + 1) * sizeof *number);
    if (!number) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for splitting it");
    memset(number, 0xff, part->vertex_count * sizeof *number);
    for (size_t i = 0; i < 3 * part->triangle_count; i++) number[part->index[i]] = 0;
    size_t kept = 0;
    for (size_t i = 0; i < part->vertex_count; i++) {
        if (number[i] == UINT32_MAX) continue;
        memmove(part->xyz + 3 * kept, part->xyz + 3 * i, 3 * sizeof *part->xyz);
        number[i] = (uint32_t)kept++;
    }
    for (size_t i = 0; i < 3 * part->triangle_count; i++) part->index[i] = number[part->index[i]];
    part->vertex_count = kept;
    free(number);
    return SWARF_OK;
}

static swarf_status make_side(const splitting *s, int way, swarf_mesh **out)
{
    swarf_mesh_data part = {0};
    rims r = {0};
    swarf_status status =
        swarf_array_reserve((void **)&part.xyz, &part.xyz_room, 3 * s->vertices.vertex_count + 3, sizeof *part.xyz);
    if (status == SWARF_OK) {
        if (s->vertices.vertex_count)
            memcpy(part.xyz, s->vertices.xyz, 3 * s->vertices.vertex_count * sizeof *part.xyz);
        part.vertex_count = s->vertices.vertex_count;
    }
    for (uint32_t i = 0; i < s->t.triangle_count && status == SWARF_OK; i++) status = keep_triangle(s, i, way, &part);
    if (status == SWARF_OK) status = put_cap(s, way, &r, &part);
    if (status == SWARF_OK) status = drop_unused(&part);
    free(r.edge);
    free(r.points);
    free(r.vertex);
    free(r.ends);
    if (status == SWARF_OK) return swarf_mesh_adopt(&part, out);
    swarf_mesh_data_free(&part);
    return status;
}

static swarf_status split(splitting *s, swarf_mesh **below, swarf_mesh **above)
{
    SWARF_TRY(find_heights(s));
    SWARF_TRY(cut_edges(s));
    swarf_mesh *low, *high;
    SWARF_TRY(make_side(s, -1, &low));
    const swarf_status status = make_side(s, 1, &high);
    if (status != SWARF_OK) {
        swarf_mesh_release(low);
        return status;
    }
    *below = low;
    *above = high;
    return SWARF_OK;
}

swarf_status swarf_mesh_split(const swarf_mesh *mesh, const double point[3], const double normal[3], swarf_mesh **below,
                              swarf_mesh **above)
{
    SWARF_REQUIRE(mesh && point && normal && below && above, "mesh: NULL");
    splitting s = {.t = swarf_mesh_triangles(mesh)};
    SWARF_TRY(take_plane(&s, point, normal));
    const swarf_topology topology = swarf_mesh_topology(mesh);
    if (s.t.triangle_count && (topology.boundary_edges || topology.misoriented_edges || !topology.closed))
        return swarf_fail(SWARF_ERROR_GEOMETRY, "mesh: only closed meshes can be split; %zu edges are open",
                          topology.boundary_edges);
    uint32_t *opposite;
    SWARF_TRY(swarf_halfedges_create(&s.t, &opposite));
    s.opposite = opposite;
    s.height = malloc((s.t.vertex_count + 1) * sizeof *s.height);
    s.crossing = malloc((3 * s.t.triangle_count + 1) * sizeof *s.crossing);
    const swarf_status status = s.height && s.crossing
                                    ? split(&s, below, above)
                                    : swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for splitting it");
    swarf_mesh_data_free(&s.vertices);
    free(s.height);
    free(s.crossing);
    free(opposite);
    return status;
}
