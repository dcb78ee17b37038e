/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Meshes that are streamed to a file: byte for byte the whole mesh where that fits, and in bands closed 2-manifolds of
 * the same shells and holes, within the error of the whole one, whose triangles do not cut each other. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cuts.h"
#include "stocks.h"

static char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    char *data = NULL;
    if (!CHECK(file != NULL)) return NULL;
    fseek(file, 0, SEEK_END);
    *length = (size_t)ftell(file);
    rewind(file);
    data = malloc(*length + 1);
    if (data && fread(data, 1, *length, file) != *length) *length = 0;
    fclose(file);
    return data;
}

/* 2 for every shell, less 2 for every hole through it: 3 F = 2 E. */
static long euler_number(const swarf_mesh *mesh)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    return (long)t.vertex_count - (long)t.triangle_count / 2;
}

/* Greatest distance of a vertex of `of` from the other mesh. */
static double farthest(const swarf_mesh *of, const swarf_mesh *from)
{
    const swarf_triangles t = swarf_mesh_triangles(of), other = swarf_mesh_triangles(from);
    double *points = malloc((3 * t.vertex_count + 1) * sizeof *points), most = 0;
    double *distance = malloc((t.vertex_count + 1) * sizeof *distance);
    swarf_solid *solid = NULL;
    if (!points || !distance || !CHECK_OK(swarf_solid_create(&other, NULL, &solid))) exit(test_end());
    for (size_t i = 0; i < 3 * t.vertex_count; i++) points[i] = (double)t.xyz[i];
    CHECK_OK(swarf_solid_distance(solid, points, t.vertex_count, NULL, distance, NULL));
    for (size_t i = 0; i < t.vertex_count; i++) most = fmax(most, fabs(distance[i]));
    swarf_solid_release(solid);
    free(points);
    free(distance);
    return most;
}

static void check_same_bytes(swarf_stock *stock, const swarf_contour_options *options, const char *whole_path,
                             const char *path)
{
    swarf_contour_report report;
    size_t length = 0, whole_length = 1;
    CHECK_OK(swarf_mesh_stream(stock, options, SIZE_MAX, path, NULL, &report));
    char *bytes = read_file(path, &length), *whole = read_file(whole_path, &whole_length);
    CHECK(bytes && whole && length == whole_length && memcmp(bytes, whole, length) == 0);
    CHECK(length == 84 + 50 * report.triangles);
    free(bytes);
    free(whole);
}

static void check_bands(swarf_stock *stock, const swarf_contour_options *options, const swarf_mesh *whole,
                        const swarf_contour_report *made, const char *path, int plain)
{
    swarf_contour_report report;
    swarf_mesh *mesh = NULL;
    if (!CHECK_OK(swarf_mesh_stream(stock, options, 1, path, NULL, &report)) || !CHECK_OK(swarf_mesh_read(path, &mesh)))
        return;
    const swarf_topology topology = swarf_mesh_topology(mesh), all = swarf_mesh_topology(whole);
    CHECK(topology.closed && !topology.nonmanifold_edges && !topology.boundary_edges && !topology.misoriented_edges);
    CHECK(!topology.degenerate);
    CHECK(swarf_mesh_triangles(mesh).triangle_count == report.triangles);
    const double shifted = options->keep_volume ? 0.01 * swarf_stock_voxel(stock) : 0;
    CHECK(report.error_mm <= fmax(options->error_mm, shifted) * (1 + 1e-6));
    CHECK(report.intersections_left == 0);
    if (report.triangles < 6000) CHECK(mesh_cuts(mesh) == 0);
    CHECK(euler_number(mesh) == euler_number(whole));
    /* where triangles cut each other vertices were put elsewhere in their cells, perhaps in one of the two only */
    const int as_found = !made->intersections_found && !report.intersections_found;
    const double bound = 2 * fmax(options->error_mm, shifted) + 1e-5,
                 most = as_found ? bound : 1.8 * swarf_stock_voxel(stock);
    CHECK_NEAR(topology.volume_mm3, all.volume_mm3, bound * all.area_mm2 + (as_found ? 0 : 1e-4 * all.volume_mm3));
    CHECK_NEAR(farthest(mesh, whole), 0, most);
    CHECK_NEAR(farthest(whole, mesh), 0, most);
    if (!as_found) {
        CHECK(!plain);
    } else {
        CHECK(report.full_triangles == made->full_triangles && report.parted_cells == made->parted_cells);
        CHECK(report.sharp_vertices == made->sharp_vertices && report.exact_vertices == made->exact_vertices);
    }
    swarf_mesh_release(mesh);
}

/* A bar with a slot, a groove and a ramp along it, through all bands: nothing there cuts itself. */
static swarf_stock *plain_stock(void)
{
    static const char *const cutters[] = {"flat:d=2,l=9", "ball:d=3,l=9", "flat:d=1,l=9"};
    static const double ends[][6] = {
        {-3, 1.5, -1.03, 33, 2.1, -1.03}, {-3, 4, -1.2, 33, 4.5, -1.2}, {2, -1, -3, 24, 8, -1}};
    const swarf_box box = {{0, 0, -5}, {30, 6, 0}};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.13;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&box, &options, &stock))) return NULL;
    for (int i = 0; i < 3; i++) {
        swarf_cutter *cutter = NULL;
        swarf_path path = {.has_motion = 1};
        memcpy(path.start, ends[i], sizeof path.start);
        memcpy(path.end, ends[i] + 3, sizeof path.end);
        CHECK_OK(swarf_cutter_parse(cutters[i], &cutter));
        CHECK_OK(swarf_stock_cut(stock, cutter, &path, 1, NULL));
        swarf_cutter_release(cutter);
    }
    return stock;
}

/* What thin cutters leave in all directions cuts itself in many places. Far from 0, where the positions of bands and of
 * the whole are rounded alike, each pair is counted once, at the planes between bands too. */
static void check_counts(test_random *random, const char *folder)
{
    char path[64];
    snprintf(path, sizeof path, "%s/counted.stl", folder);
    const swarf_box box = {{600, 0, -3}, {620, 3, 0}};
    swarf_stock_options stock_options = swarf_stock_options_default();
    stock_options.voxel_mm = 0.13;
    swarf_stock *stock = NULL;
    swarf_cutter *cutter = NULL;
    if (!CHECK_OK(swarf_stock_create_box(&box, &stock_options, &stock))) return;
    CHECK_OK(swarf_cutter_parse("ball:d=0.4,l=0.5", &cutter));
    for (int i = 0; i < 500; i++) {
        swarf_path path_of = {.has_motion = 1};
        for (int k = 0; k < 3; k++) {
            path_of.start[k] = test_random_in(random, box.lo[k], box.hi[k]);
            path_of.end[k] = path_of.start[k] + test_random_in(random, -3, 3);
        }
        CHECK_OK(swarf_stock_cut(stock, cutter, &path_of, 1, NULL));
    }
    const swarf_contour_options options = swarf_contour_options_default();
    swarf_contour_report whole, bands;
    swarf_mesh *mesh = NULL;
    if (CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, &whole)) &&
        CHECK_OK(swarf_mesh_stream(stock, &options, 1, path, NULL, &bands))) {
        CHECK(whole.intersections_found > 100);
        CHECK(bands.intersections_found == whole.intersections_found);
    }
    swarf_mesh_release(mesh);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
    unlink(path);
}

/* All ways to stream a stock against its whole mesh. */
static void check_stock(swarf_stock *stock, const swarf_surface *surface, const char *folder)
{
    char path[64], whole_path[64];
    const double voxel = swarf_stock_voxel(stock);
    snprintf(path, sizeof path, "%s/streamed.stl", folder);
    snprintf(whole_path, sizeof whole_path, "%s/whole.stl", folder);
    for (int kind = 0; kind < (surface ? 8 : 2); kind++) {
        swarf_contour_options options = swarf_contour_options_default();
        options.error_mm = kind & 1 ? 0.1 * voxel : 0;
        options.surface = kind > 1 ? surface : NULL;
        options.fine = kind == 4 || kind == 5;
        options.keep_volume = kind > 5;
        swarf_contour_report report;
        swarf_mesh *whole = NULL;
        if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &whole, &report))) break;
        CHECK_OK(swarf_mesh_write(whole, whole_path, NULL));
        check_same_bytes(stock, &options, whole_path, path);
        check_bands(stock, &options, whole, &report, path, !surface);
        swarf_mesh_release(whole);
    }
    unlink(path);
    unlink(whole_path);
}

static int stop(void *context, double fraction)
{
    (void)context;
    return fraction > 0.6;
}

/* What fails or is stopped leaves no file, and the stock as it was. */
static void check_refused(swarf_stock *stock, const char *folder)
{
    char path[64];
    swarf_contour_options options = swarf_contour_options_default();
    snprintf(path, sizeof path, "%s/part.stl", folder);
    const swarf_progress progress = {stop, NULL};
    CHECK_FAILS(swarf_mesh_stream(stock, &options, 1, path, &progress, NULL), SWARF_ERROR_CANCELLED, NULL);
    options.error_mm = 0.1;
    options.triangle_budget = 100;
    CHECK_FAILS(swarf_mesh_stream(stock, &options, 1, path, NULL, NULL), SWARF_ERROR_ARGUMENT, "budget");
    options.triangle_budget = 0;
    options.size--; /* nothing else of it is looked at then */
    options.triangle_budget = 100;
    CHECK_FAILS(swarf_mesh_stream(stock, &options, 1, path, NULL, NULL), SWARF_ERROR_ARGUMENT, "another version");
    options = swarf_contour_options_default();
    CHECK_FAILS(swarf_mesh_stream(stock, &options, 1, "part.ply", NULL, NULL), SWARF_ERROR_ARGUMENT, ".stl");
    CHECK_FAILS(swarf_mesh_stream(stock, &options, 1, "/nowhere/part.stl", NULL, NULL), SWARF_ERROR_IO, "/nowhere");
    CHECK_FAILS(swarf_mesh_stream(NULL, &options, 1, path, NULL, NULL), SWARF_ERROR_ARGUMENT, NULL);
    CHECK(access(path, F_OK) != 0);
    CHECK(rmdir(folder) == 0); /* nothing beside it either */
}

int main(void)
{
    test_random random = test_random_begin(31);
    char folder[] = "/tmp/swarf-stream-XXXXXX";
    if (!mkdtemp(folder)) return 1;
    swarf_stock *plain = plain_stock();
    check_counts(&random, folder);
    if (plain) check_stock(plain, NULL, folder);
    static const int counts[] = {1, 2, 40};
    for (int i = 0; i < counts[test_size()]; i++) {
        swarf_surface *surface = NULL;
        const double voxel = test_random_in(&random, 0.1, 0.2);
        swarf_stock *stock = stock_random(&random, voxel, test_random_in(&random, 12, 24), &surface);
        if (!stock) break;
        check_stock(stock, surface, folder);
        swarf_surface_release(surface);
        swarf_stock_destroy(stock);
    }
    if (plain) check_refused(plain, folder);
    swarf_stock_destroy(plain);
    return test_end();
}
