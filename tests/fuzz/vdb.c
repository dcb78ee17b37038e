/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The .vdb reader on any bytes: a stock that can be measured and meshed, or an error.
 * The corpus: a round bar (d 2, l 2, voxel 1) in the packings that OpenVDB writes (NAME_all: without the mask of
 * active values), as a stream without positions, with tiles in the root, between grids of other kinds; and no bar. */
#include <stdlib.h>
#include <sys/types.h>
#include <unistd.h>

#include "swarf/swarf.h"

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size)
{
    char path[] = "/tmp/swarf-fuzz-XXXXXX.vdb";
    const int file = mkstemps(path, 4);
    if (file < 0 || write(file, data, size) != (ssize_t)size) abort();
    close(file);
    swarf_stock *stock = NULL;
    const swarf_status status = swarf_stock_read(path, NULL, &stock);
    unlink(path);
    if ((status == SWARF_OK) != (stock != NULL)) abort();
    if (status != SWARF_OK && status != SWARF_ERROR_FORMAT && status != SWARF_ERROR_MEMORY) abort();
    if (stock) {
        double volume;
        swarf_mesh *mesh = NULL;
        if (swarf_stock_volume(stock, &volume) != SWARF_OK) abort();
        (void)swarf_mesh_create_stock(stock, 0, NULL, &mesh); /* a damaged field need not have a closed surface */
        swarf_mesh_release(mesh);
    }
    swarf_stock_destroy(stock);
    return 0;
}
