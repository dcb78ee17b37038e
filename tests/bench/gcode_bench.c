/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* gcode_bench KIND LINES: read a text of that many lines, one line of JSON; processor time, the
 * minimum and median of five.
 *
 * KIND: plain (N words, G1 X Y Z F), short (X Y as CAM writes surfaces), cycles (a hole a line), loop (a while of O
 * words that makes as many moves from ten lines), expressions (a computed X a line). The peak holds the text as well.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "test.h"

enum { RUNS = 5 };

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time); /* one thread: what a free core would take */
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static size_t write_line(char *at, const char *kind, long i)
{
    if (strcmp(kind, "plain") == 0)
        return (size_t)sprintf(at, "N%ld G1 X%ld.%03ld Y%ld.5 Z-%ld.25 F1000\n", i, i % 200, i % 1000, i % 77, i % 9);
    if (strcmp(kind, "short") == 0) return (size_t)sprintf(at, "X%ld.%03ld Y%ld.5\n", i % 200, i % 1000, i % 77);
    if (strcmp(kind, "cycles") == 0) return (size_t)sprintf(at, "G81 X%ld.5 Y%ld Z-3 R1\n", i % 200, i % 77);
    return (size_t)sprintf(at, "G1 X[#1+%ld*2] Y[SIN[%ld]]\n", i % 200, i % 360);
}

static char *write_text(const char *kind, long lines, size_t *length)
{
    char *text = malloc((size_t)lines * 64 + 400);
    if (!text) return NULL;
    size_t used = (size_t)sprintf(text, "G21 F100 S100 #1=1\nG0 X0 Y0 Z5\nG1 X1\n");
    if (strcmp(kind, "loop") == 0)
        used += (size_t)sprintf(text + used, "#2=0\no1 while [#2 LT %ld]\nG1 X[#2 MOD 100]\n#2=[#2+1]\no1 endwhile\n",
                                lines);
    for (long i = 0; i < lines && strcmp(kind, "loop") != 0; i++) used += write_line(text + used, kind, i);
    used += (size_t)sprintf(text + used, "M2\n");
    *length = used;
    return text;
}

int main(int count, char **words)
{
    if (count != 3) {
        fprintf(stderr, "usage: gcode_bench plain|short|cycles|loop|expressions LINES\n");
        return 2;
    }
    const long lines = strtol(words[2], NULL, 10);
    size_t length = 0;
    char *text = write_text(words[1], lines, &length);
    if (!text) return 1;
    double seconds[RUNS];
    size_t moves = 0;
    swarf_gcode_options options = swarf_gcode_options_default();
    options.line_limit = (size_t)lines * 10 + 1000;
    for (int run = 0; run < RUNS; run++) {
        swarf_program *program = NULL;
        const double from = now();
        if (swarf_gcode_read(text, length, "bench.nc", &options, NULL, &program) != SWARF_OK) {
            fprintf(stderr, "%s\n", swarf_error_last());
            return 1;
        }
        seconds[run] = now() - from;
        moves = swarf_program_move_count(program);
        swarf_program_release(program);
    }
    qsort(seconds, RUNS, sizeof *seconds, ascending);
    printf("{\"kind\": \"%s\", \"lines\": %ld, \"bytes\": %zu, \"moves\": %zu, \"min_s\": %.4f, \"median_s\": %.4f, "
           "\"peak_mb\": %.1f, \"version\": \"%s\"}\n",
           words[1], lines, length, moves, seconds[0], seconds[RUNS / 2], (double)swarf_memory_peak() / 1e6,
           swarf_version());
    free(text);
    return 0;
}
