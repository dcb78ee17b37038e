# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is measured of a body and of its shells, as a table: a row for each measure, a column for the whole and for each
shell."""

from dataclasses import dataclass

AXES = "XYZ"

# A part of more pieces than this is chips; the largest are measured.
MOST_SHELLS = 50

# Of the greatest: less is what sums of many numbers leave of a zero.
ROUNDING = 1e-9

WHOLE, PIECE, HOLLOW = "whole", "piece", "hollow"


@dataclass
class Table:
    """columns: (kind, number) from 1 on of each, the whole first. rows: (key, axis or "", unit or "", values), a value
    for each column, None where there is none. more: shells that have no column."""

    columns: list
    rows: list
    more: int = 0


def _corner(shell, which, axis):
    return None if shell.bounding_box is None else shell.bounding_box[which][axis]


def _inertia(shell, i, j):
    greatest = max(abs(moment) for moment in shell.moments)
    return shell.inertia[i][j] if abs(shell.inertia[i][j]) > ROUNDING * greatest else 0.0


def _axis(shell, k, j):
    return shell.axes[k][j] if abs(shell.axes[k][j]) > ROUNDING else 0.0


def _size(shell, axis):
    return None if shell.bounding_box is None else shell.bounding_box[1][axis] - shell.bounding_box[0][axis]


def table(whole, shells, thinnest):
    """Table of the whole and its shells (as swarf's Shell), the largest first. thinnest: least thickness of a wall, mm,
    and where, as swarf.parts.thinnest() tells it."""
    shown = sorted(shells, key=lambda shell: -abs(shell.volume_mm3))[:MOST_SHELLS]
    columns, count = [(WHOLE, 1)], {PIECE: 0, HOLLOW: 0}
    for shell in shown:
        kind = PIECE if shell.volume_mm3 > 0 else HOLLOW
        count[kind] += 1
        columns.append((kind, count[kind]))
    rows, measured = [], [whole, *shown]

    def add(key, axis, unit, value):  # which is asked for at once
        rows.append((key, axis, unit, [value(shell) for shell in measured]))

    def add_place(key, value):
        for k, axis in enumerate(AXES):
            add(key, axis, "mm", lambda shell: value(shell, k))

    def add_of_whole(key, axis, value):
        rows.append((key, axis, "mm", [value] + [None] * len(shown)))

    add("volume", "", "mm³", lambda shell: shell.volume_mm3)
    add("area", "", "mm²", lambda shell: shell.area_mm2)
    add("genus", "", "", lambda shell: shell.genus if shell.genus >= 0 else None)
    add_of_whole("wall", "", thinnest["least_mm"])
    add_place("size", _size)
    add_place("centre", lambda shell, k: shell.centre[k])
    add_place("from", lambda shell, k: _corner(shell, 0, k))
    add_place("to", lambda shell, k: _corner(shell, 1, k))
    for k, axis in enumerate(AXES):
        add_of_whole("thinnest", axis, thinnest["place"] and thinnest["place"][k])
    for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
        add("inertia", AXES[i] + AXES[j], "mm⁵", lambda shell: _inertia(shell, i, j))
    for k in range(3):
        add("moment", str(k + 1), "mm⁵", lambda shell: shell.moments[k])
    for k in range(3):
        for j, axis in enumerate(AXES):
            add("axis", "%d%s" % (k + 1, axis), "", lambda shell: _axis(shell, k, j))
    add("triangles", "", "", lambda shell: shell.triangles)
    return Table(columns, rows, len(shells) - len(shown))
