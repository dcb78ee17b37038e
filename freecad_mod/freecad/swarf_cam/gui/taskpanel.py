# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the add-on's task panels share: they read the document between the events, then work in a thread, say how far
they are and can be broken off."""

import FreeCAD
import FreeCADGui as Gui

from ..core.errors import JobError
from .qt import QtWidgets, flags

translate = FreeCAD.Qt.translate


class TaskPanel:
    """form: what is shown. reading: the Slices that read the document, worker: the Worker of the thread; None when
    there is none. bar and message: the last rows, from add_progress(). begin() and end() are the panel's own."""

    def __init__(self, name, title):
        self.reading = self.worker = None
        self.closed = False
        self.form = QtWidgets.QWidget()
        self.form.setObjectName(name)
        self.form.setWindowTitle(title)
        self.form.destroyed.connect(self.gone)
        self.bar = QtWidgets.QProgressBar()
        self.message = QtWidgets.QLabel()

    def add_progress(self, layout):
        """Add the rows that tell of the work."""
        self.bar.setRange(0, 1000)
        self.bar.hide()
        layout.addRow(self.bar)
        self.message.setWordWrap(True)
        layout.addRow(self.message)

    def begin(self):
        """Start the work, as the user wants it."""
        raise NotImplementedError

    def end(self, text):
        """Ready to begin again, with something to say; no one is told once the panel is closed."""
        if not self.closed:
            self.bar.hide()
            self.message.setText(text)

    def getStandardButtons(self):
        """OK and Cancel."""
        return flags(QtWidgets.QDialogButtonBox.Ok, QtWidgets.QDialogButtonBox.Cancel)

    @property
    def working(self):
        """Whether it reads or works."""
        return self.reading is not None or self.worker is not None

    def accept(self):
        """Start; the panel stays until the end."""
        if not self.working:
            self.begin()
        return False

    def reject(self):
        """Cancel the work, or close the panel when there is none."""
        if self.reading is not None:
            self.reading.cancel()
            self.reading = None
            self.end(translate("Swarf", "Cancelled; nothing was changed."))
            return False
        if self.worker is not None:
            self.worker.cancel()
            self.message.setText(translate("Swarf", "Cancelling ..."))
            return False
        self.close()
        return True

    def show_progress(self, fraction):
        """Fraction done."""
        if not self.closed:
            self.bar.setValue(int(1000 * fraction))

    def gone(self, *_):
        """The widgets are no more, whoever closed the dialog."""
        self.closed = True
        if self.worker is not None:
            self.worker.cancel()
        self.release()

    def release(self):
        """Let go of what is not in the panel, when it closes; may be called twice."""

    def fail(self, error):
        """In the panel, where the user looks, and in the report view, where it stays."""
        text = str(error) or type(error).__name__
        self.end(text)
        FreeCAD.Console.PrintError("Swarf: %s\n" % text)

    def close(self):
        """Close the panel once."""
        if not self.closed:
            self.closed = True
            self.release()
            Gui.Control.closeDialog()


def show(make):
    """Open the panel that make() makes -> it; None when another task is open, or there is nothing for it to do, which
    the report view tells."""
    if Gui.Control.activeDialog():
        FreeCAD.Console.PrintError(translate("Swarf", "Swarf: close the open task first\n"))
        return None
    try:
        panel = make()
    except JobError as error:
        FreeCAD.Console.PrintError("Swarf: %s\n" % error)
        return None
    Gui.Control.showDialog(panel)
    return panel
