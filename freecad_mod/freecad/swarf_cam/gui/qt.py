# SPDX-License-Identifier: LGPL-2.1-or-later
"""Qt through FreeCAD's PySide: Qt 5 or 6; FreeCAD 0.20 has the widgets in QtGui. The only place that knows which."""

from PySide import QtCore, QtGui, QtSvg

try:
    from PySide import QtWidgets
except ImportError:
    QtWidgets = QtGui

__all__ = ["QAction", "QtCore", "QtGui", "QtSvg", "QtWidgets", "flags", "place_of"]

# Qt 6 has it in QtGui.
QAction = getattr(QtGui, "QAction", None) or QtWidgets.QAction


def flags(*values):
    """Enum values of any PySide as one int, which is what FreeCAD's task dialogs want."""
    result = 0
    for value in values:
        result |= int(getattr(value, "value", value))
    return result


def place_of(event):
    """(x, y) of a mouse event in its widget, in device-independent pixels."""
    point = event.position() if hasattr(event, "position") else event.localPos()
    return point.x(), point.y()


def choice():
    """A QComboBox that does not widen its panel for a long text."""
    box = QtWidgets.QComboBox()
    box.setSizeAdjustPolicy(QtWidgets.QComboBox.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(10)
    return box
