/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Where a plane cuts a mesh: closed polygons, material on the left seen against the plane's normal.
 *
 * Vertices in the plane count as above it, or all as below where nothing is cut then, as by the plane of a bottom. So
 * every triangle is cut in no edge or in two: one on which the outline comes in (half-edge from above to below) and one
 * on which it goes on to the neighbour. */
#include "base/memory.h"
#include "base/status.h"
#include "base/vector.h"
#include "mesh/halfedge.h"
#include "mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* mm: points this close are one, and curves that come back this close to themselves all along are none. */
static const double apart = 1e-6;

struct swarf_outline {
    double *points;
    size_t point_count, point_room;
    size_t *ends;
    size_t count, end_room;
};

typedef struct cutting {
    swarf_triangles t;
    const uint32_t *opposite;
    const double *point, *normal;
    uint8_t *seen;   /* per triangle */
    int level_below; /* what lies in the plane counts as below it */
    swarf_outline *out;
} cutting;

static double height(const cutting *c, uint32_t vertex)
{
    const float *p = c->t.xyz + 3 * (size_t)vertex;
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += ((double)p[k] - c->point[k]) * c->normal[k];
    return sum;
}

static int is_above(const cutting *c, uint32_t vertex)
{
    const double at = height(c, vertex);
    return c->level_below ? at > 0 : at >= 0;
}

static uint32_t to_of(const cutting *c, uint32_t h)
{
    return c->t.index[h % 3 == 2 ? h - 2 : h + 1];
}

/* The half-edge of a triangle that goes up (or down) through the plane, SWARF_NO_HALFEDGE where none does. */
static uint32_t find_through(const cutting *c, uint32_t triangle, int up)
{
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        const int above = is_above(c, c->t.index[h]), above_next = is_above(c, to_of(c, h));
        if (above != above_next && above_next == up) return h;
    }
    return SWARF_NO_HALFEDGE;
}

/* Always from the lower vertex, so that both sides of an edge give the same bits. */
static swarf_status put_point(cutting *c, uint32_t h)
{
    uint32_t a = c->t.index[h], b = to_of(c, h);
    if (is_above(c, a)) {
        const uint32_t kept = a;
        a = b;
        b = kept;
    }
    const double low = height(c, a), high = height(c, b), t = low / (low - high);
    swarf_outline *s = c->out;
    SWARF_TRY(swarf_array_reserve((void **)&s->points, &s->point_room, 3 * (s->point_count + 1), sizeof *s->points));
    for (size_t k = 0; k < 3; k++) {
        const double from = c->t.xyz[3 * (size_t)a + k], to = c->t.xyz[3 * (size_t)b + k];
        s->points[3 * s->point_count + k] = from + t * (to - from);
    }
    s->point_count++;
    return SWARF_OK;
}

/* The way from p to q; its length. */
static double way_of(const double p[3], const double q[3], double way[3])
{
    for (int k = 0; k < 3; k++) way[k] = q[k] - p[k];
    return sqrt(vector_dot(way, way));
}

static int is_apart(const double p[3], const double q[3])
{
    double way[3];
    return way_of(p, q, way) > apart;
}

/* Whether a closed curve has an area, beyond what its points may be off. */
static int has_area(const double *points, size_t count)
{
    double area[3] = {0}, length = 0;
    for (size_t i = 1; i < count; i++) {
        double p[3], side[3], twice[3];
        way_of(points, points + 3 * i, p);
        length += way_of(points + 3 * (i - 1), points + 3 * i, side);
        vector_cross(p, side, twice);
        for (int k = 0; k < 3; k++) area[k] += 0.5 * twice[k];
    }
    return sqrt(vector_dot(area, area)) > apart * length;
}

/* End the polyline of the points from `begin` on: without those that repeat the one before, if a curve is left. */
static swarf_status end_polyline(swarf_outline *s, size_t begin, int closed)
{
    size_t kept = begin;
    for (size_t i = begin; i < s->point_count; i++) {
        const double *p = s->points + 3 * i;
        if (kept > begin && !is_apart(s->points + 3 * (kept - 1), p)) continue;
        memmove(s->points + 3 * kept++, p, 3 * sizeof *p);
    }
    while (closed && kept > begin + 1 && !is_apart(s->points + 3 * (kept - 1), s->points + 3 * begin)) kept--;
    const int is_curve = closed ? has_area(s->points + 3 * begin, kept - begin) : kept > begin + 1;
    s->point_count = is_curve ? kept : begin;
    if (!is_curve) return SWARF_OK;
    SWARF_TRY(swarf_array_reserve((void **)&s->ends, &s->end_room, s->count + 1, sizeof *s->ends));
    s->ends[s->count++] = s->point_count;
    return SWARF_OK;
}

static swarf_status follow(cutting *c, uint32_t triangle)
{
    swarf_outline *s = c->out;
    uint32_t in = find_through(c, triangle, 0);
    if (in == SWARF_NO_HALFEDGE) return SWARF_OK;
    const uint32_t first = in;
    const size_t begin = s->point_count;
    do {
        c->seen[in / 3] = 1;
        SWARF_TRY(put_point(c, in));
        const uint32_t on = find_through(c, in / 3, 1);
        in = c->opposite[on];
        if (in == SWARF_NO_HALFEDGE) { /* an open mesh: the polyline ends */
            SWARF_TRY(put_point(c, on));
            break;
        }
    } while (in != first && !c->seen[in / 3]);
    return end_polyline(s, begin, in == first);
}

static swarf_status cut(cutting *c)
{
    /* polylines of open meshes from their ends, then what goes round */
    for (uint32_t t = 0; t < c->t.triangle_count; t++) {
        const uint32_t in = find_through(c, t, 0);
        if (in != SWARF_NO_HALFEDGE && c->opposite[in] == SWARF_NO_HALFEDGE) SWARF_TRY(follow(c, t));
    }
    for (uint32_t t = 0; t < c->t.triangle_count; t++)
        if (!c->seen[t]) SWARF_TRY(follow(c, t));
    return SWARF_OK;
}

swarf_status swarf_plane_take(const double point[3], const double normal[3], double unit[3])
{
    double most = 0, square = 0;
    for (int k = 0; k < 3; k++) {
        SWARF_REQUIRE(isfinite(point[k]) && isfinite(normal[k]), "mesh: the plane is not finite");
        most = fmax(most, fabs(normal[k]));
    }
    SWARF_REQUIRE(most > 0, "mesh: the plane's normal has no length");
    for (int k = 0; k < 3; k++) { /* squares of what is far from 1 would not be numbers */
        unit[k] = normal[k] / most;
        square += unit[k] * unit[k];
    }
    for (int k = 0; k < 3; k++) unit[k] /= sqrt(square);
    return SWARF_OK;
}

swarf_status swarf_outline_create(const swarf_mesh *mesh, const double point[3], const double normal[3],
                                  swarf_outline **out)
{
    SWARF_REQUIRE(mesh && point && normal && out, "mesh: NULL");
    double unit[3];
    SWARF_TRY(swarf_plane_take(point, normal, unit));
    uint32_t *opposite = NULL;
    swarf_outline *s = calloc(1, sizeof *s);
    cutting c = {.t = swarf_mesh_triangles(mesh), .point = point, .normal = unit, .out = s};
    c.seen = calloc(c.t.triangle_count + 1, 1);
    swarf_status status = s && c.seen ? swarf_halfedges_create(&c.t, &opposite)
                                      : swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for a section");
    if (status == SWARF_OK) {
        c.opposite = opposite;
        status = cut(&c);
        if (status == SWARF_OK && s->count == 0) {
            memset(c.seen, 0, c.t.triangle_count);
            c.level_below = 1;
            status = cut(&c);
        }
    }
    free(opposite);
    free(c.seen);
    if (status != SWARF_OK) {
        swarf_outline_destroy(s);
        return status;
    }
    *out = s;
    return SWARF_OK;
}

void swarf_outline_destroy(swarf_outline *section)
{
    if (!section) return;
    free(section->points);
    free(section->ends);
    free(section);
}

size_t swarf_outline_count(const swarf_outline *section)
{
    return section->count;
}

const double *swarf_outline_polyline(const swarf_outline *section, size_t index, size_t *count)
{
    const size_t first = index ? section->ends[index - 1] : 0;
    *count = section->ends[index] - first;
    return section->points + 3 * first;
}
