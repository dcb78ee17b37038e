/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Scene: what is shown of a stock, and what is at a place of its pictures. */
#include "native.h"

static const char *const seen_names[] = {"nothing", "stock", "section", "flutes", "shank", "holder", "fixture"};
_Static_assert(sizeof seen_names / sizeof seen_names[0] == SWARF_SEEN_COUNT, "one name per thing");
static const char *const colouring_names[] = {"material", "operation", "tool", "age", "feed", "deviation"};
_Static_assert(sizeof colouring_names / sizeof colouring_names[0] == SWARF_COLOURING_COUNT, "one name per colouring");

typedef struct scene_object {
    PyObject_HEAD swarf_scene *handle;
    PyObject *stock;
    swarf_surface *surface;  /* NULL: none */
    program_object *program; /* of the surface: closed while that lives */
    PyObject *shown;         /* the Surface that it is of; NULL: of none */
} scene_object;

static PyObject *scene_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"stock", NULL};
    module_state *state = state_of_type(type);
    PyObject *stock;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!:Scene", names, state->stock, &stock)) return NULL;
    scene_object *self = (scene_object *)PyType_GenericAlloc(type, 0);
    native_call call;
    if (!self) return NULL;
    self->stock = Py_NewRef(stock);
    call_begin(&call, NULL);
    const swarf_status status = swarf_scene_create(((stock_object *)stock)->handle, &self->handle);
    if (call_end(&call, state, status) == 0) return (PyObject *)self;
    Py_DECREF(self);
    return NULL;
}

/** Let go of the surface and open its program. */
static void drop_surface(scene_object *scene)
{
    swarf_surface_release(scene->surface);
    if (scene->program) scene->program->exports--;
    Py_XDECREF((PyObject *)scene->program);
    Py_CLEAR(scene->shown);
    scene->surface = NULL;
    scene->program = NULL;
}

static void scene_dealloc(PyObject *self)
{
    swarf_scene_destroy(((scene_object *)self)->handle);
    drop_surface((scene_object *)self);
    Py_XDECREF(((scene_object *)self)->stock);
    object_free(self);
}

static PyObject *scene_update(PyObject *self, PyObject *Py_UNUSED(none))
{
    native_call call;
    call_begin(&call, NULL);
    const swarf_status status = swarf_scene_update(((scene_object *)self)->handle);
    if (call_end(&call, state_of(self), status)) return NULL;
    Py_RETURN_NONE;
}

static PyObject *scene_set_fixtures(PyObject *self, PyObject *meshes)
{
    module_state *state = state_of(self);
    PyObject *list = PySequence_Tuple(meshes), *result = NULL;
    if (!list) return NULL;
    const Py_ssize_t count = PyTuple_Size(list);
    swarf_triangles *triangles = PyMem_Malloc((size_t)(count + 1) * sizeof *triangles);
    int failed = !triangles;
    if (failed) PyErr_NoMemory();
    for (Py_ssize_t i = 0; i < count && !failed; i++) {
        PyObject *mesh = PyTuple_GetItem(list, i);
        failed = !PyObject_TypeCheck(mesh, state->mesh);
        if (failed) PyErr_Format(PyExc_TypeError, "fixtures[%zd]: needs a Mesh", i);
        if (!failed) triangles[i] = swarf_mesh_triangles(((mesh_object *)mesh)->handle);
    }
    native_call call;
    if (!failed && !call_begin(&call, NULL)) {
        const swarf_status status = swarf_scene_set_fixtures(((scene_object *)self)->handle, triangles, (size_t)count);
        if (call_end(&call, state, status) == 0) result = Py_NewRef(Py_None);
    }
    PyMem_Free(triangles);
    Py_DECREF(list);
    return result;
}

static PyObject *scene_set_surface(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"first", "program", "tools", "moves", "progress", NULL};
    module_state *state = state_of(self);
    scene_object *scene = (scene_object *)self;
    PyObject *first, *program = NULL, *dict = NULL, *moves_object = Py_None, *progress = NULL;
    size_t from, moves, tool_count;
    swarf_surface *surface = NULL;
    swarf_tool *tools;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!O!|O$O:set_surface", names, state->stock, &first,
                                     state->program, &program, &PyDict_Type, &dict, &moves_object, &progress) ||
        program_range((program_object *)program, 0, moves_object, &from, &moves) ||
        tools_read(state, dict, &tools, &tool_count))
        return NULL;
    program_object *held = (program_object *)Py_NewRef(program);
    held->exports++;
    native_call call;
    int failed = call_begin(&call, progress);
    if (!failed) {
        swarf_status status = swarf_surface_create(((stock_object *)first)->handle, held->handle, tools, tool_count,
                                                   &call.progress, &surface);
        if (!status) status = swarf_scene_set_surface(scene->handle, surface, moves, 0);
        failed = call_end(&call, state, status);
    }
    tools_free(tools, tool_count);
    if (failed) {
        swarf_surface_release(surface);
        held->exports--;
        Py_DECREF((PyObject *)held);
        return NULL;
    }
    drop_surface(scene);
    scene->surface = surface;
    scene->program = held;
    Py_RETURN_NONE;
}

static PyObject *scene_show_surface(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"surface", "moves", NULL};
    module_state *state = state_of(self);
    scene_object *scene = (scene_object *)self;
    PyObject *object, *moves_object = Py_None;
    size_t from, moves;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!|O:show_surface", names, state->surface, &object,
                                     &moves_object))
        return NULL;
    const surface_object *surface = (surface_object *)object;
    if (program_range(surface->program, 0, moves_object, &from, &moves)) return NULL;
    native_call call;
    call_begin(&call, NULL);
    const swarf_status status = swarf_scene_set_surface(scene->handle, surface->handle, moves, 0);
    if (call_end(&call, state, status)) return NULL;
    Py_INCREF(object);
    drop_surface(scene);
    scene->surface = swarf_surface_retain(surface->handle);
    scene->program = (program_object *)Py_NewRef((PyObject *)surface->program);
    scene->program->exports++;
    scene->shown = object; /* keeps the programs of set-ups before as they are */
    Py_RETURN_NONE;
}

static PyObject *scene_set_moves(PyObject *self, PyObject *args)
{
    scene_object *scene = (scene_object *)self;
    PyObject *count;
    double fraction = 0;
    size_t from, moves;
    if (!PyArg_ParseTuple(args, "O|d:set_moves", &count, &fraction)) return NULL;
    if (!scene->surface) {
        PyErr_SetString(PyExc_ValueError, "set_moves: the scene has no surface; call set_surface() first");
        return NULL;
    }
    if (program_range(scene->program, 0, count, &from, &moves)) return NULL;
    const swarf_status status = swarf_scene_set_surface(scene->handle, scene->surface, moves, fraction);
    if (status) return error_raise(state_of(self), status);
    Py_RETURN_NONE;
}

static int check_size(int width, int height)
{
    /* Before pixels are allocated; libswarf checks again what it is given. */
    if (width >= 1 && width <= 16384 && height >= 1 && height <= 16384) return 0;
    PyErr_Format(PyExc_ValueError, "width, height: %d x %d is not in 1 .. 16384", width, height);
    return -1;
}

static int read_colour(PyObject *object, const char *name, int count, float *out)
{
    if (!object || object == Py_None) return 0;
    PyObject *items = PySequence_Check(object) && !PyUnicode_Check(object) ? PySequence_Tuple(object) : NULL;
    if (!items || PyTuple_Size(items) != count) {
        if (!PyErr_Occurred()) PyErr_Format(PyExc_ValueError, "%s: needs %d numbers 0 .. 1", name, count);
        Py_XDECREF(items);
        return -1;
    }
    for (int i = 0; i < count && !PyErr_Occurred(); i++) out[i] = (float)PyFloat_AsDouble(PyTuple_GetItem(items, i));
    Py_DECREF(items);
    return PyErr_Occurred() ? -1 : 0;
}

/* Most planes that libswarf takes. */
enum { SECTIONS_MAX = 6 };

/** What a picture shows, from the keywords that render() and pick() share, and what it borrows of them. */
typedef struct view {
    swarf_picture_options options;
    swarf_camera camera;
    swarf_cut_plane section[SECTIONS_MAX];
    swarf_box outline;
    program_object *program; /* read while the call runs */
    PyObject *values;        /* of the deviation: an exported buffer, NULL without */
    Py_buffer buffer;
} view;

static void view_release(view *v)
{
    if (v->program) v->program->readers--;
    if (v->values) PyBuffer_Release(&v->buffer);
    v->program = NULL;
    v->values = NULL;
}

static int view_sections(PyObject *object, view *v)
{
    PyObject *list = PySequence_Tuple(object);
    if (!list) return -1;
    const Py_ssize_t count = PyTuple_Size(list);
    int failed = count > SECTIONS_MAX;
    if (failed) PyErr_Format(PyExc_ValueError, "sections: %zd planes, more than %d", count, SECTIONS_MAX);
    for (Py_ssize_t i = 0; i < count && !failed; i++) {
        PyObject *pair = PySequence_Tuple(PyTuple_GetItem(list, i));
        failed = !pair || PyTuple_Size(pair) != 2;
        if (failed && !PyErr_Occurred()) PyErr_Format(PyExc_ValueError, "sections[%zd]: needs (point, normal)", i);
        if (!failed)
            failed = buffer_point(PyTuple_GetItem(pair, 0), "sections: point", v->section[i].point) ||
                     buffer_point(PyTuple_GetItem(pair, 1), "sections: normal", v->section[i].normal);
        Py_XDECREF(pair);
    }
    Py_DECREF(list);
    v->options.section = v->section;
    v->options.section_count = (size_t)count;
    return failed ? -1 : 0;
}

static int view_cutter(module_state *state, PyObject *object, view *v)
{
    PyObject *pair = PySequence_Tuple(object);
    int failed = !pair || PyTuple_Size(pair) != 2 || !PyObject_TypeCheck(PyTuple_GetItem(pair, 0), state->cutter);
    if (failed && !PyErr_Occurred()) PyErr_SetString(PyExc_TypeError, "cutter: needs (Cutter, point of its tip)");
    if (!failed) {
        v->options.cutter = ((cutter_object *)PyTuple_GetItem(pair, 0))->handle; /* the caller's tuple keeps it */
        failed = buffer_point(PyTuple_GetItem(pair, 1), "cutter: tip", v->options.cutter_tip);
    }
    Py_XDECREF(pair);
    return failed ? -1 : 0;
}

static int view_values(PyObject *object, view *v)
{
    if (PyObject_GetBuffer(object, &v->buffer, PyBUF_C_CONTIGUOUS | PyBUF_FORMAT)) return -1;
    v->values = object;
    const Py_ssize_t wanted = (Py_ssize_t)v->options.width * v->options.height * 4;
    if (v->buffer.len != wanted || v->buffer.itemsize != 4 || !v->buffer.format || strcmp(v->buffer.format, "f") != 0) {
        PyErr_Format(PyExc_ValueError, "values: needs width * height numbers of format 'f'");
        return -1;
    }
    v->options.values = v->buffer.buf;
    return 0;
}

static int view_selected(PyObject *pair, swarf_picture_options *options)
{
    Py_ssize_t first, end;
    if (!PyTuple_Check(pair) || !PyArg_ParseTuple(pair, "nn", &first, &end) || first < 0 || end < first) {
        PyErr_Clear();
        PyErr_SetString(PyExc_ValueError, "selected: needs (first, end) with 0 <= first <= end");
        return -1;
    }
    options->selected_first = (size_t)first;
    options->selected_count = (size_t)(end - first);
    return 0;
}

/* The objects among the keywords; NULL or None where not given. */
typedef struct view_objects {
    PyObject *camera, *colour, *background, *background_top, *values, *sections, *cutter, *program, *selected, *outline;
} view_objects;

static int given(PyObject *object)
{
    return object && object != Py_None;
}

/** Fill the view; on failure nothing is held. */
static int view_read(module_state *state, const view_objects *o, const char *colouring, view *v)
{
    v->camera = ((camera_object *)o->camera)->camera;
    v->options.colouring = choice_find("colouring", colouring, colouring_names, SWARF_COLOURING_COUNT);
    int failed = v->options.colouring < 0 || check_size(v->options.width, v->options.height) ||
                 read_colour(o->colour, "colour", 3, v->options.colour) ||
                 read_colour(o->background, "background", 4, v->options.background) ||
                 read_colour(o->background_top, "background_top", 4, v->options.background_top) ||
                 (given(o->sections) && view_sections(o->sections, v)) ||
                 (given(o->cutter) && view_cutter(state, o->cutter, v)) ||
                 (given(o->outline) && camera_box(o->outline, &v->outline)) ||
                 (given(o->selected) && view_selected(o->selected, &v->options)) ||
                 (given(o->values) && view_values(o->values, v));
    if (!failed && given(o->outline)) v->options.outline = &v->outline;
    if (!failed && given(o->program)) {
        failed = !PyObject_TypeCheck(o->program, state->program);
        if (failed) PyErr_SetString(PyExc_TypeError, "program: needs a Program");
        if (!failed) {
            v->program = (program_object *)o->program;
            v->program->readers++;
            v->options.program = v->program->handle;
        }
    }
    if (failed) view_release(v);
    return failed ? -1 : 0;
}

static PyObject *scene_render(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"camera",     "width",          "height",     "samples",   "coarse",      "budget_ms",
                            "buffers",    "exact",          "edges",      "occlusion", "shadow",      "colour",
                            "background", "background_top", "colouring",  "values",    "value_range", "sections",
                            "cutter",     "program",        "moves_done", "path",      "selected",    "outline",
                            "axes",       "progress",       NULL};
    module_state *state = state_of(self);
    PyObject *buffers = NULL, *progress = NULL;
    const char *colouring = colouring_names[0];
    view_objects objects = {0};
    view v = {.options = swarf_picture_options_default()};
    swarf_picture_options *o = &v.options;
    if (!PyArg_ParseTupleAndKeywords(
            args, keywords, "O!|ii$iidOppppOOOsOdOOOdpOOdO:render", names, state->camera, &objects.camera, &o->width,
            &o->height, &o->samples, &o->coarse, &o->budget_ms, &buffers, &o->exact, &o->edges, &o->occlusion,
            &o->shadow, &objects.colour, &objects.background, &objects.background_top, &colouring, &objects.values,
            &o->value_range, &objects.sections, &objects.cutter, &objects.program, &o->moves_done, &o->path,
            &objects.selected, &objects.outline, &o->axes_mm, &progress) ||
        view_read(state, &objects, colouring, &v))
        return NULL;
    PyObject *names_of = given(buffers) ? Py_NewRef(buffers) : Py_BuildValue("(s)", "rgba");
    swarf_picture_buffers out;
    PyObject *picture = names_of ? picture_create(state, o, names_of, &out) : NULL;
    Py_XDECREF(names_of);
    native_call call;
    int failed = !picture || call_begin(&call, progress);
    if (!failed) {
        const swarf_status status =
            swarf_scene_render(((scene_object *)self)->handle, &v.camera, o, &call.progress, &out);
        failed = call_end(&call, state, status);
    }
    view_release(&v);
    if (!failed) return picture;
    Py_XDECREF(picture);
    return NULL;
}

PyStructSequence_Desc pick_desc = {
    .name = "swarf.Pick",
    .doc = "What is seen at a place of a picture.",
    .fields =
        (PyStructSequence_Field[]){
            {"seen", "what it is: \"stock\" ..."},
            {"point", "(x, y, z), mm"},
            {"normal", "(x, y, z), unit"},
            {"move", "the move that made the surface; -1: the stock as it was, or not known"},
            {"depth", "mm along the view from the eye"},
            {NULL, NULL},
        },
    .n_in_sequence = 5,
};

static PyObject *scene_pick(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"camera", "x", "y", "width", "height", "sections", "cutter", NULL};
    module_state *state = state_of(self);
    double x, y;
    view_objects objects = {0};
    view v = {.options = swarf_picture_options_default()};
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!dd|ii$OO:pick", names, state->camera, &objects.camera, &x, &y,
                                     &v.options.width, &v.options.height, &objects.sections, &objects.cutter) ||
        view_read(state, &objects, colouring_names[0], &v))
        return NULL;
    swarf_pick pick;
    native_call call;
    call_begin(&call, NULL);
    const swarf_status status = swarf_scene_pick(((scene_object *)self)->handle, &v.camera, &v.options, x, y, &pick);
    const int failed = call_end(&call, state, status);
    view_release(&v);
    if (failed) return NULL;
    if (pick.seen == SWARF_SEEN_NOTHING) Py_RETURN_NONE;
    PyObject *result = PyStructSequence_New(state->pick);
    if (!result) return NULL;
    PyStructSequence_SetItem(result, 0, PyUnicode_FromString(seen_names[pick.seen]));
    PyStructSequence_SetItem(result, 1, Py_BuildValue("(ddd)", pick.point[0], pick.point[1], pick.point[2]));
    PyStructSequence_SetItem(result, 2, Py_BuildValue("(ddd)", pick.normal[0], pick.normal[1], pick.normal[2]));
    PyStructSequence_SetItem(result, 3, PyLong_FromLong(pick.move));
    PyStructSequence_SetItem(result, 4, PyFloat_FromDouble(pick.depth));
    if (!PyErr_Occurred()) return result;
    Py_DECREF(result);
    return NULL;
}

static PyMethodDef scene_methods[] = {
    {"update", scene_update, METH_NOARGS,
     "update($self, /)\n--\n\nTake over what changed in the stock. Without it the next picture does."},
    {"set_surface", WITH_KEYWORDS(scene_set_surface), METH_VARARGS | METH_KEYWORDS,
     "set_surface($self, first, program, tools, moves=None, *, progress=None)\n--\n\n"
     "Show the exact surface that the first moves (None: all) of a program make of the stock `first`, which the\n"
     "scene's stock must have seen: sharp edges, true normals, and the moves that made them."},
    {"show_surface", WITH_KEYWORDS(scene_show_surface), METH_VARARGS | METH_KEYWORDS,
     "show_surface($self, surface, moves=None)\n--\n\n"
     "Show a Surface after the first moves (None: all) of its program, as set_surface() does."},
    {"set_moves", scene_set_moves, METH_VARARGS,
     "set_moves($self, count, fraction=0.0, /)\n--\n\n"
     "How many moves of the surface stand now, and what part, 0 .. 1, of the next one's path; None: all."},
    {"set_fixtures", scene_set_fixtures, METH_O,
     "set_fixtures($self, meshes, /)\n--\n\nShow these Mesh objects beside the stock, in place of those before."},
    {"render", WITH_KEYWORDS(scene_render), METH_VARARGS | METH_KEYWORDS,
     "render($self, camera, width=1280, height=960, *, samples=3, coarse=1, budget_ms=0.0, buffers=None, "
     "exact=True, edges=True, occlusion=True, shadow=False, colour=None, background=None, background_top=None, "
     "colouring='material', values=None, value_range=0.1, sections=None, cutter=None, program=None, moves_done=0.0, "
     "path=False, selected=None, outline=None, axes=0.0, progress=None)\n--\n\n"
     "A Picture. At edges samples x samples rays per pixel (1 .. 4); one ray for coarse x coarse pixels (1 .. 16), as\n"
     "many as it takes to be done in about budget_ms when that is given. buffers: what is wanted of rgba (None),\n"
     "depth, normal, position, move and seen. exact: the surface of set_surface(), at rest; edges: dark lines; "
     "occlusion: dark corners; shadow: of the light.\n"
     "Colours are linear, 0 .. 1: RGB of the material, RGBA of the background. colouring: material, operation, tool,\n"
     "age or feed of the program's moves, or deviation from `values`, width * height float32 in mm, +-value_range.\n"
     "sections: up to 6 (point, normal); what lies where a normal points to is taken away. cutter: (Cutter, tip).\n"
     "program, moves_done: what is played, and how far; path: show it. surfaces and path of the moves selected=(first, "
     "end)\n"
     "stand out. outline: a box; axes: mm of x, y, z."},
    {"pick", WITH_KEYWORDS(scene_pick), METH_VARARGS | METH_KEYWORDS,
     "pick($self, camera, x, y, width=1280, height=960, *, sections=None, cutter=None)\n--\n\n"
     "The Pick at a place of the picture (x to the right and y upwards, -1 .. 1), or None where nothing is."},
    {NULL, NULL, 0, NULL},
};

static PyType_Slot scene_slots[] = {
    {Py_tp_doc,
     "Scene(stock)\n--\n\n"
     "What is shown of a Stock; it follows the stock's changes. BusyError while another call is in the stock."},
    {Py_tp_new, scene_new},
    {Py_tp_dealloc, scene_dealloc},
    {Py_tp_methods, scene_methods},
    {0, NULL},
};

PyType_Spec scene_spec = {
    .name = "swarf.Scene",
    .basicsize = sizeof(scene_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = scene_slots,
};
