/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* 3MF files as lib3mf, the reader of the consortium that wrote the specification, sees them: without a warning, the
 * same vertices and triangles, closed, with a colour for each triangle where there are any. */
#include <cstdlib>
#include <cstring>
#include <string>
#include <unistd.h>
#include <vector>

#include <Model/COM/NMR_DLLInterfaces.h>

extern "C" {
#include "shapes.h"
#include "test.h"
}

using namespace NMR;

static PLib3MFModelMeshObject *read(const std::string &path, PLib3MFModel *model)
{
    PLib3MFModelReader *reader = nullptr;
    PLib3MFModelResourceIterator *objects = nullptr;
    PLib3MFModelResource *object = nullptr;
    BOOL any = 0;
    DWORD warnings = 1;
    CHECK(lib3mf_model_queryreader(model, "3mf", &reader) == 0);
    CHECK(lib3mf_reader_readfromfileutf8(reader, path.c_str()) == 0);
    CHECK(lib3mf_reader_getwarningcount(reader, &warnings) == 0 && warnings == 0);
    CHECK(lib3mf_model_getmeshobjects(model, &objects) == 0);
    CHECK(lib3mf_resourceiterator_movenext(objects, &any) == 0);
    if (any) CHECK(lib3mf_resourceiterator_getcurrent(objects, &object) == 0);
    lib3mf_release(objects);
    lib3mf_release(reader);
    return object;
}

static void check_file(const std::string &path, const swarf_mesh *mesh, const uint8_t *rgb)
{
    PLib3MFModel *model = nullptr;
    if (!CHECK(lib3mf_createmodel(&model) == 0)) return;
    PLib3MFModelMeshObject *object = read(path, model);
    const swarf_triangles t = swarf_mesh_triangles(mesh);
    if (CHECK((object != nullptr) == (t.triangle_count > 0)) && object) {
        DWORD vertices = 0, triangles = 0;
        BOOL closed = 0;
        CHECK(lib3mf_meshobject_getvertexcount(object, &vertices) == 0 && vertices == t.vertex_count);
        CHECK(lib3mf_meshobject_gettrianglecount(object, &triangles) == 0 && triangles == t.triangle_count);
        CHECK(lib3mf_meshobject_ismanifoldandoriented(object, &closed) == 0 && closed);
        std::vector<MODELMESHVERTEX> points(t.vertex_count);
        std::vector<MODELMESHTRIANGLE> corners(t.triangle_count);
        CHECK(lib3mf_meshobject_getvertices(object, points.data(), vertices, nullptr) == 0);
        CHECK(lib3mf_meshobject_gettriangleindices(object, corners.data(), triangles, nullptr) == 0);
        CHECK(std::memcmp(points.data(), t.xyz, 12 * t.vertex_count) == 0);
        CHECK(std::memcmp(corners.data(), t.index, 12 * t.triangle_count) == 0);
        PLib3MFPropertyHandler *colours = nullptr;
        CHECK(lib3mf_meshobject_createpropertyhandler(object, &colours) == 0);
        for (DWORD i = 0; rgb && i < triangles; i++) {
            MODELMESH_TRIANGLECOLOR_SRGB color;
            std::memset(&color, 0, sizeof color);
            CHECK(lib3mf_propertyhandler_getcolor(colours, i, &color) == 0);
            CHECK(color.m_Colors[0].m_Red == rgb[3 * i] && color.m_Colors[0].m_Green == rgb[3 * i + 1] &&
                  color.m_Colors[0].m_Blue == rgb[3 * i + 2]);
        }
        lib3mf_release(colours);
        lib3mf_release(object);
    }
    lib3mf_release(model);
}

static void check_shape(shape *s, const std::string &folder)
{
    const swarf_triangles triangles = shape_view(s);
    swarf_mesh *mesh = nullptr;
    const std::string path = folder + "/part.3mf";
    if (!CHECK_OK(swarf_mesh_create(&triangles, &mesh))) return;
    std::vector<uint8_t> rgb;
    for (size_t i = 0; i < 3 * triangles.triangle_count; i++) rgb.push_back(static_cast<uint8_t>(37 * i));
    CHECK_OK(swarf_mesh_write(mesh, path.c_str(), nullptr));
    check_file(path, mesh, nullptr);
    CHECK_OK(swarf_mesh_write_coloured(mesh, rgb.data(), triangles.triangle_count, path.c_str(), nullptr));
    check_file(path, mesh, rgb.data());
    swarf_mesh_release(mesh);
    unlink(path.c_str());
}

int main()
{
    char folder[] = "/tmp/swarf-3mf-XXXXXX";
    if (!mkdtemp(folder)) return 1;
    shape s = {};
    check_shape(&s, folder); /* nothing */
    const double lo[3] = {-1234.5, 1e-4, 0}, hi[3] = {2, 3, 4};
    shape_box(&s, lo, hi);
    check_shape(&s, folder);
    shape_ball(&s, lo, 3.3, 20);
    check_shape(&s, folder);
    shape_free(&s);
    rmdir(folder);
    return test_end();
}
