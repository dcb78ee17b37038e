/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* swarf.History: one thread at a time; a second one gets BusyError. Where it stands is kept in the object, written with
 * the GIL held, so that anyone may ask. */
#include "native.h"

typedef struct history_object {
    PyObject_HEAD swarf_history *handle;
    PyObject *stock;
    program_object *program; /* closed while the history lives */
    int busy;                /* a call without the GIL is in */
    size_t move;
    double fraction;
} history_object;

static PyStructSequence_Field held_fields[] = {
    {"bytes", "All together."},
    {"first_bytes", "The copy of the stock as it was first."},
    {"record_bytes", "What was there before the moves that can be undone."},
    {"keyframe_bytes", "Copies of the stock at some positions."},
    {"record_count", "Steps that can be undone."},
    {"keyframe_count", "Copies kept."},
    {"oldest", "Position down to which all can be undone."},
    {NULL, NULL},
};

PyStructSequence_Desc held_desc = {
    .name = "swarf.Held",
    .doc = "What a History holds, in bytes.",
    .fields = held_fields,
    .n_in_sequence = 7,
};

static PyObject *history_new(PyTypeObject *type, PyObject *args, PyObject *keywords)
{
    static char *names[] = {"stock", "program", "tools", "memory_limit", NULL};
    module_state *state = state_of_type(type);
    PyObject *stock, *program, *dict;
    Py_ssize_t limit = 0;
    swarf_tool *tools;
    size_t tool_count;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, "O!O!O!|$n:History", names, state->stock, &stock, state->program,
                                     &program, &PyDict_Type, &dict, &limit))
        return NULL;
    if (limit < 0) {
        PyErr_Format(PyExc_ValueError, "memory_limit %zd is negative; give bytes, 0 for a quarter of what is free",
                     limit);
        return NULL;
    }
    if (tools_read(state, dict, &tools, &tool_count)) return NULL;
    history_object *self = (history_object *)PyType_GenericAlloc(type, 0);
    if (!self) {
        tools_free(tools, tool_count);
        return NULL;
    }
    self->stock = Py_NewRef(stock);
    self->program = (program_object *)Py_NewRef(program);
    self->program->exports++;
    swarf_history_options options = swarf_history_options_default();
    options.memory_limit = (size_t)limit;
    native_call call;
    call_begin(&call, NULL);
    const swarf_status status = swarf_history_create(((stock_object *)stock)->handle, self->program->handle, tools,
                                                     tool_count, &options, &self->handle);
    const int failed = call_end(&call, state, status);
    tools_free(tools, tool_count);
    if (!failed) return (PyObject *)self;
    Py_DECREF(self);
    return NULL;
}

static void history_dealloc(PyObject *self)
{
    history_object *history = (history_object *)self;
    swarf_history_destroy(history->handle);
    if (history->program) history->program->exports--;
    Py_XDECREF((PyObject *)history->program);
    Py_XDECREF(history->stock);
    object_free(self);
}

static int enter(history_object *history)
{
    if (history->busy) {
        PyErr_SetString(state_of((PyObject *)history)->busy_error, "history: in use by another thread");
        return -1;
    }
    history->busy = 1;
    return 0;
}

/* *arrived NULL: go all the way. 0, or -1 with an exception. */
static int go(PyObject *self, PyObject *args, PyObject *keywords, const char *format, int *arrived)
{
    static char *names[] = {"move", "fraction", "progress", NULL};
    history_object *history = (history_object *)self;
    Py_ssize_t move;
    double fraction = 0;
    PyObject *progress = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keywords, format, names, &move, &fraction, &progress)) return -1;
    if (move < 0) {
        PyErr_Format(PyExc_ValueError, "history: no position %zd; moves count from 0", move);
        return -1;
    }
    native_call call;
    if (enter(history)) return -1;
    int failed = call_begin(&call, progress);
    if (!failed) {
        const swarf_status status =
            arrived ? swarf_history_approach(history->handle, (size_t)move, fraction, &call.progress, arrived)
                    : swarf_history_seek(history->handle, (size_t)move, fraction, &call.progress);
        failed = call_end(&call, state_of(self), status);
        history->move = swarf_history_move(history->handle);
        history->fraction = swarf_history_fraction(history->handle);
    }
    history->busy = 0;
    return failed ? -1 : 0;
}

static PyObject *history_seek(PyObject *self, PyObject *args, PyObject *keywords)
{
    if (go(self, args, keywords, "n|d$O:seek", NULL)) return NULL;
    Py_RETURN_NONE;
}

static PyObject *history_approach(PyObject *self, PyObject *args, PyObject *keywords)
{
    int arrived = 0;
    return go(self, args, keywords, "n|d$O:approach", &arrived) ? NULL : PyBool_FromLong(arrived);
}

static PyObject *history_held(PyObject *self, PyObject *Py_UNUSED(none))
{
    history_object *history = (history_object *)self;
    if (enter(history)) return NULL;
    const swarf_history_held held = swarf_history_get_held(history->handle);
    history->busy = 0;
    PyObject *items[] = {PyLong_FromSize_t(held.bytes),        PyLong_FromSize_t(held.first_bytes),
                         PyLong_FromSize_t(held.record_bytes), PyLong_FromSize_t(held.keyframe_bytes),
                         PyLong_FromSize_t(held.record_count), PyLong_FromSize_t(held.keyframe_count),
                         PyLong_FromSize_t(held.oldest)};
    return make_sequence(state_of(self)->held, items, 7);
}

static PyObject *history_stock(PyObject *self, void *Py_UNUSED(closure))
{
    return Py_NewRef(((history_object *)self)->stock);
}

static PyObject *history_move(PyObject *self, void *Py_UNUSED(closure))
{
    return PyLong_FromSize_t(((history_object *)self)->move);
}

static PyObject *history_fraction(PyObject *self, void *Py_UNUSED(closure))
{
    return PyFloat_FromDouble(((history_object *)self)->fraction);
}

static PyMethodDef history_methods[] = {
    {"seek", WITH_KEYWORDS(history_seek), METH_VARARGS | METH_KEYWORDS,
     "seek($self, move, fraction=0.0, *, progress=None)\n--\n\n"
     "Make the stock what it is after the first `move` moves and a part, 0 .. 1, of the next one's path. Cancelling\n"
     "leaves it between moves, where `move` says. ValueError: no such position, or the stock was changed by others."},
    {"approach", WITH_KEYWORDS(history_approach), METH_VARARGS | METH_KEYWORDS,
     "approach($self, move, fraction=0.0, *, progress=None)\n--\n\n"
     "Go on towards there by one batch of at most 4096 moves -> whether it is there."},
    {"held", history_held, METH_NOARGS, "held($self, /)\n--\n\nWhat it holds: a Held."},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef history_getset[] = {
    {"stock", history_stock, NULL, "The Stock: read it, draw it, measure it, and let nothing else cut it.", NULL},
    {"move", history_move, NULL, "Moves that are done.", NULL},
    {"fraction", history_fraction, NULL, "Part of the next move that is done, 0 .. 1.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot history_slots[] = {
    {Py_tp_doc,
     "History(stock, program, tools, *, memory_limit=0)\n--\n\n"
     "A stock that can stand at any move of a program, forward by cutting, back by undoing; tools as in\n"
     "Stock.simulate(). It stands before the first move. A position has one content, to the bit, whichever way it is\n"
     "reached. memory_limit: bytes for what is kept, besides a copy of the first stock; 0: a quarter of what is free.\n"
     "The program cannot be changed while the history lives. A second thread gets BusyError."},
    {Py_tp_new, history_new},
    {Py_tp_dealloc, history_dealloc},
    {Py_tp_methods, history_methods},
    {Py_tp_getset, history_getset},
    {0, NULL},
};

PyType_Spec history_spec = {
    .name = "swarf.History",
    .basicsize = sizeof(history_object),
    .flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
    .slots = history_slots,
};
