/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The file, little-endian: magic (8 bytes), version, library major and minor (4 each), has-offsets (1), id (36 letters),
 * metadata, grid count (4); per grid its name, type and parent's name (strings), where it, its values and its end lie
 * (8 each), compression (4), metadata, the map's name, and then the transform and the tree, which hold no lengths that
 * are filled before they are read. Metadata: count (4), each a name and a type (strings) and a value. Strings and
 * values: length (4), bytes. Source: openvdb/io/Archive.cc and GridDescriptor.cc, format 222 to 224. */
#include "stock/vdb_scan.h"

#include "base/status.h"

typedef struct scan {
    FILE *file;
    uint64_t size;
    const char *path;
} scan;

/* The format where all of this came to be as above. */
static const uint64_t first_version = 222;

static swarf_status read_number(const scan *s, size_t bytes, const char *what, uint64_t *out)
{
    unsigned char raw[8];
    if (fread(raw, 1, bytes, s->file) != bytes)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: cut short in its header (%s)", s->path, what);
    *out = 0;
    for (size_t i = 0; i < bytes; i++) *out |= (uint64_t)raw[i] << (8 * i);
    return SWARF_OK;
}

static swarf_status skip(const scan *s, uint64_t bytes, const char *what)
{
    const off_t here = ftello(s->file);
    if (here < 0 || (uint64_t)here > s->size || bytes > s->size - (uint64_t)here)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: cut short or damaged: %s of %llu bytes at %lld in a file of %llu", s->path,
                          what, (unsigned long long)bytes, (long long)here, (unsigned long long)s->size);
    if (fseeko(s->file, (off_t)bytes, SEEK_CUR) != 0)
        return swarf_fail(SWARF_ERROR_IO, "%s: cannot read", s->path);
    return SWARF_OK;
}

static swarf_status skip_string(const scan *s, const char *what)
{
    uint64_t length;
    SWARF_TRY(read_number(s, 4, what, &length));
    return skip(s, length, what);
}

static swarf_status skip_metadata(const scan *s)
{
    uint64_t count;
    SWARF_TRY(read_number(s, 4, "number of metadata", &count));
    for (uint64_t i = 0; i < count; i++) {
        SWARF_TRY(skip_string(s, "metadata name"));
        SWARF_TRY(skip_string(s, "metadata type"));
        SWARF_TRY(skip_string(s, "metadata value"));
    }
    return SWARF_OK;
}

/* Up to the next grid; *end is 0 where the file does not say where that is. */
static swarf_status scan_grid(const scan *s, uint64_t *end)
{
    uint64_t unused;
    SWARF_TRY(skip_string(s, "grid name"));
    SWARF_TRY(skip_string(s, "grid type"));
    SWARF_TRY(skip_string(s, "parent's name"));
    SWARF_TRY(read_number(s, 8, "grid position", &unused));
    SWARF_TRY(read_number(s, 8, "values position", &unused));
    SWARF_TRY(read_number(s, 8, "end position", end));
    SWARF_TRY(skip(s, 4, "compression"));
    SWARF_TRY(skip_metadata(s));
    return skip_string(s, "map type");
}

static swarf_status scan_file(const scan *s)
{
    uint64_t magic, version, grids;
    SWARF_TRY(read_number(s, 8, "magic number", &magic));
    if (magic != 0x56444220) return swarf_fail(SWARF_ERROR_FORMAT, "%s: not a .vdb file", s->path);
    SWARF_TRY(read_number(s, 4, "version", &version));
    if (version < first_version)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: format %llu is not read, %llu (2012) or later is; save it anew", s->path,
                          (unsigned long long)version, (unsigned long long)first_version);
    SWARF_TRY(skip(s, 8 + 1 + 36, "header"));
    SWARF_TRY(skip_metadata(s));
    SWARF_TRY(read_number(s, 4, "number of grids", &grids));
    if (grids > s->size) return swarf_fail(SWARF_ERROR_FORMAT, "%s: damaged: it claims %llu grids", s->path, (unsigned long long)grids);
    for (uint64_t i = 0; i < grids; i++) {
        uint64_t end = 0;
        SWARF_TRY(scan_grid(s, &end));
        if (end == 0) return SWARF_OK; /* a stream without offsets: only its first grid can be looked at */
        const off_t here = ftello(s->file);
        if (here < 0 || end < (uint64_t)here || end > s->size)
            return swarf_fail(SWARF_ERROR_FORMAT, "%s: cut short or damaged: grid %llu ends at byte %llu of %llu", s->path,
                              (unsigned long long)i + 1, (unsigned long long)end, (unsigned long long)s->size);
        SWARF_TRY(skip(s, end - (uint64_t)here, "grid"));
    }
    return SWARF_OK;
}

swarf_status swarf_vdb_scan(FILE *file, uint64_t size, const char *path)
{
    const scan s = {file, size, path};
    const swarf_status status = scan_file(&s);
    rewind(file);
    return status;
}
