/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* swarf.Surface: the exact surface of a stock and a program. Immutable, any thread. */
#include "native.h"

PyObject *surface_wrap(PyTypeObject *type, swarf_surface *handle, program_object *program, PyObject *before)
{
    surface_object *self = handle ? (surface_object *)PyType_GenericAlloc(type, 0) : NULL;
    if (!self) {
        swarf_surface_release(handle);
        program->exports--;
        Py_DECREF((PyObject *)program);
        return NULL;
    }
    self->handle = handle;
    self->program = program;
    self->before = Py_XNewRef(before);
    return (PyObject *)self;
}

PyObject *surface_make(PyTypeObject *type, PyObject *program, PyObject *tools, PyObject *progress, PyObject *before,
                       surface_maker *make, const void *context)
{
    module_state *state = state_of_type(type);
    swarf_tool *table;
    size_t count;
    if (tools_read(state, tools, &table, &count)) return NULL;
    program_object *held = (program_object *)Py_NewRef(program);
    held->exports++; /* its moves must not change while the surface shows them */
    swarf_surface *handle = NULL;
    native_call call;
    int failed = call_begin(&call, progress);
    if (!failed) failed = call_end(&call, state, make(context, held->handle, table, count, &call.progress, &handle));
    tools_free(table, count);
    return surface_wrap(type, failed ? NULL : handle, held, before);
}

static swarf_status make_first(const void *stock, const swarf_program *program, const swarf_tool *tools, size_t count,
                               const swarf_progress *progress, swarf_surface **out)
{
    return swarf_surface_create(((const stock_object *)stock)->handle, program, tools, count, progress, out);
}

static PyObject *surface_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"first", "program", "tools", "progress", NULL};
    const module_state *state = state_of_type(type);
    PyObject *first, *program, *tools, *progress = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!O!|$O:Surface", names, state->stock, &first, state->program,
                                     &program, &PyDict_Type, &tools, &progress))
        return NULL;
    return surface_make(type, program, tools, progress, NULL, make_first, first);
}

static void surface_dealloc(PyObject *object)
{
    surface_object *self = (surface_object *)object;
    swarf_surface_release(self->handle);
    self->program->exports--;
    Py_DECREF((PyObject *)self->program);
    Py_XDECREF(self->before);
    object_free(object);
}

static PyMethodDef surface_methods[] = {
    {"next", WITH_KEYWORDS(surface_next), METH_VARARGS | METH_KEYWORDS, surface_next_doc},
    {NULL, NULL, 0, NULL},
};

static PyType_Slot surface_slots[] = {
    {Py_tp_doc, "Surface(first, program, tools, *, progress=None)\n--\n\n"
                "The surface that a program makes of the stock `first` (as it is now, not kept), exactly: the first\n"
                "shape and the sweeps of the cutters in `tools`, a dict {number: Cutter}. The program can no longer "
                "be\n"
                "added to while the surface lives. Immutable, any thread."},
    {Py_tp_new, surface_new},
    {Py_tp_dealloc, surface_dealloc},
    {Py_tp_methods, surface_methods},
    {0, NULL},
};

PyType_Spec surface_spec = {
    .name = "swarf.Surface",
    .basicsize = sizeof(surface_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = surface_slots,
};
