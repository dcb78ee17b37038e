/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Stock.picture() and Stock.cast(): a scene lives for one call only, for the stock must not change under it. */
#include "native.h"

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
