/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The kernel for scalar; see ring_body.h. */
#define KERNEL_NAME swarf_ring_kernel_scalar
#include "mesh/ring_body.h"
