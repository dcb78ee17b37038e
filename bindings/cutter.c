/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* swarf.Cutter: immutable, any thread. */
#include "native.h"

static const char *const part_names[] = {"flutes", "shank", "holder"};
enum { PART_KINDS = sizeof part_names / sizeof part_names[0] };

/** The kind among the arguments (keyword `kind`, "flutes" unless told), -1 with an exception. */
static int kind_parse(const char *text)
{
    return choice_find("kind", text, part_names, PART_KINDS);
}

static PyObject *cutter_wrap(PyTypeObject *type, swarf_cutter *handle)
{
    cutter_object *self = (cutter_object *)PyType_GenericAlloc(type, 0);
    if (!self) {
        swarf_cutter_release(handle);
        return NULL;
    }
    self->handle = handle;
    return (PyObject *)self;
}

static PyObject *cutter_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"text", NULL};
    const char *text;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "s:Cutter", names, &text)) return NULL;
    swarf_cutter *handle;
    const swarf_status status = swarf_cutter_parse(text, &handle);
    return status ? error_raise(state_of_type(type), status) : cutter_wrap(type, handle);
}

static void cutter_dealloc(PyObject *self)
{
    swarf_cutter_release(((cutter_object *)self)->handle);
    object_free(self);
}

/** Part `index` of a tuple of (kind, nodes); the nodes are the caller's to free. */
static int part_read(PyObject *parts, Py_ssize_t index, swarf_cutter_part *out)
{
    PyObject *pair = PyTuple_GetItem(parts, index);
    const char *kind_text;
    PyObject *nodes;
    if (!PyTuple_Check(pair) || PyTuple_Size(pair) != 2) {
        PyErr_Format(PyExc_TypeError, "parts[%zd]: needs a tuple (kind, nodes)", index);
        return -1;
    }
    if (!PyArg_ParseTuple(pair, "sO", &kind_text, &nodes)) return -1;
    const int kind = kind_parse(kind_text);
    if (kind < 0) return -1;
    double *table;
    size_t count;
    if (buffer_doubles(nodes, "nodes", 3, &table, &count)) return -1;
    *out = (swarf_cutter_part){
        .kind = (swarf_part_kind)kind, .nodes = (const swarf_profile_node *)table, .node_count = count};
    return 0;
}

static PyObject *cutter_from_parts(PyObject *type, PyObject *argument)
{
    _Static_assert(sizeof(swarf_profile_node) == 3 * sizeof(double), "a node is a row of three numbers");
    PyObject *parts = PySequence_Tuple(argument);
    if (!parts) return NULL;
    const Py_ssize_t count = PyTuple_Size(parts);
    swarf_cutter_part *array = PyMem_Calloc((size_t)count + 1, sizeof *array);
    Py_ssize_t done = 0;
    PyObject *result = NULL;
    if (!array) PyErr_NoMemory();
    while (array && done < count && !part_read(parts, done, &array[done])) done++;
    if (array && done == count) {
        swarf_cutter *handle;
        const swarf_status status = swarf_cutter_create(array, (size_t)count, &handle);
        result = status ? error_raise(state_of_type((PyTypeObject *)type), status)
                        : cutter_wrap((PyTypeObject *)type, handle);
    }
    for (Py_ssize_t i = 0; i < done; i++) PyMem_Free((void *)array[i].nodes);
    PyMem_Free(array);
    Py_DECREF(parts);
    return result;
}

/** Kind of a method with only that argument. */
static int kind_argument(PyObject *args, PyObject *keywords, const char *format, swarf_part_kind *out)
{
    static char *names[] = {"kind", NULL};
    const char *text = part_names[0];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, format, names, &text)) return -1;
    const int kind = kind_parse(text);
    if (kind < 0) return -1;
    *out = (swarf_part_kind)kind;
    return 0;
}

static PyObject *cutter_radius(PyObject *self, PyObject *args, PyObject *keywords)
{
    swarf_part_kind kind;
    if (kind_argument(args, keywords, "|s:radius", &kind)) return NULL;
    return PyFloat_FromDouble(swarf_cutter_radius(((cutter_object *)self)->handle, kind));
}

static PyObject *cutter_extent(PyObject *self, PyObject *args, PyObject *keywords)
{
    swarf_part_kind kind;
    if (kind_argument(args, keywords, "|s:extent", &kind)) return NULL;
    double lo, hi;
    swarf_cutter_extent(((cutter_object *)self)->handle, kind, &lo, &hi);
    return Py_BuildValue("(dd)", lo, hi);
}

static PyObject *cutter_volume(PyObject *self, PyObject *args, PyObject *keywords)
{
    swarf_part_kind kind;
    if (kind_argument(args, keywords, "|s:volume", &kind)) return NULL;
    return PyFloat_FromDouble(swarf_cutter_volume(((cutter_object *)self)->handle, kind));
}

static PyObject *cutter_radius_at(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"z", "kind", NULL};
    double z;
    const char *text = part_names[0];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "d|s:radius_at", names, &z, &text)) return NULL;
    const int kind = kind_parse(text);
    if (kind < 0) return NULL;
    return PyFloat_FromDouble(swarf_cutter_radius_at(((cutter_object *)self)->handle, (swarf_part_kind)kind, z));
}

static PyObject *cutter_parts(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_cutter *handle = ((cutter_object *)self)->handle;
    const size_t count = swarf_cutter_part_count(handle);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        swarf_cutter_part part;
        const swarf_status status = swarf_cutter_part_get(handle, i, &part);
        PyObject *nodes =
            status ? error_raise(state_of(self), status)
                   : buffer_view(state_of(self), self, part.nodes, "d", sizeof(double), part.node_count, 3, NULL);
        PyObject *pair = nodes ? Py_BuildValue("(sN)", part_names[part.kind], nodes) : NULL;
        if (!pair || PyTuple_SetItem(result, (Py_ssize_t)i, pair) < 0) Py_CLEAR(result);
    }
    return result;
}

static PyObject *cutter_repr(PyObject *self)
{
    const swarf_cutter *handle = ((cutter_object *)self)->handle;
    double lo, hi;
    swarf_cutter_extent(handle, SWARF_PART_FLUTES, &lo, &hi);
    char text[128];
    PyOS_snprintf(text, sizeof text, "<swarf.Cutter d=%g l=%g, %d part(s)>",
                  2 * swarf_cutter_radius(handle, SWARF_PART_FLUTES), hi - lo, (int)swarf_cutter_part_count(handle));
    return PyUnicode_FromString(text);
}

static PyMethodDef cutter_methods[] = {
    {"from_parts", cutter_from_parts, METH_O | METH_CLASS,
     "from_parts($type, parts, /)\n--\n\n"
     "A cutter from (kind, nodes) pairs: kind \"flutes\", \"shank\" or \"holder\"; nodes an (n, 3) table of\n"
     "r, z (mm) and bulge (tan of a quarter of the arc's angle to the next node, 0 for a line), from the axis\n"
     "at the lowest height up and back to the axis. ValueError, or GeometryError for an impossible meridian."},
    {"radius", WITH_KEYWORDS(cutter_radius), METH_VARARGS | METH_KEYWORDS,
     "radius($self, kind='flutes')\n--\n\nGreatest radius of the parts of one kind, mm; 0 if it has none."},
    {"extent", WITH_KEYWORDS(cutter_extent), METH_VARARGS | METH_KEYWORDS,
     "extent($self, kind='flutes')\n--\n\nLowest and highest z of the parts of one kind, mm; (0, 0) if it has none."},
    {"volume", WITH_KEYWORDS(cutter_volume), METH_VARARGS | METH_KEYWORDS,
     "volume($self, kind='flutes')\n--\n\nVolume of the parts of one kind, mm3, exact (Pappus)."},
    {"radius_at", WITH_KEYWORDS(cutter_radius_at), METH_VARARGS | METH_KEYWORDS,
     "radius_at($self, z, kind='flutes')\n--\n\nRadius of the parts of one kind at height z, mm; -1 outside."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef cutter_getset[] = {
    {"parts", cutter_parts, NULL, "Tuple of (kind, read-only (n, 3) float64 view of r, z, bulge).", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot cutter_slots[] = {
    {Py_tp_doc, "Cutter(text)\n--\n\n"
                "A cutter: a body of revolution about +z, tip at z = 0, from text such as \"flat:d=3,l=18\" or\n"
                "\"bull:d=6,r=1,l=20,sd=6,sl=30\" (shapes flat ball bull chamfer drill taperedball lollipop tslot\n"
                "dovetail threadmill form; mm and degrees). FormatError names the word that is wrong. Any thread."},
    {Py_tp_new, cutter_new},
    {Py_tp_dealloc, cutter_dealloc},
    {Py_tp_repr, cutter_repr},
    {Py_tp_methods, cutter_methods},
    {Py_tp_getset, cutter_getset},
    {0, NULL},
};

PyType_Spec cutter_spec = {
    .name = "swarf.Cutter",
    .basicsize = sizeof(cutter_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = cutter_slots,
};
