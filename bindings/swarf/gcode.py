# SPDX-License-Identifier: LGPL-2.1-or-later
"""G-code for Python and the command line: reading, its words on the command line, moves as text."""
from __future__ import annotations

import argparse
import math
import os
from typing import Any, Iterator, Optional, Union, get_args

from . import specs
from ._native import Program
from .aliases import Dialect
from .records import ARC, AXES, MOVE, SECTION, section_and_kind

DIALECTS: tuple[Dialect, ...] = get_args(Dialect)

MOVE_KINDS = ("rapid", "feed", "dwell", "tool", "probe", "position")
PLANES = ("xy", "zx", "yz")
SPINDLES = ("off", "cw", "ccw")
COOLANTS = ("off", "mist", "flood", "mist flood")
OFFSETS = ("machine", "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")


def read_gcode(path: Union[str, os.PathLike[str]], **options: Any) -> Program:
    """The Program in a G-code file; options as of Program.read_gcode(). Its ``moves``, ``arcs``, ``sections`` and
    ``axes`` are buffers, its ``notes`` what the reader had to say. OSError, FormatError."""
    return Program.read_gcode(path, **options)


def add_arguments(command: argparse.ArgumentParser) -> None:
    """The options that say how G-code is to be read."""
    group = command.add_argument_group("G-code")
    group.add_argument("--dialect", choices=DIALECTS, default=DIALECTS[0], help="the control (default: linuxcnc)")
    group.add_argument("--tool", metavar="N=SPEC", action="append", default=[],
                       help="tool number N, e.g. 1=flat:d=3,l=18; with teeth=2 its chips are known (repeatable)")
    group.add_argument("--tool-table", metavar="FILE.tbl", help="LinuxCNC's tool table: offsets and diameters")
    group.add_argument("--parameters", metavar="FILE.var", help="LinuxCNC's parameter file: work offsets")
    group.add_argument("--machine-unit", choices=("mm", "inch"), default="mm",
                       help="what the lengths in these two files are in (default: mm)")
    group.add_argument("--search", metavar="FOLDERS", help="folders with files of subroutines, ':' between them")
    group.add_argument("--block-delete", action="store_true", help="leave out lines that begin with '/'")
    group.add_argument("--start", metavar="X,Y,Z", help="where the tool stands first, mm (default: not known)")


def options(arguments: argparse.Namespace) -> dict[str, Any]:
    """Those options as keywords of read_gcode(). ValueError, FormatError."""
    start = None
    if arguments.start is not None:
        words = arguments.start.split(",")
        try:
            start = tuple(float(word) for word in words)
        except ValueError:
            start = ()
        if len(start) != 3 or not all(math.isfinite(value) for value in start):
            raise ValueError(f"start {arguments.start!r}: wanted X,Y,Z in mm")
    return {
        "dialect": arguments.dialect,
        "tools": arguments.tool_table,
        "diameters": {number: 2 * cutter.radius() for number, (cutter, *_) in specs.tools(arguments.tool).items()},
        "parameters": arguments.parameters,
        "machine_unit": arguments.machine_unit,
        "search": arguments.search,
        "block_delete": arguments.block_delete,
        "start": start,
    }


def note_text(note: tuple[str, str, int, int, str]) -> str:
    """A note as one line, ``file:line:column: kind: text``."""
    kind, source, line, column, text = note
    return f"{source}:{line}:{column}: {kind}: {' '.join(text.split())}"


def _number(value: float) -> str:
    """Six decimals, no minus before nothing; "?" for what is not known."""
    if math.isnan(value):
        return "?"
    text = f"{value:.6f}"
    return text[1:] if text == "-0.000000" else text


def _point(letters: str, values: tuple[float, ...]) -> str:
    return " ".join(letter + _number(value) for letter, value in zip(letters, values))


def _section_lines(program: Program, old: Optional[tuple[Any, ...]], new: tuple[Any, ...]) -> Iterator[str]:
    tool, operation, spindle, coolant, speed, offset, source = new
    before = old or (None,) * 7
    if source != before[6] and (source or old):
        yield f"source {program.sources[source]}"
    if operation != before[1]:
        yield f"operation {operation} {program.operations[operation]}"
    if tool != before[0]:
        yield f"tool {tool if tool >= 0 else 'none'}"
    if (spindle, speed) != (before[2], before[4]):
        yield f"spindle {SPINDLES[spindle]} {_number(speed)}"
    if coolant != before[3]:
        yield f"coolant {COOLANTS[coolant & 3]}"
    if offset != before[5]:
        yield f"offset {OFFSETS[offset] if 0 <= offset < len(OFFSETS) else offset}"


def moves_text(program: Program) -> Iterator[str]:
    """The canonical moves of a program, one line each::

        operation INDEX NAME | tool N | spindle cw RPM | coolant flood | offset G54 | source FILE   what changes
        LINE rapid X Y Z                    LINE feed X Y Z F           LINE probe X Y Z F
        LINE arc PLANE X Y Z I J K A F      LINE dwell SECONDS          LINE tool N
        LINE position X Y Z                 a place that is reached in an unknown way

    Lengths in mm, ends and centres (I J K) absolute in the coordinates of the stock, A the angle in degrees
    (positive: counter-clockwise, more than 360: several turns), F in mm/min. A B C U V W follow where they are not 0.
    """
    sections = list(SECTION.iter_unpack(bytes(program.sections)))
    arcs = bytes(program.arcs)
    axes = list(AXES.iter_unpack(bytes(program.axes)))
    row, section_now = 0, -1
    current: tuple[float, ...] = (0.0,) * 6
    for index, move in enumerate(MOVE.iter_unpack(program.moves)):
        *end, feed, line, arc, packed = move
        section, kind = section_and_kind(packed)
        if section != section_now:
            old = None if section_now < 0 else sections[section_now]
            section_now = section
            yield from _section_lines(program, old, sections[section_now])
        if row < len(axes) and axes[row][0] <= index:
            current = axes[row][1:]
            row += 1
        if kind == 2:
            yield f"{line} dwell {_number(feed)}"
            continue
        if kind == 3:
            yield f"{line} tool {sections[section_now][0]}"
            continue
        words = [str(line), "arc" if arc >= 0 else MOVE_KINDS[kind]]
        if arc >= 0:
            *centre, angle, plane, _ = ARC.unpack_from(arcs, ARC.size * arc)
            words += [PLANES[plane], _point("XYZ", tuple(end)), _point("IJK", tuple(centre)),
                      "A" + _number(math.degrees(angle))]
        else:
            words.append(_point("XYZ", tuple(end)))
        if any(current):
            words.append(_point("ABCUVW", current))
        if kind in (1, 4):
            words.append("F" + _number(feed))
        yield " ".join(words)
