/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Cutters from text: "bull:d=6,r=1,l=20", "form:0/0:3/0:3/4/0.4:2/5:0/5". */
#include "base/memory.h"
#include "base/number.h"
#include "base/status.h"
#include "cutter/shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* All names, for errors. */
static void list_names(char *out, size_t size)
{
    out[0] = 0;
    for (int i = 0; i < SWARF_SHAPE_COUNT; i++) {
        strncat(out, i ? ", " : "", size - strlen(out) - 1);
        strncat(out, swarf_shape_table[i].name, size - strlen(out) - 1);
    }
}

static swarf_status parse_dimension(const char *text, const char *name, const char *word, size_t length,
                                    swarf_dimensions *dimensions)
{
    const char *equals = memchr(word, '=', length);
    if (!equals || equals == word)
        return swarf_fail(SWARF_ERROR_FORMAT, "cutter '%s': '%.*s' is not of the form letter=number", text, (int)length,
                          word);
    const size_t letters = (size_t)(equals - word);
    for (size_t i = 0; i < swarf_dimension_count; i++) {
        const swarf_dimension *dimension = &swarf_dimension_table[i];
        if (strlen(dimension->letters) != letters || strncmp(dimension->letters, word, letters) != 0) continue;
        double *value = (double *)((char *)dimensions + dimension->offset);
        if (!isnan(*value))
            return swarf_fail(SWARF_ERROR_FORMAT, "cutter '%s': %s is given twice", text, dimension->letters);
        if (swarf_number_read(equals + 1, word + length, value) != word + length)
            return swarf_fail(SWARF_ERROR_FORMAT, "cutter '%s': '%.*s' does not end in a number", text, (int)length,
                              word);
        return SWARF_OK;
    }
    return swarf_fail(SWARF_ERROR_FORMAT, "cutter '%s': '%.*s' is no dimension of %s", text, (int)letters, word, name);
}

static swarf_status parse_form(const char *text, const char *words, swarf_cutter **out)
{
    swarf_profile_node *nodes = NULL;
    size_t room = 0, count = 0;
    swarf_status status = SWARF_OK;
    while (status == SWARF_OK) {
        status = swarf_array_reserve((void **)&nodes, &room, count + 1, sizeof *nodes);
        if (status != SWARF_OK) break;
        double value[3] = {0};
        int given = 0;
        const char *const stop = words + strlen(words), *end = words;
        while (given < 3) {
            end = swarf_number_read(given ? end + 1 : words, stop, &value[given]);
            if (!end) break;
            given++;
            if (*end != '/') break;
        }
        if (given < 2 || !end || (*end && *end != ':')) {
            status = swarf_fail(SWARF_ERROR_FORMAT, "cutter '%s': node %zu is not of the form r/z or r/z/bulge", text,
                                count);
            break;
        }
        nodes[count++] = (swarf_profile_node){value[0], value[1], value[2]};
        if (!*end) break;
        words = end + 1;
    }
    if (status == SWARF_OK) {
        const swarf_cutter_part part = {SWARF_PART_FLUTES, nodes, count};
        status = swarf_cutter_create(&part, 1, out);
    }
    free(nodes);
    return status;
}

swarf_status swarf_cutter_parse(const char *text, swarf_cutter **out)
{
    SWARF_REQUIRE(text && out, "cutter: text or output missing");
    const char *colon = strchr(text, ':');
    const size_t length = colon ? (size_t)(colon - text) : strlen(text);
    int shape = 0;
    while (shape < SWARF_SHAPE_COUNT && (strlen(swarf_shape_table[shape].name) != length ||
                                         strncmp(swarf_shape_table[shape].name, text, length) != 0))
        shape++;
    if (shape == SWARF_SHAPE_COUNT || !colon) {
        char names[256];
        list_names(names, sizeof names);
        return swarf_fail(SWARF_ERROR_FORMAT, "cutter '%s': must be NAME:DIMENSIONS as in flat:d=3,l=18; names are %s",
                          text, names);
    }
    if (shape == SWARF_SHAPE_FORM) return parse_form(text, colon + 1, out);
    swarf_dimensions dimensions = swarf_dimensions_default();
    for (const char *word = colon; *word;) {
        word++; /* over the ':' or ',' */
        const size_t length_word = strcspn(word, ",");
        SWARF_TRY(parse_dimension(text, swarf_shape_table[shape].name, word, length_word, &dimensions));
        word += length_word;
    }
    const swarf_status status = swarf_cutter_create_shape((swarf_shape)shape, &dimensions, out);
    return status == SWARF_ERROR_ARGUMENT ? swarf_fail(SWARF_ERROR_FORMAT, "%s", swarf_error_last()) : status;
}
