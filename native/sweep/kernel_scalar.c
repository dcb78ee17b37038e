/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernels for scalar; see kernel_body.h. */
#define KERNEL_NAME swarf_kernel_scalar
#include "sweep/kernel_body.h"
