/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Failing with a text, inside the library. */
#ifndef SWARF_BASE_STATUS_H
#define SWARF_BASE_STATUS_H

#include "swarf/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Of a text with its end: two paths and a sentence. Longer ones are cut, never overrun. */
enum { SWARF_ERROR_SIZE = 1024 };

/** Keep a text for swarf_error_last() and return `status`: `return swarf_fail(SWARF_ERROR_IO, "...")`. */
swarf_status swarf_fail(swarf_status status, const char *format, ...) SWARF_PRINTF(2, 3);

/** The same with "prefix: " before the text of the failure that is already kept. */
swarf_status swarf_fail_within(swarf_status status, const char *format, ...) SWARF_PRINTF(2, 3);

/* Compilers and analyzers see one file at a time: told that the status comes back as it went in, they do not follow
 * the path on which a failure is no failure, and their warnings about it go away. */
#define swarf_fail(status, ...) (swarf_fail((status), __VA_ARGS__), (status))
#define swarf_fail_within(status, ...) (swarf_fail_within((status), __VA_ARGS__), (status))

/** Leave the calling function with the status of `call` when it failed. */
#define SWARF_TRY(call)                                                                                                \
    do {                                                                                                               \
        swarf_status try_status_ = (call);                                                                             \
        if (try_status_ != SWARF_OK) return try_status_;                                                               \
    } while (0)

/** Leave the calling function when an argument is wrong. */
#define SWARF_REQUIRE(condition, ...)                                                                                  \
    do {                                                                                                               \
        if (!(condition)) return swarf_fail(SWARF_ERROR_ARGUMENT, __VA_ARGS__);                                        \
    } while (0)

#ifdef __cplusplus
}
#endif
#endif
