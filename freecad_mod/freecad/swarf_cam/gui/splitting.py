# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task panel that splits what is left of a stock by a plane into closed meshes."""

import FreeCAD

from ..app import pieces
from . import taskpanel
from .planepanel import PlanePanel
from .qt import QtWidgets
from .worker import Worker

translate = FreeCAD.Qt.translate

# Of parts in turn, so that one sees where they part; all as bright as the stock.
COLOURS = ((0.62, 0.70, 0.76), (0.83, 0.69, 0.51), (0.63, 0.76, 0.60), (0.74, 0.65, 0.78))


# Pieces that become objects: more are of no use in the tree, and FreeCAD stands still while it makes them.
MOST_PIECES = 100


class SplitPanel(PlanePanel):
    """Task panel for one simulation object."""

    def __init__(self, obj):
        super().__init__("SwarfSplitPanel", translate("Swarf", "Split the stock"), obj)
        self._split = None
        self.each = QtWidgets.QCheckBox(translate("Swarf", "each piece on its own"))
        self.each.setToolTip(translate("Swarf", "What hangs together becomes a mesh, not all on one side of the plane"))
        self.layout.addRow(self.each)
        self.add_progress(self.layout)

    def begin(self):
        """Split in a thread."""
        self.message.setText("")
        self.bar.setRange(0, 1000)
        self.bar.show()
        body, plane, each = self.body, self.plane, self.each.isChecked()
        self._split = body
        self.worker = Worker(lambda progress: body.split(*plane, each, progress, MOST_PIECES), self.show_progress,
                             self.on_end)
        self.worker.start()

    def on_end(self, files, error):
        """The thread is through, with files or an error."""
        cancelled = self.worker.cancelled
        self.worker = None
        self.follow()
        if self.closed:
            return
        if cancelled:
            self.end(translate("Swarf", "Cancelled; nothing was changed."))
            return
        if self._split is not self.body:
            self.end(translate("Swarf", "The stock changed meanwhile; nothing was split."))
            return
        try:
            if error is not None:
                raise error
            made = pieces.add_parts(self.obj, files)
        except Exception as problem:  # the user sees it
            self.fail(problem)
            return
        for number, part in enumerate(made):
            part.ViewObject.ShapeColor = COLOURS[number % len(COLOURS)]
        FreeCAD.Console.PrintMessage(translate("Swarf", "Swarf: in the document: {0}\n").format(
            ", ".join(part.Label for part in made)))
        self.close()


def show_panel(obj):
    """Open the panel, None when another task is open or nothing is left."""
    return taskpanel.show(lambda: SplitPanel(obj))
