/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Shifting vertices until the mesh has the volume of the surface.
 *
 * Flat facets with their corners on a surface leave out volume where it bulges and add some where it is hollow. How
 * much each facet has lost is known: as it was made, by where the surface meets its voxel's edge, and for every vertex
 * that was left out since, by the tetrahedra between the facets before and after. A facet gets it back when its corners
 * move outwards by lost / area. A vertex moves by the least squares of what its facets ask for, so that on an edge it
 * moves with the one face and stays on the other, and where its facets bend less than an edge does, across them only.
 * What all of that comes to is not yet what all facets asked for: the rest is asked of those that are not flat, evenly,
 * and the shifts are found again.
 */
#include "mesh/facets.h"

#include "base/parallel.h"
#include "base/status.h"
#include "mesh/eigen.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 4096 };
/* tan^2 of half of 25 degrees: two faces as large as each other that meet less sharply are one. */
static const double least_eigenvalue = 0.049;
/* Facets turn by less than 18 degrees. */
static const double least_cosine = 0.95;
/* How often shifts are found; of what was lost, the rest that is not worth finding them again. */
enum { ROUNDS = 5 };
static const double settled = 1e-2;

typedef struct regaining {
    const swarf_facets *facets;
    const uint8_t *marks;
    double most;     /* mm */
    double flat;     /* mm: facets that lost less all over are flat */
    uint32_t *begin; /* of each vertex: its facets' first place in the list, and after the last vertex */
    uint32_t *list;
    float *shift;      /* of each vertex, mm */
    float *asked;      /* of each facet, mm3 */
    uint8_t *stays;    /* of each facet: it would turn */
    struct sums *sums; /* of each chunk of facets */
} regaining;

/* Volume that was lost and that shifts bring, in mm3; area of facets that are not flat, in mm2. */
typedef struct sums {
    double lost, gained, bent;
} sums;

static void sort_facets(regaining *r)
{
    const swarf_facets *facets = r->facets;
    for (size_t f = 0; f < facets->facet_count; f++)
        for (int k = 0; k < 3; k++) r->begin[facets->facet[f].v[k] + 1]++;
    for (size_t v = 0; v < facets->vertex_count; v++) r->begin[v + 1] += r->begin[v];
    for (size_t f = facets->facet_count; f-- > 0;)
        for (int k = 0; k < 3; k++) r->list[--r->begin[facets->facet[f].v[k] + 1]] = (uint32_t)f;
    /* each begin is now in the place after its own */
    memmove(r->begin, r->begin + 1, facets->vertex_count * sizeof *r->begin);
    r->begin[facets->vertex_count] = (uint32_t)(3 * facets->facet_count);
}

/* Twice a facet's area along its normal, its corners shifted or not. */
static void area_of(const regaining *r, size_t f, int shifted, double out[3])
{
    const uint32_t *v = r->facets->facet[f].v;
    double p[3][3];
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < 3; k++) {
            const size_t at = 3 * (size_t)v[i] + k;
            p[i][k] = (double)r->facets->xyz[at] + (shifted ? (double)r->shift[at] : 0);
        }
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        out[k] = (p[1][l] - p[0][l]) * (p[2][m] - p[0][m]) - (p[1][m] - p[0][m]) * (p[2][l] - p[0][l]);
    }
}

static void shift_vertex(const regaining *r, size_t vertex)
{
    double matrix[3][3] = {{0}}, asked[3] = {0}, value[3], vector[3][3], shift[3] = {0};
    for (uint32_t i = r->begin[vertex]; i < r->begin[vertex + 1]; i++) {
        double n[3];
        area_of(r, r->list[i], 0, n);
        const double twice = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (!(twice > 0)) continue;
        for (int k = 0; k < 3; k++) {
            for (int l = 0; l < 3; l++) matrix[k][l] += n[k] * n[l] / (2 * twice);
            asked[k] += (double)r->asked[r->list[i]] * n[k] / twice;
        }
    }
    swarf_eigen_symmetric((const double(*)[3])matrix, value, vector);
    for (int i = 0; i < 3 && value[i] > least_eigenvalue * value[0]; i++) {
        double along = 0;
        for (int k = 0; k < 3; k++) along += asked[k] * vector[i][k];
        for (int k = 0; k < 3; k++) shift[k] += along / value[i] * vector[i][k];
    }
    const double length = sqrt(shift[0] * shift[0] + shift[1] * shift[1] + shift[2] * shift[2]);
    for (int k = 0; k < 3; k++)
        r->shift[3 * vertex + (size_t)k] = (float)(length > r->most ? shift[k] * r->most / length : shift[k]);
}

static swarf_status shift_some(void *context, size_t index)
{
    const regaining *r = context;
    for (size_t v = index * CHUNK; v < (index + 1) * CHUNK && v < r->facets->vertex_count; v++)
        if (!r->marks || !(r->marks[v] & SWARF_VERTEX_LOCKED)) shift_vertex(r, v);
    return SWARF_OK;
}

static swarf_status look_at_some(void *context, size_t index)
{
    const regaining *r = context;
    for (size_t f = index * CHUNK; f < (index + 1) * CHUNK && f < r->facets->facet_count; f++) {
        double a[3], b[3];
        area_of(r, f, 0, a);
        area_of(r, f, 1, b);
        const double along = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        const double square = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
        r->stays[f] = !(along > 0 && along * along >= least_cosine * least_cosine * square);
    }
    return SWARF_OK;
}

/* Take the shifts of facets that would turn back; returns whether there are any. */
static int take_back(const regaining *r)
{
    int any = 0;
    for (size_t f = 0; f < r->facets->facet_count; f++) {
        if (!r->stays[f]) continue;
        for (int k = 0; k < 3; k++) {
            float *shift = r->shift + 3 * (size_t)r->facets->facet[f].v[k];
            any |= shift[0] != 0 || shift[1] != 0 || shift[2] != 0;
            memset(shift, 0, 3 * sizeof *shift);
        }
    }
    return any;
}

static int is_bent(const regaining *r, size_t f, double twice)
{
    return fabs((double)r->facets->facet[f].lost_mm3) > 0.5 * twice * r->flat;
}

/* A facet whose corners move evenly sweeps its mean area along the way of its middle. */
static swarf_status sum_some(void *context, size_t index)
{
    const regaining *r = context;
    sums *s = &r->sums[index];
    *s = (sums){0};
    for (size_t f = index * CHUNK; f < (index + 1) * CHUNK && f < r->facets->facet_count; f++) {
        const uint32_t *v = r->facets->facet[f].v;
        double a[3], b[3], square = 0;
        area_of(r, f, 0, a);
        area_of(r, f, 1, b);
        for (size_t k = 0; k < 3; k++) {
            double way = 0;
            for (int i = 0; i < 3; i++) way += (double)r->shift[3 * (size_t)v[i] + k];
            s->gained += 0.25 * (a[k] + b[k]) * way / 3;
            square += a[k] * a[k];
        }
        s->lost += (double)r->facets->facet[f].lost_mm3;
        if (is_bent(r, f, sqrt(square))) s->bent += 0.5 * sqrt(square);
    }
    return SWARF_OK;
}

static swarf_status sum_up(const regaining *r, sums *out)
{
    const size_t chunks = (r->facets->facet_count + CHUNK - 1) / CHUNK;
    SWARF_TRY(swarf_parallel_for(chunks, sum_some, (void *)r, NULL, 0, 1));
    *out = (sums){0};
    for (size_t i = 0; i < chunks; i++) {
        out->lost += r->sums[i].lost;
        out->gained += r->sums[i].gained;
        out->bent += r->sums[i].bent;
    }
    return SWARF_OK;
}

static void ask_more(const regaining *r, double height)
{
    for (size_t f = 0; f < r->facets->facet_count; f++) {
        double n[3];
        area_of(r, f, 0, n);
        const double twice = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (is_bent(r, f, twice)) r->asked[f] += (float)(height * 0.5 * twice);
    }
}

static float length_of(const float shift[3])
{
    return sqrtf(shift[0] * shift[0] + shift[1] * shift[1] + shift[2] * shift[2]);
}

static void apply(const regaining *r, swarf_facets *facets)
{
    for (size_t i = 0; i < 3 * facets->vertex_count; i++) facets->xyz[i] += r->shift[i];
    for (size_t f = 0; f < facets->facet_count; f++) {
        float most = 0;
        for (int k = 0; k < 3; k++) most = fmaxf(most, length_of(r->shift + 3 * (size_t)facets->facet[f].v[k]));
        facets->facet[f].error_mm += most;
        facets->facet[f].lost_mm3 = 0;
    }
}

static swarf_status find_shifts(regaining *r)
{
    const size_t vertices = (r->facets->vertex_count + CHUNK - 1) / CHUNK;
    const size_t facets = (r->facets->facet_count + CHUNK - 1) / CHUNK;
    SWARF_TRY(swarf_parallel_for(vertices, shift_some, r, NULL, 0, 1));
    do {
        SWARF_TRY(swarf_parallel_for(facets, look_at_some, r, NULL, 0, 1));
    } while (take_back(r));
    return SWARF_OK;
}

/* Shifts that bring what was lost, or most of it; none where they would bring the volume further from it. */
static swarf_status settle(regaining *r)
{
    sums s = {0};
    sort_facets(r);
    for (size_t f = 0; f < r->facets->facet_count; f++) r->asked[f] = r->facets->facet[f].lost_mm3;
    for (int round = 0; round < ROUNDS; round++) {
        SWARF_TRY(find_shifts(r));
        SWARF_TRY(sum_up(r, &s));
        if (!(fabs(s.lost - s.gained) > settled * fabs(s.lost)) || !(s.bent > 0)) break;
        if (round + 1 < ROUNDS) ask_more(r, (s.lost - s.gained) / s.bent);
    }
    if (fabs(s.lost - s.gained) > fabs(s.lost)) memset(r->shift, 0, 3 * r->facets->vertex_count * sizeof *r->shift);
    return SWARF_OK;
}

/* What positions are rounded by, in mm. */
static double rounding_of(const swarf_facets *facets)
{
    float most = 0;
    for (size_t i = 0; i < 3 * facets->vertex_count; i++) most = fmaxf(most, fabsf(facets->xyz[i]));
    return (double)(most * FLT_EPSILON);
}

swarf_status swarf_facets_regain(swarf_facets *facets, const uint8_t *marks, double most_mm, double flat_mm)
{
    regaining r = {.facets = facets,
                   .marks = marks,
                   .most = most_mm,
                   .flat = fmax(flat_mm, rounding_of(facets)),
                   .begin = calloc(facets->vertex_count + 2, sizeof *r.begin),
                   .list = malloc((3 * facets->facet_count + 1) * sizeof *r.list),
                   .shift = calloc(3 * facets->vertex_count + 1, sizeof *r.shift),
                   .asked = malloc((facets->facet_count + 1) * sizeof *r.asked),
                   .stays = malloc(facets->facet_count + 1),
                   .sums = malloc((facets->facet_count / CHUNK + 1) * sizeof *r.sums)};
    swarf_status status = SWARF_OK;
    if (!r.begin || !r.list || !r.shift || !r.asked || !r.stays || !r.sums)
        status = swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for shifting vertices");
    if (status == SWARF_OK) status = settle(&r);
    if (status == SWARF_OK) apply(&r, facets);
    free(r.begin);
    free(r.list);
    free(r.shift);
    free(r.asked);
    free(r.stays);
    free(r.sums);
    return status;
}
