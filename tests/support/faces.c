/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "faces.h"

#include <math.h>
#include <string.h>

#include "gradient.h"

typedef struct asked {
    const faces *of;
    int face;
} asked;

static double asked_value(const void *of, const double p[3])
{
    const asked *a = of;
    return a->of->value(a->of->of, a->face, p);
}

int faces_gradient(const faces *s, int face, const double p[3], double out[3])
{
    const asked of = {s, face};
    return fabs(test_gradient(asked_value, &of, p, 1e-4, out) - 1) < 5e-4;
}

/* The nearest point where two faces meet, and the direction of their edge. */
static int find_edge(const faces *s, int i, int j, const double from[3], double q[3], double along[3])
{
    enum { STEPS = 7 };
    memcpy(q, from, 3 * sizeof *q);
    for (int step = 0; step < STEPS; step++) {
        double n[3], m[3], cosine = 0, size = 0;
        const double a = -s->value(s->of, i, q), b = -s->value(s->of, j, q);
        if (!faces_gradient(s, i, q, n) || !faces_gradient(s, j, q, m)) return 0;
        for (int k = 0; k < 3; k++) cosine += n[k] * m[k];
        const double sine = 1 - cosine * cosine;
        if (sine < 0.03) return 0; /* 10 degrees */
        for (int k = 0; k < 3; k++) {
            along[k] = n[(k + 1) % 3] * m[(k + 2) % 3] - n[(k + 2) % 3] * m[(k + 1) % 3];
            size += along[k] * along[k];
        }
        for (int k = 0; k < 3; k++) along[k] /= sqrt(size);
        if (fabs(a) < 1e-6 && fabs(b) < 1e-6) return 1;
        for (int k = 0; k < 3; k++) q[k] += ((a - cosine * b) * n[k] + (b - cosine * a) * m[k]) / sine;
    }
    return 0;
}

/* Whether the edge goes on for half a voxel in the cell of a vertex, and there is one. */
static int is_in_cell(const faces *s, int i, int j, const double p[3], const double q[3], const double along[3])
{
    double lo = -INFINITY, hi = INFINITY, middle[3], on[3], other[3];
    for (int k = 0; k < 3; k++) {
        const double low = s->origin[k] + floor((p[k] - s->origin[k]) / s->voxel) * s->voxel;
        const double a = (low - q[k]) / along[k], b = (low + s->voxel - q[k]) / along[k];
        lo = fmax(lo, fmin(a, b));
        hi = fmin(hi, fmax(a, b));
    }
    if (!(hi - lo >= 0.5 * s->voxel)) return 0;
    for (int k = 0; k < 3; k++) middle[k] = q[k] + 0.5 * (lo + hi) * along[k];
    if (!find_edge(s, i, j, middle, on, other)) return 0;
    const double bent = hypot(hypot(on[0] - middle[0], on[1] - middle[1]), on[2] - middle[2]);
    return bent <= s->bend * s->voxel && fabs(s->value(s->of, -1, on)) < 1e-5 && !faces_gradient(s, -1, on, other);
}

enum { MOST_NEAR = 64 };

/* Faces within three voxels, and how far they are. */
static int find_near(const faces *s, const double p[3], int near[MOST_NEAR], double value[MOST_NEAR])
{
    int count = 0;
    for (int i = 0; i < s->count && count < MOST_NEAR; i++) {
        const double off = fabs(s->value(s->of, i, p));
        if (off >= 3 * s->voxel) continue;
        near[count] = i;
        value[count++] = off;
    }
    return count;
}

int faces_edges(const faces *s, const double p[3], faces_edge out[FACES_MOST_EDGES])
{
    int near[MOST_NEAR], found = 0;
    double value[MOST_NEAR];
    const int count = find_near(s, p, near, value);
    for (int i = 0; i < count; i++)
        for (int j = 0; j < i && value[i] < 2 * s->voxel && found < FACES_MOST_EDGES; j++) {
            double q[3], along[3];
            if (near[i] < s->apart) continue;
            if (value[j] > 2 * s->voxel || !find_edge(s, near[i], near[j], p, q, along)) continue;
            if (!is_in_cell(s, near[i], near[j], p, q, along)) continue;
            const double away = hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]) / s->voxel;
            out[found++] = (faces_edge){{near[i], near[j]}, away};
        }
    return found;
}

double faces_edge_distance(const faces *s, const double p[3], int *corner)
{
    faces_edge edge[FACES_MOST_EDGES];
    int near[MOST_NEAR];
    double value[MOST_NEAR], least = INFINITY;
    const int count = faces_edges(s, p, edge);
    for (int i = 0; i < count; i++) least = fmin(least, edge[i].away);
    *corner = find_near(s, p, near, value) > 2;
    return isinf(least) ? -1 : least;
}
