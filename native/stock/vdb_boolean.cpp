/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock by stock, on copies of both trees: OpenVDB's operations take the operands apart. */
#include "base/arena.hpp"
#include "base/guard.hpp"
#include "stock/stock.h"
#include "stock/vdb_tree.hpp"

#include <openvdb/tools/Composite.h>
#include <openvdb/tools/SignedFloodFill.h>

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
            swarf_tree *result =
                swarf_arena_run([&] { return combine(*stock->tree, other->tree->grid->tree(), shift, operation); });
            swarf_tree_destroy(stock->tree);
            stock->tree = result;
            return SWARF_OK;
        });
        if (other != stock) swarf_stock_leave(other);
    }
    swarf_stock_leave(stock);
    return status;
}
