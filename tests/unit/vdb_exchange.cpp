/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Files between Swarf and plain OpenVDB, both ways: what another program reads of ours, and what we take of its. */
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetFilter.h>
#include <openvdb/tools/LevelSetPlatonic.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include <unistd.h>

extern "C" {
#include "test.h"
}
#include "swarf/swarf.h"

namespace {

constexpr double voxel = 0.2;
std::string folder;

std::string at(const char *name)
{
    return folder + "/" + name;
}

void write(const std::string &path, const openvdb::FloatGrid::Ptr &grid)
{
    openvdb::io::File file(path);
    file.write({grid});
    file.close();
}

/* A block of ours as OpenVDB sees it: class, transform, background, and the distance at every active voxel. */
void check_theirs()
{
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    const swarf_box box = {{1, -2, 0.5}, {11, 6, 7.5}};
    swarf_stock *stock = nullptr;
    CHECK_OK(swarf_stock_create_box(&box, &options, &stock));
    CHECK_OK(swarf_stock_write(stock, at("ours.vdb").c_str(), nullptr));
    swarf_stock_destroy(stock);

    openvdb::io::File file(at("ours.vdb"));
    file.open();
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("stock"));
    file.close();
    if (!CHECK(grid != nullptr)) return;
    CHECK(grid->getGridClass() == openvdb::GRID_LEVEL_SET);
    CHECK_NEAR(grid->voxelSize()[0], voxel, 1e-12);
    CHECK_NEAR(grid->background(), 3 * voxel, 1e-6);
    double worst = 0;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        const openvdb::Vec3d p = grid->indexToWorld(value.getCoord());
        double out2 = 0, in = -1e9;
        for (int k = 0; k < 3; k++) {
            const double d = std::fabs(p[k] - 0.5 * (box.lo[k] + box.hi[k])) - 0.5 * (box.hi[k] - box.lo[k]);
            out2 += d > 0 ? d * d : 0;
            in = std::fmax(in, d);
        }
        worst = std::fmax(worst, std::fabs(*value - (in > 0 ? std::sqrt(out2) : in)));
    }
    CHECK(grid->activeVoxelCount() > 10000);
    CHECK(worst < 1e-5);
    CHECK(grid->tree().getValue(openvdb::Coord::round(grid->worldToIndex(openvdb::Vec3d(6, 2, 4)))) < 0);
}

/* Spheres of theirs: half widths other than ours, and values kept as halves. */
void check_ours()
{
    const double radius = 5, exact = 4.0 / 3.0 * std::acos(-1.0) * radius * radius * radius;
    for (const float width : {2.0f, 3.0f, 5.0f})
        for (const bool half : {false, true}) {
            const auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
                static_cast<float>(radius), openvdb::Vec3f(1, 2, 3), static_cast<float>(voxel), width);
            grid->setSaveFloatAsHalf(half);
            write(at("sphere.vdb"), grid);
            swarf_stock *stock = nullptr;
            double volume = 0;
            if (!CHECK_OK(swarf_stock_read(at("sphere.vdb").c_str(), nullptr, &stock))) continue;
            CHECK_OK(swarf_stock_volume(stock, &volume));
            CHECK_NEAR(volume, exact, (half ? 1e-3 : 2e-4) * exact);
            swarf_stock_destroy(stock);
        }
}

/* What has no surface is refused: solid tiles alone, and a sphere that lost the leaf at one of its poles; and what is
 * so far away that its mesh would have all vertices in one point. */
void refuse(const char *what, const openvdb::FloatGrid::Ptr &grid, const char *why = "bare.vdb: not a narrow band")
{
    write(at("bare.vdb"), grid);
    swarf_stock *stock = nullptr;
    if (!CHECK_FAILS(swarf_stock_read(at("bare.vdb").c_str(), nullptr, &stock), SWARF_ERROR_FORMAT, why))
        std::printf("    %s\n", what);
    swarf_stock_destroy(stock);
}

void check_refusals()
{
    const float band = 3 * static_cast<float>(voxel);
    auto grid = openvdb::createLevelSet<openvdb::FloatGrid>(voxel);
    grid->tree().addTile(1, openvdb::Coord(0, 0, 0), -band, false);
    grid->tree().addTile(1, openvdb::Coord(8, 0, 0), -band, false);
    refuse("tiles alone", grid);

    grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(20, openvdb::Vec3f(0), static_cast<float>(voxel));
    for (int x = -16; x <= 8; x += 8)
        for (int y = -16; y <= 8; y += 8)
            for (int z = 80; z <= 104; z += 8) grid->tree().addTile(1, openvdb::Coord(x, y, z), band, false);
    refuse("a hole", grid);

    grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(20, openvdb::Vec3f(0), static_cast<float>(voxel));
    grid->transform().postTranslate(openvdb::Vec3d(0, -1e12, 0));
    refuse("far away", grid, "bare.vdb: its middle is at -1e+12 mm in y");
}

using shape = double (*)(const openvdb::Vec3d &);

constexpr double edge = 6.06, radius = 4;

double ball(const openvdb::Vec3d &p)
{
    return p.length() - radius;
}

double cube(const openvdb::Vec3d &p)
{
    return std::fmax(std::fabs(p[0]), std::fmax(std::fabs(p[1]), std::fabs(p[2]))) - edge / 2;
}

openvdb::FloatGrid::Ptr make(shape distance)
{
    return distance == ball
               ? openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(static_cast<float>(radius), openvdb::Vec3f(0),
                                                                          static_cast<float>(voxel))
               : openvdb::tools::createLevelSetCube<openvdb::FloatGrid>(static_cast<float>(edge), openvdb::Vec3f(0),
                                                                        static_cast<float>(voxel));
}

/* A mesh of theirs: vertices are off by no more than this, in the mean, in voxels. */
void check_mesh(const char *what, const openvdb::FloatGrid::Ptr &grid, shape distance, double most)
{
    write(at("sphere.vdb"), grid);
    swarf_stock *stock = nullptr;
    swarf_mesh *mesh = nullptr;
    const swarf_contour_options options = swarf_contour_options_default();
    if (!CHECK_OK(swarf_stock_read(at("sphere.vdb").c_str(), nullptr, &stock))) return;
    if (CHECK_OK(swarf_mesh_contour(stock, &options, nullptr, &mesh, nullptr))) {
        const swarf_triangles t = swarf_mesh_triangles(mesh);
        double sum = 0;
        for (size_t i = 0; i < t.vertex_count; i++)
            sum += std::fabs(distance({t.xyz[3 * i], t.xyz[3 * i + 1], t.xyz[3 * i + 2]})) / voxel;
        const double mean = sum / static_cast<double>(t.vertex_count);
        std::printf("%s: vertices off by %.5f voxels in the mean\n", what, mean);
        CHECK(swarf_mesh_topology(mesh).closed && mean < most);
    }
    swarf_mesh_release(mesh);
    swarf_stock_destroy(stock);
}

/* Distances as they are, with noise, smoothed over edges, and what is no distance. */
void check_meshes()
{
    check_mesh("ball", make(ball), ball, 0.01);
    check_mesh("cube", make(cube), cube, 1e-4);
    for (const shape distance : {ball, cube})
        for (const double part : {0.01, 0.1}) {
            const auto grid = make(distance);
            std::mt19937 engine(7);
            for (auto value = grid->beginValueOn(); value; ++value) {
                const double noise = static_cast<double>(engine()) / 4294967296.0 - 0.5; /* the same everywhere */
                value.setValue(static_cast<float>(*value + part * std::sqrt(12) * voxel * noise));
            }
            check_mesh(distance == ball ? "ball with noise" : "cube with noise", grid, distance,
                       part < 0.05 ? 0.011 : 0.07);
        }
    auto grid = make(cube);
    openvdb::tools::LevelSetFilter<openvdb::FloatGrid>(*grid).gaussian(1);
    check_mesh("smoothed cube", grid, cube, 0.15);
    grid = make(cube);
    for (auto value = grid->beginValueOn(); value; ++value) value.setValue(0.8f * *value);
    check_mesh("cube of another slope", grid, cube, 0.004);
}

/* A voxel of material without a band: within a leaf it has a mesh, at the leaf's border, beyond which nothing is, its
 * surface cannot be told. */
void check_cut_off()
{
    for (const int place : {4, 0, 7}) {
        const auto grid = openvdb::FloatGrid::create(static_cast<float>(3 * voxel));
        grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
        grid->setGridClass(openvdb::GRID_LEVEL_SET);
        grid->tree().setValue(openvdb::Coord(place), static_cast<float>(-0.5 * voxel));
        write(at("sphere.vdb"), grid);
        swarf_stock *stock = nullptr;
        swarf_mesh *mesh = nullptr;
        const swarf_contour_options options = swarf_contour_options_default();
        if (!CHECK_OK(swarf_stock_read(at("sphere.vdb").c_str(), nullptr, &stock))) return;
        if (place == 0)
            CHECK_FAILS(swarf_mesh_contour(stock, &options, nullptr, &mesh, nullptr), SWARF_ERROR_GEOMETRY, "cut off");
        else if (CHECK_OK(swarf_mesh_contour(stock, &options, nullptr, &mesh, nullptr)))
            CHECK(swarf_mesh_topology(mesh).closed && swarf_mesh_triangles(mesh).triangle_count == 12);
        swarf_mesh_release(mesh);
        swarf_stock_destroy(stock);
    }
}

} // namespace

int main()
{
    char name[] = "/tmp/swarf-exchange-XXXXXX";
    if (!mkdtemp(name)) return 2;
    folder = name;
    openvdb::initialize();
    check_theirs();
    check_ours();
    check_meshes();
    check_cut_off();
    check_refusals();
    for (const char *file : {"ours.vdb", "sphere.vdb", "bare.vdb"}) std::remove(at(file).c_str());
    rmdir(name);
    return test_end();
}
