/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The least and the most of two numbers. fmin() and fmax() are calls, for the sake of NaNs that cannot come here. */
#ifndef SWARF_BASE_LEAST_H
#define SWARF_BASE_LEAST_H

static inline double swarf_least(double a, double b)
{
    return a < b ? a : b;
}

static inline double swarf_most(double a, double b)
{
    return a > b ? a : b;
}

#endif
