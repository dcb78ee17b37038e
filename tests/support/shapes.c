/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "shapes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"

static const double pi = 3.14159265358979323846;

static void *grow(void *array, size_t bytes)
{
    void *grown = realloc(array, bytes);
    if (!grown) abort();
    return grown;
}

void shape_vertex(shape *s, double x, double y, double z)
{
    s->xyz = grow(s->xyz, 3 * (s->vertices + 1) * sizeof *s->xyz);
    float *p = s->xyz + 3 * s->vertices++;
    p[0] = (float)x;
    p[1] = (float)y;
    p[2] = (float)z;
}

void shape_triangle(shape *s, size_t a, size_t b, size_t c)
{
    s->index = grow(s->index, 3 * (s->triangles + 1) * sizeof *s->index);
    uint32_t *v = s->index + 3 * s->triangles++;
    v[0] = (uint32_t)a;
    v[1] = (uint32_t)b;
    v[2] = (uint32_t)c;
}

void shape_box(shape *s, const double lo[3], const double hi[3])
{
    static const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const size_t first = s->vertices;
    for (int i = 0; i < 8; i++) shape_vertex(s, i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]);
    for (int i = 0; i < 6; i++) {
        size_t v[4];
        for (int k = 0; k < 4; k++) v[k] = first + (size_t)quads[i][k];
        shape_triangle(s, v[0], v[1], v[2]);
        shape_triangle(s, v[0], v[2], v[3]);
    }
}

void shape_flip(shape *s, size_t first_triangle)
{
    for (size_t i = first_triangle; i < s->triangles; i++) {
        const uint32_t keep = s->index[3 * i];
        s->index[3 * i] = s->index[3 * i + 1];
        s->index[3 * i + 1] = keep;
    }
}

void shape_cylinder(shape *s, const double base[3], double radius, double height, int sides)
{
    const size_t first = s->vertices, n = (size_t)sides;
    shape_vertex(s, base[0], base[1], base[2]);
    shape_vertex(s, base[0], base[1], base[2] + height);
    for (size_t i = 0; i < n; i++) {
        const double angle = 2 * pi * (double)i / (double)n;
        for (int k = 0; k < 2; k++)
            shape_vertex(s, base[0] + radius * cos(angle), base[1] + radius * sin(angle), base[2] + k * height);
    }
    for (size_t i = 0; i < n; i++) {
        const size_t a = first + 2 + 2 * i, b = first + 2 + 2 * ((i + 1) % n);
        shape_triangle(s, first, b, a);
        shape_triangle(s, first + 1, a + 1, b + 1);
        shape_triangle(s, a, b, b + 1);
        shape_triangle(s, a, b + 1, a + 1);
    }
}

void shape_ball(shape *s, const double centre[3], double radius, int rings)
{
    const size_t first = s->vertices, n = (size_t)(2 * rings);
    shape_vertex(s, centre[0], centre[1], centre[2] - radius);
    shape_vertex(s, centre[0], centre[1], centre[2] + radius);
    for (int j = 1; j < rings; j++)
        for (size_t i = 0; i < n; i++) {
            const double polar = pi * j / rings, angle = 2 * pi * (double)i / (double)n;
            shape_vertex(s, centre[0] + radius * sin(polar) * cos(angle), centre[1] + radius * sin(polar) * sin(angle),
                         centre[2] - radius * cos(polar));
        }
    for (size_t i = 0; i < n; i++) {
        const size_t next = (i + 1) % n;
        shape_triangle(s, first, first + 2 + next, first + 2 + i);
        for (size_t j = 1; j + 1 < (size_t)rings; j++) {
            const size_t low = first + 2 + (j - 1) * n, high = low + n;
            shape_triangle(s, low + i, low + next, high + next);
            shape_triangle(s, low + i, high + next, high + i);
        }
        const size_t last = first + 2 + (size_t)(rings - 2) * n;
        shape_triangle(s, first + 1, last + i, last + next);
    }
}

void shape_unshare(shape *s)
{
    shape apart = {0};
    for (size_t i = 0; i < s->triangles; i++) {
        for (int k = 0; k < 3; k++) {
            const float *p = s->xyz + 3 * (size_t)s->index[3 * i + (size_t)k];
            shape_vertex(&apart, p[0], p[1], p[2]);
        }
        shape_triangle(&apart, 3 * i, 3 * i + 1, 3 * i + 2);
    }
    shape_free(s);
    *s = apart;
}

swarf_triangles shape_view(const shape *s)
{
    return (swarf_triangles){s->xyz, s->vertices, s->index, s->triangles};
}

void shape_free(shape *s)
{
    free(s->xyz);
    free(s->index);
    memset(s, 0, sizeof *s);
}

swarf_mesh *shape_mesh(shape *s)
{
    const swarf_triangles triangles = shape_view(s);
    swarf_mesh *mesh = NULL;
    CHECK_OK(swarf_mesh_create(&triangles, &mesh));
    shape_free(s);
    return mesh;
}
