/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Parameters that the machine's state gives: numbered ones that follow it, and the predefined names. */
#include "gcode/machine.h"

#include "base/status.h"

#include <math.h>
#include <string.h>

/* Of a position in work or machine coordinates: lengths in the units in force. */
static double in_units(const swarf_machine *machine, int axis, double value)
{
    return axis >= 3 && axis <= 5 ? value : value / machine->modes.unit_mm;
}

static double absolute_of(const swarf_machine *machine, int axis)
{
    double absolute[SWARF_AXES];
    swarf_machine_absolute(machine, machine->position, absolute);
    return in_units(machine, axis, absolute[axis] - machine->offset[axis]);
}

static double tool_value(const swarf_machine *machine, int index)
{
    const swarf_gcode_tool *tool = swarf_machine_find_tool(machine, machine->section.tool);
    if (!tool) return 0.0;
    if (index <= 5409) return in_units(machine, index - 5401, tool->offset[index - 5401]);
    return index == 5410 ? in_units(machine, 0, tool->diameter_mm) : index == 5413 ? tool->orientation : 0.0;
}

double swarf_machine_parameter(const swarf_machine *machine, int index)
{
    if (index >= 5021 && index <= 5029) return absolute_of(machine, index - 5021);
    if (index >= 5420 && index <= 5428) return in_units(machine, index - 5420, machine->position[index - 5420]);
    if (index >= 5061 && index <= 5069) return in_units(machine, index - 5061, machine->parameters.numbered[index]);
    if (index >= 5081 && index <= 5089) return in_units(machine, index - 5081, machine->offset[index - 5081]);
    if (index == 5400) return machine->section.tool < 0 ? 0.0 : machine->section.tool;
    if (index >= 5401 && index <= 5413) return tool_value(machine, index);
    return machine->parameters.numbered[index];
}

swarf_status swarf_machine_check_setting(const swarf_machine *machine, const swarf_setting *setting,
                                         const swarf_word *word)
{
    const int i = setting->index;
    if ((i >= 5021 && i <= 5029) || (i >= 5081 && i <= 5089) || (i >= 5400 && i <= 5413) || (i >= 5420 && i <= 5428))
        return swarf_gcode_fail(machine, word, "assigns a parameter that the machine's state gives");
    if (i) return SWARF_OK;
    char name[SWARF_PARAMETER_NAME_MAX + 1];
    if (!swarf_parameter_name(setting->name, setting->name + setting->length, name))
        return swarf_gcode_fail(machine, word, "has no name, or one of more than %d characters",
                                SWARF_PARAMETER_NAME_MAX);
    double value;
    if (swarf_machine_predefined(machine, name, &value))
        return swarf_gcode_fail(machine, word, "assigns a parameter that the machine's state gives");
    return SWARF_OK;
}

swarf_status swarf_machine_set(swarf_machine *machine, const swarf_setting *setting)
{
    if (setting->index) {
        machine->parameters.numbered[setting->index] = setting->value;
        return SWARF_OK;
    }
    char name[SWARF_PARAMETER_NAME_MAX + 1];
    (void)swarf_parameter_name(setting->name, setting->name + setting->length, name);
    return swarf_parameters_set(&machine->parameters, name, setting->value);
}

int swarf_machine_predefined(const swarf_machine *machine, const char *name, double *out)
{
    if (name[0] != '_') return 0;
    name++;
    const swarf_modes *m = &machine->modes;
    if (name[0] && !name[1] && strchr("xyzabcuvw", name[0])) {
        const int axis = (int)(strchr("xyzabcuvw", name[0]) - "xyzabcuvw");
        *out = in_units(machine, axis, machine->position[axis]);
        return 1;
    }
    if (strncmp(name, "abs_", 4) == 0 && name[4] && !name[5] && strchr("xyzabcuvw", name[4])) {
        *out = absolute_of(machine, (int)(strchr("xyzabcuvw", name[4]) - "xyzabcuvw"));
        return 1;
    }
    static const int planes[3] = {170, 180, 190};
    const int system = machine->system;
    int offset = 0;
    for (int k = 0; k < SWARF_AXES; k++) offset |= machine->offset[k] != 0.0;
    const struct {
        const char *name;
        double value;
    } table[] = {
        {"line", machine->place.line},
        {"motion_mode", m->motion},
        {"plane", planes[m->plane]},
        {"ccomp", machine->comp.side ? machine->comp.code : 400},
        {"metric", m->unit_mm == 1.0},
        {"imperial", m->unit_mm != 1.0},
        {"absolute", !m->incremental},
        {"incremental", m->incremental},
        {"inverse_time", m->feed_mode == 930},
        {"units_per_minute", m->feed_mode == 940},
        {"units_per_rev", m->feed_mode == 950},
        {"coord_system", system <= 6 ? 530 + 10 * system : 584 + system},
        {"tool_offset", offset},
        {"retract_r_plane", m->retract_to_r},
        {"retract_old_z", !m->retract_to_r},
        {"spindle_rpm_mode", !m->surface},
        {"spindle_css_mode", m->surface},
        {"ijk_absolute_mode", m->arc_absolute},
        {"lathe_diameter_mode", 0},
        {"lathe_radius_mode", 1},
        {"spindle_on", m->spindle != SWARF_SPINDLE_OFF},
        {"spindle_cw", m->spindle == SWARF_SPINDLE_CW},
        {"mist", m->coolant & 1},
        {"flood", m->coolant >> 1 & 1},
        {"speed_override", 1},
        {"feed_override", 1},
        {"adaptive_feed", 0},
        {"feed_hold", 0},
        {"feed", m->feed_mode == 930 ? m->feed : m->feed / m->unit_mm},
        {"rpm", m->speed},
        {"current_tool", machine->section.tool < 0 ? 0 : machine->section.tool},
        {"current_pocket", machine->section.tool < 0 ? 0 : machine->section.tool},
        {"selected_tool", machine->selected},
        {"selected_pocket", machine->selected},
        {"value", machine->returned},
        {"value_returned", machine->has_returned},
        {"task", 0},
        {"call_level", machine->level},
        {"remap_level", 0},
        {"vmajor", 2.9},
        {"vminor", 0.0},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (strcmp(name, table[i].name) == 0) {
            *out = table[i].value;
            return 1;
        }
    return 0;
}
