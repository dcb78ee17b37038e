# SPDX-License-Identifier: LGPL-2.1-or-later
"""Icons of the panel: own drawings in icons/panel, whose ink takes the colour of the theme's text."""

import os

from .. import ICONS
from .qt import QtCore, QtGui, QtSvg

# What the files say where the theme's colour goes.
INK = "#000000"

# Pixels a drawing is made of; four times what buttons show, for screens of high density.
SIZE = 96


def _pixmap(text, colour):
    """By Qt's SVG library: the plug-in that would make images of SVG is not installed with every FreeCAD."""
    pixmap = QtGui.QPixmap(SIZE, SIZE)
    pixmap.fill(QtCore.Qt.transparent)
    painter = QtGui.QPainter(pixmap)
    QtSvg.QSvgRenderer(QtCore.QByteArray(text.replace(INK, colour.name()).encode())).render(painter)
    painter.end()
    return pixmap


def icon(name, palette):
    """QIcon of a drawing in the colours of a palette."""
    with open(os.path.join(ICONS, "panel", name + ".svg"), encoding="utf-8") as file:
        text = file.read()
    group, result = QtGui.QPalette, QtGui.QIcon()
    result.addPixmap(_pixmap(text, palette.color(group.Active, group.ButtonText)), QtGui.QIcon.Normal)
    result.addPixmap(_pixmap(text, palette.color(group.Disabled, group.ButtonText)), QtGui.QIcon.Disabled)
    return result
