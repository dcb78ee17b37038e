/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Crossings of the field beside edges of the surface, by the faces that meet there.
 *
 *   sight   of a voxel: the gradient from one side of the edge, which tells of the face that is nearest to it
 *   end     of a grid edge: a voxel, and the face that is seen from it
 *
 * Beside a ridge the field is the greatest of the distances from its faces, beside a groove the least, so that on the
 * way out of the material the surface is where the first or the last of them is 0. Outside of a ridge and inside of a
 * groove the field may also be the distance from the edge, which tells of no face: then it is asked of the voxels
 * about. */
#include "mesh/contour_sharp.h"

#include <math.h>
#include <string.h>

/* In voxels: a face that tells of a voxel's value to this, and what it bends on the way there, is what that sees. */
static const float same_value = 0.02f;
/* Cosine of the angle within which gradients are of one face, 15 degrees. */
static const float same_face_cosine = 0.966f;
/* Planes may be off by this part of a voxel beyond an end of a grid edge that the signs say is met. */
static const float beyond_end = 0.1f;

static const int stride[3] = {SWARF_WIDE_HALO * SWARF_WIDE_HALO, SWARF_WIDE_HALO, 1};

enum { ABOUT = 10 }; /* voxels: the ends of a grid edge and those beside them */

/* A grid edge, from inside to outside of the material. */
typedef struct ray {
    contour_sharp *sharp;
    int at[3]; /* its low end */
    int axis, outwards;
} ray;

typedef struct end {
    int at[3];
    float value; /* in voxels */
    const contour_sight *sight;
    float rise; /* of the face towards the other end */
} end;

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static const float *value_at(const contour_sharp *s, const int at[3])
{
    return s->values + (at[0] + SWARF_WIDE_BELOW) * stride[0] + (at[1] + SWARF_WIDE_BELOW) * stride[1] + at[2] +
           SWARF_WIDE_BELOW;
}

void swarf_contour_sharp_begin(contour_sharp *s, const contour *work, const contour_block *block)
{
    swarf_contour_fetch_wide(work, block->ijk, s->values);
    memset(s->looked, 0, sizeof s->looked);
    s->limit = work->layout->background;
    s->voxel = (float)work->layout->voxel;
}

static const contour_sight *look(contour_sharp *s, const int at[3])
{
    const int place = ((at[0] + 1) * SWARF_SHARP_SPAN + at[1] + 1) * SWARF_SHARP_SPAN + at[2] + 1;
    contour_sight *sight = &s->sight[place];
    if (s->looked[place]) return sight;
    const float *value = value_at(s, at), scale = 1 / s->voxel;
    float bend = 0;
    for (int k = 0; k < 3; k++)
        sight->gradient[k] = scale * swarf_field_slope(value, stride[k], s->limit, s->voxel, &bend);
    const float off = fabsf(dot(sight->gradient, sight->gradient) - 1);
    bend *= scale;
    sight->bend = bend < swarf_face_bend && off < swarf_gradient_slack ? bend : INFINITY;
    s->looked[place] = 1;
    return sight;
}

static int sees(const contour_sight *sight)
{
    return !isinf(sight->bend);
}

static void see(const ray *r, end *e, const contour_sight *sight)
{
    e->sight = sight;
    if (sight) e->rise = e->at[r->axis] == r->at[r->axis] ? sight->gradient[r->axis] : -sight->gradient[r->axis];
}

static end find_end(const ray *r, int high)
{
    end out = {.at = {r->at[0], r->at[1], r->at[2]}};
    out.at[r->axis] += high;
    out.value = *value_at(r->sharp, out.at) / r->sharp->voxel;
    const contour_sight *own = look(r->sharp, out.at);
    see(r, &out, sees(own) ? own : NULL);
    return out;
}

/* How far from an end its face is 0 on the way to the other one; beyond that where it never is. */
static float reach(const end *e)
{
    enum { NEVER = 3 };
    if (e->value == 0) return 0;
    return e->value * e->rise < 0 ? -e->value / e->rise : NEVER;
}

static void set(contour_crossing *crossing, float t, const float gradient[3])
{
    const float length = sqrtf(dot(gradient, gradient));
    crossing->t = fminf(fmaxf(t, (float)SWARF_CONTOUR_MARGIN), 1 - (float)SWARF_CONTOUR_MARGIN);
    for (int k = 0; k < 3; k++) crossing->normal[k] = gradient[k] / length;
    crossing->move = SWARF_BY_FACES;
}

/* The same so far from inside, if that is on the grid edge. */
static void set_along(const ray *r, float along, const float gradient[3], contour_crossing *crossing)
{
    if (along > -beyond_end && along < 1 + beyond_end) set(crossing, r->outwards ? along : 1 - along, gradient);
}

/* What voxels about a grid edge see that one end of it may: the face that tells best of its value, NULL where none
 * does; and of the face that the other end is known to see and of those that may be there with it the one that the
 * surface is on, `along` from inside, NULL where it is the known one. */
typedef struct about {
    const contour_sight *best, *met;
    float along;
} about;

static about look_about(const ray *r, const end *e, const end *known)
{
    static const int across[ABOUT / 2][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    const int high = e->at[r->axis] != r->at[r->axis];
    const float sign = known && known->value + known->rise < e->value ? 1 : -1; /* ridge, groove */
    float least = 1;
    about found = {.along = known ? reach(known) : 0};
    if (known && known->value >= 0) found.along = 1 - found.along;
    for (int c = 0; c < ABOUT; c++) {
        const int step[3] = {c % 2, across[c / 2][0], across[c / 2][1]};
        int from[3];
        for (int k = 0; k < 3; k++) from[(r->axis + k) % 3] = r->at[(r->axis + k) % 3] + step[k];
        const contour_sight *sight = look(r->sharp, from);
        if (!sees(sight)) continue;
        float told = *value_at(r->sharp, from) / r->sharp->voxel; /* of the low end, then of `e` */
        for (int k = 0; k < 3; k++) told -= sight->gradient[(r->axis + k) % 3] * (float)step[k];
        const float rise = sight->gradient[r->axis], other = high ? told : told + rise;
        told = high ? told + rise : told;
        const float square = (float)((step[0] - high) * (step[0] - high) + step[1] * step[1] + step[2] * step[2]);
        const float off = fabsf(told - e->value) / (same_value + 0.5f * sight->bend * square);
        if (off < least) {
            least = off;
            found.best = sight;
        }
        if (!known || told * other >= 0 || (told < 0) != (e->value < 0)) continue;
        const float in = told < 0 ? told : other, along = in / (in - (told < 0 ? other : told));
        if (sign * (told - e->value) > same_value || sign * (other - known->value) > same_value ||
            sign * along >= sign * found.along)
            continue;
        found.along = along;
        found.met = sight;
    }
    return found;
}

/* Where both ends see a face. */
static void cross_between(const ray *r, const end *in, const end *out, contour_crossing *crossing)
{
    /* of each face over the field at the other end */
    const float over_out = in->value + in->rise - out->value, over_in = out->value + out->rise - in->value;
    const float slack_out = same_value + 0.5f * in->sight->bend, slack_in = same_value + 0.5f * out->sight->bend;
    const int ridge = over_out <= slack_out && over_in <= slack_in,
              groove = over_out >= -slack_out && over_in >= -slack_in;
    const float *n = in->sight->gradient, *m = out->sight->gradient;
    const float cosine = dot(n, m) / sqrtf(dot(n, n) * dot(m, m));
    if (ridge && groove && cosine > same_face_cosine) {
        const float t = r->outwards ? crossing->t : 1 - crossing->t;
        float gradient[3];
        for (int k = 0; k < 3; k++) gradient[k] = (1 - t) * n[k] + t * m[k];
        set(crossing, crossing->t, gradient);
        return;
    }
    const float from_in = reach(in), from_out = 1 - reach(out);
    const int by_in = ridge ? from_in < from_out : from_out < from_in;
    const float along = by_in ? from_in : from_out;
    if (ridge || groove) set_along(r, along, by_in ? n : m, crossing);
}

/* Where one end sees no face by itself. */
static void cross_beside(const ray *r, end *known, end *other, contour_crossing *crossing)
{
    const float over = known->value + known->rise - other->value;
    if (fabsf(over) <= same_value + 0.5f * known->sight->bend) {
        set(crossing, crossing->t, known->sight->gradient);
        return;
    }
    const about found = look_about(r, other, known);
    if (found.best) {
        see(r, other, found.best);
        cross_between(r, known->value < 0 ? known : other, known->value < 0 ? other : known, crossing);
    } else
        set_along(r, found.along, (found.met ? found.met : known->sight)->gradient, crossing);
}

void swarf_contour_cross_sharp(contour_sharp *sharp, const int at[3], int axis, contour_crossing *crossing)
{
    ray r = {.sharp = sharp, .at = {at[0], at[1], at[2]}, .axis = axis};
    end low = find_end(&r, 0), high = find_end(&r, 1);
    r.outwards = low.value < 0;
    if (!low.sight && !high.sight) {
        see(&r, &low, look_about(&r, &low, NULL).best);
        see(&r, &high, look_about(&r, &high, NULL).best);
    }
    if (low.sight && high.sight)
        cross_between(&r, r.outwards ? &low : &high, r.outwards ? &high : &low, crossing);
    else if (low.sight || high.sight)
        cross_beside(&r, low.sight ? &low : &high, low.sight ? &high : &low, crossing);
}
