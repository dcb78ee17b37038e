/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A ZIP archive written as it comes, one deflated entry after the other. By hand, over zlib: libarchive would bring
 * libxml2 and others into FreeCAD's process, which may have loaded versions of its own. */
#ifndef SWARF_MESH_ZIP_H
#define SWARF_MESH_ZIP_H

#include "swarf/base.h"

#include <stdio.h>

typedef struct swarf_zip swarf_zip;

/** To a stream that can be sought in; its write errors are the caller's to find. */
swarf_status swarf_zip_create(FILE *stream, swarf_zip **out);
/** Begin an entry; the one before ends. */
swarf_status swarf_zip_entry(swarf_zip *zip, const char *name);
/** SWARF_ERROR_ARGUMENT when an entry or the archive grows beyond 4 GiB. */
swarf_status swarf_zip_write(swarf_zip *zip, const void *data, size_t length);
/** End the last entry and write the directory. */
swarf_status swarf_zip_finish(swarf_zip *zip);
void swarf_zip_destroy(swarf_zip *zip);

#endif
