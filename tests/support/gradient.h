/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Gradients of functions of which only the values are known. */
#ifndef SWARF_TEST_GRADIENT_H
#define SWARF_TEST_GRADIENT_H

/** Gradient of value(of, p) at a place, from differences over `step` to either side; its length, which is 1 where the
 *  function is a smooth distance. */
double test_gradient(double (*value)(const void *of, const double p[3]), const void *of, const double at[3],
                     double step, double out[3]);

#endif
