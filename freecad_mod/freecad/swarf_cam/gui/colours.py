# SPDX-License-Identifier: LGPL-2.1-or-later
"""Colours of operations, findings and the picture's background, in light and dark themes."""

import array

from .. import native
from .qt import QtGui

FINDINGS = {"error": "#e5484d", "warning": "#e69f00", "note": "#3d8fd1"}

# What deviations are tinted on in the legend: about as light as a face towards the viewer.
DEVIATION_LIT = (225, 225, 225, 255)

# Bare aluminium, linear.
MATERIAL = (0.50, 0.53, 0.56)

BACKGROUND_LIGHT = ((0.72, 0.77, 0.82), (0.93, 0.95, 0.97))
BACKGROUND_DARK = ((0.085, 0.095, 0.11), (0.20, 0.22, 0.25))


def of_operation(index):
    """QColor of an operation, as pictures that are coloured by operations have it."""
    return QtGui.QColor.fromRgbF(*(12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055
                                   for c in native.load().picture_colour(index)))


def of_deviations(swarf, values, tolerance):
    """RGBA bytes of some deviations, as the stock shows them where it is lit."""
    table = memoryview(array.array("d", values)).cast("B").cast("d", (len(values), 1))
    return swarf.deviation_colours(table, bytes(DEVIATION_LIT) * len(values), tolerance)


def is_dark(palette):
    """Whether a theme has light text on dark."""
    return palette.color(QtGui.QPalette.Window).lightness() < 128


def _linear(colour):
    return tuple(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour) + (1.0,)


def background(palette):
    """(bottom, top) of the picture for a theme, linear RGBA as Scene.render takes it."""
    bottom, top = BACKGROUND_DARK if is_dark(palette) else BACKGROUND_LIGHT
    return _linear(bottom), _linear(top)
