/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The one guard that every extern "C" body over C++ runs in: exceptions become statuses. */
#ifndef SWARF_BASE_GUARD_HPP
#define SWARF_BASE_GUARD_HPP

#include "base/status.h"

#include <exception>
#include <new>

template <typename Body> swarf_status swarf_guard(const char *what, Body &&body) noexcept
{
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return swarf_fail(SWARF_ERROR_MEMORY, "%s: out of memory; use a larger voxel", what);
    } catch (const std::exception &error) {
        return swarf_fail(SWARF_ERROR_INTERNAL, "%s: %s", what, error.what());
    } catch (...) {
        return swarf_fail(SWARF_ERROR_INTERNAL, "%s: unknown exception", what);
    }
}

#endif
