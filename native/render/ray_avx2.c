/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernels of rays and pixels for avx2; see ray_body.h and pixel_body.h. */
#define KERNEL_NAME swarf_ray_kernel_avx2
#include "render/pixel_body.h"

#include "render/ray_body.h"
