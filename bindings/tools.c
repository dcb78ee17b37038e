/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Tool tables: {number: Cutter}. */
#include "native.h"

void tools_free(swarf_tool *tools, size_t count)
{
    for (size_t i = 0; i < count; i++) swarf_cutter_release((swarf_cutter *)tools[i].cutter);
    PyMem_Free(tools);
}

int tools_read(module_state *state, PyObject *dict, swarf_tool **out, size_t *count)
{
    swarf_tool *tools = PyMem_Calloc((size_t)PyDict_Size(dict) + 1, sizeof *tools);
    size_t found = 0;
    Py_ssize_t position = 0;
    PyObject *key, *value;
    if (!tools) {
        PyErr_NoMemory();
        return -1;
    }
    while (PyDict_Next(dict, &position, &key, &value)) {
        int overflow = 0;
        const long number = PyLong_Check(key) ? PyLong_AsLongAndOverflow(key, &overflow) : 0;
        if (!PyLong_Check(key) || overflow || number < INT32_MIN || number > INT32_MAX) {
            PyErr_Format(PyExc_TypeError, "tools: the key %R is no tool number", key);
            break;
        }
        if (!PyObject_TypeCheck(value, state->cutter)) {
            PyErr_Format(PyExc_TypeError, "tools: tool %ld is no Cutter", number);
            break;
        }
        tools[found++] =
            (swarf_tool){.number = (int32_t)number, .cutter = swarf_cutter_retain(((cutter_object *)value)->handle)};
    }
    if (PyErr_Occurred()) {
        tools_free(tools, found);
        return -1;
    }
    *out = tools;
    *count = found;
    return 0;
}
