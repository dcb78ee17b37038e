/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code: text -> lines -> blocks -> machine. The text is read where it lies, never copied and never past its end. */
#include "swarf/gcode.h"

#include "base/file.h"
#include "base/parallel.h"
#include "base/status.h"
#include "gcode/machine.h"
#include "program/arc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Lines between two looks at the clock: some 0.2 ms of work. */
enum { LINES_PER_LOOK = 2048 };

/* A few dozen reports a second. */
static const double report_interval_s = 0.03;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

swarf_gcode_options swarf_gcode_options_default(void)
{
    return (swarf_gcode_options){sizeof(swarf_gcode_options), {NAN, NAN, NAN}};
}

/* One past the last byte of the line at `at`; CR, LF and CR LF end a line. */
static const char *line_end(const char *at, const char *end)
{
    while (at < end && *at != '\n' && *at != '\r') at++;
    return at;
}

static int has_words(const swarf_block *block)
{
    return block->given || block->grouped;
}

static swarf_status read_lines(swarf_machine *machine, const char *text, const char *end,
                               const swarf_progress *progress)
{
    static const char mark[] = "\xef\xbb\xbf"; /* byte order mark that some editors leave */
    const char *at = text;
    if (end - at >= 3 && memcmp(at, mark, 3) == 0) at += 3;
    int begun = 0; /* something other than comments was read: a '%' from here on is the last one */
    double reported = now();
    swarf_block block;
    while (at < end && !machine->ended) {
        const char *stop = line_end(at, end);
        machine->place.line++;
        SWARF_TRY(swarf_block_read(&machine->place, at, stop, &block));
        if (block.percent) {
            if (begun) break;
            begun = 1;
        } else if (has_words(&block)) {
            begun = 1;
            SWARF_TRY(swarf_machine_run(machine, &block));
        }
        at = end - stop >= 2 && stop[0] == '\r' && stop[1] == '\n' ? stop + 2 : stop < end ? stop + 1 : end;
        if (machine->place.line % LINES_PER_LOOK != 0) continue;
        const double time = now();
        if (time - reported < report_interval_s) continue;
        reported = time;
        SWARF_TRY(swarf_progress_report(progress, (double)(at - text) / (double)(end - text)));
    }
    return swarf_progress_report(progress, 1.0);
}

swarf_status swarf_gcode_read(const char *text, size_t length, const char *name, const swarf_gcode_options *options,
                              const swarf_progress *progress, swarf_program **out)
{
    SWARF_REQUIRE((text || length == 0) && name && out, "gcode: text, name or output missing");
    const swarf_gcode_options defaults = swarf_gcode_options_default();
    if (!options) options = &defaults;
    SWARF_REQUIRE(options->size == sizeof *options, "gcode: options of %zu bytes; take swarf_gcode_options_default()",
                  options->size);
    SWARF_TRY(swarf_progress_report(progress, 0.0));
    swarf_program *program;
    SWARF_TRY(swarf_program_create(options->start, &program));
    swarf_machine machine;
    swarf_machine_begin(&machine, program, name, options->start);
    if (!text) text = "";
    const swarf_status status = read_lines(&machine, text, text + length, progress);
    swarf_machine_end(&machine);
    if (status != SWARF_OK) {
        swarf_program_release(program);
        return status;
    }
    *out = program;
    return SWARF_OK;
}

swarf_status swarf_gcode_read_file(const char *path, const swarf_gcode_options *options, const swarf_progress *progress,
                                   swarf_program **out)
{
    char *text;
    size_t length;
    SWARF_TRY(swarf_file_read(path, &text, &length));
    const swarf_status status = swarf_gcode_read(text, length, path, options, progress, out);
    free(text);
    return status;
}
