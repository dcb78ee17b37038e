/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* .vdb files, through a stream buffer of our own: it counts bytes for the progress, stops when the caller wants to,
 * and fails at the first byte that is not there, so that a file cut short is an error and never a wait or a crash. */
#include "base/arena.hpp"
#include "base/file.h"
#include "base/guard.hpp"
#include "stock/stock.h"
#include "stock/vdb_scan.h"
#include "stock/vdb_tree.hpp"

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/FastSweeping.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <sstream>
#include <streambuf>
#include <sys/stat.h>
#include <vector>

namespace {

/* A stdio file as a stream buffer (stdio buffers already). `expected` bytes are the whole of the progress. */
class file_buffer : public std::streambuf {
  public:
    file_buffer(FILE *file, double expected, swarf_interrupter &interrupter)
        : file_(file), expected_(expected), interrupter_(interrupter)
    {
    }
    /* Whether the caller may stop the work now; at first he may. */
    void let_stop(bool may)
    {
        may_stop_ = may;
    }

  protected:
    std::streamsize xsgetn(char *to, std::streamsize count) override
    {
        return moved(std::fread(to, 1, static_cast<size_t>(count), file_));
    }
    std::streamsize xsputn(const char *from, std::streamsize count) override
    {
        return moved(std::fwrite(from, 1, static_cast<size_t>(count), file_));
    }
    int_type uflow() override
    {
        return std::fgetc(file_);
    }
    int_type underflow() override
    {
        return std::ungetc(std::fgetc(file_), file_);
    }
    int_type overflow(int_type c) override
    {
        return std::fputc(c, file_);
    }
    int sync() override
    {
        return 0;
    }
    pos_type seekoff(off_type offset, std::ios_base::seekdir way, std::ios_base::openmode) override
    {
        const int whence = way == std::ios_base::beg ? SEEK_SET : way == std::ios_base::cur ? SEEK_CUR : SEEK_END;
        if (offset == 0 && way == std::ios_base::cur) return ftello(file_);
        return fseeko(file_, offset, whence) == 0 ? pos_type(ftello(file_)) : pos_type(off_type(-1));
    }
    pos_type seekpos(pos_type position, std::ios_base::openmode mode) override
    {
        return seekoff(position, std::ios_base::beg, mode);
    }

  private:
    std::streamsize moved(size_t count)
    {
        done_ += static_cast<double>(count);
        unreported_ += count;
        if (may_stop_ && unreported_ >= report_bytes) {
            unreported_ = 0;
            if (interrupter_.wasInterrupted(static_cast<int>(100 * std::min(done_ / expected_, 1.0)))) return 0;
        }
        return static_cast<std::streamsize>(count);
    }

    static constexpr size_t report_bytes = 4 << 20; /* some hundred reports a second */
    FILE *file_;
    double expected_, done_ = 0;
    size_t unreported_ = 0;
    bool may_stop_ = true;
    swarf_interrupter &interrupter_;
};

/* Archive::write() to a stream of ours, with the offsets that other programs seek by. */
class stream_archive : public openvdb::io::Archive {
  public:
    void save(std::ostream &stream, const openvdb::GridCPtrVec &grids) const
    {
        Archive::write(stream, grids, true);
    }
};

struct file_closer {
    void operator()(FILE *file) const
    {
        std::fclose(file);
    }
};

/* What Archive::readGrid() does after the metadata: they and all before them are only ever read by the scan. */
openvdb::FloatGrid::Ptr read_grid(FILE *file, const swarf_vdb_place &place, swarf_interrupter &interrupter)
{
    file_buffer buffer(file, static_cast<double>(place.end - place.transform), interrupter);
    std::istream stream(&buffer);
    stream.exceptions(std::ios_base::failbit | std::ios_base::badbit | std::ios_base::eofbit);
    openvdb::io::StreamMetadata::Ptr settings(new openvdb::io::StreamMetadata);
    openvdb::io::setStreamMetadataPtr(stream, settings, /*transfer=*/false);
    openvdb::io::setVersion(stream, {place.library_major, place.library_minor}, place.format);
    openvdb::io::setDataCompression(stream, place.compression);
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create();
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    stream.seekg(static_cast<std::streamoff>(place.transform));
    grid->readTransform(stream);
    buffer.let_stop(false); /* an exception from here would leak nodes: InternalNode::readTopology() */
    grid->tree().readTopology(stream, place.half != 0);
    buffer.let_stop(true);
    grid->tree().readBuffers(stream, place.half != 0);
    return grid;
}

/* Uniform voxels along the axes are all that a stock knows. */
swarf_status check_transform(const openvdb::FloatGrid &grid, const char *path, double &voxel)
{
    const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
    voxel = matrix(0, 0);
    bool fine = std::isfinite(voxel) && voxel > 0;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3 && fine; k++)
            fine =
                i == 3 ? std::isfinite(matrix(i, k)) : std::fabs(matrix(i, k) - (i == k ? voxel : 0)) <= 1e-9 * voxel;
    if (!fine)
        return swarf_fail(SWARF_ERROR_FORMAT,
                          "%s: its voxels are not cubes along the axes (rotated, mirrored or stretched); resample it",
                          path);
    return SWARF_OK;
}

/* Set everything that is not within `band` to +-band and inactive. */
void trim_band(openvdb::FloatGrid &grid, float band)
{
    openvdb::FloatTree &tree = grid.tree();
    for (auto leaf = tree.beginLeaf(); leaf; ++leaf)
        for (openvdb::Index i = 0; i < SWARF_LEAF_SIZE; i++) {
            const float value = leaf->getValue(i);
            if (leaf->isValueOn(i) && !(std::fabs(value) < band)) leaf->setValueOff(i, value < 0 ? -band : band);
        }
    openvdb::tools::changeLevelSetBackground(tree, band);
}

bool all_finite(const openvdb::FloatTree &tree)
{
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile)
        if (!std::isfinite(tile.getValue())) return false;
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
        for (openvdb::Index i = 0; i < SWARF_LEAF_SIZE; i++)
            if (!std::isfinite(leaf->getValue(i))) return false;
    return true;
}

constexpr double farthest = 1e6; /* mm, as for all stocks: floats tell no vertices apart that are far away */

/* Refuse what would not fit: two far apart leaves of a broken file ask for all the nodes between them. */
swarf_status check_extent(const openvdb::FloatGrid &grid, const char *path, double voxel)
{
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) return SWARF_OK;
    const openvdb::Vec3d middle = grid.indexToWorld(0.5 * (box.min().asVec3d() + box.max().asVec3d()));
    swarf_box extent;
    for (int k = 0; k < 3; k++) {
        if (!(std::fabs(middle[k]) <= farthest))
            return swarf_fail(SWARF_ERROR_FORMAT, "%s: its middle is at %g mm in %c; -%g to %g mm are possible", path,
                              middle[k], "xyz"[k], farthest, farthest);
        extent.lo[k] = box.min()[k] * voxel;
        extent.hi[k] = (box.max()[k] + 1.0) * voxel;
    }
    swarf_stock_options options = swarf_stock_options_default();
    options.voxel_mm = voxel;
    double origin[3];
    int32_t count[3];
    const swarf_status status = swarf_stock_layout(&extent, &options, origin, count);
    return status == SWARF_OK
               ? SWARF_OK
               : swarf_fail_within(status == SWARF_ERROR_ARGUMENT ? SWARF_ERROR_FORMAT : status, "%s", path);
}

/* Bring any level set to the form a stock has. Wider bands are cut to three voxels, which changes no value inside
 * them; narrower ones are continued outwards by fast sweeping, which keeps the surface. */
swarf_status normalise(openvdb::FloatGrid::Ptr &grid, const char *path, double voxel)
{
    const double width = static_cast<double>(grid->background()) / voxel;
    if (!(std::isfinite(width) && width >= 1))
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: a band of %g voxels; at least 1 is needed", path, width);
    if (grid->tree().activeTileCount() > 0)
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: not a narrow band: whole blocks are active", path);
    if (!all_finite(grid->tree()))
        return swarf_fail(SWARF_ERROR_FORMAT, "%s: it holds values that are not finite", path);
    const auto band = static_cast<float>(SWARF_HALF_WIDTH * voxel);
    trim_band(*grid, std::min(grid->background(), width > SWARF_HALF_WIDTH ? band : grid->background()));
    SWARF_TRY(check_extent(*grid, path, voxel));
    if (width < SWARF_HALF_WIDTH - 1e-3) {
        grid = openvdb::tools::dilateSdf(*grid, static_cast<int>(std::ceil(SWARF_HALF_WIDTH - width)),
                                         openvdb::tools::NN_FACE_EDGE_VERTEX, 2);
        grid->setGridClass(openvdb::GRID_LEVEL_SET);
    }
    trim_band(*grid, band);
    return SWARF_OK;
}

/* Refuse solid blocks whose neighbour is an empty one: the surface between them has no band, so that nothing could be
 * cut, measured or meshed there. */
swarf_status check_band(const swarf_tree &tree, const char *path)
{
    enum { OUTSIDE, INSIDE, BAND };
    const int32_t *count = tree.layout.count;
    const auto kind = [&](const int32_t at[3]) {
        for (int k = 0; k < 3; k++)
            if (at[k] < 0 || at[k] >= count[k] * 16) return OUTSIDE;
        const size_t node =
            (static_cast<size_t>(at[0] / 16) * static_cast<size_t>(count[1]) + static_cast<size_t>(at[1] / 16)) *
                static_cast<size_t>(count[2]) +
            static_cast<size_t>(at[2] / 16);
        const auto slot = static_cast<unsigned>((at[0] % 16) << 8 | (at[1] % 16) << 4 | (at[2] % 16));
        if (!(tree.occupied[node * SWARF_NODE_WORDS + (slot >> 6)] >> (slot & 63) & 1)) return OUTSIDE;
        return swarf_tree_leaf(&tree, node, slot) ? BAND : INSIDE;
    };
    int32_t at[3];
    for (at[0] = 0; at[0] < count[0] * 16; at[0]++)
        for (at[1] = 0; at[1] < count[1] * 16; at[1]++)
            for (at[2] = 0; at[2] < count[2] * 16; at[2]++) {
                if (kind(at) != INSIDE) continue;
                for (int side = 0; side < 6; side++) {
                    int32_t next[3] = {at[0], at[1], at[2]};
                    next[side / 2] += side % 2 ? 1 : -1;
                    if (kind(next) == OUTSIDE)
                        return swarf_fail(SWARF_ERROR_FORMAT,
                                          "%s: not a narrow band: solid without a surface at %g %g %g mm", path,
                                          tree.layout.origin[0] + at[0] * 8 * tree.layout.voxel,
                                          tree.layout.origin[1] + at[1] * 8 * tree.layout.voxel,
                                          tree.layout.origin[2] + at[2] * 8 * tree.layout.voxel);
                }
            }
    return SWARF_OK;
}

} // namespace

extern "C" swarf_status swarf_vdb_unpack(const void *chunk, size_t chunk_bytes, uint32_t compression, size_t bytes)
{
    return swarf_guard("packed values", [&]() -> swarf_status {
        std::istringstream stream(std::string(static_cast<const char *>(chunk), chunk_bytes));
        std::vector<char> values(bytes + 1); /* never a null buffer, which would mean to skip */
        try {
            if (compression & SWARF_VDB_BLOSC)
                openvdb::io::bloscFromStream(stream, values.data(), bytes);
            else
                openvdb::io::unzipFromStream(stream, values.data(), bytes);
        } catch (const openvdb::Exception &error) {
            return swarf_fail(SWARF_ERROR_FORMAT, "%s", error.what());
        }
        return SWARF_OK;
    });
}

extern "C" swarf_status swarf_stock_read(const char *path, const swarf_progress *progress, swarf_stock **out)
{
    SWARF_REQUIRE(path && out, "stock: path or output missing");
    return swarf_guard(path, [&]() -> swarf_status {
        swarf_vdb_initialize();
        const std::unique_ptr<FILE, file_closer> file(std::fopen(path, "rb"));
        struct stat info;
        if (!file || fstat(fileno(file.get()), &info) != 0)
            return swarf_fail(SWARF_ERROR_IO, "%s: cannot open: %s", path, std::strerror(errno));
        if (!S_ISREG(info.st_mode)) return swarf_fail(SWARF_ERROR_IO, "%s: not a file", path);
        swarf_vdb_place place;
        SWARF_TRY(swarf_vdb_scan(file.get(), static_cast<uint64_t>(info.st_size), path, &place));
        swarf_interrupter interrupter(progress);
        openvdb::FloatGrid::Ptr grid;
        double voxel;
        try {
            grid = read_grid(file.get(), place, interrupter);
            SWARF_TRY(check_transform(*grid, path, voxel));
        } catch (const std::ios_base::failure &) {
            SWARF_TRY(interrupter.status());
            return swarf_fail(SWARF_ERROR_FORMAT, "%s: cut short while it was read", path);
        } catch (const openvdb::Exception &error) { /* a leaf that does not unpack, a singular map */
            return swarf_fail(SWARF_ERROR_FORMAT, "%s: damaged before byte %lld: %s", path,
                              static_cast<long long>(ftello(file.get())), error.what());
        }
        SWARF_TRY(swarf_arena_run([&] { return normalise(grid, path, voxel); }));
        std::unique_ptr<swarf_tree> tree(swarf_tree_adopt(grid));
        SWARF_TRY(check_band(*tree, path));
        return swarf_stock_wrap(tree.release(), out);
    });
}

extern "C" swarf_status swarf_stock_write(swarf_stock *stock, const char *path, const swarf_progress *progress)
{
    SWARF_REQUIRE(path && *path, "stock: path missing");
    SWARF_TRY(swarf_stock_enter_read(stock));
    swarf_file_writer writer;
    swarf_status status = swarf_file_begin(path, &writer);
    if (status == SWARF_OK) {
        swarf_interrupter interrupter(progress);
        status = swarf_guard(path, [&]() -> swarf_status {
            size_t leaves, bytes;
            swarf_tree_size(stock->tree, &leaves, &bytes);
            const auto grid = stock->tree->grid->copy(); /* shares the tree */
            grid->setName("stock");
            grid->setCreator("swarf");
            grid->setGridClass(openvdb::GRID_LEVEL_SET);
            grid->insertMeta("voxel_mm", openvdb::DoubleMetadata(stock->tree->layout.voxel));
            file_buffer buffer(writer.stream, static_cast<double>(bytes), interrupter);
            std::ostream stream(&buffer);
            stream.exceptions(std::ios_base::failbit | std::ios_base::badbit);
            try {
                stream_archive().save(stream, {grid});
            } catch (const std::ios_base::failure &) {
                SWARF_TRY(interrupter.status());
                return swarf_fail(SWARF_ERROR_IO, "%s: cannot write: %s", path, std::strerror(errno));
            }
            return SWARF_OK;
        });
        if (status == SWARF_OK)
            status = swarf_file_commit(&writer);
        else
            swarf_file_abandon(&writer);
    }
    swarf_stock_leave(stock);
    return status;
}
