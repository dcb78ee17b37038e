# SPDX-License-Identifier: LGPL-2.1-or-later
"""What task panels share that cut what is left of a stock by a plane across an axis: the plane's widgets, and the
curves where it cuts, found in a thread and shown in the 3D view while the plane is moved."""

import FreeCAD

from ..core.section import AXES, Section
from . import numbers
from .bodypanel import BodyPanel
from .curves import Curves
from .qt import QtWidgets, choice
from .worker import Worker

translate = FreeCAD.Qt.translate

DECIMALS = 3

# mm from the origin; farther than any stock lies.
FARTHEST = 1e6


class PlanePanel(BodyPanel):
    """Task panel for one simulation object. found: (plane, polylines) as they were seen last, None before."""

    def __init__(self, name, title, obj):
        self.found = self.curves = None
        self._looking = self._looked = None
        super().__init__(name, title, obj)
        self.layout = QtWidgets.QFormLayout(self.form)
        self.axis = choice()
        self.axis.addItems(list(AXES))
        self.axis.setToolTip(translate("Swarf", "Axis that the plane is across"))
        self.layout.addRow(translate("Swarf", "Axis"), self.axis)
        self.position = QtWidgets.QDoubleSpinBox()
        self.position.setDecimals(DECIMALS)
        self.position.setRange(-FARTHEST, FARTHEST)
        self.position.setSuffix(" mm")
        self.position.setToolTip(translate("Swarf", "Place of the plane on the axis"))
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
        self.position.setValue(Section(axis).position(self.box))
        self._show_extent()
        self._move()

    def _show_extent(self):
        lo, hi = (numbers.text(corner[self.axis.currentIndex()], DECIMALS) for corner in self.box)
        self.extent.setText(translate("Swarf", "The stock lies between {0} and {1} mm").format(lo, hi))

    def renew(self):
        """The curves are others; the plane stays."""
        self.found = None
        self._show_extent()
        self.look()

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

    @property
    def sought(self):
        """The plane whose curves are to be found."""
        return self.plane

    def look(self, *_):
        """Find the curves of the plane that is sought now, unless that is under way: then it is looked at again."""
        if self._looking is None and not self.closed:
            body, plane = self._looked = self.body, self.sought
            self._looking = Worker(lambda progress: body.section(*plane), lambda fraction: None, self._on_look)
            self._looking.start()

    def _on_look(self, curves, error):
        self._looking = None
        self.follow()
        if self.closed or self._looking is not None:
            return
        plane = self.sought
        if self._looked != (self.body, plane):
            self.look()
            return
        if error is not None:
            self.fail(error)
        else:
            self.found = plane, curves
            self.curves.show(curves)
            self.on_found(curves)
        if not self.closed and self.sought != plane:
            self.look()

    def on_found(self, curves):
        """The curves of the plane are known."""

    def release(self):
        """Nor are there curves."""
        super().release()
        if self.curves is not None:
            self.curves.remove()
