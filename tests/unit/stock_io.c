/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* .vdb files: out and in again without a change; cut short or damaged anywhere, they are refused without harm. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "test.h"

static char folder[] = "/tmp/swarf-io-XXXXXX";

static const char *in_folder(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void put(const char *name, const unsigned char *data, size_t length)
{
    FILE *file = fopen(in_folder(name), "wb");
    if (!CHECK(file != NULL)) return;
    CHECK(fwrite(data, 1, length, file) == length);
    fclose(file);
}

static unsigned char *get(const char *name, size_t *length)
{
    FILE *file = fopen(in_folder(name), "rb");
    if (!CHECK(file != NULL)) return NULL;
    fseek(file, 0, SEEK_END);
    *length = (size_t)ftell(file);
    rewind(file);
    unsigned char *data = malloc(*length);
    CHECK(data && fread(data, 1, *length, file) == *length);
    fclose(file);
    return data;
}

static swarf_stock *make_stock(double voxel)
{
    const double base[3] = {1, 2, 3}, axis[3] = {0, 3, 4};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    swarf_stock *stock = NULL;
    CHECK_OK(swarf_stock_create_cylinder(base, axis, 2, &options, &stock));
    return stock;
}

static void check_round_trip(void)
{
    swarf_stock *stock = make_stock(0.1), *back = NULL;
    if (!stock) return;
    CHECK_OK(swarf_stock_write(stock, in_folder("a.vdb"), NULL));
    if (CHECK_OK(swarf_stock_read(in_folder("a.vdb"), NULL, &back))) {
        uint64_t one, two;
        double volume, volume_back;
        CHECK_OK(swarf_stock_hash(stock, &one));
        CHECK_OK(swarf_stock_hash(back, &two));
        CHECK(one == two);
        CHECK_OK(swarf_stock_volume(stock, &volume));
        CHECK_OK(swarf_stock_volume(back, &volume_back));
        CHECK_NEAR(volume, volume_back, 1e-12 * volume);
        CHECK_NEAR(swarf_stock_voxel(back), 0.1, 1e-12);
        const double point[3] = {1.5, 3, 5};
        float here, there;
        CHECK_OK(swarf_stock_sample(stock, point, 1, &here));
        CHECK_OK(swarf_stock_sample(back, point, 1, &there));
        CHECK_NEAR(here, there, 1e-6);
        CHECK_OK(swarf_stock_boolean(back, stock, SWARF_DIFFERENCE)); /* the voxels coincide */
        CHECK_OK(swarf_stock_write(back, in_folder("empty.vdb"), NULL));
        swarf_stock_destroy(back);
        back = NULL;
        if (CHECK_OK(swarf_stock_read(in_folder("empty.vdb"), NULL, &back))) swarf_stock_destroy(back);
    }
    swarf_stock_destroy(stock);
}

static int stop(void *user, double fraction)
{
    (void)user;
    (void)fraction;
    return 1;
}

static void check_refusals(void)
{
    swarf_stock *stock = make_stock(0.5), *back = NULL;
    if (!stock) return;
    CHECK_FAILS(swarf_stock_read(in_folder("none.vdb"), NULL, &back), SWARF_ERROR_IO, "none.vdb");
    CHECK_FAILS(swarf_stock_read(folder, NULL, &back), SWARF_ERROR_IO, "not a file");
    CHECK_FAILS(swarf_stock_read(NULL, NULL, &back), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_write(stock, "/nowhere/a.vdb", NULL), SWARF_ERROR_IO, "/nowhere/a.vdb");
    CHECK_FAILS(swarf_stock_write(stock, "", NULL), SWARF_ERROR_ARGUMENT, NULL);
    CHECK_FAILS(swarf_stock_write(NULL, in_folder("b.vdb"), NULL), SWARF_ERROR_ARGUMENT, NULL);
    put("text.vdb", (const unsigned char *)"hello, this is no grid", 22);
    CHECK_FAILS(swarf_stock_read(in_folder("text.vdb"), NULL, &back), SWARF_ERROR_FORMAT, "not a .vdb file");
    put("zero.vdb", (const unsigned char *)"", 0);
    CHECK_FAILS(swarf_stock_read(in_folder("zero.vdb"), NULL, &back), SWARF_ERROR_FORMAT, "zero.vdb");
    put("zip.vdb", (const unsigned char *)"\x1f\x8b\x08\0\0\0\0\0\0\0", 10);
    CHECK_FAILS(swarf_stock_read(in_folder("zip.vdb"), NULL, &back), SWARF_ERROR_FORMAT, "gzip");
    mkdir(in_folder("closed"), 0555);
    if (geteuid() != 0) /* root may write anywhere */
        CHECK_FAILS(swarf_stock_write(stock, in_folder("closed/a.vdb"), NULL), SWARF_ERROR_IO, "closed/a.vdb");
    CHECK(back == NULL);
    swarf_stock_destroy(stock);
    /* cancelling keeps the file that was there */
    stock = make_stock(0.02);
    put("old.vdb", (const unsigned char *)"old", 3);
    const swarf_progress progress = {stop, NULL};
    if (stock) CHECK_FAILS(swarf_stock_write(stock, in_folder("old.vdb"), &progress), SWARF_ERROR_CANCELLED, NULL);
    size_t length = 0;
    free(get("old.vdb", &length));
    CHECK(length == 3);
    if (stock) CHECK_OK(swarf_stock_write(stock, in_folder("old.vdb"), NULL));
    CHECK_FAILS(swarf_stock_read(in_folder("old.vdb"), &progress, &back), SWARF_ERROR_CANCELLED, NULL);
    swarf_stock_destroy(stock);
}

/* Cut at every kind of place: refused, never a crash. */
static void check_truncation(void)
{
    swarf_stock *stock = make_stock(0.5);
    if (!stock) return;
    CHECK_OK(swarf_stock_write(stock, in_folder("c.vdb"), NULL));
    swarf_stock_destroy(stock);
    size_t length = 0;
    unsigned char *data = get("c.vdb", &length);
    for (int i = 0; data && i < 300; i++) {
        const size_t cut = i < 200 ? (size_t)i * length / 200 : length - (size_t)(i - 199);
        put("d.vdb", data, cut);
        swarf_stock *back = NULL;
        CHECK_FAILS(swarf_stock_read(in_folder("d.vdb"), NULL, &back), SWARF_ERROR_FORMAT, "d.vdb");
    }
    free(data);
}

/* Where the first `text` ends in the data. */
static size_t behind(const unsigned char *data, size_t length, const char *text)
{
    const size_t size = strlen(text);
    for (size_t at = 0; at + size <= length; at++)
        if (memcmp(data + at, text, size) == 0) return at + size;
    CHECK(!"the text is in the file");
    return 0;
}

/* The file with `count` bytes of `value` at `at` is refused for that reason. */
static void check_patch(unsigned char *data, size_t length, size_t at, const void *value, size_t count,
                        const char *part)
{
    unsigned char kept[16];
    if (!CHECK(at + count <= length && count <= sizeof kept)) return;
    memcpy(kept, data + at, count);
    memcpy(data + at, value, count);
    put("e.vdb", data, length);
    memcpy(data + at, kept, count);
    swarf_stock *back = NULL;
    CHECK_FAILS(swarf_stock_read(in_folder("e.vdb"), NULL, &back), SWARF_ERROR_FORMAT, part);
    swarf_stock_destroy(back);
}

enum { MAP = 18 * 8, ROOT = 16, PLACE = 12, MASKS = 2 * 32 * 32 * 32 / 8 };

/* Each field that OpenVDB would follow blindly, and what else must have an error of its own. */
static void check_fields(unsigned char *data, size_t length)
{
    const double nan_number = NAN;
    const float infinite = INFINITY;
    const uint32_t none = 0, two = 2, many = 0x7fffffff, old = 221;
    const int64_t overrun = -200000, underrun = -1, huge = (int64_t)1 << 40, least = INT64_MIN;
    const size_t grid = behind(data, length, "stock") - 9 - 4;
    const size_t map = behind(data, length, "UniformScaleTranslateMap"), root = map + MAP, node = root + ROOT + PLACE;
    const unsigned char ones[2] = {0xff, 0xff};
    check_patch(data, length, 8, &old, 4, "format 221");
    check_patch(data, length, grid, &none, 4, "no grids");
    check_patch(data, length, grid, &many, 4, "cut short");
    check_patch(data, length, behind(data, length, "Tree_float_5_4_") - 3, "5", 1, "no level set");
    check_patch(data, length, behind(data, length, "level set") - 3, "fog", 3, "no level set");
    check_patch(data, length, map, &nan_number, 8, "expected a finite number of the map");
    check_patch(data, length, map - 4, "Mop", 3, "expected a type of map");
    check_patch(data, length, root, &two, 4, "expected 1 buffer");
    check_patch(data, length, root + 4, &infinite, 4, "expected a finite background");
    check_patch(data, length, root + 8, &many, 4, "more than the file holds");
    check_patch(data, length, root + 12, &many, 4, "more than the file holds");
    check_patch(data, length, root + ROOT, &two, 4, "expected a multiple of 4096");
    check_patch(data, length, node + MASKS, ones, 1, "expected a kind of inactive values");
    check_patch(data, length, node + MASKS + 1, &overrun, 8, "expected a plain chunk");
    check_patch(data, length, node + MASKS + 1, &underrun, 8, "expected a plain chunk");
    check_patch(data, length, node + MASKS + 1, &least, 8, "expected a plain chunk");
    check_patch(data, length, node + MASKS + 1, &huge, 8, "expected a packed chunk");
}

/* A bit of every byte turned over (of every 16th of the 8 KiB of masks): a stock or an error, and never harm. */
static void check_bits(unsigned char *data, size_t length)
{
    test_random random = test_random_begin(11);
    const size_t masks = behind(data, length, "UniformScaleTranslateMap") + MAP + ROOT + PLACE;
    size_t refused = 0, tried = 0;
    for (size_t at = 0; at < length; at += at >= masks && at < masks + MASKS ? 16 : 1) {
        const unsigned char kept = data[at];
        data[at] ^= (unsigned char)(1u << test_random_below(&random, 8));
        put("f.vdb", data, length);
        data[at] = kept;
        tried++;
        swarf_stock *back = NULL;
        const swarf_status status = swarf_stock_read(in_folder("f.vdb"), NULL, &back);
        CHECK(status == SWARF_ERROR_FORMAT || status == SWARF_ERROR_MEMORY ? back == NULL : status == SWARF_OK);
        if (status != SWARF_OK) {
            refused++;
            CHECK(strstr(swarf_error_last(), "f.vdb") != NULL);
        } else {
            double volume;
            CHECK_OK(swarf_stock_volume(back, &volume));
            CHECK(isfinite(volume));
        }
        swarf_stock_destroy(back);
    }
    CHECK(refused > tried / 10 && refused < tried);
}

static void check_damage(void)
{
    swarf_stock *stock = make_stock(1);
    if (!stock) return;
    CHECK_OK(swarf_stock_write(stock, in_folder("g.vdb"), NULL));
    swarf_stock_destroy(stock);
    size_t length = 0;
    unsigned char *data = get("g.vdb", &length);
    if (data && CHECK(length > MAP + ROOT + PLACE + MASKS)) {
        check_fields(data, length);
        check_bits(data, length);
    }
    free(data);
}

int main(void)
{
    if (!CHECK(mkdtemp(folder) != NULL)) return test_end();
    check_round_trip();
    check_refusals();
    check_truncation();
    check_damage();
    char command[64];
    snprintf(command, sizeof command, "rm -r %s", folder);
    CHECK(system(command) == 0);
    return test_end();
}
