/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the benchmarks share: their fixed jobs, and a clock. */
#ifndef SWARF_BENCH_JOBS_H
#define SWARF_BENCH_JOBS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "test.h"

typedef struct bench_job {
    const char *name;
    const char *cutter;
    swarf_box box;
} bench_job;

/* The jobs of the prototype this is measured against, to the digit. */
static const bench_job bench_jobs[] = {
    {"bear", "flat:d=3,l=18", {{0, 0, -20}, {80, 80, 0}}},
    {"cameo", "ball:d=2,l=4", {{-83.6, -104.153, -6}, {83.6, 103.747, 0}}},
};

static inline const bench_job *bench_job_find(const char *name)
{
    for (size_t i = 0; i < sizeof bench_jobs / sizeof *bench_jobs; i++)
        if (strcmp(name, bench_jobs[i].name) == 0) return &bench_jobs[i];
    return NULL;
}

static inline double bench_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/** Seconds of all threads' processor time. */
static inline double bench_cpu(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline void bench_must(swarf_status status)
{
    if (status == SWARF_OK) return;
    fprintf(stderr, "benchmark: %s\n", swarf_error_last());
    exit(2);
}

/** Voxel with which the longest edge of the stock has `resolution` of them. */
static inline double bench_job_voxel(const bench_job *job, int resolution)
{
    double longest = 0;
    for (int i = 0; i < 3; i++)
        if (job->box.hi[i] - job->box.lo[i] > longest) longest = job->box.hi[i] - job->box.lo[i];
    return longest / resolution;
}

/** The program of a job; released by the caller. Exits with 77 when the data are not there. */
static inline swarf_program *bench_job_program(const bench_job *job)
{
    char path[2048];
    if (!test_shared()[0]) {
        fprintf(stderr, "benchmark: skipped, no folder of shared data: set SWARF_SHARED\n");
        exit(77);
    }
    snprintf(path, sizeof path, "%s/data/%s.nc", test_shared(), job->name);
    swarf_gcode_options options = swarf_gcode_options_default();
    options.start[0] = options.start[1] = 0;
    options.start[2] = 50;
    swarf_program *program = NULL;
    bench_must(swarf_gcode_read_file(path, &options, NULL, &program));
    return program;
}

/** The paths of a job's moves; freed by the caller. */
static inline swarf_path *bench_job_paths(const bench_job *job, size_t *count)
{
    swarf_program *program = bench_job_program(job);
    const size_t moves = swarf_program_move_count(program);
    swarf_path *paths = malloc((moves + 1) * sizeof *paths);
    if (!paths) exit(2);
    *count = 0;
    for (size_t i = 0; i < moves; i++) {
        bench_must(swarf_program_path(program, i, &paths[*count]));
        *count += paths[*count].has_motion != 0;
    }
    swarf_program_release(program);
    return paths;
}

/** A job about to be run: a block, and what cuts it. */
typedef struct bench_setup {
    swarf_program *program;
    swarf_cutter *cutter;
    swarf_tool *tools;
    size_t moves, tool_count;
    swarf_stock *stock;
} bench_setup;

static inline bench_setup bench_setup_begin(const bench_job *job, double voxel)
{
    bench_setup s = {.program = bench_job_program(job)};
    s.moves = swarf_program_move_count(s.program);
    s.tool_count = swarf_program_section_count(s.program);
    s.tools = calloc(s.tool_count + 1, sizeof *s.tools);
    if (!s.tools) exit(2);
    bench_must(swarf_cutter_parse(job->cutter, &s.cutter));
    for (size_t i = 0; i < s.tool_count; i++)
        s.tools[i] = (swarf_tool){swarf_program_sections(s.program)[i].tool, 0, s.cutter};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    bench_must(swarf_stock_create_box(&job->box, &options, &s.stock));
    return s;
}

/** The exact surface of a job, before it is cut; owned by the caller. */
static inline swarf_surface *bench_setup_surface(const bench_setup *s)
{
    swarf_surface *surface = NULL;
    bench_must(swarf_surface_create(s->stock, s->program, s->tools, s->tool_count, NULL, &surface));
    return surface;
}

static inline void bench_setup_cut(const bench_setup *s)
{
    swarf_simulation *simulation = NULL;
    bench_must(
        swarf_stock_simulate(s->stock, s->program, 0, s->moves, s->tools, s->tool_count, NULL, NULL, &simulation));
    swarf_simulation_destroy(simulation);
}

/** The stock, owned by the caller; the rest is freed. */
static inline swarf_stock *bench_setup_end(bench_setup *s)
{
    free(s->tools);
    swarf_cutter_release(s->cutter);
    swarf_program_release(s->program);
    return s->stock;
}

/** The stock after the job, and its exact surface; both owned by the caller. */
static inline swarf_stock *bench_job_cut(const bench_job *job, double voxel, swarf_surface **surface)
{
    bench_setup s = bench_setup_begin(job, voxel);
    *surface = bench_setup_surface(&s);
    bench_setup_cut(&s);
    return bench_setup_end(&s);
}

#endif
