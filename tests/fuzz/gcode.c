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

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size)
{
    swarf_program *program = NULL;
    const swarf_status status = swarf_gcode_read((const char *)data, size, "fuzz.nc", NULL, NULL, &program);
    if (status != SWARF_OK) {
        require(status == SWARF_ERROR_FORMAT && program == NULL);
        require(strncmp(swarf_error_last(), "fuzz.nc:", 8) == 0);
        return 0;
    }
    const size_t count = swarf_program_move_count(program);
    const size_t step = count / 10000 + 1; /* expanded cycles may be many moves alike */
    for (size_t i = 0; i < count; i += step) {
        const swarf_move *move = &swarf_program_moves(program)[i];
        require(swarf_move_get_section(move) < swarf_program_section_count(program));
        require(move->arc < (int32_t)swarf_program_arc_count(program));
        require(isfinite(move->feed_mm_min) && move->feed_mm_min >= 0.0f);
        check_path(program, i);
    }
    require(isfinite(swarf_program_seconds(program, 1000.0)));
    swarf_program_release(program);
    return 0;
}
