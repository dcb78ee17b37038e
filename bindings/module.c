/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The module swarf._native: types, exceptions, and what concerns the whole process. */
#include "native.h"

module_state *state_of_type(PyTypeObject *type)
{
    return PyType_GetModuleState(type);
}

module_state *state_of(PyObject *self)
{
    return PyType_GetModuleState(Py_TYPE(self));
}

void object_free(PyObject *self)
{
    PyTypeObject *type = Py_TYPE(self);
    PyObject_Free(self);
    Py_DECREF(type);
}

int choice_find(const char *what, const char *text, const char *const *names, int count)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(text, names[i])) return i;
    char list[256] = "";
    for (int i = 0; i < count; i++) {
        const size_t used = strlen(list);
        PyOS_snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", names[i]);
    }
    PyErr_Format(PyExc_ValueError, "%s: '%s' is none of %s", what, text, list);
    return -1;
}

static PyObject *module_version(PyObject *Py_UNUSED(module), PyObject *Py_UNUSED(none))
{
    return PyUnicode_FromString(swarf_version());
}

static PyObject *module_threads(PyObject *Py_UNUSED(module), PyObject *Py_UNUSED(none))
{
    return PyLong_FromLong(swarf_threads());
}

static PyObject *module_set_threads(PyObject *module, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"count", NULL};
    int count;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "i:set_threads", names, &count)) return NULL;
    const swarf_status status = swarf_threads_set(count);
    if (status) return error_raise(PyModule_GetState(module), status);
    Py_RETURN_NONE;
}

static PyObject *module_set_progress_interval(PyObject *module, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"milliseconds", NULL};
    int milliseconds;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "i:set_progress_interval", names, &milliseconds)) return NULL;
    const swarf_status status = swarf_progress_interval_set(milliseconds);
    if (status) return error_raise(PyModule_GetState(module), status);
    Py_RETURN_NONE;
}

static PyObject *module_isa(PyObject *Py_UNUSED(module), PyObject *Py_UNUSED(none))
{
    return PyUnicode_FromString(swarf_isa_name(swarf_isa_current()));
}

static PyObject *module_memory_peak(PyObject *Py_UNUSED(module), PyObject *Py_UNUSED(none))
{
    return PyLong_FromSize_t(swarf_memory_peak());
}

static PyMethodDef module_methods[] = {
    {"version", module_version, METH_NOARGS, "version()\n--\n\nVersion of libswarf, e.g. \"0.1.0\"."},
    {"threads", module_threads, METH_NOARGS, "threads()\n--\n\nNumber of threads the library uses."},
    {"set_threads", WITH_KEYWORDS(module_set_threads), METH_VARARGS | METH_KEYWORDS,
     "set_threads(count)\n--\n\n"
     "Set how many threads the library may use in this process, 1 .. 1024; 0: one per core.\n"
     "Results never depend on it."},
    {"set_progress_interval", WITH_KEYWORDS(module_set_progress_interval), METH_VARARGS | METH_KEYWORDS,
     "set_progress_interval(milliseconds)\n--\n\n"
     "Set how many milliseconds at least pass between two reports of one loop in this process, 25 at first.\n"
     "With 0 each piece of work done by the calling thread is reported: with one thread the same on any machine."},
    {"isa", module_isa, METH_NOARGS, "isa()\n--\n\nInstruction set in use: \"scalar\", \"avx2\" or \"avx512\"."},
    {"memory_peak", module_memory_peak, METH_NOARGS,
     "memory_peak()\n--\n\nPeak resident memory of this process in bytes, 0 where the system does not tell."},
    {"compare_volume", WITH_KEYWORDS(compare_volume), METH_VARARGS | METH_KEYWORDS, compare_volume_doc},
    {"measure_deviation", WITH_KEYWORDS(measure_deviation), METH_VARARGS | METH_KEYWORDS, measure_deviation_doc},
    {"compare_overlap", WITH_KEYWORDS(compare_overlap), METH_VARARGS | METH_KEYWORDS, compare_overlap_doc},
    {"compare_place", WITH_KEYWORDS(compare_place), METH_VARARGS | METH_KEYWORDS, compare_place_doc},
    {"picture_colour", WITH_KEYWORDS(picture_colour), METH_VARARGS | METH_KEYWORDS, picture_colour_doc},
    {"deviation_colours", WITH_KEYWORDS(deviation_colours), METH_VARARGS | METH_KEYWORDS, deviation_colours_doc},
    {NULL, NULL, 0, NULL},
};

/** A heap type of ours, kept in the state and added to the module unless `hidden`. */
static int add_type(PyObject *module, PyType_Spec *spec, PyTypeObject **out, int hidden)
{
    *out = (PyTypeObject *)PyType_FromModuleAndSpec(module, spec, NULL);
    if (!*out) return -1;
    return hidden ? 0 : PyModule_AddType(module, *out);
}

static int add_sequence(PyObject *module, PyStructSequence_Desc *desc, PyTypeObject **out)
{
    *out = PyStructSequence_NewType(desc);
    return *out ? PyModule_AddType(module, *out) : -1;
}

static int module_exec(PyObject *module)
{
    module_state *state = PyModule_GetState(module);
    return error_setup(module, state) || add_type(module, &buffer_view_spec, &state->view, 1) ||
                   add_type(module, &cutter_spec, &state->cutter, 0) ||
                   add_type(module, &program_spec, &state->program, 0) ||
                   add_type(module, &stock_spec, &state->stock, 0) ||
                   add_type(module, &simulation_spec, &state->simulation, 0) ||
                   add_type(module, &mesh_spec, &state->mesh, 0) || add_type(module, &camera_spec, &state->camera, 0) ||
                   add_type(module, &scene_spec, &state->scene, 0) ||
                   add_type(module, &picture_spec, &state->picture, 0) ||
                   add_type(module, &surface_spec, &state->surface, 0) ||
                   add_sequence(module, &pick_desc, &state->pick) || add_sequence(module, &lump_desc, &state->lump) ||
                   add_sequence(module, &finding_desc, &state->finding) ||
                   add_sequence(module, &comparison_desc, &state->comparison) ||
                   add_sequence(module, &cluster_desc, &state->cluster) ||
                   add_sequence(module, &check_finding_desc, &state->check_finding) ||
                   add_type(module, &check_spec, &state->check, 0) || add_type(module, &solid_spec, &state->solid, 0) ||
                   add_type(module, &deviation_spec, &state->deviation, 0) ||
                   add_sequence(module, &shell_desc, &state->shell) ||
                   add_sequence(module, &contour_desc, &state->contour) ||
                   add_type(module, &history_spec, &state->history, 0) || add_sequence(module, &held_desc, &state->held)
               ? -1
               : 0;
}

static int module_traverse(PyObject *module, visitproc visit, void *arg)
{
    module_state *state = PyModule_GetState(module);
    Py_VISIT(state->cutter);
    Py_VISIT(state->program);
    Py_VISIT(state->stock);
    Py_VISIT(state->simulation);
    Py_VISIT(state->mesh);
    Py_VISIT(state->camera);
    Py_VISIT(state->scene);
    Py_VISIT(state->surface);
    Py_VISIT(state->picture);
    Py_VISIT(state->pick);
    Py_VISIT(state->lump);
    Py_VISIT(state->view);
    Py_VISIT(state->finding);
    Py_VISIT(state->comparison);
    Py_VISIT(state->cluster);
    Py_VISIT(state->check);
    Py_VISIT(state->check_finding);
    Py_VISIT(state->solid);
    Py_VISIT(state->deviation);
    Py_VISIT(state->shell);
    Py_VISIT(state->contour);
    Py_VISIT(state->history);
    Py_VISIT(state->held);
    Py_VISIT(state->error);
    Py_VISIT(state->format_error);
    Py_VISIT(state->geometry_error);
    Py_VISIT(state->cancelled);
    Py_VISIT(state->busy_error);
    return 0;
}

static int module_clear(PyObject *module)
{
    module_state *state = PyModule_GetState(module);
    Py_CLEAR(state->cutter);
    Py_CLEAR(state->program);
    Py_CLEAR(state->stock);
    Py_CLEAR(state->simulation);
    Py_CLEAR(state->mesh);
    Py_CLEAR(state->camera);
    Py_CLEAR(state->scene);
    Py_CLEAR(state->surface);
    Py_CLEAR(state->picture);
    Py_CLEAR(state->pick);
    Py_CLEAR(state->lump);
    Py_CLEAR(state->view);
    Py_CLEAR(state->finding);
    Py_CLEAR(state->comparison);
    Py_CLEAR(state->cluster);
    Py_CLEAR(state->check);
    Py_CLEAR(state->check_finding);
    Py_CLEAR(state->solid);
    Py_CLEAR(state->deviation);
    Py_CLEAR(state->shell);
    Py_CLEAR(state->contour);
    Py_CLEAR(state->history);
    Py_CLEAR(state->held);
    Py_CLEAR(state->error);
    Py_CLEAR(state->format_error);
    Py_CLEAR(state->geometry_error);
    Py_CLEAR(state->cancelled);
    Py_CLEAR(state->busy_error);
    return 0;
}

static void module_free(void *module)
{
    module_clear(module);
}

static PyModuleDef_Slot module_slots[] = {
    {Py_mod_exec, module_exec},
    {0, NULL},
};

static struct PyModuleDef module_def = {
    PyModuleDef_HEAD_INIT,
    .m_name = "swarf._native",
    .m_doc = "Milling simulation: the face of libswarf. Lengths in mm. Import the package swarf instead.",
    .m_size = sizeof(module_state),
    .m_methods = module_methods,
    .m_slots = module_slots,
    .m_traverse = module_traverse,
    .m_clear = module_clear,
    .m_free = module_free,
};

PyMODINIT_FUNC PyInit__native(void);

PyMODINIT_FUNC PyInit__native(void)
{
    return PyModuleDef_Init(&module_def);
}
