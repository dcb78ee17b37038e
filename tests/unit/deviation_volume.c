/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A deviation's volumes: those of the fields, and of closed forms. */
#include "milled.h"
#include "shapes.h"

static const double pi = 3.14159265358979323846;

static void add_box(shape *s, double x0, double y0, double z0, double x1, double y1, double z1)
{
    const double lo[3] = {x0, y0, z0}, hi[3] = {x1, y1, z1};
    shape_box(s, lo, hi);
}

/* A deviation's volumes, taken from points where stock and design run side by side, are those of the fields. */
static void check_volumes_of(milled *j, const shape *s, double excess, double gouge, const char *name)
{
    const swarf_triangles triangles = shape_view(s);
    swarf_solid *design = NULL;
    CHECK_OK(swarf_solid_create(&triangles, NULL, &design));
    swarf_comparison by_fields;
    CHECK_OK(swarf_compare_volume(j->stock, design, NULL, &by_fields));
    swarf_deviation *deviation = milled_deviation(j, design, 0.05);
    const swarf_comparison volumes = swarf_deviation_get_sums(deviation).volumes;
    const double voxel = swarf_stock_voxel(j->stock), bound = voxel * 0.01 * 6800 + 5 * voxel * voxel * 60;
    const int well = CHECK_NEAR(volumes.excess_mm3, by_fields.excess_mm3, bound) &
                     CHECK_NEAR(volumes.gouge_mm3, by_fields.gouge_mm3, bound) &
                     CHECK_NEAR(volumes.excess_mm3, excess, 4 * bound) &
                     CHECK_NEAR(volumes.gouge_mm3, gouge, 4 * bound);
    if (!well)
        printf("%s, voxel %g: %g and %g, by fields %g and %g, in truth %g and %g\n", name, voxel, volumes.excess_mm3,
               volumes.gouge_mm3, by_fields.excess_mm3, by_fields.gouge_mm3, excess, gouge);
    double shares = 0; /* the clusters have all but what is within tolerance */
    size_t count = 0;
    const swarf_cluster *c = swarf_deviation_clusters(deviation, &count);
    for (size_t i = 0; i < count; i++) shares += c[i].excess ? c[i].volume_mm3 : 0;
    if (!CHECK(shares > 0.5 * excess - 4 * bound)) printf("%s, voxel %g: clusters have %g\n", name, voxel, shares);
    swarf_deviation_destroy(deviation);
    swarf_solid_release(design);
}

static void check_volumes(void)
{
    static const double voxels[4] = {0.25, 0.4, 0.62, 1.5};
    for (int i = test_size() == TEST_FULL ? 0 : test_size() == TEST_USUAL ? 1 : 2; i < 4; i++) {
        const double voxel = voxels[i], wall = 0.9 * voxel;
        milled j = milled_begin("flat:d=4,l=20", voxel);
        shape s = {0}; /* two shells that overlap below the top of a stock that was not cut */
        add_box(&s, 0, 0, -10, 60, 40, -5);
        add_box(&s, 20, 10, -6, 40, 30, 0);
        check_volumes_of(&j, &s, 60 * 40 * 5 - 20 * 20 * 5, 0, "boss");
        shape_free(&s);
        add_box(&s, 0, 0, -10, 60, 40, 0); /* a cavity behind thin walls that was not cut, one behind thick ones */
        const size_t first = s.triangles;
        add_box(&s, wall, wall, -10 + wall, 20, 40 - wall, -wall);
        add_box(&s, 35, 15, -7, 50, 25, -3);
        shape_flip(&s, first);
        check_volumes_of(&j, &s, (20 - wall) * (40 - 2 * wall) * (10 - 2 * wall) + 15 * 10 * 4, 0, "cavity");
        shape_free(&s);
        /* a pocket and a slot that ought not to be there */
        milled_pocket(&j, 4);
        milled_line(&j, SWARF_MOVE_RAPID, 10, -10, 5, 50);
        milled_line(&j, SWARF_MOVE_RAPID, 10, -10, -6, 51);
        milled_line(&j, SWARF_MOVE_FEED, 10, 50, -6, 52);
        milled_cut(&j);
        add_box(&s, 0, 0, -10, 60, 40, 0);
        check_volumes_of(&j, &s, 0, 4 * (200 - (4 - pi) * 4) + 4 * 40 * 6, "gouges");
        shape_free(&s);
        add_box(&s, 0, 0, -10, 60, 40, -4); /* cut in part only */
        check_volumes_of(&j, &s, 4 * 2400 - 4 * (200 - (4 - pi) * 4) - 4 * 40 * 4, 4 * 40 * 2, "half done");
        shape_free(&s);
        milled_end(&j);
    }
}

int main(void)
{
    check_volumes();
    return test_end();
}
