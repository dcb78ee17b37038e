/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "gcode/block.h"

#include "base/status.h"
#include "gcode/machine.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

/* Values beyond this are mistakes; also keeps every later product finite. */
static const double value_limit = 1e6;

/* A code may be off a whole number by this (LinuxCNC's manual, "Numbers": within 0.0001 of the code, here times 10). */
static const double code_within = 1e-3;

/* "'G1'" for messages: blanks kept, anything unprintable as '?', long words cut. */
static void quote(const swarf_word *word, char *out, size_t size)
{
    size_t used = 0;
    out[used++] = '\'';
    for (size_t i = 0; i < word->length && used + 2 < size; i++) {
        const char c = word->at[i];
        out[used++] = (char)(c >= ' ' && c <= '~' ? c : c == '\t' ? ' ' : '?');
    }
    out[used++] = '\'';
    out[used] = 0;
}

static uint32_t column_of(const swarf_place *place, const swarf_word *word)
{
    return word ? (uint32_t)(word->at - place->text) + 1 : 1;
}

enum { NOTE_SIZE = 480 };

/* The word, if there is one, and what there is to say of it. */
static void compose(const swarf_word *word, const char *format, va_list arguments, char out[NOTE_SIZE])
{
    char quoted[40] = "", text[400];
    if (word) quote(word, quoted, sizeof quoted);
    vsnprintf(text, sizeof text, format, arguments);
    snprintf(out, NOTE_SIZE, "%s%s%s", quoted, word ? " " : "", text);
}

swarf_status swarf_gcode_fail(const swarf_machine *machine, const swarf_word *word, const char *format, ...)
{
    const swarf_place *place = &machine->place;
    char note[NOTE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    compose(word, format, arguments, note);
    va_end(arguments);
    SWARF_TRY(
        swarf_notes_add(machine->notes, SWARF_NOTE_ERROR, place->name, place->line, column_of(place, word), note));
    return swarf_fail(SWARF_ERROR_FORMAT, "%s:%u:%u: error: %s", place->name, place->line, column_of(place, word),
                      note);
}

swarf_status swarf_gcode_warn(const swarf_machine *machine, const swarf_word *word, const char *format, ...)
{
    const swarf_place *place = &machine->place;
    char note[NOTE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    compose(word, format, arguments, note);
    va_end(arguments);
    return swarf_notes_add(machine->notes, SWARF_NOTE_WARNING, place->name, place->line, column_of(place, word), note);
}

static inline int blank(char c)
{
    return c == ' ' || c == '\t';
}

static inline int digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Up to 15 digits the result is correctly rounded (both the digits and the power of ten are exact doubles), beyond it
 * is off by at most one part in 2^52: the 19 leading digits are exact in a 64-bit integer. */
int swarf_plain_number_read(const char **cursor, const char *end, double *out, uint32_t *whole)
{
    static const double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const int last_power = (int)(sizeof powers / sizeof *powers) - 1;
    const char *at = *cursor, *after = at;
    uint64_t digits = 0;
    int significant = 0, any = 0, point = 0, negative = 0;
    long scale = 0;
    while (at < end && blank(*at)) at++;
    if (at < end && (*at == '+' || *at == '-')) negative = *at++ == '-';
    for (; at < end; at++) {
        const char c = *at;
        if (digit(c)) {
            any = 1;
            if (significant < 19) {
                digits = digits * 10 + (uint64_t)(c - '0');
                significant += digits != 0;
                scale -= point;
            } else {
                scale += !point;
            }
        } else if (c == '.' && !point) {
            point = 1;
        } else if (!blank(c)) {
            break;
        }
        if (!blank(c)) after = at + 1;
    }
    if (!any) return 0;
    double value = (double)digits;
    if (digits != 0) { /* zero keeps being zero however many zeros follow the point */
        if (scale > last_power)
            value = HUGE_VAL;
        else if (scale > 0)
            value *= powers[scale];
        for (; scale < -last_power; scale += last_power) value /= powers[last_power];
        if (scale < 0) value /= powers[-scale];
    }
    *out = negative ? -value : value;
    *whole = !point;
    *cursor = after;
    return 1;
}

static swarf_status add_code(const swarf_machine *machine, swarf_block *block, int is_g, swarf_word *word)
{
    const double scaled = is_g ? word->value * 10.0 : word->value;
    const double rounded = nearbyint(scaled);
    if (!(rounded >= 0.0 && rounded < 10000.0 && fabs(scaled - rounded) < code_within))
        return swarf_gcode_fail(machine, word, "is no code; G takes at most one decimal, M none");
    const char *reason = NULL;
    const swarf_group group = is_g ? swarf_code_g(machine->dialect, (int)rounded, &reason)
                                   : swarf_code_m(machine->dialect, (int)rounded, &reason);
    if (group == SWARF_GROUP_NONE)
        return swarf_gcode_fail(machine, word, "%s (dialect %s)", reason, machine->dialect->name);
    if (block->grouped >> group & 1u) {
        char other[40];
        quote(&block->groups[group], other, sizeof other);
        return swarf_gcode_fail(machine, word, "and %s are of one modal group; keep one in this line", other);
    }
    word->value = rounded;
    block->groups[group] = *word;
    block->grouped |= 1u << group;
    return SWARF_OK;
}

static swarf_status add_word(const swarf_machine *machine, swarf_block *block, char letter, swarf_word *word)
{
    if (letter == 'N') return SWARF_OK; /* a label; nothing jumps to it */
    if (!(fabs(word->value) <= value_limit))
        return swarf_gcode_fail(machine, word, "is out of range; at most %g is possible", value_limit);
    if (letter == 'G' || letter == 'M') return add_code(machine, block, letter == 'G', word);
    const int slot = swarf_letter_index(letter);
    if (block->given >> slot & 1u) return swarf_gcode_fail(machine, word, "is the second %c in this line", letter);
    block->letters[slot] = *word;
    block->given |= 1u << slot;
    return SWARF_OK;
}

/* A character no word begins with. */
static swarf_status fail_character(const swarf_machine *machine, const char *at)
{
    const swarf_word word = {0.0, at, 1, 0};
    switch (*at) {
    case '[':
    case ']':
    case '=':
    case '<': return swarf_gcode_fail(machine, &word, "stands alone; expressions belong to a word or a parameter");
    case ')': return swarf_gcode_fail(machine, &word, "closes no comment");
    case '%': return swarf_gcode_fail(machine, &word, "must stand alone in its line");
    case '@':
    case '^': return swarf_gcode_fail(machine, &word, "polar coordinates are not supported; write X and Y");
    default: break;
    }
    if (*at >= ' ' && *at <= '~') return swarf_gcode_fail(machine, &word, "begins no word; expected a letter");
    return swarf_gcode_fail(machine, &word, "is byte 0x%02x; this is not G-code text", (unsigned char)*at);
}

/* Skip blanks and comments; *cursor ends at a character of a word or at the end. */
static swarf_status skip(const swarf_machine *machine, swarf_block *block, const char **cursor)
{
    const char *at = *cursor, *end = block->end;
    for (;; at++) {
        while (at < end && blank(*at)) at++;
        if (at == end) break;
        if (*at == ';') {
            block->comment = at + 1;
            block->comment_end = at = end;
            break;
        }
        if (*at != '(') break;
        const swarf_word open = {0.0, at, 1, 0};
        block->comment = at + 1;
        for (at++; at < end && *at != ')'; at++)
            if (*at == '(') return swarf_gcode_fail(machine, &open, "comment holds another '('");
        if (at == end) return swarf_gcode_fail(machine, &open, "comment is not closed in this line");
        block->comment_end = at;
    }
    *cursor = at;
    return SWARF_OK;
}

/* "#5 = value" at *cursor. */
static swarf_status read_setting(const swarf_machine *machine, swarf_block *block, const char **cursor)
{
    const char *at = *cursor + 1, *end = block->end;
    swarf_word word = {0.0, *cursor, 1, 0};
    if (!machine->dialect->expressions)
        return swarf_gcode_fail(machine, &word, "parameters are not read in dialect %s", machine->dialect->name);
    if (block->setting_count == SWARF_SETTINGS_MAX)
        return swarf_gcode_fail(machine, &word, "is one assignment too many; %d fit in a line", SWARF_SETTINGS_MAX);
    swarf_setting *setting = &block->settings[block->setting_count];
    setting->index = 0;
    at = swarf_skip_blanks(at, end);
    if (at < end && *at == '<') {
        setting->name = ++at;
        while (at < end && *at != '>') at++;
        if (at == end) return swarf_gcode_fail(machine, &word, "parameter's name is not closed; expected '>'");
        setting->length = (uint32_t)(at - setting->name);
        at++;
    } else {
        double index = 0.0;
        SWARF_TRY(swarf_value_read(machine, &at, end, &index));
        word.length = (uint32_t)(at - word.at);
        const double nearest = nearbyint(index);
        if (!(fabs(index - nearest) <= 1e-4 && nearest >= 1.0 && nearest < SWARF_PARAMETERS))
            return swarf_gcode_fail(machine, &word, "is no parameter; #1 to #%d are", SWARF_PARAMETERS - 1);
        setting->index = (int32_t)nearest;
    }
    word.length = (uint32_t)(at - word.at);
    at = swarf_skip_blanks(at, end);
    if (at == end || *at != '=') return swarf_gcode_fail(machine, &word, "does nothing here; expected '=' after it");
    at++;
    SWARF_TRY(swarf_value_read(machine, &at, end, &setting->value));
    word.length = (uint32_t)(at - word.at);
    SWARF_TRY(swarf_machine_check_setting(machine, setting, &word));
    block->setting_count++;
    *cursor = at;
    return SWARF_OK;
}

static char upper(char c)
{
    return c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
}

/* Statements of Fanuc's macro language begin as words do, but say what O words say. */
static swarf_status refuse_statement(const swarf_machine *machine, const char *at, const char *end)
{
    static const char *const names[] = {"WHILE", "IF", "GOTO", "THEN", "END", "DO"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        uint32_t length = 0;
        while (names[i][length] && at + length < end && upper(at[length]) == names[i][length]) length++;
        if (names[i][length]) continue;
        const char after = at + length < end ? upper(at[length]) : ' ';
        if (after >= 'A' && after <= 'Z') continue; /* IFIX[...]: a value of I */
        const swarf_word word = {0.0, at, length, 0};
        return swarf_gcode_fail(machine, &word,
                                "is a statement of macros, which are not read; write O words (o100 while [...])");
    }
    return SWARF_OK;
}

static swarf_status read_words(swarf_machine *machine, swarf_block *block, const char *at)
{
    const char *end = block->end;
    int first = 1;
    while (at < end) {
        swarf_word word = {0.0, at, 1, 0};
        const char letter = upper(*at);
        if (letter == '#') {
            SWARF_TRY(read_setting(machine, block, &at));
        } else if (letter == 'O' && first) {
            block->flow = at;
            return SWARF_OK;
        } else {
            if ((letter < 'A' || letter > 'Z') && letter != '$') return fail_character(machine, at);
            if (letter == 'O')
                return swarf_gcode_fail(machine, &word, "must be the first word of its line: O words stand alone");
            at++;
            if (!swarf_plain_number_read(&at, end, &word.value, &word.whole)) {
                const char *value = swarf_skip_blanks(at, end);
                if (value == end || !(*value == '#' || *value == '[' || *value == '-' || *value == '+' ||
                                      (*value >= 'a' && *value <= 'z') || (*value >= 'A' && *value <= 'Z')))
                    return swarf_gcode_fail(machine, &word, "has no number; expected digits after it");
                SWARF_TRY(refuse_statement(machine, word.at, end));
                SWARF_TRY(swarf_value_read(machine, &value, end, &word.value));
                at = value;
            }
            word.length = (uint32_t)(at - word.at);
            SWARF_TRY(add_word(machine, block, letter, &word));
            first = first && letter == 'N';
        }
        if (at < end && !blank(*at) && *at != '(' && *at != ';') continue;
        SWARF_TRY(skip(machine, block, &at));
    }
    for (int i = 0; i < block->setting_count; i++) SWARF_TRY(swarf_machine_set(machine, &block->settings[i]));
    return SWARF_OK;
}

swarf_status swarf_block_read(swarf_machine *machine, const char *text, const char *end, swarf_block *block)
{
    block->text = machine->place.text = text;
    block->end = end;
    block->flow = block->comment = NULL;
    block->given = block->used = block->grouped = 0;
    block->percent = block->skipped = block->setting_count = 0;
    const char *at = text;
    SWARF_TRY(skip(machine, block, &at));
    if (at < end && *at == '/') {
        at++;
        if (machine->block_delete) {
            block->skipped = 1;
            return SWARF_OK;
        }
        SWARF_TRY(skip(machine, block, &at));
    } else if (at < end && *at == '%') {
        const char *percent = at++;
        SWARF_TRY(skip(machine, block, &at));
        if (at < end) return fail_character(machine, percent);
        block->percent = 1;
        return SWARF_OK;
    } else if (at < end && *at == '$' && machine->dialect->dollar_system) {
        const swarf_word word = {0.0, at, (uint32_t)(end - at), 0};
        block->skipped = 1;
        return swarf_gcode_warn(machine, &word, "is a command to the control; it is not simulated");
    }
    return read_words(machine, block, at);
}
