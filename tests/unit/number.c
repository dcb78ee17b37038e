/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Decimal numbers against strtod in the "C" locale, what is no number, and another locale. */
#include "base/number.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"

/* Characters read; -1 when there is no number. */
static int read_text(const char *text, double *out)
{
    const char *end = swarf_number_read(text, text + strlen(text), out);
    return end ? (int)(end - text) : -1;
}

static void check_against_strtod(void)
{
    test_random random = test_random_begin(7);
    for (int i = 0; i < 20000; i++) {
        char text[64];
        const double value = test_random_in(&random, -1, 1) * pow(10, floor(test_random_in(&random, -300, 300)));
        snprintf(text, sizeof text, i % 2 ? "%.*e" : "%.*g", (int)test_random_in(&random, 1, 22), value);
        double found = NAN;
        const double expected = strtod(text, NULL);
        if (!CHECK(read_text(text, &found) == (int)strlen(text)) ||
            !CHECK(fabs(found - expected) <= 4 * DBL_EPSILON * fabs(expected)))
            printf("    of %s\n", text);
    }
}

static void check_words(void)
{
    static const struct {
        const char *text;
        int length;
        double value;
    } cases[] = {
        {"0", 1, 0},
        {"-2.5", 4, -2.5},
        {"+.5", 3, 0.5},
        {"7.", 2, 7},
        {"1e3", 3, 1000},
        {"25E-2,", 5, 0.25},
        {"3em", 1, 3},
        {"3e+", 1, 3},
        {"1.2.3", 3, 1.2},
        {"1,5", 1, 1},
        {"0x10", 1, 0},
        {"4/5", 1, 4},
        {"0e99999999999", 13, 0},
        {"1e-99999999999", 14, 0},
        {"100000000000000000000000", 24, 1e23},
        {"0.00000000000000000000001", 25, 1e-23},
        {"", -1, 0},
        {"-", -1, 0},
        {".", -1, 0},
        {"e5", -1, 0},
        {" 1", -1, 0},
        {"inf", -1, 0},
        {"nan", -1, 0},
        {"1e309", -1, 0},
        {"-1e99999999999", -1, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double found = 42;
        const int length = read_text(cases[i].text, &found);
        const double expected = cases[i].length < 0 ? 42 : cases[i].value; /* untouched on failure */
        if (!CHECK(length == cases[i].length) || !CHECK_NEAR(found, expected, 4 * DBL_EPSILON * fabs(expected)))
            printf("    of '%s'\n", cases[i].text);
    }
    double found;
    const char *text = "12345";
    CHECK(swarf_number_read(text, text + 2, &found) == text + 2 && found == 12); /* not beyond the end */
}

int main(void)
{
    check_against_strtod();
    check_words();
    if (setlocale(LC_ALL, "de_DE.UTF-8") || setlocale(LC_ALL, "fr_FR.UTF-8")) /* decimal commas, where there are some */
        check_words();
    return test_end();
}
