# SPDX-License-Identifier: LGPL-2.1-or-later
"""Swarf's page in FreeCAD's preferences."""

import FreeCAD

from ..core import transport
from . import settings
from .qt import QtWidgets

translate = FreeCAD.Qt.translate


class Page:
    """FreeCAD makes one each time the preferences are opened, and calls these two."""

    def __init__(self, _parent=None):
        self.form = QtWidgets.QWidget()
        self.form.setObjectName("SwarfPreferences")
        self.form.setWindowTitle(translate("Swarf", "Live milling"))
        layout = QtWidgets.QFormLayout(self.form)
        self.resolution = QtWidgets.QSpinBox()
        self.resolution.setRange(50, 8192)
        self.resolution.setSingleStep(100)
        self.resolution.setToolTip(translate("Swarf", "How fine a job is cut at first: more is sharper and slower"))
        layout.addRow(translate("Swarf", "Voxels along the stock's longest edge"), self.resolution)
        self.speed = QtWidgets.QComboBox()
        for speed in transport.SPEEDS:
            self.speed.addItem(translate("Swarf", "max") if speed == transport.AS_FAST_AS_POSSIBLE else "× %g" % speed,
                               speed)
        layout.addRow(translate("Swarf", "Speed"), self.speed)
        self.lengths = {}
        for name, text, least, most in (
                ("tolerance", translate("Swarf", "Deviation from the model that is well"), settings.TOLERANCE_MIN_MM,
                 settings.TOLERANCE_MAX_MM),
                ("clearance", translate("Swarf", "Clearance of holders"), 0.0, settings.CLEARANCE_MAX_MM)):
            box = QtWidgets.QDoubleSpinBox()
            box.setDecimals(3)
            box.setRange(least, most)
            box.setSingleStep(0.01)
            box.setSuffix(" mm")
            layout.addRow(text, box)
            self.lengths[name] = box
        self.flags = {}
        for name, text in (("AutoPlay", translate("Swarf", "Play as soon as the job is read")),
                           ("AutoCheck", translate("Swarf", "Check the job when it is opened")),
                           ("StopAtError", translate("Swarf", "Stop checking at the first error")),
                           ("Perspective", translate("Swarf", "Perspective")),
                           ("ShowCutter", translate("Swarf", "Show the cutter")),
                           ("ShowPath", translate("Swarf", "Show the tool's path")),
                           ("ShowOrigin", translate("Swarf", "Show the origin and the outline of the stock")),
                           ("Occlusion", translate("Swarf", "Darken corners when the view is at rest")),
                           ("Shadow", translate("Swarf", "Shadows when the view is at rest"))):
            box = QtWidgets.QCheckBox(text)
            layout.addRow(box)
            self.flags[name] = box

    def loadSettings(self):
        """From FreeCAD's parameters."""
        self.resolution.setValue(settings.resolution())
        self.speed.setCurrentIndex(max(self.speed.findData(settings.speed()), 0))
        self.lengths["tolerance"].setValue(settings.tolerance())
        self.lengths["clearance"].setValue(settings.clearance())
        for name, box in self.flags.items():
            box.setChecked(settings.flag(name))

    def saveSettings(self):
        """Into FreeCAD's parameters."""
        settings.set_resolution(self.resolution.value())
        settings.set_speed(self.speed.currentData())
        settings.set_tolerance(self.lengths["tolerance"].value())
        settings.set_clearance(self.lengths["clearance"].value())
        for name, box in self.flags.items():
            settings.set_flag(name, box.isChecked())
