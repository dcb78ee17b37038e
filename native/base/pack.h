/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* As many doubles side by side as fit one register, beside lanes.h: + - * / are the compiler's own. What is asked of
 * them comes as a bit per value. None may be NaN where the least or the most is asked for: their order must not matter.
 */
#ifndef SWARF_BASE_PACK_H
#define SWARF_BASE_PACK_H

#include "base/lanes.h"

#if defined(__AVX512F__)
enum { PACK = 8 };
#elif defined(__AVX2__)
enum { PACK = 4 };
#else
enum { PACK = 2 };
#endif
typedef double pack __attribute__((vector_size(8 * PACK)));
typedef int64_t pack_words __attribute__((vector_size(8 * PACK)));

INLINE pack pack_load(const double *from)
{
    pack a;
    memcpy(&a, from, sizeof a);
    return a;
}
INLINE void pack_store(double *to, pack a)
{
    memcpy(to, &a, sizeof a);
}
INLINE pack pack_size(pack a)
{
    return (pack)((pack_words)a & INT64_MAX);
}

#if defined(__AVX512F__)

INLINE pack pack_of(double a)
{
    return (pack)_mm512_set1_pd(a);
}
/* A bit per a < b. */
INLINE unsigned pack_below(pack a, pack b)
{
    return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ);
}
/* A bit per a <= b. */
INLINE unsigned pack_up_to(pack a, pack b)
{
    return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LE_OQ);
}
INLINE pack pack_root(pack a)
{
    return (pack)_mm512_sqrt_pd((__m512d)a);
}
/* a where there is a bit, else b. */
INLINE pack pack_pick(unsigned bits, pack a, pack b)
{
    return (pack)_mm512_mask_blend_pd((__mmask8)bits, (__m512d)b, (__m512d)a);
}
/* Of those with a bit; infinite without one. */
INLINE double pack_least(unsigned bits, pack a)
{
    return _mm512_mask_reduce_min_pd((__mmask8)bits, (__m512d)a);
}
INLINE double pack_most(unsigned bits, pack a)
{
    return _mm512_mask_reduce_max_pd((__mmask8)bits, (__m512d)a);
}
/* In any order: of whole numbers. */
INLINE double pack_sum(pack a)
{
    return _mm512_reduce_add_pd((__m512d)a);
}

#elif defined(__AVX2__)

INLINE pack pack_of(double a)
{
    return (pack)_mm256_set1_pd(a);
}
INLINE unsigned pack_below(pack a, pack b)
{
    return (unsigned)_mm256_movemask_pd(_mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_LT_OQ));
}
INLINE unsigned pack_up_to(pack a, pack b)
{
    return (unsigned)_mm256_movemask_pd(_mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_LE_OQ));
}
INLINE pack pack_root(pack a)
{
    return (pack)_mm256_sqrt_pd((__m256d)a);
}
INLINE pack pack_pick(unsigned bits, pack a, pack b)
{
    /* the bit of each value goes to the sign, which alone is looked at */
    const __m256i signs = _mm256_sllv_epi64(_mm256_set1_epi64x(bits), _mm256_setr_epi64x(63, 62, 61, 60));
    return (pack)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)signs);
}
INLINE double pack_least(unsigned bits, pack a)
{
    const __m256d four = (__m256d)pack_pick(bits, a, pack_of(INFINITY));
    const __m128d two = _mm_min_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
    return _mm_cvtsd_f64(_mm_min_sd(two, _mm_unpackhi_pd(two, two)));
}
INLINE double pack_most(unsigned bits, pack a)
{
    const __m256d four = (__m256d)pack_pick(bits, a, pack_of(-INFINITY));
    const __m128d two = _mm_max_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
    return _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)));
}
INLINE double pack_sum(pack a)
{
    return a[0] + a[1] + a[2] + a[3];
}

#else

INLINE pack pack_of(double a)
{
    return (pack){a, a};
}
INLINE unsigned pack_below(pack a, pack b)
{
    return (unsigned)(a[0] < b[0]) | (unsigned)(a[1] < b[1]) << 1;
}
INLINE unsigned pack_up_to(pack a, pack b)
{
    return (unsigned)(a[0] <= b[0]) | (unsigned)(a[1] <= b[1]) << 1;
}
INLINE pack pack_root(pack a)
{
    return (pack){sqrt(a[0]), sqrt(a[1])};
}
INLINE pack pack_pick(unsigned bits, pack a, pack b)
{
    const pack_words from = {-(int64_t)(bits & 1), -(int64_t)(bits >> 1 & 1)};
    return (pack)(((pack_words)a & from) | ((pack_words)b & ~from));
}
INLINE double pack_least(unsigned bits, pack a)
{
    a = pack_pick(bits, a, pack_of(INFINITY));
    return a[0] < a[1] ? a[0] : a[1];
}
INLINE double pack_most(unsigned bits, pack a)
{
    a = pack_pick(bits, a, pack_of(-INFINITY));
    return a[0] > a[1] ? a[0] : a[1];
}
INLINE double pack_sum(pack a)
{
    return a[0] + a[1];
}

#endif

#endif
