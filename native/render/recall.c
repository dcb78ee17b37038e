/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "render/recall.h"

#include <stdlib.h>
#include <string.h>

void swarf_outlook_make(const swarf_camera *camera, const swarf_picture_options *options, int32_t coarse,
                        swarf_outlook *out)
{
    memset(out, 0, sizeof *out); /* they are compared as bytes, those between members too */
    out->camera = *camera;
    out->width = options->width;
    out->height = options->height;
    out->coarse = coarse;
    out->exact = options->exact;
    out->section_count = options->section_count;
    for (size_t i = 0; i < options->section_count; i++) out->section[i] = options->section[i];
    if (!options->cutter) return;
    out->cutter = options->cutter;
    memcpy(out->cutter_tip, options->cutter_tip, sizeof out->cutter_tip);
}

int swarf_recall_has(const swarf_recall *recall, const swarf_outlook *outlook)
{
    return recall->is_known && memcmp(&recall->outlook, outlook, sizeof *outlook) == 0;
}

void swarf_recall_keep(swarf_recall *recall, const swarf_outlook *outlook)
{
    swarf_recall_forget(recall);
    recall->outlook = *outlook;
    recall->is_known = 1;
    if (outlook->cutter) (void)swarf_cutter_retain((swarf_cutter *)outlook->cutter);
}

void swarf_recall_forget(swarf_recall *recall)
{
    if (recall->is_known) swarf_cutter_release((swarf_cutter *)recall->outlook.cutter);
    free(recall->sky);
    free(recall->sun);
    free(recall->mark);
    swarf_detail_forget(&recall->detail);
    *recall = (swarf_recall){.is_known = 0};
}
