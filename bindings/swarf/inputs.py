# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the subcommands that cut have in common: the words for input, stock, tools and voxels, and the Job they make."""
from __future__ import annotations

import argparse
import os
from dataclasses import dataclass
from typing import Any, NamedTuple, Optional, Sequence

from . import _native, gcode, holders, placement, readers, specs
from .console import one_line, tell
from .job import Job
from .progress import Bar
from .simulate import DEFAULT_RESOLUTION
from .stocks import MOST_SET_UPS

#: More findings than this are left to the report.
FINDINGS_SHOWN = 20


@dataclass
class SetUp:
    """One set-up as the words tell it."""

    path: Optional[str] = None  #: None: the input
    job: Optional[str] = None
    turn: Optional[placement.Turn] = None


class OfSetUp(argparse.Action):
    """``--then`` begins a set-up; ``--job`` and ``--turn`` are of the one begun last."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any,
                 option_string: Optional[str] = None) -> None:
        set_ups = namespace.set_ups = list(namespace.set_ups or [SetUp()])
        if self.dest == "then":
            set_ups.append(SetUp(values))
            return
        if getattr(set_ups[-1], self.dest) is not None:
            raise argparse.ArgumentError(self, "given twice for one set-up; --then begins the next")
        try:
            setattr(set_ups[-1], self.dest, placement.parse(values) if self.dest == "turn" else values)
        except ValueError as error:
            raise argparse.ArgumentError(self, str(error)) from None


def add_arguments(command: argparse.ArgumentParser) -> None:
    """The input and how it is to be cut."""
    command.add_argument("input", metavar="INPUT", help="a G-code file, or a .FCStd file where the add-on is installed")
    command.set_defaults(set_ups=None)
    command.add_argument("--job", metavar="NAME", action=OfSetUp, default=argparse.SUPPRESS,
                         help="the job in a .FCStd file, if it has several")
    command.add_argument("--then", metavar="INPUT", action=OfSetUp, default=argparse.SUPPRESS,
                         help="the next set-up: it cuts what is left (repeatable); a --job and a --turn after it are "
                         "its")
    command.add_argument("--turn", metavar="SPEC", action=OfSetUp, default=argparse.SUPPRESS,
                         help=f"how the stock lies in the set-up, {placement.HELP}")
    command.add_argument("--stock", metavar="SPEC", help=specs.STOCK_HELP)
    command.add_argument("--holder", metavar="N=NAME,stickout=MM", action="append", default=[],
                         help="what holds tool N, e.g. 1=SK40-ER16,stickout=35 or 1=form:0/0:20/0:20/50,stickout=40 "
                              "(repeatable)")
    size = command.add_mutually_exclusive_group()
    size.add_argument("--voxel", metavar="MM", type=float, help="edge of a voxel")
    size.add_argument("--resolution", metavar="N", type=float,
                      help=f"voxels along the stock's longest edge (default {DEFAULT_RESOLUTION})")
    command.add_argument("--threads", metavar="T", type=int, default=0, help="threads to use (default: all cores)")
    gcode.add_arguments(command)


def files_read(arguments: argparse.Namespace) -> list[Optional[str]]:
    """The files that these words name to be read, the input first; None for what is not given."""
    return [arguments.input, arguments.stock, arguments.tool_table, arguments.parameters,
            *(set_up.path for set_up in arguments.set_ups or ())]


def files_of(job: Job) -> list[Optional[str]]:
    """The files that a job, and the set-ups before it, were read from or will be, besides those of files_read()."""
    found: list[Optional[str]] = []
    for _ in range(MOST_SET_UPS):
        stock = job.stock or {}
        found += [*job.files, stock.get("path")]
        if "job" not in stock:
            break
        job = stock["job"]
    return found


def set_threads(arguments: argparse.Namespace) -> None:
    """``--threads``; ValueError."""
    if abs(arguments.threads) >= 1 << 31:  # no int of C's: the library could not say so
        raise ValueError(f"threads: {arguments.threads} is not in 0 .. 1024 (0: one per core)")
    _native.set_threads(arguments.threads)


def read_job(arguments: argparse.Namespace, bar: Bar) -> Job:
    """The Job in the input, with what the other words say of stock and tools; its stock is what the set-ups before it
    leave. ValueError where something is missing."""
    set_ups = arguments.set_ups or [SetUp()]
    stock = None if arguments.stock is None else specs.stock(arguments.stock)
    given = _holders(arguments.holder)
    jobs: list[Job] = []
    for set_up in set_ups:
        if jobs:
            stock = {"kind": "result", "job": jobs[-1]}
        jobs.append(_read_set_up(arguments, set_up, stock, bar))
    for number, holding in given.items():
        if not any(number in job.tools for job in jobs):
            raise ValueError(f"holder {holding.word!r}: there is no tool {number}")
    return jobs[-1]


def _read_set_up(arguments: argparse.Namespace, set_up: SetUp, stock: Optional[dict[str, Any]], bar: Bar) -> Job:
    path = arguments.input if set_up.path is None else set_up.path
    tools = specs.tools(arguments.tool)
    options = gcode.options(arguments)
    job = readers.read(path, set_up.job, lambda fraction: bar("read", fraction), options)
    if stock is not None:
        own = job.stock
        job.stock = stock
        if stock["kind"] == "result" and own is not None and own["kind"] == "result" and "placement" in own:
            job.stock = {**stock, "placement": own["placement"]}  # how the document turns what the job before leaves
    if set_up.turn is not None and job.stock is not None:
        job.stock = {**job.stock, "placement": set_up.turn}
    for number, (cutter, text, teeth) in tools.items():
        job.tools[number], job.tool_names[number] = cutter, text
        job.teeth.pop(number, None)  # they were another cutter's
        if teeth:
            job.teeth[number] = teeth
    add_holders(job, arguments.holder)
    if len(job.program) == 0:
        raise ValueError(f"{path}: the program has no moves: there is nothing to simulate")
    if os.path.splitext(path)[1].lower() in readers.GCODE_SUFFIXES:
        check_gcode_job(job, path)
    return job


class _Holding(NamedTuple):
    """A word of ``--holder``, and what it says besides the tool."""

    word: str
    name: str
    stickout: Optional[float]
    projection: Optional[float]


def _holders(words: Sequence[str]) -> dict[int, _Holding]:
    """What ``--holder`` says by tool; ValueError where a tool has two."""
    found: dict[int, _Holding] = {}
    for word in words:
        number, name, stickout, projection = holders.parse(word)
        if number in found:
            raise ValueError(f"holder {word!r}: tool {number} has one already")
        found[number] = _Holding(word, name, stickout, projection)
    return found


def add_holders(job: Job, words: Sequence[str]) -> None:
    """Put those tools of ``--holder`` that the job has into their holders. ValueError."""
    for number, (_, name, stickout, projection) in _holders(words).items():
        if number not in job.tools:
            continue
        holder: holders.Holder | str = name
        if not name.lower().startswith("form:"):
            holder = holders.find(name, projection)
        job.tools[number], notes = holders.hold(job.tools[number], holder, stickout, f"tool {number}")
        job.holders[number] = holders.describe(name, stickout)
        job.notes += notes


def check_gcode_job(job: Job, path: str) -> None:
    """G-code tells neither tools nor stock: ValueError says which are missing and how to give them."""
    used = job.program.tools
    if -1 in used and len(job.tools) == 1 and used == (-1,):
        # The program never names a tool: the only one there is must be meant.
        number, cutter = next(iter(job.tools.items()))
        job.tools[-1] = cutter
        job.tool_names[-1] = job.tool_names[number]
        if number in job.teeth:
            job.teeth[-1] = job.teeth[number]
        if number in job.holders:
            job.holders[-1] = job.holders[number]
        job.notes.append(f"the program names no tool: tool {number} is used")
    missing = [number for number in used if number not in job.tools]
    if -1 in missing:
        raise ValueError(f"{path}: moves before the first T and M6 have no tool; "
                         "begin the program with a tool change, e.g. T1 M6")
    if missing:
        names = ", ".join(f"T{number}" for number in missing)
        options = " ".join(f"--tool {number}=flat:d=6,l=20" for number in missing)
        raise ValueError(f"{path}: the program uses {names}, which G-code does not describe; give e.g. {options}")
    if job.stock is None:
        raise ValueError(f"{path}: G-code does not tell the stock; give e.g. --stock box:0,0,-10,100,60,0")


def print_notes(job: Job) -> None:
    """What reading the job, and the set-ups before it, had to say, on stderr."""
    if job.stock is not None and job.stock["kind"] == "result":
        print_notes(job.stock["job"])
    for note in job.program.notes:
        tell(gcode.note_text(note))
    for text in job.notes:
        tell(f"note: {one_line(text)}")


def print_findings(lines: Sequence[str]) -> None:
    """The first findings, one a line, on stderr."""
    for line in lines[:FINDINGS_SHOWN]:
        tell(line)
    if len(lines) > FINDINGS_SHOWN:
        tell(f"note: {len(lines) - FINDINGS_SHOWN} more findings are in the report")
