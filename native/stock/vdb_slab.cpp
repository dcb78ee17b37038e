/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "stock/vdb_slab.hpp"

#include <algorithm>
#include <cstdint>
#include <new>
#include <thread>

#include <sys/mman.h>

namespace {

constexpr size_t huge_page = size_t(2) << 20;

unsigned thread_number() noexcept
{
    static std::atomic<unsigned> threads{0};
    static thread_local unsigned number; /* from 1 on; 0: none yet */
    if (number == 0) number = threads.fetch_add(1, std::memory_order_relaxed) + 1;
    return number;
}

/* Address space for `bytes` at a multiple of a huge page; pages come when they are touched. */
char *map_aligned(size_t bytes)
{
    const size_t wanted = bytes + huge_page;
    void *const mapped =
        mmap(nullptr, wanted, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    char *const raw = static_cast<char *>(mapped);
    const size_t before = (huge_page - reinterpret_cast<uintptr_t>(raw) % huge_page) % huge_page;
    if (before > 0) munmap(raw, before);
    munmap(raw + before + bytes, huge_page - before);
    madvise(raw + before, bytes, MADV_HUGEPAGE); /* where the kernel has none, small pages do */
    return raw + before;
}

/* Have the processor fetch a cell that will be written. */
void fetch(const void *cell) noexcept
{
    const char *const begin = static_cast<const char *>(cell);
    for (size_t i = 0; i < swarf_slab::cell_bytes; i += 64) __builtin_prefetch(begin + i, 1);
}

} // namespace

swarf_slab::~swarf_slab()
{
    for (int i = 0; i < region_count_.load(); i++) munmap(regions_[i].begin.load(), regions_[i].bytes);
}

/* More threads than shelves share some. */
swarf_slab::shelf &swarf_slab::enter() noexcept
{
    shelf &own = shelves_[thread_number() % shelf_count];
    while (own.busy.test_and_set(std::memory_order_acquire)) std::this_thread::yield();
    return own;
}

void swarf_slab::add_region()
{
    const int count = region_count_.load(std::memory_order_relaxed);
    if (count == most_regions) throw std::bad_alloc();
    const size_t bytes = std::min(largest_region, first_region << std::min(count, 16));
    cells_ += bytes / cell_bytes;
    shared_.reserve(cells_);
    char *const begin = map_aligned(bytes);
    regions_[count].bytes = bytes;
    regions_[count].begin.store(begin, std::memory_order_relaxed);
    region_count_.store(count + 1, std::memory_order_release);
    next_ = begin;
    end_ = begin + bytes / cell_bytes * cell_bytes;
}

/* A shelf is empty: cells that others gave back first, then fresh ones. */
void swarf_slab::refill(shelf &own)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    const size_t given = std::min(batch, shared_.size());
    std::copy(shared_.end() - static_cast<std::ptrdiff_t>(given), shared_.end(), own.free);
    shared_.resize(shared_.size() - given);
    own.count = given;
    if (given > 0) return;
    if (next_ == end_) add_region();
    own.fresh = next_;
    own.fresh_end = next_ = next_ + std::min(batch * cell_bytes, static_cast<size_t>(end_ - next_));
}

/* A shelf is full: the half that lies longest, and is least in the caches, to the others. */
void swarf_slab::spill(shelf &own) noexcept
{
    const std::lock_guard<std::mutex> lock(mutex_);
    void **const middle = own.free + most_on_shelf / 2;
    shared_.insert(shared_.end(), own.free, middle); /* there is room: add_region() */
    own.count = static_cast<size_t>(std::copy(middle, own.free + own.count, own.free) - own.free);
}

void *swarf_slab::take()
{
    shelf &own = enter();
    try {
        if (own.count == 0 && own.fresh == own.fresh_end) refill(own);
    } catch (...) {
        own.busy.clear(std::memory_order_release);
        throw;
    }
    void *found;
    if (own.count > 0) {
        found = own.free[--own.count];
        if (own.count > 0) fetch(own.free[own.count - 1]); /* likely the next one */
    } else {
        found = own.fresh;
        own.fresh += cell_bytes;
    }
    own.busy.clear(std::memory_order_release);
    return found;
}

void swarf_slab::give(void *cell) noexcept
{
    shelf &own = enter();
    if (own.count == most_on_shelf) spill(own);
    own.free[own.count++] = cell;
    own.busy.clear(std::memory_order_release);
}

bool swarf_slab::owns(const void *cell) const noexcept
{
    const char *const place = static_cast<const char *>(cell);
    for (int i = region_count_.load(std::memory_order_acquire) - 1; i >= 0; i--) {
        const char *const begin = regions_[i].begin.load(std::memory_order_relaxed);
        if (place >= begin && place < begin + regions_[i].bytes) return true;
    }
    return false;
}
