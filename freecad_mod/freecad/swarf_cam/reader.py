# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reader of .FCStd files for the command line: entry point "fcstd" of the group "swarf.readers", and
reader of designs: group "swarf.designs".

FreeCAD brings its own Python on some systems, so the document is opened by freecadcmd in a process of its own, from a
copy and with an empty user folder: neither the user's file nor his settings are touched.
"""

import os
import shutil
import subprocess
import tempfile
import zipfile

from .core import exchange
from .core.errors import JobError

NAMES = ("freecadcmd", "FreeCADCmd", "freecadcmd-python3", "freecad.cmd")
HELP = ("FreeCAD is needed to read .FCStd and CAD files, and no freecadcmd was found: install FreeCAD "
        "(Debian: apt install freecad) or set SWARF_FREECADCMD to its freecadcmd")

# How often a running freecadcmd is looked at, seconds.
POLL_SECONDS = 0.1


def find_freecadcmd():
    """Path of FreeCAD's command line program. JobError tells how to get it."""
    chosen = os.environ.get("SWARF_FREECADCMD")
    if chosen:
        found = shutil.which(chosen)
        if not found:
            raise JobError("SWARF_FREECADCMD is '%s', which is not a program" % chosen)
        return found
    for name in NAMES:
        found = shutil.which(name)
        if found:
            return found
    raise JobError(HELP)


def _run(command, environment, log, progress):
    """Run to the end, calling progress meanwhile, which can stop the work by a true answer or an exception."""
    with open(log, "wb") as output:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                                   env=environment)
        try:
            while True:
                try:
                    return process.wait(POLL_SECONDS)
                except subprocess.TimeoutExpired:
                    if progress is not None and progress(0.0):
                        raise JobError("cancelled while FreeCAD was reading the job") from None
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()


def _export(path, variables, read_answer, progress):
    """Have a copy of a file exported by freecadcmd, as these variables say; what read_answer(folder) makes of it."""
    program = find_freecadcmd()
    with tempfile.TemporaryDirectory(prefix="swarf-") as folder:
        home, answer = os.path.join(folder, "home"), os.path.join(folder, "answer")
        os.mkdir(home)
        os.mkdir(answer)
        copy = os.path.join(folder, "document" + os.path.splitext(path)[1])
        shutil.copyfile(path, copy)
        environment = dict(os.environ, FREECAD_USER_HOME=home, SWARF_EXPORT_INPUT=copy, SWARF_EXPORT_FOLDER=answer)
        environment.update(variables)
        parent = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
        code = ("import sys; sys.path.insert(0, %r); from swarf_cam.app import export; export.main()" % parent)
        log = os.path.join(folder, "log")
        status = _run([program, "-c", code], environment, log, progress)
        try:
            return read_answer(answer)
        except JobError as error:
            text = str(error)
            if not os.path.exists(os.path.join(answer, "error.json")):
                with open(log, "rb") as file:
                    lines = file.read().decode(errors="replace").strip().splitlines()
                text += " (%s, status %d): %s" % (program, status, " ".join(lines[-3:]))
            raise JobError("%s: %s" % (path, text)) from error


def _check_document(path):
    with open(path, "rb") as file:
        if not zipfile.is_zipfile(file):
            raise JobError("%s: is not a FreeCAD document, or is cut off" % path)


def read_data(path, job=None, progress=None):
    """core JobData of a job in a .FCStd file; no native module is needed.

    job: name or label, None for the only one. progress: called with 0.0 while FreeCAD works; a true answer or an
    exception, which comes out, stops FreeCAD. OSError when the file cannot be read, JobError for all else.
    """
    _check_document(path)
    return _export(path, {"SWARF_EXPORT_JOB": job or "", "SWARF_EXPORT_DEFLECTION": ""}, exchange.read, progress)


def read_design(path, deflection_mm, progress=None):
    """swarf.Mesh of the solids in a STEP, IGES, BREP or .FCStd file, its triangles no farther from the faces than
    deflection_mm; progress and errors as read_data()."""
    from .native import to_mesh

    path = os.fspath(path)
    with open(path, "rb"):
        pass  # who cannot read it should not wait for FreeCAD to say so
    if path.lower().endswith(".fcstd"):
        _check_document(path)
    return to_mesh(_export(path, {"SWARF_EXPORT_DEFLECTION": repr(float(deflection_mm))}, exchange.read_design,
                           progress))


def read(path, job=None, progress=None):
    """swarf.Job of a job in a .FCStd file; arguments and errors as read_data()."""
    from .native import to_job  # needs the native module, which read_data() does not

    return to_job(read_data(os.fspath(path), job, progress))
