# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stock and tool as words of the command line."""
from __future__ import annotations

import math
import os
from typing import Any, Sequence

from ._native import Cutter, Error, Mesh
from .simulate import MESH_SOURCES, STOCK_SUFFIXES

STOCK_HELP = "box:X0,Y0,Z0,X1,Y1,Z1, cylinder:X,Y,Z,R,L (axis +Z) or cylinder:X,Y,Z,R,AX,AY,AZ, or a FILE"

#: Greatest tool number, as in G-code.
MOST_TOOL = 1_000_000


def _numbers(spec: str, text: str, counts: tuple[int, ...], wanted: str) -> list[float]:
    try:
        values = [float(word) for word in text.split(",")]
    except ValueError as error:
        raise ValueError(f"stock {spec!r}: {error}; wanted {wanted}") from None
    if len(values) not in counts:
        raise ValueError(f"stock {spec!r}: {len(values)} numbers; wanted {wanted}")
    if not all(math.isfinite(value) for value in values):
        raise ValueError(f"stock {spec!r}: a number is not finite; wanted {wanted}")
    return values


def stock(spec: str) -> dict[str, Any]:
    """Stock of a Job from ``--stock``: box, cylinder, mesh file or .vdb file. ValueError, OSError, FormatError."""
    kind, colon, rest = spec.partition(":")
    if colon and kind == "box":
        values = _numbers(spec, rest, (6,), "box:X0,Y0,Z0,X1,Y1,Z1")
        if not all(lo < hi for lo, hi in zip(values[:3], values[3:])):
            raise ValueError(f"stock {spec!r}: the second corner must lie above the first in X, Y and Z")
        return {"kind": "box", "lo": tuple(values[:3]), "hi": tuple(values[3:])}
    if colon and kind == "cylinder":
        wanted = "cylinder:X,Y,Z,RADIUS,LENGTH or cylinder:X,Y,Z,RADIUS,AX,AY,AZ"
        values = _numbers(spec, rest, (5, 7), wanted)
        axis = (0.0, 0.0, values[4]) if len(values) == 5 else tuple(values[4:])
        if not (values[3] > 0 and math.hypot(*axis) > 0):
            raise ValueError(f"stock {spec!r}: radius and length must be above 0")
        return {"kind": "cylinder", "base": tuple(values[:3]), "axis": axis, "radius": values[3]}
    suffix = os.path.splitext(spec)[1].lower()
    if suffix in MESH_SOURCES:
        return {"kind": "mesh", "mesh": Mesh.read(spec), "path": spec}
    if suffix in STOCK_SUFFIXES:
        return {"kind": "vdb", "path": spec}
    raise ValueError(f"stock {spec!r}: wanted {STOCK_HELP} ({', '.join(MESH_SOURCES + STOCK_SUFFIXES)})")


def tool(spec: str) -> tuple[int, Cutter, str, int]:
    """Number, cutter, text and teeth (0: not told) of a ``--tool``, e.g. ``1=flat:d=3,l=18,teeth=2``. ValueError,
    FormatError."""
    number, equals, text = spec.partition("=")
    # isdecimal() is true of other scripts' digits too; int() reads them as well.
    if not equals or not number.strip().isdecimal():
        raise ValueError(f"tool {spec!r}: wanted NUMBER=SHAPE, e.g. 1=flat:d=3,l=18")
    if len(number) > 9 or int(number) > MOST_TOOL:
        raise ValueError(f"tool {spec!r}: numbers up to {MOST_TOOL} are possible")
    shape, teeth = _teeth(int(number), text)
    try:
        return int(number), Cutter(shape), shape, teeth
    except (Error, ValueError) as error:
        raise type(error)(f"tool {int(number)}: {error}") from None


def tools(texts: Sequence[str]) -> dict[int, tuple[Cutter, str, int]]:
    """Cutter, text and teeth (0: not told) of several ``--tool`` by number. ValueError where a number is given
    twice."""
    found: dict[int, tuple[Cutter, str, int]] = {}
    for given in texts:
        number, cutter, text, teeth = tool(given)
        if number in found:
            raise ValueError(f"tool {number}: given twice")
        found[number] = cutter, text, teeth
    return found


def _teeth(number: int, text: str) -> tuple[str, int]:
    """A tool's text without the word that tells its cutting edges, and their number; 0: not told."""
    words = text.split(",")
    told = [word for word in words if word.strip().startswith("teeth=")]
    if not told:
        return text, 0
    count = told[0].partition("=")[2].strip()
    if len(told) > 1 or not count.isdecimal() or not 0 < int(count) <= 1000:
        raise ValueError(f"tool {number}: {','.join(told)}: one number of teeth, 1 .. 1000, is wanted")
    return ",".join(word for word in words if word not in told), int(count)
