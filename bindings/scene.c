/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Scene: what is shown of a stock, its pictures, and what is at a place of them. */
#include "native.h"

static const char *const seen_names[] = {"nothing", "stock"};
enum { SEEN_COUNT = sizeof seen_names / sizeof seen_names[0] };
static const char *const buffer_names[] = {"rgba", "depth", "normal", "position", "move", "seen"};
enum { RGBA, DEPTH, NORMAL, POSITION, MOVE, SEEN, BUFFER_COUNT };
_Static_assert(sizeof buffer_names / sizeof buffer_names[0] == BUFFER_COUNT, "one name per buffer");
/* Of a buffer's items: format, bytes, how many per pixel (0: one, in rows of the picture). */
static const struct {
    const char *format;
    size_t itemsize, columns;
} layouts[BUFFER_COUNT] = {{"B", 1, 4}, {"f", 4, 0}, {"f", 4, 3}, {"d", 8, 3}, {"i", 4, 0}, {"B", 1, 0}};

/* ---- pictures ---- */

typedef struct picture_object {
    PyObject_HEAD Py_ssize_t width;
    Py_ssize_t height;
    PyObject *bytes[BUFFER_COUNT]; /* NULL: not asked for */
} picture_object;

static void picture_dealloc(PyObject *self)
{
    for (int i = 0; i < BUFFER_COUNT; i++) Py_XDECREF(((picture_object *)self)->bytes[i]);
    object_free(self);
}

static PyObject *picture_buffer(PyObject *self, void *closure)
{
    picture_object *picture = (picture_object *)self;
    const int which = (int)(intptr_t)closure;
    PyObject *owner = picture->bytes[which];
    if (!owner) Py_RETURN_NONE;
    const size_t columns = layouts[which].columns, width = (size_t)picture->width, height = (size_t)picture->height;
    return buffer_view(state_of(self), owner, PyBytes_AsString(owner), layouts[which].format, layouts[which].itemsize,
                       columns ? width * height : height, columns ? columns : width, NULL);
}

static PyObject *picture_width(PyObject *self, void *Py_UNUSED(closure))
{
    return PyLong_FromSsize_t(((picture_object *)self)->width);
}

static PyObject *picture_height(PyObject *self, void *Py_UNUSED(closure))
{
    return PyLong_FromSsize_t(((picture_object *)self)->height);
}

static PyObject *picture_write(PyObject *self, PyObject *path_object)
{
    picture_object *picture = (picture_object *)self;
    PyObject *path = NULL, *result = NULL;
    if (!picture->bytes[RGBA]) {
        PyErr_SetString(PyExc_ValueError, "picture: made without 'rgba'");
        return NULL;
    }
    if (!PyUnicode_FSConverter(path_object, &path)) return NULL;
    native_call call;
    if (!call_begin(&call, NULL)) {
        const swarf_status status =
            swarf_picture_write(PyBytes_AsString(path), (const uint8_t *)PyBytes_AsString(picture->bytes[RGBA]),
                                (int32_t)picture->width, (int32_t)picture->height);
        if (call_end(&call, state_of(self), status) == 0) result = Py_NewRef(Py_None);
    }
    Py_DECREF(path);
    return result;
}

static PyMethodDef picture_methods[] = {
    {"write", picture_write, METH_O, "write($self, path, /)\n--\n\nWrite the colours as PNG. OSError."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef picture_getset[] = {
    {"width", picture_width, NULL, "Pixels.", NULL},
    {"height", picture_height, NULL, "Pixels.", NULL},
    {"rgba", picture_buffer, NULL, "(height * width, 4) uint8 view, sRGB, rows from the top.", (void *)(intptr_t)RGBA},
    {"depth", picture_buffer, NULL,
     "(height, width) float32 view: mm along the view from the eye, inf where nothing is seen.",
     (void *)(intptr_t)DEPTH},
    {"normal", picture_buffer, NULL, "(height * width, 3) float32 view: unit normals, zero where nothing is seen.",
     (void *)(intptr_t)NORMAL},
    {"position", picture_buffer, NULL, "(height * width, 3) float64 view: points in mm, NaN where nothing is seen.",
     (void *)(intptr_t)POSITION},
    {"move", picture_buffer, NULL,
     "(height, width) int32 view: the move that made the surface; -1: the stock as it was, or not known.",
     (void *)(intptr_t)MOVE},
    {"seen", picture_buffer, NULL, "(height, width) uint8 view: what is seen, 0 nothing, 1 stock.",
     (void *)(intptr_t)SEEN},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot picture_slots[] = {
    {Py_tp_doc, "A picture of a scene. Its views are read-only; those that were not asked for are None."},
    {Py_tp_dealloc, picture_dealloc},
    {Py_tp_methods, picture_methods},
    {Py_tp_getset, picture_getset},
    {0, NULL},
};

PyType_Spec picture_spec = {
    .name = "swarf.Picture",
    .basicsize = sizeof(picture_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = picture_slots,
};

/** An empty picture with memory for the buffers named in a sequence; fills `out` with where they are. */
static picture_object *picture_create(module_state *state, const swarf_picture_options *options, PyObject *names,
                                      swarf_picture_buffers *out)
{
    PyObject *list = PySequence_Tuple(names);
    if (!list) return NULL;
    picture_object *picture = (picture_object *)PyType_GenericAlloc(state->picture, 0);
    int failed = !picture;
    void *data[BUFFER_COUNT] = {NULL};
    for (Py_ssize_t i = 0; !failed && i < PyTuple_Size(list); i++) {
        PyObject *item = PyTuple_GetItem(list, i), *text = PyUnicode_Check(item) ? PyUnicode_AsUTF8String(item) : NULL;
        if (!text && !PyErr_Occurred()) PyErr_SetString(PyExc_TypeError, "buffers: needs a sequence of names");
        const int which = text ? choice_find("buffers", PyBytes_AsString(text), buffer_names, BUFFER_COUNT) : -1;
        Py_XDECREF(text);
        failed = which < 0;
        if (failed || picture->bytes[which]) continue;
        const size_t columns = layouts[which].columns ? layouts[which].columns : 1;
        picture->bytes[which] = PyBytes_FromStringAndSize(
            NULL, (Py_ssize_t)(layouts[which].itemsize * columns * (size_t)options->width * (size_t)options->height));
        failed = !picture->bytes[which];
        if (!failed) data[which] = PyBytes_AsString(picture->bytes[which]);
    }
    Py_DECREF(list);
    if (failed) {
        Py_XDECREF((PyObject *)picture);
        return NULL;
    }
    picture->width = options->width;
    picture->height = options->height;
    *out = (swarf_picture_buffers){.size = sizeof *out,
                                   .rgba = data[RGBA],
                                   .depth = data[DEPTH],
                                   .normal = data[NORMAL],
                                   .position = data[POSITION],
                                   .move = data[MOVE],
                                   .seen = data[SEEN]};
    return picture;
}

/* ---- scenes ---- */

typedef struct scene_object {
    PyObject_HEAD swarf_scene *handle;
    PyObject *stock;
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

static void scene_dealloc(PyObject *self)
{
    swarf_scene_destroy(((scene_object *)self)->handle);
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

static PyObject *scene_render(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"camera",  "width",  "height",     "samples",        "coarse",   "budget_ms",
                            "buffers", "colour", "background", "background_top", "progress", NULL};
    module_state *state = state_of(self);
    PyObject *camera, *buffers = NULL, *colour = NULL, *background = NULL, *background_top = NULL, *progress = NULL;
    swarf_picture_options options = swarf_picture_options_default();
    int width = options.width, height = options.height, samples = options.samples, coarse = options.coarse;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!|ii$iidOOOOO:render", names, state->camera, &camera, &width,
                                     &height, &samples, &coarse, &options.budget_ms, &buffers, &colour, &background,
                                     &background_top, &progress) ||
        check_size(width, height) || read_colour(colour, "colour", 3, options.colour) ||
        read_colour(background, "background", 4, options.background) ||
        read_colour(background_top, "background_top", 4, options.background_top))
        return NULL;
    options.width = width;
    options.height = height;
    options.samples = samples;
    options.coarse = coarse;
    PyObject *only_colours = buffers && buffers != Py_None ? Py_NewRef(buffers) : Py_BuildValue("(s)", "rgba");
    if (!only_colours) return NULL;
    swarf_picture_buffers out;
    picture_object *picture = picture_create(state, &options, only_colours, &out);
    Py_DECREF(only_colours);
    native_call call;
    if (!picture) return NULL;
    const swarf_camera seen_by = ((camera_object *)camera)->camera;
    int failed = call_begin(&call, progress);
    if (!failed) {
        const swarf_status status =
            swarf_scene_render(((scene_object *)self)->handle, &seen_by, &options, &call.progress, &out);
        failed = call_end(&call, state, status);
    }
    if (!failed) return (PyObject *)picture;
    Py_DECREF(picture);
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
    static char *names[] = {"camera", "x", "y", "aspect", NULL};
    module_state *state = state_of(self);
    PyObject *camera;
    double x, y, aspect = 1;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!dd|d:pick", names, state->camera, &camera, &x, &y, &aspect))
        return NULL;
    const swarf_camera seen_by = ((camera_object *)camera)->camera;
    swarf_pick pick;
    native_call call;
    call_begin(&call, NULL);
    const swarf_status status = swarf_scene_pick(((scene_object *)self)->handle, &seen_by, aspect, x, y, &pick);
    if (call_end(&call, state, status)) return NULL;
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
    {"render", WITH_KEYWORDS(scene_render), METH_VARARGS | METH_KEYWORDS,
     "render($self, camera, width=1280, height=960, *, samples=3, coarse=1, budget_ms=0.0, buffers=None, "
     "colour=None, background=None, background_top=None, progress=None)\n--\n\n"
     "A Picture. At edges samples x samples rays per pixel (1 .. 4); one ray for coarse x coarse pixels (1 .. 16), as\n"
     "many as it takes to be done in about budget_ms when that is given. buffers: what is wanted of rgba (None), "
     "depth,\n"
     "normal, position, move and seen. Colours are linear, 0 .. 1: RGB of the material, RGBA of the background."},
    {"pick", WITH_KEYWORDS(scene_pick), METH_VARARGS | METH_KEYWORDS,
     "pick($self, camera, x, y, aspect=1.0)\n--\n\n"
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
