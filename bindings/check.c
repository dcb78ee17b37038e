/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock.check() and what it returns: what a program does that it must not, and what it asks of its tools. */
#include "native.h"

typedef struct check_object {
    PyObject_HEAD swarf_check *handle;
} check_object;

static const swarf_check *handle_of(PyObject *self)
{
    return ((check_object *)self)->handle;
}

static void check_dealloc(PyObject *self)
{
    swarf_check_destroy(((check_object *)self)->handle);
    object_free(self);
}

static const char *const severities[] = {"note", "warning", "error"};
static const char *const parts[] = {"flutes", "shank", "holder"};

static PyStructSequence_Field check_fields[] = {
    {"severity", "\"note\", \"warning\" or \"error\"."},
    {"kind", "\"rapid\", \"start\", \"shank\", \"holder\", \"depth\", \"near\", \"fixture\", \"design\", \"spindle\", "
             "\"feed\", \"plunge\", \"travel\" or \"tool\"."},
    {"part", "What touches: \"flutes\", \"shank\" or \"holder\"."},
    {"operation", "Index of the operation."},
    {"move", "Number of the move, from 0."},
    {"line", "Line of the source, from 1; 0: unknown."},
    {"tool", "Tool number."},
    {"t", "Where on the move it begins, 0 .. 1."},
    {"tip", "Place of the tool then, mm."},
    {"point", "A place of the deepest contact of the whole move, mm."},
    {"depth", "How deep that is, mm; no more than three voxels are told."},
    {"text", "What was found."},
    {NULL, NULL},
};

PyStructSequence_Desc check_finding_desc = {
    .name = "swarf.CheckFinding",
    .doc = "Something that Stock.check() found.",
    .fields = check_fields,
    .n_in_sequence = 12,
};

static PyObject *finding_to_python(module_state *state, const swarf_check_finding *f)
{
    PyObject *items[] = {
        PyUnicode_FromString(severities[f->severity]),
        PyUnicode_FromString(swarf_check_name((swarf_check_kind)f->kind)),
        PyUnicode_FromString(parts[f->part]),
        PyLong_FromLong(f->operation),
        PyLong_FromSize_t(f->move),
        PyLong_FromUnsignedLong(f->line),
        PyLong_FromLong(f->tool),
        PyFloat_FromDouble(f->t),
        Py_BuildValue("(ddd)", f->tip[0], f->tip[1], f->tip[2]),
        Py_BuildValue("(ddd)", f->point[0], f->point[1], f->point[2]),
        PyFloat_FromDouble(f->depth_mm),
        PyUnicode_DecodeUTF8(f->text, (Py_ssize_t)strnlen(f->text, sizeof f->text), "replace"),
    };
    return make_sequence(state->check_finding, items, 12);
}

static PyObject *check_findings(PyObject *self, void *Py_UNUSED(closure))
{
    size_t count;
    const swarf_check_finding *findings = swarf_check_findings(handle_of(self), &count);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        PyObject *finding = finding_to_python(state_of(self), &findings[i]);
        if (!finding || PyTuple_SetItem(result, (Py_ssize_t)i, finding) < 0) Py_CLEAR(result);
    }
    return result;
}

static PyObject *check_simulation(PyObject *self, void *Py_UNUSED(closure))
{
    return simulation_wrap(state_of(self), swarf_check_simulation(handle_of(self)), self);
}

static PyObject *check_loads(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_loads *loads = swarf_check_loads(handle_of(self));
    if (!loads) Py_RETURN_NONE;
    PyObject *result = PyDict_New();
    for (int k = -1; result && k < SWARF_LOAD_COUNT; k++) {
        size_t count;
        const void *data = k < 0 ? (const void *)swarf_loads_volume(loads, &count)
                                 : (const void *)swarf_loads_get(loads, (swarf_load_kind)k, &count);
        const size_t size = k < 0 ? sizeof(double) : sizeof(float);
        PyObject *view = buffer_view(state_of(self), self, data, k < 0 ? "d" : "f", size, count, 0, NULL);
        if (!view || PyDict_SetItemString(result, k < 0 ? "volume" : swarf_load_name((swarf_load_kind)k), view) < 0)
            Py_CLEAR(result);
        Py_XDECREF(view);
    }
    return result;
}

static PyGetSetDef check_getset[] = {
    {"findings", check_findings, NULL, "Tuple of CheckFinding, in the order of the moves.", NULL},
    {"simulation", check_simulation, NULL, "What Stock.simulate() tells of the same moves: Simulation.", NULL},
    {"loads", check_loads, NULL,
     "What each move asks of its tool, None unless asked for: a dict of read-only views with one number a move.\n"
     "\"volume\" (float64): mm3 removed. The others float32: \"rate\" and \"peak_rate\" mm3/s at the feed, "
     "\"depth\"\n"
     "along the axis and \"width\" across the motion mm, \"angle\" degrees of the turn in material, \"chip\" mm (0: "
     "number\n"
     "of teeth, feed or speed not known), the greatest of the move; \"climb\" 1: climb milling, -1: conventional;\n"
     "\"at\" 0 .. 1 along the move, where the angle is greatest.",
     NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot check_slots[] = {
    {Py_tp_doc, "What Stock.check() came to. Immutable, any thread."},
    {Py_tp_dealloc, check_dealloc},
    {Py_tp_getset, check_getset},
    {0, NULL},
};

PyType_Spec check_spec = {
    .name = "swarf.Check",
    .basicsize = sizeof(check_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = check_slots,
};

/* ---- checking ---- */

/** The numbers of teeth of a dict {tool: teeth}, into the tools. */
static int teeth_read(PyObject *dict, swarf_tool *tools, size_t count)
{
    if (!PyDict_Check(dict)) {
        PyErr_SetString(PyExc_TypeError, "teeth: a dict of tool numbers is wanted");
        return -1;
    }
    for (size_t i = 0; i < count; i++) {
        PyObject *key = PyLong_FromLong(tools[i].number), *value = key ? PyDict_GetItemWithError(dict, key) : NULL;
        Py_XDECREF(key);
        if (PyErr_Occurred()) return -1;
        const long teeth = value ? PyLong_AsLong(value) : 0;
        if (PyErr_Occurred()) return -1;
        if (teeth < 0 || teeth > 1000) {
            PyErr_Format(PyExc_ValueError, "teeth: tool %d cannot have %ld; 1 .. 1000, 0: not known",
                         (int)tools[i].number, teeth);
            return -1;
        }
        tools[i].teeth = (int32_t)teeth;
    }
    return 0;
}

/** What the lists of Python hold, for the library. */
struct lists {
    PyObject *fixtures; /* a tuple of Solids, kept alive */
    const swarf_solid **solids;
    int32_t *no_plunge;
};

static void lists_free(struct lists *lists)
{
    Py_CLEAR(lists->fixtures);
    PyMem_Free(lists->solids);
    PyMem_Free(lists->no_plunge);
}

static int lists_read(module_state *state, PyObject *fixtures, PyObject *no_plunge, struct lists *out,
                      swarf_check_options *options)
{
    PyObject *numbers = NULL;
    out->fixtures = PySequence_Tuple(fixtures);
    numbers = out->fixtures ? PySequence_Tuple(no_plunge) : NULL;
    if (!numbers) return -1;
    const Py_ssize_t solid_count = PyTuple_Size(out->fixtures), number_count = PyTuple_Size(numbers);
    out->solids = PyMem_Calloc((size_t)solid_count + 1, sizeof *out->solids);
    out->no_plunge = PyMem_Calloc((size_t)number_count + 1, sizeof *out->no_plunge);
    if (!out->solids || !out->no_plunge) {
        Py_DECREF(numbers);
        PyErr_NoMemory();
        return -1;
    }
    for (Py_ssize_t i = 0; i < solid_count && !PyErr_Occurred(); i++) {
        PyObject *fixture = PyTuple_GetItem(out->fixtures, i);
        if (PyObject_TypeCheck(fixture, state->solid))
            out->solids[i] = ((solid_object *)fixture)->handle;
        else
            PyErr_Format(PyExc_TypeError, "fixtures: item %zd is no Solid", i);
    }
    for (Py_ssize_t i = 0; i < number_count && !PyErr_Occurred(); i++)
        out->no_plunge[i] = (int32_t)PyLong_AsLong(PyTuple_GetItem(numbers, i));
    Py_DECREF(numbers);
    options->fixtures = out->solids;
    options->fixture_count = (size_t)solid_count;
    options->no_plunge = out->no_plunge;
    options->no_plunge_count = (size_t)number_count;
    return PyErr_Occurred() ? -1 : 0;
}

const char stock_check_doc[] =
    "check($self, program, tools, *, fixtures=(), design=None, tolerance=0.05, clearance=0.0, travel=None, "
    "no_plunge=(), teeth={}, loads=False, stop=False, progress=None)\n--\n\n"
    "Play a program as simulate() does, and look at each move before it is cut -> Check.\n"
    "`fixtures` are Solids that nothing may touch, `design` a Solid that shank and holder may not touch and flutes by "
    "no\n"
    "more than `tolerance`; `clearance` (mm) is wanted between holder and stock; `travel` is a box that the tip has to "
    "stay\n"
    "in; `no_plunge` are tools that cannot plunge; `loads` measures what each move asks of its tool, of which `teeth` "
    "are\n"
    "{number: cutting edges around it}; `stop` ends with the first error.";

PyObject *stock_check(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"program",   "tools", "fixtures", "design", "tolerance", "clearance", "travel",
                            "no_plunge", "teeth", "loads",    "stop",   "progress",  NULL};
    module_state *state = state_of(self);
    swarf_check_options options = swarf_check_options_default();
    PyObject *program_argument, *dict, *fixtures = NULL, *design = Py_None, *travel = Py_None, *no_plunge = NULL;
    PyObject *teeth = NULL, *progress = NULL;
    int stop = 0, loads = 0;
    swarf_tool *tools;
    size_t tool_count;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!|$OOddOOOppO:check", names, state->program, &program_argument,
                                     &PyDict_Type, &dict, &fixtures, &design, &options.design_mm, &options.clearance_mm,
                                     &travel, &no_plunge, &teeth, &loads, &stop, &progress))
        return NULL;
    options.stop_on_first = stop;
    options.loads = loads;
    if (travel != Py_None && camera_box(travel, &options.travel)) return NULL;
    if (design != Py_None && !PyObject_TypeCheck(design, state->solid))
        return PyErr_Format(PyExc_TypeError, "design: a Solid is wanted");
    if (design != Py_None) options.design = ((solid_object *)design)->handle;
    struct lists lists = {0};
    PyObject *none = PyTuple_New(0);
    const int wrong =
        !none || lists_read(state, fixtures ? fixtures : none, no_plunge ? no_plunge : none, &lists, &options);
    Py_XDECREF(none);
    if (wrong || tools_read(state, dict, &tools, &tool_count)) {
        lists_free(&lists);
        return NULL;
    }
    program_object *program = (program_object *)program_argument;
    swarf_check *check = NULL;
    native_call call;
    int failed = teeth && teeth_read(teeth, tools, tool_count);
    if (!failed) {
        program->readers++;
        failed = call_begin(&call, progress);
        if (!failed) {
            const swarf_status status = swarf_stock_check(((stock_object *)self)->handle, program->handle, 0,
                                                          swarf_program_move_count(program->handle), tools, tool_count,
                                                          &options, &call.progress, &check);
            failed = call_end(&call, state, status);
        }
        program->readers--;
    }
    tools_free(tools, tool_count);
    lists_free(&lists);
    check_object *result = failed ? NULL : (check_object *)PyType_GenericAlloc(state->check, 0);
    if (!result) {
        swarf_check_destroy(check);
        return NULL;
    }
    result->handle = check;
    return (PyObject *)result;
}
