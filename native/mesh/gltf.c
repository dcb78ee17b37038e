/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* glTF 2.0, binary (.glb): a header, a JSON chunk, a binary chunk of positions, colours and indices; little-endian. Its
 * units are metres and +y is up, so that the one node turns and scales. Without normals readers shade faces flat, which
 * is what a milled part asks for. */
#include "base/parallel.h"
#include "base/status.h"
#include "mesh/colours.h"
#include "mesh/mesh.h"
#include "mesh/text.h"

#include <math.h>
#include <string.h>

enum { JSON = 2048, WORDS = 16384 };

/* Words on their way to the stream. */
typedef struct output {
    FILE *stream;
    size_t used;
    unsigned char bytes[4 * WORDS];
} output;

static void put_u32(output *o, uint32_t value)
{
    for (int i = 0; i < 4; i++) o->bytes[4 * o->used + (size_t)i] = (unsigned char)(value >> (8 * i));
    if (++o->used < WORDS) return;
    fwrite(o->bytes, 4, o->used, o->stream);
    o->used = 0;
}

static void put_f32(output *o, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u32(o, bits);
}

/* The description; returns its length, blanks at the end making it a multiple of four. */
static size_t describe(const swarf_painted *p, char json[JSON])
{
    const swarf_triangles *t = &p->triangles;
    const size_t positions = 12 * t->vertex_count, colours = p->vertex_rgb ? 4 * t->vertex_count : 0;
    const size_t indices = 12 * t->triangle_count, total = positions + colours + indices;
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < 3 * t->vertex_count; i++) {
        lo[i % 3] = fmin(lo[i % 3], (double)t->xyz[i]);
        hi[i % 3] = fmax(hi[i % 3], (double)t->xyz[i]);
    }
    size_t n = 0;
#define PRINT(...) n += (size_t)snprintf(json + n, JSON - n, __VA_ARGS__)
    PRINT("{\"asset\":{\"version\":\"2.0\",\"generator\":\"Swarf %s\"},\"scene\":0,", swarf_version());
    if (t->triangle_count == 0) { /* buffers must not be empty */
        PRINT("\"scenes\":[{}]}");
    } else {
        PRINT("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"matrix\":"
              "[0.001,0,0,0,0,0,-0.001,0,0,0.001,0,0,0,0,0,1]}],"
              "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0%s},\"indices\":1,\"mode\":4}]}],"
              "\"buffers\":[{\"byteLength\":%zu}],",
              colours ? ",\"COLOR_0\":2" : "", total);
        PRINT("\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%zu,\"target\":34962},"
              "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":34963}",
              positions, positions + colours, indices);
        if (colours)
            PRINT(",{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":34962}", positions, colours);
        PRINT("],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\","
              "\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]},",
              t->vertex_count, lo[0], lo[1], lo[2], hi[0], hi[1], hi[2]);
        PRINT("{\"bufferView\":1,\"componentType\":5125,\"count\":%zu,\"type\":\"SCALAR\"}", 3 * t->triangle_count);
        if (colours)
            PRINT(",{\"bufferView\":2,\"componentType\":5121,\"normalized\":true,\"count\":%zu,\"type\":\"VEC4\"}",
                  t->vertex_count);
        PRINT("]}");
    }
    while (n % 4) PRINT(" ");
#undef PRINT
    return n;
}

static swarf_status write_all(const swarf_painted *p, FILE *stream, const swarf_progress *progress)
{
    const swarf_triangles *t = &p->triangles;
    char json[JSON];
    output o = {.stream = stream};
    locale_t kept;
    SWARF_TRY(swarf_text_locale_begin(&kept));
    const size_t described = describe(p, json);
    swarf_text_locale_end(kept);
    const size_t binary = (p->vertex_rgb ? 16 : 12) * t->vertex_count + 12 * t->triangle_count;
    const size_t chunk = t->triangle_count ? 8 + binary : 0;
    if (20 + described + chunk > UINT32_MAX)
        return swarf_fail(SWARF_ERROR_ARGUMENT, "mesh: %zu bytes are more than a .glb file can count",
                          20 + described + chunk);
    put_u32(&o, 0x46546c67);
    put_u32(&o, 2);
    put_u32(&o, (uint32_t)(20 + described + chunk));
    put_u32(&o, (uint32_t)described);
    put_u32(&o, 0x4e4f534a);
    fwrite(o.bytes, 4, o.used, stream);
    o.used = 0;
    fwrite(json, 1, described, stream);
    if (chunk == 0) return swarf_progress_report(progress, 1);
    put_u32(&o, (uint32_t)binary);
    put_u32(&o, 0x004e4942);
    for (size_t i = 0; i < 3 * t->vertex_count; i++) put_f32(&o, t->xyz[i]);
    SWARF_TRY(swarf_progress_report(progress, 0.4));
    for (size_t i = 0; p->vertex_rgb && i < t->vertex_count; i++) {
        const uint8_t *c = p->vertex_rgb + 3 * i;
        put_u32(&o, (uint32_t)c[0] | (uint32_t)c[1] << 8 | (uint32_t)c[2] << 16 | 0xff000000u);
    }
    for (size_t i = 0; i < 3 * t->triangle_count; i++) put_u32(&o, t->index[i]);
    fwrite(o.bytes, 4, o.used, stream);
    return swarf_progress_report(progress, 1);
}

swarf_status swarf_gltf_write(const swarf_triangles *t, const uint8_t *rgb, FILE *stream,
                              const swarf_progress *progress)
{
    swarf_painted painted;
    SWARF_TRY(swarf_painted_create(t, rgb, &painted));
    const swarf_status status = write_all(&painted, stream, progress);
    swarf_painted_free(&painted);
    return status;
}
