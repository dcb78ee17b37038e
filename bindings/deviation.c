/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* swarf.Solid, swarf.Deviation and what is measured with them. */
#include "native.h"

/* ---- solids ---- */

static swarf_solid *solid_of(PyObject *self)
{
    return ((solid_object *)self)->handle;
}

static PyObject *solid_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"mesh", "progress", NULL};
    module_state *state = state_of_type(type);
    PyObject *mesh, *progress = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!|$O:Solid", names, state->mesh, &mesh, &progress)) return NULL;
    native_call call;
    if (call_begin(&call, progress)) return NULL;
    const swarf_triangles triangles = swarf_mesh_triangles(((mesh_object *)mesh)->handle);
    swarf_solid *handle = NULL;
    const swarf_status status = swarf_solid_create(&triangles, &call.progress, &handle);
    solid_object *self = NULL;
    if (!call_end(&call, state, status)) self = (solid_object *)PyType_GenericAlloc(type, 0);
    if (!self) {
        swarf_solid_release(handle);
        return NULL;
    }
    self->handle = handle;
    return (PyObject *)self;
}

static void solid_dealloc(PyObject *self)
{
    swarf_solid_release(solid_of(self));
    object_free(self);
}

static PyObject *solid_distance(PyObject *self, PyObject *points_object)
{
    double *points;
    size_t count;
    if (buffer_doubles(points_object, "points", 3, &points, &count)) return NULL;
    PyObject *result = NULL, *bytes = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(count * sizeof(double)));
    native_call call;
    if (bytes && !call_begin(&call, NULL)) {
        double *distance = (double *)PyBytes_AsString(bytes);
        const swarf_status status = swarf_solid_distance(solid_of(self), points, count, &call.progress, distance, NULL);
        if (!call_end(&call, state_of(self), status))
            result = buffer_view(state_of(self), bytes, distance, "d", sizeof *distance, count, 0, NULL);
    }
    Py_XDECREF(bytes);
    PyMem_Free(points);
    return result;
}

static PyObject *solid_size(PyObject *self, void *closure)
{
    const swarf_solid_facts facts = swarf_solid_get_facts(solid_of(self));
    return PyLong_FromSize_t(*(const size_t *)((const char *)&facts + (size_t)(uintptr_t)closure));
}

static PyObject *solid_volume(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(swarf_solid_get_facts(solid_of(self)).volume_mm3);
}

static PyObject *solid_hole(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(swarf_solid_get_facts(solid_of(self)).hole_mm2);
}

static PyObject *solid_box(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_solid_facts facts = swarf_solid_get_facts(solid_of(self));
    return box_to_python(&facts.box);
}
#define FACT(name) (void *)(uintptr_t)offsetof(swarf_solid_facts, name)

static PyMethodDef solid_methods[] = {
    {"distance", solid_distance, METH_O,
     "distance($self, points, /)\n--\n\n"
     "Signed distances (mm, negative inside, exact) of an (n, 3) table of points: read-only float64 view."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef solid_getset[] = {
    {"volume", solid_volume, NULL, "Volume, mm3; what shells have in common counts once.", NULL},
    {"bounding_box", solid_box, NULL, "((x, y, z), (x, y, z)) in mm.", NULL},
    {"triangle_count", solid_size, NULL, "Triangles that bound it.", FACT(triangle_count)},
    {"dropped_triangles", solid_size, NULL, "Degenerate, duplicate and inner triangles.", FACT(dropped_triangles)},
    {"open_edges", solid_size, NULL, "Edges where the mesh is open.", FACT(open_edges)},
    {"turned_edges", solid_size, NULL, "Edges between triangles turned different ways.", FACT(turned_edges)},
    {"crossing_triangles", solid_size, NULL, "Triangles that cross or touch others.", FACT(crossing_triangles)},
    {"hole_mm2", solid_hole, NULL, "The holes have no greater area.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot solid_slots[] = {
    {Py_tp_doc, "Solid(mesh, *, progress=None)\n--\n\n"
                "What a closed Mesh encloses, with exact signed distances. Small holes pass (see open_edges).\n"
                "GeometryError when it is open, inside out or encloses nothing. Immutable, any thread."},
    {Py_tp_new, solid_new},
    {Py_tp_dealloc, solid_dealloc},
    {Py_tp_methods, solid_methods},
    {Py_tp_getset, solid_getset},
    {0, NULL},
};

PyType_Spec solid_spec = {
    .name = "swarf.Solid",
    .basicsize = sizeof(solid_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = solid_slots,
};

/* ---- deviations ---- */

typedef struct deviation_object {
    PyObject_HEAD swarf_deviation *handle;
} deviation_object;

static const swarf_deviation *deviation_of(PyObject *self)
{
    return ((deviation_object *)self)->handle;
}

static void deviation_dealloc(PyObject *self)
{
    swarf_deviation_destroy(((deviation_object *)self)->handle);
    object_free(self);
}

PyObject *make_sequence(PyTypeObject *type, PyObject **items, Py_ssize_t count)
{
    PyObject *result = PyStructSequence_New(type);
    for (Py_ssize_t i = 0; i < count; i++) {
        if (result && items[i]) {
            PyStructSequence_SetItem(result, i, items[i]);
        } else {
            Py_XDECREF(items[i]);
            Py_CLEAR(result);
        }
    }
    return result;
}

static PyStructSequence_Field cluster_fields[] = {
    {"kind", "\"excess\", \"gouge\" or \"not reached\" (excess where no move went)."},
    {"value", "Greatest deviation, mm, positive outwards."},
    {"at_least", "Whether the value is only known to be as much: a feature that is missing altogether."},
    {"place", "Where that is, mm."},
    {"area", "Area beyond tolerance, mm2."},
    {"volume", "Volume between stock and design, mm3."},
    {"box", "Bounding box of the places."},
    {"triangle", "Triangle of the design nearest to the place."},
    {"moves", "Moves that made it, or came nearest; the last cuts first."},
    {"away", "How far the nearest cut stays from the place, mm."},
    {NULL, NULL},
};

PyStructSequence_Desc cluster_desc = {
    .name = "swarf.Cluster",
    .doc = "Neighbouring places where the deviation is beyond tolerance.",
    .fields = cluster_fields,
    .n_in_sequence = 10,
};

static PyObject *cluster_to_python(module_state *state, const swarf_cluster *c)
{
    PyObject *moves = PyTuple_New((Py_ssize_t)c->move_count);
    for (uint32_t i = 0; moves && i < c->move_count; i++) {
        PyObject *move = PyLong_FromLongLong(c->moves[i]);
        if (!move || PyTuple_SetItem(moves, (Py_ssize_t)i, move) < 0) Py_CLEAR(moves);
    }
    PyObject *items[] = {
        PyUnicode_FromString(!c->excess   ? "gouge"
                             : c->reached ? "excess"
                                          : "not reached"),
        PyFloat_FromDouble(c->value_mm),
        PyBool_FromLong(c->at_least),
        Py_BuildValue("(ddd)", c->place[0], c->place[1], c->place[2]),
        PyFloat_FromDouble(c->area_mm2),
        PyFloat_FromDouble(c->volume_mm3),
        box_to_python(&c->box),
        PyLong_FromUnsignedLong(c->triangle),
        moves,
        PyFloat_FromDouble(c->away_mm),
    };
    return make_sequence(state->cluster, items, 10);
}

static PyObject *deviation_clusters(PyObject *self, void *Py_UNUSED(closure))
{
    size_t count;
    const swarf_cluster *clusters = swarf_deviation_clusters(deviation_of(self), &count);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        PyObject *cluster = cluster_to_python(state_of(self), &clusters[i]);
        if (!cluster || PyTuple_SetItem(result, (Py_ssize_t)i, cluster) < 0) Py_CLEAR(result);
    }
    return result;
}

static PyObject *deviation_comparison(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_comparison c = swarf_deviation_get_sums(deviation_of(self)).volumes;
    PyObject *items[] = {PyFloat_FromDouble(c.design_mm3), PyFloat_FromDouble(c.stock_mm3),
                         PyFloat_FromDouble(c.excess_mm3), PyFloat_FromDouble(c.gouge_mm3)};
    return make_sequence(state_of(self)->comparison, items, 4);
}

static PyObject *deviation_number(PyObject *self, void *closure)
{
    const swarf_deviation_sums sums = swarf_deviation_get_sums(deviation_of(self));
    return PyFloat_FromDouble(*(const double *)((const char *)&sums + (size_t)(uintptr_t)closure));
}
#define SUM(name) (void *)(uintptr_t)offsetof(swarf_deviation_sums, name)

static PyObject *deviation_percentiles(PyObject *self, void *Py_UNUSED(closure))
{
    const swarf_deviation_sums sums = swarf_deviation_get_sums(deviation_of(self));
    const double *p = sums.percentile_mm;
    return Py_BuildValue("(ddddddd)", p[0], p[1], p[2], p[3], p[4], p[5], p[6]);
}

static PyObject *deviation_passed(PyObject *self, void *Py_UNUSED(closure))
{
    return PyBool_FromLong(swarf_deviation_get_sums(deviation_of(self)).passed);
}

static PyObject *deviation_points(PyObject *self, void *closure)
{
    const float *xyz, *value;
    const uint8_t *kind;
    const size_t count = swarf_deviation_points(deviation_of(self), &xyz, &value, &kind);
    switch ((int)(intptr_t)closure) {
    case 0: return buffer_view(state_of(self), self, xyz, "f", sizeof *xyz, count, 3, NULL);
    case 1: return buffer_view(state_of(self), self, value, "f", sizeof *value, count, 0, NULL);
    default: return buffer_view(state_of(self), self, kind, "B", sizeof *kind, count, 0, NULL);
    }
}

static PyObject *deviation_histogram(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"lo", "hi", "bins", NULL};
    double lo, hi;
    Py_ssize_t bins = 64;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "dd|n:histogram", names, &lo, &hi, &bins)) return NULL;
    if (bins < 1 || bins > 1 << 20) {
        PyErr_SetString(PyExc_ValueError, "bins: 1 .. 1048576 are possible");
        return NULL;
    }
    double *areas = PyMem_Calloc((size_t)bins, sizeof *areas);
    if (!areas) return PyErr_NoMemory();
    const swarf_status status = swarf_deviation_histogram(deviation_of(self), lo, hi, (size_t)bins, areas);
    PyObject *result = status ? error_raise(state_of(self), status) : PyTuple_New(bins);
    for (Py_ssize_t i = 0; result && i < bins; i++) {
        PyObject *area = PyFloat_FromDouble(areas[i]);
        if (!area || PyTuple_SetItem(result, i, area) < 0) Py_CLEAR(result);
    }
    PyMem_Free(areas);
    return result;
}

/* What options of a deviation borrow from Python while the GIL is released. */
typedef struct deviation_borrowed {
    PyObject *ignore; /* bytes */
    swarf_tool *tools;
    size_t tool_count;
    swarf_program *program; /* NULL: moves are not asked for */
    program_object *reader;
} deviation_borrowed;

/* Region, ignore (one byte per triangle), program and tools as Python has them; end with borrowed_end() in any case. */
static int borrowed_begin(module_state *state, PyObject *region, PyObject *ignore, PyObject *program, PyObject *dict,
                          swarf_deviation_options *options, deviation_borrowed *borrowed)
{
    memset(borrowed, 0, sizeof *borrowed);
    if (region != Py_None && camera_box(region, &options->region)) return -1;
    if (ignore != Py_None) {
        borrowed->ignore = PyBytes_FromObject(ignore);
        if (!borrowed->ignore) return -1;
        options->ignore = (const uint8_t *)PyBytes_AsString(borrowed->ignore);
        options->ignore_count = (size_t)PyBytes_Size(borrowed->ignore);
    }
    if ((program == Py_None) != (dict == Py_None) ||
        (program != Py_None && (!PyObject_TypeCheck(program, state->program) || !PyDict_Check(dict)))) {
        PyErr_SetString(PyExc_TypeError, "program and tools: a Program and a dict of Cutters are wanted, or neither");
        return -1;
    }
    if (program == Py_None) return 0;
    if (tools_read(state, dict, &borrowed->tools, &borrowed->tool_count)) return -1;
    borrowed->reader = (program_object *)program;
    borrowed->reader->readers++;
    borrowed->program = borrowed->reader->handle;
    return 0;
}

static void borrowed_end(deviation_borrowed *borrowed)
{
    if (borrowed->reader) borrowed->reader->readers--;
    Py_XDECREF(borrowed->ignore);
    tools_free(borrowed->tools, borrowed->tool_count);
}

/* Takes the handle over; NULL (an exception is set) stays NULL. */
static PyObject *deviation_wrap(module_state *state, swarf_deviation *handle)
{
    deviation_object *result = handle ? (deviation_object *)PyType_GenericAlloc(state->deviation, 0) : NULL;
    if (result)
        result->handle = handle;
    else
        swarf_deviation_destroy(handle);
    return (PyObject *)result;
}

/* What a Deviation is asked for with; objects are None where they are not given. */
typedef struct deviation_request {
    swarf_stock *stock; /* NULL: what `measured` measured is judged anew */
    const swarf_solid *design;
    const swarf_deviation *measured;
    swarf_deviation_options options;
    PyObject *region, *ignore, *program, *tools, *progress;
} deviation_request;

/* Measuring is nearly all of the work where moves are looked for too. */
static const double measuring_share = 0.9;

static int report_measuring(void *whole, double fraction)
{
    const swarf_progress *progress = whole;
    return progress->fn(progress->user, measuring_share * fraction);
}

static int report_finding(void *whole, double fraction)
{
    const swarf_progress *progress = whole;
    return progress->fn(progress->user, measuring_share + (1 - measuring_share) * fraction);
}

static PyObject *deviation_make(module_state *state, deviation_request *r)
{
    swarf_deviation *handle = NULL;
    deviation_borrowed borrowed;
    native_call call;
    if (!borrowed_begin(state, r->region, r->ignore, r->program, r->tools, &r->options, &borrowed) &&
        !call_begin(&call, r->progress)) {
        const swarf_progress parts[2] = {{report_measuring, &call.progress}, {report_finding, &call.progress}};
        const swarf_progress *first = borrowed.program ? &parts[0] : &call.progress;
        swarf_status status = r->stock ? swarf_deviation_create(r->stock, r->design, &r->options, first, &handle)
                                       : swarf_deviation_judge(r->measured, &r->options, first, &handle);
        if (!status && borrowed.program)
            status =
                swarf_deviation_find_moves(handle, borrowed.program, borrowed.tools, borrowed.tool_count, &parts[1]);
        if (call_end(&call, state, status)) {
            swarf_deviation_destroy(handle);
            handle = NULL;
        }
    }
    borrowed_end(&borrowed);
    return deviation_wrap(state, handle);
}

static PyObject *deviation_judge(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"excess", "gouge", "allowance", "region", "ignore", "program", "tools", "progress", NULL};
    deviation_request r = {.measured = deviation_of(self),
                           .options = swarf_deviation_options_default(),
                           .region = Py_None,
                           .ignore = Py_None,
                           .program = Py_None,
                           .tools = Py_None};
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "|$dddOOOOO:judge", names, &r.options.excess_mm,
                                     &r.options.gouge_mm, &r.options.allowance_mm, &r.region, &r.ignore, &r.program,
                                     &r.tools, &r.progress))
        return NULL;
    return deviation_make(state_of(self), &r);
}

static PyMethodDef deviation_methods[] = {
    {"judge", WITH_KEYWORDS(deviation_judge), METH_VARARGS | METH_KEYWORDS,
     "judge($self, *, excess=0.05, gouge=0.05, allowance=0.0, region=None, ignore=None, program=None, tools=None, "
     "progress=None)\n--\n\n"
     "The same measurement judged by other options, see measure_deviation(), without measuring again: fast -> "
     "Deviation.\nStock and design may be gone; `first` stays what it was."},
    {"histogram", WITH_KEYWORDS(deviation_histogram), METH_VARARGS | METH_KEYWORDS,
     "histogram($self, lo, hi, bins=64)\n--\n\n"
     "mm2 of the surface in equal steps of the deviation from lo to hi; what is beyond counts in the outer ones."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef deviation_getset[] = {
    {"passed", deviation_passed, NULL, "Whether no cluster is a gouge, or an excess that a move reached.", NULL},
    {"clusters", deviation_clusters, NULL, "Tuple of Cluster: those that fail first, the largest volume first.", NULL},
    {"comparison", deviation_comparison, NULL, "Volumes of stock, design, excess and gouge: Comparison.", NULL},
    {"points", deviation_points, NULL, "Read-only (n, 3) float32 view: measured points of the surface, mm.",
     (void *)(intptr_t)0},
    {"values", deviation_points, NULL, "Read-only float32 view: their deviations, mm, positive where material is left.",
     (void *)(intptr_t)1},
    {"kinds", deviation_points, NULL, "Read-only uint8 view: 1 near an edge, 2 untouched, 4 not to be measured.",
     (void *)(intptr_t)2},
    {"percentiles", deviation_percentiles, NULL,
     "Deviations (mm) that 1, 5, 25, 50, 75, 95 and 99 % of the area lie below.", NULL},
    {"area", deviation_number, NULL, "Measured surface, mm2.", SUM(area_mm2)},
    {"mean", deviation_number, NULL, "Mean deviation, mm.", SUM(mean_mm)},
    {"rms", deviation_number, NULL, "Root of the mean square, mm.", SUM(rms_mm)},
    {"least", deviation_number, NULL, "Least deviation, mm.", SUM(least_mm)},
    {"most", deviation_number, NULL, "Greatest deviation, mm.", SUM(most_mm)},
    {"excess_area", deviation_number, NULL, "Surface with too much left, mm2.", SUM(excess_mm2)},
    {"gouge_area", deviation_number, NULL, "Surface cut too deep, mm2.", SUM(gouge_mm2)},
    {"not_reached_area", deviation_number, NULL, "Surface with too much left where no move went, mm2.",
     SUM(not_reached_mm2)},
    {"error", deviation_number, NULL, "How far a value on a smooth face may be off, mm.", SUM(error_mm)},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot deviation_slots[] = {
    {Py_tp_doc, "The deviation of a stock from its design, see measure_deviation(). Immutable, any thread."},
    {Py_tp_dealloc, deviation_dealloc},
    {Py_tp_methods, deviation_methods},
    {Py_tp_getset, deviation_getset},
    {0, NULL},
};

PyType_Spec deviation_spec = {
    .name = "swarf.Deviation",
    .basicsize = sizeof(deviation_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = deviation_slots,
};

/* ---- functions ---- */

const char measure_deviation_doc[] =
    "measure_deviation(stock, design, *, excess=0.05, gouge=0.05, allowance=0.0, region=None, ignore=None, first=None, "
    "program=None, tools=None, progress=None)\n--\n\n"
    "Hold a stock against a design Solid -> Deviation. Tolerances `excess` and `gouge` in mm; `allowance` is meant to "
    "be\nleft; `region` is a box ((x, y, z), (x, y, z)) to stay in; `ignore` has one byte for each triangle of the "
    "design's\nmesh, not 0 where it is not to be measured; `first` is the Stock before the first cut, to tell where no "
    "move went;\n`program` and `tools` {number: Cutter} tell the moves behind each cluster. The stocks are unchanged.";

PyObject *measure_deviation(PyObject *module, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"stock",  "design", "excess",  "gouge", "allowance", "region",
                            "ignore", "first",  "program", "tools", "progress",  NULL};
    module_state *state = PyModule_GetState(module);
    PyObject *stock, *design, *first = Py_None;
    deviation_request r = {.options = swarf_deviation_options_default(),
                           .region = Py_None,
                           .ignore = Py_None,
                           .program = Py_None,
                           .tools = Py_None};
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!|$dddOOOOOO:measure_deviation", names, state->stock, &stock,
                                     state->solid, &design, &r.options.excess_mm, &r.options.gouge_mm,
                                     &r.options.allowance_mm, &r.region, &r.ignore, &first, &r.program, &r.tools,
                                     &r.progress))
        return NULL;
    if (first != Py_None && !PyObject_TypeCheck(first, state->stock))
        return PyErr_Format(PyExc_TypeError, "first: a Stock is wanted");
    if (first != Py_None) r.options.first = ((stock_object *)first)->handle;
    r.stock = ((stock_object *)stock)->handle;
    r.design = solid_of(design);
    return deviation_make(state, &r);
}

const char compare_place_doc[] = "compare_place(stock, design)\n--\n\n"
                                 "What makes it doubtful that a design Solid belongs to a stock -> (kind, value, "
                                 "factor, text): \"\" when\nall looks well, \"unit\" (value times as large, units "
                                 "that are factor apart), \"empty\", \"beside\", \"out\"\n(by value mm).";

PyObject *compare_place(PyObject *module, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"stock", "design", NULL};
    module_state *state = PyModule_GetState(module);
    PyObject *stock, *design;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!:compare_place", names, state->stock, &stock, state->solid,
                                     &design))
        return NULL;
    swarf_place place;
    native_call call;
    if (call_begin(&call, NULL)) return NULL;
    const swarf_status status = swarf_compare_place(((stock_object *)stock)->handle, solid_of(design), &place);
    if (call_end(&call, state, status)) return NULL;
    return Py_BuildValue("sdds", swarf_place_name((swarf_place_kind)place.kind), place.value, place.factor, place.text);
}

const char compare_overlap_doc[] =
    "compare_overlap(stock, solid, *, progress=None)\n--\n\n"
    "How deep (mm, 0.0: not at all) a Solid, a fixture, reaches into a stock -> (depth, (x, y, z)). No more than six "
    "voxels\nare told; less than 0.35 of one, as beside edges, is none.";

PyObject *compare_overlap(PyObject *module, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"stock", "solid", "progress", NULL};
    module_state *state = PyModule_GetState(module);
    PyObject *stock, *solid, *progress = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!|$O:compare_overlap", names, state->stock, &stock,
                                     state->solid, &solid, &progress))
        return NULL;
    double depth, point[3];
    native_call call;
    if (call_begin(&call, progress)) return NULL;
    const swarf_status status =
        swarf_compare_overlap(((stock_object *)stock)->handle, solid_of(solid), &call.progress, &depth, point);
    if (call_end(&call, state, status)) return NULL;
    return Py_BuildValue("d(ddd)", depth, point[0], point[1], point[2]);
}

const char picture_colour_doc[] = "picture_colour(number)\n--\n\n"
                                  "Linear RGB, 0 .. 1, of an operation (by its index) or a tool (by its number) in "
                                  "pictures that are coloured by them.";

PyObject *picture_colour(PyObject *Py_UNUSED(module), PyObject *args, PyObject *keywords)
{
    static char *names[] = {"number", NULL};
    int number;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "i:picture_colour", names, &number)) return NULL;
    float colour[3];
    swarf_picture_colour(number, colour);
    return Py_BuildValue("(ddd)", (double)colour[0], (double)colour[1], (double)colour[2]);
}

const char deviation_colours_doc[] =
    "deviation_colours(values, rgba, tolerance)\n--\n\n"
    "Tint shaded pixels (RGBA bytes) by their deviations, an (n, 1) table of mm -> bytes: green within the tolerance,\n"
    "by yellow to red where material is left, by cyan to blue where it is missing.";

PyObject *deviation_colours(PyObject *module, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"values", "rgba", "tolerance", NULL};
    PyObject *values_object, *rgba_object;
    double tolerance, *values;
    size_t count;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OOd:deviation_colours", names, &values_object, &rgba_object,
                                     &tolerance))
        return NULL;
    PyObject *bytes = PyBytes_FromObject(rgba_object), *result = NULL;
    if (!bytes) return NULL;
    if (!buffer_doubles(values_object, "values", 1, &values, &count)) {
        if ((size_t)PyBytes_Size(bytes) != 4 * count) {
            PyErr_Format(PyExc_ValueError, "rgba: %zd bytes for %zu values", PyBytes_Size(bytes), count);
        } else if ((result = PyBytes_FromStringAndSize(PyBytes_AsString(bytes), PyBytes_Size(bytes)))) {
            const swarf_status status =
                swarf_deviation_colours(values, count, tolerance, (uint8_t *)PyBytes_AsString(result));
            if (status) {
                Py_CLEAR(result);
                error_raise(PyModule_GetState(module), status);
            }
        }
        PyMem_Free(values);
    }
    Py_DECREF(bytes);
    return result;
}
