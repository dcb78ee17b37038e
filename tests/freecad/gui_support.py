# SPDX-License-Identifier: LGPL-2.1-or-later
"""What tests in the real GUI share: let it live, look at it, end it. Screenshots and the verdict PASSED or FAILED go
to $SWARF_GUI_OUT."""

import os
import sys
import threading
import time
import traceback

import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore

try:
    from PySide import QtWidgets
except ImportError:  # FreeCAD 0.20
    from PySide import QtGui as QtWidgets

OUT = os.environ["SWARF_GUI_OUT"]

# The CAM workbench asks about units at its first activation unless the schema has minutes (6: small parts and CNC).
FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Units").SetInt("UserSchema", 6)
for group in ("Path", "CAM"):
    FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/" + group).SetBool("WarningSuppressVelocity", True)
# An error would make the report view pop up, and every widget another size.
FreeCAD.ParamGet("User parameter:BaseApp/Preferences/OutputWindow").SetBool("checkShowReportViewOnError", False)

# More than anything takes on the busiest machine.
WAIT_SECONDS = 240

# What Qt's slots, timers and threads raised: nobody else would notice.
_raised = []


def _record(kind, error, trace):
    _raised.append("".join(traceback.format_exception(kind, error, trace)))
    print(_raised[-1])


sys.excepthook = _record
threading.excepthook = lambda arguments: _record(arguments.exc_type, arguments.exc_value, arguments.exc_traceback)


def live():
    """Let the GUI live for a moment."""
    QtWidgets.QApplication.processEvents()
    time.sleep(0.01)


def pump(seconds):
    """Let the GUI live for a while. What is to come of it is waited for by wait_for(): how much comes in a while
    depends on the machine."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        live()


def wait_for(condition, what):
    """Let the GUI live until a condition holds, and not a turn of the event loop longer."""
    end = time.monotonic() + WAIT_SECONDS
    while not condition():
        assert time.monotonic() < end, "timeout: " + what
        live()


def screenshot(name):
    """The whole screen: widgets do not hold what OpenGL drew."""
    pump(0.5)
    QtWidgets.QApplication.primaryScreen().grabWindow(0).save(os.path.join(OUT, name))


def run(check):
    """Check, tell, end."""
    verdict = "FAILED"
    try:
        check()
        assert not _raised, "%d exceptions in slots or threads, the first:\n%s" % (len(_raised), _raised[0])
        verdict = "PASSED"
    except BaseException:
        traceback.print_exc()
        screenshot("failed.png")
    with open(os.path.join(OUT, "verdict"), "w") as file:
        file.write(verdict + "\n")
    print("GUI TEST", verdict)
    sys.stdout.flush()
    for name in list(FreeCAD.listDocuments()):
        FreeCAD.closeDocument(name)
    if verdict != "PASSED":
        os._exit(1)
    Gui.getMainWindow().close()


def watch():
    """A modal dialog would stop the test: show it and close it."""
    dialog = QtWidgets.QApplication.activeModalWidget()
    if dialog is not None:
        print("MODAL", type(dialog).__name__, dialog.windowTitle(), getattr(dialog, "text", lambda: "")())
        dialog.grab().save(os.path.join(OUT, "modal.png"))
        dialog.close()


def start(check):
    """Run a check once FreeCAD has started."""
    timer = QtCore.QTimer(Gui.getMainWindow())
    timer.timeout.connect(watch)
    timer.start(2000)
    QtCore.QTimer.singleShot(1500, lambda: run(check))
