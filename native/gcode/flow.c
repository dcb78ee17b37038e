/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "gcode/flow.h"

#include "base/memory.h"
#include "base/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Open blocks at once; no program nests deeper. */
enum { NEST_MAX = 100 };

const char *swarf_line_end(const char *at, const char *end)
{
    while (at < end && *at != '\n' && *at != '\r') at++;
    return at;
}

const char *swarf_line_next(const char *stop, const char *end)
{
    return end - stop >= 2 && stop[0] == '\r' && stop[1] == '\n' ? stop + 2 : stop < end ? stop + 1 : end;
}

void swarf_source_destroy(swarf_source *source)
{
    for (size_t i = 0; i < source->count; i++) free(source->words[i].label);
    free(source->words);
    free(source->name);
    if (source->owned) free(source->text);
}

static char lower(char c)
{
    return (char)(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
}

static int is_letter(char c)
{
    return lower(c) >= 'a' && lower(c) <= 'z';
}

/* Where the line's first word is, line numbers and a block delete left aside; NULL: nowhere, or the line is deleted. */
static const char *first_word(const swarf_machine *machine, const char *at, const char *end)
{
    at = swarf_skip_blanks(at, end);
    if (at < end && *at == '/') {
        if (machine->block_delete) return NULL;
        at = swarf_skip_blanks(at + 1, end);
    }
    if (at < end && lower(*at) == 'n') {
        double number;
        uint32_t whole;
        at++;
        (void)swarf_plain_number_read(&at, end, &number, &whole);
        at = swarf_skip_blanks(at, end);
    }
    return at < end ? at : NULL;
}

/* The value behind O that is no plain number or name: "[...]", "#5", "#<x>". */
static const char *skip_value(const char *at, const char *end)
{
    while (at < end && *at == '#') at = swarf_skip_blanks(at + 1, end);
    if (at < end && *at == '<') {
        while (at < end && *at != '>') at++;
        return at < end ? at + 1 : at;
    }
    if (at < end && *at == '[') {
        int depth = 0;
        for (; at < end; at++) {
            depth += *at == '[';
            depth -= *at == ']';
            if (depth == 0) return at + 1;
        }
        return at;
    }
    while (at < end && *at >= '0' && *at <= '9') at++;
    return at;
}

static swarf_status fail_at(const swarf_machine *machine, const swarf_flow_word *word, const char *text)
{
    const swarf_word where = {0.0, word->word, (uint32_t)(word->rest - word->word), 0};
    return swarf_gcode_fail(machine, &where, "%s", text);
}

/* Label and keyword of the O word at word->word. */
static swarf_status read_head(const swarf_machine *machine, swarf_flow_word *word)
{
    static const struct {
        const char *name;
        int kind;
    } keywords[] = {{"sub", SWARF_FLOW_SUB},
                    {"endsub", SWARF_FLOW_ENDSUB},
                    {"return", SWARF_FLOW_RETURN},
                    {"call", SWARF_FLOW_CALL},
                    {"if", SWARF_FLOW_IF},
                    {"elseif", SWARF_FLOW_ELSEIF},
                    {"else", SWARF_FLOW_ELSE},
                    {"endif", SWARF_FLOW_ENDIF},
                    {"while", SWARF_FLOW_WHILE},
                    {"endwhile", SWARF_FLOW_ENDWHILE},
                    {"do", SWARF_FLOW_DO},
                    {"repeat", SWARF_FLOW_REPEAT},
                    {"endrepeat", SWARF_FLOW_ENDREPEAT},
                    {"break", SWARF_FLOW_BREAK},
                    {"continue", SWARF_FLOW_CONTINUE}};
    const char *end = word->line_end, *at = swarf_skip_blanks(word->word + 1, end);
    char label[SWARF_PARAMETER_NAME_MAX + 1] = "";
    word->rest = at;
    if (at < end && *at == '<') {
        const char *open = ++at;
        while (at < end && *at != '>') at++;
        word->rest = at;
        if (at == end || !swarf_parameter_name(open, at, label))
            return fail_at(machine, word, "is no label; expected O and a number, or a name in < >");
        at++;
    } else if (at < end && *at >= '0' && *at <= '9') {
        while (at < end && *at == '0') at++;
        size_t used = 0;
        for (; at < end && *at >= '0' && *at <= '9' && used < 16; at++) label[used++] = *at;
        if (used == 0) label[used++] = '0';
        label[used] = 0;
    } else if (at < end && (*at == '[' || *at == '#')) {
        at = skip_value(at, end);
    } else {
        return fail_at(machine, word, "is no label; expected O and a number, or a name in < >");
    }
    at = swarf_skip_blanks(at, end);
    char keyword[16] = "";
    size_t length = 0;
    for (; at < end && is_letter(*at); at = swarf_skip_blanks(at + 1, end))
        if (length + 1 < sizeof keyword) keyword[length++] = lower(*at);
    keyword[length] = 0;
    word->rest = at;
    word->kind = length == 0 && machine->dialect->expressions ? SWARF_FLOW_PROGRAM : -1;
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords && machine->dialect->o_words; i++)
        if (strcmp(keyword, keywords[i].name) == 0) word->kind = keywords[i].kind;
    if (word->kind < 0)
        return fail_at(machine, word,
                       machine->dialect->o_words ? "is no O word; sub, call, if, while, do, repeat and their kin are"
                                                 : "is no O word of this dialect; only numbers of programs are");
    if (!label[0]) {
        if (word->kind != SWARF_FLOW_CALL) return fail_at(machine, word, "needs a label that is written out");
        return SWARF_OK;
    }
    const size_t size = strlen(label) + 1;
    word->label = malloc(size);
    if (!word->label) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    memcpy(word->label, label, size);
    return SWARF_OK;
}

/* Blocks that are open while a text is scanned: indices of their first words. */
typedef struct nest {
    int32_t open[NEST_MAX];
    int count;
} nest;

static const char *const begins[] = {
    [SWARF_FLOW_ENDSUB] = "sub", [SWARF_FLOW_ELSEIF] = "if",      [SWARF_FLOW_ELSE] = "if",
    [SWARF_FLOW_ENDIF] = "if",   [SWARF_FLOW_ENDWHILE] = "while", [SWARF_FLOW_ENDREPEAT] = "repeat",
    [SWARF_FLOW_DO_WHILE] = "do"};

static int begin_kind(int kind)
{
    switch (kind) {
    case SWARF_FLOW_ENDSUB: return SWARF_FLOW_SUB;
    case SWARF_FLOW_ELSEIF:
    case SWARF_FLOW_ELSE:
    case SWARF_FLOW_ENDIF: return SWARF_FLOW_IF;
    case SWARF_FLOW_ENDWHILE: return SWARF_FLOW_WHILE;
    case SWARF_FLOW_ENDREPEAT: return SWARF_FLOW_REPEAT;
    default: return SWARF_FLOW_DO;
    }
}

static swarf_status open_block(swarf_machine *machine, swarf_source *source, nest *n, int32_t index)
{
    swarf_flow_word *word = &source->words[index];
    if (word->kind == SWARF_FLOW_SUB) {
        if (n->count) return fail_at(machine, word, "begins a subroutine inside another block; end that one first");
        for (int32_t i = 0; i < index; i++)
            if (source->words[i].kind == SWARF_FLOW_SUB && strcmp(source->words[i].label, word->label) == 0)
                return fail_at(machine, word, "is a subroutine that exists already; labels must differ");
    }
    if (n->count == NEST_MAX) return fail_at(machine, word, "is nested too deeply");
    word->begin = index;
    n->open[n->count++] = index;
    return SWARF_OK;
}

/* A word that continues or ends the innermost block. */
static swarf_status continue_block(swarf_machine *machine, swarf_source *source, nest *n, int32_t index, int ends)
{
    swarf_flow_word *word = &source->words[index];
    swarf_flow_word *first = n->count ? &source->words[n->open[n->count - 1]] : NULL;
    if (!first || first->kind != begin_kind(word->kind) || strcmp(first->label, word->label) != 0) {
        char text[200];
        if (first)
            snprintf(text, sizeof text, "has no %s: the block that is open here is o%.40s of line %u",
                     begins[word->kind], first->label, (unsigned)first->line);
        else
            snprintf(text, sizeof text, "has no %s of its label before it", begins[word->kind]);
        return fail_at(machine, word, text);
    }
    word->begin = n->open[n->count - 1];
    if (word->kind == SWARF_FLOW_ELSEIF || word->kind == SWARF_FLOW_ELSE || word->kind == SWARF_FLOW_ENDIF) {
        int32_t last = word->begin; /* the branch before this one */
        while (source->words[last].branch) last = source->words[last].branch;
        if (source->words[last].kind == SWARF_FLOW_ELSE && word->kind != SWARF_FLOW_ENDIF)
            return fail_at(machine, word, "comes after the else of its block");
        source->words[last].branch = index;
    }
    if (!ends) return SWARF_OK;
    n->count--;
    for (int32_t i = word->begin; i <= index; i++)
        if (source->words[i].begin == word->begin) source->words[i].end = index;
    return SWARF_OK;
}

/* break and continue: the loop around them of the same label. */
static swarf_status find_loop(swarf_machine *machine, swarf_source *source, const nest *n, int32_t index)
{
    swarf_flow_word *word = &source->words[index];
    for (int i = n->count - 1; i >= 0; i--) {
        const swarf_flow_word *first = &source->words[n->open[i]];
        const int loop =
            first->kind == SWARF_FLOW_WHILE || first->kind == SWARF_FLOW_DO || first->kind == SWARF_FLOW_REPEAT;
        if (loop && strcmp(first->label, word->label) == 0) {
            word->begin = n->open[i];
            return SWARF_OK;
        }
    }
    return fail_at(machine, word, "is in no loop of its label");
}

static swarf_status match(swarf_machine *machine, swarf_source *source, nest *n, int32_t index)
{
    swarf_flow_word *word = &source->words[index];
    switch (word->kind) {
    case SWARF_FLOW_SUB:
    case SWARF_FLOW_IF:
    case SWARF_FLOW_DO:
    case SWARF_FLOW_REPEAT: return open_block(machine, source, n, index);
    case SWARF_FLOW_WHILE: {
        const swarf_flow_word *first = n->count ? &source->words[n->open[n->count - 1]] : NULL;
        if (!first || first->kind != SWARF_FLOW_DO || strcmp(first->label, word->label) != 0)
            return open_block(machine, source, n, index);
        word->kind = SWARF_FLOW_DO_WHILE;
        return continue_block(machine, source, n, index, 1);
    }
    case SWARF_FLOW_ELSEIF:
    case SWARF_FLOW_ELSE: return continue_block(machine, source, n, index, 0);
    case SWARF_FLOW_ENDSUB:
    case SWARF_FLOW_ENDIF:
    case SWARF_FLOW_ENDWHILE:
    case SWARF_FLOW_ENDREPEAT: return continue_block(machine, source, n, index, 1);
    case SWARF_FLOW_BREAK:
    case SWARF_FLOW_CONTINUE: return find_loop(machine, source, n, index);
    default: return SWARF_OK;
    }
}

static swarf_status scan_line(swarf_machine *machine, swarf_source *source, nest *n, const char *text, const char *stop,
                              uint32_t line)
{
    const char *word = first_word(machine, text, stop);
    if (!word || lower(*word) != 'o') return SWARF_OK;
    if (source->count >= INT32_MAX) return swarf_fail(SWARF_ERROR_MEMORY, "too many O words");
    SWARF_TRY(swarf_array_reserve((void **)&source->words, &source->room, source->count + 1, sizeof *source->words));
    swarf_flow_word *entry = &source->words[source->count];
    memset(entry, 0, sizeof *entry);
    entry->line_text = machine->place.text = text;
    entry->word = word;
    entry->line_end = stop;
    entry->line = machine->place.line = line;
    const swarf_status status = read_head(machine, entry);
    source->count++;
    if (status != SWARF_OK) return status;
    return match(machine, source, n, (int32_t)source->count - 1);
}

swarf_status swarf_flow_scan(swarf_machine *machine, swarf_source *source)
{
    const swarf_place place = machine->place;
    const char *end = source->text + source->length;
    nest n;
    n.count = 0;
    uint32_t line = 0;
    int percents = 0;
    machine->place.name = source->name;
    source->scanned = 1;
    for (const char *at = source->text; at < end;) {
        const char *stop = swarf_line_end(at, end);
        line++;
        const char *first = swarf_skip_blanks(at, stop);
        if (first < stop && *first == '%' && (++percents == 2 || source->count)) break;
        SWARF_TRY(scan_line(machine, source, &n, at, stop, line));
        at = swarf_line_next(stop, end);
    }
    if (n.count) {
        const swarf_flow_word *open = &source->words[n.open[n.count - 1]];
        machine->place.text = open->line_text;
        machine->place.line = open->line;
        return fail_at(machine, open, "begins a block that is not ended");
    }
    /* breaks know their loops' ends only now */
    for (size_t i = 0; i < source->count; i++)
        if (source->words[i].kind == SWARF_FLOW_BREAK || source->words[i].kind == SWARF_FLOW_CONTINUE)
            source->words[i].end = source->words[source->words[i].begin].end;
    machine->place = place;
    return SWARF_OK;
}

const swarf_flow_word *swarf_flow_at(const swarf_source *source, const char *word)
{
    size_t lo = 0, hi = source->count;
    while (lo < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (source->words[middle].word < word)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo < source->count && source->words[lo].word == word ? &source->words[lo] : NULL;
}

const swarf_flow_word *swarf_flow_find(const swarf_source *source, swarf_flow_kind kind, const char *label)
{
    for (size_t i = 0; i < source->count; i++)
        if (source->words[i].kind == (int32_t)kind && strcmp(source->words[i].label, label) == 0)
            return &source->words[i];
    return NULL;
}
