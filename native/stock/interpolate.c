/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A distance field between its voxels: trilinear, less what second differences tell that this is off; and where they
 * tell of an edge, by the faces beside it.
 *
 *   corner   of the cell: its value, and its gradient from one side of the edge
 *   face     corners of about one gradient: a plane
 *   value    max over faces j of min over those that are above j where j is seen (Ovchinnikov 2002): what any faces
 *            make that meet in edges, be they ridges, grooves or both */
#include "stock/interpolate.h"

#include "stock/gradient.h"
#include "stock/leaf.h"

#include <math.h>

/* Planes that make of all corners what they are, but for this, are all there is. */
static const float least_misfit = 0.02f;
/* Faces that do not tell of the corners to this do not tell of the field between them: there it is of things that are
 * as small as voxels, of which trilinear values make too little and second differences too much. */
static const float greatest_misfit = 0.3f;
/* In voxels: corners that are nearer to the surface than this tell about as much of it. */
static const float nearness = 0.25f;
/* Cosine of the angle within which gradients are of one face, 15 degrees. */
static const float same_face_cosine = 0.966f;
/* In voxels: what tells on which side of a face another one is. */
static const float least_evidence = 0.02f;

/* Corner number: x * 4 + y * 2 + z. */
enum { CORNERS = 8 };

typedef struct cell {
    const float *low;
    int stride[3];
    float t[3];
    float limit;
    float value[CORNERS], weight[CORNERS]; /* weight: trilinear */
    float smooth;                          /* the value as if there were no edge */
    float halfway;                         /* from that to the trilinear one */
    float bend;                            /* greatest second difference */
    /* by corner, where there is an edge: */
    float gradient[CORNERS][3], steepness[CORNERS] /* its square */, gradient_bend[CORNERS];
} cell;

typedef struct face {
    float weight, offset, gradient[3]; /* value at the low corner, and the slope */
} face;

typedef struct faces {
    int count;
    int of_corner[CORNERS]; /* -1: none */
    face face[CORNERS];
} faces;

static const float *corner_of(const cell *c, int corner)
{
    return c->low + (corner >> 2) * c->stride[0] + (corner >> 1 & 1) * c->stride[1] + (corner & 1);
}

/* How many corners are known; their values. */
static int look_near(cell *c)
{
    int known = 0;
    for (int i = 0; i < CORNERS; i++) {
        c->value[i] = *corner_of(c, i);
        known += fabsf(c->value[i]) < c->limit;
    }
    return known;
}

/* Trilinear, and less by what the second differences along each axis make of it. */
static void look_smooth(cell *c)
{
    const float *t = c->t, u[3] = {1 - t[0], 1 - t[1], 1 - t[2]};
    const float across[4] = {u[0] * u[1], u[0] * t[1], t[0] * u[1], t[0] * t[1]};
    float sum = 0, bend = 0, less = 0;
    for (int i = 0; i < CORNERS; i++) {
        c->weight[i] = across[i >> 1] * (i & 1 ? t[2] : u[2]);
        sum += c->weight[i] * c->value[i];
    }
    for (int k = 0; k < 3; k++) {
        const int step = c->stride[k], l = k == 0 ? 1 : 0, m = k == 2 ? 1 : 2;
        const float part[4] = {u[l] * u[m], u[l] * t[m], t[l] * u[m], t[l] * t[m]};
        float off = 0;
        for (int e = 0; e < 4; e++) { /* of the edges along it */
            const float *a = c->low + (e >> 1) * c->stride[l] + (e & 1) * c->stride[m], low = a[0], high = a[step];
            float first = a[-step] - 2 * low + high, last = low - 2 * high + a[2 * step];
            first = fabsf(a[-step]) < c->limit ? first : 0; /* nothing is known */
            last = fabsf(a[2 * step]) < c->limit ? last : 0;
            const float one = fabsf(first), other = fabsf(last);
            bend = one > bend ? one : bend;
            bend = other > bend ? other : bend;
            off += part[e] * (first + last);
        }
        less += 0.25f * t[k] * u[k] * off;
    }
    c->bend = bend;
    c->smooth = sum - less;
    c->halfway = sum - 0.5f * less;
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Value of a face's plane at a corner of the cell. */
static float plane_at(const face *f, int corner)
{
    float value = f->offset;
    for (int k = 0; k < 3; k++) value += f->gradient[k] * (float)(corner >> (2 - k) & 1);
    return value;
}

static void find_gradients(cell *c)
{
    for (int i = 0; i < CORNERS; i++) {
        const float *at = corner_of(c, i);
        c->gradient_bend[i] = 0;
        for (int k = 0; k < 3; k++)
            c->gradient[i][k] = swarf_field_slope(at, c->stride[k], c->limit, 1, &c->gradient_bend[i]);
        c->steepness[i] = dot(c->gradient[i], c->gradient[i]);
    }
}

/* The face that a corner's gradient is of, a new one where there is none yet. */
static int face_of(const cell *c, int corner, const faces *f)
{
    int n = 0;
    for (; n < f->count; n++) {
        const float *other = f->face[n].gradient;
        if (dot(c->gradient[corner], other) > same_face_cosine * sqrtf(c->steepness[corner] * dot(other, other))) break;
    }
    return n;
}

/* The corners whose gradients can be told that well, by faces. */
static void find_faces(const cell *c, float most_bend, float slack, faces *out)
{
    out->count = 0;
    for (int i = 0; i < CORNERS; i++) {
        out->of_corner[i] = -1;
        if (c->gradient_bend[i] > most_bend || fabsf(c->steepness[i] - 1) > slack) continue;
        const int n = out->of_corner[i] = face_of(c, i, out);
        face *f = &out->face[n];
        if (n == out->count) *f = (face){0};
        out->count += n == out->count;
        /* the mean of what its corners make of it, by how near they are */
        float offset = c->value[i];
        for (int k = 0; k < 3; k++) offset -= c->gradient[i][k] * (float)(i >> (2 - k) & 1);
        const float weight = c->weight[i] + 1e-3f, part = weight / (f->weight + weight);
        f->weight += weight;
        f->offset += part * (offset - f->offset);
        for (int k = 0; k < 3; k++) f->gradient[k] += part * (c->gradient[i][k] - f->gradient[k]);
    }
}

/* How far a face is above the field where another one is seen, at the corner that tells most. */
static float height_over(const cell *c, const faces *f, int which, int other)
{
    float most = 0;
    for (int i = 0; i < CORNERS; i++) {
        const float here = f->of_corner[i] == other ? plane_at(&f->face[which], i) - c->value[i] : 0;
        if (fabsf(here) > fabsf(most)) most = here;
    }
    return most;
}

typedef struct lattice {
    const faces *faces;
    unsigned above[CORNERS]; /* faces that are above this one where it is seen, a bit each */
} lattice;

static void find_order(const cell *c, const faces *f, lattice *out)
{
    out->faces = f;
    for (int j = 0; j < f->count; j++) {
        out->above[j] = 1u << j;
        for (int i = 0; i < f->count; i++) {
            if (i == j) continue;
            float height = height_over(c, f, i, j);
            if (fabsf(height) < least_evidence) height = height_over(c, f, j, i);
            if (height > 0) out->above[j] |= 1u << i;
        }
    }
}

static float lattice_value(const lattice *l, const float at[CORNERS])
{
    float most = -INFINITY;
    for (int j = 0; j < l->faces->count; j++) {
        float least = INFINITY;
        for (int i = 0; i < l->faces->count; i++)
            if (l->above[j] >> i & 1) least = fminf(least, at[i]);
        most = fmaxf(most, least);
    }
    return most;
}

/* How far it is to the edge of two faces, for the side of `value`: 0 where the edge is not the nearest. */
static float edge_distance(const lattice *l, const float at[CORNERS], float value)
{
    float most = 0;
    for (int j = 0; j < l->faces->count; j++)
        for (int i = 0; i < j; i++) {
            const int groove = l->above[j] >> i & 1;
            const float sign = value < 0 ? -1.0f : 1.0f, a = sign * at[i], b = sign * at[j];
            if (groove != (value < 0) || a <= 0 || b <= 0) continue;
            const float *n = l->faces->face[i].gradient, *m = l->faces->face[j].gradient;
            const float cosine = dot(n, m) / sqrtf(dot(n, n) * dot(m, m));
            if (a > cosine * b && b > cosine * a)
                most = fmaxf(most, sqrtf((a * a + b * b - 2 * cosine * a * b) / (1 - cosine * cosine)));
        }
    return most;
}

/* Beside an edge the field may be the distance from it, which is more than from its faces: whether it is, the corners
 * tell. The surface itself does not move by it. */
static float beyond_edge(const cell *c, const lattice *l, const float at[CORNERS], float value)
{
    const float most = edge_distance(l, at, value);
    if (most <= fabsf(value)) return value;
    float balance = 0;
    for (int i = 0; i < CORNERS; i++) {
        float here[CORNERS] = {0};
        for (int j = 0; j < l->faces->count; j++) here[j] = plane_at(&l->faces->face[j], i);
        const float flat = lattice_value(l, here), round = edge_distance(l, here, flat);
        if (flat * value <= 0 || round <= fabsf(flat)) continue;
        balance += fabsf(fabsf(c->value[i]) - fabsf(flat)) - fabsf(fabsf(c->value[i]) - round);
    }
    return balance > 0 ? copysignf(most, value) : value;
}

/* No value differs from a corner's by more than it is away. */
static float keep_near(const cell *c, float value)
{
    float lo = -c->limit, hi = c->limit;
    for (int i = 0; i < CORNERS; i++) {
        float square = 0;
        for (int k = 0; k < 3; k++) {
            const float away = (i >> (2 - k) & 1 ? 1 - c->t[k] : c->t[k]);
            square += away * away;
        }
        const float away = sqrtf(square);
        /* what is not known is beyond the limit: not so outside, where leaves are dropped that are nearer */
        if (c->value[i] > -c->limit) lo = fmaxf(lo, (c->value[i] < c->limit ? c->value[i] : SWARF_LEAF_DROP) - away);
        if (c->value[i] < c->limit) hi = fminf(hi, c->value[i] + away);
    }
    return lo <= hi ? fminf(fmaxf(value, lo), hi) : c->smooth;
}

/* How far the faces are from what they should make of the corners, be the field the distance from them or from their
 * edges; the more the nearer to the surface. */
static float misfit(const cell *c, const lattice *l)
{
    float most = l->faces->count ? 0 : INFINITY;
    for (int i = 0; i < CORNERS && l->faces->count; i++) {
        float at[CORNERS] = {0};
        for (int j = 0; j < l->faces->count; j++) at[j] = plane_at(&l->faces->face[j], i);
        const float flat = lattice_value(l, at), round = copysignf(edge_distance(l, at, flat), flat);
        const float off = fminf(fabsf(c->value[i] - flat), fabsf(c->value[i] - round));
        most = fmaxf(most, off / (fabsf(c->value[i]) + nearness));
    }
    return most;
}

static float look_sharp(cell *c)
{
    faces flat, any, *f = &flat;
    lattice of_flat, of_any, *l = &of_flat;
    float at[CORNERS] = {0};
    find_gradients(c);
    find_faces(c, swarf_flat_bend, 2 * swarf_flat_bend, &flat);
    find_order(c, &flat, &of_flat);
    float off = misfit(c, &of_flat);
    if (off > least_misfit) { /* not of planes alone */
        find_faces(c, swarf_edge_bend, swarf_gradient_slack, &any);
        find_order(c, &any, &of_any);
        const float other = misfit(c, &of_any);
        if (other < off) {
            off = other;
            f = &any;
            l = &of_any;
        }
    }
    if (off > greatest_misfit) return keep_near(c, c->halfway);
    for (int j = 0; j < f->count; j++) at[j] = f->face[j].offset + dot(f->face[j].gradient, c->t);
    return keep_near(c, beyond_edge(c, l, at, lattice_value(l, at)));
}

/* Where the field is known on one side only: it goes on from the corner that is nearest to the surface. */
static float look_beyond(cell *c)
{
    int nearest = 0;
    float bend = 0;
    for (int i = 1; i < CORNERS; i++)
        if (fabsf(c->value[i]) < fabsf(c->value[nearest])) nearest = i;
    float value = c->smooth = c->value[nearest];
    for (int k = 0; k < 3; k++)
        value += swarf_field_slope(corner_of(c, nearest), c->stride[k], c->limit, 1, &bend) *
                 (c->t[k] - (float)(nearest >> (2 - k) & 1));
    return keep_near(c, value);
}

float swarf_field_interpolate(const float *low, const int stride[2], const double t[3], float limit)
{
    cell c = {
        .low = low, .stride = {stride[0], stride[1], 1}, .t = {(float)t[0], (float)t[1], (float)t[2]}, .limit = limit};
    const int known = look_near(&c);
    if (known < CORNERS) return known ? look_beyond(&c) : c.value[0];
    look_smooth(&c);
    return c.bend < swarf_edge_bend ? c.smooth : look_sharp(&c);
}
