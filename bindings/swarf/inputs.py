# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the subcommands that cut have in common: the words for input, stock, tools and voxels, and the Job they make."""
from __future__ import annotations

import argparse
import os
import sys
from typing import Sequence

from . import _native, gcode, holders, readers, specs
from .console import one_line
from .job import Job
from .progress import Bar
from .simulate import DEFAULT_RESOLUTION

#: More findings than this are left to the report.
FINDINGS_SHOWN = 20


def add_arguments(command: argparse.ArgumentParser) -> None:
    """The input and how it is to be cut."""
    command.add_argument("input", metavar="INPUT", help="a G-code file, or a .FCStd file where the add-on is installed")
    command.add_argument("--job", metavar="NAME", help="the job in a .FCStd file, if it has several")
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


def set_threads(arguments: argparse.Namespace) -> None:
    """``--threads``; ValueError."""
    if abs(arguments.threads) >= 1 << 31:  # no int of C's: the library could not say so
        raise ValueError(f"threads: {arguments.threads} is not in 0 .. 1024 (0: one per core)")
    _native.set_threads(arguments.threads)


def read_job(arguments: argparse.Namespace, bar: Bar) -> Job:
    """The Job in the input, with what the other words say of stock and tools. ValueError where something is missing."""
    stock = None if arguments.stock is None else specs.stock(arguments.stock)
    tools = specs.tools(arguments.tool)
    options = gcode.options(arguments)
    job = readers.read(arguments.input, arguments.job, lambda fraction: bar("read", fraction), options)
    if stock is not None:
        job.stock = stock
    for number, (cutter, text, teeth) in tools.items():
        job.tools[number], job.tool_names[number] = cutter, text
        job.teeth.pop(number, None)  # they were another cutter's
        if teeth:
            job.teeth[number] = teeth
    add_holders(job, arguments.holder)
    if len(job.program) == 0:
        raise ValueError(f"{arguments.input}: the program has no moves: there is nothing to simulate")
    if os.path.splitext(arguments.input)[1].lower() in readers.GCODE_SUFFIXES:
        check_gcode_job(job, arguments.input)
    return job


def add_holders(job: Job, words: Sequence[str]) -> None:
    """Put the tools of the job into the holders of ``--holder``; ValueError for tools that are not there."""
    given = set()
    for word in words:
        number, name, stickout, projection = holders.parse(word)
        if number not in job.tools:
            raise ValueError(f"holder {word!r}: there is no tool {number}")
        if number in given:
            raise ValueError(f"holder {word!r}: tool {number} has one already")
        given.add(number)
        holder = name if name.lower().startswith("form:") else holders.find(name, projection)
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
        for known in (job.teeth, job.holders):
            if number in known:
                known[-1] = known[number]
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
    """What reading the job had to say, on stderr."""
    for note in job.program.notes:
        print(f"swarf: {note[0]}: {gcode.note_text(note)}", file=sys.stderr)
    for text in job.notes:
        print(f"swarf: note: {one_line(text)}", file=sys.stderr)


def print_findings(lines: Sequence[str]) -> None:
    """The first findings, one a line, on stderr."""
    for line in lines[:FINDINGS_SHOWN]:
        print(f"swarf: {line}", file=sys.stderr)
    if len(lines) > FINDINGS_SHOWN:
        print(f"swarf: note: {len(lines) - FINDINGS_SHOWN} more findings are in the report", file=sys.stderr)
