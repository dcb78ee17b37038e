/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* One table from statuses to exceptions. */
#include "native.h"

/** An exception class of ours, where it is kept, and what it says of itself. */
typedef struct exception_class {
    const char *name;
    size_t offset;
    const char *doc;
} exception_class;

static const exception_class classes[] = {
    {"swarf.Error", offsetof(module_state, error), "Something libswarf could not do; base of its own exceptions."},
    {"swarf.FormatError", offsetof(module_state, format_error),
     "A file or text is not what it should be; the text says where."},
    {"swarf.GeometryError", offsetof(module_state, geometry_error),
     "A shape that cannot be worked with, e.g. an open mesh."},
    {"swarf.Cancelled", offsetof(module_state, cancelled),
     "The progress callback asked to stop; the objects stay valid."},
    {"swarf.BusyError", offsetof(module_state, busy_error), "The object is in use by another call."},
};

static PyObject **class_at(module_state *state, const exception_class *item)
{
    return (PyObject **)((char *)state + item->offset);
}

int error_setup(PyObject *module, module_state *state)
{
    for (size_t i = 0; i < sizeof classes / sizeof classes[0]; i++) {
        PyObject *made = PyErr_NewExceptionWithDoc(classes[i].name, classes[i].doc, state->error, NULL);
        if (!made) return -1;
        *class_at(state, &classes[i]) = made;
        if (PyModule_AddObjectRef(module, classes[i].name + sizeof "swarf." - 1, made) < 0) return -1;
    }
    return 0;
}

PyObject *error_raise(module_state *state, swarf_status status)
{
    PyObject *type = state->error;
    switch (status) {
    case SWARF_ERROR_ARGUMENT: type = PyExc_ValueError; break;
    case SWARF_ERROR_MEMORY: type = PyExc_MemoryError; break;
    case SWARF_ERROR_IO: type = PyExc_OSError; break;
    case SWARF_ERROR_FORMAT: type = state->format_error; break;
    case SWARF_ERROR_GEOMETRY: type = state->geometry_error; break;
    case SWARF_ERROR_CANCELLED: type = state->cancelled; break;
    case SWARF_ERROR_BUSY: type = state->busy_error; break;
    case SWARF_ERROR_INTERNAL: break;
    case SWARF_OK: PyErr_SetString(PyExc_SystemError, "no failure to raise"); return NULL;
    }
    const char *text = swarf_error_last();
    /* Paths in the text are bytes of the file system: decode as such, never fail on them. */
    PyObject *decoded = PyUnicode_DecodeUTF8(text, (Py_ssize_t)strlen(text), "replace");
    if (!decoded) return NULL;
    PyErr_SetObject(type, decoded);
    Py_DECREF(decoded);
    return NULL;
}
