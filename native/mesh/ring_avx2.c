/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernel for avx2; see ring_body.h. */
#define KERNEL_NAME swarf_ring_kernel_avx2
#include "mesh/ring_body.h"
