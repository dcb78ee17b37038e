/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "base/memory.h"

#include "base/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static size_t read_number(const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file) return SIZE_MAX;
    unsigned long long value;
    const int got = fscanf(file, "%llu", &value);
    fclose(file);
    return got == 1 ? (size_t)value : SIZE_MAX; /* "max": no limit */
}

size_t swarf_memory_free(void)
{
    size_t bytes = SIZE_MAX;
    FILE *file = fopen("/proc/meminfo", "r");
    if (file) {
        char line[256];
        unsigned long long kib;
        while (fgets(line, sizeof line, file))
            if (sscanf(line, "MemAvailable: %llu kB", &kib) == 1) bytes = (size_t)kib * 1024;
        fclose(file);
    }
    const size_t limit = read_number("/sys/fs/cgroup/memory.max");
    if (limit != SIZE_MAX) {
        const size_t used = read_number("/sys/fs/cgroup/memory.current");
        const size_t left = used < limit ? limit - used : 0;
        if (left < bytes) bytes = left;
    }
    return bytes;
}

double swarf_memory_limit(size_t asked)
{
    if (asked) return (double)asked;
    const size_t left = swarf_memory_free();
    return left == SIZE_MAX ? INFINITY : 0.8 * (double)left;
}

size_t swarf_memory_peak(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (size_t)usage.ru_maxrss * 1024 : 0;
}

swarf_status swarf_array_reserve(void **array, size_t *room, size_t needed, size_t element)
{
    if (needed <= *room) return SWARF_OK;
    size_t wanted = *room * 2 > needed ? *room * 2 : needed;
    if (wanted < 16) wanted = 16;
    if (wanted > SIZE_MAX / element) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    void *grown = realloc(*array, wanted * element);
    if (!grown) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory for %zu bytes", wanted * element);
    *array = grown;
    *room = wanted;
    return SWARF_OK;
}
