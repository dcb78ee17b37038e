/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Hashes of numbers, for tables and for telling contents apart; nothing against those who look for equal ones. */
#ifndef SWARF_BASE_MIX_H
#define SWARF_BASE_MIX_H

#include <stdint.h>

/** Every bit of a number into every bit of another, one to one (splitmix64: G. L. Steele et al., "Fast splittable
 *  pseudorandom number generators", 2014). */
static inline uint64_t swarf_mix(uint64_t x)
{
    x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
    return x ^ x >> 31;
}

/** The hash of what `hash` is of and one word more; of nothing it is 0. */
static inline uint64_t swarf_mix_in(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    return hash ^ hash >> 29;
}

/** The same where words are many and may differ little: every bit of a word reaches every bit of the hash. */
static inline uint64_t swarf_mix_fold(uint64_t hash, uint64_t word)
{
    const unsigned __int128 product = (unsigned __int128)(hash ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    return ((uint64_t)product ^ (uint64_t)(product >> 64)) + UINT64_C(0x2545f4914f6cdd1d);
}

/** The next number of a row that looks random (splitmix64). */
static inline uint64_t swarf_mix_next(uint64_t *state)
{
    *state += UINT64_C(0x9e3779b97f4a7c15);
    return swarf_mix(*state);
}

#endif
