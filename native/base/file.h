/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Files that are read whole, and files that appear whole or not at all. */
#ifndef SWARF_BASE_FILE_H
#define SWARF_BASE_FILE_H

#include "swarf/base.h"

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Read a whole file; *data is followed by a 0 byte and freed by the caller with free(). */
swarf_status swarf_file_read(const char *path, char **data, size_t *length);

/** A file being written beside its target and renamed over it when complete; into the target itself where that is a
 *  device or a pipe (`temporary` is NULL). */
typedef struct swarf_file_writer {
    FILE *stream;
    char *path;
    char *temporary;
} swarf_file_writer;

/** Open for writing; a symbolic link stays and the file it leads to is replaced. On success close with
 *  swarf_file_commit() or swarf_file_abandon(). */
swarf_status swarf_file_begin(const char *path, swarf_file_writer *writer);
/** Flush, sync errors, rename; on failure the target is as it was and the temporary is gone. */
swarf_status swarf_file_commit(swarf_file_writer *writer);
void swarf_file_abandon(swarf_file_writer *writer);

/** Last suffix of a path in lower case without the dot, "" if none; at most `size` bytes with the 0. */
void swarf_file_suffix(const char *path, char *out, size_t size);

#ifdef __cplusplus
}
#endif
#endif
