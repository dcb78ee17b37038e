/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "gcode/sources.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { SOURCES_MAX = 1000 };

void swarf_sources_destroy(swarf_sources *sources)
{
    for (size_t i = 0; i < sources->count; i++) {
        swarf_source_destroy(sources->list[i]);
        free(sources->list[i]);
    }
    free(sources->list);
}

swarf_status swarf_sources_add(swarf_sources *sources, swarf_program *program, const char *name, char *text,
                               size_t length, int owned, swarf_source **out)
{
    swarf_source *source = calloc(1, sizeof *source);
    const size_t size = strlen(name) + 1;
    char *copy = malloc(size);
    swarf_status status = source && copy ? SWARF_OK : swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    if (status == SWARF_OK)
        status =
            swarf_array_reserve((void **)&sources->list, &sources->room, sources->count + 1, sizeof *sources->list);
    if (status == SWARF_OK) status = swarf_program_add_source(program, name, &source->index);
    if (status != SWARF_OK) {
        free(source);
        free(copy);
        if (owned) free(text);
        return status;
    }
    memcpy(copy, name, size);
    source->name = copy;
    source->text = text;
    source->length = length;
    source->owned = owned;
    sources->list[sources->count++] = source;
    *out = source;
    return SWARF_OK;
}

/* The file FOLDER/LABEL.ngc, if there is one. */
static swarf_status try_file(swarf_sources *sources, swarf_machine *machine, const char *folder, size_t length,
                             const char *label, swarf_source **out)
{
    static const char *const suffixes[] = {"ngc", "nc"};
    *out = NULL;
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
        char path[4096];
        const int size =
            snprintf(path, sizeof path, "%.*s%s%s.%s", (int)length, folder, length ? "/" : "", label, suffixes[i]);
        struct stat status;
        if (size < 0 || (size_t)size >= sizeof path || stat(path, &status) != 0 || !S_ISREG(status.st_mode)) continue;
        for (size_t k = 0; k < sources->count; k++)
            if (strcmp(sources->list[k]->name, path) == 0) *out = sources->list[k];
        if (*out) return SWARF_OK;
        if (sources->count >= SOURCES_MAX) return swarf_fail(SWARF_ERROR_MEMORY, "more than %d files", SOURCES_MAX);
        char *text;
        size_t bytes;
        SWARF_TRY(swarf_file_read(path, &text, &bytes));
        return swarf_sources_add(sources, machine->program, path, text, bytes, 1, out);
    }
    return SWARF_OK;
}

static swarf_status look_into(swarf_machine *machine, swarf_source *source, swarf_flow_kind kind, const char *label,
                              const swarf_flow_word **out)
{
    if (!source->scanned) SWARF_TRY(swarf_flow_scan(machine, source));
    *out = swarf_flow_find(source, kind, label);
    return SWARF_OK;
}

swarf_status swarf_sources_find(swarf_sources *sources, swarf_machine *machine, swarf_source *here,
                                swarf_flow_kind kind, const char *label, swarf_source **source,
                                const swarf_flow_word **out)
{
    *out = NULL;
    *source = here;
    SWARF_TRY(look_into(machine, *source, kind, label, out));
    for (size_t i = 0; i < sources->count && !*out; i++) {
        *source = sources->list[i];
        SWARF_TRY(look_into(machine, *source, kind, label, out));
    }
    if (*out || strchr(label, '/')) return SWARF_OK;
    if (sources->folder) {
        SWARF_TRY(try_file(sources, machine, sources->folder, strlen(sources->folder), label, source));
        if (*source) SWARF_TRY(look_into(machine, *source, kind, label, out));
    }
    for (const char *at = sources->search; at && *at && !*out;) {
        const char *end = strchr(at, ':');
        const size_t length = end ? (size_t)(end - at) : strlen(at);
        SWARF_TRY(try_file(sources, machine, at, length, label, source));
        if (*source) SWARF_TRY(look_into(machine, *source, kind, label, out));
        at = end ? end + 1 : NULL;
    }
    return SWARF_OK;
}
