/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The tracing kernels for scalar; see ray_body.h. */
#define KERNEL_NAME swarf_ray_kernel_scalar
#include "render/ray_body.h"
