/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock.simulate() and what it returns: swarf.Simulation and swarf.Finding. */
#include "native.h"

typedef struct simulation_object {
    PyObject_HEAD const swarf_simulation *handle;
    PyObject *owner; /* of the handle; NULL: the object itself */
} simulation_object;

static const char *const severity_names[] = {"note", "warning", "error"};

static const swarf_simulation *handle_of(PyObject *self)
{
    return ((simulation_object *)self)->handle;
}

static void simulation_dealloc(PyObject *self)
{
    simulation_object *simulation = (simulation_object *)self;
    if (!simulation->owner) swarf_simulation_destroy((swarf_simulation *)simulation->handle);
    Py_CLEAR(simulation->owner);
    object_free(self);
}

static PyStructSequence_Field finding_fields[] = {
    {"severity", "\"note\", \"warning\" or \"error\"."},
    {"operation", "Index of the operation."},
    {"move", "Number of the move, from 0."},
    {"line", "Line of the source, from 1; 0: unknown."},
    {"tool", "Tool number."},
    {"text", "What was noticed."},
    {"kind", "\"no tool\", \"unknown tool\", \"no flutes\", \"axis\" or \"idle\"."},
    {"axis", "Letter of the axis of \"axis\", else \"\"."},
    {"value", "Where that axis goes, degrees or mm."},
    {NULL, NULL},
};

PyStructSequence_Desc finding_desc = {
    .name = "swarf.Finding",
    .doc = "Something the simulation noticed.",
    .fields = finding_fields,
    .n_in_sequence = 9,
};

static PyObject *finding_to_python(module_state *state, const swarf_finding *finding)
{
    const int known = finding->severity >= 0 && finding->severity <= SWARF_ERROR;
    PyObject *items[] = {
        PyUnicode_FromString(severity_names[known ? finding->severity : SWARF_ERROR]),
        PyLong_FromLong(finding->operation),
        PyLong_FromSize_t(finding->move),
        PyLong_FromUnsignedLong(finding->line),
        PyLong_FromLong(finding->tool),
        PyUnicode_DecodeUTF8(finding->text, (Py_ssize_t)strnlen(finding->text, sizeof finding->text), "replace"),
        PyUnicode_FromString(swarf_finding_name((swarf_finding_kind)finding->kind)),
        PyUnicode_FromStringAndSize(&"ABCUVW"[finding->axis], finding -> kind == SWARF_FINDING_AXIS),
        PyFloat_FromDouble(finding->value),
    };
    return make_sequence(state->finding, items, 9);
}

static PyObject *simulation_findings(PyObject *self, void *Py_UNUSED(closure))
{
    size_t count;
    const swarf_finding *findings = swarf_simulation_findings(handle_of(self), &count);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        PyObject *finding = finding_to_python(state_of(self), &findings[i]);
        if (!finding || PyTuple_SetItem(result, (Py_ssize_t)i, finding) < 0) Py_CLEAR(result);
    }
    return result;
}

static PyObject *simulation_removed_by_operation(PyObject *self, void *Py_UNUSED(closure))
{
    size_t count;
    const double *removed = swarf_simulation_removed(handle_of(self), &count);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        PyObject *value = PyFloat_FromDouble(removed[i]);
        if (!value || PyTuple_SetItem(result, (Py_ssize_t)i, value) < 0) Py_CLEAR(result);
    }
    return result;
}

static PyObject *simulation_removed_per_move(PyObject *self, void *Py_UNUSED(closure))
{
    size_t count;
    const double *removed = swarf_simulation_removed_per_move(handle_of(self), &count);
    if (!removed) Py_RETURN_NONE;
    return buffer_view(state_of(self), self, removed, "d", sizeof(double), count, 0, NULL);
}

static PyObject *simulation_volume_initial(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(swarf_simulation_volume_initial(handle_of(self)));
}

static PyObject *simulation_volume_final(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(swarf_simulation_volume_final(handle_of(self)));
}

static PyGetSetDef simulation_getset[] = {
    {"removed_by_operation", simulation_removed_by_operation, NULL,
     "mm3 removed by each operation of the program, in its order.", NULL},
    {"removed_per_move", simulation_removed_per_move, NULL,
     "Read-only float64 view of the mm3 that each played move removed; None unless asked for.", NULL},
    {"findings", simulation_findings, NULL, "Tuple of Finding, in the order of the moves.", NULL},
    {"volume_initial", simulation_volume_initial, NULL, "Volume before, mm3.", NULL},
    {"volume_final", simulation_volume_final, NULL, "Volume after, mm3.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot simulation_slots[] = {
    {Py_tp_doc, "What Stock.simulate() came to. Immutable, any thread."},
    {Py_tp_dealloc, simulation_dealloc},
    {Py_tp_getset, simulation_getset},
    {0, NULL},
};

PyType_Spec simulation_spec = {
    .name = "swarf.Simulation",
    .basicsize = sizeof(simulation_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = simulation_slots,
};

PyObject *simulation_wrap(module_state *state, const swarf_simulation *handle, PyObject *owner)
{
    simulation_object *result = (simulation_object *)PyType_GenericAlloc(state->simulation, 0);
    if (!result) return NULL;
    result->handle = handle;
    Py_XINCREF(owner);
    result->owner = owner;
    return (PyObject *)result;
}

/* ---- simulating ---- */

const char stock_simulate_doc[] =
    "simulate($self, program, tools, *, first=0, count=None, batch=0, removed_per_move=False, progress=None)\n--\n\n"
    "Play moves first .. first + count - 1 of a program with tools {number: Cutter} -> Simulation.\n"
    "`batch` moves are cut at once: 0 as many as share a tool and an operation, 1 move by move.\n"
    "A tool that is missing or has no flutes is a finding of class \"error\". Cancelling leaves the moves so far cut.";

PyObject *stock_simulate(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"program", "tools", "first", "count", "batch", "removed_per_move", "progress", NULL};
    module_state *state = state_of(self);
    swarf_simulation_options options = swarf_simulation_options_default();
    PyObject *program_argument, *dict, *count_object = Py_None, *progress = NULL;
    Py_ssize_t first_wanted = 0, batch = 0;
    size_t first, count, tool_count;
    swarf_tool *tools;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!|$nOnpO:simulate", names, state->program, &program_argument,
                                     &PyDict_Type, &dict, &first_wanted, &count_object, &batch,
                                     &options.removed_per_move, &progress))
        return NULL;
    program_object *program = (program_object *)program_argument;
    if (batch < 0) {
        PyErr_SetString(PyExc_ValueError, "batch: negative; 0 means as many as share a tool and an operation");
        return NULL;
    }
    options.batch = (size_t)batch;
    if (program_range(program, first_wanted, count_object, &first, &count) ||
        tools_read(state, dict, &tools, &tool_count))
        return NULL;
    swarf_simulation *handle = NULL;
    native_call call;
    program->readers++;
    int failed = call_begin(&call, progress);
    if (!failed) {
        const swarf_status status = swarf_stock_simulate(((stock_object *)self)->handle, program->handle, first, count,
                                                         tools, tool_count, &options, &call.progress, &handle);
        failed = call_end(&call, state, status);
    }
    program->readers--;
    tools_free(tools, tool_count);
    PyObject *result = failed ? NULL : simulation_wrap(state, handle, NULL);
    if (!result) swarf_simulation_destroy(handle);
    return result;
}
