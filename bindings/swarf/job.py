# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job: what every input becomes before it is simulated.

Readers of further inputs are found by the entry point group ``swarf.readers``: the name is the file suffix in lower
case without the dot, the value a function ``read(path, job=None, progress=None) -> Job``, where ``job`` is the name of
the job wanted if the file may hold several.
"""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Optional

from ._native import Cutter, Mesh, Program
from .accept import Acceptance
from .records import MOVE, SECTION, section_and_kind


@dataclass
class Job:
    """Program, tools and stock of one setup; lengths in mm, all in the coordinates of the stock.

    ``stock`` is None (not known) or one of::

        {"kind": "box", "lo": (x, y, z), "hi": (x, y, z)}
        {"kind": "cylinder", "base": (x, y, z), "axis": (x, y, z), "radius": r}   axis: from base to the other end
        {"kind": "mesh", "mesh": Mesh}                              "path": where it came from, for errors
        {"kind": "vdb", "path": path}
        {"kind": "result", "job": Job}    what is left after that job; "path": a .vdb file that holds it already

    Each may have a "placement", how it lies in this set-up: rows as of Stock.placed(), or a placement.Turn.
    """

    name: str
    program: Program
    tools: dict[int, Cutter] = field(default_factory=dict)
    tool_names: dict[int, str] = field(default_factory=dict)
    stock: Optional[dict[str, Any]] = None
    design: Optional[Mesh] = None
    notes: list[str] = field(default_factory=list)
    holders: dict[int, str] = field(default_factory=dict)  #: what holds each tool, for people; the cutters have it
    accepted: list[Acceptance] = field(default_factory=list)  #: findings that the job's document accepts
    fixtures: list[Mesh] = field(default_factory=list)  #: closed: clamps, a vice, the table
    teeth: dict[int, int] = field(default_factory=dict)  #: cutting edges around each tool, where they are known
    files: list[str] = field(default_factory=list)  #: that it was read from besides the one that was asked for


def number_of(job: Job, tool: int) -> int:
    """The number by which a tool was given. Moves that name none have -1, and may have another's cutter."""
    cutter = job.tools.get(tool) if tool < 0 else None
    return next((number for number, other in job.tools.items() if number >= 0 and other is cutter), tool)


def operation_of(job: Job, move: int) -> tuple[Optional[str], int]:
    """Name of the operation (None: none) and line of a move."""
    *_, line, _, section_kind = MOVE.unpack_from(job.program.moves, move * MOVE.size)
    index = SECTION.unpack_from(job.program.sections, section_and_kind(section_kind)[0] * SECTION.size)[1]
    names = job.program.operations
    return (names[index] if 0 <= index < len(names) else None), line
