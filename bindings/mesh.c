/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* swarf.Mesh and compare_volume(): triangles, immutable, any thread. Their measures are in measures.c. */
#include "native.h"

static swarf_mesh *handle_of(PyObject *self)
{
    return ((mesh_object *)self)->handle;
}

PyObject *mesh_wrap(PyTypeObject *type, swarf_mesh *handle)
{
    mesh_object *self = (mesh_object *)PyType_GenericAlloc(type, 0);
    if (!self) {
        swarf_mesh_release(handle);
        return NULL;
    }
    self->handle = handle;
    self->from_stock = 0;
    return (PyObject *)self;
}

/** End a call that makes a mesh. */
static PyObject *mesh_finish(PyObject *type, native_call *call, swarf_status status, swarf_mesh *handle)
{
    if (call_end(call, state_of_type((PyTypeObject *)type), status)) {
        swarf_mesh_release(handle);
        return NULL;
    }
    return mesh_wrap((PyTypeObject *)type, handle);
}

static PyObject *mesh_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"vertices", "triangles", NULL};
    PyObject *vertices_object, *triangles_object, *result = NULL;
    double *vertices = NULL;
    uint32_t *index = NULL;
    swarf_triangles triangles = {0};
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OO:Mesh", names, &vertices_object, &triangles_object))
        return NULL;
    if (buffer_doubles(vertices_object, "vertices", 3, &vertices, &triangles.vertex_count) ||
        buffer_indices(triangles_object, "triangles", 3, &index, &triangles.triangle_count)) {
        PyMem_Free(vertices);
        return NULL;
    }
    float *xyz = PyMem_Malloc(3 * triangles.vertex_count * sizeof *xyz + 1);
    native_call call;
    if (!xyz) {
        PyErr_NoMemory();
    } else if (!call_begin(&call, NULL)) {
        for (size_t i = 0; i < 3 * triangles.vertex_count; i++) xyz[i] = (float)vertices[i];
        triangles.xyz = xyz;
        triangles.index = index;
        swarf_mesh *handle = NULL;
        const swarf_status status = swarf_mesh_create(&triangles, &handle);
        result = mesh_finish((PyObject *)type, &call, status, handle);
    }
    PyMem_Free(xyz);
    PyMem_Free(vertices);
    PyMem_Free(index);
    return result;
}

static void mesh_dealloc(PyObject *self)
{
    swarf_mesh_release(handle_of(self));
    object_free(self);
}

static PyObject *mesh_read(PyObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"path", NULL};
    PyObject *path, *result = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O&:read", names, PyUnicode_FSConverter, &path)) return NULL;
    native_call call;
    if (!call_begin(&call, NULL)) {
        swarf_mesh *handle = NULL;
        const swarf_status status = swarf_mesh_read(PyBytes_AsString(path), &handle);
        result = mesh_finish(type, &call, status, handle);
    }
    Py_DECREF(path);
    return result;
}

/** What meshes of a stock are made with; 0, or -1 with an exception. */
static int read_options(const module_state *state, double error, PyObject *given, PyObject *moves, int fine,
                        int keep_volume, swarf_contour_options *out)
{
    if (given != Py_None && !PyObject_TypeCheck(given, state->surface)) {
        PyErr_Format(PyExc_TypeError, "surface: needs a Surface or None");
        return -1;
    }
    const surface_object *surface = given == Py_None ? NULL : (const surface_object *)given;
    size_t from, count = 0;
    if (!surface && moves != Py_None) {
        PyErr_Format(PyExc_ValueError, "moves: they are those of a surface, which was not given");
        return -1;
    }
    if (surface && program_range(surface->program, 0, moves, &from, &count)) return -1;
    *out = swarf_contour_options_default();
    out->error_mm = error;
    out->surface = surface ? surface->handle : NULL;
    out->moves = count;
    out->fine = fine;
    out->keep_volume = keep_volume;
    return 0;
}

static PyObject *mesh_from_stock(PyObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"stock", "error", "budget", "surface", "moves", "fine", "keep_volume", "progress", NULL};
    module_state *state = state_of_type((PyTypeObject *)type);
    PyObject *stock, *surface = Py_None, *moves = Py_None, *progress = NULL;
    double error = 0;
    int fine = 0, keep_volume = 0;
    Py_ssize_t budget = 0;
    swarf_contour_options options;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!|d$O&OOppO:from_stock", names, state->stock, &stock, &error,
                                     count_read, &budget, &surface, &moves, &fine, &keep_volume, &progress) ||
        read_options(state, error, surface, moves, fine, keep_volume, &options))
        return NULL;
    if (budget < 0) return PyErr_Format(PyExc_ValueError, "budget: %zd is not a number of triangles", budget);
    options.triangle_budget = (size_t)budget;
    native_call call;
    if (call_begin(&call, progress)) return NULL;
    swarf_contour_report report;
    swarf_mesh *handle = NULL;
    const swarf_status status =
        swarf_mesh_contour(((stock_object *)stock)->handle, &options, &call.progress, &handle, &report);
    PyObject *result = mesh_finish(type, &call, status, handle);
    if (result) {
        ((mesh_object *)result)->contour = report;
        ((mesh_object *)result)->from_stock = 1;
    }
    return result;
}

typedef struct streaming {
    swarf_stock *stock;
    const swarf_contour_options *options;
    size_t memory_limit;
    swarf_contour_report report;
} streaming;

static swarf_status stream_to(void *context, const char *path, const swarf_progress *progress)
{
    streaming *s = context;
    return swarf_mesh_stream(s->stock, s->options, s->memory_limit, path, progress, &s->report);
}

static PyObject *mesh_stream(PyObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"stock", "path",        "error",        "surface",  "moves",
                            "fine",  "keep_volume", "memory_limit", "progress", NULL};
    module_state *state = state_of_type((PyTypeObject *)type);
    PyObject *stock, *path, *surface = Py_None, *moves = Py_None, *progress = NULL;
    double error = 0;
    int fine = 0, keep_volume = 0;
    Py_ssize_t limit = 0;
    swarf_contour_options options;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O&|d$OOppO&O:stream", names, state->stock, &stock,
                                     PyUnicode_FSConverter, &path, &error, &surface, &moves, &fine, &keep_volume,
                                     count_read, &limit, &progress))
        return NULL;
    int bad = read_options(state, error, surface, moves, fine, keep_volume, &options);
    if (!bad && limit < 0) {
        PyErr_Format(PyExc_ValueError, "memory_limit: %zd is not a number of bytes", limit);
        bad = -1;
    }
    if (bad) {
        Py_DECREF(path);
        return NULL;
    }
    streaming s = {.stock = ((stock_object *)stock)->handle, .options = &options, .memory_limit = (size_t)limit};
    PyObject *done = call_write(state, &s, path, progress, stream_to);
    if (!done) return NULL;
    Py_DECREF(done);
    return contour_tuple(state, &s.report);
}

typedef struct writing {
    const swarf_mesh *mesh;
    const uint8_t *rgb;
    size_t count;
} writing;

static swarf_status write_to(void *context, const char *path, const swarf_progress *progress)
{
    const writing *w = context;
    return swarf_mesh_write_coloured(w->mesh, w->rgb, w->count, path, progress);
}

/** A table of colours as bytes; *out is freed with PyMem_Free(). */
static int read_colours(PyObject *object, uint8_t **out, size_t *count)
{
    uint32_t *values;
    *out = NULL;
    *count = 0;
    if (!object || object == Py_None) return 0;
    if (buffer_indices(object, "colours", 3, &values, count)) return -1;
    uint8_t *rgb = PyMem_Malloc(3 * *count + 1);
    for (size_t i = 0; rgb && i < 3 * *count; i++) {
        if (values[i] > 255) {
            PyErr_Format(PyExc_ValueError, "colours: row %zu: %u is not in 0 .. 255", i / 3, (unsigned)values[i]);
            PyMem_Free(rgb);
            PyMem_Free(values);
            return -1;
        }
        rgb[i] = (uint8_t)values[i];
    }
    PyMem_Free(values);
    *out = rgb;
    if (!rgb) PyErr_NoMemory();
    return rgb ? 0 : -1;
}

static PyObject *mesh_write(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"path", "colours", "progress", NULL};
    PyObject *path, *colours = NULL, *progress = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O&|$OO:write", names, PyUnicode_FSConverter, &path, &colours,
                                     &progress))
        return NULL;
    writing w = {.mesh = handle_of(self)};
    uint8_t *rgb;
    if (read_colours(colours, &rgb, &w.count)) {
        Py_DECREF(path);
        return NULL;
    }
    w.rgb = rgb;
    PyObject *result = call_write(state_of(self), &w, path, progress, write_to);
    PyMem_Free(rgb);
    return result;
}

/* ---- properties: measured once, when the mesh was made ---- */

static PyObject *mesh_vertices(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_triangles triangles = swarf_mesh_triangles(handle_of(self));
    return buffer_view(state_of(self), self, triangles.xyz, "f", sizeof(float), triangles.vertex_count, 3, NULL);
}

static PyObject *mesh_triangles(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_triangles triangles = swarf_mesh_triangles(handle_of(self));
    return buffer_view(state_of(self), self, triangles.index, "I", sizeof(uint32_t), triangles.triangle_count, 3, NULL);
}

static PyObject *mesh_vertex_count(PyObject *self, void *Py_UNUSED(closure))
{
    return PyLong_FromSize_t(swarf_mesh_triangles(handle_of(self)).vertex_count);
}

static PyObject *mesh_triangle_count(PyObject *self, void *Py_UNUSED(closure))
{
    return PyLong_FromSize_t(swarf_mesh_triangles(handle_of(self)).triangle_count);
}

static PyObject *mesh_closed(PyObject *self, void *Py_UNUSED(closure))
{
    return PyBool_FromLong(swarf_mesh_topology(handle_of(self)).closed);
}

static PyObject *mesh_volume(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(swarf_mesh_topology(handle_of(self)).volume_mm3);
}

static PyObject *mesh_area(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(swarf_mesh_topology(handle_of(self)).area_mm2);
}

static PyObject *mesh_bounding_box(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_topology topology = swarf_mesh_topology(handle_of(self));
    return box_to_python(&topology.box);
}

static PyObject *mesh_edges(PyObject *self, void *closure)
{
    const swarf_topology topology = swarf_mesh_topology(handle_of(self));
    return PyLong_FromSize_t(*(const size_t *)((const char *)&topology + (size_t)(uintptr_t)closure));
}
#define FIELD(name) (void *)(uintptr_t)offsetof(swarf_topology, name)

static PyObject *mesh_repr(PyObject *self)
{
    const swarf_triangles triangles = swarf_mesh_triangles(handle_of(self));
    return PyUnicode_FromFormat("<swarf.Mesh of %zu vertices, %zu triangles, %s>", triangles.vertex_count,
                                triangles.triangle_count,
                                swarf_mesh_topology(handle_of(self)).closed ? "closed" : "open");
}

static PyMethodDef mesh_methods[] = {
    {"read", WITH_KEYWORDS(mesh_read), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "read($type, path)\n--\n\nMesh from a .stl (welded), .ply or .obj file, by its content. OSError, FormatError."},
    {"from_stock", WITH_KEYWORDS(mesh_from_stock), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "from_stock($type, stock, error=0.0, *, budget=0, surface=None, moves=None, fine=False, keep_volume=False,\n"
     "progress=None)\n--\n\n"
     "The surface of a stock with its edges: closed, oriented outwards, no triangles that cut each other. Vertices "
     "are\n"
     "left out while the mesh stays within ``error`` mm of the full one, until at most ``budget`` triangles are left\n"
     "(0: as few as the error allows). Vertices lie exactly on the Surface of which the stock has seen the first\n"
     "``moves`` (None: all), edges as sharp as they are; without one they come from the voxels. ``fine``: triangles\n"
     "that leave the Surface, beside edges closer to each other than a voxel, are split; that takes longer.\n"
     "``keep_volume``: vertices are shifted, by a fifth of the error at most (a hundredth of a voxel where it is 0),\n"
     "until the mesh has the volume of the surface, ``contour.surface_mm3``, or is as near to it as that allows.\n"
     "What it came to is in ``contour``."},
    {"stream", WITH_KEYWORDS(mesh_stream), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "stream($type, stock, path, error=0.0, *, surface=None, moves=None, fine=False, keep_volume=False,\n"
     "memory_limit=0, progress=None)\n"
     "--\n\n"
     "The mesh of from_stock() straight to a binary .stl file; its Contour. One that would not fit into\n"
     "``memory_limit`` (bytes; 0: 80 % of what is free now) is made and written band by band along x, with small\n"
     "triangles along the planes between them; a pipe gets the whole one however much memory that takes."},
    {"write", WITH_KEYWORDS(mesh_write), METH_VARARGS | METH_KEYWORDS,
     "write($self, path, *, colours=None, progress=None)\n--\n\n"
     "Write .stl or .ply (binary), .obj, .3mf or .glb by the suffix; beside the target and renamed, so a failure "
     "loses\n"
     "nothing. ``colours`` is an (m, 3) table of 0 .. 255, a row per triangle; .stl has no place for it."},
    {"measure", mesh_measure, METH_NOARGS, mesh_measure_doc},
    {"shells", mesh_shells, METH_NOARGS, mesh_shells_doc},
    {"keep_shells", mesh_keep_shells, METH_O, mesh_keep_shells_doc},
    {"split_shells", WITH_KEYWORDS(mesh_split_shells), METH_VARARGS | METH_KEYWORDS, mesh_split_shells_doc},
    {"split", WITH_KEYWORDS(mesh_split), METH_VARARGS | METH_KEYWORDS, mesh_split_doc},
    {"thickness", WITH_KEYWORDS(mesh_thickness), METH_VARARGS | METH_KEYWORDS, mesh_thickness_doc},
    {"placed", mesh_placed, METH_O, mesh_placed_doc},
    {"origins", WITH_KEYWORDS(mesh_origins), METH_VARARGS | METH_KEYWORDS, mesh_origins_doc},
    {"faces", WITH_KEYWORDS(mesh_faces), METH_VARARGS | METH_KEYWORDS, mesh_faces_doc},
    {"section", WITH_KEYWORDS(mesh_section), METH_VARARGS | METH_KEYWORDS, mesh_section_doc},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef mesh_getset[] = {
    {"vertices", mesh_vertices, NULL, "Read-only (n, 3) float32 view, mm.", NULL},
    {"triangles", mesh_triangles, NULL, "Read-only (n, 3) uint32 view of vertex numbers, outwards.", NULL},
    {"vertex_count", mesh_vertex_count, NULL, "Number of vertices.", NULL},
    {"triangle_count", mesh_triangle_count, NULL, "Number of triangles.", NULL},
    {"closed", mesh_closed, NULL, "Whether every edge is balanced: the surface bounds a volume.", NULL},
    {"volume", mesh_volume, NULL, "Signed volume, mm3; positive when oriented outwards.", NULL},
    {"area", mesh_area, NULL, "Area, mm2.", NULL},
    {"bounding_box", mesh_bounding_box, NULL, "((x, y, z), (x, y, z)) in mm, None when empty.", NULL},
    {"boundary_edges", mesh_edges, NULL, "Edges of one triangle only.", FIELD(boundary_edges)},
    {"nonmanifold_edges", mesh_edges, NULL, "Edges of more than two triangles.", FIELD(nonmanifold_edges)},
    {"misoriented_edges", mesh_edges, NULL, "Edges that two triangles use in one direction.", FIELD(misoriented_edges)},
    {"degenerate", mesh_edges, NULL, "Triangles with a repeated vertex.", FIELD(degenerate)},
    {"contour", mesh_contour, NULL, "Contour: what Mesh.from_stock() came to; None for other meshes.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot mesh_slots[] = {
    {Py_tp_doc, "Mesh(vertices, triangles)\n--\n\n"
                "Triangles: vertices an (n, 3) table in mm, triangles an (m, 3) table of vertex numbers,\n"
                "counter-clockwise seen from outside. Immutable, any thread. ValueError for numbers out of range."},
    {Py_tp_new, mesh_new},
    {Py_tp_dealloc, mesh_dealloc},
    {Py_tp_repr, mesh_repr},
    {Py_tp_methods, mesh_methods},
    {Py_tp_getset, mesh_getset},
    {0, NULL},
};

PyType_Spec mesh_spec = {
    .name = "swarf.Mesh",
    .basicsize = sizeof(mesh_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = mesh_slots,
};

/* ---- comparing ---- */

static PyStructSequence_Field comparison_fields[] = {
    {"design_mm3", "Volume of the design."},
    {"stock_mm3", "Volume of the stock."},
    {"excess_mm3", "Stock outside the design: material left."},
    {"gouge_mm3", "Design outside the stock: material missing."},
    {NULL, NULL},
};

PyStructSequence_Desc comparison_desc = {
    .name = "swarf.Comparison",
    .doc = "Stock and design by volume, mm3.",
    .fields = comparison_fields,
    .n_in_sequence = 4,
};

const char compare_volume_doc[] =
    "compare_volume(stock, design, *, progress=None)\n--\n\n"
    "Compare a stock with a closed design Mesh by volume, on the stock's own voxels -> Comparison.\n"
    "The stock is unchanged. GeometryError when the design is open.";

PyObject *compare_volume(PyObject *module, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"stock", "design", "progress", NULL};
    module_state *state = PyModule_GetState(module);
    PyObject *stock, *design, *progress = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!|$O:compare_volume", names, state->stock, &stock, state->mesh,
                                     &design, &progress))
        return NULL;
    native_call call;
    if (call_begin(&call, progress)) return NULL;
    const swarf_triangles triangles = swarf_mesh_triangles(handle_of(design));
    swarf_comparison found = {0};
    swarf_solid *solid = NULL;
    swarf_status status = swarf_solid_create(&triangles, NULL, &solid);
    if (!status) status = swarf_compare_volume(((stock_object *)stock)->handle, solid, &call.progress, &found);
    swarf_solid_release(solid);
    if (call_end(&call, state, status)) return NULL;
    const double values[] = {found.design_mm3, found.stock_mm3, found.excess_mm3, found.gouge_mm3};
    PyObject *result = PyStructSequence_New(state->comparison);
    for (Py_ssize_t i = 0; result && i < 4; i++) {
        PyObject *value = PyFloat_FromDouble(values[i]);
        if (value)
            PyStructSequence_SetItem(result, i, value);
        else
            Py_CLEAR(result);
    }
    return result;
}
