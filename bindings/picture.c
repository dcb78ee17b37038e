/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Picture: the buffers of one. Stock.picture() and Stock.cast(): a scene lives for one call only, for the stock must
 * not change under it. */
#include "native.h"

static const char *const buffer_names[] = {"rgba", "depth", "normal", "position", "move", "seen"};
enum { RGBA, DEPTH, NORMAL, POSITION, MOVE, SEEN, BUFFER_COUNT };
_Static_assert(sizeof buffer_names / sizeof buffer_names[0] == BUFFER_COUNT, "one name per buffer");
/* Of a buffer's items: format, bytes, how many per pixel (0: one, in rows of the picture). */
static const struct {
    const char *format;
    size_t itemsize, columns;
} layouts[BUFFER_COUNT] = {{"B", 1, 4}, {"f", 4, 0}, {"f", 4, 3}, {"d", 8, 3}, {"i", 4, 0}, {"B", 1, 0}};

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

static PyObject *picture_show_deviation(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"other", "tolerance", "allowance", "progress", NULL};
    module_state *state = state_of(self);
    picture_object *picture = (picture_object *)self;
    PyObject *other, *progress = NULL;
    double tolerance, allowance = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "Od|$dO:show_deviation", names, &other, &tolerance, &allowance,
                                     &progress))
        return NULL;
    const int is_design = PyObject_TypeCheck(other, state->solid);
    if (!is_design && !PyObject_TypeCheck(other, state->stock)) {
        PyErr_SetString(PyExc_TypeError, "show_deviation: needs the Solid of a design or a Stock");
        return NULL;
    }
    if (!picture->bytes[RGBA] || !picture->bytes[POSITION] || !picture->bytes[SEEN]) {
        PyErr_SetString(PyExc_ValueError, "picture: made without 'rgba', 'position' and 'seen'");
        return NULL;
    }
    const size_t count = (size_t)picture->width * (size_t)picture->height;
    PyObject *values = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(count * sizeof(double)));
    /* A copy, for views of the picture as it was may live. */
    PyObject *rgba = PyBytes_FromStringAndSize(PyBytes_AsString(picture->bytes[RGBA]), (Py_ssize_t)(4 * count));
    PyObject *result = NULL;
    native_call call;
    if (values && rgba && !call_begin(&call, progress)) {
        double *value = (double *)(void *)PyBytes_AsString(values);
        const double *position = (const double *)(const void *)PyBytes_AsString(picture->bytes[POSITION]);
        const uint8_t *seen = (const uint8_t *)PyBytes_AsString(picture->bytes[SEEN]);
        swarf_status status = is_design ? swarf_deviation_pixels(((solid_object *)other)->handle, position, seen, count,
                                                                 allowance, &call.progress, value)
                                        : swarf_deviation_design_pixels(((stock_object *)other)->handle, position, seen,
                                                                        count, allowance, &call.progress, value);
        if (!status) status = swarf_deviation_colours(value, count, tolerance, (uint8_t *)PyBytes_AsString(rgba));
        if (!call_end(&call, state, status))
            result = buffer_view(state, values, value, "d", sizeof *value, (size_t)picture->height,
                                 (size_t)picture->width, NULL);
    }
    if (result) {
        Py_DECREF(picture->bytes[RGBA]);
        picture->bytes[RGBA] = Py_NewRef(rgba);
    }
    Py_XDECREF(rgba);
    Py_XDECREF(values);
    return result;
}

static PyMethodDef picture_methods[] = {
    {"show_deviation", WITH_KEYWORDS(picture_show_deviation), METH_VARARGS | METH_KEYWORDS,
     "show_deviation($self, other, tolerance, *, allowance=0.0, progress=None)\n--\n\n"
     "Tint what shows the stock by its deviation from a design Solid, as deviation_colours() does -> the deviations\n"
     "(mm, less what is meant to be left), a read-only (height, width) float64 view, NaN elsewhere. Of a picture of\n"
     "the design, by that of a Stock from it: on faces to 0.01 voxel up to two voxels, +-inf beyond three. Needs the\n"
     "buffers rgba, position and seen; ValueError without them. rgba is a new view, which write() writes."},
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
    {"seen", picture_buffer, NULL,
     "(height, width) uint8 view: what is seen, 0 nothing, 1 stock, 2 section, 3 flutes, 4 shank, 5 holder, 6 fixture.",
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

PyObject *picture_create(module_state *state, const swarf_picture_options *options, PyObject *names,
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
    return (PyObject *)picture;
}

/* ---- methods of Stock ---- */

const char stock_picture_doc[] =
    "picture($self, path=None, width=1024, height=768, *, view='isometric', samples=3, perspective=False, "
    "progress=None)\n--\n\n"
    "A shaded picture, samples x samples rays per pixel at edges; view isometric, top, bottom, front, rear, left or\n"
    "right.\n"
    "With a path it is written as PNG and None is returned; else RGBA bytes, 4 x width x height, rows from the top.";

/** Scene, camera, pixels; runs without the GIL. */
static swarf_status draw(swarf_stock *stock, swarf_view view, int perspective, const swarf_picture_options *options,
                         const swarf_progress *progress, const char *path, uint8_t *rgba)
{
    swarf_box box;
    swarf_camera camera;
    swarf_scene *scene;
    swarf_status status = swarf_stock_box(stock, &box);
    for (int i = 0; i < 3 && !status; i++)
        if (!(box.lo[i] < box.hi[i])) { /* nothing left: an empty picture of any place */
            box.lo[i] = 0;
            box.hi[i] = 1;
        }
    if (!status) status = swarf_camera_fit(view, perspective, &box, (double)options->width / options->height, &camera);
    if (!status) status = swarf_scene_create(stock, &scene);
    if (status) return status;
    status = swarf_scene_picture(scene, &camera, options, progress, rgba);
    swarf_scene_destroy(scene);
    if (!status && path) status = swarf_picture_write(path, rgba, options->width, options->height);
    return status;
}

PyObject *stock_picture(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"path", "width", "height", "view", "samples", "perspective", "progress", NULL};
    swarf_picture_options options = swarf_picture_options_default();
    PyObject *path_object = Py_None, *progress = NULL, *path = NULL, *result = NULL;
    const char *view_text = view_names[0];
    int width = 1024, height = 768, samples = 3, perspective = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "|Oii$sipO:picture", names, &path_object, &width, &height,
                                     &view_text, &samples, &perspective, &progress))
        return NULL;
    const int view = choice_find("view", view_text, view_names, SWARF_VIEW_COUNT);
    if (view < 0) return NULL;
    /* Before the pixels are allocated; libswarf checks again what it is given. */
    if (width < 1 || width > 16384 || height < 1 || height > 16384) {
        PyErr_Format(PyExc_ValueError, "width, height: %d x %d is not in 1 .. 16384", width, height);
        return NULL;
    }
    options.width = width;
    options.height = height;
    options.samples = samples;
    if (path_object != Py_None && !PyUnicode_FSConverter(path_object, &path)) return NULL;
    PyObject *pixels = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)4 * width * height);
    native_call call;
    if (pixels && !call_begin(&call, progress)) {
        const swarf_status status =
            draw(((stock_object *)self)->handle, (swarf_view)view, perspective, &options, &call.progress,
                 path ? PyBytes_AsString(path) : NULL, (uint8_t *)PyBytes_AsString(pixels));
        if (call_end(&call, state_of(self), status) == 0) result = Py_NewRef(path ? Py_None : pixels);
    }
    Py_XDECREF(pixels);
    Py_XDECREF(path);
    return result;
}

const char stock_cast_doc[] =
    "cast($self, origins, directions)\n--\n\n"
    "First hits of rays, (n, 3) tables in mm -> (distances: float64 view, in lengths of the direction, inf for none;\n"
    "normals: (n, 3) float32 view).";

PyObject *stock_cast(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"origins", "directions", NULL};
    PyObject *origins, *directions, *result = NULL;
    double *origin = NULL, *direction = NULL;
    size_t count, direction_count;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OO:cast", names, &origins, &directions)) return NULL;
    if (buffer_doubles(origins, "origins", 3, &origin, &count) ||
        buffer_doubles(directions, "directions", 3, &direction, &direction_count)) {
        PyMem_Free(origin);
        return NULL;
    }
    PyObject *distances = NULL, *normals = NULL;
    native_call call;
    if (count != direction_count) {
        PyErr_Format(PyExc_ValueError, "directions: %zu rows where origins has %zu", direction_count, count);
    } else {
        distances = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(count * sizeof(double)));
        normals = distances ? PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(count * 3 * sizeof(float))) : NULL;
    }
    if (normals && !call_begin(&call, NULL)) {
        swarf_scene *scene;
        swarf_status status = swarf_scene_create(((stock_object *)self)->handle, &scene);
        if (!status) {
            status = swarf_scene_cast(scene, origin, direction, count, (double *)(void *)PyBytes_AsString(distances),
                                      (float *)(void *)PyBytes_AsString(normals));
            swarf_scene_destroy(scene);
        }
        if (call_end(&call, state_of(self), status) == 0) {
            PyObject *t = buffer_view(state_of(self), distances, PyBytes_AsString(distances), "d", sizeof(double),
                                      count, 0, NULL);
            PyObject *n =
                buffer_view(state_of(self), normals, PyBytes_AsString(normals), "f", sizeof(float), count, 3, NULL);
            result = t && n ? PyTuple_Pack(2, t, n) : NULL;
            Py_XDECREF(t);
            Py_XDECREF(n);
        }
    }
    Py_XDECREF(distances);
    Py_XDECREF(normals);
    PyMem_Free(origin);
    PyMem_Free(direction);
    return result;
}
