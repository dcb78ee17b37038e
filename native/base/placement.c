/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "base/placement.h"

#include "base/status.h"
#include "base/vector.h"

#include <math.h>
#include <string.h>

/* What a rotation may lack of orthonormal, and what a coordinate of an axis may lack of 0 or 1 to be one: a micrometre
 * at 1 m from the origin. */
static const double mended = 1e-6, on_axis = 1e-9;

static const double farthest = 1e6;

swarf_placement swarf_placement_identity(void)
{
    return (swarf_placement){.rotation = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

static void scale(double a[3], double factor)
{
    for (int k = 0; k < 3; k++) a[k] *= factor;
}

/* The first row as it is, the second across it, the third across both: exact where the axes are axes already. */
static void mend(double rows[3][3])
{
    scale(rows[0], 1 / sqrt(vector_dot(rows[0], rows[0])));
    const double along = vector_dot(rows[0], rows[1]);
    for (int k = 0; k < 3; k++) rows[1][k] -= along * rows[0][k];
    scale(rows[1], 1 / sqrt(vector_dot(rows[1], rows[1])));
    vector_cross(rows[0], rows[1], rows[2]);
}

swarf_status swarf_placement_check(const swarf_placement *placement)
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 4; k++)
            SWARF_REQUIRE(isfinite(k < 3 ? placement->rotation[i][k] : placement->shift[i]),
                          "placement: row %d, column %d is not finite", i, k);
        for (int k = 0; k <= i; k++) {
            const double wanted = i == k, found = vector_dot(placement->rotation[k], placement->rotation[i]);
            SWARF_REQUIRE(fabs(found - wanted) <= mended,
                          "placement: rows %d and %d of the rotation have the product %g where a rotation has %g: it "
                          "skews or scales",
                          k, i, found, wanted);
        }
    }
    double third[3];
    vector_cross(placement->rotation[0], placement->rotation[1], third);
    SWARF_REQUIRE(vector_dot(third, placement->rotation[2]) > 0,
                  "placement: it mirrors; a part can only be turned and moved");
    return SWARF_OK;
}

swarf_status swarf_placement_create(const double rows[12], swarf_placement *out)
{
    SWARF_REQUIRE(rows && out, "placement: NULL");
    swarf_placement made = {0};
    for (int i = 0; i < 3; i++) {
        memcpy(made.rotation[i], rows + 4 * i, sizeof made.rotation[i]);
        made.shift[i] = rows[4 * i + 3];
    }
    SWARF_TRY(swarf_placement_check(&made));
    for (int i = 0; i < 3; i++)
        SWARF_REQUIRE(fabs(made.shift[i]) <= farthest, "placement: shifted by %g mm in %c; up to %g are possible",
                      made.shift[i], "xyz"[i], farthest);
    mend(made.rotation);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const double whole = round(made.rotation[i][k]);
            if (fabs(made.rotation[i][k] - whole) < on_axis) made.rotation[i][k] = whole + 0.0;
        }
    *out = made;
    return SWARF_OK;
}

void swarf_placement_direction(const swarf_placement *placement, const double in[3], double out[3])
{
    const double d[3] = {in[0], in[1], in[2]};
    for (int k = 0; k < 3; k++) out[k] = vector_dot(placement->rotation[k], d);
}

void swarf_placement_point(const swarf_placement *placement, const double in[3], double out[3])
{
    swarf_placement_direction(placement, in, out);
    for (int k = 0; k < 3; k++) out[k] += placement->shift[k];
}

swarf_placement swarf_placement_inverse(const swarf_placement *placement)
{
    swarf_placement back = {0};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) back.rotation[i][k] = placement->rotation[k][i];
    for (int i = 0; i < 3; i++) back.shift[i] = 0.0 - vector_dot(back.rotation[i], placement->shift);
    return back;
}

int swarf_placement_quarters(const swarf_placement *placement, int axis[3], int sign[3])
{
    int found[3] = {0};
    for (int k = 0; k < 3; k++) {
        const double *row = placement->rotation[k];
        while (found[k] < 3 && row[found[k]] == 0) found[k]++;
        if (found[k] == 3 || fabs(row[found[k]]) != 1) return 0;
        for (int other = found[k] + 1; other < 3; other++)
            if (row[other] != 0) return 0;
    }
    double third[3];
    vector_cross(placement->rotation[0], placement->rotation[1], third);
    if (vector_dot(third, placement->rotation[2]) != 1) return 0; /* two rows along one axis, or a mirror */
    for (int k = 0; k < 3; k++) {
        axis[k] = found[k];
        sign[k] = placement->rotation[k][found[k]] > 0 ? 1 : -1;
    }
    return 1;
}
