# SPDX-License-Identifier: LGPL-2.1-or-later
"""Section curves as drawings in mm: SVG, and DXF as of AutoCAD R12, the oldest that readers know."""
from __future__ import annotations

from typing import Iterable, Sequence

from .files import write_text
from .vectors import Vector, add, cross, dot, unit

__all__ = ["SUFFIXES", "flat", "write"]

SUFFIXES = (".svg", ".dxf")

Point = tuple[float, float]

#: Width of lines in a picture, of its longer edge.
STROKE = 1 / 500

#: Of a unit normal, what rounding makes of nought.
ROUNDED = 1e-9

#: Layer of the curves. Not 0: FreeCAD's reader takes it for the code that begins the next entity, and misses that.
LAYER = "SECTION"


def flat(curves: Iterable[Sequence[Vector]], point: Vector, normal: Vector) -> list[list[Point]]:
    """Curves of a plane across an axis as the two other coordinates, in their order; of any other one as it is seen
    against the normal, ``point`` at the origin, to the right what is horizontal."""
    upwards = unit(normal)
    across = [axis for axis in range(3) if abs(upwards[axis]) > ROUNDED]
    if len(across) == 1:
        first, second = (axis for axis in range(3) if axis not in across)
        return [[(corner[first], corner[second]) for corner in curve] for curve in curves]
    right = unit(cross((0.0, 0.0, 1.0), upwards))
    up = cross(upwards, right)
    return [[(dot(place, right), dot(place, up)) for place in (add(corner, point, -1) for corner in curve)]
            for curve in curves]


def write(curves: Sequence[Sequence[Point]], path: str) -> None:
    """Closed curves, at least one, to a file by its suffix. OSError."""
    write_text(_dxf(curves) if path.lower().endswith(".dxf") else _svg(curves), path)


def _number(value: float) -> str:
    return f"{round(value, 6) + 0.0:.6f}"  # no minus before 0


def _svg(curves: Sequence[Sequence[Point]]) -> str:
    lo, hi = ([pick(corner[axis] for curve in curves for corner in curve) for axis in (0, 1)] for pick in (min, max))
    stroke = max(hi[0] - lo[0], hi[1] - lo[1]) * STROKE
    width, height = (_number(hi[axis] - lo[axis] + stroke) for axis in (0, 1))
    left, top = _number(lo[0] - stroke / 2), _number(-hi[1] - stroke / 2)
    paths = ("M" + " L".join(f"{_number(x)},{_number(-y)}" for x, y in curve) + " Z" for curve in curves)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
            f'viewBox="{left} {top} {width} {height}">\n'
            f'<path fill="#d0d0d0" fill-rule="evenodd" stroke="#000000" stroke-width="{_number(stroke)}" '
            'stroke-linejoin="round" d="' + "\n".join(paths) + '"/>\n</svg>\n')


def _dxf(curves: Sequence[Sequence[Point]]) -> str:
    """Each curve a closed POLYLINE on the layer; pairs of a group's code and its value."""
    pairs: list[tuple[int, object]] = [(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009"), (0, "ENDSEC"),
                                       (0, "SECTION"), (2, "ENTITIES")]
    for curve in curves:
        pairs += [(0, "POLYLINE"), (8, LAYER), (66, 1), (70, 1), (10, _number(0)), (20, _number(0)), (30, _number(0))]
        for x, y in curve:
            pairs += [(0, "VERTEX"), (8, LAYER), (10, _number(x)), (20, _number(y)), (30, _number(0))]
        pairs += [(0, "SEQEND"), (8, LAYER)]
    pairs += [(0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code}\n{value}\n" for code, value in pairs)
