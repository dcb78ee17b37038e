/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* An open-addressing table of vertex numbers, at most half full, that grows with the vertices found: meshes name
 * near vertices one after the other, so that a small table stays in cache. */
#include "base/weld.h"

#include "base/mix.h"
#include "base/status.h"

#include <stdlib.h>
#include <string.h>

#define EMPTY UINT32_MAX

static uint64_t hash_position(const uint32_t bits[3])
{
    return swarf_mix_in(swarf_mix_in(swarf_mix_in(0, bits[0]), bits[1]), bits[2]);
}

static void read_bits(const float *p, uint32_t bits[3])
{
    for (int c = 0; c < 3; c++) {
        const float plain = p[c] + 0.0f; /* turns -0 into 0 */
        memcpy(&bits[c], &plain, sizeof plain);
    }
}

/* Slot that holds the position or where it would go. */
static size_t find_slot(const uint32_t *table, size_t size, const float *xyz, const uint32_t bits[3])
{
    for (size_t slot = (size_t)hash_position(bits) & (size - 1);; slot = (slot + 1) & (size - 1)) {
        if (table[slot] == EMPTY) return slot;
        uint32_t there[3];
        read_bits(xyz + 3 * (size_t)table[slot], there);
        if (memcmp(there, bits, sizeof there) == 0) return slot;
    }
}

static uint32_t *make_table(size_t size)
{
    uint32_t *table = malloc(size * sizeof *table);
    if (table) memset(table, 0xff, size * sizeof *table);
    return table;
}

swarf_status swarf_weld(float *xyz, size_t count, uint32_t *map, size_t *unique)
{
    SWARF_REQUIRE(count < EMPTY, "mesh: %zu vertices are more than 32-bit numbers can name", count);
    size_t size = 1024, used = 0;
    uint32_t *table = make_table(size);
    if (!table) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory for welding");
    for (size_t i = 0; i < count; i++) {
        uint32_t bits[3];
        if (2 * (used + 1) > size) {
            uint32_t *larger = make_table(4 * size);
            if (!larger) {
                free(table);
                return swarf_fail(SWARF_ERROR_MEMORY, "out of memory for welding %zu vertices", count);
            }
            for (size_t v = 0; v < used; v++) {
                read_bits(xyz + 3 * v, bits);
                larger[find_slot(larger, 4 * size, xyz, bits)] = (uint32_t)v;
            }
            free(table);
            table = larger;
            size *= 4;
        }
        read_bits(xyz + 3 * i, bits);
        const size_t slot = find_slot(table, size, xyz, bits);
        if (table[slot] == EMPTY) {
            table[slot] = (uint32_t)used;
            if (used != i) memcpy(xyz + 3 * used, xyz + 3 * i, 3 * sizeof *xyz);
            used++;
        }
        map[i] = table[slot];
    }
    free(table);
    *unique = used;
    return SWARF_OK;
}
