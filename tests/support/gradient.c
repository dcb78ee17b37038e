/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "gradient.h"

#include <math.h>

double test_gradient(double (*value)(const void *of, const double p[3]), const void *of, const double at[3],
                     double step, double out[3])
{
    for (int k = 0; k < 3; k++) {
        double a[3] = {at[0], at[1], at[2]}, b[3] = {at[0], at[1], at[2]};
        a[k] -= step;
        b[k] += step;
        out[k] = (value(of, b) - value(of, a)) / (2 * step);
    }
    return sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
}
