/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernels for avx512; see kernel_body.h. */
#define KERNEL_NAME swarf_kernel_avx512
#include "sweep/kernel_body.h"
