/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A triangle is cut along the line that each other one leaves in its plane, or, where the two are nearly in one plane,
 * along the outline of the part that comes within the gap. The pieces are triangles too, in a tree: a cut one has the
 * two or three that it became below it, so that the next line finds those it passes. Lines come in random order, which
 * keeps this tree low. Cutting too much is harmless; cutting too little is not, for which reason a line that comes
 * within rounding of a piece cuts it, unless it would cut off nothing thicker than that.
 *
 * Then the winding number before and behind the middle of each piece tells whether it bounds the solid. Of pieces in
 * the same plane facing the same way, as where faces of two shells are flush, those of the first triangle stay.
 */
#include "solid/pieces.h"

#include "base/memory.h"
#include "base/mix.h"
#include "base/parallel.h"
#include "base/status.h"
#include "base/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Share of the gap by which a line must pass a corner to cut. */
static const double least_cut = 0.25;

/* Share of the gap away from a piece where it is asked what lies before and behind: beyond a triangle that touches it,
 * yet not beyond one that is farther than the gap and left no cuts. */
static const double test_depth = 0.75;

/* Share of the gap within which two pieces are in the same plane; less than the test depth, or both might seem inner.
 */
static const double same_plane = 0.25;

/* Planes at a smaller sine are nearly one: the strip within the gap is wide, and its outline makes no slivers. */
static const double least_sine = 0.01;

/* A piece as thin as rounding has any normal; it tells a side when it is the triangle's own to this. */
static const double least_true_cosine = 0.999;

/* Nodes of the tree of one triangle, and triangles that one piece of work cuts. */
enum { MOST_NODES = 1 << 22, PLACES = 16 };

/* A triangle, or what was cut from it, with what it was cut into. */
struct node {
    double p[3][3];
    uint32_t first, count;
};

/* A triangle that may cover pieces of another one, and a box about it. */
struct cover {
    double p[3][3], normal[3], lo[3], hi[3];
};

struct knife {
    const swarf_solid *solid;
    const swarf_crossings *crossings;
    double gap;
    size_t place; /* of the triangle being cut */
    double corner[3], normal[3];
    struct node *nodes;
    size_t count, room;
    uint32_t *stack; /* nodes to look at */
    size_t stack_room;
    uint32_t *order; /* of the triangles it meets */
    size_t order_room;
    struct cover *covers;
    size_t cover_count, cover_room;
};

static double along(const double axis[3], const double origin[3], const double point[3])
{
    return axis[0] * (point[0] - origin[0]) + axis[1] * (point[1] - origin[1]) + axis[2] * (point[2] - origin[2]);
}

int swarf_solid_bounds(const swarf_solid *solid, const double point[3], const double normal[3])
{
    const double step = test_depth * SOLID_GAP * solid->all.slack;
    double before[3], behind[3];
    for (int k = 0; k < 3; k++) {
        before[k] = point[k] + step * normal[k];
        behind[k] = point[k] - step * normal[k];
    }
    return swarf_solid_inside(solid, behind) - swarf_solid_inside(solid, before);
}

/* ---- cutting ---- */

/* Whether a piece and a line's part from `from` to `to` come within `thin` of each other; `away` are the corners'
 * distances to the line, which the unit vector `across` stands on. Two figures are apart when a side of one says so. */
static int touches(const struct knife *knife, const struct node *node, const double from[3], const double to[3],
                   const double across[3], double thin, double away[3])
{
    for (int i = 0; i < 3; i++) away[i] = along(across, from, node->p[i]);
    if ((away[0] > thin && away[1] > thin && away[2] > thin) || (away[0] < -thin && away[1] < -thin && away[2] < -thin))
        return 0;
    for (int i = 0; i < 3; i++) {
        double edge[3], outwards[3];
        for (int k = 0; k < 3; k++) edge[k] = node->p[(i + 1) % 3][k] - node->p[i][k];
        vector_cross(edge, knife->normal, outwards);
        if (!vector_normalise(outwards)) continue;
        if (along(outwards, node->p[i], from) > thin && along(outwards, node->p[i], to) > thin) return 0;
    }
    return 1;
}

static void add_node(struct knife *knife, const double a[3], const double b[3], const double c[3])
{
    struct node *node = &knife->nodes[knife->count++];
    memcpy(node->p[0], a, sizeof node->p[0]);
    memcpy(node->p[1], b, sizeof node->p[1]);
    memcpy(node->p[2], c, sizeof node->p[2]);
    node->first = node->count = 0;
}

/* Where the line passes an edge, by how far its ends are from it. */
static void point_on_edge(const double a[3], const double b[3], double away_a, double away_b, double out[3])
{
    const double t = away_a / (away_a - away_b);
    for (int k = 0; k < 3; k++) out[k] = a[k] + t * (b[k] - a[k]);
}

static double square_between(const double a[3], const double b[3])
{
    const double v[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return vector_dot(v, v);
}

static swarf_status cut_node(struct knife *knife, size_t number, const double away[3], double thin)
{
    int side[3], above = 0, below = 0;
    for (int i = 0; i < 3; i++) {
        side[i] = away[i] > thin ? 1 : away[i] < -thin ? -1 : 0;
        above += side[i] > 0;
        below += side[i] < 0;
    }
    if (!above || !below) return SWARF_OK;
    if (knife->count + 3 > MOST_NODES)
        return swarf_fail(SWARF_ERROR_GEOMETRY,
                          "mesh: triangle %u crosses so many others that it falls into more than a million pieces; "
                          "unite the shells before",
                          knife->solid->source[knife->place]);
    SWARF_TRY(swarf_array_reserve((void **)&knife->nodes, &knife->room, knife->count + 3, sizeof *knife->nodes));
    int first = 0; /* the corner on the line, or the one that is alone on its side */
    const int alone = above + below == 2 ? 0 : above == 1 ? 1 : -1;
    while (side[first] != alone) first++;
    const int second = (first + 1) % 3, third = (first + 2) % 3;
    struct node node = knife->nodes[number];
    const double *a = node.p[first], *b = node.p[second], *c = node.p[third];
    double x[3], y[3];
    node.first = (uint32_t)knife->count;
    if (alone == 0) {
        point_on_edge(b, c, away[second], away[third], x);
        add_node(knife, a, b, x);
        add_node(knife, a, x, c);
    } else {
        point_on_edge(a, b, away[first], away[second], x);
        point_on_edge(a, c, away[first], away[third], y);
        add_node(knife, a, x, y);
        const int other = square_between(x, c) > square_between(b, y);
        add_node(knife, x, b, other ? y : c);
        add_node(knife, other ? b : x, c, y);
    }
    node.count = (uint32_t)knife->count - node.first;
    knife->nodes[number] = node;
    return SWARF_OK;
}

/* Cut all pieces that the straight line between two points touches. */
static swarf_status cut_line(struct knife *knife, const double from[3], const double to[3])
{
    const double thin = least_cut * knife->gap;
    double way[3], across[3], away[3];
    for (int k = 0; k < 3; k++) way[k] = to[k] - from[k];
    vector_cross(knife->normal, way, across);
    if (vector_dot(way, way) <= thin * thin || !vector_normalise(across)) return SWARF_OK;
    size_t depth = 1;
    SWARF_TRY(swarf_array_reserve((void **)&knife->stack, &knife->stack_room, 1, sizeof *knife->stack));
    knife->stack[0] = 0;
    while (depth > 0) {
        const uint32_t number = knife->stack[--depth];
        const struct node *node = &knife->nodes[number];
        if (!touches(knife, node, from, to, across, thin, away)) continue;
        if (node->count == 0) {
            SWARF_TRY(cut_node(knife, number, away, thin));
            continue;
        }
        SWARF_TRY(
            swarf_array_reserve((void **)&knife->stack, &knife->stack_room, depth + node->count, sizeof *knife->stack));
        for (uint32_t i = 0; i < node->count; i++) knife->stack[depth++] = node->first + i;
    }
    return SWARF_OK;
}

/* Keep the part of a convex figure with sign * height <= limit (I. E. Sutherland and G. W. Hodgman, 1974). */
static int clip(const double (*in)[4], int count, double sign, double limit, double (*out)[4])
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        const double *a = in[i], *b = in[(i + 1) % count];
        const double over_a = sign * a[3] - limit, over_b = sign * b[3] - limit;
        if (over_a <= 0) memcpy(out[kept++], a, sizeof out[0]);
        if ((over_a <= 0) == (over_b <= 0)) continue;
        for (int k = 0; k < 4; k++) out[kept][k] = a[k] + over_a / (over_a - over_b) * (b[k] - a[k]);
        kept++;
    }
    return kept;
}

/* The line that another triangle leaves in the plane of this one, and its edges there. */
static swarf_status cut_by_line(struct knife *knife, const double (*q)[4])
{
    double ends[3][3];
    int count = 0;
    for (int i = 0; i < 3; i++) {
        const double *a = q[i], *b = q[(i + 1) % 3];
        if ((a[3] > 0) != (b[3] > 0)) point_on_edge(a, b, a[3], b[3], ends[count++]);
        if (fabs(a[3]) <= knife->gap && fabs(b[3]) <= knife->gap) SWARF_TRY(cut_line(knife, a, b));
    }
    return count == 2 ? cut_line(knife, ends[0], ends[1]) : SWARF_OK;
}

static swarf_status cut_by_triangle(struct knife *knife, size_t other)
{
    const swarf_corners *t = &knife->solid->corners[other];
    double q[3][4], normal[3], sine[3], part[2][8][4]; /* corners and their heights above the plane */
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) q[i][k] = t->xyz[i][k];
        q[i][3] = along(knife->normal, knife->corner, q[i]);
    }
    swarf_corners_normal(t, normal);
    const int has_normal = vector_normalise(normal) > 0;
    vector_cross(normal, knife->normal, sine);
    if (!has_normal || vector_dot(sine, sine) > least_sine * least_sine) return cut_by_line(knife, q);
    int count = clip(q, 3, 1, knife->gap, part[0]);
    count = clip(part[0], count, -1, knife->gap, part[1]);
    for (int i = 0; i < count; i++) /* drop it on the plane */
        for (int k = 0; k < 3; k++) part[1][i][k] -= part[1][i][3] * knife->normal[k];
    for (int i = 0; i < count; i++) SWARF_TRY(cut_line(knife, part[1][i], part[1][(i + 1) % count]));
    return SWARF_OK;
}

/* Cut the triangle at knife->place along all others that it meets. */
static swarf_status cut_triangle(struct knife *knife)
{
    const uint32_t *other = knife->crossings->other + knife->crossings->first[knife->place];
    const size_t count = knife->crossings->first[knife->place + 1] - knife->crossings->first[knife->place];
    double p[3][3];
    for (int i = 0; i < 9; i++) p[i / 3][i % 3] = knife->solid->corners[knife->place].xyz[i / 3][i % 3];
    memcpy(knife->corner, p[0], sizeof knife->corner);
    knife->count = 0;
    SWARF_TRY(swarf_array_reserve((void **)&knife->nodes, &knife->room, 1, sizeof *knife->nodes));
    add_node(knife, p[0], p[1], p[2]);
    SWARF_TRY(swarf_array_reserve((void **)&knife->order, &knife->order_room, count, sizeof *knife->order));
    memcpy(knife->order, other, count * sizeof *knife->order);
    uint64_t state = knife->place;
    for (size_t i = count; i-- > 0;) {
        const size_t j = swarf_mix_next(&state) % (i + 1);
        const uint32_t now = knife->order[j];
        knife->order[j] = knife->order[i];
        SWARF_TRY(cut_by_triangle(knife, now));
    }
    return SWARF_OK;
}

/* ---- what remains ---- */

/* List the triangles that may cover pieces of this one: they come before it, in its plane, facing its way. */
static swarf_status find_covers(struct knife *knife)
{
    const size_t first = knife->crossings->first[knife->place], end = knife->crossings->first[knife->place + 1];
    knife->cover_count = 0;
    SWARF_TRY(swarf_array_reserve((void **)&knife->covers, &knife->cover_room, end - first, sizeof *knife->covers));
    for (size_t i = first; i < end; i++) {
        const size_t other = knife->crossings->other[i];
        if (other > knife->place) continue;
        struct cover cover;
        for (int j = 0; j < 9; j++) cover.p[j / 3][j % 3] = knife->solid->corners[other].xyz[j / 3][j % 3];
        swarf_corners_normal(&knife->solid->corners[other], cover.normal);
        if (!vector_normalise(cover.normal) || vector_dot(cover.normal, knife->normal) < least_true_cosine) continue;
        for (int k = 0; k < 3; k++) {
            cover.lo[k] = fmin(cover.p[0][k], fmin(cover.p[1][k], cover.p[2][k])) - 2 * knife->gap;
            cover.hi[k] = fmax(cover.p[0][k], fmax(cover.p[1][k], cover.p[2][k])) + 2 * knife->gap;
        }
        knife->covers[knife->cover_count++] = cover;
    }
    return SWARF_OK;
}

/* Whether one of them covers a piece. */
static int is_covered(const struct knife *knife, double p[3][3])
{
    const double flush = same_plane * knife->gap;
    for (size_t i = 0; i < knife->cover_count; i++) {
        const struct cover *cover = &knife->covers[i];
        int covers = 1;
        for (int k = 0; k < 3; k++) covers &= p[0][k] >= cover->lo[k] && p[0][k] <= cover->hi[k];
        for (int j = 0; j < 9 && covers; j++) {
            double edge[3], outwards[3];
            for (int k = 0; k < 3; k++) edge[k] = cover->p[(j / 3 + 1) % 3][k] - cover->p[j / 3][k];
            vector_cross(edge, cover->normal, outwards);
            covers = vector_normalise(outwards) && along(outwards, cover->p[j / 3], p[j % 3]) <= knife->gap &&
                     fabs(along(cover->normal, cover->p[0], p[j % 3])) <= flush;
        }
        if (covers) return 1;
    }
    return 0;
}

/* Not inlined: GCC 12 forgets in vectors (-O3) that a double was rounded to float, and takes what has no area for more.
 */
static __attribute__((noinline)) void round_corners(double p[3][3], swarf_corners *out)
{
    for (int i = 0; i < 9; i++) out->xyz[i / 3][i % 3] = (float)p[i / 3][i % 3];
}

static swarf_status add_piece(swarf_pieces *pieces, const swarf_piece *piece)
{
    SWARF_TRY(swarf_array_reserve((void **)&pieces->list, &pieces->room, pieces->count + 1, sizeof *pieces->list));
    pieces->list[pieces->count++] = *piece;
    return SWARF_OK;
}

/* Add a piece to those that bound the solid, if it does; clear *whole if it does not, or from its other side. */
static swarf_status take_piece(const struct knife *knife, double p[3][3], swarf_pieces *pieces, int *whole)
{
    swarf_piece piece = {.place = (uint32_t)knife->place, .state = SOLID_SLIVER};
    double middle[3], normal[3];
    round_corners(p, &piece.corners);
    for (int k = 0; k < 3; k++) middle[k] = (p[0][k] + p[1][k] + p[2][k]) / 3;
    swarf_corners_normal(&piece.corners, normal);
    if (!vector_normalise(normal)) return SWARF_OK;
    const int bounds = swarf_solid_bounds(knife->solid, middle, knife->normal);
    const int counts = bounds != 0 && !is_covered(knife, p);
    if (!counts || bounds < 0) *whole = 0;
    if (!counts) return SWARF_OK;
    if (bounds > 0 && vector_dot(normal, knife->normal) > least_true_cosine) piece.state = SOLID_PIECE;
    return add_piece(pieces, &piece);
}

/* Add what bounds the solid of the triangle that was cut: all of it in one where each piece does. */
static swarf_status take_pieces(const struct knife *knife, swarf_pieces *pieces)
{
    const size_t before = pieces->count;
    const swarf_piece all = {.corners = knife->solid->corners[knife->place],
                             .place = (uint32_t)knife->place,
                             .state = SOLID_PIECE,
                             .whole = 1};
    int whole = 1;
    for (size_t i = 0; i < knife->count; i++)
        if (knife->nodes[i].count == 0) SWARF_TRY(take_piece(knife, knife->nodes[i].p, pieces, &whole));
    if (!whole || pieces->count == before) return SWARF_OK;
    pieces->count = before;
    return add_piece(pieces, &all);
}

struct piece_work {
    const swarf_solid *solid;
    const swarf_crossings *crossings;
    const uint32_t *places; /* that meet others */
    size_t count;
    swarf_pieces *found; /* per piece of work */
};

static swarf_status cut_places(void *context, size_t index)
{
    const struct piece_work *work = context;
    const size_t end = (index + 1) * PLACES < work->count ? (index + 1) * PLACES : work->count;
    struct knife knife = {
        .solid = work->solid, .crossings = work->crossings, .gap = SOLID_GAP * work->solid->all.slack};
    swarf_status status = SWARF_OK;
    for (size_t i = index * PLACES; i < end && status == SWARF_OK; i++) {
        knife.place = work->places[i];
        swarf_corners_normal(&work->solid->corners[knife.place], knife.normal);
        if (!vector_normalise(knife.normal)) continue; /* a line bounds nothing */
        status = cut_triangle(&knife);
        if (status == SWARF_OK) status = find_covers(&knife);
        if (status == SWARF_OK) status = take_pieces(&knife, &work->found[index]);
    }
    free(knife.nodes);
    free(knife.stack);
    free(knife.order);
    free(knife.covers);
    return status;
}

static swarf_status join_pieces(const swarf_pieces *parts, size_t count, swarf_pieces *out)
{
    size_t total = 0;
    for (size_t i = 0; i < count; i++) total += parts[i].count;
    SWARF_TRY(swarf_array_reserve((void **)&out->list, &out->room, total + 1, sizeof *out->list));
    for (size_t i = 0; i < count; i++) {
        if (parts[i].count) memcpy(out->list + out->count, parts[i].list, parts[i].count * sizeof *out->list);
        out->count += parts[i].count;
    }
    return SWARF_OK;
}

swarf_status swarf_pieces_cut(const swarf_solid *solid, const swarf_crossings *crossings,
                              const swarf_progress *progress, double from, double to, swarf_pieces *out)
{
    const size_t count = (crossings->count + PLACES - 1) / PLACES;
    struct piece_work work = {.solid = solid, .crossings = crossings};
    swarf_pieces pieces = {.list = NULL};
    uint32_t *places = malloc((crossings->count + 1) * sizeof *places);
    work.places = places;
    work.found = calloc(count + 1, sizeof *work.found);
    swarf_status status = SWARF_OK;
    if (!places || !work.found) status = swarf_fail(SWARF_ERROR_MEMORY, "solid: out of memory");
    for (size_t i = 0; i < solid->tree.count && status == SWARF_OK && crossings->count; i++)
        if (crossings->first[i] < crossings->first[i + 1]) places[work.count++] = (uint32_t)i;
    if (status == SWARF_OK) status = swarf_parallel_for(count, cut_places, &work, progress, from, to);
    if (status == SWARF_OK) status = join_pieces(work.found, count, &pieces);
    for (size_t i = 0; work.found && i < count; i++) free(work.found[i].list);
    free(work.found);
    free(places);
    if (status != SWARF_OK) {
        swarf_pieces_free(&pieces);
        return status;
    }
    *out = pieces;
    return SWARF_OK;
}

void swarf_pieces_free(swarf_pieces *pieces)
{
    free(pieces->list);
    memset(pieces, 0, sizeof *pieces);
}
