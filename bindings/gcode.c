/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Reading G-code: Program.read_gcode(), parse_gcode() and check_gcode(), which differ in where the text comes from and
 * in what becomes of an error.
 */
#include "native.h"

#include <stdlib.h>

static const char *const unit_names[] = {"mm", "inch"};
static const char *const note_names[] = {"error", "warning", "message"};

/** One reading, with what it owns. */
typedef struct reading {
    swarf_gcode_options options;
    PyObject *path, *tool_path, *parameters;
    swarf_gcode_tool *tools;
    swarf_gcode_diameter *diameters;
    native_call call;
} reading;

/** The keywords that all three share, as they are given. */
typedef struct keywords {
    PyObject *start, *tools, *diameters, *parameters, *progress;
    const char *dialect, *unit, *search;
    int block_delete;
    Py_ssize_t line_limit;
} keywords;

#define KEYWORD_NAMES                                                                                                  \
    "start", "dialect", "tools", "diameters", "parameters", "machine_unit", "search", "block_delete", "line_limit",    \
        "progress", NULL
#define KEYWORD_FORMAT "OsOOOszpnO"
#define KEYWORD_PLACES(k)                                                                                              \
    &(k).start, &(k).dialect, &(k).tools, &(k).diameters, &(k).parameters, &(k).unit, &(k).search, &(k).block_delete,  \
        &(k).line_limit, &(k).progress
#define KEYWORD_DEFAULTS                                                                                               \
    {                                                                                                                  \
        .dialect = swarf_gcode_dialect_name(SWARF_DIALECT_LINUXCNC), .unit = unit_names[0]                             \
    }

static void reading_end(reading *r)
{
    Py_XDECREF(r->path);
    Py_XDECREF(r->tool_path);
    Py_XDECREF(r->parameters);
    swarf_gcode_tools_free(r->tools);
    free(r->diameters);
    swarf_notes_destroy(r->options.notes);
}

/** (number, diameter, length) rows. */
static int tools_from_rows(reading *r, PyObject *object)
{
    PyObject *rows = PySequence_List(object);
    if (!rows) return -1;
    const Py_ssize_t count = PyList_Size(rows);
    r->tools = calloc((size_t)count + 1, sizeof *r->tools);
    int failed = r->tools == NULL;
    if (failed) PyErr_NoMemory();
    for (Py_ssize_t i = 0; i < count && !failed; i++) {
        PyObject *row = PySequence_Tuple(PyList_GetItem(rows, i));
        swarf_gcode_tool *tool = &r->tools[i];
        failed = !row || !PyArg_ParseTuple(row, "idd;tools: rows of number, diameter and length", &tool->number,
                                           &tool->diameter_mm, &tool->offset[2]);
        Py_XDECREF(row);
    }
    Py_DECREF(rows);
    r->options.tools = r->tools;
    r->options.tool_count = (size_t)count;
    return failed ? -1 : 0;
}

static int is_path(PyObject *object)
{
    if (PyUnicode_Check(object) || PyBytes_Check(object)) return 1;
    PyObject *method = PyObject_GetAttrString(object, "__fspath__");
    if (!method) PyErr_Clear();
    Py_XDECREF(method);
    return method != NULL;
}

static int reading_tools(reading *r, PyTypeObject *type, PyObject *tools, double unit_mm)
{
    if (!tools || tools == Py_None) return 0;
    if (!is_path(tools)) return tools_from_rows(r, tools);
    if (!PyUnicode_FSConverter(tools, &r->tool_path)) return -1;
    const swarf_status status =
        swarf_gcode_tools_read(PyBytes_AsString(r->tool_path), unit_mm, &r->tools, &r->options.tool_count);
    if (status) return error_raise(state_of_type(type), status), -1;
    r->options.tools = r->tools;
    return 0;
}

/** {number: diameter}. */
static int reading_diameters(reading *r, PyObject *diameters)
{
    if (!diameters || diameters == Py_None) return 0;
    PyObject *items = PyMapping_Items(diameters);
    if (!items && PyErr_ExceptionMatches(PyExc_AttributeError))
        PyErr_SetString(PyExc_TypeError, "diameters: a dict of tool numbers is wanted");
    if (!items) return -1;
    const Py_ssize_t count = PyList_Size(items);
    r->diameters = calloc((size_t)count + 1, sizeof *r->diameters);
    int failed = r->diameters == NULL;
    if (failed) PyErr_NoMemory();
    for (Py_ssize_t i = 0; i < count && !failed; i++) {
        PyObject *item = PySequence_Tuple(PyList_GetItem(items, i));
        failed = !item || !PyArg_ParseTuple(item, "id;diameters: a number and its diameter", &r->diameters[i].number,
                                            &r->diameters[i].mm);
        Py_XDECREF(item);
    }
    Py_DECREF(items);
    r->options.diameters = r->diameters;
    r->options.diameter_count = (size_t)count;
    return failed ? -1 : 0;
}

static int dialect_find(const char *text)
{
    const char *names[16];
    int count = 0;
    while (count < 16 && (names[count] = swarf_gcode_dialect_name((swarf_gcode_dialect)count)) != NULL) count++;
    return choice_find("dialect", text, names, count);
}

static int reading_options(reading *r, PyTypeObject *type, const keywords *k)
{
    if (k->start && k->start != Py_None && buffer_point(k->start, "start", r->options.start)) return -1;
    const int dialect = dialect_find(k->dialect);
    if (dialect < 0) return -1;
    const int unit = choice_find("machine_unit", k->unit, unit_names, 2);
    if (unit < 0) return -1;
    if (k->line_limit < 0) {
        PyErr_SetString(PyExc_ValueError, "line_limit: not a number of lines (0: the usual limit)");
        return -1;
    }
    const double unit_mm = unit ? 25.4 : 1.0;
    r->options.dialect = (swarf_gcode_dialect)dialect;
    r->options.path = k->search;
    r->options.block_delete = k->block_delete;
    r->options.line_limit = (size_t)k->line_limit;
    r->options.parameter_unit_mm = unit_mm;
    if (k->parameters && k->parameters != Py_None) {
        if (!PyUnicode_FSConverter(k->parameters, &r->parameters)) return -1;
        r->options.parameters = PyBytes_AsString(r->parameters);
    }
    if (reading_tools(r, type, k->tools, unit_mm) || reading_diameters(r, k->diameters)) return -1;
    const swarf_status status = swarf_notes_create(&r->options.notes);
    return status ? (error_raise(state_of_type(type), status), -1) : 0;
}

static PyObject *notes_to_python(const swarf_notes *notes)
{
    const size_t count = swarf_notes_count(notes);
    PyObject *result = PyTuple_New((Py_ssize_t)count);
    for (size_t i = 0; result && i < count; i++) {
        const swarf_note note = swarf_notes_get(notes, i);
        PyObject *source = PyUnicode_DecodeUTF8(note.source, (Py_ssize_t)strlen(note.source), "surrogateescape");
        PyObject *text = PyUnicode_DecodeUTF8(note.text, (Py_ssize_t)strlen(note.text), "replace");
        PyObject *item = source && text
                             ? Py_BuildValue("(sOIIO)", note_names[note.kind], source, note.line, note.column, text)
                             : NULL;
        Py_XDECREF(source);
        Py_XDECREF(text);
        if (!item || PyTuple_SetItem(result, (Py_ssize_t)i, item) < 0) Py_CLEAR(result);
    }
    return result;
}

static PyObject *program_with_notes(PyTypeObject *type, swarf_program *handle, const swarf_notes *notes)
{
    PyObject *result = program_wrap(type, handle);
    if (!result) return NULL;
    PyObject *list = notes_to_python(notes);
    if (!list) {
        Py_DECREF(result);
        return NULL;
    }
    ((program_object *)result)->notes = list;
    return result;
}

/** read_gcode() and check_gcode(). */
static PyObject *read_path(PyTypeObject *type, PyObject *args, PyObject *keyword_dict, const char *format, int check)
{
    static char *names[] = {"path", KEYWORD_NAMES};
    reading r = {.options = swarf_gcode_options_default()};
    keywords k = KEYWORD_DEFAULTS;
    PyObject *result = NULL;
    if (!PyArg_ParseTupleAndKeywords(args, keyword_dict, format, names, PyUnicode_FSConverter, &r.path,
                                     KEYWORD_PLACES(k)))
        return NULL;
    if (!reading_options(&r, type, &k) && !call_begin(&r.call, k.progress)) {
        swarf_program *handle = NULL;
        swarf_status status = swarf_gcode_read_file(PyBytes_AsString(r.path), &r.options, &r.call.progress, &handle);
        /* an error that is among the notes is an answer */
        const size_t count = swarf_notes_count(r.options.notes);
        if (check && status == SWARF_ERROR_FORMAT && count &&
            swarf_notes_get(r.options.notes, count - 1).kind == SWARF_NOTE_ERROR)
            status = SWARF_OK;
        if (call_end(&r.call, state_of_type(type), status) == 0) {
            result = check ? notes_to_python(r.options.notes) : program_with_notes(type, handle, r.options.notes);
            if (!check) handle = NULL;
        }
        swarf_program_release(handle);
    }
    reading_end(&r);
    return result;
}

PyObject *gcode_read(PyObject *type, PyObject *args, PyObject *keyword_dict)
{
    return read_path((PyTypeObject *)type, args, keyword_dict, "O&|$" KEYWORD_FORMAT ":read_gcode", 0);
}

PyObject *gcode_check(PyObject *type, PyObject *args, PyObject *keyword_dict)
{
    return read_path((PyTypeObject *)type, args, keyword_dict, "O&|$" KEYWORD_FORMAT ":check_gcode", 1);
}

PyObject *gcode_parse(PyObject *type_object, PyObject *args, PyObject *keyword_dict)
{
    static char *names[] = {"text", "name", KEYWORD_NAMES};
    PyTypeObject *type = (PyTypeObject *)type_object;
    reading r = {.options = swarf_gcode_options_default()};
    keywords k = KEYWORD_DEFAULTS;
    PyObject *result = NULL;
    const char *text, *name = "text";
    Py_ssize_t length;
    /* "s#": a str's own UTF-8 bytes or those of bytes; both immutable and held by the caller's argument tuple. */
    if (!PyArg_ParseTupleAndKeywords(args, keyword_dict, "s#|$s" KEYWORD_FORMAT ":parse_gcode", names, &text, &length,
                                     &name, KEYWORD_PLACES(k)))
        return NULL;
    if (!reading_options(&r, type, &k) && !call_begin(&r.call, k.progress)) {
        swarf_program *handle = NULL;
        const swarf_status status = swarf_gcode_read(text, (size_t)length, name, &r.options, &r.call.progress, &handle);
        if (call_end(&r.call, state_of_type(type), status) == 0) {
            result = program_with_notes(type, handle, r.options.notes);
            handle = NULL;
        }
        swarf_program_release(handle);
    }
    reading_end(&r);
    return result;
}
