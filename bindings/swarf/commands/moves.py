# SPDX-License-Identifier: LGPL-2.1-or-later
"""``swarf moves``: the canonical moves of a program as text."""
from __future__ import annotations

import argparse
from typing import Any

from .. import gcode, readers
from ..console import DONE, say
from ..progress import Bar


def add(subparsers: Any) -> None:
    """Add the parser of ``swarf moves``."""
    command = subparsers.add_parser(
        "moves",
        help="the canonical moves of a program as text",
        description="Print what a program makes the machine do, one move a line, in a format that stays: cycles, "
        "loops, offsets and compensation are worked out. Lengths in mm, in the coordinates of the stock.",
    )
    command.add_argument("input", metavar="FILE", help="a G-code file, or a .FCStd file where the add-on is installed")
    command.add_argument("--job", metavar="NAME", help="the job in a .FCStd file, if it has several")
    gcode.add_arguments(command)


def run(arguments: argparse.Namespace) -> int:
    """Print the moves."""
    with Bar() as bar:
        job = readers.read(
            arguments.input, arguments.job, lambda fraction: bar("read", fraction), gcode.options(arguments)
        )
    say(gcode.moves_text(job.program))
    return DONE
