# SPDX-License-Identifier: LGPL-2.1-or-later
"""The row that places the section plane; shown while the stock is cut open."""

import FreeCAD

from ...core.section import AXES, Section
from .. import icons
from ..qt import QtCore, QtWidgets

translate = FreeCAD.Qt.translate

# Steps of the slider from one side of the stock to the other.
STEPS = 1000


class SectionRow(QtWidgets.QWidget):
    """Tells by changed that planes() has other ones."""

    changed = QtCore.Signal()

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfSection")
        self._section, self._box, self._showing = Section(), None, False
        row = QtWidgets.QHBoxLayout(self)
        row.setContentsMargins(8, 0, 8, 3)
        self.axis = QtWidgets.QComboBox()
        self.axis.setObjectName("SwarfSectionAxis")
        self.axis.setToolTip(translate("Swarf", "Axis that the section is across"))
        self.axis.addItems(list(AXES))
        self.axis.setCurrentIndex(self._section.axis)
        self.axis.currentIndexChanged.connect(self._set_axis)
        row.addWidget(self.axis)
        self.slider = QtWidgets.QSlider(QtCore.Qt.Horizontal)
        self.slider.setObjectName("SwarfSectionSlider")
        self.slider.setAccessibleName(translate("Swarf", "Place of the section"))
        self.slider.setRange(0, STEPS)
        self.slider.valueChanged.connect(self._slide)
        row.addWidget(self.slider, 1)
        self.position = QtWidgets.QDoubleSpinBox()
        self.position.setObjectName("SwarfSectionPosition")
        self.position.setToolTip(translate("Swarf", "Place of the section"))
        self.position.setDecimals(2)
        self.position.setSuffix(" mm")
        self.position.setKeyboardTracking(False)
        self.position.valueChanged.connect(self._type)
        row.addWidget(self.position)
        self.flip = QtWidgets.QToolButton()
        self.flip.setObjectName("SwarfSectionFlip")
        self.flip.setToolTip(translate("Swarf", "Take the other side away"))
        self.flip.setAutoRaise(True)
        self.flip.setCheckable(True)
        self.flip.toggled.connect(self._set_flipped)
        row.addWidget(self.flip)
        self._take_theme()

    def open(self, box):
        """A job's box; the plane keeps its axis, its side and its share of the way."""
        self._box = box
        self._show_values()

    def planes(self):
        """((point, normal),) for Scene.render, () while the row is hidden."""
        return () if self.isHidden() or self._box is None else self._section.planes(self._box)

    def _show_values(self):
        if self._box is None:
            return
        self._showing = True
        axis = self._section.axis
        self.position.setRange(self._box[0][axis], self._box[1][axis])
        self.position.setSingleStep((self._box[1][axis] - self._box[0][axis]) / 100)
        self.position.setValue(self._section.position(self._box))
        self.slider.setValue(round(STEPS * self._section.share))
        self._showing = False
        self.changed.emit()

    def _set_axis(self, index):
        self._section.axis = index
        self._show_values()

    def _slide(self, value):
        if not self._showing:
            self._section.share = value / STEPS
            self._show_values()

    def _type(self, value):
        if not self._showing and self._box is not None:
            self._section.move_to(self._box, value)
            self._show_values()

    def _set_flipped(self, on):
        self._section.flipped = on
        self.changed.emit()

    def _take_theme(self):
        self.flip.setIcon(icons.icon("flip", self.palette()))

    def changeEvent(self, event):
        """The theme may have changed."""
        super().changeEvent(event)
        if event.type() in (QtCore.QEvent.PaletteChange, QtCore.QEvent.StyleChange) and hasattr(self, "flip"):
            self._take_theme()
