/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Base room: statuses, threads, topology. */
#include <math.h>
#include <string.h>

#include "test.h"

static void check_topology(void)
{
    const float xyz[] = {0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4};
    const uint32_t closed[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    swarf_triangles tetrahedron = {xyz, 4, closed, 4};
    swarf_topology topology;
    if (CHECK_OK(swarf_triangles_topology(&tetrahedron, &topology))) {
        CHECK(topology.closed);
        CHECK(topology.boundary_edges == 0);
        CHECK_NEAR(topology.volume_mm3, 4.0, 1e-9);
        CHECK_NEAR(topology.box.hi[2], 4.0, 0);
    }
    tetrahedron.triangle_count = 3;
    if (CHECK_OK(swarf_triangles_topology(&tetrahedron, &topology))) {
        CHECK(!topology.closed);
        CHECK(topology.boundary_edges == 3);
    }
    const uint32_t flipped[] = {0, 1, 2, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    tetrahedron = (swarf_triangles){xyz, 4, flipped, 4};
    if (CHECK_OK(swarf_triangles_topology(&tetrahedron, &topology))) {
        CHECK(!topology.closed);
        CHECK(topology.misoriented_edges == 3);
    }
    const uint32_t outside[] = {0, 1, 7};
    tetrahedron = (swarf_triangles){xyz, 4, outside, 1};
    CHECK_FAILS(swarf_triangles_topology(&tetrahedron, &topology), SWARF_ERROR_ARGUMENT, "vertex 7");
    const float bad[] = {0, 0, 0, 2, NAN, 0, 0, 3, 0, 0, 0, 4};
    tetrahedron = (swarf_triangles){bad, 4, closed, 4};
    CHECK_FAILS(swarf_triangles_topology(&tetrahedron, &topology), SWARF_ERROR_ARGUMENT, "y of vertex 1");
}

int main(void)
{
    CHECK(strcmp(swarf_version(), "0.1.0") == 0);
    CHECK_FAILS(swarf_threads_set(-1), SWARF_ERROR_ARGUMENT, "-1");
    CHECK_OK(swarf_threads_set(3));
    CHECK(swarf_threads() == 3);
    CHECK_OK(swarf_threads_set(0));
    CHECK(swarf_threads() > 0);
    CHECK_FAILS(swarf_isa_set((swarf_isa)9), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_OK(swarf_isa_set(SWARF_ISA_SCALAR));
    CHECK(swarf_isa_current() == SWARF_ISA_SCALAR);
    check_topology();
    return test_end();
}
