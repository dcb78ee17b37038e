/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Sixteen floats side by side, in whatever registers the file that includes this is compiled for.
 *
 * + - * / are the compiler's own; minimum(a, b) is a < b ? a : b as in the processor's instruction, so that zeros and
 * NAN behave the same everywhere. Division and square root are the exactly rounded ones: estimates differ between
 * processors. */
#ifndef SWARF_BASE_LANES_H
#define SWARF_BASE_LANES_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

typedef float lanes __attribute__((vector_size(64)));
typedef float octet __attribute__((vector_size(32)));
enum { LANES = 16 };

#if defined(__AVX2__)
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline __attribute__((unused)) /* the reference need not be fast, but quick to compile */
#endif

INLINE lanes all(float a)
{
    return (lanes){a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a};
}
INLINE lanes load(const float *from)
{
    lanes a;
    memcpy(&a, from, sizeof a);
    return a;
}
INLINE void store(float *to, lanes a)
{
    memcpy(to, &a, sizeof a);
}
INLINE octet all8(float a)
{
    return (octet){a, a, a, a, a, a, a, a};
}
INLINE octet load8(const float *from)
{
    octet a;
    memcpy(&a, from, sizeof a);
    return a;
}
INLINE void store8(float *to, octet a)
{
    memcpy(to, &a, sizeof a);
}

#if defined(__AVX512F__)

typedef __mmask16 mask;
INLINE lanes minimum(lanes a, lanes b)
{
    return (lanes)_mm512_min_ps((__m512)a, (__m512)b);
}
INLINE lanes maximum(lanes a, lanes b)
{
    return (lanes)_mm512_max_ps((__m512)a, (__m512)b);
}
INLINE lanes root(lanes a)
{
    return (lanes)_mm512_sqrt_ps((__m512)a);
}
INLINE mask less(lanes a, lanes b)
{
    return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
}
INLINE mask both(mask a, mask b)
{
    return a & b;
}
INLINE mask either(mask a, mask b)
{
    return a | b;
}
INLINE lanes pick(mask m, lanes a, lanes b)
{
    return (lanes)_mm512_mask_blend_ps(m, (__m512)b, (__m512)a);
}
INLINE unsigned bits(mask m)
{
    return m;
}
INLINE lanes gather(const float *from, const int32_t *at)
{
    return (lanes)_mm512_i32gather_ps(_mm512_loadu_si512(at), from, 4);
}

#elif defined(__AVX2__)

typedef struct mask {
    __m256 lo, hi;
} mask;
INLINE __m256 low(lanes a)
{
    return (__m256)__builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7);
}
INLINE __m256 high(lanes a)
{
    return (__m256)__builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15);
}
INLINE lanes join(__m256 a, __m256 b)
{
    return __builtin_shufflevector((octet)a, (octet)b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
INLINE lanes minimum(lanes a, lanes b)
{
    return join(_mm256_min_ps(low(a), low(b)), _mm256_min_ps(high(a), high(b)));
}
INLINE lanes maximum(lanes a, lanes b)
{
    return join(_mm256_max_ps(low(a), low(b)), _mm256_max_ps(high(a), high(b)));
}
INLINE lanes root(lanes a)
{
    return join(_mm256_sqrt_ps(low(a)), _mm256_sqrt_ps(high(a)));
}
INLINE mask less(lanes a, lanes b)
{
    return (mask){_mm256_cmp_ps(low(a), low(b), _CMP_LT_OQ), _mm256_cmp_ps(high(a), high(b), _CMP_LT_OQ)};
}
INLINE mask both(mask a, mask b)
{
    return (mask){_mm256_and_ps(a.lo, b.lo), _mm256_and_ps(a.hi, b.hi)};
}
INLINE mask either(mask a, mask b)
{
    return (mask){_mm256_or_ps(a.lo, b.lo), _mm256_or_ps(a.hi, b.hi)};
}
INLINE lanes pick(mask m, lanes a, lanes b)
{
    return join(_mm256_blendv_ps(low(b), low(a), m.lo), _mm256_blendv_ps(high(b), high(a), m.hi));
}
INLINE unsigned bits(mask m)
{
    return (unsigned)_mm256_movemask_ps(m.lo) | (unsigned)_mm256_movemask_ps(m.hi) << 8;
}
INLINE lanes gather(const float *from, const int32_t *at)
{
    return join(_mm256_i32gather_ps(from, _mm256_loadu_si256((const __m256i *)(const void *)at), 4),
                _mm256_i32gather_ps(from, _mm256_loadu_si256((const __m256i *)(const void *)(at + 8)), 4));
}

#else

typedef struct mask {
    int32_t bit[LANES];
} mask;
#define EACH_LANE for (int i = 0; i < LANES; i++)
INLINE lanes minimum(lanes a, lanes b)
{
    EACH_LANE a[i] = a[i] < b[i] ? a[i] : b[i];
    return a;
}
INLINE lanes maximum(lanes a, lanes b)
{
    EACH_LANE a[i] = a[i] > b[i] ? a[i] : b[i];
    return a;
}
INLINE lanes root(lanes a)
{
    EACH_LANE a[i] = sqrtf(a[i]);
    return a;
}
INLINE mask less(lanes a, lanes b)
{
    mask m;
    EACH_LANE m.bit[i] = a[i] < b[i];
    return m;
}
INLINE mask both(mask a, mask b)
{
    EACH_LANE a.bit[i] &= b.bit[i];
    return a;
}
INLINE mask either(mask a, mask b)
{
    EACH_LANE a.bit[i] |= b.bit[i];
    return a;
}
INLINE lanes pick(mask m, lanes a, lanes b)
{
    EACH_LANE b[i] = m.bit[i] ? a[i] : b[i];
    return b;
}
INLINE unsigned bits(mask m)
{
    unsigned word = 0;
    EACH_LANE word |= (unsigned)m.bit[i] << i;
    return word;
}
INLINE lanes gather(const float *from, const int32_t *at)
{
    lanes a;
    EACH_LANE a[i] = from[at[i]];
    return a;
}

#endif

#if defined(__AVX2__)
INLINE octet minimum8(octet a, octet b)
{
    return (octet)_mm256_min_ps((__m256)a, (__m256)b);
}
INLINE octet maximum8(octet a, octet b)
{
    return (octet)_mm256_max_ps((__m256)a, (__m256)b);
}
INLINE octet root8(octet a)
{
    return (octet)_mm256_sqrt_ps((__m256)a);
}
/* One bit per value with |a| < limit. */
INLINE unsigned within8(octet a, octet limit)
{
    const __m256 size = _mm256_andnot_ps(_mm256_set1_ps(-0.0f), (__m256)a);
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(size, (__m256)limit, _CMP_LT_OQ));
}
#else
INLINE octet minimum8(octet a, octet b)
{
    for (int i = 0; i < 8; i++) a[i] = a[i] < b[i] ? a[i] : b[i];
    return a;
}
INLINE octet maximum8(octet a, octet b)
{
    for (int i = 0; i < 8; i++) a[i] = a[i] > b[i] ? a[i] : b[i];
    return a;
}
INLINE octet root8(octet a)
{
    for (int i = 0; i < 8; i++) a[i] = sqrtf(a[i]);
    return a;
}
INLINE unsigned within8(octet a, octet limit)
{
    unsigned word = 0;
    for (int i = 0; i < 8; i++) word |= (unsigned)(fabsf(a[i]) < limit[i]) << i;
    return word;
}
#endif

INLINE lanes clamped(lanes a, lanes lo, lanes hi)
{
    return minimum(maximum(a, lo), hi);
}

/* |a| */
INLINE lanes magnitude(lanes a)
{
    typedef int32_t words __attribute__((vector_size(64)));
    return (lanes)((words)a & 0x7fffffff);
}

INLINE float least_lane(lanes a)
{
    float value[LANES];
    store(value, a);
    float least = value[0];
    for (int i = 1; i < LANES; i++) least = value[i] < least ? value[i] : least;
    return least;
}

/* Eight layers of 4 x 4 columns of voxels (lane = 4 * x + y) become eight pairs of columns: the eight voxels of column
 * (x, y), then those of (x, y + 1), in the order of x and y. */
#if defined(__AVX512F__)
INLINE void stand_up(lanes layer[8])
{
    __m512 quad[2][4]; /* [half of z][y]: four voxels above each other, at each x */
    for (int half = 0; half < 2; half++) {
        const __m512 a = (__m512)layer[4 * half], b = (__m512)layer[4 * half + 1], c = (__m512)layer[4 * half + 2],
                     d = (__m512)layer[4 * half + 3];
        const __m512d ab_low = (__m512d)_mm512_unpacklo_ps(a, b), ab_high = (__m512d)_mm512_unpackhi_ps(a, b);
        const __m512d cd_low = (__m512d)_mm512_unpacklo_ps(c, d), cd_high = (__m512d)_mm512_unpackhi_ps(c, d);
        quad[half][0] = (__m512)_mm512_unpacklo_pd(ab_low, cd_low);
        quad[half][1] = (__m512)_mm512_unpackhi_pd(ab_low, cd_low);
        quad[half][2] = (__m512)_mm512_unpacklo_pd(ab_high, cd_high);
        quad[half][3] = (__m512)_mm512_unpackhi_pd(ab_high, cd_high);
    }
    for (int y = 0; y < 4; y += 2) {
        const __m512 p = quad[0][y], q = quad[1][y], r = quad[0][y + 1], s = quad[1][y + 1];
        /* two x at a time of one column, then of its neighbour */
        const __m512 pq_low = _mm512_shuffle_f32x4(p, q, 0x44), pq_high = _mm512_shuffle_f32x4(p, q, 0xee);
        const __m512 rs_low = _mm512_shuffle_f32x4(r, s, 0x44), rs_high = _mm512_shuffle_f32x4(r, s, 0xee);
        layer[y / 2] = (lanes)_mm512_shuffle_f32x4(pq_low, rs_low, 0x88);
        layer[2 + y / 2] = (lanes)_mm512_shuffle_f32x4(pq_low, rs_low, 0xdd);
        layer[4 + y / 2] = (lanes)_mm512_shuffle_f32x4(pq_high, rs_high, 0x88);
        layer[6 + y / 2] = (lanes)_mm512_shuffle_f32x4(pq_high, rs_high, 0xdd);
    }
}
#else
/* Eight vectors of eight: rows become columns. */
INLINE void transpose8(octet r[8])
{
#define LOW_PAIRS(a, b) __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13)
#define HIGH_PAIRS(a, b) __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15)
#define LOW_QUADS(a, b) __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13)
#define HIGH_QUADS(a, b) __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15)
#define LOW_HALVES(a, b) __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11)
#define HIGH_HALVES(a, b) __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15)
    octet t[8], u[8];
    for (int i = 0; i < 4; i++) {
        t[2 * i] = LOW_PAIRS(r[2 * i], r[2 * i + 1]);
        t[2 * i + 1] = HIGH_PAIRS(r[2 * i], r[2 * i + 1]);
    }
    for (int i = 0; i < 2; i++) {
        u[4 * i] = LOW_QUADS(t[4 * i], t[4 * i + 2]);
        u[4 * i + 1] = HIGH_QUADS(t[4 * i], t[4 * i + 2]);
        u[4 * i + 2] = LOW_QUADS(t[4 * i + 1], t[4 * i + 3]);
        u[4 * i + 3] = HIGH_QUADS(t[4 * i + 1], t[4 * i + 3]);
    }
    for (int i = 0; i < 4; i++) {
        r[i] = LOW_HALVES(u[i], u[i + 4]);
        r[i + 4] = HIGH_HALVES(u[i], u[i + 4]);
    }
}
INLINE void stand_up(lanes layer[8])
{
    octet low[8], high[8];
    for (int z = 0; z < 8; z++) {
        low[z] = __builtin_shufflevector(layer[z], layer[z], 0, 1, 2, 3, 4, 5, 6, 7);
        high[z] = __builtin_shufflevector(layer[z], layer[z], 8, 9, 10, 11, 12, 13, 14, 15);
    }
    transpose8(low);
    transpose8(high);
    for (int i = 0; i < 4; i++) {
        layer[i] =
            __builtin_shufflevector(low[2 * i], low[2 * i + 1], 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        layer[4 + i] =
            __builtin_shufflevector(high[2 * i], high[2 * i + 1], 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }
}
#endif

#endif
