/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* surface_bench PROGRAM N THREADS [POINTS]: cut a fixed job, then move the vertices of its mesh onto the exact surface.
 * PROGRAM is bear or cameo (see shared data); prints one line of JSON. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "jobs.h"

/* Places of a mesh's vertices, directions out of the material there, and where they went. */
typedef struct vertices {
    size_t count;
    double *xyz, *normal, *out;
    int64_t *move;
} vertices;

/* Directions: summed normals of the triangles. */
static void take_normals(const swarf_triangles *t, vertices *v)
{
    for (size_t i = 0; i < t->triangle_count; i++) {
        const uint32_t *at = t->index + 3 * i;
        double e[2][3];
        for (int s = 0; s < 2; s++)
            for (int k = 0; k < 3; k++) e[s][k] = (double)t->xyz[3 * at[s + 1] + k] - (double)t->xyz[3 * at[0] + k];
        for (int s = 0; s < 3; s++)
            for (int k = 0; k < 3 && at[s] < v->count; k++)
                v->normal[3 * at[s] + k] +=
                    e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
    }
    for (size_t i = 0; i < v->count; i++)
        if (v->normal[3 * i] == 0 && v->normal[3 * i + 1] == 0 && v->normal[3 * i + 2] == 0) v->normal[3 * i + 2] = 1;
}

/* The first vertices of the stock's mesh, `most` at most. */
static vertices take_vertices(swarf_stock *stock, size_t most)
{
    swarf_mesh *mesh = NULL;
    bench_must(swarf_mesh_create_stock(stock, 0, NULL, &mesh));
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    vertices v = {.count = most < t.vertex_count ? most : t.vertex_count};
    v.xyz = malloc((v.count + 1) * 24);
    v.normal = calloc(v.count + 1, 24);
    v.out = malloc((v.count + 1) * 24);
    v.move = malloc((v.count + 1) * 8);
    if (!v.xyz || !v.normal || !v.out || !v.move) exit(2);
    for (size_t i = 0; i < 3 * v.count; i++) v.xyz[i] = (double)t.xyz[i];
    take_normals(&t, &v);
    swarf_mesh_release(mesh);
    return v;
}

static void print(const vertices *v, double voxel)
{
    size_t none = 0;
    double sum = 0, most = 0;
    for (size_t i = 0; i < v->count; i++) {
        none += v->move[i] == -2;
        double square = 0;
        for (int k = 0; k < 3; k++) square += pow(v->out[3 * i + k] - v->xyz[3 * i + k], 2);
        sum += square;
        most = fmax(most, square);
    }
    printf("\"without\": %zu, \"moved_rms_voxel\": %.4f, \"moved_most_voxel\": %.4f}\n", none,
           sqrt(sum / (double)(v->count + !v->count)) / voxel, sqrt(most) / voxel);
}

int main(int count, char **argument)
{
    const bench_job *j = count > 1 ? bench_job_find(argument[1]) : NULL;
    if (!j || count < 4 || count > 5 || atoi(argument[2]) < 1) {
        fprintf(stderr, "usage: surface_bench bear|cameo RESOLUTION THREADS [POINTS]\n");
        return 2;
    }
    bench_must(swarf_threads_set(atoi(argument[3])));
    const double voxel = bench_job_voxel(j, atoi(argument[2]));
    bench_setup setup = bench_setup_begin(j, voxel);
    const double t_build = bench_now();
    swarf_surface *surface = bench_setup_surface(&setup);
    const double build_s = bench_now() - t_build;
    bench_setup_cut(&setup);
    swarf_stock *stock = bench_setup_end(&setup);
    vertices v = take_vertices(stock, count > 4 ? (size_t)atol(argument[4]) : SIZE_MAX);
    const double t_refine = bench_now();
    bench_must(swarf_surface_refine(surface, setup.moves, &(swarf_surface_lines){v.xyz, v.normal, v.count, voxel}, NULL,
                                    &(swarf_surface_feet){v.out, v.normal, v.move}));
    const double refine_s = bench_now() - t_refine;
    printf("{\"program\": \"%s\", \"resolution\": %s, \"threads\": %d, \"moves\": %zu, \"points\": %zu, "
           "\"build_s\": %.4f, \"refine_s\": %.4f, ",
           j->name, argument[2], swarf_threads(), setup.moves, v.count, build_s, refine_s);
    print(&v, voxel);
    free(v.xyz);
    free(v.normal);
    free(v.out);
    free(v.move);
    swarf_stock_destroy(stock);
    swarf_surface_release(surface);
    return 0;
}
