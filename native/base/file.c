/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "base/file.h"

#include "base/memory.h"
#include "base/status.h"

#include <ctype.h>
#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

swarf_status swarf_file_read(const char *path, char **data, size_t *length)
{
    SWARF_REQUIRE(path && data && length, "file: path or output missing");
    FILE *file = fopen(path, "rb");
    if (!file) return swarf_fail(SWARF_ERROR_IO, "%s: cannot open: %s", path, strerror(errno));
    struct stat info;
    if (fstat(fileno(file), &info) == 0 && S_ISDIR(info.st_mode)) {
        fclose(file);
        return swarf_fail(SWARF_ERROR_IO, "%s: is a folder, not a file", path);
    }
    char *buffer = NULL;
    size_t room = 0, used = 0;
    swarf_status status = SWARF_OK;
    for (;;) {
        status = swarf_array_reserve((void **)&buffer, &room, used + 65537, 1);
        if (status != SWARF_OK) break;
        const size_t got = fread(buffer + used, 1, room - used - 1, file);
        used += got;
        if (got == 0) break;
    }
    if (status == SWARF_OK && ferror(file))
        status = swarf_fail(SWARF_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    fclose(file);
    if (status != SWARF_OK) {
        free(buffer);
        return status;
    }
    buffer[used] = 0;
    *data = buffer;
    *length = used;
    return SWARF_OK;
}

/* The file that a path leads to through symbolic links, whether it exists or not: renaming over a link would replace
 * the link. NULL with errno where there is no memory or the links go round. */
static char *follow_links(const char *path)
{
    char *at = strdup(path);
    for (int links = 0; at && links < 40; links++) { /* as many as Linux follows */
        char target[4096];
        const ssize_t length = readlink(at, target, sizeof target - 1);
        if (length <= 0 || (size_t)length == sizeof target - 1) return at;
        target[length] = 0;
        const char *slash = strrchr(at, '/');
        const size_t folder = target[0] == '/' || !slash ? 0 : (size_t)(slash - at) + 1;
        char *next = malloc(folder + (size_t)length + 1);
        if (next) {
            memcpy(next, at, folder);
            memcpy(next + folder, target, (size_t)length + 1);
        }
        free(at);
        at = next;
    }
    if (at) errno = ELOOP;
    free(at);
    return NULL;
}

/* Beside the target and for its owner and others as the system's mask says; what it is called is in `temporary`. */
static FILE *open_beside(char *temporary)
{
    const int descriptor = mkstemp(temporary);
    if (descriptor < 0) return NULL;
    const mode_t mask = umask(0);
    umask(mask);
    (void)fchmod(descriptor, 0666 & ~mask); /* mkstemp makes it private */
    FILE *stream = fdopen(descriptor, "wb");
    if (!stream) {
        close(descriptor);
        unlink(temporary);
    }
    return stream;
}

swarf_status swarf_file_begin(const char *path, swarf_file_writer *writer)
{
    SWARF_REQUIRE(path && *path && writer, "file: path missing");
    char *copy = follow_links(path);
    if (!copy)
        return errno == ELOOP ? swarf_fail(SWARF_ERROR_IO, "%s: cannot write: %s", path, strerror(errno))
                              : swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    struct stat info;
    const int exists = stat(copy, &info) == 0;
    if (exists && S_ISDIR(info.st_mode)) {
        free(copy);
        return swarf_fail(SWARF_ERROR_IO, "%s: is a folder, not a file", path);
    }
    char *temporary = NULL;
    if (!exists || S_ISREG(info.st_mode)) {         /* devices and pipes are written to, not replaced */
        static const char name[] = ".swarf-XXXXXX"; /* the target's own may be as long as the system takes */
        const char *slash = strrchr(copy, '/');
        const size_t folder = slash ? (size_t)(slash - copy) + 1 : 0;
        temporary = malloc(folder + sizeof name);
        if (!temporary) {
            free(copy);
            return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
        }
        memcpy(temporary, copy, folder);
        memcpy(temporary + folder, name, sizeof name);
    }
    FILE *stream = temporary ? open_beside(temporary) : fopen(copy, "wb");
    if (!stream) {
        const swarf_status status = swarf_fail(SWARF_ERROR_IO, "%s: cannot write: %s", path, strerror(errno));
        free(copy);
        free(temporary);
        return status;
    }
    writer->stream = stream;
    writer->path = copy;
    writer->temporary = temporary;
    return SWARF_OK;
}

static void forget(swarf_file_writer *writer)
{
    if (writer->temporary && writer->temporary[0]) unlink(writer->temporary);
    free(writer->path);
    free(writer->temporary);
    memset(writer, 0, sizeof *writer);
}

/* Why writing failed some time ago. Trying again tells: a byte where it is thrown away then, nothing at all to a
 * device; a pipe says whether anybody reads it. */
static const char *reason_of(const swarf_file_writer *writer)
{
    const int descriptor = fileno(writer->stream);
    int again;
    if (writer->temporary) {
        clearerr(writer->stream);
        again = fputc(0, writer->stream) == EOF || fflush(writer->stream) != 0;
    } else {
        again = write(descriptor, "", 0) < 0;
        struct pollfd state = {.fd = descriptor};
        if (!again && poll(&state, 1, 0) == 1 && state.revents & POLLERR) return strerror(EPIPE);
    }
    return again ? strerror(errno) : "it failed a moment ago";
}

swarf_status swarf_file_commit(swarf_file_writer *writer)
{
    swarf_status status = SWARF_OK;
    if (fflush(writer->stream) != 0)
        status = swarf_fail(SWARF_ERROR_IO, "%s: cannot write: %s", writer->path, strerror(errno));
    else if (ferror(writer->stream))
        status = swarf_fail(SWARF_ERROR_IO, "%s: cannot write: %s", writer->path, reason_of(writer));
    if (fclose(writer->stream) != 0 && status == SWARF_OK)
        status = swarf_fail(SWARF_ERROR_IO, "%s: cannot write: %s", writer->path, strerror(errno));
    if (status == SWARF_OK && writer->temporary) {
        if (rename(writer->temporary, writer->path) != 0)
            status = swarf_fail(SWARF_ERROR_IO, "%s: cannot replace: %s", writer->path, strerror(errno));
        else
            writer->temporary[0] = 0; /* gone */
    }
    forget(writer);
    return status;
}

void swarf_file_abandon(swarf_file_writer *writer)
{
    if (!writer->stream) return;
    fclose(writer->stream);
    forget(writer);
}

void swarf_file_suffix(const char *path, char *out, size_t size)
{
    const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
    size_t used = 0;
    if (dot && (!slash || dot > slash))
        for (dot++; *dot && used + 1 < size; dot++) out[used++] = (char)tolower((unsigned char)*dot);
    out[used] = 0;
}
