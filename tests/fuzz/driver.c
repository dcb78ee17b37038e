/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Replays a corpus through a fuzz target without a fuzzer: every file of the folders given, each of its beginnings
 * (up to a few hundred), and some thousand mutations of it. Inputs lie in blocks of their own length, so that the
 * address sanitizer sees a reader that goes past the end. No input at all is a failure. */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

/* Whole files of more than this only replay as they are. */
enum { MUTATED_MAX = 65536, PREFIXES = 300, MUTATIONS = 1500 };

static uint64_t state = 1;
static size_t inputs;

static uint64_t draw(uint64_t count)
{
    uint64_t x = state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (x ^ (x >> 31)) % count;
}

static void run(const unsigned char *data, size_t size)
{
    unsigned char *copy = malloc(size ? size : 1);
    if (!copy) exit(2);
    memcpy(copy, data, size);
    (void)LLVMFuzzerTestOneInput(copy, size);
    free(copy);
    inputs++;
}

/* One to four small changes: a bit, a byte, a stretch repeated, a stretch taken out. */
static size_t mutate(unsigned char *data, size_t size)
{
    for (uint64_t changes = 1 + draw(4); changes && size; changes--) {
        const size_t at = (size_t)draw(size), length = 1 + (size_t)draw(size - at < 16 ? size - at : 16);
        switch (draw(4)) {
        case 0: data[at] ^= (unsigned char)(1u << draw(8)); break;
        case 1: data[at] = (unsigned char)draw(256); break;
        case 2: memmove(data + draw(size - length + 1), data + at, length); break;
        default:
            memmove(data + at, data + at + length, size - at - length);
            size -= length;
            break;
        }
    }
    return size;
}

static void replay(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0) {
        fprintf(stderr, "%s: cannot read\n", path);
        exit(2);
    }
    const size_t size = (size_t)ftell(file);
    rewind(file);
    unsigned char *data = malloc(size + 1), *changed = malloc(size + 1);
    if (!data || !changed || fread(data, 1, size, file) != size) exit(2);
    fclose(file);
    run(data, size);
    if (size <= MUTATED_MAX) {
        const size_t step = size / PREFIXES + 1;
        for (size_t length = 0; length < size; length += step) run(data, length);
        for (int i = 0; i < MUTATIONS; i++) {
            memcpy(changed, data, size);
            run(changed, mutate(changed, size));
        }
    }
    free(changed);
    free(data);
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* In the order of names, so that the mutations are the same on every machine. */
static void replay_folder(const char *folder)
{
    DIR *listing = opendir(folder);
    if (!listing) {
        fprintf(stderr, "%s: no such folder\n", folder);
        exit(2);
    }
    char *names[4096];
    size_t count = 0;
    for (const struct dirent *entry; count < 4096 && (entry = readdir(listing));)
        if (entry->d_name[0] != '.' && !(names[count++] = strdup(entry->d_name))) exit(2);
    closedir(listing);
    qsort(names, count, sizeof *names, compare_names);
    for (size_t i = 0; i < count; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        replay(path);
        free(names[i]);
    }
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) replay_folder(argv[i]);
    printf("%zu inputs\n", inputs);
    return inputs ? 0 : 1;
}
