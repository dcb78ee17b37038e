# SPDX-License-Identifier: LGPL-2.1-or-later
"""What task panels share that cut what is left of a stock by a plane across an axis: the plane's widgets, and the
curves where it cuts, found in a thread and shown in the 3D view while the plane is moved."""

import FreeCAD

from ..app import pieces
from ..core.section import AXES, Section
from . import numbers
from .curves import Curves
from .qt import QtWidgets, choice
from .taskpanel import TaskPanel
from .worker import Worker

translate = FreeCAD.Qt.translate

DECIMALS = 3

# mm from the origin; farther than any stock lies.
FARTHEST = 1e6


class PlanePanel(TaskPanel):
    """Task panel for one simulation object. found: (plane, polylines) as they were seen last, None before."""

    def __init__(self, name, title, obj):
        super().__init__(name, title)
        self.obj, self.found, self._looking = obj, None, None
        self.body, self._box = pieces.body_of(obj), pieces.box_of(obj)
        self.layout = QtWidgets.QFormLayout(self.form)
        self.axis = choice()
        self.axis.addItems(list(AXES))
        self.axis.setToolTip(translate("Swarf", "Axis that the section is across"))
        self.layout.addRow(translate("Swarf", "Axis"), self.axis)
        self.position = QtWidgets.QDoubleSpinBox()
        self.position.setDecimals(DECIMALS)
        self.position.setRange(-FARTHEST, FARTHEST)
        self.position.setSuffix(" mm")
        self.position.setToolTip(translate("Swarf", "Place of the section"))
        self.layout.addRow(translate("Swarf", "Position"), self.position)
        self.extent = QtWidgets.QLabel()
        self.extent.setWordWrap(True)
        self.layout.addRow(self.extent)
        self.curves = Curves(obj.Document)
        self.position.valueChanged.connect(self._move)
        self.axis.currentIndexChanged.connect(self._show_axis)
        self.axis.setCurrentIndex(AXES.index("Z"))

    def _show_axis(self, axis):
        """Where the stock lies on the axis, and its middle."""
        self.position.setValue(Section(axis).position(self._box))
        lo, hi = (numbers.text(corner[axis], DECIMALS) for corner in self._box)
        self.extent.setText(translate("Swarf", "The stock lies between {0} and {1} mm").format(lo, hi))
        self._move()

    def _move(self, *_):
        """The plane is another one."""
        self.message.setText("")
        self.look()

    @property
    def plane(self):
        """(point, normal) as the widgets tell, the normal along the axis."""
        point, normal = [0.0] * 3, [0.0] * 3
        axis = self.axis.currentIndex()
        point[axis], normal[axis] = self.position.value(), 1.0
        return tuple(point), tuple(normal)

    def look(self, *_):
        """Find the curves of the plane as it is now, unless that is under way: then it is looked at again."""
        if self._looking is None and not self.closed:
            plane = self.plane
            self._looking = Worker(lambda progress: (plane, self.body.section(*plane)), lambda fraction: None,
                                   self._on_look)
            self._looking.start()

    def _on_look(self, found, error):
        self._looking = None
        if self.closed:
            return
        if error is not None:
            self.fail(error)
            return
        if found[0] != self.plane:
            self.look()
            return
        self.found = found
        self.curves.show(found[1])
        self.on_found(found[1])

    def on_found(self, curves):
        """The curves of the plane are known."""

    def gone(self, *_):
        """The widgets are no more, whoever closed the dialog, and the curves neither."""
        super().gone()
        self.curves.remove()

    def close(self):
        """Close the panel once."""
        self.curves.remove()
        super().close()
