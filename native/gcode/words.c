/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "gcode/words.h"

#include "base/status.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Values beyond this are mistakes; also keeps every later product finite. */
static const double value_limit = 1e6;

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

swarf_status swarf_gcode_fail(const swarf_place *place, const swarf_block *block, const swarf_word *word,
                              const char *format, ...)
{
    char quoted[40] = "", text[512];
    if (word) quote(word, quoted, sizeof quoted);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return swarf_fail(SWARF_ERROR_FORMAT, "%s:%u:%zu: error: %s%s%s", place->name, place->line,
                      word ? (size_t)(word->at - block->text) + 1 : (size_t)1, quoted, word ? " " : "", text);
}

static inline int blank(char c)
{
    return c == ' ' || c == '\t';
}

static inline int digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Read a number at *cursor; 0 if there is none. Up to 15 digits the result is correctly rounded (both the digits
 * and the power of ten are exact doubles), beyond it is off by at most one part in 2^52: the 19 leading digits are
 * exact in a 64-bit integer. */
static int read_number(const char **cursor, const char *end, double *out)
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
    *cursor = after;
    return 1;
}

/* Modal group of a G word (code times 10), or -1 with the reason why it is not supported. */
static int group_of_g(int code, const char **reason)
{
    switch (code) {
    case 40: return SWARF_GROUP_DWELL;
    case 0:
    case 10:
    case 20:
    case 30:
    case 730:
    case 810:
    case 820:
    case 830:
    case 850:
    case 890: return SWARF_GROUP_MOTION;
    case 800: return SWARF_GROUP_CANCEL;
    case 170:
    case 180:
    case 190: return SWARF_GROUP_PLANE;
    case 900:
    case 910: return SWARF_GROUP_DISTANCE;
    case 901:
    case 911: return SWARF_GROUP_ARC_CENTRE;
    case 940: return SWARF_GROUP_FEED_MODE;
    case 200:
    case 210: return SWARF_GROUP_UNITS;
    case 400: return SWARF_GROUP_RADIUS;
    case 430:
    case 490: return SWARF_GROUP_LENGTH;
    case 980:
    case 990: return SWARF_GROUP_RETRACT;
    case 540: return SWARF_GROUP_OFFSET;
    case 610:
    case 611:
    case 640: return SWARF_GROUP_PATH;
    case 50:
    case 51: *reason = "splines are not supported; post with lines and arcs"; break;
    case 100: *reason = "setting tool and offset tables is not supported"; break;
    case 280:
    case 281:
    case 300:
    case 301: *reason = "reference positions are not known here; write the retract as a G0 move"; break;
    case 330:
    case 760:
    case 840:
    case 740: *reason = "threading and tapping are not supported; G81 or G85 cut the same hole"; break;
    case 382:
    case 383:
    case 384:
    case 385: *reason = "probing is not supported"; break;
    case 410:
    case 411:
    case 420:
    case 421: *reason = "cutter compensation is not supported; post the tool centre's path (G40)"; break;
    case 431:
    case 432: *reason = "offsets are not supported; only G43 of the loaded tool and G49 are"; break;
    case 520:
    case 921:
    case 922:
    case 923:
    case 920: *reason = "shifting the origin is not supported; write coordinates of G54"; break;
    case 530: *reason = "machine coordinates are not known here; write coordinates of G54"; break;
    case 550:
    case 560:
    case 570:
    case 580:
    case 590:
    case 591:
    case 592:
    case 593: *reason = "only work offset G54 is supported; the others' places are not known here"; break;
    case 860:
    case 870:
    case 880: *reason = "this boring cycle is not supported; G85 and G89 are"; break;
    case 930:
    case 950: *reason = "only feed per minute (G94) is supported"; break;
    case 960:
    case 970: *reason = "constant surface speed is not supported; give rpm by S"; break;
    default:
        *reason = "is not supported; G0 to G4, G17 to G21, G40, G43, G49, G54, G61, G64, G73, G80 to G83, G85, "
                  "G89 to G91, G94, G98 and G99 are";
        break;
    }
    return -1;
}

static int group_of_m(int code)
{
    switch (code) {
    case 0:
    case 1:
    case 2:
    case 30: return SWARF_GROUP_STOP;
    case 3:
    case 4:
    case 5: return SWARF_GROUP_SPINDLE;
    case 6: return SWARF_GROUP_TOOL;
    case 7: return SWARF_GROUP_MIST;
    case 8: return SWARF_GROUP_FLOOD;
    case 9: return SWARF_GROUP_DRY;
    default: return -1;
    }
}

static swarf_status add_code(const swarf_place *place, swarf_block *block, int is_g, swarf_word *word)
{
    const double scaled = is_g ? word->value * 10.0 : word->value;
    const double rounded = nearbyint(scaled);
    if (!(rounded >= 0.0 && rounded < 10000.0 && fabs(scaled - rounded) < 1e-6))
        return swarf_gcode_fail(place, block, word, "is no code; G takes at most one decimal, M none");
    const char *reason = "is not supported; M0 to M9 and M30 are";
    const int group = is_g ? group_of_g((int)rounded, &reason) : group_of_m((int)rounded);
    if (group < 0) return swarf_gcode_fail(place, block, word, "%s", reason);
    if (block->grouped >> group & 1u) {
        char other[40];
        quote(&block->groups[group], other, sizeof other);
        return swarf_gcode_fail(place, block, word, "and %s are of one modal group; keep one in this line", other);
    }
    word->value = rounded;
    block->groups[group] = *word;
    block->grouped |= 1u << group;
    return SWARF_OK;
}

static const char *letter_reason(char letter)
{
    switch (letter) {
    case 'A':
    case 'B':
    case 'C': return "rotary axes are not supported";
    case 'U':
    case 'V':
    case 'W': return "secondary axes are not supported";
    case 'D': return "cutter compensation is not supported";
    case 'E': return "is no word, and numbers take no exponent; write the number out";
    case 'O': return "program numbers and subroutines are not supported";
    default: return NULL;
    }
}

static swarf_status add_word(const swarf_place *place, swarf_block *block, char letter, swarf_word *word)
{
    if (letter == 'N') return SWARF_OK; /* a label; nothing jumps to it */
    if (!(fabs(word->value) <= value_limit))
        return swarf_gcode_fail(place, block, word, "is out of range; at most %g is possible", value_limit);
    if (letter == 'G' || letter == 'M') return add_code(place, block, letter == 'G', word);
    const uint32_t bit = SWARF_LETTER(letter);
    if (block->given & bit) return swarf_gcode_fail(place, block, word, "is the second %c in this line", letter);
    block->letters[letter - 'A'] = *word;
    block->given |= bit;
    return SWARF_OK;
}

/* A character no word begins with. */
static swarf_status fail_character(const swarf_place *place, const swarf_block *block, const char *at)
{
    const swarf_word word = {0.0, at, 1};
    switch (*at) {
    case '#':
    case '[':
    case ']':
    case '=':
    case '<': return swarf_gcode_fail(place, block, &word, "parameters and expressions are not supported");
    case ')': return swarf_gcode_fail(place, block, &word, "closes no comment");
    case '%': return swarf_gcode_fail(place, block, &word, "must stand alone in its line");
    default: break;
    }
    if (*at >= ' ' && *at <= '~') return swarf_gcode_fail(place, block, &word, "begins no word; expected a letter");
    return swarf_gcode_fail(place, block, &word, "is byte 0x%02x; this is not G-code text", (unsigned char)*at);
}

/* Skip blanks and comments; *cursor ends at a character of a word or at the end. */
static swarf_status skip(const swarf_place *place, const swarf_block *block, const char **cursor)
{
    const char *at = *cursor, *end = block->end;
    for (;; at++) {
        while (at < end && blank(*at)) at++;
        if (at == end || *at == ';') {
            at = end;
            break;
        }
        if (*at != '(') break;
        const swarf_word open = {0.0, at, 1};
        for (at++; at < end && *at != ')'; at++)
            if (*at == '(') return swarf_gcode_fail(place, block, &open, "comment holds another '('");
        if (at == end) return swarf_gcode_fail(place, block, &open, "comment is not closed in this line");
    }
    *cursor = at;
    return SWARF_OK;
}

swarf_status swarf_block_read(const swarf_place *place, const char *text, const char *end, swarf_block *block)
{
    block->text = text;
    block->end = end;
    block->given = block->used = block->grouped = 0;
    block->percent = 0;
    const char *at = text;
    SWARF_TRY(skip(place, block, &at));
    if (at < end && *at == '/') { /* block delete: the switch is off, the line counts */
        at++;
        SWARF_TRY(skip(place, block, &at));
    } else if (at < end && *at == '%') {
        const char *percent = at++;
        SWARF_TRY(skip(place, block, &at));
        if (at < end) return fail_character(place, block, percent);
        block->percent = 1;
        return SWARF_OK;
    }
    while (at < end) {
        swarf_word word = {0.0, at, 1};
        char letter = *at;
        if (letter >= 'a' && letter <= 'z') letter = (char)(letter - 'a' + 'A');
        if (letter < 'A' || letter > 'Z') return fail_character(place, block, at);
        at++;
        const int number = read_number(&at, end, &word.value);
        if (number) word.length = (size_t)(at - word.at);
        const char *reason = letter_reason(letter);
        if (reason) return swarf_gcode_fail(place, block, &word, "%s", reason);
        if (!number) return swarf_gcode_fail(place, block, &word, "has no number; expected digits after it");
        SWARF_TRY(add_word(place, block, letter, &word));
        SWARF_TRY(skip(place, block, &at));
    }
    return SWARF_OK;
}
