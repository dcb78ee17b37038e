/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include "sweep/column.h"

#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static swarf_status reserve(swarf_column *column, size_t count)
{
    if (count + COLUMN_SLACK <= column->room) return SWARF_OK;
    const size_t room = 2 * count + 4 * COLUMN_SLACK;
    swarf_column_free(column);
    int ok = 1;
    for (int i = 0; i < COLUMN_FIELDS; i++) ok &= (column->field[i] = malloc(room * sizeof(float))) != NULL;
    for (int i = 0; i < COLUMN_LISTS; i++) ok &= (column->list[i] = malloc(room * sizeof(int32_t))) != NULL;
    for (int i = 0; i < BLOCKS_AT_ONCE; i++) {
        ok &= (column->bound[i] = malloc(room * sizeof(float))) != NULL;
        ok &= (column->floor[i] = malloc(room * sizeof(float))) != NULL;
    }
    ok &= (column->kind = malloc(room)) != NULL;
    if (!ok) {
        swarf_column_free(column);
        return swarf_fail(SWARF_ERROR_MEMORY, "stock: out of memory for %zu moves in one place", count);
    }
    column->room = room;
    return SWARF_OK;
}

void swarf_column_free(swarf_column *column)
{
    for (int i = 0; i < COLUMN_FIELDS; i++) free(column->field[i]);
    for (int i = 0; i < COLUMN_LISTS; i++) free(column->list[i]);
    for (int i = 0; i < BLOCKS_AT_ONCE; i++) {
        free(column->bound[i]);
        free(column->floor[i]);
    }
    free(column->kind);
    memset(column, 0, sizeof *column);
}

static double clamp(double value, double lo, double hi)
{
    return value < lo ? lo : value > hi ? hi : value;
}

static void fill_line(swarf_column *column, size_t k, const swarf_track *track)
{
    const double x = column->middle[0] - track->point[0], y = column->middle[1] - track->point[1];
    const double s = clamp(x * track->ux + y * track->uy, 0, track->run);
    const double slope = track->slope, length = track->length, stretch = track->run > 0 ? length / track->run : 0;
    const int rises = track->rise > 0;
    float **f = column->field;
    f[COLUMN_X][k] = (float)(track->ux * s - x);
    f[COLUMN_Y][k] = (float)(track->uy * s - y);
    f[COLUMN_Z][k] = (float)(track->point[2] + slope * s - column->middle[2]);
    f[COLUMN_UX][k] = (float)track->ux;
    f[COLUMN_UY][k] = (float)track->uy;
    f[COLUMN_S0][k] = (float)-s;
    f[COLUMN_S1][k] = (float)(track->run - s);
    f[COLUMN_M][k] = (float)slope;
    f[COLUMN_IM][k] = (float)(1 / sqrt(1 + slope * slope));
    f[COLUMN_RISE][k] = (float)(track->run > 0 ? 0 : track->rise);
    f[COLUMN_DX][k] = (float)(length > 0 ? track->ux * track->run / length : 0);
    f[COLUMN_DY][k] = (float)(length > 0 ? track->uy * track->run / length : 0);
    f[COLUMN_DZ][k] = (float)(length > 0 ? track->rise / length : 1);
    f[COLUMN_T0][k] = (float)(-s * stretch);
    f[COLUMN_T1][k] = (float)(track->run > 0 ? (track->run - s) * stretch : track->rise);
    for (int i = COLUMN_AX; i <= COLUMN_BY; i++) f[i][k] = 0;
    column->kind[k] = track->run > 0 && rises ? TRACK_TILTED : TRACK_LEVEL;
}

static void fill_arc(swarf_column *column, size_t k, const swarf_track *track)
{
    const double *c = track->centre, R = track->radius;
    double nx = column->middle[0] - c[0], ny = column->middle[1] - c[1];
    const double away = hypot(nx, ny);
    const double a[2] = {cos(track->from), sin(track->from)};
    const double b[2] = {cos(track->from + track->turn), sin(track->from + track->turn)};
    nx = away > 0 ? nx / away : a[0];
    ny = away > 0 ? ny / away : a[1];
    float **f = column->field;
    f[COLUMN_X][k] = (float)(c[0] + R * nx - column->middle[0]);
    f[COLUMN_Y][k] = (float)(c[1] + R * ny - column->middle[1]);
    f[COLUMN_Z][k] = (float)(track->point[2] - column->middle[2]);
    f[COLUMN_UX][k] = (float)nx;
    f[COLUMN_UY][k] = (float)ny;
    f[COLUMN_S0][k] = (float)(1 / R);
    f[COLUMN_M][k] = 0;
    f[COLUMN_IM][k] = 1;
    f[COLUMN_RISE][k] = 0;
    f[COLUMN_NAX][k] = (float)a[0];
    f[COLUMN_NAY][k] = (float)a[1];
    f[COLUMN_NBX][k] = (float)b[0];
    f[COLUMN_NBY][k] = (float)b[1];
    f[COLUMN_A][k] = (float)(R * (a[0] * ny - a[1] * nx));
    f[COLUMN_B][k] = (float)(R * (nx * b[1] - ny * b[0]));
    f[COLUMN_AX][k] = (float)(c[0] + R * a[0] - column->middle[0]);
    f[COLUMN_AY][k] = (float)(c[1] + R * a[1] - column->middle[1]);
    f[COLUMN_BX][k] = (float)(c[0] + R * b[0] - column->middle[0]);
    f[COLUMN_BY][k] = (float)(c[1] + R * b[1] - column->middle[1]);
    column->kind[k] = TRACK_ARC;
    if (track->turn >= 2 * M_PI - 1e-12)
        column->kind[k] |= TRACK_ARC_FULL;
    else if (track->turn > M_PI)
        column->kind[k] |= TRACK_ARC_MAJOR;
    column->arcs = 1;
}

swarf_status swarf_column_fill(swarf_column *column, const double middle[3], const swarf_track *tracks,
                               const int32_t *numbers, size_t count)
{
    column->count = 0;
    SWARF_TRY(reserve(column, count));
    memcpy(column->middle, middle, sizeof column->middle);
    column->arcs = 0;
    for (size_t k = 0; k < count; k++) {
        const swarf_track *track = &tracks[numbers ? (size_t)numbers[k] : k];
        if (track->is_arc)
            fill_arc(column, k, track);
        else
            fill_line(column, k, track);
        column->list[LIST_ALL][k] = (int32_t)k;
    }
    for (int i = 0; i < COLUMN_SLACK; i++) column->list[LIST_ALL][count + (size_t)i] = 0;
    column->count = count;
    return SWARF_OK;
}
