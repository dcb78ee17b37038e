/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Recall: what the rays through a picture's squares met, and what light gets there, is the same in the next picture,
 * while nothing is changed but how it is shaded: more samples, open sky, colours, a selection, the path. */
#ifndef SWARF_RENDER_RECALL_H
#define SWARF_RENDER_RECALL_H

#include "render/detail.h"
#include "swarf/render.h"

enum { SWARF_SECTIONS_MAX = 6 };

/** All of a picture's options that decide what its middles meet. */
typedef struct swarf_outlook {
    swarf_camera camera;
    int32_t width, height, coarse, exact;
    size_t section_count;
    swarf_cut_plane section[SWARF_SECTIONS_MAX];
    const swarf_cutter *cutter;
    double cutter_tip[3];
} swarf_outlook;

/** What lines there are about a grid square, 0 .. 255 each. */
typedef struct swarf_line_mark {
    uint8_t edge;    /* how much of an edge its middle is on */
    uint8_t outline; /* of what stands high before what is behind: these lines are dark in any case */
    uint8_t room;    /* how dark the others may be: less where they crowd */
} swarf_line_mark;

/** What a scene's scratch memory holds the middles of, and their light, lines and detail as far as they were asked for
 *  (see picture.h). */
typedef struct swarf_recall {
    swarf_outlook outlook; /* its cutter is kept, so that no other one can take its place in memory */
    int is_known;
    float *sky;
    uint8_t *sun;
    swarf_line_mark *mark;
    swarf_detail detail;
} swarf_recall;

/** The outlook of a picture whose camera and options have been checked, with the coarseness chosen. */
void swarf_outlook_make(const swarf_camera *camera, const swarf_picture_options *options, int32_t coarse,
                        swarf_outlook *out);

/** Whether these are the middles that are known. */
int swarf_recall_has(const swarf_recall *recall, const swarf_outlook *outlook);
void swarf_recall_keep(swarf_recall *recall, const swarf_outlook *outlook);
/** Whatever changes what can be met, or the memory, forgets. */
void swarf_recall_forget(swarf_recall *recall);

#endif
