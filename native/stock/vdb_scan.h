/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A look at a .vdb file before OpenVDB reads it. */
#ifndef SWARF_STOCK_VDB_SCAN_H
#define SWARF_STOCK_VDB_SCAN_H

#include "swarf/base.h"

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Check that the lengths of all names and metadata fit in the `size` bytes of the file: OpenVDB allocates and fills
 *  what such a length says, up to 4 GiB, before it finds the file shorter. Leaves the file at its start.
 *  SWARF_ERROR_FORMAT names what does not fit. Files of versions before 222 (2012) are refused. */
swarf_status swarf_vdb_scan(FILE *file, uint64_t size, const char *path);

#ifdef __cplusplus
}
#endif
#endif
