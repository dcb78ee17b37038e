/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* G-code: texts -> lines -> blocks -> machine, and the jumps between lines. The text is read where it lies, never
 * copied and never past its end.
 *
 *     sources   the program's text, and the files of subroutines it called
 *     frames    where each call returns to, and what it keeps: #1 to #30, its locals, its repeats
 */
#include "swarf/gcode.h"

#include "base/file.h"
#include "base/parallel.h"
#include "base/status.h"
#include "gcode/sources.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Lines between two looks at the clock: some 0.2 ms of work. */
enum { LINES_PER_LOOK = 2048 };

/* A few dozen reports a second. */
static const double report_interval_s = 0.03;

/* Loops and calls end in an error after this many lines where nobody says how many: some ten seconds. */
static const size_t line_limit_default = 20000000;

enum { LOOPS_MAX = 1000, ARGUMENTS_MAX = SWARF_PARAMETERS_LOCAL };

typedef struct loop {
    const swarf_flow_word *word; /* its repeat */
    double left;
} loop;

typedef struct frame {
    swarf_source *source;
    const char *at; /* where it goes on */
    uint32_t line;
    const swarf_flow_word *entry; /* what was called; NULL: the program itself */
    int repeats;                  /* M98 L */
    int numbered;                 /* called by M98: parameters are the caller's */
    double locals[SWARF_PARAMETERS_LOCAL + 1];
    size_t base;
    int loops;
} frame;

typedef struct runner {
    swarf_machine machine;
    swarf_block block;
    swarf_sources sources;
    frame frames[SWARF_CALLS_MAX + 1];
    int depth;
    loop loops[LOOPS_MAX];
    int loop_count;
    size_t executed, limit;
    double reported, fraction;
    int begun;  /* something but comments was read: a second '%' is the end */
    int titled; /* the program's own number was read */
} runner;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

swarf_gcode_options swarf_gcode_options_default(void)
{
    swarf_gcode_options options;
    memset(&options, 0, sizeof options);
    options.size = sizeof options;
    for (int k = 0; k < 3; k++) options.start[k] = NAN;
    options.parameter_unit_mm = 1.0;
    return options;
}

/* ---- jumps ---- */

static frame *top(runner *r)
{
    return &r->frames[r->depth];
}

static void go_on_after(runner *r, const swarf_flow_word *word)
{
    frame *f = top(r);
    f->at = swarf_line_next(word->line_end, f->source->text + f->source->length);
    f->line = word->line;
}

static void go_to(runner *r, const swarf_flow_word *word)
{
    frame *f = top(r);
    f->at = word->line_text;
    f->line = word->line - 1;
}

static swarf_word span_of(const swarf_flow_word *word)
{
    return (swarf_word){0.0, word->word, (uint32_t)(word->rest - word->word), 0};
}

static swarf_status fail_word(const runner *r, const swarf_flow_word *word, const char *text)
{
    const swarf_word where = span_of(word);
    return swarf_gcode_fail(&r->machine, &where, "%s", text);
}

/* Behind blanks and comments. */
static const char *skip_comments(const char *at, const char *end)
{
    for (at = swarf_skip_blanks(at, end); at < end && *at == '('; at = swarf_skip_blanks(at, end)) {
        while (at < end && *at != ')') at++;
        if (at < end) at++;
    }
    return at < end && *at == ';' ? end : at;
}

/* Nothing but comments may follow. */
static swarf_status check_rest(const runner *r, const swarf_flow_word *word, const char *at)
{
    at = skip_comments(at, word->line_end);
    if (at == word->line_end) return SWARF_OK;
    const swarf_word where = {0.0, at, 1, 0};
    return swarf_gcode_fail(&r->machine, &where, "does not belong into a line of an O word");
}

static swarf_status read_value(runner *r, const swarf_flow_word *word, double *out)
{
    const char *at = skip_comments(word->rest, word->line_end);
    if (at == word->line_end || *at != '[') return fail_word(r, word, "needs a value in brackets");
    SWARF_TRY(swarf_value_read(&r->machine, &at, word->line_end, out));
    return check_rest(r, word, at);
}

/* Forget the repeats inside the block that is left; its own too when `own`. */
static void leave_loops(runner *r, const swarf_flow_word *begin, const swarf_flow_word *end, int own)
{
    while (r->loop_count > top(r)->loops && r->loops[r->loop_count - 1].word >= begin + (own ? 0 : 1) &&
           r->loops[r->loop_count - 1].word <= end)
        r->loop_count--;
}

/* ---- calls ---- */

static swarf_status enter(runner *r, const swarf_word *where, swarf_source *source, const swarf_flow_word *entry,
                          int numbered, int repeats)
{
    const int limit = r->machine.dialect->call_depth;
    if (r->depth >= limit || r->depth >= SWARF_CALLS_MAX)
        return swarf_gcode_fail(&r->machine, where, "calls deeper than %d levels; does it call itself for ever?",
                                limit);
    frame *f = &r->frames[++r->depth];
    f->source = source;
    f->entry = entry;
    f->numbered = numbered;
    f->repeats = repeats;
    f->loops = r->loop_count;
    f->base = r->machine.parameters.base;
    memcpy(f->locals, r->machine.parameters.numbered, sizeof f->locals);
    if (!numbered) r->machine.parameters.base = r->machine.parameters.locals.count;
    r->machine.level = r->depth;
    r->machine.is_saved[r->depth] = 0;
    r->machine.place.name = source->name;
    r->machine.section.source = source->index;
    go_on_after(r, entry);
    return SWARF_OK;
}

static swarf_status leave(runner *r)
{
    frame *f = top(r);
    if (f->numbered && --f->repeats > 0) {
        go_on_after(r, f->entry);
        return SWARF_OK;
    }
    if (r->machine.is_saved[r->depth] == 2) SWARF_TRY(swarf_machine_restore(&r->machine));
    if (!f->numbered) {
        swarf_parameters_leave(&r->machine.parameters, r->machine.parameters.base);
        r->machine.parameters.base = f->base;
        memcpy(r->machine.parameters.numbered, f->locals, sizeof f->locals);
    }
    r->loop_count = f->loops;
    r->depth--;
    r->machine.level = r->depth;
    r->machine.place.name = top(r)->source->name;
    r->machine.section.source = top(r)->source->index;
    return SWARF_OK;
}

/* The label of a call: written out, or computed now. */
static swarf_status label_of(runner *r, const swarf_flow_word *word, char *out, size_t size)
{
    if (word->label) {
        snprintf(out, size, "%s", word->label);
        return SWARF_OK;
    }
    const char *at = word->word + 1;
    double number = 0.0;
    SWARF_TRY(swarf_value_read(&r->machine, &at, word->line_end, &number));
    const double nearest = nearbyint(number);
    if (!(fabs(number - nearest) <= 1e-4 && nearest >= 0.0 && nearest < 1e9))
        return fail_word(r, word, "computes a label that is no whole number");
    snprintf(out, size, "%.0f", nearest);
    return SWARF_OK;
}

static swarf_status call(runner *r, const swarf_flow_word *word)
{
    char label[SWARF_PARAMETER_NAME_MAX + 1];
    double arguments[ARGUMENTS_MAX];
    int count = 0;
    const char *at = skip_comments(word->rest, word->line_end);
    SWARF_TRY(label_of(r, word, label, sizeof label));
    for (; at < word->line_end && *at == '['; at = skip_comments(at, word->line_end)) {
        if (count == ARGUMENTS_MAX) return fail_word(r, word, "has more than 30 arguments");
        SWARF_TRY(swarf_value_read(&r->machine, &at, word->line_end, &arguments[count++]));
    }
    SWARF_TRY(check_rest(r, word, at));
    swarf_source *source;
    const swarf_flow_word *entry;
    SWARF_TRY(swarf_sources_find(&r->sources, &r->machine, top(r)->source, SWARF_FLOW_SUB, label, &source, &entry));
    const swarf_word where = span_of(word);
    if (!entry)
        return swarf_gcode_fail(&r->machine, &where,
                                "calls a subroutine that is not there: no 'o%.40s sub' and no file '%.40s.ngc'", label,
                                label);
    SWARF_TRY(enter(r, &where, source, entry, 0, 1));
    for (int i = 0; i < count; i++) r->machine.parameters.numbered[1 + i] = arguments[i];
    r->machine.returned = 0.0;
    r->machine.has_returned = 0;
    return SWARF_OK;
}

/* return and endsub, with a value where brackets follow. */
static swarf_status return_from(runner *r, const swarf_flow_word *word)
{
    const frame *f = top(r);
    if (!f->entry || f->numbered) return fail_word(r, word, "is in no call of its subroutine");
    const char *at = skip_comments(word->rest, word->line_end);
    if (at < word->line_end && *at == '[') {
        double value = 0.0;
        SWARF_TRY(read_value(r, word, &value));
        r->machine.returned = value;
        r->machine.has_returned = 1;
    } else {
        SWARF_TRY(check_rest(r, word, at));
    }
    return leave(r);
}

static swarf_status call_numbered(runner *r)
{
    char label[32];
    snprintf(label, sizeof label, "%d", r->machine.call_number);
    swarf_source *source;
    const swarf_flow_word *entry;
    SWARF_TRY(swarf_sources_find(&r->sources, &r->machine, top(r)->source, SWARF_FLOW_PROGRAM, label, &source, &entry));
    if (!entry)
        return swarf_gcode_fail(&r->machine, &r->machine.call_word,
                                "calls a program that is not there: no line O%s and no file '%s.ngc'", label, label);
    if (r->machine.call_repeats == 0) return SWARF_OK;
    return enter(r, &r->machine.call_word, source, entry, 1, r->machine.call_repeats);
}

static swarf_status return_numbered(runner *r)
{
    const frame *f = top(r);
    if (!f->entry) {
        r->machine.ended = 1;
        return swarf_gcode_warn(&r->machine, &r->machine.call_word, "begins the program anew; one pass is simulated");
    }
    if (!f->numbered)
        return swarf_gcode_fail(&r->machine, &r->machine.call_word, "ends programs that M98 called; write endsub");
    return leave(r);
}

/* ---- O words ---- */

/* From an if or an elseif whose condition was read, or to what comes after a branch that was executed. */
static swarf_status choose(runner *r, const swarf_flow_word *word)
{
    const swarf_flow_word *words = top(r)->source->words;
    for (;;) {
        double condition = 1.0;
        r->machine.place.text = word->line_text;
        r->machine.place.line = word->line;
        if (word->kind == SWARF_FLOW_IF || word->kind == SWARF_FLOW_ELSEIF)
            SWARF_TRY(read_value(r, word, &condition));
        else
            SWARF_TRY(check_rest(r, word, word->rest));
        if (condition != 0.0) break;
        word = &words[word->branch];
    }
    go_on_after(r, word);
    return SWARF_OK;
}

static swarf_status begin_repeat(runner *r, const swarf_flow_word *word)
{
    double count = 0.0;
    SWARF_TRY(read_value(r, word, &count));
    const swarf_flow_word *last = &top(r)->source->words[word->end];
    if (!(count >= 1.0)) {
        go_on_after(r, last);
        return SWARF_OK;
    }
    if (r->loop_count == LOOPS_MAX) return fail_word(r, word, "is in too many loops at once");
    r->loops[r->loop_count++] = (loop){word, floor(count)};
    return SWARF_OK;
}

static void end_repeat(runner *r, const swarf_flow_word *word)
{
    const swarf_flow_word *first = &top(r)->source->words[word->begin];
    if (r->loop_count <= top(r)->loops || r->loops[r->loop_count - 1].word != first) return;
    if (--r->loops[r->loop_count - 1].left >= 1.0)
        go_on_after(r, first);
    else
        r->loop_count--;
}

static swarf_status run_flow(runner *r, const char *at)
{
    frame *f = top(r);
    if (!f->source->scanned) SWARF_TRY(swarf_flow_scan(&r->machine, f->source));
    const swarf_flow_word *word = swarf_flow_at(f->source, at);
    if (!word) return swarf_gcode_fail(&r->machine, NULL, "O word behind the end of the program");
    const swarf_flow_word *words = f->source->words, *begin = &words[word->begin], *end = &words[word->end];
    double value = 0.0;
    switch ((swarf_flow_kind)word->kind) {
    case SWARF_FLOW_PROGRAM:
        if (r->titled) return fail_word(r, word, "is where the program runs into another one; end it by M30 or M99");
        r->titled = 1;
        return check_rest(r, word, word->rest);
    case SWARF_FLOW_SUB: go_on_after(r, end); return SWARF_OK;
    case SWARF_FLOW_ENDSUB:
    case SWARF_FLOW_RETURN: return return_from(r, word);
    case SWARF_FLOW_CALL: return call(r, word);
    case SWARF_FLOW_IF: return choose(r, word);
    case SWARF_FLOW_ELSEIF:
    case SWARF_FLOW_ELSE:
    case SWARF_FLOW_ENDIF: go_on_after(r, end); return SWARF_OK;
    case SWARF_FLOW_WHILE:
        SWARF_TRY(read_value(r, word, &value));
        if (value == 0.0) go_on_after(r, end);
        return SWARF_OK;
    case SWARF_FLOW_ENDWHILE: go_to(r, begin); return check_rest(r, word, word->rest);
    case SWARF_FLOW_DO: return check_rest(r, word, word->rest);
    case SWARF_FLOW_DO_WHILE:
        SWARF_TRY(read_value(r, word, &value));
        if (value != 0.0) go_on_after(r, begin);
        return SWARF_OK;
    case SWARF_FLOW_REPEAT: return begin_repeat(r, word);
    case SWARF_FLOW_ENDREPEAT: end_repeat(r, word); return SWARF_OK;
    case SWARF_FLOW_BREAK:
        leave_loops(r, begin, end, 1);
        go_on_after(r, end);
        return SWARF_OK;
    case SWARF_FLOW_CONTINUE:
        leave_loops(r, begin, end, 0);
        go_to(r, end);
        return SWARF_OK;
    }
    return SWARF_OK;
}

/* ---- lines ---- */

static swarf_status report(runner *r, const swarf_progress *progress)
{
    const double time = now();
    if (time - r->reported < report_interval_s) return SWARF_OK;
    r->reported = time;
    const swarf_source *main = r->sources.list[0];
    if (r->frames[0].source == main && main->length)
        r->fraction = fmax(r->fraction, (double)(r->frames[0].at - main->text) / (double)main->length);
    return swarf_progress_report(progress, r->fraction);
}

/* What to do at the end of a text: 1 if the program is over. */
static swarf_status end_of_text(runner *r)
{
    const frame *f = top(r);
    r->machine.place.text = f->source->text + f->source->length;
    if (f->entry)
        return swarf_gcode_fail(&r->machine, NULL, "the text ends inside the subprogram O%s; write M99",
                                f->entry->label);
    r->machine.ended = 1;
    if (r->machine.dialect->needs_end && r->begun)
        return swarf_gcode_warn(&r->machine, NULL, "the text ends without M2, M30 or a second %%");
    return SWARF_OK;
}

static int has_words(const swarf_block *block)
{
    return block->given || block->grouped || block->setting_count;
}

static swarf_status run_line(runner *r)
{
    frame *f = top(r);
    const char *end = f->source->text + f->source->length, *text = f->at;
    const char *stop = swarf_line_end(text, end);
    f->at = swarf_line_next(stop, end);
    r->machine.place.line = ++f->line;
    swarf_block *block = &r->block;
    SWARF_TRY(swarf_block_read(&r->machine, text, stop, block));
    if (block->skipped) return SWARF_OK;
    if (block->flow) {
        r->begun = 1;
        return run_flow(r, block->flow);
    }
    if (block->percent) {
        if (!r->begun) { /* the first; what comes before it is a title */
            r->begun = 1;
            return SWARF_OK;
        }
        if (f->entry) return end_of_text(r);
        r->machine.ended = 1;
        return SWARF_OK;
    }
    if (!has_words(block)) return block->comment ? swarf_machine_comment(&r->machine, block) : SWARF_OK;
    r->begun = 1;
    SWARF_TRY(swarf_machine_run(&r->machine, block));
    if (r->machine.request == SWARF_REQUEST_NONE) return SWARF_OK;
    return r->machine.request == SWARF_REQUEST_CALL ? call_numbered(r) : return_numbered(r);
}

static swarf_status run(runner *r, const swarf_progress *progress)
{
    static const char mark[] = "\xef\xbb\xbf"; /* byte order mark that some editors leave */
    frame *main = &r->frames[0];
    main->source = r->sources.list[0];
    main->at = main->source->text;
    if (main->source->length >= 3 && memcmp(main->at, mark, 3) == 0) main->at += 3;
    r->machine.place.name = main->source->name;
    r->reported = now();
    while (!r->machine.ended) {
        const frame *f = top(r);
        if (f->at >= f->source->text + f->source->length) {
            SWARF_TRY(end_of_text(r));
            continue;
        }
        SWARF_TRY(run_line(r));
        if (++r->executed % LINES_PER_LOOK != 0) continue;
        if (r->executed > r->limit)
            return swarf_gcode_fail(&r->machine, NULL, "more than %zu lines were executed: a loop without an end?",
                                    r->executed);
        SWARF_TRY(report(r, progress));
    }
    SWARF_TRY(swarf_machine_finish(&r->machine));
    return swarf_progress_report(progress, 1.0);
}

static swarf_status read_text(const char *text, size_t length, const char *name, const char *folder,
                              const swarf_gcode_options *options, const swarf_progress *progress, swarf_program **out)
{
    SWARF_TRY(swarf_progress_report(progress, 0.0));
    runner *r = calloc(1, sizeof *r);
    if (!r) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    swarf_program *program = NULL;
    swarf_status status = swarf_program_create(options->start, &program);
    if (status == SWARF_OK) {
        r->sources.search = options->path;
        r->sources.folder = folder;
        r->limit = (options->line_limit ? options->line_limit : line_limit_default) + length;
        status = swarf_machine_begin(&r->machine, options, program);
        swarf_source *source;
        if (status == SWARF_OK)
            status = swarf_sources_add(&r->sources, program, name, (char *)text, length, 0, &source);
        if (status == SWARF_OK) status = run(r, progress);
        swarf_machine_end(&r->machine);
    }
    swarf_sources_destroy(&r->sources);
    free(r);
    if (status != SWARF_OK) {
        swarf_program_release(program);
        return status;
    }
    *out = program;
    return SWARF_OK;
}

static swarf_status check_options(const swarf_gcode_options **options, const swarf_gcode_options *defaults)
{
    if (!*options) *options = defaults;
    SWARF_REQUIRE((*options)->size == sizeof **options,
                  "gcode: options of %zu bytes; take swarf_gcode_options_default()", (*options)->size);
    return SWARF_OK;
}

swarf_status swarf_gcode_read(const char *text, size_t length, const char *name, const swarf_gcode_options *options,
                              const swarf_progress *progress, swarf_program **out)
{
    SWARF_REQUIRE((text || length == 0) && name && out, "gcode: text, name or output missing");
    const swarf_gcode_options defaults = swarf_gcode_options_default();
    SWARF_TRY(check_options(&options, &defaults));
    return read_text(text ? text : "", length, name, NULL, options, progress, out);
}

swarf_status swarf_gcode_read_file(const char *path, const swarf_gcode_options *options, const swarf_progress *progress,
                                   swarf_program **out)
{
    SWARF_REQUIRE(path && out, "gcode: path or output missing");
    const swarf_gcode_options defaults = swarf_gcode_options_default();
    SWARF_TRY(check_options(&options, &defaults));
    char *text;
    size_t length;
    SWARF_TRY(swarf_file_read(path, &text, &length));
    const char *slash = strrchr(path, '/');
    const size_t size = slash ? (size_t)(slash - path) : 0;
    char *folder = malloc(size + 2);
    swarf_status status = SWARF_ERROR_MEMORY;
    if (folder) {
        memcpy(folder, size ? path : slash ? "/" : ".", size ? size : 1);
        folder[size ? size : 1] = 0;
        status = read_text(text, length, path, folder, options, progress, out);
        free(folder);
    } else {
        (void)swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    }
    free(text);
    return status;
}
