/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Scene: the blocks of a stock, and rays in world coordinates over them.
 *
 *   blocks   in the order of the leaves; ~150 bytes for each leaf that the surface passes (a leaf has 2048)
 *   accel    Embree's tree over them (embree_scene.cpp); NULL when there are none
 *   box      of all crossed cells, in voxels
 *
 * A ray is moved, in double, to where it enters the box, so that a far eye costs no precision. A ray that starts in
 * material meets no surface from outside and counts as a miss.
 */
#include "render/scene.h"

#include "base/parallel.h"
#include "base/status.h"
#include "render/embree_scene.h"
#include "stock/stock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct swarf_scene {
    swarf_stock *stock;
    swarf_tree_layout layout;
    swarf_block *blocks;
    size_t block_count;
    swarf_accel *accel;
    double box_lo[3], box_hi[3];
    double ray_ms; /* that a ray of the last picture took, with all that belongs to it; 0: no picture yet */
    float outside[SWARF_LEAF_SIZE], inside[SWARF_LEAF_SIZE]; /* what the blocks see of tiles */
};

/* Of a ray before the first picture has told: a small computer's. */
static const double first_ray_ms = 3e-4;

/* Leaves that one piece of work makes blocks of: some 0.2 ms. */
enum { CHUNK = 256 };

typedef struct chunk {
    swarf_block *blocks;
    size_t count;
} chunk;

typedef struct builder {
    const swarf_scene *scene;
    const swarf_tree *tree;
    const swarf_leaf *leaves;
    size_t leaf_count;
    chunk *chunks;
} builder;

/** Values of a slot by its coordinates, in slots from the layout's corner. */
static const float *slot_values(const builder *b, const int32_t at[3])
{
    const swarf_tree_layout *layout = &b->scene->layout;
    size_t node = 0;
    unsigned slot = 0;
    for (int axis = 0; axis < 3; axis++) {
        if (at[axis] < 0 || at[axis] >> 4 >= layout->count[axis]) return b->scene->outside;
        node = node * (size_t)layout->count[axis] + (size_t)(at[axis] >> 4);
        slot = slot << 4 | (unsigned)(at[axis] & 15);
    }
    const float *leaf = swarf_tree_leaf(b->tree, node, slot);
    if (leaf) return leaf;
    return layout->occupied[node * SWARF_NODE_WORDS + slot / 64] >> (slot % 64) & 1 ? b->scene->inside
                                                                                    : b->scene->outside;
}

static int is_tile(const builder *b, const float *values)
{
    return values == b->scene->inside || values == b->scene->outside;
}

/** The block at slot coordinates `at`; 0 when the surface does not pass it. */
static int make_block(const builder *b, const int32_t at[3], swarf_block *out)
{
    for (int number = 0; number < 8; number++) {
        const int32_t up[3] = {at[0] + (number >> 2), at[1] + (number >> 1 & 1), at[2] + (number & 1)};
        out->values[number] = slot_values(b, up);
    }
    for (int axis = 0; axis < 3; axis++) out->ijk[axis] = at[axis] * SWARF_LEAF_DIM;
    return swarf_block_make(out);
}

/** Whether a leaf's voxels that touch the slot below it (by the axes of `number`) differ in sign from that tile. */
static int differs(const float *leaf, const float *tile, int number)
{
    const int x_end = number & 4 ? 1 : 8, y_end = number & 2 ? 1 : 8, z_end = number & 1 ? 1 : 8;
    const int negative = tile[0] < 0;
    for (int x = 0; x < x_end; x++)
        for (int y = 0; y < y_end; y++)
            for (int z = 0; z < z_end; z++)
                if ((leaf[x << 6 | y << 3 | z] < 0) != negative) return 1;
    return 0;
}

/** Cells below a leaf belong to its lower neighbours. Where those are tiles, a narrow band of full width has no
 *  surface in them, but a file from elsewhere may: then the tile gets a block too. It is made by the first of its
 *  upper neighbours whose voxels call for it. */
static int make_tile_block(const builder *b, const int32_t leaf_at[3], const float *values, int number,
                           swarf_block *out)
{
    const int32_t at[3] = {leaf_at[0] - (number >> 2), leaf_at[1] - (number >> 1 & 1), leaf_at[2] - (number & 1)};
    const float *tile = slot_values(b, at);
    if (!is_tile(b, tile) || !differs(values, tile, number)) return 0;
    for (int other = 1; other < number; other++) {
        const int32_t up[3] = {at[0] + (other >> 2), at[1] + (other >> 1 & 1), at[2] + (other & 1)};
        const float *neighbour = slot_values(b, up);
        if (!is_tile(b, neighbour) && differs(neighbour, tile, other)) return 0;
    }
    return make_block(b, at, out);
}

static swarf_status build_chunk(void *context, size_t index)
{
    builder *b = context;
    const size_t first = index * CHUNK, last = first + CHUNK < b->leaf_count ? first + CHUNK : b->leaf_count;
    swarf_block found[8];
    size_t room = 0;
    chunk made = {NULL, 0};
    for (size_t leaf = first; leaf < last; leaf++) {
        int32_t at[3];
        for (int axis = 0; axis < 3; axis++) at[axis] = b->leaves[leaf].ijk[axis] / SWARF_LEAF_DIM;
        size_t count = (size_t)make_block(b, at, &found[0]);
        for (int number = 1; number < 8; number++)
            count += (size_t)make_tile_block(b, at, b->leaves[leaf].values, number, &found[count]);
        if (made.count + count > room) {
            room = room ? 2 * room : CHUNK;
            swarf_block *grown = realloc(made.blocks, room * sizeof *grown);
            if (!grown) {
                free(made.blocks);
                return swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory");
            }
            made.blocks = grown;
        }
        if (count) memcpy(made.blocks + made.count, found, count * sizeof *found);
        made.count += count;
    }
    b->chunks[index] = made;
    return SWARF_OK;
}

/** Put the chunks end to end, in their order. */
static swarf_status join(builder *b, size_t chunk_count, swarf_scene *scene)
{
    size_t total = 0;
    for (size_t index = 0; index < chunk_count; index++) total += b->chunks[index].count;
    if (total == 0) return SWARF_OK;
    scene->blocks = malloc(total * sizeof *scene->blocks);
    if (!scene->blocks) return swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory for %zu blocks", total);
    for (size_t index = 0; index < chunk_count; index++) {
        chunk *part = &b->chunks[index];
        if (part->count) memcpy(scene->blocks + scene->block_count, part->blocks, part->count * sizeof *part->blocks);
        scene->block_count += part->count;
        free(part->blocks);
        part->blocks = NULL;
    }
    return SWARF_OK;
}

static swarf_status build_blocks(swarf_scene *scene, const swarf_tree *tree, const swarf_leaf *leaves, size_t count)
{
    const size_t chunk_count = (count + CHUNK - 1) / CHUNK;
    if (chunk_count == 0) return SWARF_OK;
    builder b = {scene, tree, leaves, count, calloc(chunk_count, sizeof(chunk))};
    if (!b.chunks) return swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory");
    swarf_status status = swarf_parallel_for(chunk_count, build_chunk, &b, NULL, 0, 1);
    if (status == SWARF_OK) status = join(&b, chunk_count, scene);
    for (size_t index = 0; index < chunk_count; index++) free(b.chunks[index].blocks);
    free(b.chunks);
    return status;
}

static swarf_status build(swarf_scene *scene)
{
    swarf_leaf *leaves = NULL;
    size_t count = 0;
    swarf_accel_destroy(scene->accel);
    free(scene->blocks);
    scene->accel = NULL;
    scene->blocks = NULL;
    scene->block_count = 0;
    scene->layout = *swarf_tree_get_layout(scene->stock->tree);
    for (int place = 0; place < SWARF_LEAF_SIZE; place++) {
        scene->outside[place] = scene->layout.background;
        scene->inside[place] = -scene->layout.background;
    }
    SWARF_TRY(swarf_stock_leaves(scene->stock, &leaves, &count));
    const swarf_status status = build_blocks(scene, scene->stock->tree, leaves, count);
    free(leaves);
    if (status != SWARF_OK || scene->block_count == 0) return status;
    for (int axis = 0; axis < 3; axis++) {
        scene->box_lo[axis] = INFINITY;
        scene->box_hi[axis] = -INFINITY;
        for (size_t index = 0; index < scene->block_count; index++) {
            const swarf_block *block = &scene->blocks[index];
            scene->box_lo[axis] = fmin(scene->box_lo[axis], block->ijk[axis] + block->lo[axis]);
            scene->box_hi[axis] = fmax(scene->box_hi[axis], block->ijk[axis] + block->hi[axis]);
        }
    }
    return swarf_accel_create(scene->blocks, scene->block_count, &scene->accel);
}

swarf_status swarf_scene_create(swarf_stock *stock, swarf_scene **out)
{
    SWARF_REQUIRE(stock && out, "scene: stock or output missing");
    swarf_scene *scene = calloc(1, sizeof *scene);
    if (!scene) return swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory");
    scene->stock = stock;
    swarf_status status = swarf_stock_enter_read(stock);
    if (status == SWARF_OK) {
        status = build(scene);
        swarf_stock_leave(stock);
    }
    if (status != SWARF_OK) {
        swarf_scene_destroy(scene);
        return status;
    }
    *out = scene;
    return SWARF_OK;
}

swarf_status swarf_scene_update(swarf_scene *scene)
{
    SWARF_REQUIRE(scene, "scene: missing");
    SWARF_TRY(swarf_stock_enter_read(scene->stock));
    const swarf_status status = build(scene);
    swarf_stock_leave(scene->stock);
    return status;
}

void swarf_scene_destroy(swarf_scene *scene)
{
    if (!scene) return;
    swarf_accel_destroy(scene->accel);
    free(scene->blocks);
    free(scene);
}

swarf_status swarf_scene_enter(const swarf_scene *scene)
{
    return swarf_stock_enter_read(scene->stock);
}

void swarf_scene_leave(const swarf_scene *scene)
{
    swarf_stock_leave(scene->stock);
}

void swarf_scene_box(const swarf_scene *scene, swarf_box *out)
{
    for (int axis = 0; axis < 3; axis++) {
        out->lo[axis] = scene->block_count ? scene->layout.origin[axis] + scene->layout.voxel * scene->box_lo[axis] : 1;
        out->hi[axis] = scene->block_count ? scene->layout.origin[axis] + scene->layout.voxel * scene->box_hi[axis] : 0;
    }
}

double swarf_scene_ray_ms(const swarf_scene *scene)
{
    return scene->ray_ms > 0 ? scene->ray_ms : first_ray_ms;
}

void swarf_scene_note_ray_ms(swarf_scene *scene, double ray_ms)
{
    scene->ray_ms = ray_ms;
}

/** Whether a point (in voxels) lies in material. */
static int is_inside(const swarf_scene *scene, const double p[3])
{
    double local[3];
    int32_t low[3];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = (int32_t)floor(p[axis]);
        local[axis] = p[axis] - low[axis];
    }
    float corner[8];
    for (int number = 0; number < 8; number++) {
        const int32_t ijk[3] = {low[0] + (number >> 2), low[1] + (number >> 1 & 1), low[2] + (number & 1)};
        corner[number] = swarf_stock_value(scene->stock, ijk);
    }
    return swarf_cell_value(corner, local) < 0;
}

/** Make a ray in voxels whose origin is where it enters the scene's box, *moved on by that many voxels; 0 when it
 *  passes the box by or starts in material. */
static int prepare(const swarf_scene *scene, const double origin[3], const double direction[3], double length,
                   swarf_ray *ray, double *moved)
{
    double enter = 0, leave = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        ray->origin[axis] = (origin[axis] - scene->layout.origin[axis]) / scene->layout.voxel;
        ray->direction[axis] = direction[axis] / length;
        /* Across any box this strays less than rounding does; its inverse could be infinite. */
        if (fabs(ray->direction[axis]) < 1e-18) ray->direction[axis] = 0;
        ray->inverse[axis] = 1 / ray->direction[axis];
        if (ray->direction[axis] == 0) {
            if (ray->origin[axis] < scene->box_lo[axis] || ray->origin[axis] > scene->box_hi[axis]) return 0;
            continue;
        }
        const double t_lo = (scene->box_lo[axis] - ray->origin[axis]) * ray->inverse[axis];
        const double t_hi = (scene->box_hi[axis] - ray->origin[axis]) * ray->inverse[axis];
        enter = fmax(enter, fmin(t_lo, t_hi));
        leave = fmin(leave, fmax(t_lo, t_hi));
    }
    if (enter > leave) return 0;
    if (enter > 0) {
        for (int axis = 0; axis < 3; axis++) {
            /* Rounding must not push the origin out of the box by which blocks at its rim are found. */
            const double at = ray->origin[axis] + enter * ray->direction[axis];
            ray->origin[axis] = fmin(fmax(at, scene->box_lo[axis]), scene->box_hi[axis]);
        }
    } else if (is_inside(scene, ray->origin)) {
        return 0;
    }
    ray->t = INFINITY;
    ray->block = UINT32_MAX;
    *moved = enter;
    return 1;
}

swarf_status swarf_scene_trace(const swarf_scene *scene, const double *origin, const double *direction, unsigned count,
                               double *distance, float *normal)
{
    swarf_ray rays[SWARF_PACKET];
    double moved[SWARF_PACKET], length[SWARF_PACKET];
    unsigned number[SWARF_PACKET], active = 0;
    for (unsigned ray = 0; ray < count; ray++) {
        const double *d = direction + 3 * ray;
        distance[ray] = INFINITY;
        if (normal) memset(normal + 3 * ray, 0, 3 * sizeof *normal);
        if (!scene->accel) continue;
        length[active] = hypot(hypot(d[0], d[1]), d[2]);
        if (!prepare(scene, origin + 3 * ray, d, length[active], &rays[active], &moved[active])) continue;
        number[active++] = ray;
    }
    if (active == 0) return SWARF_OK;
    swarf_accel_trace(scene->accel, rays, active);
    for (unsigned ray = 0; ray < active; ray++) {
        if (isinf(rays[ray].t)) continue;
        distance[number[ray]] = (moved[ray] + rays[ray].t) * scene->layout.voxel / length[ray];
        if (normal) memcpy(normal + 3 * number[ray], rays[ray].normal, sizeof rays[ray].normal);
    }
    return SWARF_OK;
}

typedef struct cast {
    const swarf_scene *scene;
    const double *origin, *direction;
    size_t count;
    double *distance;
    float *normal;
} cast;

/* Packets that one piece of work traces: some 0.1 ms. */
enum { PACKETS = 32 };

static swarf_status cast_some(void *context, size_t index)
{
    const cast *c = context;
    const size_t last = (index + 1) * PACKETS * SWARF_PACKET;
    for (size_t ray = index * PACKETS * SWARF_PACKET; ray < last && ray < c->count; ray += SWARF_PACKET) {
        const size_t left = c->count - ray;
        SWARF_TRY(swarf_scene_trace(c->scene, c->origin + 3 * ray, c->direction + 3 * ray,
                                    left < SWARF_PACKET ? (unsigned)left : SWARF_PACKET, c->distance + ray,
                                    c->normal ? c->normal + 3 * ray : NULL));
    }
    return SWARF_OK;
}

swarf_status swarf_scene_cast(swarf_scene *scene, const double *origin, const double *direction, size_t count,
                              double *distance, float *normal)
{
    SWARF_REQUIRE(scene && (count == 0 || (origin && direction && distance)), "rays: scene, rays or output missing");
    for (size_t ray = 0; ray < count; ray++) {
        double longest = 0;
        for (size_t place = 3 * ray; place < 3 * ray + 3; place++) {
            SWARF_REQUIRE(isfinite(origin[place]) && isfinite(direction[place]),
                          "rays: a number of ray %zu is not finite", ray);
            longest = fmax(longest, fabs(direction[place]));
        }
        SWARF_REQUIRE(longest > 0, "rays: the direction of ray %zu is zero", ray);
    }
    cast c = {scene, origin, direction, count, distance, normal};
    SWARF_TRY(swarf_scene_enter(scene));
    const swarf_status status =
        swarf_parallel_for((count + PACKETS * SWARF_PACKET - 1) / (PACKETS * SWARF_PACKET), cast_some, &c, NULL, 0, 1);
    swarf_scene_leave(scene);
    return status;
}
