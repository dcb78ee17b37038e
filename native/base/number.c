/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "base/number.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

static int is_digit(const char *p, const char *end)
{
    return p < end && *p >= '0' && *p <= '9';
}

/* An exponent counts only with a digit: "3em" is 3, then "em". */
static const char *read_exponent(const char *p, const char *end, int *scale)
{
    const char *digits = p;
    if (digits == end || (*digits != 'e' && *digits != 'E')) return p;
    digits++;
    int minus = 0, exponent = 0;
    if (digits < end && (*digits == '-' || *digits == '+')) minus = *digits++ == '-';
    if (!is_digit(digits, end)) return p;
    for (; is_digit(digits, end); digits++)
        if (exponent < 10000) exponent = 10 * exponent + (*digits - '0'); /* far beyond any double, far from overflow */
    *scale += minus ? -exponent : exponent;
    return digits;
}

/* In steps of exact powers, which neither overflow early nor lose a small mantissa. */
static double scaled(uint64_t mantissa, int scale)
{
    static const double power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    double value = (double)mantissa;
    for (; scale > 22 && value > 0 && value < INFINITY; scale -= 22) value *= 1e22;
    for (; scale < -22 && value > 0; scale += 22) value /= 1e22;
    if (!(value > 0 && value < INFINITY)) return value;
    return scale < 0 ? value / power[-scale] : value * power[scale];
}

const char *swarf_number_read(const char *at, const char *end, double *out)
{
    const char *p = at;
    int negative = 0, digits = 0, scale = 0, after_point = 0;
    uint64_t mantissa = 0;
    if (p < end && (*p == '-' || *p == '+')) negative = *p++ == '-';
    for (; is_digit(p, end) || (p < end && *p == '.' && !after_point); p++) {
        if (*p == '.') {
            after_point = 1;
            continue;
        }
        digits = 1;
        /* 18 digits are more than a double holds; later ones only move the point */
        if (mantissa < UINT64_C(100000000000000000)) {
            mantissa = 10 * mantissa + (uint64_t)(*p - '0');
            scale -= after_point;
        } else {
            scale += !after_point;
        }
    }
    if (!digits) return NULL;
    p = read_exponent(p, end, &scale);
    const double value = scaled(mantissa, scale);
    if (isinf(value)) return NULL;
    *out = negative ? -value : value;
    return p;
}
