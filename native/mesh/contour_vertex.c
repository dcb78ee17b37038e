/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The vertex of one cycle by the field alone: on a smooth face the point of the surface nearest to the middle of the
 * crossings, on edges and corners where the faces meet. Beside them, where the crossings are of faces, the surface
 * between voxels is these, not what values between the voxels' would be.
 *
 * Every crossing is a plane of a quadratic error function (Ju, Losasso, Schaefer, Warren 2002), solved about the middle
 * of the crossings with eigenvalues that carry nothing left out.
 */
#include "mesh/contour.h"

#include "base/vector.h"
#include "mesh/eigen.h"

#include <math.h>
#include <string.h>

/* Faces that differ by less than 30 degrees are one: the field's gradients turn by as much on a ball of three voxels.
 */
static const double same_face_cosine = 0.866;
/* Eigenvalues below this part of the greatest carry nothing but the noise of the gradients. */
static const double least_eigenvalue = 0.04;

void swarf_contour_middle(const contour_polygon *polygon, double out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = 0;
        for (int i = 0; i < polygon->count; i++) out[k] += polygon->point[i][k] / polygon->count;
    }
}

int swarf_contour_clamp(const contour_bounds *bounds, double x[3])
{
    int moved = 0;
    for (int k = 0; k < 3; k++) {
        const double above = x[k] > bounds->lo[k] ? x[k] : bounds->lo[k]; /* fmax() and fmin() are calls */
        const double kept = above < bounds->hi[k] ? above : bounds->hi[k];
        moved |= kept != x[k];
        x[k] = kept;
    }
    return moved;
}

/* Value and gradient of the field in voxels at a point of the cell. */
static void look(const contour_polygon *polygon, const double x[3], double *value, double gradient[3])
{
    const double *f = polygon->corner;
    *value = 0;
    gradient[0] = gradient[1] = gradient[2] = 0;
    for (int c = 0; c < 8; c++) {
        double weight[3], slope[3];
        for (int k = 0; k < 3; k++) {
            const int high = c >> (2 - k) & 1;
            weight[k] = high ? x[k] : 1 - x[k];
            slope[k] = high ? 1 : -1;
        }
        *value += f[c] * weight[0] * weight[1] * weight[2];
        gradient[0] += f[c] * slope[0] * weight[1] * weight[2];
        gradient[1] += f[c] * weight[0] * slope[1] * weight[2];
        gradient[2] += f[c] * weight[0] * weight[1] * slope[2];
    }
}

/* Newton's steps onto the surface within the cell. */
static void project(const contour_polygon *polygon, double x[3])
{
    for (int round = 0; round < 3; round++) {
        double value, gradient[3];
        look(polygon, x, &value, gradient);
        const double square = vector_dot(gradient, gradient);
        if (fabs(value) < 1e-5 || square < 1e-6) return;
        for (int k = 0; k < 3; k++) x[k] -= value * gradient[k] / square;
        swarf_contour_clamp(&polygon->bounds, x);
    }
}

/* Move along an edge to where it passes the bounds, if it does; through their slabs. */
static void move_inside(const contour_bounds *bounds, const double edge[3], double x[3])
{
    double lo = -4, hi = 4;
    for (int k = 0; k < 3; k++) {
        const double slope = edge[k];
        if (fabs(slope) < 1e-9) continue;
        const double first = (bounds->lo[k] - x[k]) / slope, last = (bounds->hi[k] - x[k]) / slope;
        const double from = first < last ? first : last, to = first < last ? last : first;
        lo = from > lo ? from : lo;
        hi = to < hi ? to : hi;
    }
    if (lo > hi) return;
    const double along = fmin(fmax(0, lo), hi);
    for (int k = 0; k < 3; k++) x[k] += along * edge[k];
}

/* Two planes, most of what comes, in closed form: their matrix has the eigenvalues 1 + c and 1 - c. */
static int meet_two(const contour_plane *a, const contour_plane *b, const double about[3], double least,
                    const contour_bounds *bounds, double out[3])
{
    const double *n = a->normal, *m = b->normal, c = vector_dot(n, m);
    if (!(1 - fabs(c) > least * (1 + fabs(c)))) return 0;
    const double r = vector_dot(n, a->point) - vector_dot(n, about), s = vector_dot(m, b->point) - vector_dot(m, about),
                 size = 1 - c * c;
    double edge[3];
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        out[k] = about[k] + ((r - c * s) * n[k] + (s - c * r) * m[k]) / size;
        edge[k] = (n[i] * m[j] - n[j] * m[i]) / sqrt(size);
    }
    move_inside(bounds, edge, out);
    return 1;
}

int swarf_contour_meet(const contour_plane *planes, int count, const double about[3], double least,
                       const contour_bounds *bounds, double out[3])
{
    double a[3][3] = {{0}}, right[3] = {0}, value[3], vector[3][3];
    if (count == 2 && meet_two(&planes[0], &planes[1], about, least, bounds, out)) return 2;
    for (int i = 0; i < count; i++) {
        const double *n = planes[i].normal;
        const double away = vector_dot(n, planes[i].point) - vector_dot(n, about);
        for (int r = 0; r < 3; r++) {
            for (int c = 0; c < 3; c++) a[r][c] += n[r] * n[c];
            right[r] += n[r] * away;
        }
    }
    swarf_eigen_symmetric(a, value, vector);
    int rank = 0;
    memcpy(out, about, 3 * sizeof *out);
    for (int i = 0; i < 3 && value[i] > least * value[0] && value[i] > 0; i++, rank++)
        for (int k = 0; k < 3; k++) out[k] += vector_dot(vector[i], right) / value[i] * vector[i][k];
    if (rank == 2) move_inside(bounds, vector[2], out);
    return rank;
}

static int outside(const double x[3])
{
    double most = 0;
    for (int k = 0; k < 3; k++) most = fmax(most, fmax(-x[k], x[k] - 1));
    return most > 0.01;
}

/* A corner that lies in another cell is not this cell's: its edge is, or its face. */
static int meet_inside(const contour_plane *planes, int count, const double about[3], const contour_bounds *bounds,
                       double out[3])
{
    double least = least_eigenvalue;
    int rank = swarf_contour_meet(planes, count, about, least, bounds, out);
    while (rank > 1 && outside(out) && 5 * least < 1) {
        least *= 5;
        rank = swarf_contour_meet(planes, count, about, least, bounds, out);
    }
    return rank;
}

void swarf_contour_rise(const contour_polygon *polygon, double x[3])
{
    double away = 0, normal[3] = {0};
    for (int i = 0; i < polygon->count; i++)
        for (int k = 0; k < 3; k++) {
            normal[k] += polygon->normal[i][k];
            away += polygon->normal[i][k] * (polygon->point[i][k] - x[k]);
        }
    const double length = sqrt(vector_dot(normal, normal));
    if (length > 0)
        for (int k = 0; k < 3; k++) x[k] += 0.5 * away / polygon->count * normal[k] / length;
}

int swarf_contour_vertex(const contour_polygon *polygon, double out[3])
{
    double x[3], least_dot = 1;
    swarf_contour_middle(polygon, x);
    for (int i = 0; i < polygon->count; i++)
        for (int j = 0; j < i; j++) least_dot = fmin(least_dot, vector_dot(polygon->normal[i], polygon->normal[j]));
    int rank = 1, by_faces = 0;
    for (int i = 0; i < polygon->count; i++) by_faces |= polygon->move[i] == SWARF_BY_FACES;
    if (least_dot < same_face_cosine) {
        const double middle[3] = {x[0], x[1], x[2]};
        contour_plane planes[12];
        for (int i = 0; i < polygon->count; i++) {
            memcpy(planes[i].point, polygon->point[i], sizeof planes[i].point);
            memcpy(planes[i].normal, polygon->normal[i], sizeof planes[i].normal);
        }
        rank = meet_inside(planes, polygon->count, middle, &polygon->bounds, x);
    } else if (by_faces)
        swarf_contour_rise(polygon, x);
    if ((swarf_contour_clamp(&polygon->bounds, x) || rank < 2) && !by_faces) project(polygon, x);
    memcpy(out, x, sizeof x);
    return rank;
}
