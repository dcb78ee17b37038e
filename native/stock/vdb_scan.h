/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A walk over a .vdb file before OpenVDB reads from it: OpenVDB fills buffers by lengths that it has not checked. */
#ifndef SWARF_STOCK_VDB_SCAN_H
#define SWARF_STOCK_VDB_SCAN_H

#include "swarf/base.h"

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How the values of a grid are kept; OpenVDB's own bits. */
enum { SWARF_VDB_ZIP = 1, SWARF_VDB_ACTIVE_MASK = 2, SWARF_VDB_BLOSC = 4 };

/** A level set of floats in a file, and what OpenVDB must be told to read it from its transform on. */
typedef struct swarf_vdb_place {
    uint64_t transform;                    /**< byte where its transform starts; its tree follows */
    uint64_t end;                          /**< byte behind its last leaf */
    uint32_t format;                       /**< of the file, 222 to 225 */
    uint32_t library_major, library_minor; /**< OpenVDB that wrote it */
    uint32_t compression;                  /**< SWARF_VDB_ bits */
    int half;                              /**< values are half floats */
} swarf_vdb_place;

/** Find the first level set of floats (trees of depth 5-4-3, no instance of another grid) in the `size` bytes of the
 *  file and check everything of it that OpenVDB relies on: each count and length against the file and against what a
 *  node holds, masks, order and places of nodes, chunks of inner nodes unpacked. Only the bodies of leaves' chunks are
 *  left; their decompressors are bounded. SWARF_ERROR_FORMAT names file, byte and what was expected there. */
swarf_status swarf_vdb_scan(FILE *file, uint64_t size, const char *path, swarf_vdb_place *out);

/** Unpack a chunk (8 bytes of length and its body; `chunk_bytes` in all) as OpenVDB does and forget the result.
 *  SWARF_ERROR_FORMAT when that does not give `bytes` bytes. */
swarf_status swarf_vdb_unpack(const void *chunk, size_t chunk_bytes, uint32_t compression, size_t bytes);

#ifdef __cplusplus
}
#endif
#endif
