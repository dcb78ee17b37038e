/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock.lumps(): what of a stock hangs together. */
#include "native.h"

static PyStructSequence_Field lump_fields[] = {
    {"voxels", "Number of its voxels."},
    {"volume_mm3", "Their volume."},
    {"inside", "Centre (x, y, z) of one of them, mm."},
    {"bounding_box", "((x, y, z), (x, y, z)) of them, mm."},
    {NULL, NULL},
};

PyStructSequence_Desc lump_desc = {
    .name = "swarf.Lump",
    .doc = "Material of a stock that hangs together.",
    .fields = lump_fields,
    .n_in_sequence = 4,
};

const char stock_lumps_doc[] =
    "lumps($self, points=(), *, progress=None)\n--\n\n"
    "What hangs together, by voxels with a common face: Lumps, the largest first, and for each of an (n, 3) table of\n"
    "points the place of the lump that holds it, None in the air.";

/** A tuple of what `item` makes of 0 .. count - 1. */
static PyObject *tuple_of(size_t count, PyObject *(*item)(const void *context, size_t index), const void *context)
{
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        PyObject *made = item(context, i);
        if (!made || PyTuple_SetItem(result, (Py_ssize_t)i, made)) Py_CLEAR(result);
    }
    return result;
}

typedef struct lumps_made {
    module_state *state;
    const swarf_lump *lump;
} lumps_made;

static PyObject *lump_to_python(const void *context, size_t index)
{
    const lumps_made *made = context;
    const swarf_lump *lump = &made->lump[index];
    PyObject *items[] = {PyLong_FromSize_t(lump->voxels), PyFloat_FromDouble(lump->volume_mm3),
                         Py_BuildValue("(ddd)", lump->inside[0], lump->inside[1], lump->inside[2]),
                         box_to_python(&lump->box)};
    return make_sequence(made->state->lump, items, 4);
}

static PyObject *place_to_python(const void *context, size_t index)
{
    const uint32_t place = ((const uint32_t *)context)[index];
    return place == UINT32_MAX ? Py_NewRef(Py_None) : PyLong_FromUnsignedLong(place);
}

PyObject *stock_lumps(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"points", "progress", NULL};
    module_state *state = state_of(self);
    PyObject *given = NULL, *progress = NULL, *result = NULL;
    double *points = NULL;
    size_t count = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "|O$O:lumps", names, &given, &progress) ||
        (given && buffer_doubles(given, "points", 3, &points, &count)))
        return NULL;
    uint32_t *lump_of = PyMem_Calloc(count + 1, sizeof *lump_of);
    native_call call;
    if (!lump_of) {
        PyErr_NoMemory();
    } else if (!call_begin(&call, progress)) {
        swarf_lumps *lumps = NULL;
        const swarf_status status =
            swarf_lumps_create(((stock_object *)self)->handle, points, count, &call.progress, lump_of, &lumps);
        if (!call_end(&call, state, status)) {
            size_t found;
            const lumps_made made = {state, swarf_lumps_get(lumps, &found)};
            PyObject *items[] = {tuple_of(found, lump_to_python, &made), tuple_of(count, place_to_python, lump_of)};
            if (items[0] && items[1]) result = PyTuple_Pack(2, items[0], items[1]);
            Py_XDECREF(items[0]);
            Py_XDECREF(items[1]);
        }
        swarf_lumps_destroy(lumps);
    }
    PyMem_Free(lump_of);
    PyMem_Free(points);
    return result;
}
