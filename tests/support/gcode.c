/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "gcode.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Before every text; lines are counted without it. */
static const char head[] = "F100 G98\n";

swarf_status gcode_read_bytes(const char *text, size_t length, swarf_program **out)
{
    char *copy = malloc(sizeof head - 1 + length);
    if (!copy) return SWARF_ERROR_MEMORY;
    memcpy(copy, head, sizeof head - 1);
    memcpy(copy + sizeof head - 1, text, length);
    swarf_gcode_options options = swarf_gcode_options_default();
    options.start[0] = options.start[1] = 0;
    options.start[2] = 10;
    const swarf_status status = swarf_gcode_read(copy, sizeof head - 1 + length, "part.nc", &options, NULL, out);
    free(copy);
    return status;
}

swarf_program *gcode_read_ok(const char *text)
{
    swarf_program *program = NULL;
    CHECK_OK(gcode_read_bytes(text, strlen(text), &program));
    if (!program) CHECK_OK(swarf_program_create(NULL, &program)); /* the failure is counted; go on with nothing */
    return program;
}

void gcode_refuse(const char *text, const char *part)
{
    swarf_program *program = NULL;
    int ok = CHECK(gcode_read_bytes(text, strlen(text), &program) == SWARF_ERROR_FORMAT);
    char message[800] = "";
    const char *last = swarf_error_last(), *place = strchr(last, ':');
    if (ok && place) {
        char *rest;
        const unsigned long line = strtoul(place + 1, &rest, 10);
        snprintf(message, sizeof message, "part.nc:%lu%s", line - 1, rest);
    }
    ok = CHECK(strstr(message, part) != NULL) && ok;
    if (!ok) fprintf(stderr, "  in: %s\n  wanted: %s\n  got: %s\n", text, part, message);
    CHECK(program == NULL);
    swarf_program_release(program);
}

void gcode_expect(const char *text, const char *kinds, ...)
{
    swarf_program *program = gcode_read_ok(text);
    const size_t count = swarf_program_move_count(program);
    const swarf_move *moves = swarf_program_moves(program);
    int same = count == strlen(kinds);
    va_list ends;
    va_start(ends, kinds);
    for (size_t i = 0; i < strlen(kinds); i++) {
        double wanted[3];
        for (int k = 0; k < 3; k++) wanted[k] = va_arg(ends, double);
        if (i >= count) continue;
        const char *letters = "rfdtpP";
        const char kind = moves[i].arc >= 0 ? 'a' : letters[swarf_move_get_kind(&moves[i])];
        same = same && kind == kinds[i];
        for (int k = 0; k < 3; k++)
            same = same && (isnan(wanted[k]) ? isnan(moves[i].end[k]) : fabs(moves[i].end[k] - wanted[k]) < 1e-9);
    }
    va_end(ends);
    if (!CHECK(same)) {
        fprintf(stderr, "  in: %s\n  %zu moves:\n", text, count);
        for (size_t i = 0; i < count; i++)
            fprintf(stderr, "  kind %d arc %d: %.9g %.9g %.9g\n", (int)swarf_move_get_kind(&moves[i]),
                    (int)moves[i].arc, moves[i].end[0], moves[i].end[1], moves[i].end[2]);
    }
    swarf_program_release(program);
}
