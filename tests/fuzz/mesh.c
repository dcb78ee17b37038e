/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* STL, PLY and OBJ readers on any bytes: a mesh or an error. */
#include <stdlib.h>
#include <sys/types.h>
#include <unistd.h>

#include "swarf/swarf.h"

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size)
{
    static const char *const suffixes[] = {".stl", ".dat"}; /* named, or told by the content alone */
    for (int i = 0; i < 2; i++) {
        char path[] = "/tmp/swarf-fuzz-XXXXXX.xxx";
        for (int k = 0; k < 4; k++) path[22 + k] = suffixes[i][k];
        const int file = mkstemps(path, 4);
        if (file < 0 || write(file, data, size) != (ssize_t)size) abort();
        close(file);
        swarf_mesh *mesh = NULL;
        const swarf_status status = swarf_mesh_read(path, &mesh);
        if ((status == SWARF_OK) != (mesh != NULL)) abort();
        if (status != SWARF_OK && status != SWARF_ERROR_FORMAT && status != SWARF_ERROR_MEMORY) abort();
        unlink(path);
        swarf_mesh_release(mesh);
    }
    return 0;
}
