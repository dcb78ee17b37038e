/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A cube whose centre is farther from the surface than its corners and the reach is all of one sign. The others are
 * divided. In a leaf the triangles within reach are gathered once; where they lie in one plane, that plane is all there
 * is to it. Else the leaf is divided: when they are few with ever shorter lists of those that can be closest to any of
 * its voxels, when they are many by looking in the tree. */
#include "solid/field.h"

#include "base/least.h"
#include "base/memory.h"
#include "base/status.h"
#include "solid/solid.h"

#include <math.h>
#include <stdlib.h>

/* Triangles whose corners leave a plane by less than this many voxels are in it: values are as exact as that. */
static const double flatness = 2e-4;

/* Normals of triangles in one plane agree to this, whatever their corners were rounded by. */
static const double least_flat_cosine = 0.999;

/* Triangles from which on the lists of a leaf are divided once more before all of them are tried at every voxel. */
enum { FEW = 3 };

/* Triangles from which on lists take longer than looking in the tree. */
enum { MANY = 32 };

/* A half space that a triangle lies in: before an edge, or on either side of its own plane. */
struct side {
    double normal[3], offset, spread; /* sum of the normal's sizes: how far a cube reaches along it */
};

typedef struct candidate {
    size_t place;
    double area;
    struct side plane; /* normal 0 when degenerate */
    struct side edge[3];
} candidate;

/* A cube of voxel centres in mm. */
struct cube {
    double middle[3], half; /* of its edge */
    double radius;          /* to its corners */
};

struct walker {
    const swarf_field *field;
    const swarf_solid *solid;
    swarf_field_fn see;
    void *context;
    candidate *list; /* those of a leaf, then of its part, of the part's part */
    size_t count, room;
    const struct cube *cube; /* what is gathered must come this near to it */
    double bound;
    swarf_nearby nearby;
    swarf_status status;
    float values[FIELD_LEAF_SIZE];
};

static struct cube cube_of(const swarf_field *field, const int32_t corner[3], int edge)
{
    struct cube cube = {.half = 0.5 * (edge - 1) * field->voxel};
    for (int k = 0; k < 3; k++) cube.middle[k] = field->origin[k] + field->voxel * (corner[k] + 0.5 * (edge - 1));
    cube.radius = cube.half * sqrt(3.0);
    return cube;
}

static void ends_of(const struct cube *cube, double lo[3], double hi[3])
{
    for (int k = 0; k < 3; k++) {
        lo[k] = cube->middle[k] - cube->half;
        hi[k] = cube->middle[k] + cube->half;
    }
}

static double along(const struct side *side, const double point[3])
{
    return side->normal[0] * point[0] + side->normal[1] * point[1] + side->normal[2] * point[2] - side->offset;
}

static void set_side(struct side *side, const float point[3])
{
    double square = 0;
    for (int k = 0; k < 3; k++) square += side->normal[k] * side->normal[k];
    const double scale = square > 0 ? 1 / sqrt(square) : 0;
    side->offset = side->spread = 0;
    for (int k = 0; k < 3; k++) {
        side->normal[k] *= scale;
        side->offset += side->normal[k] * point[k];
        side->spread += fabs(side->normal[k]);
    }
}

/* A triangle is at least this far from all of a cube. */
static double least_distance(const candidate *c, const struct cube *cube)
{
    double least = fabs(along(&c->plane, cube->middle)) - c->plane.spread * cube->half;
    for (int i = 0; i < 3; i++)
        least = swarf_most(least, along(&c->edge[i], cube->middle) - c->edge[i].spread * cube->half);
    return least;
}

static int add_candidate(void *context, size_t place)
{
    struct walker *w = context;
    w->status = swarf_array_reserve((void **)&w->list, &w->room, w->count + 1, sizeof *w->list);
    if (w->status != SWARF_OK) return 0;
    candidate *c = &w->list[w->count];
    const swarf_corners *t = &w->solid->corners[place];
    c->place = place;
    swarf_corners_normal(t, c->plane.normal);
    const double *n = c->plane.normal;
    c->area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++) {
        const float *from = t->xyz[i], *to = t->xyz[(i + 1) % 3];
        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            c->edge[i].normal[k] = ((double)to[l] - from[l]) * n[m] - ((double)to[m] - from[m]) * n[l];
        }
        set_side(&c->edge[i], from);
    }
    set_side(&c->plane, t->xyz[0]);
    if (least_distance(c, w->cube) <= w->bound) w->count++;
    return 1;
}

/* The closest of a list to a point. Where the foot on its plane lies in a triangle nothing else need be found out; a
 * triangle with the foot beyond an edge is no closer than the line of that edge. */
static swarf_nearest closest_of(const struct walker *w, const candidate *list, size_t count, const double point[3],
                                size_t *number)
{
    swarf_nearest nearest = {.square = INFINITY, .place = SIZE_MAX};
    *number = 0;
    for (size_t i = 0; i < count; i++) {
        const candidate *c = &list[i];
        const double away = along(&c->plane, point);
        double beyond = along(&c->edge[0], point);
        beyond = swarf_most(beyond, along(&c->edge[1], point));
        beyond = swarf_most(beyond, along(&c->edge[2], point));
        const double least = away * away + (beyond > 0 ? beyond * beyond : 0);
        if (least >= nearest.square) continue;
        if (beyond <= 0 && c->area > 0) {
            *number = i;
            nearest = (swarf_nearest){.square = least, .place = c->place};
            for (int k = 0; k < 3; k++) nearest.point[k] = point[k] - away * c->plane.normal[k];
            continue;
        }
        swarf_nearest here = {.place = c->place};
        here.square = swarf_corners_closest(&w->solid->corners[c->place], point, here.point, &here.feature);
        if (!(here.square < nearest.square)) continue;
        *number = i;
        nearest = here;
    }
    return nearest;
}

static double clamp(double value, double reach)
{
    return value < -reach ? -reach : value > reach ? reach : value;
}

static float *value_at(struct walker *w, const int32_t at[3], int x, int y, int z)
{
    return &w->values[(at[0] + x) * 64 + (at[1] + y) * 8 + at[2] + z];
}

static void fill_same(struct walker *w, const int32_t at[3], int edge, double value)
{
    for (int x = 0; x < edge; x++)
        for (int y = 0; y < edge; y++)
            for (int z = 0; z < edge; z++) *value_at(w, at, x, y, z) = (float)value;
}

/* How far to look for what is not flat. */
static double flat_limit(const struct walker *w, const struct cube *cube, double away)
{
    const double limit = swarf_most(away, w->field->reach);
    return limit < away + cube->radius ? limit : away + cube->radius;
}

/* Whether all that a cube sees of the surface within reach is one plane, which is that of *out; `nearest` is the
 * triangle closest to its middle, and `away` how far that is.
 *
 * The foot of the middle must lie in the plane's patch. Were the foot of another point x in the cube outside it, the
 * patch would end on the way there, at the foot of some point y between them; and a triangle beyond that end would be
 * as near to y as the plane is, which is no farther than it is from the middle or from x. */
static int is_flat(const struct walker *w, const candidate *list, size_t count, const struct cube *cube,
                   const candidate *nearest, double away, const candidate **out)
{
    const double tolerance = flatness * w->field->voxel;
    const double limit = flat_limit(w, cube, away) + tolerance;
    const candidate *flat = NULL; /* the largest, for its plane is the truest */
    for (size_t i = 0; i < count; i++) {
        const candidate *c = &list[i];
        double cosine = 0;
        for (int k = 0; k < 3; k++) cosine += c->plane.normal[k] * nearest->plane.normal[k];
        if (cosine > least_flat_cosine && flat && flat->area >= c->area) continue;
        if (least_distance(c, cube) > limit) continue;
        if (!(cosine > least_flat_cosine)) return 0;
        flat = c;
    }
    if (!flat || fabs(fabs(along(&flat->plane, cube->middle)) - away) > tolerance) return 0;
    for (size_t i = 0; i < count; i++) {
        if (&list[i] == flat || least_distance(&list[i], cube) > limit) continue;
        for (int corner = 0; corner < 3; corner++) {
            double point[3];
            for (int k = 0; k < 3; k++) point[k] = w->solid->corners[list[i].place].xyz[corner][k];
            if (fabs(along(&flat->plane, point)) > tolerance) return 0;
        }
    }
    *out = flat;
    return 1;
}

static void fill_plane(struct walker *w, const int32_t at[3], int edge, const struct cube *cube, const candidate *plane)
{
    const double reach = w->field->reach, voxel = w->field->voxel;
    const double *n = plane->plane.normal, low = cube->half;
    const double base = along(&plane->plane, cube->middle) - low * (n[0] + n[1] + n[2]);
    for (int x = 0; x < edge; x++)
        for (int y = 0; y < edge; y++)
            for (int z = 0; z < edge; z++)
                *value_at(w, at, x, y, z) = (float)clamp(base + voxel * (n[0] * x + n[1] * y + n[2] * z), reach);
}

static void fill_voxel(struct walker *w, const int32_t corner[3], const int32_t at[3], size_t first, size_t count)
{
    double point[3];
    for (int k = 0; k < 3; k++) point[k] = w->field->origin[k] + w->field->voxel * corner[k];
    size_t number;
    const swarf_nearest nearest = closest_of(w, w->list + first, count, point, &number);
    *value_at(w, at, 0, 0, 0) =
        (float)clamp(sqrt(nearest.square) * swarf_solid_sign(w->solid, point, &nearest), w->field->reach);
}

/* Fill the voxels of a part of the leaf: `at` in the leaf, `corner` in the grid; the `count` triangles of the list from
 * `first` on are all that can be closest to any of them. */
static void fill_part(struct walker *w, const int32_t corner[3], const int32_t at[3], int edge, size_t first,
                      size_t count)
{
    const double reach = w->field->reach;
    const struct cube cube = cube_of(w->field, corner, edge);
    size_t number;
    const swarf_nearest nearest = closest_of(w, w->list + first, count, cube.middle, &number);
    const double away = sqrt(nearest.square);
    if (away - cube.radius >= reach) {
        fill_same(w, at, edge, reach * swarf_solid_sign(w->solid, cube.middle, &nearest));
        return;
    }
    const candidate *plane;
    if (is_flat(w, w->list + first, count, &cube, &w->list[first + number], away, &plane)) {
        fill_plane(w, at, edge, &cube, plane);
        return;
    }
    const double bound = away + cube.radius * (1 + 1e-9);
    const size_t own = first + count;
    w->status = swarf_array_reserve((void **)&w->list, &w->room, own + count, sizeof *w->list);
    if (w->status != SWARF_OK) return;
    size_t kept = 1; /* the closest first: the others are compared with it */
    w->list[own] = w->list[first + number];
    for (size_t i = first; i < own; i++)
        if (i != first + number && least_distance(&w->list[i], &cube) <= bound) w->list[own + kept++] = w->list[i];
    const int part = edge == 2 || kept <= FEW ? 1 : edge / 2;
    for (int x = 0; x < edge; x += part)
        for (int y = 0; y < edge; y += part)
            for (int z = 0; z < edge; z += part) {
                const int32_t next[3] = {corner[0] + x, corner[1] + y, corner[2] + z};
                const int32_t there[3] = {at[0] + x, at[1] + y, at[2] + z};
                if (part == 1)
                    fill_voxel(w, next, there, own, kept);
                else
                    fill_part(w, next, there, part, own, kept);
                if (w->status != SWARF_OK) return;
            }
}

/* The same where there are many: no list is all that can be closest. */
static void search_part(struct walker *w, const int32_t corner[3], const int32_t at[3], int edge)
{
    const double reach = w->field->reach;
    const struct cube cube = cube_of(w->field, corner, edge);
    swarf_nearest nearest;
    swarf_nearby_find(&w->nearby, cube.middle, &nearest);
    const double away = sqrt(nearest.square);
    if (edge == 1 || away - cube.radius >= reach) {
        fill_same(w, at, edge, clamp(away * swarf_solid_sign(w->solid, cube.middle, &nearest), reach));
        return;
    }
    const int part = edge / 2;
    for (int i = 0; i < 8; i++) {
        const int step[3] = {(i >> 2) * part, (i >> 1 & 1) * part, (i & 1) * part};
        const int32_t next[3] = {corner[0] + step[0], corner[1] + step[1], corner[2] + step[2]};
        const int32_t there[3] = {at[0] + step[0], at[1] + step[1], at[2] + step[2]};
        search_part(w, next, there, part);
    }
}

/* Gather what comes within `bound` of a cube. */
static void gather(struct walker *w, const struct cube *cube, double bound)
{
    double lo[3], hi[3];
    ends_of(cube, lo, hi);
    w->count = 0;
    w->cube = cube;
    w->bound = bound;
    swarf_box_tree_near(&w->solid->tree, lo, hi, bound, 0, add_candidate, w);
}

static void fill_leaf(struct walker *w, const int32_t corner[3], const struct cube *cube, size_t nearest, double away)
{
    const int32_t start[3] = {0, 0, 0};
    const candidate *plane;
    gather(w, cube, flat_limit(w, cube, away) * (1 + 1e-9) + flatness * w->field->voxel);
    size_t number = 0;
    while (number < w->count && w->list[number].place != nearest) number++;
    if (w->status == SWARF_OK && number < w->count &&
        is_flat(w, w->list, w->count, cube, &w->list[number], away, &plane)) {
        fill_plane(w, start, FIELD_LEAF, cube, plane);
        return;
    }
    if (w->count > MANY) {
        double lo[3], hi[3];
        ends_of(cube, lo, hi);
        swarf_nearby_enter(&w->nearby, lo, hi);
        search_part(w, corner, start, FIELD_LEAF);
        return;
    }
    gather(w, cube, (away + cube->radius) * (1 + 1e-9));
    if (w->status == SWARF_OK) fill_part(w, corner, start, FIELD_LEAF, 0, w->count);
}

/* `far`: no point of the cube is farther from the surface. */
static swarf_status walk(struct walker *w, const int32_t corner[3], int edge, double far)
{
    if (w->field->wanted && !w->field->wanted(w->context, corner, edge)) return SWARF_OK;
    const struct cube cube = cube_of(w->field, corner, edge);
    swarf_nearest nearest;
    swarf_solid_nearest(w->solid, cube.middle, far, &nearest);
    if (nearest.place == SIZE_MAX) swarf_solid_nearest(w->solid, cube.middle, INFINITY, &nearest); /* rounding */
    const double away = sqrt(nearest.square);
    if (away - cube.radius >= w->field->reach)
        return w->see(w->context, corner, edge, NULL, swarf_solid_sign(w->solid, cube.middle, &nearest) < 0);
    if (edge == FIELD_LEAF) {
        fill_leaf(w, corner, &cube, nearest.place, away);
        return w->status == SWARF_OK ? w->see(w->context, corner, FIELD_LEAF, w->values, 0) : w->status;
    }
    const int part = edge / 2;
    for (int i = 0; i < 8; i++) {
        const int32_t next[3] = {corner[0] + (i >> 2) * part, corner[1] + (i >> 1 & 1) * part,
                                 corner[2] + (i & 1) * part};
        SWARF_TRY(walk(w, next, part, away + cube.radius * (1 + 1e-9)));
    }
    return SWARF_OK;
}

swarf_status swarf_field_walk(const swarf_field *field, const int32_t corner[3], int edge, swarf_field_fn see,
                              void *context)
{
    struct walker w = {.field = field, .solid = field->solid, .see = see, .context = context};
    swarf_nearby_begin(&w.solid->tree, w.solid->corners, &w.nearby);
    const swarf_status status = walk(&w, corner, edge, INFINITY);
    free(w.list);
    return status;
}
