/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* swarf.Stock: one thread at a time; a second one gets BusyError from libswarf itself. */
#include "native.h"

static swarf_stock *handle_of(PyObject *self)
{
    return ((stock_object *)self)->handle;
}

PyObject *box_to_python(const swarf_box *box)
{
    for (int i = 0; i < 3; i++)
        if (!(box->lo[i] <= box->hi[i])) Py_RETURN_NONE;
    return Py_BuildValue("((ddd)(ddd))", box->lo[0], box->lo[1], box->lo[2], box->hi[0], box->hi[1], box->hi[2]);
}

PyObject *stock_wrap(PyTypeObject *type, native_call *call, swarf_status status, swarf_stock *handle)
{
    stock_object *self = NULL;
    if (call_end(call, state_of_type(type), status) == 0) self = (stock_object *)PyType_GenericAlloc(type, 0);
    if (!self) {
        swarf_stock_destroy(handle);
        return NULL;
    }
    self->handle = handle;
    return (PyObject *)self;
}

static void stock_dealloc(PyObject *self)
{
    swarf_stock_destroy(handle_of(self));
    object_free(self);
}

/* ---- making ---- */

/* -1 with ValueError when the limit is none. */
static int stock_options(double voxel, Py_ssize_t memory_limit, swarf_stock_options *out)
{
    if (memory_limit < 0) {
        PyErr_Format(PyExc_ValueError, "memory_limit %zd is negative; give bytes, 0 for most of what is free",
                     memory_limit);
        return -1;
    }
    *out = swarf_stock_options_default();
    out->voxel_mm = voxel;
    out->memory_limit = (size_t)memory_limit;
    return 0;
}

static PyObject *stock_box(PyObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"lo", "hi", "voxel", "memory_limit", NULL};
    PyObject *lo, *hi;
    double voxel;
    Py_ssize_t limit = 0;
    swarf_box box;
    swarf_stock_options options;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OOd|$n:box", names, &lo, &hi, &voxel, &limit) ||
        buffer_point(lo, "lo", box.lo) || buffer_point(hi, "hi", box.hi) || stock_options(voxel, limit, &options))
        return NULL;
    native_call call;
    swarf_stock *handle = NULL;
    call_begin(&call, NULL);
    const swarf_status status = swarf_stock_create_box(&box, &options, &handle);
    return stock_wrap((PyTypeObject *)type, &call, status, handle);
}

static PyObject *stock_cylinder(PyObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"base", "axis", "radius", "voxel", "memory_limit", NULL};
    PyObject *base_object, *axis_object;
    double radius, voxel, base[3], axis[3];
    Py_ssize_t limit = 0;
    swarf_stock_options options;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OOdd|$n:cylinder", names, &base_object, &axis_object, &radius,
                                     &voxel, &limit) ||
        buffer_point(base_object, "base", base) || buffer_point(axis_object, "axis", axis) ||
        stock_options(voxel, limit, &options))
        return NULL;
    native_call call;
    swarf_stock *handle = NULL;
    call_begin(&call, NULL);
    const swarf_status status = swarf_stock_create_cylinder(base, axis, radius, &options, &handle);
    return stock_wrap((PyTypeObject *)type, &call, status, handle);
}

static PyObject *stock_from_mesh(PyObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"mesh", "voxel", "memory_limit", "progress", NULL};
    PyObject *mesh, *progress = NULL;
    double voxel;
    Py_ssize_t limit = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!d|$nO:from_mesh", names,
                                     state_of_type((PyTypeObject *)type)->mesh, &mesh, &voxel, &limit, &progress))
        return NULL;
    swarf_stock_options options;
    if (stock_options(voxel, limit, &options)) return NULL;
    native_call call;
    if (call_begin(&call, progress)) return NULL;
    const swarf_triangles triangles = swarf_mesh_triangles(((mesh_object *)mesh)->handle);
    swarf_stock *handle = NULL;
    const swarf_status status = swarf_stock_create_mesh(&triangles, &options, &call.progress, &handle);
    return stock_wrap((PyTypeObject *)type, &call, status, handle);
}

static PyObject *stock_read(PyObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"path", "progress", NULL};
    PyObject *path, *progress = NULL, *result = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O&|$O:read", names, PyUnicode_FSConverter, &path, &progress))
        return NULL;
    native_call call;
    if (!call_begin(&call, progress)) {
        swarf_stock *handle = NULL;
        const swarf_status status = swarf_stock_read(PyBytes_AsString(path), &call.progress, &handle);
        result = stock_wrap((PyTypeObject *)type, &call, status, handle);
    }
    Py_DECREF(path);
    return result;
}

static PyObject *stock_estimate(PyObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"lo", "hi", "voxel", NULL};
    PyObject *lo, *hi;
    double voxel;
    swarf_box box;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OOd:estimate", names, &lo, &hi, &voxel) ||
        buffer_point(lo, "lo", box.lo) || buffer_point(hi, "hi", box.hi))
        return NULL;
    size_t bytes;
    const swarf_status status = swarf_stock_estimate(&box, voxel, &bytes);
    return status ? error_raise(state_of_type((PyTypeObject *)type), status) : PyLong_FromSize_t(bytes);
}

static PyObject *stock_copy(PyObject *self, PyObject *Py_UNUSED(none))
{
    native_call call;
    swarf_stock *handle = NULL;
    call_begin(&call, NULL);
    const swarf_status status = swarf_stock_copy(handle_of(self), &handle);
    return stock_wrap(Py_TYPE(self), &call, status, handle);
}

static swarf_status write_to(void *stock, const char *path, const swarf_progress *progress)
{
    return swarf_stock_write(stock, path, progress);
}

static PyObject *stock_write(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"path", "progress", NULL};
    PyObject *path, *progress = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O&|$O:write", names, PyUnicode_FSConverter, &path, &progress))
        return NULL;
    return call_write(state_of(self), handle_of(self), path, progress, write_to);
}

/* ---- measuring ---- */

static PyObject *stock_bounding_box(PyObject *self, PyObject *Py_UNUSED(none))
{
    native_call call;
    swarf_box box;
    call_begin(&call, NULL);
    const swarf_status status = swarf_stock_box(handle_of(self), &box);
    return call_end(&call, state_of(self), status) ? NULL : box_to_python(&box);
}

static PyObject *stock_volume(PyObject *self, PyObject *Py_UNUSED(none))
{
    native_call call;
    double volume;
    call_begin(&call, NULL);
    const swarf_status status = swarf_stock_volume(handle_of(self), &volume);
    return call_end(&call, state_of(self), status) ? NULL : PyFloat_FromDouble(volume);
}

static PyObject *stock_hash(PyObject *self, PyObject *Py_UNUSED(none))
{
    native_call call;
    uint64_t hash;
    call_begin(&call, NULL);
    const swarf_status status = swarf_stock_hash(handle_of(self), &hash);
    return call_end(&call, state_of(self), status) ? NULL : PyLong_FromUnsignedLongLong(hash);
}

static PyObject *stock_size(PyObject *self, PyObject *Py_UNUSED(none))
{
    native_call call;
    size_t leaves, bytes;
    call_begin(&call, NULL);
    const swarf_status status = swarf_stock_size(handle_of(self), &leaves, &bytes);
    if (call_end(&call, state_of(self), status)) return NULL;
    return Py_BuildValue("(nn)", (Py_ssize_t)leaves, (Py_ssize_t)bytes);
}

static PyObject *stock_sample(PyObject *self, PyObject *argument)
{
    double *points;
    size_t count;
    if (buffer_doubles(argument, "points", 3, &points, &count)) return NULL;
    PyObject *result = NULL, *values = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(count * sizeof(float)));
    native_call call;
    if (values && !call_begin(&call, NULL)) {
        const swarf_status status =
            swarf_stock_sample(handle_of(self), points, count, (float *)(void *)PyBytes_AsString(values));
        if (call_end(&call, state_of(self), status) == 0)
            result = buffer_view(state_of(self), values, PyBytes_AsString(values), "f", sizeof(float), count, 0, NULL);
    }
    Py_XDECREF(values);
    PyMem_Free(points);
    return result;
}

/* ---- changing ---- */

/** The paths of a stretch of a program; moves without motion are left out. Runs without the GIL. */
static swarf_status collect_paths(const swarf_program *program, size_t first, size_t count, swarf_path *paths,
                                  size_t *found)
{
    *found = 0;
    for (size_t i = 0; i < count; i++) {
        const swarf_status status = swarf_program_path(program, first + i, &paths[*found]);
        if (status) return status;
        if (paths[*found].has_motion) ++*found;
    }
    return SWARF_OK;
}

static PyObject *stock_cut(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"cutter", "program", "first", "count", "progress", NULL};
    module_state *state = state_of(self);
    PyObject *cutter, *program_argument, *count_object = Py_None, *progress = NULL;
    Py_ssize_t first_wanted = 0;
    size_t first, count;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!|n$OO:cut", names, state->cutter, &cutter, state->program,
                                     &program_argument, &first_wanted, &count_object, &progress))
        return NULL;
    program_object *program = (program_object *)program_argument;
    if (program_range(program, first_wanted, count_object, &first, &count)) return NULL;
    swarf_path *paths = PyMem_Calloc(count + 1, sizeof *paths);
    if (!paths) return PyErr_NoMemory();
    native_call call;
    program->readers++; /* before the GIL goes: nobody may grow the program from here on */
    int failed = call_begin(&call, progress);
    if (!failed) {
        size_t found;
        swarf_status status = collect_paths(program->handle, first, count, paths, &found);
        if (!status)
            status = swarf_stock_cut(handle_of(self), ((cutter_object *)cutter)->handle, paths, found, &call.progress);
        failed = call_end(&call, state, status);
    }
    program->readers--;
    PyMem_Free(paths);
    if (failed) return NULL;
    Py_RETURN_NONE;
}

static PyObject *stock_boolean(PyObject *self, PyObject *other, swarf_boolean operation)
{
    module_state *state = state_of(self);
    if (!PyObject_TypeCheck(other, state->stock)) {
        PyErr_SetString(PyExc_TypeError, "other: needs a Stock");
        return NULL;
    }
    native_call call;
    call_begin(&call, NULL);
    const swarf_status status = swarf_stock_boolean(handle_of(self), handle_of(other), operation);
    if (call_end(&call, state, status)) return NULL;
    Py_RETURN_NONE;
}

static PyObject *stock_union(PyObject *self, PyObject *other)
{
    return stock_boolean(self, other, SWARF_UNION);
}

static PyObject *stock_intersection(PyObject *self, PyObject *other)
{
    return stock_boolean(self, other, SWARF_INTERSECTION);
}

static PyObject *stock_difference(PyObject *self, PyObject *other)
{
    return stock_boolean(self, other, SWARF_DIFFERENCE);
}

static PyObject *stock_voxel(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(swarf_stock_voxel(handle_of(self)));
}

static PyObject *stock_repr(PyObject *self)
{
    char text[64]; /* no more than what is known without reading it: a stock may be in use */
    PyOS_snprintf(text, sizeof text, "<swarf.Stock voxel=%g>", swarf_stock_voxel(handle_of(self)));
    return PyUnicode_FromString(text);
}

static PyMethodDef stock_methods[] = {
    {"box", WITH_KEYWORDS(stock_box), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "box($type, lo, hi, voxel, *, memory_limit=0)\n--\n\n"
     "A block between two corners. MemoryError, before any work, when the estimate exceeds `memory_limit` bytes\n"
     "(0: 80 % of what is free); its text names a voxel size that would fit."},
    {"cylinder", WITH_KEYWORDS(stock_cylinder), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "cylinder($type, base, axis, radius, voxel, *, memory_limit=0)\n--\n\n"
     "A round bar from the centre of one end along the vector `axis`, whose length is the bar's."},
    {"from_mesh", WITH_KEYWORDS(stock_from_mesh), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "from_mesh($type, mesh, voxel, *, memory_limit=0, progress=None)\n--\n\n"
     "The inside of a closed Mesh. GeometryError when it is open or not oriented outwards."},
    {"read", WITH_KEYWORDS(stock_read), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "read($type, path, *, progress=None)\n--\n\n"
     "From the first level set of a .vdb file, with its voxel size. OSError, FormatError."},
    {"estimate", WITH_KEYWORDS(stock_estimate), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "estimate($type, lo, hi, voxel)\n--\n\nBytes that a stock filling this box may need while it is cut."},
    {"lumps", WITH_KEYWORDS(stock_lumps), METH_VARARGS | METH_KEYWORDS, stock_lumps_doc},
    {"placed", WITH_KEYWORDS(stock_placed), METH_VARARGS | METH_KEYWORDS, stock_placed_doc},
    {"write", WITH_KEYWORDS(stock_write), METH_VARARGS | METH_KEYWORDS,
     "write($self, path, *, progress=None)\n--\n\n"
     "To a .vdb file; beside the target and renamed, so a failure loses nothing."},
    {"copy", stock_copy, METH_NOARGS, "copy($self, /)\n--\n\nA stock of its own with the same content."},
    {"bounding_box", stock_bounding_box, METH_NOARGS,
     "bounding_box($self, /)\n--\n\n"
     "((x, y, z), (x, y, z)) of the material in mm, to half a voxel; None when nothing is left."},
    {"volume", stock_volume, METH_NOARGS, "volume($self, /)\n--\n\nVolume of the material, mm3."},
    {"hash", stock_hash, METH_NOARGS,
     "hash($self, /)\n--\n\n64-bit hash of the content, the same whatever the threads or kernels."},
    {"size", stock_size, METH_NOARGS, "size($self, /)\n--\n\n(leaves of 8x8x8 voxels, bytes held)."},
    {"sample", stock_sample, METH_O,
     "sample($self, points, /)\n--\n\n"
     "Signed distance (mm, negative inside, trilinear) at an (n, 3) table of points: read-only float32 view.\n"
     "Beyond the narrow band +-3 voxels."},
    {"cut", WITH_KEYWORDS(stock_cut), METH_VARARGS | METH_KEYWORDS,
     "cut($self, cutter, program, first=0, *, count=None, progress=None)\n--\n\n"
     "Cut with the flutes of one cutter along moves first .. first + count - 1 of a program, whatever their tool,\n"
     "all at once. Cancelling leaves some moves cut."},
    {"simulate", WITH_KEYWORDS(stock_simulate), METH_VARARGS | METH_KEYWORDS, stock_simulate_doc},
    {"check", WITH_KEYWORDS(stock_check), METH_VARARGS | METH_KEYWORDS, stock_check_doc},
    {"union", stock_union, METH_O, "union($self, other, /)\n--\n\nAdd another stock of the same voxels to this one."},
    {"intersection", stock_intersection, METH_O,
     "intersection($self, other, /)\n--\n\nKeep what is in another stock of the same voxels too."},
    {"difference", stock_difference, METH_O,
     "difference($self, other, /)\n--\n\nTake another stock of the same voxels away from this one."},
    {"picture", WITH_KEYWORDS(stock_picture), METH_VARARGS | METH_KEYWORDS, stock_picture_doc},
    {"cast", WITH_KEYWORDS(stock_cast), METH_VARARGS | METH_KEYWORDS, stock_cast_doc},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef stock_getset[] = {
    {"voxel", stock_voxel, NULL, "Edge of a voxel, mm.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot stock_slots[] = {
    {Py_tp_doc, "What is being milled: a narrow-band level set in mm. Made by Stock.box(), cylinder(), from_mesh() or\n"
                "read(). Long calls use all cores, take a progress callback of the fraction done (a true answer\n"
                "cancels: Cancelled; an exception cancels and comes out) and leave a consistent stock. A stock that\n"
                "is in use by another call raises BusyError."},
    {Py_tp_dealloc, stock_dealloc},
    {Py_tp_repr, stock_repr},
    {Py_tp_methods, stock_methods},
    {Py_tp_getset, stock_getset},
    {0, NULL},
};

PyType_Spec stock_spec = {
    .name = "swarf.Stock",
    .basicsize = sizeof(stock_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = stock_slots,
};
