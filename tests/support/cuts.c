/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "cuts.h"

#include <math.h>
#include <stdlib.h>

static double volume_of(const float *a, const float *b, const float *c, const float *d)
{
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)b[k] - a[k];
        v[k] = (double)c[k] - a[k];
        w[k] = (double)d[k] - a[k];
    }
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/* Whether the segment p q goes through the triangle's inside. */
static int pierces(const float *p, const float *q, const float *const t[3], double least)
{
    const double above = volume_of(t[0], t[1], t[2], p), below = volume_of(t[0], t[1], t[2], q);
    if (!((above > least && below < -least) || (above < -least && below > least))) return 0;
    const double e0 = volume_of(p, q, t[0], t[1]), e1 = volume_of(p, q, t[1], t[2]), e2 = volume_of(p, q, t[2], t[0]);
    return (e0 > least && e1 > least && e2 > least) || (e0 < -least && e1 < -least && e2 < -least);
}

size_t mesh_cuts(const swarf_mesh *mesh)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    float(*box)[6] = malloc((t.triangle_count + 1) * sizeof *box);
    size_t cuts = 0;
    for (size_t i = 0; box && i < t.triangle_count; i++)
        for (int c = 0; c < 3; c++) {
            const float x[3] = {t.xyz[3 * (size_t)t.index[3 * i] + (size_t)c],
                                t.xyz[3 * (size_t)t.index[3 * i + 1] + (size_t)c],
                                t.xyz[3 * (size_t)t.index[3 * i + 2] + (size_t)c]};
            box[i][c] = fminf(x[0], fminf(x[1], x[2]));
            box[i][3 + c] = fmaxf(x[0], fmaxf(x[1], x[2]));
        }
    for (size_t i = 0; box && i < t.triangle_count; i++)
        for (size_t j = 0; j < i; j++) {
            if (box[i][0] > box[j][3] || box[j][0] > box[i][3] || box[i][1] > box[j][4] || box[j][1] > box[i][4] ||
                box[i][2] > box[j][5] || box[j][2] > box[i][5])
                continue;
            const float *a[3], *b[3];
            for (size_t k = 0; k < 3; k++) {
                a[k] = t.xyz + 3 * (size_t)t.index[3 * i + k];
                b[k] = t.xyz + 3 * (size_t)t.index[3 * j + k];
            }
            int cut = 0;
            for (int k = 0; k < 3; k++)
                cut |= pierces(a[k], a[(k + 1) % 3], b, 1e-9) || pierces(b[k], b[(k + 1) % 3], a, 1e-9);
            cuts += (size_t)cut;
        }
    free(box);
    return cuts;
}
