/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Native calls without the GIL.
 *
 * libswarf reports progress on the thread that made the call. The report takes the GIL with that thread's own state
 * (which also serves sub-interpreters), lets signal handlers run, calls the callback and lets the GIL go again. What is
 * raised there cancels the call, waits in the native_call and comes out of call_end() unchanged.
 */
#include "native.h"

static int report(void *user, double fraction)
{
    native_call *call = user;
    if (call->type) return 1; /* raised before: the library is still on its way out */
    PyEval_RestoreThread(call->thread);
    int stop = PyErr_CheckSignals() < 0;
    if (!stop && call->callback) {
        PyObject *answer = PyObject_CallFunction(call->callback, "d", fraction);
        stop = answer ? PyObject_IsTrue(answer) : 1; /* -1 is an exception too */
        Py_XDECREF(answer);
    }
    if (PyErr_Occurred()) PyErr_Fetch(&call->type, &call->value, &call->traceback);
    call->thread = PyEval_SaveThread();
    return stop != 0;
}

int call_begin(native_call *call, PyObject *callback)
{
    if (callback == Py_None) callback = NULL;
    if (callback && !PyCallable_Check(callback)) {
        PyErr_SetString(PyExc_TypeError, "progress: not callable; give a function of the fraction done, or None");
        return -1;
    }
    *call = (native_call){.progress = {report, call}, .callback = callback};
    call->thread = PyEval_SaveThread();
    return 0;
}

int call_end(native_call *call, module_state *state, swarf_status status)
{
    PyEval_RestoreThread(call->thread);
    if (call->type) {
        PyErr_Restore(call->type, call->value, call->traceback);
        return -1;
    }
    if (status == SWARF_OK) return 0;
    error_raise(state, status);
    return -1;
}

PyObject *call_write(module_state *state, void *context, PyObject *path, PyObject *progress,
                     swarf_status (*write)(void *context, const char *path, const swarf_progress *progress))
{
    native_call call;
    int failed = call_begin(&call, progress);
    if (!failed) {
        const swarf_status status = write(context, PyBytes_AsString(path), &call.progress);
        failed = call_end(&call, state, status);
    }
    Py_DECREF(path);
    if (failed) return NULL;
    Py_RETURN_NONE;
}
