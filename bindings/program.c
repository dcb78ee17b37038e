/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* swarf.Program: built by one thread, then read by many.
 *
 * libswarf leaves it to the caller that nobody builds while another reads. Here two counters do that: views of the
 * arrays (`exports`) and calls that read without the GIL (`readers`); while either is above 0 the program is closed.
 */
#include "native.h"

#include <math.h>
#include <stdlib.h>

static const char *const kind_names[] = {"rapid", "feed", "dwell", "tool_change", "probe", "position"};
static const char *const plane_names[] = {"xy", "zx", "yz"};
static const char *const spindle_names[] = {"off", "cw", "ccw"};

/* A machine's usual rapid rate where nobody told; only the time estimate depends on it. */
#define RAPID_MM_MIN 5000.0

static swarf_program *handle_of(PyObject *self)
{
    return ((program_object *)self)->handle;
}

PyObject *program_wrap(PyTypeObject *type, swarf_program *handle)
{
    program_object *self = (program_object *)PyType_GenericAlloc(type, 0);
    if (!self) {
        swarf_program_release(handle);
        return NULL;
    }
    self->handle = handle;
    return (PyObject *)self;
}

static PyObject *program_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"start", NULL};
    PyObject *start = Py_None;
    double point[3];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "|O:Program", names, &start)) return NULL;
    if (start != Py_None && buffer_point(start, "start", point)) return NULL;
    swarf_program *handle;
    const swarf_status status = swarf_program_create(start == Py_None ? NULL : point, &handle);
    return status ? error_raise(state_of_type(type), status) : program_wrap(type, handle);
}

static void program_dealloc(PyObject *self)
{
    swarf_program_release(handle_of(self));
    Py_XDECREF(((program_object *)self)->notes);
    object_free(self);
}

/* ---- building ---- */

/** Nobody reads the program: it may change. */
static int program_open(PyObject *self)
{
    const program_object *program = (program_object *)self;
    if (program->readers) {
        PyErr_SetString(state_of(self)->busy_error, "the program is being read by another call");
        return -1;
    }
    if (program->exports) {
        PyErr_SetString(PyExc_BufferError, "views of the program's arrays exist: it cannot grow");
        return -1;
    }
    return 0;
}

static PyObject *finish(PyObject *self, swarf_status status)
{
    if (status) return error_raise(state_of(self), status);
    Py_RETURN_NONE;
}

static PyObject *program_add_operation(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"name", NULL};
    const char *name;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "s:add_operation", names, &name) || program_open(self))
        return NULL;
    const size_t index = swarf_program_operation_count(handle_of(self));
    const swarf_status status = swarf_program_add_operation(handle_of(self), name);
    return status ? error_raise(state_of(self), status) : PyLong_FromSize_t(index);
}

static PyObject *program_set_section(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"tool", "operation", "spindle", "spindle_rpm", "coolant", "work_offset", NULL};
    const char *spindle = spindle_names[0];
    const size_t operations = swarf_program_operation_count(handle_of(self));
    swarf_section section = {.tool = -1, .operation = operations ? (int)operations - 1 : 0};
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "|$iisdii:set_section", names, &section.tool, &section.operation,
                                     &spindle, &section.spindle_rpm, &section.coolant, &section.work_offset))
        return NULL;
    section.spindle = choice_find("spindle", spindle, spindle_names, 3);
    if (section.spindle < 0 || program_open(self)) return NULL;
    return finish(self, swarf_program_set_section(handle_of(self), &section));
}

static PyObject *program_add_line(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"end", "kind", "feed_mm_min", "line", NULL};
    PyObject *end_object;
    const char *kind_text = kind_names[SWARF_MOVE_FEED];
    double end[3], feed = 0;
    unsigned int line = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O|$sdI:add_line", names, &end_object, &kind_text, &feed, &line) ||
        buffer_point(end_object, "end", end))
        return NULL;
    const int kind = choice_find("kind", kind_text, kind_names, 6);
    if (kind < 0 || program_open(self)) return NULL;
    return finish(self, swarf_program_add_line(handle_of(self), (swarf_move_kind)kind, end, feed, line));
}

static PyObject *program_add_arc(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"end", "centre", "plane", "ccw", "turns", "feed_mm_min", "line", NULL};
    PyObject *end_object, *centre_object;
    const char *plane_text = plane_names[0];
    double end[3], centre[3], feed = 0;
    int ccw = 1, turns = 1;
    unsigned int line = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OO|$spidI:add_arc", names, &end_object, &centre_object,
                                     &plane_text, &ccw, &turns, &feed, &line) ||
        buffer_point(end_object, "end", end) || buffer_point(centre_object, "centre", centre))
        return NULL;
    const int plane = choice_find("plane", plane_text, plane_names, 3);
    if (plane < 0 || program_open(self)) return NULL;
    return finish(self,
                  swarf_program_add_arc(handle_of(self), end, centre, (swarf_plane)plane, ccw, turns, feed, line));
}

static PyObject *program_add_dwell(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"seconds", "line", NULL};
    double seconds;
    unsigned int line = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "d|$I:add_dwell", names, &seconds, &line) || program_open(self))
        return NULL;
    return finish(self, swarf_program_add_event(handle_of(self), SWARF_MOVE_DWELL, seconds, line));
}

static PyObject *program_add_tool_change(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"line", NULL};
    unsigned int line = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "|$I:add_tool_change", names, &line) || program_open(self))
        return NULL;
    return finish(self, swarf_program_add_event(handle_of(self), SWARF_MOVE_TOOL_CHANGE, 0, line));
}

/* ---- reading ---- */

int program_range(program_object *program, Py_ssize_t first, PyObject *count, size_t *first_out, size_t *count_out)
{
    const Py_ssize_t moves = (Py_ssize_t)swarf_program_move_count(program->handle);
    if (first < 0 || first > moves) {
        PyErr_Format(PyExc_ValueError, "first: %zd is not in 0 .. %zd, the number of moves", first, moves);
        return -1;
    }
    Py_ssize_t wanted = moves - first;
    if (count != Py_None) {
        if (!count_read(count, &wanted)) return -1;
        if (wanted < 0 || wanted > moves - first) {
            PyErr_Format(PyExc_ValueError, "count: %zd is not in 0 .. %zd, the moves from there", wanted,
                         moves - first);
            return -1;
        }
    }
    *first_out = (size_t)first;
    *count_out = (size_t)wanted;
    return 0;
}

static PyObject *program_seconds(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"rapid_mm_min", NULL};
    double rapid = RAPID_MM_MIN;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "|d:seconds", names, &rapid)) return NULL;
    if (!isfinite(rapid) || rapid <= 0) {
        PyErr_SetString(PyExc_ValueError, "rapid_mm_min: not a positive number");
        return NULL;
    }
    program_object *program = (program_object *)self;
    native_call call;
    program->readers++;
    call_begin(&call, NULL);
    const double seconds = swarf_program_seconds(program->handle, rapid);
    const int failed = call_end(&call, state_of(self), SWARF_OK);
    program->readers--;
    return failed ? NULL : PyFloat_FromDouble(seconds);
}

/* A number for all of X, Y, Z, or three; None: as it is. */
static int limit_of(PyObject *object, const char *name, double out[3])
{
    if (!object || object == Py_None) return 0;
    if (!PyNumber_Check(object) || PySequence_Check(object)) return buffer_point(object, name, out);
    const double value = PyFloat_AsDouble(object);
    if (value == -1.0 && PyErr_Occurred()) return -1;
    for (int k = 0; k < 3; k++) out[k] = value;
    return 0;
}

static PyObject *program_times(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"rapid_mm_min",  "feed_mm_min", "acceleration_mm_s2", "junction_mm", "rotary_deg_min",
                            "tool_change_s", NULL};
    swarf_machine_limits limits = swarf_machine_limits_default();
    PyObject *rapid = NULL, *feed = NULL, *acceleration = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "|$OOOddd:times", names, &rapid, &feed, &acceleration,
                                     &limits.junction_mm, &limits.rotary_deg_min, &limits.tool_change_s) ||
        limit_of(rapid, "rapid_mm_min", limits.rapid_mm_min) || limit_of(feed, "feed_mm_min", limits.feed_mm_min) ||
        limit_of(acceleration, "acceleration_mm_s2", limits.acceleration_mm_s2))
        return NULL;
    program_object *program = (program_object *)self;
    const size_t count = swarf_program_move_count(program->handle);
    PyObject *bytes = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(count * sizeof(double)));
    if (!bytes) return NULL;
    native_call call;
    program->readers++;
    call_begin(&call, NULL);
    const swarf_status status =
        swarf_program_times(program->handle, &limits, (double *)(void *)PyBytes_AsString(bytes));
    const int failed = call_end(&call, state_of(self), status);
    program->readers--;
    PyObject *result =
        failed ? NULL
               : buffer_view(state_of(self), bytes, PyBytes_AsString(bytes), "d", sizeof(double), count, 0, NULL);
    Py_DECREF(bytes);
    return result;
}

static Py_ssize_t program_length(PyObject *self)
{
    return (Py_ssize_t)swarf_program_move_count(handle_of(self));
}

static PyObject *program_moves(PyObject *self, void *Py_UNUSED(closure))
{
    _Static_assert(sizeof(swarf_move) == 40, "the format below");
    const swarf_program *handle = handle_of(self);
    return buffer_view(state_of(self), self, swarf_program_moves(handle),
                       "T{(3)d:end:f:feed_mm_min:I:line:i:arc:I:section_kind:}", sizeof(swarf_move),
                       swarf_program_move_count(handle), 0, &((program_object *)self)->exports);
}

static PyObject *program_arcs(PyObject *self, void *Py_UNUSED(closure))
{
    _Static_assert(sizeof(swarf_arc) == 40, "the format below");
    const swarf_program *handle = handle_of(self);
    return buffer_view(state_of(self), self, swarf_program_arcs(handle),
                       "T{(3)d:centre:d:angle_rad:i:plane:i:reserved:}", sizeof(swarf_arc),
                       swarf_program_arc_count(handle), 0, &((program_object *)self)->exports);
}

static PyObject *program_sections(PyObject *self, void *Py_UNUSED(closure))
{
    _Static_assert(sizeof(swarf_section) == 32, "the format below");
    const swarf_program *handle = handle_of(self);
    return buffer_view(state_of(self), self, swarf_program_sections(handle),
                       "T{i:tool:i:operation:i:spindle:i:coolant:d:spindle_rpm:i:work_offset:i:source:}",
                       sizeof(swarf_section), swarf_program_section_count(handle), 0,
                       &((program_object *)self)->exports);
}

static PyObject *program_axes(PyObject *self, void *Py_UNUSED(closure))
{
    _Static_assert(sizeof(swarf_axes) == 56 && sizeof(size_t) == 8, "the format below");
    const swarf_program *handle = handle_of(self);
    return buffer_view(state_of(self), self, swarf_program_axes(handle), "T{Q:first:(6)d:value:}", sizeof(swarf_axes),
                       swarf_program_axes_count(handle), 0, &((program_object *)self)->exports);
}

static PyObject *program_notes(PyObject *self, void *Py_UNUSED(closure))
{
    PyObject *notes = ((program_object *)self)->notes;
    return notes ? Py_NewRef(notes) : PyTuple_New(0);
}

static PyObject *program_sources(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_program *handle = handle_of(self);
    const size_t count = swarf_program_source_count(handle);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        const char *name = swarf_program_source_name(handle, i);
        PyObject *text = PyUnicode_DecodeUTF8(name, (Py_ssize_t)strlen(name), "surrogateescape");
        if (!text || PyTuple_SetItem(result, (Py_ssize_t)i, text) < 0) Py_CLEAR(result);
    }
    return result;
}

static PyObject *program_operations(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_program *handle = handle_of(self);
    const size_t count = swarf_program_operation_count(handle);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        const char *name = swarf_program_operation_name(handle, i);
        PyObject *text = PyUnicode_DecodeUTF8(name, (Py_ssize_t)strlen(name), "replace");
        if (!text || PyTuple_SetItem(result, (Py_ssize_t)i, text) < 0) Py_CLEAR(result);
    }
    return result;
}

static int compare_ints(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/** Tools of the moves that feed, sorted, each once. */
static PyObject *program_tools(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_program *handle = handle_of(self);
    const size_t sections = swarf_program_section_count(handle), moves = swarf_program_move_count(handle);
    const swarf_section *section = swarf_program_sections(handle);
    const swarf_move *move = swarf_program_moves(handle);
    int32_t *tools = PyMem_Malloc((sections + 1) * sizeof *tools);
    char *used = PyMem_Calloc(sections + 1, 1);
    PyObject *result = NULL;
    if (!tools || !used) {
        PyErr_NoMemory();
    } else {
        for (size_t i = 0; i < moves; i++)
            if (swarf_move_get_kind(&move[i]) == SWARF_MOVE_FEED) used[swarf_move_get_section(&move[i])] = 1;
        size_t count = 0, unique = 0;
        for (size_t i = 0; i < sections; i++)
            if (used[i]) tools[count++] = section[i].tool;
        qsort(tools, count, sizeof *tools, compare_ints);
        for (size_t i = 0; i < count; i++)
            if (!unique || tools[unique - 1] != tools[i]) tools[unique++] = tools[i];
        result = PyTuple_New((Py_ssize_t)unique);
        for (size_t i = 0; result && i < unique; i++) {
            PyObject *number = PyLong_FromLong(tools[i]);
            if (!number || PyTuple_SetItem(result, (Py_ssize_t)i, number) < 0) Py_CLEAR(result);
        }
    }
    PyMem_Free(tools);
    PyMem_Free(used);
    return result;
}

static PyObject *program_repr(PyObject *self)
{
    return PyUnicode_FromFormat("<swarf.Program of %zd moves, %zd operations>", program_length(self),
                                (Py_ssize_t)swarf_program_operation_count(handle_of(self)));
}

static PyMethodDef program_methods[] = {
    {"read_gcode", WITH_KEYWORDS(gcode_read), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "read_gcode($type, path, *, start=None, dialect='linuxcnc', tools=None, diameters=None, "
     "parameters=None, machine_unit='mm', search=None, block_delete=False, line_limit=0, progress=None)\n--\n\n"
     "Program from a G-code file. `start` is where the tool stands first; `dialect` \"linuxcnc\", \"grbl\", \"mach3\"\n"
     "or \"fanuc\"; `tools` a LinuxCNC tool table file, or (number, diameter, length) rows in mm; `diameters` maps\n"
     "numbers of tools to diameters in mm, for cutter compensation where no table tells; `parameters` a LinuxCNC\n"
     "parameter file; `machine_unit` \"mm\" or \"inch\", which the lengths in the two files are in; `search` folders "
     "of\n"
     "subroutine files, ':' between them; `block_delete` leaves out lines that begin with '/'; `line_limit` bounds\n"
     "what loops execute (0: 20 million lines). OSError, or\n"
     "FormatError \"file:line:column: error: 'word' ...\". Any thread."},
    {"parse_gcode", WITH_KEYWORDS(gcode_parse), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "parse_gcode($type, text, *, name='text', start=None, dialect='linuxcnc', tools=None, diameters=None, "
     "parameters=None, machine_unit='mm', search=None, block_delete=False, line_limit=0, progress=None)\n--\n\n"
     "The same from text (str or bytes); `name` stands for the file in errors."},
    {"check_gcode", WITH_KEYWORDS(gcode_check), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "check_gcode($type, path, *, start=None, dialect='linuxcnc', tools=None, diameters=None, "
     "parameters=None, machine_unit='mm', search=None, block_delete=False, line_limit=0, progress=None)\n--\n\n"
     "What read_gcode() has to say of a file, as its notes: the first error, after which nothing is read, and the\n"
     "warnings and messages before it. No FormatError."},
    {"add_operation", WITH_KEYWORDS(program_add_operation), METH_VARARGS | METH_KEYWORDS,
     "add_operation($self, name)\n--\n\nAdd an operation, make it current and return its index."},
    {"set_section", WITH_KEYWORDS(program_set_section), METH_VARARGS | METH_KEYWORDS,
     "set_section($self, *, tool=-1, operation=..., spindle='off', spindle_rpm=0.0, coolant=0, work_offset=0)\n--\n\n"
     "What the moves that follow share: tool number (-1: none), index of the operation (the one added last),\n"
     "spindle \"off\", \"cw\" or \"ccw\", coolant (bit 0 mist, bit 1 flood), work offset (0 machine, 1 G54 ...)."},
    {"add_line", WITH_KEYWORDS(program_add_line), METH_VARARGS | METH_KEYWORDS,
     "add_line($self, end, *, kind='feed', feed_mm_min=0.0, line=0)\n--\n\n"
     "Add a straight move to `end` (three numbers, mm); kind \"feed\", \"rapid\", \"probe\" or \"position\"."},
    {"add_arc", WITH_KEYWORDS(program_add_arc), METH_VARARGS | METH_KEYWORDS,
     "add_arc($self, end, centre, *, plane='xy', ccw=True, turns=1, feed_mm_min=0.0, line=0)\n--\n\n"
     "Add an arc or helix about `centre` in plane \"xy\", \"zx\" or \"yz\"; `turns` counts the passes, end equal to\n"
     "the start gives a full circle. ValueError when the radii of start and end do not fit."},
    {"add_dwell", WITH_KEYWORDS(program_add_dwell), METH_VARARGS | METH_KEYWORDS,
     "add_dwell($self, seconds, *, line=0)\n--\n\nAdd a pause at the current position."},
    {"add_tool_change", WITH_KEYWORDS(program_add_tool_change), METH_VARARGS | METH_KEYWORDS,
     "add_tool_change($self, *, line=0)\n--\n\nAdd a change to the tool of the current section."},
    {"seconds", WITH_KEYWORDS(program_seconds), METH_VARARGS | METH_KEYWORDS,
     "seconds($self, rapid_mm_min=5000.0)\n--\n\n"
     "Seconds that the moves take at their feeds, rapids at `rapid_mm_min`, without acceleration."},
    {"times", WITH_KEYWORDS(program_times), METH_VARARGS | METH_KEYWORDS,
     "times($self, *, rapid_mm_min=5000.0, feed_mm_min=5000.0, acceleration_mm_s2=500.0, junction_mm=0.01, "
     "rotary_deg_min=3600.0, tool_change_s=0.0)\n--\n\n"
     "Seconds of each move as a read-only float64 view: with the rapid rate, greatest feed and acceleration of each\n"
     "axis (a number, or three for X, Y, Z), corners passed at the speed at which an arc that strays from them by\n"
     "`junction_mm` holds the acceleration."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef program_getset[] = {
    {"moves", program_moves, NULL,
     "Read-only view of the moves: records end (3 float64), feed_mm_min (float32), line (uint32), arc (int32,\n"
     "-1: straight), section_kind (uint32: section * 8 + kind). While a view lives the program cannot grow.",
     NULL},
    {"arcs", program_arcs, NULL,
     "Read-only view of the arcs: records centre (3 float64), angle_rad, plane (int32), reserved.", NULL},
    {"sections", program_sections, NULL,
     "Read-only view of the sections: records tool, operation, spindle, coolant (int32), spindle_rpm (float64),\n"
     "work_offset, source (int32).",
     NULL},
    {"axes", program_axes, NULL,
     "Read-only view of where A, B, C (degrees), U, V, W (mm) stand: records first (uint64, the move from which on),\n"
     "value (6 float64). Empty while they stand at 0.",
     NULL},
    {"notes", program_notes, NULL,
     "What the reader had to say: (kind, source, line, column, text) each; kind \"warning\" or \"message\".", NULL},
    {"sources", program_sources, NULL, "Names of the files the moves come from; sections point to them.", NULL},
    {"operations", program_operations, NULL, "Names of the operations.", NULL},
    {"tools", program_tools, NULL, "Numbers of the tools that feed moves use, sorted; -1: no tool loaded.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot program_slots[] = {
    {Py_tp_doc, "Program(start=None)\n--\n\n"
                "What a machine does: a flat array of moves in mm, in the coordinates of the stock, from where the\n"
                "tool stands first (three numbers; None: unknown). One thread builds, many may read; building while\n"
                "a call reads raises BusyError, while a view lives BufferError. len() is the number of moves."},
    {Py_tp_new, program_new},
    {Py_tp_dealloc, program_dealloc},
    {Py_tp_repr, program_repr},
    {Py_tp_methods, program_methods},
    {Py_tp_getset, program_getset},
    {Py_sq_length, program_length},
    {0, NULL},
};

PyType_Spec program_spec = {
    .name = "swarf.Program",
    .basicsize = sizeof(program_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = program_slots,
};
