# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long the machine takes: times of moves, summed by tool and operation, with the limits of a machine from a file.

The file is JSON with any of the keywords of Program.times(), e.g.::

    {"rapid_mm_min": [8000, 8000, 5000], "feed_mm_min": 5000, "acceleration_mm_s2": [500, 500, 300],
     "junction_mm": 0.01, "rotary_deg_min": 3600, "tool_change_s": 8}
"""
from __future__ import annotations

import math
from typing import Any, Optional

from ._native import Program
from .files import is_number, read_json
from .records import MOVE, SECTION, section_and_kind

KEYS = ("rapid_mm_min", "feed_mm_min", "acceleration_mm_s2", "junction_mm", "rotary_deg_min", "tool_change_s")

#: Those that may differ by axis.
BY_AXIS = KEYS[:3]


def read_machine(path: str) -> dict[str, Any]:
    """Keywords of Program.times() from a file. OSError; ValueError names the file and what is wrong."""
    limits = read_json(path)
    if not isinstance(limits, dict):
        raise ValueError(f"{path}: wanted an object with {', '.join(KEYS)}")
    for key, value in limits.items():
        if key not in KEYS:
            raise ValueError(f"{path}: {key!r} is not known; {', '.join(KEYS)} are")
        values = value if isinstance(value, list) and key in BY_AXIS and len(value) == 3 else [value]
        if not all(map(is_number, values)):
            three = ", or three for X, Y, Z" if key in BY_AXIS else ""
            raise ValueError(f"{path}: {key}: {value!r} is no number{three}")
    try:
        Program().times(**limits)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    return limits


def summary(program: Program, limits: Optional[dict[str, Any]] = None) -> dict[str, Any]:
    """Seconds in all, by tool number and by operation (in the program's order). ValueError for limits that cannot
    be."""
    times = program.times(**(limits or {}))
    sections = [(row[0], row[1]) for row in SECTION.iter_unpack(bytes(program.sections))]
    by_section = [0.0] * len(sections)
    for taken, row in zip(times, MOVE.iter_unpack(program.moves)):
        by_section[section_and_kind(row[-1])[0]] += taken
    by_tool: dict[int, float] = {}
    by_operation = [0.0] * len(program.operations)
    for (tool, operation), seconds in zip(sections, by_section):
        by_tool[tool] = by_tool.get(tool, 0.0) + seconds
        by_operation[operation] += seconds
    return {"total": math.fsum(by_section), "by_tool": by_tool, "by_operation": by_operation}
