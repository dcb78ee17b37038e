/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* PLY: a text header that lists elements and their properties, then their values, as text or binary of either byte
 * order. Read are x, y, z of "vertex" and the list vertex_indices (or vertex_index) of "face"; all else is stepped
 * over. Polygons become fans. Written: binary little-endian, floats and 32-bit numbers. */
#include "mesh/mesh.h"

#include "base/parallel.h"
#include "base/status.h"
#include "mesh/text.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* More than any writer makes; keeps the header a plain array. */
enum { MAX_ELEMENTS = 32, MAX_PROPERTIES = 64 };
enum { CHUNK = 65536 };

typedef enum number_type { I8, U8, I16, U16, I32, U32, F32, F64, TYPE_COUNT } number_type;
static const size_t type_size[TYPE_COUNT] = {1, 1, 2, 2, 4, 4, 4, 8};

/* What a value is for. */
typedef enum role { OTHER, X, Y, Z, CORNERS } role;

typedef struct property {
    int is_list;
    number_type count_type;
    number_type type;
    role role;
} property;

typedef struct element {
    int is_vertex, is_face;
    size_t count;
    size_t property_count;
    property properties[MAX_PROPERTIES];
} element;

typedef struct reader {
    swarf_text text;
    int binary, big_endian;
    size_t element_count;
    element elements[MAX_ELEMENTS];
    const char *what; /* element being read and its number, for errors */
    size_t number;
} reader;

static int type_of(swarf_word word, number_type *out)
{
    static const struct {
        const char *name;
        number_type type;
    } names[] = {{"char", I8},    {"int8", I8},     {"uchar", U8},   {"uint8", U8},   {"short", I16}, {"int16", I16},
                 {"ushort", U16}, {"uint16", U16},  {"int", I32},    {"int32", I32},  {"uint", U32},  {"uint32", U32},
                 {"float", F32},  {"float32", F32}, {"double", F64}, {"float64", F64}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (swarf_word_is(word, names[i].name)) {
            *out = names[i].type;
            return 1;
        }
    return 0;
}

static swarf_status read_property(reader *r)
{
    if (r->element_count == 0)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s:%zu: property before any element", r->text.name, r->text.line);
    element *e = &r->elements[r->element_count - 1];
    if (e->property_count == MAX_PROPERTIES)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s:%zu: more than %d properties", r->text.name, r->text.line,
                          MAX_PROPERTIES);
    property p = {0};
    swarf_word word = swarf_text_word(&r->text);
    if (swarf_word_is(word, "list")) {
        p.is_list = 1;
        word = swarf_text_word(&r->text);
        if (!type_of(word, &p.count_type) || p.count_type >= F32)
            return swarf_text_fail(&r->text, word, "a whole number type");
        word = swarf_text_word(&r->text);
    }
    if (!type_of(word, &p.type)) return swarf_text_fail(&r->text, word, "a number type");
    word = swarf_text_word(&r->text);
    if (word.length == 0) return swarf_text_fail(&r->text, word, "a property name");
    if (e->is_vertex && !p.is_list && word.length == 1 && *word.at >= 'x' && *word.at <= 'z')
        p.role = (role)(X + (*word.at - 'x'));
    if (e->is_face && p.is_list && p.type < F32 &&
        (swarf_word_is(word, "vertex_indices") || swarf_word_is(word, "vertex_index")))
        p.role = CORNERS;
    e->properties[e->property_count++] = p;
    return SWARF_OK;
}

static swarf_status read_element(reader *r)
{
    if (r->element_count == MAX_ELEMENTS)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s:%zu: more than %d elements", r->text.name, r->text.line,
                          MAX_ELEMENTS);
    element *e = &r->elements[r->element_count];
    const swarf_word name = swarf_text_word(&r->text);
    e->is_vertex = swarf_word_is(name, "vertex");
    e->is_face = swarf_word_is(name, "face");
    const swarf_word word = swarf_text_word(&r->text);
    int64_t count;
    if (!swarf_word_integer(word, &count) || count < 0) return swarf_text_fail(&r->text, word, "a count");
    e->count = (size_t)count;
    r->element_count++;
    return SWARF_OK;
}

static swarf_status read_format(reader *r)
{
    const swarf_word word = swarf_text_word(&r->text);
    if (swarf_word_is(word, "ascii")) return SWARF_OK;
    r->binary = 1;
    if (swarf_word_is(word, "binary_little_endian")) return SWARF_OK;
    r->big_endian = 1;
    if (swarf_word_is(word, "binary_big_endian")) return SWARF_OK;
    return swarf_text_fail(&r->text, word, "ascii, binary_little_endian or binary_big_endian");
}

/* Every vertex needs x, y and z, every face its corners, and faces come after vertices. */
static swarf_status check_header(const reader *r)
{
    int vertices = 0;
    for (size_t i = 0; i < r->element_count; i++) {
        const element *e = &r->elements[i];
        unsigned roles = 0;
        for (size_t k = 0; k < e->property_count; k++) roles |= 1u << e->properties[k].role;
        const unsigned wanted = e->is_vertex ? 1u << X | 1u << Y | 1u << Z : e->is_face ? 1u << CORNERS : 0;
        if ((roles & wanted) != wanted)
            return swarf_fail(SWARF_ERROR_FORMAT, "%s: its header names no %s", r->text.name,
                              e->is_vertex ? "x, y and z of a vertex" : "list vertex_indices of a face");
        if (e->is_vertex) vertices = 1;
        if (e->is_face && !vertices)
            return swarf_fail(SWARF_ERROR_FORMAT, "%s: faces before vertices, or no vertices", r->text.name);
    }
    return vertices ? SWARF_OK : swarf_fail(SWARF_ERROR_FORMAT, "%s: its header names no vertices", r->text.name);
}

static swarf_status read_header(reader *r)
{
    int format = 0;
    for (;;) {
        if (!swarf_text_next_line(&r->text))
            return swarf_fail(SWARF_ERROR_FORMAT, "%s:%zu: the header has no end_header", r->text.name, r->text.line);
        const swarf_word word = swarf_text_word(&r->text);
        if (word.length == 0 || swarf_word_is(word, "comment") || swarf_word_is(word, "obj_info")) continue;
        if (swarf_word_is(word, "end_header")) break;
        if (swarf_word_is(word, "format")) {
            SWARF_TRY(read_format(r));
            format = 1;
        } else if (swarf_word_is(word, "element")) {
            SWARF_TRY(read_element(r));
        } else if (swarf_word_is(word, "property")) {
            SWARF_TRY(read_property(r));
        } else {
            return swarf_text_fail(&r->text, word, "format, element, property, comment or end_header");
        }
    }
    if (!format) return swarf_fail(SWARF_ERROR_FORMAT, "%s: its header names no format", r->text.name);
    swarf_text_next_line(&r->text);
    return check_header(r);
}

static swarf_status read_binary_value(reader *r, number_type type, double *out)
{
    const size_t size = type_size[type];
    if ((size_t)(r->text.end - r->text.at) < size)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: cut short: the file ends in %s %zu", r->text.name, r->what,
                          r->number + 1);
    const unsigned char *b = (const unsigned char *)r->text.at;
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) bits |= (uint64_t)b[r->big_endian ? size - 1 - i : i] << (8 * i);
    r->text.at += size;
    float single;
    const uint32_t low = (uint32_t)bits;
    switch (type) {
    case I8: *out = (int8_t)bits; break;
    case I16: *out = (int16_t)bits; break;
    case I32: *out = (int32_t)bits; break;
    case F32:
        memcpy(&single, &low, sizeof single);
        *out = single;
        break;
    case F64: memcpy(out, &bits, sizeof *out); break;
    default: *out = (double)bits;
    }
    return SWARF_OK;
}

static swarf_status read_value(reader *r, number_type type, double *out)
{
    if (r->binary) return read_binary_value(r, type, out);
    const swarf_word word = swarf_text_word_anywhere(&r->text);
    return swarf_word_number(word, out) ? SWARF_OK : swarf_text_fail(&r->text, word, "a number");
}

static swarf_status read_list(reader *r, const property *p, swarf_mesh_data *out)
{
    double count, value;
    uint32_t first = 0, last = 0;
    SWARF_TRY(read_value(r, p->count_type, &count));
    if (!(count >= 0 && count <= UINT32_MAX) || (p->role == CORNERS && count < 3))
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: %s %zu has a list of %g", r->text.name, r->what, r->number + 1,
                          count);
    for (uint32_t i = 0; i < (uint32_t)count; i++) {
        SWARF_TRY(read_value(r, p->type, &value));
        if (p->role != CORNERS) continue;
        if (!(value >= 0 && value < (double)out->vertex_count && value < UINT32_MAX) || value != floor(value))
            return swarf_fail(SWARF_ERROR_FORMAT, "%s: %s %zu uses vertex %.17g of %zu", r->text.name, r->what,
                              r->number + 1, value, out->vertex_count);
        const uint32_t vertex = (uint32_t)value;
        if (i >= 2) SWARF_TRY(swarf_mesh_data_triangle(out, first, last, vertex));
        if (i == 0) first = vertex;
        last = vertex;
    }
    return SWARF_OK;
}

static swarf_status read_row(reader *r, const element *e, swarf_mesh_data *out)
{
    float xyz[3] = {0, 0, 0};
    for (size_t k = 0; k < e->property_count; k++) {
        const property *p = &e->properties[k];
        if (p->is_list) {
            SWARF_TRY(read_list(r, p, out));
            continue;
        }
        double value;
        SWARF_TRY(read_value(r, p->type, &value));
        if (p->role == OTHER) continue;
        if (!(fabs(value) <= FLT_MAX))
            return swarf_fail(SWARF_ERROR_FORMAT, "%s: %s %zu: a coordinate is not finite", r->text.name, r->what,
                              r->number + 1);
        xyz[p->role - X] = (float)value;
    }
    return e->is_vertex ? swarf_mesh_data_vertex(out, xyz) : SWARF_OK;
}

static swarf_status read_body(reader *r, swarf_mesh_data *out)
{
    for (size_t i = 0; i < r->element_count; i++) {
        const element *e = &r->elements[i];
        r->what = e->is_vertex ? "vertex" : e->is_face ? "face" : "element";
        if (e->property_count == 0) continue; /* holds nothing, however many it claims */
        for (r->number = 0; r->number < e->count; r->number++) SWARF_TRY(read_row(r, e, out));
    }
    return SWARF_OK;
}

swarf_status swarf_ply_read(const char *text, size_t length, const char *name, swarf_mesh_data *out)
{
    reader *r = calloc(1, sizeof *r);
    if (!r) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    r->text = (swarf_text){text, text + length, name, 1};
    swarf_status status = read_header(r);
    if (status == SWARF_OK) status = read_body(r, out);
    free(r);
    return status;
}

static void put_u32(unsigned char *p, uint32_t value)
{
    for (int i = 0; i < 4; i++) p[i] = (unsigned char)(value >> (8 * i));
}

typedef struct writing {
    const swarf_triangles *t;
    const uint8_t *rgb;
} writing;

static void put_vertex(const writing *w, size_t i, unsigned char *p)
{
    for (int c = 0; c < 3; c++) {
        uint32_t bits;
        memcpy(&bits, w->t->xyz + 3 * i + c, sizeof bits);
        put_u32(p + 4 * c, bits);
    }
}

static void put_face(const writing *w, size_t i, unsigned char *p)
{
    p[0] = 3;
    for (int k = 0; k < 3; k++) put_u32(p + 1 + 4 * k, w->t->index[3 * i + (size_t)k]);
    if (w->rgb) memcpy(p + 13, w->rgb + 3 * i, 3);
}

/* `count` records of `size` bytes through one buffer; `from`..`to` is their part of the progress. */
static swarf_status write_records(const writing *w, size_t count, size_t size,
                                  void (*put)(const writing *, size_t, unsigned char *), FILE *stream,
                                  const swarf_progress *progress, double from, double to)
{
    unsigned char *buffer = malloc(CHUNK * size);
    if (!buffer) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    swarf_status status = SWARF_OK;
    for (size_t first = 0; first < count && status == SWARF_OK; first += CHUNK) {
        const size_t part = count - first < CHUNK ? count - first : CHUNK;
        for (size_t i = 0; i < part; i++) put(w, first + i, buffer + i * size);
        fwrite(buffer, size, part, stream);
        status = swarf_progress_report(progress, from + (to - from) * (double)(first + part) / (double)count);
    }
    free(buffer);
    return status;
}

swarf_status swarf_ply_write(const swarf_triangles *t, const uint8_t *rgb, FILE *stream, const swarf_progress *progress)
{
    const writing w = {t, rgb};
    fprintf(stream,
            "ply\nformat binary_little_endian 1.0\ncomment Swarf, mm\nelement vertex %zu\nproperty float x\n"
            "property float y\nproperty float z\nelement face %zu\nproperty list uchar uint vertex_indices\n%s"
            "end_header\n",
            t->vertex_count, t->triangle_count,
            rgb ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "");
    SWARF_TRY(write_records(&w, t->vertex_count, 12, put_vertex, stream, progress, 0, 0.3));
    return write_records(&w, t->triangle_count, rgb ? 16 : 13, put_face, stream, progress, 0.3, 1);
}
