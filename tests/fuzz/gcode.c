/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Any bytes as G-code: an error with a place and a text, or a program whose every number is sound. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "swarf/swarf.h"

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

static void require(int condition)
{
    if (!condition) abort();
}

/* Finite, or unknown where it may be. */
static void check_path(const swarf_program *program, size_t index)
{
    swarf_path path;
    require(swarf_program_path(program, index, &path) == SWARF_OK);
    if (!path.has_motion) return;
    const double length = swarf_path_length(&path);
    require(isfinite(length) && length >= 0.0);
    for (int i = 0; i <= 4; i++) {
        double p[3];
        swarf_path_point(&path, i / 4.0, p);
        require(isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]));
    }
}

/* What is not in the text is taken from its length, so that mutations change it as well. */
static swarf_gcode_options options_for(size_t size)
{
    static const swarf_gcode_tool tools[] = {{1, 0, {0, 0, 10}, 6}, {2, 0, {1, 2, 20}, -1}};
    swarf_gcode_options options = swarf_gcode_options_default();
    options.dialect = (swarf_gcode_dialect)(size % 5 % 4);
    options.block_delete = size / 5 % 2 == 1;
    if (size / 10 % 2) {
        options.tools = tools;
        options.tool_count = sizeof tools / sizeof *tools;
    }
    static const swarf_gcode_diameter diameters[] = {{1, 5}, {3, 0}};
    if (size / 40 % 2) {
        options.diameters = diameters;
        options.diameter_count = sizeof diameters / sizeof *diameters;
    }
    if (size / 20 % 2)
        for (int k = 0; k < 3; k++) options.start[k] = 0.0;
    options.line_limit = 20000;
    return options;
}

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size)
{
    swarf_program *program = NULL;
    swarf_gcode_options options = options_for(size);
    require(swarf_notes_create(&options.notes) == SWARF_OK);
    const swarf_status status = swarf_gcode_read((const char *)data, size, "fuzz.nc", &options, NULL, &program);
    const size_t notes = swarf_notes_count(options.notes);
    for (size_t i = 0; i < notes; i++) require(strlen(swarf_notes_get(options.notes, i).text) < 500);
    if (status == SWARF_ERROR_FORMAT) {
        require(notes > 0 && swarf_notes_get(options.notes, notes - 1).kind == SWARF_NOTE_ERROR);
        require(strncmp(swarf_error_last(), "fuzz.nc:", 8) == 0);
    }
    swarf_notes_destroy(options.notes);
    if (status != SWARF_OK) {
        require((status == SWARF_ERROR_FORMAT || status == SWARF_ERROR_MEMORY) && program == NULL);
        return 0;
    }
    const size_t count = swarf_program_move_count(program);
    const size_t step = count / 10000 + 1; /* expanded cycles may be many moves alike */
    for (size_t i = 0; i < count; i += step) {
        const swarf_move *move = &swarf_program_moves(program)[i];
        double from[6], to[6];
        require(swarf_move_get_section(move) < swarf_program_section_count(program));
        require(move->arc < (int32_t)swarf_program_arc_count(program));
        require(isfinite(move->feed_mm_min) && move->feed_mm_min >= 0.0f);
        (void)swarf_program_move_axes(program, i, from, to);
        for (int k = 0; k < 6; k++) require(isfinite(from[k]) && isfinite(to[k]));
        check_path(program, i);
    }
    require(isfinite(swarf_program_seconds(program, 1000.0)));
    double *seconds = malloc((count + 1) * sizeof *seconds);
    require(seconds != NULL && swarf_program_times(program, NULL, seconds) == SWARF_OK);
    for (size_t i = 0; i < count; i += step) require(isfinite(seconds[i]) && seconds[i] >= 0.0);
    free(seconds);
    swarf_program_release(program);
    return 0;
}
