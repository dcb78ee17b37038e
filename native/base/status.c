/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static _Thread_local char text[SWARF_ERROR_SIZE];

/* Names in brackets: the header's macros of these names are not meant here. */
swarf_status(swarf_fail)(swarf_status status, const char *format, ...)
{
    char fresh[SWARF_ERROR_SIZE]; /* the arguments may point into the old text */
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(fresh, sizeof fresh, format, arguments);
    va_end(arguments);
    memcpy(text, fresh, sizeof text);
    return status;
}

swarf_status(swarf_fail_within)(swarf_status status, const char *format, ...)
{
    char prefix[SWARF_ERROR_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(prefix, sizeof prefix, format, arguments);
    va_end(arguments);
    return swarf_fail(status, "%s: %s", prefix, text);
}

const char *swarf_error_last(void)
{
    return text;
}

const char *swarf_status_name(swarf_status status)
{
    switch (status) {
    case SWARF_OK: return "ok";
    case SWARF_ERROR_ARGUMENT: return "argument";
    case SWARF_ERROR_MEMORY: return "memory";
    case SWARF_ERROR_IO: return "io";
    case SWARF_ERROR_FORMAT: return "format";
    case SWARF_ERROR_GEOMETRY: return "geometry";
    case SWARF_ERROR_CANCELLED: return "cancelled";
    case SWARF_ERROR_BUSY: return "busy";
    case SWARF_ERROR_INTERNAL: return "internal";
    }
    return "unknown";
}

#define QUOTE_(x) #x
#define QUOTE(x) QUOTE_(x)
const char *swarf_version(void)
{
    return QUOTE(SWARF_VERSION_MAJOR) "." QUOTE(SWARF_VERSION_MINOR) "." QUOTE(SWARF_VERSION_PATCH);
}
