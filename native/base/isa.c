/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Which instruction set variant of the kernels is in use; chosen once, at the first question. */
#include "base/status.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[] = {"scalar", "avx2", "avx512"};
static atomic_int chosen = -1;

static int supported(swarf_isa isa)
{
    if (isa == SWARF_ISA_SCALAR) return 1;
#if defined(SWARF_HAVE_X86)
    __builtin_cpu_init();
    if (isa == SWARF_ISA_AVX2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (isa == SWARF_ISA_AVX512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
    return 0;
}

swarf_isa swarf_isa_current(void)
{
    int isa = atomic_load_explicit(&chosen, memory_order_relaxed);
    if (isa >= 0) return (swarf_isa)isa;
    const char *wanted = getenv("SWARF_ISA");
    for (isa = SWARF_ISA_AVX512; isa > SWARF_ISA_SCALAR; isa--) {
        if (wanted && *wanted && strcmp(wanted, names[isa]) != 0) continue;
        if (supported((swarf_isa)isa)) break;
    }
    atomic_store(&chosen, isa);
    return (swarf_isa)isa;
}

const char *swarf_isa_name(swarf_isa isa)
{
    return isa >= SWARF_ISA_SCALAR && isa <= SWARF_ISA_AVX512 ? names[isa] : "unknown";
}

swarf_status swarf_isa_set(swarf_isa isa)
{
    SWARF_REQUIRE(isa >= SWARF_ISA_SCALAR && isa <= SWARF_ISA_AVX512 && supported(isa),
                  "instruction set %d: this processor or build lacks it", (int)isa);
    atomic_store(&chosen, (int)isa);
    return SWARF_OK;
}
