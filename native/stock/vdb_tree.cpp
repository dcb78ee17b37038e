/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "stock/vdb_tree.hpp"

#include "base/guard.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>

using openvdb::Coord;
using openvdb::Index;

void swarf_vdb_initialize()
{
    static std::once_flag once;
    std::call_once(once, [] { openvdb::initialize(); });
}

namespace {

size_t node_number(const swarf_tree &tree, int32_t x, int32_t y, int32_t z)
{
    const int32_t *count = tree.layout.count;
    return (static_cast<size_t>(x) * static_cast<size_t>(count[1]) + static_cast<size_t>(y)) *
               static_cast<size_t>(count[2]) +
           static_cast<size_t>(z);
}

Coord slot_corner(const swarf_vdb_node &node, unsigned slot)
{
    const Coord corner = node.origin();
    return corner.offsetBy(static_cast<int>(slot >> 8) * SWARF_LEAF_DIM,
                           static_cast<int>(slot >> 4 & 15) * SWARF_LEAF_DIM,
                           static_cast<int>(slot & 15) * SWARF_LEAF_DIM);
}

/* The node that holds `at`, made (all of the value that was there) where the tree has a tile instead. */
swarf_vdb_node *make_node(openvdb::FloatTree &tree, const Coord &at)
{
    if (auto *node = tree.probeNode<swarf_vdb_node>(at)) return node;
    const float value = tree.getValue(at);
    /* Its place in the root first: OpenVDB would lose the node if there is no memory left for the place. */
    if (tree.getValueDepth(at) < 0) tree.root().addTile(at, value, false);
    tree.touchLeaf(at);
    auto *node = tree.probeNode<swarf_vdb_node>(at);
    node->addTile(swarf_vdb_node::coordToOffset(at), value, false);
    return node;
}

/* Find or make all nodes of the layout. */
void fill_nodes(swarf_tree &tree)
{
    const int32_t *count = tree.layout.count;
    const size_t total = static_cast<size_t>(count[0]) * static_cast<size_t>(count[1]) * static_cast<size_t>(count[2]);
    tree.nodes.resize(total);
    tree.occupied.assign(total * SWARF_NODE_WORDS, 0);
    tree.layout.occupied = tree.occupied.data();
    tree.stamps.resize(total * SWARF_NODE_CUBES);
    tree.layout.stamps = tree.stamps.data();
    swarf_tree_stamp_all(&tree, 1);
    for (int32_t x = 0; x < count[0]; x++)
        for (int32_t y = 0; y < count[1]; y++)
            for (int32_t z = 0; z < count[2]; z++)
                tree.nodes[node_number(tree, x, y, z)] = make_node(
                    tree.grid->tree(), tree.base.offsetBy(x * SWARF_NODE_DIM, y * SWARF_NODE_DIM, z * SWARF_NODE_DIM));
}

swarf_vdb_leaf *leaf_of(const swarf_tree *tree, size_t node, unsigned slot)
{
    swarf_vdb_node *const holder = tree->nodes[node];
    if (!holder->getChildMask().isOn(slot)) return nullptr;
    return const_cast<swarf_vdb_leaf *>(holder->getTable()[slot].getChild());
}

/* OpenVDB has no way to give a leaf a buffer of one's own, so this reaches its private pointer (an explicit
 * instantiation may name it). Only leaves of our trees lie in cells, and ~swarf_tree() takes them out before OpenVDB
 * could free them; copies of a tree, which its tools work on, have leaves of OpenVDB's. */
struct buffer_data {
    using type = float *openvdb::tree::LeafBuffer<float, 3>::*;
    friend type expose(buffer_data);
};
template <buffer_data::type Member> struct exposed {
    friend buffer_data::type expose(buffer_data)
    {
        return Member;
    }
};
template struct exposed<&openvdb::tree::LeafBuffer<float, 3>::mData>;

static_assert(sizeof(swarf_vdb_leaf) <= swarf_slab::node_bytes, "the node of a cell is too small");

float *values_in_cell(swarf_vdb_leaf *leaf)
{
    return reinterpret_cast<float *>(reinterpret_cast<char *>(leaf) + swarf_slab::node_bytes);
}

float *values_of(const swarf_tree *tree, swarf_vdb_leaf *leaf)
{
    return tree->adopted ? leaf->buffer().data() : values_in_cell(leaf);
}

swarf_vdb_leaf *take_leaf(swarf_tree &tree, const Coord &corner)
{
    /* PartialCreate: no buffer is filled only to be overwritten. */
    auto *leaf = new (tree.slab->take()) swarf_vdb_leaf(openvdb::PartialCreate(), corner, 0.0f, false);
    leaf->buffer().*expose(buffer_data()) = values_in_cell(leaf);
    return leaf;
}

/* Nothing needs to be done for the node in a cell: it holds nothing of its own. */
void drop_leaf(swarf_tree &tree, swarf_vdb_leaf *leaf) noexcept
{
    if (!tree.adopted || tree.slab->owns(leaf))
        tree.slab->give(leaf);
    else
        delete leaf;
}

/* The cube of a slot is its number without the low two bits of x, y and z. */
void stamp(swarf_tree *tree, size_t node, unsigned slot)
{
    const unsigned cube = (slot >> 10) << 4 | (slot >> 6 & 3) << 2 | (slot >> 2 & 3);
    uint32_t &own = tree->layout.stamps[node * SWARF_NODE_CUBES + cube];
    if (own != tree->layout.generation) own = tree->layout.generation; /* unwritten lines stay in all caches */
}

void set_mask(swarf_vdb_leaf &leaf, const uint64_t mask[8])
{
    auto &words = leaf.getValueMask();
    for (Index k = 0; k < 8; k++) words.getWord<uint64_t>(k) = mask[k];
}

} // namespace

swarf_tree::~swarf_tree()
{
    for (swarf_vdb_node *node : nodes)
        if (node) /* not all are made when memory ran out */
            for (auto leaf = node->beginChildOn(); leaf; ++leaf)
                if (slab->owns(&*leaf)) node->stealNode<swarf_vdb_leaf>(leaf.getCoord(), 0.0f, false);
    /* Node by node: ~Tree() makes lists of them first, and ends the program when there is no memory for the lists. */
    if (grid) grid->tree().root().clear();
}

swarf_tree *swarf_tree_adopt(const openvdb::FloatGrid::Ptr &grid)
{
    auto tree = std::make_unique<swarf_tree>();
    tree->adopted = true;
    tree->grid = grid;
    grid->tree().voxelizeActiveTiles();
    openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    if (box.empty()) box.reset(Coord(0), Coord(0));
    /* Multiples of 128 below the low and above the high corner; >> rounds towards minus infinity. */
    for (int k = 0; k < 3; k++) {
        const int lo = box.min()[k] >> 7, hi = box.max()[k] >> 7;
        tree->base[k] = lo * SWARF_NODE_DIM;
        tree->layout.count[k] = hi - lo + 1;
    }
    /* from the matrix: voxelSize() is a difference of positions and loses the last digits */
    tree->layout.voxel = grid->transform().baseMap()->getAffineMap()->getMat4()(0, 0);
    tree->layout.background = grid->background();
    const openvdb::Vec3d origin = grid->indexToWorld(tree->base);
    for (int k = 0; k < 3; k++) tree->layout.origin[k] = origin[k];
    fill_nodes(*tree);
    for (size_t node = 0; node < tree->nodes.size(); node++) {
        const swarf_vdb_node &holder = *tree->nodes[node];
        uint64_t *words = &tree->occupied[node * SWARF_NODE_WORDS];
        for (unsigned slot = 0; slot < SWARF_NODE_SLOTS; slot++)
            if (holder.getChildMask().isOn(slot) || holder.getTable()[slot].getValue() < 0)
                words[slot >> 6] |= uint64_t(1) << (slot & 63);
    }
    return tree.release();
}

extern "C" swarf_status swarf_tree_create(double voxel, const double origin[3], const int32_t count[3],
                                          swarf_tree **out)
{
    return swarf_guard("stock", [&]() -> swarf_status {
        swarf_vdb_initialize();
        auto tree = std::make_unique<swarf_tree>();
        tree->layout.voxel = voxel;
        tree->layout.background = static_cast<float>(SWARF_HALF_WIDTH * voxel);
        auto transform = openvdb::math::Transform::createLinearTransform(voxel);
        transform->postTranslate(openvdb::Vec3d(origin[0], origin[1], origin[2]));
        tree->grid = openvdb::FloatGrid::create(tree->layout.background);
        tree->grid->setGridClass(openvdb::GRID_LEVEL_SET);
        tree->grid->setTransform(transform);
        tree->base = Coord(0);
        for (int k = 0; k < 3; k++) {
            tree->layout.origin[k] = origin[k];
            tree->layout.count[k] = count[k];
        }
        fill_nodes(*tree);
        *out = tree.release();
        return SWARF_OK;
    });
}

extern "C" swarf_status swarf_tree_copy(const swarf_tree *tree, swarf_tree **out)
{
    return swarf_guard("stock", [&]() -> swarf_status {
        auto copy = std::make_unique<swarf_tree>();
        copy->adopted = true;
        copy->layout = tree->layout;
        copy->base = tree->base;
        copy->occupied = tree->occupied;
        copy->stamps = tree->stamps;
        copy->grid = tree->grid->deepCopy();
        copy->layout.occupied = copy->occupied.data();
        copy->layout.stamps = copy->stamps.data();
        copy->nodes.resize(tree->nodes.size());
        for (size_t node = 0; node < copy->nodes.size(); node++)
            copy->nodes[node] = copy->grid->tree().probeNode<swarf_vdb_node>(tree->nodes[node]->origin());
        *out = copy.release();
        return SWARF_OK;
    });
}

extern "C" void swarf_tree_destroy(swarf_tree *tree)
{
    delete tree;
}

extern "C" const swarf_tree_layout *swarf_tree_get_layout(const swarf_tree *tree)
{
    return &tree->layout;
}

extern "C" void swarf_tree_next_generation(swarf_tree *tree)
{
    tree->layout.generation++;
}

extern "C" void swarf_tree_stamp_all(swarf_tree *tree, uint32_t generation)
{
    tree->layout.generation = generation;
    std::fill(tree->stamps.begin(), tree->stamps.end(), generation);
}

extern "C" float *swarf_tree_leaf(const swarf_tree *tree, size_t node, unsigned slot)
{
    swarf_vdb_leaf *const leaf = leaf_of(tree, node, slot);
    return leaf ? values_of(tree, leaf) : nullptr;
}

extern "C" void swarf_tree_leaf_fetch(const swarf_tree *tree, size_t node, unsigned slot)
{
    if (tree->adopted)
        __builtin_prefetch(leaf_of(tree, node, slot));
    else
        __builtin_prefetch(&tree->nodes[node]->getTable()[slot]);
}

extern "C" int swarf_tree_tile_inside(const swarf_tree *tree, size_t node, unsigned slot)
{
    return tree->nodes[node]->getTable()[slot].getValue() < 0;
}

extern "C" swarf_status swarf_tree_leaf_add(swarf_tree *tree, size_t node, unsigned slot, const float *values,
                                            const uint64_t mask[8])
{
    return swarf_guard("stock", [&]() -> swarf_status {
        swarf_vdb_node &holder = *tree->nodes[node];
        const Coord corner = slot_corner(holder, slot);
        swarf_vdb_leaf *const leaf = take_leaf(*tree, corner);
        std::memcpy(values_in_cell(leaf), values, SWARF_LEAF_SIZE * sizeof(float));
        set_mask(*leaf, mask);
        if (holder.getChildMask().isOn(slot)) drop_leaf(*tree, holder.stealNode<swarf_vdb_leaf>(corner, 0.0f, false));
        holder.addLeaf(leaf);
        stamp(tree, node, slot);
        tree->layout.occupied[node * SWARF_NODE_WORDS + (slot >> 6)] |= uint64_t(1) << (slot & 63);
        return SWARF_OK;
    });
}

extern "C" void swarf_tree_leaf_mask(swarf_tree *tree, size_t node, unsigned slot, const uint64_t mask[8])
{
    set_mask(*leaf_of(tree, node, slot), mask);
    stamp(tree, node, slot);
}

extern "C" void swarf_tree_tile(swarf_tree *tree, size_t node, unsigned slot, int inside)
{
    const float value = inside ? -tree->layout.background : tree->layout.background;
    swarf_vdb_node &holder = *tree->nodes[node];
    if (holder.getChildMask().isOn(slot))
        drop_leaf(*tree, holder.stealNode<swarf_vdb_leaf>(slot_corner(holder, slot), value, false));
    else
        holder.addTile(Index(slot), value, false);
    stamp(tree, node, slot);
    uint64_t &word = tree->layout.occupied[node * SWARF_NODE_WORDS + (slot >> 6)];
    const uint64_t bit = uint64_t(1) << (slot & 63);
    word = inside ? word | bit : word & ~bit;
}

extern "C" void swarf_tree_fill(swarf_tree *tree, size_t node, const int lo[3], const int hi[3])
{
    swarf_vdb_node &holder = *tree->nodes[node];
    uint64_t *words = &tree->layout.occupied[node * SWARF_NODE_WORDS];
    for (int x = lo[0]; x <= hi[0]; x++)
        for (int y = lo[1]; y <= hi[1]; y++)
            for (int z = lo[2]; z <= hi[2]; z++) {
                const unsigned slot = static_cast<unsigned>(x << 8 | y << 4 | z);
                holder.addTile(Index(slot), -tree->layout.background, false);
                stamp(tree, node, slot);
                words[slot >> 6] |= uint64_t(1) << (slot & 63);
            }
}

extern "C" void swarf_tree_size(const swarf_tree *tree, size_t *leaves, size_t *bytes)
{
    size_t count = 0;
    for (const swarf_vdb_node *node : tree->nodes) count += node->getChildMask().countOn();
    *leaves = count;
    *bytes = tree->nodes.size() * sizeof(swarf_vdb_node) + count * swarf_slab::cell_bytes +
             tree->occupied.size() * sizeof(uint64_t) + tree->stamps.size() * sizeof(uint32_t);
}
