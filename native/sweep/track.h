/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Tracks: paths in index space (voxels of a layout), reduced to what the kernels know: straight lines, upwards, and
 * level arcs. Moves are symmetric in time, so that a line that falls is swept from its end. Helices and arcs in the
 * ZX and YZ planes become chords that leave them by less than SWARF_SWEEP_BOUND voxels. */
#ifndef SWARF_SWEEP_TRACK_H
#define SWARF_SWEEP_TRACK_H

#include "swarf/program.h"

typedef struct swarf_track {
    double point[3];          /* lower end of a line; an arc: its height in z */
    double ux, uy, run, rise; /* line: horizontal direction (unit), horizontal and vertical length, both >= 0 */
    double length, slope;     /* line: in space; rise / run, 0 where it is vertical */
    double centre[2], radius; /* arc */
    double from, turn;        /* arc: angle of its start, turn > 0 counter-clockwise, at most 2 pi */
    int is_arc;
} swarf_track;

typedef struct swarf_track_list {
    swarf_track *tracks;
    size_t count, room;
} swarf_track_list;

/** Append the tracks of a path; nothing when it has no motion. `origin` and `voxel` (mm) make the index space. */
swarf_status swarf_track_append(swarf_track_list *list, const swarf_path *path, const double origin[3], double voxel);

#endif
