/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Parameters: the numbered ones, #1 to #5602, and the named ones, global and local to a call.
 *
 * Names are few (tens), so each list is searched from its end by a hash before the name. Locals of all calls lie in
 * one list; a call's begin at `base`.
 */
#ifndef SWARF_GCODE_PARAMETERS_H
#define SWARF_GCODE_PARAMETERS_H

#include "swarf/base.h"

enum { SWARF_PARAMETERS = 5603, SWARF_PARAMETER_NAME_MAX = 127, SWARF_PARAMETERS_LOCAL = 30 };

typedef struct swarf_named {
    char *name;
    uint32_t hash;
    double value;
} swarf_named;

typedef struct swarf_named_list {
    swarf_named *list;
    size_t count, room;
} swarf_named_list;

typedef struct swarf_parameters {
    double *numbered; /**< SWARF_PARAMETERS of them; 0 is not used */
    swarf_named_list globals, locals;
    size_t base;
} swarf_parameters;

swarf_status swarf_parameters_create(swarf_parameters *parameters);
void swarf_parameters_destroy(swarf_parameters *parameters);

/** Lower case without blanks into `out` (SWARF_PARAMETER_NAME_MAX + 1 bytes); 0 if there is nothing or too much. */
int swarf_parameter_name(const char *at, const char *end, char *out);
/** A named parameter of the current call, or global where the name begins with '_'; NULL if it does not exist. */
const double *swarf_parameters_find(const swarf_parameters *parameters, const char *name);
swarf_status swarf_parameters_set(swarf_parameters *parameters, const char *name, double value);
/** Forget the locals from `base` on. */
void swarf_parameters_leave(swarf_parameters *parameters, size_t base);

/** Read a LinuxCNC parameter file: two columns, number and value; lines of another form are left out. Places in it are
 *  in units of `unit_mm`, afterwards in mm. SWARF_ERROR_FORMAT: it has lines, but none with a parameter. */
swarf_status swarf_parameters_read(swarf_parameters *parameters, const char *path, double unit_mm);

#endif
