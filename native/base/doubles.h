/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sixteen doubles side by side, beside lanes.h: + - * / are the compiler's own, and it makes registers of them; what
 * compares it would take apart. larger(a, b) is a > b ? a : b as in the processor's instruction. */
#ifndef SWARF_BASE_DOUBLES_H
#define SWARF_BASE_DOUBLES_H

#include "base/lanes.h"

typedef double doubles __attribute__((vector_size(128)));
typedef int64_t longs __attribute__((vector_size(128)));

INLINE doubles all_doubles(double a)
{
    return (doubles){a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a};
}
INLINE doubles load_doubles(const double *from)
{
    doubles a;
    memcpy(&a, from, sizeof a);
    return a;
}
INLINE void store_doubles(double *to, doubles a)
{
    memcpy(to, &a, sizeof a);
}
/* The size of one with the sign of the other; the size is not negative. */
INLINE doubles with_sign(doubles size, doubles sign)
{
    return (doubles)((longs)size | ((longs)sign & (longs)all_doubles(-0.0)));
}

#if defined(__AVX512F__)

typedef union doubles_halves {
    doubles all;
    __m512d half[2];
} doubles_halves;
INLINE doubles lesser(doubles a, doubles b)
{
    doubles_halves x = {a}, y = {b};
    for (int i = 0; i < 2; i++) x.half[i] = _mm512_min_pd(x.half[i], y.half[i]);
    return x.all;
}
INLINE doubles larger(doubles a, doubles b)
{
    doubles_halves x = {a}, y = {b};
    for (int i = 0; i < 2; i++) x.half[i] = _mm512_max_pd(x.half[i], y.half[i]);
    return x.all;
}
INLINE doubles root_doubles(doubles a)
{
    doubles_halves x = {a};
    for (int i = 0; i < 2; i++) x.half[i] = _mm512_sqrt_pd(x.half[i]);
    return x.all;
}
/* A bit per a <= b. */
INLINE unsigned up_to(doubles a, doubles b)
{
    const doubles_halves x = {a}, y = {b};
    return (unsigned)_mm512_cmp_pd_mask(x.half[0], y.half[0], _CMP_LE_OQ) |
           (unsigned)_mm512_cmp_pd_mask(x.half[1], y.half[1], _CMP_LE_OQ) << 8;
}
INLINE lanes narrow(doubles a)
{
    const doubles_halves x = {a};
    return (lanes)_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(x.half[0])), _mm512_cvtpd_ps(x.half[1]), 1);
}

#elif defined(__AVX2__)

typedef union doubles_quarters {
    doubles all;
    __m256d quarter[4];
} doubles_quarters;
INLINE doubles lesser(doubles a, doubles b)
{
    doubles_quarters x = {a}, y = {b};
    for (int i = 0; i < 4; i++) x.quarter[i] = _mm256_min_pd(x.quarter[i], y.quarter[i]);
    return x.all;
}
INLINE doubles larger(doubles a, doubles b)
{
    doubles_quarters x = {a}, y = {b};
    for (int i = 0; i < 4; i++) x.quarter[i] = _mm256_max_pd(x.quarter[i], y.quarter[i]);
    return x.all;
}
INLINE doubles root_doubles(doubles a)
{
    doubles_quarters x = {a};
    for (int i = 0; i < 4; i++) x.quarter[i] = _mm256_sqrt_pd(x.quarter[i]);
    return x.all;
}
INLINE unsigned up_to(doubles a, doubles b)
{
    const doubles_quarters x = {a}, y = {b};
    unsigned word = 0;
    for (int i = 0; i < 4; i++)
        word |= (unsigned)_mm256_movemask_pd(_mm256_cmp_pd(x.quarter[i], y.quarter[i], _CMP_LE_OQ)) << (4 * i);
    return word;
}
INLINE lanes narrow(doubles a)
{
    const doubles_quarters x = {a};
    return join(_mm256_set_m128(_mm256_cvtpd_ps(x.quarter[1]), _mm256_cvtpd_ps(x.quarter[0])),
                _mm256_set_m128(_mm256_cvtpd_ps(x.quarter[3]), _mm256_cvtpd_ps(x.quarter[2])));
}

#else

INLINE doubles lesser(doubles a, doubles b)
{
    EACH_LANE a[i] = a[i] < b[i] ? a[i] : b[i];
    return a;
}
INLINE doubles larger(doubles a, doubles b)
{
    EACH_LANE a[i] = a[i] > b[i] ? a[i] : b[i];
    return a;
}
INLINE doubles root_doubles(doubles a)
{
    EACH_LANE a[i] = sqrt(a[i]);
    return a;
}
INLINE unsigned up_to(doubles a, doubles b)
{
    unsigned word = 0;
    EACH_LANE word |= (unsigned)(a[i] <= b[i]) << i;
    return word;
}
INLINE lanes narrow(doubles a)
{
    lanes b;
    EACH_LANE b[i] = (float)a[i];
    return b;
}

#endif

#endif
