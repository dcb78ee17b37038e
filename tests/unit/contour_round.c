/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Meshes of the field alone where faces bend: what balls of a few voxels leave in a block, plunged, along level lines
 * and down ramps, wherever the voxels lie, against the oracle's distance. */
#include <math.h>
#include <stdlib.h>

#include "oracle.h"
#include "stocks.h"

static const double voxel = 0.2, pi = 3.14159265358979323846;

enum { PLUNGE, LEVEL, RAMP, KINDS };

/* Radii of balls, how many of each kind are tried, and greatest distances that may be, all in voxels: of one trace's
 * vertices in the mean, of 99 of 100 of a range's, and of any. Seen of 1000 traces of each kind (of the largest 300):
 * 0.098, 0.22, 0.44 of the smallest balls; 0.052, 0.13, 0.30; 0.0075, 0.016, 0.12; 0.0035, 0.010, 0.034; 0.0020, 0.005,
 * 0.017 of the largest. Of few traces 99 of 100 may be farther off. */
static const struct range {
    double from, to;
    int traces;
    double mean, most, worst;
} ranges[] = {
    {2, 3, 12, 0.11, 0.28, 0.5},     {3, 4, 12, 0.06, 0.19, 0.35},      {4, 6, 12, 0.009, 0.021, 0.14},
    {6, 10, 6, 0.004, 0.013, 0.045}, {10, 16, 2, 0.0025, 0.008, 0.022},
};

typedef struct trace {
    swarf_box block;
    swarf_path path;
} trace;

/* In a block whose other faces are far from the round one; that opens to the top by an upright wall. */
static trace random_trace(test_random *random, int kind, double radius)
{
    const double half = kind == PLUNGE ? 0 : 6 * voxel, heading = test_random_in(random, -pi, pi);
    const double rise = kind == RAMP ? half * tan(test_random_in(random, 5, 45) * pi / 180) : 0;
    const double along[3] = {half * cos(heading), half * sin(heading), rise}, away = half + radius + 5 * voxel;
    const double middle = -radius - rise - 4 * voxel;
    trace out = {.block = {{-away, -away, middle - rise - 4 * voxel}, {away, away, 0}}, .path = {.has_motion = 1}};
    for (int k = 0; k < 3; k++) {
        const double at = (k == 2 ? middle : 0) + test_random_in(random, -0.5, 0.5) * voxel;
        out.path.start[k] = kind == PLUNGE && k == 2 ? 1 : at - along[k];
        out.path.end[k] = at + along[k];
        out.block.lo[k] -= test_random_in(random, 0, voxel);
    }
    return out;
}

/* Distances of the vertices from what the ball left, in voxels. */
typedef struct figures {
    double sum, worst;
    size_t count, above; /* above: the range's limit for 99 of 100 */
} figures;

static figures measure(const swarf_mesh *mesh, const trace *at, const oracle_body *ball, double most)
{
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    figures out = {0};
    for (size_t i = 0; i < t.vertex_count; i++) {
        double p[3], other = INFINITY;
        for (size_t k = 0; k < 3; k++) {
            p[k] = (double)t.xyz[3 * i + k];
            other = fmin(other, fmin(p[k] - at->block.lo[k], at->block.hi[k] - p[k]));
        }
        if (other < 3 * voxel) continue;
        const double off = fabs(oracle_distance(ball, &at->path, p)) / voxel;
        out.sum += off;
        out.worst = fmax(out.worst, off);
        out.count++;
        out.above += off > most;
    }
    return out;
}

static figures try_one(test_random *random, int kind, double radius, double most)
{
    const trace at = random_trace(random, kind, radius);
    const swarf_contour_options options = swarf_contour_options_default();
    swarf_stock *stock = stock_block(&at.block, voxel);
    swarf_cutter *cutter = NULL;
    swarf_mesh *mesh = NULL;
    char text[48];
    snprintf(text, sizeof text, "ball:d=%.9g,l=30", 2 * radius);
    if (!CHECK_OK(swarf_cutter_parse(text, &cutter))) exit(test_end());
    CHECK_OK(swarf_stock_cut(stock, cutter, &at.path, 1, NULL));
    if (!CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &mesh, NULL))) exit(test_end());
    const oracle_body ball = oracle_body_of(cutter, SWARF_PART_FLUTES);
    const figures out = measure(mesh, &at, &ball, most);
    swarf_mesh_release(mesh);
    swarf_cutter_release(cutter);
    swarf_stock_destroy(stock);
    return out;
}

static void check_range(test_random *random, int kind, const struct range *range)
{
    static const char *const names[KINDS] = {"plunged", "level", "ramp"};
    const int size = test_size(), traces = size == TEST_FULL    ? 20 * range->traces
                                           : size == TEST_LIGHT ? 1
                                                                : range->traces;
    figures all = {0};
    double mean = 0;
    for (int i = 0; i < traces; i++) {
        const double radius = test_random_in(random, range->from, range->to) * voxel;
        const figures one = try_one(random, kind, radius, range->most);
        const double one_mean = one.sum / (double)one.count;
        if (!CHECK(one.count > 20 && one_mean < range->mean && one.worst < range->worst))
            printf("%s, ball of %.4f voxels: %zu vertices off %.5f, worst %.4f voxels\n", names[kind], radius / voxel,
                   one.count, one_mean, one.worst);
        mean = fmax(mean, one_mean);
        all.sum += one.sum;
        all.worst = fmax(all.worst, one.worst);
        all.count += one.count;
        all.above += one.above;
    }
    printf("%-7s balls of %2g to %2g voxels: %7zu vertices off %.5f, of one trace %.5f, worst %.4f voxels, %.2f %% "
           "above %g\n",
           names[kind], range->from, range->to, all.count, all.sum / (double)all.count, mean, all.worst,
           100.0 * (double)all.above / (double)all.count, range->most);
    CHECK(size == TEST_LIGHT || all.above * 100 <= all.count);
}

int main(void)
{
    test_random random = test_random_begin(22);
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        for (int kind = 0; kind < KINDS; kind++) check_range(&random, kind, &ranges[i]);
    return test_end();
}
