/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Scene: the cubes of a stock, and rays in world coordinates over them.
 *
 *   grid     a pointer per cube of the layout, NULL where nothing stops a ray; ~130 bytes for each leaf near the
 *            surface (a leaf has 2048)
 *   box      of all cells that stop rays, in voxels
 *
 * An update looks only at cubes whose slots, or upper neighbours' slots, changed since the last one. A ray is moved, in
 * double, to where it enters the box, so that a far eye costs no precision. A ray that starts in material meets no
 * surface from outside and counts as a miss.
 */
#include "render/scene.h"

#include "base/parallel.h"
#include "base/status.h"
#include "render/cube.h"
#include "render/embree_fixtures.h"
#include "stock/stock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct swarf_scene {
    swarf_stock *stock;
    swarf_tree_layout layout;
    uint32_t seen; /* the stock's generation that the cubes show, 0: none */
    swarf_cube_grid grid;
    size_t cube_count;        /* that are there; 0 while the scene is not whole */
    swarf_fixtures *fixtures; /* NULL: none */
    swarf_surface *surface;   /* NULL: none */
    size_t surface_moves;
    double surface_part; /* of the next move */
    swarf_ray_space space;
    void *scratch;
    size_t scratch_size;
    swarf_recall recall;
    double ray_ms; /* that a ray of the last picture took, with all that belongs to it; 0: no picture yet */
    swarf_cube_tiles tiles;
};

/* Of a ray before the first picture has told: a small computer's. */
static const double first_ray_ms = 3e-4;

static size_t grid_size(const swarf_cube_grid *grid)
{
    return (size_t)grid->count[0] * (size_t)grid->count[1] * (size_t)grid->count[2];
}

static void free_grid(swarf_scene *scene)
{
    for (size_t number = 0; scene->grid.cube && number < grid_size(&scene->grid); number++) {
        if (!scene->grid.cube[number]) continue;
        swarf_cube_free(scene->grid.cube[number]);
        free(scene->grid.cube[number]);
    }
    free(scene->grid.cube);
    memset(&scene->grid, 0, sizeof scene->grid);
}

/** Make the grid fit the layout; what is there stays if it does. */
static swarf_status lay_out(swarf_scene *scene)
{
    scene->layout = *swarf_tree_get_layout(scene->stock->tree);
    scene->space.voxel = scene->layout.voxel;
    memcpy(scene->space.origin, scene->layout.origin, sizeof scene->space.origin);
    swarf_cube_grid grid = {.cube = NULL};
    for (int axis = 0; axis < 3; axis++)
        grid.count[axis] = scene->layout.count[axis] * (SWARF_NODE_DIM / SWARF_CUBE_CELLS) + SWARF_CUBES_BELOW + 1;
    if (scene->grid.cube && memcmp(grid.count, scene->grid.count, sizeof grid.count) == 0) return SWARF_OK;
    scene->seen = 0;
    grid.cube = calloc(grid_size(&grid), sizeof *grid.cube);
    if (!grid.cube) return swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory for %zu cubes", grid_size(&grid));
    free_grid(scene);
    scene->grid = grid;
    for (int place = 0; place < SWARF_LEAF_SIZE; place++) {
        scene->tiles.outside[place] = scene->layout.background;
        scene->tiles.inside[place] = -scene->layout.background;
    }
    return SWARF_OK;
}

static swarf_status refresh_cube(swarf_scene *scene, size_t number, const int32_t at[3])
{
    swarf_cube *cube = scene->grid.cube[number], made = {0};
    if (cube) made = *cube;
    for (int axis = 0; axis < 3; axis++) made.corner[axis] = SWARF_CUBE_CELLS * (at[axis] - SWARF_CUBES_BELOW);
    swarf_status status = swarf_cube_make(&made, scene->stock->tree, &scene->tiles);
    if (made.slot_count == 0) {
        swarf_cube_free(&made);
        free(cube);
        cube = NULL;
    } else {
        if (!cube) cube = malloc(sizeof *cube);
        if (cube)
            *cube = made;
        else
            status = swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory");
        if (!cube) swarf_cube_free(&made);
    }
    scene->grid.cube[number] = cube;
    return status;
}

/** Whether a slot that the cells of this cube see has changed since the scene last looked. */
static int is_stale(const swarf_scene *scene, const int32_t at[3])
{
    enum { ACROSS = SWARF_NODE_DIM / SWARF_CUBE_CELLS };
    for (int number = 0; number < 8; number++) {
        int32_t up[3] = {at[0] + (number >> 2), at[1] + (number >> 1 & 1), at[2] + (number & 1)};
        size_t node = 0;
        unsigned cube = 0;
        int out = 0;
        for (int axis = 0; axis < 3; axis++) {
            up[axis] -= SWARF_CUBES_BELOW;
            out |= up[axis] < 0 || up[axis] >= ACROSS * scene->layout.count[axis];
            node = node * (size_t)scene->layout.count[axis] + (size_t)(up[axis] / ACROSS);
            cube = cube * ACROSS + (unsigned)(up[axis] % ACROSS);
        }
        if (!out && swarf_stock_stamp(scene->stock, node, cube) > scene->seen) return 1;
    }
    return 0;
}

static swarf_status refresh_row(void *context, size_t row)
{
    swarf_scene *scene = context;
    const swarf_cube_grid *grid = &scene->grid;
    int32_t at[3] = {(int32_t)row / grid->count[1], (int32_t)row % grid->count[1], 1};
    if (at[0] == 0 || at[0] == grid->count[0] - 1 || at[1] == 0 || at[1] == grid->count[1] - 1) return SWARF_OK;
    for (; at[2] < grid->count[2] - 1; at[2]++)
        if (is_stale(scene, at)) SWARF_TRY(refresh_cube(scene, row * (size_t)grid->count[2] + (size_t)at[2], at));
    return SWARF_OK;
}

/** Count the cubes that are there, and measure their box. */
static void measure(swarf_scene *scene)
{
    const size_t size = grid_size(&scene->grid);
    for (int axis = 0; axis < 3; axis++) {
        scene->space.lo[axis] = INFINITY;
        scene->space.hi[axis] = -INFINITY;
    }
    scene->cube_count = 0;
    for (size_t number = 0; number < size; number++) {
        const swarf_cube *cube = scene->grid.cube[number];
        if (!cube) continue;
        scene->cube_count++;
        for (int axis = 0; axis < 3; axis++) {
            scene->space.lo[axis] = fmin(scene->space.lo[axis], cube->corner[axis] + cube->lo[axis]);
            scene->space.hi[axis] = fmax(scene->space.hi[axis], cube->corner[axis] + cube->hi[axis]);
        }
    }
}

/** With the stock entered. */
static swarf_status refresh(swarf_scene *scene)
{
    const uint32_t generation = swarf_stock_generation(scene->stock);
    if (scene->seen == generation) return SWARF_OK;
    swarf_recall_forget(&scene->recall);
    scene->cube_count = 0; /* until all is in place: a failure leaves a scene of nothing, and all of it stale */
    SWARF_TRY(lay_out(scene));
    const swarf_status status =
        swarf_parallel_for((size_t)scene->grid.count[0] * (size_t)scene->grid.count[1], refresh_row, scene, NULL, 0, 1);
    scene->seen = 0;
    SWARF_TRY(status);
    measure(scene);
    scene->seen = generation;
    return SWARF_OK;
}

swarf_status swarf_scene_create(swarf_stock *stock, swarf_scene **out)
{
    SWARF_REQUIRE(stock && out, "scene: stock or output missing");
    swarf_scene *scene = calloc(1, sizeof *scene);
    if (!scene) return swarf_fail(SWARF_ERROR_MEMORY, "scene: out of memory");
    scene->stock = stock;
    const swarf_status status = swarf_scene_update(scene);
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
    SWARF_TRY(swarf_scene_enter(scene));
    swarf_scene_leave(scene);
    return SWARF_OK;
}

void swarf_scene_destroy(swarf_scene *scene)
{
    if (!scene) return;
    swarf_fixtures_destroy(scene->fixtures);
    swarf_surface_release(scene->surface);
    free_grid(scene);
    swarf_recall_forget(&scene->recall);
    free(scene->scratch);
    free(scene);
}

swarf_status swarf_scene_enter(swarf_scene *scene)
{
    SWARF_TRY(swarf_stock_enter_read(scene->stock));
    const swarf_status status = refresh(scene);
    if (status != SWARF_OK) swarf_stock_leave(scene->stock);
    return status;
}

void swarf_scene_leave(swarf_scene *scene)
{
    swarf_stock_leave(scene->stock);
}

void *swarf_scene_scratch(swarf_scene *scene, size_t bytes)
{
    if (bytes > scene->scratch_size || bytes < scene->scratch_size / 4) {
        swarf_recall_forget(&scene->recall);
        free(scene->scratch);
        scene->scratch = malloc(bytes);
        scene->scratch_size = scene->scratch ? bytes : 0;
    }
    return scene->scratch;
}

swarf_recall *swarf_scene_recall(swarf_scene *scene)
{
    return &scene->recall;
}

void swarf_scene_box(const swarf_scene *scene, swarf_box *out)
{
    for (int axis = 0; axis < 3; axis++) {
        out->lo[axis] =
            scene->cube_count ? scene->layout.origin[axis] + scene->layout.voxel * scene->space.lo[axis] : 1;
        out->hi[axis] =
            scene->cube_count ? scene->layout.origin[axis] + scene->layout.voxel * scene->space.hi[axis] : 0;
    }
}

swarf_status swarf_scene_set_fixtures(swarf_scene *scene, const swarf_triangles *triangles, size_t count)
{
    SWARF_REQUIRE(scene && (triangles || count == 0), "fixtures: scene or triangles missing");
    swarf_fixtures *fixtures = NULL;
    size_t filled = 0;
    for (size_t i = 0; i < count; i++) filled += triangles[i].triangle_count > 0;
    if (filled) SWARF_TRY(swarf_fixtures_create(triangles, count, &fixtures));
    const swarf_status status = swarf_stock_enter_write(scene->stock); /* no picture is being made of what goes */
    if (status != SWARF_OK) {
        swarf_fixtures_destroy(fixtures);
        return status;
    }
    swarf_recall_forget(&scene->recall);
    swarf_fixtures_destroy(scene->fixtures);
    scene->fixtures = fixtures;
    swarf_stock_leave(scene->stock);
    return SWARF_OK;
}

swarf_status swarf_scene_set_surface(swarf_scene *scene, swarf_surface *surface, size_t moves, double part)
{
    SWARF_REQUIRE(scene, "scene: missing");
    SWARF_REQUIRE(part >= 0 && part <= 1, "scene: part %g of a move; 0 to 1 are possible", part);
    SWARF_TRY(swarf_stock_enter_write(scene->stock));
    if (surface != scene->surface || moves != scene->surface_moves || part != scene->surface_part)
        swarf_recall_forget(&scene->recall);
    if (surface) (void)swarf_surface_retain(surface);
    swarf_surface_release(scene->surface);
    scene->surface = surface;
    scene->surface_moves = moves;
    scene->surface_part = part;
    swarf_stock_leave(scene->stock);
    return SWARF_OK;
}

const swarf_surface *swarf_scene_surface(const swarf_scene *scene)
{
    return scene->surface;
}

size_t swarf_scene_moves(const swarf_scene *scene, double *part)
{
    *part = scene->surface_part;
    return scene->surface_moves;
}

const swarf_fixtures *swarf_scene_fixtures(const swarf_scene *scene)
{
    return scene->fixtures;
}

double swarf_scene_voxel(const swarf_scene *scene)
{
    return scene->layout.voxel;
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
    double local[3], value[8];
    int32_t low[3];
    size_t number = 0;
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = (int32_t)floor(p[axis]);
        local[axis] = p[axis] - low[axis];
        const int32_t at = low[axis] + SWARF_CUBES_BELOW * SWARF_CUBE_CELLS;
        if (at < 0 || at / SWARF_CUBE_CELLS >= scene->grid.count[axis]) return 0;
        number = number * (size_t)scene->grid.count[axis] + (size_t)(at / SWARF_CUBE_CELLS);
    }
    const swarf_cube *cube = scene->grid.cube[number];
    const int x = low[0] & 31, y = low[1] & 31, z = low[2] & 31;
    if (!cube || !(cube->block[x >> 2] >> ((y >> 2) * 8 + (z >> 2)) & 1))
        return swarf_stock_value(scene->stock, low) < 0; /* all air, or all so deep that no ray gets there */
    const swarf_cube_slot *slot = &cube->slots[cube->place[(x >> 3) * 16 + (y >> 3) * 4 + (z >> 3)]];
    const uint64_t stop = slot->stop[(x >> 2 & 1) * 4 + (y >> 2 & 1) * 2 + (z >> 2 & 1)];
    if (!(stop >> ((x & 3) * 16 + (y & 3) * 4 + (z & 3)) & 1)) return 0;
    for (int corner = 0; corner < 8; corner++) {
        const int up[3] = {(x & 7) + (corner >> 2), (y & 7) + (corner >> 1 & 1), (z & 7) + (corner & 1)};
        value[corner] = slot->values[(up[0] >> 3) << 2 | (up[1] >> 3) << 1 | up[2] >> 3]
                                    [(up[0] & 7) << 6 | (up[1] & 7) << 3 | (up[2] & 7)];
    }
    for (int axis = 0, half = 4; axis < 3; axis++, half /= 2)
        for (int corner = 0; corner < half; corner++)
            value[corner] += local[axis] * (value[corner + half] - value[corner]);
    return value[0] < 0;
}

/** Put a packet on its way; returns the rays that may meet something. */
static unsigned enter(const swarf_scene *scene, swarf_rays *rays, swarf_packet *packet, double moved[SWARF_PACKET],
                      unsigned *inside)
{
    unsigned active = swarf_ray_kernel_current()->enter(&scene->space, rays, packet, moved);
    *inside = 0;
    for (unsigned left = active; left; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        if (moved[lane] > 0) continue;
        const double at[3] = {packet->origin[0][lane], packet->origin[1][lane], packet->origin[2][lane]};
        if (is_inside(scene, at)) *inside |= 1u << lane;
    }
    return active & ~*inside;
}

void swarf_scene_trace(const swarf_scene *scene, swarf_rays rays[], unsigned inside[], int count)
{
    swarf_packet packet[SWARF_GROUP];
    double moved[SWARF_GROUP][SWARF_PACKET];
    unsigned active[SWARF_GROUP];
    for (int i = 0; i < count; i++) {
        for (int lane = 0; lane < SWARF_PACKET; lane++) rays[i].distance[lane] = INFINITY;
        rays[i].hit = inside[i] = 0;
        if (scene->cube_count) active[i] = enter(scene, &rays[i], &packet[i], moved[i], &inside[i]);
    }
    if (!scene->cube_count) return;
    swarf_ray_kernel_current()->trace(&scene->grid, packet, active, count);
    for (int i = 0; i < count; i++) {
        rays[i].hit = active[i];
        for (int lane = 0; lane < SWARF_PACKET; lane++)
            if (active[i] >> lane & 1)
                rays[i].distance[lane] = (moved[i][lane] + packet[i].t[lane]) * scene->layout.voxel;
        memcpy(rays[i].normal, packet[i].normal, sizeof rays[i].normal);
    }
}
