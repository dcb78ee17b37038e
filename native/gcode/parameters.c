/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "gcode/parameters.h"

#include "gcode/machine.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* More names than this are a loop that makes them. */
enum { NAMES_MAX = 100000 };

swarf_status swarf_parameters_create(swarf_parameters *parameters)
{
    memset(parameters, 0, sizeof *parameters);
    parameters->numbered = calloc(SWARF_PARAMETERS, sizeof *parameters->numbered);
    if (!parameters->numbered) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    return SWARF_OK;
}

static void forget(swarf_named_list *names, size_t from)
{
    while (names->count > from) free(names->list[--names->count].name);
}

void swarf_parameters_destroy(swarf_parameters *parameters)
{
    forget(&parameters->globals, 0);
    forget(&parameters->locals, 0);
    free(parameters->globals.list);
    free(parameters->locals.list);
    free(parameters->numbered);
}

int swarf_parameter_name(const char *at, const char *end, char *out)
{
    size_t used = 0;
    for (; at < end; at++) {
        if (*at == ' ' || *at == '\t') continue;
        if (used == SWARF_PARAMETER_NAME_MAX) return 0;
        out[used++] = (char)(*at >= 'A' && *at <= 'Z' ? *at - 'A' + 'a' : *at);
    }
    out[used] = 0;
    return used > 0;
}

static uint32_t hash_of(const char *name)
{
    uint32_t hash = 2166136261u;
    for (; *name; name++) hash = (hash ^ (unsigned char)*name) * 16777619u;
    return hash;
}

static swarf_named *find(const swarf_named_list *names, size_t from, const char *name, uint32_t hash)
{
    for (size_t i = names->count; i > from; i--)
        if (names->list[i - 1].hash == hash && strcmp(names->list[i - 1].name, name) == 0) return &names->list[i - 1];
    return NULL;
}

const double *swarf_parameters_find(const swarf_parameters *parameters, const char *name)
{
    const int global = name[0] == '_';
    const swarf_named *found =
        find(global ? &parameters->globals : &parameters->locals, global ? 0 : parameters->base, name, hash_of(name));
    return found ? &found->value : NULL;
}

swarf_status swarf_parameters_set(swarf_parameters *parameters, const char *name, double value)
{
    const int global = name[0] == '_';
    swarf_named_list *names = global ? &parameters->globals : &parameters->locals;
    const uint32_t hash = hash_of(name);
    swarf_named *found = find(names, global ? 0 : parameters->base, name, hash);
    if (!found) {
        if (names->count >= NAMES_MAX) return swarf_fail(SWARF_ERROR_MEMORY, "more than %d names", NAMES_MAX);
        SWARF_TRY(swarf_array_reserve((void **)&names->list, &names->room, names->count + 1, sizeof *names->list));
        const size_t size = strlen(name) + 1;
        char *copy = malloc(size);
        if (!copy) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
        memcpy(copy, name, size);
        found = &names->list[names->count++];
        found->name = copy;
        found->hash = hash;
    }
    found->value = value;
    return SWARF_OK;
}

void swarf_parameters_leave(swarf_parameters *parameters, size_t base)
{
    forget(&parameters->locals, base);
}

static const char *skip_blanks(const char *at, const char *end)
{
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\r')) at++;
    return at;
}

/* Of the parameters that hold places - G28's, G30's, G92's and the work offsets - X Y Z and U V W are lengths; A B C
 * are angles, and the work offsets' tenth is their turn. */
static int is_length(int number)
{
    static const int sets[] = {5161, 5181, 5211};
    int axis = -1;
    for (size_t i = 0; i < sizeof sets / sizeof sets[0]; i++)
        if (number >= sets[i] && number < sets[i] + SWARF_AXES) axis = number - sets[i];
    if (number >= 5221 && number < 5221 + 20 * SWARF_SYSTEMS && (number - 5221) % 20 < SWARF_AXES)
        axis = (number - 5221) % 20;
    return axis >= 0 && (axis < 3 || axis > 5);
}

swarf_status swarf_parameters_read(swarf_parameters *parameters, const char *path, double unit_mm)
{
    SWARF_REQUIRE(unit_mm > 0.0 && unit_mm <= 1000.0, "parameters: a unit of %g mm", unit_mm);
    char *data;
    size_t length;
    SWARF_TRY(swarf_file_read(path, &data, &length));
    swarf_status status = SWARF_OK;
    int line = 0, last = 0, blank = 1;
    for (const char *at = data, *end = data + length; at < end && status == SWARF_OK;) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        if (!stop) stop = end;
        line++;
        double number = 0.0, value = 0.0;
        blank &= skip_blanks(at, stop) == stop;
        const char *next = swarf_number_read(skip_blanks(at, stop), stop, &number);
        next = next ? swarf_number_read(skip_blanks(next, stop), stop, &value) : NULL;
        if (next && skip_blanks(next, stop) == stop) {
            if (!(number >= 1.0 && number < SWARF_PARAMETERS && number == floor(number)))
                status = swarf_fail(SWARF_ERROR_FORMAT, "%s:%d:1: error: %g is no parameter; 1 to %d are", path, line,
                                    number, SWARF_PARAMETERS - 1);
            else if ((int)number <= last)
                status = swarf_fail(SWARF_ERROR_FORMAT, "%s:%d:1: error: parameter %d comes after %d; they must ascend",
                                    path, line, (int)number, last);
            else if (!(fabs(value) <= 1e9))
                status = swarf_fail(SWARF_ERROR_FORMAT, "%s:%d:1: error: %g is out of range", path, line, value);
            else
                parameters->numbered[last = (int)number] = is_length((int)number) ? value * unit_mm : value;
        }
        at = stop < end ? stop + 1 : end;
    }
    free(data);
    /* other lines are remarks, but a file of nothing else is another file */
    if (status == SWARF_OK && !last && !blank)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: no line of it is a parameter: its number, 1 to %d, and its value",
                          path, SWARF_PARAMETERS - 1);
    return status;
}
