/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sixteen addresses side by side, beside counts.h and doubles.h: for lanes that read in different places. + is the
 * compiler's own. */
#ifndef SWARF_BASE_LONGS_H
#define SWARF_BASE_LONGS_H

#include "base/counts.h"
#include "base/doubles.h"

INLINE longs address_of(const void *place)
{
    const int64_t a = (int64_t)(intptr_t)place;
    return (longs){a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a};
}
INLINE longs widen(counts a)
{
    return __builtin_convertvector(a, longs);
}
/* Their lower halves. */
INLINE counts shorten(longs a)
{
    return __builtin_convertvector(a, counts);
}
INLINE doubles widen_counts(counts a)
{
    return __builtin_convertvector(a, doubles);
}
INLINE doubles widen_lanes(lanes a)
{
    return __builtin_convertvector(a, doubles);
}

#if defined(__AVX512F__)

typedef union longs_halves {
    longs all;
    __m512i half[2];
} longs_halves;
INLINE longs pick_longs(mask m, longs a, longs b)
{
    longs_halves x = {a}, y = {b};
    for (int i = 0; i < 2; i++) x.half[i] = _mm512_mask_blend_epi64((__mmask8)(m >> 8 * i), y.half[i], x.half[i]);
    return x.all;
}
/* Lanes that are not 0. */
INLINE mask is_set(longs a)
{
    const longs_halves x = {a};
    return (mask)(_mm512_test_epi64_mask(x.half[0], x.half[0]) | _mm512_test_epi64_mask(x.half[1], x.half[1]) << 8);
}
/* What lies at the addresses where m is set, else 0. */
INLINE counts gather_far(mask m, longs at)
{
    const longs_halves x = {at};
    const __m256i zero = _mm256_setzero_si256();
    const __m256i lo = _mm512_mask_i64gather_epi32(zero, (__mmask8)m, x.half[0], NULL, 1);
    const __m256i hi = _mm512_mask_i64gather_epi32(zero, (__mmask8)(m >> 8), x.half[1], NULL, 1);
    return (counts)_mm512_inserti64x4(_mm512_castsi256_si512(lo), hi, 1);
}
INLINE longs gather_longs(mask m, longs at)
{
    longs_halves x = {at};
    for (int i = 0; i < 2; i++)
        x.half[i] = _mm512_mask_i64gather_epi64(_mm512_setzero_si512(), (__mmask8)(m >> 8 * i), x.half[i], NULL, 1);
    return x.all;
}

#elif defined(__AVX2__)

typedef union longs_quarters {
    longs all;
    __m256i quarter[4];
} longs_quarters;
/* All bits of the lanes of m. */
INLINE longs_quarters spread(mask m)
{
    const __m256i lo = (__m256i)m.lo, hi = (__m256i)m.hi;
    longs_quarters x;
    x.quarter[0] = _mm256_cvtepi32_epi64(_mm256_castsi256_si128(lo));
    x.quarter[1] = _mm256_cvtepi32_epi64(_mm256_extracti128_si256(lo, 1));
    x.quarter[2] = _mm256_cvtepi32_epi64(_mm256_castsi256_si128(hi));
    x.quarter[3] = _mm256_cvtepi32_epi64(_mm256_extracti128_si256(hi, 1));
    return x;
}
INLINE longs pick_longs(mask m, longs a, longs b)
{
    const longs_quarters wide = spread(m);
    return (a & wide.all) | (b & ~wide.all);
}
INLINE mask is_set(longs a)
{
    const longs_quarters x = {a};
    unsigned none = 0;
    for (int i = 0; i < 4; i++)
        none |= (unsigned)_mm256_movemask_pd((__m256d)_mm256_cmpeq_epi64(x.quarter[i], _mm256_setzero_si256()))
                << 4 * i;
    return mask_of(~none);
}
INLINE counts gather_far(mask m, longs at)
{
    const longs_quarters x = {at};
    const __m128i zero = _mm_setzero_si128();
    const __m256i lo = (__m256i)m.lo, hi = (__m256i)m.hi;
    const __m128i a = _mm256_mask_i64gather_epi32(zero, NULL, x.quarter[0], _mm256_castsi256_si128(lo), 1);
    const __m128i b = _mm256_mask_i64gather_epi32(zero, NULL, x.quarter[1], _mm256_extracti128_si256(lo, 1), 1);
    const __m128i c = _mm256_mask_i64gather_epi32(zero, NULL, x.quarter[2], _mm256_castsi256_si128(hi), 1);
    const __m128i d = _mm256_mask_i64gather_epi32(zero, NULL, x.quarter[3], _mm256_extracti128_si256(hi, 1), 1);
    return join_counts(_mm256_set_m128i(b, a), _mm256_set_m128i(d, c));
}
INLINE longs gather_longs(mask m, longs at)
{
    const longs_quarters wide = spread(m);
    longs_quarters x = {at};
    for (int i = 0; i < 4; i++)
        x.quarter[i] = _mm256_mask_i64gather_epi64(_mm256_setzero_si256(), NULL, x.quarter[i], wide.quarter[i], 1);
    return x.all;
}

#else

INLINE longs pick_longs(mask m, longs a, longs b)
{
    EACH_LANE b[i] = m.bit[i] ? a[i] : b[i];
    return b;
}
INLINE mask is_set(longs a)
{
    mask m;
    EACH_LANE m.bit[i] = a[i] != 0;
    return m;
}
INLINE counts gather_far(mask m, longs at)
{
    counts a;
    EACH_LANE
    {
        int32_t value = 0;
        if (m.bit[i]) memcpy(&value, (const void *)(intptr_t)at[i], sizeof value);
        a[i] = value;
    }
    return a;
}
INLINE longs gather_longs(mask m, longs at)
{
    longs a;
    EACH_LANE
    {
        int64_t value = 0;
        if (m.bit[i]) memcpy(&value, (const void *)(intptr_t)at[i], sizeof value);
        a[i] = value;
    }
    return a;
}

#endif

INLINE doubles pick_doubles(mask m, doubles a, doubles b)
{
    return (doubles)pick_longs(m, (longs)a, (longs)b);
}

#endif
