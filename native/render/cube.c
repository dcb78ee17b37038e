/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "render/cube.h"

#include "base/status.h"

#include <stdlib.h>
#include <string.h>

/* A cube's slots and their upper neighbours. */
enum { AROUND = SWARF_CUBE_SLOTS + 1 };

typedef struct around {
    const float *values[AROUND][AROUND][AROUND];
    uint64_t sign[AROUND][AROUND][AROUND][8]; /* bit y * 8 + z of word x: below 0 */
} around;

/** Values of a slot by its coordinates, in slots from the layout's corner. */
static const float *slot_values(const swarf_tree *tree, const swarf_cube_tiles *tiles, const int32_t at[3])
{
    const swarf_tree_layout *layout = swarf_tree_get_layout(tree);
    size_t node = 0;
    unsigned slot = 0;
    for (int axis = 0; axis < 3; axis++) {
        if (at[axis] < 0 || at[axis] >> 4 >= layout->count[axis]) return tiles->outside;
        node = node * (size_t)layout->count[axis] + (size_t)(at[axis] >> 4);
        slot = slot << 4 | (unsigned)(at[axis] & 15);
    }
    if (!(layout->occupied[node * SWARF_NODE_WORDS + slot / 64] >> (slot % 64) & 1)) return tiles->outside;
    const float *leaf = swarf_tree_leaf(tree, node, slot);
    return leaf ? leaf : tiles->inside;
}

/** 0 when there are tiles only. */
static int look_around(const swarf_cube *cube, const swarf_tree *tree, const swarf_cube_tiles *tiles, around *out)
{
    int leaves = 0;
    for (int x = 0; x < AROUND; x++)
        for (int y = 0; y < AROUND; y++)
            for (int z = 0; z < AROUND; z++) {
                const int32_t at[3] = {cube->corner[0] / SWARF_LEAF_DIM + x, cube->corner[1] / SWARF_LEAF_DIM + y,
                                       cube->corner[2] / SWARF_LEAF_DIM + z};
                const float *values = slot_values(tree, tiles, at);
                out->values[x][y][z] = values;
                leaves += values != tiles->outside && values != tiles->inside;
            }
    return leaves != 0;
}

static void find_signs(const swarf_cube_tiles *tiles, around *out)
{
    const swarf_ray_kernel *kernel = swarf_ray_kernel_current();
    for (int x = 0; x < AROUND; x++)
        for (int y = 0; y < AROUND; y++)
            for (int z = 0; z < AROUND; z++) {
                const float *values = out->values[x][y][z];
                uint64_t *sign = out->sign[x][y][z];
                if (values == tiles->outside)
                    memset(sign, 0, sizeof out->sign[x][y][z]);
                else if (values == tiles->inside)
                    memset(sign, 255, sizeof out->sign[x][y][z]);
                else
                    kernel->signs(values, sign);
            }
}

/** Bits (y, z): whether any of the values (y .. y + 1, z .. z + 1) of one x is below 0. The words are those of the slot
 *  and of its neighbours up in z, in y and in both. */
static uint64_t square_any(uint64_t own, uint64_t up_z, uint64_t up_y, uint64_t up_yz)
{
    const uint64_t row_end = 0x8080808080808080u; /* z = 7 of each y */
    const uint64_t here = own | (own >> 1 & ~row_end) | (up_z << 7 & row_end);
    const uint64_t above = up_y | (up_y >> 1 & ~row_end) | (up_yz << 7 & row_end);
    return here | here >> 8 | above << 56;
}

/** The cells of slot (x, y, z) that stop rays; 0 when there are none. */
static int find_stops(const around *a, int x, int y, int z, uint64_t stop[8])
{
    uint64_t any[9], all_of = 0;
    for (int layer = 0; layer < 9; layer++) {
        const int up = layer >> 3, word = layer & 7;
        any[layer] = square_any(a->sign[x + up][y][z][word], a->sign[x + up][y][z + 1][word],
                                a->sign[x + up][y + 1][z][word], a->sign[x + up][y + 1][z + 1][word]);
    }
    for (int layer = 0; layer < 8; layer++) all_of |= stop[layer] = any[layer] | any[layer + 1];
    return all_of != 0;
}

/** Whether a slot and its upper neighbours are inside tiles: too deep for any ray to get there. */
static int is_deep(const around *a, const swarf_cube_tiles *tiles, int x, int y, int z)
{
    for (int number = 0; number < 8; number++)
        if (a->values[x + (number >> 2)][y + (number >> 1 & 1)][z + (number & 1)] != tiles->inside) return 0;
    return 1;
}

/** The cells of a slot by blocks. */
static void sort_stops(const uint64_t stop[8], uint64_t by_block[8])
{
    memset(by_block, 0, 8 * sizeof *by_block);
    for (int x = 0; x < 8; x++)
        for (int quarter = 0; quarter < 4; quarter++) { /* y half, z half */
            uint64_t bits = stop[x] >> (32 * (quarter >> 1) + 4 * (quarter & 1)) & 0x0f0f0f0f;
            bits = (bits | bits >> 4) & 0x00ff00ff;
            bits = (bits | bits >> 8) & 0xffff;
            by_block[(x >> 2) * 4 + quarter] |= bits << (16 * (x & 3));
        }
}

/** The bounds of the cells that stop in the slot. */
static void measure(const uint64_t stop[8], int lo[3], int hi[3])
{
    uint64_t any = 0;
    lo[0] = 8;
    hi[0] = 0;
    for (int x = 0; x < 8; x++) {
        if (!stop[x]) continue;
        if (lo[0] > x) lo[0] = x;
        hi[0] = x + 1;
        any |= stop[x];
    }
    uint64_t columns = any | any >> 32;
    columns |= columns >> 16;
    columns = (columns | columns >> 8) & 255;
    lo[1] = __builtin_ctzll(any) >> 3;
    hi[1] = (63 - __builtin_clzll(any)) / 8 + 1;
    lo[2] = __builtin_ctzll(columns);
    hi[2] = 64 - __builtin_clzll(columns);
}

/** Room for one more slot. */
static swarf_status grow(swarf_cube *cube)
{
    if (cube->slot_count < cube->slot_room) return SWARF_OK;
    const uint32_t room = cube->slot_room ? 2 * cube->slot_room : 8;
    swarf_cube_slot *slots = aligned_alloc(64, room * sizeof *slots); /* the words of a slot are a line of a cache */
    if (!slots) return swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory");
    if (cube->slot_count) memcpy(slots, cube->slots, cube->slot_count * sizeof *slots);
    free(cube->slots);
    cube->slots = slots;
    cube->slot_room = room;
    return SWARF_OK;
}

static void clear(swarf_cube *cube)
{
    cube->slot_count = 0;
    for (int axis = 0; axis < 3; axis++) {
        cube->lo[axis] = SWARF_CUBE_CELLS;
        cube->hi[axis] = 0;
    }
    memset(cube->block, 0, sizeof cube->block);
}

static swarf_status add_slot(swarf_cube *cube, const around *a, int x, int y, int z, const uint64_t stop[8])
{
    SWARF_TRY(grow(cube));
    swarf_cube_slot *slot = &cube->slots[cube->slot_count];
    sort_stops(stop, slot->stop);
    for (int number = 0; number < 8; number++)
        slot->values[number] = a->values[x + (number >> 2)][y + (number >> 1 & 1)][z + (number & 1)];
    const int at[3] = {8 * x, 8 * y, 8 * z};
    int lo[3], hi[3];
    measure(stop, lo, hi);
    cube->place[(x * 4 + y) * 4 + z] = (uint8_t)cube->slot_count++;
    for (int block = 0; block < 8; block++)
        if (slot->stop[block])
            cube->block[2 * x + (block >> 2)] |= (uint64_t)1 << ((2 * y + (block >> 1 & 1)) * 8 + 2 * z + (block & 1));
    for (int axis = 0; axis < 3; axis++) {
        if (cube->lo[axis] > at[axis] + lo[axis]) cube->lo[axis] = (uint8_t)(at[axis] + lo[axis]);
        if (cube->hi[axis] < at[axis] + hi[axis]) cube->hi[axis] = (uint8_t)(at[axis] + hi[axis]);
    }
    return SWARF_OK;
}

void swarf_cube_free(swarf_cube *cube)
{
    clear(cube);
    free(cube->slots);
    cube->slots = NULL;
    cube->slot_room = 0;
}

swarf_status swarf_cube_make(swarf_cube *cube, const swarf_tree *tree, const swarf_cube_tiles *tiles)
{
    around a;
    clear(cube);
    if (!look_around(cube, tree, tiles, &a)) {
        swarf_cube_free(cube);
        return SWARF_OK;
    }
    find_signs(tiles, &a);
    for (int x = 0; x < SWARF_CUBE_SLOTS; x++)
        for (int y = 0; y < SWARF_CUBE_SLOTS; y++)
            for (int z = 0; z < SWARF_CUBE_SLOTS; z++) {
                uint64_t stop[8];
                if (is_deep(&a, tiles, x, y, z) || !find_stops(&a, x, y, z, stop)) continue;
                const swarf_status status = add_slot(cube, &a, x, y, z, stop);
                if (status != SWARF_OK) {
                    clear(cube);
                    return status;
                }
            }
    if (cube->slot_count == 0) swarf_cube_free(cube);
    return SWARF_OK;
}
