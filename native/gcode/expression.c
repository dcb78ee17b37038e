/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Expressions: [ ... ] with LinuxCNC's operators and functions, computed while they are read.
 *
 * Precedence, highest first, each level from the left: **; * / MOD; + -; EQ NE GT GE LT LE; AND OR XOR. Angles are
 * degrees. Equality is to 1e-6, truth is other than 0.
 */
#include "base/status.h"
#include "gcode/machine.h"

#include <math.h>
#include <string.h>

/* Nesting beyond this is no program; it bounds the C stack. */
enum { DEPTH_MAX = 64 };

/* LinuxCNC's: values nearer than this are equal. */
static const double equal_within = 1e-6;

/* An index may be off a whole number by this (LinuxCNC's manual, "Numbers"). */
static const double whole_within = 1e-4;

static const double degree = 0.017453292519943295769;

typedef struct reader {
    const swarf_machine *machine;
    const char *at, *end;
    int depth;
} reader;

static swarf_status read_value(reader *r, double *out);
static swarf_status read_expression(reader *r, double *out);

static int next_is(reader *r, char c)
{
    r->at = swarf_skip_blanks(r->at, r->end);
    return r->at < r->end && *r->at == c;
}

static char upper(char c)
{
    return (char)(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
}

/* Fail at the text from `from` to where reading has come. */
static swarf_status fail_from(const reader *r, const char *from, const char *text)
{
    const swarf_word word = {0.0, from, (uint32_t)(r->at > from ? r->at - from : from < r->end), 0};
    return swarf_gcode_fail(r->machine, &word, "%s", text);
}

/* Read a word of letters if it is `word` (upper case), blanks allowed between the letters. */
static int read_letters(reader *r, const char *word)
{
    const char *at = swarf_skip_blanks(r->at, r->end);
    for (; *word; word++) {
        if (at == r->end || upper(*at) != *word) return 0;
        at = swarf_skip_blanks(at + 1, r->end);
    }
    r->at = at;
    return 1;
}

typedef enum operation {
    NONE,
    POWER,
    TIMES,
    OVER,
    MODULO,
    PLUS,
    MINUS,
    EQUAL,
    UNEQUAL,
    GREATER,
    NOT_LESS,
    LESS,
    NOT_GREATER,
    AND,
    OR,
    XOR
} operation;

static int level_of(operation what)
{
    return what == POWER ? 5 : what <= MODULO ? 4 : what <= MINUS ? 3 : what <= NOT_GREATER ? 2 : 1;
}

static operation read_operation(reader *r)
{
    static const struct {
        const char *name;
        operation what;
    } words[] = {{"**", POWER}, {"*", TIMES},        {"/", OVER},     {"MOD", MODULO}, {"+", PLUS},
                 {"-", MINUS},  {"EQ", EQUAL},       {"NE", UNEQUAL}, {"GT", GREATER}, {"GE", NOT_LESS},
                 {"LT", LESS},  {"LE", NOT_GREATER}, {"AND", AND},    {"OR", OR},      {"XOR", XOR}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (read_letters(r, words[i].name)) return words[i].what;
    return NONE;
}

static const char *compute(operation what, double a, double b, double *out)
{
    switch (what) {
    case POWER:
        if (a < 0.0 && b != floor(b)) return "raises a negative number to a power that is not whole";
        if (a == 0.0 && b < 0.0) return "divides by zero";
        *out = pow(a, b);
        break;
    case TIMES: *out = a * b; break;
    case OVER:
        if (b == 0.0) return "divides by zero";
        *out = a / b;
        break;
    case MODULO:
        if (b == 0.0) return "divides by zero";
        *out = fmod(a, b);
        if (*out < 0.0) *out += fabs(b);
        break;
    case PLUS: *out = a + b; break;
    case MINUS: *out = a - b; break;
    case EQUAL: *out = fabs(a - b) < equal_within; break;
    case UNEQUAL: *out = fabs(a - b) >= equal_within; break;
    case GREATER: *out = a > b; break;
    case NOT_LESS: *out = a >= b; break;
    case LESS: *out = a < b; break;
    case NOT_GREATER: *out = a <= b; break;
    case AND: *out = a != 0.0 && b != 0.0; break;
    case OR: *out = a != 0.0 || b != 0.0; break;
    case XOR: *out = (a != 0.0) != (b != 0.0); break;
    case NONE: break;
    }
    return isfinite(*out) ? NULL : "is beyond what numbers can be";
}

/* Operands of at least `level`, each operation from the left. *what is the operation that follows, already read. */
static swarf_status read_level(reader *r, int level, const char *from, double *value, operation *what)
{
    while (*what != NONE && level_of(*what) >= level) {
        const operation now = *what;
        double right = 0.0, result = 0.0;
        SWARF_TRY(read_value(r, &right));
        *what = read_operation(r);
        if (*what != NONE && level_of(*what) > level_of(now))
            SWARF_TRY(read_level(r, level_of(now) + 1, from, &right, what));
        const char *wrong = compute(now, *value, right, &result);
        if (wrong) return fail_from(r, from, wrong);
        *value = result;
    }
    return SWARF_OK;
}

static swarf_status read_expression(reader *r, double *out)
{
    const char *from = r->at++;
    if (++r->depth > DEPTH_MAX) return fail_from(r, from, "is nested too deeply");
    double value = 0.0;
    SWARF_TRY(read_value(r, &value));
    operation what = read_operation(r);
    SWARF_TRY(read_level(r, 1, from, &value, &what));
    if (!next_is(r, ']')) return fail_from(r, from, "is not closed: expected an operator or ']'");
    r->at++;
    r->depth--;
    *out = value;
    return SWARF_OK;
}

/* "<name>" at r->at into `name`. */
static swarf_status read_name(reader *r, const char *from, char *name)
{
    const char *open = ++r->at;
    while (r->at < r->end && *r->at != '>') r->at++;
    if (r->at == r->end) return fail_from(r, from, "is not closed: expected '>' after the parameter's name");
    if (!swarf_parameter_name(open, r->at++, name)) return fail_from(r, from, "is no name of a parameter");
    return SWARF_OK;
}

static swarf_status read_parameter(reader *r, double *out)
{
    const char *from = r->at++;
    if (!r->machine->dialect->expressions) return fail_from(r, from, "parameters are not read in this dialect");
    if (next_is(r, '<')) {
        char name[SWARF_PARAMETER_NAME_MAX + 1];
        SWARF_TRY(read_name(r, from, name));
        const double *found = swarf_parameters_find(&r->machine->parameters, name);
        if (found) {
            *out = *found;
            return SWARF_OK;
        }
        if (!swarf_machine_predefined(r->machine, name, out))
            return fail_from(r, from, "is a parameter that has no value yet; assign one first");
        if (isnan(*out)) return fail_from(r, from, "is not known yet; command the axis first");
        return SWARF_OK;
    }
    double index = 0.0;
    if (++r->depth > DEPTH_MAX) return fail_from(r, from, "is nested too deeply");
    SWARF_TRY(read_value(r, &index));
    r->depth--;
    const double nearest = nearbyint(index);
    if (!(fabs(index - nearest) <= whole_within && nearest >= 1.0 && nearest < SWARF_PARAMETERS))
        return fail_from(r, from, "is no parameter; #1 to #5602 are");
    *out = swarf_machine_parameter(r->machine, (int)nearest);
    if (isnan(*out)) return fail_from(r, from, "is not known yet; command the axis first");
    return SWARF_OK;
}

static swarf_status read_atan(reader *r, const char *from, double *out)
{
    double y = 0.0, x = 0.0;
    SWARF_TRY(read_expression(r, &y));
    if (!next_is(r, '/')) return fail_from(r, from, "needs two arguments: ATAN[y]/[x]");
    r->at++;
    if (!next_is(r, '[')) return fail_from(r, from, "needs two arguments: ATAN[y]/[x]");
    SWARF_TRY(read_expression(r, &x));
    *out = atan2(y, x) / degree;
    return SWARF_OK;
}

static swarf_status read_exists(reader *r, const char *from, double *out)
{
    static const char wrong[] = "takes one named parameter: EXISTS[#<name>]";
    char name[SWARF_PARAMETER_NAME_MAX + 1];
    r->at++;
    if (!next_is(r, '#')) return fail_from(r, from, wrong);
    r->at++;
    double value = 0.0;
    if (!next_is(r, '<')) { /* a number exists when it can */
        SWARF_TRY(read_value(r, &value));
        if (!next_is(r, ']')) return fail_from(r, from, wrong);
        r->at++;
        *out = value >= 1.0 && value < SWARF_PARAMETERS;
        return SWARF_OK;
    }
    SWARF_TRY(read_name(r, from, name));
    if (!next_is(r, ']')) return fail_from(r, from, wrong);
    r->at++;
    *out = swarf_parameters_find(&r->machine->parameters, name) || swarf_machine_predefined(r->machine, name, &value);
    return SWARF_OK;
}

typedef enum function { ABS, ACOS, ASIN, COS, EXP, FIX, FUP, LN, ROUND, SIN, SQRT, TAN, FUNCTIONS } function;

static const char *apply(function what, double a, double *out)
{
    switch (what) {
    case ABS: *out = fabs(a); break;
    case ACOS:
    case ASIN:
        if (fabs(a) > 1.0) return "has an argument beyond -1 .. 1";
        *out = (what == ACOS ? acos(a) : asin(a)) / degree;
        break;
    case COS: *out = cos(a * degree); break;
    case EXP: *out = exp(a); break;
    case FIX: *out = floor(a); break;
    case FUP: *out = ceil(a); break;
    case LN:
        if (!(a > 0.0)) return "has an argument that is not positive";
        *out = log(a);
        break;
    case ROUND: *out = round(a); break;
    case SIN: *out = sin(a * degree); break;
    case SQRT:
        if (a < 0.0) return "has a negative argument";
        *out = sqrt(a);
        break;
    case TAN: *out = tan(a * degree); break;
    case FUNCTIONS: break;
    }
    return isfinite(*out) ? NULL : "is beyond what numbers can be";
}

static swarf_status read_function(reader *r, double *out)
{
    static const char *const names[FUNCTIONS] = {"ABS", "ACOS", "ASIN",  "COS", "EXP",  "FIX",
                                                 "FUP", "LN",   "ROUND", "SIN", "SQRT", "TAN"};
    const char *from = r->at;
    const int atan = read_letters(r, "ATAN"), exists = !atan && read_letters(r, "EXISTS");
    int what = 0;
    if (!atan && !exists)
        while (what < FUNCTIONS && !read_letters(r, names[what])) what++;
    if (what == FUNCTIONS) {
        r->at = from + 1;
        return fail_from(r, from, "is no value; expected a number, '#', '[' or a function");
    }
    if (!next_is(r, '[')) return fail_from(r, from, "needs its argument in brackets");
    if (atan) return read_atan(r, from, out);
    if (exists) return read_exists(r, from, out);
    double argument = 0.0;
    SWARF_TRY(read_expression(r, &argument));
    const char *wrong = apply((function)what, argument, out);
    return wrong ? fail_from(r, from, wrong) : SWARF_OK;
}

static swarf_status read_value(reader *r, double *out)
{
    r->at = swarf_skip_blanks(r->at, r->end);
    const char *from = r->at;
    uint32_t whole;
    if (swarf_plain_number_read(&r->at, r->end, out, &whole)) return SWARF_OK;
    if (r->at == r->end) return fail_from(r, from, "expected a value at the end of the line");
    if (*r->at == '-' || *r->at == '+') {
        const int minus = *r->at++ == '-';
        if (++r->depth > DEPTH_MAX) return fail_from(r, from, "is nested too deeply");
        SWARF_TRY(read_value(r, out));
        r->depth--;
        if (minus) *out = -*out;
        return SWARF_OK;
    }
    if (*r->at == '#') return read_parameter(r, out);
    if (!r->machine->dialect->expressions) return fail_from(r, from, "expressions are not read in this dialect");
    if (*r->at == '[') return read_expression(r, out);
    return read_function(r, out);
}

swarf_status swarf_value_read(const swarf_machine *machine, const char **cursor, const char *end, double *out)
{
    reader r = {machine, *cursor, end, 0};
    double value = 0.0;
    SWARF_TRY(read_value(&r, &value));
    *cursor = r.at;
    *out = value;
    return SWARF_OK;
}
