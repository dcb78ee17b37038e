/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Slab: the 2 KiB buffers of a tree's leaves, carved from large regions that the kernel may back with huge pages.
 *
 *   regions   2 MiB, 4 MiB ... 256 MiB, each aligned to a huge page; given back to the system with the slab
 *   batches   64 buffers next to each other: what a thread takes from a region at once
 *   shelves   one per thread (by a number of its own, modulo SHELVES): buffers given back and the rest of a batch
 *
 * Cutting makes and unmakes leaves by the hundred thousand; with one page fault for each two of them the system took a
 * quarter of the time. Any thread may take and give; memory in use never moves. */
#ifndef SWARF_STOCK_VDB_SLAB_HPP
#define SWARF_STOCK_VDB_SLAB_HPP

#include "stock/vdb_tree.h"

#include <atomic>
#include <cstddef>
#include <mutex>

class swarf_slab {
  public:
    swarf_slab() = default;
    swarf_slab(const swarf_slab &) = delete;
    swarf_slab &operator=(const swarf_slab &) = delete;
    ~swarf_slab();

    /** A buffer of SWARF_LEAF_SIZE floats with any values; throws std::bad_alloc. */
    float *take();
    /** Give back a buffer that was taken here. */
    void give(float *buffer) noexcept;
    /** Was this buffer taken here? */
    bool owns(const float *buffer) const noexcept;

  private:
    static constexpr size_t buffer_bytes = SWARF_LEAF_SIZE * sizeof(float);
    static constexpr size_t batch = 64, most_on_shelf = 4 * batch;
    static constexpr size_t first_region = size_t(2) << 20, largest_region = size_t(256) << 20;
    static constexpr int shelf_count = 32, most_regions = 1024; /* 256 GiB */

    /* Buffers that nobody uses, linked through their first bytes. */
    struct free_buffer {
        free_buffer *next;
    };
    struct alignas(64) shelf {
        std::atomic_flag busy = ATOMIC_FLAG_INIT;
        free_buffer *free = nullptr;
        size_t count = 0;
        char *fresh = nullptr, *fresh_end = nullptr;
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
    std::mutex mutex_; /* of what follows */
    free_buffer *shared_ = nullptr;
    char *next_ = nullptr, *end_ = nullptr; /* of the newest region */
    region regions_[most_regions];
    std::atomic<int> region_count_{0};
};

#endif
