/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A hash table with open addressing over the places of edges' corners. */
#include "mesh/crease.h"

#include "base/memory.h"
#include "base/mix.h"
#include "base/status.h"

#include <stdlib.h>
#include <string.h>

void swarf_crease_memo_free(swarf_crease_memo *memo)
{
    free(memo->splits);
    free(memo->slots);
    memset(memo, 0, sizeof *memo);
}

/* Where corners are, or the empty slot where they would be. */
static size_t find(const swarf_crease_memo *memo, const float corners[12])
{
    uint32_t bits[12];
    uint64_t hash = 0;
    memcpy(bits, corners, sizeof bits);
    for (int k = 0; k < 12; k++) hash = swarf_mix_in(hash, bits[k]);
    size_t at = (size_t)(hash >> 20) & (memo->slot_count - 1);
    while (memo->slots[at] && memcmp(memo->splits[memo->slots[at] - 1].corners, corners, sizeof bits) != 0)
        at = (at + 1) & (memo->slot_count - 1);
    return at;
}

const crease_split *swarf_crease_recall(const swarf_crease_memo *memo, const float corners[12])
{
    if (!memo->count) return NULL;
    const uint32_t slot = memo->slots[find(memo, corners)];
    return slot ? &memo->splits[slot - 1] : NULL;
}

/* Room for so many more. */
static swarf_status widen(swarf_crease_memo *memo, size_t more)
{
    const size_t needed = memo->count + more;
    SWARF_TRY(swarf_array_reserve((void **)&memo->splits, &memo->room, needed, sizeof *memo->splits));
    if (2 * needed <= memo->slot_count) return SWARF_OK;
    size_t slot_count = 16;
    while (slot_count < 4 * needed) slot_count *= 2;
    uint32_t *slots = calloc(slot_count, sizeof *slots);
    if (!slots || needed >= UINT32_MAX) {
        free(slots);
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory");
    }
    free(memo->slots);
    memo->slots = slots;
    memo->slot_count = slot_count;
    for (size_t i = 0; i < memo->count; i++) slots[find(memo, memo->splits[i].corners)] = (uint32_t)(i + 1);
    return SWARF_OK;
}

swarf_status swarf_crease_remember(swarf_crease_memo *memo, const crease_split *splits, size_t count)
{
    SWARF_TRY(widen(memo, count));
    for (size_t i = 0; i < count; i++) {
        const size_t at = find(memo, splits[i].corners);
        if (memo->slots[at]) continue;
        memo->splits[memo->count++] = splits[i];
        memo->slots[at] = (uint32_t)memo->count;
    }
    return SWARF_OK;
}
