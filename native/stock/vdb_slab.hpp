/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Slab: cells for the leaves of a tree, each a node of OpenVDB's followed by its 512 values, carved from large regions
 * that the kernel may back with huge pages.
 *
 *   cell      128 bytes for the node, 2 KiB of values: whoever has the node has the values, without reading it
 *   regions   2 MiB, 4 MiB ... 256 MiB, each aligned to a huge page; given back to the system with the slab
 *   batches   64 cells next to each other: what a thread takes from a region at once
 *   shelves   one per thread (by a number of its own, modulo SHELVES): cells given back and the rest of a batch
 *
 * Cutting makes and unmakes leaves by the million; with one page fault for each two of them the system took a quarter
 * of the time. Free cells are kept in lists beside them, so that one is neither read nor written when it is given back.
 * Any thread may take and give; memory in use never moves. */
#ifndef SWARF_STOCK_VDB_SLAB_HPP
#define SWARF_STOCK_VDB_SLAB_HPP

#include "stock/vdb_tree.h"

#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

class swarf_slab {
  public:
    static constexpr size_t node_bytes = 128, cell_bytes = node_bytes + SWARF_LEAF_SIZE * sizeof(float);

    swarf_slab() = default;
    swarf_slab(const swarf_slab &) = delete;
    swarf_slab &operator=(const swarf_slab &) = delete;
    ~swarf_slab();

    /** A cell with anything in it, aligned to 64 bytes; throws std::bad_alloc. */
    void *take();
    /** Give back a cell that was taken here. */
    void give(void *cell) noexcept;
    /** Was this taken here? */
    bool owns(const void *cell) const noexcept;

  private:
    static constexpr size_t batch = 64, most_on_shelf = 4 * batch;
    static constexpr size_t first_region = size_t(2) << 20, largest_region = size_t(256) << 20;
    static constexpr int shelf_count = 32, most_regions = 1024; /* 256 GiB */

    struct alignas(64) shelf {
        std::atomic_flag busy = ATOMIC_FLAG_INIT;
        size_t count = 0;
        char *fresh = nullptr, *fresh_end = nullptr;
        void *free[most_on_shelf]; /* the first `count`; the last one given back is the first to be taken again */
    };
    struct region {
        std::atomic<char *> begin{nullptr};
        size_t bytes = 0;
    };

    shelf &enter() noexcept;
    void refill(shelf &own);
    void spill(shelf &own) noexcept;
    void add_region();

    shelf shelves_[shelf_count];
    std::mutex mutex_;                      /* of what follows */
    std::vector<void *> shared_;            /* free cells; has room for those of all regions */
    size_t cells_ = 0;                      /* of all regions */
    char *next_ = nullptr, *end_ = nullptr; /* of the newest region */
    region regions_[most_regions];
    std::atomic<int> region_count_{0};
};

#endif
