/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* 3MF core specification 1.3 with colours of the materials extension 1.2.1: a ZIP archive of one model of one object,
 * in millimetres. Written as it goes, with no copy of the mesh in memory, which lib3mf would take; that reads it in
 * tests. */
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/colours.h"
#include "mesh/mesh.h"
#include "mesh/text.h"
#include "mesh/zip.h"

#include <stdlib.h>
#include <string.h>

enum { TEXT = 65536, LINE = 128, REPORT = 65536 };

/* Text on its way into the archive. */
typedef struct output {
    swarf_zip *zip;
    size_t used;
    char text[TEXT];
} output;

static swarf_status flush(output *o)
{
    const size_t used = o->used;
    o->used = 0;
    return swarf_zip_write(o->zip, o->text, used);
}

#define PRINT(o, ...)                                                                                                  \
    do {                                                                                                               \
        if ((o)->used > TEXT - LINE) SWARF_TRY(flush(o));                                                              \
        (o)->used += (size_t)snprintf((o)->text + (o)->used, LINE, __VA_ARGS__);                                       \
    } while (0)

static swarf_status write_whole(swarf_zip *zip, const char *name, const char *text)
{
    SWARF_TRY(swarf_zip_entry(zip, name));
    return swarf_zip_write(zip, text, strlen(text));
}

static swarf_status write_mesh(output *o, const swarf_triangles *t, const uint8_t *rgb, const uint32_t *palette,
                               size_t colours, const swarf_progress *progress)
{
    const double total = (double)(t->vertex_count + t->triangle_count) + 1;
    PRINT(o, "<object id=\"1\" type=\"model\"%s><mesh><vertices>\n", rgb ? " pid=\"2\" pindex=\"0\"" : "");
    for (size_t i = 0; i < t->vertex_count; i++) {
        const float *p = t->xyz + 3 * i;
        PRINT(o, "<vertex x=\"%.9g\" y=\"%.9g\" z=\"%.9g\"/>\n", (double)p[0], (double)p[1], (double)p[2]);
        if (i % REPORT == 0) SWARF_TRY(swarf_progress_report(progress, (double)i / total));
    }
    PRINT(o, "</vertices><triangles>\n");
    for (size_t i = 0; i < t->triangle_count; i++) {
        const uint32_t *v = t->index + 3 * i;
        PRINT(o, "<triangle v1=\"%u\" v2=\"%u\" v3=\"%u\"", v[0], v[1], v[2]);
        if (rgb) PRINT(o, " pid=\"2\" p1=\"%zu\"", swarf_palette_find(palette, colours, rgb + 3 * i));
        PRINT(o, "/>\n");
        if (i % REPORT == 0) SWARF_TRY(swarf_progress_report(progress, (double)(t->vertex_count + i) / total));
    }
    PRINT(o, "</triangles></mesh></object>\n");
    return SWARF_OK;
}

static swarf_status write_model(output *o, const swarf_triangles *t, const uint8_t *rgb, const uint32_t *palette,
                                size_t colours, const swarf_progress *progress)
{
    PRINT(o, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\"\n");
    PRINT(o, " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"");
    PRINT(o, " xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n");
    PRINT(o, "<metadata name=\"Application\">Swarf %s</metadata>\n<resources>\n", swarf_version());
    if (rgb) {
        PRINT(o, "<m:colorgroup id=\"2\">");
        for (size_t i = 0; i < colours; i++) PRINT(o, "<m:color color=\"#%06XFF\"/>\n", palette[i]);
        PRINT(o, "</m:colorgroup>\n");
    }
    /* an object must have a triangle: an empty mesh is a model of nothing */
    if (t->triangle_count) SWARF_TRY(write_mesh(o, t, rgb, palette, colours, progress));
    PRINT(o, "</resources>\n<build>%s</build>\n</model>\n", t->triangle_count ? "<item objectid=\"1\"/>" : "");
    return flush(o);
}

static swarf_status write_parts(output *o, const swarf_triangles *t, const uint8_t *rgb, const uint32_t *palette,
                                size_t colours, const swarf_progress *progress)
{
    SWARF_TRY(write_whole(o->zip, "[Content_Types].xml",
                          "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                          "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
                          "<Default Extension=\"rels\" "
                          "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
                          "<Default Extension=\"model\" "
                          "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n"));
    SWARF_TRY(write_whole(o->zip, "_rels/.rels",
                          "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                          "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
                          "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
                          "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
                          "</Relationships>\n"));
    SWARF_TRY(swarf_zip_entry(o->zip, "3D/3dmodel.model"));
    SWARF_TRY(write_model(o, t, rgb, palette, colours, progress));
    SWARF_TRY(swarf_zip_finish(o->zip));
    return swarf_progress_report(progress, 1.0);
}

swarf_status swarf_3mf_write(const swarf_triangles *t, const uint8_t *rgb, FILE *stream, const swarf_progress *progress)
{
    uint32_t *palette = NULL;
    size_t colours = 0;
    locale_t kept;
    if (rgb) SWARF_TRY(swarf_palette(rgb, t->triangle_count, &palette, &colours));
    output *o = calloc(1, sizeof *o);
    swarf_status status = o ? swarf_zip_create(stream, &o->zip) : swarf_fail(SWARF_ERROR_MEMORY, "out of memory");
    if (status == SWARF_OK) status = swarf_text_locale_begin(&kept);
    if (status == SWARF_OK) {
        status = write_parts(o, t, rgb, palette, colours, progress);
        swarf_text_locale_end(kept);
    }
    if (o) swarf_zip_destroy(o->zip);
    free(o);
    free(palette);
    return status;
}
