/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* For libraries that bring their own TBB loops: run them on as many threads as swarf_parallel_for() would. */
#ifndef SWARF_BASE_ARENA_HPP
#define SWARF_BASE_ARENA_HPP

#include "base/parallel.h"
#include "base/status.h"

#include <tbb/task_arena.h>

#include <atomic>
#include <thread>
#include <utility>

/** Call `body` on this thread in an arena as wide as swarf_threads() says; its exceptions come through. */
template <typename Body> auto swarf_arena_run(Body &&body)
{
    tbb::task_arena arena(swarf_threads());
    return arena.execute(std::forward<Body>(body));
}

/** A progress callback in the form OpenVDB asks for ("interrupter"): reports from the calling thread only, never
 * falling, mapped to `from`..`to`; answers any thread whether to stop. */
class swarf_interrupter {
  public:
    explicit swarf_interrupter(const swarf_progress *progress) : progress_(progress) {}
    void part(double from, double to)
    {
        from_ = from;
        to_ = to;
    }
    void start(const char * = nullptr) {}
    void end() {}
    bool wasInterrupted(int percent = -1)
    {
        if (std::this_thread::get_id() == caller_ && !stopped_) {
            const double now = percent < 0 ? last_ : from_ + (to_ - from_) * percent / 100.0;
            if (now > last_) last_ = now;
            if (swarf_progress_report(progress_, last_) != SWARF_OK) stopped_ = true;
        }
        return stopped_;
    }
    /** SWARF_ERROR_CANCELLED once the caller wanted to stop. */
    swarf_status status() const
    {
        return stopped_ ? swarf_fail(SWARF_ERROR_CANCELLED, "cancelled") : SWARF_OK;
    }

  private:
    const swarf_progress *progress_;
    std::thread::id caller_ = std::this_thread::get_id();
    std::atomic<bool> stopped_{false};
    double from_ = 0, to_ = 1, last_ = 0;
};

#endif
