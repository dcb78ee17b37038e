/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The file, little-endian, strings as length (4) and bytes: magic (8), format, library major and minor (4 each),
 * has-positions (1), id (36 letters), metadata, grid count (4), grids. Metadata: count (4), each a name, a type and a
 * value (strings). A grid: name, type, parent's name (strings); where it, its leaves' values and its end lie (8 each);
 * compression (4), metadata, the map's name and its doubles, the tree.
 *
 * The tree, 5-4-3: buffer count (4, is 1), background (float), tile and child count (4 each); tiles: place (3 x 4),
 * float, active (1); children: place, node. A node of 32^3 or 16^3 slots: child mask, active mask, values; then its
 * children, of which leaves (8^3) are an active mask. Behind the last node, for all leaves in the same order: active
 * mask, values. Values: how inactive ones are kept (1), up to two of them (floats), a mask that chooses, the others
 * in a chunk: plain, or length (8) and body: packed, or -length and plain where packing did not help.
 *
 * The file passes once, through a window, in order. OpenVDB later reads only what lies from the transform to the end
 * of the tree, so that nothing it acts upon has not been looked at here.
 * Source: openvdb 10 io/Archive.cc, io/GridDescriptor.cc, io/Compression.h, tree/RootNode.h; c-blosc README_HEADER. */
#include "stock/vdb_scan.h"

#include "base/status.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum {
    FORMAT_FIRST = 222, /* where all of this came to be as above (2012) */
    FORMAT_LAST = 225,
    UPPER_SLOTS = 32 * 32 * 32,
    LOWER_SLOTS = 16 * 16 * 16,
    LEAF_SLOTS = 8 * 8 * 8,
    PLACE_BITS = 12, /* a root slot is 4096 voxels wide */
    BLOSC_HEADER = 16,
    WINDOW = 1 << 18, /* holds the largest thing looked at whole: a packed chunk of UPPER_SLOTS floats */
    TEXT_MAX = 256
};

typedef struct reader {
    FILE *file;
    const char *path;
    uint64_t size, at;   /* bytes of the file; the next one */
    uint64_t from, held; /* what the window holds */
    unsigned char window[WINDOW];
} reader;

/* Grid descriptor and metadata, as far as they matter. */
typedef struct description {
    char name[TEXT_MAX], type[TEXT_MAX], parent[TEXT_MAX], class[TEXT_MAX];
    uint64_t start, values, end; /* 0 in files without positions */
    uint32_t compression;
    int half;
} description;

/* printf arguments: what was expected and found at byte `at`. */
static SWARF_PRINTF(3, 4) swarf_status damaged(const reader *r, uint64_t at, const char *format, ...)
{
    char text[2 * TEXT_MAX];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return swarf_fail(SWARF_ERROR_FORMAT, "%s: damaged at byte %llu: %s", r->path, (unsigned long long)at, text);
}

static swarf_status skip(reader *r, uint64_t bytes, const char *what)
{
    if (bytes > r->size - r->at)
        return swarf_fail(SWARF_ERROR_FORMAT,
                          "%s: cut short or damaged: expected %llu bytes of %s at byte %llu of %llu", r->path,
                          (unsigned long long)bytes, what, (unsigned long long)r->at, (unsigned long long)r->size);
    r->at += bytes;
    return SWARF_OK;
}

/* The next bytes, WINDOW at most, good until the next call. */
static swarf_status look(reader *r, uint64_t bytes, const char *what, const unsigned char **out)
{
    const uint64_t at = r->at;
    SWARF_TRY(skip(r, bytes, what));
    if (at < r->from || at + bytes > r->from + r->held) {
        const uint64_t rest = r->size - at;
        r->from = at;
        r->held = rest < WINDOW ? rest : WINDOW;
        if (fseeko(r->file, (off_t)at, SEEK_SET) != 0 || fread(r->window, 1, r->held, r->file) != r->held)
            return swarf_fail(SWARF_ERROR_IO, "%s: cannot read", r->path);
    }
    *out = r->window + (at - r->from);
    return SWARF_OK;
}

static swarf_status take(reader *r, uint64_t bytes, const char *what, uint64_t *out)
{
    const unsigned char *raw;
    SWARF_TRY(look(r, bytes, what, &raw));
    *out = 0;
    for (uint64_t i = 0; i < bytes; i++) *out |= (uint64_t)raw[i] << (8 * i);
    return SWARF_OK;
}

static swarf_status take_float(reader *r, const char *what)
{
    const unsigned char *raw;
    float value;
    SWARF_TRY(look(r, sizeof value, what, &raw));
    memcpy(&value, raw, sizeof value);
    return isfinite(value) ? SWARF_OK : damaged(r, r->at - 4, "expected a finite %s, found %g", what, (double)value);
}

/* A string; its beginning goes to out[TEXT_MAX]. */
static swarf_status take_text(reader *r, const char *what, char *out)
{
    uint64_t length;
    SWARF_TRY(take(r, 4, what, &length));
    const uint64_t kept = length < TEXT_MAX ? length : TEXT_MAX - 1;
    const unsigned char *text;
    SWARF_TRY(look(r, kept, what, &text));
    memcpy(out, text, kept);
    out[kept] = 0;
    return skip(r, length - kept, what);
}

/* `d` may be NULL. */
static swarf_status walk_metadata(reader *r, description *d)
{
    uint64_t count;
    SWARF_TRY(take(r, 4, "number of metadata", &count));
    for (uint64_t i = 0; i < count; i++) {
        char name[TEXT_MAX], type[TEXT_MAX], value[TEXT_MAX];
        SWARF_TRY(take_text(r, "metadata name", name));
        SWARF_TRY(take_text(r, "metadata type", type));
        SWARF_TRY(take_text(r, "metadata value", value));
        if (d && strcmp(name, "class") == 0 && strcmp(type, "string") == 0) strcpy(d->class, value);
        if (d && strcmp(name, "is_saved_as_half_float") == 0 && strcmp(type, "bool") == 0) d->half = value[0] != 0;
    }
    return SWARF_OK;
}

/* Leaves the reader at the grid's transform. */
static swarf_status walk_description(reader *r, int positions, description *d)
{
    uint64_t compression;
    const uint64_t from = r->at;
    *d = (description){.class = "unknown"};
    SWARF_TRY(take_text(r, "grid name", d->name));
    SWARF_TRY(take_text(r, "grid type", d->type));
    SWARF_TRY(take_text(r, "parent's name", d->parent));
    SWARF_TRY(take(r, 8, "grid position", &d->start));
    SWARF_TRY(take(r, 8, "values position", &d->values));
    SWARF_TRY(take(r, 8, "end position", &d->end));
    if (!positions) d->start = d->values = d->end = 0;
    if (positions && d->start != r->at)
        return damaged(r, r->at - 24, "expected the grid's position, %llu, found %llu", (unsigned long long)r->at,
                       (unsigned long long)d->start);
    if (positions && (d->end <= r->at || d->end > r->size))
        return damaged(r, r->at - 8, "the grid from byte %llu on ends at byte %llu of %llu", (unsigned long long)from,
                       (unsigned long long)d->end, (unsigned long long)r->size);
    SWARF_TRY(take(r, 4, "compression", &compression));
    if (compression > (SWARF_VDB_ZIP | SWARF_VDB_ACTIVE_MASK | SWARF_VDB_BLOSC))
        return damaged(r, r->at - 4, "expected a compression of 0 to 7, found %llu", (unsigned long long)compression);
    d->compression = (uint32_t)compression;
    return walk_metadata(r, d);
}

static swarf_status walk_transform(reader *r)
{
    static const struct {
        const char *name;
        int numbers;
    } maps[] = {
        {"UniformScaleMap", 15},   {"ScaleMap", 15},      {"UniformScaleTranslateMap", 18},
        {"ScaleTranslateMap", 18}, {"TranslationMap", 3}, {"AffineMap", 16},
        {"UnitaryMap", 16},
    };
    char name[TEXT_MAX];
    const uint64_t from = r->at;
    SWARF_TRY(take_text(r, "map type", name));
    if (strcmp(name, "NonlinearFrustumMap") == 0)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: its grid is not linear (a frustum); a stock has uniform voxels",
                          r->path);
    size_t kind = 0;
    while (kind < sizeof maps / sizeof *maps && strcmp(name, maps[kind].name) != 0) kind++;
    if (kind == sizeof maps / sizeof *maps) return damaged(r, from, "expected a type of map, found '%s'", name);
    for (int i = 0; i < maps[kind].numbers; i++) {
        const unsigned char *raw;
        double number;
        SWARF_TRY(look(r, sizeof number, "map", &raw));
        memcpy(&number, raw, sizeof number);
        if (!isfinite(number)) return damaged(r, r->at - 8, "expected a finite number of the map, found %g", number);
    }
    return SWARF_OK;
}

static unsigned count_bits(const unsigned char *mask, size_t slots)
{
    unsigned count = 0;
    for (size_t i = 0; i < slots / 64; i++) {
        uint64_t word;
        memcpy(&word, mask + 8 * i, sizeof word);
        count += (unsigned)__builtin_popcountll(word);
    }
    return count;
}

/* OpenVDB fills a buffer for `bytes` with what the chunk says it has. blosc reads as much as the body's own header
 * says; bounded like that it checks the rest itself, as zlib does. */
static swarf_status walk_chunk(reader *r, const description *d, uint64_t bytes, int unpack)
{
    const int blosc = (d->compression & SWARF_VDB_BLOSC) != 0;
    const uint64_t from = r->at;
    const unsigned char *chunk;
    uint64_t length, most = bytes + (blosc ? BLOSC_HEADER : 0);
    SWARF_TRY(take(r, 8, "chunk's length", &length));
    if ((int64_t)length <= 0) {
        if (0 - length != bytes)
            return damaged(r, from, "expected a plain chunk of %llu bytes, found %llu", (unsigned long long)bytes,
                           (unsigned long long)(0 - length));
        return skip(r, bytes, "plain chunk");
    }
    if (length > most || (blosc && length < BLOSC_HEADER))
        return damaged(r, from, "expected a packed chunk of %d to %llu bytes, found %llu", blosc ? BLOSC_HEADER : 1,
                       (unsigned long long)most, (unsigned long long)length);
    r->at = from;
    SWARF_TRY(look(r, 8 + length, "chunk", &chunk));
    if (blosc) {
        uint32_t plain, packed;
        memcpy(&plain, chunk + 8 + 4, sizeof plain);
        memcpy(&packed, chunk + 8 + 12, sizeof packed);
        if (plain != bytes || packed != length)
            return damaged(r, from + 8, "expected a blosc header of %llu bytes packed to %llu, found %lu and %lu",
                           (unsigned long long)bytes, (unsigned long long)length, (unsigned long)plain,
                           (unsigned long)packed);
    }
    if (!unpack) return SWARF_OK;
    const swarf_status status = swarf_vdb_unpack(chunk, 8 + length, d->compression, bytes);
    if (status != SWARF_ERROR_FORMAT) return status;
    return damaged(r, from + 8, "expected %llu bytes, packed, found what does not unpack", (unsigned long long)bytes);
}

/* The values of a node with `active` of its slots on. */
static swarf_status walk_values(reader *r, const description *d, uint64_t slots, uint64_t active, int unpack)
{
    uint64_t kind;
    SWARF_TRY(take(r, 1, "kind of inactive values", &kind));
    if (kind > 6)
        return damaged(r, r->at - 1, "expected a kind of inactive values, 0 to 6, found %llu",
                       (unsigned long long)kind);
    const int floats = kind == 5 ? 2 : kind == 2 || kind == 4;
    for (int i = 0; i < floats; i++) SWARF_TRY(take_float(r, "inactive value"));
    if (kind >= 3 && kind <= 5) SWARF_TRY(skip(r, slots / 8, "mask of inactive values"));
    const uint64_t count = (d->compression & SWARF_VDB_ACTIVE_MASK) && kind != 6 ? active : slots;
    const uint64_t bytes = count * (d->half ? 2 : 4);
    if (!(d->compression & (SWARF_VDB_ZIP | SWARF_VDB_BLOSC)) || (d->half && bytes == 0))
        return skip(r, bytes, "values"); /* no half floats: not even a chunk */
    return walk_chunk(r, d, bytes, unpack);
}

/* An inner node up to its children. */
static swarf_status walk_inner(reader *r, const description *d, size_t slots, unsigned *children)
{
    const unsigned char *masks;
    const uint64_t from = r->at;
    SWARF_TRY(look(r, slots / 4, "masks of a node", &masks));
    *children = count_bits(masks, slots);
    for (size_t i = 0; i < slots / 8; i++)
        if (masks[i] & masks[slots / 8 + i])
            return damaged(r, from + i, "expected children or active values, found a slot with both");
    return walk_values(r, d, slots, count_bits(masks + slots / 8, slots), 1);
}

/* A node of 32^3 slots and all below, without leaves' values; their number is added to *leaves. OpenVDB leaks what it
 * has of such a node when it fails inside it: so all of it is checked, packed values too. */
static swarf_status walk_upper(reader *r, const description *d, uint64_t *leaves)
{
    unsigned lowers, here;
    SWARF_TRY(walk_inner(r, d, UPPER_SLOTS, &lowers));
    while (lowers-- > 0) {
        SWARF_TRY(walk_inner(r, d, LOWER_SLOTS, &here));
        SWARF_TRY(skip(r, (uint64_t)here * (LEAF_SLOTS / 8), "masks of leaves"));
        *leaves += here;
    }
    return SWARF_OK;
}

/* The place of a root slot as a number in the order of places, which is the order they come in. */
static swarf_status take_place(reader *r, uint64_t *place)
{
    *place = 0;
    for (int k = 0; k < 3; k++) {
        uint64_t raw;
        SWARF_TRY(take(r, 4, "place of a root slot", &raw));
        if (raw & ((1u << PLACE_BITS) - 1))
            return damaged(r, r->at - 4, "expected a multiple of 4096, found %ld", (long)(int32_t)(uint32_t)raw);
        *place = *place << (32 - PLACE_BITS) | (raw ^ 0x80000000u) >> PLACE_BITS;
    }
    return SWARF_OK;
}

/* `places` has room for `tiles`. Leaves' values come in the order of places, children as they are listed: both must
 * be the same, and no place may come twice. */
static swarf_status walk_slots(reader *r, const description *d, uint64_t *places, uint64_t tiles, uint64_t children,
                               uint64_t *leaves)
{
    uint64_t active, place, last = 0, tile = 0;
    for (uint64_t i = 0; i < tiles; i++) {
        SWARF_TRY(take_place(r, &places[i]));
        if (i > 0 && places[i] <= places[i - 1]) return damaged(r, r->at - 12, "expected tiles in the order of places");
        SWARF_TRY(take_float(r, "tile"));
        SWARF_TRY(take(r, 1, "tile's state", &active));
        if (active > 1)
            return damaged(r, r->at - 1, "expected a state of 0 or 1, found %llu", (unsigned long long)active);
    }
    for (uint64_t i = 0; i < children; i++, last = place) {
        SWARF_TRY(take_place(r, &place));
        while (tile < tiles && places[tile] < place) tile++;
        if ((i > 0 && place <= last) || (tile < tiles && places[tile] == place))
            return damaged(r, r->at - 12, "expected nodes in the order of places, where no tile is");
        SWARF_TRY(walk_upper(r, d, leaves));
    }
    return SWARF_OK;
}

static swarf_status walk_tree(reader *r, const description *d)
{
    uint64_t buffers, tiles, children, leaves = 0;
    SWARF_TRY(take(r, 4, "number of buffers", &buffers));
    if (buffers != 1)
        return damaged(r, r->at - 4, "expected 1 buffer per leaf, found %llu", (unsigned long long)buffers);
    SWARF_TRY(take_float(r, "background"));
    SWARF_TRY(take(r, 4, "number of tiles", &tiles));
    SWARF_TRY(take(r, 4, "number of nodes", &children));
    if (tiles * 17 + children * 12 > r->size - r->at)
        return damaged(r, r->at - 8, "%llu tiles and %llu nodes are more than the file holds",
                       (unsigned long long)tiles, (unsigned long long)children);
    uint64_t *places = calloc(tiles + 1, sizeof *places);
    if (!places) return swarf_fail(SWARF_ERROR_MEMORY, "%s: out of memory", r->path);
    const swarf_status status = walk_slots(r, d, places, tiles, children, &leaves);
    free(places);
    SWARF_TRY(status);
    if (d->values != 0 && d->values != r->at)
        return damaged(r, r->at, "expected values at byte %llu, found them here", (unsigned long long)d->values);
    for (uint64_t i = 0; i < leaves; i++) {
        const unsigned char *mask;
        SWARF_TRY(look(r, LEAF_SLOTS / 8, "mask of a leaf", &mask));
        SWARF_TRY(walk_values(r, d, LEAF_SLOTS, count_bits(mask, LEAF_SLOTS), 0));
    }
    return SWARF_OK;
}

static int is_level_set(const description *d)
{
    return strncmp(d->type, "Tree_float_5_4_3", 16) == 0 &&
           (d->type[16] == 0 || strcmp(d->type + 16, "_HalfFloat") == 0) && d->parent[0] == 0 &&
           strcmp(d->class, "level set") == 0;
}

/* From the transform to the end. */
static swarf_status walk_grid(reader *r, const description *d, swarf_vdb_place *out)
{
    if (d->half != (strlen(d->type) > 16))
        return damaged(r, r->at, "expected half floats in name and metadata of the type, found them in one");
    out->transform = r->at;
    out->compression = d->compression;
    out->half = d->half;
    SWARF_TRY(walk_transform(r));
    SWARF_TRY(walk_tree(r, d));
    out->end = r->at;
    return SWARF_OK;
}

static swarf_status walk_header(reader *r, int *positions, swarf_vdb_place *out)
{
    uint64_t magic = 0, format, major, minor, flag;
    if (r->size == 0) return swarf_fail(SWARF_ERROR_FORMAT, "%s: not a .vdb file: it is empty", r->path);
    if (r->size >= 8) SWARF_TRY(take(r, 8, "magic number", &magic));
    if (magic != 0x56444220)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: not a .vdb file%s", r->path,
                          (magic & 0xffff) == 0x8b1f ? ": it is packed by gzip; unpack it" : "");
    SWARF_TRY(take(r, 4, "format", &format));
    if (format < FORMAT_FIRST || format > FORMAT_LAST)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: format %llu is not read, %d (2012) to %d are; save it anew", r->path,
                          (unsigned long long)format, FORMAT_FIRST, FORMAT_LAST);
    SWARF_TRY(take(r, 4, "library version", &major));
    SWARF_TRY(take(r, 4, "library version", &minor));
    SWARF_TRY(take(r, 1, "positions flag", &flag));
    SWARF_TRY(skip(r, 36, "id"));
    *positions = flag != 0;
    out->format = (uint32_t)format;
    out->library_major = (uint32_t)major;
    out->library_minor = (uint32_t)minor;
    return walk_metadata(r, NULL);
}

static swarf_status walk_file(reader *r, swarf_vdb_place *out)
{
    int positions, found = 0;
    uint64_t grids;
    char there[2 * TEXT_MAX] = "no grids";
    size_t written = 0;
    SWARF_TRY(walk_header(r, &positions, out));
    SWARF_TRY(take(r, 4, "number of grids", &grids));
    for (uint64_t i = 0; i < grids && (positions || !found); i++) {
        description d;
        SWARF_TRY(walk_description(r, positions, &d));
        if (!found && is_level_set(&d)) {
            SWARF_TRY(walk_grid(r, &d, out));
            found = 1;
            if (positions && r->at != d.end)
                return damaged(r, r->at, "expected the end of the grid at byte %llu, found it here",
                               (unsigned long long)d.end);
        } else if (written < sizeof there) {
            written += (size_t)snprintf(there + written, sizeof there - written, "%s\"%.60s\" (%.40s, %.40s%s)",
                                        i > 0 ? ", " : "", d.name, d.type, d.class, d.parent[0] ? ", an instance" : "");
        }
        if (positions && d.end < r->at) return damaged(r, d.end, "expected the end of the grid, found its metadata");
        if (!positions && !found) break; /* nothing tells where the next one starts */
        if (positions) r->at = d.end;
    }
    if (!found) return swarf_fail(SWARF_ERROR_FORMAT, "%s: no level set of floats in it, but %s", r->path, there);
    return SWARF_OK;
}

swarf_status swarf_vdb_scan(FILE *file, uint64_t size, const char *path, swarf_vdb_place *out)
{
    reader *r = malloc(sizeof *r);
    if (!r) return swarf_fail(SWARF_ERROR_MEMORY, "%s: out of memory", path);
    r->file = file;
    r->path = path;
    r->size = size;
    r->at = r->from = r->held = 0;
    swarf_vdb_place place = {0};
    const swarf_status status = walk_file(r, &place);
    free(r);
    if (status == SWARF_OK) *out = place;
    return status;
}
