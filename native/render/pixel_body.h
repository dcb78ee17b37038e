/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Light on sixteen pixels, and four colours to bytes; included once per instruction set, beside ray_body.h. */
#include "base/counts.h"
#include "render/ray_kernel.h"

/* A. Gooch, B. Gooch, P. Shirley, E. Cohen: A Non-Photorealistic Lighting Model for Automatic Technical Illustration,
 * SIGGRAPH 1998, section 4.2: blue and yellow shifts, and how much of the object's colour each side shows. Gentler
 * shifts and more of the colour than theirs: colours mean something here. */
static const float gooch_blue = 0.14f, gooch_yellow = 0.10f, gooch_alpha = 0.22f, gooch_beta = 0.86f;
/* How dark a closed pocket gets, and what is left of the light in a shadow. */
static const float sky_least = 0.12f, sun_least = 0.35f;

static void shade(const swarf_tones *in, float out[3][LANES])
{
    const lanes half = all(0.5f), one = all(1);
    const lanes cosine = all(in->light[0]) * load(in->normal[0]) + all(in->light[1]) * load(in->normal[1]) +
                         all(in->light[2]) * load(in->normal[2]);
    const lanes warmth = (half + half * cosine) * (all(sun_least) + all(1 - sun_least) * load(in->sun));
    const lanes open = all(sky_least) + all(1 - sky_least) * load(in->sky);
    for (int channel = 0; channel < 3; channel++) {
        const lanes base = load(in->base[channel]);
        const lanes cool = all(channel == 2 ? gooch_alpha + gooch_blue : gooch_alpha) * base;
        const lanes warm = all(gooch_beta) * base + all(channel == 2 ? 0 : gooch_yellow);
        store(out[channel], (warmth * warm + (one - warmth) * cool) * open);
    }
}

typedef uint8_t bytes __attribute__((vector_size(LANES)));

/* Values of 0 .. 1 of the table's steps. */
INLINE counts look_up(const int32_t srgb[SWARF_SRGB_SIZE + 1], lanes value)
{
    const lanes step = clamped(value, all(0), all(1)) * all(SWARF_SRGB_SIZE) + all(0.5f);
    return gather_counts(mask_of(0xffff), srgb, to_counts(step));
}

static void encode(const float colour[4 * 4], const int32_t srgb[SWARF_SRGB_SIZE + 1], uint8_t out[4 * 4])
{
    const lanes zero = all(0), one = all(1), c = load(colour);
    const lanes alpha = __builtin_shufflevector(c, c, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15);
    const lanes scale = pick(less(zero, alpha), one / alpha, zero);
    const counts opacity = to_counts(clamped(c, zero, one) * all(255) + all(0.5f));
    const bytes four = __builtin_convertvector(pick_counts(mask_of(0x8888), opacity, look_up(srgb, c * scale)), bytes);
    memcpy(out, &four, sizeof four);
}

static void encode_opaque(const float rgb[3][LANES], const int32_t srgb[SWARF_SRGB_SIZE + 1], unsigned which,
                          uint8_t out[4 * LANES])
{
    /* Where red, green, blue and opacity lie in a word, by the order of its bytes in memory. */
    enum { FIRST = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? 0 : 24, STEP = FIRST ? -8 : 8 };
    counts word = all_counts((int32_t)(255u << (FIRST + 3 * STEP))), old;
    memcpy(&old, out, sizeof old);
    for (int channel = 0; channel < 3; channel++) word |= look_up(srgb, load(rgb[channel])) << (FIRST + channel * STEP);
    word = pick_counts(mask_of(which), word, old);
    memcpy(out, &word, sizeof word);
}
