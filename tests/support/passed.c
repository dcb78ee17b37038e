/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "passed.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void passed_add(passed *list, int cell, int edge, double away)
{
    if (list->count == list->room) {
        list->room = 2 * list->room + 256;
        passed_vertex *grown = realloc(list->vertex, list->room * sizeof *grown);
        if (!grown) {
            fputs("out of memory\n", stderr);
            exit(2);
        }
        list->vertex = grown;
    }
    list->vertex[list->count++] = (passed_vertex){cell, edge, away};
}

/* Those of an edge of a cell follow each other, the nearest first. */
static int by_edge(const void *a, const void *b)
{
    const passed_vertex *x = a, *y = b;
    if (x->cell != y->cell) return x->cell < y->cell ? -1 : 1;
    if (x->edge != y->edge) return x->edge < y->edge ? -1 : 1;
    return (x->away > y->away) - (x->away < y->away);
}

passed_figures passed_end(passed *list, double far)
{
    passed_figures out = {0};
    if (list->count) qsort(list->vertex, list->count, sizeof *list->vertex, by_edge);
    for (size_t i = 0; i < list->count; i++) {
        const passed_vertex *own = &list->vertex[i];
        if (i > 0 && own->cell == own[-1].cell && own->edge == own[-1].edge) continue;
        out.count++;
        out.most = fmax(out.most, own->away);
        out.far += own->away > far;
    }
    free(list->vertex);
    *list = (passed){0};
    return out;
}
