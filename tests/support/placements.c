/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "placements.h"

#include <math.h>
#include <string.h>

swarf_placement placement_make(const double angle[3], const double shift[3])
{
    double r[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, rows[12];
    for (int axis = 0; axis < 3; axis++) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (int k = 0; k < 3; k++) {
            const double ra = r[a][k], rb = r[b][k];
            r[a][k] = cos(angle[axis]) * ra - sin(angle[axis]) * rb;
            r[b][k] = sin(angle[axis]) * ra + cos(angle[axis]) * rb;
        }
    }
    for (int i = 0; i < 3; i++) {
        memcpy(rows + 4 * i, r[i], sizeof r[i]);
        rows[4 * i + 3] = shift[i];
    }
    swarf_placement made = swarf_placement_identity();
    CHECK_OK(swarf_placement_create(rows, &made));
    return made;
}
