# SPDX-License-Identifier: LGPL-2.1-or-later
"""CAMotics projects (.camotics, JSON): one program with its tools and its block of stock, for runs side by side."""
from __future__ import annotations

import math
import os
from typing import Any, Callable, Optional

from ._native import Cutter, Error, FormatError, Program
from .files import is_number, read_json
from .job import Job

#: (r, z, bulge) nodes of a tool of radius r and length l; snub is the radius of a snub nose's tip.
_QUARTER = math.tan(math.pi / 8)


def _nodes(shape: str, r: float, length: float, snub: float) -> list[tuple[float, float, float]]:
    """Meridian of a tool's shape. ValueError for one that is not known or cannot be."""
    if shape == "cylindrical":
        return [(0, 0, 0), (r, 0, 0), (r, length, 0), (0, length, 0)]
    if shape == "ballnose":
        return [(0, 0, _QUARTER), (r, r, 0), (r, max(length, r), 0), (0, max(length, r), 0)]
    if shape == "conical":
        return [(0, 0, 0), (r, length, 0), (0, length, 0)]
    if shape == "snubnose":
        return [(0, 0, 0), (snub, 0, 0), (r, length, 0), (0, length, 0)]
    if shape == "spheroid" and math.isclose(length, 2 * r):
        return [(0, 0, _QUARTER), (r, r, _QUARTER), (0, 2 * r, 0)]
    raise ValueError(f"shape {shape!r} is not known; cylindrical, ballnose, conical, snubnose and spheres are")


def _number(table: dict[str, Any], key: str, scale: float) -> float:
    value: Any = table.get(key)
    if not (is_number(value) and value > 0):
        raise ValueError(f"{key}: {value!r} is no positive length")
    return float(value) * scale


def cutter(tool: dict[str, Any]) -> Cutter:
    """The cutter of a project's tool. ValueError, GeometryError."""
    scale = 25.4 if str(tool.get("units", "metric")).lower() == "imperial" else 1.0
    shape = str(tool.get("shape", "cylindrical")).lower()
    radius, length = 0.5 * _number(tool, "diameter", scale), _number(tool, "length", scale)
    snub = 0.5 * _number(tool, "snub_diameter", scale) if shape == "snubnose" else 0.0
    return Cutter.from_parts([("flutes", _nodes(shape, radius, length, snub))])


def _stock(project: dict[str, Any]) -> Optional[dict[str, Any]]:
    workpiece = project.get("workpiece", {})
    bounds = None if workpiece.get("automatic") else workpiece.get("bounds")
    if bounds is None:
        return None
    for key in ("min", "max"):
        corner = bounds[key]
        if not (isinstance(corner, list) and len(corner) == 3 and all(map(is_number, corner))):
            raise ValueError(f"workpiece: {key}: {corner!r}: three numbers are wanted")
    # the bounds of a workpiece are in mm whatever the units of the project
    return {"kind": "box", "lo": tuple(map(float, bounds["min"])), "hi": tuple(map(float, bounds["max"]))}


def _source(project: dict[str, Any], path: str) -> str:
    """The file of the project's program."""
    files = project["files"]
    if not (isinstance(files, list) and all(isinstance(name, str) for name in files)):
        raise ValueError(f"files: {files!r}: a list of names is wanted")
    if len(files) != 1:
        raise ValueError(f"it has {len(files)} programs; one can be read")
    return os.path.join(os.path.dirname(path), files[0])


def _tools(project: dict[str, Any]) -> dict[int, Cutter]:
    found = {}
    for number, tool in project.get("tools", {}).items():
        if not number.isdecimal():
            raise ValueError(f"tools: {number!r} is no number of a tool")
        if not isinstance(tool, dict):
            raise ValueError(f"tool {number}: {tool!r}: an object is wanted")
        try:
            found[int(number)] = cutter(tool)
        except (ValueError, Error) as error:
            raise ValueError(f"tool {number}: {error}") from None
    return found


def read(
    path: str, progress: Optional[Callable[[float], Any]] = None, options: Optional[dict[str, Any]] = None
) -> Job:
    """The Job of a project; ``options`` as of Program.read_gcode(). OSError; FormatError says what is wrong in it."""
    try:
        project = read_json(path)
    except ValueError as error:
        raise FormatError(str(error)) from None
    try:
        if not isinstance(project, dict):
            raise ValueError("an object is wanted")
        source, tools = _source(project, path), _tools(project)
        names = {int(number): str(tool.get("description", "")) for number, tool in project.get("tools", {}).items()}
        stock = _stock(project)
    except KeyError as error:
        raise FormatError(f"{path}: is no CAMotics project: it has no {error}") from None
    except (ValueError, TypeError, AttributeError) as error:
        raise FormatError(f"{path}: is no CAMotics project: {error}") from None
    words = dict(options or {})
    known = {number: 2 * tool.radius() for number, tool in tools.items()}
    words["diameters"] = {**known, **(words.get("diameters") or {})}
    program = Program.read_gcode(source, progress=progress, **words)
    return Job(name=os.path.basename(path), program=program, tools=tools, tool_names=names, stock=stock, files=[source])
