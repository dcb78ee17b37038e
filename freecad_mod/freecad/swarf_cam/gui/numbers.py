# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers for people, written as the user's locale has them: as FreeCAD's spin boxes show what they hold. G-code, files
and errors of the native module keep the decimal point."""

from ..app import wording
from .qt import QtCore


def _point():
    return str(QtCore.QLocale().decimalPoint())


def _pointed(digits):
    """Digits with the locale's point. PySide2's toString() would keep seven of them only."""
    return digits.replace(".", _point())


def text(value, decimals, signed=False):
    """A number with so many decimals; signed: with its sign, also where that is a plus."""
    rounded = round(value, decimals) + 0.0  # no minus before zeros
    return ("+" if signed and rounded >= 0 else "") + _pointed("%.*f" % (decimals, rounded))


def short(value, signed=False):
    """A number with at most three digits that count."""
    return ("+" if signed and value >= 0 else "") + _pointed("%.3g" % value)


def count(value):
    """A number of things, in groups of digits where the locale has such."""
    return QtCore.QLocale().toString(int(value))


def measure(value, unit):
    """A measure: a number of things, a length to a tenth of a micrometre, a part of a direction, or what has seven
    digits that count."""
    if isinstance(value, int):
        return count(value)
    decimals = {"mm": 4, "": 6}.get(unit)
    return _pointed("%.7g" % value) if decimals is None else text(value, decimals)


def deviation(value):
    """A deviation in mm, to the micrometre."""
    return text(value, 3, True)


def size(count_of_bytes):
    """Bytes, as kilobytes, megabytes or gigabytes."""
    if count_of_bytes >= 1e9:
        return text(count_of_bytes / 1e9, 1) + " GB"
    if count_of_bytes < 1e5:
        return text(count_of_bytes / 1e3, 1) + " kB"
    return text(count_of_bytes / 1e6, 0 if count_of_bytes >= 1e7 else 2) + " MB"


def in_words(finding):
    """A text of swarf's about a finding in the user's language, its numbers and units as all others."""
    return wording.say(finding, _point())
