/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* TBB behind C. One arena per call, as wide as swarf_threads() says. */
#include "base/parallel.h"

#include "base/guard.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace {

std::atomic<int> wanted_threads{0};
thread_local int current_slot = 0;

/* A piece of work may itself share work out, and then goes on in the slot it had. */
struct slot_kept {
    int own = current_slot;
    slot_kept() = default;
    slot_kept(const slot_kept &) = delete;
    slot_kept &operator=(const slot_kept &) = delete;
    ~slot_kept()
    {
        current_slot = own;
    }
};

/* Making an arena costs more than cutting one move, so the last one is kept for the next call of the same width;
 * calls that overlap get one of their own. */
std::mutex kept_mutex;

/* Never destroyed at exit: TBB may be gone by then. */
std::unique_ptr<tbb::task_arena> &kept_arena()
{
    static auto *const arena = new std::unique_ptr<tbb::task_arena>;
    return *arena;
}

[[maybe_unused]] std::unique_ptr<tbb::task_arena> take_arena(int threads)
{
    std::lock_guard<std::mutex> lock(kept_mutex);
    if (kept_arena() && kept_arena()->max_concurrency() == threads) return std::move(kept_arena());
    return std::make_unique<tbb::task_arena>(threads);
}

[[maybe_unused]] void keep_arena(std::unique_ptr<tbb::task_arena> arena)
{
    std::lock_guard<std::mutex> lock(kept_mutex);
    kept_arena() = std::move(arena);
}

/* TBB has a worker per core unless told otherwise; more are wanted when a count above that is asked for.
 * Never destroyed at exit: TBB may be gone by then. */
std::mutex pool_mutex;
tbb::global_control *pool_size = nullptr;

using clock_type = std::chrono::steady_clock;
/* Often enough for a smooth bar, rare enough that a Python callback costs nothing. */
std::atomic<int> report_interval_ms{25};

struct run {
    swarf_work_fn work;
    void *context;
    const swarf_progress *progress;
    double from, to;
    size_t count;
    std::thread::id caller = std::this_thread::get_id();
    std::atomic<size_t> done{0};
    std::atomic<int> failed{SWARF_OK};
    std::string text{}; /* written once, by the thread that sets `failed` */
    clock_type::time_point reported = clock_type::now();

    void stop(swarf_status status)
    {
        int expected = SWARF_OK;
        if (failed.compare_exchange_strong(expected, status)) text = swarf_error_last();
    }
    void one(size_t index)
    {
        if (failed.load(std::memory_order_relaxed) != SWARF_OK) return;
        const swarf_status status = work(context, index);
        if (status != SWARF_OK) stop(status);
        const size_t finished = done.fetch_add(1, std::memory_order_relaxed) + 1;
        if (!progress || std::this_thread::get_id() != caller) return;
        const auto now = clock_type::now();
        if (now - reported < std::chrono::milliseconds(report_interval_ms.load(std::memory_order_relaxed))) return;
        reported = now;
        /* rounded, from + (to - from) may be more than `to`, from where the next part goes on */
        const double share = static_cast<double>(finished) / static_cast<double>(count);
        const swarf_status answer =
            swarf_progress_report(progress, finished == count ? to : from + (to - from) * share);
        if (answer != SWARF_OK) stop(answer);
    }
};

#if defined(__SANITIZE_THREAD__)
/* TBB is not instrumented, so that the thread sanitizer does not see how it hands work over. Plain threads do the same
 * work in its place, and what it then reports is ours. */
void run_on(int threads, run &state)
{
    std::atomic<size_t> next{0};
    const auto take = [&](int slot) {
        current_slot = slot;
        for (size_t index = next++; index < state.count; index = next++) state.one(index);
    };
    std::vector<std::thread> team;
    for (int slot = 1; slot < threads; slot++) team.emplace_back(take, slot);
    take(0);
    for (std::thread &thread : team) thread.join();
}
#else
/* Pieces that one task does: handing over takes as long as a small piece. Few enough that the threads end together. */
size_t grain_of(size_t count, int threads)
{
    return std::clamp<size_t>(count / (256 * static_cast<size_t>(threads)), 1, 16);
}

void run_on(int threads, run &state)
{
    std::unique_ptr<tbb::task_arena> arena = take_arena(threads);
    arena->execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<size_t>(0, state.count, grain_of(state.count, threads)),
            [&](const tbb::blocked_range<size_t> &range) {
                current_slot = tbb::this_task_arena::current_thread_index();
                for (size_t index = range.begin(); index != range.end(); index++) state.one(index);
            },
            tbb::simple_partitioner());
    });
    keep_arena(std::move(arena));
}
#endif

} // namespace

extern "C" swarf_status swarf_threads_set(int count)
{
    SWARF_REQUIRE(count >= 0 && count <= 1024, "threads: %d is not in 0 .. 1024 (0: one per core)", count);
    return swarf_guard("threads", [&]() -> swarf_status {
        const std::lock_guard<std::mutex> lock(pool_mutex);
        delete pool_size;
        pool_size = nullptr;
        if (count > static_cast<int>(std::thread::hardware_concurrency()))
            pool_size =
                new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(count));
        wanted_threads.store(count);
        return SWARF_OK;
    });
}

extern "C" int swarf_threads(void)
{
    const int wanted = wanted_threads.load();
    if (wanted > 0) return wanted;
    const unsigned cores = std::thread::hardware_concurrency();
    return cores ? static_cast<int>(cores) : 1;
}

extern "C" int swarf_parallel_slot(void)
{
    return current_slot;
}

extern "C" swarf_status swarf_progress_interval_set(int milliseconds)
{
    SWARF_REQUIRE(milliseconds >= 0, "interval of progress: %d ms is negative", milliseconds);
    report_interval_ms.store(milliseconds);
    return SWARF_OK;
}

extern "C" swarf_status swarf_progress_report(const swarf_progress *progress, double fraction)
{
    if (progress && progress->fn && progress->fn(progress->user, fraction))
        return swarf_fail(SWARF_ERROR_CANCELLED, "cancelled");
    return SWARF_OK;
}

static int report_share(void *context, double fraction)
{
    const auto *share = static_cast<const swarf_progress_share *>(context);
    return share->whole->fn(share->whole->user, share->from + (share->to - share->from) * fraction);
}

extern "C" swarf_progress swarf_progress_part(swarf_progress_share *share)
{
    return {report_share, share};
}

extern "C" swarf_status swarf_parallel_for(size_t count, swarf_work_fn work, void *context,
                                           const swarf_progress *progress, double from, double to)
{
    if (count == 0) return SWARF_OK;
    return swarf_guard("parallel work", [&]() -> swarf_status {
        run state{work, context, progress && progress->fn ? progress : nullptr, from, to, count};
        const int threads = swarf_threads();
        const slot_kept kept;
        if (threads == 1 || count == 1) {
            current_slot = 0;
            for (size_t index = 0; index < count && state.failed.load() == SWARF_OK; index++) state.one(index);
        } else {
            run_on(threads, state);
        }
        const int failed = state.failed.load();
        if (failed != SWARF_OK) return swarf_fail(static_cast<swarf_status>(failed), "%s", state.text.c_str());
        return SWARF_OK;
    });
}
