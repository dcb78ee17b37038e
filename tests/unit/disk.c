/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Files that cannot be written: a disk that fills up (a limit on the size of files stands for it, and /dev/full),
 * folders that are not there or are read-only, folders in the place of files. Each is one error that names the file;
 * what was there before stays, nothing half done is left beside it. */
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "test.h"

static char folder[] = "/tmp/swarf-disk-XXXXXX";
static const char *const kinds[] = {"stl", "ply", "obj", "3mf", "glb", "vdb", "png", "stream.stl"};
enum { KINDS = sizeof kinds / sizeof *kinds, SIDE = 64 };

static swarf_stock *stock;
static swarf_mesh *mesh;
static uint8_t pixels[4 * SIDE * SIDE];

static swarf_status write_kind(int kind, const char *path)
{
    const swarf_contour_options options = swarf_contour_options_default();
    if (strcmp(kinds[kind], "vdb") == 0) return swarf_stock_write(stock, path, NULL);
    if (strcmp(kinds[kind], "png") == 0) return swarf_picture_write(path, pixels, SIDE, SIDE);
    if (strcmp(kinds[kind], "stream.stl") == 0) return swarf_mesh_stream(stock, &options, 1, path, NULL, NULL);
    return swarf_mesh_write(mesh, path, NULL);
}

static const char *in_folder(const char *format, int kind)
{
    static char path[256], name[64];
    snprintf(name, sizeof name, format, kinds[kind]);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int count_files(void)
{
    int count = 0;
    DIR *all = opendir(folder);
    while (all && readdir(all)) count++;
    if (all) closedir(all);
    return count - 2;
}

static void check_full(int kind)
{
    struct rlimit own, small;
    const char *path = in_folder("full.%s", kind);
    FILE *file = fopen(path, "wb");
    if (!CHECK(file != NULL)) return;
    fputs("before", file);
    fclose(file);
    const int files = count_files();
    static const rlim_t limits[] = {0, 100, 4096};
    CHECK(getrlimit(RLIMIT_FSIZE, &own) == 0);
    small = own;
    for (int i = 0; i < 3; i++) {
        small.rlim_cur = limits[i];
        CHECK(setrlimit(RLIMIT_FSIZE, &small) == 0);
        CHECK_FAILS(write_kind(kind, path), SWARF_ERROR_IO, "cannot write: File too large");
        CHECK(strstr(swarf_error_last(), path) != NULL);
        CHECK(setrlimit(RLIMIT_FSIZE, &own) == 0);
    }
    CHECK(count_files() == files);
    char text[8] = "";
    file = fopen(path, "rb");
    if (file) {
        CHECK(fread(text, 1, 7, file) == 6 && strcmp(text, "before") == 0);
        fclose(file);
    }
    CHECK_OK(write_kind(kind, path));
    CHECK(count_files() == files);
    CHECK(unlink(path) == 0);
}

/* A device is written to and never replaced. */
static void check_device(int kind)
{
    struct stat info;
    if (stat("/dev/full", &info) != 0 || !S_ISCHR(info.st_mode)) {
        if (kind == 0) printf("no /dev/full here: not looked at\n");
        return;
    }
    const char *path = in_folder("device.%s", kind);
    CHECK(symlink("/dev/full", path) == 0);
    CHECK_FAILS(write_kind(kind, path), SWARF_ERROR_IO, "No space left on device");
    CHECK(stat("/dev/full", &info) == 0 && S_ISCHR(info.st_mode));
    CHECK(lstat(path, &info) == 0 && S_ISLNK(info.st_mode));
    CHECK(unlink(path) == 0);
    CHECK(symlink("/dev/null", path) == 0);
    CHECK_OK(write_kind(kind, path));
    CHECK(stat("/dev/null", &info) == 0 && S_ISCHR(info.st_mode));
    CHECK(unlink(path) == 0);
}

static int reader = -1;

static int close_reader(void *context, double fraction)
{
    (void)context;
    if (fraction > 0.5 && reader >= 0) {
        close(reader);
        reader = -1;
    }
    return 0;
}

/* A pipe cannot go back to its count: it gets the whole mesh, byte for byte, however little memory there is. */
static void check_pipe(void)
{
    char path[64], file_path[64];
    static char piped[1 << 16], wanted[1 << 16]; /* no more than a pipe holds */
    snprintf(path, sizeof path, "%s/pipe.stl", folder);
    snprintf(file_path, sizeof file_path, "%s/file.stl", folder);
    swarf_contour_options options = swarf_contour_options_default();
    options.error_mm = 0.02;
    swarf_contour_report report;
    swarf_mesh *whole = NULL;
    CHECK(mkfifo(path, 0600) == 0);
    reader = open(path, O_RDONLY | O_NONBLOCK);
    if (!CHECK(reader >= 0) || !CHECK_OK(swarf_mesh_contour(stock, &options, NULL, &whole, &report))) return;
    if (CHECK(84 + 50 * report.triangles < sizeof piped) &&
        CHECK_OK(swarf_mesh_stream(stock, &options, 1, path, NULL, NULL))) {
        CHECK_OK(swarf_mesh_write(whole, file_path, NULL));
        FILE *file = fopen(file_path, "rb");
        const size_t length = file ? fread(wanted, 1, sizeof wanted, file) : 0;
        if (file) fclose(file);
        CHECK(length == 84 + 50 * report.triangles);
        CHECK(read(reader, piped, sizeof piped) == (ssize_t)length && memcmp(piped, wanted, length) == 0);
        CHECK(unlink(file_path) == 0);
    }
    const swarf_progress progress = {close_reader, NULL};
    CHECK_FAILS(swarf_mesh_stream(stock, &options, 1, path, &progress, NULL), SWARF_ERROR_IO, "Broken pipe");
    CHECK(unlink(path) == 0);
    swarf_mesh_release(whole);
}

static void check_folders(int kind)
{
    const char *path = in_folder("folder.%s", kind);
    CHECK(mkdir(path, 0700) == 0);
    CHECK_FAILS(write_kind(kind, path), SWARF_ERROR_IO, "is a folder");
    CHECK(rmdir(path) == 0);
    CHECK_FAILS(write_kind(kind, in_folder("none/part.%s", kind)), SWARF_ERROR_IO, "No such file or directory");
    if (geteuid() == 0) {
        if (kind == 0) printf("root may write to read-only folders: not looked at\n");
        return;
    }
    CHECK(chmod(folder, 0500) == 0);
    CHECK_FAILS(write_kind(kind, in_folder("part.%s", kind)), SWARF_ERROR_IO, "Permission denied");
    CHECK(chmod(folder, 0700) == 0);
    CHECK(count_files() == 0);
}

int main(void)
{
    const swarf_box box = {{0, 0, -4}, {20, 9, 0}};
    swarf_stock_options options = swarf_stock_options_default();
    const swarf_contour_options contour = swarf_contour_options_default();
    options.voxel_mm = 0.2;
    signal(SIGXFSZ, SIG_IGN); /* a file at its limit is an error, as on a full disk */
    signal(SIGPIPE, SIG_IGN); /* and so is a pipe that nobody reads any more */
    if (!mkdtemp(folder) || !CHECK_OK(swarf_stock_create_box(&box, &options, &stock)) ||
        !CHECK_OK(swarf_mesh_contour(stock, &contour, NULL, &mesh, NULL)))
        return test_end();
    test_random random = test_random_begin(5);
    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)test_random_below(&random, 256); /* not to be packed */
    for (int kind = 0; kind < KINDS; kind++) {
        check_full(kind);
        check_device(kind);
        check_folders(kind);
    }
    check_pipe();
    CHECK(count_files() == 0);
    swarf_mesh_release(mesh);
    swarf_stock_destroy(stock);
    CHECK(rmdir(folder) == 0);
    return test_end();
}
