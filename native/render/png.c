/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Pictures to PNG files. libpng reports errors by longjmp: between setjmp and the end only plain C runs. */
#include "base/file.h"
#include "base/status.h"
#include "swarf/render.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <string.h>

static void keep_error(png_structp png, png_const_charp text)
{
    snprintf(png_get_error_ptr(png), 160, "%s", text);
    png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

/** Everything between setjmp and the end; 0 when libpng jumped out, with its text. */
static int encode(png_structp png, png_infop info, FILE *stream, const uint8_t *rgba, int32_t width, int32_t height)
{
    if (setjmp(png_jmpbuf(png))) return 0;
    png_init_io(png, stream);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8, PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (int32_t row = 0; row < height; row++) png_write_row(png, rgba + 4 * (size_t)width * (size_t)row);
    png_write_end(png, info);
    return 1;
}

swarf_status swarf_picture_write(const char *path, const uint8_t *rgba, int32_t width, int32_t height)
{
    SWARF_REQUIRE(path && rgba, "picture: path or pixels missing");
    SWARF_REQUIRE(width >= 1 && width <= 16384 && height >= 1 && height <= 16384,
                  "picture: %d x %d pixels is not in 1 .. 16384", (int)width, (int)height);
    swarf_file_writer writer;
    SWARF_TRY(swarf_file_begin(path, &writer));
    char text[160] = "";
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, text, keep_error, ignore_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info) {
        png_destroy_write_struct(&png, NULL);
        swarf_file_abandon(&writer);
        return swarf_fail(SWARF_ERROR_MEMORY, "%s: out of memory for libpng", path);
    }
    errno = 0;
    const int done = encode(png, info, writer.stream, rgba, width, height);
    const char *const reason = errno ? strerror(errno) : text; /* the system's word says more than libpng's */
    png_destroy_write_struct(&png, &info);
    if (done) return swarf_file_commit(&writer);
    const swarf_status status = swarf_fail(SWARF_ERROR_IO, "%s: cannot write: %s", path, reason);
    swarf_file_abandon(&writer);
    return status;
}
