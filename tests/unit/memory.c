/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Memory that runs out: everything once through, with the k-th allocation failing, for k = 1, 2, ... until none fails;
 * and so each way of making a mesh.
 *
 * malloc() and its kin and operator new are defined here and so come before the libraries'. They count and refuse what
 * libswarf asks for (the caller is known by its address), and keep those blocks in a table while they live, so that
 * what is left behind shows. What TBB and OpenVDB ask for from within their own libraries is let through. */
#define _GNU_SOURCE /* dl_iterate_phdr() */
#include <link.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stocks.h"

/* glibc's own, under the names that cannot be taken from it. */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void __libc_free(void *block);
/* std::__throw_bad_alloc(), operator new(size_t), new[](size_t): their names for the linker (Itanium C++ ABI). */
_Noreturn void _ZSt17__throw_bad_allocv(void);
void *_Znwm(size_t size);
void *_Znam(size_t size);

/* The code of libswarf. */
static uintptr_t code_from, code_to;

static atomic_bool watching;
static atomic_size_t asked;  /* since the watch began */
static atomic_size_t refuse; /* number of the allocation that fails, 0: none */
static atomic_bool refused;

/* Living blocks of the watch: open addressing, guarded by a spin lock. `gone` marks places that were in use. */
enum { PLACES = 1 << 14 };
static void *living[PLACES];
static char gone;
static atomic_flag lock = ATOMIC_FLAG_INIT;

static int find_code(struct dl_phdr_info *info, size_t size, void *unused)
{
    (void)size, (void)unused;
    if (!strstr(info->dlpi_name, "/libswarf.so")) return 0;
    for (int i = 0; i < info->dlpi_phnum; i++) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[i];
        if (part->p_type != PT_LOAD || !(part->p_flags & PF_X)) continue;
        code_from = info->dlpi_addr + part->p_vaddr;
        code_to = code_from + part->p_memsz;
    }
    return 1;
}

static int counts(const void *caller)
{
    return atomic_load(&watching) && (uintptr_t)caller >= code_from && (uintptr_t)caller < code_to;
}

static int refuses(void)
{
    if (atomic_fetch_add(&asked, 1) + 1 != atomic_load(&refuse)) return 0;
    atomic_store(&refused, 1);
    return 1;
}

static void **place_of(const void *block, int free_one)
{
    size_t at = ((uintptr_t)block >> 4) * 0x9E3779B97F4A7C15u >> 50;
    for (int i = 0; i < PLACES; i++, at = (at + 1) % PLACES) {
        if (living[at] == block || (free_one && living[at] == &gone)) return &living[at];
        if (!living[at]) return free_one ? &living[at] : NULL;
    }
    return NULL;
}

static void remember(void *block)
{
    if (!block) return;
    while (atomic_flag_test_and_set(&lock)) continue;
    void **place = place_of(block, 1);
    if (place) *place = block;
    atomic_flag_clear(&lock);
}

/* 1 if it was remembered. */
static int forget(const void *block)
{
    if (!block || !atomic_load(&watching)) return 0;
    while (atomic_flag_test_and_set(&lock)) continue;
    void **place = place_of(block, 0);
    if (place) *place = &gone;
    atomic_flag_clear(&lock);
    return place != NULL;
}

void *malloc(size_t size)
{
    const int watch = counts(__builtin_return_address(0));
    if (watch && refuses()) return NULL;
    void *block = __libc_malloc(size);
    if (watch) remember(block);
    return block;
}

void *calloc(size_t count, size_t size)
{
    const int watch = counts(__builtin_return_address(0));
    if (watch && refuses()) return NULL;
    void *block = __libc_calloc(count, size);
    if (watch) remember(block);
    return block;
}

void *realloc(void *old, size_t size)
{
    const int watch = counts(__builtin_return_address(0));
    if (watch && refuses()) return NULL;
    const int known = forget(old); /* first: another thread may get the address as soon as it is free */
    void *block = __libc_realloc(old, size);
    if (known || watch) remember(block ? block : old);
    return block;
}

static void *make(size_t size, int watch)
{
    if (watch && refuses()) _ZSt17__throw_bad_allocv();
    void *block = __libc_malloc(size ? size : 1);
    if (!block) _ZSt17__throw_bad_allocv();
    if (watch) remember(block);
    return block;
}

void *_Znwm(size_t size)
{
    return make(size, counts(__builtin_return_address(0)));
}

void *_Znam(size_t size)
{
    return make(size, counts(__builtin_return_address(0)));
}

void free(void *block)
{
    forget(block);
    __libc_free(block);
}

/* A pocket's corner: lines on the level and on a slope, an arc, a plunge. */
static const char program_text[] = "G21 G90 G17\nT1 M6\nG0 X1 Y1 Z12\nG1 Z7 F300\nX7 Z6\nG3 X9 Y3 R2\nG1 Y9\nM2\n";

/* All that the reader of G-code keeps lists of: files' words, names, tools, operations, what compensation holds. */
static const char language_text[] = "o1 sub\n#<a>=#1\no<two> call [1]\no1 endsub\no<two> sub\n#<_g>=2\no<two> endsub\n"
                                    "o1 call [3]\n(print, #<_g>)\nT2 M6\nM101\nG10 L1 P2 R1\nF9 G0 X0 Y0 Z0\nG41\n"
                                    "G1 X10\nX20\nZ-1\nG4 P1\nY20\nG40 G0 X0\nG0 A90\nM98 P7\nM2\nO7\nM99\n";

struct things {
    swarf_program *program, *language;
    swarf_notes *notes;
    swarf_cutter *cutter;
    swarf_stock *stock, *walked;
    swarf_history *history;
    swarf_check *check;
    swarf_simulation *simulation;
    swarf_mesh *mesh, *welded, *parts[2];
    swarf_measures *measures;
    swarf_contour_report report;
    double volume;
    uint64_t hash; /* of the history's stock where its walk ends */
};

static swarf_status read_program(struct things *t)
{
    return swarf_gcode_read(program_text, strlen(program_text), "pocket.nc", NULL, NULL, &t->program);
}

static swarf_status read_language(struct things *t)
{
    swarf_gcode_options options = swarf_gcode_options_default();
    swarf_notes_destroy(t->notes);
    t->notes = NULL;
    const swarf_status status = swarf_notes_create(&t->notes);
    if (status != SWARF_OK) return status;
    options.notes = t->notes;
    return swarf_gcode_read(language_text, strlen(language_text), "language.nc", &options, NULL, &t->language);
}

static swarf_status make_cutter(struct things *t)
{
    return swarf_cutter_parse("bull:d=4,r=1,l=6,sd=3,sl=10", &t->cutter);
}

static swarf_status make_stock(struct things *t)
{
    const swarf_box box = {{0, 0, 0}, {10, 10, 10}};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.5;
    return swarf_stock_create_box(&box, &options, &t->stock);
}

/* With loads, on a stock of its own: what failed half way is not asked again. */
static swarf_status check_loads(struct things *t)
{
    const swarf_tool tool = {.number = 1, .teeth = 2, .cutter = t->cutter};
    swarf_check_options options = swarf_check_options_default();
    swarf_stock *stock = NULL;
    options.loads = 1;
    swarf_status status = swarf_stock_copy(t->stock, &stock);
    if (status == SWARF_OK)
        status = swarf_stock_check(stock, t->program, 0, swarf_program_move_count(t->program), &tool, 1, &options, NULL,
                                   &t->check);
    swarf_stock_destroy(stock);
    return status;
}

static swarf_status simulate(struct things *t)
{
    const swarf_tool tool = {.number = 1, .cutter = t->cutter};
    return swarf_stock_simulate(t->stock, t->program, 0, swarf_program_move_count(t->program), &tool, 1, NULL, NULL,
                                &t->simulation);
}

static swarf_status measure(struct things *t)
{
    return swarf_stock_volume(t->stock, &t->volume);
}

static swarf_status make_history(struct things *t)
{
    const swarf_tool tool = {.number = 1, .cutter = t->cutter};
    const swarf_box box = {{0, 0, 0}, {10, 10, 10}};
    swarf_stock_options options = swarf_stock_options_default();
    swarf_history_options limit = swarf_history_options_default();
    options.voxel_mm = 0.5;
    limit.memory_limit = 60000; /* so that records are made one */
    swarf_status status = t->walked ? SWARF_OK : swarf_stock_create_box(&box, &options, &t->walked);
    if (status == SWARF_OK) status = swarf_history_create(t->walked, t->program, &tool, 1, &limit, &t->history);
    return status;
}

/* Forward, back and forward again; a walk that failed anywhere is walked again from there. */
static swarf_status walk(struct things *t)
{
    const size_t count = swarf_program_move_count(t->program), places[] = {count, 2, count - 1, 0, 4};
    for (int i = 0; i < 5; i++) {
        const swarf_status status = swarf_history_seek(t->history, places[i], i == 4 ? 0.5 : 0, NULL);
        if (status != SWARF_OK) return status;
    }
    return swarf_stock_hash(t->walked, &t->hash);
}

static swarf_status make_mesh(struct things *t)
{
    return swarf_mesh_create_stock(t->stock, 0, NULL, &t->mesh);
}

static swarf_status weld_mesh(struct things *t)
{
    const swarf_triangles triangles = swarf_mesh_triangles(t->mesh);
    return swarf_mesh_create(&triangles, &t->welded);
}

static swarf_status measure_mesh(struct things *t)
{
    return swarf_measures_create(t->mesh, &t->measures);
}

/* Its shell, which it has one of, and none. */
static swarf_status part_mesh(struct things *t)
{
    static const uint32_t group_of = 1;
    size_t shells;
    swarf_measures_shells(t->measures, &shells);
    if (!CHECK(shells == 1)) return SWARF_ERROR_ARGUMENT;
    const swarf_status status = swarf_mesh_create_groups(t->mesh, t->measures, &group_of, 2, NULL, t->parts);
    CHECK((status == SWARF_OK) == (t->parts[0] != NULL) && (status == SWARF_OK) == (t->parts[1] != NULL));
    return status;
}

/* A block with a slot along its side, a groove that leaves a thin wall beside it, and a ball's trace across both: with
 * a cell that is parted, triangles that cut each other and edges to split. Made once. */
static struct {
    swarf_stock *stock;
    swarf_surface *surface;
} part;

/* Longer than a band, which is written to a file. */
static struct {
    swarf_stock *stock;
    char file[32];
} bar = {.file = "/tmp/swarf-memory-XXXXXX.stl"};

static void make_bar(void)
{
    const swarf_box box = {{0, 0, -0.6}, {14, 0.6, 0}};
    const int file = mkstemps(bar.file, 4);
    CHECK(file >= 0 && close(file) == 0);
    bar.stock = stock_block(&box, 0.2);
}

static void release_bar(void)
{
    swarf_stock_destroy(bar.stock);
    CHECK(unlink(bar.file) == 0);
}

static void make_part(void)
{
    static const struct {
        const char *cutter;
        double from[3], to[3];
    } cuts[] = {{"flat:d=0.5,l=9", {-1, 1, -0.3}, {3, 1.4, -0.3}},
                {"chamfer:d=1,l=9,a=60", {-1, 0.2, -0.8}, {3, 0.7, -0.8}},
                {"ball:d=1,l=9", {1.1, -1, -0.4}, {1.3, 3, -0.4}}};
    enum { CUTS = sizeof cuts / sizeof *cuts };
    const swarf_box box = {{0, 0, -1.2}, {1.6, 1.4, 0}};
    swarf_tool tools[CUTS];
    swarf_stock *first = stock_block(&box, 0.2);
    swarf_program *program = NULL;
    part.stock = stock_block(&box, 0.2);
    CHECK_OK(swarf_program_create((double[3]){0, 0, 9}, &program));
    CHECK_OK(swarf_program_add_operation(program, "cut"));
    for (int i = 0; i < CUTS; i++) {
        swarf_cutter *cutter = NULL;
        const swarf_section section = {.tool = i + 1};
        swarf_path path = {.has_motion = 1};
        if (!CHECK_OK(swarf_cutter_parse(cuts[i].cutter, &cutter))) exit(test_end());
        memcpy(path.start, cuts[i].from, sizeof path.start);
        memcpy(path.end, cuts[i].to, sizeof path.end);
        CHECK_OK(swarf_stock_cut(part.stock, cutter, &path, 1, NULL));
        CHECK_OK(swarf_program_set_section(program, &section));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_POSITION, path.start, 0, 1));
        CHECK_OK(swarf_program_add_line(program, SWARF_MOVE_FEED, path.end, 100, 1));
        tools[i] = (swarf_tool){.number = i + 1, .cutter = cutter};
    }
    CHECK_OK(swarf_surface_create(first, program, tools, CUTS, NULL, &part.surface));
    for (int i = 0; i < CUTS; i++) swarf_cutter_release((swarf_cutter *)tools[i].cutter);
    swarf_program_release(program);
    swarf_stock_destroy(first);
}

static void release_part(void)
{
    swarf_surface_release(part.surface);
    swarf_stock_destroy(part.stock);
}

static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) hash = (hash ^ ((const unsigned char *)bytes)[i]) * 0x100000001B3u;
    return hash; /* FNV-1a */
}

static swarf_status contour(struct things *t, const swarf_surface *surface, int fine, int keep_volume)
{
    swarf_contour_options options = swarf_contour_options_default();
    options.surface = surface;
    options.fine = fine;
    options.keep_volume = keep_volume;
    options.error_mm = keep_volume ? 0.01 : 0;
    const swarf_status status = swarf_mesh_contour(part.stock, &options, NULL, &t->mesh, &t->report);
    CHECK((status == SWARF_OK) == (t->mesh != NULL));
    if (status != SWARF_OK) return status;
    const swarf_triangles mesh = swarf_mesh_triangles(t->mesh);
    t->volume = swarf_mesh_topology(t->mesh).volume_mm3;
    t->hash = hash_bytes(0xCBF29CE484222325u, mesh.xyz, 3 * mesh.vertex_count * sizeof *mesh.xyz);
    t->hash = hash_bytes(t->hash, mesh.index, 3 * mesh.triangle_count * sizeof *mesh.index);
    return SWARF_OK;
}

static swarf_status contour_field(struct things *t)
{
    return contour(t, NULL, 0, 0);
}

static swarf_status contour_surface(struct things *t)
{
    return contour(t, part.surface, 0, 0);
}

static swarf_status contour_fine(struct things *t)
{
    const swarf_status status = contour(t, part.surface, 1, 0);
    const swarf_contour_report *report = &t->report;
    if (status == SWARF_OK) CHECK(report->parted_cells && report->intersections_found && report->split_edges);
    return status;
}

static swarf_status contour_kept(struct things *t)
{
    return contour(t, part.surface, 0, 1);
}

static swarf_status contour_bands(struct things *t)
{
    char bytes[4096];
    const swarf_contour_options options = swarf_contour_options_default();
    const swarf_status status = swarf_mesh_stream(bar.stock, &options, 1, bar.file, NULL, &t->report);
    if (status != SWARF_OK) return status;
    FILE *file = fopen(bar.file, "rb");
    if (!CHECK(file != NULL)) return SWARF_ERROR_IO;
    t->volume = t->report.surface_mm3;
    t->hash = 0xCBF29CE484222325u;
    for (size_t got; (got = fread(bytes, 1, sizeof bytes, file)) > 0;) t->hash = hash_bytes(t->hash, bytes, got);
    CHECK(fclose(file) == 0);
    return SWARF_OK;
}

struct step {
    const char *name;
    swarf_status (*fn)(struct things *t);
};

static const struct step all[] = {
    {"read the program", read_program},
    {"read the language", read_language},
    {"make the cutter", make_cutter},
    {"make the stock", make_stock},
    {"check loads", check_loads},
    {"simulate", simulate},
    {"measure", measure},
    {"make a history", make_history},
    {"walk through it", walk},
    {"make the mesh", make_mesh},
    {"weld the mesh", weld_mesh},
    {"measure the mesh", measure_mesh},
    {"part the mesh", part_mesh},
};

static const struct step contours[] = {
    {"contour the field", contour_field},
    {"contour the surface", contour_surface},
    {"contour finely", contour_fine},
    {"contour and keep the volume", contour_kept},
};

static const struct step bands[] = {
    {"contour band by band", contour_bands},
};

static void release(struct things *t)
{
    for (size_t i = 0; i < 2; i++) swarf_mesh_release(t->parts[i]);
    swarf_measures_destroy(t->measures);
    swarf_mesh_release(t->welded);
    swarf_mesh_release(t->mesh);
    swarf_simulation_destroy(t->simulation);
    swarf_history_destroy(t->history);
    swarf_stock_destroy(t->walked);
    swarf_check_destroy(t->check);
    swarf_stock_destroy(t->stock);
    swarf_cutter_release(t->cutter);
    swarf_program_release(t->program);
    swarf_program_release(t->language);
    swarf_notes_destroy(t->notes);
}

/* One go through some steps. */
struct round {
    const struct step *steps;
    size_t count;
    size_t fail;     /* the number of the allocation that fails, 0: none */
    double expected; /* volume at the end, 0: not known yet */
    uint64_t expected_hash;
    size_t asked;
    double volume;
    uint64_t hash;
};

/* A step that comes back without memory is asked again: then it succeeds, and the result is that of a round in which
 * nothing failed. */
static void *play_round(void *argument)
{
    struct round *round = argument;
    struct things t = {0};
    atomic_store(&refused, 0);
    atomic_store(&asked, 0);
    atomic_store(&refuse, round->fail);
    atomic_store(&watching, 1);
    int ok = 1;
    for (size_t i = 0; i < round->count && ok; i++) {
        const struct step *step = &round->steps[i];
        const int before = atomic_load(&refused);
        swarf_status status = step->fn(&t);
        if (status == SWARF_ERROR_MEMORY && !before && atomic_load(&refused)) status = step->fn(&t);
        ok = status == SWARF_OK;
        if (!ok) printf("allocation %zu, %s: %s\n", round->fail, step->name, swarf_error_last());
    }
    release(&t);
    round->asked = atomic_load(&asked);
    round->volume = t.volume;
    round->hash = t.hash;
    CHECK(ok);
    if (ok && round->expected > 0) CHECK(t.volume == round->expected && t.hash == round->expected_hash);
    return NULL;
}

/* In a thread of its own: what the library keeps for a thread goes with it. */
static void run_round(struct round *round)
{
    pthread_t thread;
    memset(living, 0, sizeof living);
    if (!CHECK(pthread_create(&thread, NULL, play_round, round) == 0)) return;
    pthread_join(thread, NULL);
    atomic_store(&watching, 0);
    if (round->fail == 0) return; /* what is set up once stays */
    size_t left = 0;
    for (int i = 0; i < PLACES; i++) left += living[i] && living[i] != &gone;
    if (left) printf("allocation %zu: %zu blocks are left\n", round->fail, left);
    CHECK(left == 0);
}

/* With every `stride`th allocation failing; volume of what the steps made. */
static double fail_each(const struct step *steps, size_t count, size_t stride)
{
    struct round first = {.steps = steps, .count = count}, second = first;
    run_round(&first);
    run_round(&second);
    CHECK(second.asked > 50);
    for (size_t k = 1; k <= second.asked; k += stride) {
        struct round round = second;
        round.fail = k;
        round.expected = second.volume;
        round.expected_hash = second.hash;
        run_round(&round);
        CHECK(atomic_load(&refused));
    }
    printf("%s ...: one in %zu of %zu allocations failed\n", steps->name, stride, second.asked);
    return second.volume;
}

int main(void)
{
    CHECK(dl_iterate_phdr(find_code, NULL) == 1);
    CHECK_OK(swarf_threads_set(1)); /* the same allocation is the k-th in each round */
    const double milled = fail_each(all, sizeof all / sizeof *all, 1);
    CHECK(milled > 500 && milled < 1000);
    const size_t stride = test_size() == TEST_FULL ? 1 : 5;
    make_part();
    for (size_t i = 0; i < sizeof contours / sizeof *contours; i++) {
        const double part_mm3 = fail_each(&contours[i], 1, stride);
        CHECK(part_mm3 > 1 && part_mm3 < 2);
    }
    release_part();
    make_bar();
    CHECK_NEAR(fail_each(bands, 1, stride), 14 * 0.6 * 0.6, 1e-3);
    release_bar();
    return test_end();
}
