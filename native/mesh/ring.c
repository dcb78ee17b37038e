/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "mesh/ring.h"

#include "swarf/base.h"

const ring_kernel *swarf_ring_kernel_current(void)
{
    switch (swarf_isa_current()) {
#if defined(SWARF_HAVE_X86)
    case SWARF_ISA_AVX512: return &swarf_ring_kernel_avx512;
    case SWARF_ISA_AVX2: return &swarf_ring_kernel_avx2;
#endif
    default: return &swarf_ring_kernel_scalar;
    }
}
