/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Meshes: from stocks, closed and the same for any number of threads; files round and round; what readers refuse. */
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "shapes.h"
#include "test.h"

static char folder[] = "/tmp/swarf-mesh-XXXXXX";

static const char *in_folder(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void put(const char *name, const void *data, size_t length)
{
    FILE *file = fopen(in_folder(name), "wb");
    if (CHECK(file != NULL)) {
        CHECK(fwrite(data, 1, length, file) == length);
        fclose(file);
    }
}

static swarf_status read_text(const char *name, const char *text, swarf_mesh **out)
{
    put(name, text, strlen(text));
    return swarf_mesh_read(in_folder(name), out);
}

static void check_object(void)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {2, 3, 4};
    shape box = {0};
    shape_box(&box, lo, hi);
    const swarf_triangles triangles = shape_view(&box);
    swarf_mesh *mesh = NULL;
    if (CHECK_OK(swarf_mesh_create(&triangles, &mesh))) {
        shape_flip(&box, 0); /* it is a copy */
        CHECK(swarf_mesh_retain(mesh) == mesh);
        swarf_mesh_release(mesh);
        const swarf_topology topology = swarf_mesh_topology(mesh);
        CHECK(topology.closed);
        CHECK_NEAR(topology.volume_mm3, 24, 1e-9);
        CHECK_NEAR(topology.area_mm2, 52, 1e-9);
        CHECK(swarf_mesh_triangles(mesh).triangle_count == 12);
        swarf_mesh_release(mesh);
    }
    swarf_mesh_release(NULL);
    box.index[7] = 8;
    CHECK_FAILS(swarf_mesh_create(&triangles, &mesh), SWARF_ERROR_ARGUMENT, "vertex 8");
    CHECK_FAILS(swarf_mesh_create(NULL, &mesh), SWARF_ERROR_ARGUMENT, NULL);
    shape_free(&box);
}

/* Writing through links replaces what they lead to and leaves them links. */
static void check_links(const swarf_mesh *mesh)
{
    struct stat info;
    CHECK(mkdir(in_folder("sub"), 0700) == 0);
    CHECK(symlink("sub/real.stl", in_folder("first.stl")) == 0);
    CHECK(symlink("first.stl", in_folder("second.stl")) == 0);
    for (int round = 0; round < 2; round++) { /* once made, once replaced */
        CHECK_OK(swarf_mesh_write(mesh, in_folder("second.stl"), NULL));
        CHECK(lstat(in_folder("second.stl"), &info) == 0 && S_ISLNK(info.st_mode));
        CHECK(lstat(in_folder("first.stl"), &info) == 0 && S_ISLNK(info.st_mode));
        CHECK(lstat(in_folder("sub/real.stl"), &info) == 0 && S_ISREG(info.st_mode));
    }
    CHECK(symlink("ring.stl", in_folder("ring.stl")) == 0);
    CHECK_FAILS(swarf_mesh_write(mesh, in_folder("ring.stl"), NULL), SWARF_ERROR_IO, "ring.stl");
}

/* Every format brings back the same floats; STL renumbers the vertices. */
static void check_round_trips(void)
{
    test_random random = test_random_begin(3);
    const double centre[3] = {test_random_in(&random, -9, 9), 1e-4, -1234.5};
    shape ball = {0};
    shape_ball(&ball, centre, test_random_in(&random, 1, 9), 20);
    const swarf_triangles triangles = shape_view(&ball);
    swarf_mesh *mesh = NULL;
    if (!CHECK_OK(swarf_mesh_create(&triangles, &mesh))) return;
    static const char *const names[] = {"a.stl", "a.PLY", "a.obj"};
    for (int i = 0; i < 3; i++) {
        swarf_mesh *back = NULL;
        CHECK_OK(swarf_mesh_write(mesh, in_folder(names[i]), NULL));
        if (!CHECK_OK(swarf_mesh_read(in_folder(names[i]), &back))) continue;
        const swarf_triangles view = swarf_mesh_triangles(back);
        CHECK(view.vertex_count == triangles.vertex_count);
        CHECK(view.triangle_count == triangles.triangle_count);
        CHECK(swarf_mesh_topology(back).closed);
        int same = view.triangle_count == triangles.triangle_count;
        for (size_t k = 0; same && k < 3 * view.triangle_count; k++)
            same =
                memcmp(view.xyz + 3 * (size_t)view.index[k], triangles.xyz + 3 * (size_t)triangles.index[k], 12) == 0;
        CHECK(same);
        swarf_mesh_release(back);
    }
    CHECK_FAILS(swarf_mesh_write(mesh, in_folder("a.step"), NULL), SWARF_ERROR_ARGUMENT, ".obj, .3mf or .glb");
    CHECK_FAILS(swarf_mesh_write(mesh, "/nowhere/a.stl", NULL), SWARF_ERROR_IO, "/nowhere/a.stl");
    CHECK_FAILS(swarf_mesh_write(NULL, in_folder("a.stl"), NULL), SWARF_ERROR_ARGUMENT, NULL);
    check_links(mesh);
    swarf_mesh_release(mesh);
    shape_free(&ball);
}

static void check_text_formats(void)
{
    swarf_mesh *mesh = NULL;
    static const char stl[] = "solid one\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
                              "   vertex 0 1.5e0 0\n  endloop\n endfacet\nendsolid one\n";
    if (CHECK_OK(read_text("t.stl", stl, &mesh))) {
        CHECK(swarf_mesh_triangles(mesh).triangle_count == 1);
        CHECK_NEAR(swarf_mesh_topology(mesh).area_mm2, 0.75, 1e-9);
        swarf_mesh_release(mesh);
    }
    static const char ply[] =
        "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement vertex 4\r\nproperty uchar red\r\nproperty double x\r\n"
        "property float y\r\nproperty float z\r\nelement face 1\r\nproperty list uchar int vertex_index\r\n"
        "end_header\r\n255 0 0 0\r\n255 1 0 0\r\n255 1 1 0\r\n255 0 1 0\r\n4 0 1 2 3\r\n";
    if (CHECK_OK(read_text("t.ply", ply, &mesh))) {
        CHECK(swarf_mesh_triangles(mesh).triangle_count == 2);
        CHECK_NEAR(swarf_mesh_topology(mesh).area_mm2, 1, 1e-9);
        swarf_mesh_release(mesh);
    }
    static const char obj[] =
        "# x\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nvn 0 0 1\nf 1//1 2//1 3//1\nv 0 1 0\nf -4 -2 -1\n";
    if (CHECK_OK(read_text("t.obj", obj, &mesh))) {
        CHECK_NEAR(swarf_mesh_topology(mesh).area_mm2, 1, 1e-9);
        swarf_mesh_release(mesh);
    }
    /* lines that end with CR alone */
    char old[sizeof stl];
    for (size_t i = 0; i < sizeof stl; i++) old[i] = stl[i] == '\n' ? '\r' : stl[i];
    if (CHECK_OK(read_text("t.stl", old, &mesh))) {
        CHECK_NEAR(swarf_mesh_topology(mesh).area_mm2, 0.75, 1e-9);
        swarf_mesh_release(mesh);
    }
    CHECK_FAILS(read_text("t.stl", "solid a\rfacet normal 0 0 1\router loop\rvertex 0 0 zero\r", &mesh),
                SWARF_ERROR_FORMAT, "t.stl:4: 'zero'");
    /* big-endian PLY: the numbers 1, 2, 3 and a face */
    static const char head[] =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty short y\n"
        "property char z\nelement face 1\nproperty list uchar ushort vertex_indices\nend_header\n";
    static const unsigned char body[] = {0x3f, 0x80, 0, 0, 0, 2, 3, 0, 0, 0, 0, 0xff, 0xfe, 0,
                                         0,    0,    0, 0, 0, 0, 0, 3, 0, 0, 0, 1,    0,    2};
    char whole[sizeof head + sizeof body];
    memcpy(whole, head, sizeof head - 1);
    memcpy(whole + sizeof head - 1, body, sizeof body);
    put("b.ply", whole, sizeof head - 1 + sizeof body);
    if (CHECK_OK(swarf_mesh_read(in_folder("b.ply"), &mesh))) {
        const float *p = swarf_mesh_triangles(mesh).xyz;
        CHECK_NEAR(p[0], 1, 0);
        CHECK_NEAR(p[1], 2, 0);
        CHECK_NEAR(p[2], 3, 0);
        CHECK_NEAR(p[4], -2, 0);
        swarf_mesh_release(mesh);
    }
    put("b.ply", whole, sizeof head - 1 + sizeof body - 3);
    CHECK_FAILS(swarf_mesh_read(in_folder("b.ply"), &mesh), SWARF_ERROR_FORMAT, "face 1");
}

static void check_refusals(void)
{
    static const struct {
        const char *name, *text, *part;
    } cases[] = {
        {"e.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n", "e.stl:4: 'zero'"},
        {"e.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1e99\n", "e.stl:4: '1e99'"},
        {"e.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", "the line ends"},
        {"e.stl", "solid a\nfacet normal 0 0 1\n", "the file ends"},
        {"e.stl", "solid a\nfoo\n", "'foo'"},
        {"e.stl", "short", "header"},
        {"e.stl", "", "empty"},
        {"e.ply", "plx\n", "\"ply\""},
        {"e.ply",
         "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n"
         "end_header\n1 2 3\n",
         "e.ply:9"},
        {"e.ply", "ply\nformat ascii 1.0\nelement vertex -1\n", "e.ply:3: '-1'"},
        {"e.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "x, y and z"},
        {"e.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n", "end_header"},
        {"e.ply",
         "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face "
         "1\n"
         "property list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 7\n",
         "face 1 uses vertex 7"},
        {"e.obj", "v 0 0 0\nf 1 2 3\n", "e.obj:2: '2'"},
        {"e.obj", "v 0 0 0\nf 1 1\n", "three corners"},
        {"e.obj", "v 0 nan 0\n", "e.obj:1: 'nan'"},
        {"e.obj", "hello\n", "'hello'"},
        {"e.obj", "# nothing\n", "no vertices"},
    };
    swarf_mesh *mesh = NULL;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        CHECK_FAILS(read_text(cases[i].name, cases[i].text, &mesh), SWARF_ERROR_FORMAT, cases[i].part);
    unsigned char stl[134] = {0};
    stl[80] = stl[81] = stl[82] = stl[83] = 0xff;
    put("e.stl", stl, sizeof stl);
    CHECK_FAILS(swarf_mesh_read(in_folder("e.stl"), &mesh), SWARF_ERROR_FORMAT, "claims 4294967295 triangles");
    memset(stl + 80, 0, 4);
    stl[80] = 1;
    memset(stl + 96, 0xff, 12);
    put("e.stl", stl, sizeof stl);
    CHECK_FAILS(swarf_mesh_read(in_folder("e.stl"), &mesh), SWARF_ERROR_FORMAT, "triangle 1");
    unsigned char longer[134 + 50] = {0};
    longer[80] = 1;
    put("e.stl", longer, sizeof longer);
    CHECK_FAILS(swarf_mesh_read(in_folder("e.stl"), &mesh), SWARF_ERROR_FORMAT, "claims 1 triangles, 134 bytes");
    put("e.stl", longer, 137);
    CHECK_FAILS(swarf_mesh_read(in_folder("e.stl"), &mesh), SWARF_ERROR_FORMAT, "the file has 137");
    CHECK_FAILS(swarf_mesh_read(in_folder("none.stl"), &mesh), SWARF_ERROR_IO, "none.stl");
    CHECK_FAILS(swarf_mesh_read(folder, &mesh), SWARF_ERROR_IO, "folder");
    CHECK(mesh == NULL);
}

static int stop(void *user, double fraction)
{
    (void)fraction;
    return ++*(int *)user >= 2;
}

static void check_from_stock(void)
{
    const double base[3] = {0.03, 0.02, 0.01}, axis[3] = {6, 5, 4};
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = 0.1;
    swarf_stock *stock = NULL;
    if (!CHECK_OK(swarf_stock_create_cylinder(base, axis, 3, &options, &stock))) return;
    const double exact = 3.14159265358979323846 * 9 * sqrt(77);
    swarf_mesh *first = NULL;
    for (int threads = 1; threads <= 8; threads++) {
        CHECK_OK(swarf_threads_set(threads));
        swarf_mesh *mesh = NULL;
        if (!CHECK_OK(swarf_mesh_create_stock(stock, 0, NULL, &mesh))) continue;
        const swarf_topology topology = swarf_mesh_topology(mesh);
        CHECK(topology.closed && topology.boundary_edges == 0 && topology.nonmanifold_edges == 0);
        CHECK_NEAR(topology.volume_mm3, exact, 3e-3 * exact); /* the mesher rounds the edges of the ends off */
        if (!first) {
            first = mesh;
            continue;
        }
        CHECK(test_same_mesh(first, mesh));
        swarf_mesh_release(mesh);
    }
    CHECK_OK(swarf_threads_set(0));
    swarf_mesh_release(first);

    swarf_mesh *mesh = NULL;
    if (CHECK_OK(swarf_mesh_create_stock(stock, 0.5, NULL, &mesh))) {
        const swarf_topology topology = swarf_mesh_topology(mesh);
        CHECK(topology.closed);
        CHECK_NEAR(topology.volume_mm3, exact, 2e-2 * exact);
        swarf_mesh_release(mesh);
    }
    CHECK_FAILS(swarf_mesh_create_stock(stock, 2, NULL, &mesh), SWARF_ERROR_ARGUMENT, "adaptivity");
    CHECK_FAILS(swarf_mesh_create_stock(NULL, 0, NULL, &mesh), SWARF_ERROR_ARGUMENT, NULL);
    int calls = 0;
    const swarf_progress progress = {stop, &calls};
    CHECK_OK(swarf_progress_interval_set(0));
    CHECK_FAILS(swarf_mesh_create_stock(stock, 0, &progress, &mesh), SWARF_ERROR_CANCELLED, NULL);
    if (CHECK_OK(swarf_stock_boolean(stock, stock, SWARF_DIFFERENCE)) &&
        CHECK_OK(swarf_mesh_create_stock(stock, 0, NULL, &mesh))) {
        CHECK(swarf_mesh_triangles(mesh).triangle_count == 0);
        CHECK_OK(swarf_mesh_write(mesh, in_folder("empty.stl"), NULL));
        swarf_mesh_release(mesh);
    }
    swarf_stock_destroy(stock);
}

int main(void)
{
    if (!CHECK(mkdtemp(folder) != NULL)) return test_end();
    setlocale(LC_ALL, "de_DE.UTF-8"); /* decimal commas where the system has them */
    check_object();
    check_round_trips();
    check_text_formats();
    check_refusals();
    check_from_stock();
    char command[64];
    snprintf(command, sizeof command, "rm -r %s", folder);
    CHECK(system(command) == 0);
    return test_end();
}
