/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Colours of triangles, for formats that know them otherwise. */
#ifndef SWARF_MESH_COLOURS_H
#define SWARF_MESH_COLOURS_H

#include "swarf/base.h"

/** Triangles whose vertices are split where colours meet; without colours a view of what came in. */
typedef struct swarf_painted {
    swarf_triangles triangles;
    uint8_t *vertex_rgb; /* 3 per vertex, NULL without colours */
    float *xyz;
    uint32_t *index;
} swarf_painted;

swarf_status swarf_painted_create(const swarf_triangles *triangles, const uint8_t *rgb, swarf_painted *out);
void swarf_painted_free(swarf_painted *painted);

/** The different colours among `count` (3 bytes each), ascending, as 0xRRGGBB; freed by the caller with free(). */
swarf_status swarf_palette(const uint8_t *rgb, size_t count, uint32_t **out, size_t *colours);
/** Place of a colour in a palette that holds it. */
size_t swarf_palette_find(const uint32_t *palette, size_t colours, const uint8_t rgb[3]);

#endif
