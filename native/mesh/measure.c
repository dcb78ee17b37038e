/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Measures of the shells of a mesh. Integrals over what a shell encloses are sums over the tetrahedra of its triangles
 * and one point (Lien and Kajiya 1984), taken at the middle of its box so that far away parts lose no digits. */
#include "base/status.h"
#include "mesh/eigen.h"
#include "mesh/halfedge.h"
#include "swarf/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct swarf_measures {
    swarf_shell whole;
    swarf_shell *shells;
    size_t shell_count;
    uint32_t *shell_of;
};

/* Sums of one shell on the way: volume, its first and second moments about `about`. */
typedef struct sums {
    double about[3], volume, first[3], second[3][3];
} sums;

static void add_triangle(sums *s, swarf_shell *shell, const float *p[3])
{
    double a[3][3], sum[3];
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++) a[k][c] = (double)p[k][c] - s->about[c];
    double u[3], v[3];
    for (int c = 0; c < 3; c++) {
        u[c] = a[1][c] - a[0][c];
        v[c] = a[2][c] - a[0][c];
        sum[c] = a[0][c] + a[1][c] + a[2][c];
    }
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double six = a[0][0] * n[0] + a[0][1] * n[1] + a[0][2] * n[2]; /* six times the tetrahedron's volume */
    shell->area_mm2 += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    s->volume += six / 6;
    for (int i = 0; i < 3; i++) {
        s->first[i] += six / 24 * sum[i];
        for (int j = 0; j < 3; j++)
            s->second[i][j] +=
                six / 120 * (a[0][i] * a[0][j] + a[1][i] * a[1][j] + a[2][i] * a[2][j] + sum[i] * sum[j]);
    }
}

/* Centre, inertia and principal axes from the sums. */
static void finish(const sums *s, swarf_shell *shell)
{
    shell->volume_mm3 = s->volume;
    if (!(fabs(s->volume) > 0)) return;
    double about[3], central[3][3], inertia[3][3], moment[3], axis[3][3], trace = 0;
    for (int i = 0; i < 3; i++) {
        about[i] = s->first[i] / s->volume;
        shell->centre[i] = s->about[i] + about[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) central[i][j] = s->second[i][j] - s->volume * about[i] * about[j];
    for (int i = 0; i < 3; i++) trace += central[i][i];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) inertia[i][j] = (i == j ? trace : 0) - central[i][j];
    memcpy(shell->inertia, inertia, sizeof inertia);
    swarf_eigen_symmetric(inertia, moment, axis);
    for (int i = 0; i < 3; i++) {
        shell->moment[i] = moment[2 - i];
        memcpy(shell->axis[i], axis[2 - i], sizeof shell->axis[i]);
    }
    /* one of the two directions of an axis: its greatest coordinate is positive; the third makes them right-handed */
    for (int i = 0; i < 2; i++) {
        double *x = shell->axis[i];
        const int most =
            fabs(x[0]) >= fabs(x[1]) ? (fabs(x[0]) >= fabs(x[2]) ? 0 : 2) : (fabs(x[1]) >= fabs(x[2]) ? 1 : 2);
        for (int k = 2; k >= 0 && x[most] < 0; k--)
            if (k != most) x[k] = -x[k];
        x[most] = fabs(x[most]);
    }
    const double *x = shell->axis[0], *y = shell->axis[1];
    for (int k = 0; k < 3; k++) shell->axis[2][k] = x[(k + 1) % 3] * y[(k + 2) % 3] - x[(k + 2) % 3] * y[(k + 1) % 3];
}

static void widen(swarf_box *box, const float *p)
{
    for (int c = 0; c < 3; c++) {
        box->lo[c] = fmin(box->lo[c], (double)p[c]);
        box->hi[c] = fmax(box->hi[c], (double)p[c]);
    }
}

static void begin_shell(swarf_shell *shell)
{
    memset(shell, 0, sizeof *shell);
    for (int c = 0; c < 3; c++) {
        shell->box.lo[c] = INFINITY;
        shell->box.hi[c] = -INFINITY;
    }
}

/* Boxes and numbers of vertices, edges and triangles. A vertex that shells touch in counts in each. */
static swarf_status count_parts(const swarf_triangles *t, const uint32_t *opposite, swarf_measures *m)
{
    size_t *begin = calloc(m->shell_count + 2, sizeof *begin);
    uint32_t *order = calloc(t->triangle_count + 1, sizeof *order),
             *seen = malloc((t->vertex_count + 1) * sizeof *seen);
    if (!begin || !order || !seen) {
        free(begin);
        free(order);
        free(seen);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for measuring");
    }
    memset(seen, 0xff, t->vertex_count * sizeof *seen);
    for (size_t i = 0; i < t->triangle_count; i++) begin[m->shell_of[i] + 1]++;
    for (size_t s = 0; s < m->shell_count; s++) begin[s + 1] += begin[s];
    for (size_t i = 0; i < t->triangle_count; i++) order[begin[m->shell_of[i]]++] = (uint32_t)i;
    for (size_t i = 0; i < t->triangle_count; i++) {
        const uint32_t number = m->shell_of[order[i]];
        swarf_shell *shell = &m->shells[number];
        shell->triangles++;
        for (size_t k = 0; k < 3; k++) {
            const size_t h = 3 * (size_t)order[i] + k;
            const uint32_t v = t->index[h];
            shell->edges += opposite[h] == SWARF_NO_HALFEDGE || opposite[h] > h;
            shell->open_edges += opposite[h] == SWARF_NO_HALFEDGE;
            widen(&shell->box, t->xyz + 3 * (size_t)v);
            if (seen[v] == number) continue;
            seen[v] = number;
            shell->vertices++;
        }
    }
    free(begin);
    free(order);
    free(seen);
    return SWARF_OK;
}

static void number_of_euler(swarf_shell *shell, size_t shells)
{
    shell->euler = (int64_t)shell->vertices - (int64_t)shell->edges + (int64_t)shell->triangles;
    shell->genus = shell->open_edges ? -1 : (int64_t)shells - shell->euler / 2;
}

static swarf_status integrate(const swarf_triangles *t, swarf_measures *m)
{
    sums *all = calloc(m->shell_count + 1, sizeof *all); /* the last: of the whole */
    if (!all) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for measuring");
    for (size_t s = 0; s < m->shell_count; s++) {
        const swarf_shell *shell = &m->shells[s];
        for (int c = 0; c < 3; c++) {
            all[s].about[c] = 0.5 * (shell->box.lo[c] + shell->box.hi[c]);
            m->whole.box.lo[c] = fmin(m->whole.box.lo[c], shell->box.lo[c]);
            m->whole.box.hi[c] = fmax(m->whole.box.hi[c], shell->box.hi[c]);
        }
        m->whole.vertices += shell->vertices;
        m->whole.edges += shell->edges;
        m->whole.open_edges += shell->open_edges;
        m->whole.triangles += shell->triangles;
    }
    sums *whole = &all[m->shell_count];
    for (int c = 0; c < 3; c++)
        if (m->shell_count) whole->about[c] = 0.5 * (m->whole.box.lo[c] + m->whole.box.hi[c]);
    for (size_t i = 0; i < t->triangle_count; i++) {
        const float *p[3];
        for (size_t k = 0; k < 3; k++) p[k] = t->xyz + 3 * (size_t)t->index[3 * i + k];
        add_triangle(&all[m->shell_of[i]], &m->shells[m->shell_of[i]], p);
        add_triangle(whole, &m->whole, p);
    }
    for (size_t s = 0; s < m->shell_count; s++) {
        number_of_euler(&m->shells[s], 1);
        finish(&all[s], &m->shells[s]);
        m->whole.genus += m->shells[s].genus;
    }
    number_of_euler(&m->whole, m->shell_count);
    finish(whole, &m->whole);
    free(all);
    return SWARF_OK;
}

static swarf_status measure(const swarf_triangles *t, swarf_measures *m)
{
    uint32_t *opposite;
    m->shell_of = malloc((t->triangle_count + 1) * sizeof *m->shell_of);
    if (!m->shell_of) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for measuring");
    SWARF_TRY(swarf_halfedges_create(t, &opposite));
    swarf_status status = swarf_halfedges_pieces(opposite, t->triangle_count, m->shell_of, &m->shell_count);
    if (status == SWARF_OK) {
        m->shells = calloc((m->shell_count + 1), sizeof *m->shells);
        if (!m->shells) status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for measuring");
    }
    if (status == SWARF_OK) {
        begin_shell(&m->whole);
        for (size_t s = 0; s < m->shell_count; s++) begin_shell(&m->shells[s]);
        status = count_parts(t, opposite, m);
    }
    free(opposite);
    return status == SWARF_OK ? integrate(t, m) : status;
}

swarf_status swarf_measures_create(const swarf_mesh *mesh, swarf_measures **out)
{
    SWARF_REQUIRE(mesh && out, "mesh: NULL");
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    swarf_measures *m = calloc(1, sizeof *m);
    if (!m) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for measuring");
    const swarf_status status = measure(&t, m);
    if (status != SWARF_OK) {
        swarf_measures_destroy(m);
        return status;
    }
    *out = m;
    return SWARF_OK;
}

void swarf_measures_destroy(swarf_measures *measures)
{
    if (!measures) return;
    free(measures->shells);
    free(measures->shell_of);
    free(measures);
}

swarf_shell swarf_measures_whole(const swarf_measures *measures)
{
    return measures->whole;
}

const swarf_shell *swarf_measures_shells(const swarf_measures *measures, size_t *count)
{
    *count = measures->shell_count;
    return measures->shells;
}

const uint32_t *swarf_measures_shell_of(const swarf_measures *measures)
{
    return measures->shell_of;
}
