# SPDX-License-Identifier: LGPL-2.1-or-later
"""Qt through FreeCAD's PySide: Qt 5 or 6; FreeCAD 0.20 has the widgets in QtGui."""

from PySide import QtCore, QtGui

try:
    from PySide import QtWidgets
except ImportError:
    QtWidgets = QtGui

__all__ = ["QtCore", "QtGui", "QtWidgets", "flags"]


def flags(*values):
    """Enum values of any PySide as one int, which is what FreeCAD's task dialogs want."""
    result = 0
    for value in values:
        result |= int(getattr(value, "value", value))
    return result
