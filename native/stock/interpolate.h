/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* A distance field between its voxels. */
#ifndef SWARF_STOCK_INTERPOLATE_H
#define SWARF_STOCK_INTERPOLATE_H

/** Voxels that are read beside a cell, on either side. */
enum { SWARF_CELL_HALO = 2 };

/** Value in voxels at `t` (0 .. 1 from the low corner along each axis) in the cell whose low corner is `low`, in a
 *  block with `stride` values to the next voxel along x and y, 1 along z. `limit`: values from which on nothing is
 *  known but the sign; it is returned where nothing more is. Any thread.
 *
 *  Where the field is smooth this is exact to second order. Beside edges and corners the faces go on from the voxels
 *  on either side of them until they meet: planes meet where they do, if they are two voxels wide. */
float swarf_field_interpolate(const float *low, const int stride[2], const double t[3], float limit);

#endif
