# SPDX-License-Identifier: LGPL-2.1-or-later
"""Task panel that adds the wires along which a plane cuts what is left of a stock."""

import FreeCAD
import FreeCADGui as Gui

from ..app import model
from ..core.errors import JobError
from ..core.section import AXES, Section
from . import numbers
from .qt import QtWidgets, choice
from .taskpanel import TaskPanel

translate = FreeCAD.Qt.translate

DECIMALS = 3

# mm from the origin; farther than any stock lies.
FARTHEST = 1e6


class SectionPanel(TaskPanel):
    """Task panel for one simulation object."""

    def __init__(self, obj):
        super().__init__("SwarfSectionPanel", translate("Swarf", "Section of the stock"))
        self.obj = obj
        box = obj.Mesh.BoundBox
        self._box = (box.XMin, box.YMin, box.ZMin), (box.XMax, box.YMax, box.ZMax)
        layout = QtWidgets.QFormLayout(self.form)
        self.axis = choice()
        self.axis.addItems(list(AXES))
        self.axis.setToolTip(translate("Swarf", "Axis that the section is across"))
        layout.addRow(translate("Swarf", "Axis"), self.axis)
        self.position = QtWidgets.QDoubleSpinBox()
        self.position.setDecimals(DECIMALS)
        self.position.setRange(-FARTHEST, FARTHEST)
        self.position.setSuffix(" mm")
        self.position.setToolTip(translate("Swarf", "Place of the section"))
        layout.addRow(translate("Swarf", "Position"), self.position)
        self.extent = QtWidgets.QLabel()
        self.extent.setWordWrap(True)
        layout.addRow(self.extent)
        self.add_progress(layout)
        self.axis.currentIndexChanged.connect(self._show_axis)
        self.axis.setCurrentIndex(AXES.index("Z"))

    def _show_axis(self, axis):
        """Where the stock lies on the axis, and its middle."""
        self.position.setValue(Section(axis).position(self._box))
        lo, hi = (numbers.text(corner[axis], DECIMALS) for corner in self._box)
        self.extent.setText(translate("Swarf", "The stock lies between {0} and {1} mm").format(lo, hi))

    def begin(self):
        """Add the wires; the panel stays where there are none."""
        section = Section(self.axis.currentIndex())
        (_, normal), = section.planes(self._box)
        point = [0.0] * 3
        point[section.axis] = self.position.value()
        try:
            made = model.add_section(self.obj, point, normal)
        except (JobError, ValueError, RuntimeError) as error:
            self.fail(error)
            return
        FreeCAD.Console.PrintMessage(translate("Swarf", "Swarf: in the document: {0}\n").format(made.Label))
        self.close()


def show_panel(obj):
    """Open the panel, None when another task is open."""
    if Gui.Control.activeDialog():
        FreeCAD.Console.PrintError(translate("Swarf", "Swarf: close the open task first\n"))
        return None
    panel = SectionPanel(obj)
    Gui.Control.showDialog(panel)
    return panel
