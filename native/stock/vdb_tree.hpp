/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The OpenVDB side of a tree, for the vdb*.cpp files of this and later rooms only. */
#ifndef SWARF_STOCK_VDB_TREE_HPP
#define SWARF_STOCK_VDB_TREE_HPP

#include "stock/vdb_slab.hpp"
#include "stock/vdb_tree.h"

#include <openvdb/openvdb.h>

#include <memory>
#include <vector>

using swarf_vdb_node = openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType; /* 16^3 slots */
using swarf_vdb_leaf = openvdb::FloatTree::LeafNodeType;

struct swarf_tree {
    swarf_tree_layout layout;
    openvdb::FloatGrid::Ptr grid; /* a level set; its transform maps index to world */
    openvdb::Coord base;          /* grid index of the layout's voxel (0, 0, 0); multiples of 128 */
    std::vector<swarf_vdb_node *> nodes;
    std::vector<uint64_t> occupied;
    std::vector<uint32_t> stamps;
    std::unique_ptr<swarf_slab> slab = std::make_unique<swarf_slab>(); /* of the leaves that cutting made */
    bool adopted = false; /* some leaves may be OpenVDB's own; else all are in cells of the slab */

    swarf_tree() = default;
    swarf_tree(const swarf_tree &) = delete;
    swarf_tree &operator=(const swarf_tree &) = delete;
    ~swarf_tree();
};

/** Take over a level-set grid of half width 3 (uniform voxels, no rotation): every 128^3 node that its bounding box
 *  touches is made, tiles of higher levels are pushed down, occupancy is read off. Throws. */
swarf_tree *swarf_tree_adopt(const openvdb::FloatGrid::Ptr &grid);

/** Call openvdb::initialize() once. */
void swarf_vdb_initialize();

#endif
