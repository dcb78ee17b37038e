/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* STL. Binary: 80 bytes of anything, a 32-bit count, then per triangle 12 floats (normal, 3 corners) and 2 bytes,
 * little-endian. Text: solid / facet normal / outer loop / 3 vertices / endloop / endfacet / endsolid.
 * Normals are written but not read: the order of the corners says the same. */
#include "mesh/stl.h"

#include "base/parallel.h"
#include "base/status.h"
#include "mesh/text.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER = 84, RECORD = 50 };
/* Triangles per write: 3 MB, large enough for full disk speed, small enough for a lively progress bar. */
enum { CHUNK = 65536 };

static uint32_t read_u32(const char *p)
{
    const unsigned char *b = (const unsigned char *)p;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static void write_u32(unsigned char *p, uint32_t value)
{
    for (int i = 0; i < 4; i++) p[i] = (unsigned char)(value >> (8 * i));
}

static void write_f32(unsigned char *p, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    write_u32(p, bits);
}

int swarf_stl_is_binary(const char *text, size_t length)
{
    return length >= HEADER && (length - HEADER) % RECORD == 0 && (length - HEADER) / RECORD == read_u32(text + 80);
}

static swarf_status read_binary(const char *text, size_t length, const char *name, swarf_mesh_data *out)
{
    const size_t there = (length - HEADER) / RECORD, claimed = read_u32(text + 80);
    if (claimed > there)
        return swarf_fail(SWARF_ERROR_FORMAT,
                          "%s: cut short: its header claims %zu triangles, but %zu bytes hold only %zu", name, claimed,
                          length, there);
    if (claimed < there || (length - HEADER) % RECORD)
        return swarf_fail(SWARF_ERROR_FORMAT,
                          "%s: its header claims %zu triangles, %zu bytes, but the file has %zu: the count is wrong or "
                          "something else follows",
                          name, claimed, claimed * RECORD + HEADER, length);
    for (size_t i = 0; i < claimed; i++) {
        const char *record = text + HEADER + i * RECORD;
        for (int k = 0; k < 3; k++) {
            float p[3];
            for (int c = 0; c < 3; c++) {
                const uint32_t bits = read_u32(record + 12 + 12 * k + 4 * c);
                memcpy(&p[c], &bits, sizeof bits);
                if (!isfinite(p[c]))
                    return swarf_fail(SWARF_ERROR_FORMAT, "%s: triangle %zu: coordinate %c of corner %d is not finite",
                                      name, i + 1, "xyz"[c], k + 1);
            }
            SWARF_TRY(swarf_mesh_data_vertex(out, p));
        }
        const uint32_t v = (uint32_t)(3 * i);
        SWARF_TRY(swarf_mesh_data_triangle(out, v, v + 1, v + 2));
    }
    return SWARF_OK;
}

static swarf_status expect(swarf_text *text, const char *wanted)
{
    const swarf_word word = swarf_text_word_anywhere(text);
    return swarf_word_is(word, wanted) ? SWARF_OK : swarf_text_fail(text, word, wanted);
}

static swarf_status read_facet(swarf_text *text, swarf_mesh_data *out)
{
    SWARF_TRY(expect(text, "normal"));
    swarf_text_next_line(text); /* whatever the normal is */
    SWARF_TRY(expect(text, "outer"));
    SWARF_TRY(expect(text, "loop"));
    for (int k = 0; k < 3; k++) {
        SWARF_TRY(expect(text, "vertex"));
        float p[3];
        SWARF_TRY(swarf_text_point(text, p));
        SWARF_TRY(swarf_mesh_data_vertex(out, p));
    }
    SWARF_TRY(expect(text, "endloop"));
    SWARF_TRY(expect(text, "endfacet"));
    if (out->vertex_count >= UINT32_MAX) return swarf_fail(SWARF_ERROR_FORMAT, "%s: too many triangles", text->name);
    const uint32_t v = (uint32_t)(out->vertex_count - 3);
    return swarf_mesh_data_triangle(out, v, v + 1, v + 2);
}

static swarf_status read_text(const char *data, size_t length, const char *name, swarf_mesh_data *out)
{
    swarf_text text = {data, data + length, name, 1};
    int open = 0, solids = 0;
    for (;;) {
        const swarf_word word = swarf_text_word_anywhere(&text);
        if (word.length == 0 && solids && !open) return SWARF_OK;
        if (swarf_word_is(word, "solid") && !open) {
            open = 1;
            solids++;
            swarf_text_next_line(&text); /* the rest is its name */
        } else if (swarf_word_is(word, "endsolid") && open) {
            open = 0;
            swarf_text_next_line(&text);
        } else if (swarf_word_is(word, "facet") && open) {
            SWARF_TRY(read_facet(&text, out));
        } else {
            return swarf_text_fail(&text, word, open ? "'facet' or 'endsolid'" : "'solid'");
        }
    }
}

swarf_status swarf_stl_read(const char *text, size_t length, const char *name, swarf_mesh_data *out)
{
    size_t skip = 0;
    while (skip < length && (text[skip] == ' ' || text[skip] == '\n' || text[skip] == '\r' || text[skip] == '\t'))
        skip++;
    /* many programs start a binary header with "solid": a text has no 0 bytes */
    const int is_text = strncmp(text + skip, "solid", 5) == 0 && !swarf_stl_is_binary(text, length) &&
                        !memchr(text, 0, length < 4096 ? length : 4096);
    if (is_text) {
        SWARF_TRY(read_text(text, length, name, out));
    } else {
        if (length < HEADER)
            return swarf_fail(SWARF_ERROR_FORMAT, "%s: not an STL file: %zu bytes are less than its header of %d", name,
                              length, HEADER);
        SWARF_TRY(read_binary(text, length, name, out));
    }
    return swarf_mesh_data_weld(out);
}

static void write_record(const swarf_triangles *t, size_t i, unsigned char *record)
{
    const float *p[3];
    for (int k = 0; k < 3; k++) p[k] = t->xyz + 3 * (size_t)t->index[3 * i + (size_t)k];
    double u[3], v[3];
    for (int c = 0; c < 3; c++) {
        u[c] = (double)p[1][c] - p[0][c];
        v[c] = (double)p[2][c] - p[0][c];
    }
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int c = 0; c < 3; c++) {
        write_f32(record + 4 * c, length > 0 ? (float)(n[c] / length) : 0.0f);
        for (int k = 0; k < 3; k++) write_f32(record + 12 + 12 * k + 4 * c, p[k][c]);
    }
    record[48] = record[49] = 0;
}

swarf_status swarf_stl_write_header(size_t triangles, FILE *stream)
{
    if (triangles > UINT32_MAX)
        return swarf_fail(SWARF_ERROR_ARGUMENT, "mesh: %zu triangles are more than an STL file can count", triangles);
    unsigned char header[HEADER] = "Swarf binary STL, mm"; /* must not start with "solid" */
    write_u32(header + 80, (uint32_t)triangles);
    fwrite(header, 1, HEADER, stream); /* what fails is found when the file is closed */
    return SWARF_OK;
}

swarf_status swarf_stl_write_records(const swarf_triangles *t, FILE *stream, const swarf_progress *progress)
{
    unsigned char *buffer = malloc((size_t)CHUNK * RECORD);
    if (!buffer) return swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    swarf_status status = SWARF_OK;
    for (size_t first = 0; first < t->triangle_count && status == SWARF_OK; first += CHUNK) {
        const size_t left = t->triangle_count - first, count = left < CHUNK ? left : CHUNK;
        for (size_t i = 0; i < count; i++) write_record(t, first + i, buffer + i * RECORD);
        fwrite(buffer, RECORD, count, stream);
        status = swarf_progress_report(progress, (double)(first + count) / (double)t->triangle_count);
    }
    free(buffer);
    return status;
}

swarf_status swarf_stl_finish(FILE *stream, size_t triangles)
{
    if (fseek(stream, 0, SEEK_SET) != 0 && !ferror(stream)) /* that is told when the file is closed */
        return swarf_fail(SWARF_ERROR_IO, "mesh: the count cannot be put where the file begins: %s", strerror(errno));
    return swarf_stl_write_header(triangles, stream);
}

swarf_status swarf_stl_write(const swarf_triangles *t, const uint8_t *rgb, FILE *stream, const swarf_progress *progress)
{
    (void)rgb;
    SWARF_TRY(swarf_stl_write_header(t->triangle_count, stream));
    return swarf_stl_write_records(t, stream, progress);
}
