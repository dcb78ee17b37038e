# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a stock lies in its set-up: placements as rows of rotation and shift, and turns told in words.

A turn is a list of words with commas between them::

    x180              turned by 180 degrees about X, right-handed, about the middle of what is there; so y90, z-45
    top=0             moved so that its top comes to Z 0; so bottom, left and right (X), front and back (Y)
    dx=5              moved by 5 mm along X in the end; so dy, dz

Turns come first, in their order, then sides, then shifts: "x180,top=0,left=0" turns a part over and puts its top and
its left side to 0.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Callable, Sequence, Union

from .aliases import Box

#: Three rows of a rotation and a shift in mm: p -> rotation * p + shift.
Rows = Sequence[Sequence[float]]

IDENTITY: Rows = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))

#: Side -> axis, end of the box.
SIDES = {"left": (0, 0), "right": (0, 1), "front": (1, 0), "back": (1, 1), "bottom": (2, 0), "top": (2, 1)}

HELP = "e.g. x180,top=0: turns x180 y90 z-45, then sides left= right= front= back= bottom= top=, then dx= dy= dz="


def rotation_about(axis: int, angle_deg: float) -> Rows:
    """Rows of a turn about a coordinate axis; quarter turns are exact."""
    quarter, rest = divmod(angle_deg, 90.0)
    if rest == 0:
        cosine, sine = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    else:
        cosine, sine = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    rows = [list(row) for row in IDENTITY]
    first, second = (axis + 1) % 3, (axis + 2) % 3
    rows[first][first], rows[first][second] = cosine, -sine
    rows[second][first], rows[second][second] = sine, cosine
    return rows


def point(rows: Rows, p: Sequence[float]) -> tuple[float, float, float]:
    """Where a point comes to."""
    x, y, z = (row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] for row in rows)
    return x, y, z


def direction(rows: Rows, d: Sequence[float]) -> tuple[float, float, float]:
    """How a direction is turned."""
    x, y, z = (row[0] * d[0] + row[1] * d[1] + row[2] * d[2] for row in rows)
    return x, y, z


def after(second: Rows, first: Rows) -> Rows:
    """The placement that does `first`, then `second`."""
    columns = [direction(second, [row[k] for row in first]) for k in range(3)]
    shift = point(second, [row[3] for row in first])
    return tuple((columns[0][k], columns[1][k], columns[2][k], shift[k]) for k in range(3))


def shifted(rows: Rows, shift: Sequence[float]) -> Rows:
    """A placement, then a shift."""
    return tuple((*row[:3], row[3] + by) for row, by in zip(rows, shift))


def is_quarter(rows: Rows) -> bool:
    """Whether axes are turned onto axes."""
    return all(sorted(abs(value) for value in row[:3]) == [0.0, 0.0, 1.0] for row in rows)


def box_of(rows: Rows, box: Box) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """The box round a box that was placed."""
    corners = [point(rows, [box[i >> k & 1][k] for k in range(3)]) for i in range(8)]
    lo, hi = (tuple(end(corner[k] for corner in corners) for k in range(3)) for end in (min, max))
    return (lo[0], lo[1], lo[2]), (hi[0], hi[1], hi[2])


@dataclass(frozen=True)
class Turn:
    """A placement that depends on the box of what is turned."""

    rotation: Rows = IDENTITY
    sides: tuple[tuple[str, float], ...] = ()
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def rows(self, box: Box) -> Rows:
        """The placement, for what lies in this box."""
        middle = [(lo + hi) / 2 for lo, hi in zip(*box)]
        turned = direction(self.rotation, middle)
        rows = shifted(self.rotation, [a - b for a, b in zip(middle, turned)])
        for side, wanted in self.sides:
            axis, end = SIDES[side]
            rows = shifted(rows, [wanted - box_of(rows, box)[end][axis] if k == axis else 0.0 for k in range(3)])
        return shifted(rows, self.shift)


#: What a stock's description may have as its "placement".
Placement = Union[Turn, Rows]


def rows_of(placement: Placement, box: Callable[[], Box]) -> Rows:
    """A placement as rows; the box of what is placed is asked for where that matters."""
    if isinstance(placement, str):
        raise ValueError(f"placement {placement!r}: wanted rows, or the Turn that swarf.placement.parse() makes of it")
    return placement.rows(box()) if isinstance(placement, Turn) else placement


def parse(text: str) -> Turn:
    """A Turn of words, see the head of this module. ValueError."""
    rotation: Rows = IDENTITY
    sides: dict[str, float] = {}
    shift = [0.0, 0.0, 0.0]
    for word in text.split(","):
        word = word.strip().lower()
        name, equals, value = word.partition("=")
        if not equals:
            name, value = word[:1], word[1:]
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise ValueError(f"turn {text!r}: {word!r} is no turn, side or shift; wanted {HELP}")
        if not equals and name in ("x", "y", "z"):
            rotation = after(rotation_about("xyz".index(name), number), rotation)
        elif equals and name in SIDES:
            if any(SIDES[name][0] == SIDES[side][0] for side in sides):
                raise ValueError(f"turn {text!r}: {name!r} and another side both say where it lies along "
                                 f"{'XYZ'[SIDES[name][0]]}")
            sides[name] = number
        elif equals and name in ("dx", "dy", "dz"):
            shift["xyz".index(name[1])] += number
        else:
            raise ValueError(f"turn {text!r}: {word!r} is no turn, side or shift; wanted {HELP}")
    return Turn(rotation, tuple(sides.items()), (shift[0], shift[1], shift[2]))


def describe(placement: Any) -> list[list[float]]:
    """Rows as lists, for JSON."""
    return [[float(value) for value in row] for row in placement]
