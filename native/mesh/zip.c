/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* PKWARE APPNOTE 6.3.3 without ZIP64: local header, deflated data, ... , central directory, its end. Sizes and checksum
 * of an entry are put into its header afterwards. No times: the same content gives the same bytes. */
#include "mesh/zip.h"

#include "base/status.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { ENTRIES = 8, NAME = 64, BUFFER = 65536 };

/* 1980-01-01, the first day that ZIP knows. */
enum { NO_DATE = 0x21 };

typedef struct entry {
    char name[NAME];
    uint32_t offset, checksum, packed, plain;
} entry;

struct swarf_zip {
    FILE *stream;
    z_stream deflate;
    entry entries[ENTRIES];
    int count;
    int open;
    unsigned char buffer[BUFFER];
};

static unsigned char *put(unsigned char *at, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++) *at++ = (unsigned char)(value >> (8 * i));
    return at;
}

/* What the local header and the directory say alike: version, flags, method, time, date, checksum, sizes, name. */
static unsigned char *put_common(unsigned char *at, const entry *e)
{
    at = put(at, 20, 2);
    at = put(at, 0, 2);
    at = put(at, 8, 2);
    at = put(at, 0, 2);
    at = put(at, NO_DATE, 2);
    at = put(at, e->checksum, 4);
    at = put(at, e->packed, 4);
    at = put(at, e->plain, 4);
    at = put(at, (uint32_t)strlen(e->name), 2);
    return put(at, 0, 2);
}

static void write_header(swarf_zip *zip, const entry *e)
{
    unsigned char header[30];
    put_common(put(header, 0x04034b50, 4), e);
    fwrite(header, 1, sizeof header, zip->stream);
    fwrite(e->name, 1, strlen(e->name), zip->stream);
}

swarf_status swarf_zip_create(FILE *stream, swarf_zip **out)
{
    swarf_zip *zip = calloc(1, sizeof *zip);
    if (!zip) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    zip->stream = stream;
    /* raw deflate at zlib's fastest level: meshes as text shrink to a fourth at any level */
    if (deflateInit2(&zip->deflate, Z_BEST_SPEED, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
        free(zip);
        return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    }
    *out = zip;
    return SWARF_OK;
}

static swarf_status pump(swarf_zip *zip, int flush)
{
    entry *e = &zip->entries[zip->count - 1];
    int result;
    do {
        zip->deflate.next_out = zip->buffer;
        zip->deflate.avail_out = BUFFER;
        result = deflate(&zip->deflate, flush);
        const uint32_t got = BUFFER - zip->deflate.avail_out;
        if (e->packed > UINT32_MAX - got || e->offset + (uint64_t)e->packed + got > UINT32_MAX)
            return swarf_fail(SWARF_ERROR_ARGUMENT, "mesh: more than 4 GiB: write it as .stl, .ply or .glb");
        e->packed += got;
        fwrite(zip->buffer, 1, got, zip->stream);
    } while (zip->deflate.avail_out == 0 || (flush == Z_FINISH && result == Z_OK));
    return SWARF_OK;
}

static swarf_status end_entry(swarf_zip *zip)
{
    if (!zip->open) return SWARF_OK;
    zip->open = 0;
    SWARF_TRY(pump(zip, Z_FINISH));
    const entry *e = &zip->entries[zip->count - 1];
    const off_t end = ftello(zip->stream);
    if (end < 0 || fseeko(zip->stream, (off_t)e->offset, SEEK_SET) != 0)
        return swarf_fail(SWARF_ERROR_IO, "a ZIP archive cannot be written to a pipe");
    write_header(zip, e);
    return fseeko(zip->stream, end, SEEK_SET) == 0 ? SWARF_OK : swarf_fail(SWARF_ERROR_IO, "cannot seek in the file");
}

swarf_status swarf_zip_entry(swarf_zip *zip, const char *name)
{
    SWARF_TRY(end_entry(zip));
    SWARF_REQUIRE(zip->count < ENTRIES && strlen(name) < NAME, "zip: too many entries, or too long a name");
    const off_t offset = ftello(zip->stream);
    if (offset < 0) return swarf_fail(SWARF_ERROR_IO, "a ZIP archive cannot be written to a pipe");
    if ((uint64_t)offset > UINT32_MAX) return swarf_fail(SWARF_ERROR_ARGUMENT, "mesh: more than 4 GiB");
    entry *e = &zip->entries[zip->count++];
    memcpy(e->name, name, strlen(name) + 1);
    e->offset = (uint32_t)offset;
    e->checksum = (uint32_t)crc32(0, NULL, 0);
    zip->open = 1;
    deflateReset(&zip->deflate);
    write_header(zip, e);
    return SWARF_OK;
}

swarf_status swarf_zip_write(swarf_zip *zip, const void *data, size_t length)
{
    entry *e = &zip->entries[zip->count - 1];
    if (length > UINT32_MAX - e->plain)
        return swarf_fail(SWARF_ERROR_ARGUMENT, "mesh: more than 4 GiB: write it as .stl, .ply or .glb");
    e->plain += (uint32_t)length;
    e->checksum = (uint32_t)crc32(e->checksum, data, (uInt)length);
    zip->deflate.next_in = (z_const Bytef *)data;
    zip->deflate.avail_in = (uInt)length;
    return pump(zip, Z_NO_FLUSH);
}

swarf_status swarf_zip_finish(swarf_zip *zip)
{
    SWARF_TRY(end_entry(zip));
    const off_t begin = ftello(zip->stream);
    for (int i = 0; i < zip->count; i++) {
        unsigned char record[46];
        const entry *e = &zip->entries[i];
        unsigned char *at = put_common(put(put(record, 0x02014b50, 4), 20, 2), e);
        put(put(put(put(put(at, 0, 2), 0, 2), 0, 2), 0, 4), e->offset, 4);
        fwrite(record, 1, sizeof record, zip->stream);
        fwrite(e->name, 1, strlen(e->name), zip->stream);
    }
    const off_t end = ftello(zip->stream);
    if (begin < 0 || end < 0 || (uint64_t)end > UINT32_MAX)
        return swarf_fail(SWARF_ERROR_ARGUMENT, "mesh: more than 4 GiB: write it as .stl, .ply or .glb");
    unsigned char record[22];
    unsigned char *at = put(put(put(record, 0x06054b50, 4), 0, 2), 0, 2);
    at = put(put(at, (uint32_t)zip->count, 2), (uint32_t)zip->count, 2);
    put(put(put(at, (uint32_t)(end - begin), 4), (uint32_t)begin, 4), 0, 2);
    fwrite(record, 1, sizeof record, zip->stream);
    return SWARF_OK;
}

void swarf_zip_destroy(swarf_zip *zip)
{
    if (!zip) return;
    deflateEnd(&zip->deflate);
    free(zip);
}
