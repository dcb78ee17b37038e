/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The one home of the buffer protocol: checked tables in, read-only views out.
 *
 * Inputs are copied into plain C arrays before the GIL is released, so that nobody can change them meanwhile.
 */
#include "native.h"

#include <math.h>

int count_read(PyObject *object, void *out)
{
    const Py_ssize_t value = PyNumber_AsSsize_t(object, NULL);
    if (value == -1 && PyErr_Occurred()) return 0;
    *(Py_ssize_t *)out = value;
    return 1;
}

/* ---- views ---- */

typedef struct view_object {
    PyObject_HEAD PyObject *owner;
    const void *data;
    const char *format; /* a string literal */
    Py_ssize_t itemsize;
    int ndim;
    Py_ssize_t shape[2];
    Py_ssize_t strides[2];
    Py_ssize_t *pins; /* in the owner; NULL: nothing to count */
} view_object;

static int view_getbuffer(PyObject *self, Py_buffer *out, int flags)
{
    view_object *view = (view_object *)self;
    out->obj = NULL;
    if (flags & PyBUF_WRITABLE) {
        PyErr_SetString(PyExc_BufferError, "the view is read-only");
        return -1;
    }
    if (view->ndim > 1 && (flags & PyBUF_F_CONTIGUOUS) == PyBUF_F_CONTIGUOUS) {
        PyErr_SetString(PyExc_BufferError, "the view is in C order");
        return -1;
    }
    out->buf = (void *)view->data;
    out->len = view->itemsize * view->shape[0] * (view->ndim > 1 ? view->shape[1] : 1);
    out->itemsize = view->itemsize;
    out->readonly = 1;
    out->ndim = view->ndim;
    out->format = flags & PyBUF_FORMAT ? (char *)view->format : NULL;
    out->shape = flags & PyBUF_ND ? view->shape : NULL;
    out->strides = (flags & PyBUF_STRIDES) == PyBUF_STRIDES ? view->strides : NULL;
    out->suboffsets = NULL;
    out->internal = NULL;
    out->obj = Py_NewRef(self);
    return 0;
}

static void view_dealloc(PyObject *self)
{
    view_object *view = (view_object *)self;
    if (view->pins) --*view->pins;
    Py_XDECREF(view->owner);
    object_free(self);
}

static PyType_Slot view_slots[] = {
    {Py_tp_doc, "Exporter of a part of a swarf object; seen only through memoryview."},
    {Py_tp_dealloc, view_dealloc},
    {Py_bf_getbuffer, view_getbuffer},
    {0, NULL},
};

PyType_Spec buffer_view_spec = {
    .name = "swarf._native.View",
    .basicsize = sizeof(view_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = view_slots,
};

PyObject *buffer_view(module_state *state, PyObject *owner, const void *data, const char *format, size_t itemsize,
                      size_t rows, size_t columns, Py_ssize_t *pins)
{
    view_object *view = (view_object *)PyType_GenericAlloc(state->view, 0);
    if (!view) return NULL;
    view->owner = Py_NewRef(owner);
    view->data = data ? data : ""; /* an empty array may have no memory; a buffer must */
    view->format = format;
    view->itemsize = (Py_ssize_t)itemsize;
    view->ndim = columns ? 2 : 1;
    view->shape[0] = (Py_ssize_t)rows;
    view->shape[1] = (Py_ssize_t)columns;
    view->strides[0] = view->itemsize * (columns ? (Py_ssize_t)columns : 1);
    view->strides[1] = view->itemsize;
    view->pins = pins;
    if (pins) ++*pins;
    PyObject *result = PyMemoryView_FromObject((PyObject *)view);
    Py_DECREF(view);
    return result;
}

/* ---- inputs ---- */

/** What a table's elements become. */
typedef enum element { ELEMENT_DOUBLE, ELEMENT_INDEX } element;

static size_t element_size(element kind)
{
    return kind == ELEMENT_DOUBLE ? sizeof(double) : sizeof(uint32_t);
}

static int store_double(const char *name, Py_ssize_t row, Py_ssize_t column, double value, double *out)
{
    if (!isfinite(value)) {
        PyErr_Format(PyExc_ValueError, "%s[%zd, %zd]: not a finite number", name, row, column);
        return -1;
    }
    *out = value;
    return 0;
}

static int store_index(const char *name, Py_ssize_t row, Py_ssize_t column, int fits, uint64_t value, uint32_t *out)
{
    if (!fits || value > UINT32_MAX) {
        PyErr_Format(PyExc_ValueError, "%s[%zd, %zd]: not in 0 .. 4294967295", name, row, column);
        return -1;
    }
    *out = (uint32_t)value;
    return 0;
}

/** The one letter of a format in native byte order, 0 for anything else. */
static char format_letter(const Py_buffer *buffer)
{
    const char *format = buffer->format ? buffer->format : "B";
    const uint16_t probe = 1;
    const char native = *(const char *)&probe ? '<' : '>';
    if (*format == '@' || *format == '=' || *format == native) format++;
    return format[0] && !format[1] ? format[0] : '\0';
}

/** A number of the letter's kind and of `size` bytes; sizes tell 'l' of '=' and '@' apart. */
static int number_load(char letter, size_t size, const char *from, int *is_float, double *real, int *negative,
                       uint64_t *whole)
{
    *is_float = 0;
    *negative = 0;
    if (letter == 'd' && size == sizeof(double)) {
        memcpy(real, from, sizeof(double));
        *is_float = 1;
        return 0;
    }
    if (letter == 'f' && size == sizeof(float)) {
        float value;
        memcpy(&value, from, sizeof value);
        *real = (double)value;
        *is_float = 1;
        return 0;
    }
    if (!letter || !strchr("bBhHiIlLqQnN", letter)) return -1;
    const int is_signed = strchr("bhilqn", letter) != NULL;
    switch (size) {
    case 1: {
        uint8_t v;
        memcpy(&v, from, 1);
        *whole = v;
        *negative = is_signed && (int8_t)v < 0;
        break;
    }
    case 2: {
        uint16_t v;
        memcpy(&v, from, 2);
        *whole = v;
        *negative = is_signed && (int16_t)v < 0;
        break;
    }
    case 4: {
        uint32_t v;
        memcpy(&v, from, 4);
        *whole = v;
        *negative = is_signed && (int32_t)v < 0;
        break;
    }
    case 8: {
        memcpy(whole, from, 8);
        *negative = is_signed && (int64_t)*whole < 0;
        break;
    }
    default: return -1;
    }
    if (*negative) { /* sign-extended, so that its value can be had as a double */
        const int shift = 64 - 8 * (int)size;
        *whole = (uint64_t)((int64_t)(*whole << shift) >> shift);
    }
    *real = *negative ? (double)(int64_t)*whole : (double)*whole;
    return 0;
}

static int table_of_buffer(const Py_buffer *buffer, const char *name, Py_ssize_t columns, element kind, void *out)
{
    const char letter = format_letter(buffer);
    for (Py_ssize_t row = 0; row < buffer->shape[0]; row++)
        for (Py_ssize_t column = 0; column < columns; column++) {
            const char *from = (const char *)buffer->buf + row * buffer->strides[0] + column * buffer->strides[1];
            int is_float, negative;
            double real;
            uint64_t whole = 0;
            const int failed = number_load(letter, (size_t)buffer->itemsize, from, &is_float, &real, &negative, &whole);
            if (failed || (kind == ELEMENT_INDEX && is_float)) {
                PyErr_Format(PyExc_ValueError, "%s: elements of format '%s'; %s are needed", name,
                             buffer->format ? buffer->format : "B",
                             kind == ELEMENT_INDEX ? "whole numbers in native byte order (e.g. 'I')"
                                                   : "numbers in native byte order (e.g. 'd' or 'f')");
                return -1;
            }
            const size_t at = (size_t)(row * columns + column);
            if (kind == ELEMENT_DOUBLE ? store_double(name, row, column, real, (double *)out + at)
                                       : store_index(name, row, column, !negative, whole, (uint32_t *)out + at))
                return -1;
        }
    return 0;
}

static int table_of_rows(PyObject *rows, const char *name, Py_ssize_t columns, element kind, void *out)
{
    const Py_ssize_t count = PyTuple_Size(rows);
    for (Py_ssize_t row = 0; row < count; row++) {
        PyObject *items = PySequence_Tuple(PyTuple_GetItem(rows, row));
        if (!items) return -1;
        if (PyTuple_Size(items) != columns) {
            PyErr_Format(PyExc_ValueError, "%s[%zd]: %zd numbers where %zd are needed", name, row, PyTuple_Size(items),
                         columns);
            Py_DECREF(items);
            return -1;
        }
        int failed = 0;
        for (Py_ssize_t column = 0; column < columns && !failed; column++) {
            PyObject *item = PyTuple_GetItem(items, column);
            const size_t at = (size_t)(row * columns + column);
            if (kind == ELEMENT_DOUBLE) {
                const double value = PyFloat_AsDouble(item);
                failed =
                    (value == -1.0 && PyErr_Occurred()) || store_double(name, row, column, value, (double *)out + at);
            } else {
                PyObject *whole = PyNumber_Index(item); /* no float here */
                int overflow = 0;
                const long long value = whole ? PyLong_AsLongLongAndOverflow(whole, &overflow) : -1;
                Py_XDECREF(whole);
                failed = (!overflow && value == -1 && PyErr_Occurred()) ||
                         store_index(name, row, column, !overflow && value >= 0, (uint64_t)value, (uint32_t *)out + at);
            }
        }
        Py_DECREF(items);
        if (failed) return -1;
    }
    return 0;
}

static int table_allocate(Py_ssize_t rows, Py_ssize_t columns, element kind, void **out)
{
    /* PyMem_Malloc refuses more than PY_SSIZE_T_MAX; rows * columns of something that exists cannot overflow. */
    *out = PyMem_Malloc((size_t)rows * (size_t)columns * element_size(kind) + 1);
    if (*out) return 0;
    PyErr_NoMemory();
    return -1;
}

static int table_read(PyObject *object, const char *name, Py_ssize_t columns, element kind, void **out, size_t *count)
{
    void *table = NULL;
    Py_ssize_t rows = 0;
    int failed;
    if (PyObject_CheckBuffer(object)) {
        Py_buffer buffer;
        if (PyObject_GetBuffer(object, &buffer, PyBUF_STRIDES | PyBUF_FORMAT) < 0) return -1;
        if (buffer.ndim != 2 || buffer.shape[1] != columns) {
            if (buffer.ndim == 2)
                PyErr_Format(PyExc_ValueError, "%s: %zd columns where %zd are needed", name, buffer.shape[1], columns);
            else
                PyErr_Format(PyExc_ValueError, "%s: %d dimensions where an (n, %zd) table is needed", name, buffer.ndim,
                             columns);
            failed = -1;
        } else {
            rows = buffer.shape[0];
            failed = table_allocate(rows, columns, kind, &table);
            if (!failed) failed = table_of_buffer(&buffer, name, columns, kind, table);
        }
        PyBuffer_Release(&buffer);
    } else {
        PyObject *sequence = PySequence_Check(object) && !PyUnicode_Check(object) ? PySequence_Tuple(object) : NULL;
        if (!sequence) {
            if (!PyErr_Occurred())
                PyErr_Format(PyExc_TypeError, "%s: needs a buffer or a sequence of rows of %zd numbers", name, columns);
            return -1;
        }
        rows = PyTuple_Size(sequence);
        failed = table_allocate(rows, columns, kind, &table);
        if (!failed) failed = table_of_rows(sequence, name, columns, kind, table);
        Py_DECREF(sequence);
    }
    if (failed) {
        PyMem_Free(table);
        return -1;
    }
    *out = table;
    *count = (size_t)rows;
    return 0;
}

int buffer_doubles(PyObject *object, const char *name, Py_ssize_t columns, double **out, size_t *rows)
{
    void *table;
    if (table_read(object, name, columns, ELEMENT_DOUBLE, &table, rows)) return -1;
    *out = table;
    return 0;
}

int buffer_indices(PyObject *object, const char *name, Py_ssize_t columns, uint32_t **out, size_t *rows)
{
    void *table;
    if (table_read(object, name, columns, ELEMENT_INDEX, &table, rows)) return -1;
    *out = table;
    return 0;
}

int buffer_point(PyObject *object, const char *name, double out[3])
{
    PyObject *items = PySequence_Check(object) && !PyUnicode_Check(object) ? PySequence_Tuple(object) : NULL;
    if (!items) {
        if (!PyErr_Occurred()) PyErr_Format(PyExc_TypeError, "%s: needs three numbers", name);
        return -1;
    }
    double point[3] = {0};
    int failed = PyTuple_Size(items) != 3;
    if (failed) PyErr_Format(PyExc_ValueError, "%s: %zd numbers where 3 are needed", name, PyTuple_Size(items));
    for (Py_ssize_t i = 0; i < 3 && !failed; i++) {
        point[i] = PyFloat_AsDouble(PyTuple_GetItem(items, i));
        failed = point[i] == -1.0 && PyErr_Occurred();
        if (!failed && !isfinite(point[i])) {
            PyErr_Format(PyExc_ValueError, "%s[%zd]: not a finite number", name, i);
            failed = 1;
        }
    }
    Py_DECREF(items);
    if (failed) return -1;
    memcpy(out, point, sizeof point);
    return 0;
}
