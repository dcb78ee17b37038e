/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Camera: from where and how a scene is looked at; its methods change it in place. */
#include "native.h"

const char *const view_names[] = {"isometric", "top", "bottom", "front", "rear", "left", "right"};
_Static_assert(sizeof view_names / sizeof view_names[0] == SWARF_VIEW_COUNT, "one name per view");

static swarf_camera *camera_of(PyObject *self)
{
    return &((camera_object *)self)->camera;
}

static PyObject *none_or_raise(PyObject *self, swarf_status status)
{
    if (status) return error_raise(state_of(self), status);
    Py_RETURN_NONE;
}

int camera_box(PyObject *box, swarf_box *out)
{
    if (box == Py_None) { /* of a stock with nothing left */
        *out = (swarf_box){{1, 1, 1}, {0, 0, 0}};
        return 0;
    }
    PyObject *corners = PySequence_Check(box) ? PySequence_Tuple(box) : NULL;
    int failed = !corners || PyTuple_Size(corners) != 2;
    if (failed && !PyErr_Occurred()) PyErr_SetString(PyExc_TypeError, "box: needs two corners, ((x, y, z), (x, y, z))");
    if (!failed)
        failed = buffer_point(PyTuple_GetItem(corners, 0), "box[0]", out->lo) ||
                 buffer_point(PyTuple_GetItem(corners, 1), "box[1]", out->hi);
    Py_XDECREF(corners);
    return failed ? -1 : 0;
}

static PyObject *camera_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"eye", "target", "up", "perspective", "height", "fov", NULL};
    PyObject *eye, *target, *up;
    swarf_camera camera = {.height_mm = 100, .fov_deg = 30};
    int perspective = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OOO|$pdd:Camera", names, &eye, &target, &up, &perspective,
                                     &camera.height_mm, &camera.fov_deg) ||
        buffer_point(eye, "eye", camera.eye) || buffer_point(target, "target", camera.target) ||
        buffer_point(up, "up", camera.up))
        return NULL;
    camera.perspective = perspective;
    double origin[3], direction[3];
    const swarf_status status = swarf_camera_ray(&camera, 1, 0, 0, origin, direction); /* checks the camera */
    if (status) return error_raise(state_of_type(type), status);
    PyObject *self = PyType_GenericAlloc(type, 0);
    if (self) *camera_of(self) = camera;
    return self;
}

static PyObject *camera_view(PyObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"name", "box", "aspect", "perspective", NULL};
    const char *name;
    PyObject *box_object;
    double aspect = 1;
    int perspective = 0;
    swarf_box box;
    swarf_camera camera;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "sO|d$p:view", names, &name, &box_object, &aspect, &perspective))
        return NULL;
    const int view = choice_find("view", name, view_names, SWARF_VIEW_COUNT);
    if (view < 0 || camera_box(box_object, &box)) return NULL;
    const swarf_status status = swarf_camera_fit((swarf_view)view, perspective, &box, aspect, &camera);
    if (status) return error_raise(state_of_type((PyTypeObject *)type), status);
    PyObject *self = PyType_GenericAlloc((PyTypeObject *)type, 0);
    if (self) *camera_of(self) = camera;
    return self;
}

static PyObject *camera_copy(PyObject *self, PyObject *Py_UNUSED(none))
{
    PyObject *copy = PyType_GenericAlloc(Py_TYPE(self), 0);
    if (copy) *camera_of(copy) = *camera_of(self);
    return copy;
}

static PyObject *camera_fit(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"box", "aspect", NULL};
    PyObject *box_object;
    double aspect = 1;
    swarf_box box;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O|d:fit", names, &box_object, &aspect) ||
        camera_box(box_object, &box))
        return NULL;
    return none_or_raise(self, swarf_camera_fit_box(camera_of(self), &box, aspect));
}

static PyObject *camera_set_perspective(PyObject *self, PyObject *on)
{
    const int perspective = PyObject_IsTrue(on);
    if (perspective < 0) return NULL;
    return none_or_raise(self, swarf_camera_set_perspective(camera_of(self), perspective));
}

static PyObject *camera_turn(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"pivot", "axis", "angle_deg", NULL};
    PyObject *pivot_object, *axis_object;
    double angle, pivot[3], axis[3];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "OOd:turn", names, &pivot_object, &axis_object, &angle) ||
        buffer_point(pivot_object, "pivot", pivot) || buffer_point(axis_object, "axis", axis))
        return NULL;
    return none_or_raise(self, swarf_camera_turn(camera_of(self), pivot, axis, angle));
}

static PyObject *camera_orbit(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"pivot", "right_deg", "up_deg", "turntable", NULL};
    PyObject *pivot_object;
    double right, up, pivot[3];
    int turntable = 0;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "Odd|$p:orbit", names, &pivot_object, &right, &up, &turntable) ||
        buffer_point(pivot_object, "pivot", pivot))
        return NULL;
    return none_or_raise(self, swarf_camera_orbit(camera_of(self), pivot, right, up, turntable));
}

static PyObject *camera_pan(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"x", "y", "depth_of", NULL};
    PyObject *point_object = Py_None;
    double x, y, point[3];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "dd|O:pan", names, &x, &y, &point_object) ||
        (point_object != Py_None && buffer_point(point_object, "depth_of", point)))
        return NULL;
    return none_or_raise(self, swarf_camera_pan(camera_of(self), x, y, point_object == Py_None ? NULL : point));
}

static PyObject *camera_zoom(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"factor", "toward", NULL};
    PyObject *point_object = Py_None;
    double factor, point[3];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "d|O:zoom", names, &factor, &point_object)) return NULL;
    memcpy(point, camera_of(self)->target, sizeof point);
    if (point_object != Py_None && buffer_point(point_object, "toward", point)) return NULL;
    return none_or_raise(self, swarf_camera_zoom(camera_of(self), factor, point));
}

static PyObject *camera_ray(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"x", "y", "aspect", NULL};
    double x, y, aspect = 1, origin[3], direction[3];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "dd|d:ray", names, &x, &y, &aspect)) return NULL;
    const swarf_status status = swarf_camera_ray(camera_of(self), aspect, x, y, origin, direction);
    if (status) return error_raise(state_of(self), status);
    return Py_BuildValue("((ddd)(ddd))", origin[0], origin[1], origin[2], direction[0], direction[1], direction[2]);
}

static PyObject *camera_project(PyObject *self, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"point", "aspect", NULL};
    PyObject *point_object;
    double aspect = 1, point[3], place[3];
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O|d:project", names, &point_object, &aspect) ||
        buffer_point(point_object, "point", point))
        return NULL;
    const swarf_status status = swarf_camera_project(camera_of(self), aspect, point, place);
    if (status) return error_raise(state_of(self), status);
    return Py_BuildValue("(ddd)", place[0], place[1], place[2]);
}

static PyObject *point_to_python(const double point[3])
{
    return Py_BuildValue("(ddd)", point[0], point[1], point[2]);
}

static PyObject *camera_eye(PyObject *self, void *Py_UNUSED(closure))
{
    return point_to_python(camera_of(self)->eye);
}

static PyObject *camera_target(PyObject *self, void *Py_UNUSED(closure))
{
    return point_to_python(camera_of(self)->target);
}

static PyObject *camera_up(PyObject *self, void *Py_UNUSED(closure))
{
    return point_to_python(camera_of(self)->up);
}

static PyObject *camera_perspective(PyObject *self, void *Py_UNUSED(closure))
{
    return PyBool_FromLong(camera_of(self)->perspective);
}

static PyObject *camera_height(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(camera_of(self)->height_mm);
}

static PyObject *camera_fov(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(camera_of(self)->fov_deg);
}

static PyMethodDef camera_methods[] = {
    {"view", WITH_KEYWORDS(camera_view), METH_VARARGS | METH_KEYWORDS | METH_CLASS,
     "view($type, name, box, aspect=1.0, *, perspective=False)\n--\n\n"
     "The whole of a box ((x, y, z), (x, y, z)) or None seen as isometric, top, bottom, front, rear, left or right."},
    {"copy", camera_copy, METH_NOARGS, "copy($self, /)\n--\n\nA camera of its own that looks the same way."},
    {"fit", WITH_KEYWORDS(camera_fit), METH_VARARGS | METH_KEYWORDS,
     "fit($self, box, aspect=1.0)\n--\n\nShow the whole box from the direction the camera looks in."},
    {"set_perspective", camera_set_perspective, METH_O,
     "set_perspective($self, on, /)\n--\n\n"
     "Parallel rays instead of perspective or back; what lies at the target keeps its size."},
    {"turn", WITH_KEYWORDS(camera_turn), METH_VARARGS | METH_KEYWORDS,
     "turn($self, pivot, axis, angle_deg)\n--\n\nTurn counter-clockwise about the line through `pivot` along `axis`."},
    {"orbit", WITH_KEYWORDS(camera_orbit), METH_VARARGS | METH_KEYWORDS,
     "orbit($self, pivot, right_deg, up_deg, *, turntable=False)\n--\n\n"
     "Turn about `pivot` as if the part were dragged to the right and upwards by these angles: about the camera's\n"
     "own axes, or with `turntable` about the vertical and up to the poles."},
    {"pan", WITH_KEYWORDS(camera_pan), METH_VARARGS | METH_KEYWORDS,
     "pan($self, x, y, depth_of=None)\n--\n\n"
     "Move so that what lies as deep as `depth_of` (the target) goes x to the right and y upwards, in heights of the\n"
     "picture."},
    {"zoom", WITH_KEYWORDS(camera_zoom), METH_VARARGS | METH_KEYWORDS,
     "zoom($self, factor, toward=None)\n--\n\n"
     "Show things `factor` times as large; the point `toward` (the target) stays at its place in the picture."},
    {"ray", WITH_KEYWORDS(camera_ray), METH_VARARGS | METH_KEYWORDS,
     "ray($self, x, y, aspect=1.0)\n--\n\n"
     "(origin, unit direction) of the ray through a place of the picture, x to the right and y upwards, -1 .. 1."},
    {"project", WITH_KEYWORDS(camera_project), METH_VARARGS | METH_KEYWORDS,
     "project($self, point, aspect=1.0)\n--\n\n"
     "(x, y, depth in mm) at which a point appears; x and y are NaN for what is behind a perspective eye."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef camera_getset[] = {
    {"eye", camera_eye, NULL, "Where the camera stands, mm.", NULL},
    {"target", camera_target, NULL, "The point in the middle of the picture, mm.", NULL},
    {"up", camera_up, NULL, "What is upwards in the picture.", NULL},
    {"perspective", camera_perspective, NULL, "Whether rays meet in the eye; else they are parallel.", NULL},
    {"height", camera_height, NULL, "Parallel rays: mm from the bottom to the top of the picture.", NULL},
    {"fov", camera_fov, NULL, "Perspective: vertical opening angle, degrees.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot camera_slots[] = {
    {Py_tp_doc,
     "Camera(eye, target, up, *, perspective=False, height=100.0, fov=30.0)\n--\n\n"
     "From where and how a scene is looked at, in mm and degrees; its methods change it in place. Places in\n"
     "a picture are x to the right and y upwards, -1 .. 1 at its borders; its aspect is width / height.\n"
     "Parallel rays show what is before and behind the eye. ValueError for a camera that sees nothing."},
    {Py_tp_new, camera_new},
    {Py_tp_dealloc, object_free},
    {Py_tp_methods, camera_methods},
    {Py_tp_getset, camera_getset},
    {0, NULL},
};

PyType_Spec camera_spec = {
    .name = "swarf.Camera",
    .basicsize = sizeof(camera_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = camera_slots,
};
