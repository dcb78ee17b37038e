/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Meshes of groups of shells of a mesh, in one pass: its triangles are sorted by group, and each group takes its own in
 * the order in which they were, with vertices numbered as they come. */
#include "base/parallel.h"
#include "base/status.h"
#include "swarf/mesh.h"

#include <stdlib.h>
#include <string.h>

typedef struct sorted {
    size_t *end;      /* of each group in `order` */
    uint32_t *order;  /* triangles by group */
    uint32_t *number; /* of each vertex in the group that is made, UINT32_MAX: not in it */
    float *xyz;       /* its vertices and triangles */
    uint32_t *index;
    swarf_mesh **made;
} sorted;

static void sorted_free(sorted *s, size_t count)
{
    for (size_t g = 0; s->made && g < count; g++) swarf_mesh_release(s->made[g]);
    free(s->end);
    free(s->order);
    free(s->number);
    free(s->xyz);
    free(s->index);
    free(s->made);
}

static swarf_status sort(const swarf_triangles *t, const uint32_t *shell_of, const uint32_t *group_of, size_t count,
                         sorted *s)
{
    s->end = calloc(count + 1, sizeof *s->end);
    s->order = malloc((t->triangle_count + 1) * sizeof *s->order);
    s->number = malloc((t->vertex_count + 1) * sizeof *s->number);
    s->xyz = malloc(3 * (t->vertex_count + 1) * sizeof *s->xyz);
    s->index = malloc(3 * (t->triangle_count + 1) * sizeof *s->index);
    s->made = calloc(count + 1, sizeof(swarf_mesh *));
    if (!s->end || !s->order || !s->number || !s->xyz || !s->index || !s->made)
        return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for its shells");
    memset(s->number, 0xff, t->vertex_count * sizeof *s->number);
    for (size_t i = 0; i < t->triangle_count; i++)
        if (group_of[shell_of[i]] < count) s->end[group_of[shell_of[i]] + 1]++;
    for (size_t g = 0; g < count; g++) s->end[g + 1] += s->end[g];
    for (size_t i = 0; i < t->triangle_count; i++) /* where a group begins becomes where it ends */
        if (group_of[shell_of[i]] < count) s->order[s->end[group_of[shell_of[i]]]++] = (uint32_t)i;
    return SWARF_OK;
}

static swarf_status make_group(const swarf_triangles *t, sorted *s, size_t group)
{
    const size_t begin = group ? s->end[group - 1] : 0;
    const uint32_t *own = s->order + begin;
    swarf_triangles part = {s->xyz, 0, s->index, s->end[group] - begin};
    for (size_t i = 0; i < part.triangle_count; i++)
        for (size_t k = 0; k < 3; k++) {
            const uint32_t v = t->index[3 * (size_t)own[i] + k];
            if (s->number[v] == UINT32_MAX) {
                memcpy(s->xyz + 3 * part.vertex_count, t->xyz + 3 * (size_t)v, 3 * sizeof *s->xyz);
                s->number[v] = (uint32_t)part.vertex_count++;
            }
            s->index[3 * i + k] = s->number[v];
        }
    for (size_t i = 0; i < part.triangle_count; i++)
        for (size_t k = 0; k < 3; k++) s->number[t->index[3 * (size_t)own[i] + k]] = UINT32_MAX;
    return swarf_mesh_create(&part, &s->made[group]);
}

swarf_status swarf_mesh_create_groups(const swarf_mesh *mesh, const swarf_measures *measures, const uint32_t *group_of,
                                      size_t count, const swarf_progress *progress, swarf_mesh **out)
{
    SWARF_REQUIRE(mesh && measures && group_of && (out || !count), "mesh: NULL");
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    sorted s = {0};
    swarf_status status = sort(&t, swarf_measures_shell_of(measures), group_of, count, &s);
    for (size_t g = 0; g < count && status == SWARF_OK; g++) {
        status = swarf_progress_report(progress, (double)g / (double)count);
        if (status == SWARF_OK) status = make_group(&t, &s, g);
    }
    if (status == SWARF_OK) status = swarf_progress_report(progress, 1);
    if (status == SWARF_OK)
        for (size_t g = 0; g < count; g++) {
            out[g] = s.made[g];
            s.made[g] = NULL;
        }
    sorted_free(&s, count);
    return status;
}

swarf_status swarf_mesh_create_shells(const swarf_mesh *mesh, const swarf_measures *measures, const uint32_t *shells,
                                      size_t count, swarf_mesh **out)
{
    SWARF_REQUIRE(mesh && measures && out && (shells || !count), "mesh: NULL");
    size_t all;
    swarf_measures_shells(measures, &all);
    for (size_t i = 0; i < count; i++) SWARF_REQUIRE(shells[i] < all, "mesh: shell %u of %zu", shells[i], all);
    uint32_t *group_of = malloc((all + 1) * sizeof *group_of);
    if (!group_of) return swarf_fail(SWARF_ERROR_MEMORY, "mesh: out of memory for its shells");
    memset(group_of, 0xff, all * sizeof *group_of);
    for (size_t i = 0; i < count; i++) group_of[shells[i]] = 0;
    const swarf_status status = swarf_mesh_create_groups(mesh, measures, group_of, 1, NULL, out);
    free(group_of);
    return status;
}
