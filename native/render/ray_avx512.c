/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The tracing kernels for avx512; see ray_body.h. */
#define KERNEL_NAME swarf_ray_kernel_avx512
#include "render/ray_body.h"
