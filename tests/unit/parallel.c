/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* swarf_parallel_for: every index once, the first failure wins with its text, cancelling, progress, slots. */
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/status.h"
#include "test.h"

enum { COUNT = 20000 };

/* One slot per index. Plain, not atomic: the thread sanitizer sees it when an index is given out twice. */
static int visits[COUNT];
static double products[COUNT];

static swarf_status visit(void *context, size_t index)
{
    visits[index]++;
    products[index] = 0;
    for (int k = 0; k < 50; k++) products[index] += (double)(index + (size_t)k) * *(const double *)context;
    return SWARF_OK;
}

static void check_every_index_once(int threads)
{
    const double factor = 0.5;
    CHECK_OK(swarf_threads_set(threads));
    memset(visits, 0, sizeof visits);
    CHECK_OK(swarf_parallel_for(COUNT, visit, (void *)&factor, NULL, 0, 1));
    size_t wrong = 0;
    for (size_t i = 0; i < COUNT; i++) wrong += visits[i] != 1 || products[i] != 0.5 * (50.0 * (double)i + 1225.0);
    CHECK(wrong == 0);
    CHECK_OK(swarf_parallel_for(0, visit, (void *)&factor, NULL, 0, 1));
}

typedef struct failing {
    size_t bad_from; /* this index and all after it fail */
    atomic_size_t calls;
} failing;

static swarf_status fail_late(void *context, size_t index)
{
    failing *f = context;
    atomic_fetch_add(&f->calls, 1);
    if (index >= f->bad_from) return swarf_fail(SWARF_ERROR_GEOMETRY, "piece %zu is bad", index);
    return SWARF_OK;
}

/* On any thread the failure's text must reach the caller, and the rest must not be worked off. */
static void check_failure(int threads)
{
    CHECK_OK(swarf_threads_set(threads));
    failing one = {COUNT - 1, 0};
    CHECK_FAILS(swarf_parallel_for(COUNT, fail_late, &one, NULL, 0, 1), SWARF_ERROR_GEOMETRY, "piece 19999 is bad");
    failing many = {0, 0};
    CHECK_FAILS(swarf_parallel_for(COUNT, fail_late, &many, NULL, 0, 1), SWARF_ERROR_GEOMETRY, "is bad");
    CHECK(atomic_load(&many.calls) <= (size_t)threads);
}

typedef struct watch {
    pthread_t caller;
    double last, lowest, highest, stop_at;
    size_t calls, strangers, falls;
} watch;

static int on_progress(void *user, double fraction)
{
    watch *w = user;
    w->strangers += !pthread_equal(pthread_self(), w->caller);
    w->falls += fraction < w->last;
    w->last = fraction;
    if (fraction < w->lowest) w->lowest = fraction;
    if (fraction > w->highest) w->highest = fraction;
    w->calls++;
    return fraction >= w->stop_at;
}

/* About 50 us of work. */
static swarf_status dawdle(void *context, size_t index)
{
    volatile double sum = 0;
    for (int k = 0; k < 25000; k++) sum = sum + (double)k;
    atomic_fetch_add((atomic_size_t *)context, 1);
    (void)index;
    return SWARF_OK;
}

typedef struct queue {
    watch *watch;
    size_t before; /* reports that other threads wait for */
    atomic_size_t reports, done;
} queue;

static int on_report(void *user, double fraction)
{
    queue *q = user;
    const int answer = on_progress(q->watch, fraction);
    atomic_fetch_add(&q->reports, 1);
    return answer;
}

/* The caller works, and reports, before the others: else these might do everything while it waits for a core. */
static swarf_status queue_up(void *context, size_t index)
{
    queue *q = context;
    const int is_caller = pthread_equal(pthread_self(), q->watch->caller);
    while (!is_caller && atomic_load(&q->reports) < q->before) sched_yield();
    return dawdle(&q->done, index);
}

static void check_progress(int threads)
{
    CHECK_OK(swarf_threads_set(threads));
    watch w = {.caller = pthread_self(), .lowest = 2, .highest = -1, .stop_at = 2};
    queue q = {.watch = &w, .before = 5};
    const swarf_progress progress = {on_report, &q};
    CHECK_OK(swarf_progress_interval_set(0)); /* each piece of the caller's is reported, however short it is */
    CHECK_OK(swarf_parallel_for(500, queue_up, &q, &progress, 0.25, 0.75));
    CHECK(atomic_load(&q.done) == 500);
    CHECK(w.calls >= 5);
    CHECK(w.strangers == 0);
    CHECK(w.falls == 0);
    CHECK(w.lowest >= 0.25 && w.highest <= 0.75);

    w = (watch){.caller = pthread_self(), .lowest = 2, .highest = -1, .stop_at = 0};
    q = (queue){.watch = &w, .before = 1};
    CHECK_FAILS(swarf_parallel_for(500, queue_up, &q, &progress, 0, 1), SWARF_ERROR_CANCELLED, "cancelled");
    CHECK(w.calls == 1);

    /* one thread stops at the same piece on any machine */
    CHECK_OK(swarf_threads_set(1));
    w = (watch){.caller = pthread_self(), .lowest = 2, .highest = -1, .stop_at = 0.5};
    q = (queue){.watch = &w};
    CHECK_FAILS(swarf_parallel_for(500, queue_up, &q, &progress, 0, 1), SWARF_ERROR_CANCELLED, "cancelled");
    CHECK(w.calls == 250 && atomic_load(&q.done) == 250);

    CHECK_FAILS(swarf_progress_interval_set(-1), SWARF_ERROR_ARGUMENT, "-1 ms");
    CHECK_OK(swarf_progress_interval_set(3600000)); /* nothing is told before it is over */
    w = (watch){.caller = pthread_self(), .lowest = 2, .highest = -1, .stop_at = 2};
    CHECK_OK(swarf_parallel_for(500, queue_up, &q, &progress, 0, 1));
    CHECK(w.calls == 0);
    CHECK_OK(swarf_progress_interval_set(25));
}

/* A loop inside a loop, and two threads that loop at the same time, share the pool. */
static swarf_status nest(void *context, size_t index)
{
    (void)index;
    return swarf_parallel_for(50, dawdle, context, NULL, 0, 1);
}

static void *loop_beside(void *context)
{
    return swarf_parallel_for(8, nest, context, NULL, 0, 1) == SWARF_OK ? context : NULL;
}

static void check_sharing(void)
{
    CHECK_OK(swarf_threads_set(3));
    atomic_size_t here = 0, beside = 0;
    pthread_t other;
    void *result = NULL;
    if (!CHECK(pthread_create(&other, NULL, loop_beside, &beside) == 0)) return;
    CHECK_OK(swarf_parallel_for(8, nest, &here, NULL, 0, 1));
    pthread_join(other, &result);
    CHECK(result == &beside);
    CHECK(atomic_load(&here) == 400 && atomic_load(&beside) == 400);
}

typedef struct slots {
    atomic_int busy[8];
    atomic_size_t wrong;
} slots;

static swarf_status nothing(void *context, size_t index)
{
    (void)context;
    (void)index;
    return SWARF_OK;
}

/* A piece has its slot for itself, a loop inside it or not. */
static swarf_status keep_slot(void *context, size_t index)
{
    slots *s = context;
    const int own = swarf_parallel_slot();
    atomic_fetch_add(&s->wrong, (size_t)(atomic_fetch_add(&s->busy[own], 1) != 0));
    const swarf_status status = index % 3 ? SWARF_OK : swarf_parallel_for(2, nothing, NULL, NULL, 0, 1);
    atomic_fetch_add(&s->wrong, (size_t)(swarf_parallel_slot() != own));
    atomic_fetch_sub(&s->busy[own], 1);
    return status;
}

static void check_slots(int threads)
{
    CHECK_OK(swarf_threads_set(threads));
    slots s = {.wrong = 0};
    CHECK_OK(swarf_parallel_for(COUNT, keep_slot, &s, NULL, 0, 1));
    CHECK(atomic_load(&s.wrong) == 0);
    CHECK(swarf_parallel_slot() == 0);
}

static int note(void *user, double fraction)
{
    *(double *)user = fraction;
    return fraction > 0.5;
}

static void check_share(void)
{
    double told = -1;
    const swarf_progress whole = {note, &told};
    swarf_progress_share share = {&whole, 0.25, 0.75};
    const swarf_progress part = swarf_progress_part(&share);
    CHECK_OK(swarf_progress_report(&part, 0));
    CHECK_NEAR(told, 0.25, 1e-15);
    CHECK_OK(swarf_progress_report(&part, 0.5));
    CHECK_NEAR(told, 0.5, 1e-15);
    CHECK_FAILS(swarf_progress_report(&part, 1), SWARF_ERROR_CANCELLED, "cancelled");
    CHECK_NEAR(told, 0.75, 1e-15);
}

int main(void)
{
    static const int threads[] = {1, 2, 3, 8};
    for (size_t i = 0; i < sizeof threads / sizeof threads[0]; i++) {
        check_every_index_once(threads[i]);
        check_failure(threads[i]);
        check_progress(threads[i]);
        check_slots(threads[i]);
    }
    check_sharing();
    check_share();
    return test_end();
}
