# SPDX-License-Identifier: LGPL-2.1-or-later
"""Voxel size with what it costs, before it is paid."""

import FreeCAD

from ... import native
from ...app import wording
from .. import numbers
from ..qt import QtCore, QtWidgets

translate = FreeCAD.Qt.translate

VOXEL_MAX_MM, VOXEL_DECIMALS = 100.0, 4


class Accuracy(QtWidgets.QWidget):
    """Tells by chosen the voxel size in mm to simulate with from now on."""

    chosen = QtCore.Signal(float)

    def __init__(self, parent=None):
        super().__init__(parent)
        self.setObjectName("SwarfAccuracy")
        form = QtWidgets.QFormLayout(self)
        self.voxel = QtWidgets.QDoubleSpinBox()
        self.voxel.setObjectName("SwarfVoxel")
        self.voxel.setDecimals(VOXEL_DECIMALS)
        self.voxel.setRange(10.0 ** -VOXEL_DECIMALS, VOXEL_MAX_MM)
        self.voxel.setSingleStep(0.01)
        self.voxel.setSuffix(" mm")
        form.addRow(translate("Swarf", "Voxel size"), self.voxel)
        self.estimate = QtWidgets.QLabel()
        self.estimate.setObjectName("SwarfEstimate")
        self.estimate.setWordWrap(True)
        form.addRow(self.estimate)
        self.apply = QtWidgets.QPushButton(translate("Swarf", "Simulate with this voxel size"))
        self.apply.setObjectName("SwarfApply")
        self.apply.clicked.connect(lambda *_: self.chosen.emit(self.voxel.value()))
        form.addRow(self.apply)
        self.outcome = QtWidgets.QLabel()
        self.outcome.setObjectName("SwarfOutcome")
        self.outcome.setWordWrap(True)
        self.outcome.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        form.addRow(self.outcome)
        self._box = self._measured = None
        self.voxel.valueChanged.connect(self._show_estimate)

    def open(self, box, voxel_mm):
        """A stock's box and the voxel size in use."""
        self._box, self._measured = box, None
        self.voxel.setValue(voxel_mm)
        self._show_estimate()

    def measured(self, session, seconds):
        """What opening took at the size in use, and what came out."""
        self._measured = session.voxel_mm, seconds
        overview = session.overview
        volumes = overview.volume_initial, overview.volume_initial - overview.volume_final, overview.volume_final
        lines = [translate("Swarf", "Stock {0} cm³, removed {1} cm³, left {2} cm³").format(
            *(numbers.text(volume / 1000, 2) for volume in volumes))]
        lines += ["%s: %s" % (translate("Swarf", wording.SEVERITIES[severity]), numbers.in_words(text))
                  for _, severity, text in overview.findings]
        lines += list(session.data.notes)
        self.outcome.setText("\n".join(lines))
        self._show_estimate()

    def _show_estimate(self, *_):
        if self._box is None:
            self.estimate.setText("")
            return
        voxel = self.voxel.value()
        try:
            needed = native.estimate(*self._box, voxel)
        except (ValueError, MemoryError, OverflowError) as error:
            self.estimate.setText(str(error))
            self.apply.setEnabled(False)
            return
        self.apply.setEnabled(True)
        cells = max(b - a for a, b in zip(*self._box)) / voxel
        text = translate("Swarf", "{0} voxels along the longest edge, up to {1}").format(
            numbers.count(round(cells)), numbers.size(needed))
        if self._measured is not None:
            # A level set is a surface: four times the work for half the voxel.
            seconds = self._measured[1] * (self._measured[0] / voxel) ** 2
            text += translate("Swarf", ", about {0} s to cut once").format(numbers.text(seconds, 1))
        self.estimate.setText(text)
