/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock by stock, on copies of both trees: OpenVDB's operations take the operands apart. */
#include "base/arena.hpp"
#include "base/guard.hpp"
#include "base/memory.h"
#include "stock/stock.h"
#include "stock/vdb_tree.hpp"

#include <openvdb/tools/Composite.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace {

/* How far the voxels of two stocks may be apart and still be the same: a hundredth of the accuracy of a face. */
constexpr double coincide = 1e-4;

/* Grid index of `other`'s voxels in `own`, less their own index. */
swarf_status find_shift(const swarf_tree &own, const swarf_tree &other, openvdb::Coord &out)
{
    const double voxel = own.layout.voxel;
    SWARF_REQUIRE(std::fabs(other.layout.voxel - voxel) <= 1e-9 * voxel,
                  "stock: voxels of %.9g and %.9g mm do not combine", voxel, other.layout.voxel);
    for (int k = 0; k < 3; k++) {
        const double shift = (other.layout.origin[k] - own.layout.origin[k]) / voxel;
        SWARF_REQUIRE(std::fabs(shift - std::round(shift)) <= coincide && std::fabs(shift) < 1e8,
                      "stock: the voxels of the two stocks lie %.4g voxels apart along %c; whole numbers combine",
                      shift, "xyz"[k]);
        out[k] = static_cast<int>(std::lround(shift)) + own.base[k] - other.base[k];
    }
    return SWARF_OK;
}

/* Refuse a union that would not fit: a stock has all nodes between its parts, however far apart they lie. */
swarf_status check_union(const swarf_tree &own, const swarf_tree &other, const openvdb::Coord &shift)
{
    double nodes = 1;
    for (int k = 0; k < 3; k++) {
        const double own_lo = own.base[k], other_lo = static_cast<double>(other.base[k]) + shift[k];
        const double own_hi = own_lo + own.layout.count[k] * static_cast<double>(SWARF_NODE_DIM);
        const double other_hi = other_lo + other.layout.count[k] * static_cast<double>(SWARF_NODE_DIM);
        nodes *= std::ceil((std::max(own_hi, other_hi) - std::min(own_lo, other_lo)) / SWARF_NODE_DIM);
    }
    const double wanted = nodes * (sizeof(swarf_vdb_node) + SWARF_NODE_WORDS * sizeof(uint64_t));
    const size_t left = swarf_memory_free();
    if (left == SIZE_MAX || wanted <= 0.8 * static_cast<double>(left)) return SWARF_OK;
    return swarf_fail(SWARF_ERROR_MEMORY,
                      "stock: the two lie too far apart for one: that may need %.3g GiB, %.3g GiB may be used",
                      wanted / 0x1p30, 0.8 * static_cast<double>(left) / 0x1p30);
}

openvdb::FloatTree::Ptr shifted_copy(const openvdb::FloatTree &tree, const openvdb::Coord &shift)
{
    if (shift == openvdb::Coord(0)) return std::make_shared<openvdb::FloatTree>(tree);
    auto moved = std::make_shared<openvdb::FloatTree>(tree.background());
    openvdb::tree::ValueAccessor<openvdb::FloatTree> to(*moved);
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
        for (auto value = leaf->cbeginValueOn(); value; ++value) to.setValue(value.getCoord() + shift, *value);
    openvdb::tools::signedFloodFill(*moved);
    return moved;
}

swarf_tree *combine(const swarf_tree &own, const openvdb::FloatTree &other, const openvdb::Coord &shift,
                    swarf_boolean operation)
{
    const auto grid = own.grid->deepCopy();
    const auto operand = shifted_copy(other, shift);
    switch (operation) {
    case SWARF_UNION: openvdb::tools::csgUnion(grid->tree(), *operand); break;
    case SWARF_INTERSECTION: openvdb::tools::csgIntersection(grid->tree(), *operand); break;
    case SWARF_DIFFERENCE: openvdb::tools::csgDifference(grid->tree(), *operand); break;
    }
    return swarf_tree_adopt(grid);
}

} // namespace

extern "C" swarf_status swarf_stock_boolean(swarf_stock *stock, swarf_stock *other, swarf_boolean operation)
{
    SWARF_REQUIRE(stock && other, "stock: NULL");
    SWARF_REQUIRE(operation >= SWARF_UNION && operation <= SWARF_DIFFERENCE, "stock: no boolean number %d",
                  static_cast<int>(operation));
    SWARF_TRY(swarf_stock_enter_read(stock));
    swarf_status status = other == stock ? SWARF_OK : swarf_stock_enter_read(other);
    if (status == SWARF_OK) {
        status = swarf_guard("stock boolean", [&]() -> swarf_status {
            openvdb::Coord shift;
            SWARF_TRY(find_shift(*stock->tree, *other->tree, shift));
            if (operation == SWARF_UNION) SWARF_TRY(check_union(*stock->tree, *other->tree, shift));
            swarf_tree *result =
                swarf_arena_run([&] { return combine(*stock->tree, other->tree->grid->tree(), shift, operation); });
            swarf_tree_stamp_all(result, stock->tree->layout.generation + 1);
            swarf_tree_destroy(stock->tree);
            stock->tree = result;
            return SWARF_OK;
        });
        if (other != stock) swarf_stock_leave(other);
    }
    swarf_stock_leave(stock);
    return status;
}
