/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Notes: a list of texts with their places. Texts are copied one by one; the names of sources, which repeat, are kept
 * once as long as the same one follows. */
#include "base/memory.h"
#include "base/status.h"
#include "swarf/program.h"

#include <stdlib.h>
#include <string.h>

/* Of warnings and messages each: nobody reads more, and a loop can make them by the million. */
enum { NOTES_MAX = 10000, KINDS = 3 };

struct swarf_notes {
    swarf_note *list;
    size_t count, room;
    char **names;
    size_t name_count, name_room;
    size_t of_kind[KINDS];
};

swarf_status swarf_notes_create(swarf_notes **out)
{
    SWARF_REQUIRE(out, "notes: output missing");
    swarf_notes *notes = calloc(1, sizeof *notes);
    if (!notes) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    *out = notes;
    return SWARF_OK;
}

void swarf_notes_destroy(swarf_notes *notes)
{
    if (!notes) return;
    for (size_t i = 0; i < notes->count; i++) free((char *)notes->list[i].text);
    for (size_t i = 0; i < notes->name_count; i++) free(notes->names[i]);
    free(notes->list);
    free(notes->names);
    free(notes);
}

static char *copy_of(const char *text)
{
    const size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    if (copy) memcpy(copy, text, size);
    return copy;
}

static swarf_status keep_name(swarf_notes *notes, const char *name, const char **out)
{
    if (notes->name_count && strcmp(notes->names[notes->name_count - 1], name) == 0) {
        *out = notes->names[notes->name_count - 1];
        return SWARF_OK;
    }
    SWARF_TRY(
        swarf_array_reserve((void **)&notes->names, &notes->name_room, notes->name_count + 1, sizeof *notes->names));
    char *copy = copy_of(name);
    if (!copy) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    *out = notes->names[notes->name_count++] = copy;
    return SWARF_OK;
}

swarf_status swarf_notes_add(swarf_notes *notes, swarf_note_kind kind, const char *source, uint32_t line,
                             uint32_t column, const char *text)
{
    if (!notes) return SWARF_OK;
    SWARF_REQUIRE(source && text && kind >= SWARF_NOTE_ERROR && kind <= SWARF_NOTE_MESSAGE, "notes: NULL or no kind");
    if (kind != SWARF_NOTE_ERROR && notes->of_kind[kind] >= NOTES_MAX) return SWARF_OK;
    SWARF_TRY(swarf_array_reserve((void **)&notes->list, &notes->room, notes->count + 1, sizeof *notes->list));
    const char *name = NULL;
    SWARF_TRY(keep_name(notes, source, &name));
    char *copy = copy_of(text);
    if (!copy) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    notes->of_kind[kind]++;
    notes->list[notes->count++] = (swarf_note){(int32_t)kind, line, column, name, copy};
    return SWARF_OK;
}

size_t swarf_notes_count(const swarf_notes *notes)
{
    return notes ? notes->count : 0;
}

swarf_note swarf_notes_get(const swarf_notes *notes, size_t index)
{
    if (!notes || index >= notes->count) return (swarf_note){SWARF_NOTE_MESSAGE, 0, 0, "", ""};
    return notes->list[index];
}
