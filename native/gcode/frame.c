/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Frames: from work coordinates to machine coordinates and to the tip in the coordinates of the stock. */
#include "gcode/machine.h"

#include <math.h>
#include <string.h>

static const double degree = 0.017453292519943295769;

/* Multiples of a right angle exactly, so that G68 R90 leaves no dirt in the last digits. */
static void turn_of(double deg, double *cosine, double *sine)
{
    const double quarter = fmod(deg, 360.0) / 90.0;
    if (quarter == nearbyint(quarter)) {
        static const double exact[4] = {1.0, 0.0, -1.0, 0.0};
        const int q = ((int)quarter % 4 + 4) % 4;
        *cosine = exact[q];
        *sine = exact[(q + 3) % 4];
        return;
    }
    *cosine = cos(deg * degree);
    *sine = sin(deg * degree);
}

static void turn(double cosine, double sine, double *x, double *y)
{
    const double u = *x;
    *x = cosine * u - sine * *y;
    *y = sine * u + cosine * *y;
}

static void bend(const swarf_bend *b, double p[3])
{
    for (int k = 0; k < 3; k++) p[k] = b->scale_centre[k] + b->factor[k] * (p[k] - b->scale_centre[k]);
    p[0] -= b->turn_centre[0];
    p[1] -= b->turn_centre[1];
    turn(b->cosine, b->sine, &p[0], &p[1]);
    p[0] += b->turn_centre[0];
    p[1] += b->turn_centre[1];
}

static void unbend(const swarf_bend *b, double p[3])
{
    p[0] -= b->turn_centre[0];
    p[1] -= b->turn_centre[1];
    turn(b->cosine, -b->sine, &p[0], &p[1]);
    p[0] += b->turn_centre[0];
    p[1] += b->turn_centre[1];
    for (int k = 0; k < 3; k++) p[k] = b->scale_centre[k] + (p[k] - b->scale_centre[k]) / b->factor[k];
}

void swarf_machine_reframe(swarf_machine *machine)
{
    if (!machine->has_table) memcpy(machine->length, machine->offset, sizeof machine->length);
    if (!machine->frame_fixed) {
        memcpy(machine->frame, machine->work, sizeof machine->frame);
        machine->frame_deg = machine->turn_deg;
    }
    swarf_bend *b = &machine->bend;
    turn_of(b->angle, &b->cosine, &b->sine);
    turn_of(machine->turn_deg - machine->frame_deg, &machine->cosine, &machine->sine);
    double *constant = machine->constant, cosine, sine;
    for (int k = 0; k < 3; k++)
        constant[k] = machine->work[k] - machine->frame[k] + machine->offset[k] - machine->length[k];
    turn_of(-machine->frame_deg, &cosine, &sine);
    turn(cosine, sine, &constant[0], &constant[1]);
    machine->plain = !b->on && machine->turn_deg == machine->frame_deg;
    machine->frame_stale = 1;
}

void swarf_machine_tip(const swarf_machine *machine, const double work[3], double out[3])
{
    if (machine->plain) {
        for (int k = 0; k < 3; k++) out[k] = work[k] + machine->shift[k] + machine->constant[k];
        return;
    }
    double p[3] = {work[0], work[1], work[2]};
    if (machine->bend.on) bend(&machine->bend, p);
    for (int k = 0; k < 3; k++) p[k] += machine->shift[k];
    turn(machine->cosine, machine->sine, &p[0], &p[1]);
    for (int k = 0; k < 3; k++) out[k] = p[k] + machine->constant[k];
}

void swarf_machine_absolute(const swarf_machine *machine, const double work[SWARF_AXES], double out[SWARF_AXES])
{
    double p[SWARF_AXES];
    memcpy(p, work, sizeof p);
    if (machine->bend.on) bend(&machine->bend, p);
    for (int k = 0; k < SWARF_AXES; k++) p[k] += machine->shift[k];
    if (machine->turn_deg != 0.0) {
        double cosine, sine;
        turn_of(machine->turn_deg, &cosine, &sine);
        turn(cosine, sine, &p[0], &p[1]);
    }
    for (int k = 0; k < SWARF_AXES; k++) out[k] = p[k] + machine->work[k] + machine->offset[k];
}

void swarf_machine_relative(const swarf_machine *machine, const double absolute[SWARF_AXES], double out[SWARF_AXES])
{
    double p[SWARF_AXES];
    for (int k = 0; k < SWARF_AXES; k++) p[k] = absolute[k] - machine->work[k] - machine->offset[k];
    if (machine->turn_deg != 0.0) {
        double cosine, sine;
        turn_of(machine->turn_deg, &cosine, &sine);
        turn(cosine, -sine, &p[0], &p[1]);
    }
    for (int k = 0; k < SWARF_AXES; k++) p[k] -= machine->shift[k];
    if (machine->bend.on) unbend(&machine->bend, p);
    memcpy(out, p, sizeof p);
}

void swarf_machine_select_system(swarf_machine *machine, int system)
{
    double absolute[SWARF_AXES];
    swarf_machine_absolute(machine, machine->position, absolute);
    const double *numbered = machine->parameters.numbered + 5221 + 20 * (system - 1);
    machine->system = system;
    memcpy(machine->work, numbered, sizeof machine->work);
    machine->turn_deg = numbered[9];
    machine->parameters.numbered[5220] = system;
    machine->section.work_offset = system;
    swarf_machine_relative(machine, absolute, machine->position);
    swarf_machine_reframe(machine);
}
