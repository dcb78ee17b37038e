/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Wavefront OBJ: "v x y z" and "f a b c ...", corners as vertex[/texture[/normal]], numbers from 1 or, negative,
 * back from the last vertex. Polygons become fans. Everything that is not shape is skipped. Colours are written after a
 * vertex's coordinates, 0 .. 1, as most programs read them. */
#include "mesh/mesh.h"

#include "base/parallel.h"
#include "base/status.h"
#include "mesh/colours.h"
#include "mesh/text.h"

#include <string.h>

/* Elements between two progress reports. */
enum { CHUNK = 65536 };

static swarf_status read_vertex(swarf_text *text, swarf_mesh_data *out)
{
    float p[3];
    SWARF_TRY(swarf_text_point(text, p));
    return swarf_mesh_data_vertex(out, p);
}

static swarf_status read_face(swarf_text *text, swarf_mesh_data *out)
{
    uint32_t first = 0, last = 0;
    for (size_t corner = 0;; corner++) {
        const swarf_word word = swarf_text_word(text);
        if (word.length == 0 || word.at[0] == '#') {
            if (corner < 3)
                return swarf_text_fail(text, (swarf_word){text->at, 0}, "a face with three corners or more");
            return SWARF_OK;
        }
        const char *slash = memchr(word.at, '/', word.length);
        const swarf_word number = {word.at, slash ? (size_t)(slash - word.at) : word.length};
        int64_t value;
        if (!swarf_word_integer(number, &value)) return swarf_text_fail(text, word, "a vertex number");
        if (value < 0) value += (int64_t)out->vertex_count + 1;
        if (value < 1 || value > (int64_t)out->vertex_count || value > UINT32_MAX)
            return swarf_fail(SWARF_ERROR_FORMAT, "%s:%zu: '%.*s': there are %zu vertices up to this line", text->name,
                              text->line, (int)(word.length < 40 ? word.length : 40), word.at, out->vertex_count);
        const uint32_t vertex = (uint32_t)(value - 1);
        if (corner >= 2) SWARF_TRY(swarf_mesh_data_triangle(out, first, last, vertex));
        if (corner == 0) first = vertex;
        last = vertex;
    }
}

swarf_status swarf_obj_read(const char *data, size_t length, const char *name, swarf_mesh_data *out)
{
    static const char *const skipped[] = {"vn", "vt", "vp", "g", "o", "s", "l", "p", "mtllib", "usemtl"};
    swarf_text text = {data, data + length, name, 1};
    do {
        const swarf_word word = swarf_text_word(&text);
        if (word.length == 0 || word.at[0] == '#') continue;
        if (swarf_word_is(word, "v")) {
            SWARF_TRY(read_vertex(&text, out));
        } else if (swarf_word_is(word, "f")) {
            SWARF_TRY(read_face(&text, out));
        } else {
            int known = 0;
            for (size_t i = 0; i < sizeof skipped / sizeof *skipped; i++) known |= swarf_word_is(word, skipped[i]);
            if (!known) return swarf_text_fail(&text, word, "a statement of an OBJ file (v, f ...)");
        }
    } while (swarf_text_next_line(&text));
    if (out->vertex_count == 0)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: neither STL, PLY nor OBJ: no vertices in it", name);
    return SWARF_OK;
}

static swarf_status write_all(const swarf_painted *p, FILE *stream, const swarf_progress *progress)
{
    const swarf_triangles *t = &p->triangles;
    const double total = (double)(t->vertex_count + t->triangle_count) + 1;
    fprintf(stream, "# Swarf, mm\n");
    for (size_t i = 0; i < t->vertex_count; i++) {
        const float *at = t->xyz + 3 * i;
        /* 9 digits bring every float back */
        fprintf(stream, "v %.9g %.9g %.9g", (double)at[0], (double)at[1], (double)at[2]);
        if (p->vertex_rgb)
            for (int c = 0; c < 3; c++) fprintf(stream, " %.4g", p->vertex_rgb[3 * i + (size_t)c] / 255.0);
        fputc('\n', stream);
        if (i % CHUNK == 0) SWARF_TRY(swarf_progress_report(progress, (double)i / total));
    }
    for (size_t i = 0; i < t->triangle_count; i++) {
        const uint32_t *v = t->index + 3 * i;
        fprintf(stream, "f %llu %llu %llu\n", v[0] + 1ull, v[1] + 1ull, v[2] + 1ull);
        if (i % CHUNK == 0) SWARF_TRY(swarf_progress_report(progress, (double)(t->vertex_count + i) / total));
    }
    return swarf_progress_report(progress, 1.0);
}

swarf_status swarf_obj_write(const swarf_triangles *t, const uint8_t *rgb, FILE *stream, const swarf_progress *progress)
{
    swarf_painted painted;
    locale_t kept;
    SWARF_TRY(swarf_painted_create(t, rgb, &painted));
    swarf_status status = swarf_text_locale_begin(&kept);
    if (status == SWARF_OK) {
        status = write_all(&painted, stream, progress);
        swarf_text_locale_end(kept);
    }
    swarf_painted_free(&painted);
    return status;
}
