/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "mesh/eigen.h"

#include <math.h>
#include <string.h>

/* Turn the plane of axes p and q so that a[p][q] becomes 0 (Golub and Van Loan, section 8.5). */
static void rotate(double a[3][3], double v[3][3], int p, int q)
{
    if (a[p][q] == 0) return;
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;
    const int r = 3 - p - q;
    const double arp = a[r][p], arq = a[r][q], apq = a[p][q];
    a[p][p] -= t * apq;
    a[q][q] += t * apq;
    a[p][q] = a[q][p] = 0;
    a[r][p] = a[p][r] = c * arp - s * arq;
    a[r][q] = a[q][r] = s * arp + c * arq;
    for (int k = 0; k < 3; k++) {
        const double vp = v[p][k], vq = v[q][k];
        v[p][k] = c * vp - s * vq;
        v[q][k] = s * vp + c * vq;
    }
}

void swarf_eigen_symmetric(const double matrix[3][3], double value[3], double vector[3][3])
{
    double a[3][3], v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memcpy(a, matrix, sizeof a);
    /* convergence is quadratic: six sweeps leave nothing off the diagonal */
    for (int sweep = 0; sweep < 6; sweep++) {
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
    }
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 2; i++)
        for (int j = i + 1; j < 3; j++)
            if (a[order[j]][order[j]] > a[order[i]][order[i]]) {
                const int kept = order[i];
                order[i] = order[j];
                order[j] = kept;
            }
    for (int i = 0; i < 3; i++) {
        value[i] = a[order[i]][order[i]];
        memcpy(vector[i], v[order[i]], sizeof v[0]);
    }
}
