/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Eigenvalues of symmetric 3x3 matrices. */
#ifndef SWARF_MESH_EIGEN_H
#define SWARF_MESH_EIGEN_H

/** Eigenvalues, the greatest first, and their unit eigenvectors (rows) of a symmetric matrix, by Jacobi's rotations:
 *  as exact as doubles are, also for repeated eigenvalues. Any thread. */
void swarf_eigen_symmetric(const double matrix[3][3], double value[3], double vector[3][3]);

#endif
