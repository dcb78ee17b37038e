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
    thread_local const unsigned number = threads.fetch_add(1, std::memory_order_relaxed);
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
    char *const begin = map_aligned(bytes);
    regions_[count].bytes = bytes;
    regions_[count].begin.store(begin, std::memory_order_relaxed);
    region_count_.store(count + 1, std::memory_order_release);
    next_ = begin;
    end_ = begin + bytes;
}

/* A shelf is empty: buffers that others gave back first, then fresh ones. */
void swarf_slab::refill(shelf &own)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    for (size_t i = 0; i < batch && shared_; i++) {
        free_buffer *const buffer = shared_;
        shared_ = buffer->next;
        buffer->next = own.free;
        own.free = buffer;
        own.count++;
    }
    if (own.free) return;
    if (next_ == end_) add_region();
    own.fresh = next_;
    own.fresh_end = next_ = next_ + batch * buffer_bytes;
}

void swarf_slab::spill(shelf &own) noexcept
{
    const std::lock_guard<std::mutex> lock(mutex_);
    for (; own.count > most_on_shelf / 2; own.count--) {
        free_buffer *const buffer = own.free;
        own.free = buffer->next;
        buffer->next = shared_;
        shared_ = buffer;
    }
}

float *swarf_slab::take()
{
    shelf &own = enter();
    try {
        if (!own.free && own.fresh == own.fresh_end) refill(own);
    } catch (...) {
        own.busy.clear(std::memory_order_release);
        throw;
    }
    void *found;
    if (own.free) {
        found = own.free;
        own.free = own.free->next;
        own.count--;
    } else {
        found = own.fresh;
        own.fresh += buffer_bytes;
    }
    own.busy.clear(std::memory_order_release);
    return static_cast<float *>(found);
}

void swarf_slab::give(float *buffer) noexcept
{
    shelf &own = enter();
    own.free = new (buffer) free_buffer{own.free};
    if (++own.count > most_on_shelf) spill(own);
    own.busy.clear(std::memory_order_release);
}

bool swarf_slab::owns(const float *buffer) const noexcept
{
    const char *const place = reinterpret_cast<const char *>(buffer);
    for (int i = region_count_.load(std::memory_order_acquire) - 1; i >= 0; i--) {
        const char *const begin = regions_[i].begin.load(std::memory_order_relaxed);
        if (place >= begin && place < begin + regions_[i].bytes) return true;
    }
    return false;
}
