/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* From one set-up to the next: methods of Stock, Surface and Mesh. */
#include "native.h"

/** A placement from three rows of four numbers. 0, or -1 with an exception. */
static int placement_read(module_state *state, PyObject *object, swarf_placement *out)
{
    double *rows;
    size_t count;
    if (buffer_doubles(object, "placement", 4, &rows, &count)) return -1;
    int failed = count != 3;
    if (failed)
        PyErr_Format(PyExc_ValueError, "placement: %zu rows where 3 are needed, of rotation and shift", count);
    else if (swarf_placement_create(rows, out))
        failed = error_raise(state, SWARF_ERROR_ARGUMENT) == NULL;
    PyMem_Free(rows);
    return failed ? -1 : 0;
}

/** The surface in an argument and its moves; *out NULL for None. 0, or -1 with an exception. */
static int surface_argument(module_state *state, PyObject *given, PyObject *moves, const swarf_surface **out,
                            size_t *count)
{
    *out = NULL;
    *count = 0;
    if (given == Py_None) {
        if (moves == Py_None) return 0;
        PyErr_SetString(PyExc_ValueError, "moves: they are those of a surface, which was not given");
        return -1;
    }
    if (!PyObject_TypeCheck(given, state->surface)) {
        PyErr_SetString(PyExc_TypeError, "surface: needs a Surface or None");
        return -1;
    }
    const surface_object *surface = (const surface_object *)given;
    size_t from;
    if (program_range(surface->program, 0, moves, &from, count)) return -1;
    *out = surface->handle;
    return 0;
}

const char stock_placed_doc[] =
    "placed($self, placement, *, voxel=None, surface=None, moves=None, memory_limit=0, progress=None)\n--\n\n"
    "The stock turned and moved, as a new Stock: ``placement`` is three rows of rotation and shift (mm), (3, 4). "
    "Quarter\n"
    "turns with any shift keep every voxel. Any other turn, or another ``voxel`` (mm), goes by the mesh with the "
    "Surface "
    "of\n"
    "which the stock has seen the first ``moves`` (None: all), without loss to speak of. Else new voxels are made from "
    "the\n"
    "old ones: edges move by less than a tenth of a voxel, corners by up to 0.3; edges too where voxels "
    "become\n"
    "larger. ValueError: not a rotation; GeometryError: nothing is left of the stock.";

PyObject *stock_placed(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"placement", "voxel", "surface", "moves", "memory_limit", "progress", NULL};
    module_state *state = state_of(self);
    PyObject *given, *voxel = Py_None, *surface = Py_None, *moves = Py_None, *progress = NULL;
    Py_ssize_t limit = 0;
    swarf_placement placement;
    swarf_place_options options = swarf_place_options_default();
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O|$OOOnO:placed", names, &given, &voxel, &surface, &moves, &limit,
                                     &progress) ||
        placement_read(state, given, &placement) ||
        surface_argument(state, surface, moves, &options.surface, &options.moves))
        return NULL;
    if (limit < 0) return PyErr_Format(PyExc_ValueError, "memory_limit %zd is negative", limit);
    options.memory_limit = (size_t)limit;
    if (voxel != Py_None) {
        options.voxel_mm = PyFloat_AsDouble(voxel);
        if (options.voxel_mm == -1.0 && PyErr_Occurred()) return NULL;
        if (!(options.voxel_mm > 0)) return PyErr_Format(PyExc_ValueError, "voxel: not a positive length in mm");
    }
    native_call call;
    if (call_begin(&call, progress)) return NULL;
    swarf_stock *handle = NULL;
    const swarf_status status =
        swarf_stock_place(((stock_object *)self)->handle, &placement, &options, &call.progress, &handle, NULL);
    return stock_wrap(Py_TYPE(self), &call, status, handle);
}

const char surface_next_doc[] =
    "next($self, placement, program, tools, *, moves=None, progress=None)\n--\n\n"
    "The Surface of the next set-up: this one after its first ``moves`` (None: all), turned and moved by "
    "``placement``, is\n"
    "the first shape of ``program``. Nothing is lost.";

typedef struct next_context {
    const swarf_surface *before;
    size_t moves;
    swarf_placement placement;
} next_context;

static swarf_status make_next(const void *context, const swarf_program *program, const swarf_tool *tools, size_t count,
                              const swarf_progress *progress, swarf_surface **out)
{
    const next_context *c = context;
    return swarf_surface_create_next(c->before, c->moves, &c->placement, program, tools, count, progress, out);
}

PyObject *surface_next(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"placement", "program", "tools", "moves", "progress", NULL};
    module_state *state = state_of(self);
    PyObject *given, *program, *tools, *moves = Py_None, *progress = NULL;
    next_context c;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OO!O!|$OO:next", names, &given, state->program, &program,
                                     &PyDict_Type, &tools, &moves, &progress) ||
        placement_read(state, given, &c.placement) || surface_argument(state, self, moves, &c.before, &c.moves))
        return NULL;
    return surface_make(Py_TYPE(self), program, tools, progress, self, make_next, &c);
}

const char mesh_placed_doc[] =
    "placed($self, placement, /)\n--\n\n"
    "The mesh turned and moved, as a new Mesh: ``placement`` is three rows of rotation and shift (mm).";

PyObject *mesh_placed(PyObject *self, PyObject *given)
{
    module_state *state = state_of(self);
    swarf_placement placement;
    native_call call;
    if (placement_read(state, given, &placement) || call_begin(&call, NULL)) return NULL;
    swarf_mesh *handle = NULL;
    const swarf_status status = swarf_mesh_create_placed(((mesh_object *)self)->handle, &placement, &handle);
    return call_end(&call, state, status) ? NULL : mesh_wrap(Py_TYPE(self), handle);
}

/* What a view of the triangles' surface points shows: rows of `columns` numbers, and how they are filled. */
typedef struct triangle_view {
    const char *arguments, *format;
    size_t item_bytes, columns;
    swarf_status (*fill)(const swarf_surface *surface, const swarf_surface_point *points, size_t rows,
                         const swarf_progress *progress, void *out);
} triangle_view;

/* A view with a row for each triangle of the mesh, by the point of a Surface that is nearest to its middle. */
static PyObject *view_triangles(PyObject *self, PyObject *args, PyObject *keywords, const triangle_view *view)
{
    static char *names[] = {"surface", "moves", "reach", "progress", NULL};
    module_state *state = state_of(self);
    PyObject *given, *moves = Py_None, *progress = NULL;
    const swarf_surface *surface;
    const swarf_mesh *mesh = ((mesh_object *)self)->handle;
    size_t count;
    double reach = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, view->arguments, names, state->surface, &given, &moves, &reach,
                                     &progress) ||
        surface_argument(state, given, moves, &surface, &count))
        return NULL;
    const size_t rows = swarf_mesh_triangles(mesh).triangle_count;
    swarf_surface_point *points = PyMem_Calloc(rows + 1, sizeof *points);
    PyObject *values = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(view->columns * rows * view->item_bytes));
    PyObject *result = NULL;
    native_call call;
    if (!points) {
        PyErr_NoMemory();
    } else if (values && !call_begin(&call, progress)) {
        void *out = PyBytes_AsString(values);
        swarf_status status = swarf_mesh_origins(mesh, surface, count, reach, &call.progress, points);
        if (!status) status = view->fill(surface, points, rows, &call.progress, out);
        if (!call_end(&call, state, status))
            result = buffer_view(state, values, out, view->format, view->item_bytes, rows, view->columns, NULL);
    }
    PyMem_Free(points);
    Py_XDECREF(values);
    return result;
}

const char mesh_origins_doc[] =
    "origins($self, surface, *, moves=None, reach=0.0, progress=None)\n--\n\n"
    "What made each triangle: a read-only (m, 4) int32 view of set-up (0: the Surface's own, 1: the one before\n"
    "...), move (-1: the first shape, -2: not known), piece of the cutter or the first shape, and kind of face:\n"
    "0 other, 1 plane, 2 cylinder, 3 cone, 4 sphere, 5 torus. Looked for within ``reach`` mm (0: a voxel) of the\n"
    "triangle, beside its middle.";

static swarf_status fill_origins(const swarf_surface *surface, const swarf_surface_point *points, size_t rows,
                                 const swarf_progress *progress, void *out)
{
    return swarf_surface_marks(surface, points, rows, progress, out);
}

PyObject *mesh_origins(PyObject *self, PyObject *args, PyObject *keywords)
{
    static const triangle_view view = {"O!|$OdO:origins", "i", sizeof(int32_t), 4, fill_origins};
    return view_triangles(self, args, keywords, &view);
}

const char mesh_faces_doc[] =
    "faces($self, surface, *, moves=None, reach=0.0, progress=None)\n--\n\n"
    "The endless face that each triangle is on: a read-only (m, 9) float64 view of kind (as in origins()), point\n"
    "(x, y, z), axis (unit), radius, and second number. Plane: a point, the normal out of the material; cylinder:\n"
    "axis and radius; cone: apex, axis, second = tangent of the angle between axis and face; sphere: centre,\n"
    "radius; torus: centre, axis, radius to the middle of the tube, second = radius of the tube. Looked for as\n"
    "origins() does.";

enum { FACE_COLUMNS = 9 };

static swarf_status fill_faces(const swarf_surface *surface, const swarf_surface_point *points, size_t rows,
                               const swarf_progress *progress, void *out)
{
    (void)progress; /* a microsecond each */
    double *row = out;
    for (size_t i = 0; i < rows; i++, row += FACE_COLUMNS) {
        const swarf_face_shape shape = swarf_surface_shape(surface, &points[i]);
        row[0] = shape.kind;
        memcpy(row + 1, shape.point, sizeof shape.point);
        memcpy(row + 4, shape.axis, sizeof shape.axis);
        row[7] = shape.radius;
        row[8] = shape.second;
    }
    return SWARF_OK;
}

PyObject *mesh_faces(PyObject *self, PyObject *args, PyObject *keywords)
{
    static const triangle_view view = {"O!|$OdO:faces", "d", sizeof(double), FACE_COLUMNS, fill_faces};
    return view_triangles(self, args, keywords, &view);
}
