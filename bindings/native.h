/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Inside of the Python extension `swarf._native`: its state, and what its files offer each other.
 *
 * Limited API of CPython 3.11, multi-phase init, heap types that cannot be subclassed (so that a type leads to the
 * module's state), no static objects. Every file is one noun; each type wraps one handle of libswarf.
 */
#ifndef SWARF_BINDINGS_NATIVE_H
#define SWARF_BINDINGS_NATIVE_H

#define PY_SSIZE_T_CLEAN
#define Py_LIMITED_API 0x030B0000
#include <Python.h>

#include <stddef.h>
#include <string.h>

#include "swarf/swarf.h"

/* ---- module.c ---- */

typedef struct module_state {
    PyTypeObject *cutter;
    PyTypeObject *program;
    PyTypeObject *stock;
    PyTypeObject *simulation;
    PyTypeObject *mesh;
    PyTypeObject *camera;
    PyTypeObject *scene;
    PyTypeObject *surface;
    PyTypeObject *picture;
    PyTypeObject *view;
    PyTypeObject *finding; /* struct sequences */
    PyTypeObject *comparison;
    PyTypeObject *cluster;
    PyTypeObject *check;
    PyTypeObject *check_finding;
    PyTypeObject *solid;
    PyTypeObject *deviation;
    PyTypeObject *shell;
    PyTypeObject *contour;
    PyTypeObject *history;
    PyTypeObject *held;
    PyTypeObject *pick;
    PyTypeObject *lump;
    PyObject *error; /* exceptions, see error.c */
    PyObject *format_error;
    PyObject *geometry_error;
    PyObject *cancelled;
    PyObject *busy_error;
} module_state;

/** State of the module that made this type. */
module_state *state_of_type(PyTypeObject *type);
/** State of the module that made this object's type. */
module_state *state_of(PyObject *self);

/** Give an object of one of our heap types back. */
void object_free(PyObject *self);

/** Number of `text` among `names`; -1 with a ValueError that lists them. */
int choice_find(const char *what, const char *text, const char *const *names, int count);

/** Cast of a function with keywords to the slot's type. */
#define WITH_KEYWORDS(function) ((PyCFunction)(void (*)(void))(function))

/* ---- error.c ---- */

/** Make the exception classes and add them to the module. */
int error_setup(PyObject *module, module_state *state);
/** Raise what a failed status and swarf_error_last() say; always returns NULL. */
PyObject *error_raise(module_state *state, swarf_status status);

/* ---- call.c ---- */

/** A native call that runs without the GIL, with progress, signals and cancelling. */
typedef struct native_call {
    swarf_progress progress; /* pass &call.progress to the library */
    PyObject *callback;      /* borrowed; NULL: none */
    PyThreadState *thread;
    PyObject *type, *value, *traceback; /* exception that the callback or a signal handler raised */
} native_call;

/** Check the callback (None, NULL or callable), then release the GIL. 0, or -1 with an exception and the GIL held. */
int call_begin(native_call *call, PyObject *callback);
/** Take the GIL back and raise what went wrong. 0, or -1 with an exception. */
int call_end(native_call *call, module_state *state, swarf_status status);
/** Run `write` on `handle` and `path` (bytes, as PyUnicode_FSConverter gives it; its reference is taken). None, or NULL
 *  with an exception. */
PyObject *call_write(module_state *state, void *context, PyObject *path, PyObject *progress,
                     swarf_status (*write)(void *context, const char *path, const swarf_progress *progress));

/* ---- buffer.c ---- */

/** A converter for PyArg: a whole number to a Py_ssize_t, one beyond its range to the end of that. 0 with an exception.
 */
int count_read(PyObject *object, void *out);

extern PyType_Spec buffer_view_spec;

/** Three finite numbers of a sequence. 0, or -1 with an exception that begins with `name`. */
int buffer_point(PyObject *object, const char *name, double out[3]);
/** A table of finite numbers with `columns` columns: a buffer of 2 dimensions and a number format in native byte
 *  order, strided or not, or a sequence of sequences. *out is freed with PyMem_Free(). 0, or -1 with an exception. */
int buffer_doubles(PyObject *object, const char *name, Py_ssize_t columns, double **out, size_t *rows);
/** The same for whole numbers 0 .. 2^32 - 1. */
int buffer_indices(PyObject *object, const char *name, Py_ssize_t columns, uint32_t **out, size_t *rows);
/** Read-only memoryview of rows x columns items (columns 0: one dimension) inside `owner`, which it keeps alive.
 *  `pins` (may be NULL) is a counter in the owner that is raised while the view lives. */
PyObject *buffer_view(module_state *state, PyObject *owner, const void *data, const char *format, size_t itemsize,
                      size_t rows, size_t columns, Py_ssize_t *pins);

/* ---- cutter.c ---- */

typedef struct cutter_object {
    PyObject_HEAD swarf_cutter *handle;
} cutter_object;
extern PyType_Spec cutter_spec;

/* ---- program.c ---- */

typedef struct program_object {
    PyObject_HEAD swarf_program *handle;
    Py_ssize_t exports; /* views of its arrays: they must not move */
    Py_ssize_t readers; /* calls without the GIL that read it */
    PyObject *notes;    /* tuple of what its reader had to say; NULL: none */
} program_object;

/** Program.read_gcode(), parse_gcode() and check_gcode(); class methods. In gcode.c. */
PyObject *gcode_read(PyObject *type, PyObject *args, PyObject *keywords);
PyObject *gcode_parse(PyObject *type, PyObject *args, PyObject *keywords);
PyObject *gcode_check(PyObject *type, PyObject *args, PyObject *keywords);
/** A new Program that owns `handle`, released on failure. */
PyObject *program_wrap(PyTypeObject *type, swarf_program *handle);
extern PyType_Spec program_spec;

/** Check first and count against the program's moves; `count` None means up to the end. */
int program_range(program_object *program, Py_ssize_t first, PyObject *count, size_t *first_out, size_t *count_out);

/* ---- stock.c ---- */

typedef struct stock_object {
    PyObject_HEAD swarf_stock *handle;
} stock_object;
extern PyType_Spec stock_spec;

/** End a call that makes a stock: a Stock of this type, or NULL with an exception and the handle destroyed. */
PyObject *stock_wrap(PyTypeObject *type, native_call *call, swarf_status status, swarf_stock *handle);

/** ((x, y, z), (x, y, z)), or None when the box is empty. */
PyObject *box_to_python(const swarf_box *box);

/* ---- lumps.c ---- */

extern PyStructSequence_Desc lump_desc;
extern const char stock_lumps_doc[];
PyObject *stock_lumps(PyObject *self, PyObject *args, PyObject *keywords);

/* ---- tools.c ---- */

/** The tool table of a dict {number: Cutter}; it holds its own references, for the dict may change meanwhile. */
int tools_read(module_state *state, PyObject *dict, swarf_tool **out, size_t *count);
void tools_free(swarf_tool *tools, size_t count);

/* ---- simulation.c ---- */

extern PyType_Spec simulation_spec;
extern PyStructSequence_Desc finding_desc;
/** A Simulation; `owner` keeps the handle alive, NULL: it is the object's own. NULL with an exception. */
PyObject *simulation_wrap(module_state *state, const swarf_simulation *handle, PyObject *owner);
extern const char stock_simulate_doc[];
PyObject *stock_simulate(PyObject *self, PyObject *args, PyObject *keywords);

/* ---- history.c ---- */

extern PyType_Spec history_spec;
extern PyStructSequence_Desc held_desc;

/* ---- picture.c ---- */

extern PyType_Spec picture_spec;
/** A Picture as large as the options say, with memory for the buffers named in a sequence; fills `out` with where they
 *  are. NULL with an exception. */
PyObject *picture_create(module_state *state, const swarf_picture_options *options, PyObject *names,
                         swarf_picture_buffers *out);
extern const char stock_picture_doc[];
PyObject *stock_picture(PyObject *self, PyObject *args, PyObject *keywords);
extern const char stock_cast_doc[];
PyObject *stock_cast(PyObject *self, PyObject *args, PyObject *keywords);

/* ---- camera.c ---- */

typedef struct camera_object {
    PyObject_HEAD swarf_camera camera;
} camera_object;
extern PyType_Spec camera_spec;

/** Names of the views, SWARF_VIEW_COUNT of them. */
extern const char *const view_names[];
/** A box from ((x, y, z), (x, y, z)), or an empty one from None. 0, or -1 with an exception. */
int camera_box(PyObject *box, swarf_box *out);

/* ---- scene.c ---- */

extern PyType_Spec scene_spec;
extern PyStructSequence_Desc pick_desc;

/* ---- surface.c ---- */

typedef struct surface_object {
    PyObject_HEAD swarf_surface *handle;
    program_object *program; /* kept from growing */
    PyObject *before;        /* Surface of the set-up before, whose program is kept from growing too; NULL: none */
} surface_object;
extern PyType_Spec surface_spec;
/** A Surface that takes over a handle (NULL with an exception: gives up the rest) and a reference to its program, whose
 *  `exports` were raised; `before` may be NULL. */
PyObject *surface_wrap(PyTypeObject *type, swarf_surface *handle, program_object *program, PyObject *before);
/** What makes the handle of a Surface, of a first stock or of a surface before. */
typedef swarf_status surface_maker(const void *context, const swarf_program *program, const swarf_tool *tools,
                                   size_t tool_count, const swarf_progress *progress, swarf_surface **out);
/** A Surface of a Program and a dict of tools. */
PyObject *surface_make(PyTypeObject *type, PyObject *program, PyObject *tools, PyObject *progress, PyObject *before,
                       surface_maker *make, const void *context);

/* ---- placement.c: methods of Stock, Surface and Mesh ---- */

extern const char stock_placed_doc[], surface_next_doc[], mesh_origins_doc[], mesh_faces_doc[], mesh_placed_doc[];
PyObject *stock_placed(PyObject *self, PyObject *args, PyObject *keywords);
PyObject *surface_next(PyObject *self, PyObject *args, PyObject *keywords);
PyObject *mesh_placed(PyObject *self, PyObject *placement);
PyObject *mesh_origins(PyObject *self, PyObject *args, PyObject *keywords);
PyObject *mesh_faces(PyObject *self, PyObject *args, PyObject *keywords);

/* ---- mesh.c ---- */

typedef struct mesh_object {
    PyObject_HEAD swarf_mesh *handle;
    int from_stock; /* whether `contour` holds */
    swarf_contour_report contour;
} mesh_object;
extern PyType_Spec mesh_spec;
/** A Mesh that takes over a reference, also on failure. */
PyObject *mesh_wrap(PyTypeObject *type, swarf_mesh *handle);

/* ---- measures.c: methods of Mesh ---- */

extern PyStructSequence_Desc shell_desc, contour_desc;
extern const char mesh_measure_doc[], mesh_shells_doc[], mesh_keep_shells_doc[], mesh_split_shells_doc[],
    mesh_section_doc[], mesh_split_doc[], mesh_thickness_doc[];
PyObject *mesh_measure(PyObject *self, PyObject *none);
PyObject *mesh_shells(PyObject *self, PyObject *none);
PyObject *mesh_keep_shells(PyObject *self, PyObject *list);
PyObject *mesh_split_shells(PyObject *self, PyObject *args, PyObject *keywords);
PyObject *mesh_section(PyObject *self, PyObject *args, PyObject *keywords);
PyObject *mesh_split(PyObject *self, PyObject *args, PyObject *keywords);
PyObject *mesh_thickness(PyObject *self, PyObject *args, PyObject *keywords);
PyObject *mesh_contour(PyObject *self, void *closure);
/** A Contour. */
PyObject *contour_tuple(module_state *state, const swarf_contour_report *report);

/* ---- mesh.c ---- */

extern PyStructSequence_Desc comparison_desc;
extern const char compare_volume_doc[];
PyObject *compare_volume(PyObject *module, PyObject *args, PyObject *keywords);

/* ---- deviation.c ---- */

typedef struct solid_object {
    PyObject_HEAD swarf_solid *handle;
} solid_object;
extern PyType_Spec solid_spec;
extern PyType_Spec deviation_spec;
extern PyStructSequence_Desc cluster_desc;
extern const char measure_deviation_doc[];
PyObject *measure_deviation(PyObject *module, PyObject *args, PyObject *keywords);
extern const char compare_overlap_doc[];
PyObject *compare_overlap(PyObject *module, PyObject *args, PyObject *keywords);
extern const char compare_place_doc[];
PyObject *compare_place(PyObject *module, PyObject *args, PyObject *keywords);
extern const char picture_colour_doc[];
PyObject *picture_colour(PyObject *module, PyObject *args, PyObject *keywords);
extern const char deviation_colours_doc[];
PyObject *deviation_colours(PyObject *module, PyObject *args, PyObject *keywords);

/** A struct sequence of these items, which it takes over; NULL with an exception when one of them is NULL. */
PyObject *make_sequence(PyTypeObject *type, PyObject **items, Py_ssize_t count);

/* ---- check.c ---- */

extern PyStructSequence_Desc check_finding_desc;
extern PyType_Spec check_spec;
extern const char stock_check_doc[];
PyObject *stock_check(PyObject *self, PyObject *args, PyObject *keywords);

#endif
