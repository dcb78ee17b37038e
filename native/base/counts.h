/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sixteen whole numbers side by side: what lanes.h lacks for walking through grids. + - & | << >> are the compiler's
 * own; >> of a negative number keeps the sign. */
#ifndef SWARF_BASE_COUNTS_H
#define SWARF_BASE_COUNTS_H

#include "base/lanes.h"

typedef int32_t counts __attribute__((vector_size(64)));

INLINE counts all_counts(int32_t a)
{
    return (counts){a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a};
}
INLINE void store_counts(int32_t *to, counts a)
{
    memcpy(to, &a, sizeof a);
}
INLINE lanes to_lanes(counts a)
{
    return __builtin_convertvector(a, lanes);
}
/* Towards zero; of numbers that an int32_t holds. */
INLINE counts to_counts(lanes a)
{
    return __builtin_convertvector(a, counts);
}

#if defined(__AVX512F__)

INLINE mask mask_of(unsigned bit)
{
    return (mask)bit;
}
INLINE mask except(mask a, mask b)
{
    return (mask)(a & ~b);
}
INLINE counts pick_counts(mask m, counts a, counts b)
{
    return (counts)_mm512_mask_blend_epi32(m, (__m512i)b, (__m512i)a);
}
/* Lanes where a & b is not 0. */
INLINE mask meets(counts a, counts b)
{
    return _mm512_test_epi32_mask((__m512i)a, (__m512i)b);
}
/* from[at] where m is set, else 0. */
INLINE counts gather_counts(mask m, const int32_t *from, counts at)
{
    return (counts)_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), m, (__m512i)at, from, 4);
}
INLINE counts least(counts a, counts b)
{
    return (counts)_mm512_min_epi32((__m512i)a, (__m512i)b);
}
INLINE counts greatest(counts a, counts b)
{
    return (counts)_mm512_max_epi32((__m512i)a, (__m512i)b);
}

#elif defined(__AVX2__)

INLINE __m256i low_counts(counts a)
{
    typedef int32_t half __attribute__((vector_size(32)));
    return (__m256i)(half)__builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7);
}
INLINE __m256i high_counts(counts a)
{
    typedef int32_t half __attribute__((vector_size(32)));
    return (__m256i)(half)__builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15);
}
INLINE counts join_counts(__m256i a, __m256i b)
{
    typedef int32_t half __attribute__((vector_size(32)));
    return __builtin_shufflevector((half)a, (half)b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
INLINE mask mask_of(unsigned bit)
{
    const __m256i each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i lo = _mm256_and_si256(_mm256_set1_epi32((int)bit), each);
    const __m256i hi = _mm256_and_si256(_mm256_set1_epi32((int)(bit >> 8)), each);
    return (mask){(__m256)_mm256_cmpeq_epi32(lo, each), (__m256)_mm256_cmpeq_epi32(hi, each)};
}
INLINE mask except(mask a, mask b)
{
    return (mask){_mm256_andnot_ps(b.lo, a.lo), _mm256_andnot_ps(b.hi, a.hi)};
}
INLINE counts pick_counts(mask m, counts a, counts b)
{
    return (counts)pick(m, (lanes)a, (lanes)b);
}
INLINE mask meets(counts a, counts b)
{
    const __m256i zero = _mm256_setzero_si256(), ones = _mm256_set1_epi32(-1);
    const __m256i lo = _mm256_cmpeq_epi32(_mm256_and_si256(low_counts(a), low_counts(b)), zero);
    const __m256i hi = _mm256_cmpeq_epi32(_mm256_and_si256(high_counts(a), high_counts(b)), zero);
    return (mask){(__m256)_mm256_xor_si256(lo, ones), (__m256)_mm256_xor_si256(hi, ones)};
}
INLINE counts gather_counts(mask m, const int32_t *from, counts at)
{
    const __m256i zero = _mm256_setzero_si256();
    return join_counts(_mm256_mask_i32gather_epi32(zero, from, low_counts(at), (__m256i)m.lo, 4),
                       _mm256_mask_i32gather_epi32(zero, from, high_counts(at), (__m256i)m.hi, 4));
}
INLINE counts least(counts a, counts b)
{
    return join_counts(_mm256_min_epi32(low_counts(a), low_counts(b)),
                       _mm256_min_epi32(high_counts(a), high_counts(b)));
}
INLINE counts greatest(counts a, counts b)
{
    return join_counts(_mm256_max_epi32(low_counts(a), low_counts(b)),
                       _mm256_max_epi32(high_counts(a), high_counts(b)));
}

#else

INLINE mask mask_of(unsigned bit)
{
    mask m;
    EACH_LANE m.bit[i] = (int32_t)(bit >> i & 1);
    return m;
}
INLINE mask except(mask a, mask b)
{
    EACH_LANE a.bit[i] &= ~b.bit[i];
    return a;
}
INLINE counts pick_counts(mask m, counts a, counts b)
{
    EACH_LANE b[i] = m.bit[i] ? a[i] : b[i];
    return b;
}
INLINE mask meets(counts a, counts b)
{
    mask m;
    EACH_LANE m.bit[i] = (a[i] & b[i]) != 0;
    return m;
}
INLINE counts gather_counts(mask m, const int32_t *from, counts at)
{
    counts a;
    EACH_LANE a[i] = m.bit[i] ? from[at[i]] : 0;
    return a;
}
INLINE counts least(counts a, counts b)
{
    EACH_LANE a[i] = a[i] < b[i] ? a[i] : b[i];
    return a;
}
INLINE counts greatest(counts a, counts b)
{
    EACH_LANE a[i] = a[i] > b[i] ? a[i] : b[i];
    return a;
}

#endif

#endif
