/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "mesh/text.h"

#include "base/number.h"
#include "base/status.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Lines end with LF, CR LF, or a CR alone as on old Macintoshes; the 0 byte after the text makes at[1] safe. */
static int is_blank(const char *at)
{
    return *at == ' ' || *at == '\t' || *at == '\v' || *at == '\f' || (*at == '\r' && at[1] == '\n');
}

static int is_line_end(const char *at)
{
    return *at == '\n' || (*at == '\r' && at[1] != '\n');
}

swarf_word swarf_text_word(swarf_text *text)
{
    while (text->at < text->end && is_blank(text->at)) text->at++;
    swarf_word word = {text->at, 0};
    while (text->at < text->end && !is_blank(text->at) && !is_line_end(text->at)) text->at++;
    word.length = (size_t)(text->at - word.at);
    return word;
}

int swarf_text_next_line(swarf_text *text)
{
    while (text->at < text->end && !is_line_end(text->at)) text->at++;
    if (text->at == text->end) return 0;
    text->at++;
    text->line++;
    return 1;
}

swarf_word swarf_text_word_anywhere(swarf_text *text)
{
    swarf_word word = swarf_text_word(text);
    while (word.length == 0 && swarf_text_next_line(text)) word = swarf_text_word(text);
    return word;
}

int swarf_word_is(swarf_word word, const char *wanted)
{
    return strlen(wanted) == word.length && memcmp(word.at, wanted, word.length) == 0;
}

int swarf_word_number(swarf_word word, double *out)
{
    double value;
    const char *end = swarf_number_read(word.at, word.at + word.length, &value);
    if (!end || end != word.at + word.length || fabs(value) > FLT_MAX) return 0;
    *out = value;
    return 1;
}

int swarf_word_integer(swarf_word word, int64_t *out)
{
    const char *p = word.at, *end = p + word.length;
    int negative = 0;
    int64_t value = 0;
    if (p < end && (*p == '-' || *p == '+')) negative = *p++ == '-';
    if (p == end) return 0;
    for (; p < end; p++) {
        if (*p < '0' || *p > '9' || value > (INT64_C(1) << 53) / 10) return 0;
        value = 10 * value + (*p - '0');
    }
    *out = negative ? -value : value;
    return 1;
}

swarf_status swarf_text_fail(const swarf_text *text, swarf_word word, const char *wanted)
{
    if (word.length == 0)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s:%zu: %s expected, but the %s ends", text->name, text->line, wanted,
                          text->at >= text->end ? "file" : "line");
    const int shown = word.length < 40 ? (int)word.length : 40;
    return swarf_fail(SWARF_ERROR_FORMAT, "%s:%zu: '%.*s': %s expected", text->name, text->line, shown, word.at,
                      wanted);
}

swarf_status swarf_text_locale_begin(locale_t *kept)
{
    const locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!plain) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    *kept = uselocale(plain);
    return SWARF_OK;
}

void swarf_text_locale_end(locale_t kept)
{
    freelocale(uselocale(kept));
}

swarf_status swarf_text_point(swarf_text *text, float out[3])
{
    float point[3];
    for (int k = 0; k < 3; k++) {
        const swarf_word word = swarf_text_word(text);
        double value;
        if (!swarf_word_number(word, &value)) return swarf_text_fail(text, word, "a coordinate");
        point[k] = (float)value;
    }
    memcpy(out, point, sizeof point);
    return SWARF_OK;
}
