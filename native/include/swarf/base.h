/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Base: statuses and their text, progress and cancelling, threads, instruction set.
 *
 * Every function that can fail returns a swarf_status, writes its outputs last and leaves them
 * untouched on failure. The text of the last failure is kept per thread. All may return
 * SWARF_ERROR_ARGUMENT for NULL, numbers not finite or options of another size, and
 * SWARF_ERROR_MEMORY; those with progress SWARF_ERROR_CANCELLED; those with a stock
 * SWARF_ERROR_BUSY. What else they return, and when, their docstrings name.
 */
#ifndef SWARF_BASE_H
#define SWARF_BASE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define SWARF_API __attribute__((visibility("default")))
#define SWARF_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define SWARF_API
#define SWARF_PRINTF(format_index, first)
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define SWARF_VERSION_MAJOR 0
#define SWARF_VERSION_MINOR 1
#define SWARF_VERSION_PATCH 0

/** What a call came to: 0 is success, every failure is negative. */
typedef enum swarf_status {
    SWARF_OK = 0,
    SWARF_ERROR_ARGUMENT = -1,  /**< a value the caller passed is wrong (NULL, NaN, out of range) */
    SWARF_ERROR_MEMORY = -2,    /**< the memory is not there, or the estimate exceeds the limit */
    SWARF_ERROR_IO = -3,        /**< a file cannot be opened, read or written */
    SWARF_ERROR_FORMAT = -4,    /**< a file or text is not what it should be; the text says where */
    SWARF_ERROR_GEOMETRY = -5,  /**< a shape that cannot be worked with (open mesh, empty profile) */
    SWARF_ERROR_CANCELLED = -6, /**< the progress callback asked to stop; the object stays valid */
    SWARF_ERROR_BUSY = -7,      /**< the object is in use by another thread */
    SWARF_ERROR_INTERNAL = -8   /**< an exception of a library, or a broken invariant of ours */
} swarf_status;

/** Text of this thread's last failure: what was wrong, where, and what would be right; "" if none.
 *  Owned by the library, valid until this thread's next failing call. Any thread. */
SWARF_API const char *swarf_error_last(void);

/** Short English name of a status ("argument", "memory" ...). Any thread. */
SWARF_API const char *swarf_status_name(swarf_status status);

/** "0.1.0". Any thread. */
SWARF_API const char *swarf_version(void);

/** Progress of a long call, 0..1, never falling; a non-zero return cancels the call.
 *  Called from the thread that made the call, a few dozen times a second at most. */
typedef int (*swarf_progress_fn)(void *user, double fraction);

/** A progress callback with its user pointer; pass NULL where none is wanted. */
typedef struct swarf_progress {
    swarf_progress_fn fn;
    void *user;
} swarf_progress;

/** At least so many milliseconds pass between two reports of one loop (25 at first), this process over. With 0 each
 *  piece of work done by the calling thread is reported, so that with one thread a callback can stop a call at the same
 *  place on any machine. SWARF_ERROR_ARGUMENT if negative. Any thread. */
SWARF_API swarf_status swarf_progress_interval_set(int milliseconds);

/** Set how many threads the library may use, this process over; 0 means one per core.
 *  Results never depend on it. SWARF_ERROR_ARGUMENT if negative or above 1024. Any thread. */
SWARF_API swarf_status swarf_threads_set(int count);

/** Number of threads in use (never 0). Any thread. */
SWARF_API int swarf_threads(void);

/** Instruction set variants of the kernels; all give the same bits. */
typedef enum swarf_isa { SWARF_ISA_SCALAR = 0, SWARF_ISA_AVX2 = 1, SWARF_ISA_AVX512 = 2 } swarf_isa;

/** The variant in use: the best this processor has, or what the environment variable SWARF_ISA
 *  (scalar, avx2, avx512) asked for at start. Any thread. */
SWARF_API swarf_isa swarf_isa_current(void);

/** "scalar", "avx2" or "avx512". Any thread. */
SWARF_API const char *swarf_isa_name(swarf_isa isa);

/** Use another variant from now on, for tests and benchmarks.
 *  SWARF_ERROR_ARGUMENT if this processor or build lacks it. Not while other calls run. */
SWARF_API swarf_status swarf_isa_set(swarf_isa isa);

/** Peak resident memory of this process in bytes, 0 where the system does not tell. Any thread. */
SWARF_API size_t swarf_memory_peak(void);

/** An axis-aligned box in mm; empty when lo > hi in any coordinate. */
typedef struct swarf_box {
    double lo[3];
    double hi[3];
} swarf_box;

/** Borrowed view of triangles: `xyz` holds 3 * vertex_count floats (mm), `index` holds
 *  3 * triangle_count vertex numbers, counter-clockwise seen from outside. */
typedef struct swarf_triangles {
    const float *xyz;
    size_t vertex_count;
    const uint32_t *index;
    size_t triangle_count;
} swarf_triangles;

/** What the edges of a triangle set say of it. */
typedef struct swarf_topology {
    size_t boundary_edges;    /**< used by one triangle only: the surface is open there */
    size_t nonmanifold_edges; /**< used by more than two triangles */
    size_t misoriented_edges; /**< used by two triangles in the same direction */
    size_t degenerate;        /**< triangles with a repeated vertex */
    int closed;               /**< 1 when every edge is used an even number of times, balanced both ways */
    double volume_mm3;        /**< signed volume, positive when oriented outwards */
    double area_mm2;
    swarf_box box;
} swarf_topology;

/** Measure the topology of triangles by their vertex numbers (weld first where a file has none).
 *  SWARF_ERROR_ARGUMENT for NULL, an index out of range or a coordinate that is not finite. Any thread. */
SWARF_API swarf_status swarf_triangles_topology(const swarf_triangles *triangles, swarf_topology *out);

#ifdef __cplusplus
}
#endif
#endif
