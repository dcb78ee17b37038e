/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What a swarf.Mesh measures, shells apart: swarf.Shell, swarf.Contour, sections. */
#include "native.h"

static const swarf_mesh *handle_of(PyObject *self)
{
    return ((mesh_object *)self)->handle;
}

static PyStructSequence_Field shell_fields[] = {
    {"triangles", "Number of triangles."},
    {"vertices", "Number of vertices."},
    {"edges", "Number of edges."},
    {"open_edges", "Edges of one triangle only."},
    {"euler", "Vertices - edges + triangles."},
    {"genus", "Holes through it; -1 when it is open."},
    {"volume_mm3", "Volume; negative: a cavity."},
    {"area_mm2", "Area."},
    {"centre", "Centre of mass, mm."},
    {"inertia", "Rows of the inertia tensor about the centre, mm5 at density 1."},
    {"moments", "Principal moments, the least first, mm5."},
    {"axes", "Their unit axes, right-handed."},
    {"bounding_box", "((x, y, z), (x, y, z)) in mm, None when empty."},
    {NULL, NULL},
};

PyStructSequence_Desc shell_desc = {
    .name = "swarf.Shell",
    .doc = "A piece of surface that hangs together by its edges, measured.",
    .fields = shell_fields,
    .n_in_sequence = 13,
};

static PyStructSequence_Field contour_fields[] = {
    {"full_triangles", "Triangles before vertices were left out."},
    {"triangles", "Triangles of the mesh."},
    {"sharp_vertices", "Vertices on edges and corners, before vertices were left out."},
    {"exact_vertices", "On the exact surface, before vertices were left out."},
    {"parted_cells", "Cells that the surface passes more than once."},
    {"intersections_found", "Pairs of triangles that cut each other and were put right."},
    {"intersections_left", "Pairs that still do."},
    {"error_mm", "Bound of the distance to the mesh of all vertices."},
    {"budget_met", "Whether there are no more triangles than were allowed."},
    {"unseen_mm3", "Material thinner than a voxel that the mesh has not, about."},
    {"surface_mm3", "Volume within the surface that the mesh stands for, without what its flat triangles leave out of "
                    "bulges and put into hollows; what fine adds by splitting edges is not in it."},
    {"split_edges", "Edges of triangles that left the surface and were split."},
    {NULL, NULL},
};

PyStructSequence_Desc contour_desc = {
    .name = "swarf.Contour",
    .doc = "What Mesh.from_stock() or Mesh.stream() came to.",
    .fields = contour_fields,
    .n_in_sequence = 12,
};

/** A struct sequence of `count` values, whose references it takes; NULL with an exception when one is NULL. */
static PyObject *sequence_of(PyTypeObject *type, PyObject *const *values, Py_ssize_t count)
{
    PyObject *result = PyStructSequence_New(type);
    int missing = !result;
    for (Py_ssize_t i = 0; i < count; i++) {
        if (values[i] && result)
            PyStructSequence_SetItem(result, i, values[i]);
        else
            Py_XDECREF(values[i]);
        missing |= !values[i];
    }
    if (missing) Py_CLEAR(result);
    return result;
}

static PyObject *triple(const double v[3])
{
    return Py_BuildValue("(ddd)", v[0], v[1], v[2]);
}

static PyObject *triples(const double m[3][3])
{
    return Py_BuildValue("(NNN)", triple(m[0]), triple(m[1]), triple(m[2]));
}

static PyObject *shell_to_python(module_state *state, const swarf_shell *s)
{
    PyObject *const values[] = {PyLong_FromSize_t(s->triangles),
                                PyLong_FromSize_t(s->vertices),
                                PyLong_FromSize_t(s->edges),
                                PyLong_FromSize_t(s->open_edges),
                                PyLong_FromLongLong(s->euler),
                                PyLong_FromLongLong(s->genus),
                                PyFloat_FromDouble(s->volume_mm3),
                                PyFloat_FromDouble(s->area_mm2),
                                triple(s->centre),
                                triples(s->inertia),
                                triple(s->moment),
                                triples(s->axis),
                                box_to_python(&s->box)};
    return sequence_of(state->shell, values, sizeof values / sizeof *values);
}

/** The measures of a mesh, NULL with an exception. */
static swarf_measures *measures_of(PyObject *self)
{
    native_call call;
    swarf_measures *measures = NULL;
    if (call_begin(&call, NULL)) return NULL;
    const swarf_status status = swarf_measures_create(handle_of(self), &measures);
    return call_end(&call, state_of(self), status) ? NULL : measures;
}

const char mesh_measure_doc[] = "measure($self, /)\n--\n\nAll shells as one Shell; cavities count against the solids.";

PyObject *mesh_measure(PyObject *self, PyObject *Py_UNUSED(none))
{
    swarf_measures *measures = measures_of(self);
    if (!measures) return NULL;
    const swarf_shell whole = swarf_measures_whole(measures);
    swarf_measures_destroy(measures);
    return shell_to_python(state_of(self), &whole);
}

const char mesh_shells_doc[] = "shells($self, /)\n--\n\nTuple of a Shell per piece that hangs together by its edges.";

PyObject *mesh_shells(PyObject *self, PyObject *Py_UNUSED(none))
{
    swarf_measures *measures = measures_of(self);
    if (!measures) return NULL;
    size_t count;
    const swarf_shell *shells = swarf_measures_shells(measures, &count);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        PyObject *shell = shell_to_python(state_of(self), &shells[i]);
        if (!shell || PyTuple_SetItem(result, (Py_ssize_t)i, shell)) Py_CLEAR(result);
    }
    swarf_measures_destroy(measures);
    return result;
}

const char mesh_keep_shells_doc[] =
    "keep_shells($self, shells, /)\n--\n\nA Mesh of these shells alone, by their places in shells().";

/** The place of a shell; one that is too large for it becomes UINT32_MAX. 1, or 0 with an exception. */
static int shell_place(PyObject *item, uint32_t *out)
{
    Py_ssize_t value = 0;
    if (!item || !count_read(item, &value)) return 0;
    if (value < 0) {
        PyErr_Format(PyExc_ValueError, "shells: %R is not the place of one", item);
        return 0;
    }
    *out = (size_t)value < UINT32_MAX ? (uint32_t)value : UINT32_MAX;
    return 1;
}

/** The places of shells in a sequence, freed with PyMem_Free(); NULL with an exception. */
static uint32_t *shell_places(PyObject *list, Py_ssize_t *count)
{
    *count = PySequence_Size(list);
    if (*count < 0) return NULL;
    uint32_t *places = PyMem_Malloc((size_t)*count * sizeof *places + 1);
    if (!places) PyErr_NoMemory();
    for (Py_ssize_t i = 0; places && i < *count; i++) {
        PyObject *item = PySequence_GetItem(list, i);
        const int is_read = shell_place(item, &places[i]);
        Py_XDECREF(item);
        if (is_read) continue;
        PyMem_Free(places);
        places = NULL;
    }
    return places;
}

PyObject *mesh_keep_shells(PyObject *self, PyObject *list)
{
    Py_ssize_t count;
    uint32_t *places = shell_places(list, &count);
    if (!places) return NULL;
    PyObject *result = NULL;
    native_call call;
    swarf_measures *measures = measures_of(self);
    if (measures && !call_begin(&call, NULL)) {
        swarf_mesh *handle = NULL;
        const swarf_status status = swarf_mesh_create_shells(handle_of(self), measures, places, (size_t)count, &handle);
        if (!call_end(&call, state_of(self), status)) result = mesh_wrap(Py_TYPE(self), handle);
    }
    swarf_measures_destroy(measures);
    PyMem_Free(places);
    return result;
}

const char mesh_split_shells_doc[] =
    "split_shells($self, groups, *, progress=None)\n--\n\n"
    "A tuple of a Mesh per group of shells, each group a sequence of their places in shells(); a shell is in one group "
    "at\n"
    "most. All are made in one pass: many take no longer than few.";

/** Tell each shell of a group its number. 0, or -1 with an exception. */
static int number_group(PyObject *list, uint32_t group, size_t shells, uint32_t *group_of)
{
    Py_ssize_t count;
    uint32_t *places = list ? shell_places(list, &count) : NULL;
    if (!places) return -1;
    int failed = 0;
    for (Py_ssize_t i = 0; i < count && !failed; i++) {
        failed = places[i] >= shells || group_of[places[i]] != UINT32_MAX;
        if (places[i] >= shells)
            PyErr_Format(PyExc_ValueError, "groups: shell %u of %zu", (unsigned)places[i], shells);
        else if (failed)
            PyErr_Format(PyExc_ValueError, "groups: shell %u is in two", (unsigned)places[i]);
        else
            group_of[places[i]] = group;
    }
    PyMem_Free(places);
    return failed ? -1 : 0;
}

/** The number of its group for every shell, freed with PyMem_Free(); NULL with an exception. */
static uint32_t *number_groups(PyObject *groups, Py_ssize_t count, size_t shells)
{
    uint32_t *group_of = PyMem_Malloc((shells + 1) * sizeof *group_of);
    if (!group_of) PyErr_NoMemory();
    for (size_t s = 0; group_of && s < shells; s++) group_of[s] = UINT32_MAX;
    for (Py_ssize_t g = 0; group_of && g < count; g++) {
        PyObject *group = PySequence_GetItem(groups, g);
        if (number_group(group, (uint32_t)g, shells, group_of)) {
            PyMem_Free(group_of);
            group_of = NULL;
        }
        Py_XDECREF(group);
    }
    return group_of;
}

/** A tuple of Meshes that takes over `count` handles, also on failure. */
static PyObject *mesh_tuple(PyTypeObject *type, swarf_mesh *const *handles, Py_ssize_t count)
{
    PyObject *result = PyTuple_New(count);
    for (Py_ssize_t i = 0; i < count; i++) {
        PyObject *mesh = mesh_wrap(type, handles[i]);
        if (!result)
            Py_XDECREF(mesh);
        else if (!mesh || PyTuple_SetItem(result, i, mesh))
            Py_CLEAR(result);
    }
    return result;
}

PyObject *mesh_split_shells(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"groups", "progress", NULL};
    PyObject *groups, *progress = NULL, *result = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O|$O:split_shells", names, &groups, &progress)) return NULL;
    const Py_ssize_t count = PySequence_Size(groups);
    swarf_measures *measures = count < 0 ? NULL : measures_of(self);
    if (!measures) return NULL;
    size_t shells;
    swarf_measures_shells(measures, &shells);
    swarf_mesh **made = PyMem_Malloc(((size_t)count + 1) * sizeof(swarf_mesh *));
    if (!made) PyErr_NoMemory();
    uint32_t *group_of = made ? number_groups(groups, count, shells) : NULL;
    native_call call;
    if (group_of && !call_begin(&call, progress)) {
        const swarf_status status =
            swarf_mesh_create_groups(handle_of(self), measures, group_of, (size_t)count, &call.progress, made);
        if (!call_end(&call, state_of(self), status)) result = mesh_tuple(Py_TYPE(self), made, count);
    }
    PyMem_Free(group_of);
    PyMem_Free(made);
    swarf_measures_destroy(measures);
    return result;
}

const char mesh_section_doc[] =
    "section($self, point, normal)\n--\n\n"
    "Where the plane through ``point`` cuts the mesh: a tuple of polylines, each a tuple of (x, y, z) in mm, material\n"
    "on the left seen against ``normal``. In a closed mesh each goes on from its last point to its first. Of a face "
    "that\n"
    "lies in the plane what is just below counts, or just above where nothing is below.";

PyObject *mesh_section(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"point", "normal", NULL};
    PyObject *point_object, *normal_object;
    double point[3], normal[3];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OO:section", names, &point_object, &normal_object)) return NULL;
    if (buffer_point(point_object, "point", point) || buffer_point(normal_object, "normal", normal)) return NULL;
    native_call call;
    swarf_outline *section = NULL;
    if (call_begin(&call, NULL)) return NULL;
    const swarf_status status = swarf_outline_create(handle_of(self), point, normal, &section);
    if (call_end(&call, state_of(self), status)) return NULL;
    const size_t count = swarf_outline_count(section);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        size_t points;
        const double *at = swarf_outline_polyline(section, i, &points);
        PyObject *line = PyTuple_New((Py_ssize_t)points);
        for (size_t k = 0; line && k < points; k++) {
            PyObject *p = triple(at + 3 * k);
            if (!p || PyTuple_SetItem(line, (Py_ssize_t)k, p)) Py_CLEAR(line);
        }
        if (!line || PyTuple_SetItem(result, (Py_ssize_t)i, line)) Py_CLEAR(result);
    }
    swarf_outline_destroy(section);
    return result;
}

PyObject *contour_tuple(module_state *state, const swarf_contour_report *r)
{
    PyObject *const values[] = {PyLong_FromSize_t(r->full_triangles),     PyLong_FromSize_t(r->triangles),
                                PyLong_FromSize_t(r->sharp_vertices),     PyLong_FromSize_t(r->exact_vertices),
                                PyLong_FromSize_t(r->parted_cells),       PyLong_FromSize_t(r->intersections_found),
                                PyLong_FromSize_t(r->intersections_left), PyFloat_FromDouble(r->error_mm),
                                PyBool_FromLong(r->budget_met),           PyFloat_FromDouble(r->unseen_mm3),
                                PyFloat_FromDouble(r->surface_mm3),       PyLong_FromSize_t(r->split_edges)};
    return sequence_of(state->contour, values, sizeof values / sizeof *values);
}

PyObject *mesh_contour(PyObject *self, void *Py_UNUSED(closure))
{
    const mesh_object *mesh = (const mesh_object *)self;
    if (!mesh->from_stock) Py_RETURN_NONE;
    return contour_tuple(state_of(self), &mesh->contour);
}

const char mesh_split_doc[] = "split($self, point, normal)\n--\n\n"
                              "The closed mesh cut by the plane through ``point``: (what lies against ``normal``, what "
                              "lies along it), two closed "
                              "Meshes\n"
                              "with caps, empty where there is nothing. GeometryError: the mesh is open.";

PyObject *mesh_split(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"point", "normal", NULL};
    PyObject *point_object, *normal_object;
    double point[3], normal[3];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OO:split", names, &point_object, &normal_object)) return NULL;
    if (buffer_point(point_object, "point", point) || buffer_point(normal_object, "normal", normal)) return NULL;
    native_call call;
    swarf_mesh *below = NULL, *above = NULL;
    if (call_begin(&call, NULL)) return NULL;
    const swarf_status status = swarf_mesh_split(handle_of(self), point, normal, &below, &above);
    if (call_end(&call, state_of(self), status)) return NULL;
    PyObject *first = mesh_wrap(Py_TYPE(self), below), *second = mesh_wrap(Py_TYPE(self), above);
    PyObject *result = first && second ? PyTuple_Pack(2, first, second) : NULL;
    Py_XDECREF(first);
    Py_XDECREF(second);
    return result;
}

const char mesh_thickness_doc[] =
    "thickness($self, *, progress=None)\n--\n\n"
    "Thickness of the wall behind each triangle, mm: a read-only float32 view, the least of four rays straight into "
    "the\n"
    "material, from the triangle's middle and near its corners, to a face within 60 degrees of opposite; inf where "
    "there\n"
    "is none. GeometryError: longer or farther away than 1e6 mm.";

PyObject *mesh_thickness(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"progress", NULL};
    PyObject *progress = NULL, *result = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "|$O:thickness", names, &progress)) return NULL;
    const size_t rows = swarf_mesh_triangles(handle_of(self)).triangle_count;
    PyObject *values = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(rows * sizeof(float)));
    native_call call;
    if (values && !call_begin(&call, progress)) {
        float *out = (float *)(void *)PyBytes_AsString(values);
        const swarf_status status = swarf_mesh_thickness(handle_of(self), &call.progress, out);
        if (!call_end(&call, state_of(self), status))
            result = buffer_view(state_of(self), values, out, "f", sizeof(float), rows, 0, NULL);
    }
    Py_XDECREF(values);
    return result;
}
